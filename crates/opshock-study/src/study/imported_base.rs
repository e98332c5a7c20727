//! Reduces a base plate given by another program's matrices to modes under the shock.
//!
//! As with a suspension, the files are read with the study, and the modes take their place in it. z is the disk's
//! axis; spindle, ramp and pivot are nodes with displacement z (3).
//!
//! ```text
//! K x = ω² M x,  xᵀ M x = 1      natural modes below `cut_khz`, counted by signs of pivots
//! φ = z of x at the three nodes,  p = x·M 1z, of the whole mass matrix, held nodes included
//! ```
//!
//! Nothing stands for the modes above the cut: a base that stiff is rigid.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use opshock_import::{Fault, Faults};
use opshock_solid::assembly::SolidSystem;
use opshock_solid::modes::StaticSolver;
use opshock_solid::reduction::{PointMode, all_modes};
use opshock_solid::sparse::SparseError;
use opshock_solver::shock::BaseMode;

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
pub const TABLE: &str = "base.imported";
/// List that takes their place.
pub const MODES: &str = fields::BASE_MODES.path();
/// Most modes that a base may have.
pub const MOST: usize = 16;
/// Default of `cut_khz`, Hz.
const CUT_HZ: f64 = 1e4;
/// Default of `damping_ratio`.
const DAMPING_RATIO: f64 = 0.02;
/// What must be given of the table.
const NEEDED: [&str; 5] = [
    FILES.mass.path(),
    FILES.stiffness.path(),
    fields::BASE_IMPORTED_SPINDLE.path(),
    fields::BASE_IMPORTED_RAMP.path(),
    fields::BASE_IMPORTED_PIVOT.path(),
];
/// Keys of its matrices.
const FILES: Files = Files {
    mass: fields::BASE_IMPORTED_MASS,
    stiffness: fields::BASE_IMPORTED_STIFFNESS,
    freedoms: fields::BASE_IMPORTED_FREEDOMS,
    places: fields::BASE_IMPORTED_PLACES,
    units: fields::BASE_IMPORTED_UNITS,
    held: fields::BASE_IMPORTED_HELD,
};

/// Reads the matrices a study names into the list of modes.
pub fn read(reader: &mut Reader, location: &Location) {
    let view = View::of_study(&reader.settings);
    let is_given = NEEDED.map(|path| view.datum(path).is_some());
    if is_given == [false; NEEDED.len()] {
        // Modes of the command line leave them without their files.
        if !reader.settings.has(MODES) {
            let names = NEEDED.map(|path| path.rsplit('.').next().unwrap_or(path));
            lonely(reader, TABLE, "matrices", &names.join(", "));
        }
        return;
    }
    // Matrices beside modes are reported as given twice; missing keys are reported with all others.
    if reader.settings.has(MODES) {
        return;
    }
    if is_given != [true; NEEDED.len()] || !reader.settings.are_sound(&[TABLE]) {
        return;
    }
    match modes(&view, &location.folder) {
        Err(faults) => refuse_files(reader, TABLE, faults),
        Ok((modes, warnings)) => {
            let number = modes.len();
            if !(1..=MOST).contains(&number) {
                refuse_number(reader, number);
                return;
            }
            let warnings = warnings.into_iter().map(StudyError::from);
            reader.remarks.extend(warnings);
            let source = Source::new("modes of the imported base", written(&modes));
            put(reader, &source, "base");
        }
    }
}

/// Refuses a cut with no modes below it, or with too many.
fn refuse_number(reader: &mut Reader, number: usize) {
    let paths = [fields::BASE_IMPORTED_CUT_KHZ.path(), FILES.stiffness.path()];
    let given = paths.into_iter().find_map(|path| {
        let setting = reader.settings.get(path)?;
        Some((path, setting.place.clone()))
    });
    let Some((path, place)) = given else {
        return;
    };
    let many = number > MOST;
    let message = match many {
        true => format!("a base of more than {MOST} modes below the cut"),
        false => "a base without a mode below the cut".to_string(),
    };
    let fault = StudyError::at("E189", &place, path, message)
        .value(place.text())
        .allowed(format!("a cut_khz with 1 to {MOST} modes below it"))
        .hint(match many {
            true => "a lower cut_khz",
            false => "a higher cut_khz, or a rigid base; are the units right?",
        });
    reader.spoil(path, fault);
}

