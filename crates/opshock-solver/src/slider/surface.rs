//! Shape of the slider's air-bearing surface: recess field and slowly varying form.
//!
//! ```text
//! h(x, y) = h_c − θ (x − x_c) + φ (y − y_c) + recess(x, y) + form(x, y)
//! form    = crown ξ² + camber η² + twist ξ η + tan(taper) max(0, l − x)
//! ξ = (x − x_c)/(L/2),  η = (y − y_c)/(W/2)
//! ```
//!
//! The form is measured from the middle of the surface: with a positive crown the ends lie
//! farther from the disk than the middle by that amount. x_c and y_c are the middle of the slider.

use super::parameters::{Rail, RailOutline, SliderParameters};

impl RailOutline {
    /// Whether the point lies inside or on the outline.
    pub fn contains(&self, x_m: f64, y_m: f64) -> bool {
        match self {
            RailOutline::Rectangle {
                x_m: [x0, x1],
                y_m: [y0, y1],
            } => (*x0..=*x1).contains(&x_m) && (*y0..=*y1).contains(&y_m),
            RailOutline::Polygon { points_m } => polygon_contains(points_m, x_m, y_m),
        }
    }

    /// Whether its edge may run through an axis-parallel rectangle; false when it does not.
    fn cuts(&self, [x_m, y_m]: [[f64; 2]; 2]) -> bool {
        match self {
            RailOutline::Rectangle {
                x_m: own_x,
                y_m: own_y,
            } => {
                let meets = |a: &[f64; 2], b: [f64; 2]| a[0] <= b[1] && b[0] <= a[1];
                let holds = |a: &[f64; 2], b: [f64; 2]| a[0] <= b[0] && b[1] <= a[1];
                let is_inside = holds(own_x, x_m) && holds(own_y, y_m);
                meets(own_x, x_m) && meets(own_y, y_m) && !is_inside
            }
            RailOutline::Polygon { points_m } => {
                let starts = points_m.iter().cycle().skip(points_m.len() - 1);
                let mut sides = starts.zip(points_m);
                sides.any(|(a, b)| side_meets(*a, *b, [x_m, y_m]))
            }
        }
    }

    /// Corners in order.
    pub fn corners_m(&self) -> Vec<[f64; 2]> {
        match self {
            RailOutline::Rectangle {
                x_m: [x0, x1],
                y_m: [y0, y1],
            } => {
                vec![[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]]
            }
            RailOutline::Polygon { points_m } => points_m.clone(),
        }
    }
}

/// Whether the side from `a` to `b` has a point in a closed axis-parallel rectangle: neither may the side lie beyond
/// one of the rectangle's lines, nor the rectangle on one side of the side's own line.
fn side_meets(a: [f64; 2], b: [f64; 2], rectangle: [[f64; 2]; 2]) -> bool {
    let is_beyond = |d: usize| {
        let [low, high] = rectangle[d];
        a[d].max(b[d]) < low || a[d].min(b[d]) > high
    };
    if is_beyond(0) || is_beyond(1) {
        return false;
    }
    let [x, y] = rectangle;
    let turn = |px: f64, py: f64| (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
    let turns = [
        turn(x[0], y[0]),
        turn(x[1], y[0]),
        turn(x[1], y[1]),
        turn(x[0], y[1]),
    ];
    !(turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0))
}

/// Even-odd rule.
fn polygon_contains(points: &[[f64; 2]], x: f64, y: f64) -> bool {
    let mut inside = false;
    let mut previous = match points.last() {
        Some(p) => *p,
        None => return false,
    };
    for &[px, py] in points {
        let [qx, qy] = previous;
        if (py > y) != (qy > y) && x < (qx - px) * (y - py) / (qy - py) + px {
            inside = !inside;
        }
        previous = [px, py];
    }
    inside
}

/// Geometry of one slider's air-bearing surface.
#[derive(Clone, Debug)]
pub struct Surface {
    length_m: f64,
    width_m: f64,
    base_recess_m: f64,
    crown_m: f64,
    camber_m: f64,
    twist_m: f64,
    taper_length_m: f64,
    taper_slope: f64,
    rails: Vec<Rail>,
}

