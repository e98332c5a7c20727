//! Interface between structure and head: the motion of the disk under the slider.

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

/// Motion of the disk under the slider, which drives the head. Time 0 is the onset of the pulse.
pub trait DiskMotion: Sync {
    /// Pose at `time_s`.
    fn pose(&self, time_s: f64) -> DiskPose;
    /// Time derivative of the pose at `time_s` (from the right at a jump).
    fn pose_rate(&self, time_s: f64) -> DiskPose;
    /// Sorted instants at which a step must end (jumps and kinks of the motion), s.
    fn events_s(&self) -> &[f64];
    /// Motion of the suspension's pivot beyond that of its load, and its rate (from the right at a jump). A load per
    /// mass drives the head's masses, and a jump of the pivot's velocity has none. Poses are not relative to this
    /// motion.
    fn pivot(&self, _time_s: f64) -> [f64; 2] {
        [0.0; 2]
    }
}
