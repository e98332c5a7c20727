//! Studies whose answers are known without physics, and simulators that misbehave on purpose.

use std::io::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::simulation::{self, History, Outcome, StructureColumns};
use opshock_study::search::{
    Coordinates, MonotonicityScan, Probe, ProbeResult, Ramp, RunCost, SearchSettings, Sign,
    UndecidedCause, Verdict,
};
use opshock_study::store::{PointDigest, StudyTexts};
use opshock_study::study::KeepHistories;
use opshock_study::sweep::{Event, Onset, PointFilm, Progress, Simulator, SweepInput, SweepPoint};

/// Widths of the paper's figure, ms.
pub const WIDTHS_MS: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];

/// A study over these ramps and widths, both signs, 20 to 2000 G at 1 %.
pub fn study(ramps: &[Ramp], widths_ms: &[f64]) -> SweepInput {
    let mut points = Vec::new();
    for &ramp in ramps {
        for &pulse_ms in widths_ms {
            for sign in [Sign::Plus, Sign::Minus] {
                points.push(SweepPoint {
                    coordinates: Coordinates {
                        ramp,
                        pulse_ms,
                        sign,
                        axes: Vec::new(),
                        round: 0,
                        fail_below_m: 0.0,
                        clearance_axis: None,
                    },
                    axes: Vec::new(),
                    digest: digest(&format!("{ramp} {pulse_ms} {sign:?}")),
                    below_continuum: false,
                    film: PointFilm {
                        number: 0,
                        cells: 1000,
                        kept: [false; 2],
                    },
                    uncertainty: None,
                });
            }
        }
    }
    SweepInput {
        texts: StudyTexts {
            name: "mock".into(),
            digest: "0123".into(),
            file: None,
            given: "name = \"mock\"\n".into(),
            resolved: "name = \"mock\"\n".into(),
        },
        plan: "{}".into(),
        axes: Vec::new(),
        points,
        decides: None,
        settings: settings(MonotonicityScan::Sampled),
        checkpoint: Duration::from_secs(30),
        start_s: 5e-4,
        keep_histories: KeepHistories::Bracket,
    }
}

/// The 36 points of the paper's figure.
pub fn fig13() -> SweepInput {
    study(&[Ramp::None, Ramp::Rigid, Ramp::Deformable], &WIDTHS_MS)
}

/// 20 to 2000 G, 1 %, gaps of at most 10 %, window check on.
pub fn settings(monotonicity_scan: MonotonicityScan) -> SearchSettings {
    SearchSettings::new((20.0, 2000.0), 0.01, monotonicity_scan, 0.10, true).expect("settings")
}

/// A digest out of a text: two FNV hashes, enough to tell test points apart.
pub fn digest(text: &str) -> PointDigest {
    let mut bytes = [0; 32];
    for (lane, chunk) in bytes.chunks_exact_mut(8).enumerate() {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64 ^ (lane as u64 * 0x9e37_79b9);
        for byte in text.bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        chunk.copy_from_slice(&hash.to_le_bytes());
    }
    PointDigest(bytes)
}

/// Something that goes wrong in a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Poison {
    /// Panics at every probe.
    Panic,
    /// Survives with a clearance that is not a number.
    NotANumber,
    /// Never converges.
    NeverConverges,
}

/// A run of this length no test waits for.
const OUTLASTING: Duration = Duration::from_secs(60);

/// A law of failure with first touches, costs and poison.
pub struct MockSimulator<'a> {
    input: &'a SweepInput,
    /// Time each run takes. One that outlasts any test prints `begun` first.
    pub sleep: Duration,
    /// Whether histories can be recorded.
    pub records: bool,
    /// What is wrong with which point.
    pub poison: Vec<(Coordinates, Poison)>,
    calls: AtomicU64,
    /// Runs going on now, and runs that began or ended beside another one.
    running: AtomicU64,
    accompanied: AtomicU64,
}

