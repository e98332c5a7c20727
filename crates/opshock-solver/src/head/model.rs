//! The immutable model of one head: film, slider, gimbal and suspension, ready to run shocks.

use std::sync::Arc;

use thiserror::Error;

use super::damage::DamageLimits;
use super::mechanics::Mechanics;
use super::outcome::Place;
use super::resolution::HeadResolution;
use crate::air_bearing::steady::Flight;
use crate::air_bearing::{Attitude, Film};
use crate::disk::{DiskPose, SurfaceMotion};
use crate::integrator::{TR_BDF2, Tableau};
use crate::shock::{BaseMotion, Pulse};
use crate::slider::SliderParameters;
use crate::suspension::{ReducedSuspension, SuspensionError, SuspensionParameters};

/// Why a head cannot be built.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum HeadError {
    /// The suspension cannot be built.
    #[error(transparent)]
    Suspension(#[from] SuspensionError),
    /// A number of the resolution is out of its range.
    #[error("{quantity} must be positive and finite, found {value}")]
    NotPositive {
        /// Which one.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The mass matrix of slider and suspension is singular.
    #[error("the mass matrix of slider and suspension is singular")]
    SingularMass,
    /// The steady clearance is already below the failure limit.
    #[error(
        "steady clearance {min_clearance_m:e} m is not above the failure limit {fail_below_m:e} m"
    )]
    StartsFailed {
        /// Steady clearance, m.
        min_clearance_m: f64,
        /// Where on the slider it is.
        place: Place,
        /// Failure limit, m.
        fail_below_m: f64,
    },
    /// The slider cannot follow the disk's run-out and waviness.
    #[error(
        "run-out and waviness take {lost:.2} of what the slider can lose of clearance or gas before the shock"
    )]
    RunOut {
        /// Share of the clearance above the failure limit, or of half of a cell's gas, that the waves take.
        lost: f64,
    },
    /// The flight has another number of cells than the film.
    #[error("the flight has {flight} cells, the film {film}")]
    CellMismatch {
        /// Cells of the flight.
        flight: usize,
        /// Cells of the film.
        film: usize,
    },
}

/// A shock: unit pulse and signed amplitude.
#[derive(Clone, Copy, Debug)]
pub struct ShockLoad<'a> {
    /// Unit pulse.
    pub pulse: &'a Pulse,
    /// Inertia load per mass at the pulse's peak, m/s2.
    pub amplitude_m_per_s2: f64,
    /// Motion of the base, when it vibrates: the suspension's pivot moves with it, and the disk's motion is relative to
    /// the pivot.
    pub base: Option<&'a BaseMotion>,
}

impl ShockLoad<'_> {
    /// Inertia load per mass that the suspension feels at `time_s`, m/s2.
    pub(super) fn value(&self, time_s: f64) -> f64 {
        self.amplitude_m_per_s2 * self.unit(time_s, time_s)
    }

    /// Displacement of the pivot relative to the rigid base by that load, m.
    pub(super) fn carried_m(&self, time_s: f64) -> f64 {
        let unit = self.base.map_or(0.0, |base| base.displacement(time_s)[0]);
        self.amplitude_m_per_s2 * unit
    }

    /// [`Self::value`] from the right.
    pub(super) fn just_after(&self, time_s: f64) -> f64 {
        self.amplitude_m_per_s2 * self.unit(time_s, right_of(time_s))
    }

    /// Jump of [`Self::value`].
    pub(super) fn jump(&self, time_s: f64) -> f64 {
        let jump = self.unit(time_s, right_of(time_s)) - self.unit(time_s, time_s);
        jump * self.amplitude_m_per_s2
    }

    /// Load per unit amplitude, the pulse taken at `pulse_s`.
    fn unit(&self, time_s: f64, pulse_s: f64) -> f64 {
        let pulse = self.pulse.value(pulse_s);
        match self.base {
            None => pulse,
            Some(base) => base.load(time_s, pulse),
        }
    }
}

fn right_of(time_s: f64) -> f64 {
    time_s * (1.0 + 1e-12) + f64::MIN_POSITIVE
}

/// Film, slider, gimbal and suspension of one head, ready to run any shock.
#[derive(Clone, Debug)]
pub struct HeadModel {
    pub(super) film: Arc<Film>,
    pub(super) flight: Arc<Flight>,
    pub(super) suspension: ReducedSuspension,
    pub(super) mechanics: Mechanics,
    pub(super) resolution: HeadResolution,
    pub(super) tableau: Tableau,
    pub(super) fail_below_m: f64,
    /// What fails in place of the first touch; none by default.
    pub(super) damage: Option<DamageLimits>,
    /// Film force of the steady state, which the load balances.
    pub(super) steady_force: [f64; 3],
    pub(super) steady_clearance_m: f64,
    /// Change of the clearance at the slider's ends per attitude: 1, L/2, W/2.
    pub(super) arms: [f64; 3],
    /// Stiffness of the film against heave, N/m; converts force errors into gap errors.
    pub(super) film_n_per_m: f64,
    /// Converts velocity errors into gap errors: 1/ω of the slider on its film, s.
    pub(super) velocity_to_gap_s: f64,
    /// Times at which pressure fields are kept, ascending, s; none by default.
    pub(super) field_times_s: Vec<f64>,
    /// Run-out and waviness of the disk's surface; none by default.
    pub(super) following: Option<Following>,
}

