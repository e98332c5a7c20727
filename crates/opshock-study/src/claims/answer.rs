//! A claim's line in the table: number, uncertainty, answer.

use super::catalogue::{CLAIMS, Claim, Source};
use super::finding::{Finding, Spread, spread};
use super::sensitivity::{Rests, Sensitivity};
use serde::Serialize;

/// The answer to a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// It holds, everywhere it was tried.
    Holds,
    /// It does not hold, wherever it was tried.
    DoesNot,
    /// It holds for some of what was tried.
    Depends,
    /// The table of critical shocks is missing.
    NotAsked,
}

impl Answer {
    /// Words of tables.
    pub fn words(self) -> &'static str {
        match self {
            Answer::Holds => "holds",
            Answer::DoesNot => "does not hold",
            Answer::Depends => "depends",
            Answer::NotAsked => "not asked",
        }
    }
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClaimRow {
    /// Stable name.
    pub id: &'static str,
    /// Section and figure.
    pub place: &'static str,
    /// The paper's words, shortened.
    pub paper: &'static str,
    /// What the number is.
    pub number: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Between which the statement holds, in words.
    pub holds_with: String,
    /// What was found with the study's own values.
    pub finding: Option<Finding>,
    /// How the number moves with finer knobs; for shocks.
    pub spread: Option<Spread>,
    /// Answer.
    pub answer: Answer,
    /// On what it depends, with the range in which it holds.
    pub depends_on: Vec<String>,
    /// Places whose answer the error bars leave no doubt about, and all; for critical shocks.
    pub beyond_the_bars: Option<[usize; 2]>,
}

/// The table. `finer` are the findings with one knob of accuracy finer each, by its name.
pub fn rows(
    own: Vec<Option<Finding>>,
    finer: &[(String, Vec<Option<Finding>>)],
    sensitivity: Option<&Sensitivity>,
) -> Vec<ClaimRow> {
    CLAIMS
        .iter()
        .zip(own)
        .enumerate()
        .map(|(place, (claim, finding))| {
            let of_claim: Vec<(String, Finding)> = finer
                .iter()
                .filter_map(|(knob, found)| Some((knob.clone(), found[place].clone()?)))
                .collect();
            row(claim, finding, &of_claim, sensitivity)
        })
        .collect()
}

fn row(
    claim: &Claim,
    finding: Option<Finding>,
    finer: &[(String, Finding)],
    sensitivity: Option<&Sensitivity>,
) -> ClaimRow {
    let mut depends_on = Vec::new();
    let mut turned = None;
    if let Some(found) = &finding {
        depends_on.extend(places(found));
        if !matches!(claim.source, Source::Critical(_)) {
            let moved = spread(found, finer);
            if !moved.turns.is_empty() {
                depends_on.push(format!(
                    "accuracy: turns with finer {}",
                    moved.turns.join(", ")
                ));
            }
            turned = Some(moved);
        }
        let rests = sensitivity
            .and_then(|all| all.row(claim.id))
            .map(|row| row.rests());
        if let Some(Rests::On(parameters)) = rests {
            depends_on.extend(parameters);
        }
    }
    let answer = match &finding {
        None => Answer::NotAsked,
        Some(_) if !depends_on.is_empty() => Answer::Depends,
        Some(found) if found.holds => Answer::Holds,
        Some(_) => Answer::DoesNot,
    };
    let beyond_the_bars = finding
        .as_ref()
        .filter(|found| !found.parts.is_empty())
        .map(|found| {
            let sure = found
                .parts
                .iter()
                .filter(|part| part.is_beyond_the_bar(claim) == Some(true));
            [sure.count(), found.parts.len()]
        });
    ClaimRow {
        id: claim.id,
        place: claim.place,
        paper: claim.words,
        number: claim.number,
        unit: claim.unit,
        holds_with: claim.bounds_words(),
        finding,
        spread: turned,
        answer,
        depends_on,
        beyond_the_bars,
    }
}

/// Where a statement about many critical shocks holds, when it does so in some places only.
fn places(found: &Finding) -> Option<String> {
    let list = |wanted: bool| -> Vec<&str> {
        let parts = found.parts.iter().filter(|part| part.holds == wanted);
        parts.map(|part| part.at.as_str()).collect()
    };
    let (holding, failing) = (list(true), list(false));
    (!holding.is_empty() && !failing.is_empty()).then(|| {
        format!(
            "pulse: holds at {}; not at {}",
            holding.join("; "),
            failing.join("; ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::finding::Part;

    fn claim(id: &str) -> &'static Claim {
        CLAIMS.iter().find(|claim| claim.id == id).expect("a claim")
    }

    #[test]
    fn a_statement_that_holds_in_some_places_depends_on_the_pulse() {
        let part = |at: &str, value: f64, bar| Part {
            at: at.into(),
            value,
            bar: Some(bar),
            holds: value >= 1.0,
        };
        let found = Finding {
            value: Some(0.9),
            holds: false,
            parts: vec![
                part("1 ms, +", 1.2, [1.1, 1.3]),
                part("2 ms, +", 0.9, [0.8, 1.1]),
            ],
            note: String::new(),
        };
        let row = row(claim("deformable_above_rigid"), Some(found), &[], None);
        assert_eq!(row.answer, Answer::Depends);
        assert_eq!(row.depends_on, ["pulse: holds at 1 ms, +; not at 2 ms, +"]);
        assert_eq!(row.beyond_the_bars, Some([1, 2]));
    }

    #[test]
    fn an_answer_that_turns_with_accuracy_is_no_answer() {
        let found = |value: f64, holds| Finding {
            value: Some(value),
            holds,
            ..Finding::default()
        };
        let finer = [("disk_modes".to_owned(), found(1.2, false))];
        let row = row(claim("rigid_touch"), Some(found(1.0, true)), &finer, None);
        assert_eq!(row.answer, Answer::Depends);
        assert_eq!(row.depends_on, ["accuracy: turns with finer disk_modes"]);
    }
}
