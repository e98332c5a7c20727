//! The half-sine nearest to a record, and whether the record lies within the tolerances of one.
//!
//! IEC 60068-2-27 (2008), figure of the half-sine pulse: about a nominal pulse of peak A and duration D the tolerances
//! are ±0.2 A at the peak and on the zero line before and after it. Here the band is that all along, nominal ± 0.2 A; the
//! figure's own boundaries beside rise and fall are not reproduced. The velocity change, integrated from 0.4 D before the
//! pulse to 0.1 D after it, must be within 15 % of the nominal one, 2AD/π.

use super::measures::Record;
use std::f64::consts::PI;

/// Tolerance of the acceleration as a share of the nominal peak.
pub const AMPLITUDE_TOLERANCE: f64 = 0.2;

/// Tolerance of the velocity change as a share of the nominal one.
pub const VELOCITY_TOLERANCE: f64 = 0.15;

/// A half-sine pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSine {
    /// Peak with its sign, m/s².
    pub peak_m_per_s2: f64,
    /// Duration, s.
    pub duration_s: f64,
    /// Its beginning, s.
    pub onset_s: f64,
}

/// A time in which a record is outside of the tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// First sample outside, s.
    pub from_s: f64,
    /// Last sample outside, s.
    pub to_s: f64,
    /// Largest distance from the nominal pulse in it, with its sign, as a share of the nominal peak.
    pub share: f64,
}

impl HalfSine {
    /// Acceleration at a time, m/s².
    pub fn at(&self, time_s: f64) -> f64 {
        let share = (time_s - self.onset_s) / self.duration_s;
        match (0.0..=1.0).contains(&share) {
            true => self.peak_m_per_s2 * (PI * share).sin(),
            false => 0.0,
        }
    }

    /// Velocity change, m/s.
    pub fn velocity_change_m_per_s(&self) -> f64 {
        2.0 * self.peak_m_per_s2 * self.duration_s / PI
    }

    /// The half-sine nearest to a record, by least squares.
    pub fn nearest(record: &Record) -> Self {
        let mut best = Self::start(record, None);
        let mut step = 0.1;
        while step > 1e-7 {
            let moved = |of_duration: f64, of_onset: f64| {
                let pulse = Self {
                    duration_s: best.duration_s * (1.0 + of_duration),
                    onset_s: best.onset_s + of_onset * best.duration_s,
                    ..best
                };
                pulse.with_nearest_peak(record)
            };
            let tried = [
                (step, 0.0),
                (-step, 0.0),
                (0.0, step),
                (0.0, -step),
                (step, -0.5 * step),
                (-step, 0.5 * step),
            ];
            let tried = tried.map(|(duration, onset)| moved(duration, onset));
            step = better(record, &mut best, &tried, step);
        }
        best
    }

    /// A half-sine of this peak and duration, its beginning set by least squares. The peak takes the record's sign.
    pub fn aligned(record: &Record, peak_m_per_s2: f64, duration_s: f64) -> Self {
        let mut best = Self::start(record, Some(duration_s));
        best.peak_m_per_s2 = peak_m_per_s2.abs().copysign(record.peak_m_per_s2());
        let mut step = 0.1;
        while step > 1e-7 {
            let tried = [step, -step].map(|share| Self {
                onset_s: best.onset_s + share * duration_s,
                ..best
            });
            step = better(record, &mut best, &tried, step);
        }
        best
    }

    /// About the middle of the record's time above 10 % of its peak.
    fn start(record: &Record, duration_s: Option<f64>) -> Self {
        let (from_s, to_s) = record.above(0.1);
        // A half-sine is above 10 % for 0.936 of its duration.
        let duration_s = duration_s.unwrap_or((to_s - from_s) / 0.936);
        let pulse = Self {
            peak_m_per_s2: record.peak_m_per_s2(),
            duration_s,
            onset_s: 0.5 * (from_s + to_s - duration_s),
        };
        pulse.with_nearest_peak(record)
    }

    fn with_nearest_peak(mut self, record: &Record) -> Self {
        self.peak_m_per_s2 = 1.0;
        let (mut above, mut below) = (0.0, 0.0);
        for (time_s, value, weight_s) in weighted(record) {
            let unit = self.at(time_s);
            above += weight_s * unit * value;
            below += weight_s * unit * unit;
        }
        self.peak_m_per_s2 = if below > 0.0 { above / below } else { 0.0 };
        self
    }

    fn squared_distance(&self, record: &Record) -> f64 {
        weighted(record)
            .map(|(time_s, value, weight_s)| weight_s * (value - self.at(time_s)).powi(2))
            .sum()
    }

