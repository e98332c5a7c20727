//! Decomposes coupled oscillators with any damping into their damped modes, and advances these exactly.
//!
//! ```text
//! M q̈ + D q̇ + K q = b f(t)          M real, D and K complex: amplitudes of a harmonic in a fixed frame
//! q = Σ P η,   q̇ = Σ V η,   η̇ = s η + w f
//! ```
//!
//! Where damping does not share the modes of mass and stiffness, or where a rotor's gyroscopic moments couple them, no
//! transformation gives uncoupled oscillators. In first-order form there is one: the eigenvectors of the state (q, q̇).
//! Every mode η is one complex number, its flow over any time is e^{sh}, and its forced response is a closed form as in
//! [`crate::modal::forcing`].
//!
//! A coordinate may have Maxwell elements as well, springs k in series with dashpots of relaxation time τ:
//!
//! ```text
//! M q̈ + D q̇ + K q + Σ k y = b f(t),    ẏ = q̇ − y/τ          y: extension of the spring
//! ```
//!
//! Each is one more first-order coordinate; it stores ½ k y² and loses the power k y²/τ.
//!
//! For a real system only one of each conjugate pair is kept, with weights of 2.
//!
//! Energies: H = ½ q̇ᴴ M q̇ + ½ qᴴ U q with the real part U of the stiffness that stores energy. The rest takes the
//! power Re(q̇ᴴ D q̇ + q̇ᴴ (K − U) q) from it.
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
