//! A study that has passed every check: read from a file, with its points, settings and digest.

use super::fault::{self, Severity, StudyError, StudyErrors};
use super::included::{self, Location};
use super::overlay::{self, Override};
use super::points::{self, Axis, Point};
use super::read::Reader;
use super::recorded::MeasuredPulse;
use super::set_arg::SetArg;
use super::settings::{Settings, View};
use super::source::{self, Origin, Source};
use super::text_file;
use super::words::{Effects, KeepHistories, LeftOut, UncertaintyOf};
use super::{complete, example, fields, resolved, scene, tree};
use crate::search::{MonotonicityScan, Ramp, Sign};
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use std::path::{Path, PathBuf};

/// A study that has passed every check.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name.
    pub name: String,
    /// Outputs asked for.
    pub outputs: Vec<Output>,
    /// Every point, in the canonical order of the search.
    pub points: Vec<Point>,
    /// Axes beside widths, ramp models and signs, outermost first.
    pub axes: Vec<Axis>,
    /// Pulse widths, ms, ascending.
    pub widths_ms: Vec<f64>,
    /// Ramp models, in canonical order.
    pub ramps: Vec<Ramp>,
    /// Signs, in canonical order.
    pub signs: Vec<Sign>,
    /// Settings of the search.
    pub search: SearchSettings,
    /// Settings of the store.
    pub output: OutputSettings,
    /// Onset of the pulse on the time axis of every output, s.
    pub start_s: f64,
    /// Times after the onset at which pressure fields are kept, ascending, s; before it negative.
    pub field_times_s: Vec<f64>,
    /// Whether only the needed effects are simulated.
    pub effects: Effects,
    /// Effects left out by hand.
    pub leave_out: Vec<LeftOut>,
    /// Digest of every setting.
    pub digest: [u8; 32],
    /// Warnings and notes, by place.
    pub remarks: Vec<StudyError>,
    /// What the command line set, and what it replaced.
    pub overrides: Vec<Override>,
    /// The study file as named.
    pub path: PathBuf,
    /// The same file, absolute and without links; `None` for a study that comes from no file.
    pub file: Option<PathBuf>,
    /// Text of the study file.
    pub text: String,
    /// The record of a pulse that a file gives.
    pub measured: Option<MeasuredPulse>,
    pub(super) settings: Settings,
}

/// Settings of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchSettings {
    /// Lowest amplitude tried, g.
    pub amplitude_min_g: f64,
    /// Highest amplitude tried, g.
    pub amplitude_max_g: f64,
    /// Width of the final bracket, per cent.
    pub tolerance_pct: f64,
    /// Which amplitudes below the lowest failure are simulated, to see that none of them fails.
    pub monotonicity_scan: MonotonicityScan,
    /// Largest untested gap below the lowest failure, per cent.
    pub scan_gap_pct: f64,
    /// Whether the contributions of the resolution to the uncertainty are estimated.
    pub uncertainty: bool,
    /// Of which points.
    pub uncertainty_of: UncertaintyOf,
    /// Amplitude that every point must survive, g.
    pub required_amplitude_g: Option<f64>,
    /// Times that a point which misses the target is refined.
    pub max_refinements: u8,
    /// How widths are added; `None`: not at all.
    pub added_points: Option<AddedPointsSettings>,
}

/// How widths are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedPointsSettings {
    /// Largest error of linear interpolation between neighbouring answers, per cent.
    pub tolerance_pct: Option<f64>,
    /// Largest distance of the two widths between which two ramp models change places, per cent.
    pub crossing_pct: Option<f64>,
    /// No widths are added closer than this, per cent.
    pub closest_pct: f64,
    /// Points added at most.
    pub max_points: usize,
}

/// Settings of the store.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSettings {
    /// Which histories are stored.
    pub keep_histories: KeepHistories,
    /// Time between two refreshes of the results file, s.
    pub checkpoint_s: f64,
}

impl Study {
    /// Reads a study file and lays the `--set` arguments over it.
    ///
    /// # Errors
    /// Every fault of the study, up to [`fault::MAX_LISTED`], sorted by place.
    pub fn from_path(path: &Path, sets: &[SetArg]) -> Result<Self, StudyErrors> {
        let text = text_file::read_text(path).map_err(|fault| StudyErrors::from(*fault))?;
        let study = Self::from_text_of(text, path, sets)?;
        Ok(Self {
            file: std::fs::canonicalize(path).ok(),
            ..study
        })
    }

