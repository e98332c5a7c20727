//! Summary, tables and plots; never simulates.
