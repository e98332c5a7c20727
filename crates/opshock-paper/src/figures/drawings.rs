//! Draws Fig. 1 to 3: the drive and the ramp models, to scale, from the scene's own numbers.
//!
//! A scene knows of the ramp only where it may touch the disk and how far away; blocks, springs
//! and frame around the contact points are schematic.

use super::paper_figure::PaperFigure;
use opshock_solver::disk::DiskParameters;
use opshock_solver::ramp::{ArmMode, RampParameters};
use opshock_solver::scene::Scene;
use opshock_solver::slider::SliderParameters;
use opshock_study::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Sample, Series, Value, colour,
};
use std::f64::consts::TAU;

/// A named outline; the table of a drawing lists the corners of all of them.
struct Outline {
    name: String,
    colour: colour::Rgb,
    dash: Dash,
    width: f64,
    /// Corners, m; closed when the last is the first.
    corners_m: Vec<(f64, f64)>,
}

/// Fig. 1: disk, slider with its suspension, and ramp seen from the slider's side.
pub fn plan_drawing(scene: &Scene, program: &str) -> PaperFigure {
    let disk = &scene.disk;
    let slider = &scene.slider;
    let mut outlines = vec![
        outline("disk", colour::BLACK, circle(disk.outer_radius_m)),
        outline("clamp", colour::GREY, circle(disk.inner_radius_m)),
        Outline {
            dash: Dash::Dotted,
            ..outline("slider's track", colour::GREY, circle(slider.radius_m))
        },
        Outline {
            width: 2.2,
            ..outline("spin", colour::GREEN, spin_arrow(disk))
        },
        outline("suspension", colour::BLUE, suspension(scene)),
        Outline {
            width: 2.2,
            ..outline("slider", colour::VERMILLION, slider_outline(scene))
        },
    ];
    let mut marks = Vec::new();
    if !scene.ramp.model.is_absent() {
        let ramp = &scene.ramp;
        outlines.push(Outline {
            width: 2.2,
            ..outline("ramp (schematic)", colour::PURPLE, ramp_in_plan(disk, ramp))
        });
        marks.push((
            "contact point",
            polar(ramp.radius_m, ramp.angle_rad),
            colour::PURPLE,
        ));
    }
    let shows = format!(
        "plan view of the drive: disk {:.1} to {:.1} mm, slider at {:.2} mm and {:.0}°, ramp at {:.2} mm and {:.0}°",
        1e3 * disk.inner_radius_m,
        1e3 * disk.outer_radius_m,
        1e3 * slider.radius_m,
        slider.angle_rad.to_degrees(),
        1e3 * scene.ramp.radius_m,
        scene.ramp.angle_rad.to_degrees(),
    );
    drawing(
        1,
        "Drive in plan",
        shows,
        ("x (mm)", "y (mm)"),
        (640.0, 640.0),
        outlines,
        &marks,
        program,
    )
}

/// Fig. 2: the rigid ramp in section through its contact points.
pub fn rigid_ramp_drawing(scene: &Scene, program: &str) -> PaperFigure {
    let section = Section::of(scene);
    let mut outlines = section.disk();
    let reach = section.base();
    for side in SIDES {
        outlines.push(section.block(side, reach, "rigid ramp (schematic)"));
    }
    outlines.push(section.frame("base"));
    let shows = format!("rigid ramp in section: {}", section.words());
    section.draw(2, "Rigid ramp", shows, outlines, program)
}

