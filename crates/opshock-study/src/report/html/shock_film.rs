//! The animation of one shock: disk, ramp and slider over time, from a kept history.

use crate::store::history::StoredHistory;
use serde::Serialize;

/// Frames of the animation: one for every 15 us of a 5 ms window.
const FRAMES: usize = 360;

/// What the animation shows. Lists are frames; displacements are relative to the base.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShockFilm {
    /// `deformable ramp, 192.1 G, 0.5 ms, sign +: fails`.
    pub label: String,
    /// Time, ms.
    pub time_ms: Vec<f64>,
    /// Disk under the slider, um.
    pub slider_um: Vec<f64>,
    /// Disk at the ramp, um.
    pub ramp_um: Vec<f64>,
    /// Top arm, um.
    pub top_um: Vec<f64>,
    /// Bottom arm, um.
    pub bottom_um: Vec<f64>,
    /// Force of the top arm less that of the bottom arm, N.
    pub force_n: Vec<f64>,
    /// Smallest clearance, nm; null once the slider has touched.
    pub clearance_nm: Vec<Option<f64>>,
    /// Inner radius, place of slider and of ramp, outer radius, mm.
    pub radii_mm: [f64; 4],
    /// Clearance of the arms at rest, um.
    pub gap_um: f64,
}

impl ShockFilm {
    /// The animation of a kept history, of a study with every default written out; `None` when a column
    /// or a key is missing, as in a history without the disk.
    pub fn of(history: &StoredHistory, resolved_study: &str) -> Option<ShockFilm> {
        let study: toml::Table = resolved_study.parse().ok()?;
        let number = |table: &str, key: &str| {
            let value = study.get(table)?.get(key)?;
            value
                .as_float()
                .or_else(|| value.as_integer().map(|n| n as f64))
        };
        let column = |name: &str| history.columns.get(name).map(Vec::as_slice);
        let time = column("time_s")?;
        let step = time.len().div_ceil(FRAMES).max(1);
        let frames = |values: &[f64], scale: f64| -> Vec<f64> {
            let values = values.iter().step_by(step);
            values.map(|v| rounded(v * scale)).collect()
        };
        let microns = |name: &str| Some(frames(column(name)?, 1e6));
        let force: Vec<f64> = column("contact_top_n")?
            .iter()
            .zip(column("contact_bottom_n")?)
            .map(|(top, bottom)| top - bottom)
            .collect();
        // The peak of a frame's stretch: a contact lasts less than a frame.
        let force_n = force
            .chunks(step)
            .map(|span| {
                let peak = span.iter().copied();
                rounded(
                    peak.max_by(|a, b| a.abs().total_cmp(&b.abs()))
                        .unwrap_or(0.0),
                )
            })
            .collect();
        let at = |key: &str| history.point.get(key).cloned().unwrap_or_default();
        Some(ShockFilm {
            label: format!(
                "{}, {:.1} G, {} ms, sign {}: {}",
                match at("ramp").as_str() {
                    "none" => "no ramp".to_owned(),
                    ramp => format!("{ramp} ramp"),
                },
                history.amplitude_g,
                at("pulse_ms"),
                at("sign"),
                history.verdict
            ),
            time_ms: frames(time, 1e3),
            slider_um: microns("disk_slider_m")?,
            ramp_um: microns("disk_ramp_m")?,
            top_um: microns("ramp_top_m")?,
            bottom_um: microns("ramp_bottom_m")?,
            force_n,
            clearance_nm: frames(column("min_clearance_m")?, 1e9)
                .into_iter()
                .map(|h| h.is_finite().then_some(h))
                .collect(),
            radii_mm: [
                number("disk", "inner_radius_mm")?,
                number("slider", "radius_mm")?,
                number("ramp", "radius_mm")?,
                number("disk", "outer_radius_mm")?,
            ],
            gap_um: number("ramp", "clearance_um")
                .or_else(|| number("ramp", "clearance_top_um"))?,
        })
    }
}

/// Four digits after the point: a picture needs no more.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
