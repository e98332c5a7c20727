//! Coupled oscillators with any damping, taken apart into their damped modes.
//!
//! ```text
//! M q̈ + D q̇ + K q = b f(t)          M real, D and K complex: amplitudes of a harmonic in a fixed frame
//! q = Σ P η,   q̇ = Σ V η,   η̇ = s η + w f
//! ```
//!
//! Where damping does not share the modes of mass and stiffness, or where a rotor's gyroscopic
//! moments couple them, no transformation leaves oscillators that are alone. In first-order form there
//! is one: the eigenvectors of the state (q, q̇). Every mode η is one complex number, its flow over
//! any time is e^{sh}, and its forced response is a closed form as in [`super::forcing`].
//!
//! A coordinate may be held by Maxwell elements as well, springs k in series with dashpots of relaxation time τ:
//!
//! ```text
//! M q̈ + D q̇ + K q + Σ k y = b f(t),    ẏ = q̇ − y/τ          y: extension of the spring
//! ```
//!
//! one more first-order coordinate each; ½ k y² is stored, k y²/τ is taken.
//!
//! Of a real system only one of each conjugate pair is carried, with weights of 2.
//!
//! Energies: H = ½ q̇ᴴ M q̇ + ½ qᴴ U q with the real part U of the stiffness that stores energy. The
//! rest takes Re(q̇ᴴ D q̇ + q̇ᴴ (K − U) q) from it.
//!
//! Source: Meirovitch, Analytical Methods in Vibrations (1967), ch. 9 (state space of damped systems);
//! Ewins, Modal Testing (2000), 2.7 and 2.8 (viscous damping, rotating structures).

use super::bank::{Readout, padded};
use super::forcing::Phase;
use super::oscillator::{GAUSS_8, phi1, phi2};
use crate::linalg::dense::modes_of_free_body;
use crate::linalg::general::general_eigen;
use crate::linalg::{DenseError, SquareMatrix};
use nalgebra::Complex;

/// A spring in series with a dashpot between a coordinate and the ground.
#[derive(Clone, Copy, Debug)]
pub struct Maxwell {
    /// The coordinate.
    pub coordinate: usize,
    /// Stiffness k of the spring.
    pub stiffness: f64,
    /// Relaxation time τ, s.
    pub time_s: f64,
}

/// Matrices of coupled oscillators.
#[derive(Clone, Debug)]
pub struct CoupledSystem {
    /// M, symmetric and positive definite.
    pub mass: SquareMatrix,
    /// Real part of D.
    pub damping: SquareMatrix,
    /// Imaginary part of D: symmetric for gyroscopic moments.
    pub gyroscopic: SquareMatrix,
    /// U: the symmetric part of K that stores energy.
    pub stiffness: SquareMatrix,
    /// Imaginary part of K.
    pub cross_stiffness: SquareMatrix,
    /// Positive diagonal stiffness with frequencies like the system's: the scale of amplitudes beside
    /// velocities in the eigenproblem.
    pub scale: Vec<f64>,
    /// Maxwell elements.
    pub elements: Vec<Maxwell>,
}

/// Damped modes of a [`CoupledSystem`].
#[derive(Clone, Debug)]
pub struct CoupledModes {
    system: CoupledSystem,
    /// s of the modes carried, 1/s.
    rates_per_s: Vec<Complex<f64>>,
    /// P and V by coordinate and mode, weights of 2 included.
    position: Vec<Vec<Complex<f64>>>,
    velocity: Vec<Vec<Complex<f64>>>,
    /// The same of the Maxwell elements' extensions.
    extension: Vec<Vec<Complex<f64>>>,
    /// Share of each mode per impulse on each coordinate, by mode and coordinate.
    entrance: Vec<Vec<Complex<f64>>>,
    /// Rows that read q, q̇ (real parts, then imaginary parts of a complex system), then y likewise.
    rows: Vec<Readout>,
    is_real: bool,
    n_columns: usize,
}

