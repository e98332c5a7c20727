//! Records pressure and height of the film at given times of a run.
//!
//! ```text
//! p = ψ / h_f,   h = recess + attitude over the disk's plane,   h_f = max(h, minimum film height), smoothed
//! ```
//!
//! Inside a step ψ and the slider's coordinates are those of the cubic through both ends of the step, the one in which
//! touch is located; the disk's pose is exact. Recording does not change the steps. A time before the onset gets the
//! fields of steady flight; a time after the end of the run (touch, or the window) gets none.

use super::model::HeadModel;
use super::outcome::PressureFields;
use crate::disk::DiskMotion;
use crate::integrator::hermite;

/// The fields of one run, room for all of them made at its start.
pub(super) struct FieldRecord<'a> {
    times_s: &'a [f64],
    fields: PressureFields,
    psi: Vec<f64>,
    cells: Vec<f64>,
}

/// One step: its start, its length, and states and rates at both ends.
pub(super) struct StepEnds<'a> {
    pub start_s: f64,
    pub dt_s: f64,
    pub y: [&'a [f64]; 2],
    pub rate: [&'a [f64]; 2],
}

impl<'a> FieldRecord<'a> {
    /// Room for the fields of `times_s`, ascending.
    pub fn new(model: &HeadModel, times_s: &'a [f64]) -> Self {
        let [x, y] = model.film.lines_m();
        let n_cells = model.film.n_cells();
        let room = || Vec::with_capacity(times_s.len() * n_cells);
        Self {
            times_s,
            fields: PressureFields {
                x_lines_m: x.to_vec(),
                y_lines_m: y.to_vec(),
                time_s: Vec::with_capacity(times_s.len()),
                pressure_pa: room(),
                gap_m: room(),
            },
            psi: vec![0.0; n_cells],
            cells: vec![0.0; n_cells],
        }
    }

    /// Keeps the requested times up to 0: steady flight, whose state is `y`.
    pub fn keep_steady(&mut self, model: &HeadModel, motion: &dyn DiskMotion, y: &[f64]) {
        while let Some(time_s) = self.next_s().filter(|&t| t <= 0.0) {
            let n_cells = self.psi.len();
            self.psi.copy_from_slice(&y[..n_cells]);
            let x = std::array::from_fn(|i| y[n_cells + i]);
            self.keep(model, motion, time_s, 0.0, x);
        }
    }

    /// Keeps the requested times up to `until_s` that lie in `step`.
    pub fn keep_step(
        &mut self,
        model: &HeadModel,
        motion: &dyn DiskMotion,
        step: &StepEnds<'_>,
        until_s: f64,
    ) {
        while let Some(time_s) = self.next_s().filter(|&t| t <= until_s) {
            let theta = ((time_s - step.start_s) / step.dt_s).min(1.0);
            let at = |i: usize| {
                let (y, rate) = (step.y, step.rate);
                hermite::value(
                    theta,
                    step.dt_s,
                    [y[0][i], y[1][i]],
                    [rate[0][i], rate[1][i]],
                )
            };
            let n_cells = self.psi.len();
            for (i, psi) in self.psi.iter_mut().enumerate() {
                *psi = at(i);
            }
            let x = std::array::from_fn(|i| at(n_cells + i));
            self.keep(model, motion, time_s, time_s, x);
        }
    }

    /// The recorded fields.
    pub fn finish(self) -> PressureFields {
        self.fields
    }

    fn next_s(&self) -> Option<f64> {
        self.times_s.get(self.fields.time_s.len()).copied()
    }

    /// One field: ψ in the scratch, the slider at `x`, the disk at `pose_s`.
    fn keep(
        &mut self,
        model: &HeadModel,
        motion: &dyn DiskMotion,
        time_s: f64,
        pose_s: f64,
        x: [f64; 3],
    ) {
        let attitude = model.attitude(&x, &motion.pose(pose_s));
        let film = &model.film;
        let [nx, ny] = film.lines_m().map(|lines| lines.len() - 1);
        let Self {
            fields, psi, cells, ..
        } = self;
        fields.time_s.push(time_s);
        // The film numbers its cells in the order that suits its matrices.
        let put = |field: &mut Vec<f64>, cells: &[f64]| {
            let rows = (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y)));
            field.extend(rows.map(|(x, y)| cells[film.cell_index(x, y)]));
        };
        film.pressure(psi, &attitude, cells);
        put(&mut fields.pressure_pa, cells);
        film.heights(&attitude, cells);
        put(&mut fields.gap_m, cells);
    }
}