/// Fig. 3: the deformable ramp: each arm's contact point on its modes.
pub fn deformable_ramp_drawing(scene: &Scene, program: &str) -> PaperFigure {
    let section = Section::of(scene);
    let mut outlines = section.disk();
    let ramp = &scene.ramp.model;
    let modes: [Vec<ArmMode>; 2] = ramp.arms().unwrap_or_else(|| {
        // Each arm as it moves alone; more springs could not be distinguished.
        let of = |arm| {
            ramp.modes()
                .iter()
                .filter_map(move |mode| mode.at_contact(arm))
        };
        [0, 1].map(|arm| of(arm).take(3).collect())
    });
    for side in SIDES {
        outlines.push(section.block(side, section.arm_end(), "arm (schematic)"));
    }
    outlines.push(section.frame("base"));
    let colours = [
        colour::VERMILLION,
        colour::GREEN,
        colour::PURPLE,
        colour::ORANGE,
    ];
    for (side, modes) in SIDES.into_iter().zip(modes) {
        for (index, mode) in modes.iter().enumerate() {
            outlines.push(Outline {
                colour: colours[index % colours.len()],
                ..section.spring(side, (index, modes.len()), &mode_words(mode))
            });
        }
    }
    let shows = format!("deformable ramp in section: {}", section.words());
    section.draw(3, "Deformable ramp", shows, outlines, program)
}

fn mode_words(mode: &ArmMode) -> String {
    format!(
        "mode {:.0} Hz, {:.1} mg, participation {:.3}, damping {:.1} %",
        mode.frequency_hz,
        1e6 * mode.mass_kg,
        mode.participation,
        100.0 * mode.damping_ratio
    )
}

/// Top and bottom: sign of z.
const SIDES: [f64; 2] = [1.0, -1.0];

/// Radial section at the ramp's angle: abscissa radius, ordinate height over the disk's middle.
struct Section<'a> {
    disk: &'a DiskParameters,
    ramp: &'a RampParameters,
}

impl<'a> Section<'a> {
    fn of(scene: &'a Scene) -> Self {
        Self {
            disk: &scene.disk,
            ramp: &scene.ramp,
        }
    }

    fn words(&self) -> String {
        let (top, bottom) = (self.ramp.clearance_top_m, self.ramp.clearance_bottom_m);
        format!(
            "clearance g0 {:.0} µm above and {:.0} µm below, contact at {:.2} mm, rim at {:.2} mm, disk {:.3} mm thick",
            1e6 * top,
            1e6 * bottom,
            1e3 * self.ramp.radius_m,
            1e3 * self.disk.outer_radius_m,
            1e3 * self.disk.thickness_m
        )
    }

    /// The disk from three thicknesses inside the contact to the rim; the inner end is cut.
    fn disk(&self) -> Vec<Outline> {
        let half = 0.5 * self.disk.thickness_m;
        let inner = self.ramp.radius_m - 3.0 * self.disk.thickness_m;
        let rim = self.disk.outer_radius_m;
        let body = vec![(inner, half), (rim, half), (rim, -half), (inner, -half)];
        vec![Outline {
            width: 2.2,
            ..outline("disk", colour::BLACK, body)
        }]
    }

    /// Height of an arm's contact point at rest.
    fn contact(&self, side: f64) -> f64 {
        let clearance = match side > 0.0 {
            true => self.ramp.clearance_top_m,
            false => self.ramp.clearance_bottom_m,
        };
        side * (0.5 * self.disk.thickness_m + clearance)
    }

    /// Radius where a flexible arm's block ends.
    fn arm_end(&self) -> f64 {
        self.ramp.radius_m + 2.0 * self.disk.thickness_m
    }

    /// Radius where the base begins.
    fn base(&self) -> f64 {
        self.ramp.radius_m + 3.4 * self.disk.thickness_m
    }

    /// A block whose tip is the contact point and which ends at the radius `outside`.
    fn block(&self, side: f64, outside: f64, name: &str) -> Outline {
        let h = self.disk.thickness_m;
        let (r, z) = (self.ramp.radius_m, self.contact(side));
        let (near, far) = (z + side * 0.25 * h, z + side * 0.6 * h);
        let inside = r - 0.4 * h;
        Outline {
            width: 2.0,
            ..outline(
                name,
                colour::BLUE,
                vec![
                    (r, z),
                    (inside, near),
                    (inside, far),
                    (outside, far),
                    (outside, near),
                    (r + 0.4 * h, near),
                    (r, z),
                ],
            )
        }
    }

