//! Motion of the disk and of the ramp's two arms while they may touch, from their first contact (in the full model from
//! the onset) to the end of the run.
//!
//! The motion is a sum of two: what the pulse alone gives, which is the amplitude times a response computed once, and
//! what the contacts add. The second is marched here. Between contacts its modes are advanced in closed form. At a
//! contact an impulse changes their velocities (`complementarity`): it reverses or ends the approach at an impact, and
//! is aimed at a gap of zero one step ahead in lasting contact.

use super::contact_free::Points;
use super::driven::Driven;
use super::history::Break;
use super::rotor::{self, RotorState};
use super::run_in_progress::RunInProgress;
use super::sample::Sample;
use crate::complementarity::{Gap, ImpulseKind, Refund, StepReport, UnilateralSystem};
use crate::disk::DiskPose;
use crate::lanes::abreast;
use crate::modal::ModalState;
use crate::modal::bank::{LANES, dot};

/// Impacts closer together than this share one event of the head's time integration, s.
pub(super) const EVENT_SPACING_S: f64 = 2e-6;
/// Steps between checks for modes that have decayed.
const STILL_STEPS: usize = 64;
/// Share of the largest contact-free energy below which a chunk of eight modes is at rest: 1e-13 of the motion, which
/// no sum over all modes shows.
const STILL_SHARE: f64 = 1e-26;

pub(super) struct ContactSystem<'a> {
    pub(super) run: RunInProgress<'a>,
    pub(super) driven: &'a Driven,
    /// Time since the node reached.
    pub(super) offset_s: f64,
    /// Time from now to the instant ahead.
    pub(super) reach_s: f64,
    /// `gaps` are those at the node reached.
    pub(super) is_settled: bool,
    pub(super) gaps: [Gap; 2],
    pub(super) gaps_ahead: [Gap; 2],
    sample_ahead: Sample,
    /// Contact-driven motion of the contact point one step ahead; `None` once the state has changed.
    pub(super) contact_ahead: Option<Gap>,
    /// Node at which a contact-free interval has ended, and the contact-driven motion of the points there.
    pub(super) landed: Option<(usize, Points)>,
}

impl<'a> ContactSystem<'a> {
    /// Activates the contact-driven modes at the node that `run` has reached.
    pub fn activate(mut run: RunInProgress<'a>, driven: &'a Driven) -> Self {
        run.activate(driven);
        let mut system = Self {
            run,
            driven,
            offset_s: 0.0,
            reach_s: 0.0,
            is_settled: false,
            gaps: [Gap::default(); 2],
            gaps_ahead: [Gap::default(); 2],
            sample_ahead: Sample::default(),
            contact_ahead: None,
            landed: None,
        };
        system.settle();
        system
    }

