//! Climbing: where a bar exceeds what was asked, the knobs with the largest parts are turned finer
//! and the answer is bracketed anew.
//!
//! A climb keeps what it did not touch: only the parts of turned knobs are looked at again, around
//! the new answer, and those that count though their knobs are on the floor, since they were not looked at closely
//! where others had left no room. It ends when the bar meets what was asked, when the last climb allowed is made,
//! or at the floor: every knob whose part counts is [`FLOOR`] steps above the study, the film's [`FILM_FLOOR`]. The
//! mesh of a ramp is turned finer only as long as one of half those elements again can be made to tell its error;
//! where it is too coarse beyond that, other knobs are not turned in vain.

use opshock_solver::scene::knob::{Knob, Levels};

use super::ask::{Ask, BarInput, Known, Progress, SUBNODES, Seen};
use super::parts::{Bar, Part};
use super::pieces::{self, GROUPS, Pieces};
use super::verdicts::{self, Bracket};
use super::walk::{self, Walk};
use crate::search::evidence::NodeVerdict;
use crate::search::outcome::Flag;
use crate::search::probe::Retry;

/// Most steps by which a knob is turned finer than the study has it.
pub const FLOOR: i8 = 3;
/// The same of the film's grid. Films that are squeezed thin come into order late, and only where three of them,
/// the coarsest of a quarter of the cells, agree is their error known.
const FILM_FLOOR: i8 = FLOOR + 1;
/// Parts above this share of what was asked are turned finer: there are three sources.
const COUNTS: f64 = 1.0 / 3.0;
/// Width to which a climbed answer is bracketed, nodes: a quarter of the search's tolerance.
const WIDTH: i32 = SUBNODES / 4;

/// Most steps by which so many climbs turn the film's grid finer: two with the first, then one.
pub fn most_film_steps(climbs: u8) -> i8 {
    match i8::try_from(climbs) {
        Ok(0) => 0,
        Ok(climbs) => climbs.saturating_add(1).min(FILM_FLOOR),
        Err(_) => FILM_FLOOR,
    }
}

/// A critical shock with its bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Knobs turned finer than the study has them.
    pub levels: Levels,
    /// Highest survivor, node of the bar's lattice.
    pub survivor: i32,
    /// Lowest failure.
    pub failure: i32,
    /// Its bar.
    pub bar: Bar,
}

