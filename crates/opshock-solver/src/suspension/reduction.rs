//! Craig-Bampton reduction of the suspension's beam model to its dimple.
//!
//! Coordinates: the dimple's displacement with the static shape ψ that belongs to a force there,
//! and the lowest modes φᵢ of the beam pinned at the dimple (mass-normalised):
//!
//! ```text
//! w = ψ u₀ + Σ φᵢ uᵢ,   K = diag(k₀, ω₁², ω₂², …),   M = [ψᵀMψ  ψᵀMφ ; ·  1],   f = (ψᵀM1, φᵀM1)
//! ```
//!
//! ψᵀM1 is the effective shock mass at the dimple: the static reaction at a fixed dimple under a uniform inertia load a
//! is f₀ a.
//!
//! Damping is the same ratio ζ for every natural mode Φ of the reduced beam with the dimple free: in the
//! coordinates η of those modes, u = Φ η, mass, damping and stiffness are 1, diag(2 ζ ω) and diag(ω²), or
//! C = M Φ diag(2 ζ ω) Φᵀ M in u. With Rayleigh damping C = α M + β K, 2 ζ ω is α + β ω².
//!
//! With a lift tab one more shape is kept: the static shape of a force at the tab's end with the dimple fixed, less its
//! part in the kept modes. It is orthogonal to them in M and K, so it enters like one of them, at the frequency of its
//! Rayleigh quotient. The tab then has exactly the compliance of the finite elements (attachment mode).
//!
//! Sources: R. R. Craig, M. C. C. Bampton, AIAA J. 6 (1968) 1313; R. R. Craig, C.-J. Chang (1977).

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use super::beam::BeamMatrices;
use super::error::SuspensionError;
use super::modes::{self, Clamped, SuspensionMode};
use super::parameters::SuspensionParameters;

/// Share of a static shape's mass below which the modes are taken to contain all of it.
const HELD: f64 = 1e-20;

/// One reduced set: coordinate 0 is the dimple's, the others are pinned modes.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Mass, n × n.
    pub mass: DMatrix<f64>,
    /// Stiffness, diagonal, n.
    pub stiffness: DVector<f64>,
    /// 2 ζ ω of the natural modes, n, 1/s.
    pub decay_per_s: DVector<f64>,
    /// Natural modes Φ with the dimple free, mass-normalised columns by rising frequency, n × n.
    pub natural_modes: DMatrix<f64>,
    /// Their circular frequencies ω, n, rad/s.
    pub natural_rad_per_s: DVector<f64>,
    /// Generalised force of a unit inertia load per mass, n.
    pub inertia_load: DVector<f64>,
    /// Slope dw/dx at the dimple per coordinate, n (zero for torsion), 1/m and 1/(√kg m).
    pub slope_row: DVector<f64>,
    /// Rise of the tab's end per coordinate, n; bending of a suspension with a lift tab.
    pub tab_row: Option<DVector<f64>>,
    /// Frequencies of the finite elements with the dimple free, Hz, as many as coordinates.
    pub free_hz: Vec<f64>,
    /// Frequencies with the dimple fixed, Hz, one for each pinned mode kept.
    pub pinned_hz: Vec<f64>,
}

impl Reduction {
    /// Coordinates.
    pub fn len(&self) -> usize {
        self.stiffness.len()
    }

    /// A row over the coordinates, or a load on them, over the natural modes: Φᵀ `row`.
    ///
    /// # Panics
    /// When `row` has not n entries.
    pub fn in_natural_modes(&self, row: &DVector<f64>) -> DVector<f64> {
        self.natural_modes.tr_mul(row)
    }

    /// Whether there are no coordinates; never true for a built suspension.
    pub fn is_empty(&self) -> bool {
        self.stiffness.is_empty()
    }
}

/// The suspension as a head sees it.
#[derive(Clone, Debug)]
pub struct ReducedSuspension {
    /// Mass of hinge, load beam and flexure, kg.
    pub mass_kg: f64,
    /// Bending: coordinate 0 is the dimple's z, m.
    pub bending: Reduction,
    /// Torsion: coordinate 0 is the dimple's roll, rad.
    pub torsion: Reduction,
}

