//! Readers that are not ours: `h5dump` and h5py read every dataset of what the program writes, and
//! find units on each.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cli::{Done, study};
use opshock_tests::coarse;
use opshock_tests::hdf5_dump::dump;

/// Prints a line per dataset: path, units, number of entries.
const H5PY: &str = r#"
import sys, h5py
def reported(name, item):
    if isinstance(item, h5py.Dataset):
        units = item.attrs["units"]
        units = units.decode() if isinstance(units, bytes) else units
        values = item[()]
        print("/" + name, repr(units), values.size)
with h5py.File(sys.argv[1], "r") as file:
    file.visititems(reported)
"#;

/// A small sweep with its histories; its HDF5 files.
fn files(folder: &Path) -> Vec<PathBuf> {
    let file = study("fig13");
    let mut words = vec![
        "sweep",
        file.to_str().unwrap(),
        "--store",
        "s.opshock",
        "--quiet",
    ];
    let swept = [
        "pulse.widths_ms=[0.5]",
        "ramp.models=[\"none\", \"rigid\"]",
        "ramp.clearance_um=[80, 100]",
        "output.keep_histories=\"bracket\"",
    ];
    for set in swept.iter().chain(&coarse::SEARCH) {
        words.extend(["--set", set]);
    }
    let done = Done::of(folder, &words);
    assert!([0, 4].contains(&done.code), "{}", done.stderr);
    let store = folder.join("s.opshock");
    let mut files = vec![store.join("results.h5")];
    let histories = std::fs::read_dir(store.join("histories")).unwrap();
    files.extend(histories.take(2).map(|entry| entry.unwrap().path()));
    assert!(files.len() == 3, "{files:?}");
    files
}

/// Paths of the datasets that our own reader finds.
fn datasets(file: &Path) -> Vec<String> {
    let mut found: Vec<String> = dump(file, &[])
        .iter()
        .filter_map(|line| line.split(' ').next())
        .filter(|name| !name.contains('@'))
        .map(str::to_owned)
        .collect();
    found.sort();
    found
}

#[test]
#[ignore = "needs h5dump and h5py: make verify-hdf5"]
fn h5dump_and_h5py_read_every_dataset_with_units() {
    let folder = tempfile::tempdir().unwrap();
    let files = files(folder.path());
    let venv = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/verify-venv/bin/python");
    let python = [venv, "/usr/bin/python3".into(), "python3".into()]
        .into_iter()
        .find(|python| {
            let import = Command::new(python).args(["-c", "import h5py"]).output();
            import.is_ok_and(|output| output.status.success())
        });
    let python = python.expect("a python with h5py: scripts/bootstrap --verify");
    for file in &files {
        let expected = datasets(file);
        assert!(expected.len() >= 15, "{expected:?}");
        // All values, then the attributes alone.
        let whole = Command::new("h5dump").arg(file).output();
        let whole = whole.expect("h5dump of hdf5-tools");
        assert!(whole.status.success(), "{}", file.display());
        assert!(
            whole.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&whole.stderr)
        );
        for name in &expected {
            let output = Command::new("h5dump")
                .args(["-a", &format!("{name}/units")])
                .arg(file)
                .output()
                .unwrap();
            assert!(output.status.success(), "{name} has no units");
        }
        let output = Command::new(&python)
            .args(["-c", H5PY])
            .arg(file)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", file.display());
        let reported = String::from_utf8(output.stdout).unwrap();
        let mut found: Vec<&str> = reported
            .lines()
            .filter_map(|line| line.split(' ').next())
            .collect();
        found.sort_unstable();
        assert_eq!(found, expected, "{}", file.display());
    }
}
