//! Adds pulse widths where a curve of critical shocks bends, and where two curves cross.
//!
//! A curve is what one ramp model answers at one sign and one set of further axes, over the
//! width. In logarithms, `x = ln w` and `y = ln A`, straight lines between neighbouring answers
//! miss the curve by
//!
//! ```text
//! e = |k| L^2 / 8,   k = 2 (s_r - s_l) / (x_r - x_l)
//! ```
//!
//! with the length `L` of the interval and the larger curvature `k` of its two ends, each from the
//! slopes `s` on both sides and the places `x_l`, `x_r` of its neighbours. An interval whose `e`
//! exceeds the tolerance is halved. At a kink `e` falls with `L`, at a jump it does not: there the
//! halving ends at the closest widths allowed. A curve of two answers shows no curvature and is
//! halved once.
//!
//! Two curves cross between neighbouring common widths at which they lie in opposite order; such an interval is halved,
//! for both, until it is short enough. Equal answers, as below first touch or within one bracket, give no order; a
//! crossing may lie among them.
//!
//! A round of new widths is a function of the answers of all rounds before, so the same answers always add the same
//! widths. Answers of earlier rounds never change.

use std::cmp::Ordering;

use super::order::{Coordinates, Ramp};

/// Limits by which widths are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedPoints {
    /// Largest error of straight lines between neighbours, a share; `None`: no limit.
    pub tolerance: Option<f64>,
    /// Largest distance of widths between which two curves cross, a share; `None`: no limit.
    pub crossing: Option<f64>,
    /// Smallest distance of two widths, a share.
    pub closest: f64,
    /// Largest number of points added, in all rounds together.
    pub most_points: usize,
}

/// A point with its final answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answered {
    /// Place among the others.
    pub at: Coordinates,
    /// Its answer, G; `None` when it has no bracket.
    pub answer_g: Option<f64>,
}

/// A point to add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// A point of the same curve, by its place among the answered ones.
    pub like: usize,
    /// Width, ms.
    pub pulse_ms: f64,
}

/// Where two curves cross.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The two points below the crossing, by their places: that of the lower curve there first.
    pub below: (usize, usize),
    /// Nearest common widths on both sides at which the answers differ, ms.
    pub between_ms: (f64, f64),
    /// Where straight lines between them cross, ms.
    pub pulse_ms: f64,
    /// Answer there, G.
    pub answer_g: f64,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
struct Node {
    place: usize,
    pulse_ms: f64,
    x: f64,
    y: Option<f64>,
}

/// Points of one ramp, sign and set of axes, ascending width.
struct Curve<'a> {
    at: &'a Coordinates,
    nodes: Vec<Node>,
}

impl Curve<'_> {
    fn has(&self, pulse_ms: f64) -> bool {
        self.nodes.iter().any(|node| node.pulse_ms == pulse_ms)
    }

    fn is_beside(&self, other: &Curve<'_>) -> bool {
        self.at.sign == other.at.sign && self.at.axes == other.at.axes
    }

    /// Curvature at a point from its neighbours, where all three have answers.
    fn curvature(&self, place: usize) -> Option<f64> {
        let [a, b, c] = [place.checked_sub(1)?, place, place + 1].map(|i| self.nodes.get(i));
        let (a, b, c) = (a?, b?, c?);
        let slope = |from: &Node, to: &Node| Some((to.y? - from.y?) / (to.x - from.x));
        Some(2.0 * (slope(b, c)? - slope(a, b)?) / (c.x - a.x))
    }

    /// Error of the straight line between a point and the next; infinite when nothing shows it.
    fn error(&self, place: usize) -> Option<f64> {
        let (a, b) = (self.nodes.get(place)?, self.nodes.get(place + 1)?);
        if a.y.is_none() || b.y.is_none() {
            return None;
        }
        let ends = [self.curvature(place), self.curvature(place + 1)];
        let curvature = ends.into_iter().flatten().map(f64::abs).reduce(f64::max);
        let length = b.x - a.x;
        match curvature {
            Some(curvature) => Some(curvature * length * length / 8.0),
            // Two answers alone, or no third beside them.
            None => Some(f64::INFINITY).filter(|_| self.nodes.len() == 2),
        }
    }
}

