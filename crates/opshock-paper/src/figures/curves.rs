//! Draws Fig. 4 to 12: histories of a long and a short shock, a panel for each ramp model.

use super::case::{Clock, Curve, PaperCase, curve};
use super::curve_table::table;
use super::paper_figure::PaperFigure;
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_study::report::chart::{Axis, Dash, Figure, Panel, Rule, Series, colour};
use opshock_study::report::column_named;

const SLIDER_POINT: &[Curve] = &[curve(
    Clock::Disk,
    "disk_slider_m",
    "",
    1e6,
    colour::BLUE,
    Dash::Solid,
)];
const FORCES: &[Curve] = &[
    curve(
        Clock::Disk,
        "contact_top_n",
        "top arm",
        1.0,
        colour::VERMILLION,
        Dash::Solid,
    ),
    curve(
        Clock::Disk,
        "contact_bottom_n",
        "bottom arm",
        1.0,
        colour::BLUE,
        Dash::Solid,
    ),
];
// The rim goes first: it runs so close to the ramp point that it would hide it.
const RIM_AND_ARMS: &[Curve] = &[
    curve(
        Clock::Disk,
        "disk_rim_m",
        "disk rim",
        1e6,
        colour::SKY,
        Dash::Solid,
    ),
    curve(
        Clock::Disk,
        "disk_ramp_m",
        "disk at ramp",
        1e6,
        colour::BLACK,
        Dash::Solid,
    ),
    curve(
        Clock::Disk,
        "ramp_top_m",
        TOP_ARM,
        1e6,
        colour::VERMILLION,
        Dash::Dashed,
    ),
    curve(
        Clock::Disk,
        "ramp_bottom_m",
        BOTTOM_ARM,
        1e6,
        colour::GREEN,
        Dash::DashDot,
    ),
];
const TOP_ARM: &str = "top arm, where it is";
const BOTTOM_ARM: &str = "bottom arm, where it is";
const PITCHES: &[Curve] = &[
    curve(
        Clock::Disk,
        "disk_pitch_rad",
        "disk",
        1e6,
        colour::VERMILLION,
        Dash::Dashed,
    ),
    curve(
        Clock::Head,
        "slider_pitch_rad",
        "slider",
        1e6,
        colour::BLUE,
        Dash::Solid,
    ),
];
const CLEARANCE: &[Curve] = &[curve(
    Clock::Head,
    "min_clearance_m",
    "",
    1e9,
    colour::BLUE,
    Dash::Solid,
)];

/// How the ordinates of the panels of a figure go together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ordinate {
    /// One range: heights compare.
    Common,
    /// A range each, from zero: small contacts stay visible beside large ones.
    OwnFromZero,
}

struct Sheet<'a> {
    number: u8,
    title: &'a str,
    y: &'a str,
    curves: &'a [Curve],
    ordinate: Ordinate,
    /// Drawn times, ms; the whole window when left out.
    zoom_ms: Option<(f64, f64)>,
    program: &'a str,
}

/// Fig. 4: the shocks' accelerations, in G.
pub fn pulse_figure(long: &PaperCase, short: &PaperCase, program: &str) -> PaperFigure {
    let shock = curve(
        Clock::Disk,
        "shock_m_per_s2",
        "",
        1.0 / m_per_s2_from_g(1.0),
        colour::BLACK,
        Dash::Solid,
    );
    let cases = [
        ("long", long, colour::BLACK),
        ("short", short, colour::BLUE),
    ];
    let series = cases
        .map(|(_, case, colour)| Series {
            name: pulse_words(case),
            colour,
            ..series(case, &shock)
        })
        .to_vec();
    let named: Vec<(String, &PaperCase)> = cases
        .iter()
        .map(|(name, case, _)| ((*name).to_owned(), *case))
        .collect();
    PaperFigure {
        number: 4,
        shows: "acceleration of the two shocks".into(),
        figure: Figure {
            title: "Shock".into(),
            subtitle: subtitle(4, "", program),
            columns: 1,
            panel_px: (720.0, 330.0),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::linear("Time (ms)").between(0.0, long.window_ms().1),
                y: Axis::linear("Inertia load per mass (G)"),
                series,
                rules: Vec::new(),
                shaded: None,
            }],
        },
        csv: table(&named, &[shock], None),
    }
}

