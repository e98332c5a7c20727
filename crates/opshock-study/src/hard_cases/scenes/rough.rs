//! Rough surfaces: films with asperities at any attitude, closed forms of what they bear, and a mass that bounces on them.

use opshock_solver::air_bearing::gap_forces::AsperityContact;
use opshock_solver::air_bearing::{Attitude, Film};
use opshock_solver::rough_contact::nominal::NominalContact;
use opshock_solver::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};

use super::super::check::largest;
use super::heads::{default_slider, even_film};

/// Surfaces that hardly yield.
pub const ROUGH: AsperityContact = AsperityContact {
    roughness_m: 0.5e-9,
    asperities_per_m2: 1e14,
    tip_radius_m: 1e-6,
    modulus_pa: 1e11,
    yield_pressure_pa: 12e9,
    friction: 0.3,
};

/// The same without yielding.
pub const ELASTIC: AsperityContact = AsperityContact {
    yield_pressure_pa: 1e15,
    ..ROUGH
};

/// Surfaces that yield under light impacts.
pub const SOFT: AsperityContact = AsperityContact {
    yield_pressure_pa: 1e9,
    tip_radius_m: 20e-9,
    ..ROUGH
};

/// F_(3/2)(x) of Greenwood and Williamson, by 35-digit arithmetic.
pub const INTEGRALS: [(f64, f64); 10] = [
    (-6.0, 14.850_864_472_910_9),
    (-4.0, 8.189_959_426_789_36),
    (-2.37, 3.903_653_875_563_55),
    (-1.0, 1.404_597_470_473_95),
    (0.0, 0.430_019_993_662_26),
    (0.7, 0.136_305_416_086_598),
    (1.0, 0.075_668_177_390_975_1),
    (1.61, 0.018_778_343_591_143_2),
    (2.5, 0.001_469_938_239_537_99),
    (4.0, 4.439_155_958_539_25e-6),
];

/// 4/3 η E′ √R σ^(3/2), Pa.
pub fn unit_pressure_pa(rough: &AsperityContact) -> f64 {
    4.0 / 3.0
        * rough.asperities_per_m2
        * rough.modulus_pa
        * rough.tip_radius_m.sqrt()
        * rough.roughness_m.powf(1.5)
}

/// Restitution of a sphere at v times the speed of first yield, v >= 1: Thornton, J. Appl. Mech. 64 (1997) 383, equation 30.
pub fn restitution(v: f64) -> f64 {
    let inverse = 1.0 / v;
    let square = inverse * inverse;
    let ratio = inverse / (inverse + 2.0 * (1.2 - 0.2 * square).sqrt());
    (6.0 * 3.0_f64.sqrt() / 5.0 * (1.0 - square / 6.0) * ratio.sqrt()).sqrt()
}

/// A plane slider at a skew.
pub fn plate(skew_deg: f64) -> SliderParameters {
    SliderParameters {
        surface: SurfaceParameters::default(),
        skew_rad: skew_deg.to_radians(),
        ..default_slider()
    }
}

/// A slider of one pad, deep base around it.
pub fn padded(outline: RailOutline) -> SliderParameters {
    let surface = SurfaceParameters {
        base_recess_m: 5e-6,
        rails: vec![Rail {
            outline,
            recess_m: 0.0,
        }],
        ..SurfaceParameters::default()
    };
    SliderParameters {
        surface,
        ..plate(0.0)
    }
}

/// Film of 12 × 12 cells with contact.
pub fn film(slider: &SliderParameters, contact: AsperityContact) -> Film {
    even_film(slider, 12, &contact)
}

/// Without tilt.
pub fn level(height_m: f64) -> Attitude {
    Attitude {
        centre_height_m: height_m,
        ..Attitude::default()
    }
}

/// Attitude of a slider whose plane has these slopes and its lowest place `depth_m` below the disk.
pub fn struck(
    slider: &SliderParameters,
    film: &Film,
    depth_m: f64,
    [pitch_rad, roll_rad]: [f64; 2],
) -> Attitude {
    let at = |centre_height_m: f64| Attitude {
        centre_height_m,
        pitch_rad,
        roll_rad,
    };
    let far_m = slider.length_m;
    let lowest_m = film.min_clearance(&at(far_m)).value_m;
    at(far_m - lowest_m - depth_m)
}

