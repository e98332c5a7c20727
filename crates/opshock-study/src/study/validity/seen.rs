//! Records which combinations of axis values a rule has looked at, so that none is checked twice.
//!
//! A rule reads some keys only, and a study of many axes holds the same values of those keys over
//! and over. What a rule says is a function of the values it reads, so a combination that agrees with
//! an earlier one in all axes that the rule read there needs no second look.

use std::collections::BTreeSet;

use crate::study::settings::View;

/// Combinations one rule has looked at.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// For every set of axes that was read: the positions at which it was.
    read: Vec<(u64, BTreeSet<Vec<usize>>)>,
}

impl Seen {
    /// Runs `rule` unless it would only repeat itself; says whether it ran.
    pub fn look(&mut self, view: &View<'_>, rule: impl FnOnce()) -> bool {
        let known = |(axes, at): &(u64, BTreeSet<Vec<usize>>)| at.contains(&view.at(*axes));
        if self.read.iter().any(known) {
            return false;
        }
        view.forget_read();
        rule();
        let (axes, at) = (view.read(), view.at(view.read()));
        match self.read.iter_mut().find(|(known, _)| *known == axes) {
            Some((_, seen)) => _ = seen.insert(at),
            None => self.read.push((axes, BTreeSet::from([at]))),
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Study;

    #[test]
    fn a_rule_runs_once_for_each_value_of_what_it_reads() {
        let sets = [
            "ramp.clearance_um=[80, 90, 100]",
            "slider.angle_deg=[6, 7]",
            "suspension.gram_load_gf=[0.9, 1.0]",
        ];
        let sets: Vec<_> = sets.iter().map(|set| set.parse().expect("a set")).collect();
        let study = Study::from_text(&Study::example("axes"), &sets).expect("a study");
        let (mut seen, mut runs) = (Seen::default(), 0);
        crate::study::points::combinations(&study.settings, |view| {
            seen.look(view, || {
                runs += 1;
                // The angle is read at one clearance only.
                if view.number("ramp.clearance_um") == 90.0 {
                    view.number("slider.angle_deg");
                }
            });
        });
        assert_eq!(runs, 1 + 2 + 1);
    }
}
