//! Other programs' files: sound ones give what they say, and every damaged one under
//! `tests/bad_inputs/imports/` gets its message. Its name tells its code, what stands behind the
//! first point which of the files of its folder it replaces.

use crate::cli::{Done, files};
use opshock_import::cml::rail::{self, Rail, RailFile, Recess};
use opshock_solver::disk::DiskDamping;
use opshock_solver::ramp::RampModel;
use opshock_solver::slider::RailOutline;
use opshock_study::study::Study;
use opshock_tests::heads::default_slider;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("bad_inputs/imports")
        .join(name)
}

/// Options for files by their endings; those of modes and a gyroscopic matrix are asked for only
/// where one of them is damaged.
const ROLES: [(&str, &str, &[&str]); 4] = [
    (
        "market",
        "si",
        &[
            "mass.mtx",
            "stiffness.mtx",
            "gyroscopic.mtx",
            "modes.mtx",
            "frequencies.txt",
        ],
    ),
    ("calculix", "mm_n", &["mas", "sti", "dof"]),
    ("dense", "mm_mn", &["M.dat", "K.dat", "cords.dat"]),
    (
        "contact",
        "si",
        &[
            "mass.mtx",
            "stiffness.mtx",
            "dof",
            "modes.mtx",
            "frequencies.txt",
        ],
    ),
];

/// What to type for the matrices of a folder, one file replaced by a damaged one.
fn matrices(importer: &str, damaged: Option<&Path>) -> Vec<String> {
    let (_, units, roles) = ROLES.iter().find(|(name, _, _)| *name == importer).unwrap();
    let options = ["--mass", "--stiffness", "--dof", "--modes", "--frequencies"];
    let ending = damaged.map_or("", |path| {
        let name = path.file_name().unwrap().to_str().unwrap();
        name.split_once('.').unwrap().1
    });
    let mut words = vec!["import".to_owned(), "matrices".to_owned()];
    words.extend(["--units".to_owned(), (*units).to_owned()]);
    for role in *roles {
        let option = match *role {
            "mass.mtx" | "mas" | "M.dat" => options[0],
            "stiffness.mtx" | "sti" | "K.dat" => options[1],
            "dof" => options[2],
            "cords.dat" => "--places",
            "gyroscopic.mtx" => "--gyroscopic",
            "modes.mtx" => options[3],
            _ => options[4],
        };
        let of_modes = ["modes.mtx", "frequencies.txt"];
        let only_when_damaged = match *role {
            "gyroscopic.mtx" => ending != "gyroscopic.mtx",
            role if of_modes.contains(&role) => importer == "market" && !of_modes.contains(&ending),
            _ => false,
        };
        if only_when_damaged {
            continue;
        }
        let file = match damaged {
            Some(path) if ending == *role => path.to_owned(),
            _ => folder(importer).join(format!("sound.{role}")),
        };
        words.extend([option.to_owned(), file.display().to_string()]);
    }
    // Its modes move this freedom alone.
    if importer == "contact" {
        words.extend(["--contact", "8.3"].map(str::to_owned));
    }
    words
}

fn cmlair(damaged: Option<&Path>) -> Vec<String> {
    let name = damaged.map_or("", |path| path.to_str().unwrap());
    let of = |ending: &str| {
        let file = folder("cmlair").join(format!("sound.{ending}"));
        if name.ends_with(ending) {
            name.to_owned()
        } else {
            file.display().to_string()
        }
    };
    let words = [
        "import",
        "cmlair",
        &of("rail.dat"),
        "--run",
        &of("run.dat"),
        "--out",
        "out",
    ];
    words.map(str::to_owned).to_vec()
}

/// What to type for a dynamic run beside the sound surface.
fn dynamic(damaged: Option<&Path>) -> Vec<String> {
    let sound = folder("dynluls").join("sound.DynLULS.def");
    let file = damaged.unwrap_or(&sound);
    let surface = folder("cmlair").join("sound.rail.dat");
    let words = [
        "import",
        "cmlair",
        surface.to_str().unwrap(),
        "--dynamic",
        file.to_str().unwrap(),
        "--out",
        "out",
    ];
    words.map(str::to_owned).to_vec()
}

fn run(at: &Path, words: &[String]) -> Done {
    let words: Vec<&str> = words.iter().map(String::as_str).chain(["--json"]).collect();
    Done::of(at, &words)
}

