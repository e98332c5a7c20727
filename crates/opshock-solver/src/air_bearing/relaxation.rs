//! Pseudo-transient continuation for a quasi-static film at a fixed attitude, from states where Newton's method fails.
//!
//! ```text
//! (M/τ + A) δψ = −R,   A = dR/dψ,   M = 12 μ × area of a cell
//! ```
//!
//! These are linearly implicit Euler steps of M dψ/dt + R = 0. Their length τ grows as ψ converges, so that the last
//! steps are Newton's (Kelley and Keyes 1998, SIAM J. Numer. Anal. 35, 508).
//!
//! Why Newton's method alone fails. Without slip (G = ψ), the diffusion G h under a pad of some nanometres is a
//! fiftieth of its value with slip, and at ambient pressure negligible beside the wind. With that diffusion, Newton's
//! first step from ambient pressure raises the gas to 720 times ambient pressure in front of the pads (`drive-2.5in`,
//! 961 cells) and empties cells beside them to the share that a step must leave, again and again: p/p_a falls to 5e-17
//! in forty steps. With slip, G stays above 6 λ p_a as ψ falls; without it, G vanishes with ψ.
//!
//! Why the matrix is singular there. G is taken at the cell's centre (see [`super::flux`]). Without wind the outward
//! flux of a half cell is J = G h_f/Δ (ψ − h_c p_f), and
//!
//! ```text
//! dJ/dψ = (G h_f/Δ) (1 − (ψ G′/G) (p_f/p_c − 1))
//! ```
//!
//! is positive as long as p_f/p_c < 1 + G/(ψ G′). This bound is 2 without slip, where ψ G′/G = 1, and much larger where
//! slip is strong. Within it A has a positive diagonal, negative off-diagonal entries and no negative column sum,
//! except for the slope that the wind carries to a face. A is then close to an M-matrix, and pivots need no exchange of
//! rows ([`crate::linalg::banded`]). Where neighbours differ by factors of hundreds, as in those steps, the sign
//! changes, pivots pass through zero and multipliers grow. The solution itself has no such ratios. M/τ adds to the
//! diagonal alone, so short steps have a dominant diagonal for any A.

use super::attitude::Attitude;
use super::newton::{NEAR, Newton};
use crate::linalg::banded::Entry;
use crate::linalg::diagonals::Diagonals;

/// Inverse of the first step's length, 1/s: in that time gas crosses the smallest cells.
const FIRST_RATE_PER_S: f64 = 8e6;

/// Inverse of the length beyond which a step equals Newton's, 1/s: gas crosses a slider a hundred times in it.
const SLOWEST_RATE_PER_S: f64 = 1e2;

/// Inverse of the shortest step, 1/s.
const FASTEST_RATE_PER_S: f64 = 1e15;

/// Relative change of a cell's ψ beyond which a step is rejected, and the change that the step length aims at.
const LARGEST_CHANGE: f64 = 0.8;
const USUAL_CHANGE: f64 = 0.4;

/// Most steps, rejected ones included.
const MOST_STEPS: usize = 300;

impl<E: Entry> Newton<'_, E> {
    /// Relaxes the quasi-static film at a fixed attitude, in place; returns whether it converged.
    pub(super) fn relax(&mut self, psi: &mut [f64], attitude: &Attitude) -> bool {
        let mut capacity = Diagonals::zeros(psi.len(), vec![0]);
        let own = capacity.column_mut(0).expect("made for it");
        own.copy_from_slice(self.film.capacity());
        let mut delta = vec![0.0; psi.len()];
        let mut rate = FIRST_RATE_PER_S;
        self.forget();
        for _ in 0..MOST_STEPS {
            self.n_factored += 1;
            let (film, linear) = (self.film, &mut self.linearisation);
            film.linearise(psi, attitude, linear, &mut self.scratch);
            let factored = self.lu.factor(&linear.by_psi, rate, &capacity);
            delta.copy_from_slice(&linear.residual);
            let change = factored.map_or(f64::INFINITY, |()| {
                self.lu.solve(&mut delta);
                let changes = delta.iter().zip(&*psi);
                changes.fold(0.0, |most, (delta, psi)| larger(most, (delta / psi).abs()))
            });
            if change > LARGEST_CHANGE {
                rate *= 8.0;
                if rate > FASTEST_RATE_PER_S {
                    return false;
                }
                continue;
            }
            for (psi, delta) in psi.iter_mut().zip(&delta) {
                *psi -= delta;
            }
            if change < NEAR && rate < SLOWEST_RATE_PER_S {
                return true;
            }
            rate *= (change / USUAL_CHANGE).clamp(0.125, 1.0);
        }
        false
    }
}

/// The larger of two numbers, with NaN taken as infinite.
fn larger(most: f64, other: f64) -> f64 {
    if other.is_nan() {
        f64::INFINITY
    } else {
        most.max(other)
    }
}
