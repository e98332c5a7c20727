//! A parameter set with its numbers, and how well the observations hold with it.

use std::cmp::Ordering;

use super::observation::{Known, Observation, RULED_OUT, SAFE};

/// Implausibility or negative margin beyond which one observation is as wrong as any.
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

impl Sample {
    /// Every number is known.
    pub fn is_whole(&self) -> bool {
        self.numbers
            .iter()
            .all(|(known, _)| *known != Known::NotAsked)
    }

    /// Some observation is implausible by the known numbers.
    pub fn is_ruled_out(&self, observations: &[Observation]) -> bool {
        self.implausibilities(observations).any(|i| i >= RULED_OUT)
    }

    /// Plausible by every number.
    pub(super) fn is_kept(&self, observations: &[Observation]) -> bool {
        self.is_whole() && !self.is_ruled_out(observations)
    }

    fn implausibilities<'s>(
        &'s self,
        observations: &'s [Observation],
    ) -> impl Iterator<Item = f64> + 's {
        let pairs = observations.iter().zip(&self.numbers);
        pairs.filter_map(|(one, (known, u))| one.implausibility(*known, *u))
    }

    fn margins<'s>(
        &'s self,
        observations: &'s [Observation],
    ) -> impl Iterator<Item = (usize, f64)> + 's {
        let pairs = observations.iter().zip(&self.numbers).enumerate();
        pairs.filter_map(|(place, (one, (known, u)))| Some((place, one.margin(*known, *u)?)))
    }

    /// Distance from all observations; 0 where none is implausible.
    pub(super) fn distance(&self, observations: &[Observation]) -> f64 {
        self.implausibilities(observations)
            .map(|i| i.min(FAR).ln_1p())
            .sum()
    }

    /// Places of observations that do not hold.
    pub(super) fn fails(&self, observations: &[Observation]) -> Vec<usize> {
        let holds =
            |place: &usize| observations[*place].holds(self.numbers[*place].0) == Some(false);
        (0..observations.len()).filter(holds).collect()
    }

    /// All of some observations hold, given by their places.
    pub(super) fn holds_all(&self, places: &[usize], observations: &[Observation]) -> bool {
        let holds = |place: &usize| observations[*place].holds(self.numbers[*place].0);
        places.iter().all(|place| holds(place) == Some(true))
    }

    /// Places of observations whose margin is below their numerical uncertainty.
    pub(super) fn falls_short(&self, observations: &[Observation]) -> Vec<usize> {
        let short = self
            .margins(observations)
            .filter(|(_, margin)| *margin < SAFE);
        short.map(|(place, _)| place).collect()
    }

    /// Order by the least weight of observations that do not hold, then by [`Self::score`].
    pub(super) fn order(
        &self,
        other: &Self,
        observations: &[Observation],
        scales: &[f64],
    ) -> Ordering {
        let weight = |place: usize| observations[place].weight;
        let fails = |one: &Self| one.fails(observations).into_iter().map(weight).sum::<f64>();
        let scores = self
            .score(observations, scales)
            .total_cmp(&other.score(observations, scales));
        fails(other).total_cmp(&fails(self)).then(scores)
    }

    /// Smallest margin, and the place of the observation that has it.
    pub(super) fn smallest_margin(&self, observations: &[Observation]) -> (f64, Option<usize>) {
        let margins = self
            .margins(observations)
            .map(|(place, margin)| (margin, Some(place)));
        margins.fold((f64::INFINITY, None), |least, one| {
            if one.0 < least.0 { one } else { least }
        })
    }

    /// Objective of the search: the smallest margin where all reach their numerical uncertainty. Else minus the
    /// shortfall, with a step for each observation that does not reach it, so that one more reaches it before the
    /// others come nearer. `scales` are distances of each number that are half a step.
    pub(super) fn score(&self, observations: &[Observation], scales: &[f64]) -> f64 {
        let pairs = observations.iter().zip(&self.numbers).zip(scales);
        let missing: f64 = pairs
            .filter_map(|((one, (known, u)), scale)| one.missing(*known, *u, *scale))
            .sum();
        match missing > 0.0 {
            true => -missing,
            false => self.smallest_margin(observations).0.min(FAR),
        }
    }
}

/// Median distance of numbers outside their range, over the samples in which they do not hold; 1 where there is none.
pub(super) fn scales(samples: &[Sample], observations: &[Observation]) -> Vec<f64> {
    let of = |(place, one): (usize, &Observation)| {
        let numbers = samples.iter().map(|sample| sample.numbers[place].0);
        let outside = numbers.filter_map(|known| one.outside(known));
        let mut all: Vec<f64> = outside
            .filter(|far| *far > 0.0 && far.is_finite())
            .collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(1.0)
    };
    observations.iter().enumerate().map(of).collect()
}
