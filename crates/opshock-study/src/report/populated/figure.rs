//! Draws fragility curves: share of drives that fail by an amplitude, with its band and the log-normal fit.

use super::words::Populated;
use crate::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value, colour,
};

/// Points of a fitted curve.
const POINTS: usize = 80;

/// A panel for each requirement, a curve for each pulse width.
pub(in crate::report) fn fragility_figure(populated: &Populated<'_>) -> Figure {
    let answer = populated.answer;
    let panels = answer.requirements.iter().map(|one| {
        let curves = one.fragility.iter().enumerate();
        let series = curves.flat_map(|(place, curve)| {
            let name = format!("{} ms", curve.pulse_ms);
            let colour = colour::CYCLE[place % colour::CYCLE.len()];
            let samples = curve.steps.iter().map(|step| {
                let share = &step.fails;
                let y = 100.0 * share.with as f64 / share.of as f64;
                let [low, high] = share.interval.map(|end| 100.0 * end);
                Sample {
                    x: step.amplitude_g,
                    value: Value::Known { y, low, high },
                    open: false,
                    note: format!(
                        "{:.0} G: {} of {} fail, {low:.1} to {high:.1} %",
                        step.amplitude_g, share.with, share.of
                    ),
                }
            });
            let marker = (Marker::Circle, Fill::Full);
            let counted = Series::marked(&name, colour, None, marker, samples.collect());
            let fitted = curve.fit.map(|fit| {
                let ends = [0, curve.steps.len() - 1].map(|at| curve.steps[at].amplitude_g.ln());
                let points = (0..=POINTS).map(|at| {
                    let share = at as f64 / POINTS as f64;
                    let amplitude_g = (ends[0] + share * (ends[1] - ends[0])).exp();
                    (amplitude_g, 100.0 * fit.fails(amplitude_g))
                });
                let name = format!("{name}, log-normal fit");
                Series::curve(&name, colour, Dash::Dashed, points.collect())
            });
            std::iter::once(counted).chain(fitted)
        });
        Panel {
            title: one.name.clone(),
            x: Axis::log("Amplitude (G)"),
            y: Axis::linear("Drives that fail (%)"),
            series: series.collect(),
            rules: vec![Rule::Vertical {
                x: one.required_g,
                label: "required".into(),
            }],
            shaded: None,
        }
    });
    Figure {
        title: format!("{}: fragility", answer.name),
        subtitle: format!(
            "of the first {} drives; bars: exact 95 % interval at each amplitude",
            answer.fragility_drives
        ),
        columns: answer.requirements.len().clamp(1, 2),
        panel_px: (470.0, 300.0),
        panels: panels.collect(),
    }
}
