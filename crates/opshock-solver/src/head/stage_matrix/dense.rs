//! M, C, K and contacts of a head as dense matrices, for tests: built from the reduction, without its modes.

use super::super::sample::slider;
use crate::slider::body::Inertia;
use crate::suspension::{ContactLaw, ReducedSuspension, Reduction, SuspensionParameters};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A contact in the reduction's coordinates u.
pub struct Contact {
    pub row: DVector<f64>,
    pub steady_force_n: f64,
    pub n_per_m: f64,
    pub n_s_per_m: f64,
}

impl Contact {
    pub fn signed(&self, u: &DVector<f64>, w: &DVector<f64>) -> f64 {
        self.steady_force_n + self.n_per_m * self.row.dot(u) + self.n_s_per_m * self.row.dot(w)
    }
}

/// M, C, K and contacts in u: slider, then dimple and pinned modes of bending and of torsion.
pub struct Dense {
    pub mass: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    pub load: DVector<f64>,
    /// The dimple first.
    pub contacts: Vec<Contact>,
    /// u = T x.
    pub from_modes: DMatrix<f64>,
    /// Its inverse by M, computed otherwise than in the program.
    pub to_modes: DMatrix<f64>,
}

/// C = 2 ζ K^½ (K^-½ M K^-½)^½ K^½, the damping of which every mode has the ratio ζ, without its modes.
pub fn even_damping(set: &Reduction, ratio: f64) -> DMatrix<f64> {
    let roots = set.stiffness.map(f64::sqrt);
    let n = set.len();
    let standard = DMatrix::from_fn(n, n, |i, j| set.mass[(i, j)] / (roots[i] * roots[j]));
    let eigen = SymmetricEigen::new(standard);
    let values = DMatrix::from_diagonal(&eigen.eigenvalues.map(f64::sqrt));
    let root = &eigen.eigenvectors * values * eigen.eigenvectors.transpose();
    let factor = 2.0 * ratio;
    DMatrix::from_fn(n, n, |i, j| factor * roots[i] * root[(i, j)] * roots[j])
}

impl Dense {
    pub fn new(parameters: &SuspensionParameters, reduced: &ReducedSuspension) -> Self {
        let (bending, torsion) = (&reduced.bending, &reduced.torsion);
        let roll_at = 3 + bending.len();
        let n = roll_at + torsion.len();
        let inertia = Inertia::of(&slider());
        let mut out = Self {
            mass: DMatrix::zeros(n, n),
            damping: DMatrix::zeros(n, n),
            stiffness: DMatrix::zeros(n, n),
            load: DVector::zeros(n),
            contacts: Vec::new(),
            from_modes: DMatrix::identity(n, n),
            to_modes: DMatrix::identity(n, n),
        };
        for (i, m) in inertia.diagonal().into_iter().enumerate() {
            out.mass[(i, i)] = m;
        }
        out.load[0] = inertia.mass_kg;
        for (at, set) in [(3, bending), (roll_at, torsion)] {
            let size = (set.len(), set.len());
            out.mass.view_mut((at, at), size).copy_from(&set.mass);
            let damping = even_damping(set, parameters.damping_ratio);
            out.damping.view_mut((at, at), size).copy_from(&damping);
            let stiffness = DMatrix::from_diagonal(&set.stiffness);
            out.stiffness.view_mut((at, at), size).copy_from(&stiffness);
            out.load
                .rows_mut(at, set.len())
                .copy_from(&set.inertia_load);
            let modes = &set.natural_modes;
            out.from_modes.view_mut((at, at), size).copy_from(modes);
            let inverse = modes.transpose() * &set.mass;
            out.to_modes.view_mut((at, at), size).copy_from(&inverse);
        }

        let unit = |i: usize| DVector::from_fn(n, |k, _| f64::from(k == i));
        let of_bending = |row: &DVector<f64>| {
            let mut out = DVector::zeros(n);
            out.rows_mut(3, row.len()).copy_from(row);
            out
        };
        let vertical = unit(0) - unit(3);
        let pitch = unit(1) + of_bending(&bending.slope_row);
        let roll = unit(2) - unit(roll_at);
        let gimbal = &parameters.gimbal;
        out.stiffness += gimbal.vertical_n_per_m * &vertical * vertical.transpose();
        out.stiffness += gimbal.pitch_n_m_per_rad * &pitch * pitch.transpose();
        out.stiffness += gimbal.roll_n_m_per_rad * &roll * roll.transpose();

        let mut contact = |row: DVector<f64>, steady_force_n: f64, law: &ContactLaw| {
            let n_per_m = law.stiffness_n_per_m;
            let n_s_per_m = 2.0 * law.damping_ratio * (n_per_m * inertia.mass_kg).sqrt();
            out.contacts.push(Contact {
                row,
                steady_force_n,
                n_per_m,
                n_s_per_m,
            });
        };
        contact(
            vertical.clone(),
            parameters.steady_dimple_force_n(),
            &parameters.dimple,
        );
        for limiter in &parameters.limiters {
            let row = limiter.along_m * &pitch - limiter.across_m * &roll - &vertical;
            let law = &limiter.contact;
            contact(row, -limiter.gap_m * law.stiffness_n_per_m, law);
        }
        if let (Some(tab), Some(row)) = (&parameters.lift_tab, &bending.tab_row) {
            let steady_force_n = -tab.gap_m * tab.contact.stiffness_n_per_m;
            contact(of_bending(row), steady_force_n, &tab.contact);
        }
        out
    }

    pub fn len(&self) -> usize {
        self.load.len()
    }

    /// C and K with the contacts closed that `closed` names.
    pub fn tangent(&self, closed: &[bool]) -> [DMatrix<f64>; 2] {
        let (mut damping, mut stiffness) = (self.damping.clone(), self.stiffness.clone());
        for (contact, _) in self.contacts.iter().zip(closed).filter(|(_, c)| **c) {
            let square = &contact.row * contact.row.transpose();
            damping += contact.n_s_per_m * &square;
            stiffness += contact.n_per_m * &square;
        }
        [damping, stiffness]
    }

    /// Force of the contacts less the dimple's steady one, and the sum of their magnitudes.
    pub fn contact_force(&self, u: &DVector<f64>, w: &DVector<f64>) -> [DVector<f64>; 2] {
        let mut out = [DVector::zeros(self.len()), DVector::zeros(self.len())];
        for (k, contact) in self.contacts.iter().enumerate() {
            let held = if k == 0 { contact.steady_force_n } else { 0.0 };
            out[0] -= (contact.signed(u, w).max(0.0) - held) * &contact.row;
            let size = contact.steady_force_n.abs()
                + contact.n_per_m * contact.row.abs().dot(&u.abs())
                + contact.n_s_per_m * contact.row.abs().dot(&w.abs());
            out[1] += size * contact.row.abs();
        }
        out
    }
}
