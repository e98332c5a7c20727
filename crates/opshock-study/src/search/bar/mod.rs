//! Error bar of a critical shock: what search and resolution add, part by part.
//!
//! Each part asks what the answer would be if one knob were turned a step coarser ([`Knob`]), so
//! that its runs cost less than those of the search, and a step finer where that is not little. All
//! knobs but the film's grid are turned on a film of a quarter or an eighth of the cells (half where
//! those answer otherwise), because what such a knob changes hardly depends on the film; and together, in
//! groups (`GROUPS`): of disk and ramp, of the head, and the mesh of a ramp from geometry. Only where a
//! group turned together has no answer is each of its knobs turned alone.
//! Two readings turn runs into amplitude:
//!
//! * *margin* (`margin`): where the smallest clearance falls steadily to zero at the instant at
//!   which the lowest failure touches, δA = δh / |dh/dA|, a run per group;
//! * *verdicts* (`verdicts`): where survival ends abruptly (a dimple opens, the slider is thrown),
//!   the critical amplitude of each turned scene itself, bracketed to an eighth of the tolerance
//!   or to a 16th of what is in the bar already, an eighth where that exceeds what was asked.
//!
//! An estimate that shows the knob's formal order is multiplied by 1.25, any other by 3 (Roache
//! 1994, J. Fluids Eng. 116, 405); the change seen by turning finer is certain and on the side to which it led,
//! and only what is left beyond it is multiplied, either way. Parts add up on both sides; none takes from
//! another. An error of e above is the ratio 1 + e, and so is one below.
//!
//! Where the margin tells the answer, the film's grid is judged by films held still at the lowest attitude
//! ([`Knob::HeldFilm`]), as far as they say of a quarter of the cells, or of half, what those answered.
//!
//! [`bar`] is a function of what was simulated: called again with more known runs it goes further,
//! and the runs it looks at, in that order, are the canonical sequence of the bar.

mod ask;
mod climb;
mod judge;
mod margin;
#[cfg(test)]
mod tests;
mod verdicts;
mod walk;

use std::collections::BTreeSet;

use opshock_solver::scene::knob::{Knob, Levels};

pub use self::ask::{Ask, BarInput, Known, Progress, SUBNODES, Seen};
pub use self::climb::{Answer, FLOOR, answer, most_film_steps};
use self::judge::Estimate;
use self::walk::{Walk, bracket, fails_below};
use super::outcome::Flag;

/// Knobs that are first turned together.
struct Group {
    /// Name of their common part.
    name: &'static str,
    knobs: &'static [Knob],
}

const GROUPS: [Group; 3] = [
    // Alone: its order is another one, and only some studies have it.
    Group {
        name: "ramp_mesh",
        knobs: &[Knob::RampMesh],
    },
    Group {
        name: "structure",
        knobs: &[Knob::DiskModes, Knob::StructureStep],
    },
    // So coarse at once, they may fail where none of them does.
    Group {
        name: "head",
        knobs: &[
            Knob::SuspensionModes,
            Knob::HeadTolerance,
            Knob::CouplingTolerance,
        ],
    },
];

/// Part of what a bar holds already to which brackets of further parts are narrowed.
const GRAIN: f64 = 1.0 / 16.0;
/// The same where the bar exceeds what was asked whatever they say.
const COARSE_GRAIN: f64 = 1.0 / 8.0;

/// Narrowest bracket of turned knobs, nodes.
const FINEST: i32 = 2;

/// One part of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// `search`, the knob's word or that of a group.
    pub name: &'static str,
    /// Below the reported value, as a share of it.
    pub low: f64,
    /// Above the reported value, as a share of it.
    pub high: f64,
    /// Factor of safety in it: 1 for a certain bound.
    pub factor: f64,
}

/// An error bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Its parts.
    pub parts: Vec<Part>,
    /// What a reader must know of it.
    pub flags: BTreeSet<Flag>,
}

impl Bar {
    /// Adds a part; one that is not known is said to be missing.
    fn add(&mut self, name: &'static str, estimate: Option<Estimate>, accuracy: f64) {
        let Some(estimate) = estimate else {
            self.flags.insert(Flag::BarPartial);
            return;
        };
        let [below, above] = estimate.errors();
        self.parts.push(Part {
            name,
            // The ratio 1 + e downwards.
            low: below / (1.0 + below),
            high: above,
            factor: estimate.factor,
        });
        if estimate.factor == judge::WIDE && !estimate.is_negligible(accuracy) {
            self.flags.insert(Flag::BarWide);
        }
    }

    fn extend(&mut self, other: &Bar) {
        self.parts.extend(&other.parts);
        self.flags.extend(&other.flags);
    }

