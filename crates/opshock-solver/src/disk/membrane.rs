//! Computes the in-plane stress of a spinning annular disk, clamped inside, free outside.
//!
//! ```text
//! d(r σr)/dr − σθ + ρ Ω² r² = 0,   u(r_i) = 0,   σr(r_o) = 0
//! u  = c₁ r + c₂/r − (1 − ν²) ρ Ω² r³ / (8 E)
//! σr = E/(1 − ν²) (u′ + ν u/r),   σθ = E/(1 − ν²) (u/r + ν u′)
//! ```
//!
//! Plane stress, linear elastic, uniform thickness; the hoop and radial stress rotate with the disk and are steady in
//! it. Source: Timoshenko and Goodier, Theory of Elasticity (1970), art. 32, with the inner edge clamped instead of
//! free.

use super::parameters::DiskParameters;

/// Steady membrane stress as a function of the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneStress {
    modulus_pa: f64,
    poisson: f64,
    c1: f64,
    c2_m2: f64,
    c3_per_m2: f64,
}

impl MembraneStress {
    /// Stress at the disk's speed.
    pub fn new(disk: &DiskParameters) -> Self {
        let nu = disk.poisson;
        let c3 = (1.0 - nu * nu) * disk.density_kg_per_m3 * disk.spin_rad_per_s.powi(2)
            / (8.0 * disk.youngs_modulus_pa);
        let (a2, b2) = (disk.inner_radius_m.powi(2), disk.outer_radius_m.powi(2));
        // u(a) = 0:  c1 a² + c2 = c3 a⁴.   σr(b) = 0:  (1 + ν) c1 − (1 − ν) c2/b² = (3 + ν) c3 b².
        let c1 = c3 * ((3.0 + nu) * b2 + (1.0 - nu) * a2 * a2 / b2)
            / ((1.0 + nu) + (1.0 - nu) * a2 / b2);
        Self {
            modulus_pa: disk.youngs_modulus_pa / (1.0 - nu * nu),
            poisson: nu,
            c1,
            c2_m2: c3 * a2 * a2 - c1 * a2,
            c3_per_m2: c3,
        }
    }

    /// (σr, σθ) at radius `r_m`, Pa.
    pub fn at(&self, r_m: f64) -> (f64, f64) {
        let r2 = r_m * r_m;
        let over_r = self.c1 + self.c2_m2 / r2 - self.c3_per_m2 * r2;
        let slope = self.c1 - self.c2_m2 / r2 - 3.0 * self.c3_per_m2 * r2;
        (
            self.modulus_pa * (slope + self.poisson * over_r),
            self.modulus_pa * (over_r + self.poisson * slope),
        )
    }
}
