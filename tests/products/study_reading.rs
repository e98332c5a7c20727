//! Study files as a user writes them: defaults, axes, `--set`, points, digest.

use opshock_study::study::{Ramp, SetArg, Sign, Study, StudyErrors};

pub(super) const SHORT: &str = "study_format = 2\nname = \"short\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\n";

pub(super) fn read(text: &str, sets: &[&str]) -> Result<Study, StudyErrors> {
    let sets: Vec<SetArg> = sets.iter().map(|set| SetArg::parse(set).unwrap()).collect();
    Study::from_text(text, &sets)
}

pub(super) fn codes(result: Result<Study, StudyErrors>) -> Vec<&'static str> {
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
    let study = read(
        SHORT,
        &["ramp.clearance_um=[60, 80]", "resolution.preset=coarse"],
    )
    .unwrap();
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
fn errors_are_listed_together() {
    let text = "study_format = 2\n[pulse]\nwidth_ms = 2\n[disk]\nthickness_mm = -1\nrpm = \"5400\"\n[ramp]\nmodels=[\"rigid\"]\n";
    assert_eq!(codes(read(text, &[])), ["E112", "E110", "E130", "E113"]);
}

#[test]
fn the_digest_does_not_see_order_spelling_and_comments() {
    let one = "study_format = 2\nname = \"d\"\n[pulse]\nwidths_ms = [0.5, 2.0]\n[disk]\nrpm = 5400.0\nthickness_mm = 0.635\n[ramp]\nmodels = [\"none\", \"rigid\"]\nclearance_um = 100.0\n";
    let other = "# a comment\nname = 'd'\nramp = { clearance_um = 1e2, models = [\"none\", \"rigid\"] }\n\ndisk.thickness_mm = 0.63500\nstudy_format = 0x2\npulse.widths_ms = [\n  0.5, # short\n  2,\n]\ndisk.rpm = 5_400\n";
    let (one, other) = (read(one, &[]).unwrap(), read(other, &[]).unwrap());
    assert_eq!(one.digest, other.digest);
    assert_eq!(one.resolved_toml(), other.resolved_toml());
    let ids = |study: &Study| {
        study
            .points
            .iter()
            .map(|point| point.id)
            .collect::<Vec<_>>()
    };
    assert_eq!(ids(&one), ids(&other));

    // Axes in either order, in the file or on the command line, are one study.
    let (rpm, gap) = ("disk.rpm=[5400, 7200]", "ramp.clearance_um=[60, 80]");
    let one = read(SHORT, &[rpm, gap]).unwrap();
    let other = read(SHORT, &[gap, rpm]).unwrap();
    let again = read(&one.resolved_toml(), &[]).unwrap();
    for other in [other, again] {
        assert_eq!(one.digest, other.digest);
        assert_eq!(one.axes, other.axes);
        assert_eq!(ids(&one), ids(&other));
    }
}

#[test]
fn an_identity_depends_on_the_scene_and_on_nothing_else() {
    let base = read(SHORT, &[]).unwrap();
    for set in [
        "name=other",
        "outputs=[\"min_clearance\"]",
        "search.tolerance_pct=2",
        "output.checkpoint_s=60",
        "resolution.not_refined=[\"disk_modes\"]",
        "pulse.start_ms=1",
        "ramp.clearance_top_um=100",
        "gas.altitude_m=0",
        "pulse.rise_share=0.2",
    ] {
        assert_eq!(
            read(SHORT, &[set]).unwrap().points[0].id,
            base.points[0].id,
            "{set}"
        );
    }
    let both = read(SHORT, &["ramp.models=[\"none\", \"rigid\"]"]).unwrap();
    let mut ids: Vec<_> = both.points.iter().map(|point| point.id).collect();
    assert!(ids.contains(&base.points[0].id) && ids.contains(&base.points[1].id));
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 4);
}

#[test]
fn a_value_of_the_model_is_not_refined() {
    use opshock_solver::scene::discretisation::{Discretisation, Levels};
    let sets = [
        "resolution.not_refined=[\"disk_modes\"]",
        "resolution.disk_cut_khz=40",
    ];
    let study = read(SHORT, &sets).unwrap();
    let scene = &study.points[0].scene;
    assert!(!scene.discretisations().contains(&Discretisation::DiskModes));
    assert!(
        scene
            .discretisations()
            .contains(&Discretisation::StructureStep)
    );
    let finer = Levels::NONE
        .changed(Discretisation::DiskModes, 1)
        .changed(Discretisation::StructureStep, 1);
    let finer = scene.at_levels(finer);
    assert_eq!(finer.disk_resolution, scene.disk_resolution);
    let step_s = scene.structure_resolution.step_s;
    assert_eq!(finer.structure_resolution.step_s, 0.5 * step_s);
    let values = "values of the model, not refined: disk modes to 40 kHz";
    assert_eq!(study.not_refined().as_deref(), Some(values));
    assert_eq!(read(SHORT, &sets[1..]).unwrap().not_refined(), None);
    let unknown = read(SHORT, &["resolution.not_refined=[\"disk\"]"]).unwrap_err();
    assert!(unknown.to_string().contains("disk_modes"), "{unknown}");
}

