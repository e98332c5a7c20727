//! Text, CSV, JSON and studies of a population.

use std::fmt::Write as _;

use super::figure::fragility_figure;
use super::words::Populated;
use crate::report::error::ReportError;
use crate::report::html::population::page;
use crate::report::table::{aligned, csv_line, plain_markdown};

/// Beginning of a study that a population wrote.
const STUDY_OF_A_POPULATION: &str = "# opshock yield: drive ";

/// How a file of this name begins, if a population wrote it.
pub fn file_of_a_population(name: &str) -> Option<&'static str> {
    let number = name
        .strip_prefix("drive-")
        .and_then(|rest| rest.strip_suffix(".toml"));
    if number.is_some_and(|number| number.parse::<u64>().is_ok()) {
        return Some(STUDY_OF_A_POPULATION);
    }
    // Figures of this name are replaced whatever they hold.
    ["yield.svg", "yield.png"].contains(&name).then_some("")
}

/// Answer and tables, as a terminal shows them.
pub fn text(populated: &Populated<'_>) -> String {
    let mut text = populated.sentences().join("\n");
    let (header, rows) = populated.requirements();
    let _ = write!(text, "\n\n{}", aligned(&header, &rows));
    let (header, rows) = populated.sensitivities();
    if !rows.is_empty() {
        let _ = write!(text, "\n{}", aligned(&header, &rows));
    }
    let (header, rows) = populated.worst();
    let _ = write!(text, "\nWorst drives\n{}", aligned(&header, &rows));
    text
}

/// The same as Markdown, with what it rests on.
pub fn markdown(populated: &Populated<'_>) -> String {
    let table = |(header, rows): (Vec<String>, Vec<Vec<String>>)| plain_markdown(&header, &rows);
    let mut text = format!(
        "# {}\n\n{}\n\n{}\n",
        populated.answer.name,
        populated.sentences().join("\n"),
        table(populated.requirements())
    );
    if !populated.answer.sensitivity.is_empty() {
        let matters = table(populated.sensitivities());
        let _ = write!(text, "## Which tolerance matters\n\n{matters}\n");
    }
    let _ = write!(
        text,
        "## Worst drives\n\n{}\n{}\n\nDrive: {}. {}\n\n```toml\n{}\n```\n\n```toml\n{}\n```\n",
        table(populated.worst()),
        populated.basis(),
        populated.drive,
        populated.program,
        populated.tolerances.text.trim_end(),
        populated.spec.text.trim_end(),
    );
    text
}

/// A line for each drive: its values and verdicts.
fn csv(populated: &Populated<'_>) -> String {
    let spec = populated.spec;
    let (tolerances, drives) = (populated.tolerances, populated.drives);
    let values = |index: u64| tolerances.values(&tolerances.draw(index));
    let keys = values(0).into_iter().map(|(key, _)| key);
    let names = spec.requirements.iter().map(|one| one.name.clone());
    let header = ["drive".to_owned(), "verdict".to_owned()];
    let header: Vec<String> = header.into_iter().chain(names).chain(keys).collect();
    let mut text = csv_line(&header);
    for drive in drives {
        let mut row = vec![
            (drive.index + 1).to_string(),
            drive.overall().as_str().to_owned(),
        ];
        let verdicts = (0..spec.requirements.len()).map(|place| drive.verdict(place));
        row.extend(verdicts.map(|verdict| verdict.as_str().to_owned()));
        row.extend(
            values(drive.index)
                .into_iter()
                .map(|(_, text)| text.unwrap_or_default()),
        );
        text.push_str(&csv_line(&row));
    }
    text
}

/// The answer as JSON.
pub fn json(populated: &Populated<'_>) -> serde_json::Value {
    let mut value = serde_json::to_value(populated.answer).expect("an answer is JSON");
    value["study"] = populated.study.into();
    value["drive"] = populated.drive.into();
    value["program"] = populated.program.into();
    value["answer"] = populated.sentences().join(" ").into();
    value
}

/// `yield.md`, `.csv`, `.json`, `.html`, `yield.svg` and `.png`, and `drive-N.toml` for each of the worst drives.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn populated_files(populated: &Populated<'_>) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let figure = fragility_figure(populated);
    let json = format!("{:#}\n", json(populated));
    let mut files = vec![
        ("yield.md".to_owned(), markdown(populated).into_bytes()),
        ("yield.csv".to_owned(), csv(populated).into_bytes()),
        ("yield.json".to_owned(), json.into_bytes()),
        ("yield.html".to_owned(), page(populated).into_bytes()),
    ];
    if figure.panels.iter().any(|panel| !panel.series.is_empty()) {
        files.push(("yield.svg".to_owned(), figure.svg().into_bytes()));
        files.push(("yield.png".to_owned(), figure.png()?));
    }
    for one in &populated.answer.worst {
        let drawn = populated.tolerances.draw(one.drive - 1);
        // A drive of the population was a study when it was simulated.
        let Ok(study) = populated.tolerances.study_of(&drawn) else {
            continue;
        };
        let text = format!(
            "{STUDY_OF_A_POPULATION}{} of {:?} (seed {}): {} at {}, {}\n{}",
            one.drive,
            populated.answer.name,
            populated.answer.seed,
            one.verdict.as_str(),
            one.requirement,
            one.point,
            study.resolved_toml()
        );
        files.push((format!("drive-{}.toml", one.drive), text.into_bytes()));
    }
    Ok(files)
}
