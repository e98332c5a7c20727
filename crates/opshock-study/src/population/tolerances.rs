//! Reads tolerance files: distributions of a study's keys, their correlations, measured parts, and the number of drives.
//!
//! A tolerance file is TOML like a study and gives the same messages: all faults at once, each with its place.

use std::path::{Path, PathBuf};

use super::correlation::Correlation;
use super::parts::Parts;
use crate::draws::{self, Parameter, draw};
use crate::qualification::Spec;
use crate::store::{NumberStore, StoreError};
use crate::study::table_fields::{Faults, Fields};
use crate::study::tree;
use crate::study::{SetArg, Study, StudyError, StudyErrors, is_within};

const TOP: &[&str] = &[
    "tolerances_format",
    "name",
    "source",
    "drives",
    "seed",
    "fragility_drives",
    "tolerance",
    "correlation",
    "parts",
];
/// Drives unless the file says otherwise: when all of them survive, 99 % do with 95 % confidence.
const DRIVES: u64 = 299;
/// Drives whose critical shocks make the fragility curve, unless the file says otherwise.
const FRAGILITY_DRIVES: u64 = 100;
const MOST: u64 = 10_000_000;
/// Keys that are no property of a drive.
const NOT_OF_DRIVE: [&str; 6] = ["name", "outputs", "search", "resolution", "output", "pulse"];

/// A tolerance file that has passed every check.
#[derive(Clone, Debug)]
pub struct Tolerances {
    /// Name of the population.
    pub name: String,
    /// Where its figures come from.
    pub source: Option<String>,
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Number of drives, fixed before any is simulated.
    pub drives: u64,
    /// Seed of their draws.
    pub seed: u64,
    /// The first drives, of which the critical shock is bracketed, too.
    pub fragility_drives: u64,
    /// Distributions of keys.
    pub parameters: Vec<Parameter>,
    correlation: Option<Correlation>,
    parts: Option<Parts>,
    /// The study file, and what the command line lays over it.
    study: PathBuf,
    sets: Vec<SetArg>,
}

impl Tolerances {
    /// Reads a tolerance file of the study file at `study`; `sets` are laid over that, and a drive's values over them.
    ///
    /// # Errors
    ///
    /// Every fault of the file, of the study, or of a study with an extreme value of a tolerance, or with a part.
    pub fn from_path(path: &Path, study: &Path, sets: &[SetArg]) -> Result<Self, StudyErrors> {
        let plain = Study::from_path(study, sets)?;
        let (text, root) = tree::read(path)?;
        let mut faults = Faults::new();
        let Some(fields) = Fields::of(&root, "", TOP, &mut faults) else {
            return Err(StudyErrors::new(faults));
        };
        let format = fields.count("tolerances_format", [1, 1], &mut faults);
        if format.is_none() && fields.get("tolerances_format").is_none() {
            fields.missing("tolerances_format", "1", &mut faults);
        }
        let name = fields.text("name", &mut faults);
        if name.is_none() && fields.get("name").is_none() {
            fields.missing("name", "a text", &mut faults);
        }
        let from = fields.text("source", &mut faults);
        let mut count = |name: &str, range: [u64; 2], unless: u64| {
            fields.count(name, range, &mut faults).unwrap_or(unless)
        };
        let drives = count("drives", [1, MOST], DRIVES);
        let seed = count("seed", [0, MOST], 1);
        let fragility = count(
            "fragility_drives",
            [0, drives],
            FRAGILITY_DRIVES.min(drives),
        );
        let parameters = draws::read(&fields, "tolerance", &plain, &mut faults);
        let parts = parts(&fields, path, &mut faults);
        if fields.present(&["tolerance", "parts"]).is_empty() {
            fields.missing(
                "tolerance",
                "[[tolerance]], one or more, or parts",
                &mut faults,
            );
        }
        refuse_keys(&fields, &parameters, parts.as_ref(), &mut faults);
        let correlation = correlation(&fields, &parameters, &mut faults);
        let (Some(name), true) = (name, faults.is_empty()) else {
            return Err(StudyErrors::new(faults));
        };
        let all = Self {
            name,
            source: from,
            path: path.to_path_buf(),
            text,
            drives,
            seed,
            fragility_drives: fragility,
            parameters,
            correlation,
            parts,
            study: study.to_path_buf(),
            sets: sets.to_vec(),
        };
        all.check_values(&fields, &plain, &mut faults);
        match faults.is_empty() {
            true => Ok(all),
            false => Err(StudyErrors::new(faults)),
        }
    }

