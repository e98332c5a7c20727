//! Smallest clearance between the slider's true surface and the disk.
//!
//! On a region of one recess the height is a quadratic in (x, y), so over that region it is
//! smallest on the boundary or, where the surface bulges towards the disk, at its one stationary
//! point. The visible boundaries (outlines of rails where no later rail covers both sides alike, the slider's own
//! outline, the end of the taper) are cut into straight pieces once. On a piece the height is a parabola whose minimum
//! has a closed form. A call then costs a few operations per piece, most of them for eight pieces at once, and
//! allocates nothing.

use super::pieces::{Eight, Lowest, Piece};
use super::surface::Surface;
use crate::lanes::{SUMS, widest};

/// Smallest clearance and its place in slider coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Height over the disk's plane, m; negative when the surface cuts it.
    pub value_m: f64,
    /// Distance from the leading edge, m.
    pub x_m: f64,
    /// Distance from the inner edge, m.
    pub y_m: f64,
}

/// Candidates for the smallest clearance of one surface.
#[derive(Clone, Debug)]
pub struct ClearanceMap {
    surface: Surface,
    pieces: Vec<Piece>,
    /// The same pieces eight at a time.
    eights: Vec<Eight>,
    /// Inverse of the form's matrix of second derivatives where that is positive definite: xx, xy,
    /// yy, m.
    bulge_m: Option<[f64; 3]>,
}

impl ClearanceMap {
    /// Prepares the candidates of `surface`.
    pub fn new(surface: &Surface) -> Self {
        let [xx, xy, yy] = surface.form_curvature_per_m();
        let determinant = xx * yy - xy * xy;
        let bulge_m = (determinant > 0.0 && xx > 0.0)
            .then(|| [yy / determinant, -xy / determinant, xx / determinant]);
        let pieces = visible_pieces(surface);
        let centre_m = surface.centre_m();
        Self {
            surface: surface.clone(),
            eights: pieces
                .chunks(SUMS)
                .map(|some| Eight::new(some, centre_m))
                .collect(),
            pieces,
            bulge_m,
        }
    }

    /// Smallest clearance with the surface's middle `centre_height_m` over the disk (without
    /// recess), pitched and rolled.
    pub fn minimum(&self, centre_height_m: f64, pitch_rad: f64, roll_rad: f64) -> Clearance {
        let [xc, yc] = self.surface.centre_m();
        let mut best = Clearance {
            value_m: f64::INFINITY,
            x_m: xc,
            y_m: yc,
        };
        let lowest = widest(Lowest {
            eights: &self.eights,
            pieces: &self.pieces,
            centre_height_m,
            pitch_rad,
            roll_rad,
        });
        if lowest.value_m < best.value_m {
            let Piece {
                start_m: [x0, y0],
                span_m: [dx, dy],
                ..
            } = self.pieces[lowest.piece];
            best = Clearance {
                value_m: lowest.value_m,
                x_m: x0 + lowest.at * dx,
                y_m: y0 + lowest.at * dy,
            };
        }
        if let Some([a, b, d]) = self.bulge_m {
            let taper = self.surface.taper_length_m();
            for on_taper in [false, true] {
                // Gradient at the middle, continued from the taper where the point is sought there.
                let x_from = if on_taper {
                    0.0
                } else {
                    self.surface.length_m()
                };
                if on_taper && taper == 0.0 {
                    continue;
                }
                let [gx, gy] = self.surface.form_gradient(x_from, yc);
                let (gx, gy) = (gx - pitch_rad, gy + roll_rad);
                let (x, y) = (x_from - (a * gx + b * gy), yc - (b * gx + d * gy));
                let inside = (0.0..=self.surface.length_m()).contains(&x)
                    && (0.0..=self.surface.width_m()).contains(&y)
                    && (x < taper) == on_taper;
                if inside {
                    let value = centre_height_m - pitch_rad * (x - xc)
                        + roll_rad * (y - yc)
                        + self.surface.form_m(x, y)
                        + self.surface.recess_m(x, y);
                    if value < best.value_m {
                        best = Clearance {
                            value_m: value,
                            x_m: x,
                            y_m: y,
                        };
                    }
                }
            }
        }
        best
    }
}

