//! Fuzz tests of the importers: words, lines and bytes of other programs' files exchanged.

use std::path::Path;

use opshock_import::cml::study::{Asked, study, surface};
use opshock_import::cml::{drive, dynamic, rail, run};
use opshock_import::fault::MAX_LISTED;
use opshock_import::gmsh;
use opshock_import::matrix::dof::{self, Freedoms};
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::matrix::{Matrix, calculix, check, dense, market, modes};
use opshock_import::text::Source;
use opshock_import::{Fault, Faults};
use opshock_tests::seeded::{Seeded, seeds};

use crate::{mutate, watch};

/// Words that break readers of numbers.
const WORDS: &[&str] = &[
    "nan",
    "-inf",
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "3",
    "4",
    "7",
    "0.5",
    "1e300",
    "1e308",
    "1e309",
    "1e-400",
    "5e-324",
    "18446744073709551615",
    "18446744073709551616",
    "400000",
    "4000000000",
    "1D5",
    "1.d-3",
    "d",
    "1,5",
    ",",
    ".",
    "+",
    "-",
    "1.2.3",
    "2.7",
    "12.3",
    "%",
    "#",
    "**",
    "*",
    "CML",
    "8.0",
    "9.1",
    "symmetric",
    "general",
    "skew-symmetric",
    "array",
    "coordinate",
    "irad",
    "imodel",
    "\u{b5}m",
    "\u{feff}",
];

/// Sound files and damaged ones of an importer, by their endings.
fn corpus(importer: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("bad_inputs/imports")
        .join(importer);
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| {
            let name = path
                .file_name()
                .and_then(|name| name.to_str())
                .unwrap_or_default();
            endings.iter().any(|ending| name.ends_with(ending))
        })
        .collect();
    // Sound ones first: half of the executions start from one.
    paths.sort_by_key(|path| {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        (!name.starts_with("sound"), name.to_owned())
    });
    paths
        .iter()
        .map(|path| std::fs::read(path).expect("a file"))
        .collect()
}

/// A line of a file; only those that slips touch are taken apart.
#[derive(Clone)]
enum Words<'a> {
    Whole(&'a str),
    Apart(Vec<&'a str>),
}

impl<'a> Words<'a> {
    fn len(&self) -> usize {
        match self {
            Self::Whole(text) => text.split(' ').count(),
            Self::Apart(words) => words.len(),
        }
    }

    fn apart(&mut self) -> &mut Vec<&'a str> {
        if let Self::Whole(text) = self {
            *self = Self::Apart(text.split(' ').collect());
        }
        match self {
            Self::Apart(words) => words,
            Self::Whole(_) => unreachable!("taken apart above"),
        }
    }
}

/// A file after its slips.
fn mutated(seeded: &mut Seeded, corpus: &[Vec<u8>], n_sound: usize) -> Vec<u8> {
    let n = if seeded.once_in(2) {
        n_sound
    } else {
        corpus.len()
    };
    let sound = seeded.one_of(&corpus[..n]);
    if seeded.once_in(3) {
        let mut bytes = sound.clone();
        mutate::bytes(seeded, &mut bytes);
        return bytes;
    }
    let text: String = sound.iter().map(|byte| char::from(*byte)).collect();
    let mut lines: Vec<Words<'_>> = text.lines().map(Words::Whole).collect();
    let slips = if seeded.once_in(2) {
        1
    } else {
        1 + seeded.below(5)
    };
    for _ in 0..slips {
        if lines.is_empty() {
            break;
        }
        let at = seeded.below(lines.len());
        let n_words = lines[at].len();
        let word = seeded.below(n_words.max(1));
        match seeded.below(8) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[at].clone()),
            2 => {
                let other = seeded.below(lines.len());
                lines.swap(at, other);
            }
            3 if n_words > 0 => drop(lines[at].apart().remove(word)),
            4 => lines[at]
                .apart()
                .insert(word.min(n_words), *seeded.one_of(WORDS)),
            _ if n_words > 0 => lines[at].apart()[word] = *seeded.one_of(WORDS),
            _ => {}
        }
    }
    let mut written = String::with_capacity(text.len() + 64);
    for line in &lines {
        match line {
            Words::Whole(text) => written += text,
            Words::Apart(words) => written += &words.join(" "),
        }
        written.push('\n');
    }
    if lines.is_empty() {
        written.push('\n');
    }
    written.into_bytes()
}

