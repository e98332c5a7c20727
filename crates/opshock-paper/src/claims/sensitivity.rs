//! Computes how each statement depends on what the paper does not print, one parameter at a time.
//!
//! Every parameter is moved to both ends of its range with all others as in the study. The shocks
//! are run at the study's resolution; the critical shocks are found again by a coarse search
//! ([`coarse_sets`]). A ramp whose scenes do not change is not simulated again.

use super::catalogue::{CLAIMS, Claim};
use super::finding::{Finding, findings};
use super::parameter::{parameters, resolved};
use super::shocks::Shocks;
use opshock_study::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use opshock_study::store::summary::{PointSummary, Summary};
use opshock_study::study::{Ramp, SetArg, Study, StudyErrors};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Settings of the coarse search: two widths, no uncertainty intervals, no monotonicity scan, a film too coarse
/// for the value (negative shocks without a ramp come out a quarter high) and good for comparing.
pub fn coarse_sets() -> Vec<String> {
    [
        "outputs=[\"critical_shock\"]",
        "pulse.widths_ms=[0.5, 2.0]",
        "pulse.signs=[\"+\", \"-\"]",
        "ramp.models=[\"none\", \"rigid\", \"deformable\"]",
        "resolution.film_cells=300",
        "search.tolerance_pct=2.0",
        "search.monotonicity_scan=\"off\"",
        "search.uncertainty=false",
        "output.keep_histories=\"none\"",
    ]
    .map(String::from)
    .to_vec()
}

/// What the six runs have to answer.
pub fn shock_sets() -> Vec<String> {
    vec![
        "outputs=[\"min_clearance\", \"slider_attitude\", \"dimple_force\", \"disk_displacement\", \
         \"ramp_displacement\", \"contact_force\"]"
            .to_owned(),
    ]
}

/// One end of one parameter's range.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Parameter's name.
    pub parameter: &'static str,
    /// First key.
    pub key: &'static str,
    /// Value of the first key there.
    pub value: f64,
    /// What is set.
    pub sets: Vec<String>,
    /// Upper end.
    pub is_upper: bool,
}

impl Variant {
    /// Both ends of every parameter that the study has.
    pub fn all(study: &Study) -> Vec<Variant> {
        let table = resolved(study);
        let mut variants = Vec::new();
        for parameter in parameters() {
            for (place, changed) in parameter.ends(&table).into_iter().flatten().enumerate() {
                variants.push(Variant {
                    parameter: parameter.name,
                    key: parameter.keys[0],
                    value: changed.value,
                    sets: changed.sets,
                    is_upper: place == 1,
                });
            }
        }
        variants
    }

    /// Name of a file or folder: `ramp-body-mass-high`.
    pub fn stem(&self) -> String {
        let end = if self.is_upper { "high" } else { "low" };
        format!("{}-{end}", self.parameter.replace(' ', "-"))
    }
}

/// A study read again with the user's settings and, before these, more.
///
/// # Errors
///
/// A value at the end of a range that the study refuses.
pub fn with_sets(study: &Study, user: &[SetArg], sets: &[&[String]]) -> Result<Study, StudyErrors> {
    let mut all = user.to_vec();
    for text in sets.iter().copied().flatten() {
        let set = SetArg::parse(text)
            .unwrap_or_else(|error| unreachable!("{error}: written by this program"));
        all.retain(|known| known.key != set.key);
        all.push(set);
    }
    Study::from_path(&study.path, &all)
}

/// Ramps of `changed` that have a point whose scene is not that of `base`.
pub fn touched_ramps(base: &Study, changed: &Study) -> Vec<Ramp> {
    let is_known = |ramp: Ramp| {
        let of = |study: &Study| -> Vec<_> {
            let points = study.points.iter().filter(|point| point.ramp == ramp);
            points.map(|point| point.id).collect()
        };
        of(base) == of(changed)
    };
    let ramps = changed.ramps.iter().copied();
    ramps.filter(|&ramp| !is_known(ramp)).collect()
}

/// The rows of `base` with those of `changed` in their places.
pub fn merged(base: &Summary, changed: &Summary) -> Summary {
    let same = |a: &PointSummary, b: &PointSummary| {
        a.ramp == b.ramp && a.pulse_ms == b.pulse_ms && a.sign == b.sign
    };
    let mut merged = base.clone();
    for point in &mut merged.points {
        if let Some(newer) = changed.points.iter().find(|other| same(other, point)) {
            point.clone_from(newer);
        }
    }
    merged
}

/// What a claim finds at one end of a parameter's range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// Parameter.
    pub parameter: String,
    /// First key.
    pub key: String,
    /// Its value in the study.
    pub base: f64,
    /// Its value here.
    pub value: f64,
    /// Number and answer; `None` when the drive has no steady flight here, or no critical shock.
    pub found: Option<Found>,
}

/// Number and answer alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The number.
    pub value: Option<f64>,
    /// Whether the statement holds.
    pub holds: bool,
}

impl From<&Finding> for Found {
    fn from(finding: &Finding) -> Self {
        Self {
            value: finding.value,
            holds: finding.holds,
        }
    }
}

/// A claim over all parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Claim.
    pub claim: String,
    /// With the study's own values.
    pub base: Option<Found>,
    /// At the ends of every range.
    pub sides: Vec<Side>,
}

