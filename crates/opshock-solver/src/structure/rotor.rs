//! The disk's harmonics n = 0 and n = 1 on a hub that moves ([`crate::disk::hub`]).
//!
//! Coordinates are the hub's motion and the modes of the disk clamped to it (Craig and Bampton): the
//! disk moves by w = u + Σ φ q for n = 0 and by r ϑ + Σ φ q for n = 1. In the space-fixed frame, with
//! m and J the disk's mass and moment of inertia about a diameter and L = ∫ ρ h φ · (1 or r) dA,
//!
//! ```text
//! M_d = [m or J, Lᵀ; L, 1],    M = M_d + (m or I of the hub at the hub's coordinate)
//! D = c_bearing + 2 γ of the disk's modes + c M_d + i Ω (2 n M_d + I_p of the hub)
//! K = k_bearing + ω² − n² Ω² + i 2 γ n Ω of the disk's modes
//! ```
//!
//! A rigid motion of the disk meets no stiffness but that of the bearing: the membrane's stress and the
//! turning cancel, since the clamp's pull on the disk turns with the hub. Material damping is that of
//! the clamped modes, on the motion relative to the hub. A stiff bearing gives the clamped disk, with
//! the same modes. Static corrections and harmonics n ≥ 2 do not move a hub and stay oscillators.

use std::f64::consts::PI;

use super::StructureError;
use super::energy::Energies;
use super::free_motion::{Exchange, HubSample, Motion, Sample};
use super::model::{SliderPlace, StructureParameters};
use crate::complementarity::Gap;
use crate::complementarity::moreau_jean::{FirstOrderModes, MoreauJean};
use crate::disk::{DiskBasis, DiskError, DiskMode, DiskParameters, DiskPose, HubParameters};
use crate::linalg::SquareMatrix;
use crate::modal::oscillator::{GAUSS_8, phi1};
use crate::modal::{
    Coordinates, CoupledFlow, CoupledModes, CoupledState, CoupledSystem, FirstOrderResponse,
    Oscillator, Phase, PointReadout, Readout,
};
use crate::shock::{ObliqueShock, Stretch};
use nalgebra::Complex;

/// Largest |s| Δt of a mode: faster ones are a bearing too stiff for the step to see, which then is a
/// clamp. Left in, an impact would find the hub's mass where its stiffness belongs.
const FASTEST_ANGLE: f64 = PI;

/// One harmonic with the hub.
pub(super) struct Part {
    nodal_diameters: usize,
    pub modes: CoupledModes,
    /// M_d, and Ω of the disk: what the material's energy adds.
    disk_mass: SquareMatrix,
    spin_rad_per_s: f64,
    /// Disk at the ramp's contact points.
    pub contact: PointReadout,
    /// w_θ there.
    contact_turn: Readout,
    /// What an impulse there puts into the modes.
    pub contact_entrance: CoupledState,
    rim: PointReadout,
    /// Displacement, pitch and roll of the disk under the slider.
    slider: [PointReadout; 3],
    /// Hub: displacement, or tilt about two axes.
    hub: [PointReadout; 2],
    /// Momentum of the part along the hub's coordinate.
    momentum: PointReadout,
    /// Force of bearing and still air on it, by n = 0.
    bearing: Readout,
    /// Its impulse over a whole step of free motion.
    bearing_step: Readout,
    /// What the unit pulse puts into the modes, when it drives this part.
    pub drive: Option<Drive>,
    loss: SquareMatrix,
    ripple_loss: f64,
}

/// How the unit pulse drives a part.
pub(super) struct Drive {
    pub entrance: CoupledState,
    /// Velocity along the load: power per load.
    pub power: PointReadout,
    /// Inertia load of the whole rotor per unit a(t).
    pub load: f64,
    /// Gyroscopic load of a base that has begun to turn.
    running: Option<Running>,
}

/// A load in proportion to u = ∫ a dt.
struct Running {
    /// Mode that holds u.
    at: usize,
    power: PointReadout,
    /// What reads the change of the displacement along the load over a whole step of free motion.
    step: Readout,
}

/// Both harmonics on the hub; n = 1 only where something may drive it.
pub(super) struct Rotor {
    pub parts: Vec<Part>,
    /// A whole step.
    pub step: Leap,
    /// Gauss' rule within a whole step.
    quadrature: Vec<Leap>,
}

