//! Damage boundary of a qualification: sentence, table, figure, CSV.

use crate::qualification::{BoundaryPoint, DamageBoundary, pulse_shape};
use crate::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value, colour,
};
use crate::report::table::csv_line;
use crate::search::Sign;
use crate::store::summary::Summary;
use crate::study::Study;

/// A damage boundary, and the pulses it is of.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// The boundary.
    pub found: DamageBoundary,
    /// Shape of the pulses, in words.
    pub shape: &'static str,
    /// Simulations behind it.
    pub runs: u64,
}

impl Boundary {
    /// From the critical shocks of a study.
    pub fn of(study: &Study, summary: &Summary) -> Option<Boundary> {
        Some(Boundary {
            found: DamageBoundary::of(study, summary)?,
            shape: pulse_shape(study),
            runs: summary.totals.runs,
        })
    }

    /// The pulses that no drive like this fails at, and what is left open at the ends of the widths.
    pub fn sentences(&self) -> Vec<String> {
        let (velocity, acceleration) = (
            &self.found.critical_velocity_change_m_per_s,
            &self.found.critical_acceleration_g,
        );
        let widths = self.found.points.iter().map(|point| point.pulse_ms);
        let [from_ms, to_ms] = widths.fold([f64::INFINITY, 0.0], |[from, to], width| {
            [width.min(from), width.max(to)]
        });
        let mut sentences = vec![format!(
            "Damage boundary ({} of {from_ms} to {to_ms} ms): the critical velocity change is {} m/s (found at {} ms), the critical acceleration \
             {} G (found at {} ms).",
            self.shape,
            ends(velocity.interval, 3),
            velocity.at_ms,
            ends(acceleration.interval, 1),
            acceleration.at_ms
        )];
        if !velocity.is_settled {
            sentences.push(format!(
                "The critical velocity change is not settled at {from_ms} ms; shorter pulses may have a lower one."
            ));
        }
        if !acceleration.is_settled {
            sentences.push(format!(
                "The critical acceleration is not settled at {to_ms} ms; longer pulses may have a lower one."
            ));
        }
        sentences
    }

    /// A line for each pulse width and sign.
    pub(in crate::report) fn table(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let header = [
            "pulse width (ms)",
            "sign",
            "critical shock (G)",
            "velocity change (m/s)",
            "lower end not known because",
        ];
        let rows = self.found.points.iter().map(|point| {
            vec![
                point.pulse_ms.to_string(),
                point.sign.as_str().to_owned(),
                ends(point.amplitude_g, 1),
                ends(point.velocity_change_m_per_s, 3),
                point
                    .open
                    .map_or(String::new(), |open| open.words().to_owned()),
            ]
        });
        (header.map(String::from).to_vec(), rows.collect())
    }

    /// Amplitude against velocity change, a curve for each sign, with the lower ends of both critical values as lines.
    pub(in crate::report) fn figure(&self) -> Figure {
        let signs = [Sign::Plus, Sign::Minus].into_iter().zip(colour::CYCLE);
        let series = signs.filter_map(|(sign, colour)| {
            let points = self.found.points.iter().filter(|one| one.sign == sign);
            let samples: Vec<Sample> = points.filter_map(sample).collect();
            let marker = (Marker::Circle, Fill::Full);
            let name = format!("sign {}", sign.as_str());
            (!samples.is_empty())
                .then(|| Series::marked(&name, colour, Some(Dash::Solid), marker, samples))
        });
        let rules = [
            Rule::Vertical {
                x: self.found.critical_velocity_change_m_per_s.interval[0],
                label: "critical velocity change, lower end".into(),
            },
            Rule::Horizontal {
                y: self.found.critical_acceleration_g.interval[0],
                label: "critical acceleration, lower end".into(),
            },
        ];
        let is_known = |rule: &Rule| match rule {
            Rule::Vertical { x: value, .. } | Rule::Horizontal { y: value, .. } => *value > 0.0,
        };
        Figure {
            title: "Damage boundary".into(),
            subtitle: format!(
                "{}; a point is a pulse width; bars: uncertainty interval",
                self.shape
            ),
            columns: 1,
            panel_px: (620.0, 380.0),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::log("Velocity change (m/s)"),
                y: Axis::log("Amplitude (G)"),
                series: series.collect(),
                rules: rules.into_iter().filter(is_known).collect(),
                shaded: None,
            }],
        }
    }

    /// A line for each pulse width and sign.
    pub(super) fn csv(&self) -> String {
        let header = [
            "pulse_ms",
            "sign",
            "low_g",
            "high_g",
            "low_m_per_s",
            "high_m_per_s",
        ];
        let mut text = csv_line(&header.map(String::from));
        let number = |value: f64| match value.is_finite() {
            true => value.to_string(),
            false => String::new(),
        };
        for point in &self.found.points {
            let mut row = vec![point.pulse_ms.to_string(), point.sign.as_str().to_owned()];
            row.extend(point.amplitude_g.map(number));
            row.extend(point.velocity_change_m_per_s.map(number));
            text.push_str(&csv_line(&row));
        }
        text
    }
}

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Of a point of which something is known.
fn sample(point: &BoundaryPoint) -> Option<Sample> {
    let [low, high] = point.amplitude_g;
    let velocity = point.velocity_change_m_per_s;
    let (x, value) = match (low > 0.0, high.is_finite()) {
        (true, true) => {
            let y = middle(point.amplitude_g);
            (middle(velocity), Value::Known { y, low, high })
        }
        (false, true) => (velocity[1], Value::Below(high)),
        (true, false) => (velocity[0], Value::Above(low)),
        (false, false) => return None,
    };
    Some(Sample {
        x,
        value,
        open: false,
        note: format!(
            "{} ms: {} G, {} m/s",
            point.pulse_ms,
            ends(point.amplitude_g, 1),
            ends(velocity, 3)
        ),
    })
}

/// `210.1 +- 3.2`, or the bound that is known.
fn ends([low, high]: [f64; 2], digits: usize) -> String {
    match (low > 0.0, high.is_finite()) {
        (true, true) => {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            format!("{middle:.digits$} +- {half:.digits$}")
        }
        (true, false) => format!("more than {low:.digits$}"),
        (false, true) => format!("at most {high:.digits$}"),
        (false, false) => "unknown".to_owned(),
    }
}
