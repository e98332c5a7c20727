//! Hard cases E: the verdict of a run, and the search for the critical shock.

use super::check::Check;
use super::naive;
use super::scenes::films::{PlaneSlider, uniform};
use super::scenes::heads::{
    SingleModeDisk, StillDisk, default_film, default_head, default_resolution, head_on,
};
use super::scenes::noted::note;
use super::scenes::structures::{paper, paper_arms};
use crate::search::{
    Findings, Flag, MonotonicityScan, PointSearch, Probe, SearchSettings, Start, Status,
    Verdict as Reported,
};
use opshock_solver::air_bearing::Attitude;
use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::head::{HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::integrator::hermite;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::structure::Workspace;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 2e-3,
};

fn shock(
    disk: &dyn DiskMotion,
    amplitude_m_per_s2: f64,
    window_s: f64,
    tolerance: f64,
    stop: bool,
) -> HeadRun {
    let (film, flight) = default_film(300);
    let mut resolution = default_resolution();
    resolution.tolerance = tolerance;
    resolution.coupling_tolerance = 0.1 * tolerance;
    let model = head_on(&film, &flight, &resolution);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2,
    };
    model.run(
        disk,
        &load,
        window_s,
        stop,
        true,
        &mut HeadWorkspace::new(&model),
    )
}

pub(super) fn e1() -> Vec<Check> {
    let model = default_head(300, &default_resolution());
    let mut drift = 0.0_f64;
    let mut failed = 0;
    for amplitude in [0.0, 1e-300] {
        let run = shock(&StillDisk, amplitude, 5e-3, 1e-3, true);
        failed += usize::from(run.verdict != Verdict::Survives);
        for clearance in run.columns.expect("recorded").min_clearance_m {
            drift = drift.max((clearance / model.steady_clearance_m() - 1.0).abs());
        }
    }
    // The same head started 1 nm above its flight.
    let (film, flight) = default_film(300);
    let mut high = (*flight).clone();
    high.attitude.centre_height_m += 1e-9;
    let off = head_on(&film, &Arc::new(high), &default_resolution());
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: 0.0,
    };
    let mut workspace = HeadWorkspace::new(&off);
    let run = off.run(&StillDisk, &load, 1e-4, true, true, &mut workspace);
    let clearances = run.columns.expect("recorded").min_clearance_m;
    let first = clearances.first().copied().unwrap_or(f64::NAN);
    let moved = clearances.iter().map(|c| (c / first - 1.0).abs());
    vec![
        Check::new("drift of the clearance in 5 ms without shock", drift, 1e-9).against(
            "started 1 nm above the steady flight, 0.1 ms",
            moved.fold(0.0, f64::max),
        ),
        Check::none("failures without shock", failed),
    ]
}

pub(super) fn e2() -> Vec<Check> {
    // 1 − 4 t + 3 t² over a step of 2: both ends positive, −1/3 at t = 2/3, zero at 1/3.
    let cubic = |theta: f64| hermite::value(theta, 2.0, [1.0, 5.0], [-4.0, 8.0]);
    let (theta, value) = hermite::minimum(4, cubic);
    let zero = hermite::first_below_zero(2, Some(theta), cubic).unwrap_or(f64::NAN);
    let amplitude = 900.0 * G;
    let disk = SingleModeDisk::new(amplitude, 2e-3);
    let time = |tolerance: f64| match shock(&disk, amplitude, 0.8e-3, tolerance, true).verdict {
        Verdict::Fails { t_fail_s, .. } => t_fail_s,
        _ => f64::NAN,
    };
    let (coarse, fine) = (time(1e-2), time(1e-4));
    let gone_on = shock(&disk, amplitude, 0.8e-3, 1e-2, false);
    let ends = gone_on.columns.expect("recorded").time_s;
    let step_end = ends
        .iter()
        .copied()
        .find(|t| *t >= coarse)
        .unwrap_or(f64::NAN);
    let step = ends
        .windows(2)
        .find(|w| w[1] >= coarse)
        .map_or(f64::NAN, |w| w[1] - w[0]);
    vec![
        Check::new(
            "minimum of a parabola inside a step",
            (value + 1.0 / 3.0).abs(),
            1e-12,
        )
        .against("looked at step ends", 4.0 / 3.0),
        Check::new(
            "its zero, of the step",
            (zero - 1.0 / 6.0).abs(),
            1e-2 * 1e-6,
        ),
        Check::new(
            "time of touch at 100 times the tolerance, of a step",
            (coarse - fine).abs() / step,
            1.0,
        )
        .against(
            "reported at the end of the step",
            1.0 + (step_end - fine).abs() / step,
        ),
    ]
}

