//! Tests of the searches of all points of a study together.

use super::{fails, searched};
use crate::search::campaign::{Campaign, Touch};
use crate::search::order::{Coordinates, Ramp};
use crate::search::outcome::{Flag, Status};
use crate::search::point::Asked;
use crate::search::probe::{Probe, Purpose, Sign, Verdict};

fn campaign(
    points: &[Coordinates],
    touch: impl Fn(&Coordinates) -> Touch,
    law: impl Fn(&Coordinates, Probe, f64) -> Verdict,
    choose: impl FnMut(usize) -> usize,
) -> Campaign {
    searched(
        points,
        touch,
        |at, probe, a| (law(at, probe, a), None),
        choose,
    )
}

fn study(ramps: &[Ramp], widths: &[f64]) -> Vec<Coordinates> {
    let mut points = Vec::new();
    for &ramp in ramps {
        for &pulse_ms in widths {
            for sign in [Sign::Plus, Sign::Minus] {
                points.push(Coordinates {
                    ramp,
                    pulse_ms,
                    sign,
                    axes: Vec::new(),
                    round: 0,
                    fail_below_m: 0.0,
                    clearance_axis: None,
                });
            }
        }
    }
    points
}

const WIDTHS: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];

/// A study shaped like the paper's: non-monotone intervals for the deformable ramp at short widths.
fn law(at: &Coordinates, amplitude_g: f64) -> Verdict {
    let sign = if at.sign == Sign::Plus { 1.0 } else { 0.8 };
    let none = 500.0 * sign * at.pulse_ms.powf(-0.2);
    let fails_here = match at.ramp {
        Ramp::None => amplitude_g >= none,
        Ramp::Rigid => amplitude_g >= 210.0 * at.pulse_ms.powf(-0.3) || amplitude_g >= none,
        Ramp::Deformable => {
            let window = at.pulse_ms < 0.9
                && at.sign == Sign::Plus
                && (150.0..150.0 + 24.0 * at.pulse_ms).contains(&amplitude_g);
            window || amplitude_g >= 300.0 * sign * at.pulse_ms.powf(0.1)
        }
    };
    if fails_here {
        fails()
    } else {
        Verdict::Survives
    }
}

fn touch(at: &Coordinates) -> Touch {
    match at.ramp {
        Ramp::None => Touch::NoRamp,
        Ramp::Rigid => Touch::At { onset_g: 120.0 },
        Ramp::Deformable => Touch::At { onset_g: 110.0 },
    }
}

#[test]
fn any_order_of_answers_gives_the_same_probes_and_rows() {
    let points = study(&Ramp::ALL, &WIDTHS);
    let reference = campaign(&points, touch, |at, _, a| law(at, a), |_| 0);
    let mut state = 12345_u64;
    for _ in 0..20 {
        let other = campaign(
            &points,
            touch,
            |at, _, a| law(at, a),
            |n| {
                state = state
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                (state >> 33) as usize % n
            },
        );
        for point in 0..points.len() {
            assert_eq!(other.findings(point), reference.findings(point));
            let logs = [&other, &reference].map(|c| c.search(point).map(|s| s.log().to_vec()));
            assert_eq!(logs[0], logs[1]);
        }
    }
    let runs: u64 = (0..points.len())
        .map(|point| reference.findings(point).runs)
        .sum();
    assert!(runs <= 36 * 18, "{runs} runs");
}

#[test]
fn a_window_found_at_one_width_is_followed_to_the_next() {
    // The narrow non-monotone interval at 0.5 ms, searched first, falls between the scanned grid points there; at 0.6
    // ms it is wide.
    let points = study(&[Ramp::None, Ramp::Deformable], &[0.5, 0.6]);
    let window = |at: &Coordinates| {
        if at.pulse_ms > 0.55 {
            150.0..175.0
        } else {
            160.5..165.5
        }
    };
    let law = |at: &Coordinates, _: Probe, a: f64| {
        let late = at.ramp == Ramp::Deformable && at.sign == Sign::Plus;
        if a >= 400.0 || (late && (window(at).contains(&a) || a >= 300.0)) {
            fails()
        } else {
            Verdict::Survives
        }
    };
    let done = campaign(&points, touch, law, |_| 0);
    let grid = done.settings().grid;
    for (point, at) in points.iter().enumerate() {
        if at.ramp == Ramp::Deformable && at.sign == Sign::Plus {
            let findings = done.findings(point);
            assert_eq!(
                findings.failure,
                Some(grid.at_or_above(window(at).start)),
                "{at:?}"
            );
            let log = done.search(point).expect("searched").log();
            let met = |asked: &Asked| law(at, asked.probe, grid.amplitude_g(asked.probe.index));
            let survivor_above = log.iter().any(|asked| {
                met(asked) == Verdict::Survives && Some(asked.probe.index) > findings.failure
            });
            assert_eq!(findings.flags.contains(&Flag::NonMonotone), survivor_above);
        }
    }
    let followed = (0..points.len())
        .filter_map(|point| done.search(point))
        .flat_map(|search| search.log())
        .filter(|asked| asked.purpose == Purpose::FollowUp)
        .count();
    assert!(followed > 0, "the window was met by the scan itself");
}

#[test]
fn a_ramp_out_of_reach_costs_nothing() {
    let points = study(&Ramp::ALL[..2], &WIDTHS);
    let far = |at: &Coordinates| match at.ramp {
        Ramp::None => Touch::NoRamp,
        _ => Touch::At { onset_g: 900.0 },
    };
    let done = campaign(&points, far, |at, _, a| law(at, a), |n| n - 1);
    let order = done.order();
    for (point, at) in points.iter().enumerate() {
        if at.ramp == Ramp::Rigid {
            let findings = done.findings(point);
            let none = done.findings(order.relations[point].companion.expect("companion"));
            assert_eq!(findings.runs, 0);
            assert_eq!(findings.failure, none.failure);
            assert_eq!(findings.survivor, none.survivor);
            assert_eq!(findings.status, Status::Ok);
            assert!(findings.flags.contains(&Flag::NoTouch));
        }
    }
}

#[test]
fn without_the_amplitude_of_first_touch_nothing_is_inherited() {
    let points = study(&Ramp::ALL[..2], &[1.0]);
    let done = campaign(&points, |_| Touch::Unknown, |at, _, a| law(at, a), |_| 0);
    for point in 0..points.len() {
        let findings = done.findings(point);
        assert_eq!(findings.status, Status::Ok);
        assert!(findings.flags.contains(&Flag::OnsetUnknown));
        assert!(findings.runs > 0);
    }
}
