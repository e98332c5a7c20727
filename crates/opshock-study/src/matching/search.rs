//! The search: independent draws of the prior, waves that explore what is left, refinement of the smallest margin.

use super::evaluations::{Asked, Evaluations, Interrupted};
use super::file::MatchProblem;
use super::observation::{Known, Quantity, RULED_OUT, Stage};
use super::prior::{draw, filling, numbers};
use crate::store::StoreError;

/// Sets from which a wave starts at least; the nearest where fewer are left.
const PARENTS: usize = 20;
/// Implausibility beyond which one observation is as wrong as any.
const FAR: f64 = 1e3;

/// A parameter set.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Cumulative probabilities of the parameters.
    pub unit: Vec<f64>,
    /// Wave, 0 for draws of the prior; `None` for the refinement.
    pub wave: Option<u32>,
    /// Numbers of the observations, those of combinations included, each with its numerical uncertainty.
    pub numbers: Vec<(Known, f64)>,
}

/// What a wave did.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveReport {
    /// What was done.
    pub name: String,
    /// Parameter sets tried.
    pub tried: u64,
    /// Those that are not ruled out.
    pub kept: u64,
    /// What the sets kept so far leave of each parameter's range, a share; empty without any.
    pub left: Vec<f64>,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Everything asked for was computed.
    Complete,
    /// A stop was asked for before.
    Stopped,
}

/// All that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    /// Parameter sets: draws of the prior first, in their order.
    pub samples: Vec<Sample>,
    /// Draws of the prior among them.
    pub draws: usize,
    /// Measured numerical uncertainty of every observation; 0 where it is given, exact or not measured.
    pub measured_u: Vec<f64>,
    /// What was done.
    pub waves: Vec<WaveReport>,
    /// Parameter sets of the refinement, over all starts.
    pub refined: u64,
    /// Why it ended.
    pub ended: Ended,
}

/// Searches for parameter sets; `tell` hears of every wave.
///
/// # Errors
/// The store cannot be written. What was computed before is kept.
pub fn search(
    problem: &MatchProblem,
    evaluations: &mut Evaluations<'_>,
    tell: &mut dyn FnMut(&WaveReport),
) -> Result<Searched, StoreError> {
    let mut run = Run {
        problem,
        evaluations,
        tell,
        found: Searched {
            samples: Vec::new(),
            draws: 0,
            measured_u: vec![0.0; problem.observations.len()],
            waves: Vec::new(),
            refined: 0,
            ended: Ended::Complete,
        },
    };
    match run.all() {
        Ok(()) => {}
        Err(Interrupted::Stopped) => run.found.ended = Ended::Stopped,
        Err(Interrupted::Store(error)) => return Err(error),
    }
    Ok(run.found)
}

impl Evaluations<'_> {
    /// A parameter set through every stage, with the numerical uncertainties that a search measured; `None` when a stop was
    /// asked for.
    ///
    /// # Errors
    /// The store cannot be written.
    pub fn sample(
        &mut self,
        problem: &MatchProblem,
        unit: &[f64],
        found: &Searched,
    ) -> Result<Option<Sample>, StoreError> {
        let mut run = Run {
            problem,
            evaluations: self,
            tell: &mut |_| {},
            found: Searched {
                samples: Vec::new(),
                waves: Vec::new(),
                ..found.clone()
            },
        };
        let mut sample = [run.fresh(unit.to_vec(), None)];
        for stage in problem.stages() {
            match run.evaluate(stage, &mut sample) {
                Ok(()) => {}
                Err(Interrupted::Stopped) => return Ok(None),
                Err(Interrupted::Store(error)) => return Err(error),
            }
        }
        let [sample] = sample;
        Ok(Some(sample))
    }
}

struct Run<'a, 'b> {
    problem: &'a MatchProblem,
    evaluations: &'a mut Evaluations<'b>,
    tell: &'a mut dyn FnMut(&WaveReport),
    found: Searched,
}

impl Run<'_, '_> {
    fn all(&mut self) -> Result<(), Interrupted> {
        self.numerics()?;
        self.prior()?;
        for wave in 1..=self.problem.effort.waves {
            self.wave(wave)?;
        }
        if self.problem.effort.refinement > 0 {
            self.promote()?;
        }
        for start in 0..self.problem.effort.starts {
            self.refine(start)?;
        }
        Ok(())
    }

