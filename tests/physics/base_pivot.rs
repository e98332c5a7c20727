//! A suspension whose pivot moves, given as a motion and as a load.

use std::f64::consts::TAU;

use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::head::{HeadWorkspace, ShockLoad};
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::simulation::Model;
use opshock_tests::pairs::coarse;
use opshock_tests::scenes;

/// A disk at a given height, under a suspension whose pivot moves.
pub(super) struct MovedPivot {
    /// Height of the disk and motion of the pivot at a time.
    pub(super) disk_m: fn(f64) -> [f64; 2],
    pub(super) pivot_m: fn(f64) -> [f64; 2],
    pub(super) events_s: Vec<f64>,
}

impl DiskMotion for MovedPivot {
    fn pose(&self, time_s: f64) -> DiskPose {
        DiskPose {
            displacement_m: (self.disk_m)(time_s)[0],
            ..DiskPose::default()
        }
    }

    fn pose_rate(&self, time_s: f64) -> DiskPose {
        DiskPose {
            displacement_m: (self.disk_m)(time_s)[1],
            ..DiskPose::default()
        }
    }

    fn events_s(&self) -> &[f64] {
        &self.events_s
    }

    fn pivot(&self, time_s: f64) -> [f64; 2] {
        (self.pivot_m)(time_s)
    }
}

/// Period of the pivot's swing, s.
const SWING_S: f64 = 2.5e-4;

/// (1 − cos) swings of 3 um from 0.1 ms on, (displacement, velocity).
pub(super) fn swung(time_s: f64) -> [f64; 2] {
    let omega = TAU / SWING_S;
    let t = (time_s - 1e-4).max(0.0);
    [
        1.5e-6 * (1.0 - (omega * t).cos()),
        1.5e-6 * omega * (omega * t).sin(),
    ]
}

/// An impact that gives the pivot 4 mm/s from 0.2 ms on, for 0.1 ms.
fn struck(time_s: f64) -> [f64; 2] {
    let speed = 4e-3;
    let t = (time_s - 2e-4).clamp(0.0, 1e-4);
    let is_moving = (2e-4..3e-4).contains(&time_s);
    [speed * t, if is_moving { speed } else { 0.0 }]
}

/// The pivot's motion given as such, or as a load −ü and a disk that moves the other way: the same clearance.
/// An impact, for which there is no load, is given as one of 10 ns.
#[test]
fn a_pivot_that_moves_is_a_load_and_a_jump_of_its_velocity_a_short_one() {
    let mut scene = coarse(scenes::scene("fig13-stiffness", "none", 0.5, &[]));
    scene.head_resolution.tolerance = 1e-3;
    let plan = Plan::new(&[Output::MinClearance], Mode::Auto);
    let model = Model::assemble(&scene, &plan, None).expect("builds");
    let head = model.head().expect("a head");
    let rest = |_: f64| [0.0; 2];
    let run = |motion: &MovedPivot, pulse: &Pulse, amplitude_m_per_s2: f64| {
        let load = ShockLoad {
            pulse,
            amplitude_m_per_s2,
            base: None,
        };
        let mut workspace = HeadWorkspace::new(head);
        let run = head.run(motion, &load, 5e-4, false, true, &mut workspace);
        (run.min_clearance_m, run.dimple.min_force_n)
    };
    let table = |time_s: Vec<f64>, relative: Vec<f64>| Pulse {
        width_s: time_s[time_s.len() - 1],
        shape: PulseShape::Table { time_s, relative },
    };
    // ü of the swings, and of an impact as triangles of 10 ns.
    let omega = TAU / SWING_S;
    let fine: Vec<f64> = (0..=2000).map(|k| 2.5e-7 * f64::from(k)).collect();
    let swings = fine.iter().map(|&t| match t < 1e-4 {
        true => 0.0,
        false => -1.5e-6 * omega * omega * (omega * (t - 1e-4)).cos(),
    });
    let swings = table(fine.clone(), swings.collect());
    let around = |at: f64| [at - 1e-8, at, at + 1e-8];
    let times = [&[0.0][..], &around(2e-4), &around(3e-4)].concat();
    let blow = table(times, vec![0.0, 0.0, -4e5, 0.0, 0.0, 4e5, 0.0]);
    let against: [fn(f64) -> [f64; 2]; 2] = [|t| swung(t).map(|x| -x), |t| struck(t).map(|x| -x)];
    let quiet = run(
        &MovedPivot {
            disk_m: rest,
            pivot_m: rest,
            events_s: vec![0.0],
        },
        &swings,
        0.0,
    );
    let reported: [fn(f64) -> [f64; 2]; 2] = [swung, struck];
    for (k, (pulse, allowed)) in [(&swings, 5e-3), (&blow, 5e-2)].into_iter().enumerate() {
        let events_s = vec![0.0, 1e-4, 2e-4, 3e-4];
        let moved = MovedPivot {
            disk_m: rest,
            pivot_m: reported[k],
            events_s: events_s.clone(),
        };
        let shaken = MovedPivot {
            disk_m: against[k],
            pivot_m: rest,
            events_s,
        };
        let (a, b) = (run(&moved, pulse, 0.0), run(&shaken, pulse, 1.0));
        println!("still {quiet:?}, moved {a:?}, shaken {b:?}");
        // In changes from rest, of the clearance and of the dimple's force.
        let change = (quiet.0 - b.0, quiet.1 - b.1);
        assert!(change.0 > 0.04 * quiet.0 && change.1 > 0.02 * quiet.1);
        assert!((a.0 - b.0).abs() < allowed * change.0);
        assert!((a.1 - b.1).abs() < allowed * change.1);
    }
}
