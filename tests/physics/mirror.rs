//! A drive upside down: every displacement along the axis changes sign with the amplitude, and what was above
//! the disk is below it.

use opshock_solver::disk::HubParameters;
use opshock_solver::ramp::{ArmMode, Arms, CoupledMode, OneBody, RampBody, RigidRamp};
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::shock::ObliqueShock;
use opshock_solver::simulation::{Outcome, StructureColumns};
use opshock_tests::{pairs, scenes};

use super::base::BASE;
use super::hub::{distance, largest, spindle};

fn arm(frequency_hz: f64, participation: f64) -> ArmMode {
    ArmMode {
        frequency_hz,
        mass_kg: 2e-5,
        participation,
        damping_ratio: 0.02,
    }
}

/// The drive of Fig. 13 with gaps of 80 um above and 60 um below, 2 ms of it.
fn drive(model: impl Into<RampBody>, hub: HubParameters) -> Scene {
    let mut scene = scenes::scene(
        "fig13-stiffness",
        "rigid",
        0.5,
        &[("resolution.preset", "coarse")],
    );
    scene.window = Window::Fixed { length_s: 2e-3 };
    scene.disk_resolution.cut_hz = 12e3;
    scene.disk.hub = Some(hub);
    scene.ramp.model = model.into();
    scene.ramp.clearance_top_m = 80e-6;
    scene.ramp.clearance_bottom_m = 60e-6;
    scene.slider.angle_rad += 0.7;
    scene
}

fn shaken(scene: &Scene, amplitude_g: f64) -> Outcome {
    let plan = Plan::new(&[Output::ContactForce], Mode::Auto);
    pairs::run(scene, &plan, amplitude_g, None).1
}

fn columns(outcome: &Outcome) -> &StructureColumns {
    &outcome.history.as_ref().expect("recorded").structure
}

/// Arms that differ, a rotor whose centre of mass is not its centre of tilt, and a shock that pushes aside and
/// turns the base, or a base that vibrates: contact on both sides.
#[test]
fn a_drive_upside_down_moves_the_other_way() {
    let coupled = |frequency_hz: f64, top: f64, bottom: f64| CoupledMode {
        frequency_hz,
        shape_per_sqrt_kg: [top, bottom],
        participation_sqrt_kg: 2e-3,
        damping_ratio: 0.02,
    };
    let mut oblique = drive(
        OneBody {
            modes: vec![coupled(2500.0, 150.0, 90.0), coupled(6100.0, -60.0, 130.0)],
        },
        spindle(),
    );
    oblique.oblique = Some(ObliqueShock {
        in_plane: [0.4, -0.7],
        rotation_per_m: [9.0, 14.0],
    });
    let mut shaky = drive(
        Arms {
            top: vec![arm(3100.0, 0.8)],
            bottom: vec![arm(2700.0, 0.7), arm(9000.0, 0.1)],
        },
        spindle(),
    );
    shaky.base = BASE.to_vec();
    for (name, scene) in [("oblique", oblique), ("base", shaky)] {
        let above = shaken(&scene, 400.0);
        let below = shaken(&scene.mirrored(), -400.0);
        let impulses = [&above.top, &above.bottom].map(|arm| arm.impulse_n_s);
        assert!(
            impulses.iter().all(|impulse| *impulse > 0.0),
            "{name}: {impulses:?}"
        );
        let (a, b) = (columns(&above), columns(&below));
        let turned = |column: &[f64]| column.iter().map(|x| -x).collect::<Vec<_>>();
        for (column, x, y) in [
            ("disk under the slider", &a.disk_slider_m, &b.disk_slider_m),
            ("disk at the ramp", &a.disk_ramp_m, &b.disk_ramp_m),
            ("pitch", &a.disk_pitch_rad, &b.disk_pitch_rad),
            ("roll", &a.disk_roll_rad, &b.disk_roll_rad),
            ("top arm", &a.ramp_top_m, &b.ramp_bottom_m),
            ("bottom arm", &a.ramp_bottom_m, &b.ramp_top_m),
            ("hub", &a.hub_axial_m, &b.hub_axial_m),
            ("tilt", &a.hub_tilt_ramp_rad, &b.hub_tilt_ramp_rad),
            (
                "tilt across",
                &a.hub_tilt_across_rad,
                &b.hub_tilt_across_rad,
            ),
            ("pivot", &a.base_pivot_m, &b.base_pivot_m),
        ] {
            let share = distance(x, &turned(y)) / largest(x).max(f64::MIN_POSITIVE);
            println!("{name}, {column}: {share:.1e}");
            assert!(share < 1e-9, "{name}, {column}: {share:e}");
        }
        for (x, y) in [(&above.top, &below.bottom), (&above.bottom, &below.top)] {
            assert!((x.impulse_n_s / y.impulse_n_s - 1.0).abs() < 1e-9, "{name}");
        }
        // Not by symmetry: the drive itself answers the other sign otherwise.
        let other = shaken(&scene, -400.0);
        let apart = distance(&turned(&columns(&other).disk_slider_m), &a.disk_slider_m);
        assert!(
            apart > 0.01 * largest(&a.disk_slider_m),
            "{name}: {apart:e}"
        );
    }
}

/// Mirrored twice a scene is itself.
#[test]
fn upside_down_twice_is_the_drive_itself() {
    let rigid = drive(RigidRamp, spindle());
    assert_ne!(rigid.mirrored(), rigid);
    assert_eq!(rigid.mirrored().mirrored(), rigid);
}
