//! What is common to all amplitudes of one scene, and the run of one amplitude.

use super::assembly::count_steps;
use super::contact_system::ContactSystem;
use super::history::StructuralHistory;
use super::record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBook, HubRecord, StructureColumns,
};
use super::rotor::Rotor;
use super::run_books::{RunBooks, RunState};
use super::shared::{Shared, unit_gap};
use super::{ContactMethod, StructureResolution, Window};
use crate::complementarity::{self, ContactMemory, Gap};
use crate::disk::{DiskError, DiskParameters, DiskResolution};
use crate::mutant;
use crate::ramp::{RampError, RampParameters};
use crate::shock::{BaseMode, BaseMotion, ObliqueShock, Pulse, PulseError};
use std::sync::Arc;

/// Penetration above which a run warns, m.
const PENETRATION_WARNING_M: f64 = 1e-7;

/// Where the slider stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderPlace {
    /// Radius of its centre, m.
    pub radius_m: f64,
    /// Angle of its centre in the disk's sense of rotation, same origin as the ramp, rad.
    pub angle_rad: f64,
    /// Angle from the slider's x axis to the disk's velocity, positive towards +y, rad.
    pub skew_rad: f64,
}

impl SliderPlace {
    /// Weights of (slope outwards, slope along the disk's velocity) in pitch and in roll:
    /// w_x = w_t cos − w_r sin, w_y = w_t sin + w_r cos; pitch = −w_x, roll = w_y.
    pub(super) fn slopes_to_pose(&self) -> [[f64; 2]; 2] {
        let (sine, cosine) = self.skew_rad.sin_cos();
        [[sine, -cosine], [cosine, sine]]
    }
}

/// Everything a structural model is built from.
#[derive(Clone, Copy, Debug)]
pub struct StructureParameters<'a> {
    /// Disk.
    pub disk: &'a DiskParameters,
    /// Numerical resolution of the disk.
    pub disk_resolution: &'a DiskResolution,
    /// Ramp.
    pub ramp: &'a RampParameters,
    /// Slider.
    pub slider: SliderPlace,
    /// Unit pulse.
    pub pulse: &'a Pulse,
    /// What else shakes the base in step with it.
    pub oblique: Option<&'a ObliqueShock>,
    /// Modes of the base that everything stands on; none: it is rigid.
    pub base: &'a [BaseMode],
    /// Simulated time.
    pub window: Window,
    /// Numerical resolution in time.
    pub resolution: &'a StructureResolution,
}

/// Why a structural model cannot be built or run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// Disk.
    #[error(transparent)]
    Disk(#[from] DiskError),
    /// Ramp.
    #[error(transparent)]
    Ramp(#[from] RampError),
    /// Pulse.
    #[error(transparent)]
    Pulse(#[from] PulseError),
    /// An oblique shock without a hub that it could tilt, or with shares that are no numbers.
    #[error("an oblique shock needs a hub, on which it tilts the disk, and finite shares")]
    Direction,
    /// Modes of a base that cannot be, too many or too light, or under an oblique shock.
    #[error(
        "a vibrating base has at most 16 modes of finite numbers, a frequency above 0 and a damping ratio \
         in [0, 1), is heavier than disk, hub and arms where they stand on it, and takes a straight shock"
    )]
    Base,
    /// Step or window.
    #[error("{name} = {value:e} is outside its range ({allowed})")]
    Time {
        /// Name of the quantity.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// A motion that is not a finite number.
    #[error("the structure's motion is not finite at {time_s:e} s")]
    NotFinite {
        /// Time, s.
        time_s: f64,
    },
}

/// Something a user should know about a structural run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StructureWarning {
    /// A contact sank in by more than a tenth of a micrometre: the step is too long.
    Penetration {
        /// Largest penetration, m.
        depth_m: f64,
    },
    /// Bounces accumulated within a step and were taken as lasting contact.
    BouncesAccumulated {
        /// Number of steps.
        steps: u64,
    },
    /// Harmonics with modes below the cut were left out.
    HarmonicsBounded,
    /// Arm modes too fast for the step were slowed at constant stiffness.
    ArmModesSlowed {
        /// Number of modes.
        modes: usize,
    },
    /// Both arms held one point: only the net force is determined.
    BothArmsOnePoint,
    /// The hub's bearing drives a whirl of the rotor.
    HubInstability {
        /// 0: axial motion, 1: tilt.
        nodal_diameters: usize,
        /// Growth rate, 1/s.
        growth_per_s: f64,
    },
    /// The disk spins above a critical speed and air held in space drives a travelling wave.
    PhysicalInstability {
        /// Nodal diameters of the wave.
        nodal_diameters: usize,
        /// Growth rate, 1/s.
        growth_per_s: f64,
    },
}

