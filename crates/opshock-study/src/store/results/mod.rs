//! Results file `results.h5` of a store: the table and all runs, and enough to resume from.
//!
//! | where | what |
//! |-------|------|
//! | `/` attributes | `format` (`opshock results`), `format_version`, `program_version`, `commit`, `physics_structure`, `physics_head`, `study`, `study_digest`, `axes`, `steps_per_octave`, `reference_g`, `start_s`, `plan` (JSON: outputs, effects and rules of each ramp's scenes), `content_blake3` |
//! | `/points/*` | a row per point in the study's order: the columns of the table, the further axes under `/points/axes/NAME`, `point_digest`, `onset`, `onset_m_per_s2` |
//! | `/brackets/*` | every survivor below a failure: `point`, `lower_g`, `upper_g` (`/points/brackets_g` has the same as JSON) |
//! | `/runs/*` | every simulation of the canonical sequences, by point and then by sequence: `point`, `sequence`, `purpose`, `history` (its file from the store's folder, empty when none is kept), `index` (on an amplitude grid sixteen times as fine for `uncertainty`), `levels` (refinement levels relative to the study's resolution), `amplitude_g`, `amplitude_m_per_s2` (signed), `window_factor`, `retry`, `verdict`, `cause`, `message`, `t_fail_s`, `x_m`, `y_m`, `h_min_m`, `t_min_s`, and the work; `t_fail_after_onset_s` and `t_min_after_onset_s` are the same times to the last bit |
//! | `/machine` | host, threads, times; `/machine/runs` wall time of each run; `/machine/outside` simulations that no sequence requested (computed ahead, or of an earlier form of the study) |
//!
//! Every dataset has `units` and `description`, every group `description`. Missing numbers are NaN. Times are on the study's axis, where the
//! pulse starts at `start_s`, unless their name says otherwise.
//! Nothing outside `/machine` depends on the machine, the threads or the time of day. The file is
//! written whole aside, synced and renamed; `content_blake3`, and `outside_blake3` of
//! `/machine/outside`, cover what a resume takes from it;
//! a seal (`store/seal.rs`) behind the end of the HDF5 data covers the whole file.

mod columns;
mod point_columns;
mod read;
mod rows;
mod run_columns;
mod write;

pub use read::{parse, read};
pub use rows::{PointKeep, RESULTS_FORMAT, Results, RunRow, Session};
pub use write::{bytes, write};
