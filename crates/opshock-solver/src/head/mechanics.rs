//! Slider, gimbal, dimple contact and suspension as one small mechanical system.
//!
//! Coordinates x: slider (z, pitch, roll), then suspension bending (dimple z, pinned modes), then
//! torsion (dimple roll, pinned modes); all increments from the loaded, flying state in the
//! base's frame.
//!
//! ```text
//! M ẍ = f a(t) + (F − F₀) − C ẋ − K x − B (N − N₀)
//! N   = max(0, N₀ + k_d δ + c_d δ̇),   δ = Bᵀx = z − z_dimple,   c_d = 2 ζ_d √(k_d m)
//! K ∋ k_z (z − z_dimple)²/2 + k_pitch (pitch + dw/dx|dimple)²/2 + k_roll (roll − roll_dimple)²/2
//! ```
//!
//! Every mass feels +m a(t), so a > 0 lifts the load beam off the slider and unloads the dimple.
//! dw/dx = Σ slope_row u has the sign opposite to pitch (pitch > 0: leading edge up; the
//! suspension's root lies beyond the leading edge). The contact pushes only; its force is
//! continuous with a kink where the dimple opens. Limiters and a lift tab, where there are some, are
//! further contacts of that kind (`stops`).

use super::stops::{Closed, Stop, Stops};
use crate::linalg::pivoted::{PaddedColumns, PivotedInverse, sum_of_products};
use crate::slider::SliderParameters;
use crate::slider::body::Inertia;
use crate::suspension::{ContactLaw, ReducedSuspension, SuspensionParameters};
use nalgebra::{Complex, DMatrix, DVector};

/// Index of the slider's z among the coordinates.
const SLIDER_Z: usize = 0;
/// Index of the dimple's z among the coordinates.
const DIMPLE_Z: usize = 3;

/// The linear matrices (row by row) and the dimple.
#[derive(Clone, Debug)]
pub(super) struct Mechanics {
    n: usize,
    /// Mass, damping and stiffness once more, for products.
    columns: [PaddedColumns; 3],
    mass: Vec<f64>,
    inverse_mass: PaddedColumns,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    inertia_load: Vec<f64>,
    /// e = M⁻¹ f: the motion of every coordinate that an acceleration of the pivot asks for.
    rigid: Vec<f64>,
    preload_n: f64,
    contact_n_per_m: f64,
    contact_n_s_per_m: f64,
    suspension_weights: Vec<f64>,
    stops: Stops,
    /// Of the stops those that are limiters; the lift tab follows.
    n_limiters: usize,
}

impl Mechanics {
    /// Assembles the system. `suspension` must come from `parameters`.
    pub fn new(
        parameters: &SuspensionParameters,
        suspension: &ReducedSuspension,
        slider: &SliderParameters,
    ) -> Option<Self> {
        let (bending, torsion) = (&suspension.bending, &suspension.torsion);
        let roll_at = DIMPLE_Z + bending.len();
        let n = roll_at + torsion.len();
        let mut mass = vec![0.0; n * n];
        let mut damping = vec![0.0; n * n];
        let mut stiffness = vec![0.0; n * n];
        let mut inertia_load = vec![0.0; n];

        let inertia = Inertia::of(slider);
        for (i, m) in inertia.diagonal().into_iter().enumerate() {
            mass[i * n + i] = m;
        }
        inertia_load[SLIDER_Z] = inertia.mass_kg;
        for (first, block) in [(DIMPLE_Z, bending), (roll_at, torsion)] {
            for i in 0..block.len() {
                for j in 0..block.len() {
                    mass[(first + i) * n + first + j] = block.mass[(i, j)];
                    damping[(first + i) * n + first + j] = block.damping[(i, j)];
                }
                stiffness[(first + i) * n + first + i] = block.stiffness[i];
                inertia_load[first + i] = block.inertia_load[i];
            }
        }

        let gimbal = &parameters.gimbal;
        let mut vertical = vec![0.0; n];
        vertical[SLIDER_Z] = 1.0;
        vertical[DIMPLE_Z] = -1.0;
        let mut pitch = vec![0.0; n];
        pitch[1] = 1.0;
        pitch[DIMPLE_Z..roll_at].copy_from_slice(bending.slope_row.as_slice());
        let mut roll = vec![0.0; n];
        roll[2] = 1.0;
        roll[roll_at] = -1.0;
        for (spring, row) in [
            (gimbal.vertical_n_per_m, &vertical),
            (gimbal.pitch_n_m_per_rad, &pitch),
            (gimbal.roll_n_m_per_rad, &roll),
        ] {
            for i in 0..n {
                for j in 0..n {
                    stiffness[i * n + j] += spring * row[i] * row[j];
                }
            }
        }

        let mut inverse = PivotedInverse::new(n);
        inverse.matrix_mut().copy_from_slice(&mass);
        if !inverse.invert() {
            return None;
        }
        let inverse_mass = inverse.into_columns();

        let mut rigid = vec![0.0; n];
        sum_of_products([(&inverse_mass, &inertia_load)], &mut rigid);

        // Force at the dimple that an error of a suspension coordinate causes through the mass
        // coupling at its own frequency, or directly for the interface coordinates.
        let mut suspension_weights = vec![0.0; n];
        for (k, weight) in suspension_weights.iter_mut().enumerate().take(roll_at) {
            if k > DIMPLE_Z {
                *weight = bending.mass[(0, k - DIMPLE_Z)].abs() * bending.stiffness[k - DIMPLE_Z];
            }
        }

        let damper = |law: &ContactLaw| {
            2.0 * law.damping_ratio * (law.stiffness_n_per_m * inertia.mass_kg).sqrt()
        };
        let stop = |row: Vec<f64>, gap_m: f64, law: &ContactLaw| Stop {
            row,
            gap_m,
            stiffness_n_per_m: law.stiffness_n_per_m,
            damping_n_s_per_m: damper(law),
        };
        let mut stops = Vec::new();
        for limiter in &parameters.limiters {
            let opening = vertical.iter().zip(&pitch).zip(&roll);
            let row = opening
                .map(|((v, p), r)| limiter.along_m * p - limiter.across_m * r - v)
                .collect();
            stops.push(stop(row, limiter.gap_m, &limiter.contact));
        }
        if let (Some(tab), Some(shape)) = (&parameters.lift_tab, &bending.tab_row) {
            let mut row = vec![0.0; n];
            row[DIMPLE_Z..roll_at].copy_from_slice(shape.as_slice());
            stops.push(stop(row, tab.gap_m, &tab.contact));
        }

        let dimple = &parameters.dimple;
        Some(Self {
            n,
            columns: [&mass, &damping, &stiffness].map(|rows| PaddedColumns::new(n, rows)),
            mass,
            inverse_mass,
            damping,
            stiffness,
            inertia_load,
            rigid,
            preload_n: parameters.gram_load_n,
            contact_n_per_m: dimple.stiffness_n_per_m,
            contact_n_s_per_m: 2.0
                * dimple.damping_ratio
                * (dimple.stiffness_n_per_m * inertia.mass_kg).sqrt(),
            suspension_weights,
            stops: Stops::new(stops),
            n_limiters: parameters.limiters.len(),
        })
    }

