//! Reads `results.h5`.

use std::path::Path;

use hdf5::{File, Group};

use opshock_solver::scene::discretisation::Levels;

use super::columns::{get, get_number, get_text, get_texts};
use super::rows::{PointKeep, RESULTS_FORMAT, Results, RunRow, Session};
use crate::search::{Flag, ProbeResult, Purpose, Ramp, Sign, Status, UndecidedCause, Verdict};
use crate::store::error::StoreError;
use crate::store::files::{self, RealFiles};
use crate::store::hdf5_file;
use crate::store::record::{
    COSTS, PointDigest, RunKey, RunMachine, RunRecord, StoredTouch, cost_from,
};
use crate::store::seal::{self, Sealed};
use crate::store::summary::{
    AxisValue, CONTRIBUTIONS, Contribution, PointSummary, Summary, Totals,
};

/// Reads results; `None` when the file is missing.
///
/// # Errors
///
/// The file is of another format (E181), cannot be read (E183), or it is not HDF5, cut short, or its bytes or
/// content do not match their digests (E182).
pub fn read(path: &Path) -> Result<Option<Results>, StoreError> {
    files::read(&RealFiles, path)?
        .map(|bytes| parse(path, &bytes))
        .transpose()
}

/// Reads the bytes of results; `path` is only named in the error.
///
/// # Errors
///
/// E181 and E182 as for [`read`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Results, StoreError> {
    let damaged = |what: String| StoreError::Damaged {
        path: path.to_owned(),
        what,
        hint: "if the journal is sound, `opshock sweep` writes it anew from there",
    };
    let inside = match seal::check(bytes) {
        Sealed::Whole(inside) => inside,
        // Another program has changed it: it is judged by its digests alone.
        Sealed::Without => bytes,
        Sealed::Broken => return Err(damaged("its bytes do not match its seal".into())),
    };
    let file = hdf5_file::open(inside)
        .map_err(|error| damaged(format!("not HDF5, or cut short ({error})")))?;
    let found =
        format(&file).map_err(|error| damaged(format!("not results of opshock ({error})")))?;
    if found != RESULTS_FORMAT {
        return Err(StoreError::OtherFormat {
            path: path.to_owned(),
            found,
            known: RESULTS_FORMAT,
        });
    }
    let (results, digest) = content(&file).map_err(|error| damaged(error.to_string()))?;
    let outside = outside_digest(&file).map_err(|error| damaged(error.to_string()))?;
    if outside != results.outside_digest() {
        return Err(damaged("/machine/outside does not match its digest".into()));
    }
    if results.content_digest() != digest {
        return Err(damaged("its content does not match its digest".into()));
    }
    Ok(results)
}

fn format(file: &File) -> hdf5::Result<u32> {
    let root = file.as_group()?;
    let format = get_text(&root, "format")?;
    if format != "opshock results" {
        return Err(format!("format is {format:?}").into());
    }
    get_number(&root, "format_version")
}