/// Amplitudes η of all modes, in columns of whole chunks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoupledState {
    /// Real parts.
    pub re: Vec<f64>,
    /// Imaginary parts.
    pub im: Vec<f64>,
}

/// e^{sh} − 1 of all modes.
#[derive(Clone, Debug, Default)]
pub struct CoupledFlow {
    re: Vec<f64>,
    im: Vec<f64>,
}

/// What reads displacement and velocity of a point.
#[derive(Clone, Debug, Default)]
pub struct PointReadout {
    /// Displacement.
    pub position: Readout,
    /// Velocity.
    pub velocity: Readout,
}

/// Coordinates and velocities.
#[derive(Clone, Debug, Default)]
pub struct Coordinates {
    /// q.
    pub q: Vec<Complex<f64>>,
    /// q̇.
    pub v: Vec<Complex<f64>>,
    /// y of the Maxwell elements.
    pub y: Vec<Complex<f64>>,
}

/// Response of one first-order mode over one time to the four parts of a [`Phase`].
#[derive(Clone, Copy, Debug, Default)]
pub struct FirstOrderResponse([Complex<f64>; 4]);

impl CoupledSystem {
    /// Zero matrices for `scale.len()` coordinates.
    pub fn zeros(scale: Vec<f64>) -> Self {
        let zero = || SquareMatrix::zeros(scale.len());
        Self {
            mass: zero(),
            damping: zero(),
            gyroscopic: zero(),
            stiffness: zero(),
            cross_stiffness: zero(),
            scale,
            elements: Vec::new(),
        }
    }

    /// ½ q̇ᴴ M q̇, ½ qᴴ U q + Σ ½ k |y|².
    pub fn energies(&self, at: &Coordinates) -> (f64, f64) {
        (
            0.5 * hermitian(&self.mass, &at.v),
            0.5 * hermitian(&self.stiffness, &at.q) + 0.5 * self.extended(at, |_| 1.0),
        )
    }

    /// Σ k |y|² weight.
    fn extended(&self, at: &Coordinates, weight: impl Fn(&Maxwell) -> f64) -> f64 {
        let elements = self.elements.iter().zip(&at.y);
        let of = |(element, y): (&Maxwell, &Complex<f64>)| {
            element.stiffness * y.norm_sqr() * weight(element)
        };
        elements.map(of).sum()
    }

    /// Re(q̇ᴴ D q̇ + q̇ᴴ (K − U) q) + Σ k |y|²/τ: power taken from H.
    pub fn loss_rate(&self, at: &Coordinates) -> f64 {
        let n = self.scale.len();
        let mut cross = 0.0;
        for i in 0..n {
            for (j, k) in self.cross_stiffness.row(i).iter().enumerate() {
                // Re(v* i k q)
                cross += k * (at.v[i].im * at.q[j].re - at.v[i].re * at.q[j].im);
            }
        }
        hermitian(&self.damping, &at.v)
            + cross
            + self.extended(at, |element| element.time_s.recip())
    }
}

/// Real quadratic form of a complex vector, for a symmetric matrix.
pub fn hermitian(a: &SquareMatrix, x: &[Complex<f64>]) -> f64 {
    let mut sum = 0.0;
    for (i, xi) in x.iter().enumerate() {
        let row = a.row(i).iter().zip(x);
        let along: Complex<f64> = row.map(|(a, x)| x * *a).sum();
        sum += xi.re * along.re + xi.im * along.im;
    }
    sum
}

impl CoupledModes {
    /// Takes `system` apart.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite; modes that coincide ([`general_eigen`]).
    pub fn new(system: CoupledSystem) -> Result<Self, DenseError> {
        Self::below(system, f64::INFINITY)
    }

