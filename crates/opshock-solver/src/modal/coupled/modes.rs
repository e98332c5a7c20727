//! Computes the damped modes of coupled oscillators from the eigenvectors of the state (q, q̇), and advances them.

use super::state::{CoupledFlow, CoupledState, PointReadout};
use super::system::{Coordinates, CoupledSystem};
use crate::linalg::dense::modes_of_free_body;
use crate::linalg::general::general_eigen;
use crate::linalg::{DenseError, SquareMatrix};
use crate::modal::bank::{Readout, padded};
use crate::modal::oscillator::{GAUSS_8, phi1};
use nalgebra::Complex;

/// Damped modes of a [`CoupledSystem`].
#[derive(Clone, Debug)]
pub struct CoupledModes {
    system: CoupledSystem,
    /// s of the modes kept, 1/s.
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

impl CoupledModes {
    /// Decomposes `system` into its modes.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite; modes that coincide ([`general_eigen`]).
    pub fn new(system: CoupledSystem) -> Result<Self, DenseError> {
        Self::below(system, f64::INFINITY)
    }

    /// Decomposes `system` and leaves out modes faster than `fastest_per_s`.
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
        // With √k y beside the velocities an element's block is skew but for its loss.
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

    /// Adds a mode that holds u = ∫ f dt and with it the load `b` u: η̇ = s η + w u has the solution η = η' − (w/s) u
    /// with η' driven by f alone. Returns the entrance of f into the modes, and the new mode's index.
    ///
    /// No mode of the system may have s = 0.
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
        // A steady load gives no velocity, and its Maxwell elements have relaxed.
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

    /// s of the modes kept, 1/s.
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

    /// Row that reads Re Σ weights·q.
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
        // Nothing that this step resolves drives modes beyond some panels per step.
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
