//! Writes a mesh in Gmsh's format.

use super::elements::{HEXAHEDRON, TETRAHEDRON};
use super::mesh::{BODY, MeshFile, Solid};
use std::collections::HashSet;
use std::fmt::Write as _;

/// Text of a mesh, format 4.1 in ASCII: one volume named [`BODY`], a surface for each name, numbers with
/// all their digits. [`super::read`] gives the same mesh back.
///
/// Faces with nodes outside the solid are not written, because no element has them; nor are surfaces of such faces
/// only.
pub fn write(mesh: &MeshFile) -> String {
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let surfaces = surfaces(mesh);
    let n_surfaces = surfaces.len();
    let _ = writeln!(text, "$PhysicalNames\n{}", n_surfaces + 1);
    for (number, name) in (1..).zip(surfaces.iter().map(|surface| surface.0)) {
        // A name of blanks alone is a name; nothing between the quotes is none.
        let name = if name.is_empty() { " " } else { name };
        let _ = writeln!(text, "2 {number} \"{name}\"");
    }
    let _ = writeln!(text, "3 1 \"{BODY}\"\n$EndPhysicalNames");
    // Points and curves are not needed; every box is that of the whole solid.
    let _ = writeln!(text, "$Entities\n0 0 {n_surfaces} 1");
    let [low, high] = bounds(&mesh.nodes);
    let box_of = |number: usize| {
        let [a, b] = [low, high].map(|[x, y, z]| format!("{x:?} {y:?} {z:?}"));
        format!("{number} {a} {b} 1 {number} 0\n")
    };
    (1..=n_surfaces).for_each(|number| text += &box_of(number));
    text += &box_of(1);
    text += "$EndEntities\n";
    nodes(mesh, &mut text);
    elements(mesh, &surfaces, &mut text);
    text
}

/// Names of the surfaces with the nodes of each face.
type Surfaces<'a> = Vec<(&'a str, Vec<&'a [usize]>)>;

fn surfaces(mesh: &MeshFile) -> Surfaces<'_> {
    let inside = |nodes: &&[usize]| nodes.iter().all(|&node| node < mesh.nodes.len());
    let all = mesh.surfaces.iter().map(|(name, list)| {
        let faces = list.iter().map(|face| &face.nodes[..]).filter(inside);
        (name.as_str(), faces.collect::<Vec<_>>())
    });
    all.filter(|(_, faces)| !faces.is_empty()).collect()
}

/// Corners of the box around some places.
fn bounds(places: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let first = places.first().copied().unwrap_or_default();
    places.iter().fold([first; 2], |[low, high], place| {
        [
            std::array::from_fn(|i| low[i].min(place[i])),
            std::array::from_fn(|i| high[i].max(place[i])),
        ]
    })
}

/// Lowest and highest of some numbers.
fn ends(tags: &[usize]) -> [usize; 2] {
    let ends = [tags.iter().min(), tags.iter().max()];
    ends.map(|end| end.copied().unwrap_or(0))
}

fn nodes(mesh: &MeshFile, text: &mut String) {
    let n = mesh.nodes.len();
    let [low, high] = ends(&mesh.node_tags);
    let _ = writeln!(text, "$Nodes\n1 {n} {low} {high}\n3 1 0 {n}");
    for tag in &mesh.node_tags {
        let _ = writeln!(text, "{tag}");
    }
    for [x, y, z] in &mesh.nodes {
        let _ = writeln!(text, "{x:?} {y:?} {z:?}");
    }
    *text += "$EndNodes\n";
}

/// Elements of one type on one entity.
struct Block {
    /// `dimension entity type`.
    head: String,
    /// Number of each element.
    tags: Vec<usize>,
    /// Its nodes.
    nodes: Vec<Vec<usize>>,
}

fn elements(mesh: &MeshFile, surfaces: &Surfaces<'_>, text: &mut String) {
    // Faces have no numbers of their own; they get unused ones.
    let taken: HashSet<usize> = mesh.element_tags.iter().copied().collect();
    let mut free = (1..).filter(|tag| !taken.contains(tag));
    let mut blocks = Vec::new();
    for (number, (_, faces)) in (1..).zip(surfaces) {
        for alike in faces.chunk_by(|a, b| a.len() == b.len()) {
            let gmsh_type = if alike[0].len() == 6 { 9 } else { 16 };
            blocks.push(Block {
                head: format!("2 {number} {gmsh_type}"),
                tags: free.by_ref().take(alike.len()).collect(),
                nodes: alike.iter().map(|nodes| nodes.to_vec()).collect(),
            });
        }
    }
    let (gmsh_type, order): (_, &[usize]) = match mesh.solid {
        Solid::Tetrahedron => (11, &TETRAHEDRON),
        Solid::Hexahedron => (17, &HEXAHEDRON),
    };
    let solids = mesh.connectivity.chunks_exact(order.len());
    blocks.push(Block {
        head: format!("3 1 {gmsh_type}"),
        tags: mesh.element_tags.clone(),
        nodes: solids
            .map(|solid| {
                let mut there = vec![0; order.len()];
                order
                    .iter()
                    .zip(solid)
                    .for_each(|(&k, &node)| there[k] = node);
                there
            })
            .collect(),
    });
    let tags: Vec<usize> = blocks
        .iter()
        .flat_map(|block| &block.tags)
        .copied()
        .collect();
    let [low, high] = ends(&tags);
    let (n_blocks, n) = (blocks.len(), tags.len());
    let _ = writeln!(text, "$Elements\n{n_blocks} {n} {low} {high}");
    for Block { head, tags, nodes } in &blocks {
        let _ = writeln!(text, "{head} {}", tags.len());
        for (tag, nodes) in tags.iter().zip(nodes) {
            let _ = write!(text, "{tag}");
            for &node in nodes {
                let _ = write!(text, " {}", mesh.node_tags[node]);
            }
            text.push('\n');
        }
    }
    *text += "$EndElements\n";
}
