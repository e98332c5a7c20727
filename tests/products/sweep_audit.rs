//! `opshock sweep --audit`: finished simulations against the same ones with the full model.

use std::path::Path;

use super::cli::{Done, study};
use opshock_study::store::folder::session;
use opshock_study::store::{Record, Store, StudyTexts, load};

const SMALL: &[&str] = &[
    "pulse.widths_ms=[0.5]",
    "pulse.signs=[\"+\"]",
    "ramp.models=[\"none\", \"rigid\"]",
    "pulse.window_ms=0.8",
    "search.tolerance_pct=20",
    "resolution.preset=\"coarse\"",
    "search.max_refinements=0",
    "resolution.film_cells=100",
    "resolution.disk_cut_khz=10",
    "output.keep_histories=\"none\"",
];

fn sweep(folder: &Path, store: &str, audit: &str) -> Done {
    let path = study("fig13");
    let mut words = vec!["sweep", path.to_str().unwrap(), "--store", store];
    words.extend(["-j2", "--progress", "none", "--audit", audit]);
    for key in SMALL {
        words.extend(["--set", key]);
    }
    Done::of(folder, &words)
}

#[test]
fn an_audit_finds_every_altered_number_and_nothing_else() {
    let folder = tempfile::tempdir().expect("folder");
    let clean = sweep(folder.path(), "clean", "100%");
    assert!([0, 4].contains(&clean.code), "{}", clean.stderr);
    assert!(clean.stderr.contains("with all effects, no difference"));
    let report = |store: &str| Done::of(folder.path(), &["report", store, "--format", "json"]);
    let audit = report("clean").json()["audit"].clone();
    let runs = audit["runs"].as_u64().unwrap();
    assert!(runs > 5 && audit["of_runs"] == runs);
    let page = Done::of(folder.path(), &["report", "clean", "--format", "md"]).stdout;
    assert!(
        page.contains(&format!("audit: {runs} of {runs} simulations")),
        "{page}"
    );

    // What the rules saved, added up by hand; explain says the same.
    let (_, stored) = load(&folder.path().join("clean")).expect("loads");
    let stored = stored.expect("results");
    let onset_g = stored.summary.points[1].onset_g.expect("an onset");
    let bare = stored
        .runs
        .iter()
        .filter(|row| row.point == 0 && row.levels.is_none());
    let below = bare.filter(|row| row.amplitude_g < onset_g);
    let (n, steps) = below.fold((0, 0), |(n, steps), row| {
        (n + 1, steps + row.result().cost.steps)
    });
    assert!(n > 1 && onset_g > 150.0);
    let saved = report("clean").json()["savings"].clone();
    let rules: Vec<&str> = (0..9).map(|k| saved[k]["rule"].as_str().unwrap()).collect();
    assert_eq!(
        rules,
        ["R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8", "R9"]
    );
    let r4 = &saved[3];
    assert_eq!(r4["runs"], n);
    assert_eq!(r4["head_steps"], steps);
    let share = r4["share"].as_f64().unwrap();
    assert!(share > 0.0 && share < 0.5, "{share}");
    // Seconds are steps at the sweep's own seconds a step.
    let made: u64 = stored.runs.iter().map(|row| row.result().cost.steps).sum();
    let wall_s: f64 = stored.runs.iter().map(|row| row.run.machine.wall_s).sum();
    let reported = opshock_study::report::savings(&stored);
    let seconds = reported[3].seconds.expect("head steps");
    assert!((seconds / (wall_s * steps as f64 / made as f64) - 1.0).abs() < 1e-9);
    // Without ramp no harmonics; every run but the first of each of the two models took it over;
    // one film for both points.
    let count = |point: usize| {
        let of_point = stored.runs.iter().filter(|row| row.point == point);
        of_point.filter(|row| row.levels.is_none()).count()
    };
    assert_eq!(saved[1]["runs"], count(0));
    assert_eq!(saved[2]["runs"], count(1));
    assert_eq!(saved[4]["runs"], count(0) + count(1) - 2);
    assert_eq!(saved[8]["runs"], 1);
    assert!(reported[0].seconds.is_none() && saved[6]["runs"] == 0);
    assert!(
        saved[3]["seconds"].is_null(),
        "a sweep done again gives the same JSON"
    );
    assert!(!page.contains("saved"), "{page}");
    let verbose = Done::of(folder.path(), &["report", "clean", "--verbose"]).stderr;
    assert!(
        verbose.contains("rule R4 saved work in")
            && verbose.contains("rule R6 saved work in")
            && verbose.contains("rule R1 saved nothing: "),
        "{verbose}"
    );
    let path = study("fig13");
    let mut words = vec![
        "explain",
        path.to_str().unwrap(),
        "--store",
        "clean",
        "--json",
    ];
    words.extend(SMALL.iter().flat_map(|key| ["--set", key]));
    let explained = Done::of(folder.path(), &words).json();
    assert_eq!(explained["saved_in_sweep"], saved);

    // The plan stands with the results.
    let results = hdf5::File::open(folder.path().join("clean/results.h5")).unwrap();
    let plan = results.attr("plan").unwrap();
    let plan = plan.read_scalar::<hdf5::types::VarLenUnicode>().unwrap();
    let plan: serde_json::Value = serde_json::from_str(&plan).unwrap();
    assert_eq!(plan["outputs"], serde_json::json!(["critical_shock"]));
    let ramp = |ramp: &str| plan["ramps"][ramp].clone();
    assert_eq!(ramp("none")["effects"]["disk.travelling_waves"], "off");
    assert_eq!(ramp("rigid")["effects"]["ramp.contact"], "inactive");
    let has_r4 = |rules: &str| {
        let rules = ramp("rigid")[rules].clone();
        rules.as_array().unwrap().iter().any(|rule| rule == "R4")
    };
    assert!(has_r4("rules_below_touch") && !has_r4("rules_above_touch"));

    drop(results);

    // The same store with the smallest clearance of one surviving run a bit larger.
    let (loaded, _) = load(&folder.path().join("clean")).expect("loads");
    let owner = loaded.owner.expect("the study");
    let texts = StudyTexts {
        name: owner.name,
        digest: owner.digest,
        resolved: owner.resolved.unwrap(),
        ..StudyTexts::default()
    };
    let mut runs: Vec<_> = loaded.runs.into_values().collect();
    runs.sort_by_key(|run| run.key);
    let survivor = runs.iter_mut().find(|run| {
        run.key.window_factor == 1 && run.result.h_min_m.is_some_and(|height| height > 0.0)
    });
    let height = survivor.unwrap().result.h_min_m.as_mut().unwrap();
    let (true_m, false_m) = (*height, height.next_up());
    *height = false_m;
    let other = folder.path().join("altered");
    let (mut store, _) = Store::open(&other, &texts, &session(1)).expect("opens");
    let records: Vec<Record> = runs.into_iter().map(Record::Run).collect();
    store.append(&records).expect("appends");
    drop(store);
    let found = sweep(folder.path(), "altered", "1.0");
    assert_eq!(found.code, 7, "{}", found.stderr);
    let named = format!("h_min_m is {false_m:e} as stored and {true_m:e} with the full model");
    assert!(found.stderr.contains(&named), "{}", found.stderr);
    assert_eq!(found.stderr.matches("as stored").count(), 1);
    let kept = report("altered").json()["audit"]["differences"].clone();
    assert_eq!(kept.as_array().unwrap().len(), 1);
    assert_eq!(kept[0]["quantity"], "h_min_m");
}

#[test]
fn a_sample_is_a_share_and_a_wrong_share_is_refused() {
    let folder = tempfile::tempdir().expect("folder");
    for wrong in ["0", "0%", "101%", "two", "nan"] {
        let refused = sweep(folder.path(), "s", wrong);
        assert_eq!(refused.code, 2, "{wrong}");
        assert!(
            refused.stderr.contains("share above 0 %"),
            "{}",
            refused.stderr
        );
    }
    let done = sweep(folder.path(), "s", "20%");
    assert!([0, 4].contains(&done.code), "{}", done.stderr);
    let audit =
        Done::of(folder.path(), &["report", "s", "--format", "json"]).json()["audit"].clone();
    let of_runs = audit["of_runs"].as_f64().unwrap();
    assert_eq!(audit["runs"].as_f64().unwrap(), (0.2 * of_runs).ceil());
    // The sample is seeded: again, and with one thread, the same file.
    let file = || std::fs::read(folder.path().join("s/audit.json")).unwrap();
    let first = file();
    sweep(folder.path(), "s", "0.2");
    assert_eq!(first, file());
}
