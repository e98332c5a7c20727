//! What is common to all amplitudes of one scene, and the run of one amplitude.

use super::bank::Bank;
use super::contact_system::{ContactSystem, RunState};
use super::energy::EnergyWeights;
use super::free_motion::{FreeMotion, Sample};
use super::history::StructuralHistory;
use super::record::{
    ArmContact, BaseRecord, Complementarity, DiskExtremes, EnergyBook, HubRecord, StructureColumns,
};
use super::rotor::{self, Rotor, is_carried};
use super::{ContactMethod, StructureResolution, Window};
use crate::complementarity::{self, ContactMemory, Gap, ImpactLaw};
use crate::disk::{
    self, DiskBasis, DiskError, DiskMode, DiskParameters, DiskPose, DiskResolution, Harmonics,
};
use crate::modal::{BankFlow, Oscillator, Readout};
use crate::mutant;
use crate::ramp::{ArmMode, RampError, RampModel, RampParameters};
use crate::shock::{BaseMode, BaseMotion, ObliqueShock, Pulse, PulseError};
use std::ops::Range;
use std::sync::Arc;

/// A gap below this is closed, m. Displacements of 0.1 mm carry rounding of 1e-20 m; nothing of
/// interest is smaller than 1e-12 m.
const GAP_TOLERANCE_M: f64 = 1e-13;
/// Bounces located in one step before contact is taken as sustained.
const MAX_IMPACTS_PER_STEP: u32 = 8;
/// Penetration above which a run warns, m.
const PENETRATION_WARNING_M: f64 = 1e-7;
/// Largest ω Δt of a disk mode; a longer step is divided into equal parts. Beyond π an impulse
/// cannot be aimed (see [`crate::complementarity`]). A static correction faster than that is slowed at
/// constant compliance: it stands for stiffness, and would divide the step three to five times.
const FASTEST_DISK_ANGLE: f64 = 3.0;
/// Most modes of a base.
const MOST_BASE_MODES: usize = 16;
/// Most steps of a grid.
const MAX_STEPS: f64 = 2e7;

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

/// One arm in the bank of oscillators.
pub(super) struct Arm {
    /// Indices of its modes in the bank.
    pub modes: Range<usize>,
}

