//! Runs disk, ramp and base with Moreau-Jean time stepping, the reference contact method.
//!
//! Shock and contact act on one state, with the implicit midpoint rule instead of the exact flow and a velocity
//! constraint instead of aimed impulses ([`crate::complementarity::moreau_jean`]). The energy balance is that of the
//! midpoint steps and closes to rounding. With the means q̄, r̄ of a step and the impulses P on gaps with rates ġ₀, ġ₁
//! before and after it,
//! ```text
//! H₁ − H₀ = Σ f Δq − Δt Σ (Re d |r̄|² + Re(i Im k r̄* q̄)) + Σ P (ġ₀ + ġ₁)/2
//! ```
//!
//! An impact takes one step, so the motion has no breaks; the step in which a contact begins is an event for the head's
//! time integration.

use super::closing::{BodyBalance, Closing};
use super::contact_log::ContactLog;
use super::contact_system::EVENT_SPACING_S;
use super::driven::Driven;
use super::energy::ExchangedEnergy;
use super::error::StructureError;
use super::history::StructuralHistory;
use super::model::StructureModel;
use super::node::Node;
use super::outcome::StructureRun;
use super::parameters::Window;
use super::record::{Complementarity, DiskExtremes, StructureColumns};
use super::rotor::{RotorScratch, RotorState};
use super::shared::Shared;
use super::snapshot::Snapshots;
use crate::complementarity::moreau_jean::{LinearMode, MoreauJean};
use crate::disk::DiskPose;
use crate::modal::bank::dot;
use crate::modal::{ModalState, Oscillator};
use nalgebra::Complex;

/// State of a run.
struct March<'a> {
    shared: &'a Shared,
    driven: &'a Driven,
    amplitude: f64,
    system: MoreauJean,
    /// Modal force of the shock at the middle of the step.
    force: Vec<f64>,
    now: ModalState,
    before: ModalState,
    history: StructuralHistory,
    columns: Option<StructureColumns>,
    extremes: DiskExtremes,
    logs: [ContactLog; 2],
    complementarity: Complementarity,
    exchanged: ExchangedEnergy,
    rotor_now: RotorState,
    rotor_before: RotorState,
    scratch: RotorScratch,
    bodies: Option<BodyBalance>,
    last: Node,
    last_impulse_s: f64,
}

impl StructureModel {
    /// Runs the model's modes with Moreau-Jean steps of the model's length.
    pub(super) fn run_moreau_jean(
        &self,
        amplitude: f64,
        record: bool,
        snapshots: &mut Snapshots,
    ) -> Result<StructureRun, StructureError> {
        let shared = &*self.shared;
        let mut march = March::new(shared, shared.driven()?, amplitude, record);
        // Its state is the whole motion.
        let mut keep = |k: usize, march: &March<'_>| {
            let modes = [&*march.now.q_re, &*march.now.q_im];
            snapshots.offer(k, modes, &march.rotor_now, 0.0);
        };
        march.record_node(0);
        keep(0, &march);
        for k in 0..shared.n_steps {
            march.step(k);
            march.record_node(k + 1);
            keep(k + 1, &march);
            if march.decayed() || !march.last.energies.fixed_frame.is_finite() {
                break;
            }
        }
        march.finish()
    }
}

impl<'a> March<'a> {
    fn new(shared: &'a Shared, driven: &'a Driven, amplitude: f64, record: bool) -> Self {
        let n = driven.oscillators.len();
        let n_nodes = shared.n_steps + 1;
        let rotor = shared.free.rotor.as_ref();
        let at_rest = || rotor.map_or_else(RotorState::default, |rotor| rotor.at_rest());
        Self {
            shared,
            driven,
            amplitude,
            system: system(shared, driven),
            force: vec![0.0; n],
            now: ModalState::at_rest(n),
            before: ModalState::at_rest(n),
            history: shared.history(n_nodes),
            columns: record.then(StructureColumns::default),
            extremes: DiskExtremes::default(),
            logs: Default::default(),
            complementarity: Complementarity::default(),
            exchanged: ExchangedEnergy::default(),
            rotor_now: at_rest(),
            rotor_before: at_rest(),
            scratch: rotor.map_or_else(RotorScratch::default, |rotor| rotor.scratch()),
            bodies: rotor.is_some().then(|| BodyBalance::of(amplitude)),
            last: Node::default(),
            last_impulse_s: f64::NEG_INFINITY,
        }
    }

