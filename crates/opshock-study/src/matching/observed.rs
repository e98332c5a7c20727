//! Reads the observations of a match file.

use std::path::Path;

use super::measured::measured;
use super::observation::{
    COLUMNS, Combination, Measure, Observation, Quantity, Scalar, ShockChoice, Stage,
};
use super::statements::Statements;
use crate::study::table_fields::{Faults, Fields};
use crate::study::tree::Value;
use crate::study::{Ramp, Sign};

const OBSERVATION: &[&str] = &[
    "name",
    "output",
    "equals",
    "history",
    "file",
    "measure",
    "critical_shock",
    "statement",
    "ratio",
    "difference",
    "distance_pct",
    "order",
    "shock",
    "range",
    "uncertainty",
    "discrepancy",
    "numerical_uncertainty",
    "source",
];
const KINDS: &[&str] = &[
    "output",
    "history",
    "critical_shock",
    "statement",
    "ratio",
    "difference",
    "distance_pct",
    "order",
];
/// Members of `opshock run --json` that need the head.
const OF_THE_HEAD: &[&str] = &[
    "verdict",
    "cause",
    "t_fail_s",
    "place",
    "min_clearance_m",
    "t_min_clearance_s",
    "steady",
    "dimple",
    "limiters",
    "lift_tab",
];
/// Its other members.
const OF_THE_DISK: &[&str] = &[
    "disk",
    "contact",
    "energy",
    "complementarity",
    "hub",
    "base",
];

/// Reads every `[[observation]]`, then the statements that `statements` names.
pub(super) fn read(
    fields: &Fields<'_>,
    folder: &Path,
    built_in: &dyn Statements,
    faults: &mut Faults,
) -> Vec<Observation> {
    let mut all: Vec<Observation> = Vec::new();
    for (node, path) in fields.list("observation", faults) {
        let Some(table) = Fields::of(node, &path, OBSERVATION, faults) else {
            continue;
        };
        let before = faults.len();
        let read = one(&table, folder, &all, built_in, faults);
        let Some(read) = read.filter(|_| faults.len() == before) else {
            continue;
        };
        if all.iter().any(|known| known.name == read.name) {
            faults.push(
                table
                    .fault_of("E193", "name", "two observations have this name")
                    .allowed("one"),
            );
        }
        all.push(read);
    }
    let statements = match fields.get("statements").map(|node| &node.value) {
        Some(Value::Text(word)) if word == built_in.name() => built_in.observations(),
        Some(_) => {
            let ids = fields.texts("statements", faults);
            ids.iter()
                .filter_map(|id| statement(fields, "statements", id, built_in, faults))
                .collect()
        }
        None => Vec::new(),
    };
    for one in statements {
        if all.iter().any(|known| known.name == one.name) {
            let message = format!("{} is an observation above, too", one.name);
            faults.push(
                fields
                    .fault_of("E193", "statements", message)
                    .allowed("each once"),
            );
        }
        all.push(one);
    }
    all
}

fn statement(
    fields: &Fields<'_>,
    name: &str,
    id: &str,
    built_in: &dyn Statements,
    faults: &mut Faults,
) -> Option<Observation> {
    let mut all = built_in.observations();
    let Some(place) = all.iter().position(|one| one.name == id) else {
        let message = format!("{id:?} is no statement of the {}", built_in.name());
        let ids: Vec<&str> = all.iter().map(|one| one.name.as_str()).collect();
        faults.push(
            fields
                .fault_of("E193", name, message)
                .allowed(ids.join(", ")),
        );
        return None;
    };
    Some(all.swap_remove(place))
}