    /// Opens or makes the store of its answers in `folder`; `kind` names them and their format.
    ///
    /// # Errors
    /// As [`NumberStore::open`].
    pub fn open_store(&self, folder: &Path, kind: &str) -> Result<NumberStore, StoreError> {
        NumberStore::open(folder, kind, &self.name, &self.path, &self.text)
    }

    /// A specification whose requirements set none of these keys.
    ///
    /// # Errors
    ///
    /// A requirement sets a key that has a tolerance.
    pub fn check_spec(&self, spec: &Spec) -> Result<(), StudyErrors> {
        let file = self.path.display().to_string();
        let clashes = spec.requirements.iter().flat_map(|requirement| {
            let keys = self.keys();
            let set = |key: &&str| requirement.sets.iter().any(|one| is_within(key, one));
            let both = keys.into_iter().filter(set).map(str::to_owned);
            both.map(move |key| (key, &requirement.name))
        });
        let faults: Vec<StudyError> = clashes
            .map(|(key, requirement)| {
                let message = format!("{key} is set by requirement {requirement:?}, too");
                StudyError::in_file("E195", &file, message).allowed("keys that no requirement sets")
            })
            .collect();
        match faults.is_empty() {
            true => Ok(()),
            false => Err(StudyErrors::new(faults)),
        }
    }

    /// Every key that differs between drives.
    fn keys(&self) -> Vec<&str> {
        let own = self.parameters.iter().flat_map(|one| &one.keys);
        let own = own.map(|(key, _)| key.as_str());
        let parts = self.parts.iter().flat_map(|parts| &parts.keys);
        own.chain(parts.map(String::as_str)).collect()
    }

    /// Cumulative probabilities of drive number `index`, by name; the last is that of its part.
    pub fn draw(&self, index: u64) -> Vec<f64> {
        let n = self.parameters.len();
        let mut drawn = draw(self.seed, index, n + 1);
        let part = drawn.pop().filter(|_| self.parts.is_some());
        let mut values = match &self.correlation {
            Some(correlation) => correlation.apply(&drawn),
            None => drawn,
        };
        values.extend(part);
        values
    }

    /// Names of what drives are compared by: the tolerances, and every key that is measured in parts.
    pub fn ranked_names(&self) -> Vec<&str> {
        let own = self.parameters.iter().map(|one| one.name.as_str());
        let parts = self.parts.iter().flat_map(|parts| &parts.keys);
        own.chain(parts.map(String::as_str)).collect()
    }

    /// What sorts drives by each of these: cumulative probabilities, and measured values.
    pub fn ranks(&self, drawn: &[f64]) -> Vec<f64> {
        let mut ranks = drawn[..self.parameters.len()].to_vec();
        if let (Some(parts), Some(&p)) = (&self.parts, drawn.last()) {
            ranks.extend(parts.settings(p).map(|(_, value)| value));
        }
        ranks
    }

    /// Values of cumulative probabilities as text, by key; an absent key has none.
    pub fn values(&self, drawn: &[f64]) -> Vec<(String, Option<String>)> {
        let own = self.parameters.iter().zip(drawn);
        let mut values: Vec<_> = own.flat_map(|(one, &p)| one.settings(p)).collect();
        if let (Some(parts), Some(&p)) = (&self.parts, drawn.last()) {
            let part = parts.settings(p);
            values.extend(part.map(|(key, value)| (key.to_owned(), Some(format!("{value:?}")))));
        }
        values
    }

    /// Settings of a drive: those of the command line, and its own over them.
    pub fn arguments(&self, drawn: &[f64]) -> Vec<SetArg> {
        self.over_sets(self.values(drawn))
    }

    /// The study of a drive.
    ///
    /// # Errors
    ///
    /// The study's faults, such as parts that do not fit one another.
    pub fn study_of(&self, drawn: &[f64]) -> Result<Study, StudyErrors> {
        Study::from_path(&self.study, &self.arguments(drawn))
    }

