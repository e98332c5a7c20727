//! Holds all that moves with hub or base: the harmonics n = 0 and n = 1 as one system.

use super::matrices::{RidingMode, Stand};
use super::part::{self, Part};
use super::places::Places;
use super::state::{Leap, RotorScratch, RotorState};
use crate::complementarity::moreau_jean::{FirstOrderModes, MoreauJean};
use crate::disk::{DiskError, DiskMode};
use crate::modal::oscillator::GAUSS_8;
use crate::modal::{PointReadout, Readout};
use crate::ramp::RampError;
use crate::shock::{BaseMotion, Stretch};
use crate::structure::error::StructureError;
use crate::structure::parameters::StructureParameters;

/// Both harmonics; n = 1 only on a hub and where something may drive it.
pub(in crate::structure) struct Rotor {
    pub parts: Vec<Part>,
    /// Whether there is a base that vibrates.
    pub(super) has_base: bool,
    /// A whole step.
    pub step: Leap,
    /// Flows to the points of Gauss' rule within a whole step.
    pub(super) quadrature: Vec<Leap>,
}

impl Rotor {
    /// Builds what `modes` of the disk, those of [`super::is_carried`], move with; `None` on a rigid base without a
    /// hub. Shapes are those at contact, slider and rim.
    ///
    /// # Errors
    /// Modes that cannot be separated, as those of a base lighter than what it carries.
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
        if hub.is_none() && parameters.base.is_empty() && arms.is_empty() {
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
        let relaxation = &ramp.model.relaxation[..];
        // A rigid base couples nothing, and equal arms in one system would have equal eigenvalues.
        let is_rigid = parameters.base.is_empty() || (base.is_empty() && ramp.model.relaxes());
        let (carried, alone) = arms.split_at(if is_rigid { 0 } else { arms.len() });
        let upright = Stand {
            hub,
            base: &base,
            arms: carried,
            relaxation,
        };
        let mut parts = Vec::new();
        if hub.is_some() || !parameters.base.is_empty() {
            let coupled = Part::build(0, &upright, &of(0), &place, step_s);
            parts.push(coupled.map_err(|source| match parameters.base.is_empty() {
                true => unsolved(0, source),
                false => StructureError::Base,
            })?);
        }
        // Without harmonics in the basis nothing drives the tilt.
        if hub.is_some() && has_harmonics {
            let tilted = Stand {
                hub,
                ..Stand::default()
            };
            let tilting = Part::build(1, &tilted, &of(1), &place, step_s);
            parts.push(tilting.map_err(|source| unsolved(1, source))?);
        }
        for mode in alone {
            let own = Stand {
                arms: std::slice::from_ref(mode),
                relaxation,
                ..Stand::default()
            };
            let part = Part::build(0, &own, &[], &place, step_s);
            parts.push(part.map_err(|_| RampError::NotSolved)?);
        }
        let mut rotor = Self {
            parts,
            has_base: !parameters.base.is_empty(),
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
        let part = self.parts.first().filter(|_| self.has_base)?;
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

    /// Adds the rotor to a reference system of Moreau-Jean steps, with rows for the gaps of both arms.
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

    /// Number of modes, each conjugate pair once.
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

fn unsolved(nodal_diameters: usize, source: crate::linalg::DenseError) -> StructureError {
    StructureError::Disk(DiskError::Hub {
        nodal_diameters,
        source,
    })
}
