//! State of a film's cells as columns, padded so that every block of faces finds blocks of cells.

use super::attitude::Attitude;
use super::faces::{BLOCK, Block, Interior, Sides, block};
use super::film::{CellStates, Film};
use super::flow_factor::PickedRows;
use super::flux::HalfCell;

/// Scratch of the flux balance, one per thread.
#[derive(Clone, Debug)]
pub struct FilmScratch {
    /// Where cell 0 stands in the columns, and the number of cells.
    front: usize,
    n_cells: usize,
    /// ψ, its inverse, height, its inverse, its derivative by the true height, G, its inverse and dG/dψ
    /// of every cell.
    pub(super) psi: Vec<f64>,
    pub(super) inverse_psi: Vec<f64>,
    pub(super) h: Vec<f64>,
    pub(super) inverse_h: Vec<f64>,
    pub(super) h_slope: Vec<f64>,
    pub(super) g: Vec<f64>,
    pub(super) inverse_g: Vec<f64>,
    pub(super) g_slope: Vec<f64>,
    /// Flux through the faces of either direction towards rising cell numbers.
    pub(super) flux: [Vec<f64>; 2],
    /// Rows of the flow factor's table.
    rows: PickedRows,
    /// Residual that the caller does not use.
    pub(super) spare: Vec<f64>,
}

impl FilmScratch {
    pub(super) fn new(film: &Film) -> Self {
        let columns = &film.columns;
        let ones = || vec![1.0; columns.padded];
        Self {
            front: columns.front,
            n_cells: columns.n_cells,
            psi: ones(),
            inverse_psi: ones(),
            h: ones(),
            inverse_h: ones(),
            h_slope: ones(),
            g: ones(),
            inverse_g: ones(),
            g_slope: ones(),
            flux: [0, 1].map(|_| vec![0.0; columns.padded]),
            rows: PickedRows::new(columns.n_cells),
            spare: vec![0.0; columns.n_cells],
        }
    }

    /// The state set last, at its `attitude`.
    pub(super) fn cell_states<'a>(&'a self, attitude: &'a Attitude) -> CellStates<'a> {
        let cells = self.front..self.front + self.n_cells;
        CellStates {
            attitude,
            psi: &self.psi[cells.clone()],
            h: &self.h[cells.clone()],
            inverse_h: &self.inverse_h[cells.clone()],
            h_slope: &self.h_slope[cells],
        }
    }

    /// Sets the state (ψ, attitude).
    #[inline(always)]
    pub(super) fn fill(&mut self, film: &Film, psi: &[f64], attitude: &Attitude) {
        let columns = &film.columns;
        assert_eq!(psi.len(), columns.n_cells);
        assert_eq!(self.psi.len(), columns.padded);
        let front = columns.front;
        self.psi[front..front + psi.len()].copy_from_slice(psi);
        let g = &mut self.g[front..front + psi.len()];
        let slopes = &mut self.g_slope[front..front + psi.len()];
        film.flow.conductances(psi, g, slopes, &mut self.rows);
        for first in (0..columns.recess.len()).step_by(BLOCK) {
            let height = columns.places.heights(first, attitude);
            let recess = block(&columns.recess, first);
            let at = front + first;
            let [h, slope] = film.limited_block(&height, recess);
            let (psi, g) = (block(&self.psi, at), block(&self.g, at));
            // Three inverses by one division, which takes as long as a dozen products.
            let mut inverse = [[0.0; BLOCK]; 3];
            for k in 0..BLOCK {
                let all = 1.0 / ((psi[k] * g[k]) * h[k]);
                inverse[0][k] = all * (g[k] * h[k]);
                inverse[1][k] = all * (psi[k] * h[k]);
                inverse[2][k] = all * (psi[k] * g[k]);
            }
            *block_mut(&mut self.inverse_psi, at) = inverse[0];
            *block_mut(&mut self.inverse_g, at) = inverse[1];
            *block_mut(&mut self.inverse_h, at) = inverse[2];
            *block_mut(&mut self.h, at) = h;
            *block_mut(&mut self.h_slope, at) = slope;
        }
    }
}

/// The block of `column` that starts at `first`, to be written.
#[inline(always)]
pub(super) fn block_mut(column: &mut [f64], first: usize) -> &mut Block {
    (&mut column[first..first + BLOCK])
        .try_into()
        .expect("a slice of BLOCK entries")
}

