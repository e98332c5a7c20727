//! Reads and writes Gmsh meshes (`.msh`, version 4.1, ASCII) of solids.
//!
//! Read are the nodes, the quadratic tetrahedra or hexahedra, and the faces of the physical
//! surfaces by name. Nodes come out in the order of CalculiX's C3D10 and C3D20:
//!
//! | Gmsh's type | element | here |
//! |---|---|---|
//! | 11 | tetrahedron of 10 nodes | its last two nodes change places |
//! | 17 | hexahedron of 20 nodes | edges in the order lower, upper, upright |
//! | 12 | hexahedron of 27 nodes | the same; nodes in faces and in the middle are dropped |
//! | 9, 16, 10 | triangle of 6, quadrangle of 8 or 9 nodes | corners, then middles of the edges |
//!
//! Where physical volumes are named, only those named [`BODY`] are used. Lengths are as in the file.
//!
//! Source: Gmsh reference manual, sections "MSH file format" (version 4.1) and "Node ordering".

mod elements;
mod found;
mod mesh;
mod read;
mod words;
mod write;

pub use mesh::{BODY, Face, MeshFile, Solid};
pub use read::read;
pub use write::write;

#[cfg(test)]
mod tests;
