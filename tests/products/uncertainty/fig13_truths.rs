//! `make verify-uncertainty`: do the uncertainty intervals of `results/fig13` contain critical shocks that were made
//! independently?
//!
//! A truth is searched for on uncorrected films of some 8000 and 16 000 cells, with all modes of the suspension, half the
//! time step of disk and ramp, and tolerances of the head sixteen times smaller. The disk's highest frequency stays: it is a
//! value of the model of `studies/fig13`. The film's error halves from each film to the next (second order in the cell's
//! length), so that the truth is 2 A - B with A and B the critical shocks on the finest film and the one before. Its own
//! uncertainty is |A - B| plus half of both brackets. Where that is too much for an interval that meets its target, a third
//! film of some 32 000 cells follows; where it is more than a fifth of the interval's half-width the truth is unusable.
//! Every truth is a line of `results/uncertainty/fig13.csv`; run again, it goes on from there, as long as the scene is the same.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{
    Model, Request, Scope, Verdict as SolverVerdict, Workspace, simulate,
};
use opshock_solver::suspension::ReducedSuspension;
use opshock_study::sweep::SweepInput;
use opshock_tests::scenes::study;
use opshock_tests::seeded::seeds;

use super::coverage::Truth;
use super::verify::truth;

/// Cells of the films.
const CELLS: [usize; 3] = [8_000, 16_000, 32_000];
/// Width of a truth's brackets, a share.
const BRACKET: f64 = 1e-3;
/// Half-width of an interval that meets its target, a share.
const TARGET: f64 = 0.01;
/// Largest uncertainty of a usable truth over the half-width of the interval, and share of truths that may exceed it.
const USABLE: f64 = 0.2;
const UNUSABLE: f64 = 0.1;

/// A row of the table of Fig. 13, G.
#[derive(Clone, Debug)]
struct Row {
    point: String,
    low_g: f64,
    high_g: f64,
}

impl Row {
    fn half_g(&self) -> f64 {
        0.5 * (self.high_g - self.low_g)
    }

    fn middle_g(&self) -> f64 {
        f64::midpoint(self.low_g, self.high_g)
    }
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../results")
}

/// Intervals by point (`ramp,pulse_ms,sign`).
fn intervals() -> Vec<Row> {
    let text = std::fs::read_to_string(folder().join("fig13/table.csv")).expect("a table");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let place = |name: &str| names.iter().position(|one| *one == name).expect("a column");
    let [crit, half] = ["a_crit_g", "uncertainty_g"].map(place);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| -> f64 { cells[place].parse().expect("an interval") };
        Row {
            point: cells[..3].join(","),
            low_g: number(crit) - number(half),
            high_g: number(crit) + number(half),
        }
    };
    lines.map(row).collect()
}

/// The scene without correction of its film, on `cells` cells, everything else finer.
fn independent(scene: &Scene, cells: usize) -> Scene {
    let mut finer = scene.clone();
    finer.film_resolution.cells = cells;
    finer.film_resolution.correction_cells = 0;
    finer.structure_resolution.step_s /= 2.0;
    finer.head_resolution.tolerance /= 16.0;
    finer.head_resolution.approach_share /= 2.0;
    finer.head_resolution.coupling_tolerance /= 16.0;
    let most = ReducedSuspension::most_bending_modes(&scene.suspension);
    finer.head_resolution.suspension_modes = most.expect("a suspension of beams");
    finer
}

/// Brackets of a scene's critical shock on the films so far; fewer than two where a shock has no verdict.
type Brackets = Vec<Truth>;

/// A truth and its own uncertainty, G.
fn extrapolated(brackets: &[Truth]) -> Option<(f64, f64)> {
    let &[.., coarse, fine] = brackets else {
        return None;
    };
    let change_g = fine.middle_g() - coarse.middle_g();
    let brackets_g = fine.high_g - fine.low_g + coarse.high_g - coarse.low_g;
    Some((
        fine.middle_g() + change_g,
        change_g.abs() + 0.5 * brackets_g,
    ))
}

/// Goes on from the brackets that are `known`, the finest film last.
fn truths(scene: &Scene, sign: f64, from_g: f64, known: &[Truth]) -> Brackets {
    let mut found: Brackets = Vec::new();
    for (place, cells) in CELLS.into_iter().enumerate() {
        if place == 2 && extrapolated(&found).is_some_and(|(g, own_g)| own_g <= USABLE * TARGET * g)
        {
            break;
        }
        let finer = independent(scene, cells);
        let mut built = None;
        let mut workspace = Workspace::default();
        let mut fails = |amplitude_g: f64| {
            let model = built
                .get_or_insert_with(|| Model::build(&finer, Scope::Full, None).expect("builds"));
            let request = Request {
                amplitude_m_per_s2: sign * m_per_s2_from_g(amplitude_g),
                record: false,
            };
            match simulate(model, &request, &mut workspace).verdict {
                Some(SolverVerdict::Survives) => Some(false),
                Some(SolverVerdict::Fails { .. }) => Some(true),
                _ => None,
            }
        };
        let near_g = found.last().map_or(from_g, |one| one.middle_g());
        match truth(near_g, BRACKET, known.get(place).copied(), &mut fails) {
            Some(one) => found.push(one),
            None => break,
        }
    }
    found
}

