//! Disk, ramp and their contact: one run gives a structural history.
#![doc = include_str!("theory.md")]

mod assembly;
mod bank;
mod closing;
mod contact_log;
mod contact_system;
mod driven;
mod energy;
mod flight;
mod forced_columns;
mod free_motion;
mod history;
mod model;
mod modes;
mod moreau_jean_run;
mod node;
mod record;
mod response;
mod rotor;
mod run_books;
mod shared;
mod span;
mod stretches;
mod stride;
mod watch;

pub use history::StructuralHistory;
pub use model::{
    SliderPlace, StructureError, StructureModel, StructureParameters, StructureRun,
    StructureWarning, Wake, Workspace,
};
pub use modes::{ArmModeRow, DiskModeRow, StructureModes, modes};
pub use record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBook, Episode, HubRecord,
    MomentumBook, StructureColumns,
};
pub use response::{Source, StructureAnswer};
pub use rotor::HubModeRow;

/// How disk and ramp are brought into contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactMethod {
    /// Exact flow between impacts, impacts located in time, aimed impulses in lasting contact.
    #[default]
    ExactFlow,
    /// Implicit midpoint steps with the constraint on velocities
    /// ([`crate::complementarity::moreau_jean`]): shares nothing with the other but the modes. An
    /// impact takes a whole step, so at equal steps it is less accurate.
    MoreauJean,
}

/// Numerical resolution of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureResolution {
    /// Step of the grid on which motion is stored and contact is resolved, s. Divided into equal
    /// parts when the fastest mode of the disk needs it.
    pub step_s: f64,
    /// Contact method.
    pub contact: ContactMethod,
}

/// How long a simulation lasts after the onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// Fixed length, s.
    Fixed {
        /// Length after the onset, s.
        length_s: f64,
    },
    /// Until disk and ramp energy fall below a share of their peak.
    UntilDecayed {
        /// Share of the peak energy.
        share: f64,
        /// Longest window, s.
        max_s: f64,
    },
}
