//! Makes a statement's row of the table: number, uncertainty, answer.

use super::catalogue::{CLAIMS, Claim, Source};
use super::finding::{Finding, Spread, spread};
use super::sensitivity::Sensitivity;
use serde::Serialize;

/// The answer to a statement, by the study's own values first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// It holds with the study's own values, and with any one discretisation parameter refined and any
    /// one unpublished parameter moved.
    HoldsRobustly,
    /// It holds with the study's own values; what changes the answer is named, or was not measured.
    Holds,
    /// It does not hold with the study's own values, whatever else it holds with.
    DoesNot,
    /// The table of critical shocks is missing.
    NotAsked,
}

impl Answer {
    /// Words of every table and heading.
    pub fn words(self) -> &'static str {
        match self {
            Answer::HoldsRobustly => "holds robustly",
            Answer::Holds => "holds with the study's own values",
            Answer::DoesNot => "does not hold with the study's own values",
            Answer::NotAsked => "not asked",
        }
    }
}

/// How many statements hold with the study's own values, and how many of these robustly.
pub fn tally(rows: &[ClaimRow], has_sensitivity: bool) -> String {
    let count = |answer| rows.iter().filter(|row| row.answer == answer).count();
    let robust = count(Answer::HoldsRobustly);
    let hold = robust + count(Answer::Holds);
    let left = match count(Answer::NotAsked) {
        0 => String::new(),
        left => format!(", {left} are not asked (no table of critical shocks)"),
    };
    let is_untried = |row: &&ClaimRow| row.answer == Answer::Holds && row.depends_on.is_empty();
    let untried = rows.iter().filter(is_untried).count();
    let turn = hold - robust - untried;
    let of_these = match has_sensitivity {
        false => "Whether they do so robustly was not measured (`--sensitivity`).".to_owned(),
        true => format!(
            "Of these {hold}, {robust} hold robustly, also with any one discretisation parameter refined by a \
             step and any one parameter that the paper does not print at either end of its range; \
             {turn} change{}.",
            match untried {
                0 => String::new(),
                _ => format!(", {untried} were not tried (searches left out)"),
            }
        ),
    };
    format!(
        "{} statements: {hold} hold with the study's own values, {} do not{left}. {of_these}",
        rows.len(),
        count(Answer::DoesNot)
    )
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
    /// How the number moves with finer discretisation parameters; for shocks.
    pub spread: Option<Spread>,
    /// Answer.
    pub answer: Answer,
    /// What changes the answer, with where it holds; of one that does not hold, what it holds with.
    pub depends_on: Vec<String>,
    /// Places whose answer is the same over the whole uncertainty interval, and all places; for critical shocks.
    pub beyond_the_uncertainties: Option<[usize; 2]>,
}

