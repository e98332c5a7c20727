//! Disk and arms as a unilateral system, and everything a run keeps of it.
//!
//! Total motion = amplitude × unit response + contact-driven motion. The second part is at rest
//! until the first touch; from then on it is carried by its exact flow and kicked by impulses.

use super::Window;
use super::closing::{BodyBook, Closing};
use super::contact_log::ContactLog;
use super::energy::{Energies, Ledger, LongSum};
use super::free_motion::{ForcedState, Sample};
use super::history::{Break, StructuralHistory};
use super::model::{Shared, StructureError, StructureRun, StructureWarning};
use super::node::Node;
use super::record::{Complementarity, DiskExtremes, StructureColumns};
use super::rotor::{self, Leap, RotorState};
use crate::complementarity::{Gap, ImpulseKind, StepReport, UnilateralSystem};
use crate::disk::DiskPose;
use crate::lanes::abreast;
use crate::modal::bank::{dot, padded};
use crate::modal::{BankFlow, ModalState, Readout};

/// Impacts closer than this share an event of the head's integration, s.
pub(super) const EVENT_SPACING_S: f64 = 2e-6;
/// In a fixed window the peaks of the energies are looked for in every node of so many. Books of work
/// and losses are kept at every step.
const ENERGY_NODES: usize = 8;

/// All that changes in a run; kept in the workspace so that runs reuse its memory.
#[derive(Default)]
pub(super) struct RunState {
    now: ModalState,
    ahead: ModalState,
    total: ModalState,
    unit_now: ForcedState,
    unit_ahead: ForcedState,
    total_forced: ForcedState,
    part_flow: BankFlow,
    /// The disk's harmonics on hub or base: driven by contact; no parts without one.
    rotor_now: RotorState,
    rotor_ahead: RotorState,
    part_leap: Leap,
    logs: [ContactLog; 2],
    history: StructuralHistory,
    columns: StructureColumns,
    record: bool,
    keeps_motion: bool,
}

pub(super) struct ContactSystem<'a> {
    shared: &'a Shared,
    amplitude: f64,
    state: &'a mut RunState,
    /// Node at or before now.
    k: usize,
    /// Time since that node.
    offset_s: f64,
    /// Time from now to the instant ahead.
    reach_s: f64,
    awake: bool,
    /// `gaps` are those of the node at `k`.
    is_settled: bool,
    /// `total_forced` is the state now.
    is_totalled: bool,
    gaps: [Gap; 2],
    gaps_ahead: [Gap; 2],
    sample_ahead: Sample,
    ledger: Ledger,
    energies: Energies,
    extremes: DiskExtremes,
    complementarity: Complementarity,
    accumulated_steps: u64,
    both_arms: bool,
    bodies: Option<BodyBook>,
    decayed: bool,
    /// First node whose motion is not a finite number.
    not_finite: Option<usize>,
}

impl RunState {
    pub fn prepare(&mut self, shared: &Shared, record: bool, keeps_motion: bool) {
        let n = shared.oscillators.len();
        if self.now.len() == n {
            self.now.reset();
        } else {
            self.now = ModalState::at_rest(n);
            self.ahead = ModalState::at_rest(n);
            self.total = ModalState::at_rest(n);
            self.part_flow = BankFlow::zeros(n);
        }
        let n_forced = shared.forced_index.len();
        let rotor = shared.free.rotor.as_ref();
        let has_shape = match rotor {
            Some(rotor) => rotor.is_of(&self.rotor_now),
            None => self.rotor_now.parts.is_empty(),
        };
        if self.unit_now.x.len() != padded(n_forced) || !has_shape {
            self.unit_now = ForcedState::at_rest(n_forced, rotor);
            self.unit_ahead = self.unit_now.clone();
            self.total_forced = self.unit_now.clone();
            self.rotor_now = self.unit_now.rotor.clone();
            self.rotor_ahead = self.unit_now.rotor.clone();
            self.part_leap = rotor.map_or_else(Leap::default, |rotor| rotor.step.clone());
        }
        // Padding stays at rest, whatever an earlier model left there.
        self.total_forced.x.fill(0.0);
        self.total_forced.v.fill(0.0);
        self.rotor_now.reset();
        self.logs.iter_mut().for_each(ContactLog::clear);
        let n_nodes = if keeps_motion { shared.n_steps + 1 } else { 0 };
        self.history = StructuralHistory {
            step_s: shared.free.step_s,
            pose: Vec::with_capacity(n_nodes),
            rate: Vec::with_capacity(n_nodes),
            breaks: Vec::new(),
            events_s: vec![0.0],
            pivot: shared.pivot_history(n_nodes),
        };
        self.columns = StructureColumns::default();
        self.record = record;
        self.keeps_motion = keeps_motion;
    }
}

