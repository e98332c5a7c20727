//! Dynamic decks of version 6.4 of the CMLAir family (`tests/reference/cml_decks/`): each becomes a study by one command.

use crate::cli::{Done, files};
use opshock_study::study::Study;
use std::path::{Path, PathBuf};

pub fn decks() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/cml_decks")
}

/// Imports a deck of `folder` into `out`.
pub fn import(at: &Path, folder: &Path, deck: &str, more: &[&str]) -> Done {
    let [rail, deck] =
        ["rail_own_rectangular_abs.dat", deck].map(|name| folder.join(name).display().to_string());
    let words = [
        "import",
        "cmlair",
        &rail,
        "--dynamic",
        &deck,
        "--out",
        "out",
        "--json",
    ];
    Done::of(at, &[&words[..], more].concat())
}

#[test]
fn a_deck_becomes_a_study_and_says_what_became_what() {
    let at = tempfile::tempdir().unwrap();
    let done = import(at.path(), &decks(), "dynluls_shock_400G_2ms_rigid.def", &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let map = done.json()["map"].to_string();
    assert!(map.contains(r#"["f0","suspension.gram_load_gf"]"#), "{map}");
    let notes = done.json()["notes"].to_string();
    for note in [
        "xl = 0.0008435 m",
        "opshock run --sign + --amplitude-g 400",
        "dimple = rigid",
        "not read: grid",
    ] {
        assert!(notes.contains(note), "{note}\n{notes}");
    }
    // The suspension alone: the flexure's spring is off the load beam's diagonal.
    let of = |path: PathBuf| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(path).unwrap();
        let rows = text.lines().map(|line| line.split_whitespace());
        rows.map(|row| row.map(|word| word.parse().unwrap()).collect())
            .collect()
    };
    let whole = of(decks().join("susp_K.dat"));
    let alone = of(at.path().join("out/susp_K.dat"));
    assert_eq!((whole.len(), alone.len()), (36, 30));
    assert!(
        (whole[24][24] - 15.0 - alone[24][24]).abs() < 1e-9,
        "{}",
        alone[24][24]
    );
    let study = Study::from_path(&at.path().join("out/study.toml"), &[]).unwrap();
    // Two ramp models, both signs.
    assert_eq!(study.points.len(), 4);
    let scene = &study.points[0].scene;
    let suspension = &scene.suspension;
    let rayleigh = suspension.rayleigh.unwrap();
    let slider = &scene.slider;
    let slider_kg = slider.density_kg_per_m3 * slider.length_m * slider.width_m * slider.height_m;
    for (what, found, wanted) in [
        ("load", suspension.gram_load_n, 2.5e-3 * 9.80665),
        ("preload", suspension.gimbal.dimple_preload_n, 1e-3),
        ("dimple", suspension.dimple.stiffness_n_per_m, 1e8),
        ("flexure", suspension.gimbal.vertical_n_per_m, 15.0),
        ("its pitch", suspension.gimbal.pitch_n_m_per_rad, 1.745e-5),
        ("its roll", suspension.gimbal.roll_n_m_per_rad, 1.745e-5),
        ("slider", slider_kg, 5.7718e-7),
        ("alpha", rayleigh.alpha_per_s, 25.0),
        ("beta", rayleigh.beta_s, 1e-7),
        ("limiter", suspension.limiters[0].gap_m, 92.4e-6),
        ("outer limiter", suspension.limiters[1].gap_m, 92.5e-6),
        ("ramp", scene.ramp.radius_m, 32.151e-3),
        ("clearance", scene.ramp.clearance_top_m, 100e-6),
        ("skew", slider.skew_rad, 0.943_f64.to_radians()),
        ("pressure", scene.gas.pressure_pa, 101_350.0),
        ("pulse", scene.pulse.width_s, 2e-3),
    ] {
        assert!(
            (found / wanted - 1.0).abs() < 1e-4,
            "{what}: {found} {wanted}"
        );
    }
}

#[test]
fn a_deck_without_ramp_becomes_a_study_that_runs() {
    let at = tempfile::tempdir().unwrap();
    let deck = "dynluls_shock_200G_0p5ms_no_ramp.def";
    let done = import(at.path(), &decks(), deck, &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let study = Study::from_path(&at.path().join("out/study.toml"), &[]).unwrap();
    assert_eq!(study.points.len(), 2);
    assert!((study.points[0].scene.pulse.width_s - 5e-4).abs() < 1e-12);
    let words =
        "run out/study.toml --sign + --amplitude-g 200 --set resolution.preset=coarse --json";
    let done = Done::of(at.path(), &words.split(' ').collect::<Vec<_>>());
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(done.json()["verdict"], "survives", "{}", done.stderr);
}

#[test]
fn damaged_decks_get_their_message() {
    let at = tempfile::tempdir().unwrap();
    let beside = at.path().join("beside");
    std::fs::create_dir(&beside).unwrap();
    let name = "dynluls_P400_none.def";
    for (file, old, new, code, said) in [
        (
            name,
            "1 0.0 0.0 1.0 1.0",
            "1 1.0 0.0 1.0 1.0",
            "E176",
            "not along the disk's axis",
        ),
        (
            name,
            "*****Ramp*****",
            "*****Ramps*****",
            "E173",
            "there is no section \\\"ramp\\\"",
        ),
        (
            name,
            "***end***",
            "*****More*****\nx\n1",
            "E173",
            "more sections",
        ),
        (
            name,
            "ramp_opt clr\n0",
            "ramp_opt clr\n0.5",
            "E174",
            "not a count",
        ),
        (name, "36 10 0", "3.5 10 0", "E174", "not a count"),
        (
            name,
            "x_ramp ramp_ang",
            "ramp_ang",
            "E175",
            "it lacks x_ramp",
        ),
        (
            name,
            "36 10 0",
            "35 10 0",
            "E174",
            "not a freedom of the suspension",
        ),
        (
            name,
            "25 33 1 0.0 1.0",
            "25 33 0 0.0 1.0",
            "E175",
            "a closed contact",
        ),
        (
            name,
            "25 33 1 0.0 1.0",
            "25 33 1 0.0 x",
            "E174",
            "the value is no number",
        ),
        (
            name,
            "8.500000e-04 0.8",
            "8.900000e-04 0.8",
            "E175",
            "not that of the surface",
        ),
        (
            "susp_cords.dat",
            "2.815000e+01 0.0 0.0 3\n",
            "",
            "E161",
            "another number of rows",
        ),
        (
            "susp_K.dat",
            "-1.745000000000e+01",
            "-1.6e+01",
            "E175",
            "not a spring between slider and dimple",
        ),
    ] {
        for path in files(&decks()) {
            std::fs::copy(&path, beside.join(path.file_name().unwrap())).unwrap();
        }
        let text = std::fs::read_to_string(beside.join(file)).unwrap();
        assert!(text.contains(old), "{file}: {old}");
        std::fs::write(beside.join(file), text.replace(old, new)).unwrap();
        let done = import(at.path(), &beside, name, &[]);
        assert_eq!(done.code, 3, "{old}: {}{}", done.stdout, done.stderr);
        assert!(
            done.stderr.contains(code) && done.stderr.contains(said),
            "{old}: {}",
            done.stderr
        );
        assert!(!at.path().join("out").exists());
    }
}
