//! Vector instructions of the processor at hand, without asking for them when compiling.
//!
//! A kernel is a struct whose `call` is marked `#[inline(always)]`; [`widest`] compiles it once for
//! every instruction set and picks the widest that the processor has. Loops that the compiler does
//! not turn into vector code by itself say so with [`WithSimd`]. Multiplications and additions
//! are never fused, and every element of a loop is computed alone, so all sets give the same bits.

pub use pulp::{NullaryFnOnce as Kernel, Simd, WithSimd};

/// Sums that every reduction keeps apart, so that its order does not depend on the registers.
pub const SUMS: usize = 8;

/// Scalar products of `x` with three rows.
///
/// # Panics
///
/// When a row is shorter than `x`.
pub fn products(rows: [&[f64]; 3], x: &[f64]) -> [f64; 3] {
    widest(Products { rows, x })
}

/// Scalar product of `x` with a row.
///
/// # Panics
///
/// When the row is shorter than `x`.
pub fn product(row: &[f64], x: &[f64]) -> f64 {
    widest(Products { rows: [row], x })[0]
}

/// Sum of `x`.
pub fn sum(x: &[f64]) -> f64 {
    widest(Sum { x })
}

struct Sum<'a> {
    x: &'a [f64],
}

impl Kernel for Sum<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let (chunks, rest) = self.x.as_chunks::<SUMS>();
        let mut sums = [0.0; SUMS];
        for chunk in chunks {
            for k in 0..SUMS {
                sums[k] += chunk[k];
            }
        }
        let mut last = 0.0;
        for x in rest {
            last += x;
        }
        total(sums) + last
    }
}

struct Products<'a, const K: usize> {
    rows: [&'a [f64]; K],
    x: &'a [f64],
}

impl<const K: usize> Kernel for Products<'_, K> {
    type Output = [f64; K];

    // A closure would be compiled once, for the narrowest registers: loops all along.
    #[inline(always)]
    fn call(self) -> [f64; K] {
        let (x, x_rest) = self.x.as_chunks::<SUMS>();
        let mut out = [0.0; K];
        for (out, row) in out.iter_mut().zip(self.rows) {
            let (a, a_rest) = row[..self.x.len()].as_chunks::<SUMS>();
            let mut sums = [0.0; SUMS];
            for (a, x) in a.iter().zip(x) {
                for k in 0..SUMS {
                    sums[k] += a[k] * x[k];
                }
            }
            let mut rest = 0.0;
            for (a, x) in a_rest.iter().zip(x_rest) {
                rest += a * x;
            }
            *out = total(sums) + rest;
        }
        out
    }
}

/// All eight in a fixed order.
#[inline(always)]
pub fn total(s: [f64; SUMS]) -> f64 {
    ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]))
}

/// Runs `kernel` compiled for the widest vector registers of this processor.
#[inline]
pub fn widest<K: WithSimd>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(kernel)
}
