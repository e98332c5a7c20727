//! Why a shock failed: the mechanism of a failing run, by its own forces and times.
//!
//! The first of these that holds at the touch names it:
//!
//! 1. `limiter`, `lift_tab`: a stop of the suspension was closed within the last [`RECENT_S`].
//! 2. `dimple_separation`: the dimple was open within the last [`RECENT_S`]. The slider, held by the flexure and the suction of the
//!    film alone, is thrown onto the disk when the load beam comes back (pitch slap).
//! 3. `ramp_impact`: disk and ramp were in contact within the last [`IMPACT_S`], and the net force of the air bearing has varied by
//!    more than [`LEAST_RANGE`] of the steady dimple force within the last [`RANGE_S`]: bending waves pass under the slider.
//! 4. `lift_loss`: the net force of the air bearing pulls the slider down.
//! 5. `compression`: dimple and air bearing both press with more than the steady force of the dimple.
//! 6. `other`.
//!
//! The limits were chosen on 36 shocks, one 2 % beyond the interval of each point of Fig. 13. Bending waves of 0.5 kHz and more
//! travel from ramp to slider in 93 us there. Surface forces are in none of these forces.

use super::outcome::{Outcome, Verdict};

/// Time before a touch in which an open dimple or a closed stop counts, s.
const RECENT_S: f64 = 20e-6;
/// Longest time between a contact with the ramp and a touch that it causes, s.
const IMPACT_S: f64 = 100e-6;
/// Time before a touch over which the range of the bearing force is taken, s.
const RANGE_S: f64 = 50e-6;
/// Least range that bending waves make, over the steady dimple force.
const LEAST_RANGE: f64 = 0.25;

/// Mechanism of a failure; see the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mechanism {
    /// A limiter of the suspension was closed.
    Limiter,
    /// The lift tab's stop was closed.
    LiftTab,
    /// The dimple had opened.
    DimpleSeparation,
    /// Bending waves of a contact with the ramp.
    RampImpact,
    /// Suction is larger than lift.
    LiftLoss,
    /// Load beyond what the bearing carries.
    Compression,
    /// None of these.
    Other,
}

impl Mechanism {
    /// All, in the order in which they are tried.
    pub const ALL: [Self; 7] = [
        Self::Limiter,
        Self::LiftTab,
        Self::DimpleSeparation,
        Self::RampImpact,
        Self::LiftLoss,
        Self::Compression,
        Self::Other,
    ];

    /// That of a name in an output file.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.as_str() == word)
    }

    /// As people read it.
    pub fn words(self) -> String {
        self.as_str().replace('_', " ")
    }

    /// Name in output files.
    pub fn as_str(self) -> &'static str {
        match self {
            Mechanism::Limiter => "limiter",
            Mechanism::LiftTab => "lift_tab",
            Mechanism::DimpleSeparation => "dimple_separation",
            Mechanism::RampImpact => "ramp_impact",
            Mechanism::LiftLoss => "lift_loss",
            Mechanism::Compression => "compression",
            Mechanism::Other => "other",
        }
    }
}

/// Times and forces that decide the mechanism. Forces are over the steady force of the dimple, times before the touch, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct FailureEvidence {
    /// Since the dimple was last open; `None`: it never was.
    pub dimple_open_before_s: Option<f64>,
    /// Since a limiter was last closed.
    pub limiter_before_s: Option<f64>,
    /// Since the lift tab's stop was last closed.
    pub lift_tab_before_s: Option<f64>,
    /// Since disk and ramp were last in contact; 0 while they are.
    pub ramp_contact_before_s: Option<f64>,
    /// Since that contact began; impulses less than 30 us apart are one contact.
    pub ramp_began_before_s: Option<f64>,
    /// Force of the dimple at the touch.
    pub dimple_over_steady: f64,
    /// Net force of the air bearing at the touch; negative: suction.
    pub bearing_over_steady: f64,
    /// Largest less smallest net force of the air bearing in the last 50 us.
    pub bearing_range_over_steady: f64,
}

