//! Takes a whole contact-free interval in one step, before the first touch and between contacts.

use super::contact_free::{ContactFree, Points};
use super::contact_system::ContactSystem;
use super::driven::Driven;
use super::outlook::Sight;
use super::parameters::Window;
use super::record::DiskExtremes;
use super::run_in_progress::RunInProgress;
use super::span::{INTERVAL_NODES, Range};
use crate::complementarity::Gap;
use crate::lanes::abreast;
use crate::modal::ModalState;

impl Driven {
    /// Contact-driven motion of the points in `state`, of which the first `n_modes` move.
    fn points(&self, n_modes: usize, state: &ModalState) -> Points {
        let n = n_modes;
        let (q_re, q_im) = (&state.q_re[..n], &state.q_im[..n]);
        let (r_re, r_im) = (&state.r_re[..n], &state.r_im[..n]);
        let slider = &self.slider[0];
        let [
            contact,
            contact_rate,
            rim,
            rim_rate,
            re,
            im,
            re_rate,
            im_rate,
        ] = abreast([
            [&self.contact, q_re],
            [&self.contact, r_re],
            [&self.rim, q_re],
            [&self.rim, r_re],
            [&slider.re, q_re],
            [&slider.im, q_im],
            [&slider.re, r_re],
            [&slider.im, r_im],
        ]);
        [
            [contact, contact_rate],
            [rim, rim_rate],
            [re + im, re_rate + im_rate],
        ]
    }
}

impl ContactSystem<'_> {
    /// Advances the system, its balances and its history by a whole contact-free interval and returns true. Returns
    /// false, and changes nothing, where a gap might close.
    pub fn advance_contact_free(&mut self) -> bool {
        let (driven, k) = (self.driven, self.run.k);
        let Some(contact_free) = &driven.contact_free else {
            return false;
        };
        let to = k + INTERVAL_NODES;
        if !k.is_multiple_of(INTERVAL_NODES) || to > self.run.shared.n_steps {
            return false;
        }
        let gaps = self.gaps.iter().take(self.run.shared.n_contacts);
        if gaps.fold(f64::INFINITY, |least, gap| least.min(gap.value_m)) <= 0.0 {
            return false;
        }
        let n = self.run.n_moving;
        let state = &mut *self.run.state;
        contact_free.flow.apply(n, &state.now, &mut state.ahead);
        let stray_m = contact_free.stray_m(n, &state.now);
        if !stray_m.is_finite() {
            return false;
        }
        // The interval begins where the last one ended.
        let before = self.landed.filter(|(node, _)| *node == k);
        let points = [
            before.map_or_else(|| driven.points(n, &state.now), |(_, points)| points),
            driven.points(n, &state.ahead),
        ];
        if !self.stays_open(contact_free, &points[1], stray_m) || self.decays() {
            return false;
        }
        let is_watched = !self.stays_within(contact_free, &points, stray_m);
        self.land(contact_free, is_watched);
        self.landed = Some((to, points[1]));
        let [[value_m, rate_m_per_s], [rim_m, _], [slider_m, _]] = points[1];
        let contact = Gap {
            value_m,
            rate_m_per_s,
        };
        self.run.seen = Some(Sight {
            contact,
            rim_m,
            slider_m,
        });
        true
    }

    /// Whether both gaps stay open until the state ahead, the end of the interval.
    fn stays_open(&mut self, contact_free: &ContactFree, ahead: &Points, stray_m: f64) -> bool {
        let (shared, a, k) = (self.run.shared, self.run.amplitude, self.run.k);
        let samples = [k, k + INTERVAL_NODES].map(|k| &shared.free.samples[k]);
        let [value_m, rate_m_per_s] = ahead[0];
        let contact = Gap {
            value_m,
            rate_m_per_s,
        };
        let arm = |side| self.driven.arm_now(side, &self.run.state.ahead);
        self.gaps_ahead = self.gaps_between(contact, samples[1], arm);
        let span = &shared.free.spans[k / INTERVAL_NODES];
        (0..shared.n_contacts).all(|side| {
            let ends = [
                (self.gaps[side], samples[0]),
                (self.gaps_ahead[side], samples[1]),
            ];
            let by_contact = ends.map(|(gap, sample)| {
                let free = shared.free_gap(side, a, sample);
                [
                    gap.value_m - free.value_m,
                    gap.rate_m_per_s - free.rate_m_per_s,
                ]
            });
            let driven = Range::of_motion(by_contact, contact_free.length_s, stray_m);
            let free = span.gaps[side].times(a);
            shared.clearance_m[side] + (free.low + driven.low) > shared.law.gap_tolerance_m
        })
    }

    /// Whether no point exceeds its extremes so far and those at the end of the interval.
    fn stays_within(&self, contact_free: &ContactFree, ends: &[Points; 2], stray_m: f64) -> bool {
        let (shared, a, k) = (self.run.shared, self.run.amplitude, self.run.k);
        let span = &shared.free.spans[k / INTERVAL_NODES];
        let last = &shared.free.samples[k + INTERVAL_NODES];
        let last = [last.contact.value, last.rim, last.slider.value];
        let mut extremes = self.run.extremes;
        let at_end: [f64; 3] = std::array::from_fn(|i| a * last[i] + ends[1][i][0]);
        extremes.include_points(at_end);
        (0..3).all(|i| {
            let driven = Range::of_motion(ends.map(|end| end[i]), contact_free.length_s, stray_m);
            let range = span.points[i].times(a).plus(driven);
            let most = extremes.of_point(i);
            most.low <= range.low && range.high <= most.high
        })
    }

    /// Whether the motion has decayed by the end of the interval, the state ahead: energies fall, so one that is still
    /// above the limit there was above it before.
    fn decays(&mut self) -> bool {
        if matches!(self.run.shared.window, Window::Fixed { .. }) {
            return false;
        }
        let k = self.run.k;
        let to = k + INTERVAL_NODES;
        let free = &self.run.shared.free;
        free.state_at_node(to, &mut self.run.state.unit_ahead);
        self.turn_to(to);
        let material_j = self.run.energies_now().material();
        self.turn_to(k);
        self.run.has_decayed(to, material_j)
    }

    /// Makes node `k` and the states ahead the present ones, and the present ones those ahead.
    fn turn_to(&mut self, k: usize) {
        self.run.k = k;
        self.run.is_totalled = false;
        let state = &mut *self.run.state;
        std::mem::swap(&mut state.now, &mut state.ahead);
        std::mem::swap(&mut state.unit_now, &mut state.unit_ahead);
    }

    /// Adds the interval to the balances and ends it.
    fn land(&mut self, contact_free: &ContactFree, is_watched: bool) {
        let (shared, k, n) = (self.run.shared, self.run.k, self.run.n_moving);
        let free = &shared.free;
        let run = &mut self.run;
        run.exchanged
            .damping
            .add(contact_free.loss.loss(n, &run.state.now));
        if k as f64 * free.step_s >= free.pulse_end_s {
            run.total_forced(self.driven);
            let total = &run.state.total_forced;
            let states = total.x.iter().zip(&total.v).zip(&contact_free.forced_loss);
            let loss = states.map(|((x, v), form)| form.loss((*x).into(), (*v).into()));
            run.exchanged.damping.add(loss.sum());
            free.state_at_node(k + INTERVAL_NODES, &mut run.state.unit_ahead);
        } else {
            let state = &mut *run.state;
            let forced = &mut state.forced;
            for (j, &i) in self.driven.forced_index.iter().enumerate() {
                (forced.x[j], forced.v[j]) = (state.now.q_re[i], state.now.r_re[i]);
            }
            state.unit_ahead.copy_from(&state.unit_now);
            let states = [forced, &mut state.unit_ahead, &mut state.total_forced];
            free.exchange_contact_free(states, k, run.amplitude, &mut run.exchanged);
            run.is_totalled = false;
        }
        (self.contact_ahead, run.seen) = (None, None);
        if is_watched || run.state.keeps_motion || run.state.record {
            run.watch(self.driven);
        }
        self.turn_to(k + INTERVAL_NODES);
        (self.gaps, self.is_settled) = (self.gaps_ahead, true);
        self.rest();
    }
}

