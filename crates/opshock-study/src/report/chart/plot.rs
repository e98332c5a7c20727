//! The plotting area of a panel, with its axes: gives the pixel of a value.

use super::axis::ResolvedAxis;
use super::figure::{Panel, Rule, Value};

/// Plotting area and its axes.
pub(super) struct Plot {
    pub(super) x0: f64,
    pub(super) y0: f64,
    pub(super) x1: f64,
    pub(super) y1: f64,
    pub(super) shift: f64,
    pub(super) x: ResolvedAxis,
    pub(super) y: ResolvedAxis,
}

impl Plot {
    /// The same axes with everything drawn `dx` to the right.
    pub(super) fn shifted(&self, dx: f64) -> Plot {
        Plot {
            shift: dx,
            x: self.x.clone(),
            y: self.y.clone(),
            ..*self
        }
    }

    /// Lengths of the axes' units made equal: the axis with the longer unit shows more.
    pub(super) fn true_to_scale(mut self) -> Plot {
        let x_unit = (self.x1 - self.x0) / (self.x.high - self.x.low);
        let y_unit = (self.y1 - self.y0) / (self.y.high - self.y.low);
        if x_unit > y_unit {
            self.x = self.x.grown(x_unit / y_unit);
        } else {
            self.y = self.y.grown(y_unit / x_unit);
        }
        self
    }

    pub(super) fn px(&self, x: f64) -> f64 {
        self.shift + self.x0 + self.x.share(x) * (self.x1 - self.x0)
    }

    pub(super) fn py(&self, y: f64) -> f64 {
        self.y1 - self.y.share(y) * (self.y1 - self.y0)
    }

    pub(super) fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.px(x), self.py(y))
    }
}

pub(super) fn abscissae(panel: &Panel) -> impl Iterator<Item = f64> {
    panel.series.iter().flat_map(|series| {
        let curve = series.curve.iter().map(|p| p.0);
        curve.chain(series.samples.iter().map(|sample| sample.x))
    })
}

pub(super) fn ordinates(panel: &Panel) -> impl Iterator<Item = f64> {
    let series = panel.series.iter().flat_map(|series| {
        let curve = series.curve.iter().map(|p| p.1);
        let samples = series.samples.iter().flat_map(|sample| match sample.value {
            Value::Known { y, low, high } => [y, low, high],
            Value::Above(y) | Value::Below(y) => [y; 3],
        });
        curve.chain(samples)
    });
    let rules = panel.rules.iter().filter_map(|rule| match rule {
        Rule::Horizontal { y, .. } => Some(*y),
        Rule::Vertical { .. } => None,
    });
    series.chain(rules)
}
