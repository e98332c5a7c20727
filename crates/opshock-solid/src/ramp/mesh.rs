//! Structured mesh of hexahedra of a parametric ramp, [`RampGeometry`].
//!
//! The parts are boxes. All their faces are planes of one grid of lines, and its cells inside a box become elements.
//! Fingers are boxes too, with their outer faces moved onto the slope.
//!
//! At re-entrant corners and at the edge of the bolted face stresses are unbounded, and elements of uniform size
//! converge slowly there. Next to these planes the elements are divided further:
//!
//! ```text
//! |h/4|h/4| h/2 |    h    |    h    ...
//! ```
//!
//! The plane y = 0 is a symmetry plane of the ramp, its loads and its contacts. Half of the ramp, free to slide in that
//! plane, moves as the whole does under axial shock.

use super::geometry::{GeometryError, MOST_ELEMENTS, RampGeometry};
use crate::element::Shape;
use crate::mesh::{FaceWeights, Mesh};
use std::collections::BTreeMap;

/// Lines closer than this are one, m.
const SAME_M: f64 = 1e-9;
/// Times an element beside a singular edge is halved.
const HALVINGS: u32 = 2;

/// Extent of the meshed ramp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// y ≥ 0.
    Half,
    /// The whole ramp.
    Whole,
}

/// Mesh of a ramp with its mount and contact faces.
#[derive(Clone, Debug)]
pub struct RampMesh {
    /// Elements.
    pub mesh: Mesh,
    /// How much of the ramp is there.
    pub extent: Extent,
    /// Nodes in the plane of symmetry of a half.
    pub symmetric: Vec<usize>,
    /// Faces on the base.
    pub bolted: Vec<Vec<usize>>,
    /// Contact of the upper finger with the disk, on its lower face.
    pub top: FaceWeights,
    /// Contact of the lower finger with the disk, on its upper face.
    pub bottom: FaceWeights,
}

/// A part: ranges in x, y and z.
type Part = [[f64; 2]; 3];

impl RampGeometry {
    /// Meshes the ramp with elements no longer than `size_m` in any direction.
    ///
    /// # Errors
    /// An invalid geometry, or a size that requires too many elements.
    pub fn mesh(&self, size_m: f64, extent: Extent) -> Result<RampMesh, GeometryError> {
        self.validate()?;
        let parts = self.parts(extent);
        let lines: [Vec<f64>; 3] = std::array::from_fn(|i| self.lines(&parts, i, size_m));
        let inside = |x: [f64; 3]| {
            let within = |part: &Part| (0..3).all(|i| part[i][0] < x[i] && x[i] < part[i][1]);
            parts.iter().any(within)
        };
        let counts = lines.each_ref().map(|l| l.len() as f64 - 1.0);
        let cells = counts.iter().product::<f64>();
        if !(size_m > 0.0 && cells <= 8.0 * MOST_ELEMENTS as f64) {
            return Err(GeometryError::MeshSize {
                size_m,
                elements: cells as usize,
            });
        }
        let mut grid = Grid::default();
        let cells = |i: usize| 0..lines[i].len() - 1;
        for k in cells(2) {
            for j in cells(1) {
                for i in cells(0) {
                    let at = [i, j, k];
                    let middle = |d: usize| 0.5 * (lines[d][at[d]] + lines[d][at[d] + 1]);
                    if inside(std::array::from_fn(middle)) {
                        grid.add(at);
                    }
                }
            }
        }
        let n_elements = grid.connectivity.len() / 20;
        if n_elements > MOST_ELEMENTS {
            return Err(GeometryError::MeshSize {
                size_m,
                elements: n_elements,
            });
        }
        let mut mesh = grid.finish(&lines);
        for node in &mut mesh.nodes_m {
            self.slope(node);
        }
        Ok(self.with_faces(mesh, extent))
    }

    fn parts(&self, extent: Extent) -> Vec<Part> {
        let half_finger = 0.5 * self.finger_width_m;
        let half_body = 0.5 * self.body_width_m;
        let finger = [0.0, self.finger_length_m];
        let body_end = self.finger_length_m + self.body_length_m;
        let top = self.slot_above_m + self.root_thickness_m;
        let mut parts = vec![
            [
                finger,
                [-half_finger, half_finger],
                [self.slot_above_m, top],
            ],
            [
                finger,
                [-half_finger, half_finger],
                [
                    -self.slot_below_m - self.root_thickness_m,
                    -self.slot_below_m,
                ],
            ],
            [
                [self.finger_length_m, body_end],
                [-half_body, half_body],
                [-self.body_depth_m, top],
            ],
        ];
        if self.pad_length_m > 0.0 {
            parts.push([
                [body_end, body_end + self.neck_length_m + self.pad_length_m],
                [-half_body, half_body],
                [
                    -self.body_depth_m,
                    -self.body_depth_m + self.mount_thickness_m,
                ],
            ]);
        }
        if extent == Extent::Half {
            parts.iter_mut().for_each(|part| part[1][0] = 0.0);
        }
        parts
    }

