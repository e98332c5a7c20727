//! `make verify-uncertainty`: do the uncertainty intervals of `results/fig13` contain critical shocks that were made
//! independently?
//!
//! The disk's highest frequency stays: it is a value of the model of `studies/fig13`. Every truth is a line of
//! `results/uncertainty/fig13.csv`; run again, it goes on from there, as long as the scene is the same.

use std::sync::Mutex;

use opshock_study::study::Point;
use opshock_study::sweep::SweepInput;
use opshock_tests::scenes::study;
use opshock_tests::seeded::seeds;

use super::coverage::scene_name;
use super::truths::{Judged, Truths, judge, on_all_cores, results, truths};

/// Half-width of an interval that meets its target, a share.
const TARGET: f64 = 0.01;

/// Intervals of the table of Fig. 13 by point (`ramp,pulse_ms,sign`).
fn intervals() -> Vec<Judged> {
    let text = std::fs::read_to_string(results().join("fig13/table.csv")).expect("a table");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let place = |name: &str| names.iter().position(|one| *one == name).expect("a column");
    let [crit, half] = ["a_crit_g", "uncertainty_g"].map(place);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| -> f64 { cells[place].parse().expect("an interval") };
        Judged {
            name: cells[..3].join(","),
            middle_g: number(crit),
            half_g: number(half),
            brackets: Vec::new(),
            change_g: 0.0,
        }
    };
    lines.map(row).collect()
}

#[test]
#[ignore = "make verify-uncertainty: hours, resumable"]
fn uncertainty_slow_truths_lie_inside_the_intervals_of_fig13() {
    let mut rows = intervals();
    let study = study("fig13", &[]);
    let input = SweepInput::of(&study).expect("input");
    let log = Mutex::new(Truths::open("fig13.csv", "ramp,pulse_ms,sign"));
    let place_of = |row: &Judged| {
        let mut points = study.points.iter();
        let name =
            |point: &Point| format!("{},{},{}", point.ramp, point.pulse_ms, point.sign.as_str());
        let place = points.position(|point| name(point) == row.name);
        let place = place.expect("a point");
        (place, scene_name(&input.points[place].digest.0))
    };
    let wanted: Vec<&Judged> = seeds(0..rows.len() as u64)
        .map(|seed| &rows[seed as usize])
        .collect();
    // Finest films last: they take most of the time.
    for films in [2, 3] {
        on_all_cores(&wanted, |row| {
            let (place, scene) = place_of(row);
            let known = log.lock().expect("whole").of(&row.name, &scene);
            let Point {
                scene: of, sign, ..
            } = &study.points[place];
            let found = truths(of, sign.factor(), row.middle_g, TARGET, films, &known);
            if found != known {
                println!("{}: {found:.1?}", row.name);
                log.lock().expect("whole").put(&row.name, &scene, found);
            }
        });
    }
    let log = log.into_inner().expect("whole");
    for row in &mut rows {
        row.brackets = log.of(&row.name, &place_of(row).1);
    }
    rows.retain(|row| !row.brackets.is_empty());
    judge(&rows).hold();
}
