//! Writes the report as one HTML file that needs no network and no other file. It has its own
//! content security policy (`default-src 'none'`, inline style and script).
//!
//! Without JavaScript it has its tables, its static figures and, by their addresses, the pages of
//! its points. The script (`report.js`) draws zoomable plots in place of the static ones.

mod accuracy;
mod critical;
mod data;
mod main_table;
mod points;
pub(super) mod population;
pub(super) mod qualification;
mod shock_film;
mod source;
pub(super) mod text;
mod words;
pub(super) mod worth;

pub use shock_film::ShockFilm;
pub use source::ReportSource;

use critical::drawn_with_keys;
use text::{escaped, head};

use super::answer::Answer;
use super::coordinates;
use super::critical_layout::Layout;
use super::crossings;
use super::margin_curves::margin_curves;
use super::outcome_map::outcome_map;
use super::savings;
use super::table;
use super::terms::{self, Kind};
use crate::store::summary::Summary;
use std::fmt::Write as _;

/// The page.
pub fn html(source: &ReportSource<'_>) -> String {
    let summary = source.summary;
    let title = escaped(&summary.study);
    let layout = Layout::of(summary, source.x(), true);
    let mut page = head(&summary.study, true);
    let _ = write!(
        page,
        r##"<body>
<a class="skip" href="#table">to the table</a>
<header>
<h1>{title}</h1>
<p class="lead">{answer}</p>
<p class="quiet">{counts}. {program}, study {digest}</p>
</header>
"##,
        answer = escaped(&source.answer()),
        counts = escaped(&table::counts(summary)),
        program = escaped(source.program),
        digest = escaped(&summary.digest),
    );
    let sections = sections(source, &layout);
    page.push_str("<nav aria-label=\"Sections\"><ul>\n");
    for section in &sections {
        let _ = writeln!(
            page,
            "<li><a href=\"#{}\" title=\"{}\">{}</a></li>",
            section.id,
            escaped(section.meaning()),
            section.heading()
        );
    }
    page.push_str("</ul></nav>\n<main>\n<div id=\"controls\" role=\"group\" aria-label=\"What the plots show\"></div>\n");
    for section in &sections {
        let screen = match ["critical", "table"].contains(&section.id) {
            true => "",
            false => " class=\"screen\"",
        };
        let _ = write!(
            page,
            "<section id=\"{id}\"{screen} aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\" title=\"{}\">{}</h2>\n{}\n</section>\n",
            escaped(section.meaning()),
            section.heading(),
            section.body,
            id = section.id
        );
    }
    let _ = write!(
        page,
        "<div class=\"paper\">{}<p>On screen the report also has choices, points, simulations, accuracy, effects and provenance.</p></div>\n</main>\n",
        words::of_rows(summary)
    );
    page.push_str(&data::block(
        summary,
        &layout,
        &source.figure(""),
        source.runs,
        source.film,
    ));
    let _ = write!(
        page,
        "<pre id=\"csv\" hidden>{}</pre>\n<script>\n{}</script>\n</body>\n</html>\n",
        escaped(&table::csv(summary)),
        include_str!("report.js")
    );
    page
}

/// One part of the page; its heading is a word of [`terms`].
struct Section {
    id: &'static str,
    body: String,
}

impl Section {
    fn heading(&self) -> &'static str {
        terms::find(Kind::Section, self.id).map_or("", |term| term.shown)
    }

    fn meaning(&self) -> &'static str {
        terms::find(Kind::Section, self.id).map_or("", |term| term.text)
    }
}

