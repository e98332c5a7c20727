//! Builds the immutable model of one scene, and shares parts between models.

use std::sync::Arc;

use thiserror::Error;

use crate::air_bearing::steady::{Flight, SteadyError, fly};
use crate::air_bearing::{CorrectionForces, Film, FilmError};
use crate::head::{HeadError, HeadModel};
use crate::mutant;
use crate::scene::Scene;
use crate::scene::plan::{Decision, Mode, Needs, Output, Plan, Touch};
use crate::simulation::kept_corrections::kept_or;
use crate::structure::{StructureError, StructureModel};

/// Why a scene cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// Disk, ramp, pulse or window.
    #[error("structure: {0}")]
    Structure(#[from] StructureError),
    /// Film.
    #[error("air bearing: {0}")]
    Film(#[from] FilmError),
    /// The slider finds no steady flying state.
    #[error("steady flight: {0}")]
    Steady(#[from] SteadyError),
    /// Suspension or head.
    #[error("head: {0}")]
    Head(#[from] HeadError),
}

/// Whether a question needs disk and ramp alone or the head as well: short for the plan of one output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Disk and ramp alone: displacements and contact forces.
    Structure,
    /// Disk, ramp and head: clearance and verdict.
    Full,
}

impl Scope {
    /// The plan it stands for.
    pub fn plan(self) -> Plan {
        let output = match self {
            Scope::Structure => Output::DiskDisplacement,
            Scope::Full => Output::CriticalShock,
        };
        Plan::new(&[output], Mode::Auto)
    }
}

/// Film and steady flight of one slider.
#[derive(Clone, Debug)]
pub struct Bearing {
    /// Discrete film.
    pub film: Arc<Film>,
    /// Steady flying state under the gram load.
    pub flight: Arc<Flight>,
    /// Defect correction of the film; `None` without one.
    pub reference: Option<Arc<CorrectionForces>>,
}

impl Bearing {
    /// Builds the film of `scene` and finds its steady flying state. Its defect correction is that of `known`, a
    /// bearing for which [`Bearing::has_reference`] holds, or is [kept](super::keep_corrections), or is sampled.
    ///
    /// # Errors
    /// [`BuildError::Film`], [`BuildError::Steady`].
    pub fn build(scene: &Scene, known: Option<&Self>) -> Result<Self, BuildError> {
        let reference = match known.and_then(|known| known.reference.clone()) {
            _ if scene.film_resolution.correction_cells == 0 => None,
            Some(known) => Some(known),
            None => Some(Arc::new(kept_or(scene, correction_forces)?)),
        };
        let plain = scene.film()?;
        let load = [scene.suspension.gram_load_n, 0.0, 0.0];
        let film = match &reference {
            Some(reference) => plain.corrected_by(reference)?,
            None => plain,
        };
        let flight = fly(&film, load)?;
        Ok(Self {
            film: Arc::new(film),
            flight: Arc::new(flight),
            reference,
        })
    }

    /// Whether two scenes have the same film and the same steady flight.
    pub fn is_shared(a: &Scene, b: &Scene) -> bool {
        let cells = a.film_resolution.cells == b.film_resolution.cells;
        Self::has_reference(a, b) && all_agree([("R9 film cells", cells)])
    }

    /// Whether the same defect correction holds for two scenes, whatever their numbers of cells.
    pub fn has_reference(a: &Scene, b: &Scene) -> bool {
        let [one, other] = [a, b].map(|scene| {
            let film = &scene.film_resolution;
            (film.min_height_m, film.correction_cells)
        });
        all_agree([
            ("R9 slider", a.slider == b.slider),
            ("R9 gas", a.gas == b.gas),
            ("R9 flow model", a.flow == b.flow),
            ("R9 gap forces", a.gap_forces == b.gap_forces),
            ("R9 film reference", one == other),
            ("R9 speed", a.disk.spin_rad_per_s == b.disk.spin_rad_per_s),
            (
                "R9 gram load",
                a.suspension.gram_load_n == b.suspension.gram_load_n,
            ),
        ])
    }
}

/// A scene made ready to simulate any amplitude of either sign.
#[derive(Clone)]
pub struct Model {
    pub(super) scene: Scene,
    pub(super) structure: StructureModel,
    pub(super) head: Option<HeadModel>,
    bearing: Option<Bearing>,
    plan: Plan,
    /// Identifies the model that scratch was made for; clones are the same model.
    pub(super) identity: Arc<()>,
}

impl Model {
    /// Disk, ramp and head of `scene`: [`Model::build`] with nothing to share.
    ///
    /// # Errors
    /// [`BuildError`] names the part and the quantity.
    pub fn new(scene: &Scene) -> Result<Self, BuildError> {
        Self::build(scene, Scope::Full, None)
    }

    /// Builds the part `scope` of `scene`; see [`Model::assemble`].
    ///
    /// # Errors
    /// [`BuildError`] names the part and the quantity.
    pub fn build(
        scene: &Scene,
        scope: Scope,
        shared_model: Option<&Model>,
    ) -> Result<Self, BuildError> {
        Self::assemble(scene, &scope.plan(), shared_model)
    }

    /// Builds what `plan` needs of `scene`, and reads nothing else of it.
    ///
    /// The structure, or film and steady flight, are taken from a model of another scene when they would be the same
    /// and the plan shares them: the first of `shared_models` that has the part. Building is deterministic, so the
    /// numbers do not depend on it.
    ///
    /// # Errors
    /// [`BuildError`] names the part and the quantity.
    pub fn assemble<'a>(
        scene: &Scene,
        plan: &Plan,
        shared_models: impl IntoIterator<Item = &'a Model>,
    ) -> Result<Self, BuildError> {
        let shared_models: Vec<&Model> = match plan.shares_parts {
            true => shared_models.into_iter().collect(),
            false => Vec::new(),
        };
        let structure = match shared_models
            .iter()
            .find(|other| other.has_structure(scene, plan))
        {
            Some(other) => other.structure.clone(),
            None => build_structure(scene, plan)?,
        };
        let bearing = match plan.needs >= Needs::Flight {
            true => Some(bearing(scene, &shared_models)?),
            false => None,
        };
        let head = match &bearing {
            Some(bearing) if plan.needs >= Needs::Head => {
                let head = HeadModel::build(
                    &scene.suspension,
                    &scene.slider,
                    Arc::clone(&bearing.film),
                    Arc::clone(&bearing.flight),
                    &scene.head_resolution,
                    scene.fail_below_m,
                )?;
                let head = head
                    .with_damage(scene.damage)
                    .with_fields(&plan.field_times_s);
                Some(match scene.surface_motion() {
                    Some(surface) => head.with_run_out(surface)?,
                    None => head,
                })
            }
            _ => None,
        };
        Ok(Self {
            scene: scene.clone(),
            structure,
            head,
            bearing,
            plan: plan.clone(),
            identity: Arc::new(()),
        })
    }

    /// Whether `scene` under `plan` has the same disk, ramp, pulse and window, and the slider at
    /// the same place: the same structural history at every amplitude.
    pub fn has_structure(&self, scene: &Scene, plan: &Plan) -> bool {
        let own = &self.scene;
        let place = own.structure().slider == scene.structure().slider;
        let steps = own.structure_resolution == scene.structure_resolution;
        all_agree([
            ("R9 disk", own.disk == scene.disk),
            (
                "R9 disk modes",
                own.disk_resolution == scene.disk_resolution,
            ),
            ("R9 ramp", own.ramp == scene.ramp),
            ("R9 pulse", own.pulse == scene.pulse),
            ("R9 direction", own.oblique == scene.oblique),
            ("R9 base", own.base == scene.base),
            ("R9 window", own.window == scene.window),
            ("R9 structure steps", steps),
            ("R9 slider's place", place),
        ]) && self.plan.activation == plan.activation
            && self.plan.needs == plan.needs
    }

    /// The plan it was built by.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The plan's rules R1 to R10 with the numbers of this model, for a shock of signed amplitude
    /// or, with `None`, for any.
    pub fn decisions(&self, amplitude_m_per_s2: Option<f64>) -> Vec<Decision> {
        let threshold = |positive| self.structure.touch_amplitude_m_per_s2(positive);
        let touch = Touch {
            amplitude_m_per_s2,
            threshold_m_per_s2: [threshold(true), threshold(false)],
        };
        self.plan.decisions(&self.scene, &touch)
    }

    /// The scene it was built from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The structural half.
    pub fn structure(&self) -> &StructureModel {
        &self.structure
    }

    /// The head, when it was built.
    pub fn head(&self) -> Option<&HeadModel> {
        self.head.as_ref()
    }

    /// Film and steady flight, when they were built.
    pub fn bearing(&self) -> Option<&Bearing> {
        self.bearing.as_ref()
    }
}

/// Whether every named condition of sharing holds.
fn all_agree<const N: usize>(conditions: [(&str, bool); N]) -> bool {
    let mut all = conditions.iter();
    all.all(|(name, holds)| *holds || mutant::is_on(name))
}

/// Disk and ramp of `scene` as `plan` needs them.
fn build_structure(scene: &Scene, plan: &Plan) -> Result<StructureModel, StructureError> {
    let structure = StructureModel::build(&scene.structure(), plan.harmonics(scene))?;
    let structure = structure.with_activation(plan.activation);
    Ok(match plan.needs {
        Needs::Head => structure,
        Needs::Structure | Needs::Flight => structure.without_motion(),
    })
}

/// Share of the load a film can carry at which it is sampled if it cannot carry that of the scene.
const OF_CARRIED: f64 = 0.95;

/// Defect correction of every grid of the film of `scene`.
fn correction_forces(scene: &Scene) -> Result<CorrectionForces, BuildError> {
    let film = scene
        .with_film_cells(scene.film_resolution.correction_cells)
        .film()?;
    let finer = scene.film_cut_in_two(&film)?;
    let fly_under = |load_n| fly(&film, [load_n, 0.0, 0.0]);
    let flight = match fly_under(scene.suspension.gram_load_n) {
        // The corrected film decides whether the slider flies; its correction is sampled near the last equilibrium.
        Err(SteadyError::CannotFly { carried_n, .. }) => fly_under(OF_CARRIED * carried_n)?,
        flight => flight?,
    };
    Ok(CorrectionForces::sample(&film, &finer, &flight)?)
}

/// Film and steady flight of `scene`: those of a shared model when they are the same.
fn bearing(scene: &Scene, shared_models: &[&Model]) -> Result<Bearing, BuildError> {
    let shared = shared_models
        .iter()
        .filter(|other| Bearing::is_shared(scene, &other.scene))
        .find_map(|other| other.bearing.clone());
    let known = shared_models
        .iter()
        .filter(|other| Bearing::has_reference(scene, &other.scene))
        .find_map(|other| other.bearing.as_ref());
    match shared {
        Some(bearing) => Ok(bearing),
        None => Bearing::build(scene, known),
    }
}
