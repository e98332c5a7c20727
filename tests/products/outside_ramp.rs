//! A ramp by other programs: Gmsh meshes the default ramp, CalculiX makes its matrices, and
//! `opshock import ramp` takes them. Frequencies and critical shocks are those of opshock's own
//! elements on the same mesh, and those of its own mesh of the same shape within the meshes' error.
//! Needs Debian's packages `gmsh` and `calculix-ccx`.

use crate::cli::{Done, study};
use opshock_import::gmsh::{self, MeshFile};
use opshock_import::text::Source;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// Longest edge of Gmsh's tetrahedra, mm.
const SIZE_MM: &str = "0.8";
/// Frequencies that CalculiX itself computes.
const N_OWN: usize = 10;

fn run(program: &str, folder: &Path, words: &[&str]) {
    let done = Command::new(program)
        .args(words)
        .env("OMP_NUM_THREADS", "1")
        .current_dir(folder)
        .output()
        .unwrap_or_else(|_| panic!("{program}: scripts/bootstrap --verify"));
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{program}: {said}");
}

/// CalculiX's input in N, mm, t, s, with the numbers of the mesh's nodes.
fn deck(mesh: &MeshFile, solver: &str) -> String {
    let mut text = String::from("*NODE, NSET=ALL\n");
    for (tag, [x, y, z]) in mesh.node_tags.iter().zip(&mesh.nodes) {
        let _ = writeln!(text, "{tag}, {x:.11e}, {y:.11e}, {z:.11e}");
    }
    text += "*ELEMENT, TYPE=C3D10, ELSET=SOLID\n";
    let elements = mesh.connectivity.chunks_exact(10);
    for (tag, nodes) in mesh.element_tags.iter().zip(elements) {
        let nodes: Vec<String> = nodes
            .iter()
            .map(|&a| mesh.node_tags[a].to_string())
            .collect();
        let _ = writeln!(text, "{tag}, {}", nodes.join(", "));
    }
    text += "*MATERIAL, NAME=POM\n*ELASTIC\n2850., 0.37\n*DENSITY\n1.41e-9\n\
             *SOLID SECTION, ELSET=SOLID, MATERIAL=POM\n*BOUNDARY\n";
    let mut held: Vec<usize> = mesh.surface("mount").unwrap().concat();
    held.sort_unstable();
    held.dedup();
    for node in held {
        let _ = writeln!(text, "{}, 1, 3", mesh.node_tags[node]);
    }
    let _ = writeln!(text, "*STEP\n*FREQUENCY{solver}\n{N_OWN}\n*END STEP");
    text
}

/// Frequencies that CalculiX computed, Hz.
fn calculix_hz(table: &str) -> Vec<f64> {
    let rows = table.lines().map(|line| line.split_whitespace().collect());
    rows.skip_while(|words: &Vec<&str>| words.first() != Some(&"MODE"))
        .take_while(|words| words.first() != Some(&"P"))
        .filter_map(|words| match words[..] {
            [mode, _, _, hz, _] if mode.parse::<usize>().is_ok() => hz.parse().ok(),
            _ => None,
        })
        .collect()
}

/// Modes that move a contact, or are moved by the base.
fn driven_hz(modes: &Value) -> Vec<f64> {
    let number = |mode: &Value, key: &str| mode[key].as_f64().unwrap().abs();
    let list = modes.as_array().unwrap().iter().filter(|mode| {
        number(mode, "top_shape_per_sqrt_kg") + number(mode, "bottom_shape_per_sqrt_kg") > 20.0
    });
    list.map(|mode| number(mode, "frequency_hz")).collect()
}

/// The study of the deformable ramp with this section, at the preset `coarse`.
fn write_study(folder: &Path, name: &str, section: &str) -> String {
    let text = std::fs::read_to_string(study("fig13-geometry")).unwrap();
    let (before, rest) = text.split_once("[ramp.deformable.geometry]").unwrap();
    let after = &rest[rest.find("# The slider sits").unwrap()..];
    let surface = study("fig13").with_file_name("surface.toml");
    let text = format!("{before}{section}\n{after}")
        .replace("../fig13/surface.toml", surface.to_str().unwrap())
        .replace("[0.5, 1.0, 2.0, 3.0]", "[1.0]")
        .replace("preset = \"standard\"", "preset = \"coarse\"");
    let file = format!("{name}.toml");
    std::fs::write(folder.join(&file), text).unwrap();
    file
}

/// A critical shock with its interval, g.
struct Critical {
    sign: String,
    value: f64,
    low: f64,
    high: f64,
}

