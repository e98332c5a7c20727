//! Simulates disk, ramp and their contact under a shock; one run gives the disk's motion under the slider.
#![doc = include_str!("theory.md")]

mod assembly;
mod bank;
mod batched_step;
mod closing;
mod contact_free;
mod contact_free_run;
mod contact_log;
mod contact_system;
mod displacements;
mod driven;
mod energy;
mod error;
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
mod run_in_progress;
mod sample;
mod shared;
mod snapshot;
mod span;
mod stretches;
mod time_grid;
mod watch;

pub use displacements::disk_displacements;
pub use error::StructureError;
pub use history::StructuralHistory;
pub use model::{Activation, StructureModel, Workspace};
pub use modes::{ArmModeRow, DiskModeRow, StructureModes, modes};
pub use outcome::{StructureRun, StructureWarning};
pub use parameters::{
    ContactMethod, SliderPlace, StructureParameters, StructureResolution, Window,
};
pub use record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBalance, Episode, HubRecord,
    MomentumBalance, StructureColumns,
};
pub use response::{Source, StructureAnswer};
pub use rotor::HubModeRow;
