//! What is left of a sweep: runs and seconds, as the range of many made-up ends.
//!
//! Each end finishes the searches and the uncertainty intervals from what is known, with refinement
//! and doubled windows, by the code that asks for the real runs. Two things are learnt on the way: the time of each kind
//! of run (`pace`), and by how much real intervals cost more than made-up ones of the same points, by ramp model.

use std::collections::{BTreeMap, BTreeSet};

use opshock_solver::scene::discretisation::Discretisation;

use super::input::{PointFilm, SweepInput};
use super::made_up::{Ended, Random, ended};
use super::made_up_interval::{Errors, MadeUpInterval};
use super::pace::Pace;
use super::registry::{
    Depth, Registry, interval_input, next_round, seen, uncertainty_asked, uncertainty_probe,
};
use super::rows;
use super::run_time::RunTime;
use super::spread::Spread;
use crate::search::uncertainty::{self, Ask, UncertaintyInput};
use crate::search::{Asked, Campaign, Flag, Probe, ProbeResult, Ramp, Touch};
use crate::study::KeepHistories;

/// Made-up ends, for few points and for many.
const ENDS: u64 = 32;
const FEWEST_ENDS: u64 = 8;
/// Points made up at most in all ends.
const MOST_POINTS: u64 = 4096;
/// Share of the threads' time spent simulating.
pub(super) const CORE_USE: f64 = 0.95;
/// Time of runs that idle threads simulate ahead of a search and that it never requests, over that of the search's own, times
/// points over threads beyond the first. Measured with two threads: 0.3 to 0.8 of the time with four points, 0 to 0.1
/// with 12 to 36.
const AHEAD: f64 = 1.9;
/// The most that AHEAD may add with many threads, a guess: few runs are likely enough to be simulated ahead.
const MOST_AHEAD: f64 = 2.0;
/// Points as many as which made-up intervals count against finished ones: of all ramp models, and of one.
const MADE_UP_POINTS: f64 = 3.0;
/// Real over made-up cost of an interval before any is finished: that of 21 studies, of which nine refine.
const MODEL_RATIO: f64 = 0.8;
/// Standard deviation of the logarithm of the real over the made-up cost of all intervals, before any is finished.
const MODEL_SPREAD: f64 = 0.4;

/// What is left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Remainder {
    /// Runs of the searches.
    pub(super) search_runs: Spread,
    /// Runs of the uncertainty intervals.
    pub(super) uncertainty_runs: Spread,
    /// All of them.
    pub(super) runs: Spread,
    /// Seconds of all simulations, one after another.
    pub(super) core_s: Spread,
    /// Seconds with the threads of the sweep.
    pub(super) wall_s: Spread,
}

/// The interval of a point in one end.
struct Interval {
    ramp: Ramp,
    /// Seconds and runs left.
    left_s: f64,
    runs: usize,
    /// Its film, and refinement levels of its defect correction among them.
    film: PointFilm,
    corrections: BTreeSet<i8>,
    /// Seconds of the finished interval, real and made up.
    finished_s: Option<[f64; 2]>,
    /// The critical shock with it.
    answer: Option<uncertainty::Answer>,
}

/// What is left of the sweep of `registry`, at `pace`.
pub(super) fn remainder(
    input: &SweepInput,
    registry: &Registry<'_>,
    touches: &[Touch],
    pace: &Pace,
    threads: usize,
) -> Remainder {
    let n_points = input.points.len().max(1) as u64;
    let n_ends = (MOST_POINTS / n_points).clamp(FEWEST_ENDS, ENDS);
    let mut outcomes: [Vec<f64>; 5] = Default::default();
    for end in 0..n_ends {
        let one = one_end(input, registry, touches, pace, threads, end);
        for (outcomes, one) in outcomes.iter_mut().zip(one) {
            outcomes.push(one);
        }
    }
    let [search_runs, uncertainty_runs, runs, core_s, wall_s] = outcomes.map(Spread::of);
    Remainder {
        search_runs,
        uncertainty_runs,
        runs,
        core_s,
        wall_s,
    }
}

