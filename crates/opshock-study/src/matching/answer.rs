//! What a search says: matching sets, shares of the prior, conflicts, ranges, and what to measure next.

use super::file::MatchProblem;
use super::observation::{Known, RULED_OUT, Stage};
use super::search::{Ended, Sample, Searched, WaveReport, hull};
use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF as _};

/// Sets of the gallery.
const GALLERY: usize = 12;
/// Largest group of observations that is looked at.
const LARGEST_GROUP: usize = 4;
/// Groups listed at most.
const MOST_GROUPS: usize = 200;
/// Plausible sets for every parameter and one from which ranges are told.
const SETS_A_DIMENSION: usize = 10;
/// Numbers compared for what a further measurement would leave.
const MOST_PAIRED: usize = 400;

/// A share of the prior.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Draws with it.
    pub with: u64,
    /// Independent draws of the prior.
    pub of: u64,
    /// Ends of the exact binomial interval of 95 % (Clopper and Pearson 1934, Biometrika 26, 404); with none, the upper end
    /// is one-sided, about 3/n.
    pub interval: [f64; 2],
}

impl Share {
    /// Of `with` among `of` independent draws.
    pub fn of(with: u64, of: u64) -> Self {
        let (k, n) = (with as f64, of as f64);
        let quantile =
            |a: f64, b: f64, p: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
        let interval = match (with, of) {
            (_, 0) => [0.0, 1.0],
            (0, _) => [0.0, 1.0 - 0.05_f64.powf(1.0 / n)],
            (k, n) if k == n => [0.05_f64.powf(1.0 / n as f64), 1.0],
            _ => [
                quantile(k, n - k + 1.0, 0.025),
                quantile(k + 1.0, n - k, 0.975),
            ],
        };
        Self { with, of, interval }
    }
}

/// An observation's line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObservationRow {
    /// Name.
    pub name: String,
    /// Where it comes from.
    pub source: String,
    /// Stage of cost.
    pub stage: &'static str,
    /// Lowest and highest number with which it is true; absent for numbers that are only reported, and open ends.
    pub range: Option<[Option<f64>; 2]>,
    /// Typical numerical uncertainty: the median over the sets.
    pub numerical_uncertainty: f64,
    /// Share of the prior that makes it true.
    pub share: Option<Share>,
    /// Share that does not rule it out.
    pub plausible: Option<Share>,
    /// Number with the best set, and its margin in units of the numerical uncertainty; absent without number or bound.
    pub best: Option<f64>,
    /// Margin of the best set.
    pub best_margin: Option<f64>,
    /// Distance of each parameter's distribution given the observation from that before (Kolmogorov and Smirnov's
    /// statistic, 0 to 1): what it says about the parameter.
    pub says: Vec<Option<f64>>,
}

/// A parameter's line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterRow {
    /// Name.
    pub name: String,
    /// Keys.
    pub keys: Vec<String>,
    /// Where the range comes from.
    pub source: String,
    /// First and last value of the prior, in the words of a study.
    pub before: [String; 2],
    /// Those left; absent where too few plausible sets were found to tell.
    pub after: Option<[String; 2]>,
    /// Cumulative probabilities of both.
    pub after_probability: Option<[f64; 2]>,
}

/// A parameter set that makes every observation true, or the best there is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MatchingSet {
    /// Values of the parameters, in their order.
    pub values: Vec<String>,
    /// Cumulative probabilities.
    pub unit: Vec<f64>,
    /// Smallest margin, in units of the numerical uncertainty; absent where it is without bound.
    pub smallest_margin: Option<f64>,
    /// Observation that has it.
    pub decided_by: String,
    /// Observations that do not hold.
    pub fails: Vec<String>,
}

/// Observations that no set satisfies together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Conflict {
    /// Their names; none of them can be left out.
    pub observations: Vec<String>,
    /// Sets, of all waves, of which all of them are known.
    pub tried: u64,
    /// Independent draws among these, none of which satisfies all.
    pub share: Share,
}

