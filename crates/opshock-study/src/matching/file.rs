//! Reads match files: a study, its unknown parameters, and what was observed.
//!
//! A match file is TOML like a study and gives the same messages: all faults at once, each with its place.

use std::path::{Path, PathBuf};

use super::observation::{Observation, Stage};
use super::observed;
use super::statements::Statements;
use crate::draws::{self, Parameter};
use crate::study::table_fields::{Faults, Fields};
use crate::study::text_file;
use crate::study::tree;
use crate::study::{SetArg, Study, StudyError, StudyErrors};

/// A match problem that has passed every check.
#[derive(Clone, Debug)]
pub struct MatchProblem {
    /// Name.
    pub name: String,
    /// The match file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// The study whose parameters are sought, with its own values.
    pub study: Study,
    /// Seed of every random number.
    pub seed: u64,
    /// The unknown parameters.
    pub parameters: Vec<Parameter>,
    /// The observations; those without a range are only reported.
    pub observations: Vec<Observation>,
    /// The set of statements that observations may name.
    pub(super) statements: &'static dyn Statements,
    /// Settings laid over the study for each stage.
    pub settings: [Vec<String>; 3],
    /// Effort of the search.
    pub effort: Effort,
    /// Tolerance of searches for critical shocks, per cent.
    pub(super) tolerance_pct: f64,
    /// Settings that the command line lays over the study.
    sets: Vec<SetArg>,
}

/// Effort of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Independent draws of the prior, by stage; each a part of those of the stage before.
    pub draws: [u64; 3],
    /// Waves after the first.
    pub waves: u32,
    /// Parameter sets tried in each of them.
    pub samples: u64,
    /// Parameter sets tried in the max-min refinement.
    pub refinement: u64,
    /// Starts of the refinement.
    pub starts: u32,
    /// Place of the parameter of which every choice is refined by itself.
    pub each: Option<usize>,
    /// Searches for a set that disproves a conflict.
    pub conflict_searches: u64,
    /// Sets that each of them tries at most.
    pub conflict_evaluations: u64,
    /// Parameter sets at which the numerical uncertainty is measured.
    pub probes: u64,
}

const TOP: &[&str] = &[
    "match_format",
    "name",
    "study",
    "unset",
    "seed",
    "draws",
    "waves",
    "refinement",
    "conflicts",
    "settings",
    "numerics",
    "parameter",
    "observation",
    "statements",
];
/// Draws of the prior by stage unless the file says otherwise.
const DRAWS: [u64; 3] = [2000, 300, 30];
const REFINEMENT: &[&str] = &["evaluations", "starts", "each", "weights"];
/// Largest number that a match file may give for a seed, draws or evaluations.
const MOST: u64 = 100_000_000;

