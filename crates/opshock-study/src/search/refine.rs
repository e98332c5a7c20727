//! Widths added where a curve of answers bends, and where two curves cross.
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
//! Two curves cross between neighbouring common widths at which they lie in opposite order; such
//! an interval is halved, for both, until it is short enough. Answers that are equal, as below
//! first touch or within one bracket, order nothing; a crossing may lie among them.
//!
//! A round of new widths is a function of the answers of all rounds before, so that whoever knows
//! the same answers adds the same widths. Answers of earlier rounds never change.

use std::cmp::Ordering;

use super::order::{Coordinates, RampClass};

/// How widths are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refine {
    /// Straight lines between neighbours are to be this good, a share; `None`: not asked for.
    pub tolerance: Option<f64>,
    /// Widths between which two curves cross are to be this close, a share; `None`: not asked for.
    pub crossing: Option<f64>,
    /// No two widths become closer than this, a share.
    pub closest: f64,
    /// Points added at most, in all rounds together.
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

    /// Curvature at a node from its neighbours, where all three have answers.
    fn curvature(&self, place: usize) -> Option<f64> {
        let [a, b, c] = [place.checked_sub(1)?, place, place + 1].map(|i| self.nodes.get(i));
        let (a, b, c) = (a?, b?, c?);
        let slope = |from: &Node, to: &Node| Some((to.y? - from.y?) / (to.x - from.x));
        Some(2.0 * (slope(b, c)? - slope(a, b)?) / (c.x - a.x))
    }

    /// What straight lines miss between a node and the next; infinite when nothing tells.
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
    /// By how much the goal is missed, 1 when it is just met.
    excess: f64,
    pulse_ms: f64,
    curves: Vec<usize>,
}

/// Points to add to those answered, none when the curves are as good as asked.
pub fn wanted(refine: &Refine, answered: &[Answered]) -> Vec<Wanted> {
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
            .then(a.ramp_class.cmp(&b.ramp_class))
            .then_with(|| a.ramp.cmp(&b.ramp))
    });
    curves
}

