//! Changes steps, coupling, contact method or window of a scene, or refines and coarsens its discretisation parameters:
//! for retries, checks and refinement studies.

use super::description::Scene;
use super::discretisation::{Discretisation, Levels};
use crate::disk::MOST_ELEMENTS;
use crate::head::Coupling;
use crate::structure::{ContactMethod, Window};
use crate::suspension::ReducedSuspension;

impl Scene {
    /// Every time step divided by `divisor` (> 1): the structure's grid directly, the head through its tolerance (local
    /// error of a second-order step, so its cube) and its approach bound. The coupling tolerance is reduced as well:
    /// otherwise its error would be taken for that of the step.
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

    /// The discretisation parameters whose refinement can change this scene's results. Without a ramp nothing excites
    /// what the disk's modes and the structure's step resolve. Without defect correction it has no grid. A value of the
    /// model is not refined.
    pub fn discretisations(&self) -> Vec<Discretisation> {
        let has_ramp = !self.ramp.model.is_absent();
        Discretisation::ALL
            .into_iter()
            .filter(|discretisation| {
                has_ramp
                    || !matches!(
                        discretisation,
                        Discretisation::DiskModes | Discretisation::StructureStep
                    )
            })
            .filter(|discretisation| {
                self.film_resolution.correction_cells > 0
                    || *discretisation != Discretisation::FilmCorrection
            })
            .filter(|discretisation| !self.not_refined.contains(discretisation))
            .collect()
    }

    /// The same scene at other refinement levels; parameters in `not_refined` keep their values. See
    /// [`super::discretisation`].
    #[must_use]
    pub fn at_levels(&self, mut levels: Levels) -> Scene {
        let mut scene = self.clone();
        for discretisation in &self.not_refined {
            levels.0[discretisation.place()] = 0;
        }
        let power = |base: f64, discretisation: Discretisation| {
            base.powi(i32::from(levels.of(discretisation)))
        };
        let scaled = |count: usize, factor: f64, least: usize| {
            ((count as f64 * factor).round() as usize).max(least)
        };
        let film = power(2.0, Discretisation::FilmGrid);
        scene.film_resolution.cells = scaled(self.film_resolution.cells, film, 16);
        let correction = &mut scene.film_resolution.correction_cells;
        if *correction > 0 {
            let factor = power(2.0, Discretisation::FilmCorrection);
            *correction = scaled(*correction, factor, 16);
        }
        scene.film_resolution.min_height_m /= power(2.0, Discretisation::MinFilmHeight);
        let disk = power(2.0, Discretisation::DiskModes);
        scene.disk_resolution.cut_hz *= disk;
        // Frequencies of a plate grow with the square of its wave numbers.
        let waves = disk.sqrt();
        scene.disk_resolution.n_harmonics = scaled(self.disk_resolution.n_harmonics, waves, 1);
        // No elements are added beyond the largest number for a disk; a scene with more keeps them, which is reported.
        let elements = self.disk_resolution.n_elements;
        let most = elements.max(MOST_ELEMENTS);
        scene.disk_resolution.n_elements = scaled(elements, waves, 2).min(most);
        if levels.of(Discretisation::SuspensionModes) != 0 {
            let modes = power(2.0, Discretisation::SuspensionModes);
            let wanted = scaled(self.head_resolution.suspension_modes, modes, 1);
            // A beam has no more modes; with all of them nothing is cut off.
            let most = ReducedSuspension::most_bending_modes(&self.suspension);
            scene.head_resolution.suspension_modes = wanted.min(most.unwrap_or(wanted));
        }
        scene.structure_resolution.step_s /= power(2.0, Discretisation::StructureStep);
        scene.head_resolution.tolerance /= power(8.0, Discretisation::HeadTolerance);
        scene.head_resolution.approach_share /= power(2.0, Discretisation::HeadTolerance);
        scene.head_resolution.coupling_tolerance /= power(8.0, Discretisation::CouplingTolerance);
        scene
    }
}
