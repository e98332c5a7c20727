//! The command line inside Python, and what the program says of itself.

use opshock::cli::main_with;
use opshock_study::provenance;
use opshock_study::study::schema::json_schema;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line with these arguments, the first the program's name; its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| main_with(arguments).code())
}

/// `opshock VERSION (COMMIT, physics STRUCTURE/HEAD)`.
#[pyfunction]
pub fn program() -> String {
    provenance::program()
}

/// Cores that this process may use.
#[pyfunction]
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The JSON Schema of study files.
#[pyfunction]
pub fn schema() -> String {
    json_schema().to_string()
}
