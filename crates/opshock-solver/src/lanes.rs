//! Runs loops with the widest vector instructions of the processor at hand, chosen when the program runs.
//!
//! A kernel is a struct whose `call` is marked `#[inline(always)]`; [`widest`] compiles it once for every instruction
//! set and picks the widest that the processor has. Loops that the compiler does not turn into vector code by itself
//! use [`WithSimd`]. A product and a sum are fused, that is rounded once, only where `mul_add` is written, which every
//! processor rounds alike, and every element of a loop is computed alone: all sets give the same bits. On a processor
//! without fused instructions (x86-64 before 2013) a library computes them one by one.

pub use pulp::{NullaryFnOnce as Kernel, Simd, WithSimd};

/// Sums that every reduction keeps apart, so that its order does not depend on the registers.
pub const SUMS: usize = 8;

/// Scalar products of `x` with three rows.
///
/// # Panics
///
/// When a row is shorter than `x`.
pub fn products(rows: [&[f64]; 3], x: &[f64]) -> [f64; 3] {
    abreast(rows.map(|row| [row, x]))
}

/// Scalar product of `x` with a row.
///
/// # Panics
///
/// When the row is shorter than `x`.
pub fn product(row: &[f64], x: &[f64]) -> f64 {
    abreast([[row, x]])[0]
}

/// Scalar products of pairs of a row and a vector, side by side, since a single one waits for its sums. Each has the
/// bits of [`product`].
///
/// # Panics
///
/// When a row is shorter than its vector.
pub fn abreast<const K: usize>(pairs: [[&[f64]; 2]; K]) -> [f64; K] {
    let (sums, rest) = widest(Abreast { pairs });
    std::array::from_fn(|i| total(sums[i]) + rest[i])
}

/// Sum of `x`.
pub fn sum(x: &[f64]) -> f64 {
    let (sums, rest) = widest(Sum { x });
    total(sums) + rest
}

/// `out` += `weight` `x`.
///
/// # Panics
///
/// When lengths differ.
pub fn add_scaled(out: &mut [f64], weight: f64, x: &[f64]) {
    assert_eq!(out.len(), x.len());
    widest(AddScaled { out, weight, x });
}

/// `out` := `base` + (w₀ x₀ + w₁ x₁ + w₂ x₂).
///
/// # Panics
///
/// When lengths differ.
pub fn combine(base: &[f64], weights: [f64; 3], x: [&[f64]; 3], out: &mut [f64]) {
    assert!(base.len() == out.len() && x.iter().all(|x| x.len() == out.len()));
    widest(Combine {
        base,
        weights,
        x,
        out,
    });
}

/// `out` := (`to` − `from`) `per_s`.
///
/// # Panics
///
/// When lengths differ.
pub fn rate_between(from: &[f64], to: &[f64], per_s: f64, out: &mut [f64]) {
    assert!(from.len() == out.len() && to.len() == out.len());
    widest(RateBetween {
        from,
        to,
        per_s,
        out,
    });
}

struct RateBetween<'a> {
    from: &'a [f64],
    to: &'a [f64],
    per_s: f64,
    out: &'a mut [f64],
}

impl Kernel for RateBetween<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for ((out, from), to) in self.out.iter_mut().zip(self.from).zip(self.to) {
            *out = (to - from) * self.per_s;
        }
    }
}

struct AddScaled<'a> {
    out: &'a mut [f64],
    weight: f64,
    x: &'a [f64],
}

impl Kernel for AddScaled<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (out, x) in self.out.iter_mut().zip(self.x) {
            *out = self.weight.mul_add(*x, *out);
        }
    }
}

struct Combine<'a> {
    base: &'a [f64],
    weights: [f64; 3],
    x: [&'a [f64]; 3],
    out: &'a mut [f64],
}

impl Kernel for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let ([a, b, c], [w0, w1, w2]) = (self.x, self.weights);
        let rest = a.iter().zip(b).zip(c);
        for ((out, base), ((a, b), c)) in self.out.iter_mut().zip(self.base).zip(rest) {
            *out = base + w2.mul_add(*c, w1.mul_add(*b, w0 * a));
        }
    }
}

struct Sum<'a> {
    x: &'a [f64],
}

impl Kernel for Sum<'_> {
    type Output = ([f64; SUMS], f64);

    #[inline(always)]
    fn call(self) -> Self::Output {
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
        (sums, last)
    }
}

struct Abreast<'a, const K: usize> {
    pairs: [[&'a [f64]; 2]; K],
}

impl<const K: usize> WithSimd for Abreast<'_, K> {
    /// Separate sums, and those of the remaining elements. If they were added up here, the compiler would use pairs of
    /// numbers and shuffles instead of whole registers.
    type Output = ([[f64; SUMS]; K], [f64; K]);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        match S::F64_LANES {
            8 => self.run::<S, 1>(simd),
            4 => self.run::<S, 2>(simd),
            2 => self.run::<S, 4>(simd),
            _ => self.run::<S, 8>(simd),
        }
    }
}

impl<const K: usize> Abreast<'_, K> {
    /// The sums with eight numbers in `V` registers.
    #[inline(always)]
    fn run<S: Simd, const V: usize>(&self, simd: S) -> ([[f64; SUMS]; K], [f64; K]) {
        let whole = |i: usize| -> [&[[f64; SUMS]]; 2] {
            let [row, x] = self.pairs[i];
            [row[..x.len()].as_chunks().0, x.as_chunks().0]
        };
        let together = (0..K).map(|i| whole(i)[1].len()).min().unwrap_or(0);
        let firsts: [_; K] = std::array::from_fn(|i| whole(i).map(|chunks| &chunks[..together]));
        let mut sums = [[simd.splat_f64s(0.0); V]; K];
        for j in 0..together {
            for (sums, [row, x]) in sums.iter_mut().zip(&firsts) {
                add_products(simd, sums, &row[j], &x[j]);
            }
        }
        let mut rests = [0.0; K];
        for (i, sums) in sums.iter_mut().enumerate() {
            let [row, x] = whole(i);
            for (row, x) in row[together..].iter().zip(&x[together..]) {
                add_products(simd, sums, row, x);
            }
            let done = x.len() * SUMS;
            let [row, x] = self.pairs[i];
            for (row, x) in row[done..].iter().zip(&x[done..]) {
                rests[i] = row.mul_add(*x, rests[i]);
            }
        }
        let mut out = [[0.0; SUMS]; K];
        for (out, sums) in out.iter_mut().zip(sums) {
            for (out, sum) in S::as_mut_simd_f64s(out).0.iter_mut().zip(sums) {
                *out = sum;
            }
        }
        (out, rests)
    }
}

/// `sums` += `row` `x`.
#[inline(always)]
fn add_products<S: Simd, const V: usize>(
    simd: S,
    sums: &mut [S::f64s; V],
    row: &[f64; SUMS],
    x: &[f64; SUMS],
) {
    let parts = S::as_simd_f64s(row).0.iter().zip(S::as_simd_f64s(x).0);
    for (sum, (row, x)) in sums.iter_mut().zip(parts) {
        *sum = simd.mul_add_f64s(*row, *x, *sum);
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
