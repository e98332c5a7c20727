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

/// F_(3/2) with an exponential through the normal density at 1 and 3 σ, for which it has a closed form:
/// c Γ(5/2) λ^(−5/2) exp(−λ x).
pub fn exponential_heights(x: f64) -> f64 {
    let rate = 0.5 * (normal_density(1.0) / normal_density(3.0)).ln();
    let factor = normal_density(1.0) * rate.exp();
    factor * 1.329_340_388_179_137 * rate.powf(-2.5) * (-rate * x).exp()
}

/// Pressure of a nominal area by Gauss's rule of three points in 32 parts of the heights that touch, whatever the law does between.
pub fn pressure_across_the_limit(per_m2: f64, law: &AsperityLaw, sigma_m: f64, h_m: f64) -> f64 {
    const PARTS: u32 = 32;
    let highest = 8.3;
    let lowest = (h_m / sigma_m).max(-highest);
    let part = (highest - lowest) / f64::from(PARTS);
    let mut sum = 0.0;
    for k in 0..PARTS {
        let middle = lowest + (f64::from(k) + 0.5) * part;
        for (place, weight) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let s = middle + 0.5 * part * place;
            sum += weight / 18.0 * part * normal_density(s) * law.force(s * sigma_m - h_m);
        }
    }
    per_m2 * sum
}

/// Mean gap summed over heights in steps of 0.1 nm, which roughness may be smaller than.
pub fn mean_gap_in_steps(h_m: f64, sigma_m: f64) -> f64 {
    let step_m = 0.1e-9;
    let heights = (-200..=200).map(|k| f64::from(k) * step_m);
    let gaps = heights.map(|s| (h_m + s).max(0.0) * normal_density(s / sigma_m) / sigma_m * step_m);
    gaps.sum()
}
