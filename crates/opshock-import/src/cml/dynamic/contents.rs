//! Contents of the file of a dynamic run, `DynLULS.def`.

/// Data of a drive under a shock.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicFile {
    /// Version of the format.
    pub version: String,
    /// Length of the slider, m.
    pub length_m: f64,
    /// Its width per length.
    pub width_per_length: f64,
    /// Centre of gravity as written: x, y, z.
    pub centre: [f64; 3],
    /// Load, kg of force.
    pub load_kgf: f64,
    /// Point of the load from the slider's centre, m.
    pub load_point_m: [f64; 2],
    /// `halt`, as written.
    pub halt: f64,
    /// Speed, rev/min.
    pub speed_rpm: f64,
    /// Time step, s.
    pub step_s: f64,
    /// End of the run, s.
    pub end_s: f64,
    /// Radius of the slider, m.
    pub radius_m: f64,
    /// First and last radius of a move, m.
    pub move_radii_m: [f64; 2],
    /// `iact`, `dact`, `vact`: the actuator's motion, as written.
    pub actuator: [f64; 3],
    /// Arm from the actuator's pivot to the slider, m; 0 where there is none.
    pub arm_m: f64,
    /// Skew, deg.
    pub skew_deg: f64,
    /// Height, pitch, roll, dx, dy, yaw at the start, as written.
    pub attitude: [f64; 6],
    /// Gas, where its section has the names of `run.dat`.
    pub gas: Option<Gas>,
    /// Pulse.
    pub shock: Option<Shock>,
    /// What is known of the suspension's matrices.
    pub suspension: Contents,
    /// Disk.
    pub disk: Disk,
    /// Ramp.
    pub ramp: Ramp,
}

/// The gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Ambient pressure, Pa.
    pub pressure_pa: f64,
    /// Mean free path, m.
    pub mean_free_path_m: f64,
    /// Viscosity, Pa s.
    pub viscosity_pa_s: f64,
}

/// Shape of a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Half a sine.
    HalfSine,
    /// Constant.
    Square,
    /// A sine.
    Sine,
    /// A sine that decays.
    DecayingSine,
}

/// Modes of the pulse that are read, and their shapes.
pub(super) const SHAPES: [(usize, Shape); 4] = [
    (1, Shape::HalfSine),
    (2, Shape::Square),
    (3, Shape::Sine),
    (4, Shape::DecayingSine),
];

/// A pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shock {
    /// Shape.
    pub shape: Shape,
    /// Start, s.
    pub start_s: f64,
    /// Width, s.
    pub width_s: f64,
    /// Magnitude, multiples of 9.80665 m/s².
    pub magnitude_g: f64,
    /// Time constant of the decay, s.
    pub time_constant_s: f64,
}

/// What the matrices beside the file contain.
#[derive(Clone, Debug, PartialEq)]
pub enum Contents {
    /// Their section does not start with whole numbers.
    Unknown,
    /// The suspension.
    Suspension(Matrices),
    /// Suspension, flexure and slider, as a deck of version 6.4 has them.
    Deck(DeckSuspension),
}

/// Suspension of a deck of version 6.4. Its matrices contain the slider, on the springs of the flexure.
#[derive(Clone, Debug, PartialEq)]
pub struct DeckSuspension {
    /// Rows.
    pub n_rows: usize,
    /// Rows of the slider along and about x, y, z, counted from 1.
    pub slider_rows: [usize; 6],
    /// Row of the load beam's displacement z at the dimple.
    pub dimple_row: usize,
    /// Force of the dimple without load, N.
    pub preload_n: f64,
    /// Gaps of the limiters, m.
    pub limiters_m: Vec<f64>,
    /// Static pitch and roll attitude, rad.
    pub static_angles_rad: [f64; 2],
    /// Rayleigh damping, share of the mass matrix, 1/s.
    pub alpha_per_s: f64,
    /// Share of the stiffness matrix, s.
    pub beta_s: f64,
}

/// Matrices beside the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Matrices {
    /// Rows.
    pub n_rows: usize,
    /// Row of the slider's first freedom, counted from 1.
    pub slider_row: usize,
}

/// The disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Radii of clamp and rim, m.
    pub radii_m: [f64; 2],
    /// Thickness, m.
    pub thickness_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
    /// Rayleigh damping, share of the mass matrix, 1/s.
    pub alpha_per_s: f64,
    /// Share of the stiffness matrix, s.
    pub beta_s: f64,
}

/// Place of the ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// Distance from the actuator's pivot, m.
    pub distance_m: f64,
    /// Angle at the pivot from the slider outwards, deg.
    pub angle_deg: f64,
    /// Clearance to the disk, m.
    pub clearance_m: f64,
    /// Sides of the disk that have one: 0, 1 or 2.
    pub sides: usize,
}

/// Number of the model of Fukui and Kaneko.
pub(super) const FUKUI_KANEKO: usize = 5;
