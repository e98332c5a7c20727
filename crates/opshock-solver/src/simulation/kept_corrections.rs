//! Where defect corrections of films are kept beyond a process, by what the process that simulates has chosen.

use std::sync::OnceLock;

use crate::air_bearing::CorrectionForces;
use crate::scene::Scene;

/// Keeps what films of a scene's slider were sampled to ([`CorrectionForces`]), for scenes of which
/// [`Bearing::has_reference`](super::Bearing::has_reference) holds.
pub trait KeptCorrections: Send + Sync {
    /// Whether it is kept.
    fn has(&self, scene: &Scene) -> bool;
    /// What is kept; the same bits as were sampled.
    fn find(&self, scene: &Scene) -> Option<CorrectionForces>;
    /// Keeps it.
    fn keep(&self, scene: &Scene, correction: &CorrectionForces);
}

static KEPT: OnceLock<Box<dyn KeptCorrections>> = OnceLock::new();

/// Chooses where this process keeps defect corrections, once; without a choice, nowhere.
pub fn keep_corrections(kept: Box<dyn KeptCorrections>) {
    // A second choice leaves the first.
    let _ = KEPT.set(kept);
}

/// Whether the defect correction of a scene is kept.
pub fn is_correction_kept(scene: &Scene) -> bool {
    KEPT.get().is_some_and(|kept| kept.has(scene))
}

/// The defect correction of a scene: the kept one, or that of `sample`, which is then kept.
pub(super) fn kept_or<E>(
    scene: &Scene,
    sample: impl FnOnce(&Scene) -> Result<CorrectionForces, E>,
) -> Result<CorrectionForces, E> {
    let Some(kept) = KEPT.get() else {
        return sample(scene);
    };
    if let Some(found) = kept.find(scene) {
        return Ok(found);
    }
    let sampled = sample(scene)?;
    kept.keep(scene, &sampled);
    Ok(sampled)
}
