//! A base plate as matrices: a study with them has the modes that an independent eigensolver finds, in every format,
//! and moves as with those modes listed; what is no base is refused as for ramps and suspensions.

use std::fmt::Write as _;
use std::path::Path;

use super::cli::Done;
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use opshock_solver::shock::BaseMode;
use opshock_study::study::{Study, StudyErrors};

const DRIVE: &str = "study_format = 2\nname = \"base\"\noutputs = [\"contact_force\"]\n\
    [pulse]\nwidths_ms = [0.5]\nsigns = [\"+\"]\nwindow_ms = 1.5\n[ramp]\nmodels = [\"rigid\"]\n\
    [resolution]\npreset = \"coarse\"\ndisk_cut_khz = 10\n";

/// Nodes 1 (held), 2 (spindle), 3 (ramp), 4 (pivot) on springs, with masses that couple neighbours, N, m, kg.
fn plate() -> [DMatrix<f64>; 2] {
    let mut mass = DMatrix::from_diagonal(&DVector::from_vec(vec![0.2, 0.4, 0.1, 0.15]));
    let mut stiffness = DMatrix::zeros(4, 4);
    for (i, j, m, k) in [
        (0, 1, 0.03, 4e6),
        (1, 2, 0.01, 1.5e7),
        (1, 3, 0.02, 8e6),
        (2, 3, 0.005, 3e6),
    ] {
        mass[(i, j)] += m;
        mass[(j, i)] += m;
        stiffness[(i, i)] += k;
        stiffness[(j, j)] += k;
        stiffness[(i, j)] -= k;
        stiffness[(j, i)] -= k;
    }
    [mass, stiffness]
}

/// Modes with node 1 held, by Cholesky's factor of the mass and the symmetric eigenproblem.
fn modes() -> Vec<BaseMode> {
    let [mass, stiffness] = plate();
    let load = (&mass * DVector::from_element(4, 1.0))
        .rows(1, 3)
        .into_owned();
    let free = |matrix: &DMatrix<f64>| matrix.view((1, 1), (3, 3)).into_owned();
    let inverse = Cholesky::new(free(&mass))
        .unwrap()
        .l()
        .try_inverse()
        .unwrap();
    let eigen = SymmetricEigen::new(&inverse * free(&stiffness) * inverse.transpose());
    let mut modes: Vec<BaseMode> = (0..3)
        .map(|j| {
            let shape = inverse.transpose() * eigen.eigenvectors.column(j);
            let participation = shape.dot(&load);
            let shape = shape * participation.signum();
            BaseMode {
                frequency_hz: eigen.eigenvalues[j].sqrt() / std::f64::consts::TAU,
                damping_ratio: 0.03,
                participation_sqrt_kg: participation.abs(),
                spindle_per_sqrt_kg: shape[0],
                ramp_per_sqrt_kg: shape[1],
                pivot_per_sqrt_kg: shape[2],
            }
        })
        .collect();
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    modes
}

/// Entries of a matrix, of its lower or upper triangle, counted from 1.
fn entries(matrix: &DMatrix<f64>, lower: bool, factor: f64) -> String {
    let mut text = String::new();
    for i in 0..matrix.nrows() {
        for j in 0..=i {
            if matrix[(i, j)] != 0.0 {
                let [row, column] = if lower { [i, j] } else { [j, i] };
                let _ = writeln!(
                    text,
                    "{} {} {:e}",
                    row + 1,
                    column + 1,
                    factor * matrix[(i, j)]
                );
            }
        }
    }
    text
}

fn rows(matrix: &DMatrix<f64>, factor: f64) -> String {
    let row = |i: usize| {
        let words = matrix
            .row(i)
            .iter()
            .map(|x| format!("{:e}", factor * x))
            .collect::<Vec<_>>();
        words.join(" ") + "\n"
    };
    (0..matrix.nrows()).map(row).collect()
}

