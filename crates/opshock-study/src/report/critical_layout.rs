//! Distributes the coordinates of a table over one figure: abscissa, colour, line style, panels.
//!
//! Signs have a panel each, and so has the worst of them (and of the heads of one drive). Of the others, the ramp model
//! takes the colours, or else the coordinate with most values that there are colours for. One more takes line style and
//! mark as long as a panel has no more than [`MOST_LINES`] lines; what is left makes more rows of panels.

use super::answer::worst;
use super::chart::colour;
use super::coordinates::{self, RAMP, SIGN, is_worst_case};
use crate::store::summary::{AxisValue, PointSummary, Summary};

/// Lines in a panel that a reader tells apart.
const MOST_LINES: usize = 6;

/// One figure of critical shocks, before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// Coordinate on the abscissa.
    pub x: usize,
    /// Abscissae, in order, with the word of each where they are no numbers.
    pub ticks: Vec<(f64, Option<String>)>,
    /// Panels, row by row.
    pub panels: Vec<PanelOfLines>,
    /// Panels in a row.
    pub columns: usize,
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PanelOfLines {
    /// Heading.
    pub title: String,
    /// Whether its marks are the lowest of several rows.
    pub is_worst: bool,
    /// Lines.
    pub lines: Vec<Line>,
}

/// One line with its marks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Name in the legend.
    pub name: String,
    /// Place in the list of colours.
    pub colour: usize,
    /// Place in the list of line styles and marks.
    pub style: usize,
    /// Abscissae and rows of the table.
    pub marks: Vec<(f64, usize)>,
}

/// What a panel or a line has in common: places of coordinates with their values.
type Fixed = Vec<(usize, AxisValue)>;

fn has(point: &PointSummary, fixed: &Fixed) -> bool {
    fixed
        .iter()
        .all(|(place, value)| coordinates::value(point, *place) == *value)
}

/// Every combination of values of these coordinates that a row has, in the order of the values.
fn combinations(summary: &Summary, places: &[usize]) -> Vec<Fixed> {
    let mut found: Vec<Fixed> = vec![Vec::new()];
    for &place in places {
        let values = coordinates::values(summary, place);
        let longer = found.iter().flat_map(|fixed| {
            values.iter().map(move |value| {
                let mut fixed = fixed.clone();
                fixed.push((place, value.clone()));
                fixed
            })
        });
        found = longer.collect();
    }
    found.retain(|fixed| summary.points.iter().any(|point| has(point, fixed)));
    found
}

/// Coordinates by what shows them.
struct Shown {
    colour: Option<usize>,
    style: Option<usize>,
    panels: Vec<usize>,
}

impl Shown {
    fn of(summary: &Summary, x: usize) -> Self {
        let count = |place: usize| coordinates::values(summary, place).len();
        let places = 0..coordinates::names(summary).len();
        let mut left: Vec<usize> = places
            .filter(|&place| place != x && place != SIGN && count(place) > 1)
            .collect();
        let fits = |place: &usize| count(*place) <= colour::CYCLE.len();
        let most = left
            .iter()
            .copied()
            .filter(fits)
            .max_by_key(|place| count(*place));
        let colour = left.iter().copied().find(|place| *place == RAMP).or(most);
        left.retain(|place| Some(*place) != colour);
        let lines = colour.map_or(1, count);
        let room = |place: &usize| lines * count(*place) <= MOST_LINES;
        let style = left
            .iter()
            .copied()
            .filter(room)
            .min_by_key(|place| count(*place));
        left.retain(|place| Some(*place) != style);
        Self {
            colour,
            style,
            panels: left,
        }
    }

    /// The same without what a worst case is taken over.
    fn without_worst_case(&self, summary: &Summary) -> Self {
        let keep = |place: &usize| !is_worst_case(summary, *place);
        Self {
            colour: self.colour.filter(keep),
            style: self.style.filter(keep),
            panels: self.panels.iter().copied().filter(keep).collect(),
        }
    }

    fn lines(&self, summary: &Summary) -> Vec<(Fixed, Line)> {
        let places: Vec<usize> = self.colour.into_iter().chain(self.style).collect();
        let line = |fixed: Fixed| {
            let rank = |place: Option<usize>| {
                let (place, value) = fixed.iter().find(|(known, _)| Some(*known) == place)?;
                let values = coordinates::values(summary, *place);
                values.iter().position(|other| other == value)
            };
            let words: Vec<String> = fixed
                .iter()
                .map(|(place, value)| coordinates::words(summary, *place, value))
                .collect();
            let colour = rank(self.colour).unwrap_or(0);
            let line = Line {
                name: match words.is_empty() {
                    true => "critical shock".to_owned(),
                    false => words.join(", "),
                },
                colour,
                // A second way to tell lines apart, for print and for readers who do not see colours.
                style: rank(self.style).unwrap_or(if self.style.is_some() { 0 } else { colour }),
                marks: Vec::new(),
            };
            (fixed, line)
        };
        combinations(summary, &places)
            .into_iter()
            .map(line)
            .collect()
    }
}