impl MatchProblem {
    /// Reads a match file, the study it names, and every file that it names; `sets` are laid over the study,
    /// and `statements` are those that the file may name.
    ///
    /// # Errors
    /// Every fault of the match file, or of the study.
    pub fn from_path(
        path: &Path,
        sets: &[SetArg],
        statements: &'static dyn Statements,
    ) -> Result<Self, StudyErrors> {
        let (text, root) = tree::read(path)?;
        let mut faults = Faults::new();
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let Some(fields) = Fields::of(&root, "", TOP, &mut faults) else {
            return Err(StudyErrors::new(faults));
        };
        match fields.count("match_format", [1, 1], &mut faults) {
            None if fields.get("match_format").is_none() => {
                fields.missing("match_format", "1", &mut faults)
            }
            _ => {}
        }
        let name = fields.text("name", &mut faults);
        if name.is_none() && fields.get("name").is_none() {
            fields.missing("name", "a text", &mut faults);
        }
        let mut sets = sets.to_vec();
        for key in fields.texts("unset", &mut faults) {
            match SetArg::unset(&key) {
                Ok(argument) => sets.push(argument),
                Err(error) => {
                    let fault = fields.fault_of("E193", "unset", error.reason);
                    faults.push(fault.allowed(
                        "keys that the study is to lack, as \"ramp.contact_stiffness_n_per_m\"",
                    ));
                }
            }
        }
        let study = match fields.text("study", &mut faults) {
            Some(file) => Some(Study::from_path(&folder.join(file), &sets)?),
            None => {
                if fields.get("study").is_none() {
                    fields.missing(
                        "study",
                        "the path of a study file, from the match file's folder",
                        &mut faults,
                    );
                }
                None
            }
        };
        let effort = effort(&fields, &mut faults);
        let settings = settings(&fields, &mut faults);
        let parameters = match &study {
            Some(study) => draws::read(&fields, "parameter", study, &mut faults),
            None => Vec::new(),
        };
        let effort = Effort {
            each: each(&fields, &parameters, &mut faults),
            ..effort
        };
        let mut observed_faults = Faults::new();
        let mut observations = observed::read(&fields, &folder, statements, &mut observed_faults);
        // Weights of observations that cannot be read would be reported as unknown keys.
        if observed_faults.is_empty() {
            weigh(&fields, &mut observations, &mut faults);
        }
        faults.append(&mut observed_faults);
        if fields.get("parameter").is_none() {
            fields.missing("parameter", "[[parameter]], one or more", &mut faults);
        }
        if observations.iter().all(|one| one.range.is_none()) && faults.is_empty() {
            fields.missing(
                "observation",
                "[[observation]] with a range, one or more",
                &mut faults,
            );
        }
        let seed = fields.count("seed", [0, MOST], &mut faults).unwrap_or(1);
        let mut problem = match (study, faults.is_empty()) {
            (Some(study), true) => Self {
                tolerance_pct: study.search.tolerance_pct,
                sets,
                name: name.unwrap_or_default(),
                path: path.to_path_buf(),
                text,
                study,
                seed,
                parameters,
                observations,
                statements,
                settings,
                effort,
            },
            _ => return Err(StudyErrors::new(faults)),
        };
        problem.check_settings(&mut faults);
        problem.check_ends(&fields, &mut faults);
        match faults.is_empty() {
            true => Ok(problem),
            false => Err(StudyErrors::new(faults)),
        }
    }

