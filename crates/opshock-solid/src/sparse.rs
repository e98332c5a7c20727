//! Symmetric sparse matrices and small dense ones; the only module that uses the matrix library.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Side, c64};
use std::sync::Arc;

/// Sparsity pattern of the lower triangle of a symmetric matrix, column by column, diagonal included.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricPattern {
    column_start: Vec<usize>,
    rows: Vec<usize>,
}

/// A symmetric matrix by the lower triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricMatrix {
    pattern: Arc<SymmetricPattern>,
    values: Vec<f64>,
}

/// Errors of a sparse problem.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SparseError {
    /// A pivot of the Cholesky factorisation is not positive.
    #[error("matrix is not positive definite")]
    NotPositiveDefinite,
    /// A pivot of the factorisation is zero.
    #[error("matrix is singular")]
    Singular,
    /// The factors do not fit into memory.
    #[error("factors of a matrix of order {order} do not fit into memory")]
    Memory {
        /// Order of the matrix.
        order: usize,
    },
    /// More modes below the cut frequency than are kept.
    #[error("{count} modes lie below the cut; at most {most} are kept")]
    TooManyModes {
        /// Modes counted.
        count: usize,
        /// Most that are kept.
        most: usize,
    },
    /// The eigenvalue iteration did not converge.
    #[error("eigenvalue iteration of order {order} did not converge")]
    NotConverged {
        /// Order of the matrix.
        order: usize,
    },
}

/// K = L Lᵀ of a sparse matrix.
pub struct Cholesky {
    factor: Llt<usize, f64>,
    order: usize,
}

/// A − s B = L D Lᵀ, without pivoting.
pub(crate) struct Pivots {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    order: usize,
}

impl SymmetricPattern {
    /// From starts of the columns (order + 1) and rising rows of each, the diagonal first.
    ///
    /// # Panics
    /// When a column does not start with its diagonal or its rows do not rise.
    pub fn new(column_start: Vec<usize>, rows: Vec<usize>) -> Self {
        let order = column_start.len() - 1;
        for j in 0..order {
            let column = &rows[column_start[j]..column_start[j + 1]];
            assert_eq!(column.first(), Some(&j), "column {j} lacks its diagonal");
            assert!(column.is_sorted_by(|a, b| a < b), "rows of column {j}");
        }
        Self { column_start, rows }
    }

    fn order(&self) -> usize {
        self.column_start.len() - 1
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.order();
        SymbolicSparseColMatRef::new_checked(n, n, &self.column_start, None, &self.rows)
    }
}

impl SymmetricMatrix {
    /// Zeros at every place.
    pub fn zeros(pattern: Arc<SymmetricPattern>) -> Self {
        let values = vec![0.0; pattern.rows.len()];
        Self { pattern, values }
    }

    /// Order.
    pub fn order(&self) -> usize {
        self.pattern.order()
    }

    /// Stored entries.
    pub fn n_entries(&self) -> usize {
        self.values.len()
    }