/// The table. `finer` are the findings with one discretisation parameter refined each, by its name.
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
                .filter_map(|(discretisation, found)| {
                    Some((discretisation.clone(), found[place].clone()?))
                })
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
    let mut changed = None;
    let turning = finding.as_ref().and_then(|found| {
        let row = sensitivity?.row(claim.id)?;
        row.turning(found.holds)
    });
    if let Some(found) = &finding {
        depends_on.extend(places(found));
        if !matches!(claim.source, Source::Critical(_)) {
            let moved = spread(found, finer);
            if !moved.turns.is_empty() {
                depends_on.push(format!(
                    "resolution: changes with {} refined",
                    moved.turns.join(", ")
                ));
            }
            changed = Some(moved);
        }
        if let Some(turning) = &turning {
            depends_on.extend(turning.iter().cloned());
        }
    }
    let answer = match &finding {
        None => Answer::NotAsked,
        Some(found) if !found.holds => Answer::DoesNot,
        Some(_) if turning.is_some() && depends_on.is_empty() => Answer::HoldsRobustly,
        Some(_) => Answer::Holds,
    };
    let beyond_the_uncertainties = finding
        .as_ref()
        .filter(|found| !found.parts.is_empty())
        .map(|found| {
            let sure = found
                .parts
                .iter()
                .filter(|part| part.is_beyond_the_uncertainty(claim) == Some(true));
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
        spread: changed,
        answer,
        depends_on,
        beyond_the_uncertainties,
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
    use crate::claims::sensitivity::{Found, Row, Side};

    fn claim(id: &str) -> &'static Claim {
        CLAIMS.iter().find(|claim| claim.id == id).expect("a claim")
    }

    fn found(value: f64, holds: bool) -> Finding {
        Finding {
            value: Some(value),
            holds,
            ..Finding::default()
        }
    }

    #[test]
    fn a_statement_that_holds_in_some_places_does_not_hold_and_says_where_it_does() {
        let part = |at: &str, value: f64, uncertainty| Part {
            at: at.into(),
            value,
            uncertainty: Some(uncertainty),
            holds: value >= 1.0,
        };
        let found = Finding {
            parts: vec![
                part("1 ms, +", 1.2, [1.1, 1.3]),
                part("2 ms, +", 0.9, [0.8, 1.1]),
            ],
            ..found(0.9, false)
        };
        let row = row(claim("deformable_above_rigid"), Some(found), &[], None);
        assert_eq!(row.answer, Answer::DoesNot);
        assert_eq!(row.depends_on, ["pulse: holds at 1 ms, +; not at 2 ms, +"]);
        assert_eq!(row.beyond_the_uncertainties, Some([1, 2]));
    }

    /// `rigid_touch` moved to two values of a parameter, by the answers of the sensitivity's own table
    /// and of both ends.
    fn moved(base: bool, ends: [bool; 2]) -> Sensitivity {
        let found = |holds| Some(Found { value: None, holds });
        let side = |value, holds| Side {
            parameter: "mass".into(),
            key: "mass_mg".into(),
            base: 3.0,
            value,
            found: found(holds),
        };
        Sensitivity {
            study: String::new(),
            program: String::new(),
            physics: None,
            coarse: Vec::new(),
            rows: vec![Row {
                claim: "rigid_touch".into(),
                base: found(base),
                sides: vec![side(2.0, ends[0]), side(4.0, ends[1])],
            }],
        }
    }

    #[test]
    fn only_what_holds_with_the_studys_own_values_holds_robustly() {
        let coarse = |word| format!("coarse search of the sensitivity: {word}");
        let turns = "mass (mass_mg): holds at 2, 3, not at 4";
        let cases = [
            (
                true,
                moved(true, [true, true]),
                Answer::HoldsRobustly,
                vec![],
            ),
            (
                true,
                moved(true, [true, false]),
                Answer::Holds,
                vec![turns.to_owned()],
            ),
            // Met by the coarse search wherever it looked, and not by the study itself.
            (
                false,
                moved(true, [true, true]),
                Answer::DoesNot,
                vec![coarse("holds")],
            ),
            (false, moved(false, [false, false]), Answer::DoesNot, vec![]),
            (
                true,
                moved(false, [false, false]),
                Answer::Holds,
                vec![coarse("does not hold")],
            ),
        ];
        let mut rows = Vec::new();
        for (holds, all, answer, depends_on) in cases {
            let one = row(
                claim("rigid_touch"),
                Some(found(1.0, holds)),
                &[],
                Some(&all),
            );
            assert_eq!((one.answer, &one.depends_on), (answer, &depends_on));
            rows.push(one);
        }
        // No parameter moved at all, and an answer that changes with a refined discretisation parameter.
        let own = || Some(found(1.0, true));
        assert_eq!(
            row(claim("rigid_touch"), own(), &[], None).answer,
            Answer::Holds
        );
        let finer = [("disk_modes".to_owned(), found(1.2, false))];
        let all = moved(true, [true, true]);
        let changed = row(claim("rigid_touch"), own(), &finer, Some(&all));
        assert_eq!(changed.answer, Answer::Holds);
        assert_eq!(
            changed.depends_on,
            ["resolution: changes with disk_modes refined"]
        );
        rows.push(row(claim("rigid_touch"), own(), &[], None));

        rows.push(row(claim("rises_none"), None, &[], None));
        assert_eq!(
            tally(&rows, true),
            "7 statements: 4 hold with the study's own values, 2 do not, 1 are not asked (no table of \
             critical shocks). Of these 4, 1 hold robustly, also with any one discretisation parameter \
             refined by a step and any one parameter that the paper does not print at either end of its \
             range; 2 change, 1 were not tried (searches left out)."
        );
    }
}
