//! The table of keys, the schema and the digest hold every key.

use super::study_reading::{SHORT, read};

/// Numbers with a unit whose valid range is a turn or a whole: no value in another unit stands out of a narrower one.
const SCALELESS: [&str; 5] = [
    "disk.run_out_deg",
    "disk.waves[].phase_deg",
    "ramp.angle_deg",
    "slider.angle_deg",
    "search.scan_gap_pct",
];

#[test]
fn the_table_of_keys_is_consistent() {
    use opshock_study::study::key::{Kind, Presence};
    use opshock_study::study::keys::{CHOICES, KEYS, find};
    use opshock_study::study::unit;

    // Ratios, shares, exponents and the like: everything else carries its unit.
    let plain = [
        "poisson",
        "modal_ratio",
        "damping_ratio",
        "contact_damping_ratio",
        "participation",
        "restitution",
        "rise_share",
        "decay_share",
        "approach_share",
        "head_tolerance",
        "coupling_tolerance",
        "table_relative",
        "table_columns",
        "base",
        "held",
        "in_plane_x",
        "in_plane_y",
        "share",
        "friction",
    ];
    for (position, key) in KEYS.iter().enumerate() {
        assert!(
            KEYS[..position].iter().all(|other| other.path != key.path),
            "{} twice",
            key.path
        );
        assert!(
            key.help.ends_with('.') && !key.help.is_empty(),
            "{}: {:?}",
            key.path,
            key.help
        );
        assert!(!key.example().is_empty(), "{} has no example", key.path);
        let number = matches!(
            key.kind,
            Kind::Number(_)
                | Kind::NumberOrWord(..)
                | Kind::Axis(_)
                | Kind::Numbers(_)
                | Kind::Pair(_)
                | Kind::Points
        );
        assert_eq!(
            number && unit::of_path(key.path).is_none(),
            number && plain.contains(&key.name()),
            "{}: {:?}",
            key.path,
            unit::of_path(key.path).map(|unit| unit.suffix)
        );
        // What has a unit can be given in another one.
        let path = key.path.trim_start_matches("heads[].");
        let has_scale = number && unit::of_path(key.path).is_some();
        assert!(
            !has_scale || key.usual.is_some() != SCALELESS.contains(&path),
            "{}: {:?}",
            key.path,
            key.usual
        );
        if let (Kind::Number(range), Some((low, high))) = (key.kind, key.usual) {
            assert!(
                low < high && (range.contains(low) || low == 0.0) && range.contains(high),
                "{}",
                key.path
            );
        }
        if let Presence::Together(_) = key.presence {
            assert!(CHOICES.iter().any(|choice| {
                choice
                    .alternatives
                    .iter()
                    .any(|paths| paths.contains(&key.path))
            }));
        }
    }
    for choice in CHOICES {
        for path in choice.alternatives.iter().flat_map(|paths| paths.iter()) {
            assert!(find(path).is_some(), "{path}");
        }
    }
    for unit in unit::UNITS.iter().filter(|unit| unit.in_use) {
        let used = KEYS
            .iter()
            .any(|key| unit::of_path(key.path).is_some_and(|found| found.suffix == unit.suffix));
        let promised = ["s", "us", "kg", "urad"].contains(&unit.suffix);
        assert!(used || promised, "no key uses _{}", unit.suffix);
    }
}

/// A value of the key that differs from its default and fits a study built around it.
fn other_value(key: &opshock_study::study::key::Key) -> Option<String> {
    use opshock_study::study::key::Kind;
    let words = |words: &[&str]| {
        words
            .iter()
            .map(|word| format!("{word:?}"))
            .collect::<Vec<_>>()
    };
    Some(match key.path {
        "study_format" => return None,
        "name" => "\"another\"".to_string(),
        "outputs" => "[\"disk_displacement\"]".to_string(),
        "ramp.models" => "[\"none\", \"rigid\"]".to_string(),
        "ramp.radius_mm" => "32.0".to_string(),
        "pulse.shape" => "\"square\"".to_string(),
        "slider.surface.file" | "slider.surface.preset" | "slider.surface.rail" => {
            return None;
        }
        // They make a sampled pulse together.
        path if path.starts_with("pulse.table") => return None,
        "ramp.deformable.modes" | "ramp.deformable.bottom_modes" => {
            "[{ frequency_hz = 900.0, mass_mg = 50.0, participation = 0.2 }]".to_string()
        }
        "solver.leave_out" => return None,
        "resolution.not_refined" => "[\"disk_modes\"]".to_string(),
        // Ways to read files; what they hold takes their place.
        path if path.starts_with("ramp.deformable.mesh.")
            || path.starts_with("suspension.imported.")
            || path.starts_with("base.imported.") =>
        {
            return None;
        }
        _ => match key.kind {
            Kind::Flag => "false".to_string(),
            Kind::Integer(low, _) => (low + 17).to_string(),
            Kind::Word(all) => words(all).pop()?,
            Kind::Words(_) => "[\"-\"]".to_string(),
            Kind::Axis(_) => "[2.5]".to_string(),
            Kind::Number(_) | Kind::NumberOrWord(..) => match key.example().parse::<f64>().ok()? {
                0.0 => "0.001".to_string(),
                value => format!("{:?}", value * 0.99),
            },
            _ => return None,
        },
    })
}

