//! Geometry of plane polygons: area, order of corners, crossing edges.

/// Area, half the sum of cross products; positive counter-clockwise.
pub fn signed_area(corners: &[[f64; 2]]) -> f64 {
    let n = corners.len();
    0.5 * (0..n)
        .map(|i| {
            let ([x0, y0], [x1, y1]) = (corners[i], corners[(i + 1) % n]);
            x0 * y1 - x1 * y0
        })
        .sum::<f64>()
}

/// Whether all corners lie on one line.
pub fn on_one_line(corners: &[[f64; 2]]) -> bool {
    let Some(&[x0, y0]) = corners.first() else {
        return true;
    };
    let Some(&[x1, y1]) = corners.iter().find(|corner| **corner != [x0, y0]) else {
        return true;
    };
    corners
        .iter()
        .all(|[x, y]| (x1 - x0) * (y - y0) == (y1 - y0) * (x - x0))
}

/// The first two edges (by the corner they start from) that cross or touch though they are no
/// neighbours, or overlap though they are.
pub fn crossing_edges(corners: &[[f64; 2]]) -> Option<(usize, usize)> {
    let n = corners.len();
    let edge = |i: usize| (corners[i], corners[(i + 1) % n]);
    for i in 0..n {
        for j in i + 1..n {
            let neighbours = j == i + 1 || (i == 0 && j == n - 1);
            let ((a, b), (c, d)) = (edge(i), edge(j));
            let bad = if neighbours {
                folds_back(corners, if j == i + 1 { j } else { 0 })
            } else {
                meet(a, b, c, d)
            };
            if bad {
                return Some((i, j));
            }
        }
    }
    None
}

/// Whether the two edges at a corner lie on each other.
fn folds_back(corners: &[[f64; 2]], at: usize) -> bool {
    let n = corners.len();
    let (before, here, after) = (
        corners[(at + n - 1) % n],
        corners[at],
        corners[(at + 1) % n],
    );
    let (ux, uy) = (before[0] - here[0], before[1] - here[1]);
    let (vx, vy) = (after[0] - here[0], after[1] - here[1]);
    ux * vy - uy * vx == 0.0 && ux * vx + uy * vy > 0.0
}

fn meet(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let within = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        r[0] >= p[0].min(q[0])
            && r[0] <= p[0].max(q[0])
            && r[1] >= p[1].min(q[1])
            && r[1] <= p[1].max(q[1])
    };
    let (s1, s2, s3, s4) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    if s1 * s2 < 0.0 && s3 * s4 < 0.0 {
        return true;
    }
    (s1 == 0.0 && within(a, b, c))
        || (s2 == 0.0 && within(a, b, d))
        || (s3 == 0.0 && within(c, d, a))
        || (s4 == 0.0 && within(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_simple_and_a_bow_tie_is_not() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert_eq!(signed_area(&square), 4.0);
        assert_eq!(crossing_edges(&square), None);
        let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(crossing_edges(&bow), Some((0, 2)));
    }

    #[test]
    fn an_edge_through_a_corner_and_a_fold_are_found() {
        let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]];
        assert!(crossing_edges(&touching).is_some());
        let folded = [[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, 3.0]];
        assert!(crossing_edges(&folded).is_some());
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(crossing_edges(&triangle), None);
    }
}
