//! `opshock schema`: prints the JSON Schema of study files, for editors, and what each key means, for people.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use clap::{Arg, Args, Command};
use opshock_study::report::terms;
use opshock_study::study::{reference, schema};
use serde_json::json;

/// Print what a key or a word of the report means, or the JSON Schema of study files
#[derive(Args, Debug)]
pub struct SchemaArgs {
    /// Keys or sections, as disk.thickness_mm: meaning, unit, range, default; or words of tables and reports
    #[arg(value_name = "KEY", conflicts_with_all = ["units", "markdown", "terms", "commands"])]
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
    /// Print the reference of all commands with their options instead
    #[arg(long, conflicts_with_all = ["units", "markdown", "terms"])]
    commands: bool,
}

/// Runs the command.
pub fn run(arguments: &SchemaArgs, program: Command, console: &Console) -> Result<Exit, Failure> {
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
    } else if arguments.commands {
        console.result(&commands(program))?;
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

/// Every command with its arguments and options, from its help.
fn commands(mut program: Command) -> String {
    program.build();
    let mut text = String::from(
        "# The commands of opshock\n\nMade by `opshock schema --commands` from the help texts: `opshock COMMAND --help` says the \
         same.\n\n## Options of every command\n\n",
    );
    let is_shared = |argument: &&Arg| argument.is_global_set() || argument.get_id() == "version";
    table(&mut text, program.get_arguments().filter(is_shared));
    let exits = program.get_after_help().map(ToString::to_string);
    text.push_str(&format!("\n{}.\n", exits.unwrap_or_default()));
    for command in program.get_subcommands() {
        page(&mut text, "opshock", command);
    }
    text
}

/// A command and those below it.
fn page(text: &mut String, above: &str, command: &Command) {
    let name = format!("{above} {}", command.get_name());
    let about = command.get_long_about().or(command.get_about());
    let about = about.map(ToString::to_string).unwrap_or_default();
    text.push_str(&format!(
        "\n## `{name}`\n\n{}.\n\n",
        about.trim_end_matches('.')
    ));
    let own = |argument: &&Arg| {
        !argument.is_global_set() && !argument.is_hide_set() && argument.get_id() != "help"
    };
    table(text, command.get_arguments().filter(own));
    for below in command.get_subcommands() {
        page(text, &name, below);
    }
}

/// A row an argument; nothing without any.
fn table<'a>(text: &mut String, arguments: impl Iterator<Item = &'a Arg>) {
    let escaped = |words: String| words.replace('|', "\\|").replace('\n', " ");
    let mut rows = arguments.peekable();
    if rows.peek().is_some() {
        text.push_str("| argument | what |\n| --- | --- |\n");
    }
    for argument in rows {
        let help = argument.get_long_help().or(argument.get_help());
        let mut help = help.map(ToString::to_string).unwrap_or_default();
        let words = argument.get_possible_values();
        if !words.is_empty() && argument.get_action().takes_values() {
            let names: Vec<&str> = words.iter().map(|word| word.get_name()).collect();
            help.push_str(&format!(" [{}]", names.join(", ")));
        }
        let names = escaped(argument.to_string());
        let short = argument
            .get_short()
            .map_or(String::new(), |short| format!("`-{short}`, "));
        text.push_str(&format!("| {short}`{names}` | {} |\n", escaped(help)));
    }
}
