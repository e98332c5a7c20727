//! Random tables of failure: a critical amplitude for every point, first touch below it, and non-monotone
//! intervals (failure) in between that shift with the pulse width.

use std::collections::BTreeSet;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_study::search::{
    Campaign, Coordinates, Findings, MonotonicityScan, Probe, ProbeResult, Ramp, RunCost,
    SearchSettings, Sign, Touch, Verdict,
};
use opshock_study::sweep::{Onset, Simulator};

use crate::mock_sweep::settings;
use crate::seeded::Seeded;

/// Widths of a table, ms.
pub const WIDTHS_MS: [f64; 3] = [0.5, 1.0, 2.0];

/// A point of a table.
#[derive(Clone, Debug)]
pub struct TablePoint {
    /// Ramp, width, sign.
    pub at: Coordinates,
    /// Fails from here on, G.
    pub critical_g: f64,
    /// First touch, G; `None` without ramp.
    pub onset_g: Option<f64>,
    /// Intervals of failure, G, low end included, high end not.
    pub windows_g: Vec<(f64, f64)>,
    /// The clearance falls to nothing at the critical amplitude.
    pub has_margin: bool,
}

/// A table: two ramps (none, deformable), three widths, one sign.
#[derive(Clone, Debug)]
pub struct Table(pub Vec<TablePoint>);

impl TablePoint {
    /// Whether a shock fails.
    pub fn fails(&self, amplitude_g: f64) -> bool {
        let is_in = |&(low, high): &(f64, f64)| (low..high).contains(&amplitude_g);
        amplitude_g >= self.critical_g || self.windows_g.iter().any(is_in)
    }

    /// Smallest clearance of a survivor, m.
    pub fn margin_m(&self, amplitude_g: f64) -> f64 {
        if self.has_margin {
            1e-9 * (self.critical_g / amplitude_g).ln()
        } else {
            2e-9
        }
    }

    /// Lowest failing point of an amplitude grid within its range.
    pub fn lowest_failure(&self, settings: &SearchSettings) -> Option<i32> {
        let SearchSettings { grid, range, .. } = settings;
        (range.low..=range.high).find(|&node| self.fails(grid.amplitude_g(node)))
    }

    /// First touch as a search receives it.
    pub fn touch(&self) -> Touch {
        match self.onset_g {
            None => Touch::NoRamp,
            Some(onset_g) => Touch::At { onset_g },
        }
    }
}

impl Table {
    /// The table of a seed.
    pub fn random(seed: u64) -> Table {
        let mut seeded = Seeded::new(seed);
        let none_g = seeded.log_between(150.0, 1200.0);
        let none_slope = seeded.between(-0.4, 0.4);
        let deformable = seeded.between(0.5, 0.95);
        let slope = seeded.between(-0.3, 0.3);
        let touch = seeded.between(0.3, 0.97);
        // Windows between first touch and the critical amplitude: place and width as shares.
        let windows: Vec<(f64, f64, f64)> = (0..seeded.below(3))
            .map(|_| {
                let place = seeded.between(0.0, 1.0);
                let width = seeded.between(0.0, 0.25);
                (place, width, seeded.between(-0.2, 0.2))
            })
            .collect();
        let has_margin = seeded.once_in(2);
        let mut points = Vec::new();
        for ramp in [Ramp::None, Ramp::Deformable] {
            for pulse_ms in WIDTHS_MS {
                let bare_g = none_g * pulse_ms.powf(none_slope);
                let is_bare = ramp == Ramp::None;
                let share = deformable * pulse_ms.powf(slope);
                let critical_g = if is_bare {
                    bare_g
                } else {
                    bare_g * share.min(1.0)
                };
                let onset_g = (!is_bare).then_some(critical_g * touch);
                let windows_g = windows
                    .iter()
                    .filter(|_| !is_bare)
                    .map(|&(place, width, drift)| {
                        let place = place + drift * pulse_ms.ln();
                        let low = critical_g * touch.powf(1.0 - place.clamp(0.0, 1.0));
                        (low, low * (1.0 + width))
                    })
                    .collect();
                points.push(TablePoint {
                    at: Coordinates {
                        ramp,
                        pulse_ms,
                        sign: Sign::Plus,
                        axes: Vec::new(),
                        round: 0,
                        fail_below_m: 0.0,
                        clearance_axis: None,
                    },
                    critical_g,
                    onset_g,
                    windows_g,
                    has_margin,
                });
            }
        }
        Table(points)
    }

