//! Stiffness and mass matrices of a mesh supported at some of its nodes, and its load under base acceleration.
//!
//! ```text
//! M u'' + K u = W λ + M 1z a(t)        u relative to the base, a(t) the inertia load per mass
//! ```
//!
//! Fixed unknowns are removed from the equations; their mass stays in the load of the others. An elastic mount adds ∫ k
//! N Nᵀ dA over its faces to K.

use crate::element::{self, face_integrals};
use crate::material::{Material, MaterialError};
use crate::mesh::{Mesh, MeshError};
use crate::sparse::{SymmetricMatrix, SymmetricPattern};
use std::sync::Arc;

/// An unknown that does not move.
const HELD: usize = usize::MAX;

/// A mesh of one material on its base.
#[derive(Clone, Debug)]
pub struct Support<'a> {
    /// Displacements held at 0: node and direction (0 to 2 for x to z).
    pub held: Vec<(usize, usize)>,
    /// Faces on springs, with stiffness per area in each direction, N/m³.
    pub elastic: Vec<ElasticFaces<'a>>,
}

/// Faces on springs.
#[derive(Clone, Copy, Debug)]
pub struct ElasticFaces<'a> {
    /// Nodes of each face.
    pub faces: &'a [Vec<usize>],
    /// Stiffness per area in x, y, z, N/m³.
    pub stiffness_n_per_m3: [f64; 3],
}

/// Equations of motion of a mesh on its base.
#[derive(Clone, Debug)]
pub struct SolidSystem {
    /// Stiffness, N/m.
    pub stiffness: SymmetricMatrix,
    /// Mass, kg, of the same pattern.
    pub mass: SymmetricMatrix,
    /// Load of a unit inertia load per mass in x, y, z, kg.
    pub base_load_kg: [Vec<f64>; 3],
    /// Mass of the whole mesh, kg.
    pub total_mass_kg: f64,
    unknown: Vec<[usize; 3]>,
}

/// Errors of assembling a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssemblyError {
    /// Mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// Every node is fixed.
    #[error("every node of the mesh is held")]
    NothingMoves,
}

impl SolidSystem {
    /// Assembles the elements of a mesh.
    ///
    /// # Errors
    /// An invalid mesh or material, a folded element, or no free unknown.
    ///
    /// # Panics
    /// When the support names a node or direction that is not there.
    pub fn assemble(
        mesh: &Mesh,
        material: &Material,
        support: &Support<'_>,
    ) -> Result<Self, AssemblyError> {
        mesh.validate()?;
        material.validate()?;
        let mut unknown = vec![[0; 3]; mesh.nodes_m.len()];
        for &(node, direction) in &support.held {
            unknown[node][direction] = HELD;
        }
        let mut n = 0;
        for slot in unknown.iter_mut().flatten() {
            if *slot != HELD {
                *slot = n;
                n += 1;
            }
        }
        if n == 0 {
            return Err(AssemblyError::NothingMoves);
        }
        let pattern = Arc::new(pattern(mesh, &unknown, n));
        let mut system = Self {
            stiffness: SymmetricMatrix::zeros(Arc::clone(&pattern)),
            mass: SymmetricMatrix::zeros(pattern),
            base_load_kg: std::array::from_fn(|_| vec![0.0; n]),
            total_mass_kg: 0.0,
            unknown,
        };
        let stations = mesh.shape.stations();
        for (k, nodes) in mesh.elements().enumerate() {
            let matrices = element::matrices(&stations, &mesh.corners_m(nodes), material).map_err(
                |fault| MeshError::Folded {
                    element: k,
                    determinant: fault.determinant,
                },
            )?;
            system.add_element(nodes, &matrices);
        }
        for springs in &support.elastic {
            system.add_springs(mesh, springs);
        }
        Ok(system)
    }

