//! The studies that come with opshock.

use std::path::{Path, PathBuf};

use opshock_study::study::{Choice, Point, Ramp, SetArg, Sign, Study};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies")
}

fn read(name: &str) -> Study {
    let path = folder().join(name).join("study.toml");
    Study::from_path(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn every_study_is_clean_and_documented() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let entry = entry.unwrap();
        if !entry.file_type().unwrap().is_dir() {
            continue;
        }
        let name = entry.file_name().into_string().unwrap();
        let study = read(&name);
        assert!(study.remarks.is_empty(), "{name}: {:?}", study.remarks);
        assert!(
            entry.path().join("README.md").is_file(),
            "{name} has no README.md"
        );
        for line in study
            .text
            .lines()
            .filter(|line| !line.trim_start().starts_with('#'))
        {
            if let Some(at) = line.find('=') {
                assert!(
                    line[..at].ends_with(' ') && !line[..at].ends_with("  "),
                    "{name}: {line}"
                );
                assert!(line[at + 1..].starts_with(' '), "{name}: {line}");
            }
        }
        names.push(name);
    }
    for expected in [
        "fig13",
        "fig13-converged",
        "fig13-stiffness",
        "paper-cases",
        "drive-2.5in",
        "clearance",
        "damage",
        "touch",
    ] {
        assert!(
            names.iter().any(|name| name == expected),
            "studies/{expected} is missing"
        );
    }
}

#[test]
fn comments_do_not_repeat_key_names() {
    for name in [
        "fig13/study.toml",
        "fig13/surface.toml",
        "fig13-converged/study.toml",
        "fig13-stiffness/study.toml",
        "paper-cases/study.toml",
        "drive-2.5in/study.toml",
    ] {
        let text = std::fs::read_to_string(folder().join(name)).unwrap();
        let comments: Vec<&str> = text
            .lines()
            .filter(|line| line.trim_start().starts_with('#'))
            .collect();
        for key in opshock_study::study::keys::KEYS.iter() {
            // Names with a unit or an underscore; `name` or `rail` are words of the language.
            if key.name().contains('_') {
                for comment in &comments {
                    assert!(!comment.contains(key.name()), "{name}: {comment}");
                }
            }
        }
    }
}

#[test]
fn fig13_has_the_points_of_the_figure_in_canonical_order() {
    let study = read("fig13");
    assert_eq!(study.points.len(), 36);
    let first: Vec<(f64, Ramp, Sign)> = study.points[..7]
        .iter()
        .map(|point| (point.pulse_ms, point.ramp, point.sign))
        .collect();
    assert_eq!(
        first,
        [
            (0.5, Ramp::None, Sign::Plus),
            (0.5, Ramp::None, Sign::Minus),
            (0.5, Ramp::Rigid, Sign::Plus),
            (0.5, Ramp::Rigid, Sign::Minus),
            (0.5, Ramp::Deformable, Sign::Plus),
            (0.5, Ramp::Deformable, Sign::Minus),
            (3.0, Ramp::None, Sign::Plus),
        ]
    );
    let widths: Vec<f64> = study
        .points
        .iter()
        .step_by(6)
        .map(|point| point.pulse_ms)
        .collect();
    assert_eq!(widths, [0.5, 3.0, 1.0, 0.75, 1.5, 2.0]);
    let scene = &study.points[4].scene;
    assert_eq!(scene.suspension.gram_load_n, 0.89 * 9.80665e-3);
    let rails = &scene.slider.surface.rails;
    assert_eq!(rails.len(), 8);
}

