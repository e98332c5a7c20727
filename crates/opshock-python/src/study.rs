//! Studies: read, changed, described.

use crate::failure::{or_raise, raised};
use opshock::cli::failure::{Failure, Fault};
use opshock_study::study::text_file::read_text;
use opshock_study::study::{
    Choice, Point, Ramp, SetArg, Sign, Study as Checked, StudyErrors, is_within,
};
use pyo3::prelude::*;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// A study that has passed every check, with the text and the settings it was made of.
#[pyclass(frozen, module = "opshock._native")]
pub struct Study {
    /// The study.
    pub study: Checked,
    settings: Vec<String>,
}

impl Study {
    /// Of a text; `file` is the file that has it, if one does.
    fn of(
        text: String,
        path: &Path,
        file: Option<PathBuf>,
        settings: Vec<String>,
    ) -> Result<Self, Failure> {
        let sets: Result<Vec<SetArg>, _> = settings.iter().map(|one| SetArg::parse(one)).collect();
        let mut study = Checked::from_text_of(text, path, &sets?)?;
        study.file = file;
        Ok(Self { study, settings })
    }

    fn with(&self, further: Vec<String>) -> Result<Self, Failure> {
        // A later setting replaces what it holds.
        let key = |setting: &str| {
            setting
                .split('=')
                .next()
                .unwrap_or_default()
                .trim()
                .to_owned()
        };
        let later: Vec<String> = further.iter().map(|setting| key(setting)).collect();
        let is_kept =
            |setting: &&String| !later.iter().any(|above| is_within(&key(setting), above));
        let kept = self.settings.iter().filter(is_kept).cloned();
        let settings = kept.chain(further).collect();
        let Checked {
            text, path, file, ..
        } = &self.study;
        Self::of(text.clone(), path, file.clone(), settings)
    }
}

#[pymethods]
impl Study {
    /// Reads a study file, with settings as `KEY=VALUE` laid over it.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        let text = read_text(&path).map_err(|fault| raised(py, StudyErrors::from(*fault)))?;
        let file = std::fs::canonicalize(&path).ok();
        or_raise(py, Self::of(text, &path, file, settings))
    }

    /// Reads the text of a study; `path` is the file it would be in.
    #[staticmethod]
    fn parse(py: Python<'_>, text: String, path: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        or_raise(py, Self::of(text, &path, None, settings))
    }

    /// Text, path, file and settings, of which [`Study::restored`] makes the study again.
    fn parts(&self) -> (&str, &Path, Option<&Path>, &[String]) {
        let study = &self.study;
        (
            &study.text,
            &study.path,
            study.file.as_deref(),
            &self.settings,
        )
    }

    /// The study of these parts.
    #[staticmethod]
    fn restored(
        py: Python<'_>,
        text: String,
        path: PathBuf,
        file: Option<PathBuf>,
        settings: Vec<String>,
    ) -> PyResult<Self> {
        or_raise(py, Self::of(text, &path, file, settings))
    }

    /// Text of the smallest useful study.
    #[staticmethod]
    fn example(name: &str) -> String {
        Checked::example(name)
    }

    /// The same study with further settings.
    fn changed(&self, py: Python<'_>, settings: Vec<String>) -> PyResult<Self> {
        or_raise(py, self.with(settings))
    }

    /// The same study with one ramp model, pulse width and sign: those given, else its only ones.
    fn chosen(
        &self,
        py: Python<'_>,
        ramp: Option<&str>,
        pulse_ms: Option<f64>,
        sign: Option<&str>,
    ) -> PyResult<Self> {
        let choice = Choice {
            ramp: or_raise(
                py,
                word("ramp", ramp, "none, rigid or deformable", Ramp::from_word),
            )?,
            pulse_ms,
            sign: or_raise(py, word("sign", sign, "+ or -", Sign::from_word))?,
            amplitude_g: None,
        };
        let point = self.study.select_point(&choice);
        let point = point.map_err(|error| raised(py, error))?;
        let mut settings = Vec::new();
        if self.study.ramps != [point.ramp] {
            settings.push(format!("ramp.models=[\"{}\"]", point.ramp));
        }
        if self.study.widths_ms != [point.pulse_ms] {
            settings.push(format!("pulse.widths_ms=[{:?}]", point.pulse_ms));
        }
        if self.study.signs != [point.sign] {
            settings.push(format!("pulse.signs=[\"{}\"]", point.sign));
        }
        or_raise(py, self.with(settings))
    }

    /// Every setting with its default, as TOML.
    fn resolved_toml(&self) -> String {
        self.study.resolved_toml()
    }

    /// Name, digest, axes, points and remarks, as JSON.
    fn described(&self) -> String {
        let study = &self.study;
        let order = study.table_order();
        let points: Vec<Value> = order.iter().map(|&k| point(&study.points[k])).collect();
        let axes: Map<String, Value> = (study.axes.iter())
            .map(|axis| (axis.column.clone(), json!(axis.path)))
            .collect();
        let remarks: Vec<Value> = study.remarks.iter().map(|one| one.to_json()).collect();
        json!({
            "name": study.name,
            "digest": study.digest_hex(),
            "path": study.path,
            "axes": axes,
            "points": points,
            "remarks": remarks,
        })
        .to_string()
    }
}

/// Coordinates of a point, as every table names them, and its label.
fn point(point: &Point) -> Value {
    let axes: Map<String, Value> = (point.axes.iter())
        .map(|(name, value)| (name.clone(), value.to_json()))
        .collect();
    json!({
        "ramp": point.ramp.as_str(),
        "pulse_ms": point.pulse_ms,
        "sign": point.sign.to_string(),
        "axes": axes,
        "label": point.label(),
    })
}

/// A word of a study, if one is given.
fn word<T>(
    name: &str,
    given: Option<&str>,
    allowed: &str,
    read: impl Fn(&str) -> Option<T>,
) -> Result<Option<T>, Failure> {
    let Some(given) = given else {
        return Ok(None);
    };
    let refused = || {
        Failure::Usage(vec![Fault {
            key: Some(name.to_owned()),
            value: Some(given.to_owned()),
            allowed: Some(allowed.to_owned()),
            ..Fault::new("usage", format!("{name} = {given:?}"))
        }])
    };
    read(given).map(Some).ok_or_else(refused)
}
