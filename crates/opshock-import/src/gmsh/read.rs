//! The sections of a `.msh` file.

use super::elements::{Kind, kind};
use super::mesh::{BODY, Face, MeshFile, Solid};
use crate::fault::{Fault, Faults};
use crate::text::{Line, NotANumber, Source, Word};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::iter::Peekable;

/// Reads a file.
///
/// # Errors
/// E160 for a file that is none of Gmsh or is cut short; E173 for another version and for a binary
/// one; E177 for words that are no numbers, counts that are not those told, nodes that are not there
/// or are there twice; E178 for elements that are not read, and for none.
pub fn read(source: &Source) -> Result<MeshFile, Faults> {
    let mut reader = Reader {
        file: &source.name,
        lines: source.lines().peekable(),
        words: Vec::new().into_iter(),
        last: 0,
    };
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

/// What the sections hold.
#[derive(Default)]
struct Found {
    /// Names of physical groups by dimension and number.
    names: HashMap<(usize, usize), String>,
    /// Physical groups of surfaces and volumes, by dimension and number.
    groups: HashMap<(usize, usize), Vec<usize>>,
    has_entities: bool,
    nodes: Vec<[f64; 3]>,
    node_tags: Vec<usize>,
    by_tag: HashMap<usize, usize>,
    has_nodes: bool,
    solids: Vec<Element>,
    faces: Vec<Element>,
}

/// An element as it stands in the file.
struct Element {
    tag: usize,
    entity: usize,
    line: usize,
    solid: Option<Solid>,
    nodes: Vec<usize>,
}

struct Reader<'a, L: Iterator<Item = Line<'a>>> {
    file: &'a str,
    lines: Peekable<L>,
    words: std::vec::IntoIter<Word<'a>>,
    /// Line read last.
    last: usize,
}

fn is_mark(line: &Line<'_>) -> bool {
    line.text.trim_start().starts_with('$')
}

impl<'a, L: Iterator<Item = Line<'a>>> Reader<'a, L> {
    fn line(&mut self) -> Option<Line<'a>> {
        let line = self.lines.next()?;
        self.last = line.number;
        Some(line)
    }

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
        let number = self.last;
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

    /// The line that opens the next section.
    fn next_section(&mut self) -> Option<Line<'a>> {
        self.words = Vec::new().into_iter();
        loop {
            let line = self.line()?;
            if is_mark(&line) {
                return Some(line);
            }
        }
    }

    /// Leaves the lines before the next mark.
    fn skip(&mut self) {
        self.words = Vec::new().into_iter();
        while self.lines.peek().is_some_and(|line| !is_mark(line)) {
            self.line();
        }
    }

    /// The mark that closes a section, with nothing before it.
    fn end(&mut self, name: &str, opened: usize) -> Result<(), Faults> {
        let too_many = |word: Word<'_>| {
            Fault::of("E177", self.file, "more words than the counts tell")
                .at(word.place())
                .what(name)
                .value(word.text)
                .allowed(format!("$End{name}"))
        };
        if let Some(word) = self.words.next() {
            return Err(too_many(word).into());
        }
        while let Some(line) = self.line() {
            if line.text.trim() == format!("$End{name}") {
                return Ok(());
            }
            if let Some(word) = line.words().next() {
                let fault = Fault::of("E177", self.file, "more words than the counts tell");
                return Err(fault
                    .at(word.place())
                    .what(name)
                    .value(word.text)
                    .allowed(format!("$End{name}"))
                    .into());
            }
        }
        let fault = Fault::of("E160", self.file, "the file is cut short");
        Err(fault
            .line(opened)
            .what(name)
            .allowed(format!("$End{name}"))
            .into())
    }

    /// The next word of the section.
    fn word(&mut self, what: &str) -> Result<Word<'a>, Faults> {
        loop {
            if let Some(word) = self.words.next() {
                return Ok(word);
            }
            match self.lines.peek() {
                Some(line) if !is_mark(line) => {
                    let words: Vec<Word<'a>> = line.words().collect();
                    self.words = words.into_iter();
                    self.line();
                }
                Some(_) => {
                    let fault = Fault::of("E177", self.file, "fewer words than the counts tell");
                    return Err(fault.line(self.last).what(what).allowed("a number").into());
                }
                None => {
                    let fault = Fault::of("E160", self.file, "the file is cut short");
                    return Err(fault.line(self.last).what(what).allowed("a number").into());
                }
            }
        }
    }

    fn count(&mut self, what: &str) -> Result<usize, Faults> {
        let word = self.word(what)?;
        word.count().ok_or_else(|| {
            let fault = Fault::of("E177", self.file, "not a whole number from 0");
            fault.at(word.place()).what(what).value(word.text).into()
        })
    }

    /// A number of an entity or group: below 0 where it is turned round.
    fn signed(&mut self, what: &str) -> Result<usize, Faults> {
        let word = self.word(what)?;
        let number = word
            .integer()
            .and_then(|n| usize::try_from(n.unsigned_abs()).ok());
        number.ok_or_else(|| {
            let fault = Fault::of("E177", self.file, "not a whole number");
            fault.at(word.place()).what(what).value(word.text).into()
        })
    }

    fn real(&mut self, what: &str) -> Result<f64, Faults> {
        let word = self.word(what)?;
        word.real().map_err(|wrong| {
            let message = match wrong {
                NotANumber::Comma => "a comma in a number",
                NotANumber::NotFinite => "the value is not finite, or 1e300 and more",
                NotANumber::Word => "the value is no number",
            };
            let fault = Fault::of("E177", self.file, message);
            fault
                .at(word.place())
                .what(what)
                .value(word.text)
                .allowed("a number with a decimal point")
                .into()
        })
    }

    /// The line of the word read last.
    fn at(&self) -> usize {
        self.last
    }

    /// `dimension number "name"`, a line each.
    fn names(&mut self, found: &mut Found) -> Result<(), Faults> {
        let n = self.count("physical names")?;
        for _ in 0..n {
            let dimension = self.count("dimension of a name")?;
            let number = self.signed("number of a name")?;
            // A name may hold blanks: it is what stands between the quotes.
            let line = self.at();
            let words: Vec<&str> = self.words.by_ref().map(|word| word.text).collect();
            let text = words.join(" ");
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
        let told = self.count("nodes")?;
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
        self.as_told("nodes", told, found.nodes.len())
    }

    fn as_told(&self, what: &str, told: usize, there: usize) -> Result<(), Faults> {
        if told == there {
            return Ok(());
        }
        let fault = Fault::of("E177", self.file, "another number than the section tells");
        Err(fault
            .line(self.at())
            .what(what)
            .value(there.to_string())
            .allowed(told.to_string())
            .into())
    }

    fn elements(&mut self, found: &mut Found) -> Result<(), Faults> {
        let n_blocks = self.count("blocks of elements")?;
        let told = self.count("elements")?;
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
        self.as_told("elements", told, there)
    }
}

impl Found {
    /// Names of the physical groups that an element is in.
    fn names_of(&self, dimension: usize, entity: usize) -> impl Iterator<Item = &str> {
        let groups = self.groups.get(&(dimension, entity)).into_iter().flatten();
        groups.filter_map(move |group| self.names.get(&(dimension, *group)).map(String::as_str))
    }

    fn finish(mut self, file: &str) -> Result<MeshFile, Faults> {
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
                // A node outside the solid makes a face of none of its elements.
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
