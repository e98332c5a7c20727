//! Run-out and waviness: the plane under the slider, the head that follows it, and the head's linear
//! response, of which the start of a run is made.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Complex, DMatrix, DVector};
use opshock_solver::air_bearing::Film;
use opshock_solver::air_bearing::steady::Flight;
use opshock_solver::disk::run_out::WavyDisk;
use opshock_solver::disk::{DiskMotion, SurfaceMotion, Track, Wave};
use opshock_solver::head::response::{Drive, HeadResponse};
use opshock_solver::head::{HeadColumns, HeadError, HeadModel, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::quantity::rad_per_s_from_rpm;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::suspension::ReducedSuspension;
use opshock_tests::heads::{StillDisk, default_film, default_resolution, head_on};
use opshock_tests::sheet::at_most;
use opshock_tests::suspensions::default_suspension;

fn track(skew_rad: f64) -> Track {
    Track {
        radius_m: 21e-3,
        angle_rad: 0.7,
        skew_rad,
        outer_radius_m: 32.5e-3,
        spin_rad_per_s: rad_per_s_from_rpm(5400.0),
    }
}

fn wave(harmonic: u32, amplitude_m: f64, grows_with_radius: bool) -> Wave {
    Wave {
        harmonic,
        amplitude_m,
        phase_rad: 0.4,
        grows_with_radius,
    }
}

/// Displacement, slopes and rates against differences of the shape itself.
#[test]
fn run_out_moves_the_plane_that_touches_the_surface() {
    let waves = [
        wave(1, 5e-6, true),
        wave(12, 2e-8, false),
        wave(5, 1e-7, true),
    ];
    for skew in [0.0, 0.3] {
        let track = track(skew);
        let surface = |x: f64, y: f64, t: f64| -> f64 {
            let (r, theta) = (f64::hypot(x, y), y.atan2(x));
            let of = |w: &Wave| {
                let share = if w.grows_with_radius {
                    r / 32.5e-3
                } else {
                    1.0
                };
                let k = f64::from(w.harmonic);
                let angle = k * (theta - track.spin_rad_per_s * t) + w.phase_rad;
                w.amplitude_m * share * angle.cos()
            };
            waves.iter().map(of).sum()
        };
        let motion = SurfaceMotion::new(&waves, &track);
        let disk = WavyDisk {
            under: &StillDisk,
            surface: &motion,
        };
        let (s, c) = track.angle_rad.sin_cos();
        let (x, y) = (21e-3 * c, 21e-3 * s);
        // Slider's x along the disk's velocity turned by the skew, y outwards.
        let (ss, cs) = skew.sin_cos();
        let along = [-s * cs - c * ss, c * cs - s * ss];
        let across = [-s * ss + c * cs, c * ss + s * cs];
        for t in [0.0, 1.234e-3, 7e-3] {
            let step = 1e-7;
            let slope = |d: [f64; 2]| {
                let at = |sign: f64| surface(x + sign * step * d[0], y + sign * step * d[1], t);
                (at(1.0) - at(-1.0)) / (2.0 * step)
            };
            let pose = disk.pose(t);
            assert!((pose.displacement_m - surface(x, y, t)).abs() < 1e-18);
            assert!(
                (pose.pitch_rad + slope(along)).abs() < 1e-9 * 3e-4,
                "{skew} {t}"
            );
            assert!(
                (pose.roll_rad - slope(across)).abs() < 1e-9 * 3e-4,
                "{skew} {t}"
            );
            let (before, after) = (disk.pose(t - 1e-8), disk.pose(t + 1e-8));
            let rate = disk.pose_rate(t);
            for (rate, [after, before]) in [
                (
                    rate.displacement_m,
                    [after.displacement_m, before.displacement_m],
                ),
                (rate.pitch_rad, [after.pitch_rad, before.pitch_rad]),
                (rate.roll_rad, [after.roll_rad, before.roll_rad]),
            ] {
                let difference = (after - before) / 2e-8;
                assert!(
                    (rate - difference).abs() < 1e-6 * (rate.abs() + 1e-3),
                    "{rate}"
                );
            }
        }
    }
}

fn no_shock() -> Pulse {
    Pulse {
        shape: PulseShape::HalfSine,
        width_s: 1e-4,
    }
}

fn columns_over(head: &HeadModel, window_s: f64) -> HeadColumns {
    let pulse = no_shock();
    let load = ShockLoad {
        base: None,
        pulse: &pulse,
        amplitude_m_per_s2: 0.0,
    };
    let mut workspace = HeadWorkspace::new(head);
    let run = head.run(&StillDisk, &load, window_s, true, true, &mut workspace);
    assert_eq!(run.verdict, Verdict::Survives);
    run.columns.unwrap()
}

fn head(film: &(Arc<Film>, Arc<Flight>), tolerance: f64) -> HeadModel {
    let mut resolution = default_resolution();
    resolution.tolerance = tolerance;
    resolution.coupling_tolerance = 1e-2 * tolerance;
    head_on(&film.0, &film.1, &resolution)
}

/// Complex amplitude of a column at ω, by least squares with a constant.
fn amplitude(time_s: &[f64], values: &[f64], omega: f64) -> Complex<f64> {
    let rows = DMatrix::from_fn(time_s.len(), 3, |i, j| match j {
        0 => (omega * time_s[i]).cos(),
        1 => -(omega * time_s[i]).sin(),
        _ => 1.0,
    });
    let right = DVector::from_column_slice(values);
    let fit = rows.svd(true, true).solve(&right, 1e-12).unwrap();
    Complex::new(fit[0], fit[1])
}

/// Small waves: the run in time, from its first instant on, is the harmonic motion that the linear
/// response says, height and pitch, in and far above the range of the suspension's modes; twice the wave
/// is twice the answer.
#[test]
fn run_out_in_time_is_the_linear_response() {
    let film = default_film(500);
    let at_rest = head(&film, 1e-5);
    for (harmonic, amplitude_m) in [(22, 1e-9), (200, 1e-10), (1000, 1e-10)] {
        let motion = |amplitude_m| {
            let waves = [wave(harmonic, amplitude_m, false)];
            SurfaceMotion::new(&waves, &track(0.0))
        };
        let surface = motion(amplitude_m);
        let swing = surface.swings()[0];
        let omega = swing.omega_rad_per_s;
        let drive = Drive {
            disk: swing.pose,
            ..Drive::default()
        };
        let expected = HeadResponse::new(&at_rest).at(omega, &drive).unwrap();
        let window = (4.0 * TAU / omega).max(1e-4);
        let of = |amplitude_m: f64| {
            let wavy = head(&film, 1e-5).with_run_out(motion(amplitude_m)).unwrap();
            let columns = columns_over(&wavy, window);
            [
                amplitude(&columns.time_s, &columns.slider_z_m, omega),
                amplitude(&columns.time_s, &columns.slider_pitch_rad, omega),
            ]
        };
        let (once, twice) = (of(amplitude_m), of(2.0 * amplitude_m));
        for q in 0..2 {
            let error = (once[q] - expected.slider[q]).norm() / expected.slider[q].norm();
            at_most(
                "run-out",
                "relative distance of the run in time from the linear response",
                error,
                2e-3,
            );
            let ratio = (twice[q] / once[q] - 2.0).norm() / 2.0;
            assert!(ratio < 2e-3, "{harmonic} {q}: {ratio}");
        }
    }
}

/// Once a revolution the slider follows 3 um with a change of its clearance by what the suspension's
/// stiffness and the masses need, some hundredths of a nanometre.
#[test]
fn run_out_once_a_revolution_is_followed() {
    let film = default_film(500);
    let waves = [wave(1, 5e-6, true)];
    let wavy = head(&film, 1e-3)
        .with_run_out(SurfaceMotion::new(&waves, &track(0.0)))
        .unwrap();
    let columns = columns_over(&wavy, 11.2e-3);
    let extremes = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::MAX, f64::min);
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        [low, high]
    };
    let [low, high] = extremes(&columns.slider_z_m);
    let reach = 2.0 * 5e-6 * 21.0 / 32.5;
    assert!(((high - low) / reach - 1.0).abs() < 1e-3, "{}", high - low);
    let [low, high] = extremes(&columns.min_clearance_m);
    assert!(high - low < 0.05 * film.1.min_clearance_m, "{}", high - low);
}

