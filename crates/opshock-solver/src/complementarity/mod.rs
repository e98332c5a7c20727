//! complementarity
