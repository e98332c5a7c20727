//! Hard cases: set-ups on which solvers of this kind are known to go wrong, each with measured figures and their
//! bounds.
//!
//! A case is a function that simulates and returns [`Check`]s. `opshock doctor --hard-cases` runs them on the present
//! machine and the tests assert the same checks, so that figure and bound are written in one place. Where the naive
//! method is short, the check gives its figure too ([`naive`]): the fault that the method in use cures.

mod asperities;
mod bearing;
mod check;
mod contact;
mod coupling;
mod impact;
mod moving_disk;
pub mod naive;
mod plate;
mod repeat;
mod rotation;
pub mod scenes;
mod structure;
mod verdict;

pub use check::{Check, Naive};

/// A hard case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Letter and number.
    pub id: &'static str,
    /// Its name.
    pub name: &'static str,
    run: fn() -> Vec<Check>,
}

impl Case {
    /// Runs it.
    pub fn run(&self) -> Vec<Check> {
        (self.run)()
    }
}

/// A case by its letter and number.
pub const fn case(id: &'static str, name: &'static str, run: fn() -> Vec<Check>) -> Case {
    Case { id, name, run }
}

/// Every case, in order.
pub static CASES: &[Case] = &[
    case("A1", "half-sine exactly at resonance", structure::a1),
    case("A2", "residual vibration null", structure::a2),
    case("A3", "pulse end inside a step", structure::a3),
    case("A4", "impulse limit", structure::a4),
    case("A5", "very stiff retained mode", structure::a5),
    case("A6", "a million free steps", structure::a6),
    case("A7", "travelling-wave split", rotation::a7),
    case("A8", "at the critical speed", rotation::a8),
    case("A9", "above the critical speed, two dampings", rotation::a9),
    case("A10", "only n = 0 without contact", rotation::a10),
    case("A11", "annular plate frequencies", plate::a11),
    case("A12", "extreme radii", plate::a12),
    case("A13", "mode truncation", plate::a13),
    case("B1", "sticking ramp", contact::b1),
    case("B2", "bouncing oscillator, rigid stop", impact::b2),
    case("B3", "stiff elastic stop", impact::b3),
    case("B4", "elastic bar thrown at a wall", impact::b4),
    case("B5", "grazing", impact::b5),
    case("B6", "accumulating impacts", impact::b6),
    case("B7", "resting contact", contact::b7),
    case("B8", "both ramps at once", contact::b8),
    case("B9", "starts touching, starts overlapping", contact::b9),
    case("B10", "plastic hit on a free ramp mass", impact::b10),
    case("B11", "ramp mass ratio series", contact::b11),
    case(
        "B12",
        "restitution must not matter in the limit",
        contact::b12,
    ),
    case("B13", "several impacts inside one step", impact::b13),
    case("B14", "honest order at impacts", contact::b14),
    case("B15", "drift of a velocity-level constraint", impact::b15),
    case("B16", "yanked contact", contact::b16),
    case("B17", "positive and negative shock", contact::b17),
    case("B18", "no ramp needed", contact::b18),
    case("C1", "exact one-dimensional slider", bearing::c1),
    case("C2", "huge bearing number", bearing::c2),
    case("C3", "etched step", bearing::c3),
    case("C4", "linear squeeze film", bearing::c4),
    case("C5", "gap to zero", bearing::c5),
    case("C6", "negative gap inside an iteration", moving_disk::c6),
    case("C7", "suction", moving_disk::c7),
    case("C8", "flat parallel slider", bearing::c8),
    case("C9", "mirror in roll", bearing::c9),
    case("C10", "flow from the other side", bearing::c10),
    case("C11", "kinks in the slip table", bearing::c11),
    case("C12", "bad first attitude", bearing::c12),
    case("C13", "lift-off and return", moving_disk::c13),
    case("D1", "stiff film, light slider", coupling::d1),
    case("D2", "identical residuals", coupling::d2),
    case("D3", "start from rest", coupling::d3),
    case("D4", "accelerator stall", coupling::d4),
    case("D5", "iteration cap", coupling::d5),
    case("D6", "mixed units", coupling::d6),
    case("D7", "truly one way", coupling::d7),
    case("E1", "false failure at start", verdict::e1),
    case("E2", "touch between steps", verdict::e2),
    case("E3", "corner touch", verdict::e3),
    case("E4", "not a number is not a pass", verdict::e4),
    case("E5", "known critical shock", verdict::e5),
    case("E6", "nothing to find", verdict::e6),
    case("E7", "more than one change of state", verdict::e7),
    case("E8", "threshold noise", verdict::e8),
    case("E9", "late failure", verdict::e9),
    case("E10", "zero and tiny amplitude", verdict::e10),
    case("F1", "thread count", repeat::f1),
    case("F2", "interrupted = uninterrupted", repeat::f2),
    case("F3", "order of points", repeat::f3),
    case("F4", "poisoned neighbour", repeat::f4),
    case("F5", "denormals", repeat::f5),
    case("G1", "corner of a pad grazes", asperities::g1),
    case("G2", "slides on the side of a rail", asperities::g2),
    case("G3", "no roughness", asperities::g3),
    case("G4", "very stiff asperities", asperities::g4),
    case("G5", "impact that yields", asperities::g5),
    case("G6", "cascade of bounces", asperities::g6),
    case("G7", "deep overlap", asperities::g7),
    case("G8", "few asperities touch", asperities::g8),
    case("G9", "some yield, some do not", asperities::g9),
    case("G10", "friction of a skewed slider", asperities::g10),
    case("G11", "flies on its asperities", asperities::g11),
    case("G12", "dimple opens in contact", asperities::g12),
];
