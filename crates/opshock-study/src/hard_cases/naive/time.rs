//! Naive time stepping: pulses, modes, running sums.

/// ω² x(t) under a unit half-sine by the closed form, which divides by 1 − r².
pub fn closed_form(omega: f64, width_s: f64, t_s: f64) -> f64 {
    let p = std::f64::consts::PI / width_s;
    let r = p / omega;
    ((p * t_s).sin() - r * (omega * t_s).sin()) / (1.0 - r * r)
}

/// |x − 1| of a stiff mode, ω Δt = `angle`, pushed to 1 from rest by the trapezoidal rule.
pub fn trapezoidal_ringing(angle: f64, steps: usize) -> f64 {
    let (mut x, mut v) = (-1.0, 0.0);
    let quarter = 0.25 * angle * angle;
    for _ in 0..steps {
        let next = ((1.0 - quarter) * x + v) / (1.0 + quarter);
        v -= 0.5 * angle * angle * (x + next);
        x = next;
    }
    f64::abs(x)
}

/// Growth of the energy of an oscillator under explicit Euler, ω Δt = `angle`.
pub fn euler_energy_gain(angle: f64, steps: i32) -> f64 {
    (1.0 + angle * angle).powi(steps) - 1.0
}

/// Velocity, of 2 A T/π, that a half-sine of `width_s` leaves when its load is taken at the ends of
/// steps of `step_s`; the pulse starts in the middle of a step.
pub fn sampled_impulse(width_s: f64, step_s: f64) -> f64 {
    let pulse = |t: f64| {
        let inside = (0.0..=width_s).contains(&t);
        (std::f64::consts::PI * t / width_s).sin() * f64::from(u8::from(inside))
    };
    let sum: f64 = (0..10).map(|k| pulse((f64::from(k) - 0.5) * step_s)).sum();
    0.5 * std::f64::consts::PI * sum * step_s / width_s
}

/// Growth, 1/s, that implicit Euler gives to motion e^(λ t), λ = growth + i ω, in steps of `step_s`.
pub fn implicit_euler_growth(growth_per_s: f64, omega: f64, step_s: f64) -> f64 {
    let (re, im) = (1.0 - growth_per_s * step_s, -omega * step_s);
    let size = f64::hypot(re, im);
    let steps = 1000;
    let left = (0..steps).fold(1.0, |amplitude: f64, _| amplitude / size);
    left.ln() / (f64::from(steps) * step_s)
}

/// Largest energy over start energy of an oscillator with initial velocity from its rest position, ω Δt = `angle`,
/// under explicit central differences in `steps` steps.
pub fn central_differences_gain(angle: f64, steps: usize) -> f64 {
    let (mut x, mut v) = (0.0_f64, 1.0_f64);
    let mut most = 0.0_f64;
    for _ in 0..steps {
        v -= angle * x;
        x += angle * v;
        most = most.max(x * x + v * v);
    }
    most
}

/// Number of the `steps` points in time at which a free mode at 1150 Hz has other bits when every step of 0.5 μs is
/// made as two halves.
pub fn nodes_moved_by_half_steps(steps: usize) -> usize {
    let turn = |h: f64| (std::f64::consts::TAU * 1150.0 * h).sin_cos();
    let step = |(x, v): (f64, f64), (s, c): (f64, f64)| (c * x + s * v, c * v - s * x);
    let (whole, half) = (turn(0.5e-6), turn(0.25e-6));
    let (mut one, mut two) = ((1e-4, 0.0), (1e-4, 0.0));
    (0..steps)
        .filter(|_| {
            one = step(one, whole);
            two = step(step(two, half), half);
            one.0.to_bits() != two.0.to_bits()
        })
        .count()
}

/// Displacement of a free mode at 1150 Hz at the end of the steps between `times_s`.
pub fn marched_over(times_s: &[f64]) -> f64 {
    let omega = std::f64::consts::TAU * 1150.0;
    let steps = times_s.windows(2).map(|w| w[1] - w[0]);
    let turned = steps.fold((1e-4, 0.0), |(x, v), h| {
        let (s, c) = (omega * h).sin_cos();
        (c * x + s * v, c * v - s * x)
    });
    turned.0
}

/// A number with everything below the smallest normal number put to zero.
pub fn flushed(x: f64) -> f64 {
    if x.abs() < f64::MIN_POSITIVE { 0.0 } else { x }
}
