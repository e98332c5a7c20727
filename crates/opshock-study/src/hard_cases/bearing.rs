//! Hard cases C of the air bearing: schemes, fits, continuation and Newton's method.

use super::check::{Check, largest};
use super::naive;
use super::scenes::films::{
    AMBIENT_PA, LENGTH_M, PlaneSlider, TRAILING_M, VISCOSITY_PA_S, crowded, crowded_twice, uniform,
};
use super::scenes::heads::default_film;
use nalgebra::{Matrix3, Vector3};
use opshock_solver::air_bearing::impedance::SmallMotion;
use opshock_solver::air_bearing::steady::{fixed_attitude, fly_from};
use opshock_solver::air_bearing::{Attitude, Film, FlowFactor, FlowModel};
use opshock_solver::quantity::GRAM_FORCE_N;

pub(super) fn c1() -> Vec<Check> {
    let (mut load_error, mut centre_error, mut peak_error) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (knudsen, bearing_number, load, centre, peak) in [
        (0.0, 1.0, 0.02638214, 0.5760537, 1.0418171),
        (0.0, 10.0, 0.21002882, 0.6228682, 1.3612459),
        (0.0, 100.0, 0.37074123, 0.6940930, 1.8515775),
        (0.0, 1000.0, 0.38478901, 0.7045057, 1.9759700),
        (0.1, 1.0, 0.01873479, 0.5672862, 1.0293653),
        (0.1, 100.0, 0.36438729, 0.6894843, 1.8155337),
        (0.1, 1000.0, 0.38418563, 0.7040477, 1.9695566),
        (1.0, 1.0, 0.00521583, 0.5517479, 1.0080184),
        (1.0, 100.0, 0.30365885, 0.6507819, 1.5795284),
        (1.0, 1000.0, 0.37872234, 0.6999230, 1.9207217),
    ] {
        let held = PlaneSlider::wide(FlowModel::Slip1, 2.0, bearing_number, knudsen)
            .hold_row(&crowded(64, 4.0));
        load_error = load_error.max((held.load / load - 1.0).abs());
        centre_error = centre_error.max((held.centre / centre - 1.0).abs());
        peak_error = peak_error.max((largest(held.pressure.iter().copied()) / peak - 1.0).abs());
    }
    let (_, central) = naive::film::central_slider(1000.0, 32, 0.384_789_01, 1.975_97);
    vec![
        Check::new("load, 64 cells", load_error, 1e-3),
        Check::new("centre of pressure, 64 cells", centre_error, 1e-3),
        Check::new("peak pressure, 64 cells", peak_error, 1e-3).against(
            "central differences in P, 32 equal cells, bearing number 1000",
            central,
        ),
    ]
}

pub(super) fn c2() -> Vec<Check> {
    let exact = 2.0 * std::f64::consts::LN_2 - 1.0;
    let x = crowded(256, 4.0);
    let (mut load, mut outside) = (0.0_f64, 0.0_f64);
    for bearing_number in [1e4, 1e5, 1e6, 1e7] {
        let held = PlaneSlider::wide(FlowModel::Continuum, 2.0, bearing_number, 0.0).hold_row(&x);
        load = load.max((held.load / exact - 1.0).abs() - 5.0 / bearing_number);
        for (i, p) in held.pressure.iter().enumerate() {
            let most = 2.0 / (2.0 - 0.5 * (x[i] + x[i + 1]));
            outside = outside.max(p / most - 1.0).max(1.0 - p);
        }
    }
    vec![
        Check::new(
            "load against 2 ln 2 - 1, beyond the layer's share 5/Lambda",
            load,
            1e-5,
        ),
        Check::new("pressure beyond what p h = const allows", outside, 1e-12).against(
            "central differences in P, 32 equal cells, bearing number 10000: above 2",
            naive::film::central_slider(1e4, 32, exact, 2.0).1,
        ),
    ]
}