#[test]
fn the_command_line_wins_and_both_values_are_recorded() {
    let text = "study_format = 2\nname = \"w\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\nclearance_top_um = 90.0\nclearance_bottom_um = 110.0\n[disk]\nrpm = 5400.0\ndamping = { rayleigh = { alpha_per_s = 25.0, beta_s = 1.0e-7 } }\n";
    let study = read(text, &[
        "disk.rpm=7200",
        "disk.damping.modal_ratio=0.004",
        "ramp.clearance_um=80",
        "ramp.deformable.modes=[{ frequency_hz = 900.0, mass_mg = 54.4, participation = 0.275, damping_ratio = 0.005 }]",
        "ramp.models=deformable",
        "outputs=[\"disk_displacement\"]",
        "pulse.signs=-",
        "name=from the command line",
    ])
    .unwrap();
    let scene = &study.points[0].scene;
    assert_eq!(
        scene.disk.spin_rad_per_s,
        7200.0 * std::f64::consts::TAU / 60.0
    );
    assert_eq!(
        scene.disk.damping,
        opshock_solver::disk::DiskDamping::ModalRatio(0.004)
    );
    assert_eq!(
        (scene.ramp.clearance_top_m, scene.ramp.clearance_bottom_m),
        (80e-6, 80e-6)
    );
    let [top, bottom] = scene.ramp.model.arms().expect("separate arms");
    assert_eq!(top, bottom);
    assert_eq!(
        (top.len(), top[0].mass_kg, top[0].damping_ratio),
        (1, 54.4e-6, 0.005)
    );
    assert_eq!(study.points.len(), 1);
    assert_eq!(study.points[0].sign, Sign::Minus);
    assert_eq!(study.name, "from the command line");
    let plan = study.plan();
    assert_eq!(plan.needs, opshock_solver::scene::plan::Needs::Structure);
    let rpm = &study.overrides[0];
    assert_eq!(
        (
            rpm.key.as_str(),
            rpm.file_value.as_str(),
            rpm.set_value.as_str()
        ),
        ("disk.rpm", "5400.0", "7200")
    );
    assert_eq!(study.overrides[1].file_value, "");
}

#[test]
fn gas_follows_altitude_and_temperature() {
    let sea = read(SHORT, &[]).unwrap().points[0].scene.gas.clone();
    assert_eq!(
        (sea.pressure_pa, sea.viscosity_pa_s, sea.mean_free_path_m),
        (101325.0, 1.806e-5, 63.5e-9)
    );
    let high = read(SHORT, &["gas.altitude_m=3000"]).unwrap().points[0]
        .scene
        .gas
        .clone();
    assert!((high.pressure_pa / 70108.5 - 1.0).abs() < 1e-5);
    assert!((high.mean_free_path_m * high.pressure_pa / (63.5e-9 * 101325.0) - 1.0).abs() < 1e-12);
    let warm = read(SHORT, &["gas.temperature_c=60"]).unwrap().points[0]
        .scene
        .gas
        .clone();
    assert!(
        (warm.viscosity_pa_s - 2.0e-5).abs() < 0.02e-5,
        "{:e}",
        warm.viscosity_pa_s
    );
    assert!(warm.mean_free_path_m > 63.5e-9);
    let given = read(SHORT, &["gas.temperature_c=60", "gas.mean_free_path_nm=70"]).unwrap();
    assert_eq!(given.points[0].scene.gas.mean_free_path_m, 70e-9);
}