/// The brackets of `results/uncertainty/fig13.csv`, by point, with the digest of the scene.
struct Log(BTreeMap<String, (String, Brackets)>);

const HEADER: &str = "ramp,pulse_ms,sign,scene,low_8000_g,high_8000_g,low_16000_g,high_16000_g,low_32000_g,high_32000_g";

impl Log {
    fn path() -> PathBuf {
        folder().join("uncertainty/fig13.csv")
    }

    fn open() -> Log {
        let text = std::fs::read_to_string(Log::path()).unwrap_or_default();
        let lines = text.lines().skip_while(|line| *line != HEADER).skip(1);
        let one = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            let numbers: Vec<f64> = cells[4..]
                .iter()
                .map_while(|cell| cell.parse().ok())
                .collect();
            let brackets = numbers.chunks_exact(2).map(|ends| Truth {
                low_g: ends[0],
                high_g: ends[1],
            });
            (
                cells[..3].join(","),
                (cells[3].to_owned(), brackets.collect()),
            )
        };
        Log(lines.map(one).collect())
    }

    fn put(&mut self, point: &str, scene: String, brackets: Brackets) {
        self.0.insert(point.to_owned(), (scene, brackets));
        let mut text = format!("{}\n{HEADER}\n", super::coverage::provenance_line());
        for (point, (scene, brackets)) in &self.0 {
            let _ = write!(text, "{point},{scene}");
            for place in 0..CELLS.len() {
                match brackets.get(place) {
                    Some(one) => _ = write!(text, ",{:.4},{:.4}", one.low_g, one.high_g),
                    None => text.push_str(",,"),
                }
            }
            text.push('\n');
        }
        let path = Log::path();
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("written");
    }
}

/// Fewest of `n` truths inside that do not reject a coverage of 95 % at 1 %, exactly.
fn fewest(n: usize) -> usize {
    let mut below = 0.0;
    let mut share = 0.05_f64.powi(n as i32);
    for inside in 0..=n {
        below += share;
        if below > 0.01 {
            return inside;
        }
        share *= 19.0 * (n - inside) as f64 / (inside + 1) as f64;
    }
    n
}

#[test]
fn fewest_truths_inside_are_those_of_the_exact_binomial_test() {
    // scipy.stats.binom.ppf(0.01, n, 0.95)
    assert_eq!([40, 76].map(fewest), [34, 67]);
}

fn judge(rows: &[Row], log: &Log) {
    let (mut inside, mut usable, mut unusable) = (0, 0, 0);
    let mut ratios = Vec::new();
    for row in rows {
        let interval = format!("{}: {:.2} to {:.2} G", row.point, row.low_g, row.high_g);
        let Some((_, brackets)) = log.0.get(&row.point) else {
            continue;
        };
        let Some((truth_g, own_g)) = extrapolated(brackets) else {
            println!("{interval}: no verdict");
            unusable += 1;
            continue;
        };
        let is_inside = (row.low_g..=row.high_g).contains(&truth_g);
        let word = match (own_g <= USABLE * row.half_g(), is_inside) {
            (false, _) => "unusable",
            (true, true) => "inside",
            (true, false) => "outside",
        };
        println!(
            "{interval}, truth {truth_g:.2} +- {own_g:.2} G on {} films: {word}",
            brackets.len()
        );
        if own_g > USABLE * row.half_g() {
            unusable += 1;
            continue;
        }
        usable += 1;
        inside += usize::from(is_inside);
        ratios.push(row.half_g() / (truth_g - row.middle_g()).abs().max(own_g));
    }
    ratios.sort_by(f64::total_cmp);
    println!(
        "{inside} of {usable} usable truths inside, {} needed; {unusable} unusable; half-width over true error, median {:.1}",
        fewest(usable),
        ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN)
    );
    assert!(inside >= fewest(usable), "{inside} of {usable}");
    let most = UNUSABLE * (usable + unusable) as f64;
    assert!(unusable as f64 <= most, "{unusable} unusable");
}

#[test]
#[ignore = "make verify-uncertainty: hours, resumable"]
fn uncertainty_slow_truths_lie_inside_the_intervals_of_fig13() {
    let rows = intervals();
    let study = study("fig13", &[]);
    let input = SweepInput::of(&study).expect("input");
    let log = Mutex::new(Log::open());
    let places: Vec<usize> = seeds(0..rows.len() as u64)
        .map(|seed| seed as usize)
        .collect();
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(&place) = places.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let row = &rows[place];
                    let names = study.points.iter().map(|point| {
                        format!("{},{},{}", point.ramp, point.pulse_ms, point.sign.as_str())
                    });
                    let place = { names }
                        .position(|name| name == row.point)
                        .expect("a point");
                    let digest = &input.points[place].digest.0[..8];
                    let scene: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
                    let known = match log.lock().expect("whole").0.get(&row.point) {
                        Some((of, brackets)) if *of == scene => brackets.clone(),
                        _ => Vec::new(),
                    };
                    let point = &study.points[place];
                    let found = truths(&point.scene, point.sign.factor(), row.middle_g(), &known);
                    if found != known {
                        println!("{}: {found:.1?}", row.point);
                        log.lock().expect("whole").put(&row.point, scene, found);
                    }
                }
            });
        }
    });
    judge(&rows, &log.into_inner().expect("whole"));
}
