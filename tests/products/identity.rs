//! What the digests by which stored simulations and built stages are found depend on.

use opshock_solver::scene::Scene;
use opshock_study::identity::{CellId, head_key, structure_key};
use opshock_study::study::Study;

/// Scene of the example study, with one value set.
fn scene(set: &str) -> Scene {
    let sets = if set.is_empty() {
        Vec::new()
    } else {
        vec![set.parse().unwrap()]
    };
    let study = Study::from_text(&Study::example("identity"), &sets).unwrap();
    study.points[0].scene.clone()
}

#[test]
fn the_structure_does_not_depend_on_the_head() {
    let base = scene("");
    for head_only in [
        "suspension.gram_load_gf=2.3",
        "resolution.film_cells=1999",
        "gas.pressure_pa=9e4",
    ] {
        let other = scene(head_only);
        let name = head_only;
        assert_eq!(structure_key(&base, 1), structure_key(&other, 1), "{name}");
        assert_ne!(head_key(&base, 1, 1), head_key(&other, 1, 1), "{name}");
        assert_ne!(
            CellId::new(&base, true, false),
            CellId::new(&other, true, false),
            "{name}"
        );
    }
    for both in [
        "disk.rpm=5401",
        "slider.angle_deg=7.1",
        "resolution.structure_step_us=0.4",
    ] {
        let other = scene(both);
        assert_ne!(structure_key(&base, 1), structure_key(&other, 1), "{both}");
    }
}

#[test]
fn the_contact_method_is_part_of_the_structure() {
    let scene = scene("");
    let other = scene.with_other_contact();
    assert_ne!(structure_key(&scene, 1), structure_key(&other, 1));
    assert_ne!(
        CellId::new(&scene, true, false),
        CellId::new(&other, true, false)
    );
}

#[test]
fn sign_and_version_are_part_of_the_identity() {
    let scene = scene("");
    assert_ne!(
        CellId::new(&scene, true, false),
        CellId::new(&scene, false, false)
    );
    assert_ne!(
        CellId::new(&scene, true, false),
        CellId::new(&scene, true, true)
    );
    assert_ne!(structure_key(&scene, 1), structure_key(&scene, 2));
    assert_ne!(head_key(&scene, 1, 1), head_key(&scene, 1, 2));
}
