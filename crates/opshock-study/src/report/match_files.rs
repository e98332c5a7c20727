//! Writes a match (parameters that make observations true) as Markdown, HTML, JSON, CSV, plots and studies.

use std::fmt::Write as _;

use super::chart::{
    Axis, ChartError, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value, colour,
};
use super::error::json;
use super::html::text::escaped;
use super::match_tables::{Table, maybe, summary, tables, words};
use super::table::csv_line;
use super::table::plain_markdown;
use crate::matching::{BestOfEach, Known, MatchAnswer, MatchProblem, MatchingSet, Searched};
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};

/// How a study that a match wrote begins.
pub const STUDY_OF_A_MATCH: &str = "# match \"";

/// Names and bytes of `match.md`, `.html`, `.json`, `observations.csv`, `parameters.csv`, `samples.csv`, `ranges.svg`
/// and `.png`, `choices.svg` and `.png` where each choice was searched, and a `matching-N.toml` for each set shown.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn match_files(
    problem: &MatchProblem,
    answer: &MatchAnswer,
    found: &Searched,
    program: &str,
) -> Result<Vec<(String, Vec<u8>)>, ChartError> {
    let figure = ranges(answer);
    let tables = tables(answer);
    let from = format!(
        "{program}, physics versions {PHYSICS_STRUCTURE} (disk and ramp) and {PHYSICS_HEAD} (head)"
    );
    let mut document = serde_json::to_value(answer).expect("an answer serialises");
    document["program"] = program.into();
    document["physics_structure"] = PHYSICS_STRUCTURE.into();
    document["physics_head"] = PHYSICS_HEAD.into();
    let mut files = vec![
        (
            "match.md".to_owned(),
            markdown(answer, &tables, &from).into_bytes(),
        ),
        (
            "match.html".to_owned(),
            page(answer, &tables, &figure, &from).into_bytes(),
        ),
        ("match.json".to_owned(), json(&document)),
        (
            "observations.csv".to_owned(),
            observations_csv(answer).into_bytes(),
        ),
        (
            "parameters.csv".to_owned(),
            parameters_csv(answer).into_bytes(),
        ),
        (
            "samples.csv".to_owned(),
            samples_csv(problem, found).into_bytes(),
        ),
        ("ranges.svg".to_owned(), figure.svg().into_bytes()),
        ("ranges.png".to_owned(), figure.png()?),
    ];
    if let Some(each) = &answer.best_of_each {
        let figure = choices(answer, each);
        files.push(("choices.svg".to_owned(), figure.svg().into_bytes()));
        files.push(("choices.png".to_owned(), figure.png()?));
    }
    let sets = answer.matching.iter().chain(&answer.nearest).enumerate();
    for (place, set) in sets {
        let name = match set.fails.is_empty() {
            true => format!("matching-{}.toml", place + 1),
            false => "nearest.toml".to_owned(),
        };
        if let Some(text) = study_text(problem, answer, set, &from) {
            files.push((name, text.into_bytes()));
        }
    }
    Ok(files)
}

fn markdown(answer: &MatchAnswer, tables: &[Table], from: &str) -> String {
    let mut text = format!("# Match: {}\n\n{}\n", answer.name, summary(answer));
    for table in tables {
        let _ = write!(text, "\n## {}\n\n{}\n\n", table.title, table.words);
        text += &plain_markdown(&table.head, &table.rows);
    }
    let _ = write!(text, "\nWaves:\n\n");
    for wave in &answer.waves {
        let _ = writeln!(
            text,
            "* {}: {} tried, {} kept",
            wave.name, wave.tried, wave.kept
        );
    }
    let _ = write!(text, "\n{from}\n");
    text
}

fn page(answer: &MatchAnswer, tables: &[Table], figure: &Figure, from: &str) -> String {
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}</title>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <style>{style}</style></head><body>\n<h1>Match: {name}</h1>\n<p>{summary}</p>\n{svg}\n",
        name = escaped(&answer.name),
        style = include_str!("html/style.css"),
        summary = escaped(&summary(answer)),
        svg = figure.svg(),
    );
    for table in tables {
        let row = |tag: &str, cells: &[String]| {
            let cells: String = cells
                .iter()
                .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)))
                .collect();
            format!("<tr>{cells}</tr>\n")
        };
        let rows: String = table.rows.iter().map(|cells| row("td", cells)).collect();
        let _ = write!(
            text,
            "<h2>{}</h2>\n<p>{}</p>\n<table>\n{}{rows}</table>\n",
            table.title,
            escaped(&table.words),
            row("th", &table.head)
        );
    }
    let _ = write!(text, "<p>{}</p>\n</body></html>\n", escaped(from));
    text
}

