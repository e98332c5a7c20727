//! Stores with a flipped byte at every offset of the journal and of the results, and with results cut short.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use opshock_study::search::Ramp;
use opshock_study::store::{Record, StoreError, history, journal, load, results};
use opshock_study::sweep::{Silent, SweepEnd, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, study};

use crate::made::{MAKING, OPSHOCK, Reference};

fn run(input: &SweepInput, folder: &Path) -> Result<SweepEnd, StoreError> {
    let mut simulator = MockSimulator::new(input);
    simulator.records = true;
    sweep(
        input,
        &simulator,
        folder,
        &SweepOptions::with_threads(1),
        &Silent,
    )
}

fn swept() -> (tempfile::TempDir, SweepInput, SweepEnd) {
    let folder = tempfile::tempdir().expect("folder");
    let input = study(&[Ramp::None, Ramp::Rigid], &[0.5]);
    let end = run(&input, folder.path()).expect("sweeps");
    (folder, input, end)
}

#[test]
fn a_flipped_byte_anywhere_in_a_journal_costs_one_record_and_alters_none() {
    let (folder, ..) = swept();
    let bytes = std::fs::read(folder.path().join("journal")).expect("journal");
    let path = Path::new("journal");
    let whole = journal::parse(path, &bytes).expect("reads");
    let encoded: Vec<Vec<u8>> = whole.records.iter().map(Record::encode).collect();
    let mut one_lost = 0;
    for place in 0..bytes.len() {
        for flip in [0xff, 1 << (place % 8)] {
            let mut damaged = bytes.clone();
            damaged[place] ^= flip;
            let content = journal::parse(path, &damaged).expect("no newer format");
            let found: Vec<Vec<u8>> = content.records.iter().map(Record::encode).collect();
            // What is left is what was written, in order, but for the record that was hit.
            let first = found
                .iter()
                .zip(&encoded)
                .take_while(|(a, b)| a == b)
                .count();
            let lost = encoded.len() - found.len();
            assert!(lost <= 1, "byte {place}: {lost} records lost");
            assert_eq!(found[first..], encoded[first + lost..], "byte {place}");
            assert!(!content.damage.is_empty(), "byte {place} went unseen");
            one_lost += lost;
        }
    }
    // Every byte behind the header belongs to a record; the header's cost none.
    assert!(one_lost > 2 * bytes.len() * 9 / 10, "{one_lost}");
}

#[test]
fn results_cut_anywhere_are_refused_or_written_anew() {
    let (folder, input, reference) = swept();
    let path = folder.path().join("results.h5");
    let bytes = std::fs::read(&path).expect("results");
    let journal = std::fs::read(folder.path().join("journal")).expect("journal");
    let journal_path = folder.path().join("journal");
    // 97 is prime: cuts fall on all places of a block.
    for cut in (0..bytes.len()).step_by(bytes.len() / 31 + 97) {
        std::fs::write(&path, &bytes[..cut]).expect("writes");
        std::fs::remove_file(&journal_path).expect("removes");
        let error = run(&input, folder.path()).expect_err("is refused");
        assert_eq!(error.code(), "E182", "cut at {cut}");
        assert_eq!(
            std::fs::read(&path).expect("reads").len(),
            cut,
            "kept as it was"
        );
        assert!(!journal_path.exists(), "nothing written");
        // The journal alone is enough, and says so.
        std::fs::write(&journal_path, &journal).expect("writes");
        let (loaded, stored) = load(folder.path()).expect("the journal is sound");
        assert!(stored.is_none());
        assert_eq!(loaded.notes[0].0, "results_damaged");
        let end = run(&input, folder.path()).expect("resumes");
        assert_eq!(end.computed_runs, 0);
        assert_eq!(end.summary, reference.summary);
    }
}

