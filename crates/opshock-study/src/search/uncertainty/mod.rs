//! Uncertainty interval of a critical shock: contributions of the search and of each discretisation parameter.
//!
//! The search contributes its bracket. Of every discretisation parameter
//! ([`Discretisation`](opshock_solver::scene::discretisation::Discretisation)) the change of the critical amplitude A
//! when it is coarsened by one step gives, by its formal order, the error that is left; a factor of safety times that
//! error is its contribution. Where the error is more than a quarter of the target (or of the half-width so far, if that
//! is larger) and more than what the target leaves, the parameter is refined by one step as well.
//!
//! The film's grid is estimated by itself. The others are changed in three groups, each as a whole: modes and time step of
//! disk and ramp; modes and tolerances of the head; the finite-element mesh that a ramp's modes were computed on. A parameter
//! is changed alone only where its group gives no estimate: no verdict, or an answer too far away. The effect of a group
//! hardly depends on the film, so that these runs take one of a quarter, an eighth or half of the cells whose
//! own answer is near enough.
//!
//! A run is converted to a change δA of the critical amplitude in one of two ways:
//!
//! * *clearance sensitivity* (`clearance_sensitivity`): δA = δh / |dh/dA|, with h the smallest clearance of survivors just
//!   below A and δh its change, a run a group. It holds where h falls steadily to zero as the amplitude grows, at the
//!   instant at which the lowest failure touches.
//! * *re-bracketing* (`rebracketing`): elsewhere, as where the dimple opens and survival ends abruptly, the critical
//!   amplitude of the changed scene is searched for.
//!
//! The factor of safety is 1.25 where changes fall at the formal order or faster, and for bounds by equal brackets and by
//! quasi-static films; 3 elsewhere (Roache 1994, J. Fluids Eng. 116, 405). The change seen on refining moves the bound on
//! its own side by its size; the factor acts, on both sides, on the error that is estimated to be left in the refined run.
//! Contributions add up, below and above the answer; none makes another smaller.
//!
//! Where the clearance sensitivity holds, the error of the film's grid is read off films under a slider held at the
//! attitude of the smallest clearance
//! ([`Discretisation::QuasiStaticFilm`](opshock_solver::scene::discretisation::Discretisation::QuasiStaticFilm)). Shocks on
//! a quarter of the cells, or half, test that reading: what it misses of them is added. Where that is too much, the
//! film's grid is coarsened and refined like any other parameter.
//!
//! [`answer`] is a function of finished runs. Called with more runs it goes further, and it asks for the next run that it
//! lacks: always the same runs in the same order, whatever the number of threads.

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

pub use self::ask::{Ask, Known, Progress, SUBDIVISIONS, Seen, UncertaintyInput};
pub use self::contributions::{Contribution, Uncertainty};
pub use self::refinement::{Answer, MOST_STEPS, answer, most_film_steps};
