//! `opshock merge`: unites shards, or other stores of the same study, in one store.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::report::exit_of;
use super::stored;
use anyhow::Context as _;
use clap::Args;
use opshock_study::report::table;
use opshock_study::store::folder::session;
use opshock_study::store::{self, Owner, StoreError, StudyTexts};
use opshock_study::study::Study;
use opshock_study::sweep::added_points::refined;
use opshock_study::sweep::{MergeEnd, SweepInput, merge, shard};
use std::path::{Path, PathBuf};

/// Unite the shards of a sweep, or other stores of its study, in one store
#[derive(Args, Debug)]
pub struct MergeArgs {
    /// Store of the whole sweep, or its study file; made when it is missing
    // Not `store`: arguments are known by their names, and --store has that.
    #[arg(value_name = "STORE|STUDY")]
    target: PathBuf,
    /// Stores to take from [default: the shards in STORE]
    #[arg(value_name = "FROM")]
    from: Vec<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &MergeArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let target = if arguments.from.is_empty() || arguments.target.is_file() {
        stored::source(&arguments.target, global)?
    } else {
        stored::Source::of_folder(&arguments.target)
    };
    let folder = &target.folder;
    let from = if arguments.from.is_empty() {
        shard::stores(folder)?
    } else {
        arguments.from.clone()
    };
    let Some(first) = from.first() else {
        return Err(StoreError::Empty {
            path: folder.clone(),
        }
        .into());
    };
    let texts = texts(first, &target)?;
    for other in &from[1..] {
        same_study(first, &texts, other)?;
    }
    let study = Study::from_text(&texts.resolved, &[])?;
    let no_range = "the study has no amplitudes to search";
    let mut input = SweepInput::of(&study).context(no_range)?;
    input.texts = texts;
    let mut end = merge(&input, folder, &from, &session(1))?;
    if study.search.added_points.is_some() && matches!(end, MergeEnd::Merged(_)) {
        // The answers say which widths were added; with these the table is whole.
        let refined = refined(&study, &stored::finished(folder)?);
        let whole = SweepInput {
            texts: input.texts.clone(),
            ..SweepInput::of(&refined.context(no_range)?).context(no_range)?
        };
        let again = merge(&whole, folder, &from, &session(1))?;
        if let (MergeEnd::Merged(first), MergeEnd::Merged(again)) = (&mut end, again) {
            first.results = again.results;
            first.left = again.left;
        }
    }
    match end {
        MergeEnd::Disagree(found) => {
            for disagreement in &found {
                console.note(&disagreement.to_string());
            }
            console.note("nothing was merged: the stores are not of one program and one machine");
            Ok(Exit::Difference)
        }
        MergeEnd::Merged(merged) => {
            for (path, taken) in from.iter().zip(&merged.taken) {
                console.note(&format!("{}: {taken} simulations", path.display()));
            }
            if merged.rounding > 0 {
                console.note(&format!(
                    "warning: rounding: {} simulations were made twice with the same verdict and \
                     other last digits; those of the first store are kept",
                    merged.rounding
                ));
            }
            for damage in &merged.left {
                console.note(&format!("warning: history: {damage}"));
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

/// The study kept in the first of the stores, which has to be the one that `target` asks for.
fn texts(store: &Path, target: &stored::Source) -> Result<StudyTexts, Failure> {
    let owner = owner(store)?;
    target.check(&owner)?;
    // Shards of an older form of the study must not take its place unasked.
    if !target.is_of_study() && target.folder.exists() {
        let whole = stored::finished(&target.folder)?;
        if let Some(whole) = whole.owner.filter(|whole| whole.digest != owner.digest) {
            let resolved = owner.resolved.as_deref().unwrap_or_default();
            whole.belongs(&target.folder, store, &owner.digest, resolved)?;
        }
    }
    // The file as given is for people: a store may have lost it.
    let given = std::fs::read_to_string(store.join("study.toml")).unwrap_or_default();
    let file = match target.file() {
        Some(file) => Some(file.to_owned()),
        None => owner.file.map(|file| store.join(file)),
    };
    let resolved = owner.resolved.ok_or_else(|| StoreError::Damaged {
        path: store.to_owned(),
        what: "it does not keep the study of its results".into(),
        hint: "`opshock sweep` of that study into it mends this",
    })?;
    Ok(StudyTexts {
        name: owner.name,
        digest: owner.digest,
        file: file.and_then(|file| std::fs::canonicalize(file).ok()),
        given,
        resolved,
    })
}

/// The study that a store belongs to.
fn owner(store: &Path) -> Result<Owner, Failure> {
    Ok(stored::owner(&mut store::load(store)?.0, store)?)
}

/// Refuses stores whose studies differ.
fn same_study(first: &Path, texts: &StudyTexts, other: &Path) -> Result<(), Failure> {
    let owner = owner(other)?;
    if owner.digest == texts.digest {
        return Ok(());
    }
    let differ = owner.changed(&texts.resolved).unwrap_or_default();
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
