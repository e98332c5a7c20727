//! Sweeps on disks that are full, small or read-only.

use std::path::Path;
use std::process::Command;

use opshock_study::sweep::{Silent, SweepEnd, SweepOptions, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use opshock_tests::program::program;

use crate::made::{MAKING, OPSHOCK, Reference};
use crate::mounted::Mounted;

const MOCK: &str = env!("CARGO_BIN_EXE_sweep-mock");

fn finish(folder: &Path) -> SweepEnd {
    let input = fig13();
    let simulator = MockSimulator::new(&input);
    let options = SweepOptions::with_threads(1);
    sweep(&input, &simulator, folder, &options, &Silent).expect("sweeps")
}

/// Sweeps in another process; exit code and what it said on standard error.
fn mock(folder: &Path) -> (Option<i32>, String) {
    let output = program(MOCK)
        .arg(folder)
        .args(["1", "1", "60000"])
        .output()
        .expect("runs");
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    (output.status.code(), said)
}

#[test]
#[ignore = "needs root, to mount: make verify-mounts"]
fn mounts_a_small_file_system_that_fills_up_ends_with_6_and_keeps_what_was_finished() {
    let root = tempfile::tempdir().expect("folder");
    let whole = finish(&root.path().join("whole"));
    let expected = dump(&root.path().join("whole/results.h5"), &["/machine"]);
    let disk = Mounted::tmpfs(&root.path().join("small"), "size=64k");
    let folder = disk.path().join("store");
    let (code, said) = mock(&folder);
    assert_eq!(code, Some(6), "{said}");
    assert!(said.starts_with("E183"), "{said}");
    // Room again: what was finished is used, the answer is the same to the bit.
    disk.remount("size=64m");
    let end = finish(&folder);
    assert!(end.computed_runs < whole.computed_runs);
    assert_eq!(end.summary, whole.summary);
    assert_eq!(dump(&folder.join("results.h5"), &["/machine"]), expected);
}

#[test]
#[ignore = "needs root, to mount: make verify-mounts"]
fn mounts_a_file_system_that_is_full_already_is_reported_before_computing() {
    let root = tempfile::tempdir().expect("folder");
    let disk = Mounted::tmpfs(&root.path().join("full"), "size=16k");
    let ballast = disk.path().join("ballast");
    let mut bytes = 16 << 10;
    while std::fs::write(&ballast, vec![1; bytes]).is_err() {
        bytes -= 1 << 10;
    }
    let (code, said) = mock(disk.path());
    assert_eq!(code, Some(6), "{said}");
    assert!(said.starts_with("E183"), "{said}");
    assert!(!disk.path().join("journal").exists());
}

#[test]
#[ignore = "needs root, to mount: make verify-mounts"]
fn mounts_a_read_only_file_system_is_reported_before_computing() {
    let root = tempfile::tempdir().expect("folder");
    let disk = Mounted::tmpfs(&root.path().join("readonly"), "size=4m");
    let folder = disk.path().join("store");
    finish(&folder);
    let journal = std::fs::read(folder.join("journal")).expect("journal");
    disk.remount("ro");
    let (code, said) = mock(&folder);
    assert_eq!(code, Some(6), "{said}");
    assert!(said.starts_with("E183"), "{said}");
    assert_eq!(
        std::fs::read(folder.join("journal")).expect("journal"),
        journal
    );
    // Reading goes on.
    let table = opshock_study::sweep::stored(&fig13(), &folder).expect("reads");
    assert_eq!(table.summary.totals.open, 0);
}

#[test]
fn a_folder_without_permission_is_reported_before_computing() {
    use std::os::unix::fs::PermissionsExt as _;
    let root = tempfile::tempdir().expect("folder");
    // Root may write anywhere: the program runs as nobody then, who must be able to start it.
    let allowed = |path: &Path, mode: u32| {
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).expect("mode");
    };
    allowed(root.path(), 0o755);
    let program = root.path().join("sweep-mock");
    std::fs::copy(MOCK, &program).expect("copies");
    let folder = root.path().join("store");
    std::fs::create_dir(&folder).expect("folder");
    allowed(&folder, 0o555);
    let run = |words: &[&str]| {
        Command::new(words[0])
            .args(&words[1..])
            .arg(&program)
            .arg(&folder)
            .args(["1", "0"])
            .output()
    };
    let is_root = std::fs::write(folder.join("probe"), []).is_ok();
    let done = if is_root {
        std::fs::remove_file(folder.join("probe")).expect("removes");
        run(&[
            "setpriv",
            "--reuid=65534",
            "--regid=65534",
            "--clear-groups",
        ])
    } else {
        run(&["env"])
    };
    let done = done.expect("setpriv of util-linux");
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(6), "{said}");
    assert!(said.starts_with("E183"), "{said}");
    assert_eq!(std::fs::read_dir(&folder).expect("reads").count(), 0);
}

/// Files longer than a limit cannot be written, for every kind of product: below what the smallest
/// needs, and below what only the longer ones need.
#[test]
fn a_file_that_cannot_grow_is_reported_and_never_half_there() {
    let root = tempfile::tempdir().expect("folder");
    for making in MAKING {
        let reference = Reference::of(making, root.path());
        let mut refused = 0;
        for blocks in [0, 64, 400] {
            let folder = tempfile::tempdir_in(root.path()).expect("folder");
            let limited = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let mut shell = Command::new("sh");
            let output = reference.run(shell.args(["-c", &limited, OPSHOCK]), folder.path());
            reference.judge(folder.path(), &output, true);
            refused += usize::from(!output.status.success());
            reference.finish(folder.path());
        }
        let is_file_made = !reference.files.is_empty();
        assert!(refused >= 2 || !is_file_made, "{}: {refused}", making.name);
    }
}