fn pulse_words(case: &PaperCase) -> String {
    // The caption opens with the ramp, which the pulse does not know.
    case.caption
        .shock
        .split_once(", ")
        .map_or(case.caption.shock.clone(), |(_, pulse)| pulse.to_owned())
}

/// Fig. 5 to 9: the long shock; Fig. 7 for the deformable ramp alone, when it is among the cases.
pub fn long_shock_figures(cases: &[PaperCase], program: &str) -> Vec<PaperFigure> {
    let all: Vec<&PaperCase> = cases.iter().collect();
    let mut figures = displacement_and_force(5, &all, program);
    let deformable: Vec<&PaperCase> = cases
        .iter()
        .filter(|case| case.ramp == "deformable")
        .collect();
    if !deformable.is_empty() {
        figures.push(rim_and_arms(7, &deformable, program));
    }
    let zoom = cases.first().map(|case| {
        // 0.8 to 1.5 ms of the paper's axis, whose 2 ms pulse starts at 0.5 ms.
        let at = |share: f64| 1e3 * (case.caption.start_s + share * case.caption.width_s);
        (at(0.15), at(0.5))
    });
    let pitch = Sheet {
        number: 8,
        title: "Pitch of disk and slider",
        y: "Pitch (µrad)",
        curves: PITCHES,
        ordinate: Ordinate::Common,
        zoom_ms: zoom,
        program,
    };
    figures.push(pitch.draw(&all));
    figures.push(clearance(9, &all, program));
    figures
}

/// Fig. 10 to 12: the short shock.
pub fn short_shock_figures(cases: &[PaperCase], program: &str) -> Vec<PaperFigure> {
    let all: Vec<&PaperCase> = cases.iter().collect();
    let mut figures = displacement_and_force(10, &all, program);
    figures.push(clearance(12, &all, program));
    figures
}

fn displacement_and_force(first: u8, cases: &[&PaperCase], program: &str) -> Vec<PaperFigure> {
    let displacement = Sheet {
        number: first,
        title: "Disk displacement at the slider",
        y: "Displacement (µm)",
        curves: SLIDER_POINT,
        ordinate: Ordinate::Common,
        zoom_ms: None,
        program,
    };
    let force = Sheet {
        number: first + 1,
        title: "Contact force between disk and ramp, 20 µs mean",
        y: "Force (N)",
        curves: FORCES,
        ordinate: Ordinate::OwnFromZero,
        ..displacement
    };
    vec![displacement.draw(cases), force.draw(cases)]
}

fn clearance(number: u8, cases: &[&PaperCase], program: &str) -> PaperFigure {
    let sheet = Sheet {
        number,
        title: "Minimum clearance between slider and disk",
        y: "Clearance (nm)",
        curves: CLEARANCE,
        ordinate: Ordinate::Common,
        zoom_ms: None,
        program,
    };
    let mut drawn = sheet.draw(cases);
    for (panel, case) in drawn.figure.panels.iter_mut().zip(cases) {
        panel.rules.push(Rule::Horizontal {
            y: 1e9 * case.caption.fail_below_m,
            label: "failure".into(),
        });
    }
    drawn
}

/// Disk and arms at their places: an arm stands a clearance away from the disk at rest, so that
/// contact is where a curve of the disk meets an arm's. The table holds displacements.
fn rim_and_arms(number: u8, cases: &[&PaperCase], program: &str) -> PaperFigure {
    let sheet = Sheet {
        number,
        title: "Disk rim and arms of the ramp",
        y: "Place (µm)",
        curves: RIM_AND_ARMS,
        ordinate: Ordinate::Common,
        zoom_ms: None,
        program,
    };
    let mut drawn = sheet.draw(cases);
    drawn.figure.panel_px.1 = 380.0;
    for (panel, case) in drawn.figure.panels.iter_mut().zip(cases) {
        let (top, bottom) = case.caption.ramp_clearance_m.unwrap_or_default();
        for series in &mut panel.series {
            let offset = match series.name.as_str() {
                TOP_ARM => 1e6 * top,
                BOTTOM_ARM => -1e6 * bottom,
                _ => continue,
            };
            for point in &mut series.curve {
                point.1 += offset;
            }
        }
        panel.y.range = None;
    }
    drawn
}

