//! Files of the CMLAir family become studies that fly and are shaken: surface, flights, a dynamic run and the
//! matrices beside it.

use crate::cli::{COARSE, Done};
use crate::imports::{cmlair, dynamic, folder, run};
use opshock_import::cml::rail::{self, Rail, RailFile, Recess};
use opshock_solver::air_bearing::{GapForce, SurfaceForces};
use opshock_solver::disk::DiskDamping;
use opshock_solver::slider::RailOutline;
use opshock_study::study::Study;
use opshock_tests::heads::default_slider;
use std::f64::consts::TAU;
use std::path::Path;

fn steady(at: &Path, study: &str) -> serde_json::Value {
    let set = "resolution.film_cells=800";
    let done = Done::of(
        at,
        &["steady", study, "--set", set, "--json", "--accept", "W201"],
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.json()
}

#[test]
fn a_cmlair_surface_flies() {
    let at = tempfile::tempdir().unwrap();
    let done = run(at.path(), &cmlair(None));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let checked = Done::of(at.path(), &["check", "out/study.toml", "--json"]);
    assert_eq!(checked.code, 0, "{}", checked.stderr);
    let flight = steady(at.path(), "out/study.toml");
    let clearance = flight["min_clearance_m"].as_f64().unwrap();
    let force = flight["lift_n"].as_f64().unwrap() + flight["suction_n"].as_f64().unwrap();
    assert!((1e-9..1e-6).contains(&clearance), "{flight}");
    // run.dat says 2.5e-3 kg.
    assert!((force / (2.5e-3 * 9.80665) - 1.0).abs() < 1e-6, "{flight}");
}

/// The numbers printed in the CMLAir 8.01 manual for a 2.5-inch drive, written as its file, are those of the
/// study, which flies and is shaken.
#[test]
fn a_dynamic_run_becomes_a_study_that_runs() {
    let at = tempfile::tempdir().unwrap();
    let done = run(at.path(), &dynamic(None));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let notes = done.json()["notes"].to_string();
    for assumed in [
        "f0 = 0.0025 kg",
        "read in the order start, width, magnitude, time constant",
        "read as the three values before E",
        "the last two values of the section",
        "read as the arm from the pivot to the slider",
        "dt, tf = 1e-7 s, 0.003 s",
        "sections = 12",
    ] {
        assert!(notes.contains(assumed), "{assumed}\n{notes}");
    }
    let path = at.path().join("out/study.toml");
    let study = Study::from_path(&path, &[]).unwrap();
    // Two ramp models, both signs.
    assert_eq!(study.points.len(), 4);
    let scene = &study.points[0].scene;
    let (disk, slider) = (&scene.disk, &scene.slider);
    let DiskDamping::Rayleigh {
        alpha_per_s,
        beta_s,
    } = disk.damping
    else {
        panic!("{disk:?}");
    };
    for (what, found, wanted) in [
        ("clamp", disk.inner_radius_m, 10.01e-3),
        ("rim", disk.outer_radius_m, 32.5e-3),
        ("thickness", disk.thickness_m, 0.635e-3),
        ("modulus", disk.youngs_modulus_pa, 75e9),
        ("poisson", disk.poisson, 0.30),
        ("density", disk.density_kg_per_m3, 2710.0),
        ("speed", disk.spin_rad_per_s, 5400.0 * TAU / 60.0),
        ("alpha", alpha_per_s, 25.0),
        ("beta", beta_s, 1e-7),
        ("top gap", scene.ramp.clearance_top_m, 100e-6),
        ("bottom gap", scene.ramp.clearance_bottom_m, 100e-6),
        ("length", slider.length_m, 1.25e-3),
        ("width", slider.width_m, 1.0e-3),
        ("radius", slider.radius_m, 22.215e-3),
        ("skew", slider.skew_rad, 0.943_f64.to_radians()),
        ("load", scene.suspension.gram_load_n, 2.5e-3 * 9.80665),
        ("pressure", scene.gas.pressure_pa, 101_350.0),
        ("pulse", scene.pulse.width_s, 1e-3),
        ("onset", study.start_s, 0.5e-3),
    ] {
        assert!(
            (found / wanted - 1.0).abs() < 1e-12,
            "{what}: {found} {wanted}"
        );
    }
    // 35.6 mm from the pivot at 15.91 degrees of an arm of 38 mm.
    assert!(
        (scene.ramp.radius_m - 32.15e-3).abs() < 5e-6,
        "{:?}",
        scene.ramp
    );
    let flight = steady(at.path(), "out/study.toml");
    let force = flight["force_n"].as_f64().unwrap();
    assert!((force / (2.5e-3 * 9.80665) - 1.0).abs() < 1e-6, "{flight}");
    let shock = [
        "run",
        "out/study.toml",
        "--ramp",
        "rigid",
        "--sign",
        "+",
        "--amplitude-g",
        "200",
        "--json",
    ];
    let shaken = Done::of(at.path(), &[&shock[..], &COARSE].concat());
    assert_eq!(shaken.code, 0, "{}", shaken.stderr);
    let disk = shaken.json()["disk"]["ramp_max_m"].as_f64().unwrap();
    assert!((1e-5..1e-3).contains(&disk), "{}", shaken.stdout);
}

/// The matrices of a suspension beside the file become the study's, their node by the slider's first freedom;
/// damaged ones, and numbers of the file that are not theirs, are refused and nothing is written.
#[test]
fn a_dynamic_run_takes_the_matrices_beside_it() {
    let at = tempfile::tempdir().unwrap();
    let at = at.path();
    let export = [
        "export",
        "geometry.toml",
        "--format",
        "suspension",
        "--out",
        "susp",
    ];
    let geometry = "study_format = 2\nname = \"suspension\"\n[pulse]\nwidths_ms = [0.5]\n\
         [ramp]\nmodels = [\"none\"]\n";
    std::fs::write(at.join("geometry.toml"), geometry).unwrap();
    assert_eq!(Done::of(at, &export).code, 0);
    let read = |name: &str| std::fs::read_to_string(at.join("susp").join(name)).unwrap();
    // A suspension's file has no rows of the base: three of the root's node are left out.
    let held = |name: &str, columns: usize| {
        let text = read(name);
        let rows = text.lines().skip(3).map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            words[columns..].join(" ") + "\n"
        });
        rows.collect::<String>()
    };
    let places = held("susp_cords.dat", 0);
    let section = read("suspension.toml");
    let dimple = section
        .lines()
        .find(|line| line.starts_with("dimple"))
        .unwrap();
    let dimple: usize = dimple.rsplit(' ').next().unwrap().parse().unwrap();
    let n_rows = places.lines().count();
    // Without the root's node the dimple is one node earlier, of three rows each.
    let row = 3 * (dimple - 2) + 1;
    let beside = at.join("beside");
    std::fs::create_dir(&beside).unwrap();
    let put = |name: &str, text: &str| std::fs::write(beside.join(name), text).unwrap();
    put("susp_M.dat", &held("susp_M.dat", 3));
    put("susp_K.dat", &held("susp_K.dat", 3));
    put("susp_cords.dat", &places);
    let sound = std::fs::read_to_string(folder("dynluls").join("sound.DynLULS.def")).unwrap();
    let reported = |size: usize, row: usize| {
        let numbers = format!("size  dtfac\n{size}  0.1\n");
        let freedoms = format!("slider_z  slider_p  slider_r  tab_z\n{row}  0  0  0\n");
        let text = sound.replace("size  dtfac\n250  0.1\n", &numbers);
        let old = "slider_z  slider_p  slider_r  tab_z\n241  242  243  250\n";
        assert!(text.contains(old) && text.contains(&numbers));
        put("DynLULS.def", &text.replace(old, &freedoms));
    };
    let import = |out: &str, more: &[&str]| {
        let mut words = dynamic(Some(&beside.join("DynLULS.def")));
        *words.last_mut().unwrap() = out.to_owned();
        words.extend(more.iter().map(|word| (*word).to_owned()));
        run(at, &words)
    };
    let refused = |code: &str| {
        let done = import("refused", &[]);
        assert_eq!(done.code, 3, "{}", done.stdout);
        assert_eq!(done.errors()[0]["code"], code, "{}", done.stderr);
        assert!(!at.join("refused").exists());
    };
    reported(250, row);
    refused("E161");
    reported(n_rows, 0);
    refused("E169");
    reported(n_rows, row);
    let done = import("out", &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.json()["notes"]
            .to_string()
            .contains("its node is the dimple")
    );
    let modes = |study: &str| {
        let set = "resolution.film_cells=300";
        let done = Done::of(at, &["modes", study, "--set", set, "--json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.json()["suspension"].clone()
    };
    let (a, b) = (modes("geometry.toml"), modes("out/study.toml"));
    for key in [
        "/dimple_stiffness_n_per_m",
        "/roll_stiffness_n_m_per_rad",
        "/bending_pinned_hz/0",
        "/torsion_pinned_hz/0",
    ] {
        let of = |modes: &serde_json::Value| modes.pointer(key).unwrap().as_f64().unwrap();
        assert!((of(&a) / of(&b) - 1.0).abs() < 1e-6, "{key}: {a} {b}");
    }
    // Asked for, they stay where they are.
    let done = import("plain", &["--without-matrices"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(!at.join("plain/susp_M.dat").exists());
    put("susp_K.dat", &held("susp_K.dat", 3).replacen(' ', " x", 1));
    refused("E171");
    std::fs::remove_file(beside.join("susp_K.dat")).unwrap();
    refused("E160");
}

/// What `run.dat` says of forces beside the air is in the scene, and pulls the slider down.
#[test]
fn a_cmlair_run_brings_its_surface_forces() {
    let at = tempfile::tempdir().unwrap();
    let plain = std::fs::read(folder("cmlair").join("sound.run.dat")).unwrap();
    // Latin-1, as the file is.
    let plain: String = plain.into_iter().map(char::from).collect();
    let none = "icmodel stdasp dnsasp A B\n0 0 0 0 0\n";
    assert!(plain.contains(none));
    let some = "icmodel stdasp dnsasp A B\n0 0 0 1.8e-19 1.0e-76\n\
                rdsasp eyoung yldstr elecpot\n0 0 0 0.5\n";
    let flight = |out: &str, text: &str| {
        let file = at.path().join(format!("{out}.run.dat"));
        std::fs::write(&file, text).unwrap();
        let mut words = cmlair(Some(&file));
        *words.last_mut().unwrap() = out.to_owned();
        let done = run(at.path(), &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let study = format!("{out}/study.toml");
        let scene = Study::from_path(&at.path().join(&study), &[])
            .unwrap()
            .points[0]
            .scene
            .clone();
        (scene.gap_forces.surface_forces, steady(at.path(), &study))
    };
    let (absent, free) = flight("none", &plain);
    let (present, pulled) = flight("some", &plain.replace(none, some));
    assert!(!absent.is_active() && present.is_active());
    assert_eq!(
        present,
        SurfaceForces {
            hamaker_j: 1.8e-19,
            repulsion_j_m6: 1.0e-76,
            potential_v: 0.5,
        }
    );
    let height = |flight: &serde_json::Value| flight["min_clearance_m"].as_f64().unwrap();
    assert!(height(&pulled) < height(&free), "{pulled} {free}");
    assert!(pulled["surface_forces"]["force_n"].as_f64().unwrap() < 0.0);
}

/// The default surface, written as rail.dat and imported, flies as the default surface does.
#[test]
fn a_surface_that_went_through_rail_dat_flies_as_before() {
    let slider = default_slider();
    let surface = &slider.surface;
    let rails = surface.rails.iter().map(|rail| {
        let corners_m = match &rail.outline {
            RailOutline::Rectangle {
                x_m: [a, b],
                y_m: [c, d],
            } => {
                vec![[*a, *c], [*b, *c], [*b, *d], [*a, *d]]
            }
            RailOutline::Polygon { points_m } => points_m.clone(),
        };
        Rail {
            walls: vec![0; corners_m.len()],
            corners_m,
            recess: Recess::Step(rail.recess_m),
            line: 0,
        }
    });
    let text = rail::write(&RailFile {
        version: "8.0".to_owned(),
        length_m: slider.length_m,
        width_m: slider.width_m,
        thickness_m: slider.height_m,
        rails: rails.collect(),
        walls: Vec::new(),
        taper_length_m: surface.taper_length_m,
        taper_angle_rad: surface.taper_angle_rad,
        base_recess_m: surface.base_recess_m,
        crown_m: surface.crown_m,
        camber_m: surface.camber_m,
        twist_m: surface.twist_m,
        points_m: Vec::new(),
    });
    let at = tempfile::tempdir().unwrap();
    std::fs::write(at.path().join("rail.dat"), text).unwrap();
    let imported = Done::of(at.path(), &["import", "cmlair", "rail.dat", "--out", "out"]);
    assert_eq!(imported.code, 0, "{}", imported.stderr);
    let original = std::fs::read_to_string(at.path().join("out/study.toml")).unwrap();
    let named = "surface = { file = \"surface.toml\" }";
    assert!(original.contains(named), "{original}");
    let preset = original.replace(named, "surface = { preset = \"femto-2.5in\" }");
    std::fs::write(at.path().join("out/preset.toml"), preset).unwrap();
    let (a, b) = (
        steady(at.path(), "out/study.toml"),
        steady(at.path(), "out/preset.toml"),
    );
    for key in ["min_clearance_m", "pitch_rad", "lift_n", "p_max_pa"] {
        let (a, b) = (a[key].as_f64().unwrap(), b[key].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 1e-6, "{key}: {a} {b}");
    }
}
