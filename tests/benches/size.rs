//! What runs and sweeps cost as they grow: a structure with its modes, a sweep with its points.

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use opshock_solver::simulation::{Model, Request, Scope, Workspace, simulate};
use opshock_study::search::Ramp;
use opshock_study::sweep::{SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, Recorder, study};
use opshock_tests::scenes;
use opshock_tests::timing::median_of;

/// Cut frequencies of the disk's modes, Hz.
const CUTS_HZ: [f64; 6] = [2e3, 10e3, 30e3, 60e3, 120e3, 240e3];

/// Points of a sweep.
const POINTS: [usize; 4] = [10, 100, 1000, 10_000];

/// Slope of ln(time) over ln(size) between the ends of a table.
fn exponent(rows: &[(f64, f64)]) -> f64 {
    match rows {
        [(n0, t0), .., (n1, t1)] => (t1 / t0).ln() / (n1 / n0).ln(),
        _ => f64::NAN,
    }
}

/// The reference shock without head, with more and more modes of the disk on the same steps.
fn modes(_: &mut Criterion) {
    println!("| modes | build, ms | run, ms |");
    println!("|---|---|---|");
    let request = Request {
        amplitude_m_per_s2: 190.0 * 9.80665,
        record: false,
    };
    let (mut builds, mut runs) = (Vec::new(), Vec::new());
    for cut_hz in CUTS_HZ {
        let mut scene = scenes::scene("fig13-stiffness", "deformable", 0.5, &[]);
        scene.disk_resolution.cut_hz = cut_hz;
        let build = median_of(5, || {
            let model = Model::build(&scene, Scope::Structure, None).expect("builds");
            model.structure().build_contact_driven().expect("builds");
            black_box(model);
        });
        let model = Model::build(&scene, Scope::Structure, None).expect("builds");
        let mut workspace = Workspace::default();
        let run = median_of(5, || {
            black_box(simulate(&model, &request, &mut workspace));
        });
        let n = model.structure().n_modes().expect("builds");
        println!("| {n} | {:.2} | {:.2} |", 1e3 * build, 1e3 * run);
        builds.push((n as f64, build));
        runs.push((n as f64, run));
    }
    println!(
        "exponents over all modes: build {:.2}, run {:.2}",
        exponent(&builds),
        exponent(&runs)
    );
}

/// Widths that give `n` points with both signs.
fn widths_ms(n: usize) -> Vec<f64> {
    let gaps = (n / 2 - 1).max(1) as f64;
    (0..n / 2).map(|k| 0.5 + 2.5 * k as f64 / gaps).collect()
}

/// Whole sweeps on two threads: searched on a simulator that answers at once, which leaves search,
/// journal and checkpoints; and by the program, the touch threshold of the rigid ramp.
fn points(_: &mut Criterion) {
    println!("| points | mock, s | mock, us a point | program, s | ms a point |");
    println!("|---|---|---|---|---|");
    let (mut mocks, mut programs) = (Vec::new(), Vec::new());
    for n in POINTS {
        let folder = tempfile::tempdir().expect("a folder");
        let input = study(&[Ramp::Rigid], &widths_ms(n));
        let simulator = MockSimulator::new(&input);
        let start = Instant::now();
        sweep(
            &input,
            &simulator,
            &folder.path().join("mock"),
            &SweepOptions::with_threads(2),
            &Recorder::default(),
        )
        .expect("a sweep");
        let mock = start.elapsed().as_secs_f64();

        let file = folder.path().join("study.toml");
        std::fs::write(&file, touch_study(n)).expect("written");
        let start = Instant::now();
        let status = Command::new(env!("CARGO_BIN_EXE_opshock-under-test"))
            .args(["sweep", "-q", "-j", "2", "--no-cache", "--store"])
            .arg(folder.path().join("program"))
            .arg(&file)
            .stdout(std::process::Stdio::null())
            .status()
            .expect("the program");
        assert!(status.success());
        let program = start.elapsed().as_secs_f64();
        let each = |time: f64| time / n as f64;
        println!(
            "| {n} | {mock:.3} | {:.0} | {program:.2} | {:.2} |",
            1e6 * each(mock),
            1e3 * each(program)
        );
        mocks.push((n as f64, mock));
        programs.push((n as f64, program));
    }
    println!(
        "exponents from {} to {} points: mock {:.2}, program {:.2}",
        POINTS[0],
        POINTS[POINTS.len() - 1],
        exponent(&mocks),
        exponent(&programs)
    );
}

fn touch_study(n: usize) -> String {
    format!(
        "study_format = 2\nname = \"size\"\noutputs = [\"touch_threshold\"]\n\
         [pulse]\nwidths_ms = {:?}\nsigns = [\"+\", \"-\"]\n\
         [ramp]\nmodels = [\"rigid\"]\n[resolution]\npreset = \"coarse\"\n\
         [search]\namplitude_g = {{ min = 20.0, max = 2000.0 }}\n",
        widths_ms(n)
    )
}

criterion_group!(benches, modes, points);
criterion_main!(benches);
