//! Writes that fail at every place, and file systems that fill up: `make verify-faults`.
//!
//! A write is made to fail by `strace`, one after the other, with every error a disk has, under
//! each command that makes files. Then the same commands on file systems of every size.

use std::path::Path;
use std::process::Command;

use opshock_tests::seeded::seeds;

use crate::made::{MAKING, Making, OPSHOCK, Reference};
use crate::mounted::Mounted;

/// System calls that fail together; a call that this kernel's library does not use is ignored.
const CALLS: [(&str, &str); 3] = [
    (
        "writes",
        "write,pwrite64,writev,pwritev,pwritev2,sendfile,copy_file_range",
    ),
    ("syncs", "fsync,fdatasync,sync_file_range"),
    (
        "names",
        "rename,renameat,renameat2,ftruncate,mkdir,mkdirat,link,linkat",
    ),
];
const ERRORS: [&str; 2] = ["ENOSPC", "EIO"];

/// File systems from 4 KB (none smaller exists) to 4 MB.
const SIZES: u64 = 256;
const STEP_KB: u64 = 16;

fn emptied(folder: &Path) {
    if folder.exists() {
        std::fs::remove_dir_all(folder).expect("removes");
    }
    std::fs::create_dir(folder).expect("folder");
}

/// Fails the N-th call for every N of a thread's calls; how many runs, and how many of them reported it.
fn failing_calls(reference: &Reference, root: &Path) -> (usize, usize) {
    let (folder, log) = (root.join("disturbed"), root.join("log"));
    let (mut runs, mut refused) = (0, 0);
    for (calls, names) in CALLS {
        for error in ERRORS {
            for number in 1.. {
                emptied(&folder);
                let mut strace = Command::new("strace");
                strace.args(["-f", "-qq", "-o"]).arg(&log);
                strace.args(["-e", &format!("trace={names}")]);
                strace.args(["-e", &format!("inject={names}:error={error}:when={number}")]);
                let output = reference.run(strace.arg(OPSHOCK), &folder);
                let log = std::fs::read_to_string(&log).expect("strace wrote its log");
                if !log.contains("(INJECTED)") {
                    break;
                }
                println!("{} {calls} {error} {number}", reference.making.name);
                let is_disturbed =
                    |line: &str| line.contains("write(2,") && line.contains("(INJECTED)");
                let is_heard = !log.lines().any(is_disturbed);
                reference.judge(&folder, &output, is_heard);
                reference.finish(&folder);
                runs += 1;
                refused += usize::from(!output.status.success());
            }
        }
    }
    (runs, refused)
}

/// Runs on file systems of every size, then on the same with room; how many, and how many reported it.
fn small_disks(reference: &Reference, root: &Path) -> (usize, usize) {
    let disk = Mounted::tmpfs(&root.join("small"), "size=4k");
    let folder = disk.path().join("disturbed");
    let (mut runs, mut refused) = (0, 0);
    for step in seeds(0..SIZES + 1) {
        disk.remount("size=64m");
        emptied(&folder);
        let size_kb = (step * STEP_KB).max(4);
        disk.remount(&format!("size={size_kb}k"));
        println!("{} on {size_kb} KB", reference.making.name);
        let output = reference.run(&mut Command::new(OPSHOCK), &folder);
        reference.judge(&folder, &output, true);
        disk.remount("size=64m");
        reference.finish(&folder);
        runs += 1;
        refused += usize::from(!output.status.success());
    }
    (runs, refused)
}

fn part(names: &[&str]) {
    let strace = Command::new("strace").arg("-V").output();
    assert!(
        strace.is_ok_and(|output| output.status.success()),
        "strace is missing"
    );
    let is_chosen = |making: &&Making| names.contains(&making.name);
    for making in MAKING.iter().filter(is_chosen) {
        let root = tempfile::tempdir().expect("folder");
        let reference = Reference::of(*making, root.path());
        let (runs, refused) = failing_calls(&reference, root.path());
        let (sizes, full) = small_disks(&reference, root.path());
        println!(
            "RESULT {}: {runs} failing calls, {refused} refused; {sizes} small file systems, {full} refused; \
             nothing damaged, everything whole afterwards",
            making.name
        );
        assert!(refused > 0 && (full > 0 || reference.files.is_empty()));
    }
}

#[test]
#[ignore = "needs strace and root, takes minutes: make verify-faults"]
fn faults_slow_sweep() {
    part(&["sweep"]);
}

#[test]
#[ignore = "needs strace and root, takes minutes: make verify-faults"]
fn faults_slow_report() {
    part(&["report", "export_csv"]);
}

#[test]
#[ignore = "needs strace and root, takes minutes: make verify-faults"]
fn faults_slow_export() {
    part(&["export_vtu"]);
}

#[test]
#[ignore = "needs strace and root, takes minutes: make verify-faults"]
fn faults_slow_run() {
    part(&["history_h5", "history_csv", "plots"]);
}
