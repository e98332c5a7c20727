//! Measured pulses: nothing is silently stretched, taken in another unit or cut; samples give what closed forms give.

use std::f64::consts::PI;
use std::path::Path;

use super::cli::Done;
use opshock_solver::shock::PulseShape;
use opshock_study::study::{SetArg, Study, StudyErrors};
use serde_json::Value;

/// A study around the keys of a pulse.
fn study_text(pulse: &str) -> String {
    format!(
        "study_format = 2\nname = \"m\"\n[pulse]\nshape = \"table\"\nsigns = [\"+\"]\n{pulse}\n[ramp]\nmodels = [\"none\"]\n"
    )
}

/// The study in a folder with a record beside it.
fn study(folder: &Path, record: &str, pulse: &str) -> Result<Study, StudyErrors> {
    std::fs::write(folder.join("record.csv"), record).unwrap();
    let file = folder.join("study.toml");
    std::fs::write(
        &file,
        study_text(&format!("table = \"record.csv\"\n{pulse}")),
    )
    .unwrap();
    Study::from_path(&file, &[])
}

const MEASURED: &str =
    "table_scale = \"measured\"\ntable_time_unit = \"s\"\ntable_acceleration_unit = \"g\"\n";

/// A half-sine of 459.2 G and 2 ms in seconds and G, sampled at 100 kHz, 1 ms before it and after it; what else the
/// transducer says is up to the test.
fn record(more: impl Fn(f64) -> f64) -> String {
    let rows = (-100..=300).map(|k| {
        let time_s = 1e-5 * f64::from(k);
        let half_sine = match (0..=200).contains(&k) {
            true => 459.2 * (PI * f64::from(k) / 200.0).sin(),
            false => 0.0,
        };
        format!("{time_s:.5},{:.6}\n", half_sine + more(time_s))
    });
    format!("Time (s),Acceleration (g)\n{}", rows.collect::<String>())
}

/// Times in s and accelerations of the only point.
fn samples(study: &Study) -> (Vec<f64>, Vec<f64>) {
    let pulse = &study.points[0].scene.pulse;
    match &pulse.shape {
        PulseShape::Table { time_s, relative } => {
            assert_eq!(time_s.last(), Some(&pulse.width_s));
            (time_s.clone(), relative.clone())
        }
        other => panic!("{other:?}"),
    }
}

fn remarks(study: &Study) -> Vec<String> {
    study.remarks.iter().map(ToString::to_string).collect()
}

#[test]
fn a_record_in_seconds_is_read_right_or_refused() {
    let at = tempfile::tempdir().unwrap();
    let plain = record(|_| 0.0);
    let right = study(
        at.path(),
        &plain,
        &format!("{MEASURED}table_window_ms = [0, 2]"),
    )
    .unwrap();
    assert_eq!(right.remarks.len(), 0, "{:?}", remarks(&right));
    let (time_s, relative) = samples(&right);
    assert_eq!(time_s.len(), 201);
    assert!((time_s[100] - 1e-3).abs() < 1e-15 && relative[100] == 1.0);
    // Above 10 % of the peak: 2 ms (1 − 2 asin(0.1)/π) = 1.8725 ms.
    assert_eq!(right.widths_ms, [1.872]);
    let measured = right.measured.as_ref().unwrap();
    assert!((measured.used.peak_m_per_s2() - 459.2 * 9.80665).abs() < 1e-6);

    // The study as it was written before: milliseconds, stretched, largest value 1.
    let before = study(at.path(), &plain, "widths_ms = [2.0]").unwrap_err();
    let said = before.to_string();
    assert!(
        said.contains("E112") && said.contains("table_scale = \"stretched\""),
        "{said}"
    );
    // The unit of another column heading.
    let wrong = MEASURED.replace("\"s\"", "\"ms\"");
    let said = study(at.path(), &plain, &wrong).unwrap_err().to_string();
    assert!(said.contains("\"Time (s)\""), "{said}");
    // Without a heading a thousandth of the width is too short for the time step.
    let headless = plain.lines().skip(1).collect::<Vec<_>>().join("\n");
    let said = study(at.path(), &headless, &wrong).unwrap_err().to_string();
    assert!(said.contains("E151"), "{said}");
}

