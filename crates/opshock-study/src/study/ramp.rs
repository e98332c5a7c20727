//! The ramp of a study: its keys, and what they say as a model in SI.
//!
//! A further model has its keys and its line in [`model`] here.

use opshock_solver::ramp::{
    ArmMode, Arms, CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, CoupledMode, NoRamp, OneBody,
    RampBody, RampParameters, Relaxation, RigidRamp, Viscoelastic,
};

use super::key::Kind::{Number, Tables, Text, Word, Words};
use super::key::{ANY, FROM_ZERO, Key, closed, open};
use super::keys::{LENGTH, RAMP_MATERIALS, RAMPS, RATIO};
use super::settings::View;
use super::words::{self, Ramp, names};
use super::{ramp_geometry, ramp_mesh};

/// Damping ratio of every mode that has none of its own.
const DAMPING: &str = "ramp.deformable.damping_ratio";

/// Terms by which the stiffness of every mode relaxes.
const PRONY: &str = "ramp.deformable.prony";

/// The ramp of one point, the disk's run-out taking `taken_m` of both gaps.
pub fn parameters(view: &View<'_>, ramp: Ramp, taken_m: f64) -> RampParameters {
    let clearance_m = view.si("ramp.clearance_um");
    RampParameters {
        model: model(view, ramp),
        clearance_top_m: view
            .maybe_si("ramp.clearance_top_um")
            .unwrap_or(clearance_m)
            - taken_m,
        clearance_bottom_m: view
            .maybe_si("ramp.clearance_bottom_um")
            .unwrap_or(clearance_m)
            - taken_m,
        radius_m: view.si("ramp.radius_mm"),
        angle_rad: view.si("ramp.angle_deg"),
        restitution: view.si("ramp.restitution"),
        contact_stiffness_n_per_m: view.maybe_si("ramp.contact_stiffness_n_per_m"),
        contact_frequency_hz: view
            .maybe_si("ramp.contact_frequency_khz")
            .unwrap_or(CONTACT_FREQUENCY_HZ),
        contact_damping_ratio: view
            .maybe_si("ramp.contact_damping_ratio")
            .unwrap_or(CONTACT_DAMPING_RATIO),
    }
}

fn model(view: &View<'_>, ramp: Ramp) -> RampBody {
    match ramp {
        Ramp::None => NoRamp.into(),
        Ramp::Rigid => RigidRamp.into(),
        Ramp::Deformable => viscoelastic(view, deformable(view)),
    }
}

fn deformable(view: &View<'_>) -> RampBody {
    if ramp_geometry::is_given(view) {
        let modes = ramp_geometry::coupled_modes(view);
        return OneBody { modes }.into();
    }
    if view.entries(ramp_mesh::MODES) > 0 {
        let modes = coupled_modes(view);
        return OneBody { modes }.into();
    }
    let top = arm(view, "ramp.deformable.modes");
    let bottom = match view.entries("ramp.deformable.bottom_modes") {
        0 => top.clone(),
        _ => arm(view, "ramp.deformable.bottom_modes"),
    };
    Arms { top, bottom }.into()
}

/// The ramp with what relaxes of its modes; as it is without a series.
fn viscoelastic(view: &View<'_>, elastic: RampBody) -> RampBody {
    let prony = view.tables(PRONY, |si| Relaxation {
        share: si("share"),
        time_s: si("time_ms"),
    });
    match prony.is_empty() {
        true => elastic,
        false => Viscoelastic { elastic, prony }.into(),
    }
}

/// Modes of one arm, as listed.
fn arm(view: &View<'_>, list: &str) -> Vec<ArmMode> {
    let mode = |position: usize| {
        let member = |name: &str| format!("{list}[{position}].{name}");
        ArmMode {
            frequency_hz: view.si(&member("frequency_hz")),
            mass_kg: view.si(&member("mass_mg")),
            participation: view.si(&member("participation")),
            damping_ratio: view
                .maybe_si(&member("damping_ratio"))
                .unwrap_or_else(|| view.si(DAMPING)),
        }
    };
    (0..view.entries(list)).map(mode).collect()
}

/// Modes of both arms as one body, as listed.
fn coupled_modes(view: &View<'_>) -> Vec<CoupledMode> {
    let list = ramp_mesh::MODES;
    let mode = |position: usize| {
        let member = |name: &str| format!("{list}[{position}].{name}");
        CoupledMode {
            frequency_hz: view.si(&member("frequency_hz")),
            shape_per_sqrt_kg: ["top_per_sqrt_kg", "bottom_per_sqrt_kg"]
                .map(|name| view.si(&member(name))),
            participation_sqrt_kg: view.si(&member("participation_sqrt_kg")),
            damping_ratio: view
                .maybe_si(&member("damping_ratio"))
                .unwrap_or_else(|| view.si(DAMPING)),
        }
    };
    (0..view.entries(list)).map(mode).collect()
}

