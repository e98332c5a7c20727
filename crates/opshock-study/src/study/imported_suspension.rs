//! Reduces a suspension given by another program's matrices to modes on the base.
//!
//! As with a ramp's mesh, the files are read with the study, and the modes they reduce to take their
//! place in it. The suspension reaches along x from its root to its tip, z is the disk's axis; the
//! dimple is a node with displacement z (3) and rotations about x (4, roll) and y (5, −dw/dx).
//!
//! ```text
//! u ≈ Ψ x + Φ η + Χ ξ      x = (z, dw/dx, roll) at the dimple, see opshock_solid::reduction
//! load on u: M 1z a(t)     of the whole mass matrix, the base's nodes included
//! ```
//!
//! Small matrices are not reduced: all their modes are kept.

use std::fmt::Write as _;
use std::path::Path;

use opshock_import::matrix::system::System;
use opshock_import::{Fault, Faults};
use opshock_solid::reduction::{PointMode, all_modes, reduce};
use opshock_solver::suspension::{
    RootedBeam, SuspensionError, SuspensionMode, SuspensionParameters,
};

use super::fault::StudyError;
use super::field::Field;
use super::fields;
use super::included::Location;
use super::matrices::{Files, Held, SMALL, Z, held, solid};
use super::ramp_geometry::rounded;
use super::ramp_mesh::{lonely, put, refuse_files};
use super::read::Reader;
use super::settings::View;
use super::source::Source;

/// Table of the files.
pub const TABLE: &str = "suspension.imported";
/// List that takes their place.
pub const MODES: &str = fields::SUSPENSION_MODES.path();
/// Keys of the geometry, whose place modes take.
pub const REPLACED: [&str; 17] = [
    fields::SUSPENSION_HINGE_LENGTH_MM.path(),
    fields::SUSPENSION_HINGE_WIDTH_MM.path(),
    fields::SUSPENSION_HINGE_THICKNESS_UM.path(),
    fields::SUSPENSION_LOAD_BEAM_DIMPLE_MM.path(),
    fields::SUSPENSION_LOAD_BEAM_END_MM.path(),
    fields::SUSPENSION_LOAD_BEAM_WEB_UM.path(),
    fields::SUSPENSION_LOAD_BEAM_WIDTH_ROOT_MM.path(),
    fields::SUSPENSION_LOAD_BEAM_WIDTH_DIMPLE_MM.path(),
    fields::SUSPENSION_LOAD_BEAM_TAB_WIDTH_MM.path(),
    fields::SUSPENSION_FLANGE_HEIGHT_UM.path(),
    fields::SUSPENSION_FLANGE_FROM_MM.path(),
    fields::SUSPENSION_FLANGE_TO_MM.path(),
    fields::SUSPENSION_FLEXURE_MASS_MG.path(),
    fields::SUSPENSION_FLEXURE_FROM_MM.path(),
    fields::SUSPENSION_MATERIAL_YOUNGS_MODULUS_GPA.path(),
    fields::SUSPENSION_MATERIAL_SHEAR_MODULUS_GPA.path(),
    fields::SUSPENSION_MATERIAL_DENSITY_KG_PER_M3.path(),
];
/// Keys of its matrices.
const FILES: Files = Files {
    mass: fields::SUSPENSION_IMPORTED_MASS,
    stiffness: fields::SUSPENSION_IMPORTED_STIFFNESS,
    freedoms: fields::SUSPENSION_IMPORTED_FREEDOMS,
    places: fields::SUSPENSION_IMPORTED_PLACES,
    units: fields::SUSPENSION_IMPORTED_UNITS,
    held: fields::SUSPENSION_IMPORTED_BASE,
};
/// Node of the dimple.
const DIMPLE: Field<Option<i64>> = fields::SUSPENSION_IMPORTED_DIMPLE;
/// Default of `cut_khz`, Hz.
pub const CUT_HZ: f64 = 1e6;
/// Share of a mode's motion, each against the largest of its kind, below which it is rounding.
const ROUNDING: f64 = 1e-6;

/// Reads the matrices a study names into the list of modes. `of` is what its keys begin with: nothing, or a
/// head of its own.
pub fn read(reader: &mut Reader, location: &Location, of: &str) {
    let table = format!("{of}{TABLE}");
    let view = View::of_study(&reader.settings);
    let needed = [FILES.mass.path(), FILES.stiffness.path(), DIMPLE.path()];
    let is_given = needed.map(|path| view.datum(&format!("{of}{path}")).is_some());
    if is_given == [false; 3] {
        // Modes of the command line leave them without their files.
        if !reader.settings.has(&format!("{of}{MODES}")) {
            lonely(reader, &table, "matrices", "mass, stiffness and dimple");
        }
        return;
    }
    // A missing one of the three is reported with all other missing keys.
    if is_given != [true; 3] || !reader.settings.are_sound(&[&table]) {
        return;
    }
    match modes(&view, of, &location.folder) {
        Err(faults) => refuse_files(reader, &table, faults),
        Ok((modes, warnings)) => {
            reader
                .remarks
                .extend(warnings.into_iter().map(StudyError::from));
            let source = Source::new("modes of the imported suspension", written(&modes));
            put(reader, &source, &format!("{of}suspension"));
        }
    }
}

