//! Stores with torn, flipped, missing, foreign and newer files.

use std::path::Path;

use opshock_study::search::Ramp;
use opshock_study::store::{Store, StoreError, folder::session, journal, results};
use opshock_study::sweep::{Silent, SweepEnd, SweepInput, SweepOptions, sweep};
use opshock_tests::hdf5_dump::{dump, open_rw};
use opshock_tests::mock_sweep::{MockSimulator, Recorder, study};

fn input() -> SweepInput {
    study(&[Ramp::None, Ramp::Rigid], &[0.5, 2.0])
}

fn run(input: &SweepInput, folder: &Path) -> Result<SweepEnd, StoreError> {
    sweep(
        input,
        &MockSimulator::new(input),
        folder,
        &SweepOptions::with_threads(1),
        &Silent,
    )
}

fn code(result: Result<SweepEnd, StoreError>) -> &'static str {
    result.expect_err("is refused").code()
}

/// Sweeps once; returns the folder, its journal and the content of its results.
fn swept() -> (
    tempfile::TempDir,
    SweepInput,
    SweepEnd,
    Vec<u8>,
    Vec<String>,
) {
    let folder = tempfile::tempdir().expect("folder");
    let input = input();
    let end = run(&input, folder.path()).expect("sweeps");
    let journal = std::fs::read(folder.path().join("journal")).expect("journal");
    let content = dump(&folder.path().join("results.h5"), &["/machine"]);
    (folder, input, end, journal, content)
}

/// A generator of places, the same at every run of the tests.
fn places(count: usize, below: usize) -> impl Iterator<Item = usize> {
    let mut state = 88_172_645_463_325_252_u64;
    (0..count).map(move |_| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    })
}

#[test]
fn a_journal_cut_anywhere_loses_only_what_was_cut() {
    let (_folder, input, reference, journal, content) = swept();
    let whole = |bytes: &[u8]| {
        let file = tempfile::NamedTempFile::new().expect("file");
        std::fs::write(file.path(), bytes).expect("writes");
        let content = journal::read(file.path())
            .expect("reads")
            .expect("is there");
        content
            .records
            .iter()
            .filter(|record| matches!(record, opshock_study::store::Record::Run(_)))
            .count() as u64
    };
    let cuts: Vec<usize> = places(60, journal.len())
        .chain([0, 1, 8, 20, journal.len()])
        .collect();
    for cut in cuts {
        let folder = tempfile::tempdir().expect("folder");
        std::fs::write(folder.path().join("journal"), &journal[..cut]).expect("writes");
        let end = run(&input, folder.path()).expect("resumes");
        assert_eq!(end.summary, reference.summary, "cut at {cut}");
        assert_eq!(
            dump(&folder.path().join("results.h5"), &["/machine"]),
            content
        );
        assert_eq!(
            end.computed_runs,
            reference.computed_runs - whole(&journal[..cut]),
            "cut at {cut}"
        );
    }
}

#[test]
fn a_flipped_bit_is_detected_reported_and_costs_one_record() {
    let (_folder, input, reference, journal, content) = swept();
    for place in places(60, journal.len()) {
        let mut bytes = journal.clone();
        bytes[place] ^= 1 << (place % 8);
        let folder = tempfile::tempdir().expect("folder");
        std::fs::write(folder.path().join("journal"), &bytes).expect("writes");
        let recorder = Recorder::default();
        let end = sweep(
            &input,
            &MockSimulator::new(&input),
            folder.path(),
            &SweepOptions::with_threads(1),
            &recorder,
        )
        .expect("resumes");
        assert_eq!(recorder.warnings(), ["journal_damage"], "bit at {place}");
        assert_eq!(end.summary, reference.summary);
        assert_eq!(
            dump(&folder.path().join("results.h5"), &["/machine"]),
            content
        );
        assert!(
            end.computed_runs <= 1,
            "bit at {place}: {}",
            end.computed_runs
        );
        // The journal is sound again.
        let again = journal::read(&folder.path().join("journal"))
            .expect("reads")
            .expect("is there");
        assert!(again.damage.is_empty());
    }
}

#[test]
fn without_the_journal_the_results_are_enough() {
    let (folder, input, reference, _, content) = swept();
    std::fs::remove_file(folder.path().join("journal")).expect("removes");
    let end = run(&input, folder.path()).expect("resumes");
    assert_eq!(end.computed_runs, 0);
    assert_eq!(end.summary, reference.summary);
    assert_eq!(
        dump(&folder.path().join("results.h5"), &["/machine"]),
        content
    );
    // And the journal is whole again: now the results may go.
    std::fs::remove_file(folder.path().join("results.h5")).expect("removes");
    assert_eq!(
        run(&input, folder.path()).expect("resumes").computed_runs,
        0
    );
}

