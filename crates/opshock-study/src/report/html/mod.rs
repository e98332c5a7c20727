//! The report as one HTML file that needs nothing else: no network, no other file. It keeps its
//! own content security policy (`default-src 'none'`, inline style and script).
//!
//! Without JavaScript it has its tables, its static figures and, by their addresses, the pages of
//! its points. The script (`report.js`) draws zoomable plots in place of the static ones.

mod accuracy;
mod data;
mod points;
mod shock_film;

pub use shock_film::ShockFilm;

use super::critical_shock::critical_shock_figure;
use super::crossings::{self, CrossingRow};
use super::margin_curves::margin_curves;
use super::outcome_map::{RunDot, outcome_map};
use super::savings::{self, Saving};
use super::table;
use crate::accuracy::Accuracy;
use crate::store::Audit;
use crate::store::summary::{Flag, PointSummary, Status, Summary};
use crate::study::Study;
use std::fmt::Write as _;

/// What a report is made from.
#[derive(Clone, Copy, Debug)]
pub struct ReportSource<'a> {
    /// Critical shocks.
    pub summary: &'a Summary,
    /// Every simulation.
    pub runs: &'a [RunDot],
    /// Program that swept the store, as `provenance::program()` names it.
    pub program: &'a str,
    /// The study with every default written out, when the store has it.
    pub resolved_study: Option<&'a str>,
    /// The last audit of the store.
    pub audit: Option<&'a Audit>,
    /// What the rules saved.
    pub savings: &'a [Saving],
    /// Crossings of the ramps' curves, where the study asks for them.
    pub crossings: &'a [CrossingRow],
    /// What accuracy was measured to cost, if it was.
    pub accuracy: Option<&'a Accuracy>,
    /// Effects and rules of each ramp's scenes, as the JSON of the results; empty: not known.
    pub plan: &'a str,
    /// A kept shock to be shown moving.
    pub film: Option<&'a ShockFilm>,
}

impl<'a> ReportSource<'a> {
    /// A report of the table and its simulations alone.
    pub fn of_table(summary: &'a Summary, runs: &'a [RunDot], program: &'a str) -> Self {
        Self {
            summary,
            runs,
            program,
            resolved_study: None,
            audit: None,
            savings: &[],
            crossings: &[],
            accuracy: None,
            plan: "",
            film: None,
        }
    }

    /// Discretisation parameters that are values of the study's model, in words.
    pub fn not_refined(&self) -> Option<String> {
        Study::from_text(self.resolved_study?, &[])
            .ok()?
            .not_refined()
    }

    /// The line under a table: program, study, audit.
    pub fn provenance(&self) -> String {
        let audit = self
            .audit
            .map_or(String::new(), |audit| format!("; {}", audit.sentence()));
        let mut text = self
            .not_refined()
            .map_or(String::new(), |values| values + "\n\n");
        let _ = write!(
            text,
            "{}, study {}{audit}",
            self.program, self.summary.digest
        );
        for line in savings::lines(self.savings) {
            text.push_str("\n\n");
            text.push_str(&line);
        }
        text
    }
}

/// The page.
pub fn html(source: &ReportSource<'_>) -> String {
    let summary = source.summary;
    let title = escaped(&summary.study);
    let totals = &summary.totals;
    let mut page = format!(
        r##"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<a class="skip" href="#table">to the table</a>
<header>
<h1>{title}</h1>
<p>{ok} of {points} points bracketed, {above} above and {below} below the searched range, {undecided} undecided, {open} open; {runs} simulations.</p>
<p class="quiet">{program}, study {digest}</p>
</header>
"##,
        style = include_str!("style.css"),
        ok = totals.ok,
        points = totals.points,
        above = totals.above_range,
        below = totals.below_range,
        undecided = totals.undecided,
        open = totals.open,
        runs = totals.runs,
        program = escaped(source.program),
        digest = escaped(&summary.digest),
    );
    let sections = sections(source);
    page.push_str("<nav aria-label=\"Sections\"><ul>\n");
    for section in &sections {
        let _ = writeln!(
            page,
            "<li><a href=\"#{}\">{}</a></li>",
            section.id, section.heading
        );
    }
    page.push_str("</ul></nav>\n<main>\n<div id=\"controls\" role=\"group\" aria-label=\"What the plots show\"></div>\n");
    for section in &sections {
        let _ = write!(
            page,
            "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\">{}</h2>\n{}\n</section>\n",
            section.heading,
            section.body,
            id = section.id
        );
    }
    page.push_str("</main>\n");
    page.push_str(&data::block(summary, source.runs, source.film));
    let _ = write!(
        page,
        "<pre id=\"csv\" hidden>{}</pre>\n<script>\n{}</script>\n</body>\n</html>\n",
        escaped(&table::csv(summary)),
        include_str!("report.js")
    );
    page
}