    /// Measures the numerical uncertainty: the largest change of a number when every discretisation is refined once.
    fn numerics(&mut self) -> Result<(), Interrupted> {
        let problem = self.problem;
        let is_measured = |stage: Stage| {
            let mut of_stage = problem.observations.iter().filter(|one| one.stage == stage);
            stage != Stage::CriticalShocks && of_stage.any(|one| one.numerical_u.is_none())
        };
        for stage in problem.stages().filter(|stage| is_measured(*stage)) {
            let units: Vec<Vec<f64>> = (0..problem.effort.probes.min(problem.draws(stage)))
                .map(|k| self.draw(k))
                .collect();
            let asked = |is_refined| {
                units
                    .iter()
                    .map(move |unit| (stage, &unit[..], is_refined))
                    .collect::<Vec<Asked<'_>>>()
            };
            let own = self.evaluations.of(&asked(false))?;
            let refined = self.evaluations.of(&asked(true))?;
            for (own, refined) in own.iter().zip(&refined) {
                for (place, u) in self.found.measured_u.iter_mut().enumerate() {
                    if let (Known::Is(a), Known::Is(b)) = (own[place], refined[place]) {
                        *u = u.max((a - b).abs());
                    }
                }
            }
        }
        Ok(())
    }

    fn draw(&self, index: u64) -> Vec<f64> {
        draw(self.problem.seed, index, self.problem.parameters.len())
    }

    fn prior(&mut self) -> Result<(), Interrupted> {
        let problem = self.problem;
        let stages: Vec<Stage> = problem.stages().collect();
        let draws = stages
            .iter()
            .map(|stage| problem.draws(*stage))
            .max()
            .unwrap_or(0);
        let mut samples: Vec<Sample> = (0..draws)
            .map(|k| self.fresh(self.draw(k), Some(0)))
            .collect();
        for stage in stages {
            let part = problem.draws(stage) as usize;
            self.evaluate(stage, &mut samples[..part])?;
        }
        self.found.draws = samples.len();
        // What is not ruled out goes on to the later stages.
        let mut left: Vec<usize> = (0..samples.len())
            .filter(|k| !self.is_ruled_out(&samples[*k]) && !self.is_whole(&samples[*k]))
            .collect();
        left.truncate(problem.effort.samples as usize);
        let mut on: Vec<Sample> = left.iter().map(|k| samples[*k].clone()).collect();
        self.found.samples = samples;
        // Kept apart from the draws, whose shares would be biased by a choice.
        self.stages_of(&mut on)?;
        on.retain(|one| self.is_whole(one));
        let tried = self.found.draws as u64;
        let draws = self.found.samples.len();
        self.found.samples.extend(on);
        let kept = self.found.samples[..draws]
            .iter()
            .filter(|one| !self.is_ruled_out(one))
            .count();
        self.report("prior", tried, kept as u64);
        Ok(())
    }

    fn fresh(&self, unit: Vec<f64>, wave: Option<u32>) -> Sample {
        let nothing = vec![(Known::NotAsked, 0.0); self.problem.observations.len()];
        Sample {
            unit,
            wave,
            numbers: nothing,
        }
    }

    /// Fills in the numbers of a stage.
    fn evaluate(&mut self, stage: Stage, samples: &mut [Sample]) -> Result<(), Interrupted> {
        let asked: Vec<Asked<'_>> = samples
            .iter()
            .map(|one| (stage, &one.unit[..], false))
            .collect();
        let found = self.evaluations.of(&asked)?;
        for (sample, found) in samples.iter_mut().zip(found) {
            for (place, known) in found.into_iter().enumerate() {
                if known != Known::NotAsked {
                    sample.numbers[place] = (known, self.numerical_u(place, known));
                }
            }
            self.combine(sample);
        }
        Ok(())
    }

    fn numerical_u(&self, place: usize, known: Known) -> f64 {
        let one = &self.problem.observations[place];
        match (one.numerical_u, one.stage) {
            (Some(u), _) => u,
            (None, Stage::CriticalShocks) => self.problem.search_uncertainty(one, known),
            (None, _) => self.found.measured_u[place],
        }
    }

    fn combine(&self, sample: &mut Sample) {
        for (place, one) in self.problem.observations.iter().enumerate() {
            if let Quantity::Combined(combination, of) = &one.quantity {
                let parts: Vec<(Known, f64)> =
                    of.iter().map(|part| sample.numbers[*part]).collect();
                let (known, u) = combination.of(&parts);
                sample.numbers[place] = (known, one.numerical_u.unwrap_or(u));
            }
        }
    }

    /// Implausibilities of what is known.
    fn implausibilities<'s>(&'s self, sample: &'s Sample) -> impl Iterator<Item = f64> + 's {
        let observations = self.problem.observations.iter().zip(&sample.numbers);
        observations.filter_map(|(one, (known, u))| one.implausibility(*known, *u))
    }

    fn is_ruled_out(&self, sample: &Sample) -> bool {
        self.implausibilities(sample).any(|i| i >= RULED_OUT)
    }

    fn is_whole(&self, sample: &Sample) -> bool {
        sample
            .numbers
            .iter()
            .all(|(known, _)| *known != Known::NotAsked)
    }

