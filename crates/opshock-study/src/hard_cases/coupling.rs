//! Hard cases D of coupling: film and slider solved in turn, and the data passed from structure to head.

use super::check::Check;
use super::naive;
use super::scenes::drive::small_scene;
use opshock_solver::fixed_point::{Ending, FixedPoint, Method};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::simulation::{Model, Request, Scope, Workspace, simulate};

const ANDERSON: Method = Method::Anderson { depth: 3 };
const METHODS: [Method; 3] = [Method::Plain, Method::Aitken, ANDERSON];

/// Slope of the map "slider on a film spring", trapezoidal rule: 0.6 mg on 1 MN/m.
fn slope(step_s: f64) -> f64 {
    -1e6 * step_s * step_s / (4.0 * 0.6e-6)
}

fn is_converged(ending: &Ending) -> bool {
    matches!(ending, Ending::Converged { .. })
}

pub(super) fn d1() -> Vec<Check> {
    let (mut apart, mut stuck, mut plain) = (0.0_f64, 0, 0.0_f64);
    for step in [0.5e-6, 1e-6, 2e-6, 5e-6, 1e-5] {
        let slope = slope(step);
        let answer = (3e-9 - slope * 1e-9) / (1.0 - slope);
        let map = |x: &[f64], image: &mut [f64]| {
            image[0] = 3e-9 + slope * (x[0] - 1e-9);
            true
        };
        for method in [Method::Aitken, ANDERSON] {
            let mut x = [0.0];
            let ending = FixedPoint::new(method, 1).solve(&mut x, &[1e-20], 8, map);
            stuck += usize::from(!is_converged(&ending));
            apart = apart.max((x[0] / answer - 1.0).abs());
        }
        let mut x = [0.0];
        FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-20], 8, map);
        plain = plain.max((x[0] / answer - 1.0).abs());
    }
    vec![
        Check::none("steps of 0.5 to 10 us not converged in 8 iterations", stuck),
        Check::new("against the one-matrix solve", apart, 1e-10)
            .against("plain iteration, 8 iterations", plain),
    ]
}

pub(super) fn d2() -> Vec<Check> {
    let (mut wrong, mut moved) = (0, 0.0_f64);
    for method in METHODS {
        let mut x = [0.0, 0.0];
        // Every residual is 1: no secant exists.
        let ending = FixedPoint::new(method, 2).solve(&mut x, &[1e-3; 2], 5, |x, image| {
            image.copy_from_slice(&[x[0] + 1.0, x[1]]);
            true
        });
        wrong += usize::from(!matches!(ending, Ending::NotConverged { .. }));
        wrong += x.iter().filter(|v| !v.is_finite()).count();
        let mut x = [2.0, 3.0];
        let ending = FixedPoint::new(method, 2).solve(&mut x, &[1e-3; 2], 5, |x, image| {
            image.copy_from_slice(x);
            true
        });
        wrong += usize::from(!is_converged(&ending));
        moved = moved.max((x[0] - 2.0).abs() + (x[1] - 3.0).abs());
    }
    vec![
        Check::none("unexpected endings, numbers that are none", wrong).against(
            "Aitken's factor as printed: numbers that are none of two",
            naive::search::aitken_as_printed()
                .iter()
                .filter(|w| !w.is_finite())
                .count() as f64,
        ),
        Check::new("motion of a converged state", moved, 0.0),
    ]
}

pub(super) fn d3() -> Vec<Check> {
    let mut late = 0;
    for method in METHODS {
        let ending = FixedPoint::new(method, 3).solve(&mut [0.0; 3], &[1e-12; 3], 3, |_, image| {
            image.fill(0.0);
            true
        });
        late += usize::from(!matches!(ending, Ending::Converged { iterations: 1, .. }));
    }
    vec![
        Check::none("methods that do not accept rest at once", late).against(
            "tolerance relative to a state of zero",
            METHODS
                .iter()
                .filter(|_| !naive::search::is_relatively_small(0.0, 0.0))
                .count() as f64,
        ),
    ]
}

pub(super) fn d4() -> Vec<Check> {
    let mut sign = 1.0;
    let (mut last, mut change) = (0.0_f64, f64::INFINITY);
    let ending = FixedPoint::new(Method::Aitken, 1).solve(&mut [0.0], &[1e-6], 30, |x, image| {
        sign = -sign;
        change = change.min((x[0] - last).abs());
        last = x[0];
        image[0] = x[0] + sign;
        true
    });
    vec![
        Check::none(
            "stalls taken for convergence",
            usize::from(is_converged(&ending)),
        )
        .against(
            "judged by the change of the iterate, 1e-6",
            f64::from(u8::from(change <= 1e-6)),
        ),
    ]
}

