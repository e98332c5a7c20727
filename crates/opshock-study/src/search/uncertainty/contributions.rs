//! The uncertainty interval of a critical shock and its contributions: what each source of error adds below and above.

use std::collections::BTreeSet;

use super::judge::{self, Estimate};
use crate::search::outcome::Flag;

/// One contribution of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// `search`, or the name of a discretisation parameter or of a group of them.
    pub name: &'static str,
    /// Below the highest survivor, as a share of it.
    pub low: f64,
    /// Above the highest survivor, as a share of it.
    pub high: f64,
    /// Safety factor in it: 1 for a certain bound.
    pub factor: f64,
}

/// An uncertainty interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uncertainty {
    /// Its contributions.
    pub contributions: Vec<Contribution>,
    /// What a reader of it must know.
    pub flags: BTreeSet<Flag>,
}

impl Uncertainty {
    /// Adds a contribution; an estimate that is missing sets a flag.
    pub(super) fn add(&mut self, name: &'static str, estimate: Option<Estimate>, target: f64) {
        let Some(estimate) = estimate else {
            self.flags.insert(Flag::ContributionMissing);
            return;
        };
        // The refined answer, over and times the ratio 1 + e that it may be wrong by.
        let [below, above] = estimate.known;
        let beyond = estimate.share * estimate.factor;
        self.contributions.push(Contribution {
            name,
            low: (below + beyond) / (1.0 + beyond),
            high: above + beyond + above * beyond,
            factor: estimate.factor,
        });
        if estimate.factor == judge::FACTOR_NO_ORDER
            && estimate.error() > judge::NEGLIGIBLE * target
        {
            self.flags.insert(Flag::SafetyFactor3);
        }
    }

    pub(super) fn extend(&mut self, other: &Uncertainty) {
        self.contributions.extend(&other.contributions);
        self.flags.extend(&other.flags);
    }

    /// Half-width of the interval, as a share of the highest survivor; those of contributions add up.
    pub fn half_length(&self) -> f64 {
        let parts = self.contributions.iter();
        0.5 * parts.map(|part| part.low + part.high).sum::<f64>()
    }

    /// Half-width of the interval over its middle, which is the reported value: what is compared with the target.
    pub fn relative(&self) -> f64 {
        self.relative_with(0.0)
    }

    /// The same with a share `more` above.
    pub(super) fn relative_with(&self, more: f64) -> f64 {
        let parts = self.contributions.iter();
        let beyond = more + parts.map(|part| part.high - part.low).sum::<f64>();
        (self.half_length() + 0.5 * more) / (1.0 + 0.5 * beyond)
    }
}
