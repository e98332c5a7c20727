//! Contact of a nominal area: many asperities whose heights have a normal distribution.
//!
//! ```text
//! p(h) = η ∫_h^∞ P(s − h) φ(s/σ)/σ ds                 where the surfaces were never closer
//! p(h; d) = η ∫_d^∞ P(s − h; ω* = s − d) φ(s/σ)/σ ds   after the smallest distance d <= h
//! p_n(h; d) = p(h; d) S(p(d))/p(d),   S(p) = p_y tanh(p/p_y)
//! ```
//!
//! P is the law of one asperity ([`super::asperity`]). An asperity of height s was pressed in by s − d at most, so that the
//! smallest distance of a place is all that it remembers. Without yielding both are Greenwood and Williamson's
//! 4/3 η E′ √R σ^(3/2) F_(3/2)(h/σ).
//!
//! The pressure p_n of the nominal area is p as long as few asperities touch. Where they touch everywhere, slider and disk yield
//! as wholes, and their pressure stays below p_y: S is within 1 % of p up to p_y/6. That is a bound, not a law of bulk contact.
//!
//! Integrals run over τ = (s − d)/σ from τ*, the first asperity that still touches: τ* = u + r(τ*), with u = (h − d)/σ and
//! the interference r σ that is left without force. Gauss's rule acts on two parts, below and above the limit of
//! elasticity; each in the root of the distance from its lower end, in which the integrand is smooth. Where all asperities touch, and
//! all are on one side of that limit, it is smooth from tail to tail, and the trapezoidal rule with steps of σ errs by 2 exp(−2 π²),
//! 5e-9; in the slope of loading, whose terms cancel, by 2e-7.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | σ | `sigma_m`: standard deviation of the sum of both surfaces' heights | m |
//! | η | `per_m2`: asperities per area | 1/m² |
//! | R, E′, p_y | those of one asperity | m, Pa, Pa |
//!
//! Source: Greenwood and Williamson, Proc. R. Soc. A 295 (1966) 300. Neglected: asperities deform independently, also
//! where so many touch that they would be one body; heights are those of one surface against a smooth one (misalignment of tips).

use super::asperity::AsperityLaw;
use super::loading_table::LoadingTable;
use super::roughness::normal_density;

/// Points of Gauss's rule in each part.
const POINTS: usize = 32;

/// Heights beyond these many σ from the mean are left out: 1e-16 of all asperities.
const HIGHEST: f64 = 8.3;

/// Heights up to these many σ count where all touch: all but 2e-9.
const TAIL: i32 = 6;

/// Distances in σ between which loading pressures are tabulated.
const TABULATED: [f64; 2] = [-100.0, 8.25];

/// Contact of a nominal area.
#[derive(Clone, Debug)]
pub struct NominalContact {
    sigma_m: f64,
    per_m2: f64,
    law: AsperityLaw,
    /// p_y, Pa.
    most_pa: f64,
    /// Gauss's points and weights on [0, 1].
    rule: [(f64, f64); POINTS],
    /// Pressures where the surfaces were never closer.
    loading: LoadingTable,
}

/// What a nominal area bears.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Borne {
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Its derivative by the distance, Pa/m.
    pub slope_pa_per_m: f64,
}

/// What the asperities of all cells bear at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    /// Normal force, N.
    pub force_n: f64,
    /// Its moments, by pitch and roll, N m.
    pub moments_n_m: [f64; 2],
    /// Moments of friction, N m.
    pub friction_n_m: [f64; 2],
    /// Pressure, its mean over the force, Pa.
    pub mean_pressure_pa: f64,
    /// Largest pressure of a nominal area, Pa.
    pub peak_pressure_pa: f64,
    /// Smallest distance of the mean planes, m; infinite where nothing touches.
    pub closest_m: f64,
    /// Power of friction, W.
    pub friction_w: f64,
}

impl ContactState {
    /// Normal force and its moments, conjugate to (h_c, pitch, roll).
    pub fn normal_load(&self) -> [f64; 3] {
        let [pitch, roll] = self.moments_n_m;
        [self.force_n, pitch, roll]
    }

    /// The same of friction.
    pub fn friction_load(&self) -> [f64; 3] {
        let [pitch, roll] = self.friction_n_m;
        [0.0, pitch, roll]
    }
}

