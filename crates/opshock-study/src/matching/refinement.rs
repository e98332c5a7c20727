//! The refinement: the smallest margin made as large as it can be, by differential evolution.

use super::evaluations::Interrupted;
use super::file::MatchProblem;
use super::prior::numbers;
use super::sample::Sample;
use super::search::{Run, reflected};

/// Sets that evolve together in a refinement.
pub(super) fn population(problem: &MatchProblem) -> usize {
    (2 * problem.parameters.len()).clamp(6, 30)
}

impl Run<'_, '_> {
    /// Takes the best of the sets that did not come through all stages through them: what rules out a set early may be little.
    pub(super) fn promote(&mut self) -> Result<(), Interrupted> {
        let effort = &self.problem.effort;
        let samples = &self.found.samples;
        let part = samples.iter().filter(|one| !one.is_whole());
        let mut all: Vec<(f64, &Sample)> = part.map(|one| (self.score(one), one)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(effort.starts as usize * population(self.problem));
        let mut on: Vec<Sample> = all
            .into_iter()
            .map(|(_, one)| Sample {
                wave: None,
                ..one.clone()
            })
            .collect();
        let mut stages = self.problem.stages().collect::<Vec<_>>().into_iter();
        let evaluated = stages.try_for_each(|stage| self.evaluate(stage, &mut on));
        self.found.samples.extend(on);
        evaluated
    }

    fn score(&self, sample: &Sample) -> f64 {
        sample.score(&self.problem.observations, &self.found.scales)
    }

    /// Differential evolution (Storn and Price 1997, J. Global Optimization 11, 341) from the best sets, each start from
    /// others of them; `search` is its place among all, `held` a parameter that keeps one value.
    pub(super) fn refine(
        &mut self,
        search: u32,
        start: u32,
        held: Option<(usize, f64)>,
    ) -> Result<(), Interrupted> {
        let problem = self.problem;
        let most = problem.effort.refinement / problem.searches();
        let size = population(problem);
        let whole = self.found.samples.iter().filter(|one| one.is_whole());
        let mut all: Vec<(f64, &Sample)> = whole.map(|one| (self.score(one), one)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.dedup_by(|a, b| a.1.unit == b.1.unit);
        // Every start its own part of the best, so that they are different ones.
        let stride = problem.effort.starts as usize;
        let part = all.iter().skip(start as usize).step_by(stride).take(size);
        let mut first: Vec<Sample> = part.map(|(_, one)| (*one).clone()).collect();
        if let Some((place, p)) = held {
            for one in &mut first {
                let mut unit = one.unit.clone();
                unit[place] = p;
                *one = self.fresh(unit, None);
            }
            let mut stages = problem.stages();
            stages.try_for_each(|stage| self.evaluate(stage, &mut first))?;
        }
        let score = |one: Sample| (self.score(&one), one);
        let mut population: Vec<(f64, Sample)> = first.into_iter().map(score).collect();
        if population.len() < 4 || most == 0 {
            return Ok(());
        }
        let best = |population: &[(f64, Sample)]| {
            let scores = population.iter().map(|(score, _)| *score);
            scores.fold(f64::NEG_INFINITY, f64::max)
        };
        let before = best(&population);
        let (mut tried, mut generation) = (0, 0);
        let mut interrupted = Ok(());
        while tried < most {
            let mut children: Vec<Sample> = Vec::new();
            let n = (population.len() as u64).min(most - tried) as usize;
            for k in 0..n {
                children.push(self.child(&population, k, search, generation, held));
            }
            interrupted = self.compete(&mut population, children);
            if interrupted.is_err() {
                break;
            }
            tried += n as u64;
            self.found.refined += n as u64;
            generation += 1;
        }
        let after = best(&population);
        let holding = population.iter().filter(|(score, _)| *score >= 0.0).count();
        self.found.samples.extend(
            population
                .into_iter()
                .map(|(_, one)| Sample { wave: None, ..one }),
        );
        interrupted?;
        let of = held.map_or_else(String::new, |(place, p)| {
            let parameter = &problem.parameters[place];
            format!(", {} {}", parameter.name, parameter.words(p))
        });
        self.report(
            &format!("refinement {}{of}: {before:.3} to {after:.3}", start + 1),
            tried,
            holding as u64,
        );
        Ok(())
    }

    fn child(
        &self,
        population: &[(f64, Sample)],
        k: usize,
        search: u32,
        generation: u64,
        held: Option<(usize, f64)>,
    ) -> Sample {
        let stage = 1000 + search;
        let mut random = numbers(self.problem.seed, stage, generation * 1000 + k as u64);
        let pick = |random: &mut dyn FnMut() -> f64| (random() * population.len() as f64) as usize;
        let best =
            (0..population.len()).max_by(|a, b| population[*a].0.total_cmp(&population[*b].0));
        let unit = |k: usize| &population[k].1.unit;
        let (own, best) = (unit(k), unit(best.unwrap_or(k)));
        let (a, b) = (pick(&mut random), pick(&mut random));
        let (towards, along) = (random() * random(), 0.2 + 0.7 * random());
        let sure = (random() * own.len() as f64) as usize;
        let mut moved: Vec<f64> = (0..own.len())
            .map(|d| {
                let step = towards * (best[d] - own[d])
                    + along * (unit(a)[d] - unit(b)[d])
                    + 0.01 * (random() - 0.5);
                match d == sure || random() < 0.8 {
                    true => reflected(own[d] + step),
                    false => own[d],
                }
            })
            .collect();
        if let Some((place, p)) = held {
            moved[place] = p;
        }
        self.fresh(moved, None)
    }

    /// A child takes its parent's place where it is better. Stage by stage: one that is worse by what is known of it is not
    /// simulated on.
    fn compete(
        &mut self,
        population: &mut [(f64, Sample)],
        children: Vec<Sample>,
    ) -> Result<(), Interrupted> {
        let mut left: Vec<(usize, Sample)> = children.into_iter().enumerate().collect();
        for stage in self.problem.stages().collect::<Vec<_>>() {
            let mut on: Vec<Sample> = left.iter().map(|(_, one)| one.clone()).collect();
            self.evaluate(stage, &mut on)?;
            left = left
                .into_iter()
                .zip(on)
                .map(|((k, _), one)| (k, one))
                .collect();
            left.retain(|(k, one)| self.score(one) >= population[*k].0.min(0.0));
        }
        for (k, one) in left {
            let score = self.score(&one);
            if score >= population[k].0 {
                population[k] = (score, one);
            }
        }
        Ok(())
    }
}
