//! Small bodies with one contact, on the solver's own oscillators and contact scheme.

use nalgebra::Complex;
use opshock_solver::complementarity::{
    ContactMemory, Gap, ImpactLaw, ImpulseKind, StepReport, UnilateralSystem, advance,
};
use opshock_solver::modal::{Flow, ForcedResponse, Oscillator, Phase};

/// A body of modes under constant modal forces, with one contact g = clearance + Σ shape x.
#[derive(Clone, Debug)]
pub struct Body {
    /// Modes of unit mass.
    pub oscillators: Vec<Oscillator>,
    /// Shape of the contact point.
    pub shape: Vec<f64>,
    /// Constant modal forces.
    pub force: Vec<f64>,
    /// Gap at rest, m.
    pub clearance_m: f64,
    /// Displacements.
    pub x: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Impulses so far: (time, impulse, kind, closing speed).
    pub impulses: Vec<(f64, f64, ImpulseKind, f64)>,
    /// Now, s.
    pub time_s: f64,
    memory: ContactMemory,
    reach_s: f64,
    flows: Vec<Flow>,
    ahead: (Vec<f64>, Vec<f64>),
}

impl Body {
    /// A body at rest.
    pub fn new(
        oscillators: Vec<Oscillator>,
        shape: Vec<f64>,
        force: Vec<f64>,
        clearance_m: f64,
    ) -> Self {
        let n = oscillators.len();
        Self {
            oscillators,
            shape,
            force,
            clearance_m,
            x: vec![0.0; n],
            v: vec![0.0; n],
            impulses: Vec::new(),
            time_s: 0.0,
            memory: ContactMemory::default(),
            reach_s: 0.0,
            flows: Vec::new(),
            ahead: (vec![0.0; n], vec![0.0; n]),
        }
    }

    /// A point mass or mass on a spring.
    pub fn point(mass_kg: f64, omega_rad_per_s: f64, force_n: f64, clearance_m: f64) -> Self {
        let root = mass_kg.sqrt();
        Self::new(
            vec![Oscillator::fixed(omega_rad_per_s, 0.0)],
            vec![1.0 / root],
            vec![force_n / root],
            clearance_m,
        )
    }

    /// Gap and rate of a state.
    fn gap_of(&self, x: &[f64], v: &[f64]) -> Gap {
        let read = |z: &[f64]| self.shape.iter().zip(z).map(|(b, z)| b * z).sum::<f64>();
        Gap {
            value_m: self.clearance_m + read(x),
            rate_m_per_s: read(v),
        }
    }

    /// One step of the production scheme.
    pub fn advance(&mut self, step_s: f64, law: &ImpactLaw) -> StepReport {
        let mut memory = self.memory;
        let report = advance(self, step_s, law, &mut memory);
        self.memory = memory;
        report
    }

    /// Gap now, m.
    pub fn gap_m(&self) -> f64 {
        self.gap_of(&self.x, &self.v).value_m
    }

    /// Kinetic, elastic and potential energy, J.
    pub fn energy_j(&self) -> f64 {
        (0..self.x.len())
            .map(|j| {
                let spring = self.oscillators[j].omega_rad_per_s * self.x[j];
                0.5 * (self.v[j].powi(2) + spring * spring) - self.force[j] * self.x[j]
            })
            .sum()
    }
}

impl UnilateralSystem for Body {
    fn gaps(&self) -> [Gap; 2] {
        [self.gap_of(&self.x, &self.v), Gap::default()]
    }

    fn n_contacts(&self) -> usize {
        1
    }

    fn look_ahead(&mut self, h_s: f64) {
        self.reach_s = h_s;
        self.flows = self.oscillators.iter().map(|o| o.flow(h_s)).collect();
        let constant = Phase {
            constant: 1.0,
            ..Phase::default()
        };
        for j in 0..self.x.len() {
            let f = &self.flows[j];
            let (dx, dv) = ForcedResponse::new(&self.oscillators[j], Complex::from(0.0), h_s)
                .increments(&constant);
            let (x, v) = (self.x[j], self.v[j]);
            self.ahead.0[j] = x + (f.qq.re * x + f.qr.re * v) + self.force[j] * dx;
            self.ahead.1[j] = v + (f.rq.re * x + f.rr.re * v) + self.force[j] * dv;
        }
    }

    fn gaps_ahead(&self) -> [Gap; 2] {
        [self.gap_of(&self.ahead.0, &self.ahead.1), Gap::default()]
    }

    fn mobility(&self) -> [[f64; 2]; 2] {
        let w = self.shape.iter().map(|b| b * b).sum();
        [[w, 0.0], [0.0, 0.0]]
    }

    fn compliance_ahead(&self) -> [[f64; 2]; 2] {
        let pairs = self.shape.iter().zip(&self.flows);
        [[pairs.map(|(b, f)| b * b * f.qr.re).sum(), 0.0], [0.0, 0.0]]
    }

    fn longest_aim_s(&self) -> f64 {
        let fastest = self.oscillators.iter().map(|o| o.omega_rad_per_s);
        std::f64::consts::PI / fastest.fold(0.0, f64::max)
    }

    fn impulse(&mut self, impulse_n_s: [f64; 2], kind: ImpulseKind) {
        let p = impulse_n_s[0];
        self.impulses
            .push((self.time_s, p, kind, -self.gaps()[0].rate_m_per_s));
        for j in 0..self.x.len() {
            let kick = p * self.shape[j];
            self.v[j] += kick;
            self.ahead.0[j] += kick * self.flows[j].qr.re;
            self.ahead.1[j] += kick + kick * self.flows[j].rr.re;
        }
    }

    fn commit(&mut self) {
        self.x.copy_from_slice(&self.ahead.0);
        self.v.copy_from_slice(&self.ahead.1);
        self.time_s += self.reach_s;
    }
}
