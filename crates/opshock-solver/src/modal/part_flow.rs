//! Gives the flow of many oscillators over any short time, as needed to locate an impact within a step.
//!
//! The formulas are those of [`super::oscillator`] in columns, without a call per mode; the loss comes from Gauss
//! quadrature on them. Overdamped modes and those with damping fixed in space use the single oscillator.

use super::bank::{BankFlow, ChunkFlow, LANES, ModalState, chunks};
use super::oscillator::{GAUSS_8, Oscillator};
use crate::elementary::{exp_m1, sin_cos};
use crate::lanes::{self, Kernel};

/// Largest ωh/2, Nh/2 and ηh of the columns: the range of the elementary functions.
const LARGEST_HALF_ANGLE: f64 = 1.6;
const LARGEST_DECAY: f64 = 2.0;

/// Constants from which flows over any time are computed.
#[derive(Clone, Debug, Default)]
pub struct PartFlows {
    oscillators: Vec<Oscillator>,
    /// γ, 1/s.
    eta: Vec<f64>,
    /// √(ω² − γ²), 1/s.
    damped: Vec<f64>,
    /// Its inverse, s.
    inverse: Vec<f64>,
    /// ω², 1/s².
    kappa: Vec<f64>,
    /// N, 1/s.
    turn: Vec<f64>,
    /// Modes for which the single oscillator's formulas are used.
    odd: Vec<usize>,
    longest_s: f64,
}

impl PartFlows {
    /// Tables of `oscillators`, in whole chunks.
    pub fn new(oscillators: &[Oscillator]) -> Self {
        let mut flows = Self {
            oscillators: oscillators.to_vec(),
            longest_s: f64::INFINITY,
            ..Self::default()
        };
        for (i, o) in oscillators.iter().enumerate() {
            let (omega, eta) = (o.omega_rad_per_s, o.half_damping_per_s);
            let is_plain = o.fixed_damping_per_s == 0.0 && omega > eta;
            let (mut row, mut turn) = ([0.0, 1.0, 1.0, 0.0], 0.0);
            if is_plain {
                let damped = ((omega - eta) * (omega + eta)).sqrt();
                (row, turn) = ([eta, damped, 1.0 / damped, omega * omega], o.turn_rad_per_s);
                let half_angle = 0.5 * damped.max(turn.abs());
                let longest = (LARGEST_HALF_ANGLE / half_angle).min(LARGEST_DECAY / eta);
                flows.longest_s = flows.longest_s.min(longest);
            } else if omega != 0.0 {
                flows.odd.push(i);
            }
            let columns = [
                &mut flows.eta,
                &mut flows.damped,
                &mut flows.inverse,
                &mut flows.kappa,
            ];
            for (column, value) in columns.into_iter().zip(row) {
                column.push(value);
            }
            flows.turn.push(turn);
        }
        flows
    }

    /// Sets `flow`, of as many columns, to that over `h_s`; does not allocate.
    pub fn set(&self, h_s: f64, flow: &mut BankFlow) {
        if h_s > self.longest_s {
            flow.set(&self.oscillators, h_s);
            return;
        }
        let flows = self;
        lanes::widest(Set { flows, h_s, flow });
        for &i in &self.odd {
            flow.set_mode(i, &self.oscillators[i].flow(h_s));
        }
    }

    /// Energy that damping takes from the first `n_modes` of `state`, in whole chunks, over `h_s`; nothing of
    /// those in `left_out`.
    pub fn loss(&self, n_modes: usize, state: &ModalState, h_s: f64, left_out: &[usize]) -> f64 {
        let of_mode = |i: usize| {
            let q = nalgebra::Complex::new(state.q_re[i], state.q_im[i]);
            let r = nalgebra::Complex::new(state.r_re[i], state.r_im[i]);
            self.oscillators[i].loss_form(h_s).loss(q, r)
        };
        let is_in = |i: &usize| *i < n_modes && !left_out.contains(i);
        if h_s > self.longest_s {
            return (0..n_modes).filter(is_in).map(of_mode).sum();
        }
        let (flows, n) = (self, n_modes / LANES);
        let mut sums = [0.0; LANES];
        lanes::widest(Loss {
            flows,
            n,
            state,
            h_s,
            left_out,
            sums: &mut sums,
        });
        let odd = self.odd.iter().copied().filter(is_in).map(of_mode);
        lanes::total(sums) + odd.sum::<f64>()
    }
}

