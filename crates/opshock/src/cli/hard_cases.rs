//! `opshock doctor --hard-cases`: runs the physical hard cases, scenes that break solvers, on this machine.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use opshock_study::hard_cases::{CASES, Case, Check};
use opshock_study::provenance;
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

/// Runs every case, as many at a time as there are threads, and prints them in order.
pub fn run(threads: usize, console: &Console) -> Result<Exit, Failure> {
    let findings = findings(CASES, threads)?;
    if console.json {
        console.result_json(&findings)?;
    } else {
        console.result(&as_text(&findings))?;
    }
    Ok(exit(&findings))
}

fn findings(cases: &[Case], threads: usize) -> Result<Findings, Failure> {
    use rayon::prelude::*;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::from(anyhow::Error::from(error)))?;
    let cases: Vec<CaseFinding> = pool.install(|| cases.par_iter().map(judged).collect());
    Ok(Findings {
        program: provenance::program(),
        ok: cases.iter().all(|case| case.ok),
        cases,
    })
}

fn exit(findings: &Findings) -> Exit {
    if findings.ok {
        Exit::Complete
    } else {
        Exit::Difference
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use opshock_study::hard_cases::case;

    fn sound() -> Vec<Check> {
        vec![
            Check::new("small", 1e-9, 1e-6),
            Check::none("lost", 0).against("naive", 3.0),
        ]
    }

    fn beyond() -> Vec<Check> {
        vec![
            Check::new("small", 1e-9, 1e-6),
            Check::new("large", 2e-6, 1e-6),
        ]
    }

    fn not_a_number() -> Vec<Check> {
        vec![Check::new("none", f64::NAN, 1.0)]
    }

    fn broken() -> Vec<Check> {
        panic!("a case that breaks")
    }

    #[test]
    fn one_case_that_does_not_hold_is_exit_code_7() {
        let all = [
            case("A1", "sound", sound),
            case("A2", "beyond", beyond),
            case("A3", "not a number", not_a_number),
            case("A4", "broken", broken),
        ];
        let good = findings(&all[..1], 1).unwrap();
        assert_eq!(exit(&good).code(), 0);
        assert!(as_text(&good).contains("1 cases, 2 checks, 0 cases do not hold"));
        for wrong in 1..all.len() {
            let pair = findings(&[all[0], all[wrong]], 2).unwrap();
            assert_eq!(exit(&pair).code(), 7, "{}", all[wrong].name);
            let text = as_text(&pair);
            let line = text.lines().nth(2).unwrap();
            assert!(
                line.starts_with(all[wrong].id) && line.contains("WRONG"),
                "{text}"
            );
            assert!(text.contains("1 cases do not hold"), "{text}");
        }
        // The figure beyond its bound is printed, not the first of the case.
        let text = as_text(&findings(&all[1..2], 1).unwrap());
        assert!(
            text.contains("2.000e-6 <= 1.0e-6") && text.contains("large"),
            "{text}"
        );
    }
}