/// What measuring a number would leave of the matching sets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Narrowing {
    /// Observation.
    pub observation: String,
    /// Expected share of the sets that agree with the measured number within twice its uncertainty.
    pub expected_left: f64,
}

/// All that is told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MatchAnswer {
    /// Name of the match.
    pub name: String,
    /// Whether all that was asked for was computed.
    pub is_complete: bool,
    /// Observations.
    pub observations: Vec<ObservationRow>,
    /// Share of the prior that makes all true.
    pub all: Share,
    /// Share that nothing rules out.
    pub not_ruled_out: Share,
    /// Parameters.
    pub parameters: Vec<ParameterRow>,
    /// Sets with which every observation holds, the one with the largest smallest margin first, then as far apart as can
    /// be.
    pub matching: Vec<MatchingSet>,
    /// Number of all such sets that were met.
    pub n_matching: u64,
    /// The best set where none holds everything.
    pub nearest: Option<MatchingSet>,
    /// Smallest groups that no set satisfies together.
    pub conflicts: Vec<Conflict>,
    /// What to measure next, the most telling first.
    pub next: Vec<Narrowing>,
    /// Sets tried, over all waves.
    pub tried: u64,
    /// What every wave did.
    #[serde(skip)]
    pub waves: Vec<WaveReport>,
}

impl MatchAnswer {
    /// From what was searched.
    pub fn of(problem: &MatchProblem, found: &Searched) -> Self {
        let told = Told { problem, found };
        let whole: Vec<&Sample> = found
            .samples
            .iter()
            .filter(|one| told.is_whole(one))
            .collect();
        let mut holding: Vec<&Sample> = whole
            .iter()
            .copied()
            .filter(|one| told.fails(one).is_empty())
            .collect();
        holding.sort_by(|a, b| told.smallest(b).0.total_cmp(&told.smallest(a).0));
        let nearest = whole.iter().max_by(|a, b| {
            let order = |one: &Sample| std::cmp::Reverse(told.fails(one).len());
            order(a)
                .cmp(&order(b))
                .then(told.shortfall(b).total_cmp(&told.shortfall(a)))
        });
        let best = holding.first().or(nearest).copied();
        let gallery = spread(&holding);
        let draws = &found.samples[..found.draws];
        let asked: Vec<&Sample> = draws.iter().filter(|one| told.is_whole(one)).collect();
        let all = asked
            .iter()
            .filter(|one| told.fails(one).is_empty())
            .count();
        let left = asked.iter().filter(|one| !told.is_ruled_out(one)).count();
        Self {
            name: problem.name.clone(),
            is_complete: found.ended == Ended::Complete,
            observations: (0..problem.observations.len())
                .map(|k| told.observation(k, best))
                .collect(),
            all: Share::of(all as u64, asked.len() as u64),
            not_ruled_out: Share::of(left as u64, asked.len() as u64),
            parameters: told.parameters(&whole),
            matching: gallery.into_iter().map(|one| told.set(one)).collect(),
            n_matching: holding.len() as u64,
            nearest: match holding.is_empty() {
                true => nearest.map(|one| told.set(one)),
                false => None,
            },
            conflicts: told.conflicts(),
            next: told.next(&whole),
            tried: found.waves.iter().map(|wave| wave.tried).sum(),
            waves: found.waves.clone(),
        }
    }
}

struct Told<'a> {
    problem: &'a MatchProblem,
    found: &'a Searched,
}

