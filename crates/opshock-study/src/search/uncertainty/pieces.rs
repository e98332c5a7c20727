//! Contribution of each source of error to the uncertainty interval: search, film grid, groups of other discretisation
//! parameters.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::Ask;
use super::change::Change;
use super::clearance_sensitivity::Reference;
use super::contributions::{Contribution, Uncertainty};
use super::judge::{self, Estimate};
use super::measure::Measure;
use super::rebracketing;
use super::walk::{DEEP, Start, Walk, bracket, fails_below};
use crate::search::outcome::Flag;

/// Discretisation parameters that are changed together.
pub(super) struct Group {
    /// Name of their common contribution.
    pub(super) name: &'static str,
    pub(super) discretisations: &'static [Discretisation],
}

/// In the order in which they are evaluated. The film's grid comes last: only as much of its error is evaluated closely as the
/// others leave.
pub(super) const GROUPS: [Group; 6] = [
    Group {
        name: "head",
        discretisations: &[
            Discretisation::HeadTolerance,
            Discretisation::CouplingTolerance,
        ],
    },
    // Alone: more of them cost little, where smaller tolerances cost steps.
    Group {
        name: "suspension_modes",
        discretisations: &[Discretisation::SuspensionModes],
    },
    Group {
        name: "structure",
        discretisations: &[Discretisation::DiskModes, Discretisation::StructureStep],
    },
    // Alone: its order differs from the others', and only some studies have it.
    Group {
        name: "ramp_mesh",
        discretisations: &[Discretisation::RampMesh],
    },
    Group {
        name: "film_correction",
        discretisations: &[Discretisation::FilmCorrection],
    },
    Group {
        name: "film_grid",
        discretisations: &FILM,
    },
];
const FILM: [Discretisation; 1] = [Discretisation::FilmGrid];

/// Share of the target to which brackets of changed scenes are narrowed; twice that on the scene's own film.
const GRAIN: f64 = 1.0 / 16.0;
/// Steps by which parameters other than the film's grid are refined for an estimate.
pub(super) const MOST_FINER: i8 = 2;

/// The contribution of the bracket alone.
fn search_part(walk: &Walk<'_>) -> Contribution {
    let found = bracket(walk);
    Contribution {
        name: "search",
        low: 0.0,
        high: walk.share(found.high - found.low),
        factor: 1.0,
    }
}

/// What each group contributes.
pub(super) type Pieces = [Uncertainty; GROUPS.len()];

/// Evaluates every group that is not `kept` from before.
pub(super) fn pieces(
    walk: &mut Walk<'_>,
    kept: [Option<Uncertainty>; GROUPS.len()],
) -> Result<Pieces, Ask> {
    let input = walk.input;
    if input.discretisations.is_empty() {
        return Ok(Pieces::default());
    }
    let reference = Reference::find(walk)?;
    let measure = Measure {
        reference: reference.as_ref(),
        grain: input.grid.steps_within(GRAIN * input.target).max(1),
    };
    let mut found = kept;
    let mut start = None;
    for (place, group) in GROUPS.iter().enumerate() {
        if found[place].is_none() {
            let known = found.iter().flatten().map(Uncertainty::half_length);
            // The bracket can be narrowed to one grid step.
            let room = input.target - known.sum::<f64>() - walk.share(1);
            let piece = group.look(walk, &measure, &mut start, room)?;
            found[place] = Some(piece);
        }
    }
    let found = found.map(Option::unwrap_or_default);
    narrow_bracket(walk, &found)?;
    Ok(found)
}

/// Halves the bracket of the scene itself, to one grid step if need be, if that alone meets the target, until it does.
fn narrow_bracket(walk: &mut Walk<'_>, pieces: &Pieces) -> Result<(), Ask> {
    let mut others = Uncertainty::default();
    pieces.iter().for_each(|piece| others.extend(piece));
    let target = walk.input.target;
    if others.relative_with(walk.share(1)) > target {
        return Ok(());
    }
    loop {
        let from = bracket(walk);
        let grid_points = from.high - from.low;
        if grid_points <= 1 || others.relative_with(walk.share(grid_points)) <= target {
            return Ok(());
        }
        if rebracketing::narrowed(walk, Levels::NONE, from, grid_points / 2)?.is_none() {
            return Ok(());
        }
    }
}

/// The interval that these contributions make.
pub(super) fn whole(walk: &Walk<'_>, pieces: &Pieces) -> Uncertainty {
    let mut uncertainty = Uncertainty::default();
    uncertainty.contributions.push(search_part(walk));
    for piece in pieces {
        uncertainty.extend(piece);
    }
    if !walk.input.discretisations.is_empty() && uncertainty.relative() > walk.input.target {
        uncertainty.flags.insert(Flag::TargetNotMet);
    }
    if fails_below(walk) {
        uncertainty.flags.insert(Flag::NonMonotone);
    }
    uncertainty
}

