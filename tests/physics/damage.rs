//! Damage by contact as the failure, in place of the first touch.

use std::sync::OnceLock;

use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{
    Model, Outcome, Request, SliderContact, Verdict, Workspace, simulate,
};
use opshock_tests::scenes;

/// A shock of 700 G for 2 ms on Fig. 13's drive without ramp, with rough surfaces: it touches, flies again and strikes hard.
fn shocked(output: Output, limits: &[(&str, &str)]) -> Outcome {
    shocked_by(700.0, output, limits)
}

/// A shock of an amplitude, in G, on the same drive.
fn shocked_by(amplitude_g: f64, output: Output, limits: &[(&str, &str)]) -> Outcome {
    let common = [
        ("asperity_contact.roughness_nm", "0.5"),
        ("resolution.preset", "\"coarse\""),
    ];
    let settings: Vec<(&str, &str)> = common.into_iter().chain(limits.iter().copied()).collect();
    let scene = scenes::scene("fig13", "none", 2.0, &settings);
    let model = Model::assemble(&scene, &Plan::new(&[output], Mode::Auto), None).expect("a scene");
    let request = Request {
        amplitude_m_per_s2: 9.80665 * amplitude_g,
        record: false,
    };
    simulate(&model, &request, &mut Workspace::default())
}

/// The whole motion, where the first touch is the failure.
fn whole() -> &'static Outcome {
    static WHOLE: OnceLock<Outcome> = OnceLock::new();
    WHOLE.get_or_init(|| shocked(Output::SliderContact, &[]))
}

fn damaged(limit: (&str, &str)) -> Outcome {
    let criterion = ("failure.criterion", "\"damage\"");
    shocked(Output::CriticalShock, &[criterion, limit])
}

fn contact(outcome: &Outcome) -> &SliderContact {
    outcome.slider_contact.as_ref().expect("rough surfaces")
}

fn failed_s(outcome: &Outcome) -> f64 {
    match outcome.verdict {
        Some(Verdict::Fails { t_fail_s, .. }) => t_fail_s,
        ref other => panic!("{other:?}"),
    }
}

/// The contact of [`whole`] without works and energy, which runs have that are asked for their contacts.
fn whole_motion() -> SliderContact {
    let mut motion = contact(whole()).clone();
    motion.energy = None;
    for episode in &mut motion.episodes {
        episode.work = None;
    }
    motion
}

#[test]
fn a_touch_is_no_failure_below_the_limit_of_damage() {
    let touch = whole();
    let harmless = damaged(("failure.damage.overlap_nm", "1000.0"));
    assert_eq!(harmless.verdict, Some(Verdict::Survives));
    // The same motion, bit for bit, to the end of the window.
    assert!(*contact(&harmless) == whole_motion());
    assert_eq!(contact(&harmless).touched_s, Some(failed_s(touch)));
    assert_eq!(harmless.cost.steps, touch.cost.steps);
}

#[test]
fn a_run_fails_in_the_first_contact_that_exceeds_a_limit() {
    let episodes = whole_motion().episodes;
    let hardest_gpa = |place: usize| 1e-9 * episodes[place].peak_pressure_pa;
    // A limit that the first contacts do not reach.
    let pressure_gpa = 8.0;
    let first = |exceeds: &dyn Fn(usize) -> bool| (0..episodes.len()).find(|&at| exceeds(at));
    for (limit, exceeds) in [
        (
            ("failure.damage.contacts", "0".to_owned()),
            &(|_| true) as &dyn Fn(usize) -> bool,
        ),
        (("failure.damage.contacts", "3".to_owned()), &|at| at >= 3),
        (
            ("failure.damage.pressure_gpa", pressure_gpa.to_string()),
            &|at| hardest_gpa(at) > pressure_gpa,
        ),
    ] {
        let outcome = damaged((limit.0, &limit.1));
        let place = first(exceeds).expect("some contact exceeds it");
        let (failed_s, episode) = (failed_s(&outcome), &episodes[place]);
        let during = episode.on_s..=episode.off_s;
        assert!(
            during.contains(&failed_s),
            "{limit:?}: {failed_s} in {episode:?}"
        );
        // What came before is what it was, and what comes after is not simulated.
        let seen = &contact(&outcome).episodes;
        assert_eq!(seen.len(), place + 1, "{limit:?}");
        assert_eq!(seen[..place], episodes[..place], "{limit:?}");
    }
    assert!(hardest_gpa(0) < pressure_gpa);
}

#[test]
fn an_overlap_called_damage_is_found_where_a_clearance_below_zero_is() {
    let overlapped = damaged(("failure.damage.overlap_nm", "2.0"));
    let below = shocked(Output::CriticalShock, &[("failure.clearance_nm", "-2.0")]);
    assert_eq!(overlapped.verdict, below.verdict);
    assert_eq!(overlapped.min_clearance_m, below.min_clearance_m);
    assert!(failed_s(&overlapped) > failed_s(whole()));
    assert_eq!(contact(&overlapped).touched_s, Some(failed_s(whole())));
}

#[test]
fn the_first_touch_is_reported_when_damage_came_before_it() {
    // Asperities carry the slider of a compressed film before mean planes meet.
    let of = |limits: &[(&str, &str)]| shocked_by(-1800.0, Output::SliderContact, limits);
    let touch = of(&[]);
    let damage = of(&[
        ("failure.criterion", "\"damage\""),
        ("failure.damage.contacts", "0"),
    ]);
    assert!(failed_s(&damage) < failed_s(&touch));
    assert_eq!(contact(&damage).touched_s, Some(failed_s(&touch)));
}
