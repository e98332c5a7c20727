//! Interface of ramp models, and the form in which disk, contact and prints use any of them.

use super::error::{RampError, first_fault};
use super::mode::{ArmMode, ContactMode, Relaxation};

/// Name of the model whose contact points no mode moves.
pub(super) const RIGID: &str = "rigid";

/// A model of the ramp: none, or two contact points that move as a sum of modes.
///
/// Implement it for a ramp of one's own and put it into a scene with `scene.ramp.model = own.into()`.
pub trait RampModel {
    /// Name in prints and in the identity of a result.
    fn name(&self) -> &'static str;

    /// Modes that move the contact points; none of a rigid ramp, `None` without a ramp.
    fn contacts(&self) -> Option<Vec<ContactMode>>;

    /// How the stiffness of all these modes relaxes; empty: they are elastic, with damping ratios.
    fn relaxation(&self) -> Vec<Relaxation> {
        Vec::new()
    }
}

/// A ramp as disk, contact and prints use it, whatever its model.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RampBody {
    /// Name of the model.
    pub model: &'static str,
    /// Modes that move the contact points; `None` without a ramp.
    pub contacts: Option<Vec<ContactMode>>,
    /// How the stiffness of every mode relaxes. Its frequency is that of the instantaneous stiffness.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub relaxation: Vec<Relaxation>,
}

impl<M: RampModel> From<M> for RampBody {
    fn from(model: M) -> Self {
        Self {
            model: model.name(),
            contacts: model.contacts(),
            relaxation: model.relaxation(),
        }
    }
}

impl RampBody {
    /// Whether there is no ramp.
    pub fn is_absent(&self) -> bool {
        self.contacts.is_none()
    }

    /// Modes; none of a rigid ramp and without a ramp.
    pub fn modes(&self) -> &[ContactMode] {
        self.contacts.as_deref().unwrap_or_default()
    }

    /// Whether there are modes whose stiffness relaxes.
    pub fn relaxes(&self) -> bool {
        !self.modes().is_empty() && !self.relaxation.is_empty()
    }

    /// Modes of the top and of the bottom arm where no mode moves both; `None` for one body.
    pub fn arms(&self) -> Option<[Vec<ArmMode>; 2]> {
        let moves_both = |mode: &ContactMode| mode.shape.iter().all(|shape| *shape != 0.0);
        let own = |arm| self.modes().iter().filter_map(move |m| m.at_contact(arm));
        (!self.modes().iter().any(moves_both)).then(|| [0, 1].map(|arm| own(arm).collect()))
    }

    /// Whether the ramp is its own mirror image.
    pub fn is_symmetric(&self) -> bool {
        match self.arms() {
            Some([top, bottom]) => top == bottom,
            None => self.modes().iter().all(|m| m.shape[0] == m.shape[1]),
        }
    }

    /// The ramp upside down: load and displacements change sign together, and so the modes' coordinates, and
    /// the arms change places.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut turned = self.clone();
        for mode in turned.contacts.iter_mut().flatten() {
            mode.shape.reverse();
        }
        if let (Some(_), Some(modes)) = (self.arms(), &mut turned.contacts) {
            // Modes of the top arm come first.
            modes.sort_by_key(|mode| mode.shape[0] == 0.0);
        }
        turned
    }

    pub(super) fn validate(&self) -> Result<(), RampError> {
        let modes = self.modes();
        modes.iter().try_for_each(ContactMode::validate)?;
        self.relaxation.iter().try_for_each(Relaxation::validate)?;
        let relaxes: f64 = self.relaxation.iter().map(|term| term.share).sum();
        first_fault(&[("sum of relaxing shares", relaxes, relaxes < 1.0, "below 1")])?;
        let is_rigid = self.is_absent() || self.model == RIGID;
        for (at, side) in ["top", "bottom"].into_iter().enumerate() {
            if !is_rigid && modes.iter().all(|mode| mode.shape[at] == 0.0) {
                return Err(RampError::CannotMove { side });
            }
        }
        Ok(())
    }
}
