//! Identities by content: equal inputs have equal names, on every machine and in every study.
//!
//! A cell is one search: a scene and the sign of its amplitude. Its [`CellId`] and the keys of the
//! two stages are digests of the scene's SI numbers, bit by bit, in a fixed order. The functions
//! below take every structure apart by name, so that a new field of a scene does not compile until
//! it has a place in its digest.

use opshock_solver::air_bearing::{FilmResolution, FlowModel, SurfaceForces};
use opshock_solver::disk::{DiskDamping, DiskParameters, DiskResolution, HubParameters, Wave};
use opshock_solver::gas::GasParameters;
use opshock_solver::ramp::{
    CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, ContactMode, RampBody, RampParameters, Relaxation,
};
use opshock_solver::scene::{Coupling, HeadResolution, Scene, Window};
use opshock_solver::shock::{BaseMode, ObliqueShock, Pulse, PulseShape};
use opshock_solver::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};
use opshock_solver::structure::{ContactMethod, StructureResolution};
use opshock_solver::suspension::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, LiftTab, Limiter, LoadBeam, SuspensionMode,
    SuspensionParameters,
};

/// Identity of one cell: a scene and the sign of its amplitude.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CellId(pub [u8; 16]);

impl CellId {
    /// Identity of a scene shaken with one sign of the amplitude, for a head that faces down or up.
    pub fn new(scene: &Scene, positive: bool, up: bool) -> Self {
        let mut digest = Digester::new("opshock cell 1");
        digest.structure(scene);
        digest.head(scene);
        digest.flag(positive);
        if up {
            digest.text("faces up");
        }
        Self(digest.short())
    }

    /// Reads the 32 hexadecimal digits written by [`Display`](std::fmt::Display).
    pub fn from_hex(text: &str) -> Option<Self> {
        let mut bytes = [0; 16];
        if text.len() != 32 || !text.is_ascii() {
            return None;
        }
        for (byte, digits) in bytes.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
        }
        Some(Self(bytes))
    }
}

impl std::fmt::Display for CellId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl std::fmt::Debug for CellId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "CellId({self})")
    }
}

/// Key of the structural stage: everything disk, ramp and their motion at the slider depend on,
/// and nothing else. `physics_version` is the stage's own.
pub fn structure_key(scene: &Scene, physics_version: u32) -> [u8; 16] {
    let mut digest = Digester::new("opshock structure 1");
    digest.integer(u64::from(physics_version));
    digest.structure(scene);
    digest.short()
}

/// Key of the head stage: the structural stage and everything the head depends on.
pub fn head_key(scene: &Scene, structure_version: u32, head_version: u32) -> [u8; 16] {
    let mut digest = Digester::new("opshock head 1");
    digest.integer(u64::from(structure_version));
    digest.integer(u64::from(head_version));
    digest.structure(scene);
    digest.head(scene);
    digest.short()
}

/// Hashes numbers by their bits, in order.
struct Digester(blake3::Hasher);

impl Digester {
    fn new(domain: &str) -> Self {
        let mut digest = Self(blake3::Hasher::new());
        digest.text(domain);
        digest
    }

    fn short(&self) -> [u8; 16] {
        let mut bytes = [0; 16];
        bytes.copy_from_slice(&self.0.finalize().as_bytes()[..16]);
        bytes
    }

    fn text(&mut self, text: &str) {
        self.integer(text.len() as u64);
        self.0.update(text.as_bytes());
    }

    fn integer(&mut self, value: u64) {
        self.0.update(&value.to_le_bytes());
    }

    fn flag(&mut self, flag: bool) {
        self.integer(u64::from(flag));
    }

    /// Minus zero counts as zero: they are the same input.
    fn numbers(&mut self, values: &[f64]) {
        for value in values {
            self.integer((value + 0.0).to_bits());
        }
    }

    fn list(&mut self, values: &[f64]) {
        self.integer(values.len() as u64);
        self.numbers(values);
    }

