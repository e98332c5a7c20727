//! Advances the modes driven by the shock in columns of eight: their step, points, energy and loss.
//!
//! Columns are padded with modes at rest that touch nothing. Loops then run on whole chunks, and every sum has one
//! order whatever the registers.

use super::forced_modes::{ForcedModes, POINTS};
use crate::lanes::{Kernel, SUMS, total, widest};
use crate::modal::{ForcedResponse, Phase};
use nalgebra::Complex;

/// Eight modes over one grid step.
#[derive(Clone, Debug, Default)]
struct Eight {
    /// Flow minus the identity: x from x and v, v from x and v.
    flow: [[f64; SUMS]; 4],
    /// Loss by damping over the step: weights of x², v² and x v.
    loss: [[f64; SUMS]; 3],
    /// Response to the four parts of a [`Phase`].
    displacement: [[f64; SUMS]; 4],
    velocity: [[f64; SUMS]; 4],
    omega: [f64; SUMS],
    /// 2γ, 1/s.
    damping: [f64; SUMS],
    gain: [f64; SUMS],
}

/// Velocity of eight modes at one instant within the step, from the state at its start.
#[derive(Clone, Debug, Default)]
struct Within {
    from_x: [f64; SUMS],
    from_v: [f64; SUMS],
    /// Response to the four parts of a [`Phase`].
    forced: [[f64; SUMS]; 4],
}

struct Instant {
    tau_s: f64,
    weight_s: f64,
    /// Factor of the wave since the start of the step.
    turn: Complex<f64>,
    within: Vec<Within>,
}

/// Forced modes over one grid step.
pub(super) struct ForcedColumns {
    eights: Vec<Eight>,
    /// Shapes at the points that are read, by mode.
    points: Vec<[f64; POINTS]>,
    /// Gauss points of the step, for work and loss under the pulse.
    instants: Vec<Instant>,
}

/// Most instants of a quadrature.
const MOST_INSTANTS: usize = 8;

impl ForcedColumns {
    /// Tables of `modes` with their `points` over `step_s`, for a pulse of rate `sigma_per_s`; `rule` is the quadrature
    /// of the step.
    pub fn new(
        modes: &ForcedModes,
        points: Vec<[f64; POINTS]>,
        sigma_per_s: Complex<f64>,
        step_s: f64,
        rule: &[(f64, f64)],
    ) -> Self {
        let n = modes.oscillators.len();
        let mut eights = vec![Eight::default(); n.div_ceil(SUMS)];
        for (j, o) in modes.oscillators.iter().enumerate() {
            let (eight, k) = (&mut eights[j / SUMS], j % SUMS);
            let (flow, loss) = (o.flow(step_s), o.loss_form(step_s));
            let flow = [flow.qq.re, flow.qr.re, flow.rq.re, flow.rr.re];
            set(&mut eight.flow, k, flow);
            set(&mut eight.loss, k, [loss.qq, loss.rr, 2.0 * loss.qr.re]);
            let response = ForcedResponse::new(o, sigma_per_s, step_s);
            set(&mut eight.displacement, k, response.displacement);
            set(&mut eight.velocity, k, response.velocity);
            eight.omega[k] = o.omega_rad_per_s;
            eight.damping[k] = 2.0 * o.half_damping_per_s;
            eight.gain[k] = modes.participation[j];
        }
        let instants = rule.iter().map(|&(x, weight)| {
            let tau_s = x * step_s;
            let mut within = vec![Within::default(); eights.len()];
            for (j, o) in modes.oscillators.iter().enumerate() {
                let (within, k) = (&mut within[j / SUMS], j % SUMS);
                let flow = o.flow(tau_s);
                (within.from_x[k], within.from_v[k]) = (flow.rq.re, flow.rr.re);
                let response = ForcedResponse::new(o, sigma_per_s, tau_s);
                set(&mut within.forced, k, response.velocity);
            }
            Instant {
                tau_s,
                weight_s: weight * step_s,
                turn: (sigma_per_s * tau_s).exp(),
                within,
            }
        });
        Self {
            instants: instants.collect(),
            points,
            eights,
        }
    }