impl Told<'_> {
    fn is_whole(&self, sample: &Sample) -> bool {
        sample
            .numbers
            .iter()
            .all(|(known, _)| *known != Known::NotAsked)
    }

    fn is_ruled_out(&self, sample: &Sample) -> bool {
        let mut all = self.problem.observations.iter().zip(&sample.numbers);
        all.any(|(one, (known, u))| {
            one.implausibility(*known, *u)
                .is_some_and(|i| i >= RULED_OUT)
        })
    }

    fn fails(&self, sample: &Sample) -> Vec<usize> {
        let holds =
            |k: &usize| self.problem.observations[*k].holds(sample.numbers[*k].0) == Some(false);
        (0..self.problem.observations.len()).filter(holds).collect()
    }

    /// Smallest margin and its observation.
    fn smallest(&self, sample: &Sample) -> (f64, Option<usize>) {
        let margins = self
            .problem
            .observations
            .iter()
            .zip(&sample.numbers)
            .enumerate();
        margins
            .filter_map(|(k, (one, (known, u)))| Some((one.margin(*known, *u)?, Some(k))))
            .fold((f64::INFINITY, None), |least, one| {
                if one.0 < least.0 { one } else { least }
            })
    }

    /// What the observations that fail lack together.
    fn shortfall(&self, sample: &Sample) -> f64 {
        let margins = self.problem.observations.iter().zip(&sample.numbers);
        let margins = margins.filter_map(|(one, (known, u))| one.margin(*known, *u));
        margins
            .filter(|margin| *margin < 0.0)
            .map(|margin| (-margin).min(1e3).ln_1p())
            .sum()
    }

    fn observation(&self, place: usize, best: Option<&Sample>) -> ObservationRow {
        let one = &self.problem.observations[place];
        let draws = || self.found.samples[..self.found.draws].iter();
        let asked: Vec<&Sample> = draws()
            .filter(|sample| sample.numbers[place].0 != Known::NotAsked)
            .collect();
        let holding = asked
            .iter()
            .filter(|sample| one.holds(sample.numbers[place].0) == Some(true));
        let holding: Vec<&Sample> = holding.copied().collect();
        let plausible = asked.iter().filter(|sample| {
            let (known, u) = sample.numbers[place];
            one.implausibility(known, u).is_some_and(|i| i < RULED_OUT)
        });
        let n = asked.len() as u64;
        let share = |with: usize| one.range.map(|_| Share::of(with as u64, n));
        let finite = |end: f64| end.is_finite().then_some(end);
        let mut us: Vec<f64> = asked.iter().map(|sample| sample.numbers[place].1).collect();
        us.sort_by(f64::total_cmp);
        ObservationRow {
            name: one.name.clone(),
            source: one.source.clone(),
            stage: one.stage.words(),
            range: one.range.map(|ends| ends.map(finite)),
            numerical_uncertainty: us.get(us.len() / 2).copied().unwrap_or(0.0),
            share: share(holding.len()),
            plausible: share(plausible.count()),
            best: best.and_then(|best| match best.numbers[place].0 {
                Known::Is(value) => Some(value),
                _ => None,
            }),
            best_margin: best
                .and_then(|best| one.margin(best.numbers[place].0, best.numbers[place].1))
                .filter(|margin| margin.is_finite()),
            says: (0..self.problem.parameters.len())
                .map(|d| {
                    one.range
                        .and_then(|_| kolmogorov(holding.iter().map(|sample| sample.unit[d])))
                })
                .collect(),
        }
    }

    /// What is left of the ranges. The hull of n sets lacks about n^(-2/(d+1)) of the width of a smooth convex body in d
    /// dimensions at each side (as the largest of n projections of its points); it is given back. A few sets say nothing
    /// about ranges.
    fn parameters(&self, whole: &[&Sample]) -> Vec<ParameterRow> {
        let left: Vec<&[f64]> = whole
            .iter()
            .filter(|one| !self.is_ruled_out(one))
            .map(|one| &one.unit[..])
            .collect();
        let d = self.problem.parameters.len();
        let ends = hull(left.iter().copied(), d);
        let lacking = (left.len() as f64).powf(-2.0 / (d as f64 + 1.0));
        let rows = self.problem.parameters.iter().zip(ends);
        rows.map(|(parameter, [low, high])| {
            let by = lacking * (high - low);
            let after = (left.len() >= SETS_A_DIMENSION * (d + 1))
                .then(|| [(low - by).max(0.0), (high + by).min(1.0)]);
            ParameterRow {
                name: parameter.name.clone(),
                keys: parameter.keys.iter().map(|(key, _)| key.clone()).collect(),
                source: parameter.source.clone(),
                before: [0.0, 1.0].map(|p| parameter.words(p)),
                after: after.map(|ends| ends.map(|p| parameter.words(p))),
                after_probability: after,
            }
        })
        .collect()
    }

    fn set(&self, sample: &Sample) -> MatchingSet {
        let (margin, by) = self.smallest(sample);
        let name = |k: usize| self.problem.observations[k].name.clone();
        let values = self.problem.parameters.iter().zip(&sample.unit);
        MatchingSet {
            values: values.map(|(parameter, p)| parameter.words(*p)).collect(),
            unit: sample.unit.clone(),
            smallest_margin: Some(margin).filter(|margin| margin.is_finite()),
            decided_by: by.map(name).unwrap_or_default(),
            fails: self.fails(sample).into_iter().map(name).collect(),
        }
    }

    /// Smallest groups of observations that no set satisfies together.
    fn conflicts(&self) -> Vec<Conflict> {
        let ranged: Vec<usize> = (0..self.problem.observations.len())
            .filter(|k| self.problem.observations[*k].range.is_some())
            .collect();
        let samples = &self.found.samples;
        let words = samples.len().div_ceil(64);
        let bits = |is: &dyn Fn(&Sample, usize) -> bool, k: usize| {
            let mut set = vec![0_u64; words];
            for (place, sample) in samples.iter().enumerate() {
                if is(sample, k) {
                    set[place / 64] |= 1 << (place % 64);
                }
            }
            set
        };
        let holds = |sample: &Sample, k: usize| {
            self.problem.observations[k].holds(sample.numbers[k].0) == Some(true)
        };
        let known = |sample: &Sample, k: usize| sample.numbers[k].0 != Known::NotAsked;
        let holding: Vec<Vec<u64>> = ranged.iter().map(|k| bits(&holds, *k)).collect();
        let asked: Vec<Vec<u64>> = ranged.iter().map(|k| bits(&known, *k)).collect();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut level: Vec<(Vec<usize>, Vec<u64>)> = vec![(Vec::new(), vec![u64::MAX; words])];
        for _ in 0..LARGEST_GROUP {
            let mut next = Vec::new();
            for (group, set) in &level {
                for k in group.last().map_or(0, |last| last + 1)..ranged.len() {
                    let mut larger = group.clone();
                    larger.push(k);
                    if groups
                        .iter()
                        .any(|small| small.iter().all(|one| larger.contains(one)))
                    {
                        continue;
                    }
                    let both: Vec<u64> = set.iter().zip(&holding[k]).map(|(a, b)| a & b).collect();
                    match both.iter().any(|word| *word != 0) {
                        true => next.push((larger, both)),
                        false => groups.push(larger),
                    }
                }
            }
            level = next;
        }
        let conflicts = groups.into_iter().map(|group| {
            let tried = (0..words).map(|w| {
                let all = group.iter().fold(u64::MAX, |all, k| all & asked[*k][w]);
                (w, all)
            });
            let mut counts = [0_u64; 2];
            for (w, all) in tried {
                counts[0] += u64::from(all.count_ones());
                let first = 64 * w;
                let draws = self.found.draws.saturating_sub(first).min(64);
                let mask = if draws == 64 {
                    u64::MAX
                } else {
                    (1_u64 << draws) - 1
                };
                counts[1] += u64::from((all & mask).count_ones());
            }
            Conflict {
                observations: group
                    .iter()
                    .map(|k| self.problem.observations[ranged[*k]].name.clone())
                    .collect(),
                tried: counts[0],
                share: Share::of(0, counts[1]),
            }
        });
        let mut conflicts: Vec<Conflict> = conflicts.filter(|one| one.tried > 0).collect();
        conflicts.truncate(MOST_GROUPS);
        conflicts
    }

    /// Over all pairs of sets that nothing rules out: how often the second agrees with the number of the first.
    fn next(&self, whole: &[&Sample]) -> Vec<Narrowing> {
        let left = whole
            .iter()
            .filter(|one| !self.is_ruled_out(one))
            .take(MOST_PAIRED);
        let left: Vec<&Sample> = left.copied().collect();
        if left.len() < 2 {
            return Vec::new();
        }
        let mut next: Vec<Narrowing> = Vec::new();
        for (place, one) in self.problem.observations.iter().enumerate() {
            // Counts and verdicts are told by whether they hold.
            let number = |sample: &Sample| match sample.numbers[place] {
                (Known::Is(value), u) => {
                    Some((value, u.hypot(one.observed_u).hypot(one.discrepancy_u)))
                }
                _ => None,
            };
            let agree = left.iter().map(|a| {
                let like = left.iter().filter(|b| match (number(a), number(b)) {
                    (Some((x, u)), Some((y, _))) => (x - y).abs() <= 2.0 * u,
                    (None, None) => true,
                    _ => false,
                });
                like.count() as f64 / left.len() as f64
            });
            next.push(Narrowing {
                observation: one.name.clone(),
                expected_left: agree.sum::<f64>() / left.len() as f64,
            });
        }
        next.sort_by(|a, b| a.expected_left.total_cmp(&b.expected_left));
        next
    }
}

