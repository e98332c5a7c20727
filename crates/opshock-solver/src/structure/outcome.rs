//! Result of one amplitude run through a structural model.

use super::history::StructuralHistory;
use super::record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBalance, HubRecord,
    StructureColumns,
};

/// Penetration above which a run warns, m.
const PENETRATION_WARNING_M: f64 = 1e-7;

/// Result of one amplitude run through a structural model.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureRun {
    /// Motion of the disk under the slider, unless the model is one without motion.
    pub history: StructuralHistory,
    /// Columns on the grid, when recorded.
    pub columns: Option<StructureColumns>,
    /// Extremes of the disk's motion.
    pub disk: DiskExtremes,
    /// Contact with the top arm.
    pub top: ArmContact,
    /// Contact with the bottom arm.
    pub bottom: ArmContact,
    /// Energy balance.
    pub energy: EnergyBalance,
    /// Complementarity numbers.
    pub complementarity: Complementarity,
    /// Hub, for a disk on a bearing.
    pub hub: Option<HubRecord>,
    /// Base, when it vibrates.
    pub base: Option<BaseRecord>,
    /// First touch of either arm, s.
    pub first_touch_s: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// End of the run, s.
    pub end_s: f64,
    /// Warnings.
    pub warnings: Vec<StructureWarning>,
}

impl StructureRun {
    pub(super) fn penetration_warning(depth_m: f64) -> Option<StructureWarning> {
        (depth_m > PENETRATION_WARNING_M).then_some(StructureWarning::Penetration { depth_m })
    }
}

/// Something a user should know about a structural run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StructureWarning {
    /// Penetration of more than a tenth of a micrometre: the step is too long.
    Penetration {
        /// Largest penetration, m.
        depth_m: f64,
    },
    /// Bounces accumulated within a step and were taken as lasting contact.
    BouncesAccumulated {
        /// Number of steps.
        steps: u64,
    },
    /// Harmonics with modes below the cut were left out.
    HarmonicsBounded,
    /// Arm modes too fast for the step were slowed at constant stiffness.
    ArmModesSlowed {
        /// Number of modes.
        modes: usize,
    },
    /// Both arms held one point: only the net force is determined.
    BothArmsOnePoint,
    /// The hub's bearing drives a whirl of the rotor.
    HubInstability {
        /// 0: axial motion, 1: tilt.
        nodal_diameters: usize,
        /// Growth rate, 1/s.
        growth_per_s: f64,
    },
    /// The disk spins above a critical speed, and damping fixed in space drives a travelling wave.
    PhysicalInstability {
        /// Nodal diameters of the wave.
        nodal_diameters: usize,
        /// Growth rate, 1/s.
        growth_per_s: f64,
    },
}