pub(super) fn e3() -> Vec<Check> {
    let slider = PlaneSlider::square(
        opshock_solver::air_bearing::FlowModel::Continuum,
        1.0,
        1.0,
        0.1,
    );
    let film = slider.film(&uniform(10, 1.0), &uniform(10, 1.0));
    let (mut worst, mut place, mut centres) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (pitch, roll) in [(1e-4, 3e-5), (-1e-4, 3e-5), (1e-4, -3e-5), (-2e-5, -2e-5)] {
        let attitude = Attitude {
            centre_height_m: 2e-7,
            pitch_rad: pitch,
            roll_rad: roll,
        };
        let half = 0.5e-3;
        let exact = 2e-7 - half * (f64::abs(pitch) + f64::abs(roll));
        let found = film.min_clearance(&attitude);
        worst = worst.max((found.value_m - exact).abs() / 2e-7);
        // Trailing edge low for a positive pitch, inner side low for a positive roll.
        let corner = [
            if pitch > 0.0 { 1e-3 } else { 0.0 },
            if roll > 0.0 { 0.0 } else { 1e-3 },
        ];
        place = place.max((found.x_m - corner[0]).abs() + (found.y_m - corner[1]).abs());
        let at_centre = 2e-7 - 0.9 * half * (f64::abs(pitch) + f64::abs(roll));
        centres = centres.max((at_centre - exact).abs() / 2e-7);
    }
    vec![
        Check::new("clearance of a plane at its corner", worst, 1e-12)
            .against("smallest height of 10 x 10 cell centres", centres),
        Check::new("place of the touch, m", place, 1e-12),
    ]
}

struct Broken;