/// Ranges after over ranges before, as cumulative probabilities of the prior.
fn ranges(answer: &MatchAnswer) -> Figure {
    let best = answer.matching.first().or(answer.nearest.as_ref());
    let samples = answer
        .parameters
        .iter()
        .enumerate()
        .filter_map(|(place, one)| {
            let [low, high] = one.after_probability?;
            let y = best.map_or(0.5 * (low + high), |best| best.unit[place]);
            Some(Sample {
                x: place as f64 + 1.0,
                value: Value::Known {
                    y,
                    low: low.min(y),
                    high: high.max(y),
                },
                open: false,
                note: one
                    .after
                    .as_ref()
                    .map(|ends| format!("{} to {}", ends[0], ends[1]))
                    .unwrap_or_default(),
            })
        });
    let names = answer.parameters.iter().enumerate();
    let axis =
        Axis::linear("").named(names.map(|(place, one)| (place as f64 + 1.0, one.name.clone())));
    let left = Series::marked(
        "best set, and what is left",
        colour::BLUE,
        None,
        (Marker::Circle, Fill::Full),
        samples.collect(),
    );
    let n = answer.parameters.len() as f64;
    let ends = |y: f64| {
        Series::curve(
            "range before",
            colour::GREY,
            Dash::Dashed,
            vec![(0.5, y), (n + 0.5, y)],
        )
    };
    Figure {
        title: answer.name.clone(),
        subtitle: "what the observations leave of each parameter's range".into(),
        columns: 1,
        panel_px: (140.0 + 90.0 * n, 340.0),
        panels: vec![Panel {
            title: String::new(),
            x: axis.between(0.5, n + 0.5),
            y: Axis::linear("Cumulative probability before").between(-0.05, 1.05),
            series: vec![ends(0.0), ends(1.0), left],
            rules: Vec::new(),
            shaded: None,
        }],
    }
}

/// Observations that hold with the best set of each choice.
fn choices(answer: &MatchAnswer, each: &BestOfEach) -> Figure {
    let count = |short: fn(&MatchingSet) -> &Vec<String>| {
        let places = each.choices.iter().enumerate();
        let found = places.filter_map(|(place, (.., best))| Some((place, best.as_ref()?)));
        let sample = |(place, best): (usize, &MatchingSet)| {
            let y = (answer.ranged() - short(best).len()) as f64;
            Sample {
                x: place as f64 + 1.0,
                value: Value::Known { y, low: y, high: y },
                open: false,
                note: short(best).join(", "),
            }
        };
        found.map(sample).collect::<Vec<_>>()
    };
    let held = Series::marked(
        "hold",
        colour::BLUE,
        None,
        (Marker::Circle, Fill::Open),
        count(|best| &best.fails),
    );
    let safe = Series::marked(
        "hold by their numerical uncertainty",
        colour::BLUE,
        None,
        (Marker::Circle, Fill::Full),
        count(|best| &best.falls_short),
    );
    let names = each.choices.iter().enumerate();
    let axis = Axis::linear(&each.parameter)
        .named(names.map(|(place, (value, ..))| (place as f64 + 1.0, value.clone())));
    let (n, all) = (each.choices.len() as f64, answer.ranged() as f64);
    let every = Series::curve(
        "all",
        colour::GREY,
        Dash::Dashed,
        vec![(0.5, all), (n + 0.5, all)],
    );
    Figure {
        title: answer.name.clone(),
        subtitle: format!(
            "observations that hold with the best set, {}",
            each.parameter
        ),
        columns: 1,
        panel_px: (140.0 + 70.0 * n, 340.0),
        panels: vec![Panel {
            title: String::new(),
            x: axis.between(0.5, n + 0.5),
            y: Axis::linear("Observations").between(0.0, all + 1.0),
            series: vec![every, held, safe],
            rules: Vec::new(),
            shaded: None,
        }],
    }
}

