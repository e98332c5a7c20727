//! Hard cases A of the structure: reduction of disk and ramp, and its time stepping.

use super::check::Check;
use super::naive;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, s1};
use nalgebra::Complex;
use opshock_solver::integrator::{StageSystem, Stepper, TR_BDF2};
use opshock_solver::modal::{ForcedResponse, Oscillator, Phase};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::NoRamp;
use opshock_solver::structure::{StructureRun, Window, Workspace};
use std::f64::consts::{PI, TAU};

pub(super) fn run(structure: &Structure, amplitude: f64) -> StructureRun {
    note(structure, amplitude);
    structure
        .build()
        .run(amplitude, true, &mut Workspace::default())
        .expect("a named structure runs")
}

/// Largest difference under the slider on the coarser grid, m.
pub(super) fn slider_distance(coarse: &StructureRun, fine: &StructureRun) -> f64 {
    let (a, b) = (coarse.history.nodes(), fine.history.nodes());
    let ratio = (coarse.history.step_s() / fine.history.step_s()).round() as usize;
    let pairs = a.iter().zip(b.iter().step_by(ratio));
    pairs
        .map(|(a, b)| (a.displacement_m - b.displacement_m).abs())
        .fold(0.0, f64::max)
}

/// Response (ω² x, ω v) of an undamped mode to a unit half-sine of `width_s`, at `t_s` within it.
fn half_sine_response(omega: f64, width_s: f64, t_s: f64) -> (f64, f64) {
    let oscillator = Oscillator::fixed(omega, 0.0);
    let sine = Phase {
        wave: Complex::new(0.0, -1.0),
        ..Phase::default()
    };
    let (x, v) =
        ForcedResponse::new(&oscillator, Complex::new(0.0, PI / width_s), t_s).increments(&sine);
    (x * omega * omega, v * omega)
}

pub(super) fn a1() -> Vec<Check> {
    let width = 5e-4;
    let (mut worst, mut naive) = (0.0_f64, 0.0_f64);
    for shift in [0.0, 1e-12, -1e-12, 1e-9, -1e-9] {
        let omega = PI / width * (1.0 + shift);
        // (sin ωt − r sin ...)/(1 − r²) at ωt = π (1 + s) is π (1 + s)/(2 + s) but for s³.
        let exact = PI * (1.0 + shift) / (2.0 + shift);
        worst = worst.max((half_sine_response(omega, width, width).0 / exact - 1.0).abs());
        let error = (naive::time::closed_form(omega, width, width) / exact - 1.0).abs();
        if shift != 0.0 {
            naive = naive.max(error);
        }
    }
    let omega = TAU * 1000.0;
    let travel_um = half_sine_response(omega, width, width).0 / (omega * omega) * 200.0 * G * 1e6;
    vec![
        Check::new(
            "peak against the limit form, f T = 0.5 to 1e-9 beside it",
            worst,
            1e-10,
        )
        .against("closed form with 1/(1 - r^2), which is NaN at 0.5", naive),
        Check::new(
            "200 G, 0.5 ms, 1 kHz against 78.0388411 um",
            (travel_um / 78.038_841_1 - 1.0).abs(),
            1e-9,
        ),
    ]
}

pub(super) fn a2() -> Vec<Check> {
    let width = 1.5e-3;
    let mut checks = Vec::new();
    let names = ["peak at f T = 1.5", "peak at f T = 2.5"];
    let mut rest = 0.0_f64;
    let mut snapped = 0.0_f64;
    for ((ratio, exact), name) in [(1.5, 1.5), (2.5, 1.082_531_754_7)].into_iter().zip(names) {
        let omega = TAU * ratio / width;
        let n = 20_000;
        let peak = (1..=n)
            .map(|k| half_sine_response(omega, width, width * f64::from(k) / f64::from(n)).0)
            .fold(0.0, f64::max);
        checks.push(Check::new(name, (peak - exact).abs(), 1e-6));
        let ring = |t: f64| {
            let (x, v) = half_sine_response(omega, width, t);
            x.hypot(v) / exact
        };
        rest = rest.max(ring(width));
        // The same pulse taken to end at the last node of a 0.7 us grid before its end.
        let step = 0.7e-6;
        snapped = snapped.max(ring((width / step).floor() * step));
    }
    checks.push(
        Check::new("ringing after the pulse, of the peak", rest, 1e-8)
            .against("pulse end moved to a node", snapped),
    );
    checks
}

