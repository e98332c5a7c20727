//! Results of one shock on one head: verdict, clearance, histories, cost. Times: seconds after the pulse's onset.

use crate::air_bearing::Attitude;

/// Verdict of a run: survived, failed or undecided. A NaN never decides it.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// That did not occur in the whole window.
    Survives,
    /// The clearance fell below the failure limit, or contact exceeded a limit of damage.
    Fails {
        /// Time of it, s.
        t_fail_s: f64,
        /// Place of the smallest clearance then.
        place: Place,
    },
    /// The run gave no answer.
    Undecided {
        /// The cause.
        cause: Cause,
    },
}

/// A point of the slider's surface, slider coordinates, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// From the leading edge, m.
    pub x_m: f64,
    /// From the inner edge, m.
    pub y_m: f64,
}

/// Why a run has no verdict.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// The coupled solve did not converge at the smallest step.
    NotConverged {
        /// Time, s.
        time_s: f64,
        /// Largest scaled residual.
        residual: f64,
    },
    /// The step limit was reached.
    StepLimit {
        /// Time reached, s.
        time_s: f64,
        /// The limit.
        max_steps: u64,
    },
    /// A non-finite number appeared.
    NotFinite {
        /// Time, s.
        time_s: f64,
        /// Which quantity.
        quantity: &'static str,
    },
}

/// The cause as a sentence; times are after the onset of the pulse.
impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let us = |time_s: &f64| 1e6 * time_s;
        match self {
            Cause::NotConverged { time_s, residual } => write!(
                f,
                "the coupled solve did not converge {:.3} us after the onset: scaled residual \
                 {residual:.1e} at the smallest step",
                us(time_s)
            ),
            Cause::StepLimit { time_s, max_steps } => write!(
                f,
                "the limit of {max_steps} steps was reached {:.3} us after the onset",
                us(time_s)
            ),
            Cause::NotFinite { time_s, quantity } => {
                write!(
                    f,
                    "{quantity} was not finite {:.3} us after the onset",
                    us(time_s)
                )
            }
        }
    }
}

/// Dimple contact up to the first touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DimpleRecord {
    /// Smallest contact force, N.
    pub min_force_n: f64,
    /// Total time open, s.
    pub open_s: f64,
}

/// Contact of the limiters or of the lift tab up to the first touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StopRecord {
    /// Largest contact force, N; of all limiters together.
    pub max_force_n: f64,
    /// End of the first step in which it was closed, s.
    pub first_s: Option<f64>,
    /// Total time closed, s.
    pub closed_s: f64,
}

impl StopRecord {
    /// Adds a step of `dt_s` that ends at `time_s`, with the forces at its ends.
    pub(super) fn add_step(&mut self, force_n: [f64; 2], dt_s: f64, time_s: f64) {
        let [before, after] = force_n;
        self.max_force_n = self.max_force_n.max(after);
        if after > 0.0 {
            self.first_s.get_or_insert(time_s);
        }
        let n_closed = [before, after].iter().filter(|&&f| f > 0.0).count();
        self.closed_s += 0.5 * n_closed as f64 * dt_s;
    }
}

/// One episode of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderEpisode {
    /// Begin, s.
    pub on_s: f64,
    /// End, s; that of the run for an episode that goes on.
    pub off_s: f64,
    /// Speed at which the smallest clearance fell in the step that began it, m/s, on average: negative where it rose again.
    pub approach_m_per_s: f64,
    /// Impulse of the asperities on the slider, N s.
    pub impulse_n_s: f64,
    /// Largest force, N.
    pub peak_force_n: f64,
    /// Largest pressure of a nominal area, Pa.
    pub peak_pressure_pa: f64,
    /// Smallest distance of the mean planes at a point of the film's grid, m; negative where they overlap.
    pub closest_m: f64,
    /// Place of the smallest clearance at the largest force.
    pub place: Place,
    /// Work of friction on slider and disk, J: its force times the speed of the disk.
    pub friction_j: f64,
    /// Work on the asperities, of a run that goes on after its failure.
    pub work: Option<ContactWork>,
    /// Pressure at the largest force, its mean over that force, Pa.
    pub mean_pressure_pa: f64,
}

/// Work of slider and disk on the asperities in an episode of contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ContactWork {
    /// In the steps in which it was positive, and what they held as the episode began, J.
    pub loading_j: f64,
    /// What they gave back in the others, J.
    pub unloading_j: f64,
}

/// Contact of slider and disk over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SliderContact {
    /// Its episodes, in order.
    pub episodes: Vec<SliderEpisode>,
    /// Time of the first touch, where the clearance fell below the limit, s.
    pub touched_s: Option<f64>,
    /// The last one goes on at the end of the run.
    pub goes_on: bool,
    /// Work that yielded asperities do not give back, J.
    pub yielded_j: f64,
    /// Energy of slider and suspension, of a run that goes on after its failure.
    pub energy: Option<HeadEnergy>,
}

