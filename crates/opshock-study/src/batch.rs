//! Simulates many shocks on all threads, each as if alone: for searches and optimisers outside of opshock.
//!
//! Shocks of the same scene share a model, and models share films and structures that are the same. Neither changes the
//! numbers: building is deterministic, and a model never changes.

use crate::sweep::StopFlag;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::Plan;
use opshock_solver::simulation::{BuildError, Model, Outcome, Request, Workspace, simulate};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// A shock of a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shock {
    /// Place of its scene in the list of scenes.
    pub scene: usize,
    /// Signed amplitude on the scene's axis, m/s2.
    pub amplitude_m_per_s2: f64,
}

/// What became of a shock.
#[derive(Debug)]
pub struct Simulated {
    /// Outcome, without histories; or why the scene cannot be built.
    pub outcome: Result<Outcome, BuildError>,
    /// Measured time, with the model if it was made for this shock, s.
    pub wall_s: f64,
}

type Built = Arc<OnceLock<Result<Model, BuildError>>>;

/// A scene, its plan, its model while shocks of it are left, and their number.
struct Entry<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    model: Mutex<Option<Built>>,
    left: AtomicUsize,
}

impl Entry<'_> {
    /// The model, made now if it is the first time; `alive` are the entries from which parts may be taken.
    fn built(&self, alive: &[Entry<'_>]) -> Built {
        let built = Arc::clone(lock(&self.model).get_or_insert_default());
        built.get_or_init(|| {
            let others: Vec<Built> = alive
                .iter()
                .filter_map(|entry| lock(&entry.model).clone())
                .collect();
            let models = others.iter().filter_map(|other| other.get()?.as_ref().ok());
            Model::assemble(self.scene, self.plan, models)
        });
        built
    }

    /// A shock of this scene is done; the last one gives its model up.
    fn done(&self) {
        if self.left.fetch_sub(1, Ordering::AcqRel) == 1 {
            *lock(&self.model) = None;
        }
    }
}

/// Simulates `shocks` of `scenes`, each by its plan, on `threads` threads. The answers are in the order of the shocks;
/// `None` for those that a requested stop left out.
pub fn simulate_all(
    scenes: &[(&Scene, &Plan)],
    shocks: &[Shock],
    threads: usize,
    stop: &StopFlag,
) -> Vec<Option<Simulated>> {
    let entries: Vec<Entry<'_>> = scenes
        .iter()
        .map(|(scene, plan)| Entry {
            scene,
            plan,
            model: Mutex::default(),
            left: AtomicUsize::new(0),
        })
        .collect();
    for shock in shocks {
        entries[shock.scene].left.fetch_add(1, Ordering::Relaxed);
    }
    // Scene by scene, so that few models are alive at a time.
    let mut order: Vec<usize> = (0..shocks.len()).collect();
    order.sort_by_key(|&place| shocks[place].scene);
    let next = AtomicUsize::new(0);
    let answers = Mutex::new(Vec::from_iter(shocks.iter().map(|_| None)));
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, shocks.len().max(1)) {
            scope.spawn(|| {
                let _end = EndOfAll(stop);
                let mut workspace = Workspace::default();
                while !stop.is_asked() {
                    let Some(&place) = order.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        return;
                    };
                    let began = Instant::now();
                    let entry = &entries[shocks[place].scene];
                    let request = Request {
                        amplitude_m_per_s2: shocks[place].amplitude_m_per_s2,
                        record: false,
                    };
                    let built = entry.built(&entries);
                    let outcome = match built.get() {
                        Some(Ok(model)) => Ok(simulate(model, &request, &mut workspace)),
                        Some(Err(error)) => Err(error.clone()),
                        None => unreachable!("the model was made or refused"),
                    };
                    entry.done();
                    let wall_s = began.elapsed().as_secs_f64();
                    lock(&answers)[place] = Some(Simulated { outcome, wall_s });
                }
            });
        }
    });
    answers.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// A thread that panics stops the others.
struct EndOfAll<'a>(&'a StopFlag);

impl Drop for EndOfAll<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.ask();
        }
    }
}

/// What a thread that panicked left is whole: it is replaced in one step.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