    fn structure(&mut self, scene: &Scene) {
        let Scene {
            pulse,
            oblique,
            base,
            window,
            disk,
            run_out: _,
            ramp,
            slider,
            disk_resolution,
            structure_resolution,
            suspension: _,
            gas: _,
            flow: _,
            surface_forces: _,
            fail_below_m: _,
            film_resolution: _,
            head_resolution: _,
            not_refined: _,
        } = scene;
        self.pulse(pulse);
        if let Some(ObliqueShock {
            in_plane,
            rotation_per_m,
        }) = oblique
        {
            self.text("oblique");
            self.numbers(in_plane);
            self.numbers(rotation_per_m);
        }
        if !base.is_empty() {
            // Contact moves the base: answers of before that are others.
            self.text("base 2");
            self.integer(base.len() as u64);
        }
        for BaseMode {
            frequency_hz,
            damping_ratio,
            participation_sqrt_kg,
            spindle_per_sqrt_kg,
            ramp_per_sqrt_kg,
            pivot_per_sqrt_kg,
        } in base
        {
            self.numbers(&[
                *frequency_hz,
                *damping_ratio,
                *participation_sqrt_kg,
                *spindle_per_sqrt_kg,
                *ramp_per_sqrt_kg,
                *pivot_per_sqrt_kg,
            ]);
        }
        match window {
            Window::Fixed { length_s } => {
                self.text("fixed");
                self.numbers(&[*length_s]);
            }
            Window::UntilDecayed { share, max_s } => {
                self.text("until_decayed");
                self.numbers(&[*share, *max_s]);
            }
        }
        self.disk(disk);
        self.ramp(ramp);
        // The head meets the disk at the slider's centre, in the slider's axes.
        self.numbers(&[slider.radius_m, slider.angle_rad, slider.skew_rad]);
        let DiskResolution {
            n_harmonics,
            cut_hz,
            n_elements,
            static_correction,
        } = disk_resolution;
        self.integer(*n_harmonics as u64);
        self.numbers(&[*cut_hz]);
        self.integer(*n_elements as u64);
        self.flag(*static_correction);
        let StructureResolution { step_s, contact } = structure_resolution;
        self.numbers(&[*step_s]);
        match contact {
            // Nothing: what was stored before there was a choice keeps its name.
            ContactMethod::ExactFlow => {}
            ContactMethod::MoreauJean => self.text("moreau_jean"),
        }
    }

    fn head(&mut self, scene: &Scene) {
        let Scene {
            slider,
            suspension,
            gas,
            flow,
            surface_forces,
            fail_below_m,
            film_resolution,
            head_resolution,
            oblique: _,
            base: _,
            pulse: _,
            window: _,
            disk,
            run_out,
            ramp: _,
            disk_resolution: _,
            structure_resolution: _,
            not_refined: _,
        } = scene;
        self.slider(slider);
        self.suspension(suspension);
        let GasParameters {
            pressure_pa,
            viscosity_pa_s,
            mean_free_path_m,
        } = gas;
        self.numbers(&[*pressure_pa, *viscosity_pa_s, *mean_free_path_m]);
        self.text(match flow {
            FlowModel::Continuum => "continuum",
            FlowModel::Slip1 => "slip_1",
            FlowModel::Slip2 => "slip_2",
            FlowModel::FukuiKaneko => "fukui_kaneko",
        });
        self.numbers(&[*fail_below_m]);
        let FilmResolution {
            cells,
            floor_m,
            reference_cells,
        } = film_resolution;
        self.integer(*cells as u64);
        self.integer(*reference_cells as u64);
        self.numbers(&[*floor_m]);
        let HeadResolution {
            tolerance,
            approach_share,
            suspension_modes,
            coupling,
            coupling_tolerance,
            max_steps,
        } = head_resolution;
        self.numbers(&[*tolerance, *approach_share, *coupling_tolerance]);
        self.integer(*suspension_modes as u64);
        self.text(match coupling {
            Coupling::Monolithic => "monolithic",
            Coupling::FixedPoint => "fixed_point",
            Coupling::Aitken => "aitken",
            Coupling::Anderson => "anderson",
        });
        self.integer(*max_steps);
        // Nothing without them: what was stored before there were any keeps its name.
        for wave in run_out {
            let Wave {
                harmonic,
                amplitude_m,
                phase_rad,
                grows_with_radius,
            } = wave;
            self.text(match grows_with_radius {
                true => "run_out",
                false => "wave",
            });
            self.integer(u64::from(*harmonic));
            self.numbers(&[*amplitude_m, *phase_rad, disk.outer_radius_m]);
        }
        if let Some(SurfaceForces {
            hamaker_j,
            repulsion_j_m6,
            potential_v,
        }) = surface_forces
        {
            self.text("surface_forces");
            self.numbers(&[*hamaker_j, *repulsion_j_m6, *potential_v]);
        }
    }

    fn pulse(&mut self, pulse: &Pulse) {
        let Pulse { shape, width_s } = pulse;
        self.numbers(&[*width_s]);
        match shape {
            PulseShape::HalfSine => self.text("half_sine"),
            PulseShape::Haversine => self.text("haversine"),
            PulseShape::Square => self.text("square"),
            PulseShape::Trapezoid { rise_share } => {
                self.text("trapezoid");
                self.numbers(&[*rise_share]);
            }
            PulseShape::DampedSine {
                frequency_hz,
                decay_per_s,
            } => {
                self.text("damped_sine");
                self.numbers(&[*frequency_hz, *decay_per_s]);
            }
            PulseShape::Table { time_s, relative } => {
                self.text("table");
                self.list(time_s);
                self.list(relative);
            }
        }
    }

