//! Floors, names, architecture page.