/// The static limit: a raised disk takes the slider along against the suspension's stiffness in series with
/// dimple and gimbal, and a force on the slider moves it by the flexibility of film and suspension.
#[test]
fn response_static_limit_is_flexibility() {
    let film = default_film(500);
    let model = head(&film, 1e-3);
    let mut response = HeadResponse::new(&model);
    let one = Complex::new(1.0, 0.0);
    let zero = Complex::new(0.0, 0.0);
    let drive = Drive {
        disk: [one * 1e-9, zero, zero],
        ..Drive::default()
    };
    let raised = response.at(0.0, &drive).unwrap();
    let suspension = ReducedSuspension::build(&default_suspension(), 4).unwrap();
    let parameters = default_suspension();
    let joint = parameters.dimple.stiffness_n_per_m + parameters.gimbal.vertical_n_per_m;
    let expected = raised.dimple_m * suspension.dimple_stiffness_n_per_m();
    let through = (raised.slider[0] - raised.dimple_m) * joint;
    assert!((raised.film[0] / through - 1.0).norm() < 1e-6);
    // The gimbal's pitch spring at the dimple adds some of its own.
    assert!(
        (raised.film[0] / expected - 1.0).norm() < 0.2,
        "{}",
        raised.film[0]
    );
    assert!((raised.slider[0].re / 1e-9 - 1.0).abs() < 1e-3);

    // Film alone against the steady solver's stiffness, and its damping at a low frequency.
    let z = response.impedance(0.0).unwrap();
    let slow = response.impedance(TAU).unwrap();
    for i in 0..3 {
        for j in 0..3 {
            let flight = &film.1;
            let scale = (flight.stiffness[i][i] * flight.stiffness[j][j]).sqrt();
            assert!((z[(i, j)].re - flight.stiffness[i][j]).abs() < 1e-9 * scale);
            let scale = (flight.damping[i][i] * flight.damping[j][j]).abs().sqrt();
            let damping = slow[(i, j)].im / TAU;
            assert!((damping - flight.damping[i][j]).abs() < 1e-4 * scale);
        }
    }
    // A unit force: reciprocity of a static, nearly symmetric pair is not exact, the balance is.
    let push = Drive {
        slider: [one, zero, zero],
        ..Drive::default()
    };
    let moved = response.at(0.0, &push).unwrap();
    let left = one + moved.film[0] - (moved.slider[0] - moved.dimple_m) * joint;
    assert!(left.norm() < 1e-9, "{left}");
}

/// What the slider cannot follow is refused, with a number that says how far beyond it is.
#[test]
fn run_out_beyond_what_the_slider_can_follow_is_refused() {
    let film = default_film(500);
    let waves = [wave(1000, 2e-8, false)];
    let surface = SurfaceMotion::new(&waves, &track(0.0));
    match head(&film, 1e-3).with_run_out(surface) {
        Err(HeadError::RunOut { lost }) => assert!(lost > 1.0 && lost < 100.0, "{lost}"),
        other => panic!("{other:?}"),
    }
}
