//! Air bearing: compressible Reynolds equation with rarefaction under one slider.

mod balance;
mod carrying;
mod corner;
mod defect;
mod derivatives;
mod exponential;
mod faces;
mod film;
mod flow_factor;
mod flux;
mod heights;
pub mod impedance;
mod layout;
mod linearise;
mod mesh;
mod newton;
mod relaxation;
mod state;
pub mod steady;
mod storage;
mod surface_forces;
mod thickness;

#[cfg(test)]
mod tests;

pub use defect::ReferenceForces;
pub use film::{Film, FilmError};
pub use flow_factor::FlowFactor;
pub use linearise::FilmLinearisation;
pub use state::FilmScratch;
pub use surface_forces::{SurfaceForces, SurfaceLoad};

/// Rarefaction model of the flow factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlowModel {
    /// Continuum.
    Continuum,
    /// First-order slip (Burgdorfer).
    Slip1,
    /// Second-order slip (Hsia and Domoto).
    Slip2,
    /// Fukui-Kaneko, three-range fit with blended branches.
    FukuiKaneko,
}

/// Numerical resolution of the film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmResolution {
    /// Wanted number of cells; the grid fits the surface's edges and comes close to it.
    pub cells: usize,
    /// Height h0 of the C1 floor the film sees, m.
    pub floor_m: f64,
    /// Wanted number of cells of the reference grid from which the force that the film's own leaves out is told
    /// ([`ReferenceForces`]); 0: the grid is taken as it is.
    pub reference_cells: usize,
}

/// Pose of the slider's reference plane over the disk's local plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attitude {
    /// Height of the reference plane over the disk at the slider's centre (no crown), m.
    pub centre_height_m: f64,
    /// Pitch, rad; positive: leading edge up.
    pub pitch_rad: f64,
    /// Roll, rad; positive: outer side (+y) up.
    pub roll_rad: f64,
}
