//! Hard cases A of the plate: frequencies, extreme radii, omitted modes.

use super::check::Check;
use super::naive;
use super::scenes::structures::paper;
use super::structure::run;
use opshock_solver::disk::{DiskBasis, DiskDamping, DiskParameters, DiskResolution, Harmonics};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::RigidRamp;
use opshock_solver::structure::{StructureRun, Window};

/// A plate at rest with outer radius 1 and sqrt(ρ h/D) = 1: ω is λ².
fn unit_plate(inner: f64) -> DiskParameters {
    let poisson = 0.3;
    DiskParameters {
        inner_radius_m: inner,
        outer_radius_m: 1.0,
        thickness_m: 1e-2,
        youngs_modulus_pa: 12.0 * (1.0 - poisson * poisson) * 1e6,
        poisson,
        density_kg_per_m3: 100.0,
        spin_rad_per_s: 0.0,
        damping: DiskDamping::ModalRatio(0.0),
        space_fixed_damping_per_s: 0.0,
        hub: None,
    }
}

fn plate_basis(inner: f64, n_elements: usize) -> DiskBasis {
    basis(&unit_plate(inner), n_elements)
}

fn basis(plate: &DiskParameters, n_elements: usize) -> DiskBasis {
    let resolution = DiskResolution {
        n_harmonics: 4,
        cut_hz: 1e6,
        n_elements,
        static_correction: false,
    };
    DiskBasis::build(plate, &resolution, &[], None, Harmonics::All).expect("a plate")
}

fn lambda_squared(basis: &DiskBasis, n: usize) -> f64 {
    let of_n = basis.modes.iter().filter(|m| m.nodal_diameters == n);
    of_n.map(|m| m.omega_rad_per_s).fold(f64::MAX, f64::min)
}

pub(super) fn a11() -> Vec<Check> {
    let (mut worst, mut order, mut slip) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (inner, exact) in [
        (0.5, [13.024257, 13.289781, 14.703812, 18.561989, 25.595817]),
        (0.3, [6.660367, 6.552314, 7.956487, 13.275733, 22.073777]),
        (
            0.384_615_384_6,
            [8.576955, 8.643146, 9.991785, 14.607838, 22.761462],
        ),
    ] {
        let [coarse, middle, fine] = [12, 24, 48].map(|n| plate_basis(inner, n));
        // The same rigidity D; Poisson's ratio enters the free edge's conditions alone.
        let slipped = DiskParameters {
            poisson: 0.0,
            youngs_modulus_pa: 12e6,
            ..unit_plate(inner)
        };
        let slipped = basis(&slipped, 48);
        for (n, exact) in exact.into_iter().enumerate() {
            let [a, b, c] = [&coarse, &middle, &fine].map(|basis| lambda_squared(basis, n));
            worst = worst.max((c / exact - 1.0).abs());
            slip = slip.max((lambda_squared(&slipped, n) / exact - 1.0).abs());
            order = order.max((((a - b) / (b - c)).log2() - 4.0).abs());
        }
    }
    vec![
        Check::new("15 frequencies against the Bessel determinant", worst, 1e-6)
            .against("Poisson's terms left out of the free edge", slip),
        Check::new("order of the frequencies, distance to 4", order, 0.25),
    ]
}

pub(super) fn a12() -> Vec<Check> {
    let (mut rise, mut real) = (0.0_f64, 0);
    for inner in [0.05, 0.95] {
        let bases = [8, 16, 32].map(|n| plate_basis(inner, n));
        for n in 0..=4 {
            let values = bases.each_ref().map(|basis| lambda_squared(basis, n));
            rise = rise
                .max(values[1] / values[0] - 1.0)
                .max(values[2] / values[1] - 1.0);
            real += values
                .iter()
                .filter(|v| !(v.is_finite() && **v > 0.0))
                .count();
        }
    }
    let meshes = [0.05, 0.95]
        .into_iter()
        .flat_map(|a| [8, 16, 32].map(|n| (a, n)));
    let indefinite =
        meshes.filter(|&(a, n)| !naive::plate::powers_of_the_radius_are_definite(a, n));
    vec![
        Check::new(
            "rise of a frequency when the mesh is halved, b/a 0.05 and 0.95",
            rise,
            1e-9,
        ),
        Check::none("frequencies that are not positive", real).against(
            "8, 16, 32 powers of the radius: mass matrices that are not definite",
            indefinite.count() as f64,
        ),
    ]
}

pub(super) fn a13() -> Vec<Check> {
    // A push so slow that all modes follow at once: only the flexibility of the omitted modes matters.
    let mut base = paper(10e-3, RigidRamp).with_step(4e-6);
    base.disk.damping = DiskDamping::ModalRatio(0.3);
    base.window = Window::Fixed { length_s: 6e-3 };
    let at = |cut: f64, corrected: bool| {
        let mut structure = base.with_cut(cut);
        structure.disk_resolution.static_correction = corrected;
        run(&structure, 800.0 * G)
    };
    let truth = at(80e3, true);
    let reaction = |run: &StructureRun| run.top.impulse_n_s;
    let error =
        |cut: f64, corrected: bool| (reaction(&at(cut, corrected)) / reaction(&truth) - 1.0).abs();
    let plain = [5e3, 20e3].map(|cut| error(cut, false));
    let corrected = [5e3, 20e3].map(|cut| error(cut, true));
    let of = |k: usize| corrected[k] / plain[k];
    vec![
        Check::new(
            "ramp's reaction: error with the correction, of without",
            of(0).max(of(1)),
            0.8,
        )
        // The figure is a share of the naive error.
        .against("left out", 1.0),
        Check::new(
            "error with modes to 20 kHz, of to 5 kHz",
            corrected[1] / corrected[0],
            0.3,
        ),
    ]
}
