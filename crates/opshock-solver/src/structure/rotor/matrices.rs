//! Assembles the matrices of one harmonic of the disk with hub, base and arms (equations: [module](super)).

use std::f64::consts::{PI, TAU};

use crate::disk::{DiskMode, DiskParameters, HubParameters};
use crate::linalg::SquareMatrix;
use crate::modal::{CoupledSystem, Maxwell};
use crate::ramp::Relaxation;
use crate::shock::BaseMode;

/// A mode of an arm, of unit modal mass, that the base shakes or whose stiffness relaxes.
#[derive(Clone, Copy, Debug)]
pub(in crate::structure) struct RidingMode {
    pub omega_rad_per_s: f64,
    pub half_damping_per_s: f64,
    /// Load by a unit acceleration of the ramp's mount, √kg.
    pub participation_sqrt_kg: f64,
    /// Displacement of both contact points, 1/√kg.
    pub shape_per_sqrt_kg: [f64; 2],
}

/// What a harmonic of the disk is coupled with. For n = 1 there is neither base nor arms.
#[derive(Clone, Copy, Default)]
pub(super) struct Stand<'a> {
    pub hub: Option<&'a HubParameters>,
    pub base: &'a [BaseMode],
    pub arms: &'a [RidingMode],
    /// How the stiffness of every mode of the arms relaxes.
    pub relaxation: &'a [Relaxation],
}

/// Where coordinates begin: modes of the base, the hub, modes of the disk, modes of the arms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub n_base: usize,
    pub hub: Option<usize>,
    pub disk: usize,
    pub arms: usize,
    pub order: usize,
}

impl Layout {
    pub fn of(stand: &Stand<'_>, n_disk: usize) -> Self {
        let n_base = stand.base.len();
        let disk = n_base + usize::from(stand.hub.is_some());
        Self {
            n_base,
            hub: stand.hub.map(|_| n_base),
            disk,
            arms: disk + n_disk,
            order: disk + n_disk + stand.arms.len(),
        }
    }
}

/// One harmonic with its supports.
pub(super) struct Matrices {
    pub layout: Layout,
    /// M_d, at the disk's coordinates alone.
    pub disk_mass: SquareMatrix,
    pub system: CoupledSystem,
    /// Load of every coordinate per inertia load along the axis; 0 for n ≥ 1.
    pub load: Vec<f64>,
}

impl Matrices {
    pub fn new(n: usize, stand: &Stand<'_>, modes: &[&DiskMode], disk: &DiskParameters) -> Self {
        let layout = Layout::of(stand, modes.len());
        let square = |omega: f64| omega * omega;
        let scale = (stand
            .base
            .iter()
            .map(|mode| square(TAU * mode.frequency_hz)))
        .chain(stand.hub.map(|hub| hub_of(n, hub, disk).stiffness))
        .chain(modes.iter().map(|mode| square(mode.omega_rad_per_s)))
        .chain(stand.arms.iter().map(|mode| square(mode.omega_rad_per_s)));
        let mut matrices = Self {
            layout,
            disk_mass: SquareMatrix::zeros(layout.order),
            system: CoupledSystem::zeros(scale.collect()),
            load: vec![0.0; layout.order],
        };
        matrices.add_disk(n, stand, modes, disk);
        if let Some(hub) = stand.hub {
            matrices.add_hub(n, hub, disk);
        }
        if n == 0 {
            matrices.add_base(stand, modes);
        }
        matrices
    }

    fn add_disk(
        &mut self,
        n: usize,
        stand: &Stand<'_>,
        modes: &[&DiskMode],
        disk: &DiskParameters,
    ) {
        let (at, own) = (self.layout.disk, &mut self.disk_mass);
        for (j, mode) in modes.iter().enumerate() {
            own.add(at + j, at + j, 1.0);
            if let Some(hub) = self.layout.hub {
                own.add(hub, at + j, mode.participation);
                own.add(at + j, hub, mode.participation);
            }
        }
        if let (Some(hub), Some(_)) = (self.layout.hub, stand.hub) {
            own.add(hub, hub, rigid_disk(n, disk));
        }
        let (turn, system) = (n as f64 * disk.spin_rad_per_s, &mut self.system);
        for row in self.layout.n_base..self.layout.arms {
            for column in self.layout.n_base..self.layout.arms {
                let m = own.get(row, column);
                system.mass.add(row, column, m);
                let still_air = disk.space_fixed_damping_per_s * m;
                system.damping.add(row, column, still_air);
                system.gyroscopic.add(row, column, 2.0 * turn * m);
            }
        }
        for (j, mode) in modes.iter().enumerate() {
            let omega = mode.omega_rad_per_s;
            let rate = 2.0 * mode.damping_ratio * omega;
            system.damping.add(at + j, at + j, rate);
            let stiffness = (omega - turn) * (omega + turn);
            system.stiffness.add(at + j, at + j, stiffness);
            system.cross_stiffness.add(at + j, at + j, rate * turn);
        }
    }

