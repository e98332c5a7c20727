//! Collects the modes of disk, ramp arms and contact springs into one bank of oscillators, stored as columns.

use super::forced_modes::{ForcedModes, ForcedShapes};
use super::parameters::{ContactMethod, SliderPlace};
use super::rotor::RidingMode;
use crate::disk::{DiskMode, DiskParameters, DiskPose};
use crate::modal::bank::padded;
use crate::modal::{Oscillator, Readout};
use crate::ramp::{ContactMode, RampBody, RampParameters};
use std::ops::Range;

/// Largest ω Δt of an arm mode: exact flow and quadrature then keep all digits.
const FASTEST_ARM_ANGLE: f64 = 1.5;

/// The spring of a contact, which is one more mode of its arm.
#[derive(Clone, Copy)]
pub(super) struct Spring {
    frequency_hz: f64,
    mass_kg: f64,
    damping_ratio: f64,
}

impl Spring {
    /// The spring of `ramp` if it has one. The exact flow applies a force as impulses, one per step. At those instants
    /// the spring is shorter than on average by a share 1 − [`Oscillator::train_share`]; its mass is chosen to
    /// compensate for that, so that a lasting contact has the given stiffness at the nodes of the time grid.
    pub fn of(ramp: &RampParameters, method: ContactMethod, step_s: f64) -> Option<Self> {
        let stiffness_n_per_m = ramp.contact_stiffness_n_per_m?;
        let (frequency_hz, damping_ratio) = (ramp.contact_frequency_hz, ramp.contact_damping_ratio);
        let resolved_hz = frequency_hz.min(fastest_arm_hz(step_s));
        let share = match method {
            ContactMethod::ExactFlow => {
                let omega = std::f64::consts::TAU * resolved_hz;
                Oscillator::fixed(omega, damping_ratio).train_share(step_s)
            }
            ContactMethod::MoreauJean => 1.0,
        };
        (!ramp.model.is_absent()).then_some(Self {
            frequency_hz,
            mass_kg: share * stiffness_n_per_m / (std::f64::consts::TAU * frequency_hz).powi(2),
            damping_ratio,
        })
    }

    fn at_contact(self, shape: [f64; 2]) -> ContactMode {
        ContactMode {
            frequency_hz: self.frequency_hz,
            mass_kg: self.mass_kg,
            shape,
            participation: 0.0,
            damping_ratio: self.damping_ratio,
        }
    }
}

/// Frequency of the fastest arm mode that the steps resolve, Hz.
fn fastest_arm_hz(step_s: f64) -> f64 {
    FASTEST_ARM_ANGLE / (std::f64::consts::TAU * step_s)
}

/// One arm in the bank of oscillators.
#[derive(Clone)]
pub(super) struct Arm {
    /// Indices of its modes in the bank.
    pub modes: Range<usize>,
}

/// Columns over all oscillators while they are collected.
pub(super) struct Bank {
    pub oscillators: Vec<Oscillator>,
    pub n_disk: usize,
    pub forced: ForcedModes,
    pub forced_index: Vec<usize>,
    pub shapes: ForcedShapes,
    pub contact: Vec<f64>,
    pub contact_turn: Vec<f64>,
    pub arm_shape: [Vec<f64>; 2],
    /// Bank index of the mode of each contact's spring; none of hard contacts.
    pub springs: Vec<usize>,
    pub n_slowed: usize,
    pub rim: Vec<f64>,
    pub slider: [Readout; 3],
    pub slope_to_pose: [f64; 2],
    /// Modes of arms that the rotor carries because a vibrating base shakes them or their stiffness relaxes; `None` for
    /// elastic arms on a rigid base.
    pub riding: Option<Vec<RidingMode>>,
}

