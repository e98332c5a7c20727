//! Made-up ends of the searches of a sweep: its own searches, run on from what is known with made-up verdicts.
//!
//! A table of failure has a fixed seed, the study's own first touches, the verdicts that are known, and of each ramp model
//! one critical shock that is known.

use std::collections::HashSet;

use super::input::SweepInput;
use super::registry::Registry;
use crate::search::evidence::AmplitudeVerdict;
use crate::search::{
    Asked, Campaign, Coordinates, Probe, ProbeResult, Ramp, RunCost, Sign, Touch, Verdict,
};

/// Numbers that look random and are the same everywhere (splitmix64).
pub(super) struct Random(pub(super) u64);

impl Random {
    /// Uniform in 0..1.
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Standard normal, by twelve uniform numbers.
    pub(super) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// Searches at their made-up end.
pub(super) struct Ended {
    /// The searches.
    pub(super) campaign: Campaign,
    /// Requests of each point that have not been simulated, and whether they fail.
    pub(super) new: Vec<Vec<(Asked, bool)>>,
}

/// Ends the searches of `registry` by the table `sample`. First touches that it lacks come from `touches`.
pub(super) fn ended(
    input: &SweepInput,
    registry: &Registry<'_>,
    touches: &[Touch],
    sample: u64,
) -> Ended {
    let mut campaign = registry.campaign().clone();
    for (point, &touch) in touches.iter().enumerate() {
        if campaign.touch(point).is_none() {
            campaign.set_touch(point, touch);
        }
    }
    let law = Law::of(input, touches, sample).through_known(input, registry, touches);
    let mut new = vec![Vec::new(); input.points.len()];
    // Points of equal content share their runs.
    let mut counted = HashSet::new();
    let mut n_answered = usize::MAX;
    while !campaign.is_done() && n_answered > 0 {
        n_answered = 0;
        for (point, one) in input.points.iter().enumerate() {
            while let Some(asked) = campaign.ask(point) {
                n_answered += 1;
                let key = registry.key(point, asked.probe);
                if let Some(known) = registry.runs().get(&key) {
                    let result = &known.result;
                    campaign.report_margin(point, &result.verdict, result.h_min_m);
                    continue;
                }
                let grid_point = asked.probe.index;
                let amplitude_g = input.settings.grid.amplitude_g(grid_point);
                let (at, touch) = (&one.coordinates, touches[point]);
                // An own run has the verdict that its search began with.
                let own = campaign
                    .search(point)
                    .and_then(|search| search.evidence().get(grid_point));
                let fails = match own {
                    Some(own) => own == AmplitudeVerdict::Fails,
                    None => known_to_fail(registry, point, grid_point)
                        .unwrap_or_else(|| law.fails(at, touch, amplitude_g)),
                };
                // It says something to larger clearances called failure, and is no guide within a search.
                let says = !fails && at.clearance_axis.is_some();
                let h_min_m = says.then(|| {
                    let octaves = (law.critical_g(at, touch) / amplitude_g).log2();
                    at.fail_below_m + CLEARANCE_PER_OCTAVE_M * octaves.max(0.0)
                });
                if counted.insert(key) {
                    new[point].push((asked, fails));
                }
                campaign.report_margin(point, &verdict(fails), h_min_m);
            }
        }
    }
    Ended { campaign, new }
}

/// The side of the known bracket on which a grid point of the search lies; `None` inside.
fn known_to_fail(registry: &Registry<'_>, point: usize, grid_point: i32) -> Option<bool> {
    let evidence = registry.campaign().search(point)?.evidence();
    let failure = evidence.lowest_failure();
    if failure.is_some_and(|failure| grid_point >= failure) {
        return Some(true);
    }
    let survivor = evidence.highest_survivor_below(failure)?;
    (grid_point <= survivor).then_some(false)
}

fn verdict(fails: bool) -> Verdict {
    if fails {
        Verdict::Fails {
            t_fail_s: EVENT_S,
            x_m: 0.0,
            y_m: 0.0,
        }
    } else {
        Verdict::Survives
    }
}

/// Instant of the made-up touch.
const EVENT_S: f64 = 1e-3;
/// Clearance that a made-up survivor loses for each octave of amplitude, m.
const CLEARANCE_PER_OCTAVE_M: f64 = 2e-8;

impl Ended {
    /// Made-up result of a probe of `point`; in a share of the points the survivors come close at another instant than
    /// that of the touch (committed studies: half of those without ramp, four fifths of the others).
    pub(super) fn result(
        &self,
        input: &SweepInput,
        point: usize,
        probe: Probe,
        share: f64,
    ) -> ProbeResult {
        let fail_below_m = input.points[point].coordinates.fail_below_m;
        let failure = self.campaign.findings(point).failure;
        let grid_points = failure.map_or(1, |failure| failure - probe.index);
        let of_event = match input.points[point].coordinates.ramp {
            Ramp::None => 0.5,
            Ramp::Rigid | Ramp::Deformable => 0.2,
        };
        let octaves = f64::from(grid_points) / f64::from(input.settings.grid.steps_per_octave);
        ProbeResult {
            verdict: verdict(grid_points <= 0),
            h_min_m: (grid_points > 0).then_some(fail_below_m + CLEARANCE_PER_OCTAVE_M * octaves),
            t_min_s: Some(if share < of_event {
                EVENT_S
            } else {
                2.0 * EVENT_S
            }),
            cost: RunCost::default(),
        }
    }
}

/// A made-up table: without ramp a power law of the width; with one, between first touch and that.
struct Law {
    none_g: f64,
    slope: f64,
    /// Factor of negative shocks.
    minus: f64,
    /// Place between first touch and the answer without ramp, rigid and deformable, and how it
    /// changes with the width.
    place: [f64; 2],
    drift: f64,
    /// A non-monotone interval as shares of the amplitude that fails.
    window: Option<(f64, f64)>,
}

impl Law {
    fn of(input: &SweepInput, touches: &[Touch], sample: u64) -> Law {
        let mut random = Random(sample);
        let mut share = || random.unit();
        let grid = input.settings.grid;
        let highest_g = grid.amplitude_g(input.settings.range.high);
        let lowest_g = touches
            .iter()
            .filter_map(|touch| touch.onset_g())
            .fold(grid.amplitude_g(input.settings.range.low), f64::max)
            .min(highest_g);
        Law {
            none_g: lowest_g * (highest_g / lowest_g).powf(0.7 * share()),
            slope: 0.6 * (share() - 0.5),
            minus: 1.0 + 0.5 * share(),
            place: [0.1 + 0.5 * share(), 0.8 * share().powi(2)],
            drift: 0.3 * share(),
            window: (share() < 0.25).then(|| {
                let low = 0.7 + 0.25 * share();
                (low, low * (1.02 + 0.1 * share()))
            }),
        }
    }

