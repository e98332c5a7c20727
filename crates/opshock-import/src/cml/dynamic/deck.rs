//! Reads a dynamic deck of version 6.4: slider, pulse, suspension, ramp and disk in 24 sections with titles.
//!
//! A line `*****Title*****` opens a section, in which a line of names is followed by one or more lines of values. A name
//! behind which more values stand than names is a list. What the names mean is known from the program's results on
//! decks written for that purpose; units are SI, those of its suspension mm, mN and kg.

use super::super::reader::Reader;
use super::contents::{Contents, DeckSuspension, DynamicFile, Ramp};
use super::layout::{self, Section, Value};
use super::values::{ANY, Values};
use crate::fault::{Fault, Faults};
use crate::matrix::MAX_ROWS;
use crate::text::Source;

/// Version that the layout belongs to.
const VERSION: &str = "6.4";

/// Titles of the sections that are read, with the names they must have.
const SECTIONS: [(&str, &[&str]); 9] = [
    (
        "problem definition",
        &[
            "xl", "yl", "xg", "yg", "zg", "f0", "xf0", "yf0", "halt", "rpm", "dt", "tf", "ra",
            "ra_if", "ra_of",
        ],
    ),
    ("suspension", &["iact", "xact", "dact", "vact", "ske"]),
    (
        "initial flying condition",
        &["hm", "hp", "hr", "dx", "dy", "yaw"],
    ),
    ("solution control", &["iqpo"]),
    ("air", &["p0", "al", "vis"]),
    (
        "shock",
        &[
            "shmod",
            "dx",
            "dy",
            "dz",
            "sttime",
            "pulsewid",
            "magnitude",
            "tconst",
        ],
    ),
    (
        "suspension modeling",
        &[
            "suspsz", "psa", "rsa", "dofs", "dofcu", "dofcd", "constat", "condist", "preload",
            "susp", "damp",
        ],
    ),
    ("ramp", &["ramp_opt", "clr", "x_ramp", "ramp_ang"]),
    ("disk", &["ri", "ro", "th", "e", "nu", "rho", "damp"]),
];

/// Titles of the sections that are not read.
pub const UNREAD: [&str; 15] = [
    "grid",
    "track profile",
    "disk topography",
    "slider topography",
    "track access",
    "disk velocity",
    "flutter",
    "intermolecular",
    "contact",
    "load/unload",
    "support",
    "motor",
    "hub",
    "housing",
    "base",
];

/// Whether a file has this layout: a title stands where the other one has a header.
pub fn is_deck(source: &Source) -> bool {
    let mut lines = source.lines().filter(|line| !line.text.trim().is_empty());
    lines
        .next()
        .is_some_and(|line| line.text.trim_start().starts_with("**"))
}

