//! Error bar of a critical shock: what search and resolution add, part by part.
//!
//! Each part asks what the answer would be if one knob were turned a step coarser ([`Knob`](opshock_solver::scene::knob::Knob)), so
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
//! ([`Knob::HeldFilm`](opshock_solver::scene::knob::Knob::HeldFilm)), as far as they say of a quarter of the cells, or of half, what those answered.
//!
//! [`bar`] is a function of what was simulated: called again with more known runs it goes further,
//! and the runs it looks at, in that order, are the canonical sequence of the bar.

mod ask;
mod climb;
mod judge;
mod limits;
mod margin;
mod parts;
mod pieces;
#[cfg(test)]
mod tests;
mod verdicts;
mod walk;

use self::pieces::{pieces, whole};
use self::walk::Walk;

pub use self::ask::{Ask, BarInput, Known, Progress, SUBNODES, Seen};
pub use self::climb::{Answer, FLOOR, answer, most_film_steps};
pub use self::parts::{Bar, Part};

/// The bar of `input` as far as `lookup` knows the runs it needs, with the runs looked at.
pub fn bar(input: &BarInput, lookup: &dyn Fn(Ask) -> Option<Seen>) -> (Vec<Ask>, Progress) {
    let mut log = Vec::new();
    let progress = match parts(&mut Walk::new(input, lookup, &mut log)) {
        Ok(bar) => Progress::Done(bar),
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

fn parts(walk: &mut Walk<'_>) -> Result<Bar, Ask> {
    let pieces = pieces(walk, Default::default())?;
    Ok(whole(walk, &pieces))
}
