//! Naive methods for contact of rough surfaces.

use opshock_solver::air_bearing::Attitude;
use opshock_solver::rough_contact::asperity::AsperityLaw;
use opshock_solver::rough_contact::nominal::NominalContact;
use opshock_solver::rough_contact::roughness::normal_density;

/// Force on the rectangle `x_m` by `y_m` of a plane slider by its pressures at the middles of 100 x 100 parts.
pub fn force_at_middles(
    nominal: &NominalContact,
    at: &Attitude,
    [x_m, y_m]: [[f64; 2]; 2],
    centre_m: [f64; 2],
) -> f64 {
    const PARTS: u32 = 100;
    let sides = [x_m, y_m].map(|[from, to]| (to - from) / f64::from(PARTS));
    let middle = |from: f64, k: u32, side: f64| from + (f64::from(k) + 0.5) * side;
    let mut force = 0.0;
    for i in 0..PARTS {
        for j in 0..PARTS {
            let x = middle(x_m[0], i, sides[0]) - centre_m[0];
            let y = middle(y_m[0], j, sides[1]) - centre_m[1];
            let h = at.centre_height_m - at.pitch_rad * x + at.roll_rad * y;
            force += sides[0] * sides[1] * nominal.at(h, f64::INFINITY).pressure_pa;
        }
    }
    force
}

/// F_(3/2) of asperities whose heights fall off exponentially, as Greenwood and Williamson (1966) put it for large distances:
/// Γ(5/2) exp(−x)/√(2 π), with the normal density's height at 0.
pub fn exponential_heights(x: f64) -> f64 {
    1.329_340_388_179_137 * (-x).exp() / std::f64::consts::TAU.sqrt()
}

/// Pressure of a nominal area with asperities in steps of σ, whatever their law does between.
pub fn pressure_by_trapezia(per_m2: f64, law: &AsperityLaw, sigma_m: f64, h_m: f64) -> f64 {
    let heights = (-8..=8).map(f64::from);
    let pressed = heights.map(|s| normal_density(s) * law.force((s * sigma_m - h_m).max(0.0)));
    per_m2 * pressed.sum::<f64>()
}

/// The largest part of the mean gap's formula where the planes meet, with h divided by σ.
pub fn density_of_roughness(h_m: f64, sigma_m: f64) -> f64 {
    sigma_m * normal_density(h_m / sigma_m)
}

/// Energy after over energy before of a mass that meets an area of stiff asperities, by explicit Euler with `step_s`: a mass of
/// 1.6 mg at 5 mm/s on 1 mm2.
pub fn explicit_bounce(nominal: &NominalContact, step_s: f64) -> f64 {
    let (mass_kg, area_m2) = (1.6e-6, 1e-8);
    let (mut h, mut v) = (nominal.reach_m(), -5e-3_f64);
    while v <= 0.0 || h < nominal.reach_m() {
        let force = area_m2 * nominal.at(h, f64::INFINITY).pressure_pa;
        (h, v) = (h + step_s * v, v + step_s * force / mass_kg);
    }
    (v / 5e-3).powi(2)
}
