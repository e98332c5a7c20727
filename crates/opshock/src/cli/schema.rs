//! `opshock schema`: prints the JSON Schema of study files, for editors, and what each key means, for people.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use clap::Args;
use opshock_study::report::terms;
use opshock_study::study::{reference, schema};
use serde_json::json;

/// Print what a key or a word of the report means, or the JSON Schema of study files
#[derive(Args, Debug)]
pub struct SchemaArgs {
    /// Keys or sections, as disk.thickness_mm: meaning, unit, range, default; or words of tables and reports
    #[arg(value_name = "KEY", conflicts_with_all = ["units", "markdown", "terms"])]
    keys: Vec<String>,
    /// Print the suffixes of keys with their units instead
    #[arg(long)]
    units: bool,
    /// Print the reference of all keys instead
    #[arg(long, conflicts_with = "units")]
    markdown: bool,
    /// Print the words of tables, plots and reports with their meaning instead
    #[arg(long, conflicts_with_all = ["units", "markdown"])]
    terms: bool,
}

/// Runs the command.
pub fn run(arguments: &SchemaArgs, console: &Console) -> Result<Exit, Failure> {
    if !arguments.keys.is_empty() {
        let found = arguments
            .keys
            .iter()
            .map(|key| reference::of(key).or_else(|wrong| terms::named(key).ok_or(wrong)));
        let texts: Vec<String> = found
            .collect::<Result<_, _>>()
            .map_err(|wrong| Failure::Usage(vec![Fault::new("usage", wrong)]))?;
        match console.json {
            true => console.result_json(&json!(texts))?,
            false => console.result(&texts.concat())?,
        }
    } else if arguments.terms {
        console.result(&terms::markdown())?;
    } else if arguments.markdown {
        console.result(&reference::markdown())?;
    } else if !arguments.units {
        console.result_json(&schema::json_schema())?;
    } else if console.json {
        console.result_json(&schema::units())?;
    } else {
        console.result(&(schema::units().join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}
