//! Header and columns of a history file.

use crate::search::Sign;
use crate::store::summary::AxisValue;
use opshock_solver::simulation::{HeadColumns, History, Mechanism, StructureColumns};

/// Number of the history file format; raised when a reader of the older one would go wrong.
pub const HISTORY_FORMAT: u32 = 2;

/// Header of a history file.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryHeader {
    /// Name of the study.
    pub study: String,
    /// Digest of the study.
    pub digest: String,
    /// Version of the program.
    pub program_version: String,
    /// Commit the program was built from.
    pub commit: String,
    /// Ramp model.
    pub ramp: String,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign of the shock.
    pub sign: Sign,
    /// Names of the study's further axes and the run's place on them.
    pub axes: Vec<(String, AxisValue)>,
    /// Amplitude without sign, multiples of standard gravity.
    pub amplitude_g: f64,
    /// Onset of the pulse on the study's time axis, s.
    pub start_s: f64,
    /// `survives`, `fails` or `undecided`.
    pub verdict: String,
    /// Time of touch on the study's time axis, s.
    pub t_fail_s: Option<f64>,
    /// Why it failed.
    pub mechanism: Option<Mechanism>,
    /// Names of the simulated effects.
    pub effects: Vec<String>,
    /// The run ([`KeptRun::content`](super::KeptRun::content)) when the file belongs to a store; else empty.
    pub run: String,
}

/// One named column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Dataset and CSV name; ends in the unit.
    pub name: &'static str,
    /// Unit as written to the `units` attribute.
    pub units: &'static str,
    /// Description in a sentence.
    pub description: &'static str,
    /// Values on the column's time.
    pub values: Vec<f64>,
}

/// Group, dataset or CSV column of what belongs to pressure fields: name, unit, sentence.
pub(super) const FIELD_COLUMNS: [(&str, &str, &str); 5] = [
    ("time_s", "s", "times of the fields on the study's axis"),
    (
        "y_lines_m",
        "m",
        "grid lines across the slider from its inner edge",
    ),
    (
        "x_lines_m",
        "m",
        "grid lines along the slider from its leading edge",
    ),
    (
        "pressure_pa",
        "Pa",
        "absolute pressure in the middle of every cell: time, y, x",
    ),
    (
        "gap_m",
        "m",
        "height of the slider's surface over the disk in the middle of every cell: time, y, x",
    ),
];

/// Columns of disk and ramp, `time_s` first, on the study's time axis.
pub fn structure_columns(columns: &StructureColumns, start_s: f64) -> Vec<Column> {
    let column = |name, units, description, values: &Vec<f64>| Column {
        name,
        units,
        description,
        values: values.clone(),
    };
    let mut list = vec![
        Column {
            name: "time_s",
            units: "s",
            description: "time on the study's axis; the pulse starts at attribute start_s",
            values: shifted(&columns.time_s, start_s),
        },
        column(
            "shock_m_per_s2",
            "m/s2",
            "inertia load per mass along +z felt in the base frame (minus the base's acceleration)",
            &columns.shock_m_per_s2,
        ),
        column(
            "disk_slider_m",
            "m",
            "disk displacement under the slider, relative to the base",
            &columns.disk_slider_m,
        ),
        column(
            "disk_ramp_m",
            "m",
            "disk displacement at the ramp's contact point, relative to the base",
            &columns.disk_ramp_m,
        ),
        column(
            "disk_rim_m",
            "m",
            "disk displacement at the rim, at the ramp's angle, relative to the base",
            &columns.disk_rim_m,
        ),
        column(
            "disk_pitch_rad",
            "rad",
            "slope of the disk under the slider, in the slider's pitch sense",
            &columns.disk_pitch_rad,
        ),
        column(
            "disk_roll_rad",
            "rad",
            "slope of the disk under the slider, in the slider's roll sense",
            &columns.disk_roll_rad,
        ),
        column(
            "ramp_top_m",
            "m",
            "displacement of the top arm's contact point, relative to the base",
            &columns.ramp_top_m,
        ),
        column(
            "ramp_bottom_m",
            "m",
            "displacement of the bottom arm's contact point, relative to the base",
            &columns.ramp_bottom_m,
        ),
        column(
            "contact_top_n",
            "N",
            "contact force with the top arm, 20 us running mean",
            &columns.contact_top_n,
        ),
        column(
            "contact_bottom_n",
            "N",
            "contact force with the bottom arm, 20 us running mean",
            &columns.contact_bottom_n,
        ),
        column(
            "energy_j",
            "J",
            "material kinetic and elastic energy of disk and ramp",
            &columns.energy_j,
        ),
        column(
            "energy_h_j",
            "J",
            "H, the energy on which a space-fixed ramp does no work beyond its own motion",
            &columns.energy_h_j,
        ),
    ];
    // Only of a disk on a hub, of a base that vibrates.
    let bodies = [
        column(
            "hub_axial_m",
            "m",
            "axial displacement of the hub, relative to the base",
            &columns.hub_axial_m,
        ),
        column(
            "hub_tilt_ramp_rad",
            "rad",
            "tilt of the hub that lifts the disk at the ramp's angle",
            &columns.hub_tilt_ramp_rad,
        ),
        column(
            "hub_tilt_across_rad",
            "rad",
            "tilt of the hub that lifts the disk a quarter turn on from the ramp, with the spin",
            &columns.hub_tilt_across_rad,
        ),
        column(
            "base_spindle_m",
            "m",
            "displacement of the spindle over the base as it would move rigidly",
            &columns.base_spindle_m,
        ),
        column(
            "base_ramp_m",
            "m",
            "displacement of the ramp's mount over the base as it would move rigidly",
            &columns.base_ramp_m,
        ),
        column(
            "base_pivot_m",
            "m",
            "displacement of the actuator's pivot over the base as it would move rigidly",
            &columns.base_pivot_m,
        ),
    ];
    list.extend(
        bodies
            .into_iter()
            .filter(|column| !column.values.is_empty()),
    );
    list
}

