//! Shape functions of the 10-node tetrahedron.
//!
//! Quadrature is the product of four Gauss points in each direction of the cube collapsed onto the tetrahedron. It has
//! degree 5 at least and positive weights, and is exact for stiffness and mass of straight edges (Stroud, *Approximate
//! Calculation of Multiple Integrals*, 1971, section 2.4).

use super::quadrature::{GAUSS_4, MAX_FACE_NODES, MAX_NODES, Station};

/// Corners of each edge with a node in its middle.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Nodes of each face, seen from outside.
pub const FACES: [&[usize]; 4] = [
    &[0, 2, 1, 6, 5, 4],
    &[0, 1, 3, 4, 8, 7],
    &[1, 2, 3, 5, 9, 8],
    &[2, 0, 3, 6, 7, 9],
];

/// Nodes of the unit tetrahedron.
#[cfg(test)]
pub fn nodes() -> Vec<[f64; 3]> {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let middle = |[a, b]: [usize; 2]| -> [f64; 3] {
        std::array::from_fn(|i| 0.5 * (corners[a][i] + corners[b][i]))
    };
    corners
        .into_iter()
        .chain(EDGES.into_iter().map(middle))
        .collect()
}

/// Shape functions at a point of the unit tetrahedron.
pub(super) fn station(weight: f64, x: [f64; 3]) -> Station {
    let share = [1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]];
    let slope = [
        [-1.0, -1.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let mut out = Station {
        weight,
        value: [0.0; MAX_NODES],
        gradient: [[0.0; 3]; MAX_NODES],
    };
    for a in 0..4 {
        out.value[a] = share[a] * (2.0 * share[a] - 1.0);
        out.gradient[a] = slope[a].map(|s| (4.0 * share[a] - 1.0) * s);
    }
    for (k, [a, b]) in EDGES.into_iter().enumerate() {
        out.value[4 + k] = 4.0 * share[a] * share[b];
        out.gradient[4 + k] =
            std::array::from_fn(|i| 4.0 * (share[a] * slope[b][i] + share[b] * slope[a][i]));
    }
    out
}

/// Gauss points moved to (0, 1).
fn unit_gauss() -> [[f64; 2]; 4] {
    GAUSS_4.map(|[x, w]| [0.5 * (1.0 + x), 0.5 * w])
}

pub(super) fn stations() -> Vec<Station> {
    let mut all = Vec::with_capacity(64);
    for [u, wu] in unit_gauss() {
        for [v, wv] in unit_gauss() {
            for [w, ww] in unit_gauss() {
                let y = v * (1.0 - u);
                let z = w * (1.0 - u) * (1.0 - v);
                let weight = wu * wv * ww * (1.0 - u).powi(2) * (1.0 - v);
                all.push(station(weight, [u, y, z]));
            }
        }
    }
    all
}

/// Weight, values and gradients of the 6-node face on the unit triangle.
pub(super) fn face_stations() -> Vec<(f64, [f64; MAX_FACE_NODES], [[f64; 2]; MAX_FACE_NODES])> {
    let mut all = Vec::with_capacity(16);
    for [u, wu] in unit_gauss() {
        for [v, wv] in unit_gauss() {
            // The face without the fourth corner: nodes 0 to 2 and 4 to 6.
            let on_face = station(wu * wv * (1.0 - u), [u, v * (1.0 - u), 0.0]);
            let mut value = [0.0; MAX_FACE_NODES];
            let mut gradient = [[0.0; 2]; MAX_FACE_NODES];
            for (k, a) in [0, 1, 2, 4, 5, 6].into_iter().enumerate() {
                value[k] = on_face.value[a];
                gradient[k] = [on_face.gradient[a][0], on_face.gradient[a][1]];
            }
            all.push((on_face.weight, value, gradient));
        }
    }
    all
}
