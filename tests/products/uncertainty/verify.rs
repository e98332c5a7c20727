//! `make verify-accuracy`: do the uncertainty intervals contain the truth? 300 answers that are known (laws, and disk
//! and ramp alone) and 40 whole shocks against ten times finer ones. Every answer is a line of
//! `results/accuracy/coverage.csv`; run again with the same program it goes on from there. A program
//! with other intervals and the same physics finds the truths in it and makes the intervals alone. A random
//! study without a critical shock in its range, or whose finer one has no verdict, is a line without
//! figures; an interval with the flag `contribution_missing` makes no claim. In both cases the
//! next seed stands in.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::simulation::{
    Model, Outcome, Request, Scope, Verdict as SolverVerdict, Workspace, simulate,
};
use opshock_solver::suspension::ReducedSuspension;
use opshock_study::search::{Flag, Probe, ProbeResult, RunCost, Verdict};
use opshock_study::store::summary::Status;
use opshock_study::study::Study;
use opshock_study::sweep::{Onset, Physics, Simulator, SweepInput, UncertaintyPlan};
use opshock_tests::mock_uncertainty::{LawSimulator, Random, laws_study};
use opshock_tests::scenes::study;

use super::coverage::{Covered, Line, Log, Truth, scene_name};
use super::run;

const LAWS: usize = 260;
const STRUCTURES: usize = 40;
/// Whole shocks, where `OPSHOCK_WHOLE` asks for no other number.
const WHOLE: usize = 40;

/// Critical amplitude near `from_g` to a `share`, by searching exponentially and halving, going on from what is
/// `known` of it; `None` without verdicts or farther off than a factor 4.
pub(super) fn truth(
    from_g: f64,
    share: f64,
    known: Option<Truth>,
    fails: &mut dyn FnMut(f64) -> Option<bool>,
) -> Option<Truth> {
    let (mut low, mut high) = (None, None);
    let (mut at, mut factor) = (from_g, 1.0 + 2.0 * share);
    if let Some(known) = known {
        (low, high) = (Some(known.low_g), Some(known.high_g));
    }
    loop {
        match (low, high) {
            (Some(low_g), Some(high_g)) if high_g / low_g < 1.0 + share => {
                return Some(Truth { low_g, high_g });
            }
            (Some(low), Some(high)) => at = f64::sqrt(low * high),
            (Some(low), None) => at = low * factor,
            (None, Some(high)) => at = high / factor,
            (None, None) => {}
        }
        if low.is_some() != high.is_some() {
            factor *= factor;
        }
        if (at / from_g).ln().abs() > 4_f64.ln() {
            return None;
        }
        match fails(at)? {
            true => high = Some(at),
            false => low = Some(at),
        }
    }
}

/// The scene with the error of every discretisation parameter ten times smaller at its formal order (`Discretisation`): the error
/// of cells, cut, step and coupling falls with their number, that of the head's tolerance with its
/// power of 2/3, that of the suspension's modes with their square.
fn ten_times_finer(scene: &Scene) -> Scene {
    let mut finer = scene.clone();
    finer.disk_resolution.cut_hz *= 10.0;
    let waves = |count: usize| (count as f64 * 10_f64.sqrt()).ceil() as usize;
    finer.disk_resolution.n_harmonics = waves(scene.disk_resolution.n_harmonics);
    finer.disk_resolution.n_elements = waves(scene.disk_resolution.n_elements);
    finer.structure_resolution.step_s /= 10.0;
    finer.film_resolution.cells *= 10;
    finer.head_resolution.tolerance /= 32.0;
    finer.head_resolution.approach_share /= 3.0;
    finer.head_resolution.coupling_tolerance /= 10.0;
    // A beam has no more; with all of them nothing is cut.
    let wanted = 4 * scene.head_resolution.suspension_modes;
    let most = ReducedSuspension::most_bending_modes(&scene.suspension);
    finer.head_resolution.suspension_modes = most.map_or(wanted, |most| wanted.min(most));
    finer
}

