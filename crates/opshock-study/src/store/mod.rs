//! Journal, HDF5 results, lock, resume.

pub mod history;