/// Files of the three formats, and for each the lines of a study that name them.
fn written(at: &Path) -> [String; 3] {
    let [mass, stiffness] = plate();
    let write = |name: &str, text: String| std::fs::write(at.join(name), text).unwrap();
    let market = |matrix: &DMatrix<f64>| {
        let lower = entries(matrix, true, 1.0);
        let count = lower.lines().count();
        format!("%%MatrixMarket matrix coordinate real symmetric\n4 4 {count}\n{lower}")
    };
    write("m.mtx", market(&mass));
    write("k.mtx", market(&stiffness));
    // N, mm, t: masses in t, stiffnesses in N/mm.
    write("m.mas", entries(&mass, false, 1e-3));
    write("k.sti", entries(&stiffness, false, 1e-3));
    write("base.dof", "1.3\n2.3\n3.3\n4.3\n".to_string());
    // mN, mm, kg: stiffnesses in mN/mm, which is N/m.
    write("m.dat", rows(&mass, 1.0));
    write("k.dat", rows(&stiffness, 1.0));
    write(
        "places.dat",
        "0 0 0 3\n10 0 0 3\n40 0 0 3\n10 50 0 3\n".to_string(),
    );
    let nodes = "spindle = 2\nramp = 3\npivot = 4\nheld = [1]\ndamping_ratio = 0.03\n";
    let section = |mass: &str, stiffness: &str, map: &str, units: &str| {
        format!(
            "[base.imported]\nmass = \"{mass}\"\nstiffness = \"{stiffness}\"\n{map}\nunits = \"{units}\"\n{nodes}"
        )
    };
    [
        section("m.mtx", "k.mtx", "freedoms = \"base.dof\"", "si"),
        section("m.mas", "k.sti", "freedoms = \"base.dof\"", "mm_n"),
        section("m.dat", "k.dat", "places = \"places.dat\"", "mm_mn"),
    ]
}

fn read(at: &Path, section: &str) -> Result<Study, StudyErrors> {
    let path = at.join("study.toml");
    std::fs::write(&path, format!("{DRIVE}{section}")).unwrap();
    Study::from_path(&path, &[])
}

/// Numbers of a mode.
fn numbers(mode: &BaseMode) -> [f64; 6] {
    [
        mode.frequency_hz,
        mode.damping_ratio,
        mode.participation_sqrt_kg,
        mode.spindle_per_sqrt_kg,
        mode.ramp_per_sqrt_kg,
        mode.pivot_per_sqrt_kg,
    ]
}

fn listed(modes: &[BaseMode]) -> String {
    let mut text = String::new();
    for mode in modes {
        let [f, z, p, spindle, ramp, pivot] = numbers(mode);
        let _ = write!(
            text,
            "[[base.modes]]\nfrequency_hz = {f:?}\ndamping_ratio = {z:?}\nparticipation_sqrt_kg = {p:?}\n\
             spindle_per_sqrt_kg = {spindle:?}\nramp_per_sqrt_kg = {ramp:?}\npivot_per_sqrt_kg = {pivot:?}\n"
        );
    }
    text
}

/// Nine digits of every number are kept, as of a ramp's and a suspension's.
#[test]
fn matrices_of_a_base_are_its_modes_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let expected = modes();
    for section in written(at) {
        let study = read(at, &section).unwrap_or_else(|errors| panic!("{section}{errors}"));
        let base = &study.points[0].scene.base;
        assert_eq!(base.len(), 3, "{section}");
        for (found, wanted) in base.iter().zip(&expected) {
            for (x, y) in numbers(found).into_iter().zip(numbers(wanted)) {
                assert!((x / y - 1.0).abs() < 5e-9, "{section}{found:?}\n{wanted:?}");
            }
        }
        // Written out, the study needs no files.
        let again = Study::from_text(&study.resolved_toml(), &[]).unwrap();
        assert_eq!(again.digest, study.digest);
        assert_eq!(&again.points[0].scene.base, base);
        // A lower cut keeps fewer.
        let cut_khz = 0.5e-3 * (expected[1].frequency_hz + expected[2].frequency_hz);
        let fewer = read(at, &format!("{section}cut_khz = {cut_khz:?}\n")).unwrap();
        assert_eq!(fewer.points[0].scene.base[..], base[..2]);
    }
}

/// The drive answers a shock as with the independent modes listed.
#[test]
fn a_base_of_matrices_moves_as_the_modal_one() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [_, calculix, _] = written(at);
    let reported = [calculix, listed(&modes())].map(|section| {
        read(at, &section).unwrap_or_else(|errors| panic!("{errors}"));
        let path = at.join("study.toml");
        let words = [
            "run",
            path.to_str().unwrap(),
            "--amplitude-g",
            "350",
            "--json",
        ];
        let done = Done::of(at, &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.json()
    });
    for pointer in [
        "/base/spindle_max_m",
        "/base/ramp_max_m",
        "/base/pivot_max_m",
    ] {
        let [a, b] = [0, 1].map(|k| {
            reported[k]
                .pointer(pointer)
                .and_then(|x| x.as_f64())
                .unwrap()
        });
        assert!(
            a > 1e-7 && (a / b - 1.0).abs() < 1e-7,
            "{pointer}: {a:e} {b:e}"
        );
    }
}

