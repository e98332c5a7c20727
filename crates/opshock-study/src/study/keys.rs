//! Finds keys of the study file by path: those of the table ([`super::fields`]) and those a head may have of its own.

use std::sync::LazyLock;

use super::fields::{self, TABLE};
use super::key::{Choice, Key};

/// A head's name, behind which stand the keys that it may have of its own.
const NAME_OF_A_HEAD: &str = fields::HEADS_HEAD.path();
/// What a head may have of its own: these keys, and all below the last two.
const OF_A_HEAD: [&str; 10] = [
    fields::DISK_THICKNESS_MM.path(),
    fields::RAMP_CLEARANCE_UM.path(),
    fields::RAMP_CLEARANCE_TOP_UM.path(),
    fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
    fields::SLIDER_RADIUS_MM.path(),
    fields::SLIDER_ANGLE_DEG.path(),
    fields::SLIDER_SKEW_DEG.path(),
    fields::SLIDER_FACES.path(),
    "slider.surface.",
    "suspension.",
];

/// The table, with what a head may have of its own.
pub static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
    let is_own = |key: &&Key| {
        let all_below = |own: &str| own.ends_with('.') && key.path.starts_with(own);
        OF_A_HEAD
            .iter()
            .any(|own| key.path == *own || all_below(own))
    };
    let own: Vec<Key> = TABLE.iter().filter(is_own).map(Key::of_a_head).collect();
    let name = TABLE.iter().position(|key| key.path == NAME_OF_A_HEAD);
    let (before, after) = TABLE.split_at(name.map_or(TABLE.len(), |name| name + 1));
    [before, &own, after].concat()
});

/// Groups of keys of which only one alternative may be given.
pub static CHOICES: &[Choice] = &[
    Choice {
        what: "the disk's damping",
        alternatives: &[
            &[
                fields::DISK_DAMPING_RAYLEIGH_ALPHA_PER_S.path(),
                fields::DISK_DAMPING_RAYLEIGH_BETA_S.path(),
            ],
            &[fields::DISK_DAMPING_MODAL_RATIO.path()],
        ],
    },
    Choice {
        what: "the deformable ramp",
        alternatives: &[
            &[fields::RAMP_DEFORMABLE_MODES.path()],
            &[fields::RAMP_DEFORMABLE_GEOMETRY_MATERIAL.path()],
            &[
                fields::RAMP_DEFORMABLE_MESH_FILE.path(),
                fields::RAMP_DEFORMABLE_MESH_MATERIAL.path(),
            ],
            &[fields::RAMP_DEFORMABLE_COUPLED_MODES.path()],
        ],
    },
    Choice {
        what: "the suspension",
        alternatives: &[
            &[fields::SUSPENSION_MODES.path()],
            &[
                fields::SUSPENSION_IMPORTED_MASS.path(),
                fields::SUSPENSION_IMPORTED_STIFFNESS.path(),
                fields::SUSPENSION_IMPORTED_DIMPLE.path(),
            ],
        ],
    },
    Choice {
        what: "the base",
        alternatives: &[
            &[fields::BASE_MODES.path()],
            &[
                fields::BASE_IMPORTED_MASS.path(),
                fields::BASE_IMPORTED_STIFFNESS.path(),
                fields::BASE_IMPORTED_SPINDLE.path(),
                fields::BASE_IMPORTED_RAMP.path(),
                fields::BASE_IMPORTED_PIVOT.path(),
            ],
        ],
    },
    Choice {
        what: "the rows of the base's matrices",
        alternatives: &[
            &[fields::BASE_IMPORTED_FREEDOMS.path()],
            &[fields::BASE_IMPORTED_PLACES.path()],
        ],
    },
    Choice {
        what: "the rows of the matrices",
        alternatives: &[
            &[fields::SUSPENSION_IMPORTED_FREEDOMS.path()],
            &[fields::SUSPENSION_IMPORTED_PLACES.path()],
        ],
    },
    Choice {
        what: "the sampled pulse",
        alternatives: &[
            &[fields::PULSE_TABLE.path()],
            &[
                fields::PULSE_TABLE_TIME_MS.path(),
                fields::PULSE_TABLE_RELATIVE.path(),
            ],
        ],
    },
    Choice {
        what: "the filter of the sampled pulse",
        alternatives: &[
            &[fields::PULSE_TABLE_FILTER.path()],
            &[
                fields::PULSE_TABLE_CUTOFF_HZ.path(),
                fields::PULSE_TABLE_FILTER_ORDER.path(),
            ],
        ],
    },
    Choice {
        what: "the base of the surface",
        alternatives: &[
            &[fields::SLIDER_SURFACE_PRESET.path()],
            &[fields::SLIDER_SURFACE_FILE.path()],
        ],
    },
    Choice {
        what: "the viscosity",
        alternatives: &[
            &[fields::GAS_VISCOSITY_PA_S.path()],
            &[fields::GAS_TEMPERATURE_C.path()],
        ],
    },
    Choice {
        what: "the ambient pressure",
        alternatives: &[
            &[fields::GAS_PRESSURE_PA.path()],
            &[fields::GAS_ALTITUDE_M.path()],
        ],
    },
];

/// The key at a path; list positions (`modes[0]`) are ignored.
pub fn find(path: &str) -> Option<&'static Key> {
    let pattern = pattern(path);
    KEYS.iter().find(|key| key.path == pattern)
}

/// What an axis of a study is, by the name of its column in tables ([`Axis::column`](super::Axis::column)): the key at
/// that path, or those with that last name.
pub fn described(column: &str) -> String {
    let found: Vec<String> = of_column(column)
        .map(|key| format!("{}: {}", key.path, key.help))
        .collect();
    found.join(" Or ")
}

/// Whether a column has values of the drive or its shock: what is called failure and how it is computed are none.
pub fn is_of_the_drive(column: &str) -> bool {
    let is_other = |key: &Key| ["failure", "resolution", "solver"].contains(&key.section());
    !of_column(column).any(is_other)
}

fn of_column(column: &str) -> impl Iterator<Item = &'static Key> {
    let is_named =
        move |key: &&Key| key.path == column || (key.may_be_axis() && key.name() == column);
    KEYS.iter().filter(is_named)
}

/// Whether some key lies below a path.
pub fn is_table(pattern: &str) -> bool {
    KEYS.iter().any(|key| {
        key.path
            .strip_prefix(pattern)
            .is_some_and(|rest| rest.starts_with('.'))
    })
}

/// Names that may stand directly below a table, in table order; "" is the root.
pub fn names_below(pattern: &str) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = Vec::new();
    for key in KEYS.iter() {
        let rest = if pattern.is_empty() {
            Some(key.path)
        } else {
            key.path
                .strip_prefix(pattern)
                .and_then(|rest| rest.strip_prefix('.'))
        };
        let Some(rest) = rest else { continue };
        let name = rest.split(['.', '[']).next().unwrap_or(rest);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Names of the sections.
pub fn sections() -> Vec<&'static str> {
    names_below("")
        .into_iter()
        .filter(|name| is_table(name))
        .collect()
}

/// `ramp.deformable.modes[1].mass_mg` as the table writes it: `ramp.deformable.modes[].mass_mg`.
pub fn pattern(path: &str) -> String {
    let mut pattern = String::with_capacity(path.len());
    let mut inside = false;
    for letter in path.chars() {
        match letter {
            '[' => {
                inside = true;
                pattern.push('[');
            }
            ']' => {
                inside = false;
                pattern.push(']');
            }
            _ if inside => {}
            _ => pattern.push(letter),
        }
    }
    pattern
}