impl Layout {
    /// The figure over coordinate `x`; with the panels of the worst cases where there is more than one case.
    pub fn of(summary: &Summary, x: usize, with_worst: bool) -> Self {
        let values = coordinates::values(summary, x);
        let is_words = values
            .iter()
            .any(|value| coordinates::number(value).is_none());
        let ticks: Vec<(f64, Option<String>)> = (0..values.len())
            .map(|rank| match coordinates::number(&values[rank]) {
                Some(number) if !is_words => (number, None),
                _ => (rank as f64, Some(values[rank].to_string())),
            })
            .collect();
        let abscissa = |point: &PointSummary| {
            let own = coordinates::value(point, x);
            let rank = values.iter().position(|value| *value == own);
            rank.map_or(f64::NAN, |rank| ticks[rank].0)
        };
        let shown = Shown::of(summary, x);
        let signs: Vec<Option<AxisValue>> = match x {
            SIGN => vec![None],
            _ => {
                let mut signs = coordinates::values(summary, SIGN);
                signs.sort_by_key(|sign| sign.to_string());
                signs.into_iter().map(Some).collect()
            }
        };
        let worst_of = worst_case_words(summary, x).filter(|_| with_worst);
        let general = shown.without_worst_case(summary);
        let panel = |row: &Fixed, sign: Option<&AxisValue>| {
            let mut lines = Vec::new();
            for (fixed, mut line) in shown.lines(summary) {
                for (place, point) in summary.points.iter().enumerate() {
                    let own_sign = sign.is_none_or(|sign| coordinates::value(point, SIGN) == *sign);
                    if has(point, row) && has(point, &fixed) && own_sign {
                        line.marks.push((abscissa(point), place));
                    }
                }
                line.marks.sort_by(|a, b| a.0.total_cmp(&b.0));
                lines.push(line);
            }
            PanelOfLines {
                title: title(summary, row, sign),
                is_worst: false,
                lines,
            }
        };
        let worst_panel = |row: &Fixed, words: &str| {
            let mut lines = Vec::new();
            for (fixed, mut line) in general.lines(summary) {
                for (tick, _) in &ticks {
                    let rows = summary.points.iter().filter(|point| {
                        has(point, row) && has(point, &fixed) && abscissa(point) == *tick
                    });
                    let place = worst(rows).and_then(|lowest| {
                        summary
                            .points
                            .iter()
                            .position(|point| std::ptr::eq(point, lowest))
                    });
                    line.marks.extend(place.map(|place| (*tick, place)));
                }
                lines.push(line);
            }
            let own: Vec<String> = row
                .iter()
                .map(|(place, value)| coordinates::words(summary, *place, value))
                .collect();
            PanelOfLines {
                title: [&own[..], &[words.to_owned()]].concat().join(", "),
                is_worst: true,
                lines,
            }
        };
        let rows = combinations(summary, &shown.panels);
        let general_rows = combinations(summary, &general.panels);
        let mut panels = Vec::new();
        let mut columns = signs.len();
        if let Some(words) = worst_of
            .as_deref()
            .filter(|_| rows.len() != general_rows.len())
        {
            panels.extend(general_rows.iter().map(|row| worst_panel(row, words)));
        }
        for row in &rows {
            if let Some(words) = worst_of
                .as_deref()
                .filter(|_| rows.len() == general_rows.len())
            {
                panels.push(worst_panel(row, words));
                columns = 1 + signs.len();
            }
            panels.extend(signs.iter().map(|sign| panel(row, sign.as_ref())));
        }
        Self {
            x,
            ticks,
            panels,
            columns,
        }
    }
}

/// What the worst case is taken over; `None` where there is one case only.
fn worst_case_words(summary: &Summary, x: usize) -> Option<String> {
    let places = 0..coordinates::names(summary).len();
    let several: Vec<&str> = places
        .filter(|&place| place != x && is_worst_case(summary, place))
        .filter(|&place| coordinates::values(summary, place).len() > 1)
        .map(|place| if place == SIGN { "signs" } else { "heads" })
        .collect();
    (!several.is_empty()).then(|| format!("worst of all {}", several.join(" and ")))
}

fn title(summary: &Summary, row: &Fixed, sign: Option<&AxisValue>) -> String {
    let mut words: Vec<String> = row
        .iter()
        .map(|(place, value)| coordinates::words(summary, *place, value))
        .collect();
    words.extend(
        sign.map(|sign| match (sign.to_string().as_str(), row.is_empty()) {
            ("+", true) => "sign +: disk first towards the slider".to_owned(),
            (_, true) => "sign \u{2212}: disk first away from the slider".to_owned(),
            _ => coordinates::words(summary, SIGN, sign),
        }),
    );
    words.join(", ")
}
