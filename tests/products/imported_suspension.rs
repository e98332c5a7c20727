//! A suspension as matrices: the geometry's finite elements, written and read again, fly and answer a
//! shock as the geometry does; what is no suspension is refused.

use crate::cli::{COARSE, Done, study};
use serde_json::Value;
use std::path::Path;

/// The suspension of studies/drive-2.5in as matrices in `susp/`, and a study beside them that reads them.
fn exported(at: &Path) {
    let path = study("drive-2.5in");
    let words = ["export", path.to_str().unwrap(), "--format", "suspension"];
    let done = Done::of(at, &[&words[..], &["--out", "susp"]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let section = std::fs::read_to_string(at.join("susp/suspension.toml")).unwrap();
    let of_geometry = "study_format = 2\nname = \"suspension\"\noutputs = [\"min_clearance\"]\n\
         [pulse]\nwidths_ms = [0.5]\nsigns = [\"+\"]\n[ramp]\nmodels = [\"none\"]\n";
    std::fs::write(at.join("geometry.toml"), of_geometry).unwrap();
    let of_matrices = of_geometry.to_owned() + &section;
    std::fs::write(at.join("susp/study.toml"), of_matrices).unwrap();
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("{pointer}\n{value:#}"))
}

fn reported(at: &Path, words: &[&str]) -> Value {
    let done = Done::of(at, &[words, &COARSE, &["--json"]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.json()
}

/// The list of modes has nine digits, so nothing is asked for beyond 1e-6.
#[test]
fn the_default_suspension_as_matrices_flies_and_is_shaken_as_before() {
    let at = tempfile::tempdir().unwrap();
    let at = at.path();
    exported(at);
    let both = |words: &dyn Fn(&'static str) -> Vec<&'static str>| {
        ["geometry.toml", "susp/study.toml"].map(|file| reported(at, &words(file)))
    };
    let [a, b] = both(&|file| vec!["modes", file]);
    for key in [
        "dimple_stiffness_n_per_m",
        "roll_stiffness_n_m_per_rad",
        "effective_shock_mass_kg",
        "bending_pinned_hz/0",
        "bending_pinned_hz/7",
        "bending_pinned_hz/15",
        "torsion_pinned_hz/0",
        "torsion_pinned_hz/7",
        "bending_free_hz/0",
    ] {
        let pointer = format!("/suspension/{key}");
        let (a, b) = (number(&a, &pointer), number(&b, &pointer));
        assert!((a / b - 1.0).abs() < 1e-6, "{key}: {a} {b}");
    }
    let [a, b] = both(&|file| vec!["steady", file]);
    for key in ["/min_clearance_m", "/pitch_rad", "/force_n"] {
        assert_eq!(number(&a, key), number(&b, key), "{key}");
    }
    let [a, b] = both(&|file| vec!["run", file, "--amplitude-g", "150"]);
    assert_eq!(a["verdict"], b["verdict"]);
    for key in ["/min_clearance_m", "/t_min_clearance_s"] {
        let (a, b) = (number(&a, key), number(&b, key));
        assert!((a / b - 1.0).abs() < 1e-6, "{key}: {a} {b}");
    }
}

/// What the base's own nodes carry loads their neighbours: without them the load is another.
#[test]
fn the_inertia_of_the_base_counts() {
    let at = tempfile::tempdir().unwrap();
    let at = at.path();
    exported(at);
    let modes = reported(at, &["modes", "susp/study.toml"]);
    let with_base = number(&modes, "/suspension/effective_shock_mass_kg");
    // The same matrices without the root's three rows: numbers as before, of one node less.
    let strip = |name: &str, columns: bool| {
        let text = std::fs::read_to_string(at.join("susp").join(name)).unwrap();
        let rows: Vec<String> = text
            .lines()
            .skip(3)
            .map(|line| {
                let words: Vec<&str> = line.split(' ').collect();
                words[if columns { 3 } else { 0 }..].join(" ")
            })
            .collect();
        std::fs::write(at.join("susp").join(name), rows.join("\n") + "\n").unwrap();
    };
    strip("susp_M.dat", true);
    strip("susp_K.dat", true);
    strip("susp_cords.dat", false);
    let path = at.join("susp/study.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let line = text
        .lines()
        .find(|line| line.starts_with("dimple"))
        .unwrap();
    let dimple: usize = line.rsplit(' ').next().unwrap().parse().unwrap();
    let text = text
        .replace("base = [1]\n", "")
        .replace(line, &format!("dimple = {}", dimple - 1));
    std::fs::write(path, text).unwrap();
    let modes = reported(at, &["modes", "susp/study.toml"]);
    let without = number(&modes, "/suspension/effective_shock_mass_kg");
    let lost = 1.0 - without / with_base;
    assert!((1e-6..0.05).contains(&lost), "{with_base} {without}");
}

#[test]
fn what_is_no_suspension_is_refused() {
    let at = tempfile::tempdir().unwrap();
    let at = at.path();
    exported(at);
    let refused = |code: &str, sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let words: Vec<&str> = ["check", "susp/study.toml", "--json"]
            .into_iter()
            .chain(sets)
            .collect();
        let done = Done::of(at, &words);
        assert_eq!(done.code, 3, "{sets:?}: {}", done.stdout, sets = words);
        let codes: Vec<Value> = done.errors().iter().map(|e| e["code"].clone()).collect();
        assert!(codes.iter().any(|c| c == code), "{code}: {}", done.stderr);
    };
    refused("E160", &["suspension.imported.mass=lost.dat"]);
    refused("E161", &["suspension.imported.mass=susp_cords.dat"]);
    refused("E169", &["suspension.imported.dimple=99"]);
    refused("E169", &["suspension.imported.base=[99]"]);
    refused("E113", &["suspension.imported.units=inches"]);
    refused("E160", &["suspension.imported.freedoms=susp.dof"]);
    refused("E112", &["ramp.deformable.mesh.unit=mm"]);
    // A hinge that stands on nothing.
    refused("E165", &["suspension.imported.base=[]"]);
    // Mass off the middle of the tip couples bending and torsion.
    let path = at.join("susp/susp_M.dat");
    let text = std::fs::read_to_string(&path).unwrap();
    let mut rows: Vec<Vec<String>> = text
        .lines()
        .map(|line| line.split(' ').map(str::to_owned).collect())
        .collect();
    let n = rows.len();
    let (z, roll) = (n - 3, n - 1);
    let square = |row: &[String], k: usize| row[k].parse::<f64>().unwrap();
    let coupling = 0.01 * (square(&rows[z], z) * square(&rows[roll], roll)).sqrt();
    rows[z][roll] = coupling.to_string();
    rows[roll][z] = coupling.to_string();
    let rows: Vec<String> = rows.iter().map(|row| row.join(" ")).collect();
    std::fs::write(&path, rows.join("\n") + "\n").unwrap();
    refused("E180", &[]);
    // Modes by hand that bend and twist at once.
    let both = "suspension.modes=[{frequency_hz=300.0, vertical_per_sqrt_kg=700.0, \
                slope_per_m_sqrt_kg=0.0, roll_per_m_sqrt_kg=1.0, participation_sqrt_kg=1e-3}]";
    refused("E180", &[both]);
}
