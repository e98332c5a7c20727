//! Divides the unit pulse into stretches with closed forms, and any time at their borders.

use crate::modal::Phase;
use crate::modal::oscillator::phi1;
use crate::shock::Stretch;
use nalgebra::Complex;

/// Stretches of a pulse, in order of time. All waves have one rate: a half-sine has one stretch, piecewise linear
/// shapes have no wave.
pub(super) struct Stretches(pub Vec<Stretch>);

/// A time within one stretch, or after the last.
pub(super) struct Piece {
    pub start_s: f64,
    pub h_s: f64,
    pub sigma_per_s: Complex<f64>,
    pub phase: Phase,
    pub driven: bool,
}

impl Piece {
    pub fn forcing(&self) -> Option<(Complex<f64>, &Phase)> {
        self.driven.then_some((self.sigma_per_s, &self.phase))
    }
}

impl Stretches {
    /// Borders of stretches, which are kinks of the pulse, s.
    pub fn kinks_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().map(|s| s.end_s)
    }

    /// ∫ s dt of the unit pulse until `end_s`.
    pub fn integral_s(&self, end_s: f64) -> f64 {
        let mut sum = 0.0;
        for stretch in &self.0 {
            let h = stretch.end_s.min(end_s) - stretch.start_s;
            if h > 0.0 {
                let phase = &stretch.phase;
                let wave = phase.wave * phi1(stretch.sigma_per_s * h) * h;
                sum += phase.constant * h + 0.5 * phase.slope_per_s * h * h + wave.re;
            }
        }
        sum
    }

    /// Rate and phase of the pulse when the step from `start_s` lies within one stretch.
    pub fn whole_step(&self, start_s: f64, step_s: f64) -> Option<(Complex<f64>, Phase)> {
        let i = self.0.partition_point(|s| s.end_s <= start_s);
        let stretch = self.0.get(i)?;
        (start_s + step_s <= stretch.end_s).then(|| {
            let phase = stretch
                .phase
                .later(stretch.sigma_per_s, start_s - stretch.start_s);
            (stretch.sigma_per_s, phase)
        })
    }

    /// Cuts [start, start + h] at the kinks of the pulse.
    pub fn pieces(&self, start_s: f64, h_s: f64, mut visit: impl FnMut(Piece)) {
        let end_s = start_s + h_s;
        let mut t = start_s;
        let first = self.0.partition_point(|s| s.end_s <= start_s);
        for stretch in &self.0[first..] {
            if t >= end_s {
                return;
            }
            let until = stretch.end_s.min(end_s);
            // A single piece keeps the exact length requested.
            let whole = t == start_s && until == end_s;
            visit(Piece {
                start_s: t,
                h_s: if whole { h_s } else { until - t },
                sigma_per_s: stretch.sigma_per_s,
                phase: stretch
                    .phase
                    .later(stretch.sigma_per_s, t - stretch.start_s),
                driven: true,
            });
            t = until;
        }
        if t < end_s {
            visit(Piece {
                start_s: t,
                h_s: if t == start_s { h_s } else { end_s - t },
                sigma_per_s: Complex::from(0.0),
                phase: Phase::default(),
                driven: false,
            });
        }
    }
}
