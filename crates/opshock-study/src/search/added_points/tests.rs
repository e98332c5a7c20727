//! Tests of added widths on curves that are known.

use super::*;
use crate::search::Sign;

const REFINE: AddedPoints = AddedPoints {
    tolerance: Some(0.02),
    crossing: None,
    closest: 0.01,
    most_points: 100,
};

fn at(ramp: Ramp, pulse_ms: f64) -> Coordinates {
    Coordinates {
        ramp,
        pulse_ms,
        sign: Sign::Plus,
        axes: Vec::new(),
        round: 0,
        fail_below_m: 0.0,
        clearance_axis: None,
    }
}

fn answers(ramp: Ramp, widths: &[f64], law: impl Fn(f64) -> f64) -> Vec<Answered> {
    let point = |&pulse_ms: &f64| Answered {
        at: at(ramp, pulse_ms),
        answer_g: Some(law(pulse_ms)),
    };
    widths.iter().map(point).collect()
}

/// Adds rounds until nothing is wanted; the largest number of rounds is 30.
fn refined(
    refine: &AddedPoints,
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
    let points = answers(Ramp::None, &[0.5, 0.8, 3.0], |w| 300.0 * w.powf(-0.4));
    assert!(wanted(&REFINE, &points).is_empty());
    // Two answers show no curvature: one more is requested.
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
        let start = answers(Ramp::None, &[0.5, 1.0, 2.0, 4.0], law);
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
    let start = answers(Ramp::None, &[0.5, 1.0, 2.0, 4.0], law);
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
    let start = answers(Ramp::None, &[0.5, 1.0, 2.0, 4.0], law);
    let refine = AddedPoints {
        most_points: 3,
        ..REFINE
    };
    let points = refined(&refine, start, |at| law(at.pulse_ms));
    assert_eq!(points.len(), 7);
}

#[test]
fn a_crossing_is_closed_in_for_both_curves_and_the_one_without_ramp() {
    // 300 w^-0.5 and 200 w^0.3 meet at (3/2)^(1/0.8) = 1.6600 ms.
    let law = |at: &Coordinates| match at.ramp {
        Ramp::None => 900.0,
        Ramp::Rigid => 300.0 * at.pulse_ms.powf(-0.5),
        Ramp::Deformable => 200.0 * at.pulse_ms.powf(0.3),
    };
    let mut start = Vec::new();
    for class in [Ramp::None, Ramp::Rigid, Ramp::Deformable] {
        start.extend(answers(class, &[0.5, 1.0, 3.0], |w| law(&at(class, w))));
    }
    let refine = AddedPoints {
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
    assert_eq!(points[below.0].at.ramp, Ramp::Deformable);
    for width in points.iter().map(|point| point.at.pulse_ms) {
        let n = points.iter().filter(|p| p.at.pulse_ms == width).count();
        assert_eq!(n, 3, "{width} ms");
    }
}

/// Two curves meet at 0.705 ms, which gives no order, and change order between its neighbours: their middle, 0.7071 ms,
/// lies 0.3 % from it.
#[test]
fn no_width_is_added_beside_one_at_which_curves_are_equal() {
    let widths = [0.5, 0.705, 1.0];
    let mut points = answers(Ramp::Rigid, &widths, |w| 300.0 + 100.0 * (w - 0.705));
    points.extend(answers(Ramp::Deformable, &widths, |_| 300.0));
    let refine = |closest| AddedPoints {
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
    let mut points = answers(Ramp::None, &[0.5, 1.0, 2.0], |_| 300.0);
    points.extend(answers(Ramp::Rigid, &[0.5, 1.0, 2.0], |w| {
        if w < 0.6 { 200.0 } else { 300.0 }
    }));
    assert!(crossings(&points).is_empty());
    points[4].answer_g = Some(400.0);
    points[1].answer_g = None;
    assert!(crossings(&points).is_empty());
    points[1].answer_g = Some(300.0);
    assert_eq!(crossings(&points).len(), 1);
}