#[test]
fn a_sampled_pulse_is_stretched_and_scaled() {
    use opshock_solver::shock::PulseShape;
    let study = read(
        SHORT,
        &[
            "pulse.shape=table",
            "pulse.table_time_ms=[0, 1, 4]",
            "pulse.table_relative=[0, -20, 5]",
        ],
    )
    .unwrap();
    match &study.points[0].scene.pulse.shape {
        PulseShape::Table { time_s, relative } => {
            assert_eq!(time_s, &[0.0, 0.0005, 0.002]);
            assert_eq!(relative, &[0.0, -1.0, 0.25]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn clockwise_and_closed_polygons_become_counter_clockwise_and_open() {
    use opshock_solver::slider::RailOutline;
    let set = "slider.surface.rail=[{ kind = \"polygon\", points_um = [[0, 0], [0, 200], [200, 200], [0, 0]], recess_um = 0 }]";
    let study = read(SHORT, &[set]).unwrap();
    match &study.points[0].scene.slider.surface.rails[0].outline {
        RailOutline::Polygon { points_m } => {
            assert_eq!(points_m, &[[200e-6, 200e-6], [0.0, 200e-6], [0.0, 0.0]]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn presets_set_the_resolutions_and_single_keys_override_them() {
    let fine = read(
        SHORT,
        &["resolution.preset=fine", "resolution.film_cells=500"],
    )
    .unwrap();
    let scene = &fine.points[0].scene;
    assert_eq!(scene.film_resolution.cells, 500);
    assert_eq!(scene.structure_resolution.step_s, 0.125e-6);
    let spelt = read(
        SHORT,
        &["resolution.preset=fine", "resolution.film_cells=5e2"],
    )
    .unwrap();
    assert_eq!(spelt.digest, fine.digest);
    for preset in ["coarse", "standard", "fine"] {
        // What the resolved study writes out must give back the preset's own bits.
        let study = read(SHORT, &[&format!("resolution.preset={preset}")]).unwrap();
        let again = read(&study.resolved_toml(), &[]).unwrap();
        assert_eq!(study.points[0].scene, again.points[0].scene, "{preset}");
    }
}

#[test]
fn the_coupling_tolerance_follows_a_head_tolerance_set_alone() {
    let tolerances = |sets: &[&str]| -> Vec<[f64; 2]> {
        let study = read(SHORT, sets).unwrap();
        // The resolved study stands for the same points.
        let again = read(&study.resolved_toml(), &[]).unwrap();
        let scenes = |study: &Study| -> Vec<_> {
            study
                .points
                .iter()
                .map(|point| point.scene.clone())
                .collect()
        };
        assert_eq!(scenes(&study), scenes(&again), "{sets:?}");
        let mut pairs: Vec<[f64; 2]> = study
            .points
            .iter()
            .map(|point| &point.scene.head_resolution)
            .map(|head| [head.tolerance, head.coupling_tolerance])
            .collect();
        pairs.dedup();
        pairs
    };
    let preset = tolerances(&["resolution.preset=standard"]);
    assert_eq!(preset, [[2e-2, 2e-4]]);
    assert_eq!(
        tolerances(&["resolution.head_tolerance=1e-3"]),
        [[1e-3, 0.01 * 1e-3]]
    );
    let both = [
        "resolution.head_tolerance=1e-3",
        "resolution.coupling_tolerance=1e-8",
    ];
    assert_eq!(tolerances(&both), [[1e-3, 1e-8]]);
    let mut axis = tolerances(&["resolution.head_tolerance=[1e-2, 1e-3]"]);
    axis.sort_by(|a, b| a[0].total_cmp(&b[0]));
    axis.dedup();
    assert_eq!(axis, [[1e-3, 0.01 * 1e-3], [1e-2, 0.01 * 1e-2]]);
}

#[test]
fn the_example_study_is_valid_for_any_name() {
    for name in [
        "my drive",
        "",
        "a/b",
        "\"quoted\"",
        "back\\slash",
        "tab\there",
        "日本",
    ] {
        let study = Study::from_text(&Study::example(name), &[])
            .unwrap_or_else(|errors| panic!("{name:?}: {errors}"));
        assert!(study.remarks.is_empty());
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(300))]

    /// Whatever is done to a study's text, reading it ends with a study or with errors that have
    /// places, never with a panic.
    #[test]
    fn no_text_makes_the_reader_panic(edits in proptest::collection::vec((0.0..1.0_f64, 0..8_usize, 0..12_usize), 1..6)) {
        let mut text = read(SHORT, &[]).unwrap().resolved_toml();
        for (place, cut, piece) in edits {
            let mut at = (place * text.len() as f64) as usize;
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            let end = (at + cut).min(text.len());
            let insert = ["", "]", "[", "{", "}", "=", "\n", "-1", "nan", "\"", "é", "[[1e999, 0.5], {}]"][piece];
            if text.is_char_boundary(end) {
                text.replace_range(at..end, insert);
            }
        }
        match read(&text, &[]) {
            Ok(study) => proptest::prop_assert!(!study.points.is_empty()),
            Err(errors) => {
                proptest::prop_assert!(!errors.errors.is_empty());
                proptest::prop_assert!(errors.errors.len() <= 50);
                let _ = errors.to_terminal(80, true);
                let _ = errors.to_json();
            }
        }
    }

    /// Any --set argument is refused or read, never a panic.
    #[test]
    fn no_set_argument_makes_the_reader_panic(key in "[a-z_.\\[\\]0-3]{1,24}", value in "[\\[\\]{}=,\"a-z0-9.+-]{1,24}") {
        if let Ok(set) = SetArg::parse(&format!("{key}={value}")) {
            let _ = Study::from_text(SHORT, &[set]);
        }
        for known in ["disk.rpm", "pulse.widths_ms", "ramp.models", "slider.surface", "ramp.deformable.modes", "outputs", "disk", "slider.surface.rail[1]"] {
            if let Ok(set) = SetArg::parse(&format!("{known}={value}")) {
                let _ = Study::from_text(SHORT, &[set]);
            }
        }
    }
}

/// TOML takes `.1` and `1.` for no numbers; the hint names the digit that is missing.
#[test]
fn a_number_without_a_digit_beside_its_point_is_reported_so() {
    let text = Study::example("point");
    for (value, hint) in [
        (
            ".1",
            "write thickness_mm = 0.1: TOML needs a digit before the point",
        ),
        (
            "-.5e1",
            "write thickness_mm = -0.5e1: TOML needs a digit before the point",
        ),
        (
            "1.",
            "write thickness_mm = 1.0: TOML needs a digit after the point",
        ),
        (
            "0.5mm",
            "write thickness_mm = 0.5: without quotes, the unit is in the key's name",
        ),
        ("thin", "for example thickness_mm = "),
    ] {
        let set = format!("disk.thickness_mm={value}").parse().unwrap();
        let reported = Study::from_text(&text, &[set]).unwrap_err().to_string();
        assert!(
            reported.contains("E113") && reported.contains(hint),
            "{reported}"
        );
    }
}

#[test]
fn a_mode_of_the_base_without_damping_has_the_default() {
    let mode = "frequency_hz = 900.0\nparticipation_sqrt_kg = 0.25\nspindle_per_sqrt_kg = 2.0\n\
                ramp_per_sqrt_kg = 2.4\npivot_per_sqrt_kg = 1.6\n";
    let text = format!("{SHORT}[[base.modes]]\n{mode}");
    let study = Study::from_text(&text, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let scene = &study.points[0].scene;
    assert_eq!(scene.base[0].damping_ratio, 0.02);
}

/// A share of the critical shock, half the width of its interval: 2 % as given, else that of the preset, 1 %.
#[test]
fn the_target_uncertainty_is_a_share() {
    for (line, share) in [("target_uncertainty_pct = 2.0", 0.02), ("", 0.01)] {
        let text = format!("{SHORT}[search]\n{line}\n");
        let study = Study::from_text(&text, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(study.points[0].target_uncertainty, share, "{line}");
    }
}

#[test]
fn what_is_unset_is_as_if_the_file_did_not_have_it() {
    let text = format!("{SHORT}\n[surface_forces]\nhamaker_j = 1.8e-19\n");
    let unset = |keys: &[&str]| {
        let sets: Vec<SetArg> = keys.iter().map(|key| SetArg::unset(key).unwrap()).collect();
        Study::from_text(&text, &sets)
    };
    let plain = read(SHORT, &[]).unwrap();
    assert_ne!(unset(&[]).unwrap().digest, plain.digest);
    // A section, a key, and a key that is not there.
    for keys in [
        &["surface_forces"][..],
        &["surface_forces.hamaker_j"],
        &["surface_forces", "ramp.contact_stiffness_n_per_m"],
    ] {
        let study = unset(keys).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(study.digest, plain.digest, "{keys:?}");
        assert_eq!(study.overrides.len(), 1);
        assert_eq!(study.overrides[0].set_value, "");
    }
    let code = |keys: &[&str]| unset(keys).unwrap_err().errors[0].code;
    assert_eq!(code(&["name"]), "E112");
    assert_eq!(code(&["ramp.contact_stifness_n_per_m"]), "E110");
    assert_eq!(code(&["disk.rpm", "disk.rpm.x"]), "E114");
    assert!(SetArg::unset("disk rpm").is_err() && SetArg::unset("").is_err());
    // An entry that is taken away moves those behind it, and one that is not there is a mistake.
    let modes = |k: usize| format!("ramp.deformable.modes[{k}]");
    let count = |study: Study| {
        study
            .resolved_toml()
            .matches("[[ramp.deformable.modes]]")
            .count()
    };
    let all = count(plain);
    assert_eq!(count(unset(&[&modes(0)]).unwrap()), all - 1);
    assert_eq!(code(&[&modes(0), &modes(1)]), "E114");
    assert_eq!(code(&[&modes(99)]), "E113");
}
