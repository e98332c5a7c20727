//! Lists the forces between slider and disk other than the air's pressure, each in a file of its own.
//!
//! A new force needs a file here, its entry below, and its keys in a study with the code that reads them.

mod asperity_contact;
mod graded_points;
mod quadrature;
mod surface_forces;
mod viscous_shear;

use super::gap_force::GapForce;
pub use asperity_contact::AsperityContact;
pub use surface_forces::SurfaceForces;
pub use viscous_shear::ViscousShear;

/// The forces of a scene; by default none acts.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct GapForces {
    /// Van der Waals and electrostatic forces.
    #[serde(skip_serializing_if = "is_off")]
    pub surface_forces: SurfaceForces,
    /// Shear of the film on the slider.
    #[serde(skip_serializing_if = "is_off")]
    pub viscous_shear: ViscousShear,
    /// Contact of asperities.
    #[serde(skip_serializing_if = "is_off")]
    pub asperity_contact: AsperityContact,
}

/// A force that is off is no part of a scene's identity, so adding one keeps the identities of stored results.
fn is_off(force: &impl GapForce) -> bool {
    !force.is_active()
}

impl GapForces {
    /// Every one, active or not, in the order of plans and results.
    pub fn all(&self) -> impl Iterator<Item = &dyn GapForce> {
        // Destructured by name, so that a new force does not compile until it is listed here.
        let Self {
            surface_forces,
            viscous_shear,
            asperity_contact,
        } = self;
        let all: [&dyn GapForce; _] = [surface_forces, viscous_shear, asperity_contact];
        all.into_iter()
    }

    /// Those that act.
    pub fn active(&self) -> impl Iterator<Item = &dyn GapForce> {
        self.all().filter(|force| force.is_active())
    }

    /// The same in the drive upside down.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            surface_forces: self.surface_forces.mirrored(),
            viscous_shear: self.viscous_shear.mirrored(),
            asperity_contact: self.asperity_contact.mirrored(),
        }
    }
}
