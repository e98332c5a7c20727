//! What depends on several keys: geometry, pulse against step, search range, outputs.
//!
//! Each rule names the keys it looks at and is skipped while one of them has no usable value, so
//! that one mistake makes one message.

use super::fault::StudyError;
use super::keys;
use super::polygon;
use super::samples;
use super::scene;
use super::settings::{Datum, View};
use super::source::Place;
use super::unit;

/// Steps a pulse must span.
const STEPS_PER_PULSE: f64 = 8.0;

/// Net velocity change of a sampled shock that is taken for a mistake, m/s.
const LARGEST_VELOCITY_M_PER_S: f64 = 1000.0;

/// Collects the faults of one point of a study.
pub struct Check<'a, 'f> {
    /// The point's settings.
    pub view: &'f View<'a>,
    /// Where faults go.
    pub faults: &'f mut Vec<StudyError>,
}

impl Check<'_, '_> {
    /// Every rule that does not depend on the point.
    pub fn study(&mut self) {
        self.names();
        self.outputs();
        self.search();
    }

    /// Every rule about a point.
    pub fn point(&mut self, widths_ms: &[f64]) {
        self.disk_and_ramp();
        self.slider_place();
        self.rails();
        self.suspension();
        self.pulse(widths_ms);
    }

    fn sound(&self, paths: &[&str]) -> bool {
        self.view.settings.are_sound(paths)
    }

    /// A fault at the key, of those a rule looks at, that the user wrote last.
    fn fault(
        &mut self,
        code: &'static str,
        paths: &[&str],
        message: impl Into<String>,
    ) -> &mut StudyError {
        let blamed = paths
            .iter()
            .filter_map(|path| self.view.place(path).map(|place| (*path, place)))
            .rev()
            .max_by_key(|(_, place)| place.origin);
        let fault = match blamed {
            Some((path, place)) => StudyError::at(code, place, path, message).value(place.text()),
            None => StudyError::in_file(code, "study", message),
        };
        self.push(fault)
    }

    fn push(&mut self, fault: StudyError) -> &mut StudyError {
        let at = self.faults.len();
        self.faults.push(fault);
        &mut self.faults[at]
    }

    fn names(&mut self) {
        if !self.sound(&["name"]) {
            return;
        }
        let name = self.view.word("name");
        let wrong = if name.trim().is_empty() {
            Some("must not be empty")
        } else if name
            .chars()
            .any(|letter| letter == '/' || letter.is_control())
        {
            Some("must not hold / or control characters")
        } else if name.chars().count() > 200 {
            Some("must not be longer than 200 characters")
        } else {
            None
        };
        if let Some(message) = wrong {
            let fault = self.fault("E159", &["name"], message);
            fault.allowed =
                "text of 1 to 200 characters without / and control characters".to_string();
        }
    }

    fn outputs(&mut self) {
        if !self.sound(&["outputs"]) {
            return;
        }
        let outputs = self.view.words("outputs");
        if outputs.is_empty() {
            let fault = self.fault("E158", &["outputs"], "no output is asked for");
            fault.allowed = keys::find("outputs")
                .map(|key| key.kind.allowed())
                .unwrap_or_default();
        }
        if let Some(twice) = repeated(outputs) {
            let fault = self.fault("E159", &["outputs"], format!("asks for {twice} twice"));
            fault.allowed = "each output once".to_string();
        }
        let Some(head) = outputs.iter().find(|output| needs_head(output)) else {
            return;
        };
        if self.sound(&["solver.leave_out", "solver.effects"])
            && self
                .view
                .words("solver.leave_out")
                .iter()
                .any(|effect| effect == "air_bearing")
        {
            let fault = self.fault(
                "E158",
                &["solver.leave_out"],
                format!("{head} needs air_bearing, which is left out"),
            );
            fault.allowed = format!(
                "[], or outputs of disk and ramp alone: {}",
                keys::STRUCTURE_OUTPUTS.join(", ")
            );
            fault.hint = format!("remove {head} from outputs, or do not leave air_bearing out");
        }
        if self.sound(&["disk.rpm"]) && self.view.number("disk.rpm") == 0.0 {
            let fault = self.fault(
                "E133",
                &["disk.rpm"],
                format!("{head} needs the air bearing, which needs a spinning disk"),
            );
            fault.allowed = "> 0 rev/min".to_string();
            fault.hint = format!("or ask only for {}", keys::STRUCTURE_OUTPUTS.join(", "));
        }
    }

