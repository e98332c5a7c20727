//! Round trips, and faults where values are damaged.

use super::dynamic::{Disk, DynamicFile, Gas, Matrices, Ramp, Shape, Shock};
use super::rail::{Rail, RailFile, Recess, Wall};
use super::run::{RunFile, Slip};
use super::{drive, dynamic, rail, run, study};
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

/// The sample drive of the CMLAir 8.01 manual under a shock.
fn shaken() -> DynamicFile {
    DynamicFile {
        version: "8.0".to_owned(),
        length_m: 1.25e-3,
        width_per_length: 0.8,
        centre: [0.0; 3],
        load_kgf: 2.5e-3,
        load_point_m: [0.0; 2],
        halt: 0.0,
        speed_rpm: 5400.0,
        step_s: 1e-7,
        end_s: 3e-3,
        radius_m: 22.215e-3,
        move_radii_m: [22.215e-3; 2],
        actuator: [0.0; 3],
        arm_m: 38e-3,
        skew_deg: 0.943,
        attitude: [15e-9, 150e-6, 0.0, 0.0, 0.0, 0.0],
        gas: Some(Gas {
            pressure_pa: 101_350.0,
            mean_free_path_m: 63.5e-9,
            viscosity_pa_s: 1.806e-5,
        }),
        shock: Some(Shock {
            shape: Shape::HalfSine,
            start_s: 0.5e-3,
            width_s: 1e-3,
            magnitude_g: -200.0,
            time_constant_s: 0.0,
        }),
        matrices: Some(Matrices {
            n_rows: 250,
            slider_row: 241,
        }),
        disk: Disk {
            radii_m: [10.01e-3, 32.5e-3],
            thickness_m: 0.635e-3,
            youngs_modulus_pa: 75e9,
            poisson: 0.3,
            density_kg_per_m3: 2710.0,
            alpha_per_s: 25.0,
            beta_s: 1e-7,
        },
        ramp: Ramp {
            distance_m: 35.6e-3,
            angle_deg: 15.91,
            clearance_m: 100e-6,
        },
    }
}

#[test]
fn dynamic_runs_go_round() {
    let full = shaken();
    let mut without = full.clone();
    (without.gas, without.shock, without.matrices) = (None, None, None);
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

/// Capitals, units in brackets with spaces, frames of asterisks, comments behind values, numbers of Fortran, lists.
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

/// Every word of a value that is read, replaced by a letter: each is found, at its place.
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
    // All but an option, two counts of elements and two numbers of the time step.
    assert_eq!(n, 15 + 5 + 6 + 5 + 11);
}

/// A dynamic run without `run.dat`.
const DRIVE: study::Asked<'static> = study::Asked {
    name: "drive",
    surface_file: "surface.toml",
    run_file: "",
    radius: 1,
    speed: 1,
};

/// The sample drive's ramp is 0.35 mm inside the rim, 7 degrees before the slider; at another radius the same arm
/// has the skew that its circle gives, and finds the same ramp.
#[test]
fn the_ramps_place_follows_from_the_pivot() {
    let number = |file: &DynamicFile, section: &str, key: &str| -> f64 {
        let mut rail = surface();
        (rail.length_m, rail.width_m) = (1.25e-3, 1e-3);
        let written = drive::study(&rail, None, (file, "DynLULS.def"), None, DRIVE).unwrap();
        let text = written.text.split(section).nth(1).unwrap();
        let line = text.lines().find(|line| line.starts_with(key)).unwrap();
        line.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let file = shaken();
    let ramp = number(&file, "[ramp]", "radius_mm");
    let turn = number(&file, "[slider]", "angle_deg");
    assert!((ramp - 32.15).abs() < 0.005, "{ramp}");
    assert!((turn - 7.0).abs() < 0.05, "{turn}");
    // Moved in by a turn of the arm: sin s = (r² + L² − c²)/(2 r L), the ramp's angle grows by the turn.
    let (r, l) = (file.radius_m, file.arm_m);
    let c2 = r * r + l * l - 2.0 * r * l * file.skew_deg.to_radians().sin();
    let at = |r: f64| ((c2 + l * l - r * r) / (2.0 * c2.sqrt() * l)).acos();
    let mut inner = file.clone();
    inner.radius_m = 17.9e-3;
    inner.skew_deg = ((inner.radius_m.powi(2) + l * l - c2) / (2.0 * inner.radius_m * l))
        .asin()
        .to_degrees();
    assert!((inner.skew_deg + 6.13).abs() < 0.01, "{}", inner.skew_deg);
    inner.ramp.angle_deg += (at(r) - at(inner.radius_m)).to_degrees();
    assert_eq!(number(&inner, "[ramp]", "radius_mm"), ramp);
}

#[test]
fn pulses_of_dynamic_runs_become_those_of_a_study() {
    let mut rail = surface();
    (rail.length_m, rail.width_m) = (1.25e-3, 1e-3);
    let pulse = |shape: Option<Shape>| {
        let mut file = shaken();
        file.shock = shape.zip(file.shock).map(|(shape, shock)| Shock {
            shape,
            time_constant_s: 2e-3,
            ..shock
        });
        let written = drive::study(&rail, None, (&file, "DynLULS.def"), None, DRIVE).unwrap();
        let section = written.text.split("[pulse]\n").nth(1).unwrap();
        section.split("\n\n").next().unwrap().to_owned()
    };
    let rest = "signs = [\"+\", \"-\"]";
    let start = "start_ms = 0.5";
    for (shape, wanted) in [
        (None, format!("widths_ms = [0.5, 1.0, 2.0]\n{rest}")),
        (
            Some(Shape::HalfSine),
            format!("shape = \"half_sine\"\nwidths_ms = [1]\n{rest}\n{start}"),
        ),
        (
            Some(Shape::Square),
            format!("shape = \"square\"\nwidths_ms = [1]\n{rest}\n{start}"),
        ),
        (
            Some(Shape::Sine),
            format!(
                "shape = \"damped_sine\"\nfrequency_hz = 1000.0\ndecay_per_s = 0.0\nwidths_ms = [1]\n{rest}\n{start}"
            ),
        ),
        (
            Some(Shape::DecayingSine),
            format!(
                "shape = \"damped_sine\"\nfrequency_hz = 1000.0\ndecay_per_s = 500.0\nwidths_ms = [14]\n{rest}\n{start}\nwindow_ms = 28"
            ),
        ),
    ] {
        assert_eq!(pulse(shape), wanted);
    }
}

/// In the place of another file the dynamic program's is told by its name or by names in it, whatever its first
/// line says.
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
