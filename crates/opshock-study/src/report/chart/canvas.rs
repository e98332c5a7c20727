//! Draws texts, lines and marks on a canvas in SVG pixels, y down.

use super::colour::Rgb;
use super::figure::{Dash, Fill, Marker, Series};
use super::lines;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

/// What is drawn so far.
pub(super) struct Canvas {
    pub(super) scene: Scene,
}

impl Canvas {
    pub(super) fn text(
        &mut self,
        (x, y): (f64, f64),
        content: &str,
        size: u32,
        colour: Rgb,
        anchor: TextAnchor,
    ) {
        if content.is_empty() {
            return;
        }
        self.scene.add(Primitive::Text {
            x,
            y,
            // The backend reads `$` as the start of a formula.
            content: content.replace('$', "\\$"),
            size,
            anchor,
            rotate: None,
            bold: false,
            color: Some(rgb(colour)),
        });
    }

    pub(super) fn segment(&mut self, a: (f64, f64), b: (f64, f64), colour: Rgb, width: f64) {
        self.scene.add(Primitive::Line {
            x1: a.0,
            y1: a.1,
            x2: b.0,
            y2: b.1,
            stroke: rgb(colour),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    pub(super) fn polyline(&mut self, points: &[(f64, f64)], colour: Rgb, width: f64, dash: Dash) {
        // Dashes are cut here: the raster backend would start the pattern anew at every point.
        for piece in lines::dashed(points, dash) {
            self.scene.add(Primitive::PolyLine {
                points: piece,
                stroke: rgb(colour),
                stroke_width: width,
                stroke_dasharray: None,
            });
        }
    }

    /// A closed polygon.
    pub(super) fn path(&mut self, corners: &[(f64, f64)], fill: Option<Rgb>, stroke: Rgb) {
        let mut d = String::new();
        for (index, (x, y)) in corners.iter().enumerate() {
            let command = if index == 0 { 'M' } else { 'L' };
            d.push_str(&format!("{command} {x:.2} {y:.2} "));
        }
        d.push('Z');
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: fill.map(rgb),
            stroke: rgb(stroke),
            stroke_width: 1.4,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// Shaft and open head; `up` is -1 (up) or 1 (down).
    pub(super) fn open_arrow(&mut self, (x, y): (f64, f64), up: f64, colour: Rgb) {
        let tip = y + 24.0 * up;
        self.segment((x, y), (x, tip - 7.0 * up), colour, 1.4);
        self.path(
            &[
                (x - 4.5, tip - 8.0 * up),
                (x, tip),
                (x + 4.5, tip - 8.0 * up),
            ],
            Some((255, 255, 255)),
            colour,
        );
    }

    pub(super) fn marker(
        &mut self,
        (x, y): (f64, f64),
        marker: Marker,
        fill: Fill,
        series: &Series,
    ) {
        let (colour, r) = (series.colour, series.marker_px);
        let inside = match fill {
            Fill::Full => colour,
            Fill::Open => (255, 255, 255),
        };
        match marker {
            Marker::Circle => self.scene.add(Primitive::Circle {
                cx: x,
                cy: y,
                r,
                fill: rgb(inside),
                fill_opacity: None,
                stroke: Some(rgb(colour)),
                stroke_width: Some(1.4),
            }),
            Marker::Square => {
                let corners = [(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)];
                self.path(
                    &corners.map(|c| (x + r * c.0, y + r * c.1)),
                    Some(inside),
                    colour,
                );
            }
            Marker::Triangle => {
                let corners = [(0.0, -1.25), (1.15, 0.85), (-1.15, 0.85)];
                self.path(
                    &corners.map(|c| (x + r * c.0, y + r * c.1)),
                    Some(inside),
                    colour,
                );
            }
            Marker::Diamond => {
                let corners = [(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)];
                self.path(
                    &corners.map(|c| (x + r * c.0, y + r * c.1)),
                    Some(inside),
                    colour,
                );
            }
            Marker::Cross => {
                let d = 0.9 * r;
                self.segment((x - d, y - d), (x + d, y + d), colour, 1.8);
                self.segment((x - d, y + d), (x + d, y - d), colour, 1.8);
            }
        }
    }
}

/// Width of a text in DejaVu Sans, px; within some percent, for spacing only.
pub(super) fn text_width(text: &str, size: u32) -> f64 {
    let em: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' => 0.31,
            'f' | 't' | 'r' | '(' | ')' | '/' | '-' => 0.39,
            'm' | 'w' | 'M' | 'W' | '%' => 0.92,
            '+' | '\u{2212}' | '=' | '<' | '>' | '\u{00b1}' => 0.84,
            c if c.is_ascii_uppercase() => 0.70,
            _ => 0.62,
        })
        .sum();
    em * f64::from(size)
}

pub(super) fn rgb((r, g, b): Rgb) -> Color {
    Color::Rgb(r, g, b)
}
