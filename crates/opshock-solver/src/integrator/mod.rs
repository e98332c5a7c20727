//! Integrates stiff systems with L-stable, stiffly accurate one-step schemes, step control and dense output.
//!
//! An ESDIRK scheme of s stages advances y' = f(t, y) by
//!
//! ```text
//! Yᵢ = yₙ + Δt Σⱼ<ᵢ aᵢⱼ kⱼ + d kᵢ,   kᵢ = f(tₙ + cᵢ Δt, Yᵢ),   d = γ Δt
//! k₁ = last k of the step before,    yₙ₊₁ = Yₛ
//! ```
//!
//! The first stage is explicit and the last one is the new value, so every implicit stage has the
//! same iteration matrix I − d J. Rates are taken as kᵢ = (Yᵢ − known)/d instead of evaluating f
//! once more: an error of the stage solve then enters the next step with a factor of order one,
//! not multiplied by the stiffness.
//!
//! | scheme | order | implicit stages | γ | source |
//! |---|---|---|---|---|
//! | TR-BDF2 | 2 (3 embedded) | 2 | 1 − √2/2 | Bank et al. 1985; Hosea and Shampine, Appl. Numer. Math. 20 (1996) 21 |
//! | ESDIRK3(2)4L\[2\]SA | 3 (2 embedded) | 3 | 0.43586652… | Kennedy and Carpenter, NASA/TM-2001-211038, ARK3(2)4L\[2\]SA implicit part |
//!
//! [`Stepper`] takes one trial step of any [`StageSystem`]. [`StepControl`] chooses the next step from its error out of
//! a coarse geometric series of step sizes, so that factorisations, which depend on d, are reused; [`hermite`] holds
//! the cubic dense output.

mod control;
mod extrapolation;
pub mod hermite;
mod stepper;
mod tableau;

#[cfg(test)]
mod tests;

pub use control::StepControl;
pub use stepper::{StageSystem, Stepper};
pub use tableau::{ESDIRK3, TR_BDF2, Tableau};
