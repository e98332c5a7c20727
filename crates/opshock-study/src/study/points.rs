//! Makes the axes and points of a study, in the canonical order of the search and the natural order of tables.

use std::collections::HashMap;

use opshock_solver::scene::Scene;

use super::datum::Datum;
use super::fault::{Severity, StudyError};
use super::fields;
use super::keys::{self, KEYS};
use super::ramp_remeshed::RemeshedRamp;
use super::read::{self, MAX_POINTS};
use super::scene;
use super::settings::{Settings, View};
use super::unit;
use super::validity::{Check, PointRules};
use super::words::Faces;
use crate::identity::CellId;
use crate::search::{Ramp, Sign};
use opshock_solver::scene::discretisation::{Discretisation, Levels};

/// A value on an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValue {
    /// Number, in the unit of the axis.
    Number(f64),
    /// Whole number.
    Integer(i64),
    /// Word.
    Word(String),
    /// Flag.
    Flag(bool),
}

impl AxisValue {
    fn from_datum(datum: &Datum) -> Self {
        match datum {
            Datum::Number(value) => Self::Number(*value),
            Datum::Integer(value) => Self::Integer(*value),
            Datum::Flag(flag) => Self::Flag(*flag),
            Datum::Word(word) | Datum::Text(word) => Self::Word(word.clone()),
            other => Self::Word(format!("{other:?}")),
        }
    }

    /// JSON number, string or boolean.
    pub fn to_json(&self) -> serde_json::Value {
        match self {
            Self::Number(value) => serde_json::json!(value),
            Self::Integer(value) => serde_json::json!(value),
            Self::Word(word) => serde_json::json!(word),
            Self::Flag(flag) => serde_json::json!(flag),
        }
    }
}

impl std::fmt::Display for AxisValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(value) if (f64::MIN_POSITIVE..1e-5).contains(&value.abs()) => {
                write!(f, "{value:e}")
            }
            Self::Number(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Word(word) => f.write_str(word),
            Self::Flag(flag) => write!(f, "{flag}"),
        }
    }
}

/// An axis beside widths, ramp models and signs.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Dotted path of the key.
    pub path: String,
    /// Name of its column in tables: the key's last name, or the path when two axes share that.
    pub column: String,
    /// Its values, in file order.
    pub values: Vec<AxisValue>,
}

/// One cell of a study: a search over the amplitude of one scene and sign.
#[derive(Clone, Debug)]
pub struct Point {
    /// Identity by content: scene and sign.
    pub id: CellId,
    /// Ramp model.
    pub ramp: Ramp,
    /// Pulse width, ms, as the study gives it.
    pub pulse_ms: f64,
    /// Pulse width, s.
    pub pulse_width_s: f64,
    /// Sign of the amplitude.
    pub sign: Sign,
    /// The way the head faces.
    pub faces: Faces,
    /// What a running-out disk takes of the ramp's gaps, within the scene, m; 0 unless asked for.
    pub gap_taken_m: f64,
    /// Uncertainty wanted of the critical shock, a share of it.
    pub target_uncertainty: f64,
    /// Column and value on every further axis, in axis order.
    pub axes: Vec<(String, AxisValue)>,
    /// The scene as the head sees it, with z from the disk to the head.
    pub scene: Scene,
    /// Its ramp on other meshes; `None` for one that is no solid.
    pub remeshed: Option<RemeshedRamp>,
    /// Round that added the width, 0 for the study's own.
    pub round: u32,
}

impl Point {
    /// Sign of the scene's amplitude: the shock's, reversed for a head that faces up.
    pub fn factor(&self) -> f64 {
        self.sign.factor() * self.faces.factor()
    }

    /// Levels with each of its discretisation parameters refined by `steps`.
    pub fn levels(&self, steps: i8) -> Levels {
        let mesh = Some(Discretisation::RampMesh).filter(|_| self.remeshed.is_some());
        let all = Discretisation::ALL.into_iter().chain(mesh);
        all.fold(Levels::NONE, |levels, one| levels.changed(one, steps))
    }

    /// Short name: `rigid 2 ms +`, and the further axes.
    pub fn label(&self) -> String {
        let axes: String = self
            .axes
            .iter()
            .map(|(column, value)| format!(" {column}={value}"))
            .collect();
        format!("{} {} ms {}{axes}", self.ramp, self.pulse_ms, self.sign)
    }
}

/// Paths of the axes beside widths, ramp models and signs, in the order of the table of keys:
/// the order in which they were written is not part of a study.
fn axis_paths(settings: &Settings) -> Vec<&str> {
    let mut axes: Vec<&str> = settings
        .iter()
        .filter(|(_, setting)| setting.is_axis)
        .map(|(path, _)| path)
        .collect();
    let rank = |path: &str| {
        let pattern = keys::pattern(path);
        KEYS.iter().position(|key| key.path == pattern)
    };
    axes.sort_by_key(|path| (rank(path), *path));
    axes
}

/// Path of the axis of a drive's heads.
pub const HEADS: &str = "head";

