//! `opshock report`: prints the critical shocks of a store, and writes table, figure and page.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::stored::{self, Stored};
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use opshock_study::accuracy::Accuracy;
use opshock_study::report::answer::Answer;
use opshock_study::report::coordinates::{self, NotOfTheTable};
use opshock_study::report::{
    CrossingRow, ReportSource, Saving, report_files, savings, table, terminal_plot,
};
use opshock_study::store::names::RESULTS_FILE;
use opshock_study::store::{Audit, Status, Summary, aside, results};
use opshock_study::study::Study;
use opshock_study::sweep::added_points;
use serde::Serialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Show the critical shocks of a store; write table, figure and HTML page
#[derive(Args, Debug)]
pub struct ReportArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    source: PathBuf,
    /// Format of the table on standard output
    #[arg(long, value_name = "FORMAT")]
    format: Option<TableFormat>,
    /// Plot the critical shocks as text
    #[arg(long, conflicts_with = "format")]
    plot: bool,
    /// Folder for table.md, table.csv, critical_shock.svg, critical_shock.png, report.html and results.h5
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Key on the abscissa of the figure, as ramp.clearance_um or pulse_ms [default: the numbers with most values]
    #[arg(long, value_name = "KEY", requires = "out")]
    x: Option<String>,
    /// Also print what the rules of `opshock explain` saved
    #[arg(short, long)]
    verbose: bool,
    /// accuracy.json of `opshock accuracy`, shown in report.html
    #[arg(long, value_name = "FILE", requires = "out")]
    accuracy: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TableFormat {
    Csv,
    Md,
    Json,
}

/// The answer in words and the table as JSON, with the audit when there was one and what the rules saved.
#[derive(Serialize)]
pub(super) struct Reported<'a> {
    answer: String,
    #[serde(flatten)]
    summary: &'a Summary,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit: Option<&'a Audit>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    savings: &'a [Saving],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    crossings: Vec<CrossingRow>,
}

/// Crossings of a store's curves, if its study asks for them.
fn crossings(stored: &Stored) -> Vec<CrossingRow> {
    let study = stored.resolved_study.as_deref();
    let Some(study) = study.and_then(|text| Study::from_text(text, &[]).ok()) else {
        return Vec::new();
    };
    let found = added_points::crossings(&study, &stored.summary);
    found.iter().map(CrossingRow::of).collect()
}

impl<'a> Reported<'a> {
    /// Of what a store holds.
    pub(super) fn of(stored: &'a Stored) -> Self {
        Self {
            answer: Answer::of(&stored.summary).sentences().join(" "),
            summary: &stored.summary,
            audit: stored.audit.as_ref(),
            savings: &stored.savings,
            crossings: crossings(stored),
        }
    }
}

/// Runs the command.
pub fn run(
    arguments: &ReportArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let source = stored::source(&arguments.source, global)?;
    let (results, study) = stored::load(&source, console)?;
    let folder = source.folder;
    let mechanisms = match arguments.out {
        Some(_) => results.mechanisms(&folder)?,
        None => HashMap::new(),
    };
    let stored = Stored::of(&folder, &results, study, &mechanisms);
    // Not this one: it may be newer than the numbers.
    let program = results.session.program();
    let accuracy = arguments.accuracy.as_deref().map(measured).transpose()?;
    let shown = stored.resolved_study.as_deref();
    let film = match shown.filter(|_| arguments.out.is_some()) {
        Some(study) => stored::film(&folder, &results, study)?,
        None => None,
    };
    let crossings = crossings(&stored);
    let find = |key: &String| coordinates::find(&stored.summary, "--x", key);
    let abscissa = arguments.x.as_ref().map(find).transpose();
    let abscissa = abscissa.map_err(not_of_the_table)?;
    let source = ReportSource {
        summary: &stored.summary,
        runs: &stored.runs,
        program: &program,
        resolved_study: stored.resolved_study.as_deref(),
        audit: stored.audit.as_ref(),
        savings: &stored.savings,
        crossings: &crossings,
        accuracy: accuracy.as_ref(),
        plan: &stored.plan,
        film: film.as_ref(),
        abscissa,
    };
    if let Some(out) = arguments
        .out
        .as_ref()
        .filter(|out| out.join("journal").exists())
    {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--out".into()),
            value: Some(out.display().to_string()),
            allowed: Some("a folder that is no store".into()),
            ..Fault::new(
                "usage",
                format!(
                    "{} is a store: the report would replace its results",
                    out.display()
                ),
            )
        }]));
    }
    if let Some(out) = &arguments.out {
        let mut files = report_files(&source).context("cannot draw the report")?;
        // What the table shows, whatever became of the store's own file.
        let bytes = results::bytes(&out.join(RESULTS_FILE), &results, &folder)?;
        files.push((RESULTS_FILE, bytes));
        for path in aside::write_all(out, files)? {
            console.note(&format!("wrote {}", path.display()));
        }
    }
    let format = match arguments.format {
        None if console.json => Some(TableFormat::Json),
        format => format,
    };
    match format {
        None if arguments.plot => console.result(&terminal_plot(&stored.summary))?,
        None => {
            let table = table::terminal(&stored.summary);
            console.result(&format!("{}\n\n{table}", source.answer()))?;
            for meaning in table::meanings(&stored.summary) {
                console.note(&meaning);
            }
            if let Some(values) = source.not_refined() {
                console.note(&values);
            }
            for crossing in &crossings {
                console.note(&crossing.line());
            }
            let saved = savings::lines(&stored.savings);
            for line in saved.iter().filter(|_| arguments.verbose) {
                console.note(line);
            }
        }
        Some(TableFormat::Csv) => console.result(&table::csv(&stored.summary))?,
        Some(TableFormat::Md) => {
            let (answer, provenance) = (source.answer(), source.provenance());
            console.result(&table::markdown(&stored.summary, &answer, &provenance))?;
        }
        Some(TableFormat::Json) => console.result_json(&Reported::of(&stored))?,
    }
    Ok(exit_of(&stored.summary))
}

/// The failure of an option that names what the table does not have.
pub(super) fn not_of_the_table(fault: NotOfTheTable) -> Failure {
    let message = fault.to_string();
    Failure::Usage(vec![Fault {
        key: Some(fault.key),
        value: Some(fault.value),
        allowed: Some(fault.allowed),
        ..Fault::new("usage", message)
    }])
}

/// What `opshock accuracy` wrote.
fn measured(path: &Path) -> Result<Accuracy, Failure> {
    let failure = |what: String| {
        Failure::Usage(vec![Fault::new(
            "accuracy",
            format!("{}: {what}", path.display()),
        )])
    };
    let text = std::fs::read_to_string(path).map_err(|error| failure(error.to_string()))?;
    serde_json::from_str(&text)
        .map_err(|error| failure(format!("not an accuracy.json of this program: {error}")))
}

/// Complete, or complete but for open points.
pub fn exit_of(summary: &Summary) -> Exit {
    if summary
        .points
        .iter()
        .all(|point| point.status == Status::Ok)
    {
        Exit::Complete
    } else {
        Exit::Open
    }
}
