//! Van der Waals and electrostatic forces between slider and disk.
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
//! Integrated over the film's cells with Gauss's rule of two by two points, at the height the film
//! sees, its floor included: h → 0 leaves the force finite. Force and moments are functions of the
//! attitude alone, so their derivatives stand beside those of the film at constant ψ.
//!
//! Source: Israelachvili, Intermolecular and Surface Forces (1992), ch. 10 and 11; Wu and Bogy, J.
//! Tribology 124 (2002) 562; Thornton and Bogy, IEEE Trans. Magn. 39 (2003) 2420. Left out: overcoats
//! and lubricant as layers of their own, roughness, retardation (beyond some tens of nanometres).

use super::faces::{BLOCK, Places};
use super::mesh::{Mesh, Place};
use crate::quantity::VACUUM_PERMITTIVITY_F_PER_M;
use crate::slider::surface::Surface;
use std::f64::consts::PI;

/// What acts between slider and disk beside the air.
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
    /// Whether none of them acts.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// `share` of all of them.
    pub(super) fn times(&self, share: f64) -> Self {
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

/// Force and moments [F_z, M_pitch, M_roll] of the surface forces, N and N m, with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceLoad {
    /// Conjugate to (h_c, pitch, roll), as from [`Film::force`](super::Film::force).
    pub force: [f64; 3],
    /// Derivatives by (h_c, pitch, roll): `[force][q]`.
    pub by_attitude: [[f64; 3]; 3],
}

/// Surface forces over the points of one film's cells.
#[derive(Clone, Debug)]
pub(super) struct Interaction {
    pub(super) forces: SurfaceForces,
    /// Points; the form holds the recess too.
    pub(super) places: Places,
    pub(super) area: Vec<f64>,
}

impl Interaction {
    /// Points of the cells of `mesh`.
    pub(super) fn new(forces: SurfaceForces, surface: &Surface, mesh: &Mesh) -> Self {
        let mut places = Places::default();
        let mut area = Vec::with_capacity(4 * mesh.cells.len());
        let offset = 0.5 / 3.0_f64.sqrt();
        let [nx, ny] = mesh.counts();
        for i in 0..nx {
            for j in 0..ny {
                let cell = &mesh.cells[mesh.index(i, j)];
                let [x, y] = [(0, i), (1, j)].map(|(d, k)| {
                    let (middle, width) = (mesh.lines[d].centre(k), mesh.lines[d].width(k));
                    [middle - offset * width, middle + offset * width]
                });
                for x in x {
                    for y in y {
                        let mut place = Place::new(surface, x, y);
                        place.form += cell.recess;
                        places.push(&place);
                        area.push(0.25 * cell.area);
                    }
                }
            }
        }
        // Points without area, far from the disk, fill the last block.
        while area.len() % BLOCK != 0 {
            places.push(&Place {
                form: 1.0,
                x: 0.0,
                y: 0.0,
            });
            area.push(0.0);
        }
        Self {
            forces,
            places,
            area,
        }
    }

    pub(super) fn forces(&self) -> &SurfaceForces {
        &self.forces
    }
}
