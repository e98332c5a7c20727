//! `opshock doctor`: checks whether this machine can be trusted with a sweep.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::memory;
use anyhow::Context as _;
use clap::Args;
use opshock_study::provenance;
use opshock_study::report::runs_table;
use opshock_study::store::{self, StoreError, machine};
use opshock_study::study::{SetArg, Study};
use opshock_study::sweep::{Physics, Silent, SweepInput, SweepOptions, sweep};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Check this machine: results that come back as written, the same bits for any number of threads
#[derive(Args, Debug)]
pub struct DoctorArgs {
    /// Folder to write in, where stores are going to be
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Run the hard cases instead: set-ups that break solvers, a line each with figure and bound
    #[arg(long)]
    hard_cases: bool,
}

#[derive(Debug, Serialize)]
struct Findings {
    program: String,
    system: String,
    host: String,
    cores: usize,
    threads: usize,
    checks: Vec<Check>,
}

#[derive(Debug, Serialize)]
struct Check {
    name: &'static str,
    ok: bool,
    detail: String,
}

/// Runs the command.
pub fn run(
    arguments: &DoctorArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    if arguments.hard_cases {
        return super::hard_cases::run(global.threads(), console);
    }
    // Two threads show a race also on one core.
    let threads = global.threads().max(2);
    let study = small_study()?;
    memory::check("the small sweep", memory::of_sweep(&study), threads)?;
    let alone = swept(&study, &arguments.folder, 1)?;
    let together = swept(&study, &arguments.folder, threads)?;
    let checks = vec![
        Check {
            name: "store_round_trip",
            ok: alone.comes_back && together.comes_back,
            detail: format!("{} simulations swept, stored and read again", alone.n_runs),
        },
        Check {
            name: "thread_determinism",
            ok: alone.table == together.table && alone.runs == together.runs,
            detail: format!("1 and {threads} threads, every number of every simulation"),
        },
    ];
    let ok = checks.iter().all(|check| check.ok);
    let findings = Findings {
        program: provenance::program(),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        host: machine::host(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        threads,
        checks,
    };
    if console.json {
        console.result_json(&findings)?;
    } else {
        console.result(&as_text(&findings))?;
    }
    Ok(if ok { Exit::Complete } else { Exit::Difference })
}

/// Two points with a coarse film: takes seconds and uses every part of a sweep.
fn small_study() -> Result<Study, Failure> {
    let sets: Result<Vec<SetArg>, _> = [
        "ramp.models=[\"rigid\"]",
        "pulse.widths_ms=[0.5]",
        "pulse.window_ms=1.0",
        "search.tolerance_pct=20",
        "search.monotonicity_scan=off",
        "search.uncertainty=false",
        "resolution.film_cells=300",
        "resolution.disk_cut_khz=10",
        "output.keep_histories=none",
    ]
    .into_iter()
    .map(SetArg::parse)
    .collect();
    Ok(Study::from_text(&Study::example("doctor"), &sets?)?)
}

/// The results of a sweep that must not depend on threads or files.
struct Swept {
    /// The stored table equals the one handed back.
    comes_back: bool,
    table: String,
    runs: String,
    n_runs: usize,
}

fn swept(study: &Study, folder: &Path, threads: usize) -> Result<Swept, Failure> {
    let folder = tempfile::Builder::new()
        .prefix(".opshock-doctor-")
        .tempdir_in(folder)
        .map_err(|source| StoreError::Unwritable {
            path: folder.to_owned(),
            source,
        })?;
    let input = SweepInput::of(study).context("the study has no amplitudes to search")?;
    let options = SweepOptions::with_threads(threads);
    let end = sweep(
        &input,
        &Physics::of(study),
        folder.path(),
        &options,
        &Silent,
    )?;
    let (_, results) = store::load(folder.path())?;
    let results = results.ok_or_else(|| StoreError::Empty {
        path: folder.path().to_owned(),
    })?;
    Ok(Swept {
        comes_back: results.summary == end.summary,
        table: opshock_study::report::table::csv(&results.summary),
        runs: runs_table::csv(&results),
        n_runs: results.runs.len(),
    })
}

fn as_text(findings: &Findings) -> String {
    let mut text = format!(
        "{}\n{} on {}, {} cores, {} threads used\n",
        findings.program, findings.host, findings.system, findings.cores, findings.threads
    );
    for check in &findings.checks {
        let word = if check.ok { "ok" } else { "WRONG" };
        let _ = writeln!(text, "{:<20}{word:<7}{}", check.name, check.detail);
    }
    text
}
