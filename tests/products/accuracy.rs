//! `opshock accuracy`: what it measures, and how it refuses.

use opshock_study::accuracy::{BRACKET, Bench, PointLadders, ladders};
use opshock_tests::scenes::scene;

use super::cli::{Done, study};

/// The ladder of the structure's step on a shock that reaches the ramp: answers that no contact
/// decides do not change with it, and the reference is the most certain of all.
#[test]
fn a_ladder_is_held_against_its_reference() {
    let scene = scene(
        "fig13",
        "rigid",
        0.5,
        &[
            ("solver.film_cells", "800"),
            ("pulse.window_ms", "0.8"),
            ("solver.disk_cut_khz", "10"),
        ],
    );
    let measured: Vec<_> = ladders(&scene)
        .into_iter()
        .filter(|setting| setting.ladder == "structure_step_us")
        .map(|setting| {
            let mut bench = Bench::build(&setting.scene, 1.0).expect("builds");
            let measured = bench.measure(200.0, 220.0, BRACKET);
            (setting, measured)
        })
        .collect();
    assert_eq!(measured.len(), 6);
    let ladders = PointLadders::of("rigid".into(), 200.0, &measured);
    for rung in &ladders.rungs {
        assert!(rung.measured.failure.is_none(), "{rung:?}");
        let [critical, _, flying, impulse, rim, slider, touch] = rung.errors;
        assert_eq!(flying, Some(0.0));
        // First touch is located inside the step, so its step hardly shows.
        assert!(touch.expect("touches") < 1e-6, "{rung:?}");
        for error in [impulse, rim, slider] {
            assert!(error.expect("a structure") < 2e-3, "{rung:?}");
        }
        assert!(critical.expect("bracketed") < 2e-2, "{rung:?}");
    }
    assert!(ladders.rungs.last().is_some_and(|rung| rung.is_reference));
}

/// Where no contact lies between, errors fall with the formal order: of the smallest clearance of a
/// shock without ramp with the head's tolerances. The film's is shown on nested grids (physics,
/// `flying_height_converges_with_the_formal_order_on_nested_grids`): every number of cells has a
/// layout of its own, whose error goes up and down on the way.
#[test]
fn observed_orders_without_contact_are_the_formal_ones() {
    let sets = [("solver.film_cells", "800"), ("pulse.window_ms", "0.8")];
    let scene = scene("fig13", "none", 0.5, &sets);
    for ladder in ["head_tolerance", "coupling_tolerance"] {
        let settings = ladders(&scene).into_iter();
        let measured: Vec<_> = settings
            .filter(|setting| setting.ladder == ladder)
            .map(|setting| {
                let mut bench = Bench::build(&setting.scene, 1.0).expect("builds");
                // The probing shock alone: a bracket as wide as can be.
                let measured = bench.measure(300.0, 300.0, 9.0);
                (setting, measured)
            })
            .collect();
        let ladders = PointLadders::of("none".into(), 300.0, &measured);
        let order = &ladders.orders[0];
        let (observed, formal) = (
            order.observed.expect("an order"),
            order.formal.expect("known"),
        );
        assert!((observed - formal).abs() <= 0.2, "{order:?}");
    }
}

#[test]
fn a_point_is_named_as_ramp_width_sign() {
    let folder = tempfile::tempdir().expect("folder");
    let path = study("fig13");
    let path = path.to_str().expect("a path");
    let bad = Done::of(folder.path(), &["accuracy", path, "--at", "rigid:2.0"]);
    assert_eq!(bad.code, 2, "{}", bad.stderr);
    assert!(bad.stderr.contains("RAMP:MS:SIGN"), "{}", bad.stderr);
    assert!(!folder.path().join("results").exists());
}
