//! `opshock yield`: tolerance files, the share that survives, and the program from tolerances to its files and exit codes.

use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use opshock_study::draws::draw;
use opshock_study::population::{
    Counts, DecidedBy, Level, Levels, Nominal, Part, Population, STORE, Tolerances, judge,
};
use opshock_study::qualification::{RequirementVerdict, Spec, Verdict};
use opshock_study::study::Study;
use opshock_study::sweep::{Physics, Silent, SweepInput, SweepOptions, Until, sweep};
use opshock_tests::program::program;
use opshock_tests::seeded::seeds;
use statrs::distribution::{ContinuousCDF as _, Normal};

use crate::cli::{COARSE, Done, OPSHOCK};
use crate::refused::every_file_is_refused;

fn drive(folder: &Path) -> PathBuf {
    let file = folder.join("drive.toml");
    std::fs::write(&file, Study::example("my drive")).expect("written");
    file
}

#[test]
fn every_damaged_tolerance_file_gets_its_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = drive(folder.path());
    every_file_is_refused("tolerances", 39, |path| {
        Tolerances::from_path(path, &study, &[]).err()
    });
}

const TOLERANCES: &str = r#"
tolerances_format = 1
name = "line 3"
drives = 3000
seed = 4
parts = "parts.csv"

[[tolerance]]
name = "clearance"
keys = ["ramp.clearance_um"]
normal = { mean = 100.0, sd = 5.0, range = [85.0, 115.0] }
source = "a drawing"

[[tolerance]]
name = "thickness"
keys = ["disk.thickness_mm"]
relative = true
uniform = [0.98, 1.02]
source = "a drawing"

[[correlation]]
between = ["clearance", "thickness"]
coefficient = -0.5
"#;

#[test]
fn drives_have_the_distributions_correlations_and_parts_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = drive(folder.path());
    let file = folder.path().join("tolerances.toml");
    std::fs::write(&file, TOLERANCES).expect("written");
    let parts = "suspension.gram_load_gf,slider.surface.crown_nm\n2.4,10.0\n2.5,14.0\n2.7,9.0\n";
    std::fs::write(folder.path().join("parts.csv"), parts).expect("written");
    let tolerances = Tolerances::from_path(&file, &study, &[]).expect("tolerances");
    let own = Study::from_path(&study, &[])
        .expect("a study")
        .resolved_toml();
    let own: toml::Table = own.parse().expect("TOML");
    let thickness_mm = own["disk"]["thickness_mm"].as_float().expect("a number");
    let values: Vec<Vec<f64>> = (0..tolerances.drives)
        .map(|index| {
            let values = tolerances.values(&tolerances.draw(index)).into_iter();
            let numbers = values.map(|(_, text)| text.expect("present").parse().expect("a number"));
            numbers.collect()
        })
        .collect();
    let n = values.len() as f64;
    let mean = |of: &dyn Fn(&[f64]) -> f64| values.iter().map(|one| of(one)).sum::<f64>() / n;
    // Each within five standard errors.
    assert!((mean(&|v| v[0]) - 100.0).abs() < 5.0 * 5.0 / n.sqrt());
    let sd = mean(&|v| (v[0] - 100.0).powi(2)).sqrt();
    // Cut off at three standard deviations, a normal distribution keeps 0.98658 of its own.
    assert!(
        (sd / (0.986_58 * 5.0) - 1.0).abs() < 5.0 / (2.0 * n).sqrt(),
        "{sd}"
    );
    let share = |v: &[f64]| (v[1] / thickness_mm - 1.0) / 0.02;
    assert!(mean(&|v| share(v)).abs() < 5.0 / (3.0 * n).sqrt());
    // Of a normal variable with a uniform one of the same copula: r sqrt(3 / pi).
    let both = mean(&|v| (v[0] - 100.0) / sd * share(v) * 3_f64.sqrt());
    let exact = -0.5 * (3.0 / std::f64::consts::PI).sqrt();
    assert!((both - exact).abs() < 0.08, "{both} {exact}");
    let is_part = |v: &[f64]| [[2.4, 10.0], [2.5, 14.0], [2.7, 9.0]].contains(&[v[2], v[3]]);
    assert!(values.iter().all(|v| is_part(v)));
    let first = mean(&|v| f64::from(u8::from(v[2] == 2.4)));
    assert!((first - 1.0 / 3.0).abs() < 5.0 * (2.0 / 9.0 / n).sqrt());
}