/// 400 masses on as many springs, one end on the base: their frequencies are known in closed form. The lowest of
/// them are found without the rest.
#[test]
fn of_many_freedoms_the_lowest_modes_are_found() {
    const N: usize = 400;
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (m, k) = (5e-3_f64, 2e9_f64);
    let mut mass = String::new();
    let mut stiffness = String::new();
    let mut map = String::new();
    for i in 1..=N {
        let _ = writeln!(map, "{i}.3");
        let _ = writeln!(mass, "{i} {i} {m:e}");
        let own = if i < N { 2.0 * k } else { k };
        let _ = writeln!(stiffness, "{i} {i} {own:e}");
        if i < N {
            let _ = writeln!(stiffness, "{i} {} {:e}", i + 1, -k);
        }
    }
    for (name, text) in [("b.mas", &mass), ("b.sti", &stiffness), ("b.dof", &map)] {
        std::fs::write(at.join(name), text).unwrap();
    }
    let section = |cut_khz: f64| {
        format!(
            "[base.imported]\nmass = \"b.mas\"\nstiffness = \"b.sti\"\nfreedoms = \"b.dof\"\n\
             spindle = 200\nramp = 400\npivot = 37\ncut_khz = {cut_khz:?}\n"
        )
    };
    let angle = |j: usize| std::f64::consts::PI * (2 * j - 1) as f64 / (2 * N + 1) as f64;
    let exact_hz = |j: usize| (k / m).sqrt() / std::f64::consts::PI * (0.5 * angle(j)).sin();
    let between = |j: usize| 0.5e-3 * (exact_hz(j) + exact_hz(j + 1));
    let study = read(at, &section(between(7))).unwrap_or_else(|errors| panic!("{errors}"));
    let base = &study.points[0].scene.base;
    assert_eq!(base.len(), 7);
    for (j, mode) in (1..).zip(base) {
        // sum sin²(i θ) = (2 N + 1)/4 and sum sin(i θ) = cot(θ/2)/2 for these angles.
        let scale = (4.0 / (m * (2 * N + 1) as f64)).sqrt();
        let load = 0.5 * m * scale / (0.5 * angle(j)).tan();
        let at_node = |i: usize| scale * (i as f64 * angle(j)).sin();
        for (name, x, y) in [
            ("frequency", mode.frequency_hz, exact_hz(j)),
            ("load", mode.participation_sqrt_kg, load),
            ("spindle", mode.spindle_per_sqrt_kg, at_node(200)),
            ("ramp", mode.ramp_per_sqrt_kg, at_node(400)),
            ("pivot", mode.pivot_per_sqrt_kg, at_node(37)),
        ] {
            let off = (x - y).abs() / y.abs().max(1e-3 * scale);
            assert!(off < 1e-6, "{name} of mode {j}: {x:e} {y:e}");
        }
    }
    for (cut_khz, code) in [(between(20), "E189"), (1e-3 * exact_hz(1) / 2.0, "E189")] {
        let errors = read(at, &section(cut_khz)).unwrap_err();
        assert_eq!(errors.errors.len(), 1, "{errors}");
        assert_eq!(errors.errors[0].code, code, "{errors}");
        assert_eq!(errors.errors[0].key, "base.imported.cut_khz");
    }
}

/// The errors are those of any other matrices, with file and place; of a node that is not in them, the study's.
#[test]
fn damaged_matrices_of_a_base_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [market, calculix, dense] = written(at);
    let refused = |section: &str, code: &str, file: &str| {
        let errors = read(at, section).unwrap_err();
        assert_eq!(errors.errors.len(), 1, "{errors}");
        let error = &errors.errors[0];
        assert_eq!(error.code, code, "{error}");
        assert!(error.file.ends_with(file), "{error}");
    };
    let damage = |file: &str, from: &str, to: &str, section: &str, code: &str| {
        let path = at.join(file);
        let whole = std::fs::read_to_string(&path).unwrap();
        assert!(whole.contains(from), "{file}: {whole}");
        std::fs::write(&path, whole.replacen(from, to, 1)).unwrap();
        refused(section, code, file);
        std::fs::write(&path, whole).unwrap();
    };
    damage("k.sti", "1 1 ", "1 one ", &calculix, "E171");
    damage("k.sti", "4 4 ", "4 9 ", &calculix, "E161");
    damage(
        "m.mtx",
        "real symmetric",
        "complex symmetric",
        &market,
        "E160",
    );
    damage("m.dat", "4e-1", "-4e-1", &dense, "E163");
    damage("k.dat", "-1.5e7", "-1.6e7", &dense, "E162");
    damage("base.dof", "3.3", "3.9", &calculix, "E171");
    refused(
        &calculix.replace("spindle = 2", "spindle = 7"),
        "E169",
        "study.toml",
    );
    refused(
        &calculix.replace("held = [1]", "held = [8]"),
        "E169",
        "study.toml",
    );
    // On nothing it is held by nothing.
    refused(&calculix.replace("held = [1]\n", ""), "E165", "k.sti");
    refused(&dense.replace("k.dat", "none.dat"), "E160", "none.dat");
}
