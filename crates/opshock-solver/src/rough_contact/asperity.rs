//! Force on one spherical asperity, elastic up to a limit and plastic beyond, with elastic unloading.
//!
//! ```text
//! loading      P(ω) = 4/3 E′ √R ω^(3/2)                       ω ≤ ω_c
//!              P(ω) = P(ω_c) + π R p_y (ω − ω_c)               ω > ω_c
//! limit        ω_c = R (π p_y/(2 E′))²
//! from ω*      P(ω) = P(ω*) ((ω − ω_p)/(ω* − ω_p))^(3/2)       ω_p ≤ ω ≤ ω*
//!              ω_p = ω* − (3 P(ω*)/(4 E′ √R_p))^(2/3),   R_p P(ω*) = R 4/3 E′ √R ω*^(3/2)
//! ```
//!
//! An asperity that was pressed in by ω* beyond ω_c is left with a larger radius R_p and shorter by ω_p. It then follows
//! its unloading curve back and forth, and yields again beyond ω*. Force and slope are continuous at ω_c.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | ω | interference: how far the asperity is pressed in | m |
//! | R | radius of its tip | m |
//! | E′ | 1/E′ = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ | Pa |
//! | p_y | largest contact pressure, at which it yields | Pa |
//!
//! Source: Hertz's law (Johnson, Contact Mechanics (1985), ch. 4); beyond it Thornton, J. Appl. Mech. 64 (1997) 383.
//! ω_c is the critical interference of Chang, Etsion and Bogy, J. Tribology 109 (1987) 257, with p_y for their K H; their
//! own force beyond ω_c jumps there and is single-valued, so that it would dissipate nothing.

use std::f64::consts::PI;

/// An asperity's law, in units of its limit: ω_c for lengths, P(ω_c) for forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AsperityLaw {
    /// ω_c, m.
    pub limit_m: f64,
    /// P(ω_c) = 2/3 π R p_y ω_c, N.
    pub limit_n: f64,
}

/// One asperity after its deepest interference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unloading {
    /// Force at the deepest interference, N.
    pub deepest_n: f64,
    /// Interference left without force ω_p, m.
    pub left_m: f64,
}

impl AsperityLaw {
    /// Of a tip of radius `radius_m`, E′ `modulus_pa` and p_y `yield_pa`.
    pub fn new(radius_m: f64, modulus_pa: f64, yield_pa: f64) -> Self {
        let share = 0.5 * PI * yield_pa / modulus_pa;
        let limit_m = radius_m * share * share;
        Self {
            limit_m,
            limit_n: 2.0 / 3.0 * PI * radius_m * yield_pa * limit_m,
        }
    }

    /// Force of loading, N, at the interference `depth_m` >= 0.
    #[inline]
    pub fn force(&self, depth_m: f64) -> f64 {
        let depth = depth_m / self.limit_m;
        self.limit_n
            * if depth <= 1.0 {
                depth * depth.sqrt()
            } else {
                1.5 * depth - 0.5
            }
    }

    /// What the asperity does after `deepest_m`.
    #[inline]
    pub fn unloading(&self, deepest_m: f64) -> Unloading {
        let depth = deepest_m / self.limit_m;
        let deepest_n = self.force(deepest_m);
        if depth <= 1.0 {
            return Unloading {
                deepest_n,
                left_m: 0.0,
            };
        }
        // R_p/R = Hertz's force ω*^(3/2) over this one; ω* − ω_p = (P²/(R_p/R))^(1/3) = P/√ω*, in units of the limit.
        let recovered = (1.5 * depth - 0.5) / depth.sqrt();
        Unloading {
            deepest_n,
            left_m: self.limit_m * (depth - recovered),
        }
    }
}

impl Unloading {
    /// Force at `depth_m`, N, after `deepest_m`.
    #[inline]
    pub fn force(&self, depth_m: f64, deepest_m: f64) -> f64 {
        let share = ((depth_m - self.left_m) / (deepest_m - self.left_m)).max(0.0);
        self.deepest_n * share * share.sqrt()
    }

