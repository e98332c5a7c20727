//! Places the film's grid lines by an estimate of the discretisation error of the clearance.
//!
//! Lines run through every edge of the surface. How many cells lie between two edges, and how they crowd there, follows
//! the estimate: with κ = G h² the conductance, p the pressure, ψ = p h, w = 6 μ U the wind and z the adjoint of the
//! flying height (what a mass flux into a cell does to the clearance at constant load), fluxes of second order miss the
//! clearance by about
//!
//! ```text
//! E = ∬ Δx² e_x + Δy² e_y dx dy,   e_x = c_d |κ p_xx z_xx| + c_w |w_x ψ_xx z_x|,   e_y alike.
//! ```
//!
//! The first part is that of the two-point diffusive flux κ (p_r − p_l)/Δ, off by Δ² κ p_xxx/24;
//! the second that of the convected ψ, continued from two cells behind the face and off by
//! 3/8 Δ² ψ_xx there. Most of the error under a pad is of the second kind. These leading terms
//! give c_w/c_d = 9; 12 is used, which misses the clearance least on 28 grids of 500 to 3200 cells
//! for the surfaces of both example drives (2.0 % in the mean; 3.4 % with 9, 3.8 % with 18).
//!
//! For lines along x, ∫ e_x dy remains. The spacing that makes the sum smallest for a number of lines is Δx ∝ (∫ e_x
//! dy)^(−1/3), the same along y. The ratio of the numbers of lines is that of (∫ (∫ e_x dy)^(1/3) dx)^(3/2) to the same
//! along y. Derivatives are taken inside a cell or across a face without a step, so kinks at edges do not contribute.
//! The estimate is made for a slider in ordinary flight, first on a grid with lines crowding evenly towards all edges,
//! then on its own result. (Goal-oriented error estimates: Becker and Rannacher 2001, Acta Numerica 10.)
//!
//! The sizes of neighbouring cells differ by at most a third. At a singular corner, long thin cells further out would
//! spoil the correction of the corner's own faces.

use super::attitude::Attitude;
use super::film::Film;
use super::flux::HalfCell;
use super::newton::Newton;
use crate::grid::Lines;
use crate::linalg::banded::BandedLu;
use crate::linalg::diagonals::Diagonals;
use crate::slider::surface::Surface;

/// Times the layout is improved.
pub(super) const ROUNDS: usize = 3;

/// Cells of the grids the error is estimated on; finer ones would not place lines better.
const MOST_ESTIMATE_CELLS: usize = 2000;

/// Relative step after which a film is converged well enough for the estimate: the next step would be its square.
const ESTIMATED: f64 = 1e-4;

/// Smallest density of lines, of the mean.
const FLOOR: f64 = 0.05;

/// The same where slanted sides of rails are followed in steps.
const SLANTED: f64 = 4.0;

/// Largest growth of the cell size per distance.
const GROWTH: f64 = 0.3;

/// c_d and c_w, up to a common factor.
const DIFFUSIVE: f64 = 1.0;
const CONVECTIVE: f64 = 12.0;

/// Bounds of the ratio of lines along x to lines along y.
const RATIO: [f64; 2] = [0.2, 6.0];

/// Cells of the grid to estimate on when `cells` are wanted in the end.
pub(super) fn estimate_cells(cells: usize) -> usize {
    cells.min(MOST_ESTIMATE_CELLS)
}

/// Lines through all edges, cells crowding evenly towards them.
pub(super) fn plain(surface: &Surface, cells: usize) -> Option<[Lines; 2]> {
    let target = (cells as f64).sqrt();
    let [x, y] = surface.edge_coordinates_m().map(|edges| {
        let share = |w: &[f64]| (w[1] - w[0]).sqrt();
        let total: f64 = edges.windows(2).map(share).sum();
        let mut lines = vec![edges[0]];
        for w in edges.windows(2) {
            let n = ((target * share(w) / total).round() as usize).max(1);
            for k in 1..n {
                let t = 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / n as f64).cos();
                lines.push(w[0] + (w[1] - w[0]) * t);
            }
            lines.push(w[1]);
        }
        Lines::new(lines)
    });
    Some([x?, y?])
}

