//! Time series for ParaView and everything else that reads VTK's XML files.
//!
//! | series | grid | data |
//! |---|---|---|
//! | `disk.pvd` | the disk's middle surface, quadrilaterals | points: `deflection_m`, `displacement_m` (vector, for *Warp By Vector*) |
//! | `ramp.pvd` | both arms as boxes about the disk's edge | points: `displacement_m`; cells: `contact_force_n` |
//! | `film.pvd` | the cells under the slider, in slider coordinates | cells: `pressure_pa`, `gap_m` |
//!
//! Coordinates are metres; x, y of disk and ramp are the drive's with the ramp at angle 0, z points
//! towards the slider. Displacements are not part of the points, so a viewer can scale them. Times
//! are seconds on the study's axis. The arms' boxes have the place and clearance of the scene; their
//! width and length are drawn, not simulated.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::files::{WriteError, write_all};

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
/// [`WriteError`] at the first file that cannot be written.
pub fn write_vtk(folder: &Path, series: &VtkSeries) -> Result<Vec<PathBuf>, WriteError> {
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
    write_all(folder, all.map(|(name, text)| (name, text.into_bytes())))
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

/// Kind of the cells.
#[derive(Clone, Copy)]
enum Cell {
    Quadrilateral,
    Hexahedron,
}

/// Named values, with the number of components.
type Array<'a> = (&'a str, usize, Vec<f64>);

/// One unstructured grid.
fn piece(
    points: &[[f64; 3]],
    cells: &[Vec<usize>],
    kind: Cell,
    point_data: &[Array<'_>],
    cell_data: &[Array<'_>],
) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        points.len(),
        cells.len()
    );
    for (section, data) in [("PointData", point_data), ("CellData", cell_data)] {
        let _ = writeln!(text, "<{section}>");
        for (name, components, values) in data {
            floats(&mut text, name, *components, values.iter().copied());
        }
        let _ = writeln!(text, "</{section}>");
    }
    text.push_str("<Points>\n");
    floats(&mut text, "points", 3, points.iter().flatten().copied());
    text.push_str("</Points>\n<Cells>\n");
    let connectivity = cells.iter().flatten().copied();
    integers(&mut text, "Int64", "connectivity", connectivity);
    let mut end = 0;
    let offsets = cells.iter().map(|cell| {
        end += cell.len();
        end
    });
    integers(&mut text, "Int64", "offsets", offsets);
    // VTK's numbers of cell types.
    let number = match kind {
        Cell::Quadrilateral => 9,
        Cell::Hexahedron => 12,
    };
    integers(&mut text, "UInt8", "types", cells.iter().map(|_| number));
    text.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    text
}

fn floats(text: &mut String, name: &str, components: usize, values: impl Iterator<Item = f64>) {
    let _ = write!(
        text,
        "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for value in values {
        let _ = write!(text, "{value:e} ");
    }
    text.push_str("</DataArray>\n");
}

fn integers(text: &mut String, kind: &str, name: &str, values: impl Iterator<Item = usize>) {
    let _ = write!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">"
    );
    for value in values {
        let _ = write!(text, "{value} ");
    }
    text.push_str("</DataArray>\n");
}

fn disk_piece(disk: &DiskSeries, deflection: &[f64]) -> String {
    let around = disk.angles_rad.len();
    let points: Vec<[f64; 3]> = disk
        .radii_m
        .iter()
        .flat_map(|&r| {
            let angles = disk.angles_rad.iter();
            angles.map(move |&a| [r * a.cos(), r * a.sin(), 0.0])
        })
        .collect();
    let mut cells = Vec::new();
    for ring in 0..disk.radii_m.len().saturating_sub(1) {
        for at in 0..around {
            let next = (at + 1) % around;
            let (inner, outer) = (ring * around, (ring + 1) * around);
            cells.push(vec![inner + at, outer + at, outer + next, inner + next]);
        }
    }
    let displacement = deflection.iter().flat_map(|&w| [0.0, 0.0, w]).collect();
    piece(
        &points,
        &cells,
        Cell::Quadrilateral,
        &[
            ("deflection_m", 1, deflection.to_vec()),
            ("displacement_m", 3, displacement),
        ],
        &[],
    )
}

fn ramp_piece(ramp: &RampSeries, frame: usize) -> String {
    let (sine, cosine) = ramp.angle_rad.sin_cos();
    let (near, far) = (
        ramp.radius_m - ARM_REACH_M[0],
        ramp.radius_m + ARM_REACH_M[1],
    );
    let mut points = Vec::new();
    let mut displacement = Vec::new();
    for (arm, outwards) in [1.0, -1.0].into_iter().enumerate() {
        let surface = ramp.rest_m[arm];
        let away = surface + outwards * ARM_THICK_M;
        for z in [surface.min(away), surface.max(away)] {
            for (r, t) in [(near, -1.0), (far, -1.0), (far, 1.0), (near, 1.0)] {
                let t = t * ARM_HALF_M;
                points.push([r * cosine - t * sine, r * sine + t * cosine, z]);
                displacement.extend([0.0, 0.0, ramp.displacement_m[frame][arm]]);
            }
        }
    }
    let cells = vec![(0..8).collect(), (8..16).collect()];
    piece(
        &points,
        &cells,
        Cell::Hexahedron,
        &[("displacement_m", 3, displacement)],
        &[("contact_force_n", 1, ramp.force_n[frame].to_vec())],
    )
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
    piece(
        &points,
        &cells,
        Cell::Quadrilateral,
        &[],
        &[
            ("pressure_pa", 1, film.pressure_pa[frame].clone()),
            ("gap_m", 1, film.gap_m[frame].clone()),
        ],
    )
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
