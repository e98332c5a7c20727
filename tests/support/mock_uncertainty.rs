//! Critical shocks that are known: laws of failure in which every discretisation parameter has a known error.

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_study::search::{MonotonicityScan, Probe, ProbeResult, Ramp, RunCost, Verdict};
use opshock_study::sweep::{Onset, Simulator, SweepInput, UncertaintyPlan};

use super::mock_sweep::{settings, study};

/// Numbers that look random and are the same everywhere (splitmix64).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }
}

/// How one discretisation parameter's error falls.
#[derive(Clone, Copy, Debug)]
struct DiscretisationLaw {
    /// Error with the discretisation parameter as the study has it, as a share of the answer.
    error: f64,
    /// Divisor of the error by one refinement step.
    ratio: f64,
    /// Share of the error that alternates from level to level.
    disorder: f64,
}

impl DiscretisationLaw {
    fn at(&self, level: i8) -> f64 {
        let flip = if level.rem_euclid(2) == 1 { -1.0 } else { 1.0 };
        self.error * self.ratio.powi(-i32::from(level)) * (1.0 + flip * self.disorder)
    }
}

/// A law of failure with a known critical amplitude.
#[derive(Clone, Debug)]
pub struct UncertaintyLaw {
    /// Critical amplitude with every discretisation parameter infinitely fine, G.
    pub exact_g: f64,
    discretisations: [DiscretisationLaw; 7],
    /// Clearance lost per relative growth of the amplitude, m; `None`: survival ends abruptly.
    slope_m: Option<f64>,
    /// Curvature of the clearance over its slope.
    curvature: f64,
}

impl UncertaintyLaw {
    /// A law of a seed: discretisation parameters of 0.01 to 2 %, most near their formal order, one in five without
    /// any order, two in five failures abrupt.
    pub fn of(seed: u64) -> UncertaintyLaw {
        let mut random = Random(seed.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ 0xacc);
        let discretisations = Discretisation::ALL.map(|discretisation| {
            let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
            let disordered = random.unit() < 0.2;
            DiscretisationLaw {
                error: sign * random.log_between(1e-4, 2e-2),
                ratio: discretisation.formal_ratio() * random.log_between(0.75, 1.5),
                disorder: if disordered {
                    random.between(0.1, 0.6)
                } else {
                    0.0
                },
            }
        });
        UncertaintyLaw {
            exact_g: random.log_between(100.0, 1000.0),
            discretisations,
            slope_m: (random.unit() < 0.6).then(|| random.log_between(2e-9, 2e-7)),
            curvature: random.between(-1.0, 3.0),
        }
    }

    /// Critical amplitude at some levels, G.
    pub fn critical_g(&self, levels: Levels) -> f64 {
        let errors = Discretisation::ALL.iter().zip(&self.discretisations);
        let sum: f64 = errors
            .map(|(&discretisation, law)| law.at(levels.of(discretisation)))
            .sum();
        self.exact_g * (1.0 + sum)
    }

    fn answer(&self, levels: Levels, amplitude_g: f64) -> ProbeResult {
        let lead = self.critical_g(levels) / amplitude_g - 1.0;
        let (h_min_m, t_min_s) = match self.slope_m {
            Some(slope_m) => (slope_m * lead * (1.0 + self.curvature * lead), 1e-3),
            None => (2e-9, 2e-3),
        };
        let cells = 1000.0 * 2f64.powi(i32::from(levels.of(Discretisation::FilmGrid)));
        ProbeResult {
            verdict: if lead > 0.0 {
                Verdict::Survives
            } else {
                Verdict::Fails {
                    t_fail_s: 1e-3,
                    x_m: 8e-4,
                    y_m: 0.0,
                }
            },
            h_min_m: Some(if lead > 0.0 { h_min_m.max(0.0) } else { 0.0 }),
            t_min_s: Some(t_min_s),
            cost: RunCost {
                film_solves: 1000,
                film_unknowns: cells as u64,
                ..RunCost::default()
            },
        }
    }
}

/// A study of one law a point, with uncertainty intervals.
pub fn laws_study(n: usize) -> SweepInput {
    let widths: Vec<f64> = (0..n.div_ceil(2)).map(|i| 0.5 + 0.01 * i as f64).collect();
    let mut input = study(&[Ramp::None], &widths);
    input.points.truncate(n);
    input.settings = settings(MonotonicityScan::Off);
    for point in &mut input.points {
        point.uncertainty = Some(UncertaintyPlan {
            discretisations: Discretisation::ALL.to_vec(),
            film_halvings: 3,
            mesh_halvings: 0,
            hard_contact: false,
            target: 0.01,
            refinements: 0,
        });
    }
    input
}

/// Answers by the laws of the points.
#[derive(Clone, Debug)]
pub struct LawSimulator(pub Vec<UncertaintyLaw>);

impl LawSimulator {
    /// Laws of consecutive seeds.
    pub fn of(first: u64, n: usize) -> LawSimulator {
        LawSimulator((first..).take(n).map(UncertaintyLaw::of).collect())
    }
}

impl Simulator for LawSimulator {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        self.0[point].answer(probe.levels, amplitude_g)
    }

    fn onset(&self, _: usize) -> Onset {
        Onset::NoRamp
    }
}