/// A film in the usual attitude.
pub(super) struct Held {
    film: Film,
    /// ψ of every cell, Pa m.
    psi: Vec<f64>,
}

impl Held {
    /// ψ on the cells of another film of the same slider, Pa m.
    pub(super) fn carried_to(&self, film: &Film) -> Vec<f64> {
        carried(&self.film, &self.psi, film, &film.usual_attitude())
    }
}

/// ψ of `film` on the cells of `to`, a film of the same slider, at the pressure of the cell around each
/// centre, Pa m.
pub(super) fn carried(film: &Film, psi: &[f64], to: &Film, attitude: &Attitude) -> Vec<f64> {
    let mut out = to.ambient(attitude);
    let ambient = film.ambient(attitude);
    let lines = to.mesh.lines.each_ref();
    let column = |d: usize| -> Vec<usize> {
        let old = film.mesh.lines[d].as_slice();
        let around = |x: f64| {
            old.partition_point(|line| *line <= x)
                .clamp(1, old.len() - 1)
                - 1
        };
        (0..lines[d].n_cells())
            .map(|k| around(lines[d].centre(k)))
            .collect()
    };
    let columns = [column(0), column(1)];
    for (cell, out) in out.iter_mut().enumerate() {
        let [i, j] = to.mesh.place_of(cell);
        let old = film.mesh.index(columns[0][i], columns[1][j]);
        *out *= psi[old] / ambient[old];
    }
    out
}

/// Lines placed by the error of `film`, and its state, which was sought from `psi`; `None` when it could not be found
/// or has no error.
pub(super) fn refined(
    film: Film,
    mut psi: Vec<f64>,
    surface: &Surface,
    cells: usize,
) -> Option<([Lines; 2], Held)> {
    let attitude = film.usual_attitude();
    let mut newton = Newton::<f64>::new(&film);
    newton.hold(&mut psi, &attitude, 40, ESTIMATED).ok()?;
    newton.factor(&psi, &attitude).ok()?;
    let mut adjoint = newton.clearance_goal(&attitude)?;
    let transposed = newton.linearisation.by_psi.transposed();
    let n = film.n_cells();
    let mut lu = BandedLu::<f64>::new(n, transposed.band());
    lu.factor(&transposed, 0.0, &Diagonals::zeros(n, Vec::new()))
        .ok()?;
    lu.solve(&mut adjoint);

    let errors = strip_errors(&film, &psi, &attitude, &adjoint);
    let edges = surface.edge_coordinates_m();
    let lines = film.lines_m();
    let slanted = surface.slanted_ranges_m();
    let [x, y] = [
        Density::new(lines[0], &errors[0], &slanted[0])?,
        Density::new(lines[1], &errors[1], &slanted[1])?,
    ];
    let ratio = (x.total / y.total).powf(1.5).clamp(RATIO[0], RATIO[1]);
    let x_lines = x.lines(&edges[0], (cells as f64 * ratio).sqrt())?;
    let y_lines = y.lines(&edges[1], cells as f64 / x_lines.n_cells() as f64)?;
    Some(([x_lines, y_lines], Held { film, psi }))
}

/// What the faces of one direction give about a cell.
#[derive(Clone, Copy, Default)]
struct Strip {
    /// Sum over both faces of face minus centre, of pressure and of adjoint.
    bends: [f64; 2],
    /// Slope of ψ across either face, where the film has no step.
    psi_slope: [Option<f64>; 2],
    /// Adjoint on either face, 0 on the slider's edge.
    adjoint: [f64; 2],
}

