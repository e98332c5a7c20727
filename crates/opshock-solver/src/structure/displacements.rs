//! Reads the disk's displacement anywhere and at any times of one run.
//!
//! The displacement of a point is linear in the state of the modes. So one run keeps that state at the nodes on both
//! sides of each time, and the modes' shapes at a radius, turned to an angle, read it as they read the disk under the
//! slider.

use super::assembly::{Assembly, slow_corrections};
use super::driven::sorted;
use super::error::StructureError;
use super::free_motion::ForcedState;
use super::model::{StructureModel, Workspace};
use super::parameters::{SliderPlace, StructureParameters};
use super::rotor::{RidingMode, Rotor, RotorState};
use super::snapshot::Snapshot;
use crate::disk::{DiskMode, DiskModes, Harmonics};
use crate::modal::Readout;
use std::f64::consts::{FRAC_PI_2, PI};

/// Displacement of the disk, m, over the base as it would move rigidly: for each of the `times_s` after the onset a
/// list over `radii_m`, `angles_rad` running fastest. Linear between the nodes of the time grid; a time behind the end
/// of the run has the motion there.
///
/// # Errors
/// As [`StructureModel::build`] and [`StructureModel::run`]; a radius off the disk.
pub fn disk_displacements(
    parameters: &StructureParameters<'_>,
    amplitude_m_per_s2: f64,
    times_s: &[f64],
    [radii_m, angles_rad]: [&[f64]; 2],
) -> Result<Vec<Vec<f64>>, StructureError> {
    let StructureParameters { disk, ramp, .. } = *parameters;
    for &radius_m in radii_m {
        // The clamp's edge moves with the hub.
        if radius_m != disk.inner_radius_m {
            crate::disk::basis::validate_place(disk, "point", radius_m)?;
        }
    }
    let model = StructureModel::build(parameters, Harmonics::All)?.without_motion();
    let (states, places) = states(&model, amplitude_m_per_s2, times_s)?;
    let step_s = model.shared.free.step_s;
    let mut radii = vec![ramp.radius_m];
    radii.extend(radii_m);
    radii.push(disk.outer_radius_m);
    let modes = DiskModes::new(disk, parameters.disk_resolution, &radii, Some(0))?;
    let mut basis = modes.basis(0, Harmonics::All)?;
    slow_corrections(&mut basis, step_s);
    let mut at_states = vec![Vec::new(); states.len()];
    for (at, &radius_m) in (1..).zip(radii_m) {
        let circle = Circle::new(parameters, &basis.modes, at, radius_m, step_s)?;
        let rotors: Vec<[f64; 3]> = states.iter().map(|state| circle.rotor(state)).collect();
        for &angle_rad in angles_rad {
            let point = circle.point(angle_rad);
            let of_rotor = circle.turn(angle_rad);
            for ((state, rotor), values) in states.iter().zip(&rotors).zip(&mut at_states) {
                let turned: f64 = of_rotor.iter().zip(rotor).map(|(a, b)| a * b).sum();
                values.push(point.read(state) + turned);
            }
        }
    }
    let between = |&(before, after, share): &(usize, usize, f64)| -> Vec<f64> {
        let pairs = at_states[before].iter().zip(&at_states[after]);
        pairs.map(|(a, b)| a + share * (b - a)).collect()
    };
    Ok(places.iter().map(between).collect())
}

/// State of all modes at a node, without the unit response and with it.
struct State {
    kept: Snapshot,
    /// Displacements of the forced modes in the unit response.
    unit: Vec<f64>,
    /// The whole motion of the rotor.
    rotor: RotorState,
}

/// States at the nodes on both sides of the times, and for each time the states before and after it with its place
/// between them.
type Between = (Vec<State>, Vec<(usize, usize, f64)>);

fn states(
    model: &StructureModel,
    amplitude_m_per_s2: f64,
    times_s: &[f64],
) -> Result<Between, StructureError> {
    let free = &model.shared.free;
    let sides = |&time_s: &f64| {
        let place = (time_s / free.step_s).clamp(0.0, model.n_steps() as f64);
        (place.floor() as usize, place.ceil() as usize, place.fract())
    };
    let sides: Vec<(usize, usize, f64)> = times_s.iter().map(sides).collect();
    let mut nodes: Vec<usize> = sides.iter().flat_map(|side| [side.0, side.1]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut workspace = Workspace::default();
    let taken = model.run_keeping(amplitude_m_per_s2, nodes, &mut workspace)?;
    let n_forced = free.modes.oscillators.len();
    let mut unit = ForcedState::at_rest(n_forced, free.rotor.as_ref());
    let total = |kept: Snapshot| {
        free.state_at_node(kept.node, &mut unit);
        let mut rotor = kept.rotor.clone();
        rotor.add(&unit.rotor, kept.unit);
        State {
            unit: unit.x[..n_forced].to_vec(),
            rotor,
            kept,
        }
    };
    let states: Vec<State> = taken.into_iter().map(total).collect();
    // A run until the motion has decayed may end before the last times.
    let place = |node: usize| {
        let after = states.partition_point(|state| state.kept.node < node);
        after.min(states.len() - 1)
    };
    let places = sides
        .into_iter()
        .map(|(before, after, share)| (place(before), place(after), share));
    let places = places.collect();
    Ok((states, places))
}

/// What reads the points of one circle on the disk.
struct Circle<'a> {
    parameters: &'a StructureParameters<'a>,
    radius_m: f64,
    step_s: f64,
    modes: Vec<DiskMode>,
    /// Rotors that read the point at the ramp's angle, a quarter and half a turn on.
    rotors: Option<[Rotor; 3]>,
}