/// Cuts all outlines at each other and keeps the pieces with different recess on both sides, on the
/// slider's outline, or at the end of the taper.
fn visible_pieces(surface: &Surface) -> Vec<Piece> {
    let [l, w] = [surface.length_m(), surface.width_m()];
    let outline = [[0.0, 0.0], [l, 0.0], [l, w], [0.0, w]];
    let mut segments: Vec<[[f64; 2]; 2]> = Vec::new();
    let mut add_outline = |corners: &[[f64; 2]]| {
        for (k, &corner) in corners.iter().enumerate() {
            segments.push([corner, corners[(k + 1) % corners.len()]]);
        }
    };
    add_outline(&outline);
    for rail in surface.rails() {
        add_outline(&rail.outline.corners_m());
    }
    let taper = surface.taper_length_m();
    if taper > 0.0 && taper < l {
        segments.push([[taper, 0.0], [taper, w]]);
    }

    let nudge = 1e-7 * l.min(w);
    let mut pieces = Vec::new();
    for segment in &segments {
        let mut cuts = vec![0.0, 1.0];
        for other in &segments {
            cuts.extend(crossings(segment, other));
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| *b - *a < 1e-12);
        let [[x0, y0], [x1, y1]] = *segment;
        let (dx, dy) = (x1 - x0, y1 - y0);
        let length = dx.hypot(dy);
        if length == 0.0 {
            continue;
        }
        for cut in cuts.windows(2) {
            let [from, to] = [cut[0], cut[1]];
            let middle = 0.5 * (from + to);
            let (xm, ym) = (x0 + middle * dx, y0 + middle * dy);
            let (nx, ny) = (-dy / length * nudge, dx / length * nudge);
            let sides = [[xm + nx, ym + ny], [xm - nx, ym - ny]].map(|[x, y]| {
                ((0.0..=l).contains(&x) && (0.0..=w).contains(&y)).then(|| surface.recess_m(x, y))
            });
            let at_taper = taper > 0.0 && dx == 0.0 && (x0 - taper).abs() <= nudge;
            let recess = match sides {
                [None, None] => continue,
                [Some(r), None] | [None, Some(r)] => r,
                [Some(r), Some(s)] if r == s && !at_taper => continue,
                [Some(r), Some(s)] => r.min(s),
            };
            let start_m = [x0 + from * dx, y0 + from * dy];
            let span_m = [(to - from) * dx, (to - from) * dy];
            pieces.push(piece(surface, start_m, span_m, recess));
        }
    }
    pieces
}

/// Parabola of recess and form along a straight piece; pieces do not cross the end of the taper.
fn piece(surface: &Surface, start_m: [f64; 2], span_m: [f64; 2], recess_m: f64) -> Piece {
    let form = |s: f64| surface.form_m(start_m[0] + s * span_m[0], start_m[1] + s * span_m[1]);
    let (f0, f1) = (form(0.0), form(1.0));
    let [xx, xy, yy] = surface.form_curvature_per_m();
    let curvature_m = 0.5
        * (xx * span_m[0] * span_m[0]
            + 2.0 * xy * span_m[0] * span_m[1]
            + yy * span_m[1] * span_m[1]);
    Piece {
        start_m,
        span_m,
        height_m: recess_m + f0,
        slope_m: f1 - f0 - curvature_m,
        curvature_m,
    }
}

