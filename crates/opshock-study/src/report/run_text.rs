//! The result of one simulation as text, for people.

use super::run_json::{ArmJson, MechanismJson, RunJson};
use std::fmt::Write as _;

/// Verdict, clearance, disk, contacts, energy and cost, a line each.
pub fn run_text(title: &str, run: &RunJson) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12}{value}");
    };
    line("shock", title.to_owned());
    line("verdict", verdict(run));
    if let Some(mechanism) = &run.mechanism {
        line("mechanism", mechanism_words(mechanism));
    }
    if let (Some(clearance), Some(time)) = (run.min_clearance_m, run.t_min_clearance_s) {
        let steady = run.steady.map_or(String::new(), |steady| {
            format!(
                " (steady {:.3} nm, pitch {:.2} urad, roll {:.2} urad)",
                1e9 * steady.min_clearance_m,
                1e6 * steady.pitch_rad,
                // Without the sign that rounding would leave on nothing.
                (1e8 * steady.roll_rad).round() / 100.0 + 0.0
            )
        });
        line(
            "clearance",
            format!("{:.3} nm at {:.4} ms{steady}", 1e9 * clearance, 1e3 * time),
        );
    }
    let um = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{:.2}", 1e6 * v));
    let disk = run.disk;
    line(
        "disk",
        format!(
            "slider {} to {} um, ramp point {} to {} um, rim up to {} um",
            um(disk.slider_min_m),
            um(disk.slider_max_m),
            um(disk.ramp_min_m),
            um(disk.ramp_max_m),
            um(disk.rim_max_m)
        ),
    );
    for (name, arm) in [
        ("ramp top", &run.contact.top),
        ("ramp bottom", &run.contact.bottom),
    ] {
        line(name, arm_summary(arm));
        if !arm.episodes.is_empty() {
            line(
                "",
                format!(
                    "{:>10} {:>10} {:>14} {:>12}",
                    "on_ms", "off_ms", "impulse_un_s", "peak_20us_n"
                ),
            );
        }
        for episode in &arm.episodes {
            line(
                "",
                format!(
                    "{:>10.4} {:>10.4} {:>14.3} {:>12.4}",
                    1e3 * episode.on_s,
                    1e3 * episode.off_s,
                    1e6 * episode.impulse_n_s,
                    episode.peak_20us_n
                ),
            );
        }
    }
    if let Some(dimple) = run.dimple {
        line(
            "dimple",
            format!(
                "smallest force {:.3} mN, open for {:.1} us",
                1e3 * dimple.min_force_n,
                1e6 * dimple.open_s
            ),
        );
    }
    for (name, stop) in [("limiters", run.limiters), ("lift tab", run.lift_tab)] {
        if let Some(stop) = stop {
            line(
                name,
                format!(
                    "largest force {:.3} mN, closed for {:.1} us",
                    1e3 * stop.max_force_n,
                    1e6 * stop.closed_s
                ),
            );
        }
    }
    if let Some(contact) = &run.slider_contact {
        let end = match contact.end {
            "in_contact" => "in contact at the end",
            _ => "flying at the end",
        };
        let count = contact.episodes.len();
        let touch = contact.touch_s.map_or(String::new(), |time_s| {
            format!(", touch at {:.4} ms", 1e3 * time_s)
        });
        line(
            "slider",
            format!(
                "{count} {} with the disk{touch}, {end}, {:.2} uJ not given back",
                if count == 1 { "contact" } else { "contacts" },
                1e6 * contact.yielded_j
            ),
        );
        if count > 0 {
            line(
                "",
                format!(
                    "{:>10} {:>10} {:>14} {:>14} {:>12} {:>10} {:>11} {:>12}",
                    "on_ms",
                    "off_ms",
                    "approach_mm_s",
                    "impulse_un_s",
                    "peak_mn",
                    "peak_gpa",
                    "closest_nm",
                    "friction_uj"
                ),
            );
        }
        for episode in &contact.episodes {
            line(
                "",
                format!(
                    "{:>10.4} {:>10.4} {:>14.3} {:>14.4} {:>12.3} {:>10.4} {:>11.3} {:>12.3}",
                    1e3 * episode.on_s,
                    1e3 * episode.off_s,
                    1e3 * episode.approach_m_per_s,
                    1e6 * episode.impulse_n_s,
                    1e3 * episode.peak_force_n,
                    1e-9 * episode.peak_pressure_pa,
                    1e9 * episode.closest_m,
                    1e6 * episode.friction_j
                ),
            );
        }
    }
    let energy = run.energy;
    line(
        "energy",
        format!(
            "peak {:.4} uJ, end {:.4} uJ; shock {:+.4}, damping {:+.4}, impacts {:+.4} uJ; closure {:.1e}",
            1e6 * energy.h_peak_j,
            1e6 * energy.h_end_j,
            1e6 * energy.shock_work_j,
            -1e6 * energy.damping_loss_j,
            -1e6 * energy.impact_loss_j,
            energy.closure
        ),
    );
    line(
        "contact law",
        format!(
            "penetration at most {:.2e} um, multiplier at least {:.1e} N s, product at most {:.1e} N s m",
            1e6 * run.complementarity.max_penetration_m,
            run.complementarity.min_multiplier_n_s,
            run.complementarity.max_product_n_s_m
        ),
    );
    line("effects", run.effects.join(", "));
    line("rules", run.rules.join(", "));
    let cost = run.cost;
    line(
        "cost",
        format!(
            "{} head steps ({} rejected), {} film solves of {} unknowns, {} structure steps, {:.3} s",
            cost.steps,
            cost.rejected,
            cost.film_solves,
            cost.film_unknowns,
            cost.structure_steps,
            cost.wall_s
        ),
    );
    for warning in &run.warnings {
        line("warning", format!("{}: {}", warning.code, warning.message));
    }
    text
}

