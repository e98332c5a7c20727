//! Entry points for running one shock through a head, from the onset or from a kept state.

use super::resume::{HeadState, Stretch};
use super::running::Run;
use super::steps::End;
use super::workspace::HeadWorkspace;
use crate::disk::DiskMotion;
use crate::disk::run_out::WavyDisk;
use crate::head::model::{Following, HeadModel, ShockLoad};
use crate::head::outcome::HeadRun;

impl HeadModel {
    /// Runs one shock for `window_s` after its onset under `motion` of the disk.
    ///
    /// With `stops_at_failure` the run ends at the instant of its first touch, or of the first damage where the head has limits of
    /// that; otherwise it continues with the minimum film height in the film equations. Verdict, smallest clearance (the limit
    /// at a touch) and forces are those up to there either way, with the same bits; histories and cost continue. `record` requests
    /// histories.
    ///
    /// # Panics
    /// When `workspace` was made for another model's sizes.
    pub fn run(
        &self,
        motion: &dyn DiskMotion,
        load: &ShockLoad<'_>,
        window_s: f64,
        stops_at_failure: bool,
        record: bool,
        workspace: &mut HeadWorkspace,
    ) -> HeadRun {
        let stretch = Stretch {
            end_s: window_s,
            ..Stretch::default()
        };
        self.run_stretch(motion, load, stretch, stops_at_failure, record, workspace)
            .0
    }

    /// The same over `stretch`, with the state at its end when that is kept. A run that continues another has recorded
    /// nothing before.
    ///
    /// # Panics
    /// As [`HeadModel::run`], and when the state is that of another model.
    pub fn run_stretch(
        &self,
        motion: &dyn DiskMotion,
        load: &ShockLoad<'_>,
        stretch: Stretch<'_>,
        stops_at_failure: bool,
        record: bool,
        workspace: &mut HeadWorkspace,
    ) -> (HeadRun, Option<HeadState>) {
        assert_eq!(workspace.y.len(), self.n_unknowns());
        let wavy;
        let motion = match &self.following {
            Some(Following { surface, .. }) => {
                wavy = WavyDisk {
                    under: motion,
                    surface,
                };
                &wavy
            }
            None => motion,
        };
        let mut run = match stretch.from {
            Some(state) => Run::resume(self, motion, *load, state, workspace),
            None => Run::start(self, motion, *load, stops_at_failure, record, workspace),
        };
        let restart_s = stretch.restart_s.filter(|_| stretch.from.is_none());
        let mut end = End::Window;
        if let Some(restart_s) = restart_s {
            end = run.advance(restart_s.min(stretch.end_s), stops_at_failure);
            run.forget();
        }
        if matches!(end, End::Window) {
            end = run.advance(stretch.end_s, stops_at_failure);
        }
        let is_whole = matches!(end, End::Window) && run.failed.is_none();
        let state = (stretch.keeps_end && is_whole).then(|| run.state());
        (run.finish(end), state)
    }
}
