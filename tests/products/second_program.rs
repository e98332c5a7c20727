//! Shocks of decks against the decks' own program: the same inputs, two codes (`tests/reference/cml_decks/README.md`).

use crate::cli::Done;
use crate::cml_decks::{decks, import};
use opshock_tests::sheet::at_most;

const SHEET: &str = "second-program";

/// Columns of a table by name.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let mut titles = lines.next().expect("a header").split(',');
    let at = titles.position(|title| title == name).expect("a column");
    let cell = |line: &str| {
        line.split(',')
            .nth(at)
            .expect("a cell")
            .parse()
            .expect("a number")
    };
    lines.map(cell).collect()
}

/// A column of a history at an instant, by straight lines.
fn at_time(time_s: &[f64], values: &[f64], t_s: f64) -> f64 {
    let after = time_s
        .partition_point(|t| *t < t_s)
        .clamp(1, time_s.len() - 1);
    let share = (t_s - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
    values[after - 1] + share.clamp(0.0, 1.0) * (values[after] - values[after - 1])
}

/// A deck's shock by opshock, its history, and the history of the second program.
fn both(
    deck: &str,
    peer: &str,
    ramp: &str,
    sign: &str,
    amplitude_g: &str,
) -> (serde_json::Value, String, String) {
    let at = tempfile::tempdir().expect("a folder");
    let done = import(at.path(), &decks(), deck, &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let words = [
        "run",
        "out/study.toml",
        "--ramp",
        ramp,
        "--sign",
        sign,
        "--amplitude-g",
        amplitude_g,
    ];
    let done = Done::of(
        at.path(),
        &[&words[..], &["--history", "history.csv", "--json"]].concat(),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let ours = std::fs::read_to_string(at.path().join("history.csv")).expect("a history");
    let peer = std::fs::read_to_string(decks().join(peer)).expect("a history");
    (done.json(), ours, peer)
}

/// Root mean square and largest of the difference of two columns, over the peak of the second program's.
fn difference(ours: &str, our: &str, peer: &str, other: &str) -> [f64; 2] {
    let (time_s, peer_s) = (column(ours, "time_s"), column(peer, "t_s"));
    let (our, other) = (column(ours, our), column(peer, other));
    let end_s = time_s[time_s.len() - 1];
    let pairs = peer_s.iter().zip(&other).filter(|(t, _)| **t <= end_s);
    let errors: Vec<f64> = pairs
        .map(|(t, value)| at_time(&time_s, &our, *t) - value)
        .collect();
    let largest = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let mean = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    [mean.sqrt(), largest(&errors)].map(|error| error / largest(&other))
}

/// Three shocks without ramp. The second program's slider rings in the last one.
#[test]
fn shocks_without_ramp_are_those_of_the_decks_own_program() {
    for (name, sign, amplitude_g, disk, dimple) in [
        ("P400", "+", "400", [0.25e-2, 0.5e-2], [0.2e-2, 0.7e-2]),
        ("P200", "+", "200", [0.25e-2, 0.65e-2], [0.25e-2, 0.7e-2]),
        ("N400", "-", "400", [0.25e-2, 0.5e-2], [0.9e-2, 5e-2]),
    ] {
        let deck = format!("dynluls_{name}_none.def");
        let (_, ours, peer) = both(
            &deck,
            &format!("peer_{name}_none.csv"),
            "none",
            sign,
            amplitude_g,
        );
        let case = format!("{sign}{amplitude_g} G, no ramp");
        for (what, our, other, bounds) in [
            ("disk under the slider", "disk_slider_m", "w_slider_m", disk),
            ("dimple force", "dimple_force_n", "dimple_n", dimple),
        ] {
            let found = difference(&ours, our, &peer, other);
            for ((kind, found), bound) in ["rms", "largest"].into_iter().zip(found).zip(bounds) {
                at_most(
                    SHEET,
                    &format!("{case}: {what}, {kind} difference over the peak"),
                    found,
                    bound,
                );
            }
        }
        let (time_s, our) = (column(&ours, "time_s"), column(&ours, "min_clearance_m"));
        let (peer_s, other) = (column(&peer, "t_s"), column(&peer, "clearance_m"));
        let end_s = time_s[time_s.len() - 1];
        let pairs = peer_s.iter().zip(&other).filter(|(t, _)| **t <= end_s);
        let ratios: Vec<f64> = pairs
            .map(|(t, value)| value / at_time(&time_s, &our, *t))
            .collect();
        let ratio = ratios.iter().sum::<f64>() / ratios.len() as f64;
        at_most(
            SHEET,
            &format!("{case}: mean ratio of the smallest clearances, distance from 0.93"),
            (ratio - 0.93).abs(),
            0.02,
        );
    }
}

/// Disk and rigid ramp. The impulse of the second program rises in as many contacts, at the same times.
#[test]
fn a_shock_with_a_rigid_ramp_is_that_of_the_decks_own_program() {
    let (found, ours, peer) = both(
        "dynluls_D400_rigid.def",
        "peer_D400_fix.csv",
        "rigid",
        "+",
        "400",
    );
    let case = "+400 G, rigid ramp";
    for (what, our, other, bounds) in [
        ("disk at the ramp", "disk_ramp_m", "w_ramp_m", [3e-3, 1e-2]),
        (
            "disk under the slider",
            "disk_slider_m",
            "w_slider_m",
            [3e-3, 1e-2],
        ),
    ] {
        let found = difference(&ours, our, &peer, other);
        for ((kind, found), bound) in ["rms", "largest"].into_iter().zip(found).zip(bounds) {
            at_most(
                SHEET,
                &format!("{case}: {what}, {kind} difference over the peak"),
                found,
                bound,
            );
        }
    }
    let (peer_s, impulse_n_s) = (column(&peer, "t_s"), column(&peer, "ramp_impulse_n_s"));
    let mut begins_s: Vec<f64> = Vec::new();
    let mut last_s = f64::NEG_INFINITY;
    for (times, impulses) in peer_s.windows(2).zip(impulse_n_s.windows(2)) {
        if impulses[1] > impulses[0] + 1e-9 {
            if times[0] - last_s > 3e-5 {
                begins_s.push(times[0]);
            }
            last_s = times[1];
        }
    }
    let top = &found["contact"]["top"];
    let episodes = top["episodes"].as_array().expect("episodes");
    assert_eq!(episodes.len(), begins_s.len());
    for (place, (own, begin_s)) in episodes.iter().zip(&begins_s).enumerate() {
        let own_s = own["on_s"].as_f64().expect("a time");
        // Of samples 10 us apart.
        let what = format!("{case}: begin of contact {}, s", place + 1);
        at_most(SHEET, &what, (own_s - begin_s).abs(), 1.2e-5);
    }
    let whole_n_s = impulse_n_s[impulse_n_s.len() - 1];
    let own_n_s = top["impulse_n_s"].as_f64().expect("an impulse");
    at_most(
        SHEET,
        &format!("{case}: impulse of the ramp, relative difference"),
        (own_n_s / whole_n_s - 1.0).abs(),
        1e-2,
    );
    assert_eq!(
        found["contact"]["bottom"]["impulse_n_s"].as_f64(),
        Some(0.0)
    );
}
