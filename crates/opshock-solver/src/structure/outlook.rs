//! Predicts the contact-driven motion of the disk one step ahead from the present state.

use crate::complementarity::Gap;
use crate::lanes::abreast;
use crate::modal::{BankFlow, ModalState};

/// Rows that read the disk's displacement and rate at the contact point one step ahead from q and r, real and imaginary
/// parts.
#[derive(Clone, Debug, Default)]
pub(super) struct Outlook {
    value: [Vec<f64>; 4],
    rate: [Vec<f64>; 4],
    /// Gap velocities after a step per impulses at its start, 1/kg.
    pub response: [[f64; 2]; 2],
}

/// Contact-driven motion of the disk's points at a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sight {
    /// Contact point.
    pub contact: Gap,
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
        let columns = state.columns().map(|column| &column[..n_modes]);
        let value = std::array::from_fn(|k| [&*self.value[k], columns[k]]);
        let rate = std::array::from_fn(|k| [&*self.rate[k], columns[k]]);
        let sum = |pairs: [[&[f64]; 2]; 4]| -> f64 { abreast(pairs).into_iter().sum() };
        Gap {
            value_m: sum(value),
            rate_m_per_s: sum(rate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes;
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