/// Columns of the head at its own steps, `time_s` first, on the study's time axis.
pub fn head_columns(columns: &HeadColumns, start_s: f64) -> Vec<Column> {
    let column = |name, units, description, values: &Vec<f64>| Column {
        name,
        units,
        description,
        values: values.clone(),
    };
    let mut list = vec![
        Column {
            name: "time_s",
            units: "s",
            description: "accepted steps of the head on the study's axis; ends at failure",
            values: shifted(&columns.time_s, start_s),
        },
        column(
            "slider_z_m",
            "m",
            "displacement of the slider's centre from steady flight, relative to the base",
            &columns.slider_z_m,
        ),
        column(
            "slider_pitch_rad",
            "rad",
            "pitch of the slider, positive with the leading edge up",
            &columns.slider_pitch_rad,
        ),
        column(
            "slider_roll_rad",
            "rad",
            "roll of the slider, positive with the outer edge up",
            &columns.slider_roll_rad,
        ),
        column(
            "min_clearance_m",
            "m",
            "smallest clearance between slider and disk",
            &columns.min_clearance_m,
        ),
        column(
            "bearing_force_n",
            "N",
            "net force of the air film on the slider",
            &columns.bearing_force_n,
        ),
        column(
            "bearing_pitch_n_m",
            "N m",
            "moment of the air film about the slider's centre in the sense of the pitch",
            &columns.bearing_pitch_n_m,
        ),
        column(
            "bearing_roll_n_m",
            "N m",
            "moment of the air film about the slider's centre in the sense of the roll",
            &columns.bearing_roll_n_m,
        ),
        column(
            "dimple_force_n",
            "N",
            "contact force in the dimple; 0 while it is open",
            &columns.dimple_force_n,
        ),
    ];
    // Only of drives that have them.
    let optional = [
        column(
            "limiter_force_n",
            "N",
            "contact force of the limiters together; 0 while they are open",
            &columns.limiter_force_n,
        ),
        column(
            "lift_tab_force_n",
            "N",
            "contact force of the lift tab on its stop; 0 while it is free",
            &columns.lift_tab_force_n,
        ),
        column(
            "asperity_force_n",
            "N",
            "normal force of the disk's asperities on the slider",
            &columns.asperity_force_n,
        ),
    ];
    list.extend(
        optional
            .into_iter()
            .filter(|column| !column.values.is_empty()),
    );
    list
}

/// Every root column: the structure's, then the head's interpolated onto the structure's time.
pub fn root_columns(history: &History, start_s: f64) -> Vec<Column> {
    let mut columns = structure_columns(&history.structure, start_s);
    if !history.head.time_s.is_empty() {
        let to = columns[0].values.clone();
        let head = head_columns(&history.head, start_s);
        let (time, rest) = head.split_first().expect("time is the first head column");
        columns.extend(rest.iter().map(|column| Column {
            values: resampled(&time.values, &column.values, &to),
            ..column.clone()
        }));
    }
    columns
}

fn shifted(time_s: &[f64], start_s: f64) -> Vec<f64> {
    time_s.iter().map(|t| t + start_s).collect()
}

/// Linear interpolation of `(from, values)` at the rising times `to`; NaN outside `from`.
pub(super) fn resampled(from: &[f64], values: &[f64], to: &[f64]) -> Vec<f64> {
    assert_eq!(from.len(), values.len());
    let mut right = 0;
    to.iter()
        .map(|&t| {
            while right < from.len() && from[right] < t {
                right += 1;
            }
            match (right, from.get(right)) {
                (_, None) => f64::NAN,
                (_, Some(&at)) if at == t => values[right],
                (0, _) => f64::NAN,
                (_, Some(&at)) => {
                    let before = from[right - 1];
                    let share = (t - before) / (at - before);
                    values[right - 1] + share * (values[right] - values[right - 1])
                }
            }
        })
        .collect()
}