    /// Adds to the entry in `row` ≥ `column`.
    ///
    /// # Panics
    /// When the pattern has no such place.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let start = self.pattern.column_start[column];
        let end = self.pattern.column_start[column + 1];
        let place = self.pattern.rows[start..end]
            .binary_search(&row)
            .expect("the pattern holds every pair of unknowns of an element");
        self.values[start + place] += value;
    }

    /// A x.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.order()];
        for j in 0..self.order() {
            let range = self.pattern.column_start[j]..self.pattern.column_start[j + 1];
            let mut entries = self.pattern.rows[range.clone()]
                .iter()
                .zip(&self.values[range]);
            let Some((_, diagonal)) = entries.next() else {
                continue;
            };
            let mut sum = diagonal * x[j];
            for (&i, value) in entries {
                y[i] += value * x[j];
                sum += value * x[i];
            }
            y[j] += sum;
        }
        y
    }

    /// A + `factor` B.
    ///
    /// # Panics
    /// When the patterns differ.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        assert!(
            Arc::ptr_eq(&self.pattern, &other.pattern) || self.pattern == other.pattern,
            "two matrices of one mesh"
        );
        let pairs = self.values.iter().zip(&other.values);
        Self {
            pattern: Arc::clone(&self.pattern),
            values: pairs.map(|(a, b)| a + factor * b).collect(),
        }
    }

    /// `factor` A.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|v| *v *= factor);
        self
    }

    /// Largest magnitude of an entry.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |most, v| v.abs().max(most))
    }

    /// Factorises a positive definite matrix.
    ///
    /// # Errors
    /// A matrix that is not, or too little memory.
    pub fn cholesky(&self) -> Result<Cholesky, SparseError> {
        use faer::sparse::linalg::LltError;
        let order = self.order();
        match self.view().sp_cholesky(Side::Lower) {
            Ok(factor) => Ok(Cholesky { factor, order }),
            Err(LltError::Numeric(_)) => Err(SparseError::NotPositiveDefinite),
            Err(LltError::Generic(_)) => Err(SparseError::Memory { order }),
        }
    }

    /// L D Lᵀ of a matrix that need not be definite.
    pub(crate) fn pivots(&self) -> Result<Pivots, SparseError> {
        use dyn_memory::{MemBuffer, MemStack};
        let order = self.order();
        let memory = SparseError::Memory { order };
        let symbolic = factorize_symbolic_cholesky(
            self.pattern.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| memory)?;
        let mut values = Vec::new();
        let length = symbolic.len_val();
        values.try_reserve_exact(length).map_err(|_| memory)?;
        values.resize(length, 0.0);
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        let mut buffer = MemBuffer::try_new(scratch).map_err(|_| memory)?;
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                self.view(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|_| SparseError::Singular)?;
        Ok(Pivots {
            symbolic,
            values,
            order,
        })
    }

    fn view(&self) -> SparseColMatRef<'_, usize, f64> {
        SparseColMatRef::new(self.pattern.symbolic(), &self.values)
    }
}

impl Cholesky {
    /// A⁻¹ applied to each column.
    pub fn solve(&self, columns: &mut [Vec<f64>]) {
        let mut sides = Mat::from_fn(self.order, columns.len(), |i, j| columns[j][i]);
        self.factor.solve_in_place(sides.as_mut());
        for (j, column) in columns.iter_mut().enumerate() {
            for (i, x) in column.iter_mut().enumerate() {
                *x = sides[(i, j)];
            }
        }
    }
}

impl Pivots {
    /// Negative entries of D: as many as the matrix has negative eigenvalues.
    pub fn n_negative(&self) -> usize {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                let starts = &symbolic.col_ptr()[..self.order];
                starts.iter().filter(|&&k| self.values[k] < 0.0).count()
            }
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let mut negative = 0;
                for s in 0..symbolic.n_supernodes() {
                    let width = symbolic.supernode_end()[s] - symbolic.supernode_begin()[s];
                    let start = symbolic.col_ptr_for_val()[s];
                    let length = symbolic.col_ptr_for_val()[s + 1] - start;
                    // The diagonal of a dense block stored column by column.
                    let height = length / width.max(1);
                    let diagonal = (0..width).map(|k| self.values[start + k * (height + 1)]);
                    negative += diagonal.filter(|d| *d < 0.0).count();
                }
                negative
            }
        }
    }

    /// A⁻¹ applied to a column.
    pub fn solve(&self, column: &mut [f64]) {
        use dyn_memory::{MemBuffer, MemStack};
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let factor = faer::sparse::linalg::cholesky::LdltRef::new(&self.symbolic, &self.values);
        let side = MatMut::from_column_major_slice_mut(column, self.order, 1);
        factor.solve_in_place_with_conj(
            Conj::No,
            side,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }
}

use faer::dyn_stack as dyn_memory;

