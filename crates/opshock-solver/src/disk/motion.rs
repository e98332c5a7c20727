//! Motion of the disk under the slider, as the head sees it.

/// Pose of the disk's surface under the slider's centre, in the slider's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiskPose {
    /// Displacement along z, m.
    pub displacement_m: f64,
    /// Slope in the sense of positive slider pitch (-dw/dx), rad.
    pub pitch_rad: f64,
    /// Slope in the sense of positive slider roll (dw/dy), rad.
    pub roll_rad: f64,
}

impl DiskPose {
    /// Sum of two small poses.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            displacement_m: self.displacement_m + other.displacement_m,
            pitch_rad: self.pitch_rad + other.pitch_rad,
            roll_rad: self.roll_rad + other.roll_rad,
        }
    }

    /// The pose times a number.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self {
            displacement_m: factor * self.displacement_m,
            pitch_rad: factor * self.pitch_rad,
            roll_rad: factor * self.roll_rad,
        }
    }
}

/// The disk's motion under the slider as the head sees it. Time 0 is the onset of the pulse.
pub trait DiskMotion: Sync {
    /// Pose at `time_s`.
    fn pose(&self, time_s: f64) -> DiskPose;
    /// Time derivative of the pose at `time_s` (from the right at a jump).
    fn pose_rate(&self, time_s: f64) -> DiskPose;
    /// Sorted instants at which a step must end (jumps and kinks of the motion), s.
    fn events_s(&self) -> &[f64];
    /// Motion of the suspension's pivot that its load does not tell, and its rate (from the right at a jump):
    /// the head's masses are told by a load per mass what shakes them, but a jump of the pivot's velocity is
    /// none. Poses are not over this motion.
    fn pivot(&self, _time_s: f64) -> [f64; 2] {
        [0.0; 2]
    }
}
