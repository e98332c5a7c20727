//! Peak, duration, velocity change and zero line of a measured acceleration.

/// An acceleration over time; linear between its samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Times, rising, s.
    pub time_s: Vec<f64>,
    /// Acceleration at each time, m/s².
    pub acceleration_m_per_s2: Vec<f64>,
}

/// A straight line over time: offset and drift of a transducer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Value at time 0, m/s².
    pub at_zero_m_per_s2: f64,
    /// Slope, m/s³.
    pub slope_m_per_s3: f64,
}

/// Distance of a sample from the even grid, in sampling intervals, up to which times count as evenly spaced: as much as
/// rounded decimals may be off.
const LARGEST_JITTER: f64 = 0.1;

impl Line {
    /// Value at a time, m/s².
    pub fn at(&self, time_s: f64) -> f64 {
        self.at_zero_m_per_s2 + self.slope_m_per_s3 * time_s
    }
}

impl Record {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Time from the first sample to the last, s.
    pub fn length_s(&self) -> f64 {
        match (self.time_s.first(), self.time_s.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Mean sampling rate, Hz.
    pub fn rate_hz(&self) -> f64 {
        (self.len() as f64 - 1.0) / self.length_s()
    }

    /// First sample whose time is off the even grid.
    pub fn uneven(&self) -> Option<usize> {
        let interval_s = self.rate_hz().recip();
        let first_s = self.time_s.first()?;
        let is_off = |(k, time_s): (usize, &f64)| {
            (time_s - first_s - k as f64 * interval_s).abs() > LARGEST_JITTER * interval_s
        };
        self.time_s.iter().enumerate().position(is_off)
    }

    /// Position of the largest magnitude.
    pub fn peak_at(&self) -> usize {
        let magnitude = |k: &usize| self.acceleration_m_per_s2[*k].abs();
        let at = (0..self.len()).max_by(|a, b| magnitude(a).total_cmp(&magnitude(b)));
        at.unwrap_or(0)
    }

    /// The acceleration of largest magnitude, with its sign, m/s².
    pub fn peak_m_per_s2(&self) -> f64 {
        self.acceleration_m_per_s2
            .get(self.peak_at())
            .copied()
            .unwrap_or(0.0)
    }

    /// Beginning and end of the time about the peak in which the acceleration stays above a share of it, s; linear
    /// between samples, cut at the ends of the record.
    pub fn above(&self, share: f64) -> (f64, f64) {
        let peak = self.peak_m_per_s2();
        let top = self.peak_at();
        // Towards the peak, whatever its sign.
        let level = |k: usize| self.acceleration_m_per_s2[k] / peak - share;
        let crossing = |low: usize, high: usize| {
            let part = level(low) / (level(low) - level(high));
            self.time_s[low] + part * (self.time_s[high] - self.time_s[low])
        };
        let before = (0..top).rev().find(|&k| level(k) < 0.0);
        let after = (top + 1..self.len()).find(|&k| level(k) < 0.0);
        let from_s = before.map_or(self.time_s[0], |k| crossing(k, k + 1));
        let to_s = after.map_or(self.time_s[self.len() - 1], |k| crossing(k, k - 1));
        (from_s, to_s)
    }

    /// The acceleration at a time, m/s²; 0 outside of the record.
    pub fn at(&self, time_s: f64) -> f64 {
        let (Some(first), Some(last)) = (self.time_s.first(), self.time_s.last()) else {
            return 0.0;
        };
        if !(*first..=*last).contains(&time_s) || self.len() < 2 {
            return 0.0;
        }
        let k = self.time_s.partition_point(|&t| t <= time_s);
        let k = k.clamp(1, self.len() - 1);
        let share = (time_s - self.time_s[k - 1]) / (self.time_s[k] - self.time_s[k - 1]);
        let [before, after] = [k - 1, k].map(|k| self.acceleration_m_per_s2[k]);
        before + share * (after - before)
    }

    /// Integral of the acceleration, m/s.
    pub fn velocity_change_m_per_s(&self) -> f64 {
        let (times, values) = (&self.time_s, &self.acceleration_m_per_s2);
        (1..self.len())
            .map(|k| 0.5 * (values[k] + values[k - 1]) * (times[k] - times[k - 1]))
            .sum()
    }

    /// The part between two times, these included, s; interpolated at its ends, cut at those of the record.
    pub fn between(&self, from_s: f64, to_s: f64) -> Self {
        let mut part = Self::default();
        let mut add = |time_s: f64, value: f64| {
            part.time_s.push(time_s);
            part.acceleration_m_per_s2.push(value);
        };
        let (Some(first), Some(last)) = (self.time_s.first(), self.time_s.last()) else {
            return part;
        };
        let (from_s, to_s) = (from_s.max(*first), to_s.min(*last));
        if from_s >= to_s {
            return part;
        }
        add(from_s, self.at(from_s));
        for (&time_s, &value) in self.time_s.iter().zip(&self.acceleration_m_per_s2) {
            if time_s > from_s && time_s < to_s {
                add(time_s, value);
            }
        }
        add(to_s, self.at(to_s));
        part
    }

    /// Mean over the samples chosen by their time, m/s²; `None` when there are none.
    pub fn mean(&self, is_chosen: impl Fn(f64) -> bool) -> Option<Line> {
        let chosen = self.chosen(is_chosen);
        let n = chosen.len() as f64;
        let mean = chosen.iter().map(|(_, value)| value).sum::<f64>() / n;
        (!chosen.is_empty()).then_some(Line {
            at_zero_m_per_s2: mean,
            slope_m_per_s3: 0.0,
        })
    }

    /// Straight line through the samples chosen by their time, by least squares; `None` below two samples.
    pub fn line(&self, is_chosen: impl Fn(f64) -> bool) -> Option<Line> {
        let chosen = self.chosen(is_chosen);
        if chosen.len() < 2 {
            return None;
        }
        let n = chosen.len() as f64;
        let mean_s = chosen.iter().map(|(time_s, _)| time_s).sum::<f64>() / n;
        let mean = chosen.iter().map(|(_, value)| value).sum::<f64>() / n;
        let (mut above, mut below) = (0.0, 0.0);
        for (time_s, value) in chosen {
            above += (time_s - mean_s) * (value - mean);
            below += (time_s - mean_s).powi(2);
        }
        let slope = above / below;
        Some(Line {
            at_zero_m_per_s2: mean - slope * mean_s,
            slope_m_per_s3: slope,
        })
    }

    fn chosen(&self, is_chosen: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
        let samples = self.time_s.iter().zip(&self.acceleration_m_per_s2);
        samples
            .filter(|(time_s, _)| is_chosen(**time_s))
            .map(|(time_s, value)| (*time_s, *value))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A half-sine of 100 m/s² and 2 ms after 1 ms of rest, in samples of 2 us.
    fn half_sine() -> Record {
        let time_s: Vec<f64> = (0..=2000).map(|k| 2e-6 * f64::from(k)).collect();
        let at = |t: &f64| match (1e-3..=3e-3).contains(t) {
            true => 100.0 * (PI * (t - 1e-3) / 2e-3).sin(),
            false => 0.0,
        };
        let acceleration_m_per_s2 = time_s.iter().map(at).collect();
        Record {
            time_s,
            acceleration_m_per_s2,
        }
    }

    #[test]
    fn a_half_sine_has_its_closed_forms() {
        let record = half_sine();
        assert!((record.peak_m_per_s2() - 100.0).abs() < 1e-9);
        // ∫ A sin(πt/D) = 2AD/π.
        let velocity = record.velocity_change_m_per_s();
        assert!((velocity - 2.0 * 100.0 * 2e-3 / PI).abs() < 1e-6 * velocity);
        // Above 10 %: D (1 − 2 asin(0.1)/π).
        let (from_s, to_s) = record.above(0.1);
        let exact_s = 2e-3 * (1.0 - 2.0 * 0.1_f64.asin() / PI);
        assert!((to_s - from_s - exact_s).abs() < 1e-9, "{}", to_s - from_s);
        // The same pulse the other way round lasts as long.
        let mut turned = record;
        turned
            .acceleration_m_per_s2
            .iter_mut()
            .for_each(|a| *a = -*a);
        assert_eq!(turned.above(0.1), (from_s, to_s));
        assert!(turned.peak_m_per_s2() < 0.0);
    }

    #[test]
    fn offset_and_drift_are_found_outside_of_the_pulse() {
        let mut record = half_sine();
        let drift = Line {
            at_zero_m_per_s2: 3.0,
            slope_m_per_s3: -500.0,
        };
        for (value, time_s) in record.acceleration_m_per_s2.iter_mut().zip(&record.time_s) {
            *value += drift.at(*time_s);
        }
        let found = record.line(|t| !(1e-3..=3e-3).contains(&t)).unwrap();
        assert!((found.at_zero_m_per_s2 - 3.0).abs() < 1e-9);
        assert!((found.slope_m_per_s3 + 500.0).abs() < 1e-6);
        // Mean of 3 − 500 t over 500 samples from 0 to 0.998 ms.
        let mean = record.mean(|t| t < 0.999e-3).unwrap();
        assert!((mean.at_zero_m_per_s2 - (3.0 - 500.0 * 0.499e-3)).abs() < 1e-9);
        assert_eq!(record.mean(|t| t < 0.0), None);
    }

    #[test]
    fn uneven_times_are_found() {
        let mut record = half_sine();
        assert_eq!(record.uneven(), None);
        record.time_s[7] += 1e-6;
        assert_eq!(record.uneven(), Some(7));
    }
}
