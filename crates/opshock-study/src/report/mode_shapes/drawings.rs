//! Draws the modes along one line of each body, with a table of the numbers drawn.

use super::grids::numbered;
use super::shapes::{DiskShapes, HeadShapes, ModeShapes, RampShapes};
use crate::report::chart::{
    Axis, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value, colour,
};
use opshock_solver::suspension::SuspensionShapes;

/// A picture with the table it was drawn from.
pub(super) struct Drawing {
    /// File name without ending.
    pub name: &'static str,
    /// Picture.
    pub figure: Figure,
    /// CSV.
    pub table: String,
}

/// Curves in a panel of disk or suspension, the lowest modes; tables and grids have all of them.
const CURVES: usize = colour::CYCLE.len();

/// Ordinate of all drawings.
const SHAPE: &str = "Shape at unit modal mass (1/√kg)";

pub(super) fn all(shapes: &ModeShapes) -> Vec<Drawing> {
    let study = &shapes.study;
    let mut all = vec![disk(&shapes.disk, study)];
    all.extend(shapes.ramp.iter().map(|shapes| ramp(shapes, study)));
    let of_suspension = |shapes| suspension(shapes, study);
    all.extend(shapes.suspension.iter().map(of_suspension));
    all.push(head(&shapes.head, study));
    all
}

fn figure(title: &str, study: &str, panels: Vec<Panel>) -> Figure {
    Figure {
        title: title.into(),
        subtitle: study.into(),
        columns: panels.len().clamp(1, 2),
        panel_px: (if panels.len() > 1 { 470.0 } else { 720.0 }, 330.0),
        panels,
    }
}

fn panel(title: String, x: Axis, series: Vec<Series>) -> Panel {
    Panel {
        title,
        x,
        y: Axis::linear(SHAPE),
        series,
        rules: vec![Rule::Horizontal {
            y: 0.0,
            label: String::new(),
        }],
        shaded: None,
    }
}

/// Colour of series `k`.
fn coloured(k: usize) -> colour::Rgb {
    colour::CYCLE[k % colour::CYCLE.len()]
}

/// Rows of numbers below names.
fn csv(names: &[String], rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let mut text = names.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = row.iter().map(|value| format!("{value:e}")).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// φ along a radius: a panel for each number of nodal circles, a curve for each of nodal diameters.
fn disk(disk: &DiskShapes, study: &str) -> Drawing {
    let most = disk.modes.iter().map(|mode| mode.nodal_circles).max();
    let panels = (0..=most.unwrap_or(0)).map(|circles| {
        let drawn = |n: usize| n < CURVES;
        let here = disk.modes.iter().filter(|m| m.nodal_circles == circles);
        let here = here.filter(|m| drawn(m.nodal_diameters));
        let mut here: Vec<_> = here.collect();
        here.sort_by_key(|mode| mode.nodal_diameters);
        let series = here.iter().map(|mode| {
            let n = mode.nodal_diameters;
            let radii = disk.radii_m.iter().map(|r| 1e3 * r);
            let curve = radii.zip(mode.radial_per_sqrt_kg.iter().copied());
            Series::curve(
                &format!("n = {n}"),
                coloured(n),
                Dash::Solid,
                curve.collect(),
            )
        });
        let title = format!("Nodal circles: {circles}; curves: nodal diameters n");
        panel(title, Axis::linear("Radius (mm)"), series.collect())
    });
    let name = |m: &super::shapes::DiskShape| {
        format!("n{}_c{}_per_sqrt_kg", m.nodal_diameters, m.nodal_circles)
    };
    let mut names = vec!["radius_m".to_owned()];
    names.extend(disk.modes.iter().map(name));
    let columns = disk.modes.iter().map(|mode| &mode.radial_per_sqrt_kg[..]);
    let rows = rows_of(&disk.radii_m, columns);
    Drawing {
        name: "disk_modes",
        figure: figure("Modes of the disk", study, panels.collect()),
        table: csv(&names, rows),
    }
}

/// Rows of a table: a place, and every mode's motion there.
fn rows_of<'a>(
    places: &'a [f64],
    columns: impl Iterator<Item = &'a [f64]> + Clone,
) -> impl Iterator<Item = Vec<f64>> {
    places.iter().enumerate().map(move |(i, place)| {
        let motions = columns.clone().map(|column| column[i]);
        std::iter::once(*place).chain(motions).collect()
    })
}

