//! Limits of contact from which slider and disk count as damaged, where that and not their first touch is the failure.

use super::outcome::SliderEpisode;

/// Limits of contact; the first that is exceeded is damage.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct DamageLimits {
    /// Largest pressure of a nominal area, Pa.
    pub pressure_pa: Option<f64>,
    /// Overlap of the mean planes, of the exact surface of the slider, m.
    pub overlap_m: Option<f64>,
    /// Episodes of contact.
    pub episodes: Option<u64>,
}

impl DamageLimits {
    /// Whether the latest episode, the `number`th, exceeds the pressure or their number. An overlap is found inside a step, as a
    /// touch is.
    pub(super) fn exceeded(&self, latest: &SliderEpisode, number: usize) -> bool {
        let over = |limit: Option<f64>, value: f64| limit.is_some_and(|limit| value > limit);
        over(self.pressure_pa, latest.peak_pressure_pa)
            || self.episodes.is_some_and(|most| number as u64 > most)
    }
}