/// Flow of every mode over one time, and its response to the pulse's wave.
#[derive(Clone, Debug, Default)]
pub(super) struct Leap {
    h_s: f64,
    flows: Vec<CoupledFlow>,
    responses: Vec<Vec<FirstOrderResponse>>,
}

/// Amplitudes of the modes of every part.
#[derive(Clone, Debug, Default)]
pub(super) struct RotorState {
    pub parts: Vec<CoupledState>,
}

/// Room for what is computed on the way.
#[derive(Clone, Debug, Default)]
pub(super) struct RotorScratch {
    leap: Leap,
    coordinates: Vec<Coordinates>,
    start: RotorState,
    point: RotorState,
    /// State of which work and loss are asked for.
    pub walk: RotorState,
}

impl Rotor {
    /// The rotor of `disk`'s hub; `None` without one. `basis` has shapes at contact, slider and rim.
    ///
    /// # Errors
    /// Modes that cannot be taken apart.
    pub fn build(
        basis: &DiskBasis,
        parameters: &StructureParameters<'_>,
        stretches: &[Stretch],
        step_s: f64,
    ) -> Result<Option<Self>, StructureError> {
        let (disk, ramp) = (parameters.disk, parameters.ramp);
        let Some(hub) = &disk.hub else {
            return Ok(None);
        };
        let place = Places {
            disk,
            slider: parameters.slider,
            ramp_radius_m: ramp.radius_m,
            angle_rad: parameters.slider.angle_rad - ramp.angle_rad,
            ramp_angle_rad: ramp.angle_rad,
            oblique: parameters.oblique,
        };
        let mut parts = Vec::new();
        for n in 0..=1 {
            let carried = |mode: &&DiskMode| mode.nodal_diameters == n && is_carried(mode);
            let modes: Vec<&DiskMode> = basis.modes.iter().filter(carried).collect();
            // Without its harmonic in the basis nothing drives the tilt.
            let is_built = n == 0 || basis.modes.iter().any(|mode| mode.nodal_diameters > 0);
            if is_built {
                parts.push(Part::build(n, hub, &modes, &place, step_s)?);
            }
        }
        let mut rotor = Self {
            parts,
            step: Leap::default(),
            quadrature: Vec::new(),
        };
        // One rate per pulse shape: a half-sine has one stretch, piecewise linear ones have none.
        let sigma = stretches[0].sigma_per_s;
        let leap = |h_s: f64| {
            let mut leap = Leap::default();
            rotor.set_leap(h_s, Some(sigma), &mut leap);
            leap
        };
        let step = leap(step_s);
        let quadrature = GAUSS_8.iter().map(|(x, _)| leap(x * step_s)).collect();
        (rotor.step, rotor.quadrature) = (step, quadrature);
        Ok(Some(rotor))
    }

    /// Tables of `h_s`, with responses to a wave when its rate is given; does not allocate in tables
    /// that were set before.
    pub fn set_leap(&self, h_s: f64, sigma_per_s: Option<Complex<f64>>, leap: &mut Leap) {
        leap.h_s = h_s;
        leap.flows.resize(self.parts.len(), CoupledFlow::default());
        leap.responses.resize(self.parts.len(), Vec::new());
        let tables = leap.flows.iter_mut().zip(&mut leap.responses);
        for (part, (flow, responses)) in self.parts.iter().zip(tables) {
            part.modes.set_flow(h_s, flow);
            let rates = part.modes.rates_per_s();
            responses.resize(rates.len(), FirstOrderResponse::default());
            if let (Some(sigma), Some(_)) = (sigma_per_s, &part.drive) {
                for (response, s) in responses.iter_mut().zip(rates) {
                    *response = FirstOrderResponse::new(*s, sigma, h_s);
                }
            }
        }
    }

