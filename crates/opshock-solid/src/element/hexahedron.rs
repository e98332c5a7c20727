//! Shape functions of the 20-node hexahedron at 3 × 3 × 3 Gauss points.

use super::quadrature::{GAUSS_3, MAX_FACE_NODES, MAX_NODES, Station};

/// Nodes on the cube (−1, 1)³.
pub const NODES: [[f64; 3]; 20] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Nodes of each face, seen from outside.
pub const FACES: [&[usize]; 6] = [
    &[0, 3, 2, 1, 11, 10, 9, 8],
    &[4, 5, 6, 7, 12, 13, 14, 15],
    &[0, 1, 5, 4, 8, 17, 12, 16],
    &[1, 2, 6, 5, 9, 18, 13, 17],
    &[2, 3, 7, 6, 10, 19, 14, 18],
    &[3, 0, 4, 7, 11, 16, 15, 19],
];

/// Value and derivative in each direction of the shape function of `node`.
fn shape(node: [f64; 3], x: [f64; 3]) -> (f64, [f64; 3]) {
    // One factor per direction: 1 + s x at corners, 1 − x² across the middle of an edge.
    let mut factor = [0.0; 3];
    let mut slope = [0.0; 3];
    for i in 0..3 {
        (factor[i], slope[i]) = if node[i] == 0.0 {
            (1.0 - x[i] * x[i], -2.0 * x[i])
        } else {
            (1.0 + node[i] * x[i], node[i])
        };
    }
    let product = factor[0] * factor[1] * factor[2];
    let partial = [
        slope[0] * factor[1] * factor[2],
        factor[0] * slope[1] * factor[2],
        factor[0] * factor[1] * slope[2],
    ];
    if node.contains(&0.0) {
        return (0.25 * product, partial.map(|p| 0.25 * p));
    }
    let sum = node[0] * x[0] + node[1] * x[1] + node[2] * x[2] - 2.0;
    let gradient = std::array::from_fn(|i| 0.125 * (partial[i] * sum + product * node[i]));
    (0.125 * product * sum, gradient)
}

/// Shape functions at a point of the cube.
pub(super) fn station(weight: f64, x: [f64; 3]) -> Station {
    let mut out = Station {
        weight,
        value: [0.0; MAX_NODES],
        gradient: [[0.0; 3]; MAX_NODES],
    };
    for (a, node) in NODES.iter().enumerate() {
        (out.value[a], out.gradient[a]) = shape(*node, x);
    }
    out
}

pub(super) fn stations() -> Vec<Station> {
    let mut all = Vec::with_capacity(27);
    for [x, wx] in GAUSS_3 {
        for [y, wy] in GAUSS_3 {
            for [z, wz] in GAUSS_3 {
                all.push(station(wx * wy * wz, [x, y, z]));
            }
        }
    }
    all
}

/// Weight, values and gradients of the 8-node face on (−1, 1)² at 3 × 3 points.
pub(super) fn face_stations() -> Vec<(f64, [f64; MAX_FACE_NODES], [[f64; 2]; MAX_FACE_NODES])> {
    let mut all = Vec::with_capacity(9);
    // The face is the upper one of the cube: nodes 4 to 7 and 12 to 15.
    let nodes = [4, 5, 6, 7, 12, 13, 14, 15];
    for [x, wx] in GAUSS_3 {
        for [y, wy] in GAUSS_3 {
            let on_face = station(wx * wy, [x, y, 1.0]);
            let value = nodes.map(|a| on_face.value[a]);
            let gradient = nodes.map(|a| [on_face.gradient[a][0], on_face.gradient[a][1]]);
            all.push((on_face.weight, value, gradient));
        }
    }
    all
}
