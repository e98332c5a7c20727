//! Compares two tables of critical shocks point by point, and lists only what differs.
//!
//! Points are matched by ramp, width, sign and further axes. An axis that only one study has is
//! matched with the other study's setting of that key. Intervals that touch count as overlapping.

use super::table::{aligned, uncertainty_words};
use crate::store::summary::{AxisValue, PointSummary, Status, Summary};
use crate::study::difference::{self, SettingDifference, Settings};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// One side of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    /// Where it was read from, as the user named it.
    pub source: &'a str,
    /// Its table.
    pub summary: &'a Summary,
    /// The study with every default; `None`: not kept, settings cannot be compared.
    pub resolved_study: Option<&'a str>,
}

/// Whether the difference of two critical shocks is beyond their uncertainty intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Significance {
    /// Uncertainty intervals do not overlap.
    BeyondUncertainties,
    /// Uncertainty intervals overlap, search brackets do not.
    WithinUncertainties,
    /// Search brackets overlap already.
    WithinBrackets,
    /// Search brackets do not overlap, and a side has no uncertainty interval.
    BeyondBrackets,
    /// A side has no bracket.
    Unknown,
}

impl Significance {
    /// Compares the rows of one point.
    pub fn of(a: &PointSummary, b: &PointSummary) -> Significance {
        let (Some(bracket_a), Some(bracket_b)) = (a.bracket_g(), b.bracket_g()) else {
            return Significance::Unknown;
        };
        let overlap = |one: [f64; 2], other: [f64; 2]| one[0] <= other[1] && other[0] <= one[1];
        if overlap(bracket_a, bracket_b) {
            return Significance::WithinBrackets;
        }
        match (a.interval_g(), b.interval_g()) {
            (Some(a), Some(b)) if overlap(a, b) => Significance::WithinUncertainties,
            (Some(_), Some(_)) => Significance::BeyondUncertainties,
            _ => Significance::BeyondBrackets,
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Significance::BeyondUncertainties => "beyond uncertainty intervals",
            Significance::WithinUncertainties => "within uncertainty intervals",
            Significance::WithinBrackets => "within brackets",
            Significance::BeyondBrackets => "beyond brackets, no intervals",
            Significance::Unknown => "unknown",
        }
    }
}

/// A point of both tables whose answers differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PointDifference {
    /// Names of the further axes with their values.
    pub axes: Vec<(String, AxisValue)>,
    /// Row of A.
    pub a: PointSummary,
    /// Row of B.
    pub b: PointSummary,
    /// Columns that differ.
    pub differs: Vec<&'static str>,
    /// `a_crit_g` of B over that of A, less one, per cent; `None` unless both are bracketed.
    pub change_pct: Option<f64>,
    /// Whether the difference is beyond the uncertainty intervals.
    pub significance: Significance,
}

/// A point of one table only.
#[derive(Clone, Debug, PartialEq)]
pub struct LonePoint {
    /// Names of the further axes with their values.
    pub axes: Vec<(String, AxisValue)>,
    /// Its row.
    pub row: PointSummary,
}

/// What differs between two tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Settings; `None` when a side does not keep its study.
    pub settings: Option<Vec<SettingDifference>>,
    /// Points of both, in the order of A.
    pub points: Vec<PointDifference>,
    /// Points of both whose rows are equal.
    pub equal_points: usize,
    /// Points of A only.
    pub only_a: Vec<LonePoint>,
    /// Points of B only.
    pub only_b: Vec<LonePoint>,
}

/// Compares two tables.
pub fn compare(a: Side<'_>, b: Side<'_>) -> Comparison {
    let settings_a = a.resolved_study.and_then(difference::flat);
    let settings_b = b.resolved_study.and_then(difference::flat);
    let paths_a = axis_paths(a.summary, settings_a.as_ref());
    let paths_b = axis_paths(b.summary, settings_b.as_ref());
    let mut paths = paths_a.clone();
    paths.extend(
        paths_b
            .iter()
            .filter(|path| !paths_a.contains(path))
            .cloned(),
    );

    let axes_a = |row: &PointSummary| axes_of(row, &paths, &paths_a, settings_a.as_ref());
    let axes_b = |row: &PointSummary| axes_of(row, &paths, &paths_b, settings_b.as_ref());
    let mut rest: Vec<LonePoint> = b
        .summary
        .points
        .iter()
        .map(|row| lone(row, axes_b))
        .collect();
    let (mut points, mut only_a, mut equal_points) = (Vec::new(), Vec::new(), 0);
    for row in &a.summary.points {
        let mine = lone(row, axes_a);
        let Some(place) = rest.iter().position(|other| is_same_point(&mine, other)) else {
            only_a.push(mine);
            continue;
        };
        let other = rest.remove(place);
        let differs = differing(row, &other.row);
        if differs.is_empty() {
            equal_points += 1;
        } else {
            points.push(PointDifference {
                change_pct: change_pct(row, &other.row),
                significance: Significance::of(row, &other.row),
                axes: mine.axes,
                a: mine.row,
                b: other.row,
                differs,
            });
        }
    }
    Comparison {
        settings: settings_a
            .zip(settings_b)
            .map(|(a, b)| difference::differing(&a, &b)),
        points,
        equal_points,
        only_a,
        only_b: rest,
    }
}

