//! Widths that refinement adds: a crossing and a kink that are known, the same table whatever the
//! threads, kills and shards, and a small study of the real physics.

use std::path::Path;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_study::search::{Probe, ProbeResult, RunCost, Verdict};
use opshock_study::store::{self, Loaded, Summary, folder};
use opshock_study::study::{Ramp, SetArg, Study};
use opshock_study::sweep::refine::{crossings, next_round, refined};
use opshock_study::sweep::{
    Ending, MergeEnd, Onset, Silent, Simulator, SweepInput, SweepOptions, merge, shard, sweep,
};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::tables::failure;

use crate::cli::{Done, study as shipped};

/// Kink of the deformable ramp's curve, ms.
const KINK_MS: f64 = 0.8;

/// Critical shocks in G: two power laws that meet at 1.66 ms, one of them with a kink.
fn critical_g(ramp: Ramp, pulse_ms: f64) -> f64 {
    match ramp {
        Ramp::None => 900.0,
        Ramp::Rigid => 300.0 * pulse_ms.powf(-0.5),
        Ramp::Deformable => {
            let at_kink = 200.0 * KINK_MS.powf(0.3);
            let slope = if pulse_ms < KINK_MS { -0.9 } else { 0.3 };
            at_kink * (pulse_ms / KINK_MS).powf(slope)
        }
    }
}

/// Where the power laws meet, ms.
fn crossing_ms() -> f64 {
    1.5_f64.powf(1.25)
}

struct Law(Vec<(Ramp, f64)>);

impl Law {
    fn of(study: &Study) -> Law {
        let order = study.table_order().into_iter();
        let points = order.map(|place| &study.points[place]);
        Law(points.map(|point| (point.ramp, point.pulse_ms)).collect())
    }
}

impl Simulator for Law {
    fn simulate(&self, point: usize, _: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let (ramp, pulse_ms) = self.0[point];
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        let fails = amplitude_g >= critical_g(ramp, pulse_ms);
        ProbeResult {
            verdict: if fails { failure() } else { Verdict::Survives },
            h_min_m: (!fails).then_some(1e-9),
            t_min_s: (!fails).then_some(1e-3),
            cost: RunCost {
                steps: amplitude_g as u64,
                ..RunCost::default()
            },
        }
    }

    fn onset(&self, point: usize) -> Onset {
        match self.0[point].0 {
            Ramp::None => Onset::NoRamp,
            Ramp::Rigid | Ramp::Deformable => Onset::At {
                amplitude_m_per_s2: 100.0 * STANDARD_GRAVITY_M_PER_S2,
            },
        }
    }
}

fn study(more: &[&str]) -> Study {
    let sets = [
        "pulse.widths_ms=[0.5, 1.0, 3.0]",
        "pulse.signs=[\"+\"]",
        "ramp.models=[\"none\", \"rigid\", \"deformable\"]",
        "search.error_bars=false",
        "search.refine.closest_pct=1.0",
    ];
    let sets: Vec<SetArg> = sets
        .iter()
        .chain(more)
        .map(|set| set.parse().expect("a set argument"))
        .collect();
    Study::from_text(&Study::example("refined"), &sets).expect("a study")
}

fn finished(store: &Path) -> Loaded {
    store::load(store).map_or_else(|_| Loaded::default(), |(loaded, _)| loaded)
}

/// Sweeps round by round as the program does, at most `rounds` of them.
fn sweep_rounds(study: &Study, store: &Path, threads: usize, rounds: usize) -> (Study, Summary) {
    let options = SweepOptions::with_threads(threads);
    let mut study = refined(study, &finished(store)).expect("a range");
    for _ in 1.. {
        let input = SweepInput::of(&study).expect("input");
        let end = sweep(&input, &Law::of(&study), store, &options, &Silent).expect("sweeps");
        assert_eq!(end.ending, Ending::Complete);
        let round = study.points.iter().map(|point| point.round).max();
        match next_round(&study, &end.summary) {
            Some(next) if round.expect("points") + 1 < rounds as u32 => study = next,
            _ => return (study, end.summary),
        }
    }
    unreachable!("refinement ends")
}

