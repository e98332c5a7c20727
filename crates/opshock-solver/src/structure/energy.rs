//! Keeps the energy balance of disk and arms along a run.
//!
//! The weights are closed forms of each mode (see [`crate::modal::oscillator`]). The loss over a step comes from the
//! roots of the motion and not from the energies at its ends: the balance therefore closes only when flow, forcing,
//! impulses and losses agree.

use crate::lanes::{self, Kernel};
use crate::modal::bank::{LANES, chunks};
use crate::modal::{LossForm, ModalState, Oscillator};

/// Energies at one instant, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Energies {
    /// Kinetic energy of the material.
    pub kinetic: f64,
    /// Elastic energy.
    pub elastic: f64,
    /// Energy H of the space-fixed frame.
    pub fixed_frame: f64,
}

impl Energies {
    pub fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.fixed_frame += other.fixed_frame;
    }

    pub fn material(&self) -> f64 {
        self.kinetic + self.elastic
    }
}

/// Weights of the energies over the bank.
#[derive(Clone, Debug, Default)]
pub(super) struct EnergyWeights {
    stiffness: Vec<f64>,
    turn: Vec<f64>,
}

/// Weights of the loss over one time, over the bank.
#[derive(Clone, Debug, Default)]
pub(super) struct LossWeights {
    qq: Vec<f64>,
    rr: Vec<f64>,
    qr_re: Vec<f64>,
    qr_im: Vec<f64>,
}

impl EnergyWeights {
    /// Weights of all modes.
    pub fn new(oscillators: &[Oscillator]) -> Self {
        let squared = |o: &Oscillator| o.omega_rad_per_s * o.omega_rad_per_s;
        Self {
            stiffness: oscillators.iter().map(squared).collect(),
            turn: oscillators.iter().map(|o| o.turn_rad_per_s).collect(),
        }
    }

    /// Energies of a total state.
    pub fn energies(&self, state: &ModalState) -> Energies {
        let weights = self;
        let sums = lanes::widest(EnergySums { weights, state });
        let [rr, turned, turn2, spring] = sums.map(|s| 0.5 * lanes::total(s));
        Energies {
            kinetic: rr + 2.0 * turned + turn2,
            elastic: spring,
            fixed_frame: rr - turn2 + spring,
        }
    }

    /// ½ Σ (|r|² + ω² |q|²) of a chunk of modes, J: the size of their motion.
    pub fn of_chunk(&self, chunk: usize, state: &ModalState) -> f64 {
        let modes = chunk * LANES..(chunk + 1) * LANES;
        let squares = |a: f64, b: f64| a * a + b * b;
        modes
            .map(|i| {
                let spring = self.stiffness[i] * squares(state.q_re[i], state.q_im[i]);
                0.5 * (spring + squares(state.r_re[i], state.r_im[i]))
            })
            .sum()
    }
}

impl LossWeights {
    /// Weights for a time `h_s`; the loss of the modes in `forced` is computed with their forcing.
    pub fn new(oscillators: &[Oscillator], forced: &[usize], h_s: f64) -> Self {
        let mut w = Self::default();
        for (i, o) in oscillators.iter().enumerate() {
            let loss = if forced.contains(&i) {
                LossForm::default()
            } else {
                o.loss_form(h_s)
            };
            w.qq.push(loss.qq);
            w.rr.push(loss.rr);
            w.qr_re.push(2.0 * loss.qr.re);
            w.qr_im.push(-2.0 * loss.qr.im);
        }
        w
    }

    /// Weights of |q|², |r|² and the real and imaginary part of q* r.
    pub fn columns(&self) -> [&[f64]; 4] {
        [&self.qq, &self.rr, &self.qr_re, &self.qr_im]
    }

    /// Loss of those of the first `n_modes`, in whole chunks, that are without forcing.
    pub fn loss(&self, n_modes: usize, state: &ModalState) -> f64 {
        let (weights, n) = (self, n_modes / LANES);
        lanes::total(lanes::widest(LossSums { weights, n, state }))
    }
}

struct EnergySums<'a> {
    weights: &'a EnergyWeights,
    state: &'a ModalState,
}

