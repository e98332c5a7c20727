//! Contents of the sections of a `.msh` file, and the solid built from them.

use super::mesh::{BODY, Face, MeshFile, Solid};
use crate::fault::{Fault, Faults};
use std::collections::{BTreeMap, HashMap};

/// Contents of the sections.
#[derive(Default)]
pub(super) struct Found {
    /// Names of physical groups by dimension and number.
    pub(super) names: HashMap<(usize, usize), String>,
    /// Physical groups of surfaces and volumes, by dimension and number.
    pub(super) groups: HashMap<(usize, usize), Vec<usize>>,
    pub(super) has_entities: bool,
    pub(super) nodes: Vec<[f64; 3]>,
    pub(super) node_tags: Vec<usize>,
    pub(super) by_tag: HashMap<usize, usize>,
    pub(super) has_nodes: bool,
    pub(super) solids: Vec<Element>,
    pub(super) faces: Vec<Element>,
}

/// An element as it stands in the file.
pub(super) struct Element {
    pub(super) tag: usize,
    pub(super) entity: usize,
    pub(super) line: usize,
    pub(super) solid: Option<Solid>,
    pub(super) nodes: Vec<usize>,
}

impl Found {
    /// Names of the physical groups that an element is in.
    fn names_of(&self, dimension: usize, entity: usize) -> impl Iterator<Item = &str> {
        let groups = self.groups.get(&(dimension, entity)).into_iter().flatten();
        groups.filter_map(move |group| self.names.get(&(dimension, *group)).map(String::as_str))
    }

    pub(super) fn finish(mut self, file: &str) -> Result<MeshFile, Faults> {
        let missing = |section: &str| {
            let fault = Fault::of("E160", file, "a section is missing");
            Faults::from(fault.what(section).allowed(format!("${section}")))
        };
        if !self.has_nodes {
            return Err(missing("Nodes"));
        }
        if !self.has_entities {
            return Err(missing("Entities"));
        }
        let named = self
            .names
            .iter()
            .any(|((d, _), name)| *d == 3 && name == BODY);
        let solids = std::mem::take(&mut self.solids);
        let solids: Vec<Element> = solids
            .into_iter()
            .filter(|e| !named || self.names_of(3, e.entity).any(|name| name == BODY))
            .collect();
        let Some(solid) = solids.first().and_then(|element| element.solid) else {
            return Err(Fault::of("E178", file, "the mesh has no solid element")
                .allowed("quadratic tetrahedra (11) or hexahedra (17, 12)")
                .hint("mesh in three dimensions, and save the physical volume")
                .into());
        };
        if let Some(other) = solids.iter().find(|element| element.solid != Some(solid)) {
            return Err(
                Fault::of("E178", file, "tetrahedra and hexahedra in one solid")
                    .line(other.line)
                    .what(format!("element {}", other.tag))
                    .allowed("elements of one kind")
                    .into(),
            );
        }
        // Only nodes of the solid: Gmsh also has those of points, of constructions, of the middle of
        // hexahedra.
        let mut place = vec![usize::MAX; self.nodes.len()];
        let mut mesh = MeshFile {
            file: file.to_owned(),
            solid,
            nodes: Vec::new(),
            node_tags: Vec::new(),
            connectivity: Vec::with_capacity(solids.len() * solid.n_nodes()),
            element_tags: solids.iter().map(|element| element.tag).collect(),
            surfaces: BTreeMap::new(),
        };
        for node in solids.iter().flat_map(|element| &element.nodes) {
            if place[*node] == usize::MAX {
                place[*node] = mesh.nodes.len();
                mesh.nodes.push(self.nodes[*node]);
                mesh.node_tags.push(self.node_tags[*node]);
            }
            mesh.connectivity.push(place[*node]);
        }
        for face in &self.faces {
            for name in self.names_of(2, face.entity) {
                // A node outside the solid: then the face belongs to none of its elements.
                mesh.surfaces
                    .entry(name.to_owned())
                    .or_default()
                    .push(Face {
                        nodes: face.nodes.iter().map(|&node| place[node]).collect(),
                        line: face.line,
                    });
            }
        }
        Ok(mesh)
    }
}