impl Bank {
    /// Disk modes. Angles are measured from the ramp, so that the contact force drives real parts.
    pub fn new(
        modes: &[DiskMode],
        disk: &DiskParameters,
        slider: SliderPlace,
        ramp_angle: f64,
        has_riding: bool,
    ) -> Self {
        let n_disk = padded(modes.len());
        let zero = || vec![0.0; n_disk];
        // x runs with the disk; with negative spin it runs against growing angle.
        let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
        let [pitch, roll] = slider.slopes_to_pose();
        let mut bank = Self {
            oscillators: vec![Oscillator::default(); n_disk],
            n_disk,
            forced: ForcedModes::default(),
            forced_index: Vec::new(),
            shapes: ForcedShapes::default(),
            contact: zero(),
            contact_turn: zero(),
            arm_shape: [zero(), zero()],
            springs: Vec::new(),
            n_slowed: 0,
            rim: zero(),
            slider: std::array::from_fn(|_| Readout {
                re: zero(),
                im: zero(),
            }),
            slope_to_pose: [pitch[0], roll[0]],
            riding: has_riding.then(Vec::new),
        };
        for (i, mode) in modes.iter().enumerate() {
            let n = mode.nodal_diameters as f64;
            let fixed = disk.space_fixed_damping_per_s;
            let gamma = mode.damping_ratio * mode.omega_rad_per_s;
            // Without rotation both dampings are the same.
            let (gamma, fixed) = if mode.nodal_diameters == 0 {
                (gamma + 0.5 * fixed, 0.0)
            } else {
                (gamma, fixed)
            };
            bank.oscillators[i] = Oscillator {
                omega_rad_per_s: mode.omega_rad_per_s,
                half_damping_per_s: gamma,
                turn_rad_per_s: n * disk.spin_rad_per_s,
                fixed_damping_per_s: fixed,
            };
            let [(contact, _), (value, slope), (rim, _)] = mode.shape[..] else {
                unreachable!("the basis is sampled at three radii")
            };
            bank.contact[i] = contact;
            bank.contact_turn[i] = n * contact;
            bank.rim[i] = rim;
            // w = φ Re(q e^{inα}): real part of q reads cos, imaginary −sin.
            let (s, c) = (n * (slider.angle_rad - ramp_angle)).sin_cos();
            let along = sense * n * value / slider.radius_m;
            let rows = [
                (value * c, -value * s),
                (
                    pitch[0] * slope * c - pitch[1] * along * s,
                    -pitch[0] * slope * s - pitch[1] * along * c,
                ),
                (
                    roll[0] * slope * c - roll[1] * along * s,
                    -roll[0] * slope * s - roll[1] * along * c,
                ),
            ];
            for (readout, (re, im)) in bank.slider.iter_mut().zip(rows) {
                readout.re[i] = re;
                readout.im[i] = im;
            }
            // Only the contact force drives the static correction.
            if mode.nodal_diameters == 0 && mode.nodal_circles.is_some() {
                bank.forced.oscillators.push(bank.oscillators[i]);
                bank.forced.participation.push(mode.participation);
                bank.forced_index.push(i);
                bank.shapes.contact.push(contact);
                bank.shapes.rim.push(rim);
                bank.shapes.slider.push(value);
                bank.shapes.slider_slope.push(slope);
            }
        }
        bank
    }

    /// Appends the modes of a ramp and the springs of its contacts. Separate arms: the modes of each arm, then its
    /// spring. One body: all modes, then both springs.
    pub fn add_ramp(&mut self, ramp: &RampBody, spring: Option<Spring>, step_s: f64) -> [Arm; 2] {
        let springs =
            [[1.0, 0.0], [0.0, 1.0]].map(|contact| spring.map(|spring| spring.at_contact(contact)));
        if ramp.arms().is_none() {
            let springs: Vec<ContactMode> = springs.into_iter().flatten().collect();
            let arm = self.add_modes(ramp.modes(), &springs, ramp.relaxes(), step_s);
            return [arm.clone(), arm];
        }
        [0, 1].map(|side| {
            let own = |mode: &&ContactMode| mode.shape[side] != 0.0;
            let modes: Vec<ContactMode> = ramp.modes().iter().filter(own).copied().collect();
            self.add_modes(&modes, springs[side].as_slice(), ramp.relaxes(), step_s)
        })
    }

