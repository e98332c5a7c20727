//! `opshock modes --response SOURCE`: computes the response of disk, ramp, slider and suspension to a harmonic
//! force or shock, and the film's stiffness and damping at the same frequencies.

use crate::cli::failure::{Failure, Fault};
use crate::cli::{memory, study_file};
use anyhow::Context as _;
use nalgebra::Complex;
use opshock_solver::head::response::{Drive, HeadResponse};
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::Model;
use opshock_solver::structure::Source;
use opshock_study::study::Study;
use opshock_study::study::memory::Demand;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Where a response can come from: a name, and the structure's source when it acts there.
const SOURCES: [(&str, Option<Source>); 7] = [
    ("shock", Some(Source::Shock)),
    ("disk.ramp", Some(Source::DiskAtRamp)),
    ("disk.slider", Some(Source::DiskAtSlider)),
    ("ramp.top", Some(Source::TopArm)),
    ("ramp.bottom", Some(Source::BottomArm)),
    ("slider", None),
    ("dimple", None),
];

/// Every point's answer at one frequency, and the film there.
pub struct Row {
    frequency_hz: f64,
    points: Vec<(&'static str, Complex<f64>)>,
    stiffness: [[f64; 3]; 3],
    damping: [[f64; 3]; 3],
}

/// Responses to one source.
pub struct Responses {
    source: String,
    rows: Vec<Row>,
}

/// Computes them; the source and the frequencies are as given on the command line.
///
/// # Errors
///
/// A name that is no source, frequencies out of range, a disk on a hub or a vibrating base, no steady flight.
pub fn responses(
    study: &Study,
    scene: &Scene,
    source: &str,
    frequencies_hz: &[f64],
) -> Result<Responses, Failure> {
    let usage = |key: &str, value: String, allowed: String| {
        Failure::Usage(vec![Fault {
            key: Some(key.into()),
            value: Some(value.clone()),
            allowed: Some(allowed),
            ..Fault::new("usage", format!("{key} {value}: not possible"))
        }])
    };
    let Some((_, of_structure)) = SOURCES.iter().find(|(name, _)| *name == source) else {
        let names: Vec<&str> = SOURCES.iter().map(|(name, _)| *name).collect();
        return Err(usage("--response", source.to_owned(), names.join(", ")));
    };
    let wrong = frequencies_hz
        .iter()
        .find(|hz| !(hz.is_finite() && **hz >= 0.0));
    if let Some(hz) = wrong {
        return Err(usage("--hz", hz.to_string(), "frequencies >= 0".into()));
    }
    if frequencies_hz.is_empty() {
        return Err(usage(
            "--hz",
            String::new(),
            "one or more frequencies".into(),
        ));
    }
    let stands = scene.disk.hub.is_some() || !scene.base.is_empty();
    if stands && of_structure.is_some() {
        let allowed =
            "slider or dimple: responses of a disk on a hub or a vibrating base are not computed";
        return Err(usage("--response", source.to_owned(), allowed.into()));
    }
    let mut still = scene.clone();
    // Small motions about steady flight over a plane disk.
    still.run_out.clear();
    let plan = Plan::new(&[Output::CriticalShock], Mode::Full);
    memory::check("the response", Demand::run(&still, &plan, false), 1)?;
    let model = Model::assemble(&still, &plan, None)
        .map_err(|error| study_file::cannot_be_simulated(study, &error))?;
    let head = model.head().context("no head")?;
    let mut linear = HeadResponse::new(head);
    let rows: Result<Vec<Row>, Failure> = frequencies_hz
        .iter()
        .map(|&hz| {
            let omega = TAU * hz;
            let one = Complex::new(1.0, 0.0);
            let mut drive = Drive::default();
            let mut points = Vec::new();
            match of_structure {
                Some(source) => {
                    let answer = model.structure().response(omega, *source);
                    let answer =
                        answer.map_err(|error| study_file::cannot_be_simulated(study, &error))?;
                    let answer = answer.context("a disk on a hub")?;
                    drive.disk = answer.slider;
                    if *source == Source::Shock {
                        drive.load_m_per_s2 = one;
                    }
                    points.extend([
                        ("disk.ramp", answer.ramp_m),
                        ("disk.rim", answer.rim_m),
                        ("disk.slider", answer.slider[0]),
                        ("disk.pitch", answer.slider[1]),
                        ("disk.roll", answer.slider[2]),
                        ("ramp.top", answer.arms_m[0]),
                        ("ramp.bottom", answer.arms_m[1]),
                    ]);
                }
                None if source == "slider" => drive.slider[0] = one,
                None => drive.dimple_n = one,
            }
            let what = || format!("no response at {hz} Hz");
            let answer = linear.at(omega, &drive).with_context(what)?;
            points.extend([
                ("slider", answer.slider[0]),
                ("slider.pitch", answer.slider[1]),
                ("slider.roll", answer.slider[2]),
                ("dimple", answer.dimple_m),
                ("film.height", answer.slider[0] - drive.disk[0]),
                ("film.force", answer.film[0]),
            ]);
            let z = linear.impedance(omega).with_context(what)?;
            let damping = |value: Complex<f64>| if omega > 0.0 { value.im / omega } else { 0.0 };
            Ok(Row {
                frequency_hz: hz,
                points,
                stiffness: std::array::from_fn(|i| std::array::from_fn(|j| z[(i, j)].re)),
                damping: std::array::from_fn(|i| std::array::from_fn(|j| damping(z[(i, j)]))),
            })
        })
        .collect();
    Ok(Responses {
        source: source.to_owned(),
        rows: rows?,
    })
}

impl Responses {
    /// For machines.
    pub fn as_json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                let points: Map<String, Value> = row
                    .points
                    .iter()
                    .map(|(name, value)| ((*name).to_owned(), json!([value.re, value.im])))
                    .collect();
                json!({
                    "frequency_hz": row.frequency_hz,
                    "points": points,
                    "stiffness": row.stiffness,
                    "damping": row.damping,
                })
            })
            .collect();
        json!({ "source": self.source, "rows": rows })
    }

    /// For people: magnitude and phase of every point.
    pub fn as_text(&self) -> String {
        let unit = match self.source.as_str() {
            "shock" => "m/s2 of shock",
            _ => "N",
        };
        let mut text = format!(
            "response per {unit} at {} (magnitude in m, rad, N; phase in degrees)\n",
            self.source
        );
        for row in &self.rows {
            let _ = writeln!(text, "  {} Hz", row.frequency_hz);
            for (name, value) in &row.points {
                let (size, phase) = (value.norm(), value.arg().to_degrees());
                let _ = writeln!(text, "    {name:<13} {size:>12.5e}  {phase:>8.2}");
            }
            let (k, c) = (row.stiffness[0][0], row.damping[0][0]);
            let _ = writeln!(text, "    film: {k:.5e} N/m, {c:.5e} N s/m against height");
        }
        text
    }
}
