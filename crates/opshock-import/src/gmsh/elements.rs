//! Gmsh's element types and the order of their nodes.

use super::mesh::Solid;

/// Meaning of an element type here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A solid element with the place of each of its nodes in the file's order.
    Solid(Solid, &'static [usize]),
    /// A face, with the number of its nodes that are used.
    Face(usize),
    /// A point or line, ignored.
    Left,
    /// A solid or face that is not read, with its name.
    Refused(&'static str),
}

/// Middles 4 to 9 of C3D10 are those of the edges 01, 12, 20, 03, 13, 23; Gmsh has 23 before 13.
pub(super) const TETRAHEDRON: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8];

/// Gmsh's middles 8 to 19 are those of the edges 01, 03, 04, 12, 15, 23, 26, 37, 45, 47, 56, 67.
pub(super) const HEXAHEDRON: [usize; 20] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
];

/// Kind and number of nodes of a type of element; `None` for one that Gmsh's manual does not list.
pub(super) fn kind(gmsh_type: usize) -> Option<(Kind, usize)> {
    let known = match gmsh_type {
        1 => (Kind::Left, 2),
        8 => (Kind::Left, 3),
        15 => (Kind::Left, 1),
        26 => (Kind::Left, 4),
        9 => (Kind::Face(6), 6),
        10 => (Kind::Face(8), 9),
        16 => (Kind::Face(8), 8),
        11 => (Kind::Solid(Solid::Tetrahedron, &TETRAHEDRON), 10),
        12 => (Kind::Solid(Solid::Hexahedron, &HEXAHEDRON), 27),
        17 => (Kind::Solid(Solid::Hexahedron, &HEXAHEDRON), 20),
        2 => (Kind::Refused("triangle of 3 nodes"), 3),
        3 => (Kind::Refused("quadrangle of 4 nodes"), 4),
        4 => (Kind::Refused("tetrahedron of 4 nodes"), 4),
        5 => (Kind::Refused("hexahedron of 8 nodes"), 8),
        6 => (Kind::Refused("prism of 6 nodes"), 6),
        7 => (Kind::Refused("pyramid of 5 nodes"), 5),
        13 => (Kind::Refused("prism of 18 nodes"), 18),
        14 => (Kind::Refused("pyramid of 14 nodes"), 14),
        18 => (Kind::Refused("prism of 15 nodes"), 15),
        19 => (Kind::Refused("pyramid of 13 nodes"), 13),
        20 => (Kind::Refused("triangle of 9 nodes"), 9),
        21 => (Kind::Refused("triangle of 10 nodes"), 10),
        29 => (Kind::Refused("tetrahedron of 20 nodes"), 20),
        30 => (Kind::Refused("tetrahedron of 35 nodes"), 35),
        31 => (Kind::Refused("tetrahedron of 56 nodes"), 56),
        92 => (Kind::Refused("hexahedron of 64 nodes"), 64),
        93 => (Kind::Refused("hexahedron of 125 nodes"), 125),
        _ => return None,
    };
    Some(known)
}
