//! Corrects force and moments of a film for the error of its grid, by films on a finer grid.
//!
//! Let q be the slider's attitude (height, pitch, roll). Held at q, over the turning disk, a film of N cells carries
//! force and moments F_N(q), and one without discretisation error F(q). Their difference P(q), the discretisation
//! defect, is a smooth function of q. When a model is built, P is sampled at 200 attitudes, at 5 to 150 % of the height
//! of steady flight where the slider is closest to the disk ([`Range`]), on a defect-correction grid of 1000 to 4000
//! cells and on the same with every cell divided into four. Their forces F₁ and F₂ are extrapolated at second order
//! (Roache 1994, J. Fluids Eng. 116, 405):
//!
//! ```text
//! F ≈ F₂ + (F₂ − F₁)/3,      P = F − F_N at the samples, interpolated between them (`defect`)
//! ```
//!
//! Every state of the film in a shock is corrected alike: its force is F_N(ψ, q) + P(q), with ψ = p h the film's unknowns.
//! The error of the film's answer to a change in time, as its squeeze damping, is not corrected.
//!
//! Brandt (1977, Math. Comp. 31, 333) corrects a coarse grid by a fine one in the same way, there for a field.

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

/// Number of sampled attitudes.
const SAMPLES: usize = 200;

/// Forces of quasi-static films without discretisation error at the sampled attitudes. They give the discretisation
/// defect of every grid of the same film.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CorrectionForces {
    range: Range,
    /// In an order in which neighbours are alike.
    attitudes: Vec<Attitude>,
    /// [F_z, M_pitch, M_roll] of the air, N and N m.
    forces: Vec<[f64; 3]>,
    /// The same on the defect-correction grid, and that grid's lines, m.
    on_grid: Vec<[f64; 3]>,
    lines_m: [Vec<f64>; 2],
}

impl CorrectionForces {
    /// Samples `film`, which has the steady `flight`, and `finer`, which has every cell cut in two along both
    /// directions.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] when a quasi-static film does not converge.
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

    /// Discretisation defect of the grid of `film`, a film of the same slider.
    ///
    /// # Errors
    ///
    /// As [`CorrectionForces::sample`].
    pub(super) fn defect_of(&self, film: &Film) -> Result<Defect, SteadyError> {
        let is_sampled = film.lines_m() == self.lines_m.each_ref().map(Vec::as_slice);
        let mut held = Held::new(film);
        let samples = self.attitudes.iter().zip(&self.forces).zip(&self.on_grid);
        let defects = samples.map(|((attitude, whole), on_grid)| {
            let own = match is_sampled {
                true => *on_grid,
                false => held.force(attitude, |film| film.ambient(attitude))?,
            };
            let place = self.range.variables(attitude).map(|x| x.0);
            let missing: [f64; 3] = std::array::from_fn(|f| whole[f] - own[f]);
            Ok((place, missing))
        });
        let defects: Result<Vec<_>, SteadyError> = defects.collect();
        let (places, missing): (_, Vec<_>) = defects?.into_iter().unzip();
        Ok(Defect {
            range: self.range.clone(),
            missing: Interpolation::through(places, &missing),
        })
    }
}

impl Film {
    /// The same film with defect correction: [`Film::force`] and the linearisation include the correction from then on,
    /// pressures and fluxes do not.
    ///
    /// # Errors
    ///
    /// As [`CorrectionForces::sample`].
    pub fn corrected_by(mut self, reference: &CorrectionForces) -> Result<Self, SteadyError> {
        self.defect = None;
        self.defect = Some(reference.defect_of(&self)?);
        Ok(self)
    }

    /// What [`Film::corrected_by`] adds to force and moments at an attitude; `None` without defect correction.
    pub fn correction(&self, attitude: &Attitude) -> Option<GapLoad> {
        Some(self.defect.as_ref()?.load(attitude))
    }
}

/// Quasi-static films of one grid, one attitude after the other. Residuals decide convergence, so factors may be of
/// single precision.
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

    /// Force of the air at `attitude`; the iteration starts from the preceding film at the same pressures, or from
    /// `guess`.
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
        self.newton.force_held(&mut self.psi, attitude)
    }
}

/// Point k = 1, 2, ... of a sequence that fills the cube from -1 to 1, denser towards its faces, where interpolation is
/// worst: additive recurrence on the powers of the root of x⁴ = x + 1 (Roberts 2018), mapped by the cosine.
fn spread(k: usize) -> [f64; 3] {
    const ROOT: f64 = 1.220_744_084_605_759_6;
    std::array::from_fn(|d| {
        let share = (0.5 + k as f64 / ROOT.powi(d as i32 + 1)).fract();
        -(std::f64::consts::PI * share).cos()
    })
}

/// The points, each followed by the nearest of those left.
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