    /// `to` := `from` after the leap, under `amplitude` times a forcing that starts at `phase`, if any.
    fn carry(
        &self,
        leap: &Leap,
        forcing: Option<(&Phase, f64)>,
        from: &RotorState,
        to: &mut RotorState,
    ) {
        for (i, part) in self.parts.iter().enumerate() {
            let to = &mut to.parts[i];
            leap.flows[i].apply(&from.parts[i], to);
            if let (Some(drive), Some((phase, amplitude))) = (&part.drive, forcing) {
                for (k, response) in leap.responses[i].iter().enumerate() {
                    drive.add(k, amplitude * response.increment(phase), to);
                }
            }
        }
    }

    /// Whether `state` was made for this rotor.
    pub fn is_of(&self, state: &RotorState) -> bool {
        let lengths = self.parts.iter().map(|p| p.modes.n_columns());
        lengths.eq(state.parts.iter().map(|s| s.re.len()))
    }

    /// Adds the rotor to a reference system of Moreau-Jean steps, with rows of the gaps of both arms.
    pub fn add_to(&self, system: &mut MoreauJean) {
        for part in &self.parts {
            let signed = |sign: f64| -> PointReadout {
                let scaled = |row: &Readout| Readout {
                    re: row.re.iter().map(|x| sign * x).collect(),
                    im: row.im.iter().map(|x| sign * x).collect(),
                };
                PointReadout {
                    position: scaled(&part.contact.position),
                    velocity: scaled(&part.contact.velocity),
                }
            };
            // Top g = g₀ + x − w, bottom g = g₀ − x + w.
            let entrance = |sign: f64| {
                let mut state = part.modes.at_rest();
                state.add(&part.contact_entrance, sign);
                state
            };
            system.add_coupled(FirstOrderModes {
                rates_per_s: part.modes.rates_per_s().to_vec(),
                gaps: [signed(-1.0), signed(1.0)],
                entrances: [entrance(-1.0), entrance(1.0)],
                drive: part.drive.as_ref().map(|drive| drive.entrance.clone()),
                state: part.modes.at_rest(),
            });
        }
    }

    /// Energy lost by the mean of two states over `h_s`, and work of a constant load per unit a(t).
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

    /// All at rest.
    pub fn at_rest(&self) -> RotorState {
        RotorState {
            parts: self.parts.iter().map(|p| p.modes.at_rest()).collect(),
        }
    }

    pub fn scratch(&self) -> RotorScratch {
        RotorScratch {
            leap: self.step.clone(),
            coordinates: self.parts.iter().map(|p| p.modes.coordinates()).collect(),
            start: self.at_rest(),
            point: self.at_rest(),
            walk: self.at_rest(),
        }
    }

