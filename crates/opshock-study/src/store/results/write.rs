//! Writes `results.h5`.

use std::path::Path;

use hdf5::Group;

use super::columns::{self, Column, Values, counts, numbers, put_number, put_text, texts};
use super::rows::{RESULTS_FORMAT, Results, RunRow};
use crate::search::Verdict;
use crate::search::amplitude_grid::REFERENCE_G;
use crate::store::error::StoreError;
use crate::store::record::{COST_NAMES, RunRecord, StoredTouch, cost_counts};
use crate::store::summary::{AxisValue, CONTRIBUTIONS, Contribution, PointSummary, Summary};
use crate::store::{aside, hdf5_file, seal};

/// Replaces `path` by these results: made and sealed in memory, written aside, synced, renamed.
///
/// # Errors
///
/// The folder cannot be written; the old file is then whole and in place.
pub fn write(path: &Path, results: &Results) -> Result<(), StoreError> {
    aside::write(path, &bytes(path, results)?)
}

/// The bytes of these results, sealed; `path` is only named in the error.
///
/// # Errors
///
/// E183: out of memory.
pub fn bytes(path: &Path, results: &Results) -> Result<Vec<u8>, StoreError> {
    hdf5_file::bytes(|root| fill(root, results))
        .map(seal::seal)
        .map_err(|error| StoreError::not_made(path, &error))
}

fn fill(root: &Group, results: &Results) -> hdf5::Result<()> {
    let Results {
        summary, session, ..
    } = results;
    put_text(root, "format", "opshock results")?;
    put_number(root, "format_version", RESULTS_FORMAT)?;
    put_text(root, "program_version", &session.program_version)?;
    put_text(root, "commit", &session.commit)?;
    put_number(root, "physics_structure", session.physics_structure)?;
    put_number(root, "physics_head", session.physics_head)?;
    put_text(root, "study", &summary.study)?;
    put_text(root, "study_digest", &summary.digest)?;
    put_text(root, "axes", &summary.axes.join(" "))?;
    put_number(root, "steps_per_octave", results.steps_per_octave)?;
    put_number(root, "reference_g", REFERENCE_G)?;
    put_number(root, "start_s", results.start_s)?;
    put_text(root, "plan", &results.plan)?;
    put_text(root, "content_blake3", &results.content_digest())?;

    let points = root.create_group("points")?;
    columns::write(&points, &point_columns(summary))?;
    columns::write(&points, &keep_columns(results))?;
    columns::write(&points.create_group("axes")?, &axis_columns(summary))?;

    let runs = root.create_group("runs")?;
    columns::write(&runs, &row_columns(&results.runs))?;
    let records: Vec<&RunRecord> = results.runs.iter().map(|row| &row.run).collect();
    columns::write(&runs, &run_columns(&records, results.start_s))?;

    machine(&root.create_group("machine")?, results, &records)
}

fn machine(group: &Group, results: &Results, records: &[&RunRecord]) -> hdf5::Result<()> {
    let session = &results.session;
    put_text(group, "host", &session.host)?;
    put_number(group, "process", session.process)?;
    put_number(group, "threads", session.threads as u64)?;
    put_number(group, "started_unix_s", session.started_unix_s)?;
    put_number(group, "written_unix_s", results.written_unix_s)?;
    put_text(group, "os", std::env::consts::OS)?;
    put_text(group, "architecture", std::env::consts::ARCH)?;
    columns::write(&group.create_group("runs")?, &time_columns(records))?;
    let outside: Vec<&RunRecord> = results.outside.iter().collect();
    let group = group.create_group("outside")?;
    put_text(&group, "outside_blake3", &results.outside_digest())?;
    let digest = texts("point_digest", &outside, |run| run.key.point.hex());
    columns::write(&group, &[digest])?;
    columns::write(&group, &run_columns(&outside, results.start_s))?;
    columns::write(&group, &time_columns(&outside))
}