/// The integral of s^`power` p(s - depth) over s from 0.
pub fn moment_of_pressure(nominal: &NominalContact, depth_m: f64, power: i32) -> f64 {
    let parts = 20_000;
    let step_m = (nominal.reach_m() + depth_m) / f64::from(parts);
    let part = |k: i32| {
        let s = (f64::from(k) + 0.5) * step_m;
        s.powi(power) * nominal.at(s - depth_m, f64::INFINITY).pressure_pa * step_m
    };
    (0..parts).map(part).sum()
}

/// A mass that falls onto a rough area of 0.01 mm2 again and again.
#[derive(Debug)]
pub struct Bounces<'a> {
    contact: &'a NominalContact,
    /// Height, velocity, smallest height so far.
    state: [f64; 3],
}

/// Speed of the first impact of [`Bounces`], m/s, mass, kg, weight, N, and area, m2.
const IMPACT_M_PER_S: f64 = 5e-3;
const MASS_KG: f64 = 1.6e-6;
const WEIGHT_N: f64 = 2.5e-4;
const AREA_M2: f64 = 1e-8;

/// What a hundred impacts leave.
#[derive(Clone, Copy, Debug)]
pub struct AfterBounces {
    /// Largest energy not accounted for, of the kinetic energy before the first.
    pub imbalance: f64,
    /// Kinetic energy after the first, of the same.
    pub returned: f64,
}

impl<'a> Bounces<'a> {
    /// Onto surfaces that have not touched.
    pub fn onto(contact: &'a NominalContact) -> Self {
        Self {
            contact,
            state: [contact.reach_m(), -IMPACT_M_PER_S, f64::INFINITY],
        }
    }

    /// A hundred impacts, by Runge and Kutta's rule in contact and in closed form between.
    pub fn hundred(mut self) -> AfterBounces {
        let reach_m = self.contact.reach_m();
        let began_j = self.energy_j();
        let scale_j = 0.5 * MASS_KG * IMPACT_M_PER_S * IMPACT_M_PER_S;
        let mut returned = None;
        let imbalances = (0..100).map(|_| {
            while self.step(5e-10) {}
            let imbalance = (self.energy_j() - began_j).abs() / scale_j;
            let [h, v, closest] = self.state;
            let left = 0.5 * MASS_KG * v * v + WEIGHT_N * (h - reach_m);
            returned.get_or_insert(left / scale_j);
            // The flight up and down again.
            let fall = (v * v + 2.0 * WEIGHT_N / MASS_KG * (h - reach_m)).sqrt();
            self.state = [reach_m, -fall, closest];
            imbalance
        });
        AfterBounces {
            imbalance: largest(imbalances),
            returned: returned.unwrap_or_default(),
        }
    }

    /// One step in contact; true until it flies again.
    fn step(&mut self, dt_s: f64) -> bool {
        let [h, v, closest] = self.state;
        let acceleration =
            |h: f64| (AREA_M2 * self.contact.at(h, closest).pressure_pa - WEIGHT_N) / MASS_KG;
        let rate = |[h, v]: [f64; 2]| [v, acceleration(h)];
        let moved = |k: [f64; 2], share: f64| [h + share * dt_s * k[0], v + share * dt_s * k[1]];
        let k1 = rate([h, v]);
        let k2 = rate(moved(k1, 0.5));
        let k3 = rate(moved(k2, 0.5));
        let k4 = rate(moved(k3, 1.0));
        let sum = |q: usize| (k1[q] + 2.0 * k2[q] + 2.0 * k3[q] + k4[q]) / 6.0;
        let (h, v) = (h + dt_s * sum(0), v + dt_s * sum(1));
        self.state = [h, v, closest.min(h)];
        v <= 0.0 || h < self.contact.reach_m()
    }

    /// Motion, height and what the contact keeps and has kept, J.
    fn energy_j(&self) -> f64 {
        let [h, v, closest] = self.state;
        let contact = self.contact;
        let of_area = match closest < contact.reach_m() {
            true => {
                contact.elastic_j_per_m2(h, closest) + contact.work_j_per_m2(closest)
                    - contact.elastic_j_per_m2(closest, closest)
            }
            false => 0.0,
        };
        0.5 * MASS_KG * v * v + WEIGHT_N * h + AREA_M2 * of_area
    }
}
