//! Adaptive refinement: where an interval exceeds the target uncertainty, the discretisation parameters with the
//! largest contributions are refined and the answer is bracketed anew.
//!
//! A refinement keeps the contributions of unchanged parameters. Evaluated again, around the new answer, are those of
//! changed parameters, and large ones of parameters at maximum refinement, which were not evaluated closely while
//! others had left no room. It ends when the interval meets the target, after the last refinement allowed, or when
//! every parameter that contributes is at its maximum: [`MOST_STEPS`] above the study, the film's [`MOST_FILM_STEPS`].
//! A ramp's mesh is refined only while a mesh of half its element size can be made to estimate its error. Where it is
//! too coarse beyond that, no other parameter is refined in vain.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::{Ask, Known, Progress, SUBDIVISIONS, Seen, UncertaintyInput};
use super::contributions::{Contribution, Uncertainty};
use super::pieces::{self, GROUPS, Pieces};
use super::rebracketing::{self, Bracket};
use super::walk::{self, Walk};
use crate::search::evidence::AmplitudeVerdict;
use crate::search::outcome::Flag;
use crate::search::probe::Retry;

/// Largest number of steps by which a discretisation parameter is refined beyond the study.
pub const MOST_STEPS: i8 = 3;
/// The same for the film's grid. Films compressed to small heights converge late: their error is known only where three
/// grids, the coarsest of a quarter of the cells, agree.
const MOST_FILM_STEPS: i8 = MOST_STEPS + 1;
/// Contributions above this share of the target are refined: film, structure and head are three sources.
const REFINE_ABOVE: f64 = 1.0 / 3.0;
/// Width to which a refined answer is bracketed, grid steps: a quarter of the search's tolerance.
const WIDTH: i32 = SUBDIVISIONS / 4;

/// Most steps by which so many refinements refine the film's grid: two with the first, then one each.
pub fn most_film_steps(refinements: u8) -> i8 {
    match i8::try_from(refinements) {
        Ok(0) => 0,
        Ok(refinements) => refinements.saturating_add(1).min(MOST_FILM_STEPS),
        Err(_) => MOST_FILM_STEPS,
    }
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
}

