//! Computes the modal basis of the disk, and decides which modes of each harmonic are kept.
//!
//! * n ≥ 1: every mode below the cut; harmonics whose lowest mode lies above the cut are left out.
//! * n = 0: it is the only harmonic in free motion, so it keeps at least [`MIN_SYMMETRIC_MODES`] and every mode below
//!   [`SYMMETRIC_CUT_FACTOR`] times the cut.
//! * Static correction: per harmonic the residual flexibility of a point load at the ramp,
//!   x = K⁻¹ f − Σ φ (φ·f)/ω², which is orthogonal to the kept modes in mass and stiffness and so
//!   is one more oscillator, of frequency (x·Kx / x·Mx)^½. With it the static compliance of the
//!   contact point is exact per harmonic. It is driven by the contact force only.
//!
//! Shapes are scaled to modal mass 1 kg.

use super::error::DiskError;
use super::harmonic::{HarmonicFamily, RadialMesh};
use super::membrane::MembraneStress;
use super::parameters::{DiskDamping, DiskParameters, DiskResolution};
use crate::linalg::dense::dot;
use crate::linalg::lowest;

/// Largest number of radial elements of a disk: 18 per bending wave of an aluminium platter at 7.7 MHz, where a wave is
/// hardly longer than the disk is thick. With more, rounding in the stiffness (its condition grows with the fourth
/// power) outweighs what they resolve.
pub const MOST_ELEMENTS: usize = 400;
/// Smallest number of modes kept for n = 0.
pub const MIN_SYMMETRIC_MODES: usize = 8;
/// Modes of n = 0 are kept up to this multiple of the cut.
pub const SYMMETRIC_CUT_FACTOR: f64 = 4.0;

/// One mode of the disk.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskMode {
    /// Nodal diameters n.
    pub nodal_diameters: usize,
    /// Nodal circles (index of the radial mode); `None` for a static correction.
    pub nodal_circles: Option<usize>,
    /// Undamped angular frequency in the rotating frame, rad/s.
    pub omega_rad_per_s: f64,
    /// Damping ratio in the rotating frame.
    pub damping_ratio: f64,
    /// Generalised force of a unit acceleration of the rigid motion of its harmonic: displacement for n = 0, kg^½; tilt
    /// for n = 1, kg^½ m; zero for higher n and for corrections.
    pub participation: f64,
    /// Radial shape at the given radii: (φ, φ′), kg^-½ and kg^-½/m.
    pub shape: Vec<(f64, f64)>,
}

/// Which harmonics a basis holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harmonics {
    /// n = 0: all that moves without a load that depends on the angle.
    Symmetric,
    /// n = 0 and n = 1: all that moves with a hub.
    Tilting,
    /// Every harmonic below the cut.
    All,
}

/// Modes, n rising, frequency rising within n.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskBasis {
    /// Modes.
    pub modes: Vec<DiskMode>,
    /// True when harmonics below the cut were left out because of `n_harmonics`.
    pub harmonics_bounded: bool,
}

/// Data from which the modes of a disk are computed, harmonic by harmonic.
#[derive(Clone, Debug)]
pub struct DiskModes {
    family: HarmonicFamily,
    damping: DiskDamping,
    resolution: DiskResolution,
    /// Rows that give (φ, φ′) at the given radii.
    rows: Vec<(Vec<f64>, Vec<f64>)>,
    correction_at: Option<usize>,
}

/// Modes of one harmonic.
struct HarmonicModes {
    modes: Vec<DiskMode>,
    /// How many of them lie below the cut.
    n_below: usize,
}

impl DiskModes {
    /// Shapes are sampled at `radii_m`; `correction_at` is the index into `radii_m` of the point whose static
    /// compliance is made exact, if any.
    ///
    /// # Errors
    /// Parameters out of range.
    pub fn new(
        disk: &DiskParameters,
        resolution: &DiskResolution,
        radii_m: &[f64],
        correction_at: Option<usize>,
    ) -> Result<Self, DiskError> {
        validate(disk, resolution)?;
        disk.hub.map_or(Ok(()), |hub| hub.validate())?;
        let mesh = RadialMesh::new(disk, resolution.n_elements);
        Ok(Self {
            family: HarmonicFamily::new(disk, &MembraneStress::new(disk), &mesh),
            damping: disk.damping,
            resolution: resolution.clone(),
            rows: radii_m.iter().map(|&r| mesh.interpolation(r)).collect(),
            correction_at,
        })
    }