/// Reads a deck.
///
/// # Errors
/// As [`super::read()`]; E176 for an oblique shock.
pub fn read(source: &Source) -> Result<DynamicFile, Faults> {
    let mut reader = Reader::without_header(source);
    let sections = layout::split(&mut reader, SECTIONS.len() + UNREAD.len())?;
    let file = reader.file;
    let mut faults = Faults::default();
    let read = SECTIONS.map(|(title, wanted)| {
        section(file, &sections, title, wanted).unwrap_or_else(|wrong| {
            faults.append(wrong);
            Vec::new()
        })
    });
    faults.or(())?;
    let [
        problem,
        actuator,
        attitude,
        solver,
        air,
        shock,
        modeling,
        ramp,
        disk,
    ] = &read;
    let line = |title: &str| {
        let found = sections.iter().find(|section| section.title == title);
        found.map_or(1, |section| section.line)
    };
    let mut values = Values {
        file,
        faults: Faults::default(),
    };
    let length_m = values.of(problem, "xl", "m", (1e-5, 2e-2));
    let width_per_length = values.of(problem, "yl", "", (0.05, 20.0));
    let [along, across] = ["xf0", "yf0"].map(|name| values.of(problem, name, "", ANY));
    let is_vertical = values.is_vertical(shock);
    // The pulse by its order in the other layout.
    let pulse = in_order(
        shock,
        &["shmod", "sttime", "pulsewid", "magnitude", "tconst"],
    );
    let radii = in_order(disk, &["ri", "ro", "th", "e", "nu", "rho"]);
    let damping = disk.iter().filter(|value| value.name == "damp").cloned();
    let radii: Vec<Value<'_>> = radii.into_iter().chain(damping).collect();
    let read = DynamicFile {
        version: VERSION.to_owned(),
        length_m,
        width_per_length,
        centre: ["xg", "yg", "zg"].map(|name| values.of(problem, name, "", ANY)),
        load_kgf: values.of(problem, "f0", "kg", (1e-6, 0.02)),
        load_point_m: [
            (along - 0.5) * length_m,
            across * width_per_length * length_m,
        ],
        halt: values.of(problem, "halt", "", ANY),
        speed_rpm: values.of(problem, "rpm", "rpm", (1.0, 1e5)),
        step_s: values.of(problem, "dt", "s", (0.0, 1.0)),
        end_s: values.of(problem, "tf", "s", (0.0, 1e3)),
        radius_m: values.of(problem, "ra", "m", (1e-3, 0.2)),
        move_radii_m: ["ra_if", "ra_of"].map(|name| values.of(problem, name, "m", ANY)),
        actuator: ["iact", "dact", "vact"].map(|name| values.of(actuator, name, "", ANY)),
        arm_m: values.arm(actuator),
        skew_deg: values.of(actuator, "ske", "deg", (-89.0, 89.0)),
        attitude: ["hm", "hp", "hr", "dx", "dy", "yaw"]
            .map(|name| values.of(attitude, name, "", ANY)),
        gas: values.gas(air),
        shock: match is_vertical {
            true => values.shock(&pulse, line("shock")),
            false => None,
        },
        suspension: Contents::Deck(values.suspension(modeling, line("suspension modeling"))),
        disk: values.disk(&radii, line("disk")),
        ramp: Ramp {
            distance_m: values.of(ramp, "x_ramp", "m", (1e-3, 0.3)),
            angle_deg: values.of(ramp, "ramp_ang", "deg", (-90.0, 90.0)),
            clearance_m: values.of(ramp, "clr", "m", (0.0, 2e-3)),
            sides: values.count(ramp, "ramp_opt", (0, 2)),
        },
    };
    values.flow(solver);
    values.faults.or(read)
}

/// Values of the section of a title, which has all the names `wanted`.
fn section<'a>(
    file: &str,
    sections: &[Section<'a>],
    title: &str,
    wanted: &[&str],
) -> Result<Vec<Value<'a>>, Faults> {
    let Some(section) = sections.iter().find(|section| section.title == title) else {
        let titles: Vec<&str> = sections.iter().map(|other| other.title.as_str()).collect();
        return Err(
            Fault::of("E173", file, format!("there is no section \"{title}\""))
                .what("sections")
                .value(titles.join(", "))
                .allowed(title)
                .into(),
        );
    };
    let values = layout::lists(section);
    let lacking: Vec<&str> = wanted
        .iter()
        .copied()
        .filter(|name| values.iter().all(|value| value.name != *name))
        .collect();
    if lacking.is_empty() {
        return Ok(values);
    }
    Err(Fault::of("E175", file, "values are missing in the section")
        .line(section.line)
        .what(title)
        .value(format!("it lacks {}", lacking.join(", ")))
        .allowed(wanted.join(" "))
        .into())
}

/// The first value of each name.
fn in_order<'a>(section: &[Value<'a>], names: &[&str]) -> Vec<Value<'a>> {
    let of = |name: &&str| section.iter().find(|value| value.name == *name).cloned();
    names.iter().filter_map(of).collect()
}