    fn pairs<'a>(
        &'a self,
        state: &'a RotorState,
    ) -> impl Iterator<Item = (&'a Part, &'a CoupledState)> {
        self.parts.iter().zip(&state.parts)
    }

    /// Modes carried, each pair once.
    pub fn n_modes(&self) -> usize {
        self.parts.iter().map(|p| p.disk_mass.order()).sum()
    }

    /// Whether the unit pulse tilts the hub.
    pub fn is_tilted(&self) -> bool {
        let tilts = |p: &Part| p.nodal_diameters > 0 && p.drive.is_some();
        self.parts.iter().any(tilts)
    }

    /// Modes that the unit pulse drives.
    pub fn n_driven(&self) -> usize {
        let driven = self.parts.iter().filter(|p| p.drive.is_some());
        driven.map(|p| p.disk_mass.order()).sum()
    }

    /// Displacement of the disk at the contact points, and its rate.
    pub fn contact(&self, state: &RotorState) -> Gap {
        let mut sum = Gap::default();
        for (part, state) in self.pairs(state) {
            let (value, rate) = part.contact.read(state);
            sum.value_m += value;
            sum.rate_m_per_s += rate;
        }
        sum
    }

    /// w_θ at the contact points.
    pub fn contact_turn(&self, state: &RotorState) -> f64 {
        let turn = |(p, s): (&Part, &CoupledState)| p.contact_turn.read(&s.re, &s.im);
        self.pairs(state).map(turn).sum()
    }

    pub fn rim_m(&self, state: &RotorState) -> f64 {
        let rim = |(p, s): (&Part, &CoupledState)| p.rim.position.read(&s.re, &s.im);
        self.pairs(state).map(rim).sum()
    }

    /// Displacement of the disk under the slider.
    pub fn slider_m(&self, state: &RotorState) -> f64 {
        let slider = |(p, s): (&Part, &CoupledState)| p.slider[0].position.read(&s.re, &s.im);
        self.pairs(state).map(slider).sum()
    }

    /// Adds pose and rate of the disk under the slider.
    pub fn add_slider(&self, state: &RotorState, pose: &mut DiskPose, rate: &mut DiskPose) {
        for (part, state) in self.pairs(state) {
            let [w, p, r] = part.slider.each_ref().map(|row| row.read(state));
            pose.displacement_m += w.0;
            pose.pitch_rad += p.0;
            pose.roll_rad += r.0;
            rate.displacement_m += w.1;
            rate.pitch_rad += p.1;
            rate.roll_rad += r.1;
        }
    }

    /// Jump of the rate of the slider's pose per impulse at the contact points.
    pub fn slider_jump(&self) -> DiskPose {
        let mut jump = DiskPose::default();
        let mut none = DiskPose::default();
        let kicked = RotorState {
            parts: self
                .parts
                .iter()
                .map(|p| p.contact_entrance.clone())
                .collect(),
        };
        self.add_slider(&kicked, &mut none, &mut jump);
        jump
    }

    /// The hub, with the impulse of the bearing so far.
    pub fn hub(&self, state: &RotorState, bearing_n_s: f64) -> HubSample {
        let mut sample = HubSample {
            bearing_n_s,
            ..HubSample::default()
        };
        for (part, s) in self.pairs(state) {
            let read = |row: &PointReadout| row.position.read(&s.re, &s.im);
            if part.nodal_diameters == 0 {
                sample.axial_m = read(&part.hub[0]);
                sample.momentum_n_s = part.momentum.velocity.read(&s.re, &s.im);
            } else {
                sample.tilt_rad = [read(&part.hub[0]), read(&part.hub[1])];
            }
        }
        sample
    }

    /// Impulse of the bearing on the rotor over a whole step of free motion, N s.
    pub fn step_bearing_n_s(&self, state: &RotorState) -> f64 {
        let (part, state) = (&self.parts[0], &state.parts[0]);
        part.bearing_step.read(&state.re, &state.im)
    }

    /// Axial force of bearing and still air on the rotor, N.
    fn bearing_n(&self, state: &RotorState) -> f64 {
        let (part, state) = (&self.parts[0], &state.parts[0]);
        part.bearing.read(&state.re, &state.im)
    }

    /// `ahead` := `now` after free motion over the partial leap, or over a whole step.
    pub fn flow(&self, now: &RotorState, partial: Option<&Leap>, ahead: &mut RotorState) {
        self.carry(partial.unwrap_or(&self.step), None, now, ahead);
    }

    /// Carries `state` over a whole step inside a stretch of the pulse, or after it.
    pub fn step(&self, phase: Option<&Phase>, state: &mut RotorState, scratch: &mut RotorScratch) {
        scratch.start.copy_from(state);
        self.carry(&self.step, phase.map(|p| (p, 1.0)), &scratch.start, state);
    }

    /// Carries `state` over `h_s` under `amplitude` times a forcing of one closed form.
    pub fn advance(
        &self,
        h_s: f64,
        forcing: Option<(Complex<f64>, &Phase)>,
        amplitude: f64,
        state: &mut RotorState,
        scratch: &mut RotorScratch,
    ) {
        let RotorScratch { leap, start, .. } = scratch;
        start.copy_from(state);
        self.set_leap(h_s, forcing.map(|(sigma, _)| sigma), leap);
        self.carry(
            leap,
            forcing.map(|(_, phase)| (phase, amplitude)),
            start,
            state,
        );
    }

    /// Displacement of the contact points after the flow per unit impulse there at its start.
    pub fn compliance(&self, partial: Option<&Leap>) -> f64 {
        (0..self.parts.len())
            .map(|i| {
                let part = &self.parts[i];
                let flow = &partial.unwrap_or(&self.step).flows[i];
                flow.compliance(&part.contact_entrance, &part.contact)
            })
            .sum()
    }

    /// Velocity of the contact points per unit impulse there.
    pub fn mobility(&self) -> f64 {
        let jump = |p: &Part| p.contact.read(&p.contact_entrance).1;
        self.parts.iter().map(jump).sum()
    }

    /// An impulse on the disk at the contact points, now and ahead.
    pub fn kick(
        &self,
        impulse: f64,
        partial: Option<&Leap>,
        now: &mut RotorState,
        ahead: &mut RotorState,
    ) {
        for (i, part) in self.parts.iter().enumerate() {
            now.parts[i].add(&part.contact_entrance, impulse);
            let flow = &partial.unwrap_or(&self.step).flows[i];
            flow.add_kick(&part.contact_entrance, impulse, &mut ahead.parts[i]);
        }
    }

    /// Loss of energy per squared impulse in the ripple of equal impulses, one a step: that of the disk's
    /// modes, clamped. The hub is too heavy and too slow for a ripple of its own.
    pub fn ripple_loss(&self) -> f64 {
        self.parts.iter().map(|part| part.ripple_loss).sum()
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

    /// Energy lost over a whole step of free motion.
    pub fn step_loss(&self, state: &RotorState) -> f64 {
        let loss = |(p, s): (&Part, &CoupledState)| s.form(&p.loss);
        self.pairs(state).map(loss).sum()
    }

    /// Work, loss and impulse of the bearing over a whole step after the pulse.
    pub fn free_exchange(&self, state: &RotorState) -> Exchange {
        let running = self.pairs(state).filter_map(|(part, state)| {
            let load = part.drive.as_ref()?.running.as_ref()?;
            Some(state.re[load.at] * load.step.read(&state.re, &state.im))
        });
        Exchange {
            work: running.sum(),
            loss: self.step_loss(state),
            bearing_n_s: self.step_bearing_n_s(state),
        }
    }

    /// The same over a whole step inside a stretch of the pulse.
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

    /// The same over `h_s` of one closed form for the state in `scratch.walk`, which moves along.
    /// Nothing is tabulated.
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
        total.bearing_n_s += weight_s * self.bearing_n(state);
    }

    /// Inertia load of the whole rotor per unit a(t): its mass.
    pub fn load_kg(&self) -> f64 {
        self.parts[0].drive.as_ref().map_or(0.0, |drive| drive.load)
    }

    /// Growth rate of the fastest growing mode with its nodal diameters, if one grows.
    pub fn growth(&self) -> Option<(usize, f64)> {
        let rates = self.parts.iter().flat_map(|part| {
            let rates = part.modes.rates_per_s().iter();
            rates.map(|s| (part.nodal_diameters, s.re))
        });
        rates
            .filter(|(_, growth)| *growth > 0.0)
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Adds the unit response of the points.
    pub fn add_sample(&self, state: &RotorState, sample: &mut Sample) {
        let contact = self.contact(state);
        sample.contact.value += contact.value_m;
        sample.contact.rate += contact.rate_m_per_s;
        let (mut pose, mut rate) = (DiskPose::default(), DiskPose::default());
        self.add_slider(state, &mut pose, &mut rate);
        sample.slider.value += pose.displacement_m;
        sample.slider.rate += rate.displacement_m;
        let motion = |value, rate| Motion { value, rate };
        sample.tilt = [
            motion(pose.pitch_rad, rate.pitch_rad),
            motion(pose.roll_rad, rate.roll_rad),
        ];
        sample.rim += self.rim_m(state);
    }
}

