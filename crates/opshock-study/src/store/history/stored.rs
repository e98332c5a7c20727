//! A kept history read back, for what is drawn from it.

use std::collections::BTreeMap;
use std::path::Path;

use hdf5::types::VarLenUnicode;

/// The columns on the time of disk and ramp, and whose they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredHistory {
    /// Coordinates of the point, as `ramp`, `pulse_ms`, `sign`.
    pub point: BTreeMap<String, String>,
    /// Amplitude without sign, G.
    pub amplitude_g: f64,
    /// `survives`, `fails`, `undecided`.
    pub verdict: String,
    /// Columns by name, in SI.
    pub columns: BTreeMap<String, Vec<f64>>,
}

/// Reads what [`write_hdf5`](super::write_hdf5) wrote.
///
/// # Errors
///
/// HDF5's, when the file is none of those.
pub fn read_hdf5(path: &Path) -> hdf5::Result<StoredHistory> {
    let file = hdf5::File::open(path)?;
    let text = |name: &str| -> hdf5::Result<String> {
        let value: VarLenUnicode = file.attr(name)?.read_scalar()?;
        Ok(value.to_string())
    };
    let mut point = BTreeMap::new();
    for name in file.attr_names()? {
        if let Some(key) = name.strip_prefix("point_") {
            point.insert(key.to_owned(), text(&name)?);
        }
    }
    let mut columns = BTreeMap::new();
    for dataset in file.datasets()? {
        let name = dataset.name();
        if dataset.ndim() == 1 {
            columns.insert(
                name.trim_start_matches('/').to_owned(),
                dataset.read_raw::<f64>()?,
            );
        }
    }
    Ok(StoredHistory {
        point,
        amplitude_g: file.attr("amplitude_g")?.read_scalar()?,
        verdict: text("verdict")?,
        columns,
    })
}
