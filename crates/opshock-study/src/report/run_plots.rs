//! Plots one simulation against time.

use super::chart::{Axis, Dash, Figure, Panel, Rule, Series, colour};
use super::error::ReportError;
use crate::store::aside::write_all;
use crate::store::history::{Column, head_columns, root_columns, structure_columns};
use opshock_solver::simulation::History;
use std::path::{Path, PathBuf};

/// What the pictures say about the simulation beside the curves.
#[derive(Clone, Debug, PartialEq)]
pub struct RunCaption {
    /// Ramp, amplitude, width and sign in words.
    pub shock: String,
    /// Onset of the pulse on the study's axis, s.
    pub start_s: f64,
    /// Width of the pulse, s.
    pub width_s: f64,
    /// Time of failure on the study's axis, s.
    pub t_fail_s: Option<f64>,
    /// That is damage, and no touch.
    pub fails_by_damage: bool,
    /// Clearance between disk and top and bottom arm at rest, m; `None` without a ramp.
    pub ramp_clearance_m: Option<(f64, f64)>,
    /// Clearance at which the slider touches, m: the failure, unless that is damage.
    pub fail_below_m: f64,
}

/// A picture with the table it was drawn from.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFigure {
    /// File name without ending.
    pub name: &'static str,
    /// Picture.
    pub figure: Figure,
    /// Columns of its table, time first.
    pub table: Vec<Column>,
}

/// The pictures of a run: shock, disk displacement with the ramp's, contact forces, pitch and roll of disk and
/// slider, minimum clearance, dimple and bearing force. The head's are left out when it was not
/// simulated.
pub fn run_figures(history: &History, caption: &RunCaption) -> Vec<NamedFigure> {
    let structure = structure_columns(&history.structure, caption.start_s);
    let head = head_columns(&history.head, caption.start_s);
    let window = match (structure[0].values.first(), structure[0].values.last()) {
        (Some(first), Some(last)) => (1e3 * first, 1e3 * last),
        _ => return Vec::new(),
    };
    let draw = Drawing { caption, window };
    let mut figures = vec![
        draw.figure(
            "shock",
            "Shock",
            "Inertia load per mass (m/s²)",
            &structure,
            &[("shock_m_per_s2", "shock", 1.0, colour::BLACK, Dash::Solid)],
        ),
        draw.disk_displacement(&structure),
        draw.figure(
            "contact_force",
            "Contact between disk and ramp",
            "Contact force, 20 µs mean (N)",
            &structure,
            &[
                (
                    "contact_top_n",
                    "top arm",
                    1.0,
                    colour::VERMILLION,
                    Dash::Solid,
                ),
                (
                    "contact_bottom_n",
                    "bottom arm",
                    1.0,
                    colour::BLUE,
                    Dash::Solid,
                ),
            ],
        ),
    ];
    if !history.structure.hub_axial_m.is_empty() {
        figures.push(draw.hub(&structure));
    }
    if history.head.time_s.is_empty() {
        figures.push(draw.figure(
            "disk_slope",
            "Slope of the disk under the slider",
            "Angle (µrad)",
            &structure,
            &[
                (
                    "disk_pitch_rad",
                    "disk pitch",
                    1e6,
                    colour::BLUE,
                    Dash::Solid,
                ),
                (
                    "disk_roll_rad",
                    "disk roll",
                    1e6,
                    colour::VERMILLION,
                    Dash::Solid,
                ),
            ],
        ));
        return figures;
    }
    let root = root_columns(history, caption.start_s);
    figures.push(draw.angles("pitch", &structure, &head, &root));
    figures.push(draw.angles("roll", &structure, &head, &root));
    figures.push(draw.clearance(&head));
    figures.push(draw.figure(
        "head_force",
        "Forces on the slider",
        "Force (mN)",
        &head,
        &[
            (
                "dimple_force_n",
                "dimple contact",
                1e3,
                colour::BLUE,
                Dash::Solid,
            ),
            (
                "bearing_force_n",
                "air bearing",
                1e3,
                colour::BLACK,
                Dash::Dashed,
            ),
        ],
    ));
    if !history.head.asperity_force_n.is_empty() {
        let force = ("asperity_force_n", "", 1.0, colour::VERMILLION, Dash::Solid);
        figures.push(draw.figure(
            "slider_contact",
            "Contact of slider and disk",
            "Force of the asperities (N)",
            &head,
            &[force],
        ));
    }
    figures
}

