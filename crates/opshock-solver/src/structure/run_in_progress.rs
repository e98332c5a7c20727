//! Keeps extremes, energies and history of a run at every node, before and after contact is activated.
//!
//! Total motion = amplitude × unit response + contact-driven motion. The second part is at rest
//! until the first touch ([`super::contact_system`] carries it from then on).

use super::closing::{BodyBalance, Closing};
use super::contact_log::ContactLog;
use super::driven::Driven;
use super::energy::{Energies, ExchangedEnergy, LongSum};
use super::error::StructureError;
use super::free_motion::ForcedState;
use super::history::StructuralHistory;
use super::node::Node;
use super::outcome::{StructureRun, StructureWarning};
use super::outlook::Sight;
use super::parameters::Window;
use super::record::{Complementarity, DiskExtremes, StructureColumns};
use super::rotor::{Leap, RotorState};
use super::sample::Sample;
use super::shared::Shared;
use super::snapshot::Snapshots;
use super::span::INTERVAL_NODES;
use crate::complementarity::Gap;
use crate::disk::DiskPose;
use crate::lanes::abreast;
use crate::modal::bank::padded;
use crate::modal::{BankFlow, ModalState, Readout};

/// Steps between two looks for the peaks of the energies, at the nodes where contact-free intervals begin and end.
/// Balances of work and losses are kept at every step.
const ENERGY_NODES: usize = INTERVAL_NODES;

/// All that changes in a run; kept in the workspace so that runs reuse its memory.
#[derive(Default)]
pub(super) struct RunState {
    pub now: ModalState,
    pub ahead: ModalState,
    pub unit_now: ForcedState,
    pub unit_ahead: ForcedState,
    pub total_forced: ForcedState,
    /// Contact-driven motion of the forced modes, in contact-free intervals under the pulse.
    pub forced: ForcedState,
    pub part_flow: BankFlow,
    /// Time of `part_flow`, s.
    pub part_s: f64,
    /// The disk's harmonics on hub or base: driven by contact; no parts without one.
    pub rotor_now: RotorState,
    pub rotor_ahead: RotorState,
    pub part_leap: Leap,
    pub logs: [ContactLog; 2],
    pub history: StructuralHistory,
    columns: StructureColumns,
    pub snapshots: Snapshots,
    pub record: bool,
    pub keeps_motion: bool,
}

pub(super) struct RunInProgress<'a> {
    pub shared: &'a Shared,
    pub amplitude: f64,
    pub state: &'a mut RunState,
    /// Node at or before now.
    pub k: usize,
    /// The contact-driven modes, once activated.
    pub driven: Option<&'a Driven>,
    /// Modes of `driven` that are not at rest, in whole chunks.
    pub n_moving: usize,
    /// Whether `state.total_forced` holds the present state.
    pub is_totalled: bool,
    /// Points at the end of a step, read during that step.
    pub seen: Option<Sight>,
    pub exchanged: ExchangedEnergy,
    pub complementarity: Complementarity,
    /// Steps in which bounces were taken as lasting contact.
    pub accumulated_steps: u64,
    /// Both arms held one point.
    pub both_arms: bool,
    pub bodies: Option<BodyBalance>,
    energies: Energies,
    pub extremes: DiskExtremes,
    decayed: bool,
    /// First node whose motion is not a finite number.
    not_finite: Option<usize>,
}

