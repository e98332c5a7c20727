//! Tests of static runs (`run.dat`).

use super::{codes, flights, source};
use crate::cml::run;
use crate::text::Source;

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

/// A and B are read beside `icmodel` alone, by their names and not by their place; missing values are 0.
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
    // Another section may use A as a name.
    let elsewhere = with_line("imodel", "imodel A\n3 7.0\nx");
    assert_eq!(values(&elsewhere), (1.8e-19, 1.1e-76, -0.5));
    for (line, what, reported) in [
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
            (what, reported),
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
