//! Reduces a deformable ramp given by its geometry to oscillators: finite elements, then their modes.
//!
//! The oscillators are rounded to nine digits: a study must be the same study where a C library or processor gives
//! other last digits.

use opshock_solid::material::{MATERIALS, Material};
use opshock_solid::ramp::{
    Extent, Mount, RampGeometry, RampMesh, RampModes, SolidRamp, SolidRampError,
};
use opshock_solver::ramp::CoupledMode;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::field::{Field, Text};
use super::fields;
use super::keys::KEYS;
use super::settings::View;

/// Table of the geometry.
pub const TABLE: &str = "ramp.deformable.geometry";
/// Default of `mesh_size_mm`, m.
pub const MESH_SIZE_M: f64 = 1e-3;
/// Default of `cut_khz`, Hz.
pub const CUT_HZ: f64 = 100e3;

/// A ramp's length in a study: its key and its field.
pub type Length = (Field<Option<f64>>, fn(&mut RampGeometry) -> &mut f64);

/// Every length a study may set.
pub const LENGTHS: &[Length] = &[
    (fields::RAMP_DEFORMABLE_GEOMETRY_FINGER_LENGTH_MM, |g| {
        &mut g.finger_length_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_FINGER_WIDTH_MM, |g| {
        &mut g.finger_width_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_TIP_THICKNESS_MM, |g| {
        &mut g.tip_thickness_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_ROOT_THICKNESS_MM, |g| {
        &mut g.root_thickness_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_SLOPE_LENGTH_MM, |g| {
        &mut g.slope_length_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_BODY_LENGTH_MM, |g| {
        &mut g.body_length_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_BODY_WIDTH_MM, |g| {
        &mut g.body_width_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_BODY_DEPTH_MM, |g| {
        &mut g.body_depth_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_NECK_LENGTH_MM, |g| {
        &mut g.neck_length_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_PAD_LENGTH_MM, |g| {
        &mut g.pad_length_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_MOUNT_THICKNESS_MM, |g| {
        &mut g.mount_thickness_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_CONTACT_MM, |g| {
        &mut g.contact_m
    }),
    (fields::RAMP_DEFORMABLE_GEOMETRY_CONTACT_LENGTH_MM, |g| {
        &mut g.contact_length_m
    }),
];

/// Path of a key of the table.
pub fn path(name: &str) -> String {
    format!("{TABLE}.{name}")
}

/// Every key of the table.
pub fn paths() -> impl Iterator<Item = &'static str> {
    let below = |path: &&str| path.strip_prefix(TABLE).is_some_and(|r| r.starts_with('.'));
    KEYS.iter().map(|key| key.path).filter(below)
}

/// Whether the study gives the ramp by its geometry: whether it names a material.
pub fn is_given(view: &View<'_>) -> bool {
    view.settings.has(OF_GEOMETRY.material.path())
}

/// The ramp of a view.
pub fn solid_ramp(view: &View<'_>) -> SolidRamp {
    let mut geometry = RampGeometry::mobile_drive();
    for (key, field) in LENGTHS {
        if let Some(length_m) = view.get(key) {
            *field(&mut geometry) = length_m;
        }
    }
    // The rim stands midway between the contacts.
    let half_disk_m = 0.5 * view.get(&fields::DISK_THICKNESS_MM);
    let clearance_m = |side: &Field<Option<f64>>| {
        let own_m = view.get(side);
        own_m.unwrap_or_else(|| view.get(&fields::RAMP_CLEARANCE_UM))
    };
    geometry.slot_above_m = half_disk_m + clearance_m(&fields::RAMP_CLEARANCE_TOP_UM);
    geometry.slot_below_m = half_disk_m + clearance_m(&fields::RAMP_CLEARANCE_BOTTOM_UM);
    SolidRamp {
        geometry,
        material: OF_GEOMETRY.material(view),
        mount: OF_GEOMETRY.mount(view),
        mesh_size_m: view
            .get(&fields::RAMP_DEFORMABLE_GEOMETRY_MESH_SIZE_MM)
            .unwrap_or(MESH_SIZE_M),
        cut_hz: OF_GEOMETRY.cut_hz(view),
    }
}

/// Keys of the solid ramp of a table.
pub struct SolidFields {
    /// Name of the material.
    pub material: Field<Text>,
    /// What replaces its Young's modulus, Poisson's ratio, density.
    pub replaced: [Field<Option<f64>>; 3],
    /// Stiffness of the mount: normal, tangential.
    pub mount: [Field<Option<f64>>; 2],
    /// Modes are kept below this frequency.
    pub cut: Field<Option<f64>>,
}

/// Those of a geometry.
pub const OF_GEOMETRY: SolidFields = SolidFields {
    material: fields::RAMP_DEFORMABLE_GEOMETRY_MATERIAL,
    replaced: [
        fields::RAMP_DEFORMABLE_GEOMETRY_YOUNGS_MODULUS_GPA,
        fields::RAMP_DEFORMABLE_GEOMETRY_POISSON,
        fields::RAMP_DEFORMABLE_GEOMETRY_DENSITY_KG_PER_M3,
    ],
    mount: [
        fields::RAMP_DEFORMABLE_GEOMETRY_MOUNT_NORMAL_N_PER_M,
        fields::RAMP_DEFORMABLE_GEOMETRY_MOUNT_TANGENTIAL_N_PER_M,
    ],
    cut: fields::RAMP_DEFORMABLE_GEOMETRY_CUT_KHZ,
};

impl SolidFields {
    /// The material named, with what replaces values of it.
    pub fn material(&self, view: &View<'_>) -> Material {
        // The table of keys allows known names only.
        let known = Material::by_name(view.get(&self.material)).unwrap_or(MATERIALS[0].material);
        let [youngs_modulus_pa, poisson, density_kg_per_m3] =
            self.replaced.each_ref().map(|field| view.get(field));
        Material {
            youngs_modulus_pa: youngs_modulus_pa.unwrap_or(known.youngs_modulus_pa),
            poisson: poisson.unwrap_or(known.poisson),
            density_kg_per_m3: density_kg_per_m3.unwrap_or(known.density_kg_per_m3),
        }
    }

    /// How the ramp stands on the base.
    pub fn mount(&self, view: &View<'_>) -> Mount {
        let [normal, tangential] = self.mount.each_ref().map(|field| view.get(field));
        match normal {
            None => Mount::Bolted,
            Some(normal_n_per_m) => Mount::Elastic {
                normal_n_per_m,
                tangential_n_per_m: tangential.unwrap_or(normal_n_per_m),
            },
        }
    }

    /// Frequency below which its modes are kept, Hz.
    pub fn cut_hz(&self, view: &View<'_>) -> f64 {
        view.get(&self.cut).unwrap_or(CUT_HZ)
    }
}

/// A meshed ramp on its base.
#[derive(Clone, Debug)]
pub struct RampSolid {
    /// Finite elements.
    pub mesh: RampMesh,
    /// Material.
    pub material: Material,
    /// Mount.
    pub mount: Mount,
    /// Modes are kept below this frequency, Hz.
    pub cut_hz: f64,
}

/// What a ramp was reduced to.
type Answer = Result<Arc<RampModes>, SolidRampError>;

/// The ramp's oscillators; each ramp is meshed once per process.
///
/// # Errors
/// See [`SolidRampError`].
pub fn modes(ramp: &SolidRamp) -> Answer {
    static KNOWN: OnceLock<Mutex<HashMap<String, Answer>>> = OnceLock::new();
    let known = KNOWN.get_or_init(Mutex::default);
    // Debug prints every field with all its digits.
    let key = format!("{ramp:?}");
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    known
        .entry(key)
        .or_insert_with(|| ramp.modes().map(Arc::new))
        .clone()
}

/// Whether the ramp can be meshed with elements of its size; each size is tried once per process.
pub fn has_mesh(ramp: &SolidRamp) -> bool {
    static KNOWN: OnceLock<Mutex<HashMap<String, bool>>> = OnceLock::new();
    let known = KNOWN.get_or_init(Mutex::default);
    let key = format!("{:?} {:?}", ramp.geometry, ramp.mesh_size_m);
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    *known
        .entry(key)
        .or_insert_with(|| ramp.geometry.mesh(ramp.mesh_size_m, Extent::Half).is_ok())
}

/// The oscillators of a view as the solver takes them; none for a ramp that the checks refuse.
pub fn coupled_modes(view: &View<'_>) -> Vec<CoupledMode> {
    let damping_ratio = view.get(&fields::RAMP_DEFORMABLE_DAMPING_RATIO);
    oscillators(&solid_ramp(view), damping_ratio)
}

/// The oscillators of a ramp as the solver takes them; none for one without.
pub fn oscillators(ramp: &SolidRamp, damping_ratio: f64) -> Vec<CoupledMode> {
    let Ok(answer) = modes(ramp) else {
        return Vec::new();
    };
    let modes = answer.modes.iter();
    modes
        .map(|mode| CoupledMode {
            frequency_hz: rounded(mode.frequency_hz),
            shape_per_sqrt_kg: [mode.shape[0], mode.shape[1]].map(rounded),
            participation_sqrt_kg: rounded(mode.participation),
            damping_ratio,
        })
        .collect()
}

/// Nine digits.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Study;
    use crate::study::key::Presence;

    fn study(lines: &str) -> Study {
        let text = format!(
            "study_format = 2\nname = \"a\"\noutputs = [\"contact_force\"]\n\
             [pulse]\nwidths_ms = [1.0]\nsigns = [\"+\"]\n\
             [ramp]\nmodels = [\"deformable\"]\n{lines}"
        );
        Study::from_text(&text, &[]).unwrap()
    }

    fn lowest_hz(study: &Study, point: usize) -> f64 {
        study.points[point].scene.ramp.model.modes()[0].frequency_hz
    }

    #[test]
    fn what_the_table_of_keys_says_is_the_default_is_it() {
        let default = RampGeometry::mobile_drive();
        for (length, field) in LENGTHS {
            let name = length.path();
            let Presence::Optional(absent) = length.key.presence else {
                panic!("{name}")
            };
            let value: f64 = absent.parse().unwrap();
            let mut geometry = default;
            assert!(
                (1e-3 * value / *field(&mut geometry) - 1.0).abs() < 1e-12,
                "{name}"
            );
        }
        for (field, expected) in [
            (
                fields::RAMP_DEFORMABLE_GEOMETRY_MESH_SIZE_MM,
                1e3 * MESH_SIZE_M,
            ),
            (fields::RAMP_DEFORMABLE_GEOMETRY_CUT_KHZ, 1e-3 * CUT_HZ),
        ] {
            let Presence::Optional(absent) = field.key.presence else {
                panic!("{}", field.path())
            };
            assert_eq!(absent.parse(), Ok(expected), "{}", field.path());
        }
        let names: Vec<&str> = MATERIALS.iter().map(|known| known.name).collect();
        assert_eq!(names, crate::study::words::RAMP_MATERIALS);
    }

    /// Frequencies of one shape go with the square root of modulus over density.
    #[test]
    fn a_stiffer_material_raises_every_frequency_by_the_root_of_its_modulus() {
        let ramp = study(
            "[ramp.deformable.geometry]\nmesh_size_mm = 3.0\nmaterial = \"PEEK\"\n\
             youngs_modulus_gpa = [4.0, 16.0]\n",
        );
        assert_eq!(ramp.points.len(), 2);
        let ratio = lowest_hz(&ramp, 1) / lowest_hz(&ramp, 0);
        assert!((ratio - 2.0).abs() < 1e-7, "{ratio}");
    }

    #[test]
    fn the_slot_follows_the_clearances() {
        let ramp = study(
            "clearance_um = 60.0\nclearance_top_um = 150.0\n[ramp.deformable.geometry]\nmaterial = \"POM\"\nmesh_size_mm = 3.0\n",
        );
        let view = View::first(&ramp.settings);
        let solid = solid_ramp(&view).geometry;
        assert!((solid.slot_above_m - (0.3175e-3 + 150e-6)).abs() < 1e-15);
        assert!((solid.slot_below_m - (0.3175e-3 + 60e-6)).abs() < 1e-15);
    }
}
