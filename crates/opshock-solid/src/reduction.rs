//! Craig-Bampton reduction of a solid to the points at which it touches other bodies.
//!
//! ```text
//! u ≈ Ψ x + Φ η + Χ ξ    Ψ constraint modes: 1 at one point, 0 at the others, unloaded elsewhere
//!                        Φ modes with the points fixed, all below the cut frequency
//!                        Χ static response of the modes above the cut to MΨ and to base motion
//! Kr = [S 0 0; 0 Λ 0; 0 0 ΧᵀKΧ]    S = (Wᵀ K⁻¹ W)⁻¹
//! Mr = [ΨᵀMΨ ΨᵀMΦ ΨᵀMΧ; · 1 0; · · 1]
//! ```
//!
//! Ψ and Φ alone are the method of Craig and Bampton. Neglecting the modes above the cut then costs a share (ω/ω_cut)²
//! of their contribution. With their static response Χ, one vector per point and one for the base, the share is
//! (ω/ω_cut)⁴.
//!
//! A point is a patch: x = wᵀ u is the mean displacement over it, and a force acts on it with the same weights. The
//! displacement under a force on a single point of a solid would grow without bound as the mesh is refined. Static
//! motion of the points under any force on them and under steady acceleration is exact; dynamic motion is accurate
//! below the cut.
//!
//! The reduced system is small enough to be diagonalised completely: every mode then is an oscillator with a shape at
//! each point and a participation in the base's acceleration.
//!
//! ```text
//! q'' + 2 ζ ω q' + ω² q = Σ φ_point λ_point + p a(t),    x_point = Σ φ_point q
//! ```
//!
//! Source: Craig and Bampton (1968), AIAA J. 6, 1313; Hintz (1975), AIAA J. 13, 1007 for the exact
//! static part; Dickens, Nakagawa and Wittbrodt (1997), Computers & Structures 62, 985 for Χ.

use crate::assembly::SolidSystem;
use crate::modes::{SolidModes, StaticSolver, append, combination};
use crate::sparse::{Dense, SparseError, SymmetricMatrix, dense_general_eigen, dot};

/// A correction is dropped when the modes contain all of it but this share.
const NEGLIGIBLE: f64 = 1e-6;

/// Reduced matrices: points first, then modes, then corrections for the neglected modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedSolid {
    /// Points.
    pub n_points: usize,
    /// Stiffness, N/m (1/s² for modes).
    pub stiffness: Dense,
    /// Mass, kg (1 for modes, √kg between).
    pub mass: Dense,
    /// Load of a unit inertia load per mass along z, kg (√kg for modes).
    pub base_load: Vec<f64>,
    /// Displacements of the unknowns, a column per reduced unknown.
    pub basis: Vec<Vec<f64>>,
}

/// Most modes with fixed points that a reduction keeps. A ramp has far fewer below any cut that its contact excites;
/// the limit bounds time and memory for an unsuitable shape.
pub const MOST_MODES: usize = 100;

/// An oscillator of the reduced solid.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Displacement of each point per unit of the mode, 1/√kg.
    pub shape: Vec<f64>,
    /// Load per inertia load per mass along z, √kg.
    pub participation: f64,
}

/// Reduces a system to the points given by `columns`, with fixed-interface modes below `cut_hz`.
///
/// # Errors
/// A solid without support, points that cannot move independently, more than [`MOST_MODES`] modes below the cut, no
/// convergence.
pub fn reduce(
    system: &SolidSystem,
    columns: Vec<Vec<f64>>,
    cut_hz: f64,
) -> Result<ReducedSolid, SparseError> {
    let statics = StaticSolver::new(system, columns, 0.0)?;
    let limit = (std::f64::consts::TAU * cut_hz).powi(2);
    let count = statics.count_below(system, limit)?;
    if count > MOST_MODES {
        return Err(SparseError::TooManyModes {
            count,
            most: MOST_MODES,
        });
    }
    let modes = statics.counted(system, count, limit)?;
    let n_points = statics.constraint_modes().len();
    let corrections = corrections(system, &statics, &modes);
    let n_modes = modes.shapes.len();
    let mut basis = statics.constraint_modes().to_vec();
    basis.extend(modes.shapes);
    basis.extend(corrections);
    let masses: Vec<Vec<f64>> = basis.iter().map(|x| system.mass.times(x)).collect();
    let size = basis.len();
    let mut mass = vec![vec![0.0; size]; size];
    let mut stiffness = vec![vec![0.0; size]; size];
    for i in 0..size {
        for j in 0..=i {
            let entry = if j < n_points {
                dot(&basis[j], &masses[i])
            } else {
                f64::from(u8::from(i == j))
            };
            mass[i][j] = entry;
            mass[j][i] = entry;
        }
    }
    let first = n_points + n_modes;
    for i in first..size {
        let force = system.stiffness.times(&basis[i]);
        for j in first..size {
            stiffness[i][j] = dot(&basis[j], &force);
        }
    }
    for (row, points) in stiffness.iter_mut().zip(statics.point_stiffness()) {
        row[..n_points].copy_from_slice(points);
    }
    for (k, value) in modes.omega_squared.iter().enumerate() {
        stiffness[n_points + k][n_points + k] = *value;
    }
    let base_load = basis
        .iter()
        .map(|x| dot(x, &system.base_load_kg[2]))
        .collect();
    Ok(ReducedSolid {
        n_points,
        stiffness,
        mass,
        base_load,
        basis,
    })
}

