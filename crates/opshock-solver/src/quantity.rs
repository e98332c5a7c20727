//! Constants and the only conversions from engineers' units into SI.

/// Standard gravity, m/s2 (CGPM 1901).
pub const STANDARD_GRAVITY_M_PER_S2: f64 = 9.80665;

/// Force of one gram at standard gravity, N.
pub const GRAM_FORCE_N: f64 = 9.80665e-3;

/// rad/s from revolutions per minute.
pub fn rad_per_s_from_rpm(rpm: f64) -> f64 {
    rpm * (std::f64::consts::TAU / 60.0)
}

/// rad from degrees.
pub fn rad_from_deg(deg: f64) -> f64 {
    deg.to_radians()
}

/// m/s2 from multiples of standard gravity.
pub fn m_per_s2_from_g(g: f64) -> f64 {
    g * STANDARD_GRAVITY_M_PER_S2
}
