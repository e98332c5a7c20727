//! Max-min refinement of a match: differential evolution that makes the smallest margin as large as possible.

use super::emulator::predicted;
use super::evaluations::Interrupted;
use super::file::MatchProblem;
use super::observation::{Known, Observation, Stage};
use super::sample::Sample;
use super::search::{Run, reflected};
use crate::draws::numbers;
use rayon::prelude::*;

/// Children from which a prediction chooses one.
const CHILDREN: usize = 200;
/// Share of them with some coordinates drawn anew.
const ANEW: f64 = 0.4;
/// Share of a generation's children that continue to the next stage.
const GO_ON: f64 = 0.6;

/// Sets that evolve together in a refinement.
pub(super) fn population_size(problem: &MatchProblem) -> usize {
    problem.parameters.len().clamp(6, 30)
}

/// Task of one differential evolution.
pub(super) struct Evolution<'e> {
    /// Its place among all: it has random numbers of its own.
    pub(super) search: u32,
    /// A parameter with a fixed value.
    pub(super) held: Option<(usize, f64)>,
    /// The observations of the problem; those that do not contribute are without a range.
    pub(super) seen: &'e [Observation],
    /// Stages that these need.
    pub(super) stages: Vec<Stage>,
    /// Sets that are tried before any children.
    pub(super) joining: Vec<Vec<f64>>,
    /// Largest number of sets tried.
    pub(super) most: u64,
    /// Places of observations; one set with which they all hold is enough.
    pub(super) ends_with: Option<&'e [usize]>,
}

/// How a differential evolution ended.
pub(super) struct Evolved {
    /// The final sets.
    pub(super) population: Vec<Sample>,
    /// Sets tried.
    pub(super) tried: u64,
    /// A set was found with which all hold.
    pub(super) is_had: bool,
    /// Whether it was interrupted.
    pub(super) ended: Result<(), Interrupted>,
}

