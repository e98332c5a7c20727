//! Limiters and lift tab of a suspension whose slider stands on a spring in place of a film.

use super::super::mechanics::{Mechanics, StageState};
use super::super::sample::{law, limiter, slider, suspension};
use super::super::stage_matrix::StageMatrix;
use super::Closed;
use crate::integrator::{StageSystem, Stepper, TR_BDF2};
use crate::slider::body::Inertia;
use crate::suspension::{LiftTab, ReducedSuspension, SuspensionParameters};
use nalgebra::DVector;

/// Mechanics on springs k of the slider's z, pitch and roll, under a load a.
struct OnSprings {
    mechanics: Mechanics,
    reduced: ReducedSuspension,
    springs: [f64; 3],
    a: f64,
    last: Closed,
}

impl OnSprings {
    fn new(parameters: &SuspensionParameters, modes: usize, springs: [f64; 3], a: f64) -> Self {
        let reduced = ReducedSuspension::build(parameters, modes).expect("builds");
        let mechanics = Mechanics::new(parameters, &reduced, &slider()).expect("a mass matrix");
        let last = Closed::DIMPLE;
        Self {
            mechanics,
            reduced,
            springs,
            a,
            last,
        }
    }

    fn film(&self, x: &[f64]) -> [f64; 3] {
        std::array::from_fn(|i| -self.springs[i] * x[i])
    }

    fn solve(&self, d_s: f64, closed: Closed, b: &mut [f64]) {
        let mut matrix = StageMatrix::new(self.mechanics.n_modes());
        let mut springs = [[0.0; 3]; 3];
        for (i, spring) in self.springs.into_iter().enumerate() {
            springs[i][i] = spring;
        }
        assert!(matrix.prepare(&self.mechanics, d_s, closed, &springs));
        assert!(matrix.solve(b));
    }

    /// Coordinates of the reduction to the dimple, bending: its z and pinned modes.
    fn pinned(&self, x: &[f64]) -> Vec<f64> {
        let bending = &self.reduced.bending;
        let modes = DVector::from_column_slice(&x[3..3 + bending.len()]);
        (&bending.natural_modes * modes).as_slice().to_vec()
    }

    /// z of the suspension's dimple.
    fn dimple(&self, x: &[f64]) -> f64 {
        self.pinned(x)[0]
    }

    /// Moves the dimple by `z` with its static shape; Φ⁻¹ = Φᵀ M.
    fn move_dimple(&self, x: &mut [f64], z: f64) {
        let bending = &self.reduced.bending;
        let modes = bending.in_natural_modes(&(bending.mass.column(0) * z));
        x[3..3 + bending.len()].copy_from_slice(modes.as_slice());
    }

    /// (x, v) after `n` steps of `dt_s` from `y`; `look` sees every state with its time.
    fn march(
        &mut self,
        y: &mut [f64],
        dt_s: f64,
        n: usize,
        mut look: impl FnMut(&Self, f64, &[f64]),
    ) {
        let size = self.mechanics.len();
        let mut rate = vec![0.0; 2 * size];
        let (x, v) = y.split_at(size);
        rate[..size].copy_from_slice(v);
        let film = self.film(x);
        let (_, accelerations) = rate.split_at_mut(size);
        self.mechanics
            .acceleration(self.a, film, x, v, accelerations);
        let mut stepper = Stepper::new(TR_BDF2, 2 * size);
        for k in 0..n {
            stepper
                .step(self, k as f64 * dt_s, dt_s, y, &rate)
                .expect("contacts settle");
            y.copy_from_slice(stepper.value());
            rate.copy_from_slice(stepper.rate());
            stepper.accept(dt_s);
            look(self, (k + 1) as f64 * dt_s, y);
        }
    }