/// What must hold of a refusal.
fn judge(faults: &Faults) {
    assert!(!faults.listed.is_empty() && faults.listed.len() <= MAX_LISTED);
    for Fault {
        code,
        file,
        message,
        ..
    } in &faults.listed
    {
        assert!(code.len() == 4 && !message.is_empty(), "{faults}");
        assert!(!file.is_empty(), "{faults}");
    }
}

/// Rows of the largest matrix that is checked and not only read.
const SMALL: usize = 60;

/// Puts a matrix beside a mass of 1 kg in every row and checks it, as the command does.
fn check_beside_unit_mass(stiffness: Matrix, freedoms: Option<Freedoms>) -> Result<(), Faults> {
    let n = stiffness.n_rows;
    if n > SMALL {
        return Ok(());
    }
    let text = (1..=n).fold(
        format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {n}\n"),
        |text, row| text + &format!("{row} {row} 1\n"),
    );
    let mass = market::read(&Source::of("mass.mtx", text.into_bytes())?)?;
    let system = System::of(mass, stiffness, None, freedoms, Units::MillimetreNewton)?;
    let (system, found) = check::check(system, true)?;
    assert!(found.n_rigid <= 6 && found.highest_hz > 0.0, "{found:?}");
    assert!(found.lowest_hz.is_none_or(f64::is_finite), "{found:?}");
    let again = market::write_symmetric(&system.stiffness);
    let again = market::read(&Source::of("k.mtx", again.into_bytes())?)?;
    assert!(again.entries().eq(system.stiffness.entries()));
    Ok(())
}

fn fuzz(
    name: &str,
    (corpus, n_sound): (Vec<Vec<u8>>, usize),
    range: std::ops::Range<u64>,
    report_every: u64,
    read: impl Fn(u64, Source) -> Result<(), Faults>,
) {
    watch::run(name, range, report_every, |seed| {
        let bytes = mutated(&mut Seeded::new(seed), &corpus, n_sound);
        match Source::of(name, bytes).and_then(|source| read(seed, source)) {
            Ok(()) => true,
            Err(faults) => {
                judge(&faults);
                false
            }
        }
    });
}

fn fuzz_market(range: std::ops::Range<u64>, report_every: u64) {
    let corpus = corpus("market", &[".mtx", ".txt"]);
    fuzz(
        "market",
        (corpus, 4),
        range,
        report_every,
        |seed, source| {
            if seed.is_multiple_of(16) {
                modes::read_frequencies(&source)?;
            }
            let matrix = market::read(&source)?;
            if matrix.n_rows == matrix.n_columns {
                check_beside_unit_mass(matrix, None)?;
            }
            Ok(())
        },
    );
}

fn fuzz_calculix(range: std::ops::Range<u64>, report_every: u64) {
    let corpus = corpus("calculix", &[".sti", ".mas", ".dof"]);
    let map = Source::of("map.dof", b"2.3\n3.3\n".to_vec()).expect("text");
    let sound = dof::read(&map).expect("a map");
    fuzz(
        "calculix",
        (corpus, 3),
        range,
        report_every,
        |seed, source| {
            if seed.is_multiple_of(4) {
                let freedoms = dof::read(&source)?;
                if !freedoms.is_empty() {
                    freedoms.find(&freedoms.name(0), "contact")?;
                    judge(
                        &freedoms
                            .find("0.0", "contact")
                            .expect_err("no freedom has direction 0"),
                    );
                }
            }
            check_beside_unit_mass(calculix::read(&source, &sound)?, Some(sound.clone()))
        },
    );
}

fn fuzz_dense(range: std::ops::Range<u64>, report_every: u64) {
    let corpus = corpus("dense", &[".dat"]);
    fuzz("dense", (corpus, 3), range, report_every, |seed, source| {
        if seed.is_multiple_of(4) {
            let (freedoms, places) = dense::read_places(&source)?;
            assert!(freedoms.len() == places.len());
        }
        check_beside_unit_mass(dense::read(&source, true)?, None)
    });
}

fn fuzz_rail(range: std::ops::Range<u64>, report_every: u64) {
    fuzz(
        "rail",
        (corpus("cmlair", &[".rail.dat"]), 1),
        range,
        report_every,
        |_, source| {
            let file = rail::read(&source)?;
            let again = rail::read(&Source::of("rail.dat", rail::write(&file).into_bytes())?)?;
            assert_eq!(again.rails.len(), file.rails.len());
            assert_eq!(
                (again.base_recess_m, again.crown_m),
                (file.base_recess_m, file.crown_m)
            );
            let written = surface(&file, "rail.dat")?;
            assert!(written.text.matches("[[rail]]").count() == file.rails.len());
            Ok(())
        },
    );
}

