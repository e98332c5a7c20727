//! A number that is not known yet, with a range.

use serde::Serialize;

/// An estimate with its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Lower end: 10 of 100 outcomes lie below.
    pub min: f64,
    /// Half of the outcomes lie below.
    pub likely: f64,
    /// Upper end: 10 of 100 outcomes lie above.
    pub max: f64,
}

impl Spread {
    /// 10th, 50th and 90th percentile of equally likely outcomes; zero without any.
    pub(super) fn of(mut outcomes: Vec<f64>) -> Spread {
        outcomes.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (outcomes.len().saturating_sub(1) as f64 * share).round() as usize;
            outcomes.get(place).copied().unwrap_or(0.0)
        };
        Spread {
            min: at(0.1),
            likely: at(0.5),
            max: at(0.9),
        }
    }

    /// Every number of it times `factor`.
    pub(super) fn scaled(self, factor: f64) -> Spread {
        Spread {
            min: self.min * factor,
            likely: self.likely * factor,
            max: self.max * factor,
        }
    }
}
