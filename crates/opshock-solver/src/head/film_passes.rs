//! Loops over the film's cells in a stage of a time step: the cells' storage, Newton's correction once the slider's is
//! known, and the size of an error.
//!
//! ```text
//! r_f = M (ψ − ψ_known)/d + R,    δψ = −A⁻¹ r_f − Z δq
//! ```

use crate::lanes::{Kernel, SUMS, total, widest};
use crate::linalg::diagonals::Diagonals;

/// Turns `residual`, which holds A⁻¹ r_f, into δψ in place. Returns Σ (δψ/ψ)² and the largest share of its gas that a
/// cell would lose. A NaN in ψ or δψ makes the sum NaN.
///
/// # Panics
///
/// When slices differ in length.
pub(super) fn correct_film(
    residual: &mut [f64],
    z: &[Vec<f64>; 3],
    psi: &[f64],
    dq: [f64; 3],
) -> (f64, f64) {
    assert!(z.iter().all(|z| z.len() == psi.len()) && residual.len() == psi.len());
    let (squares, losses, [square, loss]) = widest(Correct {
        residual,
        z: [&z[0], &z[1], &z[2]],
        psi,
        dq,
    });
    (
        total(squares) + square,
        losses.into_iter().fold(loss, f64::max),
    )
}

/// `residual` += `storage` (`psi` − `known`) `per_d`.
///
/// # Panics
///
/// When slices differ in length.
pub(super) fn add_storage(
    residual: &mut [f64],
    storage: &Diagonals,
    [psi, known]: [&[f64]; 2],
    per_d: f64,
) {
    let n = residual.len();
    assert!(storage.n() == n && psi.len() == n && known.len() == n);
    widest(AddStorage {
        residual,
        storage,
        psi,
        known,
        per_d,
    });
}

/// Root of the mean of (e/ψ)², with `least` for ψ where that is less.
///
/// # Panics
///
/// When slices differ in length.
pub(super) fn relative_size(e: &[f64], psi: &[f64], least: f64) -> f64 {
    assert_eq!(e.len(), psi.len());
    let (squares, square) = widest(RelativeSquares { e, psi, least });
    ((total(squares) + square) / psi.len() as f64).sqrt()
}

struct AddStorage<'a> {
    residual: &'a mut [f64],
    storage: &'a Diagonals,
    psi: &'a [f64],
    known: &'a [f64],
    per_d: f64,
}

impl Kernel for AddStorage<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (offset, column) in self.storage.iter() {
            let rows = self.storage.rows(offset);
            let Some(first) = rows.start.checked_add_signed(offset) else {
                continue;
            };
            let m = rows.len();
            let (column, residual) = (
                &column[rows.start..][..m],
                &mut self.residual[rows.start..][..m],
            );
            let (psi, known) = (&self.psi[first..][..m], &self.known[first..][..m]);
            for k in 0..m {
                residual[k] = (column[k] * (psi[k] - known[k])).mul_add(self.per_d, residual[k]);
            }
        }
    }
}

struct RelativeSquares<'a> {
    e: &'a [f64],
    psi: &'a [f64],
    least: f64,
}

impl Kernel for RelativeSquares<'_> {
    type Output = ([f64; SUMS], f64);

    #[inline(always)]
    fn call(self) -> Self::Output {
        let ((e, e_rest), (psi, psi_rest)) =
            (self.e.as_chunks::<SUMS>(), self.psi.as_chunks::<SUMS>());
        let mut squares = [0.0; SUMS];
        for (e, psi) in e.iter().zip(psi) {
            for k in 0..SUMS {
                let relative = e[k] / at_least(psi[k], self.least);
                squares[k] = relative.mul_add(relative, squares[k]);
            }
        }
        let mut square = 0.0;
        for (e, psi) in e_rest.iter().zip(psi_rest) {
            let relative = e / at_least(*psi, self.least);
            square = relative.mul_add(relative, square);
        }
        (squares, square)
    }
}

/// ψ, or `least` where that is more; NaN stays.
#[inline(always)]
fn at_least(psi: f64, least: f64) -> f64 {
    if psi < least { least } else { psi }
}

struct Correct<'a> {
    residual: &'a mut [f64],
    z: [&'a [f64]; 3],
    psi: &'a [f64],
    dq: [f64; 3],
}