/// Disk, ramp, pulse and grid, ready to run any amplitude of either sign.
#[derive(Clone)]
pub struct StructureModel {
    pub(super) shared: Arc<Shared>,
    wake: Wake,
    keeps_motion: bool,
}

/// When the contact-driven state (every harmonic, arms included) starts to be marched.
///
/// Until the first touch it is exactly zero, so both give the same motion and the same contacts;
/// the energy book sums the same energies in another order and agrees to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wake {
    /// At the first touch: before it a run only scales the unit response.
    #[default]
    AtTouch,
    /// From the onset of the pulse, touch or not, ramp or not.
    AtOnset,
}

/// Scratch of one thread; fits any model.
#[derive(Default)]
pub struct Workspace {
    state: Option<RunState>,
}

/// One amplitude through a structural model.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureRun {
    /// Motion of the disk under the slider, unless the model is one without motion.
    pub history: StructuralHistory,
    /// Columns on the grid, when recorded.
    pub columns: Option<StructureColumns>,
    /// Extremes of the disk's motion.
    pub disk: DiskExtremes,
    /// Contact with the top arm.
    pub top: ArmContact,
    /// Contact with the bottom arm.
    pub bottom: ArmContact,
    /// Energy book.
    pub energy: EnergyBook,
    /// Complementarity numbers.
    pub complementarity: Complementarity,
    /// Hub, of a disk on a bearing.
    pub hub: Option<HubRecord>,
    /// Base, when it vibrates.
    pub base: Option<BaseRecord>,
    /// First touch of either arm, s.
    pub first_touch_s: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// End of the run, s.
    pub end_s: f64,
    /// Signs of trouble.
    pub warnings: Vec<StructureWarning>,
}

impl StructureModel {
    pub(super) fn of(shared: Shared) -> Self {
        Self {
            shared: Arc::new(shared),
            wake: Wake::default(),
            keeps_motion: true,
        }
    }

    /// Builds at once what contact drives, as the first run that touches would.
    ///
    /// # Errors
    /// A failed eigenvalue problem of a harmonic n >= 1.
    pub fn wake_up(&self) -> Result<(), StructureError> {
        self.shared.driven().map(|_| ())
    }

    /// The same model with another start of the contact-driven state.
    #[must_use]
    pub fn with_wake(self, wake: Wake) -> Self {
        Self { wake, ..self }
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

    /// When the contact-driven state starts to be marched.
    pub fn wake(&self) -> Wake {
        self.wake
    }

    /// Node of the grid at which a run over `window` ends at the latest, s; `None` where there is no such window.
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

    /// Number of modes once contact has woken all: disk (with static corrections), hub and arms.
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
        if shared.method == ContactMethod::MoreauJean {
            return self.run_moreau_jean(amplitude_m_per_s2, record);
        }
        let state = workspace.state.get_or_insert_with(RunState::default);
        state.prepare(shared, record, self.keeps_motion);
        let amplitude_m_per_s2 = match mutant::is_on("R5 sign") {
            true => amplitude_m_per_s2.abs(),
            false => amplitude_m_per_s2,
        };
        let mut books = RunBooks::new(shared, amplitude_m_per_s2, state);
        let mut memory = ContactMemory::default();
        books.record_node();
        let first_awake = match self.wake {
            Wake::AtTouch if mutant::is_on("R3 first touch") => shared.n_steps,
            Wake::AtTouch => shared.first_touching_step(amplitude_m_per_s2),
            Wake::AtOnset => 0,
        };
        while books.k < first_awake {
            if !books.sleep_flight(first_awake) {
                books.sleep_step();
            }
            books.record_node();
            if books.decayed() {
                return books.finish();
            }
        }
        if first_awake == shared.n_steps {
            return books.finish();
        }
        let mut system = ContactSystem::wake(books, shared.driven()?);
        while system.books().k < shared.n_steps {
            if !system.fly() {
                let step_s = shared.free.step_s;
                let report =
                    complementarity::advance(&mut system, step_s, &shared.law, &mut memory);
                system.end_step(report);
            }
            system.books().record_node();
            if system.books().decayed() {
                break;
            }
        }
        system.into_books().finish()
    }

    /// Smallest |amplitude| of the given sign at which this ramp is touched within the window, by
    /// linearity from the unit response; `None` without a ramp or when nothing closes the gap.
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

impl StructureRun {
    pub(super) fn penetration_warning(depth_m: f64) -> Option<StructureWarning> {
        (depth_m > PENETRATION_WARNING_M).then_some(StructureWarning::Penetration { depth_m })
    }
}
