//! One whole step of what contact drives, in one pass over the modes: loss, flow and what is read at its end.
//!
//! What a gap will be a step on is a sum over the state now, so that impulses can be aimed before anything is
//! carried: the state is read once a step, with the impulses of its start in it.

use super::driven::Driven;
use crate::complementarity::Gap;
use crate::lanes::{self, Simd, WithSimd, abreast};
use crate::modal::bank::{ChunkFlow, LANES, chunks};
use crate::modal::{BankFlow, ModalState};

/// Rows that read the disk's displacement and rate at the contact point a step on out of q and r, real and imaginary
/// parts.
#[derive(Clone, Debug, Default)]
pub(super) struct Outlook {
    value: [Vec<f64>; 4],
    rate: [Vec<f64>; 4],
    /// Gap velocities after a step per impulses at its start, 1/kg.
    pub response: [[f64; 2]; 2],
}

/// What contact adds to the disk's points at a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sight {
    /// Contact point.
    pub contact: Gap,
    /// The same a step on, if nothing happens.
    pub contact_ahead: Gap,
    /// Rim and slider, m.
    pub rim_m: f64,
    pub slider_m: f64,
}

impl Outlook {
    /// Rows for the points of `contact` after `flow`.
    pub fn new(contact: &[f64], flow: &BankFlow) -> Self {
        let n = contact.len();
        let mut outlook = Self {
            value: std::array::from_fn(|_| vec![0.0; n]),
            rate: std::array::from_fn(|_| vec![0.0; n]),
            ..Self::default()
        };
        for (i, &shape) in contact.iter().enumerate() {
            let of = flow.of_mode(i);
            let value = [1.0 + of.qq.re, -of.qq.im, of.qr.re, -of.qr.im];
            let rate = [of.rq.re, -of.rq.im, 1.0 + of.rr.re, -of.rr.im];
            for k in 0..4 {
                outlook.value[k][i] = shape * value[k];
                outlook.rate[k][i] = shape * rate[k];
            }
        }
        outlook
    }

    /// The contact point a step after `state`.
    pub fn of(&self, n_modes: usize, state: &ModalState) -> Gap {
        let columns = columns(state).map(|column| &column[..n_modes]);
        let value = std::array::from_fn(|k| [&*self.value[k], columns[k]]);
        let rate = std::array::from_fn(|k| [&*self.rate[k], columns[k]]);
        let sum = |pairs: [[&[f64]; 2]; 4]| -> f64 { abreast(pairs).into_iter().sum() };
        Gap {
            value_m: sum(value),
            rate_m_per_s: sum(rate),
        }
    }
}

fn columns(state: &ModalState) -> [&[f64]; 4] {
    [&state.q_re, &state.q_im, &state.r_re, &state.r_im]
}

impl Driven {
    /// Carries the first `n_modes` of `now` over a step into `ahead`: the loss of those without forcing, and what is
    /// seen at its end.
    pub fn stride(&self, n_modes: usize, now: &ModalState, ahead: &mut ModalState) -> (f64, Sight) {
        let mut sums = [[0.0; LANES]; SUMS];
        lanes::widest(Stride {
            driven: self,
            n: n_modes / LANES,
            now,
            ahead,
            sums: &mut sums,
        });
        let [loss, value, rate, rim, slider_re, slider_im, next, next_rate] =
            sums.map(lanes::total);
        let gap = |value_m: f64, rate_m_per_s: f64| Gap {
            value_m,
            rate_m_per_s,
        };
        let sight = Sight {
            contact: gap(value, rate),
            contact_ahead: gap(next, next_rate),
            rim_m: rim,
            slider_m: slider_re + slider_im,
        };
        (loss, sight)
    }

    /// The contact point of arm `side` in `state`, by contact.
    pub fn arm_now(&self, side: usize, state: &ModalState) -> Gap {
        let mut at = Gap::default();
        for j in self.arms[side].modes.clone() {
            at.value_m += self.arm_shape[side][j] * state.q_re[j];
            at.rate_m_per_s += self.arm_shape[side][j] * state.r_re[j];
        }
        at
    }

    /// The contact point of arm `side` a step after `state`, by contact.
    pub fn arm_ahead(&self, side: usize, state: &ModalState) -> Gap {
        let mut at = Gap::default();
        for j in self.arms[side].modes.clone() {
            // Arms stand in the drive's frame: all is real.
            let (of, shape) = (self.step_flow.of_mode(j), self.arm_shape[side][j]);
            let (q, r) = (state.q_re[j], state.r_re[j]);
            at.value_m += shape * (q + (of.qq.re * q + of.qr.re * r));
            at.rate_m_per_s += shape * (r + (of.rq.re * q + of.rr.re * r));
        }
        at
    }
}

/// Loss, contact point and its rate, rim, both parts of the slider, contact point and rate a step on.
const SUMS: usize = 8;

struct Stride<'a> {
    driven: &'a Driven,
    n: usize,
    now: &'a ModalState,
    ahead: &'a mut ModalState,
    sums: &'a mut [[f64; LANES]; SUMS],
}

