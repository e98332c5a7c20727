//! Heads of one drive with surface, suspension and side of the disk of their own: each answers as it would
//! alone, and what they have in common is simulated once.

use std::path::Path;

use super::cli::{Done, study};
use super::multi_body::sweep;
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_study::search::Probe;
use opshock_study::study::{Faces, SetArg, Study, StudyErrors};
use opshock_study::sweep::{Physics, Simulator};
use opshock_tests::pairs::assert_same_answers;

const DRIVE: &str = r#"study_format = 2
name = "heads"
[pulse]
widths_ms = [0.5]
signs = ["+"]
window_ms = 0.8
[ramp]
models = ["rigid"]
[resolution]
preset = "coarse"
film_cells = 150
disk_cut_khz = 10
[slider.surface]
crown_nm = 12.0
twist_nm = 3.0
"#;

/// Surface of a file: its twist is left to the default.
const SURFACE: &str = r#"base_recess_um = 2.0
crown_nm = 9.0
[[rail]]
kind = "rect"
x_um = [20, 840]
y_um = [50, 250]
recess_um = 0.0
[[rail]]
kind = "polygon"
points_um = [[20, 450], [840, 450], [840, 650], [20, 650]]
recess_um = 0.0
"#;

/// A head and the study that has its values alone. Where a head has a surface of its own, nothing of it
/// is the drive's.
const HEADS: [(&str, &str, &str, bool); 5] = [
    ("as the drive", "", "", false),
    (
        "file",
        "slider.surface.file = \"own.toml\"\nslider.surface.camber_nm = 4.0\n",
        "[slider.surface]\nfile = \"own.toml\"\ncamber_nm = 4.0\n",
        true,
    ),
    (
        "rails",
        "slider.surface.rail = [{ kind = \"rect\", x_um = [0, 850], y_um = [0, 700], recess_um = 0 }]\n",
        "[[slider.surface.rail]]\nkind = \"rect\"\nx_um = [0, 850]\ny_um = [0, 700]\nrecess_um = 0\n",
        true,
    ),
    (
        "stiff",
        "suspension.hinge.thickness_um = 50.0\nsuspension.limiters.gap_um = 90.0\n",
        "[suspension]\nhinge.thickness_um = 50.0\nlimiters.gap_um = 90.0\n",
        false,
    ),
    ("matrices", "", "", false),
];

