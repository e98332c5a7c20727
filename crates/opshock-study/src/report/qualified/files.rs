//! Text, CSV and JSON of verdicts, and the files of a qualification.

use serde_json::{Value, json as value};

use super::answer::{Qualified, Tested, critical_words, reserve_words};
use super::junit::junit;
use crate::qualification::Verdict;
use crate::report::coordinates;
use crate::report::error::ReportError;
use crate::report::html::qualification::page;
use crate::report::table::{aligned, csv_line, plain_markdown};

/// Heading and a line for each requirement.
fn rows(qualified: &Qualified<'_>) -> (Vec<String>, Vec<Vec<String>>) {
    let header = [
        "requirement",
        "required (G)",
        "points",
        "runs",
        "verdict",
        "reserve of the point that decides",
    ]
    .map(String::from)
    .to_vec();
    let rows = qualified
        .tested
        .iter()
        .map(|one| {
            vec![
                one.requirement.name.clone(),
                format!("{:.1}", one.requirement.required_g()),
                one.found.points.len().to_string(),
                one.summary.totals.runs.to_string(),
                one.found.verdict.as_str().to_owned(),
                lowest(one),
            ]
        })
        .collect();
    (header, rows)
}

/// Answer, and a table with a line for each requirement, as a terminal shows them.
pub fn text(qualified: &Qualified<'_>) -> String {
    let (header, rows) = rows(qualified);
    let mut text = format!(
        "{}\n\n{}",
        qualified.sentences().join("\n"),
        aligned(&header, &rows)
    );
    if let Some(boundary) = &qualified.boundary {
        let (header, rows) = boundary.table();
        text.push_str(&format!(
            "\n{}\n\n{}",
            boundary.sentences().join("\n"),
            aligned(&header, &rows)
        ));
    }
    text
}

/// The same as Markdown, with the program and the specification.
pub fn markdown(qualified: &Qualified<'_>) -> String {
    let (header, rows) = rows(qualified);
    let mut table = plain_markdown(&header, &rows);
    if let Some(boundary) = &qualified.boundary {
        let (header, rows) = boundary.table();
        table.push_str(&format!(
            "\n## Damage boundary\n\n{}\n\n{}",
            boundary.sentences().join("\n"),
            plain_markdown(&header, &rows)
        ));
    }
    format!(
        "# {}: {}\n\n{}\n\n{table}\nDrive: {}. {} simulations. {}\n\n```toml\n{}\n```\n",
        qualified.study,
        qualified.verdict().as_str(),
        qualified.sentences().join("\n"),
        qualified.drive,
        qualified.runs(),
        qualified.program,
        qualified.spec.text.trim()
    )
}

/// The point that decides a requirement, and its reserve.
fn lowest(tested: &Tested<'_>) -> String {
    tested.worst().map_or(String::new(), |(row, at)| {
        format!(
            "{}: {}, {}",
            reserve_words(row, at),
            coordinates::name(tested.summary, row),
            critical_words(row)
        )
    })
}

/// A line for each point.
pub fn csv(qualified: &Qualified<'_>) -> String {
    let header = [
        "requirement",
        "amplitude_g",
        "required_g",
        "point",
        "verdict",
        "reason",
        "a_crit_g",
        "uncertainty_g",
        "low_g",
        "high_g",
        "reserve_pct",
        "runs",
        "status",
        "flags",
    ];
    let mut text = csv_line(&header.map(String::from));
    for tested in &qualified.tested {
        for (row, at) in tested.rows() {
            let number = |value: Option<f64>| {
                let value = value.filter(|value| value.is_finite());
                value.map_or(String::new(), |value| value.to_string())
            };
            let flags: Vec<&str> = row.flags.iter().map(|flag| flag.as_str()).collect();
            text.push_str(&csv_line(&[
                tested.requirement.name.clone(),
                tested.requirement.amplitude_g.to_string(),
                tested.requirement.required_g().to_string(),
                coordinates::name(tested.summary, row),
                at.verdict.as_str().to_owned(),
                at.open
                    .map_or(String::new(), |open| open.words().to_owned()),
                number(row.a_crit_g),
                number(row.uncertainty_g),
                number(at.interval_g.map(|[low_g, _]| low_g)),
                number(at.interval_g.map(|[_, high_g]| high_g)),
                number(at.reserve.map(|reserve| 100.0 * reserve)),
                row.runs.to_string(),
                row.status.as_str().to_owned(),
                flags.join(" "),
            ]));
        }
    }
    text
}

/// Everything as JSON: the answer, the requirements, and each with the table of its store and the verdict on every row.
pub fn json(qualified: &Qualified<'_>) -> Value {
    let requirements: Vec<Value> = qualified.tested.iter().map(requirement).collect();
    value!({
        "study": qualified.study,
        "drive": qualified.drive,
        "specification": qualified.spec.name,
        "source": qualified.spec.source,
        "program": qualified.program,
        "verdict": qualified.verdict(),
        "answer": qualified.sentences().join(" "),
        "runs": qualified.runs(),
        "requirements": requirements,
        "damage_boundary": qualified.boundary.as_ref().map(|boundary| &boundary.found),
    })
}

fn requirement(tested: &Tested<'_>) -> Value {
    let mut table = serde_json::to_value(tested.summary).expect("a table is JSON");
    let rows = table["points"].as_array_mut().into_iter().flatten();
    for (row, at) in rows.zip(&tested.found.points) {
        row["verdict"] = value!(at.verdict);
        row["reason"] = value!(at.open);
        // An open end is null.
        row["interval_g"] = value!(at.interval_g);
        row["reserve_pct"] = value!(at.reserve.map(|reserve| 100.0 * reserve));
    }
    value!({
        "name": tested.requirement.name,
        "amplitude_g": tested.requirement.amplitude_g,
        "margin_pct": tested.requirement.margin_pct,
        "required_g": tested.requirement.required_g(),
        "velocity_change_m_per_s": tested.requirement.velocity_changes_m_per_s(),
        "verdict": tested.found.verdict,
        "failing_points": tested.count(Verdict::Fails),
        "undecided_points": tested.count(Verdict::Undecided),
        "worst_point": tested.found.worst,
        "digest": table["digest"],
        "points": table["points"],
        "totals": table["totals"],
    })
}

/// `qualification.md`, `.csv`, `.json`, `.xml` and `.html`, and of a damage boundary `damage_boundary.csv`, `.svg` and `.png`:
/// names and bytes.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn qualified_files(
    qualified: &Qualified<'_>,
) -> Result<Vec<(&'static str, Vec<u8>)>, ReportError> {
    let json = format!("{:#}\n", json(qualified));
    let mut files = vec![
        ("qualification.md", markdown(qualified).into_bytes()),
        ("qualification.csv", csv(qualified).into_bytes()),
        ("qualification.json", json.into_bytes()),
        ("qualification.xml", junit(qualified).into_bytes()),
        ("qualification.html", page(qualified).into_bytes()),
    ];
    if let Some(boundary) = &qualified.boundary {
        let figure = boundary.figure();
        let [csv, svg, png] = OF_BOUNDARY;
        files.push((csv, boundary.csv().into_bytes()));
        files.push((svg, figure.svg().into_bytes()));
        files.push((png, figure.png()?));
    }
    Ok(files)
}

const OF_BOUNDARY: [&str; 3] = [
    "damage_boundary.csv",
    "damage_boundary.svg",
    "damage_boundary.png",
];

/// How a file of this name begins, where a qualification writes it only if it is asked for: these are replaced whatever they hold.
pub fn optional_file(name: &str) -> Option<&'static str> {
    OF_BOUNDARY.contains(&name).then_some("")
}
