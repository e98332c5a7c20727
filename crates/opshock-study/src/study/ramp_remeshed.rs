//! Meshes a ramp given by its geometry finer and coarser, for the mesh's contribution to an uncertainty interval.

use super::fields;
use super::ramp_geometry;
use super::settings::View;
use super::words::Faces;
use crate::search::Ramp;
use opshock_solid::ramp::SolidRamp;
use opshock_solver::ramp::{ContactMode, OneBody, RampBody};

/// A deformable ramp whose mesh can be made anew.
#[derive(Clone, Debug, PartialEq)]
pub struct RemeshedRamp {
    solid: SolidRamp,
    damping_ratio: f64,
    /// The way the head faces, which sees the ramp.
    faces: Faces,
}

impl RemeshedRamp {
    /// That of a view; `None` for other ramps, and for those that are given by modes.
    pub(super) fn of(view: &View<'_>, ramp: Ramp) -> Option<Self> {
        let is_solid = ramp == Ramp::Deformable && ramp_geometry::is_given(view);
        is_solid.then(|| Self {
            solid: ramp_geometry::solid_ramp(view),
            damping_ratio: view.get(&fields::RAMP_DEFORMABLE_DAMPING_RATIO),
            faces: view.get(&fields::SLIDER_FACES).unwrap_or_default(),
        })
    }

    /// Oscillators on elements of half the size `level` times, or of twice where it is negative. None
    /// where the geometry has no such mesh: a scene with them cannot be built.
    pub fn modes(&self, level: i8) -> Vec<ContactMode> {
        let modes = ramp_geometry::oscillators(&self.at(level), self.damping_ratio);
        let ramp = RampBody::from(OneBody { modes });
        let seen = match self.faces {
            Faces::Down => ramp,
            Faces::Up => ramp.mirrored(),
        };
        seen.contacts.unwrap_or_default()
    }

    /// Times that the elements may be halved, up to `most`, until the ramp takes too many.
    pub fn halvings(&self, most: i8) -> i8 {
        let has_mesh = |level: &i8| ramp_geometry::has_mesh(&self.at(*level));
        (1..=most).take_while(has_mesh).last().unwrap_or(0)
    }

    /// All that its meshes and oscillators are made of, every number with all its digits.
    pub fn content(&self) -> String {
        format!("{self:?}")
    }

    fn at(&self, level: i8) -> SolidRamp {
        SolidRamp {
            mesh_size_m: self.solid.mesh_size_m / f64::from(level).exp2(),
            ..self.solid
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::study::Study;

    /// Displacements that are held to polynomials stiffen: frequencies fall from mesh to mesh.
    #[test]
    fn the_mesh_of_the_study_lies_between_a_coarser_and_a_finer_one() {
        let facing = |size: &str, faces: &str| {
            let text = format!(
                "study_format = 2\nname = \"a\"\noutputs = [\"contact_force\"]\n\
                 [pulse]\nwidths_ms = [1.0]\nsigns = [\"+\"]\n\
                 [ramp]\nmodels = [\"rigid\", \"deformable\"]\n\
                 [ramp.deformable.geometry]\nmaterial = \"POM\"\nmesh_size_mm = {size}\n\
                 [slider]\nfaces = \"{faces}\"\n"
            );
            Study::from_text(&text, &[]).unwrap()
        };
        let study = |size: &str| facing(size, "down");
        let one = study("3.0");
        let [rigid, deformable] = &one.points[..] else {
            panic!("two points")
        };
        assert_eq!(rigid.remeshed, None);
        let ramp = deformable.remeshed.as_ref().expect("a solid");
        let modes = deformable.scene.ramp.model.modes();
        assert_eq!(ramp.modes(0), modes);
        // The same oscillators as those of a study with that size.
        assert_eq!(
            ramp.modes(1),
            study("1.5").points[1].scene.ramp.model.modes()
        );
        // A head under the disk sees the ramp upside down, on every mesh.
        let up = &facing("3.0", "up").points[1];
        let seen = up.scene.ramp.model.modes();
        let ramp_seen = up.remeshed.as_ref().expect("a solid");
        assert_eq!(ramp_seen.modes(0), seen);
        assert_ne!(seen, modes);
        assert_eq!(up.scene.ramp.model.mirrored(), deformable.scene.ramp.model);
        // Elements of 0.375 mm are some 4000, of 0.1875 mm more than the 5000 that a ramp may have.
        assert_eq!([1, 3, 6].map(|most| ramp.halvings(most)), [1, 3, 3]);
        let lowest = [-1, 0, 1].map(|level| ramp.modes(level)[0].frequency_hz);
        assert!(
            lowest[0] >= lowest[1] && lowest[1] > lowest[2],
            "{lowest:?}"
        );
    }
}
