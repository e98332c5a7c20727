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
//! A study may instead ask whether every point survives a required amplitude. Then every point with a bracket within a
//! factor [`FAR`] of it gets an interval, and those whose interval holds the amplitude are refined, unless another point fails it for certain.
//!
//! A round is a function of finished brackets and intervals of all points, so that the same answers always choose the same
//! points.

use std::collections::BTreeSet;

/// A point whose bracket is farther than this factor from a required amplitude needs no uncertainty interval. The widest of 63
/// intervals of random drives (`results/uncertainty/drives.csv`) reaches from 54 to 341 G about a truth of 104 G.
pub const FAR: f64 = 4.0;

/// What the intervals are to decide.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Which value of each axis survives most: for each axis the number of the value of every point.
    BestValue(Vec<Vec<usize>>),
    /// Whether every point survives this amplitude, G.
    Survives(f64),
}

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
/// depends on no other run. `standings` is `None` where no critical shock is known.
pub fn decisive(question: &Question, standings: &[Option<Standing>]) -> Vec<usize> {
    let (without, to_refine) = match question {
        Question::BestValue(axes) => of_best_value(axes, standings),
        Question::Survives(amplitude_g) => of_amplitude(*amplitude_g, standings),
    };
    let round = if without.is_empty() {
        to_refine
    } else {
        without
    };
    round.into_iter().collect()
}

/// Points that have no interval, and points that may be refined and whose interval holds the amplitude: none of these where
/// one point fails for certain.
fn of_amplitude(
    amplitude_g: f64,
    standings: &[Option<Standing>],
) -> (BTreeSet<usize>, BTreeSet<usize>) {
    let places = |is_chosen: &dyn Fn(&Standing) -> bool| {
        let places = standings.iter().enumerate();
        let chosen = places.filter(|(_, at)| at.as_ref().is_some_and(is_chosen));
        chosen.map(|(place, _)| place).collect()
    };
    let has_interval = |at: &Standing| at.further != Further::Interval;
    let is_near =
        |at: &Standing| at.range_g[0] < FAR * amplitude_g && amplitude_g < FAR * at.range_g[1];
    let holds = |at: &Standing| at.range_g[0] < amplitude_g && amplitude_g < at.range_g[1];
    let mut known = standings.iter().flatten();
    let one_fails = known.any(|at| has_interval(at) && at.range_g[1] <= amplitude_g);
    (
        places(&|at| !has_interval(at) && is_near(at)),
        places(&|at| !one_fails && at.further == Further::Refinement && holds(at)),
    )
}

/// Points on which the best value of an axis depends: those without an interval, and those to be refined.
fn of_best_value(
    axes: &[Vec<usize>],
    standings: &[Option<Standing>],
) -> (BTreeSet<usize>, BTreeSet<usize>) {
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
    (without, to_refine)
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

    fn best(axes: Vec<Vec<usize>>, standings: &[Option<Standing>]) -> Vec<usize> {
        decisive(&Question::BestValue(axes), standings)
    }

    #[test]
    fn a_required_amplitude_refines_the_points_whose_interval_holds_it() {
        use Further::{Interval, Nothing, Refinement};
        let question = Question::Survives(400.0);
        let mut standings = [
            at(700.0, 2.0, Interval),
            at(405.0, 6.0, Refinement), // holds it
            at(395.0, 5.1, Refinement), // holds it
            at(404.0, 4.0, Refinement), // survives it: the amplitude is the lower end
            at(401.0, 4.0, Nothing),
            None,
            at(1610.0, 2.0, Interval), // beyond four times the amplitude
        ];
        assert_eq!(decisive(&question, &standings), [0]);
        standings[0] = at(700.0, 2.0, Refinement);
        assert_eq!(decisive(&question, &standings), [1, 2]);
        // An upper end fails: no other point matters.
        standings[2] = at(395.0, 5.0, Refinement);
        assert_eq!(decisive(&question, &standings), [0_usize; 0]);
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
        assert_eq!(best(vec![axis], &standings), [4, 5, 7]);
    }

    #[test]
    fn only_overlapping_values_are_refined_and_of_the_best_only_the_points_that_overlap() {
        use Further::{Nothing, Refinement};
        let axes = vec![vec![0, 0, 1, 1, 2]];
        let mut standings = [
            at(100.0, 4.0, Refinement), // the best
            at(103.0, 3.5, Refinement),
            at(95.0, 3.0, Refinement), // overlaps the first point of the best alone
            at(99.0, 3.0, Refinement), // not the worst case of its value
            at(80.0, 9.0, Refinement), // does not reach the best
        ];
        assert_eq!(best(axes.clone(), &standings), [0, 2]);
        // What is left for a point that cannot be refined is left to the other side.
        standings[2] = at(95.0, 3.0, Nothing);
        assert_eq!(best(axes.clone(), &standings), [0]);
        standings[0] = at(100.0, 1.0, Refinement);
        assert_eq!(best(axes.clone(), &standings), [0_usize; 0]);
        // A wide interval of a point with a higher value may hold the worst case, too.
        standings[1] = at(103.0, 5.5, Refinement);
        assert_eq!(best(axes.clone(), &standings), [1]);
    }

    #[test]
    fn without_a_choice_the_points_that_can_be_the_worst_case_are_refined() {
        use Further::{Interval, Refinement};
        let mut standings = [
            at(100.0, 2.0, Interval),
            at(103.0, 2.0, Interval),
            at(110.0, 2.0, Interval),
        ];
        let axes = vec![vec![0; 3]];
        assert_eq!(best(axes.clone(), &standings), [0, 1]);
        standings[0] = at(100.0, 9.0, Refinement);
        standings[1] = at(103.0, 2.5, Refinement);
        assert_eq!(best(axes.clone(), &standings), [0, 1]);
        standings[0] = at(97.0, 1.0, Refinement);
        assert_eq!(best(axes.clone(), &standings), [0]);
        assert_eq!(best(axes, &[None; 3]), [0_usize; 0]);
    }
}
