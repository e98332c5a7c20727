//! The coordinates of the rows of a table of critical shocks: ramp model, pulse width, sign and further axes.
//!
//! A coordinate is named by its place: [`RAMP`], [`PULSE`], [`SIGN`], then [`Summary::axes`] in their order.

use super::table::BEFORE_AXES;
use crate::search::Sign;
use crate::store::summary::{AxisValue, PointSummary, Summary};
use crate::study::{HEADS, keys};

/// Place of the ramp model.
pub const RAMP: usize = 0;
/// Place of the pulse width.
pub const PULSE: usize = 1;
/// Place of the sign.
pub const SIGN: usize = 2;
/// Keys of a study that list the values of the first three.
const KEYS: [&str; 3] = ["ramp.models", "pulse.widths_ms", "pulse.signs"];

/// A key or value that the table does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value:?} must be one of {allowed}")]
pub struct NotOfTheTable {
    /// What was to be chosen.
    pub key: String,
    /// Value found.
    pub value: String,
    /// Values there are.
    pub allowed: String,
}

/// Names of all coordinates: the columns of the table.
pub fn names(summary: &Summary) -> Vec<&str> {
    let further = summary.axes.iter().map(String::as_str);
    BEFORE_AXES.into_iter().chain(further).collect()
}

/// Value of a row.
pub fn value(point: &PointSummary, place: usize) -> AxisValue {
    match place {
        RAMP => AxisValue::Text(point.ramp.clone()),
        PULSE => AxisValue::Number(point.pulse_ms),
        SIGN => AxisValue::Text(point.sign.as_str().to_owned()),
        further => point.axes[further - BEFORE_AXES.len()].clone(),
    }
}

/// The row with another value.
fn moved(mut point: PointSummary, place: usize, value: &AxisValue) -> PointSummary {
    match (place, value) {
        (RAMP, value) => point.ramp = value.to_string(),
        (PULSE, AxisValue::Number(ms)) => point.pulse_ms = *ms,
        (SIGN, value) => point.sign = Sign::from_word(&value.to_string()).unwrap_or(point.sign),
        (PULSE, AxisValue::Text(_)) => {}
        (further, value) => point.axes[further - BEFORE_AXES.len()] = value.clone(),
    }
    point
}

/// Values that occur, numbers ascending, words in the study's order.
pub fn values(summary: &Summary, place: usize) -> Vec<AxisValue> {
    let mut values: Vec<AxisValue> = Vec::new();
    for point in &summary.points {
        let value = value(point, place);
        if !values.contains(&value) {
            values.push(value);
        }
    }
    if values.iter().all(|value| number(value).is_some()) {
        values.sort_by(|a, b| f64::total_cmp(&number(a).unwrap_or(0.0), &number(b).unwrap_or(0.0)));
    }
    values
}

/// The number of a value that is one.
pub fn number(value: &AxisValue) -> Option<f64> {
    match value {
        AxisValue::Number(number) => Some(*number),
        AxisValue::Text(_) => None,
    }
}

/// Whether a drive must survive all values of it: signs, and heads of one drive.
pub fn is_worst_case(summary: &Summary, place: usize) -> bool {
    place == SIGN || names(summary)[place] == HEADS
}

/// Whether a designer chooses among its values: everything of the drive but pulse width, sign and head.
pub fn is_choice(summary: &Summary, place: usize) -> bool {
    place != PULSE && !is_worst_case(summary, place) && keys::is_of_the_drive(names(summary)[place])
}

/// The coordinate called `key`: a column of the table, or the key of the study that lists its values.
///
/// # Errors
///
/// No such coordinate.
pub fn find(summary: &Summary, option: &str, key: &str) -> Result<usize, NotOfTheTable> {
    let names = names(summary);
    let fits = |place: usize| {
        names[place] == key
            || KEYS.get(place) == Some(&key)
            || (place > SIGN && key.ends_with(&format!(".{}", names[place])))
    };
    let found = (0..names.len()).find(|&place| fits(place));
    found.ok_or_else(|| NotOfTheTable {
        key: option.to_owned(),
        value: key.to_owned(),
        allowed: names.join(", "),
    })
}

