//! One shock and its parts: what each costs, as a time and as a ratio in the same run.
//!
//! The reference scene is the drive of `fig13-stiffness` with the deformable ramp, 190 g for 0.5 ms, 5 ms
//! window, at the study's resolution.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::simulation::{Bearing, Model, Request, Scope, Workspace, simulate};
use opshock_tests::scenes;
use opshock_tests::timing::median_of;

const REQUEST: Request = Request {
    amplitude_m_per_s2: 190.0 * 9.80665,
    record: false,
};

fn shock(c: &mut Criterion) {
    let scene = scenes::scene("fig13-stiffness", "deformable", 0.5, &[]);
    let full = Model::build(&scene, Scope::Full, None).expect("the scene builds");
    let coarse = scenes::scene(
        "fig13-stiffness",
        "deformable",
        0.5,
        &[("resolution.preset", "\"coarse\"")],
    );
    let coarse = Model::build(&coarse, Scope::Full, None).expect("the scene builds");
    let structure = Model::build(&scene, Scope::Structure, None).expect("the scene builds");
    let rigid = Model::build(
        &scenes::scene("fig13-stiffness", "rigid", 0.5, &[]),
        Scope::Structure,
        None,
    )
    .expect("the scene builds");
    let none = Model::build(
        &scenes::scene("fig13-stiffness", "none", 0.5, &[]),
        Scope::Structure,
        None,
    )
    .expect("the scene builds");
    let mut workspace = Workspace::default();

    let mut group = c.benchmark_group("shock");
    group.sample_size(10);
    group.bench_function("full", |b| {
        b.iter(|| black_box(simulate(&full, &REQUEST, &mut workspace)));
    });
    group.bench_function("full_coarse", |b| {
        b.iter(|| black_box(simulate(&coarse, &REQUEST, &mut workspace)));
    });
    group.bench_function("structure", |b| {
        b.iter(|| black_box(simulate(&structure, &REQUEST, &mut workspace)));
    });
    group.bench_function("rigid_contact", |b| {
        let request = Request {
            amplitude_m_per_s2: m_per_s2_from_g(198.0),
            ..REQUEST
        };
        b.iter(|| black_box(simulate(&rigid, &request, &mut workspace)));
    });
    group.bench_function("no_ramp", |b| {
        b.iter(|| black_box(simulate(&none, &REQUEST, &mut workspace)));
    });
    group.bench_function("steady_flight", |b| {
        let mut alone = scene.clone();
        alone.film_resolution.correction_cells = 0;
        b.iter(|| black_box(Bearing::build(&alone, None)));
    });
    group.bench_function("steady_flight_and_correction", |b| {
        b.iter(|| black_box(Bearing::build(&scene, None)));
    });
    group.bench_function("steady_flight_known_correction", |b| {
        let known = Bearing::build(&scene, None).expect("it flies");
        b.iter(|| black_box(Bearing::build(&scene, Some(&known))));
    });
    group.bench_function("build_structure", |b| {
        b.iter(|| {
            let model = Model::build(&scene, Scope::Structure, None).expect("the scene builds");
            model.structure().build_contact_driven().expect("it builds");
            black_box(model)
        });
    });
    group.bench_function("build_inactive", |b| {
        b.iter(|| black_box(Model::build(&scene, Scope::Structure, None)));
    });
    group.finish();

    let mut workspace = Workspace::default();
    let whole = median_of(5, || {
        black_box(simulate(&full, &REQUEST, &mut workspace));
    });
    let part = median_of(5, || {
        black_box(simulate(&structure, &REQUEST, &mut workspace));
    });
    let cost = simulate(&full, &REQUEST, &mut workspace).cost;
    println!(
        "full shock {whole:.3} s, structure alone {:.2} ms: the head is {:.0} times the structure",
        1e3 * part,
        whole / part
    );
    println!(
        "{} film unknowns, {} steps, {} rejected, {} film solves, {} factorisations",
        cost.film_unknowns, cost.steps, cost.rejected, cost.film_solves, cost.factorisations
    );
}

criterion_group!(benches, shock);
criterion_main!(benches);
