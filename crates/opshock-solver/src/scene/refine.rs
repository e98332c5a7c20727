//! The same scene on other steps, another coupling, contact method or window: what retries and checks run.

use super::{ContactMethod, Coupling, Scene, Window};

impl Scene {
    /// Every time step divided by `divisor` (> 1): the structure's grid directly, the head through
    /// its tolerance (local error of a second-order step, so its cube) and its approach bound. The
    /// coupling tolerance goes along: left behind, its error would be taken for that of the step.
    #[must_use]
    pub fn with_finer_steps(&self, divisor: f64) -> Scene {
        let mut finer = self.clone();
        finer.structure_resolution.step_s /= divisor;
        finer.head_resolution.tolerance /= divisor.powi(3);
        finer.head_resolution.coupling_tolerance /= divisor.powi(3);
        finer.head_resolution.approach_share /= divisor;
        finer
    }

    /// Another coupling of film and slider: the monolithic solve by the accelerated fixed point,
    /// everything else by the monolithic solve.
    #[must_use]
    pub fn with_other_coupling(&self) -> Scene {
        let mut other = self.clone();
        other.head_resolution.coupling = match self.head_resolution.coupling {
            Coupling::Monolithic => Coupling::Anderson,
            _ => Coupling::Monolithic,
        };
        other
    }

    /// The other contact method of disk and ramp.
    #[must_use]
    pub fn with_other_contact(&self) -> Scene {
        let mut other = self.clone();
        let contact = &mut other.structure_resolution.contact;
        *contact = match contact {
            ContactMethod::ExactFlow => ContactMethod::MoreauJean,
            ContactMethod::MoreauJean => ContactMethod::ExactFlow,
        };
        other
    }

    /// The window, or its longest extent, times `factor`.
    #[must_use]
    pub fn with_window_times(&self, factor: f64) -> Scene {
        let mut longer = self.clone();
        longer.window = match self.window {
            Window::Fixed { length_s } => Window::Fixed {
                length_s: length_s * factor,
            },
            Window::UntilDecayed { share, max_s } => Window::UntilDecayed {
                share,
                max_s: max_s * factor,
            },
        };
        longer
    }
}
