//! Tests of the search of one point.

use super::{fails, settings};
use crate::search::outcome::{Flag, Status};
use crate::search::point::{PointSearch, Start};
use crate::search::probe::{Probe, Purpose, Retry, UndecidedCause, Verdict};
use crate::search::settings::{MonotonicityScan, SearchSettings};

fn undecided() -> Verdict {
    Verdict::Undecided {
        cause: UndecidedCause::NotConverged,
        message: String::new(),
    }
}

fn from(hint_g: Option<f64>, onset_index: Option<i32>) -> Start {
    Start {
        hint_g,
        onset_index,
        width_rank: 0,
        fail_below_m: 0.0,
    }
}

/// Runs a search against a law of (probe, amplitude in G).
fn run(mut search: PointSearch, law: impl Fn(Probe, f64) -> Verdict) -> PointSearch {
    let grid = settings().grid;
    while let Some(asked) = search.ask() {
        assert!(search.log().len() < 2000, "endless search");
        search.tell(&law(asked.probe, grid.amplitude_g(asked.probe.index)));
    }
    search
}

fn threshold(critical_g: f64) -> impl Fn(Probe, f64) -> Verdict {
    move |_, amplitude_g| {
        if amplitude_g < critical_g {
            Verdict::Survives
        } else {
            fails()
        }
    }
}

#[test]
fn every_threshold_is_bracketed_by_neighbouring_grid_points() {
    let settings = settings();
    let grid = settings.grid;
    for step in 0..400 {
        let critical_g = 21.0 * 1.0114_f64.powi(step);
        for hint_g in [None, Some(critical_g * 0.93), Some(critical_g * 1.3)] {
            let search = run(
                PointSearch::new(settings, from(hint_g, None)),
                threshold(critical_g),
            );
            let findings = search.findings();
            assert_eq!(findings.status, Status::Ok);
            let (low, high) = (
                findings.survivor.expect("survivor"),
                findings.failure.expect("failure"),
            );
            assert_eq!(high - low, 1);
            assert!(grid.amplitude_g(low) < critical_g);
            assert!(grid.amplitude_g(high) >= critical_g);
            assert!(findings.flags.is_empty());
            assert!(findings.largest_gap.expect("scanned") > 0);
        }
    }
}

#[test]
fn probes_stay_few_with_a_hint_and_a_scan_of_one_octave() {
    let settings = settings();
    let onset = settings.grid.at_or_above(100.0);
    let mut most = 0;
    for step in 0..200 {
        let critical_g = 110.0 + f64::from(step) * 0.5;
        for off in [0.9, 0.97, 1.0, 1.03, 1.1] {
            let search = run(
                PointSearch::new(settings, from(Some(critical_g * off), Some(onset))),
                threshold(critical_g),
            );
            most = most.max(search.findings().runs);
            assert!(search.findings().largest_gap <= Some(settings.scan_gap));
        }
    }
    assert!(most <= 19, "{most} probes");
}

#[test]
fn below_first_touch_nothing_is_run() {
    let settings = settings();
    let onset = settings.grid.at_or_above(100.0);
    let search = run(
        PointSearch::new(settings, from(Some(103.0), Some(onset))),
        threshold(100.0),
    );
    let findings = search.findings();
    assert_eq!(findings.failure, Some(onset));
    assert_eq!(findings.survivor, Some(onset - 1));
    assert_eq!(findings.brackets, [(onset - 1, onset)]);
    assert!(search.log().iter().all(|asked| asked.probe.index >= onset
        || (asked.purpose == Purpose::Window && asked.probe.index == onset - 1)));
    assert!(findings.runs <= 5, "{}", findings.runs);
}

#[test]
fn nothing_to_find_is_an_answer() {
    let settings = settings();
    let never = run(PointSearch::new(settings, from(None, None)), |_, _| {
        Verdict::Survives
    });
    let findings = never.findings();
    assert_eq!(findings.status, Status::AboveRange);
    assert_eq!(findings.survivor, Some(settings.range.high));
    assert_eq!(findings.failure, None);

    let always = run(PointSearch::new(settings, from(None, None)), |_, _| fails());
    let findings = always.findings();
    assert_eq!(findings.status, Status::BelowRange);
    assert_eq!(findings.failure, Some(settings.range.low));
    assert_eq!(findings.survivor, None);
    assert!(findings.runs < 12);
}

#[test]
fn a_non_monotone_interval_below_the_bracket_becomes_the_answer() {
    let settings = settings();
    let grid = settings.grid;
    let onset = grid.at_or_above(100.0);
    let law = |_: Probe, a: f64| {
        if (130.0..146.0).contains(&a) || a >= 200.0 {
            fails()
        } else {
            Verdict::Survives
        }
    };
    let search = run(
        PointSearch::new(settings, from(Some(205.0), Some(onset))),
        law,
    );
    let findings = search.findings();
    assert_eq!(findings.status, Status::Ok);
    assert_eq!(findings.failure, Some(grid.at_or_above(130.0)));
    assert_eq!(findings.survivor, Some(grid.at_or_above(130.0) - 1));
    assert!(findings.flags.contains(&Flag::NonMonotone));
    assert_eq!(findings.brackets.len(), 2);
    assert_eq!(
        findings.brackets[1],
        (grid.at_or_above(200.0) - 1, grid.at_or_above(200.0))
    );
    // The naive answer is 54 % too high.
    let naive = SearchSettings {
        monotonicity_scan: MonotonicityScan::Off,
        ..settings
    };
    let search = run(PointSearch::new(naive, from(Some(205.0), Some(onset))), law);
    assert_eq!(search.findings().failure, Some(grid.at_or_above(200.0)));
}

