//! Writes critical shocks as a table: terminal, Markdown, CSV.

use super::terms::{self, Kind};
use crate::store::summary::{CONTRIBUTIONS, PointSummary, Status, Summary};

/// Columns of the table before those of the study's axes.
pub(super) const BEFORE_AXES: [&str; 3] = ["ramp", "pulse_ms", "sign"];
/// Columns behind them.
pub(super) const AFTER_AXES: [&str; 9] = [
    "a_crit_g",
    "uncertainty_g",
    "half_min_height_g",
    "survived_g",
    "failed_g",
    "onset_g",
    "runs",
    "status",
    "flags",
];

/// Column that the table of the page has beside them.
pub(super) const OF_PAGE: &str = "mechanism";

/// CSV with the header `ramp,pulse_ms,sign,<axes>,a_crit_g,uncertainty_g,half_min_height_g,survived_g,
/// failed_g,onset_g,runs,status,flags`. A missing value is empty; flags are joined by `;`; numbers carry all their
/// digits. Nothing in it depends on the machine.
pub fn csv(summary: &Summary) -> String {
    let mut header: Vec<String> = BEFORE_AXES.map(String::from).to_vec();
    header.extend(summary.axes.iter().cloned());
    header.extend(AFTER_AXES.map(String::from));
    let mut text = csv_line(&header);
    for point in &summary.points {
        let number = |v: Option<f64>| v.map_or(String::new(), |v| v.to_string());
        let mut row = vec![
            point.ramp.clone(),
            point.pulse_ms.to_string(),
            point.sign.as_str().to_owned(),
        ];
        row.extend(point.axes.iter().map(ToString::to_string));
        row.extend([
            number(point.a_crit_g),
            number(point.uncertainty_g),
            number(point.half_min_height_g),
            number(point.survived_g),
            number(point.failed_g),
            number(point.onset_g),
            point.runs.to_string(),
            point.status.as_str().to_owned(),
            flags(point, ";"),
        ]);
        text.push_str(&csv_line(&row));
    }
    text
}

/// A line of CSV (RFC 4180: a cell with comma, quote or line break is quoted).
pub fn csv_line(cells: &[String]) -> String {
    let quoted: Vec<String> = cells
        .iter()
        .map(|cell| {
            if cell.contains([',', '"', '\n', '\r']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.clone()
            }
        })
        .collect();
    quoted.join(",") + "\n"
}

/// A Markdown table of words.
pub(super) fn plain_markdown(header: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = line(&vec!["---".to_owned(); header.len()]);
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(header) + &rule + &rows
}

/// Markdown table below its heading and the `answer` in words, with the meaning of columns and flags.
pub fn markdown(summary: &Summary, answer: &str, provenance: &str) -> String {
    let (header, rows) = readable(summary);
    let escape = |cell: &String| cell.replace('|', "\\|");
    let mut text = format!("# {}\n\n", summary.study);
    if !answer.is_empty() {
        text.push_str(&format!("{answer}\n\n"));
    }
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    text.push_str(&line(header.iter().map(escape).collect()));
    let words = 1 + summary.axes.len();
    text.push_str(&line(
        (0..header.len())
            .map(|column| {
                let wordy = column == 0
                    || column == 2
                    || (3..2 + words).contains(&column)
                    || column + 2 >= header.len();
                if wordy {
                    "---".into()
                } else {
                    "---:".to_owned()
                }
            })
            .collect(),
    ));
    for row in &rows {
        text.push_str(&line(row.iter().map(escape).collect()));
    }
    text.push_str(&legend(summary));
    text.push_str(&parts_table(summary));
    if !provenance.is_empty() {
        text.push_str(&format!("\n{provenance}\n"));
    }
    text
}

/// Aligned table for a terminal.
pub fn terminal(summary: &Summary) -> String {
    let (header, rows) = readable(summary);
    let mut text = format!("{}\n{}", summary.study, aligned(&header, &rows));
    text.push_str(&format!("{}\n", counts(summary)));
    if let Some(share) = uncertainty_cost(summary) {
        text.push_str(&format!("uncertainty intervals: {share}\n"));
    }
    text
}

