//! Number types of matrix factors in vector registers: double precision, or single at half the memory.

use crate::lanes::Simd;

/// A number type of factors: double precision, or single precision where an iteration corrects the solution.
pub trait Entry:
    Copy
    + std::fmt::Debug
    + PartialOrd
    + std::ops::Mul<Output = Self>
    + std::ops::Neg<Output = Self>
    + 'static
{
    /// Several of them in a register.
    type Register<S: Simd>: Copy;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Largest number of them in a register of any processor.
    const SET: usize;

    /// The nearest such number.
    fn nearest(value: f64) -> Self;
    /// The same number in double precision.
    fn widen(self) -> f64;
    /// `self` `b` + `c`, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// 1/`self`.
    fn recip(self) -> Self;
    /// The number without its sign.
    fn abs(self) -> Self;
    /// Several of them to a register.
    fn cut<S: Simd>(numbers: &[Self]) -> &[Self::Register<S>];
    /// The same, to write.
    fn cut_mut<S: Simd>(numbers: &mut [Self]) -> &mut [Self::Register<S>];
    /// A register full of one number.
    fn splat<S: Simd>(self, simd: S) -> Self::Register<S>;
    /// a b + c, rounded once.
    fn multiply_add<S: Simd>(
        simd: S,
        a: Self::Register<S>,
        b: Self::Register<S>,
        c: Self::Register<S>,
    ) -> Self::Register<S>;
    /// a + b.
    fn add<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    /// How many of them there are in a register.
    fn lanes<S: Simd>() -> usize;
}

macro_rules! entry {
    ($number:ty, $set:literal, $register:ident, $splat:ident, $add:ident, $mul_add:ident, $cut:ident, $cut_mut:ident, $lanes:ident) => {
        impl Entry for $number {
            type Register<S: Simd> = S::$register;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const SET: usize = $set;

            #[inline(always)]
            #[allow(
                clippy::cast_possible_truncation,
                reason = "rounding is what it is for"
            )]
            fn nearest(value: f64) -> Self {
                value as $number
            }

            #[inline(always)]
            fn widen(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn splat<S: Simd>(self, simd: S) -> S::$register {
                simd.$splat(self)
            }

            #[inline(always)]
            fn add<S: Simd>(simd: S, a: S::$register, b: S::$register) -> S::$register {
                simd.$add(a, b)
            }

            #[inline(always)]
            fn multiply_add<S: Simd>(
                simd: S,
                a: S::$register,
                b: S::$register,
                c: S::$register,
            ) -> S::$register {
                simd.$mul_add(a, b, c)
            }

            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                <$number>::mul_add(self, b, c)
            }

            #[inline(always)]
            fn recip(self) -> Self {
                1.0 / self
            }

            #[inline(always)]
            fn abs(self) -> Self {
                <$number>::abs(self)
            }

            #[inline(always)]
            fn cut<S: Simd>(numbers: &[Self]) -> &[S::$register] {
                S::$cut(numbers).0
            }

            #[inline(always)]
            fn cut_mut<S: Simd>(numbers: &mut [Self]) -> &mut [S::$register] {
                S::$cut_mut(numbers).0
            }

            #[inline(always)]
            fn lanes<S: Simd>() -> usize {
                S::$lanes
            }
        }
    };
}

entry!(
    f64,
    8,
    f64s,
    splat_f64s,
    add_f64s,
    mul_add_f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    F64_LANES
);
entry!(
    f32,
    16,
    f32s,
    splat_f32s,
    add_f32s,
    mul_add_f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    F32_LANES
);
