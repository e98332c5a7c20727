//! What commands say they need of memory, against what they took; and what happens where it is refused.

use super::cli::{Done, OPSHOCK, opshock, study};
use opshock_solver::scene::plan::Plan;
use opshock_study::search::uncertainty::finest;
use opshock_study::study::memory::Demand;
use opshock_study::study::{Choice, Ramp, SetArg, Sign, Study};
use opshock_tests::program::program;
use std::path::Path;

/// Peaks lie between 0.6 and 1.3 times the estimate, less 30 MB at the lower end that a thread may take or not.
const FACTORS: [f64; 2] = [0.6, 1.3];
const SLACK: f64 = 30e6;

/// Largest resident memory of the program, bytes.
fn peak(folder: &Path, arguments: &[&str]) -> f64 {
    let status = folder.join("status");
    let output = opshock(folder)
        .env("OPSHOCK_STATUS_FILE", &status)
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    let text = std::fs::read_to_string(status).unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.unwrap().trim().strip_suffix(" kB").unwrap();
    1024.0 * kilobytes.parse::<f64>().unwrap()
}

fn fig13() -> String {
    study("fig13").display().to_string()
}

fn read(sets: &[&str]) -> Study {
    let sets = sets.iter().map(|set| SetArg::parse(set).unwrap());
    Study::from_path(&study("fig13"), &sets.collect::<Vec<_>>()).unwrap()
}

/// The program's peak, less that of one that only reads the study, against the estimate.
fn judge(what: &str, arguments: &[&str], sets: &[&str], estimate: f64) {
    let folder = tempfile::tempdir().unwrap();
    let file = fig13();
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    let all = |words: &[&str]| -> f64 {
        let words = [&words[..1], &[&*file], &words[1..], &sets[..]].concat();
        peak(folder.path(), &words)
    };
    let took = all(arguments) - all(&["check", "--quiet"]);
    println!(
        "{what}: took {:.1} MB, estimated {:.1}",
        took / 1e6,
        estimate / 1e6
    );
    assert!(took >= FACTORS[0] * (estimate - SLACK), "{what}");
    assert!(took <= FACTORS[1] * estimate, "{what}");
}

#[test]
fn estimates_of_single_shocks_hold_against_peaks() {
    let long = "pulse.window_ms=100";
    let times = (1..200).map(|k| format!("{}", 0.01 * f64::from(k)));
    let times = times.collect::<Vec<_>>().join(", ");
    let fields = format!("fields.times_ms=[{times}]");
    let outputs = "outputs=[\"min_clearance\", \"slider_attitude\", \"pressure_field\"]";
    let hub = [
        "hub.axial_stiffness_n_per_m=8e6",
        "hub.tilt_stiffness_n_m_per_rad=300",
        "hub.mass_mg=15000",
        "hub.transverse_inertia_mg_mm2=4e5",
        "hub.polar_inertia_mg_mm2=6e5",
        "pulse.window_ms=20",
    ];
    for (what, sets, kept) in [
        ("film", &["resolution.film_cells=12000"][..], &[][..]),
        (
            "correction",
            &["resolution.film_correction_cells=2500"],
            &[],
        ),
        ("window", &["resolution.film_cells=300", long], &[]),
        ("hub", &hub, &[]),
        (
            "history",
            &["resolution.film_cells=300", long],
            &["--history", "h.h5"],
        ),
        (
            "drawn",
            &["resolution.film_cells=300", long],
            &["--plots", "p"],
        ),
        (
            "fields",
            &["resolution.film_cells=10000", &fields, outputs],
            &["--history", "f.h5"],
        ),
    ] {
        let study = read(sets);
        let point = study.select_point(&Choice {
            ramp: Some(Ramp::Rigid),
            pulse_ms: Some(1.0),
            sign: Some(Sign::Plus),
            amplitude_g: None,
        });
        let demand = Demand::run(&point.unwrap().scene, &study.plan(), !kept.is_empty());
        let mut words = vec!["run", "--ramp", "rigid", "--pulse-ms", "1", "--sign", "+"];
        words.extend(["--amplitude-g", "10", "--quiet"]);
        words.extend(kept);
        judge(what, &words, sets, demand.bytes(1));
    }
    let sets = ["resolution.film_cells=8000"];
    let scene = &read(&sets).points[0].scene;
    let words = ["steady", "--quiet"];
    judge("steady", &words, &sets, Demand::impedance(scene).bytes(1));
}