fn one_end(
    input: &SweepInput,
    registry: &Registry<'_>,
    touches: &[Touch],
    pace: &Pace,
    threads: usize,
    end: u64,
) -> [f64; 5] {
    let ended = ended(input, registry, touches, end);
    let errors = Errors::of(end);
    let mut random = Random(end ^ 0x7ace);
    let z = [random.normal(), random.normal(), random.normal()];
    let of_run = |time: RunTime| {
        let plain = (pace.plain_spread(time.kind.ramp) * z[2]).exp();
        plain * pace.seconds(time).unwrap_or(0.0)
    };
    let seconds = |point: usize, asked: &Asked, fails: bool| {
        let time = RunTime::of(input, registry, &ended.campaign, point, asked, fails);
        match asked.probe.levels.is_none() {
            true => of_run(time),
            false => of_run(time) * (pace.spread(time.kind.ramp) * z[0]).exp(),
        }
    };
    let (mut searched, mut search_s, mut histories_s) = (0, 0.0, 0.0);
    let mut searches = 0;
    for point in 0..input.points.len() {
        if !registry.wants(point) {
            continue;
        }
        let new = &ended.new[point];
        searched += new.len() as u32;
        searches += usize::from(!new.is_empty());
        for (asked, fails) in new {
            search_s += seconds(point, asked, *fails);
        }
        if !registry.is_final(point) {
            let kept = match input.keep_histories {
                KeepHistories::None => 0,
                KeepHistories::Bracket => 2,
                KeepHistories::All => new.len().max(2),
            };
            let survivor = RunTime::survivor(&input.points[point], Probe::at(0));
            histories_s += kept as f64 * of_run(survivor);
        }
    }
    let ahead = AHEAD * threads.saturating_sub(1) as f64 / searches.max(1) as f64;
    let ahead = 1.0 + ahead.min(MOST_AHEAD);
    let (searched, search_s) = ((ahead * f64::from(searched)).round(), ahead * search_s);
    let made_up = |point: usize, refinements: u8| {
        let seed = end.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ point as u64;
        let of_asked = |asked: &Asked, fails: bool| seconds(point, asked, fails);
        interval(
            input,
            registry,
            &ended,
            &errors,
            (point, refinements),
            seed,
            &of_asked,
        )
    };
    let intervals = intervals(input, registry, &ended.campaign, &made_up);
    let factors = factors(&intervals, z[1]);
    let lefts = intervals.iter().map(|one| {
        factors
            .get(&one.ramp)
            .map_or(1.0, |factor| factor * one.left_s)
    });
    let sampled_s = sampled_s(&intervals, pace, threads);
    let lefts: Vec<f64> = sampled_s.into_iter().chain(lefts).collect();
    let asked: f64 = intervals
        .iter()
        .map(|one| one.runs as f64 * factors.get(&one.ramp).copied().unwrap_or(1.0))
        .sum();
    let is_open = intervals.iter().any(|one| one.runs > 0);
    let asked = asked.round().max(f64::from(u8::from(is_open)));
    let core_s = search_s + histories_s + lefts.iter().sum::<f64>();
    // An interval is made by one thread, the next one by the thread that is free first.
    let shared_s = (search_s + histories_s) / threads as f64;
    let mut busy_s = vec![shared_s; threads];
    for left_s in lefts {
        if let Some(first) = busy_s.iter_mut().min_by(|a, b| a.total_cmp(b)) {
            *first += left_s;
        }
    }
    let wall_s = busy_s.into_iter().fold(0.0, f64::max) / CORE_USE;
    [searched, asked, searched + asked, core_s, wall_s]
}

/// Seconds of each thread for sampling defect corrections: one samples a film's level, the others that have open intervals wait for
/// it where those need it as well.
fn sampled_s(intervals: &[Interval], pace: &Pace, threads: usize) -> Vec<f64> {
    let open = intervals.iter().filter(|one| one.runs > 0).count();
    let mut wanted: BTreeMap<(usize, i8), (PointFilm, usize)> = BTreeMap::new();
    for one in intervals {
        for &level in &one.corrections {
            let entry = wanted.entry((one.film.number, level));
            entry.or_insert((one.film, 0)).1 += 1;
        }
    }
    let mut seconds = vec![0.0; threads.min(open)];
    for ((_, level), (film, n)) in wanted {
        let sampled_s = pace.correction_s(film, level);
        let others = (n - 1) as f64 / open.saturating_sub(1).max(1) as f64;
        for (thread, seconds) in seconds.iter_mut().enumerate() {
            *seconds += sampled_s * if thread == 0 { 1.0 } else { others };
        }
    }
    seconds
}

