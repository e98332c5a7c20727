//! Records the structure at every node of the time grid, for either contact method.

use super::energy::Energies;
use super::record::{DiskExtremes, StructureColumns};
use super::sample::BodySample;
use crate::disk::DiskPose;

/// The structure at one node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    pub time_s: f64,
    pub shock_m_per_s2: f64,
    /// Disk under the slider.
    pub pose: DiskPose,
    /// Disk at the ramp point, m.
    pub ramp_m: f64,
    /// Disk at the rim, m.
    pub rim_m: f64,
    /// Contact points of both arms, m.
    pub arms_m: [f64; 2],
    pub energies: Energies,
}

impl DiskExtremes {
    pub(super) fn include(&mut self, node: &Node) {
        let w = node.pose.displacement_m;
        self.slider_max_m = self.slider_max_m.max(w);
        self.slider_min_m = self.slider_min_m.min(w);
        self.ramp_max_m = self.ramp_max_m.max(node.ramp_m);
        self.ramp_min_m = self.ramp_min_m.min(node.ramp_m);
        self.rim_max_m = self.rim_max_m.max(node.rim_m.abs());
    }
}

impl StructureColumns {
    /// Appends a row without the running means of the forces, which need all impulses.
    pub(super) fn push(&mut self, node: &Node) {
        self.time_s.push(node.time_s);
        self.shock_m_per_s2.push(node.shock_m_per_s2);
        self.disk_slider_m.push(node.pose.displacement_m);
        self.disk_ramp_m.push(node.ramp_m);
        self.disk_rim_m.push(node.rim_m);
        self.disk_pitch_rad.push(node.pose.pitch_rad);
        self.disk_roll_rad.push(node.pose.roll_rad);
        self.ramp_top_m.push(node.arms_m[0]);
        self.ramp_bottom_m.push(node.arms_m[1]);
        self.energy_j.push(node.energies.material());
        self.energy_h_j.push(node.energies.fixed_frame);
    }

    /// Appends hub and base, if present, at the node of the last row.
    pub(super) fn push_bodies(&mut self, now: &BodySample, [has_hub, has_base]: [bool; 2]) {
        if has_hub {
            let [at_ramp, across] = now.tilt_rad;
            self.hub_axial_m.push(now.axial_m);
            self.hub_tilt_ramp_rad.push(at_ramp);
            self.hub_tilt_across_rad.push(across);
        }
        if has_base {
            let [spindle, ramp, pivot] = now.mounts_m;
            self.base_spindle_m.push(spindle);
            self.base_ramp_m.push(ramp);
            self.base_pivot_m.push(pivot);
        }
    }
}
