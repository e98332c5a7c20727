//! Naive schemes and fits for films, which the air bearing does not use.

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

/// Q_P of Fukui and Kaneko's fit for D < 0.15, at any D (1990, table 1).
pub fn thin_gap_fit(d: f64) -> f64 {
    -2.229_19 * d + 2.106_73 + 0.016_53 / d - 0.000_069_4 / (d * d)
}

/// Q_P of Fukui and Kaneko's three-range fit as printed (1990, table 1).
pub fn three_range_fit(d: f64) -> f64 {
    if d < 0.15 {
        thin_gap_fit(d)
    } else if d < 5.0 {
        0.138_52 * d + 1.250_87 + 0.156_53 / d - 0.009_69 / (d * d)
    } else {
        d / 6.0 + 1.016_2 + 1.065_3 / d - 2.135_4 / (d * d)
    }
}

/// Largest jump of the slope of [`three_range_fit`] at the ends of its ranges, of Q/D.
pub fn kinks_of_the_fit() -> f64 {
    let q = three_range_fit;
    [0.15, 5.0].into_iter().fold(0.0, |most: f64, d| {
        let near = 1e-5 * d;
        let (below, above) = (d - 1e-3 * near, d + 1e-3 * near);
        let slopes = [
            (q(below) - q(below - near)) / near,
            (q(above + near) - q(above)) / near,
        ];
        most.max((slopes[1] - slopes[0]).abs() * d / q(d))
    })
}

/// Flow of a free-molecular gas at a gap, −ln D/√π, without a check of the gap's sign.
pub fn free_molecular_flow(d: f64) -> f64 {
    -d.ln() / std::f64::consts::PI.sqrt()
}

/// Pressure, Pa above ambient, in the middle of a strip of an incompressible film that opens:
/// −3/2 μ v L²/h³.
pub fn incompressible_suction(viscosity: f64, velocity: f64, length: f64, gap: f64) -> f64 {
    -1.5 * viscosity * velocity * length * length / gap.powi(3)
}

/// Load of a one-dimensional incompressible slider, in units of 6 μ U L/h², on `n` equal cells with
/// the height looked up at the grid lines: 2 up to `edge`, 1 behind it.
pub fn step_looked_up_at_lines(n: usize, edge: f64) -> f64 {
    let d = 1.0 / n as f64;
    // Between cell centres; half a cell at the ends.
    let faces: Vec<(f64, f64)> = (0..=n)
        .map(|i| {
            let height = if i as f64 * d < edge { 2.0 } else { 1.0 };
            (height, if i == 0 || i == n { 0.5 * d } else { d })
        })
        .collect();
    let sum = |power: i32| -> f64 { faces.iter().map(|(h, w)| w / h.powi(power)).sum() };
    let flow = sum(2) / sum(3);
    let mut pressure = 0.0;
    let mut load = 0.0;
    for (h, w) in &faces[..n] {
        pressure += w * (1.0 / h.powi(2) - flow / h.powi(3));
        load += d * pressure;
    }
    load
}

/// Roll moment, of load × width, of a level incompressible slider H = 2 − x on `n` × `n` cells after
/// `sweeps` of Gauss and Seidel's method from ambient pressure, always from the inner side.
pub fn roll_of_a_level_slider(n: usize, sweeps: usize) -> f64 {
    let d = 1.0 / n as f64;
    let height = |i: f64| 2.0 - i * d;
    let mut p = vec![vec![0.0; n + 2]; n + 2];
    for _ in 0..sweeps {
        for j in 1..=n {
            for i in 1..=n {
                let at = i as f64 - 0.5;
                let [west, east] = [at - 0.5, at + 0.5].map(|i| height(i).powi(3));
                let across = height(at).powi(3);
                let flows = west * p[j][i - 1]
                    + east * p[j][i + 1]
                    + across * (p[j - 1][i] + p[j + 1][i])
                    + d * (height(at - 0.5) - height(at + 0.5));
                p[j][i] = flows / (west + east + 2.0 * across);
            }
        }
    }
    let (mut load, mut moment) = (0.0, 0.0);
    for (j, row) in p.iter().enumerate().take(n + 1).skip(1) {
        let across: f64 = row[1..=n].iter().sum();
        load += across;
        moment += across * ((j as f64 - 0.5) * d - 0.5);
    }
    (moment / load).abs()
}

/// Load of the slider H = 2 − x with the wind from its leading edge, or turned round with the wind
/// from behind, on `n` equal cells: mass carried by first-order differences that always look to the
/// leading side, pressures by central ones, Newton's method from ambient.
pub fn load_with_a_fixed_upwind_side(bearing_number: f64, n: usize, turned: bool) -> f64 {
    let d = 1.0 / n as f64;
    let (lambda, height): (f64, fn(f64) -> f64) = if turned {
        (-bearing_number, |x| 1.0 + x)
    } else {
        (bearing_number, |x| 2.0 - x)
    };
    let mut p = vec![1.0; n + 1];
    for _ in 0..40 {
        let mut rows = vec![[0.0; 3]; n - 1];
        let mut rhs = vec![0.0; n - 1];
        for i in 1..n {
            let x = i as f64 * d;
            let (west, east) = (height(x - 0.5 * d).powi(3), height(x + 0.5 * d).powi(3));
            let flux = |a: f64, b: f64, cube: f64| cube * 0.5 * (b * b - a * a) / d;
            let wind = lambda * (p[i] * height(x) - p[i - 1] * height(x - d));
            rhs[i - 1] = flux(p[i], p[i + 1], east) - flux(p[i - 1], p[i], west) - wind;
            rows[i - 1] = [
                west * p[i - 1] / d + lambda * height(x - d),
                -(west + east) * p[i] / d - lambda * height(x),
                east * p[i + 1] / d,
            ];
        }
        let delta = tridiagonal(&mut rows, &mut rhs);
        p[1..n].iter_mut().zip(delta).for_each(|(p, d)| *p -= d);
    }
    p.windows(2).map(|w| d * (0.5 * (w[0] + w[1]) - 1.0)).sum()
}
