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

/// A deck's shock by both programs.
struct Shock {
    /// What opshock prints, as JSON.
    found: serde_json::Value,
    ours: String,
    peer: String,
}

impl Shock {
    fn run(deck: &str, peer: &str, [ramp, sign, amplitude_g]: [&str; 3]) -> Shock {
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
            "--history",
            "history.csv",
            "--json",
        ];
        let done = Done::of(at.path(), &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let read = |path: std::path::PathBuf| std::fs::read_to_string(path).expect("a history");
        Shock {
            found: done.json(),
            ours: read(at.path().join("history.csv")),
            peer: read(decks().join(peer)),
        }
    }

    /// Values of two columns at the instants of the second program: ours and its own.
    fn pairs(&self, our: &str, other: &str) -> Vec<[f64; 2]> {
        let (time_s, our) = (column(&self.ours, "time_s"), column(&self.ours, our));
        let (peer_s, other) = (column(&self.peer, "t_s"), column(&self.peer, other));
        let end_s = time_s[time_s.len() - 1];
        let both = peer_s.iter().zip(other).filter(|(t, _)| **t <= end_s);
        both.map(|(t, value)| [at_time(&time_s, &our, *t), value])
            .collect()
    }

    /// Holds root mean square and largest of the difference of two columns, over the second program's peak.
    fn hold(&self, case: &str, what: &str, [our, other]: [&str; 2], bounds: [f64; 2]) {
        let pairs = self.pairs(our, other);
        let largest = |of: fn(&[f64; 2]) -> f64| pairs.iter().map(of).fold(0.0, f64::max);
        let squares: f64 = pairs.iter().map(|[our, other]| (our - other).powi(2)).sum();
        let mean = squares / pairs.len() as f64;
        let errors = [mean.sqrt(), largest(|[our, other]| (our - other).abs())];
        let peak = largest(|[_, other]| other.abs());
        for ((kind, error), bound) in ["rms", "largest"].into_iter().zip(errors).zip(bounds) {
            let what = format!("{case}: {what}, {kind} difference over the peak");
            at_most(SHEET, &what, error / peak, bound);
        }
    }
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
        let peer = format!("peer_{name}_none.csv");
        let shock = Shock::run(&deck, &peer, ["none", sign, amplitude_g]);
        let case = format!("{sign}{amplitude_g} G, no ramp");
        let columns = ["disk_slider_m", "w_slider_m"];
        shock.hold(&case, "disk under the slider", columns, disk);
        shock.hold(
            &case,
            "dimple force",
            ["dimple_force_n", "dimple_n"],
            dimple,
        );
        let pairs = shock.pairs("min_clearance_m", "clearance_m");
        let ratios = pairs.iter().map(|[our, other]| other / our);
        let ratio = ratios.sum::<f64>() / pairs.len() as f64;
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
    let shock = ["rigid", "+", "400"];
    let shock = Shock::run("dynluls_D400_rigid.def", "peer_D400_fix.csv", shock);
    let case = "+400 G, rigid ramp";
    for (what, columns) in [
        ("disk at the ramp", ["disk_ramp_m", "w_ramp_m"]),
        ("disk under the slider", ["disk_slider_m", "w_slider_m"]),
    ] {
        shock.hold(case, what, columns, [3e-3, 1e-2]);
    }
    let Shock { found, peer, .. } = shock;
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
