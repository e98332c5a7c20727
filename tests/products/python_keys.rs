//! The typed settings of the Python package are those of today's study files.

use opshock_study::study::schema::json_schema;
use serde_json::Value;
use std::path::Path;

/// Attributes of a table and of the tables in it: name and sentence.
fn attributes(schema: &Value, found: &mut Vec<(String, String)>) {
    let Some(members) = schema["properties"].as_object() else {
        return;
    };
    for (name, member) in members {
        if ["$schema", "study_format"].contains(&name.as_str()) {
            continue;
        }
        let about = member["description"].as_str().unwrap_or_default();
        found.push((name.clone(), about.to_owned()));
        attributes(member, found);
        attributes(&member["items"], found);
    }
}

#[test]
fn python_has_every_setting_with_its_sentence() {
    let path = "../crates/opshock-python/python/opshock/_keys.py";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let text = std::fs::read_to_string(path).unwrap();
    let mut found = Vec::new();
    attributes(&json_schema(), &mut found);
    assert!(found.len() > 200, "{}", found.len());
    for (name, about) in &found {
        assert!(
            text.contains(&format!("\n    {name}: ")) && text.contains(about.as_str()),
            "{name}: {about}\nwrite it anew: crates/opshock-python/generate_keys.py"
        );
    }
    let fields = text
        .lines()
        .filter(|line| line.starts_with("    ") && line.contains(": ") && !line.contains("\"\"\""));
    assert_eq!(fields.count(), found.len());
}
