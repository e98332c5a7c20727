//! Converts a dynamic run of the CMLAir family (`DynLULS.def`) into sections of a study: slider, pulse, disk and ramp.
//!
//! The ramp's place follows from the actuator's pivot P. The arm, of length L, reaches from there to the
//! slider at the radius r, whose skew s is the angle between arm and track:
//!
//! ```text
//! c² = r² + L² − 2 r L sin s               c from P to the disk's centre
//! cos γ = (c² + L² − r²) / (2 c L)         γ at P, between c and the arm
//! R² = c² + x² − 2 c x cos(γ + a)          ramp at x from P, rotated by a from the slider outwards
//! ```
//!
//! The angle at the disk's centre from ramp to slider, in the sense of rotation, is the difference of their polar
//! angles there. With the sample drive of the CMLAir 8.01 manual R is 32.15 mm, inside its rim of 32.5 mm, and the
//! angle 7.0 degrees. This sign means a skew that grows outwards, as of a rotary actuator: the same arm has −6.1
//! degrees at 17.9 mm.

use super::deck;
use super::dynamic::flexure::Parted;
use super::dynamic::layout;
use super::dynamic::{Contents, DynamicFile, Gas, Shape, Shock};
use super::rail::RailFile;
use super::run::RunFile;
use super::study::{Asked, Sections, Written, gas, sections, shortest, suspension};
use crate::fault::{Fault, Faults};
use std::fmt::Write as _;

/// Sizes of one slider in two files may differ by this share; in a deck of version 6.4, whose surface is scaled to its
/// size, by the second.
const SAME: [f64; 2] = [1e-6, 0.02];

/// Time constants after which a decaying sine is cut: 0.1 % is left.
const DECAYED: f64 = 7.0;

/// The study of a surface on the drive of a dynamic run. `run.dat` supplies what the dynamic run does not give: gas,
/// and forces other than the air's. `imported` are the keys of a suspension by matrices, `parted` is what a deck of version
/// 6.4 has in them beside it.
///
/// # Errors
/// E175 for a slider of another size than the surface, a place of the ramp that is not over the disk, and as
/// [`super::study::study`].
pub fn study(
    rail: &RailFile,
    run: Option<&RunFile>,
    (file, name): (&DynamicFile, &str),
    (imported, parted): (Option<&str>, Option<&Parted>),
    asked: Asked<'_>,
) -> Result<Written, Faults> {
    let (mut study, mut left_out) = sections(rail, run, asked)?;
    let mut faults = other_slider(rail, file, name);
    let place = match place(file, name) {
        Ok(place) => place,
        Err(wrong) => {
            faults.append(wrong);
            None
        }
    };
    faults.or(())?;
    fill(&mut study, rail, run, file, place);
    let deck = match &file.suspension {
        Contents::Deck(deck) => Some((file, deck)),
        Contents::Unknown | Contents::Suspension(_) => None,
    };
    if let Some(deck) = deck {
        deck::fill(&mut study, deck, rail, parted);
    }
    if let Some(imported) = imported {
        let _ = writeln!(study.suspension, "[suspension.imported]\n{imported}");
    }
    if run.is_some() {
        // The places, speeds and load of `run.dat` are not used, so no note is needed.
        left_out.retain(|note| !["radii", "speeds", "xf0, yf0"].contains(&note.what.as_str()));
    }
    let has_matrices = imported.is_some();
    left_out.extend(match deck {
        Some(deck) => deck::notes(deck, name, rail, has_matrices),
        None => notes(file, name, run.is_some(), place.is_some(), has_matrices),
    });
    Ok(Written {
        text: study.text(asked),
        left_out,
    })
}

/// Polar coordinates of ramp and slider about the disk's centre.
#[derive(Clone, Copy)]
struct Place {
    /// Radius of the ramp, m.
    ramp_m: f64,
    /// From ramp to slider in the sense of rotation, deg.
    slider_deg: f64,
}

