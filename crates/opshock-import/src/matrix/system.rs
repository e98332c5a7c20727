//! A structure's matrices with the freedoms of their rows, in SI units.

use super::Matrix;
use super::dof::Freedoms;
use super::units::Units;
use crate::fault::{Fault, Faults};

/// M and K, and what goes with them.
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
    /// Puts matrices together and converts them.
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

    /// Number of freedoms.
    pub fn n(&self) -> usize {
        self.stiffness.n_rows
    }
}
