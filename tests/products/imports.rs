//! Other programs' files: sound ones give what they say, and every damaged one under
//! `tests/bad_inputs/imports/` gets its message. Its name gives its code, what stands behind the
//! first point which of the files of its folder it replaces.

use crate::cli::{Done, files};
use opshock_study::study::Study;
use std::path::{Path, PathBuf};

/// Damaged files of an importer, and a sound one of each kind.
pub fn folder(name: &str) -> PathBuf {
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

/// What to type for the sound surface and its flights, one of them replaced by a damaged one.
pub fn cmlair(damaged: Option<&Path>) -> Vec<String> {
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
pub fn dynamic(damaged: Option<&Path>) -> Vec<String> {
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

/// The program with these words, and its answers as JSON.
pub fn run(at: &Path, words: &[String]) -> Done {
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
    let modes = |study: &Study| study.points[0].scene.ramp.model.modes().to_vec();
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
    let mut printed = |words: Vec<String>| {
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
    printed(cmlair(Some(Path::new("no.rail.dat"))));
    printed(cmlair(Some(Path::new("no.run.dat"))));
    printed(sound(
        "calculix",
        &["--contact", "2.3", "--contact", "12.3"],
    ));
    printed(sound("calculix", &["--contact", "tip"]));
    printed(sound("market", &["--contact", "4"]));
    let mut without = sound("calculix", &[]);
    without.truncate(without.len() - 2);
    printed(without);
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
    printed(still.clone());
    insta::assert_snapshot!(text);
    let contact = still.iter().position(|word| word == "--contact").unwrap();
    still[contact + 1] = "1".to_owned();
    assert_eq!(run(at.path(), &still).code, 0);
}

#[test]
fn sound_matrices_are_reported_and_written_in_si_units() {
    let at = tempfile::tempdir().unwrap();
    let reported = |importer: &str, more: &[&str]| {
        let mut words = matrices(importer, None);
        words.extend(more.iter().map(|word| (*word).to_owned()));
        let done = run(at.path(), &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.json()
    };
    // mm, N, t: eigenvalue of 1e3 [2 -1; -1 1] against 1e-7 [2 .5; .5 1] by the quadratic formula.
    let two = reported("calculix", &["--out", "si"]);
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
    // A cantilever's end in mN, mm, kg: rotations are in rad.
    let beam = reported("dense", &[]);
    assert_eq!(beam["freedoms"], 2);
    // Warnings are accepted by their code.
    let soft = folder("market").join("w206_soft.stiffness.mtx");
    let mut words = matrices("market", Some(&soft));
    words.extend(["--accept".to_owned(), "W206".to_owned()]);
    assert_eq!(run(at.path(), &words).code, 0);
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
    let reported = done.json();
    let modes = reported["modes"].as_array().unwrap();
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
        "{reported}"
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
