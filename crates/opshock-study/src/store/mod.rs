//! Storage of finished simulations: journal, HDF5 results, lock, resume.
//!
//! A store is a folder. Its `journal` is the truth: one checksummed record per finished simulation, on the disk before
//! it is reported. `results.h5` is made from it, replaced whole, readable at any time, and enough to resume from when
//! the journal is gone. Simulations are found by content, so a changed study finds what is still valid.

pub mod aside;
pub mod audit;
pub mod error;
pub mod files;
pub mod folder;
pub mod hdf5_file;
pub mod history;
pub mod journal;
pub mod lock;
pub mod machine;
pub mod names;
pub mod numbers;
mod owner;
pub mod record;
pub mod results;
mod seal;
pub mod summary;

pub use audit::{Audit, Difference};
pub use error::StoreError;
pub use folder::{Loaded, Store, load};
pub use numbers::{Answered, Known, NumberStore, Numbers};
pub use owner::{Owner, StudyTexts};
pub use record::{PointDigest, Record, RunKey, RunMachine, RunRecord, StoredTouch, TouchRecord};
pub use results::{PointKeep, Results, RunRow, Session};
pub use summary::{AxisValue, Contribution, Flag, PointSummary, Status, Summary, Totals};