fn lone(row: &PointSummary, axes: impl Fn(&PointSummary) -> Vec<(String, AxisValue)>) -> LonePoint {
    LonePoint {
        axes: axes(row),
        row: row.clone(),
    }
}

fn is_same_point(a: &LonePoint, b: &LonePoint) -> bool {
    let place = |point: &LonePoint| (point.row.pulse_ms, point.row.sign);
    a.row.ramp == b.row.ramp && place(a) == place(b) && a.axes == b.axes
}

/// Axes by their full paths: a column is named by the last word alone where that is unique.
fn axis_paths(summary: &Summary, settings: Option<&Settings>) -> Vec<String> {
    let path = |column: &String| {
        let ending = format!(".{column}");
        let mut found = settings
            .into_iter()
            .flatten()
            .filter(|(path, value)| value.is_array() && path.ends_with(&ending));
        match (found.next(), found.next()) {
            (Some((path, _)), None) => path.clone(),
            _ => column.clone(),
        }
    };
    summary.axes.iter().map(path).collect()
}

/// Values on all axes: from the row, else what the study sets once for all points.
fn axes_of(
    row: &PointSummary,
    paths: &[String],
    own: &[String],
    settings: Option<&Settings>,
) -> Vec<(String, AxisValue)> {
    let value = |path: &String| match own.iter().position(|known| known == path) {
        Some(place) => row.axes.get(place).cloned(),
        None => match settings?.get(path)? {
            Value::Number(number) => number.as_f64().map(AxisValue::Number),
            Value::String(text) => Some(AxisValue::Text(text.clone())),
            Value::Bool(flag) => Some(AxisValue::Text(flag.to_string())),
            _ => None,
        },
    };
    paths
        .iter()
        .filter_map(|path| Some((path.clone(), value(path)?)))
        .collect()
}

/// Columns of the answer that differ; the cost of the search is not part of the answer.
fn differing(a: &PointSummary, b: &PointSummary) -> Vec<&'static str> {
    [
        ("a_crit_g", a.a_crit_g != b.a_crit_g),
        ("uncertainty_g", a.uncertainty_g != b.uncertainty_g),
        (
            "half_min_height_g",
            a.half_min_height_g != b.half_min_height_g,
        ),
        ("survived_g", a.survived_g != b.survived_g),
        ("failed_g", a.failed_g != b.failed_g),
        ("onset_g", a.onset_g != b.onset_g),
        ("status", a.status != b.status),
        ("flags", a.flags != b.flags),
    ]
    .into_iter()
    .filter_map(|(column, differs)| differs.then_some(column))
    .collect()
}

fn change_pct(a: &PointSummary, b: &PointSummary) -> Option<f64> {
    Some(100.0 * (b.a_crit_g? / a.a_crit_g? - 1.0))
}

impl Comparison {
    /// Table for a terminal.
    pub fn text(&self, a: Side<'_>, b: Side<'_>) -> String {
        let mut text = String::new();
        for (letter, side) in [("A", a), ("B", b)] {
            let _ = writeln!(text, "{letter}: {} ({})", side.summary.study, side.source);
        }
        match &self.settings {
            None => text.push_str("settings: not kept by both, not compared\n"),
            Some(settings) => {
                let _ = writeln!(text, "settings that differ: {}", settings.len());
                for setting in settings {
                    let word = |value: &Option<Value>| {
                        value.as_ref().map_or("unset".to_owned(), Value::to_string)
                    };
                    let (a, b) = (word(&setting.a), word(&setting.b));
                    let _ = writeln!(text, "  {}: {a} | {b}", setting.key);
                }
            }
        }
        let (differ, equal) = (self.points.len(), self.equal_points);
        let _ = writeln!(text, "points of both: {differ} differ, {equal} equal");
        if differ > 0 {
            text.push_str(&self.points_table());
        }
        for (letter, lone) in [("A", &self.only_a), ("B", &self.only_b)] {
            if !lone.is_empty() {
                let _ = writeln!(text, "points of {letter} only: {}", lone.len());
            }
            for LonePoint { axes, row } in lone {
                let axes: String = axes.iter().map(|(k, v)| format!(" {k}={v}")).collect();
                let sign = row.sign.as_str();
                let _ = writeln!(text, "  {} {} ms {sign}{axes}", row.ramp, row.pulse_ms);
            }
        }
        text
    }

