//! Data that all runs of one structural model share.

use super::driven::Driven;
use super::error::StructureError;
use super::free_motion::FreeMotion;
use super::history::StructuralHistory;
use super::outcome::StructureWarning;
use super::parameters::{ContactMethod, Window};
use super::rotor::Rotor;
use super::sample::{Sample, unit_gap};
use super::span::{INTERVAL_NODES, Span};
use crate::complementarity::{self, Gap, ImpactLaw};
use crate::disk::DiskPose;
use crate::shock::Pulse;
use std::sync::LazyLock;

/// The contact-driven modes, or why they cannot be built.
pub(super) type Inactive = Result<Driven, StructureError>;

/// Free motion, ramp and time grid; the contact-driven modes stay inactive until a run needs them.
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
    /// Modes of both arms in the bank; on a base the rotor carries more.
    pub n_arm_modes: usize,
    /// Pitch and roll per radial slope.
    pub slope_to_pose: [f64; 2],
    /// Reported by every run.
    pub warnings: Vec<StructureWarning>,
    pub inactive: LazyLock<Inactive, Box<dyn FnOnce() -> Inactive + Send>>,
}

impl Shared {
    /// The contact-driven modes, built at the first call.
    ///
    /// # Errors
    /// A failed eigenvalue problem of a harmonic n >= 1.
    pub fn driven(&self) -> Result<&Driven, StructureError> {
        self.inactive.as_ref().map_err(Clone::clone)
    }

    /// Gap of `side` at node `k` in free motion.
    pub fn free_gap(&self, side: usize, amplitude: f64, sample: &Sample) -> Gap {
        let unit = unit_gap(side, sample);
        Gap {
            value_m: self.clearance_m[side] + amplitude * unit.value_m,
            rate_m_per_s: amplitude * unit.rate_m_per_s,
        }
    }

    /// Pose and rate of the disk relative to the pivot in the unit response alone. The contact-driven motion of the
    /// pivot is kept separately ([`StructuralHistory`]): impulses make its velocity jump, which no load b(t) on the
    /// head can express.
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

    /// An empty history for `n_nodes`: of the disk under the slider, and of the contact-driven motion of the pivot of a
    /// vibrating base.
    pub fn history(&self, n_nodes: usize) -> StructuralHistory {
        let empty = || StructuralHistory {
            step_s: self.free.step_s,
            pose: Vec::with_capacity(n_nodes),
            rate: Vec::with_capacity(n_nodes),
            ..StructuralHistory::default()
        };
        let rotor = self.free.rotor.as_ref();
        StructuralHistory {
            events_s: vec![0.0],
            pivot: rotor
                .is_some_and(Rotor::has_pivot)
                .then(|| Box::new(empty())),
            ..empty()
        }
    }

    /// First step in which free motion closes a gap; the number of steps when none does.
    pub fn first_touching_step(&self, amplitude: f64) -> usize {
        if self.n_contacts == 0 {
            return self.n_steps;
        }
        let contact_free_intervals = (0..).zip(&self.free.spans);
        contact_free_intervals
            .filter(|(_, span)| !self.stays_open(amplitude, span))
            .find_map(|(i, _)| {
                let first = i * INTERVAL_NODES;
                let mut steps = first..(first + INTERVAL_NODES).min(self.n_steps);
                steps.find(|&k| self.may_touch(amplitude, k))
            })
            .unwrap_or(self.n_steps)
    }

    /// Whether free motion leaves both gaps open over a whole interval.
    fn stays_open(&self, amplitude: f64, span: &Span) -> bool {
        (0..self.n_contacts).all(|side| {
            let change_m = span.gaps[side].times(amplitude);
            self.clearance_m[side] + change_m.low > self.law.gap_tolerance_m
        })
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
