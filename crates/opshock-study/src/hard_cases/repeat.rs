//! Hard cases F of reproducibility: the same bits for any thread count, restart or neighbour.

use super::check::Check;
use super::naive;
use super::scenes::drive::small_scene;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, s1, s1_arms};
use super::verdict::search;
use crate::search::{
    Flag, MonotonicityScan, SearchSettings, Status, UndecidedCause, Verdict as Reported,
};
use nalgebra::Complex;
use opshock_solver::fixed_point::{FixedPoint, Method};
use opshock_solver::modal::Oscillator;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{RampBody, RigidRamp};
use opshock_solver::simulation::{Model, Outcome, Request, Scope, Workspace, simulate};
use opshock_solver::structure::{StructureRun, Window};

/// Eight small points: two ramps, four amplitudes.
fn points() -> Vec<(Structure, f64)> {
    let of = |model: RampBody| {
        let mut structure = s1(5e-4, model).with_cut(10e3).with_step(1e-6);
        structure.window = Window::Fixed { length_s: 1e-3 };
        structure
    };
    let amplitudes = [100.0, 200.0, -250.0, 400.0];
    [RampBody::from(RigidRamp), s1_arms()]
        .into_iter()
        .flat_map(|model| amplitudes.map(|g| (of(model.clone()), g * G)))
        .collect()
}

fn run_all(
    points: &[(Structure, f64)],
    order: impl Iterator<Item = usize>,
) -> Vec<(usize, StructureRun)> {
    let mut workspace = opshock_solver::structure::Workspace::default();
    order
        .map(|k| {
            let (structure, amplitude) = &points[k];
            note(structure, *amplitude);
            let run = structure.build().run(*amplitude, true, &mut workspace);
            (k, run.expect("a named structure runs"))
        })
        .collect()
}

/// Points whose numbers differ from those of `reference`.
fn differing(reference: &[(usize, StructureRun)], other: &[(usize, StructureRun)]) -> usize {
    reference
        .iter()
        .filter(|(k, run)| !other.iter().any(|(j, again)| j == k && again == run))
        .count()
}

pub(super) fn f1() -> Vec<Check> {
    let points = points();
    let alone = run_all(&points, 0..points.len());
    let mut wrong = 0;
    for threads in [2, 3, 8, 64] {
        let together: Vec<_> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|w| {
                    let points = &points;
                    scope.spawn(move || run_all(points, (w..points.len()).step_by(threads)))
                })
                .collect();
            let joined = workers
                .into_iter()
                .map(|w| w.join().expect("a worker ends"));
            joined.flatten().collect()
        });
        wrong += differing(&alone, &together);
    }
    // The force of every contact, a number per time step, as threads would gather it.
    let forces: Vec<f64> = alone
        .iter()
        .flat_map(|(_, run)| {
            run.columns
                .as_ref()
                .expect("recorded")
                .contact_top_n
                .clone()
        })
        .collect();
    let sum = naive::search::summed_by_workers(&forces, 1);
    let moved = [2, 3, 8, 64]
        .into_iter()
        .filter(|&n| naive::search::summed_by_workers(&forces, n).to_bits() != sum.to_bits());
    vec![
        Check::none("points that differ on 2, 3, 8 and 64 threads", wrong).against(
            "contact forces summed in order of arrival: numbers of threads that change it",
            moved.count() as f64,
        ),
    ]
}

fn settings() -> SearchSettings {
    SearchSettings::new((20.0, 2000.0), 0.01, MonotonicityScan::Sampled, 0.10, true)
        .expect("settings")
}

pub(super) fn f2() -> Vec<Check> {
    // A search that gets the verdicts of a stopped one again requests the same next probe.
    use crate::search::{PointSearch, Start};
    let start = Start {
        hint_g: Some(300.0),
        onset_index: None,
        fail_below_m: 0.0,
        width_rank: 1,
    };
    let settings = settings();
    let law = |index: i32| {
        if settings.grid.amplitude_g(index) < 233.0 {
            Reported::Survives
        } else {
            Reported::Fails {
                t_fail_s: 1e-3,
                x_m: 0.0,
                y_m: 0.0,
            }
        }
    };
    let until = |search: &mut PointSearch, n: usize| {
        for _ in 0..n {
            let Some(asked) = search.ask() else { break };
            search.tell(&law(asked.probe.index));
        }
    };
    let mut whole = PointSearch::new(settings, start);
    until(&mut whole, 1000);
    let mut wrong = 0;
    for stop in 0..whole.log().len() {
        let mut first = PointSearch::new(settings, start);
        until(&mut first, stop);
        let mut resumed = PointSearch::new(settings, start);
        for asked in first.log() {
            resumed.tell(&law(asked.probe.index));
        }
        until(&mut resumed, 1000);
        wrong += usize::from(resumed.log() != whole.log());
        wrong += usize::from(resumed.findings().failure != whole.findings().failure);
    }
    // A bisection begun anew between half and twice the last amplitude requested.
    let fails = |a: f64| a >= 233.0;
    let answer = naive::search::bisected(20.0, 2000.0, fails);
    let restarted = whole.log().iter().filter(|asked| {
        let last = settings.grid.amplitude_g(asked.probe.index);
        let again = naive::search::bisected(0.5 * last, 2.0 * last, fails);
        again.to_bits() != answer.to_bits()
    });
    vec![
        Check::none("stops after which a search goes another way", wrong).against(
            "bisection begun anew around the last amplitude",
            restarted.count() as f64,
        ),
        Check::new("probes short of 8", 8.0 - whole.log().len() as f64, 0.0),
    ]
}