fn content(file: &File) -> hdf5::Result<(Results, String)> {
    let root = file.as_group()?;
    let machine = root.group("machine")?;
    let session = Session {
        program_version: get_text(&root, "program_version")?,
        commit: get_text(&root, "commit")?,
        physics_structure: get_number(&root, "physics_structure")?,
        physics_head: get_number(&root, "physics_head")?,
        host: get_text(&machine, "host")?,
        process: get_number(&machine, "process")?,
        threads: get_number::<u64>(&machine, "threads")? as usize,
        started_unix_s: get_number(&machine, "started_unix_s")?,
    };
    let group = root.group("points")?;
    let points = keeps(&group)?;
    let axes: Vec<String> = get_text(&root, "axes")?
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    let rows = rows(&group, &axes)?;
    same_length(points.len(), rows.len())?;

    let group = root.group("runs")?;
    let place: Vec<u64> = get(&group, "point")?;
    let levels = levels(&group)?;
    same_length(place.len(), levels.len())?;
    let of_row: Vec<PointDigest> = place
        .iter()
        .zip(&levels)
        .map(|(&place, &levels)| {
            let point = points.get(place as usize);
            point
                .map(|point| point.digest.changed(levels))
                .ok_or_else(|| unknown("point", &place.to_string()))
        })
        .collect::<hdf5::Result<_>>()?;
    let records = records(&group, &machine.group("runs")?, &of_row)?;
    let runs = run_rows(&group, &place, &levels, records)?;

    let group = machine.group("outside")?;
    let of_run = digests(&group)?;
    let outside = self::records(&group, &group, &of_run)?;

    let totals = Totals::of(&rows, runs.iter().map(RunRow::counted));
    let results = Results {
        summary: Summary {
            study: get_text(&root, "study")?,
            digest: get_text(&root, "study_digest")?,
            axes,
            points: rows,
            totals,
        },
        steps_per_octave: get_number(&root, "steps_per_octave")?,
        start_s: get_number(&root, "start_s")?,
        plan: get_text(&root, "plan")?,
        points,
        runs,
        outside,
        session,
        written_unix_s: get_number(&machine, "written_unix_s")?,
    };
    Ok((results, get_text(&root, "content_blake3")?))
}

fn outside_digest(file: &File) -> hdf5::Result<String> {
    let outside = file.group("machine/outside")?;
    get_text(&outside, "outside_blake3")
}

fn digests(group: &Group) -> hdf5::Result<Vec<PointDigest>> {
    get_texts(group, "point_digest")?
        .iter()
        .map(|text| PointDigest::from_hex(text).ok_or_else(|| unknown("point_digest", text)))
        .collect()
}

fn keeps(group: &Group) -> hdf5::Result<Vec<PointKeep>> {
    let digests = digests(group)?;
    let kinds = get_texts(group, "onset")?;
    let amplitudes: Vec<f64> = get(group, "onset_m_per_s2")?;
    same_length(digests.len(), kinds.len())?;
    same_length(digests.len(), amplitudes.len())?;
    let keep = |((digest, kind), amplitude): ((PointDigest, String), f64)| {
        let touch = match kind.as_str() {
            "open" => None,
            "no_ramp" => Some(StoredTouch::NoRamp),
            "at" => Some(StoredTouch::At(amplitude)),
            "unknown" => Some(StoredTouch::Unknown),
            other => return Err(unknown("onset", other)),
        };
        Ok(PointKeep { digest, touch })
    };
    digests
        .into_iter()
        .zip(kinds)
        .zip(amplitudes)
        .map(keep)
        .collect()
}

