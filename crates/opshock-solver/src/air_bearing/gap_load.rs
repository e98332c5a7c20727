//! Force and moments of one contribution on the slider, with derivatives by the attitude.

/// Force and moments [F_z, M_pitch, M_roll] on the slider, N and N m, with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapLoad {
    /// Conjugate to (h_c, pitch, roll), as from [`Film::force`](super::Film::force).
    pub force: [f64; 3],
    /// Derivatives by (h_c, pitch, roll) at constant ψ: `[force][q]`.
    pub by_attitude: [[f64; 3]; 3],
    /// Force in the disk's plane, N: along the disk's motion, and outwards at a right angle to it; `None` for a load
    /// without one. The moments include its effect on the slider.
    pub in_plane_n: Option<[f64; 2]>,
}
