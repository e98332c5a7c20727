//! Stores the film's mesh as columns of numbers, so that kernels run over whole blocks of faces.
//!
//! Cells are numbered along y first. The face between cell k and its neighbour along a direction has the number k.
//! Faces that would join the end of one column to the start of the next exist too, with length 0, so that the cells of
//! a block of faces are blocks of cells.
//!
//! A face has an up side, from which the wind comes, and a down side. Without wind the up side is the cell with the
//! smaller number.

use super::attitude::Attitude;
use super::mesh::{EdgeFace, Face, Mesh, Place, Side};

/// Faces that a kernel handles together: two of the widest registers, so that a pass keeps its values in registers.
pub(super) const BLOCK: usize = 16;

/// A number of every face or cell of a block.
pub(super) type Block = [f64; BLOCK];

/// The block of `column` that starts at `first`.
#[inline(always)]
pub(super) fn block(column: &[f64], first: usize) -> &Block {
    column[first..first + BLOCK]
        .try_into()
        .expect("a slice of BLOCK entries")
}

/// Places of faces or cells as columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    pub(super) form: Vec<f64>,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
}

impl Places {
    pub(super) fn push(&mut self, place: &Place) {
        self.form.push(place.form);
        self.x.push(place.x);
        self.y.push(place.y);
    }

    /// Heights without recess of the block at `first`, m.
    #[inline(always)]
    pub(super) fn heights(&self, first: usize, attitude: &Attitude) -> Block {
        let (form, x, y) = (
            block(&self.form, first),
            block(&self.x, first),
            block(&self.y, first),
        );
        let mut out = [0.0; BLOCK];
        for k in 0..BLOCK {
            let turned = attitude.pitch_rad.mul_add(-x[k], attitude.centre_height_m);
            out[k] = attitude.roll_rad.mul_add(y[k], turned) + form[k];
        }
        out
    }
}

/// One side of many faces as columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Sides {
    pub(super) recess: Vec<f64>,
    pub(super) reach: Vec<f64>,
    pub(super) distance: Vec<f64>,
    pub(super) inverse_distance: Vec<f64>,
    pub(super) area: Vec<f64>,
}

impl Sides {
    fn push(&mut self, side: &Side, area: f64) {
        self.recess.push(side.recess);
        self.reach.push(side.reach);
        self.distance.push(1.0 / side.inverse_distance);
        self.inverse_distance.push(side.inverse_distance);
        self.area.push(area);
    }
}

/// All faces of one direction between cells.
#[derive(Clone, Debug)]
pub(super) struct Interior {
    /// 6 μ U out of the up side, >= 0.
    pub(super) wind: f64,
    /// Distance in cell numbers between the sides of a face.
    pub(super) stride: usize,
    /// Number of face 0's up cell, down cell and cell behind the up cell, counted from the cell in
    /// front of cell 0.
    pub(super) up: usize,
    pub(super) down: usize,
    pub(super) behind: usize,
    /// Length times the sign that turns up-to-down into rising cell numbers.
    pub(super) length: Vec<f64>,
    /// 1 on an etched step, 0 elsewhere.
    pub(super) step: Vec<f64>,
    pub(super) places: Places,
    pub(super) up_side: Sides,
    pub(super) down_side: Sides,
}

/// Faces on the slider's edges with the same kind of wind.
#[derive(Clone, Debug)]
pub(super) struct Edges {
    /// 6 μ U out of the slider.
    pub(super) wind: f64,
    /// Cell of every face, and the cell behind it; padded with cell 0.
    pub(super) cells: Vec<usize>,
    pub(super) behind: Vec<usize>,
    pub(super) length: Vec<f64>,
    pub(super) places: Places,
    pub(super) side: Sides,
}

/// All of a mesh as columns.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) n_cells: usize,
    /// Cells in front of cell 0 in every column of states; they hold ones.
    pub(super) front: usize,
    /// Length of a column of states.
    pub(super) padded: usize,
    pub(super) places: Places,
    pub(super) recess: Vec<f64>,
    pub(super) area: Vec<f64>,
    /// x and y of the cells' centres again, padded like states.
    pub(super) centre_x: Vec<f64>,
    pub(super) centre_y: Vec<f64>,
    pub(super) interior: [Interior; 2],
    pub(super) edges: Vec<Edges>,
}