impl DiskMotion for Broken {
    fn pose(&self, t: f64) -> DiskPose {
        DiskPose {
            displacement_m: if t > 1e-4 { f64::NAN } else { 0.0 },
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

pub(super) fn e4() -> Vec<Check> {
    let run = shock(&Broken, 0.0, 1e-3, 1e-3, true);
    let decided = !matches!(run.verdict, Verdict::Undecided { .. });
    vec![
        Check::none(
            "verdicts from a disk that is not a number",
            usize::from(decided),
        )
        .against(
            "fails when clearance < 0, else survives",
            f64::from(u8::from(!naive::search::is_below_zero(f64::NAN))),
        ),
        Check::new("run goes on behind it, s", run.end_s - 1.001e-4, 0.0),
    ]
}

fn settings(monotonicity_scan: MonotonicityScan) -> SearchSettings {
    SearchSettings::new((20.0, 2000.0), 0.01, monotonicity_scan, 0.10, true).expect("settings")
}

fn fails() -> Reported {
    Reported::Fails {
        t_fail_s: 1e-3,
        x_m: 0.0,
        y_m: 0.0,
    }
}

/// Runs a search against a law of (probe, amplitude in g).
pub(super) fn search(
    settings: SearchSettings,
    law: impl Fn(Probe, f64) -> Reported,
) -> (Findings, usize) {
    let start = Start {
        hint_g: None,
        onset_index: None,
        fail_below_m: 0.0,
        width_rank: 0,
    };
    let mut search = PointSearch::new(settings, start);
    let mut probes = 0;
    while let Some(asked) = search.ask() {
        probes += 1;
        if probes > 2000 {
            break;
        }
        search.tell(&law(
            asked.probe,
            settings.grid.amplitude_g(asked.probe.index),
        ));
    }
    (search.findings(), probes)
}

fn above(critical_g: f64) -> impl Fn(Probe, f64) -> Reported {
    move |_, a| {
        if a < critical_g {
            Reported::Survives
        } else {
            fails()
        }
    }
}

/// Largest travel of a mode at 1 kHz per unit amplitude of a half-sine, s².
fn peak_s2(width_s: f64) -> f64 {
    let (w, p) = (TAU * 1000.0, PI / width_s);
    let motion = |t: f64| {
        if ((p - w) / w).abs() < 1e-9 {
            let (sine, cosine) = (w * t).sin_cos();
            ((sine - w * t * cosine) / (2.0 * w * w), 0.5 * t * sine)
        } else {
            let scale = 1.0 / (w * w - p * p);
            let x = scale * ((p * t).sin() - p / w * (w * t).sin());
            (x, scale * p * ((p * t).cos() - (w * t).cos()))
        }
    };
    let samples = (0..=20_000).map(|i| motion(width_s * f64::from(i) / 20_000.0).0.abs());
    let (x, v) = motion(width_s);
    samples.fold(0.0, f64::max).max(x.hypot(v / w))
}

pub(super) fn e5() -> Vec<Check> {
    let (mut closed, mut outside, mut wide, mut loose) = (0.0_f64, 0, 0.0_f64, 0.0_f64);
    let settings = settings(MonotonicityScan::Sampled);
    for (width_ms, exact) in [
        (0.25, 426.987_658),
        (0.5, 256.282_637),
        (1.0, 232.422_642),
        (2.0, 317.463_645),
        (4.0, 357.680_822),
    ] {
        let critical = 1e-4 / peak_s2(width_ms * 1e-3) / G;
        closed = closed.max((critical / exact - 1.0).abs());
        let (findings, _) = search(settings, above(critical));
        let grid_point = |n: Option<i32>| n.map_or(f64::NAN, |n| settings.grid.amplitude_g(n));
        let (low, high) = (grid_point(findings.survivor), grid_point(findings.failure));
        outside += usize::from(!(low < exact && exact <= high));
        wide = wide.max(high / low - 1.0);
        let (low, high) = naive::search::bracketed((20.0, 2000.0), 7, |a| a >= critical);
        loose = loose.max(high / low - 1.0);
    }
    vec![
        Check::new("critical shock against the table", closed, 2e-7),
        Check::none("widths whose bracket does not contain it", outside),
        Check::new("widest bracket", wide, 0.01).against("seven halvings of the range", loose),
    ]
}

pub(super) fn e6() -> Vec<Check> {
    let settings = settings(MonotonicityScan::Sampled);
    let (never, probes) = search(settings, |_, _| Reported::Survives);
    let (always, more) = search(settings, |_, _| fails());
    let reported = [
        never.status == Status::AboveRange && never.failure.is_none(),
        always.status == Status::BelowRange && always.survivor.is_none(),
    ];
    vec![
        Check::none(
            "bounds given as answers",
            reported.iter().filter(|t| !**t).count(),
        )
        .against(
            "bisection between the bounds: answers where there is none",
            [f64::INFINITY, 0.0]
                .map(|critical| naive::search::bisected(20.0, 2000.0, |a| a >= critical))
                .iter()
                .filter(|answer| answer.is_finite())
                .count() as f64,
        ),
        Check::new("probes spent", probes.max(more) as f64, 40.0),
    ]
}

pub(super) fn e7() -> Vec<Check> {
    let interval = |_: Probe, a: f64| {
        if (130.0..146.0).contains(&a) || a >= 200.0 {
            fails()
        } else {
            Reported::Survives
        }
    };
    let guarded = settings(MonotonicityScan::Sampled);
    let exact = guarded.grid.amplitude_g(guarded.grid.at_or_above(130.0));
    let found = |settings: SearchSettings| {
        let (findings, _) = search(settings, interval);
        let g = findings
            .failure
            .map_or(f64::NAN, |n| settings.grid.amplitude_g(n));
        (g / exact - 1.0, findings)
    };
    let (error, findings) = found(guarded);
    let (naive, _) = found(settings(MonotonicityScan::Off));
    vec![
        Check::new("lowest failure", error.abs(), 1e-12)
            .against("bisection without a scan", naive.abs()),
        Check::none(
            "answers not marked as non-monotone",
            usize::from(!findings.flags.contains(&Flag::NonMonotone)),
        ),
        Check::none(
            "brackets not listed",
            2_usize.saturating_sub(findings.brackets.len()),
        ),
    ]
}

pub(super) fn e8() -> Vec<Check> {
    // 0.3 % of scatter on the travel, different at every amplitude.
    let flutter = |a: f64| {
        let mixed = a.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        1.0 + 0.003 * (mixed as f64 / f64::from(1 << 23) - 1.0)
    };
    let settings = settings(MonotonicityScan::Sampled);
    let (mut outside, mut narrow, mut noise) = (0, f64::INFINITY, f64::INFINITY);
    for critical in [95.0, 256.282_637, 357.680_822] {
        let (findings, _) = search(settings, |_, a| {
            if a * flutter(a) < critical {
                Reported::Survives
            } else {
                fails()
            }
        });
        let grid_point = |n: Option<i32>| n.map_or(f64::NAN, |n| settings.grid.amplitude_g(n));
        let (low, high) = (grid_point(findings.survivor), grid_point(findings.failure));
        outside += usize::from(!(low * 0.997 < critical && critical <= high * 1.0031));
        narrow = narrow.min(high / low - 1.0);
        let (low, high) =
            naive::search::bracketed((20.0, 2000.0), 40, |a| a * flutter(a) >= critical);
        noise = noise.min(high / low - 1.0);
    }
    vec![
        Check::none("answers moved by more than the flutter", outside),
        Check::new(
            "bracket narrower than a step of the amplitude grid by",
            settings.grid.step() - narrow,
            1e-12,
        )
        .against("40 halvings of the range", settings.grid.step() - noise),
    ]
}

pub(super) fn e9() -> Vec<Check> {
    let settings = settings(MonotonicityScan::Sampled);
    let late = |probe: Probe, a: f64| {
        let critical = if probe.window_factor == 2 {
            140.0
        } else {
            150.0
        };
        above(critical)(probe, a)
    };
    let (findings, _) = search(settings, late);
    let mut once = settings;
    once.window_check = false;
    let (unseen, _) = search(once, late);
    let answer = findings.failure == Some(settings.grid.at_or_above(150.0));
    vec![
        Check::none(
            "late failures not reported",
            usize::from(!findings.flags.contains(&Flag::Window)),
        )
        .against(
            "one window, whatever happens after it",
            f64::from(u8::from(!unseen.flags.contains(&Flag::Window))),
        ),
        Check::none(
            "answers that depend on the doubled window",
            usize::from(!answer),
        ),
    ]
}

pub(super) fn e10() -> Vec<Check> {
    let mut workspace = Workspace::default();
    let drive = paper(5e-4, paper_arms());
    let model = drive.build();
    let (mut most, mut wrong, mut at_rest) = (0.0_f64, 0, f64::NAN);
    for amplitude in [0.0, 1e-300, -1e-300] {
        note(&drive, amplitude);
        match model.run(amplitude, false, &mut workspace) {
            Ok(run) => {
                most = most.max(run.disk.rim_max_m);
                if amplitude == 0.0 {
                    at_rest = run.disk.rim_max_m;
                }
                wrong +=
                    usize::from(!run.energy.closure.is_finite() || run.first_touch_s.is_some());
            }
            Err(_) => wrong += 1,
        }
    }
    wrong += usize::from(model.run(f64::NAN, false, &mut workspace).is_ok());
    vec![
        Check::new("largest displacement, m", most, 1e-300),
        Check::none("runs that fail, touch, or accept NaN", wrong).against(
            "response over amplitude at 0: not a number",
            f64::from(u8::from((at_rest / 0.0).is_nan())),
        ),
    ]
}