/// The axes beside widths, ramp models and signs.
pub fn axes(settings: &Settings) -> Vec<Axis> {
    let paths = axis_paths(settings);
    let last = |path: &str| path.rsplit('.').next().unwrap_or(path).to_string();
    let heads = settings.heads();
    let head = (!heads.is_empty()).then(|| Axis {
        path: HEADS.to_string(),
        column: HEADS.to_string(),
        values: (settings.named_heads().into_iter())
            .filter(|(_, entry)| heads.contains(entry))
            .map(|(name, _)| AxisValue::Word(name.to_string()))
            .collect(),
    });
    let others = paths.iter().map(|path| {
        let shared = paths
            .iter()
            .filter(|other| last(other) == last(path))
            .count()
            > 1;
        // Columns every table has already.
        let taken =
            ["ramp", "pulse_ms", "sign", "runs", "status", "flags"].contains(&last(path).as_str());
        Axis {
            path: path.to_string(),
            column: if shared || taken {
                path.to_string()
            } else {
                last(path)
            },
            values: settings
                .get(path)
                .map(|setting| setting.values.iter().map(AxisValue::from_datum).collect())
                .unwrap_or_default(),
        }
    });
    head.into_iter().chain(others).collect()
}

/// Ramp models of the study, in canonical order.
pub fn ramps(settings: &Settings) -> Vec<Ramp> {
    let asked = View::first(settings).get(&fields::RAMP_MODELS);
    Ramp::ALL
        .into_iter()
        .filter(|ramp| asked.contains(ramp))
        .collect()
}

/// Signs of the study, in canonical order.
pub fn signs(settings: &Settings) -> Vec<Sign> {
    let asked = View::first(settings).get(&fields::PULSE_SIGNS);
    Sign::ALL
        .into_iter()
        .filter(|sign| asked.contains(sign))
        .collect()
}

/// Pulse widths of the study, ms, ascending.
pub fn widths_ms(settings: &Settings) -> Vec<f64> {
    let mut widths = View::first(settings).get(&fields::PULSE_WIDTHS_MS).to_vec();
    widths.sort_by(f64::total_cmp);
    widths
}

/// Positions 0..n in the order of the search: both ends, then the middle of each gap, gap by gap.
pub fn ends_then_midpoints(n: usize) -> Vec<usize> {
    if n == 0 {
        return Vec::new();
    }
    let mut order = vec![0];
    if n > 1 {
        order.push(n - 1);
    }
    let mut gaps = vec![(0, n - 1)];
    while !gaps.is_empty() {
        let mut next = Vec::new();
        for (low, high) in gaps {
            if high > low + 1 {
                let middle = low + (high - low) / 2;
                order.push(middle);
                next.extend([(low, middle), (middle, high)]);
            }
        }
        gaps = next;
    }
    order
}

/// The combinations of the further axes, outermost first, as views on the settings.
pub(super) fn combinations<'a>(settings: &'a Settings, mut each: impl FnMut(&View<'a>)) {
    combinations_while(settings, |view| {
        each(view);
        true
    });
}