    /// Advances from node `k` to the next.
    fn step(&mut self, k: usize) {
        let (shared, driven) = (self.shared, self.driven);
        let h = shared.free.step_s;
        let middle = self.amplitude * shared.pulse.value((k as f64 + 0.5) * h);
        for (&i, gain) in driven
            .forced_index
            .iter()
            .zip(&shared.free.modes.participation)
        {
            self.force[i] = gain * middle;
        }
        self.before.copy_from(&self.now);
        std::mem::swap(&mut self.rotor_before, &mut self.rotor_now);
        let impulse = self.system.step(&self.force, middle);
        for (own, modes) in self.rotor_now.parts.iter_mut().zip(&self.system.coupled) {
            own.copy_from(&modes.state);
        }
        let states = self.system.amplitude.iter().zip(&self.system.velocity);
        for (j, (q, r)) in states.enumerate() {
            (self.now.q_re[j], self.now.q_im[j]) = (q.re, q.im);
            (self.now.r_re[j], self.now.r_im[j]) = (r.re, r.im);
        }
        self.add_step(k, impulse);
    }

    /// Adds the energies exchanged in the step just taken from node `k`, and its impulses, to the balances.
    fn add_step(&mut self, k: usize, impulse: [f64; 2]) {
        let (shared, driven) = (self.shared, self.driven);
        let h = shared.free.step_s;
        let (a, b) = (&self.before, &self.now);
        for (j, o) in driven.oscillators.iter().enumerate() {
            let mean = |x: &[f64], y: &[f64]| 0.5 * (x[j] + y[j]);
            let (q_re, q_im) = (mean(&a.q_re, &b.q_re), mean(&a.q_im, &b.q_im));
            let (r_re, r_im) = (mean(&a.r_re, &b.r_re), mean(&a.r_im, &b.r_im));
            let mode = linear(o);
            self.exchanged
                .work
                .add(self.force[j] * (b.q_re[j] - a.q_re[j]));
            let power = mode.damping_per_s.re * (r_re * r_re + r_im * r_im)
                + mode.stiffness_per_s2.im * (r_im * q_re - r_re * q_im);
            self.exchanged.damping.add(h * power);
        }
        if let Some(rotor) = &shared.free.rotor {
            let force = self.amplitude * shared.pulse.value((k as f64 + 0.5) * h);
            let (before, now) = (&self.rotor_before, &self.rotor_now);
            let exchange = rotor.midpoint_exchange(before, now, h, force, &mut self.scratch);
            self.exchanged.work.add(exchange.work);
            self.exchanged.damping.add(exchange.loss);
            if let Some(balance) = &mut self.bodies {
                balance.add_supports(exchange.support_n_s);
                balance.contact_n_s += impulse[1] - impulse[0];
            }
        }
        if impulse == [0.0; 2] {
            return;
        }
        let start_s = k as f64 * h;
        let on_disk = impulse[1] - impulse[0];
        let mut w_theta =
            -0.5 * (dot(&driven.contact_turn, &a.q_im) + dot(&driven.contact_turn, &b.q_im));
        if let Some(rotor) = &shared.free.rotor {
            let (before, now) = (&self.rotor_before, &self.rotor_now);
            w_theta += 0.5 * (rotor.contact_turn(before) + rotor.contact_turn(now));
        }
        self.exchanged.spindle += on_disk * shared.spin_rad_per_s * w_theta;
        for (side, &p) in impulse.iter().enumerate() {
            let record = &mut self.complementarity;
            record.min_multiplier_n_s = record.min_multiplier_n_s.min(p);
            if p == 0.0 {
                continue;
            }
            let mut rates = gap_rate(driven, side, a) + gap_rate(driven, side, b);
            if let Some(rotor) = &shared.free.rotor {
                let [before, now] = [&self.rotor_before, &self.rotor_now]
                    .map(|state| rotor.contact(state).rate_m_per_s);
                let arm = [&self.rotor_before, &self.rotor_now]
                    .map(|state| rotor.arm(side, state).rate_m_per_s);
                let opening = arm[0] + arm[1] - (before + now);
                rates += if side == 0 { opening } else { -opening };
            }
            self.exchanged.impact -= 0.5 * p * rates;
            let product = (p * self.system.gap_m(side)).abs();
            record.max_product_n_s_m = record.max_product_n_s_m.max(product);
            self.logs[side].push(start_s + 0.5 * h, p);
        }
        if start_s - self.last_impulse_s > EVENT_SPACING_S {
            self.history.events_s.push(start_s);
        }
        self.last_impulse_s = start_s;
    }

