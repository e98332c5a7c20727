//! Describes a figure before it is drawn: panels, series, marks.

use super::axis::Axis;
use super::colour::Rgb;

/// Dash pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dash, dot.
    DashDot,
}

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Circle.
    Circle,
    /// Square.
    Square,
    /// Triangle, tip up.
    Triangle,
    /// Diamond.
    Diamond,
    /// Cross of two strokes.
    Cross,
}

/// How a marker is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// With the series' colour.
    Full,
    /// White.
    Open,
}

/// What is known of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Known, with the bounds of its uncertainty interval.
    Known {
        /// Value.
        y: f64,
        /// Lower end of the uncertainty interval.
        low: f64,
        /// Upper end of the uncertainty interval.
        high: f64,
    },
    /// Only known to lie above: an open arrow upwards.
    Above(f64),
    /// Only known to lie below: an open arrow downwards.
    Below(f64),
}

/// One marked value.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Abscissa.
    pub x: f64,
    /// Value.
    pub value: Value,
    /// Drawn open although the series' markers are full: an answer with a reservation (its status or a flag).
    pub open: bool,
    /// Text shown when the pointer rests on it (SVG in a browser).
    pub note: String,
}

/// One named set of data in a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty: not in the legend. Equal names in several panels are one entry.
    pub name: String,
    /// Colour.
    pub colour: Rgb,
    /// Line through the points, or none.
    pub line: Option<Dash>,
    /// Line width, px.
    pub width: f64,
    /// Markers of the samples.
    pub marker: Option<(Marker, Fill)>,
    /// Radius of the markers, px.
    pub marker_px: f64,
    /// Curve drawn as a line; NaN breaks it.
    pub curve: Vec<(f64, f64)>,
    /// Values with marks; the line, when there is one, joins neighbouring known ones.
    pub samples: Vec<Sample>,
    /// Shift to the right, px: keeps equal values of several series apart.
    pub dodge_px: f64,
}

impl Series {
    /// A curve without marks.
    pub fn curve(name: &str, colour: Rgb, dash: Dash, curve: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            colour,
            line: Some(dash),
            width: 1.6,
            marker: None,
            marker_px: 4.0,
            curve,
            samples: Vec::new(),
            dodge_px: 0.0,
        }
    }

    /// Marked values, joined by a line when `line` is given.
    pub fn marked(
        name: &str,
        colour: Rgb,
        line: Option<Dash>,
        marker: (Marker, Fill),
        samples: Vec<Sample>,
    ) -> Self {
        Self {
            line,
            marker: Some(marker),
            samples,
            ..Self::curve(name, colour, Dash::Solid, Vec::new())
        }
    }
}

/// A thin line across a panel with a word beside it.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    /// At a height.
    Horizontal {
        /// Height.
        y: f64,
        /// Word.
        label: String,
    },
    /// At an abscissa.
    Vertical {
        /// Abscissa.
        x: f64,
        /// Word.
        label: String,
    },
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Heading; empty when there is one panel only.
    pub title: String,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// Data.
    pub series: Vec<Series>,
    /// Lines across.
    pub rules: Vec<Rule>,
    /// Shaded stretch of the abscissa, such as the pulse.
    pub shaded: Option<(f64, f64)>,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Heading.
    pub title: String,
    /// Second line, smaller.
    pub subtitle: String,
    /// Panels in a row.
    pub columns: usize,
    /// Size of a panel with its labels, px.
    pub panel_px: (f64, f64),
    /// Panels, row by row.
    pub panels: Vec<Panel>,
}

/// A picture could not be encoded.
#[derive(Debug, thiserror::Error)]
#[error("cannot encode the picture: {0}")]
pub struct ChartError(pub(super) String);
