//! Records of a structural run: extremes, contacts, energy and momentum balances. Times are seconds after the onset.

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

/// A contact episode; episodes closer than 30 us are one.
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
    /// Episodes in order.
    pub episodes: Vec<Episode>,
}

/// Energy balance of the structure at the end of the window, J.
///
/// H = ½ ∫ ρ h (w_t² − Ω² w_θ²) + V of disk and ramp; see the theory of [`crate::structure`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
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
    /// Energy that damping takes from H (rotating frame; of either sign).
    pub damping_loss_j: f64,
    /// Energy that impacts take from H (never negative).
    pub impact_loss_j: f64,
    /// Energy produced by the time stepping (never positive).
    pub algorithmic_j: f64,
    /// Work of the spindle through the contact, on the material energy.
    pub spindle_work_j: f64,
    /// |H - H0 - work + losses| / peak.
    pub closure: f64,
}

/// Momentum of a body along its axis against the impulses on it, N s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MomentumBalance {
    /// Impulse of the shock.
    pub shock_n_s: f64,
    /// Impulse of its supports, springs and dampers.
    pub support_n_s: f64,
    /// Impulse of the contact between disk and ramp.
    pub contact_n_s: f64,
    /// Momentum at the end.
    pub end_n_s: f64,
    /// |momentum at the end - impulses| / largest momentum.
    pub closure: f64,
}

/// The hub of a disk on a bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HubRecord {
    /// Largest axial displacement over the bearing, m.
    pub axial_max_m: f64,
    /// Largest tilt, rad.
    pub tilt_max_rad: f64,
    /// Axial momentum of hub and disk; their supports are the bearing and damping fixed in space.
    pub momentum: MomentumBalance,
}

/// The base, when it vibrates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BaseRecord {
    /// Largest displacement of the spindle over the rigid base, m.
    pub spindle_max_m: f64,
    /// That of the ramp's mount, m.
    pub ramp_max_m: f64,
    /// That of the actuator's pivot, m.
    pub pivot_max_m: f64,
    /// Momentum of the base and all it carries, its modes weighted by their participations. For one mode with equal
    /// shapes and participation times shape of 1 it is the momentum of the drive on its mounts.
    pub momentum: MomentumBalance,
}

/// How well 0 <= g complementary to lambda >= 0 was satisfied.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complementarity {
    /// Largest penetration, m (>= 0).
    pub max_penetration_m: f64,
    /// Most negative multiplier (impulse), N s (<= 0).
    pub min_multiplier_n_s: f64,
    /// Largest |impulse x gap|, N s m.
    pub max_product_n_s_m: f64,
}

/// Columns on the structure's time grid.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(missing_docs, reason = "the names say quantity and unit")]
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
    /// Axial displacement of the hub of a disk on a bearing, relative to the base; else empty.
    pub hub_axial_m: Vec<f64>,
    /// Its tilt that lifts the disk at the ramp's angle.
    pub hub_tilt_ramp_rad: Vec<f64>,
    /// Its tilt that lifts the disk a quarter turn on from the ramp, with the spin.
    pub hub_tilt_across_rad: Vec<f64>,
    /// Displacement of the spindle with a base that vibrates, relative to the rigid one; else empty.
    pub base_spindle_m: Vec<f64>,
    /// That of the ramp's mount.
    pub base_ramp_m: Vec<f64>,
    /// That of the actuator's pivot.
    pub base_pivot_m: Vec<f64>,
}
