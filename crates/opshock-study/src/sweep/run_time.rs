//! Modelled time of a simulation, by what it is made for.
//!
//! The unit is a survivor next to the critical amplitude of a positive pulse of 1 ms, on the scene as it is, per ramp model.
//! Another run takes
//!
//! ```text
//! t / t_unit = c V A (h F T + s 2.2^n)
//! ```
//!
//! | symbol | meaning | value |
//! |---|---|---|
//! | c | factor of a pulse of w ms | w^-0.35, at most 1.2, if positive; 1.3 w^-0.15 if negative |
//! | V | factor of a failure, which ends early | 1 for survivors; 0.2 without ramp, or with a rigid one and a positive pulse; else 0.6 up to 1 ms, 0.3 beyond |
//! | A | factor of a survivor at the amplitude a below the critical one a_c | (a / a_c)^0.45 without ramp; with one 0.25 below the first touch a_t, above it 0.25 + 0.75 ((a - a_t) / (a_c - a_t))^0.5 |
//! | h, s | shares of the head and of disk and ramp | 0.87, 0 without ramp; 0.78, 0.09 with one |
//! | F | factor of a film of half, quarter, eighth of the cells, or of 2^n as many | 0.55, 0.27, 0.22; 3.2^n; of the 400 cells of the preset coarse 0.65, 0.55, 0.55; 2.2^n |
//! | T | factor of 2^n times finer tolerances of the head, or of coarser ones | 1.8^n, with a deformable ramp at the preset coarse 2.8^n; 0.8 |
//! | n | refinement level of the time step of disk and ramp | |
//!
//! Sampling the defect correction of a film on 2^n times the cells takes 3.5 (4^n) units without ramp, once a process; at the preset
//! coarse, whose unit is smaller, 6.7 (4^n). Films of less than 600 cells are taken for that preset's.
//!
//! The factors were read off the film solves and times of 56 studies of one drive (`opshock new`) with clearances
//! of 60 to 140 um at the presets coarse and standard, of Fig. 13 and of its variants, and F, T and the sampling of 21 of these
//! studies again: tuned numbers, not physics.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::input::{SweepInput, SweepPoint};
use super::registry::Registry;
use crate::search::evidence::Evidence;
use crate::search::{Asked, Campaign, Coordinates, PointSearch, Probe, Ramp, Sign, Touch};

/// Cells below which a film is like that of the preset coarse, of 400, and not of the preset standard, of 1000.
const COARSE: usize = 600;

/// A kind of run, whose measured time is compared with the modelled one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// Ramp model.
    pub(super) ramp: Ramp,
    /// Refinement levels.
    pub(super) levels: Levels,
    /// Multiple of the study's window.
    pub(super) window_factor: u8,
    /// The disk touches a ramp.
    pub(super) touches: bool,
    /// It ends by a failure.
    pub(super) fails: bool,
}

impl Kind {
    /// A run of the search on the scene as it is.
    pub(super) fn is_plain(self) -> bool {
        self.levels.is_none() && self.window_factor == 1
    }

    /// Refinement level of the film's defect correction, where that is sampled anew.
    pub(super) fn correction(self) -> Option<i8> {
        Some(self.levels.of(Discretisation::FilmCorrection)).filter(|&level| level > 0)
    }

    /// Time of head, disk and ramp in units, of a film of so many cells.
    fn relative(self, cells: usize) -> f64 {
        if self.is_plain() {
            return 1.0;
        }
        let level = |discretisation| i32::from(self.levels.of(discretisation));
        let (head, structure) = match self.ramp {
            Ramp::None => (0.87, 0.0),
            Ramp::Rigid | Ramp::Deformable => (0.78, 0.09),
        };
        let is_coarse = cells < COARSE;
        let film = match (level(Discretisation::FilmGrid), is_coarse) {
            (..=-2, true) => 0.55,
            (-1, true) => 0.65,
            (finer, true) => 2.2_f64.powi(finer),
            (..=-3, false) => 0.22,
            (-2, false) => 0.27,
            (-1, false) => 0.55,
            (finer, false) => 3.2_f64.powi(finer),
        };
        let of_finer = match self.ramp {
            Ramp::Deformable if is_coarse => 2.8_f64,
            _ => 1.8,
        };
        let tolerance = match level(Discretisation::HeadTolerance) {
            ..=-1 => 0.8,
            finer => of_finer.powi(finer),
        };
        head * film * tolerance + structure * 2.2_f64.powi(level(Discretisation::StructureStep))
    }
}

