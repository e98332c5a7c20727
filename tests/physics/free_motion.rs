//! Motion of disk and ramp before any contact, against references and relations.

use opshock_solver::disk::{DiskMotion, DiskParameters};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RampBody, RigidRamp};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::structure::{StructuralHistory, Window, Workspace};
use opshock_tests::digests::assert_digest;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{Structure, half_sine, paper, s1, s1_arms};
use opshock_tests::{number, reference};

/// The reference disk without a ramp; `radius_m` is seen through the slider.
fn no_ramp(width_s: f64, radius_m: f64) -> Structure {
    let mut structure = s1(width_s, NoRamp);
    structure.slider.radius_m = radius_m;
    structure
}

fn extreme(history: &StructuralHistory, sign: f64) -> (f64, f64) {
    let k = (0..history.nodes().len())
        .max_by(|&a, &b| {
            let value = |k: usize| sign * history.nodes()[k].displacement_m;
            value(a).total_cmp(&value(b))
        })
        .unwrap();
    // The peak between nodes: where the rate changes sign.
    let step = history.step_s();
    let (mut low, mut high) = ((k as f64 - 1.0) * step, (k as f64 + 1.0) * step);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if sign * history.pose_rate(middle).displacement_m > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, history.pose(low).displacement_m)
}

#[test]
fn no_ramp_response_is_the_reference_to_1e_5() {
    let data = reference("no_ramp_response.json");
    let (mut workspace, mut all) = (Workspace::default(), Vec::new());
    for row in data["rows"].as_array().unwrap() {
        let width = number(&row["T"]);
        for (place, radius, column) in [
            ("slider", 0.02125, 1),
            ("ramp_point", 0.032, 2),
            ("outer_edge", 0.0325, 0),
        ] {
            let run = no_ramp(width, radius)
                .build()
                .run(G, false, &mut workspace)
                .unwrap();
            let peak = number(&row[place]["max_m_per_G"]);
            for (sign, value, time) in [
                (1.0, "max_m_per_G", "t_max"),
                (-1.0, "min_m_per_G", "t_min"),
            ] {
                let (t, w) = extreme(&run.history, sign);
                all.extend([t, w]);
                at_most(
                    "half-sine-response",
                    "error of a peak, of the largest",
                    (w - number(&row[place][value])).abs() / peak,
                    1e-5,
                );
                at_most(
                    "half-sine-response",
                    "error of its time (s)",
                    (t - number(&row[place][time])).abs(),
                    1e-8,
                );
            }
            if column > 0 {
                for sample in row["samples_t_slider_ramp"].as_array().unwrap() {
                    let w = run.history.pose(number(&sample[0])).displacement_m;
                    let error = (w - number(&sample[column])).abs();
                    at_most(
                        "half-sine-response",
                        "error at any sample, of the peak",
                        error / peak,
                        1e-5,
                    );
                }
            }
        }
    }
    assert_digest("reference no_ramp_response", &all);
}

#[test]
fn documented_peaks_of_the_drive_disk() {
    let mut workspace = Workspace::default();
    for (radius, micrometres) in [(0.0325, 104.3), (0.03215, 102.4), (0.022215, 46.5)] {
        let mut structure = paper(5e-4, NoRamp);
        structure.slider.radius_m = radius;
        let run = structure
            .build()
            .run(200.0 * G, false, &mut workspace)
            .unwrap();
        assert!(
            (run.disk.slider_max_m * 1e6 - micrometres).abs() < 0.051,
            "{:?}",
            run.disk
        );
    }
    // 400 G / 2 ms brings the ramp point to 100 um 0.50 ms after the onset.
    let mut structure = paper(2e-3, NoRamp);
    structure.slider.radius_m = 0.03215;
    let run = structure
        .build()
        .run(400.0 * G, false, &mut workspace)
        .unwrap();
    let k = run
        .history
        .nodes()
        .iter()
        .position(|p| p.displacement_m > 100e-6)
        .unwrap();
    assert!((k as f64 * 0.5e-6 - 0.5e-3).abs() < 5e-6, "{k}");
}

/// Hard case A4: a pulse far shorter than the step is a velocity step 2 A T / pi.
#[test]
fn hard_a4_short_pulse_is_an_impulse() {
    let mut workspace = Workspace::default();
    let mut run = |width: f64| {
        let mut structure = no_ramp(width, 0.032).with_step(2e-6);
        structure.window = Window::Fixed { length_s: 1e-3 };
        structure
            .build()
            .run(1.0 / width, false, &mut workspace)
            .unwrap()
    };
    let (short, shorter) = (run(1e-7), run(1e-8));
    let scale = shorter.disk.slider_max_m;
    for k in (10..500).step_by(49) {
        let (a, b) = (short.history.nodes()[k], shorter.history.nodes()[k]);
        assert!((a.displacement_m - b.displacement_m).abs() < 1e-3 * scale);
    }
    assert!(scale > 1e-5);
}

