//! Coupled oscillators with any damping, taken apart into their damped modes.
//!
//! ```text
//! M q̈ + D q̇ + K q = b f(t)          M real, D and K complex: amplitudes of a harmonic in a fixed frame
//! q = Σ P η,   q̇ = Σ V η,   η̇ = s η + w f
//! ```
//!
//! Where damping does not share the modes of mass and stiffness, or where a rotor's gyroscopic
//! moments couple them, no transformation leaves oscillators that are alone. In first-order form there
//! is one: the eigenvectors of the state (q, q̇). Every mode η is one complex number, its flow over
//! any time is e^{sh}, and its forced response is a closed form as in [`crate::modal::forcing`].
//!
//! A coordinate may be held by Maxwell elements as well, springs k in series with dashpots of relaxation time τ:
//!
//! ```text
//! M q̈ + D q̇ + K q + Σ k y = b f(t),    ẏ = q̇ − y/τ          y: extension of the spring
//! ```
//!
//! one more first-order coordinate each; ½ k y² is stored, k y²/τ is taken.
//!
//! Of a real system only one of each conjugate pair is carried, with weights of 2.
//!
//! Energies: H = ½ q̇ᴴ M q̇ + ½ qᴴ U q with the real part U of the stiffness that stores energy. The
//! rest takes Re(q̇ᴴ D q̇ + q̇ᴴ (K − U) q) from it.
//!
//! Source: Meirovitch, Analytical Methods in Vibrations (1967), ch. 9 (state space of damped systems);
//! Ewins, Modal Testing (2000), 2.7 and 2.8 (viscous damping, rotating structures).

mod modes;
mod state;
mod system;

pub use modes::CoupledModes;
pub use state::{CoupledFlow, CoupledState, PointReadout};
pub use system::{Coordinates, CoupledSystem, Maxwell};

#[cfg(test)]
mod tests;
