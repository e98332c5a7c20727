//! Discretises one circumferential harmonic of the plate by radial finite elements.
//!
//! With w = φ(r) cos nθ, bending stiffness D and membrane stress σr, σθ (see `theory.md`):
//!
//! ```text
//! m  = g ∫ ρ h φ² r dr                                   g = 2π for n = 0, π for n ≥ 1
//! k  = g ∫ { D [φ″² + κ² + 2 ν φ″ κ + 2 (1 − ν) n² τ²]
//!           + h [σr φ′² + σθ n² φ²/r²] } r dr
//! κ = φ′/r − n² φ/r²,    τ = φ′/r − φ/r²
//! ```
//!
//! k is a polynomial in n²: with the three matrices of its coefficients integrated once
//! ([`HarmonicFamily`]) every harmonic is a sum of them.
//!
//! Cubic Hermite elements (unknowns φ and φ′ at the nodes), eigenvalues converge with order 4 in
//! the element length; φ = φ′ = 0 at the clamp.

use super::membrane::MembraneStress;
use super::parameters::DiskParameters;
use crate::linalg::SymmetricBand;

/// Points and weights of the Gauss rule on (0, 1) used in every element.
///
/// Six points leave an error far below the discretisation's although 1/r³ is no polynomial.
const GAUSS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_7, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_5, 0.233_956_967_286_345_5),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_5),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// Uniform radial mesh between the clamp and the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialMesh {
    inner_radius_m: f64,
    element_m: f64,
    n_elements: usize,
}

impl RadialMesh {
    /// `n_elements` equal elements.
    pub fn new(disk: &DiskParameters, n_elements: usize) -> Self {
        Self {
            inner_radius_m: disk.inner_radius_m,
            element_m: (disk.outer_radius_m - disk.inner_radius_m) / n_elements as f64,
            n_elements,
        }
    }

    /// Unknowns: displacement and slope at every node but the clamped one.
    pub fn n_unknowns(&self) -> usize {
        2 * self.n_elements
    }

    /// Rows that give (φ, φ′) at radius `r_m` from the unknowns.
    pub fn interpolation(&self, r_m: f64) -> (Vec<f64>, Vec<f64>) {
        let s = (r_m - self.inner_radius_m) / self.element_m;
        let e = (s.floor().max(0.0) as usize).min(self.n_elements - 1);
        let shape = hermite(s - e as f64, self.element_m);
        let mut rows = (vec![0.0; self.n_unknowns()], vec![0.0; self.n_unknowns()]);
        for (local, &[value, slope, _]) in shape.iter().enumerate() {
            if let Some(i) = unknown(e, local) {
                rows.0[i] = value;
                rows.1[i] = slope;
            }
        }
        rows
    }
}

/// Unknowns of two neighbouring nodes share an element: three diagonals beside the main one.
pub type Band = SymmetricBand<3>;

/// Stiffness, mass and uniform load of one harmonic.
#[derive(Clone, Debug)]
pub struct HarmonicMatrices {
    /// Stiffness, N/m per unit shape.
    pub stiffness: Band,
    /// Mass, kg.
    pub mass: Band,
    /// Inertia along the rigid motion of the harmonic: ∫ ρ h φ dA of a unit displacement for n = 0,
    /// kg; ∫ ρ h φ r cos²θ dA of a unit tilt for n = 1, kg m; zero above.
    pub rigid_load: Vec<f64>,
}

/// Matrices from which those of all harmonics are summed, per radian of angular weight g.
#[derive(Clone, Debug)]
pub struct HarmonicFamily {
    /// Factors of 1, n² and n⁴ in the stiffness.
    stiffness: [Band; 3],
    mass: Band,
    /// ∫ ρ h φ r dr and ∫ ρ h φ r² dr.
    loads: [Vec<f64>; 2],
}

