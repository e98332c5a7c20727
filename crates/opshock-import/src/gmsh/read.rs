//! Reads the sections of a Gmsh mesh file (`.msh`).

use super::elements::{Kind, kind};
use super::found::{Element, Found};
use super::mesh::MeshFile;
use super::words::Reader;
use crate::fault::{Fault, Faults};
use crate::text::{Line, Source};
use std::collections::HashSet;

/// Reads a file.
///
/// # Errors
/// E160 for a file that is not Gmsh's or is cut short; E173 for another version and for a binary file; E177 for words
/// that are no numbers, numbers of items other than declared, and nodes that are missing or repeated; E178 for elements
/// that are not read, and for a mesh without elements.
pub fn read(source: &Source) -> Result<MeshFile, Faults> {
    let mut reader = Reader::new(&source.name, source.lines());
    reader.header()?;
    let mut found = Found::default();
    while let Some(line) = reader.next_section() {
        let name = line.text.trim().trim_start_matches('$').to_owned();
        match name.as_str() {
            "PhysicalNames" => reader.names(&mut found)?,
            "Entities" => reader.entities(&mut found)?,
            "Nodes" => reader.nodes(&mut found)?,
            "Elements" => reader.elements(&mut found)?,
            "PartitionedEntities" => {
                let fault = Fault::of("E173", reader.file, "the mesh is partitioned");
                return Err(fault
                    .line(line.number)
                    .allowed("one partition")
                    .hint("save it without partitions")
                    .into());
            }
            // Periodicity, results on the mesh, comments: not read.
            _ => reader.skip(),
        }
        reader.end(&name, line.number)?;
    }
    found.finish(&source.name)
}

