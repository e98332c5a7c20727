//! Surface forces over a film's cells: force and moments at an attitude, with derivatives.

use super::attitude::Attitude;
use super::balance::Moments;
use super::derivatives::height_by_attitude;
use super::faces::{BLOCK, block};
use super::film::Film;
use super::linearise::Totals;
use super::surface_forces::{Interaction, SurfaceForces, SurfaceLoad};
use crate::lanes::{Kernel, total, widest};
use crate::slider::SliderParameters;
use crate::slider::surface::Surface;

impl Film {
    /// The same film with surface forces beside it on its `slider`: [`Film::force`] and the
    /// linearisation hold them from then on, pressures and fluxes do not.
    #[must_use]
    pub fn with_surface_forces(mut self, slider: &SliderParameters, forces: SurfaceForces) -> Self {
        let surface = Surface::new(slider);
        self.interaction =
            (!forces.is_none()).then(|| Interaction::new(forces, &surface, &self.mesh));
        self
    }

    /// The same film with `share` of its surface forces.
    pub(super) fn with_surface_share(&self, share: f64) -> Self {
        let mut film = self.clone();
        if let Some(interaction) = &mut film.interaction {
            interaction.forces = interaction.forces.times(share);
        }
        film
    }

    /// The surface forces that act beside the film; `None` without any.
    pub fn surface_forces(&self) -> Option<&SurfaceForces> {
        self.interaction.as_ref().map(Interaction::forces)
    }

    /// What the surface forces do at `attitude`; `None` without any.
    pub fn surface_load(&self, attitude: &Attitude) -> Option<SurfaceLoad> {
        let interaction = self.interaction.as_ref()?;
        Some(widest(Linearised(Posed {
            film: self,
            interaction,
            attitude,
        })))
    }

    /// Their force and moments alone; zero without any.
    pub(super) fn surface_force(&self, attitude: &Attitude) -> [f64; 3] {
        match &self.interaction {
            Some(interaction) => widest(Loads(Posed {
                film: self,
                interaction,
                attitude,
            })),
            None => [0.0; 3],
        }
    }
}

/// The points of a film at an attitude.
struct Posed<'a> {
    film: &'a Film,
    interaction: &'a Interaction,
    attitude: &'a Attitude,
}

impl Posed<'_> {
    /// First points of the blocks.
    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.interaction.area.len()).step_by(BLOCK)
    }

    /// Height that the film sees, its slope by the true height, and area of a block of points.
    #[inline(always)]
    fn block(&self, first: usize) -> ([f64; BLOCK], [f64; BLOCK], &[f64; BLOCK]) {
        let height = self.interaction.places.heights(first, self.attitude);
        let [h, floor_slope] = self.film.floored_block(&height, &[0.0; BLOCK]);
        (h, floor_slope, block(&self.interaction.area, first))
    }
}

/// Force and moments as a kernel.
struct Loads<'a>(Posed<'a>);

impl Kernel for Loads<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn call(self) -> [f64; 3] {
        let forces = &self.0.interaction.forces;
        let mut moments = Moments::default();
        for first in self.0.blocks() {
            let (h, _, area) = self.0.block(first);
            let mut load = [0.0; BLOCK];
            for k in 0..BLOCK {
                load[k] = area[k] * forces.pressure(h[k]).0;
            }
            moments.add(&load, &self.0.interaction.places, first);
        }
        moments.total()
    }
}

/// Force, moments and derivatives as a kernel.
struct Linearised<'a>(Posed<'a>);

impl Kernel for Linearised<'_> {
    type Output = SurfaceLoad;

    #[inline(always)]
    fn call(self) -> SurfaceLoad {
        let Interaction { forces, places, .. } = self.0.interaction;
        let mut totals = Totals::default();
        for first in self.0.blocks() {
            let (h, floor_slope, area) = self.0.block(first);
            let arms = height_by_attitude([block(&places.x, first), block(&places.y, first)]);
            let (mut load, mut per_height) = ([0.0; BLOCK], [0.0; BLOCK]);
            for k in 0..BLOCK {
                let (pressure, slope) = forces.pressure(h[k]);
                load[k] = area[k] * pressure;
                per_height[k] = area[k] * slope * floor_slope[k];
            }
            totals.moments.add(&load, places, first);
            totals.add_by_height(&per_height, &arms);
        }
        SurfaceLoad {
            force: totals.moments.total(),
            by_attitude: totals.force_by_attitude.map(|row| row.map(total)),
        }
    }
}
