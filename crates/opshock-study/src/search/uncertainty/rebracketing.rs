//! Re-bracketing estimate of an error: the critical amplitude of the changed scene is found anew.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::Ask;
use super::judge::{self, Estimate};
use super::limits::Limits;
use super::walk::Walk;
use crate::search::evidence::AmplitudeVerdict;
use crate::search::probe::Retry;

/// Farthest distance at which the answer of a changed scene is looked for, as a share.
const FARTHEST: f64 = 1.0;
/// Growth of the step while it is looked for; what is passed over is halved afterwards.
const GROWTH: i32 = 2;

/// Survivor and failure of a changed scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub low: i32,
    pub high: i32,
}

/// How narrow a bracket is made: a large shift is known well enough.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Width {
    /// Grid steps.
    nodes: i32,
    /// Or the distance from the start of the search over this number; 0: no.
    distance_over: i32,
    /// Farthest distance at which it is looked for, as a share.
    farthest: f64,
}

/// For the coarse films when they are compared with the scene itself.
const OF_FILM: Width = Width {
    nodes: 8,
    distance_over: 4,
    farthest: 0.5,
};
/// Largest distance of the answer on a quarter of the cells for the other parameters to be changed there where half is
/// known, and for an eighth to be compared with it, as a share: beyond it there is no order.
const NEAR: f64 = 0.05;

