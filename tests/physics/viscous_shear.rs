//! Viscous shear of the film on the slider: closed forms of plates and wedges, its moments, derivatives, mirror image,
//! the flight under it, and a shock.

use opshock_solver::air_bearing::gap_forces::{GapForces, ViscousShear};
use opshock_solver::air_bearing::steady::{fixed_attitude, fly};
use opshock_solver::air_bearing::{Attitude, Film, FilmResolution, FlowModel, GapForce, GapLoad};
use opshock_solver::gas::GasParameters;
use opshock_solver::quantity::GRAM_FORCE_N;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Bearing, Model, Request, Verdict, Workspace, simulate};
use opshock_solver::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};
use opshock_tests::heads::{default_slider, standard_gas};
use opshock_tests::sheet::at_most;

const ON: ViscousShear = ViscousShear { is_on: true };
const FLOOR_M: f64 = 0.3e-9;
const SPIN_RAD_PER_S: f64 = 565.0;
const SKEW_RAD: f64 = 0.15;

/// A plate, or one with a pad on its own mirror image across the middle.
fn slider(skew_rad: f64, has_pad: bool) -> SliderParameters {
    let surface = match has_pad {
        true => default_slider().surface,
        false => SurfaceParameters::default(),
    };
    SliderParameters {
        skew_rad,
        surface,
        ..default_slider()
    }
}

fn even(extent_m: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| extent_m * k as f64 / n as f64).collect()
}

fn on_even_grid(
    slider: &SliderParameters,
    gas: &GasParameters,
    flow: FlowModel,
    [nx, ny]: [usize; 2],
) -> Film {
    let (x, y) = (even(slider.length_m, nx), even(slider.width_m, ny));
    let film = Film::on_grid(slider, gas, flow, SPIN_RAD_PER_S, FLOOR_M, [&x, &y]);
    film.unwrap().with_gap_force(slider, &ON)
}

/// What the shear does where the pressure is `pressure_pa` at the distance x from the leading edge.
fn load_under(film: &Film, attitude: &Attitude, pressure_pa: impl Fn(f64) -> f64) -> GapLoad {
    let [lines, across] = film.lines_m();
    let mut psi = vec![0.0; film.n_cells()];
    let mut height = vec![0.0; film.n_cells()];
    film.heights(attitude, &mut height);
    for (i, ends) in lines.windows(2).enumerate() {
        for j in 0..across.len() - 1 {
            let cell = film.cell_index(i, j);
            psi[cell] = height[cell] * pressure_pa(0.5 * (ends[0] + ends[1]));
        }
    }
    load_at(film, &psi, attitude)
}

fn load_at(film: &Film, psi: &[f64], attitude: &Attitude) -> GapLoad {
    let loads = film.gap_loads(psi, attitude, &mut film.scratch());
    assert_eq!(loads[0].0, "viscous_shear");
    loads[0].1
}

/// Parallel plates under a uniform pressure, ambient or not: μ U A/(h + 2 λ p_a/p), along the disk's motion. The grid
/// is exact there, and rounding is all that may differ. The moments are this force times the slider's height: the leading
/// edge is pressed down.
#[test]
fn viscous_shear_of_parallel_plates() {
    let gas = standard_gas();
    for skew_rad in [0.0, SKEW_RAD, -SKEW_RAD] {
        for (flow, slip) in [
            (FlowModel::Continuum, 0.0),
            (FlowModel::Slip1, 1.0),
            (FlowModel::Slip2, 1.0),
            (FlowModel::FukuiKaneko, 1.0),
        ] {
            let slider = slider(skew_rad, false);
            let film = on_even_grid(&slider, &gas, flow, [7, 5]);
            for h in [5e-9, 50e-9, 2e-6] {
                let attitude = Attitude {
                    centre_height_m: h,
                    ..Attitude::default()
                };
                let load = load_under(&film, &attitude, |_| gas.pressure_pa);
                let speed = SPIN_RAD_PER_S * slider.radius_m;
                let drag = gas.viscosity_pa_s * speed * slider.length_m * slider.width_m
                    / (h + 2.0 * slip * gas.mean_free_path_m);
                let [along, outward] = load.in_plane_n.unwrap();
                at_most(
                    "viscous-shear",
                    "relative error of the drag, parallel plates",
                    (along / drag - 1.0).abs(),
                    1e-12,
                );
                assert!(outward.abs() < 1e-12 * drag, "{outward}");
                let [force, pitch, roll] = load.force;
                let (x, y) = (drag * skew_rad.cos(), drag * skew_rad.sin());
                let couple = slider.height_m * drag;
                assert_eq!(force, 0.0);
                assert!(
                    (pitch + slider.height_m * x).abs() < 1e-12 * couple,
                    "{pitch}"
                );
                assert!(
                    (roll - slider.height_m * y).abs() < 1e-12 * couple,
                    "{roll}"
                );
                assert!(pitch < 0.0 && (skew_rad == 0.0 || roll * skew_rad > 0.0));
            }
        }
    }
}

