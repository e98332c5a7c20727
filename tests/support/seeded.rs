//! Seeded numbers, and ranges of seeds that a run can be resumed from.

use std::ops::Range;

/// Numbers out of a seed (splitmix64): the same on every machine.
#[derive(Clone, Debug)]
pub struct Seeded(u64);

impl Seeded {
    /// Generator of a seed; neighbouring seeds share nothing.
    pub fn new(seed: u64) -> Self {
        let mut start = Self(seed);
        Self(start.bits())
    }

    /// Sixty-four bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `n`, 0 for `n` = 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n.max(1) as u64) as usize
    }

    /// One time in `n`.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [low, high), its logarithm evenly spread.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// An entry of a list.
    ///
    /// # Panics
    /// When the list is empty.
    pub fn one_of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// Seeds to run: `OPSHOCK_SEEDS=first..end`, or the default.
///
/// # Panics
/// When the variable is there and is no range.
pub fn seeds(default: Range<u64>) -> Range<u64> {
    match std::env::var("OPSHOCK_SEEDS") {
        Err(_) => default,
        Ok(text) => {
            let range = text.split_once("..").and_then(|(first, end)| {
                Some(first.trim().parse().ok()?..end.trim().parse().ok()?)
            });
            range.expect("OPSHOCK_SEEDS=first..end")
        }
    }
}

/// Names the seed when what it guards panics.
#[derive(Debug)]
pub struct OnPanic(pub u64);

impl Drop for OnPanic {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let (seed, next) = (self.0, self.0 + 1);
            eprintln!("seed {seed}: run again with OPSHOCK_SEEDS={seed}..{next}");
        }
    }
}
