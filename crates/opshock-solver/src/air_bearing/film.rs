//! The discrete film: gas, geometry and grid of one slider, built once.
//!
//! ```text
//! M dψ/dt + R(ψ, attitude) = 0,   R = sum of outward face fluxes
//! ```
//!
//! ψ = p h is the gas mass per area times R T. The balance is therefore conservative, and the squeeze of the film
//! enters through dψ/dt alone. Fluxes are those of [two half cells](super::flux) at
//! every face, with ambient pressure on the faces of the slider's edges. `balance` holds the balance itself,
//! [`super::layout`] the choice of the grid.

use super::attitude::Attitude;
use super::defect::Defect;
use super::faces::{BLOCK, Block, Columns, block};
use super::flow_factor::{FlowFactor, FlowModel};
use super::flux::HalfCell;
use super::gap_load::GapLoad;
use super::heights::inverses;
use super::mesh::{Cell, Mesh, Side};
use super::thickness::HeightLimit;
use crate::gas::GasParameters;
use crate::lanes::{Kernel, widest};
use crate::linalg::banded::BandedLu;
use crate::linalg::diagonals::Diagonals;
use crate::rough_contact::nominal::ContactState;
use crate::slider::clearance::{Clearance, ClearanceMap};
use std::fmt::Debug;
use std::sync::Arc;

/// A roll that moves no point of a slider by a thousandth of an atom's size, rad.
const LEAN_RAD: f64 = 1e-11;

/// Film under one slider: immutable once built.
#[derive(Clone, Debug)]
pub struct Film {
    pub(super) mesh: Mesh,
    pub(super) columns: Columns,
    pub(super) capacity: Vec<f64>,
    pub(super) storage: Diagonals,
    pub(super) flow: FlowFactor,
    pub(super) height_limit: HeightLimit,
    pub(super) gas: GasParameters,
    pub(super) ambient_pa: f64,
    /// Velocity of the disk along x and y, m/s.
    pub(super) disk_velocity_m_per_s: [f64; 2],
    pub(super) clearance: ClearanceMap,
    pub(super) usual: Attitude,
    /// Approximate ψ in the usual attitude.
    pub(super) usual_psi: Vec<f64>,
    /// Forces on the slider other than the air's pressure, each with its key; empty unless requested.
    pub(super) gap_forces: Vec<(&'static str, Arc<dyn Element>)>,
    /// Defect correction for the grid's discretisation error; none unless requested.
    pub(super) defect: Option<Defect>,
}

/// State of the cells on which a force other than the air's pressure may depend, one entry for each cell.
pub struct CellStates<'a> {
    /// Attitude of the slider.
    pub attitude: &'a Attitude,
    /// ψ, Pa m.
    pub psi: &'a [f64],
    /// Height that the film sees, m.
    pub h: &'a [f64],
    /// Its inverse, 1/m.
    pub inverse_h: &'a [f64],
    /// Its derivative by the true height.
    pub h_slope: &'a [f64],
    /// Smallest true height so far of every place that an [`Element`] remembers, m; infinite where there is none yet.
    pub closest_m: &'a [f64],
}

impl CellStates<'_> {
    /// Pressure at the centre of a cell, Pa.
    pub fn pressure(&self, cell: usize) -> f64 {
        self.psi[cell] * self.inverse_h[cell]
    }
}

