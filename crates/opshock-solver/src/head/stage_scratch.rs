//! Scratch of the stage solves: film, factors and the measured contraction of the iteration.

use super::first_order_cells::FirstOrderCells;
use super::model::HeadModel;
use super::stage_matrix::StageMatrix;
use super::stops::Closed;
use crate::air_bearing::{FilmLinearisation, FilmScratch};
use crate::lanes::products;
use crate::linalg::banded::BandedLu;

/// Contraction assumed for new factors until a second iterate measures it.
pub(super) const FIRST_CONTRACTION: f64 = 0.1;

/// Why a stage was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StageFailure {
    /// The iteration did not converge; the last estimate of its error relative to the gap, in short stages of a velocity's.
    NotConverged(f64),
    /// A number was not finite.
    NotFinite(&'static str),
}

/// Scratch of the stage solves, sized once.
#[derive(Clone, Debug)]
pub(super) struct StageScratch {
    pub film: FilmScratch,
    pub linearisation: FilmLinearisation,
    /// Single precision: the stage's iteration corrects the rounding.
    pub lu: BandedLu<f32>,
    /// d for which the factors were made; `None`: there are none.
    pub factored_d_s: Option<f64>,
    /// Stages solved since then with another d.
    pub n_borrowed: u32,
    /// Z, column by column.
    pub z: [Vec<f64>; 3],
    /// F_ψ Z − F_q.
    pub film_matrix: [[f64; 3]; 3],
    pub residual: Vec<f64>,
    pub mechanical: Vec<f64>,
    pub velocity: Vec<f64>,
    /// x − x_known of the present iterate of a short stage, accumulated.
    pub increment: Vec<f64>,
    /// Coordinates, velocities and known velocities over a pivot that moves.
    pub seen: [Vec<f64>; 3],
    pub first_order: FirstOrderCells,
    /// S + film's condensed stiffness, and what it was made for.
    pub matrix: StageMatrix,
    pub matrix_key: Option<MatrixKey>,
    /// Contraction of the last iteration with the present factors.
    pub contraction: f64,
    /// Contacts that were closed at the last mechanical iterate.
    pub last_closed: Closed,
    pub counters: Counters,
}

/// What the matrix of slider and suspension depends on besides the film's condensed stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MatrixKey {
    pub d_s: f64,
    pub closed: Closed,
    pub with_film: bool,
}

/// Cost of the stage solves, and their worst figures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counters {
    pub residuals: u64,
    pub solves: u64,
    pub factorisations: u64,
    pub linearisations: u64,
    pub max_residual: f64,
    pub mass_balance_error: f64,
}

impl StageScratch {
    pub fn new(model: &HeadModel) -> Self {
        let (n_cells, n) = (model.film.n_cells(), model.mechanics.len());
        let linearisation = model.film.linearisation();
        let band = linearisation.by_psi.band();
        Self {
            film: model.film.scratch(),
            lu: BandedLu::new(n_cells, band),
            linearisation,
            factored_d_s: None,
            n_borrowed: 0,
            z: [0, 1, 2].map(|_| vec![0.0; n_cells]),
            film_matrix: [[0.0; 3]; 3],
            residual: vec![0.0; n_cells],
            mechanical: vec![0.0; n],
            velocity: vec![0.0; n],
            increment: Vec::with_capacity(n),
            seen: [0, 1, 2].map(|_| vec![0.0; n]),
            first_order: FirstOrderCells::default(),
            matrix: StageMatrix::new(model.mechanics.n_modes()),
            matrix_key: None,
            contraction: FIRST_CONTRACTION,
            last_closed: Closed::DIMPLE,
            counters: Counters::default(),
        }
    }

    /// Discards factors, counters and cells of first order, keeping the memory.
    pub fn reset(&mut self) {
        self.forget();
        self.first_order = FirstOrderCells::default();
        self.counters = Counters::default();
    }

    /// Discards factors and the contraction measured with them.
    pub fn forget(&mut self) {
        self.factored_d_s = None;
        self.matrix.forget();
        self.matrix_key = None;
        self.contraction = FIRST_CONTRACTION;
    }

    /// The factors no longer fit the state.
    pub fn discard_factors(&mut self) {
        self.factored_d_s = None;
    }

    /// A⁻¹ applied to `residual` in place, and F_ψ of the result.
    pub fn solve_film(&mut self) -> [f64; 3] {
        self.lu.solve(&mut self.residual);
        self.counters.solves += 1;
        products(columns_of(&self.linearisation.force_by_psi), &self.residual)
    }
}

pub(super) fn columns_of(columns: &[Vec<f64>; 3]) -> [&[f64]; 3] {
    [&columns[0], &columns[1], &columns[2]]
}
