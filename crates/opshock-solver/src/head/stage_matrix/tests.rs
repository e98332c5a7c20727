//! Products and solutions by ports and modes against dense matrices in the reduction's own coordinates.

use super::super::mechanics::{Mechanics, StageState};
use super::super::sample::{law, limiter, slider, suspension};
use super::StageMatrix;
use super::dense::{Dense, even_damping};
use crate::suspension::{
    LiftTab, Limiter, RayleighDamping, ReducedSuspension, SuspensionMode, SuspensionParameters,
};
use nalgebra::{Complex, DMatrix, DVector};

/// Pseudo-random numbers between −1 and 1.
fn spread(n: usize, seed: f64) -> DVector<f64> {
    DVector::from_fn(n, |i, _| {
        (seed + 2.3 * i as f64 + 0.7 * (i * i) as f64).sin()
    })
}

/// Largest error over its scale, entry by entry.
fn worst(found: &[f64], wanted: &DVector<f64>, scale: &DVector<f64>) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let errors = found.iter().zip(wanted.iter()).zip(scale.iter());
    errors.fold(0.0, |worst: f64, ((f, w), s)| {
        worst.max(if f == w { 0.0 } else { (f - w).abs() / s })
    })
}

/// Heads with limiters, a lift tab, both and neither; with few and with many modes; with given modes.
fn heads() -> Vec<(String, SuspensionParameters, usize)> {
    let mut plain = suspension();
    plain.gimbal.pitch_n_m_per_rad = 6.0e-5;
    plain.gimbal.roll_n_m_per_rad = 2.5e-5;
    let limiters = |along: f64| -> Vec<Limiter> {
        [-4e-4, 4e-4]
            .map(|across| limiter(2e-6, along, across, law(1e5, 0.05)))
            .to_vec()
    };
    let tab = Some(LiftTab {
        gap_m: 3e-6,
        contact: law(2e5, 0.1),
    });
    let modes = |k: i32| SuspensionMode {
        frequency_hz: 400.0 * 2.1_f64.powi(k),
        vertical_per_sqrt_kg: if k % 3 == 2 {
            0.0
        } else {
            300.0 - 20.0 * f64::from(k)
        },
        slope_per_m_sqrt_kg: if k % 3 == 2 {
            0.0
        } else {
            5e4 * f64::from(k + 1)
        },
        roll_per_m_sqrt_kg: if k % 3 == 2 { 4e5 } else { 0.0 },
        participation_sqrt_kg: if k % 3 == 2 { 0.0 } else { 1e-3 },
    };
    let mut out = Vec::new();
    for n in [0, 4, 32] {
        let with = |what: &str, limiters: Vec<Limiter>, lift_tab| {
            let mut parameters = plain.clone();
            (parameters.limiters, parameters.lift_tab) = (limiters, lift_tab);
            (format!("{what}, {n} modes"), parameters, n)
        };
        out.push(with("plain", Vec::new(), None));
        out.push(with("limiters", limiters(3e-4), None));
        out.push(with("lift tab", Vec::new(), tab));
        out.push(with("both", limiters(-2e-4), tab));
    }
    let mut given = plain;
    given.modes = (0..9).map(modes).collect();
    given.limiters = limiters(3e-4);
    out.push(("given modes".to_string(), given, 32));
    out
}

/// States (u, w, known w) with the dimple closed and open, stops closed and open.
fn states(dense: &Dense) -> Vec<[DVector<f64>; 3]> {
    let n = dense.len();
    let mut out = Vec::new();
    for (k, [slider_m, dimple_m]) in [
        [1e-8, 1e-8],
        [-1e-6, 1e-6],
        [-9e-6, 9e-6],
        [9e-6, 8.9e-6],
        [-9e-6, -8.9e-6],
    ]
    .into_iter()
    .enumerate()
    {
        let seed = k as f64;
        let mut u = 1e-10 * spread(n, seed);
        u[0] = slider_m;
        u[1] *= 1e5;
        u[2] *= 1e5;
        u[3] = dimple_m;
        let speeds = |seed: f64| {
            let mut w = 1e-5 * spread(n, seed);
            w[0] *= 1e2;
            w[3] *= 1e2;
            w
        };
        out.push([u, speeds(seed + 0.3), speeds(seed + 0.6)]);
    }
    out
}