    /// Planes through edges with unbounded stress.
    fn singular(&self, direction: usize) -> Vec<f64> {
        match direction {
            0 => vec![
                self.finger_length_m,
                self.finger_length_m + self.body_length_m,
                self.bolted_from_m(),
            ],
            1 => Vec::new(),
            _ => vec![
                -self.body_depth_m,
                -self.body_depth_m + self.mount_thickness_m,
                -self.slot_below_m,
                self.slot_above_m,
            ],
        }
    }

    /// Lines of one direction: faces of the parts and other required planes, divided into cells.
    fn lines(&self, parts: &[Part], direction: usize, size_m: f64) -> Vec<f64> {
        let mut planes: Vec<f64> = parts.iter().flat_map(|part| part[direction]).collect();
        if direction == 0 {
            let half = 0.5 * self.contact_length_m;
            planes.extend([
                self.slope_length_m,
                self.contact_m - half,
                self.contact_m + half,
                self.bolted_from_m(),
            ]);
        }
        if direction == 1 {
            // The whole is a half and its mirror image.
            planes.push(0.0);
        }
        planes.sort_unstable_by(f64::total_cmp);
        planes.dedup_by(|a, b| (*a - *b).abs() < SAME_M);
        let singular = self.singular(direction);
        let is_singular = |x: f64| singular.iter().any(|s| (s - x).abs() < SAME_M);
        let mut lines = vec![planes[0]];
        for pair in planes.windows(2) {
            let ends = [is_singular(pair[0]), is_singular(pair[1])];
            divide(pair[0], pair[1], size_m, ends, &mut lines);
        }
        lines
    }

    /// Where the bolted face begins.
    fn bolted_from_m(&self) -> f64 {
        match self.pad_length_m > 0.0 {
            true => self.finger_length_m + self.body_length_m + self.neck_length_m,
            false => self.finger_length_m,
        }
    }

    /// Moves a node of a finger from its box onto the tapered finger.
    fn slope(&self, node: &mut [f64; 3]) {
        let share = self.thickness_m(node[0]) / self.root_thickness_m;
        if node[0] >= self.slope_length_m {
            return;
        }
        if node[2] > 0.0 {
            node[2] = self.slot_above_m + share * (node[2] - self.slot_above_m);
        } else {
            node[2] = -self.slot_below_m + share * (node[2] + self.slot_below_m);
        }
    }

    fn with_faces(&self, mesh: Mesh, extent: Extent) -> RampMesh {
        let near = |a: f64, b: f64| (a - b).abs() < SAME_M;
        let contact = |z: f64| {
            let half = 0.5 * self.contact_length_m + SAME_M;
            let faces =
                mesh.surface_faces(|x| near(x[2], z) && (x[0] - self.contact_m).abs() < half);
            mesh.face_weights(&faces)
        };
        let from = self.bolted_from_m() - SAME_M;
        let bolted = mesh.surface_faces(|x| near(x[2], -self.body_depth_m) && x[0] > from);
        let in_plane = |x: &[f64; 3]| extent == Extent::Half && x[1].abs() < SAME_M;
        let nodes = mesh.nodes_m.iter().enumerate();
        RampMesh {
            extent,
            symmetric: nodes.filter(|(_, x)| in_plane(x)).map(|(a, _)| a).collect(),
            bolted,
            top: contact(self.slot_above_m),
            bottom: contact(-self.slot_below_m),
            mesh,
        }
    }
}

/// Appends the lines after `from` up to `to`: the smallest number of equal cells within the size, those at singular
/// ends halved.
fn divide(from: f64, to: f64, size_m: f64, singular: [bool; 2], lines: &mut Vec<f64>) {
    // A length that is a multiple of the size except for rounding gets no extra element; sizes that are far too small
    // are rejected by the number of elements.
    let n = ((to - from) / size_m - 1e-9).ceil();
    let least = if singular == [true, true] { 2.0 } else { 1.0 };
    let n = n.clamp(least, 4.0 * MOST_ELEMENTS as f64) as usize;
    let cell = (to - from) / n as f64;
    let halved = |k: u32| cell * 0.5_f64.powi(k as i32);
    if singular[0] {
        lines.extend((1..=HALVINGS).rev().map(|k| from + halved(k)));
    }
    lines.extend((1..n).map(|k| from + cell * k as f64));
    if singular[1] {
        lines.extend((1..=HALVINGS).map(|k| to - halved(k)));
    }
    lines.push(to);
}

