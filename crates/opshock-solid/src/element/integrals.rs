//! Integrals of stiffness, mass and load over an element and over a face.

use super::quadrature::{MAX_FACE_NODES, MAX_NODES, Station};
use super::{hexahedron, tetrahedron};
use crate::material::Material;

/// An element whose map from the unit shape is not one to one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("element is folded: determinant of its map is {determinant:e} m³")]
pub struct FoldedElement {
    /// Smallest determinant found, m³ per unit volume.
    pub determinant: f64,
}

/// Stiffness and mass of one element.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementMatrices {
    /// Stiffness, (3n × 3n) row by row, order node by node (x, y, z), N/m.
    pub stiffness: Vec<f64>,
    /// Mass between nodes, the same for every direction, (n × n), kg.
    pub mass: Vec<f64>,
}

/// Stiffness and mass of the element with the corners and middles `nodes_m`.
///
/// # Errors
/// A folded element.
pub(crate) fn matrices(
    stations: &[Station],
    nodes_m: &[[f64; 3]],
    material: &Material,
) -> Result<ElementMatrices, FoldedElement> {
    let n = nodes_m.len();
    let [lambda, mu] = material.lame_pa();
    let mut stiffness = vec![0.0; 9 * n * n];
    let mut mass = vec![0.0; n * n];
    let mut slope = [[0.0; 3]; MAX_NODES];
    for station in stations {
        let volume = station.weight * slopes(station, nodes_m, &mut slope)?;
        let (first, second) = (lambda * volume, mu * volume);
        let weight = material.density_kg_per_m3 * volume;
        for a in 0..n {
            let ga = slope[a];
            for b in 0..=a {
                let gb = slope[b];
                let product = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
                mass[a * n + b] += weight * station.value[a] * station.value[b];
                for i in 0..3 {
                    let row = (3 * a + i) * 3 * n + 3 * b;
                    for j in 0..3 {
                        stiffness[row + j] += first * ga[i] * gb[j] + second * ga[j] * gb[i];
                    }
                    stiffness[row + i] += second * product;
                }
            }
        }
    }
    mirror(&mut stiffness, 3 * n);
    mirror(&mut mass, n);
    Ok(ElementMatrices { stiffness, mass })
}

/// Gradients of the shape functions in space; the determinant of the map.
pub(crate) fn slopes(
    station: &Station,
    nodes_m: &[[f64; 3]],
    slope: &mut [[f64; 3]; MAX_NODES],
) -> Result<f64, FoldedElement> {
    // Rows: direction in the unit shape; columns: direction in space.
    let mut map = [[0.0; 3]; 3];
    for (node, gradient) in nodes_m.iter().zip(&station.gradient) {
        for (row, g) in map.iter_mut().zip(gradient) {
            for (entry, x) in row.iter_mut().zip(node) {
                *entry += g * x;
            }
        }
    }
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ]
    };
    // Columns of the inverse times the determinant.
    let columns = [
        cross(map[1], map[2]),
        cross(map[2], map[0]),
        cross(map[0], map[1]),
    ];
    let determinant =
        map[0][0] * columns[0][0] + map[0][1] * columns[0][1] + map[0][2] * columns[0][2];
    if determinant.is_nan() || determinant <= 0.0 {
        return Err(FoldedElement { determinant });
    }
    for (out, gradient) in slope.iter_mut().zip(&station.gradient).take(nodes_m.len()) {
        for (i, entry) in out.iter_mut().enumerate() {
            let sum: f64 = columns.iter().zip(gradient).map(|(c, g)| c[i] * g).sum();
            *entry = sum / determinant;
        }
    }
    Ok(determinant)
}

/// ∫ Na dA and ∫ Na Nb dA over a face, (n), m², and (n × n) row by row, m².
pub(crate) fn face_integrals(nodes_m: &[[f64; 3]]) -> (Vec<f64>, Vec<f64>) {
    let stations: Vec<(f64, [f64; MAX_FACE_NODES], [[f64; 2]; MAX_FACE_NODES])> =
        match nodes_m.len() {
            8 => hexahedron::face_stations(),
            _ => tetrahedron::face_stations(),
        };
    let n = nodes_m.len();
    let (mut single, mut double) = (vec![0.0; n], vec![0.0; n * n]);
    for (weight, value, gradient) in &stations {
        let tangent = |k: usize| -> [f64; 3] {
            std::array::from_fn(|i| (0..n).map(|a| gradient[a][k] * nodes_m[a][i]).sum())
        };
        let (u, v) = (tangent(0), tangent(1));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let area = weight * normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        for a in 0..n {
            single[a] += area * value[a];
            for b in 0..n {
                double[a * n + b] += area * value[a] * value[b];
            }
        }
    }
    (single, double)
}

fn mirror(matrix: &mut [f64], n: usize) {
    // Blocks on the diagonal are computed whole, and symmetric only to rounding.
    for a in 0..n {
        for b in 0..a {
            matrix[b * n + a] = matrix[a * n + b];
        }
    }
}
