//! Change of the critical shock with half the minimum film height.

use opshock_solver::scene::discretisation::Discretisation;

use super::ask::{Ask, SUBDIVISIONS};
use super::measure::Measure;
use super::walk::Walk;

/// Grid steps to which both brackets are narrowed: half a step of the search.
const GRAIN: i32 = SUBDIVISIONS / 2;

/// The change, a share of the critical shock; `None` without verdicts or where it is too large. Both scenes have the cheaper
/// film of other comparisons, but where no defect correction makes up for the cells that it lacks. Both are bracketed: below
/// twice the minimum film height clearances do not fall steadily.
pub(super) fn change(walk: &mut Walk<'_>) -> Result<Option<f64>, Ask> {
    let measure = Measure {
        reference: None,
        grain: GRAIN,
    };
    let is_corrected = walk
        .input
        .discretisations
        .contains(&Discretisation::FilmCorrection);
    let start = match is_corrected {
        true => measure.surrogate(walk)?,
        false => walk.itself(),
    };
    let halved = start.levels.changed(Discretisation::MinFilmHeight, 1);
    let change = measure.change(walk, start, halved)?;
    Ok(change.map(|change| change.share))
}
