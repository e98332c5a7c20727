//! Converts files of the CMLAir family into a study file and a surface file of opshock (TOML).

use super::rail::{RailFile, Recess};
use super::run::{RunFile, Slip};
use crate::fault::{Fault, Faults};
use std::fmt::Write as _;

/// Text of a written file, and notes on what was not imported.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// TOML.
    pub text: String,
    /// N207 for each value that was not imported.
    pub left_out: Vec<Fault>,
}

/// A number in another unit, with the fewest digits that reproduce it.
pub(super) fn shortest(value: f64, per: f64) -> String {
    let scaled = value * per;
    for digits in 0..17 {
        let text = format!("{scaled:.digits$e}");
        let short: f64 = text.parse().unwrap_or(scaled);
        if (short / per - value).abs() <= 2.0 * f64::EPSILON * value.abs() {
            return format!("{short}");
        }
    }
    format!("{scaled}")
}

/// The surface file of a `rail.dat`.
///
/// # Errors
/// E176 for rails that are ramps: opshock's rails are of one depth.
pub fn surface(file: &RailFile, name: &str) -> Result<Written, Faults> {
    let mut faults = Faults::default();
    let um = |value: f64| shortest(value, 1e6);
    let nm = |value: f64| shortest(value, 1e9);
    let mut text = format!("# From a CMLAir {} rail file.\n", file.version);
    let _ = writeln!(text, "base_recess_um = {}", um(file.base_recess_m));
    let _ = writeln!(text, "crown_nm = {}", nm(file.crown_m));
    let _ = writeln!(text, "camber_nm = {}", nm(file.camber_m));
    let _ = writeln!(text, "twist_nm = {}", nm(file.twist_m));
    if file.taper_length_m > 0.0 {
        let _ = writeln!(text, "taper_length_um = {}", um(file.taper_length_m));
        let _ = writeln!(
            text,
            "taper_angle_deg = {}",
            file.taper_angle_rad.to_degrees()
        );
    }
    let mut n_walled = 0;
    for (k, rail) in (1..).zip(&file.rails) {
        let depth = match rail.recess {
            Recess::Step(depth) => depth,
            // A ramp of one height is a step.
            Recess::Ramp([a, b, c]) if a == b && b == c => a,
            Recess::Ramp(depths) => {
                let fault = Fault::of("E176", name, "rails that slope are not simulated");
                faults.push(
                    fault
                        .line(rail.line)
                        .what(format!("rail {k}"))
                        .value(format!("depths {depths:?} m"))
                        .allowed("one depth a rail (style 1)")
                        .hint("replace it by steps"),
                );
                continue;
            }
        };
        n_walled += usize::from(rail.walls.iter().any(|wall| *wall > 0));
        let corners: Vec<String> = rail
            .corners_m
            .iter()
            .map(|[x, y]| {
                // Rounding beyond the edges of the slider is removed.
                let (x, y) = (x.clamp(0.0, file.length_m), y.clamp(0.0, file.width_m));
                format!("[{}, {}]", um(x), um(y))
            })
            .collect();
        let _ = write!(
            text,
            "\n[[rail]]\nkind = \"polygon\"\npoints_um = [{}]\nrecess_um = {}\n",
            corners.join(", "),
            um(depth)
        );
    }
    let mut left_out = Vec::new();
    if n_walled > 0 {
        left_out.push(
            Fault::of("N207", name, "wall profiles are replaced by vertical walls")
                .what("walls")
                .value(format!("{n_walled} rails with sloping walls")),
        );
    }
    if !file.points_m.is_empty() {
        left_out.push(
            Fault::of("N207", name, "points of interest are not taken along")
                .what("points")
                .value(file.points_m.len().to_string()),
        );
    }
    faults.or(Written { text, left_out })
}

/// Names of the files, and the selected flight.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Surface file, beside the study.
    pub surface_file: &'a str,
    /// Name of `run.dat`, for faults.
    pub run_file: &'a str,
    /// Selected radius, numbered from 1.
    pub radius: usize,
    /// Selected speed, numbered from 1.
    pub speed: usize,
}

/// Sections of a study, in their order.
#[derive(Clone, Debug)]
pub(super) struct Sections {
    pub(super) pulse: String,
    pub(super) disk: String,
    pub(super) ramp: String,
    pub(super) gas: String,
    pub(super) suspension: String,
    pub(super) forces: String,
    /// Keys of place and size; the surface follows them.
    pub(super) slider: String,
}

impl Sections {
    /// The sections that follow from the surface alone.
    fn of(rail: &RailFile) -> Self {
        Self {
            pulse: "[pulse]\nwidths_ms = [0.5, 1.0, 2.0]\nsigns = [\"+\", \"-\"]\n\n".to_owned(),
            disk: String::new(),
            ramp: "[ramp]\nmodels = [\"none\"]\n\n".to_owned(),
            gas: String::new(),
            suspension: String::new(),
            forces: String::new(),
            slider: format!(
                "length_mm = {}\nwidth_mm = {}\nheight_mm = {}\n",
                shortest(rail.length_m, 1e3),
                shortest(rail.width_m, 1e3),
                shortest(rail.thickness_m, 1e3)
            ),
        }
    }