    /// This table moved so that it goes through one critical shock that is known, to a quarter of an octave, of each ramp model.
    fn through_known(
        mut self,
        input: &SweepInput,
        registry: &Registry<'_>,
        touches: &[Touch],
    ) -> Law {
        let octave = input.settings.grid.steps_per_octave;
        for ramp in [Ramp::None, Ramp::Rigid, Ramp::Deformable] {
            let known = input.points.iter().enumerate().find_map(|(point, one)| {
                let evidence = registry.campaign().search(point)?.evidence();
                let failure = evidence.lowest_failure()?;
                let survivor = evidence.highest_survivor_below(Some(failure))?;
                let is_it = one.coordinates.ramp == ramp && 4 * (failure - survivor) <= octave;
                let known_g = input.settings.grid.amplitude_g(survivor);
                is_it.then_some((&one.coordinates, touches[point], known_g))
            });
            let Some((at, touch, known_g)) = known else {
                continue;
            };
            let none_g = self.none_g(at);
            match touch {
                Touch::At { onset_g } if ramp != Ramp::None => {
                    if none_g < known_g {
                        self.none_g *= known_g / none_g;
                    }
                    let span = (self.none_g(at) / onset_g).max(1.001).ln();
                    let place = (known_g / onset_g).ln() / span - self.drift * at.pulse_ms.ln();
                    self.place[usize::from(ramp == Ramp::Deformable)] = place;
                }
                _ => self.none_g *= known_g / none_g,
            }
        }
        self
    }

    /// Critical amplitude without ramp.
    fn none_g(&self, at: &Coordinates) -> f64 {
        let sign = match at.sign {
            Sign::Plus => 1.0,
            Sign::Minus => self.minus,
        };
        self.none_g * sign * at.pulse_ms.powf(self.slope)
    }

    /// Critical amplitude.
    fn critical_g(&self, at: &Coordinates, touch: Touch) -> f64 {
        let none_g = self.none_g(at);
        let (Touch::At { onset_g }, false) = (touch, at.ramp == Ramp::None) else {
            return none_g;
        };
        let place = self.place[usize::from(at.ramp == Ramp::Deformable)];
        let place = (place + self.drift * at.pulse_ms.ln()).clamp(0.02, 0.95);
        let critical_g = onset_g * (none_g / onset_g).max(1.0).powf(place);
        critical_g.min(none_g)
    }

    fn fails(&self, at: &Coordinates, touch: Touch, amplitude_g: f64) -> bool {
        let critical_g = self.critical_g(at, touch);
        let is_in = |(low, high): (f64, f64)| {
            let is_touched = touch.onset_g().is_some_and(|onset_g| amplitude_g > onset_g);
            at.ramp != Ramp::None
                && is_touched
                && (low * critical_g..high * critical_g).contains(&amplitude_g)
        };
        amplitude_g >= critical_g || self.window.is_some_and(is_in)
    }
}