impl<'a> MockSimulator<'a> {
    /// The paper-like law over the points of `input`.
    pub fn new(input: &'a SweepInput) -> MockSimulator<'a> {
        MockSimulator {
            input,
            sleep: Duration::ZERO,
            records: false,
            poison: Vec::new(),
            calls: AtomicU64::new(0),
            running: AtomicU64::new(0),
            accompanied: AtomicU64::new(0),
        }
    }

    /// Simulations made.
    pub fn calls(&self) -> u64 {
        self.calls.load(Ordering::SeqCst)
    }

    /// Simulations beside which another one was running when they began or ended.
    pub fn accompanied(&self) -> u64 {
        self.accompanied.load(Ordering::SeqCst)
    }
}

/// Critical amplitudes shaped like the paper's, with intervals of failure for the deformable ramp at
/// short positive pulses and a late failure for the rigid ramp at 2 ms.
pub fn fails(at: &Coordinates, amplitude_g: f64, window_factor: u8) -> bool {
    let none = if at.sign == Sign::Plus { 500.0 } else { 380.0 } * at.pulse_ms.powf(-0.2);
    match at.ramp {
        Ramp::None => amplitude_g >= none,
        Ramp::Rigid => {
            let late = at.pulse_ms == 2.0 && window_factor == 2;
            let critical = 260.0 * at.pulse_ms.powf(-0.35) * if late { 0.97 } else { 1.0 };
            amplitude_g >= critical.min(none)
        }
        Ramp::Deformable => {
            let window = at.pulse_ms < 0.9
                && at.sign == Sign::Plus
                && (150.0..150.0 + 24.0 * at.pulse_ms).contains(&amplitude_g);
            window || amplitude_g >= (300.0 * at.pulse_ms.powf(0.1)).min(none)
        }
    }
}

/// Amplitude of first touch, G.
pub fn onset_g(at: &Coordinates) -> Option<f64> {
    match at.ramp {
        Ramp::None => None,
        Ramp::Rigid => Some(190.0 * at.pulse_ms.powf(-0.35)),
        Ramp::Deformable => Some(120.0 * at.pulse_ms.powf(-0.1)),
    }
}

impl Simulator for MockSimulator<'_> {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        self.calls.fetch_add(1, Ordering::SeqCst);
        let beside_at_start = self.running.fetch_add(1, Ordering::SeqCst) > 0;
        if self.sleep >= OUTLASTING {
            // A reader that went away must not end a run.
            let _ = writeln!(std::io::stdout(), "begun");
        }
        std::thread::sleep(self.sleep * u32::from(probe.window_factor));
        let beside_at_end = self.running.fetch_sub(1, Ordering::SeqCst) > 1;
        if beside_at_start || beside_at_end {
            self.accompanied.fetch_add(1, Ordering::SeqCst);
        }
        let at = &self.input.points[point].coordinates;
        assert_eq!(amplitude_m_per_s2.signum(), at.sign.factor());
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        let poison = self
            .poison
            .iter()
            .find(|(poisoned, _)| poisoned == at)
            .map(|(_, poison)| *poison);
        let mut result = ProbeResult {
            verdict: if fails(at, amplitude_g, probe.window_factor) {
                Verdict::Fails {
                    t_fail_s: 1e-3 / amplitude_g,
                    x_m: 8e-4,
                    y_m: 0.0,
                }
            } else {
                Verdict::Survives
            },
            h_min_m: Some(1e-9 / amplitude_g),
            t_min_s: Some(1e-3),
            cost: RunCost {
                steps: amplitude_g as u64,
                film_solves: 3 * amplitude_g as u64,
                film_unknowns: 2000,
                ..RunCost::default()
            },
        };
        match poison {
            None => {}
            Some(Poison::Panic) => panic!("injected panic of {point}"),
            Some(Poison::NotANumber) => {
                result.verdict = Verdict::Survives;
                result.h_min_m = Some(f64::NAN);
            }
            Some(Poison::NeverConverges) => {
                result.verdict = Verdict::Undecided {
                    cause: UndecidedCause::NotConverged,
                    message: "residual 1e-2 at 0.4 ms".into(),
                };
            }
        }
        result
    }

    fn record(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> Option<Outcome> {
        let result = self.simulate(point, probe, amplitude_m_per_s2);
        let column = vec![0.0, 1.0];
        let structure = StructureColumns {
            time_s: column.clone(),
            shock_m_per_s2: column.clone(),
            disk_slider_m: column.clone(),
            disk_ramp_m: column.clone(),
            disk_rim_m: column.clone(),
            disk_pitch_rad: column.clone(),
            disk_roll_rad: column.clone(),
            ramp_top_m: column.clone(),
            ramp_bottom_m: column.clone(),
            contact_top_n: column.clone(),
            contact_bottom_n: column.clone(),
            energy_j: column.clone(),
            energy_h_j: column,
            ..StructureColumns::default()
        };
        self.records.then(|| Outcome {
            hub: None,
            base: None,
            verdict: match result.verdict {
                Verdict::Survives => Some(simulation::Verdict::Survives),
                Verdict::Fails { t_fail_s, x_m, y_m } => Some(simulation::Verdict::Fails {
                    t_fail_s,
                    place: simulation::Place { x_m, y_m },
                }),
                Verdict::Undecided { .. } => unreachable!("only decided runs are kept"),
            },
            min_clearance_m: result.h_min_m,
            t_min_clearance_s: result.t_min_s,
            lowest: None,
            steady: None,
            disk: Default::default(),
            top: Default::default(),
            bottom: Default::default(),
            limiters: None,
            lift_tab: None,
            slider_contact: None,
            dimple: None,
            energy: Default::default(),
            complementarity: Default::default(),
            rules: vec!["R2", "R10"],
            effects: vec!["disk.bending"],
            warnings: Vec::new(),
            cost: Default::default(),
            history: Some(History {
                fields: None,
                structure,
                head: Default::default(),
            }),
        })
    }

    fn onset(&self, point: usize) -> Onset {
        match onset_g(&self.input.points[point].coordinates) {
            None => Onset::NoRamp,
            Some(onset_g) => Onset::At {
                amplitude_m_per_s2: onset_g * STANDARD_GRAVITY_M_PER_S2,
            },
        }
    }
}

/// Keeps every event.
#[derive(Debug, Default)]
pub struct Recorder(Mutex<Vec<Event>>);

impl Recorder {
    /// Events so far.
    pub fn events(&self) -> Vec<Event> {
        self.0.lock().expect("not poisoned").clone()
    }

    /// Codes of the warnings.
    pub fn warnings(&self) -> Vec<&'static str> {
        self.events()
            .iter()
            .filter_map(|event| match event {
                Event::Warning { code, .. } => Some(*code),
                _ => None,
            })
            .collect()
    }
}

impl Progress for Recorder {
    fn event(&self, event: &Event) {
        self.0.lock().expect("not poisoned").push(event.clone());
    }
}
