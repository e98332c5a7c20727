//! Study files as a user writes them: defaults, axes, `--set`, points, digest.

use opshock_study::study::{AxisValue, Ramp, SetArg, Sign, Study, StudyErrors};

const SHORT: &str = "study_format = 1\nname = \"short\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\n";

fn read(text: &str, sets: &[&str]) -> Result<Study, StudyErrors> {
    let sets: Vec<SetArg> = sets.iter().map(|set| SetArg::parse(set).unwrap()).collect();
    Study::from_text(text, &sets)
}

fn codes(result: Result<Study, StudyErrors>) -> Vec<&'static str> {
    result
        .err()
        .map(|errors| errors.errors.iter().map(|e| e.code).collect())
        .unwrap_or_default()
}

#[test]
fn a_short_study_takes_the_default_drive() {
    let study = read(SHORT, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(study.points.len(), 2);
    assert!(study.remarks.is_empty(), "{:?}", study.remarks);
    let scene = &study.points[0].scene;
    assert_eq!(scene.disk.inner_radius_m, 0.01001);
    assert_eq!(scene.disk.thickness_m, 0.000635);
    assert_eq!(scene.suspension.gram_load_n, 2.2 * 9.80665e-3);
    assert_eq!(scene.slider.surface.rails.len(), 8);
    assert_eq!(scene.ramp.clearance_top_m, 1e-4);
    assert_eq!(study.points[0].sign, Sign::Plus);
    assert_eq!(study.points[0].ramp, Ramp::Rigid);
    assert_eq!(study.start_s, 0.0005);
}

#[test]
fn the_resolved_study_reads_back_to_the_same_study() {
    let study = read(SHORT, &["ramp.clearance_um=[60, 80]", "solver.accuracy=5%"]).unwrap();
    let again = read(&study.resolved_toml(), &[])
        .unwrap_or_else(|e| panic!("{e}\n{}", study.resolved_toml()));
    assert_eq!(study.resolved_toml(), again.resolved_toml());
    assert_eq!(study.digest, again.digest);
    for (a, b) in study.points.iter().zip(&again.points) {
        assert_eq!(a.id, b.id);
        assert_eq!(a.scene, b.scene);
    }
}

#[test]
fn a_list_makes_an_axis_outside_widths_ramps_and_signs() {
    let study = read(
        SHORT,
        &[
            "ramp.clearance_um=[60, 80, 100]",
            "pulse.widths_ms=[0.5, 1, 2]",
        ],
    )
    .unwrap();
    assert_eq!(study.points.len(), 18);
    assert_eq!(study.axes[0].column, "clearance_um");
    let order: Vec<(AxisValue, f64, Sign)> = study
        .points
        .iter()
        .map(|point| (point.axes[0].1.clone(), point.pulse_ms, point.sign))
        .collect();
    assert_eq!(order[0], (AxisValue::Number(60.0), 0.5, Sign::Plus));
    assert_eq!(order[1], (AxisValue::Number(60.0), 0.5, Sign::Minus));
    assert_eq!(order[2], (AxisValue::Number(60.0), 2.0, Sign::Plus));
    assert_eq!(order[4], (AxisValue::Number(60.0), 1.0, Sign::Plus));
    assert_eq!(order[6], (AxisValue::Number(80.0), 0.5, Sign::Plus));
    assert_eq!(study.points[17].scene.ramp.clearance_bottom_m, 1e-4);
}

#[test]
fn errors_are_listed_together() {
    let text = "study_format = 1\n[pulse]\nwidth_ms = 2\n[disk]\nthickness_mm = -1\nrpm = \"5400\"\n[ramp]\nmodels=[\"rigid\"]\n";
    assert_eq!(codes(read(text, &[])), ["E112", "E110", "E130", "E113"]);
}
