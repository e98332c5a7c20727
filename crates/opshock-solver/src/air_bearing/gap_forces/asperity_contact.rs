//! Contact of the asperities of slider and disk, with friction, integrated over the film's cells.
//!
//! ```text
//! F_z = ∬ p(h; d) dA,   F_t = μ F_z along the disk's motion
//! M_pitch = −∬ p (x − x_c) dA − T F_tx,   M_roll = ∬ p (y − y_c) dA + T F_ty
//! ```
//!
//! p is the pressure of a nominal area at the distance h of the mean planes, after the smallest distance d there
//! ([`crate::rough_contact::nominal`]). d belongs to a place of the slider: what yields is on the slider, since the disk
//! brings new asperities all the time. It is updated after every accepted step. Friction acts at the slider's surface, and
//! the suspension balances it at the dimple, a slider's height T above
//! ([`super::viscous_shear`] derives that couple). The disk moves so much faster than the slider that friction follows its
//! direction.
//!
//! While a scene has this effect, the film's height is the mean gap of the rough surfaces
//! ([`crate::rough_contact::roughness`]), and its minimum a tenth of the minimum film height.
//!
//! The integral uses Gauss's rule at the true height, with points closer together towards edges ([`super::graded_points`]).
//!
//! Neglected: elastic deformation of slider and disk as wholes, the lubricant, flow factors of the film, that friction has half the lever
//! about a slider whose dimple is open, adhesion,
//! the disk's motion under the contact force.

use super::graded_points::GradedPoints;
use crate::air_bearing::attitude::Attitude;
use crate::air_bearing::film::{CellStates, Element, Film};
use crate::air_bearing::gap_force::GapForce;
use crate::air_bearing::gap_load::GapLoad;
use crate::air_bearing::mesh::Place;
use crate::rough_contact::asperity::AsperityLaw;
use crate::rough_contact::nominal::{ContactState, NominalContact};
use crate::slider::SliderParameters;
use std::sync::Arc;

/// Parameters of the contact between slider and disk; off where `roughness_m` is 0.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct AsperityContact {
    /// Standard deviation σ of the sum of both surfaces' heights, m.
    pub roughness_m: f64,
    /// Asperities per area, 1/m2.
    pub asperities_per_m2: f64,
    /// Radius of their tips, m.
    pub tip_radius_m: f64,
    /// E′ with 1/E′ = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, Pa.
    pub modulus_pa: f64,
    /// Largest contact pressure, Pa.
    pub yield_pressure_pa: f64,
    /// Coefficient of friction.
    pub friction: f64,
}

/// Smooth surfaces; with a roughness of 0.5 nm the product of roughness, tip radius and density is the 0.05 of Greenwood and
/// Williamson (1966), tip radius and friction those of a sample of the CML Dynamic Simulator, E′ and largest pressure about those
/// of thin carbon coatings. Density, E′ and pressure are doubtful.
impl Default for AsperityContact {
    fn default() -> Self {
        Self {
            roughness_m: 0.0,
            asperities_per_m2: 1e14,
            tip_radius_m: 1e-6,
            modulus_pa: 1e11,
            yield_pressure_pa: 12e9,
            friction: 0.3,
        }
    }
}

impl AsperityContact {
    /// Contact of a nominal area.
    pub fn nominal(&self) -> NominalContact {
        let law = AsperityLaw::new(self.tip_radius_m, self.modulus_pa, self.yield_pressure_pa);
        NominalContact::new(
            self.roughness_m,
            self.asperities_per_m2,
            law,
            self.yield_pressure_pa,
        )
    }
}

impl GapForce for AsperityContact {
    fn name(&self) -> &'static str {
        "head.asperity_contact"
    }

    fn is_active(&self) -> bool {
        self.roughness_m > 0.0
    }

    fn roughness_m(&self) -> Option<f64> {
        Some(self.roughness_m)
    }

    fn over(&self, film: &Film, slider: &SliderParameters) -> Arc<dyn Element> {
        let [x, y] = film.disk_velocity_m_per_s();
        let speed = x.hypot(y).max(f64::MIN_POSITIVE);
        Arc::new(Contact {
            nominal: self.nominal(),
            points: GradedPoints::new(slider, &film.mesh),
            friction: [x, y].map(|v| self.friction * v / speed),
            friction_per_force: self.friction * x.hypot(y),
            track: [slider.skew_rad.cos(), slider.skew_rad.sin()],
            arm_m: slider.height_m,
        })
    }
}