fn written(modes: &[SuspensionMode]) -> String {
    let mut text = String::new();
    for mode in modes {
        let _ = write!(
            text,
            "[[modes]]\nfrequency_hz = {:?}\nvertical_per_sqrt_kg = {:?}\n\
             slope_per_m_sqrt_kg = {:?}\nroll_per_m_sqrt_kg = {:?}\nparticipation_sqrt_kg = {:?}\n",
            rounded(mode.frequency_hz),
            rounded(mode.vertical_per_sqrt_kg),
            rounded(mode.slope_per_m_sqrt_kg),
            rounded(mode.roll_per_m_sqrt_kg),
            rounded(mode.participation_sqrt_kg)
        );
    }
    text
}

/// Modes of the matrices, and what was questionable about them.
fn modes(
    view: &View<'_>,
    of: &str,
    folder: &Path,
) -> Result<(Vec<SuspensionMode>, Vec<Fault>), Faults> {
    let Held {
        system,
        load_kg,
        warnings,
    } = held(view, of, &FILES, folder)?;
    let dimple = view.get_of(of, &DIMPLE).unwrap_or(0);
    let row = |direction: u8| {
        system
            .freedoms
            .find(&format!("{dimple}.{direction}"), DIMPLE.key.name())
    };
    let [z, about_y, about_x] = [row(3)?, row(5)?, row(4)?];
    let own_cut_hz = view.get_of(of, &fields::SUSPENSION_IMPORTED_CUT_KHZ);
    let cut_hz = own_cut_hz.unwrap_or(CUT_HZ);
    let pieces = system.pieces();
    if pieces[z] == pieces[about_x] {
        let points = [(z, 1.0), (about_y, -1.0), (about_x, 1.0)];
        let modes = split(&oscillators(&system, &load_kg, &points, cut_hz)?, &system)?;
        return Ok((modes, warnings));
    }
    // Beams bend and twist by themselves; in one reduction modes of one frequency would mix.
    if pieces[z] != pieces[about_y] {
        let message = "displacement and slope of the dimple do not hang together";
        let fault = Fault::of("E180", &system.stiffness.file, message);
        return Err(fault.what(format!("{dimple}.5")).into());
    }
    let piece = |points: &[(usize, f64)]| {
        let of = pieces[points[0].0];
        let rows: Vec<usize> = (0..system.n()).filter(|&r| pieces[r] == of).collect();
        let load: Vec<f64> = rows.iter().map(|&r| load_kg[r]).collect();
        // Rows of a piece rise, those of its points are among them.
        let at = |&(row, sense): &(usize, f64)| (rows.partition_point(|&r| r < row), sense);
        let points: Vec<(usize, f64)> = points.iter().map(at).collect();
        oscillators(&system.rows(&rows), &load, &points, cut_hz)
    };
    let bends = piece(&[(z, 1.0), (about_y, -1.0)])?;
    let twists = piece(&[(about_x, 1.0)])?;
    let bends = bends.iter().map(|mode| SuspensionMode {
        frequency_hz: mode.frequency_hz,
        vertical_per_sqrt_kg: mode.shape[0],
        slope_per_m_sqrt_kg: mode.shape[1],
        roll_per_m_sqrt_kg: 0.0,
        participation_sqrt_kg: mode.participation,
    });
    let twists = twists.iter().map(|mode| SuspensionMode {
        frequency_hz: mode.frequency_hz,
        vertical_per_sqrt_kg: 0.0,
        slope_per_m_sqrt_kg: 0.0,
        roll_per_m_sqrt_kg: mode.shape[0],
        participation_sqrt_kg: 0.0,
    });
    Ok((bends.chain(twists).collect(), warnings))
}

/// Oscillators of a system with its motion at some rows, each with a sense.
fn oscillators(
    system: &System,
    load_kg: &[f64],
    points: &[(usize, f64)],
    cut_hz: f64,
) -> Result<Vec<PointMode>, Faults> {
    let columns = points.iter().map(|&(row, sense)| {
        let mut column = vec![0.0; system.n()];
        column[row] = sense;
        column
    });
    let columns: Vec<Vec<f64>> = columns.collect();
    let solid = solid(system, Z, load_kg);
    let modes = match system.n() <= SMALL {
        true => all_modes(&solid, &columns),
        false => reduce(&solid, columns, cut_hz).and_then(|reduced| reduced.point_modes()),
    };
    modes.map_err(|error| {
        let message = format!("the matrices cannot be reduced to the dimple: {error}");
        let fault = Fault::of("E165", &system.stiffness.file, message);
        fault.hint("another cut_khz").into()
    })
}