fn fill(
    study: &mut Sections,
    rail: &RailFile,
    run: Option<&RunFile>,
    file: &DynamicFile,
    place: Option<Place>,
) {
    let mm = |value: f64| shortest(value, 1e3);
    let disk = &file.disk;
    let [inner, outer] = disk.radii_m;
    study.disk = format!(
        "[disk]\ninner_radius_mm = {}\nouter_radius_mm = {}\nthickness_mm = {}\n\
         youngs_modulus_gpa = {}\npoisson = {}\ndensity_kg_per_m3 = {}\nrpm = {}\n\
         damping = {{ rayleigh = {{ alpha_per_s = {:?}, beta_s = {:?} }} }}\n\n",
        mm(inner),
        mm(outer),
        mm(disk.thickness_m),
        shortest(disk.youngs_modulus_pa, 1e-9),
        disk.poisson,
        disk.density_kg_per_m3,
        file.speed_rpm,
        disk.alpha_per_s,
        disk.beta_s
    );
    if let Some(shock) = &file.shock {
        study.pulse = pulse(shock);
    }
    let clearance = shortest(file.ramp.clearance_m, 1e6);
    if let Some(place) = place {
        study.ramp = format!(
            "[ramp]\nmodels = [\"none\", \"rigid\"]\nclearance_um = {clearance}\n\
             radius_mm = {:.3}\nangle_deg = 0\n\n",
            1e3 * place.ramp_m
        );
    }
    let of_run = run.map(|run| Gas {
        pressure_pa: run.pressure_pa,
        mean_free_path_m: run.mean_free_path_m,
        viscosity_pa_s: run.viscosity_pa_s,
    });
    let model = "fukui_kaneko";
    study.gas = match file.gas.or(of_run) {
        Some(Gas {
            pressure_pa,
            mean_free_path_m,
            viscosity_pa_s,
        }) => gas(pressure_pa, viscosity_pa_s, mean_free_path_m, model),
        None => format!("[gas]\nmodel = \"{model}\"\n\n"),
    };
    study.suspension = suspension(file.load_kgf);
    study.slider = format!(
        "radius_mm = {}\nskew_deg = {}\n",
        mm(file.radius_m),
        file.skew_deg
    );
    if let Some(place) = place {
        let _ = writeln!(study.slider, "angle_deg = {:.3}", place.slider_deg);
    }
    let _ = write!(
        study.slider,
        "length_mm = {}\nwidth_mm = {}\nheight_mm = {}\n",
        mm(rail.length_m),
        mm(rail.width_m),
        mm(rail.thickness_m)
    );
}

/// Section of the pulse. A study searches its amplitude.
fn pulse(shock: &Shock) -> String {
    let ms = |value: f64| shortest(value, 1e3);
    let (shape, width_s) = match shock.shape {
        Shape::HalfSine => ("shape = \"half_sine\"\n".to_owned(), shock.width_s),
        Shape::Square => ("shape = \"square\"\n".to_owned(), shock.width_s),
        Shape::Sine => (sine(shock.width_s, 0.0), shock.width_s),
        Shape::DecayingSine => (
            sine(shock.width_s, 1.0 / shock.time_constant_s),
            shock.width_s.max(DECAYED * shock.time_constant_s),
        ),
    };
    let mut text = format!(
        "[pulse]\n{shape}widths_ms = [{}]\nsigns = [\"+\", \"-\"]\nstart_ms = {}\n",
        ms(width_s),
        ms(shock.start_s)
    );
    // The default window, longer for pulses that would fill it.
    let window_s = 2.0 * width_s;
    if window_s > 5e-3 {
        let _ = writeln!(text, "window_ms = {}", ms(window_s));
    }
    text + "\n"
}

fn sine(period_s: f64, decay_per_s: f64) -> String {
    format!(
        "shape = \"damped_sine\"\nfrequency_hz = {:?}\ndecay_per_s = {decay_per_s:?}\n",
        1.0 / period_s
    )
}