/// State of a block of cells and ψ of those behind them.
pub(super) struct CellBlock<'a> {
    psi: &'a Block,
    inverse_psi: &'a Block,
    psi_behind: &'a Block,
    g: &'a Block,
    inverse_g: &'a Block,
    g_slope: &'a Block,
    h: &'a Block,
    inverse_h: &'a Block,
    h_slope: &'a Block,
}

impl FilmScratch {
    /// The cells from `at`, those behind them from `behind` in the columns of states.
    #[inline(always)]
    pub(super) fn cells(&self, at: usize, behind: usize) -> CellBlock<'_> {
        CellBlock {
            psi: block(&self.psi, at),
            inverse_psi: block(&self.inverse_psi, at),
            psi_behind: block(&self.psi, behind),
            g: block(&self.g, at),
            inverse_g: block(&self.inverse_g, at),
            g_slope: block(&self.g_slope, at),
            h: block(&self.h, at),
            inverse_h: block(&self.inverse_h, at),
            h_slope: block(&self.h_slope, at),
        }
    }
}

/// G of both half cells of a block of faces at the mean of ψ of their cells, and its inverse ([`super::flux`]).
pub(super) struct MeanConductance {
    g: [Block; 2],
    inverse_g: [Block; 2],
}

/// dG/dψ there.
const MEAN_SLOPE: Block = [0.5; BLOCK];

impl MeanConductance {
    /// A side on the slider's edge with it, where the film has it, and the height `h_face` there; it is kept in `kept`.
    #[inline(always)]
    pub(super) fn of_edge<'a>(
        film: &Film,
        side: SideBlock<'a>,
        h_face: &Block,
        kept: &'a mut Option<Self>,
    ) -> SideBlock<'a> {
        if !film.has_mean_conductance() {
            return side;
        }
        let mean = kept.insert(Self::at_edge(&side, film.ambient_pa, h_face));
        side.with(mean, 0)
    }

    /// Between the cells of two sides.
    #[inline(always)]
    fn between([up, down]: [&SideBlock<'_>; 2]) -> Self {
        let (mut g, mut inverse_g) = ([[0.0; BLOCK]; 2], [[0.0; BLOCK]; 2]);
        for k in 0..BLOCK {
            let (u, d) = (up.cells.psi[k], down.cells.psi[k]);
            let is_smooth = up.recess[k] == down.recess[k];
            g[0][k] = 0.5 * (u + if is_smooth { d } else { down.p(k) * up.h(k) });
            g[1][k] = 0.5 * (d + if is_smooth { u } else { up.p(k) * down.h(k) });
            let inverse = 1.0 / (g[0][k] * g[1][k]);
            (inverse_g[0][k], inverse_g[1][k]) = (inverse * g[1][k], inverse * g[0][k]);
        }
        Self { g, inverse_g }
    }

    /// Between the cells of a side and the pressure `p` at the slider's edge; only the first of both is set.
    #[inline(always)]
    fn at_edge(side: &SideBlock<'_>, p: f64, h_face: &Block) -> Self {
        let mut out = Self {
            g: [[1.0; BLOCK]; 2],
            inverse_g: [[1.0; BLOCK]; 2],
        };
        for (k, h_face) in h_face.iter().enumerate() {
            out.g[0][k] = 0.5 * p.mul_add(*h_face, side.cells.psi[k]);
            out.inverse_g[0][k] = 1.0 / out.g[0][k];
        }
        out
    }
}

impl Interior {
    /// Both sides of the faces from `first`, with the mean G where the film has it, which is kept in `kept`.
    #[inline(always)]
    pub(super) fn sides<'a>(
        &'a self,
        film: &Film,
        state: &'a FilmScratch,
        first: usize,
        kept: &'a mut Option<MeanConductance>,
    ) -> [SideBlock<'a>; 2] {
        let (up, down) = (self.up + first, self.down + first);
        let up = SideBlock::new(
            state.cells(up, self.behind + first),
            &self.up_side,
            first,
            self.wind,
        );
        let down = SideBlock::new(state.cells(down, down), &self.down_side, first, -self.wind);
        if !film.has_mean_conductance() {
            return [up, down];
        }
        let mean = kept.insert(MeanConductance::between([&up, &down]));
        [up.with(mean, 0), down.with(mean, 1)]
    }
}

/// One side of a block of faces: its cells' state and what is fixed about them.
pub(super) struct SideBlock<'a> {
    cells: CellBlock<'a>,
    pub(super) recess: &'a Block,
    pub(super) reach: &'a Block,
    distance: &'a Block,
    inverse_distance: &'a Block,
    pub(super) area: &'a Block,
    /// 6 μ U out of the cells.
    pub(super) wind: f64,
}

