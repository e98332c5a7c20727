//! Rounds in which failures found elsewhere are looked for: those of neighbouring widths, and those of the same point with a
//! smaller clearance called failure.

use super::campaign::{Campaign, Stage};
use super::follow;

impl Campaign {
    /// `point` is `other` with the next smaller clearance called failure.
    pub(super) fn is_smaller(&self, point: usize, other: usize) -> bool {
        self.order.relations[other].smaller_clearance == Some(point)
    }

    /// Gives lower failures to neighbours when no width of a chain has a probe to request.
    pub(super) fn close_round(&mut self, chain: usize) {
        let widths = self.order.chains[chain].clone();
        let smaller = |point: usize| self.order.relations[point].smaller_clearance;
        // Failures found at a smaller clearance are failures here.
        let is_smaller_final = |point: usize| {
            smaller(point).is_none_or(|other| self.chain_final[self.order.relations[other].chain])
        };
        let idle = |point: usize| self.points[point].base.is_some() && self.ask(point).is_none();
        let is_idle = |&point: &usize| idle(point) && is_smaller_final(point);
        if self.chain_final[chain] || !widths.iter().all(is_idle) {
            return;
        }
        let spacing = (self.settings.scan_gap / 3).max(1);
        let mut gifts = Vec::new();
        for &neighbour in &widths {
            let Some(other) = self.search(neighbour) else {
                continue;
            };
            let of_smaller = smaller(neighbour).and_then(|source| {
                let failure = self.search(source)?.evidence().lowest_failure()?;
                Some((source, failure, neighbour))
            });
            if let Some(gift) = of_smaller
                && other.is_open_below_failure(gift.1)
                && !self.given.contains(&gift)
            {
                gifts.push((gift, vec![gift.1]));
            }
            for source in self.order.relations[neighbour]
                .neighbours
                .into_iter()
                .flatten()
            {
                let Some(search) = self.search(source) else {
                    continue;
                };
                let Some(window) = follow::lower_window(search) else {
                    continue;
                };
                let gift = (source, window.0, neighbour);
                if !self.given.contains(&gift) {
                    gifts.push((gift, follow::targets(search, window, other, spacing)));
                }
            }
        }
        for (gift, grid_points) in gifts {
            self.given.insert(gift);
            let (.., neighbour) = gift;
            if let Stage::Searching(search) = &mut self.points[neighbour].stage {
                search.follow(&grid_points);
                self.changed.push(neighbour);
            }
        }
        self.chain_final[chain] = widths.iter().all(|&point| self.ask(point).is_none());
        if !self.chain_final[chain] {
            return;
        }
        self.n_final_chains += 1;
        // Those of larger clearances may have waited for this one alone.
        let mut larger: Vec<usize> = Vec::new();
        for &point in &widths {
            let of_larger = self.successors[point].iter().copied();
            let of_larger = of_larger.filter(|&other| self.is_smaller(point, other));
            larger.extend(of_larger.map(|other| self.order.relations[other].chain));
        }
        larger.sort_unstable();
        larger.dedup();
        for chain in larger {
            self.close_round(chain);
        }
    }
}