/// Constants of one chunk: η, damped frequency, its inverse, ω², N.
type Constants<'a> = [&'a [f64; LANES]; 5];

#[inline(always)]
fn constants(flows: &PartFlows, i: usize) -> Constants<'_> {
    [
        &flows.eta,
        &flows.damped,
        &flows.inverse,
        &flows.kappa,
        &flows.turn,
    ]
    .map(|column| &chunks(column)[i])
}

/// Flow of one chunk over `h_s`, in the order of [`ChunkFlow`].
#[inline(always)]
fn flow_over(of: Constants<'_>, h_s: f64) -> [[f64; LANES]; 8] {
    let [eta, damped, inverse, kappa, turn] = of;
    let (mut decay, mut sine, mut cosine) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let (mut turn_sine, mut turn_cosine) = ([0.0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        decay[l] = exp_m1(-eta[l] * h_s);
        (sine[l], cosine[l]) = sin_cos(0.5 * damped[l] * h_s);
        (turn_sine[l], turn_cosine[l]) = sin_cos(0.5 * turn[l] * h_s);
    }
    let mut out = [[0.0; LANES]; 8];
    for l in 0..LANES {
        let (eta, n) = (eta[l], turn[l]);
        let less_1 = -2.0 * sine[l] * sine[l];
        // C − 1 and S of the rotating frame.
        let c = decay[l].mul_add(1.0 + less_1, less_1);
        let s = (1.0 + decay[l]) * 2.0 * sine[l] * cosine[l] * inverse[l];
        let (pp, pv) = (eta.mul_add(s, c), s);
        let (vp, vv) = (-kappa[l] * s, eta.mul_add(-s, c));
        // e^{−iNh} − 1.
        let rl_re = -2.0 * turn_sine[l] * turn_sine[l];
        let im = -2.0 * turn_sine[l] * turn_cosine[l];
        let re = 1.0 + rl_re;
        // Products with 1 + i N, as the oscillator takes them.
        let (a, b) = (pp, n * pv);
        let (qq_re, qq_im) = (rl_re + re.mul_add(a, -(im * b)), im + re.mul_add(b, im * a));
        let (qr_re, qr_im) = (re * pv, im * pv);
        let (a, b) = (vp, n * vv);
        let (sq_re, sq_im) = (
            (-im).mul_add(n, re.mul_add(a, -(im * b))),
            rl_re.mul_add(n, re.mul_add(b, im * a)),
        );
        out[0][l] = qq_re;
        out[1][l] = qq_im;
        out[2][l] = qr_re;
        out[3][l] = qr_im;
        out[4][l] = n.mul_add(qq_im, sq_re);
        out[5][l] = n.mul_add(-qq_re, sq_im);
        out[6][l] = n.mul_add(qr_im, re.mul_add(vv, rl_re));
        out[7][l] = n.mul_add(-qr_re, im.mul_add(vv, im));
    }
    out
}

struct Set<'a> {
    flows: &'a PartFlows,
    h_s: f64,
    flow: &'a mut BankFlow,
}

impl Kernel for Set<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for i in 0..chunks(&self.flows.eta).len() {
            let of = flow_over(constants(self.flows, i), self.h_s);
            self.flow.set_chunk(i, &of);
        }
    }
}

struct Loss<'a> {
    flows: &'a PartFlows,
    n: usize,
    state: &'a ModalState,
    h_s: f64,
    left_out: &'a [usize],
    sums: &'a mut [f64; LANES],
}

