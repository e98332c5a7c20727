//! What the tests share: reference data, named scenes, the built program.

pub mod coarse;
pub mod digests;
pub mod drives;
pub mod hdf5_dump;
pub mod mock_sweep;
pub mod mock_uncertainty;
pub mod pairs;
pub mod program;
pub mod refined;
pub mod runge_kutta;
pub mod scenes;
pub mod seeded;
pub mod sheet;
pub mod tables;
pub mod timing;

pub use opshock_study::hard_cases::scenes::{bodies, films, heads, rough, structures, suspensions};

/// Reads a file of reference numbers (`tests/reference/README.md` says where they come from).
///
/// # Panics
/// When the file is missing or is not JSON.
pub fn reference(name: &str) -> serde_json::Value {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("reference")
        .join(name);
    let text = std::fs::read_to_string(&path).expect("reference file");
    serde_json::from_str(&text).expect("reference file is JSON")
}

/// A number out of reference data.
///
/// # Panics
/// When the value is not a number.
pub fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().expect("a number in the reference data")
}
