//! Draws the outcome map: every simulation of a study in the plane of pulse width and amplitude.

use super::chart::colour::{self, Rgb};
use super::chart::{Axis, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value};
use super::critical_shock::{series_name, signed_series, signs};
use crate::search::Sign;
use crate::store::summary::Summary;
use opshock_solver::simulation::Mechanism;

/// One simulation of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct RunDot {
    /// Row of the summary it belongs to.
    pub point: usize,
    /// Amplitude without sign, G.
    pub amplitude_g: f64,
    /// `survives`, `fails` or `undecided`.
    pub verdict: String,
    /// Smallest clearance, m.
    pub h_min_m: Option<f64>,
    /// Why it failed, of the lowest failure of a point whose history says so.
    pub mechanism: Option<Mechanism>,
}

/// Mark of a run whose mechanism is known.
fn mark(mechanism: Mechanism) -> (Rgb, Marker) {
    match mechanism {
        Mechanism::RampImpact => (colour::BLACK, Marker::Square),
        Mechanism::DimpleSeparation => (colour::GREEN, Marker::Square),
        Mechanism::Compression => (colour::SKY, Marker::Square),
        Mechanism::LiftLoss => (colour::ORANGE, Marker::Diamond),
        Mechanism::Limiter => (colour::PURPLE, Marker::Triangle),
        Mechanism::LiftTab => (colour::PURPLE, Marker::Diamond),
        Mechanism::Other => (colour::GREY, Marker::Square),
    }
}

/// A panel for every series (ramp model and further axis values) and sign; every simulation a
/// dot, the critical shock as a line, the amplitude of first touch as a dotted line.
pub fn outcome_map(summary: &Summary, runs: &[RunDot]) -> Figure {
    let amplitudes = || {
        let touches = summary.points.iter().filter_map(|point| point.onset_g);
        runs.iter().map(|run| run.amplitude_g).chain(touches)
    };
    let low = amplitudes().fold(f64::INFINITY, f64::min);
    let high = amplitudes().fold(f64::NEG_INFINITY, f64::max);
    let mut panels = Vec::new();
    for (name, sign, title) in signed_series(summary) {
        let mut y = Axis::log("Amplitude (G)");
        if low < high {
            y = y.between(low / 1.12, high * 1.12);
        }
        panels.push(Panel {
            title,
            x: Axis::linear("Pulse width (ms)"),
            y,
            series: panel_series(summary, runs, &name, sign),
            rules: Vec::new(),
            shaded: None,
        });
    }
    Figure {
        title: "Every simulation".into(),
        subtitle: String::new(),
        columns: signs(summary).len().max(1),
        panel_px: (470.0, 330.0),
        panels,
    }
}

fn panel_series(summary: &Summary, runs: &[RunDot], name: &str, sign: Sign) -> Vec<Series> {
    let rows: Vec<usize> = (0..summary.points.len())
        .filter(|&row| {
            let point = &summary.points[row];
            point.sign == sign && series_name(summary, point) == name
        })
        .collect();
    let curve = |value: fn(&crate::store::summary::PointSummary) -> Option<f64>| {
        let mut curve: Vec<(f64, f64)> = rows
            .iter()
            .map(|&row| &summary.points[row])
            .map(|point| (point.pulse_ms, value(point).unwrap_or(f64::NAN)))
            .collect();
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve
    };
    let mut series = vec![
        Series::curve(
            "critical shock",
            colour::BLACK,
            Dash::Solid,
            curve(|p| p.known_g()),
        ),
        Series::curve(
            "first touch of the ramp",
            colour::GREY,
            Dash::Dotted,
            curve(|p| p.onset_g),
        ),
    ];
    let mut add = |name: &str, colour, marker, px, has: &dyn Fn(&RunDot) -> bool| {
        let runs = runs.iter().filter(|run| rows.contains(&run.point));
        let of_series = runs.filter(|run| has(run));
        let samples: Vec<Sample> = of_series.map(|run| dot(summary, run)).collect();
        if !samples.is_empty() {
            series.push(Series {
                marker_px: px,
                ..Series::marked(name, colour, None, marker, samples)
            });
        }
    };
    for (verdict, colour, marker) in [
        ("survives", colour::BLUE, (Marker::Circle, Fill::Open)),
        ("fails", colour::VERMILLION, (Marker::Square, Fill::Full)),
        ("undecided", colour::PURPLE, (Marker::Cross, Fill::Full)),
    ] {
        add(verdict, colour, marker, 3.0, &|run| {
            run.verdict == verdict && run.mechanism.is_none()
        });
    }
    for mechanism in Mechanism::ALL {
        let (colour, marker) = mark(mechanism);
        let name = format!("fails: {}", mechanism.words());
        add(&name, colour, (marker, Fill::Full), 4.5, &|run| {
            run.mechanism == Some(mechanism)
        });
    }
    series
}

fn dot(summary: &Summary, run: &RunDot) -> Sample {
    let clearance = run
        .h_min_m
        .map_or(String::new(), |h| format!(", clearance {:.2} nm", 1e9 * h));
    let mechanism = run.mechanism;
    let mechanism = mechanism.map_or(String::new(), |one| format!(" ({})", one.words()));
    let y = run.amplitude_g;
    Sample {
        x: summary.points[run.point].pulse_ms,
        value: Value::Known { y, low: y, high: y },
        open: false,
        note: format!("{y:.1} G: {}{mechanism}{clearance}", run.verdict),
    }
}
