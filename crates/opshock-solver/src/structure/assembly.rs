//! Assembles the structural model of one scene: the modes of disk, ramp and base, the time grid and the unit response.

use super::bank::{Arm, Bank, Spring};
use super::driven::Driven;
use super::error::StructureError;
use super::free_motion::FreeMotion;
use super::model::StructureModel;
use super::outcome::StructureWarning;
use super::parameters::{ContactMethod, SliderPlace, StructureParameters};
use super::rotor::{Rotor, is_carried};
use super::shared::{Inactive, Shared};
use super::time_grid::{check_times, count_steps};
use crate::complementarity::ImpactLaw;
use crate::disk::{
    self, DiskBasis, DiskMode, DiskModes, DiskParameters, DiskResolution, Harmonics,
};
use crate::ramp::RampParameters;
use crate::shock::{BaseMode, ObliqueShock};
use std::sync::LazyLock;

/// A gap below this is closed, m. Displacements of 0.1 mm carry rounding of 1e-20 m; nothing of
/// interest is smaller than 1e-12 m.
const GAP_TOLERANCE_M: f64 = 1e-13;
/// Impacts located in one step before the contact is taken as sustained.
const MAX_IMPACTS_PER_STEP: u32 = 8;
/// Largest ω Δt of a disk mode; a longer step is divided into equal parts. Beyond π an impulse cannot be aimed (see
/// [`crate::complementarity`]). A static correction that is faster is slowed at constant compliance: it represents
/// stiffness alone, and would divide the step by three to five.
const FASTEST_DISK_ANGLE: f64 = 3.0;
/// Largest number of modes of a base.
const MOST_BASE_MODES: usize = 16;
impl StructureModel {
    /// Builds the modes of n = 0 and the unit response. The first run that touches builds what contact alone drives
    /// (see [`Self::build_contact_driven`]): the harmonics n >= 1 and the tables of one step. Without a ramp nothing ever drives
    /// them: [`Harmonics::Symmetric`] then gives the same motion.
    ///
    /// # Errors
    /// A parameter out of range, a place off the disk, an overlap before the shock, a failed
    /// eigenvalue problem.
    pub fn build(
        parameters: &StructureParameters<'_>,
        harmonics: Harmonics,
    ) -> Result<Self, StructureError> {
        let StructureParameters {
            disk,
            disk_resolution,
            ramp,
            slider,
            pulse,
            oblique,
            base,
            window,
            resolution,
        } = *parameters;
        check_times(window, resolution.step_s)?;
        ramp.validate()?;
        check_direction(oblique, disk)?;
        check_base(base, oblique)?;
        disk::basis::validate_place(disk, "slider", slider.radius_m)?;
        disk::basis::validate_place(disk, "ramp", ramp.radius_m)?;
        let stretches = pulse.stretches()?;
        let radii = [ramp.radius_m, slider.radius_m, disk.outer_radius_m];
        let modes = DiskModes::new(disk, disk_resolution, &radii, Some(0))?;
        let is_on_hub = disk.hub.is_some();
        // Three models hold n >= 1 from the start: a hub moves with n = 1, waves that grow under damping fixed in space
        // are reported before any touch, and arms whose stiffness relaxes are modes of the rotor.
        let has_rotor = is_on_hub || !base.is_empty() || ramp.model.relaxes();
        let is_at_once = has_rotor || disk.space_fixed_damping_per_s > 0.0;
        let first = match is_at_once {
            true => harmonics,
            false => Harmonics::Symmetric,
        };
        let mut basis = modes.basis(0, first)?;
        let step_s = divided_step_s(&basis, disk_resolution, resolution.step_s);
        let n_steps = count_steps(window, step_s)?;
        slow_corrections(&mut basis, step_s);

        let has_harmonics = basis.modes.iter().any(|mode| mode.nodal_diameters > 0);
        let carried;
        (carried, basis.modes) = Assembly::split(parameters, std::mem::take(&mut basis.modes));
        let assembly = Assembly::of(parameters, step_s);
        let (mut bank, arms) = assembly.bank(&basis.modes);
        let riding = bank.riding.take().unwrap_or_default();
        let rotor = Rotor::build(
            &carried,
            &riding,
            has_harmonics,
            parameters,
            &stretches,
            step_s,
        )?;

        let mut warnings = Vec::new();
        if bank.n_slowed > 0 {
            warnings.push(StructureWarning::ArmModesSlowed {
                modes: bank.n_slowed,
            });
        }
        if let Some((nodal_diameters, growth_per_s)) = rotor.as_ref().and_then(Rotor::growth) {
            warnings.push(StructureWarning::HubInstability {
                nodal_diameters,
                growth_per_s,
            });
        }
        let n_arm_modes = match arms[0].modes == arms[1].modes {
            true => arms[0].modes.len(),
            false => arms.iter().map(|arm| arm.modes.len()).sum(),
        };
        let slope_to_pose = bank.slope_to_pose;
        let forced = std::mem::take(&mut bank.forced);
        let shapes = std::mem::take(&mut bank.shapes);
        let inactive: Box<dyn FnOnce() -> Inactive + Send> = if is_at_once {
            let mut driven = Driven::new(bank, arms, &basis, rotor.as_ref(), step_s);
            warnings.append(&mut driven.warnings);
            Box::new(|| Ok(driven))
        } else {
            Box::new(move || {
                let mut rest = modes.basis(1, harmonics)?;
                slow_corrections(&mut rest, step_s);
                basis.modes.append(&mut rest.modes);
                basis.harmonics_bounded = rest.harmonics_bounded;
                let (bank, arms) = assembly.bank(&basis.modes);
                Ok(Driven::new(bank, arms, &basis, None, step_s))
            })
        };
        Ok(Self::of(Shared {
            free: FreeMotion::new(forced, shapes, rotor, stretches, step_s, n_steps),
            n_steps,
            method: resolution.contact,
            window,
            pulse: pulse.clone(),
            n_contacts: if ramp.model.is_absent() { 0 } else { 2 },
            clearance_m: [ramp.clearance_top_m, ramp.clearance_bottom_m],
            law: ImpactLaw {
                restitution: ramp.restitution,
                gap_tolerance_m: GAP_TOLERANCE_M,
                max_impacts_per_step: MAX_IMPACTS_PER_STEP,
            },
            spin_rad_per_s: disk.spin_rad_per_s,
            n_arm_modes,
            slope_to_pose,
            warnings,
            inactive: LazyLock::new(inactive),
        }))
    }
}

