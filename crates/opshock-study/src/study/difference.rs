//! Compares two resolved studies (every setting written out with its default) key by key.

use std::collections::BTreeMap;

use serde_json::Value;

/// Every value of a study by its dotted path, entries of tables numbered from 0.
pub type Settings = BTreeMap<String, Value>;

/// A setting with different values; `None` where a study does not have it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SettingDifference {
    /// Dotted path of the key.
    pub key: String,
    /// In A.
    pub a: Option<Value>,
    /// In B.
    pub b: Option<Value>,
}

/// Settings of a study with every default; `None` when the text is no TOML.
pub fn flat(resolved_study: &str) -> Option<Settings> {
    let table: toml::Table = toml::from_str(resolved_study).ok()?;
    let mut settings = Settings::new();
    spread("", &serde_json::to_value(table).ok()?, &mut settings);
    Some(settings)
}

fn spread(path: &str, value: &Value, settings: &mut Settings) {
    match value {
        Value::Object(members) => {
            for (name, member) in members {
                let dot = if path.is_empty() { "" } else { "." };
                spread(&format!("{path}{dot}{name}"), member, settings);
            }
        }
        Value::Array(entries) if !entries.is_empty() && entries.iter().all(Value::is_object) => {
            for (place, entry) in entries.iter().enumerate() {
                spread(&format!("{path}[{place}]"), entry, settings);
            }
        }
        value => {
            settings.insert(path.to_owned(), value.clone());
        }
    }
}

/// Settings that differ, by key.
pub fn differing(a: &Settings, b: &Settings) -> Vec<SettingDifference> {
    let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
    keys.sort();
    keys.dedup();
    keys.into_iter()
        .filter(|key| a.get(*key) != b.get(*key))
        .map(|key| SettingDifference {
            key: key.clone(),
            a: a.get(key).cloned(),
            b: b.get(key).cloned(),
        })
        .collect()
}

impl std::fmt::Display for SettingDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let word =
            |value: &Option<Value>| value.as_ref().map_or("unset".to_owned(), Value::to_string);
        write!(f, "{} {} -> {}", self.key, word(&self.a), word(&self.b))
    }
}