impl ReducedSuspension {
    /// Builds and reduces a suspension. Keeps `bending_modes` pinned bending modes, and half as many pinned torsion
    /// modes (rounded up, at most all), whose frequencies lie twice as far apart.
    ///
    /// # Errors
    /// Invalid geometry, or more modes than the elements have.
    pub fn build(
        parameters: &SuspensionParameters,
        bending_modes: usize,
    ) -> Result<Self, SuspensionError> {
        let ([mut bending, torsion], mass_kg) = clamped(parameters)?;
        if parameters.lift_tab.is_none() {
            bending.tab = None;
        } else if bending.tab.is_none() {
            return Err(SuspensionError::NoTab);
        }
        let bending_modes = match parameters.modes.is_empty() {
            true => bending_modes,
            // All modes where there are fewer.
            false => bending_modes.min(bending.mass.nrows() - 1),
        };
        let all_torsion = torsion.mass.nrows() - 1;
        Ok(Self {
            mass_kg,
            bending: reduce(&bending, bending_modes, parameters)?,
            torsion: reduce(
                &torsion,
                bending_modes.div_ceil(2).min(all_torsion),
                parameters,
            )?,
        })
    }

    /// Number of all pinned bending modes; with all of them the reduction is exact.
    ///
    /// # Errors
    /// Invalid geometry.
    pub fn most_bending_modes(parameters: &SuspensionParameters) -> Result<usize, SuspensionError> {
        let ([bending, _], _) = clamped(parameters)?;
        Ok(bending.mass.nrows() - 1)
    }

    /// Stiffness against a vertical force at the dimple, N/m.
    pub fn dimple_stiffness_n_per_m(&self) -> f64 {
        self.bending.stiffness[0]
    }

    /// Roll stiffness at the dimple, N m/rad.
    pub fn roll_stiffness_n_m_per_rad(&self) -> f64 {
        self.torsion.stiffness[0]
    }

    /// Reaction at a fixed dimple per uniform inertia load, kg.
    pub fn effective_shock_mass_kg(&self) -> f64 {
        self.bending.inertia_load[0]
    }
}

/// Bending and torsion of the suspension on its base, and its mass, kg.
fn clamped(parameters: &SuspensionParameters) -> Result<([Clamped; 2], f64), SuspensionError> {
    if parameters.modes.is_empty() {
        let beam = BeamMatrices::assemble(parameters)?;
        let mass_kg = beam.mass_kg;
        return Ok((beam.clamped(), mass_kg));
    }
    // The mass that moves: with all modes, that of everything but the root.
    let moving = |mode: &SuspensionMode| mode.participation_sqrt_kg.powi(2);
    let mass_kg = parameters.modes.iter().map(moving).sum();
    Ok((modes::clamped(&parameters.modes)?, mass_kg))
}

fn reduce(
    body: &Clamped,
    n_modes: usize,
    parameters: &SuspensionParameters,
) -> Result<Reduction, SuspensionError> {
    let Clamped {
        stiffness,
        mass,
        load,
        interface,
        slope,
        tab,
    } = body;
    let interface = *interface;
    let n = stiffness.nrows();
    if n_modes + 1 > n {
        return Err(SuspensionError::TooManyModes {
            wanted: n_modes,
            available: n - 1,
        });
    }
    let factor = Cholesky::new(stiffness.clone()).ok_or(SuspensionError::Singular {
        matrix: "stiffness",
    })?;
    let mut unit = DVector::zeros(n);
    unit[interface] = 1.0;
    let flexibility = factor.solve(&unit);
    let interface_stiffness = 1.0 / flexibility[interface];
    let shape = flexibility * interface_stiffness;

    let pinned_stiffness = stiffness
        .clone()
        .remove_row(interface)
        .remove_column(interface);
    let pinned_mass = mass.clone().remove_row(interface).remove_column(interface);
    let (pinned, modes) = lowest_modes(pinned_stiffness.clone(), &pinned_mass, n_modes)?;
    let (mut omegas, mut modes) = (pinned.clone(), modes);
    if let Some(tab) = tab {
        let at = if *tab > interface { tab - 1 } else { *tab };
        if let Some((omega, mode)) = attachment(pinned_stiffness, &pinned_mass, &modes, at)? {
            omegas.push(omega);
            modes = modes.insert_column(n_modes, 0.0);
            modes.set_column(n_modes, &mode);
        }
    }
    let modes = modes.insert_row(interface, 0.0);

    let size = omegas.len() + 1;
    let mut basis = DMatrix::zeros(n, size);
    basis.set_column(0, &shape);
    basis.columns_mut(1, size - 1).copy_from(&modes);
    let mut reduced_mass = basis.transpose() * mass * &basis;
    // The pinned block is the identity and the whole is symmetric by construction; this removes rounding errors.
    for i in 0..size {
        for j in 0..size {
            if i > 0 && j > 0 {
                reduced_mass[(i, j)] = f64::from(i == j);
            } else if j > i {
                reduced_mass[(j, i)] = reduced_mass[(i, j)];
            }
        }
    }
    let mut reduced_stiffness = DVector::from_element(size, interface_stiffness);
    for (k, omega) in reduced_stiffness.iter_mut().skip(1).zip(&omegas) {
        *k = omega * omega;
    }
    let (omega, natural_modes) = lowest_modes(
        DMatrix::from_diagonal(&reduced_stiffness),
        &reduced_mass,
        size,
    )?;

    let (free, _) = lowest_modes(stiffness.clone(), mass, size)?;
    let to_hz = |omega: &[f64]| omega.iter().map(|w| w / std::f64::consts::TAU).collect();
    Ok(Reduction {
        mass: reduced_mass,
        stiffness: reduced_stiffness,
        decay_per_s: DVector::from_iterator(size, omega.iter().map(|w| parameters.decay_per_s(*w))),
        natural_modes,
        natural_rad_per_s: DVector::from_vec(omega),
        inertia_load: basis.transpose() * load,
        slope_row: basis.transpose() * slope,
        tab_row: tab.map(|tab| basis.row(tab).transpose()),
        free_hz: to_hz(&free),
        pinned_hz: to_hz(&pinned),
    })
}

