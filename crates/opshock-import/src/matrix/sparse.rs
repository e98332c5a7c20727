//! A sparse matrix stored by rows.

/// A sparse matrix stored by rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrix {
    /// File it came from.
    pub file: String,
    /// Number of rows.
    pub n_rows: usize,
    /// Number of columns.
    pub n_columns: usize,
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Matrix {
    /// Matrix from entries in any order; entries at one place are added.
    ///
    /// # Panics
    /// When an entry lies outside.
    pub fn of(file: &str, n_rows: usize, n_columns: usize, mut entries: Vec<Entry>) -> Self {
        entries.sort_by_key(|entry| (entry.row, entry.column));
        let mut matrix = Self {
            file: file.to_owned(),
            n_rows,
            n_columns,
            starts: vec![0; n_rows + 1],
            ..Self::default()
        };
        let mut last = None;
        for Entry { row, column, value } in entries {
            assert!(
                row < n_rows && column < n_columns,
                "an entry outside its matrix"
            );
            if last == Some((row, column)) {
                *matrix.values.last_mut().expect("an entry before") += value;
                continue;
            }
            last = Some((row, column));
            matrix.starts[row + 1] += 1;
            matrix.columns.push(column);
            matrix.values.push(value);
        }
        for row in 0..n_rows {
            matrix.starts[row + 1] += matrix.starts[row];
        }
        matrix
    }

    /// Columns and values of a row, by column.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        let columns = self.columns[range.clone()].iter().copied();
        columns.zip(self.values[range].iter().copied())
    }

    /// An entry; 0 where none is stored.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let range = self.starts[row]..self.starts[row + 1];
        let found = self.columns[range.clone()].binary_search(&column);
        found.map_or(0.0, |at| self.values[range.start + at])
    }

    /// Every stored entry, by row.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..self.n_rows).flat_map(move |row| {
            self.row(row)
                .map(move |(column, value)| Entry { row, column, value })
        })
    }

    /// Stored entries.
    pub fn n_entries(&self) -> usize {
        self.values.len()
    }

    /// y = A x.
    ///
    /// # Panics
    /// When lengths differ from rows and columns.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!((x.len(), y.len()), (self.n_columns, self.n_rows));
        for (row, y) in y.iter_mut().enumerate() {
            *y = self.row(row).map(|(column, value)| value * x[column]).sum();
        }
    }

    /// Every entry times a factor of its row and its column.
    #[must_use]
    pub fn scaled(mut self, factor: impl Fn(usize, usize) -> f64) -> Self {
        for row in 0..self.n_rows {
            for at in self.starts[row]..self.starts[row + 1] {
                self.values[at] *= factor(row, self.columns[at]);
            }
        }
        self
    }

    /// (A + Aᵀ)/2.
    #[must_use]
    pub fn symmetrised(self) -> Self {
        let mirrored = self.entries().flat_map(|Entry { row, column, value }| {
            let value = 0.5 * value;
            [
                Entry { row, column, value },
                Entry {
                    row: column,
                    column: row,
                    value,
                },
            ]
        });
        let entries = mirrored.collect();
        Self::of(&self.file, self.n_rows, self.n_columns, entries)
    }
}

/// An entry, with indices from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Row.
    pub row: usize,
    /// Column.
    pub column: usize,
    /// Value.
    pub value: f64,
}
