//! Evaluates the solution within one step by a cubic Hermite polynomial (dense output), and finds its minima and zeros.
//!
//! ```text
//! y(θ) = (1+2θ)(1−θ)² y₀ + θ(1−θ)² Δt y₀' + θ²(3−2θ) y₁ − θ²(1−θ) Δt y₁',   0 <= θ <= 1
//! ```

/// Value at `theta` of the cubic with end values `y` and end rates `rate` over `dt_s`.
#[inline]
pub fn value(theta: f64, dt_s: f64, y: [f64; 2], rate: [f64; 2]) -> f64 {
    let s = 1.0 - theta;
    (1.0 + 2.0 * theta) * s * s * y[0]
        + theta * s * s * dt_s * rate[0]
        + theta * theta * (3.0 - 2.0 * theta) * y[1]
        - theta * theta * s * dt_s * rate[1]
}

/// Place and value of the smallest value on [0, 1] of a smooth function, from `n` intervals of
/// equal length and a golden-section search around the best of them.
pub fn minimum(n: usize, mut function: impl FnMut(f64) -> f64) -> (f64, f64) {
    let h = 1.0 / n as f64;
    let mut best = (0.0, function(0.0));
    for i in 1..=n {
        let theta = i as f64 * h;
        let value = function(theta);
        if value < best.1 {
            best = (theta, value);
        }
    }
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let (mut low, mut high) = ((best.0 - h).max(0.0), (best.0 + h).min(1.0));
    for _ in 0..24 {
        let (a, b) = (low + GOLDEN * (high - low), high - GOLDEN * (high - low));
        let (fa, fb) = (function(a), function(b));
        for probe in [(a, fa), (b, fb)] {
            if probe.1 < best.1 {
                best = probe;
            }
        }
        if fa < fb { high = b } else { low = a }
    }
    best
}

/// First place on [0, 1] where a smooth function falls below zero, to 1e-9 of the step: the first of `n` equal
/// intervals (or `hint`, a place known to be below) at whose end it is below zero, then bisection. `None` when it is
/// below zero at none of them.
pub fn first_below_zero(
    n: usize,
    hint: Option<f64>,
    mut function: impl FnMut(f64) -> f64,
) -> Option<f64> {
    let h = 1.0 / n as f64;
    let mut low = 0.0;
    let mut high = None;
    for i in 0..=n {
        let theta = i as f64 * h;
        if let Some(place) = hint.filter(|&p| p > low && p < theta) {
            high = Some(place);
            break;
        }
        if function(theta) < 0.0 {
            high = Some(theta);
            break;
        }
        low = theta;
    }
    let mut high = high?;
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 {
            high = middle
        } else {
            low = middle
        }
    }
    Some(high)
}
