//! Factorisation of large sparse symmetric matrices within their envelope.
//!
//! ```text
//! P A Pᵀ = L D Lᵀ
//! ```
//!
//! The signs of D are those of the eigenvalues of A (Sylvester). There is no pivoting: the order P is reverse
//! Cuthill-McKee, which keeps the envelope small.

use super::sparse::Matrix;
use std::collections::VecDeque;

/// Numbers of the largest envelope, 0.8 GB.
pub const MAX_ENVELOPE: usize = 100_000_000;

/// Order of rows and extent of each within the envelope of matrices of one pattern.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Row of the matrix at each place.
    order: Vec<usize>,
    /// Place of each row.
    place: Vec<usize>,
    /// First column of each place's row.
    first: Vec<usize>,
    /// Where each place's row begins.
    start: Vec<usize>,
}

/// L and D of a matrix.
#[derive(Clone, Debug)]
pub struct Factors<'a> {
    envelope: &'a Envelope,
    lower: Vec<f64>,
    pivots: Vec<f64>,
}

impl Envelope {
    /// Envelope of the union of patterns, all symmetric and of one size; `None` when it has more than [`MAX_ENVELOPE`]
    /// numbers.
    pub fn of(matrices: &[&Matrix]) -> Option<Self> {
        let n = matrices.first().map_or(0, |matrix| matrix.n_rows);
        let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (row, neighbours) in neighbours.iter_mut().enumerate() {
            for matrix in matrices {
                let of_row = matrix.row(row).filter(|(_, value)| *value != 0.0);
                neighbours.extend(of_row.map(|(column, _)| column).filter(|c| *c != row));
            }
            neighbours.sort_unstable();
            neighbours.dedup();
        }
        let order = reversed_cuthill_mckee(&neighbours);
        let mut place = vec![0; n];
        for (at, &row) in order.iter().enumerate() {
            place[row] = at;
        }
        let (mut first, mut start) = (Vec::with_capacity(n), Vec::with_capacity(n));
        let mut size = 0_usize;
        for (at, &row) in order.iter().enumerate() {
            let lowest = neighbours[row].iter().map(|&other| place[other]).min();
            let lowest = lowest.unwrap_or(at).min(at);
            first.push(lowest);
            start.push(size);
            size += at - lowest;
            if size > MAX_ENVELOPE {
                return None;
            }
        }
        Some(Self {
            order,
            place,
            first,
            start,
        })
    }

    /// Factors of K + shift M.
    pub fn factor(&self, k: &Matrix, shift: f64, m: Option<&Matrix>) -> Factors<'_> {
        let n = self.order.len();
        let size = n
            .checked_sub(1)
            .map_or(0, |last| self.start[last] + last - self.first[last]);
        let (mut lower, mut pivots) = (vec![0.0; size], vec![0.0; n]);
        let mut add = |matrix: &Matrix, factor: f64| {
            for (at, &row) in self.order.iter().enumerate() {
                for (column, value) in matrix.row(row) {
                    let column = self.place[column];
                    if column == at {
                        pivots[at] += factor * value;
                    } else if column < at && value != 0.0 {
                        lower[self.start[at] + column - self.first[at]] += factor * value;
                    }
                }
            }
        };
        add(k, 1.0);
        if let Some(m) = m {
            add(m, shift);
        }
        for i in 0..n {
            let (first, start) = (self.first[i], self.start[i]);
            let (before, rest) = lower.split_at_mut(start);
            let row = &mut rest[..i - first];
            for j in first..i {
                let common = first.max(self.first[j]);
                let other = &before[self.start[j] + common - self.first[j]..][..j - common];
                let own = &row[common - first..j - first];
                let sum: f64 = own.iter().zip(other).map(|(a, b)| a * b).sum();
                row[j - first] -= sum;
            }
            let mut pivot = pivots[i];
            for (value, d) in row.iter_mut().zip(&pivots[first..i]) {
                let scaled = *value / d;
                pivot -= scaled * *value;
                *value = scaled;
            }
            pivots[i] = pivot;
        }
        Factors {
            envelope: self,
            lower,
            pivots,
        }
    }
}

impl Factors<'_> {
    /// Number of negative eigenvalues; `None` when a pivot is zero or NaN.
    pub fn n_negative(&self) -> Option<usize> {
        let sound = self.pivots.iter().all(|d| d.is_finite() && *d != 0.0);
        sound.then(|| self.pivots.iter().filter(|d| **d < 0.0).count())
    }

    /// First row whose pivot is not above `least` of that row, with the pivot.
    pub fn first_not_above(&self, least: impl Fn(usize) -> f64) -> Option<(usize, f64)> {
        let pairs = self.envelope.order.iter().zip(&self.pivots);
        let mut pairs = pairs.map(|(&row, &pivot)| (row, pivot));
        pairs.find(|&(row, pivot)| pivot.is_nan() || pivot <= least(row))
    }

    /// x with A x = b, in place.
    pub fn solve(&self, x: &mut [f64]) {
        let e = self.envelope;
        let n = e.order.len();
        let mut y: Vec<f64> = e.order.iter().map(|&row| x[row]).collect();
        let row = |i: usize| &self.lower[e.start[i]..][..i - e.first[i]];
        for i in 0..n {
            let sum: f64 = row(i)
                .iter()
                .zip(&y[e.first[i]..i])
                .map(|(l, y)| l * y)
                .sum();
            y[i] -= sum;
        }
        y.iter_mut().zip(&self.pivots).for_each(|(y, d)| *y /= d);
        for i in (0..n).rev() {
            let value = y[i];
            let above = y[e.first[i]..i].iter_mut().zip(row(i));
            above.for_each(|(y, l)| *y -= l * value);
        }
        for (at, &row) in e.order.iter().enumerate() {
            x[row] = y[at];
        }
    }
}

/// Breadth first from a row of few neighbours, neighbours by their number of neighbours; reversed.
fn reversed_cuthill_mckee(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let n = neighbours.len();
    let mut by_degree: Vec<usize> = (0..n).collect();
    by_degree.sort_by_key(|&row| neighbours[row].len());
    let (mut order, mut seen) = (Vec::with_capacity(n), vec![false; n]);
    for start in by_degree {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut waiting = VecDeque::from([start]);
        while let Some(row) = waiting.pop_front() {
            order.push(row);
            let mut next: Vec<usize> = neighbours[row]
                .iter()
                .copied()
                .filter(|&r| !seen[r])
                .collect();
            next.sort_by_key(|&row| neighbours[row].len());
            for row in next {
                seen[row] = true;
                waiting.push_back(row);
            }
        }
    }
    order.reverse();
    order
}
