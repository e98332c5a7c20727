//! Uncertainty interval of a critical shock: contributions of the search and of each discretisation parameter.
//!
//! The search contributes its bracket. A discretisation parameter
//! ([`Discretisation`](opshock_solver::scene::discretisation::Discretisation)) contributes the error e that it leaves in
//! the critical amplitude A, times a factor of safety (Roache 1994, J. Fluids Eng. 116, 405). With A(-1), A(0), A(1) the
//! answers one step coarser, as the scene is, and one step finer, and r the ratio by which a step divides the error:
//!
//! | answers | e | factor |
//! |---|---|---|
//! | coarser alone | \|A(-1) - A(0)\| / (r - 1) | 3 |
//! | coarser, in the same bracket | width / (r - 1) | 1.25 |
//! | coarser and finer | \|A(0) - A(1)\|, known, one-sided; and \|A(0) - A(1)\| / (r - 1) | 1 and 1.25 |
//! | the same, r not observed | the same known contribution; the larger of that and \|A(-1) - A(0)\| / r, over r - 1 | 1 and 3 |
//!
//! The ratio r is the observed one, R = (A(0) - A(-1)) / (A(1) - A(0)), at most the formal one. Up to the formal one over √2
//! it is not observed, and r is formal. If R > 1 there, factor times e is at least 1.25 \|A(0) - A(1)\| / (max(R, 1.25) - 1).
//! Of two brackets the largest distance is taken. The scene is coarsened first, which is cheap. It is refined by a step or two
//! while the contribution exceeds a quarter of the target (`pieces`, `judge`), and by one at least for disk modes that a
//! contact without stiffness excites. With A(2) the known contribution is \|A(0) - A(2)\|, and e follows from the last two.
//!
//! Parameters are changed in groups: tolerances of the head; modes of the suspension; modes and time step of disk and ramp;
//! the mesh of a ramp; the grid of the film's defect correction; the film's grid. One is changed alone only where its group
//! has no answer. All but the last hardly depend on the film, so these runs take a quarter of the cells, or half, if the
//! answer there is near. The film's grid comes last, from the scene itself: on half and a quarter of the cells, and on twice
//! the cells where that is more than the others leave.
//!
//! The change of A between two scenes is measured in two ways (`measure`):
//!
//! * *clearance sensitivity* (`clearance_sensitivity`): δA = δh / |dh/dA|, with h the smallest clearance of survivors just
//!   below A and δh its change, by a run. It holds where h falls steadily to zero as A grows, at the instant at which the lowest
//!   failure touches.
//! * *re-bracketing* (`rebracketing`): elsewhere, as where the dimple opens and survival ends abruptly, the critical
//!   amplitude of the changed scene is searched for.
//!
//! Contributions add up, below and above the answer; none makes another smaller. Where they exceed the target, the largest
//! are refined and the answer is bracketed anew (`refinement`).
//!
//! A row that is decided below twice the minimum film height also has the change of A with half that height
//! (`min_film_height`). It is no part of the interval: that height is a regularisation, without a value to converge to.
//!
//! [`answer`] is a function of finished runs. Called with more runs it goes further and asks for the next run that it lacks:
//! the same runs in the same order, whatever the number of threads.

mod ask;
mod change;
mod clearance_sensitivity;
mod contributions;
mod judge;
mod measure;
mod min_film_height;
mod pieces;
mod rebracketing;
mod refinement;
#[cfg(test)]
mod tests;
mod walk;

pub use self::ask::{Ask, Known, Progress, SUBDIVISIONS, Seen, UncertaintyInput};
pub use self::contributions::{Contribution, Uncertainty};
pub use self::refinement::{Answer, MOST_STEPS, answer, finest};
