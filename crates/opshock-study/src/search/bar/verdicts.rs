//! Reading by verdicts: the critical amplitude of a turned scene itself.

use opshock_solver::scene::knob::{Knob, Levels};

use super::ask::Ask;
use super::judge::{self, Estimate};
use super::limits::Limits;
use super::walk::Walk;
use crate::search::evidence::NodeVerdict;
use crate::search::probe::Retry;

/// Farthest that the answer of turned knobs is looked for, as a share.
const FARTHEST: f64 = 1.0;
/// Growth of the stride while it is looked for: what is passed is halved afterwards.
const GROWTH: i32 = 2;

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
    nodes: 8,
    distance_over: 4,
    farthest: 0.5,
};
/// Farthest answer of a quarter of the cells on which the other knobs are turned where half is known,
/// and that an eighth is held against, as a share: beyond it there is no order.
const NEAR: f64 = 0.05;

/// Brackets the turned scene's answer beginning at `from`. `None` without verdicts or too far away.
fn locate(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    width: Width,
) -> Result<Option<Bracket>, Ask> {
    let farthest = walk.input.lattice.nodes_within(width.farthest);
    let (mut low, mut high) = seen_about(walk, levels, from);
    let mut stride = (from.high - from.low).max(1);
    loop {
        let next = match (low, high) {
            (Some(low), Some(high)) => {
                let distance = (low - from.low).abs().max((high - from.high).abs());
                let part = distance.checked_div(width.distance_over).unwrap_or(0);
                if high - low <= part.max(width.nodes) {
                    return Ok(Some(Bracket { low, high }));
                }
                low + (high - low) / 2
            }
            // The upper end first: a survivor there answers for the lower end too.
            (None, None) => from.high,
            (Some(low), None) if low < from.high => from.high,
            (None, Some(high)) if high > from.low => from.low,
            (Some(low), None) => {
                stride *= GROWTH;
                low + stride / GROWTH
            }
            (None, Some(high)) => {
                stride *= GROWTH;
                high - stride / GROWTH
            }
        };
        if (next - from.low).abs() > farthest {
            return Ok(None);
        }
        match walk.see(levels, next)?.verdict {
            NodeVerdict::Undecided => return Ok(None),
            NodeVerdict::Survives => low = Some(next),
            NodeVerdict::Fails => high = Some(next),
        }
    }
}

