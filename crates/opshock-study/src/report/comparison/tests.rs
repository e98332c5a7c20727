//! Tests: tables with known differences.

use super::*;
use crate::search::Sign;
use crate::store::summary::Totals;

fn row(survived_g: f64, failed_g: f64, half_g: Option<f64>, axes: Vec<AxisValue>) -> PointSummary {
    PointSummary {
        ramp: "rigid".into(),
        pulse_ms: 1.0,
        sign: Sign::Plus,
        axes,
        a_crit_g: Some(f64::midpoint(survived_g, failed_g)),
        uncertainty_g: half_g,
        half_min_height_g: None,
        survived_g: Some(survived_g),
        failed_g: Some(failed_g),
        contributions: vec![],
        levels: String::new(),
        onset_g: None,
        runs: 9,
        status: Status::Ok,
        flags: vec![],
        brackets_g: vec![],
        scanned_from_g: None,
        largest_gap_pct: None,
    }
}

#[test]
fn significance_asks_brackets_first_and_uncertainty_then() {
    let at = |crit, fail, err| row(crit, fail, err, vec![]);
    let a = at(100.0, 101.0, Some(4.0));
    let of = |b: &PointSummary| (Significance::of(&a, b), Significance::of(b, &a));
    for (b, expected) in [
        (at(100.5, 101.5, Some(1.0)), Significance::WithinBrackets),
        (at(101.0, 102.0, Some(1.0)), Significance::WithinBrackets),
        (
            at(105.0, 106.0, Some(2.0)),
            Significance::WithinUncertainties,
        ),
        (
            at(107.0, 108.0, Some(2.0)),
            Significance::BeyondUncertainties,
        ),
        (at(107.0, 108.0, None), Significance::BeyondBrackets),
    ] {
        assert_eq!(of(&b), (expected, expected), "{b:?}");
    }
    // "> 90 G" says nothing against 100 G, "> 103 G" does but for the interval, "> 200 G" always.
    for (bound, expected) in [
        (90.0, Significance::WithinBrackets),
        (103.0, Significance::WithinUncertainties),
        (200.0, Significance::BeyondUncertainties),
    ] {
        let mut above = at(bound, 0.0, None);
        (above.status, above.failed_g) = (Status::AboveRange, None);
        assert_eq!(of(&above), (expected, expected), "{bound}");
    }
    let mut undecided = at(100.0, 101.0, Some(4.0));
    undecided.status = Status::Undecided;
    assert_eq!(of(&undecided).0, Significance::Unknown);
}

#[test]
fn an_axis_of_one_study_meets_the_setting_of_the_other() {
    let summary = |axes: &[&str], points| Summary {
        study: "s".into(),
        digest: "d".into(),
        axes: axes.iter().map(ToString::to_string).collect(),
        points,
        totals: Totals::default(),
    };
    let one = summary(&[], vec![row(100.0, 101.0, None, vec![])]);
    let at = |g, um| row(g, g + 1.0, None, vec![AxisValue::Number(um)]);
    let many = summary(&["clearance_um"], vec![at(80.0, 60.0), at(100.0, 100.0)]);
    let side = |summary, resolved_study| Side {
        source: "x",
        summary,
        resolved_study: Some(resolved_study),
    };
    let found = compare(
        side(&one, "[ramp]\nclearance_um = 100.0\n"),
        side(&many, "[ramp]\nclearance_um = [60.0, 100.0]\n"),
    );
    assert_eq!((found.equal_points, found.points.len()), (1, 0));
    assert!(found.only_a.is_empty());
    let place = [("ramp.clearance_um".to_owned(), AxisValue::Number(60.0))];
    assert_eq!(found.only_b[0].axes, place);
    let settings = found.settings.expect("both kept");
    assert_eq!(settings.len(), 1);
    assert_eq!(settings[0].b, Some(json!([60.0, 100.0])));
    // Another clearance: nothing to compare.
    let other = compare(
        side(&one, "[ramp]\nclearance_um = 70.0\n"),
        side(&many, "[ramp]\nclearance_um = [60.0, 100.0]\n"),
    );
    assert_eq!((other.only_a.len(), other.only_b.len()), (1, 2));
}