impl Values<'_> {
    /// Whether the shock acts along the disk's axis; E176 where it does not.
    fn is_vertical(&mut self, section: &[Value<'_>]) -> bool {
        let [x, y, z] = ["dx", "dy", "dz"].map(|name| self.of(section, name, "", ANY));
        if x == 0.0 && y == 0.0 && z > 0.0 {
            return true;
        }
        let fault = Fault::of("E176", self.file, "the shock is not along the disk's axis");
        let first = section.iter().find(|value| value.name == "dx");
        let fault = match first {
            Some(value) => fault.at(value.word.place()),
            None => fault,
        };
        self.faults.push(
            fault
                .what("dx, dy, dz")
                .value(format!("{x}, {y}, {z}"))
                .allowed("0, 0, 1; the sense is that of the magnitude")
                .hint("import it so, and give the study pulse.in_plane_x, in_plane_y"),
        );
        false
    }

    /// Freedoms of slider and dimple, contacts, damping.
    fn suspension(&mut self, section: &[Value<'_>], line: usize) -> DeckSuspension {
        let all = |name: &str| {
            section
                .iter()
                .filter(move |value| value.name == name)
                .collect::<Vec<_>>()
        };
        let n_rows = self.count(section, "suspsz", (1, MAX_ROWS));
        let mut row = |value: &Value<'_>| {
            let found = value.word.count().filter(|row| (1..=n_rows).contains(row));
            if found.is_none() {
                let fault = Fault::of("E174", self.file, "not a freedom of the suspension");
                self.faults.push(
                    fault
                        .at(value.word.place())
                        .what(value.name.as_str())
                        .value(value.word.text)
                        .allowed(format!("1 to {n_rows}, as suspsz says")),
                );
            }
            found.unwrap_or(1)
        };
        let mut slider_rows = [0; 6];
        for (slider_row, value) in slider_rows.iter_mut().zip(all("dofs")) {
            *slider_row = row(value);
        }
        let ends: Vec<[usize; 2]> = all("dofcu")
            .into_iter()
            .zip(all("dofcd"))
            .map(|(up, down)| [row(up), row(down)])
            .collect();
        let mut suspension = DeckSuspension {
            n_rows,
            slider_rows,
            dimple_row: 0,
            preload_n: 0.0,
            limiters_m: Vec::new(),
            static_angles_rad: ["psa", "rsa"].map(|name| self.of(section, name, "rad", ANY)),
            alpha_per_s: self.of(section, "susp", "1/s", (0.0, 1e5)),
            beta_s: self.of(section, "damp", "s", (0.0, 1e-3)),
        };
        let z = slider_rows[2];
        let rest = all("constat")
            .into_iter()
            .zip(all("condist"))
            .zip(all("preload"));
        for (ends, ((state, gap), preload)) in ends.into_iter().zip(rest) {
            let other = match ends {
                [up, down] if down == z => up,
                [up, down] if up == z => down,
                // Not between slider and suspension.
                _ => continue,
            };
            match state.word.count() {
                Some(1) => {
                    suspension.dimple_row = other;
                    suspension.preload_n = 1e-3 * self.at(preload, "preload", "mN", (0.0, 1e3));
                }
                _ => {
                    let gap_m = 1e-3 * self.at(gap, "condist", "mm", (0.0, 10.0));
                    suspension.limiters_m.push(gap_m);
                }
            }
        }
        if all("dofs").len() < 6 || suspension.dimple_row == 0 {
            let fault = Fault::of("E175", self.file, "the slider's freedoms are not all given");
            self.faults.push(
                fault
                    .line(line)
                    .what("dofs, dofcu, dofcd, constat")
                    .value(format!("{} freedoms, {} contacts", all("dofs").len(), all("dofcu").len()))
                    .allowed("six freedoms of the slider, and a closed contact (constat 1) of its third one, the dimple"),
            );
        }
        suspension
    }
}
