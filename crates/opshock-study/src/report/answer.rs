//! The answer of a study in a sentence, and its choices side by side: range of the critical shocks, worst case, and
//! for every axis the value that survives most, with its lead over the others.
//!
//! The worst case of a value is the lowest critical shock of all rows that have it. A lead is significant when the
//! uncertainty intervals of both worst cases do not overlap.

use super::comparison::Significance;
use super::coordinates::{self, is_choice};
use super::table::{aligned, uncertainty_words};
use crate::store::summary::{AxisValue, PointSummary, Status, Summary};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// What a table of critical shocks says in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer<'a> {
    summary: &'a Summary,
    /// The axes to choose from, those with most numbers first, each with its values from best to worst.
    pub axes: Vec<Choice<'a>>,
}

/// An axis of which a designer chooses a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice<'a> {
    /// Its column.
    pub name: &'a str,
    /// Values, best first.
    pub ranks: Vec<Rank<'a>>,
}

/// A value of an axis and its worst case.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank<'a> {
    /// Value.
    pub value: AxisValue,
    /// The row with the lowest critical shock.
    pub worst: &'a PointSummary,
    /// Rows with this value that have no answer.
    pub unanswered: usize,
}

/// The row with the lowest critical shock.
pub(super) fn worst<'a>(
    points: impl IntoIterator<Item = &'a PointSummary>,
) -> Option<&'a PointSummary> {
    let known = points
        .into_iter()
        .filter_map(|point| Some((point, point.known_g()?)));
    known
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(point, _)| point)
}

fn grams(point: &PointSummary) -> String {
    let value = point.known_g().unwrap_or(f64::NAN);
    match point.status {
        Status::AboveRange => format!("more than {value:.1} G"),
        Status::BelowRange => format!("less than {value:.1} G"),
        _ => format!("{value:.1} G"),
    }
}

fn significance_words(significance: Significance) -> &'static str {
    match significance {
        Significance::BeyondUncertainties => "beyond the uncertainty intervals",
        Significance::WithinUncertainties => "within the uncertainty intervals: not significant",
        Significance::WithinBrackets => "within the brackets of the search: not significant",
        Significance::BeyondBrackets => {
            "beyond the brackets of the search; without uncertainty intervals it is not known whether it is significant"
        }
        Significance::Unknown => "not known to be significant",
    }
}

impl<'a> Answer<'a> {
    /// Reads a table.
    pub fn of(summary: &'a Summary) -> Self {
        let names = coordinates::names(summary);
        let mut axes: Vec<(usize, Choice<'a>)> = Vec::new();
        for place in (0..names.len()).filter(|&place| is_choice(summary, place)) {
            let values = coordinates::values(summary, place);
            let mut ranks: Vec<Rank<'a>> = Vec::new();
            for value in &values {
                let rows = summary.points.iter();
                let rows: Vec<&PointSummary> = rows
                    .filter(|point| coordinates::value(point, place) == *value)
                    .collect();
                let unanswered = rows.iter().filter(|row| row.known_g().is_none()).count();
                if let Some(worst) = worst(rows) {
                    ranks.push(Rank {
                        value: value.clone(),
                        worst,
                        unanswered,
                    });
                }
            }
            ranks.sort_by(|a, b| {
                let of = |rank: &Rank<'_>| rank.worst.known_g().unwrap_or(f64::NAN);
                of(b).total_cmp(&of(a))
            });
            let numbers = values.iter().filter_map(coordinates::number).count();
            if ranks.len() > 1 {
                let name = names[place];
                axes.push((numbers, Choice { name, ranks }));
            }
        }
        axes.sort_by_key(|(numbers, _)| std::cmp::Reverse(*numbers));
        Self {
            summary,
            axes: axes.into_iter().map(|(_, choice)| choice).collect(),
        }
    }

    /// The first sentence has range, worst case and the first choice; one more follows for every other choice.
    pub fn sentences(&self) -> Vec<String> {
        let summary = self.summary;
        let known = || {
            summary
                .points
                .iter()
                .filter(|point| point.known_g().is_some())
        };
        let Some(lowest) = worst(known()) else {
            return vec!["No critical shock is known yet.".to_owned()];
        };
        let highest = known().max_by(|a, b| {
            let of = |point: &PointSummary| point.known_g().unwrap_or(f64::NAN);
            of(a).total_cmp(&of(b))
        });
        let highest = highest.unwrap_or(lowest);
        let is_alone =
            |point: &PointSummary| point.status == Status::Ok && point.uncertainty_g.is_none();
        let has_intervals = known().any(|point| point.uncertainty_g.is_some());
        let uncertainty = match uncertainty_words(lowest).as_str() {
            "" if has_intervals && is_alone(lowest) => ", bracket alone".to_owned(),
            "" => String::new(),
            words => format!(", uncertainty {} G", words.replace("+-", "\u{b1}")),
        };
        let at = coordinates::name(summary, lowest);
        let mut first = match known().count() {
            1 => format!(
                "The critical shock is {} ({at}{uncertainty})",
                grams(lowest)
            ),
            _ => format!(
                "Critical shocks range from {} (the worst case: {at}{uncertainty}) to {}",
                grams(lowest),
                grams(highest)
            ),
        };
        let missing = summary.points.len() - known().count();
        if missing > 0 {
            let _ = write!(
                first,
                ", {missing} of {} points without answer",
                summary.points.len()
            );
        }
        let unfinished = known().filter(|point| point.status == Status::Open).count();
        if unfinished > 0 {
            let _ = write!(
                first,
                ", {unfinished} of {} points with a bracket alone so far",
                summary.points.len()
            );
        }
        let alone = known().filter(|point| is_alone(point)).count();
        if has_intervals && alone > 0 {
            let _ = write!(
                first,
                ", {alone} of {} points with a bracket alone",
                summary.points.len()
            );
        }
        let mut clauses = self.axes.iter().map(Choice::clause);
        if let Some(clause) = clauses.next() {
            let _ = write!(first, "; {clause}");
        }
        let capital = |clause: String| clause.replacen("the best", "The best", 1) + ".";
        let mut sentences = vec![first + "."];
        sentences.extend(clauses.map(capital));
        sentences
    }

    /// Header and rows of a table for every choice.
    pub fn tables(&self) -> Vec<(Vec<String>, Vec<Vec<String>>)> {
        let tables = self.axes.iter().map(|choice| {
            let header = [
                choice.name,
                "worst case (G)",
                "uncertainty (G)",
                "below the best (%)",
                "without answer",
                "lead of the best",
                "worst case at",
            ];
            let row = |place: usize| {
                let rank = &choice.ranks[place];
                let (below, lead) = match place {
                    0 => (String::new(), "the best".to_owned()),
                    _ => (
                        format!("{:.1}", choice.behind_pct(place)),
                        choice.significance(place).words().to_owned(),
                    ),
                };
                vec![
                    rank.value.to_string(),
                    grams(rank.worst).replace(" G", ""),
                    uncertainty_words(rank.worst),
                    below,
                    rank.unanswered.to_string(),
                    lead,
                    coordinates::name(self.summary, rank.worst),
                ]
            };
            let rows = (0..choice.ranks.len()).map(row).collect();
            (header.map(str::to_owned).to_vec(), rows)
        });
        tables.collect()
    }

    /// A table for every choice, for a terminal.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.sentences().join(" "));
        for (header, rows) in self.tables() {
            let _ = write!(text, "\n{}", aligned(&header, &rows));
        }
        text
    }