/// The intervals of all wanted points, each content once; of a sweep that makes those of decisive points alone, the
/// intervals that its rounds choose by what is made up.
fn intervals(
    input: &SweepInput,
    registry: &Registry<'_>,
    campaign: &Campaign,
    made_up: &dyn Fn(usize, u8) -> Option<Interval>,
) -> Vec<Interval> {
    let mut depths = registry.depths().to_vec();
    let is_first = |point: usize| registry.first_of_content(point) == point;
    let make = |point: usize, depth: Depth| made_up(point, depth.refinements()?);
    let n_points = input.points.len();
    let mut intervals: Vec<Option<Interval>> = (0..n_points)
        .map(|point| {
            let is_asked = is_first(point) && (registry.wants(point) || input.decides.is_some());
            is_asked.then(|| make(point, depths[point])).flatten()
        })
        .collect();
    // The point whose interval is that of this one.
    let source = |point: usize| {
        let companion = campaign.order().relations[point].companion;
        let own = companion.filter(|_| is_taken(campaign, point));
        registry.first_of_content(own.unwrap_or(point))
    };
    loop {
        let row = |point: usize| {
            let interval = intervals[source(point)].as_ref();
            let answer = interval.and_then(|interval| interval.answer.as_ref());
            let (one, findings) = (&input.points[point], campaign.findings(point));
            let grid = &input.settings.grid;
            rows::row(one, &findings, answer.map(|answer| (answer, 0)), None, grid)
        };
        let round = match registry.is_decided() {
            true => Vec::new(),
            false => next_round(input, &row, &|point| depths[source(point)]),
        };
        let mut round: Vec<usize> = round.into_iter().map(source).collect();
        if round.is_empty() {
            return intervals.into_iter().flatten().collect();
        }
        round.sort_unstable();
        round.dedup();
        for point in round {
            depths[point] = depths[point].next();
            intervals[point] = make(point, depths[point]);
        }
    }
}

/// Real over made-up cost of an interval by ramp model: one ratio by all finished ones, and by it those of each model.
fn factors(intervals: &[Interval], z: f64) -> BTreeMap<Ramp, f64> {
    let mut of_ramp: BTreeMap<Ramp, [f64; 3]> = BTreeMap::new();
    for one in intervals {
        let sums = of_ramp.entry(one.ramp).or_default();
        if let Some([real_s, made_up_s]) = one.finished_s {
            for (sum, more) in sums.iter_mut().zip([real_s, made_up_s, 1.0]) {
                *sum += more;
            }
        }
    }
    let ratio = |[real_s, made_up_s, n]: [f64; 3], prior: f64| {
        if made_up_s <= 0.0 {
            return prior;
        }
        let more_s = MADE_UP_POINTS * made_up_s / n;
        (real_s + prior * more_s) / (made_up_s + more_s)
    };
    let all = of_ramp.values().fold([0.0; 3], |sum, one| {
        std::array::from_fn(|place| sum[place] + one[place])
    });
    let of_all = ratio(all, MODEL_RATIO);
    let spread = MODEL_SPREAD / (1.0 + all[2] / MADE_UP_POINTS).sqrt();
    of_ramp
        .into_iter()
        .map(|(ramp, sums)| (ramp, ratio(sums, of_all) * (spread * z).exp()))
        .collect()
}