/// How many points are answered, and what became of the others.
pub fn counts(summary: &Summary) -> String {
    let totals = &summary.totals;
    let lacking = summary.points.iter().filter(|row| row.lacks_uncertainty());
    let bracketed = lacking.count();
    let open = match bracketed {
        0 => "not finished".to_owned(),
        bracketed => format!("not finished ({bracketed} of them lack their uncertainty only)"),
    };
    let mut text = format!(
        "{} points: {} critical shocks found",
        totals.points, totals.ok
    );
    for (count, what) in [
        (totals.above_range, "above the searched range"),
        (totals.below_range, "below the searched range"),
        (totals.undecided, "without verdict"),
        (totals.open, &open),
    ] {
        if count > 0 {
            text.push_str(&format!(", {count} {what}"));
        }
    }
    text.push_str(&format!("; {} simulations", totals.runs));
    text
}

/// What columns mean, and the statuses and flags that rows have, a line each.
pub fn meanings(summary: &Summary) -> Vec<String> {
    let has = |status: &Status| summary.points.iter().any(|point| point.status == *status);
    let statuses = Status::ALL
        .into_iter()
        .filter(|status| *status != Status::Ok);
    let statuses = statuses.filter(has).map(terms::of_status);
    let flags = terms::flags_of(&summary.points);
    let line = |term: &terms::Term| format!("`{}`: {}", term.name, term.text);
    statuses.chain(flags).map(line).collect()
}

fn legend(summary: &Summary) -> String {
    let mut text = String::from("\n");
    for term in terms::legend_columns() {
        text.push_str(&format!("- {}: {}\n", term.shown, term.text));
    }
    for line in meanings(summary) {
        text.push_str(&format!("- {line}\n"));
    }
    text
}

