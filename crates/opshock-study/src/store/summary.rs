//! Table of a study's critical shocks as rows: the source of tables, curves and JSON.
//!
//! The JSON is `{"study", "digest", "points": [{"ramp", "pulse_ms", "sign", ...axes, "a_crit_g",
//! "uncertainty_g", "half_min_height_g", "survived_g", "failed_g", "contributions", "levels", "onset_g", "runs", "status", "flags",
//! "brackets_g", "scanned_from_g", "largest_gap_pct"}], "totals": {...}}`. A missing value is
//! null. Nothing in it depends on the machine, the number of threads or the time of day, so that
//! equal results are equal bytes.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

pub use crate::search::{Flag, Status};
use crate::search::{ProbeResult, Purpose, RunCost, Sign, Verdict};
use crate::study;

/// Value of a further axis of the study.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum AxisValue {
    /// A number in the unit that the axis' name carries.
    Number(f64),
    /// A word, a file, a truth value.
    Text(String),
}

impl From<&study::AxisValue> for AxisValue {
    fn from(value: &study::AxisValue) -> Self {
        match value {
            study::AxisValue::Number(number) => AxisValue::Number(*number),
            study::AxisValue::Integer(number) => AxisValue::Number(*number as f64),
            study::AxisValue::Word(word) => AxisValue::Text(word.clone()),
            study::AxisValue::Flag(flag) => AxisValue::Text(flag.to_string()),
        }
    }
}

impl std::fmt::Display for AxisValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            // A Hamaker constant takes twenty zeros otherwise.
            AxisValue::Number(number) if (f64::MIN_POSITIVE..1e-5).contains(&number.abs()) => {
                write!(f, "{number:e}")
            }
            AxisValue::Number(number) => write!(f, "{number}"),
            AxisValue::Text(text) => f.write_str(text),
        }
    }
}

/// Names of the contributions of uncertainty intervals, in the order in which they are listed.
///
/// `structure` and `head` stand for all discretisation parameters of disk and ramp, and of the head, changed together.
pub const CONTRIBUTIONS: [&str; 11] = [
    "search",
    "head",
    "head_tolerance",
    "coupling_tolerance",
    "suspension_modes",
    "structure",
    "disk_modes",
    "structure_step",
    "ramp_mesh",
    "film_correction",
    "film_grid",
];

/// One source of a row's uncertainty interval, G.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contribution {
    /// Below the highest survivor, G.
    pub low_g: f64,
    /// Above the highest survivor, G.
    pub high_g: f64,
    /// Safety factor in both: 1 for a bound, 1.25 where the formal order was observed, else 3.
    pub factor: f64,
}

/// Critical shock of one point.
///
/// The reported value `a_crit_g` is the middle of the uncertainty interval, of half-width `uncertainty_g`, or of the bracket
/// where there is no interval. `failed_g` is the lowest failing amplitude in the evidence, `survived_g` the highest surviving
/// one below it.
#[derive(Clone, Debug, PartialEq)]
pub struct PointSummary {
    /// Name of the ramp model.
    pub ramp: String,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign of the shock.
    pub sign: Sign,
    /// Values of the study's further axes, in the order of [`Summary::axes`].
    pub axes: Vec<AxisValue>,
    /// Critical shock as it is reported, G; `None` unless bracketed.
    pub a_crit_g: Option<f64>,
    /// Half-width of the uncertainty interval, G; `None` where it was not computed.
    pub uncertainty_g: Option<f64>,
    /// Change of the critical shock with half the minimum film height, G; no part of the interval. `None` where the clearance
    /// called failure is above twice that height, or it was not computed.
    pub half_min_height_g: Option<f64>,
    /// Highest survivor below the lowest failure, G.
    pub survived_g: Option<f64>,
    /// Lowest failure, G.
    pub failed_g: Option<f64>,
    /// Contributions to the interval, by name; they add up, below and above `survived_g`.
    pub contributions: Vec<(String, Contribution)>,
    /// Refinement levels of this answer beyond the study's resolution; empty: none.
    pub levels: String,
    /// Amplitude at which the disk first touches the ramp within the window, G.
    pub onset_g: Option<f64>,
    /// Simulations of the canonical sequence.
    pub runs: u64,
    /// How the search ended.
    pub status: Status,
    /// Flags, sorted.
    pub flags: Vec<Flag>,
    /// Every (survivor, next higher failure) pair of the evidence, G, ascending.
    pub brackets_g: Vec<[f64; 2]>,
    /// Lower end of what was searched: below it the no-ramp answer or nothing is known, G.
    pub scanned_from_g: Option<f64>,
    /// Largest untested step between survivors from there to `survived_g`, per cent.
    pub largest_gap_pct: Option<f64>,
}