/// Nodes by their place on the lines and the middles between them, created when an element first needs them.
#[derive(Default)]
struct Grid {
    // Keyed z first, so that nodes are numbered along x.
    nodes: BTreeMap<[usize; 3], usize>,
    connectivity: Vec<[usize; 3]>,
}

impl Grid {
    fn add(&mut self, [i, j, k]: [usize; 3]) {
        for corner in crate::element::HEXAHEDRON_NODES {
            // −1, 0, 1 of the unit cube are 0, 1, 2 half cells.
            let half = corner.map(|c| (c + 1.0) as usize);
            let key = [2 * k + half[2], 2 * j + half[1], 2 * i + half[0]];
            self.nodes.insert(key, 0);
            self.connectivity.push(key);
        }
    }

    fn finish(mut self, lines: &[Vec<f64>; 3]) -> Mesh {
        let at = |lines: &[f64], half: usize| match half % 2 {
            0 => lines[half / 2],
            _ => 0.5 * (lines[half / 2] + lines[half / 2 + 1]),
        };
        let mut nodes_m = Vec::with_capacity(self.nodes.len());
        for (number, (key, slot)) in self.nodes.iter_mut().enumerate() {
            *slot = number;
            nodes_m.push([
                at(&lines[0], key[2]),
                at(&lines[1], key[1]),
                at(&lines[2], key[0]),
            ]);
        }
        Mesh {
            shape: Shape::Hexahedron20,
            nodes_m,
            connectivity: self
                .connectivity
                .iter()
                .map(|key| self.nodes[key])
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(mesh: &Mesh) -> f64 {
        let stations = mesh.shape.stations();
        let unit = crate::material::Material {
            youngs_modulus_pa: 1.0,
            poisson: 0.0,
            density_kg_per_m3: 1.0,
        };
        let of = |nodes: &[usize]| -> f64 {
            let matrices =
                crate::element::matrices(&stations, &mesh.corners_m(nodes), &unit).unwrap();
            matrices.mass.iter().sum()
        };
        mesh.elements().map(of).sum()
    }

    #[test]
    fn volume_contacts_and_bolted_face_are_those_of_the_drawing_at_any_size() {
        let geometry = RampGeometry::mobile_drive();
        let cases = [
            (2e-3, Extent::Whole, 1.0),
            (0.7e-3, Extent::Whole, 1.0),
            (0.7e-3, Extent::Half, 0.5),
        ];
        for (size_m, extent, share) in cases {
            let ramp = geometry.mesh(size_m, extent).unwrap();
            ramp.mesh.validate().unwrap();
            let error = volume(&ramp.mesh) / (share * geometry.volume_m3()) - 1.0;
            assert!(error.abs() < 1e-12, "{size_m}: {error:e}");
            assert_eq!(ramp.symmetric.is_empty(), extent == Extent::Whole);
            let patch = share * geometry.contact_length_m * geometry.finger_width_m;
            for contact in [&ramp.top, &ramp.bottom] {
                assert!((contact.area_m2 / patch - 1.0).abs() < 1e-12);
                let middle: f64 = contact
                    .nodes
                    .iter()
                    .map(|&(a, w)| w * ramp.mesh.nodes_m[a][0])
                    .sum();
                assert!((middle / (patch * geometry.contact_m) - 1.0).abs() < 1e-12);
            }
            let pad = ramp.mesh.face_weights(&ramp.bolted).area_m2;
            let expected = share * geometry.pad_length_m * geometry.body_width_m;
            assert!((pad / expected - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_body_bolted_itself_has_no_mount() {
        let geometry = RampGeometry {
            pad_length_m: 0.0,
            neck_length_m: 0.0,
            ..RampGeometry::mobile_drive()
        };
        let ramp = geometry.mesh(1e-3, Extent::Whole).unwrap();
        let foot = ramp.mesh.face_weights(&ramp.bolted).area_m2;
        let expected = geometry.body_length_m * geometry.body_width_m;
        assert!((foot / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn absurd_sizes_are_refused_before_anything_is_allocated() {
        for size_m in [1e-9, 0.0, -1.0, f64::NAN, 2e-5] {
            let fault = RampGeometry::mobile_drive()
                .mesh(size_m, Extent::Half)
                .unwrap_err();
            assert!(matches!(fault, GeometryError::MeshSize { .. }), "{size_m}");
        }
    }
}
