//! A solid mesh with named surfaces: faces of its elements, its boundary, its connected pieces.

use crate::fault::{Fault, Faults};
use std::collections::{BTreeMap, HashMap};

/// Name of the physical volumes that form the solid, where any volume is named.
pub const BODY: &str = "body";

/// Kind of all solid elements of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// 10 nodes, in the order of C3D10.
    Tetrahedron,
    /// 20 nodes, in the order of C3D20.
    Hexahedron,
}

impl Solid {
    /// Nodes of an element.
    pub fn n_nodes(self) -> usize {
        match self {
            Self::Tetrahedron => 10,
            Self::Hexahedron => 20,
        }
    }

    /// Nodes of each face.
    pub(super) fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Tetrahedron => &[
                &[0, 2, 1, 6, 5, 4],
                &[0, 1, 3, 4, 8, 7],
                &[1, 2, 3, 5, 9, 8],
                &[2, 0, 3, 6, 7, 9],
            ],
            Self::Hexahedron => &[
                &[0, 3, 2, 1, 11, 10, 9, 8],
                &[4, 5, 6, 7, 12, 13, 14, 15],
                &[0, 1, 5, 4, 8, 17, 12, 16],
                &[1, 2, 6, 5, 9, 18, 13, 17],
                &[2, 3, 7, 6, 10, 19, 14, 18],
                &[3, 0, 4, 7, 11, 16, 15, 19],
            ],
        }
    }
}

/// A solid with named surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// File as named by the user.
    pub file: String,
    /// Kind of the elements.
    pub solid: Solid,
    /// Positions of the nodes that belong to elements, in the file's unit of length.
    pub nodes: Vec<[f64; 3]>,
    /// The file's number of each node.
    pub node_tags: Vec<usize>,
    /// Nodes of each element, [`Solid::n_nodes`] at a time.
    pub connectivity: Vec<usize>,
    /// The file's number of each element.
    pub element_tags: Vec<usize>,
    /// Faces of each physical surface by its name in small letters, with the line of each.
    pub surfaces: BTreeMap<String, Vec<Face>>,
}

/// A face: corners in turn, then the middles between them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Nodes.
    pub nodes: Vec<usize>,
    /// Line in the file.
    pub line: usize,
}

impl MeshFile {
    /// The faces of a physical surface; all of them lie on the outside of the solid.
    ///
    /// # Errors
    /// E179 where there is no such surface, or a face of it is not one of the solid's outside.
    pub fn surface(&self, name: &str) -> Result<Vec<Vec<usize>>, Faults> {
        let Some(faces) = self.surfaces.get(name).filter(|faces| !faces.is_empty()) else {
            let known: Vec<&str> = self.surfaces.keys().map(String::as_str).collect();
            let fault = Fault::of("E179", &self.file, "no physical surface of this name");
            return Err(fault
                .what(name)
                .value(match known.is_empty() {
                    true => "no physical surface".to_owned(),
                    false => known.join(", "),
                })
                .allowed(format!("Physical Surface(\"{name}\")"))
                .hint("name the surfaces in Gmsh, and save the physical volume too")
                .into());
        };
        let mut seen: HashMap<Vec<usize>, usize> = HashMap::new();
        for element in self.connectivity.chunks_exact(self.solid.n_nodes()) {
            for face in self.solid.faces() {
                *seen
                    .entry(key(face.iter().map(|&a| element[a])))
                    .or_default() += 1;
            }
        }
        let mut faults = Faults::default();
        for face in faces {
            let met = seen.get(&key(face.nodes.iter().copied()));
            let message = match met {
                Some(1) => continue,
                Some(_) => "the face lies inside the solid",
                None => "the face is no face of the solid's elements",
            };
            faults.push(
                Fault::of("E179", &self.file, message)
                    .line(face.line)
                    .what(name)
                    .allowed("faces of its outside, of the same order"),
            );
        }
        faults.or(faces.iter().map(|face| face.nodes.clone()).collect())
    }

    /// Whether shared nodes connect all elements.
    ///
    /// # Errors
    /// E179 with the number of an element of another piece than the first.
    pub fn one_piece(&self) -> Result<(), Faults> {
        let per_element = self.solid.n_nodes();
        let mut parent: Vec<usize> = (0..self.nodes.len()).collect();
        for element in self.connectivity.chunks_exact(per_element) {
            for &node in element {
                let (a, b) = (root(&mut parent, element[0]), root(&mut parent, node));
                parent[a.max(b)] = a.min(b);
            }
        }
        let first = root(&mut parent, self.connectivity[0]);
        let mut elements = self.connectivity.chunks_exact(per_element);
        match elements.position(|element| root(&mut parent, element[0]) != first) {
            None => Ok(()),
            Some(k) => Err(
                Fault::of("E179", &self.file, "the solid is in more than one piece")
                    .what(format!("element {}", self.element_tags[k]))
                    .allowed("one piece")
                    .hint("fuse the volumes, or remove duplicate nodes (Coherence)")
                    .into(),
            ),
        }
    }
}

/// Nodes that identify the face, whichever corner it begins with.
pub(super) fn key(nodes: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut key: Vec<usize> = nodes.collect();
    key.sort_unstable();
    key
}

/// Representative of a node's piece; paths are halved in passing.
fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}
