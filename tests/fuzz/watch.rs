//! Runs fuzz seeds one after the other, distinguishes a hang from a slow reader, and watches the memory.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use opshock_tests::seeded::OnPanic;

/// Processor time, as a machine that has others to serve may hold a reader up for long. A ramp of as
/// many finite elements as a study may ask for takes some ten seconds, all other files far less than one.
const HANG: Duration = Duration::from_secs(60);

/// A reader holds a few copies of its file; corpus, libraries and test harness take the rest. A study
/// may ask for a ramp of as many finite elements as take 2 GB.
const MOST_MEMORY_KB: u64 = 5 << 19;

/// Calls `execute` with every seed. Progress goes to standard output every `report_every` seeds.
///
/// # Panics
/// When memory grew beyond the bound. A hang ends the process, naming the seed.
pub fn run(name: &str, seeds: Range<u64>, report_every: u64, mut execute: impl FnMut(u64) -> bool) {
    let (now, ended) = (AtomicU64::new(seeds.start), AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let (mut last, mut since) = (u64::MAX, processor_time());
            while !ended.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(50));
                let seed = now.load(Ordering::Relaxed);
                if seed != last {
                    (last, since) = (seed, processor_time());
                } else if processor_time().saturating_sub(since) > HANG {
                    eprintln!("{name}: seed {seed} does not end");
                    std::process::abort();
                }
            }
        });
        let _end = EndOnDrop(&ended);
        let start = Instant::now();
        let mut accepted = 0_u64;
        for seed in seeds.clone() {
            now.store(seed, Ordering::Relaxed);
            let _named = OnPanic(seed);
            accepted += u64::from(execute(seed));
            let done = seed + 1 - seeds.start;
            if done.is_multiple_of(report_every) || seed + 1 == seeds.end {
                println!(
                    "{name}: {done} executions from seed {}, {accepted} files accepted, {:.0} a \
                     second, {} MB at most",
                    seeds.start,
                    done as f64 / start.elapsed().as_secs_f64(),
                    peak_memory_kb() / 1024
                );
            }
        }
        assert!(peak_memory_kb() < MOST_MEMORY_KB, "{} kB", peak_memory_kb());
    });
}

struct EndOnDrop<'a>(&'a AtomicBool);

impl Drop for EndOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Processor time of this process so far; 0 where the system does not say, and then no hang is seen.
fn processor_time() -> Duration {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Fields 14 and 15, numbered from the name in brackets, which may hold spaces: hundredths of a
    // second in user and system mode.
    let ticks = stat.rsplit(')').next().map_or(0, |rest| {
        let fields = rest.split_whitespace().skip(11).take(2);
        fields.filter_map(|field| field.parse::<u64>().ok()).sum()
    });
    Duration::from_millis(10 * ticks)
}

/// Largest resident memory of this process so far; 0 where the system does not say.
fn peak_memory_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse().ok())
        .unwrap_or(0)
}
