//! Estimates the memory that simulations need, and checks that a machine has it.
//!
//! Every number is a measured peak of resident memory less that of a program that does nothing, on x86-64 Linux;
//! `tests/products/memory.rs` holds the estimates against such peaks.

use super::checked::Study;
use super::fault::{StudyError, StudyErrors};
use super::fields;
use super::film_memory::{film_bytes, reference_bytes};
use super::words::KeepHistories;
use opshock_solver::scene::plan::{Needs, Plan};
use opshock_solver::scene::{Scene, Window};

/// Bytes of every thread that simulates: disk modes, film of some hundred cells, scratch.
const THREAD: f64 = 25e6;
/// Bytes of a film over n^1.5 cells, as [`FLIGHT`], where its complex impedance is found too: 150 and 152.
const IMPEDANCE: f64 = 150.0;
/// Bytes of a model per time step of disk and ramp: the unit response, which has more on a hub or a base that vibrates.
const UNIT_RESPONSE: [f64; 2] = [190.0, 330.0];
/// Bytes of a run per time step: the motion of the disk under the slider and its rate.
const MOTION: f64 = 48.0;
/// The same of histories that are kept, and of what is written or drawn of them: 211 (HDF5), 325 (CSV), 535 (plots).
const HISTORY: f64 = 450.0;
/// Models with changed discretisation parameters: of one uncertainty interval, and the most that a sweep keeps.
const REFINED: [usize; 2] = [9, 24];

/// Bytes that simulations need beyond those of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Models that are kept for all workers.
    pub models: f64,
    /// Film of each worker.
    pub film: f64,
    /// Time steps of each worker: its model, motion and histories.
    pub steps: f64,
}

impl Demand {
    /// One shock, from building its model on.
    pub fn run(scene: &Scene, plan: &Plan, record: bool) -> Demand {
        let (n, model) = unit_response(scene);
        let film = &scene.film_resolution;
        let cells = film.cells as f64;
        // Pressure and height, once in the head's run and once in its outcome.
        let fields = 32.0 * cells * plan.field_times_s.len() as f64;
        let kept = if record { HISTORY * n + fields } else { 0.0 };
        let reference = reference_bytes(film.correction_cells as f64);
        Demand {
            models: 0.0,
            film: match plan.needs >= Needs::Flight {
                true => film_bytes(cells).max(reference),
                false => 0.0,
            },
            steps: model + MOTION * n + kept,
        }
    }

    /// The steady flight of a scene with its impedance.
    pub fn impedance(scene: &Scene) -> Demand {
        let film = &scene.film_resolution;
        let reference = reference_bytes(film.correction_cells as f64);
        Demand {
            film: (IMPEDANCE * (film.cells as f64).powf(1.5)).max(reference),
            ..Demand::default()
        }
    }

    /// The first touches of all points of a study, whose models are kept.
    pub fn models(study: &Study) -> Demand {
        let mut seen: Vec<&Scene> = Vec::new();
        let mut models = 0.0;
        for point in &study.points {
            if !seen.contains(&&point.scene) {
                seen.push(&point.scene);
                models += unit_response(&point.scene).1;
            }
        }
        let plan = study.plan();
        let runs = study
            .points
            .iter()
            .map(|point| Demand::run(&point.scene, &plan, false));
        Demand {
            models,
            ..runs.fold(Demand::default(), Demand::max)
        }
    }

    /// A whole sweep: windows may be doubled, and uncertainty intervals run films and defect-correction grids of `finer` times
    /// the cells.
    pub fn sweep(study: &Study, finer: [f64; 2]) -> Demand {
        let search = &study.search;
        let mut all = Demand::models(study);
        let mut longest: f64 = 0.0;
        for point in &study.points {
            let film = &point.scene.film_resolution;
            let [cells, reference] = [film.cells, film.correction_cells].map(|cells| cells as f64);
            let films = film_bytes(finer[0] * cells).max(reference_bytes(finer[1] * reference));
            all.film = all.film.max(films);
            let (n, model) = unit_response(&point.scene);
            longest = longest.max(model);
            // A model of the doubled window in the making.
            let is_kept = study.output.keep_histories != KeepHistories::None;
            let kept = if is_kept { HISTORY * n } else { 0.0 };
            all.steps = all.steps.max(2.0 * (model + MOTION * n) + kept);
        }
        let changed = match search.uncertainty {
            true => REFINED[1].min(REFINED[0] * study.points.len()) as f64 * longest,
            false => 0.0,
        };
        // Of every point the model of the doubled window is kept too.
        all.models += 2.0 * all.models + changed;
        all
    }

    /// The larger of each.
    pub fn max(self, other: Demand) -> Demand {
        Demand {
            models: self.models.max(other.models),
            film: self.film.max(other.film),
            steps: self.steps.max(other.steps),
        }
    }

    /// What so many workers need together.
    pub fn bytes(&self, workers: usize) -> f64 {
        self.models + workers as f64 * self.worker()
    }

    fn worker(&self) -> f64 {
        THREAD + self.film + self.steps
    }

    /// Checks that it fits, with so many workers, into `available` bytes; `what` names it.
    ///
    /// # Errors
    /// E186 with the estimate, and a number of workers that fits or what to make smaller.
    pub fn check(&self, what: &str, workers: usize, available: f64) -> Result<(), StudyErrors> {
        if self.bytes(workers) <= available {
            return Ok(());
        }
        let fitting = ((available - self.models) / self.worker()).floor();
        let (key, hint) = if fitting >= 1.0 {
            ("-j", format!("-j {fitting} fits"))
        } else if self.film > self.steps.max(self.models) {
            let hint =
                "take fewer film_cells or film_correction_cells, or a machine with more memory";
            (fields::RESOLUTION_FILM_CELLS.path(), hint.to_owned())
        } else {
            let hint = "take a shorter window_ms, a longer structure_step_us, fewer fields.times_ms or points, \
                        or a machine with more memory";
            (fields::PULSE_WINDOW_MS.path(), hint.to_owned())
        };
        let message = format!(
            "{what} needs more memory than there is: about {} for films and {} for time steps in each of {workers} \
             workers, {} for the models of all points",
            gigabytes(self.film),
            gigabytes(self.steps),
            gigabytes(self.models)
        );
        let fault = StudyError::in_file("E186", key, message)
            .value(gigabytes(self.bytes(workers)))
            .allowed(format!("at most {}", gigabytes(available)))
            .hint(hint);
        Err(fault.into())
    }
}

/// Time steps of a scene's window, and bytes of its model for them.
fn unit_response(scene: &Scene) -> (f64, f64) {
    let window_s = match scene.window {
        Window::Fixed { length_s } => length_s,
        Window::UntilDecayed { max_s, .. } => max_s,
    };
    let n = window_s / scene.structure_resolution.step_s;
    let has_bodies = scene.disk.hub.is_some() || !scene.base.is_empty();
    (n, UNIT_RESPONSE[usize::from(has_bodies)] * n)
}

fn gigabytes(bytes: f64) -> String {
    format!("{:.2} GB", bytes / 1e9)
}
