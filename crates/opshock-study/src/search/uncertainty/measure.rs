//! Measures the change of the critical shock from one scene to another, by clearance sensitivity or by re-bracketing.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::Ask;
use super::change::Change;
use super::clearance_sensitivity::Reference;
use super::rebracketing;
use super::walk::{Start, Walk};

/// Largest distance of the answer on a coarser film for other parameters to be changed there, as a share: one farther off
/// belongs to another failure.
const NEAR: f64 = 0.05;
/// Grid steps to which that answer is bracketed.
const OF_SURROGATE: i32 = 8;

/// How changes are measured.
#[derive(Clone, Copy)]
pub(super) struct Measure<'r> {
    /// Clearances of survivors, where they can be used.
    pub reference: Option<&'r Reference>,
    /// Grid steps to which brackets are narrowed.
    pub grain: i32,
}

impl Measure<'_> {
    /// The scene on the coarsest film, of a quarter or half of the cells, whose answer is near or follows from clearances;
    /// else the scene itself.
    pub(super) fn surrogate(&self, walk: &mut Walk<'_>) -> Result<Start, Ask> {
        let own = walk.itself();
        for halvings in (1..=walk.input.film_halvings.min(2)).rev() {
            let levels = Levels::NONE.changed(Discretisation::FilmGrid, -halvings);
            if let Some(reference) = self.reference
                && reference.change(walk, Levels::NONE, levels)?.is_some()
            {
                return Ok(Start { levels, ..own });
            }
            let found = rebracketing::locate(walk, levels, own.bracket, OF_SURROGATE, NEAR)?;
            if let Some(bracket) = found {
                return Ok(Start { levels, bracket });
            }
        }
        Ok(own)
    }

    /// Change of the answer from `start` to the scene at `levels`; `None` without verdicts or too far away.
    pub(super) fn change(
        &self,
        walk: &mut Walk<'_>,
        start: Start,
        levels: Levels,
    ) -> Result<Option<Change>, Ask> {
        // A bracket that is known already says more than a clearance.
        if let Some(reference) = self.reference
            && !rebracketing::is_known(walk, levels)
            && let Some(share) = reference.change(walk, start.levels, levels)?
        {
            let change = Change {
                share,
                resolution: 0.0,
                is_equal: false,
            };
            return Ok(Some(change));
        }
        let base = match start.levels.is_none() {
            true => rebracketing::narrowed(walk, start.levels, start.bracket, self.grain)?,
            false => rebracketing::located(walk, start.levels, start.bracket, self.grain)?,
        };
        let Some(base) = base else {
            return Ok(None);
        };
        let Some(found) =
            rebracketing::locate(walk, levels, base, self.grain, rebracketing::FARTHEST)?
        else {
            return Ok(None);
        };
        let (low, high) = (found.low - base.low, found.high - base.high);
        let share = walk.share(if low.abs() > high.abs() { low } else { high });
        let [up, down] = [found.high - base.low, found.low - base.high];
        let most = walk.share(up).abs().max(walk.share(down).abs());
        Ok(Some(Change {
            share,
            resolution: most - share.abs(),
            is_equal: found == base,
        }))
    }
}
