//! Observations: a number of the model, the range in which it holds, and how far a parameter set is from it.
//!
//! ```text
//! margin      = distance to the nearer end of the range, negative outside, over u
//! I           = distance outside the range over sqrt(u² + observation² + discrepancy²),     ruled out: I >= 3
//! ```
//!
//! u is the numerical uncertainty of the number. I is the implausibility of Craig et al. (1997); 3 is Pukelsheim's
//! (1994, Am. Stat. 48, 88) bound: 95 % of any unimodal distribution lie within three standard deviations.

use crate::study::{Ramp, Sign};

/// Implausibility from which a parameter set is ruled out.
pub const RULED_OUT: f64 = 3.0;

/// Margin to which the search brings every observation before it widens the smallest: its own numerical uncertainty.
pub(super) const SAFE: f64 = 1.0;

/// Simulations that a number needs, in the order of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Disk and ramp of single shocks.
    DiskAndRamp,
    /// Single shocks with the head.
    SingleShocks,
    /// Critical shocks.
    CriticalShocks,
}

impl Stage {
    /// All, in the order of cost.
    pub const ALL: [Stage; 3] = [
        Stage::DiskAndRamp,
        Stage::SingleShocks,
        Stage::CriticalShocks,
    ];

    /// Key in a match file.
    pub const fn as_str(self) -> &'static str {
        match self {
            Stage::DiskAndRamp => "disk_and_ramp",
            Stage::SingleShocks => "single_shocks",
            Stage::CriticalShocks => "critical_shocks",
        }
    }

    /// Name in messages.
    pub const fn words(self) -> &'static str {
        match self {
            Stage::DiskAndRamp => "disk and ramp",
            Stage::SingleShocks => "single shocks",
            Stage::CriticalShocks => "critical shocks",
        }
    }
}

/// One shock of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct ShockChoice {
    /// Ramp model.
    pub ramp: Option<Ramp>,
    /// Width, ms.
    pub pulse_ms: Option<f64>,
    /// Sign.
    pub sign: Option<Sign>,
    /// Amplitude, G; none for a critical shock.
    pub amplitude_g: Option<f64>,
}

/// A value that an output is compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// Text.
    Text(String),
    /// true or false.
    Flag(bool),
}

/// Distance of two histories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Root of the mean square of their difference.
    Rms,
    /// Largest difference.
    Largest,
}

/// Histories that can be compared with measured ones, and what they need.
pub(super) const COLUMNS: [(&str, Stage); 15] = [
    ("disk_slider_m", Stage::DiskAndRamp),
    ("disk_ramp_m", Stage::DiskAndRamp),
    ("disk_rim_m", Stage::DiskAndRamp),
    ("disk_pitch_rad", Stage::DiskAndRamp),
    ("disk_roll_rad", Stage::DiskAndRamp),
    ("ramp_top_m", Stage::DiskAndRamp),
    ("ramp_bottom_m", Stage::DiskAndRamp),
    ("contact_top_n", Stage::DiskAndRamp),
    ("contact_bottom_n", Stage::DiskAndRamp),
    ("slider_z_m", Stage::SingleShocks),
    ("slider_pitch_rad", Stage::SingleShocks),
    ("slider_roll_rad", Stage::SingleShocks),
    ("min_clearance_m", Stage::SingleShocks),
    ("bearing_force_n", Stage::SingleShocks),
    ("dimple_force_n", Stage::SingleShocks),
];

/// Combination of numbers of other observations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combination {
    /// First over second.
    Ratio,
    /// First less second.
    Difference,
    /// Distance of two over their mean, per cent.
    DistancePct,
    /// Smallest ratio of one to the one before: above 1 they ascend.
    Order,
}

/// Source of a number.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// A number of `opshock run --json`, by its path; with `equals`, 1 where it equals that and 0 elsewhere.
    Run {
        /// The shock.
        shock: ShockChoice,
        /// Names and positions, as `["contact", "top", "episodes", "0", "on_s"]`; `length` at the end gives the number.
        path: Vec<String>,
        /// Value that a word or flag is compared with.
        equals: Option<Scalar>,
    },
    /// Distance of a history from a measured one.
    History {
        /// The shock.
        shock: ShockChoice,
        /// Column of `run --history`.
        column: String,
        /// Measured times on the study's axis, s, and values in the column's unit.
        measured: Vec<(f64, f64)>,
        /// Distance.
        measure: Measure,
    },
    /// A number of `opshock modes --json`.
    Modes(Vec<String>),
    /// A number of `opshock steady --json`.
    Steady(Vec<String>),
    /// A critical shock, G.
    Critical(ShockChoice),
    /// The number of a statement that is built into the program.
    Statement {
        /// Name of the statement.
        id: &'static str,
        /// Unit; empty for ratios and whole numbers.
        unit: &'static str,
    },
    /// A number of other observations, by their places.
    Combined(Combination, Vec<usize>),
}