/// Keys of the ramp.
pub static KEYS: &[Key] = &[
    Key::required("ramp.models", Words(RAMPS), "[\"none\", \"rigid\", \"deformable\"]", "Ramp models: an axis of the study."),
    Key::or("ramp.clearance_um", Number(FROM_ZERO), "100.0", "Static clearance between disk and ramp, above and below.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.clearance_top_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance above the disk, when unequal.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.clearance_bottom_um", Number(FROM_ZERO), "as clearance_um", "100.0", "Static clearance below the disk, when unequal.").usual(10.0, 1000.0).code("E143"),
    Key::optional("ramp.run_out", Word(&names(&words::RUN_OUT)), "none", "\"lowest_gap\"", "lowest_gap takes the run-out of the disk at the ramp off the gaps above and below it: the lowest gap of a revolution.").code("E143"),
    Key::or("ramp.radius_mm", LENGTH, "32.15", "Radius of the contact points.").usual(5.0, 70.0).code("E141"),
    Key::or("ramp.angle_deg", Number(closed(-360.0, 360.0)), "0.0", "Angle of the contact points in the disk's sense of rotation."),
    Key::or("ramp.restitution", Number(closed(0.0, 1.0)), "0.0", "Coefficient of restitution of an impact; 0 with a contact stiffness.").code("E136"),
    Key::optional("ramp.contact_stiffness_n_per_m", LENGTH, "a hard contact", "1.0e6", "Local stiffness between each arm and its contact point.").usual(1e4, 1e9).code("E136"),
    Key::optional("ramp.contact_frequency_khz", LENGTH, "400.0", "400.0", "Natural frequency of the contact's stiffness on the mass it is given: above what an impact carries to the slider.").usual(100.0, 1000.0).code("E136"),
    Key::optional("ramp.contact_damping_ratio", Number(closed(0.0, 1.0)), "0.5", "0.5", "Damping ratio at that frequency, where ringing is no physics; 0.5 at 400 kHz is a loss factor of 6 % at 25 kHz.").usual(0.0, 1.0).code("E132"),
    Key::together("ramp.deformable.modes", Tables, "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }, { frequency_hz = 17500.0, mass_mg = 35.1, participation = 0.789 }]", "Modes of each arm, scaled to 1 at the contact point; both arms alike.").code("E135"),
    Key::required("ramp.deformable.modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6),
    Key::required("ramp.deformable.modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5),
    Key::required("ramp.deformable.modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0),
    Key::optional("ramp.deformable.modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::optional("ramp.deformable.bottom_modes", Tables, "as modes", "[{ frequency_hz = 888.0, mass_mg = 57.9, participation = 0.199 }]", "Modes of the bottom arm, when the arms differ.").code("E135"),
    Key::required("ramp.deformable.bottom_modes[].frequency_hz", LENGTH, "888.0", "Undamped natural frequency.").usual(10.0, 1e6),
    Key::required("ramp.deformable.bottom_modes[].mass_mg", LENGTH, "57.9", "Modal mass.").usual(0.01, 1e5),
    Key::required("ramp.deformable.bottom_modes[].participation", Number(ANY), "0.199", "Base participation: inertia load = mass x participation x acceleration.").usual(-5.0, 5.0),
    Key::optional("ramp.deformable.bottom_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::optional("ramp.deformable.geometry.material", Word(RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material; with it the ramp is given by its geometry instead of modes."),
    Key::optional("ramp.deformable.geometry.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0),
    Key::optional("ramp.deformable.geometry.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131"),
    Key::optional("ramp.deformable.geometry.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0),
    Key::optional("ramp.deformable.geometry.finger_length_mm", LENGTH, "3.2", "3.2", "Fingers, from their tips to the body.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.finger_width_mm", LENGTH, "1.6", "1.6", "Width of the fingers.").usual(0.2, 10.0),
    Key::optional("ramp.deformable.geometry.tip_thickness_mm", LENGTH, "0.3", "0.3", "Thickness of a finger at its tip.").usual(0.05, 3.0),
    Key::optional("ramp.deformable.geometry.root_thickness_mm", LENGTH, "0.9", "0.9", "Thickness of a finger behind its slope.").usual(0.1, 5.0),
    Key::optional("ramp.deformable.geometry.slope_length_mm", LENGTH, "1.8", "1.8", "Length of the slope, over which a finger grows from tip to root thickness.").usual(0.1, 20.0),
    Key::optional("ramp.deformable.geometry.body_length_mm", LENGTH, "3.0", "3.0", "Body, along the fingers.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.body_width_mm", LENGTH, "4.0", "4.0", "Width of body and mount.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.body_depth_mm", LENGTH, "2.6", "2.6", "From the middle of the disk down to the lower face of body and mount.").usual(0.5, 20.0),
    Key::optional("ramp.deformable.geometry.neck_length_mm", Number(FROM_ZERO), "0.8", "0.8", "Free part of the mount behind the body; 0 for none.").usual(0.0, 10.0),
    Key::optional("ramp.deformable.geometry.pad_length_mm", Number(FROM_ZERO), "2.8", "2.8", "Bolted part of the mount; 0 for a body bolted itself.").usual(0.0, 20.0),
    Key::optional("ramp.deformable.geometry.mount_thickness_mm", LENGTH, "0.8", "0.8", "Thickness of the mount.").usual(0.1, 10.0),
    Key::optional("ramp.deformable.geometry.contact_mm", LENGTH, "0.35", "0.35", "From the tips to the middle of the contact with the disk.").usual(0.05, 10.0),
    Key::optional("ramp.deformable.geometry.contact_length_mm", LENGTH, "0.3", "0.3", "Length of the contact along the finger, over which its force is spread.").usual(0.02, 5.0),
    Key::optional("ramp.deformable.geometry.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.geometry.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.geometry.mesh_size_mm", LENGTH, "1.0", "0.7", "Longest edge of a finite element; elements at re-entrant corners are a quarter of it.").usual(0.2, 5.0).code("E174"),
    Key::optional("ramp.deformable.geometry.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contact points held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174"),
    Key::optional("ramp.deformable.mesh.file", Text, "a ramp given by modes", "\"ramp.msh\"", "Gmsh mesh (.msh 4.1) of the ramp with physical surfaces mount, top and bottom; z is the disk's axis."),
    Key::optional("ramp.deformable.mesh.material", Word(RAMP_MATERIALS), "a ramp given by modes", "\"POM\"", "Material of the mesh."),
    Key::optional("ramp.deformable.mesh.unit", Word(&names(&words::LENGTH_UNITS)), "mm", "\"mm\"", "Unit of length of the file."),
    Key::optional("ramp.deformable.mesh.youngs_modulus_gpa", LENGTH, "the material's", "2.85", "Young's modulus, instead of the material's.").usual(0.5, 700.0),
    Key::optional("ramp.deformable.mesh.poisson", Number(open(-1.0, 0.5)), "the material's", "0.37", "Poisson's ratio, instead of the material's.").usual(0.0, 0.45).code("E131"),
    Key::optional("ramp.deformable.mesh.density_kg_per_m3", LENGTH, "the material's", "1410.0", "Density, instead of the material's.").usual(500.0, 12000.0),
    Key::optional("ramp.deformable.mesh.mount_normal_n_per_m", LENGTH, "bolted", "2.0e6", "Stiffness of the mount's face against its plane, spread evenly; without it the face is held.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.mesh.mount_tangential_n_per_m", LENGTH, "as mount_normal_n_per_m", "1.0e6", "Stiffness of the mount's face within its plane.").usual(1e3, 1e10),
    Key::optional("ramp.deformable.mesh.cut_khz", LENGTH, "100.0", "100.0", "Modes with the contacts held, below this frequency, are kept; responses are good to half of it.").usual(5.0, 1000.0).code("E174"),
    Key::optional("ramp.deformable.coupled_modes", Tables, "a ramp given by modes of each arm", "[{ frequency_hz = 3180.2, top_per_sqrt_kg = 211.0, bottom_per_sqrt_kg = 220.0, participation_sqrt_kg = 0.005 }]", "Modes of both arms as one body.").code("E135"),
    Key::required("ramp.deformable.coupled_modes[].frequency_hz", LENGTH, "3180.2", "Undamped natural frequency."),
    Key::required("ramp.deformable.coupled_modes[].top_per_sqrt_kg", Number(ANY), "211.0", "Shape at the top contact, of unit modal mass."),
    Key::required("ramp.deformable.coupled_modes[].bottom_per_sqrt_kg", Number(ANY), "220.0", "Shape at the bottom contact, of unit modal mass."),
    Key::required("ramp.deformable.coupled_modes[].participation_sqrt_kg", Number(ANY), "0.005", "Load on the mode by a unit acceleration of the base."),
    Key::optional("ramp.deformable.coupled_modes[].damping_ratio", RATIO, "as ramp.deformable.damping_ratio", "0.02", "Damping ratio of this mode.").code("E132"),
    Key::optional("ramp.deformable.prony", Tables, "elastic modes", "[{ share = 0.02, time_ms = 0.1 }, { share = 0.03, time_ms = 0.01 }, { share = 0.05, time_ms = 0.001 }]", "Prony series by which the stiffness of every mode relaxes; frequencies are those of the instantaneous modulus. Damping ratios count beside it.").code("E132"),
    Key::required("ramp.deformable.prony[].share", Number(open(0.0, 1.0)), "0.02", "Share of the instantaneous modulus that relaxes; the sum stays below 1.").code("E132"),
    Key::required("ramp.deformable.prony[].time_ms", LENGTH, "0.1", "Relaxation time.").usual(1e-4, 1e3).code("E132"),
    Key::or("ramp.deformable.damping_ratio", RATIO, "0.02", "Damping ratio of the arms' modes.").code("E132"),
];