impl RunInProgress<'_> {
    /// Free motion over a whole interval before any contact, which may begin at node `end` or later, where nothing
    /// needs the nodes between. Returns whether it was taken.
    pub fn advance_inactive(&mut self, end: usize) -> bool {
        let (k, shared) = (self.k, self.shared);
        let is_idle = !(self.state.keeps_motion || self.state.record || self.bodies.is_some());
        let is_fixed = matches!(shared.window, Window::Fixed { .. });
        let is_whole = k.is_multiple_of(INTERVAL_NODES) && k + INTERVAL_NODES <= end;
        if !(is_idle && is_fixed && is_whole) {
            return false;
        }
        let points = shared.free.spans[k / INTERVAL_NODES].points;
        let [contact, rim, slider] = points.map(|range| range.times(self.amplitude));
        self.extremes
            .include_points([contact.low, rim.low, slider.low]);
        self.extremes
            .include_points([contact.high, rim.high, slider.high]);
        self.k += INTERVAL_NODES;
        true
    }
}

impl DiskExtremes {
    /// Includes the displacements of contact point, rim and slider.
    pub(super) fn include_points(&mut self, [contact, rim, slider]: [f64; 3]) {
        self.slider_max_m = self.slider_max_m.max(slider);
        self.slider_min_m = self.slider_min_m.min(slider);
        self.ramp_max_m = self.ramp_max_m.max(contact);
        self.ramp_min_m = self.ramp_min_m.min(contact);
        self.rim_max_m = self.rim_max_m.max(rim.abs());
    }

    /// Range in which a point (contact point, rim, slider) has been.
    fn of_point(&self, point: usize) -> Range {
        let (low, high) = match point {
            0 => (self.ramp_min_m, self.ramp_max_m),
            1 => (-self.rim_max_m, self.rim_max_m),
            _ => (self.slider_min_m, self.slider_max_m),
        };
        Range { low, high }
    }
}
