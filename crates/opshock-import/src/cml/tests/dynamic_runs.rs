//! Tests of dynamic runs (`DynLULS.def`).

use super::{shaken, source};
use crate::cml::dynamic::{Contents, Shape, Shock};
use crate::cml::{dynamic, rail, run};
use crate::text::Source;

#[test]
fn dynamic_runs_go_round() {
    let full = shaken();
    let mut without = full.clone();
    (without.gas, without.shock, without.suspension) = (None, None, Contents::Unknown);
    let mut decaying = full.clone();
    decaying.shock = full.shock.map(|shock| Shock {
        shape: Shape::DecayingSine,
        time_constant_s: 0.3e-3,
        ..shock
    });
    for file in [full, without, decaying] {
        let text = dynamic::write(&file);
        assert_eq!(dynamic::read(&source("DynLULS.def", &text)).unwrap(), file);
    }
}

/// Capitals, units in brackets with spaces, frames of asterisks, comments after values, Fortran numbers, lists.
#[test]
fn dynamic_runs_as_people_write_them() {
    let text = dynamic::write(&shaken())
        .replace(
            "***** disk *****",
            "  ******************\n***** Disk 5 \u{b5}m *****",
        )
        .replace("E(Pa) nu rho(kg/m3)", "e ( Pa ) NU RHO (kg / m3)")
        .replace("7.5e10 3e-1 2.71e3", "7.5D10 0.30 2710.0   glass")
        .replace("mode start(s)", "ISHOCK start (s)")
        .replace(
            "***** grid *****\nnone\n0",
            "***** grid *****\nnx ny\n418 418\n0.1 0.2\n# anything x",
        )
        + "****************\n";
    let bytes: Vec<u8> = text.chars().map(|c| u32::from(c) as u8).collect();
    let file = dynamic::read(&Source::of("DynLULS.def", bytes).unwrap()).unwrap();
    assert_eq!(file, shaken());
}

/// Every word of a value that is read is replaced by a letter: each fault is found, at its place.
#[test]
fn no_damaged_number_of_a_dynamic_run_is_read() {
    let text = dynamic::write(&shaken());
    let lines: Vec<&str> = text.lines().collect();
    let titles = [
        "problem",
        "suspension",
        "initial condition",
        "shock",
        "disk",
    ];
    let (mut title, mut n) = ("", 0);
    for (at, line) in lines.iter().enumerate().skip(2) {
        if let Some(found) = line.strip_prefix("***** ") {
            title = found.trim_end_matches(" *****");
        }
        let is_value = line.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        if !is_value || !titles.contains(&title) {
            continue;
        }
        for k in 0..line.split(' ').count() {
            let mut words: Vec<&str> = line.split(' ').collect();
            words[k] = "1x";
            let (broken, mut all) = (words.join(" "), lines.clone());
            all[at] = &broken;
            match dynamic::read(&source("DynLULS.def", &all.join("\n"))) {
                Ok(file) => assert_eq!((file, title), (shaken(), "disk"), "{broken}"),
                Err(faults) => {
                    assert!(
                        ["E174", "E175"].contains(&faults.listed[0].code),
                        "{faults}"
                    );
                    assert_eq!(faults.listed[0].line, at + 1, "{broken}: {faults}");
                    n += 1;
                }
            }
        }
    }
    // All but an option, two numbers of elements and two numbers of the time step.
    assert_eq!(n, 15 + 5 + 6 + 5 + 11);
}

/// In the place of another file the dynamic program's file is recognised by its name or by names in it, whatever its
/// first line is.
#[test]
fn a_dynamic_run_in_the_place_of_another_file_is_refused_by_name() {
    for (name, text, line) in [
        ("a/DynLULS.def", "anything\n1 2 3\n", 1),
        (
            "run.dat",
            "CML Version 8.0\n\n***\nra(m) ra_if(m) ra_of(m)\n1 1 1\n",
            4,
        ),
        (
            "rail.dat",
            "a title\niqpo akmax emax idisc\n5 1e-7 1e-3 1\n",
            2,
        ),
    ] {
        let source = source(name, text);
        for faults in [
            rail::read(&source).unwrap_err(),
            run::read(&source).unwrap_err(),
        ] {
            let fault = &faults.listed[0];
            assert_eq!(
                (fault.code, fault.what.as_str(), fault.line),
                ("E173", "DynLULS.def", line)
            );
        }
    }
}
