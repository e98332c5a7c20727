//! Naive methods for contact: impacts, resting, restraints on two sides.

/// Largest error of 100 impact times when the velocity is reversed in a step that ends behind the stop; oscillator of
/// period 1 on a stop at its rest position, `step` long steps.
pub fn impacts_at_step_ends(step: f64) -> f64 {
    let omega = std::f64::consts::TAU;
    let (sine, cosine) = (omega * step).sin_cos();
    let (mut x, mut v) = (0.0_f64, 1.0_f64);
    let (mut worst, mut impacts, mut k) = (0.0_f64, 0, 0_i32);
    while impacts < 100 {
        (x, v) = (x * cosine + v / omega * sine, v * cosine - x * omega * sine);
        k += 1;
        if x < 0.0 && v < 0.0 {
            v = -v;
            impacts += 1;
            let time = f64::from(k) * step;
            worst = worst.max((time - 0.5 * f64::from(impacts)).abs());
        }
    }
    worst
}

/// Energy after over energy before of a mass on springs that meets a stiff stop, by explicit
/// central differences with `step` (s): 100 kg, 10 kN/m, stop 1 MN/m, 1 m/s.
pub fn penalty_energy_gain(step: f64) -> f64 {
    let (mass, spring, stop) = (100.0, 1e4, 1e6);
    let force = |u: f64| spring * u + if u > 0.0 { stop * u } else { 0.0 };
    let (mut u, mut v) = (0.0_f64, 1.0_f64);
    v -= 0.5 * step * force(u) / mass;
    let mut most = 0.0_f64;
    for _ in 0..(0.2 / step) as usize {
        u += step * v;
        let next = v - step * force(u) / mass;
        let middle = 0.5 * (v + next);
        let elastic = 0.5 * spring * u * u + if u > 0.0 { 0.5 * stop * u * u } else { 0.0 };
        most = most.max(0.5 * mass * middle * middle + elastic);
        v = next;
    }
    most / (0.5 * mass)
}

/// Largest energy over start energy of an elastic bar moving against a wall under Newmark's rule (1/4, 1/2) with the
/// constraint on displacements; `ratio` is the step in element transit times. E 900, ρ 1, L 10, 100 linear elements
/// with consistent mass, gap 5, speed 10.
pub fn newmark_bar_energy(ratio: f64) -> f64 {
    let (n, l) = (101, 0.1);
    let step = ratio * l / 30.0;
    let (k, m) = (900.0 / l, l / 6.0);
    // Tridiagonal M and K of the free bar: diagonal and off-diagonal.
    let end = |i: usize| i == 0 || i == n - 1;
    let mass = |i: usize| if end(i) { 2.0 * m } else { 4.0 * m };
    let stiff = |i: usize| if end(i) { k } else { 2.0 * k };
    let apply = |diagonal: &dyn Fn(usize) -> f64, off: f64, x: &[f64]| -> Vec<f64> {
        (0..n)
            .map(|i| {
                let left = if i > 0 { off * x[i - 1] } else { 0.0 };
                let right = if i + 1 < n { off * x[i + 1] } else { 0.0 };
                left + diagonal(i) * x[i] + right
            })
            .collect()
    };
    let beta = 0.25 * step * step;
    let solve = |rhs: &[f64]| thomas(n, |i| mass(i) + beta * stiff(i), m - beta * k, rhs);
    let mut unit = vec![0.0; n];
    unit[0] = 1.0;
    let reach = solve(&unit);
    let (mut u, mut v, mut a) = (vec![0.0; n], vec![-10.0; n], vec![0.0; n]);
    let start = 0.5 * 10.0 * 100.0;
    let mut most = 1.0_f64;
    for _ in 0..(2.0 / step) as usize {
        let guess: Vec<f64> = (0..n).map(|i| u[i] + step * v[i] + beta * a[i]).collect();
        let force: Vec<f64> = apply(&stiff, -k, &guess).iter().map(|f| -f).collect();
        let mut next = solve(&force);
        // Wall 5 below: the contact force that puts the end on it.
        let below = -5.0 - (guess[0] + beta * next[0]);
        if below > 0.0 {
            let p = below / (beta * reach[0]);
            next.iter_mut().zip(&reach).for_each(|(a, r)| *a += p * r);
        }
        for i in 0..n {
            u[i] = guess[i] + beta * next[i];
            v[i] += 0.5 * step * (a[i] + next[i]);
        }
        a = next;
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let energy = 0.5 * (dot(&v, &apply(&mass, m, &v)) + dot(&u, &apply(&stiff, -k, &u)));
        most = most.max(energy / start);
    }
    most
}