impl RunState {
    pub fn prepare(&mut self, shared: &Shared, record: bool, keeps_motion: bool) {
        let n_forced = shared.free.modes.oscillators.len();
        let rotor = shared.free.rotor.as_ref();
        let has_shape = match rotor {
            Some(rotor) => rotor.is_of(&self.rotor_now),
            None => self.rotor_now.parts.is_empty(),
        };
        if self.unit_now.x.len() != padded(n_forced) || !has_shape {
            self.unit_now = ForcedState::at_rest(n_forced, rotor);
            self.unit_ahead = self.unit_now.clone();
            self.total_forced = self.unit_now.clone();
            self.forced = self.unit_now.clone();
            self.rotor_now = self.unit_now.rotor.clone();
            self.rotor_ahead = self.unit_now.rotor.clone();
            self.part_leap = rotor.map_or_else(Leap::default, |rotor| rotor.step.clone());
        }
        // Padding stays at rest, whatever an earlier model left there.
        self.total_forced.x.fill(0.0);
        self.total_forced.v.fill(0.0);
        self.forced.x.fill(0.0);
        self.forced.v.fill(0.0);
        self.rotor_now.reset();
        self.logs.iter_mut().for_each(ContactLog::clear);
        let n_nodes = if keeps_motion { shared.n_steps + 1 } else { 0 };
        self.history = shared.history(n_nodes);
        self.columns = StructureColumns::default();
        self.record = record;
        self.keeps_motion = keeps_motion;
    }

    /// Makes room for the contact-driven state, at rest.
    fn activate(&mut self, driven: &Driven) {
        let n = driven.oscillators.len();
        // No flow of this model yet.
        self.part_s = f64::NAN;
        if self.now.len() == n {
            self.now.reset();
            self.ahead.reset();
        } else {
            self.now = ModalState::at_rest(n);
            self.ahead = ModalState::at_rest(n);
            self.part_flow = BankFlow::zeros(n);
        }
    }
}

impl<'a> RunInProgress<'a> {
    pub fn new(shared: &'a Shared, amplitude: f64, state: &'a mut RunState) -> Self {
        Self {
            shared,
            amplitude,
            state,
            k: 0,
            driven: None,
            n_moving: 0,
            is_totalled: false,
            seen: None,
            exchanged: ExchangedEnergy::default(),
            complementarity: Complementarity::default(),
            accumulated_steps: 0,
            both_arms: false,
            bodies: (shared.free.rotor.is_some()).then(|| BodyBalance::of(amplitude)),
            energies: Energies::default(),
            extremes: DiskExtremes::default(),
            decayed: false,
            not_finite: None,
        }
    }

    pub fn decayed(&self) -> bool {
        self.decayed
    }