impl Kernel for Correct<'_> {
    /// Squares and losses kept apart, and those of the remainder.
    type Output = ([f64; SUMS], [f64; SUMS], [f64; 2]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (delta, delta_rest) = self.residual.as_chunks_mut::<SUMS>();
        let (psi, psi_rest) = self.psi.as_chunks::<SUMS>();
        let [(z0, z0_rest), (z1, z1_rest), (z2, z2_rest)] = [
            self.z[0].as_chunks::<SUMS>(),
            self.z[1].as_chunks::<SUMS>(),
            self.z[2].as_chunks::<SUMS>(),
        ];
        let mut squares = [0.0; SUMS];
        let mut losses = [0.0_f64; SUMS];
        for ((((delta, z0), z1), z2), psi) in delta.iter_mut().zip(z0).zip(z1).zip(z2).zip(psi) {
            // A separate variable, because the compiler must assume that stores into `delta` could change the rest.
            let (mut change, mut relative) = ([0.0; SUMS], [0.0; SUMS]);
            for k in 0..SUMS {
                let [a, b, c] = self.dq;
                let moved = z0[k].mul_add(a, z1[k].mul_add(b, z2[k] * c));
                change[k] = -delta[k] - moved;
                relative[k] = change[k] / psi[k];
            }
            *delta = change;
            for k in 0..SUMS {
                squares[k] = relative[k].mul_add(relative[k], squares[k]);
            }
            for k in 0..SUMS {
                let loss = -relative[k];
                losses[k] = if loss > losses[k] { loss } else { losses[k] };
            }
        }
        let (mut square, mut loss) = (0.0, 0.0);
        for (k, (delta, psi)) in delta_rest.iter_mut().zip(psi_rest).enumerate() {
            let [a, b, c] = self.dq;
            let moved = z0_rest[k].mul_add(a, z1_rest[k].mul_add(b, z2_rest[k] * c));
            *delta = -*delta - moved;
            let relative = *delta / psi;
            square = relative.mul_add(relative, square);
            loss = f64::max(loss, -relative);
        }
        (squares, losses, [square, loss])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_to_the_gas_or_to_the_least() {
        for n in [1, 7, 8, 29] {
            let e: Vec<f64> = (0..n).map(|k| 0.1 + f64::from(k)).collect();
            let gas = |k: i32| if k % 3 == 0 { 1e-6 } else { 2.0 };
            let mut psi: Vec<f64> = (0..n).map(gas).collect();
            let squares = e.iter().zip(&psi).map(|(e, psi)| {
                let over = if *psi < 1.0 { 0.5 } else { 2.0 };
                (e / over).powi(2)
            });
            let expected = (squares.sum::<f64>() / f64::from(n)).sqrt();
            assert!((relative_size(&e, &psi, 0.5) / expected - 1.0).abs() < 1e-14);
            psi[0] = f64::NAN;
            assert!(relative_size(&e, &psi, 0.5).is_nan());
        }
    }

    #[test]
    fn whole_chunks_and_the_rest_follow_the_formula() {
        for n in [1, 7, 8, 29] {
            let at =
                |seed: f64| -> Vec<f64> { (0..n).map(|k| (seed + k as f64 * 0.7).sin()).collect() };
            let z = [at(0.1), at(0.2), at(0.3)];
            let psi: Vec<f64> = at(0.4).iter().map(|v| 2.0 + v).collect();
            let dq = [0.5, -0.25, 0.125];
            let start = at(0.5);
            let mut found = start.clone();
            let (square, loss) = correct_film(&mut found, &z, &psi, dq);
            let expected: Vec<f64> = (0..n)
                .map(|k| -start[k] - (z[0][k] * 0.5 - z[1][k] * 0.25 + z[2][k] * 0.125))
                .collect();
            let relative = |k: usize| expected[k] / psi[k];
            let (mut sum, mut most) = (0.0, 0.0_f64);
            for k in 0..n {
                assert!((found[k] - expected[k]).abs() < 1e-15);
                sum += relative(k) * relative(k);
                most = most.max(-relative(k));
            }
            assert!((square - sum).abs() < 1e-14 * sum && (loss - most).abs() < 1e-15);
        }
    }
}
