//! Modes of base plate and housing under the shock, and the loads that they pass on.
//!
//! ```text
//! M q̈ + D q̇ + K q = f a(t),   u = Σ φ q at a mount,   b(t) = a(t) − ü felt there
//! ```
//!
//! | symbol | what | unit |
//! |---|---|---|
//! | q | modes of the base, then those of what rides on its spindle, unit modal mass each | m √kg |
//! | M | 1, and φ Γ between a mode of the base and a rider | 1 |
//! | D, K | 2 ζ ω and ω² of each | 1/s, 1/s² |
//! | f | load per unit inertia load: p of the base's modes, Γ of the riders | √kg |
//! | φ | displacement of a mount, along the disk's axis | 1/√kg |
//!
//! u is measured from the base as it would move rigidly. The base's modes are those with all that stands on it
//! as masses; riders, the axisymmetric modes of the disk, then add their motion over the spindle. In
//! first-order form η̇ = λ η + w a, u = Re Σ s η, and on a stretch with a = c₀ + c₁ τ + Re(C e^{στ})
//!
//! ```text
//! η = −w (c₀ + c₁ τ + c₁/λ)/λ + w/2 [C e^{στ}/(σ − λ) + C̄ e^{σ̄τ}/(σ̄ − λ)] + B e^{λτ}
//! b = c₀ + c₁ τ + Re(G C e^{στ}) − Σ Re(s λ² B e^{λτ}),   G = 1 − Σ ½ [s w σ²/(σ − λ) + s̄ w̄ σ²/(σ − λ̄)]
//! ```
//!
//! with B from η at the stretch's start; after the pulse the base rings on, with c₀ = c₁ = C = 0. A mode at the
//! pulse's own rate would make both terms infinite; its rate is then moved by 1e-6 of itself. Modes above half a
//! turn a step are left out: a base that stiff is rigid.
//!
//! So base and disk are coupled before any contact. Left out: what contact, ramp and suspension do to the base,
//! tilt and in-plane motion of the mounts.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;

use super::Stretch;
use crate::linalg::DenseError;
use crate::modal::{CoupledModes, CoupledSystem, Phase};

/// Relative distance of a mode's rate from the pulse's below which the mode is moved.
const CLOSEST: f64 = 1e-6;
/// Largest |λ| Δt of a mode.
const FASTEST_ANGLE: f64 = PI;
/// Largest ω Δt of a mode of the base that is coupled with the others at all: rounding beside faster ones would
/// show in the slow ones.
const FASTEST_COUPLED: f64 = 1e3 * PI;

/// A mode of base plate and housing, of unit modal mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseMode {
    /// Undamped frequency, Hz.
    pub frequency_hz: f64,
    /// Damping ratio, at least 0, below 1.
    pub damping_ratio: f64,
    /// Load by a unit inertia load per mass, p, √kg.
    pub participation_sqrt_kg: f64,
    /// Displacement of the spindle, φ, 1/√kg.
    pub spindle_per_sqrt_kg: f64,
    /// Displacement of the ramp's mount, 1/√kg.
    pub ramp_per_sqrt_kg: f64,
    /// Displacement of the actuator's pivot, which carries the suspension, 1/√kg.
    pub pivot_per_sqrt_kg: f64,
}

/// An oscillator on the spindle, of unit modal mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rider {
    /// Undamped frequency, rad/s.
    pub omega_rad_per_s: f64,
    /// Damping, 2 ζ ω, 1/s.
    pub damping_per_s: f64,
    /// Load by a unit acceleration of the spindle, Γ, √kg.
    pub participation_sqrt_kg: f64,
}

impl BaseMode {
    /// Whether the mode can move: numbers finite, a frequency above 0, a damping ratio in [0, 1).
    pub fn is_sound(&self) -> bool {
        let numbers = [
            self.participation_sqrt_kg,
            self.spindle_per_sqrt_kg,
            self.ramp_per_sqrt_kg,
            self.pivot_per_sqrt_kg,
        ];
        self.frequency_hz.is_finite()
            && self.frequency_hz > 0.0
            && (0.0..1.0).contains(&self.damping_ratio)
            && numbers.iter().all(|x| x.is_finite())
    }
}

/// What is mounted on the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// Disk.
    Spindle = 0,
    /// Ramp.
    Ramp = 1,
    /// Arm and suspension.
    Pivot = 2,
}

/// Motion of a base under the unit pulse.
#[derive(Clone, Debug)]
pub struct BaseMotion {
    modes: Vec<Swing>,
    segments: Vec<Segment>,
}

