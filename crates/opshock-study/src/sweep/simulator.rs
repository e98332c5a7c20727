//! Interface of a sweep to the physics: a verdict for an amplitude, and the amplitude of first touch.

use opshock_solver::simulation::Outcome;

use crate::search::{Probe, ProbeResult};

/// Runs simulations for the points of a study, by their place in the study.
///
/// Answers depend on the point and the probe alone: the same request gives the same bits on every thread and at every
/// time. Calls come from several threads at once. A panic inside is caught by the sweep and becomes an undecided run of
/// that probe alone.
pub trait Simulator: Sync {
    /// Simulates `probe` of point `point` at the signed amplitude.
    ///
    /// `amplitude_m_per_s2` carries the point's sign and equals the amplitude of grid point `probe.index`.
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult;

    /// Smallest amplitude, m/s2 (positive), at which the disk touches the ramp of `point` within
    /// the window; below it the answers are those of the same scene without ramp.
    fn onset(&self, point: usize) -> Onset;

    /// Runs a probe once more with its histories recorded; `None` when there are none to record.
    fn record(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> Option<Outcome> {
        let _ = (point, probe, amplitude_m_per_s2);
        None
    }
}

/// First touch of disk and ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Onset {
    /// No ramp in the scene.
    NoRamp,
    /// Touch at this amplitude, m/s2, and above.
    At {
        /// Positive amplitude, m/s2.
        amplitude_m_per_s2: f64,
    },
    /// Not known; nothing is taken from the no-ramp answer.
    Unknown,
}
