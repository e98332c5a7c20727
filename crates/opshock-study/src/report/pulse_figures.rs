//! Plots a measured pulse beside its record, the half-sine it is compared with, and its shock response spectrum.

use super::chart::{Axis, Dash, Figure, Panel, Series, colour};
use super::run_plots::NamedFigure;
use crate::record::{AMPLITUDE_TOLERANCE, HalfSine, Record, Response};
use crate::store::history::Column;
use crate::study::MeasuredPulse;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;

/// The pulse with its record, and its shock response spectrum at quality factor `q`. Relative accelerations count as G.
pub fn pulse_figures(
    pulse: &MeasuredPulse,
    nominal: &HalfSine,
    spectrum: &[Response],
    q: f64,
) -> Vec<NamedFigure> {
    vec![of_time(pulse, nominal), of_frequency(pulse, spectrum, q)]
}

fn g(m_per_s2: f64) -> f64 {
    m_per_s2 / STANDARD_GRAVITY_M_PER_S2
}

fn unit(pulse: &MeasuredPulse) -> &'static str {
    if pulse.has_unit { "G" } else { "relative" }
}

fn column(name: &'static str, units: &'static str, values: Vec<f64>) -> Column {
    Column {
        name,
        units,
        description: "",
        values,
    }
}

fn of_time(pulse: &MeasuredPulse, nominal: &HalfSine) -> NamedFigure {
    let used = &pulse.used;
    let margin_s = 0.5 * used.length_s();
    let (from_s, to_s) = (-margin_s, used.length_s() + margin_s);
    let shifted = Record {
        time_s: pulse.raw.time_s.iter().map(|t| t - pulse.onset_s).collect(),
        ..pulse.raw.clone()
    };
    let raw = shifted.between(from_s, to_s);
    let curve = |record: &Record| {
        let samples = record.time_s.iter().zip(&record.acceleration_m_per_s2);
        samples.map(|(t, a)| (1e3 * t, g(*a))).collect::<Vec<_>>()
    };
    let tolerance = AMPLITUDE_TOLERANCE * nominal.peak_m_per_s2.abs();
    let about = |time_s: f64, by: f64| g(nominal.at(time_s) + by * tolerance);
    let band = |by: f64| {
        let times = (0..=400).map(|k| from_s + (to_s - from_s) * f64::from(k) / 400.0);
        times.map(|t| (1e3 * t, about(t, by))).collect::<Vec<_>>()
    };
    let (grey, black) = (colour::GREY, colour::BLACK);
    let series = vec![
        Series::curve("record as read", grey, Dash::Solid, curve(&raw)),
        Series::curve("pulse", colour::BLUE, Dash::Solid, curve(used)),
        Series::curve("half-sine", black, Dash::Dashed, band(0.0)),
        Series::curve("± 20 % of its peak", black, Dash::Dotted, band(1.0)),
        Series::curve("± 20 % of its peak", black, Dash::Dotted, band(-1.0)),
    ];
    let at = |by: f64| used.time_s.iter().map(|t| about(*t, by)).collect();
    let in_g = used.acceleration_m_per_s2.iter().map(|a| g(*a)).collect();
    NamedFigure {
        name: "pulse",
        figure: Figure {
            title: "Measured pulse".into(),
            subtitle: pulse.file.clone(),
            columns: 1,
            panel_px: (720.0, 330.0),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::linear("Time from the onset (ms)").between(1e3 * from_s, 1e3 * to_s),
                y: Axis::linear(&format!("Acceleration ({})", unit(pulse))),
                series,
                rules: Vec::new(),
                shaded: Some((0.0, 1e3 * used.length_s())),
            }],
        },
        table: vec![
            column("time_s", "s", used.time_s.clone()),
            column("acceleration_g", "g", in_g),
            column("half_sine_g", "g", at(0.0)),
            column("lower_g", "g", at(-1.0)),
            column("upper_g", "g", at(1.0)),
        ],
    }
}

fn of_frequency(pulse: &MeasuredPulse, spectrum: &[Response], q: f64) -> NamedFigure {
    let values =
        |of: fn(&Response) -> f64| -> Vec<f64> { spectrum.iter().map(of).map(g).collect() };
    let frequencies: Vec<f64> = spectrum.iter().map(|r| r.frequency_hz).collect();
    let maximax = values(Response::maximax_m_per_s2);
    let primary = values(|r| r.primary_m_per_s2);
    let residual = values(|r| r.residual_m_per_s2);
    let curve = |name: &str, colour, dash, values: &[f64]| {
        let points = frequencies.iter().copied().zip(values.iter().copied());
        Series::curve(name, colour, dash, points.collect())
    };
    let series = vec![
        curve("largest", colour::BLACK, Dash::Solid, &maximax),
        curve("during the record", colour::BLUE, Dash::Dashed, &primary),
        curve("after it", colour::VERMILLION, Dash::Dotted, &residual),
    ];
    NamedFigure {
        name: "shock_response_spectrum",
        figure: Figure {
            title: "Shock response spectrum".into(),
            subtitle: format!("{}, absolute acceleration, Q = {q}", pulse.file),
            columns: 1,
            panel_px: (720.0, 330.0),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::log("Natural frequency (Hz)"),
                y: Axis::log(&format!("Acceleration ({})", unit(pulse))),
                series,
                rules: Vec::new(),
                shaded: None,
            }],
        },
        table: vec![
            column("frequency_hz", "Hz", frequencies.clone()),
            column("maximax_g", "g", maximax),
            column("primary_g", "g", primary),
            column("residual_g", "g", residual),
        ],
    }
}