impl Drive {
    fn add(&self, k: usize, response: Complex<f64>, state: &mut CoupledState) {
        let eta = Complex::new(self.entrance.re[k], self.entrance.im[k]) * response;
        state.re[k] += eta.re;
        state.im[k] += eta.im;
    }
}

impl RotorState {
    pub fn copy_from(&mut self, other: &Self) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.copy_from(other);
        }
    }

    pub fn add(&mut self, other: &Self, factor: f64) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.add(other, factor);
        }
    }

    pub fn reset(&mut self) {
        self.parts.iter_mut().for_each(CoupledState::reset);
    }
}

/// What a part needs to know of the disk and the places on it.
struct Places<'a> {
    disk: &'a DiskParameters,
    slider: SliderPlace,
    ramp_radius_m: f64,
    /// Of the slider from the ramp.
    angle_rad: f64,
    ramp_angle_rad: f64,
    oblique: Option<&'a ObliqueShock>,
}

impl Part {
    fn build(
        n: usize,
        hub: &HubParameters,
        modes: &[&DiskMode],
        place: &Places<'_>,
        step_s: f64,
    ) -> Result<Self, StructureError> {
        let disk = place.disk;
        let (disk_mass, system) = matrices(n, hub, modes, disk);
        let order = system.scale.len();
        let fastest_per_s = FASTEST_ANGLE / step_s;
        let mut coupled =
            CoupledModes::below(system, fastest_per_s).map_err(|source| DiskError::Hub {
                nodal_diameters: n,
                source,
            })?;
        let tilting = match n {
            0 => None,
            _ => place
                .oblique
                .map(|shock| TiltLoad::add(shock, hub, place, &mut coupled)),
        };
        let i = Complex::new(0.0, 1.0);
        let real = |x: f64| Complex::from(x);
        // (value, slope) of the hub's motion and of every mode at the sampled radius number `at`.
        let shapes = |at: usize, radius_m: f64| -> Vec<(f64, f64)> {
            let rigid = if n == 0 { (1.0, 0.0) } else { (radius_m, 1.0) };
            std::iter::once(rigid)
                .chain(modes.iter().map(|mode| mode.shape[at]))
                .collect()
        };
        let at_ramp = shapes(0, place.ramp_radius_m);
        let at_slider = shapes(1, place.slider.radius_m);
        let at_rim = shapes(2, disk.outer_radius_m);
        let values = |shape: &[(f64, f64)], turn: Complex<f64>| -> Vec<Complex<f64>> {
            shape.iter().map(|(value, _)| turn * *value).collect()
        };
        let order_n = n as f64;
        let turn = (i * order_n * place.angle_rad).exp();
        let [pitch, roll] = place.slider.slopes_to_pose();
        let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
        let slope = |along: [f64; 2]| -> Vec<Complex<f64>> {
            at_slider
                .iter()
                .map(|(value, slope)| {
                    let around = sense * order_n * value / place.slider.radius_m;
                    turn * (i * (along[1] * around) + along[0] * slope)
                })
                .collect()
        };
        let unit = |z: Complex<f64>| -> Vec<Complex<f64>> {
            (0..order)
                .map(|j| if j == 0 { z } else { real(0.0) })
                .collect()
        };
        let system = coupled.system();
        let rows = |a: &SquareMatrix, sign: f64| -> Vec<Complex<f64>> {
            a.row(0).iter().map(|x| real(sign * x)).collect()
        };
        let contact = values(&at_ramp, real(1.0));
        let inertia = rows(&system.mass, 1.0);
        let bearing = sum(
            &coupled.readout(&rows(&system.stiffness, -1.0)).position,
            &coupled.readout(&rows(&system.damping, -1.0)).velocity,
        );
        Ok(Self {
            nodal_diameters: n,
            spin_rad_per_s: disk.spin_rad_per_s,
            contact: coupled.readout(&contact),
            contact_turn: coupled.readout(&values(&at_ramp, i * order_n)).position,
            contact_entrance: coupled.entrance(&contact),
            rim: coupled.readout(&values(&at_rim, real(1.0))),
            slider: [values(&at_slider, turn), slope(pitch), slope(roll)]
                .map(|weights| coupled.readout(&weights)),
            hub: [real(1.0), -i].map(|z| coupled.readout(&unit(z))),
            momentum: coupled.readout(&inertia),
            bearing_step: over_step(&bearing, coupled.rates_per_s(), step_s),
            bearing,
            drive: match tilting {
                Some(load) => Some(load.drive(&coupled, step_s)),
                None => (n == 0).then(|| Drive {
                    entrance: coupled.entrance(&inertia),
                    power: coupled.readout(&inertia),
                    load: system.mass.get(0, 0),
                    running: None,
                }),
            },
            loss: coupled.loss_form(step_s),
            ripple_loss: modes
                .iter()
                .map(|mode| {
                    let oscillator = Oscillator {
                        omega_rad_per_s: mode.omega_rad_per_s,
                        half_damping_per_s: mode.damping_ratio * mode.omega_rad_per_s,
                        turn_rad_per_s: order_n * disk.spin_rad_per_s,
                        fixed_damping_per_s: disk.space_fixed_damping_per_s,
                    };
                    mode.shape[0].0.powi(2) * oscillator.ripple_loss(step_s)
                })
                .sum(),
            disk_mass,
            modes: coupled,
        })
    }