/// Motion of both contacts against frequency.
fn ramp(shapes: &RampShapes, study: &str) -> Drawing {
    let modes: Vec<(f64, [f64; 2])> = match shapes {
        RampShapes::Contacts { modes, .. } => modes
            .iter()
            .map(|mode| (mode.frequency_hz, mode.contact_per_sqrt_kg))
            .collect(),
        RampShapes::Solid { modes, .. } => modes
            .iter()
            .map(|m| (m.mode.frequency_hz, [m.mode.shape[0], m.mode.shape[1]]))
            .collect(),
    };
    let kinds = [
        ("top contact", colour::VERMILLION, Marker::Circle),
        ("bottom contact", colour::BLUE, Marker::Square),
    ];
    let series = kinds
        .iter()
        .enumerate()
        .map(|(arm, (name, colour, marker))| {
            let samples = modes.iter().map(|(hz, shape)| Sample {
                x: 1e-3 * hz,
                value: Value::Known {
                    y: shape[arm],
                    low: shape[arm],
                    high: shape[arm],
                },
                open: false,
                note: format!("{hz:.1} Hz"),
            });
            Series::marked(
                name,
                *colour,
                None,
                (*marker, Fill::Full),
                samples.collect(),
            )
        });
    let axis = Axis::log("Frequency (kHz)");
    let only = panel(String::new(), axis, series.collect());
    let names = ["frequency_hz", "top_per_sqrt_kg", "bottom_per_sqrt_kg"].map(str::to_owned);
    let rows = modes
        .iter()
        .map(|(hz, [top, bottom])| vec![*hz, *top, *bottom]);
    Drawing {
        name: "ramp_modes",
        figure: figure("Modes of the ramp", study, vec![only]),
        table: csv(&names, rows),
    }
}

/// Rise, or twist, along the axis.
fn suspension(shapes: &SuspensionShapes, study: &str) -> Drawing {
    let titles = [
        ("bending_free", "Bending, dimple free"),
        ("bending_pinned", "Bending, dimple held"),
        ("torsion_free", "Torsion, dimple free"),
        ("torsion_pinned", "Torsion, dimple held"),
    ];
    let panels = titles.map(|(wanted, title)| {
        let of_family =
            numbered(shapes).filter(|(family, number, _)| *family == wanted && *number <= CURVES);
        let mut frequencies = Vec::new();
        let series: Vec<Series> = of_family
            .map(|(_, number, mode)| {
                frequencies.push(format!("{:.1}", 1e-3 * mode.frequency_hz));
                let places = shapes.places_m.iter().map(|x| 1e3 * x);
                let curve = places.zip(mode.shape.iter().copied()).collect();
                let k = number - 1;
                Series::curve(&format!("mode {number}"), coloured(k), Dash::Solid, curve)
            })
            .collect();
        let title = format!("{title}: {} kHz", frequencies.join(", "));
        let mut panel = panel(title, Axis::linear("From the root (mm)"), series);
        if wanted.starts_with("torsion") {
            panel.y = Axis::linear("Twist at unit modal mass (1/(m √kg))");
        }
        panel
    });
    let unit = |is_bending| {
        if is_bending {
            "per_sqrt_kg"
        } else {
            "per_m_sqrt_kg"
        }
    };
    let mut names = vec!["place_m".to_owned()];
    names.extend(numbered(shapes).map(|(f, k, m)| format!("{f}_{k}_{}", unit(m.is_bending))));
    let columns = shapes.modes.iter().map(|mode| &mode.shape[..]);
    let rows = rows_of(&shapes.places_m, columns);
    Drawing {
        name: "suspension_modes",
        figure: figure("Modes of the suspension", study, panels.into()),
        table: csv(&names, rows),
    }
}

/// Rise along and across the slider, through its centre.
fn head(head: &HeadShapes, study: &str) -> Drawing {
    let lines = [
        ("Along the slider", head.length_m, [1.0, 0.0]),
        ("Across the slider", head.width_m, [0.0, 1.0]),
    ];
    let panels = lines.map(|(title, length_m, [along, across])| {
        let mut series = Vec::new();
        for (k, mode) in head.modes.iter().enumerate() {
            for (part, dash) in [("real", Dash::Solid), ("imaginary", Dash::Dashed)] {
                let curve = [-0.5 * length_m, 0.5 * length_m].map(|s| {
                    let rise = mode.rise(s * along, s * across);
                    let rise = if part == "real" { rise.re } else { rise.im };
                    (1e3 * s, rise)
                });
                let name = format!("{:.1} kHz, {part}", 1e-3 * mode.frequency_hz);
                series.push(Series::curve(&name, coloured(k), dash, curve.into()));
            }
        }
        panel(title.into(), Axis::linear("From the centre (mm)"), series)
    });
    let mut names = vec!["frequency_hz".to_owned()];
    for (what, unit) in [
        ("height", "per_sqrt_kg"),
        ("pitch", "per_m_sqrt_kg"),
        ("roll", "per_m_sqrt_kg"),
    ] {
        names.extend(["real", "imaginary"].map(|part| format!("{what}_{part}_{unit}")));
    }
    let rows = head.modes.iter().map(|mode| {
        let mut row = vec![mode.frequency_hz];
        row.extend(mode.shape.iter().flat_map(|value| [value.re, value.im]));
        row
    });
    Drawing {
        name: "head_modes",
        figure: figure("Modes of the slider on its film", study, panels.into()),
        table: csv(&names, rows),
    }
}