impl WithSimd for Stride<'_> {
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

impl Stride<'_> {
    #[inline(always)]
    fn run<S: Simd, const V: usize>(self, simd: S) {
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let driven = self.driven;
        let now = columns(self.now).map(|column| read(column));
        let loss = driven.step_loss.columns().map(|column| read(column));
        let rows = [
            &driven.contact,
            &driven.rim,
            &driven.slider[0].re,
            &driven.slider[0].im,
        ];
        let rows = rows.map(|row| read(row));
        let value = driven.outlook.value.each_ref().map(|row| read(row));
        let rate = driven.outlook.rate.each_ref().map(|row| read(row));
        let ModalState {
            q_re,
            q_im,
            r_re,
            r_im,
        } = self.ahead;
        let [out_q_re, out_q_im, out_r_re, out_r_im] =
            [q_re, q_im, r_re, r_im].map(|column| &mut column.as_chunks_mut::<LANES>().0[..n]);
        let mut sums = [[simd.splat_f64s(0.0); V]; SUMS];
        let fused = |a, b, c| simd.mul_add_f64s(a, b, c);
        let times = |a, b| simd.mul_f64s(a, b);
        let minus = |a| simd.neg_f64s(a);
        for i in 0..n {
            let ChunkFlow(flow) = driven.step_flow.of_chunk(i);
            for v in 0..V {
                let load = |x: &[f64; LANES]| S::as_simd_f64s(x).0[v];
                let [qr, qi, rr, ri] = now.map(|column| load(&column[i]));
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
                sums[0][v] = simd.add_f64s(sums[0][v], taken);

                // The roundings of the flow over a chunk (`crate::modal::bank`).
                let [ar, ai, br, bi, cr, ci, dr, di] = flow.map(load);
                let (minus_qi, at) = (minus(qi), simd);
                let real = |a, b, c, d| {
                    fused(a, qr, fused(b, minus_qi, fused(c, rr, minus(times(d, ri)))))
                };
                let imaginary =
                    |a, b, c, d| fused(a, qi, fused(b, qr, fused(c, ri, times(d, rr))));
                let to = [
                    at.add_f64s(qr, real(ar, ai, br, bi)),
                    at.add_f64s(qi, imaginary(ar, ai, br, bi)),
                    at.add_f64s(rr, real(cr, ci, dr, di)),
                    at.add_f64s(ri, imaginary(cr, ci, dr, di)),
                ];
                let [contact, rim, re, im] = rows.map(|row| load(&row[i]));
                let mut add = |k: usize, a, b| sums[k][v] = fused(a, b, sums[k][v]);
                add(1, contact, to[0]);
                add(2, contact, to[2]);
                add(3, rim, to[0]);
                add(4, re, to[0]);
                add(5, im, to[1]);
                for k in 0..4 {
                    add(6, load(&value[k][i]), to[k]);
                    add(7, load(&rate[k][i]), to[k]);
                }
                let store = |out: &mut [f64; LANES], x| S::as_mut_simd_f64s(out).0[v] = x;
                store(&mut out_q_re[i], to[0]);
                store(&mut out_q_im[i], to[1]);
                store(&mut out_r_re[i], to[2]);
                store(&mut out_r_im[i], to[3]);
            }
        }
        for (out, sums) in self.sums.iter_mut().zip(sums) {
            for (out, sum) in S::as_mut_simd_f64s(out).0.iter_mut().zip(sums) {
                *out = sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::Oscillator;

    #[test]
    fn what_is_seen_ahead_is_what_the_flow_brings() {
        let modes: Vec<Oscillator> = (0..8)
            .map(|k| Oscillator {
                omega_rad_per_s: 3e4 * f64::from(1 + k),
                half_damping_per_s: 400.0,
                turn_rad_per_s: 565.0 * f64::from(k),
                fixed_damping_per_s: 3.0,
            })
            .collect();
        let contact: Vec<f64> = (0..8).map(|k| 20.0 - f64::from(k)).collect();
        let mut flow = BankFlow::zeros(8);
        flow.set(&modes, 2.5e-7);
        let at = |seed: f64, size: f64| -> Vec<f64> {
            (0..8).map(|k| size * (seed + f64::from(k)).sin()).collect()
        };
        let state = ModalState {
            q_re: at(0.3, 1e-6),
            q_im: at(1.3, 1e-6),
            r_re: at(2.3, 0.1),
            r_im: at(3.3, 0.1),
        };
        let mut after = ModalState::at_rest(8);
        flow.apply(8, &state, &mut after);
        let ahead = Outlook::new(&contact, &flow).of(8, &state);
        let sum = |column: &[f64]| lanes::product(&contact, column);
        assert!((ahead.value_m - sum(&after.q_re)).abs() < 1e-19);
        assert!((ahead.rate_m_per_s - sum(&after.r_re)).abs() < 1e-14);
    }
}
