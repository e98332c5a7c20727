//! Writes a page for each point: answer, uncertainty interval, every simulation.

use super::main_table::{flags, status};
use super::text::{escaped, explained};
use crate::report::coordinates;
use crate::report::outcome_map::RunDot;
use crate::report::terms::{self, Kind};
use crate::store::summary::{PointSummary, Summary};
use std::fmt::Write as _;

/// All pages; one is shown at a time, the one the address names.
pub(super) fn pages(summary: &Summary, runs: &[RunDot]) -> String {
    let mut text = String::new();
    for (row, point) in summary.points.iter().enumerate() {
        let _ = write!(
            text,
            "<article class=\"page\" id=\"point-{row}\" tabindex=\"-1\" aria-labelledby=\"point-{row}-name\">\n\
             <h3 id=\"point-{row}-name\">{}</h3>\n<p><a href=\"#table\">close</a></p>\n",
            escaped(&coordinates::name(summary, point))
        );
        text.push_str(&facts(point));
        text.push_str(&contributions(point));
        text.push_str(&runs_table(row, runs));
        text.push_str("</article>\n");
    }
    text
}

fn facts(point: &PointSummary) -> String {
    let mut text = String::from("<dl>");
    let mut entry = |name: &str, value: String| {
        let _ = write!(text, "<dt>{name}</dt><dd>{}</dd>", escaped(&value));
    };
    let grams = |value: Option<f64>| value.map_or("not known".to_owned(), |v| format!("{v:.1} G"));
    entry("critical shock", grams(point.a_crit_g));
    if let Some(half) = point.uncertainty_g {
        entry(
            "half-width of the uncertainty interval",
            format!("{half:.1} G"),
        );
    }
    if let Some(change) = point.half_min_height_g {
        entry(
            "change with half the minimum film height, no part of the interval",
            format!("{change:+.1} G"),
        );
    }
    entry("highest survivor", grams(point.survived_g));
    entry("lowest failure", grams(point.failed_g));
    if let Some(onset) = point.onset_g {
        entry("first touch of the ramp", format!("{onset:.1} G"));
    }
    if !point.brackets_g.is_empty() {
        let pairs = point.brackets_g.iter();
        let pairs: Vec<String> = pairs.map(|[a, b]| format!("{a:.1} | {b:.1}")).collect();
        entry("survivor | failure", pairs.join("; ") + " G");
    }
    if let Some(gap) = point.largest_gap_pct {
        entry("largest untested step below", format!("{gap:.1} %"));
    }
    let reservations = terms::reservations(point);
    if !reservations.is_empty() {
        entry("reservations", reservations.join(" "));
    }
    let _ = write!(text, "<dt>status</dt><dd>{}</dd>", status(point));
    if !point.flags.is_empty() {
        let _ = write!(text, "<dt>flags</dt><dd>{}</dd>", flags(point));
    }
    text.push_str("</dl>\n");
    text
}

fn contributions(point: &PointSummary) -> String {
    if point.contributions.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "<div class=\"scroll\"><table><caption>What its uncertainty interval is made of</caption>\
         <thead><tr><th scope=\"col\">contribution</th><th scope=\"col\" class=\"n\">below (G)</th>\
         <th scope=\"col\" class=\"n\">above (G)</th><th scope=\"col\" class=\"n\">factor</th></tr></thead><tbody>\n",
    );
    for (name, contribution) in &point.contributions {
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td class=\"n\">{:.2}</td><td class=\"n\">{:.2}</td><td class=\"n\">{}</td></tr>",
            explained(name, meaning(name)),
            contribution.low_g,
            contribution.high_g,
            contribution.factor
        );
    }
    text.push_str("</tbody></table></div>\n");
    text
}

fn meaning(contribution: &str) -> &'static str {
    terms::find(Kind::Contribution, contribution).map_or("", |term| term.text)
}

fn runs_table(row: usize, runs: &[RunDot]) -> String {
    let mut own: Vec<&RunDot> = runs.iter().filter(|run| run.point == row).collect();
    if own.is_empty() {
        return String::new();
    }
    own.sort_by(|a, b| a.amplitude_g.total_cmp(&b.amplitude_g));
    let mut text = String::from(
        "<div class=\"scroll\"><table><caption>Its simulations</caption>\
         <thead><tr><th scope=\"col\" class=\"n\">amplitude (G)</th><th scope=\"col\">verdict</th>\
         <th scope=\"col\" class=\"n\">smallest clearance (nm)</th></tr></thead><tbody>\n",
    );
    for run in own {
        let clearance = run
            .h_min_m
            .map_or(String::new(), |h| format!("{:.3}", 1e9 * h));
        let _ = writeln!(
            text,
            "<tr class=\"{}\"><td class=\"n\">{:.2}</td><td>{}</td><td class=\"n\">{clearance}</td></tr>",
            escaped(&run.verdict),
            run.amplitude_g,
            escaped(&run.verdict)
        );
    }
    text.push_str("</tbody></table></div>\n");
    text
}
