//! Critical shocks made independently of the uncertainty rules, and whether intervals contain them.
//!
//! A truth is searched for from the middle of an interval outwards to the first bracket; failures far below it are not seen.
//! It has uncorrected films of some 8000 and 16 000 cells, all modes of the suspension, half the time step of disk and ramp,
//! and tolerances of the head sixteen times smaller. The film's error halves from each film to the next (second order in the
//! cell's length), so that the truth is 2 A - B with A and B the critical shocks on the finest film and the one before. Its
//! own uncertainty is |A - B| plus half of both brackets. Where that is too much for an interval that meets its target, a
//! third film of some 32 000 cells follows; where it is more than a fifth of an interval's half-width the truth is unusable
//! for it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{
    Model, Request, Scope, Verdict as SolverVerdict, Workspace, simulate,
};
use opshock_solver::suspension::ReducedSuspension;

use super::coverage::{Truth, provenance_line};
use super::verify::truth;

/// Cells of the films.
const CELLS: [usize; 3] = [8_000, 16_000, 32_000];
/// Width of a truth's brackets, a share.
const BRACKET: f64 = 5e-4;
/// Largest uncertainty of a usable truth over the half-width of the interval, and share of truths that may exceed it.
const USABLE: f64 = 0.2;
const UNUSABLE: f64 = 0.1;

/// Brackets of a scene's critical shock on the films so far; fewer than two where a shock has no verdict.
pub(super) type Brackets = Vec<Truth>;

/// Folder of the committed results.
pub(super) fn results() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../results")
}

/// The scene without correction of its film, on `cells` cells, everything but the disk's modes finer.
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

/// Goes on from the brackets that are `known`, the finest film last, to at most `films`; a third one is for intervals of a
/// half-width `target`, a share, where two do not suffice.
pub(super) fn truths(
    scene: &Scene,
    sign: f64,
    from_g: f64,
    target: f64,
    films: usize,
    known: &[Truth],
) -> Brackets {
    let mut found: Brackets = Vec::new();
    for (place, cells) in CELLS.into_iter().take(films.max(known.len())).enumerate() {
        if place == 2 && extrapolated(&found).is_some_and(|(g, own_g)| own_g <= USABLE * target * g)
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

/// Committed brackets by name of the point, with the digest of its scene.
pub(super) struct Truths {
    path: PathBuf,
    header: String,
    rows: BTreeMap<String, (String, Brackets)>,
}

impl Truths {
    /// What `results/uncertainty/FILE` has; a point's name has the columns `key`.
    pub(super) fn open(file: &str, key: &str) -> Truths {
        let mut header = format!("{key},scene");
        for cells in CELLS {
            let _ = write!(header, ",low_{cells}_g,high_{cells}_g");
        }
        let path = results().join("uncertainty").join(file);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let columns = key.split(',').count();
        let lines = text.lines().skip_while(|line| *line != header).skip(1);
        let one = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            let numbers: Vec<f64> = cells[columns + 1..]
                .iter()
                .map_while(|cell| cell.parse().ok())
                .collect();
            let brackets = numbers.chunks_exact(2).map(|ends| Truth {
                low_g: ends[0],
                high_g: ends[1],
            });
            let known = (cells[columns].to_owned(), brackets.collect());
            (cells[..columns].join(","), known)
        };
        let rows = lines.map(one).collect();
        Truths { path, header, rows }
    }

    /// Brackets of a point, if they are of this scene.
    pub(super) fn of(&self, name: &str, scene: &str) -> Brackets {
        match self.rows.get(name) {
            Some((of, brackets)) if of == scene => brackets.clone(),
            _ => Vec::new(),
        }
    }

    pub(super) fn put(&mut self, name: &str, scene: &str, brackets: Brackets) {
        self.rows
            .insert(name.to_owned(), (scene.to_owned(), brackets));
        let mut text = format!("{}\n{}\n", provenance_line(), self.header);
        for (name, (scene, brackets)) in &self.rows {
            let _ = write!(text, "{name},{scene}");
            for place in 0..CELLS.len() {
                match brackets.get(place) {
                    Some(one) => _ = write!(text, ",{:.4},{:.4}", one.low_g, one.high_g),
                    None => text.push_str(",,"),
                }
            }
            text.push('\n');
        }
        std::fs::create_dir_all(self.path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&self.path, text).expect("written");
    }
}

/// Calls `one` for every item, on all cores.
pub(super) fn on_all_cores<T: Sync>(items: &[T], one: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    one(item);
                }
            });
        }
    });
}

/// An interval and what is known of its truth.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) name: String,
    pub(super) middle_g: f64,
    pub(super) half_g: f64,
    pub(super) brackets: Brackets,
    /// What the truth's own uncertainty has beyond its films, G.
    pub(super) change_g: f64,
}

/// What truths say of some intervals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judgement {
    inside: usize,
    usable: usize,
    unusable: usize,
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

/// Prints every interval with its truth, and how many hold.
pub(super) fn judge(intervals: &[Judged]) -> Judgement {
    let mut judgement = Judgement {
        inside: 0,
        usable: 0,
        unusable: 0,
    };
    let mut ratios = Vec::new();
    for one in intervals {
        let (low_g, high_g) = (one.middle_g - one.half_g, one.middle_g + one.half_g);
        let interval = format!("{}: {low_g:.2} to {high_g:.2} G", one.name);
        let Some((truth_g, own_g)) = extrapolated(&one.brackets) else {
            println!("{interval}: no verdict");
            judgement.unusable += 1;
            continue;
        };
        let own_g = own_g + one.change_g;
        let is_usable = own_g <= USABLE * one.half_g;
        let is_inside = (low_g..=high_g).contains(&truth_g);
        println!(
            "{interval}, truth {truth_g:.2} +- {own_g:.2} G on {} films: {}{}",
            one.brackets.len(),
            if is_inside { "inside" } else { "outside" },
            if is_usable { "" } else { ", unusable" }
        );
        if !is_usable {
            judgement.unusable += 1;
            continue;
        }
        judgement.usable += 1;
        judgement.inside += usize::from(is_inside);
        ratios.push(one.half_g / (truth_g - one.middle_g).abs().max(own_g));
    }
    ratios.sort_by(f64::total_cmp);
    println!(
        "{} of {} usable truths inside, {} needed; {} unusable; half-width over true error, median {:.1}",
        judgement.inside,
        judgement.usable,
        fewest(judgement.usable),
        judgement.unusable,
        ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN)
    );
    judgement
}

impl Judgement {
    /// # Panics
    /// When a coverage of 95 % is rejected, or too many truths are unusable.
    pub(super) fn hold(self) {
        assert!(self.inside >= fewest(self.usable), "{self:?}");
        let most = UNUSABLE * (self.usable + self.unusable) as f64;
        assert!(self.unusable as f64 <= most, "{self:?}");
    }
}
