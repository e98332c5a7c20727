//! Pages that show output show what the program prints: their commands are run here, and every line of the block
//! behind a command must be in its output.

use crate::cli::Done;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub(crate) fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.canonicalize().unwrap()
}

pub(crate) fn page(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap()
}

/// Blocks of a page, in order, each with what stands behind its three quotes.
pub(crate) fn blocks(page: &str) -> Vec<(&str, &str)> {
    let parts = page.split("```").skip(1).step_by(2);
    parts.map(|part| part.split_once('\n').unwrap()).collect()
}

/// Arguments of the command `opshock NAME` and the lines shown behind it.
fn shown<'a>(page: &'a str, name: &str) -> (Vec<String>, Vec<&'a str>) {
    let blocks = blocks(page);
    let command = format!("target/release/opshock {name} ");
    let pairs = blocks.windows(2);
    let found = pairs
        .filter(|pair| (pair[0].0, pair[1].0) == ("sh", "text"))
        .find(|pair| pair[0].1.starts_with(&command));
    let pair = found.unwrap_or_else(|| panic!("no output behind {name}"));
    let words = pair[0].1.replace("\\\n", " ");
    let words = words.split_whitespace().skip(1).map(str::to_owned);
    (words.collect(), pair[1].1.lines().collect())
}

/// `opshock new`, with the first block of settings of the page laid over it.
pub(crate) fn drive_of(page: &str, at: &Path) {
    let new = Done::of(at, &["new"]);
    assert_eq!(new.code, 0, "{}", new.stderr);
    let mut study: toml::Table = new.stdout.parse().unwrap();
    let settings = blocks(page).into_iter().find(|block| block.0 == "toml");
    let settings: toml::Table = settings.unwrap().1.parse().unwrap();
    for (section, keys) in settings {
        let own = study.get_mut(&section).and_then(toml::Value::as_table_mut);
        own.unwrap().extend(keys.as_table().unwrap().clone());
    }
    std::fs::write(at.join("my-drive.toml"), study.to_string()).unwrap();
}

/// Runs a command of a page in a folder and holds what is shown behind it against its output.
fn prints_in(at: &Path, page: &str, name: &str) {
    let (words, lines) = shown(page, name);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = Done::of(at, &words);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let printed: BTreeSet<&str> = done.stdout.lines().map(str::trim_end).collect();
    for line in lines {
        assert!(printed.contains(line.trim_end()), "{line}\n{}", done.stdout);
    }
}

fn prints_what_is_shown(name: &str) {
    let page = page("docs/your-own-drive.md");
    let at = tempfile::tempdir().unwrap();
    drive_of(&page, at.path());
    prints_in(at.path(), &page, name);
}

#[test]
fn the_measured_pulse_is_shown_as_it_is() {
    let page = page("docs/measured-pulses.md");
    prints_in(&root(), &page, "pulse");
    prints_in(&root(), &page, "run");
    let study = root().join("docs/measured-pulse/study.toml");
    let keys: toml::Table = std::fs::read_to_string(study).unwrap().parse().unwrap();
    let shown = blocks(&page).into_iter().find(|block| block.0 == "toml");
    let shown: toml::Table = shown.unwrap().1.parse().unwrap();
    assert_eq!(keys["pulse"], shown["pulse"]);
}

#[test]
fn the_first_shock_of_the_own_drive_is_shown_as_it_is() {
    prints_what_is_shown("run");
}

#[test]
#[ignore = "slow: a sweep of 8 points, about a minute"]
fn documents_slow_sweep_of_the_own_drive_is_shown_as_it_is() {
    prints_what_is_shown("sweep");
}

