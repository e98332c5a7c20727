//! Parses the command line and runs the command; a file per command. Results go to stdout, messages to
//! stderr; see [`Exit`] for the exit codes. Modules that the Python package shares are public.

mod accuracy;
mod check;
mod claims;
mod compare;
mod completions;
mod console;
mod doctor;
mod exit;
mod explain;
mod export;
mod export_suspension;
mod export_vtu;
pub mod failure;
mod figures;
mod global;
mod hard_cases;
mod import;
mod long_run;
mod matching;
pub mod memory;
mod merge;
mod mode_shapes;
mod modes;
mod new;
mod plan;
mod population;
mod pulse;
mod qualify;
mod report;
mod responses;
pub mod run;
mod schema;
mod selection;
mod slurm;
mod status;
mod steady;
mod steady_state;
pub mod stored;
pub mod study_file;
pub mod sweep;
mod terminal;
mod thresholds;
mod worth;

pub use exit::Exit;

use anyhow::Context as _;
use clap::{CommandFactory as _, Parser, Subcommand};
use console::Console;
use failure::{Failure, Fault};
use global::GlobalArgs;
use opshock_solver::simulation;
use opshock_study::correction_cache::{self, CorrectionCache};
use opshock_study::provenance;
use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Simulates a hard disk drive's head-disk interface under operational shock and finds the
/// amplitude it survives.
#[derive(Parser, Debug)]
#[command(
    name = "opshock",
    version = provenance::long_version(),
    disable_help_subcommand = true,
    disable_version_flag = true,
    after_help = "Exit codes: 0 complete, 1 internal, 2 command line, 3 study invalid, 4 complete \
                  with open points, 5 ended by a budget, 6 store damaged, locked or newer, \
                  7 differences beyond limits, 8 a requirement not met, 129/130/143 signals"
)]
struct Cli {
    #[command(flatten)]
    global: GlobalArgs,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    New(new::NewArgs),
    Check(check::CheckArgs),
    Run(run::RunArgs),
    Modes(modes::ModesArgs),
    Steady(steady::SteadyArgs),
    Explain(explain::ExplainArgs),
    Plan(plan::PlanArgs),
    Pulse(pulse::PulseArgs),
    Sweep(sweep::SweepArgs),
    Match(matching::MatchArgs),
    Qualify(qualify::QualifyArgs),
    Yield(population::YieldArgs),
    Worth(worth::WorthArgs),
    Merge(merge::MergeArgs),
    Report(report::ReportArgs),
    Figures(figures::FiguresArgs),
    Claims(claims::ClaimsArgs),
    Accuracy(accuracy::AccuracyArgs),
    Status(status::StatusArgs),
    Compare(compare::CompareArgs),
    Export(export::ExportArgs),
    Import(import::ImportArgs),
    Doctor(doctor::DoctorArgs),
    Schema(schema::SchemaArgs),
    Completions(completions::CompletionsArgs),
}

/// Runs the program with the process's arguments.
pub fn main() -> ExitCode {
    main_with(std::env::args_os().collect()).into()
}

/// Runs the program with these arguments, the first its own name.
pub fn main_with(arguments: Vec<OsString>) -> Exit {
    tame_signals();
    // A mistake in the arguments must be reported in JSON too, before they are parsed.
    let json = arguments
        .iter()
        .skip(1)
        .any(|argument| argument == "--json");
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => {
            let console = Console { json, quiet: false };
            let exit = misunderstood(&error, &console).unwrap_or_else(|failure| {
                console.fail(&failure);
                failure.exit()
            });
            return exit;
        }
    };
    let console = Console {
        json: cli.global.json,
        quiet: cli.global.quiet,
    };
    match run(&cli, &console) {
        Ok(exit) => exit,
        Err(failure) => {
            console.fail(&failure);
            failure.exit()
        }
    }
}

