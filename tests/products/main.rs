//! Study files, search, store, report and command line.

mod report_files;
mod report_run;
mod study_reading;
mod study_shipped;
