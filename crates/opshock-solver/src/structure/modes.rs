//! Lists natural frequencies of disk, hub and ramp for printed tables.

use super::error::StructureError;
use super::rotor::{HubModeRow, hub_modes};
use crate::disk::{DiskBasis, DiskParameters, DiskResolution, Harmonics};
use crate::ramp::{CoupledMode, RampParameters};
use std::f64::consts::TAU;

/// One mode of the disk; n >= 1 stands for a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskModeRow {
    /// Nodal diameters.
    pub nodal_diameters: usize,
    /// Nodal circles.
    pub nodal_circles: usize,
    /// Undamped frequency in the rotating frame, Hz.
    pub rotating_frame_hz: f64,
    /// Frequency of the forward wave in the space-fixed frame, Hz.
    pub forward_hz: f64,
    /// Frequency of the backward wave in the space-fixed frame, Hz; negative above its critical
    /// speed, where the spin carries the wave forward.
    pub backward_hz: f64,
    /// Damping ratio in the rotating frame.
    pub damping_ratio: f64,
}

/// One mode of a ramp arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmModeRow {
    /// `"top"` or `"bottom"`.
    pub arm: &'static str,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass at the contact point, kg.
    pub mass_kg: f64,
    /// Base participation.
    pub participation: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// Modes of disk and ramp, by rising frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StructureModes {
    /// Disk.
    pub disk: Vec<DiskModeRow>,
    /// Disk's harmonics n = 0 and n = 1 with their hub, if it has one, below the cut.
    pub hub: Vec<HubModeRow>,
    /// Ramp arms.
    pub ramp: Vec<ArmModeRow>,
    /// Modes of a ramp whose arms are one body.
    pub coupled_ramp: Vec<CoupledMode>,
}

/// Modes of the disk below the cut and of the arms.
///
/// # Errors
/// Parameters out of range, or a failed eigenvalue problem.
pub fn modes(
    disk: &DiskParameters,
    resolution: &DiskResolution,
    ramp: &RampParameters,
) -> Result<StructureModes, StructureError> {
    ramp.validate()?;
    let basis = DiskBasis::build(disk, resolution, &[], None, Harmonics::All)?;
    let turn_hz = disk.spin_rad_per_s.abs() / TAU;
    let mut rows: Vec<DiskModeRow> = basis
        .modes
        .iter()
        .filter_map(|mode| {
            let hz = mode.omega_rad_per_s / TAU;
            let carried = mode.nodal_diameters as f64 * turn_hz;
            Some(DiskModeRow {
                nodal_diameters: mode.nodal_diameters,
                nodal_circles: mode.nodal_circles?,
                rotating_frame_hz: hz,
                forward_hz: hz + carried,
                backward_hz: hz - carried,
                damping_ratio: mode.damping_ratio,
            })
        })
        .filter(|row| row.rotating_frame_hz < resolution.cut_hz)
        .collect();
    rows.sort_by(|a, b| a.rotating_frame_hz.total_cmp(&b.rotating_frame_hz));
    let (mut arms, mut coupled_ramp) = (Vec::new(), Vec::new());
    match ramp.model.arms() {
        Some(own) => {
            for (arm, modes) in ["top", "bottom"].into_iter().zip(own) {
                arms.extend(modes.iter().map(|m| ArmModeRow {
                    arm,
                    frequency_hz: m.frequency_hz,
                    mass_kg: m.mass_kg,
                    participation: m.participation,
                    damping_ratio: m.damping_ratio,
                }));
            }
        }
        None => coupled_ramp.extend(ramp.model.modes().iter().map(CoupledMode::from)),
    }
    let mut hub = hub_modes(disk, &basis)?;
    hub.retain(|row| row.frequency_hz < resolution.cut_hz);
    Ok(StructureModes {
        disk: rows,
        hub,
        ramp: arms,
        coupled_ramp,
    })
}
