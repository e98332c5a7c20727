//! Reads and writes `rail.dat`, an air-bearing surface of the CMLAir family.
//!
//! ```text
//! CML Version 8.0 …             two lines of header
//! length width thickness        m
//! rails walls
//! points style                  a rail: style 1 = step, 0 = ramp
//! x y wall                      each corner; profile of the wall along the edge that starts there
//! depth                         of a step; three heights of a ramp
//! points of each wall profile
//! distances … / depths …        a wall: normal distance, negative = inside; absolute recess, m
//! taper_length taper_angle base_recess
//! crown camber twist
//! x … / y …                     points of interest
//! ```
//!
//! x runs from the leading edge, y from the inner edge; later rails overwrite earlier ones.

use super::reader::{MAX_COUNT, Reader, real, short};
use crate::fault::{Fault, Faults};
use crate::text::Source;
use std::fmt::Write as _;

/// Corners of a rail at most.
pub const MAX_CORNERS: usize = 200;

/// A surface.
#[derive(Clone, Debug, PartialEq)]
pub struct RailFile {
    /// Version of the format.
    pub version: String,
    /// Length of the slider, m.
    pub length_m: f64,
    /// Width, m.
    pub width_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Rails; later ones overwrite earlier ones.
    pub rails: Vec<Rail>,
    /// Wall profiles.
    pub walls: Vec<Wall>,
    /// Length of the taper at the leading edge, m.
    pub taper_length_m: f64,
    /// Its angle, rad.
    pub taper_angle_rad: f64,
    /// Recess of everything no rail covers, m.
    pub base_recess_m: f64,
    /// Crown, m.
    pub crown_m: f64,
    /// Camber, m.
    pub camber_m: f64,
    /// Twist, m.
    pub twist_m: f64,
    /// Points of interest, m.
    pub points_m: Vec<[f64; 2]>,
}

/// A rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Rail {
    /// Corners, m.
    pub corners_m: Vec<[f64; 2]>,
    /// Wall profile along the edge from each corner, numbered from 1; 0 for none.
    pub walls: Vec<usize>,
    /// Depth.
    pub recess: Recess,
    /// Line it starts on.
    pub line: usize,
}

/// Depth of a rail, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recess {
    /// The same everywhere.
    Step(f64),
    /// Plane through the first three corners at these depths.
    Ramp([f64; 3]),
}

/// A wall profile: depth over the normal distance from the edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Distances, m; negative inside the rail.
    pub distance_m: Vec<f64>,
    /// Absolute recess at each, m.
    pub recess_m: Vec<f64>,
}

/// Reads a surface.
///
/// # Errors
/// E160 for another header or a file cut short, E173 for another version, E174 for words that are
/// no numbers, E175 for values outside what is allowed.
pub fn read(source: &Source) -> Result<RailFile, Faults> {
    let (mut reader, version) = Reader::of(source)?;
    let result = surface(&mut reader, version);
    let mut faults = std::mem::take(&mut reader.faults);
    match result {
        Ok(file) => {
            // Unreadable values are set to 0; checks of them would only repeat the fault.
            if faults.is_empty() {
                faults = outside(&file, reader.file);
            }
            faults.or(file)
        }
        Err(last) => {
            faults.append(last);
            Err(faults)
        }
    }
}

fn surface(reader: &mut Reader<'_>, version: String) -> Result<RailFile, Faults> {
    let [length_m, width_m, thickness_m] = reader.reals(["length", "width", "thickness"])?;
    let [n_rails, n_walls] = reader.counts(["number of rails", "number of walls"])?;
    let mut rails = Vec::new();
    for k in 1..=n_rails {
        rails.push(rail(reader, k, n_walls)?);
    }
    let walls = walls(reader, n_walls)?;
    let [taper_length_m, taper_angle_rad, base_recess_m] =
        reader.reals(["taper length", "taper angle", "base recess"])?;
    let [crown_m, camber_m, twist_m] = reader.reals(["crown", "camber", "twist"])?;
    let points_m = points(reader)?;
    Ok(RailFile {
        version,
        length_m,
        width_m,
        thickness_m,
        rails,
        walls,
        taper_length_m,
        taper_angle_rad,
        base_recess_m,
        crown_m,
        camber_m,
        twist_m,
        points_m,
    })
}