#[test]
fn a_flipped_byte_in_the_results_never_gives_another_table() {
    let (folder, _, reference) = swept();
    let path = folder.path().join("results.h5");
    let bytes = std::fs::read(&path).expect("results");
    let sound = results::read(&path).expect("reads").expect("is there");
    let (mut refused, mut unseen) = (0, 0);
    let end = bytes.len() - 40..bytes.len();
    for place in (0..bytes.len()).step_by(bytes.len() / 400).chain(end) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0xff;
        std::fs::write(&path, &damaged).expect("writes");
        match results::read(&path) {
            Err(error) => {
                assert!(["E181", "E182"].contains(&error.code()), "{error}");
                refused += 1;
            }
            Ok(found) => {
                // The mark of the seal itself.
                let found = found.expect("is there");
                assert_eq!(found.summary, reference.summary, "byte {place}");
                assert_eq!(found.content_digest(), sound.content_digest());
                assert_eq!(found.outside_digest(), sound.outside_digest());
                unseen += 1;
            }
        }
    }
    assert!(refused >= 390, "{refused} refused, {unseen} taken");
}

/// The histories of a store.
fn histories(store: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(store.join("histories")).expect("folder");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("entry").path()).collect();
    files.sort();
    files
}

#[test]
fn every_byte_of_the_first_8_kb_is_sealed() {
    let (folder, ..) = swept();
    let name = Path::new("file.h5");
    let path = &histories(folder.path())[0];
    let mut bytes = std::fs::read(path).expect("history");
    history::parse(name, &bytes).expect("sound");
    for place in 0..8192 {
        bytes[place] ^= 0xff;
        let error = history::parse(name, &bytes).expect_err("is refused");
        assert_eq!(error.code(), "E182", "byte {place}");
        bytes[place] ^= 0xff;
    }
    let mut bytes = std::fs::read(folder.path().join("results.h5")).expect("results");
    results::parse(name, &bytes).expect("sound");
    for place in 0..8192 {
        bytes[place] ^= 0xff;
        let error = results::parse(name, &bytes).expect_err("is refused");
        assert_eq!(error.code(), "E182", "byte {place}");
        bytes[place] ^= 0xff;
    }
}

#[test]
fn the_program_refuses_or_mends_a_store_with_a_flipped_byte() {
    let root = tempfile::tempdir().expect("folder");
    let sweep = Reference::of(MAKING[0], root.path());
    let folder = root.path().join("sweep");
    let store = folder.join("s.opshock");
    let history = &histories(&store)[0];
    let report = || -> Output {
        let words = ["report", "s.opshock", "--out", "out"];
        let mut program = Command::new(OPSHOCK);
        program
            .args(words)
            .current_dir(&folder)
            .output()
            .expect("starts")
    };
    let flip = |path: &Path, place: usize| {
        let mut bytes = std::fs::read(path).expect("reads");
        bytes[place] ^= 0xff;
        std::fs::write(path, bytes).expect("writes");
    };
    let said = |output: &Output| String::from_utf8_lossy(&output.stderr).into_owned();
    // The superblock, a symbol table, a heap, an attribute, values.
    for place in [0, 24, 96, 680, 2048, 5000, 100_000] {
        flip(history, place);
        let refused = report();
        assert_eq!(
            refused.status.code(),
            Some(6),
            "byte {place}: {}",
            said(&refused)
        );
        let reported = "error: E182: s.opshock/histories/";
        assert!(said(&refused).contains(reported), "{}", said(&refused));
        assert!(!folder.join("out").exists());
        sweep.finish(&folder);
    }
    for place in [0, 24, 96, 680, 2048, 5000, 50_000] {
        // With a sound journal the report is whole, its results too, and the next sweep mends.
        flip(&store.join("results.h5"), place);
        let reported = report();
        assert_eq!(
            reported.status.code(),
            Some(0),
            "byte {place}: {}",
            said(&reported)
        );
        assert!(
            said(&reported).contains("warning: results_damaged: E182: "),
            "{}",
            said(&reported)
        );
        let copy = folder.join("out/results.h5");
        results::parse(&copy, &std::fs::read(&copy).expect("reads")).expect("sound");
        std::fs::remove_dir_all(folder.join("out")).expect("removes");
        let journal = std::fs::read(store.join("journal")).expect("reads");
        std::fs::remove_file(store.join("journal")).expect("removes");
        let refused = report();
        assert_eq!(
            refused.status.code(),
            Some(6),
            "byte {place}: {}",
            said(&refused)
        );
        std::fs::write(store.join("journal"), journal).expect("writes");
        sweep.finish(&folder);
    }
}
