//! Tests of single elements: shape functions, volumes, rigid motion, energy of uniform strain.

use super::integrals::matrices;
use super::*;
use crate::material::Material;

const SHAPES: [Shape; 2] = [Shape::Hexahedron20, Shape::Tetrahedron10];
const STEEL: Material = Material {
    youngs_modulus_pa: 210e9,
    poisson: 0.3,
    density_kg_per_m3: 7800.0,
};

/// A skewed, stretched copy of the unit shape, edges straight.
fn distorted(shape: Shape) -> Vec<[f64; 3]> {
    let place = |[x, y, z]: [f64; 3]| {
        [
            0.002 * x + 0.0004 * y,
            0.0015 * y - 0.0003 * z,
            0.001 * z + 0.0002 * x,
        ]
    };
    shape.unit_nodes().into_iter().map(place).collect()
}

fn determinant() -> f64 {
    // Columns of the map above.
    let (a, b, c) = (
        [0.002, 0.0, 0.0002],
        [0.0004, 0.0015, 0.0],
        [0.0, -0.0003, 0.001],
    );
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn energy(stiffness: &[f64], u: &[f64]) -> f64 {
    let rows = stiffness.chunks_exact(u.len());
    rows.zip(u)
        .map(|(row, ui)| ui * row.iter().zip(u).map(|(k, uj)| k * uj).sum::<f64>())
        .sum::<f64>()
        * 0.5
}

#[test]
fn shape_functions_are_one_at_their_node_and_sum_to_one() {
    for shape in SHAPES {
        let nodes = shape.unit_nodes();
        for (a, &node) in nodes.iter().enumerate() {
            let at = match shape {
                Shape::Hexahedron20 => hexahedron::station(1.0, node),
                Shape::Tetrahedron10 => tetrahedron::station(1.0, node),
            };
            for b in 0..nodes.len() {
                let expected = if a == b { 1.0 } else { 0.0 };
                assert!((at.value[b] - expected).abs() < 1e-15, "{shape:?} {a} {b}");
            }
        }
        for station in shape.stations() {
            assert!((station.value.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for i in 0..3 {
                assert!(station.gradient.iter().map(|g| g[i]).sum::<f64>().abs() < 1e-13);
            }
        }
    }
}

#[test]
fn volume_and_mass_are_those_of_the_map() {
    for (shape, unit) in [
        (Shape::Hexahedron20, 8.0),
        (Shape::Tetrahedron10, 1.0 / 6.0),
    ] {
        let element = matrices(&shape.stations(), &distorted(shape), &STEEL).unwrap();
        let mass: f64 = element.mass.iter().sum();
        let expected = 7800.0 * unit * determinant();
        assert!((mass / expected - 1.0).abs() < 1e-13, "{shape:?}");
    }
}

/// Consistent mass of the straight tetrahedron: ∫ L1^a L2^b L3^c L4^d = 6V a! b! c! d!/(a+b+c+d+3)!.
#[test]
fn mass_of_the_tetrahedron_is_the_closed_form() {
    let shape = Shape::Tetrahedron10;
    let element = matrices(&shape.stations(), &shape.unit_nodes(), &STEEL).unwrap();
    let six_v = 1.0;
    // ∫ (L(2L−1))² = 6V (4·4!/7! − 4·3!/6! + 2!/5!); edge with itself ∫ 16 L1² L2².
    let corner = six_v * (4.0 * 24.0 / 5040.0 - 4.0 * 6.0 / 720.0 + 2.0 / 120.0);
    let edge = six_v * 16.0 * 4.0 / 5040.0;
    assert!((element.mass[0] / (7800.0 * corner) - 1.0).abs() < 1e-12);
    assert!((element.mass[4 * 10 + 4] / (7800.0 * edge) - 1.0).abs() < 1e-12);
}

#[test]
fn rigid_motion_costs_no_energy_and_uniform_strain_its_own() {
    let [lambda, mu] = STEEL.lame_pa();
    for (shape, unit) in [
        (Shape::Hexahedron20, 8.0),
        (Shape::Tetrahedron10, 1.0 / 6.0),
    ] {
        let nodes = distorted(shape);
        let element = matrices(&shape.stations(), &nodes, &STEEL).unwrap();
        let field = |f: &dyn Fn([f64; 3]) -> [f64; 3]| -> Vec<f64> {
            nodes.iter().flat_map(|&x| f(x)).collect()
        };
        let volume = unit * determinant();
        // ε = diag(1, 2, −1), γ_xy = 3: w = ½ λ tr² + μ (1 + 4 + 1 + 3²/2).
        let strain = 1e-3;
        let stretched = field(&|[x, y, z]| [strain * (x + 3.0 * y), strain * 2.0 * y, -strain * z]);
        let density = strain * strain * (0.5 * lambda * 4.0 + mu * (6.0 + 4.5));
        let found = energy(&element.stiffness, &stretched);
        assert!(
            (found / (density * volume) - 1.0).abs() < 1e-12,
            "{shape:?}"
        );
        for motion in [
            field(&|_| [strain, 0.0, 0.0]),
            field(&|_| [0.0, strain, 0.0]),
            field(&|_| [0.0, 0.0, strain]),
            field(&|[x, y, _]| [-strain * y, strain * x, 0.0]),
            field(&|[x, _, z]| [strain * z, 0.0, -strain * x]),
            field(&|[_, y, z]| [0.0, -strain * z, strain * y]),
        ] {
            let largest = element
                .stiffness
                .iter()
                .fold(0.0_f64, |m, k| k.abs().max(m));
            let scale = largest * motion.iter().map(|u| u * u).sum::<f64>();
            assert!(energy(&element.stiffness, &motion).abs() < 1e-14 * scale);
        }
    }
}

#[test]
fn faces_point_outwards_and_close_the_volume() {
    // ∮ x·n dA = 3 V by the centroid of each flat face.
    for (shape, unit) in [
        (Shape::Hexahedron20, 8.0),
        (Shape::Tetrahedron10, 1.0 / 6.0),
    ] {
        let nodes = distorted(shape);
        let mut flux = 0.0;
        for face in shape.faces() {
            let corners: Vec<[f64; 3]> = face.iter().map(|&a| nodes[a]).collect();
            let (single, double) = face_integrals(&corners);
            let area: f64 = single.iter().sum();
            assert!((double.iter().sum::<f64>() / area - 1.0).abs() < 1e-13);
            let middle: [f64; 3] = std::array::from_fn(|i| {
                let pairs = single.iter().zip(&corners);
                pairs.map(|(w, x)| w * x[i]).sum::<f64>() / area
            });
            let edge =
                |k: usize| -> [f64; 3] { std::array::from_fn(|i| corners[k][i] - corners[0][i]) };
            let (u, v) = (edge(1), edge(2));
            let normal = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
            let height: f64 = middle.iter().zip(normal).map(|(x, n)| x * n / length).sum();
            flux += area * height;
            // A middle node belongs between its corners.
            let n_corners = face.len() / 2;
            for k in 0..n_corners {
                let (a, b, m) = (
                    corners[k],
                    corners[(k + 1) % n_corners],
                    corners[n_corners + k],
                );
                for i in 0..3 {
                    assert!(
                        (m[i] - 0.5 * (a[i] + b[i])).abs() < 1e-15,
                        "{shape:?} {face:?}"
                    );
                }
            }
        }
        let volume = unit * determinant();
        assert!((flux / (3.0 * volume) - 1.0).abs() < 1e-12, "{shape:?}");
    }
}

#[test]
fn a_folded_element_is_refused() {
    for shape in SHAPES {
        let mut nodes = distorted(shape);
        // Turned inside out.
        nodes.iter_mut().for_each(|x| x[2] = -x[2]);
        let fault = matrices(&shape.stations(), &nodes, &STEEL).err();
        assert!(fault.is_some_and(|f| f.determinant < 0.0), "{shape:?}");
    }
}
