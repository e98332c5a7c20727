//! Elements and modes against closed-form solutions of three-dimensional elasticity and of beams.

mod block;

use block::{block, edges};
use opshock_solid::assembly::{ElasticFaces, SolidSystem, Support};
use opshock_solid::element::Shape;
use opshock_solid::material::Material;
use opshock_solid::mesh::Mesh;
use opshock_solid::modes::StaticSolver;
use opshock_solid::sparse::dot;
use std::f64::consts::{PI, TAU};

const POM: Material = Material {
    youngs_modulus_pa: 2.85e9,
    poisson: 0.37,
    density_kg_per_m3: 1410.0,
};

const FREE: Support<'static> = Support {
    held: Vec::new(),
    elastic: Vec::new(),
};

/// Nodes at which `on` holds.
fn nodes_where(mesh: &Mesh, on: impl Fn([f64; 3]) -> bool) -> Vec<usize> {
    let nodes = mesh.nodes_m.iter().enumerate();
    nodes.filter(|(_, x)| on(**x)).map(|(a, _)| a).collect()
}

/// Fixes the root's axial motion, and its lateral motion on the middle lines only: a full clamp hinders lateral strain
/// and warping, which beam theory neglects.
fn hold_as_a_beam(support: &mut Support<'_>, mesh: &Mesh, root: &[usize], size_m: [f64; 2]) {
    support.held = root.iter().map(|&a| (a, 0)).collect();
    for (direction, size_m) in [(1, size_m[0]), (2, size_m[1])] {
        let middle = |a: &&usize| near(mesh.nodes_m[**a][direction], 0.5 * size_m);
        let line = root.iter().filter(middle);
        support.held.extend(line.map(|&a| (a, direction)));
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// Irons' patch test: interior nodes of an irregular patch under a linear field on its surface
/// take the linear field.
#[test]
fn an_irregular_patch_takes_any_uniform_strain_exactly() {
    for shape in [Shape::Hexahedron20, Shape::Tetrahedron10] {
        let mut mesh = block(shape, [1e-3; 3], [3, 3, 3]);
        let inside = |x: [f64; 3]| x.iter().all(|&c| c > 1e-9 && c < 1e-3 - 1e-9);
        // Corners move at random, midside nodes stay in the middle.
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((seed >> 33) as f64 / (1_u64 << 31) as f64 - 0.5) * 0.12e-3
        };
        let n_corners = if shape == Shape::Hexahedron20 { 8 } else { 4 };
        let corners: std::collections::BTreeSet<usize> = mesh
            .elements()
            .flat_map(|e| e[..n_corners].to_vec())
            .collect();
        for &a in &corners {
            if inside(mesh.nodes_m[a]) {
                mesh.nodes_m[a].iter_mut().for_each(|x| *x += random());
            }
        }
        let edges = edges(shape);
        let elements: Vec<Vec<usize>> = mesh.elements().map(<[usize]>::to_vec).collect();
        for element in &elements {
            for (m, [a, b]) in edges.iter().enumerate() {
                let ends = [mesh.nodes_m[element[*a]], mesh.nodes_m[element[*b]]];
                mesh.nodes_m[element[n_corners + m]] =
                    std::array::from_fn(|i| 0.5 * (ends[0][i] + ends[1][i]));
            }
        }
        let field = |x: [f64; 3]| {
            [
                1e-3 * x[0] - 2e-3 * x[1] + 0.5e-3 * x[2],
                3e-3 * x[0] + 0.7e-3 * x[1] - 1.1e-3 * x[2],
                -0.4e-3 * x[0] + 2.2e-3 * x[1] + 1.9e-3 * x[2],
            ]
        };
        let surface = nodes_where(&mesh, |x| !inside(x));
        let whole = SolidSystem::assemble(&mesh, &POM, &FREE).unwrap();
        let mut held = FREE;
        held.held = surface
            .iter()
            .flat_map(|&a| [(a, 0), (a, 1), (a, 2)])
            .collect();
        let system = SolidSystem::assemble(&mesh, &POM, &held).unwrap();
        // The load of the given surface on the free nodes is −K(free, surface) u(surface).
        let mut prescribed = vec![0.0; whole.order()];
        for &a in &surface {
            for (i, u) in field(mesh.nodes_m[a]).into_iter().enumerate() {
                prescribed[whole.unknown(a, i).unwrap()] = u;
            }
        }
        let pull = whole.stiffness.times(&prescribed);
        let mut load = vec![0.0; system.order()];
        let free = nodes_where(&mesh, inside);
        for &a in &free {
            for i in 0..3 {
                load[system.unknown(a, i).unwrap()] = -pull[whole.unknown(a, i).unwrap()];
            }
        }
        let mut answer = vec![load];
        system.stiffness.cholesky().unwrap().solve(&mut answer);
        let mut worst = 0.0_f64;
        for &a in &free {
            for (i, u) in field(mesh.nodes_m[a]).into_iter().enumerate() {
                worst = worst.max((answer[0][system.unknown(a, i).unwrap()] - u).abs());
            }
        }
        assert!(
            !free.is_empty() && worst < 1e-12 * 3e-6,
            "{shape:?}: {worst:e} m"
        );
    }
}

/// A free solid has six motions without strain, and no other eigenvalue near zero.
#[test]
fn a_free_solid_has_six_modes_at_zero() {
    for (shape, cells) in [
        (Shape::Hexahedron20, [3, 2, 2]),
        (Shape::Tetrahedron10, [2, 1, 2]),
    ] {
        let mesh = block(shape, [4e-3, 2e-3, 3e-3], cells);
        let system = SolidSystem::assemble(&mesh, &POM, &FREE).unwrap();
        let scale = (TAU * 1e5_f64).powi(2);
        let solver = StaticSolver::new(&system, Vec::new(), scale).unwrap();
        let modes = solver.lowest(&system, 7).unwrap();
        for value in &modes.omega_squared[..6] {
            assert!(value.abs() < 1e-10 * scale, "{shape:?} {value:e}");
        }
        assert!(modes.omega_squared[6] > 0.05 * scale, "{shape:?}");
        // Without the shift the solid is rejected, because it has no support.
        assert!(
            StaticSolver::new(&system, Vec::new(), 0.0).is_err()
                || solver.count_below(&system, 1.0).unwrap() >= 1
        );
    }
}

/// A box whose walls are smooth (no normal motion, no friction) has plane standing waves as modes:
/// ω = c |k|, k = π (l/a, m/b, n/c), with the speed of dilatation for one and of shear for up to two
/// polarisations. Quadratic elements converge with the fourth power of their size.
#[test]
fn modes_between_smooth_walls_converge_with_order_four() {
    let size_m = [3e-3, 2e-3, 1e-3];
    let [lambda, mu] = POM.lame_pa();
    let shear = (mu / POM.density_kg_per_m3).sqrt();
    let dilatation = ((lambda + 2.0 * mu) / POM.density_kg_per_m3).sqrt();
    let mut exact = Vec::new();
    for l in 0..8 {
        for m in 0..8 {
            for n in 0..8 {
                let waves = [l, m, n];
                let k = (0..3)
                    .map(|i| (PI * waves[i] as f64 / size_m[i]).powi(2))
                    .sum::<f64>()
                    .sqrt();
                let active = waves.iter().filter(|&&w| w > 0).count();
                if active == 0 {
                    continue;
                }
                exact.push(dilatation * k);
                // A wave along one axis would shear within a wall; across two it has one shear
                // polarisation, across three two.
                exact.extend(std::iter::repeat_n(shear * k, active - 1));
            }
        }
    }
    exact.sort_unstable_by(f64::total_cmp);
    let n_modes = 6;
    for (shape, grids) in [
        (Shape::Hexahedron20, [[6, 4, 2], [12, 8, 4]]),
        (Shape::Tetrahedron10, [[6, 4, 2], [12, 8, 4]]),
    ] {
        let errors = grids.map(|cells| {
            let mesh = block(shape, size_m, cells);
            let mut support = FREE;
            for i in 0..3 {
                let walls = nodes_where(&mesh, |x| near(x[i], 0.0) || near(x[i], size_m[i]));
                support.held.extend(walls.into_iter().map(|a| (a, i)));
            }
            let system = SolidSystem::assemble(&mesh, &POM, &support).unwrap();
            let solver = StaticSolver::new(&system, Vec::new(), 0.0).unwrap();
            let modes = solver.lowest(&system, n_modes).unwrap();
            modes
                .omega_squared
                .iter()
                .zip(&exact)
                .map(|(found, exact)| found.sqrt() / exact - 1.0)
                .collect::<Vec<f64>>()
        });
        for (coarse, fine) in errors[0].iter().zip(&errors[1]) {
            // Consistent matrices bound every frequency from above.
            assert!(*fine > 0.0 && *fine < 2.5e-3, "{shape:?} {fine:e}");
            let order = (coarse / fine).log2();
            assert!(
                order > 3.5,
                "{shape:?}: order {order:.2} of {coarse:e} {fine:e}"
            );
        }
    }
}

/// Tip deflection of a cantilever under an end load: P l³/3EI + P l/(κ G A), Timoshenko with κ of a rectangle for ν = 0
/// (5/6, Cowper 1966). With one element through the thickness, elements that lock lose accuracy as the beam gets
/// thinner.
#[test]
fn thin_cantilevers_neither_lock_in_shear_nor_in_volume() {
    for (length_m, height_m, poisson, tolerance) in [
        (10e-3, 1e-3, 0.0, 2e-3),
        (10e-3, 0.1e-3, 0.0, 2e-3),
        (10e-3, 0.01e-3, 0.0, 2e-3),
        (10e-3, 0.5e-3, 0.3, 2e-3),
        (10e-3, 0.5e-3, 0.49, 5e-3),
    ] {
        let material = Material { poisson, ..POM };
        let width_m = height_m;
        let mesh = block(
            Shape::Hexahedron20,
            [length_m, width_m, height_m],
            [24, 1, 1],
        );
        let mut support = FREE;
        let root = nodes_where(&mesh, |x| near(x[0], 0.0));
        hold_as_a_beam(&mut support, &mesh, &root, [width_m, height_m]);
        let system = SolidSystem::assemble(&mesh, &material, &support).unwrap();
        let tip = mesh.face_weights(&mesh.surface_faces(|x| near(x[0], length_m)));
        let shares: Vec<(usize, f64)> = tip
            .nodes
            .iter()
            .map(|&(a, w)| (a, w / tip.area_m2))
            .collect();
        let column = system.column(&shares, 2);
        let solver = StaticSolver::new(&system, vec![column], 0.0).unwrap();
        let found = solver.point_stiffness()[0][0].recip();
        let (e, area) = (material.youngs_modulus_pa, width_m * height_m);
        let inertia = width_m * height_m.powi(3) / 12.0;
        let shear = e / (2.0 * (1.0 + poisson));
        let bending = length_m.powi(3) / (3.0 * e * inertia);
        let expected = bending + length_m / (5.0 / 6.0 * shear * area);
        let error = found / expected - 1.0;
        assert!(error.abs() < tolerance, "{height_m} {poisson}: {error:e}");
    }
}

/// Natural frequencies of Timoshenko's cantilever from its characteristic equation, by exact
/// transfer of the state (w, ψ, M, Q) along the beam.
fn timoshenko_hz(length: f64, width: f64, height: f64, m: &Material, wanted: usize) -> Vec<f64> {
    let area = width * height;
    let inertia = width * height.powi(3) / 12.0;
    let e = m.youngs_modulus_pa;
    let shear =
        e / (2.0 * (1.0 + m.poisson)) * area * 10.0 * (1.0 + m.poisson) / (12.0 + 11.0 * m.poisson);
    let rho = m.density_kg_per_m3;
    // Lengths in l, forces in EI/l²: state' = A state.
    let determinant = |hz: f64| {
        let w2 = (TAU * hz).powi(2);
        let ei = e * inertia;
        let a = [
            [0.0, 1.0, 0.0, ei / (shear * length * length)],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, -rho * inertia * w2 * length * length / ei, 0.0, -1.0],
            [-rho * area * w2 * length.powi(4) / ei, 0.0, 0.0, 0.0],
        ];
        // Columns that start with M = 1 and Q = 1 at the clamp, by Runge-Kutta of order four.
        let mut states = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let n = 400;
        for state in &mut states {
            for _ in 0..n {
                let h = 1.0 / f64::from(n);
                let slope = |s: [f64; 4]| -> [f64; 4] {
                    std::array::from_fn(|i| (0..4).map(|j| a[i][j] * s[j]).sum())
                };
                let step = |s: [f64; 4], k: [f64; 4], f: f64| -> [f64; 4] {
                    std::array::from_fn(|i| s[i] + f * k[i])
                };
                let k1 = slope(*state);
                let k2 = slope(step(*state, k1, 0.5 * h));
                let k3 = slope(step(*state, k2, 0.5 * h));
                let k4 = slope(step(*state, k3, h));
                *state = std::array::from_fn(|i| {
                    state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])
                });
            }
        }
        // Free end: M = Q = 0.
        states[0][2] * states[1][3] - states[0][3] * states[1][2]
    };
    let first = 0.5596 * (e * inertia / (rho * area)).sqrt() / length.powi(2);
    let mut found = Vec::new();
    let step = 0.02 * first;
    let mut hz = 0.2 * first;
    while found.len() < wanted {
        if determinant(hz) * determinant(hz + step) < 0.0 {
            let (mut low, mut high) = (hz, hz + step);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                match determinant(low) * determinant(middle) < 0.0 {
                    true => high = middle,
                    false => low = middle,
                }
            }
            found.push(0.5 * (low + high));
        }
        hz += step;
    }
    found
}

