//! Squeeze films against closed solutions of the linearised Reynolds equation: square plate and
//! strip, stiffness and damping over the squeeze number.

use opshock_solver::air_bearing::FlowModel;
use opshock_solver::air_bearing::impedance::SmallMotion;
use opshock_tests::digests::assert_digest;
use opshock_tests::films::{
    AMBIENT_PA, LENGTH_M, PlaneSlider, TRAILING_M, VISCOSITY_PA_S, crowded_twice, uniform,
};
use opshock_tests::sheet::at_most;
use opshock_tests::{number, reference};

/// Z h/(p_a A) of a parallel plate at the squeeze number σ = 12 μ ω L²/(p_a h²).
fn squeeze(lines: &[f64], across: &[f64], width: f64, sigma: f64) -> [f64; 2] {
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
    let z = SmallMotion::new(&film, &psi, &attitude)
        .impedance(omega / std::f64::consts::TAU)
        .unwrap()[(0, 0)];
    let scale = TRAILING_M / (AMBIENT_PA * width * LENGTH_M * LENGTH_M);
    [z.re * scale, z.im * scale]
}

#[test]
fn square_plate_follows_the_series_solution() {
    let data = reference("squeeze_film.json");
    let mut all = Vec::new();
    for case in data
        .as_array()
        .unwrap_or_else(|| data["cases"].as_array().unwrap())
    {
        if case["plate"] != "square" {
            continue;
        }
        let sigma = number(&case["sigma"]);
        let expected = [number(&case["k_analytic"]), number(&case["c_analytic"])];
        let [coarse, fine] = [24, 48].map(|n| {
            let lines = crowded_twice(n);
            squeeze(&lines, &lines, 1.0, sigma)
        });
        all.extend(coarse.into_iter().chain(fine));
        for part in 0..2 {
            let found = (4.0 * fine[part] - coarse[part]) / 3.0;
            let error = (found / expected[part] - 1.0).abs();
            at_most(
                "squeeze-film-square",
                [
                    "relative error of the stiffness",
                    "relative error of the damping",
                ][part],
                error,
                1e-3,
            );
        }
    }
    assert_digest("reference squeeze_film", &all);
}

/// −Re and −Im of W/h for a strip: (1 − tanh(s/2)/(s/2)), s = sqrt(i σ), to 1e-6 in both parts.
///
/// The strip is a plate 2e6 times as wide as long; what its two ends do not carry is taken off by
/// comparing two widths.
#[test]
fn strip_follows_its_closed_form() {
    for (sigma, stiffness, damping) in [
        (0.1, 0.000_083_324_8, 0.008_332_490_2),
        (1.0, 0.008_248_773_7, 0.082_498_646_9),
        (10.0, 0.411_793_699_6, 0.417_175_356_9),
        (100.0, 0.858_578_004_6, 0.141_081_830_0),
        (1000.0, 0.955_278_640_4, 0.044_721_359_6),
    ] {
        let value = |n: usize| {
            let lines = crowded_twice(n);
            // Rows of one width in both: only the number of inner rows differs.
            let three = squeeze(&lines, &uniform(3, 3e6), 3e6, sigma);
            let four = squeeze(&lines, &uniform(4, 4e6), 4e6, sigma);
            [
                4.0 * four[0] - 3.0 * three[0],
                4.0 * four[1] - 3.0 * three[1],
            ]
        };
        let [a, b, c] = [100, 200, 400].map(value);
        for (part, expected) in [stiffness, damping].into_iter().enumerate() {
            let first = (4.0 * b[part] - a[part]) / 3.0;
            let second = (4.0 * c[part] - b[part]) / 3.0;
            let found = (16.0 * second - first) / 15.0;
            let size = f64::hypot(stiffness, damping);
            at_most(
                "squeeze-film-strip",
                [
                    "error of the stiffness, of |Z|",
                    "error of the damping, of |Z|",
                ][part],
                (found - expected).abs() / size,
                1e-6,
            );
        }
    }
}
