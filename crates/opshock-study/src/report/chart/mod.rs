//! Draws figures: grids of panels with axes, series and one legend. SVG and PNG come from the same
//! drawing, so they show the same.
//!
//! kuva draws the primitives (with an embedded font, so no machine needs one installed). Axes,
//! legend and marks are laid out here, because half-open uncertainty intervals, arrows for values that are
//! only bounded, and panels that share a legend are what the products need.

mod axis;
mod canvas;
pub mod colour;
mod draw;
mod figure;
mod lines;
mod plot;
#[cfg(test)]
mod tests;

pub use axis::{Axis, Scale};
pub use figure::{ChartError, Dash, Figure, Fill, Marker, Panel, Rule, Sample, Series, Value};

impl Figure {
    /// SVG document; light or dark as its reader prefers.
    pub fn svg(&self) -> String {
        draw::svg(self)
    }

    /// SVG for a page that has [`colour::dark_style`] itself.
    pub fn inline_svg(&self) -> String {
        draw::inline_svg(self)
    }

    /// Every panel as an SVG of its own, without title and legend, as [`Figure::inline_svg`]; the legend is
    /// [`Figure::keys`].
    pub fn inline_panels(&self) -> Vec<String> {
        let panels = self.panels.iter().map(|panel| {
            let mut panel = panel.clone();
            for series in &mut panel.series {
                series.name.clear();
            }
            draw::inline_svg(&Figure {
                title: String::new(),
                subtitle: String::new(),
                columns: 1,
                panel_px: self.panel_px,
                panels: vec![panel],
            })
        });
        panels.collect()
    }

    /// Drawings and names of the legend's entries.
    pub fn keys(&self) -> Vec<(String, String)> {
        draw::keys(self)
    }

    /// PNG at three times the SVG's size in pixels: about 300 dpi at the width of a text column.
    ///
    /// # Errors
    ///
    /// [`ChartError`] when the encoder fails.
    pub fn png(&self) -> Result<Vec<u8>, ChartError> {
        draw::png(self, 3.0)
    }
}
