//! Checks that matrices can be those of a structure: symmetric, M positive definite, K positive semi-definite, and no
//! motion without stiffness unless the structure is free.
//!
//! With λ = ω² the eigenvalues of K x = λ M x, the signs of the pivots of K ± ε M give the number of λ below ∓ε. ε is
//! 1e-11 of the largest λ; rounding of K moves an eigenvalue by less. Between −ε and ε, a rigid motion is distinguished
//! from a soft spring beside stiff ones by its forces: they cancel in every row.

use super::entries::place;
use super::envelope::{Envelope, Factors, MAX_ENVELOPE};
use super::sparse::Matrix;
use super::system::System;
use crate::fault::{Fault, Faults};

/// Asymmetry that is averaged, relative to the diagonals of row and column.
pub const SMALL_ASYMMETRY: f64 = 1e-8;

/// Share of the largest eigenvalue below which an eigenvalue is taken as zero.
const ZERO_SHARE: f64 = 1e-11;

/// Shift of inverse iteration, relative to the largest eigenvalue.
const LOW_SHARE: f64 = 1e-13;

/// Most modes of low frequency that are examined one by one.
const MANY: usize = 12;

/// Largest force of a rigid motion that remains in a row, relative to what the row's stiffness could produce.
const RIGID: f64 = 1e-10;

/// Share of its diagonal below which a pivot of M is taken as zero.
const ZERO_PIVOT: f64 = 1e-14;

/// Ratio of eigenvalues beyond which half of the digits of a double are lost (W208).
const LARGEST_RATIO: f64 = 1e14;

/// Figures of accepted matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Largest asymmetry of M and K, relative; averaged.
    pub asymmetry: f64,
    /// Sum of M over displacements along x, y, z, kg; `None` when freedoms are not known.
    pub total_mass_kg: Option<[f64; 3]>,
    /// Motions without stiffness.
    pub n_rigid: usize,
    /// Lowest frequency of the other motions, Hz; `None` when there is none or it did not converge.
    pub lowest_hz: Option<f64>,
    /// Approximate highest frequency, Hz.
    pub highest_hz: f64,
    /// Warnings: W208 conditioning, W206 unusual mass or frequency.
    pub warnings: Vec<Fault>,
}

/// Checks a system and makes its matrices symmetric.
///
/// # Errors
/// E161 when it is too large to be factorised, E162, E163, E164, E165 unless `free`, E172.
pub fn check(system: System, free: bool) -> Result<(System, Found), Faults> {
    let mut faults = Faults::default();
    let asymmetry = [&system.mass, &system.stiffness]
        .map(|matrix| symmetric(matrix, &mut faults))
        .into_iter()
        .fold(0.0, f64::max);
    if let Some(gyroscopic) = &system.gyroscopic {
        skew(gyroscopic, &mut faults);
    }
    faults.or(())?;
    let system = System {
        mass: system.mass.symmetrised(),
        stiffness: system.stiffness.symmetrised(),
        ..system
    };
    let Some(envelope) = Envelope::of(&[&system.mass, &system.stiffness]) else {
        let message = format!("the factors have more than {MAX_ENVELOPE} numbers");
        let fault = Fault::of("E161", &system.stiffness.file, message);
        return Err(fault
            .value(format!("{} rows", system.n()))
            .hint("reduce the model first")
            .into());
    };
    let mass = definite_mass(&system, &envelope)?;
    let highest = highest_eigenvalue(&system, &mass);
    let zero = ZERO_SHARE * highest;
    let factor = |shift: f64| envelope.factor(&system.stiffness, shift, Some(&system.mass));
    let negative = factor(zero).n_negative().unwrap_or(usize::MAX);
    if negative > 0 {
        return Err(negative_stiffness(&system, &envelope, highest).into());
    }
    let n_low = factor(-zero).n_negative().unwrap_or(usize::MAX);
    let low = lowest_modes(&system, &factor(LOW_SHARE * highest), n_low);
    let n_rigid = match &low {
        Some(modes) => modes
            .iter()
            .filter(|mode| is_rigid(&system.stiffness, &mode.1))
            .count(),
        None => n_low,
    };
    if n_rigid > 0 && !(free && n_rigid <= 6) {
        return Err(loose(&system, n_rigid, free).into());
    }
    let stiff = |mode: &&(f64, Vec<f64>)| !is_rigid(&system.stiffness, &mode.1);
    let lowest = low
        .as_ref()
        .and_then(|modes| modes.iter().find(stiff))
        .map(|mode| mode.0);
    let hertz = |value: f64| value.max(0.0).sqrt() / std::f64::consts::TAU;
    let mut found = Found {
        asymmetry,
        total_mass_kg: total_mass(&system),
        n_rigid,
        lowest_hz: lowest.map(hertz),
        highest_hz: hertz(highest),
        warnings: Vec::new(),
    };
    found.warnings = warnings(&system, &found);
    Ok((system, found))
}

