//! What is known about a point: nodes with their verdicts.

use std::collections::BTreeMap;

/// Verdict of a node after all its retries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeVerdict {
    /// Survives.
    Survives,
    /// Fails.
    Fails,
    /// No verdict, whatever was tried.
    Undecided,
}

/// Nodes tested, by index. Every verdict is kept; survival need not be monotone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evidence {
    nodes: BTreeMap<i32, NodeVerdict>,
    /// Of these the lowest that fails, and how many have no verdict: asked for at every probe.
    lowest_failure: Option<i32>,
    n_undecided: usize,
    /// Smallest clearances of survivors, bits of metres.
    margins: BTreeMap<i32, u64>,
}

impl Evidence {
    /// Records a node.
    pub fn insert(&mut self, index: i32, verdict: NodeVerdict) {
        let before = self.nodes.insert(index, verdict);
        self.n_undecided += usize::from(verdict == NodeVerdict::Undecided);
        self.n_undecided -= usize::from(before == Some(NodeVerdict::Undecided));
        let is_lower = self.lowest_failure.is_none_or(|lowest| index < lowest);
        if verdict == NodeVerdict::Fails && is_lower {
            self.lowest_failure = Some(index);
        } else if self.lowest_failure == Some(index) && verdict != NodeVerdict::Fails {
            let fails = |(_, verdict): &(&i32, &NodeVerdict)| **verdict == NodeVerdict::Fails;
            self.lowest_failure = self.nodes.iter().find(fails).map(|(&index, _)| index);
        }
    }

    /// Records the smallest clearance, m, of a node that survives.
    pub fn insert_margin(&mut self, index: i32, h_min_m: f64) {
        self.margins.insert(index, h_min_m.to_bits());
    }

    /// Where the clearance of the two highest survivors below `limit` (exclusive) would vanish on a
    /// straight line, in nodes; `None` when it does not fall, or one of the two has none.
    pub fn vanishing_point(&self, limit: Option<i32>) -> Option<f64> {
        let high = self.highest_survivor_below(limit)?;
        let low = self.highest_survivor_below(Some(high))?;
        let margin = |index| self.margins.get(&index).copied().map(f64::from_bits);
        let (h_low, h_high) = (margin(low)?, margin(high)?);
        let slope = (h_low - h_high) / f64::from(high - low);
        (slope > 0.0 && h_high >= 0.0).then(|| f64::from(high) + h_high / slope)
    }

    /// Verdict of a node, if tested.
    pub fn get(&self, index: i32) -> Option<NodeVerdict> {
        self.nodes.get(&index).copied()
    }

    /// Nothing was tested.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Highest tested node, decided or not.
    pub fn top(&self) -> Option<i32> {
        self.nodes.keys().next_back().copied()
    }

    /// Lowest tested node, decided or not.
    pub fn bottom(&self) -> Option<i32> {
        self.nodes.keys().next().copied()
    }

    /// Lowest failing node.
    pub fn lowest_failure(&self) -> Option<i32> {
        self.lowest_failure
    }

    /// Lowest node of `nodes` with a verdict.
    pub fn lowest_with(&self, verdict: NodeVerdict, nodes: std::ops::Range<i32>) -> Option<i32> {
        let known = self.nodes.range(nodes);
        let mut with = known.filter(|(_, known)| **known == verdict);
        with.next().map(|(&index, _)| index)
    }

    /// Lowest node, not below `floor`, down to which every node below `top` is known and none fails.
    pub fn unbroken_below(&self, top: i32, floor: i32) -> i32 {
        let mut at = top;
        for (&index, verdict) in self.nodes.range(floor.min(top)..top).rev() {
            if index != at - 1 || *verdict == NodeVerdict::Fails {
                break;
            }
            at = index;
        }
        at
    }

