//! Range of attitudes about steady flight at which films are sampled for the defect correction.

use super::attitude::Attitude;
use super::defect::range::{Parabola, Range, height};
use super::film::Film;
use super::search::Flight;
use super::steady::fly_near;

/// Loads that give θ_eq, relative to steady flight; the second set where the film does not carry the first.
const LOADS: [[f64; 3]; 2] = [[0.6, 1.0, 2.5], [0.25, 0.5, 1.0]];

/// Lowest and highest mean height of the two points, relative to steady flight.
const HEIGHTS: [f64; 2] = [0.05, 1.5];

/// Pitch about θ_eq and largest roll, relative to the pitch of steady flight: 95 % of the survivors of the study of
/// Fig. 13 stay inside it below 4 nm.
const PITCH: f64 = 0.18;
const ROLL: f64 = 0.12;

/// Accepted equilibrium pitch at the ends of [`HEIGHTS`], relative to steady flight; beyond it the parabola is used
/// between its flights only, constant outside.
const PITCHES: [f64; 2] = [0.3, 3.0];

/// Least distance of the two points, relative to the slider's width.
const APART: f64 = 0.02;

impl Range {
    /// The range about a steady `flight` of `film`.
    pub(super) fn around(film: &Film, flight: &Flight) -> Self {
        let min_height_m = film.min_height_m();
        let steady = flight.attitude;
        // A slider that flies level gets the range of one with a hundredth of the usual pitch.
        let usual = film.usual_attitude().pitch_rad.abs();
        let scale = steady.pitch_rad.abs().max(0.01 * usual);
        let [length, width] = film.extent_m();
        // Mirrored flights of a mirrored film have mirrored samples.
        let side = if film.blows_inwards() { -1.0 } else { 1.0 };
        let mut points = [side, -side].map(|sense| {
            let mut rolled = steady;
            rolled.roll_rad += sense * ROLL * scale;
            let closest = film.min_clearance(&rolled);
            let arms = [1.0, 0.5 * length - closest.x_m, closest.y_m - 0.5 * width];
            // Height at zero attitude: recess and form of the surface.
            let form_m = closest.value_m - height(&rolled, &arms);
            (form_m, arms)
        });
        let apart = points[1].1[2] - points[0].1[2];
        let sense = if apart == 0.0 { side } else { apart };
        let missing = 0.5 * (APART * width - apart.abs()).max(0.0).copysign(sense);
        points[0].1[2] -= missing;
        points[1].1[2] += missing;
        let mean = |attitude: &Attitude| {
            0.5 * points
                .iter()
                .map(|(form_m, arms)| form_m + height(attitude, arms))
                .sum::<f64>()
        };
        let mean_m = mean(&steady);
        let lean = |attitude: &Attitude| {
            let [first, second] = points.map(|(form_m, arms)| form_m + height(attitude, &arms));
            0.5 * (first - second)
        };
        let load_n = flight.lift_n + flight.suction_n;
        let flown = |loads: [f64; 3]| {
            let found = loads.map(|share| match share {
                1.0 => Some(steady),
                _ => {
                    let load = [share * load_n, 0.0, 0.0];
                    Some(fly_near(film, load, &steady).ok()?.attitude)
                }
            });
            let [a, b, c] = found;
            Some([a?, b?, c?])
        };
        let along = |flown: [Attitude; 3], value: &dyn Fn(&Attitude) -> f64| {
            Parabola::through(flown.map(|q| ((mean(&q) + min_height_m).ln(), value(&q))))
        };
        let pitch = |q: &Attitude| q.pitch_rad;
        let [usual, light] = LOADS;
        let (equilibrium, leaning) = match flown(usual).or_else(|| flown(light)) {
            Some(flown) => (along(flown, &pitch), along(flown, &lean).inside()),
            // Without neighbouring equilibria, steady flight is used at all heights.
            None => (
                Parabola::level(pitch(&steady)),
                Parabola::level(lean(&steady)),
            ),
        };
        // Far from the computed flights, a parabola through them is unreliable.
        let is_sound = HEIGHTS.iter().all(|height| {
            let (end, _) = equilibrium.at((height * mean_m + min_height_m).ln());
            let share = end / steady.pitch_rad;
            (PITCHES[0]..PITCHES[1]).contains(&share)
        });
        let equilibrium = match is_sound {
            true => equilibrium,
            false => equilibrium.inside(),
        };
        let leaning = match film.blows_across() {
            true => leaning,
            false => Parabola::level(0.0),
        };
        let half_m = 0.5 * (points[1].1[2] - points[0].1[2]).abs();
        Self {
            min_height_m,
            points,
            heights_m: HEIGHTS.map(|share| share * mean_m),
            lean_m: ROLL * scale * half_m,
            equilibrium,
            leaning,
            pitch_rad: PITCH * scale,
        }
    }
}
