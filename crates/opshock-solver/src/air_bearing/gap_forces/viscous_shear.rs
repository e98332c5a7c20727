//! Viscous shear of the film on the slider, and the pitch and roll moments of its couple with the suspension.
//!
//! ```text
//! u(z) = U (h + λ − z)/(h + 2 λ) − ∇p (z (h − z) + λ h)/(2 μ)        slip at both walls, z from the disk
//! τ = −μ du/dz (h) = μ U/(h + 2 λ) − (h/2) ∇p                        on the slider
//! M_pitch = −T ∬ τ_x dA,   M_roll = T ∬ τ_y dA
//! ```
//!
//! The first part is Couette flow with first-order slip at both walls. With λ = λ_a p_a/p, h + 2 λ = h (1 + 2 λ_a
//! p_a/ψ). This is right in both limits: μ U/h of a continuum and p U/√(2π R T) of free molecules. All rarefied models
//! of the flow factor use it; the continuum has λ = 0. The second part is Poiseuille flow: its profile is symmetric for
//! any slip, so either wall takes half of h ∇p.
//!
//! The slider does not accelerate in the disk's plane: the suspension holds it at the dimple, on the slider's back, by
//! the opposite force. Both make a couple with the slider's height T as its arm. Turning by pitch (leading edge up)
//! and roll (outer side up) moves a point z over the dimple by (z pitch, −z roll) in the plane; the surface, at
//! z = −T, does the work −T F_x pitch + T F_y roll. Drag towards the trailing edge presses the leading edge down.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | μ | `viscosity_pa_s` | Pa s |
//! | U | `disk_velocity_m_per_s` | m/s |
//! | λ_a p_a | `slip_pa_m` (0: no slip) | Pa m |
//! | T | `arm_m` | m |
//!
//! On the grid the first part is taken at the cells' centres. In the second the height of a half cell is that of its
//! face. A smooth face between cells of the pressures p₀ and p₁ then gives −h (p₁ − p₀)/2 for any face pressure, and
//! the sum is exactly ½ ∬ (p − p_a) ∇h dA. At an etched step the face pressure is that of the fluxes
//! ([`super::super::flux`]). Heights are those the film sees, with the minimum film height.
//!
//! Source: Burgdorfer, J. Basic Engineering 81 (1959) 94 (slip at both walls); Hamrock, Fundamentals of Fluid Film
//! Lubrication (1994), ch. 7 and 9 (shear on either wall). Neglected: the pressure on slopes and on walls of recesses,
//! whose force in the plane, −∬ (p − p_a) ∇h dA, is −2 times the second part above (0.14 mN beside a drag of 0.35 mN of
//! the default drive) and would make the whole the reverse of the force on the disk; the slider's own motion, except
//! through the pressure; the suspension's compliance in the plane.

use crate::air_bearing::film::{CellStates, Element, Film};
use crate::air_bearing::flow_factor::FlowModel;
use crate::air_bearing::flux::{HalfCell, HalfPartials};
use crate::air_bearing::gap_force::GapForce;
use crate::air_bearing::gap_load::GapLoad;
use crate::air_bearing::mesh::{Place, Side};
use crate::slider::SliderParameters;
use std::sync::Arc;

/// Whether the film's shear acts on the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct ViscousShear {
    /// It does.
    pub is_on: bool,
}

impl GapForce for ViscousShear {
    fn name(&self) -> &'static str {
        "head.viscous_shear"
    }

    fn is_active(&self) -> bool {
        self.is_on
    }

    fn over(&self, film: &Film, slider: &SliderParameters) -> Arc<dyn Element> {
        let gas = film.gas();
        Arc::new(Shear {
            viscosity_pa_s: gas.viscosity_pa_s,
            slip_pa_m: match film.flow_model() {
                FlowModel::Continuum => 0.0,
                FlowModel::Slip1 | FlowModel::Slip2 | FlowModel::FukuiKaneko => {
                    gas.mean_free_path_m * gas.pressure_pa
                }
            },
            disk_velocity_m_per_s: film.disk_velocity_m_per_s(),
            track: [slider.skew_rad.cos(), slider.skew_rad.sin()],
            arm_m: slider.height_m,
        })
    }
}

/// The shear over one film.
#[derive(Clone, Debug)]
struct Shear {
    viscosity_pa_s: f64,
    slip_pa_m: f64,
    disk_velocity_m_per_s: [f64; 2],
    /// Direction of the disk's motion.
    track: [f64; 2],
    arm_m: f64,
}

impl Element for Shear {
    fn force(&self, film: &Film, cells: &CellStates<'_>) -> [f64; 3] {
        let mut nothing = [const { Vec::new() }; 3];
        self.summed::<false>(film, cells, &mut nothing).load().force
    }

    fn load(&self, film: &Film, cells: &CellStates<'_>, by_psi: &mut [Vec<f64>; 3]) -> GapLoad {
        self.summed::<true>(film, cells, by_psi).load()
    }
}