/// What was met of a turned scene already at `from` or beyond, where it leads away from there.
fn seen_about(walk: &Walk<'_>, levels: Levels, from: Bracket) -> (Option<i32>, Option<i32>) {
    let levels = walk.input.base.plus(levels);
    let at = |verdict: NodeVerdict| {
        walk.log
            .iter()
            .filter(move |ask| ask.levels == levels && ask.retry == Retry::None)
            .filter(move |&&ask| (walk.lookup)(ask).is_some_and(|seen| seen.verdict == verdict))
            .map(|ask| ask.index)
    };
    let low = at(NodeVerdict::Survives)
        .filter(|&index| index >= from.low)
        .max();
    let high = at(NodeVerdict::Fails)
        .filter(|&index| index <= from.high)
        .min();
    match (low, high) {
        (Some(low), Some(high)) if low >= high => (None, None),
        found => found,
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

/// Half the cells have agreed with the scene in every halving so far, so that more may follow.
pub(super) fn may_go_on(both: Bracket) -> bool {
    both.high - both.low <= OF_FILM.nodes
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

/// A cheaper scene on which knobs are turned, with its bracket.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proxy {
    levels: Levels,
    bracket: Bracket,
}

impl Proxy {
    /// The scene on a film halved so often.
    fn on_film(halvings: i8, bracket: Bracket) -> Proxy {
        Proxy {
            levels: halved(halvings),
            bracket,
        }
    }
}

fn halved(halvings: i8) -> Levels {
    Levels::NONE.turned(Knob::FilmGrid, -halvings)
}

/// The bracket of the scene itself, as wide as the tolerance.
pub(super) fn own(walk: &Walk<'_>) -> Bracket {
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

/// Error of knobs but the film's grid turned together by one step on the scene `found`, and by one
/// step finer where that is not little and the bar may still meet what was asked. The scene with coarser
/// knobs is told, too, where it answers nearby: other knobs are turned with them, which takes fewer steps.
pub(super) fn knobs(
    walk: &mut Walk<'_>,
    knobs: &[Knob],
    found: Option<Proxy>,
    limits: Limits,
) -> Result<(Option<Estimate>, Option<Proxy>), Ask> {
    let Some(found) = found else {
        return Ok((None, None));
    };
    let width = Width {
        nodes: limits.grain,
        distance_over: 4,
        farthest: FARTHEST,
    };
    let proxy = found.levels;
    let Some(base) = narrowed(walk, proxy, found.bracket, limits.grain)? else {
        return Ok((None, None));
    };
    let coarser = judge::coarser(proxy, knobs);
    let Some(coarse) = locate(walk, coarser, base, width)? else {
        return Ok((None, None));
    };
    let cheaper = (distance(walk, base, coarse) <= NEAR).then_some(Proxy {
        levels: coarser,
        bracket: coarse,
    });
    if coarse == base {
        let nodes = base.high - base.low;
        let estimate = judge::agreement(&walk.input.lattice, nodes, knobs);
        return Ok((Some(estimate), cheaper));
    }
    let near = shift(walk, base, coarse);
    let estimate = judge::one_step(knobs, near);
    if !limits.is_worth(estimate.error()) || !walk.has_finer(knobs) {
        return Ok((Some(estimate), cheaper));
    }
    let Some(finer) = locate(walk, judge::finer(proxy, knobs), base, width)? else {
        return Ok((Some(estimate), cheaper));
    };
    // What was seen is certain only up to the brackets it was seen with.
    let sense = match finer == base {
        true => near,
        false => shift(walk, finer, base),
    };
    let fine = distance(walk, base, finer).copysign(sense);
    let mut estimate = judge::with_finer(knobs, near, fine);
    if finer == base {
        estimate = estimate.either_way();
    }
    Ok((Some(estimate), cheaper))
}

/// Halvings of the film from which on coarser films alone tell its error.
pub(super) const DEEP: i8 = 3;

/// What is known of the film's grid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Film {
    /// Its error; `None` where it could not be found.
    pub estimate: Option<Estimate>,
    /// Scene on which the other knobs are turned.
    pub proxy: Option<Proxy>,
    /// Half the cells answer as the scene does, in this bracket.
    pub agreed: Option<Bracket>,
}

impl Film {
    fn new(estimate: Option<Estimate>, proxy: Proxy) -> Film {
        Film {
            estimate,
            proxy: Some(proxy),
            agreed: None,
        }
    }
}

/// Error of the film's grid from half the cells where they answer as the scene does and a quarter does
/// not; else from the answer on a quarter of the cells with that on an eighth. A film that cannot be
/// halved so often is held against half and twice the cells.
///
/// A film is told, too, for the other knobs to be turned on: the coarsest whose answer is near, since
/// an answer far off is another failure.
pub(super) fn film(walk: &mut Walk<'_>, limits: Limits) -> Result<Film, Ask> {
    let own = own(walk);
    if !walk.input.knobs.contains(&Knob::FilmGrid) || walk.input.film_halvings < 1 {
        // Without a film the scene itself is as cheap as it gets.
        return Ok(Film::new(None, Proxy::on_film(0, own)));
    }
    if walk.input.film_halvings < DEEP {
        return by_double(walk, own);
    }
    if limits.room > 0.0
        && !answers_alike(walk, halved(2), own)?
        && let Some(both) = by_half(walk, own, OF_FILM.nodes)?
    {
        let width = Width {
            farthest: NEAR,
            ..OF_FILM
        };
        let near = locate(walk, halved(2), own, width)?
            .filter(|near| distance(walk, own, *near) <= NEAR)
            .map(|near| Proxy::on_film(2, near));
        return Ok(Film {
            estimate: Some(agreed(walk, both)),
            proxy: Some(near.unwrap_or_else(|| Proxy::on_film(1, both))),
            agreed: Some(both),
        });
    }
    let Some((halvings, near)) = quarter(walk, own)? else {
        return Ok(Film::default());
    };
    // One coarse film alone shows no order, and films so coarse have none: one halving counts.
    let has_two = halvings == 2;
    let formal = Knob::FilmGrid.formal_ratio();
    let rise = formal.powi(i32::from(halvings));
    let off = distance(walk, own, near.bracket);
    let coarse = Estimate::unseen(
        off / if has_two { rise - 1.0 } else { formal - 1.0 },
        judge::WIDE,
    );
    if !has_two || off > NEAR {
        return Ok(Film::new(Some(coarse), near));
    }
    let (estimate, coarsest) = with_eighth(walk, own, near, coarse)?;
    Ok(Film::new(Some(estimate), coarsest))
}

/// A turned scene fails and survives where the scene itself does.
fn answers_alike(walk: &mut Walk<'_>, levels: Levels, own: Bracket) -> Result<bool, Ask> {
    // The failure first: it ends early.
    Ok(walk.see(levels, own.high)?.verdict == NodeVerdict::Fails
        && walk.see(levels, own.low)?.verdict == NodeVerdict::Survives)
}

/// A quarter of the cells, half where a quarter has no answer.
fn quarter(walk: &mut Walk<'_>, own: Bracket) -> Result<Option<(i8, Proxy)>, Ask> {
    for halvings in (1..=walk.input.film_halvings.min(2)).rev() {
        if let Some(bracket) = locate(walk, halved(halvings), own, OF_FILM)? {
            return Ok(Some((halvings, Proxy::on_film(halvings, bracket))));
        }
    }
    Ok(None)
}

/// How far above the scene's answer that of twice the cells lies, the brackets of both included, a share. `None`
/// without verdicts or too far away.
pub(super) fn double(walk: &mut Walk<'_>) -> Result<Option<f64>, Ask> {
    let own = own(walk);
    let fine = locate(walk, halved(-1), own, OF_FILM)?;
    Ok(fine.map(|fine| distance(walk, own, fine).copysign(shift(walk, fine, own))))
}

/// From the answers on half and on twice the cells. A film of few cells may fly elsewhere than finer ones
/// do, and coarser ones with it, or they do not fly at all: only a finer one tells. The other knobs
/// are turned on half the cells, on the scene itself where those have no answer.
fn by_double(walk: &mut Walk<'_>, own: Bracket) -> Result<Film, Ask> {
    const FILM: [Knob; 1] = [Knob::FilmGrid];
    // Strides grow fourfold: so far out that no answer between a half and twice the scene's is missed.
    let width = Width {
        nodes: 4,
        distance_over: 4,
        farthest: 7.0,
    };
    // Beside the finer film's runs those of the scene itself cost little.
    let Some(own) = narrowed(walk, Levels::NONE, own, width.nodes)? else {
        return Ok(Film::default());
    };
    let coarse = locate(walk, halved(1), own, width)?;
    let fine = locate(walk, halved(-1), own, width)?;
    let seen = fine.map(|fine| distance(walk, own, fine).copysign(shift(walk, fine, own)));
    let near = coarse.map(|coarse| shift(walk, own, coarse));
    let mut estimate = match (near, seen) {
        (Some(near), Some(seen)) => Some(judge::with_finer(&FILM, near, seen)),
        (None, Some(seen)) => Some(judge::finer_alone(&FILM, seen)),
        (Some(_), None) | (None, None) => None,
    };
    if fine == Some(own) {
        estimate = estimate.map(Estimate::either_way);
    }
    let proxy = match coarse {
        Some(coarse) => Proxy::on_film(1, coarse),
        None => Proxy::on_film(0, own),
    };
    Ok(Film::new(estimate, proxy))
}

/// From the answers on a quarter of the cells, `coarse` by themselves, and an eighth.
///
/// With errors e, ρ²e and ρ³e on all, a quarter and an eighth of the cells, the two answers differ
/// by ρ²(ρ - 1) e, and that on all cells follows: it must lie in the bracket that was found there.
/// What the brackets of the two do not resolve is not told.
fn with_eighth(
    walk: &mut Walk<'_>,
    own: Bracket,
    near: Proxy,
    coarse: Estimate,
) -> Result<(Estimate, Proxy), Ask> {
    let Some(far) = locate(walk, halved(3), near.bracket, OF_FILM)? else {
        return Ok((coarse, near));
    };
    let coarsest = Proxy::on_film(3, far);
    let formal = Knob::FilmGrid.formal_ratio();
    let rise = formal.powi(2);
    let middle = |bracket: Bracket| f64::from(bracket.low + bracket.high) / 2.0;
    let error = (middle(far) - middle(near.bracket)) / (rise * (formal - 1.0));
    let expected = middle(near.bracket) - (rise - 1.0) * error;
    let half = |bracket: Bracket| f64::from(bracket.high - bracket.low) / 2.0;
    let slack = half(near.bracket) + half(far) + 0.5 * error.abs();
    let is_formal =
        expected >= f64::from(own.low) - slack && expected <= f64::from(own.high) + slack;
    // Either answer may lie anywhere in its bracket.
    let resolved = (half(near.bracket) + half(far)) / (rise * (formal - 1.0));
    let share = walk.share_of(error.abs().max(resolved));
    let estimate = match is_formal {
        true => Estimate::unseen(share, judge::NARROW),
        false => Estimate::unseen(coarse.share.max(share), judge::WIDE),
    };
    Ok((estimate, coarsest))
}

/// Bound on the film's error where half the cells answer as the scene does in this bracket.
pub(super) fn agreed(walk: &Walk<'_>, both: Bracket) -> Estimate {
    let nodes = both.high - both.low;
    judge::agreement(&walk.input.lattice, nodes, &[Knob::FilmGrid])
}

/// From half the cells, where they answer as the scene does: both brackets are halved together for as
/// long as they stay one and are wider than `nodes`. Half the cells are asked in the middle first,
/// whose verdict answers for one of the ends.
pub(super) fn by_half(
    walk: &mut Walk<'_>,
    own: Bracket,
    nodes: i32,
) -> Result<Option<Bracket>, Ask> {
    let half = halved(1);
    let mut both = own;
    let mut has_ends = false;
    while both.high - both.low > nodes {
        let middle = both.low + (both.high - both.low) / 2;
        let verdict = walk.see(half, middle)?.verdict;
        let (end, opposite) = match verdict {
            NodeVerdict::Survives => (both.high, NodeVerdict::Fails),
            NodeVerdict::Fails => (both.low, NodeVerdict::Survives),
            NodeVerdict::Undecided => break,
        };
        if !has_ends && walk.see(half, end)?.verdict != opposite {
            return Ok(None);
        }
        has_ends = true;
        if verdict != walk.see(Levels::NONE, middle)?.verdict {
            break;
        }
        match verdict {
            NodeVerdict::Fails => both.high = middle,
            NodeVerdict::Survives | NodeVerdict::Undecided => both.low = middle,
        }
    }
    let is_alike = has_ends || answers_alike(walk, half, own)?;
    Ok(is_alike.then_some(both))
}