impl NominalContact {
    /// With the roughness `sigma_m` > 0 and `per_m2` asperities of `law`, which yield at `most_pa`.
    pub fn new(sigma_m: f64, per_m2: f64, law: AsperityLaw, most_pa: f64) -> Self {
        let mut contact = Self {
            sigma_m,
            per_m2,
            law,
            most_pa,
            rule: gauss_rule(),
            loading: LoadingTable::default(),
        };
        contact.loading = LoadingTable::new(TABULATED, |x| {
            let [pressure_pa, slope_pa_per_m, _] = contact.integral(x * sigma_m, x * sigma_m);
            [pressure_pa, slope_pa_per_m * sigma_m]
        });
        contact
    }

    /// Distance from which nothing touches, m.
    pub fn reach_m(&self) -> f64 {
        HIGHEST * self.sigma_m
    }

    /// Pressure and slope at the distance `h_m` of the mean planes, `closest_m` the smallest so far.
    pub fn at(&self, h_m: f64, closest_m: f64) -> Borne {
        let [deepest_pa, slope_pa_per_m] = self.first(closest_m.min(h_m));
        if deepest_pa <= 0.0 {
            return Borne::default();
        }
        let bound = (deepest_pa / self.most_pa).tanh();
        let bounded_pa = bound * self.most_pa;
        if closest_m >= h_m {
            return Borne {
                pressure_pa: bounded_pa,
                slope_pa_per_m: (1.0 - bound * bound) * slope_pa_per_m,
            };
        }
        let share = bounded_pa / deepest_pa;
        let highest_m = HIGHEST * self.sigma_m - closest_m;
        let [pressure_pa, slope_pa_per_m] = match highest_m <= self.law.limit_m {
            // No asperity has yielded.
            true => self.first(h_m),
            false => {
                let [pressure_pa, slope_pa_per_m, _] = self.integral(h_m, closest_m);
                [pressure_pa, slope_pa_per_m]
            }
        };
        Borne {
            pressure_pa: (share * pressure_pa).min(self.most_pa),
            slope_pa_per_m: share * slope_pa_per_m,
        }
    }

    /// Elastic energy at the distance `h_m` of the mean planes, `closest_m` the smallest so far, J/m2.
    pub fn elastic_j_per_m2(&self, h_m: f64, closest_m: f64) -> f64 {
        let closest_m = closest_m.min(h_m);
        let [deepest_pa, _] = self.first(closest_m);
        if deepest_pa <= 0.0 {
            return 0.0;
        }
        let share = (deepest_pa / self.most_pa).tanh() * self.most_pa / deepest_pa;
        share * self.integral(h_m, closest_m)[2]
    }

    /// p and its slope at a distance where the surfaces were never closer.
    fn first(&self, h_m: f64) -> [f64; 2] {
        let tabulated = self.loading.at(h_m / self.sigma_m);
        let tabulated = tabulated.map(|[pressure_pa, slope]| [pressure_pa, slope / self.sigma_m]);
        tabulated.unwrap_or_else(|| {
            let [pressure_pa, slope_pa_per_m, _] = self.integral(h_m, h_m);
            [pressure_pa, slope_pa_per_m]
        })
    }

