//! `plan`, `sweep --shard`, `merge` and the job script, through the program.

use std::path::Path;

use crate::cli::{Done, study};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::program::program;

/// Figure 13 without and with the rigid ramp at two widths, coarse: 8 points.
const SMALL: [&str; 8] = [
    "pulse.widths_ms=[0.5, 0.7]",
    "ramp.models=[\"none\", \"rigid\"]",
    "pulse.window_ms=0.8",
    "search.tolerance_pct=5",
    "search.uncertainty=false",
    "resolution.film_cells=200",
    "resolution.disk_cut_khz=10",
    "output.keep_histories=\"none\"",
];

fn words<'a>(command: &'a str, file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec![command, file, "--store", "s.opshock", "--quiet"];
    for set in SMALL {
        words.extend(["--set", set]);
    }
    words.extend(more);
    words
}

fn content(store: &Path) -> Vec<String> {
    dump(&store.join("results.h5"), &["/machine"])
}

#[test]
fn merged_shards_are_the_sweep_bit_for_bit() {
    let root = tempfile::tempdir().unwrap();
    let (whole, parts) = (root.path().join("whole"), root.path().join("parts"));
    std::fs::create_dir(&whole).unwrap();
    std::fs::create_dir(&parts).unwrap();
    let file = study("fig13");
    let file = file.to_str().unwrap();
    let swept = Done::of(&whole, &words("sweep", file, &["-j2"]));
    assert!([0, 4].contains(&swept.code), "{}", swept.stderr);

    // Shards 2 and 3 at the same time; 1 when they have ended.
    let mut running: Vec<_> = ["2/3", "3/3"]
        .map(|shard| {
            program(crate::cli::OPSHOCK)
                .current_dir(&parts)
                .args(words("sweep", file, &["-j1", "--shard", shard]))
                .stdout(std::process::Stdio::null())
                .spawn()
                .expect("starts")
        })
        .into();
    for shard in &mut running {
        let code = shard.wait().expect("waits").code();
        assert!([Some(0), Some(4)].contains(&code), "{code:?}");
    }
    // Before all have run the merged store has open points.
    let merged = Done::of(&parts, &["merge", "s.opshock"]);
    assert!([0, 4].contains(&merged.code), "{}", merged.stderr);
    let last = Done::of(&parts, &words("sweep", file, &["-j1", "--shard", "1/3"]));
    assert!([0, 4].contains(&last.code), "{}", last.stderr);
    let merged = Done::of(&parts, &["merge", "s.opshock"]);
    assert_eq!(merged.code, swept.code, "{}", merged.stderr);
    assert_eq!(merged.stdout, swept.stdout);
    assert_eq!(
        content(&parts.join("s.opshock")),
        content(&whole.join("s.opshock"))
    );
    // Nothing is left for a sweep to do, and what is stored is not simulated twice.
    let again = Done::of(&parts, &words("sweep", file, &["-j1"]));
    assert_eq!(again.stdout, swept.stdout);
    assert_eq!(
        content(&parts.join("s.opshock")),
        content(&whole.join("s.opshock"))
    );
}

#[test]
fn a_shard_that_cannot_be_is_a_command_line_error() {
    let folder = tempfile::tempdir().unwrap();
    let file = study("fig13");
    for shard in ["0/2", "3/2", "2", "a/b"] {
        let done = Done::of(
            folder.path(),
            &["sweep", file.to_str().unwrap(), "--shard", shard],
        );
        assert_eq!(done.code, 2, "{shard}: {}", done.stderr);
    }
    let done = Done::of(folder.path(), &["merge", "s.opshock"]);
    assert_eq!(done.code, 2, "{}", done.stderr);
    std::fs::create_dir(folder.path().join("s.opshock")).unwrap();
    let done = Done::of(folder.path(), &["merge", "s.opshock"]);
    assert_eq!(done.code, 6, "{}", done.stderr);
    assert!(done.stderr.contains("E187"), "{}", done.stderr);
}

