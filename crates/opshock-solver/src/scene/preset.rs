//! Resolution presets `coarse`, `standard` and `fine` (key `resolution.preset`): a table of discretisation parameters.
//!
//! The values come from work-precision runs on the critical shock; a scene may override each of them. The uncertainty
//! wanted for the critical shock is another setting; a preset only states the one it was chosen for.

use crate::air_bearing::FilmResolution;
use crate::disk::DiskResolution;
use crate::head::{Coupling, HeadResolution};
use crate::structure::{ContactMethod, StructureResolution};

/// A named set of discretisation parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Preset {
    /// For an uncertainty of 5 %.
    Coarse,
    /// For 1 %, the default.
    Standard,
    /// For 0.1 %.
    Fine,
}

impl Preset {
    /// Uncertainty of the critical shock that the preset was chosen for, as a share of it: the target where no other is
    /// set.
    pub fn target_uncertainty(self) -> f64 {
        match self {
            Preset::Coarse => 0.05,
            Preset::Standard => 0.01,
            Preset::Fine => 0.001,
        }
    }
}

/// Smallest number of cells of the defect-correction grid at a skewed flow. There 1000 cells, cut in two and
/// extrapolated, miss the flying height by 2.3 % (skew 5 and 8 degrees on the 2.5-inch drive), 2000 by 0.4 and 1.0 %.
pub const SKEWED_CORRECTION_CELLS: usize = 2000;

/// The resolution of every part of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolutions {
    /// Disk.
    pub disk: DiskResolution,
    /// Disk and ramp in contact.
    pub structure: StructureResolution,
    /// Film.
    pub film: FilmResolution,
    /// Head.
    pub head: HeadResolution,
}

/// The resolutions of a preset.
pub fn resolutions(preset: Preset) -> Resolutions {
    // Uncorrected, 600 cells differ from 1000 by 5 to 14 % at quasi-static compression of the film. With defect
    // correction 400 cells differ by at most 2.5 %, by 0.5 % at 30 of 36 points, and 250 cells by up to 8 %.
    let (cells, correction_cells, tolerance, coupling_tolerance) = match preset {
        Preset::Coarse => (400, 1000, 5.0e-2, 5.0e-4),
        Preset::Standard => (1000, 1000, 2.0e-2, 2.0e-4),
        Preset::Fine => (4000, 4000, 1.0e-3, 1.0e-5),
    };
    // With a contact stiffness, critical shocks with a ramp settle to 1 % from 60 kHz on, with a hard contact from 240
    // kHz on. Half of 60 kHz still moves some by 4 %, so that uncertainty intervals exceed 10 %. Frequencies of a plate
    // grow with the square of its wave number.
    let (cut_hz, n_harmonics, n_elements, step_s) = match preset {
        Preset::Coarse => (120e3, 80, 56, 0.25e-6),
        Preset::Standard => (240e3, 112, 80, 0.25e-6),
        Preset::Fine => (480e3, 160, 112, 0.125e-6),
    };
    // From 8 to 16 modes critical shocks with a ramp move by 5 to 12 %, from 16 to 32 by 0.5 %, from there to all modes
    // of the beam by less than was resolved.
    let suspension_modes = match preset {
        Preset::Coarse => 16,
        Preset::Standard | Preset::Fine => 32,
    };
    Resolutions {
        disk: DiskResolution {
            n_harmonics,
            cut_hz,
            n_elements,
            static_correction: true,
        },
        structure: StructureResolution {
            step_s,
            contact: ContactMethod::ExactFlow,
        },
        film: FilmResolution {
            cells,
            min_height_m: 0.3e-9,
            correction_cells,
        },
        head: HeadResolution {
            tolerance,
            approach_share: 0.25,
            suspension_modes,
            coupling: Coupling::Monolithic,
            coupling_tolerance,
            max_steps: 2_000_000,
        },
    }
}