#[test]
fn the_estimate_of_a_sweep_holds_against_its_peak() {
    for (what, sets) in [
        (
            "time steps",
            [
                "pulse.widths_ms=[0.5, 1.0]",
                "ramp.models=[\"none\", \"rigid\"]",
                "pulse.window_ms=20",
                "search.uncertainty=false",
                "search.tolerance_pct=10",
                "resolution.film_cells=300",
            ],
        ),
        (
            "finer corrections",
            [
                "pulse.widths_ms=[1.0]",
                "ramp.models=[\"none\"]",
                "pulse.window_ms=3",
                "search.max_refinements=0",
                "search.tolerance_pct=10",
                "resolution.film_correction_cells=1500",
            ],
        ),
    ] {
        let study = read(&sets);
        let demand = Demand::sweep(
            &study,
            match study.search.uncertainty {
                true => finest(study.search.max_refinements),
                false => [1.0; 2],
            },
        );
        judge(
            what,
            &["sweep", "--store", "s.opshock", "--quiet", "-j1"],
            &sets,
            demand.bytes(1),
        );
    }
}

/// A defect-correction grid is cut in four.
#[test]
fn the_correction_counts_every_cell_it_builds() {
    let scene = |cells: usize, reference: usize| {
        let sets = [
            format!("resolution.film_cells={cells}"),
            format!("resolution.film_correction_cells={reference}"),
        ];
        read(&[&sets[0], &sets[1]])
    };
    let run = |study: &Study| {
        let plan: Plan = study.plan();
        Demand::run(&study.points[0].scene, &plan, false).film
    };
    // Single precision: 0.6 of a film that flies.
    let ratio = run(&scene(300, 1000)) / run(&scene(4000, 0));
    assert!((ratio - 0.6).abs() < 1e-9, "{ratio}");
}

/// The program with an address space of so many kB.
fn limited(folder: &Path, kilobytes: u32, arguments: &[&str]) -> Done {
    let limit = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\"");
    let under_test = program(OPSHOCK);
    let output = std::process::Command::new("sh")
        .args(["-c", &limit])
        .arg(under_test.get_program())
        .args(under_test.get_args())
        .args(arguments)
        .current_dir(folder)
        .env_remove("RUST_BACKTRACE")
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let code = output.status.code();
    Done {
        code: code.unwrap_or_else(|| panic!("{arguments:?} at {kilobytes} kB: {output:?}")),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

#[test]
fn every_command_that_simulates_is_refused_where_it_does_not_fit() {
    let folder = tempfile::tempdir().unwrap();
    let file = fig13();
    let shock = ["--ramp", "rigid", "--pulse-ms", "1", "--sign", "+"];
    let at = ["--amplitude-g", "100"];
    for (words, more) in [
        (&["run"][..], [&shock[..], &at].concat()),
        (&["steady"], vec![]),
        (&["modes"], vec![]),
        (&["explain"], [&shock[..], &at[..], &["--measure"]].concat()),
        (&["sweep"], vec!["--store", "s.opshock"]),
        (&["accuracy"], vec!["--at", "none:1:+", "--out", "a"]),
        (&["claims"], vec![]),
        (&["figures"], vec!["--out", "f"]),
        (
            &["export"],
            [&shock[..], &at, &["--format", "vtu", "--out", "v"]].concat(),
        ),
    ] {
        let set = ["--set", "resolution.film_cells=1000000", "--json"];
        let all = [words, &[&file], &more, &set].concat();
        let done = limited(folder.path(), 4_000_000, &all);
        assert_eq!(done.code, 3, "{words:?}: {}", done.stderr);
        // Remarks may come before.
        assert!(
            done.stderr.contains("\"E186\""),
            "{words:?}: {}",
            done.stderr
        );
    }
    // Ten seconds in steps of 0.25 us, which may exceed the usual.
    let long = [
        "--set",
        "pulse.window_ms=10000",
        "--accept",
        "W201",
        "--json",
    ];
    for (words, more) in [
        (&["run"][..], [&shock[..], &at].concat()),
        (&["plan"], vec![]),
    ] {
        let all = [words, &[&file], &more, &long].concat();
        let done = limited(folder.path(), 4_000_000, &all);
        assert_eq!(done.code, 3, "{words:?}: {}", done.stderr);
        assert!(
            done.stderr.contains("\"E186\""),
            "{words:?}: {}",
            done.stderr
        );
    }
}

/// With `--memory-gb` the program takes the user's word; what the machine then refuses is a message, not a signal.
#[test]
fn memory_that_is_refused_in_the_end_is_reported_with_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    let file = fig13();
    for kilobytes in (60_000..180_000).step_by(20_000) {
        let store = format!("{kilobytes}.opshock");
        let mut words = vec!["sweep", &file, "--store", &store, "-j1", "--quiet"];
        for set in [
            "pulse.widths_ms=[0.5]",
            "ramp.models=[\"none\"]",
            "pulse.window_ms=200",
            "search.uncertainty=false",
            "resolution.film_cells=300",
        ] {
            words.extend(["--set", set]);
        }
        words.extend(["--memory-gb", "100"]);
        let done = limited(folder.path(), kilobytes, &words);
        assert_eq!(done.code, 1, "{kilobytes}: {}", done.stderr);
        let reported = done.stderr.lines().next().unwrap_or_default();
        assert!(
            reported.starts_with("memory allocation of ") && reported.ends_with(" bytes failed"),
            "{reported}"
        );
    }
}
