//! Interpolates three functions through scattered points in three dimensions.
//!
//! ```text
//! f(x) = Σ_j c_j |x − x_j|³ + a + b·x,      Σ c_j = 0,  Σ c_j x_j = 0
//! ```
//!
//! This is the smoothest interpolant in the sense of Duchon (1977, Lecture Notes in Mathematics 571, 85). It is exact
//! at the points and exact for linear functions.

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use crate::lanes::{Kernel, SUMS, total, widest};
use nalgebra::DMatrix;

/// Scaling of distances along each variable; the functions vary least with the second one.
const STRETCH: [f64; 3] = [1.0, 0.5, 1.0];

/// Three functions with the same places.
#[derive(Clone, Debug)]
pub(in crate::air_bearing) struct Interpolation {
    /// Places, stretched and padded to whole registers.
    places: [Vec<f64>; 3],
    /// c of every function, padded with zeros.
    weights: [Vec<f64>; 3],
    /// a and b of every function.
    linear: [[f64; 4]; 3],
}

impl Interpolation {
    /// Through `values` at `places`, which do not all lie in one plane.
    pub(in crate::air_bearing) fn through(places: Vec<[f64; 3]>, values: &[[f64; 3]]) -> Self {
        let n = places.len();
        let at: Vec<[f64; 3]> = places.iter().map(stretched).collect();
        let tail = |x: &[f64; 3]| [1.0, x[0], x[1], x[2]];
        let system = DMatrix::from_fn(n + 4, n + 4, |i, j| match (i < n, j < n) {
            (true, true) => {
                let square: f64 = (0..3).map(|k| (at[i][k] - at[j][k]).powi(2)).sum();
                square * square.sqrt()
            }
            (true, false) => tail(&at[i])[j - n],
            (false, true) => tail(&at[j])[i - n],
            (false, false) => 0.0,
        });
        let right = DMatrix::from_fn(n + 4, 3, |i, f| if i < n { values[i][f] } else { 0.0 });
        let solved = system.lu().solve(&right);
        let solved = solved.expect("places that are not all in one plane");
        let padded = n.next_multiple_of(SUMS);
        let column = |value: &dyn Fn(usize) -> f64| {
            let mut column: Vec<f64> = (0..n).map(value).collect();
            column.resize(padded, 0.0);
            column
        };
        Self {
            places: std::array::from_fn(|k| column(&|j| at[j][k])),
            weights: std::array::from_fn(|f| column(&|j| solved[(j, f)])),
            linear: std::array::from_fn(|f| std::array::from_fn(|k| solved[(n + k, f)])),
        }
    }

    /// The three functions at a place.
    pub(super) fn values(&self, place: [f64; 3]) -> [f64; 3] {
        let at = stretched(&place);
        let sums = widest(Values(Distances { all: self, at }));
        std::array::from_fn(|f| total(sums[f]) + self.linear_part(f, at))
    }

    /// The three functions and their derivatives: `[function][variable]`.
    pub(super) fn linearised(&self, place: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let at = stretched(&place);
        let sums = widest(Slopes(Distances { all: self, at }));
        let slopes = std::array::from_fn(|f| {
            std::array::from_fn(|k| STRETCH[k] * (total(sums[f][k]) + self.linear[f][k + 1]))
        });
        (self.values(place), slopes)
    }

    fn linear_part(&self, f: usize, at: [f64; 3]) -> f64 {
        let [a, b @ ..] = self.linear[f];
        a + (b[0] * at[0] + b[1] * at[1] + b[2] * at[2])
    }
}

fn stretched(place: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| STRETCH[k] * place[k])
}

/// A place against all others.
#[derive(Clone, Copy)]
struct Distances<'a> {
    all: &'a Interpolation,
    at: [f64; 3],
}

