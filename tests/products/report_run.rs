//! JSON, text and pictures of one simulation.

use opshock_solver::simulation::{
    ArmContact, Cause, Complementarity, Cost, DimpleRecord, DiskExtremes, EnergyBalance, Episode,
    HeadColumns, History, Outcome, Place, SteadyState, StructureColumns, Verdict, Warning,
};
use opshock_study::report::{RunCaption, RunJson, run_figures, run_text, write_figures};
use serde_json::Value;

const START_S: f64 = 5e-4;

fn failing() -> Outcome {
    Outcome {
        hub: None,
        base: None,
        verdict: Some(Verdict::Fails {
            t_fail_s: 1.25e-3,
            place: Place {
                x_m: 8.3e-4,
                y_m: 2.5e-4,
            },
        }),
        min_clearance_m: Some(0.0),
        t_min_clearance_s: Some(1.25e-3),
        lowest: None,
        steady: Some(SteadyState {
            min_clearance_m: 9.15e-9,
            pitch_rad: 1.13e-4,
            roll_rad: 0.0,
        }),
        disk: DiskExtremes {
            slider_max_m: 6.8e-5,
            slider_min_m: -2e-5,
            ramp_max_m: 1e-4,
            ramp_min_m: -5e-5,
            rim_max_m: 1.02e-4,
        },
        top: ArmContact {
            first_touch_s: Some(4.995e-4),
            impulse_n_s: 2.5e-5,
            episodes: vec![Episode {
                on_s: 4.995e-4,
                off_s: 1.42e-3,
                impulse_n_s: 2.5e-5,
                peak_20us_n: 0.8,
            }],
        },
        bottom: ArmContact::default(),
        dimple: Some(DimpleRecord {
            min_force_n: 0.0,
            open_s: 3e-5,
        }),
        limiters: None,
        lift_tab: None,
        slider_contact: None,
        energy: EnergyBalance::default(),
        complementarity: Complementarity::default(),
        rules: vec!["R2", "R10"],
        effects: vec!["disk", "ramp.rigid", "head"],
        warnings: vec![Warning {
            code: "contact_modes",
            message: "a sentence".into(),
        }],
        cost: Cost {
            steps: 812,
            film_solves: 2430,
            ..Cost::default()
        },
        history: None,
    }
}

fn json(outcome: &Outcome) -> Value {
    serde_json::to_value(RunJson::new(outcome, START_S, 0.25)).expect("serialises")
}

fn keys(value: &Value) -> Vec<&str> {
    value
        .as_object()
        .expect("an object")
        .keys()
        .map(String::as_str)
        .collect()
}

#[test]
fn json_has_the_documented_keys() {
    let run = json(&failing());
    let mut top = keys(&run);
    top.sort_unstable();
    assert_eq!(
        top,
        [
            "cause",
            "complementarity",
            "contact",
            "cost",
            "dimple",
            "disk",
            "effects",
            "energy",
            "min_clearance_m",
            "place",
            "rules",
            "steady",
            "t_fail_s",
            "t_min_clearance_s",
            "verdict",
            "warnings"
        ]
    );
    for (object, expected) in [
        ("/steady", &["min_clearance_m", "pitch_rad", "roll_rad"][..]),
        (
            "/disk",
            &[
                "slider_max_m",
                "slider_min_m",
                "ramp_max_m",
                "ramp_min_m",
                "rim_max_m",
            ],
        ),
        (
            "/contact/top",
            &["first_touch_s", "impulse_n_s", "episodes"],
        ),
        (
            "/contact/bottom",
            &["first_touch_s", "impulse_n_s", "episodes"],
        ),
        (
            "/contact/top/episodes/0",
            &["on_s", "off_s", "impulse_n_s", "peak_20us_n"],
        ),
        ("/dimple", &["min_force_n", "open_s"]),
        ("/cost", &["steps", "film_solves", "wall_s"]),
    ] {
        let object_keys = keys(run.pointer(object).expect(object));
        for key in expected {
            assert!(object_keys.contains(key), "{object} has no {key}");
        }
    }
}

#[test]
fn times_are_on_the_studys_axis() {
    let run = json(&failing());
    let time = |pointer: &str| {
        run.pointer(pointer)
            .and_then(Value::as_f64)
            .expect("a number")
    };
    assert!((time("/t_fail_s") - 1.75e-3).abs() < 1e-15);
    assert!((time("/t_min_clearance_s") - 1.75e-3).abs() < 1e-15);
    assert!((time("/contact/top/first_touch_s") - 9.995e-4).abs() < 1e-15);
    assert!((time("/contact/top/episodes/0/off_s") - 1.92e-3).abs() < 1e-15);
    // Spans are not times of day: they do not move with the onset.
    assert_eq!(time("/dimple/open_s"), 3e-5);
}

