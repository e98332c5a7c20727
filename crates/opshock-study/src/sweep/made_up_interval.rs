//! Made-up answers of the runs that an uncertainty interval requests: every discretisation parameter has an error that
//! falls by refinement, about at its formal order or, in a share of the cases, without order.
//!
//! An error is a share e = t m x exp(a z + b y) of the critical amplitude, with t the target uncertainty, z normal and common
//! to all points of a study, y normal and the point's own. a and b are about those of the contributions to 114 points' intervals
//! at the presets coarse and standard; m makes the median contributions of made-up intervals about those of 69 points in 17 studies
//! with other clearances and widths. x = 4 (1 − A_t/A), within 0.1 and 1.4, is for the excess of the critical amplitude A over
//! that of first touch A_t: just above it little hangs on the contact (183 intervals of 21 studies). Known runs keep their verdicts,
//! and bound the made-up answer at their refinement levels.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::made_up::Random;
use crate::search::Ramp;
use crate::search::evidence::AmplitudeVerdict;
use crate::search::uncertainty::{Ask, Seen, UncertaintyInput};

/// Median error of a discretisation parameter over the target uncertainty: presets have both in proportion, but for films and
/// for the modes of a disk that strikes a ramp, whose errors are smaller beside a target of 5 % or of 1 %.
fn median_error(discretisation: Discretisation, ramp: Ramp, target: f64) -> f64 {
    let has_ramp = ramp != Ramp::None;
    match discretisation {
        Discretisation::FilmGrid if has_ramp => 0.7 * (0.01 / target).powf(0.2),
        Discretisation::FilmGrid => 0.3 * (0.01 / target).sqrt(),
        Discretisation::DiskModes => (0.05 / target).sqrt(),
        Discretisation::StructureStep | Discretisation::RampMesh => 0.4,
        Discretisation::HeadTolerance if has_ramp => 0.25,
        Discretisation::FilmCorrection if !has_ramp => 0.15,
        // A regularisation: what it changes is no error.
        Discretisation::MinFilmHeight => 0.0,
        Discretisation::FilmCorrection
        | Discretisation::HeadTolerance
        | Discretisation::SuspensionModes
        | Discretisation::CouplingTolerance => 0.05,
    }
}

/// a and b above.
const COMMON: f64 = 0.2;
const OWN: f64 = 0.9;
/// Share of discretisation parameters whose error has no order, and its largest alternating part.
const DISORDERED: f64 = 0.3;
const DISORDER: f64 = 0.6;

/// Common factors of the errors of a study's points, one of many possible.
pub(super) struct Errors(Vec<(Discretisation, f64)>);

impl Errors {
    /// Those of a seed.
    pub(super) fn of(sample: u64) -> Errors {
        let mut random = Random(sample ^ 0x5eed_0000);
        let all = Discretisation::ALL
            .into_iter()
            .chain([Discretisation::RampMesh]);
        Errors(
            all.map(|one| (one, (COMMON * random.normal()).exp()))
                .collect(),
        )
    }
}

/// Error of one discretisation parameter of a point.
struct OwnError {
    discretisation: Discretisation,
    share: f64,
    disorder: f64,
}

impl OwnError {
    fn at(&self, level: i8) -> f64 {
        let flip = if level.rem_euclid(2) == 1 { -1.0 } else { 1.0 };
        let ratio = self.discretisation.formal_ratio();
        self.share * ratio.powi(-i32::from(level)) * (1.0 + flip * self.disorder)
    }
}

/// Answers of a point's interval.
pub(super) struct MadeUpInterval<'a> {
    input: &'a UncertaintyInput,
    errors: Vec<OwnError>,
    /// Critical amplitude of the scene as it is, grid steps.
    critical: f64,
    /// Highest survivor and lowest failure known at some levels.
    known: Vec<(Levels, [Option<i32>; 2])>,
}

