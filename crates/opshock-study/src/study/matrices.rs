//! Reads mass and stiffness matrices of another program, in SI, without the nodes that the base holds.

use super::field::{Field, Numbers, Text};
use super::settings::View;
use opshock_import::matrix::Matrix;
use opshock_import::matrix::check;
use opshock_import::matrix::dof::Direction;
use opshock_import::matrix::files::{freedoms, matrix};
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::{Fault, Faults};
use opshock_solid::assembly::SolidSystem;
use opshock_solid::sparse::{SymmetricMatrix, SymmetricPattern};
use std::path::Path;
use std::sync::Arc;

/// Direction of the disk's axis.
pub(super) const Z: u8 = 2;

/// Rows of a piece up to which all of its modes are computed at once.
pub(super) const SMALL: usize = 300;

/// Matrices in SI whose held nodes are taken out.
pub(super) struct Held {
    /// What is left.
    pub system: System,
    /// Its load by a unit inertia load per mass along the disk's axis, kg.
    pub load_kg: Vec<f64>,
    /// What is questionable about it.
    pub warnings: Vec<Fault>,
}

/// Keys of the files of matrices.
pub(super) struct Files {
    /// Mass matrix.
    pub mass: Field<Text>,
    /// Stiffness matrix.
    pub stiffness: Field<Text>,
    /// Freedoms of the rows, or their places.
    pub freedoms: Field<Text>,
    /// Places of the rows.
    pub places: Field<Text>,
    /// Units; SI when absent.
    pub units: Field<Option<Units>>,
    /// Nodes that the base holds.
    pub held: Field<Numbers>,
}

/// The matrices of a study; `of` is what stands before their keys, nothing or a head of its own.
///
/// # Errors
/// What is wrong with the files, and motions without stiffness.
pub(super) fn held(
    view: &View<'_>,
    of: &str,
    files: &Files,
    folder: &Path,
) -> Result<Held, Faults> {
    let file = |field: &Field<Text>| {
        let word = view.get_of(of, field);
        (!word.is_empty()).then(|| folder.join(word))
    };
    let path = |field: &Field<Text>| file(field).unwrap_or_default();
    let (dof, places) = (file(&files.freedoms), file(&files.places));
    let freedoms = freedoms(dof.as_deref(), places.as_deref())?;
    let stiffness = matrix(&path(&files.stiffness), freedoms.as_ref(), true)?;
    let mass = matrix(&path(&files.mass), freedoms.as_ref(), true)?;
    let units = view.get_of(of, &files.units).unwrap_or(Units::Si);
    let system = System::of(mass, stiffness, None, freedoms, units)?;
    let held = view.get_of(of, &files.held);
    let held: Vec<u64> = held.iter().map(|number| *number as u64).collect();
    let (system, load_kg) = system.held((files.held.key.name(), &held), Z)?;
    let (system, found) = check::check(system, false)?;
    Ok(Held {
        system,
        load_kg,
        warnings: found.warnings,
    })
}

/// Load of a unit inertia load per mass along a direction (0 to 2): M times a unit displacement, kg.
pub fn load(system: &System, along: u8) -> Vec<f64> {
    let is_along = |row: usize| {
        let freedom = system.freedoms.get(row);
        freedom.is_some_and(|f| f.direction == Direction::Along(along))
    };
    let unit: Vec<f64> = (0..system.n())
        .map(|row| f64::from(u8::from(is_along(row))))
        .collect();
    let mut load = vec![0.0; system.n()];
    system.mass.apply(&unit, &mut load);
    load
}

/// The matrices as the solid crate has them; its z is the direction `along`, in which the base's
/// motion loads them by `load_kg`.
pub fn solid(system: &System, along: u8, load_kg: &[f64]) -> SolidSystem {
    let n = system.n();
    let mut columns: Vec<Vec<usize>> = (0..n).map(|column| vec![column]).collect();
    for matrix in [&system.stiffness, &system.mass] {
        for entry in matrix.entries().filter(|entry| entry.row > entry.column) {
            columns[entry.column].push(entry.row);
        }
    }
    let mut starts = vec![0];
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        starts.push(starts.last().copied().unwrap_or(0) + column.len());
    }
    let pattern = Arc::new(SymmetricPattern::new(starts, columns.concat()));
    let lower = |matrix: &Matrix| {
        let mut lower = SymmetricMatrix::zeros(Arc::clone(&pattern));
        for entry in matrix.entries().filter(|entry| entry.row >= entry.column) {
            lower.add(entry.row, entry.column, entry.value);
        }
        lower
    };
    let moved = (0..n).filter(|&row| {
        let freedom = system.freedoms.get(row);
        freedom.is_some_and(|f| f.direction == Direction::Along(along))
    });
    let total = moved.map(|row| load_kg[row]).sum();
    let [x, y] = [(along + 1) % 3, (along + 2) % 3].map(|direction| load(system, direction));
    SolidSystem::of_matrices(
        lower(&system.stiffness),
        lower(&system.mass),
        [x, y, load_kg.to_vec()],
        total,
    )
}
