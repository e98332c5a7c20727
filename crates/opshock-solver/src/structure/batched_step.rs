//! Takes one whole step of the contact-driven modes in a single pass: flow, energy loss and the points read at its end.
//!
//! The gap one step ahead is a sum over the present state, so impulses can be aimed before any mode is advanced. The
//! state is therefore read once per step, after the impulses of its start are applied, and is overwritten in place. All
//! that a step reads of 246 modes, with the state, just fits into 48 kB of cache.

use super::contact_system::ContactSystem;
use super::driven::Driven;
use super::outlook::Sight;
use crate::complementarity::Gap;
use crate::lanes::{self, Simd, WithSimd};
use crate::modal::ModalState;
use crate::modal::bank::{ChunkFlow, LANES, chunks};

impl Driven {
    /// Advances the first `n_modes` of `state` by a step. Returns the loss of the modes without forcing, the points at
    /// its end, and the contact point one more step ahead if no impulse acts.
    pub fn batched_step(&self, n_modes: usize, state: &mut ModalState) -> (f64, Sight, Gap) {
        let mut sums = [[0.0; LANES]; SUMS];
        lanes::widest(BatchedStep {
            driven: self,
            n: n_modes / LANES,
            state,
            sums: &mut sums,
        });
        let [
            loss,
            value,
            rate,
            rim,
            slider_re,
            slider_im,
            next,
            next_rate,
        ] = sums.map(lanes::total);
        let gap = |value_m: f64, rate_m_per_s: f64| Gap {
            value_m,
            rate_m_per_s,
        };
        let sight = Sight {
            contact: gap(value, rate),
            rim_m: rim,
            slider_m: slider_re + slider_im,
        };
        (loss, sight, gap(next, next_rate))
    }

    /// Contact-driven motion of the contact point of arm `side` in `state`.
    pub fn arm_now(&self, side: usize, state: &ModalState) -> Gap {
        let mut at = Gap::default();
        for j in self.arms[side].modes.clone() {
            at.value_m += self.arm_shape[side][j] * state.q_re[j];
            at.rate_m_per_s += self.arm_shape[side][j] * state.r_re[j];
        }
        at
    }

    /// Contact-driven motion of the contact point of arm `side` a step after `state`.
    pub fn arm_ahead(&self, side: usize, state: &ModalState) -> Gap {
        let mut at = Gap::default();
        for j in self.arms[side].modes.clone() {
            // Arms do not rotate: all is real.
            let (of, shape) = (self.step_flow.of_mode(j), self.arm_shape[side][j]);
            let (q, r) = (state.q_re[j], state.r_re[j]);
            at.value_m += shape * (q + (of.qq.re * q + of.qr.re * r));
            at.rate_m_per_s += shape * (r + (of.rq.re * q + of.rr.re * r));
        }
        at
    }
}

impl ContactSystem<'_> {
    /// Commits a batched modal step.
    pub(super) fn batched_step(&mut self) {
        let (driven, n) = (self.driven, self.run.n_moving);
        self.add_exchange();
        let run = &mut self.run;
        let (loss, sight, contact_ahead) = driven.batched_step(n, &mut run.state.now);
        run.exchanged.damping.add(loss);
        run.shared.free.step(&mut run.state.unit_now, run.k);
        run.is_totalled = false;
        run.seen = Some(sight);
        self.offset_s += self.reach_s;
        let (now, k) = (&self.run.state.now, self.run.k);
        let sample = &self.run.shared.free.samples[k + 1];
        let arm = |side| driven.arm_now(side, now);
        self.gaps = self.gaps_between(sight.contact, sample, arm);
        self.is_settled = true;
        self.contact_ahead = Some(contact_ahead);
    }

    /// Adds the work and loss of the forced modes from now to the instant ahead to the energy balance.
    fn add_exchange(&mut self) {
        self.run.total_forced(self.driven);
        let (free, run) = (&self.run.shared.free, &mut self.run);
        let exchange = free.exchange(&mut run.state.total_forced, run.k, run.amplitude);
        run.exchanged.work.add(exchange.work);
        run.exchanged.damping.add(exchange.loss);
    }
}

/// Loss, contact point and its rate, rim, both parts of the slider, contact point and its rate one step ahead.
const SUMS: usize = 8;