/// A mode of first order.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// λ.
    rate_per_s: Complex<f64>,
    /// w.
    entrance: Complex<f64>,
    /// What reads u at each mount, s, and u̇.
    shape: [Complex<f64>; 3],
    velocity: [Complex<f64>; 3],
}

impl Swing {
    /// η that the pulse alone asks for, `tau_s` into a stretch.
    fn forced(&self, stretch: &Stretch, tau_s: f64) -> Complex<f64> {
        let (
            Phase {
                constant,
                slope_per_s,
                wave,
            },
            sigma,
        ) = (stretch.phase, stretch.sigma_per_s);
        let rate = self.rate_per_s;
        let held = (rate.inv() * slope_per_s + (constant + slope_per_s * tau_s)) / rate;
        let mut sum = -held;
        for (wave, sigma) in [(wave, sigma), (wave.conj(), sigma.conj())] {
            if wave != Complex::default() {
                sum += wave * (sigma * tau_s).exp() / (sigma - rate) * 0.5;
            }
        }
        self.entrance * sum
    }
}

/// The pulse from one kink to the next, and what rings freely meanwhile.
#[derive(Clone, Debug)]
struct Segment {
    stretch: Stretch,
    /// B of every mode.
    free: Vec<Complex<f64>>,
}

impl BaseMotion {
    /// Motion of `base` with `riders` on its spindle, at rest at the onset, under the stretches of a pulse.
    ///
    /// # Errors
    /// Riders heavier than the base's modes; modes that cannot be taken apart.
    pub fn new(
        base: &[BaseMode],
        riders: &[Rider],
        stretches: &[Stretch],
        step_s: f64,
    ) -> Result<Self, DenseError> {
        let modes = swings(base, riders, stretches, step_s)?;
        let after = Stretch {
            start_s: stretches.last().map_or(0.0, |last| last.end_s),
            end_s: f64::INFINITY,
            sigma_per_s: Complex::from(0.0),
            phase: Phase::default(),
        };
        let mut segments = Vec::with_capacity(stretches.len() + 1);
        let mut start = vec![Complex::default(); modes.len()];
        for stretch in stretches.iter().chain([&after]) {
            let ringing = modes.iter().zip(&start);
            let segment = Segment {
                stretch: *stretch,
                free: ringing
                    .map(|(mode, eta)| eta - mode.forced(stretch, 0.0))
                    .collect(),
            };
            if stretch.end_s.is_finite() {
                let tau_s = stretch.end_s - stretch.start_s;
                for (k, (eta, mode)) in start.iter_mut().zip(&modes).enumerate() {
                    *eta = segment.state(mode, k, tau_s);
                }
            }
            segments.push(segment);
        }
        Ok(Self { modes, segments })
    }

    /// Number of modes of first order.
    pub fn n_modes(&self) -> usize {
        self.modes.len()
    }

    /// λ of mode `k`, 1/s.
    pub fn rate_per_s(&self, k: usize) -> Complex<f64> {
        self.modes[k].rate_per_s
    }

    /// G: what becomes of a wave of the pulse at a mount while it lasts.
    pub fn gain(&self, mount: Mount, sigma_per_s: Complex<f64>) -> Complex<f64> {
        let square = sigma_per_s * sigma_per_s;
        let passed = self.modes.iter().map(|mode| {
            let strength = mode.shape[mount as usize] * mode.entrance;
            let rate = mode.rate_per_s;
            let both =
                strength / (sigma_per_s - rate) + strength.conj() / (sigma_per_s - rate.conj());
            both * square * 0.5
        });
        match sigma_per_s == Complex::default() {
            true => Complex::from(1.0),
            false => Complex::from(1.0) - passed.sum::<Complex<f64>>(),
        }
    }

    /// Load that the ringing of mode `k` adds at a mount, as the wave e^{λτ} from `time_s` on.
    pub fn wave(&self, mount: Mount, k: usize, time_s: f64) -> Complex<f64> {
        let mode = &self.modes[k];
        let segment = self.segment(time_s);
        let rate = mode.rate_per_s;
        let ringing = segment.free[k] * (rate * (time_s - segment.stretch.start_s)).exp();
        -(mode.shape[mount as usize] * ringing * rate * rate)
    }

    /// Displacement of a mount over the rigid base per unit amplitude, s², and its rate.
    pub fn displacement(&self, mount: Mount, time_s: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (mode, eta) in self.states(time_s) {
            sum[0] += (mode.shape[mount as usize] * eta).re;
            sum[1] += (mode.velocity[mount as usize] * eta).re;
        }
        sum
    }

