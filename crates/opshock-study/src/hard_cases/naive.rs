//! Methods that were left for better ones, as short as they can be written: what they do to the
//! hard cases is measured with them.

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

/// Largest error of 100 impact times when a step that ends behind the stop is turned round there;
/// oscillator of period 1 on a stop at its rest position, `step` long steps.
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

/// Largest energy over start energy of a bar thrown at a wall under Newmark's rule (1/4, 1/2) with
/// the constraint on displacements; `ratio` is the step in element transit times. E 900, ρ 1, L 10,
/// 100 linear elements with consistent mass, gap 5, speed 10.
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

/// Depth after `steps` of a unit mass pushed onto a stop with acceleration `a`, when a contact is
/// bounced with restitution `e` at every node: it sinks for e < 1/2.
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

/// Depth after `steps` of resting contact when the velocity is set to zero at every node.
pub fn stopped_at_nodes(a: f64, step: f64, steps: usize) -> f64 {
    0.5 * a * step * step * steps as f64
}

/// Time that event-driven bounces of a ball from 1 m reach with `impacts` impacts, s.
pub fn event_driven_time(e: f64, impacts: i32) -> f64 {
    let first = (2.0 / 9.81_f64).sqrt();
    // Flights of 2 e^k first.
    (1..=impacts).fold(first, |t, k| t + 2.0 * first * e.powi(k))
}

/// Load and peak errors of the exact slider H = 2 − x, Kn = 0 on `n` equal cells by central
/// differences in P, Newton's method from P = 1.
pub fn central_slider(bearing_number: f64, n: usize, load: f64, peak: f64) -> (f64, f64) {
    let d = 1.0 / n as f64;
    let height = |x: f64| 2.0 - x;
    let mut p = vec![1.0; n + 1];
    // Continuation in the bearing number keeps Newton on the branch.
    for part in 1..=20 {
        let lambda = bearing_number * f64::from(part) / 20.0;
        for _ in 0..30 {
            let mut rows = vec![[0.0; 3]; n - 1];
            let mut rhs = vec![0.0; n - 1];
            for i in 1..n {
                let x = i as f64 * d;
                let (west, east) = (height(x - 0.5 * d).powi(3), height(x + 0.5 * d).powi(3));
                let flux = |a: f64, b: f64, cube: f64| cube * 0.5 * (b * b - a * a) / d;
                let wind = 0.5 * lambda * (p[i + 1] * height(x + d) - p[i - 1] * height(x - d));
                rhs[i - 1] = flux(p[i], p[i + 1], east) - flux(p[i - 1], p[i], west) - wind;
                rows[i - 1] = [
                    west * p[i - 1] / d + 0.5 * lambda * height(x - d),
                    -(west + east) * p[i] / d,
                    east * p[i + 1] / d - 0.5 * lambda * height(x + d),
                ];
            }
            let delta = tridiagonal(&mut rows, &mut rhs);
            let size = delta.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
            p[1..n].iter_mut().zip(delta).for_each(|(p, d)| *p -= d);
            if size < 1e-12 {
                break;
            }
        }
    }
    let sum: f64 = p.windows(2).map(|w| 0.5 * (w[0] + w[1]) - 1.0).sum();
    let most = p.iter().copied().fold(0.0, f64::max);
    ((sum * d / load - 1.0).abs(), (most / peak - 1.0).abs())
}

/// Solves a tridiagonal system of rows [lower, diagonal, upper] in place.
fn tridiagonal<'a>(rows: &mut [[f64; 3]], rhs: &'a mut [f64]) -> &'a [f64] {
    for i in 1..rows.len() {
        let factor = rows[i][0] / rows[i - 1][1];
        rows[i][1] -= factor * rows[i - 1][2];
        rhs[i] -= factor * rhs[i - 1];
    }
    for i in (0..rows.len()).rev() {
        let right = if i + 1 < rows.len() {
            rows[i][2] * rhs[i + 1]
        } else {
            0.0
        };
        rhs[i] = (rhs[i] - right) / rows[i][1];
    }
    rhs
}

/// Largest pull, N s in a step of `step` s, of a stop that holds a mode of 1 kg at 1 kHz on itself
/// by an equation, whichever way a force of 1 N at 100 Hz points: what holds it is minus the force.
pub fn held_by_an_equation(step: f64) -> f64 {
    let force = |t: f64| (std::f64::consts::TAU * 100.0 * t).sin();
    (0..10_000)
        .map(|k| step * force(f64::from(k) * step))
        .fold(0.0, f64::max)
}

/// Aitken's factor ω r₀ / (r₀ − r₁) as printed, for two equal residuals and for residuals of zero.
pub fn aitken_as_printed() -> [f64; 2] {
    [1.0_f64, 0.0].map(|residual| {
        let (before, now) = (residual, residual);
        -0.5 * before / (now - before)
    })
}

/// A clearance as a verdict: whether it is below zero.
pub fn is_below_zero(clearance: f64) -> bool {
    clearance < 0.0
}

/// Critical amplitude by bisection that takes the ends of its range for a survivor and a failure.
pub fn bisected(low: f64, high: f64, fails: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    while high / low > 1.01 {
        let middle = (low * high).sqrt();
        if fails(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}

/// Q_P of Fukui and Kaneko's fit for D < 0.15, at any D (1990, table 1).
pub fn thin_gap_fit(d: f64) -> f64 {
    -2.229_19 * d + 2.106_73 + 0.016_53 / d - 0.000_069_4 / (d * d)
}