pub(super) fn c3() -> Vec<Check> {
    let lines = uniform(20, 1.0);
    let mut slider = PlaneSlider::square(FlowModel::FukuiKaneko, 2.0, 100.0, 0.5);
    let mut at = |edge: f64| {
        slider.recesses = vec![([0.2, edge], [0.3, 0.7], 10.0)];
        let film = slider.film(&lines, &lines);
        let attitude = slider.attitude();
        let held = fixed_attitude(&film, &attitude).expect("a steady film");
        let mut residual = vec![0.0; film.n_cells()];
        film.flux_residual(&held.psi, &attitude, &mut residual, &mut film.scratch());
        (held.force[0], largest(residual.iter().map(|r| r.abs())))
    };
    let wind = 100.0 * AMBIENT_PA * TRAILING_M * TRAILING_M / LENGTH_M;
    let through = wind * AMBIENT_PA * TRAILING_M * LENGTH_M;
    let (on, leak) = at(0.5);
    let (before, other) = at(0.5 - 1e-9);
    let (after, _) = at(0.5 + 1e-9);
    let looked_up = |edge: f64| naive::film::step_looked_up_at_lines(20, edge);
    vec![
        Check::new(
            "mass lost by a cell, of the through-flow",
            leak.max(other) / through,
            1e-12,
        ),
        Check::new(
            "load as the edge crosses a grid line",
            (before / on - 1.0).abs().max((after / on - 1.0).abs()),
            1e-7,
        )
        .against(
            "incompressible step of 2 to 1, height looked up at 20 grid lines",
            (looked_up(0.5 + 1e-9) / looked_up(0.5 - 1e-9) - 1.0).abs(),
        ),
    ]
}

pub(super) fn c4() -> Vec<Check> {
    let squeeze = |lines: &[f64], across: &[f64], width: f64, sigma: f64| {
        let slider = PlaneSlider {
            width,
            ..PlaneSlider::square(FlowModel::Continuum, 1.0, 0.0, 0.0)
        };
        let film = slider.film(lines, across);
        let attitude = slider.attitude();
        let mut psi = vec![0.0; film.n_cells()];
        film.ambient_psi(&attitude, &mut psi);
        let omega = sigma * AMBIENT_PA * TRAILING_M * TRAILING_M
            / (12.0 * VISCOSITY_PA_S * LENGTH_M * LENGTH_M);
        let mut motion = SmallMotion::new(&film, &psi, &attitude);
        let z = motion
            .impedance(omega / std::f64::consts::TAU)
            .expect("an impedance")[(0, 0)];
        let scale = TRAILING_M / (AMBIENT_PA * width * LENGTH_M * LENGTH_M);
        [z.re * scale, z.im * scale]
    };
    let (mut worst, mut quasi_steady) = (0.0_f64, 0.0_f64);
    for (sigma, stiffness, damping) in [
        (0.1, 0.000_083_324_8, 0.008_332_490_2),
        (10.0, 0.411_793_699_6, 0.417_175_356_9),
        (1000.0, 0.955_278_640_4, 0.044_721_359_6),
    ] {
        let value = |n: usize| {
            let lines = crowded_twice(n);
            // What the two ends of the strip contribute cancels in the difference of two widths.
            let three = squeeze(&lines, &uniform(3, 3e6), 3e6, sigma);
            let four = squeeze(&lines, &uniform(4, 4e6), 4e6, sigma);
            [0, 1].map(|part| 4.0 * four[part] - 3.0 * three[part])
        };
        let [a, b, c] = [100, 200, 400].map(value);
        let size = f64::hypot(stiffness, damping);
        for (part, expected) in [stiffness, damping].into_iter().enumerate() {
            let (first, second) = (
                (4.0 * b[part] - a[part]) / 3.0,
                (4.0 * c[part] - b[part]) / 3.0,
            );
            worst = worst.max(((16.0 * second - first) / 15.0 - expected).abs() / size);
        }
        quasi_steady = quasi_steady.max(stiffness / size);
    }
    vec![
        Check::new("stiffness and damping against the closed form", worst, 1e-6).against(
            "squeeze without the gas's own storage: no stiffness",
            quasi_steady,
        ),
    ]
}

pub(super) fn c5() -> Vec<Check> {
    let slider = PlaneSlider::square(FlowModel::FukuiKaneko, 1.5, 1000.0, 0.64);
    let film = slider.film(&uniform(12, 1.0), &uniform(12, 1.0));
    let mut wrong = 0;
    for height_m in [1e-9, 1e-11, 1e-13, 0.0, -5e-8] {
        let attitude = Attitude {
            centre_height_m: height_m,
            ..slider.attitude()
        };
        let held = fixed_attitude(&film, &attitude).expect("a steady film");
        let mut pressure = vec![0.0; film.n_cells()];
        film.pressure(&held.psi, &attitude, &mut pressure);
        wrong += pressure
            .iter()
            .filter(|p| !(p.is_finite() && **p > 0.0))
            .count();
        wrong += held.force.iter().filter(|f| !f.is_finite()).count();
    }
    // Free molecular flow: Q_P = -ln D/sqrt(pi) + c0, with D ~ gap; conductance 6 Q_P psi/D.
    let free_path = 63.5e-9 * 101_325.0;
    let factor = FlowFactor::new(FlowModel::FukuiKaneko, free_path);
    let root = std::f64::consts::PI.sqrt();
    let (mut flow, mut fit) = (0.0_f64, 0.0_f64);
    for h in [1e-11, 1e-13, 1e-15] {
        let psi = 101_325.0 * h;
        let d = 0.5 * root * psi / free_path;
        let rate = -d.ln() / root + 0.376_261;
        let found = factor.conductance(psi).0 * d / (6.0 * psi);
        flow = flow.max((found / rate - 1.0).abs());
        fit = fit.max((naive::film::thin_gap_fit(d) / rate - 1.0).abs());
    }
    let unfloored = [1e-9, 1e-11, 1e-13, 0.0, -5e-8].map(|h| AMBIENT_PA * 1e-9 / h);
    let breaks = unfloored.iter().filter(|p| !(p.is_finite() && **p > 0.0));
    vec![
        Check::none(
            "pressures and forces that are not numbers, 1 nm to below 0",
            wrong,
        )
        .against("psi over the height itself", breaks.count() as f64),
        Check::new(
            "flow below 10 pm against its free-molecular limit",
            flow,
            1e-3,
        )
        .against("the three-range fit beyond its range", fit),
    ]
}