/// The value written as `text`.
///
/// # Errors
///
/// No row has it.
pub fn find_value(summary: &Summary, place: usize, text: &str) -> Result<AxisValue, NotOfTheTable> {
    let values = values(summary, place);
    let fits = |value: &&AxisValue| match number(value) {
        Some(number) => text.trim().parse() == Ok(number),
        None => value.to_string() == text,
    };
    values.iter().find(fits).cloned().ok_or_else(|| {
        let words: Vec<String> = values.iter().map(AxisValue::to_string).collect();
        NotOfTheTable {
            key: names(summary)[place].to_owned(),
            value: text.to_owned(),
            allowed: words.join(", "),
        }
    })
}

/// The rows with the values of `a`, and those with the values of `b`, which get those of `a`: so that a comparison finds
/// rows that differ in nothing else.
///
/// # Errors
///
/// A key or a value that the table does not have; other keys in `b`.
pub fn selected(
    summary: &Summary,
    a: &[(String, String)],
    b: &[(String, String)],
) -> Result<(Summary, Summary), NotOfTheTable> {
    let places = |option: &str, pairs: &[(String, String)]| {
        let mut chosen = Vec::new();
        for (key, value) in pairs {
            let place = find(summary, option, key)?;
            chosen.push((place, find_value(summary, place, value)?));
        }
        chosen.sort_by_key(|(place, _)| *place);
        Ok(chosen)
    };
    let (of_a, of_b) = (places("--points", a)?, places("--with", b)?);
    let keys = |pairs: &[(usize, AxisValue)]| {
        let names = names(summary);
        let keys: Vec<&str> = pairs.iter().map(|(place, _)| names[*place]).collect();
        keys.join(", ")
    };
    if keys(&of_a) != keys(&of_b) {
        return Err(NotOfTheTable {
            key: "--with".to_owned(),
            value: keys(&of_b),
            allowed: format!("the keys of --points: {}", keys(&of_a)),
        });
    }
    let rows = |chosen: &[(usize, AxisValue)]| {
        let has = |point: &&PointSummary| {
            let mut pairs = chosen.iter();
            pairs.all(|(place, wanted)| value(point, *place) == *wanted)
        };
        let moved = |point: &PointSummary| {
            let pairs = of_a.iter();
            pairs.fold(point.clone(), |row, (place, value)| {
                moved(row, *place, value)
            })
        };
        Summary {
            points: summary.points.iter().filter(has).map(moved).collect(),
            ..summary.clone()
        }
    };
    Ok((rows(&of_a), rows(&of_b)))
}

/// A coordinate as the label of an axis of a plot.
pub fn label(summary: &Summary, place: usize) -> String {
    match place {
        RAMP => "Ramp model".to_owned(),
        PULSE => "Pulse width (ms)".to_owned(),
        SIGN => "Sign of the shock".to_owned(),
        further => summary.axes[further - BEFORE_AXES.len()].clone(),
    }
}

/// A value in words: `rigid ramp`, `2 ms`, `sign +`, `clearance_um = 60`.
pub fn words(summary: &Summary, place: usize, value: &AxisValue) -> String {
    match place {
        RAMP if value.to_string() == "none" => "no ramp".to_owned(),
        RAMP => format!("{value} ramp"),
        PULSE => format!("{value} ms"),
        SIGN => format!("sign {}", value.to_string().replace('-', "\u{2212}")),
        further => format!("{} = {value}", summary.axes[further - BEFORE_AXES.len()]),
    }
}

/// All coordinates of a row in words.
pub fn name(summary: &Summary, point: &PointSummary) -> String {
    let words: Vec<String> = (0..names(summary).len())
        .map(|place| words(summary, place, &value(point, place)))
        .collect();
    words.join(", ")
}

/// Abscissa of a plot when none is asked for: the numbers with most values, pulse widths where there are as many; words
/// only where every number has one value.
pub fn default_abscissa(summary: &Summary) -> usize {
    let rank = |place: usize| {
        let values = values(summary, place);
        let is_numeric = values.iter().all(|value| number(value).is_some());
        (is_numeric && values.len() > 1, values.len(), place == PULSE)
    };
    let places = (0..names(summary).len()).filter(|place| *place != SIGN);
    // Ties keep the first.
    places
        .rev()
        .max_by_key(|&place| rank(place))
        .unwrap_or(PULSE)
}