/// A write past a file-size limit fails with its error instead of ending the process by SIGXFSZ. Memory that
/// the machine refuses is reported by the standard library, which then aborts: that ends with
/// [`Exit::Internal`].
fn tame_signals() {
    use signal_hook::consts::{SIGABRT, SIGXFSZ};
    use signal_hook::flag;
    // Both are refused only for signals that no program may handle.
    let _ = flag::register(SIGXFSZ, Arc::default());
    let always = Arc::new(AtomicBool::new(true));
    let _ = flag::register_conditional_shutdown(SIGABRT, Exit::Internal.code().into(), always);
}

/// Keeps defect corrections in the user's folder for caches. The check of a machine trusts none, and times of accuracy have
/// their sampling.
fn keep_corrections(cli: &Cli, console: Console) {
    let is_fresh = matches!(cli.command, Command::Doctor(_) | Command::Accuracy(_));
    let is_wanted = !cli.global.no_cache && !is_fresh;
    if let Some(folder) = correction_cache::default_folder().filter(|_| is_wanted) {
        let report = move |message: &str| console.note(&format!("note: {message}"));
        if let Some(cache) = CorrectionCache::new(folder, report) {
            simulation::keep_corrections(Box::new(cache));
        }
    }
}

fn run(cli: &Cli, console: &Console) -> Result<Exit, Failure> {
    keep_corrections(cli, *console);
    match &cli.command {
        Command::New(arguments) => new::run(arguments, console),
        Command::Check(arguments) => check::run(arguments, &cli.global, console),
        Command::Run(arguments) => run::run(arguments, &cli.global, console),
        Command::Modes(arguments) => modes::run(arguments, &cli.global, console),
        Command::Steady(arguments) => steady::run(arguments, &cli.global, console),
        Command::Explain(arguments) => explain::run(arguments, &cli.global, console),
        Command::Plan(arguments) => plan::run(arguments, &cli.global, console),
        Command::Pulse(arguments) => pulse::run(arguments, &cli.global, console),
        Command::Merge(arguments) => merge::run(arguments, &cli.global, console),
        Command::Sweep(arguments) => sweep::run(arguments, &cli.global, console),
        Command::Match(arguments) => matching::run(arguments, &cli.global, console),
        Command::Qualify(arguments) => qualify::run(arguments, &cli.global, console),
        Command::Yield(arguments) => population::run(arguments, &cli.global, console),
        Command::Worth(arguments) => worth::run(arguments, &cli.global, console),
        Command::Report(arguments) => report::run(arguments, &cli.global, console),
        Command::Figures(arguments) => figures::run(arguments, &cli.global, console),
        Command::Claims(arguments) => claims::run(arguments, &cli.global, console),
        Command::Accuracy(arguments) => accuracy::run(arguments, &cli.global, console),
        Command::Status(arguments) => status::run(arguments, &cli.global, console),
        Command::Compare(arguments) => compare::run(arguments, &cli.global, console),
        Command::Export(arguments) => export::run(arguments, &cli.global, console),
        Command::Import(arguments) => import::run(arguments, &cli.global, console),
        Command::Doctor(arguments) => doctor::run(arguments, &cli.global, console),
        Command::Schema(arguments) => schema::run(arguments, Cli::command(), console),
        Command::Completions(arguments) => completions::run(arguments, Cli::command(), console),
    }
}

/// Help and version are results; the rest is a mistake on the command line.
fn misunderstood(error: &clap::Error, console: &Console) -> Result<Exit, Failure> {
    if !error.use_stderr() {
        error.print().context("cannot write to standard output")?;
        console.result("")?;
        return Ok(Exit::Complete);
    }
    if !console.json {
        // A message that nobody can read does not change the exit code.
        let _ = error.print();
        return Ok(Exit::Usage);
    }
    let message = error.render().to_string();
    let message = message.lines().next().unwrap_or_default();
    let fault = Fault {
        key: context(error, clap::error::ContextKind::InvalidArg),
        value: context(error, clap::error::ContextKind::InvalidValue),
        allowed: context(error, clap::error::ContextKind::ValidValue),
        ..Fault::new("usage", message.trim_start_matches("error: "))
    };
    Err(Failure::Usage(vec![fault]))
}

fn context(error: &clap::Error, kind: clap::error::ContextKind) -> Option<String> {
    error.get(kind).map(ToString::to_string)
}
