//! Writes a job-array script for Slurm: one task per shard (a part of the points), requeued until it is complete.

use super::global::GlobalArgs;
use super::sweep::{quoted, settings};
use std::path::Path;

/// A sweep as a job array.
pub struct Job<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Study file.
    pub study: &'a Path,
    /// Store of the whole sweep.
    pub store: &'a Path,
    /// Tasks.
    pub shards: usize,
    /// Threads of a task.
    pub threads: usize,
    /// Longest time that a task is expected to take, hours.
    pub hours: f64,
}

/// The script.
///
/// # Errors
///
/// The program does not know its own path.
pub fn script(job: &Job<'_>, global: &GlobalArgs) -> std::io::Result<String> {
    let program = std::env::current_exe()?;
    let path = |path: &Path| -> std::io::Result<String> {
        Ok(quoted(&std::path::absolute(path)?.display().to_string()))
    };
    let (study, store) = (path(job.study)?, path(job.store)?);
    let name: String = job
        .name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    // Half as much again, at least ten minutes, whole minutes: a task that needs longer saves, ends
    // and is requeued.
    let minutes = (job.hours * 60.0 * 1.5).ceil().max(10.0) as u64;
    let (shards, threads) = (job.shards, job.threads);
    Ok(format!(
        r#"#!/bin/bash
# Sweep of a study in {shards} shards.   submit:  sbatch THIS_FILE
# When all have ended:  {program} merge {store}
#SBATCH --job-name=opshock-{name}
#SBATCH --array=1-{shards}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={threads}
#SBATCH --time={minutes}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
#SBATCH --output={output}

{program} sweep {study} --store {store}{settings} \
  --shard "$SLURM_ARRAY_TASK_ID/{shards}" -j {threads} --progress lines &
task=$!
# A minute before the time limit: save and end. The trap interrupts the wait, so wait again.
trap 'kill -TERM "$task"' TERM
wait "$task"
code=$?
while kill -0 "$task" 2>/dev/null; do
  wait "$task"
  code=$?
done
case "$code" in
  0 | 4) exit 0 ;; # complete; 4: some points are not bracketed or undecided
  143) scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID" ;; # saved: go on later
esac
exit "$code"
"#,
        program = quoted(&program.display().to_string()),
        settings = settings(global),
        output = format_args!("{}.%A_%a.log", std::path::absolute(job.store)?.display()),
    ))
}