/// The surface's motion and the state at the onset: ψ, coordinates, velocities.
#[derive(Clone, Debug)]
pub(super) struct Following {
    pub surface: SurfaceMotion,
    pub start: Vec<f64>,
}

impl HeadModel {
    /// Assembles the head of `slider` on `suspension`, flying in `film` as `flight` says.
    ///
    /// # Errors
    /// A suspension that cannot be built, a resolution out of range, a steady state that is
    /// already below `fail_below_m`.
    pub fn build(
        suspension: &SuspensionParameters,
        slider: &SliderParameters,
        film: Arc<Film>,
        flight: Arc<Flight>,
        resolution: &HeadResolution,
        fail_below_m: f64,
    ) -> Result<Self, HeadError> {
        for (quantity, value) in [
            ("head tolerance", resolution.tolerance),
            ("approach share", resolution.approach_share),
            ("coupling tolerance", resolution.coupling_tolerance),
            ("slider density", slider.density_kg_per_m3),
            ("slider height", slider.height_m),
            ("gram load", suspension.gram_load_n),
            ("steady dimple force", suspension.steady_dimple_force_n()),
            ("dimple stiffness", suspension.dimple.stiffness_n_per_m),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(HeadError::NotPositive { quantity, value });
            }
        }
        let limiters = suspension.limiters.iter().map(|limiter| &limiter.contact);
        let tab = suspension.lift_tab.iter().map(|tab| &tab.contact);
        for law in limiters.chain(tab) {
            let value = law.stiffness_n_per_m;
            if !(value > 0.0 && value.is_finite()) {
                let quantity = "stiffness of a limiter or lift tab";
                return Err(HeadError::NotPositive { quantity, value });
            }
        }
        if flight.psi.len() != film.n_cells() {
            return Err(HeadError::CellMismatch {
                flight: flight.psi.len(),
                film: film.n_cells(),
            });
        }
        let reduced = ReducedSuspension::build(suspension, resolution.suspension_modes)?;
        let mechanics =
            Mechanics::new(suspension, &reduced, slider).ok_or(HeadError::SingularMass)?;
        let steady = film.min_clearance(&flight.attitude);
        let steady_clearance_m = steady.value_m;
        let flies = steady_clearance_m > fail_below_m;
        if !flies {
            return Err(HeadError::StartsFailed {
                min_clearance_m: steady_clearance_m,
                place: Place {
                    x_m: steady.x_m,
                    y_m: steady.y_m,
                },
                fail_below_m,
            });
        }
        let film_n_per_m = flight.stiffness[0][0].abs();
        let mass = slider.density_kg_per_m3 * slider.length_m * slider.width_m * slider.height_m;
        Ok(Self {
            suspension: reduced,
            mechanics,
            resolution: resolution.clone(),
            tableau: TR_BDF2,
            fail_below_m,
            damage: None,
            steady_force: film.force(&flight.psi, &flight.attitude, &mut film.scratch()),
            steady_clearance_m,
            arms: [1.0, 0.5 * slider.length_m, 0.5 * slider.width_m],
            film_n_per_m,
            velocity_to_gap_s: (mass / film_n_per_m).sqrt(),
            field_times_s: Vec::new(),
            following: None,
            film,
            flight,
        })
    }

    /// The same head with another integration scheme than the default one.
    #[must_use]
    pub fn with_tableau(mut self, tableau: Tableau) -> Self {
        self.tableau = tableau;
        self
    }

    /// The same head, which fails by damage and not by its first touch where there are limits.
    #[must_use]
    pub fn with_damage(mut self, limits: Option<DamageLimits>) -> Self {
        self.damage = limits;
        self
    }

    /// The same head whose recorded runs keep the film's pressure and height at `times_s` after
    /// the onset, in any order.
    #[must_use]
    pub fn with_fields(mut self, times_s: &[f64]) -> Self {
        self.field_times_s = times_s.to_vec();
        self.field_times_s.sort_by(f64::total_cmp);
        self
    }

    /// The suspension's reduced model.
    pub fn suspension(&self) -> &ReducedSuspension {
        &self.suspension
    }

    /// Smallest clearance of the steady state, m.
    pub fn steady_clearance_m(&self) -> f64 {
        self.steady_clearance_m
    }

    /// Unknowns of a step: cells, coordinates, velocities.
    pub fn n_unknowns(&self) -> usize {
        self.film.n_cells() + 2 * self.mechanics.len()
    }

    /// Attitude over the disk with the slider displaced by `x` and the disk posed at `pose`.
    #[inline]
    pub(super) fn attitude(&self, x: &[f64], pose: &DiskPose) -> Attitude {
        let steady = &self.flight.attitude;
        Attitude {
            centre_height_m: steady.centre_height_m + x[0] - pose.displacement_m,
            pitch_rad: steady.pitch_rad + x[1] - pose.pitch_rad,
            roll_rad: steady.roll_rad + x[2] - pose.roll_rad,
        }
    }

    /// Gap that changes by at most this much when the slider's coordinates change by `dx`, m.
    #[inline]
    pub(super) fn gap_change(&self, dx: &[f64]) -> f64 {
        self.arms.iter().zip(dx).map(|(arm, d)| arm * d.abs()).sum()
    }

    /// Clearance to which errors are relative, m: the clearance plus twice the minimum film height, below which the
    /// film no longer distinguishes heights.
    #[inline]
    pub(super) fn gap_scale(&self, clearance_m: f64) -> f64 {
        clearance_m.max(0.0) + 2.0 * self.film.min_height_m()
    }
}
