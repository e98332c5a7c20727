//! Uncertainty interval of a critical shock: contributions of the search and of each discretisation parameter.
//!
//! The search contributes its bracket. A parameter's contribution is the change of the critical amplitude when the
//! parameter ([`Discretisation`](opshock_solver::scene::discretisation::Discretisation)) is coarsened by one step; where
//! that change is more than a quarter of the target, the parameter is refined by one step as well. Parameters are
//! changed in three groups, each as a whole: modes and time step of disk and ramp; modes and tolerances of the head; the
//! finite-element mesh that a ramp's modes were computed on. A parameter is changed alone only where no run of its group
//! gives a verdict. Their effect hardly depends on the film, so that these runs take a film of a quarter or an eighth of
//! the cells; of half, where the critical amplitude on those is not near enough to the one on the whole film.
//!
//! A run is converted to a change δA of the critical amplitude in one of two ways:
//!
//! * *clearance sensitivity* (`clearance_sensitivity`): δA = δh / |dh/dA|, with h the smallest clearance of
//!   survivors just below it and δh its change. It needs one run, and holds where h falls steadily to zero as A grows.
//! * *re-bracketing* (`rebracketing`): elsewhere, as where the dimple opens and survival ends abruptly, the critical
//!   amplitude of the changed scene is searched for.
//!
//! Factors of safety are those of Roache (1994, J. Fluids Eng. 116, 405): 1.25 where two changes fall as the formal order
//! of the method says, 3 elsewhere. The change seen on refining moves the bound on its own side by its size; the
//! factor acts, on both sides, on the error that is estimated to be left in the refined run. Contributions add up, below and above the
//! answer; none makes another smaller.
//!
//! Where the clearance sensitivity holds, the error of the film's grid is found without a shock: a steady film under a
//! slider held at the attitude of the smallest clearance is solved on finer grids
//! ([`Discretisation::QuasiStaticFilm`](opshock_solver::scene::discretisation::Discretisation::QuasiStaticFilm)). This
//! is used only where the same estimate predicts what shocks on a quarter or half of the cells gave; elsewhere the film
//! is coarsened and re-bracketed like any other parameter.
//!
//! [`uncertainty`] is a function of finished runs. Called with more runs it goes further, and it asks for the next
//! run that it lacks: always the same runs in the same order, whatever the number of threads.

mod ask;
mod clearance_sensitivity;
mod contributions;
mod judge;
mod limits;
mod pieces;
mod rebracketing;
mod refinement;
#[cfg(test)]
mod tests;
mod walk;

use self::pieces::{pieces, whole};
use self::walk::Walk;

pub use self::ask::{Ask, Known, Progress, SUBDIVISIONS, Seen, UncertaintyInput};
pub use self::contributions::{Contribution, Uncertainty};
pub use self::refinement::{Answer, MOST_STEPS, answer, most_film_steps};

/// The interval of `input` as far as `lookup` knows the runs it needs, with the runs requested.
pub fn uncertainty(
    input: &UncertaintyInput,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
) -> (Vec<Ask>, Progress) {
    let mut log = Vec::new();
    let progress = match contributions(&mut Walk::new(input, lookup, &mut log)) {
        Ok(uncertainty) => Progress::Done(uncertainty),
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

fn contributions(walk: &mut Walk<'_>) -> Result<Uncertainty, Ask> {
    let pieces = pieces(walk, Default::default())?;
    Ok(whole(walk, &pieces))
}
