//! Holds what all amplitudes of one scene share, and runs one amplitude.

use super::contact_system::ContactSystem;
use super::error::StructureError;
use super::outcome::StructureRun;
use super::parameters::{ContactMethod, Window};
use super::rotor::Rotor;
use super::run_in_progress::{RunInProgress, RunState};
use super::sample::unit_gap;
use super::shared::Shared;
use super::snapshot::{Snapshot, Snapshots};
use super::time_grid::count_steps;
use crate::complementarity::{self, ContactMemory, Gap};
use crate::mutant;
use crate::shock::BaseMotion;
use std::sync::Arc;

/// Disk, ramp, pulse and time grid, ready to run any amplitude of either sign.
#[derive(Clone)]
pub struct StructureModel {
    pub(super) shared: Arc<Shared>,
    activation: Activation,
    keeps_motion: bool,
}

/// When integration of the contact-driven state (every harmonic, arms included) starts. Until the first touch that
/// state is exactly zero, so both choices give the same motion and the same contacts. The energy balance adds the same
/// energies in another order and agrees to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Activation {
    /// At the first touch: before it a run only scales the unit response.
    #[default]
    AtTouch,
    /// At the onset of the pulse, touch or not, ramp or not.
    AtOnset,
}

/// Scratch of one thread; fits any model.
#[derive(Default)]
pub struct Workspace {
    state: Option<RunState>,
}

impl StructureModel {
    pub(super) fn of(shared: Shared) -> Self {
        Self {
            shared: Arc::new(shared),
            activation: Activation::default(),
            keeps_motion: true,
        }
    }

    /// Builds the contact-driven modes at once, as the first run that touches would.
    ///
    /// # Errors
    /// A failed eigenvalue problem of a harmonic n >= 1.
    pub fn build_contact_driven(&self) -> Result<(), StructureError> {
        self.shared.driven().map(|_| ())
    }

    /// The same model with another start of the contact-driven state.
    #[must_use]
    pub fn with_activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// The same model for runs without a head: they need not keep the motion under the slider.
    #[must_use]
    pub fn without_motion(self) -> Self {
        Self {
            keeps_motion: false,
            ..self
        }
    }

    /// Motion of the base's pivot under the unit pulse, when it vibrates.
    pub fn base_motion(&self) -> Option<&BaseMotion> {
        self.shared.free.base.as_ref()
    }

    /// When integration of the contact-driven state starts.
    pub fn activation(&self) -> Activation {
        self.activation
    }

    /// Latest end of a run over `window`, at a node of the grid, s; `None` for an invalid window.
    pub fn end_of(&self, window: Window) -> Option<f64> {
        let step_s = self.shared.free.step_s;
        let n_steps = count_steps(window, step_s).ok()?;
        Some(n_steps as f64 * step_s)
    }

    /// Steps of the grid over the whole window.
    pub fn n_steps(&self) -> usize {
        self.shared.n_steps
    }

    /// Number of modes that move before any contact: the disk's axisymmetric ones and the arms'.
    pub fn n_free_modes(&self) -> usize {
        let free = &self.shared.free;
        free.modes.oscillators.len() + free.rotor.as_ref().map_or(0, Rotor::n_driven)
    }

    /// Number of modes of both arms.
    pub fn n_arm_modes(&self) -> usize {
        let rotor = self.shared.free.rotor.as_ref();
        self.shared.n_arm_modes + rotor.map_or(0, Rotor::n_arm_modes)
    }

    /// Number of modes once contact has activated all: disk (with static corrections), hub and arms.
    ///
    /// # Errors
    /// A failed eigenvalue problem of a harmonic n >= 1.
    pub fn n_modes(&self) -> Result<usize, StructureError> {
        let rotor = self.shared.free.rotor.as_ref();
        Ok(self.shared.driven()?.n_modes() + rotor.map_or(0, Rotor::n_modes))
    }

