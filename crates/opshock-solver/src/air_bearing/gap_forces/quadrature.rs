//! Points of Gauss's rule of two by two in every cell of a film.

use crate::air_bearing::faces::{BLOCK, Places};
use crate::air_bearing::mesh::{Mesh, Place};
use crate::slider::SliderParameters;
use crate::slider::surface::Surface;

/// The points with their areas, in whole blocks.
#[derive(Clone, Debug)]
pub(super) struct CellPoints {
    /// Their form includes the recess.
    pub(super) places: Places,
    /// Area that each stands for, m2.
    pub(super) area: Vec<f64>,
}

impl CellPoints {
    /// Points of the cells of `mesh` under `slider`.
    pub(super) fn new(slider: &SliderParameters, mesh: &Mesh) -> Self {
        let surface = Surface::new(slider);
        let mut places = Places::default();
        let mut area = Vec::with_capacity(4 * mesh.cells.len());
        let offset = 0.5 / 3.0_f64.sqrt();
        let [nx, ny] = mesh.counts();
        for i in 0..nx {
            for j in 0..ny {
                let cell = &mesh.cells[mesh.index(i, j)];
                let [x, y] = [(0, i), (1, j)].map(|(d, k)| {
                    let (middle, width) = (mesh.lines[d].centre(k), mesh.lines[d].width(k));
                    [middle - offset * width, middle + offset * width]
                });
                for x in x {
                    for y in y {
                        let mut place = Place::new(&surface, x, y);
                        place.form += cell.recess;
                        places.push(&place);
                        area.push(0.25 * cell.area);
                    }
                }
            }
        }
        // Points without area, far from the disk, fill the last block.
        while area.len() % BLOCK != 0 {
            places.push(&Place {
                form: 1.0,
                x: 0.0,
                y: 0.0,
            });
            area.push(0.0);
        }
        Self { places, area }
    }
}
