//! The critical shock of one model, by bisection.

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

/// Bisects between the signed amplitudes `range_m_per_s2`, the weaker one first, both of one sign, until they differ by no
/// more than a share `tolerance` of the weaker.
///
/// It finds *one* change of the verdict. Verdicts need not be monotone in the amplitude: the sweep of a study also scans
/// below the failure it finds.
///
/// # Errors
/// [`CriticalShockError`], also for a model without a head, which has no verdict.
pub fn critical_shock(
    model: &Model,
    range_m_per_s2: [f64; 2],
    tolerance: f64,
    workspace: &mut Workspace,
) -> Result<CriticalShock, CriticalShockError> {
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
        match simulate(model, &request, workspace).answer() {
            Some(Verdict::Survives) => Ok(true),
            Some(Verdict::Fails { .. }) => Ok(false),
            Some(Verdict::Undecided { cause }) => Err(undecided(cause.to_string())),
            None => Err(undecided("the model has no head".to_owned())),
        }
    };
    let [mut low, mut high] = range_m_per_s2;
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
