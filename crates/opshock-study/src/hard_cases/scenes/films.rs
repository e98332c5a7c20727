//! Films of plane sliders in the dimensionless numbers of the lubrication literature.

use opshock_solver::air_bearing::steady::{QuasiStaticFilm, fixed_attitude};
use opshock_solver::air_bearing::{Attitude, Film, FlowModel};
use opshock_solver::gas::GasParameters;
use opshock_solver::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};

/// Length of every plane slider here, m.
pub const LENGTH_M: f64 = 1e-3;
/// Trailing height, m.
pub const TRAILING_M: f64 = 1e-7;
/// Ambient pressure, Pa.
pub const AMBIENT_PA: f64 = 1e5;
/// Viscosity, Pa s.
pub const VISCOSITY_PA_S: f64 = 1.8e-5;

/// A plane slider: heights in units of the trailing height, lengths in units of its length.
#[derive(Clone, Debug)]
pub struct PlaneSlider {
    /// Leading over trailing height.
    pub ratio: f64,
    /// Λ = 6 μ U L/(p_a h_t²).
    pub bearing_number: f64,
    /// Kn = λ_a/h_t.
    pub knudsen: f64,
    /// Rarefaction model.
    pub model: FlowModel,
    /// Width over length.
    pub width: f64,
    /// Direction of the disk's velocity, rad.
    pub skew_rad: f64,
    /// Recessed rectangles: x range, y range, depth.
    pub recesses: Vec<([f64; 2], [f64; 2], f64)>,
}

impl PlaneSlider {
    /// Square slider with the given numbers.
    pub fn square(model: FlowModel, ratio: f64, bearing_number: f64, knudsen: f64) -> Self {
        Self {
            ratio,
            bearing_number,
            knudsen,
            model,
            width: 1.0,
            skew_rad: 0.0,
            recesses: Vec::new(),
        }
    }

    /// So wide that its sides do not matter: the flow across them is 1e-12 of that along it.
    pub fn wide(model: FlowModel, ratio: f64, bearing_number: f64, knudsen: f64) -> Self {
        Self {
            width: 5e6,
            ..Self::square(model, ratio, bearing_number, knudsen)
        }
    }

    /// Steady film of a [`PlaneSlider::wide`] slider: load and centre of the middle row of five,
    /// whose neighbours carry the same pressure.
    ///
    /// # Panics
    ///
    /// When the steady state is not found.
    pub fn hold_row(&self, x: &[f64]) -> Held {
        let mut held = self.hold(x, &uniform(5, self.width));
        let n = x.len() - 1;
        let mut forces = vec![0.0; held.film.n_cells()];
        let scratch = &mut held.film.scratch();
        held.film
            .cell_forces(&held.psi, &self.attitude(), &mut forces, scratch);
        let row = |i: usize| forces[held.film.cell_index(i, 2)];
        let total: f64 = (0..n).map(row).sum();
        let moment: f64 = (0..n).map(|i| row(i) * 0.5 * (x[i] + x[i + 1])).sum();
        let area = 0.2 * self.width * LENGTH_M * LENGTH_M;
        held.load = total / (AMBIENT_PA * area);
        held.centre = moment / total;
        held.pressure = (0..n)
            .map(|i| held.pressure[held.film.cell_index(i, 2)])
            .collect();
        held
    }

    /// Slider's parameters.
    pub fn slider(&self) -> SliderParameters {
        SliderParameters {
            radius_m: 1.0,
            angle_rad: 0.0,
            skew_rad: self.skew_rad,
            length_m: LENGTH_M,
            width_m: self.width * LENGTH_M,
            height_m: LENGTH_M,
            density_kg_per_m3: 1000.0,
            surface: SurfaceParameters {
                rails: self
                    .recesses
                    .iter()
                    .map(|(x, y, depth)| Rail {
                        outline: RailOutline::Rectangle {
                            x_m: x.map(|v| v * LENGTH_M),
                            y_m: y.map(|v| v * LENGTH_M),
                        },
                        recess_m: depth * TRAILING_M,
                    })
                    .collect(),
                ..SurfaceParameters::default()
            },
        }
    }

