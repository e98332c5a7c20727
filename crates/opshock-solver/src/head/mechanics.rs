//! Slider, gimbal, dimple contact and suspension as one small mechanical system.
//!
//! Coordinates x: slider (z, pitch, roll), then the suspension's natural modes η of bending and of torsion
//! (`oscillators`). All are increments from the loaded, flying state in the base's frame. Everything but the inertia of
//! the slider and the modes themselves acts at the ports p = P x (`ports`).
//!
//! ```text
//! M ẍ = f a(t) + (F − F₀) − C ẋ − K x − Pᵀ (G p + b (N − N₀))
//! M = diag(m, J_pitch, J_roll, 1),   C = diag(0, 2 ζ ω),   K = diag(0, ω²)
//! N = max(0, N₀ + k_d δ + c_d δ̇),   δ = b·p = z − z_dimple,   c_d = 2 ζ_d √(k_d m)
//! G p = (0, k_z (z − z_dimple), k_pitch (pitch + dw/dx|dimple), k_roll (roll − roll_dimple), 0)
//! ```
//!
//! Every mass feels +m a(t), so a > 0 lifts the load beam off the slider and unloads the dimple. dw/dx has the sign
//! opposite to pitch (pitch > 0: leading edge up; the suspension's root lies beyond the leading edge). The contact only
//! pushes; its force is continuous, with a kink where the dimple opens. Limiters and a lift tab, if present, are
//! further contacts of that kind (`stops`).

use super::oscillators::{ModalMotion, Oscillators};
use super::ports::{AtPorts, CLOSING, PORTS, Ports, SLIDER, TAB, TILT_ACROSS, TILT_ALONG, parted};
use super::stops::{Closed, Stop, Stops};
use crate::linalg::pivoted::PaddedColumns;
use crate::slider::SliderParameters;
use crate::slider::body::Inertia;
use crate::suspension::{ContactLaw, ReducedSuspension, SuspensionParameters};
use nalgebra::{Complex, DMatrix, DVector};

/// The oscillators and what couples them.
#[derive(Clone, Debug)]
pub(super) struct Mechanics {
    /// m, J_pitch, J_roll.
    inertia: [f64; SLIDER],
    modes: Oscillators,
    ports: Ports,
    /// Stiffnesses of the gimbal at the ports, the diagonal of G.
    gimbal: AtPorts,
    /// e = M⁻¹ f: acceleration of every coordinate per acceleration of the pivot.
    rigid: Vec<f64>,
    steady_dimple_force_n: f64,
    contact_n_per_m: f64,
    contact_n_s_per_m: f64,
    /// Force at the dimple per natural mode of bending, one row for every pinned mode.
    suspension_weights: PaddedColumns,
    stops: Stops,
    /// Number of stops that are limiters; the lift tab follows.
    n_limiters: usize,
}

impl Mechanics {
    /// Assembles the system; `None` when the slider has no inertia or a mode is not finite. `suspension`
    /// must come from `parameters`.
    pub fn new(
        parameters: &SuspensionParameters,
        suspension: &ReducedSuspension,
        slider: &SliderParameters,
    ) -> Option<Self> {
        let inertia = Inertia::of(slider);
        let modes = Oscillators::new(suspension);
        let has_inertia = inertia.diagonal().iter().all(|m| *m > 0.0 && m.is_finite());
        let stiffness = &modes.stiffness;
        if !has_inertia || stiffness.iter().chain(&modes.load).any(|x| !x.is_finite()) {
            return None;
        }
        let mut rigid = vec![1.0, 0.0, 0.0];
        rigid.extend_from_slice(&modes.load);

        let damper = |law: &ContactLaw| {
            2.0 * law.damping_ratio * (law.stiffness_n_per_m * inertia.mass_kg).sqrt()
        };
        let stop = |row: AtPorts, gap_m: f64, law: &ContactLaw| Stop {
            row,
            gap_m,
            stiffness_n_per_m: law.stiffness_n_per_m,
            damping_n_s_per_m: damper(law),
        };
        let mut stops = Vec::new();
        for limiter in &parameters.limiters {
            let mut row = [0.0; PORTS];
            row[CLOSING] = -1.0;
            row[TILT_ALONG] = limiter.along_m;
            row[TILT_ACROSS] = -limiter.across_m;
            stops.push(stop(row, limiter.gap_m, &limiter.contact));
        }
        if let (Some(tab), true) = (&parameters.lift_tab, suspension.bending.tab_row.is_some()) {
            let mut row = [0.0; PORTS];
            row[TAB] = 1.0;
            stops.push(stop(row, tab.gap_m, &tab.contact));
        }

        let mut gimbal = [0.0; PORTS];
        gimbal[CLOSING] = parameters.gimbal.vertical_n_per_m;
        gimbal[TILT_ALONG] = parameters.gimbal.pitch_n_m_per_rad;
        gimbal[TILT_ACROSS] = parameters.gimbal.roll_n_m_per_rad;
        let dimple = &parameters.dimple;
        Some(Self {
            inertia: inertia.diagonal(),
            modes,
            ports: Ports::new(suspension),
            gimbal,
            rigid,
            steady_dimple_force_n: parameters.steady_dimple_force_n(),
            contact_n_per_m: dimple.stiffness_n_per_m,
            contact_n_s_per_m: damper(dimple),
            suspension_weights: suspension_weights(suspension),
            stops: Stops::new(stops),
            n_limiters: parameters.limiters.len(),
        })
    }

