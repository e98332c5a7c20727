//! Limits of contact from which slider and disk count as damaged, where that and not their first touch is the failure.

/// Limits of contact; the first that is exceeded is damage. An overlap is found inside a step, as a touch is; the others at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct DamageLimits {
    /// Largest pressure of a nominal area, Pa.
    pub pressure_pa: Option<f64>,
    /// Overlap of the mean planes, of the exact surface of the slider, m.
    pub overlap_m: Option<f64>,
    /// Episodes of contact.
    pub episodes: Option<u64>,
}