/// A drive whose critical amplitude is known, and the numerical error of its verdicts.
struct Mock {
    /// Of the true critical amplitude over the required one, in octaves.
    octaves: f64,
    /// What the simulated one is off, octaves.
    error: f64,
    /// Half-width of the uncertainty interval, octaves.
    half_width: f64,
}

impl Levels for Mock {
    type Interrupted = std::convert::Infallible;

    fn shock(&mut self, step: i32, refined: i8) -> Result<Level, Self::Interrupted> {
        let at = f64::from(step) / 8.0;
        let reserve = self.octaves + self.error * 0.5_f64.powi(refined.into()) - at;
        Ok(match reserve > 0.0 {
            true => Level::Survives(Some(1e-8 * reserve)),
            false => Level::Fails,
        })
    }

    fn failure_m(&self) -> f64 {
        0.0
    }

    fn interval(&mut self) -> Result<Verdict, Self::Interrupted> {
        let found = self.octaves + self.error;
        Ok(match () {
            () if found - self.half_width > 0.0 => Verdict::Passes,
            () if found + self.half_width < 0.0 => Verdict::Fails,
            () => Verdict::Undecided,
        })
    }
}

#[test]
fn stated_shares_hold_the_known_ones_of_300_populations() {
    let normal = Normal::standard();
    let mut held = 0;
    for problem in 0..300_u64 {
        let random = draw(77, problem, 4);
        // From one in ten to one in a thousand that fails; drives enough for some to fail.
        let fails = 10_f64.powf(-1.0 - 2.0 * random[0]);
        let n = (10.0 / fails) as u64;
        let spread = 0.1 + 0.3 * random[1];
        let bias = 0.04 * (random[2] - 0.5);
        let mean = -spread * normal.inverse_cdf(fails);
        let verdicts = (0..n).map(|index| {
            let own = draw(1000 + problem, index, 1)[0];
            let mut drive = Mock {
                octaves: mean + spread * normal.inverse_cdf(own.max(1e-16)),
                error: bias,
                half_width: 0.03,
            };
            let Ok(answer) = judge(&mut drive, false);
            answer.verdict
        });
        let [low, high] = Counts::of(verdicts).survival;
        held += u32::from((low..=high).contains(&(1.0 - fails)));
    }
    println!("{held} of 300");
    assert!(held >= 276, "{held}");
}

const LINE: &str = r#"
tolerances_format = 1
name = "line 3"
drives = 6
fragility_drives = 2

[[tolerance]]
name = "clearance"
keys = ["ramp.clearance_um"]
choices = [60.0, 62.0, 125.0, 150.0]
source = "a drawing"
"#;

const SPEC: &str = r#"
spec_format = 1
name = "operating shock"

[[requirement]]
name = "1 ms"
amplitude_g = 220
widths_ms = [1.0]
signs = ["-"]
"#;

/// The files of a line of drives in a folder.
fn line(folder: &Path) -> [String; 3] {
    let tolerances = folder.join("tolerances.toml");
    std::fs::write(&tolerances, LINE).expect("written");
    let spec = folder.join("spec.toml");
    std::fs::write(&spec, SPEC).expect("written");
    [drive(folder), tolerances, spec].map(|path| path.display().to_string())
}