/// Friction of the infinitely wide plane slider on its fixed, inclined surface with the heights h₁ > h₀:
/// μ U L/h₀ (6/(a + 1) − 2 ln a/(a − 1)) per width, a = h₁/h₀, as ∫ μU/h − (h/2) dp/dx dx gives with
/// dp/dx = 6 μ U (h − h_m)/h³, h_m = 2 h₁ h₀/(h₁ + h₀).
fn wedge_friction(viscosity_pa_s: f64, speed: f64, length_m: f64, [h1, h0]: [f64; 2]) -> f64 {
    let a: f64 = h1 / h0;
    viscosity_pa_s * speed * length_m / h0 * (6.0 / (a + 1.0) - 2.0 * a.ln() / (a - 1.0))
}

const WEDGE_M: [f64; 2] = [4e-6, 2e-6];

fn wedge_attitude(slider: &SliderParameters) -> Attitude {
    let [h1, h0] = WEDGE_M;
    Attitude {
        centre_height_m: 0.5 * (h1 + h0),
        pitch_rad: (h1 - h0) / slider.length_m,
        roll_rad: 0.0,
    }
}

/// The shear under the wedge's pressure in closed form: errors of second order, 1/12 (Δx)² times the integrand's
/// second derivative, below 1/n² with heights that fall to a half.
#[test]
fn viscous_shear_of_a_wedge_in_closed_form() {
    let gas = standard_gas();
    let slider = slider(0.0, false);
    let (attitude, speed) = (wedge_attitude(&slider), SPIN_RAD_PER_S * slider.radius_m);
    let ([h1, h0], length) = (WEDGE_M, slider.length_m);
    let wind = 6.0 * gas.viscosity_pa_s * speed;
    let pressure = |x: f64| {
        let h = h1 - (h1 - h0) * x / length;
        gas.pressure_pa + wind * length * (h1 - h) * (h - h0) / ((h1 * h1 - h0 * h0) * h * h)
    };
    let expected = slider.width_m * wedge_friction(gas.viscosity_pa_s, speed, length, WEDGE_M);
    let error = |n: usize| {
        let film = on_even_grid(&slider, &gas, FlowModel::Continuum, [n, 3]);
        let [drag, outward] = load_under(&film, &attitude, pressure).in_plane_n.unwrap();
        assert!(outward.abs() < 1e-12 * drag);
        (drag / expected - 1.0).abs()
    };
    let errors = [20, 40, 80].map(error);
    for (n, error) in [20.0, 40.0, 80.0].into_iter().zip(errors) {
        at_most(
            "viscous-shear",
            &format!("relative error of the drag under a wedge's pressure, {n} cells"),
            error,
            1.0 / (n * n),
        );
    }
    let order = (errors[1] / errors[2]).log2();
    assert!((order - 2.0).abs() < 0.1, "{errors:?}");
}

