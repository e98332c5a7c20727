//! Van der Waals and electrostatic forces between slider and disk, integrated over the film's cells.
//!
//! ```text
//! p(h) = −A/(6π h³) + B/(45π h⁹) − ε₀ V²/(2 h²)        per area, > 0 pushes apart
//! ```
//!
//! The first two terms are those of two half spaces whose molecules attract with C/r⁶ and repel with
//! D/r¹², A = π² ρ₁ρ₂ C and B = π² ρ₁ρ₂ D; the third is the Maxwell stress between conductors at the
//! potential difference V. Each place is taken as parallel to the disk (slopes are below 1e-3).
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | A | `hamaker_j` | J |
//! | B | `repulsion_j_m6` | J m⁶ |
//! | V | `potential_v` | V |
//! | ε₀ | [`VACUUM_PERMITTIVITY_F_PER_M`] | F/m |
//!
//! The integral uses Gauss's rule of two by two points per cell, at the height that the film sees. The minimum film
//! height is included, so the force stays finite as h → 0. Force and moments depend on the attitude alone; their
//! derivatives are added to those of the film at constant ψ.
//!
//! Source: Israelachvili, Intermolecular and Surface Forces (1992), ch. 10 and 11; Wu and Bogy, J. Tribology 124 (2002)
//! 562; Thornton and Bogy, IEEE Trans. Magn. 39 (2003) 2420. Neglected: overcoats and lubricant as layers of their own,
//! roughness, retardation (beyond some tens of nanometres).

use super::quadrature::CellPoints;
use crate::air_bearing::attitude::Attitude;
use crate::air_bearing::balance::Moments;
use crate::air_bearing::derivatives::height_by_attitude;
use crate::air_bearing::faces::{BLOCK, block};
use crate::air_bearing::film::{CellStates, Element, Film};
use crate::air_bearing::gap_force::GapForce;
use crate::air_bearing::gap_load::GapLoad;
use crate::air_bearing::linearise::Totals;
use crate::lanes::{Kernel, total, widest};
use crate::quantity::VACUUM_PERMITTIVITY_F_PER_M;
use crate::slider::SliderParameters;
use std::f64::consts::PI;
use std::sync::Arc;

/// Parameters of the surface forces between slider and disk.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct SurfaceForces {
    /// Hamaker's constant A of the attraction, J.
    pub hamaker_j: f64,
    /// Constant B of the repulsion, J m6.
    pub repulsion_j_m6: f64,
    /// Potential difference V between slider and disk, V.
    pub potential_v: f64,
}

impl SurfaceForces {
    /// `share` of all of them.
    fn times(&self, share: f64) -> Self {
        Self {
            hamaker_j: share * self.hamaker_j,
            repulsion_j_m6: share * self.repulsion_j_m6,
            potential_v: share.sqrt() * self.potential_v,
        }
    }

    /// Force per area at the height `h_m`, Pa, positive when it pushes apart, and its derivative by
    /// the height, Pa/m.
    #[inline(always)]
    pub fn pressure(&self, h_m: f64) -> (f64, f64) {
        let attraction = self.hamaker_j / (6.0 * PI);
        let repulsion = self.repulsion_j_m6 / (45.0 * PI);
        let field = 0.5 * VACUUM_PERMITTIVITY_F_PER_M * self.potential_v * self.potential_v;
        let inverse = 1.0 / h_m;
        let inverse_2 = inverse * inverse;
        let inverse_6 = inverse_2 * inverse_2 * inverse_2;
        let pressure = inverse_2 * (inverse * (repulsion * inverse_6 - attraction) - field);
        let slope = inverse_2
            * inverse
            * (inverse * (3.0 * attraction - 9.0 * repulsion * inverse_6) + 2.0 * field);
        (pressure, slope)
    }
}

impl GapForce for SurfaceForces {
    fn name(&self) -> &'static str {
        "head.surface_forces"
    }

    fn is_active(&self) -> bool {
        *self != Self::default()
    }

    fn over(&self, film: &Film, slider: &SliderParameters) -> Arc<dyn Element> {
        Arc::new(Interaction {
            forces: *self,
            points: CellPoints::new(slider, &film.mesh),
        })
    }
}

/// Surface forces over the points of one film's cells.
#[derive(Clone, Debug)]
struct Interaction {
    forces: SurfaceForces,
    points: CellPoints,
}

impl Interaction {
    fn posed<'a>(&'a self, film: &'a Film, cells: &CellStates<'a>) -> Posed<'a> {
        Posed {
            film,
            interaction: self,
            attitude: cells.attitude,
        }
    }
}

impl Element for Interaction {
    fn force(&self, film: &Film, cells: &CellStates<'_>) -> [f64; 3] {
        widest(Loads(self.posed(film, cells)))
    }

    fn load(&self, film: &Film, cells: &CellStates<'_>, _: &mut [Vec<f64>; 3]) -> GapLoad {
        widest(Linearised(self.posed(film, cells)))
    }

    fn share_of_attraction(&self, share: f64) -> Option<Arc<dyn Element>> {
        let mut part = self.clone();
        part.forces = self.forces.times(share);
        Some(Arc::new(part))
    }
}

/// The points of a film at an attitude.
struct Posed<'a> {
    film: &'a Film,
    interaction: &'a Interaction,
    attitude: &'a Attitude,
}

impl Posed<'_> {
    /// First points of the blocks.
    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.interaction.points.area.len()).step_by(BLOCK)
    }

    /// Height that the film sees, its slope by the true height, and area of a block of points.
    #[inline(always)]
    fn block(&self, first: usize) -> ([f64; BLOCK], [f64; BLOCK], &[f64; BLOCK]) {
        let height = self.interaction.points.places.heights(first, self.attitude);
        let [h, limit_slope] = self.film.limited_block::<false>(&height, &[0.0; BLOCK]);
        (h, limit_slope, block(&self.interaction.points.area, first))
    }
}

/// Force and moments as a kernel.
struct Loads<'a>(Posed<'a>);

impl Kernel for Loads<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn call(self) -> [f64; 3] {
        let forces = &self.0.interaction.forces;
        let mut moments = Moments::default();
        for first in self.0.blocks() {
            let (h, _, area) = self.0.block(first);
            let mut load = [0.0; BLOCK];
            for k in 0..BLOCK {
                load[k] = area[k] * forces.pressure(h[k]).0;
            }
            moments.add(&load, &self.0.interaction.points.places, first);
        }
        moments.total()
    }
}

/// Force, moments and derivatives as a kernel.
struct Linearised<'a>(Posed<'a>);

impl Kernel for Linearised<'_> {
    type Output = GapLoad;

    #[inline(always)]
    fn call(self) -> GapLoad {
        let Interaction { forces, points } = self.0.interaction;
        let places = &points.places;
        let mut totals = Totals::default();
        for first in self.0.blocks() {
            let (h, limit_slope, area) = self.0.block(first);
            let arms = height_by_attitude([block(&places.x, first), block(&places.y, first)]);
            let (mut load, mut per_height) = ([0.0; BLOCK], [0.0; BLOCK]);
            for k in 0..BLOCK {
                let (pressure, slope) = forces.pressure(h[k]);
                load[k] = area[k] * pressure;
                per_height[k] = area[k] * slope * limit_slope[k];
            }
            totals.moments.add(&load, places, first);
            totals.add_by_height(&per_height, &arms);
        }
        GapLoad {
            force: totals.moments.total(),
            by_attitude: totals.force_by_attitude.map(|row| row.map(total)),
            in_plane_n: None,
        }
    }
}
