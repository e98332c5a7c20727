//! Error bar of a critical shock: what search and resolution add, part by part.
//!
//! Each part asks what the answer would be if one knob were turned ([`Knob`]): coarser where finer
//! is dear (film, disk modes, structure step), else finer. All knobs but the film's grid are turned
//! on a film of a quarter or an eighth of the cells, where a run costs a tenth, because what such
//! a knob changes hardly depends on the film.
//! Two readings turn runs into amplitude:
//!
//! * *margin* (`margin`): where the smallest clearance falls steadily to zero at the instant at
//!   which the lowest failure touches, δA = δh / |dh/dA|, a run per knob;
//! * *verdicts* (`verdicts`): where survival ends abruptly (a dimple opens, the slider is thrown),
//!   the critical amplitude of each turned scene itself, bracketed to a sixteenth of the tolerance.
//!
//! An estimate that shows the knob's formal order is multiplied by 1.25, any other by 3 (Roache
//! 1994, J. Fluids Eng. 116, 405). Parts add up; nothing is taken from their having signs.
//!
//! [`bar`] is a function of what was simulated: called again with more known runs it goes further,
//! and the runs it looks at, in that order, are the canonical sequence of the bar.

mod judge;
mod margin;
#[cfg(test)]
mod tests;
mod verdicts;

use std::collections::BTreeSet;

use opshock_solver::scene::knob::{Knob, Levels};

use self::judge::Estimate;
use super::evidence::NodeVerdict;
use super::lattice::Lattice;
use super::outcome::Flag;

/// Nodes of the bar's lattice per step of the search.
pub const SUBNODES: i32 = 16;

/// A survivor that the search has met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Node of the bar's lattice.
    pub index: i32,
    /// Smallest clearance, m.
    pub h_min_m: f64,
    /// Its time, s.
    pub t_min_s: f64,
}

/// A bracket with what surrounds it.
#[derive(Clone, Debug, PartialEq)]
pub struct BarInput {
    /// Lattice of the bar: [`SUBNODES`] nodes for each of the search.
    pub lattice: Lattice,
    /// Highest survivor, node of that lattice.
    pub survivor: i32,
    /// Lowest failure.
    pub failure: i32,
    /// Time of touch of the lowest failure, s.
    pub t_fail_s: Option<f64>,
    /// Survivors of the search with their margins.
    pub survivors: Vec<Known>,
    /// Knobs that can change the answer.
    pub knobs: Vec<Knob>,
    /// Times the film's cells may be halved; 0 where there is no film.
    pub film_halvings: i8,
    /// Accuracy asked for, a share.
    pub accuracy: f64,
}

/// A run that the bar asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ask {
    /// Knobs turned.
    pub levels: Levels,
    /// Node of the bar's lattice.
    pub index: i32,
}

/// What such a run answered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Verdict.
    pub verdict: NodeVerdict,
    /// Smallest clearance, m.
    pub h_min_m: Option<f64>,
    /// Its time, s.
    pub t_min_s: Option<f64>,
}

/// One part of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// `search` or the knob's word.
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
    /// Half the bar's length over the reported value: what is compared with the accuracy asked.
    pub fn half_length(&self) -> f64 {
        0.5 * self
            .parts
            .iter()
            .map(|part| part.low + part.high)
            .sum::<f64>()
    }
}

/// How far a bar has got.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// This run is needed next.
    Wants(Ask),
    /// The bar.
    Done(Bar),
}

/// The bar of `input` as far as `lookup` knows the runs it needs, with the runs looked at.
pub fn bar(input: &BarInput, lookup: &dyn Fn(Ask) -> Option<Seen>) -> (Vec<Ask>, Progress) {
    let mut walk = Walk {
        input,
        lookup,
        log: Vec::new(),
    };
    let progress = match parts(&mut walk) {
        Ok(bar) => Progress::Done(bar),
        Err(ask) => Progress::Wants(ask),
    };
    (walk.log, progress)
}

/// Looks runs up in order; the first that is not known ends the walk.
struct Walk<'a> {
    input: &'a BarInput,
    lookup: &'a dyn Fn(Ask) -> Option<Seen>,
    log: Vec<Ask>,
}

impl Walk<'_> {
    fn see(&mut self, levels: Levels, index: i32) -> Result<Seen, Ask> {
        let ask = Ask { levels, index };
        let seen = (self.lookup)(ask).ok_or(ask)?;
        if !self.log.contains(&ask) {
            self.log.push(ask);
        }
        Ok(seen)
    }

    /// The film on which the other knobs are compared.
    fn proxy(&self) -> Levels {
        Levels::NONE.turned(Knob::FilmGrid, -self.input.film_halvings.min(2))
    }

    /// Ratio of amplitudes `nodes` apart, minus one.
    fn share(&self, nodes: i32) -> f64 {
        (f64::from(nodes) / f64::from(self.input.lattice.nodes_per_octave)).exp2() - 1.0
    }
}

fn parts(walk: &mut Walk<'_>) -> Result<Bar, Ask> {
    let input = walk.input;
    let mut bar = Bar::default();
    bar.parts.push(Part {
        name: "search",
        low: 0.0,
        high: walk.share(input.failure - input.survivor),
        factor: 1.0,
    });
    let margin = match input.knobs.is_empty() {
        true => None,
        false => margin::Reference::find(walk)?,
    };
    for &knob in &input.knobs {
        let by_margin = match &margin {
            Some(reference) if knob == Knob::FilmGrid => reference.film(walk)?,
            Some(reference) => reference.knob(walk, knob)?,
            None => None,
        };
        let estimate = match by_margin {
            Some(estimate) => Some(estimate),
            None if knob == Knob::FilmGrid => verdicts::film(walk)?,
            None => verdicts::knob(walk, knob)?,
        };
        match estimate {
            Some(Estimate { share, factor }) => {
                let error = share * factor;
                bar.parts.push(Part {
                    name: knob.as_str(),
                    // No amplitude is negative.
                    low: error.min(1.0),
                    high: error,
                    factor,
                });
                if factor == judge::WIDE && error > judge::NEGLIGIBLE * input.accuracy {
                    bar.flags.insert(Flag::BarWide);
                }
            }
            None => {
                bar.flags.insert(Flag::BarPartial);
            }
        }
    }
    if !input.knobs.is_empty() && bar.half_length() > input.accuracy {
        bar.flags.insert(Flag::BarExceeds);
    }
    Ok(bar)
}