impl HarmonicFamily {
    /// Integrates over the mesh.
    pub fn new(disk: &DiskParameters, stress: &MembraneStress, mesh: &RadialMesh) -> Self {
        let size = mesh.n_unknowns();
        let mut all = Self {
            stiffness: std::array::from_fn(|_| Band::zeros(size)),
            mass: Band::zeros(size),
            loads: [vec![0.0; size], vec![0.0; size]],
        };
        let nu = disk.poisson;
        let d = disk.youngs_modulus_pa * disk.thickness_m.powi(3) / (12.0 * (1.0 - nu * nu));
        let shapes = GAUSS.map(|(x, _)| hermite(x, mesh.element_m));
        for e in 0..mesh.n_elements {
            for ((x, weight), shape) in GAUSS.into_iter().zip(&shapes) {
                let r = mesh.inner_radius_m + (e as f64 + x) * mesh.element_m;
                let (sr, st) = stress.at(r);
                let area = weight * mesh.element_m * r;
                let bending = area * d;
                let membrane = area * disk.thickness_m;
                let mass = area * disk.density_kg_per_m3 * disk.thickness_m;
                // κ = slope − n² over, τ = slope − over.
                let parts = shape.map(|[value, first, second]| {
                    let (slope, over) = (first / r, value / (r * r));
                    [value, first, second, slope, over, slope - over]
                });
                for (a, &[va, da, dda, sa, oa, ta]) in parts.iter().enumerate() {
                    let Some(i) = unknown(e, a) else { continue };
                    all.loads[0][i] += mass * va;
                    all.loads[1][i] += mass * r * va;
                    for (b, &[vb, db, ddb, sb, ob, tb]) in parts.iter().enumerate().take(a + 1) {
                        let Some(j) = unknown(e, b) else { continue };
                        let plain = bending * (dda * ddb + sa * sb + nu * (dda * sb + sa * ddb))
                            + membrane * sr * da * db;
                        let turned = bending
                            * (2.0 * (1.0 - nu) * ta * tb
                                - (sa * ob + oa * sb)
                                - nu * (dda * ob + oa * ddb))
                            + membrane * st * va * ob;
                        all.stiffness[0].add(i, j, plain);
                        all.stiffness[1].add(i, j, turned);
                        all.stiffness[2].add(i, j, bending * oa * ob);
                        all.mass.add(i, j, mass * va * vb);
                    }
                }
            }
        }
        all
    }

    /// Matrices of harmonic `n`.
    pub fn harmonic(&self, n: usize) -> HarmonicMatrices {
        let size = self.mass.order();
        let angular = if n == 0 { 2.0 } else { 1.0 } * std::f64::consts::PI;
        let n2 = (n * n) as f64;
        let (mut stiffness, mut mass) = (Band::zeros(size), Band::zeros(size));
        for (power, part) in [1.0, n2, n2 * n2].into_iter().zip(&self.stiffness) {
            stiffness.add_scaled(angular * power, part);
        }
        mass.add_scaled(angular, &self.mass);
        let load = self.loads.get(n).cloned();
        let mut rigid_load = load.unwrap_or_else(|| vec![0.0; size]);
        rigid_load.iter_mut().for_each(|load| *load *= angular);
        HarmonicMatrices {
            stiffness,
            mass,
            rigid_load,
        }
    }
}

/// Global unknown of local shape `local` (0, 1 at the inner node; 2, 3 at the outer) of element `e`.
fn unknown(e: usize, local: usize) -> Option<usize> {
    (2 * e + local).checked_sub(2)
}

/// Value, first and second derivative of the four cubic Hermite shapes at x in (0, 1).
fn hermite(x: f64, length: f64) -> [[f64; 3]; 4] {
    let (l, l2) = (length, length * length);
    [
        [
            1.0 - 3.0 * x * x + 2.0 * x * x * x,
            (-6.0 * x + 6.0 * x * x) / l,
            (-6.0 + 12.0 * x) / l2,
        ],
        [
            l * (x - 2.0 * x * x + x * x * x),
            1.0 - 4.0 * x + 3.0 * x * x,
            (-4.0 + 6.0 * x) / l,
        ],
        [
            3.0 * x * x - 2.0 * x * x * x,
            (6.0 * x - 6.0 * x * x) / l,
            (6.0 - 12.0 * x) / l2,
        ],
        [
            l * (x * x * x - x * x),
            3.0 * x * x - 2.0 * x,
            (6.0 * x - 2.0) / l,
        ],
    ]
}