fn point_columns(summary: &Summary) -> Vec<Column> {
    let rows = &summary.points;
    let mut columns = vec![
        texts("ramp", rows, |row| row.ramp.clone()),
        numbers("pulse_ms", "ms", rows, |row| Some(row.pulse_ms)),
        texts("sign", rows, |row| row.sign.as_str().to_owned()),
        numbers("a_crit_g", "G", rows, |row| row.a_crit_g),
        numbers("a_fail_g", "G", rows, |row| row.a_fail_g),
        numbers("err_low_g", "G", rows, |row| row.err_low_g),
        numbers("err_high_g", "G", rows, |row| row.err_high_g),
        texts("levels", rows, |row| row.levels.clone()),
        numbers("onset_g", "G", rows, |row| row.onset_g),
        counts("runs", rows, |row| row.runs),
        texts("status", rows, |row| row.status.as_str().to_owned()),
        texts("flags", rows, |row| {
            let words: Vec<&str> = row.flags.iter().map(|flag| flag.as_str()).collect();
            words.join(" ")
        }),
        texts("brackets_g", rows, |row| {
            serde_json::to_string(&row.brackets_g).expect("numbers serialise")
        }),
        numbers("scanned_from_g", "G", rows, |row| row.scanned_from_g),
        numbers("largest_gap_pct", "%", rows, |row| row.largest_gap_pct),
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
                rows,
                contribution(|contribution| contribution.low_g),
            ),
            numbers(
                &format!("err_{name}_high_g"),
                "G",
                rows,
                contribution(|contribution| contribution.high_g),
            ),
            numbers(
                &format!("err_{name}_factor"),
                "1",
                rows,
                contribution(|contribution| contribution.factor),
            ),
        ]);
    }
    columns
}

fn keep_columns(results: &Results) -> Vec<Column> {
    let points = &results.points;
    vec![
        texts("point_digest", points, |point| point.digest.hex()),
        texts("onset", points, |point| {
            match point.touch {
                None => "open",
                Some(StoredTouch::NoRamp) => "no_ramp",
                Some(StoredTouch::At(_)) => "at",
                Some(StoredTouch::Unknown) => "unknown",
            }
            .to_owned()
        }),
        numbers("onset_m_per_s2", "m/s2", points, |point| {
            match point.touch {
                Some(StoredTouch::At(amplitude)) => Some(amplitude),
                _ => None,
            }
        }),
    ]
}

/// An axis is a column of numbers, or of words when one of its values is a word.
fn axis_columns(summary: &Summary) -> Vec<Column> {
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
                Values::Numbers(_) => "as in the name",
                _ => "text",
            },
            values,
        }
    };
    summary.axes.iter().enumerate().map(axis).collect()
}

fn row_columns(rows: &[RunRow]) -> Vec<Column> {
    vec![
        counts("point", rows, |row| row.point as u64),
        counts("sequence", rows, |row| row.sequence as u64),
        texts("purpose", rows, |row| row.purpose.as_str().to_owned()),
        Column {
            name: "index".into(),
            units: "1",
            values: Values::Nodes(rows.iter().map(|row| row.index).collect()),
        },
        texts("levels", rows, |row| row.levels.label()),
        numbers("amplitude_g", "G", rows, |row| Some(row.amplitude_g)),
    ]
}

fn run_columns(runs: &[&RunRecord], start_s: f64) -> Vec<Column> {
    let touch = |place: usize| {
        move |run: &&RunRecord| match &run.result.verdict {
            Verdict::Fails { t_fail_s, x_m, y_m } => Some([*t_fail_s, *x_m, *y_m][place]),
            Verdict::Survives | Verdict::Undecided { .. } => None,
        }
    };
    let reason = |place: usize| {
        move |run: &&RunRecord| match &run.result.verdict {
            Verdict::Undecided { cause, message } => {
                [cause.as_str(), message.as_str()][place].to_owned()
            }
            Verdict::Survives | Verdict::Fails { .. } => String::new(),
        }
    };
    let mut columns = vec![
        numbers("amplitude_m_per_s2", "m/s2", runs, |run| {
            Some(f64::from_bits(run.key.amplitude_bits))
        }),
        counts("window_factor", runs, |run| {
            u64::from(run.key.window_factor)
        }),
        counts("retry", runs, |run| u64::from(run.key.retry)),
        texts("verdict", runs, |run| {
            run.result.verdict.as_str().to_owned()
        }),
        texts("cause", runs, reason(0)),
        texts("message", runs, reason(1)),
        numbers("t_fail_s", "s", runs, |run| {
            touch(0)(run).map(|time_s| start_s + time_s)
        }),
        numbers("t_fail_after_onset_s", "s", runs, touch(0)),
        numbers("x_m", "m", runs, touch(1)),
        numbers("y_m", "m", runs, touch(2)),
        numbers("h_min_m", "m", runs, |run| run.result.h_min_m),
        numbers("t_min_s", "s", runs, |run| {
            run.result.t_min_s.map(|time_s| start_s + time_s)
        }),
        numbers("t_min_after_onset_s", "s", runs, |run| run.result.t_min_s),
    ];
    for (place, name) in COST_NAMES.iter().enumerate() {
        columns.push(counts(name, runs, |run| {
            cost_counts(&run.result.cost)[place]
        }));
    }
    columns
}

fn time_columns(runs: &[&RunRecord]) -> Vec<Column> {
    vec![
        numbers("wall_s", "s", runs, |run| Some(run.machine.wall_s)),
        numbers("finished_unix_s", "s", runs, |run| {
            Some(run.machine.finished_unix_s)
        }),
    ]
}
