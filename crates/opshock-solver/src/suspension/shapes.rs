//! Shapes of the suspension's natural modes along its length, for drawing.
//!
//! ```text
//! K φ = ω² M φ,   φᵀ M φ = 1      of the finite elements, root clamped; dimple free, or fixed too
//! ```
//!
//! Inside an element the shape is the element's own: the cubic of Hermite for bending, a line for
//! torsion, so that integrals over the shape are those of the mass matrix.

use nalgebra::{DMatrix, DVector};

use super::beam::{BeamMatrices, hermite};
use super::error::SuspensionError;
use super::parameters::SuspensionParameters;
use super::reduction::lowest_modes;
use super::section::Section;

/// Parts of an element between drawn points.
const PARTS: usize = 4;

/// Support of the suspension beside its root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// Nothing.
    Free,
    /// The dimple: its z for bending, its roll for torsion.
    Pinned,
}

/// One natural mode of unit modal mass.
#[derive(Clone, Debug, PartialEq)]
pub struct SuspensionShape {
    /// Bending, or torsion.
    pub is_bending: bool,
    /// Support.
    pub held: Held,
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// At every place: rise, 1/√kg, of a bending mode; twist about the axis, 1/(m √kg), of a torsion mode.
    pub shape: Vec<f64>,
}

/// Shapes of a suspension given by its geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct SuspensionShapes {
    /// Places along the axis from the root, m: the ends of every element and three points within.
    pub places_m: Vec<f64>,
    /// Width there, m.
    pub width_m: Vec<f64>,
    /// Bending, then torsion; free, then pinned; rising frequency.
    pub modes: Vec<SuspensionShape>,
}

impl SuspensionShapes {
    /// As many modes as [`super::ReducedSuspension::build`] keeps: `bending_modes` pinned bending modes
    /// and half as many, rounded up, of torsion; one more of each with the dimple free.
    ///
    /// # Errors
    /// Invalid geometry, or more modes than the elements have.
    pub fn build(
        parameters: &SuspensionParameters,
        bending_modes: usize,
    ) -> Result<Self, SuspensionError> {
        let beam = BeamMatrices::assemble(parameters)?;
        let nodes = &beam.nodes_m;
        let mut places_m = vec![nodes[0]];
        for ends in nodes.windows(2) {
            let part = |k: usize| ends[0] + (ends[1] - ends[0]) * k as f64 / PARTS as f64;
            places_m.extend((1..PARTS).map(part));
            places_m.push(ends[1]);
        }
        let width_m = places_m
            .iter()
            .map(|&x| Section::width_m(parameters, x))
            .collect();
        let torsion_modes = bending_modes.div_ceil(2);
        let mut modes = Vec::new();
        for (is_bending, stiffness, mass, dimple, n_modes) in [
            (
                true,
                &beam.bending_stiffness,
                &beam.bending_mass,
                beam.dimple_bending,
                bending_modes,
            ),
            (
                false,
                &beam.torsion_stiffness,
                &beam.torsion_mass,
                beam.dimple_torsion,
                torsion_modes,
            ),
        ] {
            let available = mass.nrows() - 1;
            if n_modes > available {
                return Err(SuspensionError::TooManyModes {
                    wanted: n_modes,
                    available,
                });
            }
            let without = |matrix: &DMatrix<f64>| {
                let matrix = matrix.clone();
                matrix.remove_row(dimple).remove_column(dimple)
            };
            let free = lowest_modes(stiffness.clone(), mass, n_modes + 1)?;
            let (omega, pinned) = lowest_modes(without(stiffness), &without(mass), n_modes)?;
            let pinned = (omega, pinned.insert_row(dimple, 0.0));
            for (held, (omega, vectors)) in [(Held::Free, free), (Held::Pinned, pinned)] {
                for (omega, vector) in omega.iter().zip(vectors.column_iter()) {
                    modes.push(SuspensionShape {
                        is_bending,
                        held,
                        frequency_hz: omega / std::f64::consts::TAU,
                        shape: along(nodes, is_bending, &vector.into_owned()),
                    });
                }
            }
        }
        Ok(Self {
            places_m,
            width_m,
            modes,
        })
    }
}

/// A shape at the drawn places from the unknowns of the nodes; those of the root are zero.
fn along(nodes: &[f64], is_bending: bool, unknowns: &DVector<f64>) -> Vec<f64> {
    let per_node = if is_bending { 2 } else { 1 };
    let of = |node: usize, k: usize| match node {
        0 => 0.0,
        _ => unknowns[per_node * (node - 1) + k],
    };
    let mut shape = vec![0.0];
    for (e, ends) in nodes.windows(2).enumerate() {
        for part in 1..=PARTS {
            let s = part as f64 / PARTS as f64;
            shape.push(if is_bending {
                let [a, b, c, d] = hermite(s, ends[1] - ends[0]);
                a * of(e, 0) + b * of(e, 1) + c * of(e + 1, 0) + d * of(e + 1, 1)
            } else {
                (1.0 - s) * of(e, 0) + s * of(e + 1, 0)
            });
        }
    }
    shape
}