    /// The study with one tolerance at both of its `ends` (cumulative probabilities), and its own values of everything else.
    ///
    /// # Errors
    ///
    /// The study's faults.
    pub fn studies_at(&self, place: usize, ends: [f64; 2]) -> Result<[Study; 2], StudyErrors> {
        let settings = |end| self.parameters[place].settings(end);
        let study = |end| Study::from_path(&self.study, &self.over_sets(settings(end)));
        let [low, high] = ends.map(study);
        Ok([low?, high?])
    }

    /// The arguments of the command line, with settings over them.
    fn over_sets(&self, settings: Vec<(String, Option<String>)>) -> Vec<SetArg> {
        let mut all = self.sets.clone();
        for (key, text) in settings {
            all.retain(|known| known.key != key);
            all.push(setting(&key, text));
        }
        all
    }

    /// The study must accept the extreme values and choices of each tolerance, and each part, with all others in the middle;
    /// none of their keys may be an axis of it.
    fn check_values(&self, fields: &Fields<'_>, plain: &Study, faults: &mut Faults) {
        let middle = vec![0.5; self.parameters.len() + usize::from(self.parts.is_some())];
        let one_value = || "keys with one value in the study".to_owned();
        let labels = |study: &Study| -> Vec<String> {
            let points = study.table_order().into_iter();
            points.map(|point| study.points[point].label()).collect()
        };
        let in_the_middle = self.study_of(&middle).ok();
        let usual = labels(in_the_middle.as_ref().unwrap_or(plain));
        // Words of the fault and what is valid. A fault of another key is none of this tolerance's, or of this part's.
        let refused = |place: usize, p: f64, keys: &[&str]| {
            let mut unit = middle.clone();
            unit[place] = p;
            match self.study_of(&unit) {
                Ok(study) => (labels(&study) != usual).then(|| {
                    let message = "changes the points of the study".to_owned();
                    (message, one_value())
                }),
                Err(refused) => {
                    let mut errors = refused.errors.into_iter();
                    let own = errors.find(|fault| keys.contains(&fault.key.as_str()))?;
                    let message = format!(
                        "the study refuses {} {}: {}",
                        own.key, own.value, own.message
                    );
                    Some((message, own.allowed.to_string()))
                }
            }
        };
        let own_keys = self.parameters.iter().map(|one| {
            let keys = one.keys.iter().map(|(key, _)| key.as_str());
            (one.name.as_str(), "tolerance", keys.collect::<Vec<_>>())
        });
        let of_parts = self.parts.iter().map(|parts| {
            let keys = parts.keys.iter().map(String::as_str);
            ("", "parts", keys.collect::<Vec<_>>())
        });
        let all: Vec<_> = own_keys.chain(of_parts).collect();
        for (name, entry, keys) in &all {
            let is_axis = |key: &&&str| {
                **key == "ramp.models" || plain.axes.iter().any(|axis| axis.path == **key)
            };
            if let Some(key) = keys.iter().find(is_axis) {
                let fault =
                    fields.fault_of("E195", entry, format!("{key} is an axis of the study"));
                faults.push(fault.value(*name).allowed(one_value()));
            }
        }
        if !faults.is_empty() {
            return;
        }
        let extremes = self.parameters.iter().map(Parameter::extremes);
        let rows = self.parts.iter().map(|parts| {
            let n = parts.rows.len() as f64;
            (0..parts.rows.len())
                .map(|row| (row as f64 + 0.5) / n)
                .collect()
        });
        let probabilities: Vec<Vec<f64>> = extremes.chain(rows).collect();
        for (place, (name, entry, keys)) in all.iter().enumerate() {
            let mut of_entry = probabilities[place].iter().enumerate();
            let first = of_entry.find_map(|(at, p)| Some((at, refused(place, *p, keys)?)));
            if let Some((at, (message, allowed))) = first {
                let of = match *entry {
                    "parts" => format!("part {} of the file", at + 1),
                    _ => format!("tolerance {name:?}"),
                };
                let fault = fields.fault_of("E195", entry, format!("{of}: {message}"));
                faults.push(fault.value(*name).allowed(allowed));
            }
        }
        if faults.is_empty() && usual != labels(plain) {
            let fault = fields.fault_of("E195", "tolerance", "change the points of the study");
            faults.push(fault.allowed(one_value()));
        }
    }
}

