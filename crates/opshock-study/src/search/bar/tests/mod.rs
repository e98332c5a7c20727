//! Bars against answers that are known.

mod climbs;
mod film;
mod parts;

use super::limits::Limits;
use super::*;
use crate::search::evidence::NodeVerdict;
use crate::search::lattice::Lattice;
use crate::search::outcome::Flag;
use crate::search::probe::Retry;
use opshock_solver::scene::knob::{Knob, Levels};

/// A law of failure: critical amplitude, G, and clearance at its event, for any setting of knobs.
struct Law {
    /// Critical amplitude with every knob infinitely fine, G.
    exact_g: f64,
    /// Error of each knob at level 0, as a share.
    errors: [f64; 6],
    /// Ratio by which a step finer divides each.
    ratios: [f64; 6],
    /// Clearance lost per relative growth of the amplitude, m; `None`: survival ends abruptly.
    slope_m: Option<f64>,
}

impl Law {
    fn critical_g(&self, levels: Levels) -> f64 {
        let errors = Knob::ALL.iter().zip(self.errors.iter().zip(&self.ratios));
        let sum: f64 = errors
            .map(|(&knob, (error, ratio))| error * ratio.powi(-i32::from(levels.of(knob))))
            .sum();
        self.exact_g * (1.0 + sum)
    }

    fn see(&self, lattice: Lattice, ask: Ask) -> Seen {
        let amplitude_g = lattice.amplitude_g(ask.index);
        let critical_g = self.critical_g(ask.levels);
        let survives = amplitude_g < critical_g;
        Seen {
            verdict: match survives {
                true => NodeVerdict::Survives,
                false => NodeVerdict::Fails,
            },
            h_min_m: Some(match (survives, self.slope_m) {
                (false, _) => 0.0,
                (true, Some(slope_m)) => slope_m * (critical_g / amplitude_g - 1.0),
                (true, None) => 2e-9,
            }),
            t_min_s: Some(match self.slope_m {
                Some(_) => 1e-3,
                None => 2e-3,
            }),
        }
    }

    /// The bar of this law on a lattice of one per cent, and the runs it took.
    fn bar(&self) -> (Bar, f64, usize) {
        self.bar_with(3)
    }

    fn input(&self, film_halvings: i8) -> (BarInput, f64) {
        let search = Lattice::for_tolerance(0.01).expect("lattice");
        let lattice = search.finer(SUBNODES);
        let survivor = search.at_or_below(self.critical_g(Levels::NONE) * (1.0 - 1e-12));
        let known = |node: i32| {
            let index = node * SUBNODES;
            let seen = self.see(
                lattice,
                Ask {
                    levels: Levels::NONE,
                    index,
                    retry: Retry::None,
                },
            );
            Known {
                index,
                h_min_m: seen.h_min_m.expect("a clearance"),
                t_min_s: seen.t_min_s.expect("a time"),
            }
        };
        let input = BarInput {
            base: Levels::NONE,
            lattice,
            survivor: survivor * SUBNODES,
            failure: (survivor + 1) * SUBNODES,
            t_fail_s: Some(1e-3),
            survivors: [4, 2, 0].map(|below| known(survivor - below)).to_vec(),
            knobs: Knob::ALL.to_vec(),
            film_halvings,
            mesh_halvings: 0,
            holds_films: false,
            accuracy: 0.01,
        };
        (input, search.amplitude_g(survivor))
    }

    fn bar_with(&self, film_halvings: i8) -> (Bar, f64, usize) {
        let (input, reported_g) = self.input(film_halvings);
        let lattice = input.lattice;
        let (log, progress) = bar(&input, &|ask| Some(self.see(lattice, ask)));
        let bar = done(progress);
        (bar, reported_g, log.len())
    }

    /// The answer after at most so many climbs, its amplitude and the runs it took.
    fn climbed(&self, climbs: u8) -> (Answer, f64, usize) {
        let (input, _) = self.input(3);
        let lattice = input.lattice;
        let (log, progress) = answer(&input, climbs, &|ask| Some(self.see(lattice, ask)));
        let answer = done(progress);
        let reported_g = lattice.amplitude_g(answer.survivor);
        (answer, reported_g, log.len())
    }

    fn formal(errors: [f64; 6], slope_m: Option<f64>) -> Law {
        Law {
            exact_g: 300.0,
            errors,
            ratios: Knob::ALL.map(Knob::formal_ratio),
            slope_m,
        }
    }
}

/// Error that a part gives on its larger side, as a share.
fn larger(part: Part) -> f64 {
    part.high.max(part.low / (1.0 - part.low))
}

fn part(bar: &Bar, name: &str) -> Part {
    *bar.parts
        .iter()
        .find(|part| part.name == name)
        .unwrap_or_else(|| panic!("no {name} in {bar:?}"))
}

/// What is reached when every run is known.
fn done<T: std::fmt::Debug>(progress: Progress<T>) -> T {
    match progress {
        Progress::Done(found) => found,
        Progress::Wants(ask) => panic!("{ask:?} is not known"),
    }
}
