//! Arranges a match (parameters that make observations true) as tables, for every format.

use std::fmt::Write as _;

use crate::draws::Share;
use crate::matching::{MatchAnswer, MatchingSet};

/// Conflicts and further measurements that tables show.
const SHOWN: usize = 40;

/// A heading with a table under it.
pub(super) struct Table {
    pub(super) title: &'static str,
    /// What a reader gets from it.
    pub(super) words: String,
    pub(super) head: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

/// The answer for a terminal.
pub fn match_text(answer: &MatchAnswer) -> String {
    let mut text = summary(answer) + "\n";
    for table in tables(answer) {
        let _ = write!(text, "\n{}\n", table.title);
        let all: Vec<&Vec<String>> = std::iter::once(&table.head).chain(&table.rows).collect();
        let widths: Vec<usize> = (0..table.head.len())
            .map(|c| {
                all.iter()
                    .map(|row| row[c].chars().count())
                    .max()
                    .unwrap_or(0)
            })
            .collect();
        for row in all {
            let cells = row
                .iter()
                .zip(&widths)
                .map(|(cell, width)| format!("{cell:<width$}"));
            let _ = writeln!(
                text,
                "  {}",
                cells.collect::<Vec<_>>().join("  ").trim_end()
            );
        }
    }
    text.trim_end().to_owned()
}

pub(super) fn summary(answer: &MatchAnswer) -> String {
    let [held, of] = answer.held();
    let mut text = format!("{}: ", answer.name);
    text += &match answer.n_matching {
        0 => format!(
            "no parameter set makes all {of} observations true; the nearest makes {held} true"
        ),
        n => format!("{n} parameter sets make all {of} observations true"),
    };
    let _ = write!(
        text,
        " ({} sets tried). Share of the prior that makes all true: {}; that nothing rules out: {}.",
        answer.tried,
        share(&answer.all),
        share(&answer.not_ruled_out)
    );
    if !answer.is_complete {
        text += " The search was interrupted: these are the numbers so far.";
    }
    text
}

fn share(share: &Share) -> String {
    let percent = |x: f64| short(100.0 * x);
    let [low, high] = share.interval;
    match (share.with, share.of) {
        (_, 0) => "not asked".to_owned(),
        (0, n) => format!("none of {n}, less than {} % with 95 %", percent(high)),
        (k, n) => {
            let own = percent(k as f64 / n as f64);
            format!(
                "{own} % ({k} of {n}, 95 %: {} to {})",
                percent(low),
                percent(high)
            )
        }
    }
}

/// Four digits.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if size != 0.0 && !(1e-4..1e6).contains(&size) => format!("{rounded:e}"),
        _ => format!("{rounded}"),
    }
}

pub(super) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), short)
}

fn range(ends: Option<[Option<f64>; 2]>) -> String {
    match ends {
        None => "not observed".to_owned(),
        Some([Some(low), Some(high)]) if low == high => short(low),
        Some([Some(low), Some(high)]) => format!("{} to {}", short(low), short(high)),
        Some([Some(low), None]) => format!("at least {}", short(low)),
        Some([None, Some(high)]) => format!("at most {}", short(high)),
        Some([None, None]) => "any number".to_owned(),
    }
}

pub(super) fn words(list: &[&str]) -> Vec<String> {
    list.iter().map(|word| (*word).to_owned()).collect()
}

