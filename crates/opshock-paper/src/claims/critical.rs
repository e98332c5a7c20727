//! Computes the numbers that decide the statements of section 4.3, from a table of critical shocks.
//!
//! A ratio's bounds are the quotients of the ends of both intervals: both rows wrong by all of their intervals
//! and in opposite directions.

use opshock_study::search::Sign;
use opshock_study::store::summary::{PointSummary, Summary};

/// One number of a statement about many critical shocks: place, number, bounds by the uncertainty intervals.
pub type Place = (String, f64, Option<[f64; 2]>);

/// Numbers of a statement about many critical shocks.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Those that decide it.
    pub places: Vec<Place>,
    /// What else a reader wants to see.
    pub note: String,
}

impl From<Vec<Place>> for Parts {
    fn from(places: Vec<Place>) -> Self {
        Self {
            places,
            note: String::new(),
        }
    }
}

/// From this width on a pulse is long, ms: the paper's section 4.2 calls 0.5 ms small.
const LONG_FROM_MS: f64 = 1.0;

/// A predictions value with its interval, G.
#[derive(Clone, Copy)]
struct WithUncertainty {
    value: f64,
    uncertainty: Option<[f64; 2]>,
}

impl WithUncertainty {
    fn of(point: &PointSummary) -> Option<WithUncertainty> {
        let value = point.a_crit_g?;
        let uncertainty = point.uncertainty_g;
        Some(WithUncertainty {
            value,
            uncertainty: uncertainty.map(|half| [(value - half).max(0.0), value + half]),
        })
    }

    /// `self / other`.
    fn over(self, other: WithUncertainty) -> (f64, Option<[f64; 2]>) {
        let uncertainty = self
            .uncertainty
            .zip(other.uncertainty)
            .map(|(a, b)| [a[0] / b[1], a[1] / b[0]]);
        (self.value / other.value, uncertainty)
    }

    /// Distance of two over their mean, per cent.
    fn distance(self, other: WithUncertainty) -> (f64, Option<[f64; 2]>) {
        let of = |a: f64, b: f64| 200.0 * (a - b).abs() / (a + b);
        let uncertainty = self.uncertainty.zip(other.uncertainty).map(|(a, b)| {
            let apart = [of(a[0], b[1]), of(a[1], b[0])];
            let touch = a[0] <= b[1] && b[0] <= a[1];
            let least = if touch { 0.0 } else { apart[0].min(apart[1]) };
            [least, apart[0].max(apart[1])]
        });
        (of(self.value, other.value), uncertainty)
    }
}

/// Widths, ascending, and value of a ramp and sign; rows of studies with further axes are left out,
/// as they answer another question.
fn curve(summary: &Summary, ramp: &str, sign: Sign) -> Vec<(f64, WithUncertainty)> {
    let mut curve: Vec<(f64, WithUncertainty)> = summary
        .points
        .iter()
        .filter(|point| point.ramp == ramp && point.sign == sign && point.axes.is_empty())
        .filter_map(|point| Some((point.pulse_ms, WithUncertainty::of(point)?)))
        .collect();
    curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    curve
}

/// Widths that both curves have.
fn both(
    a: Vec<(f64, WithUncertainty)>,
    b: &[(f64, WithUncertainty)],
) -> impl Iterator<Item = (f64, WithUncertainty, WithUncertainty)> {
    a.into_iter().filter_map(|(width, one)| {
        let other = b.iter().find(|(at, _)| *at == width)?;
        Some((width, one, other.1))
    })
}

const SIGNS: [Sign; 2] = [Sign::Plus, Sign::Minus];

/// Widths that the paper may have used, ms: it prints none, and draws few points a curve.
const PAPER_WIDTHS_MS: [f64; 5] = [0.5, 1.0, 1.5, 2.0, 3.0];

