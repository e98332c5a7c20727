//! A number that is not known yet, with a range.

use serde::Serialize;

/// An estimate with its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Lower end: 5 of 100 outcomes lie below.
    pub min: f64,
    /// Half of the outcomes lie below.
    pub likely: f64,
    /// Upper end: 5 of 100 outcomes lie above.
    pub max: f64,
}

impl Spread {
    /// 5th, 50th and 95th percentile of equally likely outcomes; zero without any.
    pub(super) fn of(mut outcomes: Vec<f64>) -> Spread {
        outcomes.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (outcomes.len().saturating_sub(1) as f64 * share).round() as usize;
            outcomes.get(place).copied().unwrap_or(0.0)
        };
        Spread {
            min: at(0.05),
            likely: at(0.5),
            max: at(0.95),
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

    /// This estimate of what is left, narrowed until the total, with what is `done`, spans a factor 1.98 at most. A narrowed
    /// range holds fewer than 90 of 100 outcomes.
    pub(super) fn narrowed(self, done: f64) -> Spread {
        let whole = done + self.likely;
        let half = 1.98_f64.sqrt();
        Spread {
            min: self.min.max(whole / half - done),
            likely: self.likely,
            max: self.max.min(whole * half - done),
        }
    }
}
