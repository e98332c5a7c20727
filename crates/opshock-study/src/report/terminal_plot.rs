//! Plots critical shock against pulse width as text, for a terminal.

use super::critical_shock::{series_name, series_names};
use crate::search::Sign;
use crate::store::summary::Summary;
use std::fmt::Write as _;

/// Letters of the series, in their order.
const LETTERS: &str = "nrdabcefghijklmopqstuvwxyz";
const ROWS: usize = 18;
const COLUMNS: usize = 64;

/// A panel for each sign; a letter a ramp model (and further axis value), `*` where several fall on
/// one cell, `^` and `v` where only a bound is known. The ordinate is logarithmic.
pub fn terminal_plot(summary: &Summary) -> String {
    let names = series_names(summary);
    let letters = letters(&names);
    let known = |value: Option<f64>| value.filter(|v| v.is_finite() && *v > 0.0);
    let values: Vec<f64> = summary
        .points
        .iter()
        .filter_map(|point| known(point.known_g()))
        .collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min) / 1.1;
    let high = values.iter().copied().fold(0.0, f64::max) * 1.1;
    if values.is_empty() {
        return "no critical shock to plot\n".into();
    }
    let widths = || summary.points.iter().map(|point| point.pulse_ms);
    let first = widths().fold(f64::INFINITY, f64::min);
    let last = widths().fold(0.0, f64::max);
    let mut text = String::new();
    for sign in [Sign::Plus, Sign::Minus] {
        if summary.points.iter().all(|point| point.sign != sign) {
            continue;
        }
        let mut grid = vec![vec![' '; COLUMNS]; ROWS];
        for point in summary.points.iter().filter(|point| point.sign == sign) {
            let Some(value) = known(point.known_g()) else {
                continue;
            };
            let bound = match (point.survived_g, point.failed_g) {
                (Some(_), None) => Some('^'),
                (None, Some(_)) => Some('v'),
                _ => None,
            };
            let name = series_name(summary, point);
            let letter = names.iter().position(|other| *other == name);
            let mark = bound.unwrap_or(letter.map_or('?', |place| letters[place]));
            let share = (value / low).ln() / (high / low).ln();
            let row = ((1.0 - share) * (ROWS - 1) as f64).round() as usize;
            let across = if last > first {
                (point.pulse_ms - first) / (last - first)
            } else {
                0.5
            };
            let column = 1 + (across * (COLUMNS - 3) as f64).round() as usize;
            let cell = &mut grid[row.min(ROWS - 1)][column];
            *cell = if *cell == ' ' || *cell == mark {
                mark
            } else {
                '*'
            };
        }
        let _ = writeln!(text, "critical shock (G), sign {}", sign.as_str());
        for (row, cells) in grid.iter().enumerate() {
            let share = 1.0 - row as f64 / (ROWS - 1) as f64;
            let label = match row % 4 == 0 || row == ROWS - 1 {
                true => format!("{:.0}", low * (high / low).powf(share)),
                false => String::new(),
            };
            let line: String = cells.iter().collect();
            let _ = writeln!(text, "{label:>7} |{}", line.trim_end());
        }
        let _ = writeln!(text, "{:>7} +{}", "", "-".repeat(COLUMNS));
        let (from, to) = (format!("{first}"), format!("{last} ms"));
        let gap = COLUMNS.saturating_sub(from.len() + to.len());
        let _ = writeln!(text, "{:>8} {from}{}{to}\n", "", " ".repeat(gap));
    }
    let legend: Vec<String> = names
        .iter()
        .zip(&letters)
        .map(|(name, letter)| format!("{letter} {name}"))
        .collect();
    let _ = writeln!(text, "{}", legend.join("   "));
    text
}

/// The first letter of a name when it is free, else the next one that is.
fn letters(names: &[String]) -> Vec<char> {
    let mut taken: Vec<char> = Vec::new();
    for name in names {
        let own = name.chars().next().unwrap_or('x').to_ascii_lowercase();
        let free = std::iter::once(own).chain(LETTERS.chars()).find(|letter| {
            letter.is_ascii_alphabetic() && *letter != 'v' && !taken.contains(letter)
        });
        taken.push(free.unwrap_or('x'));
    }
    taken
}
