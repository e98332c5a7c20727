//! The paper's statements and figures, from the public interface of solver and study: the numbers that decide the
//! statements, their table, what they rest on, and Fig. 1 to 13.

#![forbid(unsafe_code)]

pub mod claims;
pub mod figures;