/// E175 where the surface is of a slider of another size.
fn other_slider(rail: &RailFile, file: &DynamicFile, name: &str) -> Faults {
    let mut faults = Faults::default();
    let width_m = file.length_m * file.width_per_length;
    let same = SAME[usize::from(matches!(file.suspension, Contents::Deck(_)))];
    for (what, value, wanted) in [
        ("xl", file.length_m, rail.length_m),
        ("xl times yl/xl", width_m, rail.width_m),
    ] {
        if (value / wanted - 1.0).abs() > same {
            let fault = Fault::of("E175", name, "the slider is not that of the surface");
            faults.push(
                fault
                    .what(what)
                    .value(format!("{value} m"))
                    .allowed(format!("{wanted} m, as in rail.dat")),
            );
        }
    }
    faults
}

/// Places of ramp and slider; `None` without an arm.
///
/// # Errors
/// E175 for a ramp that is not over the disk.
fn place(file: &DynamicFile, name: &str) -> Result<Option<Place>, Faults> {
    let (arm, radius) = (file.arm_m, file.radius_m);
    if arm == 0.0 {
        return Ok(None);
    }
    let centre = (radius * radius + arm * arm
        - 2.0 * radius * arm * file.skew_deg.to_radians().sin())
    .sqrt();
    // Pivot at the origin, the disk's centre on the x axis.
    let cosine = (centre * centre + arm * arm - radius * radius) / (2.0 * centre * arm);
    let to_slider = cosine.clamp(-1.0, 1.0).acos();
    let from_centre = |distance: f64, angle: f64| {
        let (x, y) = (distance * angle.cos() - centre, distance * angle.sin());
        (x.hypot(y), y.atan2(x))
    };
    let (_, slider) = from_centre(arm, to_slider);
    let ramp = &file.ramp;
    let (ramp_m, at_ramp) = from_centre(ramp.distance_m, to_slider + ramp.angle_deg.to_radians());
    let [inner, outer] = file.disk.radii_m;
    if !(inner..=outer).contains(&ramp_m) {
        let fault = Fault::of("E175", name, "the ramp is not over the disk");
        return Err(fault
            .what("x_ramp, ramp_ang")
            .value(format!("{:.3} mm from the disk's centre", 1e3 * ramp_m))
            .allowed(format!("{:.3} to {:.3} mm", 1e3 * inner, 1e3 * outer))
            .hint("its place follows from xact, ra and skew: the arm from the pivot to the slider")
            .into());
    }
    let turn = (at_ramp - slider).to_degrees();
    Ok(Some(Place {
        ramp_m,
        slider_deg: turn - 360.0 * (turn / 360.0).round(),
    }))
}

/// Notes on assumptions about the file, and on values that are not imported.
fn notes(
    file: &DynamicFile,
    name: &str,
    has_run: bool,
    has_ramp: bool,
    has_matrices: bool,
) -> Vec<Fault> {
    let mut notes = Vec::new();
    let mut note = |what: &str, value: String, message: &str| {
        notes.push(Fault::of("N207", name, message).what(what).value(value));
    };
    let load = format!("{} kg", file.load_kgf);
    note("f0", load, "read in kg of force, as in run.dat");
    let skew = format!("{} deg", file.skew_deg);
    note("skew", skew, "read in degrees");
    report_shock(file, &mut note);
    let [inner, outer] = file.disk.radii_m;
    note(
        "radii and thickness of the disk",
        format!("{inner}, {outer}, {} m", file.disk.thickness_m),
        "read as the three values before E",
    );
    note(
        "Rayleigh damping of the disk",
        format!("{:?} 1/s, {:?} s", file.disk.alpha_per_s, file.disk.beta_s),
        "read as the last two values of the section: shares of mass and of stiffness",
    );
    let arm = format!("{} m", file.arm_m);
    let message = match has_ramp {
        true => {
            "read as the arm from the pivot to the slider, which gives the ramp's place; ramp_ang is in degrees from the slider outwards; the ramp is rigid"
        }
        false => {
            "no arm from the pivot to the slider: the ramp's place is not known, it is left out"
        }
    };
    note("xact", arm, message);
    if file.gas.is_none() {
        let message = match has_run {
            true => "not in the section of the air by these names: the gas is that of run.dat",
            false => {
                "not in the section of the air by these names: the gas is that of the default drive"
            }
        };
        note("p0, al, vis", "not found".to_owned(), message);
    }
    if has_run {
        note(
            "run.dat",
            "beside DynLULS.def".to_owned(),
            "radius, skew, speed, load and slip model are those of DynLULS.def",
        );
    }
    match (has_matrices, &file.suspension) {
        (true, Contents::Suspension(found)) => note(
            "freedom numbers of the slider",
            found.slider_row.to_string(),
            "the third value of its section, a row of the matrices: its node is the dimple",
        ),
        _ => note(
            "suspension",
            "matrices not taken".to_owned(),
            "the suspension is that of the default drive with this load",
        ),
    }
    report_rest(file, has_matrices, &mut note);
    notes
}

