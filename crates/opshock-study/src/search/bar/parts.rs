//! An error bar and its parts.

use std::collections::BTreeSet;

use super::judge::{self, Estimate};
use crate::search::outcome::Flag;

/// One part of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// `search`, the knob's word or that of a group.
    pub name: &'static str,
    /// Below the reported value, as a share of it.
    pub low: f64,
    /// Above the reported value, as a share of it.
    pub high: f64,
    /// Factor of safety in it: 1 for a certain bound.
    pub factor: f64,
}

/// An error bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Its parts.
    pub parts: Vec<Part>,
    /// What a reader must know of it.
    pub flags: BTreeSet<Flag>,
}

impl Bar {
    /// Adds a part; one that is not known is said to be missing.
    pub(super) fn add(&mut self, name: &'static str, estimate: Option<Estimate>, accuracy: f64) {
        let Some(estimate) = estimate else {
            self.flags.insert(Flag::BarPartial);
            return;
        };
        let [below, above] = estimate.errors();
        self.parts.push(Part {
            name,
            // The ratio 1 + e downwards.
            low: below / (1.0 + below),
            high: above,
            factor: estimate.factor,
        });
        if estimate.factor == judge::WIDE && !estimate.is_negligible(accuracy) {
            self.flags.insert(Flag::BarWide);
        }
    }

    pub(super) fn extend(&mut self, other: &Bar) {
        self.parts.extend(&other.parts);
        self.flags.extend(&other.flags);
    }

    /// Half the bar's length over the reported value: what is compared with the accuracy asked.
    pub fn half_length(&self) -> f64 {
        0.5 * self
            .parts
            .iter()
            .map(|part| part.low + part.high)
            .sum::<f64>()
    }
}
