//! Search for matching parameter sets: draws of the prior, waves that explore what is left, refinement of the margin.

use super::evaluations::{Asked, Evaluations, Interrupted};
use super::file::MatchProblem;
use super::observation::{Known, Quantity, RULED_OUT, Stage};
use super::sample::{Sample, scales};
use super::searched::{Ended, Searched, WaveReport};
use crate::draws::{draw, filling, numbers};
use crate::store::StoreError;

/// Least number of sets from which a wave starts; the nearest where fewer are left.
const PARENTS: usize = 20;

/// Searches for parameter sets; `notify` is called for every wave.
///
/// # Errors
/// The store cannot be written. What was computed before is kept.
pub fn search(
    problem: &MatchProblem,
    evaluations: &mut Evaluations<'_>,
    notify: &mut dyn FnMut(&WaveReport),
) -> Result<Searched, StoreError> {
    let mut run = Run {
        problem,
        evaluations,
        notify,
        found: Searched::nothing(problem.observations.len()),
    };
    match run.all() {
        Ok(()) => {}
        Err(Interrupted::Stopped) => run.found.ended = Ended::Stopped,
        Err(Interrupted::Store(error)) => return Err(error),
    }
    Ok(run.found)
}

impl Evaluations<'_> {
    /// A parameter set through every stage, with the numerical uncertainties that a search measured; `None` after a
    /// requested stop.
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
            notify: &mut |_| {},
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