    /// Takes `system` apart and leaves out modes faster than `fastest_per_s`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn below(system: CoupledSystem, fastest_per_s: f64) -> Result<Self, DenseError> {
        let n = system.scale.len();
        let mut scale = SquareMatrix::zeros(n);
        for (i, k) in system.scale.iter().enumerate() {
            scale.add(i, i, *k);
        }
        // With the undamped modes of mass and scale, q = Φ m, and the state (Ω m, ṁ), the matrix is
        // nearly skew: its eigenvectors are nearly orthogonal and its largest entry is a frequency.
        let undamped = modes_of_free_body(&scale, &system.mass)?;
        let omega: Vec<f64> = undamped.values.iter().map(|v| v.sqrt()).collect();
        let phi = &undamped.vectors;
        let form = |re: &SquareMatrix, im: &SquareMatrix, k: usize, l: usize| {
            Complex::new(re.form(&phi[k], &phi[l]), im.form(&phi[k], &phi[l]))
        };
        let zero = Complex::from(0.0);
        let order = 2 * n + system.elements.len();
        let mut rows = vec![vec![zero; order]; order];
        for k in 0..n {
            rows[k][n + k] = Complex::from(omega[k]);
            for l in 0..n {
                let stiffness = form(&system.stiffness, &system.cross_stiffness, k, l);
                rows[n + k][l] = -stiffness / omega[l];
                rows[n + k][n + l] = -form(&system.damping, &system.gyroscopic, k, l);
            }
        }
        // With √k y beside the velocities an element is skew but for what it takes.
        for (e, element) in system.elements.iter().enumerate() {
            for k in 0..n {
                let held = Complex::from(element.stiffness.sqrt() * phi[k][element.coordinate]);
                rows[n + k][2 * n + e] = -held;
                rows[2 * n + e][n + k] = held;
            }
            rows[2 * n + e][2 * n + e] = Complex::from(-element.time_s.recip());
        }
        let is_real = rows.iter().flatten().all(|z| z.im == 0.0);
        let eigen = general_eigen(&rows)?;
        let kept: Vec<usize> = (0..order)
            .filter(|&k| !is_real || eigen.values[k].im >= 0.0)
            .filter(|&k| eigen.values[k].norm() < fastest_per_s)
            .collect();
        let weight = |k: usize| match is_real && eigen.values[k].im > 0.0 {
            true => 2.0,
            false => 1.0,
        };
        // Φ times one half of an eigenvector, the first one divided by Ω.
        let coordinate = |i: usize, k: usize, half: usize| -> Complex<f64> {
            let sum: Complex<f64> = (0..n)
                .map(|l| {
                    let divisor = if half == 0 { omega[l] } else { 1.0 };
                    eigen.vectors[k][half * n + l] * (phi[l][i] / divisor)
                })
                .sum();
            sum * weight(k)
        };
        let by_coordinate = |half: usize| -> Vec<Vec<Complex<f64>>> {
            (0..n)
                .map(|i| kept.iter().map(|&k| coordinate(i, k, half)).collect())
                .collect()
        };
        let extension = system.elements.iter().enumerate().map(|(e, element)| {
            let of =
                |&k: &usize| eigen.vectors[k][2 * n + e] * (weight(k) / element.stiffness.sqrt());
            kept.iter().map(of).collect()
        });
        let extension = extension.collect();
        let entrance = kept
            .iter()
            .map(|&k| {
                let share = |i: usize| (0..n).map(|l| eigen.inverse[k][n + l] * phi[l][i]).sum();
                (0..n).map(share).collect()
            })
            .collect();
        let mut modes = Self {
            system,
            rates_per_s: kept.iter().map(|&k| eigen.values[k]).collect(),
            position: by_coordinate(0),
            velocity: by_coordinate(1),
            extension,
            entrance,
            rows: Vec::new(),
            is_real,
            n_columns: padded(kept.len()),
        };
        modes.set_rows();
        Ok(modes)
    }

    /// Rows that read the coordinates.
    fn set_rows(&mut self) {
        let n = self.position.len();
        let unit = |i: usize, z: Complex<f64>| -> Vec<Complex<f64>> {
            let mut unit = vec![Complex::from(0.0); n];
            unit[i] = z;
            unit
        };
        // Re(−i q) is the imaginary part.
        let parts = [Complex::from(1.0), Complex::new(0.0, -1.0)];
        self.rows.clear();
        for part in &parts[..if self.is_real { 1 } else { 2 }] {
            let points: Vec<PointReadout> = (0..n).map(|i| self.readout(&unit(i, *part))).collect();
            self.rows.extend(points.iter().map(|p| p.position.clone()));
            self.rows.extend(points.into_iter().map(|p| p.velocity));
        }
        for part in &parts[..if self.is_real { 1 } else { 2 }] {
            let rows = self.extension.iter();
            let rows: Vec<Readout> = rows
                .map(|row| self.columns(std::slice::from_ref(row), &[*part]))
                .collect();
            self.rows.extend(rows);
        }
    }

    /// Adds a mode that holds u = ∫ f dt and with it the load `b` u: η̇ = s η + w u has the answer
    /// η = η' − (w/s) u with η' driven by f alone. Returns what puts f into the modes.
    ///
    /// No mode of the system may rest, s = 0.
    pub fn add_running_load(&mut self, b: &[Complex<f64>]) -> (CoupledState, usize) {
        let w = self.entrance(b);
        let ratios: Vec<Complex<f64>> = self
            .rates_per_s
            .iter()
            .enumerate()
            .map(|(k, s)| Complex::new(w.re[k], w.im[k]) / s)
            .collect();
        let held = |row: &[Complex<f64>]| -> Complex<f64> {
            -row.iter()
                .zip(&ratios)
                .map(|(p, r)| p * r)
                .sum::<Complex<f64>>()
        };
        for row in self.position.iter_mut() {
            let at = held(row);
            row.push(at);
        }
        // What a steady load holds does not move, and its Maxwell elements have relaxed.
        for row in self.velocity.iter_mut().chain(&mut self.extension) {
            row.push(Complex::from(0.0));
        }
        let at = self.rates_per_s.len();
        self.rates_per_s.push(Complex::from(0.0));
        self.entrance.push(vec![Complex::from(0.0); b.len()]);
        self.n_columns = padded(self.rates_per_s.len());
        self.set_rows();
        let mut state = self.at_rest();
        for (k, ratio) in ratios.iter().enumerate() {
            (state.re[k], state.im[k]) = (ratio.re, ratio.im);
        }
        state.re[at] = 1.0;
        (state, at)
    }

    /// The matrices.
    pub fn system(&self) -> &CoupledSystem {
        &self.system
    }

    /// s of the modes carried, 1/s.
    pub fn rates_per_s(&self) -> &[Complex<f64>] {
        &self.rates_per_s
    }

    /// Length of the columns of a state.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// All modes at rest.
    pub fn at_rest(&self) -> CoupledState {
        CoupledState {
            re: vec![0.0; self.n_columns],
            im: vec![0.0; self.n_columns],
        }
    }

    /// Coordinates for [`Self::read`].
    pub fn coordinates(&self) -> Coordinates {
        let zero = vec![Complex::from(0.0); self.position.len()];
        Coordinates {
            q: zero.clone(),
            v: zero,
            y: vec![Complex::from(0.0); self.extension.len()],
        }
    }

    /// What reads Re Σ weights·q.
    pub fn readout(&self, weights: &[Complex<f64>]) -> PointReadout {
        PointReadout {
            position: self.columns(&self.position, weights),
            velocity: self.columns(&self.velocity, weights),
        }
    }

    fn columns(&self, table: &[Vec<Complex<f64>>], weights: &[Complex<f64>]) -> Readout {
        let mut readout = Readout {
            re: vec![0.0; self.n_columns],
            im: vec![0.0; self.n_columns],
        };
        for k in 0..self.rates_per_s.len() {
            let rows = table.iter().zip(weights);
            let sum: Complex<f64> = rows.map(|(row, weight)| row[k] * weight).sum();
            (readout.re[k], readout.im[k]) = (sum.re, -sum.im);
        }
        readout
    }

    /// w of the generalised force `b` per unit f.
    pub fn entrance(&self, b: &[Complex<f64>]) -> CoupledState {
        let mut state = self.at_rest();
        for (k, row) in self.entrance.iter().enumerate() {
            let w: Complex<f64> = row.iter().zip(b).map(|(w, b)| w * b).sum();
            (state.re[k], state.im[k]) = (w.re, w.im);
        }
        state
    }

    /// Fills `at` with coordinates and velocities.
    pub fn read(&self, state: &CoupledState, at: &mut Coordinates) {
        let n = at.q.len();
        let value = |row: usize| self.rows[row].read(&state.re, &state.im);
        for i in 0..n {
            at.q[i] = Complex::from(value(i));
            at.v[i] = Complex::from(value(n + i));
            if !self.is_real {
                at.q[i].im = value(2 * n + i);
                at.v[i].im = value(3 * n + i);
            }
        }
        let (first, r) = (if self.is_real { 2 * n } else { 4 * n }, at.y.len());
        for e in 0..r {
            at.y[e] = Complex::from(value(first + e));
            if !self.is_real {
                at.y[e].im = value(first + r + e);
            }
        }
    }

    /// Sets `flow` to that over `h_s`; does not allocate when `flow` was made for these modes.
    pub fn set_flow(&self, h_s: f64, flow: &mut CoupledFlow) {
        flow.re.resize(self.n_columns, 0.0);
        flow.im.resize(self.n_columns, 0.0);
        for (k, s) in self.rates_per_s.iter().enumerate() {
            let z = s * h_s;
            let less_1 = phi1(z) * z;
            (flow.re[k], flow.im[k]) = (less_1.re, less_1.im);
        }
    }

    /// Energy taken from H over `h_s` of free motion, as a form of the state at its start: symmetric,
    /// row by row over real parts, then imaginary parts.
    pub fn loss_form(&self, h_s: f64) -> SquareMatrix {
        let m = self.n_columns;
        let mut form = SquareMatrix::zeros(2 * m);
        let mut flow = CoupledFlow::default();
        let (mut unit, mut after) = (self.at_rest(), self.at_rest());
        let fastest = self.rates_per_s.iter().map(|s| s.norm());
        // Modes beyond some panels a step are driven by nothing that this step resolves.
        let n_panels = (fastest.fold(0.0, f64::max) * h_s).ceil().clamp(1.0, 16.0) as usize;
        let panel = h_s / n_panels as f64;
        let mut columns = vec![self.coordinates(); 2 * m];
        for step in 0..n_panels {
            for (x, weight) in GAUSS_8 {
                self.set_flow((step as f64 + x) * panel, &mut flow);
                for (j, column) in columns.iter_mut().enumerate() {
                    unit.reset();
                    let part = if j < m { &mut unit.re } else { &mut unit.im };
                    part[j % m] = 1.0;
                    flow.apply(&unit, &mut after);
                    self.read(&after, column);
                }
                self.add_loss(weight * panel, &columns, &mut form);
            }
        }
        form
    }

    /// Adds `weight` times the loss rate as a form of the state whose unit vectors give `columns`.
    fn add_loss(&self, weight: f64, columns: &[Coordinates], form: &mut SquareMatrix) {
        let n = self.position.len();
        let product = |a: &SquareMatrix, x: &[Complex<f64>]| -> Vec<Complex<f64>> {
            let row = |i| a.row(i).iter().zip(x).map(|(a, x)| x * *a).sum();
            (0..n).map(row).collect()
        };
        let i = Complex::new(0.0, 1.0);
        // D v + i C q of every column: the force that takes the power.
        let forces: Vec<Vec<Complex<f64>>> = columns
            .iter()
            .map(|at| {
                let viscous = product(&self.system.damping, &at.v);
                let cross = product(&self.system.cross_stiffness, &at.q);
                viscous.iter().zip(&cross).map(|(a, b)| a + i * b).collect()
            })
            .collect();
        let dot = |x: &[Complex<f64>], y: &[Complex<f64>]| -> f64 {
            x.iter()
                .zip(y)
                .map(|(x, y)| x.re * y.re + x.im * y.im)
                .sum()
        };
        for (a, left) in columns.iter().enumerate() {
            for (b, right) in columns.iter().enumerate() {
                let both = dot(&left.v, &forces[b]) + dot(&right.v, &forces[a]);
                let relaxed: f64 = (self.system.elements.iter().enumerate())
                    .map(|(e, x)| x.stiffness / x.time_s * dot(&left.y[e..=e], &right.y[e..=e]))
                    .sum();
                form.add(a, b, weight * (0.5 * both + relaxed));
            }
        }
    }
}

