//! A: the structure and its time stepping.

use super::Check;
use super::naive;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, paper, s1};
use nalgebra::Complex;
use opshock_solver::disk::{DiskBasis, DiskDamping, DiskParameters, DiskResolution, Harmonics};
use opshock_solver::integrator::{StageSystem, Stepper, TR_BDF2};
use opshock_solver::modal::{ForcedResponse, Oscillator, Phase};
use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2 as G, rad_per_s_from_rpm};
use opshock_solver::ramp::{NoRamp, RigidRamp};
use opshock_solver::structure::{StructureRun, StructureWarning, Wake, Window, Workspace, modes};
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
            "200 g, 0.5 ms, 1 kHz against 78.0388411 um",
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
    // Below f T = 0.5 the peak comes after the pulse: what rings at its end.
    let (x, v) = half_sine_response(TAU * 0.25, 1.0, 1.0);
    shock_spectrum = shock_spectrum.max((x.hypot(v) / 0.942_809_041_6 - 1.0).abs());
    // Pulses longer by a tenth of a step each: a peak that hangs on the grid would rise in steps.
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

pub(super) fn a7() -> Vec<Check> {
    let resolution = DiskResolution {
        n_harmonics: 6,
        cut_hz: 20e3,
        n_elements: 24,
        static_correction: false,
    };
    let base = s1(1e-3, NoRamp);
    let (mut worst, mut without, mut signs) = (0.0_f64, 0.0_f64, 0);
    for sense in [1.0, -1.0] {
        let mut disk = base.disk.clone();
        disk.spin_rad_per_s *= sense;
        let turn_hz = disk.spin_rad_per_s.abs() / TAU;
        let table = modes(&disk, &resolution, &base.ramp).expect("modes");
        for row in table.disk {
            let n = row.nodal_diameters as f64;
            let split = row.forward_hz - row.backward_hz;
            worst = worst.max((split - 2.0 * n * turn_hz).abs() / row.rotating_frame_hz);
            if n > 1.0 {
                without = without.max((split - 2.0 * turn_hz).abs() / row.rotating_frame_hz);
            }
        }
        // What a point fixed in space sees of a pair: the turn of the oscillator's own flow.
        let n = 3.0;
        let pair = Oscillator {
            turn_rad_per_s: n * disk.spin_rad_per_s,
            ..Oscillator::fixed(TAU * 2000.0, 0.0)
        };
        let mut rates: Vec<f64> = pair.roots().iter().map(|root| root.im).collect();
        rates.sort_by(f64::total_cmp);
        signs += usize::from(rates.len() != 2);
        let beat = pair.flow(1e-6);
        signs += usize::from((beat.qq.im > 0.0) != (sense > 0.0));
    }
    vec![
        Check::new("split against 2 n f, of the frequency", worst, 1e-8)
            .against("factor n left out", without),
        Check::none("senses of rotation that do not turn the pair", signs),
    ]
}

/// Set S1 with a rigid ramp at another speed.
fn at_speed(rpm: f64) -> Structure {
    let mut structure = s1(5e-4, RigidRamp).with_cut(15e3).with_step(1e-6);
    structure.disk.spin_rad_per_s = rad_per_s_from_rpm(rpm);
    structure.window = Window::Fixed { length_s: 2e-3 };
    structure
}

/// Lowest frequency with `n` nodal diameters in the rotating frame, rad/s.
fn omega(structure: &Structure, n: usize) -> f64 {
    let resolution = DiskResolution {
        n_harmonics: n,
        ..structure.disk_resolution.clone()
    };
    let table = modes(&structure.disk, &resolution, &structure.ramp).expect("modes");
    let of_n = table.disk.iter().filter(|row| row.nodal_diameters == n);
    of_n.map(|row| row.rotating_frame_hz)
        .fold(f64::MAX, f64::min)
        * TAU
}

pub(super) fn a8() -> Vec<Check> {
    // Secant steps onto ω = 3 Ω: the centrifugal stiffness makes ω² all but linear in Ω².
    let mut rpm = 50_741.0;
    for _ in 0..12 {
        rpm *= omega(&at_speed(rpm), 3) / (3.0 * rad_per_s_from_rpm(rpm));
    }
    let ratio = 3.0 * rad_per_s_from_rpm(rpm) / omega(&at_speed(rpm), 3);
    let slow = run(&at_speed(5400.0), 1500.0 * G);
    let run = run(&at_speed(rpm), 1500.0 * G);
    vec![
        Check::new("distance to the critical speed", (ratio - 1.0).abs(), 1e-6),
        Check::new(
            "travel of the rim, of that at 5400 rpm",
            run.disk.rim_max_m / slow.disk.rim_max_m,
            10.0,
        )
        .against(
            "static solve in the fixed frame, of its own at rest",
            naive::plate::static_amplification(ratio),
        ),
        Check::new("energy book there", run.energy.closure, 1e-9),
        Check::new(
            "largest penetration there, m",
            run.complementarity.max_penetration_m,
            1e-7,
        ),
        Check::none("contacts missed", usize::from(run.first_touch_s.is_none())),
    ]
}

