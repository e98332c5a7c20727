//! Text, Markdown, CSV and JSON of what tolerances are worth.

use super::words::Valued;
use crate::report::html::worth::page;
use crate::report::table::{aligned, csv_line, plain_markdown};

/// Answer and table, as a terminal shows them.
pub fn text(valued: &Valued<'_>) -> String {
    let (header, rows) = valued.table();
    format!(
        "{}\n\n{}",
        valued.sentences().join("\n"),
        aligned(&header, &rows)
    )
}

fn markdown(valued: &Valued<'_>) -> String {
    let (header, rows) = valued.table();
    format!(
        "# {}: what tolerances are worth\n\n{}\n\n{}\nDrive: {}. {}\n\n```toml\n{}\n```\n",
        valued.answer.name,
        valued.sentences().join("\n"),
        plain_markdown(&header, &rows),
        valued.drive,
        valued.program,
        valued.tolerances.trim_end()
    )
}

/// A line for each tolerance and point.
fn csv(valued: &Valued<'_>) -> String {
    let header = [
        "tolerance",
        "point",
        "critical_low_g",
        "critical_high_g",
        "change_g",
        "uncertainty_g",
        "refined",
        "excludes_zero",
    ];
    let mut text = csv_line(&header.map(String::from));
    for row in &valued.answer.rows {
        for change in &row.changes {
            let number =
                |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
            text.push_str(&csv_line(&[
                row.name.clone(),
                change.point.clone(),
                number(change.critical_g[0]),
                number(change.critical_g[1]),
                number(change.change_g),
                number(change.uncertainty_g),
                change.refined.to_string(),
                change.excludes_zero.to_string(),
            ]));
        }
    }
    text
}

/// The answer as JSON.
pub fn json(valued: &Valued<'_>) -> serde_json::Value {
    let mut value = serde_json::to_value(valued.answer).expect("an answer is JSON");
    value["study"] = valued.study.into();
    value["drive"] = valued.drive.into();
    value["program"] = valued.program.into();
    value["answer"] = valued.sentences().join(" ").into();
    value
}

/// `worth.md`, `.csv`, `.json` and `.html`: names and bytes.
pub fn valued_files(valued: &Valued<'_>) -> Vec<(&'static str, Vec<u8>)> {
    let json = format!("{:#}\n", json(valued));
    vec![
        ("worth.md", markdown(valued).into_bytes()),
        ("worth.csv", csv(valued).into_bytes()),
        ("worth.json", json.into_bytes()),
        ("worth.html", page(valued).into_bytes()),
    ]
}
