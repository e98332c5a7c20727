//! Writes time series for ParaView and everything else that reads VTK's XML files.
//!
//! | series | grid | data |
//! |---|---|---|
//! | `disk.pvd` | the disk's middle surface, quadrilaterals | points: `deflection_m`, `displacement_m` (vector) |
//! | `ramp.pvd` | both arms as boxes about the disk's edge | points: `displacement_m`; cells: `contact_force_n` |
//! | `film.pvd` | the cells under the slider, in slider coordinates | cells: `pressure_pa`, `gap_m` |
//!
//! Coordinates are metres; x, y of disk and ramp are the drive's with the ramp at angle 0, z points
//! towards the slider. Displacements are not part of the points, so a viewer can scale them. Times
//! are seconds on the study's axis. The arms' boxes have the place and clearance of the scene; their
//! width and length are drawn, not simulated.

use super::vtu::{Cell, Grid, polar_grid};
use crate::store::StoreError;
use crate::store::aside::write_all;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Disk over time on a polar grid, innermost circle first, angle running fastest.
#[derive(Clone, Debug)]
pub struct DiskSeries {
    /// Radii, m.
    pub radii_m: Vec<f64>,
    /// Angles, rad, around the whole disk, the first not repeated.
    pub angles_rad: Vec<f64>,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Deflection of every point, a list for each time, m.
    pub deflection_m: Vec<Vec<f64>>,
}

/// Arms over time.
#[derive(Clone, Debug)]
pub struct RampSeries {
    /// Radius of the contact points, m.
    pub radius_m: f64,
    /// Angle, rad.
    pub angle_rad: f64,
    /// Contact surfaces at rest over the disk's middle surface: top, bottom, m.
    pub rest_m: [f64; 2],
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Displacement of both contact points, m.
    pub displacement_m: Vec<[f64; 2]>,
    /// Contact force of both, N.
    pub force_n: Vec<[f64; 2]>,
}

/// Film over time.
#[derive(Clone, Debug)]
pub struct FilmSeries {
    /// Grid lines along the slider, m.
    pub x_lines_m: Vec<f64>,
    /// Grid lines across it, m.
    pub y_lines_m: Vec<f64>,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Pressure of every cell, x fastest, a list for each time, Pa.
    pub pressure_pa: Vec<Vec<f64>>,
    /// Height of every cell, m.
    pub gap_m: Vec<Vec<f64>>,
}

/// What is written of one shock.
#[derive(Clone, Debug)]
pub struct VtkSeries {
    /// Disk.
    pub disk: DiskSeries,
    /// Arms; `None` without a ramp.
    pub ramp: Option<RampSeries>,
    /// Film; `None` when the head was not simulated.
    pub film: Option<FilmSeries>,
}

/// Half the drawn width of an arm, m.
const ARM_HALF_M: f64 = 1.0e-3;
/// Drawn reach inwards and outwards of the contact point, m.
const ARM_REACH_M: [f64; 2] = [0.4e-3, 2.0e-3];
/// Drawn thickness, m.
const ARM_THICK_M: f64 = 0.5e-3;

/// Writes the series into `folder`, which is made when it is missing; returns the written files.
///
/// # Errors
///
/// E183 at the first file that cannot be written.
pub fn write_vtk(folder: &Path, series: &VtkSeries) -> Result<Vec<PathBuf>, StoreError> {
    let disk = &series.disk;
    let frames = disk.deflection_m.iter().enumerate();
    let disk_files = frames.map(|(frame, w)| (name("disk", frame), disk_piece(disk, w)));
    let mut lists = vec![("disk.pvd".to_owned(), collection("disk", &disk.time_s))];
    if let Some(ramp) = &series.ramp {
        lists.push(("ramp.pvd".into(), collection("ramp", &ramp.time_s)));
    }
    if let Some(film) = &series.film {
        lists.push(("film.pvd".into(), collection("film", &film.time_s)));
    }
    let ramp_files = series.ramp.iter().flat_map(|ramp| {
        let frames = 0..ramp.time_s.len();
        frames.map(|frame| (name("ramp", frame), ramp_piece(ramp, frame)))
    });
    let film_files = series.film.iter().flat_map(|film| {
        let frames = 0..film.time_s.len();
        frames.map(|frame| (name("film", frame), film_piece(film, frame)))
    });
    // Made one after the other, as they are written: a fine film of many frames is large.
    let all = lists
        .into_iter()
        .chain(disk_files)
        .chain(ramp_files)
        .chain(film_files);
    write_all(folder, all)
}

fn name(part: &str, frame: usize) -> String {
    format!("{part}_{frame:04}.vtu")
}

