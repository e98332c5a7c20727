//! Computes the numbers that decide the statements of sections 4.1 and 4.2, from the histories of [`Shocks`].
//!
//! Each function gives the number and a note with what belongs to it. Times in notes are on the
//! paper's axis.

use super::shocks::{Case, Shocks};
use opshock_solver::simulation::{Episode, Verdict};
use std::f64::consts::PI;

type Number = (Option<f64>, String);

/// Grid on which histories are compared, s: that of disk and ramp is finer, the head's irregular.
const GRID_S: f64 = 2e-6;

/// Linear interpolation in a history; NaN outside of it.
fn at(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|&t| t <= time);
    match (after.checked_sub(1), times.get(after)) {
        (Some(before), Some(&next)) => {
            let share = (time - times[before]) / (next - times[before]);
            values[before] + share * (values[after] - values[before])
        }
        (Some(before), None) if times[before] == time => values[before],
        _ => f64::NAN,
    }
}

/// Values of a history at `from`, `from` + grid, ... up to `to`.
fn sampled(times: &[f64], values: &[f64], (from, to): (f64, f64)) -> Vec<f64> {
    let count = ((to - from) / GRID_S).round() as usize;
    (0..=count)
        .map(|k| at(times, values, from + k as f64 * GRID_S))
        .collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, n), v| (sum + v * v, n + 1));
    (sum / count as f64).sqrt()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, v| most.max(v.abs()))
}

fn end_s(case: &Case) -> f64 {
    case.disk().time_s.last().copied().unwrap_or(0.0)
}

fn displacement(case: &Case, window: (f64, f64)) -> Vec<f64> {
    sampled(&case.disk().time_s, &case.disk().disk_slider_m, window)
}

/// RMS distance of the disk under the slider from its motion without a ramp, m.
fn departure(case: &Case, free: &Case) -> f64 {
    let window = (0.0, end_s(case).min(end_s(free)));
    let (a, b) = (displacement(case, window), displacement(free, window));
    rms(a.iter().zip(&b).map(|(a, b)| a - b))
}

/// Contact spells of both arms in order of time, each with whether it is the top arm's.
fn spells(case: &Case) -> Vec<(bool, Episode)> {
    let top = case.outcome.top.episodes.iter().map(|e| (true, *e));
    let bottom = case.outcome.bottom.episodes.iter().map(|e| (false, *e));
    let mut spells: Vec<_> = top.chain(bottom).collect();
    spells.sort_by(|a, b| a.1.on_s.total_cmp(&b.1.on_s));
    spells
}

fn spell_words(case: &Case) -> String {
    let spells = spells(case);
    let words = spells.iter().map(|(is_top, e)| {
        format!(
            "{} {:.3} ms {:.2} N",
            if *is_top { "top" } else { "bottom" },
            1e3 * (e.on_s + case.start_s),
            e.peak_20us_n
        )
    });
    words.collect::<Vec<_>>().join(", ")
}

fn first_touch(case: &Case) -> Number {
    let touches = [&case.outcome.top, &case.outcome.bottom].map(|arm| arm.first_touch_s);
    let first = touches.into_iter().flatten().min_by(f64::total_cmp);
    let time = first.map(|t| 1e3 * (t + case.start_s));
    (time, format!("{} contacts", spells(case).len()))
}

fn smallest_clearance(case: &Case) -> Number {
    let steady = case
        .outcome
        .steady
        .map_or(f64::NAN, |s| 1e9 * s.min_clearance_m);
    match case.outcome.verdict {
        Some(Verdict::Survives) => (
            case.outcome.min_clearance_m.map(|h| 1e9 * h),
            format!("survives; {steady:.2} nm before the shock"),
        ),
        Some(Verdict::Fails { t_fail_s, .. }) => (
            Some(0.0),
            format!("fails at {:.4} ms", 1e3 * (t_fail_s + case.start_s)),
        ),
        Some(Verdict::Undecided { ref cause }) => (None, format!("undecided: {cause}")),
        None => (None, "no head was simulated".to_owned()),
    }
}

