//! Tests of searches that differ in the clearance called failure alone.

use super::{fails, settings};
use crate::search::campaign::{Campaign, Touch};
use crate::search::order::{Coordinates, Ramp};
use crate::search::outcome::Status;
use crate::search::probe::{Sign, Verdict};

const CLEARANCES_NM: [f64; 4] = [0.0, 0.3, 0.6, 1.0];

fn points(clearances_nm: &[f64]) -> Vec<Coordinates> {
    let mut points = Vec::new();
    for &clearance_nm in clearances_nm {
        for ramp in [Ramp::None, Ramp::Deformable] {
            for pulse_ms in [0.5, 1.0, 2.0] {
                for sign in [Sign::Plus, Sign::Minus] {
                    points.push(Coordinates {
                        ramp,
                        pulse_ms,
                        sign,
                        // The first is another axis.
                        axes: vec!["4".to_owned(), format!("{clearance_nm:.1}")],
                        round: 0,
                        fail_below_m: 1e-9 * clearance_nm,
                        clearance_axis: Some(1),
                    });
                }
            }
        }
    }
    points
}

/// Smallest clearance of a shock, m: falls on a curve, with a dip for the deformable ramp and sign - at 0.5 ms and, a `narrow` one,
/// at 1 ms.
fn law(at: &Coordinates, amplitude_g: f64, narrow: bool) -> f64 {
    let own = if at.sign == Sign::Plus { 500.0 } else { 420.0 };
    let critical_g = match at.ramp {
        Ramp::None => 1.3 * own * at.pulse_ms.powf(0.4),
        _ => own * at.pulse_ms.powf(0.3),
    };
    let (low_g, high_g) = match at.pulse_ms {
        0.5 => (230.0, 300.0),
        1.0 if narrow => (258.0, 271.0),
        _ => (0.0, 0.0),
    };
    let is_dip = at.ramp == Ramp::Deformable
        && at.sign == Sign::Minus
        && (low_g..high_g).contains(&amplitude_g);
    4e-9 * (1.0 - (amplitude_g / critical_g).powi(2)) - if is_dip { 3.5e-9 } else { 0.0 }
}

/// Searches all points by their smallest clearance, m.
fn searched(
    points: &[Coordinates],
    clearance_m: impl Fn(&Coordinates, f64) -> f64,
    choose: impl FnMut(usize) -> usize,
) -> Campaign {
    let touch = |at: &Coordinates| match at.ramp {
        Ramp::None => Touch::NoRamp,
        _ => Touch::At { onset_g: 150.0 },
    };
    let law = |at: &Coordinates, _, amplitude_g: f64| {
        let h_m = clearance_m(at, amplitude_g);
        if h_m < at.fail_below_m {
            (fails(), Some(at.fail_below_m))
        } else {
            (Verdict::Survives, Some(h_m))
        }
    };
    super::searched(points, touch, law, choose)
}

#[test]
fn larger_clearances_start_from_the_runs_of_smaller_ones_and_keep_their_answers() {
    let all = points(&CLEARANCES_NM);
    let together = searched(&all, |at, a| law(at, a, false), |_| 0);
    let mut runs = [0, 0];
    for (k, clearance_nm) in CLEARANCES_NM.into_iter().enumerate() {
        let own = points(&[clearance_nm]);
        let alone = searched(&own, |at, a| law(at, a, false), |_| 0);
        for (place, at) in own.iter().enumerate() {
            let found = [
                together.findings(k * own.len() + place),
                alone.findings(place),
            ];
            let [a, b] = found.each_ref().map(|f| (f.survivor, f.failure, f.status));
            assert_eq!(a, b, "{at:?}");
            runs[0] += found[0].runs;
            runs[1] += if k == 0 { found[1].runs } else { 0 };
        }
    }
    // The bound of the whole: four clearances for two and a half times the runs of one.
    assert!(2 * runs[0] <= 5 * runs[1], "{runs:?}");
}

#[test]
fn both_ends_of_every_bracket_have_a_run_of_their_own() {
    let all = points(&CLEARANCES_NM);
    let together = searched(&all, |at, a| law(at, a, true), |_| 0);
    for (point, at) in all.iter().enumerate() {
        let Some(search) = together.search(point) else {
            continue;
        };
        let found = together.findings(point);
        for end in [found.survivor, found.failure] {
            let mut own = search.log().iter().map(|asked| asked.probe);
            assert!(own.any(|probe| Some(probe.index) == end), "{at:?}");
        }
    }
}

/// A failure that one width has from the other, after its own scan has missed it, is one at every larger clearance.
#[test]
fn critical_shocks_never_rise_with_the_clearance_called_failure() {
    let all = points(&CLEARANCES_NM);
    let together = searched(&all, |at, a| law(at, a, true), |_| 0);
    let per_clearance = all.len() / CLEARANCES_NM.len();
    let failure = |point: usize| together.findings(point).failure.expect("fails");
    let mut narrow = 0;
    for (smaller, at) in all[per_clearance..].iter().enumerate() {
        let point = smaller + per_clearance;
        assert!(failure(point) <= failure(smaller), "{at:?}");
        let grid = settings().grid;
        narrow += usize::from((255.0..275.0).contains(&grid.amplitude_g(failure(point))));
    }
    assert!(narrow > 0, "no answer is in the narrow interval");
}

#[test]
fn any_order_of_answers_gives_the_same_probes() {
    let all = points(&CLEARANCES_NM);
    let reference = searched(&all, |at, a| law(at, a, true), |_| 0);
    for seed in 1..20 {
        let mut state = seed;
        let other = searched(
            &all,
            |at, a| law(at, a, true),
            |n| {
                state = (state * 48271) % 2_147_483_647;
                state % n
            },
        );
        for (point, at) in all.iter().enumerate() {
            let logs = [&other, &reference].map(|c| c.search(point).map(|s| s.log().to_vec()));
            assert_eq!(logs[0], logs[1], "{at:?}");
        }
    }
}

/// Both signs fail at the start of the range when 0.9 nm is called failure, which the slider never has.
#[test]
fn a_clearance_that_is_never_reached_is_below_the_range_by_a_run_of_its_own() {
    let all = points(&[0.0, 0.9]);
    let flat = |_: &Coordinates, a: f64| 0.8e-9 * (1.0 - (a / 500.0).powi(2));
    let together = searched(&all, flat, |_| 0);
    let n = all.len() / 2;
    for (point, at) in all
        .iter()
        .enumerate()
        .filter(|(_, at)| at.ramp == Ramp::None)
    {
        let found = together.findings(point);
        let expected = if point < n {
            Status::Ok
        } else {
            Status::BelowRange
        };
        assert_eq!(found.status, expected, "{at:?}");
        let low = settings().range.low;
        let log = together.search(point).expect("searches").log();
        let own = log.iter().any(|asked| asked.probe.index == low);
        assert!(point < n || own, "{at:?}");
    }
}
