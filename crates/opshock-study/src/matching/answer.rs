//! Result of a match: matching sets, shares of the prior, conflicts, ranges, and what to measure next.

use super::conflicts::{Conflict, groups};
use super::file::MatchProblem;
use super::observation::{Known, RULED_OUT};
use super::sample::Sample;
use super::search::hull;
use super::searched::{Ended, Searched, WaveReport};
use crate::draws::ParameterValue;
use crate::draws::Share;
use serde::Serialize;
use std::collections::HashSet;

/// Largest number of conflicting groups listed.
const MOST_GROUPS: usize = 200;
/// Largest number of matching sets listed.
const GALLERY: usize = 12;
/// Plausible sets per parameter, and one more, from which ranges are given.
const SETS_A_DIMENSION: usize = 10;
/// Largest number of sets compared for the effect of a further measurement.
const MOST_PAIRED: usize = 400;

/// Row of an observation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObservationRow {
    /// Name.
    pub name: String,
    /// Source.
    pub source: String,
    /// Stage of cost.
    pub stage: &'static str,
    /// Lowest and highest number with which it is true; absent for numbers that are only reported, and open ends.
    pub range: Option<[Option<f64>; 2]>,
    /// Typical numerical uncertainty: the median over the sets.
    pub numerical_uncertainty: f64,
    /// Share of the prior with which it holds.
    pub share: Option<Share>,
    /// Share of the prior that it does not rule out.
    pub plausible: Option<Share>,
    /// Number with the best set, and its margin in units of the numerical uncertainty; absent without number or bound.
    pub best: Option<f64>,
    /// Margin of the best set.
    pub best_margin: Option<f64>,
    /// Distance of each parameter's distribution given the observation from the prior (Kolmogorov and Smirnov's
    /// statistic, 0 to 1): the information about the parameter.
    pub says: Vec<Option<f64>>,
}

/// Row of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterRow {
    /// Name.
    pub name: String,
    /// Keys.
    pub keys: Vec<String>,
    /// Source of the range.
    pub source: String,
    /// First and last value of the prior, in the words of a study.
    pub before: [String; 2],
    /// First and last value left; absent where too few plausible sets were found.
    pub after: Option<[String; 2]>,
    /// Cumulative probabilities of both.
    pub after_probability: Option<[f64; 2]>,
}

/// A parameter set with which every observation holds, or the best there is.
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
    /// Observations that do not hold by their numerical uncertainty.
    pub falls_short: Vec<String>,
}

/// The best set with each choice of the parameter that `refinement.each` names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BestOfEach {
    /// Parameter.
    pub parameter: String,
    /// Its choices, each with the number of completely known sets, and the best of them.
    pub choices: Vec<(String, u64, Option<MatchingSet>)>,
}

/// Effect of measuring a number on the matching sets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Narrowing {
    /// Observation.
    pub observation: String,
    /// Expected share of the sets that agree with the measured number within twice its uncertainty.
    pub expected_left: f64,
}

/// The result of a match.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MatchAnswer {
    /// Name of the match.
    pub name: String,
    /// Whether everything requested was computed.
    pub is_complete: bool,
    /// Observations.
    pub observations: Vec<ObservationRow>,
    /// Share of the prior with which all hold.
    pub all: Share,
    /// Share of the prior that is not ruled out.
    pub not_ruled_out: Share,
    /// Parameters.
    pub parameters: Vec<ParameterRow>,
    /// Sets with which every observation holds: the one with the largest smallest margin first, then the farthest from
    /// those before.
    pub matching: Vec<MatchingSet>,
    /// Number of all such sets that were found.
    pub n_matching: u64,
    /// The best set where none satisfies all.
    pub nearest: Option<MatchingSet>,
    /// The best set with each choice of a parameter, where the refinement has a search for each.
    pub best_of_each: Option<BestOfEach>,
    /// Smallest groups that no set satisfies together.
    pub conflicts: Vec<Conflict>,
    /// What to measure next, the most informative first.
    pub next: Vec<Narrowing>,
    /// Sets tried, over all waves.
    pub tried: u64,
    /// Every wave.
    #[serde(skip)]
    pub waves: Vec<WaveReport>,
}

impl MatchAnswer {
    /// From the results of a search.
    pub fn of(problem: &MatchProblem, found: &Searched) -> Self {
        let results = Results { problem, found };
        let seen = &problem.observations[..];
        // A set found by several parts of the search is listed once.
        let mut met = HashSet::new();
        let mut is_new = |one: &&Sample| {
            let bits = one.unit.iter().map(|p| p.to_bits());
            met.insert(bits.collect::<Vec<u64>>())
        };
        let whole = found.samples.iter().filter(|one| one.is_whole());
        let whole: Vec<&Sample> = whole.filter(&mut is_new).collect();
        let mut holding: Vec<&Sample> = whole
            .iter()
            .copied()
            .filter(|one| one.fails(seen).is_empty())
            .collect();
        holding.sort_by(|a, b| {
            b.smallest_margin(seen)
                .0
                .total_cmp(&a.smallest_margin(seen).0)
        });
        let nearest = whole.iter().max_by(|a, b| a.order(b, seen, &found.scales));
        let best = holding.first().or(nearest).copied();
        let gallery = spread(&holding);
        let draws = &found.samples[..found.draws];
        let asked: Vec<&Sample> = draws.iter().filter(|one| one.is_whole()).collect();
        let all = asked
            .iter()
            .filter(|one| one.fails(seen).is_empty())
            .count();
        let left = asked.iter().filter(|one| !one.is_ruled_out(seen)).count();
        Self {
            name: problem.name.clone(),
            is_complete: found.ended == Ended::Complete,
            observations: (0..problem.observations.len())
                .map(|k| results.observation(k, best))
                .collect(),
            all: Share::of(all as u64, asked.len() as u64),
            not_ruled_out: Share::of(left as u64, asked.len() as u64),
            parameters: results.parameters(&whole),
            matching: gallery.into_iter().map(|one| results.set(one)).collect(),
            n_matching: holding.len() as u64,
            nearest: match holding.is_empty() {
                true => nearest.map(|one| results.set(one)),
                false => None,
            },
            best_of_each: problem
                .effort
                .each
                .map(|place| results.best_of_each(place, &whole)),
            conflicts: groups(problem, found)
                .into_iter()
                .map(|(_, one)| one)
                .take(MOST_GROUPS)
                .collect(),
            next: results.next(&whole),
            tried: found.waves.iter().map(|wave| wave.tried).sum(),
            waves: found.waves.clone(),
        }
    }
}

