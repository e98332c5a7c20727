//! Writes which parameters the statements depend on: `sensitivity.md`, `.csv`, `.json` and a tornado plot.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::answer::{Answer, ClaimRow, tally};
use super::files::short;
use super::sensitivity::{Found, Row, Sensitivity};
use opshock_study::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value, colour,
};
use opshock_study::report::table::csv_line;
use opshock_study::report::{ReportError, json};
use opshock_study::store::aside::write_all;

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
        ("sensitivity.md", markdown(all, claims).into_bytes()),
        ("sensitivity.csv", csv(all).into_bytes()),
        ("sensitivity.json", json(all)),
        ("sensitivity.svg", figure.svg().into_bytes()),
        ("sensitivity.png", figure.png()?),
    ];
    Ok(write_all(folder, files)?)
}

pub(super) fn markdown(all: &Sensitivity, claims: &[ClaimRow]) -> String {
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
    text.push_str("\nThe two shocks run at the study's resolution. ");
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
             table, their changes are what is compared.",
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

fn csv(all: &Sensitivity) -> String {
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

/// A panel for each statement that any parameter moves: lines from the number at the lower to that
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
struct LineEnd {
    value: f64,
    holds: bool,
    is_upper: bool,
}

/// Lines in a panel.
const MOST_LINES: usize = 7;

fn tornado_panel(row: &Row) -> Option<Panel> {
    let claim = row.claim()?;
    let base = row.base?.value?;
    let mut lines: Vec<(&str, Vec<LineEnd>)> = Vec::new();
    for side in &row.sides {
        let Some((value, holds)) = side
            .found
            .and_then(|found| Some((found.value?, found.holds)))
        else {
            continue;
        };
        let end = LineEnd {
            value,
            holds,
            is_upper: side.value > side.base,
        };
        match lines.iter_mut().find(|(name, _)| *name == side.parameter) {
            Some((_, ends)) => ends.push(end),
            None => lines.push((&side.parameter, vec![end])),
        }
    }
    let reach = |ends: &[LineEnd]| {
        ends.iter()
            .map(|end| (end.value - base).abs())
            .fold(0.0, f64::max)
    };
    lines.retain(|(_, ends)| reach(ends) > 1e-9 * base.abs().max(1e-9));
    // Stable: equal lines stay in the order of the parameters.
    lines.sort_by(|a, b| reach(&b.1).total_cmp(&reach(&a.1)));
    lines.truncate(MOST_LINES);
    if lines.is_empty() {
        return None;
    }
    let mut series = Vec::new();
    for (place, (_, ends)) in lines.iter().enumerate() {
        let height = (lines.len() - place) as f64;
        for &LineEnd {
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
            let uncertainty = vec![(base, height), (value, height)];
            series.push(Series {
                width: 7.0,
                ..Series::curve(name, colour, Dash::Solid, uncertainty)
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
    let count = lines.len();
    Some(Panel {
        title: claim.words.chars().take(86).collect(),
        x: Axis::linear(&format!("{}{unit}", claim.number)),
        y: Axis::linear("").between(0.3, count as f64 + 1.3).named(
            lines
                .iter()
                .enumerate()
                .map(|(place, (name, _))| ((count - place) as f64, (*name).to_owned())),
        ),
        series,
        rules,
        shaded: None,
    })
}
