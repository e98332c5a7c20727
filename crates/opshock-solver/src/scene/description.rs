//! Describes one simulation, all but its amplitude, as plain data, and builds the film from it.

use super::discretisation::Discretisation;
use crate::air_bearing::{Film, FilmError, FilmResolution, FlowModel, GapForces, is_limited};
use crate::disk::{DiskParameters, DiskResolution, SurfaceMotion, Track, Wave};
use crate::gas::GasParameters;
use crate::head::{DamageLimits, HeadResolution};
use crate::ramp::RampParameters;
use crate::shock::{BaseMode, ObliqueShock, Pulse};
use crate::slider::SliderParameters;
use crate::structure::{SliderPlace, StructureParameters, StructureResolution, Window};
use crate::suspension::SuspensionParameters;

/// Everything one simulation needs but the amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Unit pulse.
    pub pulse: Pulse,
    /// Further loads of an oblique shock, in proportion to the pulse; `None`: an axial shock.
    pub oblique: Option<ObliqueShock>,
    /// Modes of base plate and housing; empty: a rigid base.
    pub base: Vec<BaseMode>,
    /// Simulated time after the onset.
    pub window: Window,
    /// Disk.
    pub disk: DiskParameters,
    /// Waves of the disk's surface that rotate with it under the slider; empty: a plane disk.
    pub run_out: Vec<Wave>,
    /// Ramp.
    pub ramp: RampParameters,
    /// Slider.
    pub slider: SliderParameters,
    /// Suspension.
    pub suspension: SuspensionParameters,
    /// Gas.
    pub gas: GasParameters,
    /// Rarefaction model.
    pub flow: FlowModel,
    /// Forces between slider and disk beside the air's pressure.
    pub gap_forces: GapForces,
    /// Clearance below which the head-disk interface has failed, m.
    pub fail_below_m: f64,
    /// Limits of contact from which it has failed instead, where a touch is no failure; `None`: it is.
    pub damage: Option<DamageLimits>,
    /// Resolution of the disk.
    pub disk_resolution: DiskResolution,
    /// Resolution of the structure.
    pub structure_resolution: StructureResolution,
    /// Resolution of the film.
    pub film_resolution: FilmResolution,
    /// Resolution of the head.
    pub head_resolution: HeadResolution,
    /// Discretisation parameters whose values belong to the model, as the highest frequency of a finite-element disk:
    /// they are not refined.
    pub not_refined: Vec<Discretisation>,
}

impl Scene {
    /// Motion of the disk's surface under the slider; `None` of a plane disk.
    pub fn surface_motion(&self) -> Option<SurfaceMotion> {
        let track = Track {
            radius_m: self.slider.radius_m,
            angle_rad: self.slider.angle_rad,
            skew_rad: self.slider.skew_rad,
            outer_radius_m: self.disk.outer_radius_m,
            spin_rad_per_s: self.disk.spin_rad_per_s,
        };
        (!self.run_out.is_empty()).then(|| SurfaceMotion::new(&self.run_out, &track))
    }

    /// The clearance called failure lies where the film sees more height than there is: below twice its minimum height. Damage is no
    /// clearance.
    pub fn fails_below_continuum(&self) -> bool {
        let roughness_m = self.gap_forces.asperity_contact.roughness_m;
        self.damage.is_none()
            && is_limited(
                self.fail_below_m,
                self.film_resolution.min_height_m,
                roughness_m,
            )
    }

    /// Disk, ramp, pulse and window, observed under the slider.
    pub fn structure(&self) -> StructureParameters<'_> {
        StructureParameters {
            disk: &self.disk,
            disk_resolution: &self.disk_resolution,
            ramp: &self.ramp,
            slider: SliderPlace {
                radius_m: self.slider.radius_m,
                angle_rad: self.slider.angle_rad,
                skew_rad: self.slider.skew_rad,
            },
            pulse: &self.pulse,
            oblique: self.oblique.as_ref(),
            base: &self.base,
            window: self.window,
            resolution: &self.structure_resolution,
        }
    }

    /// The film under the slider, over the disk at its speed, and the scene's other forces in the gap.
    ///
    /// # Errors
    ///
    /// As [`Film::build`].
    pub fn film(&self) -> Result<Film, FilmError> {
        let film = Film::build(
            &self.slider,
            &self.gas,
            self.flow,
            self.disk.spin_rad_per_s,
            &self.film_resolution,
        )?;
        Ok(self.with_gap_forces(film))
    }

    /// The same scene on a film of about `cells` cells.
    #[must_use]
    pub fn with_film_cells(&self, cells: usize) -> Scene {
        let mut scene = self.clone();
        scene.film_resolution.cells = cells;
        scene
    }

    /// The same film on given grid lines, along x and along y.
    ///
    /// # Errors
    ///
    /// As [`Film::on_grid`].
    pub fn film_on(&self, lines_m: [&[f64]; 2]) -> Result<Film, FilmError> {
        let film = Film::on_grid(
            &self.slider,
            &self.gas,
            self.flow,
            self.disk.spin_rad_per_s,
            self.film_resolution.min_height_m,
            lines_m,
        )?;
        Ok(self.with_gap_forces(film))
    }

    /// `film`, a film of this scene, with every cell cut in two along both directions.
    ///
    /// # Errors
    ///
    /// As [`Film::on_grid`].
    pub fn film_cut_in_two(&self, film: &Film) -> Result<Film, FilmError> {
        let halved = |lines_m: &[f64]| -> Vec<f64> {
            let between = lines_m.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
            between.chain(lines_m.last().copied()).collect()
        };
        let [x, y] = film.lines_m().map(halved);
        self.film_on([&x, &y])
    }

    fn with_gap_forces(&self, film: Film) -> Film {
        let active = self.gap_forces.active();
        active.fold(film, |film, force| film.with_gap_force(&self.slider, force))
    }
}