/// One observation.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Name.
    pub name: String,
    /// Source of its number.
    pub quantity: Quantity,
    /// Lowest and highest number with which it holds; `None` for a number without observed value.
    pub range: Option<[f64; 2]>,
    /// Standard uncertainty of the observation.
    pub observed_u: f64,
    /// Standard uncertainty of the model: effects it omits.
    pub discrepancy_u: f64,
    /// Numerical uncertainty where the file gives it.
    pub numerical_u: Option<f64>,
    /// Weight in the search, 1 unless the file says otherwise.
    pub weight: f64,
    /// Simulations needed.
    pub stage: Stage,
    /// Source of the observation.
    pub source: String,
}

/// A number as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Not computed yet.
    NotAsked,
    /// There is none, as the time of a touch that does not occur.
    Missing,
    /// The number.
    Is(f64),
}

impl Observation {
    /// Whether it holds with a number; `None` where that is not known or nothing was observed.
    pub fn holds(&self, number: Known) -> Option<bool> {
        let [low, high] = self.range?;
        match number {
            Known::NotAsked => None,
            Known::Missing => Some(false),
            Known::Is(value) => Some((low..=high).contains(&value)),
        }
    }

    /// Signed distance to the nearer end of the range in units of the numerical uncertainty `u`: infinite where nothing
    /// bounds it, without a number, and for exact numbers. An end that is met to the bit is a limit of the number
    /// itself and bounds nothing, as for whole numbers or the clearance of a slider that touches; two critical shocks
    /// that a search found equal are no such limit.
    pub fn margin(&self, number: Known, u: f64) -> Option<f64> {
        let [low, high] = self.range?;
        let inside = match number {
            Known::NotAsked => return None,
            Known::Missing => return Some(f64::NEG_INFINITY),
            Known::Is(value) => {
                let is_limit = |far: f64| far == 0.0 && self.stage != Stage::CriticalShocks;
                let to = |far: f64| if is_limit(far) { f64::INFINITY } else { far };
                to(value - low).min(to(high - value))
            }
        };
        Some(match (u > 0.0, inside >= 0.0) {
            (true, _) => inside / u,
            (false, true) => f64::INFINITY,
            (false, false) => f64::NEG_INFINITY,
        })
    }

    /// Distance outside the range; infinite without a number.
    pub(super) fn outside(&self, number: Known) -> Option<f64> {
        let [low, high] = self.range?;
        match number {
            Known::NotAsked => None,
            Known::Missing => Some(f64::INFINITY),
            Known::Is(value) => Some((low - value).max(value - high).max(0.0)),
        }
    }

    /// Shortfall of a number's margin from its numerical uncertainty `u`, from 1 to 2 times the weight, and 0 where it reaches it; `None` where
    /// it is not known or bounds nothing. `scale` is the distance that is half a step.
    pub(super) fn missing(&self, number: Known, u: f64, scale: f64) -> Option<f64> {
        if self.margin(number, u)? >= SAFE {
            return Some(0.0);
        }
        let outside = self.outside(number).unwrap_or(0.0) + SAFE * u;
        let far = match outside.is_finite() {
            true => outside / (outside + scale),
            false => 1.0,
        };
        Some(self.weight * (1.0 + far))
    }

    /// Implausibility with a numerical uncertainty `u`.
    pub fn implausibility(&self, number: Known, u: f64) -> Option<f64> {
        let outside = self.outside(number)?;
        let total = u.hypot(self.observed_u).hypot(self.discrepancy_u);
        Some(match outside > 0.0 {
            true => outside / total,
            false => 0.0,
        })
    }
}