impl<'a> SideBlock<'a> {
    /// `cells` at the faces from `first`.
    #[inline(always)]
    pub(super) fn new(cells: CellBlock<'a>, sides: &'a Sides, first: usize, wind: f64) -> Self {
        Self {
            cells,
            recess: block(&sides.recess, first),
            reach: block(&sides.reach, first),
            distance: block(&sides.distance, first),
            inverse_distance: block(&sides.inverse_distance, first),
            area: block(&sides.area, first),
            wind,
        }
    }

    /// The same with the `which`-th conductances of `mean`.
    #[inline(always)]
    fn with(mut self, mean: &'a MeanConductance, which: usize) -> Self {
        self.cells.g = &mean.g[which];
        self.cells.inverse_g = &mean.inverse_g[which];
        self.cells.g_slope = &MEAN_SLOPE;
        self
    }

    /// Pressure at the centre of cell k.
    #[inline(always)]
    pub(super) fn p(&self, k: usize) -> f64 {
        self.cells.psi[k] * self.cells.inverse_h[k]
    }

    /// Height at the centre of cell k.
    #[inline(always)]
    pub(super) fn h(&self, k: usize) -> f64 {
        self.cells.h[k]
    }

    /// Derivative of that height by the true one.
    #[inline(always)]
    pub(super) fn h_slope(&self, k: usize) -> f64 {
        self.cells.h_slope[k]
    }

    /// Half cell k for kernels without the inverses of its heights, which are NaN here.
    #[inline(always)]
    pub(super) fn bare_half(&self, k: usize, h_face: f64) -> HalfCell {
        self.half(k, h_face, [f64::NAN; 2])
    }

    /// Half cell k with the height `h_face` at the face and `inverses` of its heights.
    #[inline(always)]
    pub(super) fn half(&self, k: usize, h_face: f64, inverses: [f64; 2]) -> HalfCell {
        HalfCell {
            psi: self.cells.psi[k],
            inverse_psi: self.cells.inverse_psi[k],
            psi_behind: self.cells.psi_behind[k],
            reach: self.reach[k],
            g: self.cells.g[k],
            inverse_g: self.cells.inverse_g[k],
            g_slope: self.cells.g_slope[k],
            h_centre: self.cells.h[k],
            inverse_h: self.cells.inverse_h[k],
            h_face,
            inverses,
            distance: self.distance[k],
            inverse_distance: self.inverse_distance[k],
            wind: self.wind,
        }
    }
}

/// State of cells picked one by one.
pub(super) struct Picked {
    psi: Block,
    inverse_psi: Block,
    psi_behind: Block,
    g: Block,
    inverse_g: Block,
    g_slope: Block,
    h: Block,
    inverse_h: Block,
    h_slope: Block,
}

impl Picked {
    /// The cells in `cells` with those behind them; `front` cells precede cell 0. Without wind neither the cells behind
    /// nor the inverses that wind needs are set.
    #[inline(always)]
    pub(super) fn new(
        state: &FilmScratch,
        cells: &[usize],
        behind: &[usize],
        front: usize,
        has_wind: bool,
    ) -> Self {
        let pick = |column: &[f64], cells: &[usize]| picked(column, cells, front);
        let for_wind = |column: &[f64], cells: &[usize]| {
            if has_wind {
                picked(column, cells, front)
            } else {
                [f64::NAN; BLOCK]
            }
        };
        Self {
            psi: pick(&state.psi, cells),
            inverse_psi: for_wind(&state.inverse_psi, cells),
            psi_behind: for_wind(&state.psi, behind),
            g: pick(&state.g, cells),
            inverse_g: for_wind(&state.inverse_g, cells),
            g_slope: pick(&state.g_slope, cells),
            h: pick(&state.h, cells),
            inverse_h: pick(&state.inverse_h, cells),
            h_slope: pick(&state.h_slope, cells),
        }
    }

    #[inline(always)]
    pub(super) fn cells(&self) -> CellBlock<'_> {
        CellBlock {
            psi: &self.psi,
            inverse_psi: &self.inverse_psi,
            psi_behind: &self.psi_behind,
            g: &self.g,
            inverse_g: &self.inverse_g,
            g_slope: &self.g_slope,
            h: &self.h,
            inverse_h: &self.inverse_h,
            h_slope: &self.h_slope,
        }
    }
}

#[inline(always)]
fn picked(column: &[f64], cells: &[usize], front: usize) -> Block {
    let mut out = [0.0; BLOCK];
    for (out, cell) in out.iter_mut().zip(cells) {
        *out = column[front + cell];
    }
    out
}
