//! Compares frequencies of a ramp and of a cantilever with CalculiX on the same mesh: an independent program with its
//! own elements (C3D20, C3D10), assembly and eigenvalue solver. Needs `ccx`, Debian package calculix-ccx.

mod block;

use block::block;
use opshock_solid::assembly::{SolidSystem, Support};
use opshock_solid::element::Shape;
use opshock_solid::material::Material;
use opshock_solid::mesh::Mesh;
use opshock_solid::modes::StaticSolver;
use opshock_solid::ramp::{Extent, RampGeometry};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const MODES: usize = 12;

/// The corners of hexahedra as six straight tetrahedra each.
fn tetrahedra(hexahedra: &Mesh) -> Mesh {
    const PARTS: [[usize; 4]; 6] = [
        [0, 1, 2, 6],
        [0, 2, 3, 6],
        [0, 3, 7, 6],
        [0, 7, 4, 6],
        [0, 4, 5, 6],
        [0, 5, 1, 6],
    ];
    const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let mut nodes_m = Vec::new();
    let mut numbers: HashMap<[usize; 2], usize> = HashMap::new();
    let mut connectivity = Vec::new();
    for element in hexahedra.elements() {
        for part in PARTS {
            let corners = part.map(|c| element[c]);
            let pairs = corners
                .map(|c| [c, c])
                .into_iter()
                .chain(EDGES.map(|[a, b]| [corners[a], corners[b]]));
            for [a, b] in pairs {
                let number = *numbers.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let ends = [hexahedra.nodes_m[a], hexahedra.nodes_m[b]];
                    nodes_m.push(std::array::from_fn(|i| 0.5 * (ends[0][i] + ends[1][i])));
                    nodes_m.len() - 1
                });
                connectivity.push(number);
            }
        }
    }
    Mesh {
        shape: Shape::Tetrahedron10,
        nodes_m,
        connectivity,
    }
}

/// CalculiX's input in mm, t, s, MPa; it reads at most twenty characters a number.
fn input(mesh: &Mesh, material: &Material, held: &[usize]) -> String {
    let mut text = String::from("*NODE, NSET=ALL\n");
    for (a, x) in mesh.nodes_m.iter().enumerate() {
        let [x, y, z] = x.map(|c| 1e3 * c);
        let _ = writeln!(text, "{}, {x:.11e}, {y:.11e}, {z:.11e}", a + 1);
    }
    let kind = match mesh.shape {
        Shape::Hexahedron20 => "C3D20",
        Shape::Tetrahedron10 => "C3D10",
    };
    let _ = writeln!(text, "*ELEMENT, TYPE={kind}, ELSET=SOLID");
    for (k, element) in mesh.elements().enumerate() {
        let _ = write!(text, "{}", k + 1);
        for (i, node) in element.iter().enumerate() {
            // At most sixteen numbers a line.
            let separator = if i == 12 { ",\n" } else { ", " };
            let _ = write!(text, "{separator}{}", node + 1);
        }
        text.push('\n');
    }
    let _ = writeln!(
        text,
        "*MATERIAL, NAME=POLYMER\n*ELASTIC\n{:.6e}, {}\n*DENSITY\n{:.6e}\n\
         *SOLID SECTION, ELSET=SOLID, MATERIAL=POLYMER\n*BOUNDARY",
        1e-6 * material.youngs_modulus_pa,
        material.poisson,
        1e-12 * material.density_kg_per_m3
    );
    for node in held {
        let _ = writeln!(text, "{}, 1, 3", node + 1);
    }
    let _ = writeln!(text, "*STEP\n*FREQUENCY\n{MODES}\n*END STEP");
    text
}

/// Frequencies, Hz, out of the table of eigenvalues.
fn frequencies_hz(table: &str) -> Vec<f64> {
    let rows = table.lines().map(|line| line.split_whitespace().collect());
    rows.skip_while(|words: &Vec<&str>| words.first() != Some(&"MODE"))
        .take_while(|words| words.first() != Some(&"P"))
        .filter_map(|words| match words[..] {
            [mode, _, _, hz, _] if mode.parse::<usize>().is_ok() => hz.parse().ok(),
            _ => None,
        })
        .collect()
}

