//! `figures`: what is drawn is what the runs computed and what the scene says, and always the same.

use super::cli::{COARSE, Done, files, study};
use opshock_study::study::Study;
use std::collections::HashMap;
use std::path::Path;

/// Pulses of the paper's drive, on a coarse film and a short window.
const WIDTHS: [&str; 2] = ["--set", "pulse.widths_ms=[0.5, 1.0]"];
const TABLE: &str = "ramp,pulse_ms,sign,a_crit_g,uncertainty_g,half_min_height_g,survived_g,failed_g,onset_g,runs,status,flags\n\
                     rigid,0.5,+,202.9,1,-0.5,201.9,203.9,195.3,4,ok,\n\
                     none,0.5,-,,,,473.5,,,17,above_range,window\n";

fn figures(folder: &Path, more: &[&str]) -> Done {
    let path = study("paper-cases");
    let start = ["figures", path.to_str().unwrap(), "--long", "1:300"];
    Done::of(folder, &[&start[..], &WIDTHS, &COARSE, more].concat())
}

/// Columns of a CSV as the words in it; empty cells left out.
fn columns(path: &Path) -> HashMap<String, Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(','));
    let names: Vec<&str> = lines.next().unwrap().collect();
    let mut columns: HashMap<String, Vec<String>> = HashMap::new();
    for line in lines {
        for (name, cell) in names.iter().zip(line) {
            let column = columns.entry((*name).to_owned()).or_default();
            if !cell.is_empty() {
                column.push(cell.to_owned());
            }
        }
    }
    columns
}

fn corners(path: &Path, outline: &str) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .map(|line| line.split(',').collect::<Vec<_>>())
        .filter(|cells| cells[0].trim_matches('"') == outline)
        .map(|cells| (cells[2].parse().unwrap(), cells[3].parse().unwrap()))
        .collect()
}

