//! Graded tensor grids: cells, faces, spacing.
