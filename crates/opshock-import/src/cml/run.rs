//! Reads and writes `run.dat`, the settings of static runs of the CMLAir family.
//!
//! Two lines of header, then sections that a line of asterisks opens. In a section a line of names is followed by a
//! line of values. After `irad irpm ialt` come the radii, their skews, the speeds and the altitudes, a line each. Read
//! are places and speeds, the gas, the load, the slip model, and the forces between slider and disk other than the
//! air's. The rest are settings of another solver.
//!
//! `A` and `B` are short enough to name anything, so they are read only beside `icmodel`.

use super::reader::{Reader, within};
use crate::fault::{Fault, Faults};
use crate::text::{Line, NotANumber, Source, Word};
use std::collections::HashMap;

/// Static flights requested by a file.
#[derive(Clone, Debug, PartialEq)]
pub struct RunFile {
    /// Version of the format.
    pub version: String,
    /// Radii, m.
    pub radii_m: Vec<f64>,
    /// Skew at each radius, deg.
    pub skews_deg: Vec<f64>,
    /// Speeds, rev/min.
    pub speeds_rpm: Vec<f64>,
    /// Altitudes, m.
    pub altitudes_m: Vec<f64>,
    /// Ambient pressure, Pa.
    pub pressure_pa: f64,
    /// Mean free path, m.
    pub mean_free_path_m: f64,
    /// Viscosity, Pa s.
    pub viscosity_pa_s: f64,
    /// Load, kg of force.
    pub load_kgf: f64,
    /// Point of the load from the slider's centre, m; 0 where not given.
    pub load_point_m: [f64; 2],
    /// Static pitch and roll angles of the suspension, rad; 0 where not given.
    pub static_angles_rad: [f64; 2],
    /// Slip model.
    pub slip: Slip,
    /// Contact model; 0 for none.
    pub contact_model: usize,
    /// Hamaker's constant A of the attraction A/(6 π h³) per area, J; 0 for none.
    pub hamaker_j: f64,
    /// Constant B of the repulsion B/(45 π h⁹) per area, J m⁶; 0 for none.
    pub repulsion_j_m6: f64,
    /// Potential difference of slider and disk, V; 0 for none.
    pub potential_v: f64,
}

/// Range of pressures that are read.
pub(super) const PRESSURE_PA: (f64, f64) = (1e3, 1e6);
/// Range of mean free paths that are read.
pub(super) const MEAN_FREE_PATH_M: (f64, f64) = (1e-9, 1e-5);
/// Range of viscosities that are read.
pub(super) const VISCOSITY_PA_S: (f64, f64) = (1e-6, 1e-3);

/// Rarefaction model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slip {
    /// First-order slip.
    First,
    /// Second-order slip.
    Second,
    /// Fukui and Kaneko.
    FukuiKaneko,
}

/// Names with their values.
type Settings<'a> = HashMap<String, (Word<'a>, usize)>;

/// Reads a file.
///
/// # Errors
/// E160, E173 as [`super::rail::read`]; E174 for words that are no numbers; E175 for names without a
/// value, settings that are missing, and values outside what is allowed.
pub fn read(source: &Source) -> Result<RunFile, Faults> {
    let (mut reader, version) = Reader::of(source)?;
    let sections = sections(&mut reader)?;
    let mut settings = Settings::new();
    let mut lists: Option<(usize, Vec<Line<'_>>)> = None;
    for section in &sections {
        let behind = name_values(&reader, section, &mut settings)?;
        if let Some(line) = behind {
            lists = Some((
                line,
                section
                    .iter()
                    .copied()
                    .filter(|l| l.number > line)
                    .collect(),
            ));
        }
    }
    let mut faults = std::mem::take(&mut reader.faults);
    let file = flights(&reader, &settings, lists, version, &mut faults);
    match file {
        Ok(file) => faults.or(file),
        Err(last) => {
            faults.append(last);
            Err(faults)
        }
    }
}

/// Lines between lines of asterisks.
fn sections<'a>(reader: &mut Reader<'a>) -> Result<Vec<Vec<Line<'a>>>, Faults> {
    let mut sections: Vec<Vec<Line<'a>>> = Vec::new();
    for line in reader.lines.by_ref() {
        if line.text.trim_start().starts_with("**") {
            sections.push(Vec::new());
        } else if let Some(section) = sections.last_mut() {
            section.push(line);
        }
    }
    if sections.is_empty() {
        return Err(reader.cut_short("its first section, a line of asterisks"));
    }
    Ok(sections)
}

