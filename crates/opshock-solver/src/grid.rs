//! Describes graded tensor grids by their lines: cells, faces, spacing.
//!
//! A [`Lines`] is a strictly rising list of grid lines; cells lie between neighbours, their
//! centres half way. Lines of a tensor grid run through every edge they are given, and between two
//! edges cells grow away from those ends that ask for fine cells.

/// Grid lines of one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    lines: Vec<f64>,
}

impl Lines {
    /// Lines as given; `None` unless at least two and strictly rising.
    pub fn new(lines: Vec<f64>) -> Option<Self> {
        let rising = lines.windows(2).all(|w| w[0] < w[1]) && lines.iter().all(|x| x.is_finite());
        (lines.len() >= 2 && rising).then_some(Self { lines })
    }

    /// Number of cells.
    pub fn n_cells(&self) -> usize {
        self.lines.len() - 1
    }

    /// All lines, one more than cells.
    pub fn as_slice(&self) -> &[f64] {
        &self.lines
    }

    /// Centre of cell `i`.
    pub fn centre(&self, i: usize) -> f64 {
        0.5 * (self.lines[i] + self.lines[i + 1])
    }

    /// Width of cell `i`.
    pub fn width(&self, i: usize) -> f64 {
        self.lines[i + 1] - self.lines[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_must_rise() {
        assert!(Lines::new(vec![0.0]).is_none());
        assert!(Lines::new(vec![0.0, 1.0, 1.0]).is_none());
        assert!(Lines::new(vec![0.0, f64::NAN]).is_none());
        let lines = Lines::new(vec![1.0, 1.5, 2.0, 2.5, 3.0]).unwrap();
        assert_eq!(
            (lines.n_cells(), lines.centre(1), lines.width(3)),
            (4, 1.75, 0.5)
        );
    }
}
