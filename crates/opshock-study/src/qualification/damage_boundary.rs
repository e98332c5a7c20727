//! Damage boundary: which pulses of a shape fail, by velocity change and amplitude (ASTM D3332).
//!
//! A pulse s(t) with peak 1 and width w changes the velocity by V = A ∫s dt. At each width the boundary is the critical shock
//! A(w), so that the boundary is the curve (V(w), A(w)). Short pulses fail by their velocity change alone, long ones by their amplitude:
//!
//! ```text
//! critical velocity change  = min over w of A(w) ∫s dt        critical acceleration  = min over w of A(w)
//! ```
//!
//! A pulse of a tested width that fails has at least both. ASTM D3332 takes each from one test, at a short and at a long pulse;
//! here every width counts, because a pulse about as long as a period of the structure fails below the level of long ones.

use serde::Serialize;

use super::verdict::{Open, PointVerdict};
use crate::search::Sign;
use crate::store::summary::Summary;
use crate::study::Study;

/// Change of a critical value from one width to the next up to which it counts as settled.
const SETTLED: f64 = 0.1;

/// The boundary at a pulse width and sign.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundaryPoint {
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign of the shock.
    pub sign: Sign,
    /// Where the critical shock may lie, G; from 0 and without bound where nothing is known. A lower end that would not pass as a
    /// requirement ([`PointVerdict`]) is 0.
    pub amplitude_g: [f64; 2],
    /// Why the lower end is not known.
    pub open: Option<Open>,
    /// The same as velocity change, m/s.
    pub velocity_change_m_per_s: [f64; 2],
}

/// A critical value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Critical {
    /// Where it may lie.
    pub interval: [f64; 2],
    /// Pulse width at which it is found, ms.
    pub at_ms: f64,
    /// Widths beyond those that were tested will not lower it by much: it is known, and the end of the widths lies above it for certain,
    /// or changes by less than 10 % to the next width.
    pub is_settled: bool,
}

/// A damage boundary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DamageBoundary {
    /// Its points, by sign and width.
    pub points: Vec<BoundaryPoint>,
    /// Velocity change below which no pulse fails, m/s.
    pub critical_velocity_change_m_per_s: Critical,
    /// Amplitude below which no pulse fails, G.
    pub critical_acceleration_g: Critical,
}

impl DamageBoundary {
    /// From the critical shocks of a study's points, in the order of its tables; `None` without points.
    pub fn of(study: &Study, summary: &Summary) -> Option<DamageBoundary> {
        let order = study.table_order().into_iter();
        let points = order.zip(&summary.points).map(|(place, row)| {
            let point = &study.points[place];
            let unit_s = point.scene.pulse.integral_s().ok()?.abs();
            let [low_g, high_g] = row.interval_g().unwrap_or([0.0, f64::INFINITY]);
            let open = PointVerdict::of(row, low_g).open;
            let amplitude_g = [open.map_or(low_g, |_| 0.0), high_g];
            let per_g = opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 * unit_s;
            Some(BoundaryPoint {
                pulse_ms: point.pulse_ms,
                sign: point.sign,
                amplitude_g,
                open,
                velocity_change_m_per_s: amplitude_g.map(|amplitude_g| per_g * amplitude_g),
            })
        });
        Self::through(points.collect::<Option<_>>()?)
    }

    /// Through points of any order.
    pub fn through(mut points: Vec<BoundaryPoint>) -> Option<DamageBoundary> {
        points.sort_by(|a, b| {
            let by_width = a.pulse_ms.total_cmp(&b.pulse_ms);
            a.sign.as_str().cmp(b.sign.as_str()).then(by_width)
        });
        let velocity_change = critical(&points, |point| point.velocity_change_m_per_s, false)?;
        let acceleration = critical(&points, |point| point.amplitude_g, true)?;
        Some(DamageBoundary {
            points,
            critical_velocity_change_m_per_s: velocity_change,
            critical_acceleration_g: acceleration,
        })
    }
}

