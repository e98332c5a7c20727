//! Maps the rows of a matrix to degrees of freedom: node and direction.

use crate::fault::{Fault, Faults};
use crate::text::Source;
use std::collections::HashMap;

/// Direction of a freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Direction {
    /// Displacement along x, y, z: 0, 1, 2.
    Along(u8),
    /// Rotation about x, y, z: 0, 1, 2.
    About(u8),
}

impl Direction {
    /// Direction from its number, 1 to 6.
    pub fn of(number: u64) -> Option<Self> {
        match number {
            1..=3 => Some(Direction::Along(number as u8 - 1)),
            4..=6 => Some(Direction::About(number as u8 - 4)),
            _ => None,
        }
    }

    /// Number from 1 to 6.
    pub fn number(self) -> u8 {
        match self {
            Direction::Along(k) => k + 1,
            Direction::About(k) => k + 4,
        }
    }

    /// Whether it is a rotation.
    pub fn is_rotation(self) -> bool {
        matches!(self, Direction::About(_))
    }
}

/// A freedom: node and direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Freedom {
    /// Number of the node.
    pub node: u64,
    /// Direction.
    pub direction: Direction,
}

/// Freedoms of the rows of a matrix, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Freedoms {
    /// File they came from: that of the matrix when no map is given.
    pub file: String,
    list: Vec<Option<Freedom>>,
}

impl Freedoms {
    /// Freedoms of a matrix without a map.
    pub fn unnamed(file: &str, n: usize) -> Self {
        Self {
            file: file.to_owned(),
            list: vec![None; n],
        }
    }

    /// Known freedoms.
    pub fn of(file: &str, list: Vec<Freedom>) -> Self {
        Self {
            file: file.to_owned(),
            list: list.into_iter().map(Some).collect(),
        }
    }

    /// Those of some rows.
    ///
    /// # Panics
    /// When a row is not there.
    #[must_use]
    pub fn part(&self, rows: &[usize]) -> Self {
        Self {
            file: self.file.clone(),
            list: rows.iter().map(|&row| self.list[row]).collect(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether node and direction are known.
    pub fn are_named(&self) -> bool {
        self.list.iter().all(Option::is_some)
    }

    /// Freedom of a row.
    pub fn get(&self, row: usize) -> Option<Freedom> {
        self.list[row]
    }

    /// "node.direction", or the row where that is not known.
    pub fn name(&self, row: usize) -> String {
        match self.list.get(row).copied().flatten() {
            Some(Freedom { node, direction }) => format!("{node}.{}", direction.number()),
            None => format!("row {}", row + 1),
        }
    }

    /// Row of "node.direction"; where nothing is named, of "row", numbered from 1.
    ///
    /// # Errors
    /// E169 with the nearest names.
    pub fn find(&self, name: &str, what: &str) -> Result<usize, Faults> {
        let found = if self.are_named() {
            (0..self.len()).find(|&row| self.name(row) == name)
        } else {
            name.parse::<usize>()
                .ok()
                .filter(|row| (1..=self.len()).contains(row))
                .map(|row| row - 1)
        };
        found.ok_or_else(|| {
            let fault = Fault::of("E169", &self.file, "the freedom is not in the map")
                .what(what)
                .value(name);
            if self.are_named() {
                fault
                    .allowed("node.direction of the map, direction 1 to 6")
                    .hint(format!("near it are {}", self.near(name).join(", ")))
                    .into()
            } else {
                fault
                    .allowed(format!("a row from 1 to {}", self.len()))
                    .into()
            }
        })
    }

    /// Up to three nodes nearest to one, for a hint.
    pub(super) fn near_node(&self, node: u64) -> String {
        let mut nodes: Vec<u64> = self.list.iter().flatten().map(|f| f.node).collect();
        nodes.sort_by_key(|other| (other.abs_diff(node), *other));
        nodes.dedup();
        let near: Vec<String> = nodes.iter().take(3).map(u64::to_string).collect();
        near.join(", ")
    }

    /// Up to three names nearest to one, by node and then by direction.
    fn near(&self, name: &str) -> Vec<String> {
        let (node, direction) = name.split_once('.').unwrap_or((name, "1"));
        let node = node.parse::<u64>().unwrap_or(0);
        let direction = direction.parse::<u64>().unwrap_or(1);
        let mut rows: Vec<usize> = (0..self.len()).collect();
        rows.sort_by_key(|&row| {
            self.list[row].map(|freedom| {
                let away = u64::from(freedom.direction.number()).abs_diff(direction);
                (freedom.node.abs_diff(node), away)
            })
        });
        rows.into_iter().take(3).map(|row| self.name(row)).collect()
    }
}

/// Reads a map: a line "node.direction" for each row, as CalculiX writes it.
///
/// # Errors
/// E171 for a line of another form or a freedom given twice.
pub fn read(source: &Source) -> Result<Freedoms, Faults> {
    let (mut list, mut faults) = (Vec::new(), Faults::default());
    let mut seen: HashMap<Freedom, usize> = HashMap::new();
    for line in source.lines().filter(|line| !line.text.trim().is_empty()) {
        let fault = |message: String| {
            Fault::of("E171", &source.name, message)
                .line(line.number)
                .value(line.text.trim())
        };
        let parts = line.text.trim().split_once('.');
        let freedom = parts.and_then(|(node, direction)| {
            let node = node.parse().ok()?;
            let direction = Direction::of(direction.parse().ok()?)?;
            Some(Freedom { node, direction })
        });
        let Some(freedom) = freedom else {
            let wrong = fault("not a freedom".to_owned());
            faults.push(wrong.allowed("node.direction, direction 1 to 6, as 12.3"));
            continue;
        };
        if let Some(before) = seen.insert(freedom, line.number) {
            faults.push(fault(format!(
                "the freedom stands on line {before} already"
            )));
        }
        list.push(freedom);
    }
    faults.or(Freedoms::of(&source.name, list))
}

/// The map as text.
pub fn write(freedoms: &Freedoms) -> String {
    (0..freedoms.len())
        .map(|row| freedoms.name(row) + "\n")
        .collect()
}