fn one(
    table: &Fields<'_>,
    folder: &Path,
    known: &[Observation],
    built_in: &dyn Statements,
    faults: &mut Faults,
) -> Option<Observation> {
    let name = table.text("name", faults);
    if name.is_none() && table.get("name").is_none() {
        table.missing("name", "a text", faults);
    }
    let given = table.present(KINDS);
    let [kind] = given[..] else {
        let fault = table.fault("E193", format!("has {} outputs", given.len()));
        faults.push(fault.allowed(format!("one of {}", KINDS.join(", "))));
        return None;
    };
    let (quantity, stage, own_range) = match kind {
        "output" => output(table, faults)?,
        "history" => history(table, folder, faults)?,
        "critical_shock" => {
            if table.flag(kind, faults)? {
                let shock = shock(table, false, faults)?;
                (Quantity::Critical(shock), Stage::CriticalShocks, None)
            } else {
                faults.push(
                    table
                        .fault_of("E193", kind, "asks for nothing")
                        .allowed("true"),
                );
                return None;
            }
        }
        "statement" => {
            let id = table.text(kind, faults)?;
            let of = statement(table, kind, &id, built_in, faults)?;
            (of.quantity, of.stage, of.range)
        }
        _ => combined(table, kind, known, faults)?,
    };
    if matches!(
        kind,
        "statement" | "ratio" | "difference" | "distance_pct" | "order"
    ) && table.get("shock").is_some()
    {
        let fault = table.fault_of("E193", "shock", format!("has no meaning beside {kind}"));
        faults.push(fault.allowed("no shock"));
    }
    let range = table.range("range", true, faults);
    // A distance is not negative: a lower limit of 0 is no end of its range.
    let range = range.map(|[low, high]| match kind {
        "history" | "distance_pct" if low <= 0.0 => [f64::NEG_INFINITY, high],
        _ => [low, high],
    });
    if own_range.is_some() && range.is_some() {
        faults.push(
            table
                .fault_of("E193", "range", "is given by equals or the statement")
                .allowed("no range"),
        );
    }
    Some(Observation {
        name: name?,
        quantity,
        range: range.or(own_range),
        weight: 1.0,
        observed_u: table.positive("uncertainty", faults).unwrap_or(0.0),
        discrepancy_u: table.positive("discrepancy", faults).unwrap_or(0.0),
        numerical_u: table.positive("numerical_uncertainty", faults),
        stage,
        source: table.text("source", faults).unwrap_or_default(),
    })
}

type Read = (Quantity, Stage, Option<[f64; 2]>);

fn output(table: &Fields<'_>, faults: &mut Faults) -> Option<Read> {
    let path = table.text("output", faults)?;
    let mut words: Vec<String> = path.split('.').map(str::to_owned).collect();
    let command = words.remove(0);
    let first = words.first().map_or("", String::as_str);
    let wrong = |faults: &mut Faults, message: String, allowed: String| {
        faults.push(table.fault_of("E193", "output", message).allowed(allowed));
    };
    match command.as_str() {
        "modes" | "steady" if !words.is_empty() => {
            if table.get("shock").is_some() || table.get("equals").is_some() {
                let name = if table.get("shock").is_some() {
                    "shock"
                } else {
                    "equals"
                };
                faults.push(
                    table
                        .fault_of("E193", name, format!("has no meaning beside {command}"))
                        .allowed("none"),
                );
                return None;
            }
            Some(match command.as_str() {
                "modes" if first == "disk" || first == "ramp" => {
                    (Quantity::Modes(words), Stage::DiskAndRamp, None)
                }
                "modes" => (Quantity::Modes(words), Stage::SingleShocks, None),
                _ => (Quantity::Steady(words), Stage::SingleShocks, None),
            })
        }
        "run" => {
            let stage = match first {
                first if OF_THE_HEAD.contains(&first) => Stage::SingleShocks,
                first if OF_THE_DISK.contains(&first) => Stage::DiskAndRamp,
                _ => {
                    let all = [OF_THE_HEAD, OF_THE_DISK].concat().join(", ");
                    wrong(
                        faults,
                        "is no output of opshock run --json".into(),
                        format!("run. and one of {all}"),
                    );
                    return None;
                }
            };
            let equals = match table.get("equals").map(|node| &node.value) {
                None => None,
                Some(Value::Text(word)) => Some(Scalar::Text(word.clone())),
                Some(Value::Flag(flag)) => Some(Scalar::Flag(*flag)),
                Some(_) => {
                    let fault = table.fault_of("E113", "equals", "is neither text nor flag");
                    faults.push(fault.allowed("text, true or false; numbers have a range"));
                    return None;
                }
            };
            let verdicts = ["survives", "fails"];
            if let (true, Some(Scalar::Text(word))) = (path == "run.verdict", &equals)
                && !verdicts.contains(&word.as_str())
            {
                faults.push(
                    table
                        .fault_of("E193", "equals", "is no verdict")
                        .allowed(verdicts.join(", ")),
                );
            }
            let shock = shock(table, true, faults)?;
            let range = equals.is_some().then_some([1.0, 1.0]);
            Some((
                Quantity::Run {
                    shock,
                    path: words,
                    equals,
                },
                stage,
                range,
            ))
        }
        _ => {
            let allowed = "run., modes. or steady. and a path in the JSON of that command";
            wrong(faults, "is no output".into(), allowed.into());
            None
        }
    }
}