/// What reads one point.
struct Point {
    forced: Vec<f64>,
    bank: Readout,
}

impl<'a> Circle<'a> {
    /// The circle whose shapes in `modes` are number `at`.
    fn new(
        parameters: &'a StructureParameters<'a>,
        modes: &[DiskMode],
        at: usize,
        radius_m: f64,
        step_s: f64,
    ) -> Result<Self, StructureError> {
        let seen = |mode: &DiskMode| {
            let [ramp, rim] = [mode.shape[0], mode.shape[mode.shape.len() - 1]];
            DiskMode {
                shape: vec![ramp, mode.shape[at], rim],
                ..mode.clone()
            }
        };
        let seen: Vec<DiskMode> = modes.iter().map(seen).collect();
        let has_harmonics = seen.iter().any(|mode| mode.nodal_diameters > 0);
        let (carried, modes) = Assembly::split(parameters, seen);
        let mut circle = Self {
            parameters,
            radius_m,
            step_s,
            modes,
            rotors: None,
        };
        let riding = circle.bank(0.0).0.riding.take().unwrap_or_default();
        let rotor = |angle_rad| circle.rotor_at(angle_rad, &carried, &riding, has_harmonics);
        circle.rotors = match [rotor(0.0)?, rotor(FRAC_PI_2)?, rotor(PI)?] {
            [Some(at_ramp), Some(quarter), Some(half)] => Some([at_ramp, quarter, half]),
            _ => None,
        };
        Ok(circle)
    }

    fn place(&self, angle_rad: f64) -> StructureParameters<'a> {
        StructureParameters {
            slider: SliderPlace {
                radius_m: self.radius_m,
                angle_rad,
                skew_rad: 0.0,
            },
            ..*self.parameters
        }
    }

    fn bank(&self, angle_rad: f64) -> (super::bank::Bank, [super::bank::Arm; 2]) {
        Assembly::of(&self.place(angle_rad), self.step_s).bank(&self.modes)
    }

    fn rotor_at(
        &self,
        from_ramp_rad: f64,
        carried: &[DiskMode],
        riding: &[RidingMode],
        has_harmonics: bool,
    ) -> Result<Option<Rotor>, StructureError> {
        let place = self.place(self.parameters.ramp.angle_rad + from_ramp_rad);
        let stretches = place.pulse.stretches()?;
        let step_s = self.step_s;
        Rotor::build(carried, riding, has_harmonics, &place, &stretches, step_s)
    }

    /// The point at an angle.
    fn point(&self, angle_rad: f64) -> Point {
        let (mut bank, arms) = self.bank(angle_rad);
        let forced = std::mem::take(&mut bank.shapes.slider);
        let (bank, _) = sorted(bank, arms);
        let [bank, _, _] = bank.slider;
        Point { forced, bank }
    }

    /// Displacement by the rotor on this circle: its mean, and the amplitudes of cosine and sine of the angle from the
    /// ramp, for the rotor holds n = 0 and n = 1.
    fn rotor(&self, state: &State) -> [f64; 3] {
        let Some(rotors) = &self.rotors else {
            return [0.0; 3];
        };
        let [at_ramp, quarter, half] = rotors.each_ref().map(|rotor| rotor.slider_m(&state.rotor));
        let mean = 0.5 * (at_ramp + half);
        [mean, at_ramp - mean, quarter - mean]
    }

    /// Weights of [`Self::rotor`] at an angle.
    fn turn(&self, angle_rad: f64) -> [f64; 3] {
        let (sine, cosine) = (angle_rad - self.parameters.ramp.angle_rad).sin_cos();
        [1.0, cosine, sine]
    }
}

impl Point {
    /// Displacement without the rotor, m.
    fn read(&self, state: &State) -> f64 {
        let shapes = self.forced.iter().zip(&state.unit);
        let unit: f64 = shapes.map(|(shape, x)| shape * x).sum();
        let [re, im] = &state.kept.modes;
        let driven = match re.is_empty() {
            true => 0.0,
            false => self.bank.read(re, im),
        };
        state.kept.unit * unit + driven
    }
}
