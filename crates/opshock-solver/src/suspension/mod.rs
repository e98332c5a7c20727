//! Reduced model of the suspension: hinge, load beam with flanges, flexure mass, dimple, gimbal.
//!
//! `beam` turns the geometry into bending and torsion finite elements of a clamped strip of varying section
//! (`section`). `reduction` condenses them to the motion of the dimple plus a few dimple-pinned modes (Craig and
//! Bampton 1968). The result is what a head integrates:
//!
//! ```text
//! M ü + C u̇ + K u = f a(t) + e₀ F        u = (dimple z, pinned bending modes)
//! Mₜ v̈ + Cₜ v̇ + Kₜ v = e₀ T            v = (dimple roll, pinned torsion modes)
//! ```
//!
//! with a(t) the inertia load per mass in the base frame, F and T the force and the roll moment
//! that the slider exerts at the dimple. All displacements are increments from the loaded state;
//! gram load and preload of the gimbal enter as the steady dimple force. The gimbal's pitch moment acts on u through
//! the slope at the dimple, a lift tab's force through the rise of the tab's end.
//!
//! A suspension from another program is given by its modes on the base (`modes`) and reduced in the same way.
//!
//! Neglected: in-plane motion (sway), coupling of bending and torsion by asymmetry, stiffening by preload, and rotatory
//! inertia of bending.

mod beam;
mod error;
mod modes;
mod parameters;
mod reduction;
mod section;
mod shapes;

pub use beam::{BeamMatrices, RootedBeam};
pub use error::SuspensionError;
pub use modes::SuspensionMode;
pub use parameters::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, LiftTab, Limiter, LoadBeam, RayleighDamping,
    SuspensionParameters,
};
pub use reduction::{ReducedSuspension, Reduction};
pub use section::{FLANGED_TORSION_FACTOR, FLEXURE_ROLL_RADIUS_M, HINGE_TORSION_FACTOR, Section};
pub use shapes::{Held, SuspensionShape, SuspensionShapes};