struct BatchedStep<'a> {
    driven: &'a Driven,
    n: usize,
    state: &'a mut ModalState,
    sums: &'a mut [[f64; LANES]; SUMS],
}

impl WithSimd for BatchedStep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.run::<S, 1>(simd),
            4 => self.run::<S, 2>(simd),
            2 => self.run::<S, 4>(simd),
            _ => self.run::<S, 8>(simd),
        }
    }
}

impl BatchedStep<'_> {
    #[inline(always)]
    fn run<S: Simd, const V: usize>(self, simd: S) {
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let driven = self.driven;
        let loss = driven.step_loss.columns().map(read);
        let rows = [
            &driven.contact,
            &driven.rim,
            &driven.slider[0].re,
            &driven.slider[0].im,
        ];
        let rows = rows.map(|row| read(row));
        let ModalState {
            q_re,
            q_im,
            r_re,
            r_im,
        } = self.state;
        let [q_re, q_im, r_re, r_im] =
            [q_re, q_im, r_re, r_im].map(|column| &mut column.as_chunks_mut::<LANES>().0[..n]);
        let mut sums = [[simd.splat_f64s(0.0); SUMS]; V];
        let fused = |a, b, c| simd.mul_add_f64s(a, b, c);
        let times = |a, b| simd.mul_f64s(a, b);
        let less = |a, b, c| simd.negate_mul_add_f64s(a, b, c);
        let minus = |a| simd.neg_f64s(a);
        for i in 0..n {
            let ChunkFlow(flow) = driven.step_flow.of_chunk(i);
            for (v, sums) in sums.iter_mut().enumerate() {
                let load = |x: &[f64; LANES]| S::as_simd_f64s(x).0[v];
                let [qr, qi, rr, ri] = [&q_re[i], &q_im[i], &r_re[i], &r_im[i]].map(load);
                let [qq, vv, re, im] = loss.map(|column| load(&column[i]));
                // As the sums over many steps take them (`super::energy`).
                let squares = fused(
                    qq,
                    fused(qr, qr, times(qi, qi)),
                    times(vv, fused(rr, rr, times(ri, ri))),
                );
                let products = fused(
                    re,
                    fused(qr, rr, times(qi, ri)),
                    times(im, fused(qr, ri, minus(times(qi, rr)))),
                );
                let taken = simd.add_f64s(squares, products);
                sums[0] = simd.add_f64s(sums[0], taken);

                // Rounded as the flow over a chunk (`crate::modal::bank`) is.
                let [ar, ai, br, bi, cr, ci, dr, di] = flow.map(load);
                let at = simd;
                let real =
                    |a, b, c, d| fused(a, qr, less(b, qi, fused(c, rr, minus(times(d, ri)))));
                let imaginary = |a, b, c, d| fused(a, qi, fused(b, qr, fused(c, ri, times(d, rr))));
                let to = [
                    at.add_f64s(qr, real(ar, ai, br, bi)),
                    at.add_f64s(qi, imaginary(ar, ai, br, bi)),
                    at.add_f64s(rr, real(cr, ci, dr, di)),
                    at.add_f64s(ri, imaginary(cr, ci, dr, di)),
                ];
                let [contact, rim, re, im] = rows.map(|row| load(&row[i]));
                let mut add = |k: usize, a, b| sums[k] = fused(a, b, sums[k]);
                add(1, contact, to[0]);
                add(2, contact, to[2]);
                add(3, rim, to[0]);
                add(4, re, to[0]);
                add(5, im, to[1]);
                let [x, y, p, q] = to;
                let next =
                    |a, b, c, d, from| less(d, q, fused(c, p, less(b, y, fused(a, x, from))));
                add(6, contact, next(ar, ai, br, bi, x));
                add(7, contact, next(cr, ci, dr, di, p));
                let store = |out: &mut [f64; LANES], x| S::as_mut_simd_f64s(out).0[v] = x;
                store(&mut q_re[i], x);
                store(&mut q_im[i], y);
                store(&mut r_re[i], p);
                store(&mut r_im[i], q);
            }
        }
        for (k, out) in self.sums.iter_mut().enumerate() {
            for (out, sums) in S::as_mut_simd_f64s(out).0.iter_mut().zip(&sums) {
                *out = sums[k];
            }
        }
    }
}
