//! Physical constants, and the only conversions from engineers' units into SI.

/// Standard gravity, m/s2 (CGPM 1901).
pub const STANDARD_GRAVITY_M_PER_S2: f64 = 9.80665;

/// Force of one gram at standard gravity, N.
pub const GRAM_FORCE_N: f64 = 9.80665e-3;

/// Permittivity of the vacuum ε₀, F/m (CODATA 2018).
pub const VACUUM_PERMITTIVITY_F_PER_M: f64 = 8.854_187_812_8e-12;

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

/// rad from microradians.
pub fn rad_from_urad(urad: f64) -> f64 {
    urad / 1e6
}

/// s from milliseconds. Decimal units divide by an exact power of ten, so that a decimal value
/// becomes the double nearest to it.
pub fn s_from_ms(ms: f64) -> f64 {
    ms / 1e3
}

/// s from microseconds.
pub fn s_from_us(us: f64) -> f64 {
    us / 1e6
}

/// m from millimetres.
pub fn m_from_mm(mm: f64) -> f64 {
    mm / 1e3
}

/// m from micrometres.
pub fn m_from_um(um: f64) -> f64 {
    um / 1e6
}

/// m from nanometres.
pub fn m_from_nm(nm: f64) -> f64 {
    nm / 1e9
}

/// kg from milligrams.
pub fn kg_from_mg(mg: f64) -> f64 {
    mg / 1e6
}

/// kg m² from mg mm².
pub fn kg_m2_from_mg_mm2(mg_mm2: f64) -> f64 {
    mg_mm2 / 1e12
}

/// N from grams of force.
pub fn n_from_gf(gf: f64) -> f64 {
    gf * GRAM_FORCE_N
}

/// Hz from kilohertz.
pub fn hz_from_khz(khz: f64) -> f64 {
    khz * 1e3
}

/// 1/µm² to 1/m².
#[inline]
pub fn per_m2_from_per_um2(per_um2: f64) -> f64 {
    per_um2 * 1e12
}

/// Pa from gigapascals.
pub fn pa_from_gpa(gpa: f64) -> f64 {
    gpa * 1e9
}

/// K from degrees Celsius.
pub fn k_from_c(celsius: f64) -> f64 {
    celsius + 273.15
}

/// Share of one from per cent.
pub fn share_from_pct(pct: f64) -> f64 {
    pct / 100.0
}