    /// Reads a study from the text that a file at `path` would have. File paths in it start from that file's folder; the
    /// study itself comes from no file.
    ///
    /// # Errors
    /// As [`Study::from_path`].
    pub fn from_text_of(text: String, path: &Path, sets: &[SetArg]) -> Result<Self, StudyErrors> {
        let location = Location {
            file: path.to_path_buf(),
            folder: path.parent().map(Path::to_path_buf).unwrap_or_default(),
        };
        Self::read(text, location, sets)
    }

    /// Reads a study from its text. File paths start from the working directory.
    ///
    /// # Errors
    /// As [`Study::from_path`].
    pub fn from_text(text: &str, sets: &[SetArg]) -> Result<Self, StudyErrors> {
        let location = Location {
            file: PathBuf::from("study.toml"),
            folder: PathBuf::new(),
        };
        Self::read(text.to_string(), location, sets)
    }

    fn read(text: String, location: Location, sets: &[SetArg]) -> Result<Self, StudyErrors> {
        let source = Source::new(location.file.display().to_string(), text);
        let mut root = tree::parse(&source, Origin::File).map_err(StudyErrors::new)?;
        if matches!(&root.value, tree::Value::Table(members) if members.is_empty()) {
            let start = source::Place {
                source: source.clone(),
                span: 0..0,
                origin: Origin::File,
            };
            let fault = StudyError::at("E101", &start, "", "the study file is empty")
                .allowed("a study")
                .hint("the smallest valid study is printed by `opshock new`");
            return Err(fault.into());
        }
        let mut reader = Reader::default();
        let base = |root: &tree::Node, path: &str| included::base_list(root, sets, path, &location);
        overlay::seed_lists(&mut root, sets, base);
        let overrides = overlay::lay_over(&mut root, sets, &mut reader.errors);
        reader.table(&root, "", "");
        complete::complete(&mut reader, &root, &location);
        let Reader {
            settings,
            mut errors,
            mut remarks,
            measured,
        } = reader;
        let mut found = Vec::new();
        points::check(&settings, &mut found);
        for fault in found {
            if fault.severity() == Severity::Error {
                errors.push(fault)
            } else {
                remarks.push(fault)
            }
        }
        if !errors.is_empty() {
            return Err(StudyErrors::new(errors));
        }
        fault::tidy(&mut remarks);
        let points = points::points(&settings);
        if let Some(fault) = points::alike(&settings, &points) {
            return Err(fault.into());
        }
        let view = View::first(&settings);
        Ok(Self {
            name: view.get(&fields::NAME).to_string(),
            outputs: view.get(&fields::OUTPUTS),
            points,
            axes: points::axes(&settings),
            widths_ms: points::widths_ms(&settings),
            ramps: points::ramps(&settings),
            signs: points::signs(&settings),
            search: SearchSettings {
                amplitude_min_g: view.number(fields::SEARCH_AMPLITUDE_G_MIN.path()),
                amplitude_max_g: view.number(fields::SEARCH_AMPLITUDE_G_MAX.path()),
                tolerance_pct: view.number(fields::SEARCH_TOLERANCE_PCT.path()),
                monotonicity_scan: view.get(&fields::SEARCH_MONOTONICITY_SCAN),
                scan_gap_pct: view.number(fields::SEARCH_SCAN_GAP_PCT.path()),
                uncertainty: view.get(&fields::SEARCH_UNCERTAINTY),
                uncertainty_of: view
                    .get(&fields::SEARCH_UNCERTAINTY_OF)
                    .unwrap_or(UncertaintyOf::All),
                required_amplitude_g: view.maybe_number(fields::SEARCH_REQUIRED_AMPLITUDE_G.path()),
                max_refinements: view.get(&fields::SEARCH_MAX_REFINEMENTS),
                added_points: added_points(&view),
            },
            output: OutputSettings {
                keep_histories: view.get(&fields::OUTPUT_KEEP_HISTORIES),
                checkpoint_s: view.get(&fields::OUTPUT_CHECKPOINT_S),
            },
            start_s: view.get(&fields::PULSE_START_MS),
            field_times_s: scene::field_times_s(&view),
            effects: view.get(&fields::SOLVER_EFFECTS),
            leave_out: view.get(&fields::SOLVER_LEAVE_OUT),
            digest: resolved::digest(&settings),
            remarks,
            overrides,
            path: location.file,
            file: None,
            text: source.text.clone(),
            measured,
            settings,
        })
    }

    /// Text of the smallest useful study, for `opshock new`.
    pub fn example(name: &str) -> String {
        example::text(name)
    }