/// Runs the commands of a block in a folder, what they print into the files that they name; the last one's output.
fn run_block(at: &Path, commands: &str) -> Done {
    let commands = commands.replace("\\\n", " ");
    let one = |command: &str| {
        let words = command.split_whitespace().skip(1);
        let words: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
        let to_file = words.iter().position(|&word| word == ">");
        let done = Done::of(at, &words[..to_file.unwrap_or(words.len())]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        if let Some(place) = to_file {
            std::fs::write(at.join(words[place + 1]), &done.stdout).unwrap();
        }
        done
    };
    let mut all: Vec<Done> = commands.lines().map(one).collect();
    all.pop().unwrap()
}

/// The best of five clearances: `new`, the sweep, and what `compare` prints.
#[test]
#[ignore = "slow: a sweep of 30 points, about a minute"]
fn documents_slow_best_of_five_clearances_is_shown_as_it_is() {
    let page = page("docs/your-own-drive.md");
    let at = tempfile::tempdir().unwrap();
    let is_it = |block: &(&str, &str)| block.1.contains("new > five.toml");
    run_block(at.path(), blocks(&page).into_iter().find(is_it).unwrap().1);
    prints_in(at.path(), &page, "compare");
}

/// What the page on specifications shows of a drive of the reader's own.
#[test]
#[ignore = "slow: a specification with its intervals, half a minute"]
fn documents_slow_specification_of_the_own_drive_is_shown_as_it_is() {
    let page = page("docs/qualify.md");
    let at = tempfile::tempdir().unwrap();
    let mut all = blocks(&page).into_iter();
    let spec = all.find(|(kind, text)| *kind == "toml" && text.starts_with("spec_format"));
    std::fs::write(at.path().join("spec.toml"), spec.unwrap().1).unwrap();
    let done = run_block(at.path(), all.next().unwrap().1);
    for line in all.next().unwrap().1.lines() {
        assert!(done.stdout.contains(line), "{line}\n{}", done.stdout);
    }
}

/// Rows of Fig. 13 that pages show are those of its committed table.
#[test]
fn rows_of_pages_are_those_of_the_committed_table() {
    assert!(rows_of_fig13("README.md") >= 2);
    assert_eq!(rows_of_fig13("docs/paper.md"), 2);
}

/// Holds a page's rows against the table, and counts them.
fn rows_of_fig13(name: &str) -> usize {
    let page = page(name);
    let table = blocks(&page)
        .into_iter()
        .find(|(_, text)| text.starts_with("ramp  "));
    let committed = std::fs::read_to_string(root().join("results/fig13/table.csv")).unwrap();
    let mut found = 0;
    for row in table.unwrap().1.lines().skip(1) {
        let words: Vec<&str> = row.split_whitespace().collect();
        let key = words[..3].join(",") + ",";
        let line = committed.lines().find(|line| line.starts_with(&key));
        let values: Vec<&str> = line.expect("such a point").split(',').collect();
        let of = |at: usize, sign: &str| {
            let value: f64 = values[at].parse().unwrap();
            format!("{sign}{value:.1}")
        };
        for expected in [
            of(3, ""),
            of(4, "+-"),
            format!("{:+.1}", values[5].parse::<f64>().unwrap()),
            of(6, ""),
            of(7, ""),
            values[9].to_owned(),
        ] {
            assert!(words.contains(&expected.as_str()), "{row}: {expected}");
        }
        assert!(
            row.trim_end().ends_with(&values[11].replace(';', ", ")),
            "{row}"
        );
        found += 1;
    }
    found
}

/// The heading of the table that both pages show.
#[test]
fn headings_of_tables_are_those_of_the_program() {
    let at = tempfile::tempdir().unwrap();
    drive_of(&page("docs/your-own-drive.md"), at.path());
    let sets = [
        "--set",
        "resolution.preset=coarse",
        "--max-refinements",
        "0",
    ];
    let one = [
        "--set",
        "pulse.widths_ms=2",
        "--set",
        "ramp.models=[\"rigid\"]",
        "--set",
        "resolution.film_cells=200",
        "--set",
        "resolution.disk_cut_khz=10",
    ];
    let done = Done::of(
        at.path(),
        &[&["sweep", "my-drive.toml"][..], &sets, &one].concat(),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let heading = done
        .stdout
        .lines()
        .find(|line| line.starts_with("ramp "))
        .unwrap();
    let titles = |heading: &str| -> Vec<String> {
        let titles = heading
            .split("  ")
            .map(str::trim)
            .filter(|title| !title.is_empty());
        titles.map(str::to_owned).collect()
    };
    let printed = titles(heading);
    for name in ["README.md", "docs/your-own-drive.md"] {
        let page = page(name);
        let table = blocks(&page)
            .into_iter()
            .find(|(_, text)| text.starts_with("ramp  "));
        let shown = titles(table.unwrap().1.lines().next().unwrap());
        assert!(
            shown.iter().all(|title| printed.contains(title)),
            "{name}: {shown:?} {printed:?}"
        );
    }
}

/// A page that the program writes is committed as it writes it today.
fn is_todays(option: &str, name: &str) {
    let at = tempfile::tempdir().unwrap();
    let done = Done::of(at.path(), &["schema", option]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let path = root().join(name);
    if std::env::var_os("INSTA_UPDATE").is_some_and(|how| how == "always") {
        std::fs::write(&path, &done.stdout).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(
        committed == done.stdout,
        "write it anew: opshock schema {option} > {name}"
    );
}

#[test]
fn the_reference_of_words_is_todays() {
    is_todays("--terms", "docs/terms.md");
}

#[test]
fn the_reference_of_commands_is_todays() {
    is_todays("--commands", "docs/commands.md");
}

/// The reference of keys is today's, and knows every key with its words.
#[test]
fn the_reference_of_keys_is_todays() {
    is_todays("--markdown", "docs/keys.md");
    let at = tempfile::tempdir().unwrap();
    let one = Done::of(at.path(), &["schema", "disk.thickness_mm"]);
    assert_eq!(one.code, 0, "{}", one.stderr);
    for line in [
        "disk.thickness_mm",
        "  meaning   Thickness.",
        "  unit      mm (length)",
        "  value     a number, > 0",
        "  usually   0.1 to 3; else a warning (W201)",
        "  default   0.635",
    ] {
        assert!(
            one.stdout.lines().any(|found| found == line),
            "{line}\n{}",
            one.stdout
        );
    }
    let reference = page("docs/keys.md");
    let keys = reference
        .lines()
        .filter_map(|line| line.strip_prefix("**`"));
    let keys: Vec<&str> = keys.map(|line| line.split_once('`').unwrap().0).collect();
    let all = Done::of(at.path(), &[&["schema"][..], &keys].concat());
    assert_eq!(all.code, 0, "{}", all.stderr);
    assert_eq!(all.stdout.matches("  acts on ").count(), keys.len());
    let wrong = Done::of(at.path(), &["schema", "slider.thickness_mm"]);
    assert_eq!(wrong.code, 2);
    assert!(
        wrong.stderr.contains("did you mean disk.thickness_mm"),
        "{}",
        wrong.stderr
    );
}