/// The same with the film solved, incompressible by an ambient pressure that makes the compressibility number 1e-4, which
/// then is the share of it in the answer. Side edges are left out by the difference of two widths.
#[test]
fn viscous_shear_of_a_wedge_whose_film_is_solved() {
    let speed = SPIN_RAD_PER_S * default_slider().radius_m;
    let mut gas = standard_gas();
    let compressibility = 1e-4;
    gas.pressure_pa = 6.0 * gas.viscosity_pa_s * speed * default_slider().length_m
        / (compressibility * WEDGE_M[1] * WEDGE_M[1]);
    let drag = |n: usize, middle: usize| {
        let mut slider = slider(0.0, false);
        // The sides are felt over about a length: three of them on either side, the rest between.
        let size = 0.25 * slider.length_m;
        let cells = 24 + middle;
        slider.width_m = size * cells as f64;
        let film = on_even_grid(&slider, &gas, FlowModel::Continuum, [n, cells]);
        let attitude = wedge_attitude(&slider);
        let held = fixed_attitude(&film, &attitude).unwrap();
        let [along, _] = load_at(&film, &held.psi, &attitude).in_plane_n.unwrap();
        (along, slider.width_m, slider.length_m)
    };
    let per_width = |n: usize| {
        let (narrow, broad) = (drag(n, 0), drag(n, 8));
        (broad.0 - narrow.0) / (broad.1 - narrow.1)
    };
    let length = default_slider().length_m;
    let expected = wedge_friction(gas.viscosity_pa_s, speed, length, WEDGE_M);
    let errors = [16, 32].map(|n| (per_width(n) / expected - 1.0).abs());
    for (n, error) in [16.0, 32.0].into_iter().zip(errors) {
        assert!(
            error < 2.0 / (n * n) + compressibility,
            "{n} cells: {error:e}"
        );
    }
}

fn bare_film(slider: &SliderParameters, flow: FlowModel, cells: usize) -> Film {
    let resolution = FilmResolution {
        cells,
        min_height_m: FLOOR_M,
        correction_cells: 0,
    };
    Film::build(slider, &standard_gas(), flow, SPIN_RAD_PER_S, &resolution).unwrap()
}

