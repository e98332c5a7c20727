//! Outcome of one simulation: verdict, clearance, records, cost. Times are seconds after the pulse's onset.

use crate::air_bearing::Attitude;
pub use crate::head::{
    Cause, ContactWork, DimpleRecord, HeadColumns, HeadEnergy, Place, PressureFields,
    SliderContact, SliderEpisode, StopRecord, Verdict,
};
pub use crate::structure::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBalance, Episode, HubRecord,
    MomentumBalance, StructureColumns,
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

/// Cost and numerical quality of a run. The caller measures wall time.
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

/// Outcome of one simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Whether slider and disk touched; `None` when the head was not simulated and disk and ramp ran to the end.
    pub verdict: Option<Verdict>,
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
    /// Contact of slider and disk over the simulated time, of a scene with contact of asperities.
    pub slider_contact: Option<SliderContact>,
    /// Energy balance of the structure.
    pub energy: EnergyBalance,
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
    /// Warnings, as stable codes with a sentence.
    pub warnings: Vec<Warning>,
    /// Cost.
    pub cost: Cost,
    /// Histories, when requested.
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
    /// Head; ends at its failure under a plan that [stops there](crate::scene::plan::Plan::stops_at_failure).
    pub head: HeadColumns,
    /// Pressure fields, when the plan keeps some.
    pub fields: Option<PressureFields>,
}
