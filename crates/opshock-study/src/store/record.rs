//! Record of a finished simulation, and its bytes.
//!
//! Little-endian; lengths before text; a number that does not exist is a zero byte, one that
//! exists a one byte and its eight bytes, so that every double comes back with the same bits.

use opshock_solver::scene::discretisation::Levels;

use crate::search::{ProbeResult, RunCost, UndecidedCause, Verdict};

/// Digest of everything that decides a point's answers but the amplitude.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointDigest(pub [u8; 32]);

impl PointDigest {
    /// Sixty-four hexadecimal digits.
    pub fn hex(&self) -> String {
        self.0.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The same point at other refinement levels.
    #[must_use]
    pub fn changed(&self, levels: Levels) -> PointDigest {
        if levels.is_none() {
            return *self;
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"opshock refinement levels 1");
        hasher.update(&self.0);
        hasher.update(levels.label().as_bytes());
        PointDigest(*hasher.finalize().as_bytes())
    }

    /// Reads sixty-four hexadecimal digits.
    pub fn from_hex(text: &str) -> Option<PointDigest> {
        let mut bytes = [0; 32];
        if text.len() != 64 || !text.is_ascii() {
            return None;
        }
        for (byte, pair) in bytes.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?;
        }
        Some(PointDigest(bytes))
    }
}

impl std::fmt::Debug for PointDigest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", &self.hex()[..12])
    }
}

/// Identity of a simulation by its content: a changed study finds again what is still valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RunKey {
    /// The point.
    pub point: PointDigest,
    /// Bits of the signed amplitude, m/s2.
    pub amplitude_bits: u64,
    /// Multiple of the window.
    pub window_factor: u8,
    /// Place in the order of the retries.
    pub retry: u8,
}

/// Time of the run on its machine, kept apart from results.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunMachine {
    /// Measured time, s.
    pub wall_s: f64,
    /// End of the run, seconds since 1970.
    pub finished_unix_s: f64,
}

/// A finished simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// Identity.
    pub key: RunKey,
    /// Answer.
    pub result: ProbeResult,
    /// Machine.
    pub machine: RunMachine,
}

/// Amplitude of first touch of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchRecord {
    /// The point.
    pub point: PointDigest,
    /// Touch.
    pub touch: StoredTouch,
}

/// First touch as stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoredTouch {
    /// No ramp.
    NoRamp,
    /// At this amplitude, m/s2.
    At(f64),
    /// Not known.
    Unknown,
}

/// One entry of the journal.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// A finished simulation.
    Run(RunRecord),
    /// First touch of a point.
    Touch(TouchRecord),
    /// A process began to write: program, machine, start, as JSON.
    Session(String),
    /// Numbers of a parameter set of a match: not computed, none, or a number.
    Numbers {
        /// What they were made of.
        key: PointDigest,
        /// By the place of the observation.
        numbers: Vec<Option<Option<f64>>>,
    },
}

impl Record {
    /// Kind byte and content.
    pub fn encode(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(192);
        match self {
            Record::Run(run) => {
                out.push(1);
                encode_run(&mut out, run);
            }
            Record::Touch(touch) => {
                out.push(2);
                out.extend_from_slice(&touch.point.0);
                let amplitude = match touch.touch {
                    StoredTouch::NoRamp => (0, 0.0),
                    StoredTouch::At(amplitude) => (1, amplitude),
                    StoredTouch::Unknown => (2, 0.0),
                };
                out.push(amplitude.0);
                out.extend_from_slice(&amplitude.1.to_le_bytes());
            }
            Record::Session(text) => {
                out.push(3);
                put_text(&mut out, text);
            }
            Record::Numbers { key, numbers } => {
                out.push(4);
                out.extend_from_slice(&key.0);
                out.extend_from_slice(&(numbers.len() as u64).to_le_bytes());
                for number in numbers {
                    out.push(match number {
                        None => 0,
                        Some(None) => 1,
                        Some(Some(_)) => 2,
                    });
                    out.extend_from_slice(&number.flatten().unwrap_or(0.0).to_le_bytes());
                }
            }
        }
        out
    }