/// A small study of a seed: one point.
fn small_study(kind: &str, seed: u64) -> Study {
    let mut random = Random(seed ^ if kind == "whole" { 0x77 } else { 0x33 });
    let ramps: &[&str] = match kind {
        "whole" => &["none", "rigid", "deformable"],
        _ => &["rigid", "deformable"],
    };
    let ramp = ramps[(random.unit() * ramps.len() as f64) as usize];
    let sign = if random.unit() < 0.5 { "+" } else { "-" };
    let pulse_ms = random.log_between(0.3, 0.9);
    let cut_khz = random.log_between(15.0, 60.0);
    let sets = [
        ("ramp.models", format!("[\"{ramp}\"]")),
        ("pulse.signs", format!("[\"{sign}\"]")),
        ("pulse.widths_ms", format!("[{pulse_ms:.3}]")),
        ("pulse.window_ms", "1.5".to_owned()),
        ("resolution.disk_cut_khz", format!("{cut_khz:.1}")),
        (
            "ramp.clearance_um",
            format!("{:.1}", random.between(60.0, 120.0)),
        ),
        ("disk.rpm", format!("{:.0}", random.between(4800.0, 7200.0))),
        (
            "suspension.gram_load_gf",
            format!("{:.3}", random.between(0.9, 1.4)),
        ),
        ("search.monotonicity_scan", "\"off\"".to_owned()),
        ("search.max_refinements", "0".to_owned()),
        ("search.tolerance_pct", "2.0".to_owned()),
        ("resolution.preset", "\"coarse\"".to_owned()),
        ("resolution.film_cells", "240".to_owned()),
        // What the truths of before were made with.
        ("resolution.disk_harmonics", "56".to_owned()),
        ("resolution.disk_elements", "40".to_owned()),
        ("resolution.structure_step_us", "0.5".to_owned()),
        ("output.keep_histories", "\"none\"".to_owned()),
    ];
    let sets: Vec<(&str, &str)> = sets.iter().map(|(k, v)| (*k, v.as_str())).collect();
    study("fig13-stiffness", &sets)
}

/// Disk and ramp alone: fails when the impulse of the contacts or the travel of the disk under the
/// slider exceeds a limit.
struct StructureSimulator {
    scene: Scene,
    sign: f64,
    /// Limit of the impulse, N s, or of the travel, m.
    limit: f64,
    by_impulse: bool,
}

impl StructureSimulator {
    fn load(&self, outcome: &Outcome) -> f64 {
        if self.by_impulse {
            outcome.top.impulse_n_s + outcome.bottom.impulse_n_s
        } else {
            outcome
                .disk
                .slider_max_m
                .abs()
                .max(outcome.disk.slider_min_m.abs())
        }
    }

    fn lead(&self, scene: &Scene, amplitude_m_per_s2: f64) -> f64 {
        let model = Model::build(scene, Scope::Structure, None).expect("builds");
        self.lead_of(&model, amplitude_m_per_s2)
    }

    fn lead_of(&self, model: &Model, amplitude_m_per_s2: f64) -> f64 {
        let request = Request {
            amplitude_m_per_s2,
            record: false,
        };
        let outcome = simulate(model, &request, &mut Workspace::default());
        self.limit / self.load(&outcome) - 1.0
    }
}

impl Simulator for StructureSimulator {
    fn simulate(&self, _: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let lead = self.lead(&self.scene.at_levels(probe.levels), amplitude_m_per_s2);
        ProbeResult {
            verdict: if lead > 0.0 {
                Verdict::Survives
            } else {
                Verdict::Fails {
                    t_fail_s: 1e-3,
                    x_m: 0.0,
                    y_m: 0.0,
                }
            },
            h_min_m: Some(1e-8 * lead.clamp(0.0, 1e3)),
            t_min_s: Some(1e-3),
            cost: RunCost::default(),
        }
    }

    fn onset(&self, _: usize) -> Onset {
        Onset::NoRamp
    }
}

fn structure(seed: u64, known: Known<'_>) -> Line {
    let study = small_study("structure", seed);
    let scene = study.points[0].scene.clone();
    let sign = study.points[0].sign.factor();
    let mut simulator = StructureSimulator {
        scene: scene.clone(),
        sign,
        limit: 1.0,
        by_impulse: seed.is_multiple_of(2),
    };
    // The limit is what a shock above first touch brings.
    let onset = Model::build(&scene, Scope::Structure, None)
        .expect("builds")
        .structure()
        .touch_amplitude_m_per_s2(sign > 0.0)
        .expect("touches");
    simulator.limit = 1.0 / (1.0 + simulator.lead(&scene, sign * 1.3 * onset));
    let mut input = SweepInput::of(&study).expect("input");
    input.points[0].uncertainty = Some(UncertaintyPlan {
        discretisations: vec![Discretisation::DiskModes, Discretisation::StructureStep],
        film_halvings: 0,
        mesh_halvings: 0,
        hard_contact: false,
        target: 0.05,
        refinements: 0,
    });
    let row = swept(&input, &simulator);
    let mut model = None;
    line(&input, &row, known, &mut |amplitude_g| {
        let model = model.get_or_insert_with(|| {
            Model::build(&ten_times_finer(&scene), Scope::Structure, None).expect("builds finer")
        });
        Some(simulator.lead_of(model, simulator.sign * m_per_s2_from_g(amplitude_g)) <= 0.0)
    })
}

