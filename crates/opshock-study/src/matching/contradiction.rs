//! Searches for parameter sets that would disprove a conflict, a group of observations that seem not to hold together.

use super::conflicts::groups;
use super::evaluations::Interrupted;
use super::observation::{Observation, Quantity, Stage};
use super::refinement::{Evolution, population_size};
use super::sample::Sample;
use super::search::Run;
use super::searched::Contradicted;

impl Run<'_, '_> {
    /// For each observation that does not hold with the nearest set, searches for sets that satisfy the smallest group
    /// in which it conflicts with others, until every such group has been searched in vain or is no conflict any more.
    pub(super) fn contradict(&mut self) -> Result<(), Interrupted> {
        let problem = self.problem;
        let mut search = problem.effort.starts * problem.searches().len() as u32;
        if problem.effort.conflict_searches == 0 {
            return Ok(());
        }
        while let Some(group) = self.next_group() {
            let seen = counted(&problem.observations, &group);
            let names: Vec<&str> = group
                .iter()
                .map(|place| problem.observations[*place].name.as_str())
                .collect();
            let (mut tried, mut is_had) = (0, false);
            for k in 0..problem.effort.conflict_searches {
                let evolution = Evolution {
                    search,
                    held: None,
                    seen: &seen,
                    stages: stages(&problem.observations, &group),
                    joining: Vec::new(),
                    most: problem.effort.conflict_evaluations,
                    ends_with: Some(&group),
                };
                let found = self.one_more(&evolution)?;
                search += 1;
                tried += found.0;
                is_had = found.1;
                let name = format!("{}: search {}", names.join(", "), k + 1);
                self.report(&name, found.0, u64::from(is_had));
                if is_had {
                    break;
                }
            }
            if !is_had {
                self.found.contradicted.push(Contradicted {
                    group,
                    searches: problem.effort.conflict_searches,
                    tried,
                });
            }
        }
        Ok(())
    }

    /// One search from draws of its own: number of sets tried, and whether all observations hold with one.
    fn one_more(&mut self, evolution: &Evolution<'_>) -> Result<(u64, bool), Interrupted> {
        let size = population_size(self.problem) as u64;
        let draws = self.found.draws as u64 + size * u64::from(evolution.search);
        let mut first: Vec<Sample> = (draws..draws + size)
            .map(|index| self.fresh(self.draw(index), None))
            .collect();
        let mut stages = evolution.stages.iter();
        stages.try_for_each(|stage| self.evaluate(*stage, &mut first))?;
        self.found.samples.extend(first.iter().cloned());
        let evolved = self.evolve(first, evolution);
        evolved.ended?;
        Ok((size + evolved.tried, evolved.is_had))
    }

    fn next_group(&self) -> Option<Vec<usize>> {
        let (seen, scales) = (&self.problem.observations, &self.found.scales);
        let whole = self.found.samples.iter().filter(|one| one.is_whole());
        let nearest = whole.max_by(|a, b| a.order(b, seen, scales))?;
        let groups = groups(self.problem, &self.found);
        let is_done = |group: &Vec<usize>| {
            let mut done = self.found.contradicted.iter();
            done.any(|one| one.group == *group)
        };
        let smallest = nearest.fails(seen).into_iter().filter_map(|place| {
            let group = groups.iter().find(|(group, _)| group.contains(&place));
            group.map(|(group, _)| group.clone())
        });
        smallest.into_iter().find(|group| !is_done(group))
    }
}

/// The observations, of which only those of a group have a range.
fn counted(observations: &[Observation], group: &[usize]) -> Vec<Observation> {
    let mut counted = observations.to_vec();
    for (place, one) in counted.iter_mut().enumerate() {
        if !group.contains(&place) {
            one.range = None;
        }
    }
    counted
}

/// Stages that the numbers of a group need.
fn stages(observations: &[Observation], group: &[usize]) -> Vec<Stage> {
    let mut left = group.to_vec();
    let mut needed = Vec::new();
    while let Some(place) = left.pop() {
        match &observations[place].quantity {
            Quantity::Combined(_, of) => left.extend(of),
            _ => needed.push(observations[place].stage),
        }
    }
    needed.sort();
    needed.dedup();
    needed
}
