//! Tests of surfaces (`rail.dat`).

use super::{source, surface};
use crate::cml::rail;

#[test]
fn surfaces_go_round() {
    let file = surface();
    let text = rail::write(&file);
    assert_eq!(rail::read(&source("rail.dat", &text)).unwrap(), file);
}

/// Every word of a valid file is replaced by a letter, one after the other: each fault is found at its place.
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
