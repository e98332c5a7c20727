//! Shock response spectrum: the largest absolute acceleration of damped oscillators whose base moves as the record says.
//!
//! ```text
//! w'' + 2ζω w' + ω² w = a(t),   absolute acceleration = ω² w + 2ζω w',   ζ = 1/(2Q)
//! ```
//!
//! w is the deflection against the base, with its sign turned. The record is linear between its samples; the response to
//! that is exact ([`opshock_solver::modal::forcing`]), as it is in the ramp-invariant filter of Smallwood (An Improved
//! Recursive Formula for Calculating Shock Response Spectra, Shock and Vibration Bulletin 51, 1981). That filter has its
//! values at the samples; here they are at least [`STEPS_PER_PERIOD`] a natural period, with a parabola through the
//! highest, and the motion after the record is followed for a period.

use super::measures::Record;
use nalgebra::Complex;
use opshock_solver::modal::Oscillator;
use opshock_solver::modal::forcing::{ForcedResponse, Phase};
use std::f64::consts::TAU;

/// Values of the response in a natural period.
const STEPS_PER_PERIOD: f64 = 64.0;

/// Response of one oscillator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Largest magnitude during the record, m/s².
    pub primary_m_per_s2: f64,
    /// Largest magnitude after the record, m/s².
    pub residual_m_per_s2: f64,
}

impl Response {
    /// Largest magnitude at any time, m/s².
    pub fn maximax_m_per_s2(&self) -> f64 {
        self.primary_m_per_s2.max(self.residual_m_per_s2)
    }
}

/// Natural frequencies, twelve an octave, Hz.
pub fn octave_frequencies_hz(from_hz: f64, to_hz: f64) -> Vec<f64> {
    let count = (12.0 * (to_hz / from_hz).log2()).floor().max(0.0) as usize;
    (0..=count)
        .map(|k| from_hz * (k as f64 / 12.0).exp2())
        .collect()
}

/// The spectrum at these natural frequencies; `q` is the quality factor, infinite without damping.
pub fn shock_response_spectrum(record: &Record, frequencies_hz: &[f64], q: f64) -> Vec<Response> {
    let damping_ratio = 0.5 / q;
    frequencies_hz
        .iter()
        .map(|&frequency_hz| response(record, frequency_hz, damping_ratio))
        .collect()
}

/// Largest magnitude of values in passing, with parabolas through the last three.
#[derive(Default)]
struct Largest {
    last: [(f64, f64); 2],
    count: usize,
    magnitude: f64,
}

impl Largest {
    fn add(&mut self, time_s: f64, value: f64) {
        let [(t0, y0), (t1, y1)] = self.last;
        self.magnitude = self.magnitude.max(value.abs());
        if self.count > 1 && (y1 - y0) * (value - y1) < 0.0 {
            // Newton's form through the three, at its extremum.
            let first = (y1 - y0) / (t1 - t0);
            let second = ((value - y1) / (time_s - t1) - first) / (time_s - t0);
            let top_s = 0.5 * (t0 + t1 - first / second);
            let top = y0 + first * (top_s - t0) + second * (top_s - t0) * (top_s - t1);
            self.magnitude = self.magnitude.max(top.abs());
        }
        self.last = [(t1, y1), (time_s, value)];
        self.count += 1;
    }
}

