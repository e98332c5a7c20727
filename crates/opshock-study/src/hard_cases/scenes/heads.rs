//! Heads for tests without structure solver: default slider, film and flight, and disks that move by a formula.

use std::sync::Arc;

use opshock_solver::air_bearing::gap_forces::AsperityContact;
use opshock_solver::air_bearing::steady::{Flight, fly};
use opshock_solver::air_bearing::{Attitude, Film, FilmResolution, FlowModel, GapForce, GapLoad};
use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::gas::GasParameters;
use opshock_solver::head::{Coupling, HeadModel, HeadResolution};
use opshock_solver::quantity::rad_per_s_from_rpm;
use opshock_solver::scene::Scene;
use opshock_solver::slider::{RailOutline, SliderParameters};
use opshock_solver::suspension::SuspensionParameters;

use super::suspensions::default_suspension;

/// The slider of the default drive, at angle 0. Coordinates of its rails are whole micrometres times 1e-6, to the bit of
/// the committed digests.
pub fn default_slider() -> SliderParameters {
    let mut slider = Scene::default_drive().slider;
    slider.angle_rad = 0.0;
    for rail in &mut slider.surface.rails {
        if let RailOutline::Rectangle { x_m, y_m } = &mut rail.outline {
            for side in x_m.iter_mut().chain(y_m) {
                *side = (*side * 1e6).round() * 1e-6;
            }
        }
    }
    slider
}

/// Air at one atmosphere as the reference numbers use it.
pub fn standard_gas() -> GasParameters {
    Scene::default_drive().gas
}

/// Film of a slider over a disk at a speed.
///
/// # Panics
/// When it has none.
pub fn film_of(slider: &SliderParameters, spin_rad_per_s: f64, cells: usize) -> Film {
    let resolution = FilmResolution {
        cells,
        min_height_m: 0.3e-9,
        correction_cells: 0,
    };
    let (gas, flow) = (standard_gas(), FlowModel::FukuiKaneko);
    Film::build(slider, &gas, flow, spin_rad_per_s, &resolution).expect("film builds")
}

/// Film on `n` x `n` equal cells under a slider, with a force beside the air's pressure.
///
/// # Panics
/// When it has none.
pub fn even_film(slider: &SliderParameters, n: usize, force: &dyn GapForce) -> Film {
    let [x, y] = [slider.length_m, slider.width_m]
        .map(|extent_m| -> Vec<f64> { (0..=n).map(|k| extent_m * k as f64 / n as f64).collect() });
    let spin = rad_per_s_from_rpm(5400.0);
    let (gas, flow) = (standard_gas(), FlowModel::FukuiKaneko);
    let film = Film::on_grid(slider, &gas, flow, spin, 0.3e-9, [&x, &y]);
    film.expect("film builds").with_gap_force(slider, force)
}

/// What that force does at an attitude, at ambient pressure.
pub fn gap_load(film: &Film, attitude: &Attitude) -> GapLoad {
    let mut psi = vec![0.0; film.n_cells()];
    film.ambient_psi(attitude, &mut psi);
    film.gap_loads(&psi, attitude, &mut film.scratch())[0].1
}

/// Film of the default slider with about `cells` cells and its flight under the gram load.
pub fn default_film(cells: usize) -> (Arc<Film>, Arc<Flight>) {
    flying(film_of(
        &default_slider(),
        rad_per_s_from_rpm(5400.0),
        cells,
    ))
}

/// The same between rough surfaces.
pub fn rough_film(cells: usize, rough: &AsperityContact) -> (Arc<Film>, Arc<Flight>) {
    let slider = default_slider();
    let film = film_of(&slider, rad_per_s_from_rpm(5400.0), cells);
    flying(film.with_gap_force(&slider, rough))
}

fn flying(film: Film) -> (Arc<Film>, Arc<Flight>) {
    let flight = fly(&film, [default_suspension().gram_load_n, 0.0, 0.0]).expect("flies");
    (Arc::new(film), Arc::new(flight))
}

/// Resolution that tests start from.
pub fn default_resolution() -> HeadResolution {
    HeadResolution {
        tolerance: 1e-3,
        approach_share: 0.3,
        suspension_modes: 4,
        coupling: Coupling::Monolithic,
        coupling_tolerance: 1e-4,
        max_steps: 200_000,
    }
}

/// Default head on a film of about `cells` cells.
pub fn default_head(cells: usize, resolution: &HeadResolution) -> HeadModel {
    let (film, flight) = default_film(cells);
    head_on(&film, &flight, resolution)
}

/// Default head on an existing film.
pub fn head_on(film: &Arc<Film>, flight: &Arc<Flight>, resolution: &HeadResolution) -> HeadModel {
    suspended_by(&default_suspension(), film, flight, resolution)
}

/// The same on another suspension.
pub fn suspended_by(
    suspension: &SuspensionParameters,
    film: &Arc<Film>,
    flight: &Arc<Flight>,
    resolution: &HeadResolution,
) -> HeadModel {
    HeadModel::build(
        suspension,
        &default_slider(),
        Arc::clone(film),
        Arc::clone(flight),
        resolution,
        0.0,
    )
    .expect("head builds")
}

