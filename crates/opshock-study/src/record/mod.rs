//! Processes and judges measured accelerations: filter, offset, durations, half-sine tolerances, shock response spectrum.
//!
//! Plain numbers in SI; no files. What a study file asks for is brought together in
//! [`study::measured_pulse`](crate::study::measured_pulse).

mod filter;
mod half_sine;
mod measures;
mod shock_response;

pub use filter::{Filter, FilterError, phaseless};
pub use half_sine::{AMPLITUDE_TOLERANCE, HalfSine, Outside, VELOCITY_TOLERANCE};
pub use measures::{Line, Record};
pub use shock_response::{Response, octave_frequencies_hz, shock_response_spectrum};