/// What the bank of disk and arms is assembled from.
pub(super) struct Assembly {
    disk: DiskParameters,
    ramp: RampParameters,
    slider: SliderPlace,
    oblique: Option<ObliqueShock>,
    has_riding: bool,
    method: ContactMethod,
    step_s: f64,
}

impl Assembly {
    pub fn of(parameters: &StructureParameters<'_>, step_s: f64) -> Self {
        let StructureParameters { ramp, base, .. } = *parameters;
        Self {
            disk: parameters.disk.clone(),
            ramp: ramp.clone(),
            slider: parameters.slider,
            oblique: parameters.oblique.copied(),
            has_riding: !base.is_empty() || ramp.model.relaxes(),
            method: parameters.resolution.contact,
            step_s,
        }
    }

    /// Modes of the disk that the rotor holds because they move with hub and base, and the others.
    pub fn split(
        parameters: &StructureParameters<'_>,
        modes: Vec<DiskMode>,
    ) -> (Vec<DiskMode>, Vec<DiskMode>) {
        let is_on_hub = parameters.disk.hub.is_some();
        let has_rotor = is_on_hub || !parameters.base.is_empty();
        let on_it = |mode: &DiskMode| has_rotor && is_carried(mode, is_on_hub);
        modes.into_iter().partition(on_it)
    }

    /// Modes of the disk and both arms in one bank, padded.
    pub fn bank(&self, modes: &[DiskMode]) -> (Bank, [Arm; 2]) {
        let Self { disk, ramp, .. } = self;
        let mut bank = Bank::new(modes, disk, self.slider, ramp.angle_rad, self.has_riding);
        let spring = Spring::of(ramp, self.method, self.step_s);
        let arms = bank.add_ramp(&ramp.model, spring, self.step_s);
        if let Some(shock) = &self.oblique {
            // On a turning base the ramp's axial load differs from the spindle's.
            bank.scale_arms(shock.axial_at(ramp.radius_m, ramp.angle_rad));
        }
        bank.pad();
        (bank, arms)
    }
}

fn check_direction(
    oblique: Option<&ObliqueShock>,
    disk: &DiskParameters,
) -> Result<(), StructureError> {
    match oblique {
        Some(shock) if disk.hub.is_none() || !shock.is_finite() => Err(StructureError::Direction),
        _ => Ok(()),
    }
}

fn check_base(base: &[BaseMode], oblique: Option<&ObliqueShock>) -> Result<(), StructureError> {
    let is_sound = base.len() <= MOST_BASE_MODES && base.iter().all(BaseMode::is_sound);
    match base.is_empty() || (oblique.is_none() && is_sound) {
        true => Ok(()),
        false => Err(StructureError::Base),
    }
}

/// The step, divided for the modes below the cut or, where it is faster, for the fastest mode of n = 0, which every
/// basis holds. All ramps therefore share one time grid.
fn divided_step_s(basis: &DiskBasis, resolution: &DiskResolution, step_s: f64) -> f64 {
    let symmetric = basis.modes.iter().filter(|mode| mode.nodal_diameters == 0);
    let fastest = symmetric
        .filter(|mode| mode.nodal_circles.is_some())
        .map(|mode| mode.omega_rad_per_s)
        .fold(std::f64::consts::TAU * resolution.cut_hz, f64::max);
    let n_parts = (fastest * step_s / FASTEST_DISK_ANGLE).ceil().max(1.0);
    step_s / n_parts
}

/// Slows static corrections that are too fast for the step; φ/ω, and with it the compliance, stays the same.
pub(super) fn slow_corrections(basis: &mut DiskBasis, step_s: f64) {
    let limit = FASTEST_DISK_ANGLE / step_s;
    for mode in &mut basis.modes {
        if mode.nodal_circles.is_none() && mode.omega_rad_per_s > limit {
            let share = limit / mode.omega_rad_per_s;
            mode.omega_rad_per_s = limit;
            for (value, slope) in &mut mode.shape {
                *value *= share;
                *slope *= share;
            }
        }
    }
}
