//! The page's table of critical shocks: every column, status and flag explained on hover.

use super::text::{escaped, explained, signed};
use crate::report::outcome_map::RunDot;
use crate::report::{table, terms};
use crate::store::summary::{PointSummary, Summary};
use opshock_solver::simulation::Mechanism;
use std::fmt::Write as _;

/// The table with its heading; with the mechanism of the lowest failure, where it is known.
pub(super) fn section(summary: &Summary, runs: &[RunDot]) -> String {
    let (mut header, mut rows) = table::readable(summary);
    let mechanisms: Vec<Option<String>> = (0..rows.len()).map(|row| mechanism(runs, row)).collect();
    let has_mechanism = mechanisms.iter().any(Option::is_some);
    let place = header.len() - 2;
    if has_mechanism {
        header.insert(place, table::OF_PAGE.into());
        for (row, mechanism) in rows.iter_mut().zip(mechanisms) {
            row.insert(place, mechanism.unwrap_or_default());
        }
    }
    let words = 3 + summary.axes.len();
    let numeric = |column: usize| column == 1 || (words..place).contains(&column);
    let mut text = String::from(
        "<p class=\"screen\">A heading says on hover what its column is, and sorts by it when clicked; flags say theirs too. \
         Shaded rows have a reservation. <a href=\"#words\">All words</a>.</p>\n\
         <p class=\"screen\"><button type=\"button\" id=\"copy\">copy as CSV</button> <span id=\"copied\" role=\"status\"></span></p>\n\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Critical shocks\"><table class=\"sortable\">\n<thead><tr>",
    );
    for (column, name) in header.iter().enumerate() {
        let class = if numeric(column) { " class=\"n\"" } else { "" };
        let _ = write!(
            text,
            "<th scope=\"col\"{class}><button type=\"button\" title=\"{}\">{}</button></th>",
            escaped(terms::of_column(name)),
            escaped(name)
        );
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for (place, (point, row)) in summary.points.iter().zip(&rows).enumerate() {
        let class = match terms::is_reserved(point) {
            true => " class=\"reserved\"",
            false => "",
        };
        let _ = write!(text, "<tr data-point=\"{place}\"{class}>");
        for (column, cell) in row.iter().enumerate() {
            let class = if numeric(column) { " class=\"n\"" } else { "" };
            let value = sort_value(point, &header[column])
                .map_or(String::new(), |value| format!(" data-v=\"{value}\""));
            let cell = signed(cell);
            let _ = match column {
                0 => write!(
                    text,
                    "<th scope=\"row\"><a href=\"#point-{place}\">{cell}</a></th>"
                ),
                _ if column + 1 == row.len() => {
                    write!(text, "<td class=\"wrap\">{}</td>", flags(point))
                }
                _ if column + 2 == row.len() => write!(text, "<td>{}</td>", status(point)),
                _ => write!(text, "<td{class}{value}>{cell}</td>"),
            };
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>");
    text
}

/// Mechanism of the lowest failure of a row, the only run of it that has one.
fn mechanism(runs: &[RunDot], row: usize) -> Option<String> {
    let mut of_row = runs.iter().filter(|run| run.point == row);
    of_row.find_map(|run| run.mechanism).map(Mechanism::words)
}

/// The status, which does not say that all is well where a flag says otherwise.
pub(super) fn status(point: &PointSummary) -> String {
    let term = terms::of_status(point.status);
    let is_found = point.status == crate::store::summary::Status::Ok;
    let shown = match is_found && terms::is_reserved(point) {
        true => format!("{}, see flags", term.shown),
        false => term.shown.to_owned(),
    };
    explained(&shown, term.text)
}

/// The flags, each with its meaning on hover.
pub(super) fn flags(point: &PointSummary) -> String {
    let flags: Vec<String> = point
        .flags
        .iter()
        .map(|flag| terms::of_flag(*flag))
        .map(|term| explained(term.shown, term.text))
        .collect();
    flags.join(", ")
}

/// The number a cell sorts by, where its text is not one.
fn sort_value(point: &PointSummary, heading: &str) -> Option<f64> {
    match heading {
        "A_crit (G)" => point.known_g(),
        "uncertainty (G)" => point.uncertainty_g,
        "half min. height (G)" => point.half_min_height_g,
        "survived (G)" => point.survived_g,
        "failed (G)" => point.failed_g,
        _ => None,
    }
}
