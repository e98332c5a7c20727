//! The paper's statements as files: Markdown, CSV, JSON; and what they rest on, with its plot.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::claims::{Answer, ClaimRow, Found, Row, Sensitivity, tally};
use opshock_study::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value, colour,
};
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
             | where | the paper says | here | holds with | answer | turns with |\n\
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
            "\n± is the largest change of the number when one knob of accuracy is turned a step finer \
             (the knob in brackets). \"Beyond the bars\": with both critical shocks wrong by all of \
             their error bars, in opposite directions, the answer stays. \"About\" in the paper is \
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
                "| place | number | by the error bars | holds |\n| --- | ---: | ---: | --- |\n",
            );
            for part in &found.parts {
                let bar = part.bar.map_or(String::new(), |[low, high]| {
                    format!("{} to {}", short(low), short(high))
                });
                let _ = writeln!(
                    text,
                    "| {} | {} | {bar} | {} |",
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
            "change_with_finer_knob",
            "finer_knob",
            "holds_with",
            "holds_with_own_values",
            "answer",
            "depends_on",
            "places_beyond_bars",
            "places",
            "note",
        ];
        let mut text = csv_line(&header.map(String::from));
        for row in &self.claims {
            let found = row.finding.as_ref();
            let spread = row.spread.as_ref();
            let maybe = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
            let count = |place: usize| {
                row.beyond_the_bars
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
                spread.map_or(String::new(), |spread| spread.knob.clone()),
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
            if let Some((change, knob)) = spread.and_then(|s| Some((s.change?, &s.knob))) {
                let _ = match change {
                    0.0 => write!(text, " ± 0"),
                    _ => write!(text, " ± {} ({knob})", short_change(change)),
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
    if let Some([sure, all]) = row.beyond_the_bars {
        let _ = write!(text, "; {sure} of {all} beyond the bars");
    }
    text
}

/// Four digits.
fn short(value: f64) -> String {
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

/// Writes `sensitivity.md`, `.csv`, `.json`, `.svg` and `.png` into `folder`, with the answers of the
/// table beside it; returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_sensitivity(
    folder: &Path,
    all: &Sensitivity,
    claims: &[ClaimRow],
) -> Result<Vec<PathBuf>, ReportError> {
    let figure = tornado(all);
    let files = [
        (
            "sensitivity.md",
            sensitivity_markdown(all, claims).into_bytes(),
        ),
        ("sensitivity.csv", sensitivity_csv(all).into_bytes()),
        ("sensitivity.json", json(all)),
        ("sensitivity.svg", figure.svg().into_bytes()),
        ("sensitivity.png", figure.png()?),
    ];
    Ok(write_all(folder, files)?)
}

fn sensitivity_markdown(all: &Sensitivity, claims: &[ClaimRow]) -> String {
    let mut text = format!(
        "# What the statements rest on\n\nEvery parameter that the paper does not print is moved to \
         both ends of a range, one at a time. {}\n\n![Tornado plot](sensitivity.png)\n",
        tally(claims, true)
    );
    for answer in [Answer::HoldsRobustly, Answer::Holds, Answer::DoesNot] {
        let mut words = answer.words().to_owned();
        words[..1].make_ascii_uppercase();
        let _ = writeln!(text, "\n## {words}\n");
        for row in claims.iter().filter(|row| row.answer == answer) {
            let _ = writeln!(text, "- {}", row.paper);
            for line in &row.depends_on {
                let _ = writeln!(text, "  - {line}");
            }
        }
    }
    text.push_str("\n## Ranges\n\n| parameter | key | low | study | high |\n| --- | --- | ---: | ---: | ---: |\n");
    if let Some(row) = all.rows.first() {
        for pair in row.sides.chunks(2) {
            if let [low, high] = pair {
                let _ = writeln!(
                    text,
                    "| {} | `{}` | {} | {} | {} |",
                    low.parameter, low.key, low.value, low.base, high.value
                );
            }
        }
    }
    let lost: Vec<String> = all
        .rows
        .first()
        .map(|row| {
            let sides = row.sides.iter().filter(|side| side.found.is_none());
            sides
                .map(|side| format!("{} = {}", side.parameter, side.value))
                .collect()
        })
        .unwrap_or_default();
    if !lost.is_empty() {
        let _ = writeln!(
            text,
            "\nWithout an answer (the drive cannot be simulated there): {}.",
            lost.join(", ")
        );
    }
    text.push_str("\nThe two shocks run at the study's accuracy. ");
    if all.coarse.is_empty() {
        let left: Vec<&str> = all
            .rows
            .iter()
            .filter(|row| row.base.is_none())
            .filter_map(|row| Some(row.claim()?.words))
            .collect();
        let _ = write!(
            text,
            "Not tried, because the searches were left out: {}.",
            left.join("; ")
        );
    } else {
        let _ = write!(
            text,
            "Critical shocks come from a coarse search (`{}`): its values are not those of the \
             table, their changes are what counts.",
            all.coarse.join("`, `")
        );
    }
    let _ = write!(
        text,
        " Gimbal stiffness moves pitch, roll and vertical together.\n\n{}, study {}\n",
        all.program, all.study
    );
    text
}

fn sensitivity_csv(all: &Sensitivity) -> String {
    let header = [
        "claim",
        "parameter",
        "key",
        "study_value",
        "value",
        "base_number",
        "base_holds",
        "number",
        "holds",
    ];
    let mut text = csv_line(&header.map(String::from));
    let cells = |found: Option<Found>| {
        let number = found.and_then(|found| found.value);
        [
            number.map_or(String::new(), |v| v.to_string()),
            found.map_or(String::new(), |found| found.holds.to_string()),
        ]
    };
    for row in &all.rows {
        for side in &row.sides {
            let mut line = vec![
                row.claim.clone(),
                side.parameter.clone(),
                side.key.clone(),
                side.base.to_string(),
                side.value.to_string(),
            ];
            line.extend(cells(row.base));
            line.extend(cells(side.found));
            text.push_str(&csv_line(&line));
        }
    }
    text
}

/// A panel for each statement that any parameter moves: bars from the number at the lower to that
/// at the upper end of a range, the longest on top; dashed: the study's own number and the bounds
/// between which the statement holds.
fn tornado(all: &Sensitivity) -> Figure {
    let panels: Vec<Panel> = all.rows.iter().filter_map(tornado_panel).collect();
    Figure {
        title: "What the paper's statements rest on".into(),
        subtitle: format!(
            "each parameter alone at the ends of its range; an open mark: the statement does not hold there   [{}]",
            all.program
        ),
        columns: 2,
        panel_px: (620.0, 290.0),
        panels,
    }
}

/// Number of a statement at one end of a parameter's range.
struct BarEnd {
    value: f64,
    holds: bool,
    is_upper: bool,
}

/// Bars in a panel.
const BARS: usize = 7;

fn tornado_panel(row: &Row) -> Option<Panel> {
    let claim = row.claim()?;
    let base = row.base?.value?;
    let mut bars: Vec<(&str, Vec<BarEnd>)> = Vec::new();
    for side in &row.sides {
        let Some((value, holds)) = side
            .found
            .and_then(|found| Some((found.value?, found.holds)))
        else {
            continue;
        };
        let end = BarEnd {
            value,
            holds,
            is_upper: side.value > side.base,
        };
        match bars.iter_mut().find(|(name, _)| *name == side.parameter) {
            Some((_, ends)) => ends.push(end),
            None => bars.push((&side.parameter, vec![end])),
        }
    }
    let reach = |ends: &[BarEnd]| {
        ends.iter()
            .map(|end| (end.value - base).abs())
            .fold(0.0, f64::max)
    };
    bars.retain(|(_, ends)| reach(ends) > 1e-9 * base.abs().max(1e-9));
    // Stable: equal bars stay in the order of the parameters.
    bars.sort_by(|a, b| reach(&b.1).total_cmp(&reach(&a.1)));
    bars.truncate(BARS);
    if bars.is_empty() {
        return None;
    }
    let mut series = Vec::new();
    for (place, (_, ends)) in bars.iter().enumerate() {
        let height = (bars.len() - place) as f64;
        for &BarEnd {
            value,
            holds,
            is_upper,
        } in ends
        {
            let (name, colour) = if is_upper {
                ("upper end of the range", colour::VERMILLION)
            } else {
                ("lower end of the range", colour::BLUE)
            };
            let bar = vec![(base, height), (value, height)];
            series.push(Series {
                width: 7.0,
                ..Series::curve(name, colour, Dash::Solid, bar)
            });
            series.push(Series {
                marker_px: 5.0,
                ..Series::marked(
                    "",
                    colour,
                    None,
                    (Marker::Circle, Fill::Full),
                    vec![Sample {
                        x: value,
                        value: Value::Known {
                            y: height,
                            low: height,
                            high: height,
                        },
                        open: !holds,
                        note: format!(
                            "{}: {}",
                            short(value),
                            if holds { "holds" } else { "does not hold" }
                        ),
                    }],
                )
            });
        }
    }
    let mut rules = vec![Rule::Vertical {
        x: base,
        label: String::new(),
    }];
    for bound in [claim.bounds.0, claim.bounds.1] {
        // The smallest number above zero stands for zero.
        let bound = if bound == f64::MIN_POSITIVE {
            0.0
        } else {
            bound
        };
        if bound.is_finite() && bound != base {
            rules.push(Rule::Vertical {
                x: bound,
                label: "bound".into(),
            });
        }
    }
    let unit = if claim.unit.is_empty() {
        String::new()
    } else {
        format!(" ({})", claim.unit)
    };
    let count = bars.len();
    Some(Panel {
        title: claim.words.chars().take(86).collect(),
        x: Axis::linear(&format!("{}{unit}", claim.number)),
        y: Axis::linear("").between(0.3, count as f64 + 1.3).named(
            bars.iter()
                .enumerate()
                .map(|(place, (name, _))| ((count - place) as f64, (*name).to_owned())),
        ),
        series,
        rules,
        shaded: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::{CLAIMS, Finding, rows};

    #[test]
    fn both_pages_give_every_statement_the_same_answer() {
        let finding = |holds| {
            Some(Finding {
                value: Some(1.0),
                holds,
                ..Finding::default()
            })
        };
        // Every statement met by the coarse search at every end; the second is not by the study itself.
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
        let rests = sensitivity_markdown(&all, &claims);
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
            let told = "37 statements: 36 hold with the study's own values, 1 do not. Of these 36, 36 hold robustly,";
            assert!(page.contains(told), "{page}");
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
