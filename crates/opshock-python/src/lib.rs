//! The compiled half of the Python package `opshock`: studies, simulations, sweeps and stores by the same code as the
//! command line. Structured answers cross the border as JSON text, columns of numbers as bytes; the Python half
//! (`python/opshock`) gives them types, units and documentation.

mod command;
mod failure;
mod search;
mod shock;
mod signals;
mod store;
mod study;
mod sweep;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::command::{cores, main, program, schema};
    #[pymodule_export]
    use super::search::Search;
    #[pymodule_export]
    use super::shock::{simulate, simulate_many};
    #[pymodule_export]
    use super::store::{open_store, store_runs};
    #[pymodule_export]
    use super::study::Study;
    #[pymodule_export]
    use super::sweep::sweep;
}