/// The first set, then each the farthest from those before.
fn spread<'s>(sets: &[&'s Sample]) -> Vec<&'s Sample> {
    let mut chosen: Vec<&Sample> = sets.first().copied().into_iter().collect();
    let apart = |a: &Sample, b: &Sample| {
        a.unit
            .iter()
            .zip(&b.unit)
            .map(|(x, y)| (x - y).powi(2))
            .sum::<f64>()
    };
    while !chosen.is_empty() && chosen.len() < GALLERY.min(sets.len()) {
        let nearest = |one: &Sample| {
            chosen
                .iter()
                .map(|known| apart(one, known))
                .fold(f64::INFINITY, f64::min)
        };
        let Some(far) = sets
            .iter()
            .copied()
            .max_by(|a, b| nearest(a).total_cmp(&nearest(b)))
        else {
            break;
        };
        if nearest(far) == 0.0 {
            break;
        }
        chosen.push(far);
    }
    chosen
}

/// Largest distance of the empirical distribution of some numbers from the uniform one from 0 to 1; `None` of none.
fn kolmogorov(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = numbers.collect();
    all.sort_by(f64::total_cmp);
    let n = all.len() as f64;
    let steps = all.iter().enumerate();
    steps
        .map(|(k, x)| (x - k as f64 / n).abs().max(((k + 1) as f64 / n - x).abs()))
        .max_by(f64::total_cmp)
}

