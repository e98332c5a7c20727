//! Matrices against another program's frequencies, round trips, and messages of faults.

use super::dof::{Direction, Freedom, Freedoms};
use super::envelope::Envelope;
use super::system::System;
use super::units::Units;
use super::{Entry, Matrix, calculix, check, dense, dof, market, modes};
use crate::fault::Faults;
use crate::text::Source;
use std::path::Path;

fn source(name: &str, text: &str) -> Source {
    Source::of(name, text.as_bytes().to_vec()).unwrap()
}

fn reference(name: &str) -> Source {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/calculix");
    Source::read(&folder.join(name)).unwrap()
}

fn arm() -> System {
    let freedoms = dof::read(&reference("arm.dof")).unwrap();
    let stiffness = calculix::read(&reference("arm.sti"), &freedoms).unwrap();
    let mass = calculix::read(&reference("arm.mas"), &freedoms).unwrap();
    System::of(
        mass,
        stiffness,
        None,
        Some(freedoms),
        Units::MillimetreNewton,
    )
    .unwrap()
}

fn codes(faults: &Faults) -> Vec<&str> {
    faults.listed.iter().map(|fault| fault.code).collect()
}

/// Springs of 1 N/m between n masses of 1 kg, the first on the base: λ = 4 sin²((2 k − 1) π/(4 n + 2)).
fn chain(n: usize, on_base: bool) -> [Matrix; 2] {
    let (mut k, mut m) = (Vec::new(), Vec::new());
    let mut add = |row: usize, column: usize, value: f64| k.push(Entry { row, column, value });
    for i in 0..n {
        add(i, i, if i + 1 < n { 2.0 } else { 1.0 });
        if i > 0 {
            add(i, i - 1, -1.0);
            add(i - 1, i, -1.0);
        }
        m.push(Entry {
            row: i,
            column: i,
            value: 1.0,
        });
    }
    if !on_base {
        add(0, 0, -1.0);
    }
    [Matrix::of("m", n, n, m), Matrix::of("k", n, n, k)]
}

#[test]
fn calculix_matrices_have_calculix_frequencies() {
    let (system, found) = check::check(arm(), false).unwrap();
    assert_eq!(system.n(), 36);
    // CalculiX prints seven digits: 0.1635258E+05 Hz.
    let lowest = found.lowest_hz.unwrap();
    assert!((lowest / 16_352.58 - 1.0).abs() < 1e-6, "{lowest}");
    assert!(
        (found.highest_hz / 5.0708e6 - 1.0).abs() < 0.05,
        "{}",
        found.highest_hz
    );
    // 1.41e-9 t/mm³ × 0.1 mm² × 2⅓ mm of free nodes' share, in kg.
    for mass in found.total_mass_kg.unwrap() {
        assert!((mass / 3.29e-7 - 1.0).abs() < 1e-9, "{mass}");
    }
    assert_eq!((found.n_rigid, found.warnings.len()), (0, 0));
    assert!(found.asymmetry == 0.0);
}

#[test]
fn a_system_written_as_matrix_market_reads_back_the_same() {
    let (system, _) = check::check(arm(), false).unwrap();
    let text = market::write_symmetric(&system.stiffness);
    let again = market::read(&source(&system.stiffness.file, &text)).unwrap();
    assert_eq!(again.n_entries(), system.stiffness.n_entries());
    for (a, b) in again.entries().zip(system.stiffness.entries()) {
        assert_eq!(
            (a.row, a.column, a.value.to_bits()),
            (b.row, b.column, b.value.to_bits())
        );
    }
    let names = dof::write(&system.freedoms);
    assert_eq!(
        dof::read(&source(&system.freedoms.file, &names)).unwrap(),
        system.freedoms
    );
}

#[test]
fn a_chain_has_its_frequencies_and_its_free_motion() {
    for n in [2, 3, 50, 400] {
        let [m, k] = chain(n, true);
        let system = System::of(m, k, None, None, Units::Si).unwrap();
        let (_, found) = check::check(system, false).unwrap();
        let angle = |k: f64| k * std::f64::consts::PI / (4 * n + 2) as f64;
        let hertz = |k: f64| 2.0 * angle(k).sin() / std::f64::consts::TAU;
        let lowest = found.lowest_hz.unwrap();
        assert!((lowest / hertz(1.0) - 1.0).abs() < 1e-8, "{n}: {lowest}");
        let highest = hertz(2.0 * n as f64 - 1.0);
        assert!(found.highest_hz <= highest * (1.0 + 1e-12) && found.highest_hz > 0.9 * highest);
        let [m, k] = chain(n, false);
        let system = System::of(m, k, None, None, Units::Si).unwrap();
        assert_eq!(
            codes(&check::check(system.clone(), false).unwrap_err()),
            ["E165"]
        );
        assert_eq!(check::check(system, true).unwrap().1.n_rigid, 1);
    }
}