/// The parts, in their order. A part that has nothing to show is left out.
fn sections(source: &ReportSource<'_>, layout: &Layout) -> Vec<Section> {
    let summary = source.summary;
    let mut sections = Vec::new();
    let mut add = |id, body: String| sections.push(Section { id, body });
    add("critical", critical::section(source, layout));
    add("table", main_table::section(summary, source.runs));
    let answer = Answer::of(summary);
    if !answer.axes.is_empty() {
        add("choices", choices(&answer));
    }
    if !source.crossings.is_empty() {
        let body = crossings::section(source.crossings, &summary.axes);
        add("crossings", body);
    }
    let pages = points::pages(summary, source.runs);
    let how =
        "<p>A name in the table, or a mark in a plot, opens the page of its point here.</p>\n";
    add("points", how.to_owned() + &pages);
    add("compare", "<div id=\"compare-tool\"></div>".to_owned());
    if !source.runs.is_empty() {
        let map = outcome_map(summary, source.runs);
        let margin = margin_curves(summary, source.runs);
        let legend = |figure: &str| {
            let signs = terms::TERMS
                .iter()
                .filter(|term| term.kind == Kind::Sign && term.shown.contains(figure));
            words::list(&signs.collect::<Vec<_>>())
        };
        let drawn = drawn_with_keys(&map, "Outcome of every simulation", "map");
        add("map", legend("map") + &drawn);
        let drawn = drawn_with_keys(&margin, "Smallest clearance against amplitude", "margin");
        if margin.panels.iter().any(|panel| !panel.series.is_empty()) {
            add("margin", legend("margin") + &drawn);
        }
    }
    if let Some(film) = source.film {
        let body = format!(
            "<p>{}. Displacements are drawn some hundred times too large; an arm in contact is orange, and a slider whose \
             run has ended or whose asperities bear more than 0.1 mN. \
             The figures of a run without this script: <code>opshock run --plots</code>.</p>\n\
             <div id=\"film-stage\"></div>",
            escaped(&film.label)
        );
        add("film", body);
    }
    if let Some(body) = accuracy::section(summary, source.accuracy) {
        add("accuracy", body);
    }
    add("effects", effects(source));
    let saved = savings::lines(source.savings);
    if !saved.is_empty() {
        let lines = saved
            .iter()
            .map(|line| format!("<li>{}</li>\n", escaped(line)));
        add("time", format!("<ul>\n{}</ul>", lines.collect::<String>()));
    }
    add("reservations", reservations(summary));
    add("words", words::section(summary));
    add("provenance", provenance(source));
    sections
}

/// Every value of the axes to choose from, against the best.
fn choices(answer: &Answer<'_>) -> String {
    let tables = answer.tables().into_iter();
    tables
        .map(|(header, rows)| accuracy::plain_table(&header, &rows, header.len()))
        .collect()
}

/// Effects simulated for each ramp, those left out, and the rules that apply.
fn effects(source: &ReportSource<'_>) -> String {
    let mut text = String::new();
    let plan: serde_json::Value = serde_json::from_str(source.plan).unwrap_or_default();
    if let Some(ramps) = plan["ramps"].as_object() {
        text.push_str(
            "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">ramp</th><th scope=\"col\">simulated</th>\
             <th scope=\"col\">left out</th><th scope=\"col\">rules below touch</th><th scope=\"col\">rules above touch</th></tr></thead><tbody>\n",
        );
        for (ramp, plan) in ramps {
            let effects = plan["effects"].as_object();
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
                let rules = plan[key].as_array().into_iter().flatten();
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
    if text.is_empty() {
        text.push_str("<p>The results name no effects.</p>");
    }
    text
}

fn reservations(summary: &Summary) -> String {
    let mut text = String::new();
    for (place, point) in summary.points.iter().enumerate() {
        let said = terms::reservations(point);
        if said.is_empty() {
            continue;
        }
        let _ = writeln!(
            text,
            "<li><a href=\"#point-{place}\">{}</a>: {}</li>",
            escaped(&coordinates::name(summary, point)),
            escaped(&said.join(" "))
        );
    }
    if text.is_empty() {
        "<p>None: every critical shock is found.</p>".into()
    } else {
        format!("<ul>\n{text}</ul>")
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
        entry("not refined", &values);
    }
    if let Some(audit) = source.audit {
        let mut sentences = vec![audit.sentence()];
        sentences.extend(audit.differences.iter().map(ToString::to_string));
        entry("audit", &sentences.join("; "));
    }
    let cost = &summary.totals.cost;
    entry(
        "work",
        &format!(
            "{} simulations, {} without verdict; {} time steps of the head, {} film solves of up to {} unknowns, {} structure steps",
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