    /// Displacements and velocities of the points for states `x`, `v`: Σ shape × x and Σ shape × v.
    pub fn read(&self, x: &[f64], v: &[f64]) -> [[f64; POINTS]; 2] {
        let points = &self.points;
        widest(Read { points, x, v })
    }

    /// (kinetic, elastic) energy, J.
    pub fn energy(&self, x: &[f64], v: &[f64]) -> [f64; 2] {
        let eights = &self.eights;
        widest(Energy { eights, x, v }).map(total)
    }

    /// Loss over a step without load, J.
    pub fn free_loss(&self, x: &[f64], v: &[f64]) -> f64 {
        let eights = &self.eights;
        total(widest(FreeLoss { eights, x, v }))
    }

    /// [`Self::energy`] of a state, [`Self::free_loss`] over the step without load and the step itself, in one pass
    /// with the same bits.
    pub fn balance_and_advance(&self, x: &mut [f64], v: &mut [f64]) -> ([f64; 2], f64) {
        let eights = &self.eights;
        let [kinetic, elastic, loss] = widest(BalanceAndAdvance { eights, x, v }).map(total);
        ([kinetic, elastic], loss)
    }

    /// A step without load.
    pub fn carry(&self, x: &mut [f64], v: &mut [f64]) {
        let eights = &self.eights;
        widest(Carry { eights, x, v });
    }

    /// A step under `phase`.
    pub fn drive(&self, phase: &Phase, x: &mut [f64], v: &mut [f64]) {
        let (eights, parts) = (&self.eights, phase.parts());
        widest(Drive {
            eights,
            parts,
            x,
            v,
        });
    }

    /// Work of the load `amplitude` times `phase` over a step, and loss meanwhile, from the state at its start, J.
    pub fn exchange(&self, amplitude: f64, phase: &Phase, x: &[f64], v: &[f64]) -> [f64; 2] {
        let mut weights = [[0.0; 2]; MOST_INSTANTS];
        for (weights, instant) in weights.iter_mut().zip(&self.instants) {
            let force = amplitude * phase.turned(instant.tau_s, instant.turn).value();
            *weights = [instant.weight_s * force, instant.weight_s];
        }
        widest(ExchangeWithin {
            eights: &self.eights,
            instants: &self.instants,
            weights,
            amplitude,
            parts: phase.parts(),
            x,
            v,
        })
        .map(total)
    }
}

fn set<const N: usize>(columns: &mut [[f64; SUMS]; N], k: usize, values: [f64; N]) {
    for (column, value) in columns.iter_mut().zip(values) {
        column[k] = value;
    }
}

/// The modes of `eights` with their states, eight by eight.
#[inline(always)]
fn with_states<'a>(
    eights: &'a [Eight],
    x: &'a [f64],
    v: &'a [f64],
) -> impl Iterator<Item = (&'a Eight, &'a [f64; SUMS], &'a [f64; SUMS])> {
    let states = x.as_chunks().0.iter().zip(v.as_chunks().0);
    eights
        .iter()
        .zip(states)
        .map(|(eight, (x, v))| (eight, x, v))
}

/// The same with mutable states.
#[inline(always)]
fn with_states_mut<'a>(
    eights: &'a [Eight],
    x: &'a mut [f64],
    v: &'a mut [f64],
) -> impl Iterator<Item = (&'a Eight, &'a mut [f64; SUMS], &'a mut [f64; SUMS])> {
    let states = x.as_chunks_mut().0.iter_mut().zip(v.as_chunks_mut().0);
    eights
        .iter()
        .zip(states)
        .map(|(eight, (x, v))| (eight, x, v))
}

struct Read<'a> {
    points: &'a [[f64; POINTS]],
    x: &'a [f64],
    v: &'a [f64],
}

impl Kernel for Read<'_> {
    type Output = [[f64; POINTS]; 2];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (mut x, mut v) = ([0.0; POINTS], [0.0; POINTS]);
        for ((shape, q), r) in self.points.iter().zip(self.x).zip(self.v) {
            for k in 0..POINTS {
                x[k] = shape[k].mul_add(*q, x[k]);
                v[k] = shape[k].mul_add(*r, v[k]);
            }
        }
        [x, v]
    }
}

