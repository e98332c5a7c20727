//! Draws the critical shock against any coordinate: the curve a study is made for.

use super::chart::{Axis, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value, colour};
use super::coordinates::{self, PULSE, default_abscissa};
use super::critical_layout::{Layout, Line, PanelOfLines};
use super::terms::is_reserved;
use crate::search::Sign;
use crate::store::summary::{PointSummary, Status, Summary};

const MARKERS: [Marker; 4] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
];
const DASHES: [Dash; 4] = [Dash::Solid, Dash::Dashed, Dash::DashDot, Dash::Dotted];

/// Critical shocks over the coordinate with most numbers, as [`critical_shock_over`].
pub fn critical_shock_figure(summary: &Summary, provenance: &str) -> Figure {
    critical_shock_over(summary, default_abscissa(summary), provenance)
}

/// Critical shocks over the pulse width with a panel for each sign: the paper's Fig. 13.
pub fn paper_figure(summary: &Summary, provenance: &str) -> Figure {
    figure(summary, &Layout::of(summary, PULSE, false), provenance)
}

/// Critical shocks over coordinate `x` (see [`super::coordinates`]) on one common ordinate; panels for each sign, and
/// one for the worst of all signs and heads.
///
/// Marks are `a_crit_g` with its uncertainty interval; an open mark has a reservation (see the table's
/// status and flags); an open arrow is only a bound: no failure up to, or failure already at, the
/// end of the searched range. Series of equal values are set some pixels apart.
pub fn critical_shock_over(summary: &Summary, x: usize, provenance: &str) -> Figure {
    figure(summary, &Layout::of(summary, x, true), provenance)
}

pub(super) fn figure(summary: &Summary, layout: &Layout, provenance: &str) -> Figure {
    let ordinate = ordinate(summary);
    let abscissa = abscissa(summary, layout);
    let panels: Vec<Panel> = layout
        .panels
        .iter()
        .map(|panel| Panel {
            title: panel.title.clone(),
            x: abscissa.clone(),
            y: ordinate.clone(),
            series: panel
                .lines
                .iter()
                .enumerate()
                .map(|(index, line)| series(summary, panel, line, index))
                .collect(),
            rules: Vec::new(),
            shaded: None,
        })
        .collect();
    let bounded = summary
        .points
        .iter()
        .any(|point| matches!(point.status, Status::AboveRange | Status::BelowRange));
    let has_uncertainty = |point: &PointSummary| point.uncertainty_g.is_some();
    let mut subtitle = "critical shock".to_owned();
    if summary.points.iter().any(has_uncertainty) {
        subtitle.push_str(" with its uncertainty interval");
    }
    if summary.points.iter().any(is_reserved) {
        subtitle.push_str("; open mark: with a reservation");
    }
    if bounded {
        subtitle.push_str("; open arrow: only a bound");
    }
    let lacks_uncertainty =
        |point: &PointSummary| point.status == Status::Ok && !has_uncertainty(point);
    if summary.points.iter().any(lacks_uncertainty) {
        subtitle.push_str("; no interval: uncertainty not known");
    }
    if !provenance.is_empty() {
        subtitle = format!("{subtitle}   [{provenance}]");
    }
    let width_px = match layout.columns {
        1 => 720.0,
        2 => 470.0,
        _ => 400.0,
    };
    Figure {
        title: summary.study.clone(),
        subtitle,
        columns: layout.columns,
        panel_px: (width_px, 400.0),
        panels,
    }
}

/// The abscissa with the values of the study as ticks, those that would sit on one another left out.
fn abscissa(summary: &Summary, layout: &Layout) -> Axis {
    let axis = Axis::linear(&coordinates::label(summary, layout.x));
    let values: Vec<f64> = layout.ticks.iter().map(|(value, _)| *value).collect();
    let (low, high) = match (values.first(), values.last()) {
        (Some(first), Some(last)) if last > first => {
            (first - 0.08 * (last - first), last + 0.08 * (last - first))
        }
        (Some(first), _) => (
            first - 0.5 * first.abs().max(1.0),
            first + 0.5 * first.abs().max(1.0),
        ),
        _ => (0.0, 1.0),
    };
    let axis = axis.between(low, high);
    if layout.ticks.iter().all(|(_, word)| word.is_none()) {
        return Axis {
            ticks: (values.len() <= 9).then(|| readable(&values, (low, high))),
            ..axis
        };
    }
    let words = layout.ticks.iter();
    axis.named(words.map(|(value, word)| (*value, word.clone().unwrap_or_default())))
}