    /// Limiters and lift tab.
    pub fn n_stops(&self) -> usize {
        self.stops.len()
    }

    /// Whether there are limiters, and a lift tab.
    pub fn has_stops(&self) -> [bool; 2] {
        [self.n_limiters > 0, self.stops.len() > self.n_limiters]
    }

    /// Forces of the limiters together, and of the lift tab; 0 where there are none.
    pub fn stop_forces(&self, x: &[f64], v: &[f64]) -> [f64; 2] {
        let mut forces = [0.0; 2];
        for (k, stop) in self.stops.iter().enumerate() {
            forces[usize::from(k >= self.n_limiters)] += stop.force(x, v);
        }
        forces
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        self.n
    }

    /// Contact force N of the dimple; 0 when it is open.
    #[inline]
    pub fn dimple_force(&self, x: &[f64], v: &[f64]) -> f64 {
        self.signed_dimple_force(x, v).max(0.0)
    }

    #[inline]
    fn signed_dimple_force(&self, x: &[f64], v: &[f64]) -> f64 {
        self.preload_n
            + self.contact_n_per_m * (x[SLIDER_Z] - x[DIMPLE_Z])
            + self.contact_n_s_per_m * (v[SLIDER_Z] - v[DIMPLE_Z])
    }

    /// Adds the generalised force at inertia load `a` with the film's excess force F − F₀, without
    /// springs and dampers of the linear matrices.
    fn add_load(&self, a: f64, film: [f64; 3], x: &[f64], v: &[f64], out: &mut [f64]) {
        for (out, load) in out.iter_mut().zip(&self.inertia_load) {
            *out += load * a;
        }
        for (out, f) in out.iter_mut().zip(film) {
            *out += f;
        }
        let excess = self.dimple_force(x, v) - self.preload_n;
        out[SLIDER_Z] -= excess;
        out[DIMPLE_Z] += excess;
        self.stops.add_force(x, v, out);
    }

    /// Acceleration ẍ.
    pub fn acceleration(
        &self,
        a: f64,
        film: [f64; 3],
        x: &[f64],
        v: &[f64],
        scratch: &mut [f64],
        out: &mut [f64],
    ) {
        let [_, damping, stiffness] = &self.columns;
        sum_of_products([(damping, v), (stiffness, x)], scratch);
        scratch.iter_mut().for_each(|f| *f = -*f);
        self.add_load(a, film, x, v, scratch);
        sum_of_products([(&self.inverse_mass, scratch)], out);
    }

    /// Adds the jump of ẍ that a jump `da` of the inertia load causes.
    pub fn add_acceleration_jump(&self, da: f64, out: &mut [f64]) {
        for (out, e) in out.iter_mut().zip(&self.rigid) {
            *out += da * e;
        }
    }

