//! The change of a critical shock with half the minimum film height, against searches with either, and the rows that have it.

use opshock_study::store::{AxisValue, Flag, PointSummary, results};
use opshock_study::study::Sign;
use opshock_study::sweep::{Ending, Physics, Silent, SweepInput, SweepOptions, sweep};
use opshock_tests::hdf5_dump::open_rw;
use opshock_tests::scenes;

/// No ramp, 2 ms, both signs.
fn rows(sets: &[(&str, &str)]) -> Vec<PointSummary> {
    let mut all = vec![
        ("pulse.widths_ms", "[2.0]"),
        ("ramp.models", "[\"none\"]"),
        ("resolution.preset", "\"coarse\""),
        ("search.max_refinements", "0"),
    ];
    all.extend(sets);
    let study = scenes::study("fig13", &all);
    let folder = tempfile::tempdir().expect("a folder");
    let input = SweepInput::of(&study).expect("input");
    let options = SweepOptions::with_threads(2);
    let physics = Physics::of(&study);
    let end = sweep(&input, &physics, folder.path(), &options, &Silent).expect("sweeps");
    assert_eq!(end.ending, Ending::Complete);
    end.summary.points
}

fn row(rows: &[PointSummary], sign: Sign, value: f64) -> &PointSummary {
    let is_it = |row: &&PointSummary| row.sign == sign && row.axes == [AxisValue::Number(value)];
    rows.iter().find(is_it).expect("a row")
}

#[test]
fn half_the_minimum_film_height_changes_an_answer_as_a_search_with_it_does() {
    let beside = rows(&[("failure.clearance_nm", "[0.0, 0.6]")]);
    let searched = rows(&[
        ("resolution.min_film_height_nm", "[0.15, 0.3]"),
        ("search.uncertainty", "false"),
    ]);
    for sign in [Sign::Plus, Sign::Minus] {
        let answer_g = |height_nm| row(&searched, sign, height_nm).a_crit_g.expect("an answer");
        let (whole_g, half_g) = (answer_g(0.3), answer_g(0.15));
        let found = row(&beside, sign, 0.0);
        let change_g = found.half_min_height_g.expect("a change");
        // Both are known to about 1 % of the answer, a large change to a quarter of itself.
        let expected_g = half_g - whole_g;
        let within_g = 0.01 * whole_g + 0.25 * expected_g;
        println!("{sign:?}: {change_g:.1} G, by two searches {expected_g:.1} G");
        assert!(
            (change_g - expected_g).abs() < within_g,
            "{change_g} {expected_g}"
        );
        if sign == Sign::Minus {
            assert!(change_g > 0.04 * whole_g, "{change_g} of {whole_g} G");
        }
        let interval_g = found.uncertainty_g.expect("an interval");
        let sum_g: f64 = found
            .contributions
            .iter()
            .map(|(_, one)| one.low_g + one.high_g)
            .sum();
        assert!(
            (2.0 * interval_g - sum_g).abs() < 1e-9,
            "no part of the interval"
        );
        // 0.6 nm is twice the minimum film height.
        for (clearance_nm, is_below) in [(0.0, true), (0.6, false)] {
            let row = row(&beside, sign, clearance_nm);
            assert_eq!(row.flags.contains(&Flag::BelowContinuum), is_below);
            assert_eq!(row.half_min_height_g.is_some(), is_below);
        }
    }
}

/// A file of a program without the column is read as before: where it is empty it is no content.
#[test]
fn results_without_the_change_are_read() {
    let sets = [
        ("pulse.widths_ms", "[1.0]"),
        ("ramp.models", "[\"none\"]"),
        ("pulse.signs", "[\"+\"]"),
        ("resolution.film_cells", "200"),
        ("search.uncertainty", "false"),
    ];
    let study = scenes::study("fig13", &sets);
    let folder = tempfile::tempdir().expect("a folder");
    let input = SweepInput::of(&study).expect("input");
    let options = SweepOptions::with_threads(1);
    let physics = Physics::of(&study);
    sweep(&input, &physics, folder.path(), &options, &Silent).expect("sweeps");
    let path = folder.path().join("results.h5");
    let rows = || {
        results::read(&path)
            .expect("reads")
            .expect("a file")
            .summary
            .points
    };
    let before = rows();
    let file = open_rw(&path);
    let points = file.group("points").expect("a table");
    points.unlink("half_min_height_g").expect("a column");
    drop((points, file));
    assert_eq!(rows(), before);
    assert_eq!(before[0].half_min_height_g, None);
}