pub(super) fn a3() -> Vec<Check> {
    let width = 1000.37 * 0.5e-6;
    let mut structure = s1(width, NoRamp).with_cut(20e3);
    structure.window = Window::Fixed { length_s: 2e-3 };
    let coarse = run(&structure.with_step(2e-6), 100.0 * G);
    let fine = run(&structure.with_step(0.25e-6), 100.0 * G);
    let mut wide = structure.clone();
    wide.pulse.width_s = (width / 2e-6).round() * 2e-6;
    let moved = run(&wide.with_step(0.25e-6), 100.0 * G);
    let peak = fine.disk.slider_max_m;
    let mut shock_spectrum = 0.0_f64;
    for (ratio, exact) in [
        (1.0, 1.732_050_807_6),
        (2.0, 1.268_075_355_1),
        (0.809_937_6, 1.768_457_654_0),
    ] {
        let peak = (1..=40_000)
            .map(|k| half_sine_response(TAU * ratio, 1.0, f64::from(k) / 40_000.0).0)
            .fold(0.0, f64::max);
        shock_spectrum = shock_spectrum.max((peak / exact - 1.0).abs());
    }
    // Below f T = 0.5 the peak comes after the pulse: the free vibration at its end.
    let (x, v) = half_sine_response(TAU * 0.25, 1.0, 1.0);
    shock_spectrum = shock_spectrum.max((x.hypot(v) / 0.942_809_041_6 - 1.0).abs());
    // Pulses longer by a tenth of a step each: a peak that depends on the time grid would rise in steps.
    let peaks = [false, true].map(|snapped| {
        let peak = |k: u32| {
            let mut longer = structure.with_step(2e-6);
            longer.pulse.width_s = width + 0.2e-6 * f64::from(k);
            if snapped {
                longer.pulse.width_s = (longer.pulse.width_s / 2e-6).round() * 2e-6;
            }
            run(&longer, 100.0 * G).disk.slider_max_m
        };
        let peaks: Vec<f64> = (0..=20).map(peak).collect();
        let bends = peaks.windows(3).map(|p| (p[2] - 2.0 * p[1] + p[0]).abs());
        bends.fold(0.0, f64::max) / (peaks[20] - peaks[0]).abs()
    });
    vec![
        Check::new(
            "bend of the peak over pulses longer by 0.2 us, of its change over 4 us",
            peaks[0],
            5e-3,
        )
        .against("pulse end moved to a node of 2 us", peaks[1]),
        Check::new(
            "steps of 2 us against 0.25 us, of the peak",
            slider_distance(&coarse, &fine) / peak,
            1e-11,
        )
        .against(
            "pulse end moved to a node of 2 us",
            slider_distance(&moved, &fine) / peak,
        ),
        Check::new(
            "shock spectrum against its closed form",
            shock_spectrum,
            1e-7,
        ),
    ]
}

pub(super) fn a4() -> Vec<Check> {
    let (omega, amplitude) = (TAU * 1000.0, 1e6);
    let width = 1e-8;
    let (_, v) = half_sine_response(omega, width, width);
    let exact = 2.0 * amplitude * width / PI;
    let mut structure = s1(1e-7, NoRamp).with_step(2e-6).with_cut(10e3);
    structure.window = Window::Fixed { length_s: 1e-3 };
    let short = run(&structure, 1e7);
    structure.pulse.width_s = 1e-8;
    let shorter = run(&structure, 1e8);
    vec![
        Check::new(
            "velocity after 10 ns against 2 A T / pi",
            (v * amplitude / omega / exact - 1.0).abs(),
            1e-8,
        )
        .against(
            "pulse sampled at steps of 2 us",
            (naive::time::sampled_impulse(width, 2e-6) - 1.0).abs(),
        ),
        Check::new(
            "disk: pulses of 100 and 10 ns of one impulse, of the peak",
            slider_distance(&short, &shorter) / shorter.disk.slider_max_m,
            1e-3,
        ),
    ]
}

