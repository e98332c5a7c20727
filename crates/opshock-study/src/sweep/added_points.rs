//! Rounds of added pulse widths: the widths that final answers require, and the study that has them.
//!
//! A study as written is round 0. Its final answers determine the widths of round 1, and so on; nothing else decides
//! (`search::added_points`). What is stored is the same as for a study that was written with these widths.

use super::input::SweepInput;
use super::replay::replay;
use crate::search::added_points::{self, Answered, Crossing, Wanted};
use crate::search::{AddedPoints, AmplitudeGridError};
use crate::store::summary::{PointSummary, Status, Summary};
use crate::store::{Loaded, folder};
use crate::study::{AddedPointsSettings, Study};

/// A crossing of two ramps' curves: the rows below it, that of the lower curve first.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossed<'a> {
    /// Rows at the width below.
    pub below: (&'a PointSummary, &'a PointSummary),
    /// Crossing point.
    pub crossing: Crossing,
}

/// The study with every width that the `loaded` results require. Rounds are added as far as the answers of the rounds
/// before are final.
///
/// # Errors
///
/// The amplitude range has no point of the tolerance's amplitude grid.
pub fn refined(study: &Study, loaded: &Loaded) -> Result<Study, AmplitudeGridError> {
    let mut study = study.clone();
    loop {
        if study.search.added_points.is_none() {
            return Ok(study);
        }
        let input = SweepInput::of(&study)?;
        let results = replay(&input, loaded.clone(), &folder::session(1));
        match next_round(&study, &results.summary) {
            Some(next) => study = next,
            None => return Ok(study),
        }
    }
}

/// The study with the widths of the next round; `None` while a row is open, and when nothing is
/// to be added. `summary` is that of all of the study's points.
pub fn next_round(study: &Study, summary: &Summary) -> Option<Study> {
    let refine = settings(study.search.added_points.as_ref()?);
    if summary.points.iter().any(|row| row.status == Status::Open) {
        return None;
    }
    let input = SweepInput::of(study).ok()?;
    let order = study.table_order();
    let answered: Vec<Answered> = input
        .points
        .iter()
        .zip(&summary.points)
        .map(|(point, row)| Answered {
            at: point.coordinates.clone(),
            answer_g: row.a_crit_g,
        })
        .collect();
    let wanted = added_points::wanted(&refine, &answered);
    let added = wanted
        .iter()
        .map(|&Wanted { like, pulse_ms }| (order[like], pulse_ms));
    (!wanted.is_empty()).then(|| study.clone().with_widths(added))
}

/// Crossings of the curves of a summary's rows; none for a study that does not ask for them.
pub fn crossings<'a>(study: &Study, summary: &'a Summary) -> Vec<Crossed<'a>> {
    if study
        .search
        .added_points
        .is_none_or(|refine| refine.crossing_pct.is_none())
    {
        return Vec::new();
    }
    let answered: Vec<Answered> = summary
        .points
        .iter()
        .map(|row| Answered {
            at: super::rows::coordinates(row),
            answer_g: row.a_crit_g,
        })
        .collect();
    let rows = |(low, high): (usize, usize)| (&summary.points[low], &summary.points[high]);
    added_points::crossings(&answered)
        .into_iter()
        .map(|crossing| Crossed {
            below: rows(crossing.below),
            crossing,
        })
        .collect()
}

/// The study's settings as shares.
fn settings(refine: &AddedPointsSettings) -> AddedPoints {
    AddedPoints {
        tolerance: refine.tolerance_pct.map(|percent| percent / 100.0),
        crossing: refine.crossing_pct.map(|percent| percent / 100.0),
        closest: refine.closest_pct / 100.0,
        most_points: refine.max_points,
    }
}