impl<'a> MadeUpInterval<'a> {
    /// Answers of a seed, in accord with the runs `known`, of a point whose disk touches its ramp from `onset_g` on.
    pub(super) fn of(
        input: &'a UncertaintyInput,
        (ramp, onset_g): (Ramp, Option<f64>),
        common: &Errors,
        seed: u64,
        known: &[(Ask, Seen)],
    ) -> MadeUpInterval<'a> {
        let mut random = Random(seed);
        let inside = random.unit();
        let width = f64::from(input.failure - input.survivor);
        let critical_g = input.grid.amplitude_g(input.survivor);
        // A drive that fails before its disk touches the ramp has the errors of one without.
        let fails_untouched = onset_g.is_some_and(|onset_g| onset_g >= critical_g);
        let ramp = if fails_untouched { Ramp::None } else { ramp };
        let of_onset = |onset_g: f64| (4.0 * (1.0 - onset_g / critical_g)).clamp(0.1, 1.4);
        let excess = onset_g.filter(|_| !fails_untouched).map_or(1.0, of_onset);
        let mut error = |&(discretisation, common): &(Discretisation, f64)| {
            let median = excess * common * median_error(discretisation, ramp, input.target);
            let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
            let is_disordered = random.unit() < DISORDERED;
            let disorder = DISORDER * random.unit();
            OwnError {
                discretisation,
                share: sign * input.target * median * (OWN * random.normal()).exp(),
                disorder: if is_disordered { disorder } else { 0.0 },
            }
        };
        let errors = common.0.iter().map(&mut error);
        let is_there = |one: &OwnError| input.discretisations.contains(&one.discretisation);
        let errors = errors.filter(is_there).collect();
        let mut bounds: Vec<(Levels, [Option<i32>; 2])> = Vec::new();
        for (ask, seen) in known {
            let place = bounds.iter().position(|(levels, _)| *levels == ask.levels);
            let place = place.unwrap_or_else(|| {
                bounds.push((ask.levels, [None; 2]));
                bounds.len() - 1
            });
            let [survivor, failure] = &mut bounds[place].1;
            match seen.verdict {
                AmplitudeVerdict::Survives => *survivor = (*survivor).max(Some(ask.index)),
                AmplitudeVerdict::Fails => {
                    *failure = Some(failure.map_or(ask.index, |before| before.min(ask.index)));
                }
                AmplitudeVerdict::Undecided => {}
            }
        }
        MadeUpInterval {
            input,
            errors,
            critical: f64::from(input.survivor) + inside * width,
            known: bounds,
        }
    }

    /// Critical amplitude at some levels, grid steps.
    fn critical(&self, levels: Levels) -> f64 {
        let change: f64 = self
            .errors
            .iter()
            .map(|error| error.at(levels.of(error.discretisation)) - error.at(0))
            .sum();
        let steps = f64::from(self.input.grid.steps_per_octave);
        let critical = self.critical + steps * (1.0 + change.clamp(-0.5, 1.0)).log2();
        let known = self.known.iter().find(|(known, _)| *known == levels);
        let Some((_, [survivor, failure])) = known else {
            return critical;
        };
        let low = survivor.map_or(f64::NEG_INFINITY, f64::from);
        let high = failure.map_or(f64::INFINITY, |failure| f64::from(failure) - 0.5);
        critical.min(high).max(low)
    }

    /// Clearance and its time of the scene as it is, by the survivors known.
    fn margin(&self, grid_point: f64) -> Option<(f64, f64)> {
        let known = &self.input.survivors;
        let at_or_below = known
            .iter()
            .filter(|known| f64::from(known.index) <= grid_point);
        let below = at_or_below.max_by_key(|known| known.index);
        let above = known
            .iter()
            .filter(|known| f64::from(known.index) > grid_point);
        let above = above.min_by_key(|known| known.index);
        let nearest = below.or(above)?;
        let (from, to, to_m) = match (below, above) {
            (Some(below), Some(above)) => (below, f64::from(above.index), above.h_min_m),
            (Some(below), None) => (below, self.critical.max(grid_point), 0.0),
            (None, _) => return Some((nearest.h_min_m, nearest.t_min_s)),
        };
        let length = (to - f64::from(from.index)).max(1e-9);
        let share = (grid_point - f64::from(from.index)) / length;
        Some((
            from.h_min_m + share * (to_m - from.h_min_m),
            nearest.t_min_s,
        ))
    }

    /// The made-up answer of a run.
    pub(super) fn seen(&self, ask: Ask) -> Seen {
        let critical = self.critical(ask.levels);
        let grid_point = f64::from(ask.index);
        let margin = self.margin(grid_point + self.critical - critical);
        Seen {
            verdict: if grid_point <= critical {
                AmplitudeVerdict::Survives
            } else {
                AmplitudeVerdict::Fails
            },
            h_min_m: margin.map(|(h_min_m, _)| h_min_m),
            t_min_s: margin.map(|(_, t_min_s)| t_min_s),
        }
    }
}
