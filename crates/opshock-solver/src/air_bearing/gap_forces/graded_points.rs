//! Points of Gauss's rule in the cells of a film, closer together towards edges.
//!
//! A tilted slider strikes with an edge or a corner, over a width of depth over tilt: often less than a micrometre, where a cell
//! is tens of micrometres wide. Beside an edge a cell is cut into parts, halved again and again towards it, and the rule of
//! two points acts on each. Edges are those of the slider, those at which its surface steps back, and the end of its taper. A cell
//! that a slanted side of a rail crosses is cut into equal parts as well.

use crate::air_bearing::attitude::Attitude;
use crate::air_bearing::mesh::{Mesh, Place};
use crate::slider::SliderParameters;
use crate::slider::surface::Surface;
use std::ops::Range;

/// Width of the part next to an edge, at most, m.
const FINEST_M: f64 = 0.25e-6;

/// Share of a cell's width within which a place lies on a line of the grid.
const ON_LINE: f64 = 1e-6;

/// Parts along a direction of a cell that a slanted side crosses.
const EQUAL_PARTS: u32 = 8;

/// Which of the two ends of a cell along a direction are edges.
type Edges = [bool; 2];

/// The points with their areas, cell by cell.
#[derive(Clone, Debug)]
pub(super) struct GradedPoints {
    cells: Vec<CellPoints>,
    /// Their form includes the recess.
    pub(super) places: Vec<Place>,
    /// Area that each stands for, m2.
    pub(super) area: Vec<f64>,
}

/// Points of one cell, and what bounds their heights from below.
#[derive(Clone, Debug)]
struct CellPoints {
    points: Range<usize>,
    lowest_form: f64,
    x: [f64; 2],
    y: [f64; 2],
}

impl CellPoints {
    fn lowest_m(&self, attitude: &Attitude) -> f64 {
        let [x, y] = [(-attitude.pitch_rad, self.x), (attitude.roll_rad, self.y)]
            .map(|(slope, ends)| (slope * ends[0]).min(slope * ends[1]));
        attitude.centre_height_m + x + y + self.lowest_form
    }
}

impl GradedPoints {
    /// Points of the cells of `mesh` under `slider`.
    pub(super) fn new(slider: &SliderParameters, mesh: &Mesh) -> Self {
        let surface = Surface::new(slider);
        let counts = mesh.counts();
        let mut all = Self {
            cells: Vec::with_capacity(mesh.cells.len()),
            places: Vec::new(),
            area: Vec::new(),
        };
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                let cell = &mesh.cells[mesh.index(i, j)];
                let steps_back = |[i, j]: [usize; 2]| {
                    let is_cell = i < counts[0] && j < counts[1];
                    !is_cell || mesh.cells[mesh.index(i, j)].recess > cell.recess
                };
                // Before the first cell the number wraps, and is no cell's either.
                let mut edges = [
                    [[i.wrapping_sub(1), j], [i + 1, j]],
                    [[i, j.wrapping_sub(1)], [i, j + 1]],
                ]
                .map(|ends| ends.map(steps_back));
                let [x, y] = [(0, i), (1, j)]
                    .map(|(d, k)| (mesh.lines[d].centre(k), mesh.lines[d].width(k)));
                let taper_m = surface.taper_length_m();
                for (edge, side) in edges[0].iter_mut().zip([-0.5, 0.5]) {
                    *edge |= taper_m > 0.0 && (x.0 + side * x.1 - taper_m).abs() < ON_LINE * x.1;
                }
                let is_crossed = surface.recess_m(x.0, y.0) != cell.recess;
                let [x, y] = [(x, edges[0]), (y, edges[1])].map(|((middle, width), edges)| {
                    let mut cuts = graded(width, edges);
                    if is_crossed {
                        cuts.extend(equal(width));
                        cuts.sort_by(f64::total_cmp);
                        cuts.dedup_by(|a, b| *a - *b < ON_LINE * width);
                    }
                    points(middle, &cuts)
                });
                let first = all.places.len();
                for &(x, along) in &x {
                    for &(y, across) in &y {
                        let mut place = Place::new(&surface, x, y);
                        place.form += surface.recess_m(x, y);
                        all.places.push(place);
                        all.area.push(along * across);
                    }
                }
                let own = &all.places[first..];
                let ends = |of: fn(&Place) -> f64| [of(&own[0]), of(&own[own.len() - 1])];
                all.cells.push(CellPoints {
                    points: first..all.places.len(),
                    lowest_form: own
                        .iter()
                        .map(|place| place.form)
                        .fold(f64::INFINITY, f64::min),
                    x: ends(|place| place.x),
                    y: ends(|place| place.y),
                });
            }
        }
        all
    }

    /// Calls `visit` with every point below `reach_m`: its number and height.
    pub(super) fn below(
        &self,
        reach_m: f64,
        attitude: &Attitude,
        mut visit: impl FnMut(usize, f64),
    ) {
        for cell in &self.cells {
            if cell.lowest_m(attitude) >= reach_m {
                continue;
            }
            for point in cell.points.clone() {
                let height_m = self.places[point].height(attitude);
                if height_m < reach_m {
                    visit(point, height_m);
                }
            }
        }
    }
}

/// Ends of equal parts of a cell along a direction, from its middle.
fn equal(width: f64) -> Vec<f64> {
    let at = |k: u32| width * (f64::from(k) / f64::from(EQUAL_PARTS) - 0.5);
    (0..=EQUAL_PARTS).map(at).collect()
}

/// Ends of parts that are closer together towards edges.
fn graded(width: f64, edges: Edges) -> Vec<f64> {
    let half = 0.5 * width;
    let halvings = (half / FINEST_M).log2().ceil().max(1.0) as i32;
    // Cuts at these distances from the middle.
    let towards = |is_edge: bool| -> Vec<f64> {
        let cuts = (1..=halvings).map(|k| half * (1.0 - 0.5_f64.powi(k)));
        cuts.filter(|_| is_edge).collect()
    };
    let mut cuts = vec![-half];
    cuts.extend(towards(edges[0]).into_iter().rev().map(|cut| -cut));
    cuts.extend(edges.contains(&true).then_some(0.0));
    cuts.extend(towards(edges[1]));
    cuts.push(half);
    cuts
}

/// Points along one direction of a cell, rising, and the widths that they stand for.
fn points(middle: f64, cuts: &[f64]) -> Vec<(f64, f64)> {
    let offset = 0.5 / 3.0_f64.sqrt();
    let of_part = |part: &[f64]| {
        let (centre, width) = (middle + 0.5 * (part[0] + part[1]), part[1] - part[0]);
        [-offset, offset].map(|at| (at.mul_add(width, centre), 0.5 * width))
    };
    cuts.windows(2).flat_map(of_part).collect()
}