impl CoupledState {
    /// Puts every mode to rest.
    pub fn reset(&mut self) {
        self.re.fill(0.0);
        self.im.fill(0.0);
    }

    /// Takes the values of `other`, of the same length.
    pub fn copy_from(&mut self, other: &Self) {
        self.re.copy_from_slice(&other.re);
        self.im.copy_from_slice(&other.im);
    }

    /// Adds `factor` times `other`.
    pub fn add(&mut self, other: &Self, factor: f64) {
        for (x, y) in self.re.iter_mut().zip(&other.re) {
            *x += factor * y;
        }
        for (x, y) in self.im.iter_mut().zip(&other.im) {
            *x += factor * y;
        }
    }

    /// zᵀ F z over real, then imaginary parts.
    pub fn form(&self, form: &SquareMatrix) -> f64 {
        let m = self.re.len();
        let along = |row: &[f64]| {
            let re = super::bank::dot(&row[..m], &self.re);
            re + super::bank::dot(&row[m..], &self.im)
        };
        let re: f64 = (0..m).map(|i| self.re[i] * along(form.row(i))).sum();
        let im: f64 = (0..m).map(|i| self.im[i] * along(form.row(m + i))).sum();
        re + im
    }
}

impl CoupledFlow {
    /// `after` := flow of `before`.
    pub fn apply(&self, before: &CoupledState, after: &mut CoupledState) {
        for k in 0..self.re.len() {
            let (x, y) = (before.re[k], before.im[k]);
            after.re[k] = x + (self.re[k] * x - self.im[k] * y);
            after.im[k] = y + (self.re[k] * y + self.im[k] * x);
        }
    }