    /// Film on lines given in units of the length.
    ///
    /// # Panics
    ///
    /// When the lines do not span the slider.
    pub fn film(&self, x: &[f64], y: &[f64]) -> Film {
        let gas = GasParameters {
            pressure_pa: AMBIENT_PA,
            viscosity_pa_s: VISCOSITY_PA_S,
            mean_free_path_m: (self.knudsen * TRAILING_M).max(1e-15),
        };
        let speed = self.bearing_number * AMBIENT_PA * TRAILING_M * TRAILING_M
            / (6.0 * VISCOSITY_PA_S * LENGTH_M);
        let scaled = |lines: &[f64]| lines.iter().map(|v| v * LENGTH_M).collect::<Vec<_>>();
        Film::on_grid(
            &self.slider(),
            &gas,
            self.model,
            speed,
            1e-3 * TRAILING_M,
            [&scaled(x), &scaled(y)],
        )
        .expect("lines span the slider")
    }

    /// Attitude with the trailing edge at its height.
    pub fn attitude(&self) -> Attitude {
        Attitude {
            centre_height_m: 0.5 * (1.0 + self.ratio) * TRAILING_M,
            pitch_rad: (self.ratio - 1.0) * TRAILING_M / LENGTH_M,
            roll_rad: 0.0,
        }
    }

    /// Steady film on given lines, with load W/(p_a A) and the centre of pressure from the leading
    /// edge in lengths.
    ///
    /// # Panics
    ///
    /// When the steady state is not found.
    pub fn hold(&self, x: &[f64], y: &[f64]) -> Held {
        let film = self.film(x, y);
        let attitude = self.attitude();
        let held = fixed_attitude(&film, &attitude).expect("steady film");
        let area = self.width * LENGTH_M * LENGTH_M;
        let mut pressure = vec![0.0; film.n_cells()];
        film.pressure(&held.psi, &attitude, &mut pressure);
        let QuasiStaticFilm { force, psi, .. } = held;
        Held {
            load: force[0] / (AMBIENT_PA * area),
            centre: 0.5 - force[1] / (force[0] * LENGTH_M),
            roll_centre: force[2] / (force[0] * LENGTH_M),
            pressure: pressure.iter().map(|p| p / AMBIENT_PA).collect(),
            psi,
            film,
        }
    }
}

/// A steady film in numbers without units.
#[derive(Clone, Debug)]
pub struct Held {
    /// W/(p_a A).
    pub load: f64,
    /// Centre of pressure from the leading edge, in lengths.
    pub centre: f64,
    /// Centre of pressure from the middle towards the outer side, in lengths.
    pub roll_centre: f64,
    /// p/p_a per cell.
    pub pressure: Vec<f64>,
    /// ψ per cell, Pa m.
    pub psi: Vec<f64>,
    /// The film.
    pub film: Film,
}

/// `n` equal cells from 0 to `to`.
pub fn uniform(n: usize, to: f64) -> Vec<f64> {
    (0..=n).map(|k| to * k as f64 / n as f64).collect()
}

/// `n` cells from 0 to 1 crowding at 1: 1 − (e^(b (1 − s)) − 1)/(e^b − 1).
pub fn crowded(n: usize, b: f64) -> Vec<f64> {
    (0..=n)
        .map(|k| {
            let s = k as f64 / n as f64;
            1.0 - ((b * (1.0 - s)).exp() - 1.0) / (b.exp() - 1.0)
        })
        .collect()
}

/// `n` cells from 0 to 1 crowding at both ends.
pub fn crowded_twice(n: usize) -> Vec<f64> {
    (0..=n)
        .map(|k| 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / n as f64).cos())
        .collect()
}

/// Model by the name the reference data use.
///
/// # Panics
///
/// For another name.
pub fn model(name: &str) -> FlowModel {
    match name {
        "continuum" => FlowModel::Continuum,
        "first_order_slip" => FlowModel::Slip1,
        "FK" => FlowModel::FukuiKaneko,
        _ => panic!("no flow model {name}"),
    }
}
