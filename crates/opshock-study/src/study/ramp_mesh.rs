//! Reduces a deformable ramp given by a mesh of the user, a file of Gmsh, to oscillators.
//!
//! The file is read with the study, so that what is simulated, stored and compared is the ramp as it
//! was then: its oscillators take the place of the table, as samples take that of a pulse's file.
//! They are rounded to nine digits, as those of a ramp given by its geometry.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use opshock_import::gmsh::{self, MeshFile, Solid};
use opshock_import::text;
use opshock_import::{Fault, Faults};
use opshock_solid::assembly::AssemblyError;
use opshock_solid::element::Shape;
use opshock_solid::mesh::{Mesh, MeshError};
use opshock_solid::ramp::{Mount, RampFaces, RampMesh, RampModes, ShapeError, SolidRampError};

use super::fault::StudyError;
use super::field::Field;
use super::fields;
use super::included::Location;
use super::keys;
use super::ramp_geometry::{RampSolid, SolidFields, rounded};
use super::read::Reader;
use super::settings::View;
use super::source::{Origin, Source};
use super::tree;
use super::words;
use crate::search::Ramp;

/// Table of the mesh.
pub const TABLE: &str = "ramp.deformable.mesh";
/// Keys of its solid.
const OF_MESH: SolidFields = SolidFields {
    material: fields::RAMP_DEFORMABLE_MESH_MATERIAL,
    replaced: [
        fields::RAMP_DEFORMABLE_MESH_YOUNGS_MODULUS_GPA,
        fields::RAMP_DEFORMABLE_MESH_POISSON,
        fields::RAMP_DEFORMABLE_MESH_DENSITY_KG_PER_M3,
    ],
    mount: [
        fields::RAMP_DEFORMABLE_MESH_MOUNT_NORMAL_N_PER_M,
        fields::RAMP_DEFORMABLE_MESH_MOUNT_TANGENTIAL_N_PER_M,
    ],
    cut: fields::RAMP_DEFORMABLE_MESH_CUT_KHZ,
};
/// List that takes its place.
pub const MODES: &str = fields::RAMP_DEFORMABLE_COUPLED_MODES.path();
/// Nodes at most: two gigabytes and a quarter of a minute.
const MOST_NODES: usize = 25_000;
/// Longest edge of the box around a ramp, m.
const SIZE_M: std::ops::RangeInclusive<f64> = 0.5e-3..=0.1;
/// Difference between the contacts' gap and disk with clearances from which on a note says so, m.
const SLOT_M: f64 = 2e-6;

/// Reads the mesh a study names, if it wants a deformable ramp, into the list of oscillators.
pub fn read(reader: &mut Reader, location: &Location) {
    let file_key = fields::RAMP_DEFORMABLE_MESH_FILE.path();
    let needed = [
        TABLE,
        fields::RAMP_MODELS.path(),
        fields::DISK_THICKNESS_MM.path(),
        fields::RAMP_CLEARANCE_UM.path(),
    ];
    let view = View::first(&reader.settings);
    let is_wanted = view.get(&fields::RAMP_MODELS).contains(&Ramp::Deformable);
    let named = view.get(&fields::RAMP_DEFORMABLE_MESH_FILE).to_owned();
    if named.is_empty() && view.get(&OF_MESH.material).is_empty() {
        // Modes of the command line leave them without their file.
        if !reader.settings.has(MODES) {
            lonely(reader, TABLE, "a mesh", "file and material");
        }
        return;
    }
    if named.is_empty() || !is_wanted || !reader.settings.are_sound(&needed) {
        return;
    }
    let answer = ramp(&view, &location.folder.join(&named));
    let place = view.place(file_key).cloned();
    match answer {
        Err(faults) => refuse_files(reader, TABLE, faults),
        Ok((modes, gap_m)) => {
            let clearance_m = |side: &Field<Option<f64>>| {
                let own_m = view.get(side);
                own_m.unwrap_or_else(|| view.get(&fields::RAMP_CLEARANCE_UM))
            };
            let slot_m = view.get(&fields::DISK_THICKNESS_MM)
                + clearance_m(&fields::RAMP_CLEARANCE_TOP_UM)
                + clearance_m(&fields::RAMP_CLEARANCE_BOTTOM_UM);
            if let Some(place) = place.filter(|_| (gap_m - slot_m).abs() > SLOT_M) {
                let message = format!(
                    "its contacts stand {:.1} um apart, disk and clearances take {:.1} um",
                    1e6 * gap_m,
                    1e6 * slot_m
                );
                reader.remarks.push(
                    StudyError::at("N208", &place, file_key, message)
                        .value(place.text())
                        .hint(
                            "the study's clearances are used; the mesh gives only how the ramp moves",
                        ),
                );
            }
            let source = Source::new(format!("modes of {named}"), written(&modes));
            put(reader, &source, "ramp.deformable");
        }
    }
}