/// Static shape of a unit force at unknown `at`, less its part in the mass-normalised `modes`: its circular frequency
/// and its mass-normalised shape; `None` when the modes contain all of it.
fn attachment(
    stiffness: DMatrix<f64>,
    mass: &DMatrix<f64>,
    modes: &DMatrix<f64>,
    at: usize,
) -> Result<Option<(f64, DVector<f64>)>, SuspensionError> {
    let factor = Cholesky::new(stiffness.clone()).ok_or(SuspensionError::Singular {
        matrix: "stiffness",
    })?;
    let mut unit = DVector::zeros(stiffness.nrows());
    unit[at] = 1.0;
    let whole = factor.solve(&unit);
    let size = |x: &DVector<f64>| x.dot(&(mass * x));
    let mut rest = whole.clone();
    // Twice: the second pass removes the rounding errors of the first.
    for _ in 0..2 {
        let shares = modes.transpose() * (mass * &rest);
        rest -= modes * shares;
    }
    let square = size(&rest);
    if square <= HELD * size(&whole) {
        return Ok(None);
    }
    rest /= square.sqrt();
    let omega = rest.dot(&(&stiffness * &rest)).sqrt();
    Ok(Some((omega, rest)))
}

/// Lowest `n_modes` of K φ = ω² M φ: circular frequencies in rising order and mass-normalised
/// modes with a positive entry of largest magnitude.
///
/// With K = L Lᵀ it solves (L⁻¹ M L⁻ᵀ) y = ω⁻² y: the wanted modes are then the largest
/// eigenvalues and keep full relative accuracy, however high the highest frequency is.
pub(super) fn lowest_modes(
    stiffness: DMatrix<f64>,
    mass: &DMatrix<f64>,
    n_modes: usize,
) -> Result<(Vec<f64>, DMatrix<f64>), SuspensionError> {
    let n = stiffness.nrows();
    if n_modes == 0 {
        return Ok((Vec::new(), DMatrix::zeros(n, 0)));
    }
    let factor = Cholesky::new(stiffness).ok_or(SuspensionError::Singular {
        matrix: "stiffness",
    })?;
    let lower = factor.l();
    let singular = SuspensionError::Singular {
        matrix: "stiffness",
    };
    let half = lower.solve_lower_triangular(mass).ok_or(singular)?;
    let standard = lower
        .solve_lower_triangular(&half.transpose())
        .ok_or(singular)?;
    let standard = (&standard + standard.transpose()) * 0.5;
    let eigen = SymmetricEigen::new(standard);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let mut frequencies = Vec::with_capacity(n_modes);
    let mut modes = DMatrix::zeros(n, n_modes);
    for (column, &k) in order.iter().take(n_modes).enumerate() {
        let value = eigen.eigenvalues[k];
        if value <= 0.0 {
            return Err(SuspensionError::Singular { matrix: "mass" });
        }
        frequencies.push(value.sqrt().recip());
        let y = eigen.eigenvectors.column(k).into_owned();
        let mut mode = lower.tr_solve_lower_triangular(&y).ok_or(singular)?;
        let norm = mode.dot(&(mass * &mode)).sqrt();
        let largest = mode[mode.icamax()];
        mode *= largest.signum() / norm;
        modes.set_column(column, &mode);
    }
    Ok((frequencies, modes))
}
