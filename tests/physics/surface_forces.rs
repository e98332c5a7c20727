//! Van der Waals and electrostatic forces: closed forms of plates, derivatives, flying height, pull-in,
//! and the head in motion under them.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use opshock_solver::air_bearing::steady::{
    Flight, SteadyError, fixed_attitude, fly, lower_equilibria,
};
use opshock_solver::air_bearing::{Attitude, Film, FilmResolution, FlowModel, SurfaceForces};
use opshock_solver::head::{Coupling, HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::quantity::{GRAM_FORCE_N, rad_per_s_from_rpm};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::slider::surface::Surface;
use opshock_solver::slider::{SliderParameters, SurfaceParameters};
use opshock_tests::heads::{
    StillDisk, default_resolution, default_slider, even_film, gap_load, head_on, standard_gas,
};
use opshock_tests::sheet::at_most;

const PERMITTIVITY: f64 = 8.854_187_812_8e-12;
const LOAD_N: f64 = 2.2 * GRAM_FORCE_N;
const FLOOR_M: f64 = 0.3e-9;
/// Carbon on carbon, as Wu and Bogy (2002) take it, and half a volt.
const USUAL: SurfaceForces = SurfaceForces {
    hamaker_j: 1.8e-19,
    repulsion_j_m6: 1.0e-76,
    potential_v: 0.5,
};

fn plate() -> SliderParameters {
    SliderParameters {
        surface: SurfaceParameters::default(),
        ..default_slider()
    }
}

fn default_film(cells: usize) -> Film {
    let resolution = FilmResolution {
        cells,
        min_height_m: FLOOR_M,
        correction_cells: 0,
    };
    let spin = rad_per_s_from_rpm(5400.0);
    let flow = FlowModel::FukuiKaneko;
    Film::build(&default_slider(), &standard_gas(), flow, spin, &resolution).unwrap()
}

fn moved(attitude: &Attitude, q: usize, by: f64) -> Attitude {
    let mut out = *attitude;
    *[
        &mut out.centre_height_m,
        &mut out.pitch_rad,
        &mut out.roll_rad,
    ][q] += by;
    out
}

/// Each force alone, and all three.
fn each() -> [SurfaceForces; 4] {
    let none = SurfaceForces::default();
    [
        SurfaceForces {
            hamaker_j: 1.8e-19,
            ..none
        },
        SurfaceForces {
            repulsion_j_m6: 1.0e-76,
            ..none
        },
        SurfaceForces {
            potential_v: 0.5,
            ..none
        },
        USUAL,
    ]
}

/// Force per area at h as written in the literature.
fn pressure(forces: &SurfaceForces, h: f64) -> f64 {
    -forces.hamaker_j / (6.0 * PI * h.powi(3)) + forces.repulsion_j_m6 / (45.0 * PI * h.powi(9))
        - PERMITTIVITY * forces.potential_v.powi(2) / (2.0 * h * h)
}

#[test]
fn surface_forces_of_parallel_plates() {
    let slider = plate();
    let area = slider.length_m * slider.width_m;
    for forces in each() {
        let film = even_film(&slider, 8, &forces);
        for h in [0.7e-9, 2e-9, 9e-9, 50e-9] {
            let attitude = Attitude {
                centre_height_m: h,
                ..Attitude::default()
            };
            let load = gap_load(&film, &attitude);
            let expected = pressure(&forces, h) * area;
            at_most(
                "surface-forces",
                "relative error of the force, parallel plates",
                (load.force[0] / expected - 1.0).abs(),
                1e-12,
            );
            let arm = load.force[1].abs() + load.force[2].abs();
            assert!(arm < 1e-12 * expected.abs() * slider.length_m, "{load:?}");
        }
    }
}

/// Surfaces with the work of adhesion γ and the distance z₀ at rest attract with 8 γ/(3 z₀) ((z₀/h)³ − (z₀/h)⁹) an area; a flat
/// punch comes off at its largest value, 16 γ/(9 √3 z₀), at h = 3^(1/6) z₀ (Greenwood, Proc. R. Soc. A 453 (1997) 1277).
#[test]
fn surface_forces_hold_a_flat_punch_up_to_its_pull_off() {
    let slider = plate();
    let (z0, adhesion_j_per_m2) = (0.7e-9_f64, 7e-3);
    let hamaker_j = 16.0 * PI * adhesion_j_per_m2 * z0 * z0;
    let forces = SurfaceForces {
        hamaker_j,
        repulsion_j_m6: 7.5 * hamaker_j * z0.powi(6),
        potential_v: 0.0,
    };
    let film = even_film(&slider, 8, &forces);
    let pull = |h: f64| {
        let attitude = Attitude {
            centre_height_m: h,
            ..Attitude::default()
        };
        -gap_load(&film, &attitude).force[0] / (slider.length_m * slider.width_m)
    };
    let closed = 16.0 * adhesion_j_per_m2 / (9.0 * 3.0_f64.sqrt() * z0);
    // Largest pull, by thirds of a range where it rises and falls.
    let [mut low, mut high] = [z0, 3.0 * z0];
    while high - low > 1e-8 * z0 {
        let third = (high - low) / 3.0;
        if pull(low + third) < pull(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    let error = (pull(low) / closed - 1.0).abs();
    at_most(
        "surface-forces",
        "relative error of the pull-off force, flat punch",
        error,
        1e-12,
    );
    assert!((low / z0 / 3.0_f64.powf(1.0 / 6.0) - 1.0).abs() < 1e-6);
    assert!(pull(z0).abs() < 1e-12 * closed);
}

/// ∫ x^k u^-n dx over −l/2 .. l/2 with u = h − slope x, for k = 0, 1.
fn moments_of_power(n: i32, h: f64, slope: f64, l: f64) -> [f64; 2] {
    let power = |u: f64, m: i32| match m {
        -1 => u.ln(),
        m => u.powi(m + 1) / f64::from(m + 1),
    };
    let (low, high) = (h - 0.5 * slope * l, h + 0.5 * slope * l);
    let over = |m: i32| power(high, m) - power(low, m);
    [
        over(-n) / slope,
        (h * over(-n) - over(1 - n)) / (slope * slope),
    ]
}

/// A plate pitched by 3 nm over its length, or rolled, against the integrals in closed form; Gauss's rule
/// errs with the fourth power of the cells' size.
#[test]
fn surface_forces_of_tilted_plates_and_their_order() {
    let slider = plate();
    let (l, w) = (slider.length_m, slider.width_m);
    let h = 4e-9;
    for forces in each() {
        for tilt in ["pitch", "roll"] {
            // Pitch lowers the trailing edge (+x), roll lifts +y: u = h − s x.
            let (slope, along, across) = match tilt {
                "pitch" => (3e-9 / l, l, w),
                _ => (-3e-9 / w, w, l),
            };
            let attitude = Attitude {
                centre_height_m: h,
                pitch_rad: if tilt == "pitch" { slope } else { 0.0 },
                roll_rad: if tilt == "roll" { -slope } else { 0.0 },
            };
            let parts = [
                (3, -forces.hamaker_j / (6.0 * PI)),
                (9, forces.repulsion_j_m6 / (45.0 * PI)),
                (2, -0.5 * PERMITTIVITY * forces.potential_v.powi(2)),
            ];
            let mut expected = [0.0; 2];
            for (n, factor) in parts {
                let integral = moments_of_power(n, h, slope, along);
                expected[0] += factor * across * integral[0];
                expected[1] += factor * across * integral[1];
            }
            // M_pitch = −∫ x p, M_roll = ∫ y p.
            let (axis, sign) = if tilt == "pitch" { (1, -1.0) } else { (2, 1.0) };
            let error = |n: usize| {
                let film = even_film(&slider, n, &forces);
                let load = gap_load(&film, &attitude);
                let force = (load.force[0] / expected[0] - 1.0).abs();
                let moment = (sign * load.force[axis] / expected[1] - 1.0).abs();
                [force, moment]
            };
            let (coarse, fine) = (error(10), error(20));
            for k in 0..2 {
                let rate = (coarse[k] / fine[k]).log2();
                assert!(rate > 3.9, "{forces:?} {tilt} {k}: {rate}");
                assert!(fine[k] < 1e-3, "{forces:?} {tilt} {k}: {}", fine[k]);
            }
            let [force, moment] = error(160);
            at_most(
                "surface-forces",
                "relative error of the force, tilted plates, 160 x 160 cells",
                force,
                1e-6,
            );
            at_most(
                "surface-forces",
                "relative error of the moment, likewise",
                moment,
                1e-6,
            );
        }
    }
}

/// Derivatives against differences: of the surface forces above, near and below the minimum film height, and
/// of the whole film's quasi-static stiffness against films held at displaced attitudes.
#[test]
fn surface_forces_stiffness_is_the_derivative() {
    let slider = default_slider();
    let film = default_film(1000).with_gap_force(&slider, &USUAL);
    let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
    let steps = [1e-13, 2e-10, 3e-10];
    for lower in [0.0, 7e-9, 9e-9, 12e-9] {
        let mut at = moved(&flight.attitude, 0, -lower);
        at.roll_rad = 2e-6;
        let load = gap_load(&film, &at);
        for (q, step) in steps.into_iter().enumerate() {
            let side = |sign: f64| gap_load(&film, &moved(&at, q, sign * step));
            let (up, down) = (side(1.0).force, side(-1.0).force);
            for f in 0..3 {
                let slope = (up[f] - down[f]) / (2.0 * step);
                let scale = (load.by_attitude[f][f] * load.by_attitude[q][q])
                    .abs()
                    .sqrt();
                let error = (load.by_attitude[f][q] - slope).abs() / scale;
                assert!(error < 2e-5, "{lower} {f} {q}: {error}");
            }
        }
    }
    for (q, step) in steps.into_iter().enumerate() {
        let held = |sign: f64| {
            let attitude = moved(&flight.attitude, q, sign * 10.0 * step);
            fixed_attitude(&film, &attitude).unwrap().force
        };
        let (up, down) = (held(1.0), held(-1.0));
        for f in 0..3 {
            let slope = -(up[f] - down[f]) / (20.0 * step);
            let scale = (flight.stiffness[f][f] * flight.stiffness[q][q])
                .abs()
                .sqrt();
            let error = (flight.stiffness[f][q] - slope).abs() / scale;
            assert!(error < 1e-5, "film {f} {q}: {error}");
        }
    }
}

/// Midpoint rule on a grid of its own over the slider's true surface.
fn by_midpoints(forces: &SurfaceForces, attitude: &Attitude) -> Vector3<f64> {
    let slider = default_slider();
    let surface = Surface::new(&slider);
    let [xc, yc] = surface.centre_m();
    let (nx, ny) = (1700, 350);
    let (dx, dy) = (slider.length_m / nx as f64, slider.width_m / ny as f64);
    let mut out = Vector3::zeros();
    for i in 0..nx {
        for j in 0..ny {
            let (x, y) = ((i as f64 + 0.5) * dx, (j as f64 + 0.5) * dy);
            let h = attitude.centre_height_m - attitude.pitch_rad * (x - xc)
                + attitude.roll_rad * (y - yc)
                + surface.recess_m(x, y)
                + surface.form_m(x, y);
            let p = pressure(forces, h) * dx * dy;
            out += Vector3::new(p, -p * (x - xc), p * (y - yc));
        }
    }
    out
}

/// At the attitude flown under surface forces the air alone, held there, and the closed forms summed
/// over a grid of the test's own balance the gram load; weak forces lower the slider by what the
/// air's stiffness gives way.
#[test]
fn surface_forces_lower_the_flying_slider_by_the_balance_of_forces() {
    let bare = default_film(2000);
    let before = fly(&bare, [LOAD_N, 0.0, 0.0]).unwrap();
    let film = bare.clone().with_gap_force(&default_slider(), &USUAL);
    let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
    assert!(flight.min_clearance_m < before.min_clearance_m);
    let air = Vector3::from(fixed_attitude(&bare, &flight.attitude).unwrap().force);
    let surface = by_midpoints(&USUAL, &flight.attitude);
    assert!(surface[0] < -1e-5, "{surface}");
    let left = air + surface - Vector3::new(LOAD_N, 0.0, 0.0);
    let scale = surface[0].abs();
    assert!(left[0].abs() < 2e-3 * scale, "{left} beside {surface}");
    assert!(
        left[1].abs() < 2e-3 * scale * 4e-4,
        "{left} beside {surface}"
    );
    assert!(flight.n_iterations <= before.n_iterations + 3);

    let stiffness = Matrix3::from_fn(|i, j| before.stiffness[i][j]);
    let drop = |share: f64| {
        let forces = SurfaceForces {
            hamaker_j: share * USUAL.hamaker_j,
            repulsion_j_m6: share * USUAL.repulsion_j_m6,
            potential_v: share.sqrt() * USUAL.potential_v,
        };
        let film = bare.clone().with_gap_force(&default_slider(), &forces);
        let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
        let found = flight.attitude.centre_height_m - before.attitude.centre_height_m;
        let given = stiffness.try_inverse().unwrap() * by_midpoints(&forces, &before.attitude);
        (found / given[0] - 1.0).abs()
    };
    let (some, tenth) = (drop(0.1), drop(0.01));
    // What is left falls with the force, down to the grid's own error.
    assert!(tenth < 0.005 && some < 0.05, "{some} {tenth}");
}

/// Determinant of the stiffness against heave and pitch; roll keeps its own on this slider.
fn determinant(flight: &Flight) -> f64 {
    let k = &flight.stiffness;
    k[0][0] * k[1][1] - k[0][1] * k[1][0]
}

fn under_potential(bare: &Film, potential_v: f64) -> Film {
    let forces = SurfaceForces {
        potential_v,
        ..SurfaceForces::default()
    };
    bare.clone().with_gap_force(&default_slider(), &forces)
}

fn at_potential(bare: &Film, potential_v: f64) -> Result<Flight, SteadyError> {
    fly(&under_potential(bare, potential_v), [LOAD_N, 0.0, 0.0])
}

/// Rising potential lowers the slider until its stiffness is spent and it meets the unstable equilibrium
/// below, both as the root of what is left to the fold. Beyond, the error says so, names the clearance it
/// would fly at and the share of the forces at the fold to a thousandth.
#[test]
fn surface_forces_pull_the_slider_in_at_a_fold() {
    let bare = default_film(1000);
    let free = fly(&bare, [LOAD_N, 0.0, 0.0]).unwrap();
    let (mut low, mut high) = (1.4, 1.7);
    let mut pulled = Vec::new();
    while high - low > 1e-5 * high {
        let middle = 0.5 * (low + high);
        match at_potential(&bare, middle) {
            Ok(flight) => {
                assert!(flight.min_clearance_m < free.min_clearance_m);
                low = middle;
            }
            Err(SteadyError::PulledIn { share, without_m }) => {
                assert_eq!(without_m, free.min_clearance_m);
                // Force goes with the square of the potential.
                pulled.push(middle * share.sqrt());
                high = middle;
            }
            Err(other) => panic!("{middle} V: {other}"),
        }
    }
    let left = |share: f64| {
        let film = under_potential(&bare, low * (1.0 - share));
        let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
        // The unstable partner of the flight, with which it merges at the fold.
        let lower = lower_equilibria(&film, [LOAD_N, 0.0, 0.0], &flight);
        let apart = flight.min_clearance_m - lower[0].min_clearance_m;
        assert!(!lower[0].stable);
        [determinant(&flight).powi(2), apart.powi(2)]
    };
    let (near, nearer) = (left(4e-4), left(1e-4));
    for (near, nearer) in near.into_iter().zip(nearer) {
        let fold = (near * 1e-4 - nearer * 4e-4) / (near - nearer);
        assert!(nearer < 0.01 * determinant(&free).powi(2));
        assert!(fold.abs() < 3e-5, "{low} V, fold {fold} above");
    }
    assert!(pulled.len() > 3);
    for potential in pulled {
        assert!(
            (potential / low - 1.0).abs() < 1e-3,
            "{potential} V, {low} V"
        );
    }
    let error = at_potential(&bare, 1.001 * high).unwrap_err().to_string();
    assert!(error.contains("pull the slider onto the disk"), "{error}");
}

fn shock(film: &Arc<Film>, coupling: Coupling, tolerance: f64, amplitude: f64) -> HeadRun {
    let flight = Arc::new(fly(film, [LOAD_N, 0.0, 0.0]).unwrap());
    let mut resolution = default_resolution();
    resolution.coupling = coupling;
    resolution.tolerance = tolerance;
    resolution.coupling_tolerance = 1e-2 * tolerance;
    let head = head_on(film, &flight, &resolution);
    let pulse = Pulse {
        shape: PulseShape::HalfSine,
        width_s: 2e-4,
    };
    let load = ShockLoad {
        base: None,
        pulse: &pulse,
        amplitude_m_per_s2: amplitude,
    };
    let mut workspace = HeadWorkspace::new(&head);
    head.run(&StillDisk, &load, 3e-4, true, true, &mut workspace)
}

/// In motion: rest stays rest, Newton on everything needs no more iterations than without surface
/// forces, film and structure in turn find the same, and errors fall with the tolerance.
#[test]
fn surface_forces_enter_the_coupled_head() {
    let bare = Arc::new(default_film(500));
    let film = (*bare).clone().with_gap_force(&default_slider(), &USUAL);
    let film = Arc::new(film);
    let rest = shock(&film, Coupling::Monolithic, 1e-3, 0.0);
    let columns = rest.columns.unwrap();
    let moved = columns
        .slider_z_m
        .iter()
        .fold(0.0, |m: f64, z| m.max(z.abs()));
    assert!(moved < 1e-16, "{moved}");
    let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
    let surface = gap_load(&film, &flight.attitude).force[0];
    assert!((columns.bearing_force_n[0] - (LOAD_N - surface)).abs() < 1e-9 * LOAD_N);

    let amplitude = -1500.0;
    let per_step = |run: &HeadRun| {
        let steps = (run.cost.steps + run.cost.rejected) as f64;
        [
            run.cost.film_residuals as f64 / steps,
            run.cost.factorisations as f64 / steps,
        ]
    };
    let plain = shock(&bare, Coupling::Monolithic, 1e-3, amplitude);
    let with = shock(&film, Coupling::Monolithic, 1e-3, amplitude);
    assert_eq!(with.verdict, Verdict::Survives);
    assert!(with.min_clearance_m < plain.min_clearance_m);
    let (a, b) = (per_step(&plain), per_step(&with));
    assert!(b[0] < 1.05 * a[0] && b[1] < 1.1 * a[1], "{a:?} {b:?}");

    let finest = shock(&film, Coupling::Monolithic, 1e-6, amplitude).min_clearance_m;
    let error = |coupling, tolerance| {
        let run = shock(&film, coupling, tolerance, amplitude);
        (run.min_clearance_m - finest).abs() / finest
    };
    let anderson = error(Coupling::Anderson, 1e-4);
    assert!(anderson < 1e-4, "{anderson}");
    let (coarse, fine) = (
        error(Coupling::Monolithic, 1e-2),
        error(Coupling::Monolithic, 1e-4),
    );
    // The embedded error is of third order in the step, the scheme of second: 10^(2 2/3) at least.
    assert!(fine < 1e-4 && coarse / fine > 10.0, "{coarse} {fine}");
}

/// Just below pull-in a shock that the bare slider survives ends on the disk: touch, not a hang.
#[test]
fn surface_forces_pull_in_during_a_shock_is_a_touch() {
    let bare = default_film(500);
    let (mut low, mut high) = (1.4, 1.7);
    while high - low > 1e-3 * high {
        let middle = 0.5 * (low + high);
        match at_potential(&bare, middle) {
            Ok(_) => low = middle,
            Err(_) => high = middle,
        }
    }
    let forces = SurfaceForces {
        potential_v: 0.98 * low,
        ..SurfaceForces::default()
    };
    let film = bare.clone().with_gap_force(&default_slider(), &forces);
    let (bare, film) = (Arc::new(bare), Arc::new(film));
    let without = shock(&bare, Coupling::Monolithic, 1e-3, -1500.0);
    let with = shock(&film, Coupling::Monolithic, 1e-3, -1500.0);
    assert_eq!(without.verdict, Verdict::Survives);
    assert!(matches!(with.verdict, Verdict::Fails { .. }), "{with:?}");
}