    /// Searches the table, the points served in the order of `seeded`.
    ///
    /// # Panics
    /// When nobody asks and not everything is answered.
    pub fn search(
        &self,
        monotonicity_scan: MonotonicityScan,
        seeded: &mut Seeded,
    ) -> Vec<Searched> {
        let settings = SearchSettings {
            window_check: false,
            ..settings(monotonicity_scan)
        };
        let coordinates: Vec<Coordinates> = self.0.iter().map(|point| point.at.clone()).collect();
        let mut campaign = Campaign::new(settings, &coordinates);
        for (place, point) in self.0.iter().enumerate() {
            campaign.set_touch(place, point.touch());
        }
        let mut asking: Vec<usize> = Vec::new();
        loop {
            for place in campaign.take_changed() {
                if !asking.contains(&place) && campaign.ask(place).is_some() {
                    asking.push(place);
                }
            }
            if asking.is_empty() {
                break;
            }
            let turn = seeded.below(asking.len());
            let place = asking[turn];
            let Some(asked) = campaign.ask(place) else {
                asking.swap_remove(turn);
                continue;
            };
            let probe = asked.probe;
            let amplitude_g = settings.grid.amplitude_g(probe.index);
            let point = &self.0[place];
            if point.fails(amplitude_g) {
                campaign.tell(place, &failure());
            } else {
                let margin = Some(point.margin_m(amplitude_g));
                campaign.report_margin(place, &Verdict::Survives, margin);
            }
        }
        assert!(campaign.is_done(), "nobody asks");
        (0..self.0.len())
            .map(|place| Searched {
                findings: campaign.findings(place),
                tested: campaign.search(place).map_or_else(BTreeSet::new, |search| {
                    search.log().iter().map(|asked| asked.probe.index).collect()
                }),
            })
            .collect()
    }
}

/// What a search found, and the grid points that it tested.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    /// The answer.
    pub findings: Findings,
    /// Points of the amplitude grid.
    pub tested: BTreeSet<i32>,
}

/// A failure without further facts.
pub fn failure() -> Verdict {
    Verdict::Fails {
        t_fail_s: 1e-3,
        x_m: 0.0,
        y_m: 0.0,
    }
}

/// Halves the whole range down to neighbouring grid points, failure taken to be monotone: lowest failing
/// point found and simulations made.
pub fn plain_bisection(settings: &SearchSettings, fails: impl Fn(f64) -> bool) -> (i32, u64) {
    let SearchSettings { grid, range, .. } = settings;
    let (mut low, mut high, mut runs) = (range.low, range.high, 2);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        runs += 1;
        if fails(grid.amplitude_g(middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    (high, runs)
}

impl Simulator for Table {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let point = &self.0[point];
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        let fails = point.fails(amplitude_g);
        ProbeResult {
            verdict: if fails { failure() } else { Verdict::Survives },
            h_min_m: (!fails).then(|| point.margin_m(amplitude_g)),
            t_min_s: (!fails).then_some(1e-3),
            cost: RunCost {
                steps: amplitude_g as u64 * u64::from(probe.window_factor),
                ..RunCost::default()
            },
        }
    }

    fn onset(&self, point: usize) -> Onset {
        match self.0[point].onset_g {
            None => Onset::NoRamp,
            Some(onset_g) => Onset::At {
                amplitude_m_per_s2: onset_g * STANDARD_GRAVITY_M_PER_S2,
            },
        }
    }
}