struct Results<'a> {
    problem: &'a MatchProblem,
    found: &'a Searched,
}

impl Results<'_> {
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

    /// Ranges left. The hull of n sets lacks about n^(-2/(d+1)) of the width of a smooth convex body in d dimensions at
    /// each side (as the largest of n projections of its points); the range is widened by as much. A few sets give no
    /// range.
    fn parameters(&self, whole: &[&Sample]) -> Vec<ParameterRow> {
        let left: Vec<&[f64]> = whole
            .iter()
            .filter(|one| !one.is_ruled_out(&self.problem.observations))
            .map(|one| &one.unit[..])
            .collect();
        let d = self.problem.parameters.len();
        let ends = hull(left.iter().copied(), d);
        // A refinement's sets lie close together: they may widen the hull, but not make it denser.
        let n = whole.iter().filter(|one| self.is_explored(one)).count();
        let lacking = (n as f64).powf(-2.0 / (d as f64 + 1.0));
        let rows = self.problem.parameters.iter().zip(ends);
        rows.map(|(parameter, [low, high])| {
            let by = lacking * (high - low);
            let after = (n >= SETS_A_DIMENSION * (d + 1))
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

    /// A plausible set of the draws or of a wave.
    fn is_explored(&self, sample: &Sample) -> bool {
        sample.wave.is_some() && !sample.is_ruled_out(&self.problem.observations)
    }

    fn set(&self, sample: &Sample) -> MatchingSet {
        let (margin, by) = sample.smallest_margin(&self.problem.observations);
        let name = |k: usize| self.problem.observations[k].name.clone();
        let values = self.problem.parameters.iter().zip(&sample.unit);
        MatchingSet {
            values: values.map(|(parameter, p)| parameter.words(*p)).collect(),
            unit: sample.unit.clone(),
            smallest_margin: Some(margin).filter(|margin| margin.is_finite()),
            decided_by: by.map(name).unwrap_or_default(),
            fails: sample
                .fails(&self.problem.observations)
                .into_iter()
                .map(name)
                .collect(),
            falls_short: sample
                .falls_short(&self.problem.observations)
                .into_iter()
                .map(name)
                .collect(),
        }
    }

    fn best_of_each(&self, place: usize, whole: &[&Sample]) -> BestOfEach {
        let parameter = &self.problem.parameters[place];
        let choices = parameter.choices().iter().enumerate();
        let row = |(choice, text): (usize, &String)| {
            let value = ParameterValue::Choice(choice);
            let those = || {
                whole
                    .iter()
                    .filter(|one| parameter.value(one.unit[place]) == value)
            };
            let best =
                those().max_by(|a, b| a.order(b, &self.problem.observations, &self.found.scales));
            let best = best.map(|one| self.set(one));
            (text.clone(), those().count() as u64, best)
        };
        BestOfEach {
            parameter: parameter.name.clone(),
            choices: choices.map(row).collect(),
        }
    }

    /// Over all pairs of sets that are not ruled out: how often the second agrees with the number of the first.
    fn next(&self, whole: &[&Sample]) -> Vec<Narrowing> {
        let left = whole
            .iter()
            .filter(|one| self.is_explored(one))
            .take(MOST_PAIRED);
        let left: Vec<&Sample> = left.copied().collect();
        if left.len() < 2 {
            return Vec::new();
        }
        let mut next: Vec<Narrowing> = Vec::new();
        for (place, one) in self.problem.observations.iter().enumerate() {
            // For whole numbers and verdicts, agreement is that both hold or neither.
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

/// Largest distance of the empirical distribution of some numbers from the uniform one from 0 to 1; `None` without any.
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
    /// Observations with a range.
    pub fn ranged(&self) -> usize {
        let ranged = self.observations.iter().filter(|one| one.range.is_some());
        ranged.count()
    }

    /// Observations with a range that the best set satisfies, and all of them.
    pub fn held(&self) -> [usize; 2] {
        let best = self.matching.first().or(self.nearest.as_ref());
        [
            best.map_or(0, |best| self.ranged() - best.fails.len()),
            self.ranged(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_distributions_are_kolmogorovs() {
        // All numbers are in the lower half: the distribution is 1 at 0.5, where the uniform one is 0.5.
        let halves = (0..1000).map(|k| 0.5 * (f64::from(k) + 0.5) / 1000.0);
        assert!((kolmogorov(halves).expect("numbers") - 0.5).abs() < 1e-3);
        assert_eq!(kolmogorov(std::iter::empty()), None);
    }
}
