//! Searches against answers that are known.

use super::campaign::{Campaign, Touch};
use super::order::{Coordinates, RampClass};
use super::outcome::{Flag, Status};
use super::point::{Asked, PointSearch, Start};
use super::probe::{Probe, Purpose, Retry, Sign, UndecidedCause, Verdict};
use super::settings::{Certify, SearchSettings};

fn settings() -> SearchSettings {
    SearchSettings::new((20.0, 2000.0), 0.01, Certify::Staggered, 0.10, true).expect("settings")
}

fn fails() -> Verdict {
    Verdict::Fails {
        t_fail_s: 1e-3,
        x_m: 0.0,
        y_m: 0.0,
    }
}

fn undecided() -> Verdict {
    Verdict::Undecided {
        cause: UndecidedCause::NotConverged,
        message: String::new(),
    }
}

fn from(hint_g: Option<f64>, onset_node: Option<i32>) -> Start {
    Start {
        hint_g,
        onset_node,
        width_rank: 0,
    }
}

/// Runs a search against a law of (probe, amplitude in G).
fn run(mut search: PointSearch, law: impl Fn(Probe, f64) -> Verdict) -> PointSearch {
    let lattice = settings().lattice;
    while let Some(asked) = search.ask() {
        assert!(search.log().len() < 2000, "endless search");
        search.tell(&law(asked.probe, lattice.amplitude_g(asked.probe.index)));
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
fn every_threshold_is_bracketed_by_neighbouring_nodes() {
    let settings = settings();
    let lattice = settings.lattice;
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
            assert!(lattice.amplitude_g(low) < critical_g);
            assert!(lattice.amplitude_g(high) >= critical_g);
            assert!(findings.flags.is_empty());
            assert!(findings.largest_gap.expect("scanned") > 0);
        }
    }
}

