//! Load/unload ramp: none, rigid, or deformable arms given as modes.

/// One mode of a ramp arm, scaled to shape 1 at the contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass, kg.
    pub mass_kg: f64,
    /// Base participation: inertia load = mass x participation x a(t).
    pub participation: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// Which ramp model stands at the rim.
#[derive(Clone, Debug, PartialEq)]
pub enum RampModel {
    /// No ramp.
    None,
    /// Contact points fixed to the base.
    Rigid,
    /// Contact points on flexible arms; top and bottom are separate.
    Deformable {
        /// Modes of the top arm.
        top: Vec<ArmMode>,
        /// Modes of the bottom arm.
        bottom: Vec<ArmMode>,
    },
}

/// The ramp and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct RampParameters {
    /// Model.
    pub model: RampModel,
    /// Static clearance between disk and top arm, m.
    pub clearance_top_m: f64,
    /// Static clearance between disk and bottom arm, m.
    pub clearance_bottom_m: f64,
    /// Radius of the contact points, m.
    pub radius_m: f64,
    /// Angle of the contact points in the disk's sense of rotation, rad.
    pub angle_rad: f64,
    /// Coefficient of restitution of an impact, 0 <= e <= 1 (Newton's law).
    pub restitution: f64,
}