fn peak_um(case: &Case) -> Number {
    let disk = &case.outcome.disk;
    let peak = 1e6 * disk.slider_max_m;
    (
        Some(peak),
        format!("{:.2} um downwards", -1e6 * disk.slider_min_m),
    )
}

pub(super) fn pulse_shape(shocks: &Shocks) -> Number {
    let worst = [&shocks.long.none, &shocks.short.none].map(|case| {
        let load = |t: f64| match (0.0..=case.width_s).contains(&t) {
            true => case.amplitude_m_per_s2 * (PI * t / case.width_s).sin(),
            false => 0.0,
        };
        let disk = case.disk();
        let off = disk.time_s.iter().zip(&disk.shock_m_per_s2);
        100.0 * largest(off.map(|(&t, a)| a - load(t))) / case.amplitude_m_per_s2
    });
    (
        Some(worst[0].max(worst[1])),
        "largest deviation from A sin(pi t/T)".into(),
    )
}

pub(super) fn free_force(shocks: &Shocks) -> Number {
    let disk = shocks.long.none.disk();
    let force = disk.contact_top_n.iter().chain(&disk.contact_bottom_n);
    (Some(largest(force.copied())), String::new())
}

pub(super) fn rigid_touch(shocks: &Shocks) -> Number {
    first_touch(&shocks.long.rigid)
}

pub(super) fn rigid_ramp_point(shocks: &Shocks) -> Number {
    let disk = &shocks.long.rigid.outcome.disk;
    (
        Some(1e6 * disk.ramp_max_m),
        format!("rim {:.2} um", 1e6 * disk.rim_max_m),
    )
}

pub(super) fn rigid_peak(shocks: &Shocks) -> Number {
    peak_um(&shocks.long.rigid)
}

pub(super) fn deformable_touch(shocks: &Shocks) -> Number {
    first_touch(&shocks.long.deformable)
}

pub(super) fn deformable_peak(shocks: &Shocks) -> Number {
    let [free, held] = [&shocks.long.none, &shocks.long.deformable]
        .map(|case| 1e6 * case.outcome.disk.slider_max_m);
    (
        Some(100.0 * held / free),
        format!("{held:.2} against {free:.2} um"),
    )
}

pub(super) fn deformable_departure(shocks: &Shocks) -> Number {
    let long = &shocks.long;
    let [rigid, deformable] =
        [&long.rigid, &long.deformable].map(|case| 1e6 * departure(case, &long.none));
    (
        Some(100.0 * deformable / rigid),
        format!(
            "RMS distance from the motion without a ramp {deformable:.2} against {rigid:.2} um"
        ),
    )
}

pub(super) fn top_collisions(shocks: &Shocks) -> Number {
    let case = &shocks.long.deformable;
    let count = case.outcome.top.episodes.len() as f64;
    (Some(count), spell_words(case))
}

/// Velocity of the ramp point after a collision over that before it.
pub(super) fn direction_kept(shocks: &Shocks) -> Number {
    let case = &shocks.long.deformable;
    let disk = case.disk();
    let rate = |from: f64| {
        let w = |t| at(&disk.time_s, &disk.disk_ramp_m, t);
        (w(from + 20e-6) - w(from)) / 20e-6
    };
    let kept = case.outcome.top.episodes.iter().map(|spell| {
        let (before, after) = (rate(spell.on_s - 22e-6), rate(spell.off_s + 2e-6));
        (before, after)
    });
    let kept: Vec<(f64, f64)> = kept.collect();
    let words: Vec<String> = kept
        .iter()
        .map(|(before, after)| format!("{before:.3} to {after:.3} m/s"))
        .collect();
    let least = kept
        .iter()
        .map(|(before, after)| after / before)
        .min_by(f64::total_cmp);
    (least, words.join(", "))
}

