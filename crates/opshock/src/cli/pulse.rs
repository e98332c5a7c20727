//! `opshock pulse`: prints and plots what a study makes of a measured pulse.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::{mode_shapes, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, s_from_ms};
use opshock_study::record::{
    AMPLITUDE_TOLERANCE, HalfSine, VELOCITY_TOLERANCE, octave_frequencies_hz,
    shock_response_spectrum,
};
use opshock_study::report::{pulse_figures, write_figures};
use opshock_study::study::measured_pulse::WIDTH_ABOVE;
use opshock_study::study::{MeasuredPulse, Study, StudyError, StudyErrors};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Lowest natural frequency of the shock response spectrum, Hz.
const LOWEST_HZ: f64 = 10.0;

/// Sampling rate by the highest natural frequency of the spectrum.
const SAMPLES_PER_PERIOD: f64 = 5.0;

/// Print what a study makes of a measured pulse: peak, width, velocity change, tolerances of a half-sine
#[derive(Args, Debug)]
pub struct PulseArgs {
    /// Study file
    study: PathBuf,
    /// Peak of the half-sine to compare with, G; without it the nearest one
    #[arg(long, value_name = "G", requires = "half_sine_ms")]
    half_sine_g: Option<f64>,
    /// Its duration, ms
    #[arg(long, value_name = "MS", requires = "half_sine_g")]
    half_sine_ms: Option<f64>,
    /// Quality factor of the shock response spectrum
    #[arg(long, value_name = "Q", default_value_t = 10.0)]
    q: f64,
    /// Write pulse and shock response spectrum into a folder as SVG, PNG and CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &PulseArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let above_zero = [
        ("--half-sine-g", arguments.half_sine_g),
        ("--half-sine-ms", arguments.half_sine_ms),
        ("--q", Some(arguments.q)),
    ];
    for (option, value) in above_zero {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return Err(Failure::Usage(vec![Fault {
                key: Some(option.into()),
                value: Some(value.to_string()),
                allowed: Some("a finite number > 0".into()),
                ..Fault::new("usage", format!("{option} is out of range"))
            }]));
        }
    }
    let folder = arguments.out.as_deref();
    folder.map_or(Ok(()), |folder| mode_shapes::check_folder("--out", folder))?;
    let study = study_file::read(&arguments.study, global, console)?;
    let Some(pulse) = &study.measured else {
        let file = study.path.display().to_string();
        let fault = StudyError::in_file("E112", &file, "the study has no pulse from a file")
            .allowed("a study with pulse.table");
        return Err(StudyErrors::new(vec![fault]).into());
    };
    let asked = arguments.half_sine_g.zip(arguments.half_sine_ms);
    let nominal = match asked {
        Some((g, ms)) => {
            HalfSine::aligned(&pulse.used, g * STANDARD_GRAVITY_M_PER_S2, s_from_ms(ms))
        }
        None => HalfSine::nearest(&pulse.used),
    };
    if let Some(folder) = folder {
        let highest_hz = pulse.raw.rate_hz() / SAMPLES_PER_PERIOD;
        let frequencies_hz = octave_frequencies_hz(LOWEST_HZ.min(highest_hz), highest_hz);
        let spectrum = shock_response_spectrum(&pulse.used, &frequencies_hz, arguments.q);
        let figures = pulse_figures(pulse, &nominal, &spectrum, arguments.q);
        let written = write_figures(folder, &figures).context("no plots of the pulse")?;
        console.note(&format!(
            "wrote {} files into {}",
            written.len(),
            folder.display()
        ));
    }
    if console.json {
        console.result_json(&as_json(&study, pulse, &nominal))?;
    } else {
        console.result(&as_text(&study, pulse, &nominal, asked.is_some()))?;
    }
    Ok(Exit::Complete)
}

fn in_g(m_per_s2: f64) -> f64 {
    m_per_s2 / STANDARD_GRAVITY_M_PER_S2
}