impl Group {
    /// The contribution of these parameters changed together, or of each alone where together they have no answer. `start`
    /// is the cheaper scene on which they are changed, `room` what the target leaves.
    fn look(
        &self,
        walk: &mut Walk<'_>,
        measure: &Measure<'_>,
        start: &mut Option<Start>,
        room: f64,
    ) -> Result<Uncertainty, Ask> {
        let input = walk.input;
        let is_changed =
            |discretisation: &Discretisation| input.discretisations.contains(discretisation);
        let own = self.discretisations.iter().copied().filter(is_changed);
        let own: Vec<Discretisation> = own.collect();
        let mut uncertainty = Uncertainty::default();
        if own == FILM {
            let error = film(walk, measure, room)?;
            uncertainty.add(self.name, error, input.target);
            return Ok(uncertainty);
        }
        if own.is_empty() {
            return Ok(uncertainty);
        }
        let from = match *start {
            Some(start) => start,
            None => measure.surrogate(walk)?,
        };
        *start = Some(from);
        let joint = error(walk, measure, from, &own)?;
        if joint.is_some() || own.len() == 1 {
            uncertainty.add(self.name, joint, input.target);
            return Ok(uncertainty);
        }
        for discretisation in own {
            let alone = error(walk, measure, from, &[discretisation])?;
            uncertainty.add(discretisation.as_str(), alone, input.target);
        }
        Ok(uncertainty)
    }
}

/// Error of parameters other than the film's grid, coarsened together by one step from `start`, and refined by a step or two
/// while it is not negligible: that costs less than refining the scene for an error that it does not have.
fn error(
    walk: &mut Walk<'_>,
    measure: &Measure<'_>,
    start: Start,
    discretisations: &[Discretisation],
) -> Result<Option<Estimate>, Ask> {
    let at = |steps| judge::refined(start.levels, discretisations, steps);
    let mut near = measure.change(walk, start, at(-1))?;
    let mut estimate = near.map(|near| judge::one_step(discretisations, near));
    // Parameters that have no answer together are changed one by one.
    if near.is_none() && discretisations.len() > 1 {
        return Ok(None);
    }
    let enough = judge::NEGLIGIBLE * walk.input.target;
    // After an impact without stiffness two sets of modes can agree by chance.
    let least =
        i8::from(walk.input.hard_contact && discretisations.contains(&Discretisation::DiskModes));
    let mut before: Option<Change> = None;
    for steps in 1..=MOST_FINER {
        let is_enough = estimate.is_some_and(|estimate| estimate.error() <= enough);
        if (is_enough && steps > least) || !walk.has_finer(discretisations, steps) {
            break;
        }
        let Some(finest) = measure.change(walk, start, at(steps))? else {
            // A confirmation that has no answer leaves the contribution unknown.
            estimate = estimate
                .map(Estimate::unconfirmed)
                .filter(|_| steps > least);
            break;
        };
        let finer = before.map_or(finest, |before| finest.since(before));
        estimate = Some(judge::with_finer(discretisations, near, finer, finest));
        near = Some(finer.reversed());
        before = Some(finest);
    }
    Ok(estimate)
}

/// Error of the film's grid from half and a quarter of the cells; where that is more than negligible and more than the
/// `room`, from half and twice the cells.
fn film(walk: &mut Walk<'_>, measure: &Measure<'_>, room: f64) -> Result<Option<Estimate>, Ask> {
    let start = walk.itself();
    let measure = Measure {
        grain: 2 * measure.grain,
        ..*measure
    };
    let at = |steps| judge::refined(Levels::NONE, &FILM, steps);
    let is_deep = walk.input.film_halvings >= DEEP;
    let near = measure.change(walk, start, at(-1))?;
    let mut coarse = None;
    if let (true, Some(near)) = (is_deep, near) {
        let far = measure.change(walk, start, at(-2))?;
        coarse = Some(match far {
            Some(far) => judge::two_coarser(&FILM, near, far),
            None => judge::one_step(&FILM, near).unconfirmed(),
        });
    }
    let enough = room.max(judge::NEGLIGIBLE * walk.input.target);
    if coarse.is_some_and(|coarse| coarse.error() <= enough) {
        return Ok(coarse);
    }
    Ok(match measure.change(walk, start, at(1))? {
        Some(finer) => Some(judge::with_finer(&FILM, near, finer, finer)),
        None => coarse.map(Estimate::unconfirmed),
    })
}
