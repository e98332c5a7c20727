//! What each tolerance is worth: the change of every critical shock across it, the largest certain one first.

use serde::Serialize;

use super::pair::Pair;
use super::simulated::{ENDS, grid};
use crate::population::Tolerances;
use crate::study::Study;

/// Change of the critical shock of a point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The point.
    pub point: String,
    /// Critical shocks at the lower and the higher value, G.
    pub critical_g: [Option<f64>; 2],
    /// Change from the lower to the higher value, G.
    pub change_g: Option<f64>,
    /// Half-width of its interval, G.
    pub uncertainty_g: Option<f64>,
    /// Steps by which the study's resolution was refined for it.
    pub refined: usize,
    /// The interval does not hold 0.
    pub excludes_zero: bool,
}

/// What one tolerance is worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorthRow {
    /// Name of the tolerance.
    pub name: String,
    /// Its keys at the lower and the higher value.
    pub values: Vec<(String, [Option<String>; 2])>,
    /// Difference of the values of the first key, in the key's unit; of relative values, of the key itself.
    pub width: Option<f64>,
    /// By point.
    pub changes: Vec<Change>,
}

impl WorthRow {
    /// The change of which most is certain: the end of its interval that is nearer to 0 is farthest from it.
    pub fn largest(&self) -> Option<&Change> {
        let known = self
            .changes
            .iter()
            .filter(|change| change.change_g.is_some());
        known.max_by(|a, b| a.certain_g().total_cmp(&b.certain_g()))
    }

    fn certain_g(&self) -> f64 {
        self.largest().map_or(f64::NEG_INFINITY, Change::certain_g)
    }
}

impl Change {
    /// The least that it may be, either way, G; below 0 where its interval holds 0.
    fn certain_g(&self) -> f64 {
        self.change_g.unwrap_or(0.0).abs() - self.uncertainty_g.unwrap_or(0.0)
    }
}

/// What every tolerance is worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorthAnswer {
    /// Name of the tolerance file.
    pub name: String,
    /// By tolerance, the one with the largest certain change first.
    pub rows: Vec<WorthRow>,
}

impl WorthAnswer {
    /// Of the pairs by tolerance and point.
    pub fn of(tolerances: &Tolerances, nominal: &Study, pairs: &[Vec<Pair>]) -> WorthAnswer {
        let grid = grid();
        let order = nominal.table_order();
        let all = tolerances.parameters.iter().zip(pairs);
        let mut rows: Vec<WorthRow> = all
            .map(|(parameter, pairs)| {
                let [low, high] = ENDS.map(|end| parameter.settings(end));
                let both = low.into_iter().zip(high);
                let values: Vec<_> = both.map(|((key, a), (_, b))| (key, [a, b])).collect();
                let numbers = values.first().and_then(|(_, ends)| {
                    let number = |text: &Option<String>| text.as_ref()?.parse::<f64>().ok();
                    Some([number(&ends[0])?, number(&ends[1])?])
                });
                let changes = pairs.iter().zip(&order).map(|(pair, &point)| {
                    let amplitude_g = |step: i32| grid.amplitude_g(step);
                    let found = pair.change_g(&amplitude_g);
                    Change {
                        point: nominal.points[point].label(),
                        critical_g: pair.critical_g(&amplitude_g),
                        change_g: found.map(|[change_g, _]| change_g),
                        uncertainty_g: found.map(|[_, half_g]| half_g),
                        refined: pair.refined(),
                        excludes_zero: found
                            .is_some_and(|[change_g, half_g]| change_g.abs() > half_g),
                    }
                });
                WorthRow {
                    name: parameter.name.clone(),
                    width: numbers.map(|[low, high]| high - low),
                    values,
                    changes: changes.collect(),
                }
            })
            .collect();
        rows.sort_by(|a, b| b.certain_g().total_cmp(&a.certain_g()));
        WorthAnswer {
            name: tolerances.name.clone(),
            rows,
        }
    }
}