/// Brackets the changed scene's answer beginning at `from`. `None` without verdicts or too far away.
fn locate(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    width: Width,
) -> Result<Option<Bracket>, Ask> {
    let farthest = walk.input.grid.steps_within(width.farthest);
    let (mut low, mut high) = seen_about(walk, levels, from);
    let mut stride = (from.high - from.low).max(1);
    loop {
        let next = match (low, high) {
            (Some(low), Some(high)) => {
                let distance = (low - from.low).abs().max((high - from.high).abs());
                let fraction = distance.checked_div(width.distance_over).unwrap_or(0);
                if high - low <= fraction.max(width.nodes) {
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
            AmplitudeVerdict::Undecided => return Ok(None),
            AmplitudeVerdict::Survives => low = Some(next),
            AmplitudeVerdict::Fails => high = Some(next),
        }
    }
}

/// Known verdicts of a changed scene at `from` or beyond, where they lead away from there.
fn seen_about(walk: &Walk<'_>, levels: Levels, from: Bracket) -> (Option<i32>, Option<i32>) {
    let levels = walk.input.base.plus(levels);
    let at = |verdict: AmplitudeVerdict| {
        walk.log
            .iter()
            .filter(move |ask| ask.levels == levels && ask.retry == Retry::None)
            .filter(move |&&ask| (walk.lookup)(ask).is_some_and(|seen| seen.verdict == verdict))
            .map(|ask| ask.index)
    };
    let low = at(AmplitudeVerdict::Survives)
        .filter(|&index| index >= from.low)
        .max();
    let high = at(AmplitudeVerdict::Fails)
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

/// Halves a bracket down to `nodes` grid steps. `None` without verdicts.
pub(super) fn narrowed(
    walk: &mut Walk<'_>,
    levels: Levels,
    mut bracket: Bracket,
    nodes: i32,
) -> Result<Option<Bracket>, Ask> {
    while bracket.high - bracket.low > nodes {
        let middle = bracket.low + (bracket.high - bracket.low) / 2;
        match walk.see(levels, middle)?.verdict {
            AmplitudeVerdict::Undecided => return Ok(None),
            AmplitudeVerdict::Survives => bracket.low = middle,
            AmplitudeVerdict::Fails => bracket.high = middle,
        }
    }
    Ok(Some(bracket))
}

/// A cheaper scene on which discretisation parameters are changed, with its bracket.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surrogate {
    levels: Levels,
    bracket: Bracket,
}

impl Surrogate {
    /// The scene on a film halved so many times.
    fn on_film(halvings: i8, bracket: Bracket) -> Surrogate {
        Surrogate {
            levels: halved(halvings),
            bracket,
        }
    }
}

fn halved(halvings: i8) -> Levels {
    Levels::NONE.changed(Discretisation::FilmGrid, -halvings)
}

/// The bracket of the scene itself, as wide as the tolerance.
pub(super) fn own(walk: &Walk<'_>) -> Bracket {
    Bracket {
        low: walk.input.survivor,
        high: walk.input.failure,
    }
}

/// Shift from one bracket to another as a share, of the end that moved farther.
fn shift(walk: &Walk<'_>, from: Bracket, to: Bracket) -> f64 {
    let (low, high) = (to.low - from.low, to.high - from.high);
    walk.share(if low.abs() > high.abs() { low } else { high })
}

/// Largest distance between two answers of which either may lie anywhere in its bracket.
fn distance(walk: &Walk<'_>, a: Bracket, b: Bracket) -> f64 {
    let (up, down) = (walk.share(b.high - a.low), walk.share(b.low - a.high));
    up.abs().max(down.abs())
}

/// Error of parameters other than the film's grid, coarsened together by one step on the scene `found`, and refined by
/// one where that is not little and the interval may still meet the target. Returns the coarsened scene, too, if its
/// answer is near: other parameters are then changed on it, which takes fewer steps.
pub(super) fn discretisations(
    walk: &mut Walk<'_>,
    discretisations: &[Discretisation],
    found: Option<Surrogate>,
    limits: Limits,
) -> Result<(Option<Estimate>, Option<Surrogate>), Ask> {
    let Some(found) = found else {
        return Ok((None, None));
    };
    let width = Width {
        nodes: limits.grain,
        distance_over: 4,
        farthest: FARTHEST,
    };
    let surrogate = found.levels;
    let Some(base) = narrowed(walk, surrogate, found.bracket, limits.grain)? else {
        return Ok((None, None));
    };
    let coarser = judge::coarser(surrogate, discretisations);
    let Some(coarse) = locate(walk, coarser, base, width)? else {
        return Ok((None, None));
    };
    let cheaper = (distance(walk, base, coarse) <= NEAR).then_some(Surrogate {
        levels: coarser,
        bracket: coarse,
    });
    if coarse == base {
        let nodes = base.high - base.low;
        let estimate = judge::agreement(&walk.input.grid, nodes, discretisations);
        return Ok((Some(estimate), cheaper));
    }
    let near = shift(walk, base, coarse);
    let estimate = judge::one_step(discretisations, near);
    if !limits.is_worth(estimate.error()) || !walk.has_finer(discretisations) {
        return Ok((Some(estimate), cheaper));
    }
    let Some(finer) = locate(walk, judge::finer(surrogate, discretisations), base, width)? else {
        return Ok((Some(estimate), cheaper));
    };
    // An observed change is certain only up to the brackets it was observed with.
    let sense = match finer == base {
        true => near,
        false => shift(walk, finer, base),
    };
    let fine = distance(walk, base, finer).copysign(sense);
    let mut estimate = judge::with_finer(discretisations, near, fine);
    if finer == base {
        estimate = estimate.either_way();
    }
    Ok((Some(estimate), cheaper))
}

/// Possible halvings of the film from which on coarser films alone estimate its error.
pub(super) const DEEP: i8 = 3;

/// What is known of the film's grid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Film {
    /// Its error; `None` where it could not be found.
    pub estimate: Option<Estimate>,
    /// Scene on which the other discretisation parameters are changed.
    pub surrogate: Option<Surrogate>,
    /// Half the cells answer as the scene does, in this bracket.
    pub agreed: Option<Bracket>,
}

impl Film {
    fn new(estimate: Option<Estimate>, surrogate: Surrogate) -> Film {
        Film {
            estimate,
            surrogate: Some(surrogate),
            agreed: None,
        }
    }
}

/// Error of the film's grid from half the cells where they answer as the scene does and a quarter does not; else from
/// the answers on a quarter and an eighth of the cells. A film that cannot be halved so many times is compared with
/// half and twice the cells.
///
/// Also returns the film on which the other parameters are changed: the coarsest whose answer is near, since an answer
/// far off belongs to another failure.
pub(super) fn film(walk: &mut Walk<'_>, limits: Limits) -> Result<Film, Ask> {
    let own = own(walk);
    if !walk
        .input
        .discretisations
        .contains(&Discretisation::FilmGrid)
        || walk.input.film_halvings < 1
    {
        // Without a film the scene itself is as cheap as it gets.
        return Ok(Film::new(None, Surrogate::on_film(0, own)));
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
            .map(|near| Surrogate::on_film(2, near));
        return Ok(Film {
            estimate: Some(agreed(walk, both)),
            surrogate: Some(near.unwrap_or_else(|| Surrogate::on_film(1, both))),
            agreed: Some(both),
        });
    }
    let Some((halvings, near)) = quarter(walk, own)? else {
        return Ok(Film::default());
    };
    // One coarse film alone shows no order, and films so coarse have none: one halving is assumed.
    let has_two = halvings == 2;
    let formal = Discretisation::FilmGrid.formal_ratio();
    let rise = formal.powi(i32::from(halvings));
    let off = distance(walk, own, near.bracket);
    let coarse = Estimate::unseen(
        off / if has_two { rise - 1.0 } else { formal - 1.0 },
        judge::FACTOR_NO_ORDER,
    );
    if !has_two || off > NEAR {
        return Ok(Film::new(Some(coarse), near));
    }
    let (estimate, coarsest) = with_eighth(walk, own, near, coarse)?;
    Ok(Film::new(Some(estimate), coarsest))
}

/// A changed scene fails and survives where the scene itself does.
fn answers_alike(walk: &mut Walk<'_>, levels: Levels, own: Bracket) -> Result<bool, Ask> {
    // The failure first: it ends early.
    Ok(
        walk.see(levels, own.high)?.verdict == AmplitudeVerdict::Fails
            && walk.see(levels, own.low)?.verdict == AmplitudeVerdict::Survives,
    )
}

/// A quarter of the cells, half where a quarter has no answer.
fn quarter(walk: &mut Walk<'_>, own: Bracket) -> Result<Option<(i8, Surrogate)>, Ask> {
    for halvings in (1..=walk.input.film_halvings.min(2)).rev() {
        if let Some(bracket) = locate(walk, halved(halvings), own, OF_FILM)? {
            return Ok(Some((halvings, Surrogate::on_film(halvings, bracket))));
        }
    }
    Ok(None)
}

/// Distance of the answer on twice the cells above the scene's, including both brackets, a share. `None` without
/// verdicts or too far away.
pub(super) fn double(walk: &mut Walk<'_>) -> Result<Option<f64>, Ask> {
    let own = own(walk);
    let fine = locate(walk, halved(-1), own, OF_FILM)?;
    Ok(fine.map(|fine| distance(walk, own, fine).copysign(shift(walk, fine, own))))
}

/// From the answers on half and on twice the cells. A film of few cells, and coarser ones with it, may have another
/// flying state than finer ones, or none: only a finer one shows that. The other parameters are changed on half the
/// cells, or on the scene itself where those have no answer.
fn by_double(walk: &mut Walk<'_>, own: Bracket) -> Result<Film, Ask> {
    const FILM: [Discretisation; 1] = [Discretisation::FilmGrid];
    // Looked for so far out that no answer between a half and twice the scene's is missed.
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
    let surrogate = match coarse {
        Some(coarse) => Surrogate::on_film(1, coarse),
        None => Surrogate::on_film(0, own),
    };
    Ok(Film::new(estimate, surrogate))
}

/// From the answers on a quarter of the cells, `coarse` their estimate alone, and on an eighth.
///
/// With errors e, ρ²e and ρ³e on all, a quarter and an eighth of the cells, the two answers differ by ρ²(ρ - 1) e, and
/// that on all cells follows: it must lie in the bracket that was found there. An error below the resolution of both
/// brackets is bounded by that resolution.
fn with_eighth(
    walk: &mut Walk<'_>,
    own: Bracket,
    near: Surrogate,
    coarse: Estimate,
) -> Result<(Estimate, Surrogate), Ask> {
    let Some(far) = locate(walk, halved(3), near.bracket, OF_FILM)? else {
        return Ok((coarse, near));
    };
    let coarsest = Surrogate::on_film(3, far);
    let formal = Discretisation::FilmGrid.formal_ratio();
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
        true => Estimate::unseen(share, judge::FACTOR_FORMAL_ORDER),
        false => Estimate::unseen(coarse.share.max(share), judge::FACTOR_NO_ORDER),
    };
    Ok((estimate, coarsest))
}

/// Bound on the film's error where half the cells answer as the scene does in this bracket.
pub(super) fn agreed(walk: &Walk<'_>, both: Bracket) -> Estimate {
    let nodes = both.high - both.low;
    judge::agreement(&walk.input.grid, nodes, &[Discretisation::FilmGrid])
}

/// From half the cells, where they answer as the scene does: both brackets are halved together while they remain equal
/// and are wider than `nodes`. Half the cells are simulated in the middle first, whose verdict answers for one of the
/// ends.
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
            AmplitudeVerdict::Survives => (both.high, AmplitudeVerdict::Fails),
            AmplitudeVerdict::Fails => (both.low, AmplitudeVerdict::Survives),
            AmplitudeVerdict::Undecided => break,
        };
        if !has_ends && walk.see(half, end)?.verdict != opposite {
            return Ok(None);
        }
        has_ends = true;
        if verdict != walk.see(Levels::NONE, middle)?.verdict {
            break;
        }
        match verdict {
            AmplitudeVerdict::Fails => both.high = middle,
            AmplitudeVerdict::Survives | AmplitudeVerdict::Undecided => both.low = middle,
        }
    }
    let is_alike = has_ends || answers_alike(walk, half, own)?;
    Ok(is_alike.then_some(both))
}
