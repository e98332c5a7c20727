//! Sweeps of drives with more bodies than disk, ramp and head: a hub on its bearing, oblique shocks.

use std::fs::{OpenOptions, remove_file};
use std::path::Path;

use super::cli::{Done, study};
use opshock_study::study::{SetArg, Study};
use opshock_tests::hdf5_dump::dump;
use serde_json::Value;

/// One width, one sign, a rigid ramp, the first 0.8 ms: a point takes seven runs.
const SMALL: [&str; 10] = [
    "pulse.widths_ms=[0.5]",
    "pulse.signs=[\"+\"]",
    "ramp.models=[\"rigid\"]",
    "pulse.window_ms=0.8",
    "search.tolerance_pct=5",
    "search.monotonicity_scan=off",
    "search.uncertainty=false",
    "resolution.film_cells=200",
    "resolution.disk_cut_khz=10",
    "resolution.preset=coarse",
];

/// 15 g on a bearing of 300 N m/rad; the axial stiffness is up to the test.
const HUB: [&str; 6] = [
    "hub.mass_mg=15000",
    "hub.transverse_inertia_mg_mm2=4e5",
    "hub.polar_inertia_mg_mm2=6e5",
    "hub.axial_damping_n_s_per_m=50",
    "hub.tilt_damping_n_m_s_per_rad=2e-3",
    "hub.centre_height_mm=1.5",
];

fn program(folder: &Path, command: &[&str], set: &[String]) -> Done {
    let path = study("fig13");
    let mut words = command.to_vec();
    words.insert(1, path.to_str().expect("UTF-8"));
    words.extend(["--accept", "W201"]);
    let key = |value: &str| value.split('=').next().map(str::to_owned);
    let is_left = |small: &&str| set.iter().all(|value| key(value) != key(small));
    let small = SMALL.into_iter().filter(is_left);
    for value in small.chain(set.iter().map(String::as_str)) {
        words.extend(["--set", value]);
    }
    Done::of(folder, &words)
}

fn settings<const N: usize>(more: [&str; N]) -> Vec<String> {
    HUB.into_iter().chain(more).map(String::from).collect()
}

/// Sweeps to the end; the points of its table.
pub fn sweep(folder: &Path, set: &[String]) -> Vec<Value> {
    let command = ["sweep", "--store", "s.opshock", "--quiet", "--json"];
    let swept = program(folder, &command, set);
    assert_eq!(swept.code, 0, "{}", swept.stderr);
    swept.json()["points"].as_array().expect("points").clone()
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().expect("a number")
}

/// The limit of a bearing that does not yield is the clamped disk: the same bracket on the amplitude grid, and the
/// first touch to what 1e18 N/m leaves of it.
#[test]
fn a_sweep_over_bearings_ends_at_the_clamped_critical_shock() {
    let folder = tempfile::tempdir().expect("folder");
    let [clamped, hub] = ["clamped", "hub"].map(|name| folder.path().join(name));
    for place in [&clamped, &hub] {
        std::fs::create_dir(place).expect("folder");
    }
    let clamped = &sweep(&clamped, &[])[0];
    let set = settings([
        "hub.axial_stiffness_n_per_m=[8e6, 1e18]",
        "hub.tilt_stiffness_n_m_per_rad=3e12",
    ]);
    let points = sweep(&hub, &set);
    assert_eq!(points.len(), 2);
    assert_eq!(number(&points[0], "axial_stiffness_n_per_m"), 8e6);
    for key in ["survived_g", "failed_g"] {
        assert_eq!(points[1][key], clamped[key]);
        // 15 g and the disk on 8 N/um resonate at 3.2 kHz, which adds to the disk's motion.
        assert!(number(&points[0], key) < number(clamped, key));
    }
    let touches = [&points[1], clamped].map(|point| number(point, "onset_g"));
    assert!((touches[0] / touches[1] - 1.0).abs() < 1e-9, "{touches:?}");

    // The last third of the journal and the checkpoint lost: the sweep makes up for them.
    let store = hub.join("s.opshock");
    let checkpoint = store.join("results.h5");
    let before = dump(&checkpoint, &["/machine"]);
    let journal = store.join("journal");
    let file = OpenOptions::new().write(true).open(&journal);
    let file = file.expect("opens");
    let length = file.metadata().expect("metadata").len();
    file.set_len(length * 2 / 3).expect("cuts");
    remove_file(&checkpoint).expect("removes");
    assert_eq!(sweep(&hub, &set), points);
    assert_eq!(dump(&checkpoint, &["/machine"]), before);
}

/// The disk is a body of revolution: turning the shock, the ramp and the slider together turns the answer.
#[test]
fn an_oblique_sweep_does_not_care_where_angle_0_is() {
    let (in_plane, rotation) = ([0.5, 0.2], [10.0, -4.0]);
    let tables = [0.0_f64, 37.0, 90.0].map(|angle_deg| {
        let folder = tempfile::tempdir().expect("folder");
        let (sine, cosine) = angle_deg.to_radians().sin_cos();
        let turned = |[x, y]: [f64; 2]| [x * cosine - y * sine, x * sine + y * cosine];
        let (plane, turn) = (turned(in_plane), turned(rotation));
        let mut set = settings([
            "hub.axial_stiffness_n_per_m=8e6",
            "hub.tilt_stiffness_n_m_per_rad=300",
        ]);
        set.extend([
            format!("pulse.in_plane_x={}", plane[0]),
            format!("pulse.in_plane_y={}", plane[1]),
            format!("pulse.rotation_x_per_m={}", turn[0]),
            format!("pulse.rotation_y_per_m={}", turn[1]),
            format!("ramp.angle_deg={angle_deg}"),
            format!("slider.angle_deg={}", 7.0 + angle_deg),
        ]);
        sweep(folder.path(), &set).remove(0)
    });
    for table in &tables[1..] {
        for key in ["survived_g", "failed_g", "runs"] {
            assert_eq!(table[key], tables[0][key]);
        }
        let share = number(table, "onset_g") / number(&tables[0], "onset_g");
        assert!((share - 1.0).abs() < 1e-9, "{share}");
    }
}