    /// The harmonics of `harmonics` from `first` on. A second call that begins where the first ended gives the
    /// remaining ones of a single call.
    ///
    /// # Errors
    /// A failed eigenvalue problem.
    pub fn basis(&self, first: usize, harmonics: Harmonics) -> Result<DiskBasis, DiskError> {
        let mut basis = DiskBasis {
            modes: Vec::new(),
            harmonics_bounded: false,
        };
        let last = match harmonics {
            Harmonics::Symmetric => 0,
            Harmonics::Tilting => 1,
            Harmonics::All => usize::MAX,
        };
        // Lowest frequencies fall from n = 0 to 1 or 2 and rise from there on: two harmonics in
        // a row above the cut end the list.
        let mut n_above_cut = 0;
        for n in first..=last {
            let HarmonicModes { modes, n_below } = self.harmonic(n)?;
            n_above_cut = if n_below == 0 { n_above_cut + 1 } else { 0 };
            if n >= 2 && n_above_cut >= 2 {
                break;
            }
            if n > self.resolution.n_harmonics {
                basis.harmonics_bounded = n_below > 0;
                break;
            }
            basis.modes.extend(modes);
        }
        Ok(basis)
    }

    /// Modes of `n`, frequency rising, and the static correction.
    fn harmonic(&self, n: usize) -> Result<HarmonicModes, DiskError> {
        let failed = |source| DiskError::Modes {
            nodal_diameters: n,
            source,
        };
        let cut = std::f64::consts::TAU * self.resolution.cut_hz;
        let m = self.family.harmonic(n);
        let (limit, at_least) = match n {
            0 => (SYMMETRIC_CUT_FACTOR * cut, MIN_SYMMETRIC_MODES),
            _ => (cut, 0),
        };
        let pairs = lowest::modes_below(&m.stiffness, &m.mass, limit * limit, at_least);
        let pairs = pairs.map_err(failed)?;
        let sample = |x: &[f64]| -> Vec<(f64, f64)> {
            let rows = self.rows.iter();
            rows.map(|(value, slope)| (dot(value, x), dot(slope, x)))
                .collect()
        };
        let kept = pairs.values.iter().zip(&pairs.vectors).enumerate();
        let mut modes: Vec<_> = kept
            .map(|(j, (value, x))| DiskMode {
                nodal_diameters: n,
                nodal_circles: Some(j),
                omega_rad_per_s: value.sqrt(),
                damping_ratio: damping_ratio(&self.damping, value.sqrt()),
                participation: dot(&m.rigid_load, x),
                shape: sample(x),
            })
            .collect();
        let is_below = |mode: &&DiskMode| mode.omega_rad_per_s < cut;
        let n_below = match n {
            0 => modes.iter().take_while(is_below).count(),
            _ => modes.len(),
        };
        let at = match self.correction_at {
            Some(at) if self.resolution.static_correction && !modes.is_empty() => at,
            _ => return Ok(HarmonicModes { modes, n_below }),
        };
        let mut x = self.rows[at].0.clone();
        m.stiffness.cholesky().map_err(failed)?.solve(&mut x);
        // Two projections suffice against the rounding left by the first.
        for _ in 0..2 {
            let inertia = m.mass.times(&x);
            for y in &pairs.vectors {
                let share = dot(y, &inertia);
                for (xi, yi) in x.iter_mut().zip(y) {
                    *xi -= share * yi;
                }
            }
        }
        let mass = m.mass.form(&x, &x);
        let omega = (m.stiffness.form(&x, &x) / mass).sqrt();
        let scale = mass.sqrt().recip();
        if scale.is_finite() {
            x.iter_mut().for_each(|c| *c *= scale);
            modes.push(DiskMode {
                nodal_diameters: n,
                nodal_circles: None,
                omega_rad_per_s: omega,
                damping_ratio: damping_ratio(&self.damping, omega),
                participation: 0.0,
                shape: sample(&x),
            });
        }
        Ok(HarmonicModes { modes, n_below })
    }
}