fn fuzz_run(range: std::ops::Range<u64>, report_every: u64) {
    let slider = corpus("cmlair", &["sound.rail.dat"]).remove(0);
    let slider = rail::read(&Source::of("rail.dat", slider).expect("text")).expect("a surface");
    fuzz(
        "run",
        (corpus("cmlair", &[".run.dat"]), 1),
        range,
        report_every,
        |_, source| {
            let file = run::read(&source)?;
            let again = run::read(&Source::of("run.dat", run::write(&file).into_bytes())?)?;
            assert_eq!(again, file);
            let asked = Asked {
                name: "fuzz",
                surface_file: "surface.toml",
                run_file: "run.dat",
                radius: file.radii_m.len(),
                speed: 1,
            };
            study(&slider, Some(&file), asked)?;
            Ok(())
        },
    );
}

fn fuzz_dynamic(range: std::ops::Range<u64>, report_every: u64) {
    let slider = corpus("cmlair", &["sound.rail.dat"]).remove(0);
    let slider = rail::read(&Source::of("rail.dat", slider).expect("text")).expect("a surface");
    let flights = corpus("cmlair", &["sound.run.dat"]).remove(0);
    let flights = run::read(&Source::of("run.dat", flights).expect("text")).expect("flights");
    fuzz(
        "dynamic",
        (corpus("dynluls", &[".def"]), 1),
        range,
        report_every,
        |seed, source| {
            let file = dynamic::read(&source)?;
            let text = dynamic::write(&file);
            let again = dynamic::read(&Source::of("DynLULS.def", text.into_bytes())?)?;
            assert_eq!(again, file);
            let asked = Asked {
                name: "fuzz",
                surface_file: "surface.toml",
                run_file: "run.dat",
                radius: 1,
                speed: 1,
            };
            let flights = seed.is_multiple_of(2).then_some(&flights);
            let named = (&file, "DynLULS.def");
            let written = drive::study(&slider, flights, named, (None, None), asked)?;
            assert!(!written.text.contains("NaN") && !written.text.contains("inf"));
            Ok(())
        },
    );
}

fn fuzz_gmsh(range: std::ops::Range<u64>, report_every: u64) {
    fuzz(
        "gmsh",
        (corpus("gmsh", &[".msh"]), 1),
        range,
        report_every,
        |_, source| {
            let mesh = gmsh::read(&source)?;
            assert_eq!(mesh.nodes.len(), mesh.node_tags.len());
            let n = mesh.element_tags.len();
            assert_eq!(mesh.connectivity.len(), n * mesh.solid.n_nodes());
            assert!(
                mesh.connectivity
                    .iter()
                    .all(|node| *node < mesh.nodes.len())
            );
            let text = gmsh::write(&mesh);
            let again = gmsh::read(&Source::of("again.msh", text.clone().into_bytes())?)?;
            assert_eq!(again.nodes, mesh.nodes);
            assert_eq!(again.connectivity, mesh.connectivity);
            assert_eq!(gmsh::write(&again), text);
            mesh.one_piece()?;
            for name in ["mount", "top", "bottom"] {
                let faces = mesh.surface(name)?;
                assert!(faces.iter().flatten().all(|node| *node < mesh.nodes.len()));
            }
            Ok(())
        },
    );
}

#[test]
fn mutated_meshes_are_read_or_refused() {
    fuzz_gmsh(0..6_000, 3_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_gmsh() {
    fuzz_gmsh(seeds(0..10_000_000), 1_000_000);
}

#[test]
fn mutated_matrices_are_read_or_refused() {
    fuzz_market(0..6_000, 3_000);
    fuzz_calculix(0..6_000, 3_000);
    fuzz_dense(0..6_000, 3_000);
}

#[test]
fn mutated_cmlair_files_are_read_or_refused() {
    fuzz_rail(0..6_000, 3_000);
    fuzz_run(0..6_000, 3_000);
    fuzz_dynamic(0..6_000, 3_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_market() {
    fuzz_market(seeds(0..10_000_000), 1_000_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_calculix() {
    fuzz_calculix(seeds(0..10_000_000), 1_000_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_dense() {
    fuzz_dense(seeds(0..10_000_000), 1_000_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_rail() {
    fuzz_rail(seeds(0..10_000_000), 1_000_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_run() {
    fuzz_run(seeds(0..10_000_000), 1_000_000);
}

#[test]
#[ignore = "slow: 10 million executions, some minutes"]
fn fuzz_slow_dynamic() {
    fuzz_dynamic(seeds(0..10_000_000), 1_000_000);
}