    /// b where the pulse is `value` at `time_s`: at a jump of the pulse of either side.
    pub fn load(&self, mount: Mount, time_s: f64, value: f64) -> f64 {
        let accelerations = self.states(time_s).map(|(mode, eta)| {
            let rate = mode.rate_per_s * eta + mode.entrance * value;
            (mode.velocity[mount as usize] * rate).re
        });
        value - accelerations.sum::<f64>()
    }

    fn segment(&self, time_s: f64) -> &Segment {
        let ended = |segment: &Segment| segment.stretch.end_s <= time_s;
        &self.segments[self.segments.partition_point(ended)]
    }

    /// Every mode with its η.
    fn states(&self, time_s: f64) -> impl Iterator<Item = (&Swing, Complex<f64>)> {
        let segment = self.segment(time_s);
        let tau_s = time_s - segment.stretch.start_s;
        let modes = self.modes.iter().enumerate();
        modes.map(move |(k, mode)| (mode, segment.state(mode, k, tau_s)))
    }
}

impl Segment {
    fn state(&self, mode: &Swing, k: usize, tau_s: f64) -> Complex<f64> {
        mode.forced(&self.stretch, tau_s) + self.free[k] * (mode.rate_per_s * tau_s).exp()
    }
}

/// Base and riders taken apart.
fn swings(
    base: &[BaseMode],
    riders: &[Rider],
    stretches: &[Stretch],
    step_s: f64,
) -> Result<Vec<Swing>, DenseError> {
    let is_slow = |mode: &&BaseMode| TAU * mode.frequency_hz * step_s < FASTEST_COUPLED;
    let base: Vec<BaseMode> = base.iter().filter(is_slow).copied().collect();
    let of_base = base.iter().map(|mode| {
        let omega = TAU * mode.frequency_hz;
        let damping = 2.0 * mode.damping_ratio * omega;
        (omega, damping, mode.participation_sqrt_kg)
    });
    let of_riders = riders.iter().map(|rider| {
        let gain = rider.participation_sqrt_kg;
        (rider.omega_rad_per_s, rider.damping_per_s, gain)
    });
    let all: Vec<(f64, f64, f64)> = of_base.chain(of_riders).collect();
    let mut system = CoupledSystem::zeros(all.iter().map(|(omega, ..)| omega * omega).collect());
    for (i, (omega, damping, _)) in all.iter().enumerate() {
        system.mass.add(i, i, 1.0);
        system.damping.add(i, i, *damping);
        system.stiffness.add(i, i, omega * omega);
    }
    for (k, mode) in base.iter().enumerate() {
        for (j, rider) in riders.iter().enumerate() {
            let coupling = mode.spindle_per_sqrt_kg * rider.participation_sqrt_kg;
            system.mass.add(k, base.len() + j, coupling);
            system.mass.add(base.len() + j, k, coupling);
        }
    }
    let modes = CoupledModes::below(system, FASTEST_ANGLE / step_s)?;
    let real = |x: f64| Complex::from(x);
    let loads: Vec<Complex<f64>> = all.iter().map(|(.., gain)| real(*gain)).collect();
    let entrance = modes.entrance(&loads);
    let readouts = [Mount::Spindle, Mount::Ramp, Mount::Pivot].map(|mount| {
        let mut weights = vec![real(0.0); all.len()];
        for (weight, mode) in weights.iter_mut().zip(&base) {
            *weight = real(match mount {
                Mount::Spindle => mode.spindle_per_sqrt_kg,
                Mount::Ramp => mode.ramp_per_sqrt_kg,
                Mount::Pivot => mode.pivot_per_sqrt_kg,
            });
        }
        modes.readout(&weights)
    });
    let swing = |(k, rate): (usize, &Complex<f64>)| {
        let is_met = |s: &Stretch| {
            let sigma = Complex::new(s.sigma_per_s.re, s.sigma_per_s.im.abs());
            (rate - sigma).norm() < CLOSEST * rate.norm()
        };
        let moved = match stretches.iter().any(is_met) {
            true => 1.0 + 2.0 * CLOSEST,
            false => 1.0,
        };
        // A readout holds Re(z̄ η) as (re, im) of z.
        let row = |of: &crate::modal::Readout| Complex::new(of.re[k], -of.im[k]);
        Swing {
            rate_per_s: rate * moved,
            entrance: Complex::new(entrance.re[k], entrance.im[k]),
            shape: [0, 1, 2].map(|m| row(&readouts[m].position)),
            velocity: [0, 1, 2].map(|m| row(&readouts[m].velocity)),
        }
    };
    Ok(modes.rates_per_s().iter().enumerate().map(swing).collect())
}
