//! Columns of a table in HDF5: one dataset each, with its unit and what it is.

use std::borrow::Cow;

use hdf5::types::VarLenUnicode;
use hdf5::{Group, H5Type, Location};

/// Values of a column.
#[derive(Clone, Debug)]
pub(super) enum Values {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Whole numbers.
    Counts(Vec<u64>),
    /// Points of the amplitude grid.
    Nodes(Vec<i32>),
    /// Words.
    Texts(Vec<String>),
}

/// A column.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub name: String,
    pub units: &'static str,
    /// What it is, as written to the attribute `description`.
    pub description: Text,
    pub values: Values,
}

/// A sentence, of the program or put together.
pub(super) type Text = Cow<'static, str>;

/// Column of numbers.
pub(super) fn numbers<'a, T: 'a>(
    name: &str,
    units: &'static str,
    description: impl Into<Text>,
    rows: impl IntoIterator<Item = &'a T>,
    of: impl Fn(&T) -> Option<f64>,
) -> Column {
    let values = rows
        .into_iter()
        .map(|row| of(row).unwrap_or(f64::NAN))
        .collect();
    Column {
        name: name.to_owned(),
        units,
        description: description.into(),
        values: Values::Numbers(values),
    }
}

/// Column of whole numbers.
pub(super) fn counts<'a, T: 'a>(
    name: &str,
    description: impl Into<Text>,
    rows: impl IntoIterator<Item = &'a T>,
    of: impl Fn(&T) -> u64,
) -> Column {
    Column {
        name: name.to_owned(),
        units: "1",
        description: description.into(),
        values: Values::Counts(rows.into_iter().map(of).collect()),
    }
}

/// Column of words.
pub(super) fn texts<'a, T: 'a>(
    name: &str,
    description: impl Into<Text>,
    rows: impl IntoIterator<Item = &'a T>,
    of: impl Fn(&T) -> String,
) -> Column {
    Column {
        name: name.to_owned(),
        units: "text",
        description: description.into(),
        values: Values::Texts(rows.into_iter().map(of).collect()),
    }
}

/// Makes a group and says what it is.
pub(super) fn group(parent: &Group, name: &str, description: &str) -> hdf5::Result<Group> {
    let group = parent.create_group(name)?;
    put_text(&group, "description", description)?;
    Ok(group)
}

/// Writes columns into a group.
pub(super) fn write(group: &Group, columns: &[Column]) -> hdf5::Result<()> {
    for Column {
        name,
        units,
        description,
        values,
    } in columns
    {
        let dataset = match values {
            Values::Numbers(values) => dataset(group, name, values)?,
            Values::Counts(values) => dataset(group, name, values)?,
            Values::Nodes(values) => dataset(group, name, values)?,
            Values::Texts(values) => {
                let values: Vec<VarLenUnicode> = values
                    .iter()
                    .map(|text| unicode(text))
                    .collect::<Result<_, _>>()?;
                dataset(group, name, &values)?
            }
        };
        put_text(&dataset, "units", units)?;
        put_text(&dataset, "description", description)?;
    }
    Ok(())
}

fn dataset<T: H5Type>(group: &Group, name: &str, values: &[T]) -> hdf5::Result<hdf5::Dataset> {
    group.new_dataset_builder().with_data(values).create(name)
}

/// Writes a text attribute.
pub(super) fn put_text(at: &Location, name: &str, value: &str) -> hdf5::Result<()> {
    at.new_attr::<VarLenUnicode>()
        .create(name)?
        .write_scalar(&unicode(value)?)
}

/// Writes a number as attribute.
pub(super) fn put_number<T: H5Type>(at: &Location, name: &str, value: T) -> hdf5::Result<()> {
    at.new_attr::<T>().create(name)?.write_scalar(&value)
}

/// Reads a text attribute.
pub(super) fn get_text(at: &Location, name: &str) -> hdf5::Result<String> {
    at.attr(name)?
        .read_scalar::<VarLenUnicode>()
        .map(|text| text.as_str().to_owned())
}

/// Reads a number attribute.
pub(super) fn get_number<T: H5Type>(at: &Location, name: &str) -> hdf5::Result<T> {
    at.attr(name)?.read_scalar()
}

/// Reads a column of plain values.
pub(super) fn get<T: H5Type>(group: &Group, name: &str) -> hdf5::Result<Vec<T>> {
    group.dataset(name)?.read_raw()
}

/// Reads a column of words.
pub(super) fn get_texts(group: &Group, name: &str) -> hdf5::Result<Vec<String>> {
    let texts: Vec<VarLenUnicode> = get(group, name)?;
    Ok(texts.iter().map(|text| text.as_str().to_owned()).collect())
}

/// HDF5 text ends at a NUL; a panic's message could hold one.
fn unicode(text: &str) -> hdf5::Result<VarLenUnicode> {
    text.replace('\0', "\u{fffd}")
        .parse()
        .map_err(|error| hdf5::Error::from(format!("text: {error}")))
}
