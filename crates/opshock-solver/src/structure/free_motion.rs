//! Computes the motion before any contact: the response to the unit pulse, which every run scales by its amplitude.
//!
//! An axial shock drives the axisymmetric modes of the disk and the modes of the ramp's arms. Both are oscillators, at
//! rest at first and driven by participation × a(t). They are advanced over the grid t_k = k Δt by their exact forced
//! flow, also in steps in which the pulse has a kink. Every run, whatever its ramp, sign and amplitude, scales the same
//! columns. On a hub or a vibrating base the disk's modes are coupled with it and advanced as a `rotor`.

use super::energy::{ExchangedEnergy, LongSum};
use super::forced_columns::ForcedColumns;
use super::forced_modes::{ForcedModes, ForcedShapes};
use super::rotor::{Rotor, RotorScratch, RotorState};
use super::sample::{BodySample, Exchange, Motion, Sample};
use super::span::{INTERVAL_NODES, Span};
use super::stretches::{Piece, Stretches};
use crate::modal::bank::padded;
use crate::modal::oscillator::GAUSS_8;
use crate::modal::{Flow, ForcedResponse, Oscillator, Phase};
use crate::shock::{BaseMotion, Stretch};
use nalgebra::Complex;

/// Displacements and velocities of the forced modes, padded.
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedState {
    pub x: Vec<f64>,
    pub v: Vec<f64>,
    /// The disk's harmonics on a hub; no parts without one.
    pub rotor: RotorState,
    pub scratch: RotorScratch,
}

/// States of the forced modes at some nodes, one after the other.
#[derive(Clone, Debug, Default)]
struct Checkpoints {
    /// x, then v.
    states: Vec<f64>,
    /// Of a disk on a hub or on a base that vibrates.
    rotors: Vec<RotorState>,
}

impl Checkpoints {
    fn push(&mut self, state: &ForcedState) {
        self.states.extend_from_slice(&state.x);
        self.states.extend_from_slice(&state.v);
        if !state.rotor.parts.is_empty() {
            self.rotors.push(state.rotor.clone());
        }
    }

    fn copy_to(&self, i: usize, state: &mut ForcedState) {
        let n = state.x.len();
        let (x, v) = self.states[2 * i * n..][..2 * n].split_at(n);
        state.x.copy_from_slice(x);
        state.v.copy_from_slice(v);
        if let Some(rotor) = self.rotors.get(i) {
            state.rotor.copy_from(rotor);
        }
    }
}

/// Response to the unit pulse on the grid, and the tables that continue it from any state.
pub(super) struct FreeMotion {
    pub step_s: f64,
    pub samples: Vec<Sample>,
    /// Largest energy of disk and arms, J per (m/s²)².
    pub peak_energy: f64,
    /// Modal states every [`INTERVAL_NODES`] steps: a run that activates contact repeats at most so many steps.
    checkpoints: Checkpoints,
    /// Bounds of the motion between two of these.
    pub spans: Vec<Span>,
    pub modes: ForcedModes,
    /// The forced modes over a grid step.
    columns: ForcedColumns,
    /// The disk's harmonics on a hub or on a base that vibrates.
    pub rotor: Option<Rotor>,
    /// Motion of the pivot under the unit pulse, if the base vibrates.
    pub base: Option<BaseMotion>,
    /// Hub and base at every node.
    pub bodies: Vec<BodySample>,
    pub pulse: Stretches,
    /// Rate and phase of the pulse at the nodes before its end whose step lies within one stretch of the pulse.
    phases: Vec<Option<(Complex<f64>, Phase)>>,
    pub pulse_end_s: f64,
}