    /// Energies of the material and in the space-fixed frame.
    fn energies(&self, at: &Coordinates) -> Energies {
        let (kinetic, elastic) = self.modes.system().energies(at);
        let n = self.nodal_diameters as f64 * self.spin_rad_per_s;
        if n == 0.0 {
            return Energies {
                kinetic,
                elastic,
                fixed_frame: kinetic + elastic,
            };
        }
        // ½ sᴴ M_d s with s = q̇ + i n Ω q instead of ½ q̇ᴴ M_d q̇; ½ n² Ω² qᴴ M_d q is elastic too.
        let (mut turned, mut carried) = (0.0, 0.0);
        for (row, (q, v)) in at.q.iter().zip(&at.v).enumerate() {
            let masses = self.disk_mass.row(row).iter().zip(&at.q);
            let moved: Complex<f64> = masses.map(|(m, q)| q * *m).sum();
            turned += v.im * moved.re - v.re * moved.im;
            carried += q.re * moved.re + q.im * moved.im;
        }
        let carried = 0.5 * n * n * carried;
        Energies {
            kinetic: kinetic + n * turned + carried,
            elastic: elastic + carried,
            fixed_frame: kinetic + elastic,
        }
    }
}

/// One damped mode of disk and hub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubModeRow {
    /// `"axial"`, or for tilts `"forward"` and `"backward"`: the sense of the whirl in the space-fixed
    /// frame against the spin.
    pub motion: &'static str,
    /// Damped frequency in the space-fixed frame, Hz; 0 when it does not swing.
    pub frequency_hz: f64,
    /// Damping ratio; negative when it grows.
    pub damping_ratio: f64,
}