fn rows(group: &Group, axes: &[String]) -> hdf5::Result<Vec<PointSummary>> {
    let ramp = get_texts(group, "ramp")?;
    let sign = get_texts(group, "sign")?;
    let status = get_texts(group, "status")?;
    let flags = get_texts(group, "flags")?;
    let brackets = get_texts(group, "brackets_g")?;
    let runs: Vec<u64> = get(group, "runs")?;
    let names = [
        "pulse_ms",
        "a_crit_g",
        "uncertainty_g",
        "survived_g",
        "failed_g",
        "onset_g",
        "scanned_from_g",
        "largest_gap_pct",
    ];
    let numbers: Vec<Vec<f64>> = names
        .iter()
        .map(|name| get(group, name))
        .collect::<hdf5::Result<_>>()?;
    // Not in files of earlier programs.
    let half_min_height: Option<Vec<f64>> = match group.link_exists("half_min_height_g") {
        true => Some(get(group, "half_min_height_g")?),
        false => None,
    };
    let contributions = contribution_columns(group)?;
    let columns = axes
        .iter()
        .map(|name| axis(&group.group("axes")?, name))
        .collect::<hdf5::Result<Vec<_>>>()?;
    let n = ramp.len();
    let levels = get_texts(group, "levels")?;
    let lengths = [
        levels.len(),
        sign.len(),
        status.len(),
        flags.len(),
        brackets.len(),
        runs.len(),
    ];
    for length in lengths
        .into_iter()
        .chain(numbers.iter().map(Vec::len))
        .chain(half_min_height.iter().map(Vec::len))
        .chain(columns.iter().map(Vec::len))
        .chain(
            contributions
                .iter()
                .flat_map(|(_, columns)| columns.iter().map(Vec::len)),
        )
    {
        same_length(n, length)?;
    }
    (0..n)
        .map(|i| {
            let number = |column: usize| Some(numbers[column][i]).filter(|value| !value.is_nan());
            let contribution = |(name, [low, high, factor]): &ContributionColumns| {
                let contribution = Contribution {
                    low_g: low[i],
                    high_g: high[i],
                    factor: factor[i],
                };
                (!contribution.low_g.is_nan()).then(|| ((*name).to_owned(), contribution))
            };
            Ok(PointSummary {
                ramp: Ramp::from_word(&ramp[i])
                    .ok_or_else(|| unknown("ramp", &ramp[i]))?
                    .to_string(),
                pulse_ms: numbers[0][i],
                sign: Sign::from_word(&sign[i]).ok_or_else(|| unknown("sign", &sign[i]))?,
                axes: columns.iter().map(|column| column[i].clone()).collect(),
                a_crit_g: number(1),
                uncertainty_g: number(2),
                half_min_height_g: half_min_height
                    .as_ref()
                    .map(|column| column[i])
                    .filter(|value| !value.is_nan()),
                survived_g: number(3),
                failed_g: number(4),
                contributions: contributions.iter().filter_map(contribution).collect(),
                levels: levels[i].clone(),
                onset_g: number(5),
                runs: runs[i],
                status: Status::parse(&status[i]).ok_or_else(|| unknown("status", &status[i]))?,
                flags: flags[i]
                    .split_whitespace()
                    .map(|word| Flag::parse(word).ok_or_else(|| unknown("flag", word)))
                    .collect::<hdf5::Result<_>>()?,
                brackets_g: exact_pairs(&brackets[i])?,
                scanned_from_g: number(6),
                largest_gap_pct: number(7),
            })
        })
        .collect()
}

/// Name of a contribution of the uncertainty intervals; its low, high and factor, row by row.
type ContributionColumns = (&'static str, [Vec<f64>; 3]);

/// Low, high and factor of every contribution of the uncertainty intervals; one that no row has is not in the file.
fn contribution_columns(group: &Group) -> hdf5::Result<Vec<ContributionColumns>> {
    CONTRIBUTIONS
        .into_iter()
        .filter(|name| group.link_exists(&format!("err_{name}_low_g")))
        .map(|name| {
            let column = |what: &str| get(group, &format!("err_{name}_{what}"));
            Ok((
                name,
                [column("low_g")?, column("high_g")?, column("factor")?],
            ))
        })
        .collect()
}

/// Pairs of numbers out of JSON, each read by the standard library, which rounds correctly.
fn exact_pairs(text: &str) -> hdf5::Result<Vec<[f64; 2]>> {
    let numbers = text
        .split(['[', ']', ','])
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().map_err(|_| unknown("bracket", text)))
        .collect::<hdf5::Result<Vec<f64>>>()?;
    Ok(numbers
        .chunks_exact(2)
        .map(|pair| [pair[0], pair[1]])
        .collect())
}

fn axis(group: &Group, name: &str) -> hdf5::Result<Vec<AxisValue>> {
    if let Ok(numbers) = get::<f64>(group, name) {
        return Ok(numbers.into_iter().map(AxisValue::Number).collect());
    }
    Ok(get_texts(group, name)?
        .into_iter()
        .map(AxisValue::Text)
        .collect())
}