impl Shear {
    /// Both parts over all cells, with derivatives where `SLOPES` holds.
    fn summed<'a, const SLOPES: bool>(
        &self,
        film: &Film,
        cells: &CellStates<'_>,
        by_psi: &'a mut [Vec<f64>; 3],
    ) -> Sum<'a, SLOPES> {
        let mut sum = Sum {
            in_plane: [0.0; 2],
            by_attitude: [[0.0; 3]; 2],
            by_psi,
            arms: [-self.arm_m, self.arm_m],
            track: self.track,
        };
        self.couette(film, cells, &mut sum);
        between_cells(film, cells, &mut sum);
        on_edges(film, cells, &mut sum);
        sum
    }

    /// μ U ψ/(h (ψ + 2 λ_a p_a)) over every cell.
    fn couette<const SLOPES: bool>(
        &self,
        film: &Film,
        cells: &CellStates<'_>,
        sum: &mut Sum<'_, SLOPES>,
    ) {
        for (k, cell) in film.mesh.cells.iter().enumerate() {
            let (psi, inverse_h) = (cells.psi[k], cells.inverse_h[k]);
            let with_slip = 1.0 / (psi + 2.0 * self.slip_pa_m);
            let per_velocity = self.viscosity_pa_s * cell.area * inverse_h * with_slip;
            let by_psi = per_velocity * (2.0 * self.slip_pa_m * with_slip);
            let by_height = -per_velocity * psi * inverse_h * cells.h_slope[k];
            for (d, velocity) in self.disk_velocity_m_per_s.into_iter().enumerate() {
                sum.add(d, velocity * per_velocity * psi);
                sum.add_by_psi(d, k, velocity * by_psi);
                sum.add_by_height(d, &cell.place, velocity * by_height);
            }
        }
    }
}

/// −(h/2) ∇p at the faces between cells.
fn between_cells<const SLOPES: bool>(
    film: &Film,
    cells: &CellStates<'_>,
    sum: &mut Sum<'_, SLOPES>,
) {
    let [nx, ny] = film.mesh.counts();
    let n_across_x = (nx - 1) * ny;
    for (k, face) in film.mesh.faces.iter().enumerate() {
        let d = usize::from(k >= n_across_x);
        let [low, high] = &face.sides;
        let base = face.place.height(cells.attitude);
        let half = -0.5 * face.length;
        if face.is_smooth() {
            let (h, h_slope) = film.limited(base + low.recess);
            let rise = cells.pressure(high.cell) - cells.pressure(low.cell);
            sum.add(d, half * h * rise);
            sum.add_by_height(d, &face.place, half * rise * h_slope);
            sum.add_by_pressure(d, (film, cells), low.cell, -half * h);
            sum.add_by_pressure(d, (film, cells), high.cell, half * h);
        } else {
            let step = Step::new(film, cells, [low, high], base);
            let [h_low, h_high] = step.halves.map(|side| side.h_face);
            let [p_low, p_high] = [low, high].map(|side| cells.pressure(side.cell));
            let p = step.pressure;
            sum.add(d, half * (h_low * (p - p_low) + h_high * (p_high - p)));
            if SLOPES {
                sum.add_by_pressure(d, (film, cells), low.cell, -half * h_low);
                sum.add_by_pressure(d, (film, cells), high.cell, half * h_high);
                let by_height = [half * (p - p_low), half * (p_high - p)];
                let by = (by_height, half * (h_low - h_high));
                step.add_slopes(d, (film, cells), &face.place, by, sum);
            }
        }
    }
}

/// −(h/2) ∇p in the half cells at the slider's edges, where the ambient pressure stands.
fn on_edges<const SLOPES: bool>(film: &Film, cells: &CellStates<'_>, sum: &mut Sum<'_, SLOPES>) {
    let [_, ny] = film.mesh.counts();
    for (k, face) in film.mesh.edge_faces.iter().enumerate() {
        let d = usize::from(k >= 2 * ny);
        let outwards = [face.place.x, face.place.y][d].signum();
        let half = -0.5 * outwards * face.length;
        let (h, h_slope) = film.limited(face.place.height(cells.attitude) + face.side.recess);
        let rise = film.ambient_pa() - cells.pressure(face.side.cell);
        sum.add(d, half * h * rise);
        sum.add_by_height(d, &face.place, half * rise * h_slope);
        sum.add_by_pressure(d, (film, cells), face.side.cell, -half * h);
    }
}

/// A face on an etched step, the pressure on it that of the fluxes.
struct Step<'a> {
    sides: [&'a Side; 2],
    halves: [HalfCell; 2],
    /// Derivatives of their G by ψ across the face.
    by_across: [f64; 2],
    pressure: f64,
    /// 1/(β + β).
    inverse_beta: f64,
    /// Derivatives of the heights the film sees on either side by the true one.
    h_slopes: [f64; 2],
}

