//! Predicts the shortfall of parameter sets from those simulated so far, by extremely randomised trees (Geurts, Ernst
//! and Wehenkel 2006, Mach. Learn. 63, 3). It proposes what is simulated next; no answer rests on it.

use super::observation::Observation;
use super::sample::Sample;
use super::searched::Searched;
use rayon::prelude::*;
use smartcore::ensemble::extra_trees_regressor::{
    ExtraTreesRegressor, ExtraTreesRegressorParameters,
};
use smartcore::linalg::basic::matrix::DenseMatrix;

/// Largest number of draws of the prior that a prediction rests on, and of the latest sets.
const MOST: usize = 750;
/// Fewest of both.
const FEWEST: usize = 30;
/// Trees for each observation.
const TREES: usize = 60;

type Trees = ExtraTreesRegressor<f64, f64, DenseMatrix<f64>, Vec<f64>>;

/// Predicted shortfall of each of `asked` in the observations in `places`, from the observations whose shortfall
/// differs among the known sets. Trees of an observation live no longer than their predictions.
pub(super) fn predicted(
    found: &Searched,
    observations: &[Observation],
    places: &[usize],
    seed: u64,
    asked: &[Vec<f64>],
) -> Vec<f64> {
    let (draws, later) = found.samples.split_at(found.draws);
    let of_place = |place: &usize| -> Option<Vec<f64>> {
        let place = *place;
        let known = |one: &Sample| {
            let (known, u) = one.numbers[place];
            let lacks = observations[place].missing(known, u, found.scales[place])?;
            Some((one.unit.clone(), lacks))
        };
        let draws = draws.iter().filter_map(known).take(MOST);
        let later = later.iter().rev().filter_map(known).take(MOST);
        let (units, lacks): (Vec<_>, Vec<f64>) = draws.chain(later).unzip();
        if units.len() < FEWEST || lacks.iter().all(|lack| *lack == lacks[0]) {
            return None;
        }
        let parameters = ExtraTreesRegressorParameters {
            n_trees: TREES,
            min_samples_leaf: 2,
            m: Some(units[0].len()),
            seed,
            ..Default::default()
        };
        let trees = Trees::fit(&matrix(&units)?, &lacks, parameters).ok()?;
        trees.predict(&matrix(asked)?).ok()
    };
    let all: Vec<Option<Vec<f64>>> = places.par_iter().map(of_place).collect();
    // In the order of the observations: the same bits for any number of threads.
    all.iter()
        .flatten()
        .fold(vec![0.0; asked.len()], |mut sums, lacks| {
            sums.iter_mut()
                .zip(lacks)
                .for_each(|(sum, lack)| *sum += lack);
            sums
        })
}

fn matrix(units: &[Vec<f64>]) -> Option<DenseMatrix<f64>> {
    let (rows, columns) = (units.len(), units.first()?.len());
    let values = units.iter().flat_map(|unit| unit.iter().copied());
    DenseMatrix::new(rows, columns, values.collect(), false).ok()
}

#[cfg(test)]
mod tests {
    use super::super::observation::{Known, Quantity, Stage};
    use super::*;
    use crate::draws::draw;

    #[test]
    fn of_some_sets_that_which_is_going_to_lack_least_is_found() {
        let above = |range| Observation {
            name: "x".into(),
            quantity: Quantity::Modes(Vec::new()),
            range: Some(range),
            weight: 1.0,
            observed_u: 0.0,
            discrepancy_u: 0.0,
            numerical_u: None,
            stage: Stage::DiskAndRamp,
            source: String::new(),
        };
        // The first number is the first coordinate, the second the product of two others; only 60 sets have it.
        let observations = [above([0.7, 2.0]), above([0.0, 0.1])];
        let simulated = |k: u64| {
            let unit = draw(5, k, 4);
            let second = match k % 5 {
                0 => Known::Is(unit[1] * unit[2]),
                _ => Known::NotAsked,
            };
            let numbers = vec![(Known::Is(unit[0]), 1e-3), (second, 1e-3)];
            Sample {
                unit,
                wave: None,
                numbers,
            }
        };
        let samples: Vec<Sample> = (0..300).map(simulated).collect();
        let found = Searched {
            samples,
            draws: 200,
            scales: vec![0.3, 0.3],
            ..Searched::nothing(2)
        };
        let asked = [
            vec![0.9, 0.9, 0.9, 0.5],
            vec![0.2, 0.1, 0.2, 0.5],
            vec![0.85, 0.1, 0.2, 0.5],
            vec![0.2, 0.9, 0.9, 0.5],
        ];
        let lacks = predicted(&found, &observations, &[0, 1], 1, &asked);
        let least = (0..4).min_by(|a, b| lacks[*a].total_cmp(&lacks[*b]));
        assert_eq!(least, Some(2), "{lacks:?}");
    }
}
