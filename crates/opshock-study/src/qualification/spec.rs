//! Reads specification files: amplitudes that a drive must survive, at which pulses, altitudes and clearances.
//!
//! A specification is TOML like a study and gives the same messages: all faults at once, each with its place.

use std::path::Path;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::shock::PulseShape;

use crate::search::decisive::FAR;
use crate::study::table_fields::{Faults, Fields, wrong_kind};
use crate::study::tree::{self, Value};
use crate::study::{SetArg, Study, StudyError, StudyErrors, UncertaintyOf, is_within};

const TOP: &[&str] = &[
    "spec_format",
    "name",
    "source",
    "requirement",
    "damage_boundary",
];
const OF_BOUNDARY: &[&str] = &["widths_ms", "signs", "set"];
/// Fewest pulse widths of a damage boundary: a short pulse, a long one, and one between.
const FEWEST_WIDTHS: usize = 3;
/// Highest amplitude of its search, G: short pulses need more than a study's own.
const BOUNDARY_MOST_G: f64 = 1e5;
const OF_REQUIREMENT: &[&str] = &[
    "name",
    "amplitude_g",
    "margin_pct",
    "widths_ms",
    "signs",
    "altitude_m",
    "clearance_nm",
    "set",
];
/// Keys of a requirement that are keys of the study.
const OF_STUDY: [(&str, &str); 4] = [
    ("widths_ms", "pulse.widths_ms"),
    ("signs", "pulse.signs"),
    ("altitude_m", "gas.altitude_m"),
    ("clearance_nm", "failure.clearance_nm"),
];
/// Keys that a requirement sets by itself, and may not set otherwise.
const OWN: [&str; 6] = [
    "name",
    "outputs",
    "search.uncertainty",
    "search.amplitude_g",
    "search.required_amplitude_g",
    "search.uncertainty_of",
];
/// Longest name of a requirement, bytes.
const LONGEST_NAME: usize = 100;
/// Longest name of a study.
const MOST_LETTERS: usize = 200;
/// Largest margin, per cent.
const MOST_MARGIN_PCT: f64 = 1000.0;

/// A specification that has passed every check.
#[derive(Clone, Debug)]
pub struct Spec {
    /// Name.
    pub name: String,
    /// Where its figures come from.
    pub source: Option<String>,
    /// Its text.
    pub text: String,
    /// Requirements, in the file's order.
    pub requirements: Vec<Requirement>,
    /// The study of the damage boundary, where one is asked for.
    pub damage_boundary: Option<Study>,
}

/// What a drive must survive.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// Name, unlike those of the other requirements.
    pub name: String,
    /// Amplitude, G.
    pub amplitude_g: f64,
    /// Margin, per cent of the amplitude.
    pub margin_pct: f64,
    /// Keys of the study that it sets by itself.
    pub sets: Vec<String>,
    /// The study with the requirement's pulses, and its search about the required amplitude.
    pub study: Study,
}

impl Requirement {
    /// Amplitude that every point must survive: with the margin, G.
    pub fn required_g(&self) -> f64 {
        required_g(self.amplitude_g, self.margin_pct)
    }

    /// Smallest and largest velocity change of its pulses at the required amplitude, m/s.
    pub fn velocity_changes_m_per_s(&self) -> [f64; 2] {
        let peak_m_per_s2 = self.required_g() * STANDARD_GRAVITY_M_PER_S2;
        let pulses = self.study.points.iter().map(|point| &point.scene.pulse);
        let integrals_s = pulses.map(|pulse| pulse.integral_s().expect("a study's pulse is sound"));
        integrals_s.fold([f64::INFINITY, 0.0], |[low, high], integral_s| {
            let change = (peak_m_per_s2 * integral_s).abs();
            [low.min(change), high.max(change)]
        })
    }
}

/// Shape of a study's pulses, in words.
pub fn pulse_shape(study: &Study) -> &'static str {
    let first = study.points.first();
    match first.map(|point| &point.scene.pulse.shape) {
        Some(PulseShape::HalfSine) => "half-sine",
        Some(PulseShape::Haversine) => "haversine",
        Some(PulseShape::Square) => "square",
        Some(PulseShape::Trapezoid { .. }) => "trapezoid",
        Some(PulseShape::DampedSine { .. }) => "damped sine",
        Some(PulseShape::Table { .. }) => "as sampled",
        None => "none",
    }
}

