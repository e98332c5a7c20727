//! The `opshock` program, built by the package that tests it: no test can run a stale one.

fn main() -> std::process::ExitCode {
    opshock_study::cli::main()
}