fn verdict(run: &RunJson) -> String {
    match (run.t_fail_s, run.place, &run.cause) {
        (Some(time), Some(place), _) => format!(
            "fails{} at {:.4} ms, {:.0} um from the leading and {:.0} um from the inner edge",
            if is_damage(run, time) {
                " by damage"
            } else {
                ""
            },
            1e3 * time,
            1e6 * place.x_m,
            1e6 * place.y_m
        ),
        (_, _, Some(cause)) => format!("undecided: {cause}"),
        _ => run
            .verdict
            .unwrap_or("no verdict: head not simulated")
            .to_owned(),
    }
}

/// A failure at `time_s` is no touch: that came before, or not at all.
fn is_damage(run: &RunJson, time_s: f64) -> bool {
    let contact = run.slider_contact.as_ref();
    contact.is_some_and(|contact| contact.touch_s != Some(time_s))
}

fn arm_summary(arm: &ArmJson) -> String {
    match arm.first_touch_s {
        None => "no contact".to_owned(),
        Some(first) => format!(
            "first touch {:.4} ms, impulse {:.3} uN s in {} {}",
            1e3 * first,
            1e6 * arm.impulse_n_s,
            arm.episodes.len(),
            if arm.episodes.len() == 1 {
                "episode"
            } else {
                "episodes"
            }
        ),
    }
}

/// The mechanism with the figures that decided it.
fn mechanism_words(mechanism: &MechanismJson) -> String {
    let evidence = &mechanism.evidence;
    let until = |time_s: Option<f64>, what: &str| {
        time_s.map_or(String::new(), |time_s| match time_s > 5e-8 {
            true => format!("{what} until {:.1} us before the touch; ", 1e6 * time_s),
            false => format!("{what} until the touch; "),
        })
    };
    let began = evidence
        .ramp_began_before_s
        .map_or(String::new(), |time_s| {
            format!("ramp contact from {:.1} us before the touch", 1e6 * time_s)
        });
    format!(
        "{}: {}{}{}{began}{}dimple {:.2}, air bearing {:.2} of the steady dimple force, varied by {:.2}",
        evidence.mechanism().words(),
        until(evidence.limiter_before_s, "limiter closed"),
        until(evidence.lift_tab_before_s, "lift tab closed"),
        until(evidence.dimple_open_before_s, "dimple open"),
        until(evidence.ramp_contact_before_s, ""),
        evidence.dimple_over_steady,
        evidence.bearing_over_steady,
        evidence.bearing_range_over_steady
    )
}