fn arguments<'a>(files: &'a [String; 3], store: &'a str) -> Vec<&'a str> {
    let [study, tolerances, spec] = files.each_ref().map(String::as_str);
    let mut all = vec!["yield", study, "--tolerances", tolerances, "--spec", spec];
    all.extend(["--store", store, "--json"]);
    let sets = [
        "ramp.models=[\"rigid\"]",
        "pulse.widths_ms=[1.0]",
        "search.max_refinements=0",
    ];
    all.extend(sets.iter().flat_map(|set| ["--set", set]));
    all.extend(COARSE);
    all
}

fn done(folder: &Path, files: &[String; 3], store: &str, more: &[&str]) -> Done {
    let mut all = arguments(files, store);
    all.extend(more);
    Done::of(folder, &all)
}

#[test]
fn shards_threads_and_a_second_run_give_the_same_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = line(folder.path());
    let store = |name: &str| folder.path().join(name).display().to_string();
    let (whole, merged) = (store("whole"), store("merged"));
    let parts: Vec<String> = (1..=4).map(|part| store(&format!("part-{part}"))).collect();
    let out = store("out");
    // Of a former answer, and somebody's own.
    std::fs::create_dir(&out).expect("a folder");
    let old = ["drive-7.toml", "drive-8.toml"].map(|name| Path::new(&out).join(name));
    std::fs::write(&old[0], "# opshock yield: drive 7 of").expect("written");
    std::fs::write(&old[1], "# drive 8").expect("written");
    let first = done(folder.path(), &files, &whole, &["-j", "3", "--out", &out]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    assert_eq!(old.each_ref().map(|path| path.exists()), [false, true]);
    let answer = first.json();
    let counts =
        ["passing", "undecided", "failing"].map(|key| answer[key].as_u64().expect("a count"));
    assert_eq!(counts.iter().sum::<u64>(), 6);
    assert!(counts[0] > 0 && counts[2] > 0, "{counts:?}");
    // All is there: nothing is simulated again, and the answer is the same.
    let again = done(
        folder.path(),
        &files,
        &whole,
        &["-j", "1", "--at-least", "99.9", "--budget", "0s"],
    );
    assert_eq!(
        (again.code, &again.stdout),
        (8, &first.stdout),
        "{}",
        again.stderr
    );
    // A part of the drives has no answer to be judged.
    let judged = ["--shard", "1/2", "--at-least", "90"];
    assert_eq!(done(folder.path(), &files, &parts[0], &judged).code, 2);
    for (number, store) in (1..).zip(&parts) {
        let part = format!("{number}/4");
        let shard = done(folder.path(), &files, store, &["--shard", &part]);
        assert_eq!(
            (shard.code, shard.stdout.as_str()),
            (0, ""),
            "{}",
            shard.stderr
        );
    }
    let reused: Vec<&str> = parts
        .iter()
        .flat_map(|part| ["--reuse", part.as_str()])
        .collect();
    let united = done(folder.path(), &files, &merged, &reused);
    assert_eq!(
        (united.code, &united.stdout),
        (0, &first.stdout),
        "{}",
        united.stderr
    );
    // The worst drive is a study of its own that fails where the population says so.
    let worst = &answer["worst"][0];
    let study = format!("{out}/drive-{}.toml", worst["drive"]);
    let fails_g = worst["bracket_g"][1]
        .as_f64()
        .expect("a failure")
        .to_string();
    let run = [
        "run",
        &study,
        "--ramp",
        "rigid",
        "--pulse-ms",
        "1",
        "--sign",
        "-",
        "--amplitude-g",
        &fails_g,
        "--json",
    ];
    let run = Done::of(folder.path(), &run);
    let run = run.json();
    assert_eq!(run["verdict"], "fails", "{run}");
    let csv = std::fs::read_to_string(format!("{out}/yield.csv")).expect("written");
    assert_eq!(csv.lines().count(), 7);
    assert!(
        csv.starts_with("drive,verdict,1 ms,ramp.clearance_um\n"),
        "{csv}"
    );
}

