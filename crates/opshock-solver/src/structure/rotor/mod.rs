//! Harmonics of the disk with what they stand on: a hub that moves ([`crate::disk::hub`]), a base that
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
//! A rigid motion of the disk meets no stiffness but that of the bearing: the membrane's stress and the
//! turning cancel, since the clamp's pull on the disk turns with the hub. Material damping is that of
//! the clamped modes, on the motion relative to the hub. A stiff bearing gives the clamped disk, with
//! the same modes. Static corrections and harmonics n ≥ 2 do not move a hub and stay oscillators.
//!
//! Modes of the base are coordinates of n = 0, and so are the modes of arms that the base shakes: with ℓ the load
//! of a coordinate per inertia load (m of the hub's, L of the disk's modes, √m p of the arms') and φ of its mount,
//!
//! ```text
//! M = [1, φ ℓᵀ; ℓ φᵀ, M of what it carries],   f = (p, ℓ) a(t),   w = Σ φ_spindle q + ...,   x = Σ φ_ramp q + ...
//! ```
//!
//! so that shock and contact find base, hub, disk and arms as one body, each moving the others. Tilts of the base
//! are left out.

mod body;
mod exchange;
mod leap;
mod load;
mod matrices;
mod part;
mod points;
mod whirl;

use super::StructureError;
use super::model::{SliderPlace, StructureParameters};
use crate::complementarity::moreau_jean::{FirstOrderModes, MoreauJean};
use crate::disk::{DiskError, DiskMode, DiskParameters};
use crate::modal::oscillator::GAUSS_8;
use crate::modal::{Coordinates, CoupledState, PointReadout, Readout};
use crate::shock::{BaseMotion, ObliqueShock, Stretch};
pub(super) use body::Body;
pub(super) use leap::{Leap, add};
use matrices::Stand;
pub(super) use part::Part;
pub use whirl::HubModeRow;
pub(super) use whirl::hub_modes;

/// A mode of an arm, of unit modal mass, that the base shakes.
#[derive(Clone, Copy, Debug)]
pub(super) struct RidingMode {
    pub omega_rad_per_s: f64,
    pub half_damping_per_s: f64,
    /// Load by a unit acceleration of the ramp's mount, √kg.
    pub participation_sqrt_kg: f64,
    /// Displacement of both contact points, 1/√kg.
    pub shape_per_sqrt_kg: [f64; 2],
}

/// Both harmonics; n = 1 only on a hub and where something may drive it.
pub(super) struct Rotor {
    pub parts: Vec<Part>,
    /// A whole step.
    pub step: Leap,
    /// Gauss' rule within a whole step.
    quadrature: Vec<Leap>,
}

/// Amplitudes of the modes of every part.
#[derive(Clone, Debug, Default)]
pub(super) struct RotorState {
    pub parts: Vec<CoupledState>,
}

/// Room for what is computed on the way.
#[derive(Clone, Debug, Default)]
pub(super) struct RotorScratch {
    leap: Leap,
    coordinates: Vec<Coordinates>,
    start: RotorState,
    point: RotorState,
    /// State of which work and loss are asked for.
    pub walk: RotorState,
}

impl Rotor {
    /// What `modes` of the disk, those of [`is_carried`], move with; `None` on a rigid base without a hub.
    /// Shapes are those at contact, slider and rim.
    ///
    /// # Errors
    /// Modes that cannot be taken apart, as those of a base lighter than what it carries.
    pub fn build(
        modes: &[DiskMode],
        arms: &[RidingMode],
        has_harmonics: bool,
        parameters: &StructureParameters<'_>,
        stretches: &[Stretch],
        step_s: f64,
    ) -> Result<Option<Self>, StructureError> {
        let (disk, ramp) = (parameters.disk, parameters.ramp);
        let hub = disk.hub.as_ref();
        if hub.is_none() && parameters.base.is_empty() {
            return Ok(None);
        }
        let place = Places {
            disk,
            slider: parameters.slider,
            ramp_radius_m: ramp.radius_m,
            angle_rad: parameters.slider.angle_rad - ramp.angle_rad,
            ramp_angle_rad: ramp.angle_rad,
            oblique: parameters.oblique,
        };
        let base = part::slow_modes(parameters.base, step_s);
        let of = |n: usize| -> Vec<&DiskMode> {
            let own = |mode: &&DiskMode| mode.nodal_diameters == n;
            modes.iter().filter(own).collect()
        };
        let upright = Stand {
            hub,
            base: &base,
            arms,
        };
        let coupled = Part::build(0, &upright, &of(0), &place, step_s);
        let mut parts = vec![coupled.map_err(|source| match parameters.base.is_empty() {
            true => unsolved(0, source),
            false => StructureError::Base,
        })?];
        // Without harmonics in the basis nothing drives the tilt.
        if hub.is_some() && has_harmonics {
            let tilted = Stand {
                hub,
                ..Stand::default()
            };
            let tilting = Part::build(1, &tilted, &of(1), &place, step_s);
            parts.push(tilting.map_err(|source| unsolved(1, source))?);
        }
        let mut rotor = Self {
            parts,
            step: Leap::default(),
            quadrature: Vec::new(),
        };
        // One rate per pulse shape: a half-sine has one stretch, piecewise linear ones have none.
        let sigma = stretches[0].sigma_per_s;
        let leap = |h_s: f64| {
            let mut leap = Leap::default();
            rotor.set_leap(h_s, Some(sigma), &mut leap);
            leap
        };
        let step = leap(step_s);
        let quadrature = GAUSS_8.iter().map(|(x, _)| leap(x * step_s)).collect();
        (rotor.step, rotor.quadrature) = (step, quadrature);
        Ok(Some(rotor))
    }

