//! Defines the options that every command has.

use clap::{ArgAction, Args, ValueEnum};
use opshock_study::sweep::ProgressKind;
use std::path::PathBuf;

/// Options of every command.
#[derive(Args, Debug)]
pub struct GlobalArgs {
    /// Print version, commit and physics versions
    #[arg(short = 'V', long, action = ArgAction::Version)]
    version: Option<bool>,
    /// Worker threads [default: all cores]
    #[arg(short, long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) jobs: Option<u16>,
    /// Results, and errors, as JSON
    #[arg(long, global = true)]
    pub(super) json: bool,
    /// No messages but errors and warnings
    #[arg(short, long, global = true)]
    pub(super) quiet: bool,
    /// Set a key of the study; may be repeated
    #[arg(
        long,
        global = true,
        value_name = "KEY=VALUE",
        allow_hyphen_values = true
    )]
    pub(super) set: Vec<String>,
    /// Take a key, a section or an entry of a list away from the study; may be repeated
    #[arg(long, global = true, value_name = "KEY")]
    pub(super) unset: Vec<String>,
    /// Times that a point may be refined to meet its target uncertainty; 0 for a first look: search.max_refinements
    #[arg(long, global = true, value_name = "N")]
    pub(super) max_refinements: Option<u8>,
    /// Folder of the store [default: beside the study file, STUDY.opshock for STUDY.toml]
    #[arg(long, global = true, value_name = "DIR")]
    pub(super) store: Option<PathBuf>,
    /// Sample defect corrections of films anew, and keep none for other runs
    #[arg(long, global = true)]
    pub(super) no_cache: bool,
    /// How progress is shown
    #[arg(long, global = true, value_name = "HOW", value_enum, default_value_t)]
    pub(super) progress: ProgressChoice,
    /// Codes of warnings that need not stop the command, as W201,W203
    #[arg(long, global = true, value_name = "CODES", value_delimiter = ',')]
    pub(super) accept: Vec<String>,
}

/// How progress is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum ProgressChoice {
    /// A live table on a terminal, lines elsewhere
    #[default]
    Auto,
    /// A live table
    Bar,
    /// Lines
    Lines,
    /// Nothing
    None,
}

impl From<ProgressChoice> for ProgressKind {
    fn from(choice: ProgressChoice) -> Self {
        match choice {
            ProgressChoice::Auto => ProgressKind::Auto,
            ProgressChoice::Bar => ProgressKind::Bar,
            ProgressChoice::Lines => ProgressKind::Lines,
            ProgressChoice::None => ProgressKind::None,
        }
    }
}

impl GlobalArgs {
    /// Worker threads: `-j`, else one for each core.
    pub(super) fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.jobs.map_or_else(cores, usize::from)
    }
}
