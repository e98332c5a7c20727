//! Ramp model that does not deform.

use super::mode::ContactMode;
use super::model::{RIGID, RampModel};

/// Contact points fixed to the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RigidRamp;

impl RampModel for RigidRamp {
    fn name(&self) -> &'static str {
        RIGID
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        Some(Vec::new())
    }
}