impl Spec {
    /// Reads a specification, and makes a study of each of its requirements from the study file at `study`; `sets` are laid
    /// over that study, and the requirement over them.
    ///
    /// # Errors
    ///
    /// Every fault of the specification, or of the study.
    pub fn from_path(path: &Path, study: &Path, sets: &[SetArg]) -> Result<Spec, StudyErrors> {
        Self::read(path, study, sets, true)
    }

    /// The same, but for the damage boundary: the requirements alone.
    ///
    /// # Errors
    ///
    /// As [`Spec::from_path`].
    pub fn requirements_from_path(
        path: &Path,
        study: &Path,
        sets: &[SetArg],
    ) -> Result<Vec<Requirement>, StudyErrors> {
        Ok(Self::read(path, study, sets, false)?.requirements)
    }

    fn read(
        path: &Path,
        study: &Path,
        sets: &[SetArg],
        with_boundary: bool,
    ) -> Result<Spec, StudyErrors> {
        // A fault of the study itself is no fault of every requirement.
        let plain = Study::from_path(study, sets)?;
        let (text, root) = tree::read(path)?;
        let mut faults = Faults::new();
        let Some(fields) = Fields::of(&root, "", TOP, &mut faults) else {
            return Err(StudyErrors::new(faults));
        };
        if fields.count("spec_format", [1, 1], &mut faults).is_none()
            && fields.get("spec_format").is_none()
        {
            fields.missing("spec_format", "1", &mut faults);
        }
        let name = required_text(&fields, "name", &mut faults);
        let from = fields.text("source", &mut faults);
        let entries = fields.list("requirement", &mut faults);
        if entries.is_empty() && faults.is_empty() {
            fields.missing("requirement", "[[requirement]], one or more", &mut faults);
        }
        let mut requirements: Vec<Requirement> = Vec::new();
        for (node, path) in entries {
            let Some(entry) = Fields::of(node, &path, OF_REQUIREMENT, &mut faults) else {
                continue;
            };
            let Some(one) = requirement(&entry, (&plain, study, sets), &mut faults) else {
                continue;
            };
            if requirements.iter().any(|other| other.name == one.name) {
                let fault = entry.fault_of("E194", "name", "is the name of another requirement");
                faults.push(fault.allowed("a name that no other requirement has"));
            }
            requirements.push(one);
        }
        let asked = fields.get("damage_boundary").filter(|_| with_boundary);
        let damage_boundary = asked.and_then(|node| {
            let path = fields.path("damage_boundary");
            let entry = Fields::of(node, &path, OF_BOUNDARY, &mut faults)?;
            boundary(&entry, (&plain, study, sets), &mut faults)
        });
        match (name, faults.is_empty()) {
            (Some(name), true) => Ok(Spec {
                name,
                source: from,
                text,
                requirements,
                damage_boundary,
            }),
            _ => Err(StudyErrors::new(faults)),
        }
    }
}

/// Amplitude with its margin, G.
fn required_g(amplitude_g: f64, margin_pct: f64) -> f64 {
    amplitude_g + amplitude_g * margin_pct / 100.0
}

fn required_text(fields: &Fields<'_>, name: &str, faults: &mut Faults) -> Option<String> {
    if fields.get(name).is_none() {
        fields.missing(name, "a text", faults);
    }
    let text = fields.text(name, faults)?;
    // The name of a requirement is that of the folder with its simulations, too.
    let is_plain = !text.trim().is_empty()
        && text.len() <= LONGEST_NAME
        && !text.starts_with('.')
        && !text.chars().any(|c| c == '/' || c == '"' || c.is_control());
    if !is_plain {
        let fault = fields.fault_of("E194", name, "is no name");
        faults.push(fault.allowed(format!(
            "text of 1 to {LONGEST_NAME} bytes that does not begin with a dot, without /, \" and control characters"
        )));
    }
    is_plain.then_some(text)
}

