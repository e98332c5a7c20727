//! Round trips, and faults where values are damaged.

use super::rail::{Rail, RailFile, Recess, Wall};
use super::run::{RunFile, Slip};
use super::{rail, run, study};
use crate::fault::Faults;
use crate::text::Source;

fn source(name: &str, text: &str) -> Source {
    Source::of(name, text.as_bytes().to_vec()).unwrap()
}

fn codes(faults: &Faults) -> Vec<&str> {
    faults.listed.iter().map(|fault| fault.code).collect()
}

/// Two rails and a wall profile on a pico slider.
fn surface() -> RailFile {
    let rail = |corners: [[f64; 2]; 4], recess, line| Rail {
        corners_m: corners.to_vec(),
        walls: vec![0, 1, 0, 1],
        recess,
        line,
    };
    RailFile {
        version: "8.0".to_owned(),
        length_m: 1.25e-3,
        width_m: 1.0e-3,
        thickness_m: 0.3e-3,
        rails: vec![
            rail(
                [
                    [0.0, 0.1e-3],
                    [0.3e-3, 0.1e-3],
                    [0.3e-3, 0.9e-3],
                    [0.0, 0.9e-3],
                ],
                Recess::Step(2.5e-7),
                5,
            ),
            rail(
                [
                    [0.3e-3, 0.1e-3],
                    [1.1e-3, 0.1e-3],
                    [1.1e-3, 0.3e-3],
                    [0.3e-3, 0.3e-3],
                ],
                Recess::Ramp([0.0, 1e-8, 1e-8]),
                11,
            ),
        ],
        walls: vec![Wall {
            distance_m: vec![-1e-6, 0.0, 3e-6],
            recess_m: vec![0.0, 2e-7, 1.5e-6],
        }],
        taper_length_m: 0.1e-3,
        taper_angle_rad: 0.01,
        base_recess_m: 2.5e-6,
        crown_m: 12.7e-9,
        camber_m: -3.1e-9,
        twist_m: 0.0,
        points_m: vec![[1e-4, 2e-4], [3e-4, 5e-4]],
    }
}

fn flights() -> RunFile {
    RunFile {
        version: "7.0".to_owned(),
        radii_m: vec![17.9e-3, 22.215e-3],
        skews_deg: vec![-6.2, 0.943],
        speeds_rpm: vec![5400.0],
        altitudes_m: vec![0.0],
        pressure_pa: 101_350.0,
        mean_free_path_m: 63.5e-9,
        viscosity_pa_s: 1.806e-5,
        load_kgf: 2.5e-3,
        load_point_m: [0.0; 2],
        static_angles_rad: [0.0; 2],
        slip: Slip::FukuiKaneko,
        contact_model: 0,
        hamaker_j: 1.8e-19,
        repulsion_j_m6: 1.1e-76,
        potential_v: -0.5,
    }
}

#[test]
fn surfaces_go_round() {
    let file = surface();
    let text = rail::write(&file);
    assert_eq!(rail::read(&source("rail.dat", &text)).unwrap(), file);
}

#[test]
fn runs_go_round() {
    let file = flights();
    let text = run::write(&file);
    assert_eq!(run::read(&source("run.dat", &text)).unwrap(), file);
}

/// The flights' file with one line in place of another.
fn with_line(old: &str, new: &str) -> Source {
    let text = run::write(&flights());
    assert!(text.lines().any(|line| line == old), "{old}\n{text}");
    let lines = text
        .lines()
        .map(|line| if line == old { new } else { line });
    source("run.dat", &lines.collect::<Vec<_>>().join("\n"))
}

/// A and B count beside `icmodel` alone, by their names and not by their place; what is not there is 0.
#[test]
fn surface_forces_are_read_by_name() {
    let values = |source: &Source| {
        let file = run::read(source).unwrap();
        (file.hamaker_j, file.repulsion_j_m6, file.potential_v)
    };
    let names = "icmodel A B";
    let full = with_line(names, "icmodel B A");
    // Exchanged names exchange the values: the repulsion's is then out of range.
    assert_eq!(codes(&run::read(&full).unwrap_err()), ["E175"]);
    assert_eq!(
        values(&with_line("elecpot", "frcoe")),
        (1.8e-19, 1.1e-76, 0.0)
    );
    let alone = with_line(names, "icmodel stdasp dnsasp");
    assert_eq!(values(&alone), (0.0, 0.0, -0.5));
    // Another section may call anything A.
    let elsewhere = with_line("imodel", "imodel A\n3 7.0\nx");
    assert_eq!(values(&elsewhere), (1.8e-19, 1.1e-76, -0.5));
    for (line, what, told) in [
        ("0 -1.8e-19 0", "a", "-1.8e-19 J"),
        ("0 180 0", "a", "180 J"),
        ("0 1.8e-19 1e-9", "b", "1e-9 J m6"),
        ("0 0 1.1e-76", "B", "1.1e-76"),
        ("0 1,8e-19 0", "a", "1,8e-19"),
    ] {
        let faults = run::read(&with_line("0 1.8e-19 1.1e-76", line)).unwrap_err();
        let fault = &faults.listed[0];
        assert_eq!(
            (fault.what.as_str(), fault.value.as_str()),
            (what, told),
            "{faults}"
        );
        assert!(fault.line > 0, "{faults}");
    }
    let faults = run::read(&with_line("-5e-1", "5000")).unwrap_err();
    assert_eq!(faults.listed[0].allowed, "-1000 to 1000 V");
}

