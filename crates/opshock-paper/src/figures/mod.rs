//! Draws the figures of the paper, `fig01` to `fig13`, from a study's own scene and runs.
//!
//! | figures | drawn from |
//! |---------|------------|
//! | 1 to 3 | the scene: plan view of the drive, the ramp models in section |
//! | 4 to 12 | the histories of two shocks, a long and a short one, with every ramp model |
//! | 13 | a table of critical shocks |

mod case;
mod curve_table;
mod curves;
mod drawings;
mod paper_figure;

pub use case::PaperCase;
pub use curves::{long_shock_figures, pulse_figure, short_shock_figures};
pub use drawings::{deformable_ramp_drawing, plan_drawing, rigid_ramp_drawing};
pub use paper_figure::{PaperFigure, critical_figure, write_paper_figures};