/// An interval to halve, for one curve or two.
struct Halving {
    /// Ratio of the error to its limit, 1 when it is just met.
    excess: f64,
    pulse_ms: f64,
    curves: Vec<usize>,
}

/// Points to add to those answered; none when the curves meet the limits.
pub fn wanted(refine: &AddedPoints, answered: &[Answered]) -> Vec<Wanted> {
    let curves = curves(answered);
    let added = answered.iter().filter(|point| point.at.round > 0).count();
    let mut left = refine.most_points.saturating_sub(added);
    let mut halvings = bends(refine, &curves);
    halvings.extend(unordered(refine, &curves));
    // The worst first; equal ones as the curves come.
    halvings.sort_by(|a, b| {
        let worst = b.excess.partial_cmp(&a.excess).unwrap_or(Ordering::Equal);
        worst.then(a.pulse_ms.total_cmp(&b.pulse_ms))
    });
    let mut chosen: Vec<(usize, f64)> = Vec::new();
    for halving in halvings {
        let mut new: Vec<(usize, f64)> = Vec::new();
        for &curve in &halving.curves {
            // Below first touch the answer is that without ramp, which is needed too.
            for curve in [bare(&curves, curve), Some(curve)].into_iter().flatten() {
                let point = (curve, halving.pulse_ms);
                let is_known = curves[curve].has(point.1) || chosen.contains(&point);
                if !is_known && !new.contains(&point) {
                    new.push(point);
                }
            }
        }
        if new.len() > left {
            break;
        }
        left -= new.len();
        chosen.extend(new);
    }
    chosen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let point = |(curve, pulse_ms): (usize, f64)| Wanted {
        like: curves[curve].nodes[0].place,
        pulse_ms,
    };
    chosen.into_iter().map(point).collect()
}

/// Every crossing of two curves, by curves and ascending width.
pub fn crossings(answered: &[Answered]) -> Vec<Crossing> {
    let curves = curves(answered);
    let mut found = Vec::new();
    for (a, b) in pairs(&curves) {
        for (low, high) in opposite(&curves[a], &curves[b]) {
            let [d_low, d_high] = [low, high].map(|(a, b)| a.1 - b.1);
            let share = d_low / (d_low - d_high);
            let along = |from: f64, to: f64| (from + share * (to - from)).exp();
            let (lower, upper) = if d_low < 0.0 { low } else { (low.1, low.0) };
            found.push(Crossing {
                below: (lower.0.place, upper.0.place),
                between_ms: (low.0.0.pulse_ms, high.0.0.pulse_ms),
                pulse_ms: along(low.0.0.x, high.0.0.x),
                answer_g: along(low.0.1, high.0.1),
            });
        }
    }
    found
}

fn curves(answered: &[Answered]) -> Vec<Curve<'_>> {
    let mut curves: Vec<Curve<'_>> = Vec::new();
    for (place, point) in answered.iter().enumerate() {
        let node = Node {
            place,
            pulse_ms: point.at.pulse_ms,
            x: point.at.pulse_ms.ln(),
            y: point.answer_g.map(f64::ln),
        };
        let same = |curve: &&mut Curve<'_>| {
            let (a, b) = (curve.at, &point.at);
            a.ramp == b.ramp && a.sign == b.sign && a.axes == b.axes
        };
        match curves.iter_mut().find(same) {
            Some(curve) => curve.nodes.push(node),
            None => curves.push(Curve {
                at: &point.at,
                nodes: vec![node],
            }),
        }
    }
    for curve in &mut curves {
        curve.nodes.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    curves.sort_by(|a, b| {
        let (a, b) = (a.at, b.at);
        a.axes
            .cmp(&b.axes)
            .then(a.sign.cmp(&b.sign))
            .then(a.ramp.cmp(&b.ramp))
    });
    curves
}

