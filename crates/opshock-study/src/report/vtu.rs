//! Writes unstructured grids as VTK's XML files, numbers as text with every digit.

use std::fmt::Write as _;

/// Kind of the cells.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cell {
    Quadrilateral,
    Hexahedron,
    Tetrahedron10,
    Hexahedron20,
}

/// Named values, with the number of components.
type Array = (String, usize, Vec<f64>);

/// An unstructured grid of one kind of cells and what is known on it.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    kind: Cell,
    points: Vec<[f64; 3]>,
    cells: Vec<Vec<usize>>,
    field_data: Vec<Array>,
    point_data: Vec<Array>,
    cell_data: Vec<Array>,
}

impl Grid {
    /// A grid without data; cells name their points in VTK's order.
    pub(super) fn new(kind: Cell, points: Vec<[f64; 3]>, cells: Vec<Vec<usize>>) -> Self {
        Self {
            kind,
            points,
            cells,
            field_data: Vec::new(),
            point_data: Vec::new(),
            cell_data: Vec::new(),
        }
    }

    /// Values that belong to the grid as a whole.
    pub(super) fn of_all(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        let values = values.into_iter().collect();
        self.field_data.push((name.to_owned(), 1, values));
    }

    /// Values of every point.
    pub(super) fn at_points(
        &mut self,
        name: impl Into<String>,
        components: usize,
        values: Vec<f64>,
    ) {
        self.point_data.push((name.into(), components, values));
    }

    /// Values of every cell.
    pub(super) fn in_cells(
        &mut self,
        name: impl Into<String>,
        components: usize,
        values: Vec<f64>,
    ) {
        self.cell_data.push((name.into(), components, values));
    }

    /// The file.
    pub(super) fn text(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n",
        );
        if !self.field_data.is_empty() {
            text.push_str("<FieldData>\n");
            for (name, _, values) in &self.field_data {
                let size = format!("NumberOfTuples=\"{}\"", values.len());
                floats(&mut text, name, &size, values.iter().copied());
            }
            text.push_str("</FieldData>\n");
        }
        let _ = writeln!(
            text,
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
            self.points.len(),
            self.cells.len()
        );
        let vectors = |n: usize| format!("NumberOfComponents=\"{n}\"");
        for (section, data) in [
            ("PointData", &self.point_data),
            ("CellData", &self.cell_data),
        ] {
            let _ = writeln!(text, "<{section}>");
            for (name, components, values) in data {
                floats(
                    &mut text,
                    name,
                    &vectors(*components),
                    values.iter().copied(),
                );
            }
            let _ = writeln!(text, "</{section}>");
        }
        text.push_str("<Points>\n");
        let coordinates = self.points.iter().flatten().copied();
        floats(&mut text, "points", &vectors(3), coordinates);
        text.push_str("</Points>\n<Cells>\n");
        let connectivity = self.cells.iter().flatten().copied();
        integers(&mut text, "Int64", "connectivity", connectivity);
        let mut end = 0;
        let offsets = self.cells.iter().map(|cell| {
            end += cell.len();
            end
        });
        integers(&mut text, "Int64", "offsets", offsets);
        // VTK's numbers of cell types.
        let number = match self.kind {
            Cell::Quadrilateral => 9,
            Cell::Hexahedron => 12,
            Cell::Tetrahedron10 => 24,
            Cell::Hexahedron20 => 25,
        };
        integers(
            &mut text,
            "UInt8",
            "types",
            self.cells.iter().map(|_| number),
        );
        text.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
        text
    }
}

fn floats(text: &mut String, name: &str, size: &str, values: impl Iterator<Item = f64>) {
    let _ = write!(
        text,
        "<DataArray type=\"Float64\" Name=\"{name}\" {size} format=\"ascii\">"
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

/// Points and quadrilaterals of a whole annulus, innermost circle first, angle running fastest; the
/// first angle is not repeated.
pub(super) fn polar_grid(radii_m: &[f64], angles_rad: &[f64]) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let around = angles_rad.len();
    let points = radii_m.iter().flat_map(|&r| {
        let angles = angles_rad.iter();
        angles.map(move |&a| [r * a.cos(), r * a.sin(), 0.0])
    });
    let mut cells = Vec::new();
    for ring in 0..radii_m.len().saturating_sub(1) {
        for at in 0..around {
            let next = (at + 1) % around;
            let (inner, outer) = (ring * around, (ring + 1) * around);
            cells.push(vec![inner + at, outer + at, outer + next, inner + next]);
        }
    }
    (points.collect(), cells)
}