/// A force on the slider other than the air's pressure, over the cells of one film. Residual and linearisation loop
/// over a list of these.
pub trait Element: Debug + Send + Sync {
    /// Force and moments [F_z, M_pitch, M_roll], conjugate to (h_c, pitch, roll), N and N m.
    fn force(&self, film: &Film, cells: &CellStates<'_>) -> [f64; 3];

    /// The same with derivatives; those by ψ are added to `by_psi`, one column for each force.
    fn load(&self, film: &Film, cells: &CellStates<'_>, by_psi: &mut [Vec<f64>; 3]) -> GapLoad;

    /// Places whose smallest height so far it depends on; at most one force of a film has some.
    fn n_remembered(&self) -> usize {
        0
    }

    /// Takes the heights at `attitude` into the smallest ones so far.
    fn remember(&self, _attitude: &Attitude, _closest_m: &mut [f64]) {}

    /// What the asperities bear at `attitude`; `None` for a force that is no contact.
    fn contact(&self, _attitude: &Attitude, _closest_m: &[f64]) -> Option<ContactState> {
        None
    }

    /// What the asperities give back as slider and disk part from `attitude`, J.
    fn elastic_j(&self, _attitude: &Attitude, _closest_m: &[f64]) -> f64 {
        0.0
    }

    /// Work of bringing the surfaces to the smallest heights so far that they do not give back, J.
    fn yielded_j(&self, _closest_m: &[f64]) -> f64 {
        0.0
    }

    /// `share` of a force that may pull the slider onto the disk and so end its flight; `None` for any other force.
    fn share_of_attraction(&self, _share: f64) -> Option<Arc<dyn Element>> {
        None
    }
}

impl Film {
    /// Number of cells n, the length of every ψ.
    pub fn n_cells(&self) -> usize {
        self.mesh.cells.len()
    }

    /// Grid lines along x and along y, m.
    pub fn lines_m(&self) -> [&[f64]; 2] {
        [self.mesh.lines[0].as_slice(), self.mesh.lines[1].as_slice()]
    }

    /// Index in ψ of the cell between lines `i`, `i + 1` along x and `j`, `j + 1` along y.
    pub fn cell_index(&self, i: usize, j: usize) -> usize {
        self.mesh.index(i, j)
    }

    /// M, Pa s m2, the factor of dψ/dt (`air_bearing/storage.rs` derives it). Its columns add up to [`Film::capacity`].
    pub fn storage(&self) -> &Diagonals {
        &self.storage
    }

    /// Turns M dψ/dt into dψ/dt in place.
    ///
    /// # Panics
    ///
    /// When `stored` has not n_cells entries.
    pub fn spread_by_storage(&self, stored: &mut [f64]) {
        let (storage, n) = (&self.storage, self.n_cells());
        let mut lu = BandedLu::<f64>::new(n, storage.band());
        lu.factor(storage, 0.0, &Diagonals::zeros(n, Vec::new()))
            .expect("columns with more on the diagonal than beside it");
        lu.solve(stored);
    }

    /// 12 μ A of every cell, Pa s m2: ψ times it is the gas that the cell holds.
    pub fn capacity(&self) -> &[f64] {
        &self.capacity
    }

    /// Ambient pressure, Pa.
    pub fn ambient_pa(&self) -> f64 {
        self.ambient_pa
    }

    /// Gas around the drive.
    pub fn gas(&self) -> &GasParameters {
        &self.gas
    }

    /// Rarefaction model.
    pub fn flow_model(&self) -> FlowModel {
        self.flow.model()
    }

    /// Velocity of the disk under the slider along its x and y, m/s.
    pub fn disk_velocity_m_per_s(&self) -> [f64; 2] {
        self.disk_velocity_m_per_s
    }

    /// Attitude of a slider in ordinary flight, the first guess of steady states and what the grid
    /// is laid out for.
    pub fn usual_attitude(&self) -> Attitude {
        self.usual
    }

    /// Length and width of the slider, m.
    pub fn extent_m(&self) -> [f64; 2] {
        [0, 1].map(|d| {
            let lines = self.mesh.lines[d].as_slice();
            lines[lines.len() - 1] - lines[0]
        })
    }

    /// Minimum film height h0 between smooth surfaces, the roughness between rough ones, m.
    pub fn min_height_m(&self) -> f64 {
        self.height_limit.scale_m()
    }

    /// Height the film sees in a cell and its derivative by the true height.
    #[inline]
    pub(super) fn cell_height(&self, cell: &Cell, attitude: &Attitude) -> (f64, f64) {
        self.height_limit
            .apply(cell.place.height(attitude) + cell.recess)
    }

    /// Height the film sees where the true height is `h`, and its derivative.
    #[inline(always)]
    pub(super) fn limited(&self, h: f64) -> (f64, f64) {
        self.height_limit.apply(h)
    }

    /// Heights the film sees in a block where the true ones are `base` + `recess`, and their
    /// derivatives.
    #[inline(always)]
    pub(super) fn limited_block<const ROUGH: bool>(
        &self,
        base: &Block,
        recess: &Block,
    ) -> [Block; 2] {
        self.height_limit.apply_block::<ROUGH>(base, recess)
    }

    /// Half cell of `side` where the height is `h_centre` at the centre and `base` at the face, without recess, and ψ
    /// `across` the face, behind an etched step that of the pressure there at the height here; and the derivative of its G by the latter.
    pub(super) fn half_cell(
        &self,
        side: &Side,
        psi: &[f64],
        [h_centre, base]: [f64; 2],
        across: f64,
    ) -> (HalfCell, f64) {
        let flow = &self.flow;
        let at_centre = flow.conductance(psi[side.cell]);
        let [g, g_slope, by_across] = flow.of_half_cell(psi[side.cell], at_centre, across);
        let h_face = self.limited(base + side.recess).0;
        let half = HalfCell {
            psi: psi[side.cell],
            inverse_psi: 1.0 / psi[side.cell],
            psi_behind: psi[side.behind],
            reach: side.reach,
            g,
            inverse_g: 1.0 / g,
            g_slope,
            h_centre,
            inverse_h: 1.0 / h_centre,
            h_face,
            inverses: inverses(h_centre, h_face),
            distance: 1.0 / side.inverse_distance,
            inverse_distance: side.inverse_distance,
            wind: side.wind,
        };
        (half, by_across)
    }

    /// ψ of the undisturbed ambient pressure, Pa m.
    ///
    /// # Panics
    ///
    /// When `out` has not n_cells entries.
    pub fn ambient_psi(&self, attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(out.len(), self.n_cells());
        for (psi, cell) in out.iter_mut().zip(&self.mesh.cells) {
            *psi = self.ambient_pa * self.cell_height(cell, attitude).0;
        }
    }

    /// ψ where the pressure is ambient everywhere, Pa m, one for each cell.
    pub(super) fn ambient(&self, attitude: &Attitude) -> Vec<f64> {
        let mut psi = vec![0.0; self.n_cells()];
        self.ambient_psi(attitude, &mut psi);
        psi
    }

    /// ψ from which to seek the film in the usual attitude, Pa m: that of the preceding grids, or ambient pressure on a
    /// given grid.
    pub(super) fn usual_psi(&self) -> &[f64] {
        &self.usual_psi
    }

    /// Pressure at the cells' centres, Pa.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn pressure(&self, psi: &[f64], attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(out.len(), self.n_cells());
        for ((p, psi), cell) in out.iter_mut().zip(psi).zip(&self.mesh.cells) {
            *p = psi / self.cell_height(cell, attitude).0;
        }
    }

    /// Lowest pressure at a cell's centre, Pa; cells whose pressure is NaN are ignored.
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries.
    pub fn lowest_pressure_pa(&self, psi: &[f64], attitude: &Attitude) -> f64 {
        assert_eq!(psi.len(), self.n_cells());
        let film = self;
        let lowest = match self.height_limit.is_rough() {
            true => widest(LowestPressure::<true> {
                film,
                psi,
                attitude,
            }),
            false => widest(LowestPressure::<false> {
                film,
                psi,
                attitude,
            }),
        };
        lowest.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Height of the slider's surface over the disk at the cells' centres, m, without the minimum film height.
    ///
    /// # Panics
    ///
    /// When `out` has not n_cells entries.
    pub fn heights(&self, attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(out.len(), self.n_cells());
        for (h, cell) in out.iter_mut().zip(&self.mesh.cells) {
            *h = cell.place.height(attitude) + cell.recess;
        }
    }

    /// `attitude` with a negligible roll to the side to which wind across the slider rolls it. Of two points that
    /// mirror each other it selects the closer one, so that skews of either sign have grids that mirror each other.
    pub(super) fn leaning(&self, attitude: &Attitude) -> Attitude {
        let lean_rad = match self.blows_across() {
            true if self.blows_inwards() => -LEAN_RAD,
            true => LEAN_RAD,
            false => 0.0,
        };
        Attitude {
            roll_rad: attitude.roll_rad + lean_rad,
            ..*attitude
        }
    }

    /// Whether the wind blows across the slider as well.
    pub(super) fn blows_across(&self) -> bool {
        self.columns.interior[1].wind != 0.0
    }

    /// Whether the wind blows across the slider towards its inner side.
    pub(super) fn blows_inwards(&self) -> bool {
        let across = &self.columns.interior[1];
        across.up > across.down
    }

    /// Smallest clearance of the true surface over the disk's plane.
    pub fn min_clearance(&self, attitude: &Attitude) -> Clearance {
        self.clearance.minimum(
            attitude.centre_height_m,
            attitude.pitch_rad,
            attitude.roll_rad,
        )
    }
}

struct LowestPressure<'a, const ROUGH: bool> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
}

impl<const ROUGH: bool> Kernel for LowestPressure<'_, ROUGH> {
    type Output = Block;

    #[inline(always)]
    fn call(self) -> Block {
        let columns = &self.film.columns;
        let mut lowest = [f64::INFINITY; BLOCK];
        for (at, cells) in self.psi.chunks(BLOCK).enumerate() {
            let first = at * BLOCK;
            let base = columns.places.heights(first, self.attitude);
            let [h, _] = self
                .film
                .limited_block::<ROUGH>(&base, block(&columns.recess, first));
            // The unused rest of the last block holds no gas and must not give the lowest pressure.
            let mut psi = [f64::INFINITY; BLOCK];
            psi[..cells.len()].copy_from_slice(cells);
            for k in 0..BLOCK {
                let p = psi[k] / h[k];
                lowest[k] = if p < lowest[k] { p } else { lowest[k] };
            }
        }
        lowest
    }
}
