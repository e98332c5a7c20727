//! Element types: nodes, faces, quadrature points.

use super::quadrature::Station;
use super::{hexahedron, tetrahedron};

/// Kind of all elements of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Serendipity hexahedron. Corners 0 to 3 turn around the lower face, 4 to 7 above them; then
    /// the middles of the lower edges, of the upper edges, of the upright edges. CalculiX's C3D20.
    Hexahedron20,
    /// Tetrahedron: corners, middles of the edges 01, 12, 20, 03, 13, 23. CalculiX's C3D10.
    Tetrahedron10,
}

impl Shape {
    /// Nodes of an element.
    pub fn n_nodes(self) -> usize {
        match self {
            Self::Hexahedron20 => 20,
            Self::Tetrahedron10 => 10,
        }
    }

    /// Nodes of each face, seen from outside: corners in turn, then the middles between them.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Hexahedron20 => &hexahedron::FACES,
            Self::Tetrahedron10 => &tetrahedron::FACES,
        }
    }

    /// Points of quadrature of the volume.
    pub(crate) fn stations(self) -> Vec<Station> {
        match self {
            Self::Hexahedron20 => hexahedron::stations(),
            Self::Tetrahedron10 => tetrahedron::stations(),
        }
    }

    /// Corners of the unit shape and middles of its edges.
    #[cfg(test)]
    pub(crate) fn unit_nodes(self) -> Vec<[f64; 3]> {
        match self {
            Self::Hexahedron20 => hexahedron::NODES.to_vec(),
            Self::Tetrahedron10 => tetrahedron::nodes(),
        }
    }
}