/// The argument that sets a key, or takes it away.
fn setting(key: &str, text: Option<String>) -> SetArg {
    let argument = match text {
        Some(text) => SetArg::parse(&format!("{key}={text}")),
        None => SetArg::unset(key),
    };
    argument.expect("keys are checked when read")
}

fn parts(fields: &Fields<'_>, path: &Path, faults: &mut Faults) -> Option<Parts> {
    let file = fields.text("parts", faults)?;
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    match Parts::read(&folder.join(file)) {
        Ok(parts) => Some(parts),
        Err(fault) => {
            faults.push(*fault);
            None
        }
    }
}

/// Keys that are no property of a drive, and keys that are drawn twice.
fn refuse_keys(
    fields: &Fields<'_>,
    parameters: &[Parameter],
    parts: Option<&Parts>,
    faults: &mut Faults,
) {
    let own = parameters.iter().flat_map(|one| &one.keys);
    let own: Vec<&str> = own.map(|(key, _)| key.as_str()).collect();
    let measured: Vec<&str> = parts.map_or(Vec::new(), |parts| {
        parts.keys.iter().map(String::as_str).collect()
    });
    let named = own.iter().map(|key| ("tolerance", *key));
    for (name, key) in named.chain(measured.iter().map(|key| ("parts", *key))) {
        if NOT_OF_DRIVE.iter().any(|section| is_within(key, section)) {
            let fault = fields.fault_of("E195", name, format!("{key} is no property of a drive"));
            faults.push(
                fault
                    .value(key)
                    .allowed("keys of disk, ramp, slider, suspension, gas and spindle"),
            );
        }
    }
    if let Some(key) = own.iter().find(|key| measured.contains(key)) {
        let message = format!("{key} has a tolerance and is measured in parts");
        let fault = fields.fault_of("E195", "parts", message);
        faults.push(fault.allowed("each key once"));
    }
}

/// The correlations of tolerances, by their names.
fn correlation(
    fields: &Fields<'_>,
    parameters: &[Parameter],
    faults: &mut Faults,
) -> Option<Correlation> {
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    let names = || {
        let names: Vec<&str> = parameters.iter().map(|one| one.name.as_str()).collect();
        format!("two different names of tolerances: {}", names.join(", "))
    };
    for (node, path) in fields.list("correlation", faults) {
        let Some(entry) = Fields::of(node, &path, &["between", "coefficient"], faults) else {
            continue;
        };
        let between = entry.texts("between", faults);
        let place = |name: &String| parameters.iter().position(|one| one.name == *name);
        let places: Vec<Option<usize>> = between.iter().map(place).collect();
        let coefficient = entry.number("coefficient", faults);
        if coefficient.is_none() && entry.get("coefficient").is_none() {
            entry.missing("coefficient", "a number between -1 and 1", faults);
        }
        if coefficient.is_some_and(|coefficient| coefficient.abs() >= 1.0) {
            let fault = entry.fault_of("E130", "coefficient", "is no correlation");
            faults.push(fault.allowed("a number between -1 and 1"));
        }
        match (places.as_slice(), coefficient) {
            (&[Some(a), Some(b)], Some(coefficient)) if a != b => {
                let is_known =
                    |&(c, d, _): &(usize, usize, f64)| [c, d] == [a, b] || [d, c] == [a, b];
                if pairs.iter().any(is_known) {
                    let fault = entry.fault_of("E195", "between", "has a coefficient already");
                    faults.push(fault.allowed("each pair once"));
                }
                pairs.push((a, b, coefficient));
            }
            (_, None) => {}
            // Faults of the tolerances themselves come first.
            _ if faults.is_empty() || !parameters.is_empty() => {
                let fault = entry.fault_of("E195", "between", "is no pair of tolerances");
                faults.push(fault.allowed(names()));
            }
            _ => {}
        }
    }
    if pairs.is_empty() || !faults.is_empty() {
        return None;
    }
    let correlation = Correlation::of(parameters.len(), &pairs);
    if correlation.is_none() {
        let message = "has coefficients that contradict one another";
        let fault = fields.fault_of("E195", "correlation", message);
        faults.push(fault.allowed("coefficients whose matrix is positive definite"));
    }
    correlation
}
