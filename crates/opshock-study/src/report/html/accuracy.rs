//! The page's section on accuracy: contributions to the uncertainty intervals, and error against cost.

use super::text::{escaped, explained, figure, signed};
use crate::accuracy::{Accuracy, PointStudies};
use crate::report::accuracy_files;
use crate::report::table;
use crate::report::terms::{self, Kind};
use crate::store::summary::Summary;
use std::fmt::Write as _;

/// The section; `None` where there are neither intervals nor refinement studies.
pub(super) fn section(summary: &Summary, accuracy: Option<&Accuracy>) -> Option<String> {
    let contributions = table::contributions(summary);
    if contributions.is_none() && accuracy.is_none() {
        return None;
    }
    let mut text = String::new();
    if let Some((header, rows)) = contributions {
        let cost = table::uncertainty_cost(summary)
            .map_or(String::new(), |cost| format!(" Cost: {cost}."));
        let _ = writeln!(
            text,
            "<p>What the uncertainty intervals are made of, in per cent of A<sub>crit</sub>. {}{}</p>",
            escaped(&table::contributions_note(summary)),
            escaped(&cost)
        );
        text.push_str(&plain_table(&header, &rows, 3 + summary.axes.len()));
    }
    let Some(accuracy) = accuracy else {
        return Some(text);
    };
    let _ = write!(
        text,
        "<p>What accuracy costs, measured for each discretisation parameter on single shocks of {}: error against a \
         reference ten times finer, over the time of one shock. The tables give the settings of all \
         discretisation parameters together; those in bold are the cheapest of their accuracy.</p>\n\
         <p class=\"quiet\">{}, study {}</p>\n",
        escaped(&accuracy.study),
        escaped(&accuracy.program),
        escaped(&accuracy.digest)
    );
    for point in &accuracy.points {
        let plot = accuracy_files::figure(point, "").inline_svg();
        let label = format!("Error against time, {}", escaped(&point.label));
        text.push_str(&figure(&plot, &label).replacen("<figure>", "<figure class=\"wide\">", 1));
        text.push_str(&joint_table(point));
    }
    Some(text)
}

/// Time against error of the settings of all discretisation parameters together.
fn joint_table(point: &PointStudies) -> String {
    let header = [
        "all discretisation parameters",
        "critical shock (G)",
        "its error (%)",
        "clearance (%)",
        "time of a shock (s)",
        "film work",
    ]
    .map(String::from);
    let rows: Vec<Vec<String>> = point
        .settings
        .iter()
        .filter(|setting| setting.parameter == "joint")
        .map(|setting| {
            let per_cent = |column: usize| {
                setting.errors[column]
                    .map_or(String::new(), |error| format!("{:.2}", 100.0 * error))
            };
            vec![
                match setting.is_reference {
                    true => format!("{} (reference)", setting.value),
                    false => setting.value.clone(),
                },
                match (&setting.measured.failure, setting.measured.critical_g) {
                    (Some(reason), _) => reason.clone(),
                    (None, Some(critical_g)) => format!("{critical_g:.1}"),
                    (None, None) => String::new(),
                },
                per_cent(0),
                per_cent(1),
                setting
                    .wall_s
                    .map_or(String::new(), |[_, median, _]| format!("{median:.3}")),
                format!("{:.2e}", setting.measured.work as f64),
            ]
        })
        .collect();
    let table = plain_table(&header, &rows, 1);
    // The Pareto front of time and error in bold.
    point
        .settings
        .iter()
        .filter(|setting| setting.is_on_front)
        .fold(table, |table, setting| {
            let cell = format!("<td>{}</td>", escaped(&setting.value));
            let bold = format!("<td><strong>{}</strong></td>", escaped(&setting.value));
            table.replace(&cell, &bold)
        })
}

/// A heading that says on hover what stands below it.
fn heading(name: &str) -> String {
    let plain = name.trim_end_matches(" (%)");
    let kinds = [Kind::Contribution, Kind::Word, Kind::Column];
    let found = kinds
        .into_iter()
        .find_map(|kind| terms::find(kind, plain).or_else(|| terms::find(kind, name)));
    found.map_or_else(|| escaped(name), |term| explained(name, term.text))
}

/// A table whose first `words` columns, but for the second of several, are words.
pub(super) fn plain_table(header: &[String], rows: &[Vec<String>], words: usize) -> String {
    let class = |column: usize| match column >= words || (words > 1 && column == 1) {
        true => " class=\"n\"",
        false => "",
    };
    let mut text = String::from("<div class=\"scroll\"><table>\n<thead><tr>");
    for (column, name) in header.iter().enumerate() {
        let _ = write!(
            text,
            "<th scope=\"col\"{}>{}</th>",
            class(column),
            heading(name)
        );
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        text.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let _ = write!(text, "<td{}>{}</td>", class(column), signed(cell));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>\n");
    text
}
