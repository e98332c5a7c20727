//! Draws margin curves: smallest clearance against amplitude, at every point of a study.

use super::chart::{Axis, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value, colour};
use super::critical_shock::{series_name, signed_series, signs};
use super::outcome_map::RunDot;
use crate::store::summary::Summary;

const MARKERS: [Marker; 4] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
];

/// A panel for every ramp model (and further axis value) and sign, a curve for every pulse width;
/// open marks failed. Runs without a clearance are left out.
pub fn margin_curves(summary: &Summary, runs: &[RunDot]) -> Figure {
    let mut panels = Vec::new();
    for (name, sign, title) in signed_series(summary) {
        let mut series = Vec::new();
        let rows = summary.points.iter().enumerate();
        let of_panel = rows.filter(|(_, p)| p.sign == sign && series_name(summary, p) == name);
        for (place, (row, point)) in of_panel.enumerate() {
            let mut samples: Vec<Sample> = runs
                .iter()
                .filter(|run| run.point == row)
                .filter_map(sample)
                .collect();
            samples.sort_by(|a, b| a.x.total_cmp(&b.x));
            if samples.is_empty() {
                continue;
            }
            series.push(Series {
                marker_px: 3.0,
                ..Series::marked(
                    &format!("{} ms", point.pulse_ms),
                    colour::CYCLE[place % colour::CYCLE.len()],
                    Some(Dash::Solid),
                    (MARKERS[place % MARKERS.len()], Fill::Full),
                    samples,
                )
            });
        }
        panels.push(Panel {
            title,
            x: Axis::log("Amplitude (G)"),
            y: Axis::linear("Smallest clearance (nm)"),
            series,
            rules: Vec::new(),
            shaded: None,
        });
    }
    Figure {
        title: "Margin".into(),
        subtitle: "smallest clearance of every simulation; open marks fail".into(),
        columns: signs(summary).len().max(1),
        panel_px: (470.0, 300.0),
        panels,
    }
}

fn sample(run: &RunDot) -> Option<Sample> {
    let y = 1e9 * run.h_min_m.filter(|h| h.is_finite())?;
    Some(Sample {
        x: run.amplitude_g,
        value: Value::Known { y, low: y, high: y },
        open: run.verdict == "fails",
        note: format!("{:.1} G: {}, {y:.2} nm", run.amplitude_g, run.verdict),
    })
}
