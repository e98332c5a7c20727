//! Couples harmonics of the disk with what they stand on: a hub that moves ([`crate::disk::hub`]), or a base that
//! vibrates ([`crate::shock::BaseMode`]) with the ramp's arms on it.
//!
//! Coordinates are the motion of hub and base and the modes of the disk clamped to them (Craig and Bampton):
//! the disk moves by w = u + Σ φ q for n = 0 and by r ϑ + Σ φ q for n = 1. In the space-fixed frame, with
//! m and J the disk's mass and moment of inertia about a diameter and L = ∫ ρ h φ · (1 or r) dA,
//!
//! ```text
//! M_d = [m or J, Lᵀ; L, 1],    M = M_d + (m or I of the hub at the hub's coordinate)
//! D = c_bearing + 2 γ of the disk's modes + c M_d + i Ω (2 n M_d + I_p of the hub)
//! K = k_bearing + ω² − n² Ω² + i 2 γ n Ω of the disk's modes
//! ```
//!
//! A rigid motion of the disk meets no stiffness but that of the bearing: the membrane stress and the rotation cancel,
//! since the clamp's pull on the disk rotates with the hub. Material damping is that of the clamped modes, on the
//! motion relative to the hub. A stiff bearing gives the clamped disk, with the same modes. Static corrections and
//! harmonics n ≥ 2 do not move a hub and stay oscillators.
//!
//! Modes of the base are coordinates of n = 0, and so are the modes of arms that the base shakes: with ℓ the load
//! of a coordinate per inertia load (m of the hub's, L of the disk's modes, √m p of the arms') and φ of its mount,
//!
//! ```text
//! M = [1, φ ℓᵀ; ℓ φᵀ, M of what it carries],   f = (p, ℓ) a(t),   w = Σ φ_spindle q + ...,   x = Σ φ_ramp q + ...
//! ```
//!
//! so that base, hub, disk and arms respond to shock and contact as one coupled body. Tilts of the base are left out.
//!
//! Arms whose stiffness relaxes ([`crate::ramp::Relaxation`]) have Maxwell elements in parallel with it. On a rigid
//! base each of their modes is a part of its own.

mod body;
mod exchange;
mod leap;
mod load;
mod matrices;
mod part;
mod places;
mod points;
mod state;
mod whirl;
mod whole;

pub(super) use body::Body;
pub(super) use leap::add;
pub(super) use matrices::{RidingMode, is_carried};
pub(super) use state::{Leap, RotorScratch, RotorState};
pub use whirl::HubModeRow;
pub(super) use whirl::hub_modes;
pub(super) use whole::Rotor;
