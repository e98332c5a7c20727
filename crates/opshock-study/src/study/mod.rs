//! Study files: reading, validation, axes, points.