/// All pulse shapes: the closed form against the same pulse as a fine table.
#[test]
fn every_shape_agrees_with_its_own_table() {
    let mut workspace = Workspace::default();
    let width = 7.3e-4;
    let shapes = [
        PulseShape::HalfSine,
        PulseShape::Haversine,
        PulseShape::Square,
        PulseShape::Trapezoid { rise_share: 0.2 },
        PulseShape::DampedSine {
            frequency_hz: 2500.0,
            decay_per_s: 900.0,
        },
    ];
    for shape in shapes {
        let pulse = Pulse {
            shape: shape.clone(),
            width_s: width,
        };
        let n = 4000;
        let time_s: Vec<f64> = (0..=n)
            .map(|k| width * f64::from(k) / f64::from(n))
            .collect();
        let table = PulseShape::Table {
            relative: time_s.iter().map(|&t| pulse.value(t)).collect(),
            time_s,
        };
        let mut structure = no_ramp(width, 0.032);
        structure.pulse = pulse;
        let exact = structure
            .build()
            .run(100.0 * G, false, &mut workspace)
            .unwrap();
        structure.pulse.shape = table;
        let sampled = structure
            .build()
            .run(100.0 * G, false, &mut workspace)
            .unwrap();
        for (a, b) in exact.history.nodes().iter().zip(sampled.history.nodes()) {
            let difference = (a.displacement_m - b.displacement_m).abs();
            assert!(
                difference < 1e-6 * exact.disk.slider_max_m,
                "{shape:?} {difference:e}"
            );
        }
        assert!(
            exact.energy.closure < 1e-12 && sampled.energy.closure < 1e-12,
            "{:?}",
            exact.energy
        );
    }
}

/// Velocity changes of unit pulses in closed form: 2T/pi, T/2, T, (1 - r)T, and of a table its trapezoids.
#[test]
fn the_integral_of_every_shape_is_its_closed_form() {
    let (width_s, decay, frequency) = (7.3e-4, 900.0_f64, 2500.0_f64);
    let omega = std::f64::consts::TAU * frequency;
    let (sin, cos) = (omega * width_s).sin_cos();
    let sine = (omega - (-decay * width_s).exp() * (decay * sin + omega * cos))
        / (decay * decay + omega * omega);
    let table = PulseShape::Table {
        time_s: vec![0.0, 1e-4, 4e-4, width_s],
        relative: vec![0.0, 1.0, -0.5, 0.0],
    };
    let shapes = [
        (PulseShape::HalfSine, width_s * std::f64::consts::FRAC_2_PI),
        (PulseShape::Haversine, 0.5 * width_s),
        (PulseShape::Square, width_s),
        (PulseShape::Trapezoid { rise_share: 0.2 }, 0.8 * width_s),
        (
            PulseShape::DampedSine {
                frequency_hz: frequency,
                decay_per_s: decay,
            },
            sine,
        ),
        (table, 0.5e-4 + 0.75e-4 - 0.25 * 3.3e-4),
    ];
    for (shape, expected) in shapes {
        let pulse = Pulse { shape, width_s };
        let found = pulse.integral_s().expect("a sound pulse");
        assert!(
            (found - expected).abs() < 1e-12 * width_s,
            "{pulse:?}: {found}"
        );
    }
}

/// Hard cases B18, B17, A10: below touch all ramps give the same bits, and -A mirrors A.
#[test]
fn hard_b18_below_touch_every_ramp_gives_the_same_bits() {
    let mut workspace = Workspace::default();
    let models = [RampBody::from(NoRamp), RigidRamp.into(), s1_arms()].map(|m| s1(5e-4, m).build());
    let onset = models[1..]
        .iter()
        .map(|m| m.touch_amplitude_m_per_s2(true).unwrap())
        .fold(f64::MAX, f64::min);
    for amplitude in [0.999 * onset, 0.3 * onset, -0.5 * onset] {
        let runs: Vec<_> = models
            .iter()
            .map(|m| m.run(amplitude, true, &mut workspace).unwrap())
            .collect();
        let bits = |run: &opshock_solver::structure::StructureRun| -> Vec<u64> {
            let c = run.columns.as_ref().unwrap();
            [
                &c.disk_slider_m,
                &c.disk_ramp_m,
                &c.disk_rim_m,
                &c.disk_pitch_rad,
                &c.disk_roll_rad,
            ]
            .iter()
            .flat_map(|column| column.iter().map(|x| x.to_bits()))
            .collect()
        };
        assert_eq!(bits(&runs[0]), bits(&runs[1]));
        assert_eq!(bits(&runs[0]), bits(&runs[2]));
        assert_eq!(runs[0].history, runs[2].history);
        assert!(runs.iter().all(|r| r.first_touch_s.is_none()));
    }
}

