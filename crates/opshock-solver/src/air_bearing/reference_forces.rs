//! What a film's grid leaves out of force and moments, as a function of the attitude.
//!
//! Under a slider held still at the attitude q (height, pitch, roll) a film of N cells carries the force and the two
//! moments F_N(q), and one without grid error F(q). The
//! difference, the *defect* of the grid, is smooth in q though not in N. It is sampled once, on films held still,
//! and added to what the film carries in every state:
//!
//! ```text
//! F_N(ψ, q) + P(q),      P = F − F_N on the samples
//! F ≈ F_ref' + (F_ref' − F_ref)/3         ψ: the film's state, p h
//! ```
//!
//! F_ref and F_ref' are forces on a reference grid and on the same with every cell cut in two along both
//! directions: on the finer one the error of second order is a quarter (Roache 1994, J. Fluids Eng. 116, 405).
//!
//! P interpolates the samples (`defect`). A film in motion gets the same correction: the grid's error in the film's
//! rates is not corrected.
//!
//! Such a correction of a coarse discretisation by a finer one is Brandt's (1977, Math. Comp. 31, 333: the
//! fine-to-coarse defect τ of multi-level schemes), here of three numbers instead of a field.

use super::attitude::Attitude;
use super::defect::Defect;
use super::defect::interpolation::Interpolation;
use super::defect::range::Range;
use super::film::Film;
use super::gap_load::GapLoad;
use super::layout::carried;
use super::newton::Newton;
use super::search::Flight;
use super::steady_error::SteadyError;

/// Attitudes at which films are held.
const SAMPLES: usize = 200;

/// Forces of a film without grid error under sliders held still: what every grid of the same film lacks is told
/// from it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceForces {
    range: Range,
    /// In an order in which neighbours are alike.
    attitudes: Vec<Attitude>,
    /// [F_z, M_pitch, M_roll] of the air, N and N m.
    forces: Vec<[f64; 3]>,
    /// The same on the reference grid, and that grid's lines, m.
    on_grid: Vec<[f64; 3]>,
    lines_m: [Vec<f64>; 2],
}

impl ReferenceForces {
    /// Samples of `film`, on which the steady `flight` is, and of `finer`, which has every cell of it cut in two
    /// along both directions.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] when a film does not settle under a slider held still.
    pub fn sample(film: &Film, finer: &Film, flight: &Flight) -> Result<Self, SteadyError> {
        let range = Range::around(film, flight);
        let shares = in_a_row((1..=SAMPLES).map(spread).collect());
        let attitudes: Vec<Attitude> = shares.iter().map(|at| range.attitude(*at)).collect();
        let (mut coarse, mut fine) = (Held::new(film), Held::new(finer));
        let forces = attitudes.iter().map(|attitude| {
            let rough = coarse.force(attitude, |_| film.ambient(attitude))?;
            let psi = &coarse.psi;
            let close = fine.force(attitude, |finer| carried(film, psi, finer, attitude))?;
            let whole = std::array::from_fn(|f| close[f] + (close[f] - rough[f]) / 3.0);
            Ok((whole, rough))
        });
        let forces = forces.collect::<Result<Vec<_>, SteadyError>>()?;
        let (forces, on_grid) = forces.into_iter().unzip();
        Ok(Self {
            range,
            attitudes,
            forces,
            on_grid,
            lines_m: film.lines_m().map(<[f64]>::to_vec),
        })
    }

    /// What the grid of `film`, a film of the same slider, leaves out.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] when it does not settle under a slider held still.
    pub(super) fn defect_of(&self, film: &Film) -> Result<Defect, SteadyError> {
        let own = if film.lines_m() == self.lines_m.each_ref().map(Vec::as_slice) {
            self.on_grid.clone()
        } else {
            let mut held = Held::new(film);
            let attitudes = self.attitudes.iter();
            let own = attitudes.map(|attitude| held.force(attitude, |film| film.ambient(attitude)));
            own.collect::<Result<_, SteadyError>>()?
        };
        let missing: Vec<[f64; 3]> = self
            .forces
            .iter()
            .zip(&own)
            .map(|(whole, own)| std::array::from_fn(|f| whole[f] - own[f]))
            .collect();
        let variables = |attitude| self.range.variables(attitude).map(|x| x.0);
        let places = self.attitudes.iter().map(variables).collect();
        Ok(Defect {
            range: self.range.clone(),
            missing: Interpolation::through(places, &missing),
        })
    }
}

impl Film {
    /// The same film with what its grid leaves out of force and moments put back: [`Film::force`] and the
    /// linearisation hold it from then on, pressures and fluxes do not.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] when the film does not settle under a slider held still.
    pub fn corrected_by(mut self, reference: &ReferenceForces) -> Result<Self, SteadyError> {
        self.defect = None;
        self.defect = Some(reference.defect_of(&self)?);
        Ok(self)
    }

    /// What [`Film::corrected_by`] adds to force and moments at an attitude; `None` of a film as its grid has it.
    pub fn correction(&self, attitude: &Attitude) -> Option<GapLoad> {
        Some(self.defect.as_ref()?.load(attitude))
    }
}

/// Films of one grid under sliders held still, one attitude after the other. Residuals say where they settle, so that
/// factors may be single.
struct Held<'a> {
    newton: Newton<'a, f32>,
    /// The last attitude and its film.
    last: Option<Attitude>,
    psi: Vec<f64>,
}

impl<'a> Held<'a> {
    fn new(film: &'a Film) -> Self {
        Self {
            newton: Newton::new(film),
            last: None,
            psi: Vec::new(),
        }
    }

    /// Force of the air at `attitude`: from the film at the one before, at the same pressures, or from `guess`.
    fn force(
        &mut self,
        attitude: &Attitude,
        guess: impl Fn(&Film) -> Vec<f64>,
    ) -> Result<[f64; 3], SteadyError> {
        let film = self.newton.film;
        if let Some(last) = self.last.replace(*attitude) {
            let (before, now) = (film.ambient(&last), film.ambient(attitude));
            for (psi, (before, now)) in self.psi.iter_mut().zip(before.iter().zip(&now)) {
                *psi *= now / before;
            }
            if let Ok(force) = self.newton.force_held(&mut self.psi, attitude) {
                return Ok(force);
            }
        }
        self.psi = guess(film);
        self.newton.forget();
        let held = self.newton.force_held(&mut self.psi, attitude);
        held.or_else(|_| {
            let mut newton = Newton::<f64>::new(film);
            self.psi = film.ambient(attitude);
            newton.relax(&mut self.psi, attitude);
            newton.force_held(&mut self.psi, attitude)
        })
    }
}

/// Place k = 1, 2, ... of a sequence that fills the cube from -1 to 1, denser towards its ends, where interpolation
/// is worst: additive recurrence on the powers of the root of x⁴ = x + 1 (Roberts 2018), by the cosine.
fn spread(k: usize) -> [f64; 3] {
    const ROOT: f64 = 1.220_744_084_605_759_6;
    std::array::from_fn(|d| {
        let share = (0.5 + k as f64 / ROOT.powi(d as i32 + 1)).fract();
        -(std::f64::consts::PI * share).cos()
    })
}

/// The places, each followed by the nearest of those left.
fn in_a_row(mut left: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let apart = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let mut row = Vec::with_capacity(left.len());
    let mut last = [0.0; 3];
    while let Some(next) =
        (0..left.len()).min_by(|&a, &b| apart(&left[a], &last).total_cmp(&apart(&left[b], &last)))
    {
        last = left.swap_remove(next);
        row.push(last);
    }
    row
}
