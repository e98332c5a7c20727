//! Phaseless low-pass filters: channel frequency classes of SAE J211-1, and Butterworth filters by cut-off and order.
//!
//! A Butterworth filter of order n runs forwards and backwards, so that the phase cancels and the gain is squared:
//!
//! ```text
//! gain = 1 / (1 + (f/f₁)^2n),   digital: f → tan(π f/f_s), f₁ → tan(π f₁/f_s)
//! ```
//!
//! Two passes are at 1/√2 (−3 dB) at the cut-off `f_c = f₁ (√2 − 1)^(1/2n)`. SAE J211-1 (2014), appendix C, sets n = 2 and
//! f₁ = 2.0775 CFC, so that f_c = 1.667 CFC. Each pass is a chain of second-order sections by the bilinear transform with
//! the corner prewarped; for n = 2 these are the coefficients of the standard.
//!
//! Beyond its ends the record is continued by its first and last value until the filter has settled.

use std::f64::consts::{PI, SQRT_2};

/// Corner of one pass per channel frequency class, SAE J211-1, appendix C.
const CORNER_PER_CLASS: f64 = 2.0775;

/// Natural logarithm of what is left of a transient where the continuation ends: e⁻²³ = 1e-10.
const SETTLED: f64 = 23.0;

/// A phaseless low-pass filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Channel frequency class of SAE J211-1: 60, 180, 600 or 1000.
    Class(u32),
    /// Butterworth filter.
    Butterworth {
        /// Frequency at which both passes together give 1/√2, Hz.
        cutoff_hz: f64,
        /// Order of each pass.
        order: u32,
    },
}

/// Why a filter cannot be applied.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// The corner is at or above half the sampling rate.
    #[error(
        "the cut-off of {cutoff_hz:.1} Hz needs a sampling rate above {needed_hz:.0} Hz, the record has {rate_hz:.0} Hz"
    )]
    TooHigh {
        /// Cut-off of both passes, Hz.
        cutoff_hz: f64,
        /// Twice the corner of one pass, Hz.
        needed_hz: f64,
        /// Sampling rate, Hz.
        rate_hz: f64,
    },
    /// A period of the cut-off is longer than the record.
    #[error(
        "a period of the cut-off of {cutoff_hz:.1} Hz is longer than the record of {length_ms:.3} ms"
    )]
    TooLow {
        /// Cut-off of both passes, Hz.
        cutoff_hz: f64,
        /// Length of the record, ms.
        length_ms: f64,
    },
}

impl Filter {
    /// Order of each pass.
    pub fn order(&self) -> u32 {
        match self {
            Self::Class(_) => 2,
            Self::Butterworth { order, .. } => *order,
        }
    }

    /// Corner of one pass, at which it gives 1/√2, Hz.
    pub fn corner_hz(&self) -> f64 {
        match self {
            Self::Class(class) => CORNER_PER_CLASS * f64::from(*class),
            Self::Butterworth { cutoff_hz, .. } => cutoff_hz / self.cutoff_per_corner(),
        }
    }

    /// Frequency at which both passes together give 1/√2, Hz.
    pub fn cutoff_hz(&self) -> f64 {
        match self {
            Self::Class(_) => self.corner_hz() * self.cutoff_per_corner(),
            Self::Butterworth { cutoff_hz, .. } => *cutoff_hz,
        }
    }

    fn cutoff_per_corner(&self) -> f64 {
        (SQRT_2 - 1.0).powf(0.5 / f64::from(self.order()))
    }

    /// Damping coefficients 2 sin((2k + 1)π/2n) of the second-order sections.
    fn dampings(&self) -> impl Iterator<Item = f64> {
        let order = self.order();
        (0..order / 2).map(move |k| 2.0 * (f64::from(2 * k + 1) * PI / f64::from(2 * order)).sin())
    }

    /// Samples in which a transient of one pass decays.
    fn settling(&self, rate_hz: f64) -> usize {
        let slowest = self.dampings().fold(2.0_f64, f64::min);
        (SETTLED / (PI * self.corner_hz() * slowest) * rate_hz).ceil() as usize
    }
}

impl std::fmt::Display for Filter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Class(class) => write!(
                f,
                "SAE J211 CFC {class} (-3 dB at {:.0} Hz, two passes of order 2)",
                self.cutoff_hz()
            ),
            Self::Butterworth { cutoff_hz, order } => write!(
                f,
                "Butterworth, -3 dB at {cutoff_hz} Hz, two passes of order {order}"
            ),
        }
    }
}

/// One section: y = b₀x + b₁x₁ + b₂x₂ − a₁y₁ − a₂y₂.
#[derive(Clone, Copy, Debug)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// Of s² + q s + 1, with the corner at tan = `w`.
    fn second_order(w: f64, q: f64) -> Self {
        let scale = 1.0 + q * w + w * w;
        let gain = w * w / scale;
        Self {
            b: [gain, 2.0 * gain, gain],
            a: [2.0 * (w * w - 1.0) / scale, (1.0 - q * w + w * w) / scale],
        }
    }

    /// Of s + 1.
    fn first_order(w: f64) -> Self {
        let gain = w / (1.0 + w);
        Self {
            b: [gain, gain, 0.0],
            a: [(w - 1.0) / (1.0 + w), 0.0],
        }
    }

    /// Filters in place, from rest at the first value.
    fn run<'a>(&self, values: impl Iterator<Item = &'a mut f64>) {
        let mut past: Option<[f64; 4]> = None;
        for value in values {
            let x = *value;
            let [x1, x2, y1, y2] = past.unwrap_or([x; 4]);
            let y =
                self.b[0] * x + self.b[1] * x1 + self.b[2] * x2 - self.a[0] * y1 - self.a[1] * y2;
            past = Some([x, x1, y, y1]);
            *value = y;
        }
    }
}