struct Energy<'a> {
    eights: &'a [Eight],
    x: &'a [f64],
    v: &'a [f64],
}

impl Kernel for Energy<'_> {
    type Output = [[f64; SUMS]; 2];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (mut kinetic, mut elastic) = ([0.0; SUMS], [0.0; SUMS]);
        for (eight, x, v) in with_states(self.eights, self.x, self.v) {
            add_energy(eight, x, v, [&mut kinetic, &mut elastic]);
        }
        [kinetic, elastic]
    }
}

struct FreeLoss<'a> {
    eights: &'a [Eight],
    x: &'a [f64],
    v: &'a [f64],
}

impl Kernel for FreeLoss<'_> {
    type Output = [f64; SUMS];

    #[inline(always)]
    fn call(self) -> [f64; SUMS] {
        let mut loss = [0.0; SUMS];
        for (eight, x, v) in with_states(self.eights, self.x, self.v) {
            add_free_loss(eight, x, v, &mut loss);
        }
        loss
    }
}

struct BalanceAndAdvance<'a> {
    eights: &'a [Eight],
    x: &'a mut [f64],
    v: &'a mut [f64],
}

impl Kernel for BalanceAndAdvance<'_> {
    /// Kinetic and elastic energy, and loss.
    type Output = [[f64; SUMS]; 3];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (mut kinetic, mut elastic, mut loss) = ([0.0; SUMS], [0.0; SUMS], [0.0; SUMS]);
        for (eight, x, v) in with_states_mut(self.eights, self.x, self.v) {
            add_energy(eight, x, v, [&mut kinetic, &mut elastic]);
            add_free_loss(eight, x, v, &mut loss);
            carry(&eight.flow, x, v);
        }
        [kinetic, elastic, loss]
    }
}

struct Carry<'a> {
    eights: &'a [Eight],
    x: &'a mut [f64],
    v: &'a mut [f64],
}

impl Kernel for Carry<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (eight, x, v) in with_states_mut(self.eights, self.x, self.v) {
            carry(&eight.flow, x, v);
        }
    }
}

struct Drive<'a> {
    eights: &'a [Eight],
    parts: [f64; 4],
    x: &'a mut [f64],
    v: &'a mut [f64],
}

impl Kernel for Drive<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (eight, x, v) in with_states_mut(self.eights, self.x, self.v) {
            carry(&eight.flow, x, v);
            let by_x = respond(&eight.displacement, &self.parts);
            let by_v = respond(&eight.velocity, &self.parts);
            let (mut to, mut to_v) = (*x, *v);
            for k in 0..SUMS {
                to[k] = eight.gain[k].mul_add(by_x[k], to[k]);
                to_v[k] = eight.gain[k].mul_add(by_v[k], to_v[k]);
            }
            (*x, *v) = (to, to_v);
        }
    }
}

struct ExchangeWithin<'a> {
    eights: &'a [Eight],
    instants: &'a [Instant],
    /// Of power per unit load and of loss, at every instant.
    weights: [[f64; 2]; MOST_INSTANTS],
    amplitude: f64,
    parts: [f64; 4],
    x: &'a [f64],
    v: &'a [f64],
}

impl Kernel for ExchangeWithin<'_> {
    /// Work and loss.
    type Output = [[f64; SUMS]; 2];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (mut work, mut loss) = ([0.0; SUMS], [0.0; SUMS]);
        let states = with_states(self.eights, self.x, self.v);
        for (i, (eight, x, v)) in states.enumerate() {
            let (mut power, mut taken) = ([0.0; SUMS], [0.0; SUMS]);
            for (instant, [by_power, by_loss]) in self.instants.iter().zip(self.weights) {
                let within = &instant.within[i];
                let by = respond(&within.forced, &self.parts);
                for k in 0..SUMS {
                    let free = v[k] + within.from_x[k].mul_add(x[k], within.from_v[k] * v[k]);
                    let rate = (self.amplitude * eight.gain[k]).mul_add(by[k], free);
                    power[k] = by_power.mul_add(rate, power[k]);
                    taken[k] = (by_loss * rate).mul_add(rate, taken[k]);
                }
            }
            for k in 0..SUMS {
                work[k] = eight.gain[k].mul_add(power[k], work[k]);
                loss[k] = eight.damping[k].mul_add(taken[k], loss[k]);
            }
        }
        [work, loss]
    }
}

