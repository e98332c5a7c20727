//! Contribution of each source of error to the uncertainty interval: search, film grid, groups of discretisation
//! parameters.

use std::collections::BTreeSet;

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::Ask;
use super::contributions::{Contribution, Uncertainty};
use super::limits::Limits;
use super::walk::{Walk, bracket, fails_below};
use super::{clearance_sensitivity, rebracketing};
use crate::search::outcome::Flag;

/// Discretisation parameters that are first changed together.
pub(super) struct Group {
    /// Name of their common contribution.
    pub(super) name: &'static str,
    pub(super) discretisations: &'static [Discretisation],
}

pub(super) const GROUPS: [Group; 3] = [
    // Alone: its order differs from the others', and only some studies have it.
    Group {
        name: "ramp_mesh",
        discretisations: &[Discretisation::RampMesh],
    },
    Group {
        name: "structure",
        discretisations: &[Discretisation::DiskModes, Discretisation::StructureStep],
    },
    // Coarsened together with the structure, they may fail where none of them does alone.
    Group {
        name: "head",
        discretisations: &[
            Discretisation::SuspensionModes,
            Discretisation::HeadTolerance,
            Discretisation::CouplingTolerance,
        ],
    },
];

/// The contribution of the bracket alone.
fn search_part(walk: &Walk<'_>) -> Uncertainty {
    let (survivor, failure) = bracket(walk);
    let search = Contribution {
        name: "search",
        low: 0.0,
        high: walk.share(failure - survivor),
        factor: 1.0,
    };
    Uncertainty {
        contributions: vec![search],
        flags: BTreeSet::new(),
    }
}

/// What each source of error contributes: the film's grid, then [`GROUPS`].
pub(super) type Pieces = [Uncertainty; 1 + GROUPS.len()];

/// Evaluates every source that is not `kept` from before.
pub(super) fn pieces(
    walk: &mut Walk<'_>,
    kept: [Option<Uncertainty>; 1 + GROUPS.len()],
) -> Result<Pieces, Ask> {
    let input = walk.input;
    let margin = match input.discretisations.is_empty() {
        true => None,
        false => clearance_sensitivity::Reference::find(walk)?,
    };
    let [film, groups @ ..] = kept;
    let (mut surrogate, mut agreed) = (None, None);
    let mut sum = search_part(walk);
    let film = match film {
        Some(film) => film,
        None => {
            let mut film = Uncertainty::default();
            if input.discretisations.contains(&Discretisation::FilmGrid) {
                let by_clearance = match &margin {
                    Some(reference) => reference.film(walk, Limits::of(walk, &sum, 0.0))?,
                    None => None,
                };
                let found = match by_clearance {
                    Some(_) => rebracketing::Film {
                        estimate: by_clearance,
                        ..Default::default()
                    },
                    None => {
                        let limits = Limits::of(walk, &sum, 0.0);
                        rebracketing::film(walk, limits)?
                    }
                };
                (surrogate, agreed) = (found.surrogate, found.agreed);
                film.add(
                    Discretisation::FilmGrid.as_str(),
                    found.estimate,
                    input.target,
                );
            }
            film
        }
    };
    // What further halving would take off the contributions of film and bracket is room for the others.
    let spare = match agreed {
        Some(both) if rebracketing::may_go_on(both) => {
            sum = search_part(walk);
            sum.half_length() + film.half_length() - least_by_half(walk, both)
        }
        _ => 0.0,
    };
    sum.extend(&film);
    let mut found = [
        film,
        Uncertainty::default(),
        Uncertainty::default(),
        Uncertainty::default(),
    ];
    // The head first: with its parameters coarsened, comparisons of the structure cost half as much.
    for (place, (group, kept)) in GROUPS.iter().zip(groups).enumerate().rev() {
        let piece = match kept {
            Some(piece) => piece,
            None => group.look(walk, margin.as_ref(), &mut surrogate, (&sum, spare))?,
        };
        sum.extend(&piece);
        found[place + 1] = piece;
    }
    if let Some(both) = agreed.filter(|&both| rebracketing::may_go_on(both)) {
        found[0] = narrow_film(walk, &found, both)?;
    }
    narrow_bracket(walk, &found)?;
    Ok(found)
}

