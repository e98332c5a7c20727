//! Fuzz tests of the readers of studies, surfaces and sampled pulses.

use std::path::{Path, PathBuf};

use opshock_study::study::samples::{self, Layout, Samples};
use opshock_study::study::source::Source;
use opshock_study::study::text_file::decode;
use opshock_study::study::{Study, StudyError, StudyErrors, fault::MAX_LISTED};
use opshock_tests::seeded::{Seeded, seeds};

use crate::{corpus, mutate, watch};

/// Text of a mutated file: two times in three by lines, else by bytes, where it stays UTF-8.
fn mutated(seed: u64, corpus: &[String]) -> Result<String, StudyErrors> {
    let mut seeded = Seeded::new(seed);
    // Half start from a sound study, or hardly any would come through.
    let n = if seeded.once_in(2) {
        corpus::N_SOUND_STUDIES
    } else {
        corpus.len()
    };
    let base = seeded.one_of(&corpus[..n]).clone();
    if !seeded.once_in(3) {
        return Ok(mutate::text(&mut seeded, &base, corpus));
    }
    let mut bytes = base.into_bytes();
    mutate::bytes(&mut seeded, &mut bytes);
    decode(bytes, "study.toml").map_err(|fault| StudyErrors::from(*fault))
}

/// What must hold of any answer: a refusal has a code and words for every fault, in the order of
/// the file and no more than can be read; what is accepted, written out with all keys, is accepted
/// again as the same study.
fn judge(seed: u64, answer: Result<Study, StudyErrors>) -> bool {
    match answer {
        Ok(study) => {
            assert!(!study.points.is_empty());
            if study.points.len() <= 100 && seed.is_multiple_of(8) {
                let text = study.resolved_toml();
                let again = Study::from_text(&text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
                assert_eq!(text, again.resolved_toml());
                assert_eq!(study.digest_hex(), again.digest_hex(), "{text}");
            }
            true
        }
        Err(errors) => {
            assert!(!errors.errors.is_empty() && errors.errors.len() <= MAX_LISTED);
            for error in &errors.errors {
                assert!(
                    error.code.len() == 4 && !error.message.is_empty(),
                    "{error:?}"
                );
            }
            if seed.is_multiple_of(16) {
                assert!(!errors.to_terminal(80, false).is_empty());
            }
            false
        }
    }
}

fn fuzz_studies(range: std::ops::Range<u64>, report_every: u64) {
    let corpus = corpus::studies();
    watch::run("study", range, report_every, |seed| {
        match mutated(seed, &corpus) {
            Ok(text) => judge(seed, Study::from_text(&text, &[])),
            Err(refused) => judge(seed, Err(refused)),
        }
    });
}

/// A folder in memory where there is one: ten million files need no disk.
fn scratch() -> tempfile::TempDir {
    let memory = Path::new("/dev/shm");
    if memory.is_dir() {
        tempfile::tempdir_in(memory)
    } else {
        tempfile::tempdir()
    }
    .expect("a folder to write in")
}

/// Bytes of a mutated file: two times in three by lines, else by bytes.
fn mutated_file(seed: u64, corpus: &[String]) -> Vec<u8> {
    let mut seeded = Seeded::new(seed);
    let base = seeded.one_of(corpus).clone();
    if !seeded.once_in(3) {
        return mutate::text(&mut seeded, &base, corpus).into_bytes();
    }
    let mut bytes = base.into_bytes();
    mutate::bytes(&mut seeded, &mut bytes);
    bytes
}

/// A file that a sound study names, mutated anew for every seed.
fn fuzz_named(
    name: &str,
    study: &str,
    corpus: &[String],
    range: std::ops::Range<u64>,
    report_every: u64,
) {
    let folder = scratch();
    let at = |file: &str| -> PathBuf { folder.path().join(file) };
    std::fs::write(at("study.toml"), study).expect("written");
    watch::run(name, range, report_every, |seed| {
        std::fs::write(at(name), mutated_file(seed, corpus)).expect("written");
        judge(seed, Study::from_path(&at("study.toml"), &[]))
    });
}

const HEAD: &str = "study_format = 2\nname = \"case\"\n[ramp]\nmodels = [\"rigid\"]\n";

fn fuzz_surfaces(range: std::ops::Range<u64>, report_every: u64) {
    let study = format!(
        "{HEAD}[pulse]\nwidths_ms = [2.0]\nsigns = [\"+\"]\n[slider]\nsurface = {{ file = \"surface\" }}\n"
    );
    fuzz_named("surface", &study, &corpus::surfaces(), range, report_every);
}

/// One in this many pulses is also read as a user's is, by a study that names its file.
const WHOLE: u64 = 64;

/// What must hold of an answer of the pulses' own reader.
fn judge_samples(answer: Result<Samples, Vec<StudyError>>) -> bool {
    match answer {
        Ok(Samples {
            time, acceleration, ..
        }) => {
            assert!(time.len() >= 2 && time.len() == acceleration.len());
            assert!(time.is_sorted_by(|a, b| a < b));
            assert!(time.iter().chain(&acceleration).all(|v| v.is_finite()));
            true
        }
        Err(faults) => {
            assert!(!faults.is_empty());
            for fault in &faults {
                assert!(fault.code == "E153" && !fault.message.is_empty());
            }
            false
        }
    }
}

fn fuzz_pulses(range: std::ops::Range<u64>, report_every: u64) {
    let study = format!(
        "{HEAD}[pulse]\nshape = \"table\"\ntable = \"pulse\"\ntable_scale = \"measured\"\ntable_time_unit = \"ms\"\n\
         table_acceleration_unit = \"g\"\ntable_cutoff_hz = 1500.0\ntable_filter_order = 3\n"
    );
    let layout = Layout {
        columns: [0, 1],
        may_have_more: false,
        skip_rows: 0,
    };
    let folder = scratch();
    let at = |file: &str| -> PathBuf { folder.path().join(file) };
    std::fs::write(at("study.toml"), study).expect("written");
    let corpus = corpus::pulses();
    watch::run("pulse", range, report_every, |seed| {
        let bytes = mutated_file(seed, &corpus);
        if seed.is_multiple_of(WHOLE) {
            std::fs::write(at("pulse"), &bytes).expect("written");
            judge(seed, Study::from_path(&at("study.toml"), &[]));
        }
        match decode(bytes, "pulse") {
            Ok(text) => judge_samples(samples::read(&Source::new("pulse", text), &layout)),
            Err(refused) => judge(seed, Err(StudyErrors::from(*refused))),
        }
    });
}

#[test]
fn mutated_studies_are_read_or_refused() {
    fuzz_studies(0..6_000, 3_000);
}

#[test]
fn mutated_surfaces_are_read_or_refused() {
    fuzz_surfaces(0..3_000, 3_000);
}

#[test]
fn mutated_pulses_are_read_or_refused() {
    fuzz_pulses(0..3_000, 3_000);
}

#[test]
#[ignore = "slow: 10 million executions, about an hour"]
fn fuzz_slow_study() {
    fuzz_studies(seeds(0..10_000_000), 100_000);
}

#[test]
#[ignore = "slow: 10 million executions, about an hour"]
fn fuzz_slow_surface() {
    fuzz_surfaces(seeds(0..10_000_000), 100_000);
}

#[test]
#[ignore = "slow: 10 million executions, about an hour"]
fn fuzz_slow_pulse() {
    fuzz_pulses(seeds(0..10_000_000), 100_000);
}
