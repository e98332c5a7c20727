//! What a dynamic deck of version 6.4 gives a study beside what every dynamic run gives: suspension, slider's mass, notes.

use super::dynamic::deck::UNREAD;
use super::dynamic::flexure::Parted;
use super::dynamic::{DeckSuspension, DynamicFile};
use super::rail::RailFile;
use super::study::{Sections, shortest};
use crate::fault::Fault;
use std::fmt::Write as _;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

/// Fields of a deck, and the keys of the study that they become.
pub const MAP: [(&str, &str); 14] = [
    ("f0", "suspension.gram_load_gf"),
    ("rpm", "disk.rpm"),
    ("ra, ske", "slider.radius_mm, skew_deg"),
    ("xact, x_ramp, ramp_ang", "ramp.radius_mm, slider.angle_deg"),
    ("iqpo, p0, al, vis", "gas"),
    (
        "shmod, sttime, pulsewid, tconst",
        "pulse.shape, start_ms, widths_ms",
    ),
    (
        "susp_M.dat, susp_K.dat, susp_cords.dat, dofs",
        "suspension.imported, suspension.gimbal, slider.density_kg_per_m3",
    ),
    (
        "preload of the closed contact",
        "suspension.gimbal.dimple_preload_gf",
    ),
    (
        "the closed contact, a constraint",
        "suspension.dimple.stiffness_n_per_m",
    ),
    ("condist of the open contacts", "suspension.limiters"),
    ("ramp_opt, clr", "ramp.models, clearance_um"),
    ("ri, ro, th, E, nu, rho", "disk: radii, thickness, material"),
    ("susp damp", "suspension.rayleigh"),
    ("damp of the disk", "disk.damping.rayleigh"),
];

/// Stiffness that stands for a constraint: 25 mN give by 0.25 nm, and ten times more moves the forces of the shared decks by less
/// than 0.001 % of their peak.
const RIGID_N_PER_M: f64 = 1e8;

/// Adds the suspension's contacts, and with `parted` its flexure and the slider's density.
pub(super) fn fill(
    study: &mut Sections,
    (file, deck): (&DynamicFile, &DeckSuspension),
    rail: &RailFile,
    parted: Option<&Parted>,
) {
    let mut gimbal = Vec::new();
    if let Some(parted) = parted {
        let names = ["vertical_n_per_m", "pitch_n_m_per_rad", "roll_n_m_per_rad"];
        let springs = names.iter().zip(parted.flexure);
        gimbal.extend(springs.map(|(name, spring)| format!("{name} = {spring:?}")));
        let volume_m3 = rail.length_m * rail.width_m * rail.thickness_m;
        let _ = writeln!(
            study.slider,
            "density_kg_per_m3 = {}",
            parted.slider_kg / volume_m3
        );
    }
    let preload_gf = 1e3 * deck.preload_n / GRAVITY;
    gimbal.push(format!("dimple_preload_gf = {preload_gf}"));
    study.suspension = format!(
        "[suspension]\ngram_load_gf = {}\ngimbal = {{ {} }}\ndimple = {{ stiffness_n_per_m = {RIGID_N_PER_M:?} }}\n\
         rayleigh = {{ alpha_per_s = {:?}, beta_s = {:?} }}\n",
        shortest(file.load_kgf, 1e3),
        gimbal.join(", "),
        deck.alpha_per_s,
        deck.beta_s
    );
    let um = |gap_m: f64| shortest(gap_m, 1e6);
    match deck.limiters_m[..] {
        [] => {}
        [gap_m] => {
            let _ = writeln!(study.suspension, "limiters = {{ gap_um = {} }}", um(gap_m));
        }
        [inner_m, outer_m, ..] => {
            let _ = writeln!(
                study.suspension,
                "limiters = {{ gap_um = {}, gap_outer_um = {} }}",
                um(inner_m),
                um(outer_m)
            );
        }
    }
    study.suspension += "\n";
    if file.ramp.sides == 0 {
        study.ramp = "[ramp]\nmodels = [\"none\"]\n\n".to_owned();
    }
}

/// Notes on what a deck has and the study has not.
pub(super) fn notes(
    (file, deck): (&DynamicFile, &DeckSuspension),
    name: &str,
    rail: &RailFile,
    has_matrices: bool,
) -> Vec<Fault> {
    let mut notes = Vec::new();
    let mut note = |what: &str, value: String, message: &str| {
        notes.push(Fault::of("N207", name, message).what(what).value(value));
    };
    if (file.length_m / rail.length_m - 1.0).abs() > f64::EPSILON {
        note(
            "xl",
            format!("{} m", file.length_m),
            "the slider has the size in rail.dat",
        );
    }
    if let Some(shock) = &file.shock {
        let sign = if shock.magnitude_g < 0.0 { "+" } else { "-" };
        note(
            "magnitude",
            format!("{} G", shock.magnitude_g),
            &format!(
                "a study searches it, in both senses; this shock: opshock run --sign {sign} --amplitude-g {}",
                shock.magnitude_g.abs()
            ),
        );
    }
    note(
        "dimple",
        "rigid".to_owned(),
        &format!(
            "suspension.dimple.stiffness_n_per_m = {RIGID_N_PER_M:?}, that of the limiters too"
        ),
    );
    if !has_matrices {
        note(
            "susp_M.dat, susp_K.dat",
            "not taken".to_owned(),
            "the suspension is that of the default drive with this load",
        );
    }
    if file.ramp.sides == 1 {
        note(
            "ramp_opt",
            "1".to_owned(),
            "ramps of a study have both arms",
        );
    }
    if file.ramp.sides > 0 {
        note(
            "profile of the ramp",
            "not taken".to_owned(),
            "the disk meets it in one point",
        );
    }
    if deck.limiters_m.len() > 2 {
        let count = deck.limiters_m.len().to_string();
        note("condist", count, "the first two limiters are taken");
    }
    for (what, values, message) in [
        (
            "psa, rsa",
            deck.static_angles_rad.to_vec(),
            "static angles of the suspension are not taken",
        ),
        (
            "xf0, yf0 from the centre",
            file.load_point_m.to_vec(),
            "the load acts at the slider's centre",
        ),
        ("halt", vec![file.halt], "the gas is not changed with it"),
        (
            "iact, dact, vact",
            file.actuator[1..].to_vec(),
            "the actuator stands still",
        ),
    ] {
        if values.iter().any(|value| *value != 0.0) {
            note(what, format!("{values:?}"), message);
        }
    }
    note(
        "dt, tf",
        format!("{:?} s, {:?} s", file.step_s, file.end_s),
        "a study has its own window and steps",
    );
    note(
        "hm, hp, hr, dx, dy, yaw",
        format!("{:?}", file.attitude),
        "a run starts from the steady flight",
    );
    note(
        "sections",
        UNREAD.len().to_string(),
        &format!("not read: {}", UNREAD.join(", ")),
    );
    notes
}
