//! Fuzz tests of the journal reader: damaged bytes, damaged records under sound checksums, foreign records.

use opshock_study::search::{ProbeResult, RunCost, UndecidedCause, Verdict};
use opshock_study::store::journal::{self, JournalHeader, JournalWriter};
use opshock_study::store::{
    PointDigest, Record, RunKey, RunMachine, RunRecord, StoredTouch, TouchRecord,
};
use opshock_tests::seeded::{Seeded, seeds};
use std::path::Path;

use crate::{mutate, watch};

/// "OPJR", length, checksum.
const FRAME: usize = 12;

fn record(seeded: &mut Seeded) -> Record {
    let mut point = PointDigest([0; 32]);
    point
        .0
        .iter_mut()
        .for_each(|byte| *byte = seeded.bits() as u8);
    let text: String = (0..seeded.below(30))
        .map(|_| *seeded.one_of(&['a', '{', '"', '\u{b5}']))
        .collect();
    match seeded.below(6) {
        0 => Record::Session(text),
        1 => Record::Touch(TouchRecord {
            point,
            touch: *seeded.one_of(&[
                StoredTouch::NoRamp,
                StoredTouch::At(1234.5),
                StoredTouch::Unknown,
            ]),
        }),
        kind => Record::Run(RunRecord {
            key: RunKey {
                point,
                amplitude_bits: seeded.bits(),
                window_factor: seeded.below(3) as u8,
                retry: seeded.below(6) as u8,
            },
            result: ProbeResult {
                verdict: match kind {
                    2 | 3 => Verdict::Survives,
                    4 => Verdict::Fails {
                        t_fail_s: 1e-3,
                        x_m: 2e-4,
                        y_m: -1e-5,
                    },
                    _ => Verdict::Undecided {
                        cause: UndecidedCause::StepLimit,
                        message: text,
                    },
                },
                h_min_m: seeded.once_in(2).then_some(3e-9),
                t_min_s: seeded.once_in(2).then_some(f64::from_bits(seeded.bits())),
                cost: RunCost {
                    steps: seeded.bits(),
                    ..RunCost::default()
                },
            },
            machine: RunMachine::default(),
        }),
    }
}

fn whole_journal(folder: &Path, seed: u64) -> (Vec<u8>, Vec<Record>) {
    let mut seeded = Seeded::new(seed);
    let records: Vec<Record> = (0..1 + seeded.below(6))
        .map(|_| record(&mut seeded))
        .collect();
    let path = folder.join(format!("journal-{seed}"));
    let header = JournalHeader {
        study: "fuzz".into(),
        ..JournalHeader::default()
    };
    JournalWriter::create(&path, &header, &records).expect("written");
    (std::fs::read(&path).expect("read"), records)
}

/// Offsets of the records' frames.
fn frames(bytes: &[u8]) -> Vec<usize> {
    (0..bytes.len().saturating_sub(FRAME))
        .filter(|&i| bytes[i..].starts_with(b"OPJR"))
        .collect()
}

/// Damage inside a record's content under a checksum made anew, so that the decoder sees it.
fn damage_under_checksum(seeded: &mut Seeded, bytes: &mut Vec<u8>) {
    let all = frames(bytes);
    if all.is_empty() {
        return;
    }
    let at = *seeded.one_of(&all);
    let length = u32::from_le_bytes(bytes[at + 4..at + 8].try_into().expect("four")) as usize;
    let end = (at + FRAME + length).min(bytes.len());
    let mut content = bytes[at + FRAME..end].to_vec();
    mutate::bytes(seeded, &mut content);
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&(content.len() as u32).to_le_bytes());
    hasher.update(&content);
    let mut framed = b"OPJR".to_vec();
    framed.extend((content.len() as u32).to_le_bytes());
    framed.extend(hasher.finalize().to_le_bytes());
    framed.extend(content);
    bytes.splice(at..end, framed);
}

/// What must hold of any answer: a journal that opens has its bytes accounted for, and what it
/// gives back encodes and decodes to itself; an undamaged one gives back what was written.
fn fuzz_journals(range: std::ops::Range<u64>, report_every: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let whole: Vec<(Vec<u8>, Vec<Record>)> = (0..40)
        .map(|seed| whole_journal(folder.path(), seed))
        .collect();
    for (bytes, records) in &whole {
        let content = journal::parse(Path::new("journal"), bytes).expect("whole");
        assert!(content.damage.is_empty() && content.records.len() == records.len());
    }
    watch::run("journal", range, report_every, |seed| {
        let mut seeded = Seeded::new(seed);
        let mut bytes = seeded.one_of(&whole).0.clone();
        match seeded.below(4) {
            0 | 1 => damage_under_checksum(&mut seeded, &mut bytes),
            2 => {
                let other = &seeded.one_of(&whole).0;
                let (at, from) = (seeded.below(bytes.len()), seeded.below(other.len()));
                bytes.splice(at.., other[from..].iter().copied());
            }
            _ => {}
        }
        if seeded.once_in(2) {
            mutate::bytes(&mut seeded, &mut bytes);
        }
        let Ok(content) = journal::parse(Path::new("journal"), &bytes) else {
            return false;
        };
        assert!(content.whole_bytes <= bytes.len() as u64);
        let lost: u64 = content.damage.iter().map(|damage| damage.length).sum();
        let kept: usize = content
            .records
            .iter()
            .map(|r| FRAME + r.encode().len())
            .sum();
        assert!(lost + kept as u64 <= bytes.len() as u64);
        for record in &content.records {
            let bytes = record.encode();
            let again = Record::decode(&bytes).expect("what was decoded");
            assert_eq!(again.encode(), bytes);
        }
        content.damage.is_empty()
    });
}

#[test]
fn mutated_journals_are_read_or_refused() {
    fuzz_journals(0..50_000, 50_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_journal() {
    fuzz_journals(seeds(0..10_000_000), 1_000_000);
}
