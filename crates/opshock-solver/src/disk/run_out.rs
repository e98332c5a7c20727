//! Models run-out and waviness: a shape of the disk's surface that rotates with it under the slider.
//!
//! ```text
//! w(r, θ, t) = Σ a_i(r) cos(k_i (θ − Ω t) + φ_i),    a_i(r) = amplitude, or amplitude r/b
//! ```
//!
//! Under the slider the surface is replaced by its tangent plane at the slider's centre: displacement, pitch and roll,
//! each a sum of harmonic motions at k_i Ω. That leaves out the surface's curvature over the slider, a share 1 − cos(π
//! L/λ) of the amplitude at the ends of a slider of length L under a wave of length λ. The shape is that of the
//! spinning disk: it drives none of its modes.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | k | `harmonic` | 1 |
//! | φ | `phase_rad` | rad |
//! | Ω | `spin_rad_per_s` | rad/s |
//! | b | `outer_radius_m` | m |

use super::motion::{DiskMotion, DiskPose};
use nalgebra::Complex;

/// One wave around the disk.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Wave {
    /// Waves per revolution.
    pub harmonic: u32,
    /// Amplitude, m: at every radius, or at the rim where it grows with the radius.
    pub amplitude_m: f64,
    /// Phase at angle 0 at the onset of the shock, rad.
    pub phase_rad: f64,
    /// Whether the amplitude grows with the radius from 0 at the axis, as that of a tilted disk.
    pub grows_with_radius: bool,
}

impl Wave {
    /// Amplitude at a radius and its derivative by the radius.
    fn at(&self, radius_m: f64, outer_radius_m: f64) -> [f64; 2] {
        match self.grows_with_radius {
            true => {
                let slope = self.amplitude_m / outer_radius_m;
                [slope * radius_m, slope]
            }
            false => [self.amplitude_m, 0.0],
        }
    }
}

/// Place of the slider on the surface, and the speed of the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Track {
    /// Radius of the slider's centre, m.
    pub radius_m: f64,
    /// Its angle in the sense of growing θ, rad.
    pub angle_rad: f64,
    /// Skew, rad.
    pub skew_rad: f64,
    /// Radius of the rim, m.
    pub outer_radius_m: f64,
    /// Spin, rad/s.
    pub spin_rad_per_s: f64,
}

/// Harmonic motion of the plane under the slider: Re(`pose` e^{iωt}), pose as displacement (m), pitch and
/// roll (rad).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// ω, rad/s.
    pub omega_rad_per_s: f64,
    /// Complex amplitudes.
    pub pose: [Complex<f64>; 3],
}

/// The surface's motion under one slider.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceMotion {
    swings: Vec<Swing>,
}

impl SurfaceMotion {
    /// The motion by `waves` under a slider on `track`.
    pub fn new(waves: &[Wave], track: &Track) -> Self {
        let sense = if track.spin_rad_per_s < 0.0 {
            -1.0
        } else {
            1.0
        };
        let (sine, cosine) = track.skew_rad.sin_cos();
        let swings = waves.iter().map(|wave| {
            let k = f64::from(wave.harmonic);
            let [value, outwards] = wave.at(track.radius_m, track.outer_radius_m);
            // cos(k θ − k Ω t + φ) = Re(conj(e^{i(k θ + φ)}) e^{i k Ω t}).
            let turn = Complex::from_polar(1.0, -(k * track.angle_rad + wave.phase_rad));
            // ∂/∂θ of the conjugate, along the disk's velocity.
            let along = turn * Complex::new(0.0, -k * value * sense / track.radius_m);
            let outwards = turn * outwards;
            Swing {
                omega_rad_per_s: k * track.spin_rad_per_s,
                pose: [
                    turn * value,
                    outwards * sine - along * cosine,
                    outwards * cosine + along * sine,
                ],
            }
        });
        Self {
            swings: swings.collect(),
        }
    }

    /// Its harmonic parts.
    pub fn swings(&self) -> &[Swing] {
        &self.swings
    }

    /// Pose, or its rate, at a time after the onset.
    fn sum(&self, time_s: f64, factor: impl Fn(f64) -> Complex<f64>) -> DiskPose {
        let mut out = [0.0; 3];
        for swing in &self.swings {
            let turn = Complex::from_polar(1.0, swing.omega_rad_per_s * time_s)
                * factor(swing.omega_rad_per_s);
            for (out, pose) in out.iter_mut().zip(swing.pose) {
                *out += (pose * turn).re;
            }
        }
        DiskPose {
            displacement_m: out[0],
            pitch_rad: out[1],
            roll_rad: out[2],
        }
    }
}

/// A disk that moves as `under`, with the motion of its surface added.
pub struct WavyDisk<'a> {
    /// Motion of the disk.
    pub under: &'a dyn DiskMotion,
    /// Motion of its surface under the slider.
    pub surface: &'a SurfaceMotion,
}

impl DiskMotion for WavyDisk<'_> {
    fn pose(&self, time_s: f64) -> DiskPose {
        let surface = self.surface.sum(time_s, |_| Complex::new(1.0, 0.0));
        self.under.pose(time_s).plus(&surface)
    }

    fn pose_rate(&self, time_s: f64) -> DiskPose {
        let surface = self.surface.sum(time_s, |omega| Complex::new(0.0, omega));
        self.under.pose_rate(time_s).plus(&surface)
    }

    fn events_s(&self) -> &[f64] {
        self.under.events_s()
    }

    fn pivot(&self, time_s: f64) -> [f64; 2] {
        self.under.pivot(time_s)
    }
}