/// ∫ e_x dy of the strips between lines along x, and ∫ e_y dx: see the module.
fn strip_errors(film: &Film, psi: &[f64], attitude: &Attitude, adjoint: &[f64]) -> [Vec<f64>; 2] {
    let [nx, ny] = [film.mesh.lines[0].n_cells(), film.mesh.lines[1].n_cells()];
    let heights: Vec<f64> = film
        .mesh
        .cells
        .iter()
        .map(|cell| film.cell_height(cell, attitude).0)
        .collect();
    let mut strips = vec![[Strip::default(); 2]; film.n_cells()];
    let is_straight = !film.blows_across();
    for (k, face) in film.mesh.faces.iter().enumerate() {
        let d = usize::from(k >= (nx - 1) * ny);
        let base = face.place.height(attitude);
        let half: [HalfCell; 2] = std::array::from_fn(|s| {
            let [side, other] = [&face.sides[s], &face.sides[1 - s]];
            let across = match face.is_smooth() {
                true => psi[other.cell],
                false => psi[other.cell] / heights[other.cell] * heights[side.cell],
            };
            film.half_cell(side, psi, [heights[side.cell], base], across)
                .0
        });
        let [(a, b), (c, e)] = half.map(|half| half.coefficients());
        let p = (a + c) / (b + e);
        let weight = half.map(|h| h.g * h.h_centre * h.h_face * h.inverse_distance);
        let [l, r] = face.sides.map(|side| side.cell);
        let z = (weight[0] * adjoint[l] + weight[1] * adjoint[r]) / (weight[0] + weight[1]);
        let lines = &film.mesh.lines[d];
        // Cells are numbered along y first. Without wind across, layouts keep the places of a numbering along x, by
        // which they were calibrated (CONVECTIVE); with wind across these would not mirror each other.
        let at = match (is_straight, d) {
            (true, 0) => [l % nx, r % nx],
            (true, _) => [l / nx, r / nx],
            (false, _) => [l, r].map(|cell| film.mesh.place_of(cell)[d]),
        };
        let apart = 0.5 * (lines.width(at[0]) + lines.width(at[1]));
        let slope = face.is_smooth().then(|| (psi[r] - psi[l]) / apart);
        for (cell, end) in [(l, 1), (r, 0)] {
            let strip = &mut strips[cell][d];
            strip.bends[0] += p - psi[cell] / heights[cell];
            strip.bends[1] += z - adjoint[cell];
            strip.psi_slope[end] = slope;
            strip.adjoint[end] = z;
        }
    }
    // Edge faces come in the order of their direction: both ends of every row, of every column.
    for (k, face) in film.mesh.edge_faces.iter().enumerate() {
        let (d, cell) = (usize::from(k >= 2 * ny), face.side.cell);
        strips[cell][d].bends[0] += film.ambient_pa - psi[cell] / heights[cell];
        strips[cell][d].bends[1] -= adjoint[cell];
    }
    let mut errors = [vec![0.0; nx], vec![0.0; ny]];
    for (c, (strip, &h)) in strips.iter().zip(&heights).enumerate() {
        let at = film.mesh.place_of(c);
        for d in 0..2 {
            let width = film.mesh.lines[d].width(at[d]);
            let across = film.mesh.lines[1 - d].width(at[1 - d]);
            let Strip {
                bends: [p, z],
                psi_slope,
                adjoint: [z_left, z_right],
            } = strip[d];
            let kappa = film.flow.conductance(psi[c]).0 * h * h;
            let diffusive = kappa * (p * z).abs() * (2.0 / width).powi(4);
            let convective = match psi_slope {
                [Some(left), Some(right)] => {
                    let wind = film.columns.interior[d].wind;
                    (wind * (right - left) * (z_right - z_left)).abs() / (width * width)
                }
                _ => 0.0,
            };
            errors[d][at[d]] += across * (DIFFUSIVE * diffusive + CONVECTIVE * convective);
        }
    }
    errors
}

/// Density of lines along one direction.
struct Density<'a> {
    /// Lines of the grid it was estimated on.
    old: &'a [f64],
    /// Its integral from the first old line to every other.
    cumulated: Vec<f64>,
    /// ∫ e^(1/3).
    total: f64,
}

