//! Base-acceleration pulses: shape, width, events, closed-form modal forcing.
//!
//! Every shape is a sequence of intervals, in each of which
//!
//! ```text
//! s(t) = c₀ + c₁ τ + Re(C e^{στ}),   τ = t − start of the interval
//! ```
//!
//! so that the response of a linear mode has a closed form in each ([`crate::modal::forcing`]).
//!
//! | shape        | σ              | C    | c₀, c₁              |
//! |--------------|----------------|------|---------------------|
//! | half-sine    | iπ/T           | −i   | 0                   |
//! | haversine    | i2π/T          | −½   | ½, 0                |
//! | square       |                | 0    | 1, 0                |
//! | trapezoid    |                | 0    | piecewise linear    |
//! | damped sine  | −d + i2πf      | −i   | 0                   |
//! | table        |                | 0    | piecewise linear    |

use crate::modal::Phase;
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Shape of the unit pulse s(t), 0 <= t <= width, with max |s| = 1.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
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
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Pulse {
    /// Shape.
    pub shape: PulseShape,
    /// Width T, s.
    pub width_s: f64,
}

/// An interval of a pulse with one closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Start, s after the onset.
    pub start_s: f64,
    /// End, s after the onset.
    pub end_s: f64,
    /// Rate σ of the wave, 1/s.
    pub sigma_per_s: Complex<f64>,
    /// Forcing at the start.
    pub phase: Phase,
}

/// Further excitation of the base in proportion to a(t), while the pulse shakes it along the axis.
///
/// Axes are fixed in the drive: x at angle 0 of the disk, y a quarter turn on in the sense of growing angle. Signs are
/// those of a(t), the load felt in the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ObliqueShock {
    /// In-plane loads per mass along x and y per unit a(t).
    pub in_plane: [f64; 2],
    /// Felt angular accelerations about x and y per unit a(t), 1/m.
    pub rotation_per_m: [f64; 2],
}

impl ObliqueShock {
    /// Axial load per mass at a place on the drive per unit a(t): 1 + ρ_x y − ρ_y x.
    pub fn axial_at(&self, radius_m: f64, angle_rad: f64) -> f64 {
        let (sine, cosine) = angle_rad.sin_cos();
        let [about_x, about_y] = self.rotation_per_m;
        1.0 + radius_m * (about_x * sine - about_y * cosine)
    }

    /// Whether every share is a finite number.
    pub fn is_finite(&self) -> bool {
        let shares = self.in_plane.iter().chain(&self.rotation_per_m);
        shares.into_iter().all(|x| x.is_finite())
    }
}

/// Errors of a pulse's description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PulseError {
    /// The width is not a positive number.
    #[error("pulse width {0:e} s is not a positive number")]
    Width(f64),
    /// A parameter of the shape is outside its range.
    #[error("pulse parameter {name} = {value:e} is outside its range ({allowed})")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// A row of a sampled pulse cannot be used.
    #[error("row {row} of the sampled pulse: {fault}")]
    Row {
        /// Row, from 0.
        row: usize,
        /// What is wrong.
        fault: &'static str,
    },
}

impl Pulse {
    /// Intervals in order, from 0 to the width.
    ///
    /// # Errors
    /// A width or parameter out of range, a table that does not rise from 0 to the width.
    pub fn stretches(&self) -> Result<Vec<Stretch>, PulseError> {
        let width = self.width_s;
        if !(width.is_finite() && width > 0.0) {
            return Err(PulseError::Width(width));
        }
        let wave = |sigma: Complex<f64>, amplitude: Complex<f64>, constant: f64| {
            vec![Stretch {
                start_s: 0.0,
                end_s: width,
                sigma_per_s: sigma,
                phase: Phase {
                    constant,
                    slope_per_s: 0.0,
                    wave: amplitude,
                },
            }]
        };
        let minus_i = Complex::new(0.0, -1.0);
        Ok(match &self.shape {
            PulseShape::HalfSine => wave(Complex::new(0.0, PI / width), minus_i, 0.0),
            PulseShape::Haversine => wave(Complex::new(0.0, TAU / width), Complex::from(-0.5), 0.5),
            PulseShape::Square => wave(Complex::from(0.0), Complex::from(0.0), 1.0),
            &PulseShape::Trapezoid { rise_share } => {
                if !(rise_share > 0.0 && rise_share <= 0.5) {
                    return Err(PulseError::Parameter {
                        name: "rise_share",
                        value: rise_share,
                        allowed: "above 0, at most 0.5",
                    });
                }
                let rise = rise_share * width;
                piecewise_linear(&[0.0, rise, width - rise, width], &[0.0, 1.0, 1.0, 0.0])
            }
            &PulseShape::DampedSine {
                frequency_hz,
                decay_per_s,
            } => {
                for (name, value) in [("frequency_hz", frequency_hz), ("decay_per_s", decay_per_s)]
                {
                    if !(value.is_finite() && value >= 0.0) {
                        return Err(PulseError::Parameter {
                            name,
                            value,
                            allowed: "finite and at least 0",
                        });
                    }
                }
                wave(Complex::new(-decay_per_s, TAU * frequency_hz), minus_i, 0.0)
            }
            PulseShape::Table { time_s, relative } => {
                check_table(time_s, relative, width)?;
                piecewise_linear(time_s, relative)
            }
        })
    }

