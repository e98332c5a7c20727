//! Reads the values of `DynLULS.def`, each within its range.

use super::super::reader::Reader;
use super::contents::{Contents, DynamicFile, Matrices, Ramp};
use super::deck;
use super::layout::{self, Value};
use super::values::{ANY, Values};
use crate::fault::Faults;
use crate::text::Source;

/// Reads a file.
///
/// # Errors
/// E160 and E173 for another header, version or number of sections; E174 for words that are no numbers; E175
/// for sections without their names, names without values, and values outside what is allowed; E176 for a
/// pulse given by a table.
pub fn read(source: &Source) -> Result<DynamicFile, Faults> {
    if deck::is_deck(source) {
        return deck::read(source);
    }
    let (mut reader, version) = Reader::of_any(source)?;
    let sections = layout::split(&mut reader, layout::SECTIONS.len())?;
    let file = reader.file;
    let mut faults = Faults::default();
    let mut section = |at: usize| match layout::values(file, &sections, at) {
        Ok(values) => values,
        Err(wrong) => {
            faults.append(wrong);
            Vec::new()
        }
    };
    let named = [
        layout::PROBLEM,
        layout::ACTUATOR,
        layout::ATTITUDE,
        layout::SOLVER,
        layout::DISK,
        layout::SHOCK,
    ];
    let [problem, actuator, attitude, solver, disk, shock] = named.map(&mut section);
    // What is missing in one section is reported with what is missing in the others, before any value.
    faults.or(())?;
    let optional = |at: usize| layout::values(file, &sections, at).unwrap_or_default();
    let (air, matrices) = (optional(layout::AIR), optional(layout::MATRICES));
    let mut values = Values {
        file,
        faults: Faults::default(),
    };
    let read = DynamicFile {
        version,
        length_m: values.of(&problem, "xl", "m", (1e-5, 2e-2)),
        width_per_length: values.of(&problem, "yl/xl", "", (0.05, 20.0)),
        centre: ["xg", "yg", "zg"].map(|name| values.of(&problem, name, "", ANY)),
        load_kgf: values.of(&problem, "f0", "kg", (1e-6, 0.02)),
        load_point_m: ["xf0", "yf0"].map(|name| values.of(&problem, name, "m", ANY)),
        halt: values.of(&problem, "halt", "", ANY),
        speed_rpm: values.of(&problem, "rpm", "rpm", (1.0, 1e5)),
        step_s: values.of(&problem, "dt", "s", (0.0, 1.0)),
        end_s: values.of(&problem, "tf", "s", (0.0, 1e3)),
        radius_m: values.of(&problem, "ra", "m", (1e-3, 0.2)),
        move_radii_m: ["ra_if", "ra_of"].map(|name| values.of(&problem, name, "m", ANY)),
        actuator: ["iact", "dact", "vact"].map(|name| values.of(&actuator, name, "", ANY)),
        arm_m: values.arm(&actuator),
        skew_deg: values.of(&actuator, "skew", "deg", (-89.0, 89.0)),
        attitude: ["hm", "hp", "hr", "dx", "dy", "yaw"]
            .map(|name| values.of(&attitude, name, "", ANY)),
        gas: values.gas(&air),
        shock: values.shock(&shock, sections[layout::SHOCK].line),
        suspension: matrices_of(&matrices).map_or(Contents::Unknown, Contents::Suspension),
        disk: values.disk(&disk, sections[layout::DISK].line),
        ramp: Ramp {
            distance_m: values.of(&disk, "x_ramp", "m", (1e-3, 0.3)),
            angle_deg: values.of(&disk, "ramp_ang", "deg", (-90.0, 90.0)),
            clearance_m: values.of(&disk, "ramp_clr", "m", (0.0, 2e-3)),
            sides: 2,
        },
    };
    values.flow(&solver);
    values.faults.or(read)
}

/// Whole numbers at the start of the section, its step's share between them.
fn matrices_of(values: &[Value<'_>]) -> Option<Matrices> {
    let [n_rows, _, slider_row, ..] = values else {
        return None;
    };
    let count = |value: &Value<'_>| value.word.count().filter(|n| (1..=1_000_000).contains(n));
    let (n_rows, slider_row) = (count(n_rows)?, count(slider_row)?);
    (slider_row <= n_rows).then_some(Matrices { n_rows, slider_row })
}