impl Kernel for Loss<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let columns = self.state.columns();
        for i in 0..self.n {
            let of = constants(self.flows, i);
            let at = columns.map(|column| chunks(column)[i]);
            let mut chunk = [0.0; LANES];
            for (x, weight) in GAUSS_8 {
                let flow = flow_over(of, x * self.h_s);
                let [q_re, q_im, r_re, r_im] = ChunkFlow(flow.each_ref()).carry(at);
                for l in 0..LANES {
                    // Re(s r*) with s = r + i N q.
                    let across = q_re[l].mul_add(r_im[l], -(q_im[l] * r_re[l]));
                    let squares = r_re[l].mul_add(r_re[l], r_im[l] * r_im[l]);
                    let power = 2.0 * of[0][l] * of[4][l].mul_add(across, squares);
                    chunk[l] = (weight * self.h_s).mul_add(power, chunk[l]);
                }
            }
            for j in self.left_out {
                if j / LANES == i {
                    chunk[j % LANES] = 0.0;
                }
            }
            for (sum, taken) in self.sums.iter_mut().zip(chunk) {
                *sum += taken;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen modes: rotating, overdamped, damped in space, resting.
    fn modes() -> Vec<Oscillator> {
        let mut modes: Vec<Oscillator> = (0..16)
            .map(|k| Oscillator {
                omega_rad_per_s: 6.0e3 * 1.4_f64.powi(k),
                half_damping_per_s: 5e-8 * (6.0e3 * 1.4_f64.powi(k)).powi(2),
                turn_rad_per_s: 565.0 * f64::from(k),
                fixed_damping_per_s: 0.0,
            })
            .collect();
        modes[3].half_damping_per_s = 3.0 * modes[3].omega_rad_per_s;
        modes[7].fixed_damping_per_s = 40.0;
        modes[15] = Oscillator::default();
        modes
    }

    #[test]
    fn columns_are_the_oscillators_to_rounding() {
        let modes = modes();
        let flows = PartFlows::new(&modes);
        let (mut columns, mut own) = (BankFlow::zeros(16), BankFlow::zeros(16));
        let state = ModalState {
            q_re: (0..16).map(|k| f64::from(k).sin()).collect(),
            q_im: (0..16).map(|k| f64::from(k).cos()).collect(),
            r_re: (0..16).map(|k| 1e4 * f64::from(k).cos()).collect(),
            r_im: (0..16).map(|k| -3e4 * f64::from(k).cos()).collect(),
        };
        let (mut a, mut b) = (ModalState::at_rest(16), ModalState::at_rest(16));
        // The last time is beyond the range of the columns.
        for h in [1e-12, 3e-9, 1e-7, 2.5e-7, 1e-4] {
            flows.set(h, &mut columns);
            own.set(&modes, h);
            columns.apply(16, &state, &mut a);
            own.apply(16, &state, &mut b);
            for i in 0..15 {
                let omega = modes[i].omega_rad_per_s;
                let size = 1.0 + 4e4 / omega;
                let moved = [(&a.q_re, &b.q_re), (&a.q_im, &b.q_im)];
                let turned = [(&a.r_re, &b.r_re), (&a.r_im, &b.r_im)];
                for (a, b) in moved {
                    assert!((a[i] - b[i]).abs() < 4e-16 * size, "{i} {h:e}");
                }
                for (a, b) in turned {
                    assert!((a[i] - b[i]).abs() < 1e-15 * omega * size, "{i} {h:e}");
                }
            }
            let wanted: f64 = (0..16)
                .filter(|&i| i != 2)
                .map(|i| {
                    let q = nalgebra::Complex::new(state.q_re[i], state.q_im[i]);
                    let r = nalgebra::Complex::new(state.r_re[i], state.r_im[i]);
                    modes[i].loss_form(h).loss(q, r)
                })
                .sum();
            let found = flows.loss(16, &state, h, &[2]);
            assert!(
                (found / wanted - 1.0).abs() < 1e-11,
                "{h:e}: {found} {wanted}"
            );
        }
    }
}