/// Every message of an importer's damaged files; exit code 3, the code of the name, nothing written.
fn said(importer: &str, words: impl Fn(Option<&Path>) -> Vec<String>, least: usize) -> String {
    let at = tempfile::tempdir().unwrap();
    let (mut text, mut count) = (String::new(), 0);
    for path in files(&folder(importer)) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if name.starts_with("sound") {
            continue;
        }
        let done = run(at.path(), &words(Some(&path)));
        assert_eq!(done.code, 3, "{name}: {}{}", done.stdout, done.stderr);
        assert_eq!(done.stdout, "", "{name}");
        let errors = done.errors();
        let code = name.split('_').next().unwrap().to_uppercase();
        assert!(
            errors.iter().any(|e| e["code"] == *code),
            "{name}: {}",
            done.stderr
        );
        text += &format!("{name}\n");
        for error in errors {
            let word = |key: &str| error[key].as_str().unwrap_or_default().to_owned();
            let file = word("file");
            let file = file.rsplit('/').next().unwrap();
            let line = error["line"].as_u64().unwrap_or(0);
            text += &format!("  {file}:{line}: {}", word("code"));
            for (before, key) in [
                (" ", "key"),
                (" = ", "value"),
                (": ", "message"),
                ("; allowed: ", "allowed"),
                ("; hint: ", "hint"),
            ] {
                let found = word(key);
                // Folders differ from machine to machine.
                let found = found.replace(&format!("{}/", folder(importer).display()), "");
                if !found.is_empty() {
                    text += &format!("{before}{found}");
                }
            }
            text += "\n";
        }
        count += 1;
    }
    assert!(count >= least, "{count} of {importer}");
    assert_eq!(std::fs::read_dir(at.path()).unwrap().count(), 0);
    text
}

#[test]
fn every_damaged_matrix_market_file_gets_its_message() {
    insta::assert_snapshot!(said("market", |path| matrices("market", path), 50));
}

#[test]
fn every_damaged_calculix_file_gets_its_message() {
    insta::assert_snapshot!(said("calculix", |path| matrices("calculix", path), 20));
}

#[test]
fn every_damaged_dense_file_gets_its_message() {
    insta::assert_snapshot!(said("dense", |path| matrices("dense", path), 20));
}

/// A contact point that the map does not have, or that no mode moves.
#[test]
fn every_damaged_contact_gets_its_message() {
    let at = tempfile::tempdir().unwrap();
    let sound = run(at.path(), &matrices("contact", None));
    assert_eq!(sound.code, 0, "{}", sound.stderr);
    insta::assert_snapshot!(said("contact", |path| matrices("contact", path), 7));
}

#[test]
fn every_damaged_cmlair_file_gets_its_message() {
    insta::assert_snapshot!(said("cmlair", cmlair, 50));
}

#[test]
fn every_damaged_dynamic_run_gets_its_message() {
    insta::assert_snapshot!(said("dynluls", dynamic, 50));
}

#[test]
fn every_damaged_gmsh_mesh_gets_its_message() {
    let words = |damaged: Option<&Path>| {
        let study = folder("gmsh").join("sound.study.toml");
        let file = damaged.map_or(folder("gmsh").join("sound.msh"), Path::to_owned);
        let set = format!("ramp.deformable.mesh.file={}", file.display());
        let words = ["check", &study.display().to_string(), "--set", &set];
        words.map(str::to_owned).to_vec()
    };
    insta::assert_snapshot!(said("gmsh", words, 40));
}

/// Gmsh's 27-node hexahedra without their inner nodes are its 20-node ones; the oscillators that
/// take the mesh's place in the resolved study are the same study.
#[test]
fn a_study_takes_its_ramp_from_a_gmsh_mesh() {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/gmsh");
    let read = |file: &str| {
        let text = std::fs::read_to_string(folder("gmsh").join("sound.study.toml")).unwrap();
        let path = reference.join(file);
        let named = text.replace("sound.msh", path.to_str().unwrap());
        Study::from_text(&named, &[]).unwrap()
    };
    let modes = |study: &Study| match &study.points[0].scene.ramp.model {
        RampModel::Coupled { modes } => modes.clone(),
        other => panic!("{other:?}"),
    };
    let [twenty, twenty_seven, ten] = ["hex20.msh", "hex27.msh", "tet10.msh"].map(read);
    let lowest = |study: &Study| modes(study)[0].frequency_hz;
    assert!((lowest(&twenty) / lowest(&twenty_seven) - 1.0).abs() < 1e-8);
    // One shape: both are too stiff, a hexahedron a block more so than the finer tetrahedra.
    let ratio = lowest(&ten) / lowest(&twenty);
    assert!((0.9..1.0).contains(&ratio), "{ratio}");
    let again = Study::from_text(&twenty.resolved_toml(), &[]).unwrap();
    assert_eq!(again.digest, twenty.digest);
    assert_eq!(modes(&again), modes(&twenty));
    // The slot is 0.8 mm, disk and clearances take 0.835 mm.
    assert!(twenty.remarks.iter().any(|remark| remark.code == "N208"));
}

