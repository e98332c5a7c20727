//! Cells and faces of a film's grid: places, recesses, sizes, and the wind through every face.
//!
//! Cells are numbered along y first. A grid has fewer lines that way, and the band of a matrix over the cells is as
//! wide as a column of cells. Fluxes along x reach one cell further upstream where the wind carries them, which makes
//! the band one column wider on that side.

use super::attitude::Attitude;
use super::corner::{Widths, conductance_factors};
use crate::grid::Lines;
use crate::slider::surface::Surface;

/// Recesses that differ by less belong to one smooth part of the film.
const SAME_RECESS_M: f64 = 1e-12;

/// Whether surfaces of these recesses are one, without an etched step in between.
#[inline(always)]
pub(super) fn is_smooth([left, right]: [f64; 2]) -> bool {
    (left - right).abs() < SAME_RECESS_M
}

/// Height of a place: the constant part and the lever arms of pitch and roll.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Form, without recess, m.
    pub(super) form: f64,
    /// x − x_c, m.
    pub(super) x: f64,
    /// y − y_c, m.
    pub(super) y: f64,
}

impl Place {
    pub(super) fn new(surface: &Surface, x: f64, y: f64) -> Self {
        let [xc, yc] = surface.centre_m();
        Self {
            form: surface.form_m(x, y),
            x: x - xc,
            y: y - yc,
        }
    }

    #[inline(always)]
    pub(super) fn height(&self, attitude: &Attitude) -> f64 {
        attitude.centre_height_m - attitude.pitch_rad * self.x
            + attitude.roll_rad * self.y
            + self.form
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) place: Place,
    pub(super) recess: f64,
    pub(super) area: f64,
}

/// One cell's side of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) cell: usize,
    /// The next cell away from the face; `cell` itself when `reach` is 0.
    pub(super) behind: usize,
    /// See [`HalfCell::reach`](super::flux::HalfCell::reach).
    pub(super) reach: f64,
    pub(super) recess: f64,
    /// 1/Δ.
    pub(super) inverse_distance: f64,
    /// 6 μ U · outward normal.
    pub(super) wind: f64,
    /// Area of the half cell.
    pub(super) area: f64,
}

/// Face between two cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) sides: [Side; 2],
    pub(super) place: Place,
    pub(super) length: f64,
}

impl Face {
    /// True when both sides belong to one smooth part of the film.
    pub(super) fn is_smooth(&self) -> bool {
        is_smooth(self.sides.map(|side| side.recess))
    }
}

/// Face on the slider's edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeFace {
    pub(super) side: Side,
    pub(super) place: Place,
    pub(super) length: f64,
}

/// All cells and faces of one film.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    /// Grid lines along x and along y.
    pub(super) lines: [Lines; 2],
    pub(super) cells: Vec<Cell>,
    /// Faces across x, then faces across y, each in the order of the cells in front of them.
    pub(super) faces: Vec<Face>,
    /// The faces on both ends of the rows, then those on both ends of the columns.
    pub(super) edge_faces: Vec<EdgeFace>,
}

impl Mesh {
    /// Mesh of `surface` on `lines` with the wind 6 μ U along x and y.
    pub(super) fn new(surface: &Surface, lines: [Lines; 2], wind: [f64; 2]) -> Self {
        let cells = cells(surface, &lines);
        let mut mesh = Self {
            faces: Vec::with_capacity(2 * cells.len()),
            edge_faces: Vec::with_capacity(4 * lines[0].n_cells().max(lines[1].n_cells())),
            cells,
            lines,
        };
        let [nx, ny] = mesh.counts();
        for line in 0..=nx {
            for row in 0..ny {
                mesh.add_face(surface, 0, line, row, wind[0]);
            }
        }
        for column in 0..nx {
            for line in 0..=ny {
                mesh.add_face(surface, 1, line, column, wind[1]);
            }
        }
        mesh
    }

    /// Cells along x and along y.
    pub(super) fn counts(&self) -> [usize; 2] {
        [self.lines[0].n_cells(), self.lines[1].n_cells()]
    }

    /// Number of the cell in column i and row j.
    pub(super) fn index(&self, i: usize, j: usize) -> usize {
        i * self.lines[1].n_cells() + j
    }

    /// Column and row of cell `c`.
    pub(super) fn place_of(&self, c: usize) -> [usize; 2] {
        let ny = self.lines[1].n_cells();
        [c / ny, c % ny]
    }

