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
    /// Smallest heights so far of the places that a force remembers, m.
    pub(crate) closest_m: Vec<f64>,
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
            closest_m: vec![f64::INFINITY; film.n_remembered()],
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
            closest_m: &self.closest_m,
        }
    }

    /// Sets the state (ψ, attitude).
    #[inline(always)]
    pub(super) fn fill<const ROUGH: bool>(
        &mut self,
        film: &Film,
        psi: &[f64],
        attitude: &Attitude,
    ) {
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
            let [h, slope] = film.limited_block::<ROUGH>(&height, recess);
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

/// G of both half cells of a block of faces, its inverse, and its derivatives by ψ of the cell and across the face
/// ([`super::flux`]).
pub(super) struct FaceConductance {
    g: [Block; 2],
    inverse_g: [Block; 2],
    slope: [Block; 2],
    by_across: [Block; 2],
}

impl FaceConductance {
    /// `sides` with ψ `across` the faces; none where G is that of the centres everywhere.
    #[inline(always)]
    fn new<const N: usize>(
        film: &Film,
        sides: [&SideBlock<'_>; N],
        across: &[Block; N],
    ) -> Option<Self> {
        let mut any = film.flow.is_proportional();
        for (side, across) in sides.iter().zip(across) {
            let CellBlock { psi, g, .. } = side.cells;
            for k in 0..BLOCK {
                any |= across[k] - psi[k] > g[k];
            }
        }
        if !any {
            return None;
        }
        let mut out = Self {
            g: [[1.0; BLOCK]; 2],
            inverse_g: [[1.0; BLOCK]; 2],
            slope: [[0.0; BLOCK]; 2],
            by_across: [[0.0; BLOCK]; 2],
        };
        for (s, (side, across)) in sides.into_iter().zip(across).enumerate() {
            let CellBlock {
                psi, g, g_slope, ..
            } = side.cells;
            for k in 0..BLOCK {
                let at_centre = (g[k], g_slope[k]);
                let [g, slope, by_across] = film.flow.of_half_cell(psi[k], at_centre, across[k]);
                out.g[s][k] = g;
                out.inverse_g[s][k] = 1.0 / g;
                out.slope[s][k] = slope;
                out.by_across[s][k] = by_across;
            }
        }
        Some(out)
    }

    /// A side on the slider's edge with it, where the height is `h_face`; it is kept in `kept`.
    #[inline(always)]
    pub(super) fn of_edge<'a>(
        film: &Film,
        side: SideBlock<'a>,
        h_face: &Block,
        kept: &'a mut Option<Self>,
    ) -> SideBlock<'a> {
        let across = h_face.map(|h| film.ambient_pa * h);
        *kept = Self::new(film, [&side], &[across]);
        match kept {
            Some(conductance) => side.with(conductance, 0),
            None => side,
        }
    }
}

impl Interior {
    /// Both sides of the faces from `first`, with G of the faces where it is not that of the centres, which is kept in
    /// `kept`.
    #[inline(always)]
    pub(super) fn sides<'a>(
        &'a self,
        film: &Film,
        state: &'a FilmScratch,
        first: usize,
        kept: &'a mut Option<FaceConductance>,
    ) -> [SideBlock<'a>; 2] {
        let (up, down) = (self.up + first, self.down + first);
        let up = SideBlock::new(
            state.cells(up, self.behind + first),
            &self.up_side,
            first,
            self.wind,
        );
        let down = SideBlock::new(state.cells(down, down), &self.down_side, first, -self.wind);
        let step = block(&self.step, first);
        let across = [up.across(&down, step), down.across(&up, step)];
        *kept = FaceConductance::new(film, [&up, &down], &across);
        match kept {
            Some(conductance) => [up.with(conductance, 0), down.with(conductance, 1)],
            None => [up, down],
        }
    }
}

/// One side of a block of faces: its cells' state and what is fixed about them.
pub(super) struct SideBlock<'a> {
    cells: CellBlock<'a>,
    /// Derivative of G by ψ across the faces, where it has any.
    pub(super) by_across: Option<&'a Block>,
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
            by_across: None,
            recess: block(&sides.recess, first),
            reach: block(&sides.reach, first),
            distance: block(&sides.distance, first),
            inverse_distance: block(&sides.inverse_distance, first),
            area: block(&sides.area, first),
            wind,
        }
    }

    /// The same with the `which`-th conductances.
    #[inline(always)]
    fn with(mut self, conductance: &'a FaceConductance, which: usize) -> Self {
        self.cells.g = &conductance.g[which];
        self.cells.inverse_g = &conductance.inverse_g[which];
        self.cells.g_slope = &conductance.slope[which];
        self.by_across = Some(&conductance.by_across[which]);
        self
    }

    /// ψ of `other` across the faces, behind an etched `step` that of the pressure there at the height here.
    #[inline(always)]
    fn across(&self, other: &SideBlock<'_>, step: &Block) -> Block {
        let mut out = *other.cells.psi;
        for (k, psi) in out.iter_mut().enumerate() {
            *psi *= other.height_ratio(self, step, k);
        }
        out
    }

    /// Derivative of ψ that `other` sees across face k by ψ here: 1, on an etched `step` the ratio of its height to that
    /// here. Without a choice, so that whole registers hold it.
    #[inline(always)]
    pub(super) fn height_ratio(&self, other: &SideBlock<'_>, step: &Block, k: usize) -> f64 {
        1.0 + step[k] * (other.h(k) * self.inverse_h(k) - 1.0)
    }

    /// Pressure at the centre of cell k.
    #[inline(always)]
    pub(super) fn p(&self, k: usize) -> f64 {
        self.cells.psi[k] * self.cells.inverse_h[k]
    }

    /// Inverse of the height at the centre of cell k.
    #[inline(always)]
    pub(super) fn inverse_h(&self, k: usize) -> f64 {
        self.cells.inverse_h[k]
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