/// Least contribution of bracket and film together where half the cells agree with the scene.
fn least_by_half(walk: &Walk<'_>, both: rebracketing::Bracket) -> f64 {
    let one = rebracketing::Bracket {
        high: both.low + 1,
        ..both
    };
    0.5 * walk.share(1) + rebracketing::agreed(walk, one).error()
}

/// The film's contribution after further halvings of the bracket in which half the cells agree with the scene. They go
/// on while the interval exceeds the target and halving can still bring it there.
fn narrow_film(
    walk: &mut Walk<'_>,
    pieces: &Pieces,
    mut both: rebracketing::Bracket,
) -> Result<Uncertainty, Ask> {
    let [mut film, groups @ ..] = pieces.clone();
    let target = walk.input.target;
    let others: f64 = groups.iter().map(Uncertainty::half_length).sum();
    if others + least_by_half(walk, both) > target {
        return Ok(film);
    }
    // One run of the scene itself may do what otherwise takes one run on each grid.
    let (low, high) = bracket(walk);
    let halved = 0.5 * walk.share((high - low) / 2);
    if high - low > 1 && others + film.half_length() + halved <= target {
        return Ok(film);
    }
    loop {
        let half = others + search_part(walk).half_length() + film.half_length();
        let own = rebracketing::own(walk);
        let narrower = (both.high - both.low) / 2;
        if half <= target || narrower < 1 {
            return Ok(film);
        }
        match rebracketing::by_half(walk, own, narrower)? {
            Some(now) if now != both => both = now,
            _ => return Ok(film),
        }
        film = Uncertainty::default();
        let estimate = rebracketing::agreed(walk, both);
        film.add(Discretisation::FilmGrid.as_str(), Some(estimate), target);
    }
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
        let (low, high) = bracket(walk);
        let from = rebracketing::Bracket { low, high };
        let nodes = high - low;
        if nodes <= 1 || others.relative_with(walk.share(nodes)) <= target {
            return Ok(());
        }
        if rebracketing::narrowed(walk, Levels::NONE, from, nodes / 2)?.is_none() {
            return Ok(());
        }
    }
}

/// The interval that these contributions make.
pub(super) fn whole(walk: &Walk<'_>, pieces: &Pieces) -> Uncertainty {
    let mut uncertainty = search_part(walk);
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
    /// The contribution of these parameters changed together, or of each alone where together they have no answer. The
    /// interval has `sum` without it, of which `spare` can be halved away. `surrogate` is the cheaper scene found by
    /// re-bracketing.
    fn look(
        &self,
        walk: &mut Walk<'_>,
        margin: Option<&clearance_sensitivity::Reference>,
        surrogate: &mut Option<rebracketing::Surrogate>,
        (sum, spare): (&Uncertainty, f64),
    ) -> Result<Uncertainty, Ask> {
        let limits = Limits::of(walk, sum, spare);
        let mut changed = |walk: &mut Walk<'_>, discretisations: &[Discretisation]| {
            let by_clearance = match margin {
                Some(reference) => reference.discretisations(walk, discretisations, limits)?,
                None => None,
            };
            if by_clearance.is_some() {
                return Ok(by_clearance);
            }
            if surrogate.is_none() {
                *surrogate = rebracketing::film(walk, limits)?.surrogate;
            }
            let (estimate, cheaper) =
                rebracketing::discretisations(walk, discretisations, *surrogate, limits)?;
            if discretisations.len() > 1 {
                *surrogate = cheaper.or(*surrogate);
            }
            Ok(estimate)
        };
        let is_changed =
            |discretisation: &Discretisation| walk.input.discretisations.contains(discretisation);
        let discretisations: Vec<Discretisation> = self
            .discretisations
            .iter()
            .copied()
            .filter(is_changed)
            .collect();
        let target = walk.input.target;
        let mut uncertainty = Uncertainty::default();
        let joint = match discretisations.len() {
            0 => return Ok(uncertainty),
            1 => None,
            _ => changed(walk, &discretisations)?,
        };
        if joint.is_some() {
            uncertainty.add(self.name, joint, target);
            return Ok(uncertainty);
        }
        for discretisation in discretisations {
            let alone = changed(walk, &[discretisation])?;
            uncertainty.add(discretisation.as_str(), alone, target);
        }
        Ok(uncertainty)
    }
}