/// The contact over one film.
#[derive(Clone, Debug)]
struct Contact {
    nominal: NominalContact,
    points: GradedPoints,
    /// μ times the direction of the disk's motion.
    friction: [f64; 2],
    /// Power of friction over the normal force, m/s.
    friction_per_force: f64,
    /// Direction of the track.
    track: [f64; 2],
    arm_m: f64,
}

impl Contact {
    /// Moments of friction by pitch and roll over the normal force, m.
    fn friction_arms_m(&self) -> [f64; 2] {
        let [x, y] = self.friction;
        [-self.arm_m * x, self.arm_m * y]
    }

    /// Calls `visit` with every point that may touch: its number and height.
    fn touching(&self, attitude: &Attitude, visit: impl FnMut(usize, f64)) {
        self.points.below(self.nominal.reach_m(), attitude, visit);
    }
}

impl Element for Contact {
    fn force(&self, film: &Film, cells: &CellStates<'_>) -> [f64; 3] {
        self.load(film, cells, &mut [const { Vec::new() }; 3]).force
    }

    fn load(&self, _: &Film, cells: &CellStates<'_>, _: &mut [Vec<f64>; 3]) -> GapLoad {
        let arms = self.friction_arms_m();
        let (mut force, mut by_attitude) = ([0.0; 3], [[0.0; 3]; 3]);
        self.touching(cells.attitude, |k, height_m| {
            let borne = self.nominal.at(height_m, cells.closest_m[k]);
            let Place { x, y, .. } = self.points.places[k];
            let area = self.points.area[k];
            // Work of the pressure and of friction per (h_c, pitch, roll).
            let levers = [1.0, arms[0] - x, arms[1] + y];
            let heights = [1.0, -x, y];
            for (f, lever) in levers.into_iter().enumerate() {
                force[f] += lever * area * borne.pressure_pa;
                for (q, height) in heights.into_iter().enumerate() {
                    by_attitude[f][q] += lever * area * borne.slope_pa_per_m * height;
                }
            }
        });
        let [x, y] = self.friction.map(|share| share * force[0]);
        let [cos, sin] = self.track;
        GapLoad {
            force,
            by_attitude,
            in_plane_n: Some([x * cos + y * sin, y * cos - x * sin]),
        }
    }

    fn contact(&self, attitude: &Attitude, closest_m: &[f64]) -> Option<ContactState> {
        let mut state = ContactState {
            closest_m: f64::INFINITY,
            ..ContactState::default()
        };
        self.touching(attitude, |k, height_m| {
            let pressure_pa = self.nominal.at(height_m, closest_m[k]).pressure_pa;
            let (Place { x, y, .. }, force_n) =
                (&self.points.places[k], self.points.area[k] * pressure_pa);
            state.force_n += force_n;
            state.moments_n_m[0] -= x * force_n;
            state.moments_n_m[1] += y * force_n;
            state.mean_pressure_pa += force_n * pressure_pa;
            state.peak_pressure_pa = state.peak_pressure_pa.max(pressure_pa);
            state.closest_m = state.closest_m.min(height_m);
        });
        if state.force_n > 0.0 {
            state.mean_pressure_pa /= state.force_n;
        }
        state.friction_n_m = self.friction_arms_m().map(|arm_m| arm_m * state.force_n);
        state.friction_w = self.friction_per_force * state.force_n;
        Some(state)
    }

    fn elastic_j(&self, attitude: &Attitude, closest_m: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.touching(attitude, |k, height_m| {
            sum += self.points.area[k] * self.nominal.elastic_j_per_m2(height_m, closest_m[k]);
        });
        sum
    }

    fn yielded_j(&self, closest_m: &[f64]) -> f64 {
        let touched = closest_m.iter().zip(&self.points.area);
        let touched = touched.filter(|(closest_m, _)| closest_m.is_finite());
        let lost = touched.map(|(&closest_m, area)| {
            let back = self.nominal.elastic_j_per_m2(closest_m, closest_m);
            area * (self.nominal.work_j_per_m2(closest_m) - back)
        });
        let lost_j: f64 = lost.sum();
        // Where nothing has yielded, two rules of quadrature may leave less than nothing.
        if lost_j < 0.0 { 0.0 } else { lost_j }
    }

    fn n_remembered(&self) -> usize {
        self.points.area.len()
    }

    fn remember(&self, attitude: &Attitude, closest_m: &mut [f64]) {
        self.touching(attitude, |k, height_m| {
            closest_m[k] = closest_m[k].min(height_m);
        });
    }
}
