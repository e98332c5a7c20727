//! Naive iterations, verdicts and searches.

/// Aitken's factor ω r₀ / (r₀ − r₁) as printed, for two equal residuals and for residuals of zero.
pub fn aitken_as_printed() -> [f64; 2] {
    [1.0_f64, 0.0].map(|residual| {
        let (before, now) = (residual, residual);
        -0.5 * before / (now - before)
    })
}

/// A clearance as a verdict: whether it is below zero.
pub fn is_below_zero(clearance: f64) -> bool {
    clearance < 0.0
}

/// Critical amplitude by bisection that takes the ends of its range for a survivor and a failure.
pub fn bisected(low: f64, high: f64, fails: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    while high / low > 1.01 {
        let middle = (low * high).sqrt();
        if fails(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}

/// Whether a residual of zero is small relative to a state of zero.
pub fn is_relatively_small(residual: f64, state: f64) -> bool {
    residual / state <= 1e-6
}

/// Ends of the bracket after `halvings` of an interval assumed to contain the answer.
pub fn bracketed(
    (mut low, mut high): (f64, f64),
    halvings: usize,
    fails: impl Fn(f64) -> bool,
) -> (f64, f64) {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if fails(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    (low, high)
}

/// Sum of numbers in the order in which `workers` workers, each with every n-th number, deliver them one worker after
/// the other.
pub fn summed_by_workers(numbers: &[f64], workers: usize) -> f64 {
    (0..workers).fold(0.0, |sum, worker| {
        numbers
            .iter()
            .skip(worker)
            .step_by(workers)
            .fold(sum, |sum, x| sum + x)
    })
}

/// Answers of a row of bisections each of which starts around the last answer, in the
/// order of `criticals`; the first starts from `start`.
pub fn each_from_the_last(start: f64, criticals: &[f64]) -> Vec<f64> {
    let mut last = start;
    criticals
        .iter()
        .map(|&critical| {
            last = bisected(0.55 * last, 1.9 * last, |a| a >= critical);
            last
        })
        .collect()
}