    /// Highest survivor below `limit` (exclusive), of all nodes when there is no limit.
    pub fn highest_survivor_below(&self, limit: Option<i32>) -> Option<i32> {
        let below = match limit {
            Some(limit) => self.nodes.range(..limit),
            None => self.nodes.range(..),
        };
        below
            .rev()
            .find(|(_, verdict)| **verdict == NodeVerdict::Survives)
            .map(|(index, _)| *index)
    }

    /// Undecided nodes strictly between two nodes, ascending.
    pub fn undecided_between(&self, low: i32, high: i32) -> Vec<i32> {
        if low + 1 >= high {
            return Vec::new();
        }
        self.nodes
            .range(low + 1..high)
            .filter(|(_, verdict)| **verdict == NodeVerdict::Undecided)
            .map(|(index, _)| *index)
            .collect()
    }

    /// Number of undecided nodes.
    pub fn n_undecided(&self) -> usize {
        self.n_undecided
    }

    /// Every (survivor, next higher decided node that fails), ascending.
    pub fn brackets(&self) -> Vec<(i32, i32)> {
        let mut brackets = Vec::new();
        let mut survivor = None;
        for (&index, verdict) in &self.nodes {
            match verdict {
                NodeVerdict::Survives => survivor = Some(index),
                NodeVerdict::Fails => {
                    if let Some(low) = survivor.take() {
                        brackets.push((low, index));
                    }
                }
                NodeVerdict::Undecided => {}
            }
        }
        brackets
    }

    /// A survivor lies above a failure.
    pub fn is_non_monotone(&self) -> bool {
        match (self.lowest_failure(), self.highest_survivor_below(None)) {
            (Some(failure), Some(survivor)) => survivor > failure,
            _ => false,
        }
    }

    /// The lowest failure and the last node before the next higher survivor: where the lowest
    /// window of failure lies.
    pub fn window_of_failure(&self) -> Option<(i32, i32)> {
        let low = self.lowest_failure()?;
        let top = self.top()?;
        let above = self
            .nodes
            .range(low..)
            .find(|(_, verdict)| **verdict == NodeVerdict::Survives)
            .map_or(top, |(index, _)| index - 1);
        Some((low, above))
    }

    /// Largest step between neighbouring survivors from `low` up to `high`, nodes.
    ///
    /// `low` counts as a survivor whether tested or not.
    pub fn largest_gap(&self, low: i32, high: i32) -> i32 {
        let mut last = low;
        let mut largest = 0;
        for (&index, verdict) in self.nodes.range(low..=high) {
            if *verdict == NodeVerdict::Survives {
                largest = largest.max(index - last);
                last = index;
            }
        }
        largest.max(high - last)
    }

    /// Lowest survivor.
    pub fn lowest_survivor(&self) -> Option<i32> {
        self.nodes
            .iter()
            .find(|(_, verdict)| **verdict == NodeVerdict::Survives)
            .map(|(index, _)| *index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_that_replaces_another_counts_once() {
        let mut evidence = Evidence::default();
        for (index, verdict) in [
            (7, NodeVerdict::Fails),
            (3, NodeVerdict::Undecided),
            (5, NodeVerdict::Fails),
        ] {
            evidence.insert(index, verdict);
        }
        assert_eq!(
            (evidence.lowest_failure(), evidence.n_undecided()),
            (Some(5), 1)
        );
        evidence.insert(3, NodeVerdict::Survives);
        evidence.insert(5, NodeVerdict::Survives);
        assert_eq!(
            (evidence.lowest_failure(), evidence.n_undecided()),
            (Some(7), 0)
        );
        assert_eq!(evidence.lowest_with(NodeVerdict::Survives, 4..9), Some(5));
        assert_eq!(evidence.lowest_with(NodeVerdict::Fails, 0..7), None);
        evidence.insert(6, NodeVerdict::Undecided);
        let below = |top, floor| evidence.unbroken_below(top, floor);
        assert_eq!(
            [below(7, 0), below(7, 6), below(8, 0), below(4, 9)],
            [5, 6, 8, 4]
        );
    }
}