    /// Kinetic and elastic energy, contacts included, under no load.
    fn energy(&self, y: &[f64], parameters: &SuspensionParameters) -> f64 {
        let (x, v) = y.split_at(self.mechanics.len());
        let bending = &self.reduced.bending;
        let n = bending.len();
        let (u, w) = (self.pinned(x), self.pinned(v));
        let mut twice = 0.0;
        for i in 0..n {
            twice += bending.stiffness[i] * u[i] * u[i];
            twice += (0..n)
                .map(|j| w[i] * bending.mass[(i, j)] * w[j])
                .sum::<f64>();
        }
        let inertia = Inertia::of(&slider()).diagonal();
        for i in 0..3 {
            twice += inertia[i] * v[i] * v[i] + self.springs[i] * x[i] * x[i];
        }
        let gimbal = &parameters.gimbal;
        let slope: f64 = bending.slope_row.iter().zip(&u).map(|(s, u)| s * u).sum();
        twice += gimbal.vertical_n_per_m * (x[0] - u[0]).powi(2);
        twice += gimbal.pitch_n_m_per_rad * (x[1] + slope).powi(2);
        // N − N₀ of the dimple is the slope of (N₀ + k δ)²/2k − N₀ δ.
        let (k, preload) = (parameters.dimple.stiffness_n_per_m, parameters.gram_load_n);
        let delta = x[0] - u[0];
        twice += (preload + k * delta).max(0.0).powi(2) / k - 2.0 * preload * delta;
        for limiter in &parameters.limiters {
            let opening = limiter.along_m * (x[1] + slope) - delta;
            let excess = (opening - limiter.gap_m).max(0.0);
            twice += limiter.contact.stiffness_n_per_m * excess * excess;
        }
        0.5 * twice
    }
}

impl StageSystem for OnSprings {
    type Failure = ();

    fn solve_stage(&mut self, _: f64, d_s: f64, known: &[f64], y: &mut [f64]) -> Result<(), ()> {
        let n = self.mechanics.len();
        let (x_known, v_known) = known.split_at(n);
        let (x, v) = y.split_at_mut(n);
        let mut r = vec![0.0; n];
        let mut before = None;
        for _ in 0..20 {
            for ((v, x), known) in v.iter_mut().zip(&*x).zip(x_known) {
                *v = (x - known) / d_s;
            }
            let closed = self.mechanics.closed(x, v);
            // Linear between the contacts' states: one correction each.
            if before == Some(closed) {
                self.last = closed;
                return Ok(());
            }
            before = Some(closed);
            let state = StageState {
                d_s,
                a: self.a,
                film: self.film(x),
                x,
                v,
                v_known,
            };
            assert_eq!(self.mechanics.imbalance(&state, &mut r), closed);
            self.solve(d_s, closed, &mut r);
            for (x, r) in x.iter_mut().zip(&r) {
                *x += r;
            }
        }
        Err(())
    }

    fn filter(&mut self, d_s: f64, error: &mut [f64]) {
        let n = self.mechanics.len();
        let (e_x, e_v) = error.split_at_mut(n);
        let mut load = vec![0.0; n];
        self.mechanics
            .filter_load(d_s, self.last, e_x, e_v, &mut load);
        self.solve(d_s, self.last, &mut load);
        for ((e_x, e_v), x) in e_x.iter_mut().zip(e_v).zip(&load) {
            *e_v = (x - *e_x) / d_s;
            *e_x = *x;
        }
    }
}

/// A lasting load a lifts the load beam off the slider against both limiters. With the dimple open
///
/// ```text
/// k₀ w + k_z (w − z) + 2 k e = f₀ a − N₀,   k_f z − k_z (w − z) − 2 k e = m a + N₀,   w − z = g + e
/// ```
#[test]
fn a_lasting_load_presses_on_the_limiters_by_stiffness_times_excess() {
    let (g, k, k_f, a) = (92.4e-6, 1e5, 1e6, 1.2e4);
    let mut parameters = suspension();
    parameters.limiters = [-4e-4, 4e-4]
        .map(|across| limiter(g, 0.0, across, law(k, 0.05)))
        .to_vec();
    let mut head = OnSprings::new(&parameters, 4, [k_f, 1.0, 1.0], a);
    let n = head.mechanics.len();
    let mut y = vec![0.0; 2 * n];
    head.march(&mut y, 1e-3, 2000, |_, _, _| ());

    let k_0 = head.reduced.dimple_stiffness_n_per_m();
    let f_0 = head.reduced.effective_shock_mass_kg();
    let k_z = parameters.gimbal.vertical_n_per_m;
    let m = Inertia::of(&slider()).mass_kg;
    let preload = parameters.gram_load_n;
    // z from the second equation plus the first: k₀ (z + g + e) + k_f z = (f₀ + m) a.
    let free = (f_0 + m) * a / (k_0 + k_f);
    let share = k_0 / (k_0 + k_f);
    // w = z + g + e with z = free − share (g + e), into the first.
    let left = k_0 * (1.0 - share) + k_z;
    let excess = (f_0 * a - preload - k_0 * free - left * g) / (left + 2.0 * k);
    assert!(excess > 1e-9, "{excess:e}");

    let (x, v) = y.split_at(n);
    let [limiters, tab] = head.mechanics.stop_forces(x, v);
    let found = head.dimple(x) - x[0] - g;
    assert!((found / excess - 1.0).abs() < 1e-9, "{found:e} {excess:e}");
    assert!((limiters / (2.0 * k * excess) - 1.0).abs() < 1e-9);
    assert_eq!((tab, head.mechanics.dimple_force(x, v)), (0.0, 0.0));
}

