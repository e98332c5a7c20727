//! Errors of the search for a steady state of film and slider.

use super::attitude::Attitude;
use crate::linalg::banded::BandedError;
use std::fmt;
use thiserror::Error;

/// Why no steady state was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SteadyError {
    /// The flux Jacobian could not be factored.
    #[error("the film's Jacobian could not be factored: {0}")]
    Singular(#[from] BandedError),
    /// Newton's method came to an end without converging.
    #[error("no steady state within {iterations} iterations; last attitude {attitude:?}")]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Last attitude reached.
        attitude: Attitude,
    },
    /// The slider flies without surface forces; with all of them it is pulled onto the disk.
    #[error(
        "surface forces pull the slider onto the disk, {share:.3} of them is the most under which it \
         flies; without them it flies at {without_m:e} m"
    )]
    PulledIn {
        /// Share of the surface forces to which a flight could be followed, within a thousandth.
        share: f64,
        /// Smallest clearance without surface forces, m.
        without_m: f64,
    },
    /// The film carries less than the load: no stable equilibrium has a clearance.
    #[error(
        "the slider cannot fly under {:.4} mN: its film carries {:.4} mN at most, at a clearance of {:.3} nm; \
         followed from lighter loads, {ends}", 1e3 * load_n, 1e3 * carried_n, 1e9 * clearance_m
    )]
    CannotFly {
        /// The load, N.
        load_n: f64,
        /// The largest load of a stable flight, to about a thousandth of the load, N.
        carried_n: f64,
        /// Smallest clearance of that flight, m.
        clearance_m: f64,
        /// How the flights end there.
        ends: FlightsEnd,
    },
    /// The only equilibria found are unstable.
    #[error("the equilibrium at {attitude:?} is not stable")]
    Unstable {
        /// Its attitude.
        attitude: Attitude,
    },
}

/// How the stable flights under growing loads end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlightsEnd {
    /// At a limit point: no flight next to the last one carries more.
    AtLimitPoint,
    /// At the minimum film height: the next one has less clearance.
    AtMinimumHeight,
}

impl fmt::Display for FlightsEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtLimitPoint => "its flights end at a limit point of the load",
            Self::AtMinimumHeight => "its flights end at the minimum film height",
        })
    }
}
