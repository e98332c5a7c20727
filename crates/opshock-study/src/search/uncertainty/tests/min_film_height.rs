//! The change with half the minimum film height: what it is of a known law, and that the interval is the same without it.

use super::*;

/// Share by which half the minimum film height moves the answer.
const CHANGES: [f64; 4] = [-0.12, 0.0, 0.004, 0.083];

/// Errors for which the scene is refined once or twice.
const ERRORS: [f64; 7] = [0.012, 0.0, 0.0, 0.0, 0.0, 0.004, 0.0];

fn seen(law: &Law, change: f64, input: &UncertaintyInput, ask: Ask) -> Seen {
    let halved = f64::from(ask.levels.of(Discretisation::MinFilmHeight));
    let law = Law {
        exact_g: law.exact_g * (1.0 + change * halved),
        ..*law
    };
    law.see(input.grid, ask)
}

#[test]
fn the_change_is_that_of_the_law_and_leaves_the_interval_as_it_is() {
    for slope_m in [None, Some(2e-8)] {
        for change in CHANGES {
            // Without a coarser film the comparison is made on the scene itself.
            for halvings in [0, 3] {
                let law = Law::formal(ERRORS, slope_m);
                let (plain, _) = law.input(halvings);
                let below = UncertaintyInput {
                    below_continuum: true,
                    ..plain.clone()
                };
                for refinements in [0, 2] {
                    let lookup = |ask: Ask| Some(seen(&law, change, &plain, ask));
                    let (_, without) = answer(&plain, refinements, &lookup);
                    let (runs, with) = answer(&below, refinements, &lookup);
                    let with = done(with);
                    let found = with.half_min_height.expect("a change");
                    // Half a step of the search is 0.5 %; a larger change is known to a quarter of itself.
                    let resolution = (0.25 * change.abs()).max(0.005) * 1.01;
                    assert!((found - change).abs() < resolution, "{found} {change}");
                    let interval = Answer {
                        half_min_height: None,
                        ..with
                    };
                    assert_eq!(interval, done(without));
                    let mut once = runs.clone();
                    once.sort_unstable();
                    once.dedup();
                    assert_eq!(once.len(), runs.len(), "no run is requested twice");
                }
            }
        }
    }
}

#[test]
fn a_deeper_refinement_begins_with_the_runs_of_a_shallower_one() {
    let law = Law::formal(ERRORS, None);
    let (mut input, _) = law.input(3);
    input.below_continuum = true;
    let lookup = |ask: Ask| Some(seen(&law, 0.083, &input, ask));
    let (shallow, _) = answer(&input, 0, &lookup);
    let (deep, found) = answer(&input, 2, &lookup);
    assert!(!done(found).levels.is_none(), "refined");
    assert!(deep.len() > shallow.len() && deep.starts_with(&shallow));
    // Known runs are added one by one in the order of requests.
    for known in 0..deep.len() {
        let some = |ask: Ask| deep[..known].contains(&ask).then(|| lookup(ask)).flatten();
        let (log, next) = answer(&input, 2, &some);
        assert_eq!(log, deep[..known]);
        assert_eq!(next, Progress::Wants(deep[known]));
    }
}