fn response(record: &Record, frequency_hz: f64, damping_ratio: f64) -> Response {
    let omega = TAU * frequency_hz;
    let oscillator = Oscillator::fixed(omega, damping_ratio);
    let absolute = |q: f64, r: f64| omega * omega * q + 2.0 * damping_ratio * omega * r;
    let step_s = (STEPS_PER_PERIOD * frequency_hz).recip();
    let (mut w, mut v) = (0.0, 0.0);
    let mut largest = Largest::default();
    let mut kept = (0.0, oscillator.flow(0.0), ForcedResponse::default());
    let samples = record
        .time_s
        .windows(2)
        .zip(record.acceleration_m_per_s2.windows(2));
    for (times, values) in samples {
        let length_s = times[1] - times[0];
        let count = (length_s / step_s).ceil().max(1.0);
        let h_s = length_s / count;
        if kept.0 != h_s {
            let forced = ForcedResponse::new(&oscillator, Complex::default(), h_s);
            kept = (h_s, oscillator.flow(h_s), forced);
        }
        let mut phase = Phase {
            constant: values[0],
            slope_per_s: (values[1] - values[0]) / length_s,
            ..Phase::default()
        };
        for k in 0..count as usize {
            let (free_w, free_v) = kept.1.apply(Complex::from(w), Complex::from(v));
            let (added_w, added_v) = kept.2.increments(&phase);
            (w, v) = (free_w.re + added_w, free_v.re + added_v);
            phase = phase.later(Complex::default(), h_s);
            largest.add(times[0] + (k + 1) as f64 * h_s, absolute(w, v));
        }
    }
    let mut after = Largest::default();
    after.add(0.0, absolute(w, v));
    let flow = oscillator.flow(step_s);
    for k in 1..=STEPS_PER_PERIOD as usize + 1 {
        let (free_w, free_v) = flow.apply(Complex::from(w), Complex::from(v));
        (w, v) = (free_w.re, free_v.re);
        after.add(k as f64 * step_s, absolute(w, v));
    }
    Response {
        frequency_hz,
        primary_m_per_s2: largest.magnitude,
        residual_m_per_s2: after.magnitude,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A half-sine of 1 m/s² and 1 ms in `n` intervals.
    fn half_sine(n: u32) -> Record {
        let share = |k: u32| f64::from(k) / f64::from(n);
        Record {
            time_s: (0..=n).map(|k| 1e-3 * share(k)).collect(),
            acceleration_m_per_s2: (0..=n).map(|k| (PI * share(k)).sin()).collect(),
        }
    }

    /// Undamped, with β = ω₀/ω = 1/(2 f T): during the pulse a = (sin ω₀t − β sin ωt)/(1 − β²), whose largest value is at
    /// t = 2π/(ω + ω₀) when that is within it (f T > ½) and, for faster oscillators, at the multiple of it that is
    /// largest; afterwards the amplitude is 2β cos(π/2β)/(1 − β²) (Clough and Penzien, Dynamics of Structures, ch. 5).
    #[test]
    fn an_undamped_half_sine_has_its_closed_form() {
        let record = half_sine(20_000);
        for f_t in [0.1, 0.3, 0.45, 0.7, 0.8, 1.0, 1.7, 3.2, 10.0] {
            let frequency_hz = f_t / 1e-3;
            let found = response(&record, frequency_hz, 0.0);
            let beta = 0.5 / f_t;
            let during = |share: f64| {
                ((PI * share).sin() - beta * (TAU * f_t * share).sin()) / (1.0 - beta * beta)
            };
            // Extrema where cos ω₀t = cos ωt: ωt = 2πn ± ω₀t; or the end of the pulse.
            let mut primary = during(1.0).abs();
            for n in 1..40 {
                for sign in [1.0, -1.0] {
                    let share = f64::from(n) / (f_t + sign * 0.5);
                    if (0.0..=1.0).contains(&share) {
                        primary = primary.max(during(share).abs());
                    }
                }
            }
            let residual = (2.0 * beta * (0.5 * PI / beta).cos() / (1.0 - beta * beta)).abs();
            assert!(
                (found.primary_m_per_s2 - primary).abs() < 1e-5,
                "fT {f_t}: {found:?} {primary}"
            );
            assert!(
                (found.residual_m_per_s2 - residual).abs() < 1e-5,
                "fT {f_t}: {found:?} {residual}"
            );
        }
        // A static limit: a fast oscillator follows the base.
        let stiff = response(&record, 300e3, 0.05);
        assert!((stiff.maximax_m_per_s2() - 1.0).abs() < 1e-4, "{stiff:?}");
    }

    /// Against the classical Runge-Kutta method with 4000 steps a period, on a record with uneven times.
    #[test]
    fn a_damped_oscillator_agrees_with_a_fine_integration() {
        let record = Record {
            time_s: vec![0.0, 0.2e-3, 0.5e-3, 0.9e-3, 1.4e-3],
            acceleration_m_per_s2: vec![0.0, 50.0, 120.0, -30.0, 10.0],
        };
        for (frequency_hz, q) in [(200.0, 10.0), (800.0, 10.0), (2500.0, 25.0), (900.0, 0.8)] {
            let (omega, zeta) = (TAU * frequency_hz, 0.5 / q);
            let rate = |t: f64, w: f64, v: f64| {
                (v, record.at(t) - 2.0 * zeta * omega * v - omega * omega * w)
            };
            // A step divides 0.1 ms, so that no corner of the record lies within a step.
            let steps_per_tenth = (4000.0 * frequency_hz * 1e-4_f64).ceil();
            let h = 1e-4 / steps_per_tenth;
            let (mut w, mut v) = (0.0, 0.0);
            let mut largest = 0.0_f64;
            let end = ((1.4e-3 + 1.5 / frequency_hz) / h).ceil() as usize;
            for k in 0..end {
                let t = k as f64 * h;
                // The record is 0 after its end; its last value belongs to the step before.
                let rate = |t: f64, w: f64, v: f64| match k as f64 * h > 1.4e-3 - 0.5 * h {
                    true => (v, -2.0 * zeta * omega * v - omega * omega * w),
                    false => rate(t.min(1.4e-3), w, v),
                };
                let (a1, b1) = rate(t, w, v);
                let (a2, b2) = rate(t + 0.5 * h, w + 0.5 * h * a1, v + 0.5 * h * b1);
                let (a3, b3) = rate(t + 0.5 * h, w + 0.5 * h * a2, v + 0.5 * h * b2);
                let (a4, b4) = rate(t + h, w + h * a3, v + h * b3);
                w += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
                v += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
                largest = largest.max((omega * omega * w + 2.0 * zeta * omega * v).abs());
            }
            let [found] = shock_response_spectrum(&record, &[frequency_hz], q)[..] else {
                panic!("one frequency");
            };
            let found = found.maximax_m_per_s2();
            assert!(
                (found / largest - 1.0).abs() < 2e-5,
                "{frequency_hz} Hz, Q {q}: {found} {largest}"
            );
        }
    }
}