impl Row {
    /// The parameters that change the claim's answer `own` (with the study's own values), each with where it
    /// holds. `None` where nothing was tried.
    pub fn turning(&self, own: bool) -> Option<Vec<String>> {
        let base = self.base?;
        let mut turning = Vec::new();
        if base.holds != own {
            turning.push(format!(
                "coarse search of the sensitivity: {}",
                if base.holds { "holds" } else { "does not hold" }
            ));
        }
        let mut ranges: BTreeMap<usize, (String, Vec<(f64, bool)>)> = BTreeMap::new();
        for (place, side) in self.sides.iter().enumerate() {
            let Some(found) = side.found else { continue };
            let first = self
                .sides
                .iter()
                .position(|other| other.parameter == side.parameter);
            let entry = ranges.entry(first.unwrap_or(place)).or_insert_with(|| {
                let name = format!("{} ({})", side.parameter, side.key);
                (name, vec![(side.base, base.holds)])
            });
            entry.1.push((side.value, found.holds));
        }
        for (name, mut tried) in ranges.into_values() {
            tried.sort_by(|a, b| a.0.total_cmp(&b.0));
            if tried.iter().any(|(_, holds)| *holds != base.holds) {
                let list = |wanted: bool| {
                    let values: Vec<String> = tried
                        .iter()
                        .filter(|(_, holds)| *holds == wanted)
                        .map(|(value, _)| value.to_string())
                        .collect();
                    values.join(", ")
                };
                turning.push(format!(
                    "{name}: holds at {}, not at {}",
                    list(true),
                    list(false)
                ));
            }
        }
        Some(turning)
    }

    /// The claim itself.
    pub fn claim(&self) -> Option<&'static Claim> {
        CLAIMS.iter().find(|claim| claim.id == self.claim)
    }
}

/// What the runs of one variant gave: its shocks and, where they were searched, its critical shocks.
pub type Given = (Shocks, Option<Summary>);

/// Every claim over all parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Digest of the study.
    pub study: String,
    /// Program.
    pub program: String,
    /// Physics versions of structure and head; absent before they were kept.
    #[serde(default)]
    pub physics: Option<[u32; 2]>,
    /// Settings of the coarse search; empty: the critical shocks were left alone.
    pub coarse: Vec<String>,
    /// A row for each claim.
    pub rows: Vec<Row>,
}

impl Sensitivity {
    /// Puts together what the runs gave: shocks and critical shocks of the study and of every
    /// variant, `None` where the drive could not be simulated or the searches were left out.
    pub fn of(
        study: &Study,
        program: &str,
        base: (&Shocks, Option<&Summary>),
        variants: &[(Variant, Option<Given>)],
    ) -> Sensitivity {
        let table = resolved(study);
        let own = findings(base.0, base.1);
        let value_of: BTreeMap<&str, f64> = parameters()
            .into_iter()
            .filter_map(|parameter| Some((parameter.name, parameter.value(&table)?)))
            .collect();
        let changed: Vec<(&Variant, Vec<Option<Finding>>)> = variants
            .iter()
            .map(|(variant, found)| {
                let found = found.as_ref();
                let none = || vec![None; CLAIMS.len()];
                (
                    variant,
                    found.map_or_else(none, |(shocks, table)| findings(shocks, table.as_ref())),
                )
            })
            .collect();
        let rows = CLAIMS
            .iter()
            .zip(own)
            .enumerate()
            .map(|(place, (claim, base))| Row {
                claim: claim.id.into(),
                base: base.as_ref().map(Found::from),
                sides: changed
                    .iter()
                    .map(|(variant, found)| Side {
                        parameter: variant.parameter.into(),
                        key: variant.key.into(),
                        base: value_of.get(variant.parameter).copied().unwrap_or(f64::NAN),
                        value: variant.value,
                        found: found[place].as_ref().map(Found::from),
                    })
                    .collect(),
            });
        Sensitivity {
            study: study.digest_hex(),
            program: program.into(),
            physics: Some([PHYSICS_STRUCTURE, PHYSICS_HEAD]),
            coarse: match base.1 {
                Some(_) => coarse_sets(),
                None => Vec::new(),
            },
            rows: rows.collect(),
        }
    }

    /// Whether it is of this study and of the physics of this program.
    pub fn is_of(&self, study: &Study) -> bool {
        self.study == study.digest_hex() && self.physics == Some([PHYSICS_STRUCTURE, PHYSICS_HEAD])
    }

    /// Row of a claim.
    pub fn row(&self, claim: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.claim == claim)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(parameter: &str, value: f64, holds: Option<bool>) -> Side {
        Side {
            parameter: parameter.into(),
            key: format!("key.{parameter}"),
            base: 10.0,
            value,
            found: holds.map(|holds| Found { value: None, holds }),
        }
    }

    #[test]
    fn a_claim_rests_on_what_turns_it_and_the_range_is_reported() {
        let mut row = Row {
            claim: "pulse".into(),
            base: Some(Found {
                value: None,
                holds: true,
            }),
            sides: vec![
                side("a", 9.0, Some(true)),
                side("a", 11.0, Some(true)),
                side("b", 8.0, Some(true)),
                side("b", 12.0, Some(false)),
                side("c", 5.0, None),
            ],
        };
        let turns = "b (key.b): holds at 8, 10, not at 12".to_owned();
        assert_eq!(row.turning(true), Some(vec![turns.clone()]));
        // The coarse search varies parameters: it cannot answer for a statement that the fine table denies.
        let coarse = "coarse search of the sensitivity: holds".to_owned();
        assert_eq!(row.turning(false), Some(vec![coarse, turns]));
        row.sides.truncate(2);
        assert_eq!(row.turning(true), Some(Vec::new()));
        row.base = None;
        assert_eq!(row.turning(true), None);
    }
}
