//! KLU, the sparse LU factorisation of SuiteSparse, as a yardstick for benchmarks.
//!
//! The library is loaded when asked for, so that machines without it build and test all the rest; on
//! Debian it is in `libsuitesparse-dev`. Indices are C `int`s (the library's plain `klu_` functions).
//!
//! Source: T. A. Davis and E. Palamadai Natarajan, *Algorithm 907: KLU*, ACM Trans. Math. Softw. 37
//! (2010), 36; functions and their arguments as in its `klu.h`.

use libloading::Library;
use std::ffi::c_int;
use std::marker::PhantomData;
use std::ptr::NonNull;

/// Names under which systems install it.
const NAMES: [&str; 3] = ["libklu.so.2", "libklu.so.1", "libklu.so"];

/// Bytes kept for `klu_common`, whose 160 or so belong to the library; releases differ by fields at
/// its end.
const COMMON_BYTES: usize = 1024;

/// `klu_common`, filled by `klu_defaults` and never looked into here.
#[repr(C, align(16))]
struct Common([u8; COMMON_BYTES]);

/// `klu_symbolic` and `klu_numeric`, known by address only.
#[repr(C)]
struct Opaque(u8);

type Defaults = unsafe extern "C" fn(*mut Common) -> c_int;
type Analyze = unsafe extern "C" fn(c_int, *const c_int, *const c_int, *mut Common) -> *mut Opaque;
type Factor = unsafe extern "C" fn(
    *const c_int,
    *const c_int,
    *const f64,
    *mut Opaque,
    *mut Common,
) -> *mut Opaque;
type Refactor = unsafe extern "C" fn(
    *const c_int,
    *const c_int,
    *const f64,
    *mut Opaque,
    *mut Opaque,
    *mut Common,
) -> c_int;
type Solve =
    unsafe extern "C" fn(*mut Opaque, *mut Opaque, c_int, c_int, *mut f64, *mut Common) -> c_int;
type Free = unsafe extern "C" fn(*mut *mut Opaque, *mut Common) -> c_int;

/// The library's functions.
pub struct Klu {
    analyze: Analyze,
    factor: Factor,
    refactor: Refactor,
    solve: Solve,
    free_symbolic: Free,
    free_numeric: Free,
    defaults: Defaults,
    /// Keeps the functions where they are.
    _library: Library,
}

/// A square sparse matrix by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    starts: Vec<c_int>,
    rows: Vec<c_int>,
    values: Vec<f64>,
}

impl Columns {
    /// From starts of the columns (order + 1), rising rows of each, and values.
    ///
    /// # Panics
    /// When the three do not describe a square matrix with indices that fit a C `int`.
    pub fn new(starts: &[usize], rows: &[usize], values: &[f64]) -> Self {
        let order = starts.len() - 1;
        assert!(starts[0] == 0 && starts.is_sorted() && starts[order] == rows.len());
        assert!(rows.len() == values.len() && rows.iter().all(|row| *row < order));
        let int = |k: &usize| c_int::try_from(*k).expect("an index of C's int");
        Self {
            starts: starts.iter().map(int).collect(),
            rows: rows.iter().map(int).collect(),
            values: values.to_vec(),
        }
    }

    fn order(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Factors of one matrix.
pub struct Factors<'a> {
    klu: &'a Klu,
    matrix: &'a Columns,
    common: Box<Common>,
    symbolic: NonNull<Opaque>,
    numeric: NonNull<Opaque>,
    /// The library keeps state behind the pointers: one thread at a time.
    _not_shared: PhantomData<*mut ()>,
}

impl Klu {
    /// The library, where it is installed.
    pub fn load() -> Option<Self> {
        // SAFETY: loading runs the initialisers of a numerical library, which has none of note; the
        // signatures are those of klu.h.
        unsafe {
            let library = NAMES.iter().find_map(|name| Library::new(name).ok())?;
            Some(Self {
                defaults: *library.get::<Defaults>(b"klu_defaults\0").ok()?,
                analyze: *library.get::<Analyze>(b"klu_analyze\0").ok()?,
                factor: *library.get::<Factor>(b"klu_factor\0").ok()?,
                refactor: *library.get::<Refactor>(b"klu_refactor\0").ok()?,
                solve: *library.get::<Solve>(b"klu_solve\0").ok()?,
                free_symbolic: *library.get::<Free>(b"klu_free_symbolic\0").ok()?,
                free_numeric: *library.get::<Free>(b"klu_free_numeric\0").ok()?,
                _library: library,
            })
        }
    }