    /// Takes one of the flights from `run.dat`.
    fn fly(&mut self, run: &RunFile, asked: Asked<'_>) -> Result<(), Faults> {
        let of = |list: &[f64], k: usize, what: &str| {
            let found = k.checked_sub(1).and_then(|k| list.get(k)).copied();
            found.ok_or_else(|| {
                let fault = Fault::of("E175", asked.run_file, format!("there is no such {what}"));
                Faults::from(
                    fault
                        .what(what)
                        .value(k.to_string())
                        .allowed(format!("1 to {}", list.len())),
                )
            })
        };
        let radius = of(&run.radii_m, asked.radius, "radius")?;
        let skew = of(&run.skews_deg, asked.radius, "radius")?;
        let speed = of(&run.speeds_rpm, asked.speed, "speed")?;
        self.disk = format!("[disk]\nrpm = {speed}\n\n");
        let place = format!("radius_mm = {}\nskew_deg = {skew}\n", shortest(radius, 1e3));
        self.slider.insert_str(0, &place);
        let model = match run.slip {
            Slip::First => "slip_1",
            Slip::Second => "slip_2",
            Slip::FukuiKaneko => "fukui_kaneko",
        };
        self.gas = gas(
            run.pressure_pa,
            run.viscosity_pa_s,
            run.mean_free_path_m,
            model,
        );
        self.suspension = suspension(run.load_kgf);
        self.forces = surface_forces(run);
        Ok(())
    }

    /// The study.
    pub(super) fn text(&self, asked: Asked<'_>) -> String {
        let mut text = format!(
            "study_format = 2\nname = {}\noutputs = [\"critical_shock\"]\n\n",
            quoted(asked.name)
        );
        for section in [
            &self.pulse,
            &self.disk,
            &self.ramp,
            &self.gas,
            &self.suspension,
            &self.forces,
        ] {
            text += section;
        }
        let surface = quoted(asked.surface_file);
        let _ = write!(
            text,
            "[slider]\n{}surface = {{ file = {surface} }}\n",
            self.slider
        );
        text
    }
}

/// Section of the gas.
pub(super) fn gas(
    pressure_pa: f64,
    viscosity_pa_s: f64,
    mean_free_path_m: f64,
    model: &str,
) -> String {
    format!(
        "[gas]\npressure_pa = {pressure_pa}\nviscosity_pa_s = {viscosity_pa_s}\n\
         mean_free_path_nm = {}\nmodel = \"{model}\"\n\n",
        shortest(mean_free_path_m, 1e9)
    )
}

/// Section of the load, kg of force.
pub(super) fn suspension(load_kgf: f64) -> String {
    let load_gf = shortest(load_kgf, 1e3);
    format!("[suspension]\ngram_load_gf = {load_gf}\n\n")
}

/// Sections of a surface flown according to `run.dat`, and notes on what was not imported; without `run.dat`, on the
/// default drive.
///
/// # Errors
/// E175 when there is no such radius or speed.
pub(super) fn sections(
    rail: &RailFile,
    run: Option<&RunFile>,
    asked: Asked<'_>,
) -> Result<(Sections, Vec<Fault>), Faults> {
    let mut sections = Sections::of(rail);
    let Some(run) = run else {
        return Ok((sections, Vec::new()));
    };
    sections.fly(run, asked)?;
    Ok((sections, run_left_out(run, asked.run_file)))
}

/// The study of a surface flown according to `run.dat`; without it, on the default drive.
///
/// # Errors
/// E175 when there is no such radius or speed.
pub fn study(rail: &RailFile, run: Option<&RunFile>, asked: Asked<'_>) -> Result<Written, Faults> {
    let (sections, left_out) = sections(rail, run, asked)?;
    Ok(Written {
        text: sections.text(asked),
        left_out,
    })
}

/// Section of the forces that the file gives; empty without any.
fn surface_forces(run: &RunFile) -> String {
    let mut text = String::new();
    for (key, value) in [
        ("hamaker_j", run.hamaker_j),
        ("repulsion_j_m6", run.repulsion_j_m6),
        ("potential_v", run.potential_v),
    ] {
        if value != 0.0 {
            let _ = writeln!(text, "{key} = {value:?}");
        }
    }
    match text.is_empty() {
        true => text,
        false => format!("[surface_forces]\n{text}\n"),
    }
}

fn run_left_out(run: &RunFile, file: &str) -> Vec<Fault> {
    let mut left_out = Vec::new();
    let mut note = |what: &str, value: String, message: &str| {
        left_out.push(Fault::of("N207", file, message).what(what).value(value));
    };
    for (what, list) in [("radii", &run.radii_m), ("speeds", &run.speeds_rpm)] {
        if list.len() > 1 {
            note(what, list.len().to_string(), "one of them is taken");
        }
    }
    if run.altitudes_m.iter().any(|altitude| *altitude != 0.0) {
        let value = format!("{:?} m", run.altitudes_m);
        note(
            "altitudes",
            value,
            "the gas is taken as given and not changed with altitude",
        );
    }
    if run.load_point_m != [0.0; 2] {
        let value = format!("{:?} m", run.load_point_m);
        note("xf0, yf0", value, "the load acts at the slider's centre");
    }
    if run.static_angles_rad != [0.0; 2] {
        let value = format!("{:?} rad", run.static_angles_rad);
        note(
            "psa, rsa",
            value,
            "static angles of the suspension are not taken along",
        );
    }
    if run.contact_model != 0 {
        let value = run.contact_model.to_string();
        note(
            "icmodel",
            value,
            "a touch is a failure and not simulated further",
        );
    }
    left_out
}

/// A TOML string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
