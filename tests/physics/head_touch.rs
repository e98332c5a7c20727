//! A slider that touches the disk: found between steps, in time and place, and never by a number that is NaN.

use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::head::{Cause, HeadModel, HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_tests::heads::{
    SingleModeDisk, SuddenDisk, default_film, default_head, default_resolution, default_slider,
    head_on,
};
use opshock_tests::suspensions::default_suspension;
use std::sync::Arc;

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 2e-3,
};
const NO_LOAD: ShockLoad<'static> = ShockLoad {
    base: None,
    pulse: &PULSE,
    amplitude_m_per_s2: 0.0,
};
const G: f64 = 9.80665;

/// Independent prototype, about 10 nm up: 0.05 m/s of sudden disk velocity leaves 0.3 nm, 0.1 m/s
/// touches within 0.2 us. Our film flies up to a nanometre lower, so the velocity that leaves that much
/// is tested to lie within 20 % of its value, and 0.2 nm will do.
#[test]
fn sudden_disk_velocity_closes_the_gap_or_touches() {
    let model = default_head(528, &default_resolution());
    let mut workspace = HeadWorkspace::new(&model);
    let mut at = |velocity_m_per_s: f64| {
        let disk = SuddenDisk { velocity_m_per_s };
        model.run(&disk, &NO_LOAD, 2e-6, true, false, &mut workspace)
    };
    let slow = at(0.04);
    assert_eq!(slow.verdict, Verdict::Survives);
    assert!(
        slow.min_clearance_m > 0.2e-9 && slow.min_clearance_m < 2e-9,
        "{:e}",
        slow.min_clearance_m
    );
    let faster = at(0.06);
    assert!(
        matches!(faster.verdict, Verdict::Fails { .. }),
        "{:?}",
        faster.verdict
    );
    let run = at(0.1);
    let Verdict::Fails { t_fail_s, .. } = run.verdict else {
        panic!("{:?}", run.verdict)
    };
    assert!(
        t_fail_s > model.steady_clearance_m() / 0.1,
        "no sooner than under a slider that stays where it is"
    );
    assert!(t_fail_s < 0.2e-6, "{t_fail_s:e}");
}

#[test]
fn hard_e2_time_of_touch_converges_with_the_tolerance() {
    let (film, flight) = default_film(300);
    let fast = SuddenDisk {
        velocity_m_per_s: 0.1,
    };
    let times: Vec<f64> = [1e-2, 1e-3, 1e-5]
        .into_iter()
        .map(|tolerance| {
            let mut resolution = default_resolution();
            resolution.tolerance = tolerance;
            resolution.coupling_tolerance = 0.1 * tolerance;
            let model = head_on(&film, &flight, &resolution);
            let run = model.run(
                &fast,
                &NO_LOAD,
                2e-6,
                true,
                false,
                &mut HeadWorkspace::new(&model),
            );
            match run.verdict {
                Verdict::Fails { t_fail_s, .. } => t_fail_s,
                other => panic!("{other:?}"),
            }
        })
        .collect();
    assert!((times[0] / times[2] - 1.0).abs() < 1e-2, "{times:?}");
    assert!((times[1] / times[2] - 1.0).abs() < 1e-3, "{times:?}");
}

/// Going on after touch keeps the verdict of the first touch, and ends with the window.
#[test]
fn going_on_after_touch_keeps_the_first_touch() {
    let model = default_head(300, &default_resolution());
    let mut workspace = HeadWorkspace::new(&model);
    let disk = SingleModeDisk::new(900.0 * G, 2e-3);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: 900.0 * G,
    };
    let stopped = model.run(&disk, &load, 0.8e-3, true, false, &mut workspace);
    let gone_on = model.run(&disk, &load, 0.8e-3, false, false, &mut workspace);
    assert!(
        matches!(stopped.verdict, Verdict::Fails { .. }),
        "{:?}",
        stopped.verdict
    );
    assert_eq!(stopped.verdict, gone_on.verdict);
    assert!(gone_on.end_s > stopped.end_s);
}