impl Distances<'_> {
    /// Way from the places at `first` and after, and its length.
    #[inline(always)]
    fn block(&self, first: usize) -> ([[f64; SUMS]; 3], [f64; SUMS]) {
        let mut way = [[0.0; SUMS]; 3];
        for k in 0..3 {
            let places = &self.all.places[k][first..first + SUMS];
            for j in 0..SUMS {
                way[k][j] = self.at[k] - places[j];
            }
        }
        let mut length = [0.0; SUMS];
        for j in 0..SUMS {
            let [x, y, z] = [way[0][j], way[1][j], way[2][j]];
            length[j] = x.mul_add(x, y.mul_add(y, z * z)).sqrt();
        }
        (way, length)
    }

    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.all.places[0].len()).step_by(SUMS)
    }
}

/// Σ c |x|³ of the three functions.
struct Values<'a>(Distances<'a>);

impl Kernel for Values<'_> {
    type Output = [[f64; SUMS]; 3];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut sums = [[0.0; SUMS]; 3];
        for first in self.0.blocks() {
            let (_, length) = self.0.block(first);
            for f in 0..3 {
                let weights = &self.0.all.weights[f][first..first + SUMS];
                for j in 0..SUMS {
                    let cube = length[j] * length[j] * length[j];
                    sums[f][j] = weights[j].mul_add(cube, sums[f][j]);
                }
            }
        }
        sums
    }
}

/// Σ 3 c |x| x of the three functions.
struct Slopes<'a>(Distances<'a>);

impl Kernel for Slopes<'_> {
    type Output = [[[f64; SUMS]; 3]; 3];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut sums = [[[0.0; SUMS]; 3]; 3];
        for first in self.0.blocks() {
            let (way, length) = self.0.block(first);
            for f in 0..3 {
                let weights = &self.0.all.weights[f][first..first + SUMS];
                for k in 0..3 {
                    for j in 0..SUMS {
                        let slope = 3.0 * length[j] * way[k][j];
                        sums[f][k][j] = weights[j].mul_add(slope, sums[f][k][j]);
                    }
                }
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places of a cube with a middle.
    fn places() -> Vec<[f64; 3]> {
        let ends = [-1.0, 0.1, 1.0];
        let all = ends.iter().flat_map(|&x| {
            let of_x = move |&y: &f64| ends.map(move |z| [x, y, z + 0.05 * x * y]);
            ends.into_iter().flat_map(move |y| of_x(&y))
        });
        all.collect()
    }

    #[test]
    fn values_are_kept_and_linear_functions_are_exact() {
        let places = places();
        let values: Vec<[f64; 3]> = places
            .iter()
            .map(|[x, y, z]| [1.0 + 2.0 * x - y + 0.5 * z, x * x, (x + y * z).sin()])
            .collect();
        let smooth = Interpolation::through(places.clone(), &values);
        for (place, values) in places.iter().zip(&values) {
            let found = smooth.values(*place);
            for f in 0..3 {
                assert!((found[f] - values[f]).abs() < 1e-11, "{place:?}: {found:?}");
            }
        }
        let (found, slopes) = smooth.linearised([0.3, -0.7, 0.2]);
        assert!((found[0] - (1.0 + 0.6 + 0.7 + 0.1)).abs() < 1e-11);
        for (slope, exact) in slopes[0].iter().zip([2.0, -1.0, 0.5]) {
            assert!((slope - exact).abs() < 1e-11);
        }
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        let places = places();
        let values: Vec<[f64; 3]> = places
            .iter()
            .map(|[x, y, z]| [x * y, y * z + x * x, (x - z).exp()])
            .collect();
        let smooth = Interpolation::through(places, &values);
        let at = [0.21, -0.4, 0.63];
        let (_, slopes) = smooth.linearised(at);
        for k in 0..3 {
            let moved = |by: f64| {
                let mut at = at;
                at[k] += by;
                smooth.values(at)
            };
            let (up, down) = (moved(1e-5), moved(-1e-5));
            for f in 0..3 {
                let quotient = (up[f] - down[f]) / 2e-5;
                assert!((slopes[f][k] - quotient).abs() < 1e-8, "{f} by {k}");
            }
        }
    }
}