/// The interval of a point; `None` where there is none of its own.
fn interval(
    input: &SweepInput,
    registry: &Registry<'_>,
    ended: &Ended,
    errors: &Errors,
    (point, refinements): (usize, u8),
    seed: u64,
    seconds: &dyn Fn(&Asked, bool) -> f64,
) -> Option<Interval> {
    let (ramp, film) = (
        input.points[point].coordinates.ramp,
        input.points[point].film,
    );
    let onset_g = ended.campaign.touch(point).and_then(Touch::onset_g);
    let all_s = |asks: &[(Ask, bool)]| -> f64 {
        let of_ask = |&(ask, fails): &(Ask, bool)| seconds(&uncertainty_asked(ask), fails);
        asks.iter().map(of_ask).sum()
    };
    let made_up = |from: &UncertaintyInput, known: &[(Ask, uncertainty::Seen)]| {
        let law = MadeUpInterval::of(from, (ramp, onset_g), errors, seed, known);
        let lookup = |ask: Ask| {
            let known = known.iter().find(|(known, _)| *known == ask);
            Some(known.map_or_else(|| law.seen(ask), |(_, seen)| *seen))
        };
        let (asks, progress) = uncertainty::answer(from, refinements, &lookup);
        let is_failure = |ask: Ask| lookup(ask).is_some_and(|seen| seen.fails());
        let asks: Vec<(Ask, bool)> = asks.into_iter().map(|ask| (ask, is_failure(ask))).collect();
        match progress {
            uncertainty::Progress::Done(answer) => (asks, Some(answer)),
            uncertainty::Progress::Wants(_) => (asks, None),
        }
    };
    if let Some(begun) = registry.interval(point) {
        let known: Vec<(Ask, uncertainty::Seen)> = begun
            .log
            .iter()
            .filter_map(|&ask| {
                let key = registry.key(point, uncertainty_probe(ask));
                let fail_below_m = input.points[point].coordinates.fail_below_m;
                Some((ask, seen(&registry.runs().get(&key)?.result, fail_below_m)))
            })
            .collect();
        if begun.is_done && registry.refinements(point) == refinements {
            let real: Vec<(Ask, bool)> = known
                .iter()
                .map(|(ask, seen)| (*ask, seen.fails()))
                .collect();
            let finished_s = [all_s(&real), all_s(&made_up(begun.input, &[]).0)];
            let answer = registry.finished_uncertainty(point);
            return Some(Interval {
                ramp,
                left_s: 0.0,
                runs: 0,
                film,
                corrections: BTreeSet::new(),
                finished_s: Some(finished_s),
                answer: answer.map(|(answer, _)| answer.clone()),
            });
        }
        let (mut asks, answer) = made_up(begun.input, &known);
        asks.retain(|(ask, _)| !known.iter().any(|(known, _)| known == ask));
        return Some(Interval {
            ramp,
            left_s: all_s(&asks),
            runs: asks.len(),
            film,
            corrections: corrections(&asks),
            finished_s: None,
            answer,
        });
    }
    if registry.is_final(point) || is_taken(&ended.campaign, point) {
        return None;
    }
    let share = Random(seed ^ 0xe7e7).unit();
    let result = |probe: Probe| -> Option<ProbeResult> {
        let known = registry.runs().get(&registry.key(point, probe));
        Some(known.map_or_else(
            || ended.result(input, point, probe, share),
            |known| known.result.clone(),
        ))
    };
    let from = interval_input(input, &ended.campaign, point, &result)?;
    let (asks, answer) = made_up(&from, &[]);
    Some(Interval {
        ramp,
        left_s: all_s(&asks),
        runs: asks.len(),
        film,
        corrections: corrections(&asks),
        finished_s: None,
        answer,
    })
}

/// Levels at which these runs need the film's defect correction sampled anew.
fn corrections(asks: &[(Ask, bool)]) -> BTreeSet<i8> {
    let levels = asks
        .iter()
        .map(|(ask, _)| ask.levels.of(Discretisation::FilmCorrection));
    levels.filter(|&level| level > 0).collect()
}

/// The point's interval is that of the same point without ramp.
fn is_taken(campaign: &Campaign, point: usize) -> bool {
    let companion = campaign.order().relations[point].companion;
    companion.is_some() && campaign.findings(point).flags.contains(&Flag::NoTouch)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An open interval of a film that samples defect corrections at these levels.
    fn interval(number: usize, levels: &[i8]) -> Interval {
        Interval {
            ramp: Ramp::None,
            left_s: 1.0,
            runs: 10,
            film: PointFilm {
                number,
                cells: 400,
                kept: [false; 2],
            },
            corrections: levels.iter().copied().collect(),
            finished_s: None,
            answer: None,
        }
    }

    #[test]
    fn a_defect_correction_is_sampled_once_while_those_who_need_it_wait() {
        let mut pace = Pace::default();
        pace.set_plain(Ramp::None, 0.1);
        // A unit takes 0.1 s, a level n of the preset coarse 6.7 (4^n) units.
        let (first_s, second_s) = (2.68, 10.72);
        for (open, threads, expected) in [
            (vec![], 4, vec![]),
            (vec![interval(0, &[1])], 4, vec![first_s]),
            // Two threads have an interval, whatever their number.
            (
                vec![interval(0, &[1]), interval(0, &[1, 2])],
                16,
                vec![first_s + second_s, first_s],
            ),
            // One of the two other intervals waits.
            (
                vec![interval(0, &[1]), interval(0, &[1]), interval(0, &[])],
                2,
                vec![first_s, 0.5 * first_s],
            ),
            // Unlike films have each their own.
            (
                vec![interval(0, &[1]), interval(1, &[1])],
                1,
                vec![2.0 * first_s],
            ),
        ] {
            let found = sampled_s(&open, &pace, threads);
            assert_eq!(found.len(), expected.len());
            let pairs = found.iter().zip(&expected);
            let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-12, "{found:?}, expected {expected:?}");
        }
    }
}