/// The paper's 0.8 to 1.5 ms, in which its Fig. 8 shows the pitch, after the onset.
fn zoom(case: &Case) -> (f64, f64) {
    (0.15 * case.width_s, 0.5 * case.width_s)
}

/// Largest change of the disk's pitch within 50 us, rad.
fn pitch_jump(case: &Case) -> f64 {
    let disk = case.disk();
    let pitch = sampled(&disk.time_s, &disk.disk_pitch_rad, zoom(case));
    let span = (50e-6 / GRID_S) as usize;
    largest((span..pitch.len()).map(|k| pitch[k] - pitch[k - span]))
}

/// Without a ramp the disk stays axisymmetric and has no circumferential slope at all, so the ramps
/// are compared with each other.
fn jumps(shocks: &Shocks) -> ([f64; 2], String) {
    let long = &shocks.long;
    let [none, rigid, deformable] =
        [&long.none, &long.rigid, &long.deformable].map(|case| 1e6 * pitch_jump(case));
    (
        [rigid, deformable],
        format!("{rigid:.1} rigid, {deformable:.1} deformable, {none:.1} urad without a ramp"),
    )
}

pub(super) fn rigid_pitch_jump(shocks: &Shocks) -> Number {
    let ([rigid, deformable], note) = jumps(shocks);
    (Some(rigid / deformable), note)
}

pub(super) fn deformable_pitch_jump(shocks: &Shocks) -> Number {
    let ([rigid, deformable], note) = jumps(shocks);
    (Some(100.0 * deformable / rigid), note)
}

/// RMS of the slider's pitch against the disk's over half a millisecond after the first touch of the
/// rigid ramp, above 2 kHz (a mean over 0.5 ms is taken out), rad. The pinned modes of the
/// suspension lie there; where the slider has touched, it goes on over the minimum film height.
fn shaking(case: &Case, from: f64) -> f64 {
    let half = 0.25e-3;
    let wide = (from - half, from + 0.5e-3 + half);
    let (disk, head) = (case.disk(), case.head());
    let own = sampled(&head.time_s, &head.slider_pitch_rad, wide);
    let under = sampled(&disk.time_s, &disk.disk_pitch_rad, wide);
    let relative: Vec<f64> = own.iter().zip(&under).map(|(a, b)| a - b).collect();
    let reach = (half / GRID_S).round() as usize;
    let around = |k: usize| {
        let span = &relative[k - reach..=k + reach];
        relative[k] - span.iter().sum::<f64>() / span.len() as f64
    };
    rms((reach..relative.len().saturating_sub(reach)).map(around))
}

fn shaken(shocks: &Shocks) -> [f64; 3] {
    let long = &shocks.long;
    let touch = long.rigid.outcome.top.first_touch_s;
    let from = touch.unwrap_or(0.25 * long.rigid.width_s);
    [&long.none, &long.rigid, &long.deformable].map(|case| 1e6 * shaking(case, from))
}

pub(super) fn rigid_shaking(shocks: &Shocks) -> Number {
    let [none, rigid, _] = shaken(shocks);
    (
        Some(rigid / none),
        format!("{rigid:.2} against {none:.2} urad RMS above 2 kHz"),
    )
}

pub(super) fn deformable_shaking(shocks: &Shocks) -> Number {
    let [none, _, deformable] = shaken(shocks);
    (
        Some(deformable / none),
        format!("{deformable:.2} against {none:.2} urad RMS above 2 kHz"),
    )
}

pub(super) fn follows_better(shocks: &Shocks) -> Number {
    let [_, rigid, deformable] = shaken(shocks);
    (
        Some(deformable / rigid),
        format!("{deformable:.2} against {rigid:.2} urad RMS above 2 kHz"),
    )
}