fn shock(table: &Fields<'_>, has_amplitude: bool, faults: &mut Faults) -> Option<ShockChoice> {
    let Some(node) = table.get("shock") else {
        table.missing(
            "shock",
            "{ ramp = \"rigid\", pulse_ms = 2.0, sign = \"+\", amplitude_g = 400.0 }",
            faults,
        );
        return None;
    };
    let names: &[&str] = match has_amplitude {
        true => &["ramp", "pulse_ms", "sign", "amplitude_g"],
        false => &["ramp", "pulse_ms", "sign"],
    };
    let before = faults.len();
    let shock = Fields::of(node, &table.path("shock"), names, faults)?;
    let ramp = shock.text("ramp", faults).and_then(|word| {
        let found = Ramp::from_word(&word);
        if found.is_none() {
            let allowed = Ramp::ALL.map(Ramp::as_str).join(", ");
            faults.push(
                shock
                    .fault_of("E113", "ramp", "is no ramp model")
                    .allowed(allowed),
            );
        }
        found
    });
    let sign = shock.text("sign", faults).and_then(|word| {
        let found = Sign::from_word(&word);
        if found.is_none() {
            faults.push(
                shock
                    .fault_of("E113", "sign", "is no sign")
                    .allowed("\"+\" or \"-\""),
            );
        }
        found
    });
    let pulse_ms = shock.positive("pulse_ms", faults);
    if pulse_ms == Some(0.0) {
        faults.push(
            shock
                .fault_of("E130", "pulse_ms", "is no width")
                .allowed("above 0"),
        );
    }
    let amplitude_g = shock.positive("amplitude_g", faults);
    if has_amplitude && shock.get("amplitude_g").is_none() {
        shock.missing("amplitude_g", "a number of 0 or more", faults);
    }
    (faults.len() == before).then_some(ShockChoice {
        ramp,
        pulse_ms,
        sign,
        amplitude_g,
    })
}

fn history(table: &Fields<'_>, folder: &Path, faults: &mut Faults) -> Option<Read> {
    let column = table.text("history", faults)?;
    let shock = shock(table, true, faults);
    let measure = match table.text("measure", faults).as_deref() {
        Some("rms") | None => Measure::Rms,
        Some("largest") => Measure::Largest,
        Some(_) => {
            faults.push(
                table
                    .fault_of("E113", "measure", "is no measure")
                    .allowed("\"rms\" or \"largest\""),
            );
            return None;
        }
    };
    let Some(file) = table.text("file", faults) else {
        if table.get("file").is_none() {
            table.missing(
                "file",
                "the path of a CSV file with the columns time_s and value",
                faults,
            );
        }
        return None;
    };
    let stage = match COLUMNS.iter().find(|(name, _)| *name == column) {
        Some((_, stage)) => *stage,
        None => {
            let names: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
            faults.push(
                table
                    .fault_of("E193", "history", "is no history")
                    .allowed(names.join(", ")),
            );
            return None;
        }
    };
    let measured = match measured(&folder.join(file)) {
        Ok(measured) => measured,
        Err(fault) => {
            faults.push(*fault);
            return None;
        }
    };
    Some((
        Quantity::History {
            shock: shock?,
            column,
            measured,
            measure,
        },
        stage,
        None,
    ))
}

fn combined(
    table: &Fields<'_>,
    kind: &str,
    known: &[Observation],
    faults: &mut Faults,
) -> Option<Read> {
    let combination = Combination::ALL
        .into_iter()
        .find(|(name, _)| *name == kind)?
        .1;
    let names = table.texts(kind, faults);
    let is_pair = combination != Combination::Order;
    if names.len() < 2 || is_pair && names.len() != 2 {
        let allowed = if is_pair {
            "two names of observations"
        } else {
            "two or more names of observations"
        };
        faults.push(
            table
                .fault_of("E193", kind, format!("has {} names", names.len()))
                .allowed(allowed),
        );
        return None;
    }
    let mut places = Vec::new();
    for name in &names {
        match known.iter().position(|one| one.name == *name) {
            Some(place) => places.push(place),
            None => {
                let above: Vec<&str> = known.iter().map(|one| one.name.as_str()).collect();
                let above = match above.is_empty() {
                    true => "an observation above this one; there is none".to_owned(),
                    false => above.join(", "),
                };
                let fault = table.fault_of(
                    "E193",
                    kind,
                    format!("{name:?} is no observation above this one"),
                );
                faults.push(fault.allowed(above));
            }
        }
    }
    let stage = places.iter().map(|place| known[*place].stage).max()?;
    Some((Quantity::Combined(combination, places), stage, None))
}