/// Two heads of a drive: another load, and another disk in a narrower gap.
const HEADS: &str = r#"heads=[
    { head = "0 up", suspension = { gram_load_gf = 1.0 } },
    { head = "1 up", slider.surface.crown_nm = 18.0, disk.thickness_mm = 0.8, ramp.clearance_um = 80.0 },
]"#;

/// A head's row is that of a study with its values: the rest is the drive's.
#[test]
fn a_row_of_a_head_is_that_of_a_study_of_this_head_alone() {
    let swept = |set: &[&str]| {
        let folder = tempfile::tempdir().expect("folder");
        let set: Vec<String> = set.iter().map(|value| (*value).to_owned()).collect();
        sweep(folder.path(), &set)
    };
    let both = swept(&[HEADS]);
    let names: Vec<&Value> = both.iter().map(|point| &point["head"]).collect();
    assert_eq!(names, ["0 up", "1 up"]);
    let alone = [
        &["suspension.gram_load_gf=1.0"][..],
        &[
            "slider.surface.crown_nm=18.0",
            "disk.thickness_mm=0.8",
            "ramp.clearance_um=80.0",
        ],
    ];
    for (row, set) in both.iter().zip(alone) {
        let alone = &swept(set)[0];
        for key in ["survived_g", "failed_g", "onset_g", "runs", "status"] {
            assert_eq!(row[key], alone[key], "{key}");
        }
    }
    assert_ne!(both[0]["onset_g"], both[1]["onset_g"]);
    assert_eq!(swept(&[HEADS, "head=1 up"]), both[1..]);
}

/// The heads survive being written out with every default, and a single shock names one.
#[test]
fn a_shock_names_its_head_and_the_resolved_study_keeps_them() {
    let sets: Vec<SetArg> = [HEADS]
        .iter()
        .map(|text| SetArg::parse(text).expect("a setting"))
        .collect();
    let read = Study::from_path(&study("fig13"), &sets).expect("a study");
    let again = Study::from_text(&read.resolved_toml(), &[]).expect("a study");
    assert_eq!(again.digest, read.digest);
    assert_eq!(again.points.len(), 72);
    let ids = |study: &Study| {
        study
            .points
            .iter()
            .map(|point| point.id)
            .collect::<Vec<_>>()
    };
    assert_eq!(ids(&again), ids(&read));

    let folder = tempfile::tempdir().expect("folder");
    let shock = ["run", "--json", "--amplitude-g", "100"];
    let open = program(folder.path(), &shock, &[HEADS.to_owned()]);
    assert_eq!(open.code, 2, "{}", open.stderr);
    assert!(
        open.stderr.contains("0 up") && open.stderr.contains("head=VALUE"),
        "{}",
        open.stderr
    );
    let chosen = [HEADS.to_owned(), "head=0 up".to_owned()];
    let chosen = program(folder.path(), &shock, &chosen);
    assert_eq!(chosen.json()["verdict"], "survives");
}

/// Rows of `explain`, and the hub's columns of a history: its largest travel and tilt are those reported.
#[test]
fn hub_and_direction_are_explained_and_the_hub_is_in_the_history() {
    let folder = tempfile::tempdir().expect("folder");
    let set = settings([
        "hub.axial_stiffness_n_per_m=8e6",
        "hub.tilt_stiffness_n_m_per_rad=300",
        "pulse.in_plane_x=0.5",
    ]);
    let explained = program(folder.path(), &["explain", "--json"], &set).json();
    let effects = explained["scenes"][0]["effects"].as_array().expect("rows");
    for effect in ["disk.hub", "shock.oblique"] {
        let row = effects.iter().find(|row| row["effect"] == effect);
        assert_eq!(row.expect(effect)["state"], "on");
    }
    let shock = ["run", "--json", "--amplitude-g", "300", "--history"];
    let reported = program(folder.path(), &[&shock[..], &["run.csv"]].concat(), &set).json();
    let text = std::fs::read_to_string(folder.path().join("run.csv")).expect("a table");
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = rows.next().expect("names");
    let at = |name: &str| names.iter().position(|n| *n == name).expect(name);
    let hub =
        ["axial_m", "tilt_ramp_rad", "tilt_across_rad"].map(|name| at(&format!("hub_{name}")));
    let (mut travel, mut tilt) = (0.0_f64, 0.0_f64);
    for row in rows {
        let [u, x, y] = hub.map(|k| row[k].parse::<f64>().expect("a number"));
        (travel, tilt) = (travel.max(u.abs()), tilt.max(x.hypot(y)));
    }
    assert!(travel > 1e-6 && tilt > 1e-6, "{travel:e} {tilt:e}");
    // But for the last digit, which reading JSON may lose.
    for (key, wanted) in [("axial_max_m", travel), ("tilt_max_rad", tilt)] {
        let share = number(&reported["hub"], key) / wanted;
        assert!((share - 1.0).abs() < 1e-15, "{key}: {share}");
    }
}
