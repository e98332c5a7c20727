//! Vector instructions of the processor at hand, without asking for them when compiling.
//!
//! A kernel is a struct whose `call` is marked `#[inline(always)]`; [`widest`] compiles it once for
//! every instruction set and picks the widest that the processor has. Loops that the compiler does
//! not turn into vector code by itself say so with [`WithSimd`]. Multiplications and additions
//! are never fused, and every element of a loop is computed alone, so all sets give the same bits.

pub use pulp::{NullaryFnOnce as Kernel, Simd, WithSimd};

/// Sums kept apart in [`products`], so that their order does not depend on the registers.
const SUMS: usize = 8;

/// Scalar products of `x` with three rows.
///
/// # Panics
///
/// When a row is shorter than `x`.
pub fn products(rows: [&[f64]; 3], x: &[f64]) -> [f64; 3] {
    widest(Products { rows, x })
}

struct Products<'a> {
    rows: [&'a [f64]; 3],
    x: &'a [f64],
}

impl Kernel for Products<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn call(self) -> [f64; 3] {
        self.rows.map(|row| {
            let mut sums = [0.0; SUMS];
            let (a, a_rest) = row[..self.x.len()].as_chunks::<SUMS>();
            let (x, x_rest) = self.x.as_chunks::<SUMS>();
            for (a, x) in a.iter().zip(x) {
                for k in 0..SUMS {
                    sums[k] += a[k] * x[k];
                }
            }
            let rest: f64 = a_rest.iter().zip(x_rest).map(|(a, x)| a * x).sum();
            total(sums) + rest
        })
    }
}

/// All eight in a fixed order.
#[inline(always)]
pub fn total(s: [f64; 8]) -> f64 {
    ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]))
}

/// Runs `kernel` compiled for the widest vector registers of this processor.
#[inline]
pub fn widest<K: WithSimd>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(kernel)
}