impl<'a> Step<'a> {
    /// Between `sides` where the true height without recess is `base`.
    fn new(film: &Film, cells: &CellStates<'_>, sides: [&'a Side; 2], base: f64) -> Self {
        let [(up, up_by), (down, down_by)] = [sides, [sides[1], sides[0]]].map(|[side, other]| {
            let heights = [cells.h[side.cell], base];
            let across = cells.pressure(other.cell) * cells.h[side.cell];
            film.half_cell(side, cells.psi, heights, across)
        });
        let halves = [up, down];
        let [(a, b), (c, e)] = halves.map(|half| half.coefficients());
        let inverse_beta = 1.0 / (b + e);
        Self {
            sides,
            halves,
            by_across: [up_by, down_by],
            pressure: (a + c) * inverse_beta,
            inverse_beta,
            h_slopes: sides.map(|side| film.limited(base + side.recess).1),
        }
    }

    /// Derivatives of what changes by `by_height` with the heights at this face, at `place`, and by `by_pressure`
    /// with the pressure on it.
    fn add_slopes<const SLOPES: bool>(
        &self,
        d: usize,
        (film, cells): (&Film, &CellStates<'_>),
        place: &Place,
        (by_height, by_pressure): ([f64; 2], f64),
        sum: &mut Sum<'_, SLOPES>,
    ) {
        for (i, side) in self.sides.into_iter().enumerate() {
            let partials = partials(&self.halves[i], self.pressure);
            let by_flux = by_pressure * self.inverse_beta;
            let [psi, psi_behind, h_centre, h_face] = partials.flux.map(|slope| by_flux * slope);
            let other = self.sides[1 - i].cell;
            let by_across = by_flux * partials.by_g[0] * self.by_across[i];
            sum.add_by_pressure(d, (film, cells), other, by_across * cells.h[side.cell]);
            sum.add_by_psi(d, side.cell, psi);
            sum.add_by_psi(d, side.behind, psi_behind);
            let centre = &film.mesh.cells[side.cell].place;
            let h_centre = h_centre + by_across * cells.pressure(other);
            sum.add_by_height(d, centre, h_centre * cells.h_slope[side.cell]);
            sum.add_by_height(d, place, (h_face + by_height[i]) * self.h_slopes[i]);
        }
    }
}

/// Derivatives of a half cell's flux at the face pressure `p`, whatever the wind.
fn partials(half: &HalfCell, p: f64) -> HalfPartials {
    if half.wind == 0.0 {
        return half.still_partials(p);
    }
    let mean = half.logarithmic_mean::<true>();
    match half.wind > 0.0 {
        true => half.partials::<true>(&mean, &half.flux::<true>(&mean), p),
        false => half.partials::<false>(&mean, &half.flux::<false>(&mean), p),
    }
}

/// Force in the plane along x and y, with derivatives where `SLOPES` holds.
struct Sum<'a, const SLOPES: bool> {
    in_plane: [f64; 2],
    by_attitude: [[f64; 3]; 2],
    /// Of [F_z, M_pitch, M_roll] by the ψ of every cell.
    by_psi: &'a mut [Vec<f64>; 3],
    /// Moments of pitch and roll by the force along x and y.
    arms: [f64; 2],
    track: [f64; 2],
}

impl<const SLOPES: bool> Sum<'_, SLOPES> {
    fn add(&mut self, d: usize, force: f64) {
        self.in_plane[d] += force;
    }

    fn add_by_psi(&mut self, d: usize, cell: usize, slope: f64) {
        if SLOPES {
            self.by_psi[1 + d][cell] += self.arms[d] * slope;
        }
    }

    /// By the true height at `place`.
    fn add_by_height(&mut self, d: usize, place: &Place, slope: f64) {
        if SLOPES {
            let [by_height, by_pitch, by_roll] = &mut self.by_attitude[d];
            *by_height += slope;
            *by_pitch -= slope * place.x;
            *by_roll += slope * place.y;
        }
    }

    /// By the pressure ψ/h at a cell's centre.
    fn add_by_pressure(
        &mut self,
        d: usize,
        (film, cells): (&Film, &CellStates<'_>),
        cell: usize,
        slope: f64,
    ) {
        if SLOPES {
            let per_psi = slope * cells.inverse_h[cell];
            self.add_by_psi(d, cell, per_psi);
            let per_height = -per_psi * cells.pressure(cell) * cells.h_slope[cell];
            self.add_by_height(d, &film.mesh.cells[cell].place, per_height);
        }
    }

    fn load(self) -> GapLoad {
        let ([x, y], [cos, sin], [pitch, roll]) = (self.in_plane, self.track, self.arms);
        let [by_x, by_y] = self.by_attitude;
        GapLoad {
            force: [0.0, pitch * x, roll * y],
            by_attitude: [
                [0.0; 3],
                by_x.map(|by| pitch * by),
                by_y.map(|by| roll * by),
            ],
            in_plane_n: Some([x * cos + y * sin, y * cos - x * sin]),
        }
    }
}
