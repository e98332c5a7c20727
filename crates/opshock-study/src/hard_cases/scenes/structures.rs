//! Named structures: disks, ramps and pulses of the reference sets.

use opshock_solver::disk::{DiskDamping, DiskParameters, DiskResolution, Harmonics};
use opshock_solver::quantity::{rad_from_deg, rad_per_s_from_rpm};
use opshock_solver::ramp::{
    ArmMode, Arms, CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, RampBody, RampParameters,
};
use opshock_solver::shock::{BaseMode, ObliqueShock, Pulse, PulseShape};
use opshock_solver::structure::{
    ContactMethod, SliderPlace, StructureModel, StructureParameters, StructureResolution, Window,
};

/// A structure with all data of its model, to be varied by tests.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Disk.
    pub disk: DiskParameters,
    /// Resolution of the disk.
    pub disk_resolution: DiskResolution,
    /// Ramp.
    pub ramp: RampParameters,
    /// Slider.
    pub slider: SliderPlace,
    /// Pulse.
    pub pulse: Pulse,
    /// Other motion of the base.
    pub oblique: Option<ObliqueShock>,
    /// Modes of the base.
    pub base: Vec<BaseMode>,
    /// Window.
    pub window: Window,
    /// Resolution in time.
    pub resolution: StructureResolution,
}

impl Structure {
    /// Builds the model.
    ///
    /// # Panics
    /// When the structure is refused.
    pub fn build(&self) -> StructureModel {
        StructureModel::build(&self.parameters(), Harmonics::All).expect("structure")
    }

    /// The parameters by reference.
    pub fn parameters(&self) -> StructureParameters<'_> {
        StructureParameters {
            disk: &self.disk,
            disk_resolution: &self.disk_resolution,
            ramp: &self.ramp,
            slider: self.slider,
            pulse: &self.pulse,
            oblique: self.oblique.as_ref(),
            base: &self.base,
            window: self.window,
            resolution: &self.resolution,
        }
    }

    /// The same with another ramp model.
    pub fn with_ramp(&self, model: impl Into<RampBody>) -> Self {
        let mut other = self.clone();
        other.ramp.model = model.into();
        other
    }

    /// The same with another step, s.
    pub fn with_step(&self, step_s: f64) -> Self {
        let mut other = self.clone();
        other.resolution.step_s = step_s;
        other
    }

    /// The same with Moreau-Jean contact.
    pub fn with_moreau_jean(&self) -> Self {
        let mut other = self.clone();
        other.resolution.contact = ContactMethod::MoreauJean;
        other
    }

    /// The same with another mode cut, Hz.
    pub fn with_cut(&self, cut_hz: f64) -> Self {
        let mut other = self.clone();
        other.disk_resolution.cut_hz = cut_hz;
        other
    }
}

/// Half-sine of a width in s.
pub fn half_sine(width_s: f64) -> Pulse {
    Pulse {
        shape: PulseShape::HalfSine,
        width_s,
    }
}

/// Disk of the spinning-disk, no-ramp and contact references.
pub fn reference_disk() -> DiskParameters {
    DiskParameters {
        inner_radius_m: 0.010,
        outer_radius_m: 0.0325,
        thickness_m: 0.635e-3,
        youngs_modulus_pa: 70e9,
        poisson: 0.33,
        density_kg_per_m3: 2700.0,
        spin_rad_per_s: rad_per_s_from_rpm(5400.0),
        damping: DiskDamping::ModalRatio(0.004),
        space_fixed_damping_per_s: 0.0,
        hub: None,
    }
}

/// The 2.5-inch disk of the default and of the paper's set.
pub fn drive_disk() -> DiskParameters {
    DiskParameters {
        inner_radius_m: 0.01001,
        youngs_modulus_pa: 75e9,
        poisson: 0.30,
        density_kg_per_m3: 2710.0,
        damping: DiskDamping::Rayleigh {
            alpha_per_s: 25.0,
            beta_s: 1.0e-7,
        },
        ..reference_disk()
    }
}

fn arms(modes: Vec<ArmMode>) -> RampBody {
    Arms {
        top: modes.clone(),
        bottom: modes,
    }
    .into()
}

/// Arms of set S1.
pub fn s1_arms() -> RampBody {
    arms(vec![
        ArmMode {
            frequency_hz: 904.704_632_189_596_7,
            mass_kg: 5.444_176_061_055_895_5e-5,
            participation: 0.274_944_597_345_495_5,
            damping_ratio: 0.005,
        },
        ArmMode {
            frequency_hz: 16_018.195_852_815_406,
            mass_kg: 1.118_127_873_464_818_3e-5,
            participation: 0.725_055_402_654_504_3,
            damping_ratio: 0.005,
        },
    ])
}

/// Arms of the paper's set.
pub fn paper_arms() -> RampBody {
    arms(vec![
        ArmMode {
            frequency_hz: 888.0,
            mass_kg: 57.9e-6,
            participation: 0.199,
            damping_ratio: 0.02,
        },
        ArmMode {
            frequency_hz: 17_500.0,
            mass_kg: 35.1e-6,
            participation: 0.789,
            damping_ratio: 0.02,
        },
    ])
}

/// Set S1: reference disk, ramp point at 32 mm, slider 20 degrees downstream at 21.25 mm.
pub fn s1(width_s: f64, model: impl Into<RampBody>) -> Structure {
    Structure {
        disk: reference_disk(),
        disk_resolution: DiskResolution {
            n_harmonics: 64,
            cut_hz: 40e3,
            n_elements: 24,
            static_correction: false,
        },
        ramp: RampParameters {
            model: model.into(),
            clearance_top_m: 100e-6,
            clearance_bottom_m: 100e-6,
            radius_m: 0.032,
            angle_rad: 0.0,
            restitution: 0.0,
            contact_stiffness_n_per_m: None,
            contact_frequency_hz: CONTACT_FREQUENCY_HZ,
            contact_damping_ratio: CONTACT_DAMPING_RATIO,
        },
        slider: SliderPlace {
            radius_m: 0.02125,
            angle_rad: rad_from_deg(20.0),
            skew_rad: 0.0,
        },
        oblique: None,
        base: Vec::new(),
        pulse: half_sine(width_s),
        window: Window::Fixed { length_s: 5e-3 },
        resolution: StructureResolution {
            step_s: 0.5e-6,
            contact: ContactMethod::ExactFlow,
        },
    }
}

/// The paper's set at the study's default resolution.
pub fn paper(width_s: f64, model: impl Into<RampBody>) -> Structure {
    let base = s1(width_s, model);
    Structure {
        disk: drive_disk(),
        disk_resolution: DiskResolution {
            cut_hz: 20e3,
            static_correction: true,
            ..base.disk_resolution
        },
        ramp: RampParameters {
            radius_m: 0.03215,
            ..base.ramp
        },
        slider: SliderPlace {
            radius_m: 0.022215,
            angle_rad: rad_from_deg(7.0),
            skew_rad: 0.0,
        },
        ..base
    }
}