/// Film's condensed stiffness: none, and one that is neither symmetric nor weak.
const FILMS: [[[f64; 3]; 3]; 2] = [
    [[0.0; 3]; 3],
    [[2e6, 80.0, -30.0], [-150.0, 0.3, 4e-3], [20.0, -7e-3, 0.1]],
];

fn built(parameters: &SuspensionParameters, n: usize) -> (Dense, Mechanics) {
    let reduced = ReducedSuspension::build(parameters, n).expect("builds");
    let mechanics = Mechanics::new(parameters, &reduced, &slider()).expect("a mass matrix");
    let dense = Dense::new(parameters, &reduced);
    assert_eq!(mechanics.len(), dense.len());
    (dense, mechanics)
}

#[test]
fn products_are_those_of_dense_matrices() {
    let (a, film) = (3e3, [1e-3, -2e-7, 3e-7]);
    let mut seen = [[false; 2]; 3];
    for (name, parameters, n_modes) in heads() {
        let (dense, mechanics) = built(&parameters, n_modes);
        let n = dense.len();
        let (to_modes, from_modes) = (&dense.to_modes, &dense.from_modes);
        // A force r on u is the force Tᵀ r on x.
        let worst_of = |found: &[f64], r: &DVector<f64>, size: &DVector<f64>| {
            let scale = from_modes.abs().tr_mul(size);
            worst(found, &from_modes.tr_mul(r), &scale)
        };
        let mut pushed = DVector::zeros(n);
        pushed.rows_mut(0, 3).copy_from_slice(&film);
        for (k, [u, w, known]) in states(&dense).into_iter().enumerate() {
            let [x, v, v_known] = [&u, &w, &known].map(|u| to_modes * u);
            let closed: Vec<bool> = dense
                .contacts
                .iter()
                .map(|contact| contact.signed(&u, &w) > 0.0)
                .collect();
            let [force, size] = dense.contact_force(&u, &w);
            let [damping, stiffness] = [&dense.damping, &dense.stiffness];
            let rest = a * &dense.load + &pushed + force - damping * &w - stiffness * &u;
            let rest_size = a * dense.load.abs()
                + pushed.abs()
                + size
                + damping.abs() * w.abs()
                + stiffness.abs() * u.abs();
            for d_s in [1e-8, 3e-7, 3e-6] {
                let rate = (&w - &known) / d_s;
                let r = &rest - &dense.mass * &rate;
                let r_size = &rest_size + dense.mass.abs() * (w.abs() + known.abs()) / d_s;
                let state = StageState {
                    d_s,
                    a,
                    film,
                    x: x.as_slice(),
                    v: v.as_slice(),
                    v_known: v_known.as_slice(),
                };
                let mut out = vec![f64::NAN; n];
                let found = mechanics.imbalance(&state, &mut out);
                let error = worst_of(&out, &r, &r_size);
                assert!(error < 1e-12, "{name}, state {k}, {d_s:e}: {error:e}");
                assert_eq!(found, mechanics.closed(x.as_slice(), v.as_slice()));
                assert_eq!(found.dimple(), closed[0], "{name}, state {k}");
                let forces = mechanics.stop_forces(x.as_slice(), v.as_slice());
                for (kind, is_closed) in forces.iter().map(|f| *f > 0.0).enumerate() {
                    seen[1 + kind][usize::from(is_closed)] = true;
                }
                seen[0][usize::from(closed[0])] = true;
                let any_stop = closed[1..].iter().any(|c| *c);
                assert_eq!(forces[0] + forces[1] > 0.0, any_stop, "{name}, state {k}");

                let mut load = &dense.mass * (&w + &u / d_s) + &dense.damping * &u;
                let mut size = dense.mass.abs() * (w.abs() + u.abs() / d_s);
                size += dense.damping.abs() * u.abs();
                for (contact, _) in dense.contacts.iter().zip(&closed).filter(|(_, c)| **c) {
                    load += contact.n_s_per_m * contact.row.dot(&u) * &contact.row;
                    let row = contact.row.abs();
                    size += contact.n_s_per_m * row.dot(&u.abs()) * row;
                }
                let (load, load_size) = (load / d_s, size / d_s);
                mechanics.filter_load(d_s, found, x.as_slice(), v.as_slice(), &mut out);
                let error = worst_of(&out, &load, &load_size);
                assert!(error < 1e-12, "{name}, state {k}, {d_s:e}: {error:e}");
            }
            let mut out = vec![f64::NAN; n];
            mechanics.acceleration(a, film, x.as_slice(), v.as_slice(), &mut out);
            // M ẍ = r, not by the inverse of M.
            let found = &dense.mass * (from_modes * DVector::from_vec(out));
            let scale = dense.mass.abs() * from_modes.abs() * from_modes.abs().tr_mul(&rest_size);
            let error = worst(found.as_slice(), &rest, &(scale.clone() + &rest_size));
            assert!(error < 1e-12, "{name}, state {k}: {error:e}");
        }
    }
    assert_eq!(seen, [[true; 2]; 3]);
}

