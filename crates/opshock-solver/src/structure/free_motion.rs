//! Motion before any contact: the response to the unit pulse, scaled by the amplitude.
//!
//! An axial shock moves the axisymmetric modes of the disk and shakes the ramp's arms. Both are
//! oscillators at rest in the drive's frame, driven by participation × a(t), and are carried over
//! the grid t_k = k Δt by their exact forced flow, also in the steps in which the pulse has a kink.
//! Every run, whatever its ramp, sign and amplitude, multiplies the same columns. On a base that vibrates
//! disk and ramp feel the loads of their mounts (`on_base`), and points move with them.

use super::energy::LongSum;
use crate::modal::oscillator::{GAUSS_8, phi1};
use crate::modal::{Flow, ForcedResponse, LossForm, Oscillator, Phase};
use crate::shock::Stretch;

use super::on_base::{OnBase, Waves};
use super::rotor::{Rotor, RotorScratch, RotorState};
use crate::shock::BaseMotion;

/// Oscillators driven by the shock, modal mass 1 kg each.
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedModes {
    pub oscillators: Vec<Oscillator>,
    /// Generalised force per unit a(t), kg^½.
    pub participation: Vec<f64>,
    /// How many are the disk's; the others are the ramp's.
    pub n_on_disk: usize,
}

/// Shapes of the forced modes at the points that matter, kg^-½ (slope: kg^-½/m).
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedShapes {
    pub contact: Vec<f64>,
    pub rim: Vec<f64>,
    pub slider: Vec<f64>,
    pub slider_slope: Vec<f64>,
    pub top: Vec<f64>,
    pub bottom: Vec<f64>,
}

/// Points read, to whole registers.
const POINTS: usize = 8;

impl ForcedShapes {
    /// Contact, slider, its slope, top, bottom and rim of every mode, and two zeros; zero where a
    /// point has no entry (modes of the disk come first, then those of arms).
    fn by_mode(&self) -> Vec<[f64; POINTS]> {
        let rows = [
            &self.contact,
            &self.slider,
            &self.slider_slope,
            &self.top,
            &self.bottom,
            &self.rim,
        ];
        let entry = |j: usize, k: usize| rows.get(k).and_then(|row| row.get(j)).copied();
        let mode = |j: usize| std::array::from_fn(|k| entry(j, k).unwrap_or(0.0));
        let n = rows.iter().map(|row| row.len()).max().unwrap_or(0);
        (0..n).map(mode).collect()
    }
}

/// Displacement and velocity of one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Motion {
    pub value: f64,
    pub rate: f64,
}

/// Unit response of all points at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    pub contact: Motion,
    pub slider: Motion,
    pub slider_slope: Motion,
    pub top: Motion,
    pub bottom: Motion,
    pub rim: f64,
    /// Pitch and roll of the disk under the slider, of a disk on a hub.
    pub tilt: [Motion; 2],
    /// Energy of disk and arms, J per (m/s²)².
    pub energy: f64,
    /// Its kinetic part.
    pub kinetic: f64,
    /// H less that energy: 0 where only n = 0 moves.
    pub excess: f64,
    /// Work of the shock so far, J per (m/s²)².
    pub work: f64,
    /// Loss by damping so far, J per (m/s²)².
    pub loss: f64,
}

/// The hub at one instant, per unit amplitude or in total.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HubSample {
    /// Axial displacement, m.
    pub axial_m: f64,
    /// Tilt towards the ramp and across, rad.
    pub tilt_rad: [f64; 2],
    /// Axial momentum of hub and disk, N s.
    pub momentum_n_s: f64,
    /// Impulse of the bearing on them so far, N s.
    pub bearing_n_s: f64,
}

/// Displacements and velocities of the forced modes.
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedState {
    pub x: Vec<f64>,
    pub v: Vec<f64>,
    /// The disk's harmonics on a hub; no parts without one.
    pub rotor: RotorState,
    pub scratch: RotorScratch,
}

/// Work of the shock and loss by damping over a time, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Exchange {
    pub work: f64,
    pub loss: f64,
    /// Impulse of a hub's bearing on the rotor, N s.
    pub bearing_n_s: f64,
}