    /// Reads what [`Record::encode`] wrote; `None` when it is something else.
    pub fn decode(bytes: &[u8]) -> Option<Record> {
        let mut input = Input(bytes);
        let record = match input.byte()? {
            1 => Record::Run(decode_run(&mut input)?),
            2 => {
                let point = PointDigest(input.array()?);
                let kind = input.byte()?;
                let amplitude = input.number()?;
                let touch = match kind {
                    0 => StoredTouch::NoRamp,
                    1 => StoredTouch::At(amplitude),
                    2 => StoredTouch::Unknown,
                    _ => return None,
                };
                Record::Touch(TouchRecord { point, touch })
            }
            3 => Record::Session(input.text()?),
            4 => {
                let key = PointDigest(input.array()?);
                let count = usize::try_from(input.count()?).ok()?;
                if count.checked_mul(9)? != input.0.len() {
                    return None;
                }
                let number = |input: &mut Input<'_>| {
                    let (kind, value) = (input.byte()?, input.number()?);
                    match kind {
                        0 => Some(None),
                        1 => Some(Some(None)),
                        2 => Some(Some(Some(value))),
                        _ => None,
                    }
                };
                let numbers = (0..count).map(|_| number(&mut input));
                Record::Numbers {
                    key,
                    numbers: numbers.collect::<Option<_>>()?,
                }
            }
            _ => return None,
        };
        input.0.is_empty().then_some(record)
    }
}

fn encode_run(out: &mut Vec<u8>, run: &RunRecord) {
    let RunRecord {
        key,
        result,
        machine,
    } = run;
    out.extend_from_slice(&key.point.0);
    out.extend_from_slice(&key.amplitude_bits.to_le_bytes());
    out.push(key.window_factor);
    out.push(key.retry);
    match &result.verdict {
        Verdict::Survives => out.push(0),
        Verdict::Fails { t_fail_s, x_m, y_m } => {
            out.push(1);
            for number in [t_fail_s, x_m, y_m] {
                out.extend_from_slice(&number.to_le_bytes());
            }
        }
        Verdict::Undecided { cause, message } => {
            out.push(2);
            put_text(out, cause.as_str());
            put_text(out, message);
        }
    }
    for number in [result.h_min_m, result.t_min_s] {
        match number {
            None => out.push(0),
            Some(number) => {
                out.push(1);
                out.extend_from_slice(&number.to_le_bytes());
            }
        }
    }
    for count in cost_counts(&result.cost) {
        out.extend_from_slice(&count.to_le_bytes());
    }
    for number in [machine.wall_s, machine.finished_unix_s] {
        out.extend_from_slice(&number.to_le_bytes());
    }
}

fn decode_run(input: &mut Input<'_>) -> Option<RunRecord> {
    let key = RunKey {
        point: PointDigest(input.array()?),
        amplitude_bits: input.count()?,
        window_factor: input.byte()?,
        retry: input.byte()?,
    };
    let verdict = match input.byte()? {
        0 => Verdict::Survives,
        1 => Verdict::Fails {
            t_fail_s: input.number()?,
            x_m: input.number()?,
            y_m: input.number()?,
        },
        2 => Verdict::Undecided {
            cause: UndecidedCause::parse(&input.text()?)?,
            message: input.text()?,
        },
        _ => return None,
    };
    Some(RunRecord {
        key,
        result: ProbeResult {
            verdict,
            h_min_m: input.maybe()?,
            t_min_s: input.maybe()?,
            cost: cost_from([
                input.count()?,
                input.count()?,
                input.count()?,
                input.count()?,
                input.count()?,
                input.count()?,
            ]),
        },
        machine: RunMachine {
            wall_s: input.number()?,
            finished_unix_s: input.number()?,
        },
    })
}