/// Modes of the harmonics n = 0 and n = 1 with `disk`'s hub, by rising frequency; none without one.
pub(super) fn hub_modes(
    disk: &DiskParameters,
    basis: &DiskBasis,
) -> Result<Vec<HubModeRow>, StructureError> {
    let Some(hub) = &disk.hub else {
        return Ok(Vec::new());
    };
    let mut rows = Vec::new();
    for n in 0..=1 {
        let carried = |mode: &&DiskMode| mode.nodal_diameters == n && is_carried(mode);
        let modes: Vec<&DiskMode> = basis.modes.iter().filter(carried).collect();
        let (_, system) = matrices(n, hub, &modes, disk);
        let coupled = CoupledModes::new(system).map_err(|source| DiskError::Hub {
            nodal_diameters: n,
            source,
        })?;
        rows.extend(coupled.rates_per_s().iter().map(|s| {
            // e^{iθ + st} goes forward where Im s is negative, for a spin towards growing θ.
            let against = s.im * disk.spin_rad_per_s > 0.0;
            HubModeRow {
                motion: match (n, against) {
                    (0, _) => "axial",
                    (_, false) => "forward",
                    (_, true) => "backward",
                },
                frequency_hz: s.im.abs() / (2.0 * PI),
                damping_ratio: -s.re / s.norm(),
            }
        }));
    }
    rows.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    Ok(rows)
}

/// Loads of an oblique shock on the tilts, per unit a(t) and per unit of its integral.
struct TiltLoad {
    direct: Vec<Complex<f64>>,
    running: Vec<Complex<f64>>,
    /// What puts the running load into the modes, and the mode that holds the integral.
    held: Option<(CoupledState, usize)>,
}

impl TiltLoad {
    /// Loads of `shock`; a turning base adds the mode of its angular velocity to `modes`.
    ///
    /// With the base's tilt β, felt as B a(t) = −β̈, the rotor's inertia loads the coordinates by
    /// M e B a + i Ω (2 M_d + I_p) e B ∫ a dt, e its rigid tilt; in-plane loads d act on its mass at
    /// the height h of its centre: m h (−d_x + i d_y).
    fn add(
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
        // The gyroscopic matrix but for what is the bearing's.
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

    fn drive(&self, modes: &CoupledModes, step_s: f64) -> Drive {
        // A load b does the power Re(bᴴ q̇).
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
            load: 0.0,
            running,
        }
    }
}

