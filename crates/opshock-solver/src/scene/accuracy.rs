//! Named accuracy rungs: the one table of resolutions behind `accuracy = "5%" | "1%" | "0.1%"`.
//!
//! A rung fixes every knob that trades time for accuracy. The values come from work-precision
//! runs on the critical shock; a scene may override each of them.

use super::{Coupling, HeadResolution};
use crate::air_bearing::FilmResolution;
use crate::disk::DiskResolution;
use crate::structure::{ContactMethod, StructureResolution};

/// A named accuracy of the critical shock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// 5 %.
    FivePercent,
    /// 1 %, the default.
    OnePercent,
    /// 0.1 %.
    TenthPercent,
}

impl Rung {
    /// The accuracy as a share of the critical shock.
    pub fn share(self) -> f64 {
        match self {
            Rung::FivePercent => 0.05,
            Rung::OnePercent => 0.01,
            Rung::TenthPercent => 0.001,
        }
    }
}

/// The resolutions of every stage.
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

/// Resolutions of a rung.
pub fn resolutions(rung: Rung) -> Resolutions {
    let (cut_hz, step_s, cells, tolerance, coupling_tolerance) = match rung {
        Rung::FivePercent => (20e3, 1.0e-6, 600, 5.0e-2, 5.0e-4),
        Rung::OnePercent => (30e3, 0.5e-6, 1000, 2.0e-2, 2.0e-4),
        Rung::TenthPercent => (80e3, 0.25e-6, 8000, 1.0e-3, 1.0e-5),
    };
    // Beside the film they cost little: 16 take 8 % more time than 4, whose critical shocks are off
    // by 1 to 30 %; those of 16 and 32 agree within 1 %.
    let suspension_modes = match rung {
        Rung::FivePercent => 8,
        Rung::OnePercent => 16,
        Rung::TenthPercent => 32,
    };
    Resolutions {
        disk: DiskResolution {
            n_harmonics: 40,
            cut_hz,
            n_elements: 40,
            static_correction: true,
        },
        structure: StructureResolution {
            step_s,
            contact: ContactMethod::ExactFlow,
        },
        film: FilmResolution {
            cells,
            floor_m: 0.3e-9,
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