#[test]
fn a_killed_run_goes_on_and_gives_the_same_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = line(folder.path());
    let store = |name: &str| folder.path().join(name).display().to_string();
    let whole = done(folder.path(), &files, &store("whole"), &["-j", "2"]);
    let killed = store("killed");
    let journal = Path::new(&killed).join("journal");
    let bytes = || std::fs::metadata(&journal).map_or(0, |found| found.len());
    let mut before = 0;
    for _ in 0..3 {
        let mut command = program(OPSHOCK);
        command.current_dir(folder.path());
        command.args(arguments(&files, &killed)).args(["-j", "1"]);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("starts");
        // Until another drive is on the disk, or all are.
        while bytes() <= before && child.try_wait().expect("a state").is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        child.kill().expect("kills");
        child.wait().expect("waits");
        before = bytes();
    }
    let end = done(folder.path(), &files, &killed, &["-j", "2"]);
    assert_eq!(
        (end.code, &end.stdout),
        (0, &whole.stdout),
        "{}",
        end.stderr
    );
    assert!(before > 0, "the killed runs left nothing");
}

/// Drives of the loose line that are compared.
const COMPARED: std::ops::Range<u64> = 0..40;

#[test]
#[ignore = "slow: 40 drives with every interval, make verify-yield"]
fn yield_slow_verdicts_by_shocks_are_those_of_intervals() {
    let [study, file, spec] = ["study.toml", "tolerances-wide.toml", "operating.toml"]
        .map(|name| Path::new("../studies/yield").join(name));
    let tolerances = Tolerances::from_path(&file, &study, &[]).expect("tolerances");
    let nominal = Spec::from_path(&spec, &study, &[]).expect("a specification");
    let nominal = nominal.requirements.iter();
    let nominal: Vec<Nominal> = nominal.map(|one| Nominal::of(&one.study)).collect();
    let range = seeds(COMPARED);
    let mut few = tolerances;
    (few.drives, few.fragility_drives) = (range.end, 0);
    let population = Population {
        tolerances: &few,
        spec: &spec,
        study: &study,
        nominal: &nominal,
    };
    let folder = tempfile::tempdir().expect("a folder");
    let mut store = few.open_store(folder.path(), STORE).expect("a store");
    let all = Part { number: 1, of: 1 };
    let drives = population.simulate(&mut store, all, 2, &Until::default(), |_, _| {});
    let drives = drives.unwrap_or_else(|why| panic!("{why:?}"));
    // Verdict by shocks, and by the interval: passes, undecided, fails.
    let mut counts = [[0; 3]; 3];
    let column = |verdict: Verdict| match verdict {
        Verdict::Passes => 0,
        Verdict::Undecided => 1,
        Verdict::Fails => 2,
    };
    for drive in &drives[range.start as usize..] {
        let sets = few.arguments(&few.draw(drive.index));
        let spec = Spec::from_path(&spec, &study, &sets).expect("a specification");
        for (requirement, points) in spec.requirements.iter().zip(&drive.requirements) {
            let input = SweepInput::of(&requirement.study).expect("input");
            let physics = Physics::of(&requirement.study);
            let folder = tempfile::tempdir().expect("a folder");
            let options = SweepOptions::with_threads(2);
            let end = sweep(&input, &physics, folder.path(), &options, &Silent).expect("sweeps");
            let found = RequirementVerdict::of(&end.summary, requirement.required_g());
            for ((point, by_interval), row) in
                points.iter().zip(&found.points).zip(&end.summary.points)
            {
                if point.by == DecidedBy::Interval {
                    continue;
                }
                counts[column(point.verdict)][column(by_interval.verdict)] += 1;
                if point.verdict != by_interval.verdict {
                    println!(
                        "drive {}, {}: {} by {:?}, {} by its interval, {:?} +- {:?} G",
                        drive.index + 1,
                        row.sign,
                        point.verdict.as_str(),
                        point.by,
                        by_interval.verdict.as_str(),
                        row.a_crit_g,
                        row.uncertainty_g
                    );
                }
            }
        }
    }
    println!("by shocks (passes, undecided, fails) against the interval: {counts:?}");
    assert_eq!([counts[0][2], counts[2][0]], [0, 0]);
}
