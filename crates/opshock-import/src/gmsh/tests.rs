//! Tests on meshes that Gmsh itself wrote.

use super::mesh::key;
use super::*;
use crate::text::Source;
use std::collections::HashMap;

fn mesh(name: &str) -> MeshFile {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/gmsh");
    read(&Source::read(&folder.join(name)).unwrap()).unwrap()
}

/// Edges whose middle nodes follow the corners, in CalculiX's order.
fn edges(solid: Solid) -> &'static [[usize; 2]] {
    match solid {
        Solid::Tetrahedron => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
        Solid::Hexahedron => &[
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [4, 5],
            [5, 6],
            [6, 7],
            [7, 4],
            [0, 4],
            [1, 5],
            [2, 6],
            [3, 7],
        ],
    }
}

fn between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}

/// The blocks have straight edges: a node that is not in the middle of its edge is at a wrong place of the list.
#[test]
fn nodes_behind_the_corners_are_in_the_middle_of_their_edges() {
    for (name, solid) in [
        ("tet10.msh", Solid::Tetrahedron),
        ("hex20.msh", Solid::Hexahedron),
        ("hex27.msh", Solid::Hexahedron),
    ] {
        let mesh = mesh(name);
        assert_eq!(mesh.solid, solid);
        let corners = if solid == Solid::Tetrahedron { 4 } else { 8 };
        for element in mesh.connectivity.chunks_exact(solid.n_nodes()) {
            for (k, [a, b]) in edges(solid).iter().enumerate() {
                let expected = between(mesh.nodes[element[*a]], mesh.nodes[element[*b]]);
                let found = mesh.nodes[element[corners + k]];
                let far = (0..3).any(|i| (found[i] - expected[i]).abs() > 1e-9);
                assert!(!far, "{name}: {found:?} {expected:?}");
            }
        }
        mesh.one_piece().unwrap();
        for (surface, height) in [("top", 0.4), ("bottom", -0.4)] {
            for face in mesh.surface(surface).unwrap() {
                let on = |node: &usize| (mesh.nodes[*node][2] - height).abs() < 1e-9;
                assert!(face.iter().all(on), "{name} {surface}");
            }
        }
    }
}

/// Nodes, elements and faces of a mesh, without the lines they stood in.
type Content = (
    Solid,
    Vec<[f64; 3]>,
    [Vec<usize>; 3],
    Vec<(String, Vec<Vec<usize>>)>,
);

fn content(mesh: &MeshFile) -> Content {
    let faces = |list: &Vec<Face>| list.iter().map(|face| face.nodes.clone()).collect();
    let surfaces = mesh.surfaces.iter();
    (
        mesh.solid,
        mesh.nodes.clone(),
        [&mesh.node_tags, &mesh.connectivity, &mesh.element_tags].map(Clone::clone),
        surfaces
            .map(|(name, list)| (name.clone(), faces(list)))
            .collect(),
    )
}

#[test]
fn meshes_go_round() {
    for name in ["tet10.msh", "hex20.msh", "hex27.msh"] {
        let one = mesh(name);
        let text = write(&one);
        let again = read(&Source::of("again.msh", text.clone().into_bytes()).unwrap()).unwrap();
        assert_eq!(content(&again), content(&one), "{name}");
        assert_eq!(write(&again), text, "{name}");
    }
}

/// Difficult cases for a writer: numbers in use, a face outside, names without letters.
#[test]
fn odd_meshes_go_round() {
    let mut odd = mesh("tet10.msh");
    odd.element_tags[0] = 1;
    odd.element_tags[1] = usize::MAX;
    odd.node_tags[3] = usize::MAX;
    odd.nodes[4] = [-0.0, 5e-324, 9.9e299];
    let mut face = odd.surfaces["top"][0].clone();
    odd.surfaces.insert(String::new(), vec![face.clone()]);
    odd.surfaces
        .insert("a \"b\" c".to_owned(), vec![face.clone()]);
    let inside = content(&odd);
    face.nodes[0] = usize::MAX;
    odd.surfaces.get_mut("top").unwrap().push(face.clone());
    odd.surfaces.insert("none".to_owned(), vec![face]);
    let again = read(&Source::of("again.msh", write(&odd).into_bytes()).unwrap()).unwrap();
    assert_eq!(content(&again), inside);
}

/// Each face of the boundary occurs once: 26 faces of five blocks less 4 pairs that touch.
#[test]
fn the_outside_of_the_blocks_is_closed() {
    let mesh = mesh("hex20.msh");
    let mut seen: HashMap<Vec<usize>, usize> = HashMap::new();
    for element in mesh.connectivity.chunks_exact(20) {
        for face in mesh.solid.faces() {
            *seen
                .entry(key(face.iter().map(|&a| element[a])))
                .or_default() += 1;
        }
    }
    assert_eq!(seen.values().filter(|met| **met == 1).count(), 22);
    assert_eq!(seen.values().filter(|met| **met == 2).count(), 4);
    // 24 corners and 44 middles of edges.
    assert_eq!(mesh.nodes.len(), 68);
}
