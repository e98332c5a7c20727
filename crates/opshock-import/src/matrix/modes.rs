//! Imports modes that another program computed: shapes Φ, a column per mode, and frequencies.
//!
//! ```text
//! ΦᵀM Φ = 1,   ΦᵀK Φ = diag((2 π f)²)
//! ```

use super::entries::{place, real};
use super::sparse::Matrix;
use super::system::System;
use crate::fault::{Fault, Faults};
use crate::text::Source;

/// Tolerance of ΦᵀM Φ about the unit matrix.
pub const NORMALISATION: f64 = 1e-6;

/// Relative tolerance of a frequency about the value from the matrices.
pub const FREQUENCY: f64 = 1e-2;

/// Shapes of unit mass with their frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Frequencies, Hz.
    pub frequencies_hz: Vec<f64>,
    /// Shapes: a vector over the freedoms for each mode, 1/√kg.
    pub shapes: Vec<Vec<f64>>,
}

/// Reads frequencies: numbers, Hz, in any number of lines.
///
/// # Errors
/// E166, E171 for words that are no numbers; E168 for a negative frequency or one below the one before.
pub fn read_frequencies(source: &Source) -> Result<Vec<f64>, Faults> {
    let (mut list, mut faults) = (Vec::<f64>::new(), Faults::default());
    for word in source.lines().flat_map(crate::text::Line::words) {
        let what = format!("mode {}", list.len() + 1);
        let Some(value) = real(&source.name, &word, &what, &mut faults) else {
            continue;
        };
        let fault = |message: &str, allowed: String| {
            Fault::of("E168", &source.name, message)
                .at(word.place())
                .what(what.clone())
                .value(word.text)
                .allowed(allowed)
        };
        if value < 0.0 {
            faults.push(fault(
                "the frequency is negative",
                "0 Hz or more".to_owned(),
            ));
        } else if let Some(last) = list.last().filter(|last| **last > value) {
            let allowed = format!("at least {last}, that of the mode before");
            faults.push(fault("the frequencies do not rise", allowed));
        }
        list.push(value);
    }
    faults.or(list)
}

/// Combines modes with the matrices that they belong to.
///
/// # Errors
/// E161 when rows or numbers of modes differ; E167 when modes are not of unit mass or not orthogonal; E168 when a
/// frequency differs from that of the matrices.
pub fn of(
    system: &System,
    shapes: &Matrix,
    frequencies_hz: Vec<f64>,
    frequencies_file: &str,
    renormalise: bool,
) -> Result<Modes, Faults> {
    if shapes.n_rows != system.n() {
        return Err(Fault::of(
            "E161",
            &shapes.file,
            "shapes have other rows than the matrices",
        )
        .value(format!("{} x {}", shapes.n_rows, shapes.n_columns))
        .allowed(format!("{} rows", system.n()))
        .into());
    }
    if frequencies_hz.len() != shapes.n_columns {
        return Err(Fault::of(
            "E161",
            frequencies_file,
            "another number of frequencies than shapes",
        )
        .value(frequencies_hz.len().to_string())
        .allowed(shapes.n_columns.to_string())
        .into());
    }
    let mut columns = vec![vec![0.0; system.n()]; shapes.n_columns];
    for e in shapes.entries() {
        columns[e.column][e.row] = e.value;
    }
    let mut load = vec![0.0; system.n()];
    let mut product = |a: &[f64], b: &[f64], matrix: &Matrix| -> f64 {
        matrix.apply(b, &mut load);
        a.iter().zip(&load).map(|(a, b)| a * b).sum()
    };
    if renormalise {
        for column in &mut columns {
            let mass = product(column, column, &system.mass);
            column.iter_mut().for_each(|x| *x /= mass.sqrt());
        }
    }
    let mut worst = (0.0_f64, 0, 0, 0.0);
    for i in 0..columns.len() {
        for j in 0..=i {
            let found = product(&columns[i], &columns[j], &system.mass);
            let apart = (found - f64::from(u8::from(i == j))).abs();
            // A shape with NaN is the worst of all.
            if apart > worst.0 || apart.is_nan() {
                worst = (apart, i, j, found);
            }
        }
    }
    let (apart, i, j, found) = worst;
    if apart > NORMALISATION || apart.is_nan() {
        let fault = Fault::of(
            "E167",
            &shapes.file,
            if i == j {
                "the modes are not of unit mass"
            } else {
                "the modes are not orthogonal"
            },
        )
        .what(format!("modes {}", place(i, j)))
        .value(format!("phi M phi = {found:.6e}"))
        .allowed(format!("{} to {NORMALISATION:e}", u8::from(i == j)));
        let hint = if i == j && !renormalise {
            "the largest of all; modes of another mass can be renormalised"
        } else {
            "the largest of all; are modes and matrices of one model and in one set of units?"
        };
        return Err(fault.hint(hint).into());
    }
    let mut faults = Faults::default();
    for (k, (column, declared)) in columns.iter().zip(&frequencies_hz).enumerate() {
        let stiffness = product(column, column, &system.stiffness);
        let given = stiffness.max(0.0).sqrt() / std::f64::consts::TAU;
        if (given - declared).abs() > FREQUENCY * declared.max(given) {
            let ratio = declared / given;
            let fault = Fault::of(
                "E168",
                frequencies_file,
                "the frequency is not the matrices'",
            )
            .what(format!("mode {}", k + 1))
            .value(format!("{declared}"))
            .allowed(format!("{given:.6e} Hz to 1 %"));
            let in_radians = (ratio / std::f64::consts::TAU - 1.0).abs() < FREQUENCY;
            faults.push(if in_radians {
                fault.hint("2 pi too large: in rad/s and not in Hz?")
            } else {
                fault.hint(format!("{ratio:.4} times what the matrices give"))
            });
        }
    }
    faults.or(Modes {
        frequencies_hz,
        shapes: columns,
    })
}

/// Checks that a freedom moves in at least one mode.
///
/// # Errors
/// E170.
pub fn moves(modes: &Modes, shapes_file: &str, row: usize, name: &str) -> Result<(), Faults> {
    let largest = |at: &dyn Fn(&Vec<f64>) -> f64| modes.shapes.iter().map(at).fold(0.0, f64::max);
    let here = largest(&|shape| shape[row].abs());
    let anywhere = largest(&|shape| shape.iter().fold(0.0, |most: f64, x| most.max(x.abs())));
    if here > 1e-12 * anywhere {
        return Ok(());
    }
    Err(
        Fault::of("E170", shapes_file, "no mode moves at the contact point")
            .what(name)
            .value(format!("{here:e} of {anywhere:.3e}"))
            .allowed("above 0 in one mode at least")
            .hint("a ramp that cannot move there is a rigid one")
            .into(),
    )
}
