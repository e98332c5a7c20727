//! Energy of slider and suspension through a run that goes on after its failure.
//!
//! ```text
//! T = ẋᵀ M ẋ/2,   U = Σ ω² η²/2 + Σ G p²/2 + U_d(δ) + Σ k max(0, o − g)²/2
//! U_d = k_d δ²/2 where δ > −N₀/k_d, else −N₀ δ − N₀²/(2 k_d)
//! d(T + U)/dt = a f·ẋ + u̇ e·f_s + (F − F₀ − F_c − F_μ)·q̇ + F_c·q̇ + F_μ·q̇ − D
//! ```
//!
//! Symbols are those of `mechanics` and `stops`; F is the force of the film with all that acts in the gap, F_c that of the
//! asperities, F_μ the couple of their friction, f_s the force of suspension and contacts on x, and D what dampers take:
//! of the modes, of the dimple and of the stops. Motions are increments from steady flight, and so is the energy. Works are
//! those along the line between the ends of a step, by Simpson's rule for the asperities and by the mean of both ends for all
//! else; D is integrated by Simpson's rule, with the cubic through both ends in the middle. What is left open is the error of the
//! time integration and of these rules.

use super::outcome::HeadEnergy;
use crate::rough_contact::nominal::ContactState;

/// Energies and forces at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EnergyState {
    pub kinetic_j: f64,
    pub elastic_j: f64,
    pub time_s: f64,
    /// q: rise, pitch and roll of the slider.
    pub slider: [f64; 3],
    /// f·x, kg m: the inertia load's work per acceleration.
    pub shock_kg_m: f64,
    /// Inertia load just before and just after the instant, m/s2.
    pub load_m_per_s2: [f64; 2],
    /// u, m, and e·f_s, N.
    pub pivot: [f64; 2],
    /// Force and moments of what acts in the gap beside the asperities, less the steady ones.
    pub film: [f64; 3],
    pub contact: ContactState,
    /// At the mean of this attitude and the one before.
    pub midway: ContactState,
    /// D, and D in the middle of the step, W.
    pub damping_w: f64,
    pub damping_midway_w: f64,
}

/// Energy balance in progress.
#[derive(Clone, Debug)]
pub(super) struct EnergyWatch {
    latest: EnergyState,
    /// Coordinates and velocities over the pivot then.
    seen: [Vec<f64>; 2],
    record: HeadEnergy,
}

/// Work of a force along the line between two places, by Simpson's rule: forces at the first, in the middle and at the last.
pub(super) fn work<const N: usize>(forces: [[f64; N]; 3], places: [[f64; N]; 2]) -> f64 {
    let [from, to] = places;
    let mean = |k: usize| (forces[0][k] + 4.0 * forces[1][k] + forces[2][k]) / 6.0;
    (0..N).map(|k| mean(k) * (to[k] - from[k])).sum()
}

/// The same with the mean of both ends in the middle.
fn work_of_ends<const N: usize>([from, to]: [[f64; N]; 2], places: [[f64; N]; 2]) -> f64 {
    let middle = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
    work([from, middle, to], places)
}

impl EnergyWatch {
    /// From the first instant of a run.
    pub fn new(first: EnergyState, seen: &[Vec<f64>; 2]) -> Self {
        let start_j = first.kinetic_j + first.elastic_j;
        Self {
            latest: first,
            seen: seen.clone(),
            record: HeadEnergy {
                start_j,
                peak_j: start_j,
                ..HeadEnergy::default()
            },
        }
    }

    /// Time, and coordinates and velocities over the pivot, at the latest instant.
    pub fn latest(&self) -> (f64, &[Vec<f64>; 2]) {
        (self.latest.time_s, &self.seen)
    }

    /// Adds the next accepted state.
    pub fn add(&mut self, now: EnergyState, seen: &[Vec<f64>; 2]) {
        for (latest, seen) in self.seen.iter_mut().zip(seen) {
            latest.copy_from_slice(seen);
        }
        let before = std::mem::replace(&mut self.latest, now);
        let places = [before.slider, now.slider];
        let through = |of: fn(&ContactState) -> [f64; 3]| {
            work([&before.contact, &now.midway, &now.contact].map(of), places)
        };
        let sum = &mut self.record;
        let loads = [[before.load_m_per_s2[1]], [now.load_m_per_s2[0]]];
        sum.shock_work_j += work_of_ends(loads, [[before.shock_kg_m], [now.shock_kg_m]]);
        let [pivot, held] = [0, 1].map(|k| [[before.pivot[k]], [now.pivot[k]]]);
        sum.shock_work_j += work_of_ends(held, pivot);
        sum.film_work_j += work_of_ends([before.film, now.film], places);
        sum.contact_work_j += through(ContactState::normal_load);
        sum.friction_work_j += through(ContactState::friction_load);
        let dt_s = now.time_s - before.time_s;
        let damping_w = before.damping_w + 4.0 * now.damping_midway_w + now.damping_w;
        sum.damping_loss_j += dt_s / 6.0 * damping_w;
        sum.peak_j = sum.peak_j.max(now.kinetic_j + now.elastic_j);
    }

    /// The balance.
    pub fn finish(self) -> HeadEnergy {
        let mut sum = self.record;
        (sum.kinetic_j, sum.elastic_j) = (self.latest.kinetic_j, self.latest.elastic_j);
        let works = sum.shock_work_j + sum.film_work_j + sum.contact_work_j + sum.friction_work_j;
        let gained_j = sum.kinetic_j + sum.elastic_j - sum.start_j;
        sum.imbalance_j = gained_j - works + sum.damping_loss_j;
        sum
    }
}
