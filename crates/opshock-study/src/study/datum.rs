//! One value of a key of the study file.

/// One value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// Number, in the unit of its key.
    Number(f64),
    /// Whole number.
    Integer(i64),
    /// Word out of the key's list.
    Word(String),
    /// true or false.
    Flag(bool),
    /// Free text.
    Text(String),
    /// Words.
    Words(Vec<String>),
    /// Numbers.
    Numbers(Vec<f64>),
    /// From and to.
    Pair([f64; 2]),
    /// Corners.
    Points(Vec<[f64; 2]>),
    /// Number of entries of a list of tables.
    Entries(usize),
}
