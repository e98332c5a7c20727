//! Errors of building a suspension.

use thiserror::Error;

/// Why a suspension cannot be built.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SuspensionError {
    /// A dimension, density or modulus is not a positive finite number.
    #[error("{quantity} must be positive, found {value}")]
    NotPositive {
        /// Which one.
        quantity: &'static str,
        /// Its value, SI.
        value: f64,
    },
    /// Places along the beam are not in the order they have to be in.
    #[error("{first} ({first_m} m) must lie before {second} ({second_m} m)")]
    OutOfOrder {
        /// The place that must come first.
        first: &'static str,
        /// Its distance from the root, m.
        first_m: f64,
        /// The place that must come second.
        second: &'static str,
        /// Its distance from the root, m.
        second_m: f64,
    },
    /// A stiffness or mass matrix is not positive definite.
    #[error("the suspension's {matrix} matrix is not positive definite")]
    Singular {
        /// Which matrix.
        matrix: &'static str,
    },
    /// A mode that bends and twists.
    #[error("suspension mode {mode} moves z and roll of the dimple at once")]
    Coupled {
        /// Which one, from 0.
        mode: usize,
    },
    /// A lift tab on a suspension that is given by its modes.
    #[error("modes of a suspension say nothing of its lift tab")]
    NoTab,
    /// No mode moves the dimple that way.
    #[error("no suspension mode moves the {what} of the dimple")]
    Unmoved {
        /// `z` or `roll`.
        what: &'static str,
    },
    /// More modes are wanted than the elements have.
    #[error("{wanted} suspension modes wanted, the elements have {available}")]
    TooManyModes {
        /// Wanted.
        wanted: usize,
        /// Available.
        available: usize,
    },
}