    /// The run so far.
    pub fn run(&mut self) -> &mut RunInProgress<'a> {
        &mut self.run
    }

    /// The run, which ends here.
    pub fn into_run(self) -> RunInProgress<'a> {
        self.run
    }

    fn now_s(&self) -> f64 {
        self.run.k as f64 * self.run.shared.free.step_s + self.offset_s
    }

    /// Computes the gaps at the node reached unless the step before has left them.
    fn settle(&mut self) {
        if !self.is_settled {
            self.gaps = self.gaps_at_node();
            self.is_settled = true;
        }
    }

    /// Moves on to the next node.
    pub fn end_step(&mut self, report: StepReport) {
        self.run.k += 1;
        self.offset_s = 0.0;
        self.run.accumulated_steps += u64::from(report.accumulated);
        self.settle();
        self.rest();
        for gap in self.gaps.iter().take(self.run.shared.n_contacts) {
            let depth = -gap.value_m;
            let largest = &mut self.run.complementarity.max_penetration_m;
            *largest = largest.max(depth);
        }
    }

    /// Sets the last modes to rest where damping has stilled them; checked at some of the nodes.
    pub(super) fn rest(&mut self) {
        if !self.run.k.is_multiple_of(STILL_STEPS) {
            return;
        }
        let run = &mut self.run;
        let amplitude = run.amplitude;
        let still_j = STILL_SHARE * (amplitude * amplitude) * run.shared.free.peak_energy;
        while run.n_moving > self.driven.n_of_arms() {
            let chunk = run.n_moving - LANES..run.n_moving;
            let energy_j = self
                .driven
                .weights
                .of_chunk(chunk.start / LANES, &run.state.now);
            if energy_j > still_j {
                return;
            }
            run.n_moving = chunk.start;
            run.state.now.rest(chunk.clone());
            run.state.ahead.rest(chunk);
        }
    }

    /// Gaps at the node reached.
    fn gaps_at_node(&self) -> [Gap; 2] {
        self.gaps_of(
            &self.run.state.now,
            &self.run.state.rotor_now,
            self.run.sample(),
        )
    }

    /// Gaps of a contact-driven state added to the unit response `sample`.
    pub(super) fn gaps_of(
        &self,
        state: &ModalState,
        hub: &RotorState,
        sample: &Sample,
    ) -> [Gap; 2] {
        let (shared, driven) = (self.run.shared, self.driven);
        let n = self.run.n_moving;
        let [value_m, rate_m_per_s] = abreast([
            [&driven.contact, &state.q_re[..n]],
            [&driven.contact, &state.r_re[..n]],
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
        self.gaps_between(disk, sample, |side| {
            let mut arm = driven.arm_now(side, state);
            if let Some(rotor) = &shared.free.rotor {
                let on_base = rotor.arm(side, hub);
                arm.value_m += on_base.value_m;
                arm.rate_m_per_s += on_base.rate_m_per_s;
            }
            arm
        })
    }

    /// Gaps between disk and arms for a contact-driven motion added to the unit response `sample`.
    pub(super) fn gaps_between(
        &self,
        disk: Gap,
        sample: &Sample,
        arm: impl Fn(usize) -> Gap,
    ) -> [Gap; 2] {
        let shared = self.run.shared;
        std::array::from_fn(|side| {
            if side >= shared.n_contacts {
                return Gap::default();
            }
            let arm = arm(side);
            let free = shared.free_gap(side, self.run.amplitude, sample);
            let sign = if side == 0 { 1.0 } else { -1.0 };
            Gap {
                value_m: free.value_m + sign * (arm.value_m - disk.value_m),
                rate_m_per_s: free.rate_m_per_s + sign * (arm.rate_m_per_s - disk.rate_m_per_s),
            }
        })
    }

    /// Adds work and loss from now to the instant ahead to the energy balance.
    fn add_free_motion(&mut self) {
        let (shared, driven, reach) = (self.run.shared, self.driven, self.reach_s);
        self.run.total_forced(self.driven);
        let is_whole = self.is_whole_step();
        let now_s = self.now_s();
        let state = &mut *self.run.state;
        let free = &shared.free;
        let exchange = if is_whole {
            self.run
                .exchanged
                .damping
                .add(driven.step_loss.loss(self.run.n_moving, &state.now));
            free.exchange(&mut state.total_forced, self.run.k, self.run.amplitude)
        } else {
            let (n, forced) = (self.run.n_moving, &driven.forced_index);
            let loss = driven.part_flows.loss(n, &state.now, reach, forced);
            self.run.exchanged.damping.add(loss);
            free.exchange_within(&mut state.total_forced, now_s, reach, self.run.amplitude)
        };
        self.run.exchanged.work.add(exchange.work);
        self.run.exchanged.damping.add(exchange.loss);
        if let Some(balance) = &mut self.run.bodies {
            balance.add_supports(exchange.support_n_s);
        }
    }

    fn gaps_at_reach(&self) -> [Gap; 2] {
        let state = &*self.run.state;
        self.gaps_of(&state.ahead, &state.rotor_ahead, &self.sample_ahead)
    }

    fn is_whole_step(&self) -> bool {
        self.offset_s == 0.0 && self.reach_s == self.run.shared.free.step_s
    }

    /// Whether the step is taken in a single pass over the modes once no event can occur in it.
    pub(super) fn is_batched(&self) -> bool {
        self.is_whole_step() && self.run.shared.free.rotor.is_none()
    }
}

impl UnilateralSystem for ContactSystem<'_> {
    fn gaps(&self) -> [Gap; 2] {
        self.gaps
    }

    fn n_contacts(&self) -> usize {
        self.run.shared.n_contacts
    }

    fn look_ahead(&mut self, h_s: f64) {
        self.reach_s = h_s;
        let (shared, driven) = (self.run.shared, self.driven);
        let free = &shared.free;
        if self.is_batched() {
            let n = self.run.n_moving;
            let now = &self.run.state.now;
            let seen = self.contact_ahead;
            let disk = seen.unwrap_or_else(|| driven.outlook.of(n, now));
            let sample = &free.samples[self.run.k + 1];
            self.gaps_ahead = self.gaps_between(disk, sample, |side| driven.arm_ahead(side, now));
            return;
        }
        if self.is_whole_step() {
            let state = &mut *self.run.state;
            let flow = &driven.step_flow;
            flow.apply(self.run.n_moving, &state.now, &mut state.ahead);
            if let Some(rotor) = &free.rotor {
                rotor.flow(&state.rotor_now, None, &mut state.rotor_ahead);
            }
            // The unit response itself is stepped only when the step is committed.
            self.sample_ahead = free.samples[self.run.k + 1];
        } else {
            let start_s = self.now_s();
            let state = &mut *self.run.state;
            if state.part_s != h_s {
                driven.part_flows.set(h_s, &mut state.part_flow);
                state.part_s = h_s;
            }
            let flow = &state.part_flow;
            flow.apply(self.run.n_moving, &state.now, &mut state.ahead);
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
        self.driven.mobility
    }

    fn compliance_ahead(&self) -> [[f64; 2]; 2] {
        let (shared, driven) = (self.run.shared, self.driven);
        let mut compliance = match self.is_whole_step() {
            true => driven.step_compliance,
            false => driven.compliance(&self.run.state.part_flow),
        };
        if let Some(rotor) = &shared.free.rotor {
            let partial = (!self.is_whole_step()).then_some(&self.run.state.part_leap);
            rotor::add(&mut compliance, &rotor.compliance(partial));
        }
        compliance
    }

    fn refund(&self) -> Refund {
        self.driven.refund(&self.run.state.now)
    }

    fn impulse(&mut self, impulse_n_s: [f64; 2], kind: ImpulseKind) {
        let (shared, driven) = (self.run.shared, self.driven);
        let [p, time_s] = [impulse_n_s, [self.now_s(); 2]];
        let rate = [self.gaps[0].rate_m_per_s, self.gaps[1].rate_m_per_s];
        let w = driven.mobility;
        let jump: [f64; 2] = std::array::from_fn(|i| w[i][0] * p[0] + w[i][1] * p[1]);

        // Energy per impulse: half the sum of the gap velocities before and after.
        let change: f64 = (0..2).map(|i| p[i] * (rate[i] + 0.5 * jump[i])).sum();
        match kind {
            ImpulseKind::Impact => self.run.exchanged.impact -= change,
            ImpulseKind::Sustained => {
                // The ripple between impulses is numerical: its loss belongs to the impulses and not to the structure.
                let back = driven.ripple_of(p).min(self.refund().of(p));
                let algorithmic = self.run.exchanged.algorithmic + (change - back);
                // What springs return beyond that is damping, too.
                let beyond = match driven.has_springs() {
                    true => algorithmic.max(0.0),
                    false => 0.0,
                };
                self.run.exchanged.algorithmic = algorithmic - beyond;
                self.run.exchanged.damping.add(-back - beyond);
            }
        }
        let on_disk = p[1] - p[0];
        let mut w_theta = -dot(&driven.contact_turn, &self.run.state.now.q_im);
        if let Some(rotor) = &shared.free.rotor {
            w_theta += rotor.contact_turn(&self.run.state.rotor_now);
            w_theta += self.run.amplitude * rotor.contact_turn(&self.run.state.unit_now.rotor);
        }
        if let Some(balance) = &mut self.run.bodies {
            balance.contact_n_s += on_disk;
        }
        self.run.exchanged.spindle += on_disk * shared.spin_rad_per_s * w_theta;

        let record = &mut self.run.complementarity;
        for side in 0..2 {
            record.min_multiplier_n_s = record.min_multiplier_n_s.min(p[side]);
            let product = (p[side] * self.gaps[side].value_m).abs();
            record.max_product_n_s_m = record.max_product_n_s_m.max(product);
            if p[side] != 0.0 {
                self.run.state.logs[side].push(time_s[side], p[side]);
            }
        }
        let singular = w[0][0] * w[1][1] <= w[0][1] * w[1][0] * (1.0 + 1e-14);
        let closed = |g: &Gap| g.value_m <= shared.law.gap_tolerance_m;
        self.run.both_arms |= singular && self.gaps.iter().all(closed);

        self.record_jump(p, kind);

        (self.is_settled, self.run.is_totalled) = (false, false);
        (self.contact_ahead, self.run.seen, self.landed) = (None, None, None);
        let (is_whole, is_batched) = (self.is_whole_step(), self.is_batched());
        let state = &mut *self.run.state;
        let flow = match is_whole {
            true => &driven.step_flow,
            false => &state.part_flow,
        };
        self.run.n_moving = driven.oscillators.len();
        state.now.kick(&driven.contact, on_disk);
        if !is_batched {
            flow.add_kick(&driven.contact, on_disk, &mut state.ahead);
        }
        if let Some(rotor) = &shared.free.rotor {
            let partial = (!is_whole).then_some(&state.part_leap);
            rotor.kick(p, partial, &mut state.rotor_now, &mut state.rotor_ahead);
        }
        for (side, force) in [(0, p[0]), (1, -p[1])] {
            if force != 0.0 && !driven.arms[side].modes.is_empty() {
                // The arms' modes precede the disk's.
                let shape = &driven.arm_shape[side][..driven.n_of_arms()];
                state.now.kick(shape, force);
                if !is_batched {
                    flow.add_kick(shape, force, &mut state.ahead);
                }
            }
        }
        for side in 0..2 {
            self.gaps[side].rate_m_per_s = rate[side] + jump[side];
        }
        if is_batched {
            let (value, rate) = (driven.step_compliance, driven.outlook.response);
            for (i, gap) in self.gaps_ahead.iter_mut().enumerate() {
                gap.value_m += value[i][0] * p[0] + value[i][1] * p[1];
                gap.rate_m_per_s += rate[i][0] * p[0] + rate[i][1] * p[1];
            }
        } else {
            self.gaps_ahead = self.gaps_at_reach();
        }
    }

    fn commit(&mut self) {
        if self.is_batched() {
            self.batched_step();
            return;
        }
        (self.contact_ahead, self.run.seen) = (None, None);
        self.add_free_motion();
        let whole = self.is_whole_step();
        let state = &mut *self.run.state;
        std::mem::swap(&mut state.now, &mut state.ahead);
        std::mem::swap(&mut state.rotor_now, &mut state.rotor_ahead);
        if whole {
            self.run.shared.free.step(&mut state.unit_now, self.run.k);
        } else {
            std::mem::swap(&mut state.unit_now, &mut state.unit_ahead);
        }
        self.offset_s += self.reach_s;
        self.gaps = self.gaps_ahead;
        // A whole step ends exactly on the node.
        (self.is_settled, self.run.is_totalled) = (whole, false);
    }
}

impl ContactSystem<'_> {
    /// Records the jumps of the rates of slider and pivot by impulses of both contacts now.
    fn record_jump(&mut self, impulse: [f64; 2], kind: ImpulseKind) {
        if !self.run.state.keeps_motion {
            return;
        }
        let on_disk = impulse[1] - impulse[0];
        let (mut slider, mut pivot) = (self.driven.slider_jump.times(on_disk), 0.0);
        if let Some([disk, top, bottom]) = &self.driven.base_jumps {
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
            let history = &mut self.run.state.history;
            let rate = &mut history.rate[self.run.k];
            *rate = rate.plus(&slider.times(0.5));
            if let Some(history) = &mut history.pivot {
                let rate = &mut history.rate[self.run.k];
                *rate = rate.plus(&pivot.times(0.5));
            }
            return;
        }
        let time_s = self.now_s();
        let sample = if self.offset_s == 0.0 {
            *self.run.sample()
        } else {
            self.run.shared.free.sample(&self.run.state.unit_now)
        };
        let (pose, rate) = self.run.slider(&sample);
        let (pose, rate_before) =
            self.run
                .shared
                .over_pivot(self.run.amplitude, time_s, pose, rate);
        let rate_after = rate_before.plus(&slider);
        let (at, before) = self.run.pivot();
        if let Some(history) = &mut self.run.state.history.pivot {
            history.breaks.push(Break {
                time_s,
                pose: at,
                rate_before: before,
                rate_after: before.plus(&pivot),
            });
        }
        let history = &mut self.run.state.history;
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