pub(super) fn is_numeric(word: &Word<'_>) -> bool {
    !matches!(word.real(), Err(NotANumber::Word))
        || word
            .text
            .starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// A name without its unit.
fn plain(word: &Word<'_>) -> String {
    word.text
        .split('(')
        .next()
        .unwrap_or_default()
        .to_lowercase()
}

/// Pairs names with values. Returns the number of the line of values of `irad`, where it is here.
fn name_values<'a>(
    reader: &Reader<'_>,
    section: &[Line<'a>],
    settings: &mut Settings<'a>,
) -> Result<Option<usize>, Faults> {
    let mut behind = None;
    let mut lines = section.iter().peekable();
    while let Some(line) = lines.next() {
        let names: Vec<Word<'a>> = line.words().collect();
        // Numbers after a line of values: lists, grids.
        if names.first().is_none_or(is_numeric) {
            continue;
        }
        let wanted = names
            .iter()
            .any(|name| WANTED.contains(&plain(name).as_str()));
        let Some(values) =
            lines.next_if(|next| next.words().next().is_some_and(|w| is_numeric(&w)))
        else {
            if wanted {
                return Err(
                    Fault::of("E175", reader.file, "names without a line of values")
                        .line(line.number)
                        .value(line.text.trim())
                        .allowed("a line of values behind a line of names")
                        .into(),
                );
            }
            continue;
        };
        let words: Vec<Word<'a>> = values.words().collect();
        let is_contact = names.iter().any(|name| plain(name) == "icmodel");
        if wanted && words.len() < names.len() {
            return Err(Fault::of("E175", reader.file, "fewer values than names")
                .line(values.number)
                .value(format!("{} values", words.len()))
                .allowed(format!("{}: {}", names.len(), line.text.trim()))
                .into());
        }
        for (name, word) in names.iter().zip(words) {
            let name = plain(name);
            if name == "irad" {
                behind = Some(values.number);
            }
            if BESIDE_CONTACT.contains(&name.as_str()) && !is_contact {
                continue;
            }
            settings.entry(name).or_insert((word, values.number));
        }
    }
    Ok(behind)
}

/// Names that are read.
const WANTED: [&str; 15] = [
    "irad", "irpm", "ialt", "p0", "al", "vis", "f0", "xf0", "yf0", "psa", "rsa", "imodel",
    "icmodel", "usestiff", "elecpot",
];

/// Names that are read where the line also has `icmodel`.
const BESIDE_CONTACT: [&str; 2] = ["a", "b"];

fn flights(
    reader: &Reader<'_>,
    settings: &Settings<'_>,
    lists: Option<(usize, Vec<Line<'_>>)>,
    version: String,
    faults: &mut Faults,
) -> Result<RunFile, Faults> {
    let file = reader.file;
    let missing = |name: &str| {
        Faults::from(
            Fault::of("E175", file, "the setting is missing")
                .what(name)
                .allowed("a value"),
        )
    };
    let Some((line, lists)) = lists else {
        return Err(missing("irad"));
    };
    let count = |name: &str| -> Result<usize, Faults> {
        let (word, _) = settings.get(name).ok_or_else(|| missing(name))?;
        word.count().filter(|n| *n <= 100).ok_or_else(|| {
            let fault = Fault::of("E174", file, "not a count")
                .at(word.place())
                .what(name);
            fault
                .value(word.text)
                .allowed("a whole number up to 100")
                .into()
        })
    };
    let [n_radii, n_speeds, n_altitudes] = [count("irad")?, count("irpm")?, count("ialt")?];
    for (name, n) in [("irad", n_radii), ("irpm", n_speeds)] {
        if n == 0 {
            return Err(Fault::of("E175", file, "no flight is asked for")
                .line(line)
                .what(name)
                .value("0")
                .allowed("1 or more")
                .into());
        }
    }
    // Lines of names between the lists are titles.
    let mut rows = lists
        .iter()
        .map(|line| line.words().collect::<Vec<_>>())
        .filter(|words| words.first().is_some_and(is_numeric));
    let mut list =
        |name: &str, n: usize, unit: &str, range: (f64, f64)| -> Result<Vec<f64>, Faults> {
            if n == 0 {
                return Ok(Vec::new());
            }
            let words = rows.next().unwrap_or_default();
            if words.len() != n {
                let at = words.first().map_or(line, |word| word.line);
                return Err(Fault::of("E175", file, "not the declared number of values")
                    .line(at)
                    .what(name)
                    .value(format!("{} values", words.len()))
                    .allowed(n.to_string())
                    .into());
            }
            let values = words
                .iter()
                .map(|word| within(file, word, name, unit, range, faults));
            Ok(values.collect())
        };
    let radii_m = list("radii", n_radii, "m", (1e-3, 0.2))?;
    let skews_deg = list("skews", n_radii, "deg", (-89.0, 89.0))?;
    let speeds_rpm = list("speeds", n_speeds, "rpm", (1.0, 1e5))?;
    let altitudes_m = list("altitudes", n_altitudes, "m", (-500.0, 12_000.0))?;
    let mut number =
        |name: &str, unit: &str, range: (f64, f64), needed: bool| -> Result<f64, Faults> {
            match settings.get(name) {
                Some((word, _)) => Ok(within(file, word, name, unit, range, faults)),
                None if needed => Err(missing(name)),
                None => Ok(0.0),
            }
        };
    let any = (-1e9, 1e9);
    let pressure_pa = number("p0", "Pa", PRESSURE_PA, true)?;
    let mean_free_path_m = number("al", "m", MEAN_FREE_PATH_M, true)?;
    let viscosity_pa_s = number("vis", "Pa s", VISCOSITY_PA_S, true)?;
    let load_kgf = number("f0", "kg", (1e-6, 0.02), true)?;
    let load_point_m = [
        number("xf0", "m", any, false)?,
        number("yf0", "m", any, false)?,
    ];
    let static_angles_rad = [
        number("psa", "rad", any, false)?,
        number("rsa", "rad", any, false)?,
    ];
    let hamaker_j = number("a", "J", (0.0, 1e-15), false)?;
    let repulsion_j_m6 = number("b", "J m6", (0.0, 1e-60), false)?;
    let potential_v = number("elecpot", "V", (-1e3, 1e3), false)?;
    if repulsion_j_m6 > 0.0 && hamaker_j == 0.0 {
        let fault = Fault::of("E175", file, "a repulsion without an attraction").what("B");
        let fault = match settings.get("b") {
            Some((word, _)) => fault.at(word.place()).value(word.text),
            None => fault,
        };
        faults.push(fault.allowed("B beside an A above 0, or 0"));
    }
    let slip = match count("imodel")? {
        1 => Slip::First,
        2 => Slip::Second,
        3 => Slip::FukuiKaneko,
        other => {
            let (word, _) = settings["imodel"];
            return Err(Fault::of("E175", file, "no such slip model")
                .at(word.place())
                .what("imodel")
                .value(other.to_string())
                .allowed("1 first order, 2 second order, 3 Fukui-Kaneko")
                .into());
        }
    };
    let contact_model = if settings.contains_key("icmodel") {
        count("icmodel")?
    } else {
        0
    };
    Ok(RunFile {
        version,
        radii_m,
        skews_deg,
        speeds_rpm,
        altitudes_m,
        pressure_pa,
        mean_free_path_m,
        viscosity_pa_s,
        load_kgf,
        load_point_m,
        static_angles_rad,
        slip,
        contact_model,
        hamaker_j,
        repulsion_j_m6,
        potential_v,
    })
}

/// The file with what is read here, every digit.
pub fn write(file: &RunFile) -> String {
    let row = |values: &[f64]| {
        let words: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
        words.join(" ")
    };
    let stars = "*".repeat(40);
    let model = match file.slip {
        Slip::First => 1,
        Slip::Second => 2,
        Slip::FukuiKaneko => 3,
    };
    let mut lines = vec![
        format!("CML Version {} run file", file.version),
        "written by opshock".to_owned(),
        stars.clone(),
        "irad irpm ialt sort".to_owned(),
        format!(
            "{} {} {} 0",
            file.radii_m.len(),
            file.speeds_rpm.len(),
            file.altitudes_m.len()
        ),
    ];
    for list in [
        &file.radii_m,
        &file.skews_deg,
        &file.speeds_rpm,
        &file.altitudes_m,
    ] {
        if !list.is_empty() {
            lines.push(row(list));
        }
    }
    let gas = [file.pressure_pa, file.mean_free_path_m, file.viscosity_pa_s];
    let ([x, y], [pitch, roll]) = (file.load_point_m, file.static_angles_rad);
    lines.extend([
        stars.clone(),
        "p0(Pa) al(m) vis(Pa.s)".to_owned(),
        row(&gas),
        stars.clone(),
        "f0(kg) xf0(m) yf0(m) psa(rad) rsa(rad)".to_owned(),
        row(&[file.load_kgf, x, y, pitch, roll]),
        stars.clone(),
        "imodel".to_owned(),
        model.to_string(),
        stars,
        "icmodel A B".to_owned(),
        format!(
            "{} {:e} {:e}",
            file.contact_model, file.hamaker_j, file.repulsion_j_m6
        ),
        "elecpot".to_owned(),
        format!("{:e}", file.potential_v),
    ]);
    lines.join("\n") + "\n"
}