    fn points_table(&self) -> String {
        let words = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
        let mut header = words(&["ramp", "pulse (ms)", "sign"]);
        if let Some(point) = self.points.first() {
            header.extend(point.axes.iter().map(|(path, _)| path.clone()));
        }
        for letter in ["A", "B"] {
            header.push(format!("{letter}: bracket (G)"));
            header.push("uncertainty (G)".to_owned());
        }
        header.extend(words(&["change (%)", "A_crit", "differs"]));
        let rows: Vec<Vec<String>> = self
            .points
            .iter()
            .map(|point| {
                let row = &point.a;
                let mut cells = vec![row.ramp.clone(), row.pulse_ms.to_string()];
                cells.push(row.sign.as_str().to_owned());
                cells.extend(point.axes.iter().map(|(_, value)| value.to_string()));
                for row in [&point.a, &point.b] {
                    cells.push(bracket_words(row));
                    cells.push(uncertainty_words(row));
                }
                let change = point.change_pct.map(|change| format!("{change:+.2}"));
                cells.push(change.unwrap_or_default());
                cells.push(point.significance.words().to_owned());
                cells.push(point.differs.join(", "));
                cells
            })
            .collect();
        aligned(&header, &rows)
    }

    /// As JSON: `a`, `b`, `settings`, `points`, `equal_points`, `only_a`, `only_b`.
    pub fn json(&self, a: Side<'_>, b: Side<'_>) -> Value {
        let side = |side: Side<'_>| {
            json!({
                "source": side.source,
                "study": side.summary.study,
                "digest": side.summary.digest,
            })
        };
        json!({
            "a": side(a),
            "b": side(b),
            "settings": self.settings,
            "points": self.points,
            "equal_points": self.equal_points,
            "only_a": self.only_a,
            "only_b": self.only_b,
        })
    }
}

fn bracket_words(row: &PointSummary) -> String {
    let number = |value: Option<f64>| value.map_or("?".to_owned(), |value| format!("{value:.1}"));
    match row.status {
        Status::Ok => format!("{} .. {}", number(row.survived_g), number(row.failed_g)),
        Status::AboveRange => format!("> {}", number(row.survived_g)),
        Status::BelowRange => format!("< {}", number(row.failed_g)),
        Status::Undecided | Status::Open => row.status.as_str().to_owned(),
    }
}

fn coordinates<M: SerializeMap>(
    map: &mut M,
    axes: &[(String, AxisValue)],
    row: &PointSummary,
) -> Result<(), M::Error> {
    map.serialize_entry("ramp", &row.ramp)?;
    map.serialize_entry("pulse_ms", &row.pulse_ms)?;
    map.serialize_entry("sign", row.sign.as_str())?;
    axes.iter()
        .try_for_each(|(path, value)| map.serialize_entry(path, value))
}

fn answer(row: &PointSummary) -> Value {
    json!({
        "a_crit_g": row.a_crit_g,
        "uncertainty_g": row.uncertainty_g,
        "half_min_height_g": row.half_min_height_g,
        "survived_g": row.survived_g,
        "failed_g": row.failed_g,
        "onset_g": row.onset_g,
        "status": row.status,
        "flags": row.flags,
    })
}

impl Serialize for LonePoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        coordinates(&mut map, &self.axes, &self.row)?;
        map.end()
    }
}

impl Serialize for PointDifference {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        coordinates(&mut map, &self.axes, &self.a)?;
        map.serialize_entry("differs", &self.differs)?;
        map.serialize_entry("change_pct", &self.change_pct)?;
        map.serialize_entry("significance", &self.significance)?;
        map.serialize_entry("a", &answer(&self.a))?;
        map.serialize_entry("b", &answer(&self.b))?;
        map.end()
    }
}

#[cfg(test)]
mod tests;
