//! Loads of the unit pulse on the rotor (harmonics coupled with hub or base): axial, and the tilts of an oblique shock.

use super::places::Places;
use crate::disk::HubParameters;
use crate::modal::oscillator::phi1;
use crate::modal::{CoupledModes, CoupledState, PointReadout, Readout};
use crate::shock::ObliqueShock;
use nalgebra::Complex;
use std::f64::consts::PI;

/// How the unit pulse drives a part.
pub(in crate::structure) struct Drive {
    pub entrance: CoupledState,
    /// Velocity along the load: power per load.
    pub power: PointReadout,
    /// Gyroscopic load of a base that has started to turn.
    pub running: Option<Running>,
}

/// A load proportional to u = ∫ a dt.
pub(in crate::structure) struct Running {
    /// Index of the mode that holds u.
    pub at: usize,
    pub power: PointReadout,
    /// Row that reads the change of the displacement along the load over a whole step of free motion.
    pub step: Readout,
}

impl Drive {
    /// The load of every coordinate per inertia load along the axis.
    pub fn along_axis(modes: &CoupledModes, load: &[f64]) -> Self {
        let load: Vec<Complex<f64>> = load.iter().map(|x| Complex::from(*x)).collect();
        Self {
            entrance: modes.entrance(&load),
            power: modes.readout(&load),
            running: None,
        }
    }

    pub fn add(&self, k: usize, response: Complex<f64>, state: &mut CoupledState) {
        let eta = Complex::new(self.entrance.re[k], self.entrance.im[k]) * response;
        state.re[k] += eta.re;
        state.im[k] += eta.im;
    }
}

/// Loads of an oblique shock on the tilts, per unit a(t) and per unit of its integral.
pub(super) struct TiltLoad {
    direct: Vec<Complex<f64>>,
    running: Vec<Complex<f64>>,
    /// Entrance of the running load into the modes, and the index of the mode that holds the integral.
    held: Option<(CoupledState, usize)>,
}

impl TiltLoad {
    /// Adds the loads of `shock`; a turning base adds the mode of its angular velocity to `modes`.
    ///
    /// With the base's tilt β, felt as B a(t) = −β̈, the rotor's inertia loads the coordinates by
    /// M e B a + i Ω (2 M_d + I_p) e B ∫ a dt, e its rigid tilt; in-plane loads d act on its mass at
    /// the height h of its centre: m h (−d_x + i d_y).
    pub fn add(
        shock: &ObliqueShock,
        hub: &HubParameters,
        place: &Places<'_>,
        modes: &mut CoupledModes,
    ) -> Self {
        let disk = place.disk;
        let (a2, b2) = (disk.inner_radius_m.powi(2), disk.outer_radius_m.powi(2));
        let mass = hub.mass_kg + PI * disk.density_kg_per_m3 * disk.thickness_m * (b2 - a2);
        let i = Complex::new(0.0, 1.0);
        // Coordinates are measured from the ramp.
        let turn = (i * place.ramp_angle_rad).exp();
        let [about_x, about_y] = shock.rotation_per_m;
        let felt = turn * Complex::new(-about_y, -about_x);
        let [x, y] = shock.in_plane;
        let system = modes.system();
        let of_row = |row: &[f64]| -> Vec<Complex<f64>> { row.iter().map(|m| felt * *m).collect() };
        let mut direct = of_row(system.mass.row(0));
        direct[0] += turn * Complex::new(-x, y) * (mass * hub.centre_height_m);
        // The gyroscopic matrix without the part of the bearing.
        let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
        let mut running: Vec<Complex<f64>> = of_row(system.gyroscopic.row(0))
            .iter()
            .map(|g| i * g)
            .collect();
        running[0] -= i * felt * (sense * hub.cross_damping_n_m_s_per_rad);
        let is_turning = felt != Complex::from(0.0) && disk.spin_rad_per_s != 0.0;
        let held = is_turning.then(|| modes.add_running_load(&running));
        Self {
            direct,
            running,
            held,
        }
    }

    pub fn drive(&self, modes: &CoupledModes, step_s: f64) -> Drive {
        // A load b has the power Re(bᴴ q̇).
        let dual = |b: &[Complex<f64>]| -> PointReadout {
            let weights: Vec<Complex<f64>> = b.iter().map(|z| z.conj()).collect();
            modes.readout(&weights)
        };
        let mut entrance = modes.entrance(&self.direct);
        let running = self.held.as_ref().map(|(held, at)| {
            entrance.add(held, 1.0);
            let power = dual(&self.running);
            let mut step = power.position.clone();
            for (k, s) in modes.rates_per_s().iter().enumerate() {
                let z = s * step_s;
                let weight = Complex::new(step.re[k], -step.im[k]) * (phi1(z) * z);
                (step.re[k], step.im[k]) = (weight.re, -weight.im);
            }
            Running {
                at: *at,
                power,
                step,
            }
        });
        Drive {
            entrance,
            power: dual(&self.direct),
            running,
        }
    }
}
