//! The numbers that decide what section 4.3 says, from a table of critical shocks.
//!
//! A ratio's bounds are the quotients of the ends of both bars: both rows wrong by all of their bars
//! and in opposite directions.

use super::catalogue::Parts;
use crate::search::Sign;
use crate::store::summary::{PointSummary, Status, Summary};

/// From this width on a pulse counts as long, ms: the paper's section 4.2 calls 0.5 ms small.
const LONG_FROM_MS: f64 = 1.0;

/// A reported value with its bar, G.
#[derive(Clone, Copy)]
struct Barred {
    value: f64,
    bar: Option<[f64; 2]>,
}

impl Barred {
    fn of(point: &PointSummary) -> Option<Barred> {
        let value = point.a_crit_g.filter(|_| point.status == Status::Ok)?;
        let bar = point.err_low_g.zip(point.err_high_g);
        Some(Barred {
            value,
            bar: bar.map(|(low, high)| [(value - low).max(0.0), value + high]),
        })
    }

    /// `self / other`.
    fn over(self, other: Barred) -> (f64, Option<[f64; 2]>) {
        let bar = self
            .bar
            .zip(other.bar)
            .map(|(a, b)| [a[0] / b[1], a[1] / b[0]]);
        (self.value / other.value, bar)
    }

    /// Distance of two over their mean, per cent.
    fn distance(self, other: Barred) -> (f64, Option<[f64; 2]>) {
        let of = |a: f64, b: f64| 200.0 * (a - b).abs() / (a + b);
        let bar = self.bar.zip(other.bar).map(|(a, b)| {
            let apart = [of(a[0], b[1]), of(a[1], b[0])];
            let touch = a[0] <= b[1] && b[0] <= a[1];
            let least = if touch { 0.0 } else { apart[0].min(apart[1]) };
            [least, apart[0].max(apart[1])]
        });
        (of(self.value, other.value), bar)
    }
}

/// Widths, ascending, and value of a ramp and sign; rows of studies with further axes are left out,
/// as they answer another question.
fn curve(summary: &Summary, ramp: &str, sign: Sign) -> Vec<(f64, Barred)> {
    let mut curve: Vec<(f64, Barred)> = summary
        .points
        .iter()
        .filter(|point| point.ramp == ramp && point.sign == sign && point.axes.is_empty())
        .filter_map(|point| Some((point.pulse_ms, Barred::of(point)?)))
        .collect();
    curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    curve
}

/// Widths that both curves have.
fn both(a: Vec<(f64, Barred)>, b: &[(f64, Barred)]) -> impl Iterator<Item = (f64, Barred, Barred)> {
    a.into_iter().filter_map(|(width, one)| {
        let other = b.iter().find(|(at, _)| *at == width)?;
        Some((width, one, other.1))
    })
}

const SIGNS: [Sign; 2] = [Sign::Plus, Sign::Minus];

fn rises(summary: &Summary, ramp: &str) -> Parts {
    let mut parts = Parts::new();
    for sign in SIGNS {
        for pair in curve(summary, ramp, sign).windows(2) {
            let (ratio, bar) = pair[1].1.over(pair[0].1);
            let at = format!("{} to {} ms, {}", pair[0].0, pair[1].0, sign.as_str());
            parts.push((at, ratio, bar));
        }
    }
    parts
}

pub(super) fn rises_none(summary: &Summary) -> Parts {
    rises(summary, "none")
}

pub(super) fn rises_rigid(summary: &Summary) -> Parts {
    rises(summary, "rigid")
}

pub(super) fn rises_deformable(summary: &Summary) -> Parts {
    rises(summary, "deformable")
}

fn signs(summary: &Summary, ramp: &str) -> Parts {
    let plus = curve(summary, ramp, Sign::Plus);
    both(plus, &curve(summary, ramp, Sign::Minus))
        .map(|(width, plus, minus)| {
            let (apart, bar) = plus.distance(minus);
            (format!("{width} ms"), apart, bar)
        })
        .collect()
}

pub(super) fn signs_none(summary: &Summary) -> Parts {
    signs(summary, "none")
}

pub(super) fn signs_rigid(summary: &Summary) -> Parts {
    signs(summary, "rigid")
}

pub(super) fn signs_deformable(summary: &Summary) -> Parts {
    signs(summary, "deformable")
}

fn ratios(summary: &Summary, ramp: &str, to: &str, is_asked: impl Fn(f64) -> bool) -> Parts {
    let mut parts = Parts::new();
    for sign in SIGNS {
        let one = curve(summary, ramp, sign);
        for (width, a, b) in both(one, &curve(summary, to, sign)) {
            if is_asked(width) {
                let (ratio, bar) = a.over(b);
                parts.push((format!("{width} ms, {}", sign.as_str()), ratio, bar));
            }
        }
    }
    parts
}

pub(super) fn above_when_long(summary: &Summary) -> Parts {
    ratios(summary, "deformable", "rigid", |width| {
        width >= LONG_FROM_MS
    })
}

pub(super) fn below_when_short(summary: &Summary) -> Parts {
    let widths = summary.points.iter().map(|point| point.pulse_ms);
    let shortest = widths.fold(f64::INFINITY, f64::min);
    ratios(summary, "deformable", "rigid", |width| width == shortest)
}

pub(super) fn below_none(summary: &Summary) -> Parts {
    let mut parts = Parts::new();
    for ramp in ["rigid", "deformable"] {
        for (at, ratio, bar) in ratios(summary, ramp, "none", |_| true) {
            parts.push((format!("{ramp}, {at}"), ratio, bar));
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn barred(value: f64, low: f64, high: f64) -> Barred {
        Barred {
            value,
            bar: Some([low, high]),
        }
    }

    #[test]
    fn quotients_and_distances_carry_the_worst_of_both_bars() {
        let (a, b) = (barred(200.0, 180.0, 240.0), barred(100.0, 80.0, 120.0));
        assert_eq!(a.over(b), (2.0, Some([1.5, 3.0])));
        let (apart, bar) = a.distance(b);
        assert!((apart - 200.0 / 3.0).abs() < 1e-12);
        // 180 against 120 and 240 against 80.
        assert_eq!(bar, Some([40.0, 100.0]));
        // Bars that touch leave no distance.
        let near = barred(190.0, 150.0, 230.0);
        assert_eq!(a.distance(near).1.map(|bar| bar[0]), Some(0.0));
    }
}
