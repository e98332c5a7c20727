//! Thins, clips and dashes polylines. All in pixels.

use super::figure::Dash;

type Point = (f64, f64);

/// Keeps first, lowest, highest and last of every half pixel column: the picture stays the same,
/// peaks included, whatever the number of samples. Points with NaN are kept, they break the line.
pub(super) fn thinned(points: &[Point]) -> Vec<Point> {
    let column = |x: f64| (2.0 * x).floor();
    let mut kept = Vec::with_capacity(points.len().min(8192));
    let mut start = 0;
    while start < points.len() {
        let here = column(points[start].0);
        let mut end = start + 1;
        let broken = |p: &Point| !p.0.is_finite() || !p.1.is_finite();
        if broken(&points[start]) {
            kept.push(points[start]);
            start = end;
            continue;
        }
        while end < points.len() && !broken(&points[end]) && column(points[end].0) == here {
            end += 1;
        }
        let run = &points[start..end];
        let by = |better: fn(f64, f64) -> bool| {
            (1..run.len()).fold(0, |best, i| {
                if better(run[i].1, run[best].1) {
                    i
                } else {
                    best
                }
            })
        };
        let mut indices = [0, by(|a, b| a < b), by(|a, b| a > b), run.len() - 1];
        indices.sort_unstable();
        for (i, index) in indices.iter().enumerate() {
            if i == 0 || *index != indices[i - 1] {
                kept.push(run[*index]);
            }
        }
        start = end;
    }
    kept
}

/// Pieces of the line inside the box `(x0, y0, x1, y1)` (Liang-Barsky per segment); NaN breaks it.
pub(super) fn clipped(points: &[Point], bounds: (f64, f64, f64, f64)) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let Some((a, b)) = clip_segment(pair[0], pair[1], bounds) else {
            open = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if open && piece.last() == Some(&a) => piece.push(b),
            _ => pieces.push(vec![a, b]),
        }
        open = b == pair[1];
    }
    pieces
}

fn clip_segment(
    a: Point,
    b: Point,
    (x0, y0, x1, y1): (f64, f64, f64, f64),
) -> Option<(Point, Point)> {
    if ![a.0, a.1, b.0, b.1].iter().all(|v| v.is_finite()) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for (towards, room) in [
        (-dx, a.0 - x0),
        (dx, x1 - a.0),
        (-dy, a.1 - y0),
        (dy, y1 - a.1),
    ] {
        if towards == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if towards < 0.0 {
            enter = enter.max(room / towards);
        } else {
            leave = leave.min(room / towards);
        }
    }
    if enter > leave {
        return None;
    }
    let at = |share: f64| (a.0 + share * dx, a.1 + share * dy);
    Some((
        if enter > 0.0 { at(enter) } else { a },
        if leave < 1.0 { at(leave) } else { b },
    ))
}

/// The drawn stretches of a dashed line; the pattern runs on across corners.
pub(super) fn dashed(points: &[Point], dash: Dash) -> Vec<Vec<Point>> {
    let pattern: &[f64] = match dash {
        Dash::Solid => return vec![points.to_vec()],
        Dash::Dashed => &[7.0, 4.0],
        Dash::Dotted => &[1.5, 3.0],
        Dash::DashDot => &[8.0, 3.0, 1.5, 3.0],
    };
    let mut pieces = Vec::new();
    let (mut phase, mut left) = (0, pattern[0]);
    let mut piece = vec![points[0]];
    for pair in points.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length <= left {
                left -= length;
                if phase % 2 == 0 {
                    piece.push(b);
                }
                break;
            }
            let share = left / length;
            a = (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1));
            if phase % 2 == 0 {
                piece.push(a);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![a];
            }
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
    }
    if phase % 2 == 0 && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}