    /// p in Pa, its slope in Pa/m and its energy in J/m2, by quadrature.
    fn integral(&self, h_m: f64, closest_m: f64) -> [f64; 3] {
        let (sigma, law) = (self.sigma_m, &self.law);
        let (d, u) = (closest_m / sigma, (h_m - closest_m) / sigma);
        let limit = law.limit_m / sigma;
        let is_loading = u == 0.0;
        // The part of the asperities that matters.
        let highest = HIGHEST - d;
        let lowest = (-HIGHEST - d).max(0.0);
        let first = self.first_touching(u).max(lowest);
        let [mut pressure, mut slope, mut energy] = [0.0; 3];
        let mut add = |tau: f64, weight: f64| {
            let deepest_m = sigma * tau;
            let after = law.unloading(deepest_m);
            let share = ((tau - u) * sigma - after.left_m) / (deepest_m - after.left_m);
            if share <= 0.0 {
                return;
            }
            let weight = weight * normal_density(d + tau);
            let root = share.sqrt();
            let force = weight * after.deepest_n * share * root;
            pressure += force;
            energy += 0.4 * force * share * (deepest_m - after.left_m);
            slope -= if is_loading {
                force * (d + tau) / sigma
            } else {
                1.5 * weight * after.deepest_n * root / (deepest_m - after.left_m)
            };
        };
        let tail = f64::from(TAIL);
        if first < -tail - d && !(-tail..=tail).contains(&(limit + d)) {
            for s in -TAIL..=TAIL {
                add(f64::from(s) - d, 1.0);
            }
        } else {
            let middle = limit.clamp(first, highest.max(first));
            for (begin, end) in [(first, middle), (middle, highest)] {
                if begin < end {
                    // In q with τ = begin + (end − begin) q², dτ = 2 (end − begin) q dq.
                    let length = end - begin;
                    for (q, weight) in self.rule {
                        add(q.mul_add(q * length, begin), 2.0 * length * q * weight);
                    }
                }
            }
        }
        [pressure, slope, energy].map(|sum| self.per_m2 * sum)
    }

    /// Work of bringing the surfaces to `h_m` for the first time, J/m2.
    pub fn work_j_per_m2(&self, h_m: f64) -> f64 {
        // Pieces of a few σ, of which the first one ends where nothing touches.
        let length_m = (self.reach_m() - h_m).max(0.0);
        let pieces = (length_m / (2.0 * self.sigma_m)).ceil().max(1.0);
        let piece_m = length_m / pieces;
        let pressures = (0..pieces as usize).flat_map(|piece| {
            self.rule.map(|(q, weight)| {
                let at_m = h_m + piece_m * (piece as f64 + q);
                weight * piece_m * self.at(at_m, at_m).pressure_pa
            })
        });
        pressures.sum()
    }

    /// τ*: the lowest asperity that touches after the surfaces were drawn apart by `u` σ.
    fn first_touching(&self, u: f64) -> f64 {
        let limit = self.law.limit_m / self.sigma_m;
        if u <= limit {
            return u;
        }
        // What an asperity recovers, τ − r(τ), rises with τ; in units of the limit (3 t/2 − 1/2)/√t = u/limit with
        // t = τ/limit, of which √t is the root of a parabola.
        let recovered = u / limit;
        let root = (recovered + recovered.mul_add(recovered, 3.0).sqrt()) / 3.0;
        root * root * limit
    }
}

