//! Checks step and window of a structural run, and gives the number of steps of its time grid.

use super::error::StructureError;
use super::parameters::Window;

/// Largest number of steps of a grid.
const MAX_STEPS: f64 = 2e7;

pub(super) fn check_times(window: Window, step_s: f64) -> Result<(), StructureError> {
    let positive = "finite and above 0";
    let above_0 = |x: f64| x.is_finite() && x > 0.0;
    let (length, share) = match window {
        Window::Fixed { length_s } => (length_s, 0.5),
        Window::UntilDecayed { share, max_s } => (max_s, share),
    };
    for (name, value, ok, allowed) in [
        ("window", length, above_0(length), positive),
        ("step", step_s, above_0(step_s), positive),
        (
            "decay share",
            share,
            above_0(share) && share < 1.0,
            "between 0 and 1",
        ),
    ] {
        if !ok {
            return Err(StructureError::Time {
                name,
                value,
                allowed,
            });
        }
    }
    Ok(())
}

pub(super) fn count_steps(window: Window, step_s: f64) -> Result<usize, StructureError> {
    // A window that is a multiple of the step but for rounding gets no extra step.
    let n = (window_length(window) / step_s - 1e-6).ceil().max(1.0);
    if n > MAX_STEPS {
        return Err(StructureError::Time {
            name: "steps in the window",
            value: n,
            allowed: "at most 2e7",
        });
    }
    Ok(n as usize)
}

fn window_length(window: Window) -> f64 {
    match window {
        Window::Fixed { length_s } => length_s,
        Window::UntilDecayed { max_s, .. } => max_s,
    }
}
