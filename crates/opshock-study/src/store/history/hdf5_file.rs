//! Writes a history as HDF5.

use super::columns::{
    Column, FIELD_COLUMNS, HISTORY_FORMAT, HistoryHeader, head_columns, root_columns,
};
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::store::error::StoreError;
use crate::store::summary::AxisValue;
use crate::store::{aside, hdf5_file, seal};
use hdf5::types::VarLenUnicode;
use hdf5::{Group, Location};
use opshock_solver::simulation::{History, Mechanism, PressureFields};
use std::path::Path;

/// Writes a history in the layout of the [module](super). Root attributes: `format` (`opshock history`),
/// `format_version`, `program_version`, `commit`, `physics_structure`, `physics_head`, `study`, `study_digest`,
/// `run_blake3` (empty outside a store), `amplitude_g`, `start_s`, `verdict`, `t_fail_s` (NaN when there is none),
/// `mechanism` (empty likewise), `effects`, and one attribute `point_KEY` per coordinate of the simulated point: a number where it is one. Every
/// dataset has `units`, `description` and `time`, the path of the dataset it is given on; every group has
/// `description`.
///
/// # Errors
///
/// E183; an existing file is then left as it was.
pub fn write_hdf5(
    path: &Path,
    history: &History,
    header: &HistoryHeader,
) -> Result<(), StoreError> {
    let bytes = hdf5_file::bytes(|root| fill(root, history, header))
        .map_err(|error| StoreError::not_made(path, &error))?;
    aside::write(path, &seal::seal(bytes))
}

fn fill(root: &Group, history: &History, header: &HistoryHeader) -> hdf5::Result<()> {
    text(root, "format", "opshock history")?;
    number(root, "format_version", HISTORY_FORMAT)?;
    text(
        root,
        "description",
        "one shock over time: all columns on the time of disk and ramp; those of the head are interpolated",
    )?;
    text(root, "program_version", &header.program_version)?;
    text(root, "commit", &header.commit)?;
    number(root, "physics_structure", PHYSICS_STRUCTURE)?;
    number(root, "physics_head", PHYSICS_HEAD)?;
    text(root, "study", &header.study)?;
    text(root, "study_digest", &header.digest)?;
    text(root, "run_blake3", &header.run)?;
    text(root, "point_ramp", &header.ramp)?;
    number(root, "point_pulse_ms", header.pulse_ms)?;
    text(root, "point_sign", header.sign.as_str())?;
    for (axis, value) in &header.axes {
        let name = format!("point_{axis}");
        match value {
            AxisValue::Number(value) => number(root, &name, *value)?,
            AxisValue::Text(value) => text(root, &name, value)?,
        }
    }
    number(root, "amplitude_g", header.amplitude_g)?;
    number(root, "start_s", header.start_s)?;
    text(root, "verdict", &header.verdict)?;
    number(root, "t_fail_s", header.t_fail_s.unwrap_or(f64::NAN))?;
    let mechanism = header.mechanism.map_or("", Mechanism::as_str);
    text(root, "mechanism", mechanism)?;
    text(root, "effects", &header.effects.join(" "))?;

    datasets(root, &root_columns(history, header.start_s), "/time_s")?;
    if !history.head.time_s.is_empty() {
        let head = root.create_group("head")?;
        text(&head, "description", "head at its own accepted steps")?;
        datasets(
            &head,
            &head_columns(&history.head, header.start_s),
            "/head/time_s",
        )?;
    }
    if let Some(fields) = &history.fields {
        write_fields(&root.create_group("fields")?, fields, header.start_s)?;
    }
    Ok(())
}

fn write_fields(group: &Group, fields: &PressureFields, start_s: f64) -> hdf5::Result<()> {
    text(group, "description", "film at the times asked for")?;
    let times: Vec<f64> = fields.time_s.iter().map(|t| t + start_s).collect();
    let cells = |lines: &[f64]| lines.len().saturating_sub(1);
    let shape = [
        times.len(),
        cells(&fields.y_lines_m),
        cells(&fields.x_lines_m),
    ];
    let columns: [&[f64]; 5] = [
        &times,
        &fields.y_lines_m,
        &fields.x_lines_m,
        &fields.pressure_pa,
        &fields.gap_m,
    ];
    for ((name, units, description), values) in FIELD_COLUMNS.into_iter().zip(columns) {
        let dataset = match name {
            "pressure_pa" | "gap_m" => {
                let dataset = group.new_dataset::<f64>().shape(shape).create(name)?;
                dataset.write_raw(values)?;
                dataset
            }
            _ => group.new_dataset_builder().with_data(values).create(name)?,
        };
        text(&dataset, "units", units)?;
        text(&dataset, "description", description)?;
    }
    Ok(())
}

fn datasets(group: &Group, columns: &[Column], time: &str) -> hdf5::Result<()> {
    for column in columns {
        let dataset = group
            .new_dataset_builder()
            .with_data(&column.values)
            .create(column.name)?;
        text(&dataset, "units", column.units)?;
        text(&dataset, "description", column.description)?;
        text(&dataset, "time", time)?;
    }
    Ok(())
}

fn text(at: &Location, name: &str, value: &str) -> hdf5::Result<()> {
    // A NUL cannot be stored; it can only come from a study's name.
    let value: VarLenUnicode = value
        .replace('\0', "")
        .parse()
        .map_err(|error| hdf5::Error::from(format!("attribute {name}: {error}")))?;
    at.new_attr::<VarLenUnicode>()
        .create(name)?
        .write_scalar(&value)
}

fn number<T: hdf5::H5Type>(at: &Location, name: &str, value: T) -> hdf5::Result<()> {
    at.new_attr::<T>().create(name)?.write_scalar(&value)
}
