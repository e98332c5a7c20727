//! Takes slider and flexure out of the matrices of a deck of version 6.4.
//!
//! There the slider is a mass on springs to the load beam's dimple node, the flexure. With s the slider's freedoms and r
//! the others, its energy ½ (u_s − u_r)ᵀ k (u_s − u_r) adds k to K_ss, −k to K_sr and k to K_rr. The matrices of the
//! suspension alone are M_rr and the Schur complement K_rr − K_rs K_ss⁻¹ K_sr.

use super::contents::DeckSuspension;
use crate::fault::{Fault, Faults};
use crate::matrix::dof::{Direction, Freedom};
use crate::matrix::{Matrix, dense, entries::place};
use crate::text::Source;
use std::fmt::Write as _;

/// Largest difference of the flexure from springs between slider and dimple, relative.
const SAME: f64 = 1e-6;

/// Suspension, flexure and slider of a deck.
#[derive(Clone, Debug, PartialEq)]
pub struct Parted {
    /// Mass, stiffness, and places of the suspension alone, as text in the deck's format and units.
    pub texts: [String; 3],
    /// Node of the dimple in them.
    pub dimple: u64,
    /// Stiffness of the flexure: vertical, N/m; pitch and roll, N m/rad.
    pub flexure: [f64; 3],
    /// Mass of the slider, kg.
    pub slider_kg: f64,
}

/// Parts the matrices of a deck in mm, mN, kg and the places of their rows.
///
/// # Errors
/// E161 for sizes other than the deck's; E175 for a slider on anything but springs to the dimple, or whose mass is not
/// its own; as [`dense::read`].
pub fn part(
    deck: &DeckSuspension,
    [mass, stiffness, places]: [&Source; 3],
) -> Result<Parted, Faults> {
    let (mass, stiffness) = (dense::read(mass, true)?, dense::read(stiffness, true)?);
    let n = deck.n_rows;
    // Coincident nodes: a line each, which `read_places` would refuse as given twice.
    let lines: Vec<&str> = places
        .lines()
        .map(|line| line.text)
        .filter(|text| !text.trim().is_empty())
        .collect();
    for (file, rows) in [
        (&mass.file, mass.n_rows),
        (&stiffness.file, stiffness.n_rows),
        (&places.name, lines.len()),
    ] {
        if rows != n {
            let fault = Fault::of(
                "E161",
                file,
                "another number of rows than the deck's suspsz",
            );
            return Err(fault
                .what("rows")
                .value(rows.to_string())
                .allowed(n.to_string())
                .into());
        }
    }
    let slider = deck.slider_rows.map(|row| row - 1);
    let rest: Vec<usize> = (0..n).filter(|row| !slider.contains(row)).collect();
    let kept: String = rest
        .iter()
        .map(|&row| format!("{}\n", lines[row]))
        .collect();
    let (freedoms, _) = dense::read_places(&Source::of(&places.name, kept.clone().into_bytes())?)?;
    let row_of = |freedom: Freedom| {
        (0..rest.len())
            .find(|&at| freedoms.get(at) == Some(freedom))
            .map(|at| rest[at])
    };
    let at = rest.iter().position(|&row| row + 1 == deck.dimple_row);
    let Some(dimple) = at.and_then(|at| freedoms.get(at)) else {
        let fault = Fault::of(
            "E169",
            &places.name,
            "the dimple is a freedom of the slider",
        );
        return Err(fault
            .what("dofcu, dofcd")
            .value(deck.dimple_row.to_string())
            .into());
    };
    lumped(&mass, &slider, &rest)?;
    let mut flexure = [0.0; 3];
    // Vertical, pitch, roll; rotations in mN mm.
    let springs = [
        (2, Direction::Along(2), 1.0),
        (4, Direction::About(1), 1e-6),
        (3, Direction::About(0), 1e-6),
    ];
    for (spring, (freedom, direction, unit)) in flexure.iter_mut().zip(springs) {
        let node = dimple.node;
        let end = row_of(Freedom { node, direction });
        *spring = unit * between(&stiffness, slider[freedom], end)?;
    }
    let rows = |matrix: &dyn Fn(usize, usize) -> f64| {
        rest.iter().fold(String::new(), |mut text, &i| {
            for &j in &rest {
                let _ = write!(text, "{:e} ", matrix(i, j));
            }
            text + "\n"
        })
    };
    // The slider's freedoms, one after the other.
    let mut condensed: Vec<Vec<f64>> = (0..n)
        .map(|i| (0..n).map(|j| stiffness.get(i, j)).collect())
        .collect();
    for &s in &slider {
        let pivot = condensed[s].clone();
        if pivot[s] == 0.0 {
            continue;
        }
        for row in &mut condensed {
            let share = row[s] / pivot[s];
            for (value, pivot) in row.iter_mut().zip(&pivot) {
                *value -= share * pivot;
            }
        }
    }
    Ok(Parted {
        texts: [
            rows(&|i, j| mass.get(i, j)),
            rows(&|i, j| condensed[i][j]),
            kept,
        ],
        dimple: dimple.node,
        flexure,
        slider_kg: mass.get(slider[2], slider[2]),
    })
}

/// E175 where the slider shares mass with the suspension.
fn lumped(mass: &Matrix, slider: &[usize], rest: &[usize]) -> Result<(), Faults> {
    for &row in slider {
        let shared = mass
            .row(row)
            .find(|(column, value)| rest.contains(column) && *value != 0.0);
        if let Some((column, value)) = shared {
            let fault = Fault::of("E175", &mass.file, "slider and suspension share mass");
            return Err(fault
                .what(place(row, column))
                .value(value.to_string())
                .allowed("0 between the freedoms of the slider and others")
                .hint("--without-matrices takes the suspension of the default drive")
                .into());
        }
    }
    Ok(())
}

/// Stiffness of the spring between a freedom of the slider and one of the dimple.
fn between(stiffness: &Matrix, slider: usize, dimple: Option<usize>) -> Result<f64, Faults> {
    let own = stiffness.get(slider, slider);
    let other = stiffness.row(slider).find(|(column, value)| {
        let expected = match *column {
            column if column == slider => own,
            column if Some(column) == dimple => -own,
            _ => 0.0,
        };
        (value - expected).abs() > SAME * own.abs()
    });
    let (column, value) = match (other, dimple) {
        (None, Some(_)) if own > 0.0 => return Ok(own),
        (Some(other), _) => other,
        (None, _) => (slider, own),
    };
    let fault = Fault::of(
        "E175",
        &stiffness.file,
        "the flexure is not a spring between slider and dimple",
    );
    Err(fault
        .what(place(slider, column))
        .value(value.to_string())
        .allowed(
            "a positive diagonal, its negative at the dimple's freedom of the same kind, else 0",
        )
        .hint("--without-matrices takes the suspension of the default drive")
        .into())
}
