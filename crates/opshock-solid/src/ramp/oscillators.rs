//! Computes the oscillators of a ramp's contact points from its mesh and material.

use super::geometry::{GeometryError, RampGeometry};
use super::mesh::{Extent, RampMesh};
use super::shape::ShapeError;
use crate::assembly::{AssemblyError, ElasticFaces, SolidSystem, Support};
use crate::material::Material;
use crate::reduction::{PointMode, ReducedSolid, reduce};
use crate::sparse::SparseError;

/// Support of the mount's face on the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mount {
    /// Fixed.
    Bolted,
    /// On springs distributed uniformly over the face.
    Elastic {
        /// Stiffness of the whole face normal to its plane, N/m.
        normal_n_per_m: f64,
        /// Stiffness of the whole face within its plane, N/m.
        tangential_n_per_m: f64,
    },
}

/// A deformable ramp from geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRamp {
    /// Dimensions.
    pub geometry: RampGeometry,
    /// Material.
    pub material: Material,
    /// Mount.
    pub mount: Mount,
    /// Longest edge of an element, m.
    pub mesh_size_m: f64,
    /// Fixed-interface modes below this frequency are kept, Hz.
    pub cut_hz: f64,
}

/// The ramp's oscillators, and figures of the model they come from.
#[derive(Clone, Debug, PartialEq)]
pub struct RampModes {
    /// Oscillators; shapes at the top and the bottom contact.
    pub modes: Vec<PointMode>,
    /// Elements.
    pub n_elements: usize,
    /// Unknowns.
    pub n_unknowns: usize,
    /// Mass of the whole ramp, kg.
    pub mass_kg: f64,
    /// Static stiffness of the top contact with the bottom one free, N/m.
    pub top_stiffness_n_per_m: f64,
}

/// Errors of computing a ramp's oscillators.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidRampError {
    /// Geometry.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// Mesh or material.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A mesh with invalid contacts.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Equations.
    #[error(transparent)]
    Sparse(#[from] SparseError),
    /// A number of the model out of its range.
    #[error("{name} = {value:e} is outside its range ({allowed})")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
}

impl SolidRamp {
    /// Meshes, assembles, reduces and diagonalises.
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn modes(&self) -> Result<RampModes, SolidRampError> {
        self.validate()?;
        let mesh = self.geometry.mesh(self.mesh_size_m, Extent::Half)?;
        mesh.modes(&self.material, self.mount, self.cut_hz)
    }

    /// Mesh and equations of motion on the base; see [`RampMesh::system`].
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn system(&self, extent: Extent) -> Result<(RampMesh, SolidSystem), SolidRampError> {
        self.validate()?;
        let mesh = self.geometry.mesh(self.mesh_size_m, extent)?;
        let system = mesh.system(&self.material, self.mount)?;
        Ok((mesh, system))
    }

    /// Craig-Bampton reduction to the two contacts, top first.
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn reduce(
        &self,
        mesh: &RampMesh,
        system: &SolidSystem,
    ) -> Result<ReducedSolid, SolidRampError> {
        Ok(reduce(system, contact_columns(mesh, system), self.cut_hz)?)
    }

    fn validate(&self) -> Result<(), SolidRampError> {
        positive(&[("mesh_size", self.mesh_size_m), ("cut", self.cut_hz)])
    }
}

impl RampMesh {
    /// Assembles, reduces to the contacts and diagonalises.
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn modes(
        &self,
        material: &Material,
        mount: Mount,
        cut_hz: f64,
    ) -> Result<RampModes, SolidRampError> {
        positive(&[("cut", cut_hz)])?;
        let system = self.system(material, mount)?;
        let reduced = reduce(&system, contact_columns(self, &system), cut_hz)?;
        let compliance = |modes: &[PointMode]| -> f64 {
            let of =
                |m: &PointMode| (m.shape[0] / (std::f64::consts::TAU * m.frequency_hz)).powi(2);
            modes.iter().map(of).sum()
        };
        let modes = reduced.point_modes()?;
        Ok(RampModes {
            top_stiffness_n_per_m: compliance(&modes).recip(),
            modes,
            n_elements: self.mesh.n_elements(),
            n_unknowns: system.order(),
            mass_kg: system.total_mass_kg,
        })
    }

    /// Equations of motion on the base. Those of a half are doubled: the other half has the same motion, and both
    /// halves share the forces on the contacts.
    ///
    /// # Errors
    /// See [`SolidRampError`].
    pub fn system(&self, material: &Material, mount: Mount) -> Result<SolidSystem, SolidRampError> {
        let sides = match self.extent {
            Extent::Half => 2.0,
            Extent::Whole => 1.0,
        };
        let mut support = Support {
            held: self.symmetric.iter().map(|&a| (a, 1)).collect(),
            elastic: Vec::new(),
        };
        match mount {
            Mount::Bolted => {
                let nodes = self.bolted.iter().flatten();
                support
                    .held
                    .extend(nodes.flat_map(|&a| [(a, 0), (a, 1), (a, 2)]));
            }
            Mount::Elastic {
                normal_n_per_m,
                tangential_n_per_m,
            } => {
                positive(&[
                    ("mount normal stiffness", normal_n_per_m),
                    ("mount tangential stiffness", tangential_n_per_m),
                ])?;
                let area_m2 = self.mesh.face_weights(&self.bolted).area_m2;
                let mut stiffness = [tangential_n_per_m; 3];
                stiffness[self.mount_axis()?] = normal_n_per_m;
                support.elastic.push(ElasticFaces {
                    faces: &self.bolted,
                    stiffness_n_per_m3: stiffness.map(|k| k / (sides * area_m2)),
                });
            }
        }
        let system = SolidSystem::assemble(&self.mesh, material, &support)?;
        Ok(system.times(sides))
    }

    /// The axis normal to the mount's face.
    fn mount_axis(&self) -> Result<usize, SolidRampError> {
        let normal = self.mesh.mean_normal(&self.bolted);
        let axis = (0..3).find(|&i| normal[i].abs() > MOUNT_UPRIGHT);
        axis.ok_or(SolidRampError::Parameter {
            name: "tilt of the mount's face from the axes",
            value: normal
                .iter()
                .fold(0.0_f64, |most, n| n.abs().max(most))
                .acos(),
            allowed: "an elastic mount's face at right angles to x, y or z",
        })
    }
}

/// Cosine of the largest tilt of an elastic mount's face, 1 degree.
const MOUNT_UPRIGHT: f64 = 0.999_847_7;

pub(super) fn positive(checks: &[(&'static str, f64)]) -> Result<(), SolidRampError> {
    match checks.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
        Some(&(name, value)) => Err(SolidRampError::Parameter {
            name,
            value,
            allowed: "finite and above 0",
        }),
        None => Ok(()),
    }
}

/// Columns that give the mean displacement along z of the top and the bottom contact.
pub fn contact_columns(mesh: &RampMesh, system: &SolidSystem) -> Vec<Vec<f64>> {
    [&mesh.top, &mesh.bottom]
        .map(|contact| {
            let shares: Vec<(usize, f64)> = contact
                .nodes
                .iter()
                .map(|&(a, weight)| (a, weight / contact.area_m2))
                .collect();
            system.column(&shares, 2)
        })
        .into()
}
