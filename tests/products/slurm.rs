//! A job array on a real Slurm: munged, slurmctld and slurmd of this machine on the loopback address.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use crate::cli::{Done, study};
use opshock_study::store::{Record, journal};
use opshock_tests::hdf5_dump::dump;

/// Figure 13 without and with the rigid ramp at three widths, coarse: 12 points.
const SMALL: [&str; 8] = [
    "pulse.widths_ms=[0.5, 0.6, 0.8]",
    "ramp.models=[\"none\", \"rigid\"]",
    "pulse.window_ms=1.0",
    "search.tolerance_pct=1",
    "search.uncertainty=false",
    "resolution.film_cells=300",
    "resolution.disk_cut_khz=10",
    "output.keep_histories=\"none\"",
];

/// Longest time in which nothing at all happens. Work that goes on is waited for, however slowly.
const STANDSTILL: Duration = Duration::from_secs(240);

fn words<'a>(command: &'a str, file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec![command, file, "--store", "s.opshock", "--quiet"];
    for set in SMALL {
        words.extend(["--set", set]);
    }
    words.extend(more);
    words
}

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scripts/slurm-loopback")
}

/// A Slurm that is stopped in the end.
struct Slurm {
    folder: PathBuf,
}

impl Slurm {
    fn start(folder: &Path) -> Slurm {
        let check = Command::new(script())
            .arg("check")
            .output()
            .expect("the script");
        let why = String::from_utf8_lossy(&check.stderr);
        assert!(check.status.success(), "{why}");
        let port = 20_000 + 2 * (std::process::id() % 10_000);
        let output = Command::new(script())
            .arg("start")
            .arg(folder)
            .env("OPSHOCK_SLURM_PORT", port.to_string())
            .output()
            .expect("the script");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        Slurm {
            folder: folder.to_owned(),
        }
    }

    fn run(&self, folder: &Path, words: &[&str]) -> Output {
        Command::new(words[0])
            .args(&words[1..])
            .current_dir(folder)
            .env("SLURM_CONF", self.folder.join("slurm.conf"))
            .output()
            .expect("a program of Slurm")
    }

    fn ask(&self, folder: &Path, words: &[&str]) -> String {
        let output = self.run(folder, words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{words:?}: {said}");
        String::from_utf8(output.stdout).expect("UTF-8")
    }

    /// What the daemons said of jobs.
    fn log(&self) -> String {
        let read = |name: &str| std::fs::read_to_string(self.folder.join(name)).expect("a log");
        let lines = read("slurmctld.log") + &read("slurmd.log");
        let of_jobs = lines
            .lines()
            .filter(|line| line.to_lowercase().contains("job"));
        of_jobs.collect::<Vec<_>>().join("\n")
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        let _ = Command::new(script())
            .arg("stop")
            .arg(&self.folder)
            .status();
    }
}

/// Waits while the shards of `store` make progress.
fn wait(what: &str, store: &Path, mut is_there: impl FnMut() -> bool) {
    let done = || -> usize {
        let shards = (1..=4).map(|number| runs(&store.join(format!("shards/{number}-of-4"))));
        shards.sum()
    };
    let (mut last, mut since) = (done(), Instant::now());
    while !is_there() {
        let now = done();
        if now != last {
            (last, since) = (now, Instant::now());
        }
        assert!(since.elapsed() < STANDSTILL, "{what} did not come");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Sends a signal; whether the process was there to get it.
fn signal(name: &str, process: &str) -> bool {
    let kill = format!("kill -{name} {process}");
    let status = Command::new("sh").args(["-c", &kill]).status();
    status.expect("a shell").success()
}

fn records(store: &Path) -> Vec<Record> {
    let content = journal::read(&store.join("journal")).expect("reads");
    content.map_or(Vec::new(), |content| content.records)
}

fn runs(store: &Path) -> usize {
    let is_run = |record: &&Record| matches!(record, Record::Run(_));
    records(store).iter().filter(is_run).count()
}

/// Process that holds a store, from its lock: process N on HOST since TIME.
fn holder(store: &Path) -> Option<String> {
    let text = std::fs::read_to_string(store.join("lock")).ok()?;
    Some(text.split(' ').nth(1)?.to_owned())
}

#[test]
#[ignore = "needs Slurm: make verify-slurm"]
fn a_job_array_with_a_killed_task_gives_the_table_of_one_machine() {
    let root = tempfile::tempdir().unwrap();
    let slurm = Slurm::start(&root.path().join("slurm"));
    let (whole, parts) = (root.path().join("whole"), root.path().join("parts"));
    std::fs::create_dir(&whole).unwrap();
    std::fs::create_dir(&parts).unwrap();
    let file = study("fig13");
    let file = file.to_str().unwrap();

    let more = ["--slurm", "--shards", "4", "-j1"];
    let planned = Done::of(&parts, &words("plan", file, &more));
    assert_eq!(planned.code, 0, "{}", planned.stderr);
    std::fs::write(parts.join("job.sh"), &planned.stdout).unwrap();
    let job = slurm.ask(&parts, &["sbatch", "--parsable", "job.sh"]);
    let job = job.trim();

    // One task is killed in the middle of its work, reported as failed, and requeued.
    let store = parts.join("s.opshock");
    let victim = store.join("shards/2-of-4");
    // Stopped at every look, so that it cannot end before it is killed, however slow the looks are.
    wait("the second shard", &store, || {
        let Some(process) = holder(&victim).filter(|process| signal("STOP", process)) else {
            return false;
        };
        if runs(&victim) >= 1 {
            return signal("KILL", &process);
        }
        signal("CONT", &process);
        false
    });
    let before = records(&victim);
    let task = format!("{job}_2");
    let state = || {
        slurm.ask(
            &parts,
            &["squeue", "-h", "-t", "all", "-j", &task, "-o", "%T"],
        )
    };
    wait("the end of the killed task", &store, || {
        state().trim() == "FAILED"
    });
    // Refused while the failed task is still being cleared away.
    wait("the requeued task", &store, || {
        slurm.ask(&parts, &["scontrol", "requeue", &task]);
        // A daemon too busy to answer says nothing.
        !["", "FAILED"].contains(&state().trim())
    });
    // Slurm would let it wait for two minutes. A task that starts in the second in which it was killed is
    // refused by slurmd (its clocks count whole seconds): "Job credential revoked".
    slurm.ask(
        &parts,
        &[
            "scontrol",
            "update",
            &format!("JobId={task}"),
            "StartTime=now+2",
        ],
    );
    let states = || {
        let words = ["squeue", "-h", "-t", "all", "-j", job, "-o", "%T"];
        slurm.ask(&parts, &words)
    };
    let ended = |states: &str| {
        let mut lines = states.lines();
        lines.clone().count() == 4 && lines.all(|state| ["COMPLETED", "FAILED"].contains(&state))
    };
    wait("the end of the array", &store, || ended(&states()));
    let states = states();
    let all = states.lines().all(|state| state == "COMPLETED");
    assert!(all, "{states}{}", slurm.log());
    let after = records(&victim);
    assert!(after.starts_with(&before), "what was finished is kept");

    let merged = Done::of(&parts, &["merge", "s.opshock"]);
    let swept = Done::of(&whole, &words("sweep", file, &["-j2"]));
    assert_eq!(merged.code, swept.code, "{}", merged.stderr);
    assert_eq!(merged.stdout, swept.stdout);
    let content = |folder: &Path| dump(&folder.join("s.opshock/results.h5"), &["/machine"]);
    assert!(content(&parts) == content(&whole), "other bits");
}
