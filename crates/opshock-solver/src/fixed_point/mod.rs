//! Fixed-point iteration between two solvers that exchange a short vector.
//!
//! ```text
//! x = H(x),   residual r = H(x) − x
//! plain      x ← x + r
//! Aitken     x ← x + ω r,   ω ← −ω ⟨r₋, r − r₋⟩ / |r − r₋|²            (Irons and Tuck 1969)
//! Anderson   x ← x + r − (ΔX + ΔR) α,   α = argmin |r − ΔR α|          (Anderson 1965)
//! ```
//!
//! Anderson's iteration with all columns kept is the interface quasi-Newton method of partitioned
//! fluid-structure codes (Degroote et al. 2009): exact after n + 1 steps for a linear map on n
//! components.
//!
//! Components have units of their own, so each is judged and scaled by its own tolerance. Convergence is judged by the
//! residual, never by the relaxed change, which a shrinking relaxation factor could make small. Equal successive
//! residuals give no secant and leave the relaxation factor unchanged.

use crate::linalg::dense::dot;

/// How the next iterate is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// x ← H(x).
    Plain,
    /// One relaxation factor from the last two residuals.
    Aitken,
    /// Least squares over up to `depth` differences.
    Anderson {
        /// Columns kept.
        depth: usize,
    },
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// Every component of the residual is within its tolerance.
    Converged {
        /// Evaluations of the map.
        iterations: usize,
        /// Largest residual over tolerance.
        residual: f64,
    },
    /// The cap was reached, or the residual grew a millionfold.
    NotConverged {
        /// Evaluations of the map.
        iterations: usize,
        /// Largest residual over tolerance.
        residual: f64,
    },
    /// The map failed or gave a number that is not finite.
    Broken {
        /// Evaluations of the map.
        iterations: usize,
    },
}

/// Storage of one iteration over vectors of one length.
#[derive(Clone, Debug)]
pub struct FixedPoint {
    method: Method,
    image: Vec<f64>,
    residual: Vec<f64>,
    last_image: Vec<f64>,
    last_residual: Vec<f64>,
    /// Differences of residuals and of images, newest first, scaled by the tolerances.
    residual_columns: Vec<Vec<f64>>,
    image_columns: Vec<Vec<f64>>,
    basis: Vec<Vec<f64>>,
    weights: Vec<f64>,
    triangle: Vec<f64>,
    relaxation: f64,
}

impl FixedPoint {
    /// Storage for vectors of `n` components. Anderson's depth is capped at `n`, beyond which
    /// columns are dependent.
    pub fn new(method: Method, n: usize) -> Self {
        let depth = match method {
            Method::Anderson { depth } => depth.min(n),
            _ => 0,
        };
        let columns = || vec![vec![0.0; n]; depth];
        Self {
            method,
            image: vec![0.0; n],
            residual: vec![0.0; n],
            last_image: vec![0.0; n],
            last_residual: vec![0.0; n],
            residual_columns: columns(),
            image_columns: columns(),
            basis: columns(),
            weights: vec![0.0; depth],
            triangle: vec![0.0; depth * depth],
            relaxation: 1.0,
        }
    }

