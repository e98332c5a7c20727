//! A journal on a file system that fails, dies or loses power at every system call in turn.
//!
//! Promise: a record that was acknowledged (its append returned, or a session began with it) is in
//! the journal ever after with the same bytes, once; what was not is simulated again; in the end
//! the records are those of an undisturbed sweep.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use opshock_study::search::Ramp;
use opshock_study::store::journal::{self, JournalHeader, JournalWriter};
use opshock_study::store::{Loaded, Record, RunKey, RunRecord, folder};
use opshock_study::sweep::{Silent, SweepInput, SweepOptions, replay, sweep};
use opshock_tests::mock_sweep::{MockSimulator, study};
use opshock_tests::seeded::Seeded;

use crate::sim_files::{Fault, SimFiles};

const JOURNAL: &str = "store/journal";

/// An undisturbed sweep: its input, every record, and its table.
fn undisturbed() -> (SweepInput, Vec<Record>, String) {
    let input = study(&[Ramp::None, Ramp::Rigid], &[0.5]);
    let folder = tempfile::tempdir().expect("folder");
    let end = sweep(
        &input,
        &MockSimulator::new(&input),
        folder.path(),
        &SweepOptions::with_threads(1),
        &Silent,
    )
    .expect("sweeps");
    let content = journal::read(&folder.path().join("journal"))
        .expect("reads")
        .expect("is there");
    let records = content
        .records
        .into_iter()
        .filter(|record| !matches!(record, Record::Session(_)))
        .collect();
    let table = serde_json::to_string(&end.summary).expect("table");
    (input, records, table)
}

/// A record without its time of day, which no promise covers before it is acknowledged.
fn name(record: &Record) -> Vec<u8> {
    match record {
        Record::Run(run) => {
            let RunKey {
                point,
                amplitude_bits,
                window_factor,
                retry,
            } = run.key;
            let mut name = point.0.to_vec();
            name.extend(amplitude_bits.to_le_bytes());
            name.extend([window_factor, retry]);
            name
        }
        Record::Touch(touch) => touch.point.0.to_vec(),
        Record::Numbers { key, .. } => key.0.to_vec(),
        Record::Session(_) => Vec::new(),
    }
}

/// What was promised and what was computed over the life of a store.
#[derive(Default)]
struct Life {
    acknowledged: BTreeMap<Vec<u8>, Vec<u8>>,
    sittings: u64,
}

/// A process as [`opshock_study::store::Store`] and the writer thread do it: reads, writes the
/// journal anew, appends what is missing. `true` when everything is there.
fn sitting(files: &SimFiles, all: &[Record], life: &mut Life, seeded: &mut Seeded) -> bool {
    let path = Path::new(JOURNAL);
    life.sittings += 1;
    let Ok(content) = journal::read_in(files, path) else {
        return false;
    };
    let records = content.map_or(Vec::new(), |content| content.records);
    let header = JournalHeader {
        study: "mock".into(),
        ..JournalHeader::default()
    };
    let session = Record::Session(format!("{{\"sitting\":{}}}", life.sittings));
    let with_session = [records.as_slice(), &[session]].concat();
    let Ok(mut writer) = JournalWriter::create_in(files, path, &header, &with_session) else {
        return false;
    };
    let known: BTreeSet<Vec<u8>> = records.iter().map(name).collect();
    for record in &records {
        if !matches!(record, Record::Session(_)) {
            let bytes = record.encode();
            let first = life
                .acknowledged
                .entry(name(record))
                .or_insert(bytes.clone());
            assert_eq!(*first, bytes, "a record was altered");
        }
    }
    let mut missing: Vec<Record> = all
        .iter()
        .filter(|record| !known.contains(&name(record)))
        .cloned()
        .collect();
    // Threads finish in any order, and each sitting measures other times.
    for i in (1..missing.len()).rev() {
        missing.swap(i, seeded.below(i + 1));
    }
    for record in &mut missing {
        if let Record::Run(RunRecord { machine, .. }) = record {
            machine.wall_s = life.sittings as f64;
        }
    }
    while !missing.is_empty() {
        let batch: Vec<Record> = missing
            .drain(..missing.len().min(1 + seeded.below(4)))
            .collect();
        if writer.append(&batch).is_err() {
            assert!(writer.append(&batch).is_err(), "a failed sync is final");
            return false;
        }
        for record in &batch {
            let before = life.acknowledged.insert(name(record), record.encode());
            assert!(before.is_none(), "a finished simulation was made again");
        }
    }
    true
}

