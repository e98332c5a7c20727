//! The film's kernels on the default grid, and its linear algebra against general sparse solvers: faer,
//! and KLU where it is installed.
//!
//! The matrix is that of a stage: M/d + R_ψ at steady flight of the drive of `fig13-stiffness`, d that of
//! a step of 0.2 µs. All factor anew on a known pattern and solve once; KLU
//! also with the pivots of before (`refactor`), which faer and the film's own do not need or do not offer.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Par};
use opshock_klu::{Columns, Klu};
use opshock_solver::air_bearing::steady::fly;
use opshock_solver::air_bearing::{Attitude, Film, FilmLinearisation, FilmScratch};
use opshock_solver::lanes::{Simd, WithSimd, widest};
use opshock_solver::linalg::banded::BandedLu;
use opshock_solver::scene::Scene;
use opshock_tests::scenes;
use opshock_tests::timing::median_of;

/// d of TR-BDF2 with a step of 0.2 µs, s.
const D_S: f64 = 0.293 * 0.2e-6;

/// Cells asked for in the table of cost against size.
const SIZES: [usize; 7] = [500, 1000, 2000, 5000, 10_000, 20_000, 50_000];

/// A film in steady flight.
struct Flying {
    film: Film,
    psi: Vec<f64>,
    attitude: Attitude,
    scratch: FilmScratch,
    lin: FilmLinearisation,
}

impl Flying {
    /// On the scene's layout of some `cells` cells.
    fn of(scene: &Scene, cells: usize) -> Self {
        let mut scene = scene.clone();
        scene.film_resolution.cells = cells;
        let film = scene.film().expect("a film");
        let load = [scene.suspension.gram_load_n, 0.0, 0.0];
        let steady = fly(&film, load).expect("flies");
        let (scratch, lin) = (film.scratch(), film.linearisation());
        let mut flying = Self {
            psi: steady.psi,
            attitude: steady.attitude,
            film,
            scratch,
            lin,
        };
        flying.linearise();
        flying
    }

    fn linearise(&mut self) {
        self.film
            .linearise(&self.psi, &self.attitude, &mut self.lin, &mut self.scratch);
    }

    fn residual(&mut self, out: &mut [f64]) -> [f64; 3] {
        self.film
            .flux_residual_and_force(&self.psi, &self.attitude, out, &mut self.scratch)
    }

    /// The matrix of a stage as a general sparse one.
    fn sparse(&self) -> SparseColMat<usize, f64> {
        let n = self.film.n_cells();
        let mut entries = Vec::new();
        for (offset, diagonal) in self.lin.by_psi.iter() {
            for (i, value) in diagonal.iter().enumerate() {
                let stored = self.film.storage().column(offset);
                let value = value + stored.map_or(0.0, |column| column[i] / D_S);
                if let Some(j) = i.checked_add_signed(offset).filter(|j| *j < n)
                    && value != 0.0
                {
                    entries.push(Triplet::new(i, j, value));
                }
            }
        }
        SparseColMat::try_new_from_triplets(n, n, &entries).expect("a pattern")
    }
}