/// What all runs share.
pub(super) struct Shared {
    pub free: FreeMotion,
    pub n_steps: usize,
    pub method: ContactMethod,
    pub window: Window,
    pub pulse: Pulse,
    /// 0 without a ramp, else 2.
    pub n_contacts: usize,
    pub clearance_m: [f64; 2],
    pub law: ImpactLaw,
    pub spin_rad_per_s: f64,
    /// Disk modes, then the arms' modes, padded.
    pub oscillators: Vec<Oscillator>,
    /// Disk modes including padding.
    pub n_disk: usize,
    /// Bank index of each forced mode.
    pub forced_index: Vec<usize>,
    pub arms: [Arm; 2],
    /// Whether both arms are one body with the same modes.
    pub coupled: bool,
    /// Shape of the disk at the contact point, over the bank (zero on arms).
    pub contact: Vec<f64>,
    /// Nodal diameters times `contact`: −Im of it reads w_θ.
    pub contact_turn: Vec<f64>,
    /// Shapes 1/√m of each arm's contact point over the bank.
    pub arm_shape: [Vec<f64>; 2],
    pub rim: Vec<f64>,
    /// Displacement, pitch and roll at the slider.
    pub slider: [Readout; 3],
    /// Jump of the slider's pose rate per impulse on the disk.
    pub slider_jump: DiskPose,
    /// That of the slider's pose and of the pivot per impulse on the disk and on each arm, on a base.
    pub base_jumps: Option<[(DiskPose, f64); 3]>,
    /// Pitch and roll per radial slope.
    pub slope_to_pose: [f64; 2],
    pub step_flow: BankFlow,
    pub weights: EnergyWeights,
    pub mobility: [[f64; 2]; 2],
    pub ripple_loss: [[f64; 2]; 2],
    pub warnings: Vec<StructureWarning>,
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
    /// Builds the modal basis, the unit response and the tables of one step.
    ///
    /// Without a ramp nothing ever drives the harmonics n >= 1: [`Harmonics::Symmetric`] then
    /// gives the same motion for less.
    ///
    /// # Errors
    /// A parameter out of range, a place off the disk, an overlap before the shock, a failed
    /// eigenvalue problem.
    pub fn build(
        parameters: &StructureParameters<'_>,
        harmonics: Harmonics,
    ) -> Result<Self, StructureError> {
        let StructureParameters {
            disk,
            disk_resolution,
            ramp,
            slider,
            pulse,
            oblique,
            base,
            window,
            resolution,
        } = *parameters;
        check_times(window, resolution.step_s)?;
        ramp.validate()?;
        check_direction(oblique, disk)?;
        check_base(base, oblique)?;
        disk::basis::validate_place(disk, "slider", slider.radius_m)?;
        disk::basis::validate_place(disk, "ramp", ramp.radius_m)?;
        let stretches = pulse.stretches()?;
        let radii = [ramp.radius_m, slider.radius_m, disk.outer_radius_m];
        let mut basis = DiskBasis::build(disk, disk_resolution, &radii, Some(0), harmonics)?;
        let step_s = divided_step_s(&basis, disk_resolution, resolution.step_s);
        slow_corrections(&mut basis, step_s);

        let is_on_hub = disk.hub.is_some();
        let has_harmonics = basis.modes.iter().any(|mode| mode.nodal_diameters > 0);
        let mut carried = Vec::new();
        if is_on_hub || !base.is_empty() {
            // The rotor carries them with hub and base.
            let all = std::mem::take(&mut basis.modes);
            let on_it = |mode: &DiskMode| is_carried(mode, is_on_hub);
            (carried, basis.modes) = all.into_iter().partition(on_it);
        }
        let mut bank = Bank::new(&basis, disk, slider, ramp.angle_rad, !base.is_empty());
        let n_steps = count_steps(window, step_s)?;
        let stiffness = match ramp.model {
            RampModel::None => None,
            _ => ramp.contact_stiffness_n_per_m,
        };
        let mut add = |modes: &[ArmMode]| bank.add_arm(modes, stiffness, step_s);
        let arms = match &ramp.model {
            RampModel::None | RampModel::Rigid => [add(&[]), add(&[])],
            RampModel::Deformable { top, bottom } => [add(top), add(bottom)],
            RampModel::Coupled { modes } => bank.add_coupled(modes, stiffness, step_s),
        };
        if let Some(shock) = oblique {
            // A turning base shakes the ramp by another axial load than the spindle.
            bank.scale_arms(shock.axial_at(ramp.radius_m, ramp.angle_rad));
        }
        bank.pad();
        let riding = bank.riding.take().unwrap_or_default();
        let rotor = Rotor::build(
            &carried,
            &riding,
            has_harmonics,
            parameters,
            &stretches,
            step_s,
        )?;

        let mut step_flow = BankFlow::zeros(bank.oscillators.len());
        step_flow.set(&bank.oscillators, step_s);
        let mut mobility = bank.contact_matrix(|_| 1.0);
        let mut ripple_loss = bank.contact_matrix(|o| o.ripple_loss(step_s));
        let mut slider_jump = bank.slider_jump();
        if let Some(rotor) = &rotor {
            rotor::add(&mut mobility, &rotor.mobility());
            rotor::add(&mut ripple_loss, &rotor.ripple_loss());
            slider_jump = slider_jump.plus(&rotor.slider_jump());
        }
        let base_jumps = rotor.as_ref().and_then(Rotor::base_jumps).map(|mut jumps| {
            jumps[0].0 = slider_jump;
            jumps
        });
        let mut warnings = instabilities(&basis, &bank.oscillators);
        if bank.n_slowed > 0 {
            warnings.push(StructureWarning::ArmModesSlowed {
                modes: bank.n_slowed,
            });
        }
        if let Some((nodal_diameters, growth_per_s)) = rotor.as_ref().and_then(Rotor::growth) {
            warnings.push(StructureWarning::HubInstability {
                nodal_diameters,
                growth_per_s,
            });
        }
        if basis.harmonics_bounded {
            warnings.push(StructureWarning::HarmonicsBounded);
        }
        let weights = EnergyWeights::new(&bank.oscillators, &bank.forced_index, step_s);
        let (forced, shapes) = (bank.forced, bank.shapes);
        let free = FreeMotion::new(forced, shapes, rotor, stretches, step_s, n_steps);
        Ok(Self {
            shared: Arc::new(Shared {
                free,
                n_steps,
                method: resolution.contact,
                window,
                pulse: pulse.clone(),
                n_contacts: if ramp.model == RampModel::None { 0 } else { 2 },
                clearance_m: [ramp.clearance_top_m, ramp.clearance_bottom_m],
                law: ImpactLaw {
                    restitution: ramp.restitution,
                    gap_tolerance_m: GAP_TOLERANCE_M,
                    max_impacts_per_step: MAX_IMPACTS_PER_STEP,
                },
                spin_rad_per_s: disk.spin_rad_per_s,
                n_disk: bank.n_disk,
                oscillators: bank.oscillators,
                forced_index: bank.forced_index,
                coupled: arms[0].modes == arms[1].modes && !arms[0].modes.is_empty(),
                arms,
                contact: bank.contact,
                contact_turn: bank.contact_turn,
                arm_shape: bank.arm_shape,
                rim: bank.rim,
                slider: bank.slider,
                slider_jump,
                base_jumps,
                slope_to_pose: bank.slope_to_pose,
                step_flow,
                weights,
                mobility,
                ripple_loss,
                warnings,
            }),
            wake: Wake::default(),
            keeps_motion: true,
        })
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

    /// Steps of the grid over the whole window.
    pub fn n_steps(&self) -> usize {
        self.shared.n_steps
    }

    /// Number of modes that move before any contact: the disk's axisymmetric ones and the arms'.
    pub fn n_free_modes(&self) -> usize {
        let rotor = self.shared.free.rotor.as_ref();
        self.shared.forced_index.len() + rotor.map_or(0, Rotor::n_driven)
    }

    /// Number of modes of both arms.
    pub fn n_arm_modes(&self) -> usize {
        let rotor = self.shared.free.rotor.as_ref();
        let alone: usize = match self.shared.coupled {
            true => self.shared.arms[0].modes.len(),
            false => self.shared.arms.iter().map(|arm| arm.modes.len()).sum(),
        };
        alone + rotor.map_or(0, Rotor::n_arm_modes)
    }

    /// Number of modes carried: disk (with static corrections), hub and arms.
    pub fn n_modes(&self) -> usize {
        let used = |o: &&Oscillator| o.omega_rad_per_s > 0.0;
        let rotor = self.shared.free.rotor.as_ref();
        self.shared.oscillators.iter().filter(used).count() + rotor.map_or(0, Rotor::n_modes)
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
        let mut system = ContactSystem::new(shared, amplitude_m_per_s2, state);
        let mut memory = ContactMemory::default();
        system.record_node();
        let first_awake = match self.wake {
            Wake::AtTouch if mutant::is_on("R3 first touch") => shared.n_steps,
            Wake::AtTouch => shared.first_touching_step(amplitude_m_per_s2),
            Wake::AtOnset => 0,
        };
        for _ in 0..first_awake {
            system.sleep_step();
            system.record_node();
            if system.decayed() {
                return system.finish();
            }
        }
        for _ in first_awake..shared.n_steps {
            system.begin_step();
            let step_s = shared.free.step_s;
            let report = complementarity::advance(&mut system, step_s, &shared.law, &mut memory);
            system.end_step(report);
            system.record_node();
            if system.decayed() {
                break;
            }
        }
        system.finish()
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

impl Shared {
    /// Gap of `side` at node `k` in free motion.
    pub fn free_gap(&self, side: usize, amplitude: f64, sample: &Sample) -> Gap {
        let unit = unit_gap(side, sample);
        Gap {
            value_m: self.clearance_m[side] + amplitude * unit.value_m,
            rate_m_per_s: amplitude * unit.rate_m_per_s,
        }
    }

    /// Pose and rate of the disk over the pivot as the unit response alone moves it.
    ///
    /// What contact does to the pivot is told apart ([`StructuralHistory`]): impulses make its velocity jump,
    /// which no load b(t) could tell the head.
    pub fn over_pivot(
        &self,
        amplitude: f64,
        time_s: f64,
        mut pose: DiskPose,
        mut rate: DiskPose,
    ) -> (DiskPose, DiskPose) {
        if let Some(base) = &self.free.base {
            let [value, speed] = base.displacement(time_s);
            pose.displacement_m -= amplitude * value;
            rate.displacement_m -= amplitude * speed;
        }
        (pose, rate)
    }

    /// An empty history of what contact does to the pivot, on a base that vibrates.
    pub fn pivot_history(&self, n_nodes: usize) -> Option<Box<StructuralHistory>> {
        self.base_jumps.map(|_| {
            Box::new(StructuralHistory {
                step_s: self.free.step_s,
                pose: Vec::with_capacity(n_nodes),
                rate: Vec::with_capacity(n_nodes),
                ..StructuralHistory::default()
            })
        })
    }

    /// First step in which free motion closes a gap; the number of steps when none does.
    fn first_touching_step(&self, amplitude: f64) -> usize {
        if self.n_contacts == 0 {
            return self.n_steps;
        }
        (0..self.n_steps)
            .find(|&k| self.may_touch(amplitude, k))
            .unwrap_or(self.n_steps)
    }

    /// True when free motion from node `k` closes a gap before node `k + 1`, or a gap is closed.
    fn may_touch(&self, amplitude: f64, k: usize) -> bool {
        (0..self.n_contacts).any(|side| {
            let now = self.free_gap(side, amplitude, &self.free.samples[k]);
            let ahead = self.free_gap(side, amplitude, &self.free.samples[k + 1]);
            ahead.value_m < 0.0 || complementarity::advance::dips(now, ahead, self.free.step_s)
        })
    }
}

/// Change of the gap of `side` per unit amplitude: top g = g₀ + x − w, bottom g = g₀ − x + w.
fn unit_gap(side: usize, sample: &Sample) -> Gap {
    let (arm, sign) = if side == 0 {
        (sample.top, 1.0)
    } else {
        (sample.bottom, -1.0)
    };
    Gap {
        value_m: sign * (arm.value - sample.contact.value),
        rate_m_per_s: sign * (arm.rate - sample.contact.rate),
    }
}

impl StructureRun {
    pub(super) fn penetration_warning(depth_m: f64) -> Option<StructureWarning> {
        (depth_m > PENETRATION_WARNING_M).then_some(StructureWarning::Penetration { depth_m })
    }
}

fn window_length(window: Window) -> f64 {
    match window {
        Window::Fixed { length_s } => length_s,
        Window::UntilDecayed { max_s, .. } => max_s,
    }
}

fn check_direction(
    oblique: Option<&ObliqueShock>,
    disk: &DiskParameters,
) -> Result<(), StructureError> {
    match oblique {
        Some(shock) if disk.hub.is_none() || !shock.is_finite() => Err(StructureError::Direction),
        _ => Ok(()),
    }
}

fn check_base(base: &[BaseMode], oblique: Option<&ObliqueShock>) -> Result<(), StructureError> {
    let is_sound = base.len() <= MOST_BASE_MODES && base.iter().all(BaseMode::is_sound);
    match base.is_empty() || (oblique.is_none() && is_sound) {
        true => Ok(()),
        false => Err(StructureError::Base),
    }
}

fn check_times(window: Window, step_s: f64) -> Result<(), StructureError> {
    let positive = "finite and above 0";
    let above_0 = |x: f64| x.is_finite() && x > 0.0;
    let (length, share) = match window {
        Window::Fixed { length_s } => (length_s, 0.5),
        Window::UntilDecayed { share, max_s } => (max_s, share),
    };
    for (name, value, ok, allowed) in [
        ("window", length, above_0(length), positive),
        ("step", step_s, above_0(step_s), positive),
        (
            "decay share",
            share,
            above_0(share) && share < 1.0,
            "between 0 and 1",
        ),
    ] {
        if !ok {
            return Err(StructureError::Time {
                name,
                value,
                allowed,
            });
        }
    }
    Ok(())
}

fn count_steps(window: Window, step_s: f64) -> Result<usize, StructureError> {
    // A window that is a multiple of the step but for rounding gets no step more.
    let n = (window_length(window) / step_s - 1e-6).ceil().max(1.0);
    if n > MAX_STEPS {
        return Err(StructureError::Time {
            name: "steps in the window",
            value: n,
            allowed: "at most 2e7",
        });
    }
    Ok(n as usize)
}

/// The step divided for the modes below the cut and, should it be lower, the slowest of n = 0, which
/// every basis holds. So all ramps share one grid.
fn divided_step_s(basis: &DiskBasis, resolution: &DiskResolution, step_s: f64) -> f64 {
    let symmetric = basis.modes.iter().filter(|mode| mode.nodal_diameters == 0);
    let fastest = symmetric
        .filter(|mode| mode.nodal_circles.is_some())
        .map(|mode| mode.omega_rad_per_s)
        .fold(std::f64::consts::TAU * resolution.cut_hz, f64::max);
    let n_parts = (fastest * step_s / FASTEST_DISK_ANGLE).ceil().max(1.0);
    step_s / n_parts
}

/// Slows static corrections too fast for the step; φ/ω and so the compliance stay.
fn slow_corrections(basis: &mut DiskBasis, step_s: f64) {
    let limit = FASTEST_DISK_ANGLE / step_s;
    for mode in &mut basis.modes {
        if mode.nodal_circles.is_none() && mode.omega_rad_per_s > limit {
            let share = limit / mode.omega_rad_per_s;
            mode.omega_rad_per_s = limit;
            for (value, slope) in &mut mode.shape {
                *value *= share;
                *slope *= share;
            }
        }
    }
}

/// Modes that grow: air held in space above a critical speed.
fn instabilities(basis: &DiskBasis, oscillators: &[Oscillator]) -> Vec<StructureWarning> {
    basis
        .modes
        .iter()
        .zip(oscillators)
        .filter_map(|(mode, o)| {
            let growth_per_s = o.roots().iter().map(|r| r.re).fold(f64::MIN, f64::max);
            (growth_per_s > 0.0).then_some(StructureWarning::PhysicalInstability {
                nodal_diameters: mode.nodal_diameters,
                growth_per_s,
            })
        })
        .collect()
}
