//! What tolerances are worth in sentences, and as a table.

use crate::worth::{Change, WorthAnswer, WorthRow};

/// What tolerances are worth, and of which drive.
#[derive(Clone, Copy, Debug)]
pub struct Valued<'a> {
    /// Name of the study.
    pub study: &'a str,
    /// Its file, and the settings that the command line laid over it.
    pub drive: &'a str,
    /// Program that found the critical shocks.
    pub program: &'a str,
    /// Text of the tolerance file.
    pub tolerances: &'a str,
    /// The answer.
    pub answer: &'a WorthAnswer,
}

/// The two values in words ([`crate::worth::ENDS`]).
const LOW: &str = "15.9th";
const HIGH: &str = "84.1th";

/// Change with its half-width, of a known one.
fn known(change: &Change) -> Option<[f64; 2]> {
    Some([change.change_g?, change.uncertainty_g?])
}

impl Valued<'_> {
    /// The answer: what is worth most, by how much, and whether the uncertainties leave it in front of the next.
    pub fn sentences(&self) -> Vec<String> {
        let largest = |row: &'_ WorthRow| -> Option<(String, Change)> {
            Some((row.name.clone(), row.largest()?.clone()))
        };
        let mut ranked = self.answer.rows.iter().filter_map(largest);
        let Some((name, first)) = ranked.next() else {
            return vec![format!(
                "{}: no change of a critical shock was found.",
                self.answer.name
            )];
        };
        let [change_g, half_g] = known(&first).unwrap_or_default();
        let change = format!(
            "{} G at {}, from its {LOW} to its {HIGH} percentile",
            plus_minus(change_g, half_g),
            first.point
        );
        if !first.excludes_zero {
            return vec![format!(
                "{}: no change of a critical shock can be distinguished from zero. The nearest to it is that of {name}: {change}.",
                self.answer.name
            )];
        }
        let mut sentences = vec![format!(
            "{}: {name} is worth most, {change}.",
            self.answer.name
        )];
        if let Some((next, other)) = ranked.next()
            && let Some([other_g, other_half_g]) = known(&other)
        {
            let lead = change_g.abs() - other_g.abs();
            sentences.push(match lead > half_g + other_half_g {
                true => format!(
                    "Its lead over {next} ({} G) is beyond the uncertainties.",
                    plus_minus(other_g, other_half_g)
                ),
                false => format!(
                    "It cannot be distinguished from {next} ({} G).",
                    plus_minus(other_g, other_half_g)
                ),
            });
        }
        let rows = self.answer.rows.iter();
        let idle = rows.filter(|row| !row.changes.iter().any(|change| change.excludes_zero));
        let idle: Vec<&str> = idle.map(|row| row.name.as_str()).collect();
        if !idle.is_empty() {
            sentences.push(format!("No effect can be shown of: {}.", idle.join(", ")));
        }
        sentences
    }

    /// A line for each tolerance.
    pub(in crate::report) fn table(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let header = [
            "tolerance",
            "key",
            "from",
            "to",
            "change of the critical shock (G)",
            "per unit of the key (G)",
            "at",
            "changes distinguishable from zero",
        ];
        let rows = self.answer.rows.iter().map(|row| {
            let distinguishable = row
                .changes
                .iter()
                .filter(|change| change.excludes_zero)
                .count();
            let mut cells = vec![row.name.clone()];
            let (key, ends) = row.values.first().cloned().unwrap_or_default();
            cells.push(key);
            cells.extend(ends.map(|end| end.map_or("absent".to_owned(), |end| short(&end))));
            let largest = row.largest();
            cells.push(
                largest
                    .and_then(known)
                    .map_or("none".to_owned(), |[change_g, half_g]| {
                        plus_minus(change_g, half_g)
                    }),
            );
            cells.push(
                largest
                    .and_then(known)
                    .zip(row.width.filter(|width| *width != 0.0))
                    .map_or(String::new(), |([change_g, half_g], width)| {
                        plus_minus(change_g / width, half_g / width.abs())
                    }),
            );
            cells.push(largest.map_or(String::new(), |change| change.point.clone()));
            cells.push(format!("{distinguishable} of {}", row.changes.len()));
            cells
        });
        (header.map(String::from).to_vec(), rows.collect())
    }
}

/// `+12.3 +- 1.1`: the half-width with two digits, the change to the same place.
pub(in crate::report) fn plus_minus(change: f64, half: f64) -> String {
    let digits = half.abs().max(f64::MIN_POSITIVE).log10().floor();
    let after_point = (1.0 - digits).clamp(0.0, 12.0) as usize;
    format!("{change:+.after_point$} +- {half:.after_point$}")
}

/// A number to five digits.
fn short(text: &str) -> String {
    let Ok(value) = text.parse::<f64>() else {
        return text.to_owned();
    };
    let digits = value.abs().max(f64::MIN_POSITIVE).log10().floor();
    let after_point = (4.0 - digits).clamp(0.0, 12.0) as usize;
    format!("{value:.after_point$}")
}

#[cfg(test)]
mod tests {
    use super::plus_minus;

    #[test]
    fn a_change_is_written_to_the_digits_of_its_half_width() {
        assert_eq!(plus_minus(12.345, 1.149), "+12.3 +- 1.1");
        assert_eq!(plus_minus(-73_027.4, 1249.0), "-73027 +- 1249");
        assert_eq!(plus_minus(0.000_123_4, 0.000_045), "+0.000123 +- 0.000045");
    }
}
