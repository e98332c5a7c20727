//! Mirrors a scene about the disk's middle plane, so that a head under the disk is simulated as one over it.
//!
//! A head over its disk faces down, one under it faces up. Mechanics is the same in a mirror: z → −z about the disk's
//! middle plane turns one drive into the other. A head under the disk is simulated as one over the disk of the mirrored
//! drive, with the amplitude of opposite sign:
//!
//! ```text
//! drive, head under the disk, amplitude A   =   mirrored drive, head over the disk, amplitude −A
//! ```
//!
//! | quantity | mirrored |
//! |---|---|
//! | displacements and loads along z; tilts; the amplitude | change sign |
//! | angles, radii, skew, spin: vectors within the plane and rotations about z | stay |
//! | what the ramp does above and below the disk | changes places |
//! | height of the rotor's centre of mass over the centre of tilt | changes sign |
//! | in-plane load per axial load | changes sign: only the axial load does |
//! | rotation in the plane per axial load | stays: both change sign |
//! | shape of a disk that runs out | changes sign: half a turn of its phase |
//! | slider, suspension, gas and forces in the film, seen from the disk | stay |
//!
//! Modes of base and ramp keep shape and participation: displacement and load change sign together, and so does the
//! mode's coordinate. A scene does not include weight; a slider's is a few thousandths of its gram load.

use std::f64::consts::PI;

use super::description::Scene;
use crate::disk::{DiskParameters, HubParameters, Wave};
use crate::ramp::RampParameters;
use crate::shock::ObliqueShock;

impl Scene {
    /// The scene of the drive upside down. Mirrored twice it is itself, but for whole turns of the phases of
    /// run-out.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        // Every field is named: a new one does not compile until its mirrored value is given here.
        let Self {
            pulse,
            oblique,
            base,
            window,
            disk,
            run_out,
            ramp,
            slider,
            suspension,
            gas,
            flow,
            gap_forces,
            fail_below_m,
            damage,
            disk_resolution,
            structure_resolution,
            film_resolution,
            head_resolution,
            not_refined,
        } = self;
        Self {
            pulse: pulse.clone(),
            oblique: oblique.as_ref().map(mirrored_shock),
            base: base.clone(),
            window: *window,
            disk: mirrored_disk(disk),
            run_out: run_out.iter().map(mirrored_wave).collect(),
            ramp: mirrored_ramp(ramp),
            slider: slider.clone(),
            suspension: suspension.clone(),
            gas: gas.clone(),
            flow: *flow,
            gap_forces: gap_forces.mirrored(),
            fail_below_m: *fail_below_m,
            damage: *damage,
            disk_resolution: disk_resolution.clone(),
            structure_resolution: structure_resolution.clone(),
            film_resolution: film_resolution.clone(),
            head_resolution: head_resolution.clone(),
            not_refined: not_refined.clone(),
        }
    }
}

fn mirrored_shock(shock: &ObliqueShock) -> ObliqueShock {
    ObliqueShock {
        in_plane: shock.in_plane.map(|share| -share),
        rotation_per_m: shock.rotation_per_m,
    }
}

fn mirrored_disk(disk: &DiskParameters) -> DiskParameters {
    let hub = disk.hub.as_ref().map(|hub| HubParameters {
        centre_height_m: -hub.centre_height_m,
        ..*hub
    });
    DiskParameters {
        hub,
        ..disk.clone()
    }
}

fn mirrored_wave(wave: &Wave) -> Wave {
    // Half a turn either way; phases stay small.
    let half = if wave.phase_rad > 0.0 { -PI } else { PI };
    Wave {
        phase_rad: wave.phase_rad + half,
        ..*wave
    }
}

fn mirrored_ramp(ramp: &RampParameters) -> RampParameters {
    RampParameters {
        model: ramp.model.mirrored(),
        clearance_top_m: ramp.clearance_bottom_m,
        clearance_bottom_m: ramp.clearance_top_m,
        ..ramp.clone()
    }
}
