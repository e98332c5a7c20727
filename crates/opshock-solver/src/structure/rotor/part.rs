//! Finds the damped modes of one harmonic with its supports, and the rows that read and drive them.

use super::body::Body;
use super::load::{Drive, TiltLoad};
use super::matrices::{Layout, Matrices, RidingMode, Stand};
use super::places::Places;
use crate::disk::DiskMode;
use crate::linalg::{DenseError, SquareMatrix};
use crate::modal::{CoupledModes, CoupledState, Oscillator, PointReadout, Readout};
use crate::shock::BaseMode;
use crate::structure::energy::Energies;
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Largest |s| Δt of a mode. A faster one belongs to a bearing or base too stiff for the step, which then acts as a
/// clamp. If it were kept, an impact would act on the hub's mass instead of its stiffness.
const FASTEST_ANGLE: f64 = PI;
/// Largest ω Δt of a mode of the base that is coupled with the others at all: rounding errors of faster ones would show
/// in the slow ones.
const FASTEST_COUPLED: f64 = 1e3 * PI;

/// One harmonic with its supports, as damped modes.
pub(in crate::structure) struct Part {
    pub nodal_diameters: usize,
    pub modes: CoupledModes,
    /// M_d, and Ω of the disk, for the energy of the material.
    disk_mass: SquareMatrix,
    spin_rad_per_s: f64,
    pub n_arm_modes: usize,
    /// Disk at the ramp's contact points.
    pub contact: PointReadout,
    /// w_θ there.
    pub contact_turn: Readout,
    /// Entrance into the modes of an impulse there.
    pub contact_entrance: CoupledState,
    /// The arms' contact points, on a base that vibrates.
    pub arms: Option<ArmPoints>,
    pub rim: PointReadout,
    /// Displacement, pitch and roll of the disk under the slider.
    pub slider: [PointReadout; 3],
    /// Hub: displacement, or tilt about two axes.
    pub hub: Option<[PointReadout; 2]>,
    /// Hub and base, with their balances.
    pub bodies: [Option<Body>; 2],
    /// Entrance into the modes of the unit pulse, when it drives this part.
    pub drive: Option<Drive>,
    pub loss: SquareMatrix,
    /// Loss of energy per squared impulse in the ripple of equal impulses, one per step, at the contacts: that of the
    /// disk's clamped modes and of the arms'. Hub and base are too heavy and too slow to ripple.
    pub ripple_loss: [[f64; 2]; 2],
}

/// Points that move with the base beside the disk.
pub(in crate::structure) struct ArmPoints {
    /// Contact points of the top and the bottom arm.
    pub contact: [PointReadout; 2],
    /// Entrance into the modes of an impulse there.
    pub entrance: [CoupledState; 2],
    /// The actuator's pivot.
    pub pivot: PointReadout,
    /// The spindle.
    pub spindle: PointReadout,
    /// The ramp's mount.
    pub ramp: PointReadout,
}

/// Modes of the base that are slow enough for the step.
pub(super) fn slow_modes(base: &[BaseMode], step_s: f64) -> Vec<BaseMode> {
    let is_slow = |mode: &&BaseMode| TAU * mode.frequency_hz * step_s < FASTEST_COUPLED;
    base.iter().filter(is_slow).copied().collect()
}

