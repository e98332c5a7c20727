//! Reading by verdicts: the critical amplitude of a turned scene itself.

use opshock_solver::scene::knob::{Knob, Levels};

use super::judge::{self, Estimate};
use super::{Ask, Limits, Walk};
use crate::search::evidence::NodeVerdict;

/// Farthest that the answer of turned knobs is looked for, as a share.
const FARTHEST: f64 = 1.0;
/// Growth of the stride while it is looked for: most of what is passed survives, which is dear.
const GROWTH: i32 = 4;

/// Survivor and failure of a turned scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub low: i32,
    pub high: i32,
}

/// How narrow a bracket is made: a large shift is known well enough.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Width {
    /// Nodes.
    nodes: i32,
    /// Or this part of its distance from where the search began; 0: no.
    distance_over: i32,
    /// Farthest that it is looked for, as a share.
    farthest: f64,
}

/// Of the coarse films when they are held against the scene itself.
const OF_FILM: Width = Width {
    nodes: 4,
    distance_over: 4,
    farthest: 0.5,
};

/// Brackets the turned scene's answer beginning at `from`. `None` without verdicts or too far away.
fn locate(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    width: Width,
) -> Result<Option<Bracket>, Ask> {
    let farthest = walk.input.lattice.nodes_within(width.farthest);
    let (mut low, mut high) = (None, None);
    // The upper end first: a survivor there answers for the lower end too.
    let mut next = from.high;
    let mut stride = (from.high - from.low).max(1);
    loop {
        if (next - from.low).abs() > farthest {
            return Ok(None);
        }
        match walk.see(levels, next)?.verdict {
            NodeVerdict::Undecided => return Ok(None),
            NodeVerdict::Survives => low = Some(next),
            NodeVerdict::Fails => high = Some(next),
        }
        match (low, high) {
            (Some(low), Some(high)) => {
                let distance = (low - from.low).abs().max((high - from.high).abs());
                let part = distance.checked_div(width.distance_over).unwrap_or(0);
                let enough = part.max(width.nodes);
                if high - low <= enough {
                    return Ok(Some(Bracket { low, high }));
                }
                next = low + (high - low) / 2;
            }
            (Some(low), None) => {
                next = low + stride;
                stride *= GROWTH;
            }
            (None, Some(high)) if high > from.low => next = from.low,
            (None, _) => {
                next -= stride;
                stride *= GROWTH;
            }
        }
    }
}

/// Brackets the answer of the scene as it is, beginning at `from`, down to `nodes`.
pub(super) fn located(
    walk: &mut Walk<'_>,
    from: Bracket,
    nodes: i32,
) -> Result<Option<Bracket>, Ask> {
    let width = Width {
        nodes,
        distance_over: 0,
        farthest: FARTHEST,
    };
    locate(walk, Levels::NONE, from, width)
}

/// Halves a bracket down to `nodes`. `None` without verdicts.
pub(super) fn narrowed(
    walk: &mut Walk<'_>,
    levels: Levels,
    mut bracket: Bracket,
    nodes: i32,
) -> Result<Option<Bracket>, Ask> {
    while bracket.high - bracket.low > nodes {
        let middle = bracket.low + (bracket.high - bracket.low) / 2;
        match walk.see(levels, middle)?.verdict {
            NodeVerdict::Undecided => return Ok(None),
            NodeVerdict::Survives => bracket.low = middle,
            NodeVerdict::Fails => bracket.high = middle,
        }
    }
    Ok(Some(bracket))
}

/// A coarser film with its bracket.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnFilm {
    halvings: i8,
    bracket: Bracket,
}

fn halved(halvings: i8) -> Levels {
    Levels::NONE.turned(Knob::FilmGrid, -halvings)
}

/// The bracket of the scene itself, as wide as the tolerance.
fn own(walk: &Walk<'_>) -> Bracket {
    Bracket {
        low: walk.input.survivor,
        high: walk.input.failure,
    }
}

/// The coarsest film, of at most `halvings`, on which the answer is found.
fn on_film(walk: &mut Walk<'_>, halvings: i8, width: Width) -> Result<Option<OnFilm>, Ask> {
    let own = own(walk);
    // Without a film the scene itself is as cheap as it gets.
    let has_film = walk.input.knobs.contains(&Knob::FilmGrid);
    let fewest = i8::from(has_film);
    for halvings in (fewest..=halvings.min(walk.input.film_halvings)).rev() {
        if let Some(bracket) = locate(walk, halved(halvings), own, width)? {
            return Ok(Some(OnFilm { halvings, bracket }));
        }
    }
    Ok(None)
}

