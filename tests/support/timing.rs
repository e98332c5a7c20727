//! Times of repeated calls, for benchmarks.

use std::time::Instant;

/// Median of some times (the upper of two middle ones), s.
///
/// # Panics
/// When there is none.
pub fn median(mut times_s: Vec<f64>) -> f64 {
    times_s.sort_by(f64::total_cmp);
    times_s[times_s.len() / 2]
}

/// Median time of `n` calls, s.
///
/// # Panics
/// When `n` is zero.
pub fn median_of(n: usize, mut call: impl FnMut()) -> f64 {
    let times = (0..n).map(|_| {
        let start = Instant::now();
        call();
        start.elapsed().as_secs_f64()
    });
    median(times.collect())
}