    /// Number of limiters and lift tab together.
    pub fn n_stops(&self) -> usize {
        self.stops.len()
    }

    /// Whether there are limiters, and a lift tab.
    pub fn has_stops(&self) -> [bool; 2] {
        [self.n_limiters > 0, self.stops.len() > self.n_limiters]
    }

    /// Energy of motion at the velocities `v`, J.
    pub fn kinetic_j(&self, v: &[f64]) -> f64 {
        let (slider, modes) = v.split_at(SLIDER);
        let of_slider = slider.iter().zip(self.inertia).map(|(v, m)| m * v * v);
        0.5 * (of_slider.sum::<f64>() + modes.iter().map(|v| v * v).sum::<f64>())
    }

    /// Energy that modes, gimbal, dimple and stops hold at `x` beyond that of steady flight (`energy`), J.
    pub fn elastic_j(&self, x: &[f64]) -> f64 {
        let [p, _] = self.ports.read_both(x, x);
        let modes = x[SLIDER..].iter().zip(&self.modes.stiffness);
        let of_modes: f64 = modes.map(|(x, k)| k * x * x).sum();
        let of_gimbal: f64 = p.iter().zip(self.gimbal).map(|(p, k)| k * p * p).sum();
        let (n0, closing) = (self.steady_dimple_force_n, p[CLOSING]);
        let elastic_n = self.elastic_dimple_force_n(&p);
        // k δ²/2 of a dimple that is closed; where it is open, the area under −N₀ from there on.
        let of_dimple = match elastic_n > -n0 {
            true => 0.5 * elastic_n * closing,
            false => -n0 * closing - 0.5 * n0 * n0 / self.contact_n_per_m,
        };
        let of_stops: f64 = self.stops.iter().map(|stop| stop.elastic_j(&p)).sum();
        0.5 * (of_modes + of_gimbal) + of_dimple + of_stops
    }

    /// Power that the dampers of modes, dimple and stops take, W.
    pub fn damping_w(&self, x: &[f64], v: &[f64]) -> f64 {
        let [p, rate] = self.ports.read_both(x, v);
        let modes = v[SLIDER..].iter().zip(&self.modes.damping);
        let of_modes: f64 = modes.map(|(v, c)| c * v * v).sum();
        let excess_n = self.signed_dimple_force(&p, &rate).max(0.0) - self.steady_dimple_force_n;
        let of_dimple = (excess_n - self.elastic_dimple_force_n(&p)) * rate[CLOSING];
        let stops = self.stops.iter().map(|stop| stop.damping_w(&p, &rate));
        of_modes + of_dimple + stops.sum::<f64>()
    }

    /// Part of N − N₀ that the dimple's place alone gives.
    fn elastic_dimple_force_n(&self, p: &AtPorts) -> f64 {
        (self.contact_n_per_m * p[CLOSING]).max(-self.steady_dimple_force_n)
    }

    /// f·x: the inertia load's work per acceleration along x.
    pub fn along_load(&self, x: &[f64]) -> f64 {
        let modes = x[SLIDER..].iter().zip(&self.modes.load);
        self.inertia[0] * x[0] + modes.map(|(x, f)| f * x).sum::<f64>()
    }

    /// Force of all limiters together, and force of the lift tab; 0 where there are none.
    pub fn stop_forces(&self, x: &[f64], v: &[f64]) -> [f64; 2] {
        let [p, rate] = self.ports.read_both(x, v);
        let mut forces = [0.0; 2];
        for (k, stop) in self.stops.iter().enumerate() {
            forces[usize::from(k >= self.n_limiters)] += stop.force(&p, &rate);
        }
        forces
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        SLIDER + self.modes.len()
    }