    /// `out` := coordinates, or velocities, over a pivot that has moved by `moved`.
    ///
    /// With x = x' + e u and u the pivot's motion the equations of x' in the pivot's frame, M ẍ' = f (a − ü) + ...,
    /// become M ẍ = f a + ... with the other forces at x': a jump of u̇ is no force on x.
    pub fn over_pivot(&self, moved: f64, x: &[f64], out: &mut [f64]) {
        for ((out, x), e) in out.iter_mut().zip(x).zip(&self.rigid) {
            *out = x - e * moved;
        }
    }

    /// Force less M (v − v_known)/d of a stage: its residual with the sign that a correction wants.
    pub fn imbalance(&self, state: &StageState<'_>, out: &mut [f64], scratch: &mut [f64]) {
        let per_d = 1.0 / state.d_s;
        for ((rate, v), known) in scratch.iter_mut().zip(state.v).zip(state.v_known) {
            *rate = (v - known) * per_d;
        }
        let [mass, damping, stiffness] = &self.columns;
        sum_of_products(
            [(mass, scratch), (damping, state.v), (stiffness, state.x)],
            out,
        );
        out.iter_mut().for_each(|f| *f = -*f);
        self.add_load(state.a, state.film, state.x, state.v, out);
    }

    /// Derivative of the residual by x with v = (x − x_known)/d, without the film; `closed` is the
    /// state of the contacts.
    pub fn stage_matrix(&self, d_s: f64, closed: Closed, out: &mut [f64]) {
        let (per_d, per_d2) = (1.0 / d_s, 1.0 / (d_s * d_s));
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.mass[i] * per_d2 + self.damping[i] * per_d + self.stiffness[i];
        }
        if closed.dimple() {
            let contact = self.contact_n_per_m + self.contact_n_s_per_m * per_d;
            let n = self.n;
            out[SLIDER_Z * n + SLIDER_Z] += contact;
            out[DIMPLE_Z * n + DIMPLE_Z] += contact;
            out[SLIDER_Z * n + DIMPLE_Z] -= contact;
            out[DIMPLE_Z * n + SLIDER_Z] -= contact;
        }
        self.stops.add_matrix(d_s, closed, out);
    }

    /// s² M + s C + K with the dimple closed and every stop open, as in steady flight.
    pub fn dynamic_matrix(&self, s: Complex<f64>) -> DMatrix<Complex<f64>> {
        let n = self.n;
        let mut out = DMatrix::from_fn(n, n, |i, j| {
            let at = i * n + j;
            s * s * self.mass[at] + s * self.damping[at] + self.stiffness[at]
        });
        let contact = s * self.contact_n_s_per_m + self.contact_n_per_m;
        out[(SLIDER_Z, SLIDER_Z)] += contact;
        out[(DIMPLE_Z, DIMPLE_Z)] += contact;
        out[(SLIDER_Z, DIMPLE_Z)] -= contact;
        out[(DIMPLE_Z, SLIDER_Z)] -= contact;
        out
    }

    /// Load of every coordinate per inertia load a.
    pub fn inertia_load(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.inertia_load)
    }

    /// Index of the dimple's z among the coordinates.
    pub fn dimple_index(&self) -> usize {
        DIMPLE_Z
    }

    /// Right-hand side of the filter: M e_v/d + (M/d² + C/d) e_x.
    pub fn filter_load(
        &self,
        d_s: f64,
        closed: Closed,
        e_x: &[f64],
        e_v: &[f64],
        out: &mut [f64],
        scratch: &mut [f64],
    ) {
        let per_d = 1.0 / d_s;
        for ((rate, x), v) in scratch.iter_mut().zip(e_x).zip(e_v) {
            *rate = v + x * per_d;
        }
        let [mass, damping, _] = &self.columns;
        sum_of_products([(mass, scratch), (damping, e_x)], out);
        out.iter_mut().for_each(|f| *f *= per_d);
        if closed.dimple() {
            let f = self.contact_n_s_per_m * (e_x[SLIDER_Z] - e_x[DIMPLE_Z]) / d_s;
            out[SLIDER_Z] += f;
            out[DIMPLE_Z] -= f;
        }
        self.stops.add_filter_load(d_s, closed, e_x, out);
    }

    /// Which contacts are closed at (x, v).
    pub fn closed(&self, x: &[f64], v: &[f64]) -> Closed {
        let dimple = Closed::of_dimple(self.signed_dimple_force(x, v) > 0.0);
        self.stops.add_closed(x, v, dimple)
    }

    /// Force at the dimple that errors of the suspension's modes cause, N.
    pub fn suspension_force_error(&self, e_x: &[f64]) -> f64 {
        self.suspension_weights
            .iter()
            .zip(e_x)
            .map(|(w, e)| w * e.abs())
            .sum()
    }
}

/// One iterate of a stage.
pub(super) struct StageState<'a> {
    /// d = γ Δt, s.
    pub d_s: f64,
    /// Inertia load per mass, m/s2.
    pub a: f64,
    /// F − F₀ of the film.
    pub film: [f64; 3],
    /// Coordinates.
    pub x: &'a [f64],
    /// Velocities.
    pub v: &'a [f64],
    /// Known part of the velocities.
    pub v_known: &'a [f64],
}
