//! Natural modes of a whole ramp as displacements of its mesh, for drawing.
//!
//! They are the modes of the reduced ramp expanded onto the mesh, φᵀ M φ = 1. Below the cut frequency they agree with
//! those of the full mesh.

use super::mesh::RampMesh;
use super::oscillators::{Mount, SolidRampError, contact_columns, positive};
use crate::material::Material;
use crate::reduction::{PointMode, reduce};

/// A mode and how it moves the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct RampShape {
    /// Frequency, and shape at the top and the bottom contact.
    pub mode: PointMode,
    /// Displacement of every node of the mesh, 1/√kg.
    pub displacement_per_sqrt_kg: Vec<[f64; 3]>,
}

impl RampMesh {
    /// The modes below the cut. Those of a half mesh are of unit mass as a whole, with the other
    /// half moving alike.
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn shapes(
        &self,
        material: &Material,
        mount: Mount,
        cut_hz: f64,
    ) -> Result<Vec<RampShape>, SolidRampError> {
        positive(&[("cut", cut_hz)])?;
        let system = self.system(material, mount)?;
        let reduced = reduce(&system, contact_columns(self, &system), cut_hz)?;
        let modes = reduced.mode_shapes()?.into_iter();
        let below = modes.take_while(|(mode, _)| mode.frequency_hz < cut_hz);
        Ok(below
            .map(|(mode, unknowns)| {
                let at = |node: usize| {
                    std::array::from_fn(|i| system.unknown(node, i).map_or(0.0, |k| unknowns[k]))
                };
                RampShape {
                    mode,
                    displacement_per_sqrt_kg: (0..self.mesh.nodes_m.len()).map(at).collect(),
                }
            })
            .collect())
    }
}