/// As [`combinations`], until `each` wants no more.
fn combinations_while<'a>(settings: &'a Settings, mut each: impl FnMut(&View<'a>) -> bool) {
    let length = |path| settings.get(path).map_or(1, |setting| setting.values.len());
    let heads = ("heads", settings.heads().len().max(1));
    let others = axis_paths(settings).into_iter();
    let axes: Vec<(&'a str, usize)> = std::iter::once(heads)
        .chain(others.map(|path| (path, length(path))))
        .filter(|(_, length)| *length != 1)
        .collect();
    let total: usize = axes.iter().map(|(_, length)| length).product();
    for number in 0..total {
        let mut rest = number;
        let mut positions: Vec<(&'a str, usize)> = Vec::with_capacity(axes.len());
        for &(path, length) in axes.iter().rev() {
            positions.push((path, rest % length));
            rest /= length;
        }
        if !each(&View::on(settings, positions)) {
            return;
        }
    }
}

/// Different errors after which no further combination is looked at: many times what is listed.
const ENOUGH: usize = 1000;

/// Checks the number of points and everything that depends on several keys, at every combination
/// until [`ENOUGH`] is wrong.
pub fn check(settings: &Settings, faults: &mut Vec<StudyError>) {
    let first = View::first(settings);
    Check {
        view: &first,
        faults,
    }
    .study();
    let axes = axis_paths(settings);
    let widths = widths_ms(settings);
    let count = axes
        .iter()
        .filter_map(|path| settings.get(path))
        .map(|setting| setting.values.len() as f64)
        .product::<f64>()
        * widths.len() as f64
        * settings.heads().len().max(1) as f64
        * (ramps(settings).len() * signs(settings).len()) as f64;
    if count > MAX_POINTS as f64 {
        let blamed = axes
            .last()
            .copied()
            .unwrap_or(fields::PULSE_WIDTHS_MS.path());
        if let Some(place) = settings.get(blamed).map(|setting| &setting.place) {
            faults.push(read::too_many_points(place, blamed, count));
        }
        return;
    }
    let mut rules = PointRules::default();
    let mut tidied = faults.len();
    combinations_while(settings, |view| {
        rules.check(view, faults, &widths);
        if faults.len() <= 2 * tidied + ENOUGH {
            return true;
        }
        // The same fault at many combinations is one fault.
        super::fault::tidy(faults);
        tidied = faults.len();
        let is_error = |fault: &&StudyError| fault.severity() == Severity::Error;
        faults.iter().filter(is_error).count() < ENOUGH
    });
}

/// Every point, in the canonical order of the search: further axes outermost, then widths ends
/// first, ramps, signs.
pub fn points(settings: &Settings) -> Vec<Point> {
    let (widths, ramps, signs) = (widths_ms(settings), ramps(settings), signs(settings));
    let axes = axes(settings);
    let mut points = Vec::new();
    combinations(settings, |view| {
        for position in ends_then_midpoints(widths.len()) {
            for &ramp in &ramps {
                for &sign in &signs {
                    points.push(point(view, &axes, ramp, widths[position], sign));
                }
            }
        }
    });
    points
}

/// Heads that are one drive in everything: one row of a table would stand for both.
pub(super) fn alike(settings: &Settings, points: &[Point]) -> Option<StudyError> {
    if settings.heads().len() < 2 {
        return None;
    }
    let mut first: HashMap<CellId, &Point> = HashMap::new();
    for point in points {
        let Some(other) = first.insert(point.id, point) else {
            continue;
        };
        let name = |point: &Point| point.axes.first().map(|(_, value)| value.to_string());
        let (a, b) = (name(other)?, name(point)?);
        let place = &settings.get("heads")?.place;
        let message = format!("the heads {a:?} and {b:?} differ in nothing but their names");
        let fault = StudyError::at("E191", place, "heads", message);
        return Some(
            fault
                .allowed("heads that differ in disk, ramp, slider or suspension")
                .hint("one entry stands for all that are alike"),
        );
    }
    None
}

/// One point of a view.
pub fn point(view: &View<'_>, axes: &[Axis], ramp: Ramp, pulse_ms: f64, sign: Sign) -> Point {
    let (scene, faces) = scene::build(view, ramp, pulse_ms);
    Point {
        id: CellId::new(&scene, sign == Sign::Plus, faces == Faces::Up),
        ramp,
        pulse_ms,
        pulse_width_s: unit::si(fields::PULSE_WIDTHS_MS.path(), pulse_ms),
        sign,
        faces,
        gap_taken_m: scene::gap_taken_m(view),
        target_uncertainty: view
            .get(&fields::SEARCH_TARGET_UNCERTAINTY_PCT)
            .unwrap_or_else(|| scene::preset(view).target_uncertainty()),
        axes: axes
            .iter()
            .filter_map(|axis| {
                view.datum(&axis.path)
                    .map(|datum| (axis.column.clone(), AxisValue::from_datum(datum)))
            })
            .collect(),
        scene,
        remeshed: RemeshedRamp::of(view, ramp),
        round: 0,
    }
}

/// The point `like` at another width, added in a later round.
pub fn at_width(settings: &Settings, like: &Point, pulse_ms: f64, round: u32) -> Point {
    let axes = axes(settings);
    let mut found = None;
    combinations(settings, |view| {
        let has = |axis: &Axis| view.datum(&axis.path).map(AxisValue::from_datum);
        let values = axes.iter().map(has);
        if found.is_none() && values.eq(like.axes.iter().map(|(_, value)| Some(value.clone()))) {
            let point = point(view, &axes, like.ramp, pulse_ms, like.sign);
            found = Some(Point { round, ..point });
        }
    });
    found.expect("a point of the study lies on its axes")
}

/// Positions of the points in the order of tables: further axes, ramps, signs, widths ascending.
pub fn table_order(points: &[Point], axes: &[Axis]) -> Vec<usize> {
    let rank = |point: &Point| -> Vec<usize> {
        point
            .axes
            .iter()
            .zip(axes)
            .map(|((_, value), axis)| {
                axis.values
                    .iter()
                    .position(|known| known == value)
                    .unwrap_or(0)
            })
            .collect()
    };
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&points[a], &points[b]);
        rank(a)
            .cmp(&rank(b))
            .then(a.ramp.cmp(&b.ramp))
            .then(a.sign.cmp(&b.sign))
            .then(a.pulse_ms.total_cmp(&b.pulse_ms))
    });
    order
}

#[cfg(test)]
mod tests {
    use super::ends_then_midpoints;

    #[test]
    fn ends_come_first_then_the_middle_of_each_gap() {
        assert!(ends_then_midpoints(0).is_empty());
        assert_eq!(ends_then_midpoints(1), [0]);
        assert_eq!(ends_then_midpoints(2), [0, 1]);
        assert_eq!(ends_then_midpoints(6), [0, 5, 2, 1, 3, 4]);
        assert_eq!(ends_then_midpoints(9), [0, 8, 4, 2, 6, 1, 3, 5, 7]);
        for n in 0..200 {
            let mut order = ends_then_midpoints(n);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..n));
        }
    }
}
