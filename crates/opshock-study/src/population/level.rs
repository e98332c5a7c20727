//! Verdict on a drive's point by few shocks, at amplitudes a fixed ratio apart: the required one and those around it.
//!
//! ```text
//! A_k = A 2^(k/8),   k = -16 to 16,   A the required amplitude
//! ```
//!
//! Three shocks judge a point: at A, at A again with every discretisation parameter a step coarser, and at A_2 where it survives
//! or at A_-2 where it fails. It passes when it survives all of them and the clearance h at A stays above that of failure within its
//! numerical error,
//!
//! ```text
//! h(0) - F |h(0) - h(-1)| / (r - 1) > h_fail,   F = 3, r = 2
//! ```
//!
//! by Roache's factor of safety without an observed order (Roache 1994, J. Fluids Eng. 116, 405) and the slowest formal ratio.
//! It fails when it fails all of them. Where the coarser shock leaves this open, a shock at A a step finer takes its place, with h(1) and
//! h(0). Of any other point the uncertainty interval of the critical shock decides, as in a qualification.
//! `docs/results/verify-yield.txt` compares both.

use crate::qualification::Verdict;

/// Amplitudes per octave.
pub const STEPS_PER_OCTAVE: i32 = 8;
/// Steps beyond the required amplitude whose verdict confirms that at the required one.
pub const CONFIRMED: i32 = 2;
/// Factor of safety over the slowest formal ratio less 1.
const FACTOR: f64 = 3.0;
/// Steps of the farthest amplitudes: a quarter of the required one and four times it.
pub const FARTHEST: i32 = 16;

/// Amplitude a number of steps from the required one, G.
pub fn amplitude_g(required_g: f64, step: i32) -> f64 {
    match step {
        0 => required_g,
        _ => required_g * (f64::from(step) / f64::from(STEPS_PER_OCTAVE)).exp2(),
    }
}

/// Outcome of a shock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// It survives with this smallest clearance, m.
    Survives(Option<f64>),
    /// It fails.
    Fails,
    /// No verdict.
    Undecided,
}

/// What a point answers: outcomes of shocks, and the verdict by its uncertainty interval.
pub trait Levels {
    /// Why there is no answer, as after a stop.
    type Interrupted;

    /// Outcome at a step of the amplitude, with every discretisation parameter refined so many times, or coarsened.
    fn shock(&mut self, step: i32, refined: i8) -> Result<Level, Self::Interrupted>;

    /// Clearance that is called failure, m.
    fn failure_m(&self) -> f64;

    /// Verdict by the uncertainty interval of the critical shock.
    fn interval(&mut self) -> Result<Verdict, Self::Interrupted>;
}

/// What decides a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecidedBy {
    /// Shocks at the study's resolution and a step coarser.
    Shocks,
    /// The same with one a step finer.
    FinerShock,
    /// The uncertainty interval of the critical shock.
    Interval,
}

/// Answer of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelAnswer {
    /// The verdict at the required amplitude.
    pub verdict: Verdict,
    /// What decided it.
    pub by: DecidedBy,
    /// Step of the highest survivor below the lowest failure.
    pub survives: Option<i32>,
    /// Step of the lowest failure.
    pub fails: Option<i32>,
    /// Smallest clearance at the highest survivor of the required amplitude and the one that confirms it, m.
    pub clearance_m: Option<f64>,
}

/// Outcomes so far.
struct Outcomes<'a, L: Levels> {
    levels: &'a mut L,
    known: Vec<(i32, Level)>,
}