/// One part of the page.
struct Section {
    id: &'static str,
    heading: &'static str,
    body: String,
}

/// The parts, in their order. A part that has nothing to show is left out.
fn sections(source: &ReportSource<'_>) -> Vec<Section> {
    let summary = source.summary;
    let has_runs = !source.runs.is_empty();
    let mut sections = Vec::new();
    let mut add = |id, heading, body: String| sections.push(Section { id, heading, body });
    add(
        "critical",
        "Critical shock",
        replaced(
            &critical_shock_figure(summary, "").svg(),
            "Critical shock against pulse width",
            "critical",
        ),
    );
    add("table", "Table", main_table(summary));
    if !source.crossings.is_empty() {
        let body = crossings::section(source.crossings, &summary.axes);
        add("crossings", "Crossings", body);
    }
    add(
        "points",
        "Points",
        "<p>A name in the table, or a mark in a plot, opens the page of its point here.</p>\n"
            .to_owned()
            + &points::pages(summary, source.runs),
    );
    add(
        "compare",
        "Compare",
        "<div id=\"compare-tool\"></div>".to_owned(),
    );
    if has_runs {
        add(
            "map",
            "Outcome map",
            format!(
                "<p>Every simulation that the answers rest on, at its pulse width and amplitude: \
                 open circles survive, full squares touch.</p>\n{}",
                replaced(
                    &outcome_map(summary, source.runs).svg(),
                    "Outcome of every simulation",
                    "map"
                )
            ),
        );
        add(
            "margin",
            "Margin",
            format!(
                "<p>Smallest clearance between slider and disk against amplitude.</p>\n{}",
                replaced(
                    &margin_curves(summary, source.runs).svg(),
                    "Smallest clearance against amplitude",
                    "margin"
                )
            ),
        );
    }
    if let Some(film) = source.film {
        add(
            "film",
            "One shock",
            format!(
                "<p>{}. Displacements are drawn some hundred times too large; an arm in contact is orange. \
                 The figures of a run without this script: <code>opshock run --plots</code>.</p>\n\
                 <div id=\"film-stage\"></div>",
                escaped(&film.label)
            ),
        );
    }
    if let Some(body) = accuracy::section(summary, source.accuracy) {
        add("accuracy", "Accuracy", body);
    }
    add("effects", "Effects", effects(source));
    add("trouble", "Trouble", reservations(summary));
    add("provenance", "Provenance", provenance(source));
    sections
}