    /// The base behind both arms.
    fn frame(&self, name: &str) -> Outline {
        let h = self.disk.thickness_m;
        let left = self.base();
        let (top, bottom) = (self.contact(1.0) + 0.9 * h, self.contact(-1.0) - 0.9 * h);
        let corners = vec![
            (left, top),
            (left + 0.35 * h, top),
            (left + 0.35 * h, bottom),
            (left, bottom),
            (left, top),
        ];
        Outline {
            width: 2.0,
            ..outline(name, colour::GREY, corners)
        }
    }

    /// A mode as a spring between block and base; several share the block's height.
    fn spring(&self, side: f64, (index, count): (usize, usize), name: &str) -> Outline {
        let h = self.disk.thickness_m;
        let (from, to) = (self.arm_end(), self.base());
        let share = (index as f64 + 0.5) / count as f64;
        let middle = self.contact(side) + side * (0.15 + 0.55 * share) * h;
        let amplitude = 0.2 * h / count as f64;
        let teeth = 8;
        let mut corners = vec![(from, middle)];
        for tooth in 0..teeth {
            let x = from + (to - from) * (0.15 + 0.7 * (f64::from(tooth) + 0.5) / f64::from(teeth));
            let up = if tooth % 2 == 0 { 1.0 } else { -1.0 };
            corners.push((x, middle + up * amplitude));
        }
        corners.push((to, middle));
        outline(name, colour::BLUE, corners)
    }

    fn draw(
        &self,
        number: u8,
        title: &str,
        shows: String,
        outlines: Vec<Outline>,
        program: &str,
    ) -> PaperFigure {
        let r = self.ramp.radius_m;
        let marks = SIDES.map(|side| ("contact point", (r, self.contact(side)), colour::PURPLE));
        drawing(
            number,
            title,
            shows,
            ("Radius (mm)", "Height over the disk's middle (mm)"),
            (820.0, 420.0),
            outlines,
            &marks,
            program,
        )
    }
}

#[expect(clippy::too_many_arguments, reason = "one call site a figure")]
fn drawing(
    number: u8,
    title: &str,
    shows: String,
    (x, y): (&str, &str),
    panel_px: (f64, f64),
    outlines: Vec<Outline>,
    marks: &[(&str, (f64, f64), colour::Rgb)],
    program: &str,
) -> PaperFigure {
    let mm = |(x, y): (f64, f64)| (1e3 * x, 1e3 * y);
    let mut series: Vec<Series> = outlines
        .iter()
        .map(|outline| Series {
            width: outline.width,
            ..Series::curve(
                &outline.name,
                outline.colour,
                outline.dash,
                outline.corners_m.iter().copied().map(mm).collect(),
            )
        })
        .collect();
    series.extend(marks.iter().map(|&(name, at, colour)| {
        let (x, y) = mm(at);
        let sample = Sample {
            x,
            value: Value::Known { y, low: y, high: y },
            open: false,
            note: name.to_owned(),
        };
        Series::marked(
            name,
            colour,
            None,
            (Marker::Circle, Fill::Full),
            vec![sample],
        )
    }));
    PaperFigure {
        number,
        csv: corners_csv(&outlines, marks),
        figure: Figure {
            title: title.into(),
            subtitle: format!("to scale; after the paper's Fig. {number}   [{program}]"),
            columns: 1,
            panel_px,
            panels: vec![Panel {
                title: String::new(),
                x: Axis::linear(x),
                y: Axis::linear(y).true_to_scale(),
                series,
                rules: Vec::new(),
                shaded: None,
            }],
        },
        shows,
    }
}

fn corners_csv(outlines: &[Outline], marks: &[(&str, (f64, f64), colour::Rgb)]) -> String {
    let mut text = String::from("outline,part,x_m,y_m\n");
    let parts = outlines
        .iter()
        .map(|outline| (outline.name.as_str(), outline.corners_m.clone()))
        .chain(marks.iter().map(|&(name, at, _)| (name, vec![at])));
    for (part, (outline, corners)) in parts.enumerate() {
        for (x, y) in corners {
            text.push_str(&format!("\"{outline}\",{part},{x:e},{y:e}\n"));
        }
    }
    text
}

fn outline(name: &str, colour: colour::Rgb, corners_m: Vec<(f64, f64)>) -> Outline {
    Outline {
        name: name.into(),
        colour,
        dash: Dash::Solid,
        width: 1.6,
        corners_m,
    }
}