/// (M_d, matrices of the harmonic on its hub); see the module.
fn matrices(
    n: usize,
    hub: &HubParameters,
    modes: &[&DiskMode],
    disk: &DiskParameters,
) -> (SquareMatrix, CoupledSystem) {
    let (a2, b2) = (disk.inner_radius_m.powi(2), disk.outer_radius_m.powi(2));
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    let spin = disk.spin_rad_per_s;
    let sense = if spin < 0.0 { -1.0 } else { 1.0 };
    // Of the disk, and of the hub: inertia, polar inertia, stiffness, damping and both across.
    let (rigid, own) = match n {
        0 => (
            PI * areal * (b2 - a2),
            [
                hub.mass_kg,
                0.0,
                hub.axial_stiffness_n_per_m,
                hub.axial_damping_n_s_per_m,
                0.0,
                0.0,
            ],
        ),
        _ => (
            0.25 * PI * areal * (b2 * b2 - a2 * a2),
            [
                hub.transverse_inertia_kg_m2,
                hub.polar_inertia_kg_m2,
                hub.tilt_stiffness_n_m_per_rad,
                hub.tilt_damping_n_m_s_per_rad,
                sense * hub.cross_stiffness_n_m_per_rad,
                sense * hub.cross_damping_n_m_s_per_rad,
            ],
        ),
    };
    let [inertia, polar, stiffness, damping, across, damping_across] = own;
    let squares = modes.iter().map(|mode| mode.omega_rad_per_s.powi(2));
    let scale: Vec<f64> = std::iter::once(stiffness).chain(squares).collect();
    let order = scale.len();
    let mut disk_mass = SquareMatrix::zeros(order);
    disk_mass.add(0, 0, rigid);
    for (j, mode) in modes.iter().enumerate() {
        disk_mass.add(0, j + 1, mode.participation);
        disk_mass.add(j + 1, 0, mode.participation);
        disk_mass.add(j + 1, j + 1, 1.0);
    }
    let mut system = CoupledSystem::zeros(scale);
    let turn = n as f64 * spin;
    for row in 0..order {
        for column in 0..order {
            let m = disk_mass.get(row, column);
            system.mass.add(row, column, m);
            let still_air = disk.space_fixed_damping_per_s * m;
            system.damping.add(row, column, still_air);
            system.gyroscopic.add(row, column, 2.0 * turn * m);
        }
    }
    system.mass.add(0, 0, inertia);
    system.damping.add(0, 0, damping);
    system.gyroscopic.add(0, 0, spin * polar + damping_across);
    system.stiffness.add(0, 0, stiffness);
    system.cross_stiffness.add(0, 0, across);
    for (j, mode) in modes.iter().enumerate() {
        let omega = mode.omega_rad_per_s;
        let rate = 2.0 * mode.damping_ratio * omega;
        system.damping.add(j + 1, j + 1, rate);
        let stiffness = (omega - turn) * (omega + turn);
        system.stiffness.add(j + 1, j + 1, stiffness);
        system.cross_stiffness.add(j + 1, j + 1, rate * turn);
    }
    (disk_mass, system)
}

fn sum(a: &Readout, b: &Readout) -> Readout {
    let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
    Readout {
        re: add(&a.re, &b.re),
        im: add(&a.im, &b.im),
    }
}

/// What reads the integral over a step of free motion of what `row` reads.
fn over_step(row: &Readout, rates_per_s: &[Complex<f64>], step_s: f64) -> Readout {
    let mut integral = row.clone();
    for (k, s) in rates_per_s.iter().enumerate() {
        // Re((re − i im) ∫ η dt) with ∫ η dt = η h φ₁(sh).
        let weight = Complex::new(row.re[k], -row.im[k]) * phi1(s * step_s) * step_s;
        (integral.re[k], integral.im[k]) = (weight.re, -weight.im);
    }
    integral
}

/// Modes of the clamped disk that move with the hub.
pub(super) fn is_carried(mode: &DiskMode) -> bool {
    mode.nodal_diameters <= 1 && mode.nodal_circles.is_some()
}