#[test]
fn a_crossing_is_located_and_a_kink_resolved() {
    let study = study(&[
        "search.refine.tolerance_pct=3",
        "search.refine.crossing_pct=4",
    ]);
    let root = tempfile::tempdir().expect("folder");
    let (last, summary) = sweep_rounds(&study, root.path(), 2, 99);
    assert!(last.points.len() > study.points.len());

    let found = crossings(&last, &summary);
    let [crossed] = &found[..] else {
        panic!("{} crossings", found.len());
    };
    assert_eq!(
        (crossed.below.0.ramp.as_str(), crossed.below.1.ramp.as_str()),
        ("deformable", "rigid")
    );
    let (low, high) = crossed.crossing.between_ms;
    // One width between them may have equal answers.
    assert!(high / low <= 1.04 * 1.04, "{low} to {high} ms");
    // Answers are known within half a bracket of 1 %; the curves part by 0.8 % for 1 % of width.
    let off = crossed.crossing.pulse_ms / crossing_ms() - 1.0;
    assert!(off.abs() < 0.01 / 0.8, "{off}");

    // Lines between the answers: the tolerance, twice at the kink, and half a bracket.
    for ramp in [Ramp::Rigid, Ramp::Deformable] {
        let of_ramp = summary
            .points
            .iter()
            .filter(|row| row.ramp == ramp.as_str());
        let rows: Vec<(f64, f64)> = of_ramp
            .map(|row| (row.pulse_ms, row.a_crit_g.expect("an answer")))
            .collect();
        assert!(rows.is_sorted_by(|a, b| a.0 < b.0), "rows by width");
        for pair in rows.windows(2) {
            for part in 1..10 {
                let share = f64::from(part) / 10.0;
                let between = |a: f64, b: f64| (a.ln() + share * (b / a).ln()).exp();
                let width = between(pair[0].0, pair[1].0);
                let line = between(pair[0].1, pair[1].1);
                let off = (line / critical_g(ramp, width)).ln();
                assert!(off.abs() < 0.07, "{ramp} {width} ms: {off}");
            }
        }
    }
    // The straight curve gets nothing beyond what the crossing asks for.
    let widths = |ramp: Ramp| {
        let of_ramp = last.points.iter().filter(|point| point.ramp == ramp);
        let widths = of_ramp.map(|point| point.pulse_ms.to_bits());
        widths.collect::<std::collections::BTreeSet<_>>()
    };
    assert!(widths(Ramp::Rigid).len() < widths(Ramp::Deformable).len());
    // Every added width has its answer without ramp.
    assert!(widths(Ramp::Rigid).is_subset(&widths(Ramp::None)));
    assert!(widths(Ramp::Deformable).is_subset(&widths(Ramp::None)));
}

#[test]
fn the_studys_own_answers_do_not_change() {
    let root = tempfile::tempdir().expect("folder");
    let plain = study(&["search.refine.most_points=1"]);
    assert!(plain.search.refine.is_none());
    let (_, own) = sweep_rounds(&plain, &root.path().join("plain"), 1, 1);
    let refined = study(&["search.refine.tolerance_pct=3"]);
    let (_, all) = sweep_rounds(&refined, &root.path().join("refined"), 1, 99);
    for row in &own.points {
        let is_it = |other: &&_| *other == row;
        assert!(all.points.iter().any(|other| is_it(&other)), "{row:?}");
    }
}