/// Takes what is wrong with the files of a table to the study's errors.
pub fn refuse_files(reader: &mut Reader, table: &str, faults: Faults) {
    let view = View::of_study(&reader.settings);
    let errors = faults.listed.into_iter().map(|mut fault| {
        if fault.message.starts_with("cannot be read") {
            fault.hint = "file paths start from the study's folder".to_owned();
        }
        // A node that the study names and its files do not have.
        let key = format!("{table}.{}", fault.what);
        let mut error = match view.place(&key).filter(|_| fault.code == "E169") {
            Some(place) => {
                let message = format!("{}: {}", fault.file, fault.message);
                StudyError::at(fault.code, place, &key, message)
                    .value(fault.value)
                    .allowed(fault.allowed)
                    .hint(fault.hint)
            }
            None => StudyError::from(fault),
        };
        // Of several heads, the one whose files these are.
        if table.starts_with("heads[") {
            error.message = format!("{table}: {}", error.message);
        }
        error
    });
    let errors: Vec<StudyError> = errors.collect();
    reader.errors.extend(errors);
    reader.settings.spoil(table);
}

/// Reads what was written of files into a section, `heads[0].` and the like before its name.
pub fn put(reader: &mut Reader, source: &Arc<Source>, section: &str) {
    // What is written here reads back.
    if let Ok(node) = tree::parse(source, Origin::Included) {
        reader.table(&node, &keys::pattern(section), section);
    }
}

/// Refuses keys of a table that say how to take files which are not named.
pub fn lonely(reader: &mut Reader, table: &str, what: &str, needed: &str) {
    let below = |path: &str| {
        path.strip_prefix(table)
            .is_some_and(|rest| rest.starts_with('.'))
    };
    let first = reader.settings.iter().find(|(path, _)| below(path));
    if let Some((path, setting)) = first {
        let fault = StudyError::at(
            "E112",
            &setting.key_place,
            path,
            format!("how to read {what}, without its files"),
        )
        .value(setting.place.text())
        .allowed(format!("{needed} beside it"))
        .hint("add them, or leave the table out");
        reader.spoil(table, fault);
    }
}

/// The oscillators as a study has them.
fn written(modes: &RampModes) -> String {
    let mut text = String::new();
    for mode in &modes.modes {
        let _ = write!(
            text,
            "[[coupled_modes]]\nfrequency_hz = {:?}\ntop_per_sqrt_kg = {:?}\n\
             bottom_per_sqrt_kg = {:?}\nparticipation_sqrt_kg = {:?}\n",
            rounded(mode.frequency_hz),
            rounded(mode.shape[0]),
            rounded(mode.shape[1]),
            rounded(mode.participation)
        );
    }
    text
}

/// Oscillators of the ramp in a file, and how far apart its contacts stand, m.
fn ramp(view: &View<'_>, path: &std::path::Path) -> Result<(Arc<RampModes>, f64), Faults> {
    type Known = HashMap<([u8; 32], String), (Arc<RampModes>, f64)>;
    static KNOWN: OnceLock<Mutex<Known>> = OnceLock::new();
    let source = text::Source::read(path)?;
    let metres = metres(view);
    let material = OF_MESH.material(view);
    let mount = OF_MESH.mount(view);
    let cut_hz = OF_MESH.cut_hz(view);
    let digest = *blake3::hash(source.text().as_bytes()).as_bytes();
    let key = (
        digest,
        format!("{metres:?} {material:?} {mount:?} {cut_hz:?}"),
    );
    let mut known = KNOWN
        .get_or_init(Mutex::default)
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    if let Some(found) = known.get(&key) {
        return Ok(found.clone());
    }
    let file = gmsh::read(&source)?;
    let mesh = ramp_mesh(&file, metres)?;
    let gap_m = mesh.gap_m();
    let modes = mesh
        .modes(&material, mount, cut_hz)
        .map_err(|error| unsolved(&file, mount, &error))?;
    let found = (Arc::new(modes), gap_m);
    known.insert(key, found.clone());
    Ok(found)
}