    /// Iterates `x` until every component of H(x) − x is within `tolerance`. On success `x` is the last argument at
    /// which the map was evaluated, so that the map's own state belongs to it. `map(x, image)` returns whether it could
    /// evaluate.
    ///
    /// # Panics
    /// When lengths differ from those of the storage.
    pub fn solve(
        &mut self,
        x: &mut [f64],
        tolerance: &[f64],
        max_iterations: usize,
        mut map: impl FnMut(&[f64], &mut [f64]) -> bool,
    ) -> Ending {
        assert_eq!(x.len(), self.image.len());
        assert_eq!(tolerance.len(), x.len());
        self.relaxation = 1.0;
        let mut first = f64::INFINITY;
        let mut columns = 0;
        let mut size = f64::INFINITY;
        for iterations in 1..=max_iterations {
            if !map(x, &mut self.image) || self.image.iter().any(|v| !v.is_finite()) {
                return Ending::Broken { iterations };
            }
            size = 0.0;
            for i in 0..x.len() {
                self.residual[i] = (self.image[i] - x[i]) / tolerance[i];
                size = f64::max(size, self.residual[i].abs());
            }
            if size <= 1.0 {
                return Ending::Converged {
                    iterations,
                    residual: size,
                };
            }
            if iterations == 1 {
                first = size;
            } else if size > 1e6 * first {
                return Ending::NotConverged {
                    iterations,
                    residual: size,
                };
            }
            match self.method {
                Method::Plain => x.copy_from_slice(&self.image),
                Method::Aitken => self.aitken(iterations > 1, x, tolerance),
                Method::Anderson { .. } => {
                    columns = self.anderson(iterations > 1, columns, x, tolerance)
                }
            }
            self.last_residual.copy_from_slice(&self.residual);
            self.last_image.copy_from_slice(&self.image);
        }
        Ending::NotConverged {
            iterations: max_iterations,
            residual: size,
        }
    }

    fn aitken(&mut self, has_last: bool, x: &mut [f64], tolerance: &[f64]) {
        if has_last {
            let (mut product, mut square) = (0.0, 0.0);
            for (r, last) in self.residual.iter().zip(&self.last_residual) {
                product += last * (r - last);
                square += (r - last) * (r - last);
            }
            let next = -self.relaxation * product / square;
            // Equal residuals give no slope; a factor of zero would stall the iteration.
            if square > 0.0 && next.is_finite() && next != 0.0 {
                self.relaxation = next;
            }
        }
        for i in 0..x.len() {
            x[i] += self.relaxation * self.residual[i] * tolerance[i];
        }
    }

    /// One step of Anderson's iteration; returns the number of columns now held.
    fn anderson(&mut self, has_last: bool, held: usize, x: &mut [f64], tolerance: &[f64]) -> usize {
        let depth = self.residual_columns.len();
        let mut held = held;
        if has_last && depth > 0 {
            self.residual_columns.rotate_right(1);
            self.image_columns.rotate_right(1);
            let now = self.residual.iter().zip(&self.last_residual);
            for (column, (now, last)) in self.residual_columns[0].iter_mut().zip(now) {
                *column = now - last;
            }
            let now = self.image.iter().zip(&self.last_image).zip(tolerance);
            for (column, ((now, last), scale)) in self.image_columns[0].iter_mut().zip(now) {
                *column = (now - last) / scale;
            }
            held = (held + 1).min(depth);
        }
        // Modified Gram-Schmidt, newest column first; a column that adds no direction is skipped.
        let mut rank = 0;
        let mut source = [0usize; 16];
        for c in 0..held.min(source.len()) {
            let full = norm(&self.residual_columns[c]);
            let (done, rest) = self.basis.split_at_mut(rank);
            let vector = &mut rest[0];
            vector.copy_from_slice(&self.residual_columns[c]);
            for (row, q) in done.iter().enumerate() {
                let projection = dot(q, vector);
                self.triangle[row * depth + rank] = projection;
                for (v, q) in vector.iter_mut().zip(q) {
                    *v -= projection * q;
                }
            }
            let left = norm(vector);
            if left > 1e-8 * full && left > 0.0 {
                vector.iter_mut().for_each(|v| *v /= left);
                self.triangle[rank * depth + rank] = left;
                source[rank] = c;
                rank += 1;
            }
        }
        for row in (0..rank).rev() {
            let mut sum = dot(&self.basis[row], &self.residual);
            for k in row + 1..rank {
                sum -= self.triangle[row * depth + k] * self.weights[k];
            }
            self.weights[row] = sum / self.triangle[row * depth + row];
        }
        x.copy_from_slice(&self.image);
        for (weight, &c) in self.weights[..rank].iter().zip(&source) {
            for ((x, scale), column) in x.iter_mut().zip(tolerance).zip(&self.image_columns[c]) {
                *x -= weight * column * scale;
            }
        }
        held
    }
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests;
