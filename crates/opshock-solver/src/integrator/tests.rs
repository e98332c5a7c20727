//! Order, stability and step control on linear problems with known solutions.

use super::*;

/// y' = J (y − g(t)) + g'(t) with a full 2 × 2 Jacobian, g known: solution g for any stiffness.
struct Linear {
    jacobian: [[f64; 2]; 2],
    forced: bool,
}

impl Linear {
    fn target(&self, t: f64) -> ([f64; 2], [f64; 2]) {
        if self.forced {
            (
                [t.sin(), (0.7 * t).cos()],
                [t.cos(), -0.7 * (0.7 * t).sin()],
            )
        } else {
            ([0.0; 2], [0.0; 2])
        }
    }

    fn solve(&self, d: f64, rhs: [f64; 2]) -> [f64; 2] {
        let j = self.jacobian;
        let a = [
            [1.0 - d * j[0][0], -d * j[0][1]],
            [-d * j[1][0], 1.0 - d * j[1][1]],
        ];
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        [
            (a[1][1] * rhs[0] - a[0][1] * rhs[1]) / det,
            (a[0][0] * rhs[1] - a[1][0] * rhs[0]) / det,
        ]
    }
}

impl StageSystem for Linear {
    type Failure = ();

    fn solve_stage(&mut self, t: f64, d: f64, known: &[f64], y: &mut [f64]) -> Result<(), ()> {
        let (g, rate) = self.target(t);
        let j = self.jacobian;
        let rhs: [f64; 2] =
            std::array::from_fn(|i| known[i] + d * (rate[i] - j[i][0] * g[0] - j[i][1] * g[1]));
        y.copy_from_slice(&self.solve(d, rhs));
        Ok(())
    }

    fn filter(&mut self, d: f64, error: &mut [f64]) {
        let filtered = self.solve(d, [error[0], error[1]]);
        error.copy_from_slice(&filtered);
    }
}

/// End error and largest error estimate of `n` equal steps over [0, 2] from the exact start.
fn run(table: Tableau, jacobian: [[f64; 2]; 2], n: usize) -> (f64, f64) {
    let mut system = Linear {
        jacobian,
        forced: true,
    };
    let mut stepper = Stepper::new(table, 2);
    let (g, rate) = system.target(0.0);
    let (mut y, mut k) = (g.to_vec(), rate.to_vec());
    let dt = 2.0 / n as f64;
    let mut estimate: f64 = 0.0;
    for step in 0..n {
        stepper
            .step(&mut system, step as f64 * dt, dt, &y, &k)
            .unwrap();
        y.copy_from_slice(stepper.value());
        k.copy_from_slice(stepper.rate());
        estimate = stepper.error().iter().fold(estimate, |m, e| m.max(e.abs()));
    }
    let (g, _) = system.target(2.0);
    ((y[0] - g[0]).hypot(y[1] - g[1]), estimate)
}

#[test]
fn order_of_every_scheme_on_a_smooth_problem() {
    for table in [TR_BDF2, ESDIRK3] {
        let mild = [[-1.0, 2.0], [-2.0, -0.5]];
        let (coarse, coarse_estimate) = run(table, mild, 40);
        let (fine, fine_estimate) = run(table, mild, 320);
        let rate = (coarse / fine).log2() / 3.0;
        assert!(
            rate > f64::from(table.order) - 0.1,
            "{}: {rate}",
            table.name
        );
        let rate = (coarse_estimate / fine_estimate).log2() / 3.0;
        assert!(
            rate > f64::from(table.error_order) - 0.1,
            "{} estimate: {rate}",
            table.name
        );
    }
}

/// With λΔt between 10³ and 10⁶ the error must still fall with at least the second order (both
/// schemes have stage order two), and must be far below that of a scheme that rings.
#[test]
fn stiff_relaxation_keeps_second_order() {
    for table in [TR_BDF2, ESDIRK3] {
        let stiff = [[-1e7, 3e6], [0.0, -1.0]];
        let (coarse, _) = run(table, stiff, 20);
        let (fine, _) = run(table, stiff, 160);
        let rate = (coarse / fine).log2() / 3.0;
        assert!(rate > 1.9, "{}: {rate}", table.name);
        assert!(fine < 1e-4);
    }
}

