//! The table of keys: everything a study file may say, in the order it is written out.
//!
//! Reading, messages, defaults, the JSON Schema, `study.resolved.toml` and the digest all come
//! from this table and from nothing else. The defaults describe one robust 2.5-inch drive (the
//! set of `studies/drive-2.5in`), so that a short study is a valid one.
//!
//! Sources of the default drive: disk, ramp place, ramp clearance: sample data of the CMLAir 8.01
//! user manual (Mardan and Bogy, 2011). Suspension and air-bearing surface: opshock's own designs.

use opshock_import::matrix::units::Units;
use opshock_solver::scene::knob::Knob;
use std::sync::LazyLock;

use super::key::{ABOVE_ZERO, ANY, Choice, FROM_ZERO, Key, Kind, above, below, closed, open};
use super::words::{self, Ramp, Sign, names};
use Kind::{
    Axis, Flag, Integer, Number, NumberOrWord, Numbers, Pair, Points, Tables, Text, Word, Words,
};

/// Ramp models, in canonical order.
pub const RAMPS: &[&str] = &[
    Ramp::None.as_str(),
    Ramp::Rigid.as_str(),
    Ramp::Deformable.as_str(),
];
/// Signs, in canonical order.
pub const SIGNS: &[&str] = &[Sign::Plus.as_str(), Sign::Minus.as_str()];
/// Outputs that disk and ramp alone give.
pub const STRUCTURE_OUTPUTS: &[&str] = &[
    "disk_displacement",
    "ramp_displacement",
    "contact_force",
    "touch_threshold",
];
/// Every output.
pub const OUTPUTS: &[&str] = &[
    "critical_shock",
    "min_clearance",
    "slider_attitude",
    "pitch",
    "steady_attitude",
    "bearing_force",
    "dimple_force",
    "disk_displacement",
    "ramp_displacement",
    "contact_force",
    "touch_threshold",
    "pressure_field",
];
/// Effects that can be left out by hand.
pub const LEAVE_OUT: &[&str] = &["air_bearing"];
/// Named materials of a ramp.
pub const RAMP_MATERIALS: &[&str] = &["POM", "LCP", "PEEK", "PEI", "PPS", "aluminium", "steel"];
/// Named surfaces.
pub const SURFACES: &[&str] = &["femto-2.5in"];

/// Discretisation parameters of a scene.
pub const DISCRETISATION: &[&str] = &[
    Knob::FilmGrid.as_str(),
    Knob::DiskModes.as_str(),
    Knob::SuspensionModes.as_str(),
    Knob::StructureStep.as_str(),
    Knob::HeadTolerance.as_str(),
    Knob::CouplingTolerance.as_str(),
];

const RATIO: Kind = Number(FROM_ZERO);
const LENGTH: Kind = Number(ABOVE_ZERO);

/// A head's name, behind which stand the keys that it may have of its own.
const NAME_OF_A_HEAD: &str = "heads[].head";
/// What a head may have of its own: these keys, and all below the last two.
const OF_A_HEAD: [&str; 10] = [
    "disk.thickness_mm",
    "ramp.clearance_um",
    "ramp.clearance_top_um",
    "ramp.clearance_bottom_um",
    "slider.radius_mm",
    "slider.angle_deg",
    "slider.skew_deg",
    "slider.faces",
    "slider.surface.",
    "suspension.",
];

/// The table, with what a head may have of its own.
pub static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
    let is_own = |key: &&Key| {
        let all_below = |own: &str| own.ends_with('.') && key.path.starts_with(own);
        OF_A_HEAD
            .iter()
            .any(|own| key.path == *own || all_below(own))
    };
    let own: Vec<Key> = TABLE.iter().filter(is_own).map(Key::of_a_head).collect();
    let name = TABLE.iter().position(|key| key.path == NAME_OF_A_HEAD);
    let (before, after) = TABLE.split_at(name.map_or(TABLE.len(), |name| name + 1));
    [before, &own, after].concat()
});

