//! What omitting effects saves: each question with the reduced model and with `effects = "full"`, in one run.
//!
//! The drive of `fig13-stiffness` at the study's resolution, 0.5 ms, 5 ms window. A pair is timed in turn, three
//! times, and the medians compared: once with building the model (one question asked), once
//! without (each further shock on the same model). Both answers are compared too.
//!
//! Then a whole search on one thread: critical shocks of three ramps and both signs against the
//! same with the full model. And 20 slider designs on one drive, sharing against each by itself, design by
//! design in turn, so that the load of the machine is on both sides.

use std::hint::black_box;
use std::time::Instant;

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{
    Model, Outcome, Request, Workspace, run_structure, simulate, simulate_head,
};
use opshock_solver::structure::StructureRun;
use opshock_study::sweep::{Physics, Silent, SweepEnd, SweepInput, SweepOptions, sweep};
use opshock_tests::scenes;
use opshock_tests::timing::median;

const ROUNDS: usize = 3;

/// Time of this thread on a processor, s, without that of other programs; where the system does
/// not report it, time on the clock.
fn busy_s() -> f64 {
    // The number is updated when the thread is scheduled.
    std::thread::yield_now();
    let reported = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = reported.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    nanoseconds.map_or_else(
        || BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64(),
        |ns| 1e-9 * ns,
    )
}

/// The same of all threads, in hundredths of a second.
fn all_threads_busy_s() -> f64 {
    let reported = std::fs::read_to_string("/proc/self/stat").ok();
    let ticks = reported.and_then(|text| {
        let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
        Some(fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?)
    });
    ticks.map_or_else(busy_s, |ticks| 0.01 * ticks)
}

fn request(amplitude_g: f64) -> Request {
    Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        record: false,
    }
}

/// Building, then the second of two shocks (the first warms the workspace), s.
fn times(scene: &Scene, plan: &Plan, amplitude_g: f64) -> ([f64; 2], Outcome) {
    let start = busy_s();
    let model = Model::assemble(scene, plan, None).expect("the scene builds");
    let built = busy_s() - start;
    let mut workspace = Workspace::default();
    black_box(simulate(&model, &request(amplitude_g), &mut workspace));
    let start = busy_s();
    let outcome = black_box(simulate(&model, &request(amplitude_g), &mut workspace));
    ([built, busy_s() - start], outcome)
}

fn compare(question: &str, ramp: &str, output: Output, amplitude_g: f64) {
    let scene = scenes::scene("fig13-stiffness", ramp, 0.5, &[]);
    let plans = [Mode::Auto, Mode::Full].map(|mode| Plan::new(&[output], mode));
    let mut all: [[Vec<f64>; 2]; 2] = Default::default();
    let mut disks = Vec::new();
    for _ in 0..ROUNDS {
        for (plan, kept) in plans.iter().zip(&mut all) {
            let ([built, shock], outcome) = times(&scene, plan, amplitude_g);
            kept[0].push(built + shock);
            kept[1].push(shock);
            disks.push((outcome.disk, outcome.top, outcome.bottom));
        }
    }
    assert!(disks.iter().all(|other| *other == disks[0]), "{question}");
    let [[auto_once, auto_more], [full_once, full_more]] = all.map(|side| side.map(median));
    println!(
        "| {question} | {:.1} ms | {:.1} ms | {:.1} | {:.2} ms | {:.1} ms | {:.1} |",
        1e3 * auto_once,
        1e3 * full_once,
        full_once / auto_once,
        1e3 * auto_more,
        1e3 * full_more,
        full_more / auto_more
    );
}

/// Parts by name, as `cargo bench --bench savings -- search`; all without one.
fn main() {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let parts: [(&str, fn()); 3] = [("pairs", pairs), ("search", search), ("designs", designs)];
    let is_named = |part: &str| named.iter().any(|word| word == part);
    let all = !parts.iter().any(|(part, _)| is_named(part));
    for (part, run) in parts {
        if all || is_named(part) {
            run();
        }
    }
}

fn pairs() {
    println!(
        "| question | one shock, reduced | full | ratio | further shock, reduced | full | ratio |"
    );
    println!("|---|---|---|---|---|---|---|");
    compare(
        "disk motion without ramp, 190 G",
        "none",
        Output::DiskDisplacement,
        190.0,
    );
    compare(
        "rigid ramp below touch, 190 G",
        "rigid",
        Output::RampDisplacement,
        190.0,
    );
    compare(
        "deformable ramp below touch, 170 G",
        "deformable",
        Output::RampDisplacement,
        170.0,
    );
    compare(
        "contact history, rigid, 400 G",
        "rigid",
        Output::ContactForce,
        400.0,
    );
    compare(
        "contact history, deformable, 400 G",
        "deformable",
        Output::ContactForce,
        400.0,
    );
    // The same contacts with shocks that the head survives: the full model runs the whole window.
    compare(
        "contact history, rigid, 198 G",
        "rigid",
        Output::ContactForce,
        198.0,
    );
    compare(
        "contact history, deformable, 190 G",
        "deformable",
        Output::ContactForce,
        190.0,
    );
    compare(
        "critical-shock probe, deformable, 190 G",
        "deformable",
        Output::CriticalShock,
        190.0,
    );
}

