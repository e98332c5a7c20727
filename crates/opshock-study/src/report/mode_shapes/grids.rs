//! Makes VTK grids of the bodies with their modes.

use super::shapes::{DiskShapes, HeadShapes, ModeShapes, RampShapes};
use crate::report::vtk_files::arm_boxes;
use crate::report::vtu::{Cell, Grid, polar_grid};
use opshock_solid::element::Shape;
use opshock_solver::suspension::{Held, SuspensionShape, SuspensionShapes};

/// Cells along and across the slider's face.
const FACE: usize = 8;

/// File names and texts.
pub(super) fn all(shapes: &ModeShapes) -> Vec<(&'static str, String)> {
    let mut all = vec![("disk_modes.vtu", disk(&shapes.disk))];
    all.extend(shapes.ramp.iter().map(|r| ("ramp_modes.vtu", ramp(r))));
    let suspension_grid = |s| ("suspension_modes.vtu", suspension(s));
    all.extend(shapes.suspension.iter().map(suspension_grid));
    all.push(("head_modes.vtu", head(&shapes.head)));
    all
}

/// Vectors along z.
fn rising(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let vectors = values.into_iter().map(|rise| [0.0, 0.0, rise]);
    vectors.flatten().collect()
}

fn disk(disk: &DiskShapes) -> String {
    let (points, cells) = polar_grid(&disk.radii_m, &disk.angles_rad);
    let mut grid = Grid::new(Cell::Quadrilateral, points, cells);
    for mode in &disk.modes {
        let n = mode.nodal_diameters as f64;
        let radial = mode.radial_per_sqrt_kg.iter();
        let around =
            radial.flat_map(|phi| disk.angles_rad.iter().map(move |a| phi * (n * a).cos()));
        let name = format!(
            "n{}_c{}_per_sqrt_kg",
            mode.nodal_diameters, mode.nodal_circles
        );
        grid.at_points(name, 3, rising(around));
    }
    grid.of_all("frequency_hz", disk.modes.iter().map(|m| m.frequency_hz));
    grid.text()
}

fn ramp(ramp: &RampShapes) -> String {
    match ramp {
        RampShapes::Contacts {
            radius_m,
            angle_rad,
            rest_m,
            modes,
        } => {
            let (points, cells) = arm_boxes(*radius_m, *angle_rad, *rest_m);
            let corners = points.len() / 2;
            let mut grid = Grid::new(Cell::Hexahedron, points, cells);
            for (k, mode) in (1..).zip(modes) {
                let [top, bottom] = mode.contact_per_sqrt_kg;
                let of_top = std::iter::repeat_n(top, corners);
                let both = of_top.chain(std::iter::repeat_n(bottom, corners));
                grid.at_points(format!("mode_{k}_per_sqrt_kg"), 3, rising(both));
            }
            grid.of_all("frequency_hz", modes.iter().map(|m| m.frequency_hz));
            grid.text()
        }
        RampShapes::Solid { mesh, modes } => {
            let kind = match mesh.mesh.shape {
                Shape::Hexahedron20 => Cell::Hexahedron20,
                Shape::Tetrahedron10 => Cell::Tetrahedron10,
            };
            // Both shapes number their nodes as VTK does.
            let cells = mesh.mesh.elements().map(<[usize]>::to_vec).collect();
            let mut grid = Grid::new(kind, mesh.mesh.nodes_m.clone(), cells);
            for (k, mode) in (1..).zip(modes) {
                let vectors = mode.displacement_per_sqrt_kg.as_flattened().to_vec();
                grid.at_points(format!("mode_{k}_per_sqrt_kg"), 3, vectors);
            }
            grid.of_all("frequency_hz", modes.iter().map(|m| m.mode.frequency_hz));
            grid.text()
        }
    }
}

/// `bending_free`, `bending_pinned`, `torsion_free` or `torsion_pinned`.
pub(super) fn family(mode: &SuspensionShape) -> &'static str {
    match (mode.is_bending, mode.held) {
        (true, Held::Free) => "bending_free",
        (true, Held::Pinned) => "bending_pinned",
        (false, Held::Free) => "torsion_free",
        (false, Held::Pinned) => "torsion_pinned",
    }
}

/// The modes with their family and their number in it, from 1.
pub(super) fn numbered(
    shapes: &SuspensionShapes,
) -> impl Iterator<Item = (&'static str, usize, &SuspensionShape)> {
    let mut last = ("", 0);
    shapes.modes.iter().map(move |mode| {
        let family = family(mode);
        let number = if last.0 == family { last.1 + 1 } else { 1 };
        last = (family, number);
        (family, number, mode)
    })
}

fn suspension(shapes: &SuspensionShapes) -> String {
    let places = shapes.places_m.iter().zip(&shapes.width_m);
    let edges = || {
        places
            .clone()
            .flat_map(|(x, b)| [(*x, -0.5 * b), (*x, 0.5 * b)])
    };
    let points = edges().map(|(x, y)| [x, y, 0.0]).collect();
    let between = 0..shapes.places_m.len().saturating_sub(1);
    let cells = between.map(|k| vec![2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]);
    let mut grid = Grid::new(Cell::Quadrilateral, points, cells.collect());
    for (family, number, mode) in numbered(shapes) {
        let of_both = mode.shape.iter().flat_map(|value| [*value; 2]);
        let rise = edges()
            .zip(of_both)
            .map(|((_, y), value)| match mode.is_bending {
                true => value,
                false => value * y,
            });
        grid.at_points(format!("{family}_{number}_per_sqrt_kg"), 3, rising(rise));
    }
    grid.of_all("frequency_hz", shapes.modes.iter().map(|m| m.frequency_hz));
    grid.text()
}

fn head(head: &HeadShapes) -> String {
    // x and y from the slider's corner, as its film has them.
    let line = |length: f64| (0..=FACE).map(move |k| length * k as f64 / FACE as f64);
    let points: Vec<[f64; 3]> = line(head.width_m)
        .flat_map(|y| line(head.length_m).map(move |x| [x, y, 0.0]))
        .collect();
    let mut cells = Vec::new();
    for row in 0..FACE {
        for column in 0..FACE {
            let corner = row * (FACE + 1) + column;
            cells.push(vec![
                corner,
                corner + 1,
                corner + FACE + 2,
                corner + FACE + 1,
            ]);
        }
    }
    let mut grid = Grid::new(Cell::Quadrilateral, points.clone(), cells);
    for (k, mode) in (1..).zip(&head.modes) {
        let rises: Vec<_> = points
            .iter()
            .map(|[x, y, _]| mode.rise(x - 0.5 * head.length_m, y - 0.5 * head.width_m))
            .collect();
        let real = rises.iter().map(|rise| rise.re);
        let imaginary = rises.iter().map(|rise| rise.im);
        grid.at_points(format!("mode_{k}_real_per_sqrt_kg"), 3, rising(real));
        grid.at_points(
            format!("mode_{k}_imaginary_per_sqrt_kg"),
            3,
            rising(imaginary),
        );
    }
    grid.of_all("frequency_hz", head.modes.iter().map(|m| m.frequency_hz));
    grid.text()
}
