//! What one simulation answers. Times are seconds after the onset of the pulse.

pub use crate::structure::{
    ArmContact, Complementarity, DiskExtremes, EnergyBook, Episode, StructureColumns,
};

/// Survival is decided, or it is not; a number that is not a number never decides it.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The clearance stayed above the failure limit for the whole window.
    Survives,
    /// The clearance fell below the failure limit.
    Fails {
        /// Time of touch, s.
        t_fail_s: f64,
        /// Place of touch on the slider.
        place: Place,
    },
    /// No answer.
    Undecided {
        /// Why.
        cause: Cause,
    },
}

/// A point of the slider's surface, slider coordinates, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// From the leading edge, m.
    pub x_m: f64,
    /// From the inner edge, m.
    pub y_m: f64,
}

/// Why a run has no verdict.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// The coupled solve did not converge at the smallest step.
    NotConverged {
        /// Time, s.
        time_s: f64,
        /// Largest scaled residual.
        residual: f64,
    },
    /// The step limit was reached.
    StepLimit {
        /// Time reached, s.
        time_s: f64,
        /// The limit.
        max_steps: u64,
    },
    /// A non-finite number appeared.
    NotFinite {
        /// Time, s.
        time_s: f64,
        /// Which quantity.
        quantity: &'static str,
    },
}

/// Steady flying state before the shock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteadyState {
    /// Minimum clearance, m.
    pub min_clearance_m: f64,
    /// Pitch, rad.
    pub pitch_rad: f64,
    /// Roll, rad.
    pub roll_rad: f64,
}

/// Dimple force over the simulated head.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DimpleRecord {
    /// Smallest contact force, N.
    pub min_force_n: f64,
    /// Total time open, s.
    pub open_s: f64,
}

/// What the run cost, and signs of trouble. Wall time is measured by the caller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Accepted head steps.
    pub steps: u64,
    /// Rejected head steps.
    pub rejected: u64,
    /// Film linear solves.
    pub film_solves: u64,
    /// Film factorisations.
    pub factorisations: u64,
    /// Structure steps.
    pub structure_steps: u64,
    /// Film unknowns.
    pub film_unknowns: u64,
    /// Largest scaled residual at acceptance.
    pub max_residual: f64,
    /// Smallest film pressure, Pa.
    pub min_pressure_pa: f64,
    /// Largest relative mass-balance error of the film over a step.
    pub mass_balance_error: f64,
}

/// Everything one simulation answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Verdict.
    pub verdict: Verdict,
    /// Smallest clearance, m; `None` when the head was not simulated.
    pub min_clearance_m: Option<f64>,
    /// Time of the smallest clearance, s.
    pub t_min_clearance_s: Option<f64>,
    /// Steady flying state.
    pub steady: Option<SteadyState>,
    /// Disk extremes.
    pub disk: DiskExtremes,
    /// Contact with the top arm.
    pub top: ArmContact,
    /// Contact with the bottom arm.
    pub bottom: ArmContact,
    /// Dimple.
    pub dimple: Option<DimpleRecord>,
    /// Energy book of the structure.
    pub energy: EnergyBook,
    /// Complementarity numbers.
    pub complementarity: Complementarity,
    /// Names of the effects that were simulated.
    pub effects: Vec<&'static str>,
    /// Things a user should know, as stable codes with a sentence.
    pub warnings: Vec<Warning>,
    /// Cost.
    pub cost: Cost,
    /// Histories, when asked for.
    pub history: Option<History>,
}

/// A warning of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Stable code such as `contact_modes`.
    pub code: &'static str,
    /// One sentence with figures.
    pub message: String,
}

/// Time histories of one simulation. Columns of one group have the length of its time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Structure.
    pub structure: StructureColumns,
    /// Head; ends at touch.
    pub head: HeadColumns,
}

/// Columns at the head's accepted steps.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(
    missing_docs,
    reason = "the names say quantity and unit; design reference section 7"
)]
pub struct HeadColumns {
    pub time_s: Vec<f64>,
    pub slider_z_m: Vec<f64>,
    pub slider_pitch_rad: Vec<f64>,
    pub slider_roll_rad: Vec<f64>,
    pub min_clearance_m: Vec<f64>,
    pub bearing_force_n: Vec<f64>,
    pub dimple_force_n: Vec<f64>,
}