#[test]
fn the_plan_holds_what_the_sweep_takes() {
    let folder = tempfile::tempdir().unwrap();
    let file = study("fig13");
    let file = file.to_str().unwrap();
    let plan = Done::of(folder.path(), &words("plan", file, &["--json"])).json();
    assert_eq!(plan["points"], 8);
    assert_eq!(plan["answered"], 0);
    assert!(!folder.path().join("s.opshock").exists(), "nothing written");
    let swept = Done::of(folder.path(), &words("sweep", file, &["--json", "-j2"])).json();
    let runs = swept["totals"]["runs"].as_f64().unwrap();
    let reported = |key: &str| plan["runs"][key].as_f64().unwrap();
    assert!(reported("min") < reported("likely") && reported("likely") < reported("max"));
    // The made-up tables are wide on purpose: what a real one takes lies within.
    assert!(
        reported("min") * 0.5 < runs && runs < reported("max") * 1.5,
        "{runs} runs, planned {}",
        plan["runs"]
    );
    let bytes = std::fs::metadata(folder.path().join("s.opshock/results.h5"))
        .unwrap()
        .len()
        + std::fs::metadata(folder.path().join("s.opshock/journal"))
            .unwrap()
            .len();
    assert!(plan["disk_bytes"].as_u64().unwrap() > bytes / 2);
    assert!(plan["core_h"]["max"].as_f64().unwrap() > 0.0);
    // Afterwards nothing is left.
    let left = Done::of(folder.path(), &words("plan", file, &["--json"])).json();
    assert_eq!(left["answered"], 8);
    assert_eq!(left["runs"]["max"], 0.0);
    assert!(left["reused_runs"].as_f64().unwrap() >= runs);
}

#[test]
fn the_job_script_names_every_task_and_the_settings() {
    let folder = tempfile::tempdir().unwrap();
    let file = study("fig13");
    let more = ["--slurm", "--shards", "4", "-j2"];
    let done = Done::of(folder.path(), &words("plan", file.to_str().unwrap(), &more));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let script = &done.stdout;
    for line in [
        "#!/bin/bash\n",
        "#SBATCH --array=1-4\n",
        "#SBATCH --cpus-per-task=2\n",
        "#SBATCH --signal=B:TERM@60\n",
        "--shard \"$SLURM_ARRAY_TASK_ID/4\" -j 2",
        "--set 'pulse.widths_ms=[0.5, 0.7]'",
    ] {
        assert!(script.contains(line), "{line}\n{script}");
    }
    let check = std::process::Command::new("bash")
        .args(["-n", "-c", script])
        .status();
    assert!(check.expect("bash").success());
}

#[test]
fn another_study_takes_what_is_finished_and_a_watch_ends_with_the_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let file = study("fig13");
    let file = file.to_str().unwrap();
    let first = Done::of(folder.path(), &words("sweep", file, &["--json", "-j2"]));
    assert!([0, 4].contains(&first.code), "{}", first.stderr);
    let mut other: Vec<&str> = words("sweep", file, &["--json", "-j2", "--reuse", "s.opshock"]);
    other.retain(|word| *word != "--quiet");
    other.extend(["--set", "name=\"another\""]);
    let place = other.iter().position(|word| *word == "s.opshock").unwrap();
    other[place] = "other.opshock";
    let second = Done::of(folder.path(), &other);
    assert_eq!(second.code, first.code, "{}", second.stderr);
    let reported = second
        .stderr
        .lines()
        .find(|line| line.contains("taken from other stores"));
    assert!(reported.unwrap().ends_with(", 0 made"), "{}", second.stderr);
    assert_eq!(second.json()["points"], first.json()["points"]);

    let once = Done::of(
        folder.path(),
        &["status", "s.opshock", "--watch", "1", "--json"],
    );
    assert_eq!(once.code, first.code, "{}", once.stderr);
    assert_eq!(once.stdout.lines().count(), 1);
    assert_eq!(once.json()["totals"]["open"], 0);
}