fn as_text(study: &Study, pulse: &MeasuredPulse, nominal: &HalfSine, is_asked: bool) -> String {
    let (raw, used) = (&pulse.raw, &pulse.used);
    let unit = if pulse.has_unit { "G" } else { "(relative)" };
    let ms = |time_s: f64| format!("{:.4}", 1e3 * time_s);
    let mut text = String::new();
    let mut row = |name: &str, what: String| {
        let _ = writeln!(text, "{name:<12}{what}");
    };
    let first_s = raw.time_s[0];
    row("file", pulse.file.clone());
    row(
        "record",
        format!(
            "{} samples from {} to {} ms, {:.0} Hz, peak {:.2} {unit}",
            raw.len(),
            ms(first_s),
            ms(first_s + raw.length_s()),
            raw.rate_hz(),
            in_g(raw.peak_m_per_s2())
        ),
    );
    row(
        "subtracted",
        match &pulse.zero_line {
            None => "nothing".to_string(),
            Some(line) => format!(
                "{:.3} {unit} at the onset, {:.3} {unit} at the end",
                in_g(line.at(pulse.onset_s)),
                in_g(line.at(pulse.onset_s + used.length_s()))
            ),
        },
    );
    let filter = pulse.filter.map(|filter| filter.to_string());
    row("filter", filter.unwrap_or_else(|| "none".to_string()));
    row(
        "pulse",
        format!(
            "{} samples, {} ms, onset at {} ms of the record",
            used.len(),
            ms(used.length_s()),
            ms(pulse.onset_s)
        ),
    );
    row("peak", format!("{:.2} {unit}", in_g(used.peak_m_per_s2())));
    let (from_s, to_s) = used.above(WIDTH_ABOVE);
    row(
        "width",
        format!("{} ms above 10 % of the peak", ms(to_s - from_s)),
    );
    if pulse.has_unit {
        let velocity = used.velocity_change_m_per_s();
        row("velocity", format!("changed by {velocity:.3} m/s"));
    }
    let widths: Vec<String> = study.widths_ms.iter().map(ToString::to_string).collect();
    row(
        "simulated",
        match pulse.is_stretched {
            true => format!("stretched to {} ms", widths.join(", ")),
            false => format!(
                "in its own time; an amplitude of {:.2} G is the record itself",
                in_g(used.peak_m_per_s2().abs())
            ),
        },
    );
    row(
        "half-sine",
        format!(
            "{} {:.2} {unit}, {} ms, from {} ms after the onset",
            if is_asked { "nominal" } else { "nearest" },
            in_g(nominal.peak_m_per_s2),
            ms(nominal.duration_s),
            ms(nominal.onset_s)
        ),
    );
    let outside = nominal.outside(used);
    row(
        "tolerance",
        format!(
            "± {:.0} % of its peak (IEC 60068-2-27): {}",
            100.0 * AMPLITUDE_TOLERANCE,
            if outside.is_empty() {
                "within"
            } else {
                "outside"
            }
        ),
    );
    for part in &outside {
        row(
            "",
            format!(
                "{} to {} ms: {:+.1} %",
                ms(part.from_s),
                ms(part.to_s),
                100.0 * part.share
            ),
        );
    }
    let ratio = nominal.velocity_ratio(used);
    let is_within = (ratio - 1.0).abs() <= VELOCITY_TOLERANCE;
    row(
        "",
        format!(
            "± {:.0} % of its velocity change: {}, {:+.1} %",
            100.0 * VELOCITY_TOLERANCE,
            if is_within { "within" } else { "outside" },
            100.0 * (ratio - 1.0)
        ),
    );
    text
}

fn as_json(study: &Study, pulse: &MeasuredPulse, nominal: &HalfSine) -> Value {
    let (raw, used) = (&pulse.raw, &pulse.used);
    let (from_s, to_s) = used.above(WIDTH_ABOVE);
    let outside = nominal.outside(used);
    let outside = outside.iter().map(
        |part| json!({ "from_s": part.from_s, "to_s": part.to_s, "share_of_peak": part.share }),
    );
    json!({
        "file": pulse.file,
        "record": {
            "samples": raw.len(),
            "from_s": raw.time_s[0],
            "length_s": raw.length_s(),
            "rate_hz": raw.rate_hz(),
            "peak_g": in_g(raw.peak_m_per_s2()),
        },
        "subtracted": pulse.zero_line.map(|line| json!({
            "at_onset_g": in_g(line.at(pulse.onset_s)),
            "at_end_g": in_g(line.at(pulse.onset_s + used.length_s())),
        })),
        "filter": pulse.filter.map(|filter| json!({
            "cutoff_hz": filter.cutoff_hz(),
            "order_of_a_pass": filter.order(),
        })),
        "pulse": {
            "samples": used.len(),
            "onset_s": pulse.onset_s,
            "length_s": used.length_s(),
            "peak_g": in_g(used.peak_m_per_s2()),
            "has_unit": pulse.has_unit,
            "width_s": to_s - from_s,
            "velocity_change_m_per_s": used.velocity_change_m_per_s(),
            "is_stretched": pulse.is_stretched,
        },
        "widths_ms": study.widths_ms,
        "half_sine": {
            "peak_g": in_g(nominal.peak_m_per_s2),
            "duration_s": nominal.duration_s,
            "onset_s": nominal.onset_s,
            "outside": outside.collect::<Vec<_>>(),
            "velocity_ratio": nominal.velocity_ratio(used),
        },
        "warnings": pulse.warnings,
    })
}