impl DiskBasis {
    /// Basis with shapes sampled at `radii_m` ([`DiskModes::new`]). A symmetric basis holds the n = 0 modes
    /// of the whole one.
    ///
    /// # Errors
    /// Parameters out of range, or a failed eigenvalue problem.
    pub fn build(
        disk: &DiskParameters,
        resolution: &DiskResolution,
        radii_m: &[f64],
        correction_at: Option<usize>,
        harmonics: Harmonics,
    ) -> Result<Self, DiskError> {
        DiskModes::new(disk, resolution, radii_m, correction_at)?.basis(0, harmonics)
    }
}

/// Damping ratio of a mode of frequency `omega` in the rotating frame.
fn damping_ratio(damping: &DiskDamping, omega: f64) -> f64 {
    match *damping {
        DiskDamping::Rayleigh {
            alpha_per_s,
            beta_s,
        } => 0.5 * (alpha_per_s / omega + beta_s * omega),
        DiskDamping::ModalRatio(ratio) => ratio,
    }
}

/// Refuses a place off the free annulus.
///
/// # Errors
/// [`DiskError::OffTheDisk`].
pub fn validate_place(
    disk: &DiskParameters,
    place: &'static str,
    radius_m: f64,
) -> Result<(), DiskError> {
    if radius_m > disk.inner_radius_m && radius_m <= disk.outer_radius_m {
        Ok(())
    } else {
        Err(DiskError::OffTheDisk {
            place,
            radius_m,
            inner_m: disk.inner_radius_m,
            outer_m: disk.outer_radius_m,
        })
    }
}

fn validate(disk: &DiskParameters, resolution: &DiskResolution) -> Result<(), DiskError> {
    let positive = "finite and above 0";
    let not_negative = "finite and at least 0";
    let (first, second) = match disk.damping {
        DiskDamping::Rayleigh {
            alpha_per_s,
            beta_s,
        } => (alpha_per_s, beta_s),
        DiskDamping::ModalRatio(ratio) => (ratio, 0.0),
    };
    let checks = [
        (
            "inner_radius_m",
            disk.inner_radius_m,
            disk.inner_radius_m > 0.0,
            positive,
        ),
        (
            "outer_radius_m",
            disk.outer_radius_m,
            disk.outer_radius_m > disk.inner_radius_m,
            "above the inner radius",
        ),
        (
            "thickness_m",
            disk.thickness_m,
            disk.thickness_m > 0.0,
            positive,
        ),
        (
            "youngs_modulus_pa",
            disk.youngs_modulus_pa,
            disk.youngs_modulus_pa > 0.0,
            positive,
        ),
        (
            "density_kg_per_m3",
            disk.density_kg_per_m3,
            disk.density_kg_per_m3 > 0.0,
            positive,
        ),
        (
            "poisson",
            disk.poisson,
            disk.poisson > -1.0 && disk.poisson < 0.5,
            "-1 to 0.5",
        ),
        ("spin_rad_per_s", disk.spin_rad_per_s, true, "finite"),
        ("damping", first, first >= 0.0, not_negative),
        ("damping", second, second >= 0.0, not_negative),
        (
            "space_fixed_damping_per_s",
            disk.space_fixed_damping_per_s,
            disk.space_fixed_damping_per_s >= 0.0,
            not_negative,
        ),
        (
            "cut_hz",
            resolution.cut_hz,
            resolution.cut_hz > 0.0,
            positive,
        ),
        (
            "n_elements",
            resolution.n_elements as f64,
            (4..=MOST_ELEMENTS).contains(&resolution.n_elements),
            "4 to 400",
        ),
    ];
    for (name, value, ok, allowed) in checks {
        if !ok || !value.is_finite() {
            return Err(DiskError::Parameter {
                name,
                value,
                allowed,
            });
        }
    }
    Ok(())
}