/// Largest relative asymmetry; E162 beyond [`SMALL_ASYMMETRY`].
fn symmetric(matrix: &Matrix, faults: &mut Faults) -> f64 {
    let most = matrix.entries().map(|e| e.value.abs()).fold(0.0, f64::max);
    let mut worst = (0.0_f64, 0, 0);
    for e in matrix.entries() {
        let scale = (matrix.get(e.row, e.row) * matrix.get(e.column, e.column))
            .abs()
            .sqrt();
        let scale = if scale > 0.0 { scale } else { most };
        let apart = (e.value - matrix.get(e.column, e.row)).abs() / scale;
        if apart > worst.0 {
            worst = (apart, e.row, e.column);
        }
    }
    let (apart, row, column) = worst;
    if apart > SMALL_ASYMMETRY {
        let (value, mirrored) = (matrix.get(row, column), matrix.get(column, row));
        faults.push(
            Fault::of("E162", &matrix.file, "the matrix is not symmetric")
                .what(place(row, column))
                .value(format!("{value:e}, mirrored {mirrored:e} (SI)"))
                .allowed(format!(
                    "a difference of at most {SMALL_ASYMMETRY:e} of the diagonals"
                ))
                .hint("the largest difference of all; is one triangle stored?"),
        );
    }
    apart
}

/// E172 for a gyroscopic matrix that is not skew.
fn skew(matrix: &Matrix, faults: &mut Faults) {
    let most = matrix.entries().map(|e| e.value.abs()).fold(0.0, f64::max);
    let mut worst = (0.0_f64, 0, 0);
    for e in matrix.entries() {
        let sum = (e.value + matrix.get(e.column, e.row)).abs();
        if sum > worst.0 {
            worst = (sum, e.row, e.column);
        }
    }
    let (sum, row, column) = worst;
    if sum > SMALL_ASYMMETRY * most {
        let (value, mirrored) = (matrix.get(row, column), matrix.get(column, row));
        faults.push(
            Fault::of("E172", &matrix.file, "the gyroscopic matrix is not skew")
                .what(place(row, column))
                .value(format!("{value:e}, mirrored {mirrored:e} (SI)"))
                .allowed("G = -Gᵀ: the mirrored entry is the negative"),
        );
    }
}