fn collection(part: &str, times: &[f64]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (frame, time) in times.iter().enumerate() {
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{}\"/>",
            name(part, frame)
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text
}

fn disk_piece(disk: &DiskSeries, deflection: &[f64]) -> String {
    let (points, cells) = polar_grid(&disk.radii_m, &disk.angles_rad);
    let displacement = deflection.iter().flat_map(|&w| [0.0, 0.0, w]).collect();
    let mut grid = Grid::new(Cell::Quadrilateral, points, cells);
    grid.at_points("deflection_m", 1, deflection.to_vec());
    grid.at_points("displacement_m", 3, displacement);
    grid.text()
}

/// Both arms as boxes, top first, eight corners each.
pub(super) fn arm_boxes(
    radius_m: f64,
    angle_rad: f64,
    rest_m: [f64; 2],
) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let (sine, cosine) = angle_rad.sin_cos();
    let (near, far) = (radius_m - ARM_REACH_M[0], radius_m + ARM_REACH_M[1]);
    let mut points = Vec::new();
    for (surface, outwards) in rest_m.into_iter().zip([1.0, -1.0]) {
        let away = surface + outwards * ARM_THICK_M;
        for z in [surface.min(away), surface.max(away)] {
            for (r, t) in [(near, -1.0), (far, -1.0), (far, 1.0), (near, 1.0)] {
                let t = t * ARM_HALF_M;
                points.push([r * cosine - t * sine, r * sine + t * cosine, z]);
            }
        }
    }
    (points, vec![(0..8).collect(), (8..16).collect()])
}

fn ramp_piece(ramp: &RampSeries, frame: usize) -> String {
    let (points, cells) = arm_boxes(ramp.radius_m, ramp.angle_rad, ramp.rest_m);
    let moved = ramp.displacement_m[frame].into_iter();
    let displacement = moved.flat_map(|w| [[0.0, 0.0, w]; 8]).flatten().collect();
    let mut grid = Grid::new(Cell::Hexahedron, points, cells);
    grid.at_points("displacement_m", 3, displacement);
    grid.in_cells("contact_force_n", 1, ramp.force_n[frame].to_vec());
    grid.text()
}

fn film_piece(film: &FilmSeries, frame: usize) -> String {
    let across = film.x_lines_m.len();
    let points: Vec<[f64; 3]> = film
        .y_lines_m
        .iter()
        .flat_map(|&y| film.x_lines_m.iter().map(move |&x| [x, y, 0.0]))
        .collect();
    let mut cells = Vec::new();
    for row in 0..film.y_lines_m.len().saturating_sub(1) {
        for column in 0..across.saturating_sub(1) {
            let corner = row * across + column;
            cells.push(vec![
                corner,
                corner + 1,
                corner + 1 + across,
                corner + across,
            ]);
        }
    }
    let mut grid = Grid::new(Cell::Quadrilateral, points, cells);
    grid.in_cells("pressure_pa", 1, film.pressure_pa[frame].clone());
    grid.in_cells("gap_m", 1, film.gap_m[frame].clone());
    grid.text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disks_cells_cover_its_area_and_close_around() {
        let angles: Vec<f64> = (0..90)
            .map(|k| k as f64 * std::f64::consts::TAU / 90.0)
            .collect();
        let disk = DiskSeries {
            radii_m: vec![0.01, 0.02, 0.03],
            angles_rad: angles,
            time_s: vec![0.0],
            deflection_m: vec![vec![1e-6; 270]],
        };
        let text = disk_piece(&disk, &disk.deflection_m[0]);
        assert!(text.contains("NumberOfPoints=\"270\" NumberOfCells=\"180\""));
        let list = |name: &str| -> Vec<f64> {
            let from = text.find(&format!("Name=\"{name}\"")).expect("an array");
            let start = from + text[from..].find('>').expect("its start") + 1;
            let end = start + text[start..].find('<').expect("its end");
            text[start..end]
                .split_whitespace()
                .map(|word| word.parse().expect("a number"))
                .collect()
        };
        let (points, corners) = (list("points"), list("connectivity"));
        // Area of every quadrilateral by the shoelace formula: positive when it turns to the left.
        let at = |corner: f64| [points[3 * corner as usize], points[3 * corner as usize + 1]];
        let mut area = 0.0;
        for cell in corners.chunks(4) {
            let own: f64 = (0..4)
                .map(|k| {
                    let (a, b) = (at(cell[k]), at(cell[(k + 1) % 4]));
                    0.5 * (a[0] * b[1] - a[1] * b[0])
                })
                .sum();
            assert!(own > 0.0);
            area += own;
        }
        // A regular polygon of 90 corners has sin(x) / x of the circle's area.
        let x = std::f64::consts::TAU / 90.0;
        let ring = std::f64::consts::PI * (0.03f64.powi(2) - 0.01f64.powi(2)) * x.sin() / x;
        assert!((area / ring - 1.0).abs() < 1e-12);
    }
}
