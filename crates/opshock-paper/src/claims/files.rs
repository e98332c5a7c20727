//! Writes the paper's statements with their answers as files: Markdown, CSV, JSON.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::answer::{ClaimRow, tally};
use opshock_study::report::table::csv_line;
use opshock_study::report::{ReportError, json};
use opshock_study::store::aside::write_all;
use serde::Serialize;

/// The table with where it comes from.
#[derive(Clone, Debug, Serialize)]
pub struct ClaimTable {
    /// Study's name.
    pub study: String,
    /// Digest of the study.
    pub digest: String,
    /// Program.
    pub program: String,
    /// Where the critical shocks come from.
    pub critical: Option<String>,
    /// Whether the rows say what they rest on.
    pub has_sensitivity: bool,
    /// Lines.
    pub claims: Vec<ClaimRow>,
}

impl ClaimTable {
    /// The Markdown of `claims.md`.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# The paper's statements\n\n{}\n\n\
             | where | the paper says | here | holds with | answer | changes with |\n\
             | --- | --- | --- | --- | --- | --- |\n",
            tally(&self.claims, self.has_sensitivity)
        );
        for row in &self.claims {
            let cells = [
                row.place.to_owned(),
                row.paper.to_owned(),
                number_cell(row),
                row.holds_with.clone(),
                row.answer.words().to_owned(),
                row.depends_on.join("; "),
            ];
            let _ = writeln!(
                text,
                "| {} |",
                cells.map(|cell| cell.replace('|', "\\|")).join(" | ")
            );
        }
        text.push_str(
            "\n± is the largest change of the number when one discretisation parameter is refined by one step \
             (that parameter in brackets). \"Beyond the intervals\": with both critical shocks wrong by all of \
             their uncertainty intervals, in opposite directions, the answer stays. \"About\" in the paper is \
             met within 10 %, a bare figure within 5 %; other bounds are ours. Sign +: the disk first \
             moves towards the slider.\n",
        );
        text.push_str(if self.has_sensitivity {
            "Ranges of parameters: `sensitivity.md`.\n"
        } else {
            "What a statement rests on among the parameters the paper does not print was not measured \
             (`--sensitivity`).\n"
        });
        text.push_str(&self.parts_markdown());
        let _ = write!(
            text,
            "\n{}, study {} ({}){}\n",
            self.program,
            self.study,
            self.digest,
            self.critical
                .as_ref()
                .map_or(String::new(), |from| format!("; critical shocks: {from}"))
        );
        text
    }

    fn parts_markdown(&self) -> String {
        let mut text = String::from("\n## Critical shocks, place by place\n");
        let mut is_empty = true;
        for row in &self.claims {
            let Some(found) = row.finding.as_ref().filter(|found| !found.parts.is_empty()) else {
                continue;
            };
            is_empty = false;
            let _ = writeln!(
                text,
                "\n{}: {}; {}\n",
                row.paper, row.number, row.holds_with
            );
            text.push_str(
                "| place | number | by the uncertainty intervals | holds |\n| --- | ---: | ---: | --- |\n",
            );
            for part in &found.parts {
                let uncertainty = part.uncertainty.map_or(String::new(), |[low, high]| {
                    format!("{} to {}", short(low), short(high))
                });
                let _ = writeln!(
                    text,
                    "| {} | {} | {uncertainty} | {} |",
                    part.at,
                    short(part.value),
                    if part.holds { "yes" } else { "no" }
                );
            }
        }
        if is_empty { String::new() } else { text }
    }

    /// The CSV of `claims.csv`.
    pub fn csv(&self) -> String {
        let header = [
            "id",
            "place",
            "paper",
            "number",
            "unit",
            "value",
            "change_with_finer_discretisation",
            "finer_discretisation",
            "holds_with",
            "holds_with_own_values",
            "answer",
            "depends_on",
            "places_beyond_uncertainties",
            "places",
            "note",
        ];
        let mut text = csv_line(&header.map(String::from));
        for row in &self.claims {
            let found = row.finding.as_ref();
            let spread = row.spread.as_ref();
            let maybe = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
            let count = |place: usize| {
                row.beyond_the_uncertainties
                    .map_or(String::new(), |counts| counts[place].to_string())
            };
            text.push_str(&csv_line(&[
                row.id.into(),
                row.place.into(),
                row.paper.into(),
                row.number.into(),
                row.unit.into(),
                maybe(found.and_then(|found| found.value)),
                maybe(spread.and_then(|spread| spread.change)),
                spread.map_or(String::new(), |spread| spread.discretisation.clone()),
                row.holds_with.clone(),
                found.map_or(String::new(), |found| found.holds.to_string()),
                row.answer.words().into(),
                row.depends_on.join("; "),
                count(0),
                count(1),
                found.map_or(String::new(), |found| found.note.clone()),
            ]));
        }
        text
    }
}