fn calculix_hz(folder: &Path, text: &str) -> Vec<f64> {
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join("ramp.inp"), text).unwrap();
    let done = Command::new("ccx")
        .args(["-i", "ramp"])
        .env("OMP_NUM_THREADS", "1")
        .current_dir(folder)
        .output()
        .expect("ccx: apt-get install calculix-ccx");
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stdout)
    );
    let table = std::fs::read_to_string(folder.join("ramp.dat")).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    frequencies_hz(&table)
}

/// Frequencies of a mesh with clamped nodes by both programs; the largest relative difference.
fn compare(name: &str, mesh: &Mesh, material: &Material, held: &[usize]) -> (Vec<f64>, f64) {
    let support = Support {
        held: held
            .iter()
            .flat_map(|&a| [(a, 0), (a, 1), (a, 2)])
            .collect(),
        elastic: Vec::new(),
    };
    let system = SolidSystem::assemble(mesh, material, &support).unwrap();
    let solver = StaticSolver::new(&system, Vec::new(), 0.0).unwrap();
    let own = solver.lowest(&system, MODES).unwrap();
    let folder =
        std::env::temp_dir().join(format!("opshock-calculix-{name}-{}", std::process::id()));
    let other = calculix_hz(&folder, &input(mesh, material, held));
    assert_eq!(other.len(), MODES);
    println!(
        "{name}, {:?}: {} elements, {} unknowns",
        mesh.shape,
        mesh.n_elements(),
        system.order()
    );
    println!("mode  opshock (Hz)  CalculiX (Hz)  difference");
    let own: Vec<f64> = own
        .omega_squared
        .iter()
        .map(|square| square.sqrt() / TAU)
        .collect();
    let mut worst = 0.0_f64;
    for (k, (hz, expected)) in own.iter().zip(&other).enumerate() {
        let difference = hz / expected - 1.0;
        worst = worst.max(difference.abs());
        println!(
            "{:>4}  {hz:>12.3}  {expected:>13.3}  {difference:>10.1e}",
            k + 1
        );
    }
    (own, worst)
}

#[test]
#[ignore = "needs CalculiX: make verify-solid"]
fn frequencies_are_those_of_calculix_on_the_same_mesh() {
    let material = Material::by_name("POM").unwrap();
    let ramp = RampGeometry::mobile_drive()
        .mesh(2e-3, Extent::Whole)
        .unwrap();
    for mesh in [tetrahedra(&ramp.mesh), ramp.mesh.clone()] {
        let bolted = mesh.surface_faces(|x| {
            (x[2] + 2.6e-3).abs() < 1e-9 && x[0] > 3.2e-3 + 3.0e-3 + 0.8e-3 - 1e-9
        });
        let mut held: Vec<usize> = bolted.into_iter().flatten().collect();
        held.sort_unstable();
        held.dedup();
        let (_, worst) = compare("ramp", &mesh, &material, &held);
        assert!(worst < 1e-3, "{:?}: {worst:e}", mesh.shape);
    }
}

/// A cantilever clamped over its whole root. It is slender enough for its first bending frequency to agree within 1 %
/// with the thin beam's 1.8751² √(EI/ρA)/(2π l²). The difference is due to the clamp, which hinders lateral strain, and
/// to shear (0.2 %).
#[test]
#[ignore = "needs CalculiX: make verify-solid"]
fn a_cantilever_vibrates_as_calculix_has_it_on_the_same_mesh() {
    let material = Material::by_name("POM").unwrap();
    let [length_m, width_m, height_m] = [20e-3, 0.8e-3, 1e-3];
    for (shape, cells) in [
        (Shape::Hexahedron20, [24, 2, 2]),
        (Shape::Tetrahedron10, [24, 2, 2]),
    ] {
        let mesh = block(shape, [length_m, width_m, height_m], cells);
        let nodes = mesh.nodes_m.iter().enumerate();
        let held: Vec<usize> = nodes.filter(|(_, x)| x[0] == 0.0).map(|(a, _)| a).collect();
        let (own, worst) = compare("cantilever", &mesh, &material, &held);
        assert!(worst < 1e-3, "{shape:?}: {worst:e}");
        let wave = (material.youngs_modulus_pa / material.density_kg_per_m3).sqrt();
        // Across the width, the lower of both bending frequencies.
        let thin =
            1.875_104_069_f64.powi(2) * wave * width_m / 12.0_f64.sqrt() / (TAU * length_m.powi(2));
        let error = own[0] / thin - 1.0;
        assert!(
            error.abs() < 1e-2,
            "{shape:?}: {} {thin}: {error:e}",
            own[0]
        );
    }
}