/// A limiter off the middle turns the slider: the springs take k e y about roll, k e x about pitch.
#[test]
fn a_limiter_aside_turns_the_slider_towards_itself() {
    let (g, k) = (1e-6, 1e5);
    let (along, across) = (3e-4, 4e-4);
    let mut parameters = suspension();
    parameters.limiters = vec![limiter(g, along, across, law(k, 0.05))];
    let springs = [1e6, 2.0, 3.0];
    let mut head = OnSprings::new(&parameters, 4, springs, 1.2e4);
    let n = head.mechanics.len();
    let mut y = vec![0.0; 2 * n];
    head.march(&mut y, 1e-3, 2000, |_, _, _| ());
    let (x, v) = y.split_at(n);
    let [force, _] = head.mechanics.stop_forces(x, v);
    assert!(force > 1e-3);
    // Pitch lifts the leading edge, roll the outer one: a pull at the tip's outer side lowers the first.
    let pitch = springs[1] * x[1];
    let roll = springs[2] * x[2];
    assert!((pitch / (-force * along) - 1.0).abs() < 1e-9, "{pitch:e}");
    assert!((roll / (force * across) - 1.0).abs() < 1e-9, "{roll:e}");
}

/// Masses and velocities of a slider and a load beam that meet at the limiters.
struct Hit {
    momentum: f64,
    relative: f64,
    peak_n: f64,
}

/// Slider and load beam, with one coordinate each, move apart at 0.3 m/s until the limiters reverse them.
fn hit(damping_ratio: f64, dt_s: f64) -> (Hit, f64) {
    let g = 1e-6;
    let mut parameters = suspension();
    // Only inertia and limiters matter: everything else is too soft within the impact.
    parameters.gram_load_n = 0.0;
    parameters.damping_ratio = 0.0;
    parameters.youngs_modulus_pa *= 1e-9;
    parameters.gimbal.vertical_n_per_m = 1e-9;
    parameters.dimple.damping_ratio = 0.0;
    parameters.limiters = vec![limiter(g, 0.0, 0.0, law(1e5, damping_ratio)); 2];
    let mut head = OnSprings::new(&parameters, 0, [0.0; 3], 0.0);
    let n = head.mechanics.len();
    let m = Inertia::of(&slider()).mass_kg;
    let beam = head.reduced.bending.mass[(0, 0)];
    let mut y = vec![0.0; 2 * n];
    // Half the gap from the limiters, so that the impact is over long before the dimple closes again.
    head.move_dimple(&mut y[..n], 0.5 * g);
    y[n] = -0.2;
    head.move_dimple(&mut y[n..], 0.1);
    let mut peak_n: f64 = 0.0;
    let end = (8e-6 / dt_s).round() as usize;
    head.march(&mut y, dt_s, end, |head, _, y| {
        let (x, v) = y.split_at(n);
        peak_n = peak_n.max(head.mechanics.stop_forces(x, v)[0]);
    });
    let (v_slider, v_beam) = (y[n], head.dimple(&y[n..]));
    let reduced = m * beam / (m + beam);
    let hit = Hit {
        momentum: m * v_slider + beam * v_beam - (-0.2 * m + 0.1 * beam),
        relative: (v_beam - v_slider) / 0.3,
        peak_n,
    };
    (hit, reduced)
}

