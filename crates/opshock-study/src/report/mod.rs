//! Summary, tables and plots; never simulates.

mod accuracy_files;
pub mod chart;
mod claims_files;
pub mod comparison;
mod critical_shock;
mod crossings;
mod files;
pub mod html;
mod margin_curves;
pub mod mode_shapes;
mod outcome_map;
pub mod paper;
pub mod run_json;
mod run_plots;
mod run_text;
pub mod runs_table;
pub mod savings;
pub mod table;
mod terminal_plot;
pub mod vtk_files;
mod vtu;

pub use accuracy_files::write_accuracy;
pub use claims_files::{ClaimTable, tornado, write_claims, write_sensitivity};
pub use critical_shock::critical_shock_figure;
pub use crossings::CrossingRow;
pub use files::{ReportError, report_files};
pub use html::ReportSource;
pub use html::ShockFilm;
pub use margin_curves::margin_curves;
pub use outcome_map::{RunDot, outcome_map};
pub use run_json::{RunJson, verdict_word};
pub use run_plots::{NamedFigure, RunCaption, run_figures, write_figures};
pub use run_text::run_text;
pub use savings::{Saving, savings};
pub use terminal_plot::terminal_plot;