/// Small dense symmetric matrix, row by row.
pub type Dense = Vec<Vec<f64>>;

/// Eigenvalues of a small symmetric matrix in rising order, and unit vectors.
///
/// # Errors
/// No convergence.
pub(crate) fn dense_eigen(matrix: &Dense) -> Result<(Vec<f64>, Vec<Vec<f64>>), SparseError> {
    let order = matrix.len();
    let full = Mat::from_fn(order, order, |i, j| matrix[i.max(j)][i.min(j)]);
    let pairs = full
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| SparseError::NotConverged { order })?;
    let values = (0..order).map(|k| pairs.S()[k]).collect();
    let vector = |k: usize| (0..order).map(|i| pairs.U()[(i, k)]).collect();
    Ok((values, (0..order).map(vector).collect()))
}

/// Pairs of K x = λ M x of small dense matrices, M positive definite; xᵀ M x = 1.
///
/// # Errors
/// M not positive definite, or no convergence.
pub(crate) fn dense_general_eigen(
    stiffness: &Dense,
    mass: &Dense,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), SparseError> {
    let n = mass.len();
    // M = L Lᵀ.
    let mut l = mass.clone();
    for j in 0..n {
        for k in 0..j {
            let share = l[j][k];
            l[j..].iter_mut().for_each(|row| row[j] -= share * row[k]);
        }
        if l[j][j].is_nan() || l[j][j] <= 0.0 {
            return Err(SparseError::NotPositiveDefinite);
        }
        let scale = l[j][j].sqrt().recip();
        for row in &mut l[j..] {
            row[j] *= scale;
        }
    }
    // L⁻¹ K L⁻ᵀ: solve with the columns, then with the rows.
    let forward = |x: &mut [f64]| {
        for i in 0..n {
            let sum: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
            x[i] = (x[i] - sum) / l[i][i];
        }
    };
    let mut reduced = stiffness.clone();
    reduced.iter_mut().for_each(|row| forward(row));
    let mut turned: Dense = (0..n)
        .map(|j| (0..n).map(|i| reduced[i][j]).collect())
        .collect();
    turned.iter_mut().for_each(|row| forward(row));
    let (values, mut vectors) = dense_eigen(&turned)?;
    for x in &mut vectors {
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
            x[i] = (x[i] - sum) / l[i][i];
        }
    }
    Ok((values, vectors))
}

/// (K (1 + i η) − ω² M)⁻¹ b as real and imaginary parts.
///
/// # Errors
/// A singular matrix or too little memory.
pub fn damped_response(
    stiffness: &SymmetricMatrix,
    mass: &SymmetricMatrix,
    omega_rad_per_s: f64,
    loss_factor: f64,
    load: &[f64],
) -> Result<Vec<[f64; 2]>, SparseError> {
    let order = load.len();
    let memory = SparseError::Memory { order };
    let mut entries = Vec::with_capacity(2 * stiffness.values.len());
    let square = omega_rad_per_s * omega_rad_per_s;
    let pattern = &stiffness.pattern;
    for j in 0..order {
        for place in pattern.column_start[j]..pattern.column_start[j + 1] {
            let i = pattern.rows[place];
            let k = stiffness.values[place];
            let value = c64::new(k - square * mass.values[place], loss_factor * k);
            entries.push(faer::sparse::Triplet::new(i, j, value));
            if i != j {
                entries.push(faer::sparse::Triplet::new(j, i, value));
            }
        }
    }
    let matrix = SparseColMat::try_new_from_triplets(order, order, &entries).map_err(|_| memory)?;
    let factor = matrix.sp_lu().map_err(|_| SparseError::Singular)?;
    let mut side = Mat::from_fn(order, 1, |i, _| c64::new(load[i], 0.0));
    factor.solve_in_place(side.as_mut());
    Ok((0..order)
        .map(|i| [side[(i, 0)].re, side[(i, 0)].im])
        .collect())
}

/// Σ a b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