/// Parameters on `a` at which `b` crosses it or, when collinear, ends on it.
fn crossings(a: &[[f64; 2]; 2], b: &[[f64; 2]; 2]) -> Vec<f64> {
    let d = [a[1][0] - a[0][0], a[1][1] - a[0][1]];
    let e = [b[1][0] - b[0][0], b[1][1] - b[0][1]];
    let offset = [b[0][0] - a[0][0], b[0][1] - a[0][1]];
    let cross = d[0] * e[1] - d[1] * e[0];
    let (dd, ee) = (d[0] * d[0] + d[1] * d[1], e[0] * e[0] + e[1] * e[1]);
    let within = |t: &f64| (0.0..=1.0).contains(t);
    if cross.abs() > 1e-12 * (dd * ee).sqrt() {
        let t = (offset[0] * e[1] - offset[1] * e[0]) / cross;
        let s = (offset[0] * d[1] - offset[1] * d[0]) / cross;
        let touches = (-1e-9..=1.0 + 1e-9).contains(&s);
        return Some(t)
            .filter(|t| touches && within(t))
            .into_iter()
            .collect();
    }
    if (offset[0] * d[1] - offset[1] * d[0]).abs() > 1e-9 * dd {
        return Vec::new();
    }
    b.iter()
        .map(|p| ((p[0] - a[0][0]) * d[0] + (p[1] - a[0][1]) * d[1]) / dd)
        .filter(within)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};

    /// Overlapping rectangles and a polygon, one of them hiding the lowest part of another.
    fn surface(crown_m: f64, camber_m: f64, twist_m: f64) -> Surface {
        let rail = |outline, recess_m| Rail { outline, recess_m };
        Surface::new(&SliderParameters {
            radius_m: 0.02,
            angle_rad: 0.0,
            skew_rad: 0.0,
            length_m: 850e-6,
            width_m: 700e-6,
            height_m: 230e-6,
            density_kg_per_m3: 4300.0,
            surface: SurfaceParameters {
                base_recess_m: 1e-6,
                crown_m,
                camber_m,
                twist_m,
                taper_length_m: 120e-6,
                taper_angle_rad: 2e-3,
                rails: vec![
                    rail(
                        RailOutline::Rectangle {
                            x_m: [0.0, 800e-6],
                            y_m: [50e-6, 650e-6],
                        },
                        0.0,
                    ),
                    rail(
                        RailOutline::Polygon {
                            points_m: vec![
                                [500e-6, 40e-6],
                                [820e-6, 120e-6],
                                [700e-6, 660e-6],
                                [480e-6, 400e-6],
                            ],
                        },
                        0.3e-6,
                    ),
                    rail(
                        RailOutline::Rectangle {
                            x_m: [550e-6, 600e-6],
                            y_m: [300e-6, 350e-6],
                        },
                        0.01e-6,
                    ),
                ],
            },
        })
    }

    #[test]
    fn minimum_is_that_of_a_dense_sampling() {
        for (crown, camber, twist) in [
            (15e-9, 2e-9, 0.0),
            (0.0, 0.0, 0.0),
            (-20e-9, 4e-9, 3e-9),
            (200e-9, 150e-9, 30e-9),
        ] {
            let surface = surface(crown, camber, twist);
            let map = ClearanceMap::new(&surface);
            let [xc, yc] = surface.centre_m();
            for (pitch, roll) in [
                (0.0, 0.0),
                (1.1e-4, 0.0),
                (-2e-4, 1e-4),
                (3e-5, -3e-4),
                (4e-4, 2e-4),
            ] {
                let found = map.minimum(5e-8, pitch, roll);
                let height = |x: f64, y: f64| {
                    5e-8 - pitch * (x - xc)
                        + roll * (y - yc)
                        + surface.form_m(x, y)
                        + surface.recess_m(x, y)
                };
                let mut sampled = f64::INFINITY;
                for i in 0..=1700 {
                    for j in 0..=1400 {
                        sampled = sampled.min(height(i as f64 * 0.5e-6, j as f64 * 0.5e-6));
                    }
                }
                let spacing = 0.5e-6 * (pitch.abs() + roll.abs() + 2e-3);
                assert!(found.value_m <= sampled + 1e-18, "{found:?} {sampled:e}");
                assert!(found.value_m > sampled - spacing, "{found:?} {sampled:e}");
                // The returned place has that height, approached from the lower side of its edge.
                let near = [-1e-12, 0.0, 1e-12]
                    .into_iter()
                    .flat_map(|dx| {
                        [-1e-12, 0.0, 1e-12].map(|dy| height(found.x_m + dx, found.y_m + dy))
                    })
                    .fold(f64::INFINITY, |best, h| {
                        if (h - found.value_m).abs() < (best - found.value_m).abs() {
                            h
                        } else {
                            best
                        }
                    });
                assert!((near - found.value_m).abs() < 1e-14, "{found:?} {near:e}");
            }
        }
    }

    /// Evaluation in groups of eight gives the same bits as one after the other.
    #[test]
    fn eights_are_read_as_pieces_one_by_one() {
        for (crown, camber, twist) in [(15e-9, 2e-9, 0.0), (0.0, 0.0, 0.0), (-20e-9, 4e-9, 3e-9)] {
            let surface = surface(crown, camber, twist);
            let map = ClearanceMap::new(&surface);
            assert!(map.pieces.len() > SUMS && !map.pieces.len().is_multiple_of(SUMS));
            let [xc, yc] = surface.centre_m();
            for k in 0..200 {
                let (pitch, roll) = (
                    3e-4 * (1.3 * f64::from(k)).sin(),
                    2e-4 * (2.9 * f64::from(k)).cos(),
                );
                let mut wanted = (f64::INFINITY, [0.0; 2]);
                for piece in &map.pieces {
                    let ([x0, y0], [dx, dy]) = (piece.start_m, piece.span_m);
                    let start = piece.height_m + 5e-8 - pitch * (x0 - xc) + roll * (y0 - yc);
                    let slope = piece.slope_m - pitch * dx + roll * dy;
                    let curvature = piece.curvature_m;
                    let mut points = vec![(start, 0.0), (start + slope + curvature, 1.0)];
                    let s = -0.5 * slope / curvature;
                    if curvature > 0.0 && s > 0.0 && s < 1.0 {
                        points = vec![(start + 0.5 * slope * s, s)];
                    }
                    for (value, s) in points {
                        if value < wanted.0 {
                            wanted = (value, [x0 + s * dx, y0 + s * dy]);
                        }
                    }
                }
                let found = map.minimum(5e-8, pitch, roll);
                if found.value_m < wanted.0 {
                    // In the middle of a face.
                    assert!(map.bulge_m.is_some());
                    continue;
                }
                assert_eq!(found.value_m.to_bits(), wanted.0.to_bits());
                assert_eq!([found.x_m, found.y_m], wanted.1);
            }
        }
    }
}
