//! Ramp model without a ramp: the disk moves freely.

use super::mode::ContactMode;
use super::model::RampModel;

/// No ramp: the disk is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoRamp;

impl RampModel for NoRamp {
    fn name(&self) -> &'static str {
        "none"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        None
    }
}
