//! Figures of the verification manual: what a test holds against an independent reference, with its bound.
//!
//! The words of a sheet (problem, reference and its trust) are in `tests/physics/sheets.toml`, its figures come from the tests:
//! `make manual` runs them with `OPSHOCK_SHEETS` set to a folder, and writes `docs/verification-manual.md` of both.

use std::io::Write;
use std::path::Path;

/// Asserts that `figure`, named by `what`, is at most `bound`, and keeps it for the sheet.
///
/// # Panics
/// When it is larger or no number, and when the folder of `OPSHOCK_SHEETS` cannot be written.
#[track_caller]
pub fn at_most(sheet: &str, what: &str, figure: f64, bound: f64) {
    assert!(figure <= bound, "{sheet}, {what}: {figure:e} of {bound:e}");
    let Some(folder) = std::env::var_os("OPSHOCK_SHEETS") else {
        return;
    };
    let line =
        serde_json::json!({ "sheet": sheet, "what": what, "figure": figure, "bound": bound });
    let path = Path::new(&folder).join("figures.jsonl");
    let mut options = std::fs::OpenOptions::new();
    let mut file = options.create(true).append(true).open(path).unwrap();
    // One write: tests run side by side.
    file.write_all(format!("{line}\n").as_bytes()).unwrap();
}
