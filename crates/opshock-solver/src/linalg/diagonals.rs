//! Stores square matrices with few diagonals, such as those of a balance over a grid of cells.

/// How far a matrix reaches on either side of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band {
    /// Entries of a row before the diagonal.
    pub below: usize,
    /// Entries of a row behind the diagonal.
    pub above: usize,
}

impl Band {
    /// As far on either side.
    pub fn even(half_bandwidth: usize) -> Self {
        Self {
            below: half_bandwidth,
            above: half_bandwidth,
        }
    }

    /// As far to the other side.
    pub(super) fn reversed(self) -> Self {
        Self {
            below: self.above,
            above: self.below,
        }
    }

    /// Entries of a row.
    pub(super) fn width(self) -> usize {
        self.below + 1 + self.above
    }
}

/// Square matrix that is zero beside a few diagonals; each is a column of numbers, by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagonals {
    n: usize,
    /// j − i of every diagonal, rising.
    offsets: Vec<isize>,
    /// Entry (i, i + offset) at place i. Places outside the matrix are not looked at.
    columns: Vec<Vec<f64>>,
}

impl Diagonals {
    /// Zero matrix of `n` rows with entries at j − i in `offsets`, which may repeat.
    pub fn zeros(n: usize, mut offsets: Vec<isize>) -> Self {
        offsets.sort_unstable();
        offsets.dedup();
        Self {
            n,
            columns: vec![vec![0.0; n]; offsets.len()],
            offsets,
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// How far the diagonals reach to either side of the main one.
    pub fn band(&self) -> Band {
        let reach = |side: isize| {
            let offsets = self.offsets.iter().map(|offset| offset * side);
            offsets.max().unwrap_or(0).max(0).unsigned_abs()
        };
        Band {
            below: reach(-1),
            above: reach(1),
        }
    }

    /// j − i of every diagonal, rising.
    pub fn offsets(&self) -> &[isize] {
        &self.offsets
    }

    /// The diagonal at j − i = `offset`: entry (i, i + offset) at place i.
    pub fn column(&self, offset: isize) -> Option<&[f64]> {
        let place = self.offsets.binary_search(&offset).ok()?;
        Some(&self.columns[place])
    }

    /// The same, to be written.
    pub fn column_mut(&mut self, offset: isize) -> Option<&mut [f64]> {
        let place = self.offsets.binary_search(&offset).ok()?;
        Some(&mut self.columns[place])
    }

    /// All diagonals with their offsets.
    pub fn iter(&self) -> impl Iterator<Item = (isize, &[f64])> {
        let columns = self.columns.iter().map(Vec::as_slice);
        self.offsets.iter().copied().zip(columns)
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        for column in &mut self.columns {
            column.fill(0.0);
        }
    }

    /// Entry (i, j); zero beside the diagonals.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let offset = j as isize - i as isize;
        self.column(offset).map_or(0.0, |column| column[i])
    }

    /// Adds `value` to entry (i, j).
    ///
    /// # Panics
    ///
    /// When (i, j) lies outside the matrix or beside its diagonals.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        assert!(
            i < self.n && j < self.n,
            "entry ({i}, {j}) of {} rows",
            self.n
        );
        let column = self.column_mut(j as isize - i as isize);
        column.expect("an entry on a diagonal")[i] += value;
    }

    /// Rows whose entry at `offset` lies inside the matrix.
    pub fn rows(&self, offset: isize) -> std::ops::Range<usize> {
        let n = self.n;
        let first = (-offset).max(0).unsigned_abs().min(n);
        let behind = n.saturating_sub(offset.max(0).unsigned_abs());
        first..behind.max(first)
    }

    /// Aᵀ.
    pub fn transposed(&self) -> Self {
        let mut out = Self::zeros(self.n, self.offsets.iter().map(|offset| -offset).collect());
        for (offset, column) in self.iter() {
            let to = out.column_mut(-offset).expect("every offset turned round");
            for i in self.rows(offset) {
                to[i.strict_add_signed(offset)] = column[i];
            }
        }
        out
    }

    /// out = A x.
    ///
    /// # Panics
    ///
    /// When a slice has not n entries.
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        assert_eq!(x.len(), self.n);
        assert_eq!(out.len(), self.n);
        out.fill(0.0);
        for (offset, column) in self.iter() {
            let rows = self.rows(offset);
            if rows.is_empty() {
                continue;
            }
            let x = &x[rows.start.strict_add_signed(offset)..];
            for ((out, a), x) in out[rows.clone()].iter_mut().zip(&column[rows]).zip(x) {
                *out += a * x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries 10 i + j on diagonals of which one lies outside altogether.
    fn sample() -> Diagonals {
        let mut matrix = Diagonals::zeros(4, vec![1, -2, 0, 1, 5]);
        for (i, j) in [
            (0, 0),
            (0, 1),
            (1, 1),
            (1, 2),
            (2, 0),
            (2, 2),
            (2, 3),
            (3, 1),
            (3, 3),
        ] {
            matrix.add(i, j, (10 * i + j) as f64);
        }
        matrix
    }

    #[test]
    fn product_and_transpose_are_those_of_the_full_matrix() {
        let matrix = sample();
        assert_eq!(matrix.offsets(), [-2, 0, 1, 5]);
        assert_eq!(matrix.band(), Band { below: 2, above: 5 });
        let x = [1.0, 10.0, 100.0, 1000.0];
        let mut out = [f64::NAN; 4];
        matrix.multiply(&x, &mut out);
        // Rows (0 1 . .), (. 11 12 .), (20 . 22 23), (. 31 . 33).
        assert_eq!(out, [10.0, 1310.0, 25_220.0, 33_310.0]);
        let transposed = matrix.transposed();
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            assert_eq!(transposed.get(j, i), matrix.get(i, j), "{i} {j}");
        }
        assert_eq!(matrix.get(2, 3), 23.0);
        assert_eq!(matrix.get(3, 0), 0.0);
    }
}
