//! The report as one HTML file that needs nothing else: no network, no other file. It keeps its
//! own content security policy (`default-src 'none'`, inline style and script).

mod accuracy;

use super::critical_shock::critical_shock_figure;
use super::outcome_map::{RunDot, outcome_map};
use super::savings::{self, Saving};
use super::table;
use crate::accuracy::Accuracy;
use crate::store::Audit;
use crate::store::summary::{Flag, PointSummary, Status, Summary};
use std::fmt::Write as _;

/// What a report is made from.
#[derive(Clone, Copy, Debug)]
pub struct ReportSource<'a> {
    /// Critical shocks.
    pub summary: &'a Summary,
    /// Every simulation.
    pub runs: &'a [RunDot],
    /// Program, as `provenance::program()` names it.
    pub program: &'a str,
    /// The study with every default written out, when the store has it.
    pub resolved_study: Option<&'a str>,
    /// The last audit of the store.
    pub audit: Option<&'a Audit>,
    /// What the rules saved.
    pub savings: &'a [Saving],
    /// What accuracy was measured to cost, if it was.
    pub accuracy: Option<&'a Accuracy>,
}

impl ReportSource<'_> {
    /// The line under a table: program, study, audit.
    pub fn provenance(&self) -> String {
        let audit = self
            .audit
            .map_or(String::new(), |audit| format!("; {}", audit.sentence()));
        let mut text = format!("{}, study {}{audit}", self.program, self.summary.digest);
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
        r#"<!doctype html>
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
<h1>{title}</h1>
<p>{ok} of {points} points bracketed, {above} above and {below} below the searched range, {undecided} undecided, {open} open; {runs} simulations.</p>
<p class="quiet">{program}, study {digest}</p>
"#,
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
    let mut section = |heading: &str, body: &str| {
        let _ = write!(page, "<section>\n<h2>{heading}</h2>\n{body}\n</section>\n");
    };
    section(
        "Critical shock",
        &figure(
            &critical_shock_figure(summary, "").svg(),
            "Critical shock against pulse width",
        ),
    );
    section("Table", &main_table(summary));
    section("Reservations", &reservations(summary));
    if !source.runs.is_empty() {
        section(
            "Outcome map",
            &format!(
                "<p>Every simulation that the answers rest on, at its pulse width and amplitude.</p>\n{}",
                figure(
                    &outcome_map(summary, source.runs).svg(),
                    "Outcome of every simulation"
                )
            ),
        );
    }
    if let Some(body) = accuracy::section(summary, source.accuracy) {
        section("Accuracy", &body);
    }
    section("Provenance", &provenance(source));
    let _ = write!(
        page,
        "<script>\n{}</script>\n</body>\n</html>\n",
        include_str!("sort.js")
    );
    page
}

fn figure(svg: &str, label: &str) -> String {
    let svg = svg.replacen("<svg ", &format!(r#"<svg aria-label="{label}" "#), 1);
    format!("<figure>{svg}</figure>")
}

fn main_table(summary: &Summary) -> String {
    let (header, rows) = table::readable(summary);
    let words = 3 + summary.axes.len();
    let numeric = |column: usize| column == 1 || (words..words + 5).contains(&column);
    let mut text = String::from(
        "<p>A<sub>crit</sub>: highest surviving amplitude below the lowest failing one, \
         A<sub>fail</sub>. Error: bar of A<sub>crit</sub>. First touch: amplitude at which the disk \
         first reaches the ramp. Shaded rows carry a reservation. A click on a heading sorts.</p>\n\
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
    for (point, row) in summary.points.iter().zip(&rows) {
        let reserved = point.status != Status::Ok || point.flags.iter().any(is_reservation);
        text.push_str(if reserved {
            "<tr class=\"reserved\">"
        } else {
            "<tr>"
        });
        for (column, cell) in row.iter().enumerate() {
            let class = if numeric(column) { " class=\"n\"" } else { "" };
            let value = sort_value(point, column, words)
                .map_or(String::new(), |value| format!(" data-v=\"{value}\""));
            let _ = write!(text, "<td{class}{value}>{}</td>", escaped(cell));
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
        let mut said: Vec<&str> = match point.status {
            Status::Ok => Vec::new(),
            Status::AboveRange => vec!["no failure up to the end of the searched range"],
            Status::BelowRange => vec!["fails at the start of the searched range already"],
            Status::Undecided => vec!["runs without verdict left no bracket"],
            Status::Open => vec!["the search has not ended"],
        };
        said.extend(
            point
                .flags
                .iter()
                .filter(|flag| is_reservation(flag))
                .map(|flag| sentence(*flag)),
        );
        if said.is_empty() {
            continue;
        }
        let axes: Vec<String> = summary
            .axes
            .iter()
            .zip(&point.axes)
            .map(|(axis, value)| format!(", {axis} = {value}"))
            .collect();
        let _ = writeln!(
            text,
            "<li>{} {} ms {}{}: {}</li>",
            escaped(&point.ramp),
            point.pulse_ms,
            point.sign.as_str(),
            escaped(&axes.concat()),
            said.join("; ")
        );
    }
    if text.is_empty() {
        "<p>None: every point is bracketed, nothing was retried.</p>".into()
    } else {
        format!("<ul>\n{text}</ul>")
    }
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
    for line in savings::lines(source.savings) {
        entry("saved", &line);
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

fn escaped(text: &str) -> String {
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
