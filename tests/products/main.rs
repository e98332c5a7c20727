//! Study files, search, store, report and command line.

mod accuracy;
mod bad_inputs;
mod bad_stores;
mod cli;
mod cli_claims;
mod cli_explain;
mod cli_figures;
mod cli_run;
mod cli_studies;
mod compare;
mod error_bars;
mod identity;
mod real_sweep;
mod report_files;
mod report_run;
mod report_store;
mod search_critical_shock;
mod store_damage;
mod store_kill;
mod study_reading;
mod study_shipped;
mod sweep_audit;
mod sweep_repeatability;
mod sweep_sharing;
mod sweep_trouble;
