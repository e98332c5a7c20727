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

/// Change with its half-width, of a known one.
fn known(change: &Change) -> Option<[f64; 2]> {
    Some([change.change_g?, change.uncertainty_g?])
}

impl Valued<'_> {
    /// The answer: what is worth most, by how much, and whether that can be told from the next and from nothing.
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
        let mut sentences = vec![format!(
            "{}: {name} is worth most, {} G at {} from one standard deviation below its median to one above.",
            self.answer.name,
            signed(change_g, half_g),
            first.point
        )];
        if let Some((next, other)) = ranked.next()
            && let Some([other_g, other_half_g]) = known(&other)
        {
            let lead = change_g.abs() - other_g.abs();
            sentences.push(match lead > half_g + other_half_g {
                true => format!(
                    "Its lead over {next} ({} G) is beyond the uncertainties.",
                    signed(other_g, other_half_g)
                ),
                false => format!(
                    "It cannot be told apart from {next} ({} G).",
                    signed(other_g, other_half_g)
                ),
            });
        }
        let rows = self.answer.rows.iter();
        let idle = rows.filter(|row| !row.changes.iter().any(|change| change.is_told_apart));
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
            "from",
            "to",
            "largest certain change (G)",
            "per unit of the key (G)",
            "at",
            "points with a change",
        ];
        let rows = self.answer.rows.iter().map(|row| {
            let told = row
                .changes
                .iter()
                .filter(|change| change.is_told_apart)
                .count();
            let mut cells = vec![row.name.clone()];
            let ends = row
                .values
                .first()
                .map(|(_, ends)| ends.clone())
                .unwrap_or_default();
            cells.extend(ends.map(|end| end.map_or("absent".to_owned(), |end| short(&end))));
            let largest = row.largest();
            cells.push(
                largest
                    .and_then(known)
                    .map_or("none".to_owned(), |[change_g, half_g]| {
                        signed(change_g, half_g)
                    }),
            );
            cells.push(largest.and_then(known).zip(row.width).map_or(
                String::new(),
                |([change_g, half_g], width)| {
                    format!("{:+.4} +- {:.4}", change_g / width, half_g / width.abs())
                },
            ));
            cells.push(largest.map_or(String::new(), |change| change.point.clone()));
            cells.push(format!("{told} of {}", row.changes.len()));
            cells
        });
        (header.map(String::from).to_vec(), rows.collect())
    }
}

/// `+12.3 +- 1.1`.
pub(in crate::report) fn signed(change_g: f64, half_g: f64) -> String {
    format!("{change_g:+.1} +- {half_g:.1}")
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