    /// Equations from matrices that another program assembled, both of one pattern.
    ///
    /// `base_load_kg` is M times a unit displacement of all nodes along x, y, z. Nodes are unknown here:
    /// [`SolidSystem::unknown`] returns `None`.
    ///
    /// # Panics
    /// When a load has another length than the matrices.
    pub fn of_matrices(
        stiffness: SymmetricMatrix,
        mass: SymmetricMatrix,
        base_load_kg: [Vec<f64>; 3],
        total_mass_kg: f64,
    ) -> Self {
        let n = mass.order();
        assert!(base_load_kg.iter().all(|load| load.len() == n) && stiffness.order() == n);
        Self {
            stiffness,
            mass,
            base_load_kg,
            total_mass_kg,
            unknown: Vec::new(),
        }
    }

    /// The equations of `copies` equal solids side by side, with the same motion.
    #[must_use]
    pub fn times(mut self, copies: f64) -> Self {
        self.stiffness = self.stiffness.scaled(copies);
        self.mass = self.mass.scaled(copies);
        self.base_load_kg
            .iter_mut()
            .flatten()
            .for_each(|x| *x *= copies);
        self.total_mass_kg *= copies;
        self
    }

    /// Unknowns.
    pub fn order(&self) -> usize {
        self.mass.order()
    }

    /// Index of a displacement in the equations; `None` when it is held.
    pub fn unknown(&self, node: usize, direction: usize) -> Option<usize> {
        let unknown = self.unknown.get(node)?;
        Some(unknown[direction]).filter(|&i| i != HELD)
    }

    /// The column that gives Σ weight × displacement; as a load, it distributes a force with the same weights.
    pub fn column(&self, weights: &[(usize, f64)], direction: usize) -> Vec<f64> {
        let mut column = vec![0.0; self.order()];
        for &(node, weight) in weights {
            if let Some(i) = self.unknown(node, direction) {
                column[i] += weight;
            }
        }
        column
    }

    fn add_element(&mut self, nodes: &[usize], matrices: &element::ElementMatrices) {
        let n = nodes.len();
        for (a, &node_a) in nodes.iter().enumerate() {
            for i in 0..3 {
                let row = self.unknown[node_a][i];
                if row == HELD {
                    continue;
                }
                let of_row = &matrices.stiffness[(3 * a + i) * 3 * n..][..3 * n];
                for (b, &node_b) in nodes.iter().enumerate() {
                    let mass = matrices.mass[a * n + b];
                    self.base_load_kg[i][row] += mass;
                    for j in 0..3 {
                        let column = self.unknown[node_b][j];
                        if column <= row {
                            self.stiffness.add(row, column, of_row[3 * b + j]);
                            if i == j {
                                self.mass.add(row, column, mass);
                            }
                        }
                    }
                }
            }
        }
        self.total_mass_kg += matrices.mass.iter().sum::<f64>();
    }

    fn add_springs(&mut self, mesh: &Mesh, springs: &ElasticFaces<'_>) {
        for face in springs.faces {
            let (_, double) = face_integrals(&mesh.corners_m(face));
            let n = face.len();
            for (a, &node_a) in face.iter().enumerate() {
                for (b, &node_b) in face.iter().enumerate() {
                    for (i, stiffness) in springs.stiffness_n_per_m3.into_iter().enumerate() {
                        let (row, column) = (self.unknown[node_a][i], self.unknown[node_b][i]);
                        if row != HELD && column <= row {
                            self.stiffness
                                .add(row, column, stiffness * double[a * n + b]);
                        }
                    }
                }
            }
        }
    }
}

/// Entries of the lower triangle: every pair of unknowns of one element.
fn pattern(mesh: &Mesh, unknown: &[[usize; 3]], n: usize) -> SymmetricPattern {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); mesh.nodes_m.len()];
    for nodes in mesh.elements() {
        for &a in nodes {
            neighbours[a].extend_from_slice(nodes);
        }
    }
    let mut column_start = Vec::with_capacity(n + 1);
    let mut rows = Vec::new();
    for (node, list) in neighbours.iter_mut().enumerate() {
        list.sort_unstable();
        list.dedup();
        for column in unknown[node] {
            if column == HELD {
                continue;
            }
            column_start.push(rows.len());
            // Unknowns rise with their nodes.
            let below = list.iter().flat_map(|&b| unknown[b]);
            rows.extend(below.filter(|&row| row != HELD && row >= column));
        }
    }
    column_start.push(rows.len());
    SymmetricPattern::new(column_start, rows)
}
