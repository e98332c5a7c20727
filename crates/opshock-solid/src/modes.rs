//! Finds all natural modes of a supported solid below a frequency.
//!
//! ```text
//! K x = ω² M x,    optionally with Wᵀ x = 0 (points fixed by forces on the columns of W)
//! ```
//!
//! * **Count.** K − s M = L D Lᵀ has as many negative pivots as there are ω² below s (Sylvester's
//!   law of inertia). With m columns W fixed, the bordered matrix gives the count
//!   n₋(A) + n₋(−Wᵀ A⁻¹ W) − m.
//! * **Pairs.** Block Lanczos steps with P K⁻¹ M find the largest 1/ω² first, where
//!   P = 1 − Ψ Wᵀ with Ψ = K⁻¹ W (Wᵀ K⁻¹ W)⁻¹ removes the motion of the fixed points. Every new
//!   vector is orthogonalised against all before it, twice. Steps end when the residual of each pair
//!   below the limit is small and their number equals the count, so that none is missed.
//!
//! Source: Parlett, *The Symmetric Eigenvalue Problem* (1998), chapters 3 and 13; Wittrick and
//! Williams (1971), Q. J. Mech. Appl. Math. 24, 263, for the count with constraints.

use crate::assembly::SolidSystem;
use crate::sparse::{Cholesky, SparseError, dense_eigen, dot};

/// Vectors added at once: pairs of equal frequency need as many.
const BLOCK: usize = 4;
/// Residual |K⁻¹Mx − θx| relative to θ at which a pair is accepted; its eigenvalue's error is the square.
const RESIDUAL: f64 = 1e-9;
/// A new vector that shrinks to this share was already in the basis.
const ROUNDING: f64 = 1e-13;
/// Most steps per wanted pair, and besides.
const MOST_STEPS: [usize; 2] = [4, 120];

/// The basis grows by this part of it between two computations of its pairs.
const LOOK_SHARE: usize = 20;

/// Natural modes, lowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidModes {
    /// ω², 1/s².
    pub omega_squared: Vec<f64>,
    /// Shapes over the unknowns, xᵀ M x = 1, 1/√kg.
    pub shapes: Vec<Vec<f64>>,
}

/// Static responses of a system: its factors, and its displacements under forces at the points.
pub struct StaticSolver {
    factor: Cholesky,
    /// Columns W.
    columns: Vec<Vec<f64>>,
    /// Ψ: displacement of 1 at one point and 0 at the others.
    pulled: Vec<Vec<f64>>,
    /// (Wᵀ K⁻¹ W)⁻¹, N/m.
    stiffness: Vec<Vec<f64>>,
    /// Added to K as a multiple of M, 1/s².
    shift: f64,
}

impl StaticSolver {
    /// Factorises K + `shift` M and solves for each column of `columns`.
    ///
    /// # Errors
    /// K + shift M not positive definite: the solid is not supported.
    pub fn new(
        system: &SolidSystem,
        columns: Vec<Vec<f64>>,
        shift: f64,
    ) -> Result<Self, SparseError> {
        let factor = match shift {
            0.0 => system.stiffness.cholesky()?,
            _ => system.stiffness.plus(shift, &system.mass).cholesky()?,
        };
        let mut pulled = columns.clone();
        factor.solve(&mut pulled);
        let compliance: Vec<Vec<f64>> = columns
            .iter()
            .map(|w| pulled.iter().map(|x| dot(w, x)).collect())
            .collect();
        let stiffness = inverse(&compliance).ok_or(SparseError::Singular)?;
        let constraint = stiffness
            .iter()
            .map(|row| combination(&pulled, row))
            .collect();
        Ok(Self {
            factor,
            columns,
            pulled: constraint,
            stiffness,
            shift,
        })
    }

    /// Displacement of 1 at one point and 0 at the others, per point.
    pub fn constraint_modes(&self) -> &[Vec<f64>] {
        &self.pulled
    }

    /// Static stiffness between the points, N/m.
    pub fn point_stiffness(&self) -> &[Vec<f64>] {
        &self.stiffness
    }

    /// P K⁻¹ of each load: static displacement with the points fixed.
    pub(crate) fn answer(&self, loads: &mut [Vec<f64>]) {
        self.factor.solve(loads);
        for x in loads {
            let moved: Vec<f64> = self.columns.iter().map(|w| dot(w, x)).collect();
            for (psi, share) in self.pulled.iter().zip(moved) {
                add(x, -share, psi);
            }
        }
    }

