//! What one simulation answers. Times are seconds after the onset of the pulse.

use crate::air_bearing::Attitude;
pub use crate::head::{
    Cause, DimpleRecord, HeadColumns, Place, PressureFields, StopRecord, Verdict,
};
pub use crate::structure::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBook, Episode, HubRecord,
    MomentumBook, StructureColumns,
};

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
    /// Verdict on what was simulated; [`Outcome::answer`] asks for that on the interface.
    pub verdict: Verdict,
    /// Smallest clearance, m, up to the first touch, where it is the limit; `None` when the head was
    /// not simulated.
    pub min_clearance_m: Option<f64>,
    /// Time of the smallest clearance, s.
    pub t_min_clearance_s: Option<f64>,
    /// Attitude of the slider over the disk at that time.
    pub lowest: Option<Attitude>,
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
    /// Limiters of the suspension.
    pub limiters: Option<StopRecord>,
    /// Lift tab.
    pub lift_tab: Option<StopRecord>,
    /// Energy book of the structure.
    pub energy: EnergyBook,
    /// Complementarity numbers.
    pub complementarity: Complementarity,
    /// Hub, of a disk on a bearing.
    pub hub: Option<HubRecord>,
    /// Base, when it vibrates.
    pub base: Option<BaseRecord>,
    /// Names of the effects that were simulated.
    pub effects: Vec<&'static str>,
    /// Rules of [`crate::scene::plan`] that were applied.
    pub rules: Vec<&'static str>,
    /// Things a user should know, as stable codes with a sentence.
    pub warnings: Vec<Warning>,
    /// Cost.
    pub cost: Cost,
    /// Histories, when asked for.
    pub history: Option<History>,
}

impl Outcome {
    /// The verdict; `None` when the head was not simulated and disk and ramp ran to the end.
    pub fn answer(&self) -> Option<&Verdict> {
        let is_without_head = self.min_clearance_m.is_none();
        match &self.verdict {
            Verdict::Survives if is_without_head => None,
            verdict => Some(verdict),
        }
    }
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
    /// Head; ends at touch under a plan that [stops there](crate::scene::plan::Plan::stops_at_touch).
    pub head: HeadColumns,
    /// Pressure fields, when the plan keeps some.
    pub fields: Option<PressureFields>,
}