pub(super) fn c8() -> Vec<Check> {
    let (mut pressure, mut load) = (0.0_f64, 0.0_f64);
    for model in [
        FlowModel::Continuum,
        FlowModel::Slip2,
        FlowModel::FukuiKaneko,
    ] {
        for bearing_number in [0.0, 1e3, 1e6] {
            let mut slider = PlaneSlider::square(model, 1.0, bearing_number, 0.7);
            slider.skew_rad = 0.3;
            let held = slider.hold(&crowded(20, 2.0), &uniform(15, 1.0));
            pressure = pressure.max(largest(held.pressure.iter().map(|p| (p - 1.0).abs())));
            load = load.max(held.load.abs());
        }
    }
    vec![
        Check::new("pressure off ambient", pressure, 1e-14),
        Check::new("load", load, 1e-14),
    ]
}

fn stepped() -> PlaneSlider {
    let mut slider = PlaneSlider::square(FlowModel::FukuiKaneko, 2.0, 300.0, 0.5);
    slider.recesses = vec![([0.1, 0.3], [0.2, 0.8], 4.0)];
    slider
}

fn force(slider: &PlaneSlider, roll_rad: f64, backwards: bool) -> [f64; 3] {
    let film = slider.film(&crowded_twice(24), &crowded_twice(18));
    let mut attitude = slider.attitude();
    attitude.roll_rad = roll_rad;
    if backwards {
        attitude.pitch_rad = -attitude.pitch_rad;
    }
    fixed_attitude(&film, &attitude)
        .expect("a steady film")
        .force
}

pub(super) fn c9() -> Vec<Check> {
    let slider = stepped();
    let level = force(&slider, 0.0, false);
    let (one, other) = (force(&slider, 3e-5, false), force(&slider, -3e-5, false));
    vec![
        Check::new(
            "roll moments of +r and -r, sum",
            (one[2] + other[2]).abs() / one[2].abs(),
            1e-12,
        ),
        Check::new(
            "loads of +r and -r, difference",
            (one[0] / other[0] - 1.0).abs(),
            1e-12,
        ),
        Check::new(
            "roll moment of a level slider, of load x length",
            level[2].abs() / (level[0].abs() * LENGTH_M),
            1e-13,
        )
        .against(
            "100 sweeps of Gauss and Seidel from one side, 16 x 16 cells",
            naive::film::roll_of_a_level_slider(16, 100),
        ),
    ]
}

pub(super) fn c10() -> Vec<Check> {
    let slider = stepped();
    let mut skewed = [slider.clone(), slider.clone()];
    skewed[0].skew_rad = 30_f64.to_radians();
    skewed[1].skew_rad = -skewed[0].skew_rad;
    let [one, other] = skewed.each_ref().map(|slider| force(slider, 0.0, false));
    let mut behind = slider.clone();
    behind.skew_rad = std::f64::consts::PI;
    for (x, _, _) in &mut behind.recesses {
        *x = [1.0 - x[1], 1.0 - x[0]];
    }
    let (level, turned) = (force(&slider, 0.0, false), force(&behind, 0.0, true));
    let fixed_side = |turned: bool| naive::film::load_with_a_fixed_upwind_side(10.0, 64, turned);
    vec![
        Check::new(
            "skew of +30 and -30 degrees, loads",
            (one[0] / other[0] - 1.0).abs(),
            1e-12,
        ),
        Check::new(
            "the same, roll moments",
            (one[2] + other[2]).abs() / one[2].abs(),
            1e-12,
        ),
        Check::new(
            "wind from behind, load",
            (turned[0] / level[0] - 1.0).abs(),
            1e-12,
        )
        .against(
            "mass always taken from the leading side, 64 cells, bearing number 10",
            (fixed_side(true) / fixed_side(false) - 1.0).abs(),
        ),
        Check::new(
            "wind from behind, pitch moment",
            (turned[1] / level[1] + 1.0).abs(),
            1e-11,
        ),
    ]
}