#[test]
fn threads_kills_and_shards_add_the_same_widths() {
    let study = study(&[
        "search.refine.tolerance_pct=3",
        "search.refine.crossing_pct=4",
    ]);
    let root = tempfile::tempdir().expect("folder");
    let place = |name: &str| root.path().join(name);
    let content = |name: &str| dump(&place(name).join("results.h5"), &["/machine"]);
    sweep_rounds(&study, &place("one"), 1, 99);
    let expected = content("one");
    sweep_rounds(&study, &place("three"), 3, 99);
    assert!(content("three") == expected, "threads show");

    // Cut anywhere, the first round included, and gone on.
    let journal = std::fs::read(place("three/journal")).expect("journal");
    for share in [0.1, 0.4, 0.7, 0.95] {
        let name = format!("cut{share}");
        std::fs::create_dir(place(&name)).expect("folder");
        let cut = (journal.len() as f64 * share) as usize;
        std::fs::write(place(&name).join("journal"), &journal[..cut]).expect("writes");
        sweep_rounds(&study, &place(&name), 2, 99);
        assert!(content(&name) == expected, "a kill at {share} shows");
    }

    // Shards answer the study's own widths; the rest is added after they are merged.
    let input = SweepInput::of(&study).expect("input");
    for part in ["2/2", "1/2"] {
        let options = SweepOptions {
            shard: Some(part.parse().expect("a shard")),
            ..SweepOptions::with_threads(1)
        };
        sweep(&input, &Law::of(&study), &place("parts"), &options, &Silent).expect("sweeps");
    }
    let stores = shard::stores(&place("parts")).expect("stores");
    let merged = merge(&input, &place("parts"), &stores, &folder::session(1)).expect("merges");
    assert!(matches!(merged, MergeEnd::Merged(_)));
    sweep_rounds(&study, &place("parts"), 2, 99);
    assert!(content("parts") == expected, "shards show");
}

/// Figure 13 without and with the rigid ramp at two widths, coarse: 8 points, and 4 between them.
const SMALL: [&str; 9] = [
    "pulse.widths_ms=[0.5, 0.7]",
    "ramp.models=[\"none\", \"rigid\"]",
    "pulse.window_ms=0.8",
    "search.tolerance_pct=5",
    "search.error_bars=false",
    "search.refine={ tolerance_pct = 20.0, crossing_pct = 50.0 }",
    "solver.film_cells=200",
    "solver.disk_cut_khz=10",
    "output.keep_histories=\"none\"",
];

fn words<'a>(command: &'a str, file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec![command, file, "--store", "s.opshock"];
    for set in SMALL {
        words.extend(["--set", set]);
    }
    words.extend(more);
    words
}

#[test]
fn a_small_study_is_refined_by_the_program() {
    let root = tempfile::tempdir().unwrap();
    let (whole, parts) = (root.path().join("whole"), root.path().join("parts"));
    std::fs::create_dir(&whole).unwrap();
    std::fs::create_dir(&parts).unwrap();
    let file = shipped("fig13");
    let file = file.to_str().unwrap();

    let planned = Done::of(&whole, &words("plan", file, &[]));
    assert!(
        planned.stdout.contains("adds 60 points at most"),
        "{}",
        planned.stdout
    );
    let swept = Done::of(&whole, &words("sweep", file, &["-j2"]));
    assert!([0, 4].contains(&swept.code), "{}", swept.stderr);
    assert!(swept.stderr.contains("4 points added"), "{}", swept.stderr);
    // Header and twelve rows.
    let csv = Done::of(&whole, &["report", "s.opshock", "--format", "csv"]);
    assert_eq!(csv.stdout.lines().count(), 13, "{}", csv.stdout);
    assert_eq!(csv.stdout.matches(",0.5916,").count(), 4, "{}", csv.stdout);

    for shard in ["1/2", "2/2"] {
        let done = Done::of(&parts, &words("sweep", file, &["-j1", "--shard", shard]));
        assert!([0, 4].contains(&done.code), "{}", done.stderr);
    }
    let merged = Done::of(&parts, &["merge", "s.opshock"]);
    assert_eq!(
        merged.stdout.matches("open").count(),
        5,
        "{}",
        merged.stdout
    );
    let last = Done::of(&parts, &words("sweep", file, &["-j1"]));
    assert_eq!(last.code, swept.code, "{}", last.stderr);
    let content = |folder: &Path| dump(&folder.join("s.opshock/results.h5"), &["/machine"]);
    assert!(content(&parts) == content(&whole), "other bits");
}
