//! The table of keys: everything a study file may say, in the order it is written out.
//!
//! Reading, messages, defaults, the JSON Schema, `study.resolved.toml`, the digest, the typed constants by which code
//! reads a value, and the field of a scene that a plain value fills all come from this table and from nothing else. The
//! defaults are one 2.5-inch drive that survives common shocks (the values of `studies/drive-2.5in`), so that a short
//! study is a valid one.
//!
//! Dimensions of the disk, position and clearance of the ramp are the sample data of the CMLAir 8.01 user manual
//! (Mardan and Bogy, 2011); suspension and air-bearing surface are opshock's own designs.

use opshock_import::matrix::units::Units;
use opshock_solver::air_bearing::FlowModel;
use opshock_solver::disk::HubParameters;
use opshock_solver::head::DamageLimits;
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::scene::plan::Output;
use opshock_solver::scene::preset::Preset;
use opshock_solver::scene::{Coupling, Scene};

use super::field::{Corners, Field, Many, Named, Numbers, Pair, Tables, Text, fields};
use super::key::{ABOVE_ZERO, ANY, FROM_ZERO, Key, Kind, above, below, closed, open};
use super::settings::View;
use super::words::{
    self, AccelerationUnit, Criterion, Effects, Faces, FilterClass, KeepHistories, LeftOut,
    LengthUnit, RailKind, RunOut, Shape, TableOffset, TableScale, TimeUnit, UncertaintyOf,
};
use crate::search::{MonotonicityScan, Ramp, Sign};
use Kind::{Axis, Flag, Integer, Number, NumberOrWord};

const RATIO: Kind = Number(FROM_ZERO);
const LENGTH: Kind = Number(ABOVE_ZERO);

fn hub(scene: &mut Scene) -> &mut HubParameters {
    scene.disk.hub.get_or_insert_default()
}

fn damage(scene: &mut Scene) -> &mut DamageLimits {
    scene.damage.get_or_insert_default()
}