/// One name per ramp model and combination of further axis values, in the study's order.
pub(super) fn series_names(summary: &Summary) -> Vec<String> {
    distinct(
        summary
            .points
            .iter()
            .map(|point| series_name(summary, point)),
    )
}

/// The panels of figures that keep both signs apart: every series with every sign the table has, each
/// with its title.
pub(super) fn signed_series(summary: &Summary) -> Vec<(String, Sign, String)> {
    let names = series_names(summary);
    let signs = signs(summary);
    let panels = names
        .iter()
        .flat_map(|name| signs.iter().map(move |sign| (name, *sign)));
    panels
        .map(|(name, sign)| {
            let sign_text = sign.as_str().replace('-', "\u{2212}");
            (name.clone(), sign, format!("{name}, sign {sign_text}"))
        })
        .collect()
}

/// Signs that the table has, plus first.
pub(super) fn signs(summary: &Summary) -> Vec<Sign> {
    [Sign::Plus, Sign::Minus]
        .into_iter()
        .filter(|sign| summary.points.iter().any(|point| point.sign == *sign))
        .collect()
}

/// Name of the series a row belongs to.
pub(super) fn series_name(summary: &Summary, point: &PointSummary) -> String {
    let mut name = match point.ramp.as_str() {
        "none" => "no ramp".to_owned(),
        ramp => format!("{ramp} ramp"),
    };
    for (axis, value) in summary.axes.iter().zip(&point.axes) {
        name.push_str(&format!(", {axis} = {value}"));
    }
    name
}

fn series(summary: &Summary, panel: &PanelOfLines, line: &Line, index: usize) -> Series {
    let samples: Vec<Sample> = line
        .marks
        .iter()
        .filter_map(|&(x, row)| {
            let point = &summary.points[row];
            let name = match panel.is_worst {
                true => format!("lowest: {}", coordinates::name(summary, point)),
                false => coordinates::name(summary, point),
            };
            sample(x, &name, point)
        })
        .collect();
    Series {
        dodge_px: 6.0 * (index as f64 - 0.5 * (panel.lines.len() as f64 - 1.0)),
        ..Series::marked(
            &line.name,
            colour::CYCLE[line.colour % colour::CYCLE.len()],
            Some(DASHES[line.style % DASHES.len()]),
            (MARKERS[line.style % MARKERS.len()], Fill::Full),
            samples,
        )
    }
}

fn sample(x: f64, name: &str, point: &PointSummary) -> Option<Sample> {
    let y = point.known_g()?;
    let half = point.uncertainty_g.unwrap_or(0.0);
    let value = match point.status {
        Status::AboveRange => Value::Above(y),
        Status::BelowRange => Value::Below(y),
        Status::Ok | Status::Undecided | Status::Open => Value::Known {
            y,
            low: y - half,
            high: y + half,
        },
    };
    let g = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.1}"));
    let critical = match (point.a_crit_g, point.uncertainty_g) {
        (Some(y), Some(half)) => format!("{y:.1} +- {half:.1} G"),
        (Some(y), None) => format!("{y:.1} G, uncertainty not known"),
        (None, _) => "not known".to_owned(),
    };
    let mut note = format!(
        "{name}: {critical}, survives {} G, fails {} G, {}",
        g(point.survived_g),
        g(point.failed_g),
        point.status.as_str()
    );
    for flag in &point.flags {
        note.push_str(&format!(", {}", flag.as_str()));
    }
    Some(Sample {
        x,
        value,
        open: is_reserved(point),
        note,
    })
}

/// One ordinate for all panels, with room for uncertainty intervals and arrows. Linear from zero, so that
/// heights compare as they are, unless the values span so much that the small ones would vanish.
fn ordinate(summary: &Summary) -> Axis {
    let mut values = Vec::new();
    for point in summary
        .points
        .iter()
        .filter_map(|point| sample(0.0, "", point))
    {
        match point.value {
            Value::Known { y, low, high } => values.extend([y, low, high]),
            Value::Above(y) => values.extend([y, 1.25 * y]),
            Value::Below(y) => values.extend([y, y / 1.25]),
        }
    }
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let label = "Critical shock (G)";
    if low > high {
        Axis::linear(label)
    } else if low > 0.0 && high > 5.0 * low {
        Axis::log(label).between(low / 1.15, high * 1.15)
    } else {
        Axis::linear(label).between(0.0, 1.06 * high)
    }
}

/// Values as ticks without those that would sit on one another.
fn readable(widths: &[f64], span: (f64, f64)) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for &width in widths {
        if kept
            .last()
            .is_none_or(|last| width - last > 0.06 * (span.1 - span.0))
        {
            kept.push(width);
        }
    }
    kept
}

fn distinct<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen: Vec<T> = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}
