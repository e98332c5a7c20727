//! The unit response at one instant: points, hub and base, energy exchanged so far.

use crate::complementarity::Gap;

/// Displacement and velocity of one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Motion {
    pub value: f64,
    pub rate: f64,
}

/// Unit response of all points at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    pub contact: Motion,
    pub slider: Motion,
    pub slider_slope: Motion,
    pub top: Motion,
    pub bottom: Motion,
    pub rim: f64,
    /// Pitch and roll of the disk under the slider, for a disk on a hub.
    pub tilt: [Motion; 2],
    /// Energy of disk and arms, J per (m/s²)².
    pub energy: f64,
    /// Its kinetic part.
    pub kinetic: f64,
    /// H minus that energy: 0 where only n = 0 moves.
    pub excess: f64,
    /// Work of the shock so far, J per (m/s²)².
    pub work: f64,
    /// Loss by damping so far, J per (m/s²)².
    pub loss: f64,
}

/// Work of the shock and loss by damping over a time, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Exchange {
    pub work: f64,
    pub loss: f64,
    /// Impulses of the supports of hub and base, N s.
    pub support_n_s: [f64; 2],
}

/// Hub and base at one instant, per unit amplitude or in total. Pairs are (hub, base).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BodySample {
    /// Axial displacement of the hub relative to its bearing, m.
    pub axial_m: f64,
    /// Its tilt towards the ramp and across, rad.
    pub tilt_rad: [f64; 2],
    /// Displacement of spindle, ramp's mount and pivot relative to the rigid base, m.
    pub mounts_m: [f64; 3],
    /// Momentum of hub and disk, and of the base with all it carries, N s.
    pub momentum_n_s: [f64; 2],
    /// Impulses of their supports so far, N s.
    pub support_n_s: [f64; 2],
}

impl BodySample {
    pub fn times(&self, factor: f64) -> Self {
        Self {
            axial_m: factor * self.axial_m,
            tilt_rad: self.tilt_rad.map(|x| factor * x),
            mounts_m: self.mounts_m.map(|x| factor * x),
            momentum_n_s: self.momentum_n_s.map(|x| factor * x),
            support_n_s: self.support_n_s.map(|x| factor * x),
        }
    }

    pub fn plus(&self, other: &Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            axial_m: self.axial_m + other.axial_m,
            tilt_rad: sum(self.tilt_rad, other.tilt_rad),
            mounts_m: std::array::from_fn(|k| self.mounts_m[k] + other.mounts_m[k]),
            momentum_n_s: sum(self.momentum_n_s, other.momentum_n_s),
            support_n_s: sum(self.support_n_s, other.support_n_s),
        }
    }
}

/// Change of the gap of `side` per unit amplitude: top g = g₀ + x − w, bottom g = g₀ − x + w.
pub(super) fn unit_gap(side: usize, sample: &Sample) -> Gap {
    let (arm, sign) = if side == 0 {
        (sample.top, 1.0)
    } else {
        (sample.bottom, -1.0)
    };
    Gap {
        value_m: sign * (arm.value - sample.contact.value),
        rate_m_per_s: sign * (arm.rate - sample.contact.rate),
    }
}