    /// Adds to `after` what an impulse on `entrance` at the start of the flow leads to.
    pub fn add_kick(&self, entrance: &CoupledState, impulse: f64, after: &mut CoupledState) {
        for k in 0..self.re.len() {
            let (x, y) = (impulse * entrance.re[k], impulse * entrance.im[k]);
            after.re[k] += x + (self.re[k] * x - self.im[k] * y);
            after.im[k] += y + (self.re[k] * y + self.im[k] * x);
        }
    }

    /// Displacement of `to` after the flow per unit impulse on `entrance` at its start.
    pub fn compliance(&self, entrance: &CoupledState, to: &PointReadout) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.re.len() {
            let (x, y) = (entrance.re[k], entrance.im[k]);
            // What the impulse leaves in displacement at once is zero but for rounding.
            sum += to.position.re[k] * (self.re[k] * x - self.im[k] * y)
                + to.position.im[k] * (self.re[k] * y + self.im[k] * x);
        }
        sum
    }
}

impl PointReadout {
    /// (displacement, velocity).
    pub fn read(&self, state: &CoupledState) -> (f64, f64) {
        (
            self.position.read(&state.re, &state.im),
            self.velocity.read(&state.re, &state.im),
        )
    }
}

impl FirstOrderResponse {
    /// Response over `h_s` of a mode of rate `s_per_s` to a wave of rate `sigma_per_s`.
    pub fn new(s_per_s: Complex<f64>, sigma_per_s: Complex<f64>, h_s: f64) -> Self {
        let i = Complex::new(0.0, 1.0);
        let z = s_per_s * h_s;
        let grown = z.exp() * h_s;
        let along = grown * phi1((sigma_per_s - s_per_s) * h_s);
        let against = grown * phi1((sigma_per_s.conj() - s_per_s) * h_s);
        Self([
            phi1(z) * h_s,
            phi2(z) * (h_s * h_s),
            (along + against) * 0.5,
            i * (along - against) * 0.5,
        ])
    }