fields! {
    STUDY_FORMAT: i64 = Key::required("study_format", Integer(2, 2), "2", "Version of the study file's format.");
    NAME: Text = Key::required("name", Kind::Text, "\"Fig. 13: three ramp models\"", "Name of the study, printed on every product.");
    OUTPUTS: Many<Output> = Key::or("outputs", Output::KIND_OF_MANY, "[\"critical_shock\"]", "What is wanted; only the effects these need are simulated.").code("E158");
    // heads
    HEAD: Text = Key::optional("head", Kind::Text, "every head", "\"0 up\"", "Of several heads the one that is simulated.").code("E191");
    HEADS: Tables = Key::optional("heads", Kind::Tables, "one head", "[{ head = \"0 up\", slider.radius_mm = 21.0 }, { head = \"0 down\", slider.radius_mm = 21.0, suspension.gram_load_gf = 2.3 }]", "Heads of a drive, each with its slider, suspension, disk and gap of the ramp: an axis of the study. What an entry leaves out is the study's.").code("E191");
    HEADS_HEAD: Text = Key::required("heads[].head", Kind::Text, "\"0 up\"", "Name of the head, as tables show it.").code("E191");
    // pulse
    PULSE_SHAPE: Shape = Key::or("pulse.shape", Shape::KIND, "\"half_sine\"", "Shape of the acceleration pulse.");
    PULSE_WIDTHS_MS: Numbers = Key::required("pulse.widths_ms", Axis(ABOVE_ZERO), "[0.5, 1.0, 2.0]", "Pulse widths: an axis of the study. Left out with table_scale measured.").usual(0.05, 100.0).code("E150");
    PULSE_SIGNS: Many<Sign> = Key::or("pulse.signs", Sign::KIND_OF_MANY, "[\"+\", \"-\"]", "Signs of the shock: + moves the disk towards the slider first.");
    PULSE_START_MS: f64 = Key::or("pulse.start_ms", Number(FROM_ZERO), "0.5", "Onset of the pulse on the time axis of every output.").usual(0.0, 1000.0).code("E150").fixed();
    PULSE_WINDOW_MS: Option<f64> = Key::or("pulse.window_ms", NumberOrWord(ABOVE_ZERO, &["until_decayed"]), "5.0", "Simulated time after the onset.").usual(0.1, 500.0).code("E152");
    PULSE_DECAY_SHARE: f64 = Key::or("pulse.decay_share", Number(open(0.0, 1.0)), "0.01", "Share of the peak energy of disk and ramp that ends the window until_decayed.").code("E152");
    PULSE_WINDOW_MAX_MS: f64 = Key::or("pulse.window_max_ms", Number(ABOVE_ZERO), "50.0", "Longest window until_decayed.").usual(0.1, 5000.0).code("E152");
    PULSE_RISE_SHARE: f64 = Key::or("pulse.rise_share", Number(above(0.0, 0.5)), "0.1", "Share of the width in which a trapezoid rises, and again falls.").code("E150");
    PULSE_FREQUENCY_HZ: f64 = Key::or("pulse.frequency_hz", Number(ABOVE_ZERO), "1000.0", "Frequency of a damped sine.").usual(10.0, 1e5).code("E150");
    PULSE_DECAY_PER_S: f64 = Key::or("pulse.decay_per_s", Number(FROM_ZERO), "500.0", "Decay rate of a damped sine.").usual(0.0, 1e6).code("E150");
    PULSE_TABLE: Text = Key::optional("pulse.table", Kind::Text, "no table", "\"pulse.csv\"", "File of a measured pulse, columns of time and acceleration. Needs table_time_unit and table_scale.");
    PULSE_TABLE_SCALE: Option<TableScale> = Key::optional("pulse.table_scale", TableScale::KIND, "stretched, for samples given in the study", "\"measured\"", "measured: real time and G, the pulse's width is the record's own; stretched: to every width of pulse.widths_ms. The shock's amplitude is the largest magnitude of the pulse in both.").fixed();
    PULSE_TABLE_TIME_UNIT: Option<TimeUnit> = Key::optional("pulse.table_time_unit", TimeUnit::KIND, "no file", "\"s\"", "Unit of the file's times.").fixed();
    PULSE_TABLE_ACCELERATION_UNIT: Option<AccelerationUnit> = Key::optional("pulse.table_acceleration_unit", AccelerationUnit::KIND, "relative numbers, for stretched pulses only", "\"g\"", "Unit of the file's accelerations.").fixed();
    PULSE_TABLE_COLUMNS: Numbers = Key::optional("pulse.table_columns", Kind::Numbers(ABOVE_ZERO), "[1, 2], and no others in the file", "[1, 3]", "Columns of time and acceleration in the file, counted from 1.").code("E153");
    PULSE_TABLE_SKIP_ROWS: Option<usize> = Key::optional("pulse.table_skip_rows", Integer(0, 10_000), "0", "12", "Rows at the beginning of the file that are not read. Rows without a number before the first sample are its header.").code("E153").fixed();
    PULSE_TABLE_WINDOW_MS: Pair = Key::optional("pulse.table_window_ms", Kind::Pair(ANY), "the whole record", "[-0.5, 3.0]", "The part of the record that is the pulse, in the file's time.").code("E153").usual(0.01, 1000.0);
    PULSE_TABLE_OFFSET: Option<TableOffset> = Key::optional("pulse.table_offset", TableOffset::KIND, "nothing is subtracted", "\"mean_before\"", "Zero line that is subtracted: mean of the samples before table_window_ms, or the straight line through those before and after it.").fixed();
    PULSE_TABLE_FILTER: Option<FilterClass> = Key::optional("pulse.table_filter", FilterClass::KIND, "no filter", "\"cfc_1000\"", "Channel frequency class of SAE J211: phaseless low-pass filter of the record.").fixed();
    PULSE_TABLE_CUTOFF_HZ: Option<f64> = Key::optional("pulse.table_cutoff_hz", Number(ABOVE_ZERO), "no filter", "2000.0", "Butterworth filter instead: frequency at which its two passes give -3 dB.").usual(10.0, 1e5).code("E153").fixed();
    PULSE_TABLE_FILTER_ORDER: Option<u32> = Key::optional("pulse.table_filter_order", Integer(1, 8), "no filter", "4", "Its order in each of the two passes.").code("E153").fixed();
    PULSE_TABLE_TIME_MS: Numbers = Key::optional("pulse.table_time_ms", Kind::Numbers(FROM_ZERO), "no table", "[0.0, 0.5, 1.0]", "Times of a sampled pulse given here instead of in a file.").code("E153").usual(0.001, 100.0);
    PULSE_TABLE_RELATIVE: Numbers = Key::optional("pulse.table_relative", Kind::Numbers(ANY), "no table", "[0.0, 1.0, 0.0]", "Relative accelerations of a sampled pulse; in G when table_scale is measured.").code("E153");
    PULSE_IN_PLANE_X: Option<f64> = Key::optional("pulse.in_plane_x", Number(ANY), "a straight shock", "0.5", "Share of the shock in the plane of the disk, along angle 0: load along x per axial load. Needs a hub.").usual(-10.0, 10.0).code("E138");
    PULSE_IN_PLANE_Y: Option<f64> = Key::optional("pulse.in_plane_y", Number(ANY), "a straight shock", "0.5", "The same a quarter turn on in the disk's sense of rotation.").usual(-10.0, 10.0).code("E138");
    PULSE_ROTATION_X_PER_M: Option<f64> = Key::optional("pulse.rotation_x_per_m", Number(ANY), "a straight shock", "10.0", "Angular acceleration felt about x per axial acceleration at the spindle. Needs a hub.").usual(-100.0, 100.0).code("E138");
    PULSE_ROTATION_Y_PER_M: Option<f64> = Key::optional("pulse.rotation_y_per_m", Number(ANY), "a straight shock", "10.0", "The same about y.").usual(-100.0, 100.0).code("E138");
    // disk
    DISK_INNER_RADIUS_MM: f64 = Key::or("disk.inner_radius_mm", LENGTH, "10.01", "Radius of the clamp.").usual(2.0, 30.0).code("E140") => |scene| scene.disk.inner_radius_m;
    DISK_OUTER_RADIUS_MM: f64 = Key::or("disk.outer_radius_mm", LENGTH, "32.5", "Radius of the rim.").usual(8.0, 70.0).code("E140") => |scene| scene.disk.outer_radius_m;
    DISK_THICKNESS_MM: f64 = Key::or("disk.thickness_mm", LENGTH, "0.635", "Thickness.").usual(0.1, 3.0) => |scene| scene.disk.thickness_m;
    DISK_YOUNGS_MODULUS_GPA: f64 = Key::or("disk.youngs_modulus_gpa", LENGTH, "75.0", "Young's modulus.").usual(10.0, 700.0) => |scene| scene.disk.youngs_modulus_pa;
    DISK_POISSON: f64 = Key::or("disk.poisson", Number(open(-1.0, 0.5)), "0.3", "Poisson's ratio.").usual(0.0, 0.45).code("E131") => |scene| scene.disk.poisson;
    DISK_DENSITY_KG_PER_M3: f64 = Key::or("disk.density_kg_per_m3", LENGTH, "2710.0", "Density.").usual(1000.0, 12000.0) => |scene| scene.disk.density_kg_per_m3;
    DISK_RPM: f64 = Key::or("disk.rpm", Number(FROM_ZERO), "5400.0", "Speed of rotation; 0 only for studies without the air bearing.").usual(500.0, 25000.0).code("E133") => |scene| scene.disk.spin_rad_per_s;
    DISK_DAMPING_RAYLEIGH_ALPHA_PER_S: f64 = Key::together("disk.damping.rayleigh.alpha_per_s", Number(FROM_ZERO), "25.0", "Material damping, share of the mass matrix, in the rotating frame.").usual(0.0, 1000.0).code("E132");
    DISK_DAMPING_RAYLEIGH_BETA_S: f64 = Key::together("disk.damping.rayleigh.beta_s", Number(FROM_ZERO), "1.0e-7", "Material damping, share of the stiffness matrix, in the rotating frame.").usual(0.0, 1e-4).code("E132");
    DISK_DAMPING_MODAL_RATIO: Option<f64> = Key::optional("disk.damping.modal_ratio", RATIO, "Rayleigh damping", "0.004", "The same damping ratio for every mode of the disk, in the rotating frame.").code("E132");
    DISK_SPACE_FIXED_DAMPING_PER_S: f64 = Key::or("disk.space_fixed_damping_per_s", Number(FROM_ZERO), "0.0", "Damping fixed in space (air): force per mass and velocity.").usual(0.0, 1000.0).code("E132") => |scene| scene.disk.space_fixed_damping_per_s;
    DISK_RUN_OUT_UM: Option<f64> = Key::optional("disk.run_out_um", Number(FROM_ZERO), "a plane disk", "5.0", "Axial run-out under the slider once a revolution: amplitude at the rim, growing with the radius.").usual(0.0, 100.0).code("E126");
    DISK_RUN_OUT_DEG: Option<f64> = Key::optional("disk.run_out_deg", Number(closed(-360.0, 360.0)), "0", "90.0", "Angle of its highest point at the onset of the shock, in the disk's sense of rotation.").code("E126");
    DISK_WAVES: Tables = Key::optional("disk.waves", Kind::Tables, "a plane disk", "[{ harmonic = 12, amplitude_nm = 20.0 }]", "Waves of the disk's surface that turn with it under the slider.").code("E126");
    DISK_WAVES_HARMONIC: u32 = Key::required("disk.waves[].harmonic", Integer(1, 10000), "12", "Waves a revolution.").code("E126");
    DISK_WAVES_AMPLITUDE_NM: f64 = Key::required("disk.waves[].amplitude_nm", Number(FROM_ZERO), "20.0", "Amplitude, the same at every radius.").usual(0.0, 1e4).code("E126");
    DISK_WAVES_PHASE_DEG: Option<f64> = Key::optional("disk.waves[].phase_deg", Number(closed(-360.0, 360.0)), "0", "90.0", "Phase at angle 0 at the onset of the shock.").code("E126");
    // hub
    HUB_AXIAL_STIFFNESS_N_PER_M: Option<f64> = Key::optional("hub.axial_stiffness_n_per_m", LENGTH, "the disk is clamped to the base", "8.0e6", "Axial stiffness of the hub's bearing; with both stiffnesses the disk stands on a hub.").usual(1e4, 1e12).code("E137") => |scene| hub(scene).axial_stiffness_n_per_m;
    HUB_TILT_STIFFNESS_N_M_PER_RAD: Option<f64> = Key::optional("hub.tilt_stiffness_n_m_per_rad", LENGTH, "the disk is clamped to the base", "300.0", "Stiffness of the bearing against tilt of the hub.").usual(0.1, 1e7).code("E137") => |scene| hub(scene).tilt_stiffness_n_m_per_rad;
    HUB_MASS_MG: Option<f64> = Key::optional("hub.mass_mg", Number(FROM_ZERO), "0", "15000.0", "Mass that moves with the hub, without the free part of the disk.").usual(100.0, 1e6).code("E137") => |scene| hub(scene).mass_kg;
    HUB_TRANSVERSE_INERTIA_MG_MM2: Option<f64> = Key::optional("hub.transverse_inertia_mg_mm2", Number(FROM_ZERO), "0", "4.0e5", "Its moment of inertia about a diameter, at the bearing's centre.").usual(1e2, 1e9).code("E137") => |scene| hub(scene).transverse_inertia_kg_m2;
    HUB_POLAR_INERTIA_MG_MM2: Option<f64> = Key::optional("hub.polar_inertia_mg_mm2", Number(FROM_ZERO), "0", "6.0e5", "Its moment of inertia about the axis of spin.").usual(1e2, 1e9).code("E137") => |scene| hub(scene).polar_inertia_kg_m2;
    HUB_AXIAL_DAMPING_N_S_PER_M: Option<f64> = Key::optional("hub.axial_damping_n_s_per_m", Number(FROM_ZERO), "0", "50.0", "Axial damping of the bearing.").usual(0.0, 1e5).code("E137") => |scene| hub(scene).axial_damping_n_s_per_m;
    HUB_TILT_DAMPING_N_M_S_PER_RAD: Option<f64> = Key::optional("hub.tilt_damping_n_m_s_per_rad", Number(FROM_ZERO), "0", "2.0e-3", "Damping of the hub's tilt.").usual(0.0, 100.0).code("E137") => |scene| hub(scene).tilt_damping_n_m_s_per_rad;
    HUB_CROSS_STIFFNESS_N_M_PER_RAD: Option<f64> = Key::optional("hub.cross_stiffness_n_m_per_rad", Number(ANY), "0", "1.0", "Moment across a tilt; positive drives the whirl that goes with the spin.").usual(-1e5, 1e5).code("E137") => |scene| hub(scene).cross_stiffness_n_m_per_rad;
    HUB_CROSS_DAMPING_N_M_S_PER_RAD: Option<f64> = Key::optional("hub.cross_damping_n_m_s_per_rad", Number(ANY), "0", "1.0e-4", "Moment across the velocity of a tilt, in the sense of the gyroscopic one.").usual(-100.0, 100.0).code("E137") => |scene| hub(scene).cross_damping_n_m_s_per_rad;
    HUB_CENTRE_HEIGHT_MM: Option<f64> = Key::optional("hub.centre_height_mm", Number(ANY), "0", "1.5", "Centre of mass of rotor and disk above the centre of tilt: arm of a shock in the disk's plane.").usual(-20.0, 20.0).code("E137") => |scene| hub(scene).centre_height_m;
    // base
    BASE_MODES: Tables = Key::optional("base.modes", Kind::Tables, "a rigid base", "[{ frequency_hz = 900.0, damping_ratio = 0.02, participation_sqrt_kg = 0.25, spindle_per_sqrt_kg = 2.0, ramp_per_sqrt_kg = 2.4, pivot_per_sqrt_kg = 1.6 }]", "Modes of base plate and housing under the shock, of unit modal mass. Needs a straight shock.").code("E189");
    BASE_MODES_FREQUENCY_HZ: f64 = Key::required("base.modes[].frequency_hz", LENGTH, "900.0", "Undamped natural frequency.").usual(10.0, 1e5).code("E189");
    BASE_MODES_DAMPING_RATIO: f64 = Key::or("base.modes[].damping_ratio", Number(below(0.0, 1.0)), "0.02", "Damping ratio.").usual(0.0, 0.5).code("E132");
    BASE_MODES_PARTICIPATION_SQRT_KG: f64 = Key::required("base.modes[].participation_sqrt_kg", Number(ANY), "0.25", "Load on the mode by a unit acceleration of the base.").usual(-3.0, 3.0);
    BASE_MODES_SPINDLE_PER_SQRT_KG: f64 = Key::required("base.modes[].spindle_per_sqrt_kg", Number(ANY), "2.0", "Displacement of the spindle along the disk's axis.").usual(-100.0, 100.0);
    BASE_MODES_RAMP_PER_SQRT_KG: f64 = Key::required("base.modes[].ramp_per_sqrt_kg", Number(ANY), "2.4", "Displacement of the ramp's mount.").usual(-100.0, 100.0);
    BASE_MODES_PIVOT_PER_SQRT_KG: f64 = Key::required("base.modes[].pivot_per_sqrt_kg", Number(ANY), "1.6", "Displacement of the actuator's pivot, which carries the suspension.").usual(-100.0, 100.0);
    BASE_IMPORTED_MASS: Text = Key::optional("base.imported.mass", Kind::Text, "modes, or a rigid base", "\"base.mas\"", "Mass matrix of the base by another program: Matrix Market (.mtx), CalculiX (.mas), or rows of numbers.");
    BASE_IMPORTED_STIFFNESS: Text = Key::optional("base.imported.stiffness", Kind::Text, "modes, or a rigid base", "\"base.sti\"", "Its stiffness matrix.");
    BASE_IMPORTED_FREEDOMS: Text = Key::optional("base.imported.freedoms", Kind::Text, "places", "\"base.dof\"", "Freedoms of the rows, a line node.direction each.");
    BASE_IMPORTED_PLACES: Text = Key::optional("base.imported.places", Kind::Text, "freedoms", "\"base_cords.dat\"", "Places and kinds of the rows, a line x y z type each, mm.");
    BASE_IMPORTED_UNITS: Option<Units> = Key::optional("base.imported.units", Units::KIND, "si", "\"mm_n\"", "Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t.");
    BASE_IMPORTED_SPINDLE: Option<i64> = Key::optional("base.imported.spindle", Integer(1, 1_000_000_000), "modes, or a rigid base", "12", "Node of the spindle; its displacement z is along the disk's axis.");
    BASE_IMPORTED_RAMP: Option<i64> = Key::optional("base.imported.ramp", Integer(1, 1_000_000_000), "modes, or a rigid base", "34", "Node of the ramp's mount.");
    BASE_IMPORTED_PIVOT: Option<i64> = Key::optional("base.imported.pivot", Integer(1, 1_000_000_000), "modes, or a rigid base", "56", "Node of the actuator's pivot.");
    BASE_IMPORTED_HELD: Numbers = Key::optional("base.imported.held", Kind::Numbers(ABOVE_ZERO), "the mounts are springs in the matrices", "[1, 2]", "Nodes that move with the shock; their mass loads the others.");
    BASE_IMPORTED_CUT_KHZ: Option<f64> = Key::optional("base.imported.cut_khz", LENGTH, "10.0", "10.0", "Natural modes below this frequency are kept, at most 16.").usual(0.1, 100.0).code("E189");
    BASE_IMPORTED_DAMPING_RATIO: Option<f64> = Key::optional("base.imported.damping_ratio", Number(below(0.0, 1.0)), "0.02", "0.02", "Damping ratio of every mode.").usual(0.0, 0.5).code("E132");
    // ramp
    RAMP_MODELS: Many<Ramp> = Key::required("ramp.models", Ramp::KIND_OF_MANY, "[\"none\", \"rigid\", \"deformable\"]", "Ramp models: an axis of the study.");
    RAMP_CLEARANCE_UM: f64 = Key::or("ramp.clearance_um", Number(FROM_ZERO), "100.0", "Static clearance between disk and ramp, above and below.").usual(10.0, 1000.0).code("E143");
    RAMP_CLEARANCE_TOP_UM: Option<f64> = Key::optional("ramp.clearance_top_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance above the disk, when unequal.").usual(10.0, 1000.0).code("E143");
    RAMP_CLEARANCE_BOTTOM_UM: Option<f64> = Key::optional("ramp.clearance_bottom_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance below the disk, when unequal.").usual(10.0, 1000.0).code("E143");
    RAMP_RUN_OUT: Option<RunOut> = Key::optional("ramp.run_out", RunOut::KIND, "none", "\"lowest_gap\"", "lowest_gap takes the run-out of the disk at the ramp off the gaps above and below it: the lowest gap of a revolution.").code("E143");
    RAMP_RADIUS_MM: f64 = Key::or("ramp.radius_mm", LENGTH, "32.15", "Radius of the contact points.").usual(5.0, 70.0).code("E141") => |scene| scene.ramp.radius_m;
    RAMP_ANGLE_DEG: f64 = Key::or("ramp.angle_deg", Number(closed(-360.0, 360.0)), "0.0", "Angle of the contact points in the disk's sense of rotation.") => |scene| scene.ramp.angle_rad;
    RAMP_RESTITUTION: f64 = Key::or("ramp.restitution", Number(closed(0.0, 1.0)), "0.0", "Coefficient of restitution of an impact; 0 with a contact stiffness.").code("E136") => |scene| scene.ramp.restitution;
    RAMP_CONTACT_STIFFNESS_N_PER_M: Option<f64> = Key::optional("ramp.contact_stiffness_n_per_m", LENGTH, "a hard contact", "1.0e6", "Local stiffness between each arm and its contact point.").usual(1e4, 1e9).code("E136");
    RAMP_CONTACT_FREQUENCY_KHZ: Option<f64> = Key::optional("ramp.contact_frequency_khz", LENGTH, "400.0", "400.0", "Natural frequency of the contact's stiffness on the mass it is given: above what an impact carries to the slider.").usual(100.0, 1000.0).code("E136") => |scene| scene.ramp.contact_frequency_hz;
    RAMP_CONTACT_DAMPING_RATIO: Option<f64> = Key::optional("ramp.contact_damping_ratio", Number(closed(0.0, 1.0)), "0.5", "0.5", "Damping ratio at that frequency, where ringing is no physics; 0.5 at 400 kHz is a loss factor of 6 % at 25 kHz.").usual(0.0, 1.0).code("E132") => |scene| scene.ramp.contact_damping_ratio;
    RAMP_DEFORMABLE_MODES: Tables = Key::together("ramp.deformable.modes", Kind::Tables, "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }, { frequency_hz = 17500.0, mass_mg = 35.1, participation = 0.789 }]", "Modes of each arm, scaled to 1 at the contact point; both arms alike.").code("E135");
    RAMP_DEFORMABLE_MODES_FREQUENCY_HZ: f64 = Key::required("ramp.deformable.modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6);
    RAMP_DEFORMABLE_MODES_MASS_MG: f64 = Key::required("ramp.deformable.modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5);
    RAMP_DEFORMABLE_MODES_PARTICIPATION: f64 = Key::required("ramp.deformable.modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0);
    RAMP_DEFORMABLE_MODES_DAMPING_RATIO: Option<f64> = Key::optional("ramp.deformable.modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132");
    RAMP_DEFORMABLE_BOTTOM_MODES: Tables = Key::optional("ramp.deformable.bottom_modes", Kind::Tables, "as modes", "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }]", "Modes of the bottom arm, when the arms differ.").code("E135");
    RAMP_DEFORMABLE_BOTTOM_MODES_FREQUENCY_HZ: f64 = Key::required("ramp.deformable.bottom_modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6);
    RAMP_DEFORMABLE_BOTTOM_MODES_MASS_MG: f64 = Key::required("ramp.deformable.bottom_modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5);
    RAMP_DEFORMABLE_BOTTOM_MODES_PARTICIPATION: f64 = Key::required("ramp.deformable.bottom_modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0);
    RAMP_DEFORMABLE_BOTTOM_MODES_DAMPING_RATIO: Option<f64> = Key::optional("ramp.deformable.bottom_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132");
    RAMP_DEFORMABLE_GEOMETRY_MATERIAL: Text = Key::optional("ramp.deformable.geometry.material", Kind::Word(words::RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material; with it the ramp is given by its geometry instead of modes.");
    RAMP_DEFORMABLE_GEOMETRY_YOUNGS_MODULUS_GPA: Option<f64> = Key::optional("ramp.deformable.geometry.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0);
    RAMP_DEFORMABLE_GEOMETRY_POISSON: Option<f64> = Key::optional("ramp.deformable.geometry.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131");
    RAMP_DEFORMABLE_GEOMETRY_DENSITY_KG_PER_M3: Option<f64> = Key::optional("ramp.deformable.geometry.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0);
    RAMP_DEFORMABLE_GEOMETRY_FINGER_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.finger_length_mm", LENGTH, "3.2", "3.2", "Fingers, from their tips to the body.").usual(0.5, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_FINGER_WIDTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.finger_width_mm", LENGTH, "1.6", "1.6", "Width of the fingers.").usual(0.2, 10.0);
    RAMP_DEFORMABLE_GEOMETRY_TIP_THICKNESS_MM: Option<f64> = Key::optional("ramp.deformable.geometry.tip_thickness_mm", LENGTH, "0.3", "0.3", "Thickness of a finger at its tip.").usual(0.05, 3.0);
    RAMP_DEFORMABLE_GEOMETRY_ROOT_THICKNESS_MM: Option<f64> = Key::optional("ramp.deformable.geometry.root_thickness_mm", LENGTH, "0.9", "0.9", "Thickness of a finger behind its slope.").usual(0.1, 5.0);
    RAMP_DEFORMABLE_GEOMETRY_SLOPE_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.slope_length_mm", LENGTH, "1.8", "1.8", "Length of the slope, over which a finger grows from tip to root thickness.").usual(0.1, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_BODY_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.body_length_mm", LENGTH, "3.0", "3.0", "Body, along the fingers.").usual(0.5, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_BODY_WIDTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.body_width_mm", LENGTH, "4.0", "4.0", "Width of body and mount.").usual(0.5, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_BODY_DEPTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.body_depth_mm", LENGTH, "2.6", "2.6", "From the middle of the disk down to the lower face of body and mount.").usual(0.5, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_NECK_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.neck_length_mm", Number(FROM_ZERO), "0.8", "0.8", "Free part of the mount behind the body; 0 for none.").usual(0.0, 10.0);
    RAMP_DEFORMABLE_GEOMETRY_PAD_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.pad_length_mm", Number(FROM_ZERO), "2.8", "2.8", "Bolted part of the mount; 0 for a body bolted itself.").usual(0.0, 20.0);
    RAMP_DEFORMABLE_GEOMETRY_MOUNT_THICKNESS_MM: Option<f64> = Key::optional("ramp.deformable.geometry.mount_thickness_mm", LENGTH, "0.8", "0.8", "Thickness of the mount.").usual(0.1, 10.0);
    RAMP_DEFORMABLE_GEOMETRY_CONTACT_MM: Option<f64> = Key::optional("ramp.deformable.geometry.contact_mm", LENGTH, "0.35", "0.35", "From the tips to the middle of the contact with the disk.").usual(0.05, 10.0);
    RAMP_DEFORMABLE_GEOMETRY_CONTACT_LENGTH_MM: Option<f64> = Key::optional("ramp.deformable.geometry.contact_length_mm", LENGTH, "0.3", "0.3", "Length of the contact along the finger, over which its force is spread.").usual(0.02, 5.0);
    RAMP_DEFORMABLE_GEOMETRY_MOUNT_NORMAL_N_PER_M: Option<f64> = Key::optional("ramp.deformable.geometry.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10);
    RAMP_DEFORMABLE_GEOMETRY_MOUNT_TANGENTIAL_N_PER_M: Option<f64> = Key::optional("ramp.deformable.geometry.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10);
    RAMP_DEFORMABLE_GEOMETRY_MESH_SIZE_MM: Option<f64> = Key::optional("ramp.deformable.geometry.mesh_size_mm", LENGTH, "1.0", "0.7", "Longest edge of a finite element; elements at re-entrant corners are a quarter of it.").usual(0.2, 5.0).code("E174");
    RAMP_DEFORMABLE_GEOMETRY_CUT_KHZ: Option<f64> = Key::optional("ramp.deformable.geometry.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contact points held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174");
    RAMP_DEFORMABLE_MESH_FILE: Text = Key::optional("ramp.deformable.mesh.file", Kind::Text, "a ramp given by modes", "\"ramp.msh\"", "Gmsh mesh (.msh 4.1) of the ramp with physical surfaces mount, top and bottom; z is the disk's axis.");
    RAMP_DEFORMABLE_MESH_MATERIAL: Text = Key::optional("ramp.deformable.mesh.material", Kind::Word(words::RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material of the mesh.");
    RAMP_DEFORMABLE_MESH_UNIT: Option<LengthUnit> = Key::optional("ramp.deformable.mesh.unit", LengthUnit::KIND, "mm", "\"mm\"", "Unit of length of the file.");
    RAMP_DEFORMABLE_MESH_YOUNGS_MODULUS_GPA: Option<f64> = Key::optional("ramp.deformable.mesh.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0);
    RAMP_DEFORMABLE_MESH_POISSON: Option<f64> = Key::optional("ramp.deformable.mesh.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131");
    RAMP_DEFORMABLE_MESH_DENSITY_KG_PER_M3: Option<f64> = Key::optional("ramp.deformable.mesh.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0);
    RAMP_DEFORMABLE_MESH_MOUNT_NORMAL_N_PER_M: Option<f64> = Key::optional("ramp.deformable.mesh.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10);
    RAMP_DEFORMABLE_MESH_MOUNT_TANGENTIAL_N_PER_M: Option<f64> = Key::optional("ramp.deformable.mesh.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10);
    RAMP_DEFORMABLE_MESH_CUT_KHZ: Option<f64> = Key::optional("ramp.deformable.mesh.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contacts held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174");
    RAMP_DEFORMABLE_COUPLED_MODES: Tables = Key::optional("ramp.deformable.coupled_modes", Kind::Tables, "a ramp given by modes of each arm", "[{ frequency_hz = 3180.2, top_per_sqrt_kg = 211.0, bottom_per_sqrt_kg = 220.0, participation_sqrt_kg = 0.005 }]", "Modes of both arms as one body.").code("E135");
    RAMP_DEFORMABLE_COUPLED_MODES_FREQUENCY_HZ: f64 = Key::required("ramp.deformable.coupled_modes[].frequency_hz", LENGTH, "3180.2", "Undamped natural frequency.").usual(10.0, 1e6);
    RAMP_DEFORMABLE_COUPLED_MODES_TOP_PER_SQRT_KG: f64 = Key::required("ramp.deformable.coupled_modes[].top_per_sqrt_kg", Number(ANY), "211.0", "Shape at the top contact, of unit modal mass.").usual(-1e4, 1e4);
    RAMP_DEFORMABLE_COUPLED_MODES_BOTTOM_PER_SQRT_KG: f64 = Key::required("ramp.deformable.coupled_modes[].bottom_per_sqrt_kg", Number(ANY), "220.0", "Shape at the bottom contact, of unit modal mass.").usual(-1e4, 1e4);
    RAMP_DEFORMABLE_COUPLED_MODES_PARTICIPATION_SQRT_KG: f64 = Key::required("ramp.deformable.coupled_modes[].participation_sqrt_kg", Number(ANY), "0.005", "Load on the mode by a unit acceleration of the base.").usual(-0.1, 0.1);
    RAMP_DEFORMABLE_COUPLED_MODES_DAMPING_RATIO: Option<f64> = Key::optional("ramp.deformable.coupled_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132");
    RAMP_DEFORMABLE_PRONY: Tables = Key::optional("ramp.deformable.prony", Kind::Tables, "elastic modes", "[{ share = 0.02, time_ms = 0.1 }, { share = 0.03, time_ms = 0.01 }, { share = 0.05, time_ms = 0.001 }]", "Prony series by which the stiffness of every mode relaxes; frequencies are those of the instantaneous modulus. Damping ratios add to it.").code("E132");
    RAMP_DEFORMABLE_PRONY_SHARE: f64 = Key::required("ramp.deformable.prony[].share", Number(open(0.0, 1.0)), "0.02", "Share of the instantaneous modulus that relaxes; the sum stays below 1.").code("E132");
    RAMP_DEFORMABLE_PRONY_TIME_MS: f64 = Key::required("ramp.deformable.prony[].time_ms", LENGTH, "0.1", "Relaxation time.").usual(1e-4, 1e3).code("E132");
    RAMP_DEFORMABLE_DAMPING_RATIO: f64 = Key::or("ramp.deformable.damping_ratio", RATIO, "0.02", "Damping ratio of the arms' modes.").code("E132");
    // slider
    SLIDER_RADIUS_MM: f64 = Key::or("slider.radius_mm", LENGTH, "21.0", "Radius of the slider's centre.").usual(5.0, 70.0) => |scene| scene.slider.radius_m;
    SLIDER_ANGLE_DEG: f64 = Key::or("slider.angle_deg", Number(closed(-360.0, 360.0)), "7.0", "Angle of the slider's centre in the disk's sense of rotation, measured as the ramp's.") => |scene| scene.slider.angle_rad;
    SLIDER_SKEW_DEG: f64 = Key::or("slider.skew_deg", Number(open(-90.0, 90.0)), "0.0", "Angle between the disk's velocity and the slider's length, positive towards the outer side.").usual(-30.0, 30.0) => |scene| scene.slider.skew_rad;
    SLIDER_FACES: Option<Faces> = Key::optional("slider.faces", Faces::KIND, "down", "\"up\"", "Way the slider faces: down, over the disk, or up, under it, where the shock has the other sign and the ramp's bottom arm is on the slider's side.");
    SLIDER_LENGTH_MM: f64 = Key::or("slider.length_mm", LENGTH, "0.85", "Length, leading to trailing edge.").usual(0.2, 5.0) => |scene| scene.slider.length_m;
    SLIDER_WIDTH_MM: f64 = Key::or("slider.width_mm", LENGTH, "0.7", "Width, inner to outer side.").usual(0.2, 4.0) => |scene| scene.slider.width_m;
    SLIDER_HEIGHT_MM: f64 = Key::or("slider.height_mm", LENGTH, "0.23", "Height.").usual(0.05, 1.5) => |scene| scene.slider.height_m;
    SLIDER_DENSITY_KG_PER_M3: f64 = Key::or("slider.density_kg_per_m3", LENGTH, "4300.0", "Density.").usual(1000.0, 10000.0) => |scene| scene.slider.density_kg_per_m3;
    SLIDER_VISCOUS_SHEAR: Option<bool> = Key::optional("slider.viscous_shear", Flag, "no shear", "true", "Shear of the film on the slider, which the suspension balances at the dimple: moments of pitch and roll.") => |scene| scene.gap_forces.viscous_shear.is_on;
    SLIDER_SURFACE_PRESET: Text = Key::optional("slider.surface.preset", Kind::Word(words::SURFACES), "a file, rails given here, or femto-2.5in", "\"femto-2.5in\"", "A named air-bearing surface.");
    SLIDER_SURFACE_FILE: Text = Key::optional("slider.surface.file", Kind::Text, "no file", "\"surface.toml\"", "File of the air-bearing surface, beside the study.");
    SLIDER_SURFACE_BASE_RECESS_UM: f64 = Key::or("slider.surface.base_recess_um", Number(FROM_ZERO), "1.5", "Recess of everything no rail covers.").usual(0.1, 10.0).code("E145") => |scene| scene.slider.surface.base_recess_m;
    SLIDER_SURFACE_CROWN_NM: f64 = Key::or("slider.surface.crown_nm", Number(ANY), "15.0", "Rise of the middle over the ends.").usual(0.1, 100.0) => |scene| scene.slider.surface.crown_m;
    SLIDER_SURFACE_CAMBER_NM: f64 = Key::or("slider.surface.camber_nm", Number(ANY), "2.0", "Rise of the middle over the sides.").usual(0.1, 100.0) => |scene| scene.slider.surface.camber_m;
    SLIDER_SURFACE_TWIST_NM: f64 = Key::or("slider.surface.twist_nm", Number(ANY), "0.0", "Twist.").usual(0.1, 100.0) => |scene| scene.slider.surface.twist_m;
    SLIDER_SURFACE_TAPER_LENGTH_UM: f64 = Key::or("slider.surface.taper_length_um", Number(FROM_ZERO), "0.0", "Length of the taper at the leading edge; 0 for none.").usual(0.0, 1000.0).code("E145") => |scene| scene.slider.surface.taper_length_m;
    SLIDER_SURFACE_TAPER_ANGLE_DEG: f64 = Key::or("slider.surface.taper_angle_deg", Number(below(0.0, 45.0)), "0.0", "Angle of the taper at the leading edge.").usual(0.0, 5.0).code("E145") => |scene| scene.slider.surface.taper_angle_rad;
    SLIDER_SURFACE_RAIL: Tables = Key::optional("slider.surface.rail", Kind::Tables, "the rails of preset or file", "[{ kind = \"rect\", x_um = [20, 170], y_um = [30, 670], recess_um = 0.25 }]", "Rails; later ones overwrite earlier ones.").code("E135");
    SLIDER_SURFACE_RAIL_KIND: RailKind = Key::required("slider.surface.rail[].kind", RailKind::KIND, "\"rect\"", "Shape of the rail's outline.").fixed();
    SLIDER_SURFACE_RAIL_X_UM: Pair = Key::optional("slider.surface.rail[].x_um", Kind::Pair(ANY), "a polygon", "[20, 170]", "Range along the length, from the leading edge.").code("E144").usual(1.0, 2000.0);
    SLIDER_SURFACE_RAIL_Y_UM: Pair = Key::optional("slider.surface.rail[].y_um", Kind::Pair(ANY), "a polygon", "[30, 670]", "Range across, from the inner edge.").code("E144").usual(1.0, 2000.0);
    SLIDER_SURFACE_RAIL_POINTS_UM: Corners = Key::optional("slider.surface.rail[].points_um", Kind::Points, "a rectangle", "[[20, 30], [170, 30], [170, 670]]", "Corners of a polygon.").code("E144").usual(1.0, 2000.0);
    SLIDER_SURFACE_RAIL_RECESS_UM: f64 = Key::required("slider.surface.rail[].recess_um", Number(FROM_ZERO), "0.25", "Recess of the rail from the reference plane.").usual(0.005, 10.0).code("E145");
    // suspension
    SUSPENSION_GRAM_LOAD_GF: f64 = Key::or("suspension.gram_load_gf", LENGTH, "2.2", "Load at the slider's centre.").usual(0.1, 8.0) => |scene| scene.suspension.gram_load_n;
    SUSPENSION_HINGE_LENGTH_MM: f64 = Key::or("suspension.hinge.length_mm", LENGTH, "1.3", "Length of the hinge.").usual(0.1, 10.0) => |scene| scene.suspension.hinge.length_m;
    SUSPENSION_HINGE_WIDTH_MM: f64 = Key::or("suspension.hinge.width_mm", LENGTH, "1.8", "Width of the hinge.").usual(0.1, 20.0) => |scene| scene.suspension.hinge.width_m;
    SUSPENSION_HINGE_THICKNESS_UM: f64 = Key::or("suspension.hinge.thickness_um", LENGTH, "40.0", "Thickness of the hinge.").usual(5.0, 200.0) => |scene| scene.suspension.hinge.thickness_m;
    SUSPENSION_LOAD_BEAM_DIMPLE_MM: f64 = Key::or("suspension.load_beam.dimple_mm", LENGTH, "10.5", "Dimple, from the root of the hinge.").usual(2.0, 40.0) => |scene| scene.suspension.load_beam.dimple_m;
    SUSPENSION_LOAD_BEAM_END_MM: f64 = Key::or("suspension.load_beam.end_mm", LENGTH, "11.8", "End of the tab, from the root of the hinge.").usual(2.0, 50.0) => |scene| scene.suspension.load_beam.end_m;
    SUSPENSION_LOAD_BEAM_WEB_UM: f64 = Key::or("suspension.load_beam.web_um", LENGTH, "28.0", "Thickness of the web.").usual(5.0, 200.0) => |scene| scene.suspension.load_beam.web_m;
    SUSPENSION_LOAD_BEAM_WIDTH_ROOT_MM: f64 = Key::or("suspension.load_beam.width_root_mm", LENGTH, "3.8", "Width where the load beam meets the hinge.").usual(0.2, 20.0) => |scene| scene.suspension.load_beam.width_root_m;
    SUSPENSION_LOAD_BEAM_WIDTH_DIMPLE_MM: f64 = Key::or("suspension.load_beam.width_dimple_mm", LENGTH, "1.2", "Width at the dimple.").usual(0.1, 10.0) => |scene| scene.suspension.load_beam.width_dimple_m;
    SUSPENSION_LOAD_BEAM_TAB_WIDTH_MM: f64 = Key::or("suspension.load_beam.tab_width_mm", LENGTH, "0.6", "Width of the tab.").usual(0.05, 10.0) => |scene| scene.suspension.load_beam.tab_width_m;
    SUSPENSION_FLANGE_HEIGHT_UM: f64 = Key::or("suspension.flange.height_um", Number(FROM_ZERO), "140.0", "Height of the flanges on both sides.").usual(0.0, 1000.0) => |scene| scene.suspension.flange.height_m;
    SUSPENSION_FLANGE_FROM_MM: f64 = Key::or("suspension.flange.from_mm", Number(FROM_ZERO), "1.9", "Start of the flanges, from the root of the hinge.").usual(0.0, 40.0) => |scene| scene.suspension.flange.from_m;
    SUSPENSION_FLANGE_TO_MM: f64 = Key::or("suspension.flange.to_mm", LENGTH, "9.6", "End of the flanges, from the root of the hinge.").usual(0.5, 40.0) => |scene| scene.suspension.flange.to_m;
    SUSPENSION_FLEXURE_MASS_MG: f64 = Key::or("suspension.flexure.mass_mg", Number(FROM_ZERO), "0.9", "Mass of the flexure, smeared evenly over the beam.").usual(0.0, 50.0) => |scene| scene.suspension.flexure.mass_kg;
    SUSPENSION_FLEXURE_FROM_MM: f64 = Key::or("suspension.flexure.from_mm", Number(FROM_ZERO), "1.0", "Start of the smeared mass, from the root of the hinge; it ends with the beam.").usual(0.0, 40.0) => |scene| scene.suspension.flexure.from_m;
    SUSPENSION_MATERIAL_YOUNGS_MODULUS_GPA: f64 = Key::or("suspension.material.youngs_modulus_gpa", LENGTH, "193.0", "Young's modulus.").usual(10.0, 700.0) => |scene| scene.suspension.youngs_modulus_pa;
    SUSPENSION_MATERIAL_SHEAR_MODULUS_GPA: f64 = Key::or("suspension.material.shear_modulus_gpa", LENGTH, "74.0", "Shear modulus.").usual(5.0, 300.0) => |scene| scene.suspension.shear_modulus_pa;
    SUSPENSION_MATERIAL_DENSITY_KG_PER_M3: f64 = Key::or("suspension.material.density_kg_per_m3", LENGTH, "7900.0", "Density.").usual(1000.0, 12000.0) => |scene| scene.suspension.density_kg_per_m3;
    SUSPENSION_DAMPING_RATIO: f64 = Key::or("suspension.damping_ratio", RATIO, "0.02", "Damping ratio of every mode of the suspension.").code("E132") => |scene| scene.suspension.damping_ratio;
    SUSPENSION_RAYLEIGH_ALPHA_PER_S: Option<f64> = Key::optional("suspension.rayleigh.alpha_per_s", Number(FROM_ZERO), "damping_ratio", "25.0", "Rayleigh damping in place of damping_ratio: share of the mass matrix.").usual(0.0, 1000.0).code("E132");
    SUSPENSION_RAYLEIGH_BETA_S: Option<f64> = Key::optional("suspension.rayleigh.beta_s", Number(FROM_ZERO), "0", "1.0e-7", "Its share of the stiffness matrix.").usual(0.0, 1e-4).code("E132");
    SUSPENSION_GIMBAL_VERTICAL_N_PER_M: f64 = Key::or("suspension.gimbal.vertical_n_per_m", LENGTH, "15.0", "Stiffness of the gimbal, vertical.").usual(0.1, 1e5) => |scene| scene.suspension.gimbal.vertical_n_per_m;
    SUSPENSION_GIMBAL_PITCH_N_M_PER_RAD: f64 = Key::or("suspension.gimbal.pitch_n_m_per_rad", LENGTH, "6.0e-5", "Stiffness of the gimbal, pitch.").usual(1e-7, 1e-2) => |scene| scene.suspension.gimbal.pitch_n_m_per_rad;
    SUSPENSION_GIMBAL_ROLL_N_M_PER_RAD: f64 = Key::or("suspension.gimbal.roll_n_m_per_rad", LENGTH, "2.5e-5", "Stiffness of the gimbal, roll.").usual(1e-7, 1e-2) => |scene| scene.suspension.gimbal.roll_n_m_per_rad;
    SUSPENSION_GIMBAL_DIMPLE_PRELOAD_GF: f64 = Key::or("suspension.gimbal.dimple_preload_gf", Number(FROM_ZERO), "0.0", "Force by which the bent gimbal presses slider and dimple together, in addition to the gram load; the film does not carry it.").usual(0.0, 5.0) => |scene| scene.suspension.gimbal.dimple_preload_n;
    SUSPENSION_DIMPLE_STIFFNESS_N_PER_M: f64 = Key::or("suspension.dimple.stiffness_n_per_m", LENGTH, "5.0e5", "Stiffness of the closed dimple contact; 1e8 is as good as rigid.").usual(1e3, 1e8) => |scene| scene.suspension.dimple.stiffness_n_per_m;
    SUSPENSION_DIMPLE_DAMPING_RATIO: f64 = Key::or("suspension.dimple.damping_ratio", RATIO, "0.05", "Damping ratio of the closed dimple contact, on the slider's mass.").code("E132") => |scene| scene.suspension.dimple.damping_ratio;
    SUSPENSION_LIMITERS_GAP_UM: Option<f64> = Key::optional("suspension.limiters.gap_um", Number(FROM_ZERO), "no limiters", "92.4", "Opening of the dimple at which the limiters hold it, from steady flight; with it there is an inner and an outer one.").usual(1.0, 1000.0).code("E139");
    SUSPENSION_LIMITERS_GAP_OUTER_UM: Option<f64> = Key::optional("suspension.limiters.gap_outer_um", Number(FROM_ZERO), "gap_um", "92.5", "The same of the outer limiter, where it differs.").usual(1.0, 1000.0).code("E139");
    SUSPENSION_LIMITERS_ALONG_MM: Option<f64> = Key::optional("suspension.limiters.along_mm", Number(ANY), "0", "0.3", "Place of the limiters from the dimple towards the tip.").usual(-3.0, 3.0).code("E139");
    SUSPENSION_LIMITERS_ACROSS_MM: Option<f64> = Key::optional("suspension.limiters.across_mm", Number(FROM_ZERO), "0", "0.4", "Distance of each from the middle: inner limiter inwards, outer one outwards.").usual(0.0, 3.0).code("E139");
    SUSPENSION_LIMITERS_STIFFNESS_N_PER_M: Option<f64> = Key::optional("suspension.limiters.stiffness_n_per_m", LENGTH, "that of the dimple", "1.0e5", "Stiffness of each limiter in contact.").usual(1e2, 1e8).code("E139");
    SUSPENSION_LIMITERS_DAMPING_RATIO: Option<f64> = Key::optional("suspension.limiters.damping_ratio", RATIO, "that of the dimple", "0.05", "Damping ratio of a limiter in contact, on the slider's mass.").code("E132");
    SUSPENSION_LIFT_TAB_GAP_UM: Option<f64> = Key::optional("suspension.lift_tab.gap_um", Number(FROM_ZERO), "the tab moves freely", "150.0", "Rise of the end of the tab at which it meets a stop of the base, from steady flight.").usual(1.0, 5000.0).code("E139");
    SUSPENSION_LIFT_TAB_STIFFNESS_N_PER_M: Option<f64> = Key::optional("suspension.lift_tab.stiffness_n_per_m", LENGTH, "that of the dimple", "1.0e5", "Stiffness of the tab in contact with its stop.").usual(1e2, 1e8).code("E139");
    SUSPENSION_LIFT_TAB_DAMPING_RATIO: Option<f64> = Key::optional("suspension.lift_tab.damping_ratio", RATIO, "that of the dimple", "0.05", "Damping ratio of the tab in contact, on the slider's mass.").code("E132");
    SUSPENSION_IMPORTED_MASS: Text = Key::optional("suspension.imported.mass", Kind::Text, "a suspension by its geometry", "\"susp_M.dat\"", "Mass matrix of another program: Matrix Market (.mtx), CalculiX (.mas) or rows of numbers.");
    SUSPENSION_IMPORTED_STIFFNESS: Text = Key::optional("suspension.imported.stiffness", Kind::Text, "a suspension by its geometry", "\"susp_K.dat\"", "Its stiffness matrix.");
    SUSPENSION_IMPORTED_FREEDOMS: Text = Key::optional("suspension.imported.freedoms", Kind::Text, "places", "\"susp.dof\"", "Freedoms of the rows, a line node.direction each.");
    SUSPENSION_IMPORTED_PLACES: Text = Key::optional("suspension.imported.places", Kind::Text, "freedoms", "\"susp_cords.dat\"", "Places and kinds of the rows, a line x y z type each, mm.");
    SUSPENSION_IMPORTED_UNITS: Option<Units> = Key::optional("suspension.imported.units", Units::KIND, "si", "\"mm_mn\"", "Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t.");
    SUSPENSION_IMPORTED_DIMPLE: Option<i64> = Key::optional("suspension.imported.dimple", Integer(1, 1_000_000_000), "a suspension by its geometry", "29", "Node of the dimple: z, roll about x and slope about y.");
    SUSPENSION_IMPORTED_BASE: Numbers = Key::optional("suspension.imported.base", Kind::Numbers(ABOVE_ZERO), "the base is not in the matrices", "[1]", "Nodes that the base holds; their mass loads the others.");
    SUSPENSION_IMPORTED_CUT_KHZ: Option<f64> = Key::optional("suspension.imported.cut_khz", LENGTH, "1000.0", "1000.0", "Modes with the dimple held, below this frequency, are kept of matrices of more than 300 rows.").usual(20.0, 10_000.0).code("E174");
    SUSPENSION_MODES: Tables = Key::optional("suspension.modes", Kind::Tables, "a suspension by its geometry", "[{ frequency_hz = 333.0, vertical_per_sqrt_kg = 700.0, slope_per_m_sqrt_kg = 9.0e4, roll_per_m_sqrt_kg = 0.0, participation_sqrt_kg = 1.7e-3 }]", "Modes of the suspension on its base, in place of its geometry.").code("E135");
    SUSPENSION_MODES_FREQUENCY_HZ: f64 = Key::required("suspension.modes[].frequency_hz", LENGTH, "333.0", "Undamped natural frequency.").usual(10.0, 1e6);
    SUSPENSION_MODES_VERTICAL_PER_SQRT_KG: f64 = Key::required("suspension.modes[].vertical_per_sqrt_kg", Number(ANY), "700.0", "Displacement z of the dimple, of unit modal mass.").usual(-1e4, 1e4);
    SUSPENSION_MODES_SLOPE_PER_M_SQRT_KG: f64 = Key::required("suspension.modes[].slope_per_m_sqrt_kg", Number(ANY), "9.0e4", "Slope dw/dx at the dimple, x from root to tip.").usual(-1e7, 1e7);
    SUSPENSION_MODES_ROLL_PER_M_SQRT_KG: f64 = Key::required("suspension.modes[].roll_per_m_sqrt_kg", Number(ANY), "0.0", "Roll of the dimple; 0 in a mode that bends.").usual(-1e7, 1e7);
    SUSPENSION_MODES_PARTICIPATION_SQRT_KG: f64 = Key::required("suspension.modes[].participation_sqrt_kg", Number(ANY), "1.7e-3", "Load on the mode by a unit acceleration of the base.").usual(-0.1, 0.1);
    // gas
    GAS_PRESSURE_PA: Option<f64> = Key::optional("gas.pressure_pa", LENGTH, "101325 Pa, or from altitude_m", "101325.0", "Ambient pressure.").usual(2e4, 2e5);
    GAS_ALTITUDE_M: Option<f64> = Key::optional("gas.altitude_m", Number(closed(-5000.0, 11000.0)), "sea level", "3000.0", "Altitude: pressure of the standard atmosphere.").usual(-500.0, 6000.0);
    GAS_TEMPERATURE_C: Option<f64> = Key::optional("gas.temperature_c", Number(open(-100.0, 500.0)), "18.45 degrees, where the viscosity is 1.806e-5 Pa s", "25.0", "Temperature: viscosity by Sutherland's law, and mean free path.").usual(-40.0, 100.0);
    GAS_VISCOSITY_PA_S: Option<f64> = Key::optional("gas.viscosity_pa_s", LENGTH, "from the temperature", "1.806e-5", "Dynamic viscosity.").usual(1e-6, 1e-4);
    GAS_MEAN_FREE_PATH_NM: Option<f64> = Key::optional("gas.mean_free_path_nm", LENGTH, "63.5 nm scaled with viscosity, pressure and temperature", "63.5", "Mean free path at the ambient pressure.").usual(5.0, 500.0);
    GAS_MODEL: FlowModel = Key::or("gas.model", FlowModel::KIND, "\"fukui_kaneko\"", "Rarefaction model of the film.") => |scene| scene.flow;
    // surface forces
    SURFACE_FORCES_HAMAKER_J: Option<f64> = Key::optional("surface_forces.hamaker_j", Number(FROM_ZERO), "no van der Waals force", "1.8e-19", "Hamaker's constant A of the attraction A/(6 pi h^3) per area between slider and disk.").usual(1e-21, 1e-18).code("E125") => |scene| scene.gap_forces.surface_forces.hamaker_j;
    SURFACE_FORCES_REPULSION_J_M6: Option<f64> = Key::optional("surface_forces.repulsion_j_m6", Number(FROM_ZERO), "no repulsion", "1.0e-76", "Constant B of the repulsion B/(45 pi h^9) per area that ends the attraction.").usual(1e-79, 1e-74).code("E125") => |scene| scene.gap_forces.surface_forces.repulsion_j_m6;
    SURFACE_FORCES_POTENTIAL_V: Option<f64> = Key::optional("surface_forces.potential_v", Number(ANY), "no electrostatic force", "0.5", "Potential difference V of slider and disk: attraction eps0 V^2/(2 h^2) per area.").usual(-10.0, 10.0).code("E125") => |scene| scene.gap_forces.surface_forces.potential_v;
    // contact of asperities
    ASPERITY_CONTACT_ROUGHNESS_NM: Option<f64> = Key::optional("asperity_contact.roughness_nm", LENGTH, "smooth surfaces without contact", "0.5", "Standard deviation of the sum of the heights of slider and disk. With it asperities bear, and the film's height is the mean gap.").usual(0.1, 10.0).code("E125") => |scene| scene.gap_forces.asperity_contact.roughness_m;
    ASPERITY_CONTACT_ASPERITIES_PER_UM2: Option<f64> = Key::optional("asperity_contact.asperities_per_um2", LENGTH, "100.0", "100.0", "Asperities per area. The default makes roughness x tip radius x density 0.05 (Greenwood and Williamson 1966: 0.03 to 0.05); doubtful for a disk.").usual(0.1, 1e4).code("E125") => |scene| scene.gap_forces.asperity_contact.asperities_per_m2;
    ASPERITY_CONTACT_TIP_RADIUS_UM: Option<f64> = Key::optional("asperity_contact.tip_radius_um", LENGTH, "1.0", "1.0", "Radius of their tips (1 um in a sample of the CML Dynamic Simulator).").usual(0.01, 100.0).code("E125") => |scene| scene.gap_forces.asperity_contact.tip_radius_m;
    ASPERITY_CONTACT_MODULUS_GPA: Option<f64> = Key::optional("asperity_contact.modulus_gpa", LENGTH, "100.0", "100.0", "E' with 1/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 of the two surfaces; doubtful, since coatings are thinner than what is pressed in.").usual(10.0, 1000.0).code("E125") => |scene| scene.gap_forces.asperity_contact.modulus_pa;
    ASPERITY_CONTACT_YIELD_PRESSURE_GPA: Option<f64> = Key::optional("asperity_contact.yield_pressure_gpa", LENGTH, "12.0", "12.0", "Largest contact pressure of an asperity, at which it yields: about the hardness of the softer surface; doubtful.").usual(0.5, 100.0).code("E125") => |scene| scene.gap_forces.asperity_contact.yield_pressure_pa;
    ASPERITY_CONTACT_FRICTION: Option<f64> = Key::optional("asperity_contact.friction", Number(FROM_ZERO), "0.3", "0.3", "Coefficient of friction (0.3 in that sample).").usual(0.0, 1.5).code("E125") => |scene| scene.gap_forces.asperity_contact.friction;
    // search
    SEARCH_AMPLITUDE_G_MIN: f64 = Key::or("search.amplitude_g.min", Number(ABOVE_ZERO), "20.0", "Lowest amplitude tried.").usual(0.1, 1e4).code("E156");
    SEARCH_AMPLITUDE_G_MAX: f64 = Key::or("search.amplitude_g.max", Number(ABOVE_ZERO), "2000.0", "Highest amplitude tried.").usual(1.0, 1e5).code("E156");
    SEARCH_TOLERANCE_PCT: f64 = Key::or("search.tolerance_pct", Number(closed(1e-6, 50.0)), "1.0", "Width of the final bracket.").usual(0.01, 20.0).code("E156");
    SEARCH_MONOTONICITY_SCAN: MonotonicityScan = Key::or("search.monotonicity_scan", MonotonicityScan::KIND, "\"sampled\"", "Which amplitudes below the lowest failure are simulated, to see that none of them fails: all (full), some (sampled), none (off).");
    SEARCH_SCAN_GAP_PCT: f64 = Key::or("search.scan_gap_pct", Number(above(0.0, 100.0)), "10.0", "Largest gap between the amplitudes that a sampled scan simulates.").code("E156");
    SEARCH_UNCERTAINTY: bool = Key::or("search.uncertainty", Flag, "true", "Gives each critical shock its uncertainty interval.");
    SEARCH_UNCERTAINTY_OF: Option<UncertaintyOf> = Key::optional("search.uncertainty_of", UncertaintyOf::KIND, "all points", "\"decisive\"", "Points that get uncertainty intervals: all, or the decisive ones, on which the best value of every axis and its lead depend, or without such an axis the worst case, or the verdicts on search.required_amplitude_g. These are refined only while that is open; the other points have their brackets alone.").code("E156");
    SEARCH_REQUIRED_AMPLITUDE_G: Option<f64> = Key::optional("search.required_amplitude_g", Number(ABOVE_ZERO), "none", "400.0", "Amplitude that every point must survive. With search.uncertainty_of = \"decisive\" intervals are then made for points within a factor 4 of this amplitude, and those whose interval contains it are refined, until they meet the target uncertainty.").usual(1.0, 1e5).code("E156");
    SEARCH_TARGET_UNCERTAINTY_PCT: Option<f64> = Key::optional("search.target_uncertainty_pct", Number(above(0.0, 100.0)), "that of the preset: 5, 1, 0.1", "1.0", "Uncertainty wanted of each critical shock: half-width of its uncertainty interval over the value. A point that misses it is refined.").usual(0.05, 20.0).code("E156");
    SEARCH_MAX_REFINEMENTS: u8 = Key::or("search.max_refinements", Integer(0, 100), "3", "Times that a point which misses the target uncertainty is refined and answered anew.");
    SEARCH_ADDED_POINTS_TOLERANCE_PCT: Option<f64> = Key::optional("search.added_points.tolerance_pct", Number(above(0.0, 100.0)), "no widths are added for it", "5.0", "Adds widths until straight lines between the answers of a ramp model are this good.").usual(1.0, 50.0).code("E156");
    SEARCH_ADDED_POINTS_CROSSING_PCT: Option<f64> = Key::optional("search.added_points.crossing_pct", Number(above(0.0, 100.0)), "no widths are added for it", "5.0", "Adds widths until those between which two ramp models change places are this close.").usual(1.0, 50.0).code("E156");
    SEARCH_ADDED_POINTS_CLOSEST_PCT: Option<f64> = Key::optional("search.added_points.closest_pct", Number(above(0.0, 100.0)), "2", "2.0", "No widths are added closer than this.").usual(0.5, 50.0).code("E156");
    SEARCH_ADDED_POINTS_MAX_POINTS: Option<usize> = Key::optional("search.added_points.max_points", Integer(1, 100_000), "60", "60", "Points added at most.");
    // solver
    SOLVER_EFFECTS: Effects = Key::or("solver.effects", Effects::KIND, "\"auto\"", "auto simulates only what the outputs need.").fixed();
    SOLVER_LEAVE_OUT: Many<LeftOut> = Key::or("solver.leave_out", LeftOut::KIND_OF_MANY, "[]", "Effects left out by hand; refused when an output needs them.");
    SOLVER_COUPLING: Coupling = Key::or("solver.coupling", Coupling::KIND, "\"monolithic\"", "How film and slider are solved together.") => |scene| scene.head_resolution.coupling;
    SOLVER_MAX_STEPS: u64 = Key::or("solver.max_steps", Integer(1, 1_000_000_000_000), "2000000", "Deterministic limit of steps; reaching it leaves the run undecided.") => |scene| scene.head_resolution.max_steps;
    // resolution
    RESOLUTION_PRESET: Preset = Key::or("resolution.preset", Preset::KIND, "\"standard\"", "Named set of discretisation parameters: gives those that are not set here, and search.target_uncertainty_pct where that is not set.").code("E157");
    RESOLUTION_DISK_CUT_KHZ: Option<f64> = Key::by_preset("resolution.disk_cut_khz", LENGTH, "240.0", "Modes of the disk above this frequency are left out.").usual(1.0, 1000.0) => |scene| scene.disk_resolution.cut_hz;
    RESOLUTION_NOT_REFINED: Many<Discretisation> = Key::optional("resolution.not_refined", Discretisation::KIND_OF_MANY, "all are refined", "[\"disk_modes\"]", "Discretisation parameters whose values belong to the model, as the modes of another program's mesh: they contribute to no uncertainty interval, and no refinement changes them.");
    RESOLUTION_DISK_HARMONICS: Option<usize> = Key::by_preset("resolution.disk_harmonics", Integer(1, 2000), "112", "Largest number of nodal diameters.") => |scene| scene.disk_resolution.n_harmonics;
    RESOLUTION_DISK_ELEMENTS: Option<usize> = Key::by_preset("resolution.disk_elements", Integer(4, 400), "80", "Radial finite elements of the disk.") => |scene| scene.disk_resolution.n_elements;
    RESOLUTION_STATIC_CORRECTION: Option<bool> = Key::by_preset("resolution.static_correction", Flag, "true", "Adds the residual flexibility of the ramp point.") => |scene| scene.disk_resolution.static_correction;
    RESOLUTION_STRUCTURE_STEP_US: Option<f64> = Key::by_preset("resolution.structure_step_us", LENGTH, "0.25", "Step on which disk and ramp are stored and contact is resolved.").usual(1e-3, 20.0) => |scene| scene.structure_resolution.step_s;
    RESOLUTION_HEAD_TOLERANCE: Option<f64> = Key::by_preset("resolution.head_tolerance", Number(open(0.0, 1.0)), "2.0e-2", "Relative local error of the clearance per step.").usual(1e-9, 0.1) => |scene| scene.head_resolution.tolerance;
    RESOLUTION_APPROACH_SHARE: Option<f64> = Key::by_preset("resolution.approach_share", Number(open(0.0, 1.0)), "0.25", "Largest share of the clearance closed in one step.") => |scene| scene.head_resolution.approach_share;
    RESOLUTION_FILM_CELLS: Option<usize> = Key::by_preset("resolution.film_cells", Integer(16, 4_000_000), "1000", "Wanted number of film cells.") => |scene| scene.film_resolution.cells;
    RESOLUTION_FILM_CORRECTION_CELLS: Option<usize> = Key::by_preset("resolution.film_correction_cells", Integer(0, 1_000_000), "1000", "Cells of the defect-correction grid, whose forces correct those of the film (2000 at least for a skewed slider); 0: no correction, as where film_cells is set alone.") => |scene| scene.film_resolution.correction_cells;
    RESOLUTION_MIN_FILM_HEIGHT_NM: Option<f64> = Key::by_preset("resolution.min_film_height_nm", LENGTH, "0.3", "Minimum film height, a regularisation: the height that the film sees does not fall below it. No uncertainty interval includes what another one would change.").usual(0.01, 5.0) => |scene| scene.film_resolution.min_height_m;
    RESOLUTION_COUPLING_TOLERANCE: Option<f64> = Key::by_preset("resolution.coupling_tolerance", Number(open(0.0, 0.1)), "2.0e-4", "Relative residual of the coupled solve; a hundredth of head_tolerance when that is set alone.").usual(1e-12, 1e-2) => |scene| scene.head_resolution.coupling_tolerance;
    RESOLUTION_SUSPENSION_MODES: Option<usize> = Key::by_preset("resolution.suspension_modes", Integer(1, 200), "32", "Modes of the suspension kept above the pinned dimple.") => |scene| scene.head_resolution.suspension_modes;
    // failure
    FAILURE_CLEARANCE_NM: f64 = Key::or("failure.clearance_nm", Number(ANY), "0.0", "Clearance below which the interface has failed.").usual(-10.0, 100.0) => |scene| scene.fail_below_m;
    FAILURE_CRITERION: Option<Criterion> = Key::optional("failure.criterion", Criterion::KIND, "touch", "\"damage\"", "What is called failure: a touch of slider and disk, or contact that exceeds one of the limits of damage below, where a touch is none.").code("E127");
    FAILURE_DAMAGE_OVERLAP_NM: Option<f64> = Key::optional("failure.damage.overlap_nm", LENGTH, "no limit", "2.0", "Limit of damage: overlap of the mean planes of slider and disk.").usual(0.1, 100.0).code("E127") => |scene| *damage(scene).overlap_m.get_or_insert_default();
    FAILURE_DAMAGE_PRESSURE_GPA: Option<f64> = Key::optional("failure.damage.pressure_gpa", LENGTH, "no limit", "1.0", "Limit of damage: contact pressure of a nominal area.").usual(0.01, 50.0).code("E127") => |scene| *damage(scene).pressure_pa.get_or_insert_default();
    FAILURE_DAMAGE_CONTACTS: Option<u64> = Key::optional("failure.damage.contacts", Integer(0, 1_000_000), "no limit", "3", "Limit of damage: number of contacts, each a force above 1 % of the steady force of the dimple.").code("E127") => |scene| *damage(scene).episodes.get_or_insert_default();
    // fields
    FIELDS_TIMES_MS: Numbers = Key::optional("fields.times_ms", Kind::Numbers(FROM_ZERO), "no pressure field", "[0.6, 0.8]", "Times at which pressure_field is kept, on the time axis of every output: pressure and height of the film in every cell.").code("E152").usual(0.001, 100.0);
    // output
    OUTPUT_KEEP_HISTORIES: KeepHistories = Key::or("output.keep_histories", KeepHistories::KIND, "\"bracket\"", "Which time histories are stored.");
    OUTPUT_CHECKPOINT_S: f64 = Key::or("output.checkpoint_s", Number(above(0.0, 86_400.0)), "30", "Time between two refreshes of results.h5.").usual(1.0, 3600.0);
}
