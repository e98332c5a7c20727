//! Asks whether standard error is a terminal, with colour, and how wide.

use std::io::IsTerminal as _;

/// Whether messages may carry colour: a terminal, and neither `NO_COLOR` nor `TERM=dumb`.
pub fn stderr_colour() -> bool {
    let unset = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    unset && !dumb && std::io::stderr().is_terminal()
}

/// Width for messages, in characters; `None` when they go to no terminal.
pub fn stderr_width() -> Option<usize> {
    if !std::io::stderr().is_terminal() {
        return None;
    }
    let columns = std::env::var("COLUMNS")
        .ok()
        .and_then(|text| text.parse().ok());
    Some(columns.unwrap_or(100))
}
