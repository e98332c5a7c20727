//! Storage matrix M of the film: how the rate of ψ = p h in each cell enters the mass balance of its neighbours.
//!
//! ```text
//! M dψ/dt + R(ψ, attitude) = 0
//! ```
//!
//! A cell stores 12 μ A ψ. Fluxes with the wind continue ψ to the face by a straight line ([`super::flux`]), which
//! makes waves lag: what travels at u = w/(12 μ) = U/2 is carried as
//!
//! ```text
//! dψ/dt = −u (1 − Δ²/3 ∂xx + Δ³/4 ∂xxx) ∂x ψ + ...
//! ```
//!
//! on cells of the width Δ. The same operator on dψ/dt removes the lag: M = 12 μ A (1 − Δ²/3 ∂xx + Δ³/4 ∂xxx). Waves
//! along x, and no others, then travel correctly to the third order of Δ. Steady states do not change. (Principle: Lele
//! 1992, J. Comput. Phys. 103, 16.) The operator is the flux of a second share of the storage through the faces along x,
//! so that mass is conserved:
//!
//! ```text
//! −ω K (s_d/4 + 3 s_b/4),   K = 12 μ L Δ_c (Δ_b + Δ_c)(Δ_b + 2 Δ_c + Δ_d)/(8 (Δ_b + Δ_c + Δ_d)),
//! ```
//!
//! with the slopes s of dψ/dt: s_b from the cell behind to the cell c that the wind leaves, and s_d from c to the next
//! cell d. K/u is the distance of the straight line's end from the parabola through three means for ∂xx ψ =
//! −∂x(dψ/dt)/u. The weight ω is that of the straight line ([`super::flux`]) at ambient pressure in the usual attitude.
//! It is a constant of the grid, near 1 under a pad and 0 where the gas diffuses. Before a step only s_b enters. Behind
//! a step no straight line is drawn and nothing is corrected. Where cell sizes differ by more than a layout allows (a
//! third), the correction is reduced: every column of M keeps most on its diagonal, as factors without pivoting need.
//!
//! With 1000 cells under the slider of Fig. 13 the impedance's error falls from 8.0 to 3.6 % at 60 kHz and from 1.9 to
//! 0.4 % at 25 kHz; with 4000 cells from 4.1 to 0.9 % and from 0.6 to 0.2 % (docs/accuracy.md).

use super::film::Film;
use super::mesh::Face;
use crate::gas::GasParameters;
use crate::linalg::diagonals::Diagonals;

/// Pe below which ω is zero.
const SMALLEST_PE: f64 = 1e-3;

/// Most by which a face's flux may depend on the cell behind and on the next, as a share of the smaller of both cells
/// there; 1/4 and 1/12 on a uniform grid.
const MOST_FROM_BEHIND: f64 = 1.0 / 2.0;
const MOST_TO_NEXT: f64 = 1.0 / 4.0;

/// 12 μ, Pa s: what a cell stores by its area and ψ.
pub(super) fn per_area(gas: &GasParameters) -> f64 {
    12.0 * gas.viscosity_pa_s
}

/// M of `film`, Pa s m2.
pub(super) fn storage(film: &Film) -> Diagonals {
    let (mesh, capacity) = (&film.mesh, film.capacity());
    let psi = film.ambient(&film.usual_attitude());
    let per_area = per_area(film.gas());
    let [nx, ny] = mesh.counts();
    let along_x = &mesh.faces[..(nx - 1) * ny];
    let wind = along_x.first().map_or(0.0, |face| face.sides[0].wind);
    let stride = ny.cast_signed();
    let offsets = match wind {
        0.0 => vec![0],
        wind if wind > 0.0 => vec![-2 * stride, -stride, 0, stride],
        _ => vec![-stride, 0, stride, 2 * stride],
    };
    let mut matrix = Diagonals::zeros(capacity.len(), offsets);
    let own = matrix.column_mut(0).expect("made for it");
    own.copy_from_slice(capacity);
    if wind == 0.0 {
        return matrix;
    }
    for face in along_x {
        let carried = through(film, face, &psi);
        let [up, down] = upwind_first(face).map(|side| side.cell);
        for (cell, share) in carried {
            let share = per_area * face.length * share;
            if share != 0.0 {
                matrix.add(up, cell, share);
                matrix.add(down, cell, -share);
            }
        }
    }
    matrix
}

fn upwind_first(face: &Face) -> [super::mesh::Side; 2] {
    let [left, right] = face.sides;
    match left.wind > 0.0 {
        true => [left, right],
        false => [right, left],
    }
}

/// The cells whose dψ/dt the storage's flux through a face depends on, with the weights, m.
fn through(film: &Film, face: &Face, psi: &[f64]) -> [(usize, f64); 3] {
    let [up, down] = upwind_first(face);
    let (behind, centre, next) = (up.behind, up.cell, down.cell);
    if up.reach == 0.0 {
        return [(behind, 0.0), (centre, 0.0), (next, 0.0)];
    }
    let width = |cell: usize| film.mesh.lines[0].width(film.mesh.place_of(cell)[0]);
    let (b, c) = (width(behind), width(centre));
    let is_smooth = face.is_smooth();
    let d = if is_smooth { width(next) } else { c };
    let k = c * (b + c) * (b + 2.0 * c + d) / (8.0 * (b + c + d));
    let [from_behind, to_next] = if is_smooth { [0.75, 0.25] } else { [1.0, 0.0] };
    let from_behind = k * from_behind * 2.0 / (b + c);
    let to_next = k * to_next * 2.0 / (c + d);
    let most = f64::min(
        MOST_FROM_BEHIND * b.min(c) / from_behind,
        MOST_TO_NEXT * c.min(d) / to_next,
    );
    let share = straight_share(film, face, psi) * most.min(1.0);
    let (from_behind, to_next) = (share * from_behind, share * to_next);
    [
        (behind, from_behind),
        (centre, to_next - from_behind),
        (next, -to_next),
    ]
}

/// ω at ambient pressure in the usual attitude.
fn straight_share(film: &Film, face: &Face, psi: &[f64]) -> f64 {
    let [up, _] = upwind_first(face);
    let attitude = film.usual_attitude();
    let h_centre = film.cell_height(&film.mesh.cells[up.cell], &attitude).0;
    let heights = [h_centre, face.place.height(&attitude)];
    let (half, _) = film.half_cell(&up, psi, heights, psi[up.cell]);
    let drive = half.drive(&half.logarithmic_mean::<true>());
    if drive.pe.abs() < SMALLEST_PE {
        return 0.0;
    }
    (1.0 - drive.pe / drive.pe.sinh()) * drive.blow / drive.pe
}