    fn search(&mut self) {
        let paths = ["search.amplitude_g.min", "search.amplitude_g.max"];
        if self.sound(&paths) {
            let (low, high) = (self.view.number(paths[0]), self.view.number(paths[1]));
            if low >= high {
                let fault = self.fault(
                    "E156",
                    &paths,
                    format!("the search range {low} to {high} g is empty"),
                );
                fault.allowed = "min < max".to_string();
            }
        }
        for (path, what) in [("ramp.models", "ramp models"), ("pulse.signs", "signs")] {
            if !self.sound(&[path]) {
                continue;
            }
            let words = self.view.words(path);
            if words.is_empty() {
                let fault = self.fault(
                    "E154",
                    &[path],
                    format!("the list is empty: a study needs {what}"),
                );
                fault.allowed = keys::find(path)
                    .map(|key| key.kind.allowed())
                    .unwrap_or_default();
            }
            if let Some(twice) = repeated(words) {
                let fault = self.fault("E154", &[path], format!("holds {twice:?} twice"));
                fault.allowed = "values that differ".to_string();
            }
        }
        if self.sound(&["pulse.widths_ms"]) {
            let widths = self.view.numbers("pulse.widths_ms");
            if widths.is_empty() {
                let fault = self.fault(
                    "E154",
                    &["pulse.widths_ms"],
                    "the list is empty: a study needs pulse widths",
                );
                fault.allowed = "one or more widths".to_string();
            }
            let mut sorted = widths.to_vec();
            sorted.sort_by(f64::total_cmp);
            if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                let fault = self.fault(
                    "E154",
                    &["pulse.widths_ms"],
                    format!("holds {} twice", twice[0]),
                );
                fault.allowed = "values that differ".to_string();
            }
        }
    }

    fn disk_and_ramp(&mut self) {
        let radii = ["disk.inner_radius_mm", "disk.outer_radius_mm"];
        let mut disk_fits = false;
        if self.sound(&radii) {
            let (inner, outer) = (self.view.number(radii[0]), self.view.number(radii[1]));
            disk_fits = inner < outer;
            if !disk_fits {
                let fault = self.fault(
                    "E140",
                    &radii,
                    format!("the inner radius {inner} mm is not below the outer radius {outer} mm"),
                );
                fault.allowed = "inner_radius_mm < outer_radius_mm".to_string();
            }
        }
        if disk_fits && self.sound(&["ramp.radius_mm"]) {
            let (inner, outer) = (self.view.number(radii[0]), self.view.number(radii[1]));
            let ramp = self.view.number("ramp.radius_mm");
            if ramp <= inner || ramp > outer {
                let side = if ramp > outer {
                    "outside the disk"
                } else {
                    "inside the clamp"
                };
                let fault = self.fault(
                    "E141",
                    &["ramp.radius_mm", radii[0], radii[1]],
                    format!("the ramp at {ramp} mm is {side}"),
                );
                fault.allowed = format!("> {inner} and <= {outer} mm");
            }
        }
        for path in [
            "ramp.clearance_um",
            "ramp.clearance_top_um",
            "ramp.clearance_bottom_um",
        ] {
            if self.sound(&[path]) && self.view.maybe_number(path) == Some(0.0) {
                let fault = self.fault("N143", &[path], "disk and ramp touch at rest");
                fault.hint = "allowed; contact begins with the shock".to_string();
            }
        }
    }

    fn slider_place(&mut self) {
        let paths = [
            "slider.radius_mm",
            "slider.length_mm",
            "slider.width_mm",
            "slider.skew_deg",
            "disk.inner_radius_mm",
            "disk.outer_radius_mm",
        ];
        if !self.sound(&paths) {
            return;
        }
        let [radius, length, width, skew_deg, inner, outer] =
            paths.map(|path| self.view.number(path));
        if inner >= outer {
            return;
        }
        let skew = unit::si("skew_deg", skew_deg);
        // Slider axes: the disk moves along (cos skew, sin skew); outward is a quarter turn left.
        for (x, edge) in [(-0.5 * length, "leading"), (0.5 * length, "trailing")] {
            for (y, side) in [(-0.5 * width, "inner"), (0.5 * width, "outer")] {
                let along = x * skew.cos() + y * skew.sin();
                let outward = y * skew.cos() - x * skew.sin();
                let corner = (radius + outward).hypot(along);
                if corner < inner || corner > outer || radius + outward < 0.0 {
                    let limit = if corner > outer {
                        "over the rim"
                    } else {
                        "over the clamp"
                    };
                    let fault = self.fault("E142", &paths, format!(
                        "the slider's {edge} {side} corner, at radius {corner:.3} mm, hangs {limit}"
                    ));
                    fault.allowed = format!("every corner between {inner} and {outer} mm");
                    fault.hint = "move the slider's centre".to_string();
                }
            }
        }
        let ramp = ["ramp.radius_mm", "ramp.angle_deg", "slider.angle_deg"];
        if self.sound(&ramp)
            && self
                .view
                .words("ramp.models")
                .iter()
                .any(|model| model != "none")
        {
            let [ramp_radius, ramp_deg, slider_deg] = ramp.map(|path| self.view.number(path));
            let apart = unit::si("angle_deg", ramp_deg - slider_deg);
            let (along, outward) = (
                ramp_radius * apart.sin(),
                ramp_radius * apart.cos() - radius,
            );
            let x = along * skew.cos() - outward * skew.sin();
            let y = along * skew.sin() + outward * skew.cos();
            if x.abs() <= 0.5 * length && y.abs() <= 0.5 * width {
                let fault = self.fault(
                    "W203",
                    &[
                        "slider.angle_deg",
                        "slider.radius_mm",
                        "ramp.radius_mm",
                        "ramp.angle_deg",
                    ],
                    "the slider flies over the ramp's contact point",
                );
                fault.allowed = "another angle or radius".to_string();
                fault.hint = "accept with --accept W203".to_string();
            }
        }
    }

    fn rails(&mut self) {
        let outline = ["slider.length_mm", "slider.width_mm"];
        if !self.sound(&outline) {
            return;
        }
        // Compared in SI: both sides are rounded once.
        let [length_m, width_m] = outline.map(|path| self.view.si(path));
        let (length_um, width_um) = (length_m * 1e6, width_m * 1e6);
        let inside = |corner: [f64; 2]| {
            let slack = 1e-12;
            let [x, y] = corner.map(|value| unit::si("x_um", value));
            (-slack..=length_m + slack).contains(&x) && (-slack..=width_m + slack).contains(&y)
        };
        let allowed = format!("0 to {length_um:.3} um along, 0 to {width_um:.3} um across");
        for position in 0..self.view.entries("slider.surface.rail") {
            let rail = format!("slider.surface.rail[{position}]");
            let member = |name: &str| format!("{rail}.{name}");
            if !self.sound(&[&rail]) {
                continue;
            }
            if self.view.word(&member("kind")) == "polygon" {
                if let Some(Datum::Points(points)) = self.view.get(&member("points_um")) {
                    self.polygon(&member("points_um"), points, &inside, &allowed);
                }
                continue;
            }
            for (axis, name) in [(0, "x_um"), (1, "y_um")] {
                let path = member(name);
                let Some(Datum::Pair(ends)) = self.view.get(&path) else {
                    continue;
                };
                for end in ends {
                    let mut corner = [0.0; 2];
                    corner[axis] = *end;
                    if !inside(corner) {
                        let fault = self.fault(
                            "E144",
                            &[&path],
                            format!("the rail reaches {end} um, outside the slider"),
                        );
                        fault.allowed = allowed.clone();
                    }
                }
            }
        }
    }

    fn polygon(
        &mut self,
        path: &str,
        points: &[[f64; 2]],
        inside: &dyn Fn([f64; 2]) -> bool,
        allowed: &str,
    ) {
        let mut corners = points.to_vec();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            let fault = self.fault(
                "E144",
                &[path],
                format!("the polygon is open: {} different corners", corners.len()),
            );
            fault.allowed = "3 corners or more".to_string();
            return;
        }
        if corners.len() > 2000 {
            let fault = self.fault(
                "E144",
                &[path],
                format!("the polygon has {} corners", corners.len()),
            );
            fault.allowed = "at most 2000 corners".to_string();
            return;
        }
        if let Some((position, corner)) = corners
            .iter()
            .enumerate()
            .find(|(_, corner)| !inside(**corner))
        {
            let fault = self.fault(
                "E144",
                &[path],
                format!(
                    "corner {} at [{}, {}] lies outside the slider",
                    position + 1,
                    corner[0],
                    corner[1]
                ),
            );
            fault.allowed = allowed.to_string();
        }
        if let Some((first, second)) = polygon::crossing_edges(&corners) {
            let n = corners.len();
            let fault = self.fault(
                "E144",
                &[path],
                format!(
                    "the polygon crosses itself: edge {}-{} meets edge {}-{}",
                    first + 1,
                    (first + 1) % n + 1,
                    second + 1,
                    (second + 1) % n + 1
                ),
            );
            fault.allowed = "a simple polygon".to_string();
            return;
        }
        let area = polygon::signed_area(&corners);
        if area == 0.0 {
            let fault = self.fault("E144", &[path], "the polygon has no area");
            fault.allowed = "corners that are not on one line".to_string();
        } else if area < 0.0 {
            let fault = self.fault("N144", &[path], "the corners run clockwise and are turned");
            fault.allowed = "counter-clockwise corners".to_string();
        }
    }

    fn suspension(&mut self) {
        let orders: [(&str, &str, bool); 5] = [
            (
                "suspension.hinge.length_mm",
                "suspension.load_beam.dimple_mm",
                true,
            ),
            (
                "suspension.load_beam.dimple_mm",
                "suspension.load_beam.end_mm",
                true,
            ),
            ("suspension.flange.from_mm", "suspension.flange.to_mm", true),
            (
                "suspension.flange.to_mm",
                "suspension.load_beam.end_mm",
                false,
            ),
            (
                "suspension.flexure.from_mm",
                "suspension.load_beam.end_mm",
                true,
            ),
        ];
        for (low, high, strict) in orders {
            if !self.sound(&[low, high]) {
                continue;
            }
            let (a, b) = (self.view.number(low), self.view.number(high));
            if a > b || (strict && a == b) {
                let sign = if strict { "<" } else { "<=" };
                let fault = self.fault(
                    "E149",
                    &[low, high],
                    format!("{low} is {a} and {high} is {b}, from the root of the hinge"),
                );
                fault.allowed = format!("{low} {sign} {high}");
            }
        }
    }

    fn pulse(&mut self, widths_ms: &[f64]) {
        if !self.sound(&["pulse.widths_ms"]) {
            return;
        }
        for &width in widths_ms {
            self.width(width);
        }
        self.sampled_pulse();
    }

    /// One pulse width, ms, against step and window.
    pub fn width(&mut self, width: f64) {
        let place = self.width_place(width);
        let width_s = unit::si("pulse.widths_ms", width);
        let step_s = scene::resolutions(self.view).structure.step_s;
        // A step that is exactly an eighth must pass whatever its decimal rounding.
        let shortest_s = STEPS_PER_PULSE * step_s * (1.0 - 1e-12);
        if self.sound(&["solver.structure_step_us", "solver.accuracy"]) && width_s < shortest_s {
            let message = format!(
                "a pulse of {width} ms is shorter than {STEPS_PER_PULSE} steps of {} us",
                trim(step_s * 1e6)
            );
            let fault = self.push(match place {
                Some(place) => StudyError::at("E151", &place, "pulse.widths_ms", message),
                None => StudyError::in_file("E151", "--pulse-ms", message),
            });
            fault.value = format!("{width}");
            fault.allowed = format!(
                "widths from {} ms, or solver.structure_step_us <= {}",
                trim(STEPS_PER_PULSE * step_s * 1e3),
                trim(width_s / STEPS_PER_PULSE * 1e6)
            );
            fault.hint = "set a smaller step".to_string();
        }
        if self.sound(&["pulse.window_ms", "pulse.window_max_ms"]) {
            let fixed = self.view.maybe_number("pulse.window_ms");
            let path = if fixed.is_some() {
                "pulse.window_ms"
            } else {
                "pulse.window_max_ms"
            };
            let end_ms = fixed.unwrap_or_else(|| self.view.number("pulse.window_max_ms"));
            if end_ms < width {
                let fault = self.fault("E152", &[path], format!(
                    "the simulation ends {end_ms} ms after the onset, inside the pulse of {width} ms"
                ));
                fault.allowed = format!(">= {width} ms");
            }
        }
    }

    /// Place of a width in the study; none when the command line named it.
    fn width_place(&self, width: f64) -> Option<Place> {
        let setting = self.view.settings.get("pulse.widths_ms")?;
        match &setting.values[0] {
            Datum::Numbers(numbers) => {
                let position = numbers.iter().position(|known| *known == width)?;
                Some(setting.place_of(position).clone())
            }
            _ => None,
        }
    }

    fn sampled_pulse(&mut self) {
        let paths = [
            "pulse.shape",
            "pulse.table",
            "pulse.table_time_ms",
            "pulse.table_relative",
        ];
        if !self.sound(&paths) || self.view.word("pulse.shape") != "table" {
            return;
        }
        if !self.view.settings.has("pulse.table_time_ms") {
            let fault = self.fault(
                "E112",
                &["pulse.shape"],
                "missing key: pulse.table, for example table = \"pulse.csv\"",
            );
            fault.key = "pulse.table".to_string();
            fault.allowed = "a file of two columns: time in ms, relative acceleration".to_string();
            return;
        }
        let (time_ms, relative) = (self.view.numbers(paths[2]), self.view.numbers(paths[3]));
        if let Some((_, message)) = samples::faults(time_ms, relative) {
            let fault = self.fault("E153", &["pulse.table", "pulse.table_time_ms"], message);
            fault.allowed = "2 samples or more, times rising from 0".to_string();
            return;
        }
        if !self.sound(&["search.amplitude_g.max"]) {
            return;
        }
        let largest = relative
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let width_ms = self
            .view
            .numbers("pulse.widths_ms")
            .iter()
            .fold(0.0_f64, |most, width| most.max(*width));
        let last = time_ms.last().copied().unwrap_or(1.0);
        let area: f64 = (1..time_ms.len())
            .map(|row| {
                0.5 * (relative[row] + relative[row - 1]) * (time_ms[row] - time_ms[row - 1])
            })
            .sum();
        let velocity = self.view.si("search.amplitude_g.max")
            * (area / largest).abs()
            * unit::si("pulse.widths_ms", width_ms)
            / last;
        if velocity > LARGEST_VELOCITY_M_PER_S {
            let fault = self.fault("W204", &["pulse.table", "pulse.table_time_ms"], format!(
                "the sampled shock changes the drive's velocity by {velocity:.0} m/s at the highest amplitude"
            ));
            fault.allowed = format!("usually below {LARGEST_VELOCITY_M_PER_S} m/s");
            fault.hint = "check that times are in ms; accept with --accept W204".to_string();
        }
    }
}

/// Whether an output needs film, slider and suspension.
pub fn needs_head(output: &str) -> bool {
    !keys::STRUCTURE_OUTPUTS.contains(&output)
}

fn repeated(words: &[String]) -> Option<&String> {
    words
        .iter()
        .enumerate()
        .find(|(position, word)| words[..*position].contains(word))
        .map(|(_, word)| word)
}

/// A number without the digits a conversion added.
fn trim(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}