/// Titles between the lists, a micro sign of Latin-1, comments behind the values, other sections.
#[test]
fn runs_as_people_write_them() {
    let text = "CML Version 8.01 RUN.DAT\r\nprepared for 5 \u{b5}m\r\n\
        ********** Solution Control **********\r\nistiff isolv ioldg iadpt isave\r\n1 1 0 1 1\r\n\
        ********** Operating ******\r\nirad irpm ialt sort\r\n1 2 1 0\r\nradii(m)\r\n2.1D-2\r\n\
        skews(deg)\r\n0\r\nRPMs\r\n5400 7200\r\naltitudes(m)\r\n0\r\n\
        ****** Air ******\r\nP0(Pa) al(m) vis(Ns/m^2)\r\n1.0135E5 6.35E-8 1.806E-5 at sea level\r\n\
        ****** Load ******\r\nf0(kg) xf0(m) yf0(m) psa rsa usestiff\r\n0.0022 0 0 0 0 0\r\n\
        ****** Reynolds ****\r\nischeme imodel akmax beta gamma\r\n2 3 1e-6 6 6\r\n";
    let bytes: Vec<u8> = text.chars().map(|c| u32::from(c) as u8).collect();
    let text = text.replace("8.01", "8.0");
    let wrong = run::read(&Source::of("run.dat", bytes).unwrap()).unwrap_err();
    assert_eq!(
        (codes(&wrong), &wrong.listed[0].value[..]),
        (vec!["E173"], "8.01")
    );
    let bytes: Vec<u8> = text.chars().map(|c| u32::from(c) as u8).collect();
    let file = run::read(&Source::of("run.dat", bytes).unwrap()).unwrap();
    assert_eq!(
        (file.radii_m, file.speeds_rpm),
        (vec![0.021], vec![5400.0, 7200.0])
    );
    assert_eq!((file.load_kgf, file.pressure_pa), (2.2e-3, 101_350.0));
}

#[test]
fn surfaces_become_toml() {
    let mut file = surface();
    let faults = study::surface(&file, "rail.dat").unwrap_err();
    assert_eq!((codes(&faults), faults.listed[0].line), (vec!["E176"], 11));
    file.rails[1].recess = Recess::Step(0.0);
    let written = study::surface(&file, "rail.dat").unwrap();
    assert!(
        written
            .text
            .contains("points_um = [[0, 100], [300, 100], [300, 900], [0, 900]]")
    );
    assert!(
        written.text.contains("crown_nm = 12.7\ncamber_nm = -3.1\n"),
        "{}",
        written.text
    );
    assert_eq!(written.left_out.len(), 2);
}

#[test]
fn flights_become_a_study() {
    let asked = study::Asked {
        name: "a \"drive\"",
        surface_file: "surface.toml",
        run_file: "run.dat",
        radius: 2,
        speed: 1,
    };
    let written = study::study(&surface(), Some(&flights()), asked).unwrap();
    for line in [
        "name = \"a \\\"drive\\\"\"",
        "rpm = 5400",
        "radius_mm = 22.215",
        "skew_deg = 0.943",
        "gram_load_gf = 2.5",
        "mean_free_path_nm = 63.5",
        "length_mm = 1.25",
        "model = \"fukui_kaneko\"",
        "[surface_forces]",
        "hamaker_j = 1.8e-19",
        "repulsion_j_m6 = 1.1e-76",
        "potential_v = -0.5",
    ] {
        assert!(
            written.text.lines().any(|found| found == line),
            "{line}\n{}",
            written.text
        );
    }
    // Two radii, one of which is taken.
    assert_eq!(written.left_out.len(), 1);
    let mut without = flights();
    (
        without.hamaker_j,
        without.repulsion_j_m6,
        without.potential_v,
    ) = (0.0, 0.0, 0.0);
    let plain = study::study(&surface(), Some(&without), asked).unwrap();
    assert!(!plain.text.contains("surface_forces"));
    let other = study::Asked { radius: 3, ..asked };
    let faults = study::study(&surface(), Some(&flights()), other).unwrap_err();
    assert_eq!(faults.listed[0].allowed, "1 to 2");
}

/// Every word of a sound file replaced by a letter, one after the other: each is found at its place.
#[test]
fn no_damaged_number_of_a_surface_is_read() {
    let mut file = surface();
    file.points_m.clear();
    let text = rail::write(&file);
    let lines: Vec<&str> = text.lines().collect();
    let mut n = 0;
    for (at, line) in lines.iter().enumerate().skip(2) {
        for k in 0..line.split(' ').count() {
            let mut words: Vec<&str> = line.split(' ').collect();
            words[k] = "x";
            let broken = words.join(" ");
            let mut all = lines.clone();
            all[at] = &broken;
            let faults = rail::read(&source("rail.dat", &all.join("\n"))).unwrap_err();
            assert!(
                ["E174", "E175"].contains(&faults.listed[0].code),
                "{broken}: {faults}"
            );
            assert_eq!(faults.listed[0].line, at + 1, "{broken}: {faults}");
            n += 1;
        }
    }
    assert_eq!(n, 50);
}

/// The dynamic program's file is told by its name or by names in it, whatever its first line says.
#[test]
fn the_dynamic_programs_file_is_refused_by_name() {
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
