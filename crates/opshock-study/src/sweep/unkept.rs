//! A sweep on this thread alone that keeps nothing: for callers that keep its table themselves.

use super::guard;
use super::input::SweepInput;
use super::ledger::{Job, Ledger};
use super::simulator::Simulator;
use crate::store::summary::Summary;
use crate::store::{Loaded, RunMachine, RunRecord, folder};

/// The table of [`super::sweep`].
pub fn unkept(input: &SweepInput, simulator: &dyn Simulator) -> Summary {
    let mut ledger = Ledger::new(input, Loaded::default());
    ledger.absorb_all();
    while !ledger.is_done() {
        let Some(job) = ledger.next_job(false) else {
            break;
        };
        match job {
            Job::Onset { point } => {
                let touch = guard::onset(simulator, point);
                ledger.touched(input.points[point].digest, touch);
            }
            Job::Run { point, asked, key } => {
                let amplitude = ledger.amplitude_m_per_s2(point, asked.probe);
                let result = guard::simulate(simulator, point, asked.probe, amplitude);
                ledger.finished(RunRecord {
                    key,
                    result,
                    machine: RunMachine::default(),
                });
            }
        }
    }
    ledger.results(&folder::session(1)).summary
}