/// A requirement and its study; `None` where it has a fault.
fn requirement(
    entry: &Fields<'_>,
    (plain, file, sets): (&Study, &Path, &[SetArg]),
    faults: &mut Faults,
) -> Option<Requirement> {
    let before = faults.len();
    let name = required_text(entry, "name", faults);
    if entry.get("amplitude_g").is_none() {
        entry.missing("amplitude_g", "a number > 0, in G", faults);
    }
    let amplitude_g = entry.number("amplitude_g", faults);
    if amplitude_g.is_some_and(|amplitude_g| amplitude_g <= 0.0) {
        let fault = entry.fault_of("E130", "amplitude_g", "is not above zero");
        faults.push(fault.allowed("a number > 0, in G"));
    }
    let margin_pct = match entry.get("margin_pct") {
        Some(_) => entry.positive("margin_pct", faults),
        None => Some(0.0),
    };
    if margin_pct.is_some_and(|margin_pct| margin_pct > MOST_MARGIN_PCT) {
        let fault = entry.fault_of("E130", "margin_pct", "is out of range");
        faults.push(fault.allowed(format!("0 to {MOST_MARGIN_PCT}, in per cent")));
    }
    let own = own_settings(entry, faults);
    let (name, amplitude_g, margin_pct) = (name?, amplitude_g?, margin_pct?);
    if faults.len() > before {
        return None;
    }
    let required_g = required_g(amplitude_g, margin_pct);
    let searched = [
        format!(
            "search.amplitude_g={{ min = {:?}, max = {:?} }}",
            plain.search.amplitude_min_g.min(required_g / FAR),
            required_g * FAR
        ),
        format!("search.required_amplitude_g={required_g:?}"),
        "search.uncertainty_of=\"decisive\"".to_owned(),
    ];
    match study_with((plain, file, sets), &name, &own, (&searched, &[])) {
        Ok(study) => Some(Requirement {
            name,
            amplitude_g,
            margin_pct,
            sets: own
                .iter()
                .filter_map(|(_, text)| text.split_once('='))
                .map(|(key, _)| key.to_owned())
                .collect(),
            study,
        }),
        Err(refused) => {
            refuse(
                entry,
                &format!("requirement {name:?}"),
                &own,
                refused,
                faults,
            );
            None
        }
    }
}

/// The study of a damage boundary: intervals of every width and sign, of one ramp model and head.
fn boundary(
    entry: &Fields<'_>,
    (plain, file, sets): (&Study, &Path, &[SetArg]),
    faults: &mut Faults,
) -> Option<Study> {
    let before = faults.len();
    if entry.get("widths_ms").is_none() {
        entry.missing("widths_ms", "three or more pulse widths, in ms", faults);
    }
    // As many intervals as there are points: none is refined unless the entry sets it.
    let mut own = vec![("set", "search.max_refinements=0".to_owned())];
    own.extend(own_settings(entry, faults));
    if faults.len() > before {
        return None;
    }
    let searched = [format!(
        "search.amplitude_g={{ min = {:?}, max = {BOUNDARY_MOST_G:?} }}",
        plain.search.amplitude_min_g
    )];
    let name = "damage boundary";
    // Every point has its interval.
    let search = &plain.search;
    let given = [
        (
            "search.uncertainty_of",
            search.uncertainty_of != UncertaintyOf::All,
        ),
        (
            "search.required_amplitude_g",
            search.required_amplitude_g.is_some(),
        ),
    ];
    let given = given.into_iter().filter(|(_, is_given)| *is_given);
    let unset: Vec<&str> = given.map(|(key, _)| key).collect();
    let study = study_with((plain, file, sets), name, &own, (&searched, &unset));
    let study =
        study.map_err(|refused| refuse(entry, "the damage boundary", &own, refused, faults));
    let study = study.ok()?;
    if study.widths_ms.len() < FEWEST_WIDTHS {
        let fault = entry.fault_of("E194", "widths_ms", "has too few pulse widths");
        faults.push(fault.allowed("three or more, from short pulses to long ones"));
    }
    if study.points.len() != study.widths_ms.len() * study.signs.len() {
        let fault = entry.fault(
            "E194",
            "the study has more points than pulse widths and signs",
        );
        faults
            .push(fault.allowed("a study with one ramp model, head and value of every other key"));
    }
    (faults.len() == before).then_some(study)
}

