//! Columns of the points in `results.h5`, with their axes and brackets.

use super::columns::{Column, Values, counts, numbers, texts};
use super::rows::Results;
use crate::store::record::StoredTouch;
use crate::store::summary::{AxisValue, CONTRIBUTIONS, Contribution, PointSummary, Summary};
use crate::study::{keys, unit};

pub(super) fn point_columns(summary: &Summary) -> Vec<Column> {
    let rows = &summary.points;
    let mut columns = vec![
        texts("ramp", "ramp model", rows, |row| row.ramp.clone()),
        numbers("pulse_ms", "ms", "pulse width", rows, |row| {
            Some(row.pulse_ms)
        }),
        texts(
            "sign",
            "+ moves the disk towards the slider first",
            rows,
            |row| row.sign.as_str().to_owned(),
        ),
        numbers(
            "a_crit_g",
            "G",
            "critical shock: middle of the uncertainty interval, or of the bracket without one",
            rows,
            |row| row.a_crit_g,
        ),
        numbers(
            "uncertainty_g",
            "G",
            "half-width of the uncertainty interval",
            rows,
            |row| row.uncertainty_g,
        ),
        numbers(
            "half_min_height_g",
            "G",
            "change of the critical shock with half the minimum film height; no part of the interval",
            rows,
            |row| row.half_min_height_g,
        ),
        numbers(
            "survived_g",
            "G",
            "highest surviving amplitude below the lowest failing one",
            rows,
            |row| row.survived_g,
        ),
        numbers("failed_g", "G", "lowest failing amplitude", rows, |row| {
            row.failed_g
        }),
        texts(
            "levels",
            "discretisation parameters refined beyond the study's for this answer, in steps",
            rows,
            |row| row.levels.clone(),
        ),
        numbers(
            "onset_g",
            "G",
            "amplitude at which the disk first touches the ramp in the window",
            rows,
            |row| row.onset_g,
        ),
        counts(
            "runs",
            "simulations behind the answer and its uncertainty",
            rows,
            |row| row.runs,
        ),
        texts("status", "how the search ended", rows, |row| {
            row.status.as_str().to_owned()
        }),
        texts(
            "flags",
            "what a reader must know, words apart by blanks",
            rows,
            |row| {
                let words: Vec<&str> = row.flags.iter().map(|flag| flag.as_str()).collect();
                words.join(" ")
            },
        ),
        texts(
            "brackets_g",
            "rows of /brackets of this point as JSON",
            rows,
            |row| serde_json::to_string(&row.brackets_g).expect("numbers serialise"),
        ),
        numbers(
            "scanned_from_g",
            "G",
            "from where on lower failures were looked for",
            rows,
            |row| row.scanned_from_g,
        ),
        numbers(
            "largest_gap_pct",
            "%",
            "largest step between survivors from there to survived_g",
            rows,
            |row| row.largest_gap_pct,
        ),
    ];
    for name in CONTRIBUTIONS {
        let contribution = |bound: fn(&Contribution) -> f64| {
            move |row: &PointSummary| {
                let contribution = row.contributions.iter().find(|(known, _)| known == name)?;
                Some(bound(&contribution.1))
            }
        };
        columns.extend([
            numbers(
                &format!("err_{name}_low_g"),
                "G",
                format!("contribution of {name} to the uncertainty below survived_g"),
                rows,
                contribution(|contribution| contribution.low_g),
            ),
            numbers(
                &format!("err_{name}_high_g"),
                "G",
                format!("contribution of {name} to the uncertainty above survived_g"),
                rows,
                contribution(|contribution| contribution.high_g),
            ),
            numbers(
                &format!("err_{name}_factor"),
                "1",
                format!("safety factor in the contribution of {name}"),
                rows,
                contribution(|contribution| contribution.factor),
            ),
        ]);
    }
    columns
}

pub(super) fn keep_columns(results: &Results) -> Vec<Column> {
    let points = &results.points;
    vec![
        texts(
            "point_digest",
            "content of the point: scene, sign, physics versions",
            points,
            |point| point.digest.hex(),
        ),
        texts(
            "onset",
            "what is known of the first touch: at an amplitude, unknown, no_ramp, open",
            points,
            |point| {
                match point.touch {
                    None => "open",
                    Some(StoredTouch::NoRamp) => "no_ramp",
                    Some(StoredTouch::At(_)) => "at",
                    Some(StoredTouch::Unknown) => "unknown",
                }
                .to_owned()
            },
        ),
        numbers(
            "onset_m_per_s2",
            "m/s2",
            "amplitude of the first touch",
            points,
            |point| match point.touch {
                Some(StoredTouch::At(amplitude)) => Some(amplitude),
                _ => None,
            },
        ),
    ]
}

/// An axis is a column of numbers, or of words when one of its values is a word.
pub(super) fn axis_columns(summary: &Summary) -> Vec<Column> {
    let axis = |(place, name): (usize, &String)| {
        let values = summary.points.iter().map(|point| &point.axes[place]);
        let number = |value: &AxisValue| match value {
            AxisValue::Number(number) => Some(*number),
            AxisValue::Text(_) => None,
        };
        let values = match values.clone().map(number).collect::<Option<Vec<f64>>>() {
            Some(numbers) => Values::Numbers(numbers),
            None => Values::Texts(values.map(|value| value.to_string()).collect()),
        };
        Column {
            name: name.clone(),
            units: match values {
                Values::Numbers(_) => unit::of_path(name).map_or("1", |unit| unit.symbol),
                _ => "text",
            },
            description: keys::described(name).into(),
            values,
        }
    };
    summary.axes.iter().enumerate().map(axis).collect()
}

pub(super) fn bracket_columns(summary: &Summary) -> Vec<Column> {
    let points = summary.points.iter().enumerate();
    let of_point = |(point, row): (usize, &PointSummary)| {
        let brackets = row.brackets_g.clone().into_iter();
        brackets.map(move |bracket| (point, bracket))
    };
    let rows: Vec<(usize, [f64; 2])> = points.flat_map(of_point).collect();
    let rows = &rows;
    vec![
        counts("point", "row of /points, from 0", rows, |row| row.0 as u64),
        numbers("lower_g", "G", "amplitude that is survived", rows, |row| {
            Some(row.1[0])
        }),
        numbers(
            "upper_g",
            "G",
            "next higher amplitude, which fails",
            rows,
            |row| Some(row.1[1]),
        ),
    ]
}
