//! Content of `results.h5` for a study: its runs, points and sessions.

use std::collections::HashMap;
use std::path::Path;

use opshock_solver::scene::discretisation::Levels;
use opshock_solver::simulation::Mechanism;

use crate::provenance;
use crate::search::{ProbeResult, Purpose, Verdict};
use crate::store::error::StoreError;
use crate::store::history::KeptRun;
use crate::store::record::{PointDigest, Record, RunMachine, RunRecord, StoredTouch, TouchRecord};
use crate::store::summary::Summary;

/// Number of the format of `results.h5`; raised when an older reader would go wrong.
pub const RESULTS_FORMAT: u32 = 4;

/// A simulation of the canonical sequence of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRow {
    /// Place of the point in the study.
    pub point: usize,
    /// Place in the point's sequence.
    pub sequence: usize,
    /// Purpose.
    pub purpose: Purpose,
    /// Point of the amplitude grid, of the uncertainty intervals' grid for their runs.
    pub index: i32,
    /// Refinement levels relative to the study.
    pub levels: Levels,
    /// Amplitude without sign, G.
    pub amplitude_g: f64,
    /// The simulation.
    pub run: RunRecord,
}

impl RunRow {
    /// What the simulation answered.
    pub fn result(&self) -> &ProbeResult {
        &self.run.result
    }

    /// The entries of the totals.
    pub fn counted(&self) -> (Purpose, &ProbeResult) {
        (self.purpose, &self.run.result)
    }
}

/// Columns of `/points` beside the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointKeep {
    /// Content of the point.
    pub digest: PointDigest,
    /// First touch, when it is known.
    pub touch: Option<StoredTouch>,
}

/// Program, host and start of a process that wrote a file.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Session {
    /// Version of the program.
    pub program_version: String,
    /// Commit of the program.
    pub commit: String,
    /// Physics version of the structure stage.
    pub physics_structure: u32,
    /// Physics version of the head stage.
    pub physics_head: u32,
    /// Host.
    pub host: String,
    /// Process id.
    pub process: u32,
    /// Worker threads.
    pub threads: usize,
    /// Start of the process, seconds since 1970.
    pub started_unix_s: f64,
}

impl Session {
    /// The program, as [`provenance::program`] names it.
    pub fn program(&self) -> String {
        let physics = [self.physics_structure, self.physics_head];
        provenance::program_of(&self.program_version, &self.commit, physics)
    }
}

/// Content of `results.h5`.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// The table.
    pub summary: Summary,
    /// Grid points per doubling of the amplitude.
    pub steps_per_octave: i32,
    /// Onset of the pulse on the study's time axis, s.
    pub start_s: f64,
    /// Effects and rules of each ramp's scenes, as JSON.
    pub plan: String,
    /// Per point of the table.
    pub points: Vec<PointKeep>,
    /// Simulations of the canonical sequences.
    pub runs: Vec<RunRow>,
    /// Finished simulations that no sequence requested.
    pub outside: Vec<RunRecord>,
    /// Who wrote it.
    pub session: Session,
    /// When, seconds since 1970.
    pub written_unix_s: f64,
}

impl Results {
    /// Everything a resume takes from the file.
    pub fn records(&self) -> Vec<Record> {
        let touches = self.points.iter().filter_map(|point| {
            Some(Record::Touch(TouchRecord {
                point: point.digest,
                touch: point.touch?,
            }))
        });
        let runs = self.runs.iter().map(|row| &row.run).chain(&self.outside);
        touches.chain(runs.cloned().map(Record::Run)).collect()
    }

    /// Runs at the study's own resolution: their histories may be kept.
    pub fn kept_runs(&self) -> impl Iterator<Item = KeptRun<'_>> {
        self.kept_by_row().flatten()
    }

    /// Why the lowest failing run of each point at the study's own resolution fails, by place in [`Results::runs`], where its
    /// history in the store says so. Reads these histories whole.
    ///
    /// # Errors
    ///
    /// As [`KeptRun::read`].
    pub fn mechanisms(&self, store: &Path) -> Result<HashMap<usize, Mechanism>, StoreError> {
        let mut lowest: HashMap<usize, (usize, KeptRun<'_>)> = HashMap::new();
        for (place, (row, kept)) in self.runs.iter().zip(self.kept_by_row()).enumerate() {
            let fails = matches!(row.run.result.verdict, Verdict::Fails { .. });
            let Some(kept) = kept.filter(|run| fails && run.key.window_factor == 1) else {
                continue;
            };
            let is_lower = |(_, other): &(usize, KeptRun<'_>)| kept.amplitude_g < other.amplitude_g;
            if lowest.get(&row.point).is_none_or(is_lower) {
                lowest.insert(row.point, (place, kept));
            }
        }
        let mut mechanisms = HashMap::new();
        for (place, kept) in lowest.into_values() {
            let history = kept.read(store)?;
            mechanisms.extend(history.and_then(|history| Some((place, history.mechanism?))));
        }
        Ok(mechanisms)
    }

    /// The run of each row, when it is one at the study's own resolution. Points of equal content share their runs,
    /// which are those of the first.
    pub(super) fn kept_by_row(&self) -> impl Iterator<Item = Option<KeptRun<'_>>> {
        let mut first = HashMap::new();
        for (place, point) in self.points.iter().enumerate() {
            first.entry(point.digest).or_insert(place);
        }
        self.runs
            .iter()
            .map(move |row| self.kept_run(row, first[&self.points[row.point].digest]))
    }

    /// The run of a row whose content `first` was the first to have.
    fn kept_run(&self, row: &RunRow, first: usize) -> Option<KeptRun<'_>> {
        let point = &self.summary.points[first];
        row.levels.is_none().then_some(KeptRun {
            ramp: &point.ramp,
            pulse_ms: point.pulse_ms,
            sign: point.sign,
            axes: &self.summary.axes,
            values: &point.axes,
            amplitude_g: row.amplitude_g,
            key: row.run.key,
            start_s: self.start_s,
            plan: &self.plan,
        })
    }

    /// Digest of the table and of the canonical simulations, without the machine's data.
    pub fn content_digest(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        let table = serde_json::to_string(&self.summary).expect("a table serialises");
        // Files of earlier programs have no such column: where it is empty, it is no content.
        let table = table.replace("\"half_min_height_g\":null,", "");
        hasher.update(table.as_bytes());
        for row in &self.runs {
            let mut run = row.run.clone();
            run.machine = RunMachine::default();
            hasher.update(&Record::Run(run).encode());
            hasher.update(row.purpose.as_str().as_bytes());
            hasher.update(&row.index.to_le_bytes());
        }
        for point in &self.points {
            if let Some(touch) = point.touch {
                let record = TouchRecord {
                    point: point.digest,
                    touch,
                };
                hasher.update(&Record::Touch(record).encode());
            }
        }
        hasher.finalize().to_hex().to_string()
    }

    /// Digest of the simulations outside the canonical sequences, without the machine's data: they are stored with
    /// those data, for idle cores decide which there are.
    pub fn outside_digest(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for run in &self.outside {
            let mut run = run.clone();
            run.machine = RunMachine::default();
            hasher.update(&Record::Run(run).encode());
        }
        hasher.finalize().to_hex().to_string()
    }
}