    /// Adds node `k`, which the state has reached, to balances and history.
    fn record_node(&mut self, k: usize) {
        let (shared, driven, s) = (self.shared, self.driven, &self.now);
        let [w, p, r] = &driven.slider;
        let read = |re: &[f64], im: &[f64]| DiskPose {
            displacement_m: w.read(re, im),
            pitch_rad: p.read(re, im),
            roll_rad: r.read(re, im),
        };
        let time_s = k as f64 * shared.free.step_s;
        let (mut pose, mut rate) = (read(&s.q_re, &s.q_im), read(&s.r_re, &s.r_im));
        let mut energies = driven.weights.energies(s);
        let (mut ramp_m, mut rim_m) = (dot(&driven.contact, &s.q_re), dot(&driven.rim, &s.q_re));
        let mut arms_m = std::array::from_fn(|side| dot(&driven.arm_shape[side], &s.q_re));
        if let Some(rotor) = &shared.free.rotor {
            rotor.add_slider(&self.rotor_now, &mut pose, &mut rate);
            energies.add(&rotor.energies(&self.rotor_now, &mut self.scratch));
            ramp_m += rotor.contact(&self.rotor_now).value_m;
            rim_m += rotor.rim_m(&self.rotor_now);
            for (side, x) in arms_m.iter_mut().enumerate() {
                *x += rotor.arm(side, &self.rotor_now).value_m;
            }
            if let Some(balance) = &mut self.bodies {
                balance.include(rotor.bodies(&self.rotor_now, balance.now.support_n_s));
            }
        }
        let node = Node {
            time_s,
            shock_m_per_s2: self.amplitude * shared.pulse.value(time_s),
            pose,
            ramp_m,
            rim_m,
            arms_m,
            energies,
        };
        let (pose, rate) = shared.over_pivot(self.amplitude, time_s, pose, rate);
        self.history.pose.push(pose);
        self.history.rate.push(rate);
        let moved = shared.free.base.as_ref().zip(shared.free.rotor.as_ref());
        if let (Some((base, rotor)), Some(history)) = (moved, &mut self.history.pivot) {
            // The contact-driven part is the whole minus the unit response.
            let whole = rotor.pivot(&self.rotor_now);
            let [value, speed] = base.displacement(time_s).map(|x| self.amplitude * x);
            let along = |displacement_m: f64| DiskPose {
                displacement_m,
                ..DiskPose::default()
            };
            history.pose.push(along(whole.value_m - value));
            history.rate.push(along(whole.rate_m_per_s - speed));
        }
        self.extremes.include(&node);
        for side in 0..shared.n_contacts {
            let largest = &mut self.complementarity.max_penetration_m;
            *largest = largest.max(-self.system.gap_m(side));
        }
        let exchanged = &mut self.exchanged;
        exchanged.peak_fixed_frame = exchanged.peak_fixed_frame.max(node.energies.fixed_frame);
        exchanged.peak_material = exchanged.peak_material.max(node.energies.material());
        if let Some(columns) = &mut self.columns {
            columns.push(&node);
            if let (Some(balance), Some(rotor)) = (&self.bodies, &shared.free.rotor) {
                columns.push_bodies(&balance.now, rotor.has_bodies());
            }
        }
        self.last = node;
    }

    fn decayed(&self) -> bool {
        match self.shared.window {
            Window::Fixed { .. } => false,
            Window::UntilDecayed { share, .. } => {
                self.last.time_s >= self.shared.free.pulse_end_s
                    && self.last.energies.material() <= share * self.exchanged.peak_material
            }
        }
    }

    /// Closes the balances.
    fn finish(self) -> Result<StructureRun, StructureError> {
        let k = self.history.pose.len() - 1;
        let closing = Closing {
            shared: self.shared,
            driven: Some(self.driven),
            k,
            not_finite: None,
            energies: self.last.energies,
            exchanged: self.exchanged,
            extremes: self.extremes,
            complementarity: self.complementarity,
            bodies: self.bodies,
            logs: &self.logs,
            history: self.history,
            columns: self.columns,
        };
        closing.run()
    }
}

/// One mode in the space-fixed frame.
fn linear(o: &Oscillator) -> LinearMode {
    let (gamma, turn) = (o.half_damping_per_s, o.turn_rad_per_s);
    LinearMode {
        stiffness_per_s2: Complex::new(o.fixed_frame_stiffness(), 2.0 * gamma * turn),
        damping_per_s: Complex::new(2.0 * gamma + o.fixed_damping_per_s, 2.0 * turn),
    }
}

/// The model's modes and gaps: top g = g₀ + x − w, bottom g = g₀ − x + w.
fn system(shared: &Shared, driven: &Driven) -> MoreauJean {
    let row = |side: usize, sign: f64| -> Vec<f64> {
        let pairs = driven.arm_shape[side].iter().zip(&driven.contact);
        pairs.map(|(arm, disk)| sign * (arm - disk)).collect()
    };
    let mut system = MoreauJean::new(
        driven.oscillators.iter().map(linear).collect(),
        [row(0, 1.0), row(1, -1.0)]
            .into_iter()
            .take(shared.n_contacts)
            .collect(),
        shared.clearance_m[..shared.n_contacts].to_vec(),
        shared.law.restitution,
        shared.free.step_s,
    );
    if let Some(rotor) = &shared.free.rotor {
        rotor.add_to(&mut system);
    }
    system
}

fn gap_rate(driven: &Driven, side: usize, state: &ModalState) -> f64 {
    let closing = dot(&driven.arm_shape[side], &state.r_re) - dot(&driven.contact, &state.r_re);
    if side == 0 { closing } else { -closing }
}