    /// Appends `modes` and `springs` behind them. A mode too fast for the step is slowed to [`FASTEST_ARM_ANGLE`] per
    /// step by adding mass. φ/ω and p/ω, that is its stiffness and its load, stay the same, and so does all slow
    /// motion.
    fn add_modes(
        &mut self,
        modes: &[ContactMode],
        springs: &[ContactMode],
        relax: bool,
        step_s: f64,
    ) -> Arm {
        let start = self.oscillators.len();
        let fastest_hz = fastest_arm_hz(step_s);
        let relaxing = modes.iter().map(|mode| (mode, relax));
        for (mode, relaxes) in relaxing.chain(springs.iter().map(|mode| (mode, false))) {
            let share = (fastest_hz / mode.frequency_hz).min(1.0);
            self.n_slowed += usize::from(share < 1.0);
            let omega = std::f64::consts::TAU * mode.frequency_hz * share;
            let o = Oscillator::fixed(omega, mode.damping_ratio);
            let gain = share * mode.participation_sqrt_kg();
            let shapes = mode.shape_per_sqrt_kg().map(|shape| share * shape);
            if self.is_riding(&o, gain, shapes, relaxes) {
                continue;
            }
            self.forced_index.push(self.oscillators.len());
            self.forced.oscillators.push(o);
            self.forced.participation.push(gain);
            self.oscillators.push(o);
            let before = self.forced.oscillators.len() - 1;
            // Shapes of the arms follow those of the disk in the forced columns.
            let columns = [&mut self.shapes.top, &mut self.shapes.bottom];
            for (side, column) in columns.into_iter().enumerate() {
                self.arm_shape[side].push(shapes[side]);
                column.resize(before, 0.0);
                column.push(shapes[side]);
            }
        }
        let end = self.oscillators.len();
        self.springs.extend(end - springs.len()..end);
        Arm { modes: start..end }
    }

    /// Passes a mode of an arm to the rotor if a base shakes it or its stiffness relaxes.
    fn is_riding(
        &mut self,
        o: &Oscillator,
        gain: f64,
        shape_per_sqrt_kg: [f64; 2],
        relaxes: bool,
    ) -> bool {
        match &mut self.riding {
            Some(riding) if gain != 0.0 || relaxes => {
                riding.push(RidingMode {
                    omega_rad_per_s: o.omega_rad_per_s,
                    half_damping_per_s: o.half_damping_per_s,
                    participation_sqrt_kg: gain,
                    shape_per_sqrt_kg,
                });
                true
            }
            _ => false,
        }
    }

    /// Scales the base's load on the arms, whose modes follow the disk's in the forced columns.
    pub fn scale_arms(&mut self, factor: f64) {
        for (index, gain) in self.forced_index.iter().zip(&mut self.forced.participation) {
            if *index >= self.n_disk {
                *gain *= factor;
            }
        }
        // An oblique shock excludes a base, so the modes passed to the rotor are those that relax.
        for mode in self.riding.iter_mut().flatten() {
            mode.participation_sqrt_kg *= factor;
        }
    }

    pub fn pad(&mut self) {
        let n = padded(self.oscillators.len());
        self.oscillators.resize(n, Oscillator::default());
        for column in [&mut self.contact, &mut self.contact_turn, &mut self.rim] {
            column.resize(n, 0.0);
        }
        for column in &mut self.arm_shape {
            column.resize(n, 0.0);
        }
    }

    /// Σ shape² weight of the modes under both contacts: mobility for a weight of 1.
    pub fn contact_matrix(&self, weight: impl Fn(&Oscillator) -> f64) -> [[f64; 2]; 2] {
        let sum = |a: &[f64], b: &[f64]| -> f64 {
            let pairs = a.iter().zip(b).zip(&self.oscillators);
            pairs.map(|((a, b), o)| a * b * weight(o)).sum()
        };
        let disk = sum(&self.contact, &self.contact);
        let [top, bottom] = [0, 1].map(|i| sum(&self.arm_shape[i], &self.arm_shape[i]));
        // One body: a force on one arm moves the other.
        let across = sum(&self.arm_shape[0], &self.arm_shape[1]);
        [
            [disk + top, -disk - across],
            [-disk - across, disk + bottom],
        ]
    }

    pub fn slider_jump(&self) -> DiskPose {
        let jump =
            |row: &Readout| -> f64 { row.re.iter().zip(&self.contact).map(|(a, b)| a * b).sum() };
        DiskPose {
            displacement_m: jump(&self.slider[0]),
            pitch_rad: jump(&self.slider[1]),
            roll_rad: jump(&self.slider[2]),
        }
    }
}
