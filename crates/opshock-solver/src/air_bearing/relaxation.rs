//! Pseudo-transient continuation: a film under a slider held still, from where Newton's method fails.
//!
//! ```text
//! (M/τ + A) δψ = −R,   A = dR/dψ,   M = 12 μ × area of a cell
//! ```
//!
//! Linearly implicit Euler steps of M dψ/dt + R = 0, whose length τ grows as ψ settles, so that the last ones are Newton's
//! (Kelley and Keyes 1998, SIAM J. Numer. Anal. 35, 508).
//!
//! Why Newton's method alone fails. Where gas does not slip (G = ψ), diffusion G h under a pad of some nanometres is a
//! fiftieth of what it is with slip, and at ambient pressure next to nothing beside the wind. Newton's first step from
//! ambient pressure sees that diffusion and piles the gas up to 720 times ambient pressure before the pads (`drive-2.5in`,
//! 961 cells), while cells beside them are emptied to the share that a step must leave, again and again: p/p_a falls to
//! 5e-17 in forty steps. With slip G stays above 6 λ p_a as ψ falls, without it G, and all diffusion, falls with ψ to nothing.
//!
//! Why the matrix is singular there. G is taken at the cell's centre (see [`super::flux`]). Without wind the outward flux of
//! a half cell is J = G h_f/Δ (ψ − h_c p_f), and
//!
//! ```text
//! dJ/dψ = (G h_f/Δ) (1 − (ψ G′/G) (p_f/p_c − 1))
//! ```
//!
//! is positive as long as p_f/p_c < 1 + G/(ψ G′): below 2 without slip, where ψ G′/G = 1, and with a wide margin where slip
//! is strong. As long as it is, A has a positive diagonal, negative numbers beside it and no negative sum of a column
//! but for the slope that the wind carries to a face: it is close to an M-matrix, and pivots need no exchange of rows
//! ([`crate::linalg::banded`]). Where neighbours differ by hundreds of times, as in those steps, the sign turns, pivots pass
//! through zero and multipliers grow. The solution itself has no such ratios. M/τ adds to the diagonal alone: short steps
//! have a dominant diagonal whatever A is.

use super::attitude::Attitude;
use super::newton::{NEAR, Newton};
use crate::linalg::banded::Entry;
use crate::linalg::diagonals::Diagonals;

/// Inverse of the first step's length, 1/s: gas crosses the smallest cells in so long.
const FIRST_RATE_PER_S: f64 = 8e6;

/// Inverse of the length from which on a step is as good as Newton's, 1/s: gas crosses a slider some hundred times meanwhile.
const SLOWEST_RATE_PER_S: f64 = 1e2;

/// Inverse of the shortest step, 1/s.
const FASTEST_RATE_PER_S: f64 = 1e15;

/// Relative change of a cell's ψ beyond which a step is taken back, and that which steps are made for.
const LARGEST_CHANGE: f64 = 0.8;
const USUAL_CHANGE: f64 = 0.4;

/// Most steps, the ones taken back counted.
const MOST_STEPS: usize = 300;

impl<E: Entry> Newton<'_, E> {
    /// Relaxes a film under a slider held still, in place; whether it settled.
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

/// The larger of two numbers, what is no number counting as infinite.
fn larger(most: f64, other: f64) -> f64 {
    if other.is_nan() {
        f64::INFINITY
    } else {
        most.max(other)
    }
}
