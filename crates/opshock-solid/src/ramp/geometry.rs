//! Dimensions of a parametric load/unload ramp, and checks that its parts fit together.
//!
//! ```text
//!   z                 section y = 0                            plan
//!   |       slope         root
//!   |    <------->   ____________________            ___________________________
//!   |            __--      finger |      |          |        |        |  bolted |
//!   |   tip   |--_________________|      |     _____|  body  |  neck  |   pad   | width
//!   |         0 . . . slot: disk  | body |    |finger        |        |         |
//!   |         |--_________________|      |    |_____|        |        |         |
//!   |            --__             |      |          |________|________|_________|
//!   |                --___________|      |
//!   |                             |      |_________________
//!   |                             |______|___neck_|__pad___|   mount, its pad bolted from below
//!   +---------------------------------------------------------- x, outwards from the tips
//! ```
//!
//! The disk's rim stands in the slot, whose height is the disk's thickness plus both clearances. The fingers reach over
//! it; the head's lift tab slides up the slope on their outer faces. z = 0 is the middle of the disk, y = 0 a plane of
//! symmetry. Fillets are neglected.

/// Dimensions of a ramp, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampGeometry {
    /// From the tips to the body.
    pub finger_length_m: f64,
    /// Width of the fingers.
    pub finger_width_m: f64,
    /// Thickness of a finger at its tip.
    pub tip_thickness_m: f64,
    /// Thickness of a finger behind its slope.
    pub root_thickness_m: f64,
    /// Length over which a finger grows from tip to root thickness.
    pub slope_length_m: f64,
    /// Body along x.
    pub body_length_m: f64,
    /// Body and mount along y.
    pub body_width_m: f64,
    /// From the middle of the disk down to the lower face of body and mount.
    pub body_depth_m: f64,
    /// Free part of the mount behind the body; 0 for none.
    pub neck_length_m: f64,
    /// Bolted part of the mount; 0 for a body that is bolted itself.
    pub pad_length_m: f64,
    /// Thickness of the mount.
    pub mount_thickness_m: f64,
    /// From the middle of the disk up to the upper finger.
    pub slot_above_m: f64,
    /// From the middle of the disk down to the lower finger.
    pub slot_below_m: f64,
    /// From the tips to the middle of the contact.
    pub contact_m: f64,
    /// Length of the contact along x; across it is as wide as the finger.
    pub contact_length_m: f64,
}

/// Errors of a geometry.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A dimension out of its range.
    #[error("{name} = {} mm is outside its range ({allowed})", mm(*value))]
    Dimension {
        /// Name of the field.
        name: &'static str,
        /// Value found, m.
        value: f64,
        /// Allowed range in words.
        allowed: String,
    },
    /// Elements larger than a part, or more elements than allowed.
    #[error(
        "a mesh size of {} mm asks for {elements} cells, 1 to {MOST_ELEMENTS} elements are allowed",
        mm(*size_m)
    )]
    MeshSize {
        /// Size asked for, m.
        size_m: f64,
        /// Elements it leads to.
        elements: usize,
    },
}

/// Most elements of a ramp: 1.2 GB and some ten seconds for opshock's own.
pub const MOST_ELEMENTS: usize = 5_000;

/// Millimetres without the digits of rounding.
fn mm(length_m: f64) -> f64 {
    (1e9 * length_m).round() / 1e6
}

impl RampGeometry {
    /// A ramp of a 2.5-inch drive with one disk, opshock's own: fingers that overlap the rim by
    /// 0.7 mm, a slope of 18 degrees, a body of 3 mm × 4 mm held by a flange with one screw.
    ///
    /// The slot is that of a disk of 0.635 mm with 100 µm above and below.
    pub fn mobile_drive() -> Self {
        Self {
            finger_length_m: 3.2e-3,
            finger_width_m: 1.6e-3,
            tip_thickness_m: 0.3e-3,
            root_thickness_m: 0.9e-3,
            slope_length_m: 1.8e-3,
            body_length_m: 3.0e-3,
            body_width_m: 4.0e-3,
            body_depth_m: 2.6e-3,
            neck_length_m: 0.8e-3,
            pad_length_m: 2.8e-3,
            mount_thickness_m: 0.8e-3,
            slot_above_m: 0.4175e-3,
            slot_below_m: 0.4175e-3,
            contact_m: 0.35e-3,
            contact_length_m: 0.3e-3,
        }
    }