/// The curve without ramp beside a curve with one.
fn bare(curves: &[Curve<'_>], curve: usize) -> Option<usize> {
    let is_bare =
        |other: &Curve<'_>| other.at.ramp == Ramp::None && other.is_beside(&curves[curve]);
    (curves[curve].at.ramp != Ramp::None)
        .then(|| curves.iter().position(is_bare))
        .flatten()
}

/// Curves of different ramps at the same sign and axes.
fn pairs(curves: &[Curve<'_>]) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    for a in 0..curves.len() {
        for b in a + 1..curves.len() {
            if curves[a].is_beside(&curves[b]) {
                pairs.push((a, b));
            }
        }
    }
    pairs
}

/// Intervals whose straight line misses the curve by more than the limit.
fn bends(refine: &AddedPoints, curves: &[Curve<'_>]) -> Vec<Halving> {
    let Some(tolerance) = refine.tolerance else {
        return Vec::new();
    };
    let mut halvings = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        for (place, pair) in curve.nodes.windows(2).enumerate() {
            if let Some(error) = curve.error(place)
                && error > tolerance
                && let Some(pulse_ms) = middle_ms(refine, [&pair[0], &pair[1]], &[curve])
            {
                halvings.push(Halving {
                    excess: error / tolerance,
                    pulse_ms,
                    curves: vec![number],
                });
            }
        }
    }
    halvings
}

/// Intervals in which two curves cross that are longer than the limit.
fn unordered(refine: &AddedPoints, curves: &[Curve<'_>]) -> Vec<Halving> {
    let Some(crossing) = refine.crossing else {
        return Vec::new();
    };
    let mut halvings = Vec::new();
    for (a, b) in pairs(curves) {
        for (low, high) in opposite(&curves[a], &curves[b]) {
            let (low, high) = (low.0.0, high.0.0);
            let excess = (high.x - low.x) / crossing.ln_1p();
            if excess > 1.0
                && let Some(pulse_ms) = middle_ms(refine, [&low, &high], &[&curves[a], &curves[b]])
            {
                halvings.push(Halving {
                    excess,
                    pulse_ms,
                    curves: vec![a, b],
                });
            }
        }
    }
    halvings
}

type Both = ((Node, f64), (Node, f64));

/// Neighbouring common widths at which two curves lie in opposite order; those in between, if
/// any, have equal answers.
fn opposite(a: &Curve<'_>, b: &Curve<'_>) -> Vec<(Both, Both)> {
    let mut found = Vec::new();
    let mut last: Option<Both> = None;
    for &of_a in &a.nodes {
        let at_width = |node: &&Node| node.pulse_ms == of_a.pulse_ms;
        let Some(&of_b) = b.nodes.iter().find(at_width) else {
            continue;
        };
        let Some((y_a, y_b)) = of_a.y.zip(of_b.y) else {
            last = None;
            continue;
        };
        if y_a == y_b {
            continue;
        }
        let both = ((of_a, y_a), (of_b, y_b));
        if let Some(before) = last
            && (before.0.1 < before.1.1) != (y_a < y_b)
        {
            found.push((before, both));
        }
        last = Some(both);
    }
    found
}

/// The geometric middle of two widths to four digits, if it keeps its distance from every width of these curves.
fn middle_ms(refine: &AddedPoints, [low, high]: [&Node; 2], curves: &[&Curve<'_>]) -> Option<f64> {
    let middle_ms = (low.pulse_ms * high.pulse_ms).sqrt();
    let middle_ms: f64 = format!("{middle_ms:.3e}").parse().ok()?;
    let is_apart = |node: &Node| {
        let ratio = node.pulse_ms / middle_ms;
        ratio.max(1.0 / ratio) >= 1.0 + refine.closest
    };
    let mut widths = curves.iter().flat_map(|curve| &curve.nodes);
    widths.all(is_apart).then_some(middle_ms)
}

#[cfg(test)]
mod tests;
