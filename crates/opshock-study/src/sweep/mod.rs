//! Sweeps: points in parallel, one writer, progress.
