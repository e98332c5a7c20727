//! `results/accuracy/coverage.csv`: uncertainty intervals against truths, a line each; lines of earlier programs.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use opshock_study::provenance;

/// Last survivor and first failure of a scene ten times finer, G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Truth {
    pub(super) low_g: f64,
    pub(super) high_g: f64,
}

impl Truth {
    pub(super) fn middle_g(self) -> f64 {
        0.5 * (self.low_g + self.high_g)
    }
}

/// One interval against the truth, G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Covered {
    pub(super) a_crit_g: f64,
    pub(super) half_g: f64,
    pub(super) truth: Truth,
    /// A contribution could not be found and is missing in the interval, which says so by its flag.
    pub(super) is_partial: bool,
}

impl Covered {
    pub(super) fn inside(&self) -> bool {
        (self.a_crit_g - self.truth.middle_g()).abs() <= self.half_g
    }

    fn ratio(&self) -> f64 {
        self.half_g / (self.a_crit_g - self.truth.middle_g()).abs().max(1e-9)
    }
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Digest of scene and physics that the truth belongs to; empty for laws.
    pub(super) scene: String,
    /// `None`: no critical shock in range, or no verdict of the finer scene.
    pub(super) covered: Option<Covered>,
}

/// What was measured, by kind and seed.
pub(super) struct Log {
    path: PathBuf,
    rows: BTreeMap<(String, u64), Line>,
    /// Truths that programs of before left behind.
    truths: BTreeMap<(String, u64), (String, Truth)>,
}

const HEADER: &str =
    "kind,seed,scene,a_crit_g,uncertainty_g,truth_low_g,truth_high_g,inside,partial";

impl Log {
    /// What this program has measured so far, and the truths that others have.
    pub(super) fn open() -> Log {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results/accuracy/coverage.csv");
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let mut log = Log {
            path,
            rows: BTreeMap::new(),
            truths: BTreeMap::new(),
        };
        let mut lines = text.lines();
        let is_own = lines.next() == Some(&provenance_line());
        if lines.next() != Some(HEADER) {
            return log;
        }
        for line in lines {
            if let Some(kept) = line.strip_prefix("# ") {
                log.keep(kept);
                continue;
            }
            let cells: Vec<&str> = line.split(',').collect();
            let number = |place: usize| cells[place].parse().ok();
            let covered = || {
                Some(Covered {
                    a_crit_g: number(3)?,
                    half_g: number(4)?,
                    truth: Truth {
                        low_g: number(5)?,
                        high_g: number(6)?,
                    },
                    is_partial: cells[8] == "true",
                })
            };
            let key = (cells[0].to_owned(), cells[1].parse().expect("a seed"));
            let (scene, covered) = (cells[2].to_owned(), covered());
            match covered {
                _ if is_own => _ = log.rows.insert(key, Line { scene, covered }),
                Some(known) if !scene.is_empty() => {
                    log.truths.insert(key, (scene, known.truth));
                }
                _ => {}
            }
        }
        log
    }

    /// Takes over a truth without interval: kind, seed, scene, low, high.
    fn keep(&mut self, line: &str) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse().expect("a number");
        let truth = Truth {
            low_g: number(3),
            high_g: number(4),
        };
        let key = (cells[0].to_owned(), cells[1].parse().expect("a seed"));
        self.truths.insert(key, (cells[2].to_owned(), truth));
    }

    /// The truth that is known of a scene.
    pub(super) fn truth(&self, kind: &str, seed: u64, scene: &str) -> Option<Truth> {
        let (of, truth) = self.truths.get(&(kind.to_owned(), seed))?;
        (of == scene).then_some(*truth)
    }

    pub(super) fn has(&self, kind: &str, seed: u64) -> bool {
        self.rows.contains_key(&(kind.to_owned(), seed))
    }

    /// Answers of a kind.
    pub(super) fn answered(&self, kind: &str) -> usize {
        let of = self.rows.iter().filter(|((known, _), _)| known == kind);
        of.filter(|(_, line)| line.covered.is_some_and(|covered| !covered.is_partial))
            .count()
    }

    pub(super) fn put(&mut self, kind: &str, seed: u64, line: Line) {
        self.rows.insert((kind.to_owned(), seed), line);
        let mut text = format!("{}\n{HEADER}\n", provenance_line());
        for ((kind, seed), line) in &self.rows {
            let scene = &line.scene;
            let Some(c) = line.covered else {
                let _ = writeln!(text, "{kind},{seed},{scene},,,,,,");
                continue;
            };
            let _ = writeln!(
                text,
                "{kind},{seed},{scene},{:.4},{:.4},{:.4},{:.4},{},{}",
                c.a_crit_g,
                c.half_g,
                c.truth.low_g,
                c.truth.high_g,
                c.inside(),
                c.is_partial
            );
        }
        // Truths that this program has not come to yet stay for it, or for the next.
        for (key, (scene, truth)) in &self.truths {
            if !self.rows.contains_key(key) {
                let (kind, seed) = key;
                let _ = writeln!(
                    text,
                    "# {kind},{seed},{scene},{:.4},{:.4}",
                    truth.low_g, truth.high_g
                );
            }
        }
        std::fs::create_dir_all(self.path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&self.path, text).expect("written");
    }

    /// Share inside and median ratio of the whole intervals of some kinds, printed.
    pub(super) fn judge(&self, kinds: &[&str]) -> (f64, f64) {
        let of: Vec<&Covered> = self
            .rows
            .iter()
            .filter(|((kind, _), _)| kinds.contains(&kind.as_str()))
            .filter_map(|(_, line)| line.covered.as_ref())
            .filter(|covered| !covered.is_partial)
            .collect();
        let inside = of.iter().filter(|one| one.inside()).count();
        let mut ratios: Vec<f64> = of.iter().map(|one| one.ratio()).collect();
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        println!(
            "{}: {inside} of {} inside ({:.1} %), median half interval {median:.1} times the error",
            kinds.join(" and "),
            of.len(),
            100.0 * inside as f64 / of.len() as f64
        );
        (inside as f64 / of.len() as f64, median)
    }
}

pub(super) fn provenance_line() -> String {
    format!("# {}", provenance::program())
}

/// First eight bytes of a digest, as the tables name scenes.
pub(super) fn scene_name(digest: &[u8]) -> String {
    digest[..8]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