    /// As JSON: `answer`, and `axes` with their `values` from best to worst.
    pub fn json(&self) -> Value {
        let value = |choice: &Choice<'_>, place: usize| {
            let rank = &choice.ranks[place];
            json!({
                "value": rank.value,
                "worst_case_g": rank.worst.known_g(),
                "status": rank.worst.status,
                "uncertainty_g": rank.worst.uncertainty_g,
                "at": coordinates::name(self.summary, rank.worst),
                "unanswered": rank.unanswered,
                "behind_pct": (place > 0).then(|| choice.behind_pct(place)),
                "significance": (place > 0).then(|| choice.significance(place)),
            })
        };
        let axes = self.axes.iter().map(|choice| {
            let values = (0..choice.ranks.len()).map(|place| value(choice, place));
            json!({"name": choice.name, "values": values.collect::<Vec<_>>()})
        });
        json!({
            "study": self.summary.study,
            "digest": self.summary.digest,
            "answer": self.sentences().join(" "),
            "axes": axes.collect::<Vec<_>>(),
        })
    }
}

impl Choice<'_> {
    /// By how much the worst case of a rank is below that of the best, per cent of the latter.
    pub fn behind_pct(&self, place: usize) -> f64 {
        let of = |place: usize| self.ranks[place].worst.known_g().unwrap_or(f64::NAN);
        100.0 * (1.0 - of(place) / of(0))
    }

    /// Whether the best leads a rank beyond the uncertainty intervals.
    pub fn significance(&self, place: usize) -> Significance {
        Significance::of(self.ranks[0].worst, self.ranks[place].worst)
    }

    fn clause(&self) -> String {
        let (best, next) = (&self.ranks[0], &self.ranks[1]);
        let lead = best
            .worst
            .known_g()
            .zip(next.worst.known_g())
            .map_or(f64::NAN, |(a, b)| a - b);
        let head = format!(
            "the best {} is {}, whose worst case, {}, is",
            self.name,
            best.value,
            grams(best.worst)
        );
        if lead == 0.0 {
            return format!("{head} that of {} too", next.value);
        }
        format!(
            "{head} {lead:.1} G ({:.1} %) above that of the next, {}, a lead {}",
            100.0 * lead / next.worst.known_g().unwrap_or(f64::NAN),
            next.value,
            significance_words(self.significance(1))
        )
    }
}