impl Run<'_, '_> {
    /// Runs the best incomplete sets through all stages: they may have been ruled out early by little. With them go the
    /// guesses, with every choice of the parameter of which each choice has a search.
    pub(super) fn promote(&mut self) -> Result<(), Interrupted> {
        let effort = &self.problem.effort;
        let seen = &self.problem.observations;
        let samples = &self.found.samples;
        let part = samples.iter().filter(|one| !one.is_whole());
        let mut all: Vec<(f64, &Sample)> = part.map(|one| (self.score(one, seen), one)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(effort.starts as usize * population_size(self.problem));
        let mut on: Vec<Sample> = all
            .into_iter()
            .map(|(_, one)| Sample {
                wave: None,
                ..one.clone()
            })
            .collect();
        let guessed = self.problem.parameters.iter().map(|one| one.start);
        let guessed: Vec<f64> = guessed.collect();
        for (held, _) in self.problem.searches() {
            let mut unit = guessed.clone();
            held.into_iter().for_each(|(place, p)| unit[place] = p);
            on.push(self.fresh(unit, None));
        }
        let mut stages = self.problem.stages().collect::<Vec<_>>().into_iter();
        let evaluated = stages.try_for_each(|stage| self.evaluate(stage, &mut on));
        self.found.samples.extend(on);
        evaluated
    }

    fn score(&self, sample: &Sample, seen: &[Observation]) -> f64 {
        sample.score(seen, &self.found.scales)
    }

    /// Differential evolution from the best sets, each start from others of them; `search` is its place among all. For
    /// a fixed parameter, from the best sets with its value; the best others join them, changed to that value.
    pub(super) fn refine(
        &mut self,
        [search, start]: [u32; 2],
        held: Option<(usize, f64)>,
        most: u64,
    ) -> Result<(), Interrupted> {
        let problem = self.problem;
        let seen = &problem.observations;
        let size = population_size(problem);
        let whole = self.found.samples.iter().filter(|one| one.is_whole());
        let mut all: Vec<(f64, &Sample)> = whole.map(|one| (self.score(one, seen), one)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.dedup_by(|a, b| a.1.unit == b.1.unit);
        // Every start has its own part of the best, so that the starts differ.
        let stride = problem.effort.starts as usize;
        let has_value = |one: &Sample| {
            held.is_none_or(|(place, p)| {
                let parameter = &problem.parameters[place];
                parameter.value(one.unit[place]) == parameter.value(p)
            })
        };
        let best = |has: bool| {
            let those = all.iter().map(|(_, one)| *one);
            let those = those.filter(move |one| has_value(one) == has);
            let those = those.skip(start as usize).step_by(stride).take(size);
            those.cloned().collect::<Vec<Sample>>()
        };
        let first = best(true);
        let joining = held.map_or_else(Vec::new, |(place, p)| {
            let moved = best(false).into_iter().map(|one| {
                let mut unit = one.unit;
                unit[place] = p;
                unit
            });
            moved.collect()
        });
        let scores = first.iter().map(|one| self.score(one, seen));
        let before = scores.fold(f64::NEG_INFINITY, f64::max);
        let evolution = Evolution {
            search,
            held,
            seen,
            stages: problem.stages().collect(),
            joining,
            most,
            ends_with: None,
        };
        let evolved = self.evolve(first, &evolution);
        self.found.refined += evolved.tried;
        let scores = || evolved.population.iter().map(|one| self.score(one, seen));
        let after = scores().fold(f64::NEG_INFINITY, f64::max);
        let holding = scores().filter(|score| *score >= 0.0).count();
        let of = held.map_or_else(String::new, |(place, p)| {
            let parameter = &problem.parameters[place];
            format!(", {} {}", parameter.name, parameter.words(p))
        });
        self.report(
            &format!("refinement {}{of}: {before:.3} to {after:.3}", start + 1),
            evolved.tried,
            holding as u64,
        );
        evolved.ended
    }

    /// Differential evolution (Storn and Price 1997, J. Global Optimization 11, 341). Every set it tries is kept.
    pub(super) fn evolve(&mut self, first: Vec<Sample>, of: &Evolution<'_>) -> Evolved {
        let has_all = |samples: &[Sample]| {
            of.ends_with
                .is_some_and(|group| samples.iter().any(|one| one.holds_all(group, of.seen)))
        };
        let mut is_had = has_all(&first);
        let score = |one: Sample| (self.score(&one, of.seen), one);
        let mut population: Vec<(f64, Sample)> = first.into_iter().map(score).collect();
        best_first(&mut population);
        let (mut tried, mut generation) = (0, 0);
        let mut ended = Ok(());
        let size = population_size(self.problem) as u64;
        while !population.is_empty() && tried < of.most && !is_had {
            let n = size.min(of.most - tried) as usize;
            let children = match (generation, of.joining.is_empty()) {
                (0, false) => {
                    let worst = population.len() - 1;
                    let joining = of.joining.iter().take(n);
                    joining
                        .map(|unit| (worst, self.fresh(unit.clone(), None)))
                        .collect()
                }
                _ => self.children(&population, n, generation, of),
            };
            let n = children.len();
            let before = self.found.samples.len();
            ended = self.compete(&mut population, children, of);
            is_had = has_all(&self.found.samples[before..]);
            if ended.is_err() {
                break;
            }
            tried += n as u64;
            generation += 1;
        }
        Evolved {
            population: population.into_iter().map(|(_, one)| one).collect(),
            tried,
            is_had,
            ended,
        }
    }

    /// `n` children, more of the better sets, each with its parent's place: of several that are drawn, the one that is
    /// predicted to miss least.
    fn children(
        &self,
        population: &[(f64, Sample)],
        n: usize,
        generation: u64,
        of: &Evolution<'_>,
    ) -> Vec<(usize, Sample)> {
        let parameters = &self.problem.parameters;
        let parent = |k: usize| k * k / n * population.len() / n;
        let drawn = |k: usize| {
            let index = generation * 1000 + k as u64;
            let mut random = numbers(self.problem.seed, 1000 + of.search, index);
            let mut drawn = Vec::with_capacity(CHILDREN);
            let mut left = 10 * CHILDREN;
            while drawn.len() < CHILDREN {
                left = left.saturating_sub(1);
                let mut unit = child(population, parent(k), of.held, &mut random);
                let all = unit.iter_mut().zip(parameters);
                all.for_each(|(p, parameter)| *p = parameter.middle_of_choice(*p));
                // A child that changes nothing is simulated already; where choices are few there may be no other.
                if left == 0 || population.iter().all(|(_, one)| one.unit != unit) {
                    drawn.push(unit);
                }
            }
            drawn
        };
        let drawn: Vec<Vec<f64>> = (0..n).into_par_iter().flat_map_iter(drawn).collect();
        let places: Vec<usize> = (0..of.seen.len()).collect();
        let lacks = predicted(&self.found, of.seen, &places, self.problem.seed, &drawn);
        let least = |k: usize| {
            let places = k * CHILDREN..(k + 1) * CHILDREN;
            places.min_by(|a, b| lacks[*a].total_cmp(&lacks[*b]))
        };
        let chosen = (0..n).filter_map(|k| Some((k, least(k)?)));
        chosen
            .map(|(k, place)| (parent(k), self.fresh(drawn[place].clone(), None)))
            .collect()
    }

    /// The children that miss least, by known numbers and predictions of the others, go on to the next stage.
    fn most_promising(
        &mut self,
        children: Vec<(usize, Sample)>,
        of: &Evolution<'_>,
    ) -> Vec<(usize, Sample)> {
        let is_unknown = |place: &usize| {
            let mut all = children.iter();
            all.any(|(_, one)| one.numbers[*place].0 == Known::NotAsked)
        };
        let unknown: Vec<usize> = (0..of.seen.len()).filter(is_unknown).collect();
        let units: Vec<Vec<f64>> = children.iter().map(|(_, one)| one.unit.clone()).collect();
        let later = predicted(&self.found, of.seen, &unknown, self.problem.seed, &units);
        let mut all: Vec<(f64, (usize, Sample))> = children
            .into_iter()
            .zip(later)
            .map(|(child, later)| (later - self.score(&child.1, of.seen).min(0.0), child))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let go_on = (GO_ON * all.len() as f64).ceil() as usize;
        let rest = all.split_off(go_on);
        let rest = rest.into_iter().map(|(_, (_, one))| one);
        self.found.samples.extend(rest);
        all.into_iter().map(|(_, child)| child).collect()
    }

    /// Children that are no worse than their parents join, and the best stay. After each stage, those that are worse
    /// already and the least promising ones are not simulated further.
    fn compete(
        &mut self,
        population: &mut Vec<(f64, Sample)>,
        children: Vec<(usize, Sample)>,
        of: &Evolution<'_>,
    ) -> Result<(), Interrupted> {
        let mut left = children;
        for (place, stage) in of.stages.iter().copied().enumerate() {
            if place > 0 {
                left = self.most_promising(left, of);
            }
            let mut on: Vec<Sample> = left.iter().map(|(_, one)| one.clone()).collect();
            self.evaluate(stage, &mut on)?;
            let known = left.iter().map(|(k, _)| *k).zip(on);
            let is_left =
                |(k, one): &(usize, Sample)| self.score(one, of.seen) >= population[*k].0.min(0.0);
            let (on, worse): (Vec<_>, Vec<_>) = known.partition(is_left);
            left = on;
            self.found
                .samples
                .extend(worse.into_iter().map(|(_, one)| one));
        }
        let size = population_size(self.problem).max(population.len());
        for (_, one) in left {
            self.found.samples.push(one.clone());
            population.push((self.score(&one, of.seen), one));
        }
        best_first(population);
        // Sets that differ by less than the search resolves are equal; parents come first.
        let all = std::mem::take(population);
        let (again, once): (Vec<_>, Vec<_>) = {
            let mut last = None;
            all.into_iter()
                .partition(|(score, _)| last.replace(score.to_bits()) == Some(score.to_bits()))
        };
        population.extend(once.into_iter().chain(again).take(size));
        best_first(population);
        Ok(())
    }
}

fn best_first(population: &mut [(f64, Sample)]) {
    population.sort_by(|a, b| b.0.total_cmp(&a.0));
}

/// One step of differential evolution from place `k` of a population, the best first.
fn child(
    population: &[(f64, Sample)],
    k: usize,
    held: Option<(usize, f64)>,
    random: &mut dyn FnMut() -> f64,
) -> Vec<f64> {
    let pick = |random: &mut dyn FnMut() -> f64| (random() * population.len() as f64) as usize;
    let unit = |k: usize| &population[k].1.unit;
    let (own, best) = (unit(k), unit(0));
    let (a, mut b) = (pick(random), pick(random));
    if a == b {
        b = (b + 1) % population.len();
    }
    // Steps of every size along differences, which shrink with the population, and across them; of one coordinate up to
    // all, as observations depend on some parameters alone. Or some coordinates drawn anew.
    let (towards, along) = (random() * random(), 0.9 * 10_f64.powf(-1.5 * random()));
    let size = 0.2 * 10_f64.powf(-3.0 * random());
    let (is_anew, share) = (random() < ANEW, random());
    let share = if is_anew { share * share } else { share };
    let (place, held) = held.map_or((own.len(), None), |(place, p)| (place, Some(p)));
    let free = own.len() - usize::from(held.is_some());
    let sure = (random() * free as f64) as usize;
    let sure = sure + usize::from(sure >= place);
    let mut moved: Vec<f64> = (0..own.len())
        .map(|d| {
            let step = towards * (best[d] - own[d])
                + along * (unit(a)[d] - unit(b)[d])
                + size * (random() - 0.5);
            let anew = random();
            match (d == sure || random() < share, is_anew) {
                (false, _) => own[d],
                (true, false) => reflected(own[d] + step),
                (true, true) => anew,
            }
        })
        .collect();
    if let Some(p) = held {
        moved[place] = p;
    }
    moved
}