    /// Adds the face on line `line` of direction `d` between lines `across` and `across` + 1 of the
    /// other.
    fn add_face(&mut self, surface: &Surface, d: usize, line: usize, across: usize, wind: f64) {
        let n = self.lines[d].n_cells();
        let at = self.lines[d].as_slice()[line];
        let middle = self.lines[1 - d].centre(across);
        let (x, y) = if d == 0 { (at, middle) } else { (middle, at) };
        let place = Place::new(surface, x, y);
        let length = self.lines[1 - d].width(across);
        if line == 0 || line == n {
            let side = if line == 0 {
                self.side(d, 0, across, -1.0, wind)
            } else {
                self.side(d, n - 1, across, 1.0, wind)
            };
            self.edge_faces.push(EdgeFace {
                side,
                place,
                length,
            });
        } else {
            let sides = [
                self.side(d, line - 1, across, 1.0, wind),
                self.side(d, line, across, -1.0, wind),
            ];
            self.faces.push(Face {
                sides,
                place,
                length,
            });
        }
    }

    /// Side of the k-th cell along direction `d`, whose outward normal points along `sign`.
    fn side(&self, d: usize, k: usize, across: usize, sign: f64, wind: f64) -> Side {
        let lines = &self.lines[d];
        let cell = |k: usize| {
            if d == 0 {
                self.index(k, across)
            } else {
                self.index(across, k)
            }
        };
        let recess = |k: usize| self.cells[cell(k)].recess;
        let behind = if sign > 0.0 {
            k.checked_sub(1)
        } else {
            Some(k + 1).filter(|&b| b < lines.n_cells())
        };
        let behind = behind.filter(|&b| sign * wind > 0.0 && is_smooth([recess(b), recess(k)]));
        let half_width = 0.5 * lines.width(k);
        Side {
            cell: cell(k),
            behind: cell(behind.unwrap_or(k)),
            reach: behind.map_or(0.0, |b| lines.width(k) / (lines.width(k) + lines.width(b))),
            recess: recess(k),
            inverse_distance: 1.0 / half_width,
            wind: sign * wind,
            area: half_width * self.lines[1 - d].width(across),
        }
    }

    /// Leaves out the straight lines that continue ψ to the faces of `cells`, rising.
    pub(super) fn flatten_at(&mut self, cells: &[usize]) {
        let is_one = |side: &Side| cells.binary_search(&side.cell).is_ok();
        let flatten = |side: &mut Side| (side.behind, side.reach) = (side.cell, 0.0);
        for Face { sides, .. } in &mut self.faces {
            if sides.iter().any(is_one) {
                sides.iter_mut().for_each(flatten);
            }
        }
        for EdgeFace { side, .. } in &mut self.edge_faces {
            if is_one(side) {
                flatten(side);
            }
        }
    }

    /// Gives the faces around singular corners of the surface the conductance of the local
    /// solution; `kappa` is the conductance G h² at a height, and the heights are those at `usual`.
    pub(super) fn correct_corners(
        &mut self,
        surface: &Surface,
        usual: &Attitude,
        kappa: impl Fn(f64) -> f64,
    ) {
        let [nx, ny] = self.counts();
        for i in 1..nx {
            for j in 1..ny {
                // Counter-clockwise from the cell left below, as the faces between them.
                let around = [
                    self.index(i - 1, j - 1),
                    self.index(i, j - 1),
                    self.index(i, j),
                    self.index(i - 1, j),
                ];
                let recess = around.map(|c| self.cells[c].recess);
                // A flat surface and a straight edge have no singularity.
                let same = |a: usize, b: usize| is_smooth([recess[a], recess[b]]);
                if (same(0, 1) && same(2, 3)) || (same(1, 2) && same(3, 0)) {
                    continue;
                }
                let [x, y] = &self.lines;
                let base = Place::new(surface, x.as_slice()[i], y.as_slice()[j]).height(usual);
                let widths = Widths {
                    left: x.width(i - 1),
                    right: x.width(i),
                    below: y.width(j - 1),
                    above: y.width(j),
                };
                let factors = conductance_factors(recess.map(|r| kappa(base + r)), &widths);
                let x_face = |j: usize| (i - 1) * ny + j;
                let y_face = |i: usize| (nx - 1) * ny + i * (ny - 1) + (j - 1);
                let meeting = [x_face(j - 1), y_face(i), x_face(j), y_face(i - 1)];
                for (face, factor) in meeting.into_iter().zip(factors) {
                    for side in &mut self.faces[face].sides {
                        side.inverse_distance *= factor;
                    }
                }
            }
        }
    }
}

fn cells(surface: &Surface, lines: &[Lines; 2]) -> Vec<Cell> {
    let [nx, ny] = [lines[0].n_cells(), lines[1].n_cells()];
    let (xs, ys) = (lines[0].as_slice(), lines[1].as_slice());
    let mut cells = Vec::with_capacity(nx * ny);
    for i in 0..nx {
        for j in 0..ny {
            cells.push(Cell {
                place: Place::new(surface, lines[0].centre(i), lines[1].centre(j)),
                recess: surface.mean_recess_m([xs[i], xs[i + 1]], [ys[j], ys[j + 1]]),
                area: lines[0].width(i) * lines[1].width(j),
            });
        }
    }
    cells
}