/// Column, name in the legend, factor to the unit of the axis, colour, dash.
type Curve<'a> = (&'a str, &'a str, f64, colour::Rgb, Dash);

struct Drawing<'a> {
    caption: &'a RunCaption,
    /// Drawn times, ms.
    window: (f64, f64),
}

impl Drawing<'_> {
    fn figure(
        &self,
        name: &'static str,
        title: &str,
        y: &str,
        columns: &[Column],
        curves: &[Curve<'_>],
    ) -> NamedFigure {
        let series = curves.iter().map(|curve| series(columns, *curve)).collect();
        NamedFigure {
            name,
            figure: self.one_panel(title, y, series),
            table: std::iter::once("time_s")
                .chain(curves.iter().map(|curve| curve.0))
                .map(|name| column_named(columns, name).clone())
                .collect(),
        }
    }

    fn one_panel(&self, title: &str, y: &str, series: Vec<Series>) -> Figure {
        let caption = self.caption;
        let mut rules = Vec::new();
        if let Some(time) = caption.t_fail_s {
            rules.push(Rule::Vertical {
                x: 1e3 * time,
                label: match caption.fails_by_damage {
                    true => "damage".into(),
                    false => "slider touches disk".into(),
                },
            });
        }
        Figure {
            title: title.into(),
            subtitle: caption.shock.clone(),
            columns: 1,
            panel_px: (720.0, 330.0),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::linear("Time (ms); shaded: pulse").between(self.window.0, self.window.1),
                y: Axis::linear(y),
                series,
                rules,
                shaded: Some((
                    1e3 * caption.start_s,
                    1e3 * (caption.start_s + caption.width_s),
                )),
            }],
        }
    }

    /// Axial travel and tilts of the hub on one axis.
    fn hub(&self, structure: &[Column]) -> NamedFigure {
        let (across, along) = (colour::VERMILLION, colour::BLUE);
        let curves = [
            (
                "hub_axial_m",
                "travel (µm)",
                1e6,
                colour::BLACK,
                Dash::Solid,
            ),
            (
                "hub_tilt_ramp_rad",
                "tilt at the ramp (µrad)",
                1e6,
                along,
                Dash::Solid,
            ),
            (
                "hub_tilt_across_rad",
                "tilt a quarter turn on (µrad)",
                1e6,
                across,
                Dash::Dashed,
            ),
        ];
        let title = "Travel and tilt of the hub";
        self.figure("hub", title, "Travel (µm), tilt (µrad)", structure, &curves)
    }

    fn disk_displacement(&self, structure: &[Column]) -> NamedFigure {
        // The rim goes first: it runs so close to the ramp point that it would hide it.
        let mut curves = vec![
            ("disk_rim_m", "disk rim", 1e6, colour::SKY, Dash::Solid),
            (
                "disk_ramp_m",
                "disk at ramp",
                1e6,
                colour::BLACK,
                Dash::Solid,
            ),
            (
                "disk_slider_m",
                "disk at slider",
                1e6,
                colour::BLUE,
                Dash::Solid,
            ),
        ];
        if self.caption.ramp_clearance_m.is_some() {
            curves.push((
                "ramp_top_m",
                "top arm",
                1e6,
                colour::VERMILLION,
                Dash::Dashed,
            ));
            curves.push((
                "ramp_bottom_m",
                "bottom arm",
                1e6,
                colour::GREEN,
                Dash::DashDot,
            ));
        }
        let mut named = self.figure(
            "disk_displacement",
            "Displacement of disk and ramp",
            "Displacement (µm)",
            structure,
            &curves,
        );
        if let Some((top, bottom)) = self.caption.ramp_clearance_m {
            // The arms are drawn where they are, a clearance away from the disk at rest: contact
            // is where a curve of the disk meets an arm's.
            for series in &mut named.figure.panels[0].series {
                let offset = match series.name.as_str() {
                    "top arm" => 1e6 * top,
                    "bottom arm" => -1e6 * bottom,
                    _ => continue,
                };
                for point in &mut series.curve {
                    point.1 += offset;
                }
            }
        }
        named
    }

    fn angles(
        &self,
        angle: &'static str,
        structure: &[Column],
        head: &[Column],
        root: &[Column],
    ) -> NamedFigure {
        let (name, title, disk, slider) = match angle {
            "pitch" => (
                "pitch",
                "Pitch of disk and slider",
                "disk_pitch_rad",
                "slider_pitch_rad",
            ),
            _ => (
                "roll",
                "Roll of disk and slider",
                "disk_roll_rad",
                "slider_roll_rad",
            ),
        };
        let of_disk = series(structure, (disk, "disk", 1e6, colour::BLUE, Dash::Dashed));
        let of_slider = series(
            head,
            (slider, "slider", 1e6, colour::VERMILLION, Dash::Solid),
        );
        NamedFigure {
            name,
            figure: self.one_panel(title, "Angle (µrad)", vec![of_disk, of_slider]),
            table: ["time_s", disk, slider]
                .map(|name| column_named(root, name).clone())
                .to_vec(),
        }
    }

    fn clearance(&self, head: &[Column]) -> NamedFigure {
        let mut named = self.figure(
            "clearance",
            "Minimum clearance",
            "Minimum clearance (nm)",
            head,
            &[("min_clearance_m", "", 1e9, colour::BLUE, Dash::Solid)],
        );
        named.figure.panels[0].rules.push(Rule::Horizontal {
            y: 1e9 * self.caption.fail_below_m,
            label: match self.caption.fails_by_damage {
                true => "touch".into(),
                false => "failure".into(),
            },
        });
        named
    }
}