    /// Half the bar's length over the reported value: what is compared with the accuracy asked.
    pub fn half_length(&self) -> f64 {
        0.5 * self
            .parts
            .iter()
            .map(|part| part.low + part.high)
            .sum::<f64>()
    }
}

/// The bar of `input` as far as `lookup` knows the runs it needs, with the runs looked at.
pub fn bar(input: &BarInput, lookup: &dyn Fn(Ask) -> Option<Seen>) -> (Vec<Ask>, Progress) {
    let mut log = Vec::new();
    let progress = match parts(&mut Walk::new(input, lookup, &mut log)) {
        Ok(bar) => Progress::Done(bar),
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

/// What the bracket alone adds.
fn search_part(walk: &Walk<'_>) -> Bar {
    let (survivor, failure) = bracket(walk);
    let search = Part {
        name: "search",
        low: 0.0,
        high: walk.share(failure - survivor),
        factor: 1.0,
    };
    Bar {
        parts: vec![search],
        flags: BTreeSet::new(),
    }
}

/// What each source of error adds: the film's grid, then [`GROUPS`].
type Pieces = [Bar; 1 + GROUPS.len()];

/// Looks at every source that is not `kept` from before.
fn pieces(walk: &mut Walk<'_>, kept: [Option<Bar>; 1 + GROUPS.len()]) -> Result<Pieces, Ask> {
    let input = walk.input;
    let margin = match input.knobs.is_empty() {
        true => None,
        false => margin::Reference::find(walk)?,
    };
    let [film, groups @ ..] = kept;
    let (mut proxy, mut agreed) = (None, None);
    let mut sum = search_part(walk);
    let film = match film {
        Some(film) => film,
        None => {
            let mut film = Bar::default();
            if input.knobs.contains(&Knob::FilmGrid) {
                let by_margin = match &margin {
                    Some(reference) => reference.film(walk, Limits::of(walk, &sum, 0.0))?,
                    None => None,
                };
                let found = match by_margin {
                    Some(_) => verdicts::Film {
                        estimate: by_margin,
                        ..Default::default()
                    },
                    None => {
                        let limits = Limits::of(walk, &sum, 0.0);
                        verdicts::film(walk, limits)?
                    }
                };
                (proxy, agreed) = (found.proxy, found.agreed);
                film.add(Knob::FilmGrid.as_str(), found.estimate, input.accuracy);
            }
            film
        }
    };
    // What halving on would take off the film's part and the bracket is room for the others.
    let spare = match agreed {
        Some(both) if verdicts::may_go_on(both) => {
            sum = search_part(walk);
            sum.half_length() + film.half_length() - least_by_half(walk, both)
        }
        _ => 0.0,
    };
    sum.extend(&film);
    let mut found = [film, Bar::default(), Bar::default(), Bar::default()];
    // The head first: with its knobs loose the structure costs half as much to compare.
    for (place, (group, kept)) in GROUPS.iter().zip(groups).enumerate().rev() {
        let piece = match kept {
            Some(piece) => piece,
            None => group.look(walk, margin.as_ref(), &mut proxy, (&sum, spare))?,
        };
        sum.extend(&piece);
        found[place + 1] = piece;
    }
    if let Some(both) = agreed.filter(|&both| verdicts::may_go_on(both)) {
        found[0] = narrow_film(walk, &found, both)?;
    }
    narrow_bracket(walk, &found)?;
    Ok(found)
}

/// Least that bracket and film can come to where half the cells agree with the scene.
fn least_by_half(walk: &Walk<'_>, both: verdicts::Bracket) -> f64 {
    let one = verdicts::Bracket {
        high: both.low + 1,
        ..both
    };
    0.5 * walk.share(1) + verdicts::agreed(walk, one).error()
}

/// Film's part after its bracket, in which half the cells agree with the scene, was halved on for as
/// long as the bar exceeds what was asked and that can mend it.
fn narrow_film(
    walk: &mut Walk<'_>,
    pieces: &Pieces,
    mut both: verdicts::Bracket,
) -> Result<Bar, Ask> {
    let [mut film, groups @ ..] = pieces.clone();
    let accuracy = walk.input.accuracy;
    let others: f64 = groups.iter().map(Bar::half_length).sum();
    if others + least_by_half(walk, both) > accuracy {
        return Ok(film);
    }
    // One run of the scene itself may do what takes one of each.
    let (low, high) = bracket(walk);
    let halved = 0.5 * walk.share((high - low) / 2);
    if high - low > 1 && others + film.half_length() + halved <= accuracy {
        return Ok(film);
    }
    loop {
        let half = others + search_part(walk).half_length() + film.half_length();
        let own = verdicts::own(walk);
        let narrower = (both.high - both.low) / 2;
        if half <= accuracy || narrower < 1 {
            return Ok(film);
        }
        match verdicts::by_half(walk, own, narrower)? {
            Some(now) if now != both => both = now,
            _ => return Ok(film),
        }
        film = Bar::default();
        let estimate = verdicts::agreed(walk, both);
        film.add(Knob::FilmGrid.as_str(), Some(estimate), accuracy);
    }
}

/// Halves the bracket of the scene itself, to a node if need be, where that alone meets what was asked and until
/// it does.
fn narrow_bracket(walk: &mut Walk<'_>, pieces: &Pieces) -> Result<(), Ask> {
    let accuracy = walk.input.accuracy;
    let others: f64 = pieces.iter().map(Bar::half_length).sum();
    if others + 0.5 * walk.share(1) > accuracy {
        return Ok(());
    }
    loop {
        let (low, high) = bracket(walk);
        let from = verdicts::Bracket { low, high };
        let nodes = high - low;
        if nodes <= 1 || others + 0.5 * walk.share(nodes) <= accuracy {
            return Ok(());
        }
        if verdicts::narrowed(walk, Levels::NONE, from, nodes / 2)?.is_none() {
            return Ok(());
        }
    }
}

/// The bar that these pieces make.
fn whole(walk: &Walk<'_>, pieces: &Pieces) -> Bar {
    let mut bar = search_part(walk);
    for piece in pieces {
        bar.extend(piece);
    }
    if !walk.input.knobs.is_empty() && bar.half_length() > walk.input.accuracy {
        bar.flags.insert(Flag::BarExceeds);
    }
    if fails_below(walk) {
        bar.flags.insert(Flag::NonMonotone);
    }
    bar
}

fn parts(walk: &mut Walk<'_>) -> Result<Bar, Ask> {
    let pieces = pieces(walk, Default::default())?;
    Ok(whole(walk, &pieces))
}

/// How closely knobs are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limits {
    /// Nodes to which brackets are narrowed.
    grain: i32,
    /// Error that needs no closer look, a share.
    little: f64,
    /// What may still be added before the bar exceeds what was asked, a share; negative beyond.
    room: f64,
}

impl Limits {
    /// For a bar that holds `sum` already, of which `spare` can be halved away.
    fn of(walk: &Walk<'_>, sum: &Bar, spare: f64) -> Limits {
        let (half, accuracy) = (sum.half_length(), walk.input.accuracy);
        let room = accuracy - half + spare;
        let grain = if room > 0.0 { GRAIN } else { COARSE_GRAIN };
        Limits {
            grain: walk.nodes(grain * 2.0 * half).max(FINEST),
            little: judge::NEGLIGIBLE * accuracy.max(half),
            room,
        }
    }

    /// A closer look that is dear may bring the bar below what was asked.
    fn is_worth(self, error: f64) -> bool {
        error > self.little && error > self.room && self.room > 0.0
    }
}

impl Group {
    /// The part of its knobs turned together, or those of each of them where turned together they
    /// have no answer. The bar holds `sum` without it, of which `spare` can be halved away; `proxy` is the
    /// cheap scene found by verdicts.
    fn look(
        &self,
        walk: &mut Walk<'_>,
        margin: Option<&margin::Reference>,
        proxy: &mut Option<verdicts::Proxy>,
        (sum, spare): (&Bar, f64),
    ) -> Result<Bar, Ask> {
        let limits = Limits::of(walk, sum, spare);
        let mut turned = |walk: &mut Walk<'_>, knobs: &[Knob]| {
            let by_margin = match margin {
                Some(reference) => reference.knobs(walk, knobs, limits)?,
                None => None,
            };
            if by_margin.is_some() {
                return Ok(by_margin);
            }
            if proxy.is_none() {
                *proxy = verdicts::film(walk, limits)?.proxy;
            }
            let (estimate, cheaper) = verdicts::knobs(walk, knobs, *proxy, limits)?;
            if knobs.len() > 1 {
                *proxy = cheaper.or(*proxy);
            }
            Ok(estimate)
        };
        let is_turned = |knob: &Knob| walk.input.knobs.contains(knob);
        let knobs: Vec<Knob> = self.knobs.iter().copied().filter(is_turned).collect();
        let accuracy = walk.input.accuracy;
        let mut bar = Bar::default();
        let joint = match knobs.len() {
            0 => return Ok(bar),
            1 => None,
            _ => turned(walk, &knobs)?,
        };
        if joint.is_some() {
            bar.add(self.name, joint, accuracy);
            return Ok(bar);
        }
        for knob in knobs {
            let alone = turned(walk, &[knob])?;
            bar.add(knob.as_str(), alone, accuracy);
        }
        Ok(bar)
    }
}