impl<'a> Density<'a> {
    fn new(old: &'a [f64], errors: &[f64], slanted: &[[f64; 2]]) -> Option<Self> {
        let width = |k: usize| old[k + 1] - old[k];
        let roots: Vec<f64> = errors.iter().map(|e| e.cbrt()).collect();
        let n = roots.len();
        let total: f64 = (0..n).map(|k| width(k) * roots[k]).sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let length = old[n] - old[0];
        let mean = total / length;
        // Sizes for as many cells as the old grid has, then cells next to small ones shrunk.
        let unit = length * (1.0 + FLOOR) / n as f64;
        let least = |k: usize| {
            let middle = 0.5 * (old[k] + old[k + 1]);
            let cut = |[from, to]: &[f64; 2]| (*from..*to).contains(&middle);
            if slanted.iter().any(cut) {
                SLANTED
            } else {
                FLOOR
            }
        };
        let mut size: Vec<f64> = (0..n)
            .map(|k| unit / (roots[k] / mean + least(k)))
            .collect();
        let apart = |k: usize| 0.5 * (width(k) + width(k + 1));
        for k in 0..n - 1 {
            size[k + 1] = size[k + 1].min(size[k] + GROWTH * apart(k));
        }
        for k in (0..n - 1).rev() {
            size[k] = size[k].min(size[k + 1] + GROWTH * apart(k));
        }
        let mut cumulated = vec![0.0; n + 1];
        for k in 0..n {
            cumulated[k + 1] = cumulated[k] + width(k) / size[k];
        }
        Some(Self {
            old,
            cumulated,
            total,
        })
    }

    /// About `count` cells through all `edges`.
    fn lines(&self, edges: &[f64], count: f64) -> Option<Lines> {
        let number = |x: f64| interpolate(self.old, &self.cumulated, x);
        let mut shares: Vec<f64> = edges
            .windows(2)
            .map(|w| number(w[1]) - number(w[0]))
            .collect();
        // A surface that is its own mirror image gets a grid that is one, to the last bit.
        let last = edges[edges.len() - 1];
        let mirrored = edges
            .iter()
            .zip(edges.iter().rev())
            .all(|(a, b)| (a + b - last).abs() < 1e-9 * last);
        if mirrored {
            let reversed: Vec<f64> = shares.iter().rev().copied().collect();
            for (share, other) in shares.iter_mut().zip(reversed) {
                *share = 0.5 * (*share + other);
            }
        }
        let counts = |unit: f64| {
            shares
                .iter()
                .map(move |s| ((s / unit).round() as usize).max(1))
        };
        let all = self.cumulated[self.cumulated.len() - 1];
        let (mut coarse, mut fine) = (all, 1e-6 * all);
        for _ in 0..60 {
            let unit = (coarse * fine).sqrt();
            if (counts(unit).sum::<usize>() as f64) < count {
                coarse = unit;
            } else {
                fine = unit;
            }
        }
        let mut out = vec![edges[0]];
        for (w, n) in edges.windows(2).zip(counts(fine)) {
            let (from, to) = (number(w[0]), number(w[1]));
            for k in 1..n {
                let at = from + (to - from) * (k as f64 / n as f64);
                out.push(interpolate(&self.cumulated, self.old, at));
            }
            out.push(w[1]);
        }
        if mirrored {
            let reversed: Vec<f64> = out.iter().rev().map(|x| last - x).collect();
            for (x, other) in out.iter_mut().zip(reversed) {
                *x = 0.5 * (*x + other);
            }
        }
        Lines::new(out)
    }
}

/// Piecewise linear y(x) through rising points, continued at the ends.
fn interpolate(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let k = xs.partition_point(|v| *v <= x).clamp(1, xs.len() - 1);
    ys[k - 1] + (x - xs[k - 1]) * (ys[k] - ys[k - 1]) / (xs[k] - xs[k - 1])
}
