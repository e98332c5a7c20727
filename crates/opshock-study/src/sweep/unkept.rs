//! A sweep on this thread alone that stores nothing: for callers that keep the table themselves.

use super::guard;
use super::input::SweepInput;
use super::registry::{Job, Registry};
use super::simulator::Simulator;
use crate::store::summary::Summary;
use crate::store::{Loaded, RunMachine, RunRecord, folder};

/// The table of [`super::sweep`].
pub fn unkept(input: &SweepInput, simulator: &dyn Simulator) -> Summary {
    let mut registry = Registry::new(input, Loaded::default());
    registry.absorb_all();
    while !registry.is_done() {
        let Some(job) = registry.next_job(false, &|_| true) else {
            break;
        };
        match job {
            Job::Onset { point } => {
                let touch = guard::onset(simulator, point);
                registry.touched(input.points[point].digest, touch);
            }
            Job::Run { point, asked, key } => {
                let amplitude = registry.amplitude_m_per_s2(point, asked.probe);
                let result = guard::simulate(simulator, point, asked.probe, amplitude);
                registry.finished(RunRecord {
                    key,
                    result,
                    machine: RunMachine::default(),
                });
            }
        }
    }
    registry.results(&folder::session(1)).summary
}