    /// Number of modes of the suspension.
    pub fn n_modes(&self) -> usize {
        self.modes.len()
    }

    /// Ports through which slider and suspension interact with everything else.
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// Mass and moments of inertia of the slider against z, pitch and roll.
    pub fn slider_inertia(&self) -> [f64; SLIDER] {
        self.inertia
    }

    /// Flexibility of every mode within a stage of `d_s`.
    pub fn modal_flexibility(&self, d_s: f64, out: &mut [f64]) {
        self.modes.flexibility(d_s, out);
    }

    /// Contact force N of the dimple; 0 when it is open.
    #[inline]
    pub fn dimple_force(&self, x: &[f64], v: &[f64]) -> f64 {
        let [p, rate] = self.ports.read_both(x, v);
        self.signed_dimple_force(&p, &rate).max(0.0)
    }

    #[inline]
    fn signed_dimple_force(&self, p: &AtPorts, rate: &AtPorts) -> f64 {
        self.steady_dimple_force_n
            + self.contact_n_per_m * p[CLOSING]
            + self.contact_n_s_per_m * rate[CLOSING]
    }

    /// Forces at the ports by gimbal, contacts and the film's excess F − F₀, and which contacts are closed.
    fn force_at_ports(&self, film: [f64; 3], p: &AtPorts, rate: &AtPorts) -> (AtPorts, Closed) {
        let mut out: AtPorts = std::array::from_fn(|k| -self.gimbal[k] * p[k]);
        for (out, film) in out.iter_mut().zip(film) {
            *out += film;
        }
        let signed = self.signed_dimple_force(p, rate);
        out[CLOSING] += self.steady_dimple_force_n - signed.max(0.0);
        self.stops.add_force(p, rate, &mut out);
        let dimple = Closed::of_dimple(signed > 0.0);
        (out, self.stops.add_closed(p, rate, dimple))
    }

    /// Acceleration ẍ.
    pub fn acceleration(&self, a: f64, film: [f64; 3], x: &[f64], v: &[f64], out: &mut [f64]) {
        // Acceleration outside any stage: no inertia term.
        let state = StageState {
            d_s: f64::INFINITY,
            a,
            film,
            x,
            v,
            v_known: v,
        };
        self.imbalance(&state, out);
        for (out, m) in out.iter_mut().zip(self.inertia) {
            *out /= m;
        }
    }

    /// Adds the jump of ẍ due to a jump `da` of the inertia load.
    pub fn add_acceleration_jump(&self, da: f64, out: &mut [f64]) {
        for (out, e) in out.iter_mut().zip(&self.rigid) {
            *out += da * e;
        }
    }

    /// `out` := coordinates, or velocities, relative to a pivot that has moved by `moved`.
    ///
    /// With x = x' + e u and u the pivot's motion the equations of x' in the pivot's frame, M ẍ' = f (a − ü) + ...,
    /// become M ẍ = f a + ... with the other forces at x': a jump of u̇ is no force on x.
    pub fn over_pivot(&self, moved: f64, x: &[f64], out: &mut [f64]) {
        for ((out, x), e) in out.iter_mut().zip(x).zip(&self.rigid) {
            *out = x - e * moved;
        }
    }

    /// Force less M (v − v_known)/d of a stage: the residual with the sign for a correction. Returns which contacts are
    /// closed.
    pub fn imbalance(&self, state: &StageState<'_>, out: &mut [f64]) -> Closed {
        let [p, rate] = self.ports.read_both(state.x, state.v);
        let (force, closed) = self.force_at_ports(state.film, &p, &rate);
        let (on_q, on_joints) = parted(force);
        let per_d = 1.0 / state.d_s;
        let (on_slider, on_modes) = out.split_at_mut(SLIDER);
        for (i, out) in on_slider.iter_mut().enumerate() {
            *out = on_q[i] - self.inertia[i] * (state.v[i] - state.v_known[i]) * per_d;
        }
        on_slider[0] += self.inertia[0] * state.a;
        let motion = ModalMotion {
            per_d,
            a: state.a,
            x: &state.x[SLIDER..],
            v: &state.v[SLIDER..],
            v_known: &state.v_known[SLIDER..],
        };
        self.modes
            .imbalance(&motion, self.ports.rows(), on_joints, on_modes);
        closed
    }

