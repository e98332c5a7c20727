//! A scene: everything one simulation needs, in SI, as plain data.

pub mod accuracy;

use crate::air_bearing::{FilmResolution, FlowModel};
use crate::disk::{DiskParameters, DiskResolution};
use crate::gas::GasParameters;
use crate::ramp::RampParameters;
use crate::shock::Pulse;
use crate::slider::SliderParameters;
use crate::structure::StructureResolution;
pub use crate::structure::Window;
use crate::suspension::SuspensionParameters;

/// How film and slider are solved together at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// One Newton iteration on everything at once (Schur complement).
    Monolithic,
    /// The paper's fixed-point iteration.
    FixedPoint,
    /// Fixed point with Aitken's relaxation.
    Aitken,
    /// Anderson acceleration (interface Newton).
    Anderson,
}

/// Resolution and limits of the head's time integration.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadResolution {
    /// Relative local error allowed in the clearance per step.
    pub tolerance: f64,
    /// Largest share by which a step may change the minimum clearance.
    pub approach_share: f64,
    /// Modes of the suspension kept above the dimple-pinned interface, bending.
    pub suspension_modes: usize,
    /// Coupling scheme.
    pub coupling: Coupling,
    /// Residual tolerance of the coupled solve relative to its scales.
    pub coupling_tolerance: f64,
    /// Step limit; reached = undecided.
    pub max_steps: u64,
}

/// Everything one simulation needs but the amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Unit pulse.
    pub pulse: Pulse,
    /// Simulated time after the onset.
    pub window: Window,
    /// Disk.
    pub disk: DiskParameters,
    /// Ramp.
    pub ramp: RampParameters,
    /// Slider.
    pub slider: SliderParameters,
    /// Suspension.
    pub suspension: SuspensionParameters,
    /// Gas.
    pub gas: GasParameters,
    /// Rarefaction model.
    pub flow: FlowModel,
    /// Clearance below which the head-disk interface has failed, m.
    pub fail_below_m: f64,
    /// Resolution of the disk.
    pub disk_resolution: DiskResolution,
    /// Resolution of the structure.
    pub structure_resolution: StructureResolution,
    /// Resolution of the film.
    pub film_resolution: FilmResolution,
    /// Resolution of the head.
    pub head_resolution: HeadResolution,
}