    /// Modes with ω² below `limit` with the points fixed.
    ///
    /// # Errors
    /// A limit that is an eigenvalue, or no convergence.
    pub fn modes_below(&self, system: &SolidSystem, limit: f64) -> Result<SolidModes, SparseError> {
        let count = self.count_below(system, limit)?;
        self.counted(system, count, limit)
    }

    /// The `count` modes that [`StaticSolver::count_below`] found below `limit`.
    ///
    /// # Errors
    /// No convergence.
    pub fn counted(
        &self,
        system: &SolidSystem,
        count: usize,
        limit: f64,
    ) -> Result<SolidModes, SparseError> {
        self.find(system, count, |value| value < limit)
    }

    /// The lowest `wanted` modes with the points fixed.
    ///
    /// # Errors
    /// No convergence.
    pub fn lowest(&self, system: &SolidSystem, wanted: usize) -> Result<SolidModes, SparseError> {
        let mut modes = self.find(system, wanted, |_| true)?;
        if let Some(last) = modes.omega_squared.last() {
            // None is missed: the count below the last one found equals their number.
            let limit = (last + self.shift) * (1.0 + 1e-6) - self.shift;
            modes = self.modes_below(system, limit)?;
            modes.omega_squared.truncate(wanted);
            modes.shapes.truncate(wanted);
        }
        Ok(modes)
    }

    /// Number of ω² below `limit` with the points fixed.
    ///
    /// # Errors
    /// A limit that is an eigenvalue.
    pub fn count_below(&self, system: &SolidSystem, limit: f64) -> Result<usize, SparseError> {
        let pivots = system.stiffness.plus(-limit, &system.mass).pivots()?;
        let m = self.columns.len();
        let mut answers = self.columns.clone();
        answers.iter_mut().for_each(|x| pivots.solve(x));
        let border: Vec<Vec<f64>> = self
            .columns
            .iter()
            .map(|w| answers.iter().map(|x| -dot(w, x)).collect())
            .collect();
        let negative = match m {
            0 => 0,
            _ => dense_eigen(&border)?.0.iter().filter(|v| **v < 0.0).count(),
        };
        Ok((pivots.n_negative() + negative).saturating_sub(m))
    }

    /// The `count` lowest pairs that are `kept`.
    fn find(
        &self,
        system: &SolidSystem,
        count: usize,
        kept: impl Fn(f64) -> bool,
    ) -> Result<SolidModes, SparseError> {
        let n = system.order();
        let free = n - self.columns.len();
        let count = count.min(free);
        if count == 0 {
            return Ok(SolidModes::default());
        }
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut images: Vec<Vec<f64>> = Vec::new();
        let mut masses: Vec<Vec<f64>> = Vec::new();
        let mut projected: Vec<Vec<f64>> = Vec::new();
        let mut block = self.first_block(system);
        let most = (MOST_STEPS[0] * count + MOST_STEPS[1]).min(free);
        let mut next_look = count;
        loop {
            let before = basis.len();
            for vector in block {
                append(system, vector, &mut basis, &mut masses, ROUNDING);
            }
            if basis.len() == before && before < free.min(most) {
                // The Krylov space is exhausted: it contains every mode that the start can reach.
                return Err(SparseError::NotConverged { order: n });
            }
            let mut next: Vec<Vec<f64>> = masses[before..].to_vec();
            self.answer(&mut next);
            for image in &next {
                // Symmetric in exact arithmetic: the lower triangle is enough.
                projected.push(masses.iter().map(|m| dot(m, image)).collect());
            }
            images.extend(next.iter().cloned());
            let size = basis.len();
            if size >= next_look.min(most) {
                // Computing the pairs costs size³, so with a large basis not after every block.
                next_look = size + size / LOOK_SHARE;
                let (values, vectors) = dense_eigen(&projected)?;
                let largest = (0..count).map(|k| size - 1 - k);
                let found = self.pairs(system, &basis, &images, &values, &vectors, largest);
                let below = |value: &f64| kept(*value);
                if let Some(modes) = found
                    && modes.omega_squared.iter().all(below)
                {
                    return Ok(modes);
                }
            }
            if size >= most {
                return Err(SparseError::NotConverged { order: n });
            }
            block = next;
        }
    }