/// Envelope factors invert the product with the matrix, and give the number of eigenvalues by Sylvester's law.
#[test]
fn factors_solve_and_count() {
    let (system, _) = check::check(arm(), false).unwrap();
    let envelope = Envelope::of(&[&system.mass, &system.stiffness]).unwrap();
    let x: Vec<f64> = (0..36).map(|k| f64::from(k % 7) - 3.0).collect();
    let mut b = vec![0.0; 36];
    system.stiffness.apply(&x, &mut b);
    envelope.factor(&system.stiffness, 0.0, None).solve(&mut b);
    let error = x
        .iter()
        .zip(&b)
        .map(|(x, b)| (x - b).abs())
        .fold(0.0, f64::max);
    assert!(error < 1e-9, "{error}");
    // Between the frequencies that CalculiX prints.
    for (hertz, below) in [
        (1.6e4, 0),
        (1.8e4, 1),
        (4e4, 2),
        (1e5, 3),
        (1.2e5, 4),
        (1.25e5, 5),
    ] {
        let value = (std::f64::consts::TAU * hertz).powi(2);
        let factors = envelope.factor(&system.stiffness, -value, Some(&system.mass));
        assert_eq!(factors.n_negative(), Some(below), "{hertz}");
    }
}

/// A spring of 1 N/m beside one of 1e15 N/m is soft and not missing (W208).
#[test]
fn a_soft_spring_beside_a_stiff_one_is_no_free_motion() {
    let entry = |at: usize, value: f64| Entry {
        row: at,
        column: at,
        value,
    };
    let k = Matrix::of(
        "k",
        3,
        3,
        vec![entry(0, 1.0), entry(1, 1e3), entry(2, 1e15)],
    );
    let m = Matrix::of("m", 3, 3, (0..3).map(|at| entry(at, 1e-6)).collect());
    let (_, found) = check::check(System::of(m, k, None, None, Units::Si).unwrap(), false).unwrap();
    let lowest = found.lowest_hz.unwrap() * std::f64::consts::TAU;
    assert!((lowest / 1e3 - 1.0).abs() < 1e-6, "{lowest}");
    assert_eq!(
        found.warnings.iter().map(|w| w.code).collect::<Vec<_>>(),
        ["W208"]
    );
}

#[test]
fn a_negative_eigenvalue_is_named() {
    let [m, k] = chain(3, true);
    let mut entries: Vec<Entry> = k.entries().collect();
    entries.push(Entry {
        row: 2,
        column: 2,
        value: -2.0,
    });
    let k = Matrix::of("k.mtx", 3, 3, entries);
    let system = System::of(m, k, None, None, Units::Si).unwrap();
    let faults = check::check(system, false).unwrap_err();
    assert_eq!(codes(&faults), ["E164"]);
    // numpy.linalg.eigvalsh of the three rows: -1.33005874.
    let reported: f64 = faults.listed[0]
        .value
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((reported + 1.330_058_74).abs() < 2e-3, "{reported}");
}

