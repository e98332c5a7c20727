//! Energies of the rotor (harmonics coupled with hub or base), and the work, losses and support impulses on it.

use super::part::Part;
use super::state::{RotorScratch, RotorState};
use super::whole::Rotor;
use crate::modal::oscillator::GAUSS_8;
use crate::modal::{Coordinates, CoupledState, Phase};
use crate::structure::energy::Energies;
use crate::structure::sample::Exchange;
use nalgebra::Complex;

impl Rotor {
    /// Energy lost at the mean of two states over `h_s`, and work of a constant load per unit a(t).
    pub fn midpoint_exchange(
        &self,
        before: &RotorState,
        after: &RotorState,
        h_s: f64,
        force: f64,
        scratch: &mut RotorScratch,
    ) -> Exchange {
        let RotorScratch {
            coordinates, point, ..
        } = scratch;
        point.reset();
        point.add(before, 0.5);
        point.add(after, 0.5);
        let mut total = Exchange::default();
        self.add_exchange(point, h_s, 0.0, coordinates, &mut total);
        for (part, (before, after)) in self.parts.iter().zip(before.parts.iter().zip(&after.parts))
        {
            if let Some(drive) = &part.drive {
                let at = |s: &CoupledState| drive.power.position.read(&s.re, &s.im);
                total.work += force * (at(after) - at(before));
            }
        }
        total
    }

    /// Energies of a total state.
    pub fn energies(&self, state: &RotorState, scratch: &mut RotorScratch) -> Energies {
        let mut sum = Energies::default();
        for (i, (part, state)) in self.pairs(state).enumerate() {
            let at = &mut scratch.coordinates[i];
            part.modes.read(state, at);
            let one = part.energies(at);
            sum.kinetic += one.kinetic;
            sum.elastic += one.elastic;
            sum.fixed_frame += one.fixed_frame;
        }
        sum
    }

    /// Impulses of the supports of hub and base over a whole step of free motion, N s.
    fn step_support_n_s(&self, state: &RotorState) -> [f64; 2] {
        let (part, state) = (&self.parts[0], &state.parts[0]);
        let bodies = part.bodies.each_ref();
        bodies.map(|body| {
            let row = body.as_ref().map(|body| &body.support_step);
            row.map_or(0.0, |row| row.read(&state.re, &state.im))
        })
    }

    /// Energy lost over a whole step of free motion.
    pub fn step_loss(&self, state: &RotorState) -> f64 {
        let loss = |(p, s): (&Part, &CoupledState)| s.form(&p.loss);
        self.pairs(state).map(loss).sum()
    }

    /// Work, loss and impulses of the supports over a whole step after the pulse.
    pub fn free_exchange(&self, state: &RotorState) -> Exchange {
        let running = self.pairs(state).filter_map(|(part, state)| {
            let load = part.drive.as_ref()?.running.as_ref()?;
            Some(state.re[load.at] * load.step.read(&state.re, &state.im))
        });
        Exchange {
            work: running.sum(),
            loss: self.step_loss(state),
            support_n_s: self.step_support_n_s(state),
        }
    }

    /// The same over a whole step within a stretch of the pulse.
    pub fn step_exchange(
        &self,
        state: &RotorState,
        (sigma_per_s, phase): (Complex<f64>, &Phase),
        amplitude: f64,
        scratch: &mut RotorScratch,
    ) -> Exchange {
        let RotorScratch {
            coordinates, point, ..
        } = scratch;
        let mut total = Exchange::default();
        for (leap, (_, weight)) in self.quadrature.iter().zip(GAUSS_8) {
            self.carry(leap, Some((phase, amplitude)), state, point);
            let force = amplitude * phase.later(sigma_per_s, leap.h_s).value();
            self.add_exchange(
                point,
                weight * self.step.h_s,
                force,
                coordinates,
                &mut total,
            );
        }
        total
    }

    /// The same over `h_s` of one closed form for the state in `scratch.walk`, which is advanced. Nothing is tabulated.
    pub fn piece_exchange(
        &self,
        h_s: f64,
        forcing: Option<(Complex<f64>, &Phase)>,
        amplitude: f64,
        scratch: &mut RotorScratch,
    ) -> Exchange {
        let mut total = Exchange::default();
        let RotorScratch {
            leap,
            coordinates,
            point,
            walk: state,
            ..
        } = scratch;
        let load = forcing.map(|(_, phase)| (phase, amplitude));
        for (x, weight) in GAUSS_8 {
            self.set_leap(x * h_s, forcing.map(|(sigma, _)| sigma), leap);
            self.carry(leap, load, state, point);
            let force = forcing.map_or(0.0, |(sigma, phase)| {
                amplitude * phase.later(sigma, x * h_s).value()
            });
            self.add_exchange(point, weight * h_s, force, coordinates, &mut total);
        }
        self.set_leap(h_s, forcing.map(|(sigma, _)| sigma), leap);
        self.carry(leap, load, state, point);
        state.copy_from(point);
        total
    }

    fn add_exchange(
        &self,
        state: &RotorState,
        weight_s: f64,
        force: f64,
        coordinates: &mut [Coordinates],
        total: &mut Exchange,
    ) {
        for ((part, state), at) in self.pairs(state).zip(coordinates) {
            part.modes.read(state, at);
            total.loss += weight_s * part.modes.system().loss_rate(at);
            if let Some(drive) = &part.drive {
                let velocity = drive.power.velocity.read(&state.re, &state.im);
                total.work += weight_s * force * velocity;
                if let Some(load) = &drive.running {
                    let velocity = load.power.velocity.read(&state.re, &state.im);
                    total.work += weight_s * state.re[load.at] * velocity;
                }
            }
        }
        for (part, state) in self.pairs(state) {
            for (sum, body) in total.support_n_s.iter_mut().zip(&part.bodies) {
                if let Some(body) = body.as_ref().filter(|_| part.nodal_diameters == 0) {
                    *sum += weight_s * body.support.read(&state.re, &state.im);
                }
            }
        }
    }
}