impl<L: Levels> Outcomes<'_, L> {
    fn at(&mut self, step: i32) -> Result<Level, L::Interrupted> {
        if let Some((_, level)) = self.known.iter().find(|(known, _)| *known == step) {
            return Ok(*level);
        }
        let level = self.levels.shock(step, 0)?;
        self.known.push((step, level));
        Ok(level)
    }

    fn lowest_failure(&self) -> Option<i32> {
        let failing = self
            .known
            .iter()
            .filter(|(_, level)| *level == Level::Fails);
        failing.map(|(step, _)| *step).min()
    }

    fn highest_survivor(&self) -> Option<(i32, Option<f64>)> {
        let below = self.lowest_failure().unwrap_or(i32::MAX);
        let surviving = self.known.iter().filter_map(|&(step, level)| match level {
            Level::Survives(clearance_m) if step < below => Some((step, clearance_m)),
            _ => None,
        });
        surviving.max_by_key(|(step, _)| *step)
    }

    /// Looks for a survivor below the lowest failure and a failure above the highest survivor, in growing steps, then
    /// halves to neighbours. An outcome without verdict ends the search.
    fn bracket(&mut self) -> Result<(), L::Interrupted> {
        let mut further = CONFIRMED;
        while self.highest_survivor().is_none() || self.lowest_failure().is_none() {
            let next = match (self.highest_survivor(), self.lowest_failure()) {
                (Some((survivor, _)), None) => survivor + further,
                (None, Some(failure)) => failure - further,
                _ => return Ok(()),
            };
            let next = next.clamp(-FARTHEST, FARTHEST);
            let is_known = self.known.iter().any(|(known, _)| *known == next);
            if is_known || self.at(next)? == Level::Undecided {
                return Ok(());
            }
            further *= 2;
        }
        while let (Some((survivor, _)), Some(failure)) =
            (self.highest_survivor(), self.lowest_failure())
            && failure - survivor > 1
        {
            if self.at(survivor + (failure - survivor) / 2)? == Level::Undecided {
                break;
            }
        }
        Ok(())
    }
}

/// Judges a point; `is_bracketed` asks for its critical shock to one step even where it passes.
///
/// # Errors
/// Where an outcome or the interval has none to give.
pub fn judge<L: Levels>(levels: &mut L, is_bracketed: bool) -> Result<LevelAnswer, L::Interrupted> {
    let mut known = Outcomes {
        levels,
        known: Vec::new(),
    };
    let here = known.at(0)?;
    let is_confirmed = match here {
        Level::Survives(_) => matches!(known.at(CONFIRMED)?, Level::Survives(_)),
        Level::Fails => known.at(-CONFIRMED)? == Level::Fails,
        Level::Undecided => false,
    };
    let clearance_m = known
        .highest_survivor()
        .and_then(|(_, clearance_m)| clearance_m);
    let failure_m = known.levels.failure_m();
    let by = match is_confirmed {
        false => DecidedBy::Interval,
        // Without a clearance no other resolution says how far it is from failing.
        true if here == Level::Survives(None) => DecidedBy::Interval,
        true if agree(here, known.levels.shock(0, -1)?, failure_m) => DecidedBy::Shocks,
        true if agree(known.levels.shock(0, 1)?, here, failure_m) => DecidedBy::FinerShock,
        true => DecidedBy::Interval,
    };
    let verdict = match (by, here) {
        (DecidedBy::Interval, _) => known.levels.interval()?,
        (_, Level::Fails) => Verdict::Fails,
        _ => Verdict::Passes,
    };
    if is_bracketed || verdict == Verdict::Fails {
        known.bracket()?;
    }
    let survivor = known.highest_survivor();
    Ok(LevelAnswer {
        verdict,
        by,
        survives: survivor.map(|(step, _)| step),
        fails: known.lowest_failure(),
        clearance_m,
    })
}

