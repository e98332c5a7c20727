//! Study files, search, store, report and command line.
