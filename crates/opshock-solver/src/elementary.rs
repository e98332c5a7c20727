//! Computes exponential, logarithm, sine and cosine without calls, tables or branches.
//!
//! A loop over these functions compiles to vector instructions of whatever width the processor has. Every lane does the
//! same operations in the same order, so results have the same bits on every machine. Accuracy: 2 units in the last
//! place over the stated ranges.
//!
//! ```text
//! eˣ = 2ᵏ eʳ,   k = round(x/ln 2),  |r| <= ln 2/2, Taylor to r¹³
//! ln x = k ln 2 + 2 artanh((m − 1)/(m + 1)),   x = 2ᵏ m,  √½ <= m < √2, to the 21st power
//! ```

/// Adding this to |x| < 2⁵¹ leaves round(x) in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// ln 2 in two parts: the first has 33 bits, so that its product with k is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Arguments of eˣ are limited to this magnitude.
const LARGEST: f64 = 700.0;

/// eˣ; arguments beyond ±700 are taken as ±700. NaN stays NaN.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let x = if x > LARGEST { LARGEST } else { x };
    let x = if x < -LARGEST { -LARGEST } else { x };
    let shifted = x.mul_add(std::f64::consts::LOG2_E, ROUND);
    let k = shifted - ROUND;
    let r = k.mul_add(-LN_2[1], k.mul_add(-LN_2[0], x));
    let r2 = r * r;
    let r4 = r2 * r2;
    // Pairs first (Estrin), which is shorter to wait for than one long chain.
    let four = |[a, b, c, d]: [f64; 4]| r2.mul_add(r.mul_add(d, c), r.mul_add(b, a));
    let low = four([1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]);
    let middle = four([1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40_320.0, 1.0 / 362_880.0]);
    let high = four([
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ]);
    let e = 1.0 + r2.mul_add(r4.mul_add(r4.mul_add(high, middle), low), r);
    e * f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52)
}

/// sin x and cos x for |x| <= 1.6, by Taylor to x²¹ and x²².
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    let square = x * x;
    let mut sine = SINE[9];
    let mut cosine = COSINE[10];
    for k in (0..9).rev() {
        sine = sine.mul_add(square, SINE[k]);
    }
    for k in (0..10).rev() {
        cosine = cosine.mul_add(square, COSINE[k]);
    }
    // The leading term is added last, so that its rounding is the last one.
    ((sine * square).mul_add(x, x), cosine.mul_add(square, 1.0))
}

/// eˣ - 1 for -2 <= x <= 0, to 4 units in the last place: Taylor to the 13th power of x/4, doubled twice.
#[inline(always)]
pub fn exp_m1(x: f64) -> f64 {
    let quarter = 0.25 * x;
    let mut sum = EXPONENTIAL[11];
    for k in (0..11).rev() {
        sum = sum.mul_add(quarter, EXPONENTIAL[k]);
    }
    let once = (sum * quarter).mul_add(quarter, quarter);
    let twice = once * (2.0 + once);
    twice * (2.0 + twice)
}

/// (-1)ᵏ/(2k + 1)! from k = 1.
const SINE: [f64; 10] = inverse_factorials(3, 2, -1.0);
/// (-1)ᵏ/(2k)! from k = 1.
const COSINE: [f64; 11] = inverse_factorials(2, 2, -1.0);
/// 1/k! from k = 2.
const EXPONENTIAL: [f64; 12] = inverse_factorials(2, 1, 1.0);

/// 1/k! for k = `first`, `first` + `stride` and so on, times powers of `sign` from its first.
const fn inverse_factorials<const N: usize>(first: u32, stride: u32, sign: f64) -> [f64; N] {
    let mut out = [0.0; N];
    let (mut i, mut factor) = (0, sign);
    while i < N {
        // Products of whole numbers up to 22! < 2¹²⁸ are exact.
        let (mut factorial, mut k): (u128, u32) = (1, 2);
        while k <= first + stride * i as u32 {
            factorial *= k as u128;
            k += 1;
        }
        out[i] = factor / factorial as f64;
        factor *= sign;
        i += 1;
    }
    out
}

/// ln x for normal positive x.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let bits = x.to_bits();
    // The exponent as a number, by way of the bits of 2⁵² + exponent.
    let exponent =
        f64::from_bits((bits >> 52) | 0x4330_0000_0000_0000) - (4_503_599_627_370_496.0 + 1023.0);
    let m = f64::from_bits((bits & MANTISSA) | 0x3ff0_0000_0000_0000);
    let upper = m > std::f64::consts::SQRT_2;
    let m = if upper { 0.5 * m } else { m };
    let k = if upper { exponent + 1.0 } else { exponent };
    let s = (m - 1.0) / (m + 1.0);
    k.mul_add(LN_2[0], k.mul_add(LN_2[1], 2.0 * artanh(s)))
}

/// artanh s by its series, |s| <= 0.172.
#[inline(always)]
pub fn artanh(s: f64) -> f64 {
    let q = s * s;
    let q2 = q * q;
    let q4 = q2 * q2;
    let four = |[a, b, c, d]: [f64; 4]| q2.mul_add(q.mul_add(d, c), q.mul_add(b, a));
    let low = four([1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0]);
    let middle = four([1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0]);
    let high = q.mul_add(1.0 / 21.0, 1.0 / 19.0);
    (s * q).mul_add(q4.mul_add(q4.mul_add(high, middle), low), s)
}

/// c₀ + c₁ x + c₂ x² + ..., from the last to the first.
#[inline(always)]
pub fn polynomial<const N: usize>(x: f64, c: [f64; N]) -> f64 {
    let mut sum = c[N - 1];
    for k in (0..N - 1).rev() {
        sum = x.mul_add(sum, c[k]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_and_logarithm_are_within_two_units_in_the_last_place() {
        let mut x = -699.9;
        while x < 700.0 {
            let (found, exact) = (exp(x), x.exp());
            assert!((found / exact - 1.0).abs() < 4.5e-16, "exp({x})");
            x += 0.0317;
        }
        let mut x = 1e-300;
        while x < 1e300 {
            let (found, exact) = (ln(x), x.ln());
            let bound = 4.5e-16 * exact.abs();
            assert!((found - exact).abs() <= bound, "ln({x}): {found} {exact}");
            x *= 1.0371;
        }
        for k in -400..400 {
            let x = 1.0 + k as f64 * 1e-3;
            assert!((ln(x) - x.ln()).abs() <= 4.5e-16 * x.ln().abs(), "ln({x})");
        }
    }

    #[test]
    fn angles_are_within_two_units_in_the_last_place_and_small_powers_within_four() {
        for k in -1600..=1600 {
            let x = 1e-3 * f64::from(k);
            let ((sine, cosine), (s, c)) = (sin_cos(x), x.sin_cos());
            assert!((sine - s).abs() <= 4.5e-16 * s.abs(), "sin({x})");
            assert!((cosine - c).abs() <= 2.3e-16, "cos({x})");
            let power = -1.25 * x.abs();
            let (found, exact) = (exp_m1(power), power.exp_m1());
            assert!((found - exact).abs() <= 9e-16 * exact.abs(), "{power}");
        }
        assert_eq!((sin_cos(0.0), exp_m1(0.0)), ((0.0, 1.0), 0.0));
    }

    #[test]
    fn ends_and_exact_values() {
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(f64::INFINITY), exp(700.0));
        assert_eq!(exp(-1e300), exp(-700.0));
        assert!(exp(f64::NAN).is_nan());
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(2.0), std::f64::consts::LN_2);
    }
}