impl MatchAnswer {
    /// Observations with a range that the best set satisfies, and all of them.
    pub fn held(&self) -> [usize; 2] {
        let ranged = self
            .observations
            .iter()
            .filter(|one| one.range.is_some())
            .count();
        let best = self.matching.first().or(self.nearest.as_ref());
        [best.map_or(0, |best| ranged - best.fails.len()), ranged]
    }

    /// Whether a stage was asked of the problem.
    pub fn has(&self, stage: Stage) -> bool {
        self.observations
            .iter()
            .any(|one| one.stage == stage.words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_have_exact_intervals() {
        // Clopper and Pearson: 10 of 100 is 4.90 % to 17.62 % (R: binom.test(10, 100)).
        let [low, high] = Share::of(10, 100).interval;
        assert!(
            (low - 0.049_005_4).abs() < 1e-6 && (high - 0.176_222_6).abs() < 1e-6,
            "{low} {high}"
        );
        // The rule of three: none of 3000 is below 0.1 % with 95 %.
        let [_, none] = Share::of(0, 3000).interval;
        assert!((none - 9.980_8e-4).abs() < 1e-7, "{none}");
        assert_eq!(Share::of(0, 0).interval, [0.0, 1.0]);
    }

    #[test]
    fn distances_of_distributions_are_kolmogorovs() {
        // All of the numbers in the lower half: the distribution is 1 at 0.5, where the uniform one is 0.5.
        let halves = (0..1000).map(|k| 0.5 * (f64::from(k) + 0.5) / 1000.0);
        assert!((kolmogorov(halves).expect("numbers") - 0.5).abs() < 1e-3);
        assert_eq!(kolmogorov(std::iter::empty()), None);
    }
}