    /// Runs the signed amplitude. With `record` the columns of the history are kept.
    ///
    /// # Errors
    /// [`StructureError::NotFinite`].
    pub fn run(
        &self,
        amplitude_m_per_s2: f64,
        record: bool,
        workspace: &mut Workspace,
    ) -> Result<StructureRun, StructureError> {
        let shared = &*self.shared;
        if !amplitude_m_per_s2.is_finite() {
            return Err(StructureError::NotFinite { time_s: 0.0 });
        }
        let state = workspace.state.get_or_insert_with(RunState::default);
        if shared.method == ContactMethod::MoreauJean {
            return self.run_moreau_jean(amplitude_m_per_s2, record, &mut state.snapshots);
        }
        state.prepare(shared, record, self.keeps_motion);
        let amplitude_m_per_s2 = match mutant::is_on("R5 sign") {
            true => amplitude_m_per_s2.abs(),
            false => amplitude_m_per_s2,
        };
        let mut run = RunInProgress::new(shared, amplitude_m_per_s2, state);
        let mut memory = ContactMemory::default();
        run.record_node();
        let first_active = match self.activation {
            Activation::AtTouch if mutant::is_on("R3 first touch") => shared.n_steps,
            Activation::AtTouch => shared.first_touching_step(amplitude_m_per_s2),
            Activation::AtOnset => 0,
        };
        while run.k < first_active {
            if !run.advance_inactive(first_active) {
                run.inactive_step();
            }
            run.record_node();
            if run.decayed() {
                return run.finish();
            }
        }
        if first_active == shared.n_steps {
            return run.finish();
        }
        let mut system = ContactSystem::activate(run, shared.driven()?);
        while system.run().k < shared.n_steps {
            if !system.advance_contact_free() {
                let step_s = shared.free.step_s;
                let report =
                    complementarity::advance(&mut system, step_s, &shared.law, &mut memory);
                system.end_step(report);
            }
            system.run().record_node();
            if system.run().decayed() {
                break;
            }
        }
        system.into_run().finish()
    }

    /// Runs the signed amplitude and keeps the states at `nodes`, which rise, as far as the run gets.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub(super) fn run_keeping(
        &self,
        amplitude_m_per_s2: f64,
        nodes: Vec<usize>,
        workspace: &mut Workspace,
    ) -> Result<Vec<Snapshot>, StructureError> {
        let state = workspace.state.get_or_insert_with(RunState::default);
        state.snapshots = Snapshots {
            nodes,
            taken: Vec::new(),
        };
        // Only a run that records visits every node.
        let run = self.run(amplitude_m_per_s2, true, workspace);
        let kept = workspace
            .state
            .as_mut()
            .map(|state| std::mem::take(&mut state.snapshots));
        run.map(|_| kept.unwrap_or_default().taken)
    }

    /// Smallest |amplitude| of the given sign at which the disk touches this ramp within the window, by linearity from
    /// the unit response; `None` without a ramp or when nothing closes the gap.
    pub fn touch_amplitude_m_per_s2(&self, positive: bool) -> Option<f64> {
        let shared = &*self.shared;
        let is_plus = positive || mutant::is_on("R7 mirrored");
        let sign = if is_plus { 1.0 } else { -1.0 };
        let mut lowest: Option<f64> = None;
        for side in 0..shared.n_contacts {
            // Closing of the gap per unit amplitude.
            let closing = |k: usize| {
                let mut sample = shared.free.samples[k];
                if mutant::is_on("R4 shaking ramp") {
                    (sample.top, sample.bottom) = Default::default();
                }
                let g = unit_gap(side, &sample);
                Gap {
                    value_m: -sign * g.value_m,
                    rate_m_per_s: -sign * g.rate_m_per_s,
                }
            };
            let mut largest = 0.0_f64;
            let mut left = closing(0);
            for k in 1..shared.free.samples.len() {
                let right = closing(k);
                largest = largest.max(right.value_m);
                if left.rate_m_per_s > 0.0 && right.rate_m_per_s < 0.0 {
                    largest = largest.max(complementarity::advance::largest_between(
                        left,
                        right,
                        shared.free.step_s,
                    ));
                }
                left = right;
            }
            if largest > 0.0 {
                let a = shared.clearance_m[side] / largest;
                lowest = Some(lowest.map_or(a, |l| l.min(a)));
            }
        }
        lowest
    }
}