fn critical(folder: &Path, file: &str) -> Vec<Critical> {
    let store = format!("{file}.opshock");
    let words = ["sweep", file, "--store", &store, "-j", "2", "--json"];
    let done = Done::of(folder, &words);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let reported = done.json();
    let points = reported["points"].as_array().unwrap().iter();
    points
        .map(|point| {
            let number = |key: &str| point[key].as_f64().unwrap();
            let value = number("a_crit_g");
            Critical {
                sign: point["sign"].as_str().unwrap().to_owned(),
                value,
                low: value - number("uncertainty_g"),
                high: value + number("uncertainty_g"),
            }
        })
        .collect()
}

#[test]
#[ignore = "slow: some minutes; needs Gmsh and CalculiX: make verify-ramp"]
fn outside_slow_ramp_by_gmsh_and_calculix() {
    let at = tempfile::tempdir().unwrap();
    let folder = at.path();
    let geo = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/gmsh/ramp.geo");
    let geo = geo.to_str().unwrap();
    run(
        "gmsh",
        folder,
        &["-3", "-setnumber", "size", SIZE_MM, "-o", "ramp.msh", geo],
    );
    let mesh = gmsh::read(&Source::read(&folder.join("ramp.msh")).unwrap()).unwrap();
    for (name, solver) in [("own", ""), ("arm", ", SOLVER=MATRIXSTORAGE")] {
        std::fs::write(folder.join(format!("{name}.inp")), deck(&mesh, solver)).unwrap();
        run("ccx", folder, &["-i", name]);
    }
    let own = calculix_hz(&std::fs::read_to_string(folder.join("own.dat")).unwrap());
    assert_eq!(own.len(), N_OWN);
    let words = "import ramp --mass arm.mas --stiffness arm.sti --dof arm.dof --units mm_n \
                 --mesh ramp.msh --cut-khz 100 --out imported";
    let words: Vec<&str> = words.split_whitespace().collect();
    let done = Done::of(folder, &words);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let imported = std::fs::read_to_string(folder.join("imported/ramp.toml")).unwrap();
    let ramps = [
        ("CalculiX", imported),
        (
            "same mesh",
            "[ramp.deformable.mesh]\nfile = \"ramp.msh\"\nmaterial = \"POM\"\n".to_owned(),
        ),
        (
            "own mesh",
            "[ramp.deformable.geometry]\nmaterial = \"POM\"\n".to_owned(),
        ),
        (
            "own, fine",
            "[ramp.deformable.geometry]\nmaterial = \"POM\"\nmesh_size_mm = 0.5\n".to_owned(),
        ),
    ];
    println!(
        "{} nodes, {} tetrahedra",
        mesh.nodes.len(),
        mesh.element_tags.len()
    );
    let mut frequencies = Vec::new();
    let mut shocks = Vec::new();
    for (k, (name, section)) in ramps.iter().enumerate() {
        let file = write_study(folder, &format!("study{k}"), section);
        let modes = Done::of(folder, &["modes", &file, "--json"]);
        assert_eq!(modes.code, 0, "{}", modes.stderr);
        let hz = driven_hz(&modes.json()["ramp"]);
        let first: Vec<String> = hz.iter().take(5).map(|hz| format!("{hz:>10.2}")).collect();
        println!("{name:<10} driven modes (Hz) {}", first.join(" "));
        frequencies.push(hz);
        let found = critical(folder, &file);
        for c in &found {
            println!(
                "{name:<10} 1 ms {}: critical shock {:.1} g, interval {:.1} to {:.1} g",
                c.sign, c.value, c.low, c.high
            );
        }
        shocks.push(found);
    }
    let [outside, same, hexahedra, _fine] = &frequencies[..] else {
        panic!("four ramps")
    };
    // CalculiX's tetrahedra have their own quadrature of the mass.
    for (a, b) in outside.iter().zip(same).take(5) {
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
    // What CalculiX's eigensolver says of its matrices, with nothing reduced.
    let hz = own[0];
    assert!((outside[0] / hz - 1.0).abs() < 1e-4, "{} {hz}", outside[0]);
    // Tetrahedra of one size are some per cent too stiff at the mount's edge.
    for (a, b) in same.iter().zip(hexahedra).take(3) {
        assert!((a / b - 1.0).abs() < 0.06, "{a} {b}");
    }
    for (k, other) in shocks.iter().enumerate().skip(1) {
        for (a, b) in shocks[0].iter().zip(other) {
            assert_eq!(a.sign, b.sign);
            let apart = a.low > b.high || b.low > a.high;
            assert!(!apart, "{} {}: {} {}", ramps[k].0, a.sign, a.value, b.value);
        }
    }
}
