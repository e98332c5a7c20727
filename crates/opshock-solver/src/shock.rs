//! Base-acceleration pulses: shape, width, events, closed-form modal forcing.

/// Shape of the unit pulse s(t), 0 <= t <= width, with max |s| = 1.
#[derive(Clone, Debug, PartialEq)]
pub enum PulseShape {
    /// s = sin(pi t / T).
    HalfSine,
    /// s = sin^2(pi t / T).
    Haversine,
    /// s = 1.
    Square,
    /// Linear rise, plateau, linear fall.
    Trapezoid {
        /// Rise time as a share of the width, 0 < share <= 0.5; the fall is the same.
        rise_share: f64,
    },
    /// s = exp(-decay t) sin(2 pi f t), cut at the width.
    DampedSine {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Decay rate, 1/s.
        decay_per_s: f64,
    },
    /// Piecewise linear through samples; times rise from 0 to the width.
    Table {
        /// Sample times since the onset, s.
        time_s: Vec<f64>,
        /// Relative acceleration at the samples, dimensionless.
        relative: Vec<f64>,
    },
}

/// One unit pulse. Time 0 is its onset.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulse {
    /// Shape.
    pub shape: PulseShape,
    /// Width T, s.
    pub width_s: f64,
}
