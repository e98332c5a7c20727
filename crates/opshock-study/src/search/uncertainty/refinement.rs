//! Adaptive refinement: where an interval exceeds the target uncertainty, the discretisation parameters with the
//! largest contributions are refined and the answer is bracketed anew.
//!
//! A refinement keeps the contributions of unchanged parameters. It ends when the interval meets the target, after the
//! last refinement allowed, or when every parameter that contributes is at its maximum: [`MOST_STEPS`] above the study. A
//! ramp's mesh is refined only while a mesh of half its element size can be made to estimate its error.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::{Ask, Known, Progress, SUBDIVISIONS, Seen, UncertaintyInput};
use super::contributions::Uncertainty;
use super::min_film_height;
use super::pieces::{self, GROUPS, MOST_FINER, Pieces};
use super::rebracketing;
use super::walk::{self, Walk};
use crate::search::evidence::AmplitudeVerdict;
use crate::search::outcome::Flag;
use crate::search::probe::Retry;

/// Largest number of steps by which a discretisation parameter is refined beyond the study.
pub const MOST_STEPS: i8 = 3;
/// Contributions above this share of the target are refined: film, structure and head are three sources.
const REFINE_ABOVE: f64 = 1.0 / 3.0;
/// Width to which a refined answer is bracketed, grid steps: a quarter of the search's tolerance.
const WIDTH: i32 = SUBDIVISIONS / 4;

/// Largest factors on the cells of the film and of its defect-correction grid in the runs of an interval, with so many
/// refinements allowed: by two steps with the first, then one each, and finer ones for the estimate.
pub fn finest(refinements: u8) -> [f64; 2] {
    let steps = match refinements {
        0 => 0,
        1 => 2,
        _ => MOST_STEPS,
    };
    let film = steps + 1;
    let correction = (steps + MOST_FINER).min(walk::FINEST_CORRECTION);
    [film, correction].map(|steps| f64::from(steps).exp2())
}

/// A critical shock with its interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Refinement levels relative to the study.
    pub levels: Levels,
    /// Highest survivor, grid point of the interval's amplitude grid.
    pub survivor: i32,
    /// Lowest failure.
    pub failure: i32,
    /// Its interval.
    pub uncertainty: Uncertainty,
    /// Change of the critical shock with half the minimum film height, a share, where it is asked for and known.
    pub half_min_height: Option<f64>,
}

/// The answer of `input` with its interval, as far as `lookup` knows the runs it needs, after at most `refinements`
/// refinements; with the runs requested.
pub fn answer(
    input: &UncertaintyInput,
    refinements: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
) -> (Vec<Ask>, Progress<Answer>) {
    let (mut log, mut beside) = (Vec::new(), Beside::default());
    let progress = match refined(input, refinements, lookup, &mut log, &mut beside) {
        Ok(mut answer) => {
            if log.iter().any(|ask| ask.retry != Retry::None) {
                answer.uncertainty.flags.insert(Flag::Retry);
            }
            answer.half_min_height = beside.change;
            Progress::Done(answer)
        }
        Err(ask) => Progress::Wants(ask),
    };
    (beside.joined(log), progress)
}

/// The change with half the minimum film height, measured between the first interval and the first refinement. Its runs are
/// kept apart, so that the interval is the same without it.
#[derive(Default)]
struct Beside {
    change: Option<f64>,
    /// Runs that the interval had requested before.
    from: usize,
    log: Vec<Ask>,
}

impl Beside {
    fn measure(
        &mut self,
        input: &UncertaintyInput,
        lookup: &dyn Fn(Ask) -> Option<Seen>,
        log: &[Ask],
    ) -> Result<(), Ask> {
        self.from = log.len();
        let mut whole = log.to_vec();
        let change = min_film_height::change(&mut Walk::new(input, lookup, &mut whole));
        self.log = whole.split_off(self.from);
        self.change = change?;
        Ok(())
    }

    /// All runs in the order in which they were requested, each once.
    fn joined(self, log: Vec<Ask>) -> Vec<Ask> {
        let later = log[self.from..].iter();
        let later: Vec<Ask> = later
            .filter(|ask| !self.log.contains(ask))
            .copied()
            .collect();
        let mut all = log;
        all.truncate(self.from);
        all.extend(self.log);
        all.extend(later);
        all
    }
}

fn refined(
    input: &UncertaintyInput,
    refinements: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
    beside: &mut Beside,
) -> Result<Answer, Ask> {
    let mut at = input.clone();
    let mut kept = Default::default();
    for left in (0..=refinements).rev() {
        let mut walk = Walk::new(&at, lookup, log);
        let pieces = pieces::pieces(&mut walk, kept)?;
        let uncertainty = pieces::whole(&walk, &pieces);
        let exceeds = uncertainty.flags.contains(&Flag::TargetNotMet);
        let found = walk::bracket(&walk);
        (at.survivor, at.failure) = (found.low, found.high);
        if input.below_continuum && left == refinements {
            beside.measure(&at, lookup, log)?;
        }
        if !exceeds || refinements == 0 {
            return Ok(Answer::of(&at, uncertainty));
        }
        let finer = match left {
            0 => Levels::NONE,
            _ => to_refine(&at, &uncertainty),
        };
        if finer.is_none() {
            return Ok(Answer::of(&at, at_limit(uncertainty)));
        }
        let next = UncertaintyInput {
            base: at.base.plus(finer),
            film_halvings: at.film_halvings + finer.of(Discretisation::FilmGrid),
            ..at.clone()
        };
        let Some(next) = bracketed(next, lookup, log)? else {
            return Ok(Answer::of(&at, at_limit(uncertainty)));
        };
        at = next;
        kept = unchanged(pieces, finer);
    }
    unreachable!("the last round returns")
}