impl PointSummary {
    /// Bracketed, and not finished since its uncertainty is missing.
    pub fn lacks_uncertainty(&self) -> bool {
        self.status == Status::Open && self.survived_g.and(self.failed_g).is_some()
    }

    /// The critical shock, or the bound that is known of it, G.
    pub fn known_g(&self) -> Option<f64> {
        match self.status {
            Status::Ok => self.a_crit_g,
            Status::BelowRange => self.failed_g,
            Status::AboveRange | Status::Undecided | Status::Open => self.survived_g,
        }
    }

    /// Where the search has the critical shock, G.
    pub fn bracket_g(&self) -> Option<[f64; 2]> {
        match self.status {
            Status::Ok => Some([self.survived_g?, self.failed_g?]),
            Status::AboveRange => Some([self.survived_g?, f64::INFINITY]),
            Status::BelowRange => Some([0.0, self.failed_g?]),
            Status::Undecided | Status::Open => None,
        }
    }

    /// Whether it has an uncertainty interval with every contribution.
    pub fn has_whole_interval(&self) -> bool {
        self.uncertainty_g.is_some() && !self.flags.contains(&Flag::ContributionMissing)
    }

    /// Uncertainty interval, G; a bound has its bracket alone.
    pub fn interval_g(&self) -> Option<[f64; 2]> {
        if self.status != Status::Ok {
            return self.bracket_g();
        }
        let (middle_g, half_g) = (self.a_crit_g?, self.uncertainty_g?);
        Some([middle_g - half_g, middle_g + half_g])
    }
}

/// Totals over all points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Totals {
    /// Points of the study.
    pub points: u64,
    /// Bracketed.
    pub ok: u64,
    /// Above the range.
    pub above_range: u64,
    /// Below the range.
    pub below_range: u64,
    /// Without a bracket for want of verdicts.
    pub undecided: u64,
    /// Not ended.
    pub open: u64,
    /// Simulations of the canonical sequences.
    pub runs: u64,
    /// Of these without verdict.
    pub undecided_runs: u64,
    /// Of these for the uncertainty intervals.
    pub uncertainty_runs: u64,
    /// Work of all runs.
    pub cost: RunCost,
    /// Work of those for the uncertainty intervals.
    pub uncertainty_cost: RunCost,
    /// Film solves times film unknowns, summed over all runs.
    pub film_work: u64,
    /// The same over the runs for the uncertainty intervals.
    pub uncertainty_film_work: u64,
}

impl Totals {
    /// Totals of these rows and of the simulations of their sequences.
    pub fn of<'a>(
        points: &[PointSummary],
        runs: impl IntoIterator<Item = (Purpose, &'a ProbeResult)>,
    ) -> Totals {
        let mut totals = Totals {
            points: points.len() as u64,
            ..Totals::default()
        };
        for point in points {
            *match point.status {
                Status::Ok => &mut totals.ok,
                Status::AboveRange => &mut totals.above_range,
                Status::BelowRange => &mut totals.below_range,
                Status::Undecided => &mut totals.undecided,
                Status::Open => &mut totals.open,
            } += 1;
        }
        for (purpose, run) in runs {
            let work = run.cost.film_solves * run.cost.film_unknowns;
            totals.film_work += work;
            if purpose == Purpose::Uncertainty {
                totals.uncertainty_runs += 1;
                totals.uncertainty_cost.add(&run.cost);
                totals.uncertainty_film_work += work;
            }
            totals.runs += 1;
            totals.undecided_runs += u64::from(matches!(run.verdict, Verdict::Undecided { .. }));
            totals.cost.add(&run.cost);
        }
        totals
    }
}