/// The table as it is written here.
static TABLE: &[Key] = &[
    Key::required("study_format", Integer(1, 1), "1", "Version of the study file's format."),
    Key::required("name", Text, "\"Fig. 13: three ramp models\"", "Name of the study, printed on every product."),
    Key::or("outputs", Words(OUTPUTS), "[\"critical_shock\"]", "What is wanted; only the effects these need are simulated.").code("E158"),
    // heads
    Key::optional("head", Text, "every head", "\"0 up\"", "Of several heads the one that is simulated.").code("E191"),
    Key::optional("heads", Tables, "one head", "[{ head = \"0 up\", slider.radius_mm = 21.0 }, { head = \"0 down\", slider.radius_mm = 21.0, suspension.gram_load_gf = 2.3 }]", "Heads of a drive, each with its slider, suspension, disk and gap of the ramp: an axis of the study. What an entry leaves out is the study's.").code("E191"),
    Key::required(NAME_OF_A_HEAD, Text, "\"0 up\"", "Name of the head, as tables show it.").code("E191"),
    // pulse
    Key::or("pulse.shape", Word(&names(&words::SHAPES)), "\"half_sine\"", "Shape of the acceleration pulse."),
    Key::required("pulse.widths_ms", Axis(ABOVE_ZERO), "[0.5, 1.0, 2.0]", "Pulse widths: an axis of the study.").usual(0.05, 100.0).code("E150"),
    Key::or("pulse.signs", Words(SIGNS), "[\"+\", \"-\"]", "Signs of the shock: + moves the disk towards the slider first."),
    Key::or("pulse.start_ms", Number(FROM_ZERO), "0.5", "Onset of the pulse on the time axis of every output.").usual(0.0, 1000.0).code("E150"),
    Key::or("pulse.window_ms", NumberOrWord(ABOVE_ZERO, &["until_decayed"]), "5.0", "Simulated time after the onset.").usual(0.1, 500.0).code("E152"),
    Key::or("pulse.decay_share", Number(open(0.0, 1.0)), "0.01", "Share of the peak energy of disk and ramp that ends the window until_decayed.").code("E152"),
    Key::or("pulse.window_max_ms", Number(ABOVE_ZERO), "50.0", "Longest window until_decayed.").usual(0.1, 5000.0).code("E152"),
    Key::or("pulse.rise_share", Number(above(0.0, 0.5)), "0.1", "Share of the width in which a trapezoid rises, and again falls.").code("E150"),
    Key::or("pulse.frequency_hz", Number(ABOVE_ZERO), "1000.0", "Frequency of a damped sine.").usual(10.0, 1e5).code("E150"),
    Key::or("pulse.decay_per_s", Number(FROM_ZERO), "500.0", "Decay rate of a damped sine.").usual(0.0, 1e6).code("E150"),
    Key::optional("pulse.table", Text, "no table", "\"pulse.csv\"", "File of a sampled pulse, two columns: time in ms from 0, relative acceleration. Stretched to the width, scaled to a largest value of 1."),
    Key::optional("pulse.table_time_ms", Numbers(FROM_ZERO), "no table", "[0.0, 0.5, 1.0]", "Times of a sampled pulse given here instead of in a file.").code("E153"),
    Key::optional("pulse.table_relative", Numbers(ANY), "no table", "[0.0, 1.0, 0.0]", "Relative accelerations of a sampled pulse.").code("E153"),
    Key::optional("pulse.in_plane_x", Number(ANY), "a straight shock", "0.5", "Share of the shock in the plane of the disk, along angle 0: load along x per axial load. Needs a hub.").usual(-10.0, 10.0).code("E138"),
    Key::optional("pulse.in_plane_y", Number(ANY), "a straight shock", "0.5", "The same a quarter turn on in the disk's sense of rotation.").usual(-10.0, 10.0).code("E138"),
    Key::optional("pulse.rotation_x_per_m", Number(ANY), "a straight shock", "10.0", "Angular acceleration felt about x per axial acceleration at the spindle. Needs a hub.").usual(-100.0, 100.0).code("E138"),
    Key::optional("pulse.rotation_y_per_m", Number(ANY), "a straight shock", "10.0", "The same about y.").usual(-100.0, 100.0).code("E138"),
    // disk
    Key::or("disk.inner_radius_mm", LENGTH, "10.01", "Radius of the clamp.").usual(2.0, 30.0).code("E140"),
    Key::or("disk.outer_radius_mm", LENGTH, "32.5", "Radius of the rim.").usual(8.0, 70.0).code("E140"),
    Key::or("disk.thickness_mm", LENGTH, "0.635", "Thickness.").usual(0.1, 3.0),
    Key::or("disk.youngs_modulus_gpa", LENGTH, "75.0", "Young's modulus.").usual(10.0, 700.0),
    Key::or("disk.poisson", Number(open(-1.0, 0.5)), "0.3", "Poisson's ratio.").usual(0.0, 0.45).code("E131"),
    Key::or("disk.density_kg_per_m3", LENGTH, "2710.0", "Density.").usual(1000.0, 12000.0),
    Key::or("disk.rpm", Number(FROM_ZERO), "5400.0", "Speed of rotation; 0 only for studies without the air bearing.").usual(500.0, 25000.0).code("E133"),
    Key::together("disk.damping.rayleigh.alpha_per_s", Number(FROM_ZERO), "25.0", "Material damping, share of the mass matrix, in the rotating frame.").usual(0.0, 1000.0).code("E132"),
    Key::together("disk.damping.rayleigh.beta_s", Number(FROM_ZERO), "1.0e-7", "Material damping, share of the stiffness matrix, in the rotating frame.").usual(0.0, 1e-4).code("E132"),
    Key::optional("disk.damping.modal_ratio", RATIO, "Rayleigh damping", "0.004", "The same damping ratio for every mode of the disk, in the rotating frame.").code("E132"),
    Key::or("disk.space_fixed_damping_per_s", Number(FROM_ZERO), "0.0", "Damping fixed in space (air): force per mass and velocity.").usual(0.0, 1000.0).code("E132"),
    Key::optional("disk.run_out_um", Number(FROM_ZERO), "a plane disk", "5.0", "Axial run-out under the slider once a revolution: amplitude at the rim, growing with the radius.").usual(0.0, 100.0).code("E126"),
    Key::optional("disk.run_out_deg", Number(closed(-360.0, 360.0)), "0", "90.0", "Angle of its highest point at the onset of the shock, in the disk's sense of rotation.").code("E126"),
    Key::optional("disk.waves", Tables, "a plane disk", "[{ harmonic = 12, amplitude_nm = 20.0 }]", "Waves of the disk's surface that turn with it under the slider.").code("E126"),
    Key::required("disk.waves[].harmonic", Integer(1, 10000), "12", "Waves a revolution.").code("E126"),
    Key::required("disk.waves[].amplitude_nm", Number(FROM_ZERO), "20.0", "Amplitude, the same at every radius.").usual(0.0, 1e4).code("E126"),
    Key::optional("disk.waves[].phase_deg", Number(closed(-360.0, 360.0)), "0", "90.0", "Phase at angle 0 at the onset of the shock.").code("E126"),
    // hub
    Key::optional("hub.axial_stiffness_n_per_m", LENGTH, "the disk is clamped to the base", "8.0e6", "Axial stiffness of the hub's bearing; with both stiffnesses the disk stands on a hub.").usual(1e4, 1e12).code("E137"),
    Key::optional("hub.tilt_stiffness_n_m_per_rad", LENGTH, "the disk is clamped to the base", "300.0", "Stiffness of the bearing against tilt of the hub.").usual(0.1, 1e7).code("E137"),
    Key::optional("hub.mass_mg", Number(FROM_ZERO), "0", "15000.0", "Mass that moves with the hub, without the free part of the disk.").usual(100.0, 1e6).code("E137"),
    Key::optional("hub.transverse_inertia_mg_mm2", Number(FROM_ZERO), "0", "4.0e5", "Its moment of inertia about a diameter, at the bearing's centre.").usual(1e2, 1e9).code("E137"),
    Key::optional("hub.polar_inertia_mg_mm2", Number(FROM_ZERO), "0", "6.0e5", "Its moment of inertia about the axis of spin.").usual(1e2, 1e9).code("E137"),
    Key::optional("hub.axial_damping_n_s_per_m", Number(FROM_ZERO), "0", "50.0", "Axial damping of the bearing.").usual(0.0, 1e5).code("E137"),
    Key::optional("hub.tilt_damping_n_m_s_per_rad", Number(FROM_ZERO), "0", "2.0e-3", "Damping of the hub's tilt.").usual(0.0, 100.0).code("E137"),
    Key::optional("hub.cross_stiffness_n_m_per_rad", Number(ANY), "0", "1.0", "Moment across a tilt; positive drives the whirl that goes with the spin.").usual(-1e5, 1e5).code("E137"),
    Key::optional("hub.cross_damping_n_m_s_per_rad", Number(ANY), "0", "1.0e-4", "Moment across the velocity of a tilt, in the sense of the gyroscopic one.").usual(-100.0, 100.0).code("E137"),
    Key::optional("hub.centre_height_mm", Number(ANY), "0", "1.5", "Centre of mass of rotor and disk above the centre of tilt: arm of a shock in the disk's plane.").usual(-20.0, 20.0).code("E137"),
    // base
    Key::optional("base.modes", Tables, "a rigid base", "[{ frequency_hz = 900.0, damping_ratio = 0.02, participation_sqrt_kg = 0.25, spindle_per_sqrt_kg = 2.0, ramp_per_sqrt_kg = 2.4, pivot_per_sqrt_kg = 1.6 }]", "Modes of base plate and housing under the shock, of unit modal mass. Needs a straight shock.").code("E189"),
    Key::required("base.modes[].frequency_hz", LENGTH, "900.0", "Undamped natural frequency.").usual(10.0, 1e5).code("E189"),
    Key::or("base.modes[].damping_ratio", Number(below(0.0, 1.0)), "0.02", "Damping ratio.").usual(0.0, 0.5).code("E132"),
    Key::required("base.modes[].participation_sqrt_kg", Number(ANY), "0.25", "Load on the mode by a unit acceleration of the base."),
    Key::required("base.modes[].spindle_per_sqrt_kg", Number(ANY), "2.0", "Displacement of the spindle along the disk's axis."),
    Key::required("base.modes[].ramp_per_sqrt_kg", Number(ANY), "2.4", "Displacement of the ramp's mount."),
    Key::required("base.modes[].pivot_per_sqrt_kg", Number(ANY), "1.6", "Displacement of the actuator's pivot, which carries the suspension."),
    Key::optional("base.imported.mass", Text, "modes, or a rigid base", "\"base.mas\"", "Mass matrix of the base by another program: Matrix Market (.mtx), CalculiX (.mas), or rows of numbers."),
    Key::optional("base.imported.stiffness", Text, "modes, or a rigid base", "\"base.sti\"", "Its stiffness matrix."),
    Key::optional("base.imported.freedoms", Text, "places", "\"base.dof\"", "Freedoms of the rows, a line node.direction each."),
    Key::optional("base.imported.places", Text, "freedoms", "\"base_cords.dat\"", "Places and kinds of the rows, a line x y z type each, mm."),
    Key::optional("base.imported.units", Word(&names(&Units::WORDS)), "si", "\"mm_n\"", "Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t."),
    Key::optional("base.imported.spindle", Integer(1, 1_000_000_000), "modes, or a rigid base", "12", "Node of the spindle; its displacement z is along the disk's axis."),
    Key::optional("base.imported.ramp", Integer(1, 1_000_000_000), "modes, or a rigid base", "34", "Node of the ramp's mount."),
    Key::optional("base.imported.pivot", Integer(1, 1_000_000_000), "modes, or a rigid base", "56", "Node of the actuator's pivot."),
    Key::optional("base.imported.held", Numbers(ABOVE_ZERO), "the mounts are springs in the matrices", "[1, 2]", "Nodes that move with the shock; their mass loads the others."),
    Key::optional("base.imported.cut_khz", LENGTH, "10.0", "10.0", "Natural modes below this frequency are kept, at most 16.").usual(0.1, 100.0).code("E189"),
    Key::optional("base.imported.damping_ratio", Number(below(0.0, 1.0)), "0.02", "0.02", "Damping ratio of every mode.").usual(0.0, 0.5).code("E132"),
    // ramp
    Key::required("ramp.models", Words(RAMPS), "[\"none\", \"rigid\", \"deformable\"]", "Ramp models: an axis of the study."),
    Key::or("ramp.clearance_um", Number(FROM_ZERO), "100.0", "Static clearance between disk and ramp, above and below.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.clearance_top_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance above the disk, when unequal.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.clearance_bottom_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance below the disk, when unequal.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.run_out", Word(&names(&words::RUN_OUT)), "none", "\"lowest_gap\"", "lowest_gap takes the run-out of the disk at the ramp off the gaps above and below it: the lowest gap of a revolution.").code("E143"),
    Key::or("ramp.radius_mm", LENGTH, "32.15", "Radius of the contact points.").usual(5.0, 70.0).code("E141"),
    Key::or("ramp.angle_deg", Number(closed(-360.0, 360.0)), "0.0", "Angle of the contact points in the disk's sense of rotation."),
    Key::or("ramp.restitution", Number(closed(0.0, 1.0)), "0.0", "Coefficient of restitution of an impact; 0 with a contact stiffness.").code("E136"),
    Key::optional("ramp.contact_stiffness_n_per_m", LENGTH, "a hard contact", "1.0e6", "Local stiffness between each arm and its contact point.").usual(1e4, 1e9).code("E136"),
    Key::optional("ramp.contact_frequency_khz", LENGTH, "400.0", "400.0", "Natural frequency of the contact's stiffness on the mass it is given: above what an impact carries to the slider.").usual(100.0, 1000.0).code("E136"),
    Key::optional("ramp.contact_damping_ratio", Number(closed(0.0, 1.0)), "0.5", "0.5", "Damping ratio at that frequency, where ringing is no physics; 0.5 at 400 kHz is a loss factor of 6 % at 25 kHz.").usual(0.0, 1.0).code("E132"),
    Key::together("ramp.deformable.modes", Tables, "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }, { frequency_hz = 17500.0, mass_mg = 35.1, participation = 0.789 }]", "Modes of each arm, scaled to 1 at the contact point; both arms alike.").code("E135"),
    Key::required("ramp.deformable.modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6),
    Key::required("ramp.deformable.modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5),
    Key::required("ramp.deformable.modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0),
    Key::optional("ramp.deformable.modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::optional("ramp.deformable.bottom_modes", Tables, "as modes", "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }]", "Modes of the bottom arm, when the arms differ.").code("E135"),
    Key::required("ramp.deformable.bottom_modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6),
    Key::required("ramp.deformable.bottom_modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5),
    Key::required("ramp.deformable.bottom_modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0),
    Key::optional("ramp.deformable.bottom_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::optional("ramp.deformable.geometry.material", Word(RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material; with it the ramp is given by its geometry instead of modes."),
    Key::optional("ramp.deformable.geometry.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0),
    Key::optional("ramp.deformable.geometry.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131"),
    Key::optional("ramp.deformable.geometry.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0),
    Key::optional("ramp.deformable.geometry.finger_length_mm", LENGTH, "3.2", "3.2", "Fingers, from their tips to the body.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.finger_width_mm", LENGTH, "1.6", "1.6", "Width of the fingers.").usual(0.2, 10.0),
    Key::optional("ramp.deformable.geometry.tip_thickness_mm", LENGTH, "0.3", "0.3", "Thickness of a finger at its tip.").usual(0.05, 3.0),
    Key::optional("ramp.deformable.geometry.root_thickness_mm", LENGTH, "0.9", "0.9", "Thickness of a finger behind its slope.").usual(0.1, 5.0),
    Key::optional("ramp.deformable.geometry.slope_length_mm", LENGTH, "1.8", "1.8", "Length of the slope, over which a finger grows from tip to root thickness.").usual(0.1, 20.0),
    Key::optional("ramp.deformable.geometry.body_length_mm", LENGTH, "3.0", "3.0", "Body, along the fingers.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.body_width_mm", LENGTH, "4.0", "4.0", "Width of body and mount.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.body_depth_mm", LENGTH, "2.6", "2.6", "From the middle of the disk down to the lower face of body and mount.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.neck_length_mm", Number(FROM_ZERO), "0.8", "0.8", "Free part of the mount behind the body; 0 for none.").usual(0.0, 10.0),
    Key::optional("ramp.deformable.geometry.pad_length_mm", Number(FROM_ZERO), "2.8", "2.8", "Bolted part of the mount; 0 for a body bolted itself.").usual(0.0, 20.0),
    Key::optional("ramp.deformable.geometry.mount_thickness_mm", LENGTH, "0.8", "0.8", "Thickness of the mount.").usual(0.1, 10.0),
    Key::optional("ramp.deformable.geometry.contact_mm", LENGTH, "0.35", "0.35", "From the tips to the middle of the contact with the disk.").usual(0.05, 10.0),
    Key::optional("ramp.deformable.geometry.contact_length_mm", LENGTH, "0.3", "0.3", "Length of the contact along the finger, over which its force is spread.").usual(0.02, 5.0),
    Key::optional("ramp.deformable.geometry.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.geometry.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.geometry.mesh_size_mm", LENGTH, "1.0", "0.7", "Longest edge of a finite element; elements at re-entrant corners are a quarter of it.").usual(0.2, 5.0).code("E174"),
    Key::optional("ramp.deformable.geometry.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contact points held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174"),
    Key::optional("ramp.deformable.mesh.file", Text, "a ramp given by modes", "\"ramp.msh\"", "Gmsh mesh (.msh 4.1) of the ramp with physical surfaces mount, top and bottom; z is the disk's axis."),
    Key::optional("ramp.deformable.mesh.material", Word(RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material of the mesh."),
    Key::optional("ramp.deformable.mesh.unit", Word(&names(&words::LENGTH_UNITS)), "mm", "\"mm\"", "Unit of length of the file."),
    Key::optional("ramp.deformable.mesh.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0),
    Key::optional("ramp.deformable.mesh.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131"),
    Key::optional("ramp.deformable.mesh.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0),
    Key::optional("ramp.deformable.mesh.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.mesh.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.mesh.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contacts held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174"),
    Key::optional("ramp.deformable.coupled_modes", Tables, "a ramp given by modes of each arm", "[{ frequency_hz = 3180.2, top_per_sqrt_kg = 211.0, bottom_per_sqrt_kg = 220.0, participation_sqrt_kg = 0.005 }]", "Modes of both arms as one body.").code("E135"),
    Key::required("ramp.deformable.coupled_modes[].frequency_hz", LENGTH, "3180.2", "Undamped natural frequency."),
    Key::required("ramp.deformable.coupled_modes[].top_per_sqrt_kg", Number(ANY), "211.0", "Shape at the top contact, of unit modal mass."),
    Key::required("ramp.deformable.coupled_modes[].bottom_per_sqrt_kg", Number(ANY), "220.0", "Shape at the bottom contact, of unit modal mass."),
    Key::required("ramp.deformable.coupled_modes[].participation_sqrt_kg", Number(ANY), "0.005", "Load on the mode by a unit acceleration of the base."),
    Key::optional("ramp.deformable.coupled_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::or("ramp.deformable.damping_ratio", RATIO, "0.02", "Damping ratio of the arms' modes.").code("E132"),
    // slider
    Key::or("slider.radius_mm", LENGTH, "21.0", "Radius of the slider's centre.").usual(5.0, 70.0),
    Key::or("slider.angle_deg", Number(closed(-360.0, 360.0)), "7.0", "Angle of the slider's centre in the disk's sense of rotation, measured as the ramp's."),
    Key::or("slider.skew_deg", Number(open(-90.0, 90.0)), "0.0", "Angle between the disk's velocity and the slider's length, positive towards the outer side.").usual(-30.0, 30.0),
    Key::optional("slider.faces", Word(&names(&words::FACES)), "down", "\"up\"", "Way the slider faces: down, over the disk, or up, under it, where the shock has the other sign and the ramp's bottom arm is on the slider's side."),
    Key::or("slider.length_mm", LENGTH, "0.85", "Length, leading to trailing edge.").usual(0.2, 5.0),
    Key::or("slider.width_mm", LENGTH, "0.7", "Width, inner to outer side.").usual(0.2, 4.0),
    Key::or("slider.height_mm", LENGTH, "0.23", "Height.").usual(0.05, 1.5),
    Key::or("slider.density_kg_per_m3", LENGTH, "4300.0", "Density.").usual(1000.0, 10000.0),
    Key::optional("slider.viscous_shear", Flag, "no shear", "true", "Shear of the film on the slider, which the suspension balances at the dimple: moments of pitch and roll."),
    Key::optional("slider.surface.preset", Word(SURFACES), "a file, rails given here, or femto-2.5in", "\"femto-2.5in\"", "A named air-bearing surface."),
    Key::optional("slider.surface.file", Text, "no file", "\"surface.toml\"", "File of the air-bearing surface, beside the study."),
    Key::or("slider.surface.base_recess_um", Number(FROM_ZERO), "1.5", "Recess of everything no rail covers.").usual(0.1, 10.0).code("E145"),
    Key::or("slider.surface.crown_nm", Number(ANY), "15.0", "Rise of the middle over the ends.").usual(-100.0, 100.0),
    Key::or("slider.surface.camber_nm", Number(ANY), "2.0", "Rise of the middle over the sides.").usual(-100.0, 100.0),
    Key::or("slider.surface.twist_nm", Number(ANY), "0.0", "Twist.").usual(-100.0, 100.0),
    Key::or("slider.surface.taper_length_um", Number(FROM_ZERO), "0.0", "Length of the taper at the leading edge; 0 for none.").usual(0.0, 1000.0).code("E145"),
    Key::or("slider.surface.taper_angle_deg", Number(below(0.0, 45.0)), "0.0", "Angle of the taper at the leading edge.").usual(0.0, 5.0).code("E145"),
    Key::optional("slider.surface.rail", Tables, "the rails of preset or file", "[{ kind = \"rect\", x_um = [20, 170], y_um = [30, 670], recess_um = 0.25 }]", "Rails; later ones overwrite earlier ones.").code("E135"),
    Key::required("slider.surface.rail[].kind", Word(&names(&words::RAIL_KINDS)), "\"rect\"", "Shape of the rail's outline."),
    Key::optional("slider.surface.rail[].x_um", Pair(ANY), "a polygon", "[20, 170]", "Range along the length, from the leading edge.").code("E144"),
    Key::optional("slider.surface.rail[].y_um", Pair(ANY), "a polygon", "[30, 670]", "Range across, from the inner edge.").code("E144"),
    Key::optional("slider.surface.rail[].points_um", Points, "a rectangle", "[[20, 30], [170, 30], [170, 670]]", "Corners of a polygon.").code("E144"),
    Key::required("slider.surface.rail[].recess_um", Number(FROM_ZERO), "0.25", "Recess of the rail from the reference plane.").usual(0.0, 10.0).code("E145"),
    // suspension
    Key::or("suspension.gram_load_gf", LENGTH, "2.2", "Load at the slider's centre.").usual(0.1, 20.0),
    Key::or("suspension.hinge.length_mm", LENGTH, "1.3", "Length of the hinge.").usual(0.1, 10.0),
    Key::or("suspension.hinge.width_mm", LENGTH, "1.8", "Width of the hinge.").usual(0.1, 20.0),
    Key::or("suspension.hinge.thickness_um", LENGTH, "40.0", "Thickness of the hinge.").usual(5.0, 200.0),
    Key::or("suspension.load_beam.dimple_mm", LENGTH, "10.5", "Dimple, from the root of the hinge.").usual(2.0, 40.0),
    Key::or("suspension.load_beam.end_mm", LENGTH, "11.8", "End of the tab, from the root of the hinge.").usual(2.0, 50.0),
    Key::or("suspension.load_beam.web_um", LENGTH, "28.0", "Thickness of the web.").usual(5.0, 200.0),
    Key::or("suspension.load_beam.width_root_mm", LENGTH, "3.8", "Width where the load beam meets the hinge.").usual(0.2, 20.0),
    Key::or("suspension.load_beam.width_dimple_mm", LENGTH, "1.2", "Width at the dimple.").usual(0.1, 10.0),
    Key::or("suspension.load_beam.tab_width_mm", LENGTH, "0.6", "Width of the tab.").usual(0.05, 10.0),
    Key::or("suspension.flange.height_um", Number(FROM_ZERO), "140.0", "Height of the flanges on both sides.").usual(0.0, 1000.0),
    Key::or("suspension.flange.from_mm", Number(FROM_ZERO), "1.9", "Start of the flanges, from the root of the hinge.").usual(0.0, 40.0),
    Key::or("suspension.flange.to_mm", LENGTH, "9.6", "End of the flanges, from the root of the hinge.").usual(0.5, 40.0),
    Key::or("suspension.flexure.mass_mg", Number(FROM_ZERO), "0.9", "Mass of the flexure, smeared evenly over the beam.").usual(0.0, 50.0),
    Key::or("suspension.flexure.from_mm", Number(FROM_ZERO), "1.0", "Start of the smeared mass, from the root of the hinge; it ends with the beam.").usual(0.0, 40.0),
    Key::or("suspension.material.youngs_modulus_gpa", LENGTH, "193.0", "Young's modulus.").usual(10.0, 700.0),
    Key::or("suspension.material.shear_modulus_gpa", LENGTH, "74.0", "Shear modulus.").usual(5.0, 300.0),
    Key::or("suspension.material.density_kg_per_m3", LENGTH, "7900.0", "Density.").usual(1000.0, 12000.0),
    Key::or("suspension.damping_ratio", RATIO, "0.02", "Damping ratio of every mode of the suspension.").code("E132"),
    Key::or("suspension.gimbal.vertical_n_per_m", LENGTH, "15.0", "Stiffness of the gimbal, vertical.").usual(0.1, 1e5),
    Key::or("suspension.gimbal.pitch_n_m_per_rad", LENGTH, "6.0e-5", "Stiffness of the gimbal, pitch.").usual(1e-7, 1e-2),
    Key::or("suspension.gimbal.roll_n_m_per_rad", LENGTH, "2.5e-5", "Stiffness of the gimbal, roll.").usual(1e-7, 1e-2),
    Key::or("suspension.dimple.stiffness_n_per_m", LENGTH, "5.0e5", "Stiffness of the closed dimple contact.").usual(1e3, 1e8),
    Key::or("suspension.dimple.damping_ratio", RATIO, "0.05", "Damping ratio of the closed dimple contact, on the slider's mass.").code("E132"),
    Key::optional("suspension.limiters.gap_um", Number(FROM_ZERO), "no limiters", "92.4", "Opening of the dimple at which the limiters hold it, from steady flight; with it there is an inner and an outer one.").usual(1.0, 1000.0).code("E139"),
    Key::optional("suspension.limiters.gap_outer_um", Number(FROM_ZERO), "gap_um", "92.5", "The same of the outer limiter, where it differs.").usual(1.0, 1000.0).code("E139"),
    Key::optional("suspension.limiters.along_mm", Number(ANY), "0", "0.3", "Place of the limiters from the dimple towards the tip.").usual(-3.0, 3.0).code("E139"),
    Key::optional("suspension.limiters.across_mm", Number(FROM_ZERO), "0", "0.4", "Distance of each from the middle: inner limiter inwards, outer one outwards.").usual(0.0, 3.0).code("E139"),
    Key::optional("suspension.limiters.stiffness_n_per_m", LENGTH, "that of the dimple", "1.0e5", "Stiffness of each limiter in contact.").usual(1e2, 1e8).code("E139"),
    Key::optional("suspension.limiters.damping_ratio", RATIO, "that of the dimple", "0.05", "Damping ratio of a limiter in contact, on the slider's mass.").code("E132"),
    Key::optional("suspension.lift_tab.gap_um", Number(FROM_ZERO), "the tab moves freely", "150.0", "Rise of the end of the tab at which it meets a stop of the base, from steady flight.").usual(1.0, 5000.0).code("E139"),
    Key::optional("suspension.lift_tab.stiffness_n_per_m", LENGTH, "that of the dimple", "1.0e5", "Stiffness of the tab in contact with its stop.").usual(1e2, 1e8).code("E139"),
    Key::optional("suspension.lift_tab.damping_ratio", RATIO, "that of the dimple", "0.05", "Damping ratio of the tab in contact, on the slider's mass.").code("E132"),
    Key::optional("suspension.imported.mass", Text, "a suspension by its geometry", "\"susp_M.dat\"", "Mass matrix of another program: Matrix Market (.mtx), CalculiX (.mas) or rows of numbers."),
    Key::optional("suspension.imported.stiffness", Text, "a suspension by its geometry", "\"susp_K.dat\"", "Its stiffness matrix."),
    Key::optional("suspension.imported.freedoms", Text, "places", "\"susp.dof\"", "Freedoms of the rows, a line node.direction each."),
    Key::optional("suspension.imported.places", Text, "freedoms", "\"susp_cords.dat\"", "Places and kinds of the rows, a line x y z type each, mm."),
    Key::optional("suspension.imported.units", Word(&names(&Units::WORDS)), "si", "\"mm_mn\"", "Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t."),
    Key::optional("suspension.imported.dimple", Integer(1, 1_000_000_000), "a suspension by its geometry", "29", "Node of the dimple: z, roll about x and slope about y."),
    Key::optional("suspension.imported.base", Numbers(ABOVE_ZERO), "the base is not in the matrices", "[1]", "Nodes that the base holds; their mass loads the others."),
    Key::optional("suspension.imported.cut_khz", LENGTH, "1000.0", "1000.0", "Modes with the dimple held, below this frequency, are kept of matrices of more than 300 rows.").usual(20.0, 10_000.0).code("E174"),
    Key::optional("suspension.modes", Tables, "a suspension by its geometry", "[{ frequency_hz = 333.0, vertical_per_sqrt_kg = 700.0, slope_per_m_sqrt_kg = 9.0e4, roll_per_m_sqrt_kg = 0.0, participation_sqrt_kg = 1.7e-3 }]", "Modes of the suspension on its base, in place of its geometry.").code("E135"),
    Key::required("suspension.modes[].frequency_hz", LENGTH, "333.0", "Undamped natural frequency."),
    Key::required("suspension.modes[].vertical_per_sqrt_kg", Number(ANY), "700.0", "Displacement z of the dimple, of unit modal mass."),
    Key::required("suspension.modes[].slope_per_m_sqrt_kg", Number(ANY), "9.0e4", "Slope dw/dx at the dimple, x from root to tip."),
    Key::required("suspension.modes[].roll_per_m_sqrt_kg", Number(ANY), "0.0", "Roll of the dimple; 0 in a mode that bends."),
    Key::required("suspension.modes[].participation_sqrt_kg", Number(ANY), "1.7e-3", "Load on the mode by a unit acceleration of the base."),
    // gas
    Key::optional("gas.pressure_pa", LENGTH, "101325 Pa, or from altitude_m", "101325.0", "Ambient pressure.").usual(2e4, 2e5),
    Key::optional("gas.altitude_m", Number(closed(-5000.0, 11000.0)), "sea level", "3000.0", "Altitude: pressure of the standard atmosphere.").usual(-500.0, 6000.0),
    Key::optional("gas.temperature_c", Number(open(-100.0, 500.0)), "18.45 degrees, where the viscosity is 1.806e-5 Pa s", "25.0", "Temperature: viscosity by Sutherland's law, and mean free path.").usual(-40.0, 100.0),
    Key::optional("gas.viscosity_pa_s", LENGTH, "from the temperature", "1.806e-5", "Dynamic viscosity.").usual(1e-6, 1e-4),
    Key::optional("gas.mean_free_path_nm", LENGTH, "63.5 nm scaled with viscosity, pressure and temperature", "63.5", "Mean free path at the ambient pressure.").usual(5.0, 500.0),
    Key::or("gas.model", Word(&names(&words::FLOWS)), "\"fukui_kaneko\"", "Rarefaction model of the film."),
    // surface forces
    Key::optional("surface_forces.hamaker_j", Number(FROM_ZERO), "no van der Waals force", "1.8e-19", "Hamaker's constant A of the attraction A/(6 pi h^3) per area between slider and disk.").usual(1e-21, 1e-18).code("E125"),
    Key::optional("surface_forces.repulsion_j_m6", Number(FROM_ZERO), "no repulsion", "1.0e-76", "Constant B of the repulsion B/(45 pi h^9) per area that ends the attraction.").usual(1e-79, 1e-74).code("E125"),
    Key::optional("surface_forces.potential_v", Number(ANY), "no electrostatic force", "0.5", "Potential difference V of slider and disk: attraction eps0 V^2/(2 h^2) per area.").usual(-10.0, 10.0).code("E125"),
    // search
    Key::or("search.amplitude_g.min", Number(ABOVE_ZERO), "20.0", "Lowest amplitude tried.").usual(0.1, 1e4).code("E156"),
    Key::or("search.amplitude_g.max", Number(ABOVE_ZERO), "2000.0", "Highest amplitude tried.").usual(1.0, 1e5).code("E156"),
    Key::or("search.tolerance_pct", Number(closed(1e-6, 50.0)), "1.0", "Width of the final bracket.").usual(0.01, 20.0).code("E156"),
    Key::or("search.certify", Word(&names(&words::CERTIFY)), "\"staggered\"", "How far the evidence below the lowest failure reaches."),
    Key::or("search.max_gap_pct", Number(above(0.0, 100.0)), "10.0", "Largest untested gap below the lowest failure.").code("E156"),
    Key::or("search.error_bars", Flag, "true", "Adds to each critical shock what the resolution contributes to its error."),
    Key::or("search.climbs", Integer(0, 100), "3", "Times that a point whose error bar exceeds the accuracy is answered anew on finer knobs."),
    Key::optional("search.refine.tolerance_pct", Number(above(0.0, 100.0)), "no widths are added for it", "5.0", "Adds widths until straight lines between the answers of a ramp model are this good.").usual(1.0, 50.0).code("E156"),
    Key::optional("search.refine.crossing_pct", Number(above(0.0, 100.0)), "no widths are added for it", "5.0", "Adds widths until those between which two ramp models change places are this close.").usual(1.0, 50.0).code("E156"),
    Key::optional("search.refine.closest_pct", Number(above(0.0, 100.0)), "2", "2.0", "No widths are added closer than this.").usual(0.5, 50.0).code("E156"),
    Key::optional("search.refine.most_points", Integer(1, 100_000), "60", "60", "Points added at most."),
    // solver
    Key::or("solver.accuracy", Word(&names(&words::RUNGS)), "\"1%\"", "Accuracy of the critical shock: sets every resolution not given here.").code("E157"),
    Key::or("solver.effects", Word(&names(&words::EFFECTS)), "\"auto\"", "auto simulates only what the outputs need."),
    Key::or("solver.leave_out", Words(LEAVE_OUT), "[]", "Effects left out by hand; refused when an output needs them."),
    Key::rung("solver.coupling", Word(&names(&words::COUPLINGS)), "\"monolithic\"", "How film and slider are solved together."),
    Key::or("solver.fail_below_nm", Number(ANY), "0.0", "Clearance below which the interface has failed.").usual(-10.0, 100.0),
    Key::rung("solver.max_steps", Integer(1, 1_000_000_000_000), "2000000", "Deterministic limit of steps; reaching it leaves the run undecided."),
    Key::rung("solver.disk_cut_khz", LENGTH, "30.0", "Modes of the disk above this frequency are left out.").usual(1.0, 1000.0),
    Key::optional("solver.not_refined", Words(DISCRETISATION), "all are refined", "[\"disk_modes\"]", "Discretisation parameters whose values belong to the model, as the modes of another program's mesh: no error bar counts them, no refinement changes them."),
    Key::rung("solver.disk_harmonics", Integer(1, 2000), "40", "Largest number of nodal diameters."),
    Key::rung("solver.disk_elements", Integer(2, 5000), "40", "Radial finite elements of the disk."),
    Key::rung("solver.static_correction", Flag, "true", "Adds the residual flexibility of the ramp point."),
    Key::rung("solver.structure_step_us", LENGTH, "0.5", "Step on which disk and ramp are stored and contact is resolved.").usual(1e-3, 20.0),
    Key::rung("solver.head_tolerance", Number(open(0.0, 1.0)), "1.0e-3", "Relative local error of the clearance per step.").usual(1e-9, 0.1),
    Key::rung("solver.approach_share", Number(open(0.0, 1.0)), "0.25", "Largest share of the clearance closed in one step."),
    Key::rung("solver.film_cells", Integer(16, 4_000_000), "2000", "Wanted number of film cells."),
    Key::rung("solver.film_reference_cells", Integer(0, 1_000_000), "1000", "Cells of the grid that, cut finer, tells what the film's own leaves out (2000 at least for a skewed slider); 0: nothing is added, as where film_cells is set alone."),
    Key::rung("solver.film_floor_nm", LENGTH, "0.3", "Floor of the height the film sees.").usual(0.01, 5.0),
    Key::rung("solver.coupling_tolerance", Number(open(0.0, 0.1)), "1.0e-6", "Relative residual of the coupled solve; a hundredth of head_tolerance when that is set alone.").usual(1e-12, 1e-2),
    Key::rung("solver.suspension_modes", Integer(1, 200), "16", "Modes of the suspension kept above the pinned dimple."),
    // fields
    Key::optional("fields.times_ms", Numbers(FROM_ZERO), "no pressure field", "[0.6, 0.8]", "Times at which pressure_field is kept, on the time axis of every output: pressure and height of the film in every cell.").code("E152"),
    // output
    Key::or("output.keep_histories", Word(&names(&words::KEEP_HISTORIES)), "\"bracket\"", "Which time histories are stored."),
    Key::or("output.checkpoint_s", Number(above(0.0, 86_400.0)), "30", "Time between two refreshes of results.h5.").usual(1.0, 3600.0),
];

/// Groups of keys of which only one alternative may be given.
pub static CHOICES: &[Choice] = &[
    Choice {
        what: "the disk's damping",
        alternatives: &[
            &[
                "disk.damping.rayleigh.alpha_per_s",
                "disk.damping.rayleigh.beta_s",
            ],
            &["disk.damping.modal_ratio"],
        ],
    },
    Choice {
        what: "the deformable ramp",
        alternatives: &[
            &["ramp.deformable.modes"],
            &["ramp.deformable.geometry.material"],
            &["ramp.deformable.mesh.file", "ramp.deformable.mesh.material"],
            &["ramp.deformable.coupled_modes"],
        ],
    },
    Choice {
        what: "the suspension",
        alternatives: &[
            &["suspension.modes"],
            &[
                "suspension.imported.mass",
                "suspension.imported.stiffness",
                "suspension.imported.dimple",
            ],
        ],
    },
    Choice {
        what: "the base",
        alternatives: &[
            &["base.modes"],
            &[
                "base.imported.mass",
                "base.imported.stiffness",
                "base.imported.spindle",
                "base.imported.ramp",
                "base.imported.pivot",
            ],
        ],
    },
    Choice {
        what: "the rows of the base's matrices",
        alternatives: &[&["base.imported.freedoms"], &["base.imported.places"]],
    },
    Choice {
        what: "the rows of the matrices",
        alternatives: &[
            &["suspension.imported.freedoms"],
            &["suspension.imported.places"],
        ],
    },
    Choice {
        what: "the sampled pulse",
        alternatives: &[
            &["pulse.table"],
            &["pulse.table_time_ms", "pulse.table_relative"],
        ],
    },
    Choice {
        what: "the base of the surface",
        alternatives: &[&["slider.surface.preset"], &["slider.surface.file"]],
    },
    Choice {
        what: "the viscosity",
        alternatives: &[&["gas.viscosity_pa_s"], &["gas.temperature_c"]],
    },
    Choice {
        what: "the ambient pressure",
        alternatives: &[&["gas.pressure_pa"], &["gas.altitude_m"]],
    },
];

/// The key at a path; list positions (`modes[0]`) are ignored.
pub fn find(path: &str) -> Option<&'static Key> {
    let pattern = pattern(path);
    KEYS.iter().find(|key| key.path == pattern)
}

/// Whether some key lies below a path.
pub fn is_table(pattern: &str) -> bool {
    KEYS.iter().any(|key| {
        key.path
            .strip_prefix(pattern)
            .is_some_and(|rest| rest.starts_with('.'))
    })
}

/// Names that may stand directly below a table, in table order; "" is the root.
pub fn names_below(pattern: &str) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = Vec::new();
    for key in KEYS.iter() {
        let rest = if pattern.is_empty() {
            Some(key.path)
        } else {
            key.path
                .strip_prefix(pattern)
                .and_then(|rest| rest.strip_prefix('.'))
        };
        let Some(rest) = rest else { continue };
        let name = rest.split(['.', '[']).next().unwrap_or(rest);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Names of the sections.
pub fn sections() -> Vec<&'static str> {
    names_below("")
        .into_iter()
        .filter(|name| is_table(name))
        .collect()
}

/// `ramp.deformable.modes[1].mass_mg` as the table writes it: `ramp.deformable.modes[].mass_mg`.
pub fn pattern(path: &str) -> String {
    let mut pattern = String::with_capacity(path.len());
    let mut inside = false;
    for letter in path.chars() {
        match letter {
            '[' => {
                inside = true;
                pattern.push('[');
            }
            ']' => {
                inside = false;
                pattern.push(']');
            }
            _ if inside => {}
            _ => pattern.push(letter),
        }
    }
    pattern
}
