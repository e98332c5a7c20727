//! Accuracy on the page: what the error bars are made of, and what each digit costs.

use super::text::{escaped, figure};
use crate::accuracy::{Accuracy, PointLadders};
use crate::report::accuracy_files;
use crate::report::table;
use crate::store::summary::Summary;
use std::fmt::Write as _;

/// The section; `None` where there are neither bars nor ladders.
pub(super) fn section(summary: &Summary, accuracy: Option<&Accuracy>) -> Option<String> {
    let parts = table::parts(summary);
    if parts.is_none() && accuracy.is_none() {
        return None;
    }
    let mut text = String::new();
    if let Some((header, rows)) = parts {
        let cost =
            table::bars_cost(summary).map_or(String::new(), |cost| format!(" Cost: {cost}."));
        let _ = writeln!(
            text,
            "<p>What the error bars are made of, in per cent of A<sub>crit</sub>. {}{}</p>",
            escaped(table::PARTS_NOTE),
            escaped(&cost)
        );
        text.push_str(&plain_table(&header, &rows, 3 + summary.axes.len()));
    }
    let Some(accuracy) = accuracy else {
        return Some(text);
    };
    let _ = write!(
        text,
        "<p>What accuracy costs, measured knob by knob on single shocks of {}: error against a \
         reference ten times finer, over the time of one shock. The tables give the settings of all \
         knobs together; those in bold are the cheapest of their accuracy.</p>\n\
         <p class=\"quiet\">{}, study {}</p>\n",
        escaped(&accuracy.study),
        escaped(&accuracy.program),
        escaped(&accuracy.digest)
    );
    for point in &accuracy.points {
        let plot = accuracy_files::figure(point, "").svg();
        let label = format!("Error against time, {}", escaped(&point.label));
        text.push_str(&figure(&plot, &label));
        text.push_str(&joint_table(point));
    }
    Some(text)
}

/// Time against error of the settings of all knobs together.
fn joint_table(point: &PointLadders) -> String {
    let header = [
        "all knobs",
        "critical shock (G)",
        "its error (%)",
        "clearance (%)",
        "time of a shock (s)",
        "film work",
    ]
    .map(String::from);
    let rows: Vec<Vec<String>> = point
        .rungs
        .iter()
        .filter(|rung| rung.ladder == "joint")
        .map(|rung| {
            let per_cent = |column: usize| {
                rung.errors[column].map_or(String::new(), |error| format!("{:.2}", 100.0 * error))
            };
            vec![
                match rung.is_reference {
                    true => format!("{} (reference)", rung.value),
                    false => rung.value.clone(),
                },
                match (&rung.measured.failure, rung.measured.critical_g) {
                    (Some(reason), _) => reason.clone(),
                    (None, Some(critical_g)) => format!("{critical_g:.1}"),
                    (None, None) => String::new(),
                },
                per_cent(0),
                per_cent(1),
                rung.wall_s
                    .map_or(String::new(), |[_, median, _]| format!("{median:.3}")),
                format!("{:.2e}", rung.measured.work as f64),
            ]
        })
        .collect();
    let table = plain_table(&header, &rows, 1);
    // The front in bold.
    point
        .rungs
        .iter()
        .filter(|rung| rung.is_on_front)
        .fold(table, |table, rung| {
            let cell = format!("<td>{}</td>", escaped(&rung.value));
            let bold = format!("<td><strong>{}</strong></td>", escaped(&rung.value));
            table.replace(&cell, &bold)
        })
}

/// A table whose first `words` columns, but for the second of several, are words.
fn plain_table(header: &[String], rows: &[Vec<String>], words: usize) -> String {
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
            escaped(name)
        );
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        text.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let _ = write!(text, "<td{}>{}</td>", class(column), escaped(cell));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>\n");
    text
}
