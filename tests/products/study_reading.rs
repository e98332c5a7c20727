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

#[test]
fn the_table_of_keys_is_consistent() {
    use opshock_study::study::key::{Kind, Presence};
    use opshock_study::study::keys::{CHOICES, KEYS, find};
    use opshock_study::study::unit;

    // Ratios, shares, exponents and the like: everything else carries its unit.
    let plain = [
        "poisson",
        "modal_ratio",
        "damping_ratio",
        "contact_damping_ratio",
        "participation",
        "restitution",
        "rise_share",
        "decay_share",
        "approach_share",
        "head_tolerance",
        "coupling_tolerance",
        "table_relative",
        "base",
        "held",
        "in_plane_x",
        "in_plane_y",
    ];
    for (position, key) in KEYS.iter().enumerate() {
        assert!(
            KEYS[..position].iter().all(|other| other.path != key.path),
            "{} twice",
            key.path
        );
        assert!(
            key.help.ends_with('.') && !key.help.is_empty(),
            "{}: {:?}",
            key.path,
            key.help
        );
        assert!(!key.example().is_empty(), "{} has no example", key.path);
        let number = matches!(
            key.kind,
            Kind::Number(_)
                | Kind::NumberOrWord(..)
                | Kind::Axis(_)
                | Kind::Numbers(_)
                | Kind::Pair(_)
                | Kind::Points
        );
        assert_eq!(
            number && unit::of_path(key.path).is_none(),
            number && plain.contains(&key.name()),
            "{}: {:?}",
            key.path,
            unit::of_path(key.path).map(|unit| unit.suffix)
        );
        if let (Kind::Number(range), Some((low, high))) = (key.kind, key.usual) {
            assert!(
                low < high && (range.contains(low) || low == 0.0) && range.contains(high),
                "{}",
                key.path
            );
        }
        if let Presence::Together(_) = key.presence {
            assert!(CHOICES.iter().any(|choice| {
                choice
                    .alternatives
                    .iter()
                    .any(|paths| paths.contains(&key.path))
            }));
        }
    }
    for choice in CHOICES {
        for path in choice.alternatives.iter().flat_map(|paths| paths.iter()) {
            assert!(find(path).is_some(), "{path}");
        }
    }
    for unit in unit::UNITS.iter().filter(|unit| unit.in_use) {
        let used = KEYS
            .iter()
            .any(|key| unit::of_path(key.path).is_some_and(|found| found.suffix == unit.suffix));
        let promised = ["s", "us", "kg", "urad"].contains(&unit.suffix);
        assert!(used || promised, "no key uses _{}", unit.suffix);
    }
}

/// A value of the key that differs from its default and fits a study built around it.
fn other_value(key: &opshock_study::study::key::Key) -> Option<String> {
    use opshock_study::study::key::Kind;
    let words = |words: &[&str]| {
        words
            .iter()
            .map(|word| format!("{word:?}"))
            .collect::<Vec<_>>()
    };
    Some(match key.path {
        "study_format" => return None,
        "name" => "\"another\"".to_string(),
        "outputs" => "[\"disk_displacement\"]".to_string(),
        "ramp.models" => "[\"none\", \"rigid\"]".to_string(),
        "ramp.radius_mm" => "32.0".to_string(),
        "pulse.shape" => "\"square\"".to_string(),
        "pulse.table" | "slider.surface.file" | "slider.surface.preset" | "slider.surface.rail" => {
            return None;
        }
        "pulse.table_time_ms" | "pulse.table_relative" => return None,
        "ramp.deformable.modes" | "ramp.deformable.bottom_modes" => {
            "[{ frequency_hz = 900.0, mass_mg = 50.0, participation = 0.2 }]".to_string()
        }
        "solver.leave_out" => return None,
        "solver.not_refined" => "[\"disk_modes\"]".to_string(),
        // Ways to read files; what they hold takes their place.
        path if path.starts_with("ramp.deformable.mesh.")
            || path.starts_with("suspension.imported.")
            || path.starts_with("base.imported.") =>
        {
            return None;
        }
        _ => match key.kind {
            Kind::Flag => "false".to_string(),
            Kind::Integer(low, _) => (low + 17).to_string(),
            Kind::Word(all) => words(all).pop()?,
            Kind::Words(_) => "[\"-\"]".to_string(),
            Kind::Axis(_) => "[2.5]".to_string(),
            Kind::Number(_) | Kind::NumberOrWord(..) => match key.example().parse::<f64>().ok()? {
                0.0 => "0.001".to_string(),
                value => format!("{:?}", value * 0.99),
            },
            _ => return None,
        },
    })
}

