//! A box of equal hexahedra or tetrahedra.

use opshock_solid::element::Shape;
use opshock_solid::mesh::Mesh;
use std::collections::BTreeMap;

/// Edges with a node in their middle, as corners of the element.
pub fn edges(shape: Shape) -> Vec<[usize; 2]> {
    match shape {
        Shape::Hexahedron20 => {
            let around = |first: usize| (0..4).map(move |k| [first + k, first + (k + 1) % 4]);
            let upright = (0..4).map(|k| [k, k + 4]);
            around(0).chain(around(4)).chain(upright).collect()
        }
        Shape::Tetrahedron10 => vec![[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
    }
}

/// A box from the origin, divided into cells, each one hexahedron or six tetrahedra.
pub fn block(shape: Shape, size_m: [f64; 3], cells: [usize; 3]) -> Mesh {
    let mut numbers: BTreeMap<[usize; 3], usize> = BTreeMap::new();
    let mut nodes_m = Vec::new();
    let mut connectivity = Vec::new();
    let mut node = |key: [usize; 3]| {
        *numbers.entry(key).or_insert_with(|| {
            nodes_m.push(std::array::from_fn(|i| {
                size_m[i] * key[i] as f64 / (2 * cells[i]) as f64
            }));
            nodes_m.len() - 1
        })
    };
    const CUBE: [[usize; 3]; 8] = [
        [0, 0, 0],
        [2, 0, 0],
        [2, 2, 0],
        [0, 2, 0],
        [0, 0, 2],
        [2, 0, 2],
        [2, 2, 2],
        [0, 2, 2],
    ];
    let edges = edges(shape);
    let elements: &[&[usize]] = match shape {
        Shape::Hexahedron20 => &[&[0, 1, 2, 3, 4, 5, 6, 7]],
        // All six around the diagonal from corner 0 to corner 6.
        Shape::Tetrahedron10 => &[
            &[0, 1, 2, 6],
            &[0, 2, 3, 6],
            &[0, 3, 7, 6],
            &[0, 7, 4, 6],
            &[0, 4, 5, 6],
            &[0, 5, 1, 6],
        ],
    };
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                for element in elements {
                    let corner = |c: usize| -> [usize; 3] {
                        let at = CUBE[element[c]];
                        [2 * i + at[0], 2 * j + at[1], 2 * k + at[2]]
                    };
                    for c in 0..element.len() {
                        connectivity.push(node(corner(c)));
                    }
                    for [a, b] in &edges {
                        let (a, b) = (corner(*a), corner(*b));
                        let middle = std::array::from_fn(|d| (a[d] + b[d]) / 2);
                        connectivity.push(node(middle));
                    }
                }
            }
        }
    }
    Mesh {
        shape,
        nodes_m,
        connectivity,
    }
}