#[test]
fn a_full_scan_finds_a_non_monotone_interval_of_one_grid_point() {
    let settings = SearchSettings {
        monotonicity_scan: MonotonicityScan::Full,
        ..settings()
    };
    let grid = settings.grid;
    let onset = grid.at_or_above(100.0);
    let lone = grid.at_or_above(121.0);
    let search = run(
        PointSearch::new(settings, from(Some(205.0), Some(onset))),
        |probe, a| {
            if probe.index == lone || a >= 200.0 {
                fails()
            } else {
                Verdict::Survives
            }
        },
    );
    assert_eq!(search.findings().failure, Some(lone));
    assert_eq!(search.findings().largest_gap, Some(1));
}

#[test]
fn retries_are_tried_in_order_and_marked() {
    let settings = settings();
    let sick = settings.grid.nearest(240.0);
    let search = run(
        PointSearch::new(settings, from(Some(230.0), None)),
        |probe, a| {
            if (probe.index - sick).abs() < 4 && probe.retry < Retry::OtherCoupling {
                undecided()
            } else {
                threshold(240.0)(probe, a)
            }
        },
    );
    let findings = search.findings();
    assert_eq!(findings.status, Status::Ok);
    assert_eq!(findings.failure, Some(settings.grid.at_or_above(240.0)));
    assert!(findings.flags.contains(&Flag::Retry));
    assert!(findings.flags.contains(&Flag::NotConverged));
    assert!(!findings.flags.contains(&Flag::UndecidedAmplitude));
    let retries: Vec<u8> = search.log().iter().map(|a| a.probe.retry.place()).collect();
    for pair in retries.windows(2) {
        assert!(pair[1] == pair[0] + 1 || pair[1] == 0, "{retries:?}");
    }
}

#[test]
fn undecided_grid_points_widen_the_bracket_and_never_move_it() {
    let settings = settings();
    let grid = settings.grid;
    let (first, last) = (grid.nearest(240.0) - 1, grid.nearest(240.0) + 1);
    let search = run(
        PointSearch::new(settings, from(Some(230.0), None)),
        |probe, a| {
            if (first..=last).contains(&probe.index) && probe.window_factor == 1 {
                undecided()
            } else {
                threshold(240.0)(probe, a)
            }
        },
    );
    let findings = search.findings();
    assert_eq!(findings.status, Status::Ok);
    assert_eq!(findings.survivor, Some(first - 1));
    assert_eq!(findings.failure, Some(last + 1));
    assert!(findings.flags.contains(&Flag::UndecidedAmplitude));
}

#[test]
fn a_point_without_verdicts_is_given_up() {
    let settings = settings();
    let search = run(
        PointSearch::new(settings, from(Some(230.0), None)),
        |_, _| undecided(),
    );
    let findings = search.findings();
    assert_eq!(findings.status, Status::Undecided);
    assert_eq!((findings.survivor, findings.failure), (None, None));
    assert_eq!(findings.runs, 25);
}

#[test]
fn a_late_failure_is_flagged_and_does_not_change_the_answer() {
    let settings = settings();
    let search = run(
        PointSearch::new(settings, from(Some(150.0), None)),
        |probe, a| {
            let critical = if probe.window_factor == 2 {
                140.0
            } else {
                150.0
            };
            threshold(critical)(probe, a)
        },
    );
    let findings = search.findings();
    assert_eq!(findings.failure, Some(settings.grid.at_or_above(150.0)));
    assert!(findings.flags.contains(&Flag::Window));
}

/// Numbers in [0, 1), the same at every run of the tests.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn any_landscape_ends_with_a_consistent_answer_and_wide_windows_are_found() {
    let settings = settings();
    let grid = settings.grid;
    for seed in 1..2000 {
        let mut random = random(seed);
        let onset_g = 60.0 + 200.0 * random();
        let critical_g = onset_g * (1.0 + 2.0 * random());
        let start_g = onset_g + (critical_g - onset_g) * random();
        let share = 0.3 * random();
        let window = start_g..(start_g * (1.0 + share)).min(critical_g);
        let sick = grid.nearest(onset_g * (1.0 + random()));
        let has_sick = random() < 0.3;
        let hint_g = (random() < 0.8).then(|| critical_g * (0.5 + random()));
        let onset = (random() < 0.8).then(|| grid.at_or_above(onset_g));
        let law = |probe: Probe, a: f64| {
            if has_sick && probe.index == sick && probe.retry < Retry::OtherContact {
                undecided()
            } else if a >= critical_g || window.contains(&a) {
                fails()
            } else {
                Verdict::Survives
            }
        };
        let search = run(PointSearch::new(settings, from(hint_g, onset)), law);
        let findings = search.findings();
        assert_eq!(findings.status, Status::Ok, "seed {seed}");
        let (survivor, failure) = (
            findings.survivor.expect("survivor"),
            findings.failure.expect("failure"),
        );
        assert_eq!(failure - survivor, 1, "seed {seed}");
        assert!(matches!(
            law(Probe::at(failure), grid.amplitude_g(failure)),
            Verdict::Fails { .. } | Verdict::Undecided { .. }
        ));
        assert!(findings.runs <= 45, "seed {seed}: {} runs", findings.runs);
        let n_window = grid.at_or_above(window.end) - grid.at_or_above(window.start);
        // Where the whole range is the point's own, the scan coarsens below 0.71 of the bracket.
        let is_fine = onset.is_some() || window.start > 0.75 * critical_g;
        if n_window >= settings.scan_gap && is_fine {
            let start = grid.at_or_above(window.start);
            assert_eq!(failure, start, "seed {seed}: {:?}", search.log());
        }
        if onset.is_some() {
            assert!(
                findings.largest_gap <= Some(settings.scan_gap),
                "seed {seed}"
            );
        }
    }
}