#[test]
fn results_read_back_as_written() {
    let (folder, _, reference, _, _) = swept();
    let read = results::read(&folder.path().join("results.h5"))
        .expect("reads")
        .expect("is there");
    assert_eq!(read.summary, reference.summary);
    assert_eq!(read.runs.len() as u64, reference.summary.totals.runs);
    let copy = folder.path().join("copy.h5");
    results::write(&copy, &read, folder.path()).expect("writes");
    assert_eq!(
        results::read(&copy).expect("reads").expect("is there"),
        read
    );
    let lines = dump(&copy, &[]);
    let names: Vec<&str> = lines
        .iter()
        .filter_map(|line| line.split(' ').next())
        .collect();
    for name in names.iter().filter(|name| !name.contains('@')) {
        for what in ["units", "description"] {
            assert!(
                names.contains(&&*format!("{name}@{what}")),
                "{name} has no {what}"
            );
        }
    }
    for group in [
        "/",
        "/points",
        "/points/axes",
        "/brackets",
        "/runs",
        "/machine",
        "/machine/outside",
    ] {
        assert!(names.contains(&&*format!("{group}@description")), "{group}");
    }

    // Brackets are those of the JSON text, row by row.
    let file = hdf5::File::open(&copy).expect("opens");
    let column = |name: &str| {
        file.dataset(name)
            .expect("a column")
            .read_raw::<f64>()
            .expect("reads")
    };
    let place: Vec<u64> = file.dataset("brackets/point").unwrap().read_raw().unwrap();
    let ends = column("brackets/lower_g")
        .into_iter()
        .zip(column("brackets/upper_g"));
    let found: Vec<(u64, [f64; 2])> = place.into_iter().zip(ends.map(|(a, b)| [a, b])).collect();
    let rows = (0..).zip(&read.summary.points);
    let expected: Vec<(u64, [f64; 2])> = rows
        .flat_map(|(place, row)| row.brackets_g.iter().map(move |pair| (place, *pair)))
        .collect();
    assert!(expected.len() >= read.summary.points.len());
    assert_eq!(found, expected);

    // A store of a program that wrote no descriptions, brackets and names of histories is read the same.
    drop(file);
    let file = open_rw(&copy);
    file.unlink("brackets").expect("removes");
    file.unlink("runs/history").expect("removes");
    for at in ["points", "runs"] {
        file.group(at)
            .unwrap()
            .delete_attr("description")
            .expect("removes");
    }
    file.close().expect("closes");
    assert_eq!(
        results::read(&copy).expect("reads").expect("is there"),
        read
    );
}

#[test]
fn damaged_results_are_refused_unless_the_journal_is_sound() {
    let (folder, input, reference, _, content) = swept();
    let path = folder.path().join("results.h5");
    let bytes = std::fs::read(&path).expect("reads");
    for broken in [&bytes[..bytes.len() / 2], b"not HDF5 at all", &[]] {
        std::fs::write(&path, broken).expect("writes");
        let recorder = Recorder::default();
        let end = sweep(
            &input,
            &MockSimulator::new(&input),
            folder.path(),
            &SweepOptions::with_threads(1),
            &recorder,
        )
        .expect("the journal is sound");
        assert_eq!(recorder.warnings(), ["results_damaged"]);
        assert_eq!(end.summary, reference.summary);
        assert_eq!(dump(&path, &["/machine"]), content);
    }
    std::fs::write(&path, &bytes[..bytes.len() / 2]).expect("writes");
    std::fs::remove_file(folder.path().join("journal")).expect("removes");
    assert_eq!(code(run(&input, folder.path())), "E182");
}

#[test]
fn a_changed_number_in_the_results_is_detected() {
    let (folder, input, ..) = swept();
    let path = folder.path().join("results.h5");
    std::fs::remove_file(folder.path().join("journal")).expect("removes");
    let file = open_rw(&path);
    let column = file.dataset("runs/h_min_m").expect("column");
    let mut values: Vec<f64> = column.read_raw().expect("reads");
    values[3] *= 1.0 + 1e-15;
    column.write_raw(&values).expect("writes");
    file.close().expect("closes");
    assert_eq!(code(run(&input, folder.path())), "E182");
}

#[test]
fn a_newer_store_and_another_study_are_refused_by_name() {
    let (folder, input, ..) = swept();
    let mut other = input.clone();
    other.texts.name = "another".into();
    other.texts.digest = "4567".into();
    assert_eq!(code(run(&other, folder.path())), "E188");

    let file = open_rw(folder.path().join("results.h5"));
    file.attr("format_version")
        .expect("attribute")
        .write_scalar(&99_u32)
        .expect("writes");
    file.close().expect("closes");
    let message = run(&input, folder.path())
        .expect_err("is refused")
        .to_string();
    assert!(
        message.starts_with("E181") && message.contains("99"),
        "{message}"
    );

    // The journal of a newer program, its header's checksum in order.
    std::fs::remove_file(folder.path().join("results.h5")).expect("removes");
    let path = folder.path().join("journal");
    let mut bytes = std::fs::read(&path).expect("reads");
    bytes[8..12].copy_from_slice(&7_u32.to_le_bytes());
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    let crc = crc32fast::hash(&bytes[8..16 + length]);
    bytes[16 + length..20 + length].copy_from_slice(&crc.to_le_bytes());
    std::fs::write(&path, &bytes).expect("writes");
    let error = run(&input, folder.path()).expect_err("is refused");
    assert_eq!(error.code(), "E181");
    assert!(error.to_string().contains("format 7"), "{error}");
}

#[test]
fn a_second_writer_is_reported_who_holds_the_store() {
    let folder = tempfile::tempdir().expect("folder");
    let input = input();
    let (_store, _) = Store::open(folder.path(), &input.texts, &session(1)).expect("opens");
    let error = run(&input, folder.path()).expect_err("is refused");
    assert_eq!(error.code(), "E184");
    let message = error.to_string();
    assert!(
        message.contains(&format!("process {}", std::process::id())),
        "{message}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_computing() {
    let file = tempfile::NamedTempFile::new().expect("file");
    let input = input();
    let simulator = MockSimulator::new(&input);
    let error = sweep(
        &input,
        &simulator,
        &file.path().join("store"),
        &SweepOptions::with_threads(1),
        &Silent,
    )
    .expect_err("is refused");
    assert_eq!(error.code(), "E183");
    assert_eq!(simulator.calls(), 0);
}
