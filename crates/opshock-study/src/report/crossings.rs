//! Finds the pulse widths at which the critical shocks of two ramp models change places.

use std::fmt::Write as _;

use super::html::text::escaped;
use crate::search::Sign;
use crate::store::AxisValue;
use crate::sweep::added_points::Crossed;
use serde::Serialize;

/// A crossing of two ramps' curves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossingRow {
    /// The lower one below the crossing, then the other.
    pub ramps: [String; 2],
    /// Sign of the shock.
    pub sign: Sign,
    /// Values of the further axes.
    pub axes: Vec<AxisValue>,
    /// Width of the pulse, ms, where straight lines between the answers meet.
    pub pulse_ms: f64,
    /// Widths between which the curves change places, ms.
    pub between_ms: [f64; 2],
    /// Critical shock there, G.
    pub a_g: f64,
}

impl CrossingRow {
    /// The row of a crossing.
    pub fn of(Crossed { below, crossing }: &Crossed<'_>) -> Self {
        Self {
            ramps: [below.0.ramp.clone(), below.1.ramp.clone()],
            sign: below.0.sign,
            axes: below.0.axes.clone(),
            pulse_ms: crossing.pulse_ms,
            between_ms: [crossing.between_ms.0, crossing.between_ms.1],
            a_g: crossing.answer_g,
        }
    }

    /// As a sentence.
    pub fn line(&self) -> String {
        let axes: String = self.axes.iter().map(|value| format!(", {value}")).collect();
        format!(
            "crossing: {} below {} up to {:.4} ms ({} to {} ms), sign {}{axes}, at {:.1} G",
            self.ramps[0],
            self.ramps[1],
            self.pulse_ms,
            self.between_ms[0],
            self.between_ms[1],
            self.sign.as_str(),
            self.a_g
        )
    }
}

/// The table of a report's page, under the names of the further `axes`.
pub(super) fn section(rows: &[CrossingRow], axes: &[String]) -> String {
    let mut text = String::from(
        "<p>Pulse widths at which two ramp models change places: up to there the first has the lower \
         critical shock, beyond it the second.</p>\n<div class=\"scroll\"><table><thead><tr>",
    );
    let columns = ["first", "second", "sign"].map(str::to_owned);
    let figures = ["width, ms", "between, ms", "critical shock, G"].map(str::to_owned);
    for name in columns.iter().chain(axes).chain(&figures) {
        let _ = write!(text, "<th scope=\"col\">{}</th>", escaped(name));
    }
    text.push_str("</tr></thead><tbody>\n");
    for row in rows {
        let mut cells = row.ramps.to_vec();
        cells.push(row.sign.as_str().to_owned());
        cells.extend(row.axes.iter().map(AxisValue::to_string));
        cells.push(format!("{:.4}", row.pulse_ms));
        cells.push(format!("{} to {}", row.between_ms[0], row.between_ms[1]));
        cells.push(format!("{:.1}", row.a_g));
        text.push_str("<tr>");
        for cell in cells {
            let _ = write!(text, "<td>{}</td>", escaped(&cell));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody></table></div>\n");
    text
}