/// A disk that does not move.
pub struct StillDisk;

impl DiskMotion for StillDisk {
    fn pose(&self, _: f64) -> DiskPose {
        DiskPose::default()
    }
    fn pose_rate(&self, _: f64) -> DiskPose {
        DiskPose::default()
    }
    fn events_s(&self) -> &[f64] {
        &[]
    }
}

/// A disk that starts to move at a constant velocity at time 0.
pub struct SuddenDisk {
    /// Velocity towards the slider, m/s.
    pub velocity_m_per_s: f64,
}

impl DiskMotion for SuddenDisk {
    fn pose(&self, t: f64) -> DiskPose {
        DiskPose {
            displacement_m: self.velocity_m_per_s * t.max(0.0),
            ..DiskPose::default()
        }
    }
    fn pose_rate(&self, _: f64) -> DiskPose {
        DiskPose {
            displacement_m: self.velocity_m_per_s,
            ..DiskPose::default()
        }
    }
    fn events_s(&self) -> &[f64] {
        &[]
    }
}

/// One mode of the disk under a half-sine: w'' + 2 ζ ω w' + ω² w = Γ A sin(π t/T), and slopes in proportion, dw/dy =
/// k_r w. The substitute for a disk with which the reference head was tested.
pub struct SingleModeDisk {
    omega: f64,
    zeta: f64,
    pulse_rate: f64,
    width_s: f64,
    /// In-phase and quadrature amplitudes of the forced motion.
    forced: [f64; 2],
    /// Homogeneous solution: in the pulse, after it.
    free: [[f64; 2]; 2],
    roll_per_m: f64,
    events_s: Vec<f64>,
}

impl SingleModeDisk {
    /// 1150 Hz, ratio 0.0075, participation 0.64, slope 130 rad per metre of displacement.
    pub fn new(amplitude_m_per_s2: f64, width_s: f64) -> Self {
        let (omega, zeta, load) = (
            1150.0 * std::f64::consts::TAU,
            0.0075,
            0.64 * amplitude_m_per_s2,
        );
        let pulse_rate = std::f64::consts::PI / width_s;
        // (ω² − p²) s + 2 ζ ω p c: response s sin pt + c cos pt to sin pt.
        let (real, imaginary) = (
            omega * omega - pulse_rate * pulse_rate,
            2.0 * zeta * omega * pulse_rate,
        );
        let square = real * real + imaginary * imaginary;
        let forced = [load * real / square, -load * imaginary / square];
        let mut disk = Self {
            omega,
            zeta,
            pulse_rate,
            width_s,
            forced,
            free: [[0.0; 2]; 2],
            roll_per_m: 130.0,
            events_s: vec![width_s],
        };
        disk.free[0] = disk.free_from([-forced[1], -forced[0] * pulse_rate]);
        let end = disk.in_pulse(width_s);
        disk.free[1] = disk.free_from(end);
        disk
    }

    fn damped(&self) -> f64 {
        self.omega * (1.0 - self.zeta * self.zeta).sqrt()
    }

    /// Cosine and sine amplitudes of the free motion that starts at (w, w').
    fn free_from(&self, start: [f64; 2]) -> [f64; 2] {
        [
            start[0],
            (start[1] + self.zeta * self.omega * start[0]) / self.damped(),
        ]
    }

    fn free_motion(&self, c: [f64; 2], t: f64) -> [f64; 2] {
        let (decay, d) = (self.zeta * self.omega, self.damped());
        let (e, sin, cos) = ((-decay * t).exp(), (d * t).sin(), (d * t).cos());
        let w = c[0] * cos + c[1] * sin;
        [e * w, e * (d * (c[1] * cos - c[0] * sin) - decay * w)]
    }

    fn in_pulse(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (self.pulse_rate * t).sin_cos();
        let [s, c] = self.forced;
        let [w, v] = self.free_motion(self.free[0], t);
        [
            w + s * sin + c * cos,
            v + self.pulse_rate * (s * cos - c * sin),
        ]
    }

    /// Displacement and velocity.
    pub fn motion(&self, t: f64) -> [f64; 2] {
        if t <= self.width_s {
            self.in_pulse(t)
        } else {
            self.free_motion(self.free[1], t - self.width_s)
        }
    }

    fn pose_of(&self, w: f64) -> DiskPose {
        DiskPose {
            displacement_m: w,
            pitch_rad: 0.0,
            roll_rad: self.roll_per_m * w,
        }
    }
}

impl DiskMotion for SingleModeDisk {
    fn pose(&self, t: f64) -> DiskPose {
        self.pose_of(self.motion(t)[0])
    }
    fn pose_rate(&self, t: f64) -> DiskPose {
        self.pose_of(self.motion(t)[1])
    }
    fn events_s(&self) -> &[f64] {
        &self.events_s
    }
}