impl Sheet<'_> {
    fn draw(&self, cases: &[&PaperCase]) -> PaperFigure {
        let of = |case: &PaperCase| -> Vec<Series> {
            let curves = self.curves.iter();
            curves.map(|curve| series(case, curve)).collect()
        };
        let drawn: Vec<Vec<Series>> = cases.iter().map(|case| of(case)).collect();
        let window = |case: &PaperCase| self.zoom_ms.unwrap_or_else(|| case.window_ms());
        let visible = |case: &PaperCase, series: &[Series]| range(series, window(case));
        let common = cases
            .iter()
            .zip(&drawn)
            .filter_map(|(case, series)| visible(case, series))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let panels: Vec<Panel> = cases
            .iter()
            .zip(drawn)
            .map(|(case, series)| {
                let own = visible(case, &series);
                let (low, high) = match self.ordinate {
                    Ordinate::Common => common.map_or((0.0, 1.0), with_margin),
                    Ordinate::OwnFromZero => {
                        let largest = |range: Option<(f64, f64)>| range.map_or(0.0, |r| r.1);
                        let own = largest(own);
                        // Without contact the axis says what a contact would look like elsewhere.
                        let top = if own > 0.0 { own } else { largest(common) };
                        (0.0, if top > 0.0 { 1.08 * top } else { 1.0 })
                    }
                };
                let pulse = &case.caption;
                Panel {
                    title: case.heading(),
                    x: Axis::linear("Time (ms); shaded: pulse")
                        .between(window(case).0, window(case).1),
                    y: Axis::linear(self.y).between(low, high),
                    series,
                    rules: pulse
                        .t_fail_s
                        .map(|time| Rule::Vertical {
                            x: 1e3 * time,
                            label: "slider touches disk".into(),
                        })
                        .into_iter()
                        .collect(),
                    shaded: Some((1e3 * pulse.start_s, 1e3 * (pulse.start_s + pulse.width_s))),
                }
            })
            .collect();
        let pulse = cases
            .first()
            .map_or(String::new(), |case| pulse_words(case));
        let named: Vec<(String, &PaperCase)> = cases
            .iter()
            .map(|case| (case.ramp.clone(), *case))
            .collect();
        PaperFigure {
            number: self.number,
            shows: format!("{}; {pulse}", self.title.to_lowercase()),
            figure: Figure {
                title: self.title.into(),
                subtitle: subtitle(self.number, &pulse, self.program),
                columns: 1,
                panel_px: (720.0, 230.0),
                panels,
            },
            csv: table(&named, self.curves, self.zoom_ms),
        }
    }
}

fn subtitle(number: u8, pulse: &str, program: &str) -> String {
    let pulse = match pulse {
        "" => String::new(),
        pulse => format!("{pulse}; "),
    };
    format!("{pulse}after the paper's Fig. {number}   [{program}]")
}

fn series(case: &PaperCase, curve: &Curve) -> Series {
    let columns = case.columns(curve.clock);
    let time = &column_named(columns, "time_s").values;
    let values = &column_named(columns, curve.column).values;
    let points = time
        .iter()
        .zip(values)
        .map(|(t, v)| (1e3 * t, curve.factor * v))
        .collect();
    Series::curve(curve.name, curve.colour, curve.dash, points)
}

/// Smallest and largest ordinate inside the window.
fn range(series: &[Series], (from, to): (f64, f64)) -> Option<(f64, f64)> {
    series
        .iter()
        .flat_map(|series| &series.curve)
        .filter(|(x, y)| (from..=to).contains(x) && y.is_finite())
        .map(|&(_, y)| (y, y))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn with_margin((low, high): (f64, f64)) -> (f64, f64) {
    let margin = if high > low {
        0.06 * (high - low)
    } else {
        0.1 * low.abs().max(1e-12)
    };
    (low - margin, high + margin)
}
