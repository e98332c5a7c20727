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
    /// SVG document.
    pub fn svg(&self) -> String {
        draw::svg(self)
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