    /// Checks that the parts fit together.
    ///
    /// # Errors
    /// The first fault found.
    pub fn validate(&self) -> Result<(), GeometryError> {
        let fault = |name, value, allowed| GeometryError::Dimension {
            name,
            value,
            allowed,
        };
        let positive = [
            ("finger_length", self.finger_length_m),
            ("finger_width", self.finger_width_m),
            ("tip_thickness", self.tip_thickness_m),
            ("root_thickness", self.root_thickness_m),
            ("slope_length", self.slope_length_m),
            ("body_length", self.body_length_m),
            ("body_width", self.body_width_m),
            ("body_depth", self.body_depth_m),
            ("slot_above", self.slot_above_m),
            ("slot_below", self.slot_below_m),
            ("contact", self.contact_m),
            ("contact_length", self.contact_length_m),
        ];
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(fault(name, value, "finite and above 0".into()));
            }
        }
        for (name, value) in [
            ("neck_length", self.neck_length_m),
            ("pad_length", self.pad_length_m),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(fault(name, value, "finite and at least 0".into()));
            }
        }
        let at_most = |name, value, bound: f64, of: &str| {
            if value > bound {
                let allowed = format!("at most {} mm, {of}", mm(bound));
                return Err(fault(name, value, allowed));
            }
            Ok(())
        };
        at_most(
            "finger_width",
            self.finger_width_m,
            self.body_width_m,
            "the body's width",
        )?;
        at_most(
            "tip_thickness",
            self.tip_thickness_m,
            self.root_thickness_m,
            "the root's thickness",
        )?;
        at_most(
            "slope_length",
            self.slope_length_m,
            self.finger_length_m,
            "the finger's length",
        )?;
        let half = 0.5 * self.contact_length_m;
        at_most(
            "contact_length",
            self.contact_length_m,
            2.0 * self.contact_m,
            "twice the distance of the contact from the tip",
        )?;
        at_most(
            "contact",
            self.contact_m,
            self.finger_length_m - half,
            "which leaves the contact on the finger",
        )?;
        let lowest = self.slot_below_m + self.root_thickness_m;
        let has_mount = self.pad_length_m > 0.0;
        let mount = if has_mount {
            self.mount_thickness_m
        } else {
            0.0
        };
        if has_mount && !(mount.is_finite() && mount > 0.0) {
            return Err(fault("mount_thickness", mount, "finite and above 0".into()));
        }
        if !has_mount && self.neck_length_m > 0.0 {
            return Err(fault(
                "pad_length",
                self.pad_length_m,
                "above 0 behind a neck".into(),
            ));
        }
        if self.body_depth_m < lowest + mount {
            let allowed = format!(
                "at least {} mm, half the slot, the lower finger and the mount",
                mm(lowest + mount)
            );
            return Err(fault("body_depth", self.body_depth_m, allowed));
        }
        Ok(())
    }

    /// Thickness of a finger at `x_m` from its tip.
    pub fn thickness_m(&self, x_m: f64) -> f64 {
        let share = (x_m / self.slope_length_m).clamp(0.0, 1.0);
        self.tip_thickness_m + share * (self.root_thickness_m - self.tip_thickness_m)
    }

    /// Volume, m³, in closed form.
    pub fn volume_m3(&self) -> f64 {
        let section = self.finger_length_m * self.root_thickness_m
            - 0.5 * self.slope_length_m * (self.root_thickness_m - self.tip_thickness_m);
        let height = self.body_depth_m + self.slot_above_m + self.root_thickness_m;
        let mount = (self.neck_length_m + self.pad_length_m) * self.mount_thickness_m;
        2.0 * section * self.finger_width_m
            + self.body_length_m * self.body_width_m * height
            + mount * self.body_width_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_names_its_dimension() {
        let good = RampGeometry::mobile_drive();
        good.validate().unwrap();
        type Change = fn(&mut RampGeometry);
        let cases: [(&str, Change); 12] = [
            ("finger_length", |g| g.finger_length_m = 0.0),
            ("root_thickness", |g| g.root_thickness_m = f64::NAN),
            ("body_width", |g| g.body_width_m = -1.0),
            ("neck_length", |g| g.neck_length_m = -1e-6),
            ("finger_width", |g| g.finger_width_m = 5e-3),
            ("tip_thickness", |g| g.tip_thickness_m = 1e-3),
            ("slope_length", |g| g.slope_length_m = 4e-3),
            ("contact_length", |g| g.contact_length_m = 0.8e-3),
            ("contact", |g| g.contact_m = 3.1e-3),
            ("mount_thickness", |g| g.mount_thickness_m = 0.0),
            ("pad_length", |g| g.pad_length_m = 0.0),
            ("body_depth", |g| g.body_depth_m = 1.5e-3),
        ];
        for (expected, change) in cases {
            let mut bad = good;
            change(&mut bad);
            match bad.validate() {
                Err(GeometryError::Dimension { name, .. }) => assert_eq!(name, expected),
                other => panic!("{expected}: {other:?}"),
            }
        }
    }
}