impl FailureEvidence {
    /// Of a run that failed and was recorded; `None` of any other, or without the columns.
    pub fn of(outcome: &Outcome) -> Option<FailureEvidence> {
        let Some(Verdict::Fails { t_fail_s, .. }) = outcome.verdict else {
            return None;
        };
        // It is that of a first touch; damage may come long after it.
        let contact = outcome.slider_contact.as_ref();
        if contact.is_some_and(|contact| contact.touched_s != Some(t_fail_s)) {
            return None;
        }
        let history = outcome.history.as_ref()?;
        let head = &history.head;
        // What was recorded up to the touch.
        let end = head.time_s.partition_point(|&time_s| time_s <= t_fail_s);
        let (dimple_n, bearing_n) = (
            head.dimple_force_n.get(..end)?,
            head.bearing_force_n.get(..end)?,
        );
        let (first_n, last) = (*dimple_n.first()?, end.checked_sub(1)?);
        if first_n <= 0.0 {
            return None;
        }
        let before = |time_s: f64| (t_fail_s - time_s).max(0.0);
        let last_where = |column: &[f64], holds: fn(f64) -> bool| {
            let place = column.iter().take(end).rposition(|&value| holds(value))?;
            Some(before(head.time_s[place]))
        };
        let from = head
            .time_s
            .partition_point(|&time_s| time_s < t_fail_s - RANGE_S);
        let recent = &bearing_n[from.min(last)..];
        let largest = recent.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let smallest = recent.iter().copied().fold(f64::INFINITY, f64::min);
        let episodes = outcome.top.episodes.iter().chain(&outcome.bottom.episodes);
        let contact = episodes
            .filter(|episode| episode.on_s <= t_fail_s)
            .max_by(|a, b| a.off_s.total_cmp(&b.off_s));
        Some(FailureEvidence {
            dimple_open_before_s: last_where(dimple_n, |force_n| force_n <= 0.0),
            limiter_before_s: last_where(&head.limiter_force_n, |force_n| force_n != 0.0),
            lift_tab_before_s: last_where(&head.lift_tab_force_n, |force_n| force_n != 0.0),
            ramp_contact_before_s: contact.map(|episode| before(episode.off_s)),
            ramp_began_before_s: contact.map(|episode| before(episode.on_s)),
            dimple_over_steady: dimple_n[last] / first_n,
            bearing_over_steady: bearing_n[last] / first_n,
            bearing_range_over_steady: (largest - smallest) / first_n,
        })
    }

    /// The mechanism that these name.
    pub fn mechanism(&self) -> Mechanism {
        let recent = |time_s: Option<f64>| time_s.is_some_and(|time_s| time_s <= RECENT_S);
        let is_behind_impact = self
            .ramp_contact_before_s
            .is_some_and(|time_s| time_s <= IMPACT_S);
        if recent(self.limiter_before_s) {
            Mechanism::Limiter
        } else if recent(self.lift_tab_before_s) {
            Mechanism::LiftTab
        } else if recent(self.dimple_open_before_s) {
            Mechanism::DimpleSeparation
        } else if is_behind_impact && self.bearing_range_over_steady > LEAST_RANGE {
            Mechanism::RampImpact
        } else if self.bearing_over_steady < 0.0 {
            Mechanism::LiftLoss
        } else if self.dimple_over_steady > 1.0 && self.bearing_over_steady > 1.0 {
            Mechanism::Compression
        } else {
            Mechanism::Other
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The order of the rules, one figure at a time.
    #[test]
    fn the_first_rule_that_holds_names_the_mechanism() {
        let mut evidence = FailureEvidence {
            dimple_over_steady: 0.9,
            bearing_over_steady: 0.4,
            ..FailureEvidence::default()
        };
        let mut named = vec![evidence.mechanism()];
        let changes: [fn(&mut FailureEvidence); 9] = [
            |evidence| evidence.dimple_over_steady = 2.1,
            |evidence| evidence.bearing_over_steady = 2.3,
            |evidence| evidence.bearing_over_steady = -0.1,
            // Too far back, then with a small range.
            |evidence| {
                (
                    evidence.ramp_contact_before_s,
                    evidence.bearing_range_over_steady,
                ) = (Some(1.2e-4), 3.0)
            },
            |evidence| {
                (
                    evidence.ramp_contact_before_s,
                    evidence.bearing_range_over_steady,
                ) = (Some(5e-5), 0.2)
            },
            |evidence| evidence.bearing_range_over_steady = 0.4,
            |evidence| evidence.dimple_open_before_s = Some(2e-6),
            |evidence| evidence.lift_tab_before_s = Some(0.0),
            |evidence| evidence.limiter_before_s = Some(1.9e-5),
        ];
        for change in changes {
            change(&mut evidence);
            named.push(evidence.mechanism());
        }
        let expected = [
            Mechanism::Other,
            Mechanism::Other,
            Mechanism::Compression,
            Mechanism::LiftLoss,
            Mechanism::LiftLoss,
            Mechanism::LiftLoss,
            Mechanism::RampImpact,
            Mechanism::DimpleSeparation,
            Mechanism::LiftTab,
            Mechanism::Limiter,
        ];
        assert_eq!(named, expected);
        evidence.limiter_before_s = Some(2.1e-5);
        assert_eq!(evidence.mechanism(), Mechanism::LiftTab);
    }
}
