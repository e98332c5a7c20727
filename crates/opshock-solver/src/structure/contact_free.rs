//! Advances the contact-driven modes by many steps at once over a contact-free interval, in which no gap can close.
//!
//! Between contacts the modes move freely: their flow over many steps, and the energy that damping takes meanwhile, are
//! closed forms. It must be proved that no gap closes in between. The contact-driven motion of a point deviates from
//! the cubic through its values and rates at both ends by at most h⁴/384 times the largest fourth derivative, and
//!
//! ```text
//! |p(t)| ≤ A = |p| + |ṗ|/ω,   |q⁽⁴⁾| ≤ Λ⁴ A,   Λ = √|κ| + 2γ + c + N
//! ```
//!
//! by the energy of a mode in its rotating frame ([`crate::modal::oscillator`]). For a mode too fast for this bound the
//! deviation is bounded by what it and its cubic can reach together. The unit response is bounded from its values at
//! the nodes ([`super::span`]). Where both bounds leave the gaps open, the steps between only advance the state and are
//! skipped. Nodes between are evaluated only where a history or an extreme needs them.

use super::bank::Bank;
use super::energy::LossWeights;
use super::span::INTERVAL_NODES;
use crate::lanes::{self, Kernel};
use crate::modal::bank::{LANES, chunks};
use crate::modal::{BankFlow, LossForm, ModalState, Oscillator};

/// Factor on the energy bounds: damping fixed in space may feed a little energy into a mode.
const WIDENING: f64 = 1.01;

/// Tables over a contact-free interval.
pub(super) struct ContactFree {
    pub length_s: f64,
    pub flow: BankFlow,
    pub loss: LossWeights,
    /// Loss of the forced modes, in their order.
    pub forced_loss: Vec<LossForm>,
    /// Largest deviation of any evaluated point from its cubic, per |q| and per |r|.
    stray_q: Vec<f64>,
    stray_r: Vec<f64>,
}

/// Contact-driven displacement and rate of the points whose extremes are kept: contact point, rim, slider.
pub(super) type Points = [[f64; 2]; 3];

impl ContactFree {
    /// Tables over the modes of `bank` for steps of `step_s`.
    pub fn new(bank: &Bank, step_s: f64) -> Self {
        let length_s = INTERVAL_NODES as f64 * step_s;
        let mut flow = BankFlow::zeros(bank.oscillators.len());
        flow.set(&bank.oscillators, length_s);
        let forced = bank.forced_index.iter();
        let stray = |i: usize| {
            let slider = f64::hypot(bank.slider[0].re[i], bank.slider[0].im[i]);
            let arm = bank.arm_shape[0][i].abs().max(bank.arm_shape[1][i].abs());
            let largest = (bank.contact[i].abs() + arm).max(bank.rim[i].abs());
            stray_of(&bank.oscillators[i], largest.max(slider), length_s)
        };
        let strays = (0..bank.oscillators.len()).map(stray);
        let (stray_q, stray_r) = strays.unzip();
        Self {
            length_s,
            flow,
            loss: LossWeights::new(&bank.oscillators, &bank.forced_index, length_s),
            forced_loss: forced
                .map(|&i| bank.oscillators[i].loss_form(length_s))
                .collect(),
            stray_q,
            stray_r,
        }
    }

    /// Largest deviation of a point from the cubic between both ends of the interval that begins at `state`, m.
    pub fn stray_m(&self, n_modes: usize, state: &ModalState) -> f64 {
        let (contact_free, n) = (self, n_modes / LANES);
        lanes::total(lanes::widest(Stray {
            contact_free,
            n,
            state,
        }))
    }
}

/// Weights of |q| and |r| in the largest deviation of a point of that `shape`.
fn stray_of(o: &Oscillator, shape: f64, h_s: f64) -> (f64, f64) {
    let omega = o.omega_rad_per_s;
    if omega == 0.0 {
        return (0.0, 0.0);
    }
    let turn = o.turn_rad_per_s.abs();
    let kappa = f64::hypot(omega * omega, o.fixed_damping_per_s * turn);
    let rate = kappa.sqrt() + 2.0 * o.half_damping_per_s + o.fixed_damping_per_s + turn;
    let angle = rate * h_s;
    // Bound of the cubic itself: its end values, and 4/27 of the interval times the rates at both ends.
    let share = (angle.powi(4) / 384.0).min(2.0 + 0.3 * angle);
    let weight = WIDENING * share * shape;
    (weight * (1.0 + turn / omega), weight / omega)
}

struct Stray<'a> {
    contact_free: &'a ContactFree,
    n: usize,
    state: &'a ModalState,
}

/// Σ of both weights times |re| + |im|, which is no less than the magnitude.
impl Kernel for Stray<'_> {
    type Output = [f64; LANES];

    #[inline(always)]
    fn call(self) -> [f64; LANES] {
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let (by_q, by_r) = (
            read(&self.contact_free.stray_q),
            read(&self.contact_free.stray_r),
        );
        let (q_re, q_im) = (read(&self.state.q_re), read(&self.state.q_im));
        let (r_re, r_im) = (read(&self.state.r_re), read(&self.state.r_im));
        let mut sum = [0.0; LANES];
        for i in 0..n {
            for l in 0..LANES {
                let q = q_re[i][l].abs() + q_im[i][l].abs();
                let r = r_re[i][l].abs() + r_im[i][l].abs();
                sum[l] = by_q[i][l].mul_add(q, by_r[i][l].mul_add(r, sum[l]));
            }
        }
        sum
    }
}
