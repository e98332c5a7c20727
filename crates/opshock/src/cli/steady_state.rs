//! Formats a steady flight for `opshock steady`, as JSON and as text.

use nalgebra::Complex;
use serde::{Serialize, Serializer};
use std::fmt::Write as _;

/// Rows of a 3x3 matrix in the order (height, pitch, roll).
pub(super) type Matrix = [[f64; 3]; 3];

/// `opshock steady --json`. Matrices are -dF/dq in the order (height, pitch, roll).
#[derive(Debug, Serialize)]
pub(super) struct SteadyJson {
    pub(super) min_clearance_m: f64,
    pub(super) centre_height_m: f64,
    pub(super) pitch_rad: f64,
    pub(super) roll_rad: f64,
    pub(super) lift_n: f64,
    pub(super) suction_n: f64,
    pub(super) force_n: f64,
    pub(super) pitch_moment_n_m: f64,
    pub(super) roll_moment_n_m: f64,
    /// Slider coordinates, m.
    pub(super) centre_of_pressure: [f64; 2],
    pub(super) p_max_pa: f64,
    pub(super) p_min_pa: f64,
    pub(super) stiffness: Matrix,
    pub(super) damping: Matrix,
    /// Slider free on its film; null when a held attitude has none.
    pub(super) modes: Option<Vec<ModeJson>>,
    pub(super) unknowns: usize,
    /// Equilibria below the flight; null for a held slider.
    pub(super) lower: Option<Vec<LowerJson>>,
    /// Discretisation defect of the film's grid in the air's force, by which it is corrected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) correction: Option<LoadJson>,
    /// Shares of the forces in the gap beside the air's pressure, by name.
    #[serde(flatten, serialize_with = "in_order")]
    pub(super) gap_forces: Vec<(&'static str, LoadJson)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) impedance: Option<Vec<ImpedanceJson>>,
}

/// Part of the force, the moments and the stiffness above that the film's pressure on its grid does not make.
#[derive(Debug, Serialize)]
pub(super) struct LoadJson {
    pub(super) force_n: f64,
    pub(super) pitch_moment_n_m: f64,
    pub(super) roll_moment_n_m: f64,
    pub(super) stiffness: Matrix,
    /// Force in the disk's plane along the disk's motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) drag_n: Option<f64>,
    /// The same at a right angle to it, outwards.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) outward_n: Option<f64>,
}

/// The entries as a map, in their order.
fn in_order<S: Serializer>(
    entries: &[(&'static str, LoadJson)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(name, load)| (name, load)))
}

/// An equilibrium below the flight.
#[derive(Debug, Serialize)]
pub(super) struct LowerJson {
    pub(super) min_clearance_m: f64,
    pub(super) centre_height_m: f64,
    pub(super) pitch_rad: f64,
    pub(super) roll_rad: f64,
    pub(super) stable: bool,
}

/// A mode of the slider on its film.
#[derive(Debug, Serialize)]
pub struct ModeJson {
    pub frequency_hz: f64,
    pub damping_ratio: f64,
    /// As [`AirBearingMode::shape`].
    #[serde(skip)]
    pub shape: [Complex<f64>; 3],
}

#[derive(Debug, Serialize)]
pub(super) struct ImpedanceJson {
    pub(super) frequency_hz: f64,
    pub(super) stiffness: Matrix,
    pub(super) damping: Matrix,
}

pub(super) fn as_text(steady: &SteadyJson) -> String {
    let mut text = format!(
        "clearance      {:.4} nm\n\
         attitude       centre height {:.4} nm, pitch {:.4} urad, roll {:.4} urad\n\
         force          {:.4} mN (lift {:.4}, suction {:.4}), moments {:.4e} and {:.4e} N m\n\
         pressure       {:.5} to {:.5} MPa, centre at x {:.2} um, y {:.2} um\n\
         unknowns       {}\n",
        1e9 * steady.min_clearance_m,
        1e9 * steady.centre_height_m,
        1e6 * steady.pitch_rad,
        1e6 * steady.roll_rad,
        1e3 * steady.force_n,
        1e3 * steady.lift_n,
        1e3 * steady.suction_n,
        steady.pitch_moment_n_m,
        steady.roll_moment_n_m,
        1e-6 * steady.p_min_pa,
        1e-6 * steady.p_max_pa,
        1e6 * steady.centre_of_pressure[0],
        1e6 * steady.centre_of_pressure[1],
        steady.unknowns,
    );
    let correction = steady.correction.iter().map(|load| ("grid's defect", load));
    let gap_forces = steady.gap_forces.iter().map(|(name, load)| (*name, load));
    for (name, load) in correction.chain(gap_forces) {
        let _ = write!(
            text,
            "{:<15}{:.4} mN of the force, moments {:.4e} and {:.4e} N m",
            name.replace('_', " "),
            1e3 * load.force_n,
            load.pitch_moment_n_m,
            load.roll_moment_n_m
        );
        if let (Some(drag_n), Some(outward_n)) = (load.drag_n, load.outward_n) {
            let _ = write!(
                text,
                ", drag {:.4} mN, outward {:.4}",
                1e3 * drag_n,
                1e3 * outward_n
            );
        }
        text.push('\n');
    }
    matrix(&mut text, "stiffness", &steady.stiffness);
    matrix(&mut text, "damping", &steady.damping);
    for below in steady.lower.iter().flatten() {
        let kind = if below.stable { "stable" } else { "unstable" };
        let clearance_nm = 1e9 * below.min_clearance_m;
        text.push_str(&format!("below          {clearance_nm:.4} nm, {kind}\n"));
    }
    for mode in steady.modes.iter().flatten() {
        let _ = writeln!(
            text,
            "mode           {:.2} kHz, damping ratio {:.4}",
            1e-3 * mode.frequency_hz,
            mode.damping_ratio
        );
    }
    for row in steady.impedance.iter().flatten() {
        matrix(
            &mut text,
            &format!("K {} Hz", row.frequency_hz),
            &row.stiffness,
        );
        matrix(
            &mut text,
            &format!("C {} Hz", row.frequency_hz),
            &row.damping,
        );
    }
    text
}

fn matrix(text: &mut String, name: &str, rows: &Matrix) {
    for (index, row) in rows.iter().enumerate() {
        let name = if index == 0 { name } else { "" };
        let _ = writeln!(
            text,
            "{name:<15}{:>13.5e} {:>13.5e} {:>13.5e}",
            row[0], row[1], row[2]
        );
    }
}