    fn add_hub(&mut self, n: usize, hub: &HubParameters, disk: &DiskParameters) {
        let own = hub_of(n, hub, disk);
        let Some(at) = self.layout.hub else { return };
        let system = &mut self.system;
        system.mass.add(at, at, own.inertia);
        system.damping.add(at, at, own.damping);
        let across = disk.spin_rad_per_s * own.polar_inertia + own.damping_across;
        system.gyroscopic.add(at, at, across);
        system.stiffness.add(at, at, own.stiffness);
        system.cross_stiffness.add(at, at, own.stiffness_across);
    }

    /// Adds base, arms, and loads: what stands on the base loads it by the inertia of its own motion.
    fn add_base(&mut self, stand: &Stand<'_>, modes: &[&DiskMode]) {
        let Layout {
            n_base,
            hub,
            disk,
            arms,
            ..
        } = self.layout;
        if let Some(hub) = hub {
            self.load[hub] = self.system.mass.get(hub, hub);
        }
        for (j, mode) in modes.iter().enumerate() {
            self.load[disk + j] = mode.participation;
        }
        for (j, mode) in stand.arms.iter().enumerate() {
            let at = arms + j;
            let omega = mode.omega_rad_per_s;
            self.load[at] = mode.participation_sqrt_kg;
            self.system.mass.add(at, at, 1.0);
            let damping = 2.0 * mode.half_damping_per_s;
            self.system.damping.add(at, at, damping);
            // The relaxing share of the stiffness belongs to Maxwell elements, so 1 − Σ g of it stays here.
            let mut lasting = 1.0;
            for term in stand.relaxation {
                lasting -= term.share;
                self.system.elements.push(Maxwell {
                    coordinate: at,
                    stiffness: term.share * omega * omega,
                    time_s: term.time_s,
                });
            }
            self.system.stiffness.add(at, at, lasting * (omega * omega));
        }
        for (k, mode) in stand.base.iter().enumerate() {
            let omega = TAU * mode.frequency_hz;
            self.load[k] = mode.participation_sqrt_kg;
            self.system.mass.add(k, k, 1.0);
            let damping = 2.0 * mode.damping_ratio * omega;
            self.system.damping.add(k, k, damping);
            self.system.stiffness.add(k, k, omega * omega);
            for j in n_base..self.layout.order {
                let mount = match j < arms {
                    true => mode.spindle_per_sqrt_kg,
                    false => mode.ramp_per_sqrt_kg,
                };
                self.system.mass.add(k, j, mount * self.load[j]);
                self.system.mass.add(j, k, mount * self.load[j]);
            }
        }
    }
}

/// Mass or transverse inertia of the free part of the disk in rigid motion.
fn rigid_disk(n: usize, disk: &DiskParameters) -> f64 {
    let (a2, b2) = (disk.inner_radius_m.powi(2), disk.outer_radius_m.powi(2));
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    match n {
        0 => PI * areal * (b2 - a2),
        _ => 0.25 * PI * areal * (b2 * b2 - a2 * a2),
    }
}

/// Hub and bearing in one of their motions.
struct HubMotion {
    inertia: f64,
    polar_inertia: f64,
    stiffness: f64,
    damping: f64,
    stiffness_across: f64,
    damping_across: f64,
}

fn hub_of(n: usize, hub: &HubParameters, disk: &DiskParameters) -> HubMotion {
    let sense = if disk.spin_rad_per_s < 0.0 { -1.0 } else { 1.0 };
    match n {
        0 => HubMotion {
            inertia: hub.mass_kg,
            polar_inertia: 0.0,
            stiffness: hub.axial_stiffness_n_per_m,
            damping: hub.axial_damping_n_s_per_m,
            stiffness_across: 0.0,
            damping_across: 0.0,
        },
        _ => HubMotion {
            inertia: hub.transverse_inertia_kg_m2,
            polar_inertia: hub.polar_inertia_kg_m2,
            stiffness: hub.tilt_stiffness_n_m_per_rad,
            damping: hub.tilt_damping_n_m_s_per_rad,
            stiffness_across: sense * hub.cross_stiffness_n_m_per_rad,
            damping_across: sense * hub.cross_damping_n_m_s_per_rad,
        },
    }
}

/// Modes of the clamped disk that move with a hub, or else with a base.
pub(in crate::structure) fn is_carried(mode: &DiskMode, is_on_hub: bool) -> bool {
    mode.nodal_diameters <= usize::from(is_on_hub) && mode.nodal_circles.is_some()
}