fn growth(run: &StructureRun, n: usize) -> Option<f64> {
    run.warnings.iter().find_map(|warning| match *warning {
        StructureWarning::PhysicalInstability {
            nodal_diameters,
            growth_per_s,
        } if nodal_diameters == n => Some(growth_per_s),
        _ => None,
    })
}

pub(super) fn a9() -> Vec<Check> {
    let (n, c) = (3, 900.0);
    let structure = at_speed(1.2 * 50_741.0);
    let turning = run(&structure, 1500.0 * G);
    let mut fixed = structure.clone();
    fixed.disk.space_fixed_damping_per_s = c;
    fixed.disk.damping = DiskDamping::ModalRatio(1e-4);
    let omega = omega(&fixed, n);
    let spin = n as f64 * structure.disk.spin_rad_per_s;
    let expected = 0.5 * c * (spin / omega - 1.0) - 1e-4 * omega;
    let fixed = run(&fixed, 1500.0 * G);
    let found = growth(&fixed, n).unwrap_or(f64::NAN);
    let mut slow = at_speed(20_000.0);
    slow.disk.space_fixed_damping_per_s = c;
    let calm = [growth(&turning, n), growth(&run(&slow, 1500.0 * G), n)];
    vec![
        Check::new(
            "growth by damping fixed in space, against theory",
            (found / expected - 1.0).abs(),
            0.01,
        )
        .against(
            "implicit Euler at the same step damps it away",
            (naive::time::implicit_euler_growth(expected, omega, 1e-6) / expected - 1.0).abs(),
        ),
        Check::none(
            "growth named where there is none",
            calm.iter().flatten().count(),
        ),
        Check::new("energy book of the growing run", fixed.energy.closure, 1e-9),
    ]
}

pub(super) fn a10() -> Vec<Check> {
    let structure = s1(5e-4, RigidRamp).with_cut(20e3);
    let mut free = structure.with_ramp(NoRamp);
    free.window = structure.window;
    let alone = run(&free, 200.0 * G);
    // Every harmonic marched from the onset, not from the first touch.
    note(&structure, 200.0 * G);
    let marched = structure
        .build()
        .with_wake(Wake::AtOnset)
        .run(200.0 * G, true, &mut Workspace::default())
        .expect("a named structure runs");
    let touch = marched.first_touch_s.unwrap_or(0.0);
    let before = (touch / marched.history.step_s()) as usize;
    let nodes = |run: &StructureRun| run.history.nodes()[..before].to_vec();
    let differing = nodes(&marched)
        .iter()
        .zip(nodes(&alone))
        .filter(|(a, b)| **a != *b)
        .count();
    let tilted = nodes(&marched)
        .iter()
        .filter(|p| p.pitch_rad != 0.0)
        .count();
    vec![
        Check::none("nodes before the touch that differ from no ramp", differing),
        Check::none("nodes before the touch tilted along the track", tilted).against(
            "uniform load summed over 360 sectors: harmonics 1 to 64 it drives",
            naive::plate::harmonics_of_a_uniform_load(64) as f64,
        ),
        Check::none("cases without a touch", usize::from(before < 100)),
    ]
}

/// A plate at rest with outer radius 1 and sqrt(ρ h/D) = 1: ω is λ².
fn unit_plate(inner: f64) -> DiskParameters {
    let poisson = 0.3;
    DiskParameters {
        inner_radius_m: inner,
        outer_radius_m: 1.0,
        thickness_m: 1e-2,
        youngs_modulus_pa: 12.0 * (1.0 - poisson * poisson) * 1e6,
        poisson,
        density_kg_per_m3: 100.0,
        spin_rad_per_s: 0.0,
        damping: DiskDamping::ModalRatio(0.0),
        space_fixed_damping_per_s: 0.0,
        hub: None,
    }
}

fn plate_basis(inner: f64, n_elements: usize) -> DiskBasis {
    basis(&unit_plate(inner), n_elements)
}

