//! Reading by verdicts: the critical amplitude of a turned scene itself.

use opshock_solver::scene::knob::{Knob, Levels};

use super::judge::{self, Estimate};
use super::{Ask, Walk};
use crate::search::evidence::NodeVerdict;

/// Farthest that a turned scene's answer is looked for, as a share.
const FARTHEST: f64 = 0.5;

/// Survivor and failure of a turned scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Bracket {
    low: i32,
    high: i32,
}

/// How narrow a bracket is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    /// One node.
    OneNode,
    /// A quarter of its distance from where the search began: a large shift is known well enough.
    QuarterOfDistance,
}

/// Brackets the turned scene's answer beginning at `from`. `None` without verdicts or too far away.
fn locate(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    width: Width,
) -> Result<Option<Bracket>, Ask> {
    let farthest = walk.input.lattice.nodes_within(FARTHEST);
    let (mut low, mut high) = (None, None);
    let mut next = from.low;
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
                let enough = match width {
                    Width::OneNode => 1,
                    Width::QuarterOfDistance => (distance / 4).max(1),
                };
                if high - low <= enough {
                    return Ok(Some(Bracket { low, high }));
                }
                next = low + (high - low) / 2;
            }
            (Some(low), None) if low < from.high => next = from.high,
            (Some(low), None) => {
                next = low + stride;
                stride *= 2;
            }
            (None, _) => {
                next -= stride;
                stride *= 2;
            }
        }
    }
}

/// A coarser film with its bracket, one node wide.
#[derive(Clone, Copy, Debug)]
struct OnFilm {
    halvings: i8,
    bracket: Bracket,
}

/// The coarsest film, of at most `halvings`, on which the answer is found.
fn on_film(walk: &mut Walk<'_>, halvings: i8) -> Result<Option<OnFilm>, Ask> {
    let own = Bracket {
        low: walk.input.survivor,
        high: walk.input.failure,
    };
    // Without a film the scene itself is as cheap as it gets.
    let has_film = walk.input.knobs.contains(&Knob::FilmGrid);
    let fewest = i8::from(has_film);
    for halvings in (fewest..=halvings.min(walk.input.film_halvings)).rev() {
        let film = Levels::NONE.turned(Knob::FilmGrid, -halvings);
        if let Some(bracket) = locate(walk, film, own, Width::OneNode)? {
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

/// Error of a knob but the film's grid from one or two steps away on the coarsest film.
pub(super) fn knob(walk: &mut Walk<'_>, knob: Knob) -> Result<Option<Estimate>, Ask> {
    let Some(film) = on_film(walk, 3)? else {
        return Ok(None);
    };
    let base = film.bracket;
    let film = Levels::NONE.turned(Knob::FilmGrid, -film.halvings);
    let once = film.turned(knob, judge::step(knob));
    let Some(one) = locate(walk, once, base, Width::QuarterOfDistance)? else {
        return Ok(None);
    };
    if one == base {
        return Ok(Some(judge::agreement(&walk.input.lattice, knob)));
    }
    let first = shift(walk, base, one);
    let estimate = judge::one_step(knob, first);
    // Too little to matter, or so much that the bar exceeds what was asked by this part alone.
    let accuracy = walk.input.accuracy;
    if estimate.share * estimate.factor <= judge::NEGLIGIBLE * accuracy
        || estimate.share * judge::NARROW > 2.0 * accuracy
    {
        return Ok(Some(estimate));
    }
    let twice = once.turned(knob, judge::step(knob));
    let Some(two) = locate(walk, twice, one, Width::QuarterOfDistance)? else {
        return Ok(Some(estimate));
    };
    let second = shift(walk, one, two);
    Ok(Some(judge::two_steps(knob, first, second)))
}

/// Error of the film's grid from the answers on a quarter and an eighth of the cells.
///
/// With errors e, ρ²e and ρ³e on all, a quarter and an eighth of the cells, the two answers differ
/// by ρ²(ρ - 1) e, and that on all cells follows: it must lie in the bracket that was found there.
pub(super) fn film(walk: &mut Walk<'_>) -> Result<Option<Estimate>, Ask> {
    let Some(near) = on_film(walk, 2)? else {
        return Ok(None);
    };
    let formal = Knob::FilmGrid.formal_ratio();
    let own = Bracket {
        low: walk.input.survivor,
        high: walk.input.failure,
    };
    // Against the bracket of the scene itself, as wide as the tolerance.
    let farthest = walk
        .share(near.bracket.high - own.low)
        .abs()
        .max(walk.share(near.bracket.low - own.high).abs());
    let rise = formal.powi(i32::from(near.halvings));
    let coarse = Estimate {
        share: farthest / (rise - 1.0),
        factor: judge::WIDE,
    };
    if near.halvings < 2 {
        return Ok(Some(coarse));
    }
    let far = match on_film(walk, 3)? {
        Some(far) if far.halvings == 3 => far.bracket,
        _ => return Ok(Some(coarse)),
    };
    let middle = |bracket: Bracket| f64::from(bracket.low + bracket.high) / 2.0;
    let error = (middle(far) - middle(near.bracket)) / (rise * (formal - 1.0));
    let expected = middle(near.bracket) - (rise - 1.0) * error;
    let slack = 1.0 + 0.5 * error.abs();
    let is_formal =
        expected >= f64::from(own.low) - slack && expected <= f64::from(own.high) + slack;
    let share = walk.share(error.abs().max(0.5).ceil() as i32);
    Ok(Some(if is_formal {
        Estimate {
            share,
            factor: judge::NARROW,
        }
    } else {
        Estimate {
            share: coarse.share.max(share),
            factor: judge::WIDE,
        }
    }))
}