#[test]
fn files_that_are_missing_and_freedoms_that_are_not_there_are_named() {
    let at = tempfile::tempdir().unwrap();
    let mut text = String::new();
    let mut tell = |words: Vec<String>| {
        let done = run(at.path(), &words);
        assert_eq!(done.code, 3, "{}", done.stderr);
        for error in done.errors() {
            let word = |key: &str| error[key].as_str().unwrap_or_default().to_owned();
            let of = [
                word("code"),
                word("key"),
                word("value"),
                word("message"),
                word("hint"),
            ];
            text += &(of.join(" | ") + "\n");
        }
    };
    let sound = |importer: &str, more: &[&str]| {
        let mut words = matrices(importer, None);
        words.extend(more.iter().map(|word| (*word).to_owned()));
        words
    };
    tell(cmlair(Some(Path::new("no.rail.dat"))));
    tell(cmlair(Some(Path::new("no.run.dat"))));
    tell(sound(
        "calculix",
        &["--contact", "2.3", "--contact", "12.3"],
    ));
    tell(sound("calculix", &["--contact", "tip"]));
    tell(sound("market", &["--contact", "4"]));
    let mut without = sound("calculix", &[]);
    without.truncate(without.len() - 2);
    tell(without);
    // A mode file whose only mode does not move the second freedom.
    let shapes = at.path().join("one.mtx");
    std::fs::write(
        &shapes,
        "%%MatrixMarket matrix array real general\n3 1\n1000\n0\n0\n",
    )
    .unwrap();
    let stiffness = at.path().join("apart.mtx");
    std::fs::write(
        &stiffness,
        "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 1000\n2 2 1000\n3 3 1000\n",
    )
    .unwrap();
    let hertz = at.path().join("one.txt");
    std::fs::write(&hertz, "5032.92\n").unwrap();
    let mut still = sound("market", &["--contact", "2"]);
    let stiff = still.iter().position(|word| word == "--stiffness").unwrap();
    still[stiff + 1] = stiffness.display().to_string();
    for (option, path) in [("--modes", &shapes), ("--frequencies", &hertz)] {
        still.extend([option.to_owned(), path.display().to_string()]);
    }
    tell(still.clone());
    insta::assert_snapshot!(text);
    let contact = still.iter().position(|word| word == "--contact").unwrap();
    still[contact + 1] = "1".to_owned();
    assert_eq!(run(at.path(), &still).code, 0);
}

