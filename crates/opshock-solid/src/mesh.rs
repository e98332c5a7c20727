//! Meshes of one element type: nodes, elements, surface faces.

use crate::element::{Shape, face_integrals};
use std::collections::HashMap;

/// A mesh of solid elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Kind of the elements.
    pub shape: Shape,
    /// Positions, m.
    pub nodes_m: Vec<[f64; 3]>,
    /// Nodes of each element, [`Shape::n_nodes`] at a time, in the shape's order.
    pub connectivity: Vec<usize>,
}

/// Errors of a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// No element.
    #[error("the mesh has no element")]
    Empty,
    /// The list of nodes is not whole elements.
    #[error("{found} nodes in the elements are not a multiple of {per_element}")]
    Ragged {
        /// Entries found.
        found: usize,
        /// Nodes of an element.
        per_element: usize,
    },
    /// An element names a node that is not there.
    #[error("element {element} names node {node} of {n_nodes}")]
    UnknownNode {
        /// Element, from 0.
        element: usize,
        /// Node named, from 0.
        node: usize,
        /// Nodes of the mesh.
        n_nodes: usize,
    },
    /// A node without an element has no mass.
    #[error("node {node} belongs to no element")]
    LooseNode {
        /// Node, from 0.
        node: usize,
    },
    /// A position that is not a finite number.
    #[error("position of node {node} is not finite")]
    NotFinite {
        /// Node, from 0.
        node: usize,
    },
    /// An element whose map from the unit shape is not one to one.
    #[error("element {element} is folded: determinant of its map is {determinant:e} m³")]
    Folded {
        /// Element, from 0.
        element: usize,
        /// Smallest determinant found, m³ per unit volume.
        determinant: f64,
    },
}

/// Nodal weights of a distribution over faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceWeights {
    /// Area, m².
    pub area_m2: f64,
    /// Node and ∫ N dA, m², by rising node.
    pub nodes: Vec<(usize, f64)>,
}

impl Mesh {
    /// Elements.
    pub fn n_elements(&self) -> usize {
        self.connectivity.len() / self.shape.n_nodes()
    }

    /// Nodes of each element.
    pub fn elements(&self) -> impl Iterator<Item = &[usize]> {
        self.connectivity.chunks_exact(self.shape.n_nodes())
    }

    /// Positions of the nodes of an element.
    pub(crate) fn corners_m(&self, element: &[usize]) -> Vec<[f64; 3]> {
        element.iter().map(|&a| self.nodes_m[a]).collect()
    }

    /// Checks that elements and nodes fit together; folded elements are found in assembly.
    ///
    /// # Errors
    /// The first fault found.
    pub fn validate(&self) -> Result<(), MeshError> {
        let per_element = self.shape.n_nodes();
        if self.connectivity.is_empty() {
            return Err(MeshError::Empty);
        }
        if !self.connectivity.len().is_multiple_of(per_element) {
            return Err(MeshError::Ragged {
                found: self.connectivity.len(),
                per_element,
            });
        }
        let n_nodes = self.nodes_m.len();
        let mut used = vec![false; n_nodes];
        for (k, &node) in self.connectivity.iter().enumerate() {
            match used.get_mut(node) {
                Some(mark) => *mark = true,
                None => {
                    return Err(MeshError::UnknownNode {
                        element: k / per_element,
                        node,
                        n_nodes,
                    });
                }
            }
        }
        if let Some(node) = used.iter().position(|mark| !mark) {
            return Err(MeshError::LooseNode { node });
        }
        let finite = |x: &[f64; 3]| x.iter().all(|c| c.is_finite());
        match self.nodes_m.iter().position(|x| !finite(x)) {
            Some(node) => Err(MeshError::NotFinite { node }),
            None => Ok(()),
        }
    }

    /// Faces of the surface all of whose nodes satisfy `on`, seen from outside.
    pub fn surface_faces(&self, on: impl Fn([f64; 3]) -> bool) -> Vec<Vec<usize>> {
        let mut seen: HashMap<Vec<usize>, (usize, Vec<usize>)> = HashMap::new();
        let mut order = 0;
        for element in self.elements() {
            for face in self.shape.faces() {
                let nodes: Vec<usize> = face.iter().map(|&a| element[a]).collect();
                if !nodes.iter().all(|&a| on(self.nodes_m[a])) {
                    continue;
                }
                let mut key = nodes.clone();
                key.sort_unstable();
                order += 1;
                // A face between two elements occurs twice and is not on the surface.
                if seen.remove(&key).is_none() {
                    seen.insert(key, (order, nodes));
                }
            }
        }
        let mut faces: Vec<(usize, Vec<usize>)> = seen.into_values().collect();
        faces.sort_unstable();
        faces.into_iter().map(|(_, nodes)| nodes).collect()
    }

    /// Mean unit normal of faces, of either sense; 0 without area. The faces may be listed either way round.
    pub fn mean_normal(&self, faces: &[Vec<usize>]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for face in faces {
            let nodes_m = self.corners_m(face);
            // Corners come first; this is the area vector of a polygon of any number of them.
            let corners = &nodes_m[..face.len() / 2];
            let mut area = [0.0; 3];
            for (n, x) in corners.iter().enumerate() {
                let y = corners[(n + 1) % corners.len()];
                for (i, entry) in area.iter_mut().enumerate() {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    *entry += 0.5 * (x[j] * y[k] - x[k] * y[j]);
                }
            }
            let along: f64 = sum.iter().zip(&area).map(|(s, a)| s * a).sum();
            let sense = if along < 0.0 { -1.0 } else { 1.0 };
            sum.iter_mut().zip(area).for_each(|(s, a)| *s += sense * a);
        }
        let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
        match length > 0.0 {
            true => sum.map(|c| c / length),
            false => [0.0; 3],
        }
    }

    /// Nodal weights of a uniform distribution over faces.
    pub fn face_weights(&self, faces: &[Vec<usize>]) -> FaceWeights {
        let mut sums = vec![0.0; self.nodes_m.len()];
        let mut used = vec![false; self.nodes_m.len()];
        let mut area_m2 = 0.0;
        for face in faces {
            let (single, _) = face_integrals(&self.corners_m(face));
            for (&node, weight) in face.iter().zip(single) {
                sums[node] += weight;
                used[node] = true;
                area_m2 += weight;
            }
        }
        let kept = (0..sums.len()).filter(|&a| used[a]);
        FaceWeights {
            area_m2,
            nodes: kept.map(|a| (a, sums[a])).collect(),
        }
    }
}
