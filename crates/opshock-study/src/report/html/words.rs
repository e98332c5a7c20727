//! The legend of all words that a page has: columns, statuses, flags, signs, contributions.

use super::text::escaped;
use crate::report::terms::{self, HEADINGS, Kind, TERMS, Term};
use crate::store::summary::{Status, Summary};
use std::fmt::Write as _;

/// Every word on the page with its meaning, by kind.
pub(super) fn section(summary: &Summary) -> String {
    let mut text = String::new();
    for (kind, heading) in HEADINGS {
        let on_page: Vec<&Term> = TERMS
            .iter()
            .filter(|term| term.kind == kind && is_on_page(summary, term))
            .collect();
        if on_page.is_empty() || kind == Kind::Section {
            continue;
        }
        let _ = write!(text, "<h3>{heading}</h3>\n{}", list(&on_page));
    }
    text
}

/// For paper: the status and flags that rows have.
pub(super) fn of_rows(summary: &Summary) -> String {
    let flags = terms::flags_of(&summary.points);
    let mut shown: Vec<&Term> = terms::legend_columns().collect();
    let statuses = Status::ALL.into_iter();
    let has = |status: &Status| summary.points.iter().any(|point| point.status == *status);
    shown.extend(statuses.filter(has).map(terms::of_status));
    shown.extend(flags);
    list(&shown)
}

/// Words with their meaning.
pub(super) fn list(words: &[&Term]) -> String {
    let mut text = String::from("<dl>");
    for term in words {
        let _ = write!(
            text,
            "<dt>{}</dt><dd>{}</dd>",
            escaped(term.shown),
            escaped(term.text)
        );
    }
    text + "</dl>\n"
}

fn is_on_page(summary: &Summary, term: &Term) -> bool {
    let mut points = summary.points.iter();
    match term.kind {
        Kind::Status => points.any(|point| point.status.as_str() == term.name),
        Kind::Reservation | Kind::Note => {
            points.any(|point| point.flags.iter().any(|flag| flag.as_str() == term.name))
        }
        Kind::Contribution => points.any(|point| {
            point
                .contributions
                .iter()
                .any(|(name, _)| name == term.name)
        }),
        Kind::Column | Kind::Sign | Kind::Section | Kind::Word => true,
    }
}