    pub fn sample(&self) -> &'a Sample {
        &self.shared.free.samples[self.k]
    }

    /// Free motion over one step: nothing to compute.
    pub fn inactive_step(&mut self) {
        self.k += 1;
    }

    /// Activates the contact-driven state, at rest at the node reached.
    pub fn activate(&mut self, driven: &'a Driven) {
        self.driven = Some(driven);
        self.n_moving = driven.n_of_arms();
        self.state.activate(driven);
        let free = &self.shared.free;
        free.state_at_node(self.k, &mut self.state.unit_now);
        let sample = self.sample();
        let a2 = self.amplitude * self.amplitude;
        self.exchanged.work = LongSum::from_value(a2 * sample.work);
        self.exchanged.damping = LongSum::from_value(a2 * sample.loss);
    }

    /// Pose and rate of the disk under the slider in free motion, without the part of the rotor.
    pub fn free_slider(&self, sample: &Sample) -> (DiskPose, DiskPose) {
        let a = self.amplitude;
        let [pitch, roll] = self.shared.slope_to_pose;
        let pose = DiskPose {
            displacement_m: a * sample.slider.value,
            pitch_rad: a * pitch * sample.slider_slope.value,
            roll_rad: a * roll * sample.slider_slope.value,
        };
        let rate = DiskPose {
            displacement_m: a * sample.slider.rate,
            pitch_rad: a * pitch * sample.slider_slope.rate,
            roll_rad: a * roll * sample.slider_slope.rate,
        };
        (pose, rate)
    }

    /// Pose and rate of the disk under the slider now.
    pub fn slider(&self, sample: &Sample) -> (DiskPose, DiskPose) {
        let a = self.amplitude;
        let (mut pose, mut rate) = self.free_slider(sample);
        if let Some(rotor) = &self.shared.free.rotor {
            let [pitch, roll] = sample.tilt;
            pose.pitch_rad += a * pitch.value;
            pose.roll_rad += a * roll.value;
            rate.pitch_rad += a * pitch.rate;
            rate.roll_rad += a * roll.rate;
            if self.driven.is_some() {
                rotor.add_slider(&self.state.rotor_now, &mut pose, &mut rate);
            }
        }
        if let Some(driven) = self.driven {
            let (n, now) = (self.n_moving, &self.state.now);
            let rows = &driven.slider;
            let driven = [
                Readout::read_three(rows, &now.q_re[..n], &now.q_im[..n]),
                Readout::read_three(rows, &now.r_re[..n], &now.r_im[..n]),
            ];
            for (pose, [w, pitch, roll]) in [&mut pose, &mut rate].into_iter().zip(driven) {
                pose.displacement_m += w;
                pose.pitch_rad += pitch;
                pose.roll_rad += roll;
            }
        }
        (pose, rate)
    }

    /// The displacement of [`Self::slider`], to the same bits.
    fn slider_displacement_m(&self, sample: &Sample) -> f64 {
        let mut displacement_m = self.amplitude * sample.slider.value;
        if let Some(sight) = &self.seen {
            displacement_m += sight.slider_m;
        } else if let Some(driven) = self.driven {
            let (n, now) = (self.n_moving, &self.state.now);
            displacement_m += driven.slider[0].read(&now.q_re[..n], &now.q_im[..n]);
            if let Some(rotor) = &self.shared.free.rotor {
                displacement_m += rotor.slider_m(&self.state.rotor_now);
            }
        }
        displacement_m
    }

    /// Adds the node reached to balances and history.
    pub fn record_node(&mut self) {
        let (shared, sample) = (self.shared, self.sample());
        // Only the head reads rates; columns hold slopes as well.
        let (pose, rate) = if self.state.keeps_motion || self.state.record {
            self.slider(sample)
        } else {
            let displacement_m = self.slider_displacement_m(sample);
            let pose = DiskPose {
                displacement_m,
                ..DiskPose::default()
            };
            (pose, DiskPose::default())
        };
        let sum = pose.displacement_m + pose.pitch_rad + pose.roll_rad;
        if !sum.is_finite() && self.not_finite.is_none() {
            self.not_finite = Some(self.k);
        }
        let is_look = self.k.is_multiple_of(ENERGY_NODES);
        let may_end = matches!(shared.window, Window::UntilDecayed { .. });
        if is_look || may_end || self.state.record {
            self.energies = self.energies_now();
        }
        if self.state.keeps_motion {
            self.keep_motion(self.k, pose, rate);
        }
        let node = self.node(pose);
        self.extremes.include(&node);
        self.record_bodies();
        let material = self.energies.material();
        if is_look {
            let exchanged = &mut self.exchanged;
            exchanged.peak_fixed_frame = exchanged.peak_fixed_frame.max(self.energies.fixed_frame);
            exchanged.peak_material = exchanged.peak_material.max(material);
        }
        self.decayed = self.has_decayed(self.k, material);
        if self.state.record {
            self.push_row(&node);
        }
    }

    /// Appends the node reached to the columns and, where it is asked for, its state to the snapshots.
    fn push_row(&mut self, node: &Node) {
        let (n, state) = (self.driven.map_or(0, |_| self.n_moving), &mut *self.state);
        state.columns.push(node);
        let modes = [&state.now.q_re, &state.now.q_im].map(|column| &column[..n]);
        (state.snapshots).offer(self.k, modes, &state.rotor_now, self.amplitude);
    }

    /// Appends a row of the columns for a node within a contact-free interval, which neither extremes nor peaks need.
    pub fn record_within(&mut self, pose: DiskPose) {
        self.energies = self.energies_now();
        let node = self.node(pose);
        self.push_row(&node);
    }

    /// Whether the run ends at node `k` with this material energy.
    pub fn has_decayed(&self, k: usize, material_j: f64) -> bool {
        let Window::UntilDecayed { share, .. } = self.shared.window else {
            return false;
        };
        let is_driven = (k as f64 * self.shared.free.step_s) < self.shared.free.pulse_end_s;
        !is_driven && material_j <= share * self.exchanged.peak_material
    }

    /// Appends node `k` to the history that the head reads.
    pub fn keep_motion(&mut self, k: usize, pose: DiskPose, rate: DiskPose) {
        let time_s = k as f64 * self.shared.free.step_s;
        let (pose, rate) = self.shared.over_pivot(self.amplitude, time_s, pose, rate);
        self.state.history.pose.push(pose);
        self.state.history.rate.push(rate);
        let (pose, rate) = self.pivot();
        if let Some(pivot) = &mut self.state.history.pivot {
            pivot.pose.push(pose);
            pivot.rate.push(rate);
        }
    }

    /// The node reached, with the disk's `pose` under the slider there.
    fn node(&self, pose: DiskPose) -> Node {
        let (shared, sample, a) = (self.shared, self.sample(), self.amplitude);
        let (mut ramp, mut rim) = (a * sample.contact.value, a * sample.rim);
        let mut arms = [a * sample.top.value, a * sample.bottom.value];
        if let Some(driven) = self.driven {
            let now = &self.state.now;
            let moving = &now.q_re[..self.n_moving];
            let [by_contact, at_rim] = match &self.seen {
                Some(sight) => [sight.contact.value_m, sight.rim_m],
                None => abreast([[&driven.contact, moving], [&driven.rim, moving]]),
            };
            ramp += by_contact;
            rim += at_rim;
            if let Some(rotor) = &shared.free.rotor {
                ramp += rotor.contact(&self.state.rotor_now).value_m;
                rim += rotor.rim_m(&self.state.rotor_now);
            }
            for (side, x) in arms.iter_mut().enumerate() {
                for j in driven.arms[side].modes.clone() {
                    *x += driven.arm_shape[side][j] * now.q_re[j];
                }
                if let Some(rotor) = &shared.free.rotor {
                    *x += rotor.arm(side, &self.state.rotor_now).value_m;
                }
            }
        }
        let time_s = self.k as f64 * shared.free.step_s;
        Node {
            time_s,
            shock_m_per_s2: match self.state.record {
                true => a * shared.pulse.value(time_s),
                // Only columns hold it.
                false => 0.0,
            },
            pose,
            ramp_m: ramp,
            rim_m: rim,
            arms_m: arms,
            energies: self.energies,
        }
    }

    /// Energies at the node reached.
    pub fn energies_now(&mut self) -> Energies {
        let shared = self.shared;
        if let Some(driven) = self.driven {
            self.total_forced(driven);
            let state = &mut *self.state;
            // The forced modes' total stands in their places while the sums are made.
            let ForcedState { x, v, .. } = &mut state.total_forced;
            swap_forced(driven, &mut state.now, x, v);
            let mut energies = driven.weights.energies(&state.now);
            swap_forced(driven, &mut state.now, x, v);
            if let Some(rotor) = &shared.free.rotor {
                let ForcedState {
                    rotor: total,
                    scratch,
                    ..
                } = &mut state.total_forced;
                energies.add(&rotor.energies(total, scratch));
            }
            return energies;
        }
        let (a2, sample) = (self.amplitude * self.amplitude, self.sample());
        let energy = a2 * sample.energy;
        // Where the disk's motion is axisymmetric both energies agree.
        let mut energies = Energies {
            kinetic: a2 * sample.kinetic,
            elastic: energy - a2 * sample.kinetic,
            fixed_frame: energy,
        };
        if sample.excess != 0.0 {
            energies.fixed_frame += a2 * sample.excess;
        }
        energies
    }

    /// Contact-driven displacement of the pivot, and its rate.
    pub fn pivot(&self) -> (DiskPose, DiskPose) {
        let along = |displacement_m: f64| DiskPose {
            displacement_m,
            ..DiskPose::default()
        };
        let rotor = self
            .shared
            .free
            .rotor
            .as_ref()
            .filter(|_| self.driven.is_some());
        let at = rotor.map_or_else(Gap::default, |rotor| rotor.pivot(&self.state.rotor_now));
        (along(at.value_m), along(at.rate_m_per_s))
    }

    /// Adds hub and base at the node reached to their balances: the unit response times the amplitude plus the
    /// contact-driven part.
    fn record_bodies(&mut self) {
        let (Some(balance), Some(rotor)) = (&mut self.bodies, &self.shared.free.rotor) else {
            return;
        };
        let mut now = self.shared.free.bodies[self.k].times(self.amplitude);
        if self.driven.is_some() {
            let driven = rotor.bodies(&self.state.rotor_now, [0.0; 2]);
            now = now.plus(&driven);
            now.support_n_s = balance.now.support_n_s;
        }
        balance.include(now);
        if self.state.record {
            self.state.columns.push_bodies(&now, rotor.has_bodies());
        }
    }

    /// Fills the total state of the forced modes: contact-driven plus amplitude times unit response.
    pub fn total_forced(&mut self, driven: &Driven) {
        if self.is_totalled {
            return;
        }
        self.is_totalled = true;
        let state = &mut *self.state;
        // At a node the unit response in `unit_now` is that of the samples.
        for (j, &i) in driven.forced_index.iter().enumerate() {
            let x = state.now.q_re[i] + self.amplitude * state.unit_now.x[j];
            let v = state.now.r_re[i] + self.amplitude * state.unit_now.v[j];
            (state.total_forced.x[j], state.total_forced.v[j]) = (x, v);
        }
        let total = &mut state.total_forced.rotor;
        total.copy_from(&state.rotor_now);
        total.add(&state.unit_now.rotor, self.amplitude);
    }

    /// Closes the balances.
    ///
    /// # Errors
    /// [`StructureError::NotFinite`].
    pub fn finish(mut self) -> Result<StructureRun, StructureError> {
        let energies = self.energies_now();
        let mut exchanged = self.exchanged;
        if self.driven.is_none() {
            let (a2, sample) = (self.amplitude * self.amplitude, self.sample());
            exchanged.work = LongSum::from_value(a2 * sample.work);
            exchanged.damping = LongSum::from_value(a2 * sample.loss);
        }
        let state = self.state;
        let history = std::mem::take(&mut state.history);
        let columns = std::mem::take(&mut state.columns);
        let closing = Closing {
            shared: self.shared,
            driven: self.driven,
            k: self.k,
            not_finite: self.not_finite,
            energies,
            exchanged,
            extremes: self.extremes,
            complementarity: self.complementarity,
            bodies: self.bodies,
            logs: &state.logs,
            history,
            columns: state.record.then_some(columns),
        };
        let mut run = closing.run()?;
        if self.accumulated_steps > 0 {
            run.warnings.push(StructureWarning::BouncesAccumulated {
                steps: self.accumulated_steps,
            });
        }
        if self.both_arms {
            run.warnings.push(StructureWarning::BothArmsOnePoint);
        }
        Ok(run)
    }
}

/// Exchanges displacements and velocities of the forced modes with `x` and `v`.
fn swap_forced(driven: &Driven, state: &mut ModalState, x: &mut [f64], v: &mut [f64]) {
    for ((&i, x), v) in driven.forced_index.iter().zip(x).zip(v) {
        std::mem::swap(&mut state.q_re[i], x);
        std::mem::swap(&mut state.r_re[i], v);
    }
}