    /// Increment of the mode for a forcing that starts at `phase`.
    pub fn increment(&self, phase: &Phase) -> Complex<f64> {
        let [constant, slope, re, im] = self.0;
        (constant * phase.constant + slope * phase.slope_per_s)
            + (re * phase.wave.re + im * phase.wave.im)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::{ForcedResponse, Oscillator};

    fn matrix(rows: &[&[f64]]) -> SquareMatrix {
        let mut a = SquareMatrix::zeros(rows.len());
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                a.add(i, j, *value);
            }
        }
        a
    }

    /// Two coordinates with everything: mass coupling, damping of one, gyroscopic and cross terms.
    fn whirling() -> CoupledSystem {
        CoupledSystem {
            mass: matrix(&[&[2.0, 0.4], &[0.4, 1.0]]),
            damping: matrix(&[&[0.3, 0.0], &[0.0, 0.05]]),
            gyroscopic: matrix(&[&[0.9, 0.2], &[0.2, 0.5]]),
            stiffness: matrix(&[&[5.0, 0.0], &[0.0, 30.0]]),
            cross_stiffness: matrix(&[&[0.2, 0.0], &[0.0, 0.1]]),
            scale: vec![5.0, 31.0],
            elements: Vec::new(),
        }
    }

    fn real() -> CoupledSystem {
        let mut system = whirling();
        system.gyroscopic = SquareMatrix::zeros(2);
        system.cross_stiffness = SquareMatrix::zeros(2);
        system
    }

    /// q, q̇ and the energy lost by the classical Runge-Kutta rule in small steps.
    fn integrate(system: &CoupledSystem, start: &Coordinates, h_s: f64) -> (Coordinates, f64) {
        let i = Complex::new(0.0, 1.0);
        let m = &system.mass;
        let det = m.get(0, 0) * m.get(1, 1) - m.get(0, 1) * m.get(1, 0);
        let rate = |at: &Coordinates| {
            let pulled = |a: usize| -> Complex<f64> {
                let pairs = system.elements.iter().zip(&at.y);
                let own = pairs.filter(|(e, _)| e.coordinate == a);
                own.map(|(e, y)| y * e.stiffness).sum()
            };
            let force: Vec<Complex<f64>> = (0..2)
                .map(|a| {
                    (0..2)
                        .map(|b| {
                            let d = i * system.gyroscopic.get(a, b) + system.damping.get(a, b);
                            let k =
                                i * system.cross_stiffness.get(a, b) + system.stiffness.get(a, b);
                            -(d * at.v[b]) - k * at.q[b]
                        })
                        .sum::<Complex<f64>>()
                        - pulled(a)
                })
                .collect();
            Coordinates {
                y: (system.elements.iter().zip(&at.y))
                    .map(|(e, y)| at.v[e.coordinate] - y / e.time_s)
                    .collect(),
                q: at.v.clone(),
                v: vec![
                    (force[0] * m.get(1, 1) - force[1] * m.get(0, 1)) / det,
                    (force[1] * m.get(0, 0) - force[0] * m.get(1, 0)) / det,
                ],
            }
        };
        let step = |at: &Coordinates, by: &Coordinates, f: f64| Coordinates {
            q: (0..2).map(|j| at.q[j] + by.q[j] * f).collect(),
            v: (0..2).map(|j| at.v[j] + by.v[j] * f).collect(),
            y: at.y.iter().zip(&by.y).map(|(y, by)| y + by * f).collect(),
        };
        let n = 20_000;
        let dt = h_s / f64::from(n);
        let (mut at, mut lost) = (start.clone(), 0.0);
        for _ in 0..n {
            let k1 = rate(&at);
            let mid = step(&at, &k1, dt / 2.0);
            let k2 = rate(&mid);
            let mid2 = step(&at, &k2, dt / 2.0);
            let k3 = rate(&mid2);
            let end = step(&at, &k3, dt);
            let k4 = rate(&end);
            let l = [&at, &mid, &mid2, &end].map(|x| system.loss_rate(x));
            lost += dt / 6.0 * (l[0] + 2.0 * l[1] + 2.0 * l[2] + l[3]);
            for (k, w) in [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)] {
                at = step(&at, k, dt * w / 6.0);
            }
        }
        (at, lost)
    }

    #[test]
    fn flow_and_loss_of_damped_whirling_modes_agree_with_direct_integration() {
        for system in [whirling(), real()] {
            let modes = CoupledModes::new(system.clone()).unwrap();
            let b = [Complex::new(0.7, 0.0), Complex::new(-0.3, 0.0)];
            let mut state = modes.at_rest();
            state.add(&modes.entrance(&b), 1.0);
            let mut start = modes.coordinates();
            modes.read(&state, &mut start);
            // An impulse sets velocities M⁻¹ b and moves nothing.
            assert!(start.q.iter().all(|q| q.norm() < 1e-14));
            let mv = system.mass.get(0, 0) * start.v[0] + system.mass.get(0, 1) * start.v[1];
            assert!((mv - 0.7).norm() < 1e-14);
            for h_s in [1e-3, 0.3, 2.5] {
                let (wanted, lost) = integrate(&system, &start, h_s);
                let mut flow = CoupledFlow::default();
                modes.set_flow(h_s, &mut flow);
                let (mut after, mut at) = (modes.at_rest(), modes.coordinates());
                flow.apply(&state, &mut after);
                modes.read(&after, &mut at);
                for j in 0..2 {
                    assert!((at.q[j] - wanted.q[j]).norm() < 1e-12, "{h_s}");
                    assert!((at.v[j] - wanted.v[j]).norm() < 1e-12, "{h_s}");
                }
                for (y, wanted) in at.y.iter().zip(&wanted.y) {
                    assert!((y - wanted).norm() < 1e-12, "{h_s}");
                }
                let booked = state.form(&modes.loss_form(h_s));
                assert!((booked - lost).abs() < 1e-12, "{h_s}: {booked} {lost}");
                let h = |x: &Coordinates| {
                    let (kinetic, elastic) = system.energies(x);
                    kinetic + elastic
                };
                assert!((h(&start) - h(&at) - booked).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn one_oscillator_moves_as_the_oscillator_does_under_every_part_of_a_pulse() {
        let sigma = Complex::new(-0.3, 2.0);
        let phase = Phase {
            constant: 0.4,
            slope_per_s: -0.7,
            wave: Complex::new(0.2, -1.1),
        };
        for (omega, ratio) in [(3.0, 0.02), (40.0, 0.01), (3.0, 4.0)] {
            let mut system = CoupledSystem::zeros(vec![omega * omega]);
            system.mass.add(0, 0, 1.0);
            system.stiffness.add(0, 0, omega * omega);
            system.damping.add(0, 0, 2.0 * ratio * omega);
            let modes = CoupledModes::new(system).unwrap();
            let point = modes.readout(&[Complex::from(1.0)]);
            let w = modes.entrance(&[Complex::from(1.0)]);
            for h_s in [1e-6, 0.01, 1.0, 3.0] {
                let mut state = modes.at_rest();
                for (k, s) in modes.rates_per_s().iter().enumerate() {
                    let response = FirstOrderResponse::new(*s, sigma, h_s).increment(&phase);
                    let z = Complex::new(w.re[k], w.im[k]) * response;
                    (state.re[k], state.im[k]) = (z.re, z.im);
                }
                let (x, v) = point.read(&state);
                let oscillator = Oscillator::fixed(omega, ratio);
                let (wanted_x, wanted_v) =
                    ForcedResponse::new(&oscillator, sigma, h_s).increments(&phase);
                assert!((x - wanted_x).abs() < 1e-12 * h_s, "{omega} {ratio} {h_s}");
                assert!((v - wanted_v).abs() < 1e-12, "{omega} {ratio} {h_s}");
            }
        }
    }
}
