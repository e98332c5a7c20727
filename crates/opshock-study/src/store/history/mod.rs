//! History files of single simulations.
//!
//! One simulation has two time axes: disk and ramp run the whole window on the structure's grid;
//! the head has its own accepted steps and ends at its failure. A history file carries both:
//!
//! | where | on | what |
//! |-------|----|------|
//! | `/NAME` | `/time_s` | every column of structure **and** head; head columns are interpolated linearly from `/head` and empty (NaN) outside the head's time |
//! | `/head/NAME` | `/head/time_s` | head columns as computed; only when the head was simulated |
//! | `/fields/pressure_pa`, `/fields/gap_m` | `/fields/time_s` × `y_lines_m` × `x_lines_m` | film pressure and height in the middle of every cell; only when `pressure_field` was asked for |
//!
//! So any two root columns can be drawn against each other at once, and nothing computed is lost.
//! Extremes of the head belong to `/head`, interpolation may cut them off.
//! Times are on the study's axis: the pulse starts at [`HistoryHeader::start_s`].
//! An HDF5 file ends with a seal (`store/seal.rs`). Coordinates of the point that are numbers are numbers in the
//! attributes since format 2; before they were text.

mod columns;
mod csv_file;
mod hdf5_file;
mod kept;
mod stored;
#[cfg(test)]
mod tests;

pub use columns::{
    Column, HISTORY_FORMAT, HistoryHeader, head_columns, root_columns, structure_columns,
};
pub use csv_file::{fields_path, write_csv};
pub use hdf5_file::write_hdf5;
pub use kept::KeptRun;
pub use stored::{StoredHistory, parse};