fn written(modes: &[BaseMode]) -> String {
    let mut text = String::new();
    for mode in modes {
        let _ = write!(
            text,
            "[[modes]]\nfrequency_hz = {:?}\ndamping_ratio = {:?}\nparticipation_sqrt_kg = {:?}\n\
             spindle_per_sqrt_kg = {:?}\nramp_per_sqrt_kg = {:?}\npivot_per_sqrt_kg = {:?}\n",
            rounded(mode.frequency_hz),
            mode.damping_ratio,
            rounded(mode.participation_sqrt_kg),
            rounded(mode.spindle_per_sqrt_kg),
            rounded(mode.ramp_per_sqrt_kg),
            rounded(mode.pivot_per_sqrt_kg)
        );
    }
    text
}

/// Modes of the matrices, one too many where there are too many, and what was questionable about them.
fn modes(view: &View<'_>, folder: &Path) -> Result<(Vec<BaseMode>, Vec<Fault>), Faults> {
    let Held {
        system,
        load_kg,
        warnings,
    } = held(view, "", &FILES, folder)?;
    let row = |field: &Field<Option<i64>>| {
        let node = view.get(field).unwrap_or(0);
        system.freedoms.find(&format!("{node}.3"), field.key.name())
    };
    let [spindle, ramp, pivot] = [
        row(&fields::BASE_IMPORTED_SPINDLE)?,
        row(&fields::BASE_IMPORTED_RAMP)?,
        row(&fields::BASE_IMPORTED_PIVOT)?,
    ];
    let cut_hz = view.get(&fields::BASE_IMPORTED_CUT_KHZ).unwrap_or(CUT_HZ);
    let own_ratio = view.get(&fields::BASE_IMPORTED_DAMPING_RATIO);
    let damping_ratio = own_ratio.unwrap_or(DAMPING_RATIO);
    let solid = solid(&system, Z, &load_kg);
    let columns = [spindle, ramp, pivot].map(|row| {
        let mut column = vec![0.0; system.n()];
        column[row] = 1.0;
        column
    });
    let mut modes = match system.n() <= SMALL {
        true => all_modes(&solid, &columns),
        false => natural_modes(&solid, [spindle, ramp, pivot], cut_hz),
    }
    .map_err(|error| {
        let message = format!("the matrices have no modes: {error}");
        let fault = Fault::of("E165", &system.stiffness.file, message);
        Faults::from(fault.hint("another cut_khz"))
    })?;
    modes.retain(|mode| mode.frequency_hz < cut_hz);
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let mode = |mode: PointMode| {
        // A mode and its negative are one: the shock pushes it along.
        let sense = if mode.participation < 0.0 { -1.0 } else { 1.0 };
        BaseMode {
            frequency_hz: mode.frequency_hz,
            damping_ratio,
            participation_sqrt_kg: sense * mode.participation,
            spindle_per_sqrt_kg: sense * mode.shape[0],
            ramp_per_sqrt_kg: sense * mode.shape[1],
            pivot_per_sqrt_kg: sense * mode.shape[2],
        }
    };
    Ok((modes.into_iter().map(mode).collect(), warnings))
}

/// Natural modes below `cut_hz` with their displacements of some rows, one too many where there are too many.
fn natural_modes(
    solid: &SolidSystem,
    rows: [usize; 3],
    cut_hz: f64,
) -> Result<Vec<PointMode>, SparseError> {
    let solver = StaticSolver::new(solid, Vec::new(), 0.0)?;
    let count = solver.count_below(solid, (TAU * cut_hz).powi(2))?;
    let found = solver.lowest(solid, count.min(MOST + 1))?;
    let load_kg = &solid.base_load_kg[usize::from(Z)];
    let pairs = found.omega_squared.iter().zip(&found.shapes);
    let mode = |(omega_squared, shape): (&f64, &Vec<f64>)| PointMode {
        frequency_hz: omega_squared.sqrt() / TAU,
        shape: rows.map(|row| shape[row]).to_vec(),
        participation: shape.iter().zip(load_kg).map(|(x, m)| x * m).sum(),
    };
    Ok(pairs.map(mode).collect())
}