#[test]
fn one_step_forgets_an_infinitely_stiff_transient() {
    for table in [TR_BDF2, ESDIRK3] {
        for stiffness in [1e3, 1e6, 1e9] {
            let jacobian = [[0.0, 1.0], [-stiffness * stiffness, -0.01 * stiffness]];
            let mut system = Linear {
                jacobian,
                forced: false,
            };
            let mut stepper = Stepper::new(table, 2);
            // A lightly damped oscillator 10³ to 10⁹ times faster than the step, displaced by 1.
            let y = [1.0, 0.0];
            let rate = [0.0, -stiffness * stiffness];
            stepper.step(&mut system, 0.0, 1.0, &y, &rate).unwrap();
            let (y, rate) = (stepper.value().to_vec(), stepper.rate().to_vec());
            stepper.step(&mut system, 1.0, 1.0, &y, &rate).unwrap();
            let left = stepper.value()[0].abs();
            assert!(
                left < 30.0 / stiffness,
                "{} at {stiffness}: {left}",
                table.name
            );
        }
    }
}

#[test]
fn weights_satisfy_the_order_conditions() {
    for table in [TR_BDF2, ESDIRK3] {
        let s = table.n_stages();
        let mut b: Vec<f64> = table.a[s - 1].to_vec();
        b.push(table.gamma);
        let companion: Vec<f64> = b
            .iter()
            .zip(table.error_weights)
            .map(|(b, e)| b + e)
            .collect();
        for (weights, order) in [(&b, table.order), (&companion, 5 - table.order)] {
            for power in 0..order {
                let sum: f64 = weights
                    .iter()
                    .zip(table.c)
                    .map(|(w, c)| w * c.powi(power as i32))
                    .sum();
                let wanted = 1.0 / f64::from(power + 1);
                assert!(
                    (sum - wanted).abs() < 1e-12,
                    "{} c^{power}: {sum}",
                    table.name
                );
            }
        }
        for i in 1..s {
            let sum: f64 = table.a[i].iter().sum::<f64>() + table.gamma;
            assert!((sum - table.c[i]).abs() < 1e-12, "{} row {i}", table.name);
        }
    }
}

#[test]
fn hermite_finds_the_minimum_and_the_crossing_of_a_parabola() {
    // y = 1 - 4 t + 3 t² on a step of 2 (t = 2 θ): minimum at t = 2/3, value -1/3; zero at 1/3.
    let (y, rate) = ([1.0, 5.0], [-4.0, 8.0]);
    let cubic = |theta: f64| hermite::value(theta, 2.0, y, rate);
    let (theta, value) = hermite::minimum(4, cubic);
    assert!((theta - 1.0 / 3.0).abs() < 1e-6);
    assert!((value + 1.0 / 3.0).abs() < 1e-12);
    let theta = hermite::first_below_zero(2, Some(theta), cubic).unwrap();
    assert!((theta - 1.0 / 6.0).abs() < 1e-9);
    assert!(hermite::first_below_zero(4, None, |_| 1.0).is_none());
}

#[test]
fn steps_are_terms_of_a_geometric_series_within_bounds() {
    let mut control = StepControl::new(3, 1e-12, 1e-5);
    assert_eq!(control.of_series(1.0), 1e-5);
    assert_eq!(control.after_accept(1e-6, 0.6), 1e-6);
    let grown = control.after_accept(1e-6, 1e-3);
    assert!(grown > 2e-6 && (control.of_series(grown) / grown - 1.0).abs() < 1e-9);
    assert!(control.after_reject(1e-6, 8.0) < 0.6e-6);
    assert!(control.after_reject(1e-6, f64::NAN) < 0.3e-6);
    assert_eq!(control.after_failure(1e-12), 1e-12);
}
