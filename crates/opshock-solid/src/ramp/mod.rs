//! Reduces a ramp, given by its dimensions or a mesh and its material, to oscillators of its contact points.

mod geometry;
mod mesh;
mod oscillators;
mod shape;
mod shapes;

pub use geometry::{GeometryError, MOST_ELEMENTS, RampGeometry};
pub use mesh::{Extent, RampMesh};
pub use oscillators::{Mount, RampModes, SolidRamp, SolidRampError, contact_columns};
pub use shape::{RampFaces, ShapeError};
pub use shapes::RampShape;