fn rail(reader: &mut Reader<'_>, k: usize, n_walls: usize) -> Result<Rail, Faults> {
    let line = reader.lines.peek().map_or(0, |line| line.number);
    let [n, style] = reader.counts(["corners of a rail", "style of a rail"])?;
    let fault = |what: &str, value: usize, allowed: String| {
        Faults::from(
            Fault::of("E175", reader.file, "the value is not allowed")
                .line(line)
                .what(format!("{what} of rail {k}"))
                .value(value.to_string())
                .allowed(allowed),
        )
    };
    if !(3..=MAX_CORNERS).contains(&n) {
        return Err(fault("corners", n, format!("3 to {MAX_CORNERS}")));
    }
    if style > 1 {
        return Err(fault(
            "style",
            style,
            "1 for a step, 0 for a ramp".to_owned(),
        ));
    }
    let (mut corners_m, mut walls) = (Vec::new(), Vec::new());
    for corner in 1..=n {
        let what = format!("corner {corner} of rail {k}");
        let (line, words) = reader.words(&what)?;
        let [x, y, wall, ..] = words[..] else {
            return Err(
                Fault::of("E175", reader.file, "values are missing on the line")
                    .line(line)
                    .what(what)
                    .value(format!("{} values", words.len()))
                    .allowed("x, y, wall")
                    .into(),
            );
        };
        corners_m.push([(x, "x"), (y, "y")].map(|(word, name)| {
            real(
                reader.file,
                &word,
                &format!("{name} of {what}"),
                &mut reader.faults,
            )
        }));
        let index = wall.count().filter(|index| *index <= n_walls);
        let Some(index) = index else {
            return Err(Fault::of("E175", reader.file, "no such wall profile")
                .at(wall.place())
                .what(format!("wall of {what}"))
                .value(wall.text)
                .allowed(format!("0 for none, up to {n_walls}"))
                .into());
        };
        walls.push(index);
    }
    let depth = format!("depth of rail {k}");
    let recess = if style == 1 {
        let [depth] = reader.reals([depth.as_str()])?;
        Recess::Step(depth)
    } else {
        let [second, third] = ["second", "third"].map(|n| format!("{n} {depth}"));
        Recess::Ramp(reader.reals([depth.as_str(), &second, &third])?)
    };
    Ok(Rail {
        corners_m,
        walls,
        recess,
        line,
    })
}

fn walls(reader: &mut Reader<'_>, n: usize) -> Result<Vec<Wall>, Faults> {
    if n == 0 {
        // The line of profile points may be present without meaning: "0".
        let is_zero = |line: &crate::text::Line<'_>| line.text.trim() == "0";
        reader.lines.next_if(is_zero);
        return Ok(Vec::new());
    }
    let (line, words) = reader.words("the points of the wall profiles")?;
    let counts: Vec<usize> = words.iter().map_while(|word| word.count()).collect();
    if counts.len() < n
        || counts[..n]
            .iter()
            .any(|count| !(2..=MAX_COUNT).contains(count))
    {
        return Err(
            Fault::of("E175", reader.file, "not the points of the wall profiles")
                .line(line)
                .value(
                    words
                        .iter()
                        .map(|word| word.text)
                        .collect::<Vec<_>>()
                        .join(" "),
                )
                .allowed(format!("{n} whole numbers from 2 to {}", MAX_COUNT))
                .into(),
        );
    }
    let mut walls = Vec::new();
    for (k, &count) in counts[..n].iter().enumerate() {
        let distance_m = list(reader, &format!("distance of wall {}", k + 1), count)?;
        let recess_m = list(reader, &format!("depth of wall {}", k + 1), count)?;
        walls.push(Wall {
            distance_m,
            recess_m,
        });
    }
    Ok(walls)
}

/// A line of `n` numbers.
fn list(reader: &mut Reader<'_>, what: &str, n: usize) -> Result<Vec<f64>, Faults> {
    let (line, words) = reader.words(what)?;
    if words.len() != n {
        return Err(
            Fault::of("E175", reader.file, "not the declared number of values")
                .line(line)
                .what(what)
                .value(format!("{} values", words.len()))
                .allowed(n.to_string())
                .into(),
        );
    }
    let value = |word| real(reader.file, word, what, &mut reader.faults);
    Ok(words.iter().map(value).collect())
}

