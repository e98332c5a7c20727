//! Models the load/unload ramp, each model in a file of its own, behind one interface for disk and contact.
//!
//! Either there is no ramp ([`NoRamp`]), or it has two contact points, above and below the disk, that move as a sum of
//! modes ([`RampBody`]). A [rigid ramp](RigidRamp) has no mode; each mode of two [`Arms`] moves one contact point; a
//! mode of [`OneBody`] may move both. Any other ramp is one more implementation of [`RampModel`].

mod arms;
mod error;
mod mode;
mod model;
mod none;
mod one_body;
mod parameters;
mod rigid;
mod viscoelastic;

pub use arms::Arms;
pub use error::RampError;
pub use mode::{ArmMode, ContactMode, Relaxation};
pub use model::{RampBody, RampModel};
pub use none::NoRamp;
pub use one_body::{CoupledMode, OneBody};
pub use parameters::{CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, RampParameters};
pub use rigid::RigidRamp;
pub use viscoelastic::{POM, Viscoelastic};