    fn disk(&mut self, disk: &DiskParameters) {
        let DiskParameters {
            inner_radius_m,
            outer_radius_m,
            thickness_m,
            youngs_modulus_pa,
            poisson,
            density_kg_per_m3,
            spin_rad_per_s,
            damping,
            space_fixed_damping_per_s,
            hub,
        } = disk;
        self.numbers(&[
            *inner_radius_m,
            *outer_radius_m,
            *thickness_m,
            *youngs_modulus_pa,
            *poisson,
            *density_kg_per_m3,
            *spin_rad_per_s,
            *space_fixed_damping_per_s,
        ]);
        match damping {
            DiskDamping::Rayleigh {
                alpha_per_s,
                beta_s,
            } => {
                self.text("rayleigh");
                self.numbers(&[*alpha_per_s, *beta_s]);
            }
            DiskDamping::ModalRatio(ratio) => {
                self.text("modal_ratio");
                self.numbers(&[*ratio]);
            }
        }
        if let Some(hub) = hub {
            self.hub(hub);
        }
    }

    fn hub(&mut self, hub: &HubParameters) {
        let HubParameters {
            mass_kg,
            transverse_inertia_kg_m2,
            polar_inertia_kg_m2,
            axial_stiffness_n_per_m,
            axial_damping_n_s_per_m,
            tilt_stiffness_n_m_per_rad,
            tilt_damping_n_m_s_per_rad,
            cross_stiffness_n_m_per_rad,
            cross_damping_n_m_s_per_rad,
            centre_height_m,
        } = hub;
        self.text("hub");
        self.numbers(&[
            *mass_kg,
            *transverse_inertia_kg_m2,
            *polar_inertia_kg_m2,
            *axial_stiffness_n_per_m,
            *axial_damping_n_s_per_m,
            *tilt_stiffness_n_m_per_rad,
            *tilt_damping_n_m_s_per_rad,
            *cross_stiffness_n_m_per_rad,
            *cross_damping_n_m_s_per_rad,
            *centre_height_m,
        ]);
    }

    fn ramp(&mut self, ramp: &RampParameters) {
        let RampParameters {
            model,
            clearance_top_m,
            clearance_bottom_m,
            radius_m,
            angle_rad,
            restitution,
            contact_stiffness_n_per_m,
            contact_frequency_hz,
            contact_damping_ratio,
        } = ramp;
        self.numbers(&[
            *clearance_top_m,
            *clearance_bottom_m,
            *radius_m,
            *angle_rad,
            *restitution,
        ]);
        // What a scene does not say keeps the identity that it had before it was a parameter.
        if let Some(stiffness) = contact_stiffness_n_per_m {
            self.text("contact stiffness");
            self.numbers(&[*stiffness]);
            let spring = [*contact_frequency_hz, *contact_damping_ratio];
            if spring != [CONTACT_FREQUENCY_HZ, CONTACT_DAMPING_RATIO] {
                self.text("contact spring");
                self.numbers(&spring);
            }
        }
        let RampBody {
            model,
            contacts,
            relaxation,
        } = model;
        self.text(model);
        let modes = contacts.as_deref().unwrap_or_default();
        // Arms list their modes each, as in a study file.
        let lists: &[&[ContactMode]] = match (*model, modes.iter().position(|m| m.shape[0] == 0.0))
        {
            (_, _) if modes.is_empty() => &[],
            ("deformable", Some(of_bottom)) => &[&modes[..of_bottom], &modes[of_bottom..]],
            _ => &[modes],
        };
        for list in lists {
            self.integer(list.len() as u64);
            for ContactMode {
                frequency_hz,
                mass_kg,
                shape,
                participation,
                damping_ratio,
            } in *list
            {
                let scale: &[f64] = match *model {
                    "deformable" => &[*mass_kg],
                    "coupled" => shape,
                    _ => &[*mass_kg, shape[0], shape[1]],
                };
                self.numbers(&[*frequency_hz]);
                self.numbers(scale);
                self.numbers(&[*participation, *damping_ratio]);
            }
        }
        if !relaxation.is_empty() {
            self.text("relaxation");
            self.integer(relaxation.len() as u64);
            for Relaxation { share, time_s } in relaxation {
                self.numbers(&[*share, *time_s]);
            }
        }
    }