    /// Stages that some observation needs.
    pub fn stages(&self) -> impl Iterator<Item = Stage> + '_ {
        let is_asked = |stage: &Stage| self.observations.iter().any(|one| one.stage == *stage);
        Stage::ALL.into_iter().filter(is_asked)
    }

    /// Independent draws of the prior that a stage gets.
    pub fn draws(&self, stage: Stage) -> u64 {
        self.effort.draws[stage as usize]
    }

    /// Searches of each start of the refinement: the fixed value of one parameter, by place and cumulative probability,
    /// and the number of sets. The first fixes none, and has half of the sets where others follow.
    pub(super) fn searches(&self) -> Vec<(Option<(usize, f64)>, u64)> {
        let all = self.effort.refinement / u64::from(self.effort.starts);
        let Some(place) = self.effort.each else {
            return vec![(None, all)];
        };
        let count = self.parameters[place].choices().len();
        let middle = |k: usize| (k as f64 + 0.5) / count as f64;
        let each = all / 2 / count as u64;
        let held = (0..count).map(|k| (Some((place, middle(k))), each));
        std::iter::once((None, all - each * count as u64))
            .chain(held)
            .collect()
    }

    /// `--set` and `--unset` arguments of a parameter set at a stage.
    pub fn arguments(&self, stage: Stage, unit: &[f64]) -> Vec<SetArg> {
        let mut all = self.sets.clone();
        let mut lay = |argument: SetArg| {
            all.retain(|known| known.key != argument.key);
            all.push(argument);
        };
        for text in &self.settings[stage as usize] {
            lay(SetArg::parse(text).expect("checked when read"));
        }
        for (parameter, &p) in self.parameters.iter().zip(unit) {
            for (key, text) in parameter.settings(p) {
                lay(match text {
                    Some(text) => SetArg::parse(&format!("{key}={text}")),
                    None => SetArg::unset(&key),
                }
                .expect("keys are checked when read"));
            }
        }
        all
    }

    /// The study of a parameter set at a stage.
    ///
    /// # Errors
    /// The study's faults, such as a hinge longer than the beam.
    pub fn study_of(&self, stage: Stage, unit: &[f64]) -> Result<Study, StudyErrors> {
        Study::from_path(&self.study.path, &self.arguments(stage, unit))
    }

    /// The study itself with a parameter set's values.
    ///
    /// # Errors
    /// The study's faults.
    pub fn with_values(&self, unit: &[f64]) -> Result<Study, StudyErrors> {
        let bare = Self {
            settings: Default::default(),
            ..self.clone()
        };
        bare.study_of(Stage::DiskAndRamp, unit)
    }

    /// The settings of every stage in use must be a study.
    fn check_settings(&mut self, faults: &mut Faults) {
        let stages: Vec<Stage> = self.stages().collect();
        for stage in stages {
            let mut sets = self.sets.clone();
            sets.extend(
                self.settings[stage as usize]
                    .iter()
                    .map(|text| SetArg::parse(text).expect("checked above")),
            );
            match Study::from_path(&self.study.path, &sets) {
                Ok(study) if stage == Stage::CriticalShocks => {
                    self.tolerance_pct = study.search.tolerance_pct
                }
                Ok(_) => {}
                Err(refused) => faults.extend(refused.errors.into_iter().map(|mut fault| {
                    fault.message = format!("{} (with settings.{})", fault.message, stage.as_str());
                    fault
                })),
            }
        }
    }

    /// Each parameter's ends must be values that the study can have, with all others in the middle.
    fn check_ends(&self, fields: &Fields<'_>, faults: &mut Faults) {
        let entries = fields.list("parameter", &mut Faults::new());
        let middle = vec![0.5; self.parameters.len()];
        for (place, parameter) in self.parameters.iter().enumerate() {
            for end in [0.0, parameter.unset_share, 1.0] {
                let mut unit = middle.clone();
                unit[place] = end;
                // The middle itself may be refused; then the fault is not this parameter's.
                let Err(refused) = self.study_of(Stage::SingleShocks, &unit) else {
                    continue;
                };
                let keys: Vec<&str> = parameter.keys.iter().map(|(key, _)| key.as_str()).collect();
                let own = refused
                    .errors
                    .iter()
                    .find(|fault| keys.contains(&fault.key.as_str()));
                if let Some(own) = own {
                    let (node, path) = &entries[place];
                    let message = format!(
                        "the study refuses {}: {}",
                        parameter.words(end),
                        own.message
                    );
                    let fault = StudyError::at("E193", &node.place, path, message);
                    faults.push(fault.value(&parameter.name).allowed(own.allowed.clone()));
                    break;
                }
            }
        }
    }
}

fn effort(fields: &Fields<'_>, faults: &mut Faults) -> Effort {
    let names = Stage::ALL.map(Stage::as_str);
    let table = |name: &str, names: &[&str], faults: &mut Faults| {
        let node = fields.get(name)?;
        Fields::of(node, name, names, faults)
    };
    let draws = table("draws", &names, faults);
    let mut effort = Effort {
        draws: DRAWS,
        waves: 10,
        samples: 100,
        refinement: 200,
        starts: 2,
        each: None,
        conflict_searches: 0,
        conflict_evaluations: 2000,
        probes: 6,
    };
    if let Some(draws) = draws {
        let mut most = MOST;
        for stage in Stage::ALL {
            let given = draws.count(stage.as_str(), [1, MOST], faults);
            let count = given.unwrap_or(effort.draws[stage as usize].min(most));
            if count > most {
                let fault =
                    draws.fault_of("E193", stage.as_str(), "is more than the stage before has");
                faults.push(fault.allowed(format!(
                    "{most} or fewer: a stage gets the first draws of the one before"
                )));
            }
            effort.draws[stage as usize] = count;
            most = count;
        }
    }
    if let Some(waves) = table("waves", &["count", "samples"], faults) {
        let count = waves.count("count", [0, 100], faults);
        effort.waves = count.map_or(effort.waves, |count| count as u32);
        effort.samples = waves
            .count("samples", [1, MOST], faults)
            .unwrap_or(effort.samples);
    }
    if let Some(refinement) = table("refinement", REFINEMENT, faults) {
        let evaluations = refinement.count("evaluations", [0, MOST], faults);
        effort.refinement = evaluations.unwrap_or(effort.refinement);
        let starts = refinement.count("starts", [1, 1000], faults);
        effort.starts = starts.map_or(effort.starts, |starts| starts as u32);
    }
    if let Some(conflicts) = table("conflicts", &["searches", "evaluations"], faults) {
        let searches = conflicts.count("searches", [0, 1000], faults);
        effort.conflict_searches = searches.unwrap_or(effort.conflict_searches);
        let evaluations = conflicts.count("evaluations", [1, MOST], faults);
        effort.conflict_evaluations = evaluations.unwrap_or(effort.conflict_evaluations);
    }
    if let Some(numerics) = table("numerics", &["probes"], faults) {
        effort.probes = numerics
            .count("probes", [0, 1000], faults)
            .unwrap_or(effort.probes);
    }
    effort
}