/// Energy balance of slider and suspension over a run, beyond the energy of steady flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct HeadEnergy {
    /// Kinetic and elastic at the onset, J: 0 without run-out.
    pub start_j: f64,
    /// At the end, J.
    pub kinetic_j: f64,
    /// At the end, in modes, gimbal, dimple, limiters and lift tab, J.
    pub elastic_j: f64,
    /// Largest sum of both, J.
    pub peak_j: f64,
    /// Work of the shock's inertia load, and of a pivot that moves, J.
    pub shock_work_j: f64,
    /// Work on the slider of what acts in the gap beside the asperities, less the whole steady force, J.
    pub film_work_j: f64,
    /// Work of the asperities' pressure on the slider, J.
    pub contact_work_j: f64,
    /// Work of their friction's couple on the slider, J; not the heat of [`SliderEpisode::friction_j`].
    pub friction_work_j: f64,
    /// Loss in dampers, J.
    pub damping_loss_j: f64,
    /// Gain of energy and losses less works, J: the error of the time integration and of the works' own integration.
    pub imbalance_j: f64,
}

/// Columns at the head's accepted steps and at its failure; a run that stops there ends with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadColumns {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Rise of the slider's centre from its steady place, m, in the base's frame.
    pub slider_z_m: Vec<f64>,
    /// Pitch in the base's frame, steady pitch included, rad.
    pub slider_pitch_rad: Vec<f64>,
    /// Roll in the base's frame, steady roll included, rad.
    pub slider_roll_rad: Vec<f64>,
    /// Smallest clearance, m.
    pub min_clearance_m: Vec<f64>,
    /// Force of the air above ambient pressure on the slider, N; positive: away from the disk. Other forces in the gap
    /// are not part of it, nor of the moments.
    pub bearing_force_n: Vec<f64>,
    /// Moment of the air about the slider's centre, N m; positive: raises the leading edge.
    pub bearing_pitch_n_m: Vec<f64>,
    /// The same; positive: raises the outer side.
    pub bearing_roll_n_m: Vec<f64>,
    /// Contact force of the dimple, N.
    pub dimple_force_n: Vec<f64>,
    /// Contact force of the limiters together, N; empty without limiters.
    pub limiter_force_n: Vec<f64>,
    /// Contact force of the lift tab, N; empty without one.
    pub lift_tab_force_n: Vec<f64>,
    /// Force of the asperities on the slider, N; empty without their contact.
    pub asperity_force_n: Vec<f64>,
}

/// Cost of a run, and diagnostics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadCost {
    /// Accepted steps.
    pub steps: u64,
    /// Steps rejected for their error, their approach or a stage that did not converge.
    pub rejected: u64,
    /// Evaluations of the film's flux balance.
    pub film_residuals: u64,
    /// Right-hand sides solved with the film's factors.
    pub film_solves: u64,
    /// Film factorisations.
    pub factorisations: u64,
    /// Evaluations of the film's Jacobian.
    pub linearisations: u64,
    /// Largest estimated error of a stage solve at acceptance, relative to the clearance.
    pub max_residual: f64,
    /// Smallest film pressure, Pa.
    pub min_pressure_pa: f64,
    /// Largest net mass that a stage failed to balance, relative to the film's mass then. Of little meaning where the
    /// film is tens of micrometres thick and its gas changes many times a step.
    pub mass_balance_error: f64,
}

impl Default for HeadCost {
    fn default() -> Self {
        Self {
            steps: 0,
            rejected: 0,
            film_residuals: 0,
            film_solves: 0,
            factorisations: 0,
            linearisations: 0,
            max_residual: 0.0,
            min_pressure_pa: f64::INFINITY,
            mass_balance_error: 0.0,
        }
    }
}

/// All results of one run of the head.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadRun {
    /// Verdict.
    pub verdict: Verdict,
    /// Smallest clearance met up to the first touch, between steps too, m; the limit when there is one.
    pub min_clearance_m: f64,
    /// Its time, s.
    pub t_min_clearance_s: f64,
    /// Its place on the slider.
    pub place: Place,
    /// Attitude of the slider over the disk then.
    pub lowest: Attitude,
    /// Time up to which the head was simulated, s.
    pub end_s: f64,
    /// What ended a run before its window, after its first touch.
    pub broke_off: Option<Cause>,
    /// Dimple.
    pub dimple: DimpleRecord,
    /// Limiters, if there are any.
    pub limiters: Option<StopRecord>,
    /// Lift tab, if there is one.
    pub lift_tab: Option<StopRecord>,
    /// Contact with the disk over the whole run, of a scene with contact of asperities.
    pub slider_contact: Option<SliderContact>,
    /// Histories, when requested.
    pub columns: Option<HeadColumns>,
    /// Pressure fields, when the head is set to keep them.
    pub fields: Option<PressureFields>,
    /// Cost.
    pub cost: HeadCost,
}

/// Film pressure and height at the requested times that a run reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PressureFields {
    /// Grid lines along the slider from its leading edge, m.
    pub x_lines_m: Vec<f64>,
    /// Grid lines across the slider from its inner edge, m.
    pub y_lines_m: Vec<f64>,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Absolute pressure in the middle of every cell, Pa: time, then y, then x, which runs fastest.
    pub pressure_pa: Vec<f64>,
    /// Height of the slider's surface over the disk there, m, in the same order; the film itself sees at least the
    /// minimum film height.
    pub gap_m: Vec<f64>,
}

impl PressureFields {
    /// Cells of one field.
    pub fn n_cells(&self) -> usize {
        let cells = |lines: &[f64]| lines.len().saturating_sub(1);
        cells(&self.x_lines_m) * cells(&self.y_lines_m)
    }
}