fn csv(rows: impl IntoIterator<Item = Vec<String>>) -> String {
    rows.into_iter().map(|row| csv_line(&row)).collect()
}

fn exact(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:?}"))
}

fn observations_csv(answer: &MatchAnswer) -> String {
    let head = words(&[
        "observation",
        "stage",
        "low",
        "high",
        "numerical_uncertainty",
        "draws_with",
        "draws",
        "share_low",
        "share_high",
        "best",
        "margin",
        "source",
    ]);
    let rows = answer.observations.iter().map(|one| {
        let [low, high] = one.range.unwrap_or([None, None]);
        let share = one.share.map(|share| {
            [
                share.with.to_string(),
                share.of.to_string(),
                exact(Some(share.interval[0])),
                exact(Some(share.interval[1])),
            ]
        });
        let mut row = vec![
            one.name.clone(),
            one.stage.to_owned(),
            exact(low),
            exact(high),
            exact(Some(one.numerical_uncertainty)),
        ];
        row.extend(share.unwrap_or_default());
        row.extend([exact(one.best), exact(one.best_margin), one.source.clone()]);
        row
    });
    csv(std::iter::once(head).chain(rows))
}

fn parameters_csv(answer: &MatchAnswer) -> String {
    let mut head = words(&[
        "parameter",
        "keys",
        "before_low",
        "before_high",
        "after_low",
        "after_high",
        "source",
    ]);
    head.extend(
        answer
            .observations
            .iter()
            .map(|one| format!("says:{}", one.name)),
    );
    let rows = answer.parameters.iter().enumerate().map(|(place, one)| {
        let after = one.after.clone().unwrap_or_default();
        let mut row = vec![one.name.clone(), one.keys.join(" ")];
        row.extend(one.before.clone());
        row.extend(after);
        row.push(one.source.clone());
        row.extend(
            answer
                .observations
                .iter()
                .map(|observation| exact(observation.says[place])),
        );
        row
    });
    csv(std::iter::once(head).chain(rows))
}

/// Every parameter set with its numbers; a number that does not exist is `none`, one that was not asked for empty.
fn samples_csv(problem: &MatchProblem, found: &Searched) -> String {
    let mut head = words(&["wave"]);
    head.extend(problem.parameters.iter().map(|one| one.name.clone()));
    head.extend(problem.observations.iter().map(|one| one.name.clone()));
    let rows = found.samples.iter().map(|sample| {
        let wave = sample
            .wave
            .map_or_else(|| "refinement".to_owned(), |wave| wave.to_string());
        let mut row = vec![wave];
        row.extend(
            problem
                .parameters
                .iter()
                .zip(&sample.unit)
                .map(|(one, p)| one.words(*p)),
        );
        row.extend(sample.numbers.iter().map(|(known, _)| match known {
            Known::NotAsked => String::new(),
            Known::Missing => "none".to_owned(),
            Known::Is(value) => exact(Some(*value)),
        }));
        row
    });
    csv(std::iter::once(head).chain(rows))
}

/// The study with a set's values; `None` where the study refuses them.
fn study_text(
    problem: &MatchProblem,
    answer: &MatchAnswer,
    set: &MatchingSet,
    from: &str,
) -> Option<String> {
    let study = problem.with_values(&set.unit).ok()?;
    let mut lines = vec![summary_of(answer, set)];
    for (parameter, value) in problem.parameters.iter().zip(&set.values) {
        lines.push(format!(
            "matched: {} = {value} ({})",
            parameter.name, parameter.source
        ));
    }
    lines.push(from.to_owned());
    let mut text = String::new();
    for line in lines {
        // A text of several lines stays one comment.
        let _ = writeln!(text, "# {}", line.replace(char::is_control, " "));
    }
    let _ = write!(text, "\n{}", study.resolved_toml());
    Some(text)
}

fn summary_of(answer: &MatchAnswer, set: &MatchingSet) -> String {
    match set.fails.is_empty() {
        true => format!(
            "match {:?}: every observation holds, with a smallest margin of {} numerical uncertainties ({})",
            answer.name,
            maybe(set.smallest_margin),
            set.decided_by
        ),
        false => format!(
            "match {:?}: the nearest set, without {}",
            answer.name,
            set.fails.join(", ")
        ),
    }
}