/// Modes that bend and modes that twist, without those that move nothing at the dimple.
fn split(reduced: &[PointMode], system: &System) -> Result<Vec<SuspensionMode>, Faults> {
    let largest = |of: &dyn Fn(&PointMode) -> f64| {
        reduced
            .iter()
            .fold(f64::MIN_POSITIVE, |most, m| of(m).abs().max(most))
    };
    let sizes = [0, 1, 2].map(|k| largest(&|mode| mode.shape[k]));
    let load = largest(&|mode| mode.participation);
    let mut modes = Vec::new();
    for mode in reduced {
        let share = |k: usize| mode.shape[k].abs() / sizes[k];
        let bends = share(0).max(share(1)).max(mode.participation.abs() / load);
        let twists = share(2);
        let rounding = ROUNDING * bends.max(twists);
        if bends.min(twists) > rounding {
            let message = "a mode moves z and roll of the dimple at once";
            let fault = Fault::of("E180", &system.stiffness.file, message);
            return Err(fault
                .what(format!("mode at {:.1} Hz", mode.frequency_hz))
                .value(format!("{:.1e}", bends.min(twists) / bends.max(twists)))
                .allowed("a suspension that is its own mirror image across its middle")
                .hint("x from root to tip, z the disk's axis; are both sides meshed alike?")
                .into());
        }
        if bends.max(twists) <= ROUNDING * ROUNDING {
            continue;
        }
        let bending = f64::from(u8::from(bends > twists));
        modes.push(SuspensionMode {
            frequency_hz: mode.frequency_hz,
            vertical_per_sqrt_kg: bending * mode.shape[0],
            slope_per_m_sqrt_kg: bending * mode.shape[1],
            roll_per_m_sqrt_kg: (1.0 - bending) * mode.shape[2],
            participation_sqrt_kg: bending * mode.participation,
        });
    }
    Ok(modes)
}

/// Modes of a view, in SI.
pub fn listed(view: &View<'_>) -> Vec<SuspensionMode> {
    let mode = |entry| SuspensionMode {
        frequency_hz: view.entry(entry, &fields::SUSPENSION_MODES_FREQUENCY_HZ),
        vertical_per_sqrt_kg: view.entry(entry, &fields::SUSPENSION_MODES_VERTICAL_PER_SQRT_KG),
        slope_per_m_sqrt_kg: view.entry(entry, &fields::SUSPENSION_MODES_SLOPE_PER_M_SQRT_KG),
        roll_per_m_sqrt_kg: view.entry(entry, &fields::SUSPENSION_MODES_ROLL_PER_M_SQRT_KG),
        participation_sqrt_kg: view.entry(entry, &fields::SUSPENSION_MODES_PARTICIPATION_SQRT_KG),
    };
    (0..view.get(&fields::SUSPENSION_MODES)).map(mode).collect()
}

/// Files of a suspension as rows of numbers in mN, mm, kg: stiffness, mass, places, and the section of
/// a study that reads them. Node 1 is the root.
#[derive(Clone, Debug)]
pub struct Written {
    /// `susp_K.dat`.
    pub stiffness: String,
    /// `susp_M.dat`.
    pub mass: String,
    /// `susp_cords.dat`.
    pub places: String,
    /// Section of a study.
    pub section: String,
}

/// Writes the finite elements of a suspension's geometry: z and rotations about y and x of each node.
///
/// # Errors
/// Geometry that cannot be.
pub fn write(suspension: &SuspensionParameters) -> Result<Written, SuspensionError> {
    let beam = RootedBeam::assemble(suspension)?;
    let n = beam.nodes_m.len();
    // Unknown 3 a + k of node a: z, rotation about y, rotation about x; lengths in mm.
    let entry = |bending: &dyn Fn(usize, usize) -> f64, torsion: &dyn Fn(usize, usize) -> f64| {
        let mut text = String::new();
        for row in 0..3 * n {
            for column in 0..3 * n {
                let (a, i, b, j) = (row / 3, row % 3, column / 3, column % 3);
                // dw/dx is −1 times the rotation about y; mN mm and rad for N m.
                let sense = |k: usize| [1.0, -1e3, 1e3][k];
                let value = match (i == 2, j == 2) {
                    (false, false) => bending(2 * a + i, 2 * b + j),
                    (true, true) => torsion(a, b),
                    _ => 0.0,
                };
                let value = sense(i) * sense(j) * value + 0.0;
                let _ = write!(text, "{}{value:e}", if column > 0 { " " } else { "" });
            }
            text.push('\n');
        }
        text
    };
    let stiffness = entry(&|i, j| beam.bending_stiffness[(i, j)], &|i, j| {
        beam.torsion_stiffness[(i, j)]
    });
    let mass = entry(&|i, j| beam.bending_mass[(i, j)], &|i, j| {
        beam.torsion_mass[(i, j)]
    });
    let mut places = String::new();
    for x in &beam.nodes_m {
        for kind in [3, 5, 4] {
            let _ = writeln!(places, "{:e} 0 0 {kind}", 1e3 * x);
        }
    }
    Ok(Written {
        stiffness,
        mass,
        places,
        section: format!(
            "[suspension.imported]\nmass = \"susp_M.dat\"\nstiffness = \"susp_K.dat\"\n\
             places = \"susp_cords.dat\"\nunits = \"mm_mn\"\nbase = [1]\ndimple = {}\n",
            beam.dimple + 1
        ),
    })
}