    /// Elastic energy at `depth_m`, J.
    #[inline]
    pub fn energy(&self, depth_m: f64, deepest_m: f64) -> f64 {
        let recovered_m = deepest_m - self.left_m;
        let share = ((depth_m - self.left_m) / recovered_m).max(0.0);
        0.4 * self.deepest_n * recovered_m * share * share * share.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E′ = 100 GPa, R = 2 um, p_y = 10 GPa.
    fn law() -> AsperityLaw {
        AsperityLaw::new(2e-6, 1e11, 1e10)
    }

    /// Work of loading up to `depth_m`, J: 2/5 P ω up to the limit, then the integral of a straight line.
    fn work(law: &AsperityLaw, depth_m: f64) -> f64 {
        let depth = depth_m / law.limit_m;
        law.limit_n
            * law.limit_m
            * if depth <= 1.0 {
                0.4 * depth * depth * depth.sqrt()
            } else {
                0.75 * depth * depth - 0.5 * depth + 0.15
            }
    }

    #[test]
    fn elastic_force_is_hertzs_and_goes_on_smoothly() {
        let law = law();
        let depth_m = 0.5 * law.limit_m;
        let hertz = 4.0 / 3.0 * 1e11 * 2e-6_f64.sqrt() * depth_m.powf(1.5);
        assert!((law.force(depth_m) / hertz - 1.0).abs() < 1e-14);
        // Contact pressure at the limit: 3/2 of the mean over a circle of the area π R ω is p_y.
        let peak = 1.5 * law.limit_n / (PI * 2e-6 * law.limit_m);
        assert!((peak / 1e10 - 1.0).abs() < 1e-14);
        let slope = |depth: f64| {
            let step = 1e-6 * law.limit_m;
            let at = |offset: f64| law.force(depth * law.limit_m + offset);
            (at(step) - at(-step)) / (2.0 * step)
        };
        assert!((slope(1.0 - 2e-6) / slope(1.0 + 2e-6) - 1.0).abs() < 3e-6);
        assert!((slope(2.0) / (PI * 2e-6 * 1e10) - 1.0).abs() < 1e-6);
    }

    /// Restitution e of a sphere that strikes at v times the speed of first yield, as published (Thornton 1997, equation
    /// 30): e² = (6 √3/5) (1 − 1/(6 v²)) (1/v / (1/v + 2 √(6/5 − 1/(5 v²))))^(1/2).
    fn published_restitution(v: f64) -> f64 {
        let inverse = 1.0 / v;
        let square = inverse * inverse;
        let ratio = inverse / (inverse + 2.0 * (1.2 - 0.2 * square).sqrt());
        (6.0 * 3.0_f64.sqrt() / 5.0 * (1.0 - square / 6.0) * ratio.sqrt()).sqrt()
    }

    #[test]
    fn restitution_is_the_published_one() {
        let law = law();
        for v in [0.3_f64, 1.0, 1.5, 3.0, 10.0, 100.0] {
            // The kinetic energy is the work of loading: solved for the depth.
            let energy = v * v * work(&law, law.limit_m);
            let (mut low, mut high) = (0.0, 1e4 * law.limit_m);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if work(&law, middle) < energy {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let returned = law.unloading(high).energy(high, high);
            let restitution = (returned / energy).sqrt();
            let expected = if v <= 1.0 {
                1.0
            } else {
                published_restitution(v)
            };
            assert!(
                (restitution / expected - 1.0).abs() < 1e-12,
                "{v}: {restitution}, published {expected}"
            );
        }
    }

    #[test]
    fn work_and_energy_are_the_integrals_of_the_forces() {
        let law = law();
        let deepest_m = 7.0 * law.limit_m;
        let unloading = law.unloading(deepest_m);
        let n = 20_000;
        let [mut loaded, mut returned] = [0.0; 2];
        for k in 0..n {
            let depth_m = (k as f64 + 0.5) / n as f64 * deepest_m;
            loaded += law.force(depth_m) * deepest_m / n as f64;
            returned += unloading.force(depth_m, deepest_m) * deepest_m / n as f64;
        }
        assert!((loaded / work(&law, deepest_m) - 1.0).abs() < 1e-6);
        assert!((returned / unloading.energy(deepest_m, deepest_m) - 1.0).abs() < 1e-6);
        assert!(returned < loaded);
    }
}