/// Bending frequencies of a cantilever against Timoshenko's beam (Cowper's shear coefficient), with the root supported
/// as a beam's.
#[test]
fn cantilever_frequencies_are_those_of_the_timoshenko_beam() {
    let (length, width, height) = (20e-3, 0.8e-3, 1e-3);
    let material = Material {
        poisson: 0.3,
        ..POM
    };
    let expected = timoshenko_hz(length, width, height, &material, 3);
    for (shape, cells) in [
        (Shape::Hexahedron20, [24, 1, 2]),
        (Shape::Tetrahedron10, [24, 1, 2]),
    ] {
        let mesh = block(shape, [length, width, height], cells);
        let mut support = FREE;
        let root = nodes_where(&mesh, |x| near(x[0], 0.0));
        hold_as_a_beam(&mut support, &mesh, &root, [width, height]);
        let system = SolidSystem::assemble(&mesh, &material, &support).unwrap();
        let solver = StaticSolver::new(&system, Vec::new(), 0.0).unwrap();
        let limit = (TAU * expected[2] * 1.05).powi(2);
        let modes = solver.modes_below(&system, limit).unwrap();
        // Bending along z is what base motion along z drives.
        let driven =
            |x: &&Vec<f64>| dot(x, &system.base_load_kg[2]).powi(2) > 1e-3 * system.total_mass_kg;
        let frequencies: Vec<f64> = modes
            .omega_squared
            .iter()
            .zip(&modes.shapes)
            .filter(|(_, x)| driven(x))
            .map(|(value, _)| value.sqrt() / TAU)
            .collect();
        assert_eq!(frequencies.len(), 3, "{shape:?}: {frequencies:?}");
        for (found, expected) in frequencies.iter().zip(&expected) {
            let error = found / expected - 1.0;
            assert!(
                error.abs() < 2e-3,
                "{shape:?} {found} {expected}: {error:e}"
            );
        }
    }
}