/// Factors of M; E163 when it is not positive definite.
fn definite_mass<'a>(system: &System, envelope: &'a Envelope) -> Result<Factors<'a>, Faults> {
    let mass = &system.mass;
    let factors = envelope.factor(mass, 0.0, None);
    let Some((row, pivot)) = factors.first_not_above(|row| ZERO_PIVOT * mass.get(row, row).abs())
    else {
        return Ok(factors);
    };
    let diagonal = mass.get(row, row);
    let (message, hint) = if diagonal > 0.0 {
        (
            "the mass matrix is not positive definite: a pivot is not above 0",
            "freedoms that move together as one have to be condensed",
        )
    } else if diagonal < 0.0 {
        (
            "the mass matrix is not positive definite: a negative mass",
            "is a sign lost?",
        )
    } else {
        (
            "the mass matrix is not positive definite: a freedom without mass",
            "condense freedoms without mass, or use a consistent mass matrix",
        )
    };
    Err(Fault::of("E163", &mass.file, message)
        .what(format!("{} ({})", system.freedoms.name(row), row + 1))
        .value(format!("pivot {pivot:.3e}, diagonal {diagonal:.3e}"))
        .allowed("above 0")
        .hint(hint)
        .into())
}

/// Largest λ of K x = λ M x, to a few per cent, by power iteration with M⁻¹ K.
fn highest_eigenvalue(system: &System, mass: &Factors<'_>) -> f64 {
    let n = system.n();
    let mut x: Vec<f64> = (0..n).map(mixed).collect();
    let mut image = vec![0.0; n];
    let mut highest = 0.0_f64;
    for _ in 0..60 {
        system.stiffness.apply(&x, &mut image);
        mass.solve(&mut image);
        let size = norm(&image);
        let before = norm(&x);
        if !(size.is_finite() && before > 0.0 && size > 0.0) {
            break;
        }
        highest = highest.max(size / before);
        x.iter_mut().zip(&image).for_each(|(x, y)| *x = y / size);
    }
    // A zero stiffness matrix gets its scale from the mass alone.
    if highest > 0.0 { highest } else { 1.0 }
}

/// Modes with λ below the zero share, at most [`MANY`], and the one above: inverse iteration, each orthogonal to those
/// before. `None` when it does not converge to finite numbers.
fn lowest_modes(
    system: &System,
    shifted: &Factors<'_>,
    n_low: usize,
) -> Option<Vec<(f64, Vec<f64>)>> {
    let n = system.n();
    if n_low > MANY {
        return None;
    }
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for k in 0..(n_low + 1).min(n) {
        let mut x: Vec<f64> = (0..n).map(|i| mixed(i + 7919 * (k + 1))).collect();
        let (mut load, mut value, mut last) = (vec![0.0; n], 0.0, f64::INFINITY);
        for _ in 0..500 {
            // M-orthogonal to the vectors before, of unit mass.
            system.mass.apply(&x, &mut load);
            for (_, other) in &found {
                let share = dot(other, &load);
                x.iter_mut().zip(other).for_each(|(x, o)| *x -= share * o);
            }
            system.mass.apply(&x, &mut load);
            let size = dot(&x, &load).sqrt();
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            x.iter_mut().for_each(|x| *x /= size);
            system.stiffness.apply(&x, &mut load);
            value = dot(&x, &load);
            if (value - last).abs() <= 1e-10 * value.abs() {
                break;
            }
            last = value;
            system.mass.apply(&x, &mut load);
            shifted.solve(&mut load);
            std::mem::swap(&mut x, &mut load);
        }
        found.push((value, x));
    }
    Some(found)
}

/// Whether the forces K x cancel: whether they are negligible beside what each row's stiffness could produce. A soft
/// spring has a force of its own, however stiff its neighbours are.
fn is_rigid(stiffness: &Matrix, x: &[f64]) -> bool {
    let largest = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (0..stiffness.n_rows).all(|row| {
        let force: f64 = stiffness
            .row(row)
            .map(|(column, value)| value * x[column])
            .sum();
        let size: f64 = stiffness.row(row).map(|(_, value)| value.abs()).sum();
        force.abs() <= RIGID * size * largest
    })
}

