//! The simulator of a sweep: builds models of the study's scenes and runs shocks on them.
//!
//! Points with the same scene (the two signs) share one model; models share structure, or film and steady flight, where
//! those are the same, and points that differ in the head alone share structural histories. Models are made when first
//! needed. None of this changes the numbers: building is deterministic and a model never changes. With `effects =
//! "full"` nothing is shared: every simulation builds its own model.

use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_solver::scene::plan::{Mode, Plan};
use opshock_solver::simulation::{
    Bearing, BuildError, Going, HeadState, Model, Outcome, Request, Workspace, run_structure,
    simulate_head_on,
};

use super::latest::Latest;
use super::probed::{not_built, probe_result};
use super::simulator::{Onset, Simulator};
use super::structure_run_cache::{Counts, StructureRunCache};
use crate::identity;
use crate::provenance::PHYSICS_STRUCTURE;
use crate::search::{Probe, ProbeResult, Retry};
use crate::study::{Point, RemeshedRamp, Study};

type Built = Result<Arc<Model>, BuildError>;

/// Models of one scene.
struct Entry {
    scene: Scene,
    /// Its ramp on other meshes.
    remeshed: Option<RemeshedRamp>,
    plain: OnceLock<Built>,
    /// The model of the doubled window, kept while both signs may need it.
    longer: Mutex<Option<Arc<Model>>>,
}

impl Entry {
    /// The scene at other refinement levels, of the ramp's mesh, too.
    fn at_levels(&self, levels: Levels) -> Scene {
        let mut scene = self.scene.at_levels(levels);
        let mesh = levels.of(Discretisation::RampMesh);
        if let Some(ramp) = self.remeshed.as_ref().filter(|_| mesh != 0) {
            scene.ramp.model.contacts = Some(ramp.modes(mesh));
        }
        scene
    }
}

/// Largest number of kept models at other refinement levels. An uncertainty interval needs about nine, each several
/// times and some by both signs; kept for all scenes they would fill the memory.
const REFINED: usize = 24;

/// Memory of the kept final states, bytes: some hundred on 1000 cells. A search needs one of its last survivors.
const MOST_END_BYTES: usize = 4 << 20;

/// Runs the physics for the points of a study.
pub struct Physics {
    entries: Vec<Entry>,
    /// Model place, sign of the shock, and sense of its axis along the scene's, of every point.
    points: Vec<(usize, f64, f64)>,
    plan: Plan,
    /// Models at other refinement levels, by place and levels.
    changed: Mutex<Latest<(usize, Levels), Arc<Model>>>,
    shared_models: Mutex<Vec<Arc<Model>>>,
    /// Scenes whose films have unlike defect corrections, with what the thread holds that samples it.
    samplings: Mutex<Vec<(Scene, Arc<Mutex<()>>)>>,
    cache: StructureRunCache,
    /// Structures that several scenes of the study have.
    shared_structures: HashSet<[u8; 16]>,
    /// Structures built so far.
    structures: AtomicU64,
    workspaces: Mutex<Vec<Workspace>>,
    /// Final states of recent survivors, by point and bits of the signed amplitude: the doubled window continues them.
    ends: Mutex<Latest<(usize, u64), HeadState>>,
}

impl Physics {
    /// Structural runs requested so far by points with a common structure, and how many of them an earlier run
    /// answered.
    pub fn structural_runs(&self) -> Counts {
        self.cache.counts()
    }

    /// Structures of disk and ramp built so far, with those of other refinement levels and longer windows.
    pub fn structures_built(&self) -> u64 {
        self.structures.load(Ordering::Relaxed)
    }

    /// The points of a study, in the order of its tables like [`super::SweepInput::of`].
    pub fn of(study: &Study) -> Self {
        Self::planned(study, study.plan())
    }

    /// The same points with every effect, nothing shared.
    pub fn in_full(study: &Study) -> Self {
        Self::planned(study, Plan::new(&study.plan().outputs, Mode::Full))
    }

    /// Builds the films of its points, those of `study`, refined by `steps` in everything, for scenes that share them.
    pub fn build_films(&self, study: &Study, steps: i8) {
        for (place, (entry, ..)) in study.table_order().into_iter().zip(&self.points) {
            // A scene that cannot be built has nothing to share.
            let _ = self.refined_model(*entry, study.points[place].levels(steps));
        }
    }

    /// Takes the films and structures of `other`, which are built now if need be, for scenes that have the same.
    #[must_use]
    pub fn sharing(self, other: &Physics) -> Self {
        self.take_films(other);
        self
    }

    /// Takes the films and structures of `other` that are built by now, and those of its points.
    pub fn take_films(&self, other: &Physics) {
        for point in 0..other.points.len() {
            // A scene that cannot be built has nothing to share.
            let _ = other.model(point);
        }
        let models = lock(&other.shared_models).clone();
        lock(&self.shared_models).extend(models);
    }