#[test]
fn solutions_are_those_of_dense_matrices() {
    // The longest step has d = 3e-6 s. Beyond it a suspension much softer than its joints costs digits.
    let bounds = [(1e-8, 1e-13), (3e-7, 1e-13), (3e-6, 1e-13), (1e-3, 1e-7)];
    for (name, parameters, n_modes) in heads() {
        let (dense, mechanics) = built(&parameters, n_modes);
        let n = dense.len();
        let mut matrix = StageMatrix::new(mechanics.n_modes());
        for (k, [u, w, _]) in states(&dense).into_iter().enumerate() {
            let [x, v] = [&u, &w].map(|u| &dense.to_modes * u);
            let closed = mechanics.closed(x.as_slice(), v.as_slice());
            let names: Vec<bool> = dense
                .contacts
                .iter()
                .map(|contact| contact.signed(&u, &w) > 0.0)
                .collect();
            let [damping, stiffness] = dense.tangent(&names);
            for ((d_s, bound), film) in bounds.into_iter().flat_map(|d| FILMS.map(|film| (d, film)))
            {
                let mut whole = &dense.mass / (d_s * d_s) + &damping / d_s + &stiffness;
                for f in 0..3 {
                    for q in 0..3 {
                        whole[(f, q)] += film[f][q];
                    }
                }
                // Every unknown and equation in units of its own.
                let units = whole.diagonal().map(|s| s.abs().sqrt());
                let scaled = DMatrix::from_fn(n, n, |i, j| whole[(i, j)] / (units[i] * units[j]));
                let b = spread(n, 0.1 * k as f64);
                let wanted = scaled.clone().full_piv_lu().solve(&b).expect("regular");

                let load = dense.from_modes.tr_mul(&b.component_mul(&units));
                let mut found = load.as_slice().to_vec();
                assert!(matrix.prepare(&mechanics, d_s, closed, &film));
                assert!(matrix.solve(&mut found));
                let found = (&dense.from_modes * DVector::from_vec(found)).component_mul(&units);
                let left = &scaled * &found - &b;
                let error = (&found - &wanted).amax() / wanted.amax();
                let left = left.amax() / (scaled.abs() * found.abs() + b.abs()).amax();
                let worst = error.max(left);
                assert!(
                    worst < bound,
                    "{name}, state {k}, {d_s:e}: {error:e} {left:e}"
                );
            }
        }
    }
}

#[test]
fn harmonic_matrix_is_the_dense_one() {
    for (name, parameters, n_modes) in heads() {
        let (dense, mechanics) = built(&parameters, n_modes);
        let mut closed = vec![false; dense.contacts.len()];
        closed[0] = true;
        let [damping, stiffness] = dense.tangent(&closed);
        let t = dense.from_modes.map(Complex::from);
        let real = |m: &DMatrix<f64>| m.map(Complex::from);
        for s in [
            Complex::new(0.0, 0.0),
            Complex::new(0.0, 6e5),
            Complex::new(-3e3, 2e4),
        ] {
            let wanted = t.transpose()
                * (real(&dense.mass) * (s * s) + real(&damping) * s + real(&stiffness))
                * &t;
            let sizes =
                dense.mass.abs() * s.norm_sqr() + damping.abs() * s.norm() + stiffness.abs();
            let t = dense.from_modes.abs();
            let sizes = t.transpose() * sizes * &t;
            let found = mechanics.dynamic_matrix(s);
            for (k, size) in sizes.iter().enumerate() {
                let error = (found.as_slice()[k] - wanted.as_slice()[k]).norm();
                assert!(error <= 1e-12 * size, "{name}, {s}: {error:e} of {size:e}");
            }
        }
        let dimple = mechanics.dimple_row();
        let wanted = dense.from_modes.row(3).transpose();
        assert!((dimple - &wanted).amax() <= 1e-14 * wanted.amax());
        let load = dense.from_modes.tr_mul(&dense.load);
        assert!((mechanics.inertia_load() - &load).amax() <= 1e-14 * load.amax());
    }
}