#[test]
fn probes_stay_few_with_a_hint_and_a_scan_of_one_octave() {
    let settings = settings();
    let onset = settings.lattice.at_or_above(100.0);
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
    let onset = settings.lattice.at_or_above(100.0);
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
fn a_window_of_failure_below_the_bracket_becomes_the_answer() {
    let settings = settings();
    let lattice = settings.lattice;
    let onset = lattice.at_or_above(100.0);
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
    assert_eq!(findings.failure, Some(lattice.at_or_above(130.0)));
    assert_eq!(findings.survivor, Some(lattice.at_or_above(130.0) - 1));
    assert!(findings.flags.contains(&Flag::NonMonotone));
    assert_eq!(findings.brackets.len(), 2);
    assert_eq!(
        findings.brackets[1],
        (lattice.at_or_above(200.0) - 1, lattice.at_or_above(200.0))
    );
    // The naive answer is 54 % too high.
    let naive = SearchSettings {
        certify: Certify::Off,
        ..settings
    };
    let search = run(PointSearch::new(naive, from(Some(205.0), Some(onset))), law);
    assert_eq!(search.findings().failure, Some(lattice.at_or_above(200.0)));
}

#[test]
fn a_full_scan_finds_a_window_of_one_node() {
    let settings = SearchSettings {
        certify: Certify::Full,
        ..settings()
    };
    let lattice = settings.lattice;
    let onset = lattice.at_or_above(100.0);
    let lone = lattice.at_or_above(121.0);
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
fn the_ladder_is_climbed_in_order_and_marked() {
    let settings = settings();
    let sick = settings.lattice.nearest(240.0);
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
    assert_eq!(findings.failure, Some(settings.lattice.at_or_above(240.0)));
    assert!(findings.flags.contains(&Flag::Retry));
    assert!(findings.flags.contains(&Flag::NotConverged));
    assert!(!findings.flags.contains(&Flag::UndecidedNode));
    let retries: Vec<u8> = search.log().iter().map(|a| a.probe.retry.level()).collect();
    for pair in retries.windows(2) {
        assert!(pair[1] == pair[0] + 1 || pair[1] == 0, "{retries:?}");
    }
}

#[test]
fn undecided_nodes_widen_the_bracket_and_never_move_it() {
    let settings = settings();
    let lattice = settings.lattice;
    let (first, last) = (lattice.nearest(240.0) - 1, lattice.nearest(240.0) + 1);
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
    assert!(findings.flags.contains(&Flag::UndecidedNode));
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
    assert_eq!(findings.failure, Some(settings.lattice.at_or_above(150.0)));
    assert!(findings.flags.contains(&Flag::Window));
}

/// Runs a campaign, always serving the point that `choose` picks among those that ask.
fn campaign(
    points: &[Coordinates],
    touch: impl Fn(&Coordinates) -> Touch,
    law: impl Fn(&Coordinates, Probe, f64) -> Verdict,
    mut choose: impl FnMut(usize) -> usize,
) -> Campaign {
    let settings = settings();
    let mut campaign = Campaign::new(settings, points);
    for (point, at) in points.iter().enumerate() {
        campaign.set_touch(point, touch(at));
    }
    while !campaign.is_done() {
        let asking: Vec<usize> = (0..points.len())
            .filter(|&point| campaign.ask(point).is_some())
            .collect();
        assert!(!asking.is_empty(), "nobody asks and nothing is final");
        let point = asking[choose(asking.len())];
        let probe = campaign.ask(point).expect("asks").probe;
        let amplitude_g = settings.lattice.amplitude_g(probe.index);
        campaign.tell(point, &law(&points[point], probe, amplitude_g));
    }
    campaign
}

fn study(ramps: &[(RampClass, &str)], widths: &[f64]) -> Vec<Coordinates> {
    let mut points = Vec::new();
    for &(ramp_class, ramp) in ramps {
        for &pulse_ms in widths {
            for sign in [Sign::Plus, Sign::Minus] {
                points.push(Coordinates {
                    ramp_class,
                    ramp: ramp.into(),
                    pulse_ms,
                    sign,
                    axes: Vec::new(),
                    round: 0,
                });
            }
        }
    }
    points
}

const RAMPS: [(RampClass, &str); 3] = [
    (RampClass::None, "none"),
    (RampClass::Rigid, "rigid"),
    (RampClass::Deformable, "deformable"),
];
const WIDTHS: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];

/// A study shaped like the paper's: windows of failure for the deformable ramp at short widths.
fn law(at: &Coordinates, amplitude_g: f64) -> Verdict {
    let sign = if at.sign == Sign::Plus { 1.0 } else { 0.8 };
    let none = 500.0 * sign * at.pulse_ms.powf(-0.2);
    let fails_here = match at.ramp_class {
        RampClass::None => amplitude_g >= none,
        RampClass::Rigid => amplitude_g >= 210.0 * at.pulse_ms.powf(-0.3) || amplitude_g >= none,
        RampClass::Deformable => {
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
    match at.ramp_class {
        RampClass::None => Touch::NoRamp,
        RampClass::Rigid => Touch::At { onset_g: 120.0 },
        RampClass::Deformable => Touch::At { onset_g: 110.0 },
    }
}

#[test]
fn any_order_of_answers_gives_the_same_probes_and_rows() {
    let points = study(&RAMPS, &WIDTHS);
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
    // The narrow window at 0.5 ms, searched first, falls between the scanned nodes there; at 0.6 ms
    // it is wide.
    let points = study(
        &[(RampClass::None, "none"), (RampClass::Deformable, "d")],
        &[0.5, 0.6],
    );
    let window = |at: &Coordinates| {
        if at.pulse_ms > 0.55 {
            150.0..175.0
        } else {
            160.5..165.5
        }
    };
    let law = |at: &Coordinates, _: Probe, a: f64| {
        let late = at.ramp_class == RampClass::Deformable && at.sign == Sign::Plus;
        if a >= 400.0 || (late && (window(at).contains(&a) || a >= 300.0)) {
            fails()
        } else {
            Verdict::Survives
        }
    };
    let done = campaign(&points, touch, law, |_| 0);
    let lattice = done.settings().lattice;
    for (point, at) in points.iter().enumerate() {
        if at.ramp_class == RampClass::Deformable && at.sign == Sign::Plus {
            let findings = done.findings(point);
            assert_eq!(
                findings.failure,
                Some(lattice.at_or_above(window(at).start)),
                "{at:?}"
            );
            let log = done.search(point).expect("searched").log();
            let met = |asked: &Asked| law(at, asked.probe, lattice.amplitude_g(asked.probe.index));
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
    let points = study(&RAMPS[..2], &WIDTHS);
    let far = |at: &Coordinates| match at.ramp_class {
        RampClass::None => Touch::NoRamp,
        _ => Touch::At { onset_g: 900.0 },
    };
    let done = campaign(&points, far, |at, _, a| law(at, a), |n| n - 1);
    let order = done.order();
    for (point, at) in points.iter().enumerate() {
        if at.ramp_class == RampClass::Rigid {
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
    let points = study(&RAMPS[..2], &[1.0]);
    let done = campaign(&points, |_| Touch::Unknown, |at, _, a| law(at, a), |_| 0);
    for point in 0..points.len() {
        let findings = done.findings(point);
        assert_eq!(findings.status, Status::Ok);
        assert!(findings.flags.contains(&Flag::OnsetUnknown));
        assert!(findings.runs > 0);
    }
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
    let lattice = settings.lattice;
    for seed in 1..2000 {
        let mut random = random(seed);
        let onset_g = 60.0 + 200.0 * random();
        let critical_g = onset_g * (1.0 + 2.0 * random());
        let start_g = onset_g + (critical_g - onset_g) * random();
        let share = 0.3 * random();
        let window = start_g..(start_g * (1.0 + share)).min(critical_g);
        let sick = lattice.nearest(onset_g * (1.0 + random()));
        let has_sick = random() < 0.3;
        let hint_g = (random() < 0.8).then(|| critical_g * (0.5 + random()));
        let onset = (random() < 0.8).then(|| lattice.at_or_above(onset_g));
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
            law(Probe::at(failure), lattice.amplitude_g(failure)),
            Verdict::Fails { .. } | Verdict::Undecided { .. }
        ));
        assert!(findings.runs <= 45, "seed {seed}: {} runs", findings.runs);
        let n_window = lattice.at_or_above(window.end) - lattice.at_or_above(window.start);
        // Where the whole range is the point's own, the scan coarsens below 0.71 of the bracket.
        let is_fine = onset.is_some() || window.start > 0.75 * critical_g;
        if n_window >= settings.scan_gap && is_fine {
            let start = lattice.at_or_above(window.start);
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