    /// Derivative by p of the forces of gimbal and closed contacts, with rate = (p − p_known)/d.
    pub fn coupling(&self, d_s: f64, closed: Closed) -> [AtPorts; PORTS] {
        let mut out = [[0.0; PORTS]; PORTS];
        for (k, stiffness) in self.gimbal.into_iter().enumerate() {
            out[k][k] = stiffness;
        }
        if closed.dimple() {
            out[CLOSING][CLOSING] += self.contact_n_per_m + self.contact_n_s_per_m / d_s;
        }
        self.stops.add_coupling(d_s, closed, &mut out);
        out
    }

    /// s² M + s C + K with the dimple closed and every stop open, as in steady flight.
    pub fn dynamic_matrix(&self, s: Complex<f64>) -> DMatrix<Complex<f64>> {
        let n = self.len();
        let mut out = DMatrix::zeros(n, n);
        for i in 0..SLIDER {
            out[(i, i)] = s * s * self.inertia[i];
        }
        let modes = &self.modes;
        for (k, (c, stiffness)) in modes.damping.iter().zip(&modes.stiffness).enumerate() {
            out[(SLIDER + k, SLIDER + k)] = s * s + s * *c + *stiffness;
        }
        let mut springs = self.gimbal.map(Complex::from);
        springs[CLOSING] += s * self.contact_n_s_per_m + self.contact_n_per_m;
        for (port, stiffness) in springs.into_iter().enumerate() {
            let row = self.ports.row(port).map(Complex::from);
            out.ger(stiffness, &row, &row, Complex::from(1.0));
        }
        out
    }

    /// Load of every coordinate per inertia load a.
    pub fn inertia_load(&self) -> DVector<f64> {
        let mut load = DVector::from_column_slice(&self.rigid);
        load[0] = self.inertia[0];
        load
    }

    /// Row that gives the z of the suspension's dimple from the coordinates.
    pub fn dimple_row(&self) -> DVector<f64> {
        let closing = -self.ports.row(CLOSING);
        self.ports.row(0) + closing
    }

    /// Right-hand side of the filter: M e_v/d + (M/d² + C/d) e_x.
    pub fn filter_load(&self, d_s: f64, closed: Closed, e_x: &[f64], e_v: &[f64], out: &mut [f64]) {
        let per_d = 1.0 / d_s;
        let e = self.ports.read(e_x);
        let mut force = [0.0; PORTS];
        if closed.dimple() {
            force[CLOSING] = self.contact_n_s_per_m * e[CLOSING] * per_d;
        }
        self.stops.add_filter_load(d_s, closed, &e, &mut force);
        let (on_q, on_joints) = parted(force);
        let (on_slider, on_modes) = out.split_at_mut(SLIDER);
        for (i, out) in on_slider.iter_mut().enumerate() {
            *out = on_q[i] + self.inertia[i] * (e_v[i] + e_x[i] * per_d) * per_d;
        }
        let errors = [&e_x[SLIDER..], &e_v[SLIDER..]];
        self.modes
            .filter_load(per_d, errors, self.ports.rows(), on_joints, on_modes);
    }

    /// Which contacts are closed at (x, v).
    pub fn closed(&self, x: &[f64], v: &[f64]) -> Closed {
        let [p, rate] = self.ports.read_both(x, v);
        let dimple = Closed::of_dimple(self.signed_dimple_force(&p, &rate) > 0.0);
        self.stops.add_closed(&p, &rate, dimple)
    }

    /// Force at the dimple that errors of the suspension's pinned modes cause, N: Σ |ψᵀMφᵢ| ωᵢ² |e_i| with
    /// ψ, φ, ω of the reduction to the dimple (`suspension`) and e_i = (Φ e_η)_i.
    pub fn suspension_force_error(&self, e_x: &[f64], scratch: &mut [f64]) -> f64 {
        let n = self.suspension_weights.order();
        let (errors, forces) = (&e_x[SLIDER..SLIDER + n], &mut scratch[..n]);
        self.suspension_weights.product(errors, forces);
        forces.iter().map(|f| f.abs()).sum()
    }
}

/// Row i > 0: force at the fixed dimple by pinned mode i of bending as it vibrates at its frequency, per natural mode;
/// row 0, of the dimple itself, is 0.
fn suspension_weights(suspension: &ReducedSuspension) -> PaddedColumns {
    let bending = &suspension.bending;
    let n = bending.len();
    let mut rows = vec![0.0; n * n];
    for (i, row) in rows.chunks_exact_mut(n).enumerate().skip(1) {
        let weight = bending.mass[(0, i)].abs() * bending.stiffness[i];
        for (j, out) in row.iter_mut().enumerate() {
            *out = weight * bending.natural_modes[(i, j)];
        }
    }
    PaddedColumns::new(n, &rows)
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
