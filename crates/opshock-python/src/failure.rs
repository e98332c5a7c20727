//! Failures as Python exceptions, which carry the faults that `--json` prints.

use opshock::cli::failure::{Failure, Fault};
use pyo3::prelude::*;

/// The exception of a failure: made by `opshock._errors.of`.
pub fn raised(py: Python<'_>, failure: impl Into<Failure>) -> PyErr {
    let failure = failure.into();
    let message = match &failure {
        Failure::Study(errors) => errors.to_string(),
        failure => failure.text(),
    };
    let arguments = (
        failure.exit().code(),
        message,
        failure.json()["errors"].to_string(),
    );
    made(py, arguments)
}

/// The exception of one fault of the program.
pub fn raised_fault(py: Python<'_>, fault: Fault) -> PyErr {
    let faults = serde_json::json!([fault]).to_string();
    made(py, (1, fault.message, faults))
}

fn made(py: Python<'_>, arguments: (u8, String, String)) -> PyErr {
    let made = py
        .import("opshock._errors")
        .and_then(|module| module.call_method1("of", arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// A result with its failure as an exception.
pub fn or_raise<T>(py: Python<'_>, result: Result<T, impl Into<Failure>>) -> PyResult<T> {
    result.map_err(|failure| raised(py, failure))
}
