//! Gives the finite elements of a study's deformable ramp, where the study has a geometry or a mesh of it.

use super::checked::Study;
use super::fault::{StudyError, StudyErrors};
use super::ramp_geometry::RampSolid;
use super::settings::View;
use super::{fields, ramp_geometry, ramp_mesh};
use opshock_solid::ramp::{Extent, SolidRampError};
use std::path::Path;

impl Study {
    /// The solid of the deformable ramp at the study's first point: of its geometry, or of its mesh,
    /// whose file is read again. `None` for a ramp that is given by modes.
    ///
    /// # Errors
    /// A mesh that is no longer what the study read, a geometry that cannot be meshed.
    pub fn ramp_solid(&self) -> Result<Option<RampSolid>, StudyErrors> {
        let view = View::first(&self.settings);
        if ramp_geometry::is_given(&view) {
            let ramp = ramp_geometry::solid_ramp(&view);
            let mesh = ramp.geometry.mesh(ramp.mesh_size_m, Extent::Half);
            let mesh = mesh.map_err(|error| {
                let what = SolidRampError::from(error).to_string();
                StudyErrors::new(vec![StudyError::in_file(
                    "E174",
                    &self.path.display().to_string(),
                    what,
                )])
            })?;
            return Ok(Some(RampSolid {
                mesh,
                material: ramp.material,
                mount: ramp.mount,
                cut_hz: ramp.cut_hz,
            }));
        }
        let file = view.get(&fields::RAMP_DEFORMABLE_MESH_FILE);
        if file.is_empty() {
            return Ok(None);
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let solid = ramp_mesh::solid(&view, &folder.join(file));
        solid.map(Some).map_err(|faults| {
            let errors = faults.listed.into_iter().map(StudyError::from);
            StudyErrors::new(errors.collect())
        })
    }
}
