//! A check of a hard case: measured figure, bound, and the naive method's figure.

use serde::Serialize;

/// A measured figure against its bound.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// What the figure is.
    pub what: &'static str,
    /// Measured.
    pub figure: f64,
    /// Largest figure allowed.
    pub bound: f64,
    /// The naive method and its figure, where there is one.
    pub naive: Option<Naive>,
}

/// A method that was replaced by a better one.
#[derive(Clone, Debug, Serialize)]
pub struct Naive {
    /// Method.
    pub method: &'static str,
    /// Its figure for the same check.
    pub figure: f64,
}

/// The largest of figures that are not negative; not a number where one of them is none.
pub(super) fn largest(figures: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |most: f64, figure: f64| match most.is_nan() || figure <= most {
        true => most,
        false => figure,
    };
    figures.into_iter().fold(0.0, larger)
}

impl Check {
    /// A figure with its bound.
    pub fn new(what: &'static str, figure: f64, bound: f64) -> Self {
        Self {
            what,
            figure,
            bound,
            naive: None,
        }
    }

    /// A condition that must hold exactly; the figure is the number of violations.
    pub fn none(what: &'static str, count: usize) -> Self {
        Self::new(what, count as f64, 0.0)
    }

    /// The same with the naive method's figure beside it.
    #[must_use]
    pub fn against(mut self, method: &'static str, figure: f64) -> Self {
        self.naive = Some(Naive { method, figure });
        self
    }

    /// Whether the figure is within its bound; a figure that is no number is not.
    pub fn holds(&self) -> bool {
        self.figure <= self.bound
    }
}