impl Part {
    pub(super) fn build(
        n: usize,
        stand: &Stand<'_>,
        modes: &[&DiskMode],
        place: &Places<'_>,
        step_s: f64,
    ) -> Result<Self, DenseError> {
        let disk = place.disk;
        let Matrices {
            layout,
            disk_mass,
            system,
            load,
        } = Matrices::new(n, stand, modes, disk);
        let mut coupled = CoupledModes::below(system, FASTEST_ANGLE / step_s)?;
        let tilting = match (n, stand.hub, place.oblique) {
            (1.., Some(hub), Some(shock)) => Some(TiltLoad::add(shock, hub, place, &mut coupled)),
            _ => None,
        };
        let i = Complex::new(0.0, 1.0);
        let real = |x: f64| Complex::from(x);
        // (value, slope) of every coordinate at the sampled radius number `at`.
        let shapes = |at: usize, radius_m: f64| -> Vec<(f64, f64)> {
            let rigid = if n == 0 { (1.0, 0.0) } else { (radius_m, 1.0) };
            let carried = stand
                .base
                .iter()
                .map(|mode| (mode.spindle_per_sqrt_kg, 0.0));
            carried
                .chain(stand.hub.map(|_| rigid))
                .chain(modes.iter().map(|mode| mode.shape[at]))
                .chain(stand.arms.iter().map(|_| (0.0, 0.0)))
                .collect()
        };
        let at_ramp = shapes(0, place.ramp_radius_m);
        let at_slider = shapes(1, place.slider.radius_m);
        let at_rim = shapes(2, disk.outer_radius_m);
        let values = |shape: &[(f64, f64)], turn: Complex<f64>| -> Vec<Complex<f64>> {
            shape.iter().map(|(value, _)| turn * *value).collect()
        };
        let order_n = n as f64;
        let turn = (i * order_n * place.angle_rad).exp();
        let [pitch, roll] = place.slider.slopes_to_pose();
        let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
        let slope = |along: [f64; 2]| -> Vec<Complex<f64>> {
            at_slider
                .iter()
                .map(|(value, slope)| {
                    let around = sense * order_n * value / place.slider.radius_m;
                    turn * (i * (along[1] * around) + along[0] * slope)
                })
                .collect()
        };
        let unit = |at: usize, z: Complex<f64>| -> Vec<Complex<f64>> {
            let mut unit = vec![real(0.0); layout.order];
            unit[at] = z;
            unit
        };
        let contact = values(&at_ramp, real(1.0));
        let hub = layout
            .hub
            .map(|at| [real(1.0), i].map(|z| coupled.readout(&unit(at, z))));
        let bodies = [
            (layout.hub).map(|at| Body::new(&coupled, &[(at, 1.0)], load[at], 1.0, step_s)),
            (layout.n_base > 0).then(|| base_body(&coupled, stand.base, step_s)),
        ];
        // Modes of arms belong to this part also where every mode of the base is too stiff for the step.
        let has_arms = layout.n_base > 0 || !stand.arms.is_empty();
        let drive = match tilting {
            Some(load) => Some(load.drive(&coupled, step_s)),
            None => (n == 0).then(|| Drive::along_axis(&coupled, &load)),
        };
        Ok(Self {
            nodal_diameters: n,
            spin_rad_per_s: disk.spin_rad_per_s,
            n_arm_modes: stand.arms.len(),
            contact: coupled.readout(&contact),
            contact_turn: coupled.readout(&values(&at_ramp, i * order_n)).position,
            contact_entrance: coupled.entrance(&contact),
            arms: has_arms.then(|| ArmPoints::new(&coupled, stand, &layout)),
            rim: coupled.readout(&values(&at_rim, real(1.0))),
            slider: [values(&at_slider, turn), slope(pitch), slope(roll)]
                .map(|weights| coupled.readout(&weights)),
            hub,
            bodies,
            drive,
            loss: coupled.loss_form(step_s),
            ripple_loss: ripple_loss(n, modes, stand.arms, place, step_s),
            disk_mass,
            modes: coupled,
        })
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.disk_mass.order()
    }

    /// Response at contact point `to` to an impulse at `from`, by `response`, as a matrix over both gaps:
    /// top x_top − w, bottom w − x_bottom.
    pub fn over_gaps(
        &self,
        response: impl Fn(&CoupledState, &PointReadout) -> f64,
    ) -> [[f64; 2]; 2] {
        let disk = response(&self.contact_entrance, &self.contact);
        let Some(arms) = &self.arms else {
            return [[disk, -disk], [-disk, disk]];
        };
        let points = [&self.contact, &arms.contact[0], &arms.contact[1]];
        let entrances = [&self.contact_entrance, &arms.entrance[0], &arms.entrance[1]];
        let c = |to: usize, from: usize| response(entrances[from], points[to]);
        let (w, top, bottom) = (0, 1, 2);
        // Base and disk are reciprocal: both orders give the same number but for rounding.
        let both = |a: usize, b: usize| 0.5 * (c(a, b) + c(b, a));
        let across = both(top, w) + both(bottom, w) - disk - both(top, bottom);
        [
            [c(top, top) - 2.0 * both(top, w) + disk, across],
            [across, c(bottom, bottom) - 2.0 * both(bottom, w) + disk],
        ]
    }

    /// Applies the impulses of both contacts to `state`: `impulse[1] − impulse[0]` on the disk, the opposite on the
    /// arms.
    pub fn for_impulses(&self, impulse: [f64; 2], mut put: impl FnMut(&CoupledState, f64)) {
        put(&self.contact_entrance, impulse[1] - impulse[0]);
        if let Some(arms) = &self.arms {
            for (entrance, force) in arms.entrance.iter().zip([impulse[0], -impulse[1]]) {
                if force != 0.0 {
                    put(entrance, force);
                }
            }
        }
    }