fn whole(seed: u64, known: Known<'_>) -> Line {
    let study = small_study("whole", seed);
    let input = SweepInput::of(&study).expect("input");
    let row = swept(&input, &Physics::of(&study));
    let point = &study.points[0];
    let mut model = None;
    let mut workspace = Workspace::default();
    line(&input, &row, known, &mut |amplitude_g| {
        let model = model.get_or_insert_with(|| {
            Model::build(&ten_times_finer(&point.scene), Scope::Full, None).expect("builds finer")
        });
        let request = Request {
            amplitude_m_per_s2: point.sign.factor() * m_per_s2_from_g(amplitude_g),
            record: false,
        };
        match simulate(model, &request, &mut workspace).verdict {
            Some(SolverVerdict::Survives) => Some(false),
            Some(SolverVerdict::Fails { .. }) => Some(true),
            undecided => {
                println!("whole {seed}: the finer scene is undecided: {undecided:?}");
                None
            }
        }
    })
}

type Row = opshock_study::store::summary::PointSummary;

fn swept(input: &SweepInput, simulator: &dyn Simulator) -> Row {
    let folder = tempfile::tempdir().expect("folder");
    let end = opshock_study::sweep::sweep(
        input,
        simulator,
        folder.path(),
        &opshock_study::sweep::SweepOptions::with_threads(1),
        &opshock_study::sweep::Silent,
    )
    .expect("sweeps");
    let row = end.summary.points[0].clone();
    println!("{:?} {:?}", row.flags, row.contributions);
    row
}

/// What is known of the truth of a scene, by its digest.
type Known<'a> = &'a dyn Fn(&str) -> Option<Truth>;

fn line(
    input: &SweepInput,
    row: &Row,
    known: Known<'_>,
    fails: &mut dyn FnMut(f64) -> Option<bool>,
) -> Line {
    let scene = scene_name(&input.points[0].digest.0);
    let covered = covered(row, known(&scene), fails);
    Line { scene, covered }
}

fn covered(
    row: &Row,
    known: Option<Truth>,
    fails: &mut dyn FnMut(f64) -> Option<bool>,
) -> Option<Covered> {
    if row.status != Status::Ok {
        println!("no critical shock: {:?}", row.status);
        return None;
    }
    let (a_crit_g, half_g) = (row.a_crit_g?, row.uncertainty_g?);
    // Fine enough to tell inside from outside, and the interval from twenty times the error.
    let share = (0.1 * half_g / a_crit_g).max(0.002);
    Some(Covered {
        a_crit_g,
        half_g,
        truth: truth(a_crit_g, share, known, fails)?,
        is_partial: row.flags.contains(&Flag::ContributionMissing),
    })
}

/// Measures what the log does not have yet, on all cores.
fn measure(log: &Mutex<Log>, kind: &str, n: usize, one: &(dyn Fn(u64, Known<'_>) -> Line + Sync)) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if log.lock().expect("whole").answered(kind) >= n {
                        break;
                    }
                    let seed = seed as u64;
                    if log.lock().expect("whole").has(kind, seed) {
                        continue;
                    }
                    let known = |scene: &str| log.lock().expect("whole").truth(kind, seed, scene);
                    let line = one(seed, &known);
                    let inside = line.covered.map(|covered| covered.inside());
                    println!("{kind} {seed}: {:.1?} {inside:?}", line.covered);
                    log.lock().expect("whole").put(kind, seed, line);
                }
            });
        }
    });
}

fn laws(log: &Mutex<Log>) {
    let (input, laws) = (laws_study(LAWS), LawSimulator::of(1000, LAWS));
    let folder = tempfile::tempdir().expect("folder");
    let end = run(&input, &laws, folder.path(), 2);
    let mut log = log.lock().expect("whole");
    for (seed, (row, law)) in end.summary.points.iter().zip(&laws.0).enumerate() {
        let covered = Covered {
            a_crit_g: row.a_crit_g.expect("bracketed"),
            half_g: row.uncertainty_g.expect("an interval"),
            truth: Truth {
                low_g: law.exact_g,
                high_g: law.exact_g,
            },
            is_partial: row.flags.contains(&Flag::ContributionMissing),
        };
        let line = Line {
            scene: String::new(),
            covered: Some(covered),
        };
        log.put("law", seed as u64, line);
    }
}

#[test]
#[ignore = "make verify-accuracy: some minutes to 40"]
fn accuracy_slow_the_truth_lies_inside_the_uncertainty() {
    let log = Mutex::new(Log::open());
    laws(&log);
    measure(&log, "structure", STRUCTURES, &structure);
    let n_whole = std::env::var("OPSHOCK_WHOLE").map_or(WHOLE, |n| n.parse().expect("a number"));
    measure(&log, "whole", n_whole, &whole);
    let log = log.into_inner().expect("whole");
    for kinds in [&["law", "structure"][..], &["whole"]] {
        let (inside, median) = log.judge(kinds);
        assert!(inside >= 0.95, "{kinds:?}: {inside}");
        assert!(median <= 10.0, "{kinds:?}: {median}");
    }
}

#[test]
fn the_truth_lies_inside_the_uncertainty_of_disk_and_ramp_alone() {
    for seed in 0..1 {
        let covered = structure(seed, &|_| None)
            .covered
            .expect("a critical shock");
        assert!(covered.inside(), "seed {seed}: {covered:?}");
    }
}