    /// How far a sample is from all that was observed; 0 where nothing is implausible.
    fn distance(&self, sample: &Sample) -> f64 {
        self.implausibilities(sample)
            .map(|i| i.min(FAR).ln_1p())
            .sum()
    }

    /// Stage by stage, for those that are not ruled out.
    fn stages_of(&mut self, samples: &mut [Sample]) -> Result<(), Interrupted> {
        for stage in self.problem.stages().collect::<Vec<_>>() {
            let left: Vec<usize> = (0..samples.len())
                .filter(|k| !self.is_ruled_out(&samples[*k]))
                .collect();
            let mut on: Vec<Sample> = left.iter().map(|k| samples[*k].clone()).collect();
            self.evaluate(stage, &mut on)?;
            for (k, one) in left.into_iter().zip(on) {
                samples[k] = one;
            }
        }
        Ok(())
    }

    /// Places of the sets that a wave starts from.
    fn parents(&self) -> Vec<usize> {
        let samples = &self.found.samples;
        let kept = |k: &usize| self.is_whole(&samples[*k]) && !self.is_ruled_out(&samples[*k]);
        let left: Vec<usize> = (0..samples.len()).filter(kept).collect();
        if left.len() >= PARENTS {
            return left;
        }
        // The farther a set has come through the stages, the nearer it is.
        let unknown = |k: usize| {
            samples[k]
                .numbers
                .iter()
                .filter(|(known, _)| *known == Known::NotAsked)
                .count()
        };
        let mut all: Vec<(usize, usize, f64)> = (0..samples.len())
            .map(|k| (k, unknown(k), self.distance(&samples[k])))
            .collect();
        all.sort_by(|a, b| {
            let far = |one: &(usize, usize, f64)| one.2 + one.1 as f64 * RULED_OUT.ln_1p();
            far(a).total_cmp(&far(b))
        });
        all.into_iter().take(PARENTS).map(|(k, ..)| k).collect()
    }

    /// Half of a wave fills the box around what is left; half steps along differences of two of its sets.
    fn wave(&mut self, wave: u32) -> Result<(), Interrupted> {
        let (seed, n) = (self.problem.seed, self.problem.parameters.len());
        let parents = self.parents();
        if parents.is_empty() {
            return Ok(());
        }
        let unit = |k: usize| &self.found.samples[parents[k % parents.len()]].unit;
        let ends = box_of(parents.iter().map(|k| &self.found.samples[*k].unit[..]), n);
        let count = self.problem.effort.samples;
        let mut samples = Vec::new();
        for k in 0..count {
            let mut random = numbers(seed, wave, k);
            let proposed: Vec<f64> = if k % 2 == 0 {
                let place = filling(seed.wrapping_add(u64::from(wave)), k as u32 / 2, n);
                place
                    .iter()
                    .zip(&ends)
                    .map(|(p, [low, high])| low + p * (high - low))
                    .collect()
            } else {
                let pick =
                    |random: &mut dyn FnMut() -> f64| (random() * parents.len() as f64) as usize;
                let (a, b) = (pick(&mut random), pick(&mut random));
                let length = 0.3 + 0.9 * random();
                let base = unit(k as usize / 2);
                (0..n)
                    .map(|d| base[d] + length * (unit(a)[d] - unit(b)[d]) + 0.02 * (random() - 0.5))
                    .collect()
            };
            samples.push(self.fresh(proposed.into_iter().map(reflected).collect(), Some(wave)));
        }
        self.stages_of(&mut samples)?;
        let kept = samples
            .iter()
            .filter(|one| self.is_whole(one) && !self.is_ruled_out(one))
            .count();
        self.found.samples.extend(samples);
        self.report(&format!("wave {wave}"), count, kept as u64);
        Ok(())
    }

    /// Score that the refinement makes as large as it can: the smallest margin where all hold, else what is missing.
    fn score(&self, sample: &Sample) -> f64 {
        let observations = self.problem.observations.iter().zip(&sample.numbers);
        let margins = observations.filter_map(|(one, (known, u))| one.margin(*known, *u));
        let (mut missing, mut smallest) = (0.0, f64::INFINITY);
        for margin in margins {
            smallest = smallest.min(margin);
            if margin < 0.0 {
                // A step for each that does not hold, so that one more holds before the others come nearer.
                missing += 1.0 + (-margin).min(FAR).ln_1p();
            }
        }
        match missing > 0.0 {
            true => -missing,
            false => smallest.min(FAR),
        }
    }

    /// Takes the best of the sets that did not come through all stages through them: what rules out a set early may be little.
    fn promote(&mut self) -> Result<(), Interrupted> {
        let effort = &self.problem.effort;
        let samples = &self.found.samples;
        let part = samples.iter().filter(|one| !self.is_whole(one));
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
        for stage in self.problem.stages().collect::<Vec<_>>() {
            self.evaluate(stage, &mut on)?;
        }
        self.found.samples.extend(on);
        Ok(())
    }