/// Points of interest: a line of x and a line of y, where there are any.
fn points(reader: &mut Reader<'_>) -> Result<Vec<[f64; 2]>, Faults> {
    if reader.lines.peek().is_none() {
        return Ok(Vec::new());
    }
    let (_, first) = reader.words("x of points of interest")?;
    // Comments may follow the surface.
    if first.iter().any(|word| word.real().is_err()) {
        return Ok(Vec::new());
    }
    let x: Vec<f64> = first.iter().filter_map(|word| word.real().ok()).collect();
    let y = list(reader, "y of points of interest", x.len())?;
    Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
}

/// E175 for every value that no slider can have.
fn outside(file: &RailFile, name: &str) -> Faults {
    let mut faults = Faults::default();
    let mut check = |what: String, line: usize, value: f64, (low, high): (f64, f64), unit: &str| {
        if !(low..=high).contains(&value) {
            let fault = Fault::of("E175", name, "the value is no slider's; all values are SI");
            faults.push(
                fault
                    .line(line)
                    .what(what)
                    .value(format!("{} {unit}", short(value)))
                    .allowed(format!("{} to {} {unit}", short(low), short(high))),
            );
        }
    };
    for (what, value) in [
        ("length", file.length_m),
        ("width", file.width_m),
        ("thickness", file.thickness_m),
    ] {
        check(what.to_owned(), 3, value, (1e-5, 2e-2), "m");
    }
    check(
        "base recess".to_owned(),
        0,
        file.base_recess_m,
        (0.0, 1e-3),
        "m",
    );
    check(
        "taper length".to_owned(),
        0,
        file.taper_length_m,
        (0.0, file.length_m),
        "m",
    );
    check(
        "taper angle".to_owned(),
        0,
        file.taper_angle_rad,
        (0.0, 0.785),
        "rad",
    );
    for (what, value) in [
        ("crown", file.crown_m),
        ("camber", file.camber_m),
        ("twist", file.twist_m),
    ] {
        check(what.to_owned(), 0, value, (-1e-5, 1e-5), "m");
    }
    for (k, rail) in (1..).zip(&file.rails) {
        let depths = match rail.recess {
            Recess::Step(depth) => vec![depth],
            Recess::Ramp(depths) => depths.to_vec(),
        };
        for depth in depths {
            check(
                format!("depth of rail {k}"),
                rail.line,
                depth,
                (0.0, 1e-3),
                "m",
            );
        }
        // Corners may lie on the edge; up to a nanometre outside is rounding.
        for (corner, [x, y]) in (1..).zip(&rail.corners_m) {
            let at = |axis: &str| format!("{axis} of corner {corner} of rail {k}");
            check(at("x"), rail.line, *x, (-1e-9, file.length_m + 1e-9), "m");
            check(at("y"), rail.line, *y, (-1e-9, file.width_m + 1e-9), "m");
        }
    }
    faults
}

/// The surface as `rail.dat`, every digit.
pub fn write(file: &RailFile) -> String {
    let mut text = format!(
        "CML Version {} rail file\nwritten by opshock\n",
        file.version
    );
    let row = |values: &[f64]| {
        let words: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
        words.join(" ") + "\n"
    };
    text += &row(&[file.length_m, file.width_m, file.thickness_m]);
    let _ = writeln!(text, "{} {}", file.rails.len(), file.walls.len());
    for rail in &file.rails {
        let (style, depths) = match &rail.recess {
            Recess::Step(depth) => (1, std::slice::from_ref(depth)),
            Recess::Ramp(depths) => (0, &depths[..]),
        };
        let _ = writeln!(text, "{} {style}", rail.corners_m.len());
        for ([x, y], wall) in rail.corners_m.iter().zip(&rail.walls) {
            let _ = writeln!(text, "{x:e} {y:e} {wall}");
        }
        text += &row(depths);
    }
    if !file.walls.is_empty() {
        let counts: Vec<String> = file
            .walls
            .iter()
            .map(|w| w.recess_m.len().to_string())
            .collect();
        text += &(counts.join(" ") + "\n");
    }
    for wall in &file.walls {
        text += &(row(&wall.distance_m) + &row(&wall.recess_m));
    }
    text += &row(&[
        file.taper_length_m,
        file.taper_angle_rad,
        file.base_recess_m,
    ]);
    text += &row(&[file.crown_m, file.camber_m, file.twist_m]);
    if !file.points_m.is_empty() {
        for axis in [0, 1] {
            text += &row(&file
                .points_m
                .iter()
                .map(|point| point[axis])
                .collect::<Vec<_>>());
        }
    }
    text
}