    /// Every setting with its default, as a study file that reads back to the same study.
    pub fn resolved_toml(&self) -> String {
        resolved::text(&self.settings)
    }

    /// The digest in hexadecimal digits.
    pub fn digest_hex(&self) -> String {
        self.digest
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }

    /// Which discretisation parameters are values of the model; `None` where all are refined.
    pub fn not_refined(&self) -> Option<String> {
        let scene = &self.points.first()?.scene;
        let value = |discretisation: &Discretisation| match discretisation {
            Discretisation::FilmGrid => format!("{} film cells", scene.film_resolution.cells),
            Discretisation::DiskModes => {
                let cut_khz = scene.disk_resolution.cut_hz / 1e3;
                format!("disk modes to {cut_khz} kHz")
            }
            Discretisation::SuspensionModes => {
                let count = scene.head_resolution.suspension_modes;
                format!("{count} suspension modes")
            }
            other => other.as_str().to_owned(),
        };
        let values: Vec<String> = scene.not_refined.iter().map(value).collect();
        let are_some = !values.is_empty();
        are_some.then(|| format!("values of the model, not refined: {}", values.join(", ")))
    }

    /// The words of the outputs asked for.
    pub fn output_words(&self) -> Vec<&'static str> {
        self.outputs.iter().map(|output| output.as_str()).collect()
    }

    /// Whether `output` is asked for.
    pub fn asks_for(&self, output: Output) -> bool {
        self.outputs.contains(&output)
    }

    /// What is simulated for the outputs asked for.
    ///
    /// # Panics
    /// When an output is left out by hand or has no meaning; the study's checks refuse both.
    pub fn plan(&self) -> Plan {
        let mode = match self.effects {
            Effects::Auto => Mode::Auto,
            Effects::Full => Mode::Full,
        };
        let plan = Plan::new(&self.outputs, mode).with_field_times(&self.field_times_s);
        if self.leave_out.contains(&LeftOut::AirBearing) {
            plan.without_head()
                .unwrap_or_else(|output| panic!("{} needs what is left out", output.as_str()))
        } else {
            plan
        }
    }

    /// Positions in [`Study::points`] in the order of tables: further axes, ramps, signs, widths
    /// ascending.
    pub fn table_order(&self) -> Vec<usize> {
        points::table_order(&self.points, &self.axes)
    }

    /// The study with points added at other widths, each like one of [`Study::points`], in the next round.
    #[must_use]
    pub fn with_widths(mut self, added: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let last = self.points.iter().map(|point| point.round).max();
        let round = last.unwrap_or(0) + 1;
        let like = |(place, pulse_ms): (usize, f64)| {
            points::at_width(&self.settings, &self.points[place], pulse_ms, round)
        };
        let new: Vec<Point> = added.into_iter().map(like).collect();
        self.points.extend(new);
        self
    }

    /// Warnings whose code is not among the accepted ones; they stop a batch run.
    pub fn unaccepted(&self, accepted: &[String]) -> Vec<&StudyError> {
        self.remarks
            .iter()
            .filter(|remark| remark.severity() == Severity::Warning)
            .filter(|remark| !accepted.iter().any(|code| code.trim() == remark.code))
            .collect()
    }
}

/// How widths are added, if they are.
fn added_points(view: &View<'_>) -> Option<AddedPointsSettings> {
    let closest = fields::SEARCH_ADDED_POINTS_CLOSEST_PCT;
    let most = fields::SEARCH_ADDED_POINTS_MAX_POINTS;
    let added = AddedPointsSettings {
        tolerance_pct: view.maybe_number(fields::SEARCH_ADDED_POINTS_TOLERANCE_PCT.path()),
        crossing_pct: view.maybe_number(fields::SEARCH_ADDED_POINTS_CROSSING_PCT.path()),
        closest_pct: view
            .maybe_number(closest.path())
            .unwrap_or_else(|| closest.key.absent()),
        max_points: view.get(&most).unwrap_or_else(|| most.key.absent()),
    };
    (added.tolerance_pct.is_some() || added.crossing_pct.is_some()).then_some(added)
}

/// Checks a number of worker threads.
///
/// # Errors
/// E185 unless 1 to 4096.
pub fn check_threads(threads: i64) -> Result<usize, Box<StudyError>> {
    match usize::try_from(threads) {
        Ok(count @ 1..=4096) => Ok(count),
        _ => Err(Box::new(
            StudyError::in_file("E185", "-j", "the number of threads is out of range")
                .value(threads.to_string())
                .allowed("1 to 4096")
                .hint("leave -j out to use every core"),
        )),
    }
}
