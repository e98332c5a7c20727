//! Measures answers and cost of one setting of a discretisation parameter.

use std::time::Instant;

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Outcome, Request, Scope, Verdict, Workspace, simulate};
use serde::{Deserialize, Serialize};

/// Answers and cost of a setting.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Why there is no answer.
    pub failure: Option<String>,
    /// Critical shock, G.
    pub critical_g: Option<f64>,
    /// Width of its bracket, G.
    pub bracket_g: f64,
    /// Shocks simulated for it.
    pub critical_runs: u64,
    /// Flying height before the shock, m.
    pub flying_height_m: f64,
    /// Smallest clearance of the probing shock, m.
    pub min_clearance_m: f64,
    /// Impulse of its contacts with the ramp, N s.
    pub contact_impulse_n_s: f64,
    /// Largest displacement of the rim, m.
    pub rim_m: f64,
    /// Largest displacement of the disk under the slider, m.
    pub slider_m: f64,
    /// First touch of disk and ramp, s.
    pub first_touch_s: Option<f64>,
    /// Film solves times film unknowns of the probing shock.
    pub work: u64,
    /// Structure steps of it.
    pub structure_steps: u64,
    /// Wall times of the probing shock, s.
    pub wall_s: Vec<f64>,
    /// Time to build the model, s.
    pub build_s: f64,
}

/// First step of the exponential search for the bracket, as a ratio.
const STEP: f64 = 1.01;
/// Largest step of the exponential search.
const LONGEST_STEP: f64 = 1.5;
/// Largest distance of a setting's answer, as a ratio; beyond it there is none.
const FARTHEST: f64 = 10.0;

/// A model with its workspace, for shocks of one sign.
pub struct Bench {
    model: Model,
    sign: f64,
    workspace: Workspace,
    build_s: f64,
}

impl Bench {
    /// Builds a scene.
    ///
    /// # Errors
    ///
    /// The solver's sentence.
    pub fn build(scene: &Scene, sign: f64) -> Result<Bench, String> {
        let began = Instant::now();
        let model = Model::build(scene, Scope::Full, None).map_err(|error| error.to_string())?;
        Ok(Bench {
            model,
            sign,
            workspace: Workspace::default(),
            build_s: began.elapsed().as_secs_f64(),
        })
    }

    /// One shock, ending at touch.
    pub fn probe(&mut self, amplitude_g: f64) -> Outcome {
        let request = Request {
            amplitude_m_per_s2: self.sign * m_per_s2_from_g(amplitude_g),
            record: false,
        };
        simulate(&self.model, &request, &mut self.workspace)
    }

    /// Wall time of one shock, s.
    pub fn time(&mut self, amplitude_g: f64) -> f64 {
        let began = Instant::now();
        self.probe(amplitude_g);
        began.elapsed().as_secs_f64()
    }

    /// Probing shock and critical shock, looked for from `near_g` to a relative width `bracket`.
    pub fn measure(&mut self, probe_g: f64, near_g: f64, bracket: f64) -> Measured {
        let outcome = self.probe(probe_g);
        let touch = [outcome.top.first_touch_s, outcome.bottom.first_touch_s];
        let mut measured = Measured {
            flying_height_m: outcome.steady.map_or(0.0, |steady| steady.min_clearance_m),
            min_clearance_m: outcome.min_clearance_m.unwrap_or(0.0),
            contact_impulse_n_s: outcome.top.impulse_n_s + outcome.bottom.impulse_n_s,
            rim_m: outcome.disk.rim_max_m,
            slider_m: outcome
                .disk
                .slider_max_m
                .abs()
                .max(outcome.disk.slider_min_m.abs()),
            first_touch_s: touch.into_iter().flatten().min_by(f64::total_cmp),
            work: outcome.cost.film_solves * outcome.cost.film_unknowns,
            structure_steps: outcome.cost.structure_steps,
            build_s: self.build_s,
            ..Measured::default()
        };
        match self.critical(near_g, bracket) {
            Ok((low, high, runs)) => {
                measured.critical_g = Some(0.5 * (low + high));
                measured.bracket_g = high - low;
                measured.critical_runs = runs;
            }
            Err(reason) => measured.failure = Some(reason),
        }
        measured
    }

    /// Survivor and failure near `from_g`, and the shocks it took.
    fn critical(&mut self, from_g: f64, bracket: f64) -> Result<(f64, f64, u64), String> {
        let (mut low, mut high): (Option<f64>, Option<f64>) = (None, None);
        let (mut at, mut stride) = (from_g, STEP);
        let mut runs = 0;
        loop {
            if at > from_g * FARTHEST || at < from_g / FARTHEST {
                return Err(format!(
                    "no critical shock within a factor {FARTHEST} of {from_g:.1} G"
                ));
            }
            runs += 1;
            match self.probe(at).verdict {
                Some(Verdict::Survives) => low = Some(at),
                Some(Verdict::Fails { .. }) => high = Some(at),
                Some(Verdict::Undecided { cause }) => {
                    return Err(format!("undecided at {at:.2} G: {cause}"));
                }
                None => return Err("no head is simulated".to_owned()),
            }
            match (low, high) {
                (Some(low), Some(high)) if high / low - 1.0 <= bracket => {
                    return Ok((low, high, runs));
                }
                (Some(low), Some(high)) => at = (low * high).sqrt(),
                (Some(low), None) => {
                    at = low * stride;
                    stride = (stride * stride).min(LONGEST_STEP);
                }
                (None, high) => {
                    at = high.unwrap_or(at) / stride;
                    stride = (stride * stride).min(LONGEST_STEP);
                }
            }
        }
    }

    /// Amplitude of a point's first touch, G.
    pub fn onset_g(&self) -> Option<f64> {
        let onset = self
            .model
            .structure()
            .touch_amplitude_m_per_s2(self.sign > 0.0);
        onset.map(|amplitude| amplitude / STANDARD_GRAVITY_M_PER_S2)
    }
}
