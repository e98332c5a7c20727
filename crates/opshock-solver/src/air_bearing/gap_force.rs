//! Interface of forces between slider and disk other than the air's pressure.
//!
//! Each force has two forms: a [`GapForce`], its parameters in a scene, and an [`Element`](super::film::Element), its
//! evaluation on the cells of a film. [`GapForces`](super::gap_forces::GapForces) lists them. Plan, mirror, film,
//! results and output loop over the list and name no single effect.

use super::attitude::Attitude;
use super::film::{Element, Film};
use super::gap_load::GapLoad;
use super::state::FilmScratch;
use crate::rough_contact::nominal::ContactState;
use crate::slider::SliderParameters;
use std::fmt::Debug;
use std::sync::Arc;

/// A force between slider and disk other than the air's pressure, as data of a scene.
pub trait GapForce: Debug + Send + Sync {
    /// Name in plans and results: `head.` and the [`GapForce::key`].
    fn name(&self) -> &'static str;

    /// Name of its contribution in what `opshock steady` prints.
    fn key(&self) -> &'static str {
        let name = self.name();
        name.strip_prefix("head.").unwrap_or(name)
    }

    /// Whether the scene has it.
    fn is_active(&self) -> bool;

    /// The same in the drive upside down; what is given in the slider's own frame stays.
    #[must_use]
    fn mirrored(&self) -> Self
    where
        Self: Clone + Sized,
    {
        self.clone()
    }

    /// Roughness of the surfaces whose mean gap the film sees, m, 0 for smooth ones; `None` for a force that has no say in it.
    fn roughness_m(&self) -> Option<f64> {
        None
    }

    /// The force over the cells of `film`, a film under `slider`.
    fn over(&self, film: &Film, slider: &SliderParameters) -> Arc<dyn Element>;
}

impl Film {
    /// The same film with `force` on its `slider`: [`Film::force`] and the linearisation include it from then on,
    /// pressures and fluxes do not. It replaces a force of the same name.
    #[must_use]
    pub fn with_gap_force(mut self, slider: &SliderParameters, force: &dyn GapForce) -> Self {
        self.gap_forces.retain(|(key, _)| *key != force.key());
        if force.is_active() {
            let element = force.over(&self, slider);
            self.gap_forces.push((force.key(), element));
        }
        if let Some(roughness_m) = force.roughness_m() {
            self.height_limit = self.height_limit.of_rough(roughness_m);
        }
        self
    }

    /// Whether a force other than the air's may pull the slider onto the disk and so end its flight.
    pub(super) fn is_drawn_in(&self) -> bool {
        let mut all = self.gap_forces.iter();
        all.any(|(_, force)| force.share_of_attraction(1.0).is_some())
    }

    /// The same film with `share` of the forces that may pull the slider onto the disk.
    pub(super) fn with_share_of_attraction(&self, share: f64) -> Self {
        let mut film = self.clone();
        for (_, force) in &mut film.gap_forces {
            if let Some(part) = force.share_of_attraction(share) {
                *force = part;
            }
        }
        film
    }

    /// Loads of the forces other than the air's at a state, each with its [`GapForce::key`].
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries or `scratch` belongs to another film.
    pub fn gap_loads(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        scratch: &mut FilmScratch,
    ) -> Vec<(&'static str, GapLoad)> {
        match self.height_limit.is_rough() {
            true => scratch.fill::<true>(self, psi, attitude),
            false => scratch.fill::<false>(self, psi, attitude),
        }
        let cells = scratch.cell_states(attitude);
        let mut by_psi = [(); 3].map(|()| vec![0.0; self.n_cells()]);
        let loads = self.gap_forces.iter();
        loads
            .map(|(key, force)| (*key, force.load(self, &cells, &mut by_psi)))
            .collect()
    }

    /// Places whose smallest height so far a force depends on.
    pub(super) fn n_remembered(&self) -> usize {
        let all = self.gap_forces.iter();
        all.map(|(_, force)| force.n_remembered()).sum()
    }

    /// Takes the heights at `attitude` into the smallest ones so far.
    pub(crate) fn remember(&self, attitude: &Attitude, closest_m: &mut [f64]) {
        for (_, force) in &self.gap_forces {
            if force.n_remembered() > 0 {
                force.remember(attitude, closest_m);
            }
        }
    }

    /// What the asperities bear at `attitude`, where the scene has their contact.
    pub(crate) fn contact(&self, attitude: &Attitude, closest_m: &[f64]) -> Option<ContactState> {
        let mut all = self.gap_forces.iter();
        all.find_map(|(_, force)| force.contact(attitude, closest_m))
    }

    /// What the asperities give back as slider and disk part from `attitude`, J.
    pub(crate) fn asperities_elastic_j(&self, attitude: &Attitude, closest_m: &[f64]) -> f64 {
        let all = self.gap_forces.iter();
        all.map(|(_, force)| force.elastic_j(attitude, closest_m))
            .sum()
    }

    /// Work of the asperities that yielded, J.
    pub(crate) fn yielded_j(&self, closest_m: &[f64]) -> f64 {
        let all = self.gap_forces.iter();
        all.map(|(_, force)| force.yielded_j(closest_m)).sum()
    }

    /// Force and moments of all of them at the state in `scratch`.
    pub(super) fn gap_force(&self, attitude: &Attitude, scratch: &FilmScratch) -> [f64; 3] {
        let cells = scratch.cell_states(attitude);
        let mut sum = [0.0; 3];
        for (_, force) in &self.gap_forces {
            let part = force.force(self, &cells);
            (0..3).for_each(|f| sum[f] += part[f]);
        }
        sum
    }
}