pub(super) fn c11() -> Vec<Check> {
    // λ p_a of air; ψ over ten decades of inverse Knudsen numbers, across every range of the fit.
    let factor = FlowFactor::new(FlowModel::FukuiKaneko, 63.5e-9 * 101_325.0);
    // Relative to conductance over psi: the flow has a minimum, where its slope is zero.
    let (mut jump, mut slope) = (0.0_f64, 0.0_f64);
    let mut psi = 1e-6;
    while psi < 1e4 {
        let d = 1e-7 * psi;
        let [(below, _), (value, rate), (above, next)] =
            [psi - d, psi, psi + d].map(|p| factor.conductance(p));
        let scale = value / psi;
        jump = jump.max((rate - next).abs() / scale);
        slope = slope.max(((above - below) / (2.0 * d) - rate).abs() / scale);
        psi *= 1.003;
    }
    let (_, flight) = default_film(300);
    vec![
        Check::new(
            "jump of the slope of the flow, of flow over psi",
            jump,
            1e-5,
        )
        .against(
            "three-range fit as printed, of Q/D",
            naive::film::kinks_of_the_fit(),
        ),
        Check::new("slope against differences", slope, 1e-6),
        Check::new("Newton iterations to fly", flight.n_iterations as f64, 20.0),
    ]
}

pub(super) fn c12() -> Vec<Check> {
    let (film, flown) = default_film(500);
    let load = [2.2 * GRAM_FORCE_N, 0.0, 0.0];
    let touching = flown.attitude.centre_height_m - flown.min_clearance_m;
    let (mut apart, mut strayed) = (0.0_f64, 0.0_f64);
    for (centre_height_m, pitch_rad, roll_rad) in [
        (1e-5, 1e-4, 0.0),
        (touching + 1e-10, flown.attitude.pitch_rad, 0.0),
        (1e-7, -1e-4, 0.0),
        (1e-7, 1e-4, 1e-4),
    ] {
        let start = Attitude {
            centre_height_m,
            pitch_rad,
            roll_rad,
        };
        let reached = undamped(&film, load, start);
        strayed = strayed.max((reached / flown.min_clearance_m - 1.0).abs());
        let found = fly_from(&film, load, &start).map_or(f64::NAN, |flight| flight.min_clearance_m);
        let distance = (found / flown.min_clearance_m - 1.0).abs();
        apart = if distance.is_nan() {
            distance
        } else {
            apart.max(distance)
        };
    }
    vec![
        Check::new("flights from 10 um, 0.1 nm, wrong pitch, roll", apart, 1e-9).against(
            "Newton's method on the attitude without damping, at most 8 steps",
            strayed,
        ),
    ]
}

/// Clearance to which Newton's method on the attitude converges with full steps and difference quotients as
/// derivatives; infinite where it diverges.
fn undamped(film: &Film, load: [f64; 3], start: Attitude) -> f64 {
    let residual = |at: &[f64; 3]| {
        let attitude = Attitude {
            centre_height_m: at[0],
            pitch_rad: at[1],
            roll_rad: at[2],
        };
        let force = fixed_attitude(film, &attitude).ok()?.force;
        Some(Vector3::from_fn(|k, _| force[k] - load[k]))
    };
    let mut at = [start.centre_height_m, start.pitch_rad, start.roll_rad];
    for _ in 0..8 {
        let Some(miss) = residual(&at) else {
            return f64::INFINITY;
        };
        let mut slope = Matrix3::zeros();
        for (k, d) in [1e-11, 1e-8, 1e-8].into_iter().enumerate() {
            let mut beside = at;
            beside[k] += d;
            let Some(other) = residual(&beside) else {
                return f64::INFINITY;
            };
            slope.set_column(k, &((other - miss) / d));
        }
        let Some(step) = slope.lu().solve(&miss) else {
            return f64::INFINITY;
        };
        (0..3).for_each(|k| at[k] -= step[k]);
        if !at.iter().all(|v| v.abs() < 1e-2) {
            return f64::INFINITY;
        }
    }
    film.min_clearance(&Attitude {
        centre_height_m: at[0],
        pitch_rad: at[1],
        roll_rad: at[2],
    })
    .value_m
}