/// The study of all heads in a folder, with the files they name.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("own.toml"), SURFACE).unwrap();
    let default = study("drive-2.5in");
    let words = [
        "export",
        default.to_str().unwrap(),
        "--format",
        "suspension",
    ];
    let done = Done::of(at, &[&words[..], &["--out", "susp"]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let mut text = DRIVE.to_string();
    for (name, of_the_head, ..) in HEADS {
        text += &format!("[[heads]]\nhead = \"{name}\"\n{of_the_head}");
    }
    text += &own_matrices(at);
    std::fs::write(at.join("all.toml"), text).unwrap();
    folder
}

/// Section of a study that reads the matrices in a folder.
fn matrices(at: &Path) -> String {
    let section = std::fs::read_to_string(at.join("susp/suspension.toml")).unwrap();
    section.replace("\"susp_", "\"susp/susp_")
}

/// The same as keys of a head.
fn own_matrices(at: &Path) -> String {
    let section = matrices(at);
    let keys = section.lines().skip(1);
    keys.map(|line| format!("suspension.imported.{line}\n"))
        .collect()
}

fn read(at: &Path, text: &str) -> Result<Study, StudyErrors> {
    let path = at.join("study.toml");
    std::fs::write(&path, text).unwrap();
    Study::from_path(&path, &[])
}

fn scenes(study: &Study) -> Vec<Scene> {
    study
        .points
        .iter()
        .map(|point| point.scene.clone())
        .collect()
}

/// The head's scene is that of a study with its values, whatever the other heads have, and stays so when the
/// study is written out without its files.
#[test]
fn a_head_with_surface_or_suspension_of_its_own_is_that_head_alone() {
    let folder = folder();
    let at = folder.path();
    let all = Study::from_path(&at.join("all.toml"), &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(all.points.len(), HEADS.len());
    for ((name, _, of_the_study, own_surface), point) in HEADS.into_iter().zip(&all.points) {
        let drive = match own_surface {
            true => DRIVE.split("[slider.surface]").next().unwrap(),
            false => DRIVE,
        };
        let of_the_study = match name {
            "matrices" => matrices(at),
            _ => of_the_study.to_string(),
        };
        let alone = read(at, &format!("{drive}{of_the_study}"));
        let alone = alone.unwrap_or_else(|errors| panic!("{name}: {errors}"));
        assert_eq!(scenes(&alone), std::slice::from_ref(&point.scene), "{name}");
        assert_eq!(alone.points[0].id, point.id, "{name}");
        let set = SetArg::parse(&format!("head={name}")).unwrap();
        let chosen = Study::from_path(&at.join("all.toml"), &[set]).unwrap();
        assert_eq!(
            scenes(&chosen),
            std::slice::from_ref(&point.scene),
            "{name}"
        );
    }
    let [drive, file, rails, stiff, matrices] = &scenes(&all)[..] else {
        panic!("five heads")
    };
    assert_eq!(drive.slider.surface.twist_m, 3e-9);
    assert_eq!(
        (file.slider.surface.twist_m, file.slider.surface.crown_m),
        (0.0, 9e-9)
    );
    assert_eq!(
        [file, rails].map(|scene| scene.slider.surface.rails.len()),
        [2, 1]
    );
    assert_eq!(stiff.suspension.limiters.len(), 2);
    assert!(matrices.suspension.modes.len() > 10 && drive.suspension.modes.is_empty());

    let again = read(at, &all.resolved_toml()).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(scenes(&again), scenes(&all));
    assert_eq!(again.digest, all.digest);
}

/// Four heads over one disk and one under it: one structure, and one structural run of each amplitude. The bits
/// are those of every head alone, and of runs that share nothing.
#[test]
fn heads_of_one_drive_share_one_structural_history() {
    let folder = folder();
    let at = folder.path();
    let text = std::fs::read_to_string(at.join("all.toml")).unwrap();
    let under =
        "[[heads]]\nhead = \"under\"\nslider.faces = \"up\"\nsuspension.gram_load_gf = 2.0\n";
    let all = read(
        at,
        &format!("{text}{under}").replace("[\"+\"]", "[\"+\", \"-\"]"),
    );
    let all = all.unwrap_or_else(|errors| panic!("{errors}"));
    let n = all.points.len();
    assert_eq!(n, 2 * (HEADS.len() + 1));
    let amplitudes = [150.0, 300.0].map(m_per_s2_from_g);
    let ask = |study: &Study| {
        let physics = Physics::of(study);
        let order = study.table_order();
        let signs = order.iter().map(|place| study.points[*place].sign.factor());
        let signs: Vec<f64> = signs.collect();
        let answer = |a: f64| {
            let one =
                |(point, sign): (usize, &f64)| physics.simulate(point, Probe::at(0), sign * a);
            signs.iter().enumerate().map(one).collect::<Vec<_>>()
        };
        let answers = amplitudes.map(answer);
        (
            answers,
            physics.structural_runs(),
            physics.structures_built(),
        )
    };
    let (shared, runs, structures) = ask(&all);
    assert_eq!(structures, 1);
    // A run for each sign and amplitude: the head under the disk takes that of the other sign.
    assert_eq!(runs.asked, 2 * n as u64);
    assert_eq!(runs.asked - runs.shared, 4);

    for (number, (name, ..)) in HEADS
        .into_iter()
        .chain([("under", "", "", false)])
        .enumerate()
    {
        let set = SetArg::parse(&format!("head={name}")).unwrap();
        let alone = Study::from_path(&at.join("study.toml"), &[set]).unwrap();
        let (answers, runs, structures) = ask(&alone);
        assert_eq!((runs.asked, structures), (0, 1), "{name}");
        for (shared, alone) in shared.iter().zip(&answers) {
            assert_eq!(shared[2 * number..2 * number + 2], alone[..], "{name}");
        }
    }
    let full = SetArg::parse("solver.effects=full").unwrap();
    let full = Study::from_path(&at.join("study.toml"), &[full]).unwrap();
    let (answers, _, structures) = ask(&full);
    for (shared, alone) in shared.iter().zip(&answers) {
        assert_same_answers(shared, alone);
    }
    assert_eq!(structures, 2 * n as u64);
    // The heads are five different ones.
    let mut heights: Vec<_> = shared[0].iter().map(|one| one.h_min_m).collect();
    heights.sort_by(|a, b| a.partial_cmp(b).unwrap());
    heights.dedup();
    assert_eq!(heights.len(), n);
}

/// A head under the disk meets the ramp's bottom arm and the shock with the other sign: where the drive is its own
/// mirror image, its rows are those of the head over the disk for the other sign.
#[test]
fn a_head_that_faces_up_is_the_one_that_faces_down_under_the_other_sign() {
    let swept = |heads: &str| {
        let folder = tempfile::tempdir().unwrap();
        let set = ["pulse.signs=[\"+\", \"-\"]", heads].map(str::to_owned);
        sweep(folder.path(), &set)
    };
    let both = swept(
        r#"heads=[
        { head = "0", ramp.clearance_top_um = 80.0, ramp.clearance_bottom_um = 120.0 },
        { head = "1", ramp.clearance_top_um = 120.0, ramp.clearance_bottom_um = 80.0, slider.faces = "up" },
    ]"#,
    );
    let signs: Vec<_> = both
        .iter()
        .map(|row| row["sign"].as_str().unwrap())
        .collect();
    assert_eq!(signs, ["+", "-", "+", "-"]);
    for (over, under) in [(0, 3), (1, 2)] {
        for key in ["survived_g", "failed_g", "onset_g", "status"] {
            assert_eq!(both[over][key], both[under][key], "{key}");
        }
    }
    for key in ["survived_g", "onset_g"] {
        assert_ne!(both[0][key], both[1][key], "{key}");
    }
}

/// One shock names the drive's sign; the axis of the way it faces makes rows of its own.
#[test]
fn the_way_a_head_faces_is_a_key_of_the_study_too() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let faces = |word: &str| read(at, &format!("{DRIVE}[slider]\nfaces = {word}\n")).unwrap();
    let (down, up, both) = (
        faces("\"down\""),
        faces("\"up\""),
        faces("[\"up\", \"down\"]"),
    );
    assert_eq!(scenes(&down), scenes(&read(at, DRIVE).unwrap()));
    assert_eq!(
        [&down, &up].map(|s| s.points[0].faces),
        [Faces::Down, Faces::Up]
    );
    // Equal gaps: the scene is its own mirror image, the shock is not.
    assert_eq!(scenes(&down), scenes(&up));
    assert_eq!([&down, &up].map(|s| s.points[0].factor()), [1.0, -1.0]);
    assert_ne!(down.points[0].id, up.points[0].id);
    assert_eq!(both.points.len(), 2);
    faces("[\"up\", \"down\"]");
    let path = at.join("study.toml");
    let words = ["explain", path.to_str().unwrap(), "--json"];
    let reported = Done::of(at, &words).json();
    let state = |scene: usize| {
        let rows = reported["scenes"][scene]["effects"].as_array().unwrap();
        let row = rows.iter().find(|row| row["effect"] == "head.faces_up");
        row.unwrap()["state"].clone()
    };
    assert_eq!([state(0), state(1)], ["on", "off"]);
}

/// Faults of a head's matrices are reported with the head and the file.
#[test]
fn damaged_matrices_of_a_head_name_it() {
    let folder = folder();
    let at = folder.path();
    let all = std::fs::read_to_string(at.join("all.toml")).unwrap();
    let refused = |code: &str, file: &str| {
        let errors = read(at, &all).unwrap_err().errors;
        assert_eq!(errors.len(), 1, "{errors:?}");
        let error = &errors[0];
        assert_eq!(error.code, code, "{error}");
        assert!(error.file.ends_with(file), "{error}");
        assert!(
            error.message.contains("heads[4].suspension.imported"),
            "{error}"
        );
    };
    let stiffness = at.join("susp/susp_K.dat");
    let text = std::fs::read_to_string(&stiffness).unwrap();
    let (first, rest) = text.split_once(' ').unwrap();
    std::fs::write(&stiffness, format!("{first}x {rest}")).unwrap();
    refused("E171", "susp_K.dat");
    std::fs::write(&stiffness, "").unwrap();
    refused("E160", "susp_K.dat");
    std::fs::remove_file(&stiffness).unwrap();
    refused("E160", "susp_K.dat");
}