/// The study with settings laid over it: its own of an entry of the file, those of the search for it, and without some keys.
fn study_with(
    (plain, file, sets): (&Study, &Path, &[SetArg]),
    name: &str,
    own: &[(&'static str, String)],
    (searched, unset): (&[String], &[&str]),
) -> Result<Study, StudyErrors> {
    let both: String = format!("{}, {name}", plain.name)
        .chars()
        .take(MOST_LETTERS)
        .collect();
    let always = [
        format!("name={both:?}"),
        "outputs=[\"critical_shock\"]".to_owned(),
        "search.uncertainty=true".to_owned(),
    ];
    let mut all = sets.to_vec();
    // What the requirement sets replaces what the command line sets.
    let mut lay = |argument: SetArg| {
        all.retain(|known| !is_within(&known.key, &argument.key));
        all.push(argument);
    };
    let added = plain.search.added_points.as_ref();
    let added = added.map(|_| "search.added_points");
    for key in added.iter().chain(unset) {
        lay(SetArg::unset(key).expect("a key"));
    }
    let keys = own.iter().map(|(_, text)| text);
    for text in keys.chain(&always).chain(searched) {
        lay(SetArg::parse(text).expect("a key and a value"));
    }
    Study::from_path(file, &all)
}

/// The faults of an entry's study, at their places in the entry where that has the key.
fn refuse(
    entry: &Fields<'_>,
    what: &str,
    own: &[(&'static str, String)],
    refused: StudyErrors,
    faults: &mut Faults,
) {
    faults.extend(refused.errors.into_iter().map(|fault| {
        let place = own.iter().find(|(_, text)| {
            let key = text.split_once('=').map(|(key, _)| key);
            key == Some(fault.key.as_str())
        });
        refusal(entry, what, place.map(|(name, _)| *name), fault)
    }));
}
/// A fault of the requirement's study, at the place of the requirement where that has the key.
fn refusal(
    entry: &Fields<'_>,
    what: &str,
    own: Option<&'static str>,
    mut fault: StudyError,
) -> StudyError {
    match own {
        Some(name) => {
            let message = format!("the study refuses {}: {}", fault.key, fault.message);
            entry
                .fault_of("E194", name, message)
                .allowed(fault.allowed.clone())
                .hint(fault.hint.clone())
        }
        None => {
            fault.message = format!("{} (with {what})", fault.message);
            fault
        }
    }
}

/// Settings of the study that a requirement names: which of its keys, and `KEY=VALUE`.
fn own_settings(entry: &Fields<'_>, faults: &mut Faults) -> Vec<(&'static str, String)> {
    let mut own = Vec::new();
    for (name, key) in OF_STUDY {
        let Some(node) = entry.get(name) else {
            continue;
        };
        let values: &[_] = match &node.value {
            Value::List(values) => values,
            _ => std::slice::from_ref(node),
        };
        let is_word = name == "signs";
        for value in values {
            match &value.value {
                Value::Text(_) if is_word => {}
                Value::Float(_) | Value::Integer(_, 10) if !is_word => {}
                _ => {
                    let wanted = if is_word {
                        "\"+\" or \"-\""
                    } else {
                        "a number"
                    };
                    faults.push(wrong_kind(value, &entry.path(name), wanted));
                }
            }
        }
        own.push((name, format!("{key}={}", node.place.text())));
    }
    let mut set = Vec::new();
    for text in entry.texts("set", faults) {
        let fault = |reason: String| entry.fault_of("E194", "set", reason);
        match SetArg::parse(&text) {
            Err(error) => {
                faults.push(fault(error.reason).allowed("texts as of --set: \"section.key=VALUE\""))
            }
            Ok(argument) => {
                let of_study = OF_STUDY.map(|(_, key)| key);
                let mut own_keys = OWN.iter().copied().chain(of_study);
                let clashes =
                    |key: &str| is_within(&argument.key, key) || is_within(key, &argument.key);
                if own_keys.any(clashes) || set.iter().any(|known: &String| clashes(known)) {
                    let what = format!("{} is set already", argument.key);
                    faults.push(
                        fault(what)
                            .allowed("each key once, and none that the requirement sets itself"),
                    );
                }
                set.push(argument.key);
                own.push(("set", text));
            }
        }
    }
    own
}