    fn planned(study: &Study, plan: Plan) -> Self {
        let points = study.table_order().into_iter().map(|place| {
            let point = &study.points[place];
            (point, point.sign.factor())
        });
        Self::new(points, plan)
    }

    /// Points with the sign of their shocks (1 or -1).
    fn new<'a>(points: impl IntoIterator<Item = (&'a Point, f64)>, plan: Plan) -> Self {
        let mut entries: Vec<Entry> = Vec::new();
        let points = points
            .into_iter()
            .map(|(point, sign)| {
                let known = entries.iter().position(|entry| {
                    entry.scene == point.scene && entry.remeshed == point.remeshed
                });
                let entry = known.unwrap_or_else(|| {
                    entries.push(Entry {
                        scene: point.scene.clone(),
                        remeshed: point.remeshed.clone(),
                        plain: OnceLock::new(),
                        longer: Mutex::new(None),
                    });
                    entries.len() - 1
                });
                (entry, sign, point.faces.factor())
            })
            .collect();
        let mut seen = HashSet::new();
        let keys = entries.iter().map(|entry| structure_key(&entry.scene));
        let shared_structures = keys.filter(|key| !seen.insert(*key)).collect();
        Self {
            entries,
            points,
            plan,
            changed: Mutex::new(Latest::new(REFINED)),
            shared_models: Mutex::new(Vec::new()),
            samplings: Mutex::new(Vec::new()),
            cache: StructureRunCache::default(),
            shared_structures,
            structures: AtomicU64::new(0),
            workspaces: Mutex::new(Vec::new()),
            ends: Mutex::new(Latest::new(MOST_END_BYTES)),
        }
    }

    /// The model of a point's own scene.
    fn model(&self, point: usize) -> Built {
        let entry = &self.entries[self.points[point].0];
        if !self.plan.shares_parts {
            return self.build(&entry.scene);
        }
        entry.plain.get_or_init(|| self.build(&entry.scene)).clone()
    }

    /// The model of a scene. One thread samples a film's defect correction, others that need it wait for that.
    fn build(&self, scene: &Scene) -> Built {
        let sampling = self.sampling(scene);
        let alone = sampling.as_ref().map(|own| lock(own));
        // Where another thread has sampled it meanwhile, nobody need wait for the rest.
        let _alone = alone.filter(|_| self.sampling(scene).is_some());
        self.assembled(scene)
    }

    /// What a thread locks that samples the defect correction of `scene`; none where a model has it, or nothing is shared.
    fn sampling(&self, scene: &Scene) -> Option<Arc<Mutex<()>>> {
        let has_reference = |known: &Scene| Bearing::has_reference(scene, known);
        if !self.plan.shares_parts
            || scene.film_resolution.correction_cells == 0
            || lock(&self.shared_models)
                .iter()
                .any(|model| has_reference(model.scene()))
        {
            return None;
        }
        let mut all = lock(&self.samplings);
        let known = all.iter().find(|(known, _)| has_reference(known));
        let own = known.map(|(_, own)| Arc::clone(own));
        Some(own.unwrap_or_else(|| {
            all.push((scene.clone(), Arc::default()));
            Arc::clone(&all[all.len() - 1].1)
        }))
    }

    fn assembled(&self, scene: &Scene) -> Built {
        let has_structure = |model: &Arc<Model>| model.has_structure(scene, &self.plan);
        let has_film = |model: &Arc<Model>| Bearing::is_shared(scene, model.scene());
        let has_reference = |model: &Arc<Model>| Bearing::has_reference(scene, model.scene());
        let shared_models: Vec<Arc<Model>> = match self.plan.shares_parts {
            true => {
                let all = lock(&self.shared_models);
                let structure = all.iter().find(|model| has_structure(model));
                let film = all.iter().find(|model| has_film(model));
                let film = film.or_else(|| all.iter().find(|model| has_reference(model)));
                structure.into_iter().chain(film).cloned().collect()
            }
            false => Vec::new(),
        };
        let given = shared_models.iter().map(|shared_model| &**shared_model);
        let model = Arc::new(Model::assemble(scene, &self.plan, given)?);
        // Kept for others: a new film, or a structure that other points have too.
        if !shared_models.iter().any(has_structure) {
            self.structures.fetch_add(1, Ordering::Relaxed);
        }
        let gives_structure = self.shared_structures.contains(&structure_key(scene));
        let is_new = !shared_models.iter().any(has_film)
            || gives_structure && !shared_models.iter().any(has_structure);
        if self.plan.shares_parts && is_new {
            lock(&self.shared_models).push(Arc::clone(&model));
        }
        Ok(model)
    }

    /// A scene at other refinement levels in the study's window.
    fn refined_model(&self, entry: usize, levels: Levels) -> Built {
        let key = (entry, levels);
        let known = lock(&self.changed).get(&key).cloned();
        if let Some(model) = known {
            return Ok(model);
        }
        let model = self.build(&self.entries[entry].at_levels(levels))?;
        lock(&self.changed).keep(key, Arc::clone(&model), 1);
        Ok(model)
    }

    /// The model a probe runs on.
    fn model_for(&self, point: usize, probe: Probe) -> Built {
        if !probe.levels.is_none() && probe.retry == Retry::None {
            return self.refined_model(self.points[point].0, probe.levels);
        }
        if probe.retry == Retry::None && probe.window_factor == 1 {
            return self.model(point);
        }
        let entry = &self.entries[self.points[point].0];
        let scene = entry.at_levels(probe.levels);
        let longer = |scene: &Scene| {
            if probe.window_factor == 1 {
                scene.clone()
            } else {
                scene.with_window_times(f64::from(probe.window_factor))
            }
        };
        match probe.retry {
            Retry::None if !self.plan.shares_parts => self.build(&longer(&scene)),
            Retry::None => {
                if let Some(model) = lock(&entry.longer).clone() {
                    return Ok(model);
                }
                let model = self.build(&longer(&scene))?;
                *lock(&entry.longer) = Some(Arc::clone(&model));
                Ok(model)
            }
            Retry::HalfStep => self.build(&longer(&scene.with_finer_steps(2.0))),
            Retry::QuarterStep => self.build(&longer(&scene.with_finer_steps(4.0))),
            Retry::OtherCoupling => self.build(&longer(&scene.with_other_coupling())),
            Retry::OtherContact => self.build(&longer(&scene.with_other_contact())),
        }
    }

    /// Runs a shock. A longer window continues the same shock in the study's window from its final state while that is
    /// still kept.
    fn run(&self, model: &Model, request: &Request, (point, probe): (usize, Probe)) -> Outcome {
        let mut workspace = lock(&self.workspaces).pop().unwrap_or_default();
        let structure = structure_key(model.scene());
        let is_shared = self.plan.shares_parts && self.shared_structures.contains(&structure);
        let amplitude_bits = request.amplitude_m_per_s2.to_bits();
        let is_plain = probe.retry == Retry::None && probe.levels.is_none() && !request.record;
        let key = (point, amplitude_bits);
        let from;
        let going = if probe.window_factor == 1 {
            Going {
                keeps_end: self.plan.shares_parts && is_plain,
                ..Going::default()
            }
        } else {
            let study = &self.entries[self.points[point].0].scene;
            from = lock(&self.ends).take(&key).filter(|_| is_plain);
            Going {
                restart_s: model.structure().end_of(study.window),
                from: from.as_ref(),
                keeps_end: false,
            }
        };
        let (outcome, end) = if is_shared && !request.record {
            let steps = model.structure().n_steps() + 1;
            let run = || run_structure(model, request, &mut workspace);
            let shared = self
                .cache
                .get_or_run((structure, amplitude_bits), steps, run);
            let structure = shared.wait().as_ref();
            simulate_head_on(model, request, structure, going, &mut workspace)
        } else {
            let structure = run_structure(model, request, &mut workspace);
            simulate_head_on(model, request, structure.as_ref(), going, &mut workspace)
        };
        if let Some(end) = end {
            let bytes = end.bytes();
            lock(&self.ends).keep(key, end, bytes);
        }
        lock(&self.workspaces).push(workspace);
        outcome
    }
}