    /// Ritz pairs, or `None` while a residual is large.
    fn pairs(
        &self,
        system: &SolidSystem,
        basis: &[Vec<f64>],
        images: &[Vec<f64>],
        values: &[f64],
        vectors: &[Vec<f64>],
        wanted: impl DoubleEndedIterator<Item = usize>,
    ) -> Option<SolidModes> {
        let mut modes = SolidModes::default();
        // The last wanted pair converges last.
        let order: Vec<usize> = wanted.collect();
        for &k in order.iter().rev() {
            let theta = values[k];
            if theta <= 0.0 {
                return None;
            }
            let mut residual = combination(images, &vectors[k]);
            let mut shape = combination(basis, &vectors[k]);
            add(&mut residual, -theta, &shape);
            let size = dot(&residual, &system.mass.times(&residual))
                .max(0.0)
                .sqrt();
            if size > RESIDUAL * theta {
                return None;
            }
            let mass = system.mass.times(&shape);
            let scale = dot(&shape, &mass).sqrt().recip() * orientation(&shape);
            shape.iter_mut().for_each(|x| *x *= scale);
            modes.omega_squared.push(theta.recip() - self.shift);
            modes.shapes.push(shape);
        }
        modes.omega_squared.reverse();
        modes.shapes.reverse();
        Some(modes)
    }

    /// Responses to base motion in three directions, and to loads without any symmetry.
    fn first_block(&self, system: &SolidSystem) -> Vec<Vec<f64>> {
        let n = system.order();
        let mut block: Vec<Vec<f64>> = system.base_load_kg.to_vec();
        while block.len() < BLOCK.max(4) {
            let seed = block.len() as f64;
            // Weyl's sequence: the same on every machine, orthogonal to no mode.
            let scattered = |i: usize| ((i + 1) as f64 * 0.618_033_988_749_894_9 * seed).fract();
            let load: Vec<f64> = (0..n).map(|i| scattered(i) - 0.5).collect();
            block.push(system.mass.times(&load));
        }
        self.answer(&mut block);
        // Base motion alone may excite nothing that the irregular loads do not.
        block.reverse();
        block
    }
}

/// Appends the part of a vector that the basis does not hold, of unit mass, unless it is at most the
/// `negligible` share.
pub(crate) fn append(
    system: &SolidSystem,
    mut vector: Vec<f64>,
    basis: &mut Vec<Vec<f64>>,
    masses: &mut Vec<Vec<f64>>,
    negligible: f64,
) {
    let norm = |x: &[f64], mx: &[f64]| dot(x, mx).max(0.0).sqrt();
    let before = norm(&vector, &system.mass.times(&vector));
    for _ in 0..2 {
        for (q, mq) in basis.iter().zip(masses.iter()) {
            let share = dot(mq, &vector);
            add(&mut vector, -share, q);
        }
    }
    let mass = system.mass.times(&vector);
    let after = norm(&vector, &mass);
    if after.is_nan() || after <= negligible * before {
        return;
    }
    basis.push(vector.iter().map(|x| x / after).collect());
    masses.push(mass.iter().map(|x| x / after).collect());
}

/// Σ share × column.
pub(crate) fn combination(columns: &[Vec<f64>], shares: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (column, &share) in columns.iter().zip(shares) {
        add(&mut sum, share, column);
    }
    sum
}

fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    for (xi, yi) in x.iter_mut().zip(y) {
        *xi += factor * yi;
    }
}

/// Sign that makes the largest entry positive.
fn orientation(shape: &[f64]) -> f64 {
    let largest = shape.iter().fold(
        0.0_f64,
        |most, &x| {
            if x.abs() > most.abs() { x } else { most }
        },
    );
    if largest < 0.0 { -1.0 } else { 1.0 }
}

/// Inverse of a small symmetric positive definite matrix; `None` when it is not.
fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    // Rows [A, 1] become [1, A⁻¹].
    let mut rows: Vec<Vec<f64>> = matrix.to_vec();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend((0..n).map(|j| f64::from(u8::from(i == j))));
    }
    for k in 0..n {
        let pivot = rows[k][k];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        rows[k].iter_mut().for_each(|x| *x /= pivot);
        let pivot_row = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let share = row[k];
            add(row, -share, &pivot_row);
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}
