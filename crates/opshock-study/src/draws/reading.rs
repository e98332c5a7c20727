//! Reads distributions of keys: the parameters of a match file, the tolerances of a tolerance file.

use super::parameter::{Distribution, Parameter};
use crate::study::table_fields::{Faults, Fields, wrong_kind};
use crate::study::tree::{Node, Value};
use crate::study::{SetArg, Study, number_at};

const PARAMETER: &[&str] = &[
    "name",
    "keys",
    "relative",
    "uniform",
    "log_uniform",
    "normal",
    "choices",
    "unset_share",
    "guess",
    "source",
];
const DISTRIBUTIONS: &[&str] = &["uniform", "log_uniform", "normal", "choices"];

/// Reads every entry of the list `name`; values relative to the study are those of `study`.
pub(crate) fn read(
    fields: &Fields<'_>,
    name: &str,
    study: &Study,
    faults: &mut Faults,
) -> Vec<Parameter> {
    let resolved = study
        .resolved_toml()
        .parse::<toml::Table>()
        .unwrap_or_default();
    let mut parameters: Vec<Parameter> = Vec::new();
    for (node, path) in fields.list(name, faults) {
        let Some(table) = Fields::of(node, &path, PARAMETER, faults) else {
            continue;
        };
        let Some(parameter) = parameter(&table, &resolved, faults) else {
            continue;
        };
        for (key, _) in &parameter.keys {
            if let Some(other) = parameters
                .iter()
                .find(|one| one.keys.iter().any(|(known, _)| known == key))
            {
                let fault = table.fault_of(
                    "E193",
                    "keys",
                    format!("{key} is a key of {:?} too", other.name),
                );
                faults.push(fault.allowed("a key in one parameter"));
            }
        }
        if parameters.iter().any(|one| one.name == parameter.name) {
            faults.push(
                table
                    .fault_of("E193", "name", "two parameters have this name")
                    .allowed("one"),
            );
        }
        parameters.push(parameter);
    }
    parameters
}

fn parameter(table: &Fields<'_>, resolved: &toml::Table, faults: &mut Faults) -> Option<Parameter> {
    let before = faults.len();
    let keys = table.texts("keys", faults);
    if keys.is_empty() {
        table.missing("keys", "a list of keys of the study", faults);
    }
    let is_relative = table.flag("relative", faults).unwrap_or(false);
    let mut with_own = Vec::new();
    let mut values = Vec::new();
    for key in keys {
        let own = number_at(resolved, &key);
        values.push(own);
        if is_relative && own.is_none() {
            let fault = table.fault_of("E193", "keys", format!("{key} has no number in the study"));
            faults.push(
                fault.allowed("keys that the study has, where values are relative to its own"),
            );
        }
        if SetArg::unset(&key).is_err() {
            let fault = table.fault_of("E193", "keys", format!("{key:?} is no key"));
            faults.push(fault.allowed("dotted names, as \"suspension.gram_load_gf\""));
        }
        with_own.push((key, own.filter(|_| is_relative)));
    }
    let unset_share = table.positive("unset_share", faults).unwrap_or(0.0);
    if unset_share >= 1.0 {
        faults.push(
            table
                .fault_of("E130", "unset_share", "leaves no values")
                .allowed("0 or more, below 1"),
        );
    }
    let distribution = distribution(table, faults);
    let first = with_own
        .first()
        .map(|(key, _)| key.clone())
        .unwrap_or_default();
    let name = table.text("name", faults).unwrap_or(first);
    let source = table.text("source", faults);
    if source.is_none() && table.get("source").is_none() {
        table.missing("source", "a text: where the range comes from", faults);
    }
    let guess = table.number("guess", faults);
    if let (Some(guess), Some(distribution)) = (guess, &distribution)
        && !distribution.has(guess)
    {
        let fault = table.fault_of("E193", "guess", "is no value of the parameter");
        faults.push(fault.allowed("a number of its range or choices"));
    }
    let distribution = distribution.filter(|_| faults.len() == before)?;
    // The study's own value is absent, or 1 where values are relative to it.
    let own = values.first().copied().flatten();
    let own = if is_relative { Some(1.0) } else { own };
    let start = match guess.or(own) {
        None if unset_share > 0.0 => 0.5 * unset_share,
        value => unset_share + (1.0 - unset_share) * distribution.probability(value),
    };
    Some(Parameter {
        name,
        keys: with_own,
        distribution,
        unset_share,
        source: source.unwrap_or_default(),
        start,
    })
}

fn distribution(table: &Fields<'_>, faults: &mut Faults) -> Option<Distribution> {
    let given = table.present(DISTRIBUTIONS);
    let [name] = given[..] else {
        let fault = table.fault("E193", format!("has {} distributions", given.len()));
        faults.push(fault.allowed(format!("one of {}", DISTRIBUTIONS.join(", "))));
        return None;
    };
    let spread = |[low, high]: [f64; 2], faults: &mut Faults| {
        if low < high {
            return Some([low, high]);
        }
        faults.push(
            table
                .fault_of("E133", name, "has no width")
                .allowed("[lowest, highest]"),
        );
        None
    };
    match name {
        "uniform" => {
            let range = table.range(name, false, faults)?;
            spread(range, faults).map(Distribution::Uniform)
        }
        "log_uniform" => {
            let range = spread(table.range(name, false, faults)?, faults)?;
            if range[0] <= 0.0 {
                faults.push(
                    table
                        .fault_of("E130", name, "is not above 0")
                        .allowed("two numbers above 0"),
                );
                return None;
            }
            Some(Distribution::LogUniform(range))
        }
        "normal" => {
            let node = table.get(name)?;
            let inner = Fields::of(node, &table.path(name), &["mean", "sd", "range"], faults)?;
            let (mean, sd) = (inner.number("mean", faults), inner.positive("sd", faults));
            let range = inner.range("range", false, faults);
            for (key, found) in [("mean", mean.is_some()), ("sd", sd.is_some())] {
                if !found && inner.get(key).is_none() {
                    inner.missing(key, "a number", faults);
                }
            }
            let (mean, sd) = (mean?, sd?);
            if sd == 0.0 {
                faults.push(
                    inner
                        .fault_of("E130", "sd", "is not above 0")
                        .allowed("a number above 0"),
                );
                return None;
            }
            // Six standard deviations contain all but 2e-9 of a normal distribution.
            let range = range.unwrap_or([mean - 6.0 * sd, mean + 6.0 * sd]);
            if range[0] >= range[1] || range[1] < mean - 8.0 * sd || range[0] > mean + 8.0 * sd {
                let fault = inner.fault_of("E133", "range", "holds nothing of the distribution");
                faults.push(fault.allowed("a range with a width within eight sd of the mean"));
                return None;
            }
            Some(Distribution::Normal { mean, sd, range })
        }
        _ => {
            let entries = table.list(name, faults);
            let mut texts = Vec::new();
            for (node, path) in &entries {
                match node.value {
                    Value::Date => faults.push(wrong_kind(node, path, "a word, number or flag")),
                    _ => texts.push(plain(node)),
                }
            }
            if texts.len() < 2 {
                faults.push(
                    table
                        .fault_of("E193", name, "has fewer than two entries")
                        .allowed("two or more"),
                );
                return None;
            }
            Some(Distribution::Choices(texts))
        }
    }
}

/// A value as `--set` takes it.
fn plain(node: &Node) -> String {
    node.place.text().trim().to_owned()
}