impl Surface {
    /// Surface of `slider`.
    pub fn new(slider: &SliderParameters) -> Self {
        let surface = &slider.surface;
        Self {
            length_m: slider.length_m,
            width_m: slider.width_m,
            base_recess_m: surface.base_recess_m,
            crown_m: surface.crown_m,
            camber_m: surface.camber_m,
            twist_m: surface.twist_m,
            taper_length_m: surface.taper_length_m,
            taper_slope: surface.taper_angle_rad.tan(),
            rails: surface.rails.clone(),
        }
    }

    /// Length along x, m.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Width along y, m.
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// Middle of the surface, m.
    pub fn centre_m(&self) -> [f64; 2] {
        [0.5 * self.length_m, 0.5 * self.width_m]
    }

    /// Length of the leading-edge taper, m; 0 without one.
    pub fn taper_length_m(&self) -> f64 {
        if self.taper_slope == 0.0 {
            0.0
        } else {
            self.taper_length_m.max(0.0)
        }
    }

    /// Rails, later ones overwrite earlier ones.
    pub fn rails(&self) -> &[Rail] {
        &self.rails
    }

    /// Recess at a point, m. On an edge, that of the later rail.
    pub fn recess_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.rails
            .iter()
            .rev()
            .find(|rail| rail.outline.contains(x_m, y_m))
            .map_or(self.base_recess_m, |rail| rail.recess_m)
    }

    /// Mean recess over a rectangle, m, from `SAMPLES`² points at the middles of equal parts: exact
    /// where one recess covers the rectangle, and continuous to 1/`SAMPLES` of the step where a
    /// slanted edge cuts it.
    pub fn mean_recess_m(&self, x_m: [f64; 2], y_m: [f64; 2]) -> f64 {
        const SAMPLES: usize = 16;
        let at = |range: [f64; 2], k: usize| {
            range[0] + (range[1] - range[0]) * ((k as f64 + 0.5) / SAMPLES as f64)
        };
        let centre = self.recess_m(at(x_m, SAMPLES / 2), at(y_m, SAMPLES / 2));
        let sampled = [x_m, y_m].map(|range| [at(range, 0), at(range, SAMPLES - 1)]);
        if !self.rails.iter().any(|rail| rail.outline.cuts(sampled)) {
            return centre;
        }
        let mut excess = 0.0;
        for i in 0..SAMPLES {
            for j in 0..SAMPLES {
                excess += self.recess_m(at(x_m, i), at(y_m, j)) - centre;
            }
        }
        centre + excess / (SAMPLES * SAMPLES) as f64
    }

    /// Form (crown, camber, twist, taper) at a point, m, measured from the middle.
    pub fn form_m(&self, x_m: f64, y_m: f64) -> f64 {
        let [xc, yc] = self.centre_m();
        let (xi, eta) = ((x_m - xc) / xc, (y_m - yc) / yc);
        self.crown_m * xi * xi
            + self.camber_m * eta * eta
            + self.twist_m * xi * eta
            + self.taper_slope * (self.taper_length_m - x_m).max(0.0)
    }

    /// Second derivatives of the form away from the taper's end: by xx, xy, yy, 1/m.
    pub(super) fn form_curvature_per_m(&self) -> [f64; 3] {
        let [xc, yc] = self.centre_m();
        [
            2.0 * self.crown_m / (xc * xc),
            self.twist_m / (xc * yc),
            2.0 * self.camber_m / (yc * yc),
        ]
    }

    /// Gradient of the form at a point; at the end of the taper that of the flat side.
    pub(super) fn form_gradient(&self, x_m: f64, y_m: f64) -> [f64; 2] {
        let [xc, yc] = self.centre_m();
        let (xi, eta) = ((x_m - xc) / xc, (y_m - yc) / yc);
        let taper = if x_m < self.taper_length_m {
            -self.taper_slope
        } else {
            0.0
        };
        [
            (2.0 * self.crown_m * xi + self.twist_m * eta) / xc + taper,
            (2.0 * self.camber_m * eta + self.twist_m * xi) / yc,
        ]
    }

    /// Coordinates through which grid lines should run: ends, axis-parallel edges, polygon
    /// corners and the end of the taper; along x, then along y; sorted, each once.
    pub fn edge_coordinates_m(&self) -> [Vec<f64>; 2] {
        let mut x = vec![0.0, self.length_m];
        let mut y = vec![0.0, self.width_m];
        if self.taper_length_m() > 0.0 {
            x.push(self.taper_length_m);
        }
        for rail in &self.rails {
            for [px, py] in rail.outline.corners_m() {
                x.push(px);
                y.push(py);
            }
        }
        [tidy(x, self.length_m), tidy(y, self.width_m)]
    }

    /// Ranges of x, and of y, with a slanted side of a rail where the cell size determines how well its steps are
    /// resolved: sides with at least half of the normal along the direction, m.
    pub(crate) fn slanted_ranges_m(&self) -> [Vec<[f64; 2]>; 2] {
        let mut ranges = [Vec::new(), Vec::new()];
        for rail in &self.rails {
            let corners = rail.outline.corners_m();
            for (k, a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                let run = [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()];
                if run[0] == 0.0 || run[1] == 0.0 {
                    continue;
                }
                for d in 0..2 {
                    if run[1 - d] >= 0.5 * run[0].hypot(run[1]) {
                        ranges[d].push([a[d].min(b[d]), a[d].max(b[d])]);
                    }
                }
            }
        }
        ranges
    }
}