#[test]
fn units_agree() {
    // A beam's free end: displacement and rotation, in three sets of units.
    let freedoms = || {
        let at = |direction| Freedom { node: 1, direction };
        Freedoms::of(
            "map",
            vec![at(Direction::Along(2)), at(Direction::About(1))],
        )
    };
    let si = [[12.0, -6e-3], [-6e-3, 4e-6]];
    let system = |units: Units, scale: [f64; 3]| {
        let matrix = |name: &str, factor: f64| {
            let entries = (0..4).map(|k| {
                let (row, column) = (k / 2, k % 2);
                let value = factor * si[row][column] * scale[row + column];
                Entry { row, column, value }
            });
            Matrix::of(name, 2, 2, entries.collect())
        };
        let [m, k] = [matrix("m", 1e-6), matrix("k", 1.0)];
        System::of(m, k, None, Some(freedoms()), units).unwrap()
    };
    let reference = system(Units::Si, [1.0; 3]);
    for (units, scale) in [
        // N/m is mN/mm; N is 1e3 mN; N m is 1e6 mN mm.
        (Units::MillimetreMillinewton, [1.0, 1e3, 1e6]),
        // N/m is 1e-3 N/mm; N is N; N m is 1e3 N mm.
        (Units::MillimetreNewton, [1e-3, 1.0, 1e3]),
    ] {
        let other = system(units, scale);
        for (a, b) in other.stiffness.entries().zip(reference.stiffness.entries()) {
            assert!(
                (a.value / b.value - 1.0).abs() < 1e-14,
                "{units:?} {a:?} {b:?}"
            );
        }
    }
}

#[test]
fn market_arrays_and_triangles_are_the_same_matrix() {
    let all =
        "%%MatrixMarket matrix coordinate real general\n% c\n2 2 4\n1 1 2\n1 2 -1\n2 1 -1\n2 2 3\n";
    let lower = "%%MatrixMarket matrix coordinate integer symmetric\n2 2 3\n1 1 2\n2 1 -1\n2 2 3\n";
    let array = "%%MatrixMarket matrix array real general\n2 2\n2\n-1\n-1\n3\n";
    let triangle = "%%matrixmarket MATRIX Array Real Symmetric\n2 2\n2.0D0 -1\n3\n";
    let read = |text: &str| market::read(&source("a.mtx", text)).unwrap();
    for text in [lower, array, triangle] {
        assert_eq!(read(text), read(all), "{text}");
    }
    let skew = read("%%MatrixMarket matrix array real skew-symmetric\n3 3\n1\n2\n3\n");
    assert_eq!(
        (
            skew.get(1, 0),
            skew.get(0, 1),
            skew.get(2, 1),
            skew.get(0, 2)
        ),
        (1.0, -1.0, 3.0, -2.0)
    );
}

#[test]
fn places_make_nodes() {
    let text = "0 0 0 3\n0 0 0 5\n10.5 0 0 1.0\n";
    let (freedoms, places) = dense::read_places(&source("susp_cords.dat", text)).unwrap();
    assert_eq!(
        [0, 1, 2].map(|row| freedoms.name(row)),
        ["1.3", "1.5", "2.1"]
    );
    assert!((places[2][0] - 10.5e-3).abs() < 1e-18);
}

/// Two masses of 1 kg on springs: λ = (3 ∓ √5)/2, shapes of unit mass.
#[test]
fn modes_are_held_against_the_matrices() {
    let [m, k] = chain(2, true);
    let system = System::of(m, k, None, None, Units::Si).unwrap();
    let golden = 0.5 * (1.0 + 5_f64.sqrt());
    let size = (1.0 + golden * golden).sqrt();
    let shapes = |factor: f64| {
        let values =
            [[1.0, golden], [golden, -1.0]].map(|column| column.map(|x| factor * x / size));
        let entries = (0..4).map(|k| Entry {
            row: k % 2,
            column: k / 2,
            value: values[k / 2][k % 2],
        });
        Matrix::of("phi.mtx", 2, 2, entries.collect())
    };
    let hertz = [0.5 * (3.0 - 5_f64.sqrt()), 0.5 * (3.0 + 5_f64.sqrt())]
        .map(|value| value.sqrt() / std::f64::consts::TAU);
    let of = |factor: f64, hertz: [f64; 2], renormalise: bool| {
        modes::of(
            &system,
            &shapes(factor),
            hertz.to_vec(),
            "f.txt",
            renormalise,
        )
    };
    let sound = of(1.0, hertz, false).unwrap();
    assert!(modes::moves(&sound, "phi.mtx", 1, "row 2").is_ok());
    assert_eq!(codes(&of(2.0, hertz, false).unwrap_err()), ["E167"]);
    assert_eq!(of(2.0, hertz, true).unwrap().shapes.len(), 2);
    let radians = hertz.map(|f| f * std::f64::consts::TAU);
    let faults = of(1.0, radians, false).unwrap_err();
    assert_eq!(codes(&faults), ["E168", "E168"]);
    assert!(faults.listed[0].hint.contains("rad/s"));
}