    /// Differential evolution (Storn and Price 1997, J. Global Optimization 11, 341) from the best sets, `start` of them
    /// left out in front.
    fn refine(&mut self, start: u32) -> Result<(), Interrupted> {
        let problem = self.problem;
        let most = problem.effort.refinement / u64::from(problem.effort.starts);
        let size = population(problem);
        let whole = self.found.samples.iter().filter(|one| self.is_whole(one));
        let mut all: Vec<(f64, &Sample)> = whole.map(|one| (self.score(one), one)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.dedup_by(|a, b| a.1.unit == b.1.unit);
        // Every start its own part of the best, so that they are different ones.
        let stride = problem.effort.starts as usize;
        let part = all.iter().skip(start as usize).step_by(stride).take(size);
        let mut population: Vec<(f64, Sample)> =
            part.map(|(score, one)| (*score, (*one).clone())).collect();
        if population.len() < 4 || most == 0 {
            return Ok(());
        }
        let before = population[0].0;
        let (mut tried, mut generation) = (0, 0);
        while tried < most {
            let mut children: Vec<Sample> = Vec::new();
            let n = (population.len() as u64).min(most - tried) as usize;
            for k in 0..n {
                children.push(self.child(&population, k, start, generation));
            }
            self.compete(&mut population, children)?;
            tried += n as u64;
            self.found.refined += n as u64;
            generation += 1;
        }
        let best = population
            .iter()
            .map(|(score, _)| *score)
            .fold(f64::NEG_INFINITY, f64::max);
        let holding = population.iter().filter(|(score, _)| *score >= 0.0).count();
        self.found.samples.extend(
            population
                .into_iter()
                .map(|(_, one)| Sample { wave: None, ..one }),
        );
        self.report(
            &format!("refinement {}: {before:.3} to {best:.3}", start + 1),
            tried,
            holding as u64,
        );
        Ok(())
    }

    fn child(&self, population: &[(f64, Sample)], k: usize, start: u32, generation: u64) -> Sample {
        let stage = 1000 + start;
        let mut random = numbers(self.problem.seed, stage, generation * 1000 + k as u64);
        let pick = |random: &mut dyn FnMut() -> f64| (random() * population.len() as f64) as usize;
        let best =
            (0..population.len()).max_by(|a, b| population[*a].0.total_cmp(&population[*b].0));
        let unit = |k: usize| &population[k].1.unit;
        let (own, best) = (unit(k), unit(best.unwrap_or(k)));
        let (a, b) = (pick(&mut random), pick(&mut random));
        let (towards, along) = (random() * random(), 0.2 + 0.7 * random());
        let sure = (random() * own.len() as f64) as usize;
        let moved: Vec<f64> = (0..own.len())
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

    fn report(&mut self, name: &str, tried: u64, kept: u64) {
        let n = self.problem.parameters.len();
        let samples = &self.found.samples;
        let left = samples
            .iter()
            .filter(|one| self.is_whole(one) && !self.is_ruled_out(one));
        let left: Vec<&[f64]> = left.map(|one| &one.unit[..]).collect();
        let left = match left.is_empty() {
            true => Vec::new(),
            false => hull(left.into_iter(), n)
                .iter()
                .map(|[low, high]| high - low)
                .collect(),
        };
        let report = WaveReport {
            name: name.to_owned(),
            tried,
            kept,
            left,
        };
        (self.tell)(&report);
        self.found.waves.push(report);
    }
}

/// Sets that evolve together in a refinement.
pub(super) fn population(problem: &MatchProblem) -> usize {
    (2 * problem.parameters.len()).clamp(6, 30)
}

/// Smallest and largest of each parameter.
pub(super) fn hull<'s>(units: impl Iterator<Item = &'s [f64]>, parameters: usize) -> Vec<[f64; 2]> {
    units.fold(vec![[1.0, 0.0]; parameters], |ends, unit| {
        ends.iter()
            .zip(unit)
            .map(|([low, high], x)| [low.min(*x), high.max(*x)])
            .collect()
    })
}

/// The hull, each side a tenth wider and at least a hundredth of the whole.
fn box_of<'s>(units: impl Iterator<Item = &'s [f64]>, parameters: usize) -> Vec<[f64; 2]> {
    let wider = |[low, high]: [f64; 2]| {
        let by = (0.1 * (high - low)).max(0.01);
        [(low - by).max(0.0), (high + by).min(1.0)]
    };
    hull(units, parameters).into_iter().map(wider).collect()
}

/// Back into 0 to 1 at its ends.
fn reflected(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}
