//! A suspension given by its natural modes on the base, to which another program's matrices reduce.
//!
//! ```text
//! q'' + ω² q = φ F + ρ T + p a(t),    z = Σ φ q,  dw/dx = Σ σ q,  roll = Σ ρ q   at the dimple
//! ```
//!
//! A suspension that is its own mirror image across the slider's middle has modes that bend (φ, σ, p) and modes that
//! twist (ρ), and none that do both; only such suspensions are accepted.
//!
//! The reduction to the dimple needs z itself as a coordinate. z replaces the lowest mode m that moves the dimple much,
//! q_m = (z − Σ φ q)/φ_m. The stiffnesses of the others then remain the largest entries of their rows, which Cholesky's
//! method factors without loss.

use nalgebra::{DMatrix, DVector};

use super::error::SuspensionError;

/// An oscillator of unit mass.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SuspensionMode {
    /// Undamped natural frequency on the base, Hz.
    pub frequency_hz: f64,
    /// Displacement z of the dimple, φ, 1/√kg.
    pub vertical_per_sqrt_kg: f64,
    /// Slope dw/dx at the dimple, σ, x from the root to the tip, 1/(m √kg).
    pub slope_per_m_sqrt_kg: f64,
    /// Roll at the dimple, ρ, 1/(m √kg).
    pub roll_per_m_sqrt_kg: f64,
    /// Load by a unit inertia load per mass, p, √kg.
    pub participation_sqrt_kg: f64,
}

/// Share of the largest displacement of the dimple above which z may replace a mode.
const MUCH: f64 = 0.1;

/// Equations of one set of unknowns of a clamped suspension.
#[derive(Clone, Debug)]
pub(super) struct Clamped {
    pub stiffness: DMatrix<f64>,
    pub mass: DMatrix<f64>,
    /// Load of a unit inertia load per mass.
    pub load: DVector<f64>,
    /// Unknown at which the slider acts.
    pub interface: usize,
    /// Row that gives dw/dx at the dimple.
    pub slope: DVector<f64>,
    /// Unknown that is the rise of the tab's end, where there is one.
    pub tab: Option<usize>,
}

/// Bending and torsion of these modes.
///
/// # Errors
/// Numbers out of range, a mode that both bends and twists, a set that does not move the dimple.
pub(super) fn clamped(modes: &[SuspensionMode]) -> Result<[Clamped; 2], SuspensionError> {
    for (k, mode) in modes.iter().enumerate() {
        let positive = mode.frequency_hz > 0.0 && mode.frequency_hz.is_finite();
        if !positive {
            return Err(SuspensionError::NotPositive {
                quantity: "frequency of a suspension mode",
                value: mode.frequency_hz,
            });
        }
        let bends = [
            mode.vertical_per_sqrt_kg,
            mode.slope_per_m_sqrt_kg,
            mode.participation_sqrt_kg,
        ];
        let is_bending = bends.iter().any(|x| *x != 0.0);
        if is_bending && mode.roll_per_m_sqrt_kg != 0.0 {
            return Err(SuspensionError::Coupled { mode: k });
        }
    }
    let (torsion, bending): (Vec<SuspensionMode>, Vec<SuspensionMode>) = modes
        .iter()
        .partition(|mode| mode.roll_per_m_sqrt_kg != 0.0);
    Ok([
        with_interface(&bending, |mode| mode.vertical_per_sqrt_kg, "z")?,
        with_interface(&torsion, |mode| mode.roll_per_m_sqrt_kg, "roll")?,
    ])
}

/// Equations whose last unknown is the one that `shape` gives.
fn with_interface(
    modes: &[SuspensionMode],
    shape: impl Fn(&SuspensionMode) -> f64,
    what: &'static str,
) -> Result<Clamped, SuspensionError> {
    let largest = modes
        .iter()
        .fold(0.0_f64, |most, m| shape(m).abs().max(most));
    let n = modes.len();
    let moves = |mode: &SuspensionMode| largest > 0.0 && shape(mode).abs() >= MUCH * largest;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| modes[a].frequency_hz.total_cmp(&modes[b].frequency_hz));
    let Some(&given_up) = order.iter().find(|&&k| moves(&modes[k])) else {
        return Err(SuspensionError::Unmoved { what });
    };
    // Columns of q = T x: the kept modes, then z.
    let mut basis = DMatrix::zeros(n, n);
    let at = shape(&modes[given_up]);
    let kept = order.iter().copied().filter(|&k| k != given_up);
    for (column, k) in kept.enumerate() {
        basis[(k, column)] = 1.0;
        basis[(given_up, column)] = -shape(&modes[k]) / at;
    }
    basis[(given_up, n - 1)] = 1.0 / at;
    let squares = modes
        .iter()
        .map(|mode| (std::f64::consts::TAU * mode.frequency_hz).powi(2));
    let squares = DMatrix::from_diagonal(&DVector::from_iterator(n, squares));
    let row = |of: fn(&SuspensionMode) -> f64| DVector::from_iterator(n, modes.iter().map(of));
    Ok(Clamped {
        stiffness: basis.transpose() * squares * &basis,
        mass: basis.transpose() * &basis,
        load: basis.transpose() * row(|mode| mode.participation_sqrt_kg),
        interface: n - 1,
        slope: basis.transpose() * row(|mode| mode.slope_per_m_sqrt_kg),
        tab: None,
    })
}