    /// Times at which a record is outside of the band about this pulse, in order.
    pub fn outside(&self, record: &Record) -> Vec<Outside> {
        let mut found: Vec<Outside> = Vec::new();
        let mut was_outside = false;
        for (&time_s, &value) in record.time_s.iter().zip(&record.acceleration_m_per_s2) {
            let share = (value - self.at(time_s)) / self.peak_m_per_s2.abs();
            let is_outside = share.abs() > AMPLITUDE_TOLERANCE;
            match found.last_mut() {
                Some(last) if is_outside && was_outside => {
                    last.to_s = time_s;
                    if share.abs() > last.share.abs() {
                        last.share = share;
                    }
                }
                _ if is_outside => found.push(Outside {
                    from_s: time_s,
                    to_s: time_s,
                    share,
                }),
                _ => {}
            }
            was_outside = is_outside;
        }
        found
    }

    /// Velocity change of a record, from 0.4 D before this pulse to 0.1 D after it, by that of this pulse.
    pub fn velocity_ratio(&self, record: &Record) -> f64 {
        let from_s = self.onset_s - 0.4 * self.duration_s;
        let part = record.between(from_s, self.onset_s + 1.1 * self.duration_s);
        part.velocity_change_m_per_s() / self.velocity_change_m_per_s()
    }
}

/// Takes the nearest of those tried; a shorter step when none is nearer.
fn better(record: &Record, best: &mut HalfSine, tried: &[HalfSine], step: f64) -> f64 {
    let before = best.squared_distance(record);
    let distance = |pulse: &HalfSine| pulse.squared_distance(record);
    let nearest = tried
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest {
        Some(nearest) if distance(nearest) < before => {
            *best = *nearest;
            step
        }
        _ => 0.5 * step,
    }
}

/// Samples with the time that each stands for.
fn weighted(record: &Record) -> impl Iterator<Item = (f64, f64, f64)> {
    let times = &record.time_s;
    (0..record.len()).map(move |k| {
        let before = times[k.saturating_sub(1)];
        let after = times[(k + 1).min(times.len() - 1)];
        (
            times[k],
            record.acceleration_m_per_s2[k],
            0.5 * (after - before),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 150 G and 2 ms, from 1 ms on, with a sine of 10 % of it laid over.
    fn record(ripple: f64) -> (HalfSine, Record) {
        let pulse = HalfSine {
            peak_m_per_s2: -1500.0,
            duration_s: 2e-3,
            onset_s: 1e-3,
        };
        let time_s: Vec<f64> = (0..=400).map(|k| 1e-5 * f64::from(k)).collect();
        let value = |t: &f64| pulse.at(*t) + ripple * 1500.0 * (t * 2.0 * PI * 9e3).sin();
        let acceleration_m_per_s2 = time_s.iter().map(value).collect();
        (
            pulse,
            Record {
                time_s,
                acceleration_m_per_s2,
            },
        )
    }

    #[test]
    fn a_half_sine_is_found_again() {
        let (pulse, record) = record(0.0);
        let found = HalfSine::nearest(&record);
        assert!(
            (found.peak_m_per_s2 - pulse.peak_m_per_s2).abs() < 0.1,
            "{found:?}"
        );
        assert!(
            (found.duration_s - pulse.duration_s).abs() < 1e-7,
            "{found:?}"
        );
        assert!((found.onset_s - pulse.onset_s).abs() < 1e-7, "{found:?}");
        assert!(found.outside(&record).is_empty());
        assert!((found.velocity_ratio(&record) - 1.0).abs() < 1e-3);
        let aligned = HalfSine::aligned(&record, 1500.0, 2e-3);
        assert!(
            (aligned.onset_s - pulse.onset_s).abs() < 1e-7,
            "{aligned:?}"
        );
    }

    #[test]
    fn the_band_is_a_fifth_of_the_peak() {
        let (pulse, within) = record(0.19);
        assert!(pulse.outside(&within).is_empty());
        let (_, beyond) = record(0.21);
        let outside = pulse.outside(&beyond);
        let worst = outside.iter().map(|o| o.share.abs()).fold(0.0, f64::max);
        assert!((worst - 0.21).abs() < 2e-3, "{worst}");
        // 1.18 of the peak is within the band; its velocity change, 18 % too large, is not.
        let (_, mut large) = record(0.0);
        large
            .acceleration_m_per_s2
            .iter_mut()
            .for_each(|a| *a *= 1.18);
        assert!(pulse.outside(&large).is_empty());
        let ratio = pulse.velocity_ratio(&large);
        assert!((ratio - 1.18).abs() < 1e-3 && (ratio - 1.0).abs() > VELOCITY_TOLERANCE);
    }
}
