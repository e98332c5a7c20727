//! Matrices of another program as the solid crate reduces them.

use opshock_import::matrix::Matrix;
use opshock_import::matrix::dof::Direction;
use opshock_import::matrix::system::System;
use opshock_solid::assembly::SolidSystem;
use opshock_solid::sparse::{SymmetricMatrix, SymmetricPattern};
use std::sync::Arc;

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