#[test]
fn every_figure_is_written_the_same_twice_and_holds_the_histories() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("table.csv"), TABLE).unwrap();
    for out in ["a", "b"] {
        let done = figures(folder.path(), &["--critical", "table.csv", "--out", out]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert_eq!(done.stdout.lines().count(), 13 * 3 + 1);
    }
    let (first, second) = (files(&at("a")), files(&at("b")));
    assert_eq!(first.len(), 13 * 3 + 1);
    for (one, other) in first.iter().zip(&second) {
        assert_eq!(one.file_name(), other.file_name());
        assert!(
            std::fs::read(one).unwrap() == std::fs::read(other).unwrap(),
            "{} differs",
            one.display()
        );
    }
    assert_eq!(std::fs::read_to_string(at("a/fig13.csv")).unwrap(), TABLE);

    // The same shock by `run`: every cell of the figures is one of its history.
    let path = study("paper-cases");
    let shock = [
        "run",
        path.to_str().unwrap(),
        "--ramp",
        "deformable",
        "--pulse-ms",
        "1",
        "--amplitude-g",
        "300",
    ];
    let done = Done::of(
        folder.path(),
        &[&shock[..], &WIDTHS, &COARSE, &["--history", "h.csv"]].concat(),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let run = columns(&at("h.csv"));
    let row: HashMap<&String, usize> = run["time_s"].iter().zip(0..).collect();
    for (figure, names) in [
        ("a/fig05.csv", &["disk_slider_m"][..]),
        ("a/fig06.csv", &["contact_top_n", "contact_bottom_n"]),
        (
            "a/fig07.csv",
            &["disk_rim_m", "disk_ramp_m", "ramp_top_m", "ramp_bottom_m"],
        ),
        ("a/fig08.csv", &["disk_pitch_rad"]),
    ] {
        let drawn = columns(&at(figure));
        assert!(drawn["time_s"].len() > 400, "{figure}");
        for name in names {
            let values = &drawn[&format!("deformable_{name}")];
            assert_eq!(values.len(), drawn["time_s"].len());
            for (time, value) in drawn["time_s"].iter().zip(values) {
                assert_eq!(value, &run[*name][row[time]], "{figure} {name} at {time} s");
            }
        }
    }
    let done = Done::of(
        folder.path(),
        &[&shock[..], &WIDTHS, &COARSE, &["--history", "h.h5"]].concat(),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let file = hdf5::File::open(at("h.h5")).unwrap();
    let head = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let drawn = columns(&at("a/fig09.csv"));
    let number = |name: &str| -> Vec<f64> {
        drawn[name]
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect()
    };
    assert_eq!(number("deformable_head_time_s"), head("head/time_s"));
    assert_eq!(
        number("deformable_min_clearance_m"),
        head("head/min_clearance_m")
    );

    // The drawings: the manual's disk, the slider where the study says, 100 um between disk and contact points.
    let largest = |points: &[(f64, f64)]| points.iter().fold(0.0f64, |m, p| m.max(p.0.hypot(p.1)));
    let plan = at("a/fig01.csv");
    assert!((largest(&corners(&plan, "disk")) - 32.5e-3).abs() < 1e-12);
    let slider = &corners(&plan, "slider")[..4];
    let centre = slider
        .iter()
        .fold((0.0, 0.0), |c, p| (c.0 + 0.25 * p.0, c.1 + 0.25 * p.1));
    let read = Study::from_path(&study("paper-cases"), &[]).expect("a study");
    let place = &read.points[0].scene.slider;
    assert!((centre.0.hypot(centre.1) - place.radius_m).abs() < 1e-12);
    assert!((centre.1.atan2(centre.0) - place.angle_rad).abs() < 1e-11);
    for section in ["a/fig02.csv", "a/fig03.csv"] {
        let disk = corners(&at(section), "disk");
        let contact = corners(&at(section), "contact point");
        assert!((contact[0].1 - disk[0].1 - 100e-6).abs() < 1e-12);
        assert!((disk[3].1 - contact[1].1 - 100e-6).abs() < 1e-12);
        assert!((contact[0].0 - 32.15e-3).abs() < 1e-12);
    }
}

#[test]
fn a_table_that_nobody_named_is_no_figure_of_this_drive() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("results/fig13/table.csv");
    std::fs::create_dir_all(table.parent().unwrap()).unwrap();
    std::fs::write(&table, TABLE).unwrap();
    // The store is named, so that one beside the shipped study cannot matter.
    let done = figures(folder.path(), &["--out", "a", "--store", "none.opshock"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.stderr.contains("no figure 13: E187"),
        "{}",
        done.stderr
    );
    assert!(!folder.path().join("a/fig13.csv").exists());
    assert!(folder.path().join("a/fig12.csv").exists());
}

#[test]
fn what_cannot_be_drawn_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("table.csv"), TABLE.replace("203.9", "x")).unwrap();
    for (more, reported) in [
        (
            &["--critical", "table.csv"][..],
            "table.csv, line 2: failed_g = \"x\" must be a number",
        ),
        (&["--critical", "none.csv"], "cannot read none.csv"),
        (&["--short", "0.5"], "must be MS:G"),
        (
            &["--set", "outputs=[\"disk_displacement\"]"],
            "its outputs leave out the head",
        ),
    ] {
        let done = figures(folder.path(), more);
        assert_eq!(done.code, 2, "{}", done.stderr);
        assert!(done.stderr.contains(reported), "{}", done.stderr);
        assert!(!at("results").exists());
    }
}

#[test]
fn without_a_table_or_a_ramp_model_its_figures_are_left_out_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let done = figures(folder.path(), &["--set", "ramp.models=[\"none\"]"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    for reported in ["no figure 2:", "no figures 3 and 7:", "no figure 13:"] {
        assert!(done.stderr.contains(reported), "{}", done.stderr);
    }
    let written = files(&folder.path().join("results/paper"));
    assert_eq!(written.len(), 9 * 3 + 1);
}
