//! Errors of a ramp's parameters.

/// Fault of a ramp.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RampError {
    /// The disk and an arm overlap before the shock.
    #[error("the {side} arm overlaps the disk by {amount_m:e} m before the shock")]
    Overlap {
        /// Which arm.
        side: &'static str,
        /// Overlap, m.
        amount_m: f64,
    },
    /// A parameter is outside its range.
    #[error("ramp parameter {name} = {value:e} is outside its range ({allowed})")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// The modes of arms that relax cannot be told apart.
    #[error("the damped modes of a relaxing ramp cannot be taken apart: two of them coincide")]
    NotSolved,
    /// No mode of the ramp moves a contact point.
    #[error("no mode of the ramp moves its {side} contact point: use a rigid ramp")]
    CannotMove {
        /// Which arm.
        side: &'static str,
    },
}

/// Name, value, whether it is in range, the range in words: the first that is not.
pub(super) fn first_fault(
    checks: &[(&'static str, f64, bool, &'static str)],
) -> Result<(), RampError> {
    let fault = checks
        .iter()
        .find(|(_, value, ok, _)| !(*ok && value.is_finite()));
    match fault {
        Some(&(name, value, _, allowed)) => Err(RampError::Parameter {
            name,
            value,
            allowed,
        }),
        None => Ok(()),
    }
}