/// A hub that is given.
const HUB: [&str; 3] = [
    "hub.axial_stiffness_n_per_m=5.0e6",
    "hub.tilt_stiffness_n_m_per_rad=200.0",
    "hub.transverse_inertia_mg_mm2=3.5e5",
];

/// Limiters and lift tab that are given.
const STOPS: [&str; 2] = [
    "suspension.limiters.gap_um=92.0",
    "suspension.lift_tab.gap_um=140.0",
];

#[test]
fn every_value_changes_the_digest_and_is_written_out() {
    use opshock_study::study::keys::KEYS;
    let base = read(SHORT, &[]).unwrap();
    let mut tried = 0;
    for key in KEYS.iter().filter(|key| !key.path.contains("[]")) {
        let Some(value) = other_value(key) else {
            continue;
        };
        let set = format!("{}={value}", key.path);
        // A hub has both stiffnesses, an oblique shock a hub, a stop its gap, a contact's spring a stiffness.
        let around: &[&str] = match key.path {
            path if path.starts_with("hub.") || key.code == "E138" => &HUB,
            path if path.starts_with("suspension.li") => &STOPS,
            "ramp.contact_frequency_khz" | "ramp.contact_damping_ratio" => {
                &["ramp.contact_stiffness_n_per_m=1.0e6"]
            }
            // A repulsion ends an attraction.
            "surface_forces.repulsion_j_m6" => &["surface_forces.hamaker_j=1.0e-19"],
            _ => &[],
        };
        let without = |set: &&&str| !set.starts_with(&format!("{}=", key.path));
        let mut sets: Vec<&str> = around.iter().filter(without).copied().collect();
        sets.push(&set);
        let study = read(SHORT, &sets).unwrap_or_else(|errors| panic!("{set}: {errors}"));
        let unset = read(SHORT, around).unwrap();
        assert_ne!(study.digest, unset.digest, "{set}");
        assert_ne!(study.digest, base.digest, "{set}");
        assert!(study.resolved_toml().contains(key.name()), "{set}");
        let again =
            read(&study.resolved_toml(), &[]).unwrap_or_else(|errors| panic!("{set}: {errors}"));
        assert_eq!(again.digest, study.digest, "{set}");
        tried += 1;
    }
    assert!(tried > 80, "{tried}");
    for rail in ["x_um=[20, 169]", "y_um=[30, 671]", "recess_um=0.26"] {
        let set = format!("slider.surface.rail[0].{rail}");
        assert_ne!(read(SHORT, &[&set]).unwrap().digest, base.digest, "{set}");
    }
}

#[test]
fn the_digest_does_not_see_order_spelling_and_comments() {
    let one = "study_format = 1\nname = \"d\"\n[pulse]\nwidths_ms = [0.5, 2.0]\n[disk]\nrpm = 5400.0\nthickness_mm = 0.635\n[ramp]\nmodels = [\"none\", \"rigid\"]\nclearance_um = 100.0\n";
    let other = "# a comment\nname = 'd'\nramp = { clearance_um = 1e2, models = [\"none\", \"rigid\"] }\n\ndisk.thickness_mm = 0.63500\nstudy_format = 0x1\npulse.widths_ms = [\n  0.5, # short\n  2,\n]\ndisk.rpm = 5_400\n";
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
        "solver.not_refined=[\"disk_modes\"]",
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
    use opshock_solver::scene::knob::{Knob, Levels};
    let sets = [
        "solver.not_refined=[\"disk_modes\"]",
        "solver.disk_cut_khz=40",
    ];
    let study = read(SHORT, &sets).unwrap();
    let scene = &study.points[0].scene;
    assert!(!scene.knobs().contains(&Knob::DiskModes));
    assert!(scene.knobs().contains(&Knob::StructureStep));
    let finer = Levels::NONE
        .turned(Knob::DiskModes, 1)
        .turned(Knob::StructureStep, 1);
    let finer = scene.at_levels(finer);
    assert_eq!(finer.disk_resolution, scene.disk_resolution);
    let step_s = scene.structure_resolution.step_s;
    assert_eq!(finer.structure_resolution.step_s, 0.5 * step_s);
    let values = "values of the model, not refined: disk modes to 40 kHz";
    assert_eq!(study.not_refined().as_deref(), Some(values));
    assert_eq!(read(SHORT, &sets[1..]).unwrap().not_refined(), None);
    let unknown = read(SHORT, &["solver.not_refined=[\"disk\"]"]).unwrap_err();
    assert!(unknown.to_string().contains("disk_modes"), "{unknown}");
}