    /// Orders and factors a matrix; `None` when it is singular.
    pub fn factor<'a>(&'a self, matrix: &'a Columns) -> Option<Factors<'a>> {
        let mut common = Box::new(Common([0; COMMON_BYTES]));
        let n = c_int::try_from(matrix.order()).ok()?;
        let (starts, rows) = (matrix.starts.as_ptr(), matrix.rows.as_ptr());
        // SAFETY: the arrays describe a square matrix (Columns::new) and outlive the call; `common` is
        // larger than the library's and was filled by it.
        unsafe {
            (self.defaults)(&raw mut *common);
            let symbolic = NonNull::new((self.analyze)(n, starts, rows, &raw mut *common))?;
            let numeric = (self.factor)(
                starts,
                rows,
                matrix.values.as_ptr(),
                symbolic.as_ptr(),
                &raw mut *common,
            );
            let Some(numeric) = NonNull::new(numeric) else {
                let mut symbolic = symbolic.as_ptr();
                (self.free_symbolic)(&raw mut symbolic, &raw mut *common);
                return None;
            };
            Some(Factors {
                klu: self,
                matrix,
                common,
                symbolic,
                numeric,
                _not_shared: PhantomData,
            })
        }
    }
}

impl Factors<'_> {
    /// Factors the matrix anew with the order and pivots of before: the least work there is. False when
    /// a pivot vanishes.
    pub fn refactor(&mut self) -> bool {
        let matrix = self.matrix;
        // SAFETY: symbolic and numeric belong to this matrix and live until drop.
        let done = unsafe {
            (self.klu.refactor)(
                matrix.starts.as_ptr(),
                matrix.rows.as_ptr(),
                matrix.values.as_ptr(),
                self.symbolic.as_ptr(),
                self.numeric.as_ptr(),
                &raw mut *self.common,
            )
        };
        done == 1
    }

    /// Orders kept, factors the matrix anew with pivots sought. False when it is singular.
    pub fn factor_anew(&mut self) -> bool {
        let matrix = self.matrix;
        // SAFETY: as in `refactor`; the old factors are given back once there are new ones.
        unsafe {
            let numeric = (self.klu.factor)(
                matrix.starts.as_ptr(),
                matrix.rows.as_ptr(),
                matrix.values.as_ptr(),
                self.symbolic.as_ptr(),
                &raw mut *self.common,
            );
            let Some(numeric) = NonNull::new(numeric) else {
                return false;
            };
            let mut old = std::mem::replace(&mut self.numeric, numeric).as_ptr();
            (self.klu.free_numeric)(&raw mut old, &raw mut *self.common);
        }
        true
    }

    /// Solves A x = `rhs` in place. False when the library refuses.
    ///
    /// # Panics
    /// When `rhs` has not as many entries as the matrix has rows.
    pub fn solve(&mut self, rhs: &mut [f64]) -> bool {
        assert_eq!(rhs.len(), self.matrix.order());
        let n = self.matrix.starts.len() as c_int - 1;
        // SAFETY: `rhs` holds n numbers, as is said by n and 1.
        let done = unsafe {
            (self.klu.solve)(
                self.symbolic.as_ptr(),
                self.numeric.as_ptr(),
                n,
                1,
                rhs.as_mut_ptr(),
                &raw mut *self.common,
            )
        };
        done == 1
    }
}

impl Drop for Factors<'_> {
    fn drop(&mut self) {
        let (mut symbolic, mut numeric) = (self.symbolic.as_ptr(), self.numeric.as_ptr());
        // SAFETY: both came from the library and are given back once.
        unsafe {
            (self.klu.free_numeric)(&raw mut numeric, &raw mut *self.common);
            (self.klu.free_symbolic)(&raw mut symbolic, &raw mut *self.common);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[4, 1, 0], [2, 5, 1], [0, 3, 6]] x = [6, 15, 24] has the solution [1, 2, 3].
    #[test]
    #[ignore = "needs SuiteSparse: make verify-klu"]
    fn a_system_with_a_known_solution_is_solved_by_fresh_and_by_renewed_factors() {
        let klu = Klu::load().expect("SuiteSparse's KLU: scripts/bootstrap --verify");
        let matrix = Columns::new(
            &[0, 2, 5, 7],
            &[0, 1, 0, 1, 2, 1, 2],
            &[4.0, 2.0, 1.0, 5.0, 3.0, 1.0, 6.0],
        );
        let mut factors = klu.factor(&matrix).expect("a regular matrix");
        for renewal in 0..3 {
            assert!(match renewal {
                0 => true,
                1 => factors.refactor(),
                _ => factors.factor_anew(),
            });
            let mut x = [6.0, 15.0, 24.0];
            assert!(factors.solve(&mut x));
            for (x, exact) in x.iter().zip([1.0, 2.0, 3.0]) {
                assert!((x - exact).abs() < 1e-14, "{x}");
            }
        }
        let singular = Columns::new(&[0, 1, 1], &[0], &[1.0]);
        assert!(klu.factor(&singular).is_none());
    }
}
