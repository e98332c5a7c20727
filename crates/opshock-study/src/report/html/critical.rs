//! The page's first section: figure of the critical shocks, its legend, and downloads.

use super::source::ReportSource;
use super::text::{address, escaped, figure, saved};
use crate::report::chart::Figure;
use crate::report::critical_layout::Layout;
use crate::report::table;
use crate::report::terms::{self, Kind};
use std::fmt::Write as _;

/// Figure, legend, downloads.
pub(super) fn section(source: &ReportSource<'_>, layout: &Layout) -> String {
    let drawn = source.figure("");
    let mut text = drawn_with_keys(&drawn, "Critical shock", "critical");
    let mut marks = vec!["full", "open", "bar", "arrow"];
    if layout.panels.iter().any(|panel| panel.is_worst) {
        marks.push("worst");
    }
    text.push_str("<dl class=\"legend\">");
    for name in marks {
        let term = terms::find(Kind::Sign, name).expect("an entry for every sign");
        let swatch = match name {
            "open" => "<span class=\"swatch\" title=\"A shaded row\"></span> ",
            _ => "",
        };
        let _ = write!(
            text,
            "<dt>{swatch}{}</dt><dd>{}</dd>",
            escaped(term.shown),
            escaped(term.text)
        );
    }
    text.push_str("</dl>\n");
    text.push_str(&downloads(source));
    text
}

/// The figure's panels side by side as the page has room, below the legend; the script replaces them by plots to zoom.
pub(super) fn drawn_with_keys(drawn: &Figure, label: &str, plot: &str) -> String {
    // The other plots of the script have the colours of its controls.
    let class = match plot {
        "critical" => "keys",
        _ => "static keys",
    };
    let mut text = format!("<ul class=\"{class}\">");
    for (line, name) in drawn.keys() {
        let line = line.replacen("<svg ", "<svg aria-hidden=\"true\" ", 1);
        let _ = write!(text, "<li>{line}{}</li>", escaped(&name));
    }
    let _ = writeln!(
        text,
        "</ul>\n<div class=\"static panels\" role=\"group\" aria-label=\"{label}\">"
    );
    for (panel, svg) in drawn.panels.iter().zip(drawn.inline_panels()) {
        text.push_str(&figure(
            &svg,
            &format!("{label}, {}", escaped(&panel.title)),
        ));
    }
    let _ = write!(
        text,
        "</div>\n<div class=\"plot panels\" data-plot=\"{plot}\"></div>"
    );
    text
}

/// Links that save the table and the figure; their content is in the page.
fn downloads(source: &ReportSource<'_>) -> String {
    let json = serde_json::to_string(source.summary).unwrap_or_default();
    let picture = source.figure(source.program).svg();
    format!(
        "<p class=\"screen\">Save: {}, {}, {}. The PNG lies beside this page as {}.</p>",
        saved(
            "table.csv",
            &address("text/csv", &table::csv(source.summary))
        ),
        saved("table.json", &address("application/json", &json)),
        saved("critical_shock.svg", &address("image/svg+xml", &picture)),
        "<code>critical_shock.png</code>",
    )
}