/// The answer of `input` with its bar, as far as `lookup` knows the runs it needs, after at most
/// `climbs` climbs; with the runs looked at.
pub fn answer(
    input: &BarInput,
    climbs: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
) -> (Vec<Ask>, Progress<Answer>) {
    let mut log = Vec::new();
    let progress = match climbed(input, climbs, lookup, &mut log) {
        Ok(mut answer) => {
            if log.iter().any(|ask| ask.retry != Retry::None) {
                answer.bar.flags.insert(Flag::Retry);
            }
            Progress::Done(answer)
        }
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

fn climbed(
    input: &BarInput,
    climbs: u8,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
) -> Result<Answer, Ask> {
    let mut at = input.clone();
    let mut kept = Default::default();
    for left in (0..=climbs).rev() {
        let mut walk = Walk::new(&at, lookup, log);
        let pieces = pieces::pieces(&mut walk, kept)?;
        let bar = pieces::whole(&walk, &pieces);
        let exceeds = bar.flags.contains(&Flag::BarExceeds);
        (at.survivor, at.failure) = walk::bracket(&walk);
        if !exceeds || climbs == 0 {
            return Ok(Answer::of(&at, bar));
        }
        let turned = match left {
            0 => Vec::new(),
            _ => turned(&at, &bar),
        };
        let finer = turned.iter().fold(Levels::NONE, |levels, &(knob, steps)| {
            levels.turned(knob, steps)
        });
        if finer.is_none() {
            return Ok(Answer::of(&at, floored(bar)));
        }
        let next = BarInput {
            base: at.base.plus(finer),
            film_halvings: at.film_halvings + finer.of(Knob::FilmGrid),
            ..at.clone()
        };
        let Some(next) = bracketed(next, lookup, log)? else {
            return Ok(Answer::of(&at, floored(bar)));
        };
        at = next;
        kept = still(&at, &pieces, &turned);
    }
    unreachable!("the last round returns")
}

impl Answer {
    fn of(at: &BarInput, bar: Bar) -> Answer {
        Answer {
            levels: at.base,
            survivor: at.survivor,
            failure: at.failure,
            bar,
        }
    }
}

/// This bar exceeds what was asked and no climb is left.
fn floored(mut bar: Bar) -> Bar {
    bar.flags.insert(Flag::BarFloor);
    bar
}

/// Most steps by which a knob can be turned. A mesh is none whose error nothing finer can tell: what a coarser
/// one alone says of it, thrice, is no less than what both said of the mesh before.
fn floor(at: &BarInput, knob: Knob) -> i8 {
    match knob {
        Knob::RampMesh => FLOOR.min(at.mesh_halvings - 1),
        Knob::FilmGrid => FILM_FLOOR,
        _ => FLOOR,
    }
}

/// Knobs to turn, with the steps that their parts call for: those whose part counts, the largest
/// where none does. A knob on the floor stays. Where nothing is left of them, the largest of the others that
/// the bar would meet what was asked without; so that nothing may be left.
fn turned(at: &BarInput, bar: &Bar) -> Vec<(Knob, i8)> {
    let most = COUNTS * at.accuracy;
    let is_last_mesh = at.base.of(Knob::RampMesh) >= floor(at, Knob::RampMesh);
    let stays = |part: &&Part| part.name == Knob::RampMesh.as_str() && is_last_mesh;
    let mesh = bar.parts.iter().find(stays);
    if mesh.is_some_and(|part| 0.5 * (part.low + part.high) > at.accuracy) {
        return Vec::new();
    }
    let knobs = |name: &str| -> Vec<Knob> {
        let group = GROUPS.iter().find(|group| group.name == name);
        let alone = Knob::from_word(name);
        let all = group.map_or_else(|| alone.into_iter().collect(), |g| g.knobs.to_vec());
        all.into_iter()
            .filter(|knob| at.knobs.contains(knob))
            .filter(|knob| !(*knob == Knob::RampMesh && is_last_mesh))
            .collect()
    };
    let mut parts: Vec<(f64, Vec<Knob>)> = bar
        .parts
        .iter()
        .map(|part| (0.5 * (part.low + part.high), knobs(part.name)))
        .filter(|(_, knobs)| !knobs.is_empty())
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let steps = |half: f64, knobs: &[Knob]| -> Vec<(Knob, i8)> {
        let of = |&knob: &Knob| {
            let level = at.base.of(knob);
            // Far up a step is dear, and may do what its order does not say.
            let called = if level == 0 && half > most * knob.formal_ratio() {
                2
            } else {
                1
            };
            (knob, called.min(floor(at, knob) - level))
        };
        knobs.iter().map(of).filter(|(_, by)| *by > 0).collect()
    };
    let counts = parts.iter().filter(|(half, _)| *half > most).count().max(1);
    let counts = counts.min(parts.len());
    let (counting, others) = parts.split_at(counts);
    let turned: Vec<_> = counting
        .iter()
        .flat_map(|(half, knobs)| steps(*half, knobs))
        .collect();
    if !turned.is_empty() {
        return turned;
    }
    let excess = bar.half_length() - at.accuracy;
    let bought = others.iter().filter(|(half, _)| *half > excess);
    bought
        .map(|(half, knobs)| steps(*half, knobs))
        .find(|turned| !turned.is_empty())
        .unwrap_or_default()
}

/// The answer of a scene turned finer, beginning at the one before. `None` without verdicts.
fn bracketed(
    mut at: BarInput,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
    log: &mut Vec<Ask>,
) -> Result<Option<BarInput>, Ask> {
    let from = Bracket {
        low: at.survivor,
        high: at.failure,
    };
    let mut walk = Walk::new(&at, lookup, log);
    let Some(found) = verdicts::located(&mut walk, from, WIDTH)? else {
        return Ok(None);
    };
    let t_fail_s = walk.see(Levels::NONE, found.high)?.t_min_s;
    // What was seen on the way are the survivors of this rung.
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
        if let (NodeVerdict::Survives, Some(h_min_m), Some(t_min_s)) =
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

/// Pieces of knobs that were not turned, but those that count and can only be looked at closer.
fn still(at: &BarInput, pieces: &Pieces, turned: &[(Knob, i8)]) -> [Option<Bar>; 1 + GROUPS.len()] {
    let is_turned = |knobs: &[Knob]| turned.iter().any(|(knob, _)| knobs.contains(knob));
    let is_on_floor = |knobs: &[Knob]| {
        let mut own = knobs.iter().filter(|knob| at.knobs.contains(knob));
        own.all(|&knob| at.base.of(knob) >= floor(at, knob))
    };
    std::array::from_fn(|place| {
        let knobs = match place {
            0 => &[Knob::FilmGrid][..],
            _ => GROUPS[place - 1].knobs,
        };
        let counts = pieces[place].half_length() > COUNTS * at.accuracy;
        let again = is_turned(knobs) || counts && is_on_floor(knobs);
        (!again).then(|| pieces[place].clone())
    })
}