/// The window "until decayed" ends where the energy has fallen to its share.
#[test]
fn until_decayed_ends_at_the_share() {
    let mut workspace = Workspace::default();
    let mut structure = paper(5e-4, NoRamp);
    structure.window = Window::UntilDecayed {
        share: 0.5,
        max_s: 50e-3,
    };
    let run = structure
        .build()
        .run(100.0 * G, true, &mut workspace)
        .unwrap();
    let energy = &run.columns.as_ref().unwrap().energy_j;
    let peak = energy.iter().copied().fold(0.0, f64::max);
    assert!(run.end_s > 2e-3 && run.end_s < 49e-3, "{}", run.end_s);
    assert!(energy[energy.len() - 1] <= 0.5 * peak && energy[energy.len() - 2] > 0.5 * peak);
    structure.window = Window::UntilDecayed {
        share: 1e-6,
        max_s: 4e-3,
    };
    assert!(
        (structure
            .build()
            .run(G, false, &mut workspace)
            .unwrap()
            .end_s
            - 4e-3)
            .abs()
            < 1e-9
    );
}

/// Slopes under the slider: a skewed slider sees the same plane from turned axes.
#[test]
fn slopes_turn_with_the_skew() {
    let mut workspace = Workspace::default();
    let mut structure = s1(2e-3, RigidRamp);
    let straight = structure
        .build()
        .run(400.0 * G, false, &mut workspace)
        .unwrap();
    structure.slider.skew_rad = 0.3;
    let skewed = structure
        .build()
        .run(400.0 * G, false, &mut workspace)
        .unwrap();
    let (sine, cosine) = 0.3_f64.sin_cos();
    let mut seen = 0.0_f64;
    for (a, b) in straight.history.nodes().iter().zip(skewed.history.nodes()) {
        // Gradient (w_x, w_y) = (-pitch, roll), disk velocity at +skew from x.
        let (wx, wy) = (-a.pitch_rad, a.roll_rad);
        let pitch = -(wx * cosine - wy * sine);
        let roll = wx * sine + wy * cosine;
        assert!((b.pitch_rad - pitch).abs() < 1e-12 && (b.roll_rad - roll).abs() < 1e-12);
        seen = seen.max(a.pitch_rad.abs());
    }
    assert!(
        seen > 1e-4,
        "the ramp tilts the disk along the track: {seen:e}"
    );
}

/// Slopes are the gradient of the displacement, checked by moving the slider.
#[test]
fn slopes_are_the_gradient_of_the_displacement() {
    let mut workspace = Workspace::default();
    let base = s1(2e-3, RigidRamp).with_step(1e-6);
    let mut at = |radius: f64, angle: f64| {
        let mut structure = base.clone();
        structure.slider.radius_m = radius;
        structure.slider.angle_rad = angle;
        structure
            .build()
            .run(400.0 * G, false, &mut workspace)
            .unwrap()
            .history
    };
    let (r, a, d) = (base.slider.radius_m, base.slider.angle_rad, 2e-5);
    let (here, out, inward) = (at(r, a), at(r + d, a), at(r - d, a));
    let (on, back) = (at(r, a + d / r), at(r, a - d / r));
    for k in (0..5000).step_by(137) {
        let w = |h: &StructuralHistory| h.nodes()[k].displacement_m;
        let roll = (w(&out) - w(&inward)) / (2.0 * d);
        let pitch = -(w(&on) - w(&back)) / (2.0 * d);
        let pose = here.nodes()[k];
        assert!(
            (pose.roll_rad - roll).abs() < 2e-7,
            "{k}: {} {roll}",
            pose.roll_rad
        );
        assert!(
            (pose.pitch_rad - pitch).abs() < 2e-7,
            "{k}: {} {pitch}",
            pose.pitch_rad
        );
    }
}

/// A backward-spinning disk is the mirror image of a forward-spinning one.
#[test]
fn the_sense_of_rotation_is_a_mirror() {
    let mut workspace = Workspace::default();
    let forward = s1(2e-3, RigidRamp);
    let mut backward = forward.clone();
    backward.disk = DiskParameters {
        spin_rad_per_s: -forward.disk.spin_rad_per_s,
        ..forward.disk.clone()
    };
    backward.slider.angle_rad = -forward.slider.angle_rad;
    let a = forward
        .build()
        .run(400.0 * G, false, &mut workspace)
        .unwrap();
    let b = backward
        .build()
        .run(400.0 * G, false, &mut workspace)
        .unwrap();
    for (p, q) in a.history.nodes().iter().zip(b.history.nodes()) {
        assert!((p.displacement_m - q.displacement_m).abs() < 1e-12);
        assert!((p.pitch_rad - q.pitch_rad).abs() < 1e-9 && (p.roll_rad - q.roll_rad).abs() < 1e-9);
    }
}

/// Grid times are k times the step, and the pulse's end is an event of the history.
#[test]
fn events_hold_the_onset_and_the_end_of_the_pulse() {
    let mut structure = s1(1e-3, NoRamp);
    structure.pulse = half_sine(1e-3);
    let run = structure
        .build()
        .run(G, false, &mut Workspace::default())
        .unwrap();
    assert_eq!(run.history.events_s(), [0.0, 1e-3]);
}