/// Header and rows in columns: the first and the last two flush left, the others right.
pub(super) fn aligned(header: &[String], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        std::iter::once(header)
            .chain(rows.iter().map(Vec::as_slice))
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let last = header.len() - 1;
    let mut text = String::new();
    for row in std::iter::once(header).chain(rows.iter().map(Vec::as_slice)) {
        let cells: Vec<String> = row
            .iter()
            .enumerate()
            .map(|(column, cell)| {
                let pad = " ".repeat(widths[column] - cell.chars().count());
                if column == 0 || column + 1 >= last {
                    format!("{cell}{pad}")
                } else {
                    format!("{pad}{cell}")
                }
            })
            .collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// Runs and work of the uncertainty intervals beside those of the search; `None` without any.
pub(super) fn uncertainty_cost(summary: &Summary) -> Option<String> {
    let totals = &summary.totals;
    let search = totals.film_work - totals.uncertainty_film_work;
    (totals.uncertainty_runs > 0 && search > 0).then(|| {
        format!(
            "{} of the {} runs, {:.0} % more than the search's own work on the film (solves times cells)",
            totals.uncertainty_runs,
            totals.runs,
            100.0 * totals.uncertainty_film_work as f64 / search as f64
        )
    })
}

/// What a reader of the contributions must know.
pub(super) fn contributions_note(summary: &Summary) -> String {
    let mut text = String::from(
        "Half of each contribution, in per cent of A_crit; they add up to the half-width of the interval. The bracket of \
         the search, and what a refined simulation has shown, lie on one side, the others on both. SF 3 \
         (safety factor 3): the error did not fall as its method predicts (formal order), so that it is taken 3 times instead of 1.25 times; \
         the bracket is taken once.",
    );
    for name in contribution_names(summary) {
        if let Some(term) = terms::find(Kind::Contribution, name) {
            text.push_str(&format!(" {}: {}", term.shown, term.text));
        }
    }
    text
}

/// The contributions that a row has, in their order.
fn contribution_names(summary: &Summary) -> Vec<&'static str> {
    let has = |name: &&str| {
        let own = |point: &PointSummary| point.contributions.iter().any(|(known, _)| known == name);
        summary.points.iter().any(own)
    };
    CONTRIBUTIONS.into_iter().filter(has).collect()
}

/// Half the contributions of every uncertainty interval as per cent of `A_crit`, header and rows; `SF 3` marks the safety
/// factor 3. `None` where the intervals have no other contribution than the bracket.
pub(super) fn contributions(summary: &Summary) -> Option<(Vec<String>, Vec<Vec<String>>)> {
    let names = contribution_names(summary);
    if names.len() < 2 {
        return None;
    }
    let mut header: Vec<String> = ["ramp", "pulse (ms)", "sign"].map(String::from).to_vec();
    header.extend(summary.axes.iter().cloned());
    header.push("half-width (%)".into());
    header.extend(names.iter().map(|name| format!("{name} (%)")));
    let is_refined = summary.points.iter().any(|point| !point.levels.is_empty());
    if is_refined {
        header.push("refinement levels".into());
    }
    let mut rows = Vec::new();
    for point in &summary.points {
        let Some(a_crit_g) = point.a_crit_g else {
            continue;
        };
        let per_cent = |value_g: f64| format!("{:.2}", 100.0 * value_g / a_crit_g);
        let mut row = vec![
            point.ramp.clone(),
            point.pulse_ms.to_string(),
            point.sign.as_str().to_owned(),
        ];
        row.extend(point.axes.iter().map(ToString::to_string));
        row.push(point.uncertainty_g.map_or(String::new(), per_cent));
        row.extend(names.iter().map(|name| {
            let contribution = point.contributions.iter().find(|(known, _)| known == name);
            contribution.map_or(String::new(), |(_, contribution)| {
                let wide = if contribution.factor > 2.0 {
                    " SF 3"
                } else {
                    ""
                };
                format!(
                    "{}{wide}",
                    per_cent(0.5 * (contribution.low_g + contribution.high_g))
                )
            })
        }));
        if is_refined {
            row.push(point.levels.clone());
        }
        rows.push(row);
    }
    Some((header, rows))
}

fn parts_table(summary: &Summary) -> String {
    let Some((header, rows)) = contributions(summary) else {
        return String::new();
    };
    let words = 3 + summary.axes.len();
    let rules: String = (0..header.len())
        .map(|column| match column == 1 || column >= words {
            true => " ---: |",
            false => " --- |",
        })
        .collect();
    let mut text = format!(
        "\n## What the uncertainty intervals are made of\n\n| {} |\n|{rules}\n",
        header.join(" | ")
    );
    for row in rows {
        text.push_str(&format!("| {} |\n", row.join(" | ")));
    }
    text.push_str(&format!("\n{}", contributions_note(summary)));
    if let Some(cost) = uncertainty_cost(summary) {
        text.push_str(&format!(" Cost: {cost}."));
    }
    text.push('\n');
    text
}

/// Header and rows as a person reads them; without the change by half the minimum film height where no row has it.
pub(super) fn readable(summary: &Summary) -> (Vec<String>, Vec<Vec<String>>) {
    let mut header: Vec<String> = ["ramp", "pulse (ms)", "sign"].map(String::from).to_vec();
    header.extend(summary.axes.iter().cloned());
    let changes = summary
        .points
        .iter()
        .any(|point| point.half_min_height_g.is_some());
    header.extend(["A_crit (G)", "uncertainty (G)"].map(String::from));
    header.extend(changes.then(|| "half min. height (G)".to_owned()));
    header.extend(
        [
            "survived (G)",
            "failed (G)",
            "first touch (G)",
            "runs",
            "status",
            "flags",
        ]
        .map(String::from),
    );
    let rows = summary
        .points
        .iter()
        .map(|point| {
            let mut row = vec![
                point.ramp.clone(),
                point.pulse_ms.to_string(),
                point.sign.as_str().to_owned(),
            ];
            row.extend(point.axes.iter().map(ToString::to_string));
            row.extend([critical_words(point), uncertainty_words(point)]);
            row.extend(changes.then(|| half_min_height_words(point)));
            row.extend([
                tenths(point.survived_g),
                tenths(point.failed_g),
                tenths(point.onset_g),
                point.runs.to_string(),
                point.status.as_str().to_owned(),
                flags(point, ", "),
            ]);
            row
        })
        .collect();
    (header, rows)
}

/// The reported critical shock or its bound, G; empty where neither is known.
fn critical_words(row: &PointSummary) -> String {
    let sign = match row.status {
        Status::Ok => "",
        Status::AboveRange => "> ",
        Status::BelowRange => "< ",
        Status::Undecided | Status::Open => return String::new(),
    };
    row.known_g()
        .map_or(String::new(), |value| format!("{sign}{value:.1}"))
}

/// Half-width of the uncertainty interval, G; empty where it is not known.
pub(super) fn uncertainty_words(row: &PointSummary) -> String {
    row.uncertainty_g
        .map_or(String::new(), |half| format!("+-{half:.1}"))
}

/// Change of the critical shock with half the minimum film height, G; empty where it is not known.
fn half_min_height_words(row: &PointSummary) -> String {
    row.half_min_height_g
        .map_or(String::new(), |change| format!("{change:+.1}"))
}

fn tenths(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:.1}"))
}

fn flags(point: &PointSummary, between: &str) -> String {
    let words: Vec<&str> = point.flags.iter().map(|flag| flag.as_str()).collect();
    words.join(between)
}
