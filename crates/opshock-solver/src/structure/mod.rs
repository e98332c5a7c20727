//! Disk, ramp and their contact: one run gives a structural history.
#![doc = include_str!("theory.md")]

mod assembly;
mod bank;
mod closing;
mod contact_log;
mod contact_system;
mod driven;
mod energy;
mod error;
mod flight;
mod flying;
mod forced_columns;
mod forced_modes;
mod free_motion;
mod history;
mod model;
mod modes;
mod moreau_jean_run;
mod node;
mod outcome;
mod outlook;
mod parameters;
mod record;
mod response;
mod rotor;
mod run_books;
mod sample;
mod shared;
mod span;
mod stretches;
mod stride;
mod time_grid;
mod watch;

pub use error::StructureError;
pub use history::StructuralHistory;
pub use model::{StructureModel, Wake, Workspace};
pub use modes::{ArmModeRow, DiskModeRow, StructureModes, modes};
pub use outcome::{StructureRun, StructureWarning};
pub use parameters::{
    ContactMethod, SliderPlace, StructureParameters, StructureResolution, Window,
};
pub use record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBook, Episode, HubRecord,
    MomentumBook, StructureColumns,
};
pub use response::{Source, StructureAnswer};
pub use rotor::HubModeRow;
