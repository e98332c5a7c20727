//! Version, commit and physics versions that every product carries.