pub(super) fn rigid_failure(shocks: &Shocks) -> Number {
    let case = &shocks.long.rigid;
    let (_, note) = smallest_clearance(case);
    match case.outcome.verdict {
        Some(Verdict::Fails { t_fail_s, .. }) => (Some(1e3 * (t_fail_s + case.start_s)), note),
        _ => (None, note),
    }
}

pub(super) fn free_survival(shocks: &Shocks) -> Number {
    smallest_clearance(&shocks.long.none)
}

pub(super) fn deformable_survival(shocks: &Shocks) -> Number {
    smallest_clearance(&shocks.long.deformable)
}

pub(super) fn excitation(shocks: &Shocks) -> Number {
    let case = &shocks.short.none;
    let pulse_hz = 0.5 / case.width_s;
    (
        Some(pulse_hz / case.first_mode_hz),
        format!("{pulse_hz:.0} against {:.1} Hz", case.first_mode_hz),
    )
}

/// Largest swing in the last period of the first mode over that in its first after the pulse.
fn swing_kept(case: &Case) -> f64 {
    let period = 1.0 / case.first_mode_hz;
    let swing = |from: f64| largest(displacement(case, (from, from + period)).into_iter());
    swing(end_s(case) - period) / swing(case.width_s)
}

pub(super) fn free_swing(shocks: &Shocks) -> Number {
    (Some(100.0 * swing_kept(&shocks.short.none)), String::new())
}

pub(super) fn short_rigid_peak(shocks: &Shocks) -> Number {
    peak_um(&shocks.short.rigid)
}

pub(super) fn short_rigid_contacts(shocks: &Shocks) -> Number {
    let case = &shocks.short.rigid;
    (Some(spells(case).len() as f64), spell_words(case))
}

pub(super) fn short_rigid_departure(shocks: &Shocks) -> Number {
    let short = &shocks.short;
    let window = (0.0, end_s(&short.none));
    let free = rms(displacement(&short.none, window).into_iter());
    let off = departure(&short.rigid, &short.none);
    (
        Some(100.0 * off / free),
        format!("{:.2} of {:.2} um RMS", 1e6 * off, 1e6 * free),
    )
}

pub(super) fn short_rigid_survival(shocks: &Shocks) -> Number {
    smallest_clearance(&shocks.short.rigid)
}

pub(super) fn short_deformable_decay(shocks: &Shocks) -> Number {
    let [free, held] =
        [&shocks.short.none, &shocks.short.deformable].map(|case| 100.0 * swing_kept(case));
    (
        Some(held),
        format!("without a ramp {free:.0} % of the first swing are left"),
    )
}

pub(super) fn alternation(shocks: &Shocks) -> Number {
    let case = &shocks.short.deformable;
    let spells = spells(case);
    let share = (spells.len() >= 2).then(|| {
        let turns = spells.windows(2).filter(|pair| pair[0].0 != pair[1].0);
        100.0 * turns.count() as f64 / (spells.len() - 1) as f64
    });
    (share, spell_words(case))
}

pub(super) fn growth(shocks: &Shocks) -> Number {
    let spells = spells(&shocks.short.deformable);
    let share = (spells.len() >= 3).then(|| {
        let grown = spells
            .windows(2)
            .filter(|pair| pair[1].1.peak_20us_n > pair[0].1.peak_20us_n);
        100.0 * grown.count() as f64 / (spells.len() - 1) as f64
    });
    (share, format!("{} contacts", spells.len()))
}

pub(super) fn short_deformable_failure(shocks: &Shocks) -> Number {
    smallest_clearance(&shocks.short.deformable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histories_are_read_between_their_samples_and_not_beyond_them() {
        let (t, v) = ([0.0, 1.0, 3.0], [0.0, 2.0, -2.0]);
        assert_eq!(at(&t, &v, 0.5), 1.0);
        assert_eq!(at(&t, &v, 2.0), 0.0);
        assert_eq!(at(&t, &v, 3.0), -2.0);
        assert!(at(&t, &v, 3.1).is_nan() && at(&t, &v, -0.1).is_nan());
    }
}
