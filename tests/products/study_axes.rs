//! Lists that make axes, and points chosen of them.

use super::study_reading::{SHORT, read};
use opshock_study::study::{AxisValue, Ramp, Sign};

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
