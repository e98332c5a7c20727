//! Passes the commit the sources are at to the compiler, as `OPSHOCK_COMMIT`.

use std::process::Command;

fn main() {
    // Both move on a commit; a package without a repository has neither.
    for file in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    // A change of any crate is one of the program.
    println!("cargo::rerun-if-changed=..");
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".into());
    let changed = git(&[
        "status",
        "--porcelain",
        "--untracked-files=no",
        "--",
        "..",
        "../../Cargo.lock",
    ])
    .is_some_and(|files| !files.is_empty());
    let mark = if changed { "+changes" } else { "" };
    println!("cargo::rustc-env=OPSHOCK_COMMIT={commit}{mark}");
}

/// Output of a git command, `None` when there is no git or no repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
