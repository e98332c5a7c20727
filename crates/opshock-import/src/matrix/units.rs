//! Sets of units of imported matrices, and their conversion into SI.
//!
//! With lengths in L metres and forces in F newtons, the scale s of a row is 1 for a displacement and L for a rotation:
//! K_SI = (F/L) s_i s_j K, and the same for M, as all sets use seconds.

use super::dof::Freedoms;
use super::sparse::Matrix;

/// A consistent set of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// N, m, kg, s.
    Si,
    /// mN, mm, kg, s: the suspension files of the CML family.
    MillimetreMillinewton,
    /// N, mm, t, s: most finite-element models.
    MillimetreNewton,
}

impl Units {
    /// Every set by its word.
    pub const WORDS: [(&'static str, Units); 3] = [
        ("si", Units::Si),
        ("mm_mn", Units::MillimetreMillinewton),
        ("mm_n", Units::MillimetreNewton),
    ];

    /// Metres of a length, newtons of a force.
    fn scales(self) -> (f64, f64) {
        match self {
            Units::Si => (1.0, 1.0),
            Units::MillimetreMillinewton => (1e-3, 1e-3),
            Units::MillimetreNewton => (1e-3, 1.0),
        }
    }

    /// Its word.
    pub fn word(self) -> &'static str {
        Self::WORDS
            .iter()
            .find(|(_, units)| *units == self)
            .map_or("", |(word, _)| word)
    }

    /// A matrix in SI units. Rows without known freedoms are taken as displacements.
    #[must_use]
    pub fn to_si(self, matrix: Matrix, freedoms: &Freedoms) -> Matrix {
        let (length, force) = self.scales();
        let arm = |row: usize| match freedoms.get(row) {
            Some(freedom) if freedom.direction.is_rotation() => length,
            _ => 1.0,
        };
        matrix.scaled(|row, column| force / length * arm(row) * arm(column))
    }
}
