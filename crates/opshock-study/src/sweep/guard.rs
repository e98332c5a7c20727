//! Isolates simulations from each other: a panic or a number that is not one becomes an undecided run of its own probe.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::histories::{self, Wanted};
use super::input::SweepInput;
use super::simulator::{Onset, Simulator};
use crate::search::{Probe, ProbeResult, RunCost, UndecidedCause, Verdict};
use crate::store::{StoreError, StoredTouch};

/// Simulates a probe.
pub(super) fn simulate(
    simulator: &dyn Simulator,
    point: usize,
    probe: Probe,
    amplitude_m_per_s2: f64,
) -> ProbeResult {
    let call = || simulator.simulate(point, probe, amplitude_m_per_s2);
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(result) => finite(result),
        Err(panic) => {
            let message = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
                .unwrap_or_else(|| "panic without message".into());
            ProbeResult {
                verdict: undecided(UndecidedCause::Panicked, &message),
                h_min_m: None,
                t_min_s: None,
                cost: RunCost::default(),
            }
        }
    }
}

/// Amplitude of first touch; unknown when the physics breaks down.
pub(super) fn onset(simulator: &dyn Simulator, point: usize) -> StoredTouch {
    match catch_unwind(AssertUnwindSafe(|| simulator.onset(point))) {
        Ok(Onset::NoRamp) => StoredTouch::NoRamp,
        Ok(Onset::At { amplitude_m_per_s2 })
            if amplitude_m_per_s2 > 0.0 && amplitude_m_per_s2.is_finite() =>
        {
            StoredTouch::At(amplitude_m_per_s2)
        }
        Ok(Onset::At { .. } | Onset::Unknown) | Err(_) => StoredTouch::Unknown,
    }
}

/// Records a history; returns a sentence for a warning when that panics.
///
/// # Errors
///
/// E183: the file cannot be written.
pub(super) fn record(
    input: &SweepInput,
    simulator: &dyn Simulator,
    wanted: &Wanted,
    folder: &Path,
) -> Result<Option<String>, StoreError> {
    let record = || histories::record(input, simulator, wanted, folder);
    match catch_unwind(AssertUnwindSafe(record)) {
        Ok(recorded) => recorded.map(|()| None),
        Err(_) => Ok(Some("a recording run panicked".into())),
    }
}

/// A survivor without a finite clearance, or a failure without a finite time, decides nothing.
fn finite(mut result: ProbeResult) -> ProbeResult {
    let bad = |number: Option<f64>| number.is_some_and(|value| !value.is_finite());
    let quantity = match &result.verdict {
        Verdict::Fails { t_fail_s, x_m, y_m }
            if ![t_fail_s, x_m, y_m].iter().all(|value| value.is_finite()) =>
        {
            Some("time or place of failure")
        }
        Verdict::Survives | Verdict::Fails { .. } if bad(result.h_min_m) || bad(result.t_min_s) => {
            Some("minimum clearance")
        }
        Verdict::Undecided { cause, message } if message.contains('\0') => {
            result.verdict = undecided(*cause, message);
            None
        }
        _ => None,
    };
    if let Some(quantity) = quantity {
        result.verdict = undecided(
            UndecidedCause::NotFinite,
            &format!("{quantity} is not a number"),
        );
    }
    result.h_min_m = result.h_min_m.filter(|value| value.is_finite());
    result.t_min_s = result.t_min_s.filter(|value| value.is_finite());
    result
}

/// HDF5 text ends at a NUL, so messages have none.
fn undecided(cause: UndecidedCause, message: &str) -> Verdict {
    Verdict::Undecided {
        cause,
        message: message.replace('\0', "\u{fffd}"),
    }
}
