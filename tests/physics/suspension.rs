//! The suspension's reduced model against independent finite-element results
//! (`reference/head_default_set.json`, an Euler-Bernoulli model with 61 constant-section elements;
//! trusted to 0.5 %) and against relations it must obey.

use opshock_solver::suspension::{BeamMatrices, ReducedSuspension, SuspensionError};
use opshock_tests::sheet::at_most;
use opshock_tests::suspensions::{default_suspension, paper_suspension};
use serde_json::Value;

fn reference() -> Value {
    let text = include_str!("../reference/head_default_set.json");
    serde_json::from_str::<Value>(text).expect("reference is JSON")["suspension_fe"].clone()
}

fn assert_close(what: &str, found: f64, wanted: f64, relative: f64) {
    assert!(
        (found - wanted).abs() <= relative * wanted.abs(),
        "{what}: found {found}, wanted {wanted} within {relative}"
    );
}

#[test]
fn default_set_reproduces_independent_elements() {
    let reference = reference();
    let number = |key: &str| reference[key].as_f64().expect("number");
    let list = |key: &str, i: usize| reference[key][i].as_f64().expect("number");
    let assert_close = |what: &str, found: f64, wanted: f64, relative: f64| {
        let what = format!("relative difference: {what}");
        at_most("suspension", &what, (found / wanted - 1.0).abs(), relative);
    };
    let model = ReducedSuspension::build(&default_suspension(), 4).expect("builds");
    assert_close("mass", model.mass_kg, number("mass_total_kg"), 1e-9);
    let stiffness = model.dimple_stiffness_n_per_m();
    assert_close("stiffness", stiffness, number("k_vertical_dimple"), 1e-4);
    let shock_mass = model.effective_shock_mass_kg();
    assert_close(
        "shock mass",
        shock_mass,
        number("m_eff_static_reaction"),
        1e-3,
    );
    let roll = model.roll_stiffness_n_m_per_rad();
    assert_close("roll stiffness", roll, number("k_roll_dimple"), 2e-3);
    for i in 0..4 {
        assert_close("free", model.bending.free_hz[i], list("f_free_Hz", i), 2e-3);
        assert_close(
            "pinned",
            model.bending.pinned_hz[i],
            list("f_dimple_pinned_Hz", i),
            2e-3,
        );
    }
    for i in 0..2 {
        assert_close(
            "torsion free",
            model.torsion.free_hz[i],
            list("f_torsion_free_Hz", i),
            3e-3,
        );
        let pinned = model.torsion.pinned_hz[i];
        assert_close(
            "torsion pinned",
            pinned,
            list("f_torsion_pinned_Hz", i),
            3e-3,
        );
    }
}

#[test]
fn reduced_matrices_agree_up_to_the_sign_of_modes() {
    let reference = reference();
    let model = ReducedSuspension::build(&default_suspension(), 4)
        .expect("builds")
        .bending;
    let at = |v: &Value| v.as_f64().expect("number").abs();
    assert_close("ψᵀMψ", model.mass[(0, 0)], at(&reference["Mr"][0][0]), 1e-3);
    assert_close(
        "dw/dx of ψ",
        model.slope_row[0],
        at(&reference["slope_row"][0]),
        1e-3,
    );
    for i in 1..5 {
        assert_close(
            "ψᵀMφ",
            model.mass[(0, i)].abs(),
            at(&reference["Mr"][0][i]),
            5e-3,
        );
        assert_close(
            "φᵀM1",
            model.inertia_load[i].abs(),
            at(&reference["fr"][i]),
            5e-3,
        );
        assert_close(
            "dw/dx of φ",
            model.slope_row[i].abs(),
            at(&reference["slope_row"][i]),
            5e-3,
        );
    }
}

