//! Plausible drives by seed, and what a slider's film carries found by forces on held sliders alone.

use nalgebra::{Matrix2, Vector2};
use opshock_solver::air_bearing::steady::fixed_attitude;
use opshock_solver::air_bearing::{Attitude, Film};
use opshock_solver::scene::Scene;
use opshock_solver::slider::RailOutline;

use crate::scenes::scene;
use crate::seeded::Seeded;

/// Every `gas.model` of a study.
pub const GAS_MODELS: [&str; 4] = ["continuum", "slip_1", "slip_2", "fukui_kaneko"];

/// Every resolution preset, in turns of the seeds.
const PRESETS: [&str; 3] = ["coarse", "standard", "fine"];

/// Ranges of what drives differ in.
const LOAD_GF: [f64; 2] = [0.3, 5.0];
const RPM: [f64; 2] = [2_000.0, 15_000.0];
const PRESSURE_PA: [f64; 2] = [0.4 * 101_325.0, 2.0 * 101_325.0];
const SKEW_DEG: f64 = 10.0;
const RADIUS_MM: [f64; 2] = [14.0, 31.0];

/// A drive with one of the surfaces of the studies, its rails, recesses and form varied; its surface is its own
/// mirror image across the slider's middle.
pub fn drive(seed: u64, gas_model: &str) -> Scene {
    let mut seeded = Seeded::new(seed);
    let study = *seeded.one_of(&["drive-2.5in", "fig13-stiffness"]);
    let load = seeded.log_between(LOAD_GF[0], LOAD_GF[1]);
    let rpm = seeded.between(RPM[0], RPM[1]);
    let pressure = seeded.between(PRESSURE_PA[0], PRESSURE_PA[1]);
    // One drive in four has a straight slider.
    let skew = match seeded.once_in(4) {
        true => 0.0,
        false => seeded.between(-SKEW_DEG, SKEW_DEG),
    };
    let radius = seeded.between(RADIUS_MM[0], RADIUS_MM[1]);
    let preset = PRESETS[(seed % 3) as usize];
    let numbers = [
        ("suspension.gram_load_gf", load),
        ("disk.rpm", rpm),
        ("gas.pressure_pa", pressure),
        ("slider.skew_deg", skew),
        ("slider.radius_mm", radius),
    ];
    let words = [("gas.model", gas_model), ("resolution.preset", preset)];
    let sets: Vec<(&str, String)> = numbers
        .iter()
        .map(|(key, value)| (*key, value.to_string()))
        .chain(
            words
                .iter()
                .map(|(key, word)| (*key, format!("\"{word}\""))),
        )
        .collect();
    let sets: Vec<(&str, &str)> = sets
        .iter()
        .map(|(key, value)| (*key, value.as_str()))
        .collect();
    let mut scene = scene(study, "none", 1.0, &sets);
    let surface = &mut scene.slider.surface;
    surface.crown_m *= seeded.between(0.0, 2.0);
    surface.camber_m *= seeded.between(0.0, 2.0);
    surface.base_recess_m *= seeded.between(0.7, 1.5);
    let (step, broad) = (seeded.between(0.7, 1.4), seeded.between(0.85, 1.03));
    let middle = 0.5 * scene.slider.width_m;
    for rail in &mut surface.rails {
        rail.recess_m *= step;
        if let RailOutline::Rectangle { y_m, .. } = &mut rail.outline {
            *y_m = y_m.map(|y| middle + broad * (y - middle));
        }
    }
    scene
}

/// The same drive with the skew of the other sign.
#[must_use]
pub fn turned(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    other.slider.skew_rad = -scene.slider.skew_rad;
    other
}

/// The most that a film carries without a moment where pitch and roll are stable, N, and the clearance there, m: of
/// quasi-static films from 50 nm down to the minimum film height, each at least `ratio` of the one before.
pub fn most_carried(film: &Film, ratio: f64) -> (f64, f64) {
    let mut most = (f64::NEG_INFINITY, f64::NAN);
    let usual = film.usual_attitude();
    let starts =
        [1.0, 0.5, 0.25, 2.0, 0.12].map(|factor| Vector2::new(factor * usual.pitch_rad, 0.0));
    let mut last = None;
    let mut clearance_m = 50e-9;
    loop {
        let tilts = last.into_iter().chain(starts);
        let found = tilts
            .filter_map(|tilt| balanced(film, clearance_m, tilt))
            .next();
        if let Some((load_n, _)) = found
            && load_n > most.0
        {
            most = (load_n, clearance_m);
        }
        last = found.map(|(_, tilt)| tilt);
        if clearance_m <= film.min_height_m() {
            return most;
        }
        clearance_m = (clearance_m * ratio).max(film.min_height_m());
    }
}

/// Slider at a smallest clearance with pitch and roll.
fn at_clearance(film: &Film, clearance_m: f64, tilt: Vector2<f64>) -> Attitude {
    let mut attitude = Attitude {
        centre_height_m: 0.0,
        pitch_rad: tilt[0],
        roll_rad: tilt[1],
    };
    attitude.centre_height_m = clearance_m - film.min_clearance(&attitude).value_m;
    attitude
}

/// The force where the moments vanish at a clearance, sought from a tilt by differences, and the tilt there; `None` where it
/// is not found or not stable.
fn balanced(film: &Film, clearance_m: f64, from: Vector2<f64>) -> Option<(f64, Vector2<f64>)> {
    let held = |tilt: Vector2<f64>, height_m: f64| {
        let attitude = Attitude {
            centre_height_m: height_m,
            pitch_rad: tilt[0],
            roll_rad: tilt[1],
        };
        fixed_attitude(film, &attitude).ok().map(|held| held.force)
    };
    let [length, width] = film.extent_m();
    let step = Vector2::new(1e-3 * clearance_m / length, 1e-3 * clearance_m / width);
    let most =
        Vector2::new(clearance_m / length, clearance_m / width).map(|tilt| 0.5 * tilt + 2e-6);
    let mut tilt = from;
    for _ in 0..25 {
        let height_m = at_clearance(film, clearance_m, tilt).centre_height_m;
        let force = held(tilt, height_m)?;
        let moment = Vector2::new(force[1], force[2]);
        // Of the whole slider about a fixed centre: the stiffness that holds it.
        let mut fixed = Matrix2::zeros();
        let mut along = Matrix2::zeros();
        for k in 0..2 {
            let mut moved = tilt;
            moved[k] += step[k];
            let same = held(moved, height_m)?;
            let shifted = held(
                moved,
                at_clearance(film, clearance_m, moved).centre_height_m,
            )?;
            let slope = |other: [f64; 3]| Vector2::new(other[1], other[2]);
            fixed.set_column(k, &((slope(same) - moment) / step[k]));
            along.set_column(k, &((slope(shifted) - moment) / step[k]));
        }
        let change = along.try_inverse()? * moment;
        if moment.norm() < 1e-6 * force[0].abs() * length {
            let scale = Matrix2::from_diagonal(&Vector2::new(1.0 / length, 1.0 / width));
            let stiffness = scale * fixed * scale;
            let is_stable = stiffness.trace() < 0.0 && stiffness.determinant() > 0.0;
            return is_stable.then_some((force[0], tilt));
        }
        for k in 0..2 {
            tilt[k] -= change[k].clamp(-most[k], most[k]);
        }
    }
    None
}