/// Adds kinetic and elastic energy of eight modes.
#[inline(always)]
fn add_energy(
    eight: &Eight,
    x: &[f64; SUMS],
    v: &[f64; SUMS],
    [kinetic, elastic]: [&mut [f64; SUMS]; 2],
) {
    for k in 0..SUMS {
        let spring = eight.omega[k] * x[k];
        kinetic[k] = (0.5 * v[k]).mul_add(v[k], kinetic[k]);
        elastic[k] = (0.5 * spring).mul_add(spring, elastic[k]);
    }
}

/// Adds the loss of eight modes over a step without load.
#[inline(always)]
fn add_free_loss(eight: &Eight, x: &[f64; SUMS], v: &[f64; SUMS], loss: &mut [f64; SUMS]) {
    let [xx, vv, xv] = &eight.loss;
    for k in 0..SUMS {
        let by_x = xx[k].mul_add(x[k], xv[k] * v[k]);
        loss[k] += x[k].mul_add(by_x, vv[k] * v[k] * v[k]);
    }
}

#[inline(always)]
fn carry(flow: &[[f64; SUMS]; 4], x: &mut [f64; SUMS], v: &mut [f64; SUMS]) {
    let [xx, xv, vx, vv] = flow;
    // Copies: as far as the compiler knows, stores into `x` could change `flow`.
    let (mut to, mut to_v) = (*x, *v);
    for k in 0..SUMS {
        to[k] += xx[k].mul_add(x[k], xv[k] * v[k]);
        to_v[k] += vx[k].mul_add(x[k], vv[k] * v[k]);
    }
    (*x, *v) = (to, to_v);
}

/// Responses to the four parts of a load.
#[inline(always)]
fn respond(response: &[[f64; SUMS]; 4], parts: &[f64; 4]) -> [f64; SUMS] {
    let [a, b, c, d] = response;
    let mut out = [0.0; SUMS];
    for k in 0..SUMS {
        let first = a[k].mul_add(parts[0], b[k] * parts[1]);
        out[k] = c[k].mul_add(parts[2], d[k].mul_add(parts[3], first));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::Oscillator;

    #[test]
    fn balanced_and_carried_in_one_pass_are_the_bits_of_three() {
        // Eleven modes, so that the second eight is padded.
        let oscillators: Vec<_> = (1..=11)
            .map(|k| Oscillator::fixed(4.0e3 * f64::from(k * k), 1e-3 * f64::from(k)))
            .collect();
        let modes = ForcedModes {
            participation: vec![0.1; oscillators.len()],
            oscillators,
        };
        let points = vec![[0.0; POINTS]; 11];
        let sigma = Complex::new(0.0, 6.0e3);
        let columns = ForcedColumns::new(&modes, points, sigma, 2.5e-7, &[(0.5, 1.0)]);
        let at = |seed: f64| -> Vec<f64> {
            let mode = |k: u32| {
                if k < 11 {
                    (seed + f64::from(k)).sin()
                } else {
                    0.0
                }
            };
            (0..16).map(mode).collect()
        };
        let (mut x, mut v) = (at(0.3), at(1.7));
        let apart = (columns.energy(&x, &v), columns.free_loss(&x, &v));
        assert!(apart.0[0] > 0.0 && apart.0[1] > 0.0 && apart.1 > 0.0);
        let (mut x_apart, mut v_apart) = (x.clone(), v.clone());
        columns.carry(&mut x_apart, &mut v_apart);
        assert_eq!(columns.balance_and_advance(&mut x, &mut v), apart);
        assert_eq!((x, v), (x_apart, v_apart));
    }
}
