//! Checks that what a command is about to do fits into the memory of this machine.

use super::failure::Failure;
use opshock_study::search::uncertainty::finest;
use opshock_study::study::Study;
use opshock_study::study::memory::Demand;
use std::path::Path;

/// Refuses what needs more memory than this process may still take. `what` names it.
///
/// # Errors
/// E186.
pub fn check(what: &str, demand: Demand, workers: usize) -> Result<(), Failure> {
    Ok(demand.check(what, workers, available_bytes())?)
}

/// What a sweep needs, including the finest film grids to which its points may be refined.
pub fn of_sweep(study: &Study) -> Demand {
    let search = &study.search;
    let finer = match search.uncertainty {
        true => finest(search.max_refinements),
        false => [1.0; 2],
    };
    Demand::sweep(study, finer)
}

/// What drives that differ from the studies need: each worker has models of its own of `copies` studies at a time, beside those
/// of the studies. Films are refined by `steps` at most, beside those of intervals.
pub fn of_drives<'a>(
    studies: impl IntoIterator<Item = &'a Study>,
    copies: f64,
    steps: u8,
) -> Demand {
    let finer = [f64::from(steps).exp2(); 2];
    let mut models = 0.0;
    let mut most = Demand::default();
    for study in studies {
        let sweep = of_sweep(study).max(Demand::sweep(study, finer));
        models += Demand::models(study).models;
        most = most.max(Demand {
            models: 0.0,
            steps: sweep.steps + copies * sweep.models,
            ..sweep
        });
    }
    Demand { models, ..most }
}

/// What Linux says is available, or what a control group or a limit of this process leaves if that is less; without
/// bound where the system gives no number.
pub fn available_bytes() -> f64 {
    let machine =
        number_behind("/proc/meminfo", "MemAvailable:").map(|kilobytes| 1024.0 * kilobytes);
    let limits = [
        ("Max address space", "VmSize:"),
        ("Max data size", "VmData:"),
    ];
    let limits = limits.into_iter().filter_map(|(limit, used)| {
        let most = number_behind("/proc/self/limits", limit)?;
        Some(most - 1024.0 * number_behind("/proc/self/status", used)?)
    });
    let all = limits.chain(machine).chain(group_bytes());
    all.fold(f64::INFINITY, f64::min).max(0.0)
}

/// What the control group of this process, and those around it, leave.
fn group_bytes() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = text.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let root = Path::new("/sys/fs/cgroup");
    let left = root
        .join(own)
        .ancestors()
        .take_while(|folder| folder.starts_with(root))
        .filter_map(|folder| {
            let number = |file: &str| -> Option<f64> {
                std::fs::read_to_string(folder.join(file))
                    .ok()?
                    .trim()
                    .parse()
                    .ok()
            };
            // Files that were read and not used of late are given up first.
            let cached = number_behind(folder.join("memory.stat"), "inactive_file").unwrap_or(0.0);
            Some(number("memory.max")? - number("memory.current")? + cached)
        })
        .fold(f64::INFINITY, f64::min);
    Some(left)
}

/// The first number behind a word at the start of a line.
fn number_behind(path: impl AsRef<Path>, word: &str) -> Option<f64> {
    let text = std::fs::read_to_string(path).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(word))?;
    rest.split_whitespace().next()?.parse().ok()
}