#[test]
fn the_command_line_wins_and_both_values_are_recorded() {
    let text = "study_format = 1\nname = \"w\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\nclearance_top_um = 90.0\nclearance_bottom_um = 110.0\n[disk]\nrpm = 5400.0\ndamping = { rayleigh = { alpha_per_s = 25.0, beta_s = 1.0e-7 } }\n";
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
fn an_entry_of_a_default_list_can_be_set_alone() {
    let study = read(
        SHORT,
        &[
            "ramp.models=deformable",
            "ramp.deformable.modes[1].mass_mg=[30, 40]",
        ],
    )
    .unwrap();
    let masses: Vec<f64> = study
        .points
        .iter()
        .map(|point| {
            let [top, _] = point.scene.ramp.model.arms().expect("separate arms");
            assert_eq!(top[0].mass_kg, 57.9e-6);
            top[1].mass_kg
        })
        .collect();
    assert_eq!(masses, [30e-6, 30e-6, 40e-6, 40e-6]);
    assert_eq!(study.axes[0].path, "ramp.deformable.modes[1].mass_mg");
    assert_eq!(study.axes[0].column, "mass_mg");
    assert!(read(SHORT, &["ramp.deformable.modes[2].mass_mg=30"]).is_err());
}

#[test]
fn axes_of_words_and_spaced_numbers_expand() {
    let study = read(
        SHORT,
        &[
            "gas.model=[\"continuum\", \"slip_1\"]",
            "disk.rpm={ from = 4000, to = 8000, count = 3, spacing = \"log\" }",
            "pulse.widths_ms={ from = 0.25, to = 4.0, count = 5, spacing = \"log\" }",
            "pulse.window_ms=[5.0, \"until_decayed\"]",
            "slider.radius_mm=[20.0, 21.0]",
            "ramp.radius_mm=[32.0, 32.15]",
        ],
    )
    .unwrap();
    let columns: Vec<&str> = study.axes.iter().map(|axis| axis.column.as_str()).collect();
    assert_eq!(
        columns,
        [
            "window_ms",
            "rpm",
            "ramp.radius_mm",
            "slider.radius_mm",
            "model"
        ]
    );
    assert_eq!(study.points.len(), 2 * 3 * 2 * 2 * 2 * 5 * 2);
    assert_eq!(study.widths_ms, [0.25, 0.5, 1.0, 2.0, 4.0]);
    assert_eq!(study.axes[1].values[0], AxisValue::Number(4000.0));
    assert_eq!(study.axes[1].values[2], AxisValue::Number(8000.0));
    match study.axes[1].values[1] {
        AxisValue::Number(rpm) => assert!((rpm - 4000.0 * 2.0_f64.sqrt()).abs() < 1e-9),
        ref other => panic!("{other:?}"),
    }
    let order = study.table_order();
    assert_eq!(order.len(), study.points.len());
    let first: Vec<f64> = order[..5]
        .iter()
        .map(|&at| study.points[at].pulse_ms)
        .collect();
    assert_eq!(first, [0.25, 0.5, 1.0, 2.0, 4.0]);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..study.points.len()));
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
fn a_single_shock_needs_every_axis_chosen() {
    use opshock_study::study::{Choice, ChoiceError};
    let study = read(
        SHORT,
        &["ramp.clearance_um=[60, 80]", "pulse.widths_ms=[0.5, 2]"],
    )
    .unwrap();
    match study.select(&Choice::default()) {
        Err(ChoiceError::Free(free)) => {
            let options: Vec<&str> = free.iter().map(|axis| axis.option.as_str()).collect();
            assert_eq!(
                options,
                [
                    "--pulse-ms",
                    "--sign",
                    "--set ramp.clearance_um=VALUE",
                    "--amplitude-g"
                ]
            );
            assert_eq!(free[2].values, ["60", "80"]);
        }
        other => panic!("{other:?}"),
    }
    let choice = Choice {
        ramp: Some(Ramp::None),
        pulse_ms: Some(0.7),
        sign: Some(Sign::Minus),
        amplitude_g: Some(100.0),
    };
    assert!(matches!(study.select(&choice), Err(ChoiceError::Free(free)) if free.len() == 1));
    let study = read(SHORT, &["ramp.clearance_um=60"]).unwrap();
    let shot = study.select(&choice).unwrap();
    assert_eq!(shot.amplitude_m_per_s2, -980.665);
    assert_eq!(
        (shot.point.ramp, shot.point.pulse_width_s),
        (Ramp::None, 0.0007)
    );
    for (pulse_ms, amplitude_g) in [
        (f64::NAN, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
        (1e-320, 1.0),
        (1.0, f64::NAN),
        (1.0, -1.0),
    ] {
        let wrong = Choice {
            pulse_ms: Some(pulse_ms),
            amplitude_g: Some(amplitude_g),
            ..choice.clone()
        };
        assert!(
            matches!(study.select(&wrong), Err(ChoiceError::Value { .. })),
            "{pulse_ms} {amplitude_g}"
        );
    }
    let short = Choice {
        pulse_ms: Some(0.0015),
        ..choice.clone()
    };
    match study.select(&short) {
        Err(ChoiceError::Study(errors)) => assert_eq!(errors.errors[0].code, "E151"),
        other => panic!("{other:?}"),
    }
    assert!(
        study
            .select(&Choice {
                amplitude_g: Some(0.0),
                ..choice
            })
            .is_ok()
    );
    assert!(study.select_drive(&Choice::default()).is_ok());
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
fn rungs_set_the_resolutions_and_single_keys_override_them() {
    let fine = read(SHORT, &["solver.accuracy=0.1%", "solver.film_cells=500"]).unwrap();
    let scene = &fine.points[0].scene;
    assert_eq!(scene.film_resolution.cells, 500);
    assert_eq!(scene.structure_resolution.step_s, 0.125e-6);
    let spelt = read(SHORT, &["solver.accuracy=0.1%", "solver.film_cells=5e2"]).unwrap();
    assert_eq!(spelt.digest, fine.digest);
    for rung in ["5%", "1%", "0.1%"] {
        // What the resolved study writes out must give back the rung's own bits.
        let study = read(SHORT, &[&format!("solver.accuracy={rung}")]).unwrap();
        let again = read(&study.resolved_toml(), &[]).unwrap();
        assert_eq!(study.points[0].scene, again.points[0].scene, "{rung}");
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
    let rung = tolerances(&["solver.accuracy=1%"]);
    assert_eq!(rung, [[2e-2, 2e-4]]);
    assert_eq!(
        tolerances(&["solver.head_tolerance=1e-3"]),
        [[1e-3, 0.01 * 1e-3]]
    );
    let both = [
        "solver.head_tolerance=1e-3",
        "solver.coupling_tolerance=1e-8",
    ];
    assert_eq!(tolerances(&both), [[1e-3, 1e-8]]);
    let mut axis = tolerances(&["solver.head_tolerance=[1e-2, 1e-3]"]);
    axis.sort_by(|a, b| a[0].total_cmp(&b[0]));
    axis.dedup();
    assert_eq!(axis, [[1e-3, 0.01 * 1e-3], [1e-2, 0.01 * 1e-2]]);
}

#[test]
fn the_schema_knows_every_key_and_no_other() {
    use opshock_study::study::keys::KEYS;
    let schema = opshock_study::study::schema::json_schema();
    let mut paths = Vec::new();
    collect(&schema, "", &mut paths);
    let mut expected: Vec<String> = KEYS.iter().map(|key| key.path.to_string()).collect();
    expected.sort();
    paths.sort();
    assert_eq!(paths, expected);
    assert_eq!(
        schema["required"],
        serde_json::json!(["study_format", "name", "pulse", "ramp"])
    );
    assert_eq!(
        schema["properties"]["pulse"]["required"],
        serde_json::json!(["widths_ms"])
    );
    assert!(
        opshock_study::study::schema::units()
            .iter()
            .any(|unit| unit.starts_with("_um: "))
    );
}

/// Paths of everything in a schema that is described, in the form of the table of keys.
fn collect(schema: &serde_json::Value, path: &str, paths: &mut Vec<String>) {
    let Some(properties) = schema["properties"].as_object() else {
        return;
    };
    for (name, child) in properties {
        let path = if path.is_empty() {
            name.clone()
        } else {
            format!("{path}.{name}")
        };
        if child.get("description").is_some() {
            paths.push(path.clone());
        }
        if child.get("items").is_some() {
            collect(&child["items"], &format!("{path}[]"), paths);
        } else if child["type"] == "object" {
            collect(child, &path, paths);
        }
    }
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

#[test]
fn the_points_of_a_large_study_all_differ() {
    let study = read(
        SHORT,
        &[
            "disk.rpm={ from = 4000, to = 8000, count = 20 }",
            "ramp.clearance_um={ from = 50, to = 150, count = 100 }",
            "pulse.widths_ms=[0.5, 1, 2, 3, 4]",
        ],
    )
    .unwrap();
    assert_eq!(study.points.len(), 20_000);
    let mut ids: Vec<_> = study.points.iter().map(|point| point.id).collect();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 20_000);
}

/// TOML takes `.1` and `1.` for no numbers; the hint names the digit that is missing.
#[test]
fn a_number_without_a_digit_beside_its_point_is_told_so() {
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
        let told = Study::from_text(&text, &[set]).unwrap_err().to_string();
        assert!(told.contains("E113") && told.contains(hint), "{told}");
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
