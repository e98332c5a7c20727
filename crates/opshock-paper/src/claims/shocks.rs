//! Runs the paper's two shocks with its three ramp models.

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::Levels;
use opshock_solver::scene::plan::{Needs, Plan};
use opshock_solver::simulation::{
    HeadColumns, Model, Outcome, Request, StructureColumns, Workspace, simulate,
};
use opshock_solver::structure::modes;
use opshock_study::study::memory::Demand;
use opshock_study::study::{Choice, ChoiceError, Point, Ramp, Sign, Study};
use std::sync::Arc;

/// Width, ms, and amplitude, G, of a shock of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperShock {
    /// Width, ms.
    pub pulse_ms: f64,
    /// Amplitude, G.
    pub amplitude_g: f64,
}

/// Section 4.1.
pub const LONG: PaperShock = PaperShock {
    pulse_ms: 2.0,
    amplitude_g: 400.0,
};
/// Section 4.2.
pub const SHORT: PaperShock = PaperShock {
    pulse_ms: 0.5,
    amplitude_g: 200.0,
};

/// The numbers cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum ShockError {
    /// The study does not give the shock.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// The scene cannot be simulated.
    #[error("{label}: {reason}")]
    Scene {
        /// Point.
        label: String,
        /// The solver's sentence.
        reason: String,
    },
}

/// One run with its histories. Times are after the onset, s.
#[derive(Clone, Debug)]
pub struct Case {
    /// What was simulated: the head goes on after a touch, at the minimum film height (a regularisation).
    pub outcome: Outcome,
    /// Onset on the study's axis, s.
    pub start_s: f64,
    /// Width, s.
    pub width_s: f64,
    /// Amplitude, m/s2.
    pub amplitude_m_per_s2: f64,
    /// Frequency of the disk's axisymmetric mode without circles, Hz.
    pub first_mode_hz: f64,
}

impl Case {
    /// Histories of disk and ramp.
    pub fn disk(&self) -> &StructureColumns {
        &self.history().structure
    }

    /// Histories of the head.
    pub fn head(&self) -> &HeadColumns {
        &self.history().head
    }

    fn history(&self) -> &opshock_solver::simulation::History {
        self.outcome.history.as_ref().expect("recorded when run")
    }
}

/// Runs of one shock.
#[derive(Clone, Debug)]
pub struct Three {
    /// Without a ramp.
    pub none: Arc<Case>,
    /// With the rigid ramp.
    pub rigid: Arc<Case>,
    /// With the deformable ramp.
    pub deformable: Arc<Case>,
}

/// Both shocks with every ramp.
#[derive(Clone, Debug)]
pub struct Shocks {
    /// 400 G, 2 ms.
    pub long: Three,
    /// 200 G, 0.5 ms.
    pub short: Three,
}

/// A run that is yet to be made: independent of all others.
pub struct Task {
    plan: Plan,
    point: Point,
    scene: Scene,
    amplitude_g: f64,
    start_s: f64,
}

impl Shocks {
    /// The six runs of a study with some discretisation parameters refined or coarsened: long, then short, each
    /// without, with the rigid and with the deformable ramp.
    ///
    /// # Errors
    ///
    /// The study leaves an axis open.
    pub fn tasks(study: &Study, levels: Levels) -> Result<Vec<Task>, ShockError> {
        Self::planned(study, &study.plan().past_touch(), levels)
    }

    /// The same runs by another plan; without a head, statements about it have no number.
    ///
    /// # Errors
    ///
    /// As [`Shocks::tasks`].
    pub fn planned(study: &Study, plan: &Plan, levels: Levels) -> Result<Vec<Task>, ShockError> {
        let mut tasks = Vec::new();
        for shot in [LONG, SHORT] {
            for ramp in [Ramp::None, Ramp::Rigid, Ramp::Deformable] {
                let point = study.select_point(&Choice {
                    ramp: Some(ramp),
                    pulse_ms: Some(shot.pulse_ms),
                    sign: Some(Sign::Plus),
                    amplitude_g: None,
                })?;
                tasks.push(Task {
                    plan: plan.clone(),
                    scene: point.scene.at_levels(levels),
                    point,
                    amplitude_g: shot.amplitude_g,
                    start_s: study.start_s,
                });
            }
        }
        Ok(tasks)
    }

    /// The six runs in the order of [`Shocks::tasks`].
    pub fn cases(&self) -> impl Iterator<Item = Arc<Case>> + '_ {
        [&self.long, &self.short]
            .into_iter()
            .flat_map(|three| [&three.none, &three.rigid, &three.deformable])
            .cloned()
    }

    /// The runs of [`Shocks::tasks`] in their order.
    ///
    /// # Panics
    ///
    /// Unless there are six.
    pub fn of(cases: Vec<Arc<Case>>) -> Shocks {
        let mut cases = cases.into_iter();
        let mut three = || {
            let mut next = || cases.next().expect("six runs");
            Three {
                none: next(),
                rigid: next(),
                deformable: next(),
            }
        };
        Shocks {
            long: three(),
            short: three(),
        }
    }
}

impl Task {
    /// The scene, to recognise equal runs.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Memory that it takes.
    pub fn demand(&self) -> Demand {
        Demand::run(&self.scene, &self.plan, true)
    }

    /// Onset of the pulse on the study's axis, s.
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    /// Runs it.
    ///
    /// # Errors
    ///
    /// The scene has no answer, as a slider without steady flight.
    pub fn run(&self) -> Result<Case, ShockError> {
        self.run_after(&mut Vec::new())
    }

    /// Runs it with parts of earlier models where they are the same, and adds its own.
    ///
    /// # Errors
    ///
    /// As [`Task::run`].
    pub fn run_after(&self, models: &mut Vec<Model>) -> Result<Case, ShockError> {
        let refused = |reason: String| ShockError::Scene {
            label: self.point.label(),
            reason,
        };
        let model = Model::assemble(&self.scene, &self.plan, models.iter())
            .map_err(|error| refused(error.to_string()))?;
        let amplitude_m_per_s2 = m_per_s2_from_g(self.amplitude_g);
        let request = Request {
            amplitude_m_per_s2,
            record: true,
        };
        let outcome = simulate(&model, &request, &mut Workspace::default());
        models.push(model);
        if outcome
            .history
            .as_ref()
            .is_none_or(|h| self.plan.needs == Needs::Head && h.head.time_s.is_empty())
        {
            return Err(refused(format!("{:?}", outcome.verdict)));
        }
        let table = modes(
            &self.scene.disk,
            &self.scene.disk_resolution,
            &self.scene.ramp,
        )
        .map_err(|error| refused(error.to_string()))?;
        let first = table
            .disk
            .iter()
            .find(|mode| mode.nodal_diameters == 0 && mode.nodal_circles == 0);
        Ok(Case {
            outcome,
            start_s: self.start_s,
            width_s: self.scene.pulse.width_s,
            amplitude_m_per_s2,
            first_mode_hz: first.map_or(f64::NAN, |mode| mode.rotating_frame_hz),
        })
    }

    /// The same run seen from another onset.
    #[must_use]
    pub fn shifted(&self, case: &Case) -> Case {
        Case {
            start_s: self.start_s,
            ..case.clone()
        }
    }
}