impl<'a, L: Iterator<Item = Line<'a>>> Reader<'a, L> {
    /// The version, in the first section.
    fn header(&mut self) -> Result<(), Faults> {
        let first = self.next_section();
        if first.is_none_or(|line| line.text.trim() != "$MeshFormat") {
            let fault = Fault::of("E160", self.file, "not a Gmsh mesh").line(1);
            return Err(fault
                .allowed("$MeshFormat in its first line")
                .hint("save as .msh, version 4.1, ASCII")
                .into());
        }
        let number = self.at();
        let version = self.word("version")?;
        let binary = self.word("file type")?;
        if !matches!(version.text, "4.1") {
            let fault = Fault::of("E173", self.file, "another version of the format");
            return Err(fault
                .at(version.place())
                .what("version")
                .value(version.text)
                .allowed("4.1")
                .hint("gmsh FILE -save -format msh41 -o FILE")
                .into());
        }
        if binary.text != "0" {
            let fault = Fault::of("E173", self.file, "the file is binary");
            return Err(fault
                .at(binary.place())
                .what("file type")
                .value(binary.text)
                .allowed("0, ASCII")
                .hint("save it with -bin 0")
                .into());
        }
        self.skip();
        self.end("MeshFormat", number)
    }

    /// `dimension number "name"`, a line each.
    fn names(&mut self, found: &mut Found) -> Result<(), Faults> {
        let n = self.count("physical names")?;
        for _ in 0..n {
            let dimension = self.count("dimension of a name")?;
            let number = self.signed("number of a name")?;
            // A name may hold blanks: it is what stands between the quotes.
            let line = self.at();
            let text = self.rest_of_line();
            let name = text
                .strip_prefix('"')
                .and_then(|rest| rest.strip_suffix('"'));
            let Some(name) = name.filter(|name| !name.is_empty()) else {
                let fault = Fault::of("E177", self.file, "a name without quotes");
                return Err(fault
                    .line(line)
                    .what("physical name")
                    .value(text)
                    .allowed("dimension number \"name\"")
                    .into());
            };
            let name = name.trim().to_lowercase();
            if found.names.insert((dimension, number), name).is_some() {
                let fault = Fault::of("E177", self.file, "the group is named twice");
                return Err(fault.line(line).what(format!("group {number}")).into());
            }
        }
        Ok(())
    }

    /// Which physical groups each surface and volume is in.
    fn entities(&mut self, found: &mut Found) -> Result<(), Faults> {
        found.has_entities = true;
        let mut counts = [0; 4];
        for (count, what) in counts
            .iter_mut()
            .zip(["points", "curves", "surfaces", "volumes"])
        {
            *count = self.count(what)?;
        }
        for (dimension, n) in counts.into_iter().enumerate() {
            for _ in 0..n {
                let number = self.signed("number of an entity")?;
                // A point has its position, the others their box.
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    self.real("position of an entity")?;
                }
                let n_groups = self.count("number of groups")?;
                for _ in 0..n_groups {
                    let group = self.signed("group of an entity")?;
                    found
                        .groups
                        .entry((dimension, number))
                        .or_default()
                        .push(group);
                }
                if dimension > 0 {
                    let n_bounds = self.count("number of bounding entities")?;
                    for _ in 0..n_bounds {
                        self.signed("bounding entity")?;
                    }
                }
            }
        }
        Ok(())
    }

    fn nodes(&mut self, found: &mut Found) -> Result<(), Faults> {
        found.has_nodes = true;
        let n_blocks = self.count("blocks of nodes")?;
        let declared = self.count("nodes")?;
        self.count("lowest number of a node")?;
        self.count("highest number of a node")?;
        for _ in 0..n_blocks {
            self.count("dimension of a block")?;
            self.signed("entity of a block")?;
            let parametric = self.count("parametric")?;
            if parametric > 0 {
                let fault = Fault::of("E173", self.file, "nodes with parameters of their surface");
                return Err(fault
                    .line(self.at())
                    .what("parametric")
                    .value(parametric.to_string())
                    .allowed("0")
                    .hint("save it with Mesh.SaveParametric = 0")
                    .into());
            }
            let n = self.count("nodes of a block")?;
            let first = found.node_tags.len();
            for _ in 0..n {
                let tag = self.count("number of a node")?;
                if found.by_tag.insert(tag, found.node_tags.len()).is_some() {
                    let fault = Fault::of("E177", self.file, "the node is there twice");
                    return Err(fault.line(self.at()).what(format!("node {tag}")).into());
                }
                found.node_tags.push(tag);
            }
            for k in first..found.node_tags.len() {
                let mut place = [0.0; 3];
                for (value, axis) in place.iter_mut().zip(["x", "y", "z"]) {
                    *value = self.real(axis).map_err(|mut faults| {
                        for fault in &mut faults.listed {
                            fault.what = format!("{axis} of node {}", found.node_tags[k]);
                        }
                        faults
                    })?;
                }
                found.nodes.push(place);
            }
        }
        self.as_declared("nodes", declared, found.nodes.len())
    }

    fn elements(&mut self, found: &mut Found) -> Result<(), Faults> {
        let n_blocks = self.count("blocks of elements")?;
        let declared = self.count("elements")?;
        self.count("lowest number of an element")?;
        self.count("highest number of an element")?;
        let mut there = 0;
        let mut tags = HashSet::new();
        for _ in 0..n_blocks {
            let dimension = self.count("dimension of a block")?;
            let entity = self.signed("entity of a block")?;
            let gmsh_type = self.count("type of elements")?;
            let line = self.at();
            let n = self.count("elements of a block")?;
            let refused = |name: &str| {
                let fault = Fault::of("E178", self.file, "elements that are not read").line(line);
                fault
                    .what(format!("type {gmsh_type}"))
                    .value(name)
                    .allowed("quadratic tetrahedra (11) or hexahedra (17, 12) with their faces")
                    .hint("mesh with Mesh.ElementOrder = 2, without prisms and pyramids")
            };
            let Some((kind, n_nodes)) = kind(gmsh_type) else {
                return Err(refused("unknown").into());
            };
            if let Kind::Refused(name) = kind {
                return Err(refused(name).into());
            }
            for _ in 0..n {
                let tag = self.count("number of an element")?;
                let line = self.at();
                if !tags.insert(tag) {
                    let fault = Fault::of("E177", self.file, "the element is there twice");
                    return Err(fault.line(line).what(format!("element {tag}")).into());
                }
                let mut nodes = Vec::new();
                for _ in 0..n_nodes {
                    let number = self.count("node of an element")?;
                    let Some(&node) = found.by_tag.get(&number) else {
                        let fault = Fault::of("E177", self.file, "the element's node is not there");
                        return Err(fault
                            .line(self.at())
                            .what(format!("element {tag}"))
                            .value(format!("node {number}"))
                            .hint(match found.has_nodes {
                                true => "",
                                false => "$Nodes comes before $Elements",
                            })
                            .into());
                    };
                    nodes.push(node);
                }
                there += 1;
                let (nodes, solid, list) = match kind {
                    Kind::Solid(solid, order) if dimension == 3 => {
                        let nodes = order.iter().map(|&k| nodes[k]).collect();
                        (nodes, Some(solid), &mut found.solids)
                    }
                    Kind::Face(n) if dimension == 2 => {
                        nodes.truncate(n);
                        (nodes, None, &mut found.faces)
                    }
                    Kind::Solid(..) | Kind::Face(_) => {
                        let fault = Fault::of("E177", self.file, "elements of another dimension");
                        return Err(fault
                            .line(line)
                            .what(format!("type {gmsh_type}"))
                            .value(dimension.to_string())
                            .into());
                    }
                    Kind::Left | Kind::Refused(_) => continue,
                };
                list.push(Element {
                    tag,
                    entity,
                    line,
                    solid,
                    nodes,
                });
            }
        }
        self.as_declared("elements", declared, there)
    }
}
