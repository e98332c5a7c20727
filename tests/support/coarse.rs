//! Settings that make a study's sweep a matter of seconds, as `--set` takes them.

/// A coarse search over short, coarse shocks of the drive in `fig13`; what is swept is up to the test.
pub const SEARCH: [&str; 6] = [
    "pulse.window_ms=0.8",
    "search.tolerance_pct=20",
    "search.monotonicity_scan=off",
    "search.uncertainty=false",
    "resolution.film_cells=200",
    "resolution.disk_cut_khz=10",
];

/// One width, no ramp: two points, of both signs, in a second.
pub const TWO_POINTS: [&str; 2] = ["pulse.widths_ms=[0.5]", "ramp.models=[\"none\"]"];