/// The curve without ramp beside a curve with one.
fn bare(curves: &[Curve<'_>], curve: usize) -> Option<usize> {
    let is_bare = |other: &Curve<'_>| {
        other.at.ramp_class == RampClass::None && other.is_beside(&curves[curve])
    };
    (curves[curve].at.ramp_class != RampClass::None)
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

/// Intervals whose straight line misses the curve by more than asked.
fn bends(refine: &Refine, curves: &[Curve<'_>]) -> Vec<Halving> {
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

/// Intervals in which two curves cross that are longer than asked.
fn unordered(refine: &Refine, curves: &[Curve<'_>]) -> Vec<Halving> {
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
fn middle_ms(refine: &Refine, [low, high]: [&Node; 2], curves: &[&Curve<'_>]) -> Option<f64> {
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
mod tests {
    use super::*;
    use crate::search::Sign;

    const REFINE: Refine = Refine {
        tolerance: Some(0.02),
        crossing: None,
        closest: 0.01,
        most_points: 100,
    };

    fn at(class: RampClass, pulse_ms: f64) -> Coordinates {
        Coordinates {
            ramp_class: class,
            ramp: format!("{class:?}"),
            pulse_ms,
            sign: Sign::Plus,
            axes: Vec::new(),
            round: 0,
        }
    }

    fn answers(class: RampClass, widths: &[f64], law: impl Fn(f64) -> f64) -> Vec<Answered> {
        let point = |&pulse_ms: &f64| Answered {
            at: at(class, pulse_ms),
            answer_g: Some(law(pulse_ms)),
        };
        widths.iter().map(point).collect()
    }

    /// Adds rounds until nothing is wanted; the largest number of rounds is 30.
    fn refined(
        refine: &Refine,
        mut points: Vec<Answered>,
        law: impl Fn(&Coordinates) -> f64,
    ) -> Vec<Answered> {
        for round in 1..30 {
            let wanted = wanted(refine, &points);
            if wanted.is_empty() {
                return points;
            }
            for Wanted { like, pulse_ms } in wanted {
                let at = Coordinates {
                    pulse_ms,
                    round,
                    ..points[like].at.clone()
                };
                points.push(Answered {
                    answer_g: Some(law(&at)),
                    at,
                });
            }
        }
        panic!("refinement does not end");
    }

    #[test]
    fn a_power_law_is_straight_and_needs_nothing() {
        let points = answers(RampClass::None, &[0.5, 0.8, 3.0], |w| 300.0 * w.powf(-0.4));
        assert!(wanted(&REFINE, &points).is_empty());
        // Two answers tell no curvature: one more is asked for.
        let wanted = wanted(&REFINE, &points[..2]);
        assert_eq!(wanted.len(), 1);
        assert_eq!(wanted[0].pulse_ms, 0.6325);
    }

    #[test]
    fn straight_lines_between_the_answers_become_as_good_as_asked() {
        // A smooth bend and a kink at 1.3 ms.
        let smooth = |w: f64| 300.0 * (1.0 + (w.ln() * 2.0).powi(2)).sqrt();
        let kinked = |w: f64| 300.0 * (w / 1.3).powf(if w < 1.3 { -1.0 } else { 0.8 });
        let laws: [&dyn Fn(f64) -> f64; 2] = [&smooth, &kinked];
        for law in laws {
            let start = answers(RampClass::None, &[0.5, 1.0, 2.0, 4.0], law);
            let mut points = refined(&REFINE, start, |at| law(at.pulse_ms));
            points.sort_by(|a, b| a.at.pulse_ms.total_cmp(&b.at.pulse_ms));
            let mut worst = 0.0_f64;
            for pair in points.windows(2) {
                let [a, b] = [&pair[0], &pair[1]];
                for part in 1..20 {
                    let share = f64::from(part) / 20.0;
                    let between = |a: f64, b: f64| (a.ln() + share * (b / a).ln()).exp();
                    let line = between(a.answer_g.unwrap_or(1.0), b.answer_g.unwrap_or(1.0));
                    let truth = law(between(a.at.pulse_ms, b.at.pulse_ms));
                    worst = worst.max((line / truth).ln().abs());
                }
            }
            // The estimate is that of a parabola; at a kink lines miss up to twice as much.
            assert!(worst < 0.04, "{worst}");
            assert!(points.len() < 30, "{}", points.len());
        }
    }

    #[test]
    fn a_jump_is_closed_in_and_no_more() {
        let law = |w: f64| if w < 1.234 { 200.0 } else { 400.0 };
        let start = answers(RampClass::None, &[0.5, 1.0, 2.0, 4.0], law);
        let points = refined(&REFINE, start, |at| law(at.pulse_ms));
        let mut widths: Vec<f64> = points.iter().map(|point| point.at.pulse_ms).collect();
        widths.sort_by(f64::total_cmp);
        let at = widths.partition_point(|&w| w < 1.234);
        let ratio = widths[at] / widths[at - 1];
        assert!((1.01..1.0301).contains(&ratio), "{ratio}");
        assert!(widths.windows(2).all(|pair| pair[1] / pair[0] >= 1.01));
    }

    #[test]
    fn the_limit_of_points_holds_and_the_worst_comes_first() {
        let law = |w: f64| if w < 1.234 { 200.0 } else { 400.0 };
        let start = answers(RampClass::None, &[0.5, 1.0, 2.0, 4.0], law);
        let refine = Refine {
            most_points: 3,
            ..REFINE
        };
        let points = refined(&refine, start, |at| law(at.pulse_ms));
        assert_eq!(points.len(), 7);
    }

    #[test]
    fn a_crossing_is_closed_in_for_both_curves_and_the_one_without_ramp() {
        // 300 w^-0.5 and 200 w^0.3 meet at (3/2)^(1/0.8) = 1.6600 ms.
        let law = |at: &Coordinates| match at.ramp_class {
            RampClass::None => 900.0,
            RampClass::Rigid => 300.0 * at.pulse_ms.powf(-0.5),
            RampClass::Deformable => 200.0 * at.pulse_ms.powf(0.3),
        };
        let mut start = Vec::new();
        for class in [RampClass::None, RampClass::Rigid, RampClass::Deformable] {
            start.extend(answers(class, &[0.5, 1.0, 3.0], |w| law(&at(class, w))));
        }
        let refine = Refine {
            tolerance: None,
            crossing: Some(0.05),
            ..REFINE
        };
        let points = refined(&refine, start, law);
        let found = crossings(&points);
        assert_eq!(found.len(), 1);
        let truth = 1.5_f64.powf(1.25);
        let Crossing {
            between_ms: (low, high),
            pulse_ms,
            answer_g,
            below,
        } = found[0];
        assert!(
            low < truth && truth < high && high / low <= 1.05,
            "{low} {high}"
        );
        // Both are straight in logarithms.
        assert!((pulse_ms / truth - 1.0).abs() < 1e-9, "{pulse_ms}");
        assert!((answer_g / (300.0 * truth.powf(-0.5)) - 1.0).abs() < 1e-9);
        assert_eq!(points[below.0].at.ramp_class, RampClass::Deformable);
        for width in points.iter().map(|point| point.at.pulse_ms) {
            let n = points.iter().filter(|p| p.at.pulse_ms == width).count();
            assert_eq!(n, 3, "{width} ms");
        }
    }

    /// Two curves meet at 0.705 ms, which orders nothing, and are the other way round at both sides: the middle of
    /// these, 0.7071 ms, lies 0.3 % from it.
    #[test]
    fn no_width_is_added_beside_one_at_which_curves_are_equal() {
        let widths = [0.5, 0.705, 1.0];
        let mut points = answers(RampClass::Rigid, &widths, |w| 300.0 + 100.0 * (w - 0.705));
        points.extend(answers(RampClass::Deformable, &widths, |_| 300.0));
        let refine = |closest| Refine {
            tolerance: None,
            crossing: Some(0.05),
            closest,
            ..REFINE
        };
        let with = |closest| refined(&refine(closest), points.clone(), |_| 300.0).len();
        assert_eq!([0.01, 0.001].map(with), [6, 8]);
    }

    #[test]
    fn equal_answers_and_open_ends_order_nothing() {
        let mut points = answers(RampClass::None, &[0.5, 1.0, 2.0], |_| 300.0);
        points.extend(answers(RampClass::Rigid, &[0.5, 1.0, 2.0], |w| {
            if w < 0.6 { 200.0 } else { 300.0 }
        }));
        assert!(crossings(&points).is_empty());
        points[4].answer_g = Some(400.0);
        points[1].answer_g = None;
        assert!(crossings(&points).is_empty());
        points[1].answer_g = Some(300.0);
        assert_eq!(crossings(&points).len(), 1);
    }
}