fn polar(radius: f64, angle: f64) -> (f64, f64) {
    (radius * angle.cos(), radius * angle.sin())
}

fn circle(radius: f64) -> Vec<(f64, f64)> {
    arc(radius, 0.0, TAU)
}

fn arc(radius: f64, from: f64, to: f64) -> Vec<(f64, f64)> {
    let pieces = 180;
    (0..=pieces)
        .map(|k| {
            polar(
                radius,
                from + (to - from) * f64::from(k) / f64::from(pieces),
            )
        })
        .collect()
}

/// A quarter turn opposite the ramp, with a head, in the sense of the spin.
fn spin_arrow(disk: &DiskParameters) -> Vec<(f64, f64)> {
    let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
    let radius = 0.5 * (disk.inner_radius_m + disk.outer_radius_m);
    let (middle, half) = (0.5 * TAU, 0.125 * TAU);
    let mut corners = arc(radius, middle - sense * half, middle + sense * half);
    let tip = middle + sense * half;
    let back = tip - sense * 0.02 * TAU;
    corners.push(polar(1.06 * radius, back));
    corners.push(polar(radius, tip));
    corners.push(polar(0.94 * radius, back));
    corners
}

/// Slider axes in plan: x along the disk's velocity rotated by the skew, y outwards.
fn slider_axes(disk: &DiskParameters, slider: &SliderParameters) -> [(f64, f64); 2] {
    let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
    let (sin, cos) = slider.angle_rad.sin_cos();
    let (along, out) = ((-sense * sin, sense * cos), (cos, sin));
    let (s, c) = slider.skew_rad.sin_cos();
    [
        (c * along.0 - s * out.0, c * along.1 - s * out.1),
        (s * along.0 + c * out.0, s * along.1 + c * out.1),
    ]
}

/// Corners given in slider axes from the slider's centre.
fn placed(scene: &Scene, corners: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let [x, y] = slider_axes(&scene.disk, &scene.slider);
    let centre = polar(scene.slider.radius_m, scene.slider.angle_rad);
    corners
        .iter()
        .map(|(a, b)| (centre.0 + a * x.0 + b * y.0, centre.1 + a * x.1 + b * y.1))
        .collect()
}

fn slider_outline(scene: &Scene) -> Vec<(f64, f64)> {
    let (l, w) = (0.5 * scene.slider.length_m, 0.5 * scene.slider.width_m);
    placed(scene, &[(-l, -w), (l, -w), (l, w), (-l, w), (-l, -w)])
}

/// Hinge, tapering load beam and tab; the dimple is over the slider's centre, the root upstream.
fn suspension(scene: &Scene) -> Vec<(f64, f64)> {
    let (hinge, beam) = (&scene.suspension.hinge, &scene.suspension.load_beam);
    let stations = [
        (0.0, hinge.width_m),
        (hinge.length_m, hinge.width_m),
        (hinge.length_m, beam.width_root_m),
        (beam.dimple_m, beam.width_dimple_m),
        (beam.dimple_m, beam.tab_width_m),
        (beam.end_m, beam.tab_width_m),
    ];
    let side =
        |sign: f64| stations.map(|(along, width)| (along - beam.dimple_m, 0.5 * sign * width));
    let mut corners = side(1.0).to_vec();
    corners.extend(side(-1.0).iter().rev());
    corners.push(corners[0]);
    placed(scene, &corners)
}

/// A block over the rim at the ramp's angle, from the contact point outwards.
fn ramp_in_plan(disk: &DiskParameters, ramp: &RampParameters) -> Vec<(f64, f64)> {
    let reach = 0.12 * disk.outer_radius_m;
    let (sin, cos) = ramp.angle_rad.sin_cos();
    let at = |r: f64, t: f64| (r * cos - t * sin, r * sin + t * cos);
    let (near, far) = (ramp.radius_m, disk.outer_radius_m + reach);
    let half = 0.25 * reach;
    vec![
        at(near, -half),
        at(far, -half),
        at(far, half),
        at(near, half),
        at(near, -half),
    ]
}