pub(super) fn f3() -> Vec<Check> {
    let points = points();
    let n = points.len();
    let forward = run_all(&points, 0..n);
    let backward = run_all(&points, (0..n).rev());
    let mixed = run_all(&points, (0..n).map(|k| (5 * k + 3) % n));
    let criticals = [426.987_658, 256.282_637, 232.422_642, 317.463_645];
    let reversed: Vec<f64> = criticals.iter().rev().copied().collect();
    let one_way = naive::search::each_from_the_last(300.0, &criticals);
    let other_way = naive::search::each_from_the_last(300.0, &reversed);
    let moved = one_way
        .iter()
        .zip(other_way.iter().rev())
        .filter(|(a, b)| a != b);
    vec![
        Check::none(
            "points that differ in another order",
            differing(&forward, &backward) + differing(&forward, &mixed),
        )
        .against(
            "bisections that start from the answer before: of four",
            moved.count() as f64,
        ),
    ]
}

fn outcome(model: &Model, amplitude_g: f64, workspace: &mut Workspace) -> Outcome {
    let request = Request {
        amplitude_m_per_s2: amplitude_g * G,
        record: true,
    };
    simulate(model, &request, workspace)
}

/// Fixed point of a contraction from the final state of a run before, by the solver's own iteration.
fn carried_over(left: f64) -> f64 {
    let mut x = [left];
    FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-12], 20, |x, image| {
        image[0] = 0.5 * x[0] + 1.0;
        true
    });
    x[0]
}

pub(super) fn f4() -> Vec<Check> {
    let model = Model::build(&small_scene(), Scope::Full, None).expect("builds");
    let clean = outcome(&model, 150.0, &mut Workspace::default());
    let mut workspace = Workspace::default();
    let poisoned = outcome(&model, f64::NAN, &mut workspace);
    let after = outcome(&model, 150.0, &mut workspace);
    let decided = !matches!(
        poisoned.verdict,
        Some(opshock_solver::simulation::Verdict::Undecided { .. })
    );
    let undecided = |cause| {
        let (findings, _) = search(settings(), |_, _| Reported::Undecided {
            cause,
            message: String::new(),
        });
        (findings.status, findings.flags)
    };
    let causes = [
        (UndecidedCause::Panicked, Flag::Panicked),
        (UndecidedCause::NotFinite, Flag::NotFinite),
        (UndecidedCause::NotConverged, Flag::NotConverged),
    ];
    let unreported = causes
        .into_iter()
        .filter(|(cause, flag)| {
            let (status, flags) = undecided(*cause);
            status != Status::Undecided || !flags.contains(flag)
        })
        .count();
    vec![
        Check::none(
            "verdicts from an amplitude that is not a number",
            usize::from(decided),
        ),
        Check::none(
            "numbers changed by a poisoned run before",
            usize::from(clean != after),
        )
        .against(
            "iteration started from the state of the run before: not a number",
            f64::from(u8::from(carried_over(f64::NAN).is_nan())),
        ),
        Check::none("causes not told apart", unreported),
    ]
}

pub(super) fn f5() -> Vec<Check> {
    let decay = |keep: fn(f64) -> f64| {
        let oscillator = Oscillator::fixed(6000.0, 0.02);
        let flow = oscillator.flow(1e-4);
        let (mut q, mut r) = (Complex::from(1e-4), Complex::from(0.0));
        let mut sum = 0_u64;
        let mut wrong = 0;
        for _ in 0..80_000 {
            (q, r) = flow.apply(q, r);
            (q, r) = (
                Complex::new(keep(q.re), keep(q.im)),
                Complex::new(keep(r.re), keep(r.im)),
            );
            wrong += usize::from(!(q.re.is_finite() && r.re.is_finite()));
            sum = sum.rotate_left(7) ^ q.re.to_bits();
        }
        (sum, wrong, q.norm())
    };
    let (first, wrong, left) = decay(|x| x);
    let (again, _, _) = decay(|x| x);
    let (other, _, _) = decay(naive::time::flushed);
    vec![
        Check::new(
            "what is left of 0.1 mm after 960 time constants, m",
            left,
            1e-300,
        ),
        Check::none("numbers that are not finite", wrong),
        Check::none(
            "decays that end with other bits",
            usize::from(first != again),
        )
        .against(
            "numbers below 2.2e-308 put to zero: other bits",
            f64::from(u8::from(other != first)),
        ),
    ]
}
