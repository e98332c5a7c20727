//! Known failures of partitioned coupling, tested on maps with known fixed points.

use super::*;

const METHODS: [Method; 3] = [Method::Plain, Method::Aitken, Method::Anderson { depth: 3 }];

/// Slider on a film spring, trapezoidal rule: q = q* − (k Δt²/4m) F-feedback.
fn film_map(dt_s: f64) -> impl Fn(&[f64], &mut [f64]) -> bool {
    let slope = -1e6 * dt_s * dt_s / (4.0 * 0.6e-6);
    move |x, image| {
        image[0] = 3e-9 + slope * (x[0] - 1e-9);
        true
    }
}

fn film_answer(dt_s: f64) -> f64 {
    let slope = -1e6 * dt_s * dt_s / (4.0 * 0.6e-6);
    (3e-9 - slope * 1e-9) / (1.0 - slope)
}

#[test]
fn hard_d1_stiff_film_and_light_slider() {
    for dt in [0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6] {
        for method in [Method::Aitken, Method::Anderson { depth: 3 }] {
            let mut x = [0.0];
            let ending = FixedPoint::new(method, 1).solve(&mut x, &[1e-20], 8, film_map(dt));
            assert!(
                matches!(ending, Ending::Converged { .. }),
                "{method:?} at {dt}: {ending:?}"
            );
            assert!((x[0] / film_answer(dt) - 1.0).abs() < 1e-10);
        }
    }
    // The failure without the remedy: the plain iteration diverges once k Δt²/4m > 1.
    for (dt, converges) in [(0.5e-6, true), (1e-6, true), (2e-6, false), (10e-6, false)] {
        let ending =
            FixedPoint::new(Method::Plain, 1).solve(&mut [0.0], &[1e-18], 60, film_map(dt));
        assert_eq!(
            matches!(ending, Ending::Converged { .. }),
            converges,
            "{dt}: {ending:?}"
        );
    }
}

#[test]
fn hard_d2_equal_residuals_and_zero_residual() {
    for method in METHODS {
        // H(x) = x + 1: every residual is 1, no secant exists, nothing may become NaN.
        let mut x = [0.0, 0.0];
        let ending = FixedPoint::new(method, 2).solve(&mut x, &[1e-3; 2], 5, |x, image| {
            image[0] = x[0] + 1.0;
            image[1] = x[1];
            true
        });
        assert!(
            matches!(ending, Ending::NotConverged { iterations: 5, .. }),
            "{method:?}"
        );
        assert!(x.iter().all(|v| v.is_finite()));
        let mut x = [2.0, 3.0];
        let ending = FixedPoint::new(method, 2).solve(&mut x, &[1e-3; 2], 5, |x, image| {
            image.copy_from_slice(x);
            true
        });
        assert_eq!(
            ending,
            Ending::Converged {
                iterations: 1,
                residual: 0.0
            }
        );
        assert_eq!(x, [2.0, 3.0]);
    }
}

#[test]
fn hard_d3_all_zero_start_is_accepted() {
    for method in METHODS {
        let ending = FixedPoint::new(method, 3).solve(&mut [0.0; 3], &[1e-12; 3], 3, |_, image| {
            image.fill(0.0);
            true
        });
        assert_eq!(
            ending,
            Ending::Converged {
                iterations: 1,
                residual: 0.0
            }
        );
    }
}

/// A map whose relaxed change shrinks quickly while the residual stays: not convergence.
#[test]
fn hard_d4_stall_is_not_convergence() {
    let mut sign = 1.0;
    let ending = FixedPoint::new(Method::Aitken, 1).solve(&mut [0.0], &[1e-6], 30, |x, image| {
        sign = -sign;
        image[0] = x[0] + sign;
        true
    });
    assert!(matches!(ending, Ending::NotConverged { residual, .. } if residual > 1e5));
}

#[test]
fn hard_d5_cap_and_breakdown_are_reported() {
    let mut x = [0.3];
    let ending = FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-300], 4, |x, image| {
        image[0] = x[0].cos();
        true
    });
    assert!(matches!(ending, Ending::NotConverged { iterations: 4, .. }));
    let broken = FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-9], 4, |_, image| {
        image[0] = f64::NAN;
        true
    });
    assert_eq!(broken, Ending::Broken { iterations: 1 });
    let failed = FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-9], 4, |_, _| false);
    assert_eq!(failed, Ending::Broken { iterations: 1 });
}

/// Nanometres beside microradians: both components reach their own tolerance.
#[test]
fn hard_d6_components_converge_to_their_own_tolerance() {
    let (gap, pitch) = (4e-9, 110e-6);
    let tolerance = [1e-13, 1e-9];
    for method in METHODS {
        let mut x = [0.0, 0.0];
        let ending = FixedPoint::new(method, 2).solve(&mut x, &tolerance, 60, |x, image| {
            let (a, b) = (x[0] - gap, x[1] - pitch);
            image[0] = gap - 0.4 * a + 1e-5 * b;
            image[1] = pitch + 2e3 * a + 0.3 * b;
            true
        });
        assert!(
            matches!(ending, Ending::Converged { .. }),
            "{method:?}: {ending:?}"
        );
        assert!((x[0] - gap).abs() < 3.0 * tolerance[0], "{method:?}");
        assert!((x[1] - pitch).abs() < 3.0 * tolerance[1], "{method:?}");
    }
}

#[test]
fn anderson_is_exact_after_n_plus_one_steps_of_a_linear_map() {
    let matrix = [[-3.0, 1.0, 0.5], [0.2, -8.0, 1.0], [0.4, 0.3, 2.5]];
    let ending = FixedPoint::new(Method::Anderson { depth: 3 }, 3).solve(
        &mut [1.0, 2.0, 3.0],
        &[1e-9; 3],
        6,
        |x, image| {
            for (out, row) in image.iter_mut().zip(matrix) {
                *out = 1.0 + row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
            }
            true
        },
    );
    assert!(
        matches!(
            ending,
            Ending::Converged {
                iterations: ..=5,
                ..
            }
        ),
        "{ending:?}"
    );
}
