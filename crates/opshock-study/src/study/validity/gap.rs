//! Rules for the gap that the run-out of a disk leaves at the ramp.

use super::check::{Check, trim};
use crate::study::field::Field;
use crate::study::fields;
use crate::study::scene;
use crate::study::words::RunOut;

const RUN_OUT: &str = fields::RAMP_RUN_OUT.path();

impl Check<'_, '_> {
    /// The run-out is smaller than the gaps, and `ramp.run_out` is set only for a disk that has one.
    pub(super) fn gap_left(&mut self) {
        let looked_at = [
            fields::DISK_WAVES.path(),
            fields::DISK_RUN_OUT_UM.path(),
            fields::DISK_OUTER_RADIUS_MM.path(),
            fields::RAMP_RADIUS_MM.path(),
            fields::RAMP_CLEARANCE_UM.path(),
            fields::RAMP_CLEARANCE_TOP_UM.path(),
            fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
            RUN_OUT,
        ];
        let run_out = self.view.get(&fields::RAMP_RUN_OUT);
        if run_out != Some(RunOut::LowestGap) || !self.sound(&looked_at) {
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
        let gap = |side: &Field<Option<f64>>| {
            let gap_m = self.view.get(side);
            gap_m.unwrap_or_else(|| self.view.get(&fields::RAMP_CLEARANCE_UM))
        };
        let narrow_m =
            gap(&fields::RAMP_CLEARANCE_TOP_UM).min(gap(&fields::RAMP_CLEARANCE_BOTTOM_UM));
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