#[test]
fn steps_and_cut_records_are_reported() {
    let at = tempfile::tempdir().unwrap();
    // 23 G of 459.2 G from the end of the pulse on: 5.0 %.
    let offset = record(|t| if t > 1.9999e-3 { 22.96 } else { 0.0 });
    let window = format!("{MEASURED}table_window_ms = [0, 2.5]");
    let warnings = remarks(&study(at.path(), &offset, &window).unwrap());
    assert!(
        warnings.len() == 1 && warnings[0].contains("ends with a step of 5.0 % of its peak"),
        "{warnings:?}"
    );
    // The record ends at a quarter of the way down: sin(0.75 π).
    let cut: String = record(|_| 0.0)
        .lines()
        .take(252)
        .map(|row| format!("{row}\n"))
        .collect();
    let warnings = remarks(&study(at.path(), &cut, MEASURED).unwrap());
    assert!(
        warnings.len() == 1 && warnings[0].contains("inside the pulse, at 70.7 % of its peak"),
        "{warnings:?}"
    );
    let turned = record(|_| 0.0).replace(',', ",-").replace("(s),-", "(s),");
    let turned = turned.replace("--", "");
    let warnings = remarks(&study(at.path(), &turned, MEASURED).unwrap());
    assert!(
        warnings.len() == 1 && warnings[0].contains("peak is negative"),
        "{warnings:?}"
    );
}

#[test]
fn offset_and_drift_are_removed_and_noise_is_filtered() {
    let at = tempfile::tempdir().unwrap();
    let drifting = record(|t| 7.0 - 2000.0 * t);
    let line = format!("{MEASURED}table_window_ms = [0, 2]\ntable_offset = \"line_outside\"");
    let corrected = study(at.path(), &drifting, &line).unwrap();
    let (time_s, relative) = samples(&corrected);
    for (t, a) in time_s.iter().zip(&relative) {
        assert!((a - (PI * t / 2e-3).sin()).abs() < 1e-7, "{t}: {a}");
    }
    // Of the mean before the pulse, 7 − 2000 t over −1 to −0.01 ms, 8.01 G, the drift stays.
    let mean = line.replace("line_outside", "mean_before");
    let shifted = study(at.path(), &drifting, &mean).unwrap();
    let measured = shifted.measured.as_ref().unwrap();
    let end = *measured.used.acceleration_m_per_s2.last().unwrap() / 9.80665;
    assert!((end - (7.0 - 4.0 - 8.01)).abs() < 1e-5, "{end}");
    // 20 % of a sine of 20 kHz makes the highest sample 17 % too high; CFC 1000 takes it away and 0.3 % of the peak:
    // the squared second-order gain at f = 250 Hz, (f/2077.5 Hz)^4, is 2e-4, its curvature at the top more.
    let noisy = record(|t| 91.84 * (2.0 * PI * 20e3 * t + 0.6).sin());
    let window = format!("{MEASURED}table_window_ms = [-0.4, 2.4]\n");
    let peak = |keys: &str| {
        let study = study(at.path(), &noisy, &format!("{window}{keys}")).unwrap();
        study.measured.unwrap().used.peak_m_per_s2() / 9.80665
    };
    assert!(peak("") > 1.1 * 459.2);
    for keys in [
        "table_filter = \"cfc_1000\"",
        "table_cutoff_hz = 1700\ntable_filter_order = 2",
    ] {
        let filtered = peak(keys);
        assert!((filtered / 459.2 - 1.0).abs() < 5e-3, "{filtered}");
    }
}

#[test]
fn samples_take_the_place_of_the_file() {
    let at = tempfile::tempdir().unwrap();
    let keys = format!("{MEASURED}table_window_ms = [0, 2]\ntable_filter = \"cfc_1000\"");
    let measured = study(at.path(), &record(|_| 0.0), &keys).unwrap();
    let again = Study::from_text(&measured.resolved_toml(), &[]).unwrap();
    assert_eq!(again.digest, measured.digest);
    assert_eq!(again.widths_ms, measured.widths_ms);
    assert_eq!(samples(&again), samples(&measured));
    // A stretched file is the study that holds its samples, to the digest.
    let keys = "widths_ms = [2.0]\ntable_scale = \"stretched\"\ntable_time_unit = \"ms\"";
    let stretched = study(at.path(), "0 0\n1 -20\n4 5\n", keys).unwrap();
    let text =
        study_text("widths_ms = [2.0]\ntable_time_ms = [0, 1, 4]\ntable_relative = [0, -20, 5]");
    let given = Study::from_text(&text, &[]).unwrap();
    assert_eq!(stretched.digest, given.digest);
    assert_eq!(
        samples(&stretched),
        (vec![0.0, 0.0005, 0.002], vec![0.0, -1.0, 0.25])
    );
}

/// A coarse drive without a ramp, the critical shock to 0.01 %.
const COARSE: [&str; 7] = [
    "search.tolerance_pct=0.01",
    "search.monotonicity_scan=off",
    "search.uncertainty=false",
    "resolution.preset=coarse",
    "resolution.film_cells=200",
    "resolution.disk_cut_khz=10",
    "pulse.window_ms=2.5",
];

fn with_sets<'a>(command: &[&'a str]) -> Vec<&'a str> {
    let sets = COARSE.iter().flat_map(|set| ["--set", set]);
    command.iter().copied().chain(sets).collect()
}

