//! `run`: one shock through the program; histories and plots agree with the JSON.

use super::cli::{COARSE, Done, OPSHOCK, files, study};
use opshock_tests::program::program;
use serde_json::Value;
use std::path::Path;

/// Pulses of the paper's drive, on a coarse film and a short window.
const WIDTHS: [&str; 2] = ["--set", "pulse.widths_ms=[0.5]"];

fn run(folder: &Path, more: &[&str]) -> Done {
    let path = study("fig13");
    let shock = [
        "run",
        path.to_str().unwrap(),
        "--ramp",
        "rigid",
        "--pulse-ms",
        "0.5",
        "--sign",
        "+",
    ];
    Done::of(folder, &[&shock[..], &WIDTHS, &COARSE, more].concat())
}

fn number(value: &Value, pointer: &str) -> f64 {
    value
        .pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{pointer}\n{value:#}"))
}

#[test]
fn a_history_agrees_with_the_json() {
    let folder = tempfile::tempdir().unwrap();
    let done = run(
        folder.path(),
        &["--amplitude-g", "250", "--json", "--history", "h.h5"],
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let json = done.json();
    let file = hdf5::File::open(folder.path().join("h.h5")).unwrap();
    let column = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let largest = |name: &str| column(name).into_iter().fold(f64::NEG_INFINITY, f64::max);
    let smallest = |name: &str| column(name).into_iter().fold(f64::INFINITY, f64::min);

    let time = column("time_s");
    assert_eq!(
        time[0], 5e-4,
        "the first sample is the onset on the study's axis"
    );
    assert!(
        (time[time.len() - 1] - 2.0e-3).abs() < 1e-9,
        "the structure runs the whole window"
    );
    let near = |a: f64, b: f64, tolerance: f64| assert!((a - b).abs() <= tolerance, "{a} {b}");
    // Extremes between samples may lie a little further out.
    near(
        largest("disk_slider_m"),
        number(&json, "/disk/slider_max_m"),
        1e-9,
    );
    near(
        smallest("disk_ramp_m"),
        number(&json, "/disk/ramp_min_m"),
        1e-9,
    );
    near(largest("shock_m_per_s2"), 250.0 * 9.80665, 1.0);
    let first_touch = number(&json, "/contact/top/first_touch_s");
    let pressing = column("contact_top_n")
        .iter()
        .position(|force| *force > 0.0)
        .unwrap();
    near(time[pressing], first_touch, 25e-6);

    let head = column("head/time_s");
    assert!(head.is_sorted() && head[0] >= 5e-4);
    let clearance = number(&json, "/min_clearance_m");
    near(smallest("head/min_clearance_m"), clearance, 1e-10);
    near(
        column("head/min_clearance_m")[0],
        number(&json, "/steady/min_clearance_m"),
        1e-12,
    );
    for name in [
        "slider_z_m",
        "slider_pitch_rad",
        "slider_roll_rad",
        "bearing_force_n",
        "bearing_pitch_n_m",
        "bearing_roll_n_m",
        "dimple_force_n",
    ] {
        assert_eq!(column(name).len(), time.len(), "{name}");
        assert_eq!(column(&format!("head/{name}")).len(), head.len(), "{name}");
    }
}

#[test]
fn a_run_writes_only_what_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let done = run(folder.path(), &["--amplitude-g", "50"]);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    assert!(done.stdout.contains("verdict") && done.stdout.contains("no contact"));
    assert_eq!(files(folder.path()).len(), 0);

    let done = run(
        folder.path(),
        &["--amplitude-g", "50", "--history", "h.csv", "--plots", "p"],
    );
    assert_eq!(done.code, 0);
    assert!(done.stderr.contains("wrote h.csv") && !done.stdout.contains("wrote"));
    assert_eq!(files(folder.path()).len(), 2);
    assert_eq!(files(&folder.path().join("p")).len(), 21);
    let csv = std::fs::read_to_string(folder.path().join("h.csv")).unwrap();
    assert!(csv.starts_with("time_s,shock_m_per_s2,disk_slider_m,"));
}

/// A slider below the limit before the shock is no failure by shock: place and amount, exit 3.
#[test]
fn a_slider_below_the_limit_at_the_start_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "--amplitude-g",
        "50",
        "--set",
        "failure.clearance_nm=60",
        "--json",
    ];
    let done = run(folder.path(), &set);
    assert_eq!(done.code, 3, "{}", done.stderr);
    let errors = done.errors();
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0]["code"], "E148");
    let message = errors[0]["message"].as_str().unwrap();
    assert!(message.contains("mm from its leading"), "{message}");
    assert_eq!(files(folder.path()).len(), 0);
}