/// Length of the file's unit, m.
fn metres(view: &View<'_>) -> f64 {
    let unit = view.get(&fields::RAMP_DEFORMABLE_MESH_UNIT);
    unit.unwrap_or(words::LENGTH_UNITS[0].1).metres
}

/// The solid of a file that a study names.
///
/// # Errors
/// As [`ramp_mesh`], and what the reader of meshes refuses.
pub fn solid(view: &View<'_>, path: &std::path::Path) -> Result<RampSolid, Faults> {
    let file = gmsh::read(&text::Source::read(path)?)?;
    Ok(RampSolid {
        mesh: ramp_mesh(&file, metres(view))?,
        material: OF_MESH.material(view),
        mount: OF_MESH.mount(view),
        cut_hz: OF_MESH.cut_hz(view),
    })
}

/// A file's solid as a ramp, in m.
///
/// # Errors
/// E174 for too many nodes; E178 for folded elements; E179 for surfaces that are not named, not on
/// the outside, or not where a ramp has them, and for a size that no ramp has.
pub fn ramp_mesh(file: &MeshFile, metres: f64) -> Result<RampMesh, Faults> {
    if file.nodes.len() > MOST_NODES {
        let fault = Fault::of("E174", &file.file, "the mesh has too many nodes");
        return Err(fault
            .value(file.nodes.len().to_string())
            .allowed(format!("at most {MOST_NODES}"))
            .hint("larger elements; errors fall with the fourth power of their size")
            .into());
    }
    file.one_piece()?;
    let mut faults = Faults::default();
    let [mount, top, bottom] = ["mount", "top", "bottom"].map(|name| {
        file.surface(name).unwrap_or_else(|found| {
            faults.append(found);
            Vec::new()
        })
    });
    faults.or(())?;
    let nodes_m: Vec<[f64; 3]> = file.nodes.iter().map(|x| x.map(|c| metres * c)).collect();
    let extents_m = std::array::from_fn::<f64, 3, _>(|i| {
        let of = |pick: fn(f64, f64) -> f64, from: f64| {
            nodes_m.iter().fold(from, |most, x| pick(most, x[i]))
        };
        of(f64::max, f64::NEG_INFINITY) - of(f64::min, f64::INFINITY)
    });
    let longest_m = extents_m.into_iter().fold(0.0, f64::max);
    if !SIZE_M.contains(&longest_m) {
        let fault = Fault::of("E179", &file.file, "no ramp is of this size");
        return Err(fault
            .value(format!("{} mm", 1e3 * longest_m))
            .allowed("0.5 to 100 mm")
            .hint("set unit to the file's unit of length: mm, um, m or inch")
            .into());
    }
    let mesh = Mesh {
        shape: match file.solid {
            Solid::Tetrahedron => Shape::Tetrahedron10,
            Solid::Hexahedron => Shape::Hexahedron20,
        },
        nodes_m,
        connectivity: file.connectivity.clone(),
    };
    let faces = RampFaces { mount, top, bottom };
    RampMesh::of(mesh, faces).map_err(|error| misshapen(file, &error))
}

fn misshapen(file: &MeshFile, error: &ShapeError) -> Faults {
    let fault = Fault::of("E179", &file.file, error.to_string());
    match error {
        ShapeError::Mesh(error) => return Fault::of("E178", &file.file, error.to_string()).into(),
        ShapeError::NoArea { part } => fault.what(*part).allowed("faces with an area"),
        ShapeError::UpsideDown { gap_m } => fault
            .what("top")
            .value(format!("{} mm", 1e3 * gap_m))
            .allowed("top above bottom along z")
            .hint("z is the disk's axis, towards the slider"),
        ShapeError::HeldContact { node } => Fault::of(
            "E179",
            &file.file,
            "contact and mount share a node, which does not move",
        )
        .what(format!("node {}", file.node_tags[*node])),
    }
    .into()
}