#[test]
fn what_does_not_exist_is_null_and_never_a_verdict() {
    let mut outcome = failing();
    outcome.verdict = Some(Verdict::Undecided {
        cause: Cause::StepLimit {
            time_s: 1e-3,
            max_steps: 500,
        },
    });
    outcome.min_clearance_m = None;
    outcome.t_min_clearance_s = None;
    outcome.steady = None;
    outcome.dimple = None;
    outcome.disk.rim_max_m = f64::NAN;
    let run = json(&outcome);
    assert_eq!(run["verdict"], "undecided");
    assert_eq!(
        run["cause"],
        "the limit of 500 steps was reached 1000.000 us after the onset"
    );
    for pointer in [
        "/t_fail_s",
        "/place",
        "/min_clearance_m",
        "/t_min_clearance_s",
        "/steady",
        "/dimple",
        "/disk/rim_max_m",
        "/contact/bottom/first_touch_s",
    ] {
        assert!(run.pointer(pointer).expect(pointer).is_null(), "{pointer}");
    }
}

#[test]
fn the_text_tells_verdict_contact_and_warning() {
    let text = run_text(
        "rigid ramp, 400 G",
        &RunJson::new(&failing(), START_S, 0.25),
    );
    for part in [
        "rigid ramp, 400 G",
        "fails at 1.7500 ms, 830 um from the leading and 250 um from the inner edge",
        "steady 9.150 nm, pitch 113.00 urad",
        "first touch 0.9995 ms, impulse 25.000 uN s in 1 episode",
        "ramp bottom no contact",
        "contact_modes: a sentence",
    ] {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(part), "{part}\n{text}");
    }
}

fn history(with_head: bool) -> History {
    let n = 400;
    let time_s: Vec<f64> = (0..n).map(|i| 1e-5 * f64::from(i)).collect();
    let wave: Vec<f64> = time_s.iter().map(|t| (6000.0 * t).sin()).collect();
    let scaled = |by: f64| wave.iter().map(|w| by * w).collect::<Vec<f64>>();
    History {
        fields: None,
        structure: StructureColumns {
            time_s: time_s.clone(),
            shock_m_per_s2: scaled(4000.0),
            disk_slider_m: scaled(6e-5),
            disk_ramp_m: scaled(9e-5),
            disk_rim_m: scaled(9.2e-5),
            disk_pitch_rad: scaled(1e-4),
            disk_roll_rad: scaled(3e-5),
            ramp_top_m: scaled(1e-6),
            ramp_bottom_m: scaled(1e-6),
            contact_top_n: scaled(0.5),
            contact_bottom_n: scaled(0.1),
            energy_j: scaled(1e-6),
            energy_h_j: scaled(1e-6),
            ..StructureColumns::default()
        },
        head: if with_head {
            HeadColumns {
                time_s: time_s[..100].to_vec(),
                slider_z_m: scaled(6e-5)[..100].to_vec(),
                slider_pitch_rad: scaled(1e-4)[..100].to_vec(),
                slider_roll_rad: scaled(3e-5)[..100].to_vec(),
                min_clearance_m: scaled(9e-9)[..100].to_vec(),
                bearing_force_n: scaled(0.02)[..100].to_vec(),
                bearing_pitch_n_m: scaled(1e-9)[..100].to_vec(),
                bearing_roll_n_m: scaled(1e-9)[..100].to_vec(),
                dimple_force_n: scaled(0.02)[..100].to_vec(),
                asperity_force_n: scaled(0.7)[..100].to_vec(),
                ..HeadColumns::default()
            }
        } else {
            HeadColumns::default()
        },
    }
}

#[test]
fn every_picture_is_written_as_svg_png_and_csv() {
    let caption = RunCaption {
        shock: "400 G".into(),
        start_s: START_S,
        width_s: 2e-3,
        t_fail_s: Some(1.49e-3),
        ramp_clearance_m: Some((1e-4, 1e-4)),
        fails_by_damage: false,
        fail_below_m: 0.0,
    };
    let with_head = [
        "shock",
        "disk_displacement",
        "contact_force",
        "pitch",
        "roll",
        "clearance",
        "head_force",
        "slider_contact",
    ];
    let without = ["shock", "disk_displacement", "contact_force", "disk_slope"];
    for (head, expected) in [(true, &with_head[..]), (false, &without[..])] {
        let folder = tempfile::tempdir().unwrap();
        let figures = run_figures(&history(head), &caption);
        let names: Vec<&str> = figures.iter().map(|named| named.name).collect();
        assert_eq!(names, expected);
        assert_eq!(
            write_figures(folder.path(), &figures).unwrap().len(),
            3 * expected.len()
        );
        for name in expected {
            let read = |ending: &str| {
                std::fs::read(folder.path().join(format!("{name}.{ending}"))).unwrap()
            };
            let svg = String::from_utf8(read("svg")).unwrap();
            assert!(
                svg.starts_with("<svg ") && svg.ends_with("</svg>"),
                "{name}"
            );
            assert!(svg.contains("Time (ms)"), "{name}");
            assert!(read("png").starts_with(b"\x89PNG"), "{name}");
            let csv = String::from_utf8(read("csv")).unwrap();
            assert!(csv.starts_with("time_s,"), "{name}");
            let first: f64 = csv
                .lines()
                .nth(1)
                .unwrap()
                .split(',')
                .next()
                .unwrap()
                .parse()
                .unwrap();
            assert_eq!(first, START_S, "{name}: times start at the onset");
        }
    }
}