/// Solves a symmetric tridiagonal system with one off-diagonal value.
fn thomas(n: usize, diagonal: impl Fn(usize) -> f64, off: f64, rhs: &[f64]) -> Vec<f64> {
    let (mut upper, mut x) = (vec![0.0; n], rhs.to_vec());
    let mut pivot = diagonal(0);
    x[0] /= pivot;
    for i in 1..n {
        upper[i - 1] = off / pivot;
        pivot = diagonal(i) - off * upper[i - 1];
        x[i] = (x[i] - off * x[i - 1]) / pivot;
    }
    for i in (0..n - 1).rev() {
        x[i] -= upper[i] * x[i + 1];
    }
    x
}

/// Depth after `steps` of a unit mass pushed onto a stop with acceleration `a`, when the velocity is reversed with
/// restitution `e` at every time step: it sinks for e < 1/2.
pub fn bounced_at_nodes(a: f64, e: f64, step: f64, steps: usize) -> f64 {
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        if x <= 0.0 && v < 0.0 {
            v *= -e;
        }
        x += step * v - 0.5 * a * step * step;
        v -= a * step;
    }
    (-x).max(0.0)
}

/// Depth after `steps` of resting contact when the velocity is set to zero at every time step.
pub fn stopped_at_nodes(a: f64, step: f64, steps: usize) -> f64 {
    0.5 * a * step * step * steps as f64
}

/// Time reached by an event-driven simulation of a ball dropped from 1 m after `impacts` impacts, s.
pub fn event_driven_time(e: f64, impacts: i32) -> f64 {
    let first = (2.0 / 9.81_f64).sqrt();
    // Times between impacts of 2 e^k first.
    (1..=impacts).fold(first, |t, k| t + 2.0 * first * e.powi(k))
}

/// Largest pull, N s in a step of `step` s, of a stop to which an equation ties a mode of 1 kg at 1 kHz, under a force of
/// 1 N at 100 Hz: the tie's force is the opposite of that force, of either sign.
pub fn held_by_an_equation(step: f64) -> f64 {
    let force = |t: f64| (std::f64::consts::TAU * 100.0 * t).sin();
    (0..10_000)
        .map(|k| step * force(f64::from(k) * step))
        .fold(0.0, f64::max)
}

/// Variation of the force over that of a rise and a fall, when a mode of 1 kg at 1 kHz, 1 μm from a
/// stop, is pushed onto it by a half-sine of 40 ms: Newmark's rule (1/4, 1/2) with the stop as a
/// condition on displacements, steps of 2 μs.
pub fn leaning_under_newmark() -> f64 {
    let (h, omega, gap) = (2e-6, std::f64::consts::TAU * 1000.0, 1e-6);
    let beta = 0.25 * h * h;
    let inertia = 1.0 + beta * omega * omega;
    let (mut u, mut v, mut a) = (0.0, 0.0, 0.0);
    let (mut last, mut variation, mut peak) = (0.0_f64, 0.0_f64, 0.0_f64);
    for k in 1..=20_000 {
        let push = 800.0 * (std::f64::consts::PI * f64::from(k) / 20_000.0).sin();
        let guess = u + h * v + beta * a;
        let mut next = (push - omega * omega * guess) / inertia;
        // The force that keeps the end of the step in front of the stop.
        let force = ((guess + beta * next - gap) * inertia / beta).max(0.0);
        next -= force / inertia;
        (u, v, a) = (guess + beta * next, v + 0.5 * h * (a + next), next);
        variation += (force - last).abs();
        peak = peak.max(force);
        last = force;
    }
    variation / (2.0 * peak)
}

/// Impulses on a disk of mobility `disk` held at rest between two rigid arms, from one equation an
/// arm and by elimination: the rows are each other's negative.
pub fn held_from_both_sides(disk: f64, closing: f64) -> [f64; 2] {
    let (row, below) = ([disk, -disk, closing], [-disk, disk, -closing]);
    let factor = below[0] / row[0];
    let left: [f64; 3] = std::array::from_fn(|k| below[k] - factor * row[k]);
    let bottom = left[2] / left[1];
    [(row[2] - row[1] * bottom) / disk, bottom]
}

/// Impulses of both arms by one sweep, top before bottom: mobilities of disk and arms, closing speeds.
pub fn one_after_the_other(disk: f64, arm: f64, closing: [f64; 2]) -> [f64; 2] {
    let top = (closing[0] / (disk + arm)).max(0.0);
    // The impulse of the top arm drives the disk into the bottom one.
    let bottom = ((closing[1] + disk * top) / (disk + arm)).max(0.0);
    [top, bottom]
}