/// A unit of the ramp model in those without ramp.
pub(super) fn of_none(ramp: Ramp) -> f64 {
    match ramp {
        Ramp::None => 1.0,
        Ramp::Rigid | Ramp::Deformable => 2.1,
    }
}

/// Units without ramp of sampling the defect correction of a film of so many cells at a refinement level.
pub(super) fn of_correction(level: i8, cells: usize) -> f64 {
    let of_plain = if cells < COARSE { 6.7 } else { 3.5 };
    of_plain * 4.0_f64.powi(i32::from(level))
}

/// Modelled time of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunTime {
    /// Its kind.
    pub(super) kind: Kind,
    /// Time in units of its ramp model.
    pub(super) units: f64,
}

impl RunTime {
    /// That of a requested run of `point` that fails or survives, by the critical amplitude that `campaign` knows.
    pub(super) fn of(
        input: &SweepInput,
        registry: &Registry<'_>,
        campaign: &Campaign,
        point: usize,
        asked: &Asked,
        fails: bool,
    ) -> RunTime {
        let at = &input.points[point].coordinates;
        let amplitude_g = registry.amplitude_g(asked.probe);
        let onset_g = campaign.touch(point).and_then(Touch::onset_g);
        let onset_g = onset_g.unwrap_or(0.0);
        let octave = f64::from(input.settings.grid.steps_per_octave);
        let octaves = match asked.probe.is_fine {
            // The finer grid of an interval lies next to the critical amplitude.
            true => 0.0,
            false => steps_below(campaign.search(point), asked.probe.index, octave) / octave,
        };
        let next_to_it = RunTime::survivor(&input.points[point], asked.probe);
        match fails {
            true => next_to_it.failing(at, amplitude_g >= onset_g),
            false => next_to_it.at(amplitude_g, onset_g, octaves),
        }
    }

    /// That of a survivor next to the critical amplitude.
    pub(super) fn survivor(point: &SweepPoint, probe: Probe) -> RunTime {
        let at = &point.coordinates;
        let kind = Kind {
            ramp: at.ramp,
            levels: probe.levels,
            window_factor: probe.window_factor,
            touches: at.ramp != Ramp::None,
            fails: false,
        };
        let of_pulse = match at.sign {
            Sign::Plus => at.pulse_ms.powf(-0.35).min(1.2),
            Sign::Minus => 1.3 * at.pulse_ms.powf(-0.15),
        };
        RunTime {
            kind,
            units: of_pulse * kind.relative(point.film.cells),
        }
    }

    /// This survivor `octaves` below the critical amplitude, where disk and ramp touch from `onset_g` upwards.
    pub(super) fn at(mut self, amplitude_g: f64, onset_g: f64, octaves: f64) -> RunTime {
        let octaves = octaves.max(0.0);
        self.kind.touches &= amplitude_g >= onset_g;
        self.units *= match (self.kind.ramp, self.kind.touches) {
            (Ramp::None, _) => (-0.45 * octaves).exp2(),
            (_, false) => 0.25,
            (_, true) => {
                let critical_g = amplitude_g * octaves.exp2();
                let place = (amplitude_g - onset_g) / (critical_g - onset_g).max(f64::MIN_POSITIVE);
                0.25 + 0.75 * place.clamp(0.0, 1.0).sqrt()
            }
        };
        self
    }

    /// This run, where it fails.
    fn failing(mut self, at: &Coordinates, touches: bool) -> RunTime {
        self.kind.touches &= touches;
        self.kind.fails = true;
        self.units *= match (at.ramp, at.sign) {
            (Ramp::None, _) | (Ramp::Rigid, Sign::Plus) => 0.2,
            _ if at.pulse_ms <= 1.0 => 0.6,
            _ => 0.3,
        };
        self
    }
}

/// Grid steps from a grid point up to the critical amplitude that is known: the middle of the bracket, but at most half an
/// octave above its survivor, or the highest survivor.
fn steps_below(search: Option<&PointSearch>, grid_point: i32, octave: f64) -> f64 {
    let evidence = search.map(PointSearch::evidence);
    let failure = evidence.and_then(Evidence::lowest_failure);
    let survivor = evidence.and_then(|evidence| evidence.highest_survivor_below(failure));
    let Some(survivor) = survivor else {
        return 0.0;
    };
    let above = f64::from(failure.unwrap_or(survivor) - survivor).min(octave) / 2.0;
    f64::from(survivor - grid_point) + above
}