impl Kernel for EnergySums<'_> {
    type Output = [[f64; LANES]; 4];

    #[inline(always)]
    fn call(self) -> [[f64; LANES]; 4] {
        let [q_re, q_im, r_re, r_im] = self.state.columns();
        // Slices of one length, so that the loop needs no bounds checks.
        let n = chunks(&self.weights.turn).len();
        let read = |column| &chunks(column)[..n];
        let (turn, stiffness) = (read(&self.weights.turn), read(&self.weights.stiffness));
        let (q_re, q_im) = (read(q_re), read(q_im));
        let (r_re, r_im) = (read(r_re), read(r_im));
        let mut sums = [[0.0; LANES]; 4];
        for i in 0..n {
            for l in 0..LANES {
                let (xr, xi) = (q_re[i][l], q_im[i][l]);
                let (vr, vi) = (r_re[i][l], r_im[i][l]);
                let qq = xr.mul_add(xr, xi * xi);
                let turn = turn[i][l];
                sums[0][l] += vr.mul_add(vr, vi * vi);
                sums[1][l] = turn.mul_add(vi.mul_add(xr, -(vr * xi)), sums[1][l]);
                sums[2][l] = (turn * turn).mul_add(qq, sums[2][l]);
                sums[3][l] = stiffness[i][l].mul_add(qq, sums[3][l]);
            }
        }
        sums
    }
}

struct LossSums<'a> {
    weights: &'a LossWeights,
    n: usize,
    state: &'a ModalState,
}

impl Kernel for LossSums<'_> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn call(self) -> [f64; LANES] {
        let LossWeights {
            qq,
            rr,
            qr_re,
            qr_im,
        } = self.weights;
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let (qq, rr) = (read(qq), read(rr));
        let (qr_re, qr_im) = (read(qr_re), read(qr_im));
        let (q_re, q_im) = (read(&self.state.q_re), read(&self.state.q_im));
        let (r_re, r_im) = (read(&self.state.r_re), read(&self.state.r_im));
        let mut sum = [0.0; LANES];
        for i in 0..n {
            for l in 0..LANES {
                let (xr, xi) = (q_re[i][l], q_im[i][l]);
                let (vr, vi) = (r_re[i][l], r_im[i][l]);
                // q* r = (xr vr + xi vi) + i (xr vi − xi vr)
                let squares =
                    qq[i][l].mul_add(xr.mul_add(xr, xi * xi), rr[i][l] * vr.mul_add(vr, vi * vi));
                let products = qr_re[i][l].mul_add(
                    xr.mul_add(vr, xi * vi),
                    qr_im[i][l] * xr.mul_add(vi, -(xi * vr)),
                );
                sum[l] += squares + products;
            }
        }
        sum
    }
}

/// A compensated sum (Neumaier 1974): it adds up the rounding error of every addition, so that its error is that of its
/// terms, whatever their number, and balances kept in different portions agree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LongSum {
    sum: f64,
    lost: f64,
}

impl LongSum {
    /// A sum that begins with a value.
    pub fn from_value(value: f64) -> Self {
        Self {
            sum: value,
            lost: 0.0,
        }
    }

    /// Adds a term.
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    /// The sum.
    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

/// Energies exchanged along a run, and the largest energies met, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ExchangedEnergy {
    pub work: LongSum,
    pub damping: LongSum,
    pub impact: f64,
    pub algorithmic: f64,
    pub spindle: f64,
    pub peak_fixed_frame: f64,
    pub peak_material: f64,
}

#[cfg(test)]
mod tests {
    use super::LongSum;

    #[test]
    fn a_long_sum_does_not_depend_on_portions() {
        // 1e16 + 1 + ... + 1 - 1e16: every 1 is lost by plain addition.
        let mut sum = LongSum::from_value(1e16);
        for _ in 0..1000 {
            sum.add(1.0);
        }
        sum.add(-1e16);
        assert_eq!(sum.value(), 1000.0);
        // A tenth, a hundred thousand times: plain addition is off by 2e-8 here.
        let (mut at_once, mut scaled) = (LongSum::default(), LongSum::default());
        for _ in 0..100_000 {
            at_once.add(0.1);
            scaled.add(0.1 * 3.0);
        }
        assert!((at_once.value() / 10_000.0 - 1.0).abs() < 2e-16);
        assert!((scaled.value() / (3.0 * at_once.value()) - 1.0).abs() < 3e-16);
    }
}