/// Points and weights of Gauss's rule on [0, 1]: the roots of Legendre's polynomial by Newton's method.
fn gauss_rule() -> [(f64, f64); POINTS] {
    std::array::from_fn(|k| {
        let n = POINTS as f64;
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for order in 2..=POINTS {
                let order = order as f64;
                let next = ((2.0 * order - 1.0) * x * value - (order - 1.0) * before) / order;
                (before, value) = (value, next);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGMA_M: f64 = 0.5e-9;
    const RADIUS_M: f64 = 2e-6;
    const MODULUS_PA: f64 = 1e11;
    const PER_M2: f64 = 5e13;

    fn contact(yield_pa: f64) -> NominalContact {
        let law = AsperityLaw::new(RADIUS_M, MODULUS_PA, yield_pa);
        NominalContact::new(SIGMA_M, PER_M2, law, yield_pa)
    }

    /// Loading pressures are those of hard case G8.
    #[test]
    fn where_nothing_yields_nothing_is_remembered() {
        let contact = contact(1e15);
        for x in [-6.0, -2.37, 0.0, 0.7, 2.5, 4.0] {
            let [first, after] = [f64::INFINITY, (x - 1.5) * SIGMA_M]
                .map(|closest_m| contact.at(x * SIGMA_M, closest_m).pressure_pa);
            assert!((after / first - 1.0).abs() < 1e-8, "{x}");
        }
    }

    #[test]
    fn slopes_and_energies_belong_to_the_pressure() {
        for yield_pa in [1e9, 4e9, 1e15] {
            let contact = contact(yield_pa);
            for closest in [f64::INFINITY, -140.0, -30.0, -16.0, -7.0, -2.0, 0.5] {
                for x in [-120.0, -25.0, -5.9, -1.0, 0.7, 1.6, 3.0] {
                    let at = |x: f64| contact.at(x * SIGMA_M, closest * SIGMA_M);
                    let step = 1e-4;
                    let (below, above, here) = (at(x - step), at(x + step), at(x));
                    let scale = at(x - 0.5).pressure_pa.max(1.0);
                    let slope = (above.pressure_pa - below.pressure_pa) / (2.0 * step * SIGMA_M);
                    let error = (slope - here.slope_pa_per_m) * SIGMA_M / scale;
                    assert!(error.abs() < 1e-6, "{yield_pa} {closest} {x}: {error:e}");
                    if x > closest {
                        let energy =
                            |x: f64| contact.elastic_j_per_m2(x * SIGMA_M, closest * SIGMA_M);
                        let fall = energy(x - step) - energy(x + step);
                        let error = fall / (2.0 * step * SIGMA_M) - here.pressure_pa;
                        assert!(
                            error.abs() < 1e-6 * scale,
                            "{yield_pa} {closest} {x}: {error:e}"
                        );
                    }
                }
            }
            let step = 1e-4;
            for x in [-1.0, 0.7, 3.0] {
                let [below, above] =
                    [x - step, x + step].map(|x| contact.work_j_per_m2(x * SIGMA_M));
                let pressure = contact.at(x * SIGMA_M, f64::INFINITY).pressure_pa;
                let error = (below - above) / (2.0 * step * SIGMA_M) / pressure - 1.0;
                assert!(error.abs() < 1e-6, "{yield_pa} {x}: {error:e}");
            }
        }
    }

    #[test]
    fn the_rules_of_quadrature_agree_where_one_follows_the_other() {
        for yield_pa in [1e9, 4e9, 1e15] {
            let contact = contact(yield_pa);
            for closest in [-200.0, -20.0, -16.0, -14.0, -7.0] {
                let [below, above] = [-1e-9, 1e-9].map(|by: f64| {
                    let at = (-f64::from(TAIL) + by) * SIGMA_M;
                    contact.integral(at, closest * SIGMA_M)
                });
                for (below, above) in below.into_iter().zip(above) {
                    let jump = (above - below).abs();
                    assert!(jump <= 3e-8 * below.abs(), "{yield_pa} {closest}: {jump:e}");
                }
            }
        }
    }

    #[test]
    fn surfaces_give_back_less_than_they_took_where_they_yield() {
        for (yield_pa, most) in [(1e9, 0.8), (4e9, 1.0 - 1e-4), (1e15, 1.0 + 1e-9)] {
            let contact = contact(yield_pa);
            let closest_m = -SIGMA_M;
            let returned = contact.elastic_j_per_m2(closest_m, closest_m);
            let share = returned / contact.work_j_per_m2(closest_m);
            assert!((0.1..=most).contains(&share), "{yield_pa}: {share}");
            // Pressed again to where they were, they bear what they bore.
            let [first, again] = [f64::INFINITY, closest_m]
                .map(|closest_m| contact.at(-SIGMA_M, closest_m).pressure_pa);
            assert!((first / again - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn pressure_stays_below_that_of_yielding() {
        let contact = contact(4e9);
        let deep = contact.at(-400.0 * SIGMA_M, f64::INFINITY);
        assert!((deep.pressure_pa / 4e9 - 1.0).abs() < 1e-6, "{deep:?}");
        let again = contact.at(-390.0 * SIGMA_M, -400.0 * SIGMA_M);
        assert!(again.pressure_pa < deep.pressure_pa && again.slope_pa_per_m < 0.0);
    }

    #[test]
    fn deep_overlap_bears_what_the_mean_asperity_bears() {
        // At −40 σ all asperities are pressed in by 40 ± 1 σ; the law's curvature adds (3/8)/40² of it.
        let contact = contact(1e15);
        let borne = contact.at(-40.0 * SIGMA_M, f64::INFINITY);
        let law = AsperityLaw::new(RADIUS_M, MODULUS_PA, 1e15);
        let mean = PER_M2 * law.force(40.0 * SIGMA_M) * (1.0 + 0.375 / 1600.0);
        assert!((borne.pressure_pa / mean - 1.0).abs() < 1e-6);
    }
}