pub(super) fn d5() -> Vec<Check> {
    let mut x = [0.3];
    let capped = FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-300], 4, |x, image| {
        image[0] = x[0].cos();
        true
    });
    let reached = x[0];
    let broken = FixedPoint::new(Method::Plain, 1).solve(&mut x, &[1e-9], 4, |_, image| {
        image[0] = f64::NAN;
        true
    });
    // The answer is cos x = x.
    let (left, tolerance) = ((reached - 0.739_085_133_215_160_6).abs(), 1e-3);
    let reported = [
        matches!(capped, Ending::NotConverged { iterations: 4, .. }),
        matches!(broken, Ending::Broken { iterations: 1 }),
    ];
    vec![
        Check::none(
            "caps and breakdowns accepted",
            reported.iter().filter(|t| !**t).count(),
        )
        .against(
            "the iterate at the cap as the answer: wrong by more than 1e-3",
            f64::from(u8::from(left > tolerance)),
        ),
    ]
}

pub(super) fn d6() -> Vec<Check> {
    let (gap, pitch) = (4e-9, 110e-6);
    let map = |x: &[f64], image: &mut [f64]| {
        let (a, b) = (x[0] - gap, x[1] - pitch);
        image[0] = gap - 0.4 * a + 1e-5 * b;
        image[1] = pitch + 2e3 * a + 0.3 * b;
        true
    };
    let (mut gap_error, mut pitch_error) = (0.0_f64, 0.0_f64);
    for method in METHODS {
        let mut x = [0.0, 0.0];
        FixedPoint::new(method, 2).solve(&mut x, &[1e-13, 1e-9], 60, map);
        gap_error = gap_error.max((x[0] - gap).abs() / 1e-13);
        pitch_error = pitch_error.max((x[1] - pitch).abs() / 1e-9);
    }
    // One norm for both: the gap has no weight beside microradians.
    let mut x = [0.0, 0.0];
    FixedPoint::new(Method::Plain, 2).solve(&mut x, &[1e-9, 1e-9], 60, map);
    vec![
        Check::new("gap, in its tolerance of 0.1 pm", gap_error, 3.0).against(
            "one tolerance of 1e-9 for nm and urad",
            (x[0] - gap).abs() / 1e-13,
        ),
        Check::new("pitch, in its tolerance of 1 nrad", pitch_error, 3.0),
    ]
}

pub(super) fn d7() -> Vec<Check> {
    let scene = small_scene();
    // Loads of one to ten.
    let [light, heavy] = [0.15, 1.5].map(|factor| {
        let mut scene = scene.clone();
        scene.suspension.gram_load_n *= factor;
        scene
    });
    let request = Request {
        amplitude_m_per_s2: 200.0 * G,
        record: true,
    };
    let runs = [
        (&scene, Scope::Full),
        (&scene, Scope::Structure),
        (&light, Scope::Full),
        (&heavy, Scope::Full),
    ]
    .map(|(scene, scope)| {
        let model = Model::assemble(scene, &scope.plan().past_touch(), None).expect("builds");
        simulate(&model, &request, &mut Workspace::default())
    });
    let columns = |k: usize| &runs[k].history.as_ref().expect("recorded").structure;
    let mut differing = 0;
    for k in [1, 2, 3] {
        let (a, b) = (columns(0), columns(k));
        for (a, b) in [
            (&a.disk_slider_m, &b.disk_slider_m),
            (&a.disk_pitch_rad, &b.disk_pitch_rad),
            (&a.disk_roll_rad, &b.disk_roll_rad),
            (&a.contact_top_n, &b.contact_top_n),
        ] {
            differing += usize::from(a.len() != b.len());
            differing += a
                .iter()
                .zip(b)
                .filter(|(a, b)| a.to_bits() != b.to_bits())
                .count();
        }
    }
    // A disk that is marched on the head's own steps depends on the head.
    let marched = [2, 3].map(|k| {
        let times = &runs[k].history.as_ref().expect("recorded").head.time_s;
        let common = times.partition_point(|&t| t < 1e-4);
        naive::time::marched_over(&[&times[..common], &[1e-4]].concat())
    });
    let touched = runs[0].top.first_touch_s.or(runs[0].bottom.first_touch_s);
    vec![
        Check::none("disk and ramp numbers that know of the head", differing).against(
            "a mode marched on the head's steps to 0.1 ms: numbers that differ",
            f64::from(u8::from(marched[0].to_bits() != marched[1].to_bits())),
        ),
        Check::none("runs without contact", usize::from(touched.is_none())),
    ]
}