/// Pressure fields in both formats, those before the touch only, and none without a file.
#[test]
fn pressure_fields_are_written_beside_the_history() {
    let folder = tempfile::tempdir().unwrap();
    let fields = |amplitude_g: &str, times: &str, more: &[&str]| {
        let times = format!("fields.times_ms={times}");
        let set = [
            "--amplitude-g",
            amplitude_g,
            "--set",
            "outputs=[\"min_clearance\",\"pressure_field\"]",
            "--set",
            &times,
        ];
        let done = run(folder.path(), &[&set[..], more].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        done
    };
    let reported = fields("100", "[0.4,0.6]", &[]).stderr;
    assert!(
        reported.contains("pressure fields are kept with --history FILE"),
        "{reported}"
    );
    assert_eq!(files(folder.path()).len(), 0);

    let done = fields("100", "[0.9,0.4]", &["--history", "h.h5"]);
    assert!(
        done.stderr
            .contains("2 of 2 pressure fields in h.h5, group fields"),
        "{}",
        done.stderr
    );
    let file = hdf5::File::open(folder.path().join("h.h5")).unwrap();
    let read = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    let time = read("fields/time_s");
    near(time[0], 4e-4);
    near(time[1], 9e-4);
    let (x, y) = (read("fields/x_lines_m"), read("fields/y_lines_m"));
    near(x[x.len() - 1], 0.85e-3);
    near(y[y.len() - 1], 0.7e-3);
    let shape = [2, y.len() - 1, x.len() - 1];
    for name in ["fields/pressure_pa", "fields/gap_m"] {
        assert_eq!(file.dataset(name).unwrap().shape(), shape, "{name}");
    }
    let (pressure, gap) = (read("fields/pressure_pa"), read("fields/gap_m"));
    let highest = pressure.iter().copied().fold(0.0, f64::max);
    assert!(highest > 5e5 && highest < 1e8, "{highest:e} Pa");

    // The same numbers, a line per time and cell.
    fields("100", "[0.4,0.9]", &["--history", "h.csv"]);
    let csv = std::fs::read_to_string(folder.path().join("h-fields.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("time_s,x_m,y_m,pressure_pa,gap_m"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
    assert_eq!((column(3), column(4)), (pressure, gap));
    near(rows[0][1], 0.5 * x[1]);
    near(rows[0][2], 0.5 * y[1]);

    let done = fields("600", "[0.4,1.9]", &["--history", "t.h5"]);
    assert!(
        done.stderr.contains("1 of 2 pressure fields"),
        "{}",
        done.stderr
    );
    assert!(
        done.stderr
            .contains("the head's run ended before the others")
    );
}

/// In the full model the head goes on after its touch: the same answer, and the histories of the reduced model first.
#[test]
fn a_run_in_full_goes_on_behind_the_touch() {
    let folder = tempfile::tempdir().unwrap();
    let shock = |file: &str, more: &[&str]| {
        let set = ["--amplitude-g", "400", "--json", "--history", file];
        let mut json = run(folder.path(), &[&set[..], more].concat()).json();
        assert_eq!(json["verdict"], "fails");
        let answer = json.as_object_mut().unwrap();
        // Work, what was built and omitted, and the balance that agrees to rounding.
        for key in ["cost", "effects", "rules", "energy"] {
            assert!(answer.remove(key).is_some(), "{key}");
        }
        json
    };
    let answer = shock("auto.h5", &[]);
    assert_eq!(shock("full.h5", &["--set", "solver.effects=full"]), answer);
    let [auto, full] = ["auto.h5", "full.h5"].map(|name| {
        let file = hdf5::File::open(folder.path().join(name)).unwrap();
        move |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap()
    });
    for name in ["time_s", "min_clearance_m", "slider_z_m", "dimple_force_n"] {
        let name = format!("head/{name}");
        assert!(full(&name).starts_with(&auto(&name)), "{name}");
    }
    let last = |column: Vec<f64>| column[column.len() - 1];
    assert_eq!(last(auto("head/time_s")), number(&answer, "/t_fail_s"));
    assert_eq!(last(full("head/time_s")), last(full("time_s")));
    let deepest = full("head/min_clearance_m").into_iter().fold(0.0, f64::min);
    assert!(deepest < 0.0, "{deepest:e}");
}

#[test]
fn a_study_of_the_disk_alone_runs_without_a_head() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "--amplitude-g",
        "250",
        "--json",
        "--set",
        "outputs=[\"disk_displacement\"]",
        "--history",
        "h.h5",
    ];
    let json = run(folder.path(), &set).json();
    let text: Vec<&str> = set.into_iter().filter(|word| *word != "--json").collect();
    let text = run(folder.path(), &text).stdout;
    assert!(text.contains("no verdict: head not simulated"), "{text}");
    assert!(!text.contains("survives"), "{text}");
    for pointer in ["/verdict", "/cause"] {
        assert!(json.pointer(pointer).unwrap().is_null(), "{pointer}");
    }
    for pointer in ["/min_clearance_m", "/steady", "/dimple"] {
        assert!(json.pointer(pointer).unwrap().is_null(), "{pointer}");
    }
    assert_eq!(number(&json, "/cost/film_solves"), 0.0);
    let file = hdf5::File::open(folder.path().join("h.h5")).unwrap();
    assert!(file.group("head").is_err());
}

#[test]
fn a_step_limit_is_undecided_and_exit_4() {
    let folder = tempfile::tempdir().unwrap();
    let done = run(
        folder.path(),
        &[
            "--amplitude-g",
            "250",
            "--json",
            "--set",
            "solver.max_steps=5",
        ],
    );
    assert_eq!(done.code, 4, "{}", done.stderr);
    let json = done.json();
    assert_eq!(json["verdict"], "undecided");
    assert!(json["cause"].as_str().unwrap().contains("5 steps"));
    assert!(json["t_fail_s"].is_null());
}

#[test]
fn open_axes_are_exit_2_and_listed_all_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = study("fig13");
    let done = Done::of(folder.path(), &["run", path.to_str().unwrap(), "--json"]);
    assert_eq!(done.code, 2);
    let keys: Vec<String> = done
        .errors()
        .iter()
        .map(|error| error["key"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(
        keys,
        ["ramp.models", "pulse.widths_ms", "pulse.signs", "amplitude"]
    );
    for wrong in [
        &["--amplitude-g", "-5"][..],
        &["--amplitude-g", "nan"],
        &["--amplitude-g", "5", "--history", "h.txt"],
        &["--amplitude-g", "five"],
    ] {
        let done = run(folder.path(), wrong);
        assert_eq!(done.code, 2, "{wrong:?}: {}", done.stderr);
    }
    assert_eq!(files(folder.path()).len(), 0);
}

#[test]
fn a_small_sweep_resumes_to_the_same_bytes_and_reports() {
    let folder = tempfile::tempdir().unwrap();
    let path = study("fig13");
    let other = tempfile::tempdir().unwrap();
    let sweep_in = |place: &Path, more: &[&str]| {
        let arguments = [
            "sweep",
            path.to_str().unwrap(),
            "--store",
            "s.opshock",
            "--set",
            "ramp.models=[\"rigid\"]",
            "--set",
            "pulse.signs=[\"+\"]",
            "--set",
            "search.tolerance_pct=20",
            "--set",
            "search.monotonicity_scan=off",
            "--max-refinements=0",
        ];
        Done::of(place, &[&arguments[..], &WIDTHS, &COARSE, more].concat())
    };
    let sweep = |more: &[&str]| sweep_in(folder.path(), more);
    for wrong in ["0", "soon", "30m7h", "-1h"] {
        let refused = sweep(&[&format!("--budget={wrong}")]);
        assert_eq!(refused.code, 2, "{}", refused.stderr);
        assert!(refused.stderr.contains("as 7h30m"), "{}", refused.stderr);
        assert_eq!(files(folder.path()).len(), 0);
    }
    let none = sweep(&["--budget", "0s", "--json"]);
    assert_eq!(none.code, 5, "{}", none.stderr);
    assert!(
        none.stderr.contains("resume with: opshock sweep "),
        "{}",
        none.stderr
    );
    let first = sweep(&["--json", "-j1"]);
    assert!([0, 4].contains(&first.code), "{}", first.stderr);
    assert_eq!(first.json()["points"].as_array().map(Vec::len), Some(1));
    // The budget left no trace: a sweep that never had one gives the same bytes.
    let fresh = sweep_in(other.path(), &["--json", "-j1"]);
    assert_eq!(first.stdout, fresh.stdout);
    let again = sweep(&["--json", "-j2", "--quiet"]);
    assert_eq!(again.stderr, "");
    assert_eq!(first.stdout, again.stdout);
    let report = Done::of(folder.path(), &["report", "s.opshock", "--json"]);
    assert_eq!((report.code, report.stdout), (first.code, first.stdout));
}

#[test]
fn doctor_finds_a_sound_machine_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let done = Done::of(folder.path(), &["doctor", "--json"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let checks = done.json()["checks"].as_array().unwrap().clone();
    assert_eq!(checks.len(), 2);
    assert!(checks.iter().all(|check| check["ok"] == true), "{checks:?}");
    assert_eq!(files(folder.path()).len(), 0);
    assert_eq!(
        Done::of(folder.path(), &["doctor", "no/such/folder"]).code,
        6
    );
}

#[test]
fn doctor_runs_the_hard_cases_and_tells_figure_and_bound() {
    let folder = tempfile::tempdir().unwrap();
    let done = Done::of(folder.path(), &["doctor", "--hard-cases", "--json"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let found = done.json();
    assert_eq!(found["ok"], true);
    let cases = found["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 78);
    for case in cases {
        assert_eq!(case["ok"], true, "{case}");
        for check in case["checks"].as_array().unwrap() {
            let (figure, bound) = (check["figure"].as_f64(), check["bound"].as_f64());
            assert!(figure.unwrap() <= bound.unwrap(), "{check}");
        }
    }
    assert_eq!(files(folder.path()).len(), 0);
    let text = Done::of(folder.path(), &["doctor", "--hard-cases"]).stdout;
    // The program, a line a case, the number of cases.
    assert_eq!(text.lines().count(), 80, "{text}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_saves_and_ends_with_the_code_of_the_signal() {
    use std::io::{BufRead as _, BufReader};
    let folder = tempfile::tempdir().unwrap();
    let mut child = program(OPSHOCK)
        .current_dir(folder.path())
        .args([
            "sweep",
            study("fig13").to_str().unwrap(),
            "--store",
            "s.opshock",
            "-j1",
            "--progress",
            "lines",
        ])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    // The second line follows the opening of the store.
    lines.next().unwrap().unwrap();
    lines.next().unwrap().unwrap();
    let pid = child.id().to_string();
    assert!(
        std::process::Command::new("sh")
            .args(["-c", &format!("kill -TERM {pid}")])
            .status()
            .unwrap()
            .success()
    );
    let rest: Vec<String> = lines.map_while(Result::ok).collect();
    assert_eq!(child.wait().unwrap().code(), Some(143), "{rest:?}");
    let resume = rest
        .iter()
        .find(|line| line.contains("resume with: opshock sweep "))
        .expect("the line");
    assert!(resume.ends_with("--store s.opshock"), "{resume}");
}
