//! Runs a sweep: hands jobs to threads, reports verdicts to the searches, and sends results to the writer.
//!
//! One thread has the searches and hands the best job to each idle thread: first a request of a search, the point with
//! the longest chain of successors first; else what a search will probably request. Answers may come back in any
//! order: that affects when a probe is answered, and nothing else.

use std::collections::HashMap;
use std::path::Path;
use std::time::{Duration, Instant};

use crossbeam_channel::{RecvTimeoutError, Sender};

use super::forgotten::forget_undecided;
use super::guard;
use super::input::SweepInput;
use super::lucky::lucky;
use super::neighbours::Neighbours;
use super::options::{Ending, SweepEnd, SweepOptions};
use super::outlook::Outlook;
use super::progress::{Event, Progress};
use super::recording::Recording;
use super::registry::{AnsweredProbe, Job, Registry};
use super::shard::Shard;
use super::simulator::Simulator;
use super::stop::TICK;
use super::writer::{self, Message};
use crate::search::ProbeResult;
use crate::store::{
    self, Loaded, PointDigest, Record, RunKey, RunMachine, RunRecord, Session, Store, StoreError,
    StoredTouch, TouchRecord, folder, machine,
};

/// Room between the searches and the writer.
const CHANNEL: usize = 1024;

/// Sweeps a study into the store in `folder`, or continues it.
///
/// # Errors
///
/// [`StoreError`]: the store cannot be opened, or the disk refused while sweeping; what was
/// finished before is kept.
pub fn sweep(
    input: &SweepInput,
    simulator: &dyn Simulator,
    folder: &Path,
    options: &SweepOptions,
    progress: &dyn Progress,
) -> Result<SweepEnd, StoreError> {
    let session = folder::session(options.threads);
    let whole = folder;
    let own = options.shard.map(|shard| shard.folder(whole));
    let folder = own.as_deref().unwrap_or(whole);
    let (mut store, mut loaded) = Store::open(folder, &input.texts, &session)?;
    let mut others = Loaded::default();
    for other in &options.reuse {
        let runs = store::load(other)?.0.runs.into_values();
        others.add(runs.map(Record::Run).collect());
    }
    let mut others = others.runs;
    if options.retry_undecided {
        forget_undecided(&mut others);
        forget_undecided(&mut loaded.runs);
    }
    progress.event(&Event::Started {
        study: input.texts.name.clone(),
        points: input.labels(),
        threads: options.threads,
        stored_runs: loaded.runs.len() as u64,
    });
    let (to_writer, messages) = crossbeam_channel::bounded(CHANNEL);
    std::thread::scope(|scope| {
        let writer = scope.spawn(move || writer::write(&mut store, &messages, progress));
        let mut run = Run::new(input, options, session, loaded, to_writer);
        run.others = others;
        if let Some(shard) = &options.shard {
            run.divide(shard, whole);
        }
        let end = run.drive(simulator, folder);
        match writer.join() {
            Ok(written) => written.and(end),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// Answer of a thread.
enum Answer {
    Touch {
        digest: PointDigest,
        touch: StoredTouch,
    },
    Run {
        key: RunKey,
        result: ProbeResult,
    },
}

struct Done {
    answer: Answer,
    wall_s: f64,
}

struct Run<'a> {
    input: &'a SweepInput,
    options: &'a SweepOptions,
    session: Session,
    registry: Registry<'a>,
    notes: Vec<(&'static str, String)>,
    to_writer: Sender<Message>,
    /// The writer gave up; its error is taken when it is joined.
    is_writer_gone: bool,
    brackets: Vec<(Option<f64>, Option<f64>)>,
    is_reported: Vec<bool>,
    /// Changes of the registry after the last report.
    seen_changes: u64,
    outlook: Outlook,
    /// Nothing but what the store had has been reported so far.
    reports_stored: bool,
    began: Instant,
    busy_s: f64,
    computed_runs: u64,
    reused_runs: u64,
    /// Simulations of other stores.
    others: HashMap<RunKey, RunRecord>,
    neighbours: Option<Neighbours>,
}

impl<'a> Run<'a> {
    fn new(
        input: &'a SweepInput,
        options: &'a SweepOptions,
        session: Session,
        mut loaded: Loaded,
        to_writer: Sender<Message>,
    ) -> Run<'a> {
        let notes = std::mem::take(&mut loaded.notes);
        Run {
            input,
            options,
            session,
            registry: Registry::new(input, loaded),
            notes,
            to_writer,
            is_writer_gone: false,
            brackets: vec![(None, None); input.points.len()],
            is_reported: vec![false; input.points.len()],
            seen_changes: 0,
            outlook: Outlook::new(),
            reports_stored: true,
            began: Instant::now(),
            busy_s: 0.0,
            computed_runs: 0,
            reused_runs: 0,
            others: HashMap::new(),
            neighbours: None,
        }
    }

    /// Restricts the run to a shard's part.
    fn divide(&mut self, shard: &Shard, whole: &Path) {
        let order = self.registry.campaign().order();
        let owned = shard.owned(order);
        // Every shard completes the added widths: the next round waits for them.
        let points = self.input.points.iter().zip(&owned);
        let wanted: Vec<bool> = points
            .map(|(point, &is_own)| is_own || point.coordinates.round > 0)
            .collect();
        let decides = self.input.decides.is_some();
        let neighbours = Neighbours::new(shard, whole, order, owned, (&wanted, decides));
        self.neighbours = Some(neighbours);
        self.registry.want(wanted);
        self.ask_neighbours();
    }

    /// Takes results of other shards, and the points of those that are not at work.
    fn ask_neighbours(&mut self) {
        let asked = self.neighbours.as_mut().and_then(Neighbours::ask);
        let Some((allowed, news)) = asked else {
            return;
        };
        self.registry.allow(allowed);
        for record in news {
            let answered = match record {
                Record::Run(run) if !self.registry.runs().contains_key(&run.key) => {
                    self.registry.finished(run)
                }
                Record::Touch(TouchRecord { point, touch }) => self.registry.touched(point, touch),
                Record::Run(_) | Record::Session(_) | Record::Numbers { .. } => continue,
            };
            self.report(&answered, None);
        }
    }

    fn drive(mut self, simulator: &dyn Simulator, folder: &Path) -> Result<SweepEnd, StoreError> {
        for (code, message) in std::mem::take(&mut self.notes) {
            self.notify(Event::Warning { code, message });
        }
        let answered = self.registry.absorb_all();
        self.report(&answered, None);
        self.reports_stored = false;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.options.threads)
            .thread_name(|number| format!("sweep-{number}"))
            .build()
            .expect("threads can be started");
        let mut ending = self.hand_out(simulator, &pool);
        if ending == Ending::Complete {
            // Answers are safe before the histories are recorded.
            let results = self.registry.results(&self.session);
            self.send(Message::Checkpoint(Box::new(results)));
            if let Some(stopped) = self.record_histories(simulator, &pool, folder)? {
                ending = stopped;
            }
        }
        let results = self.registry.results(&self.session);
        for message in lucky(self.input, &self.registry, &results) {
            self.notify(Event::Warning {
                code: "lucky",
                message,
            });
        }
        let wall_s = self.began.elapsed().as_secs_f64();
        let end = SweepEnd {
            summary: results.summary.clone(),
            ending,
            computed_runs: self.computed_runs,
            reused_runs: self.reused_runs,
            wall_s,
            core_use: self.busy_s / (wall_s * self.options.threads as f64),
        };
        self.send(Message::Checkpoint(Box::new(results)));
        let rows = end.summary.points.iter();
        self.notify(Event::Finished {
            totals: end.summary.totals,
            bracketed: rows.filter(|row| row.lacks_uncertainty()).count() as u64,
            wall_s,
            core_use: end.core_use,
        });
        Ok(end)
    }

    /// Repeats kept runs with recording; returns the reason if it did not finish.
    ///
    /// # Errors
    ///
    /// E183: a history cannot be written.
    fn record_histories(
        &mut self,
        simulator: &dyn Simulator,
        pool: &rayon::ThreadPool,
        folder: &Path,
    ) -> Result<Option<Ending>, StoreError> {
        let recorded = Recording {
            input: self.input,
            simulator,
            pool,
            folder,
            stopped: &|| self.stopped(),
            report: &|event| {
                // The writer's error is taken when it is joined.
                let _ = self.to_writer.send(Message::Report(event));
            },
        };
        let recorded = recorded.of_final_points(&self.registry)?;
        self.busy_s += recorded.busy_s;
        for message in recorded.warnings {
            self.notify(Event::Warning {
                code: "history",
                message,
            });
        }
        Ok(recorded.stopped)
    }

    fn hand_out(&mut self, simulator: &dyn Simulator, pool: &rayon::ThreadPool) -> Ending {
        let threads = self.options.threads;
        let (to_here, answers) = crossbeam_channel::unbounded::<Done>();
        let mut in_flight = 0;
        let mut is_stopping = false;
        let mut checkpoint_at = Instant::now();
        pool.in_place_scope(|scope| {
            loop {
                self.ask_neighbours();
                let stopped = self.stopped();
                if let (Some(ending), false) = (stopped, is_stopping) {
                    self.notify(Event::Stopping { in_flight, ending });
                    is_stopping = true;
                }
                while in_flight < threads && stopped.is_none() && !self.registry.is_done() {
                    let left = self.left();
                    // The first run begins in any case: a sweep called again and again gets on.
                    let fits = |job: &Job| {
                        let fits = |left| self.outlook.fits(self.input, job, left);
                        self.computed_runs == 0 || left.is_none_or(fits)
                    };
                    let Some(job) = self.registry.next_job(self.options.speculate, &fits) else {
                        break;
                    };
                    if let Job::Run { point, asked, key } = job {
                        let reused = self.others.get(&key).cloned();
                        self.reused_runs += u64::from(reused.is_some());
                        let elsewhere = || self.registry.same_elsewhere(point, asked.probe);
                        if let Some(record) = reused.or_else(elsewhere) {
                            self.keep(record, None);
                            continue;
                        }
                    }
                    let to_here = to_here.clone();
                    let (point, amplitude, digest) = match job {
                        Job::Onset { point } => (point, 0.0, self.input.points[point].digest),
                        Job::Run { point, asked, key } => (
                            point,
                            self.registry.amplitude_m_per_s2(point, asked.probe),
                            key.point,
                        ),
                    };
                    scope.spawn(move |_| {
                        let began = Instant::now();
                        let answer = match job {
                            Job::Onset { .. } => Answer::Touch {
                                digest,
                                touch: guard::onset(simulator, point),
                            },
                            Job::Run { asked, key, .. } => Answer::Run {
                                key,
                                result: guard::simulate(simulator, point, asked.probe, amplitude),
                            },
                        };
                        let wall_s = began.elapsed().as_secs_f64();
                        // The receiver is gone only after it panicked.
                        let _ = to_here.send(Done { answer, wall_s });
                    });
                    in_flight += 1;
                }
                let waits = self.neighbours.is_some() && !self.registry.is_done();
                if in_flight == 0 && (stopped.is_some() || !waits) {
                    let ending = match self.options.budget {
                        Some(_) if !self.registry.is_done() => Ending::Budget,
                        _ => Ending::Complete,
                    };
                    return stopped.unwrap_or(ending);
                }
                match answers.recv_timeout(TICK) {
                    Ok(done) => {
                        in_flight -= 1;
                        self.take(done);
                    }
                    Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
                }
                if checkpoint_at.elapsed() >= self.input.checkpoint {
                    let results = self.registry.results(&self.session);
                    self.send(Message::Checkpoint(Box::new(results)));
                    checkpoint_at = Instant::now();
                }
            }
        })
    }

    fn stopped(&self) -> Option<Ending> {
        if self.options.stop.is_asked() || self.is_writer_gone {
            return Some(Ending::Stopped {
                signal: self.options.stop.signal(),
            });
        }
        (self.left()? == Duration::ZERO).then_some(Ending::Budget)
    }

    /// Time left of the budget.
    fn left(&self) -> Option<Duration> {
        let budget = self.options.budget?;
        Some(budget.saturating_sub(self.began.elapsed()))
    }

    fn take(&mut self, Done { answer, wall_s }: Done) {
        self.busy_s += wall_s;
        match answer {
            Answer::Touch { digest, touch } => {
                self.send(Message::Keep(Record::Touch(TouchRecord {
                    point: digest,
                    touch,
                })));
                let answered = self.registry.touched(digest, touch);
                self.report(&answered, None);
            }
            Answer::Run { key, result } => {
                self.computed_runs += 1;
                let record = RunRecord {
                    key,
                    result,
                    machine: RunMachine {
                        wall_s,
                        finished_unix_s: machine::unix_now_s(),
                    },
                };
                self.keep(record, Some(wall_s));
            }
        }
    }

    /// Keeps a finished simulation and reports it to the searches.
    fn keep(&mut self, record: RunRecord, wall_s: Option<f64>) {
        let key = record.key;
        self.send(Message::Keep(Record::Run(record.clone())));
        let answered = self.registry.finished(record);
        self.report(&answered, wall_s.map(|wall_s| (key, wall_s)));
    }

    /// Reports what is left.
    fn estimate(&mut self) {
        // A short budget is for simulations.
        let is_short = self
            .left()
            .is_some_and(|left| left < Duration::from_secs(1));
        if (self.reports_stored || is_short) && !self.registry.is_done() {
            return self.outlook.learn(self.input, &self.registry);
        }
        let threads = self.options.threads;
        if let Some(left) = self.outlook.renew(self.input, &self.registry, threads) {
            self.notify(Event::Estimated(left));
        }
    }

    /// Reports which probes were answered.
    fn report(&mut self, answered: &[AnsweredProbe], computed: Option<(RunKey, f64)>) {
        for &AnsweredProbe { point, asked, key } in answered {
            if self.registry.first_of(point, asked) {
                self.notify(Event::PointStarted { point });
            }
            let verdict = self.registry.runs()[&key].result.verdict.as_str();
            self.notify(Event::ProbeDone {
                point,
                amplitude_g: self.registry.amplitude_g(asked.probe),
                verdict,
                purpose: asked.purpose.as_str(),
                retry: asked.probe.retry.label(),
                wall_s: computed
                    .filter(|(other, _)| *other == key)
                    .map(|(_, wall_s)| wall_s),
            });
        }
        let mut points: Vec<usize> = answered.iter().map(|probe| probe.point).collect();
        points.sort_unstable();
        points.dedup();
        for point in points {
            let row = self.registry.row(point);
            let bracket = (row.survived_g, row.failed_g);
            if bracket != self.brackets[point] {
                self.brackets[point] = bracket;
                self.notify(Event::Bracket {
                    point,
                    survived_g: row.survived_g,
                    failed_g: row.failed_g,
                    runs: row.runs,
                });
            }
        }
        if self.seen_changes != self.registry.n_changes() {
            self.seen_changes = self.registry.n_changes();
            for point in 0..self.is_reported.len() {
                if !self.is_reported[point] && self.registry.is_final(point) {
                    self.is_reported[point] = true;
                    let summary = self.registry.row(point);
                    self.notify(Event::PointDone {
                        point,
                        summary,
                        is_stored: self.reports_stored,
                    });
                }
            }
        }
        if !answered.is_empty() {
            self.estimate();
        }
    }

    fn notify(&mut self, event: Event) {
        self.send(Message::Report(event));
    }

    fn send(&mut self, message: Message) {
        if self.to_writer.send(message).is_err() {
            self.is_writer_gone = true;
        }
    }
}