    /// Energies of the material and in the space-fixed frame.
    pub fn energies(&self, at: &crate::modal::Coordinates) -> Energies {
        let (kinetic, elastic) = self.modes.system().energies(at);
        let n = self.nodal_diameters as f64 * self.spin_rad_per_s;
        if n == 0.0 {
            return Energies {
                kinetic,
                elastic,
                fixed_frame: kinetic + elastic,
            };
        }
        // ½ sᴴ M_d s with s = q̇ + i n Ω q instead of ½ q̇ᴴ M_d q̇; ½ n² Ω² qᴴ M_d q is elastic too.
        let (mut turned, mut carried) = (0.0, 0.0);
        for (row, (q, v)) in at.q.iter().zip(&at.v).enumerate() {
            let masses = self.disk_mass.row(row).iter().zip(&at.q);
            let moved: Complex<f64> = masses.map(|(m, q)| q * *m).sum();
            turned += v.im * moved.re - v.re * moved.im;
            carried += q.re * moved.re + q.im * moved.im;
        }
        let carried = 0.5 * n * n * carried;
        Energies {
            kinetic: kinetic + n * turned + carried,
            elastic: elastic + carried,
            fixed_frame: kinetic + elastic,
        }
    }
}

impl ArmPoints {
    fn new(modes: &CoupledModes, stand: &Stand<'_>, layout: &Layout) -> Self {
        let on_base = |shape: fn(&BaseMode) -> f64| -> Vec<Complex<f64>> {
            let mut weights = vec![Complex::from(0.0); layout.order];
            for (weight, mode) in weights.iter_mut().zip(stand.base) {
                *weight = Complex::from(shape(mode));
            }
            weights
        };
        let ramp = on_base(|mode| mode.ramp_per_sqrt_kg);
        let tips = [0, 1].map(|side| {
            let mut tip = ramp.clone();
            for (weight, mode) in tip[layout.arms..].iter_mut().zip(stand.arms) {
                *weight = Complex::from(mode.shape_per_sqrt_kg[side]);
            }
            tip
        });
        Self {
            contact: tips.each_ref().map(|tip| modes.readout(tip)),
            entrance: tips.each_ref().map(|tip| modes.entrance(tip)),
            pivot: modes.readout(&on_base(|mode| mode.pivot_per_sqrt_kg)),
            spindle: modes.readout(&on_base(|mode| mode.spindle_per_sqrt_kg)),
            ramp: modes.readout(&ramp),
        }
    }
}

/// Momentum of all that the base carries, weighted by its participations: that of a drive on soft mounts.
fn base_body(modes: &CoupledModes, base: &[BaseMode], step_s: f64) -> Body {
    let axis: Vec<(usize, f64)> = base
        .iter()
        .enumerate()
        .map(|(k, mode)| (k, mode.participation_sqrt_kg))
        .collect();
    let share = |shape: fn(&BaseMode) -> f64| -> f64 {
        let modes = base.iter();
        modes
            .map(|mode| mode.participation_sqrt_kg * shape(mode))
            .sum()
    };
    let [load, spindle, ramp] = [
        share(|mode| mode.participation_sqrt_kg),
        share(|mode| mode.spindle_per_sqrt_kg),
        share(|mode| mode.ramp_per_sqrt_kg),
    ];
    Body::new(modes, &axis, load, spindle - ramp, step_s)
}

fn ripple_loss(
    n: usize,
    modes: &[&DiskMode],
    arms: &[RidingMode],
    place: &Places<'_>,
    step_s: f64,
) -> [[f64; 2]; 2] {
    let disk = place.disk;
    let of_mode = |mode: &&DiskMode| {
        let oscillator = Oscillator {
            omega_rad_per_s: mode.omega_rad_per_s,
            half_damping_per_s: mode.damping_ratio * mode.omega_rad_per_s,
            turn_rad_per_s: n as f64 * disk.spin_rad_per_s,
            fixed_damping_per_s: disk.space_fixed_damping_per_s,
        };
        mode.shape[0].0.powi(2) * oscillator.ripple_loss(step_s)
    };
    let of_disk: f64 = modes.iter().map(of_mode).sum();
    let mut loss = [[of_disk, -of_disk], [-of_disk, of_disk]];
    for mode in arms {
        let oscillator = Oscillator {
            omega_rad_per_s: mode.omega_rad_per_s,
            half_damping_per_s: mode.half_damping_per_s,
            turn_rad_per_s: 0.0,
            fixed_damping_per_s: 0.0,
        };
        let own = oscillator.ripple_loss(step_s);
        let [top, bottom] = mode.shape_per_sqrt_kg;
        loss[0][0] += own * top * top;
        loss[1][1] += own * bottom * bottom;
        loss[0][1] -= own * top * bottom;
        loss[1][0] -= own * top * bottom;
    }
    loss
}
