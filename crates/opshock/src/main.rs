//! The `opshock` program.

fn main() -> std::process::ExitCode {
    opshock::cli::main()
}