/// The answer of `input` with its interval, as far as `lookup` knows the runs it needs, after at most `refinements`
/// refinements; with the runs requested.
pub fn answer(
    input: &UncertaintyInput,
    refinements: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
) -> (Vec<Ask>, Progress<Answer>) {
    let mut log = Vec::new();
    let progress = match refined(input, refinements, lookup, &mut log) {
        Ok(mut answer) => {
            if log.iter().any(|ask| ask.retry != Retry::None) {
                answer.uncertainty.flags.insert(Flag::Retry);
            }
            Progress::Done(answer)
        }
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

fn refined(
    input: &UncertaintyInput,
    refinements: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
) -> Result<Answer, Ask> {
    let mut at = input.clone();
    let mut kept = Default::default();
    for left in (0..=refinements).rev() {
        let mut walk = Walk::new(&at, lookup, log);
        let pieces = pieces::pieces(&mut walk, kept)?;
        let uncertainty = pieces::whole(&walk, &pieces);
        let exceeds = uncertainty.flags.contains(&Flag::TargetNotMet);
        (at.survivor, at.failure) = walk::bracket(&walk);
        if !exceeds || refinements == 0 {
            return Ok(Answer::of(&at, uncertainty));
        }
        let changed = match left {
            0 => Vec::new(),
            _ => to_refine(&at, &uncertainty),
        };
        let finer = changed
            .iter()
            .fold(Levels::NONE, |levels, &(discretisation, steps)| {
                levels.changed(discretisation, steps)
            });
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
        kept = contributions_to_keep(&at, &pieces, &changed);
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
        }
    }
}

/// An interval that exceeds the target where no refinement is left, or the refined scene has no verdict.
fn at_limit(mut uncertainty: Uncertainty) -> Uncertainty {
    uncertainty.flags.insert(Flag::RefinementLimit);
    uncertainty
}

/// Largest level of a discretisation parameter. A mesh without a finer one to compare is not refined: three times the
/// estimate from a coarser mesh is no less than the estimate from both for the mesh before.
fn limit(at: &UncertaintyInput, discretisation: Discretisation) -> i8 {
    match discretisation {
        Discretisation::RampMesh => MOST_STEPS.min(at.mesh_halvings - 1),
        Discretisation::FilmGrid => MOST_FILM_STEPS,
        _ => MOST_STEPS,
    }
}

/// Parameters to refine, with the steps that their contributions call for: those above the share [`REFINE_ABOVE`], or the
/// largest. A parameter at its maximum is not refined. Where none is left, the largest of the others without which the
/// interval would meet the target; possibly none.
fn to_refine(at: &UncertaintyInput, uncertainty: &Uncertainty) -> Vec<(Discretisation, i8)> {
    let most = REFINE_ABOVE * at.target;
    let is_last_mesh = at.base.of(Discretisation::RampMesh) >= limit(at, Discretisation::RampMesh);
    let stays = |contribution: &&Contribution| {
        contribution.name == Discretisation::RampMesh.as_str() && is_last_mesh
    };
    let mesh = uncertainty.contributions.iter().find(stays);
    if mesh.is_some_and(|contribution| 0.5 * (contribution.low + contribution.high) > at.target) {
        return Vec::new();
    }
    let discretisations = |name: &str| -> Vec<Discretisation> {
        let group = GROUPS.iter().find(|group| group.name == name);
        let alone = Discretisation::from_word(name);
        let all = group.map_or_else(
            || alone.into_iter().collect(),
            |g| g.discretisations.to_vec(),
        );
        all.into_iter()
            .filter(|discretisation| at.discretisations.contains(discretisation))
            .filter(|discretisation| !(*discretisation == Discretisation::RampMesh && is_last_mesh))
            .collect()
    };
    let mut contributions: Vec<(f64, Vec<Discretisation>)> = uncertainty
        .contributions
        .iter()
        .map(|contribution| {
            (
                0.5 * (contribution.low + contribution.high),
                discretisations(contribution.name),
            )
        })
        .filter(|(_, discretisations)| !discretisations.is_empty())
        .collect();
    contributions.sort_by(|a, b| b.0.total_cmp(&a.0));
    let steps = |half: f64, discretisations: &[Discretisation]| -> Vec<(Discretisation, i8)> {
        let of = |&discretisation: &Discretisation| {
            let level = at.base.of(discretisation);
            // At high levels a step is expensive and may not reduce the error by its formal order.
            let called = if level == 0 && half > most * discretisation.formal_ratio() {
                2
            } else {
                1
            };
            (
                discretisation,
                called.min(limit(at, discretisation) - level),
            )
        };
        discretisations
            .iter()
            .map(of)
            .filter(|(_, by)| *by > 0)
            .collect()
    };
    let counts = contributions
        .iter()
        .filter(|(half, _)| *half > most)
        .count()
        .max(1);
    let counts = counts.min(contributions.len());
    let (counting, others) = contributions.split_at(counts);
    let changed: Vec<_> = counting
        .iter()
        .flat_map(|(half, discretisations)| steps(*half, discretisations))
        .collect();
    if !changed.is_empty() {
        return changed;
    }
    let excess = uncertainty.half_length() - at.target;
    let bought = others.iter().filter(|(half, _)| *half > excess);
    bought
        .map(|(half, discretisations)| steps(*half, discretisations))
        .find(|changed| !changed.is_empty())
        .unwrap_or_default()
}

/// The answer of a refined scene, beginning at the one before. `None` without verdicts.
fn bracketed(
    mut at: UncertaintyInput,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
) -> Result<Option<UncertaintyInput>, Ask> {
    let from = Bracket {
        low: at.survivor,
        high: at.failure,
    };
    let mut walk = Walk::new(&at, lookup, log);
    let Some(found) = rebracketing::located(&mut walk, from, WIDTH)? else {
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

/// Contributions of unchanged parameters, except large ones at maximum refinement, which are evaluated more closely.
fn contributions_to_keep(
    at: &UncertaintyInput,
    pieces: &Pieces,
    changed: &[(Discretisation, i8)],
) -> [Option<Uncertainty>; 1 + GROUPS.len()] {
    let is_changed = |discretisations: &[Discretisation]| {
        changed
            .iter()
            .any(|(discretisation, _)| discretisations.contains(discretisation))
    };
    let is_at_limit = |discretisations: &[Discretisation]| {
        let mut own = discretisations
            .iter()
            .filter(|discretisation| at.discretisations.contains(discretisation));
        own.all(|&discretisation| at.base.of(discretisation) >= limit(at, discretisation))
    };
    std::array::from_fn(|place| {
        let discretisations = match place {
            0 => &[Discretisation::FilmGrid][..],
            _ => GROUPS[place - 1].discretisations,
        };
        let counts = pieces[place].half_length() > REFINE_ABOVE * at.target;
        let again = is_changed(discretisations) || counts && is_at_limit(discretisations);
        (!again).then(|| pieces[place].clone())
    })
}
