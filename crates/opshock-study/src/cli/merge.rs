//! `opshock merge`: shards, or other stores of the same study, united in one.

use super::GlobalArgs;
use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::report::exit_of;
use super::stored;
use crate::report::table;
use crate::store::folder::session;
use crate::store::{StoreError, StudyTexts};
use crate::study::{Study, difference};
use crate::sweep::refine::refined;
use crate::sweep::{MergeEnd, SweepInput, merge, shard};
use anyhow::Context as _;
use clap::Args;
use std::path::{Path, PathBuf};

/// Unite the shards of a sweep, or other stores of its study, in one store
#[derive(Args, Debug)]
pub struct MergeArgs {
    /// Store of the whole sweep, or its study file; made when it is missing
    #[arg(value_name = "STORE|STUDY")]
    store: PathBuf,
    /// Stores to take from [default: the shards in STORE]
    #[arg(value_name = "FROM")]
    from: Vec<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &MergeArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let folder = if arguments.from.is_empty() || arguments.store.is_file() {
        stored::folder(&arguments.store, global)?
    } else {
        arguments.store.clone()
    };
    let from = if arguments.from.is_empty() {
        shard::stores(&folder).with_context(|| format!("cannot read {}", folder.display()))?
    } else {
        arguments.from.clone()
    };
    let Some(first) = from.first() else {
        return Err(StoreError::Empty { path: folder }.into());
    };
    let texts = texts(first)?;
    for other in &from[1..] {
        same_study(first, &texts, other)?;
    }
    let study = Study::from_text(&texts.resolved, &[])?;
    let no_range = "the study has no amplitudes to search";
    let mut input = SweepInput::of(&study).context(no_range)?;
    input.texts = StudyTexts {
        name: study.name.clone(),
        ..texts
    };
    let mut end = merge(&input, &folder, &from, &session(1))?;
    if study.search.refine.is_some() && matches!(end, MergeEnd::Merged(_)) {
        // The answers say which widths were added; with these the table is whole.
        let refined = refined(&study, &stored::finished(&folder)?);
        let whole = SweepInput {
            texts: input.texts.clone(),
            ..SweepInput::of(&refined.context(no_range)?).context(no_range)?
        };
        let again = merge(&whole, &folder, &from, &session(1))?;
        if let (MergeEnd::Merged(first), MergeEnd::Merged(again)) = (&mut end, again) {
            first.results = again.results;
            first.left = again.left;
        }
    }
    match end {
        MergeEnd::Disagree(found) => {
            for disagreement in &found {
                console.tell(&disagreement.to_string());
            }
            console.tell("nothing was merged: the stores are not of one program and one machine");
            Ok(Exit::Difference)
        }
        MergeEnd::Merged(merged) => {
            for (path, taken) in from.iter().zip(&merged.taken) {
                console.tell(&format!("{}: {taken} simulations", path.display()));
            }
            if merged.rounding > 0 {
                console.tell(&format!(
                    "warning: rounding: {} simulations were made twice with the same verdict and \
                     other last digits; those of the first store are kept",
                    merged.rounding
                ));
            }
            for damage in &merged.left {
                console.tell(&format!("warning: history: {damage}"));
            }
            let summary = &merged.results.summary;
            if console.json {
                console.result_json(summary)?;
            } else {
                console.result(&table::terminal(summary))?;
            }
            Ok(exit_of(summary))
        }
    }
}

/// The study kept in a store.
fn texts(store: &Path) -> Result<StudyTexts, Failure> {
    let read = |name: &str| {
        let path = store.join(name);
        std::fs::read_to_string(&path).map_err(|source| StoreError::Unreadable { path, source })
    };
    Ok(StudyTexts {
        name: String::new(),
        given: read("study.toml")?,
        resolved: read("study.resolved.toml")?,
    })
}

/// Refuses stores whose studies differ.
fn same_study(first: &Path, texts: &StudyTexts, other: &Path) -> Result<(), Failure> {
    let resolved = self::texts(other)?.resolved;
    if resolved == texts.resolved {
        return Ok(());
    }
    let flat = |text: &str| difference::flat(text).unwrap_or_default();
    let differ = difference::differing(&flat(&texts.resolved), &flat(&resolved));
    let differ: Vec<String> = differ.iter().map(ToString::to_string).collect();
    Err(Failure::Usage(vec![Fault {
        key: Some("FROM".into()),
        value: Some(other.display().to_string()),
        allowed: Some("stores of one study".into()),
        hint: Some(differ.join(", ")),
        ..Fault::new(
            "usage",
            format!(
                "{} and {} are stores of different studies",
                first.display(),
                other.display()
            ),
        )
    }]))
}