impl<'a> ContactSystem<'a> {
    pub fn new(shared: &'a Shared, amplitude: f64, state: &'a mut RunState) -> Self {
        Self {
            shared,
            amplitude,
            state,
            k: 0,
            offset_s: 0.0,
            reach_s: 0.0,
            awake: false,
            is_settled: false,
            is_totalled: false,
            gaps: [Gap::default(); 2],
            gaps_ahead: [Gap::default(); 2],
            sample_ahead: Sample::default(),
            ledger: Ledger::default(),
            energies: Energies::default(),
            extremes: DiskExtremes::default(),
            complementarity: Complementarity::default(),
            accumulated_steps: 0,
            both_arms: false,
            bodies: (shared.free.rotor.is_some()).then(|| BodyBook::of(amplitude)),
            decayed: false,
            not_finite: None,
        }
    }

    pub fn decayed(&self) -> bool {
        self.decayed
    }

    fn now_s(&self) -> f64 {
        self.k as f64 * self.shared.free.step_s + self.offset_s
    }

    fn sample(&self) -> &'a Sample {
        &self.shared.free.samples[self.k]
    }

    /// Free motion over one step: nothing to compute.
    pub fn sleep_step(&mut self) {
        self.k += 1;
    }

    /// Wakes the contact-driven state at its first use.
    pub fn begin_step(&mut self) {
        if !self.awake {
            self.awake = true;
            self.shared
                .free
                .state_at_node(self.k, &mut self.state.unit_now);
            let sample = self.sample();
            let a2 = self.amplitude * self.amplitude;
            self.ledger.work = LongSum::from_value(a2 * sample.work);
            self.ledger.damping = LongSum::from_value(a2 * sample.loss);
        }
        self.settle();
    }

    /// Takes the gaps at the node reached, where the step before has not left them.
    fn settle(&mut self) {
        if !self.is_settled {
            self.gaps = self.gaps_at_node();
            self.is_settled = true;
        }
    }

    /// Settles at the next node.
    pub fn end_step(&mut self, report: StepReport) {
        self.k += 1;
        self.offset_s = 0.0;
        self.accumulated_steps += u64::from(report.accumulated);
        self.settle();
        for gap in self.gaps.iter().take(self.shared.n_contacts) {
            let depth = -gap.value_m;
            let largest = &mut self.complementarity.max_penetration_m;
            *largest = largest.max(depth);
        }
    }

    /// Gaps at the node reached.
    fn gaps_at_node(&self) -> [Gap; 2] {
        self.gaps_of(&self.state.now, &self.state.rotor_now, self.sample())
    }

    /// Gaps of a contact-driven state on top of the unit response `sample`.
    fn gaps_of(&self, driven: &ModalState, hub: &RotorState, sample: &Sample) -> [Gap; 2] {
        let shared = self.shared;
        let [value_m, rate_m_per_s] = abreast([
            [&shared.contact, &driven.q_re],
            [&shared.contact, &driven.r_re],
        ]);
        let mut disk = Gap {
            value_m,
            rate_m_per_s,
        };
        if let Some(rotor) = &shared.free.rotor {
            let on_hub = rotor.contact(hub);
            disk.value_m += on_hub.value_m;
            disk.rate_m_per_s += on_hub.rate_m_per_s;
        }
        std::array::from_fn(|side| {
            if side >= shared.n_contacts {
                return Gap::default();
            }
            let mut arm = Gap::default();
            for j in shared.arms[side].modes.clone() {
                arm.value_m += shared.arm_shape[side][j] * driven.q_re[j];
                arm.rate_m_per_s += shared.arm_shape[side][j] * driven.r_re[j];
            }
            if let Some(rotor) = &shared.free.rotor {
                let on_base = rotor.arm(side, hub);
                arm.value_m += on_base.value_m;
                arm.rate_m_per_s += on_base.rate_m_per_s;
            }
            let free = shared.free_gap(side, self.amplitude, sample);
            let sign = if side == 0 { 1.0 } else { -1.0 };
            Gap {
                value_m: free.value_m + sign * (arm.value_m - disk.value_m),
                rate_m_per_s: free.rate_m_per_s + sign * (arm.rate_m_per_s - disk.rate_m_per_s),
            }
        })
    }

    /// Pose and rate of the disk under the slider now.
    fn slider(&self, sample: &Sample) -> (DiskPose, DiskPose) {
        let a = self.amplitude;
        let [pitch, roll] = self.shared.slope_to_pose;
        let mut pose = DiskPose {
            displacement_m: a * sample.slider.value,
            pitch_rad: a * pitch * sample.slider_slope.value,
            roll_rad: a * roll * sample.slider_slope.value,
        };
        let mut rate = DiskPose {
            displacement_m: a * sample.slider.rate,
            pitch_rad: a * pitch * sample.slider_slope.rate,
            roll_rad: a * roll * sample.slider_slope.rate,
        };
        if let Some(rotor) = &self.shared.free.rotor {
            let [pitch, roll] = sample.tilt;
            pose.pitch_rad += a * pitch.value;
            pose.roll_rad += a * roll.value;
            rate.pitch_rad += a * pitch.rate;
            rate.roll_rad += a * roll.rate;
            if self.awake {
                rotor.add_slider(&self.state.rotor_now, &mut pose, &mut rate);
            }
        }
        if self.awake {
            let n = self.shared.n_disk;
            let now = &self.state.now;
            let rows = &self.shared.slider;
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
        if self.awake {
            let n = self.shared.n_disk;
            let now = &self.state.now;
            displacement_m += self.shared.slider[0].read(&now.q_re[..n], &now.q_im[..n]);
            if let Some(rotor) = &self.shared.free.rotor {
                displacement_m += rotor.slider_m(&self.state.rotor_now);
            }
        }
        displacement_m
    }

    /// Books the node reached.
    pub fn record_node(&mut self) {
        let (shared, sample, a) = (self.shared, self.sample(), self.amplitude);
        // Rates are the head's alone; slopes also stand in columns.
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
        let (mut ramp, mut rim) = (a * sample.contact.value, a * sample.rim);
        let mut arms = [a * sample.top.value, a * sample.bottom.value];
        if self.awake {
            let now = &self.state.now;
            let [by_contact, at_rim] =
                abreast([[&shared.contact, &now.q_re], [&shared.rim, &now.q_re]]);
            ramp += by_contact;
            rim += at_rim;
            if let Some(rotor) = &shared.free.rotor {
                ramp += rotor.contact(&self.state.rotor_now).value_m;
                rim += rotor.rim_m(&self.state.rotor_now);
            }
            for (side, x) in arms.iter_mut().enumerate() {
                for j in shared.arms[side].modes.clone() {
                    *x += shared.arm_shape[side][j] * now.q_re[j];
                }
                if let Some(rotor) = &shared.free.rotor {
                    *x += rotor.arm(side, &self.state.rotor_now).value_m;
                }
            }
        }
        let is_look = match shared.window {
            Window::Fixed { .. } => self.k.is_multiple_of(ENERGY_NODES),
            Window::UntilDecayed { .. } => true,
        };
        if is_look || self.state.record {
            self.energies = self.energies_now();
        }
        let time_s = self.k as f64 * shared.free.step_s;
        if self.state.keeps_motion {
            let (pose, rate) = shared.over_pivot(a, time_s, pose, rate);
            self.state.history.pose.push(pose);
            self.state.history.rate.push(rate);
            let (pose, rate) = self.pivot();
            if let Some(pivot) = &mut self.state.history.pivot {
                pivot.pose.push(pose);
                pivot.rate.push(rate);
            }
        }
        let node = Node {
            time_s,
            shock_m_per_s2: a * shared.pulse.value(time_s),
            pose,
            ramp_m: ramp,
            rim_m: rim,
            arms_m: arms,
            energies: self.energies,
        };
        self.extremes.include(&node);
        self.record_bodies();
        if is_look {
            let material = self.energies.material();
            let ledger = &mut self.ledger;
            ledger.peak_fixed_frame = ledger.peak_fixed_frame.max(self.energies.fixed_frame);
            ledger.peak_material = ledger.peak_material.max(material);
            if let Window::UntilDecayed { share, .. } = shared.window {
                self.decayed =
                    time_s >= shared.free.pulse_end_s && material <= share * ledger.peak_material;
            }
        }
        if self.state.record {
            self.state.columns.push(&node);
        }
    }

    /// Energies at the node reached.
    fn energies_now(&mut self) -> Energies {
        let shared = self.shared;
        if self.awake {
            self.total_forced();
            let state = &mut *self.state;
            state.total.copy_from(&state.now);
            for (j, &i) in shared.forced_index.iter().enumerate() {
                state.total.q_re[i] = state.total_forced.x[j];
                state.total.r_re[i] = state.total_forced.v[j];
            }
            let mut energies = shared.weights.energies(&state.total);
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

    /// What contact has done to the pivot by now, and its rate.
    fn pivot(&self) -> (DiskPose, DiskPose) {
        let along = |displacement_m: f64| DiskPose {
            displacement_m,
            ..DiskPose::default()
        };
        let rotor = self.shared.free.rotor.as_ref().filter(|_| self.awake);
        let at = rotor.map_or_else(Gap::default, |rotor| rotor.pivot(&self.state.rotor_now));
        (along(at.value_m), along(at.rate_m_per_s))
    }

    /// Books hub and base at the node reached: as every point, the unit response times the amplitude and what
    /// contact adds.
    fn record_bodies(&mut self) {
        let (Some(book), Some(rotor)) = (&mut self.bodies, &self.shared.free.rotor) else {
            return;
        };
        let mut now = self.shared.free.bodies[self.k].times(self.amplitude);
        if self.awake {
            let driven = rotor.bodies(&self.state.rotor_now, [0.0; 2]);
            now = now.plus(&driven);
            now.support_n_s = book.now.support_n_s;
        }
        book.include(now);
        if self.state.record {
            self.state.columns.push_bodies(&now, rotor.has_bodies());
        }
    }

    /// Fills the total state of the forced modes: contact-driven plus amplitude times unit response.
    fn total_forced(&mut self) {
        if self.is_totalled {
            return;
        }
        self.is_totalled = true;
        let state = &mut *self.state;
        // At a node the unit response in `unit_now` is the one behind the samples.
        for (j, &i) in self.shared.forced_index.iter().enumerate() {
            let x = state.now.q_re[i] + self.amplitude * state.unit_now.x[j];
            let v = state.now.r_re[i] + self.amplitude * state.unit_now.v[j];
            (state.total_forced.x[j], state.total_forced.v[j]) = (x, v);
        }
        let total = &mut state.total_forced.rotor;
        total.copy_from(&state.rotor_now);
        total.add(&state.unit_now.rotor, self.amplitude);
    }

    /// Work and loss from now to the instant ahead.
    fn book_free_motion(&mut self) {
        let (shared, reach) = (self.shared, self.reach_s);
        self.total_forced();
        let is_whole = self.is_whole_step();
        let now_s = self.now_s();
        let state = &mut *self.state;
        let free = &shared.free;
        let exchange = if is_whole {
            self.ledger
                .damping
                .add(shared.weights.step_loss(&state.now));
            free.exchange(&mut state.total_forced, self.k, self.amplitude)
        } else {
            for (i, o) in shared.oscillators.iter().enumerate() {
                if !shared.forced_index.contains(&i) {
                    let q = nalgebra::Complex::new(state.now.q_re[i], state.now.q_im[i]);
                    let r = nalgebra::Complex::new(state.now.r_re[i], state.now.r_im[i]);
                    self.ledger.damping.add(o.loss_form(reach).loss(q, r));
                }
            }
            free.exchange_within(&mut state.total_forced, now_s, reach, self.amplitude)
        };
        self.ledger.work.add(exchange.work);
        self.ledger.damping.add(exchange.loss);
        if let Some(book) = &mut self.bodies {
            book.add_supports(exchange.support_n_s);
        }
    }

    fn gaps_at_reach(&self) -> [Gap; 2] {
        let state = &*self.state;
        self.gaps_of(&state.ahead, &state.rotor_ahead, &self.sample_ahead)
    }

    fn is_whole_step(&self) -> bool {
        self.offset_s == 0.0 && self.reach_s == self.shared.free.step_s
    }

    /// Closes the books.
    ///
    /// # Errors
    /// [`StructureError::NotFinite`].
    pub fn finish(mut self) -> Result<StructureRun, StructureError> {
        let energies = self.energies_now();
        let mut ledger = self.ledger;
        if !self.awake {
            let (a2, sample) = (self.amplitude * self.amplitude, self.sample());
            ledger.work = LongSum::from_value(a2 * sample.work);
            ledger.damping = LongSum::from_value(a2 * sample.loss);
        }
        let state = self.state;
        let history = std::mem::take(&mut state.history);
        let columns = std::mem::take(&mut state.columns);
        let closing = Closing {
            shared: self.shared,
            k: self.k,
            not_finite: self.not_finite,
            energies,
            ledger,
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

impl UnilateralSystem for ContactSystem<'_> {
    fn gaps(&self) -> [Gap; 2] {
        self.gaps
    }

    fn n_contacts(&self) -> usize {
        self.shared.n_contacts
    }

    fn look_ahead(&mut self, h_s: f64) {
        self.reach_s = h_s;
        let shared = self.shared;
        let free = &shared.free;
        if self.is_whole_step() {
            let state = &mut *self.state;
            shared.step_flow.apply(&state.now, &mut state.ahead);
            if let Some(rotor) = &free.rotor {
                rotor.flow(&state.rotor_now, None, &mut state.rotor_ahead);
            }
            // The unit response itself is stepped only when the step is committed.
            self.sample_ahead = free.samples[self.k + 1];
        } else {
            let start_s = self.now_s();
            let state = &mut *self.state;
            state.part_flow.set(&shared.oscillators, h_s);
            state.part_flow.apply(&state.now, &mut state.ahead);
            if let Some(rotor) = &free.rotor {
                rotor.set_leap(h_s, None, &mut state.part_leap);
                let leap = Some(&state.part_leap);
                rotor.flow(&state.rotor_now, leap, &mut state.rotor_ahead);
            }
            state.unit_ahead.copy_from(&state.unit_now);
            free.advance(&mut state.unit_ahead, start_s, h_s, 1.0);
            self.sample_ahead = free.sample(&state.unit_ahead);
        }
        self.gaps_ahead = self.gaps_at_reach();
    }

    fn gaps_ahead(&self) -> [Gap; 2] {
        self.gaps_ahead
    }

    fn mobility(&self) -> [[f64; 2]; 2] {
        self.shared.mobility
    }

    fn compliance_ahead(&self) -> [[f64; 2]; 2] {
        let shared = self.shared;
        let flow = if self.is_whole_step() {
            &shared.step_flow
        } else {
            &self.state.part_flow
        };
        let disk = flow.compliance(&shared.contact);
        let [top, bottom] = &shared.arm_shape;
        let across = match shared.coupled {
            true => disk + flow.compliance_across(top, bottom),
            false => disk,
        };
        let mut compliance = [
            [disk + flow.compliance(top), -across],
            [-across, disk + flow.compliance(bottom)],
        ];
        if let Some(rotor) = &shared.free.rotor {
            let partial = (!self.is_whole_step()).then_some(&self.state.part_leap);
            rotor::add(&mut compliance, &rotor.compliance(partial));
        }
        compliance
    }

    fn ripple_loss(&self) -> [[f64; 2]; 2] {
        self.shared.ripple_loss
    }

    fn impulse(&mut self, impulse_n_s: [f64; 2], kind: ImpulseKind) {
        let shared = self.shared;
        let [p, time_s] = [impulse_n_s, [self.now_s(); 2]];
        let rate = [self.gaps[0].rate_m_per_s, self.gaps[1].rate_m_per_s];
        let w = shared.mobility;
        let jump: [f64; 2] = std::array::from_fn(|i| w[i][0] * p[0] + w[i][1] * p[1]);

        // Energy: half the sum of the gap velocities before and after, per impulse.
        let change: f64 = (0..2).map(|i| p[i] * (rate[i] + 0.5 * jump[i])).sum();
        match kind {
            ImpulseKind::Impact => self.ledger.impact -= change,
            ImpulseKind::Sustained => {
                // Damping of the ripple is the impulses' doing and not the structure's.
                let r = shared.ripple_loss;
                let ripple: f64 = (0..2)
                    .map(|i| p[i] * (r[i][0] * p[0] + r[i][1] * p[1]))
                    .sum();
                self.ledger.algorithmic += change - ripple;
                self.ledger.damping.add(-ripple);
            }
        }
        let on_disk = p[1] - p[0];
        let mut w_theta = -dot(&shared.contact_turn, &self.state.now.q_im);
        if let Some(rotor) = &shared.free.rotor {
            w_theta += rotor.contact_turn(&self.state.rotor_now);
            w_theta += self.amplitude * rotor.contact_turn(&self.state.unit_now.rotor);
        }
        if let Some(book) = &mut self.bodies {
            book.contact_n_s += on_disk;
        }
        self.ledger.spindle += on_disk * shared.spin_rad_per_s * w_theta;

        let record = &mut self.complementarity;
        for side in 0..2 {
            record.min_multiplier_n_s = record.min_multiplier_n_s.min(p[side]);
            let product = (p[side] * self.gaps[side].value_m).abs();
            record.max_product_n_s_m = record.max_product_n_s_m.max(product);
            if p[side] != 0.0 {
                self.state.logs[side].push(time_s[side], p[side]);
            }
        }
        let singular = w[0][0] * w[1][1] <= w[0][1] * w[1][0] * (1.0 + 1e-14);
        let closed = |g: &Gap| g.value_m <= shared.law.gap_tolerance_m;
        self.both_arms |= singular && self.gaps.iter().all(closed);

        self.book_jump(p, kind);

        (self.is_settled, self.is_totalled) = (false, false);
        let state = &mut *self.state;
        let flow = if self.offset_s == 0.0 && self.reach_s == shared.free.step_s {
            &shared.step_flow
        } else {
            &state.part_flow
        };
        state.now.kick(&shared.contact, on_disk);
        flow.add_kick(&shared.contact, on_disk, &mut state.ahead);
        if let Some(rotor) = &shared.free.rotor {
            let is_partial = self.offset_s != 0.0 || self.reach_s != shared.free.step_s;
            let partial = is_partial.then_some(&state.part_leap);
            rotor.kick(p, partial, &mut state.rotor_now, &mut state.rotor_ahead);
        }
        for (side, force) in [(0, p[0]), (1, -p[1])] {
            if force != 0.0 && !shared.arms[side].modes.is_empty() {
                state.now.kick(&shared.arm_shape[side], force);
                flow.add_kick(&shared.arm_shape[side], force, &mut state.ahead);
            }
        }
        for side in 0..2 {
            self.gaps[side].rate_m_per_s = rate[side] + jump[side];
        }
        self.gaps_ahead = self.gaps_at_reach();
    }

    fn commit(&mut self) {
        self.book_free_motion();
        let whole = self.is_whole_step();
        let state = &mut *self.state;
        std::mem::swap(&mut state.now, &mut state.ahead);
        std::mem::swap(&mut state.rotor_now, &mut state.rotor_ahead);
        if whole {
            self.shared.free.step(&mut state.unit_now, self.k);
        } else {
            std::mem::swap(&mut state.unit_now, &mut state.unit_ahead);
        }
        self.offset_s += self.reach_s;
        self.gaps = self.gaps_ahead;
        // A whole step ends on the node, to the bit.
        (self.is_settled, self.is_totalled) = (whole, false);
    }
}

impl ContactSystem<'_> {
    /// Books the jumps of the rates of slider and pivot by impulses of both contacts now.
    fn book_jump(&mut self, impulse: [f64; 2], kind: ImpulseKind) {
        if !self.state.keeps_motion {
            return;
        }
        let on_disk = impulse[1] - impulse[0];
        let (mut slider, mut pivot) = (self.shared.slider_jump.times(on_disk), 0.0);
        if let Some([disk, top, bottom]) = &self.shared.base_jumps {
            pivot = on_disk * disk.1;
            for ((pose, rate), force) in [(top, impulse[0]), (bottom, -impulse[1])] {
                slider = slider.plus(&pose.times(force));
                pivot += force * rate;
            }
        }
        let pivot = DiskPose {
            displacement_m: pivot,
            ..DiskPose::default()
        };
        if kind == ImpulseKind::Sustained && self.offset_s == 0.0 {
            let history = &mut self.state.history;
            let rate = &mut history.rate[self.k];
            *rate = rate.plus(&slider.times(0.5));
            if let Some(history) = &mut history.pivot {
                let rate = &mut history.rate[self.k];
                *rate = rate.plus(&pivot.times(0.5));
            }
            return;
        }
        let time_s = self.now_s();
        let sample = if self.offset_s == 0.0 {
            *self.sample()
        } else {
            self.shared.free.sample(&self.state.unit_now)
        };
        let (pose, rate) = self.slider(&sample);
        let (pose, rate_before) = self.shared.over_pivot(self.amplitude, time_s, pose, rate);
        let rate_after = rate_before.plus(&slider);
        let (at, before) = self.pivot();
        if let Some(history) = &mut self.state.history.pivot {
            history.breaks.push(Break {
                time_s,
                pose: at,
                rate_before: before,
                rate_after: before.plus(&pivot),
            });
        }
        let history = &mut self.state.history;
        history.breaks.push(Break {
            time_s,
            pose,
            rate_before,
            rate_after,
        });
        if history
            .events_s
            .last()
            .is_none_or(|&t| time_s - t > EVENT_SPACING_S)
        {
            history.events_s.push(time_s);
        }
    }
}
