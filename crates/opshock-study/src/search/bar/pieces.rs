//! What each source of error adds: the film's grid, then groups of knobs.

use std::collections::BTreeSet;

use opshock_solver::scene::knob::{Knob, Levels};

use super::ask::Ask;
use super::limits::Limits;
use super::parts::{Bar, Part};
use super::walk::{Walk, bracket, fails_below};
use super::{margin, verdicts};
use crate::search::outcome::Flag;

/// Knobs that are first turned together.
pub(super) struct Group {
    /// Name of their common part.
    pub(super) name: &'static str,
    pub(super) knobs: &'static [Knob],
}

pub(super) const GROUPS: [Group; 3] = [
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
pub(super) type Pieces = [Bar; 1 + GROUPS.len()];

/// Looks at every source that is not `kept` from before.
pub(super) fn pieces(
    walk: &mut Walk<'_>,
    kept: [Option<Bar>; 1 + GROUPS.len()],
) -> Result<Pieces, Ask> {
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
pub(super) fn whole(walk: &Walk<'_>, pieces: &Pieces) -> Bar {
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
