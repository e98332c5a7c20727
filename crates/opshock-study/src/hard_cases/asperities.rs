//! Hard cases G: contact of rough surfaces.

use super::check::{Check, largest};
use super::naive::asperities as naive;
use super::scenes::heads::{
    SuddenDisk, default_resolution, default_slider, film_of, gap_load, rough_film, suspended_by,
};
use super::scenes::rough::{
    Bounces, ELASTIC, INTEGRALS, ROUGH, SOFT, film, level, moment_of_pressure, padded, plate,
    restitution, struck, unit_pressure_pa,
};
use super::scenes::suspensions::default_suspension;
use opshock_solver::air_bearing::Film;
use opshock_solver::air_bearing::gap_forces::AsperityContact;
use opshock_solver::air_bearing::steady::fly;
use opshock_solver::head::{HeadResolution, HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::quantity::rad_per_s_from_rpm;
use opshock_solver::rough_contact::asperity::AsperityLaw;
use opshock_solver::rough_contact::roughness::normal_density;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::slider::RailOutline;
use opshock_solver::suspension::SuspensionParameters;

/// 2/12 to 9/12 of a slider's length and width: a pad on grid lines of [`film`].
fn pad_m() -> [[f64; 2]; 2] {
    let slider = default_slider();
    [slider.length_m, slider.width_m].map(|extent_m| [2.0, 9.0].map(|line| line / 12.0 * extent_m))
}

/// Force on the pad at depths and slopes against closed forms: largest errors of opshock and of a uniform grid.
fn forces_on_pad(
    depths_m: &[f64],
    slopes: [f64; 2],
    closed_form_n: impl Fn(f64) -> f64,
) -> [f64; 2] {
    let [x_m, y_m] = pad_m();
    let slider = padded(RailOutline::Rectangle { x_m, y_m });
    let centre_m = [0.5 * slider.length_m, 0.5 * slider.width_m];
    let (film, nominal) = (film(&slider, ROUGH), ROUGH.nominal());
    let errors = depths_m.iter().map(|&depth_m| {
        let at = struck(&slider, &film, depth_m, slopes);
        let middles = naive::force_at_middles(&nominal, &at, [x_m, y_m], centre_m);
        let found = gap_load(&film, &at).force[0];
        [found, middles].map(|force| (force / closed_form_n(depth_m) - 1.0).abs())
    });
    let errors: Vec<[f64; 2]> = errors.collect();
    [0, 1].map(|k| largest(errors.iter().map(|pair| pair[k])))
}

pub(super) fn g1() -> Vec<Check> {
    // h = h0 + a u + b v over u, v >= 0 bears 1/(a b) times the integral of s p(h0 + s).
    let (a, b) = (1e-3, 5e-3);
    let depths_m = [0.1e-9, 1e-9, 5e-9, 20e-9];
    let [found, middles] = forces_on_pad(&depths_m, [-a, b], |depth_m| {
        moment_of_pressure(&ROUGH.nominal(), depth_m, 1) / (a * b)
    });
    vec![
        Check::new(
            "force on a corner 0.1 to 20 nm deep against its closed form",
            found,
            0.05,
        )
        .against("pressures at the middles of 100 x 100 cells", middles),
    ]
}

pub(super) fn g2() -> Vec<Check> {
    // A rail's side of the length L that rises with the slope b bears L/b times the integral of p.
    let [[from_m, to_m], _] = pad_m();
    let b = 3e-3;
    let [found, middles] = forces_on_pad(&[1e-9, 5e-9, 20e-9], [0.0, b], |depth_m| {
        (to_m - from_m) / b * moment_of_pressure(&ROUGH.nominal(), depth_m, 0)
    });
    vec![
        Check::new(
            "force on the side of a rail, 1 to 20 nm deep, against its closed form",
            found,
            0.02,
        )
        .against("pressures at the middles of 100 x 100 cells", middles),
    ]
}

pub(super) fn g3() -> Vec<Check> {
    let slider = plate(0.0);
    let smooth = film(&slider, AsperityContact::default());
    let nearly = AsperityContact {
        roughness_m: 1e-12,
        ..ROUGH
    };
    let sigma_m = nearly.roughness_m;
    let nearly = film(&slider, nearly);
    // Above twice the minimum film height smooth surfaces see the true height.
    let heights_m = [1e-9, 3e-9, 20e-9];
    let changes = heights_m.map(|height_m| {
        let at = level(height_m);
        let mut psi = vec![0.0; smooth.n_cells()];
        smooth.ambient_psi(&at, &mut psi);
        psi.iter_mut().for_each(|psi| *psi *= 3.0);
        let force = |film: &Film| film.force(&psi, &at, &mut film.scratch())[0];
        (force(&nearly) / force(&smooth) - 1.0).abs()
    });
    let gaps = heights_m.map(|h_m| (naive::mean_gap_in_steps(h_m, sigma_m) / h_m - 1.0).abs());
    vec![
        Check::new(
            "force of a film between planes of 1 pm of roughness against smooth ones",
            largest(changes),
            1e-15,
        )
        .against(
            "their mean gap summed over heights in steps of 0.1 nm",
            largest(gaps),
        ),
    ]
}

pub(super) fn g4() -> Vec<Check> {
    let stiff = AsperityContact {
        modulus_pa: 1e13,
        yield_pressure_pa: 1e17,
        ..ROUGH
    };
    let suspension = default_suspension();
    let [fine, coarse] =
        [1e-4, 5e-2].map(|tolerance| approached(&stiff, 0.02, tolerance, &suspension));
    vec![
        Check::none(
            "runs of a head against such a disk without a verdict",
            undecided(&fine),
        ),
        Check::new(
            "energy imbalance at the end, of the largest energy",
            imbalance(&fine),
            0.02,
        )
        .against("steps of the preset coarse", imbalance(&coarse)),
    ]
}

/// A head whose disk comes at a speed for 20 us, through its contacts.
fn approached(
    rough: &AsperityContact,
    velocity_m_per_s: f64,
    tolerance: f64,
    suspension: &SuspensionParameters,
) -> HeadRun {
    let (film, flight) = rough_film(300, rough);
    let resolution = HeadResolution {
        tolerance,
        ..default_resolution()
    };
    let model = suspended_by(suspension, &film, &flight, &resolution);
    let pulse = Pulse {
        shape: PulseShape::HalfSine,
        width_s: 2e-3,
    };
    let load = ShockLoad {
        base: None,
        pulse: &pulse,
        amplitude_m_per_s2: 0.0,
    };
    let mut workspace = HeadWorkspace::new(&model);
    let disk = SuddenDisk { velocity_m_per_s };
    model.run(&disk, &load, 2e-5, false, true, &mut workspace)
}

/// Energy imbalance at the end of a run, of the largest energy.
fn imbalance(run: &HeadRun) -> f64 {
    let contact = run.slider_contact.as_ref().expect("rough surfaces");
    let energy = contact.energy.expect("the run goes on");
    energy.imbalance_j.abs() / energy.peak_j
}

fn undecided(run: &HeadRun) -> usize {
    usize::from(matches!(run.verdict, Verdict::Undecided { .. }) || run.broke_off.is_some())
}

pub(super) fn g5() -> Vec<Check> {
    let law = AsperityLaw::new(2e-6, 1e11, 1e10);
    // Work of loading in units of the limit: 2/5 up to it, then that of a straight line.
    let unit_j = law.limit_n * law.limit_m;
    let work = |depth: f64| unit_j * (0.75 * depth * depth - 0.5 * depth + 0.15);
    let speeds = [1.5, 3.0, 10.0, 100.0];
    let errors = speeds.map(|v: f64| {
        // The depth at which the work is v² times that of first yield.
        let square = v * v * 0.4 - 0.15 + 0.25 / 3.0;
        let depth = (square / 0.75).sqrt() + 1.0 / 3.0;
        let deepest_m = depth * law.limit_m;
        let returned_j = law.unloading(deepest_m).energy(deepest_m, deepest_m);
        ((returned_j / work(depth)).sqrt() / restitution(v) - 1.0).abs()
    });
    vec![
        Check::new(
            "restitution of an asperity at 1.5 to 100 times its speed of first yield, against Thornton's",
            largest(errors),
            1e-12,
        )
        .against(
            "a law that is a function of the depth alone gives everything back",
            1.0 / restitution(100.0) - 1.0,
        ),
    ]
}

pub(super) fn g6() -> Vec<Check> {
    let soft = SOFT.nominal();
    let after = Bounces::onto(&soft).hundred();
    let again = 1.0 - after.returned;
    vec![
        Check::new(
            "energy imbalance over 100 bounces on surfaces that yield, of the kinetic energy",
            after.imbalance,
            1e-9,
        )
        .against("what yielding keeps of the first, not counted", again),
        Check::new(
            "kinetic energy after the first, of that before",
            after.returned,
            0.9,
        ),
    ]
}

pub(super) fn g7() -> Vec<Check> {
    let nominal = ROUGH.nominal();
    let depths = [10.0, 40.0, 100.0, 400.0].map(|x| -x * ROUGH.roughness_m);
    let borne = depths.map(|h_m| nominal.at(h_m, f64::INFINITY));
    let elastic = ELASTIC.nominal().at(depths[3], f64::INFINITY).pressure_pa;
    let yields_pa = ROUGH.yield_pressure_pa;
    vec![
        Check::new(
            "pressure 200 nm deep over that of yielding",
            largest(borne.map(|borne| borne.pressure_pa / yields_pa)),
            1.0,
        )
        .against(
            "Greenwood and Williamson's, which knows no bound",
            elastic / yields_pa,
        ),
        Check::none(
            "slopes that rise with the distance",
            borne
                .iter()
                .filter(|borne| borne.slope_pa_per_m > 0.0 || borne.slope_pa_per_m.is_nan())
                .count(),
        ),
    ]
}

pub(super) fn g8() -> Vec<Check> {
    let nominal = ELASTIC.nominal();
    let unit_pa = unit_pressure_pa(&ELASTIC);
    let errors = INTEGRALS.map(|(x, exact)| {
        let borne = nominal.at(x * ELASTIC.roughness_m, f64::INFINITY);
        (borne.pressure_pa / (unit_pa * exact) - 1.0).abs()
    });
    let light = INTEGRALS
        .into_iter()
        .filter(|(x, _)| (0.7..=2.5).contains(x));
    let fitted = light.map(|(x, exact)| (naive::exponential_heights(x) / exact - 1.0).abs());
    vec![
        Check::new(
            "Greenwood and Williamson's pressure from -6 to 4 sigma against 35 digits",
            largest(errors),
            1e-8,
        )
        .against(
            "an exponential through the density at 1 and 3 sigma, 0.7 to 2.5 sigma",
            largest(fitted),
        ),
    ]
}

pub(super) fn g9() -> Vec<Check> {
    // The limit of elasticity lies 1.4 sigma deep, so that it falls among the asperities that touch. The reference has the same law and
    // the same bound: the quadrature is what is tried.
    let soft = AsperityContact {
        yield_pressure_pa: 1.7e9,
        ..ROUGH
    };
    let law = AsperityLaw::new(soft.tip_radius_m, soft.modulus_pa, soft.yield_pressure_pa);
    let sigma_m = soft.roughness_m;
    let reference = |h_m: f64| {
        let parts = 400_000;
        let highest = 8.3;
        let lowest = (h_m / sigma_m).max(-highest);
        let step = (highest - lowest) / f64::from(parts);
        let pressed = (0..parts).map(|k| {
            let s = lowest + (f64::from(k) + 0.5) * step;
            normal_density(s) * law.force(s * sigma_m - h_m)
        });
        let pressure_pa = soft.asperities_per_m2 * step * pressed.sum::<f64>();
        soft.yield_pressure_pa * (pressure_pa / soft.yield_pressure_pa).tanh()
    };
    let nominal = soft.nominal();
    let heights_m = [-5.0, -1.4, 0.0, 1.0, 2.0].map(|x| x * sigma_m);
    let errors = heights_m.map(|h_m| {
        let exact = reference(h_m);
        let across = naive::pressure_across_the_limit(soft.asperities_per_m2, &law, sigma_m, h_m);
        let across = soft.yield_pressure_pa * (across / soft.yield_pressure_pa).tanh();
        let found = nominal.at(h_m, f64::INFINITY).pressure_pa;
        [found, across].map(|pressure_pa| (pressure_pa / exact - 1.0).abs())
    });
    vec![
        Check::new(
            "pressure where some asperities yield and some do not, against 400 000 heights",
            largest(errors.map(|[found, _]| found)),
            1e-8,
        )
        .against(
            "Gauss's rule in parts that the limit lies across",
            largest(errors.map(|[_, across]| across)),
        ),
    ]
}

pub(super) fn g10() -> Vec<Check> {
    let skews = [0.0, 12.0, -17.0];
    let errors = skews.map(|skew_deg| {
        let slider = plate(skew_deg);
        let film = film(&slider, ROUGH);
        let load = gap_load(&film, &level(0.2e-9));
        // Along the disk's motion, which is along the track, whatever the skew.
        let [along, across] = load.in_plane_n.unwrap_or_default();
        let force = ROUGH.friction * load.force[0];
        ((along - force) / force).hypot(across / force)
    });
    vec![
        Check::new(
            "friction against its coefficient times the normal force along the track, skew 0, 12 and -17 degrees",
            largest(errors),
            1e-12,
        )
        .against(
            "friction along the slider's own axis",
            2.0 * (0.5 * 17.0_f64.to_radians()).sin(),
        ),
    ]
}

pub(super) fn g11() -> Vec<Check> {
    let rough = AsperityContact {
        roughness_m: 4e-9,
        ..ROUGH
    };
    let slider = default_slider();
    let film = film_of(&slider, rad_per_s_from_rpm(3600.0), 300).with_gap_force(&slider, &rough);
    let load_n = default_suspension().gram_load_n;
    let flight = fly(&film, [load_n, 0.0, 0.0]);
    let borne = flight.map(|flight| {
        let mut scratch = film.scratch();
        let force = film.force(&flight.psi, &flight.attitude, &mut scratch)[0];
        let air = film.air_force(&flight.psi, &flight.attitude, &mut scratch)[0];
        [force, air].map(|force| (force / load_n - 1.0).abs())
    });
    let [all, air] = borne.unwrap_or([f64::NAN; 2]);
    vec![
        Check::new(
            "load of a slider that flies on its asperities against air and asperities",
            all,
            1e-6,
        )
        .against("against the air alone", air),
    ]
}

pub(super) fn g12() -> Vec<Check> {
    // The impact throws the slider off the load beam while its asperities still bear.
    let suspension = default_suspension();
    // Pressed so that it never opens.
    let mut pressed = suspension.clone();
    pressed.gimbal.dimple_preload_n = 10.0;
    let [run, never_opens] =
        [&suspension, &pressed].map(|suspension| approached(&ROUGH, 0.3, 1e-4, suspension));
    let never_open = |run: &HeadRun| {
        let columns = run.columns.as_ref().expect("recorded");
        let forces = columns.dimple_force_n.iter().zip(&columns.asperity_force_n);
        let both = forces.filter(|&(&dimple, &asperities)| dimple == 0.0 && asperities > 1e-3);
        usize::from(both.count() == 0)
    };
    vec![
        Check::none("runs without a verdict", undecided(&run)),
        Check::none(
            "runs in which the dimple is never open while the asperities bear",
            never_open(&run),
        )
        .against(
            "a spring that presses and pulls",
            never_open(&never_opens) as f64,
        ),
        Check::new(
            "energy imbalance at the end, of the largest energy",
            imbalance(&run),
            0.02,
        ),
    ]
}
