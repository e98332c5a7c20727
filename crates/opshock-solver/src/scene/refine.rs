//! The same scene on other steps, another coupling, contact method or window, or with its discretisation parameters
//! refined or coarsened: what retries, checks and refinement studies run.

use super::description::Scene;
use super::knob::{Knob, Levels};
use crate::disk::MOST_ELEMENTS;
use crate::head::Coupling;
use crate::structure::{ContactMethod, Window};
use crate::suspension::ReducedSuspension;

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

    /// The discretisation parameters whose refinement can change this scene's answer: without a ramp nothing excites what
    /// the disk's modes and the structure's step resolve, and a value of the model is not refined.
    pub fn knobs(&self) -> Vec<Knob> {
        let has_ramp = !self.ramp.model.is_absent();
        Knob::ALL
            .into_iter()
            .filter(|knob| has_ramp || !matches!(knob, Knob::DiskModes | Knob::StructureStep))
            .filter(|knob| !self.not_refined.contains(knob))
            .collect()
    }

    /// The same scene with its knobs turned, but for values of the model; see the table of [`super::knob`].
    #[must_use]
    pub fn at_levels(&self, mut levels: Levels) -> Scene {
        let mut scene = self.clone();
        for knob in &self.not_refined {
            levels.0[knob.place()] = 0;
        }
        let power = |base: f64, knob: Knob| base.powi(i32::from(levels.of(knob)));
        let scaled = |count: usize, factor: f64, least: usize| {
            ((count as f64 * factor).round() as usize).max(least)
        };
        let film = power(2.0, Knob::FilmGrid);
        scene.film_resolution.cells = scaled(self.film_resolution.cells, film, 16);
        let disk = power(2.0, Knob::DiskModes);
        scene.disk_resolution.cut_hz *= disk;
        // Frequencies of a plate grow with the square of its wave numbers.
        let waves = disk.sqrt();
        scene.disk_resolution.n_harmonics = scaled(self.disk_resolution.n_harmonics, waves, 1);
        // Beyond what a disk may have none is added; one that has too many by itself stays so, and is told.
        let elements = self.disk_resolution.n_elements;
        let most = elements.max(MOST_ELEMENTS);
        scene.disk_resolution.n_elements = scaled(elements, waves, 2).min(most);
        if levels.of(Knob::SuspensionModes) != 0 {
            let modes = power(2.0, Knob::SuspensionModes);
            let wanted = scaled(self.head_resolution.suspension_modes, modes, 1);
            // A beam has no more; with all of them nothing is cut.
            let most = ReducedSuspension::most_bending_modes(&self.suspension);
            scene.head_resolution.suspension_modes = wanted.min(most.unwrap_or(wanted));
        }
        scene.structure_resolution.step_s /= power(2.0, Knob::StructureStep);
        scene.head_resolution.tolerance /= power(8.0, Knob::HeadTolerance);
        scene.head_resolution.approach_share /= power(2.0, Knob::HeadTolerance);
        scene.head_resolution.coupling_tolerance /= power(8.0, Knob::CouplingTolerance);
        scene
    }
}