/// Filters evenly spaced values forwards and backwards.
///
/// # Errors
/// A corner that the sampling rate cannot represent, a cut-off with less than a period in the record.
pub fn phaseless(values: &[f64], rate_hz: f64, filter: &Filter) -> Result<Vec<f64>, FilterError> {
    let (corner_hz, cutoff_hz) = (filter.corner_hz(), filter.cutoff_hz());
    if 2.0 * corner_hz >= rate_hz {
        return Err(FilterError::TooHigh {
            cutoff_hz,
            needed_hz: 2.0 * corner_hz,
            rate_hz,
        });
    }
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return Ok(Vec::new());
    };
    let length_s = (values.len() - 1) as f64 / rate_hz;
    if cutoff_hz * length_s < 1.0 {
        return Err(FilterError::TooLow {
            cutoff_hz,
            length_ms: 1e3 * length_s,
        });
    }
    let w = (PI * corner_hz / rate_hz).tan();
    let mut sections: Vec<Section> = filter
        .dampings()
        .map(|q| Section::second_order(w, q))
        .collect();
    if filter.order() % 2 == 1 {
        sections.push(Section::first_order(w));
    }
    let beyond = filter.settling(rate_hz);
    let mut out = vec![first; beyond];
    out.extend_from_slice(values);
    out.resize(out.len() + beyond, last);
    for section in &sections {
        section.run(out.iter_mut());
    }
    for section in &sections {
        section.run(out.iter_mut().rev());
    }
    Ok(out[beyond..beyond + values.len()].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const RATE_HZ: f64 = 20_000.0;

    /// Amplitude that the filter leaves of a unit sine, and the part of it that is out of phase.
    fn passed(filter: &Filter, frequency_hz: f64) -> (f64, f64) {
        let omega = TAU * frequency_hz / RATE_HZ;
        let values: Vec<f64> = (0..40_000).map(|k| (omega * f64::from(k)).sin()).collect();
        let out = phaseless(&values, RATE_HZ, filter).unwrap();
        // Whole periods in the middle: every frequency below divides 100 Hz or is a multiple of it.
        let (mut in_phase, mut out_of_phase) = (0.0, 0.0);
        for (k, value) in out.iter().enumerate().take(30_000).skip(10_000) {
            let (sine, cosine) = (omega * k as f64).sin_cos();
            in_phase += value * sine / 10_000.0;
            out_of_phase += value * cosine / 10_000.0;
        }
        (in_phase, out_of_phase)
    }

    #[test]
    fn both_passes_have_the_squared_gain_of_butterworth_and_no_phase() {
        let filters = [
            Filter::Class(60),
            Filter::Class(180),
            Filter::Class(1000),
            Filter::Butterworth {
                cutoff_hz: 300.0,
                order: 1,
            },
            Filter::Butterworth {
                cutoff_hz: 700.0,
                order: 3,
            },
            Filter::Butterworth {
                cutoff_hz: 500.0,
                order: 8,
            },
        ];
        for filter in filters {
            for frequency_hz in [50.0, 100.0, 200.0, 300.0, 700.0, 1600.0] {
                let warped = |hz: f64| (PI * hz / RATE_HZ).tan();
                let ratio = warped(frequency_hz) / warped(filter.corner_hz());
                let one_pass = (1.0 + ratio.powi(2 * filter.order() as i32)).sqrt().recip();
                let (gain, phase) = passed(&filter, frequency_hz);
                assert!(
                    (gain - one_pass * one_pass).abs() < 1e-8,
                    "{filter} {frequency_hz}: {gain}"
                );
                assert!(phase.abs() < 1e-8, "{filter} {frequency_hz}: {phase}");
            }
        }
    }

    /// SAE J211: a class of 60 has its −3 dB at 100 Hz, of 600 at 1000 Hz.
    #[test]
    fn classes_cut_off_where_the_standard_says() {
        for (class, cutoff_hz) in [(60, 100.0), (180, 300.0), (600, 1000.0), (1000, 1666.7)] {
            let found = Filter::Class(class).cutoff_hz();
            assert!((found - cutoff_hz).abs() < 1e-3 * cutoff_hz, "{found}");
        }
        // Two passes at 100 Hz: prewarping moves the digital one by less than 1e-4.
        let (gain, _) = passed(&Filter::Class(60), 100.0);
        assert!((gain - 0.5_f64.sqrt()).abs() < 2e-4, "{gain}");
        let butterworth = Filter::Butterworth {
            cutoff_hz: 200.0,
            order: 4,
        };
        let (gain, _) = passed(&butterworth, 200.0);
        assert!((gain - 0.5_f64.sqrt()).abs() < 1e-3, "{gain}");
    }

    #[test]
    fn a_constant_stays_and_what_cannot_be_filtered_is_refused() {
        let constant = vec![3.0; 1000];
        let out = phaseless(&constant, RATE_HZ, &Filter::Class(60)).unwrap();
        assert!(out.iter().all(|value| (value - 3.0).abs() < 1e-9));
        let too_high = phaseless(&constant, 4000.0, &Filter::Class(1000));
        assert!(matches!(too_high, Err(FilterError::TooHigh { .. })));
        let too_low = phaseless(&constant[..100], RATE_HZ, &Filter::Class(60));
        assert!(matches!(too_low, Err(FilterError::TooLow { .. })));
    }
}
