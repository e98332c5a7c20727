//! The gap at the ramp that a disk leaves which runs out.

use super::{Check, trim};
use crate::study::{scene, words};

const RUN_OUT: &str = "ramp.run_out";
const GAP: &str = "ramp.clearance_um";
const SIDES: [&str; 2] = ["ramp.clearance_top_um", "ramp.clearance_bottom_um"];

impl Check<'_, '_> {
    /// A disk that runs out leaves a gap, and one that is taken off the gap runs out.
    pub(super) fn gap_left(&mut self) {
        let looked_at = [
            "disk.waves",
            "disk.run_out_um",
            "disk.outer_radius_mm",
            "ramp.radius_mm",
            GAP,
            SIDES[0],
            SIDES[1],
            RUN_OUT,
        ];
        if self.view.chosen(RUN_OUT, &words::RUN_OUT) != Some(true) || !self.sound(&looked_at) {
            return;
        }
        let taken_m = scene::gap_taken_m(self.view);
        if taken_m == 0.0 {
            let fault = self.fault(
                "N116",
                &[RUN_OUT],
                "has no effect: the disk does not run out",
            );
            fault.hint = "leave it out, or give disk.run_out_um".to_string();
            return;
        }
        let gap = |side: &str| {
            let gap_m = self.view.maybe_si(side);
            gap_m.unwrap_or_else(|| self.view.si(GAP))
        };
        let narrow_m = gap(SIDES[0]).min(gap(SIDES[1]));
        if taken_m >= narrow_m {
            let message = format!(
                "the disk runs out by {} um at the ramp, across a gap of {} um",
                trim(1e6 * taken_m),
                trim(1e6 * narrow_m)
            );
            let fault = self.fault("E143", &looked_at, message);
            fault.allowed = "run-out and waves that leave a gap".to_string();
        }
    }
}
