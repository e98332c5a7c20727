//! Models the hub on a fluid-dynamic bearing that carries the disk's clamp, where the clamp is not part of the base.
//!
//! A rigid rotor (hub, clamp, spacers, further disks) that may move along the axis, u, and tilt, ϑ.
//! The tilt is one complex number in the space-fixed frame: it moves the disk by w = r Re(ϑ e^{iθ}),
//! as a harmonic n = 1 does. In the frame of the base, spin Ω:
//!
//! ```text
//! m ü + c_a u̇ + k_a u = F
//! I ϑ̈ + (i I_p Ω + c_t + i c_x) ϑ̇ + (k_t + i k_x) ϑ = M
//! ```
//!
//! i I_p Ω ϑ̇ is the gyroscopic moment of the spin. The bearing is isotropic: its matrices for the two tilts are [[k_t,
//! k_x], [−k_x, k_t]] and likewise for damping. k_x > 0 drives the forward whirl, as the rotating film of a journal
//! bearing does; c_t must outweigh it.
//!
//! The rigid rotor whirls at the roots of I λ² − I_p Ω λ − k_t = 0 (c = k_x = 0): forward
//! λ = (I_p Ω + √(I_p² Ω² + 4 I k_t)) / 2I, backward (√(…) − I_p Ω) / 2I.
//!
//! Sources: Genta, Dynamics of Rotating Systems (2005), ch. 2 (complex coordinates of a rigid rotor);
//! Jintanawan, Shen and Tanaka, Vibration analysis of fluid dynamic bearing spindles with rotating-shaft
//! design, IEEE Trans. Magn. 37 (2001) (bearing matrices of a drive's spindle).

use super::error::DiskError;

/// Hub with its bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct HubParameters {
    /// Mass that moves with the hub, without the free part of the disk simulated, kg.
    pub mass_kg: f64,
    /// Moment of inertia about a diameter at the bearing's centre, without that disk, kg m².
    pub transverse_inertia_kg_m2: f64,
    /// Moment of inertia about the axis of spin, without that disk, kg m².
    pub polar_inertia_kg_m2: f64,
    /// k_a: axial stiffness of the bearing, N/m.
    pub axial_stiffness_n_per_m: f64,
    /// c_a: axial damping, N s/m.
    pub axial_damping_n_s_per_m: f64,
    /// k_t: stiffness against tilt, N m/rad.
    pub tilt_stiffness_n_m_per_rad: f64,
    /// c_t: damping of tilt, N m s/rad.
    pub tilt_damping_n_m_s_per_rad: f64,
    /// k_x: moment across a tilt, N m/rad, positive where it drives the forward whirl.
    pub cross_stiffness_n_m_per_rad: f64,
    /// c_x: moment across the velocity of a tilt, N m s/rad, positive as the gyroscopic one.
    pub cross_damping_n_m_s_per_rad: f64,
    /// Height of the centre of mass of rotor and disk above the centre of tilt, m, towards the slider:
    /// the arm of a shock in the plane of the disk.
    pub centre_height_m: f64,
}

impl HubParameters {
    /// Checks ranges.
    ///
    /// # Errors
    /// The first fault found.
    pub fn validate(&self) -> Result<(), DiskError> {
        let (positive, not_negative) = ("finite and above 0", "finite and at least 0");
        let at_least_0 = |x: f64| x >= 0.0;
        let above_0 = |x: f64| x > 0.0;
        for (name, value, ok, allowed) in [
            (
                "hub.mass_kg",
                self.mass_kg,
                at_least_0(self.mass_kg),
                not_negative,
            ),
            (
                "hub.transverse_inertia_kg_m2",
                self.transverse_inertia_kg_m2,
                at_least_0(self.transverse_inertia_kg_m2),
                not_negative,
            ),
            (
                "hub.polar_inertia_kg_m2",
                self.polar_inertia_kg_m2,
                // For no body is it larger than twice the other one.
                (0.0..=2.0 * self.transverse_inertia_kg_m2).contains(&self.polar_inertia_kg_m2),
                "0 to twice the transverse inertia",
            ),
            (
                "hub.axial_stiffness_n_per_m",
                self.axial_stiffness_n_per_m,
                above_0(self.axial_stiffness_n_per_m),
                positive,
            ),
            (
                "hub.axial_damping_n_s_per_m",
                self.axial_damping_n_s_per_m,
                at_least_0(self.axial_damping_n_s_per_m),
                not_negative,
            ),
            (
                "hub.tilt_stiffness_n_m_per_rad",
                self.tilt_stiffness_n_m_per_rad,
                above_0(self.tilt_stiffness_n_m_per_rad),
                positive,
            ),
            (
                "hub.tilt_damping_n_m_s_per_rad",
                self.tilt_damping_n_m_s_per_rad,
                at_least_0(self.tilt_damping_n_m_s_per_rad),
                not_negative,
            ),
            (
                "hub.cross_stiffness_n_m_per_rad",
                self.cross_stiffness_n_m_per_rad,
                true,
                "finite",
            ),
            (
                "hub.cross_damping_n_m_s_per_rad",
                self.cross_damping_n_m_s_per_rad,
                true,
                "finite",
            ),
            ("hub.centre_height_m", self.centre_height_m, true, "finite"),
        ] {
            if !ok || !value.is_finite() {
                return Err(DiskError::Parameter {
                    name,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }
}
