//! Defect corrections kept between processes: the same answers, whatever becomes of the files.

use std::fs;
use std::path::Path;
use std::process::Output;

use opshock_tests::program::program;

use crate::cli::OPSHOCK;

/// A shock on Fig. 13's drive without ramp, with defect corrections kept in `cache`.
fn shock(cache: &Path, more: &[&str]) -> Output {
    let mut command = program(OPSHOCK);
    command.args(["run", "../studies/fig13/study.toml", "--ramp", "none"]);
    command.args(["--pulse-ms", "1", "--sign", "+", "--amplitude-g", "300"]);
    command.args([
        "--set",
        "resolution.preset=coarse",
        "--set",
        "pulse.window_ms=3",
    ]);
    command
        .args(["--set", "pulse.widths_ms=[1.0]", "--json"])
        .args(more);
    command.env("OPSHOCK_CACHE_DIR", cache);
    command.output().expect("starts")
}

/// What it says of the shock, but for the time that it took.
fn answer(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{output:?}");
    let mut answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    answer["cost"]["wall_s"] = serde_json::Value::Null;
    answer
}

fn files(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    entries.map(|entry| entry.expect("read").path()).collect()
}

#[test]
fn a_kept_defect_correction_gives_the_bits_of_a_sampled_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let cache = folder.path().join("new/cache");
    let sampled = answer(&shock(&cache, &["--no-cache"]));
    assert!(!cache.exists());
    assert_eq!(answer(&shock(&cache, &[])), sampled);
    let [file] = &files(&cache)[..] else {
        panic!("one film, one file");
    };
    let sound = fs::read(file).expect("read");
    assert_eq!(answer(&shock(&cache, &[])), sampled);
    // Whatever became of a file, it is sampled anew and replaced.
    let mut flipped = sound.clone();
    flipped[1000] ^= 1;
    for damaged in [&flipped[..], &sound[..500], b""] {
        fs::write(file, damaged).expect("written");
        assert_eq!(answer(&shock(&cache, &[])), sampled);
        assert_eq!(fs::read(file).expect("read"), sound);
    }
    // Another film, another file.
    let other = shock(&cache, &["--set", "disk.rpm=7200"]);
    assert_ne!(answer(&other), sampled);
    let both = files(&cache);
    assert_eq!(both.len(), 2);
    // What is kept is used: with the file of the other film in its place the answer is another.
    let of_other = both.iter().find(|path| *path != file).expect("two");
    fs::copy(of_other, file).expect("copied");
    assert_ne!(answer(&shock(&cache, &[])), sampled);
}

#[test]
fn a_folder_that_cannot_be_written_is_reported_and_costs_no_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("file");
    fs::write(&taken, "no folder").expect("written");
    let output = shock(&taken, &[]);
    answer(&output);
    let reported = String::from_utf8_lossy(&output.stderr);
    let expected = "note: defect corrections are not kept for other processes: ";
    assert!(reported.starts_with(expected), "{reported}");
    assert!(reported.contains("OPSHOCK_CACHE_DIR"), "{reported}");
    assert_eq!(fs::read(&taken).expect("read"), b"no folder");
}