/// Names of a run's numbers of work and what they count, in the order of [`cost_counts`].
pub(super) const COSTS: [(&str, &str); 6] = [
    ("steps", "accepted time steps of the head"),
    ("rejected", "rejected time steps of the head"),
    ("film_solves", "solutions of the film's linear equations"),
    ("factorisations", "factorisations of the film's matrix"),
    ("structure_steps", "time steps of disk and ramp"),
    ("film_unknowns", "cells of the film"),
];

/// Numbers of work of a run.
pub(super) fn cost_counts(cost: &RunCost) -> [u64; 6] {
    [
        cost.steps,
        cost.rejected,
        cost.film_solves,
        cost.factorisations,
        cost.structure_steps,
        cost.film_unknowns,
    ]
}

/// Reads [`cost_counts`] back.
pub(super) fn cost_from(counts: [u64; 6]) -> RunCost {
    let [
        steps,
        rejected,
        film_solves,
        factorisations,
        structure_steps,
        film_unknowns,
    ] = counts;
    RunCost {
        steps,
        rejected,
        film_solves,
        factorisations,
        structure_steps,
        film_unknowns,
    }
}

fn put_text(out: &mut Vec<u8>, text: &str) {
    out.extend_from_slice(&(text.len() as u64).to_le_bytes());
    out.extend_from_slice(text.as_bytes());
}

struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk::<N>()?;
        let head = *head;
        self.0 = rest;
        Some(head)
    }

    fn byte(&mut self) -> Option<u8> {
        self.array::<1>().map(|[byte]| byte)
    }

    fn count(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    fn number(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn maybe(&mut self) -> Option<Option<f64>> {
        match self.byte()? {
            0 => Some(None),
            1 => self.number().map(Some),
            _ => None,
        }
    }

    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.count()?).ok()?;
        if length > self.0.len() {
            return None;
        }
        let (head, rest) = self.0.split_at(length);
        let text = std::str::from_utf8(head).ok()?.to_owned();
        self.0 = rest;
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(verdict: Verdict) -> Record {
        Record::Run(RunRecord {
            key: RunKey {
                point: PointDigest([7; 32]),
                amplitude_bits: (-1234.5_f64).to_bits(),
                window_factor: 2,
                retry: 3,
            },
            result: ProbeResult {
                verdict,
                h_min_m: Some(f64::from_bits(0x3e12_3456_789a_bcde)),
                t_min_s: None,
                cost: cost_from([1, 2, 3, 4, 5, u64::MAX]),
            },
            machine: RunMachine {
                wall_s: 0.1,
                finished_unix_s: 1.7e9,
            },
        })
    }

    #[test]
    fn records_come_back_with_the_same_bits() {
        for record in [
            run(Verdict::Survives),
            run(Verdict::Fails {
                t_fail_s: 1.0 / 3.0,
                x_m: 5e-324,
                y_m: -0.0,
            }),
            run(Verdict::Undecided {
                cause: UndecidedCause::Panicked,
                message: "index 5 out of 4, \u{3bb} < 0".into(),
            }),
            Record::Touch(TouchRecord {
                point: PointDigest([1; 32]),
                touch: StoredTouch::At(0.1),
            }),
            Record::Touch(TouchRecord {
                point: PointDigest([1; 32]),
                touch: StoredTouch::NoRamp,
            }),
            Record::Session("{}".into()),
            Record::Numbers {
                key: PointDigest([9; 32]),
                numbers: vec![None, Some(None), Some(Some(-0.0)), Some(Some(1.0 / 3.0))],
            },
        ] {
            let bytes = record.encode();
            assert_eq!(Record::decode(&bytes), Some(record));
            for cut in 0..bytes.len() {
                assert_eq!(Record::decode(&bytes[..cut]), None);
            }
        }
    }

    #[test]
    fn digests_read_back() {
        let digest = PointDigest(std::array::from_fn(|i| i as u8 * 7));
        assert_eq!(PointDigest::from_hex(&digest.hex()), Some(digest));
        assert_eq!(PointDigest::from_hex("zz"), None);
    }
}
