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
    /// Largest force of the asperities of a frame, mN; null where the head's run has ended, empty without rough surfaces.
    pub asperity_mn: Vec<Option<f64>>,
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
        let peaks = |values: &[f64], scale: f64| -> Vec<Option<f64>> {
            let peak = |span: &[f64]| {
                let known = span.iter().copied().filter(|value| !value.is_nan());
                let peak = known.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
                Some(rounded(scale * peak))
            };
            values.chunks(step).map(peak).collect()
        };
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
            force_n: peaks(&force, 1.0).into_iter().flatten().collect(),
            clearance_nm: frames(column("min_clearance_m")?, 1e9)
                .into_iter()
                .map(|h| h.is_finite().then_some(h))
                .collect(),
            asperity_mn: column("asperity_force_n").map_or(Vec::new(), |force| peaks(force, 1e3)),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A contact shorter than a frame shows in it; where the head's run has ended nothing is known.
    #[test]
    fn the_force_of_a_frame_is_its_peak() {
        let n = 2 * FRAMES;
        let mut history = StoredHistory::default();
        let mut column = |name: &str, value: &dyn Fn(usize) -> f64| {
            let values = (0..n).map(value).collect();
            history.columns.insert(name.to_owned(), values);
        };
        for name in [
            "disk_slider_m",
            "disk_ramp_m",
            "ramp_top_m",
            "ramp_bottom_m",
        ] {
            column(name, &|_| 1e-6);
        }
        column("contact_top_n", &|_| 0.0);
        column("time_s", &|k| 1e-6 * k as f64);
        column("contact_bottom_n", &|k| f64::from(u8::from(k == 3)));
        column("min_clearance_m", &|k| if k < 6 { 2e-9 } else { f64::NAN });
        let study = "[disk]\ninner_radius_mm = 10\nouter_radius_mm = 32.5\n[slider]\nradius_mm = 22\n[ramp]\nradius_mm = 32\nclearance_um = 80";
        let smooth = ShockFilm::of(&history, study).expect("every column");
        assert_eq!(smooth.force_n[..3], [0.0, -1.0, 0.0]);
        assert_eq!(smooth.clearance_nm[1..4], [Some(2.0), Some(2.0), None]);
        assert!(smooth.asperity_mn.is_empty());

        let bears = |k: usize| match k {
            0..=4 => 0.0,
            5 => 3e-3,
            _ => f64::NAN,
        };
        let bears = (0..n).map(bears).collect();
        history.columns.insert("asperity_force_n".into(), bears);
        let rough = ShockFilm::of(&history, study).expect("every column");
        assert_eq!(
            rough.asperity_mn[..4],
            [Some(0.0), Some(0.0), Some(3.0), None]
        );
    }
}
