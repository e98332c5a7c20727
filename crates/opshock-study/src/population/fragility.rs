//! Fragility: the share of drives that fail by an amplitude, from the drives whose critical shocks are bracketed, and the
//! log-normal distribution fitted to them.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, Normal};

use super::level::{FARTHEST, STEPS_PER_OCTAVE, amplitude_g};
use crate::draws::Share;

/// Share of drives that fail at or below an amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The amplitude, G.
    pub amplitude_g: f64,
    /// The share, with its exact interval at this amplitude.
    pub fails: Share,
}

/// Log-normal distribution of the critical shock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LogNormal {
    /// Median, G.
    pub median_g: f64,
    /// Standard deviation of the natural logarithm.
    pub log_sd: f64,
}

impl LogNormal {
    /// Share that fails at or below an amplitude.
    pub fn fails(&self, amplitude_g: f64) -> f64 {
        let score = (amplitude_g / self.median_g).ln() / self.log_sd;
        Normal::standard().cdf(score)
    }
}

/// Fragility curve of a pulse width.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fragility {
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// The curve, from the highest amplitude at which none fails to the lowest at which all do.
    pub steps: Vec<Step>,
    /// The fit; `None` where some drives fail at no amplitude simulated, or at all, or all alike.
    pub fit: Option<LogNormal>,
}

impl Fragility {
    /// Of drives by the step of their lowest failure (`None`: above the farthest) and whether a lower step survives.
    pub fn of(pulse_ms: f64, required_g: f64, lowest: &[(Option<i32>, bool)]) -> Fragility {
        let n = lowest.len() as u64;
        let failing = |step: i32| {
            let fails = lowest
                .iter()
                .filter(|(failure, _)| failure.is_some_and(|failure| failure <= step));
            fails.count() as u64
        };
        let first = (-FARTHEST..FARTHEST).rev().find(|&step| failing(step) == 0);
        let last = (-FARTHEST..=FARTHEST).find(|&step| failing(step) == n);
        let steps = first.unwrap_or(-FARTHEST)..=last.unwrap_or(FARTHEST);
        let step = |step: i32| Step {
            amplitude_g: amplitude_g(required_g, step),
            fails: Share::of(failing(step), n),
        };
        Fragility {
            pulse_ms,
            steps: steps.map(step).collect(),
            fit: fit(required_g, lowest),
        }
    }
}

/// By mean and variance of the logarithms of the brackets' middles, the variance less that of a bracket (Sheppard 1898,
/// Proc. London Math. Soc. 29, 353).
fn fit(required_g: f64, lowest: &[(Option<i32>, bool)]) -> Option<LogNormal> {
    let wide = std::f64::consts::LN_2 / f64::from(STEPS_PER_OCTAVE);
    let middles: Option<Vec<f64>> = lowest
        .iter()
        .map(|&(failure, is_bracketed)| {
            let failure = failure.filter(|_| is_bracketed)?;
            Some(amplitude_g(required_g, failure).ln() - 0.5 * wide)
        })
        .collect();
    let middles = middles.filter(|middles| middles.len() > 1)?;
    let n = middles.len() as f64;
    let mean = middles.iter().sum::<f64>() / n;
    let squares = middles.iter().map(|middle| (middle - mean).powi(2));
    let variance = squares.sum::<f64>() / (n - 1.0) - wide * wide / 12.0;
    (variance > 0.0).then(|| LogNormal {
        median_g: mean.exp(),
        log_sd: variance.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::draw;

    #[test]
    fn the_fit_of_log_normal_drives_gives_their_parameters_back() {
        let normal = Normal::standard();
        let (median_g, log_sd) = (520.0_f64, 0.2);
        let drives: Vec<(Option<i32>, bool)> = (0..4000)
            .map(|index| {
                let score = normal.inverse_cdf(draw(9, index, 1)[0]);
                let octaves = ((median_g / 400.0).ln() + log_sd * score) / std::f64::consts::LN_2;
                (Some((8.0 * octaves).ceil() as i32), true)
            })
            .collect();
        let curve = Fragility::of(2.0, 400.0, &drives);
        let fit = curve.fit.expect("a fit");
        // Five standard errors of median and deviation.
        assert!((fit.median_g / median_g - 1.0).abs() < 5.0 * log_sd / 4000_f64.sqrt());
        assert!((fit.log_sd / log_sd - 1.0).abs() < 5.0 / 8000_f64.sqrt());
        let inside = curve.steps.iter().filter(|step| {
            let exact = normal.cdf((step.amplitude_g / median_g).ln() / log_sd);
            let [low, high] = step.fails.interval;
            (low..=high).contains(&exact)
        });
        assert!(inside.count() + 2 >= curve.steps.len(), "{curve:?}");
        let ends = [curve.steps[0], curve.steps[curve.steps.len() - 1]];
        assert_eq!(ends.map(|step| step.fails.with), [0, 4000]);
    }

    #[test]
    fn drives_beyond_the_farthest_amplitude_give_no_fit() {
        let curve = Fragility::of(1.0, 100.0, &[(Some(2), true), (None, true)]);
        assert_eq!(curve.fit, None);
        assert_eq!(curve.steps.last().map(|step| step.amplitude_g), Some(400.0));
        assert_eq!(Fragility::of(1.0, 100.0, &[(Some(2), true); 5]).fit, None);
    }
}
