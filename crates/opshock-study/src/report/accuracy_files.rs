//! Writes the refinement studies of `opshock accuracy`, error against cost: tables, JSON, work-precision plots.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::chart::{Axis, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value, colour};
use super::error::{ReportError, json};
use super::table::csv_line;
use crate::accuracy::{Accuracy, PointStudies, QUANTITIES, SettingRow};
use crate::store::aside::write_all;

/// Writes `accuracy.md`, `accuracy.csv`, `accuracy.json` and, per point, `accuracy-N.svg` and
/// `.png` into `folder`; returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_accuracy(folder: &Path, accuracy: &Accuracy) -> Result<Vec<PathBuf>, ReportError> {
    let mut files: Vec<(String, Vec<u8>)> = vec![
        ("accuracy.md".into(), markdown(accuracy).into_bytes()),
        ("accuracy.csv".into(), csv(accuracy).into_bytes()),
        ("accuracy.json".into(), json(accuracy)),
    ];
    for (number, point) in accuracy.points.iter().enumerate() {
        let figure = figure(point, &accuracy.program);
        files.push((
            format!("accuracy-{}.svg", number + 1),
            figure.svg().into_bytes(),
        ));
        files.push((format!("accuracy-{}.png", number + 1), figure.png()?));
    }
    Ok(write_all(folder, files)?)
}

/// Work-precision plots of a point: error of three quantities against wall time, a panel a refinement study.
pub fn figure(point: &PointStudies, program: &str) -> Figure {
    let mut studies: Vec<&str> = point
        .settings
        .iter()
        .map(|setting| setting.parameter.as_str())
        .collect();
    studies.dedup();
    let panels = studies
        .iter()
        .map(|parameter| {
            let of = |column: usize| -> Vec<Sample> {
                let settings = point.settings.iter();
                let settings = settings
                    .filter(|setting| setting.parameter == *parameter && !setting.is_reference);
                settings
                    .filter_map(|setting| sample(setting, column))
                    .collect()
            };
            let marked = |name: &str, colour, marker, column| {
                Series::marked(
                    name,
                    colour,
                    Some(Dash::Solid),
                    (marker, Fill::Full),
                    of(column),
                )
            };
            Panel {
                title: (*parameter).to_owned(),
                x: Axis::log("Time of one shock (s)"),
                y: Axis::log("Relative error"),
                series: vec![
                    marked("critical shock", colour::BLACK, Marker::Circle, 0),
                    marked("smallest clearance", colour::BLUE, Marker::Square, 1),
                    marked("flying height", colour::GREEN, Marker::Diamond, 2),
                    marked("contact impulse", colour::VERMILLION, Marker::Triangle, 3),
                ],
                rules: Vec::new(),
                shaded: None,
            }
        })
        .collect();
    Figure {
        title: format!("What accuracy costs: {}", point.label),
        subtitle: format!("each discretisation parameter alone, then all together   [{program}]"),
        columns: 3,
        panel_px: (360.0, 300.0),
        panels,
    }
}

fn sample(setting: &SettingRow, column: usize) -> Option<Sample> {
    let error = setting.errors[column].filter(|&error| error > 1e-9)?;
    let [_, median_s, _] = setting.wall_s?;
    Some(Sample {
        x: median_s,
        value: Value::Known {
            y: error,
            low: error,
            high: error,
        },
        open: !setting.is_on_front && setting.parameter == "joint",
        note: format!(
            "{} = {}: {:.3} %",
            setting.parameter,
            setting.value,
            100.0 * error
        ),
    })
}

fn csv(accuracy: &Accuracy) -> String {
    let mut header: Vec<String> = ["point", "parameter", "value", "fineness", "is_reference"]
        .map(String::from)
        .to_vec();
    header.extend(QUANTITIES.map(|name| format!("{name}_error")));
    header.extend(
        [
            "critical_g",
            "critical_runs",
            "wall_q1_s",
            "wall_median_s",
            "wall_q3_s",
            "build_s",
            "film_work",
            "structure_steps",
            "on_front",
            "failure",
        ]
        .map(String::from),
    );
    let mut text = csv_line(&header);
    let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:.6e}"));
    for point in &accuracy.points {
        for setting in &point.settings {
            let mut row = vec![
                point.label.clone(),
                setting.parameter.clone(),
                setting.value.clone(),
                setting.fineness.to_string(),
                setting.is_reference.to_string(),
            ];
            row.extend(setting.errors.iter().map(|&error| number(error)));
            let wall = setting.wall_s.map(|w| w.map(Some)).unwrap_or([None; 3]);
            let measured = &setting.measured;
            row.push(number(measured.critical_g));
            row.push(measured.critical_runs.to_string());
            row.extend(wall.map(number));
            row.extend([
                number(Some(measured.build_s)),
                measured.work.to_string(),
                measured.structure_steps.to_string(),
                setting.is_on_front.to_string(),
                measured.failure.clone().unwrap_or_default(),
            ]);
            text.push_str(&csv_line(&row));
        }
    }
    text
}

/// The tables as Markdown.
pub fn markdown(accuracy: &Accuracy) -> String {
    let mut text = format!("# What accuracy costs: {}\n", accuracy.study);
    for point in &accuracy.points {
        let _ = write!(
            text,
            "\n## {}, probing shock {:.1} G\n\n| discretisation parameter | value | critical shock (G) | shocks for it | its error (%) | clearance (%) | \
             flying height (%) | impulse (%) | rim (%) | slider (%) | first touch (%) | time of a shock (s) | film work |\n\
             | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
            point.label, point.probe_g
        );
        for setting in &point.settings {
            let measured = &setting.measured;
            let name = match (setting.is_reference, setting.is_on_front) {
                (true, _) => format!("{} (reference)", setting.value),
                (false, true) => format!("**{}**", setting.value),
                (false, false) => setting.value.clone(),
            };
            let errors: String = setting
                .errors
                .iter()
                .map(|error| match error {
                    Some(error) => format!(" {:.3} |", 100.0 * error),
                    None => " |".into(),
                })
                .collect();
            let wall = setting.wall_s.map_or(String::new(), |[q1, median, q3]| {
                format!("{median:.3} ({q1:.3} to {q3:.3})")
            });
            let critical = match (&measured.failure, measured.critical_g) {
                (Some(reason), _) => format!("failed: {reason}"),
                (None, Some(critical_g)) => format!("{critical_g:.1}"),
                (None, None) => String::new(),
            };
            let _ = writeln!(
                text,
                "| {} | {name} | {critical} | {} |{errors} {wall} | {:.2e} |",
                setting.parameter, measured.critical_runs, measured.work as f64
            );
        }
        text.push_str(
            "\n| discretisation parameter | order read on | observed | formal |\n| --- | --- | ---: | ---: |\n",
        );
        for order in &point.orders {
            let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.2}"));
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} |",
                order.parameter,
                order.quantity,
                match order.is_disordered {
                    true => "no order".to_owned(),
                    false => number(order.observed),
                },
                number(order.formal)
            );
        }
    }
    let _ = write!(
        text,
        "\nErrors are against the refinement study's reference; in the reference's own row they say how \
         uncertain it is (the finest setting's error, fallen at the formal order). All studies but \
         `film_cells`, the grid as it is, `film_cells_corrected` and `joint` stand on a quarter of the film's cells. Bold: on the front of \
         the joint settings. Orders are in the discretisation's own number (cells, modes, 1/step, 1/tolerance). \
         Times are of this machine.\n\n{}, study {}\n",
        accuracy.program, accuracy.digest
    );
    text
}