struct QuadraturePoint {
    tau_s: f64,
    weight_s: f64,
    flow: Vec<Flow>,
    response: Vec<ForcedResponse>,
}

/// Response to the unit pulse on the grid, and the tables that continue it from any state.
pub(super) struct FreeMotion {
    pub step_s: f64,
    pub samples: Vec<Sample>,
    /// Modal states every [`CHECKPOINT_STEPS`] nodes.
    checkpoints: Vec<ForcedState>,
    pub modes: ForcedModes,
    /// Shapes by mode, so that all points are read at once.
    points: Vec<[f64; POINTS]>,
    /// The disk's harmonics on a hub.
    pub rotor: Option<Rotor>,
    /// The base, when it vibrates.
    pub base: Option<OnBase>,
    /// Its hub at every node.
    pub hub: Vec<HubSample>,
    stretches: Vec<Stretch>,
    pub pulse_end_s: f64,
    flow: Vec<Flow>,
    loss: Vec<LossForm>,
    response: Vec<ForcedResponse>,
    quadrature: Vec<QuadraturePoint>,
}

/// Nodes between stored modal states: a run that wakes redoes at most so many steps.
const CHECKPOINT_STEPS: usize = 64;

/// Gauss rule on (0, 1) for the work and loss within a step, exact to degree 9.
const GAUSS_5: [(f64, f64); 5] = [
    (0.046_910_077_030_668_02, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

impl HubSample {
    pub fn times(&self, factor: f64) -> Self {
        Self {
            axial_m: factor * self.axial_m,
            tilt_rad: self.tilt_rad.map(|x| factor * x),
            momentum_n_s: factor * self.momentum_n_s,
            bearing_n_s: factor * self.bearing_n_s,
        }
    }
}

impl ForcedState {
    pub fn at_rest(n: usize, rotor: Option<&Rotor>) -> Self {
        Self {
            x: vec![0.0; n],
            v: vec![0.0; n],
            rotor: rotor.map_or_else(RotorState::default, Rotor::at_rest),
            scratch: rotor.map_or_else(RotorScratch::default, Rotor::scratch),
        }
    }

    pub fn copy_from(&mut self, other: &Self) {
        self.x.copy_from_slice(&other.x);
        self.v.copy_from_slice(&other.v);
        self.rotor.copy_from(&other.rotor);
    }
}

impl FreeMotion {
    /// Unit response at the nodes 0 ..= `n_steps`.
    pub fn new(
        modes: ForcedModes,
        shapes: ForcedShapes,
        rotor: Option<Rotor>,
        base: Option<BaseMotion>,
        stretches: Vec<Stretch>,
        step_s: f64,
        n_steps: usize,
    ) -> Self {
        // One rate per pulse shape: a half-sine has one stretch, piecewise linear ones have none.
        let sigma = stretches[0].sigma_per_s;
        let flows = |h: f64| modes.oscillators.iter().map(|o| o.flow(h)).collect();
        let responses = |h: f64| {
            modes
                .oscillators
                .iter()
                .map(|o| ForcedResponse::new(o, sigma, h))
                .collect()
        };
        // Work and loss of a mode swing at twice its frequency: where that is several radians a
        // step, five points leave 1e-8 of it out of the book.
        let swiftest = modes.oscillators.iter().map(|o| o.omega_rad_per_s);
        let rule: &[(f64, f64)] = if swiftest.fold(0.0, f64::max) * step_s > 0.7 {
            &GAUSS_8
        } else {
            &GAUSS_5
        };
        let base = base.map(|motion| {
            let times_s = rule.iter().map(|(x, _)| x * step_s);
            OnBase::new(motion, sigma, &modes.oscillators, step_s, times_s)
        });
        let mut free = Self {
            step_s,
            samples: Vec::with_capacity(n_steps + 1),
            checkpoints: Vec::with_capacity(n_steps / CHECKPOINT_STEPS + 1),
            flow: flows(step_s),
            loss: modes
                .oscillators
                .iter()
                .map(|o| o.loss_form(step_s))
                .collect(),
            response: responses(step_s),
            quadrature: rule
                .iter()
                .map(|&(x, weight)| QuadraturePoint {
                    tau_s: x * step_s,
                    weight_s: weight * step_s,
                    flow: flows(x * step_s),
                    response: responses(x * step_s),
                })
                .collect(),
            pulse_end_s: stretches[stretches.len() - 1].end_s,
            points: shapes.by_mode(),
            modes,
            rotor,
            base,
            hub: Vec::new(),
            stretches,
        };
        let mut state = ForcedState::at_rest(free.modes.oscillators.len(), free.rotor.as_ref());
        let (mut work, mut loss) = (LongSum::default(), LongSum::default());
        let mut bearing = LongSum::default();
        for k in 0..=n_steps {
            if k % CHECKPOINT_STEPS == 0 {
                free.checkpoints.push(state.clone());
            }
            let mut sample = free.sample(&state, k as f64 * step_s);
            (sample.kinetic, sample.energy) = free.energy(&mut state);
            if let Some(rotor) = free.rotor.as_ref().filter(|rotor| rotor.is_tilted()) {
                let of_rotor = rotor.energies(&state.rotor, &mut state.scratch);
                sample.excess = of_rotor.fixed_frame - of_rotor.material();
            }
            sample.work = work.value();
            sample.loss = loss.value();
            free.samples.push(sample);
            if let Some(rotor) = &free.rotor {
                free.hub.push(rotor.hub(&state.rotor, bearing.value()));
            }
            let exchange = free.exchange(&mut state, k, 1.0);
            work.add(exchange.work);
            loss.add(exchange.loss);
            bearing.add(exchange.bearing_n_s);
            free.step(&mut state, k);
        }
        free
    }

    /// Number of stretch borders, which are kinks of the pulse, s.
    pub fn kinks_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.stretches.iter().map(|s| s.end_s)
    }

    /// Unit response of the points for `state` at `time_s`.
    pub fn sample(&self, state: &ForcedState, time_s: f64) -> Sample {
        let (mut x, mut v) = ([0.0; POINTS], [0.0; POINTS]);
        for ((shape, q), r) in self.points.iter().zip(&state.x).zip(&state.v) {
            for k in 0..POINTS {
                x[k] += shape[k] * q;
                v[k] += shape[k] * r;
            }
        }
        let motion = |k: usize| Motion {
            value: x[k],
            rate: v[k],
        };
        let mut sample = Sample {
            contact: motion(0),
            slider: motion(1),
            slider_slope: motion(2),
            top: motion(3),
            bottom: motion(4),
            rim: x[5],
            ..Sample::default()
        };
        if let Some(rotor) = &self.rotor {
            rotor.add_sample(&state.rotor, &mut sample);
        }
        if let Some(base) = &self.base {
            let [spindle, ramp] = base.mounts(time_s);
            let carried = [
                (&mut sample.contact, spindle),
                (&mut sample.slider, spindle),
                (&mut sample.top, ramp),
                (&mut sample.bottom, ramp),
            ];
            for (point, [value, rate]) in carried {
                point.value += value;
                point.rate += rate;
            }
            sample.rim += spindle[0];
        }
        sample
    }

    /// Loads at the mounts of disk and ramp at `time_s`, where the pulse is `value`.
    pub fn loads(&self, time_s: f64, value: f64) -> [f64; 2] {
        match &self.base {
            None => [value; 2],
            Some(base) => base.loads(time_s, value),
        }
    }

    /// The pulse at the mounts of disk and ramp.
    fn phases(&self, phase: &Phase) -> [Phase; 2] {
        match &self.base {
            None => [*phase; 2],
            Some(base) => base.phases(phase),
        }
    }

    /// Mount of forced mode `j`: 0 the spindle, 1 the ramp's; one and the same on a rigid base.
    pub fn mount(&self, j: usize) -> usize {
        usize::from(self.base.is_some() && j >= self.modes.n_on_disk)
    }

    /// The base's ringing from `start_s` on.
    fn ringing(&self, start_s: f64) -> Option<(&OnBase, Waves)> {
        let base = self.base.as_ref()?;
        Some((base, base.waves(start_s)))
    }

    /// (kinetic, total) energy.
    fn energy(&self, state: &mut ForcedState) -> (f64, f64) {
        let (mut kinetic, mut elastic) = (0.0, 0.0);
        for ((o, x), v) in self.modes.oscillators.iter().zip(&state.x).zip(&state.v) {
            let spring = o.omega_rad_per_s * x;
            kinetic += 0.5 * v * v;
            elastic += 0.5 * spring * spring;
        }
        if let Some(rotor) = &self.rotor {
            let of_rotor = rotor.energies(&state.rotor, &mut state.scratch);
            kinetic += of_rotor.kinetic;
            elastic += of_rotor.elastic;
        }
        (kinetic, kinetic + elastic)
    }

    /// Unit response of the modes at node `k`: the bits behind the samples.
    pub fn state_at_node(&self, k: usize, state: &mut ForcedState) {
        let first = k / CHECKPOINT_STEPS;
        state.copy_from(&self.checkpoints[first]);
        for j in first * CHECKPOINT_STEPS..k {
            self.step(state, j);
        }
    }

    /// Carries the unit response from node `k` to the next.
    pub fn step(&self, state: &mut ForcedState, k: usize) {
        let start_s = k as f64 * self.step_s;
        if start_s >= self.pulse_end_s {
            for ((f, x), v) in self.flow.iter().zip(&mut state.x).zip(&mut state.v) {
                (*x, *v) = carry(f, *x, *v);
            }
            if let Some(rotor) = &self.rotor {
                rotor.step(None, &mut state.rotor, &mut state.scratch);
            }
        } else if let Some((_, phase)) = self.whole_step(start_s) {
            let modes = self
                .flow
                .iter()
                .zip(&self.response)
                .zip(&self.modes.participation);
            let phases = self.phases(&phase);
            let states = state.x.iter_mut().zip(&mut state.v);
            for (j, (((f, r), gain), (x, v))) in modes.zip(states).enumerate() {
                let (dx, dv) = r.increments(&phases[self.mount(j)]);
                let free = carry(f, *x, *v);
                (*x, *v) = (free.0 + gain * dx, free.1 + gain * dv);
            }
            if let Some(rotor) = &self.rotor {
                rotor.step(Some(&phase), &mut state.rotor, &mut state.scratch);
            }
        } else {
            return self.advance(state, start_s, self.step_s, 1.0);
        }
        if let Some((base, waves)) = self.ringing(start_s) {
            for (j, gain) in self.modes.participation.iter().enumerate() {
                let (dx, dv) = base.step_increments(&waves, j, self.mount(j));
                state.x[j] += gain * dx;
                state.v[j] += gain * dv;
            }
        }
    }

    /// Work and loss over the step from node `k` for a total state under `amplitude` times the
    /// unit pulse.
    pub fn exchange(&self, state: &mut ForcedState, k: usize, amplitude: f64) -> Exchange {
        let start_s = k as f64 * self.step_s;
        let is_over = start_s >= self.pulse_end_s;
        if is_over && self.base.is_none() {
            let modes = self.loss.iter().zip(&state.x).zip(&state.v);
            let mut total = Exchange {
                loss: modes
                    .map(|((l, x), v)| l.qq * x * x + l.rr * v * v + 2.0 * l.qr.re * x * v)
                    .sum(),
                ..Exchange::default()
            };
            if let Some(rotor) = &self.rotor {
                total.add(&rotor.free_exchange(&state.rotor));
            }
            return total;
        }
        let (sigma_per_s, phase) = match self.whole_step(start_s) {
            Some((stretch, phase)) => (stretch.sigma_per_s, phase),
            // A base that rings on.
            None if is_over => Default::default(),
            None => return self.exchange_within(state, start_s, self.step_s, amplitude),
        };
        let phases = self.phases(&phase);
        let ringing = self.ringing(start_s);
        let mut total = Exchange::default();
        for (i, point) in self.quadrature.iter().enumerate() {
            let mut forces = phases.map(|p| p.later(sigma_per_s, point.tau_s).value());
            if let Some((base, waves)) = &ringing {
                let added = base.ringing(waves, point.tau_s);
                forces = std::array::from_fn(|mount| forces[mount] + added[mount]);
            }
            // Work at each mount.
            let (mut power, mut loss) = ([0.0; 2], 0.0);
            for j in 0..state.x.len() {
                let f = &point.flow[j];
                let (x, v) = (state.x[j], state.v[j]);
                let gain = self.modes.participation[j];
                let mount = self.mount(j);
                let mut v = v
                    + (f.rq.re * x + f.rr.re * v)
                    + amplitude * gain * point.response[j].velocity_increment(&phases[mount]);
                if let Some((base, waves)) = &ringing {
                    v += amplitude * gain * base.velocity_increment(i, waves, j, mount);
                }
                power[mount] += gain * v;
                loss += 2.0 * self.modes.oscillators[j].half_damping_per_s * v * v;
            }
            for (force, power) in forces.iter().zip(power) {
                total.work += point.weight_s * (amplitude * force) * power;
            }
            total.loss += point.weight_s * loss;
        }
        if let Some(rotor) = &self.rotor {
            let forcing = (sigma_per_s, &phase);
            let ForcedState {
                rotor: own,
                scratch,
                ..
            } = state;
            total.add(&rotor.step_exchange(own, forcing, amplitude, scratch));
        }
        total
    }

    /// The same over any time; slower, nothing tabulated.
    pub fn exchange_within(
        &self,
        state: &mut ForcedState,
        start_s: f64,
        h_s: f64,
        amplitude: f64,
    ) -> Exchange {
        let mut total = Exchange::default();
        self.pieces(start_s, h_s, |piece| {
            let offset = piece.start_s - start_s;
            for (x, weight) in GAUSS_8 {
                let tau = x * piece.h_s;
                let phases = self.phases(&piece.phase);
                let mut loads = phases.map(|p| p.later(piece.sigma_per_s, tau).value());
                if let Some((base, waves)) = self.ringing(piece.start_s) {
                    let added = base.ringing(&waves, tau);
                    loads = std::array::from_fn(|mount| loads[mount] + added[mount]);
                }
                for (j, o) in self.modes.oscillators.iter().enumerate() {
                    let v = self.velocity_at(state, j, start_s, offset + tau, amplitude);
                    let force = amplitude * loads[self.mount(j)];
                    total.work += weight * piece.h_s * force * self.modes.participation[j] * v;
                    total.loss += weight * piece.h_s * 2.0 * o.half_damping_per_s * v * v;
                }
            }
        });
        if let Some(rotor) = &self.rotor {
            let ForcedState {
                rotor: own,
                scratch,
                ..
            } = state;
            scratch.walk.copy_from(own);
            self.pieces(start_s, h_s, |piece| {
                let one = rotor.piece_exchange(piece.h_s, piece.forcing(), amplitude, scratch);
                total.add(&one);
            });
        }
        total
    }

    /// ∫ s dt of the unit pulse until `end_s`.
    pub fn pulse_integral_s(&self, end_s: f64) -> f64 {
        let mut sum = 0.0;
        for stretch in &self.stretches {
            let h = stretch.end_s.min(end_s) - stretch.start_s;
            if h > 0.0 {
                let phase = &stretch.phase;
                let wave = phase.wave * phi1(stretch.sigma_per_s * h) * h;
                sum += phase.constant * h + 0.5 * phase.slope_per_s * h * h + wave.re;
            }
        }
        sum
    }

    fn velocity_at(
        &self,
        state: &ForcedState,
        j: usize,
        start_s: f64,
        h_s: f64,
        amplitude: f64,
    ) -> f64 {
        let o = &self.modes.oscillators[j];
        let (mut x, mut v) = (state.x[j], state.v[j]);
        self.pieces(start_s, h_s, |piece| {
            (x, v) = self.carry_piece(j, o, x, v, &piece, amplitude);
        });
        v
    }

    /// Carries `state` under `amplitude` times the unit pulse over any time.
    pub fn advance(&self, state: &mut ForcedState, start_s: f64, h_s: f64, amplitude: f64) {
        self.pieces(start_s, h_s, |piece| {
            for (j, o) in self.modes.oscillators.iter().enumerate() {
                (state.x[j], state.v[j]) =
                    self.carry_piece(j, o, state.x[j], state.v[j], &piece, amplitude);
            }
            if let Some(rotor) = &self.rotor {
                let ForcedState {
                    rotor: own,
                    scratch,
                    ..
                } = &mut *state;
                rotor.advance(piece.h_s, piece.forcing(), amplitude, own, scratch);
            }
        });
    }

    fn carry_piece(
        &self,
        j: usize,
        o: &Oscillator,
        x: f64,
        v: f64,
        piece: &Piece,
        amplitude: f64,
    ) -> (f64, f64) {
        let mut to = carry(&o.flow(piece.h_s), x, v);
        let mount = self.mount(j);
        let gain = amplitude * self.modes.participation[j];
        if piece.driven {
            let phase = &self.phases(&piece.phase)[mount];
            let (dx, dv) = ForcedResponse::new(o, piece.sigma_per_s, piece.h_s).increments(phase);
            to = (to.0 + gain * dx, to.1 + gain * dv);
        }
        if let Some(base) = &self.base {
            let (dx, dv) = base.piece_increments(o, piece.start_s, piece.h_s, mount);
            to = (to.0 + gain * dx, to.1 + gain * dv);
        }
        to
    }

    /// Stretch and phase when the step from `start_s` lies inside one stretch.
    fn whole_step(&self, start_s: f64) -> Option<(&Stretch, Phase)> {
        let i = self.stretches.partition_point(|s| s.end_s <= start_s);
        let stretch = self.stretches.get(i)?;
        (start_s + self.step_s <= stretch.end_s).then(|| {
            let phase = stretch
                .phase
                .later(stretch.sigma_per_s, start_s - stretch.start_s);
            (stretch, phase)
        })
    }

    /// Cuts [start, start + h] at the kinks of the pulse.
    fn pieces(&self, start_s: f64, h_s: f64, mut visit: impl FnMut(Piece)) {
        let end_s = start_s + h_s;
        let mut t = start_s;
        let first = self.stretches.partition_point(|s| s.end_s <= start_s);
        for stretch in &self.stretches[first..] {
            if t >= end_s {
                return;
            }
            let until = stretch.end_s.min(end_s);
            // The only piece keeps the exact length asked for.
            let whole = t == start_s && until == end_s;
            visit(Piece {
                start_s: t,
                h_s: if whole { h_s } else { until - t },
                sigma_per_s: stretch.sigma_per_s,
                phase: stretch
                    .phase
                    .later(stretch.sigma_per_s, t - stretch.start_s),
                driven: true,
            });
            t = until;
        }
        if t < end_s {
            visit(Piece {
                start_s: t,
                h_s: if t == start_s { h_s } else { end_s - t },
                sigma_per_s: nalgebra::Complex::from(0.0),
                phase: Phase::default(),
                driven: false,
            });
        }
    }
}

struct Piece {
    start_s: f64,
    h_s: f64,
    sigma_per_s: nalgebra::Complex<f64>,
    phase: Phase,
    driven: bool,
}

impl Piece {
    fn forcing(&self) -> Option<(nalgebra::Complex<f64>, &Phase)> {
        self.driven.then_some((self.sigma_per_s, &self.phase))
    }
}

impl Exchange {
    pub fn add(&mut self, other: &Self) {
        self.work += other.work;
        self.loss += other.loss;
        self.bearing_n_s += other.bearing_n_s;
    }
}

fn carry(f: &Flow, x: f64, v: f64) -> (f64, f64) {
    (
        x + (f.qq.re * x + f.qr.re * v),
        v + (f.rq.re * x + f.rr.re * v),
    )
}
