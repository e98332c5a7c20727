//! A ramp of any shape, given by a mesh and the faces of its mount and its contacts.
//!
//! z is the disk's axis and points to the side of the slider: the upper contact stands above the
//! disk, the lower one below it.

use super::mesh::{Extent, RampMesh};
use crate::mesh::{Mesh, MeshError};

/// Faces of a mesh by their function.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RampFaces {
    /// On the base.
    pub mount: Vec<Vec<usize>>,
    /// Upper finger's contact with the disk.
    pub top: Vec<Vec<usize>>,
    /// Lower finger's contact with the disk.
    pub bottom: Vec<Vec<usize>>,
}

/// Errors of a mesh as a ramp.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// Mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A part without a face, or without an area.
    #[error("{part} has no area")]
    NoArea {
        /// `mount`, `top` or `bottom`.
        part: &'static str,
    },
    /// The contacts are not on the two sides of a disk.
    #[error("the top contact stands {gap_m:e} m above the bottom one")]
    UpsideDown {
        /// Mean height of the upper contact over the lower one, m.
        gap_m: f64,
    },
    /// A contact on the base cannot move.
    #[error("contact and mount share node {node}")]
    HeldContact {
        /// Node, from 0.
        node: usize,
    },
}

impl RampMesh {
    /// Makes a whole ramp of a mesh.
    ///
    /// # Errors
    /// An invalid mesh, faces without area, contacts that cannot be those of a ramp.
    pub fn of(mesh: Mesh, faces: RampFaces) -> Result<Self, ShapeError> {
        mesh.validate()?;
        let area = |part: &'static str, faces: &[Vec<usize>]| {
            let weights = mesh.face_weights(faces);
            match weights.area_m2 > 0.0 {
                true => Ok(weights),
                false => Err(ShapeError::NoArea { part }),
            }
        };
        area("mount", &faces.mount)?;
        let (top, bottom) = (area("top", &faces.top)?, area("bottom", &faces.bottom)?);
        let mut held: Vec<usize> = faces.mount.concat();
        held.sort_unstable();
        let mut contacts = top.nodes.iter().chain(&bottom.nodes);
        if let Some(&(node, _)) = contacts.find(|(node, _)| held.binary_search(node).is_ok()) {
            return Err(ShapeError::HeldContact { node });
        }
        let ramp = Self {
            mesh,
            extent: Extent::Whole,
            symmetric: Vec::new(),
            bolted: faces.mount,
            top,
            bottom,
        };
        let gap_m = ramp.gap_m();
        match gap_m > 0.0 {
            true => Ok(ramp),
            false => Err(ShapeError::UpsideDown { gap_m }),
        }
    }

    /// Mean height of the top contact over the bottom one, m.
    pub fn gap_m(&self) -> f64 {
        let [top, bottom] = [&self.top, &self.bottom].map(|contact| {
            let of = |&(node, weight): &(usize, f64)| weight * self.mesh.nodes_m[node][2];
            contact.nodes.iter().map(of).sum::<f64>() / contact.area_m2
        });
        top - bottom
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::ramp::{Mount, RampGeometry, SolidRamp};

    fn faces(ramp: &RampMesh, geometry: &RampGeometry) -> RampFaces {
        let contact = |z: f64| {
            let half = 0.5 * geometry.contact_length_m + 1e-9;
            let near =
                |x: [f64; 3]| (x[2] - z).abs() < 1e-9 && (x[0] - geometry.contact_m).abs() < half;
            ramp.mesh.surface_faces(near)
        };
        RampFaces {
            mount: ramp.bolted.clone(),
            top: contact(geometry.slot_above_m),
            bottom: contact(-geometry.slot_below_m),
        }
    }

    /// The parametric ramp's own mesh, given as an arbitrary mesh, gives the parametric ramp: bolted, and on springs
    /// with its face up.
    #[test]
    fn a_mesh_of_the_parametric_ramp_is_that_ramp() {
        let geometry = RampGeometry::mobile_drive();
        let whole = geometry.mesh(2e-3, Extent::Whole).unwrap();
        let given = RampMesh::of(whole.mesh.clone(), faces(&whole, &geometry)).unwrap();
        let slot_m = geometry.slot_above_m + geometry.slot_below_m;
        assert!((given.gap_m() / slot_m - 1.0).abs() < 1e-12);
        let material = Material::by_name("POM").unwrap();
        let elastic = Mount::Elastic {
            normal_n_per_m: 2e6,
            tangential_n_per_m: 5e5,
        };
        for mount in [Mount::Bolted, elastic] {
            let cut_hz = 20e3;
            let own = SolidRamp {
                geometry,
                material,
                mount,
                mesh_size_m: 2e-3,
                cut_hz,
            };
            let (own, given) = (
                own.modes().unwrap(),
                given.modes(&material, mount, cut_hz).unwrap(),
            );
            for (a, b) in [
                (own.mass_kg, given.mass_kg),
                (own.top_stiffness_n_per_m, given.top_stiffness_n_per_m),
                (own.modes[0].frequency_hz, given.modes[0].frequency_hz),
                (own.modes[0].participation, given.modes[0].participation),
            ] {
                assert!((a / b - 1.0).abs() < 1e-7, "{mount:?}: {a} {b}");
            }
        }
    }

    #[test]
    fn faces_that_no_ramp_has_are_refused() {
        let geometry = RampGeometry::mobile_drive();
        let whole = geometry.mesh(2e-3, Extent::Whole).unwrap();
        let sound = faces(&whole, &geometry);
        let refused = |change: &dyn Fn(&mut RampFaces)| {
            let mut faces = sound.clone();
            change(&mut faces);
            RampMesh::of(whole.mesh.clone(), faces).unwrap_err()
        };
        let swapped = refused(&|f| std::mem::swap(&mut f.top, &mut f.bottom));
        assert!(matches!(swapped, ShapeError::UpsideDown { gap_m } if gap_m < 0.0));
        let bare = refused(&|f| f.mount.clear());
        assert_eq!(bare, ShapeError::NoArea { part: "mount" });
        let held = refused(&|f| f.mount.extend(f.top.clone()));
        assert!(matches!(held, ShapeError::HeldContact { .. }));
    }
}
