//! The modes that the shock drives, and their shapes at the points that are read.

use crate::modal::Oscillator;

/// Oscillators driven by the shock, modal mass 1 kg each.
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedModes {
    pub oscillators: Vec<Oscillator>,
    /// Generalised force per unit a(t), kg^½.
    pub participation: Vec<f64>,
}

/// Shapes of the forced modes at the points that are read, kg^-½ (slope: kg^-½/m).
#[derive(Clone, Debug, Default)]
pub(super) struct ForcedShapes {
    pub contact: Vec<f64>,
    pub rim: Vec<f64>,
    pub slider: Vec<f64>,
    pub slider_slope: Vec<f64>,
    pub top: Vec<f64>,
    pub bottom: Vec<f64>,
}

/// Number of points read, rounded up to whole registers.
pub(super) const POINTS: usize = 8;

impl ForcedShapes {
    /// Contact, slider, its slope, top, bottom and rim of every mode, and two zeros. A point without an entry gives
    /// zero (modes of the disk come first, then those of arms).
    pub fn by_mode(&self) -> Vec<[f64; POINTS]> {
        let rows = [
            &self.contact,
            &self.slider,
            &self.slider_slope,
            &self.top,
            &self.bottom,
            &self.rim,
        ];
        let entry = |j: usize, k: usize| rows.get(k).and_then(|row| row.get(j)).copied();
        let mode = |j: usize| std::array::from_fn(|k| entry(j, k).unwrap_or(0.0));
        let n = rows.iter().map(|row| row.len()).max().unwrap_or(0);
        (0..n).map(mode).collect()
    }
}
