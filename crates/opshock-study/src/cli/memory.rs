//! Whether a sweep fits into the memory of this machine.

use super::failure::Failure;
use crate::search::bar::most_film_steps;
use crate::study::memory::{check_memory, worker_bytes};
use crate::study::{Study, StudyErrors};

/// Refuses a sweep whose workers need more than `limit_gb`, or than the machine has to give, the finest films that
/// their points may climb to included.
///
/// # Errors
/// E186. Where nothing is known of the machine's memory nothing is refused.
pub fn check(study: &Study, workers: usize, limit_gb: Option<f64>) -> Result<(), Failure> {
    let Some(available) = limit_gb.map(|gb| gb * 1e9).or_else(available_bytes) else {
        return Ok(());
    };
    let search = &study.search;
    let climbs = if search.error_bars { search.climbs } else { 0 };
    let film_steps = most_film_steps(climbs).unsigned_abs().into();
    check_memory(workers, worker_bytes(study, film_steps), available)
        .map_err(|fault| Failure::Study(StudyErrors::new(vec![*fault])))
}

/// What Linux says is available, or what a control group leaves if that is less.
fn available_bytes() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let machine = line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0;
    let number = |file: &str| {
        let text = std::fs::read_to_string(format!("/sys/fs/cgroup/{file}")).ok()?;
        text.trim().parse::<f64>().ok()
    };
    let group = number("memory.max")
        .zip(number("memory.current"))
        .map_or(f64::INFINITY, |(most, now)| most - now);
    Some(machine.min(group))
}
