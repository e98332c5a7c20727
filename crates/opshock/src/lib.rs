//! The command line of opshock, which its program and its tests start.

pub mod cli;