/// The table `refinement`; its unknown keys are reported where the effort is read.
fn refinement<'a>(fields: &Fields<'a>) -> Option<Fields<'a>> {
    let node = fields.get("refinement")?;
    Fields::of(node, "refinement", REFINEMENT, &mut Faults::new())
}

/// Gives observations the weights in `refinement.weights`.
fn weigh(fields: &Fields<'_>, observations: &mut [Observation], faults: &mut Faults) {
    let Some(node) = refinement(fields).and_then(|table| table.get("weights")) else {
        return;
    };
    let names: Vec<&str> = observations.iter().map(|one| one.name.as_str()).collect();
    let Some(table) = Fields::of(node, "refinement.weights", &names, faults) else {
        return;
    };
    for one in observations {
        match table.positive(&one.name, faults) {
            Some(_) if one.range.is_none() => {
                let fault = table.fault_of("E193", &one.name, "has no range to hold within");
                faults.push(fault.allowed("an observation with a range"));
            }
            Some(weight) if weight > 0.0 => one.weight = weight,
            Some(_) => {
                let fault = table.fault_of("E193", &one.name, "has no effect");
                faults.push(fault.allowed("a number above 0"));
            }
            None => {}
        }
    }
}

/// The parameter that `refinement.each` names.
fn each(fields: &Fields<'_>, parameters: &[Parameter], faults: &mut Faults) -> Option<usize> {
    let refinement = refinement(fields)?;
    let name = refinement.text("each", faults)?;
    let is_named = |one: &Parameter| one.name == name && !one.choices().is_empty();
    let found = parameters.iter().position(is_named);
    // Faults of the parameters themselves come first.
    if found.is_none() && !parameters.is_empty() {
        let with_choices = parameters.iter().filter(|one| !one.choices().is_empty());
        let names: Vec<&str> = with_choices.map(|one| one.name.as_str()).collect();
        let allowed = match names.is_empty() {
            true => "the name of a parameter with choices; there is none".to_owned(),
            false => names.join(", "),
        };
        let fault = refinement.fault_of("E193", "each", "is no parameter with choices");
        faults.push(fault.allowed(allowed));
    }
    found
}

fn settings(fields: &Fields<'_>, faults: &mut Faults) -> [Vec<String>; 3] {
    let names = Stage::ALL.map(Stage::as_str);
    let table = fields
        .get("settings")
        .and_then(|node| Fields::of(node, "settings", &names, faults));
    Stage::ALL.map(|stage| {
        let Some(table) = &table else {
            return Vec::new();
        };
        let texts = table.texts(stage.as_str(), faults);
        for text in &texts {
            if let Err(error) = SetArg::parse(text) {
                let fault = table.fault_of("E193", stage.as_str(), error.reason);
                faults.push(fault.allowed("texts as of --set: \"section.key=VALUE\""));
            }
        }
        texts
    })
}

/// Whether a file is a match file; a file that cannot be read is none.
pub fn is_match_file(path: &Path) -> bool {
    let text = text_file::read_text(path).unwrap_or_default();
    let table = text.parse::<toml::Table>();
    table.is_ok_and(|table| table.contains_key("match_format"))
}
