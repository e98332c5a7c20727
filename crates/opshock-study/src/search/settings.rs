//! Settings of a search: tolerance, range and scan for lower failures.

use super::amplitude_grid::{AmplitudeGrid, AmplitudeGridError, AmplitudeRange};

/// How thoroughly lower failures are looked for below the bracket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MonotonicityScan {
    /// Not at all: failure is taken to be monotone.
    Off,
    /// Grid points at most `max_gap` apart, shifted from width to width so that neighbouring widths
    /// fill each other's gaps.
    Sampled,
    /// Every amplitude of the grid.
    Full,
}

impl MonotonicityScan {
    /// The word in study files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Sampled => "sampled",
            Self::Full => "full",
        }
    }
}

/// Settings of every point's search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// Amplitude grid of the tolerance.
    pub grid: AmplitudeGrid,
    /// Grid points searched.
    pub range: AmplitudeRange,
    /// Scan below the bracket.
    pub monotonicity_scan: MonotonicityScan,
    /// Largest step between scanned grid points, in grid steps.
    pub scan_gap: i32,
    /// Rerun the highest survivor in a doubled window.
    pub window_check: bool,
    /// Grid points without verdict after which a point is given up.
    pub max_undecided: usize,
}

/// Four undecided grid points are twenty runs with their retries.
const MAX_UNDECIDED: usize = 4;

impl SearchSettings {
    /// Settings from a study's numbers: amplitudes in G, tolerance and gap as shares.
    ///
    /// # Errors
    ///
    /// [`AmplitudeGridError`].
    pub fn new(
        (min_g, max_g): (f64, f64),
        tolerance: f64,
        monotonicity_scan: MonotonicityScan,
        max_gap: f64,
        window_check: bool,
    ) -> Result<SearchSettings, AmplitudeGridError> {
        let grid = AmplitudeGrid::for_tolerance(tolerance)?;
        Ok(SearchSettings {
            grid,
            range: grid.range(min_g, max_g)?,
            monotonicity_scan,
            scan_gap: grid.steps_within(max_gap.max(0.0)),
            window_check,
            max_undecided: MAX_UNDECIDED,
        })
    }
}
