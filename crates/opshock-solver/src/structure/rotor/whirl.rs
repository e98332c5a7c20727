//! Lists the whirl modes of disk and hub for printed tables.

use super::matrices::{Matrices, Stand, is_carried};
use crate::disk::{DiskBasis, DiskError, DiskMode, DiskParameters};
use crate::modal::CoupledModes;
use crate::structure::error::StructureError;
use std::f64::consts::PI;

/// One damped mode of disk and hub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubModeRow {
    /// `"axial"`, or for tilts `"forward"` and `"backward"`: the sense of the whirl in the space-fixed
    /// frame against the spin.
    pub motion: &'static str,
    /// Damped frequency in the space-fixed frame, Hz; 0 when overdamped.
    pub frequency_hz: f64,
    /// Damping ratio; negative when the mode grows.
    pub damping_ratio: f64,
}

/// Modes of the harmonics n = 0 and n = 1 with `disk`'s hub, by rising frequency; none without one.
pub(in crate::structure) fn hub_modes(
    disk: &DiskParameters,
    basis: &DiskBasis,
) -> Result<Vec<HubModeRow>, StructureError> {
    let Some(hub) = &disk.hub else {
        return Ok(Vec::new());
    };
    let mut rows = Vec::new();
    for n in 0..=1 {
        let carried = |mode: &&DiskMode| mode.nodal_diameters == n && is_carried(mode, true);
        let modes: Vec<&DiskMode> = basis.modes.iter().filter(carried).collect();
        let stand = Stand {
            hub: Some(hub),
            ..Stand::default()
        };
        let system = Matrices::new(n, &stand, &modes, disk).system;
        let coupled = CoupledModes::new(system).map_err(|source| DiskError::Hub {
            nodal_diameters: n,
            source,
        })?;
        rows.extend(coupled.rates_per_s().iter().map(|s| {
            // e^{iθ + st} travels forward where Im s is negative, for a spin towards growing θ.
            let against = s.im * disk.spin_rad_per_s > 0.0;
            HubModeRow {
                motion: match (n, against) {
                    (0, _) => "axial",
                    (_, false) => "forward",
                    (_, true) => "backward",
                },
                frequency_hz: s.im.abs() / (2.0 * PI),
                damping_ratio: -s.re / s.norm(),
            }
        }));
    }
    rows.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    Ok(rows)
}
