//! `opshock accuracy`: error against cost of each discretisation parameter, at some points of a study.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::study_file;
use clap::Args;
use opshock_solver::simulation::Scope;
use opshock_study::accuracy::{
    Accuracy, BRACKET, Bench, Measured, PointStudies, Setting, refinement_settings,
};
use opshock_study::identity;
use opshock_study::provenance::{self, PHYSICS_HEAD, PHYSICS_STRUCTURE};
use opshock_study::report::write_accuracy;
use opshock_study::store::files::{self, RealFiles};
use opshock_study::store::{StoreError, aside};
use opshock_study::study::memory::Demand;
use opshock_study::study::{Choice, Point, Ramp, Sign, Study};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Measure what accuracy costs: refinement studies on every discretisation parameter against finer references
#[derive(Args, Debug)]
pub struct AccuracyArgs {
    /// Study file
    study: PathBuf,
    /// Point as ramp:width:sign, the width in ms; may be repeated [default: each ramp model at the
    /// middle width and the last sign]
    #[arg(long, value_name = "RAMP:MS:SIGN", value_parser = place, allow_hyphen_values = true)]
    at: Vec<Place>,
    /// Folder of the products; run again, it goes on from what is there
    #[arg(long, value_name = "DIR", default_value = "results/accuracy")]
    out: PathBuf,
    /// Measurements of each time
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
}

/// A point named on the command line.
#[derive(Clone, Copy, Debug)]
struct Place {
    ramp: Ramp,
    pulse_ms: f64,
    sign: Sign,
}

fn place(text: &str) -> Result<Place, String> {
    let wanted = || "must be RAMP:MS:SIGN, as rigid:2.0:+".to_owned();
    let words: Vec<&str> = text.split(':').collect();
    let [ramp, pulse_ms, sign] = words[..] else {
        return Err(wanted());
    };
    Ok(Place {
        ramp: Ramp::from_word(ramp).ok_or_else(wanted)?,
        pulse_ms: pulse_ms.parse().map_err(|_| wanted())?,
        sign: Sign::from_word(sign).ok_or_else(wanted)?,
    })
}

/// Share of the critical shock at which the probing shock stands.
const PROBE: f64 = 0.9;

/// What was measured before, by content of the setting.
struct Memory<'a> {
    folder: &'a Path,
    known: HashMap<String, Measured>,
}

const MEASURED: &str = "measured.jsonl";

#[derive(serde::Serialize, serde::Deserialize)]
struct Line {
    key: String,
    measured: Measured,
}

impl Memory<'_> {
    /// Reads the measurements kept in `folder`; lines that this program cannot read are ignored.
    fn open(folder: &Path) -> Result<Memory<'_>, StoreError> {
        let mut known = HashMap::new();
        for line in Self::bytes(folder)?.split(|&byte| byte == b'\n') {
            if let Ok(Line { key, measured }) = serde_json::from_slice(line) {
                known.insert(key, measured);
            }
        }
        Ok(Memory { folder, known })
    }

    fn bytes(folder: &Path) -> Result<Vec<u8>, StoreError> {
        Ok(files::read(&RealFiles, &folder.join(MEASURED))?.unwrap_or_default())
    }

    /// Adds a measurement behind what the file holds now, another process's included.
    fn keep(&mut self, key: String, measured: Measured) -> Result<(), StoreError> {
        let line = Line { key, measured };
        let mut bytes = Self::bytes(self.folder)?;
        if !matches!(bytes.last(), None | Some(b'\n')) {
            bytes.push(b'\n');
        }
        serde_json::to_writer(&mut bytes, &line).expect("a measurement serialises");
        bytes.push(b'\n');
        aside::write_all(self.folder, [(MEASURED, &bytes)])?;
        self.known.insert(line.key, line.measured);
        Ok(())
    }
}