/// A half-sine of 2 ms in 201 samples: its lines are off by at most (π/200)²/8 = 3e-5 of the peak.
#[test]
fn a_sampled_half_sine_is_a_half_sine() {
    let at = tempfile::tempdir().unwrap();
    study(
        at.path(),
        &record(|_| 0.0),
        &format!("{MEASURED}table_window_ms = [0, 2]"),
    )
    .unwrap();
    let half_sine = study_text("widths_ms = [2.0]").replace("\"table\"", "\"half_sine\"");
    std::fs::write(at.path().join("half_sine.toml"), half_sine).unwrap();
    let run = |file: &str| {
        let command = ["run", file, "--amplitude-g", "300", "--json"];
        let done = Done::of(at.path(), &with_sets(&command));
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.json()["min_clearance_m"].as_f64().unwrap()
    };
    let [sampled, exact] = ["study.toml", "half_sine.toml"].map(run);
    assert!((sampled / exact - 1.0).abs() < 1e-4, "{sampled} {exact}");
    let sweep = |file: &str| {
        let command = [
            "sweep",
            file,
            "--store",
            &format!("{file}.opshock"),
            "--quiet",
            "--json",
        ];
        let done = Done::of(at.path(), &with_sets(&command));
        assert_eq!(done.code, 0, "{}", done.stderr);
        let point: Value = done.json()["points"][0].clone();
        (
            point["a_crit_g"].as_f64().unwrap(),
            point["pulse_ms"].as_f64().unwrap(),
        )
    };
    let [(sampled, width_ms), (exact, _)] = ["study.toml", "half_sine.toml"].map(sweep);
    assert!((sampled / exact - 1.0).abs() < 1e-4, "{sampled} {exact}");
    assert_eq!(width_ms, 1.872);
}

#[test]
fn the_width_of_a_record_cannot_be_chosen() {
    let at = tempfile::tempdir().unwrap();
    study(at.path(), &record(|_| 0.0), MEASURED).unwrap();
    let command = [
        "run",
        "study.toml",
        "--amplitude-g",
        "300",
        "--pulse-ms",
        "2",
    ];
    let done = Done::of(at.path(), &command);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("has its own width"), "{}", done.stderr);
    let set = SetArg::parse("pulse.widths_ms=[2.0]").unwrap();
    let refused = Study::from_path(&at.path().join("study.toml"), &[set]).unwrap_err();
    assert!(refused.to_string().contains("E115"), "{refused}");
}

#[test]
fn the_command_prints_and_draws_the_pulse() {
    let at = tempfile::tempdir().unwrap();
    study(
        at.path(),
        &record(|t| if t > 2.2e-3 { 138.0 } else { 0.0 }),
        MEASURED,
    )
    .unwrap();
    let done = Done::of(
        at.path(),
        &["pulse", "study.toml", "--out", "out", "--json"],
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let json = done.json();
    let number = |path: &str| json.pointer(path).and_then(Value::as_f64).unwrap();
    assert!((number("/record/rate_hz") - 1e5).abs() < 1e-3);
    assert!((number("/pulse/peak_g") - 459.2).abs() < 1e-6);
    assert!((number("/pulse/width_s") - 1.8725e-3).abs() < 1e-7);
    // 138 G after 2.2 ms are 30 % of the peak, outside of the band about the half-sine of 459.2 G and 2 ms.
    let words = [
        "pulse",
        "study.toml",
        "--half-sine-g",
        "459.2",
        "--half-sine-ms",
        "2",
        "--json",
    ];
    let nominal = Done::of(at.path(), &words).json();
    let outside = &nominal["half_sine"]["outside"];
    assert_eq!(outside.as_array().unwrap().len(), 1, "{outside}");
    assert!(
        (outside[0]["from_s"].as_f64().unwrap() - 3.21e-3).abs() < 1e-8,
        "{outside}"
    );
    assert!((outside[0]["share_of_peak"].as_f64().unwrap() - 138.0 / 459.2).abs() < 1e-3);
    for name in ["pulse", "shock_response_spectrum"] {
        for ending in ["svg", "png", "csv"] {
            assert!(at.path().join(format!("out/{name}.{ending}")).is_file());
        }
    }
    let csv = std::fs::read_to_string(at.path().join("out/shock_response_spectrum.csv")).unwrap();
    assert!(
        csv.starts_with("frequency_hz,maximax_g,primary_g,residual_g\n"),
        "{csv}"
    );
    std::fs::write(
        at.path().join("plain.toml"),
        study_text("widths_ms = [2.0]").replace("\"table\"", "\"square\""),
    )
    .unwrap();
    let none = Done::of(at.path(), &["pulse", "plain.toml"]);
    assert_eq!(none.code, 3);
    let usage = Done::of(at.path(), &["pulse", "study.toml", "--q", "0"]);
    assert_eq!(usage.code, 2);
}