pub(super) struct Run<'a, 'b> {
    pub(super) problem: &'a MatchProblem,
    pub(super) evaluations: &'a mut Evaluations<'b>,
    notify: &'a mut dyn FnMut(&WaveReport),
    pub(super) found: Searched,
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
            let mut search = 0;
            for start in 0..self.problem.effort.starts {
                for (held, most) in self.problem.searches() {
                    self.refine([search, start], held, most)?;
                    search += 1;
                }
            }
        }
        self.contradict()
    }

    /// Measures the numerical uncertainty: the largest change of a number when every discretisation parameter is refined once.
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
            let (own, interrupted) = self.evaluations.of(&asked(false));
            interrupted?;
            let (refined, interrupted) = self.evaluations.of(&asked(true));
            interrupted?;
            for (own, refined) in own.iter().flatten().zip(refined.iter().flatten()) {
                for (place, u) in self.found.measured_u.iter_mut().enumerate() {
                    if let (Known::Is(a), Known::Is(b)) = (own[place], refined[place]) {
                        *u = u.max((a - b).abs());
                    }
                }
            }
        }
        Ok(())
    }

    pub(super) fn draw(&self, index: u64) -> Vec<f64> {
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
        self.found.draws = samples.len();
        for stage in stages {
            let part = problem.draws(stage) as usize;
            let evaluated = self.evaluate(stage, &mut samples[..part]);
            if evaluated.is_err() {
                let is_tried = |one: &&Sample| {
                    let mut numbers = one.numbers.iter();
                    numbers.any(|(known, _)| *known != Known::NotAsked)
                };
                let tried = samples.iter().filter(is_tried).count() as u64;
                self.found.samples = samples;
                self.report("prior", tried, 0);
                return evaluated;
            }
        }
        self.found.scales = scales(&samples, &problem.observations);
        // Sets that are not ruled out go on to the later stages.
        let mut left: Vec<usize> = (0..samples.len())
            .filter(|k| {
                !samples[*k].is_ruled_out(&self.problem.observations) && !samples[*k].is_whole()
            })
            .collect();
        left.truncate(problem.effort.samples as usize);
        let mut on: Vec<Sample> = left.iter().map(|k| samples[*k].clone()).collect();
        self.found.samples = samples;
        // Kept apart from the draws, whose shares would be biased by a choice.
        self.stages_of(&mut on)?;
        on.retain(|one| one.is_whole());
        let tried = self.found.draws as u64;
        let draws = self.found.samples.len();
        self.found.samples.extend(on);
        let kept = self.found.samples[..draws]
            .iter()
            .filter(|one| !one.is_ruled_out(&self.problem.observations))
            .count();
        self.report("prior", tried, kept as u64);
        Ok(())
    }

    pub(super) fn fresh(&self, unit: Vec<f64>, wave: Option<u32>) -> Sample {
        let nothing = vec![(Known::NotAsked, 0.0); self.problem.observations.len()];
        Sample {
            unit,
            wave,
            numbers: nothing,
        }
    }

    /// Computes the numbers of a stage.
    pub(super) fn evaluate(
        &mut self,
        stage: Stage,
        samples: &mut [Sample],
    ) -> Result<(), Interrupted> {
        let asked: Vec<Asked<'_>> = samples
            .iter()
            .map(|one| (stage, &one.unit[..], false))
            .collect();
        let (found, interrupted) = self.evaluations.of(&asked);
        for (sample, found) in samples.iter_mut().zip(found) {
            for (place, known) in found.into_iter().flatten().enumerate() {
                if known != Known::NotAsked {
                    sample.numbers[place] = (known, self.numerical_u(place, known));
                }
            }
            self.combine(sample);
        }
        interrupted
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

    /// Stage by stage, for those that are not ruled out.
    fn stages_of(&mut self, samples: &mut [Sample]) -> Result<(), Interrupted> {
        for stage in self.problem.stages().collect::<Vec<_>>() {
            let left: Vec<usize> = (0..samples.len())
                .filter(|k| !samples[*k].is_ruled_out(&self.problem.observations))
                .collect();
            let mut on: Vec<Sample> = left.iter().map(|k| samples[*k].clone()).collect();
            let evaluated = self.evaluate(stage, &mut on);
            for (k, one) in left.into_iter().zip(on) {
                samples[k] = one;
            }
            evaluated?;
        }
        Ok(())
    }

    /// Places of the sets that a wave starts from.
    fn parents(&self) -> Vec<usize> {
        let samples = &self.found.samples;
        let kept = |k: &usize| {
            samples[*k].is_whole() && !samples[*k].is_ruled_out(&self.problem.observations)
        };
        let left: Vec<usize> = (0..samples.len()).filter(kept).collect();
        if left.len() >= PARENTS {
            return left;
        }
        // The more stages a set has passed, the nearer it is.
        let unknown = |k: usize| {
            samples[k]
                .numbers
                .iter()
                .filter(|(known, _)| *known == Known::NotAsked)
                .count()
        };
        let mut all: Vec<(usize, usize, f64)> = (0..samples.len())
            .map(|k| {
                (
                    k,
                    unknown(k),
                    samples[k].distance(&self.problem.observations),
                )
            })
            .collect();
        all.sort_by(|a, b| {
            let far = |one: &(usize, usize, f64)| one.2 + one.1 as f64 * RULED_OUT.ln_1p();
            far(a).total_cmp(&far(b))
        });
        all.into_iter().take(PARENTS).map(|(k, ..)| k).collect()
    }

    /// Half of a wave fills the box around the sets left; half steps along differences of two of them.
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
        let evaluated = self.stages_of(&mut samples);
        let kept = samples
            .iter()
            .filter(|one| one.is_kept(&self.problem.observations))
            .count();
        self.found.samples.extend(samples);
        evaluated?;
        self.report(&format!("wave {wave}"), count, kept as u64);
        Ok(())
    }

    pub(super) fn report(&mut self, name: &str, tried: u64, kept: u64) {
        let n = self.problem.parameters.len();
        let samples = &self.found.samples;
        let left = samples
            .iter()
            .filter(|one| one.is_kept(&self.problem.observations));
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
        (self.notify)(&report);
        self.found.waves.push(report);
    }
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

/// Reflects a value at the ends of 0 to 1.
pub(super) fn reflected(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}
