//! A statement's number, and its change with refined discretisation parameters.

use super::catalogue::{CLAIMS, Claim, Source};
use super::critical::Parts;
use super::shocks::Shocks;
use opshock_study::store::summary::Summary;
use serde::{Deserialize, Serialize};

/// One place a statement about critical shocks is tested at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// `2 ms, +`.
    pub at: String,
    /// Its number.
    pub value: f64,
    /// Lowest and highest number that the uncertainty intervals leave possible; `None` without intervals.
    pub uncertainty: Option<[f64; 2]>,
    /// The statement holds there, by the reported values.
    pub holds: bool,
}

impl Part {
    /// Whether the statement's answer there is the same over the whole interval; `None` without an interval.
    pub fn is_beyond_the_uncertainty(&self, claim: &Claim) -> Option<bool> {
        self.uncertainty.map(|uncertainty| {
            uncertainty
                .iter()
                .all(|&end| claim.admits(end) == self.holds)
        })
    }
}

/// The number of a claim in one setting.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The number; `None` when there is none, as the time of a failure that does not come.
    pub value: Option<f64>,
    /// The statement holds.
    pub holds: bool,
    /// Places it was tested at, for statements about many.
    pub parts: Vec<Part>,
    /// What else a reader wants to see.
    pub note: String,
}

/// What every claim finds; `None` for those whose source is missing. In the order of [`CLAIMS`].
pub fn findings(shocks: &Shocks, critical: Option<&Summary>) -> Vec<Option<Finding>> {
    CLAIMS
        .iter()
        .map(|claim| match claim.source {
            Source::DiskAndRamp(number) | Source::Shocks(number) => {
                let (value, note) = number(shocks);
                let value = value.filter(|value| value.is_finite());
                Some(Finding {
                    value,
                    holds: value.is_some_and(|value| claim.admits(value)),
                    parts: Vec::new(),
                    note,
                })
            }
            Source::Critical(parts) => of_parts(claim, parts(critical?)),
        })
        .collect()
}

/// The number of a statement about many places: that of the worst place.
pub fn of_parts(claim: &Claim, Parts { places, note }: Parts) -> Option<Finding> {
    let parts: Vec<Part> = places
        .into_iter()
        .map(|(at, value, uncertainty)| Part {
            at,
            value,
            uncertainty,
            holds: claim.admits(value),
        })
        .collect();
    let worst = parts
        .iter()
        .min_by(|a, b| claim.margin(a.value).total_cmp(&claim.margin(b.value)))?;
    let holding = parts.iter().filter(|part| part.holds).count();
    let aside = if note.is_empty() { "" } else { "; " };
    Some(Finding {
        value: Some(worst.value),
        holds: worst.holds,
        note: format!("holds at {holding} of {} places{aside}{note}", parts.len()),
        parts,
    })
}

/// How a number changes with refined discretisation parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Largest change, in the claim's unit.
    pub change: Option<f64>,
    /// Discretisation parameter that made it.
    pub discretisation: String,
    /// Discretisation parameters with which the answer changes.
    pub turns: Vec<String>,
}

/// Compares the number of one statement with those of refined settings, each with its parameter's name.
pub fn spread(base: &Finding, finer: &[(String, Finding)]) -> Spread {
    let mut spread = Spread::default();
    for (discretisation, found) in finer {
        if found.holds != base.holds {
            spread.turns.push(discretisation.clone());
        }
        if let (Some(a), Some(b)) = (base.value, found.value) {
            let change = (b - a).abs();
            if spread.change.is_none_or(|known| change > known) {
                spread.change = Some(change);
                spread.discretisation.clone_from(discretisation);
            }
        }
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(value: f64, holds: bool) -> Finding {
        Finding {
            value: Some(value),
            holds,
            ..Finding::default()
        }
    }

    #[test]
    fn the_spread_is_the_largest_change_and_names_every_discretisation_that_turns_the_answer() {
        let finer = [
            ("a".to_owned(), found(1.25, true)),
            ("b".to_owned(), found(0.5, false)),
            ("c".to_owned(), found(0.75, false)),
        ];
        let spread = spread(&found(1.0, true), &finer);
        assert_eq!(spread.change, Some(0.5));
        assert_eq!(spread.discretisation, "b");
        assert_eq!(spread.turns, ["b", "c"]);
    }

    #[test]
    fn the_worst_part_speaks_for_all_and_a_uncertainty_across_the_bound_decides_nothing() {
        let claim = CLAIMS
            .iter()
            .find(|claim| claim.id == "deformable_above_rigid")
            .expect("in the catalogue");
        let parts = vec![
            ("1 ms, +".to_owned(), 1.04, Some([0.9, 1.2])),
            ("2 ms, +".to_owned(), 1.5, Some([1.2, 1.8])),
            ("3 ms, +".to_owned(), 0.97, Some([0.9, 0.99])),
        ];
        let found = of_parts(claim, parts.into()).expect("parts");
        assert_eq!(found.value, Some(0.97));
        assert!(!found.holds);
        let beyond: Vec<_> = found
            .parts
            .iter()
            .map(|part| part.is_beyond_the_uncertainty(claim))
            .collect();
        assert_eq!(beyond, [Some(false), Some(true), Some(true)]);
        assert_eq!(of_parts(claim, Parts::default()), None);
    }
}