fn series(columns: &[Column], (column, name, factor, colour, dash): Curve<'_>) -> Series {
    let time = &column_named(columns, "time_s").values;
    let values = &column_named(columns, column).values;
    let curve = time
        .iter()
        .zip(values)
        .map(|(t, v)| (1e3 * t, factor * v))
        .collect();
    Series::curve(name, colour, dash, curve)
}

/// Column of a history by its name.
///
/// # Panics
///
/// Where the history has none of this name.
pub fn column_named<'a>(columns: &'a [Column], name: &str) -> &'a Column {
    columns
        .iter()
        .find(|column| column.name == name)
        .expect("the pictures name columns of the history")
}

/// Writes `NAME.svg`, `NAME.png` and `NAME.csv` of every figure into `folder`, which is made when
/// it is missing. Returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_figures(folder: &Path, figures: &[NamedFigure]) -> Result<Vec<PathBuf>, ReportError> {
    let mut files = Vec::new();
    for named in figures {
        files.extend(picture(named.name, &named.figure, csv(&named.table))?);
    }
    Ok(write_all(folder, files)?)
}

/// `NAME.png`, `NAME.svg` and `NAME.csv`: names and bytes.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn picture(
    name: &str,
    figure: &Figure,
    table: String,
) -> Result<[(String, Vec<u8>); 3], ReportError> {
    let name = |ending: &str| format!("{name}.{ending}");
    Ok([
        (name("png"), figure.png()?),
        (name("svg"), figure.svg().into_bytes()),
        (name("csv"), table.into_bytes()),
    ])
}

fn csv(table: &[Column]) -> String {
    let names: Vec<&str> = table.iter().map(|column| column.name).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..table.first().map_or(0, |column| column.values.len()) {
        let cells: Vec<String> = table
            .iter()
            .map(|column| match column.values[row] {
                value if value.is_finite() => format!("{value:e}"),
                _ => String::new(),
            })
            .collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}
