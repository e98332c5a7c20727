//! Digests of computed numbers, committed in `tests/reference/digests.json`: a change of structure moves none of them.
//!
//! A change of the physics moves some on purpose: `OPSHOCK_WRITE_DIGESTS=1 cargo test --workspace`, without a filter,
//! writes today's, and the commit says why. On which machines bits agree: `docs/verification.md`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

use serde_json::Value;

static FILE: Mutex<()> = Mutex::new(());

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("reference/digests.json")
}

fn committed() -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(path()).expect("tests/reference/digests.json");
    serde_json::from_str(&text).expect("names and digests")
}

/// Every number of a JSON value in its order, all digits; `without` are members that say what it cost.
pub fn numbers(value: &Value, without: &[&str]) -> Vec<f64> {
    match value {
        Value::Number(number) => number.as_f64().into_iter().collect(),
        Value::Array(list) => list.iter().flat_map(|v| numbers(v, without)).collect(),
        Value::Object(members) => members
            .iter()
            .filter(|(name, _)| !without.contains(&name.as_str()))
            .flat_map(|(_, v)| numbers(v, without))
            .collect(),
        _ => Vec::new(),
    }
}

/// Compares the bits of numbers with the committed digest of this name.
///
/// # Panics
/// When they differ, or none is committed; the message has the numbers.
pub fn assert_digest(name: &str, numbers: &[f64]) {
    assert!(!numbers.is_empty(), "{name}: no numbers");
    let mut hasher = blake3::Hasher::new();
    for number in numbers {
        hasher.update(&number.to_bits().to_le_bytes());
    }
    let digest = hasher.finalize().to_hex()[..16].to_string();
    let _alone = FILE.lock().unwrap_or_else(|broken| broken.into_inner());
    let mut all = committed();
    if std::env::var_os("OPSHOCK_WRITE_DIGESTS").is_some() {
        all.insert(name.to_owned(), digest);
        let text = serde_json::to_string_pretty(&all).expect("text") + "\n";
        std::fs::write(path(), text).expect("writes");
        return;
    }
    let wanted = all.get(name);
    assert!(
        wanted == Some(&digest),
        "{name}: {digest} instead of {wanted:?}: {numbers:?}"
    );
}