/// The smallest value over widths and signs. It is to settle towards the longest width, or the shortest.
fn critical(
    points: &[BoundaryPoint],
    value: impl Fn(&BoundaryPoint) -> [f64; 2],
    towards_long: bool,
) -> Option<Critical> {
    let mut widths: Vec<f64> = points.iter().map(|point| point.pulse_ms).collect();
    widths.sort_by(f64::total_cmp);
    widths.dedup();
    if towards_long {
        widths.reverse();
    }
    // The worse sign of each width; the end of the widths comes first.
    let least = |width: f64| {
        let of_width = points.iter().filter(|point| point.pulse_ms == width);
        of_width.fold([f64::INFINITY; 2], |least, point| {
            let [low, high] = value(point);
            [least[0].min(low), least[1].min(high)]
        })
    };
    let by_width: Vec<[f64; 2]> = widths.iter().map(|width| least(*width)).collect();
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    let order = |a: &usize, b: &usize| {
        let of = |place: usize| (by_width[place][1], by_width[place][0]);
        let (x, y) = (of(*a), of(*b));
        x.0.total_cmp(&y.0).then(x.1.total_cmp(&y.1))
    };
    let at = (0..by_width.len()).min_by(order)?;
    let interval = by_width.iter().fold([f64::INFINITY; 2], |all, one| {
        [all[0].min(one[0]), all[1].min(one[1])]
    });
    let is_known = |[low, high]: [f64; 2]| low > 0.0 && high.is_finite();
    let is_settled = match by_width[..] {
        [end, ..] if at > 0 && end[0] >= interval[1] => true,
        [end, next, ..] => is_known(end) && middle(next) <= (1.0 + SETTLED) * middle(end),
        _ => false,
    };
    Some(Critical {
        interval,
        at_ms: widths[at],
        is_settled: is_settled && is_known(interval),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Record, shock_response_spectrum};
    use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
    use std::f64::consts::{FRAC_2_PI, PI};

    /// An undamped oscillator of 1 kHz that fails at 100 G: critical shocks of half-sines from its numerical response, as
    /// the search would bracket them to 0.1 %.
    fn of_an_oscillator(widths_ms: &[f64]) -> DamageBoundary {
        let points = widths_ms.iter().map(|&pulse_ms| {
            let n = 4000;
            let share = |k: u32| f64::from(k) / f64::from(n);
            let record = Record {
                time_s: (0..=n).map(|k| 1e-3 * pulse_ms * share(k)).collect(),
                acceleration_m_per_s2: (0..=n).map(|k| (PI * share(k)).sin()).collect(),
            };
            let response = shock_response_spectrum(&record, &[1e3], f64::INFINITY)[0];
            let critical_g = 100.0 / response.maximax_m_per_s2();
            let amplitude_g = [0.9995 * critical_g, 1.0005 * critical_g];
            let per_g = STANDARD_GRAVITY_M_PER_S2 * FRAC_2_PI * 1e-3 * pulse_ms;
            BoundaryPoint {
                pulse_ms,
                sign: Sign::Plus,
                amplitude_g,
                open: None,
                velocity_change_m_per_s: amplitude_g.map(|amplitude_g| per_g * amplitude_g),
            }
        });
        DamageBoundary::through(points.collect()).expect("a boundary")
    }

    #[test]
    fn the_boundary_of_an_oscillator_is_the_closed_form() {
        let widths_ms = [0.02, 0.05, 0.1, 0.2, 0.3, 0.8, 1.5, 3.0, 10.0];
        let found = of_an_oscillator(&widths_ms);
        for point in &found.points {
            // Largest response of an undamped oscillator to a half-sine of 1 (Harris' Shock and Vibration Handbook,
            // chapter 8): after the pulse where that is shorter than half a period, else within it.
            let x = point.pulse_ms;
            let within =
                |n: f64| 2.0 * x / (2.0 * x - 1.0) * (2.0 * PI * n / (1.0 + 2.0 * x)).sin();
            let largest = match x < 0.5 {
                true => 4.0 * x * (PI * x).cos() / (1.0 - 4.0 * x * x),
                false => (1..=10)
                    .map(f64::from)
                    .filter(|n| *n <= x + 0.5)
                    .map(|n| within(n).abs())
                    .fold(0.0, f64::max),
            };
            let [low, high] = point
                .amplitude_g
                .map(|amplitude_g| amplitude_g * largest / 100.0);
            assert!(
                low < 1.0 && high > 1.0,
                "{} ms: {low} to {high}",
                point.pulse_ms
            );
        }
        // The asymptote of short pulses: a velocity change of the level over the angular frequency.
        let velocity = found.critical_velocity_change_m_per_s;
        let exact = 100.0 * STANDARD_GRAVITY_M_PER_S2 / (2.0 * PI * 1e3);
        assert!(
            (velocity.interval[0] / exact - 1.0).abs() < 1e-3,
            "{velocity:?}"
        );
        assert_eq!((velocity.at_ms, velocity.is_settled), (0.02, true));
        // The largest response to any half-sine is 1.768, at 0.81 of a period.
        let acceleration = found.critical_acceleration_g;
        assert!((acceleration.interval[1] * 1.768 / 100.0 - 1.0).abs() < 2e-3);
        assert_eq!((acceleration.at_ms, acceleration.is_settled), (0.8, true));
    }

    #[test]
    fn a_value_at_the_end_of_the_widths_that_still_changes_is_not_settled() {
        let found = of_an_oscillator(&[0.3, 0.45, 0.7]);
        assert!(!found.critical_velocity_change_m_per_s.is_settled);
        assert!(!found.critical_acceleration_g.is_settled);
    }

    #[test]
    fn an_unknown_point_leaves_the_lower_end_open() {
        let mut points = of_an_oscillator(&[0.1, 0.3, 3.0]).points;
        points[1].amplitude_g = [0.0, f64::INFINITY];
        points[1].velocity_change_m_per_s = [0.0, f64::INFINITY];
        let found = DamageBoundary::through(points).expect("a boundary");
        assert_eq!(found.critical_acceleration_g.interval[0], 0.0);
        assert_eq!(found.critical_velocity_change_m_per_s.interval[0], 0.0);
        assert!(found.critical_acceleration_g.interval[1].is_finite());
        assert!(!found.critical_velocity_change_m_per_s.is_settled);
    }
}
