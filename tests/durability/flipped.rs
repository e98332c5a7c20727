//! Flipped bytes at every offset of a journal, and of the results; results cut short everywhere.

use std::path::Path;

use opshock_study::search::RampClass;
use opshock_study::store::{Record, StoreError, journal, load, results};
use opshock_study::sweep::{Silent, SweepEnd, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, study};

fn run(input: &SweepInput, folder: &Path) -> Result<SweepEnd, StoreError> {
    sweep(
        input,
        &MockSimulator::new(input),
        folder,
        &SweepOptions::with_threads(1),
        &Silent,
    )
}

fn swept() -> (tempfile::TempDir, SweepInput, SweepEnd) {
    let folder = tempfile::tempdir().expect("folder");
    let input = study(&[RampClass::None, RampClass::Rigid], &[0.5]);
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
