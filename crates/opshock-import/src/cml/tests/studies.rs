//! Tests of surface files and studies that are written from files of the CMLAir family.

use super::{codes, flights, shaken, surface};
use crate::cml::dynamic::{DynamicFile, Shape, Shock};
use crate::cml::rail::Recess;
use crate::cml::{drive, study};

#[test]
fn surfaces_become_toml() {
    let mut file = surface();
    let faults = study::surface(&file, "rail.dat").unwrap_err();
    assert_eq!((codes(&faults), faults.listed[0].line), (vec!["E176"], 11));
    file.rails[1].recess = Recess::Step(0.0);
    let written = study::surface(&file, "rail.dat").unwrap();
    assert!(
        written
            .text
            .contains("points_um = [[0, 100], [300, 100], [300, 900], [0, 900]]")
    );
    assert!(
        written.text.contains("crown_nm = 12.7\ncamber_nm = -3.1\n"),
        "{}",
        written.text
    );
    assert_eq!(written.left_out.len(), 2);
}

#[test]
fn flights_become_a_study() {
    let asked = study::Asked {
        name: "a \"drive\"",
        surface_file: "surface.toml",
        run_file: "run.dat",
        radius: 2,
        speed: 1,
    };
    let written = study::study(&surface(), Some(&flights()), asked).unwrap();
    for line in [
        "name = \"a \\\"drive\\\"\"",
        "rpm = 5400",
        "radius_mm = 22.215",
        "skew_deg = 0.943",
        "gram_load_gf = 2.5",
        "mean_free_path_nm = 63.5",
        "length_mm = 1.25",
        "model = \"fukui_kaneko\"",
        "[surface_forces]",
        "hamaker_j = 1.8e-19",
        "repulsion_j_m6 = 1.1e-76",
        "potential_v = -0.5",
    ] {
        assert!(
            written.text.lines().any(|found| found == line),
            "{line}\n{}",
            written.text
        );
    }
    // Two radii, one of which is taken.
    assert_eq!(written.left_out.len(), 1);
    let mut without = flights();
    (
        without.hamaker_j,
        without.repulsion_j_m6,
        without.potential_v,
    ) = (0.0, 0.0, 0.0);
    let plain = study::study(&surface(), Some(&without), asked).unwrap();
    assert!(!plain.text.contains("surface_forces"));
    let other = study::Asked { radius: 3, ..asked };
    let faults = study::study(&surface(), Some(&flights()), other).unwrap_err();
    assert_eq!(faults.listed[0].allowed, "1 to 2");
}

/// A dynamic run without `run.dat`.
const DRIVE: study::Asked<'static> = study::Asked {
    name: "drive",
    surface_file: "surface.toml",
    run_file: "",
    radius: 1,
    speed: 1,
};

/// The sample drive's ramp is 0.35 mm inside the rim, 7 degrees before the slider. At another radius the same arm has
/// the skew that its circle gives, and leads to the same ramp.
#[test]
fn the_ramps_place_follows_from_the_pivot() {
    let number = |file: &DynamicFile, section: &str, key: &str| -> f64 {
        let written =
            drive::study(&surface(), None, (file, "DynLULS.def"), (None, None), DRIVE).unwrap();
        let text = written.text.split(section).nth(1).unwrap();
        let line = text.lines().find(|line| line.starts_with(key)).unwrap();
        line.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let file = shaken();
    let ramp = number(&file, "[ramp]", "radius_mm");
    let turn = number(&file, "[slider]", "angle_deg");
    assert!((ramp - 32.15).abs() < 0.005, "{ramp}");
    assert!((turn - 7.0).abs() < 0.05, "{turn}");
    // Moved in by a turn of the arm: sin s = (r² + L² − c²)/(2 r L), the ramp's angle grows by the turn.
    let (r, l) = (file.radius_m, file.arm_m);
    let c2 = r * r + l * l - 2.0 * r * l * file.skew_deg.to_radians().sin();
    let at = |r: f64| ((c2 + l * l - r * r) / (2.0 * c2.sqrt() * l)).acos();
    let mut inner = file.clone();
    inner.radius_m = 17.9e-3;
    inner.skew_deg = ((inner.radius_m.powi(2) + l * l - c2) / (2.0 * inner.radius_m * l))
        .asin()
        .to_degrees();
    assert!((inner.skew_deg + 6.13).abs() < 0.01, "{}", inner.skew_deg);
    inner.ramp.angle_deg += (at(r) - at(inner.radius_m)).to_degrees();
    assert_eq!(number(&inner, "[ramp]", "radius_mm"), ramp);
}

#[test]
fn pulses_of_dynamic_runs_become_those_of_a_study() {
    let rail = surface();
    let pulse = |shape: Option<Shape>| {
        let mut file = shaken();
        file.shock = shape.zip(file.shock).map(|(shape, shock)| Shock {
            shape,
            time_constant_s: 2e-3,
            ..shock
        });
        let written =
            drive::study(&rail, None, (&file, "DynLULS.def"), (None, None), DRIVE).unwrap();
        let section = written.text.split("[pulse]\n").nth(1).unwrap();
        section.split("\n\n").next().unwrap().to_owned()
    };
    let rest = "signs = [\"+\", \"-\"]";
    let start = "start_ms = 0.5";
    for (shape, wanted) in [
        (None, format!("widths_ms = [0.5, 1.0, 2.0]\n{rest}")),
        (
            Some(Shape::HalfSine),
            format!("shape = \"half_sine\"\nwidths_ms = [1]\n{rest}\n{start}"),
        ),
        (
            Some(Shape::Square),
            format!("shape = \"square\"\nwidths_ms = [1]\n{rest}\n{start}"),
        ),
        (
            Some(Shape::Sine),
            format!(
                "shape = \"damped_sine\"\nfrequency_hz = 1000.0\ndecay_per_s = 0.0\nwidths_ms = [1]\n{rest}\n{start}"
            ),
        ),
        (
            Some(Shape::DecayingSine),
            format!(
                "shape = \"damped_sine\"\nfrequency_hz = 1000.0\ndecay_per_s = 500.0\nwidths_ms = [14]\n{rest}\n{start}\nwindow_ms = 28"
            ),
        ),
    ] {
        assert_eq!(pulse(shape), wanted);
    }
}