/// Static responses to MΨ and to base motion along z with the points fixed, without their share in the modes, of unit
/// mass and orthogonal.
fn corrections(system: &SolidSystem, statics: &StaticSolver, modes: &SolidModes) -> Vec<Vec<f64>> {
    let mut answers: Vec<Vec<f64>> = statics
        .constraint_modes()
        .iter()
        .map(|psi| system.mass.times(psi))
        .collect();
    answers.push(system.base_load_kg[2].clone());
    statics.answer(&mut answers);
    let mut kept = modes.shapes.clone();
    let mut masses: Vec<Vec<f64>> = kept.iter().map(|x| system.mass.times(x)).collect();
    for answer in answers {
        append(system, answer, &mut kept, &mut masses, NEGLIGIBLE);
    }
    kept.split_off(modes.shapes.len())
}

/// Every oscillator of a small system without reduction, lowest first, with its shape given by `columns`. Solved as M x
/// = μ K x, so that the low modes keep all their digits.
///
/// # Errors
/// A stiffness that is not positive definite, no convergence.
pub fn all_modes(
    system: &SolidSystem,
    columns: &[Vec<f64>],
) -> Result<Vec<PointMode>, SparseError> {
    let n = system.order();
    let dense = |matrix: &SymmetricMatrix| -> Vec<Vec<f64>> {
        let column = |k: usize| {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            matrix.times(&unit)
        };
        (0..n).map(column).collect()
    };
    let (values, vectors) = dense_general_eigen(&dense(&system.mass), &dense(&system.stiffness))?;
    if values.iter().any(|value| value.is_nan() || *value <= 0.0) {
        return Err(SparseError::NotPositiveDefinite);
    }
    let pairs = values.iter().zip(&vectors).rev();
    Ok(pairs
        .map(|(value, vector)| {
            // xᵀ K x = 1 has mass μ.
            let scale = value.sqrt().recip();
            PointMode {
                frequency_hz: scale / std::f64::consts::TAU,
                shape: columns.iter().map(|c| scale * dot(c, vector)).collect(),
                participation: scale * dot(vector, &system.base_load_kg[2]),
            }
        })
        .collect())
}

impl ReducedSolid {
    /// The oscillators, lowest first.
    ///
    /// # Errors
    /// A mass that is not positive definite, no convergence.
    pub fn point_modes(&self) -> Result<Vec<PointMode>, SparseError> {
        let found = self.oscillators()?.into_iter();
        Ok(found.map(|(mode, _)| mode).collect())
    }

    /// The oscillators, lowest first, each with the displacements of all unknowns, 1/√kg.
    ///
    /// # Errors
    /// As [`ReducedSolid::point_modes`].
    pub fn mode_shapes(&self) -> Result<Vec<(PointMode, Vec<f64>)>, SparseError> {
        let found = self.oscillators()?.into_iter();
        let whole = |(mode, reduced): (_, Vec<f64>)| (mode, combination(&self.basis, &reduced));
        Ok(found.map(whole).collect())
    }

    /// The oscillators with their reduced unknowns.
    fn oscillators(&self) -> Result<Vec<(PointMode, Vec<f64>)>, SparseError> {
        let (values, vectors) = dense_general_eigen(&self.stiffness, &self.mass)?;
        let pairs = values.iter().zip(vectors);
        Ok(pairs
            .map(|(value, mut vector)| {
                // The sign of a mode is free: that of an entry larger than rounding is used.
                let points = &vector[..self.n_points];
                let largest = points.iter().fold(0.0_f64, |most, s| s.abs().max(most));
                let sign = points.iter().find(|s| s.abs() > 1e-3 * largest);
                if sign.is_some_and(|s| *s < 0.0) {
                    vector.iter_mut().for_each(|x| *x = -*x);
                }
                let mode = PointMode {
                    frequency_hz: value.max(0.0).sqrt() / std::f64::consts::TAU,
                    shape: vector[..self.n_points].to_vec(),
                    participation: dot(&vector, &self.base_load),
                };
                (mode, vector)
            })
            .collect())
    }
}