/// Two oscillators side by side under a constant force: ω² F = 1.
struct SideBySide([f64; 2]);

impl StageSystem for SideBySide {
    type Failure = ();

    fn solve_stage(&mut self, _: f64, d_s: f64, known: &[f64], y: &mut [f64]) -> Result<(), ()> {
        for (k, omega) in self.0.into_iter().enumerate() {
            // x = x₀ + d v, v = v₀ + d ω² (1 − x)
            let stiffness = omega * omega;
            let (x, v) = (known[2 * k], known[2 * k + 1]);
            y[2 * k + 1] = (v + d_s * stiffness * (1.0 - x)) / (1.0 + d_s * d_s * stiffness);
            y[2 * k] = x + d_s * y[2 * k + 1];
        }
        Ok(())
    }

    fn filter(&mut self, _: f64, _: &mut [f64]) {}
}

pub(super) fn a5() -> Vec<Check> {
    // Step 1: ω Δt = 1000 beside 0.05; from rest at 0, static value 1.
    let drive = |fast: f64| {
        let mut system = SideBySide([fast, 0.05]);
        let mut stepper = Stepper::new(TR_BDF2, 4);
        let mut y = vec![0.0; 4];
        let mut rate = vec![0.0, fast * fast, 0.0, 0.05 * 0.05];
        let mut largest = 0.0_f64;
        let mut slow = Vec::new();
        for k in 0..400 {
            stepper
                .step(&mut system, f64::from(k), 1.0, &y, &rate)
                .expect("a linear stage");
            y.copy_from_slice(stepper.value());
            rate.copy_from_slice(stepper.rate());
            largest = largest.max(y[0].abs());
            slow.push(y[2]);
        }
        (largest, (y[0] - 1.0).abs(), slow)
    };
    let (largest, left, slow) = drive(1000.0);
    let (_, _, alone) = drive(0.05);
    let apart = slow.iter().zip(&alone).map(|(a, b)| (a - b).abs());
    let exact = Oscillator::fixed(1e9, 0.0);
    let response = ForcedResponse::new(&exact, Complex::from(0.0), 1e-6);
    let (x, _) = response.increments(&Phase {
        constant: 1e18,
        ..Phase::default()
    });
    vec![
        Check::new(
            "head's scheme: stiff mode, of its static value",
            largest,
            2.0,
        ),
        Check::new(
            "head's scheme: stiff mode's ringing after 400 steps",
            left,
            1e-6,
        )
        .against(
            "trapezoidal rule",
            naive::time::trapezoidal_ringing(1000.0, 400),
        ),
        Check::new("the slow mode beside it", apart.fold(0.0, f64::max), 1e-6),
        Check::new("disk's exact flow: of the static value", x, 2.0 + 1e-12),
    ]
}

pub(super) fn a6() -> Vec<Check> {
    let (omega, step) = (TAU * 1037.3, 0.5e-6);
    let oscillator = Oscillator::fixed(omega, 0.0);
    let flow = oscillator.flow(step);
    let (mut q, mut r) = (Complex::from(1e-4), Complex::from(0.0));
    let start = oscillator.material_energy(q, r);
    for _ in 0..1_000_000 {
        (q, r) = flow.apply(q, r);
    }
    let energy = (oscillator.material_energy(q, r) / start - 1.0).abs();
    let summed = (0..1_000_000).fold(0.0_f64, |t, _| t + step);
    vec![
        Check::new("energy after a million steps", energy, 1e-10).against(
            "explicit Euler",
            naive::time::euler_energy_gain(omega * step, 1_000_000),
        ),
        Check::new(
            "time after a million steps, of a step",
            (1e6 * step - 0.5).abs() / step,
            1e-9,
        )
        .against("time summed up", (summed - 0.5).abs() / step),
    ]
}
