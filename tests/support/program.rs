//! Starts the program under test and collects what it prints.

use std::process::Command;

/// The program at `path` with every signal at its default: what the tests were started to ignore, under `nohup` or in
/// the background of a script, it would ignore with them. Its process is that of the command. It keeps nothing for other
/// processes: what a test sees is its own.
pub fn program(path: &str) -> Command {
    let mut command = Command::new("env");
    command.args(["--default-signal", path]);
    command.env("OPSHOCK_CACHE_DIR", "");
    command
}
