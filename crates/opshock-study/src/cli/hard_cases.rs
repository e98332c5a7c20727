//! `opshock doctor --hard-cases`: the physical part of the hard cases on this machine.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use crate::hard_cases::{CASES, Case, Check};
use crate::provenance;
use serde::Serialize;
use std::fmt::Write as _;

#[derive(Debug, Serialize)]
struct Findings {
    program: String,
    ok: bool,
    cases: Vec<CaseFinding>,
}

#[derive(Debug, Serialize)]
struct CaseFinding {
    case: &'static str,
    name: &'static str,
    ok: bool,
    checks: Vec<CheckFinding>,
}

#[derive(Debug, Serialize)]
struct CheckFinding {
    #[serde(flatten)]
    check: Check,
    ok: bool,
}

/// Runs every case, as many at a time as there are threads, and tells them in order.
pub fn run(threads: usize, console: &Console) -> Result<Exit, Failure> {
    use rayon::prelude::*;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::from(anyhow::Error::from(error)))?;
    let cases: Vec<CaseFinding> = pool.install(|| CASES.par_iter().map(judged).collect());
    let findings = Findings {
        program: provenance::program(),
        ok: cases.iter().all(|case| case.ok),
        cases,
    };
    if console.json {
        console.result_json(&findings)?;
    } else {
        console.result(&as_text(&findings))?;
    }
    Ok(if findings.ok {
        Exit::Complete
    } else {
        Exit::Difference
    })
}

/// A case and whether it holds; one that panics does not.
fn judged(case: &Case) -> CaseFinding {
    let checks = std::panic::catch_unwind(|| case.run())
        .unwrap_or_else(|_| vec![Check::new("panicked", f64::INFINITY, 0.0)]);
    let checks: Vec<CheckFinding> = checks
        .into_iter()
        .map(|check| CheckFinding {
            ok: check.holds(),
            check,
        })
        .collect();
    CaseFinding {
        case: case.id,
        name: case.name,
        ok: checks.iter().all(|c| c.ok),
        checks,
    }
}

/// A line a case: its first check, or those that do not hold.
fn as_text(findings: &Findings) -> String {
    let mut text = format!("{}\n", findings.program);
    let mut line = |case: &CaseFinding, check: &CheckFinding| {
        let word = if check.ok { "ok" } else { "WRONG" };
        let more = match case.checks.len() {
            1 => String::new(),
            n => format!(" (and {} more)", n - 1),
        };
        let _ = writeln!(
            text,
            "{:<5}{word:<7}{:>11} <= {:<9}{}: {}{}",
            case.case,
            format!("{:.3e}", check.check.figure),
            format!("{:.1e}", check.check.bound),
            case.name,
            check.check.what,
            if case.ok { more } else { String::new() },
        );
    };
    for case in &findings.cases {
        if case.ok {
            line(case, &case.checks[0]);
        } else {
            case.checks
                .iter()
                .filter(|c| !c.ok)
                .for_each(|c| line(case, c));
        }
    }
    let wrong = findings.cases.iter().filter(|case| !case.ok).count();
    let checks: usize = findings.cases.iter().map(|case| case.checks.len()).sum();
    let _ = writeln!(
        text,
        "{} cases, {checks} checks, {wrong} cases do not hold; all figures with --json",
        findings.cases.len()
    );
    text
}
