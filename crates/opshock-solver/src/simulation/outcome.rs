//! What one simulation answers. Times are seconds after the onset of the pulse.

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

/// Extremes of the disk's motion over the window, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiskExtremes {
    /// Largest displacement under the slider.
    pub slider_max_m: f64,
    /// Smallest displacement under the slider.
    pub slider_min_m: f64,
    /// Largest displacement at the ramp point.
    pub ramp_max_m: f64,
    /// Smallest displacement at the ramp point.
    pub ramp_min_m: f64,
    /// Largest magnitude at the rim, at the ramp's angle.
    pub rim_max_m: f64,
}

/// A contact spell; spells closer than 30 us are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Episode {
    /// First impulse, s.
    pub on_s: f64,
    /// Last impulse, s.
    pub off_s: f64,
    /// Impulse, N s.
    pub impulse_n_s: f64,
    /// Largest 20 us running mean of the force, N.
    pub peak_20us_n: f64,
}

/// Contact with one arm over the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmContact {
    /// First touch, s.
    pub first_touch_s: Option<f64>,
    /// Total impulse, N s.
    pub impulse_n_s: f64,
    /// Spells in order.
    pub episodes: Vec<Episode>,
}

/// Dimple force over the simulated head.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DimpleRecord {
    /// Smallest contact force, N.
    pub min_force_n: f64,
    /// Total time open, s.
    pub open_s: f64,
}

/// Energy book of the structure at the end of the window, J.
///
/// H = 1/2 int rho h (w_t^2 - Omega^2 w_theta^2) + V of disk and ramp; see docs/theory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBook {
    /// Material kinetic energy of disk and ramp at the end.
    pub kinetic_j: f64,
    /// Elastic energy at the end.
    pub elastic_j: f64,
    /// H at the end.
    pub h_end_j: f64,
    /// Largest H.
    pub h_peak_j: f64,
    /// Work of the shock.
    pub shock_work_j: f64,
    /// Taken from H by damping (rotating frame; of either sign).
    pub damping_loss_j: f64,
    /// Taken from H at impacts (never negative).
    pub impact_loss_j: f64,
    /// Produced by the time stepping (never positive).
    pub algorithmic_j: f64,
    /// Work fed in by the spindle through the contact, on the material energy.
    pub spindle_work_j: f64,
    /// |H - H0 - work + losses| / peak.
    pub closure: f64,
}

/// How well 0 <= g complementary to lambda >= 0 was met.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complementarity {
    /// Largest penetration, m (>= 0).
    pub max_penetration_m: f64,
    /// Most negative multiplier (impulse), N s (<= 0).
    pub min_multiplier_n_s: f64,
    /// Largest |impulse x gap|, N s m.
    pub max_product_n_s_m: f64,
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

/// Columns on the structure's time grid.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(
    missing_docs,
    reason = "the names say quantity and unit; design reference section 7"
)]
pub struct StructureColumns {
    pub time_s: Vec<f64>,
    pub shock_m_per_s2: Vec<f64>,
    pub disk_slider_m: Vec<f64>,
    pub disk_ramp_m: Vec<f64>,
    pub disk_rim_m: Vec<f64>,
    pub disk_pitch_rad: Vec<f64>,
    pub disk_roll_rad: Vec<f64>,
    pub ramp_top_m: Vec<f64>,
    pub ramp_bottom_m: Vec<f64>,
    /// 20 us running mean of the contact force.
    pub contact_top_n: Vec<f64>,
    /// 20 us running mean of the contact force.
    pub contact_bottom_n: Vec<f64>,
    pub energy_j: Vec<f64>,
    pub energy_h_j: Vec<f64>,
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