fn kernels(c: &mut Criterion) {
    faer::set_global_parallelism(Par::Seq);
    let scene = scenes::scene("fig13-stiffness", "none", 0.5, &[]);
    let mut flying = Flying::of(&scene, scene.film_resolution.cells);
    let n = flying.film.n_cells();
    let band = flying.lin.by_psi.band();
    println!(
        "{n} cells, {} entries below and {} above the diagonal",
        band.below, band.above
    );
    let mut residual = vec![0.0; n];
    let rhs: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
    let mut lu = BandedLu::<f64>::new(n, band);
    let mut rounded = BandedLu::<f32>::new(n, band);

    let mut group = c.benchmark_group("film");
    group.bench_function("residual", |b| b.iter(|| flying.residual(&mut residual)));
    group.bench_function("linearise", |b| b.iter(|| flying.linearise()));
    let (matrix, storage) = (&flying.lin.by_psi, flying.film.storage());
    group.bench_function("factor", |b| {
        b.iter(|| lu.factor(matrix, 1.0 / D_S, storage));
    });
    group.bench_function("factor_rounded", |b| {
        b.iter(|| rounded.factor(matrix, 1.0 / D_S, storage));
    });
    let mut x = rhs.clone();
    group.bench_function("solve", |b| {
        b.iter(|| {
            x.copy_from_slice(&rhs);
            lu.solve(&mut x);
        });
    });
    group.bench_function("solve_rounded", |b| {
        b.iter(|| {
            x.copy_from_slice(&rhs);
            rounded.solve(&mut x);
        });
    });
    let sparse = flying.sparse();
    let symbolic = SymbolicLu::try_new(sparse.symbolic()).expect("a pattern");
    group.bench_function("faer_factor_and_solve", |b| {
        b.iter(|| {
            let lu = Lu::try_new_with_symbolic(symbolic.clone(), sparse.as_ref()).expect("factors");
            black_box(lu.solve(column(&rhs)))
        });
    });
    if let Some(klu) = Klu::load() {
        let columns = columns(&sparse);
        let mut factors = klu.factor(&columns).expect("factors");
        let mut both = |name: &str, renew: fn(&mut opshock_klu::Factors<'_>) -> bool| {
            group.bench_function(name, |b| {
                b.iter(|| {
                    x.copy_from_slice(&rhs);
                    renew(&mut factors) && factors.solve(&mut x)
                });
            });
        };
        both("klu_factor_and_solve", |factors| factors.factor_anew());
        both("klu_refactor_and_solve", |factors| factors.refactor());
    }
    group.finish();
}

fn columns(matrix: &SparseColMat<usize, f64>) -> Columns {
    Columns::new(matrix.col_ptr(), matrix.row_idx(), matrix.val())
}

fn column(rhs: &[f64]) -> Mat<f64> {
    Mat::from_fn(rhs.len(), 1, |i, _| rhs[i])
}

/// What the kernels cost as the grid grows, faer beside them; exponents between the ends.
fn against_size(_: &mut Criterion) {
    faer::set_global_parallelism(Par::Seq);
    let scene = scenes::scene("fig13-stiffness", "none", 0.5, &[]);
    let klu = Klu::load();
    println!(
        "| cells | residual, us | factor, us | solve, us | faer factor + solve, us | ratio | \
         KLU refactor + solve, us | ratio |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    for cells in SIZES {
        let mut flying = Flying::of(&scene, cells);
        let n = flying.film.n_cells();
        let mut x = vec![1.0; n];
        let residual = median_of(9, || {
            black_box(flying.residual(&mut x));
        });
        let mut lu = BandedLu::<f64>::new(n, flying.lin.by_psi.band());
        let (matrix, storage) = (&flying.lin.by_psi, flying.film.storage());
        let factor = median_of(9, || {
            lu.factor(matrix, 1.0 / D_S, storage).expect("factors")
        });
        let rhs: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        x.copy_from_slice(&rhs);
        let solve = median_of(9, || lu.solve(&mut x));
        x.copy_from_slice(&rhs);
        lu.solve(&mut x);
        let sparse = flying.sparse();
        let symbolic = SymbolicLu::try_new(sparse.symbolic()).expect("a pattern");
        let mut other = column(&rhs);
        let faer = median_of(9, || {
            let lu = Lu::try_new_with_symbolic(symbolic.clone(), sparse.as_ref()).expect("factors");
            other = lu.solve(column(&rhs));
        });
        for (a, b) in x.iter().zip(other.col_as_slice(0)) {
            assert!((a - b).abs() <= 1e-8 * b.abs().max(1e-12), "{a} {b}");
        }
        let klu = klu.as_ref().map(|klu| {
            let columns = columns(&sparse);
            let mut factors = klu.factor(&columns).expect("factors");
            let mut other = rhs.clone();
            let time = median_of(9, || {
                other.copy_from_slice(&rhs);
                assert!(factors.refactor() && factors.solve(&mut other));
            });
            for (a, b) in x.iter().zip(&other) {
                assert!((a - b).abs() <= 1e-8 * b.abs().max(1e-12), "{a} {b}");
            }
            time
        });
        let beside = klu.map_or("- | -".to_string(), |time| {
            format!("{:.0} | {:.2}", 1e6 * time, time / (factor + solve))
        });
        println!(
            "| {n} | {:.1} | {:.0} | {:.1} | {:.0} | {:.2} | {beside} |",
            1e6 * residual,
            1e6 * factor,
            1e6 * solve,
            1e6 * faer,
            faer / (factor + solve)
        );
        rows.push((n as f64, [residual, factor, solve, faer]));
    }
    let [(n0, first), .., (n1, last)] = rows[..] else {
        return;
    };
    let exponents: [f64; 4] = std::array::from_fn(|k| (last[k] / first[k]).ln() / (n1 / n0).ln());
    println!("exponents from {n0} to {n1} cells: residual, factor, solve, faer: {exponents:.2?}");
}