impl Answer {
    fn of(at: &UncertaintyInput, uncertainty: Uncertainty) -> Answer {
        Answer {
            levels: at.base,
            survivor: at.survivor,
            failure: at.failure,
            uncertainty,
            half_min_height: None,
        }
    }
}

/// An interval that exceeds the target where no refinement is left, or the refined scene has no verdict.
fn at_limit(mut uncertainty: Uncertainty) -> Uncertainty {
    uncertainty.flags.insert(Flag::RefinementLimit);
    uncertainty
}

/// Largest level of a discretisation parameter. A mesh, or a grid of the correction, without a finer one to compare is not
/// refined: three times the estimate from a coarser one is no less than the estimate from both for the one before.
fn limit(at: &UncertaintyInput, discretisation: Discretisation) -> i8 {
    match discretisation {
        Discretisation::RampMesh => MOST_STEPS.min(at.mesh_halvings - 1),
        Discretisation::FilmCorrection => walk::FINEST_CORRECTION - 1,
        _ => MOST_STEPS,
    }
}

/// Parameters to refine, with their steps: those that contribute more than the share [`REFINE_ABOVE`] of the target, or else
/// the largest. A parameter at its maximum is not refined; none is where those at their maximum exceed the target.
fn to_refine(at: &UncertaintyInput, uncertainty: &Uncertainty) -> Levels {
    let most = REFINE_ABOVE * at.target;
    let finer = |name: &str, half: f64| -> Levels {
        let group = GROUPS.iter().find(|group| group.name == name);
        let alone = Discretisation::from_word(name);
        let own = group.map_or(alone.as_slice(), |group| group.discretisations);
        let own = own.iter().filter(|one| at.discretisations.contains(one));
        own.fold(Levels::NONE, |levels, &discretisation| {
            let level = at.base.of(discretisation);
            // At high levels a step is expensive and may not reduce the error by its formal order.
            let is_far = level == 0 && half > most * discretisation.formal_ratio();
            let steps = (1 + i8::from(is_far)).min(limit(at, discretisation) - level);
            levels.changed(discretisation, steps.max(0))
        })
    };
    let contributions = uncertainty.contributions.iter().map(|one| {
        let half = 0.5 * (one.low + one.high);
        (half, finer(one.name, half))
    });
    let (left, mut contributions): (Vec<_>, Vec<_>) =
        contributions.partition(|(_, levels)| levels.is_none());
    if left.iter().map(|(half, _)| half).sum::<f64>() > at.target {
        return Levels::NONE;
    }
    contributions.sort_by(|a, b| b.0.total_cmp(&a.0));
    let above = contributions.iter().filter(|(half, _)| *half > most);
    let chosen = above.count().max(1);
    let chosen = contributions.iter().take(chosen);
    chosen.fold(Levels::NONE, |levels, one| levels.plus(one.1))
}

/// The answer of a refined scene, beginning at the one before. `None` without verdicts.
fn bracketed(
    mut at: UncertaintyInput,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
) -> Result<Option<UncertaintyInput>, Ask> {
    let mut walk = Walk::new(&at, lookup, log);
    let from = walk.itself().bracket;
    let Some(found) = rebracketing::located(&mut walk, Levels::NONE, from, WIDTH)? else {
        return Ok(None);
    };
    let t_fail_s = walk.see(Levels::NONE, found.high)?.t_min_s;
    // The survivors simulated on the way are those of these levels.
    let base = at.base;
    let own: Vec<Ask> = walk
        .log
        .iter()
        .copied()
        .filter(|ask| ask.levels == base && ask.retry == Retry::None)
        .collect();
    let mut survivors = Vec::new();
    for ask in own {
        let seen = walk.see(Levels::NONE, ask.index)?;
        if let (AmplitudeVerdict::Survives, Some(h_min_m), Some(t_min_s)) =
            (seen.verdict, seen.h_min_m, seen.t_min_s)
        {
            survivors.push(Known {
                index: ask.index,
                h_min_m,
                t_min_s,
            });
        }
    }
    at.survivor = found.low;
    at.failure = found.high;
    at.t_fail_s = t_fail_s;
    at.survivors = survivors;
    Ok(Some(at))
}

/// Contributions of the groups of which nothing is refined.
fn unchanged(pieces: Pieces, finer: Levels) -> [Option<Uncertainty>; GROUPS.len()] {
    let mut place = 0;
    pieces.map(|piece| {
        let mut own = GROUPS[place].discretisations.iter();
        place += 1;
        let is_unchanged = own.all(|&discretisation| finer.of(discretisation) == 0);
        is_unchanged.then_some(piece)
    })
}
