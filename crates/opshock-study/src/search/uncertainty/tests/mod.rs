//! Tests of uncertainty intervals against laws of failure whose answers are known.

mod contributions;
mod film;
mod min_film_height;
mod refinements;

use super::pieces::{pieces, whole};
use super::walk::Walk;
use super::*;
use crate::search::amplitude_grid::AmplitudeGrid;
use crate::search::evidence::AmplitudeVerdict;
use crate::search::outcome::Flag;
use crate::search::probe::Retry;
use opshock_solver::scene::discretisation::{Discretisation, Levels};

/// The interval of `input` without refinement, as far as `lookup` knows the runs it needs, with the runs requested.
fn uncertainty(
    input: &UncertaintyInput,
    lookup: &dyn Fn(Ask) -> Option<Seen>,
) -> (Vec<Ask>, Progress) {
    let mut log = Vec::new();
    let mut walk = Walk::new(input, lookup, &mut log);
    let progress = match pieces(&mut walk, Default::default()) {
        Ok(pieces) => Progress::Done(whole(&walk, &pieces)),
        Err(ask) => Progress::Wants(ask),
    };
    (log, progress)
}

/// A law of failure: critical amplitude, G, and clearance at its event, for any levels of discretisation parameters.
struct Law {
    /// Critical amplitude with every discretisation parameter infinitely fine, G.
    exact_g: f64,
    /// Error of each discretisation parameter at level 0, as a share.
    errors: [f64; 7],
    /// Ratio by which a refinement step divides each.
    ratios: [f64; 7],
    /// Clearance lost per relative growth of the amplitude, m; `None`: survival ends abruptly.
    slope_m: Option<f64>,
}

impl Law {
    fn critical_g(&self, levels: Levels) -> f64 {
        let errors = Discretisation::ALL
            .iter()
            .zip(self.errors.iter().zip(&self.ratios));
        let sum: f64 = errors
            .map(|(&discretisation, (error, ratio))| {
                error * ratio.powi(-i32::from(levels.of(discretisation)))
            })
            .sum();
        self.exact_g * (1.0 + sum)
    }

    fn see(&self, grid: AmplitudeGrid, ask: Ask) -> Seen {
        let amplitude_g = grid.amplitude_g(ask.index);
        let critical_g = self.critical_g(ask.levels);
        let survives = amplitude_g < critical_g;
        Seen {
            verdict: match survives {
                true => AmplitudeVerdict::Survives,
                false => AmplitudeVerdict::Fails,
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

    /// The interval of this law on an amplitude grid of one per cent, and the runs it took.
    fn uncertainty(&self) -> (Uncertainty, f64, usize) {
        self.uncertainty_with(3)
    }

    fn input(&self, film_halvings: i8) -> (UncertaintyInput, f64) {
        let search = AmplitudeGrid::for_tolerance(0.01).expect("amplitude grid");
        let grid = search.finer(SUBDIVISIONS);
        let survivor = search.at_or_below(self.critical_g(Levels::NONE) * (1.0 - 1e-12));
        let known = |grid_point: i32| {
            let index = grid_point * SUBDIVISIONS;
            let seen = self.see(
                grid,
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
        let input = UncertaintyInput {
            base: Levels::NONE,
            grid,
            survivor: survivor * SUBDIVISIONS,
            failure: (survivor + 1) * SUBDIVISIONS,
            t_fail_s: Some(1e-3),
            survivors: [4, 2, 0].map(|below| known(survivor - below)).to_vec(),
            discretisations: Discretisation::ALL.to_vec(),
            film_halvings,
            mesh_halvings: 0,
            hard_contact: false,
            below_continuum: false,
            target: 0.01,
        };
        (input, search.amplitude_g(survivor))
    }

    fn uncertainty_with(&self, film_halvings: i8) -> (Uncertainty, f64, usize) {
        let (input, reported_g) = self.input(film_halvings);
        let grid = input.grid;
        let (log, progress) = uncertainty(&input, &|ask| Some(self.see(grid, ask)));
        let uncertainty = done(progress);
        (uncertainty, reported_g, log.len())
    }

    /// The answer after at most so many refinements, its amplitude and the runs it took.
    fn refined(&self, refinements: u8) -> (Answer, f64, usize) {
        let (input, _) = self.input(3);
        let grid = input.grid;
        let (log, progress) = answer(&input, refinements, &|ask| Some(self.see(grid, ask)));
        let answer = done(progress);
        let reported_g = grid.amplitude_g(answer.survivor);
        (answer, reported_g, log.len())
    }

    fn formal(errors: [f64; 7], slope_m: Option<f64>) -> Law {
        Law {
            exact_g: 300.0,
            errors,
            ratios: Discretisation::ALL.map(Discretisation::formal_ratio),
            slope_m,
        }
    }
}

/// Error that a contribution gives on its larger side, as a share.
fn larger(contribution: Contribution) -> f64 {
    contribution
        .high
        .max(contribution.low / (1.0 - contribution.low))
}

fn contribution(uncertainty: &Uncertainty, name: &str) -> Contribution {
    *uncertainty
        .contributions
        .iter()
        .find(|contribution| contribution.name == name)
        .unwrap_or_else(|| panic!("no {name} in {uncertainty:?}"))
}

/// What is reached when every run is known.
fn done<T: std::fmt::Debug>(progress: Progress<T>) -> T {
    match progress {
        Progress::Done(found) => found,
        Progress::Wants(ask) => panic!("{ask:?} is not known"),
    }
}