/// A hub that is given.
const HUB: [&str; 3] = [
    "hub.axial_stiffness_n_per_m=5.0e6",
    "hub.tilt_stiffness_n_m_per_rad=200.0",
    "hub.transverse_inertia_mg_mm2=3.5e5",
];

/// Limiters and lift tab that are given.
const STOPS: [&str; 2] = [
    "suspension.limiters.gap_um=92.0",
    "suspension.lift_tab.gap_um=140.0",
];

/// Damage of rough surfaces by a limit.
const DAMAGE: [&str; 3] = [
    "asperity_contact.roughness_nm=0.4",
    "failure.damage.overlap_nm=2.0",
    "failure.criterion=\"damage\"",
];

#[test]
fn every_value_changes_the_digest_and_is_written_out() {
    use opshock_study::study::keys::KEYS;
    let base = read(SHORT, &[]).unwrap();
    let mut tried = 0;
    for key in KEYS.iter().filter(|key| !key.path.contains("[]")) {
        let Some(value) = other_value(key) else {
            continue;
        };
        let set = format!("{}={value}", key.path);
        // A hub has both stiffnesses, an oblique shock a hub, a stop its gap, a contact's spring a stiffness.
        let around: &[&str] = match key.path {
            path if path.starts_with("hub.") || key.code == "E138" => &HUB,
            path if path.starts_with("suspension.li") => &STOPS,
            "ramp.contact_frequency_khz" | "ramp.contact_damping_ratio" => {
                &["ramp.contact_stiffness_n_per_m=1.0e6"]
            }
            path if path.starts_with("asperity_contact.") => &["asperity_contact.roughness_nm=0.4"],
            "failure.criterion" => &DAMAGE[..2],
            path if path.starts_with("failure.damage.") => &DAMAGE,
            // A repulsion ends an attraction.
            "surface_forces.repulsion_j_m6" => &["surface_forces.hamaker_j=1.0e-19"],
            _ => &[],
        };
        let without = |set: &&&str| !set.starts_with(&format!("{}=", key.path));
        let mut sets: Vec<&str> = around.iter().filter(without).copied().collect();
        sets.push(&set);
        let study = read(SHORT, &sets).unwrap_or_else(|errors| panic!("{set}: {errors}"));
        let unset = read(SHORT, around).unwrap();
        assert_ne!(study.digest, unset.digest, "{set}");
        assert_ne!(study.digest, base.digest, "{set}");
        assert!(study.resolved_toml().contains(key.name()), "{set}");
        let again =
            read(&study.resolved_toml(), &[]).unwrap_or_else(|errors| panic!("{set}: {errors}"));
        assert_eq!(again.digest, study.digest, "{set}");
        tried += 1;
    }
    assert!(tried > 80, "{tried}");
    for rail in ["x_um=[20, 169]", "y_um=[30, 671]", "recess_um=0.26"] {
        let set = format!("slider.surface.rail[0].{rail}");
        assert_ne!(read(SHORT, &[&set]).unwrap().digest, base.digest, "{set}");
    }
}

#[test]
fn the_schema_knows_every_key_and_no_other() {
    use opshock_study::study::keys::KEYS;
    let schema = opshock_study::study::schema::json_schema();
    let mut paths = Vec::new();
    collect(&schema, "", &mut paths);
    let mut expected: Vec<String> = KEYS.iter().map(|key| key.path.to_string()).collect();
    expected.sort();
    paths.sort();
    assert_eq!(paths, expected);
    assert_eq!(
        schema["required"],
        serde_json::json!(["study_format", "name", "pulse", "ramp"])
    );
    assert_eq!(
        schema["properties"]["pulse"]["required"],
        serde_json::json!(["widths_ms"])
    );
    assert!(
        opshock_study::study::schema::units()
            .iter()
            .any(|unit| unit.starts_with("_um: "))
    );
}

/// Paths of everything in a schema that is described, in the form of the table of keys.
fn collect(schema: &serde_json::Value, path: &str, paths: &mut Vec<String>) {
    let Some(properties) = schema["properties"].as_object() else {
        return;
    };
    for (name, child) in properties {
        let path = if path.is_empty() {
            name.clone()
        } else {
            format!("{path}.{name}")
        };
        if child.get("description").is_some() {
            paths.push(path.clone());
        }
        if child.get("items").is_some() {
            collect(&child["items"], &format!("{path}[]"), paths);
        } else if child["type"] == "object" {
            collect(child, &path, paths);
        }
    }
}
