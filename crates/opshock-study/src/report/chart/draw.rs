//! Lays a figure out and draws it.

use super::axis::ResolvedAxis;
use super::axis::Scale;
use super::canvas::{Canvas, rgb, text_width};
use super::colour::{FAINT_GRID, GREY, GRID, QUIET_TEXT, SHADE, TEXT, ZERO, dark_style};
use super::figure::{ChartError, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value};
use super::lines;
use super::plot::{Plot, abscissae, ordinates};
use kuva::backend::raster::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene, TextAnchor};

const OUTER_PX: f64 = 16.0;
const TITLE_SIZE: u32 = 16;
const TEXT_SIZE: u32 = 12;
/// Length of a line's sample in the legend.
const KEY_PX: f64 = 34.0;
const FONT: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

pub(super) fn svg(figure: &Figure) -> String {
    let style = format!("<style>{}</style><rect ", dark_style());
    inline_svg(figure).replacen("<rect ", &style, 1)
}

pub(super) fn inline_svg(figure: &Figure) -> String {
    written(&scene(figure))
}

fn written(scene: &Scene) -> String {
    let (width, height) = (scene.width, scene.height);
    // The view box lets a page or a document scale the picture.
    SvgBackend::new().render_scene(scene).replacen(
        "<svg ",
        &format!(r#"<svg viewBox="0 0 {width} {height}" role="img" "#),
        1,
    )
}

/// The legend's entries: a drawing of line and mark, and the name.
pub(super) fn keys(figure: &Figure) -> Vec<(String, String)> {
    let entries = legend_rows(figure, f64::MAX).concat();
    let drawn = entries.into_iter().map(|(series, _)| {
        let mut canvas = Canvas {
            scene: Scene::new(KEY_PX + 4.0, 16.0),
        };
        let unnamed = Series {
            name: String::new(),
            ..series.clone()
        };
        canvas.legend_entry((2.0, 8.0), &unnamed);
        (written(&canvas.scene), series.name.clone())
    });
    drawn.collect()
}

pub(super) fn png(figure: &Figure, scale: f32) -> Result<Vec<u8>, ChartError> {
    RasterBackend::new()
        .with_scale(scale)
        .render_scene(&scene(figure))
        .map_err(ChartError)
}

fn scene(figure: &Figure) -> Scene {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let rows = figure.panels.len().div_ceil(columns);
    let width = 2.0 * OUTER_PX + columns as f64 * figure.panel_px.0;
    let legend = legend_rows(figure, width - 2.0 * OUTER_PX);

    let mut y = OUTER_PX;
    let title_y = y + f64::from(TITLE_SIZE);
    if !figure.title.is_empty() {
        y += f64::from(TITLE_SIZE) + 8.0;
    }
    let subtitle_y = y + f64::from(TEXT_SIZE);
    if !figure.subtitle.is_empty() {
        y += f64::from(TEXT_SIZE) + 8.0;
    }
    let legend_y = y + 4.0;
    y += 20.0 * legend.len() as f64 + 6.0;
    let height = y + rows as f64 * figure.panel_px.1 + 0.5 * OUTER_PX;

    let mut canvas = Canvas {
        scene: Scene::new(width.ceil(), height.ceil()),
    };
    canvas.scene.font_family = Some(FONT.into());
    canvas.scene.text_color = Some(rgb(TEXT).to_svg_string());
    canvas.text(
        (OUTER_PX, title_y),
        &figure.title,
        TITLE_SIZE,
        TEXT,
        TextAnchor::Start,
    );
    canvas.text(
        (OUTER_PX, subtitle_y),
        &figure.subtitle,
        TEXT_SIZE,
        QUIET_TEXT,
        TextAnchor::Start,
    );
    for (row, entries) in legend.iter().enumerate() {
        let mut x = OUTER_PX;
        for (series, advance) in entries {
            canvas.legend_entry((x, legend_y + 20.0 * row as f64 + 8.0), series);
            x += advance;
        }
    }
    for (index, panel) in figure.panels.iter().enumerate() {
        let (column, row) = (index % columns, index / columns);
        let left = OUTER_PX + column as f64 * figure.panel_px.0;
        let top = y + row as f64 * figure.panel_px.1;
        canvas.panel(
            panel,
            (left, top),
            figure.panel_px,
            label_px(figure, column),
        );
    }
    // Keeps the titles of samples as tooltips without the style sheet that would come with them.
    canvas.scene.has_tooltips = false;
    canvas.scene
}

/// Room for the ordinates' labels, the same for all panels of a column so that their abscissae
/// stand over one another.
fn label_px(figure: &Figure, column: usize) -> f64 {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let panels = figure.panels.iter().skip(column).step_by(columns);
    panels
        .flat_map(|panel| ResolvedAxis::new(&panel.y, ordinates(panel)).ticks)
        .map(|(_, label)| text_width(&label, TEXT_SIZE))
        .fold(0.0, f64::max)
}

/// Rows of legend entries with the room each takes.
fn legend_rows(figure: &Figure, room: f64) -> Vec<Vec<(&Series, f64)>> {
    let mut rows: Vec<Vec<(&Series, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    let mut seen: Vec<&str> = Vec::new();
    for series in figure.panels.iter().flat_map(|panel| &panel.series) {
        if series.name.is_empty() || seen.contains(&series.name.as_str()) {
            continue;
        }
        seen.push(&series.name);
        let advance = KEY_PX + 8.0 + text_width(&series.name, TEXT_SIZE) + 20.0;
        if used + advance - 20.0 > room {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += advance;
        if let Some(row) = rows.last_mut() {
            row.push((series, advance));
        }
    }
    rows
}

impl Canvas {
    fn panel(
        &mut self,
        panel: &Panel,
        (left, top): (f64, f64),
        (width, height): (f64, f64),
        label_px: f64,
    ) {
        let x_axis = ResolvedAxis::new(&panel.x, abscissae(panel));
        let y_axis = ResolvedAxis::new(&panel.y, ordinates(panel));
        let heading = if panel.title.is_empty() { 6.0 } else { 26.0 };
        let plot = Plot {
            x0: left + 26.0 + label_px + 10.0,
            y0: top + heading,
            x1: left + width - 16.0,
            y1: top + height - 50.0,
            shift: 0.0,
            x: x_axis,
            y: y_axis,
        };
        let plot = match panel.y.is_to_scale {
            true => plot.true_to_scale(),
            false => plot,
        };
        if !panel.title.is_empty() {
            self.text(
                (plot.x0, top + 14.0),
                &panel.title,
                13,
                TEXT,
                TextAnchor::Start,
            );
        }
        self.background(panel, &plot);
        for rule in &panel.rules {
            self.rule(rule, &plot);
        }
        for series in &panel.series {
            self.series(series, &plot.shifted(series.dodge_px));
        }
        self.frame(panel, &plot, left);
    }

    fn background(&mut self, panel: &Panel, plot: &Plot) {
        if let Some((from, to)) = panel.shaded {
            let x0 = plot.px(from).max(plot.x0);
            let x1 = plot.px(to).min(plot.x1);
            if x1 > x0 {
                self.scene.add(Primitive::Rect {
                    x: x0,
                    y: plot.y0,
                    width: x1 - x0,
                    height: plot.y1 - plot.y0,
                    fill: rgb(SHADE),
                    stroke: None,
                    stroke_width: None,
                    opacity: None,
                });
            }
        }
        for value in &plot.y.minor {
            let y = plot.py(*value);
            self.segment((plot.x0, y), (plot.x1, y), FAINT_GRID, 1.0);
        }
        for (value, _) in &plot.y.ticks {
            let y = plot.py(*value);
            self.segment((plot.x0, y), (plot.x1, y), GRID, 1.0);
        }
        for (value, _) in &plot.x.ticks {
            let x = plot.px(*value);
            self.segment((x, plot.y0), (x, plot.y1), GRID, 1.0);
        }
        let zero = plot.py(0.0);
        if plot.y.scale == Scale::Linear && zero > plot.y0 + 1.0 && zero < plot.y1 - 1.0 {
            self.segment((plot.x0, zero), (plot.x1, zero), ZERO, 1.0);
        }
    }

    fn frame(&mut self, panel: &Panel, plot: &Plot, left: f64) {
        self.segment((plot.x0, plot.y0), (plot.x0, plot.y1), TEXT, 1.0);
        self.segment((plot.x0, plot.y1), (plot.x1, plot.y1), TEXT, 1.0);
        for (value, label) in &plot.y.ticks {
            let y = plot.py(*value);
            self.segment((plot.x0 - 5.0, y), (plot.x0, y), TEXT, 1.0);
            self.text(
                (plot.x0 - 8.0, y + 4.2),
                label,
                TEXT_SIZE,
                TEXT,
                TextAnchor::End,
            );
        }
        for value in &plot.y.minor {
            let y = plot.py(*value);
            self.segment((plot.x0 - 3.0, y), (plot.x0, y), TEXT, 1.0);
        }
        let mut free_from = f64::NEG_INFINITY;
        for (value, label) in &plot.x.ticks {
            let x = plot.px(*value);
            self.segment((x, plot.y1), (x, plot.y1 + 5.0), TEXT, 1.0);
            let half = 0.5 * text_width(label, TEXT_SIZE);
            if x - half >= free_from {
                self.text(
                    (x, plot.y1 + 19.0),
                    label,
                    TEXT_SIZE,
                    TEXT,
                    TextAnchor::Middle,
                );
                free_from = x + half + 4.0;
            }
        }
        let middle_x = 0.5 * (plot.x0 + plot.x1);
        self.text(
            (middle_x, plot.y1 + 39.0),
            &panel.x.label,
            TEXT_SIZE,
            TEXT,
            TextAnchor::Middle,
        );
        self.scene.add(Primitive::Text {
            x: left + 14.0,
            y: 0.5 * (plot.y0 + plot.y1),
            content: panel.y.label.clone(),
            size: TEXT_SIZE,
            anchor: TextAnchor::Middle,
            rotate: Some(-90.0),
            bold: false,
            color: Some(rgb(TEXT)),
        });
    }

    fn rule(&mut self, rule: &Rule, plot: &Plot) {
        match rule {
            Rule::Horizontal { y, label } => {
                let y = plot.py(*y);
                if y < plot.y0 || y > plot.y1 {
                    return;
                }
                self.polyline(&[(plot.x0, y), (plot.x1, y)], GREY, 1.2, Dash::Dashed);
                let above = if y - plot.y0 < 18.0 { 14.0 } else { -5.0 };
                self.text(
                    (plot.x1 - 4.0, y + above),
                    label,
                    11,
                    QUIET_TEXT,
                    TextAnchor::End,
                );
            }
            Rule::Vertical { x, label } => {
                let x = plot.px(*x);
                if x < plot.x0 || x > plot.x1 {
                    return;
                }
                self.polyline(&[(x, plot.y0), (x, plot.y1)], GREY, 1.2, Dash::Dashed);
                let room = plot.x1 - x > text_width(label, 11) + 8.0;
                let (dx, anchor) = if room {
                    (5.0, TextAnchor::Start)
                } else {
                    (-5.0, TextAnchor::End)
                };
                self.text((x + dx, plot.y0 + 12.0), label, 11, QUIET_TEXT, anchor);
            }
        }
    }

    fn series(&mut self, series: &Series, plot: &Plot) {
        let bounds = (plot.x0, plot.y0, plot.x1, plot.y1);
        let dash = series.line.unwrap_or(Dash::Solid);
        let curve: Vec<_> = series.curve.iter().map(|p| plot.at(p.0, p.1)).collect();
        for piece in lines::clipped(&lines::thinned(&curve), bounds) {
            self.polyline(&piece, series.colour, series.width, dash);
        }
        if series.line.is_some() {
            for pair in series.samples.windows(2) {
                if let (Value::Known { y: a, .. }, Value::Known { y: b, .. }) =
                    (pair[0].value, pair[1].value)
                {
                    let ends = [plot.at(pair[0].x, a), plot.at(pair[1].x, b)];
                    for piece in lines::clipped(&ends, bounds) {
                        self.polyline(&piece, series.colour, series.width, dash);
                    }
                }
            }
        }
        for sample in &series.samples {
            self.sample(sample, series, plot);
        }
    }

    fn sample(&mut self, sample: &Sample, series: &Series, plot: &Plot) {
        let (marker, fill) = series.marker.unwrap_or((Marker::Circle, Fill::Full));
        let fill = if sample.open { Fill::Open } else { fill };
        let noted = !sample.note.is_empty();
        if noted {
            self.scene.add(Primitive::GroupStart {
                transform: None,
                title: Some(sample.note.clone()),
                extra_attrs: None,
            });
        }
        match sample.value {
            Value::Known { y, low, high } => {
                let (x, y) = plot.at(sample.x, y);
                let inside = |v: f64| plot.py(v).clamp(plot.y0, plot.y1);
                let (top, bottom) = (inside(high), inside(low));
                if bottom - top > 0.5 {
                    self.segment((x, top), (x, bottom), series.colour, 1.2);
                    for end in [top, bottom] {
                        self.segment((x - 4.0, end), (x + 4.0, end), series.colour, 1.2);
                    }
                }
                if (plot.y0..=plot.y1).contains(&y) && (plot.x0..=plot.x1).contains(&x) {
                    self.marker((x, y), marker, fill, series);
                }
            }
            Value::Above(y) | Value::Below(y) => {
                let up = if matches!(sample.value, Value::Above(_)) {
                    -1.0
                } else {
                    1.0
                };
                let (x, y) = plot.at(sample.x, y);
                self.open_arrow((x, y.clamp(plot.y0, plot.y1)), up, series.colour);
                self.marker((x, y.clamp(plot.y0, plot.y1)), marker, Fill::Open, series);
            }
        }
        if noted {
            self.scene.add(Primitive::GroupEnd);
        }
    }

    fn legend_entry(&mut self, (x, y): (f64, f64), series: &Series) {
        if let Some(dash) = series.line {
            self.polyline(
                &[(x, y), (x + KEY_PX, y)],
                series.colour,
                series.width.max(1.6),
                dash,
            );
        }
        if let Some((marker, fill)) = series.marker {
            self.marker((x + 0.5 * KEY_PX, y), marker, fill, series);
        }
        self.text(
            (x + KEY_PX + 8.0, y + 4.2),
            &series.name,
            TEXT_SIZE,
            TEXT,
            TextAnchor::Start,
        );
    }
}
