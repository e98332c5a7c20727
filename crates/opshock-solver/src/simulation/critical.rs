//! Finds the critical shock of one model by bisection over the amplitude.

use super::model::Model;
use super::outcome::Verdict;
use super::run::{Request, Workspace, simulate};
use thiserror::Error;

/// Two amplitudes between which the verdict changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalShock {
    /// Signed amplitude that survives, m/s2.
    pub survives_m_per_s2: f64,
    /// Signed amplitude that fails, m/s2.
    pub fails_m_per_s2: f64,
    /// Shocks simulated.
    pub n_runs: usize,
}

/// Why there is no critical shock.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CriticalShockError {
    /// The range has no weaker and stronger amplitude of one sign, or the tolerance is not positive.
    #[error(
        "no range to bisect: {range_m_per_s2:?} m/s2 within {tolerance}; wanted are two amplitudes of one sign, the weaker \
         first, and a tolerance above 0"
    )]
    Range {
        /// The range given, m/s2.
        range_m_per_s2: [f64; 2],
        /// The tolerance given.
        tolerance: f64,
    },
    /// The weakest shock fails, or the strongest survives.
    #[error("no change of verdict: {amplitude_m_per_s2:e} m/s2 {verdict}")]
    NotBracketed {
        /// That end of the range, m/s2.
        amplitude_m_per_s2: f64,
        /// "survives" or "fails".
        verdict: &'static str,
    },
    /// A shock has no verdict.
    #[error("no verdict at {amplitude_m_per_s2:e} m/s2: {cause}")]
    Undecided {
        /// Its amplitude, m/s2.
        amplitude_m_per_s2: f64,
        /// Why.
        cause: String,
    },
}

/// Bisects between the signed amplitudes `range_m_per_s2`, the weaker one first, both of one sign, until they differ by
/// at most a share `tolerance` of the weaker.
///
/// It finds *one* change of the verdict. Verdicts need not be monotone in the amplitude: the sweep of a study also
/// scans below the failure it finds.
///
/// # Errors
/// [`CriticalShockError`], also for a model without a head, which has no verdict.
pub fn critical_shock(
    model: &Model,
    range_m_per_s2: [f64; 2],
    tolerance: f64,
    workspace: &mut Workspace,
) -> Result<CriticalShock, CriticalShockError> {
    let [mut low, mut high] = range_m_per_s2;
    let ratio = high / low;
    if !(ratio > 1.0 && ratio.is_finite() && tolerance > 0.0) {
        return Err(CriticalShockError::Range {
            range_m_per_s2,
            tolerance,
        });
    }
    let mut n_runs = 0;
    let mut survives = |amplitude_m_per_s2: f64| {
        n_runs += 1;
        let request = Request {
            amplitude_m_per_s2,
            record: false,
        };
        let undecided = |cause: String| CriticalShockError::Undecided {
            amplitude_m_per_s2,
            cause,
        };
        match simulate(model, &request, workspace).verdict {
            Some(Verdict::Survives) => Ok(true),
            Some(Verdict::Fails { .. }) => Ok(false),
            Some(Verdict::Undecided { cause }) => Err(undecided(cause.to_string())),
            None => Err(undecided("the model has no head".to_owned())),
        }
    };
    for (end, wanted, verdict) in [(low, true, "fails"), (high, false, "survives")] {
        if survives(end)? != wanted {
            return Err(CriticalShockError::NotBracketed {
                amplitude_m_per_s2: end,
                verdict,
            });
        }
    }
    while high / low > 1.0 + tolerance {
        // The mean of the logarithms, with the sign of both.
        let middle = low * (high / low).sqrt();
        if middle == low || middle == high {
            break;
        }
        match survives(middle)? {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(CriticalShock {
        survives_m_per_s2: low,
        fails_m_per_s2: high,
        n_runs,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::m_per_s2_from_g;
    use crate::ramp::NoRamp;
    use crate::scene::Scene;
    use crate::simulation::{Outcome, Scope};

    fn coarse() -> Scene {
        let mut scene = Scene::default_drive();
        scene.ramp.model = NoRamp.into();
        scene.disk_resolution.cut_hz = 20e3;
        scene.film_resolution.cells = 250;
        scene.film_resolution.correction_cells = 0;
        scene
    }

    #[test]
    fn the_verdict_changes_between_the_ends() {
        let model = Model::new(&coarse()).expect("a model");
        let mut workspace = Workspace::default();
        let range = [-20.0, -2000.0].map(m_per_s2_from_g);
        let found = critical_shock(&model, range, 0.02, &mut workspace).expect("bracketed");
        let mut run = |amplitude_m_per_s2| -> Outcome {
            let request = Request {
                amplitude_m_per_s2,
                record: false,
            };
            simulate(&model, &request, &mut workspace)
        };
        let survivor = run(found.survives_m_per_s2);
        assert_eq!(survivor.verdict, Some(Verdict::Survives));
        let failure = run(found.fails_m_per_s2).verdict;
        assert!(
            matches!(failure, Some(Verdict::Fails { .. })),
            "{failure:?}"
        );
        let ratio = found.fails_m_per_s2 / found.survives_m_per_s2;
        assert!(ratio > 1.0 && ratio <= 1.02, "{ratio}");
        // Both ends, and as many halvings as bring ln 100 below ln 1.02.
        assert_eq!(found.n_runs, 2 + 8);
    }

    #[test]
    fn what_cannot_be_bisected_is_an_error() {
        let model = Model::build(&coarse(), Scope::Structure, None).expect("a model");
        let of = |range, tolerance| {
            let found = critical_shock(&model, range, tolerance, &mut Workspace::default());
            found.expect_err("no critical shock")
        };
        for (range, tolerance) in [
            ([0.0, 1e3], 0.1),
            ([-1.0, 1e3], 0.1),
            ([1e3, 1.0], 0.1),
            ([1.0, 1e3], 0.0),
        ] {
            let error = of(range, tolerance);
            assert!(matches!(error, CriticalShockError::Range { .. }), "{error}");
        }
        let error = of([1.0, 1e3], 0.1);
        assert!(
            matches!(error, CriticalShockError::Undecided { .. }),
            "{error}"
        );
    }
}