/// Table of a study's critical shocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Name of the study.
    pub study: String,
    /// Digest of the study.
    pub digest: String,
    /// Names of the further axes.
    pub axes: Vec<String>,
    /// Rows in the study's order.
    pub points: Vec<PointSummary>,
    /// Totals.
    pub totals: Totals,
}

struct Row<'a> {
    axes: &'a [String],
    point: &'a PointSummary,
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let point = self.point;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("ramp", &point.ramp)?;
        map.serialize_entry("pulse_ms", &point.pulse_ms)?;
        map.serialize_entry("sign", point.sign.as_str())?;
        for (name, value) in self.axes.iter().zip(&point.axes) {
            map.serialize_entry(name, value)?;
        }
        map.serialize_entry("a_crit_g", &point.a_crit_g)?;
        map.serialize_entry("uncertainty_g", &point.uncertainty_g)?;
        map.serialize_entry("half_min_height_g", &point.half_min_height_g)?;
        map.serialize_entry("survived_g", &point.survived_g)?;
        map.serialize_entry("failed_g", &point.failed_g)?;
        map.serialize_entry("contributions", &Contributions(&point.contributions))?;
        map.serialize_entry("levels", &point.levels)?;
        map.serialize_entry("onset_g", &point.onset_g)?;
        map.serialize_entry("runs", &point.runs)?;
        map.serialize_entry("status", &point.status)?;
        map.serialize_entry("flags", &point.flags)?;
        map.serialize_entry("brackets_g", &point.brackets_g)?;
        map.serialize_entry("scanned_from_g", &point.scanned_from_g)?;
        map.serialize_entry("largest_gap_pct", &point.largest_gap_pct)?;
        map.end()
    }
}

struct Contributions<'a>(&'a [(String, Contribution)]);

impl Serialize for Contributions<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(
            self.0
                .iter()
                .map(|(name, contribution)| (name, contribution)),
        )
    }
}

impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rows: Vec<Row<'_>> = self
            .points
            .iter()
            .map(|point| Row {
                axes: &self.axes,
                point,
            })
            .collect();
        let mut map = serializer.serialize_map(Some(4))?;
        map.serialize_entry("study", &self.study)?;
        map.serialize_entry("digest", &self.digest)?;
        map.serialize_entry("points", &rows)?;
        map.serialize_entry("totals", &self.totals)?;
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_carry_their_axes_between_sign_and_answer_and_nulls_for_what_is_missing() {
        let summary = Summary {
            study: "s".into(),
            digest: "d".into(),
            axes: vec!["clearance_um".into()],
            points: vec![PointSummary {
                ramp: "rigid".into(),
                pulse_ms: 0.5,
                sign: Sign::Minus,
                axes: vec![AxisValue::Number(60.0)],
                a_crit_g: None,
                uncertainty_g: None,
                half_min_height_g: None,
                survived_g: Some(2000.0),
                failed_g: None,
                contributions: vec![],
                levels: String::new(),
                onset_g: None,
                runs: 3,
                status: Status::AboveRange,
                flags: vec![Flag::NonMonotone],
                brackets_g: vec![],
                scanned_from_g: None,
                largest_gap_pct: None,
            }],
            totals: Totals::default(),
        };
        let text = serde_json::to_string(&summary).expect("serialises");
        assert!(text.starts_with(
            r#"{"study":"s","digest":"d","points":[{"ramp":"rigid","pulse_ms":0.5,"sign":"-","clearance_um":60.0,"a_crit_g":null,"uncertainty_g":null,"half_min_height_g":null,"survived_g":2000.0,"failed_g":null,"contributions":{},"levels":"","onset_g":null,"runs":3,"status":"above_range","flags":["non_monotone"]"#
        ), "{text}");
    }
}