fn records(group: &Group, times: &Group, points: &[PointDigest]) -> hdf5::Result<Vec<RunRecord>> {
    let numbers: Vec<Vec<f64>> = [
        "amplitude_m_per_s2",
        "t_fail_after_onset_s",
        "x_m",
        "y_m",
        "h_min_m",
        "t_min_after_onset_s",
    ]
    .iter()
    .map(|name| get(group, name))
    .collect::<hdf5::Result<_>>()?;
    let machine: Vec<Vec<f64>> = ["wall_s", "finished_unix_s"]
        .iter()
        .map(|name| get(times, name))
        .collect::<hdf5::Result<_>>()?;
    let counts: Vec<Vec<u64>> = ["window_factor", "retry"]
        .iter()
        .copied()
        .chain(COSTS.map(|(name, _)| name))
        .map(|name| get(group, name))
        .collect::<hdf5::Result<_>>()?;
    let words: Vec<Vec<String>> = ["verdict", "cause", "message"]
        .iter()
        .map(|name| get_texts(group, name))
        .collect::<hdf5::Result<_>>()?;
    for length in numbers
        .iter()
        .chain(&machine)
        .map(Vec::len)
        .chain(counts.iter().map(Vec::len))
        .chain(words.iter().map(Vec::len))
    {
        same_length(points.len(), length)?;
    }
    let record = |(i, &point): (usize, &PointDigest)| {
        let verdict = match words[0][i].as_str() {
            "survives" => Verdict::Survives,
            "fails" => Verdict::Fails {
                t_fail_s: numbers[1][i],
                x_m: numbers[2][i],
                y_m: numbers[3][i],
            },
            "undecided" => Verdict::Undecided {
                cause: UndecidedCause::parse(&words[1][i])
                    .ok_or_else(|| unknown("cause", &words[1][i]))?,
                message: words[2][i].clone(),
            },
            other => return Err(unknown("verdict", other)),
        };
        let number = |column: usize| Some(numbers[column][i]).filter(|value| !value.is_nan());
        let small = |column: usize| {
            u8::try_from(counts[column][i])
                .map_err(|_| unknown("count", &counts[column][i].to_string()))
        };
        Ok(RunRecord {
            key: RunKey {
                point,
                amplitude_bits: numbers[0][i].to_bits(),
                window_factor: small(0)?,
                retry: small(1)?,
            },
            result: ProbeResult {
                verdict,
                h_min_m: number(4),
                t_min_s: number(5),
                cost: cost_from(std::array::from_fn(|place| counts[place + 2][i])),
            },
            machine: RunMachine {
                wall_s: machine[0][i],
                finished_unix_s: machine[1][i],
            },
        })
    };
    points.iter().enumerate().map(record).collect()
}

/// Refinement levels, row by row.
fn levels(group: &Group) -> hdf5::Result<Vec<Levels>> {
    get_texts(group, "levels")?
        .iter()
        .map(|text| Levels::parse(text).ok_or_else(|| unknown("levels", text)))
        .collect()
}

fn run_rows(
    group: &Group,
    place: &[u64],
    levels: &[Levels],
    records: Vec<RunRecord>,
) -> hdf5::Result<Vec<RunRow>> {
    let sequence: Vec<u64> = get(group, "sequence")?;
    let index: Vec<i32> = get(group, "index")?;
    let amplitude_g: Vec<f64> = get(group, "amplitude_g")?;
    let purpose = get_texts(group, "purpose")?;
    for length in [
        sequence.len(),
        index.len(),
        amplitude_g.len(),
        purpose.len(),
    ] {
        same_length(records.len(), length)?;
    }
    let row = |(i, run): (usize, RunRecord)| {
        Ok(RunRow {
            point: place[i] as usize,
            sequence: sequence[i] as usize,
            purpose: Purpose::parse(&purpose[i]).ok_or_else(|| unknown("purpose", &purpose[i]))?,
            index: index[i],
            levels: levels[i],
            amplitude_g: amplitude_g[i],
            run,
        })
    };
    records.into_iter().enumerate().map(row).collect()
}

fn same_length(expected: usize, found: usize) -> hdf5::Result<()> {
    if expected == found {
        return Ok(());
    }
    Err(format!("columns of {expected} and {found} rows").into())
}

fn unknown(what: &str, value: &str) -> hdf5::Error {
    format!("unknown {what} {value:?}").into()
}