impl Combination {
    /// Keys of a match file.
    pub const ALL: [(&'static str, Combination); 4] = [
        ("ratio", Combination::Ratio),
        ("difference", Combination::Difference),
        ("distance_pct", Combination::DistancePct),
        ("order", Combination::Order),
    ];

    /// The number, and its numerical uncertainty when those of its parts have opposite signs.
    pub fn of(self, parts: &[(Known, f64)]) -> (Known, f64) {
        // While a number is not computed yet there is no answer, whatever the others are.
        if parts.iter().any(|(known, _)| *known == Known::NotAsked) {
            return (Known::NotAsked, 0.0);
        }
        let mut values = Vec::new();
        for (known, u) in parts {
            match known {
                Known::Is(value) => values.push((*value, *u)),
                other => return (*other, 0.0),
            }
        }
        let ratio = |(a, ua): (f64, f64), (b, ub): (f64, f64)| {
            let value = a / b;
            (value, (ua + value.abs() * ub) / b.abs())
        };
        let (first, second) = (values[0], values[1]);
        let (value, u) = match self {
            Combination::Ratio => ratio(first, second),
            Combination::Difference => (first.0 - second.0, first.1 + second.1),
            Combination::DistancePct => {
                let sum = (first.0 + second.0).abs();
                let value = 200.0 * (first.0 - second.0).abs() / sum;
                let by = |own: f64| 400.0 * own.abs() / (sum * sum);
                (value, by(second.0) * first.1 + by(first.0) * second.1)
            }
            Combination::Order => values
                .windows(2)
                .map(|pair| ratio(pair[1], pair[0]))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .expect("two or more"),
        };
        match value.is_finite() {
            true => (Known::Is(value), u),
            false => (Known::Missing, 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observation(range: [f64; 2]) -> Observation {
        Observation {
            name: "x".into(),
            quantity: Quantity::Modes(Vec::new()),
            range: Some(range),
            observed_u: 3.0,
            weight: 1.0,
            discrepancy_u: 0.0,
            numerical_u: None,
            stage: Stage::DiskAndRamp,
            source: String::new(),
        }
    }

    #[test]
    fn margins_count_numerics_and_implausibility_all_uncertainties() {
        let one = observation([10.0, 20.0]);
        assert_eq!(one.margin(Known::Is(18.0), 4.0), Some(0.5));
        assert_eq!(one.margin(Known::Is(8.0), 4.0), Some(-0.5));
        let count = observation([3.0, 3.0]);
        assert_eq!(count.margin(Known::Is(3.0), 1.0), Some(f64::INFINITY));
        assert_eq!(count.margin(Known::Is(2.0), 1.0), Some(-1.0));
        let ratio = Observation {
            stage: Stage::CriticalShocks,
            ..observation([1.0, f64::INFINITY])
        };
        assert_eq!(ratio.margin(Known::Is(1.0), 0.02), Some(0.0));
        // 10 outside over sqrt(4² + 3²).
        assert_eq!(one.implausibility(Known::Is(30.0), 4.0), Some(2.0));
        assert_eq!(one.implausibility(Known::Is(10.0), 4.0), Some(0.0));
        assert_eq!(one.implausibility(Known::Missing, 4.0), Some(f64::INFINITY));
        assert_eq!(one.holds(Known::NotAsked), None);
    }

    #[test]
    fn combinations_carry_the_worst_of_both_uncertainties() {
        let (a, b) = ((Known::Is(200.0), 2.0), (Known::Is(100.0), 3.0));
        assert_eq!(
            Combination::Ratio.of(&[a, b]),
            (Known::Is(2.0), 2.0 * (0.01 + 0.03))
        );
        assert_eq!(Combination::Difference.of(&[a, b]), (Known::Is(100.0), 5.0));
        let (Known::Is(distance), u) = Combination::DistancePct.of(&[a, b]) else {
            panic!("a number");
        };
        assert!((distance - 200.0 / 3.0).abs() < 1e-12);
        // By differences of 1e-6 of the formula.
        let by = |x: f64, y: f64| 200.0 * (x - y) / (x + y);
        let slope = (by(200.0 + 1e-4, 100.0) - distance) / 1e-4 * 2.0
            - (by(200.0, 100.0 + 1e-4) - distance) / 1e-4 * 3.0;
        assert!((u - slope).abs() < 1e-5, "{u} {slope}");
        assert_eq!(Combination::Order.of(&[b, a, b]).0, Known::Is(0.5));
        let zero = (Known::Is(0.0), 1.0);
        assert_eq!(Combination::Ratio.of(&[zero, b]), (Known::Is(0.0), 0.01));
        let (missing, later) = ((Known::Missing, 0.0), (Known::NotAsked, 0.0));
        assert_eq!(Combination::Ratio.of(&[missing, later]).0, Known::NotAsked);
        assert_eq!(
            Combination::Ratio.of(&[a, (Known::Missing, 0.0)]).0,
            Known::Missing
        );
    }
}