/// Whether the same shock has one outcome at a resolution and a step coarser, and a clearance above that of failure within its error.
fn agree(outcome: Level, coarser: Level, failure_m: f64) -> bool {
    match (outcome, coarser) {
        (Level::Survives(Some(h_m)), Level::Survives(Some(coarser_m))) => {
            h_m - FACTOR * (h_m - coarser_m).abs() > failure_m
        }
        (Level::Fails, Level::Fails) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fails from a step on, and in single steps below. Its clearance, nm, is the distance to that step.
    struct Law {
        fails_from: i32,
        holes: Vec<i32>,
        /// Change of that step by a coarser and by a finer resolution.
        moved: [i32; 2],
        shocks: Vec<i32>,
        others: Vec<i8>,
        intervals: u32,
    }

    impl Levels for Law {
        type Interrupted = std::convert::Infallible;

        fn shock(&mut self, step: i32, refined: i8) -> Result<Level, Self::Interrupted> {
            match refined {
                0 => self.shocks.push(step),
                _ => self.others.push(refined),
            }
            let fails_from = self.fails_from
                + match refined {
                    -1 => self.moved[0],
                    1 => self.moved[1],
                    _ => 0,
                };
            let fails = step >= fails_from || self.holes.contains(&step);
            Ok(if fails {
                Level::Fails
            } else {
                Level::Survives(Some(1e-9 * f64::from(fails_from - step)))
            })
        }

        fn failure_m(&self) -> f64 {
            0.0
        }

        fn interval(&mut self) -> Result<Verdict, Self::Interrupted> {
            self.intervals += 1;
            Ok(Verdict::Undecided)
        }
    }

    fn law(fails_from: i32, holes: &[i32]) -> Law {
        Law {
            fails_from,
            holes: holes.to_vec(),
            moved: [0, 0],
            shocks: Vec::new(),
            others: Vec::new(),
            intervals: 0,
        }
    }

    #[test]
    fn far_points_need_three_shocks_and_near_ones_their_interval() {
        for fails_from in -20..=20 {
            let mut point = law(fails_from, &[]);
            let answer = judge(&mut point, false).expect("no stop");
            let wanted = match fails_from {
                3.. => Verdict::Passes,
                ..=-2 => Verdict::Fails,
                _ => Verdict::Undecided,
            };
            assert_eq!(answer.verdict, wanted, "{fails_from}");
            assert_eq!(point.intervals, u32::from(wanted == Verdict::Undecided));
            if wanted == Verdict::Passes {
                assert_eq!((point.shocks, point.others), (vec![0, 2], vec![-1]));
            }
        }
    }

    #[test]
    fn a_clearance_that_coarsening_moves_by_a_third_of_itself_is_refined() {
        // 9 nm at the required amplitude; three times the change is to be less.
        let by = |coarser: i32, finer: i32| {
            let mut point = law(9, &[]);
            point.moved = [coarser, finer];
            let answer = judge(&mut point, false).expect("no stop");
            assert_eq!(point.intervals, u32::from(answer.by == DecidedBy::Interval));
            answer.by
        };
        assert_eq!(by(-2, 0), DecidedBy::Shocks);
        assert_eq!(by(2, 0), DecidedBy::Shocks);
        assert_eq!(by(-3, 1), DecidedBy::FinerShock);
        assert_eq!(by(3, -2), DecidedBy::FinerShock);
        // The finer one has 6 nm, a change of 3.
        assert_eq!(by(3, -3), DecidedBy::Interval);
        assert_eq!(by(-9, -9), DecidedBy::Interval);
        assert_eq!(by(-9, 1), DecidedBy::FinerShock);
    }

    #[test]
    fn brackets_are_neighbours_and_each_amplitude_is_simulated_once() {
        for fails_from in -15..=16 {
            let mut point = law(fails_from, &[]);
            let answer = judge(&mut point, true).expect("no stop");
            assert_eq!(
                (answer.survives, answer.fails),
                (Some(fails_from - 1), Some(fails_from))
            );
            let mut once = point.shocks.clone();
            once.sort_unstable();
            once.dedup();
            assert_eq!(once.len(), point.shocks.len(), "{:?}", point.shocks);
            assert!(point.shocks.len() <= 9, "{:?}", point.shocks);
        }
        // Beyond the farthest amplitudes one side stays open.
        let beyond = judge(&mut law(40, &[]), true).expect("no stop");
        assert_eq!((beyond.survives, beyond.fails), (Some(FARTHEST), None));
        let below = judge(&mut law(-40, &[]), true).expect("no stop");
        assert_eq!((below.survives, below.fails), (None, Some(-FARTHEST)));
    }

    #[test]
    fn a_failure_below_survivors_is_no_pass() {
        // Fails at the required amplitude, survives above and below.
        let answer = judge(&mut law(10, &[0]), false).expect("no stop");
        assert_eq!(answer.by, DecidedBy::Interval);
        assert_eq!((answer.survives, answer.fails), (Some(-2), Some(0)));
    }

    #[test]
    fn steps_are_an_eighth_of_an_octave() {
        assert_eq!(amplitude_g(400.0, 0), 400.0);
        assert_eq!(amplitude_g(400.0, 8), 800.0);
        assert!((amplitude_g(400.0, CONFIRMED) / 400.0 - 1.189_207_115).abs() < 1e-9);
    }
}