/// Content of everything the structure's motion depends on.
fn structure_key(scene: &Scene) -> [u8; 16] {
    identity::structure_key(scene, PHYSICS_STRUCTURE)
}

/// A poisoned lock only means that another probe panicked; its data are consistent at all times.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

impl Simulator for Physics {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let model = match self.model_for(point, probe) {
            Err(error) => return not_built(&error),
            Ok(model) => model,
        };
        let request = Request {
            amplitude_m_per_s2: self.points[point].2 * amplitude_m_per_s2,
            record: false,
        };
        let outcome = self.run(&model, &request, (point, probe));
        probe_result(model.scene(), &outcome)
    }

    fn record(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> Option<Outcome> {
        let model = self.model_for(point, probe).ok()?;
        let request = Request {
            amplitude_m_per_s2: self.points[point].2 * amplitude_m_per_s2,
            record: true,
        };
        Some(self.run(&model, &request, (point, probe)))
    }

    fn onset(&self, point: usize) -> Onset {
        let (entry, sign, sense) = self.points[point];
        if self.entries[entry].scene.ramp.model.is_absent() {
            return Onset::NoRamp;
        }
        // With the full model nothing is taken from the answers without ramp.
        if self.plan.mode == Mode::Full {
            return Onset::Unknown;
        }
        let Ok(model) = self.model(point) else {
            return Onset::Unknown;
        };
        match model
            .structure()
            .touch_amplitude_m_per_s2(sign * sense > 0.0)
        {
            Some(amplitude_m_per_s2) => Onset::At { amplitude_m_per_s2 },
            None => Onset::Unknown,
        }
    }
}
