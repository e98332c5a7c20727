//! Run-out of the disk taken off the gap at the ramp: the first touch of the worst angle that the disk may have.

use std::f64::consts::TAU;

use super::cli::Done;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::NoRamp;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::Model;
use opshock_study::study::Study;
use opshock_tests::pairs;

const DRIVE: &str = "study_format = 2\nname = \"gap\"\noutputs = [\"contact_force\"]\n\
    [pulse]\nwidths_ms = [0.5]\nsigns = [\"+\", \"-\"]\nwindow_ms = 3.0\n[resolution]\npreset = \"coarse\"\n\
    [ramp]\nmodels = [\"rigid\"]\nradius_mm = 32.15\nclearance_um = 100.0\n";
const RUN_OUT: &str = "[disk]\nouter_radius_mm = 32.5\nrun_out_um = 5.0\n";
/// Amplitude at the ramp.
const TAKEN_M: f64 = 5e-6 * 32.15 / 32.5;

fn study(more: &str) -> Study {
    let text = format!("{DRIVE}{more}");
    Study::from_text(&text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn touch(scene: &Scene) -> [f64; 2] {
    let plan = Plan::new(&[Output::TouchThreshold], Mode::Auto);
    let model = Model::assemble(scene, &plan, None).unwrap();
    [true, false].map(|plus| model.structure().touch_amplitude_m_per_s2(plus).unwrap())
}

/// Without the key run-out does not reach the ramp. With it the scene is that of narrower gaps, whose first touch is
/// theirs to the share of the gap, as the motion before is linear; waves of any harmonic are included whole.
#[test]
fn the_gap_is_narrower_by_the_run_out_at_the_ramp() {
    let plane = &study("").points[0].scene;
    let off = &study(RUN_OUT).points[0];
    assert_eq!(off.scene.ramp, plane.ramp);
    assert_eq!(off.gap_taken_m, 0.0);
    let on = &study(&format!("run_out = \"lowest_gap\"\n{RUN_OUT}")).points[0];
    assert!((on.gap_taken_m / TAKEN_M - 1.0).abs() < 1e-14);
    let gaps = |scene: &Scene| [scene.ramp.clearance_top_m, scene.ramp.clearance_bottom_m];
    let mut same = on.scene.clone();
    same.ramp = plane.ramp.clone();
    assert_eq!(same, off.scene);
    let [narrow, wide] = [&on.scene, plane].map(touch);
    for (narrow, wide) in narrow.into_iter().zip(wide) {
        let share = narrow / wide;
        assert!(
            (share / (1.0 - TAKEN_M / 100e-6) - 1.0).abs() < 1e-12,
            "{share}"
        );
    }
    let unequal = "clearance_bottom_um = 90.0\nrun_out = \"lowest_gap\"\n";
    let unequal = &study(&format!("{unequal}{RUN_OUT}")).points[0].scene;
    for (x, y) in gaps(unequal).into_iter().zip([100e-6, 90e-6]) {
        assert!((x / (y - TAKEN_M) - 1.0).abs() < 1e-14, "{x:e}");
    }
    let waves = format!("{RUN_OUT}waves = [{{ harmonic = 9, amplitude_nm = 200.0 }}]\n");
    let wavy = &study(&format!("run_out = \"lowest_gap\"\n{waves}")).points[0];
    assert!((wavy.gap_taken_m / (TAKEN_M + 0.2e-6) - 1.0).abs() < 1e-14);
}

/// The disk's shape turns past the ramp while the shock moves it. Of all angles that the disk may have at the onset, the
/// one that touches first does so at the amplitude of the lowest gap; no angle touches earlier.
#[test]
fn no_angle_of_the_disk_at_the_onset_touches_earlier() {
    let bound = touch(&study(&format!("run_out = \"lowest_gap\"\n{RUN_OUT}")).points[0].scene);
    let mut free = study("").points[0].scene.clone();
    let ramp = free.ramp.clone();
    free.ramp.model = NoRamp.into();
    let plan = Plan::new(&[Output::DiskDisplacement], Mode::Auto);
    let (_, outcome) = pairs::run(&free, &plan, 1.0, None);
    let columns = &outcome.history.as_ref().unwrap().structure;
    let spin = free.disk.spin_rad_per_s;
    for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
        let first = |phase: f64| {
            let times = columns.time_s.iter().zip(&columns.disk_ramp_m);
            let amplitudes = times.flat_map(|(t, w)| {
                let shape = TAKEN_M * (ramp.angle_rad - spin * t + phase).cos();
                let up = sign * w / G;
                [
                    (ramp.clearance_top_m - shape, up),
                    (ramp.clearance_bottom_m + shape, -up),
                ]
            });
            let closing = amplitudes.filter(|(_, closing)| *closing > 0.0);
            closing
                .map(|(gap_m, closing)| gap_m / closing)
                .fold(f64::INFINITY, f64::min)
        };
        let n = 720;
        let found: Vec<f64> = (0..n)
            .map(|i| first(TAU * f64::from(i) / f64::from(n)))
            .collect();
        let lowest = found.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = found.iter().copied().fold(0.0, f64::max);
        println!(
            "{:.4} to {:.4} G, {:.4} at the lowest gap",
            lowest / G,
            highest / G,
            bound[k] / G
        );
        // Nodes of the history and steps of the angle miss the peak by less.
        assert!(
            (0.0..1e-4).contains(&(lowest / bound[k] - 1.0 + 1e-9)),
            "{}",
            lowest / bound[k]
        );
        // Another angle gains what this one loses: its first touch is that of a plane disk, or later.
        assert!(highest > bound[k] * (1.0 + TAKEN_M / ramp.clearance_top_m));
    }
}

/// The row of `explain`, and a key without effect.
#[test]
fn the_lowest_gap_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let state = |more: &str| {
        std::fs::write(at.join("study.toml"), format!("{DRIVE}{more}")).unwrap();
        let path = at.join("study.toml");
        let reported = Done::of(at, &["explain", path.to_str().unwrap(), "--json"]).json();
        let rows = reported["scenes"][0]["effects"].as_array().unwrap().clone();
        let row = rows
            .into_iter()
            .find(|row| row["effect"] == "ramp.lowest_gap");
        row.unwrap()["state"].as_str().unwrap().to_owned()
    };
    assert_eq!(state(RUN_OUT), "off");
    assert_eq!(state(&format!("run_out = \"lowest_gap\"\n{RUN_OUT}")), "on");
    let idle = study("run_out = \"lowest_gap\"\n");
    assert!(idle.remarks.iter().any(|remark| remark.code == "N116"));
}