#[test]
fn sound_matrices_are_told_and_written_in_si_units() {
    let at = tempfile::tempdir().unwrap();
    let told = |importer: &str, more: &[&str]| {
        let mut words = matrices(importer, None);
        words.extend(more.iter().map(|word| (*word).to_owned()));
        let done = run(at.path(), &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.json()
    };
    // mm, N, t: eigenvalue of 1e3 [2 -1; -1 1] against 1e-7 [2 .5; .5 1] by the quadratic formula.
    let two = told("calculix", &["--out", "si"]);
    let value: f64 = (5.0 - (25.0_f64 - 4.0 * 1.75).sqrt()) / (2.0 * 1.75) * 1e10;
    let hertz = value.sqrt() / std::f64::consts::TAU;
    assert!(
        (two["lowest_hz"].as_f64().unwrap() / hertz - 1.0).abs() < 1e-9,
        "{two} {hertz}"
    );
    assert!(
        (two["total_mass_kg"][2].as_f64().unwrap() / 4e-4 - 1.0).abs() < 1e-12,
        "{two}"
    );
    let stiffness = std::fs::read_to_string(at.path().join("si/stiffness.mtx")).unwrap();
    assert!(
        stiffness.ends_with("2 2 3\n1 1 2e6\n2 1 -1e6\n2 2 1e6\n"),
        "{stiffness}"
    );
    // Written files are read as they are, and never replaced.
    let again: Vec<String> = [
        "import",
        "matrices",
        "--units",
        "si",
        "--mass",
        "si/mass.mtx",
        "--stiffness",
        "si/stiffness.mtx",
        "--dof",
        "si/freedoms.dof",
    ]
    .map(str::to_owned)
    .to_vec();
    assert_eq!(run(at.path(), &again).json()["lowest_hz"], two["lowest_hz"]);
    let once_more = [again, vec!["--out".to_owned(), "si".to_owned()]].concat();
    assert_eq!(run(at.path(), &once_more).code, 2);
    // A cantilever's end in mN, mm, kg: rotations count in rad.
    let beam = told("dense", &[]);
    assert_eq!(beam["freedoms"], 2);
    // Warnings are accepted by their code.
    let soft = folder("market").join("w206_soft.stiffness.mtx");
    let mut words = matrices("market", Some(&soft));
    words.extend(["--accept".to_owned(), "W206".to_owned()]);
    assert_eq!(run(at.path(), &words).code, 0);
}

fn steady(at: &Path, study: &str) -> serde_json::Value {
    let set = "solver.film_cells=800";
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
    let coarse = [
        "run",
        "out/study.toml",
        "--ramp",
        "rigid",
        "--sign",
        "+",
        "--amplitude-g",
        "200",
        "--set",
        "solver.film_cells=300",
        "--set",
        "pulse.window_ms=1.5",
        "--set",
        "solver.disk_cut_khz=10",
        "--json",
    ];
    let shaken = Done::of(at.path(), &coarse);
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
    let geometry = "study_format = 1\nname = \"suspension\"\n[pulse]\nwidths_ms = [0.5]\n\
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
    let told = |size: usize, row: usize| {
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
    told(250, row);
    refused("E161");
    told(n_rows, 0);
    refused("E169");
    told(n_rows, row);
    let done = import("out", &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.json()["notes"]
            .to_string()
            .contains("its node is the dimple")
    );
    let modes = |study: &str| {
        let set = "solver.film_cells=300";
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
        (scene.surface_forces, steady(at.path(), &study))
    };
    let (absent, free) = flight("none", &plain);
    let (present, pulled) = flight("some", &plain.replace(none, some));
    assert_eq!(absent, None);
    let forces = present.expect("surface forces");
    assert_eq!(
        (forces.hamaker_j, forces.repulsion_j_m6, forces.potential_v),
        (1.8e-19, 1.0e-76, 0.5)
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

/// CalculiX's beam as a ramp: what its tip gives way to a force, and to the base, is what the matrices
/// say (numpy.linalg.solve), and the study that takes it has its frequencies.
#[test]
fn a_ramp_from_calculix_matrices_moves_as_they_do() {
    let at = tempfile::tempdir().unwrap();
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/calculix");
    let file = |name: &str| reference.join(name).display().to_string();
    let words = |contact: &str, out: &str| {
        let [mass, stiffness, dof] = ["arm.mas", "arm.sti", "arm.dof"].map(file);
        [
            "import",
            "ramp",
            "--mass",
            &mass,
            "--stiffness",
            &stiffness,
            "--dof",
            &dof,
            "--units",
            "mm_n",
            "--contact",
            contact,
            "--out",
            out,
        ]
        .map(str::to_owned)
        .to_vec()
    };
    let done = run(at.path(), &words("13.3", "arm"));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let told = done.json();
    let modes = told["modes"].as_array().unwrap();
    let number = |mode: &serde_json::Value, key: &str| mode[key].as_f64().unwrap();
    let stiffness = |mode| (std::f64::consts::TAU * number(mode, "frequency_hz")).powi(2);
    let flexibility: f64 = modes
        .iter()
        .map(|mode| 1.0 / (number(mode, "mass_mg") * 1e-6 * stiffness(mode)))
        .sum();
    let sag: f64 = modes
        .iter()
        .map(|mode| number(mode, "participation") / stiffness(mode))
        .sum();
    assert!(
        (flexibility / 1.048_962_913_373_314e-3 - 1.0).abs() < 1e-6,
        "{flexibility}"
    );
    assert!(
        (sag / 1.454_650_870_053_842e-10 - 1.0).abs() < 1e-6,
        "{sag}"
    );
    assert!(
        (number(&modes[0], "frequency_hz") / 16_352.578_65 - 1.0).abs() < 1e-6,
        "{told}"
    );
    let study = std::fs::read_to_string(crate::cli::study("fig13")).unwrap();
    let start = study.find("[ramp.deformable]").unwrap();
    let end = study[start + 1..]
        .find("\n[")
        .map_or(study.len(), |end| start + end + 2);
    let section = std::fs::read_to_string(at.path().join("arm/ramp.toml")).unwrap();
    let with = [&study[..start], section.as_str(), &study[end..]].concat();
    std::fs::write(at.path().join("with.toml"), with).unwrap();
    let surface = crate::cli::study("fig13").with_file_name("surface.toml");
    std::fs::copy(surface, at.path().join("surface.toml")).unwrap();
    let asked = [
        "modes",
        "with.toml",
        "--ramp",
        "deformable",
        "--json",
        "--accept",
        "W201",
    ];
    let modes = Done::of(at.path(), &asked);
    assert_eq!(modes.code, 0, "{}", modes.stderr);
    let first = modes.json()["ramp"][0]["frequency_hz"].as_f64().unwrap();
    assert!((first / 16_352.578_65 - 1.0).abs() < 1e-6, "{first}");
    // A node that is held, and nothing is written.
    let refused = run(at.path(), &words("1.3", "other"));
    assert_eq!(refused.code, 3);
    assert_eq!(refused.errors()[0]["code"], "E169");
    assert!(!at.path().join("other").exists());
}
