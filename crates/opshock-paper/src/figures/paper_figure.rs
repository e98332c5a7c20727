//! Writes a figure of the paper and the table it was drawn from.

use opshock_study::report::chart::Figure;
use opshock_study::report::{ReportError, paper_figure, picture, table};
use opshock_study::store::aside::write_all;
use opshock_study::store::summary::Summary;
use std::path::{Path, PathBuf};

/// A figure of the paper with the table it was drawn from.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFigure {
    /// Number in the paper, 1 to 13.
    pub number: u8,
    /// What it shows, for the list of figures.
    pub shows: String,
    /// Picture.
    pub figure: Figure,
    /// Table as CSV; every column's name ends in its unit.
    pub csv: String,
}

impl PaperFigure {
    /// File name without ending: `fig04`.
    pub fn stem(&self) -> String {
        format!("fig{:02}", self.number)
    }
}

/// Fig. 13: critical shock against pulse width. `source` names the table.
pub fn critical_figure(summary: &Summary, source: &str) -> PaperFigure {
    PaperFigure {
        number: 13,
        shows: format!("critical shock against pulse width, from {source}"),
        figure: paper_figure(summary, source),
        csv: table::csv(summary),
    }
}

/// Writes SVG, PNG and CSV of every figure and their list, `figures.md`, into `folder`, which is
/// made when it is missing. Returns the written files. Equal figures give equal bytes.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_paper_figures(
    folder: &Path,
    figures: &[PaperFigure],
    provenance: &str,
) -> Result<Vec<PathBuf>, ReportError> {
    let mut files = Vec::new();
    for figure in figures {
        files.extend(picture(&figure.stem(), &figure.figure, figure.csv.clone())?);
    }
    files.push(("figures.md".into(), list(figures, provenance).into_bytes()));
    Ok(write_all(folder, files)?)
}

fn list(figures: &[PaperFigure], provenance: &str) -> String {
    let mut text = String::from("# Figures of the paper\n\n");
    for figure in figures {
        let stem = figure.stem();
        text.push_str(&format!(
            "- Fig. {}: {} ([SVG]({stem}.svg), [PNG]({stem}.png), [CSV]({stem}.csv))\n",
            figure.number, figure.shows
        ));
    }
    text.push_str(&format!(
        "\nEvery column's name ends in its unit. Tables of Fig. 4 to 12 hold values of the histories, \
         not smoothed and not resampled: those of disk and ramp about every 2 us, those of the \
         slider, and of everything in Fig. 8, at every step. `opshock run --history` writes all of \
         a run.\n\n{provenance}\n"
    ));
    text
}
