//! Journal, HDF5 results, lock, resume.