/// A run that stops at touch ends with the touch: smallest clearance, its time and place, the end
/// of the run and the last row are one instant, between two steps of the run that goes on, which has it too.
#[test]
fn a_run_that_stops_ends_at_the_instant_of_touch() {
    let (film, flight) = default_film(300);
    let amplitude_m_per_s2 = 900.0 * G;
    let disk = SingleModeDisk::new(amplitude_m_per_s2, 2e-3);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2,
    };
    for fail_below_m in [0.0, 1e-9] {
        let model = HeadModel::build(
            &default_suspension(),
            &default_slider(),
            Arc::clone(&film),
            Arc::clone(&flight),
            &default_resolution(),
            fail_below_m,
        )
        .expect("head builds");
        let mut workspace = HeadWorkspace::new(&model);
        let run = model.run(&disk, &load, 0.8e-3, true, true, &mut workspace);
        let Verdict::Fails { t_fail_s, place } = run.verdict else {
            panic!("{:?}", run.verdict)
        };
        assert_eq!(run.min_clearance_m, fail_below_m);
        assert_eq!(run.t_min_clearance_s, t_fail_s);
        assert_eq!(run.place, place);
        assert_eq!(run.end_s, t_fail_s);
        let columns = run.columns.expect("recorded");
        let rows = columns.time_s.len();
        assert_eq!(columns.time_s[rows - 1], t_fail_s);
        assert_eq!(columns.min_clearance_m[rows - 1], fail_below_m);
        assert!(columns.time_s.windows(2).all(|pair| pair[0] < pair[1]));
        let (last, earlier) = columns.min_clearance_m.split_last().expect("rows");
        assert!(earlier.iter().all(|h| h > last), "no row below the limit");

        // A run that goes on has the same rows up to the touch, the touch included, and the same
        // numbers but for its cost.
        let mut gone_on = model.run(&disk, &load, 0.8e-3, false, true, &mut workspace);
        let other = gone_on.columns.take().expect("recorded");
        assert_eq!(columns.time_s, other.time_s[..rows]);
        assert_eq!(columns.slider_z_m, other.slider_z_m[..rows]);
        assert_eq!(columns.bearing_force_n, other.bearing_force_n[..rows]);
        assert!(other.time_s.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(
            other.min_clearance_m[rows..]
                .iter()
                .any(|h| *h < fail_below_m)
        );
        assert_eq!((gone_on.end_s, &gone_on.broke_off), (0.8e-3, &None));
        assert_eq!(
            gone_on.cost.steps as usize,
            other.time_s.len() - 2,
            "start and touch"
        );
        assert!(gone_on.cost.steps > run.cost.steps);
        let own = HeadRun {
            end_s: run.end_s,
            columns: Some(columns.clone()),
            cost: run.cost,
            ..gone_on
        };
        assert_eq!(
            own,
            HeadRun {
                columns: Some(columns.clone()),
                ..run
            }
        );
        // Film and slider at the touch are those of a moment between the rows around.
        let between = |column: &[f64]| {
            let (a, x, b) = (column[rows - 2], column[rows - 1], column[rows]);
            let slack = 0.1 * (b - a).abs();
            assert!(
                x >= a.min(b) - slack && x <= a.max(b) + slack,
                "{a} {x} {b}"
            );
        };
        between(&other.slider_z_m);
        between(&other.bearing_force_n);
    }
}

/// A disk that is not a number from `broken_from_s` on.
struct BreakingDisk {
    under: SingleModeDisk,
    broken_from_s: f64,
}

impl DiskMotion for BreakingDisk {
    fn pose(&self, t: f64) -> DiskPose {
        match t > self.broken_from_s {
            true => DiskPose {
                displacement_m: f64::NAN,
                ..DiskPose::default()
            },
            false => self.under.pose(t),
        }
    }
    fn pose_rate(&self, t: f64) -> DiskPose {
        self.under.pose_rate(t)
    }
    fn events_s(&self) -> &[f64] {
        self.under.events_s()
    }
}

/// What breaks a run behind its first touch, or ends it there, leaves the answer as it was.
#[test]
fn a_breakdown_behind_the_touch_changes_no_answer() {
    let amplitude_m_per_s2 = 900.0 * G;
    let disk = |broken_from_s: f64| BreakingDisk {
        under: SingleModeDisk::new(amplitude_m_per_s2, 2e-3),
        broken_from_s,
    };
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2,
    };
    let run = |disk: &BreakingDisk, max_steps: u64, stops: bool| {
        let mut resolution = default_resolution();
        resolution.max_steps = max_steps;
        let model = default_head(300, &resolution);
        model.run(
            disk,
            &load,
            0.8e-3,
            stops,
            false,
            &mut HeadWorkspace::new(&model),
        )
    };
    let whole = disk(f64::INFINITY);
    let stopped = run(&whole, 200_000, true);
    let Verdict::Fails { t_fail_s, .. } = stopped.verdict else {
        panic!("{:?}", stopped.verdict)
    };
    let n_steps = stopped.cost.steps + stopped.cost.rejected;
    let broken = run(&disk(t_fail_s + 2e-5), 200_000, false);
    let limited = run(&whole, n_steps + 5, false);
    for gone_on in [&broken, &limited] {
        assert!(gone_on.end_s > t_fail_s && gone_on.end_s < t_fail_s + 2.1e-5);
        let reported = |run: &HeadRun| {
            (
                run.min_clearance_m,
                run.t_min_clearance_s,
                run.place,
                run.dimple,
            )
        };
        assert_eq!(gone_on.verdict, stopped.verdict);
        assert_eq!(reported(gone_on), reported(&stopped));
        assert!(gone_on.broke_off.is_some() && stopped.broke_off.is_none());
    }
    assert_eq!(limited.cost.steps + limited.cost.rejected, n_steps + 5);
}

struct BrokenDisk;

impl DiskMotion for BrokenDisk {
    fn pose(&self, t: f64) -> DiskPose {
        let displacement_m = if t > 1e-4 { f64::NAN } else { 0.0 };
        DiskPose {
            displacement_m,
            ..DiskPose::default()
        }
    }
    fn pose_rate(&self, _: f64) -> DiskPose {
        DiskPose::default()
    }
    fn events_s(&self) -> &[f64] {
        &[]
    }
}

#[test]
fn hard_e4_not_a_number_is_never_a_verdict() {
    let model = default_head(300, &default_resolution());
    let run = model.run(
        &BrokenDisk,
        &NO_LOAD,
        1e-3,
        true,
        false,
        &mut HeadWorkspace::new(&model),
    );
    let Verdict::Undecided { cause } = run.verdict else {
        panic!("{:?}", run.verdict)
    };
    assert!(
        matches!(cause, Cause::NotFinite { .. } | Cause::NotConverged { .. }),
        "{cause:?}"
    );
    assert!(run.end_s <= 1.001e-4);
}
