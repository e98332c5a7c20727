//! What a bar starts from, what it asks and what is answered.

use crate::search::evidence::NodeVerdict;
use crate::search::lattice::Lattice;
use crate::search::probe::Retry;
use opshock_solver::scene::knob::{Knob, Levels};

use super::parts::Bar;

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
    /// Knobs turned already: every other turn is made from here.
    pub base: Levels,
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
    /// Times the study's elements of the ramp's solid may be halved; 0 where it is none.
    pub mesh_halvings: i8,
    /// A film can be held still at the lowest attitude of a shock ([`Knob::HeldFilm`]).
    pub holds_films: bool,
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
    /// How the run is made: the scene itself, climbed or not, is tried again as the search tries.
    pub retry: Retry,
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

/// How far a bar has got.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress<T = Bar> {
    /// This run is needed next.
    Wants(Ask),
    /// All is known.
    Done(T),
}