fn unsolved(file: &MeshFile, mount: Mount, error: &SolidRampError) -> Faults {
    let fault = match error {
        SolidRampError::Assembly(AssemblyError::Mesh(MeshError::Folded {
            element,
            determinant,
        })) => Fault::of("E178", &file.file, "the element is folded")
            .what(format!("element {}", file.element_tags[*element]))
            .value(format!("{determinant:e}"))
            .allowed("a determinant of its map above 0")
            .hint("mesh again; Mesh.HighOrderOptimize = 2 unfolds curved elements"),
        SolidRampError::Parameter { .. } => {
            Fault::of("E179", &file.file, error.to_string()).what(format!("{mount:?}"))
        }
        _ => Fault::of(
            "E175",
            &file.file,
            format!("the ramp has no modes: {error}"),
        )
        .allowed("a ramp that can be solved")
        .hint("another cut_khz, a finer mesh"),
    };
    fault.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use opshock_import::gmsh::Face;
    use opshock_solid::material::Material;
    use opshock_solid::ramp::{Extent, RampGeometry, SolidRamp};

    /// The whole of opshock's own ramp, written for Gmsh and read as any user's, has the oscillators of the
    /// half that the geometry is solved by.
    #[test]
    fn a_ramp_of_ones_own_goes_round_through_gmsh() {
        let solid = SolidRamp {
            geometry: RampGeometry::mobile_drive(),
            material: Material::by_name("POM").unwrap(),
            mount: Mount::Bolted,
            mesh_size_m: 3e-3,
            cut_hz: 60e3,
        };
        let own = solid
            .geometry
            .mesh(solid.mesh_size_m, Extent::Whole)
            .unwrap();
        let patch = |weights: &[(usize, f64)]| {
            let at = |node: usize| own.mesh.nodes_m[node];
            let is_in = |x: [f64; 3]| weights.iter().any(|&(node, _)| at(node) == x);
            own.mesh.surface_faces(is_in)
        };
        let surfaces = [
            ("mount", own.bolted.clone()),
            ("top", patch(&own.top.nodes)),
            ("bottom", patch(&own.bottom.nodes)),
        ];
        let face = |nodes: Vec<usize>| Face { nodes, line: 0 };
        let file = MeshFile {
            file: "own.msh".to_owned(),
            solid: Solid::Hexahedron,
            nodes: own
                .mesh
                .nodes_m
                .iter()
                .map(|x| x.map(|c| 1e3 * c))
                .collect(),
            node_tags: (1..=own.mesh.nodes_m.len()).collect(),
            connectivity: own.mesh.connectivity.clone(),
            element_tags: (1..=own.mesh.n_elements()).collect(),
            surfaces: surfaces
                .map(|(name, faces)| (name.to_owned(), faces.into_iter().map(face).collect()))
                .into(),
        };
        let text = gmsh::write(&file);
        let source = text::Source::of("own.msh", text.into_bytes()).unwrap();
        let read = ramp_mesh(&gmsh::read(&source).unwrap(), 1e-3).unwrap();
        let there = read
            .modes(&solid.material, solid.mount, solid.cut_hz)
            .unwrap();
        let expected = solid.modes().unwrap();
        assert!((there.mass_kg / expected.mass_kg - 1.0).abs() < 1e-12);
        let stiffness = there.top_stiffness_n_per_m / expected.top_stiffness_n_per_m;
        assert!((stiffness - 1.0).abs() < 1e-8, "{stiffness}");
        // The whole has modes besides that are odd across the ramp, which nothing drives.
        for mode in &expected.modes {
            let same = there.modes.iter().any(|other| {
                (other.frequency_hz / mode.frequency_hz - 1.0).abs() < 1e-8
                    && (other.participation.abs() - mode.participation.abs()).abs()
                        < 1e-6 * mode.participation.abs().max(1e-4)
            });
            assert!(same || mode.frequency_hz > solid.cut_hz, "{mode:?}");
        }
    }
}