pub(super) fn tables(answer: &MatchAnswer) -> Vec<Table> {
    let observations = Table {
        title: "Observations",
        words: "Each with the share of the prior that makes it true, and with the best set: number, and margin (distance to the \
                nearer end of the range) in units of the numerical uncertainty."
            .to_owned(),
        head: words(&["observation", "true with", "numerical uncertainty", "share of the prior", "best set", "margin"]),
        rows: answer
            .observations
            .iter()
            .map(|one| {
                vec![
                    one.name.clone(),
                    range(one.range),
                    short(one.numerical_uncertainty),
                    one.share.as_ref().map_or_else(|| "-".to_owned(), share),
                    maybe(one.best),
                    maybe(one.best_margin),
                ]
            })
            .collect(),
    };
    let parameters = Table {
        title: "Parameters",
        words: "Ranges before, and what the sets that nothing rules out leave of them.".to_owned(),
        head: words(&["parameter", "before", "after", "left of it (%)", "source"]),
        rows: answer
            .parameters
            .iter()
            .map(|one| {
                let to = |ends: &[String; 2]| format!("{} to {}", ends[0], ends[1]);
                let left = one
                    .after_probability
                    .map(|[low, high]| 100.0 * (high - low));
                let after = one
                    .after
                    .as_ref()
                    .map_or_else(|| "too few plausible sets to say".to_owned(), to);
                vec![
                    one.name.clone(),
                    to(&one.before),
                    after,
                    maybe(left),
                    one.source.clone(),
                ]
            })
            .collect(),
    };
    let mut all = vec![observations, parameters];
    let sets: Vec<&MatchingSet> = answer.matching.iter().chain(&answer.nearest).collect();
    if !sets.is_empty() {
        let mut head = words(&["set", "smallest margin", "decided by"]);
        head.extend(answer.parameters.iter().map(|one| one.name.clone()));
        let row = |(place, set): (usize, &&MatchingSet)| {
            let mut row = vec![
                (place + 1).to_string(),
                maybe(set.smallest_margin),
                set.decided_by.clone(),
            ];
            row.extend(
                set.values
                    .iter()
                    .map(|value| value.parse().map_or_else(|_| value.clone(), short)),
            );
            row
        };
        all.push(Table {
            title: "Matching sets",
            words: match &answer.nearest {
                Some(nearest) => format!(
                    "None; the nearest one does not have: {}.",
                    nearest.fails.join(", ")
                ),
                None => {
                    "The one with the largest smallest margin, then sets as far apart as can be."
                        .to_owned()
                }
            },
            head,
            rows: sets.iter().enumerate().map(row).collect(),
        });
    }
    if let Some(each) = &answer.best_of_each {
        let row = |(value, tried, best): &(String, u64, Option<MatchingSet>)| {
            let count = |short: fn(&MatchingSet) -> &Vec<String>| {
                best.as_ref().map_or_else(
                    || "-".to_owned(),
                    |best| (answer.ranged() - short(best).len()).to_string(),
                )
            };
            let lacking = best.as_ref().map(|best| best.falls_short.join(", "));
            vec![
                value.clone(),
                tried.to_string(),
                count(|best| &best.fails),
                count(|best| &best.falls_short),
                lacking.unwrap_or_default(),
            ]
        };
        all.push(Table {
            title: "The best set of each choice",
            words: format!(
                "A search of its own for each choice of {}: observations that hold, and that hold by their numerical uncertainty.",
                each.parameter
            ),
            head: vec![
                each.parameter.clone(),
                "sets tried".to_owned(),
                "hold".to_owned(),
                "by their numerical uncertainty".to_owned(),
                "all but".to_owned(),
            ],
            rows: each.choices.iter().map(row).collect(),
        });
    }
    if !answer.conflicts.is_empty() {
        all.push(Table {
            title: "Conflicts",
            words: "Smallest groups of observations that no set satisfies together; the bound is for independent draws of the \
                    prior, for a group that was thought of before. Searches are those for the group alone, none of which found \
                    a set."
                .to_owned(),
            head: words(&["observations", "sets tried", "share of the prior", "searches"]),
            rows: answer
                .conflicts
                .iter()
                .take(SHOWN)
                .map(|one| {
                    let searches = match one.searches {
                        0 => "none".to_owned(),
                        n => format!("{n}, {} sets", one.searched),
                    };
                    vec![one.observations.join(", "), one.tried.to_string(), share(&one.share), searches]
                })
                .collect(),
        });
    }
    if !answer.next.is_empty() {
        all.push(Table {
            title: "What to measure next",
            words: "Share of the sets that nothing rules out which would be left, on average, if the number were measured with the \
                    uncertainty it has here."
                .to_owned(),
            head: words(&["number", "expected to be left (%)"]),
            rows: answer
                .next
                .iter()
                .take(SHOWN)
                .map(|one| vec![one.observation.clone(), short(100.0 * one.expected_left)])
                .collect(),
        });
    }
    all
}