/// Notes on how the pulse was read.
fn report_shock(file: &DynamicFile, note: &mut impl FnMut(&str, String, &str)) {
    let Some(shock) = &file.shock else {
        let message = "no pulse: half-sines of three widths are searched";
        note("shock", "mode 0".to_owned(), message);
        return;
    };
    note(
        "shock",
        format!(
            "{} s, {} s, {} G, {} s",
            shock.start_s, shock.width_s, shock.magnitude_g, shock.time_constant_s
        ),
        "read in the order start, width, magnitude, time constant",
    );
    note(
        "magnitude of the shock",
        format!("{} G", shock.magnitude_g),
        "a study searches it, in both senses; one shock: opshock run --amplitude-g",
    );
    let period = format!("{} s", shock.width_s);
    match shock.shape {
        Shape::HalfSine | Shape::Square => {}
        Shape::Sine => note(
            "width of the shock",
            period,
            "read as the period of the sine, of which there is one",
        ),
        Shape::DecayingSine => note(
            "width of the shock",
            period,
            "read as the period of the sine, which is cut after seven time constants",
        ),
    }
}

/// Notes on values that are not imported.
fn report_rest(file: &DynamicFile, has_matrices: bool, note: &mut impl FnMut(&str, String, &str)) {
    note(
        "dt, tf",
        format!("{:?} s, {:?} s", file.step_s, file.end_s),
        "a study has its own window and steps",
    );
    let attitude = format!("{:?}", file.attitude);
    note(
        "hm, hp, hr, dx, dy, yaw",
        attitude,
        "a run starts from the steady flight",
    );
    for (what, values, message) in [
        (
            "xg, yg, zg",
            &file.centre[..],
            "the slider is a block of one density",
        ),
        (
            "xf0, yf0",
            &file.load_point_m[..],
            "the load acts at the slider's centre",
        ),
        ("halt", &[file.halt][..], "the gas is not changed with it"),
        (
            "iact, dact, vact",
            &file.actuator[..],
            "the actuator stands still",
        ),
    ] {
        if values.iter().any(|value| *value != 0.0) {
            note(what, format!("{values:?}"), message);
        }
    }
    if file
        .move_radii_m
        .iter()
        .any(|radius| *radius != file.radius_m)
    {
        note(
            "ra_if, ra_of",
            format!("{:?} m", file.move_radii_m),
            "the slider stays at ra",
        );
    }
    let is_read = |at: usize| match at {
        layout::AIR => file.gas.is_some(),
        layout::MATRICES => has_matrices,
        _ => at <= layout::SOLVER || [layout::SHOCK, layout::DISK].contains(&at),
    };
    let titles = layout::SECTIONS.iter().enumerate();
    let rest: Vec<&str> = titles
        .filter(|(at, _)| !is_read(*at))
        .map(|(_, (title, _))| *title)
        .collect();
    note(
        "sections",
        rest.len().to_string(),
        &format!("not read: {}", rest.join(", ")),
    );
}