    fn slider(&mut self, slider: &SliderParameters) {
        let SliderParameters {
            radius_m,
            angle_rad,
            skew_rad,
            length_m,
            width_m,
            height_m,
            density_kg_per_m3,
            surface,
        } = slider;
        self.numbers(&[
            *radius_m,
            *angle_rad,
            *skew_rad,
            *length_m,
            *width_m,
            *height_m,
            *density_kg_per_m3,
        ]);
        let SurfaceParameters {
            base_recess_m,
            crown_m,
            camber_m,
            twist_m,
            taper_length_m,
            taper_angle_rad,
            rails,
        } = surface;
        self.numbers(&[
            *base_recess_m,
            *crown_m,
            *camber_m,
            *twist_m,
            *taper_length_m,
            *taper_angle_rad,
        ]);
        self.integer(rails.len() as u64);
        for Rail { outline, recess_m } in rails {
            self.numbers(&[*recess_m]);
            match outline {
                RailOutline::Rectangle { x_m, y_m } => {
                    self.text("rect");
                    self.numbers(x_m);
                    self.numbers(y_m);
                }
                RailOutline::Polygon { points_m } => {
                    self.text("polygon");
                    self.list(points_m.as_flattened());
                }
            }
        }
    }

    fn contact(&mut self, contact: &ContactLaw) {
        let ContactLaw {
            stiffness_n_per_m,
            damping_ratio,
        } = contact;
        self.numbers(&[*stiffness_n_per_m, *damping_ratio]);
    }

    fn suspension(&mut self, suspension: &SuspensionParameters) {
        let SuspensionParameters {
            gram_load_n,
            hinge:
                Hinge {
                    length_m,
                    width_m,
                    thickness_m,
                },
            load_beam:
                LoadBeam {
                    dimple_m,
                    end_m,
                    web_m,
                    width_root_m,
                    width_dimple_m,
                    tab_width_m,
                },
            flange:
                Flange {
                    height_m,
                    from_m,
                    to_m,
                },
            flexure:
                Flexure {
                    mass_kg,
                    from_m: flexure_from_m,
                },
            youngs_modulus_pa,
            shear_modulus_pa,
            density_kg_per_m3,
            damping_ratio,
            gimbal:
                Gimbal {
                    vertical_n_per_m,
                    pitch_n_m_per_rad,
                    roll_n_m_per_rad,
                },
            dimple:
                ContactLaw {
                    stiffness_n_per_m,
                    damping_ratio: dimple_damping_ratio,
                },
            limiters,
            lift_tab,
            modes,
        } = suspension;
        // Points of suspensions without a stop, and by their geometry, keep the names that they had.
        if !limiters.is_empty() {
            self.text("limiters");
            self.integer(limiters.len() as u64);
        }
        for Limiter {
            gap_m,
            along_m,
            across_m,
            contact,
        } in limiters
        {
            self.numbers(&[*gap_m, *along_m, *across_m]);
            self.contact(contact);
        }
        if let Some(LiftTab { gap_m, contact }) = lift_tab {
            self.text("lift tab");
            self.numbers(&[*gap_m]);
            self.contact(contact);
        }
        if !modes.is_empty() {
            self.text("suspension modes");
            self.integer(modes.len() as u64);
        }
        for SuspensionMode {
            frequency_hz,
            vertical_per_sqrt_kg,
            slope_per_m_sqrt_kg,
            roll_per_m_sqrt_kg,
            participation_sqrt_kg,
        } in modes
        {
            self.numbers(&[
                *frequency_hz,
                *vertical_per_sqrt_kg,
                *slope_per_m_sqrt_kg,
                *roll_per_m_sqrt_kg,
                *participation_sqrt_kg,
            ]);
        }
        self.numbers(&[
            *gram_load_n,
            *length_m,
            *width_m,
            *thickness_m,
            *dimple_m,
            *end_m,
            *web_m,
            *width_root_m,
            *width_dimple_m,
            *tab_width_m,
            *height_m,
            *from_m,
            *to_m,
            *mass_kg,
            *flexure_from_m,
            *youngs_modulus_pa,
            *shear_modulus_pa,
            *density_kg_per_m3,
            *damping_ratio,
            *vertical_n_per_m,
            *pitch_n_m_per_rad,
            *roll_n_m_per_rad,
            *stiffness_n_per_m,
            *dimple_damping_ratio,
        ]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_identity_survives_its_text() {
        let id = CellId(std::array::from_fn(|i| 17 * i as u8));
        assert_eq!(id.to_string(), "00112233445566778899aabbccddeeff");
        assert_eq!(CellId::from_hex(&id.to_string()), Some(id));
        assert_eq!(CellId::from_hex("12"), None);
    }
}