    /// ∫ s dt over the width, s: times an amplitude it is the velocity change of the base.
    ///
    /// # Errors
    /// As [`Pulse::stretches`].
    pub fn integral_s(&self) -> Result<f64, PulseError> {
        let stretches = self.stretches()?;
        let over = stretches.iter().map(|stretch| {
            let length_s = stretch.end_s - stretch.start_s;
            let (phase, sigma) = (&stretch.phase, stretch.sigma_per_s);
            let wave = match sigma.norm() {
                0.0 => phase.wave.re * length_s,
                _ => (phase.wave * ((sigma * length_s).exp() - 1.0) / sigma).re,
            };
            (phase.constant + 0.5 * phase.slope_per_s * length_s) * length_s + wave
        });
        Ok(over.sum())
    }

    /// s(t); zero outside the pulse.
    pub fn value(&self, time_s: f64) -> f64 {
        if !(0.0..=self.width_s).contains(&time_s) {
            return 0.0;
        }
        let t = time_s;
        match &self.shape {
            PulseShape::HalfSine => (PI * t / self.width_s).sin(),
            PulseShape::Haversine => (PI * t / self.width_s).sin().powi(2),
            PulseShape::Square => 1.0,
            &PulseShape::Trapezoid { rise_share } => {
                let edge = t.min(self.width_s - t) / (rise_share * self.width_s);
                edge.clamp(0.0, 1.0)
            }
            &PulseShape::DampedSine {
                frequency_hz,
                decay_per_s,
            } => (-decay_per_s * t).exp() * (TAU * frequency_hz * t).sin(),
            PulseShape::Table { time_s, relative } => {
                let k = time_s
                    .partition_point(|&x| x <= t)
                    .clamp(1, time_s.len() - 1);
                let share = (t - time_s[k - 1]) / (time_s[k] - time_s[k - 1]);
                relative[k - 1] + share * (relative[k] - relative[k - 1])
            }
        }
    }
}

fn piecewise_linear(time_s: &[f64], value: &[f64]) -> Vec<Stretch> {
    time_s
        .windows(2)
        .zip(value.windows(2))
        .filter(|(t, _)| t[1] > t[0])
        .map(|(t, v)| Stretch {
            start_s: t[0],
            end_s: t[1],
            sigma_per_s: Complex::from(0.0),
            phase: Phase {
                constant: v[0],
                slope_per_s: (v[1] - v[0]) / (t[1] - t[0]),
                wave: Complex::from(0.0),
            },
        })
        .collect()
}

fn check_table(time_s: &[f64], relative: &[f64], width_s: f64) -> Result<(), PulseError> {
    let row = |row, fault| Err(PulseError::Row { row, fault });
    if time_s.len() < 2 {
        return row(time_s.len(), "fewer than 2 rows");
    }
    if time_s.len() != relative.len() {
        return row(
            time_s.len().min(relative.len()),
            "times and values differ in number",
        );
    }
    for (k, (t, v)) in time_s.iter().zip(relative).enumerate() {
        if !t.is_finite() || !v.is_finite() {
            return row(k, "not a finite number");
        }
        if k > 0 && *t <= time_s[k - 1] {
            return row(k, "time does not rise");
        }
    }
    if time_s[0] != 0.0 {
        return row(0, "the first time is not 0");
    }
    if time_s[time_s.len() - 1] != width_s {
        return row(time_s.len() - 1, "the last time is not the width");
    }
    Ok(())
}