fn basis(plate: &DiskParameters, n_elements: usize) -> DiskBasis {
    let resolution = DiskResolution {
        n_harmonics: 4,
        cut_hz: 1e6,
        n_elements,
        static_correction: false,
    };
    DiskBasis::build(plate, &resolution, &[], None, Harmonics::All).expect("a plate")
}

fn lambda_squared(basis: &DiskBasis, n: usize) -> f64 {
    let of_n = basis.modes.iter().filter(|m| m.nodal_diameters == n);
    of_n.map(|m| m.omega_rad_per_s).fold(f64::MAX, f64::min)
}

pub(super) fn a11() -> Vec<Check> {
    let (mut worst, mut order, mut slip) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (inner, exact) in [
        (0.5, [13.024257, 13.289781, 14.703812, 18.561989, 25.595817]),
        (0.3, [6.660367, 6.552314, 7.956487, 13.275733, 22.073777]),
        (
            0.384_615_384_6,
            [8.576955, 8.643146, 9.991785, 14.607838, 22.761462],
        ),
    ] {
        let [coarse, middle, fine] = [12, 24, 48].map(|n| plate_basis(inner, n));
        // The same rigidity D; Poisson's ratio is left in the free edge's conditions alone.
        let slipped = DiskParameters {
            poisson: 0.0,
            youngs_modulus_pa: 12e6,
            ..unit_plate(inner)
        };
        let slipped = basis(&slipped, 48);
        for (n, exact) in exact.into_iter().enumerate() {
            let [a, b, c] = [&coarse, &middle, &fine].map(|basis| lambda_squared(basis, n));
            worst = worst.max((c / exact - 1.0).abs());
            slip = slip.max((lambda_squared(&slipped, n) / exact - 1.0).abs());
            order = order.max((((a - b) / (b - c)).log2() - 4.0).abs());
        }
    }
    vec![
        Check::new("15 frequencies against the Bessel determinant", worst, 1e-6)
            .against("Poisson's terms left out of the free edge", slip),
        Check::new("order of the frequencies, distance to 4", order, 0.25),
    ]
}

pub(super) fn a12() -> Vec<Check> {
    let (mut rise, mut real) = (0.0_f64, 0);
    for inner in [0.05, 0.95] {
        let bases = [8, 16, 32].map(|n| plate_basis(inner, n));
        for n in 0..=4 {
            let values = bases.each_ref().map(|basis| lambda_squared(basis, n));
            rise = rise
                .max(values[1] / values[0] - 1.0)
                .max(values[2] / values[1] - 1.0);
            real += values
                .iter()
                .filter(|v| !(v.is_finite() && **v > 0.0))
                .count();
        }
    }
    let meshes = [0.05, 0.95]
        .into_iter()
        .flat_map(|a| [8, 16, 32].map(|n| (a, n)));
    let indefinite =
        meshes.filter(|&(a, n)| !naive::plate::powers_of_the_radius_are_definite(a, n));
    vec![
        Check::new(
            "rise of a frequency when the mesh is halved, b/a 0.05 and 0.95",
            rise,
            1e-9,
        ),
        Check::none("frequencies that are not positive", real).against(
            "8, 16, 32 powers of the radius: mass matrices that are not definite",
            indefinite.count() as f64,
        ),
    ]
}

pub(super) fn a13() -> Vec<Check> {
    // A push so slow that all modes follow at once: what counts is the flexibility they leave out.
    let mut base = paper(10e-3, RigidRamp).with_step(4e-6);
    base.disk.damping = DiskDamping::ModalRatio(0.3);
    base.window = Window::Fixed { length_s: 6e-3 };
    let at = |cut: f64, corrected: bool| {
        let mut structure = base.with_cut(cut);
        structure.disk_resolution.static_correction = corrected;
        run(&structure, 800.0 * G)
    };
    let truth = at(80e3, true);
    let reaction = |run: &StructureRun| run.top.impulse_n_s;
    let error =
        |cut: f64, corrected: bool| (reaction(&at(cut, corrected)) / reaction(&truth) - 1.0).abs();
    let plain = [5e3, 20e3].map(|cut| error(cut, false));
    let corrected = [5e3, 20e3].map(|cut| error(cut, true));
    let of = |k: usize| corrected[k] / plain[k];
    vec![
        Check::new(
            "ramp's reaction: error with the correction, of without",
            of(0).max(of(1)),
            0.8,
        )
        // The figure is a share of the naive error.
        .against("left out", 1.0),
        Check::new(
            "error with modes to 20 kHz, of to 5 kHz",
            corrected[1] / corrected[0],
            0.3,
        ),
    ]
}