/// Ratios of neighbouring widths among [`PAPER_WIDTHS_MS`]. What a curve does at others is noted as a
/// prediction: near 0.75 ms it may dip, as a half-sine of width T excites an oscillator of frequency f
/// most at f T = 0.81, and the disk's first mode is near 1 kHz.
///
/// # Source
///
/// Ayre, Transient response to step and pulse functions, in Harris, Shock and Vibration Handbook, ch. 8.
fn rises(summary: &Summary, ramp: &str) -> Parts {
    let mut parts = Parts::default();
    let mut predictions = Vec::new();
    for sign in SIGNS {
        let (judged, predicted): (Vec<_>, Vec<_>) = curve(summary, ramp, sign)
            .into_iter()
            .partition(|(width, _)| PAPER_WIDTHS_MS.contains(width));
        for pair in judged.windows(2) {
            let (ratio, uncertainty) = pair[1].1.over(pair[0].1);
            let at = format!("{} to {} ms, {}", pair[0].0, pair[1].0, sign.as_str());
            parts.places.push((at, ratio, uncertainty));
        }
        for (width, barred) in predicted {
            let above = judged.iter().position(|(known, _)| *known > width);
            let Some((low, high)) =
                above.and_then(|at| Some((judged.get(at.checked_sub(1)?)?, judged[at])))
            else {
                continue;
            };
            let least = low.1.value.min(high.1.value);
            let change = 100.0 * (barred.value / least - 1.0);
            predictions.push(format!(
                "{width} ms, {}: {:.1} G, {}",
                sign.as_str(),
                barred.value,
                match change < 0.0 {
                    true => format!("a dip {:.1} % below {} and {} ms", -change, low.0, high.0),
                    false => format!("no dip between {} and {} ms", low.0, high.0),
                }
            ));
        }
    }
    if !predictions.is_empty() {
        parts.note = format!("prediction, not judged: {}", predictions.join("; "));
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
            let (apart, uncertainty) = plus.distance(minus);
            (format!("{width} ms"), apart, uncertainty)
        })
        .collect::<Vec<_>>()
        .into()
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

fn ratios(summary: &Summary, ramp: &str, to: &str, is_asked: impl Fn(f64) -> bool) -> Vec<Place> {
    let mut parts = Vec::new();
    for sign in SIGNS {
        let one = curve(summary, ramp, sign);
        for (width, a, b) in both(one, &curve(summary, to, sign)) {
            if is_asked(width) {
                let (ratio, uncertainty) = a.over(b);
                parts.push((format!("{width} ms, {}", sign.as_str()), ratio, uncertainty));
            }
        }
    }
    parts
}

pub(super) fn above_when_long(summary: &Summary) -> Parts {
    let is_long = |width| width >= LONG_FROM_MS;
    ratios(summary, "deformable", "rigid", is_long).into()
}

pub(super) fn below_when_short(summary: &Summary) -> Parts {
    let widths = summary.points.iter().map(|point| point.pulse_ms);
    let shortest = widths.fold(f64::INFINITY, f64::min);
    ratios(summary, "deformable", "rigid", |width| width == shortest).into()
}

pub(super) fn below_none(summary: &Summary) -> Parts {
    let mut parts = Vec::new();
    for ramp in ["rigid", "deformable"] {
        for (at, ratio, uncertainty) in ratios(summary, ramp, "none", |_| true) {
            parts.push((format!("{ramp}, {at}"), ratio, uncertainty));
        }
    }
    parts.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn barred(value: f64, low: f64, high: f64) -> WithUncertainty {
        WithUncertainty {
            value,
            uncertainty: Some([low, high]),
        }
    }

    #[test]
    fn quotients_and_distances_carry_the_worst_of_both_uncertainty() {
        let (a, b) = (barred(200.0, 180.0, 240.0), barred(100.0, 80.0, 120.0));
        assert_eq!(a.over(b), (2.0, Some([1.5, 3.0])));
        let (apart, uncertainty) = a.distance(b);
        assert!((apart - 200.0 / 3.0).abs() < 1e-12);
        // 180 against 120 and 240 against 80.
        assert_eq!(uncertainty, Some([40.0, 100.0]));
        // Uncertainty intervals that touch leave no distance.
        let near = barred(190.0, 150.0, 230.0);
        assert_eq!(
            a.distance(near).1.map(|uncertainty| uncertainty[0]),
            Some(0.0)
        );
    }
}