impl Columns {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let n_cells = mesh.cells.len();
        let [_, ny] = mesh.counts();
        // The distance of a face's cells from it, to either side.
        let front = 2 * ny;
        let blocks = n_cells.next_multiple_of(BLOCK);
        let padded = front + blocks + front + BLOCK;
        let mut columns = Self {
            n_cells,
            front,
            padded,
            centre_x: vec![0.0; padded],
            centre_y: vec![0.0; padded],
            places: Places::default(),
            recess: Vec::with_capacity(blocks),
            area: Vec::with_capacity(blocks),
            interior: [
                interior(mesh, 0, blocks, front),
                interior(mesh, 1, blocks, front),
            ],
            edges: Vec::new(),
        };
        for k in 0..blocks {
            // The last cell is repeated behind it, without area.
            let cell = &mesh.cells[k.min(n_cells - 1)];
            columns.places.push(&cell.place);
            columns.recess.push(cell.recess);
            columns.area.push(if k < n_cells { cell.area } else { 0.0 });
            columns.centre_x[front + k] = cell.place.x;
            columns.centre_y[front + k] = cell.place.y;
        }
        let (x_ends, y_ends) = mesh.edge_faces.split_at(2 * ny);
        for ends in [x_ends, y_ends] {
            for sign in [-1.0, 1.0] {
                let wanted = |f: &&EdgeFace| match f.side.wind {
                    0.0 => sign < 0.0,
                    wind => wind * sign > 0.0,
                };
                let group: Vec<&EdgeFace> = ends.iter().filter(wanted).collect();
                if !group.is_empty() {
                    columns.edges.push(edges(&group));
                }
            }
        }
        columns
    }
}

fn interior(mesh: &Mesh, d: usize, blocks: usize, front: usize) -> Interior {
    let [nx, ny] = mesh.counts();
    let stride = [ny, 1][d];
    let x_faces = (nx - 1) * ny;
    let faces = if d == 0 {
        &mesh.faces[..x_faces]
    } else {
        &mesh.faces[x_faces..]
    };
    let first_wind = faces.first().map_or(0.0, |f| f.sides[0].wind);
    let backwards = first_wind < 0.0;
    let mut out = Interior {
        wind: first_wind.abs(),
        stride,
        up: if backwards { front + stride } else { front },
        down: if backwards { front } else { front + stride },
        behind: if backwards {
            front + 2 * stride
        } else {
            front - stride
        },
        length: Vec::with_capacity(blocks),
        step: Vec::with_capacity(blocks),
        places: Places::default(),
        up_side: Sides::default(),
        down_side: Sides::default(),
    };
    let mut next = faces.iter().peekable();
    for k in 0..blocks {
        let real = next.next_if(|face| face.sides[0].cell == k);
        let (face, length) = match real {
            Some(face) => (*face, face.length),
            None => (absent(mesh, k), 0.0),
        };
        let [a, b] = face.sides;
        let [up, down] = if backwards { [b, a] } else { [a, b] };
        out.length.push(if backwards { -length } else { length });
        out.step.push(f64::from(u8::from(!face.is_smooth())));
        out.places.push(&face.place);
        let area = |side: &Side| if real.is_some() { side.area } else { 0.0 };
        out.up_side.push(&up, area(&up));
        out.down_side.push(&down, area(&down));
    }
    out
}

/// Placeholder where there is no face: zero length, with numbers that keep a kernel finite.
fn absent(mesh: &Mesh, cell: usize) -> Face {
    let cell = &mesh.cells[cell.min(mesh.cells.len() - 1)];
    let side = Side {
        cell: 0,
        behind: 0,
        reach: 0.0,
        recess: cell.recess,
        inverse_distance: 1.0 / cell.area.sqrt(),
        wind: 0.0,
        area: 0.0,
    };
    Face {
        sides: [side, side],
        place: cell.place,
        length: 0.0,
    }
}

fn edges(group: &[&EdgeFace]) -> Edges {
    let mut out = Edges {
        wind: group[0].side.wind,
        cells: Vec::new(),
        behind: Vec::new(),
        length: Vec::new(),
        places: Places::default(),
        side: Sides::default(),
    };
    for k in 0..group.len().next_multiple_of(BLOCK) {
        let real = group.get(k);
        let face = real.unwrap_or(&group[group.len() - 1]);
        out.cells.push(face.side.cell);
        out.behind.push(face.side.behind);
        out.length
            .push(if real.is_some() { face.length } else { 0.0 });
        out.places.push(&face.place);
        out.side.push(
            &face.side,
            if real.is_some() { face.side.area } else { 0.0 },
        );
    }
    out
}
