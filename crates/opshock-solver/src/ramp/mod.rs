//! Load/unload ramp: models, each in a file of its own, and what disk and contact see of any of them.
//!
//! A ramp is not there ([`NoRamp`]), or it has two contact points, above and below the disk, that move as a sum of
//! modes ([`RampBody`]). A [rigid ramp](RigidRamp) has no mode, of two [`Arms`] each mode moves one contact point, of
//! [`OneBody`] it may move both. Anything else is one more implementation of [`RampModel`].

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
