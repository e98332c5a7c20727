//! Episodes of contact between slider and disk, while their asperities bear.

use super::damage::DamageLimits;
use super::energy::work;
use super::outcome::{ContactWork, Place, SliderContact, SliderEpisode};
use crate::air_bearing::Attitude;
use crate::rough_contact::nominal::ContactState;

/// Share of the steady force of the dimple from which the asperities' force is an episode of contact: their heights have no end, so
/// that some of them bear a little in flight.
const EPISODE_SHARE: f64 = 0.01;

/// Share of that force below which an episode ends, so that a force near it makes one episode and not many.
const LEAVE_SHARE: f64 = 0.5;

/// An accepted state of a run with contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    pub(super) time_s: f64,
    pub(super) clearance_m: f64,
    pub(super) place: Place,
    pub(super) state: ContactState,
    /// State at the mean of this attitude and the one before, where works are asked for.
    pub(super) midway: Option<ContactState>,
    pub(super) attitude: Attitude,
}

impl Instant {
    /// Work that slider and disk do on the asperities from `before` on, J.
    fn closing_j(&self, before: &Self) -> Option<f64> {
        let places = [&before.attitude, &self.attitude]
            .map(|at| [at.centre_height_m, at.pitch_rad, at.roll_rad]);
        let states = [&before.state, self.midway.as_ref()?, &self.state];
        Some(-work(states.map(ContactState::normal_load), places))
    }
}

/// Contact in progress.
#[derive(Clone, Debug)]
pub(super) struct ContactWatch {
    /// Force from which it is an episode, N.
    least_n: f64,
    latest: Instant,
    record: SliderContact,
}

impl ContactWatch {
    /// From the first instant of a run, at a steady force of the dimple.
    pub(super) fn new(steady_n: f64, first: Instant) -> Self {
        Self {
            least_n: EPISODE_SHARE * steady_n,
            latest: first,
            record: SliderContact::default(),
        }
    }

    /// Adds the next accepted state; `elastic_j` is what the asperities hold then.
    pub(super) fn add(&mut self, now: Instant, elastic_j: impl FnOnce() -> f64) {
        let before = std::mem::replace(&mut self.latest, now);
        let dt_s = now.time_s - before.time_s;
        if dt_s <= 0.0 {
            return;
        }
        let least_n = match self.record.goes_on {
            true => LEAVE_SHARE * self.least_n,
            false => self.least_n,
        };
        let is_on = now.state.force_n >= least_n;
        let work_j = now.closing_j(&before);
        if is_on && !self.record.goes_on {
            self.record.episodes.push(SliderEpisode {
                on_s: before.time_s,
                off_s: now.time_s,
                approach_m_per_s: (before.clearance_m - now.clearance_m) / dt_s,
                impulse_n_s: 0.0,
                peak_force_n: 0.0,
                peak_pressure_pa: 0.0,
                closest_m: f64::INFINITY,
                place: now.place,
                friction_j: 0.0,
                // What they held before this step, whose work is added below.
                work: work_j.map(|work_j| ContactWork {
                    loading_j: (elastic_j() - work_j).max(0.0),
                    unloading_j: 0.0,
                }),
                mean_pressure_pa: 0.0,
            });
        }
        if is_on || self.record.goes_on {
            let Some(episode) = self.record.episodes.last_mut() else {
                unreachable!("an episode that is on was begun");
            };
            episode.off_s = now.time_s;
            let ends = [&before.state, &now.state];
            episode.impulse_n_s += 0.5 * dt_s * ends.map(|state| state.force_n).iter().sum::<f64>();
            episode.friction_j +=
                0.5 * dt_s * ends.map(|state| state.friction_w).iter().sum::<f64>();
            if let (Some(work_j), Some(work)) = (work_j, &mut episode.work) {
                work.loading_j += work_j.max(0.0);
                work.unloading_j -= work_j.min(0.0);
            }
            if now.state.force_n > episode.peak_force_n {
                episode.peak_force_n = now.state.force_n;
                episode.place = now.place;
                episode.mean_pressure_pa = now.state.mean_pressure_pa;
            }
            episode.peak_pressure_pa = episode.peak_pressure_pa.max(now.state.peak_pressure_pa);
            episode.closest_m = episode.closest_m.min(now.state.closest_m);
        }
        self.record.goes_on = is_on;
    }

    /// Attitude at the latest instant.
    pub(super) fn attitude(&self) -> &Attitude {
        &self.latest.attitude
    }

    /// Force at the latest instant, N.
    pub(super) fn force_n(&self) -> f64 {
        self.latest.state.force_n
    }

    /// Whether the latest instant exceeds a limit of pressure, or the episodes one of their number.
    pub(super) fn exceeds(&self, limits: &DamageLimits) -> bool {
        let pressure_pa = self.latest.state.peak_pressure_pa;
        let episodes = self.record.episodes.len() as u64;
        limits
            .pressure_pa
            .is_some_and(|most_pa| pressure_pa > most_pa)
            || limits.episodes.is_some_and(|most| episodes > most)
    }

    /// The record of episodes.
    pub(super) fn finish(self) -> SliderContact {
        self.record
    }
}
