//! Columns of the simulations in `results.h5`.

use std::collections::HashSet;
use std::path::Path;

use super::columns::{Column, Values, counts, numbers, texts};
use super::rows::{Results, RunRow};
use crate::search::Verdict;
use crate::store::history::KeptRun;
use crate::store::names::HISTORIES;
use crate::store::record::{COSTS, RunRecord, cost_counts};

/// Files of the histories that the store holds.
pub(super) fn history_column(results: &Results, store: &Path) -> Column {
    let entries = std::fs::read_dir(store.join(HISTORIES)).ok();
    let entries = entries.into_iter().flatten().flatten();
    let kept: HashSet<String> = entries
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    let description = "file of its history, from the store's folder; empty: none is kept";
    let runs: Vec<Option<KeptRun<'_>>> = results.kept_by_row().collect();
    texts("history", description, &runs, |run| {
        let names = run.iter().flat_map(|run| run.names());
        let mut kept = names.filter(|name| kept.contains(name));
        let name = kept.next();
        name.map_or(String::new(), |name| format!("{HISTORIES}/{name}"))
    })
}

pub(super) fn row_columns(rows: &[RunRow]) -> Vec<Column> {
    vec![
        counts("point", "row of /points, from 0", rows, |row| {
            row.point as u64
        }),
        counts(
            "sequence",
            "place among the simulations of the point, from 0",
            rows,
            |row| row.sequence as u64,
        ),
        texts(
            "purpose",
            "what the simulation was asked for",
            rows,
            |row| row.purpose.as_str().to_owned(),
        ),
        Column {
            name: "index".into(),
            units: "1",
            description:
                "place on the amplitude grid, sixteen times as fine for the purpose uncertainty"
                    .into(),
            values: Values::Nodes(rows.iter().map(|row| row.index).collect()),
        },
        texts(
            "levels",
            "discretisation parameters changed from the study's, in steps",
            rows,
            |row| row.levels.label(),
        ),
        numbers(
            "amplitude_g",
            "G",
            "amplitude of the shock without sign",
            rows,
            |row| Some(row.amplitude_g),
        ),
    ]
}

pub(super) fn run_columns(runs: &[&RunRecord], start_s: f64) -> Vec<Column> {
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
        numbers(
            "amplitude_m_per_s2",
            "m/s2",
            "amplitude of the shock with its sign",
            runs,
            |run| Some(f64::from_bits(run.key.amplitude_bits)),
        ),
        counts(
            "window_factor",
            "simulated window in windows of the study",
            runs,
            |run| u64::from(run.key.window_factor),
        ),
        counts(
            "retry",
            "0 as the study says, 1 half and 2 a quarter of the steps, 3 the other coupling, 4 the other contact method",
            runs,
            |run| u64::from(run.key.retry),
        ),
        texts("verdict", "survives, fails or undecided", runs, |run| {
            run.result.verdict.as_str().to_owned()
        }),
        texts("cause", "why it is undecided, a word", runs, reason(0)),
        texts(
            "message",
            "why it is undecided, a sentence",
            runs,
            reason(1),
        ),
        numbers(
            "t_fail_s",
            "s",
            "time of touch on the study's axis",
            runs,
            |run| touch(0)(run).map(|time_s| start_s + time_s),
        ),
        numbers(
            "t_fail_after_onset_s",
            "s",
            "time of touch after the onset of the pulse",
            runs,
            touch(0),
        ),
        numbers(
            "x_m",
            "m",
            "place of touch, from the slider's leading edge",
            runs,
            touch(1),
        ),
        numbers(
            "y_m",
            "m",
            "place of touch, from the slider's inner edge",
            runs,
            touch(2),
        ),
        numbers(
            "h_min_m",
            "m",
            "smallest clearance between slider and disk",
            runs,
            |run| run.result.h_min_m,
        ),
        numbers(
            "t_min_s",
            "s",
            "time of the smallest clearance on the study's axis",
            runs,
            |run| run.result.t_min_s.map(|time_s| start_s + time_s),
        ),
        numbers(
            "t_min_after_onset_s",
            "s",
            "time of the smallest clearance after the onset of the pulse",
            runs,
            |run| run.result.t_min_s,
        ),
    ];
    for (place, (name, description)) in COSTS.into_iter().enumerate() {
        columns.push(counts(name, description, runs, |run| {
            cost_counts(&run.result.cost)[place]
        }));
    }
    columns
}

pub(super) fn time_columns(runs: &[&RunRecord]) -> Vec<Column> {
    vec![
        numbers("wall_s", "s", "wall time of the simulation", runs, |run| {
            Some(run.machine.wall_s)
        }),
        numbers(
            "finished_unix_s",
            "s",
            "end of the simulation, seconds since 1970",
            runs,
            |run| Some(run.machine.finished_unix_s),
        ),
    ]
}