/// Gauss rule on (0, 1) for the work and loss within a step, exact to degree 9.
const GAUSS_5: [(f64, f64); 5] = [
    (0.046_910_077_030_668_02, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

impl ForcedState {
    pub fn at_rest(n: usize, rotor: Option<&Rotor>) -> Self {
        Self {
            x: vec![0.0; padded(n)],
            v: vec![0.0; padded(n)],
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
        stretches: Vec<Stretch>,
        step_s: f64,
        n_steps: usize,
    ) -> Self {
        // One rate per pulse shape: a half-sine has one stretch, piecewise linear ones have none.
        let sigma = stretches[0].sigma_per_s;
        // Work and loss of a mode oscillate at twice its frequency. Where that is several radians per step, five points
        // would leave an error of 1e-8 in the balance.
        let swiftest = modes.oscillators.iter().map(|o| o.omega_rad_per_s);
        let rule: &[(f64, f64)] = if swiftest.fold(0.0, f64::max) * step_s > 0.7 {
            &GAUSS_8
        } else {
            &GAUSS_5
        };
        let base = rotor.as_ref();
        let base = base.and_then(|rotor| rotor.pivot_motion(&stretches));
        let mut free = Self {
            step_s,
            samples: Vec::with_capacity(n_steps + 1),
            peak_energy: 0.0,
            checkpoints: Checkpoints::default(),
            spans: Vec::new(),
            pulse_end_s: stretches[stretches.len() - 1].end_s,
            columns: ForcedColumns::new(&modes, shapes.by_mode(), sigma, step_s, rule),
            modes,
            rotor,
            base,
            bodies: Vec::new(),
            pulse: Stretches(stretches),
            phases: Vec::new(),
        };
        let driven = (0..n_steps).map(|k| k as f64 * step_s);
        let driven = driven.take_while(|&start_s| start_s < free.pulse_end_s);
        free.phases = driven
            .map(|start_s| free.pulse.whole_step(start_s, step_s))
            .collect();
        let mut state = ForcedState::at_rest(free.modes.oscillators.len(), free.rotor.as_ref());
        let n_kept = n_steps / INTERVAL_NODES + 1;
        free.checkpoints.states.reserve(2 * n_kept * state.x.len());
        free.spans.reserve(n_kept);
        let (mut work, mut loss) = (LongSum::default(), LongSum::default());
        let mut supports = [LongSum::default(); 2];
        for k in 0..=n_steps {
            if k % INTERVAL_NODES == 0 {
                free.checkpoints.push(&state);
            }
            free.close_span(INTERVAL_NODES + 1);
            let mut sample = free.sample(&state);
            if free.rotor.is_none() && k as f64 * step_s >= free.pulse_end_s {
                // Only the columns move, and nothing drives them.
                let ([kinetic, elastic], step_loss) =
                    free.columns.balance_and_advance(&mut state.x, &mut state.v);
                (sample.kinetic, sample.energy) = (kinetic, kinetic + elastic);
                (sample.work, sample.loss) = (work.value(), loss.value());
                loss.add(step_loss);
                free.samples.push(sample);
                continue;
            }
            (sample.kinetic, sample.energy) = free.energy(&mut state);
            if let Some(rotor) = free.rotor.as_ref().filter(|rotor| rotor.is_tilted()) {
                let of_rotor = rotor.energies(&state.rotor, &mut state.scratch);
                sample.excess = of_rotor.fixed_frame - of_rotor.material();
            }
            sample.work = work.value();
            sample.loss = loss.value();
            free.samples.push(sample);
            if let Some(rotor) = &free.rotor {
                let support_n_s = supports.map(|sum| sum.value());
                free.bodies.push(rotor.bodies(&state.rotor, support_n_s));
            }
            let exchange = free.exchange(&mut state, k, 1.0);
            work.add(exchange.work);
            loss.add(exchange.loss);
            for (sum, impulse) in supports.iter_mut().zip(exchange.support_n_s) {
                sum.add(impulse);
            }
            free.step(&mut state, k);
        }
        let energies = free.samples.iter().map(|sample| sample.energy);
        free.peak_energy = energies.fold(0.0, f64::max);
        free.close_span(2);
        free
    }

    /// Appends the bounds of the samples since the last span, once there are `n_wanted` of them.
    fn close_span(&mut self, n_wanted: usize) {
        let samples = &self.samples[self.spans.len() * INTERVAL_NODES..];
        if samples.len() >= n_wanted {
            self.spans.push(Span::new(samples, self.step_s));
        }
    }

    /// Unit response of the points for `state`.
    pub fn sample(&self, state: &ForcedState) -> Sample {
        let [x, v] = self.columns.read(&state.x, &state.v);
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
        sample
    }

    /// (kinetic, total) energy.
    fn energy(&self, state: &mut ForcedState) -> (f64, f64) {
        let [mut kinetic, mut elastic] = self.columns.energy(&state.x, &state.v);
        if let Some(rotor) = &self.rotor {
            let of_rotor = rotor.energies(&state.rotor, &mut state.scratch);
            kinetic += of_rotor.kinetic;
            elastic += of_rotor.elastic;
        }
        (kinetic, kinetic + elastic)
    }

    /// Unit response of the modes at node `k`, with the same bits as the samples.
    pub fn state_at_node(&self, k: usize, state: &mut ForcedState) {
        let first = k / INTERVAL_NODES;
        self.checkpoints.copy_to(first, state);
        for j in first * INTERVAL_NODES..k {
            self.step(state, j);
        }
    }

    /// Rate and phase of the pulse in the step from node `k`, if it lies within one stretch; the node at the end of the
    /// grid has one too.
    fn phase(&self, k: usize) -> Option<(Complex<f64>, Phase)> {
        let whole = || self.pulse.whole_step(k as f64 * self.step_s, self.step_s);
        self.phases.get(k).copied().unwrap_or_else(whole)
    }

    /// Advances the unit response from node `k` to the next.
    pub fn step(&self, state: &mut ForcedState, k: usize) {
        let start_s = k as f64 * self.step_s;
        if start_s >= self.pulse_end_s {
            self.columns.carry(&mut state.x, &mut state.v);
            if let Some(rotor) = &self.rotor {
                rotor.step(None, &mut state.rotor, &mut state.scratch);
            }
        } else if let Some((_, phase)) = &self.phase(k) {
            self.columns.drive(phase, &mut state.x, &mut state.v);
            if let Some(rotor) = &self.rotor {
                rotor.step(Some(phase), &mut state.rotor, &mut state.scratch);
            }
        } else {
            self.advance(state, start_s, self.step_s, 1.0);
        }
    }

    /// Work and loss over the step from node `k` for a total state under `amplitude` times the
    /// unit pulse.
    pub fn exchange(&self, state: &mut ForcedState, k: usize, amplitude: f64) -> Exchange {
        let start_s = k as f64 * self.step_s;
        let is_over = start_s >= self.pulse_end_s;
        if is_over {
            let mut total = Exchange {
                loss: self.columns.free_loss(&state.x, &state.v),
                ..Exchange::default()
            };
            if let Some(rotor) = &self.rotor {
                total.add(&rotor.free_exchange(&state.rotor));
            }
            return total;
        }
        let (sigma_per_s, phase) = match self.phase(k) {
            Some(driven) => driven,
            None => return self.exchange_within(state, start_s, self.step_s, amplitude),
        };
        let [work, loss] = self.columns.exchange(amplitude, &phase, &state.x, &state.v);
        let mut total = Exchange {
            work,
            loss,
            ..Exchange::default()
        };
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

    /// Adds work and loss over a contact-free interval from node `k`, step by step while the pulse lasts.
    /// `unit` is the unit response there and is advanced, `contact` is the contact-driven part, `total` is scratch.
    pub fn exchange_contact_free(
        &self,
        [contact, unit, total]: [&mut ForcedState; 3],
        k: usize,
        amplitude: f64,
        exchanged: &mut ExchangedEnergy,
    ) {
        for k in k..k + INTERVAL_NODES {
            for (total, from) in [
                (&mut total.x, [&contact.x, &unit.x]),
                (&mut total.v, [&contact.v, &unit.v]),
            ] {
                let [contact, unit] = from;
                for ((total, contact), unit) in total.iter_mut().zip(contact).zip(unit) {
                    *total = contact + amplitude * unit;
                }
            }
            let exchange = self.exchange(total, k, amplitude);
            exchanged.work.add(exchange.work);
            exchanged.damping.add(exchange.loss);
            self.step(unit, k);
            self.columns.carry(&mut contact.x, &mut contact.v);
        }
    }

    /// [`Self::exchange`] over any time; slower, without tables.
    pub fn exchange_within(
        &self,
        state: &mut ForcedState,
        start_s: f64,
        h_s: f64,
        amplitude: f64,
    ) -> Exchange {
        let mut total = Exchange::default();
        self.pulse.pieces(start_s, h_s, |piece| {
            let offset = piece.start_s - start_s;
            for (x, weight) in GAUSS_8 {
                let tau = x * piece.h_s;
                let load = piece.phase.later(piece.sigma_per_s, tau).value();
                for (j, o) in self.modes.oscillators.iter().enumerate() {
                    let v = self.velocity_at(state, j, start_s, offset + tau, amplitude);
                    let force = amplitude * load;
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
            self.pulse.pieces(start_s, h_s, |piece| {
                let one = rotor.piece_exchange(piece.h_s, piece.forcing(), amplitude, scratch);
                total.add(&one);
            });
        }
        total
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
        self.pulse.pieces(start_s, h_s, |piece| {
            (x, v) = self.carry_piece(j, o, x, v, &piece, amplitude);
        });
        v
    }

    /// Advances `state` over any time under `amplitude` times the unit pulse.
    pub fn advance(&self, state: &mut ForcedState, start_s: f64, h_s: f64, amplitude: f64) {
        self.pulse.pieces(start_s, h_s, |piece| {
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
        let gain = amplitude * self.modes.participation[j];
        if piece.driven {
            let phase = &piece.phase;
            let (dx, dv) = ForcedResponse::new(o, piece.sigma_per_s, piece.h_s).increments(phase);
            to = (to.0 + gain * dx, to.1 + gain * dv);
        }
        to
    }
}

impl Exchange {
    pub fn add(&mut self, other: &Self) {
        self.work += other.work;
        self.loss += other.loss;
        for (sum, impulse) in self.support_n_s.iter_mut().zip(other.support_n_s) {
            *sum += impulse;
        }
    }
}

fn carry(f: &Flow, x: f64, v: f64) -> (f64, f64) {
    (
        x + (f.qq.re * x + f.qr.re * v),
        v + (f.rq.re * x + f.rr.re * v),
    )
}
