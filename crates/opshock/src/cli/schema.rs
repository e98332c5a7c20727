//! `opshock schema`: prints the JSON Schema of study files, for editors.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use clap::Args;
use opshock_study::study::schema;

/// Print the JSON Schema of study files
#[derive(Args, Debug)]
pub struct SchemaArgs {
    /// Print the suffixes of keys with their units instead
    #[arg(long)]
    units: bool,
}

/// Runs the command.
pub fn run(arguments: &SchemaArgs, console: &Console) -> Result<Exit, Failure> {
    if !arguments.units {
        console.result_json(&schema::json_schema())?;
    } else if console.json {
        console.result_json(&schema::units())?;
    } else {
        console.result(&(schema::units().join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}
