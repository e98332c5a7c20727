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
/// Farthest answer of a film on which the other knobs are turned, as a share.
const NEAR: f64 = 0.05;

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

/// Shift from one bracket to another as a share; the larger end counts.
fn shift(walk: &Walk<'_>, from: Bracket, to: Bracket) -> f64 {
    let (low, high) = (to.low - from.low, to.high - from.high);
    walk.share(if low.abs() > high.abs() { low } else { high })
}

/// Largest distance between two answers of which either may lie anywhere in its bracket.
fn distance(walk: &Walk<'_>, a: Bracket, b: Bracket) -> f64 {
    let (up, down) = (walk.share(b.high - a.low), walk.share(b.low - a.high));
    up.abs().max(down.abs())
}

/// Error of knobs but the film's grid turned together by one step on the film found by [`film`], and
/// by one step finer where that is not little and the bar may still meet what was asked.
pub(super) fn knobs(
    walk: &mut Walk<'_>,
    knobs: &[Knob],
    found: Option<OnFilm>,
    limits: Limits,
) -> Result<Option<Estimate>, Ask> {
    let Some(found) = found else {
        return Ok(None);
    };
    let width = Width {
        nodes: limits.grain,
        distance_over: 4,
        farthest: FARTHEST,
    };
    let film = halved(found.halvings);
    let Some(base) = narrowed(walk, film, found.bracket, limits.grain)? else {
        return Ok(None);
    };
    let Some(coarse) = locate(walk, judge::coarser(film, knobs), base, width)? else {
        return Ok(None);
    };
    let nodes = base.high - base.low;
    if coarse == base {
        return Ok(Some(judge::agreement(&walk.input.lattice, nodes, knobs)));
    }
    let near = shift(walk, base, coarse);
    let estimate = judge::one_step(knobs, near);
    if !limits.is_worth(estimate.error()) {
        return Ok(Some(estimate));
    }
    let Some(finer) = locate(walk, judge::finer(film, knobs), base, width)? else {
        return Ok(Some(estimate));
    };
    // What was seen is certain only up to the brackets it was seen with.
    let sense = match finer == base {
        true => near,
        false => shift(walk, finer, base),
    };
    let fine = distance(walk, base, finer).copysign(sense);
    Ok(Some(judge::with_finer(knobs, near, fine)))
}

/// Error of the film's grid from the answer on a quarter of the cells: with that on half where it is
/// another than the scene's and half may tell better, else with that on an eighth.
///
/// A film is told, too, for the other knobs to be turned on: the coarsest whose answer is near, since
/// an answer far off is another failure.
pub(super) fn film(
    walk: &mut Walk<'_>,
    limits: Limits,
) -> Result<(Option<Estimate>, Option<OnFilm>), Ask> {
    let own = own(walk);
    if !walk.input.knobs.contains(&Knob::FilmGrid) || walk.input.film_halvings < 1 {
        // Without a film the scene itself is as cheap as it gets.
        let itself = OnFilm {
            halvings: 0,
            bracket: own,
        };
        return Ok((None, Some(itself)));
    }
    let Some(near) = quarter(walk, own)? else {
        return Ok((None, None));
    };
    // One coarse film alone shows no order, and films so coarse have none: one halving counts.
    let has_two = near.halvings == 2 && walk.input.film_halvings >= 3;
    let formal = Knob::FilmGrid.formal_ratio();
    let rise = formal.powi(i32::from(near.halvings));
    let coarse = Estimate::unseen(
        distance(walk, own, near.bracket) / if has_two { rise - 1.0 } else { formal - 1.0 },
        judge::WIDE,
    );
    let is_alike = near.bracket.low >= own.low && near.bracket.high <= own.high;
    let half = match !is_alike && near.halvings == 2 && limits.is_worth(coarse.error()) {
        true => by_half(walk, own)?,
        false => None,
    };
    if let Some((half, on_half)) = half {
        let is_near = distance(walk, own, near.bracket) <= NEAR;
        return Ok((Some(half), Some(if is_near { near } else { on_half })));
    }
    if !has_two {
        return Ok((Some(coarse), Some(near)));
    }
    let (estimate, coarsest) = with_eighth(walk, own, near, coarse)?;
    Ok((Some(estimate), Some(coarsest)))
}

/// A quarter of the cells, half where a quarter has no answer.
fn quarter(walk: &mut Walk<'_>, own: Bracket) -> Result<Option<OnFilm>, Ask> {
    for halvings in (1..=walk.input.film_halvings.min(2)).rev() {
        if let Some(bracket) = locate(walk, halved(halvings), own, OF_FILM)? {
            return Ok(Some(OnFilm { halvings, bracket }));
        }
    }
    Ok(None)
}

/// From the answers on a quarter of the cells, `coarse` by themselves, and an eighth.
///
/// With errors e, ρ²e and ρ³e on all, a quarter and an eighth of the cells, the two answers differ
/// by ρ²(ρ - 1) e, and that on all cells follows: it must lie in the bracket that was found there.
fn with_eighth(
    walk: &mut Walk<'_>,
    own: Bracket,
    near: OnFilm,
    coarse: Estimate,
) -> Result<(Estimate, OnFilm), Ask> {
    let Some(far) = locate(walk, halved(3), near.bracket, OF_FILM)? else {
        return Ok((coarse, near));
    };
    let coarsest = OnFilm {
        halvings: 3,
        bracket: far,
    };
    let formal = Knob::FilmGrid.formal_ratio();
    let rise = formal.powi(2);
    let middle = |bracket: Bracket| f64::from(bracket.low + bracket.high) / 2.0;
    let error = (middle(far) - middle(near.bracket)) / (rise * (formal - 1.0));
    let expected = middle(near.bracket) - (rise - 1.0) * error;
    let half = |bracket: Bracket| f64::from(bracket.high - bracket.low) / 2.0;
    let slack = half(near.bracket) + half(far) + 0.5 * error.abs();
    let is_formal =
        expected >= f64::from(own.low) - slack && expected <= f64::from(own.high) + slack;
    let share = walk.share(error.abs().max(0.5).ceil() as i32);
    let estimate = match is_formal {
        true => Estimate::unseen(share, judge::NARROW),
        false => Estimate::unseen(coarse.share.max(share), judge::WIDE),
    };
    Ok((estimate, coarsest))
}

/// From half the cells, where they answer as the scene does: both brackets are halved together for as
/// long as they stay one, and its width bounds the change.
fn by_half(walk: &mut Walk<'_>, own: Bracket) -> Result<Option<(Estimate, OnFilm)>, Ask> {
    let half = halved(1);
    // The failure first: it ends early.
    if walk.see(half, own.high)?.verdict != NodeVerdict::Fails
        || walk.see(half, own.low)?.verdict != NodeVerdict::Survives
    {
        return Ok(None);
    }
    let mut both = own;
    while both.high - both.low > OF_FILM.nodes {
        let middle = both.low + (both.high - both.low) / 2;
        let verdict = walk.see(half, middle)?.verdict;
        if verdict != walk.see(Levels::NONE, middle)?.verdict {
            break;
        }
        match verdict {
            NodeVerdict::Undecided => break,
            NodeVerdict::Survives => both.low = middle,
            NodeVerdict::Fails => both.high = middle,
        }
    }
    let nodes = both.high - both.low;
    let estimate = judge::agreement(&walk.input.lattice, nodes, &[Knob::FilmGrid]);
    let on_half = OnFilm {
        halvings: 1,
        bracket: both,
    };
    Ok(Some((estimate, on_half)))
}