/// Nothing acknowledged is lost, altered or doubled.
fn check(files: &SimFiles, life: &Life) -> Vec<Record> {
    let path = Path::new(JOURNAL);
    let bytes = files.peek(path).unwrap_or_default();
    let records: Vec<Record> = journal::parse(path, &bytes)
        .expect("reads")
        .records
        .into_iter()
        .filter(|record| !matches!(record, Record::Session(_)))
        .collect();
    let mut found = BTreeMap::new();
    for record in &records {
        let doubled = found.insert(name(record), record.encode());
        assert!(doubled.is_none(), "a record is there twice");
    }
    for (name, bytes) in &life.acknowledged {
        assert_eq!(
            found.get(name),
            Some(bytes),
            "a finished simulation is lost"
        );
    }
    records
}

/// What happens to the machine after a sitting ended.
fn after(files: &SimFiles, power: Option<u64>) {
    if let Some(seed) = power {
        files.lose_power(seed);
    }
    files.restart();
}

#[test]
fn no_failing_system_call_costs_a_finished_simulation() {
    let (input, all, table) = undisturbed();
    assert!(all.len() >= 30, "{} records", all.len());
    let mut cases = 0_u64;
    for scenario in 0..28_u64 {
        // Number of calls of a life without faults, broken off once in the middle.
        let dry = SimFiles::new(scenario);
        let calls = {
            let mut seeded = Seeded::new(scenario);
            let half = all.len() / 2;
            let mut life = Life::default();
            assert!(sitting(&dry, &all[..half], &mut life, &mut seeded));
            assert!(sitting(&dry, &all, &mut life, &mut seeded));
            dry.calls()
        };
        for (call, is_write) in calls.into_iter().enumerate() {
            for (i, fault) in Fault::ALL.into_iter().enumerate() {
                if !fault.can_strike(is_write) {
                    continue;
                }
                // Every fault with the power lost right after it, or only at the end of the next
                // sitting, when the page cache has been read and trusted.
                let place = scenario << 32 | (call as u64) << 8 | (i as u64) << 1;
                let at_once = (scenario + call as u64 + i as u64).is_multiple_of(2);
                let files = SimFiles::new(scenario);
                let mut seeded = Seeded::new(scenario);
                let mut life = Life::default();
                files.fail_at(call, fault);
                sitting(&files, &all[..all.len() / 2], &mut life, &mut seeded);
                after(&files, at_once.then_some(place));
                check(&files, &life);
                sitting(&files, &all, &mut life, &mut seeded);
                after(&files, Some(place + 1));
                check(&files, &life);
                if !sitting(&files, &all, &mut life, &mut seeded) {
                    after(&files, None);
                    check(&files, &life);
                    assert!(sitting(&files, &all, &mut life, &mut seeded));
                }
                let records = check(&files, &life);
                assert_eq!(records.len(), all.len(), "complete");
                cases += 1;
                if cases.is_multiple_of(97) {
                    let mut loaded = Loaded::default();
                    loaded.add(records);
                    let results = replay(&input, loaded, &folder::session(1));
                    let now = serde_json::to_string(&results.summary).expect("table");
                    assert_eq!(now, table, "bits of an undisturbed sweep");
                }
            }
        }
    }
    println!("{cases} cases of a failing, dying or unpowered file system");
    assert!(cases >= 8000, "{cases} cases");
}

#[test]
fn lives_of_many_failures_end_whole() {
    let (_, all, _) = undisturbed();
    for seed in 0..400 {
        let files = SimFiles::new(seed);
        let mut seeded = Seeded::new(seed ^ 0xd15c);
        let mut life = Life::default();
        let mut left = 30;
        loop {
            if left > 0 {
                let call = files.calls().len() + seeded.below(20);
                files.fail_at(call, *seeded.one_of(&Fault::ALL));
                left -= 1;
            }
            let whole = sitting(&files, &all, &mut life, &mut seeded);
            let power = seeded.once_in(2).then(|| seeded.bits());
            after(&files, power);
            let records = check(&files, &life);
            if whole {
                assert_eq!(records.len(), all.len());
                break;
            }
        }
    }
}