/// Sorted coordinates within 0 ... `length`, those closer than 1e-9 of it merged.
fn tidy(mut values: Vec<f64>, length: f64) -> Vec<f64> {
    values.retain(|v| (0.0..=length).contains(v));
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| (*b - *a).abs() < 1e-9 * length);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a rectangle is reported as not cut, all points of a fine raster in it agree. Cells cut by a side are
    /// found, also where neither contains a corner of the other.
    #[test]
    fn a_rectangle_that_no_side_cuts_has_one_recess() {
        // Multiples of a logarithm's digits, far apart, so that no two sequences of seven are alike.
        let mut count = 0.0;
        let mut next = || {
            count += 1.0;
            (count * count * std::f64::consts::LN_2 * 0.1).fract()
        };
        let (mut n_even, mut n_cut) = (0, 0);
        for _ in 0..4000 {
            let [a, b, c] = [0, 1, 2].map(|_| [next(), next()]);
            let x = next();
            let outlines = [
                RailOutline::Polygon {
                    points_m: vec![a, b, c],
                },
                RailOutline::Rectangle {
                    x_m: [a[0].min(b[0]), a[0].max(b[0])],
                    y_m: [a[1].min(b[1]), a[1].max(b[1])],
                },
            ];
            let (y, size) = (next(), [0.4 * next(), 0.4 * next()]);
            let rectangle = [[x, x + size[0]], [y, y + size[1]]];
            for outline in outlines {
                let at = |d: usize, k: usize| rectangle[d][0] + size[d] * k as f64 / 24.0;
                let raster = |k: usize| outline.contains(at(0, k % 25), at(1, k / 25));
                let is_even = (0..625).all(|k| raster(k) == raster(0));
                if outline.cuts(rectangle) {
                    n_cut += 1;
                } else {
                    n_even += 1;
                    assert!(is_even, "{outline:?} {rectangle:?}");
                }
            }
        }
        assert!(n_even > 4000 && n_cut > 1000, "{n_even} {n_cut}");
        let band = RailOutline::Polygon {
            points_m: vec![[-1.0, -0.9], [-0.9, -1.0], [1.0, 0.9], [0.9, 1.0]],
        };
        assert!(band.cuts([[-0.5, 0.5], [-0.5, 0.5]]));
    }
}