/// The error's measure equals that in the reduction's coordinates: Σ |ψᵀMφᵢ| ωᵢ² |e_i| over the pinned modes.
#[test]
fn error_of_the_suspension_is_weighed_in_pinned_modes() {
    for (name, parameters, n_modes) in heads() {
        let reduced = ReducedSuspension::build(&parameters, n_modes).expect("builds");
        let (dense, mechanics) = built(&parameters, n_modes);
        let bending = &reduced.bending;
        let u = 1e-9 * spread(dense.len(), 0.4);
        let wanted: f64 = (1..bending.len())
            .map(|i| bending.mass[(0, i)].abs() * bending.stiffness[i] * u[3 + i].abs())
            .sum();
        let e = &dense.to_modes * &u;
        let mut scratch = vec![0.0; dense.len()];
        let found = mechanics.suspension_force_error(e.as_slice(), &mut scratch);
        assert!(
            (found - wanted).abs() <= 1e-11 * wanted,
            "{name}: {found:e} {wanted:e}"
        );
    }
}

/// Rayleigh damping αM + βK is diagonal in the natural modes too, as the oscillators have it.
#[test]
fn natural_modes_make_rayleigh_damping_diagonal() {
    let (alpha_per_s, beta_s) = (25.0, 1e-7);
    for (name, mut parameters, n_modes) in heads() {
        parameters.rayleigh = Some(RayleighDamping {
            alpha_per_s,
            beta_s,
        });
        let reduced = ReducedSuspension::build(&parameters, n_modes).expect("builds");
        for set in [&reduced.bending, &reduced.torsion] {
            let stiffness = DMatrix::from_diagonal(&set.stiffness);
            let damping = &set.mass * alpha_per_s + stiffness * beta_s;
            let found = set.natural_modes.transpose() * damping * &set.natural_modes;
            let wanted = DMatrix::from_diagonal(&set.decay_per_s);
            let error = (&found - &wanted).amax() / wanted.amax();
            assert!(error < 1e-12, "{name}: {error:e}");
            let lowest = (found[(0, 0)] / set.decay_per_s[0] - 1.0).abs();
            assert!(lowest < 1e-9, "{name}: {lowest:e}");
        }
    }
}

/// Damping of one ratio for every natural mode, mass 1, stiffness ω².
#[test]
fn natural_modes_make_all_three_matrices_diagonal() {
    for (name, parameters, n_modes) in heads() {
        let reduced = ReducedSuspension::build(&parameters, n_modes).expect("builds");
        for set in [&reduced.bending, &reduced.torsion] {
            let (t, omega) = (&set.natural_modes, &set.natural_rad_per_s);
            let stiffness = DMatrix::from_diagonal(&set.stiffness);
            for (power, matrix, factor) in [
                (0, &set.mass, 1.0),
                (
                    1,
                    &even_damping(set, parameters.damping_ratio),
                    2.0 * parameters.damping_ratio,
                ),
                (2, &stiffness, 1.0),
            ] {
                let found = t.transpose() * matrix * t;
                for i in 0..set.len() {
                    for j in 0..set.len() {
                        let size = factor * (omega[i] * omega[j]).powf(0.5 * f64::from(power));
                        let wanted = size * f64::from(i == j);
                        let error = (found[(i, j)] - wanted).abs() / size;
                        assert!(error < 1e-12, "{name}, {power}, {i} {j}: {error:e}");
                    }
                }
            }
        }
    }
}

/// A matrix or a solution that is not finite is reported.
#[test]
fn what_is_not_finite_is_refused() {
    let (_, mechanics) = built(&suspension(), 4);
    let closed = super::Closed::DIMPLE;
    let mut matrix = StageMatrix::new(mechanics.n_modes());
    let mut film = FILMS[1];
    assert!(matrix.prepare(&mechanics, 1e-6, closed, &film));
    let mut b = vec![1.0; mechanics.len()];
    b[5] = f64::NAN;
    assert!(!matrix.solve(&mut b));
    b.fill(1.0);
    *b.last_mut().expect("modes") = f64::INFINITY;
    assert!(!matrix.solve(&mut b));
    film[1][2] = f64::NAN;
    assert!(!matrix.prepare(&mechanics, 1e-6, closed, &film));
    assert!(!matrix.prepare(&mechanics, f64::NAN, closed, &FILMS[0]));
    assert!(matrix.prepare(&mechanics, 1e-6, closed, &FILMS[0]));
}
