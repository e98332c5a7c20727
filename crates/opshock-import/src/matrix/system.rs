//! A structure's matrices with the freedoms of their rows, in SI units.

use super::dof::{Direction, Freedoms};
use super::sparse::{Entry, Matrix};
use super::units::Units;
use crate::fault::{Fault, Faults};

/// M and K, with the gyroscopic matrix and the freedoms.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// Mass.
    pub mass: Matrix,
    /// Stiffness.
    pub stiffness: Matrix,
    /// Gyroscopic matrix, where there is one.
    pub gyroscopic: Option<Matrix>,
    /// Freedoms of the rows.
    pub freedoms: Freedoms,
}

impl System {
    /// Combines matrices and converts them to SI units.
    ///
    /// # Errors
    /// E161 when a matrix is not square, or sizes or the map of freedoms differ.
    pub fn of(
        mass: Matrix,
        stiffness: Matrix,
        gyroscopic: Option<Matrix>,
        freedoms: Option<Freedoms>,
        units: Units,
    ) -> Result<Self, Faults> {
        let mut faults = Faults::default();
        let n = stiffness.n_rows;
        for matrix in [Some(&stiffness), Some(&mass), gyroscopic.as_ref()]
            .into_iter()
            .flatten()
        {
            if (matrix.n_rows, matrix.n_columns) != (n, n) {
                faults.push(
                    Fault::of("E161", &matrix.file, "the sizes of the matrices differ")
                        .value(format!("{} x {}", matrix.n_rows, matrix.n_columns))
                        .allowed(format!("{n} x {n}, square, as {}", stiffness.file)),
                );
            }
        }
        if let Some(freedoms) = freedoms.as_ref().filter(|freedoms| freedoms.len() != n) {
            faults.push(
                Fault::of(
                    "E161",
                    &freedoms.file,
                    "another number of freedoms than rows",
                )
                .value(freedoms.len().to_string())
                .allowed(format!("{n}, the rows of {}", stiffness.file)),
            );
        }
        faults.or(())?;
        let freedoms = freedoms.unwrap_or_else(|| Freedoms::unnamed(&stiffness.file, n));
        let si = |matrix| units.to_si(matrix, &freedoms);
        Ok(Self {
            mass: si(mass),
            stiffness: si(stiffness),
            gyroscopic: gyroscopic.map(si),
            freedoms: freedoms.clone(),
        })
    }

    /// The system with all freedoms of some nodes fixed to the base. The load of a unit inertia load per mass along a
    /// direction (0 to 2) on the rest, kg, is M times a unit displacement of all nodes, fixed ones included. Faults
    /// name the nodes as `what`.
    ///
    /// # Errors
    /// E169 for an unknown node, E161 when no freedom is left.
    pub fn held(
        self,
        (what, nodes): (&str, &[u64]),
        along: u8,
    ) -> Result<(Self, Vec<f64>), Faults> {
        let n = self.n();
        let freedom = |row: usize| self.freedoms.get(row);
        for node in nodes {
            if !(0..n).any(|row| freedom(row).is_some_and(|f| f.node == *node)) {
                let fault = Fault::of("E169", &self.freedoms.file, "no such node");
                return Err(fault
                    .what(what)
                    .value(node.to_string())
                    .allowed("nodes of the map")
                    .hint(format!("near it are {}", self.freedoms.near_node(*node)))
                    .into());
            }
        }
        let moves =
            |row: usize| freedom(row).is_some_and(|f| f.direction == Direction::Along(along));
        let unit: Vec<f64> = (0..n).map(|row| f64::from(u8::from(moves(row)))).collect();
        let mut load = vec![0.0; n];
        self.mass.apply(&unit, &mut load);
        let is_held = |row: usize| freedom(row).is_some_and(|f| nodes.contains(&f.node));
        let kept: Vec<usize> = (0..n).filter(|&row| !is_held(row)).collect();
        if kept.is_empty() {
            let fault = Fault::of("E161", &self.freedoms.file, "every freedom is held");
            return Err(fault.what(what).into());
        }
        let load = kept.iter().map(|&row| load[row]).collect();
        Ok((
            if nodes.is_empty() {
                self
            } else {
                self.rows(&kept)
            },
            load,
        ))
    }

    /// The system of some of its rows, with the others fixed.
    ///
    /// # Panics
    /// When a row is not there.
    #[must_use]
    pub fn rows(&self, kept: &[usize]) -> Self {
        let mut place = vec![usize::MAX; self.n()];
        kept.iter().enumerate().for_each(|(k, &row)| place[row] = k);
        let part = |matrix: &Matrix| {
            let entries = matrix.entries().filter_map(|entry| {
                let (row, column) = (place[entry.row], place[entry.column]);
                (row != usize::MAX && column != usize::MAX).then_some(Entry {
                    row,
                    column,
                    value: entry.value,
                })
            });
            Matrix::of(&matrix.file, kept.len(), kept.len(), entries.collect())
        };
        Self {
            mass: part(&self.mass),
            stiffness: part(&self.stiffness),
            gyroscopic: self.gyroscopic.as_ref().map(part),
            freedoms: self.freedoms.part(kept),
        }
    }

    /// Connected piece of each row: rows that stiffness or mass couple, directly or through others, belong to one
    /// piece.
    pub fn pieces(&self) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.n()).collect();
        let root = |parent: &mut [usize], mut row: usize| {
            while parent[row] != row {
                parent[row] = parent[parent[row]];
                row = parent[row];
            }
            row
        };
        for matrix in [&self.stiffness, &self.mass] {
            for entry in matrix.entries().filter(|entry| entry.value != 0.0) {
                let (a, b) = (
                    root(&mut parent, entry.row),
                    root(&mut parent, entry.column),
                );
                parent[a.max(b)] = a.min(b);
            }
        }
        (0..self.n()).map(|row| root(&mut parent, row)).collect()
    }

    /// Number of freedoms.
    pub fn n(&self) -> usize {
        self.stiffness.n_rows
    }
}