/// E164 with the lowest eigenvalue.
fn negative_stiffness(system: &System, envelope: &Envelope, highest: f64) -> Fault {
    // No eigenvalue lies below `low`, one lies below `high`.
    let n_below = |value: f64| {
        let factors = envelope.factor(&system.stiffness, -value, Some(&system.mass));
        factors.n_negative().unwrap_or(1)
    };
    let (mut low, mut high) = (-2.0 * highest, -ZERO_SHARE * highest);
    for _ in 0..40 {
        if n_below(low) == 0 {
            break;
        }
        low *= 2.0;
    }
    for _ in 0..80 {
        let middle = -(low * high).sqrt();
        if (low - high).abs() < 1e-3 * high.abs() {
            break;
        }
        if n_below(middle) > 0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let message = "the stiffness matrix has a negative eigenvalue: the structure is unstable";
    Fault::of("E164", &system.stiffness.file, message)
        .value(format!(
            "{:.3e} (rad/s)^2 of K x = w^2 M x",
            0.5 * (low + high)
        ))
        .allowed("0 or more")
        .hint("is a sign lost, or the model loaded beyond buckling?")
}

/// E165 with the number of motions without stiffness.
fn loose(system: &System, n_rigid: usize, free: bool) -> Fault {
    let fault = Fault::of("E165", &system.stiffness.file, "motions without stiffness")
        .value(n_rigid.to_string());
    if free {
        fault
            .allowed("at most 6 of a free body")
            .hint("parts that hang together by nothing, or a hinge")
    } else {
        fault
            .allowed("none: a ramp or a suspension is bolted to the base")
            .hint("fix the nodes at the mount, or say that the body is free")
    }
}

/// Sum of M over displacements along each direction.
fn total_mass(system: &System) -> Option<[f64; 3]> {
    use super::dof::Direction;
    if !system.freedoms.are_named() {
        return None;
    }
    let along = |k: u8| {
        let moves = |row: usize| {
            let freedom = system.freedoms.get(row);
            freedom.is_some_and(|freedom| freedom.direction == Direction::Along(k))
        };
        let of_both = system
            .mass
            .entries()
            .filter(|e| moves(e.row) && moves(e.column));
        of_both.map(|e| e.value).sum()
    };
    Some([0, 1, 2].map(along))
}

fn warnings(system: &System, found: &Found) -> Vec<Fault> {
    let mut warnings = Vec::new();
    if let Some(lowest) = found.lowest_hz {
        let ratio = (found.highest_hz / lowest).powi(2);
        if ratio > LARGEST_RATIO {
            let message = "the stiffness is badly conditioned";
            warnings.push(
                Fault::of("W208", &system.stiffness.file, message)
                    .value(format!("ratio of eigenvalues {ratio:.1e}"))
                    .allowed(format!("up to {LARGEST_RATIO:e}")),
            );
        }
        if !(1.0..=1e6).contains(&lowest) {
            let message = "the lowest frequency is no ramp's or suspension's: other units?";
            warnings.push(
                Fault::of("W206", &system.stiffness.file, message)
                    .value(format!("{lowest:.4e} Hz"))
                    .allowed("1 Hz to 1 MHz")
                    .hint(units_hint()),
            );
        }
    }
    let heaviest = found
        .total_mass_kg
        .map(|mass| mass.into_iter().fold(0.0, f64::max));
    if let Some(mass) = heaviest.filter(|mass| !(1e-9..=1.0).contains(mass)) {
        let message = "the mass is no ramp's or suspension's: other units?";
        warnings.push(
            Fault::of("W206", &system.mass.file, message)
                .value(format!("{mass:.4e} kg"))
                .allowed("1e-9 to 1 kg")
                .hint(units_hint()),
        );
    }
    warnings
}

fn units_hint() -> String {
    "units are si (N, m, kg), mm_mn (mN, mm, kg) or mm_n (N, mm, t)".to_owned()
}

/// A number between -1 and 1, unrelated to any eigenvector.
fn mixed(k: usize) -> f64 {
    let bits = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
    bits as f64 / f64::from(1_u32 << 30) - 1.0
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
