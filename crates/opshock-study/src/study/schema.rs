//! Writes the JSON Schema of study files, for editors, and the list of unit suffixes, from the table of keys.

use serde_json::{Map, Value, json};

use super::key::{Bound, Key, Kind, Presence, Range};
use super::keys::{self, KEYS};
use super::unit::{self, UNITS};

/// The JSON Schema (draft 2020-12) of a study file.
pub fn json_schema() -> Value {
    let mut schema = table("");
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("opshock study");
    schema["x-units"] = units().into_iter().map(|unit| json!(unit)).collect();
    schema
}

/// The suffixes keys end with, each with its unit: `_um: µm (length)`.
pub fn units() -> Vec<String> {
    UNITS
        .iter()
        .filter(|unit| unit.in_use)
        .map(|unit| {
            format!(
                "_{}: {} ({})",
                unit.suffix,
                unit.symbol,
                unit.dimension.name()
            )
        })
        .collect()
}

fn table(pattern: &str) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    for name in keys::names_below(pattern) {
        let path = super::read::join(pattern, name);
        let schema = match KEYS.iter().find(|key| key.path == path) {
            Some(key) => {
                if key.presence == Presence::Required {
                    required.push(json!(name));
                }
                described(key)
            }
            None => {
                if KEYS.iter().any(|key| {
                    key.presence == Presence::Required
                        && !key.path[path.len().min(key.path.len())..].contains("[]")
                        && key.path.starts_with(&format!("{path}."))
                }) {
                    required.push(json!(name));
                }
                table(&path)
            }
        };
        properties.insert(name.to_string(), schema);
    }
    let mut schema = json!({
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
    });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

fn described(key: &Key) -> Value {
    let mut schema = one(key);
    let unit = unit::of_path(key.path);
    if key.may_be_axis() {
        let mut forms = vec![
            schema.clone(),
            json!({ "type": "array", "items": schema, "minItems": 1, "uniqueItems": true }),
        ];
        if matches!(key.kind, Kind::Number(_)) {
            forms.push(spaced());
        }
        schema = json!({ "anyOf": forms });
    }
    let mut help = key.help.to_string();
    if let Some(unit) = unit {
        help.push_str(&format!(" In {}.", unit.symbol));
    }
    match key.presence {
        Presence::ByPreset => help.push_str(" Set by resolution.preset when absent."),
        Presence::Optional(absent) => help.push_str(&format!(" Absent: {absent}.")),
        _ => {}
    }
    schema["description"] = json!(help);
    if let Presence::Default(literal) | Presence::Together(literal) = key.presence
        && let Some(default) = toml_to_json(literal)
    {
        schema["default"] = default;
    }
    if let Some(example) = toml_to_json(key.example()) {
        schema["examples"] = json!([example]);
    }
    schema
}

/// Schema of one value of a key.
fn one(key: &Key) -> Value {
    match key.kind {
        Kind::Number(range) => number(range),
        Kind::NumberOrWord(range, words) => json!({ "anyOf": [number(range), { "enum": words }] }),
        Kind::Integer(low, high) => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Words(words) => json!({ "anyOf": [
            { "type": "array", "items": { "enum": words }, "uniqueItems": true }, { "enum": words },
        ] }),
        Kind::Axis(range) => json!({ "anyOf": [
            { "type": "array", "items": number(range), "minItems": 1, "uniqueItems": true },
            number(range),
            spaced(),
        ] }),
        Kind::Numbers(range) => json!({ "type": "array", "items": number(range) }),
        Kind::Pair(range) => {
            json!({ "type": "array", "items": number(range), "minItems": 2, "maxItems": 2 })
        }
        Kind::Points => json!({ "type": "array", "minItems": 3, "items": {
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
        } }),
        Kind::Tables => {
            json!({ "type": "array", "minItems": 1, "items": table(&format!("{}[]", key.path)) })
        }
    }
}

fn spaced() -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["from", "to", "count"],
        "properties": {
            "from": { "type": "number" },
            "to": { "type": "number" },
            "count": { "type": "integer", "minimum": 2 },
            "spacing": { "enum": ["linear", "log"], "default": "linear" },
        },
    })
}

fn number(range: Range) -> Value {
    let mut schema = json!({ "type": "number" });
    match range.low {
        Bound::Free => {}
        Bound::Open(limit) => schema["exclusiveMinimum"] = json!(limit),
        Bound::Closed(limit) => schema["minimum"] = json!(limit),
    }
    match range.high {
        Bound::Free => {}
        Bound::Open(limit) => schema["exclusiveMaximum"] = json!(limit),
        Bound::Closed(limit) => schema["maximum"] = json!(limit),
    }
    schema
}

fn toml_to_json(literal: &str) -> Option<Value> {
    let document: toml::Table = toml::from_str(&format!("value = {literal}")).ok()?;
    serde_json::to_value(document.get("value")?).ok()
}