fn number_cell(row: &ClaimRow) -> String {
    let Some(found) = &row.finding else {
        return String::new();
    };
    let mut text = format!("{}: ", row.number);
    match found.value {
        None => text.push_str("none"),
        Some(value) => {
            text.push_str(&short(value));
            let spread = row.spread.as_ref();
            if let Some((change, discretisation)) =
                spread.and_then(|s| Some((s.change?, &s.discretisation)))
            {
                let _ = match change {
                    0.0 => write!(text, " ± 0"),
                    _ => write!(text, " ± {} ({discretisation})", short_change(change)),
                };
            }
            if !row.unit.is_empty() {
                let _ = write!(text, " {}", row.unit);
            }
        }
    }
    if !found.note.is_empty() {
        let _ = write!(text, "; {}", found.note);
    }
    if let Some([sure, all]) = row.beyond_the_uncertainties {
        let _ = write!(text, "; {sure} of {all} beyond the intervals");
    }
    text
}

/// Four digits.
pub(super) fn short(value: f64) -> String {
    if value.is_infinite() {
        return "unbounded".into();
    }
    let digits = match value.abs() {
        v if v >= 1000.0 || v == 0.0 => 0,
        v => (3 - v.log10().floor() as i32).clamp(0, 6) as usize,
    };
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Two digits.
fn short_change(value: f64) -> String {
    match value {
        v if v >= 10.0 => format!("{v:.0}"),
        v if v >= 1e-4 => {
            let digits = (1 - v.log10().floor() as i32).clamp(0, 6) as usize;
            format!("{v:.digits$}")
        }
        v => format!("{v:.0e}"),
    }
}

/// Writes `claims.md`, `claims.csv` and `claims.json` into `folder`, which is made when it is
/// missing; returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_claims(folder: &Path, table: &ClaimTable) -> Result<Vec<PathBuf>, ReportError> {
    let files = [
        ("claims.md", table.markdown().into_bytes()),
        ("claims.csv", table.csv().into_bytes()),
        ("claims.json", json(table)),
    ];
    Ok(write_all(folder, files)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::sensitivity_files::markdown;
    use crate::claims::{CLAIMS, Finding, Found, Row, Sensitivity, rows};

    #[test]
    fn both_pages_give_every_statement_the_same_answer() {
        let finding = |holds| {
            Some(Finding {
                value: Some(1.0),
                holds,
                ..Finding::default()
            })
        };
        // The coarse search meets every statement at every end; the study itself does not meet the second.
        let found = Some(Found {
            value: None,
            holds: true,
        });
        let all = Sensitivity {
            study: "d".into(),
            program: "opshock".into(),
            physics: None,
            coarse: vec!["a".into()],
            rows: CLAIMS
                .iter()
                .map(|claim| Row {
                    claim: claim.id.into(),
                    base: found,
                    sides: Vec::new(),
                })
                .collect(),
        };
        let own = (0..CLAIMS.len()).map(|place| finding(place != 1)).collect();
        let claims = rows(own, &[], Some(&all));
        let rests = markdown(&all, &claims);
        let table = ClaimTable {
            study: "s".into(),
            digest: "d".into(),
            program: "opshock".into(),
            critical: None,
            has_sensitivity: true,
            claims,
        };
        let table = table.markdown();
        for page in [&rests, &table] {
            let reported = "37 statements: 36 hold with the study's own values, 1 do not. Of these 36, 36 hold robustly,";
            assert!(page.contains(reported), "{page}");
        }
        let (robust, not) = rests.split_once("## Does not hold").expect("a heading");
        for (place, claim) in CLAIMS.iter().enumerate() {
            let (line, cells) = (
                format!("\n- {}\n", claim.words),
                format!("| {} |", claim.words),
            );
            let row = table
                .lines()
                .find(|row| row.contains(&cells))
                .expect("a row");
            assert_eq!(robust.contains(&line), place != 1);
            assert_eq!(not.contains(&line), place == 1);
            assert_eq!(row.contains("| holds robustly |"), place != 1);
            assert_eq!(
                row.contains("| does not hold with the study's own values |"),
                place == 1
            );
        }
    }

    #[test]
    fn numbers_keep_four_digits_and_changes_two() {
        for (value, text) in [
            (53.148, "53.15"),
            (1.00414, "1.004"),
            (0.0, "0"),
            (1234.5, "1234"),
            (4.0, "4"),
            (0.00012, "0.00012"),
        ] {
            assert_eq!(short(value), text);
        }
        for (value, text) in [(0.01234, "0.012"), (12.3, "12"), (3.1e-7, "3e-7")] {
            assert_eq!(short_change(value), text);
        }
    }
}
