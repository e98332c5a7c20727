//! Points on which the answer of a study depends: which value of an axis survives most, and whether its lead is
//! significant.
//!
//! The worst case of a value is the lowest critical shock of its points. Its uncertainty matters for the best value, the
//! next, and every value whose worst case may lie as high as that of the best. Of such a value those points matter that
//! can be the worst case: the range of their critical shock begins below the lowest upper end of all ranges of the value.
//!
//! Every point that matters gets an uncertainty interval first. Then, while the interval of another value's worst case
//! reaches that of the best, points are refined, once a round: that worst case, and the points of the best value whose
//! interval begins below its upper end. A study without values to choose from has its worst case as its answer; the
//! points that can be it are refined to the target.
//!
//! A round is a function of finished brackets and intervals of all points, so that the same answers always choose the same
//! points.

use std::collections::BTreeSet;

/// What may still be done for the uncertainty of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Further {
    /// It has no interval yet.
    Interval,
    /// Its interval misses the target, and a refinement is left.
    Refinement,
    /// Nothing.
    Nothing,
}

/// What is known of the critical shock of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// As reported, G.
    pub value_g: f64,
    /// Where it may lie, G.
    pub range_g: [f64; 2],
    /// What may still be done.
    pub further: Further,
}

/// A value of an axis.
struct Rival {
    points: Vec<usize>,
    worst: usize,
    /// Where the lowest critical shock of its points may lie, G.
    range_g: [f64; 2],
}

/// The points of a round, by place: those that get an interval, or else those that are refined once more. None: the answer
/// depends on no other run. `axes` has for each axis the number of the value of every point; `standings` is `None` where no
/// critical shock is known.
pub fn decisive(axes: &[Vec<usize>], standings: &[Option<Standing>]) -> Vec<usize> {
    let (mut without, mut to_refine) = (BTreeSet::new(), BTreeSet::new());
    let may = |point: usize, further| standings[point].is_some_and(|at| at.further == further);
    let low_g = |point: usize| standings[point].map_or(f64::INFINITY, |at| at.range_g[0]);
    for axis in axes {
        let rivals = rivals(axis, standings);
        let Some((best, others)) = rivals.split_first() else {
            continue;
        };
        // As the answer compares them: by the interval of the worst case.
        let high_g = |rival: &Rival| standings[rival.worst].map_or(0.0, |at| at.range_g[1]);
        let reaches = |rival: &&Rival| high_g(rival) >= best.range_g[0];
        for (place, rival) in rivals.iter().enumerate() {
            if place > 1 && !reaches(&rival) {
                continue;
            }
            for &point in &rival.points {
                if low_g(point) > rival.range_g[1] {
                    continue;
                }
                if may(point, Further::Interval) {
                    without.insert(point);
                }
                if others.is_empty() && may(point, Further::Refinement) {
                    to_refine.insert(point);
                }
            }
        }
        for rival in others.iter().filter(reaches) {
            let of_best = best.points.iter().copied();
            let of_best = of_best.filter(|&point| low_g(point) <= high_g(rival));
            let both = of_best.chain([rival.worst]);
            to_refine.extend(both.filter(|&point| may(point, Further::Refinement)));
        }
    }
    let round = if without.is_empty() {
        to_refine
    } else {
        without
    };
    round.into_iter().collect()
}

/// The values of an axis with a known worst case, best first; equal ones in their order.
fn rivals(axis: &[usize], standings: &[Option<Standing>]) -> Vec<Rival> {
    let n_values = axis.iter().max().map_or(0, |last| last + 1);
    let mut rivals: Vec<(f64, Rival)> = Vec::new();
    for value in 0..n_values {
        let of_value = (0..axis.len()).filter(|&point| axis[point] == value);
        let known: Vec<(usize, Standing)> = of_value
            .filter_map(|point| Some((point, standings[point]?)))
            .collect();
        let least = known
            .iter()
            .min_by(|a, b| a.1.value_g.total_cmp(&b.1.value_g));
        let Some(&(worst, at)) = least else {
            continue;
        };
        let lowest = |end: usize| {
            let ends = known.iter().map(|(_, at)| at.range_g[end]);
            ends.fold(f64::INFINITY, f64::min)
        };
        let rival = Rival {
            points: known.iter().map(|(point, _)| *point).collect(),
            worst,
            range_g: [lowest(0), lowest(1)],
        };
        rivals.push((at.value_g, rival));
    }
    rivals.sort_by(|a, b| b.0.total_cmp(&a.0));
    rivals.into_iter().map(|(_, rival)| rival).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(value_g: f64, half_g: f64, further: Further) -> Option<Standing> {
        Some(Standing {
            value_g,
            range_g: [value_g - half_g, value_g + half_g],
            further,
        })
    }

    #[test]
    fn brackets_choose_what_can_be_the_worst_case_of_the_best_the_next_and_what_reaches_the_best() {
        use Further::Interval;
        let axis = vec![0, 0, 1, 1, 2, 2, 2, 3, 3];
        let standings = [
            at(100.0, 2.0, Interval), // far below the best
            at(101.0, 2.0, Interval),
            at(140.0, 2.0, Interval), // the next
            at(180.0, 2.0, Interval),
            at(150.0, 2.0, Interval), // the best: 150 and 153 overlap, 160 does not
            at(153.0, 2.0, Interval),
            at(160.0, 2.0, Interval),
            at(146.5, 2.0, Interval), // reaches the best
            None,
        ];
        // 146.5 is next, 140 neither next nor within reach.
        assert_eq!(decisive(&[axis], &standings), [4, 5, 7]);
    }

    #[test]
    fn only_overlapping_values_are_refined_and_of_the_best_only_the_points_that_overlap() {
        use Further::{Nothing, Refinement};
        let axes = [vec![0, 0, 1, 1, 2]];
        let mut standings = [
            at(100.0, 4.0, Refinement), // the best
            at(103.0, 3.5, Refinement),
            at(95.0, 3.0, Refinement), // overlaps the first point of the best alone
            at(99.0, 3.0, Refinement), // not the worst case of its value
            at(80.0, 9.0, Refinement), // does not reach the best
        ];
        assert_eq!(decisive(&axes, &standings), [0, 2]);
        // What is left for a point that cannot be refined is left to the other side.
        standings[2] = at(95.0, 3.0, Nothing);
        assert_eq!(decisive(&axes, &standings), [0]);
        standings[0] = at(100.0, 1.0, Refinement);
        assert_eq!(decisive(&axes, &standings), [0_usize; 0]);
        // A wide interval of a point with a higher value may hold the worst case, too.
        standings[1] = at(103.0, 5.5, Refinement);
        assert_eq!(decisive(&axes, &standings), [1]);
    }

    #[test]
    fn without_a_choice_the_points_that_can_be_the_worst_case_are_refined() {
        use Further::{Interval, Refinement};
        let mut standings = [
            at(100.0, 2.0, Interval),
            at(103.0, 2.0, Interval),
            at(110.0, 2.0, Interval),
        ];
        let axes = [vec![0; 3]];
        assert_eq!(decisive(&axes, &standings), [0, 1]);
        standings[0] = at(100.0, 9.0, Refinement);
        standings[1] = at(103.0, 2.5, Refinement);
        assert_eq!(decisive(&axes, &standings), [0, 1]);
        standings[0] = at(97.0, 1.0, Refinement);
        assert_eq!(decisive(&axes, &standings), [0]);
        assert_eq!(decisive(&axes, &[None; 3]), [0_usize; 0]);
    }
}