/// A stiff block on springs: ω² = k/m along each direction.
#[test]
fn a_block_on_springs_is_an_oscillator_in_each_direction() {
    let mesh = block(Shape::Hexahedron20, [2e-3, 2e-3, 0.5e-3], [2, 2, 1]);
    let faces = mesh.surface_faces(|x| near(x[2], 0.0));
    let area_m2 = 4e-6;
    // Soft springs of very different stiffness; the same springs resist rocking.
    let stiffness = [40.0, 50.0, 90.0];
    let support = Support {
        held: Vec::new(),
        elastic: vec![ElasticFaces {
            faces: &faces,
            stiffness_n_per_m3: stiffness.map(|k| k / area_m2),
        }],
    };
    let system = SolidSystem::assemble(&mesh, &POM, &support).unwrap();
    let mass = 2.0 * 2.0 * 0.5 * 1e-9 * POM.density_kg_per_m3;
    assert!((system.total_mass_kg / mass - 1.0).abs() < 1e-12);
    let solver = StaticSolver::new(&system, Vec::new(), 0.0).unwrap();
    let modes = solver.lowest(&system, 6).unwrap();
    let vertical = modes
        .omega_squared
        .iter()
        .zip(&modes.shapes)
        .max_by(|a, b| {
            let load = |x: &[f64]| dot(x, &system.base_load_kg[2]).abs();
            load(a.1).total_cmp(&load(b.1))
        })
        .unwrap();
    assert!((vertical.0 / (90.0 / mass) - 1.0).abs() < 1e-5);
    // The whole mass takes part.
    let load = dot(vertical.1, &system.base_load_kg[2]);
    assert!((load * load / mass - 1.0).abs() < 1e-5);
}
