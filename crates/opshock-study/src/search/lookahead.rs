//! Probes that a search will probably request: work for cores that would otherwise idle.
//!
//! The search is run ahead on assumed verdicts. A result computed ahead only answers a probe sooner when the search
//! requests it; it never enters the evidence by itself.

use super::evidence::AmplitudeVerdict;
use super::point::{Asked, PointSearch};
use super::probe::{Probe, Purpose, Verdict};

/// Where a probe's answer is.
#[derive(Clone, Debug, PartialEq)]
pub enum Lookup {
    /// Finished, with the smallest clearance, m.
    Known(Verdict, Option<f64>),
    /// Being computed.
    Running,
    /// Not being computed.
    Free,
}

/// A probe that may be requested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The probe.
    pub probe: Probe,
    /// Why it would be requested.
    pub purpose: Purpose,
    /// Chance that it will be requested, 1 for the present request.
    pub likelihood: f64,
}

/// Least chance for which a probe is computed ahead.
const LEAST_LIKELIHOOD: f64 = 0.2;

/// Chance that a probe survives.
fn survival_chance(search: &PointSearch, asked: Asked) -> f64 {
    match asked.purpose {
        Purpose::Bracketing | Purpose::Bisect => 0.5,
        Purpose::Scan | Purpose::Window | Purpose::Uncertainty => 0.95,
        Purpose::FollowUp => 0.6,
        Purpose::OwnRun => match search.evidence().get(asked.probe.index) {
            Some(AmplitudeVerdict::Fails) => 0.05,
            _ => 0.95,
        },
    }
}

/// Free probes that `search` requests now or may request next, at most `limit`.
pub fn candidates(
    search: &PointSearch,
    likelihood: f64,
    limit: usize,
    lookup: &dyn Fn(Probe) -> Lookup,
) -> Vec<Candidate> {
    let mut found = Vec::new();
    let mut open = vec![(search.clone(), likelihood)];
    // Best first: a branch is followed only while it is the most likely one left.
    while let Some(best) = (0..open.len()).max_by(|&a, &b| open[a].1.total_cmp(&open[b].1)) {
        let (mut search, likelihood) = open.swap_remove(best);
        let Some(asked) = search.ask() else { continue };
        match lookup(asked.probe) {
            Lookup::Known(verdict, h_min_m) => {
                search.report_margin(&verdict, h_min_m);
                open.push((search, likelihood));
                continue;
            }
            Lookup::Running => {}
            Lookup::Free => {
                found.push(Candidate {
                    probe: asked.probe,
                    purpose: asked.purpose,
                    likelihood,
                });
                if found.len() >= limit {
                    break;
                }
            }
        }
        let survives = survival_chance(&search, asked);
        for (verdict, chance) in [
            (Verdict::Survives, survives),
            (
                Verdict::Fails {
                    t_fail_s: 0.0,
                    x_m: 0.0,
                    y_m: 0.0,
                },
                1.0 - survives,
            ),
        ] {
            if likelihood * chance >= LEAST_LIKELIHOOD {
                let mut next = search.clone();
                next.tell(&verdict);
                open.push((next, likelihood * chance));
            }
        }
    }
    found
}
