//! Slider body and the rails of its surface, as plain data.

/// Slider body and its place over the disk.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SliderParameters {
    /// Radius of the slider's centre, m.
    pub radius_m: f64,
    /// Angle of the slider's centre in the disk's sense of rotation, rad (same origin as the ramp).
    pub angle_rad: f64,
    /// Skew: the disk's velocity makes this angle with x, positive towards +y, rad.
    pub skew_rad: f64,
    /// Length along x, m.
    pub length_m: f64,
    /// Width along y, m.
    pub width_m: f64,
    /// Height, m.
    pub height_m: f64,
    /// Density, kg/m3.
    pub density_kg_per_m3: f64,
    /// Air-bearing surface.
    pub surface: SurfaceParameters,
}

/// Air-bearing surface. Recess is positive away from the disk, from the reference plane.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct SurfaceParameters {
    /// Recess of everything no rail covers, m.
    pub base_recess_m: f64,
    /// Crown: how much closer to the disk the middle lies than the ends along x, m.
    pub crown_m: f64,
    /// Camber: how much closer to the disk the middle lies than the sides along y, m.
    pub camber_m: f64,
    /// Twist: how much farther from the disk the trailing outer and leading inner corners lie
    /// than the middle, the other two as much closer, m.
    pub twist_m: f64,
    /// Leading-edge taper length (0 = none), m.
    pub taper_length_m: f64,
    /// Leading-edge taper angle, rad.
    pub taper_angle_rad: f64,
    /// Rails; later ones overwrite earlier ones.
    pub rails: Vec<Rail>,
}

/// A rail: an area of one recess depth.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Rail {
    /// Outline.
    pub outline: RailOutline,
    /// Recess, m (0 = reference plane).
    pub recess_m: f64,
}

/// Outline of a rail in slider coordinates.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub enum RailOutline {
    /// Axis-parallel rectangle.
    Rectangle {
        /// x range, m.
        x_m: [f64; 2],
        /// y range, m.
        y_m: [f64; 2],
    },
    /// Simple polygon, counter-clockwise.
    Polygon {
        /// Corners, m.
        points_m: Vec<[f64; 2]>,
    },
}