/// Registers with numbers that do not wait for one another.
const IN_FLIGHT: usize = 12;

/// Rounds of a throughput.
const ROUNDS: usize = 4000;

/// Products and sums, fused, or divisions, as many as the processor can do at most.
struct Throughput {
    divides: bool,
}

impl WithSimd for Throughput {
    /// A result, that it is computed, and the numbers in a register.
    type Output = (f64, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let by = simd.splat_f64s(black_box(1.0 + 1e-9));
        let more = simd.splat_f64s(black_box(1e-9));
        let mut x = [simd.splat_f64s(1.0); IN_FLIGHT];
        if self.divides {
            for _ in 0..ROUNDS {
                for x in &mut x {
                    *x = simd.div_f64s(by, *x);
                }
            }
        } else {
            for _ in 0..ROUNDS {
                for x in &mut x {
                    *x = simd.mul_add_e_f64s(*x, by, more);
                }
            }
        }
        let sum = x.iter().map(|x| simd.reduce_sum_f64s(*x)).sum();
        (sum, S::F64_LANES)
    }
}

/// Numbers read once, one after the other: what a solution does with its factors.
struct Reading<'a>(&'a [f64]);

impl WithSimd for Reading<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (registers, _) = S::as_simd_f64s(self.0);
        let mut sums = [simd.splat_f64s(0.0); IN_FLIGHT];
        for some in registers.chunks_exact(IN_FLIGHT) {
            for (sum, x) in sums.iter_mut().zip(some) {
                *sum = simd.add_f64s(*sum, *x);
            }
        }
        sums.iter().map(|sum| simd.reduce_sum_f64s(*sum)).sum()
    }
}

/// What this machine can do of eight numbers at once: the bound of balance and linearisation, which work on as many
/// faces. And what reading as many bytes as the factors of the default grid have takes: the bound of a solution.
fn bound(_: &mut Criterion) {
    let of_eight_ns = |divides: bool| {
        let (_, lanes) = widest(Throughput { divides });
        let seconds = median_of(51, || {
            black_box(widest(Throughput { divides }));
        });
        1e9 * seconds / (ROUNDS * IN_FLIGHT * lanes) as f64 * 8.0
    };
    println!(
        "eight products and sums {:.4} ns, eight divisions {:.3} ns",
        of_eight_ns(false),
        of_eight_ns(true)
    );
    // Rows of 46 and 23 numbers beside two triangles of sixteen rows, 1012 times.
    let numbers = 1012 * (46 + 23 + 2 * 16);
    for (of, factors) in [
        ("single", vec![1.0; numbers / 2]),
        ("double", vec![1.0; numbers]),
    ] {
        let read_s = median_of(51, || {
            black_box(widest(Reading(black_box(&factors))));
        });
        println!(
            "{:.2} MB of {of} factors read in {:.2} us",
            8e-6 * factors.len() as f64,
            1e6 * read_s
        );
    }
}

criterion_group!(benches, kernels, bound, against_size);
criterion_main!(benches);