fn read_with(name: &str, set: &str) -> Study {
    let path = folder().join(name).join("study.toml");
    let set = SetArg::parse(set).unwrap();
    Study::from_path(&path, &[set]).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn clearance_and_geometry_have_the_drive_of_fig13_stiffness_but_for_what_they_ask() {
    let geometry = read("fig13-geometry");
    let (coarse, figure) = (
        read_with("fig13-stiffness", "resolution.preset=coarse"),
        read("fig13-stiffness"),
    );
    let cases = [(&coarse, read("clearance"), 144), (&figure, geometry, 16)];
    for (figure, study, points) in &cases {
        assert_eq!(study.points.len(), *points);
        for point in &study.points {
            let mut scene = point.scene.clone();
            let twin = &twin(figure, point).scene;
            scene.ramp.clearance_top_m = twin.ramp.clearance_top_m;
            scene.ramp.clearance_bottom_m = twin.ramp.clearance_bottom_m;
            if study.name == "Fig. 13 with a ramp from geometry" {
                scene.ramp.model = twin.ramp.model.clone();
            }
            assert_eq!(scene, *twin, "{}: {}", study.name, point.label());
        }
    }
    // The contact among it.
    let stiffness = |point: &Point| point.scene.ramp.contact_stiffness_n_per_m;
    let clearance = &cases[0].1.points;
    assert!(clearance.iter().all(|point| stiffness(point) == Some(1e6)));
}

/// The point of the same ramp model, width and sign.
fn twin<'a>(figure: &'a Study, point: &Point) -> &'a Point {
    let of = |point: &Point| (point.ramp, point.sign, point.pulse_ms);
    let mut points = figure.points.iter();
    points.find(|other| of(other) == of(point)).unwrap()
}

#[test]
fn converged_disk_modes_are_all_that_differs_from_fig13() {
    let (figure, converged) = (read("fig13"), read("fig13-converged"));
    assert_eq!(converged.points.len(), 36);
    for point in &converged.points {
        let twin = &twin(&figure, point).scene;
        assert_eq!(twin.disk_resolution.cut_hz, 80e3);
        assert_eq!(point.scene.disk_resolution.cut_hz, 240e3);
        assert_eq!(point.scene.not_refined, []);
        let mut scene = point.scene.clone();
        scene.disk_resolution.cut_hz = twin.disk_resolution.cut_hz;
        scene.not_refined = twin.not_refined.clone();
        assert_eq!(scene, *twin, "{}", point.label());
        assert_eq!(scene.ramp.contact_stiffness_n_per_m, None);
    }
}

#[test]
fn the_paper_cases_use_the_drive_of_fig13() {
    let (figure, cases) = (read("fig13"), read("paper-cases"));
    for point in &cases.points {
        let twin = twin(&figure, point);
        assert_eq!(twin.scene, point.scene);
        assert_eq!(twin.id, point.id);
    }
    for (ramp, pulse_ms, amplitude_g) in [
        (Ramp::Rigid, 2.0, 400.0),
        (Ramp::Deformable, 2.0, 400.0),
        (Ramp::Rigid, 0.5, 200.0),
        (Ramp::Deformable, 0.5, 200.0),
    ] {
        let shot = cases
            .select(&Choice {
                ramp: Some(ramp),
                pulse_ms: Some(pulse_ms),
                amplitude_g: Some(amplitude_g),
                sign: None,
            })
            .unwrap();
        assert_eq!(shot.amplitude_m_per_s2, amplitude_g * 9.80665);
        assert_eq!(shot.point.pulse_width_s, pulse_ms / 1e3);
    }
}

#[test]
fn the_default_drive_is_what_short_studies_get() {
    let written_out = read("drive-2.5in");
    let short = "study_format = 2\nname = \"short\"\n[pulse]\nwidths_ms = [0.5, 1.0, 2.0, 3.0]\n[ramp]\nmodels = [\"none\", \"rigid\", \"deformable\"]\n";
    let short = Study::from_text(short, &[]).unwrap();
    assert_eq!(written_out.points.len(), short.points.len());
    for (a, b) in written_out.points.iter().zip(&short.points) {
        // The gas is given by its numbers in one and by the reference state in the other.
        assert!((a.scene.gas.mean_free_path_m / b.scene.gas.mean_free_path_m - 1.0).abs() < 1e-15);
        assert_eq!(a.scene, b.scene);
    }
}