/// Shift from one bracket to another as a share; the larger end counts.
fn shift(walk: &Walk<'_>, from: Bracket, to: Bracket) -> f64 {
    let (low, high) = (to.low - from.low, to.high - from.high);
    walk.share(if low.abs() > high.abs() { low } else { high })
}

/// Error of knobs but the film's grid turned together by one step on the coarsest film, of one knob
/// by two where that is neither little nor too much. `known`: the film found by [`film`].
pub(super) fn knobs(
    walk: &mut Walk<'_>,
    knobs: &[Knob],
    known: Option<OnFilm>,
    limits: Limits,
) -> Result<Option<Estimate>, Ask> {
    let plain = Width {
        nodes: limits.grain,
        distance_over: 0,
        farthest: OF_FILM.farthest,
    };
    let quarter = Width {
        nodes: limits.grain,
        distance_over: 4,
        farthest: FARTHEST,
    };
    let found = match known {
        Some(film) => Some(film),
        None => on_film(walk, 3, plain)?,
    };
    let Some(found) = found else {
        return Ok(None);
    };
    let film = halved(found.halvings);
    let Some(base) = narrowed(walk, film, found.bracket, limits.grain)? else {
        return Ok(None);
    };
    let once = judge::coarser(film, knobs);
    let Some(one) = locate(walk, once, base, quarter)? else {
        return Ok(None);
    };
    if one == base {
        let nodes = base.high - base.low;
        return Ok(Some(judge::agreement(&walk.input.lattice, nodes, knobs)));
    }
    let first = shift(walk, base, one);
    let estimate = judge::one_step(knobs, first);
    if limits.is_enough(knobs, estimate, walk.input.accuracy) {
        return Ok(Some(estimate));
    }
    let Some(two) = locate(walk, judge::coarser(once, knobs), one, quarter)? else {
        return Ok(Some(estimate));
    };
    let second = shift(walk, one, two);
    Ok(Some(judge::two_steps(knobs, first, second)))
}

/// Error of the film's grid from the answers on a quarter and an eighth of the cells.
///
/// With errors e, ρ²e and ρ³e on all, a quarter and an eighth of the cells, the two answers differ
/// by ρ²(ρ - 1) e, and that on all cells follows: it must lie in the bracket that was found there.
///
/// The coarsest film is told, too: on it the other knobs are turned.
pub(super) fn film(walk: &mut Walk<'_>) -> Result<(Option<Estimate>, Option<OnFilm>), Ask> {
    let Some(near) = on_film(walk, 2, OF_FILM)? else {
        return Ok((None, None));
    };
    let formal = Knob::FilmGrid.formal_ratio();
    let own = own(walk);
    let farthest = walk
        .share(near.bracket.high - own.low)
        .abs()
        .max(walk.share(near.bracket.low - own.high).abs());
    let rise = formal.powi(i32::from(near.halvings));
    // One coarse film alone shows no order, and films so coarse have none: one halving counts.
    let has_two = near.halvings == 2 && walk.input.film_halvings >= 3;
    let coarse = Estimate {
        share: farthest / if has_two { rise - 1.0 } else { formal - 1.0 },
        factor: judge::WIDE,
    };
    if !has_two {
        return Ok((Some(coarse), Some(near)));
    }
    let Some(far) = locate(walk, halved(3), near.bracket, OF_FILM)? else {
        return Ok((Some(coarse), Some(near)));
    };
    let coarsest = OnFilm {
        halvings: 3,
        bracket: far,
    };
    let middle = |bracket: Bracket| f64::from(bracket.low + bracket.high) / 2.0;
    let error = (middle(far) - middle(near.bracket)) / (rise * (formal - 1.0));
    let expected = middle(near.bracket) - (rise - 1.0) * error;
    let half = |bracket: Bracket| f64::from(bracket.high - bracket.low) / 2.0;
    let slack = half(near.bracket) + half(far) + 0.5 * error.abs();
    let is_formal =
        expected >= f64::from(own.low) - slack && expected <= f64::from(own.high) + slack;
    let share = walk.share(error.abs().max(0.5).ceil() as i32);
    let estimate = if is_formal {
        Estimate {
            share,
            factor: judge::NARROW,
        }
    } else {
        Estimate {
            share: coarse.share.max(share),
            factor: judge::WIDE,
        }
    };
    Ok((Some(estimate), Some(coarsest)))
}