/// Runs the command.
pub fn run(
    arguments: &AccuracyArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    study_file::refuse_unaccepted(&study, &global.accept)?;
    let points = points(&study, &arguments.at)?;
    let mut memory = Memory::open(&arguments.out)?;
    let mut measured = Vec::new();
    for point in &points {
        measured.push(studies_of(
            &study,
            point,
            arguments.repeats,
            &mut memory,
            console,
        )?);
    }
    let accuracy = Accuracy {
        study: study.name.clone(),
        digest: study.digest_hex(),
        program: provenance::program(),
        points: measured,
    };
    let written = write_accuracy(&arguments.out, &accuracy)?;
    if console.json {
        console.result_json(&accuracy)?;
    } else {
        let lines: Vec<String> = written
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        console.result(&(lines.join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}

fn points(study: &Study, places: &[Place]) -> Result<Vec<Point>, Failure> {
    let middle = study.widths_ms.get(study.widths_ms.len() / 2).copied();
    let chosen: Vec<Choice> = if places.is_empty() {
        let of = |&ramp: &Ramp| Choice {
            ramp: Some(ramp),
            pulse_ms: middle,
            sign: study.signs.last().copied(),
            amplitude_g: None,
        };
        study.ramps.iter().map(of).collect()
    } else {
        let of = |place: &Place| Choice {
            ramp: Some(place.ramp),
            pulse_ms: Some(place.pulse_ms),
            sign: Some(place.sign),
            amplitude_g: None,
        };
        places.iter().map(of).collect()
    };
    chosen
        .iter()
        .map(|choice| Ok(study.select_point(choice)?))
        .collect()
}

/// Measures every refinement study of a point.
fn studies_of(
    study: &Study,
    point: &Point,
    repeats: u16,
    memory: &mut Memory<'_>,
    console: &Console,
) -> Result<PointStudies, Failure> {
    let sign = point.factor();
    let settings = refinement_settings(&point.scene);
    let plan = Scope::Full.plan();
    let scenes = settings.iter().map(|setting| &setting.scene);
    let runs = scenes.map(|scene| Demand::run(scene, &plan, false));
    super::memory::check(
        "a refinement study",
        runs.fold(Demand::default(), Demand::max),
        1,
    )?;
    let key = |setting: &Setting| {
        let head = identity::head_key(&setting.scene, PHYSICS_STRUCTURE, PHYSICS_HEAD);
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"opshock accuracy 1");
        hasher.update(provenance::program().as_bytes());
        hasher.update(&head);
        hasher.update(&sign.to_le_bytes());
        hasher.update(&setting.bracket.to_le_bytes());
        hasher.finalize().to_hex().to_string()
    };
    // The study's own setting says where the probing shock stands.
    let own = Setting {
        parameter: "own",
        value: String::new(),
        fineness: 1.0,
        is_reference: false,
        bracket: BRACKET,
        scene: point.scene.clone(),
    };
    let base = match memory.known.get(&key(&own)) {
        Some(base) => base.clone(),
        None => {
            let mut bench = build(study, &own, sign)?;
            let middle_g = (study.search.amplitude_min_g * study.search.amplitude_max_g).sqrt();
            let near_g = bench.onset_g().unwrap_or(middle_g);
            let found = bench.measure(near_g, near_g, own.bracket);
            memory.keep(key(&own), found.clone())?;
            found
        }
    };
    let Some(near_g) = base.critical_g else {
        return Err(
            anyhow::anyhow!("{}: {}", point.label(), base.failure.unwrap_or_default()).into(),
        );
    };
    let probe_g = PROBE * near_g;
    for (place, setting) in settings.iter().enumerate() {
        let key = key(setting);
        if memory
            .known
            .get(&key)
            .is_some_and(|known| known.failure.is_some() || !known.wall_s.is_empty())
        {
            continue;
        }
        console.note(&format!(
            "{}: {} of {}, {} = {}",
            point.label(),
            place + 1,
            settings.len(),
            setting.parameter,
            setting.value
        ));
        let measured = match Bench::build(&setting.scene, sign) {
            Ok(mut bench) => {
                let mut measured = bench.measure(probe_g, near_g, setting.bracket);
                measured.wall_s.push(bench.time(probe_g));
                measured
            }
            Err(reason) => Measured {
                failure: Some(reason),
                ..Measured::default()
            },
        };
        memory.keep(key, measured)?;
    }
    // Times in turns; references are measured once.
    for _ in 1..repeats {
        for setting in settings.iter().filter(|setting| !setting.is_reference) {
            let key = key(setting);
            let known = &memory.known[&key];
            if known.failure.is_some() || known.wall_s.len() >= usize::from(repeats) {
                continue;
            }
            let mut measured = known.clone();
            measured
                .wall_s
                .push(build(study, setting, sign)?.time(probe_g));
            memory.keep(key, measured)?;
        }
    }
    let measured: Vec<(Setting, Measured)> = settings
        .into_iter()
        .map(|setting| {
            let one = memory.known[&key(&setting)].clone();
            (setting, one)
        })
        .collect();
    Ok(PointStudies::of(point.label(), probe_g, &measured))
}

fn build(study: &Study, setting: &Setting, sign: f64) -> Result<Bench, Failure> {
    Bench::build(&setting.scene, sign).map_err(|reason| {
        Failure::Usage(vec![Fault::new(
            "scene",
            format!("{}: {reason}", study.path.display()),
        )])
    })
}
