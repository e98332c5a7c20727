//! Stores the disk's motion under the slider for the head, which is simulated after the structure.
//!
//! Nodes on the structure's time grid hold pose and rate; between them the motion is the cubic through both ends. An
//! impact makes the rate jump: its instant is a break with one rate on either side. The impulses of a lasting contact
//! represent a continuous force. At their nodes the rate is therefore the mean of both sides, which is the rate under
//! that force to second order.

use crate::disk::{DiskMotion, DiskPose};

/// Pose and both rates at an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Break {
    pub time_s: f64,
    pub pose: DiskPose,
    pub rate_before: DiskPose,
    pub rate_after: DiskPose,
}

/// Motion of the disk under the slider over the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StructuralHistory {
    pub(super) step_s: f64,
    pub(super) pose: Vec<DiskPose>,
    pub(super) rate: Vec<DiskPose>,
    pub(super) breaks: Vec<Break>,
    pub(super) events_s: Vec<f64>,
    /// Contact-driven displacement of the suspension's pivot; `None` on a rigid base.
    pub(super) pivot: Option<Box<StructuralHistory>>,
}

/// One end of a cubic.
#[derive(Clone, Copy)]
struct End {
    time_s: f64,
    pose: DiskPose,
    rate: DiskPose,
}

impl StructuralHistory {
    /// Step of the grid, s.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// Last instant, s.
    pub fn end_s(&self) -> f64 {
        self.pose.len().saturating_sub(1) as f64 * self.step_s
    }

    /// Poses at the nodes k × step.
    pub fn nodes(&self) -> &[DiskPose] {
        &self.pose
    }

    /// The two ends of the cubic that holds `time_s`; from the right at a break.
    fn ends(&self, time_s: f64) -> (End, End) {
        let last = self.pose.len() - 1;
        let k = ((time_s / self.step_s).max(0.0) as usize).min(last.saturating_sub(1));
        let node = |k: usize| End {
            time_s: k as f64 * self.step_s,
            pose: self.pose[k],
            rate: self.rate[k],
        };
        let (mut left, mut right) = (node(k), node((k + 1).min(last)));
        let first = self.breaks.partition_point(|b| b.time_s <= left.time_s);
        for b in &self.breaks[first..] {
            if b.time_s > right.time_s {
                break;
            }
            if time_s < b.time_s {
                right = End {
                    time_s: b.time_s,
                    pose: b.pose,
                    rate: b.rate_before,
                };
                break;
            }
            left = End {
                time_s: b.time_s,
                pose: b.pose,
                rate: b.rate_after,
            };
        }
        (left, right)
    }
}

impl DiskMotion for StructuralHistory {
    fn pose(&self, time_s: f64) -> DiskPose {
        let (a, b) = self.ends(time_s);
        let h = b.time_s - a.time_s;
        if h <= 0.0 {
            return a.pose;
        }
        let x = ((time_s - a.time_s) / h).clamp(0.0, 1.0);
        let y = 1.0 - x;
        let weights = [
            (1.0 + 2.0 * x) * y * y,
            (1.0 + 2.0 * y) * x * x,
            h * x * y * y,
            -h * x * x * y,
        ];
        combine([a.pose, b.pose, a.rate, b.rate], weights)
    }

    fn pose_rate(&self, time_s: f64) -> DiskPose {
        let (a, b) = self.ends(time_s);
        let h = b.time_s - a.time_s;
        if h <= 0.0 {
            return a.rate;
        }
        let x = ((time_s - a.time_s) / h).clamp(0.0, 1.0);
        let y = 1.0 - x;
        let weights = [
            -6.0 * x * y / h,
            6.0 * x * y / h,
            y * (1.0 - 3.0 * x),
            x * (1.0 - 3.0 * y),
        ];
        combine([a.pose, b.pose, a.rate, b.rate], weights)
    }

    fn events_s(&self) -> &[f64] {
        &self.events_s
    }

    fn pivot(&self, time_s: f64) -> [f64; 2] {
        let Some(pivot) = &self.pivot else {
            return [0.0; 2];
        };
        let (at, rate) = (pivot.pose(time_s), pivot.pose_rate(time_s));
        [at.displacement_m, rate.displacement_m]
    }
}

fn combine(poses: [DiskPose; 4], weights: [f64; 4]) -> DiskPose {
    let mut sum = DiskPose::default();
    for (p, w) in poses.iter().zip(weights) {
        sum.displacement_m += w * p.displacement_m;
        sum.pitch_rad += w * p.pitch_rad;
        sum.roll_rad += w * p.roll_rad;
    }
    sum
}