/// What was simulated for each ramp, and which rules left things out.
fn effects(source: &ReportSource<'_>) -> String {
    let mut text = String::new();
    let plan: serde_json::Value = serde_json::from_str(source.plan).unwrap_or_default();
    if let Some(ramps) = plan["ramps"].as_object() {
        text.push_str(
            "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">ramp</th><th scope=\"col\">simulated</th>\
             <th scope=\"col\">left out</th><th scope=\"col\">rules below touch</th><th scope=\"col\">rules above touch</th></tr></thead><tbody>\n",
        );
        for (ramp, told) in ramps {
            let effects = told["effects"].as_object();
            let list = |wanted: bool| -> String {
                let all = effects.into_iter().flatten();
                let kept = all.filter(|(_, state)| (state.as_str() != Some("off")) == wanted);
                let words: Vec<String> = kept
                    .map(|(name, state)| match state.as_str() {
                        Some("on" | "off") | None => name.clone(),
                        Some(state) => format!("{name} ({state})"),
                    })
                    .collect();
                words.join(", ")
            };
            let rules = |key: &str| -> String {
                let rules = told[key].as_array().into_iter().flatten();
                rules
                    .filter_map(|rule| rule.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            };
            let cells = [
                list(true),
                list(false),
                rules("rules_below_touch"),
                rules("rules_above_touch"),
            ];
            let cells = cells.map(|cell| format!("<td class=\"wrap\">{}</td>", escaped(&cell)));
            let _ = writeln!(
                text,
                "<tr><th scope=\"row\">{}</th>{}</tr>",
                escaped(ramp),
                cells.concat()
            );
        }
        text.push_str("</tbody></table></div>\n");
    }
    let saved = savings::lines(source.savings);
    for line in &saved {
        let _ = writeln!(text, "<p>{}</p>", escaped(line));
    }
    if text.is_empty() {
        text.push_str("<p>The results name no effects.</p>");
    }
    text
}

/// A figure that the script replaces by a zoomable one.
fn replaced(svg: &str, label: &str, plot: &str) -> String {
    let figure = figure(svg, label).replacen("<figure>", "<figure class=\"static\">", 1);
    format!("{figure}<div class=\"plot\" data-plot=\"{plot}\"></div>")
}

fn figure(svg: &str, label: &str) -> String {
    let svg = svg.replacen("<svg ", &format!(r#"<svg aria-label="{label}" "#), 1);
    format!("<figure>{svg}</figure>\n")
}

fn main_table(summary: &Summary) -> String {
    let (header, rows) = table::readable(summary);
    let words = 3 + summary.axes.len();
    let numeric = |column: usize| column == 1 || (words..words + 5).contains(&column);
    let mut text = String::from(
        "<p>A<sub>crit</sub>: highest surviving amplitude below the lowest failing one, \
         A<sub>fail</sub>. Error: bar of A<sub>crit</sub>. First touch: amplitude at which the disk \
         first reaches the ramp. Shaded rows carry a reservation. A click on a heading sorts.</p>\n\
         <p><button type=\"button\" id=\"copy\">copy as CSV</button> <span id=\"copied\" role=\"status\"></span></p>\n\
         <div class=\"scroll\"><table class=\"sortable\">\n<thead><tr>",
    );
    for (column, name) in header.iter().enumerate() {
        let class = if numeric(column) { " class=\"n\"" } else { "" };
        let _ = write!(
            text,
            "<th scope=\"col\"{class}><button type=\"button\">{}</button></th>",
            escaped(name)
        );
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for (place, (point, row)) in summary.points.iter().zip(&rows).enumerate() {
        let reserved = point.status != Status::Ok || point.flags.iter().any(is_reservation);
        let class = if reserved { " class=\"reserved\"" } else { "" };
        let _ = write!(text, "<tr data-point=\"{place}\"{class}>");
        for (column, cell) in row.iter().enumerate() {
            let class = if numeric(column) { " class=\"n\"" } else { "" };
            let value = sort_value(point, column, words)
                .map_or(String::new(), |value| format!(" data-v=\"{value}\""));
            let cell = escaped(cell);
            let _ = match column {
                0 => write!(
                    text,
                    "<th scope=\"row\"><a href=\"#point-{place}\">{cell}</a></th>"
                ),
                _ => write!(text, "<td{class}{value}>{cell}</td>"),
            };
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>");
    text
}

/// The number a cell sorts by, where its text is not one.
fn sort_value(point: &PointSummary, column: usize, words: usize) -> Option<f64> {
    match column.checked_sub(words)? {
        0 => point.a_crit_g,
        1 => point.a_fail_g,
        2 => point.err_high_g,
        _ => None,
    }
}

/// `NoTouch` says where an answer comes from and takes nothing from it.
fn is_reservation(flag: &Flag) -> bool {
    *flag != Flag::NoTouch
}

fn reservations(summary: &Summary) -> String {
    let mut text = String::new();
    for point in &summary.points {
        let said = said_of(point);
        if said.is_empty() {
            continue;
        }
        let place = summary.points.iter().position(|other| other == point);
        let _ = writeln!(
            text,
            "<li><a href=\"#point-{}\">{}</a>: {}</li>",
            place.unwrap_or_default(),
            escaped(&points::name(summary, point)),
            said.join("; ")
        );
    }
    if text.is_empty() {
        "<p>None: every point is bracketed, nothing was retried.</p>".into()
    } else {
        format!("<ul>\n{text}</ul>")
    }
}

/// What a reader must know of a point, in sentences.
fn said_of(point: &PointSummary) -> Vec<&'static str> {
    let mut said: Vec<&str> = match point.status {
        Status::Ok => Vec::new(),
        Status::AboveRange => vec!["no failure up to the end of the searched range"],
        Status::BelowRange => vec!["fails at the start of the searched range already"],
        Status::Undecided => vec!["runs without verdict left no bracket"],
        Status::Open => vec!["the search has not ended"],
    };
    let flags = point.flags.iter().filter(|flag| is_reservation(flag));
    said.extend(flags.map(|flag| sentence(*flag)));
    said
}

fn sentence(flag: Flag) -> &'static str {
    match flag {
        Flag::NonMonotone => {
            "failure is not monotone in amplitude: a survivor lies above a failure"
        }
        Flag::Window => "the highest survivor fails in a window twice as long",
        Flag::WindowUndecided => "the window twice as long has no verdict",
        Flag::Retry => "a verdict needed smaller steps or another method",
        Flag::UndecidedNode => "an amplitude without verdict widens the bracket",
        Flag::NotConverged => "a run did not converge",
        Flag::StepLimit => "a run reached its step limit",
        Flag::NotFinite => "a run met a number that is not finite",
        Flag::Panicked => "a run broke down",
        Flag::NotBuilt => "a scene could not be built",
        Flag::NoTouch => "the disk does not reach the ramp",
        Flag::OnsetUnknown => "the amplitude of first touch is not known",
        Flag::BarWide => {
            "a part of the error bar shows no formal order and carries the wide factor"
        }
        Flag::BarPartial => "a part of the error bar could not be estimated",
        Flag::BarExceeds => "half the error bar is more than the accuracy asked for",
        Flag::BarFloor => "and no finer rung was allowed",
        Flag::Climbed => "answered on finer knobs than the study's",
    }
}

fn provenance(source: &ReportSource<'_>) -> String {
    let summary = source.summary;
    let mut text = String::from("<dl>");
    let mut entry = |name: &str, value: &str| {
        let _ = write!(text, "<dt>{name}</dt><dd>{}</dd>", escaped(value));
    };
    entry("program", source.program);
    entry("study", &summary.study);
    entry("digest", &summary.digest);
    if let Some(values) = source.not_refined() {
        entry("error bars", &values);
    }
    if let Some(audit) = source.audit {
        let mut told = vec![audit.sentence()];
        told.extend(audit.differences.iter().map(ToString::to_string));
        entry("audit", &told.join("; "));
    }
    let cost = &summary.totals.cost;
    entry(
        "work",
        &format!(
            "{} simulations, {} without verdict; {} head steps, {} film solves of up to {} unknowns, {} structure steps",
            summary.totals.runs,
            summary.totals.undecided_runs,
            cost.steps,
            cost.film_solves,
            cost.film_unknowns,
            cost.structure_steps
        ),
    );
    text.push_str("</dl>");
    if let Some(study) = source.resolved_study {
        let _ = write!(
            text,
            "\n<details><summary>The study with every default</summary>\n<pre>{}</pre></details>",
            escaped(study)
        );
    }
    text
}

pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c => safe.push(c),
        }
    }
    safe
}
