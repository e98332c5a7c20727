//! Initial state of a run on a disk with run-out and waviness: the slider follows the moving surface.
//!
//! The state is steady flight plus the linear response to every wave. Terms of second order in the waves decay within
//! the film's own time constants.

use super::model::{Following, HeadError, HeadModel};
use super::response::{Drive, HeadResponse};
use crate::disk::run_out::SurfaceMotion;
use nalgebra::Complex;

/// Share of a cell's gas that all waves together may displace.
const LARGEST_SHARE: f64 = 0.5;

impl HeadModel {
    /// The same head over a disk whose surface moves by itself.
    ///
    /// # Errors
    ///
    /// [`HeadError::RunOut`] when the slider cannot follow: the waves would bring it to the failure limit or displace
    /// half of some cell's gas, or the linear response does not exist.
    pub fn with_run_out(mut self, surface: SurfaceMotion) -> Result<Self, HeadError> {
        let n_cells = self.film.n_cells();
        let n = self.mechanics.len();
        let mut start = vec![0.0; n_cells + 2 * n];
        start[..n_cells].copy_from_slice(&self.flight.psi);
        // Amplitudes of every cell's gas and of the clearance at the slider's ends, all waves in phase.
        let (mut gas, mut gap_m) = (vec![0.0; n_cells], 0.0);
        let mut response = HeadResponse::new(&self);
        for swing in surface.swings() {
            let drive = Drive {
                disk: swing.pose,
                ..Drive::default()
            };
            let omega = swing.omega_rad_per_s;
            let answer = response.at(omega, &drive).map_err(|_| HeadError::RunOut {
                lost: f64::INFINITY,
            })?;
            let psi = response.film_of(&answer, &drive);
            for ((start, psi), gas) in start.iter_mut().zip(&psi).zip(&mut gas) {
                *start += psi.re;
                *gas += psi.norm();
            }
            for (i, x) in answer.coordinates.iter().enumerate() {
                start[n_cells + i] += x.re;
                start[n_cells + n + i] += (x * Complex::new(0.0, omega)).re;
            }
            let relative: [f64; 3] =
                std::array::from_fn(|q| (answer.slider[q] - swing.pose[q]).norm());
            gap_m += self.gap_change(&relative);
        }
        let moved = gas.iter().zip(&self.flight.psi).map(|(gas, psi)| gas / psi);
        let room_m = self.steady_clearance_m - self.fail_below_m;
        let lost = moved.fold(gap_m / room_m * LARGEST_SHARE, f64::max) / LARGEST_SHARE;
        let follows = lost < 1.0;
        if !follows {
            return Err(HeadError::RunOut { lost });
        }
        self.following = Some(Following { surface, start });
        Ok(self)
    }
}