/// Sweeps Fig. 13 at 0.5 ms with some keys set, on one thread, into a store of its own.
fn swept(sets: &[(&str, &str)]) -> SweepEnd {
    let mut all = vec![
        ("pulse.widths_ms", "[0.5]"),
        ("search.tolerance_pct", "5"),
        ("output.keep_histories", "\"none\""),
        ("search.uncertainty", "false"),
    ];
    all.extend_from_slice(sets);
    let study = scenes::study("fig13-stiffness", &all);
    let input = SweepInput::of(&study).expect("points");
    let folder = tempfile::tempdir().expect("a folder");
    let store = folder.path().join("s.opshock");
    let options = SweepOptions {
        speculate: false,
        ..SweepOptions::with_threads(1)
    };
    sweep(&input, &Physics::of(&study), &store, &options, &Silent).expect("a sweep")
}

/// Critical amplitudes in the order of the table, g.
fn answers(end: &SweepEnd) -> Vec<Option<f64>> {
    let points = &end.summary.points;
    points.iter().map(|point| point.a_crit_g).collect()
}

/// Every probe of the full search builds and runs disk, ramp and head by itself.
fn search() {
    let timed = |sets: &[(&str, &str)]| {
        let start = all_threads_busy_s();
        let end = swept(sets);
        (end, all_threads_busy_s() - start)
    };
    let (auto, auto_s) = timed(&[]);
    let (full, full_s) = timed(&[("solver.effects", "\"full\"")]);
    assert_eq!(answers(&auto), answers(&full));
    println!(
        "critical-shock search, 3 ramps x 2 signs, 0.5 ms, 5 %: {} runs {auto_s:.1} s, in full {} \
         runs {full_s:.1} s, ratio {:.2}",
        auto.computed_runs,
        full.computed_runs,
        full_s / auto_s
    );
}

/// Amplitudes that a bisection between 100 and 400 G to 5 % may ask, G.
const SHOCKS_G: [f64; 3] = [200.0, 238.0, 218.0];

/// 20 crowns, two questions: contact forces, and verdicts as a search asks for them.
fn designs() {
    for (question, output) in [
        ("contact force", Output::ContactForce),
        ("critical shock", Output::CriticalShock),
    ] {
        let plan = Plan::new(&[output], Mode::Auto);
        let (mut shared_s, mut alone_s) = (0.0, 0.0);
        let mut shared_model: Option<Model> = None;
        // What a study keeps for its other points: one structural run an amplitude.
        let mut kept: Vec<Option<StructureRun>> = vec![None; SHOCKS_G.len()];
        for design in 0..20 {
            let crown = format!("{}", 10 + design);
            let scene = scenes::scene(
                "fig13-stiffness",
                "rigid",
                0.5,
                &[("slider.surface.crown_nm", &crown)],
            );
            let mut shared = || {
                let start = busy_s();
                let model = Model::assemble(&scene, &plan, shared_model.as_ref()).expect("builds");
                let mut workspace = Workspace::default();
                let mut outcomes = Vec::new();
                for (amplitude_g, kept) in SHOCKS_G.iter().zip(&mut kept) {
                    let request = request(*amplitude_g);
                    let run = kept.get_or_insert_with(|| {
                        run_structure(&model, &request, &mut workspace).expect("runs")
                    });
                    outcomes.push(simulate_head(&model, &request, Ok(run), &mut workspace));
                }
                shared_s += busy_s() - start;
                shared_model = Some(model);
                outcomes
            };
            let mut alone = || {
                let start = busy_s();
                let model = Model::assemble(&scene, &plan, None).expect("builds");
                let mut workspace = Workspace::default();
                let outcomes: Vec<Outcome> = SHOCKS_G
                    .iter()
                    .map(|amplitude_g| simulate(&model, &request(*amplitude_g), &mut workspace))
                    .collect();
                alone_s += busy_s() - start;
                outcomes
            };
            let (a, b) = match design % 2 {
                0 => (shared(), alone()),
                _ => {
                    let b = alone();
                    (shared(), b)
                }
            };
            assert_eq!(a, b, "{question}, crown {crown}");
        }
        println!(
            "20 slider designs on one drive, {question}, rigid, 0.5 ms, {} shocks each: shared \
             {shared_s:.2} s, each by itself {alone_s:.2} s, ratio {:.2}",
            SHOCKS_G.len(),
            alone_s / shared_s
        );
    }
}