#[test]
fn paper_set_has_its_printed_figures() {
    let model = ReducedSuspension::build(&paper_suspension(), 4).expect("builds");
    let figures = [
        ("mass, mg", model.mass_kg * 1e6, 5.57),
        ("stiffness", model.dimple_stiffness_n_per_m(), 11.39),
        (
            "shock mass, mg",
            model.effective_shock_mass_kg() * 1e6,
            1.918,
        ),
        ("free 1", model.bending.free_hz[0], 472.7),
        ("free 2", model.bending.free_hz[1], 2425.8),
        ("free 3", model.bending.free_hz[2], 5186.6),
        ("pinned 1", model.bending.pinned_hz[0], 2013.0),
        ("pinned 2", model.bending.pinned_hz[1], 5128.0),
        ("pinned 3", model.bending.pinned_hz[2], 7744.0),
        ("torsion pinned", model.torsion.pinned_hz[0], 6130.0),
        ("torsion free", model.torsion.free_hz[0], 5170.0),
    ];
    for (what, found, wanted) in figures {
        assert_close(what, found, wanted, 5e-3);
    }
}

/// ψ is the static shape of a force at the dimple, so by reciprocity the dimple's own static
/// deflection under any load, the inertia load included, survives the reduction exactly.
#[test]
fn static_response_to_inertia_is_exact_after_reduction() {
    let parameters = default_suspension();
    let beam = BeamMatrices::assemble(&parameters).expect("assembles");
    let model = ReducedSuspension::build(&parameters, 2)
        .expect("builds")
        .bending;
    let full = beam
        .bending_stiffness
        .clone()
        .cholesky()
        .expect("positive definite");
    let deflection = full.solve(&beam.inertia_load)[beam.dimple_bending];
    let reduced = model.inertia_load[0] / model.stiffness[0];
    assert_close("static dimple deflection", reduced, deflection, 1e-9);
}

/// With all modes a reduction is a change of coordinates, of bending and of torsion: the sum of all
/// squared frequencies, trace(M⁻¹ K), is that of the elements.
#[test]
fn with_all_modes_nothing_is_cut() {
    for parameters in [default_suspension(), paper_suspension()] {
        let beam = BeamMatrices::assemble(&parameters).expect("assembles");
        let most = ReducedSuspension::most_bending_modes(&parameters).expect("a beam");
        let model = ReducedSuspension::build(&parameters, most).expect("builds");
        for (what, reduced, stiffness, mass) in [
            (
                "bending",
                &model.bending,
                &beam.bending_stiffness,
                &beam.bending_mass,
            ),
            (
                "torsion",
                &model.torsion,
                &beam.torsion_stiffness,
                &beam.torsion_mass,
            ),
        ] {
            assert_eq!(reduced.len(), mass.nrows(), "{what}");
            let factor = mass.clone().cholesky().expect("positive definite");
            let all = factor.solve(stiffness).trace();
            let factor = reduced.mass.clone().cholesky().expect("positive definite");
            let kept = factor.solve(&nalgebra::DMatrix::from_diagonal(&reduced.stiffness));
            assert_close(what, kept.trace(), all, 1e-9);
        }
    }
}

#[test]
fn impossible_geometry_is_named() {
    let mut parameters = default_suspension();
    parameters.load_beam.web_m = f64::NAN;
    let error = ReducedSuspension::build(&parameters, 4).expect_err("NaN thickness");
    assert!(matches!(
        error,
        SuspensionError::NotPositive {
            quantity: "load beam web thickness",
            ..
        }
    ));
    let mut parameters = default_suspension();
    parameters.hinge.length_m = 11e-3;
    let error = ReducedSuspension::build(&parameters, 4).expect_err("hinge beyond the dimple");
    assert!(matches!(error, SuspensionError::OutOfOrder { .. }));
    let error = ReducedSuspension::build(&default_suspension(), 1000).expect_err("too many");
    assert!(matches!(
        error,
        SuspensionError::TooManyModes { wanted: 1000, .. }
    ));
}