fn default_film(slider: &SliderParameters, flow: FlowModel, cells: usize) -> Film {
    bare_film(slider, flow, cells).with_gap_force(slider, &ON)
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

/// Derivatives against central differences, over steps, slanted rails and below the minimum film height, with wind
/// from either side and none across. The shear is told apart by the film without it, so that it alone is compared.
#[test]
fn viscous_shear_derivatives_match_differences() {
    for (skew_rad, flow, height_m) in [
        (SKEW_RAD, FlowModel::FukuiKaneko, 60e-9),
        (-SKEW_RAD, FlowModel::Slip2, 60e-9),
        (0.0, FlowModel::Continuum, 60e-9),
        (SKEW_RAD, FlowModel::FukuiKaneko, 42e-9),
    ] {
        let mut slider = slider(skew_rad, true);
        slider.surface.twist_m = 2e-9;
        slider.surface.rails.push(Rail {
            outline: RailOutline::Polygon {
                points_m: vec![
                    [300e-6, 200e-6],
                    [420e-6, 150e-6],
                    [420e-6, 300e-6],
                    [300e-6, 260e-6],
                ],
            },
            recess_m: 0.1e-6,
        });
        let film = default_film(&slider, flow, 400);
        let attitude = Attitude {
            centre_height_m: height_m,
            pitch_rad: 1.0e-4,
            roll_rad: 8e-6,
        };
        let mut psi = vec![0.0; film.n_cells()];
        film.ambient_psi(&attitude, &mut psi);
        for (k, psi) in psi.iter_mut().enumerate() {
            *psi *= 1.5 + 0.7 * (k as f64 * 0.37).sin();
        }
        let at = load_at(&film, &psi, &attitude);
        for (q, step) in [1e-13, 1e-10, 1e-10].into_iter().enumerate() {
            let side = |sign: f64| load_at(&film, &psi, &moved(&attitude, q, sign * step)).force;
            let (up, down) = (side(1.0), side(-1.0));
            for f in 1..3 {
                let numeric = (up[f] - down[f]) / (2.0 * step);
                let scale = at.by_attitude[1][q].abs() + at.by_attitude[2][q].abs();
                assert!(
                    (numeric - at.by_attitude[f][q]).abs() < 1e-5 * scale,
                    "force {f} by {q}: {numeric:e} {:e}",
                    at.by_attitude[f][q]
                );
            }
        }
        // Along a direction of ψ, off the whole linearisation less that of the film without shear.
        let without = film
            .clone()
            .with_gap_force(&slider, &ViscousShear::default());
        let gradient = |film: &Film| {
            let mut lin = film.linearisation();
            film.linearise(&psi, &attitude, &mut lin, &mut film.scratch());
            lin.force_by_psi
        };
        let (with, plain) = (gradient(&film), gradient(&without));
        let direction: Vec<f64> = (0..psi.len())
            .map(|k| psi[k] * (k as f64 * 1.3).cos())
            .collect();
        let step = 1e-6;
        let side = |sign: f64| {
            let there = psi.iter().zip(&direction);
            let there: Vec<f64> = there.map(|(psi, d)| psi + sign * step * d).collect();
            load_at(&film, &there, &attitude).force
        };
        let (up, down) = (side(1.0), side(-1.0));
        for f in 1..3 {
            let numeric = (up[f] - down[f]) / (2.0 * step);
            let slopes = with[f].iter().zip(&plain[f]).zip(&direction);
            let parts = slopes.map(|((with, plain), d)| (with - plain) * d);
            let (exact, scale) = parts.fold((0.0, 0.0), |sum: (f64, f64), part| {
                (sum.0 + part, sum.1 + part.abs())
            });
            assert!(
                (numeric - exact).abs() < 1e-7 * scale,
                "force {f} by psi: {numeric:e} {exact:e} of {scale:e}"
            );
        }
        assert_eq!(with[0], plain[0]);
    }
}

/// Skews of either sign on a surface that is its own mirror image: the flight rolls the other way, and fore-and-aft all is the
/// same but for rounding.
#[test]
fn viscous_shear_of_either_skew_is_mirrored() {
    let flights = [SKEW_RAD, -SKEW_RAD].map(|skew_rad| {
        let slider = slider(skew_rad, true);
        let film = default_film(&slider, FlowModel::FukuiKaneko, 500);
        let flight = fly(&film, [2.2 * GRAM_FORCE_N, 0.0, 0.0]).unwrap();
        let load = load_at(&film, &flight.psi, &flight.attitude);
        (flight, load)
    });
    let [(one, a), (other, b)] = &flights;
    let alike = |a: f64, b: f64| (a - b).abs() < 1e-6 * a.abs().max(b.abs());
    assert!(alike(one.min_clearance_m, other.min_clearance_m));
    assert!(alike(one.attitude.pitch_rad, other.attitude.pitch_rad));
    assert!(alike(one.attitude.roll_rad, -other.attitude.roll_rad));
    assert!(alike(a.force[1], b.force[1]) && alike(a.force[2], -b.force[2]));
    let ([along, outward], [b_along, b_outward]) = (a.in_plane_n.unwrap(), b.in_plane_n.unwrap());
    assert!(alike(along, b_along) && alike(outward, -b_outward));
}

/// A drive without it has the bits of one that knows nothing of it.
#[test]
fn viscous_shear_that_is_off_leaves_every_bit() {
    let slider = default_slider();
    let never = bare_film(&slider, FlowModel::FukuiKaneko, 300);
    let with = never.clone().with_gap_force(&slider, &ON);
    let off = with.with_gap_force(&slider, &ViscousShear::default());
    let load = [2.2 * GRAM_FORCE_N, 0.0, 0.0];
    assert_eq!(fly(&off, load).unwrap(), fly(&never, load).unwrap());
    assert!(GapForces::default().active().next().is_none());
}

/// Couette's part of the drag, by the test's own sum over the cells.
fn couette(film: &Film, scene: &Scene, psi: &[f64], attitude: &Attitude) -> f64 {
    let (mut height, mut pressure) = (vec![0.0; psi.len()], vec![0.0; psi.len()]);
    film.heights(attitude, &mut height);
    film.pressure(psi, attitude, &mut pressure);
    let [x, y] = film.lines_m();
    let speed = scene.disk.spin_rad_per_s * scene.slider.radius_m;
    let mut sum = 0.0;
    for (i, along) in x.windows(2).enumerate() {
        for (j, across) in y.windows(2).enumerate() {
            let cell = film.cell_index(i, j);
            let path_m = scene.gas.mean_free_path_m * scene.gas.pressure_pa / pressure[cell];
            sum += (along[1] - along[0]) * (across[1] - across[0]) / (height[cell] + 2.0 * path_m);
        }
    }
    scene.gas.viscosity_pa_s * speed * sum
}

/// The default drive on 500 cells: moments that the film balances to the tolerance of any flight, a change of attitude as its
/// stiffness says, and a shock that it survives, with the work that it takes without.
#[test]
fn viscous_shear_of_the_default_drive() {
    let mut scene = Scene::default_drive();
    scene.film_resolution.cells = 500;
    scene.film_resolution.correction_cells = 0;
    let plain = Bearing::build(&scene, None).unwrap();
    scene.gap_forces.viscous_shear = ON;
    assert!(!Bearing::is_shared(&scene, &Scene::default_drive()));
    let bearing = Bearing::build(&scene, None).unwrap();
    let (film, flight) = (&bearing.film, &bearing.flight);
    let load = load_at(film, &flight.psi, &flight.attitude);
    let [drag_n, _] = load.in_plane_n.unwrap();
    // The rest is negative: the pressure rises where the film is thick, before the trailing pad, and falls where it is thin.
    let couette_n = couette(film, &scene, &flight.psi, &flight.attitude);
    assert!((couette_n / 4.22e-4 - 1.0).abs() < 0.02, "{couette_n:e} N");
    assert!((drag_n / 3.53e-4 - 1.0).abs() < 0.02, "{drag_n:e} N");
    // 9.86 nm and 110.8 urad without it: the trailing pad rises as the leading edge is pressed down.
    let rises_m = flight.min_clearance_m - plain.flight.min_clearance_m;
    assert!((rises_m / 0.145e-9 - 1.0).abs() < 0.05, "{rises_m:e} m");
    let pitches_rad = flight.attitude.pitch_rad - plain.flight.attitude.pitch_rad;
    assert!(
        (pitches_rad / -1.11e-6 - 1.0).abs() < 0.05,
        "{pitches_rad:e} rad"
    );
    let mut residual = vec![0.0; film.n_cells()];
    let scratch = &mut film.scratch();
    let [force, pitch, roll] =
        film.flux_residual_and_force(&flight.psi, &flight.attitude, &mut residual, scratch);
    let load_n = scene.suspension.gram_load_n;
    let arm = 1e-7 * load_n * scene.slider.length_m;
    assert!((force / load_n - 1.0).abs() < 1e-7);
    assert!(pitch.abs() < arm && roll.abs() < arm, "{pitch:e} {roll:e}");
    // Quasi-static stiffness times the change of attitude is the moment that was added, to the first order.
    let change = [
        flight.attitude.centre_height_m - plain.flight.attitude.centre_height_m,
        flight.attitude.pitch_rad - plain.flight.attitude.pitch_rad,
    ];
    let row = plain.flight.stiffness[1];
    let reported = row[0] * change[0] + row[1] * change[1];
    assert!(
        (reported / load.force[1] - 1.0).abs() < 0.02,
        "{reported:e}"
    );

    let request = Request {
        amplitude_m_per_s2: -100.0 * 9.80665,
        record: false,
    };
    let run = |scene: &Scene| {
        let model = Model::new(scene).unwrap();
        simulate(&model, &request, &mut Workspace::default())
    };
    let with = run(&scene);
    scene.gap_forces.viscous_shear = ViscousShear::default();
    let without = run(&scene);
    assert!(with.effects.contains(&ON.name()) && !without.effects.contains(&ON.name()));
    assert_eq!(with.verdict, Some(Verdict::Survives));
    let [higher, lower] = [&with, &without].map(|run| run.min_clearance_m.unwrap());
    assert!(
        higher > lower && higher < 1.05 * lower,
        "{higher:e} {lower:e} m"
    );
    // Newton's matrix holds the shear: no more work for it.
    let (a, b) = (
        with.cost.film_solves as f64,
        without.cost.film_solves as f64,
    );
    assert!(a < 1.1 * b, "{a} {b}");
}