/// Momentum is conserved. Without damping the bodies separate as fast as they met, with damping at exp(−π ζ'/√(1 −
/// ζ'²)) of that velocity, and the largest force is v √(k μ).
#[test]
fn a_hit_on_the_limiters_passes_momentum_on_and_gives_no_energy() {
    for damping_ratio in [0.0, 0.05, 0.3] {
        let m = Inertia::of(&slider()).mass_kg;
        let error = |dt_s: f64| {
            let (hit, reduced) = hit(damping_ratio, dt_s);
            let k = 2e5_f64;
            // Two limiters, each damped on the slider's mass.
            let c = 2.0 * 2.0 * damping_ratio * (1e5 * m).sqrt();
            let ratio = c / (2.0 * (k * reduced).sqrt());
            let wanted = (-std::f64::consts::PI * ratio / (1.0 - ratio * ratio).sqrt()).exp();
            assert!(hit.momentum.abs() < 1e-9 * m, "{:e}", hit.momentum);
            if damping_ratio == 0.0 {
                let peak = 0.3 * (k * reduced).sqrt();
                assert!(
                    (hit.peak_n / peak - 1.0).abs() < 2e-3,
                    "{}",
                    hit.peak_n / peak
                );
            }
            (-hit.relative / wanted - 1.0).abs()
        };
        let errors = [1e-7, 5e-8, 2.5e-8, 1.25e-8].map(error);
        println!("damping ratio {damping_ratio}: {errors:?}");
        let falls = errors[3] < 0.25 * errors[0];
        assert!(errors[3] < 5e-5 && falls, "{damping_ratio}: {errors:?}");
    }
}

/// Without a load the energy of slider, suspension and contacts never rises, with any contact opening or closing.
#[test]
fn no_contact_gives_energy() {
    let mut parameters = suspension();
    parameters.limiters = vec![
        limiter(2e-6, 2e-4, -4e-4, law(1e5, 0.05)),
        limiter(2.1e-6, 2e-4, 4e-4, law(1e5, 0.05)),
    ];
    let mut rises = Vec::new();
    for dt_s in [4e-7, 2e-7, 1e-7, 5e-8] {
        let mut head = OnSprings::new(&parameters, 4, [1e6, 1.0, 1.0], 0.0);
        let n = head.mechanics.len();
        let mut y = vec![0.0; 2 * n];
        head.move_dimple(&mut y[n..], 0.6);
        let start = head.energy(&y, &parameters);
        let (mut last, mut rise, mut hits, mut was_closed) = (start, 0.0_f64, 0, false);
        let end = (1e-3 / dt_s) as usize;
        head.march(&mut y, dt_s, end, |head, _, y| {
            let energy = head.energy(y, &parameters);
            rise = rise.max(energy - last);
            last = energy;
            let (x, v) = y.split_at(n);
            let is_closed = head.mechanics.stop_forces(x, v)[0] > 0.0;
            hits += usize::from(is_closed && !was_closed);
            was_closed = is_closed;
        });
        println!("{dt_s:e} s: {hits} hits, largest rise {:.1e}", rise / start);
        assert!(hits > 3 && last < start);
        rises.push(rise / start);
    }
    assert!(rises.iter().all(|rise| *rise < 1e-12), "{rises:?}");
}

/// A tab pressed against its stop yields by the finite elements' compliance: with its attachment mode, few modes or
/// none give the same force as all modes without it.
#[test]
fn a_lift_tab_is_as_stiff_as_the_finite_elements() {
    let mut parameters = suspension();
    let (k, a) = (1e5, 2e4);
    let run = |parameters: &SuspensionParameters, modes: usize| {
        let mut head = OnSprings::new(parameters, modes, [1e6, 1.0, 1.0], a);
        let n = head.mechanics.len();
        let mut y = vec![0.0; 2 * n];
        head.march(&mut y, 1e-3, 2000, |_, _, _| ());
        let (x, v) = y.split_at(n);
        head.mechanics.stop_forces(x, v)[1]
    };
    parameters.lift_tab = Some(LiftTab {
        gap_m: 50e-6,
        contact: law(k, 0.05),
    });
    let all = ReducedSuspension::most_bending_modes(&parameters).expect("builds");
    let whole = run(&parameters, all);
    assert!(whole > 1e-3, "{whole:e}");
    for modes in [0, 2, 4, 8] {
        let error = (run(&parameters, modes) / whole - 1.0).abs();
        println!("{modes} modes: {error:.1e}");
        assert!(error < 1e-9, "{modes}: {error:e}");
    }
}