    /// Motion of the actuator's pivot under the unit pulse, on a base that vibrates.
    pub fn pivot_motion(&self, stretches: &[Stretch]) -> Option<BaseMotion> {
        let part = &self.parts[0];
        let (arms, drive) = (part.arms.as_ref()?, part.drive.as_ref()?);
        let rates = part.modes.rates_per_s();
        Some(BaseMotion::new(
            rates,
            &drive.entrance,
            &arms.pivot,
            stretches,
        ))
    }

    /// Whether `state` was made for this rotor.
    pub fn is_of(&self, state: &RotorState) -> bool {
        let lengths = self.parts.iter().map(|p| p.modes.n_columns());
        lengths.eq(state.parts.iter().map(|s| s.re.len()))
    }

    /// Adds the rotor to a reference system of Moreau-Jean steps, with rows of the gaps of both arms.
    pub fn add_to(&self, system: &mut MoreauJean) {
        for part in &self.parts {
            // Top g = g₀ + x − w, bottom g = g₀ − x + w.
            let row = |side: usize, of: fn(&PointReadout) -> &Readout| -> Readout {
                let sign = if side == 0 { -1.0 } else { 1.0 };
                let scaled = |x: &[f64]| x.iter().map(|x| sign * x).collect();
                let disk = of(&part.contact);
                let mut row = Readout {
                    re: scaled(&disk.re),
                    im: scaled(&disk.im),
                };
                if let Some(arms) = &part.arms {
                    let arm = of(&arms.contact[side]);
                    for (own, arm) in [(&mut row.re, &arm.re), (&mut row.im, &arm.im)] {
                        own.iter_mut()
                            .zip(arm)
                            .for_each(|(x, arm)| *x -= sign * arm);
                    }
                }
                row
            };
            let gap = |side: usize| PointReadout {
                position: row(side, |point| &point.position),
                velocity: row(side, |point| &point.velocity),
            };
            let entrance = |impulse: [f64; 2]| {
                let mut state = part.modes.at_rest();
                part.for_impulses(impulse, |entrance, share| state.add(entrance, share));
                state
            };
            system.add_coupled(FirstOrderModes {
                rates_per_s: part.modes.rates_per_s().to_vec(),
                gaps: [gap(0), gap(1)],
                entrances: [entrance([1.0, 0.0]), entrance([0.0, 1.0])],
                drive: part.drive.as_ref().map(|drive| drive.entrance.clone()),
                state: part.modes.at_rest(),
            });
        }
    }

    /// All at rest.
    pub fn at_rest(&self) -> RotorState {
        RotorState {
            parts: self.parts.iter().map(|p| p.modes.at_rest()).collect(),
        }
    }

    pub fn scratch(&self) -> RotorScratch {
        RotorScratch {
            leap: self.step.clone(),
            coordinates: self.parts.iter().map(|p| p.modes.coordinates()).collect(),
            start: self.at_rest(),
            point: self.at_rest(),
            walk: self.at_rest(),
        }
    }

    /// Modes carried, each pair once.
    pub fn n_modes(&self) -> usize {
        self.parts.iter().map(Part::order).sum()
    }

    /// Modes of arms among them.
    pub fn n_arm_modes(&self) -> usize {
        self.parts.iter().map(|part| part.n_arm_modes).sum()
    }

    /// Whether the unit pulse tilts the hub.
    pub fn is_tilted(&self) -> bool {
        let tilts = |p: &Part| p.nodal_diameters > 0 && p.drive.is_some();
        self.parts.iter().any(tilts)
    }

    /// Modes that the unit pulse drives.
    pub fn n_driven(&self) -> usize {
        let driven = self.parts.iter().filter(|p| p.drive.is_some());
        driven.map(Part::order).sum()
    }

    /// Growth rate of the fastest growing mode with its nodal diameters, if one grows.
    pub fn growth(&self) -> Option<(usize, f64)> {
        let rates = self.parts.iter().flat_map(|part| {
            let rates = part.modes.rates_per_s().iter();
            rates.map(|s| (part.nodal_diameters, s.re))
        });
        rates
            .filter(|(_, growth)| *growth > 0.0)
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl RotorState {
    pub fn copy_from(&mut self, other: &Self) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.copy_from(other);
        }
    }

    pub fn add(&mut self, other: &Self, factor: f64) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.add(other, factor);
        }
    }

    pub fn reset(&mut self) {
        self.parts.iter_mut().for_each(CoupledState::reset);
    }
}

/// What a part needs to know of the disk and the places on it.
struct Places<'a> {
    disk: &'a DiskParameters,
    slider: SliderPlace,
    ramp_radius_m: f64,
    /// Of the slider from the ramp.
    angle_rad: f64,
    ramp_angle_rad: f64,
    oblique: Option<&'a ObliqueShock>,
}

fn unsolved(nodal_diameters: usize, source: crate::linalg::DenseError) -> StructureError {
    StructureError::Disk(DiskError::Hub {
        nodal_diameters,
        source,
    })
}

/// Modes of the clamped disk that move with a hub, or else with a base.
pub(super) fn is_carried(mode: &DiskMode, is_on_hub: bool) -> bool {
    mode.nodal_diameters <= usize::from(is_on_hub) && mode.nodal_circles.is_some()
}
